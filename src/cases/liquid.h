/* What the problems of the weakly compressible liquid share: one object, filled by its problem, stepped by liquid.c. */
#pragma once

#include "run.h"

typedef struct PgLiquidProblem_s PgLiquidProblem;

struct PgLiquid_s {
  MPI_Comm               comm;
  const PgLiquidProblem *problem;
  PgWcsph                wcsph;
  PetscInt               cells, columns; /* particles across the height, and along x */
  PetscReal              jitter;         /* of the lattice, over the spacing [1] */
  PetscInt               seed;
  PetscReal              height, dx;           /* [m] */
  PetscReal              speed;                /* of the lid, or greatest of the exact flow [m/s] */
  PetscReal              rho_0, mu, c_0, g[2]; /* as the liquid has them */
  PetscBool              tank, from_rest;      /* wcsph_hydrostatic: side walls; starts without pressure */
  PgCaseRun              run;
};

struct PgLiquidProblem_s {
  const char *name, *title, *defaults;
  PetscReal   height, speed;
  PetscInt    columns;
  PetscBool   of_pressure; /* what the exact solution is of: pressure, or velocity along x */
  PetscErrorCode (*create)(PgLiquid l, PetscOptionItems *PetscOptionsObject); /* reads options */
  PetscErrorCode (*fill)(PgLiquid l);
  PetscReal (*exact)(PgLiquid l, PetscReal t, const PetscReal x[2]);
  PetscReal (*scale)(PgLiquid l); /* what the largest error is measured in */
  PetscReal (*end)(PgLiquid l);   /* default end of the run [s] */
};

PETSC_INTERN const PgLiquidProblem PgLiquidPoiseuille, PgLiquidCouette, PgLiquidHydrostatic;
PETSC_INTERN PetscErrorCode        PgLiquidCreateProblem(MPI_Comm comm, const PgLiquidProblem *problem, PgLiquid *l);

/* Particles of a lattice with its lower left corner at `low` [m]; `pressure` (NULL: none) is that of a place. */
typedef struct {
  PgWcsphKind kind;
  PetscInt    body, columns, rows;
  PetscReal   low[2], velocity[2];
  PetscReal (*pressure)(PgLiquid l, const PetscReal x[2]);
} PgLiquidBlock;
PETSC_INTERN PetscErrorCode PgLiquidAddBlock(PgLiquid l, const PgLiquidBlock *block);
/* Liquid of l->cells x l->columns particles, periodic along x, between two walls; the upper one moves along x [m/s]. */
PETSC_INTERN PetscErrorCode PgLiquidAddChannel(PgLiquid l, PetscReal speed);
/* Layers of a wall that fill the reach of the kernel. */
PETSC_INTERN PetscErrorCode PgLiquidWallLayers(PgLiquid l, PetscInt *layers);
/* sum of sin(k pi y/H) exp(-k^2 pi^2 nu t/H^2)/k^power over k = 1, 1 + stride, ..., with alternating signs or not. */
PETSC_INTERN PetscReal PgLiquidSeries(PgLiquid l, PetscReal t, PetscReal y, int stride, int power, PetscBool alternate);
