/* What the problems of the saturated continuum share: one object, set up by its problem, stepped by up.c. */
#pragma once

#include "casesimpl.h"

typedef struct PgUpProblem_s PgUpProblem;

/* What -dt and its kin say. */
typedef struct {
  PetscReal dt, end;        /* [s], 0: of the problem */
  PetscReal every, history; /* between snapshots, between rows [s], < 0: default */
  PetscInt  steps;
  PgOutput  output; /* NULL: none */
} PgUpRunSettings;

struct PgUp_s {
  MPI_Comm           comm;
  const PgUpProblem *problem;
  PgFem              fem;
  PetscReal          size[2];         /* of the rectangle [m] */
  PetscReal          low[2], high[2]; /* of the mesh [m] */
  PetscReal          load;            /* [Pa] or [N/m] */
  PetscReal          width;           /* of what is loaded [m] */
  PetscReal          dt, end;         /* [s] */
  PetscReal          probe[2];        /* where the pressure of the history is taken [m] */
  PgUpRunSettings    run;
  PetscBool          drained; /* up_footing: the surface lets water out */
};

struct PgUpProblem_s {
  const char *name, *defaults;
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

/* Displacement along y of the node nearest to x, downward; the same on all ranks. Collective. */
PETSC_INTERN PetscErrorCode PgUpSettlementAt(PgUp up, const PetscReal x[2], PetscReal *settlement);
