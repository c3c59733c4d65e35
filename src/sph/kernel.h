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

#define PG_QUINTIC_SPLINE_CONSTANT (7.0 / (478.0 * PETSC_PI)) /* of two dimensions, Tak, Park & Park (2013), Eq. 37 */

static inline PetscReal PgFifthPower(PetscReal t)
{
  const PetscReal t2 = t * t;
  return t2 * t2 * t;
}

static inline PetscReal PgFourthPower(PetscReal t)
{
  const PetscReal t2 = t * t;
  return t2 * t2;
}

static inline PetscReal PgQuinticSplineW(PetscReal q)
{
  PetscReal w = q < 3.0 ? PgFifthPower(3.0 - q) : 0.0;
  if (q < 2.0) w -= 6.0 * PgFifthPower(2.0 - q);
  if (q < 1.0) w += 15.0 * PgFifthPower(1.0 - q);
  return PG_QUINTIC_SPLINE_CONSTANT * w;
}

static inline PetscReal PgQuinticSplineDW(PetscReal q)
{
  PetscReal w = q < 3.0 ? PgFourthPower(3.0 - q) : 0.0;
  if (q < 2.0) w -= 6.0 * PgFourthPower(2.0 - q);
  if (q < 1.0) w += 15.0 * PgFourthPower(1.0 - q);
  return -5.0 * PG_QUINTIC_SPLINE_CONSTANT * w;
}
