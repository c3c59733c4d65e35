/* Kernel functions in a form the coefficient loop can inline. */
#pragma once

#include <porograin/sph.h>

#define PG_CUBIC_SPLINE_CONSTANT (10.0 / (7.0 * PETSC_PI)) /* sigma of Eq. 63 for two dimensions */

static inline PetscReal PgCubicSplineW(PetscReal q)
{
  const PetscReal tail = 2.0 - q;
  const PetscReal core = 1.0 - q * q * (1.5 - 0.75 * q);
  return PG_CUBIC_SPLINE_CONSTANT * (q <= 1.0 ? core : (q < 2.0 ? 0.25 * tail * tail * tail : 0.0));
}

static inline PetscReal PgCubicSplineDW(PetscReal q)
{
  const PetscReal tail = 2.0 - q;
  const PetscReal core = -q * (3.0 - 2.25 * q);
  return PG_CUBIC_SPLINE_CONSTANT * (q <= 1.0 ? core : (q < 2.0 ? -0.75 * tail * tail : 0.0));
}
