/* What the files of this room share. */
#pragma once

#include <porograin/particles.h>
#include <petscsf.h>
#include <stdint.h>

typedef struct {
  PgFieldInfo info;  /* its strings are owned by the registry */
  PetscReal  *array; /* (capacity*components) owned discs first, ghosts after; NULL: not asked for yet */
} PgFieldStore;

typedef struct {
  char      *name;
  PetscInt   components;
  unsigned   flags;
  PetscInt  *offset; /* (owned + 1) first record of each disc */
  PetscReal *record;
  PetscInt   offset_capacity; /* entries of offset */
  PetscInt   record_capacity; /* records */
} PgRaggedStore;

/* Cells of the partition. Discs outside the grid belong to its edge cells. */
typedef struct {
  PetscReal width;         /* asked for at the last cut [m]; negative: no grid yet */
  PetscReal low[2];        /* corner [m] */
  PetscReal high[2];       /* opposite corner [m] */
  PetscReal per_length[2]; /* cells per length [1/m] */
  PetscInt  cells[2];
  int       levels; /* the curve runs over 2^levels x 2^levels cells */
} PgGrid;

/* One disc on its way to its place along the curve. */
typedef struct {
  uint64_t key;
  PetscInt id;
  PetscInt index; /* where its values are now: an owned disc, or owned + n for the n-th arrival */
} PgSortEntry;

/* A ghost this rank has to feed. */
typedef struct {
  PetscMPIInt rank;  /* whose ghost */
  PetscInt    disc;  /* owned disc */
  PetscInt    root;  /* its number among the boundary discs */
  PetscInt    shift; /* periods to add to x: -1, 0, 1 */
} PgGhostSend;

/* Messages between ranks that do not know beforehand who sends to them. */
typedef struct {
  PetscMPIInt  nto, nfrom;
  PetscMPIInt *to, *from; /* `from` in ascending order */
  PetscInt     kinds;     /* data of this many sorts travel */
  PetscInt    *to_size;   /* (nto*kinds) */
  PetscInt    *from_size; /* (nfrom*kinds) */
} PgMessages;

struct PgParticles_s {
  MPI_Comm    comm;
  PetscMPIInt rank, size, tag;
  PetscInt    revision;

  /* sizes */
  PetscInt owned, ghosts, global;
  PetscInt capacity; /* discs that every array can hold, ghosts included */
  PetscInt start;    /* global index of the first owned disc */

  /* values */
  PetscInt        nfields, fields_capacity;
  PgFieldStore  **field; /* pointers, so that a PgFieldInfo handed out stays where it is */
  PetscInt        nragged, ragged_capacity;
  PgRaggedStore **ragged;
  PetscInt       *id, *index; /* (capacity) permanent ids and global indices, ghosts included */

  /* partition */
  PetscReal balance;    /* largest load over the mean that is tolerated */
  PetscInt  sort_every; /* distributions between sortings */
  PetscInt  unsorted;   /* distributions since the last sorting */
  PetscReal cut_load;   /* largest load just after the last cut [discs] */
  PetscReal worst_load; /* largest load since the discs were set, with cuts that served [discs] */
  PetscInt  cuts;       /* since the discs were set */
  PgGrid    grid;
  uint64_t *splitter; /* (size + 1) piece p of the curve holds the keys [splitter[p], splitter[p + 1]) */
  PetscInt  shift;    /* rank r owns piece (r + shift) % size */
  PetscBool recut;    /* the next distribution cuts anew */

  /* periodic x */
  PetscBool periodic;
  PetscReal low, high; /* [m] */
  PgField   crossings;

  /* ghosts */
  PetscBool     any_ghosts; /* on some rank */
  PetscInt      nsend, nroots;
  PgGhostSend  *send;  /* sorted by rank */
  PetscInt     *root;  /* (nroots) owned discs that are somebody's ghost */
  PetscInt     *image; /* (ghosts) periods added to x */
  PetscSF       halo;
  PetscInt      halo_active; /* components in flight, 0: none */
  PetscReal    *root_buffer, *leaf_buffer;
  size_t        root_buffer_size, leaf_buffer_size; /* reals */
  MPI_Datatype *unit;                               /* [k] k reals in a row, MPI_DATATYPE_NULL until used */
  PetscInt      nunits;

  /* id order */
  PetscSF  byid;
  PetscInt byid_revision;
};

/* particles.c */
PETSC_INTERN PetscErrorCode PgParticlesNumber(PgParticles particles);

/* registry.c */
PETSC_INTERN PetscErrorCode PgParticlesReserve(PgParticles particles, PetscInt discs);
PETSC_INTERN PetscErrorCode PgParticlesDestroyRegistry(PgParticles particles);
PETSC_INTERN PetscErrorCode PgRaggedReserve(PgRaggedStore *ragged, PetscInt discs, PetscInt records);

/* partition.c */
PETSC_INTERN uint64_t       PgCurveKey(const PgGrid *grid, PetscInt ix, PetscInt iy);
PETSC_INTERN void           PgGridCell(const PgGrid *grid, const PetscReal position[2], PetscInt cell[2]);
PETSC_INTERN PetscMPIInt    PgPartitionOwner(PgParticles particles, uint64_t key);
PETSC_INTERN void           PgPartitionOwnRange(PgParticles particles, uint64_t *first, uint64_t *end);
PETSC_INTERN PetscErrorCode PgPartitionUpdate(PgParticles particles, PetscReal width);

/* sort.c */
PETSC_INTERN PetscErrorCode PgSortEntries(PetscInt n, PgSortEntry entry[], uint64_t max_key, PetscInt max_id);

/* migrate.c: entries come back in the new local order */
PETSC_INTERN PetscErrorCode PgParticlesMigrate(PgParticles particles, PgSortEntry *entry[], PetscBool *changed);

/* messages.c */
PETSC_INTERN PetscErrorCode PgMessagesPlan(MPI_Comm comm, PetscInt kinds, PetscMPIInt nto, const PetscMPIInt to[],
                                           const PetscInt to_size[], PgMessages *messages);
PETSC_INTERN PetscErrorCode PgMessagesExchange(MPI_Comm comm, PetscMPIInt tag, const PgMessages *messages,
                                               PetscInt kind, MPI_Datatype type, const void *send, void *receive);
PETSC_INTERN PetscInt       PgMessagesReceived(const PgMessages *messages, PetscInt kind);
PETSC_INTERN PetscErrorCode PgMessagesDestroy(PgMessages *messages);

/* ghosts.c */
PETSC_INTERN PetscErrorCode PgGhostsUpdate(PgParticles particles, const PgSortEntry entry[], PetscBool changed);
PETSC_INTERN PetscErrorCode PgGhostsDestroy(PgParticles particles);

/* halo.c */
PETSC_INTERN PetscErrorCode PgParticlesUnit(PgParticles particles, PetscInt components, MPI_Datatype *unit);
PETSC_INTERN PetscErrorCode PgHaloDestroy(PgParticles particles);

/* idorder.c */
PETSC_INTERN PetscErrorCode PgParticlesCheckIds(PgParticles particles, PetscInt owned, const PetscInt id[],
                                                PetscInt global);
