/* Corrected operators: a gradient exact for linear fields and a Laplacian exact for quadratic ones, each
   as a correction of the paper's weights. Rows whose neighbours do not determine the correction keep the
   plain form and are counted. */
#include "sphimpl.h"

/* A correction that multiplies the weights by more than this comes from neighbours on nearly one line, or
   on one side: it would amplify noise more than it removes error. A disc on a straight edge of a lattice
   needs about 2, one in a corner about 4. */
static const PetscReal largest_gradient_correction  = 10.0;
static const PetscReal largest_laplacian_correction = 5.0;

PG_CLONES PetscErrorCode PgSphCorrectGradient(PgSph sph)
{
  const PgRowList  list     = sph->list;
  PetscReal *const gradient = sph->gradient, *x;
  PetscInt         owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(sph->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(sph->particles, PG_POSITION, &x));
  for (PetscInt a = 0; a < owned; a++) {
    const PetscInt begin = list.ptr[a], end = list.ptr[a + 1];
    const PgReal2  here = PgTwo(x, a);
    PgReal2        mx = {0, 0}, my = {0, 0}, cx, cy; /* sum gradient dx, sum gradient dy; what takes their place */
    PetscReal      det, norm;

    for (PetscInt k = begin; k < end; k++) {
      const PetscInt b = list.col[k];
      const PgReal2  g = PgTwo(gradient, k), d = PgTwo(x, b) - here;
      mx += g * d[0];
      my += g * d[1];
    }
    det  = mx[0] * my[1] - my[0] * mx[1];
    norm = PetscSqrtReal(mx[0] * mx[0] + my[0] * my[0] + mx[1] * mx[1] +
                         my[1] * my[1]); /* of the inverse, times |det| */
    if (!(PetscAbsReal(det) * largest_gradient_correction > norm)) {
      sph->gradient_fallbacks++;
      continue;
    }
    cx = (PgReal2){my[1], -mx[1]} / det;
    cy = (PgReal2){-my[0], mx[0]} / det;
    for (PetscInt k = begin; k < end; k++) {
      const PgReal2 g     = cx * gradient[2 * k] + cy * gradient[2 * k + 1];
      gradient[2 * k]     = g[0];
      gradient[2 * k + 1] = g[1];
    }
  }
  PetscFunctionReturn(0);
}

enum { MOMENTS = 5 };

static void Moments(PetscReal dx, PetscReal dy, PetscReal p[MOMENTS])
{
  p[0] = dx;
  p[1] = dy;
  p[2] = dx * dx;
  p[3] = dx * dy;
  p[4] = dy * dy;
}

/* Solves s y = t by Cholesky; false when s is singular for practical purposes. */
static PetscBool SolveMoments(PetscReal s[MOMENTS][MOMENTS], PetscReal t[MOMENTS])
{
  PetscReal scale = 0.0;

  for (int i = 0; i < MOMENTS; i++) scale = PetscMax(scale, s[i][i]);
  for (int i = 0; i < MOMENTS; i++) {
    for (int j = 0; j <= i; j++) {
      PetscReal v = s[i][j];
      for (int k = 0; k < j; k++) v -= s[i][k] * s[j][k];
      if (i == j) {
        /* coordinates are in units of h: a pivot this small means the moment is not sampled */
        if (!(v > 1e-8 * scale)) return PETSC_FALSE;
        s[i][i] = PetscSqrtReal(v);
      } else {
        s[i][j] = v / s[j][j];
      }
    }
  }
  for (int i = 0; i < MOMENTS; i++) {
    for (int k = 0; k < i; k++) t[i] -= s[i][k] * t[k];
    t[i] /= s[i][i];
  }
  for (int i = MOMENTS - 1; i >= 0; i--) {
    for (int k = i + 1; k < MOMENTS; k++) t[i] -= s[k][i] * t[k];
    t[i] /= s[i][i];
  }
  return PETSC_TRUE;
}

/* lap f = sum w_b (f_b - f_a) with w_b = k_b y.P(r_b), k_b the paper's weights and P the first and second
   moments: y makes the sum exact for x, y, x^2, xy, y^2 (the moment conditions of generalised finite
   differences). Lengths are in units of h_a. */
static PetscBool CorrectRow(PgSph sph, const PetscReal *x, PetscInt a, PetscReal h)
{
  const PgRowList list                = sph->list;
  PetscReal       s[MOMENTS][MOMENTS] = {{0}}, y[MOMENTS] = {0, 0, 2.0 / (h * h), 0, 2.0 / (h * h)}, p[MOMENTS];
  PetscReal       before = 0.0, after = 0.0;

  for (PetscInt k = list.ptr[a]; k < list.ptr[a + 1]; k++) {
    const PetscInt  b = list.col[k];
    const PetscReal w = -sph->laplacian[k];
    Moments((x[2 * b] - x[2 * a]) / h, (x[2 * b + 1] - x[2 * a + 1]) / h, p);
    for (int i = 0; i < MOMENTS; i++)
      for (int j = 0; j <= i; j++) s[i][j] += w * p[i] * p[j];
    before += w;
  }
  if (!SolveMoments(s, y)) return PETSC_FALSE;
  for (int pass = 0; pass < 2; pass++) {
    for (PetscInt k = list.ptr[a]; k < list.ptr[a + 1]; k++) {
      const PetscInt b = list.col[k];
      PetscReal      f = 0.0;
      Moments((x[2 * b] - x[2 * a]) / h, (x[2 * b + 1] - x[2 * a + 1]) / h, p);
      for (int i = 0; i < MOMENTS; i++) f += y[i] * p[i];
      if (pass == 0)
        after += PetscAbsReal(f * sph->laplacian[k]);
      else
        sph->laplacian[k] *= f;
    }
    if (!(after <= largest_laplacian_correction * before)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

PetscErrorCode PgSphCorrectLaplacian(PgSph sph)
{
  PetscReal *x, *radius;
  PetscInt   owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(sph->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(sph->particles, PG_POSITION, &x));
  PetscCall(PgParticlesGetArray(sph->particles, PG_RADIUS, &radius));
  for (PetscInt a = 0; a < owned; a++)
    if (!CorrectRow(sph, x, a, sph->smoothing * radius[a])) sph->laplacian_fallbacks++;
  PetscFunctionReturn(0);
}
