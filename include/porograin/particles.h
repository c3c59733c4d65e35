/* particles: who the discs are and where they live. A struct of arrays with one registry of fields,
   the partition over the ranks, migration and ghosts. Knows no physics.

   Order in every array: the discs owned by this rank first, their ghosts (copies of other ranks' discs,
   or periodic images) after. Components are interleaved: component c of disc i is a[i*components + c].
   Arrays are valid until the next PgParticlesDistribute(). */
#pragma once

#include <porograin/base.h>

typedef struct PgParticles_s *PgParticles;
typedef PetscInt              PgField;  /* index into the registry */
typedef PetscInt              PgRagged; /* index into the registry of variable-length data */

typedef enum {
  PG_FIELD_MIGRATE = 1, /* moves with its disc; without it the values are undefined after a distribution */
  PG_FIELD_HALO    = 2, /* ghosts get values at each distribution */
  PG_FIELD_OUTPUT  = 4, /* written to result snapshots */
  PG_FIELD_RESTART = 8  /* part of a checkpoint */
} PgFieldFlag;

typedef struct {
  const char *name;        /* dataset name in files, e.g. "fluid_velocity" */
  PetscInt    components;  /* 1 scalar, 2 vector, 4 tensor by rows */
  const char *unit;        /* SI, "1" for none */
  const char *description; /* one sentence for file readers */
  unsigned    flags;       /* PgFieldFlag */
} PgFieldInfo;

/* Fields every particle store has, with these indices. */
enum {
  PG_POSITION = 0,     /* (2) [m] of the centre; in a periodic direction wrapped at each distribution */
  PG_VELOCITY,         /* (2) [m/s] */
  PG_ANGULAR_VELOCITY, /* (1) [rad/s] */
  PG_ROTATION,         /* (1) [rad] since the start */
  PG_RADIUS,           /* (1) [m] */
  PG_MASS,             /* (1) [kg/m], per metre of thickness */
  PG_INITIAL_POSITION, /* (2) [m] at the start */
  PG_CORE_FIELDS
};

/* Collective on comm. */
PETSC_EXTERN PetscErrorCode PgParticlesCreate(MPI_Comm comm, PgParticles *particles);
/* Reads -particles_balance (largest load over the mean before the discs are partitioned anew, default
   1.1) and -particles_sort_every (list builds between sortings along the curve). Collective. */
PETSC_EXTERN PetscErrorCode PgParticlesSetFromOptions(PgParticles particles);
PETSC_EXTERN PetscErrorCode PgParticlesView(PgParticles particles, PetscViewer viewer);
PETSC_EXTERN PetscErrorCode PgParticlesDestroy(PgParticles *particles);
PETSC_EXTERN MPI_Comm       PgParticlesComm(PgParticles particles);

/* Adds a field (strings are copied) and sets it to zero; a second registration under the same name
   returns the first one's index, and joins the flags, if the shape agrees and is an error if not. May be
   called at any time by all ranks in the same order. Not collective otherwise. */
PETSC_EXTERN PetscErrorCode PgParticlesRegisterField(PgParticles particles, const PgFieldInfo *info, PgField *field);
PETSC_EXTERN PetscErrorCode PgParticlesFindField(PgParticles particles, const char name[],
                                                 PgField *field); /* -1: unknown */
PETSC_EXTERN PetscErrorCode PgParticlesGetFieldCount(PgParticles particles, PetscInt *count);
PETSC_EXTERN PetscErrorCode PgParticlesGetFieldInfo(PgParticles particles, PgField field, const PgFieldInfo **info);
PETSC_EXTERN PetscErrorCode PgParticlesGetArray(PgParticles particles, PgField field, PetscReal **array);

/* Variable-length data of each owned disc: records of `components` reals, `offset` (owned + 1) in
   records. It migrates and is reordered with its disc. Example: contact history, one record for each
   touching partner. Set replaces all of it, taking a copy; with offset NULL no disc has a record and the
   memory is given back. */
PETSC_EXTERN PetscErrorCode PgParticlesRegisterRagged(PgParticles particles, const char name[], PetscInt components,
                                                      unsigned flags, PgRagged *ragged);
PETSC_EXTERN PetscErrorCode PgParticlesSetRagged(PgParticles particles, PgRagged ragged, const PetscInt offset[],
                                                 const PetscReal record[]);
PETSC_EXTERN PetscErrorCode PgParticlesGetRagged(PgParticles particles, PgRagged ragged, const PetscInt *offset[],
                                                 const PetscReal *record[]);
PETSC_EXTERN PetscErrorCode PgParticlesGetRaggedCount(PgParticles particles, PetscInt *count);
PETSC_EXTERN PetscErrorCode PgParticlesGetRaggedInfo(PgParticles particles, PgRagged ragged, const char *name[],
                                                     PetscInt *components, unsigned *flags);

/* Replaces all discs by `owned` new ones on this rank with permanent ids `id` (all ids of all ranks are
   0 .. N-1, each once: checked) and every field zero. The caller then fills the arrays and calls
   PgParticlesDistribute(). Any rank may hold none. Collective. */
PETSC_EXTERN PetscErrorCode PgParticlesSetDiscs(PgParticles particles, PetscInt owned, const PetscInt id[]);
/* Largest number of discs that one rank has had since they were set, over the mean, and how often they were
   partitioned. Known at distributions; not collective. */
PETSC_EXTERN PetscErrorCode PgParticlesGetBalance(PgParticles particles, PetscReal *worst, PetscInt *cuts);
PETSC_EXTERN PetscErrorCode PgParticlesGetSizes(PgParticles particles, PetscInt *owned, PetscInt *ghosts,
                                                PetscInt *global);
/* Permanent ids, ghosts included. */
PETSC_EXTERN PetscErrorCode PgParticlesGetIds(PgParticles particles, const PetscInt *id[]);
/* Row numbers in a PETSc vector or matrix laid out like the owned discs: start + i for owned disc i,
   the owner's number for ghosts. */
PETSC_EXTERN PetscErrorCode PgParticlesGetGlobalIndices(PgParticles particles, PetscInt *start,
                                                        const PetscInt *index[]);

/* Makes x periodic in [low, high). Each distribution wraps the positions into that range and adds the
   periods taken off to the field "crossings", so that x + crossings*(high - low) is the unwrapped one;
   between distributions discs may leave the range. Ghosts of images are shifted. Collective. */
PETSC_EXTERN PetscErrorCode PgParticlesSetPeriodicX(PgParticles particles, PetscReal low, PetscReal high);
PETSC_EXTERN PetscErrorCode PgParticlesGetPeriodicX(PgParticles particles, PetscBool *periodic, PetscReal *low,
                                                    PetscReal *high);

/* Sends every disc to the rank that owns its cell (cells of at least `width`, numbered along a Hilbert
   curve, each rank a contiguous piece), cuts the curve anew when the largest load exceeds the threshold
   (always the first time), sorts the owned discs along the curve and rebuilds the ghosts: every disc of
   another rank within `width` of an owned one is there. HALO fields of ghosts are valid on return.
   All arrays move. Collective. */
PETSC_EXTERN PetscErrorCode PgParticlesDistribute(PgParticles particles, PetscReal width);
/* Test hook: the next distribution cuts the curve anew, with the pieces shifted by `shift` ranks, so
   that almost every disc migrates. Collective. */
PETSC_EXTERN PetscErrorCode PgParticlesForceMigration(PgParticles particles, PetscInt shift);
/* Makes the next distribution the same as that of a new store with these discs: grid, cuts and order follow from
   positions and ids alone (checkpoints call it, so that a restarted run and the one that wrote the checkpoint go
   on alike). Collective. */
PETSC_EXTERN PetscErrorCode PgParticlesForgetPartition(PgParticles particles);
/* Counts distributions that changed the local numbering: whatever is kept per local index is stale when
   it has changed. */
PETSC_EXTERN PetscErrorCode PgParticlesGetRevision(PgParticles particles, PetscInt *revision);

/* Copies the owners' values of `count` fields to their ghosts in one message to each neighbour
   (positions of periodic images get their shift). Nothing to do without ghosts. Collective. */
PETSC_EXTERN PetscErrorCode PgParticlesHaloBegin(PgParticles particles, PetscInt count, const PgField fields[]);
PETSC_EXTERN PetscErrorCode PgParticlesHaloEnd(PgParticles particles, PetscInt count, const PgField fields[]);
PETSC_EXTERN PetscErrorCode PgParticlesHalo(PgParticles particles, PetscInt count, const PgField fields[]);

/* Distribution by permanent id: rank r holds ids [start, start + count), N/ranks each. The order of
   files, and of everything compared between different numbers of ranks. Copies a field of the owned
   discs into `byid` (count*components). Collective. */
PETSC_EXTERN PetscErrorCode PgParticlesGetIdRange(PgParticles particles, PetscInt *start, PetscInt *count);
PETSC_EXTERN PetscErrorCode PgParticlesToIdOrder(PgParticles particles, PetscInt components, const PetscReal owned[],
                                                 PetscReal byid[]);
PETSC_EXTERN PetscErrorCode PgParticlesFromIdOrder(PgParticles particles, PetscInt components, const PetscReal byid[],
                                                   PetscReal owned[]);
