/* What the problems of the saturated continuum share: one object, set up by its problem, stepped by up.c. */
#pragma once

#include "run.h"

typedef struct PgUpProblem_s PgUpProblem;

/* Checkpoints: where, how often, and what the results were. */
typedef struct {
  char         checkpoint[PETSC_MAX_PATH_LEN], restart[PETSC_MAX_PATH_LEN]; /* empty: none */
  PetscReal    every;                                                       /* [s], < 0: default */
  PetscInt     held;                                                        /* step of the last one, -1: none */
  PetscBool    written; /* by this program, that is: into `checkpoint` */
  PgFemResults before;  /* results of the run that goes on, or at the last checkpoint */
} PgUpRestartSettings;

struct PgUp_s {
  MPI_Comm            comm;
  const PgUpProblem  *problem;
  PgFem               fem;
  PetscReal           size[2];         /* of the rectangle [m] */
  PetscReal           low[2], high[2]; /* of the mesh [m] */
  PetscReal           load;            /* [Pa] or [N/m] */
  PetscReal           width;           /* of what is loaded [m] */
  PetscReal           dt, end;         /* [s] */
  PetscReal           probe[2];        /* where the pressure of the history is taken [m] */
  PgCaseRun           run;
  PgSolves            solves;
  PgUpRestartSettings again;
  PetscBool           drained; /* up_footing: the surface lets water out */
};

struct PgUpProblem_s {
  const char *name, *title, *defaults; /* title: of its options in the help */
  PetscInt    cells[2];
  PetscReal   size[2], load, width;
  PetscErrorCode (*create)(PgUp up, PetscOptionItems *PetscOptionsObject); /* reads options */
  PetscErrorCode (*conditions)(PgUp up);
  PetscErrorCode (*prepare)(PgUp up); /* the mesh is there: probe, default dt and end */
  /* Settlement that the history shows, positive downward [m]. Collective. */
  PetscErrorCode (*settlement)(PgUp up, PetscReal *settlement);
};

PETSC_INTERN const PgUpProblem PgUpTerzaghi, PgUpMandel, PgUpFooting;
PETSC_INTERN PetscErrorCode    PgUpCreateProblem(MPI_Comm comm, const PgUpProblem *problem, PgUp *up);

/* up_restart.c: checkpoints of a run whose steps have been chosen. All collective. */
PETSC_INTERN PetscErrorCode PgUpRestartOptions(void *up, PetscOptionItems *PetscOptionsObject);
PETSC_INTERN PetscErrorCode PgUpCheckPlaces(PgUp up, const char output[]);
PETSC_INTERN PetscErrorCode PgUpRestart(PgUp up);
/* Writes one when it is due after this step, or what ends the run asks for it. */
PETSC_INTERN PetscErrorCode PgUpCheckpoint(PgUp up, PetscInt step);

/* Displacement along y of the node nearest to x, downward; the same on all ranks. Collective. */
PETSC_INTERN PetscErrorCode PgUpSettlementAt(PgUp up, const PetscReal x[2], PetscReal *settlement);
