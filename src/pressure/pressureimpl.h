/* What the files of this room share. The equations of one geometry are kept without a matrix, as pair weights
   w_ab = -c_ab dV_b dV_a kappa_ab, so that the explicit sweep needs no more; the matrix is made from them. */
#pragma once

#include <porograin/pressure.h>

#define PG_PRESSURE_SECTION "pressure: pressure equation and its solver"

/* A method: how the equations of this geometry are solved. */
typedef struct {
  PgPressureMethod kind;
  /* After the weights changed. */
  PetscErrorCode (*update)(PgPressure pressure);
  /* Field pressure (owned) from its guess; fills stats but rhs_norm of b = 0 and singular. Ghosts are exchanged after
     it. */
  PetscErrorCode (*solve)(PgPressure pressure, PgPressureStats *stats);
  /* Reads nested solver options; NULL when there are none. */
  PetscErrorCode (*setup)(PgPressure pressure);
} PgPressureOps;

struct PgPressure_s {
  PgParticles particles;
  PgNeighbors neighbors;
  PgSph       sph;
  MPI_Comm    comm;
  PgField     p, fixed, prescribed, island_label, volume, coefficient; /* coefficient: -1 until it is used */

  /* settings */
  PgPressureOps ops;
  char          method[32];
  PetscReal     reference;              /* [Pa] */
  PetscInt      sweeps;                 /* explicit sweeps per solve */
  PetscInt      pc_lag;                 /* solves a preconditioner may serve, 0: any number */
  PetscReal     rebuild_factor;         /* of the iterations after a build, before the next build */
  PetscBool     error_if_not_converged; /* a solve that fails ends the run */
  PetscBool     fixed_work;             /* one iteration of Richardson's method: a sweep, no solution */
  PetscBool     residual_requested;     /* explicit: the next solve computes its residual */
  PetscBool     from_options;           /* options are read */
  PetscBool     user_type, user_atol;   /* -pressure_ksp_type, -pressure_ksp_atol given */
  PetscInt      dump_every;             /* 0: the first solve only */
  char          dump[PETSC_MAX_PATH_LEN], failure[PETSC_MAX_PATH_LEN];

  /* equations of the present geometry, by owned disc and by entry of the row list */
  PetscInt        owned, rows, entries; /* discs; capacities */
  const PetscInt *ptr, *col;            /* the row list */
  PetscReal      *weight;               /* (entries) w_ab [1] */
  PetscReal      *diagonal;             /* (rows) sum_b w_ab [1] */
  PetscReal      *source;               /* (rows) -Z_a dV_a; fixed discs: diagonal*(prescribed - reference) [Pa] */
  PetscReal      *lift;                 /* (rows) sum over fixed b of w_ab*(prescribed_b - reference) [Pa] */
  PetscReal      *next;                 /* (rows) result of a sweep [Pa] */
  PetscReal       smallest, largest;    /* |diagonal|, over all discs */
  PetscBool       singular, symmetric;  /* singular: no disc has a prescribed pressure */
  PetscInt        neighbors_revision, particles_revision; /* of the weights */
  PetscInt       *row_id, known, known_size; /* ids of the owned discs when last compared, their number, capacity */
  PetscInt        solves;                    /* since the start of the run, also before a restart */
  PgPressureWork  work;

  /* islands: discs that nothing ties to a prescribed pressure */
  PetscInt   islands;                  /* on all ranks; 0: the matrix is regular */
  PetscBool  whole;                    /* one island has all discs */
  PetscInt  *island, *island_parent;   /* (island_capacity) of each owned disc, -1: of none; scratch */
  PetscInt  *tie;                      /* (island_capacity) entry that ties an owned disc to a fixed one, -1: none */
  PetscInt   island_capacity;          /* owned discs */
  PetscBool  tied;                     /* all free discs are, on all ranks: there are no islands */
  PetscReal *island_size, *island_sum; /* (islands_room) discs, of all ranks; scratch */
  PetscReal *island_mean;              /* (islands_room) mean of the pressure before a solve */
  PetscReal *island_root;              /* (islands_room) label */
  PetscInt   islands_room;
  int       *island_counts; /* (2*ranks) scratch */

  /* the matrix */
  Mat       A;
  Vec       b, x, r;
  PetscInt *entry_at, *diagonal_at;         /* where each entry goes: k in the diagonal block, ~k in the other */
  PetscInt  entry_size, diagonal_size;      /* capacities */
  PetscBool new_lists, new_numbers, resize; /* since the pattern was made; the same on all ranks */
  PetscBool matrix_current, source_current, rhs_current;
  PetscInt  matrix_islands; /* null space attached */
  PetscBool matrix_whole;
  PetscInt  patterns, fills;
  PetscInt  built_fills; /* fills when the preconditioner was built */

  /* the solver */
  KSP       ksp;
  PetscReal history[1];         /* residual norm of the guess, as the KSP saw it */
  PetscBool built, stale;       /* a preconditioner exists; it must not be used again */
  PetscBool restructured;       /* numbering or pattern changed since it was built */
  PetscBool coarse_is_singular; /* BoomerAMG was told to smooth on its coarsest grid */
  PetscInt  served;             /* solves since it was built */
  PetscInt  first_iterations;   /* of the first of them */
  PetscInt  preconditioners;
};

/* pressure.c */
PETSC_INTERN PetscErrorCode PgPressureGrow(PetscInt needed, PetscInt *capacity, PetscInt arrays, PetscReal **array[]);

/* system.c */
PETSC_INTERN PetscErrorCode PgPressureComputeWeights(PgPressure pressure, const PetscReal coefficient[]);
PETSC_INTERN PetscErrorCode PgPressureComputeSource(PgPressure pressure, const PetscReal Z[]);
/* ||b - A x||, ||b|| and |sum b| of the field pressure (ghosts current), without a matrix. */
PETSC_INTERN PetscErrorCode PgPressureResidual(PgPressure pressure, PetscReal *residual, PetscReal *rhs,
                                               PetscReal *sum);

/* matrix.c */
PETSC_INTERN PetscErrorCode PgPressureAssemble(PgPressure pressure);
/* b from the sources, before anything is removed from it. */
PETSC_INTERN PetscErrorCode PgPressureFillRhs(PgPressure pressure);
PETSC_INTERN PetscErrorCode PgPressureDestroyMatrix(PgPressure pressure);

/* islands.c */
/* From the weights and conditions of the present geometry. Without a symmetric matrix only no prescribed pressure at
   all counts. Collective. */
PETSC_INTERN PetscErrorCode PgPressureFindIslands(PgPressure pressure);
PETSC_INTERN PetscErrorCode PgPressureDestroyIslands(PgPressure pressure);
/* Mean of v on each island; a value of each island added to v there. Collective, not collective. */
PETSC_INTERN PetscErrorCode PgPressureIslandMeans(PgPressure pressure, Vec v, PetscReal mean[]);
PETSC_INTERN PetscErrorCode PgPressureIslandShift(PgPressure pressure, Vec v, const PetscReal shift[]);
/* For MatNullSpaceSetFunction(). */
PETSC_INTERN PetscErrorCode PgPressureRemoveIslandMeans(MatNullSpace space, Vec v, void *pressure);

/* Room for the owned discs in island, island_parent and tie. */
PETSC_INTERN PetscErrorCode PgPressureReserveTies(PgPressure pressure);

/* ties.c */
/* Free discs that no chain of weights ties to a prescribed pressure, for messages: their number and the least id of one;
   what is known of islands is spoilt. Collective. */
PETSC_INTERN PetscErrorCode PgPressureCountLoose(PgPressure pressure, PetscInt *count, PetscInt *least);
/* Ties what can be tied, and sets tied. Collective. */
PETSC_INTERN PetscErrorCode PgPressureTie(PgPressure pressure);
/* Whether the owned discs are still tied with the present weights; lists and numbers of discs are what they were. */
PETSC_INTERN PetscBool PgPressureTiesHold(PgPressure pressure, const PetscReal fixed[]);

/* dump.c: A, b, x as PETSC binary. *written is false when the file cannot be opened. */
PETSC_INTERN PetscErrorCode PgPressureWriteSystem(PgPressure pressure, const char file[], PetscBool *written);
PETSC_INTERN PetscErrorCode PgPressureDump(PgPressure pressure);
/* Refuses a place where the next dump cannot be written. Collective. */
PETSC_INTERN PetscErrorCode PgPressureCheckDump(PgPressure pressure);

/* explicit.c, implicit.c: register their method */
PETSC_INTERN PetscErrorCode PgPressureCreate_Explicit(PgPressure pressure);
PETSC_INTERN PetscErrorCode PgPressureCreate_Implicit(PgPressure pressure);

/* solver.c: the KSP and its preconditioner */
PETSC_INTERN PetscErrorCode PgPressureCreateSolver(PgPressure pressure, KSP *ksp);
/* Enters the options of PETSc that matter most into the help. */
PETSC_INTERN PetscErrorCode PgPressureMentionOptions(void);
PETSC_INTERN PetscErrorCode PgPressureSolverFromOptions(PgPressure pressure, KSP ksp);
/* Refuses a solver that cannot work for this matrix. */
PETSC_INTERN PetscErrorCode PgPressureCheckSolver(PgPressure pressure);
PETSC_INTERN PetscErrorCode PgPressureBuildPreconditioner(PgPressure pressure);
/* Builds when a rule says so; *fresh tells. */
PETSC_INTERN PetscErrorCode PgPressureKeepPreconditioner(PgPressure pressure, PetscBool *fresh);
