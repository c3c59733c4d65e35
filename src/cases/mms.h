/* What the cases of manufactured solutions share: packings that are refined, the options that say how, and the judgement
   of the orders that come out. */
#pragma once

#include "casesimpl.h"
#include <porograin/io.h>

/* One packing with its lists, operators and, where asked for, the pressure equation. */
typedef struct {
  MPI_Comm     comm;
  PgMmsPacking packing;
  PetscInt     rows;
  PetscReal    radius, width; /* half the spacing; 2 radius points */
  PetscReal    reach;         /* of the kernel, in radii: 2h/r */
  PetscReal    h;             /* smoothing length */
  PetscReal    k_gradient, k_laplacian;
  PgParticles  particles;
  PgNeighbors  neighbors;
  PgSph        sph;
  PgPressure   pressure; /* NULL when not asked for */
} PgMmsSet;

/* Reads the options of all it makes. `frame`: as wide as makes the discs whose kernel is full fill a square of width 1,
   otherwise the whole packing has width 1. Collective. */
PETSC_INTERN PetscErrorCode PgMmsSetCreate(MPI_Comm comm, const PgMmsPacking *packing, PetscBool pressure,
                                           PetscBool frame, PgMmsSet *set);
PETSC_INTERN PetscErrorCode PgMmsSetDestroy(PgMmsSet *set);
/* Whether the kernel of the disc with this id is full, the displacements being what they may. */
PETSC_INTERN PetscBool PgMmsIsFull(const PgMmsSet *set, PetscInt id);

typedef struct {
  PetscReal low[2], length[2];
} PgMmsBox;
/* sin(pi X) sin(pi Y), X and Y running from 0 to 1 in the box, and a linear part. */
PETSC_INTERN PetscReal PgMmsHill(const PgMmsBox *box, const PetscReal x[2]);
PETSC_INTERN PetscReal PgMmsHillOnSlope(const PgMmsBox *box, const PetscReal x[2]);
PETSC_INTERN void      PgMmsHillGradient(const PgMmsBox *box, const PetscReal x[2], PetscReal grad[2]);
PETSC_INTERN PetscReal PgMmsHillLaplacian(const PgMmsBox *box, const PetscReal x[2]);

/* ---- the study of one choice of operators ---- */

typedef struct {
  PgMmsPacking packing; /* of the coarsest square */
  PetscInt     levels;
  PetscInt     sides; /* PgMmsSides */
} PgMmsPlan;

enum { PG_MMS_LEVELS = 8 };
typedef struct {
  const char *what;
  PetscReal   expected, below, above; /* order, and by how much it may be missed */
  PetscInt    count;
  PetscReal   h[PG_MMS_LEVELS], error[PG_MMS_LEVELS];
} PgMmsSequence;

/* Reads -mms_points, -mms_levels, -mms_jitter, -mms_seed and, with `pressure`, -mms_sides; to be freed by
   PgCaseDestroyContext(). Collective. */
PETSC_INTERN PetscErrorCode PgMmsPlanCreate(MPI_Comm comm, PetscBool pressure, void **context);
PETSC_INTERN PgMmsPacking   PgMmsLevel(const PgMmsPlan *plan, PetscInt level);
PETSC_INTERN void           PgMmsAdd(PgMmsSequence *s, PetscReal h, PetscReal error);
/* Between the last two squares; NaN with one. */
PETSC_INTERN PetscReal PgMmsOrder(const PgMmsSequence *s);
/* Says of each sequence whether its order is the expected one, and fails when one is not. Collective. */
PETSC_INTERN PetscErrorCode PgMmsJudge(MPI_Comm comm, const char name[], PetscInt count, const PgMmsSequence s[]);
