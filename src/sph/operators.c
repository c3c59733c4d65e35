/* The operators: one pass over the row list each, in ascending id of the neighbour. */
#include "sphimpl.h"

PetscErrorCode PgSphGradient(PgSph sph, const PetscReal f[], PetscReal grad[])
{
  const PetscReal *g = sph->gradient;
  PetscInt         owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(sph->particles, &owned, NULL, NULL));
  for (PetscInt a = 0; a < owned; a++) {
    PetscReal sx = 0.0, sy = 0.0;
    for (PetscInt k = sph->list.ptr[a]; k < sph->list.ptr[a + 1]; k++) {
      const PetscReal d = f[sph->list.col[k]] - f[a];
      sx += g[2 * k] * d;
      sy += g[2 * k + 1] * d;
    }
    grad[2 * a]     = sx;
    grad[2 * a + 1] = sy;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgSphVectorGradient(PgSph sph, const PetscReal u[], PetscReal grad[])
{
  const PetscReal *g = sph->gradient;
  PetscInt         owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(sph->particles, &owned, NULL, NULL));
  for (PetscInt a = 0; a < owned; a++) {
    PetscReal xx = 0.0, xy = 0.0, yx = 0.0, yy = 0.0;
    for (PetscInt k = sph->list.ptr[a]; k < sph->list.ptr[a + 1]; k++) {
      const PetscInt  b  = sph->list.col[k];
      const PetscReal du = u[2 * b] - u[2 * a], dv = u[2 * b + 1] - u[2 * a + 1];
      xx += g[2 * k] * du;
      xy += g[2 * k + 1] * du;
      yx += g[2 * k] * dv;
      yy += g[2 * k + 1] * dv;
    }
    grad[4 * a]     = xx;
    grad[4 * a + 1] = xy;
    grad[4 * a + 2] = yx;
    grad[4 * a + 3] = yy;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgSphDivergence(PgSph sph, const PetscReal u[], PetscReal div[])
{
  const PetscReal *g = sph->gradient;
  PetscInt         owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(sph->particles, &owned, NULL, NULL));
  for (PetscInt a = 0; a < owned; a++) {
    PetscReal s = 0.0;
    for (PetscInt k = sph->list.ptr[a]; k < sph->list.ptr[a + 1]; k++) {
      const PetscInt b = sph->list.col[k];
      s += g[2 * k] * (u[2 * b] - u[2 * a]) + g[2 * k + 1] * (u[2 * b + 1] - u[2 * a + 1]);
    }
    div[a] = s;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgSphLaplacian(PgSph sph, const PetscReal f[], PetscReal lap[])
{
  PetscInt owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(sph->particles, &owned, NULL, NULL));
  for (PetscInt a = 0; a < owned; a++) {
    PetscReal s = 0.0;
    for (PetscInt k = sph->list.ptr[a]; k < sph->list.ptr[a + 1]; k++)
      s += sph->laplacian[k] * (f[a] - f[sph->list.col[k]]);
    lap[a] = s;
  }
  PetscFunctionReturn(0);
}
