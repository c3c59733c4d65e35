/* What the files of this room share. */
#pragma once

#include <porograin/study.h>
#include <math.h>

/* ---- override.c: options set for a while ---- */

enum { PG_OVERRIDES = 48 };
typedef struct {
  PetscInt  count;
  char     *name[PG_OVERRIDES], *before[PG_OVERRIDES]; /* before: the value there was, NULL: none */
  PetscBool had[PG_OVERRIDES];
} PgOverride;

/* value NULL: an option without a value. */
PETSC_INTERN PetscErrorCode PgOverrideSet(PgOverride *o, const char name[], const char value[]);
PETSC_INTERN PetscErrorCode PgOverrideRemove(PgOverride *o, const char name[]);
/* Puts everything back; used[i], if wanted, tells whether PETSc read the i-th option while it was set. */
PETSC_INTERN PetscErrorCode PgOverrideRestore(PgOverride *o, PetscBool used[]);

/* ---- solverlist.c: the file of solvers ---- */

typedef struct {
  char       name[64], prefix[32]; /* prefix of its options, without '-' */
  PetscInt   line, options;
  char     **option, **value; /* option without '-' and prefix; value NULL: none */
  PetscBool *used;
} PgSolver;

typedef struct {
  char      file[PETSC_MAX_PATH_LEN];
  PetscInt  count;
  PgSolver *solver;
} PgSolverList;

/* `only`: names separated by commas, or empty for all. */
PETSC_INTERN PetscErrorCode PgSolverListRead(MPI_Comm comm, const char file[], const char only[], PgSolverList *list);
PETSC_INTERN PetscErrorCode PgSolverListDestroy(PgSolverList *list);
PETSC_INTERN PetscErrorCode PgSolverPut(const PgSolver *solver, const char prefix[], PgOverride *o);
PETSC_INTERN PetscErrorCode PgSolverTake(PgSolver *solver, PgOverride *o); /* remembers which were used */
PETSC_INTERN PetscErrorCode PgSolverHas(const PgSolver *solver, const char option[], PetscBool *has);
/* Tries every solver on a small Poisson matrix and fails, naming file and line, for options that nobody reads, types
   that do not exist and values that cannot be read. */
PETSC_INTERN PetscErrorCode PgSolverListCheck(MPI_Comm comm, PgSolverList *list);

/* ---- system.c, load.c: a pressure system ---- */

typedef struct {
  MPI_Comm    comm;
  char        name[PETSC_MAX_PATH_LEN];
  PetscInt    n;
  PetscReal   nonzeros, stored; /* per row */
  Mat         A;
  Vec         b, reference; /* reference: what answers are compared with, NULL: nothing */
  const char *reference_name;
  PetscBool   singular, symmetric;
  PetscReal   rhs_norm, removed; /* of b as it is solved; part taken away, relative */

  /* what A was made from; NULL when it was loaded */
  PgParticles       particles;
  PgNeighbors       neighbors;
  PgDem             dem;
  PgPore            pore;
  const PgCaseInfo *info;
  void             *context;
} PgSystem;

typedef enum { PG_STUDY_LATTICE, PG_STUDY_JITTERED, PG_STUDY_RANDOM } PgStudyPacking;
typedef struct {
  PgStudyPacking packing;
  PetscReal      jitter;       /* largest displacement of a disc in each direction, in diameters */
  PetscReal      imbalance;    /* of the right-hand side of a singular system */
  PetscBool      by_id;        /* rows in the order of permanent ids */
  PetscInt       direct_limit; /* largest n that is solved directly for comparison */
  PetscBool      no_nullspace, unprojected, preconditioned_norm; /* traps */
} PgSystemChoices;

PETSC_INTERN PetscErrorCode PgSystemCreate(MPI_Comm comm, PgSystem **system);
/* Reads the options of the case and of the water. */
PETSC_INTERN PetscErrorCode PgSystemFromCase(PgSystem *system, const PgCaseInfo *info, const PgSystemChoices *choices);
PETSC_INTERN PetscErrorCode PgSystemBuild(PgSystem *system, const PgSystemChoices *choices);
PETSC_INTERN PetscErrorCode PgSystemLoad(PgSystem *system, const char file[], const PgSystemChoices *choices);
PETSC_INTERN PetscErrorCode PgSystemFinish(PgSystem *system, const PgSystemChoices *choices);
PETSC_INTERN PetscErrorCode PgSystemDestroy(PgSystem **system);

/* ---- solve.c: one solver on one system ---- */

typedef struct {
  PetscReal rtol;
  PetscInt  repeats;
  PetscReal repeat_seconds; /* no further repeat once this is spent */
  PetscReal seconds;        /* a solve is stopped after that */
  PetscBool condition;
} PgSolveChoices;

typedef struct {
  PetscErrorCode     failed; /* of PETSc; the other numbers mean nothing then */
  PetscInt           iterations, levels;
  KSPConvergedReason reason;
  char               words[192];
  PetscReal          needed; /* iterations to tolerance, extrapolated when the solver was stopped */
  PetscReal          residual, error, setup, solve, complexity, condition;
  PetscInt           runs, history_length;
  PetscReal         *history; /* residual norm over that of b, owned here */
} PgSolveResult;

PETSC_INTERN PetscErrorCode PgSolve(PgSystem *system, const PgSystemChoices *how, PgSolver *solver,
                                    const PgSolveChoices *choices, PgSolveResult *result);
PETSC_INTERN PetscErrorCode PgSolveResultFree(PgSolveResult *result);
/* Solves by a complete factorisation; *done is false when none is at hand. */
PETSC_INTERN PetscErrorCode PgSolveDirect(Mat A, Vec b, Vec x, PetscBool *done);

/* clock.c: calls that may fail without ending the study */
typedef struct {
  char message[160];
} PgTrouble;
PETSC_INTERN PetscErrorCode PgTroubleBegin(PgTrouble *trouble);
/* The worst of the codes of all ranks. */
PETSC_INTERN PetscErrorCode PgTroubleEnd(MPI_Comm comm, PetscErrorCode *code);

/* Seconds for the clocks of the tables: CPU time of this process on one rank, wall time on several. */
PETSC_INTERN PetscErrorCode PgClock(MPI_Comm comm, PetscReal *seconds);
PETSC_INTERN PetscErrorCode PgClockSince(MPI_Comm comm, PetscReal start, PetscReal *seconds); /* largest of all ranks */
PETSC_INTERN PetscReal      PgMedian(PetscInt n, PetscReal value[]);                          /* sorts them */

/* ---- study.c ---- */

enum { PG_STUDY_LIST = 64 };
typedef struct {
  PetscInt count, value[PG_STUDY_LIST];
} PgIntList;

typedef struct {
  const char *name, *summary;
  PetscErrorCode (*options)(PgStudy study, PetscOptionItems *PetscOptionsObject);
  PetscErrorCode (*run)(PgStudy study);
} PgStudyKind;
PETSC_INTERN const PgStudyKind PgStudySolvers, PgStudyMms, PgStudyExplicit, PgStudyStepping;

struct PgStudy_s {
  MPI_Comm     comm;
  PetscInt     kind;
  PgTableFiles files;
  PetscBool    help;

  /* solvers, stepping */
  char            solver_file[PETSC_MAX_PATH_LEN], only[512], load[8 * PETSC_MAX_PATH_LEN];
  PgIntList       sizes;
  PetscBool       sizes_set;
  PgSystemChoices system;
  PgSolveChoices  solve;
  /* mms */
  PetscInt  columns, levels; /* points across the coarsest square, refinements */
  PetscReal mms_jitter;      /* in spacings */
  /* explicit */
  PgIntList at, sweeps;
  PetscReal stretch; /* [s] */
  PetscInt  samples;
  char      variants[512];
  /* stepping */
  PetscInt steps, skip, windows;
};

/* A list of whole numbers separated by commas, each in [lower, upper]. */
PETSC_INTERN PetscErrorCode PgOptionIntList(PetscOptionItems *PetscOptionsObject, const char name[], const char text[],
                                            PetscInt lower, PetscInt upper, PgIntList *list, PetscBool *set);
/* cost.c: the second part of -study explicit. */
PETSC_INTERN PetscErrorCode PgStudyCost(PgStudy study);
/* Names of solvers: -study_solvers, -study_only. */
PETSC_INTERN PetscErrorCode PgStudySolverOptions(PgStudy study, PetscOptionItems *PetscOptionsObject);
