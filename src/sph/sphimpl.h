/* What the files of this room share. */
#pragma once

#include <porograin/sph.h>

struct PgSph_s {
  PgParticles particles;
  PgNeighbors neighbors;

  /* choices */
  const PgKernel *kernel;
  PetscBool       cubic;     /* kernel is the cubic spline: the inlined loop */
  PetscReal       smoothing; /* h_a/r_a; a pair uses the mean of h_a and h_b */
  PetscReal       eta;       /* in r^2 + eta h^2 of Eq. 52 */
  PgSphOperators  gradient_kind, laplacian_kind;

  PgField volume;

  /* coefficients of the present geometry, by entry of the row list */
  PetscInt   entries, rows;        /* capacity */
  PetscReal *gradient, *laplacian; /* (2), (1) */
  PetscReal *weight;               /* (1) */
  PetscReal *kernel_sum;           /* by owned disc */
  PgRowList  list;
  PetscInt   gradient_fallbacks, laplacian_fallbacks; /* of this rank */
};

PETSC_INTERN PetscErrorCode PgSphCorrectGradient(PgSph sph);
PETSC_INTERN PetscErrorCode PgSphCorrectLaplacian(PgSph sph);
