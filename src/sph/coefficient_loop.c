/* Pair coefficients of all rows at once: the most expensive part of a fluid step after the solve.

   Built with -fno-math-errno -fno-trapping-math: they let the compiler vectorise the square root and the
   comparisons and change no value. The arithmetic of r_ab -> coefficient is odd or even in r_ab, so that
   both discs of a pair, on whatever rank, get exactly opposite gradients and equal Laplacian weights. */
#include "kernel.h"
#include "sphimpl.h"

typedef struct {
  const PetscInt  *ptr, *col;
  const PetscReal *x, *radius, *volume;
  PetscReal        half_smoothing, eta;
} Geometry;

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
  #define PG_CLONES __attribute__((target_clones("avx2", "default")))
#else
  #define PG_CLONES
#endif

/* Entries of one row. The kernel arrives as constant function pointers and is inlined. */
static inline __attribute__((always_inline)) PetscReal Row(const Geometry *g, PetscInt a, PetscReal *restrict gradient,
                                                           PetscReal *restrict laplacian, PetscReal *restrict weight,
                                                           PetscReal (*w)(PetscReal), PetscReal (*dw)(PetscReal))
{
  const PetscInt        begin = g->ptr[a], n = g->ptr[a + 1] - begin;
  const PetscInt *const col = g->col + begin;
  const PetscReal       xa = g->x[2 * a], ya = g->x[2 * a + 1], ra = g->radius[a], self = 2.0 * g->half_smoothing * ra;
  PetscReal             sum = w(0.0) / (self * self) * g->volume[a];

  for (PetscInt k = 0; k < n; k++) {
    const PetscInt  b  = col[k];
    const PetscReal dx = xa - g->x[2 * b], dy = ya - g->x[2 * b + 1], dv = g->volume[b];
    const PetscReal h = g->half_smoothing * (ra + g->radius[b]), r2 = dx * dx + dy * dy, r = PetscSqrtReal(r2);
    const PetscReal ih = 1.0 / h, q = r * ih;
    const PetscReal f             = dw(q) * ih * ih * ih / r * dv; /* (dW/dr)/r dV_b */
    gradient[2 * (begin + k)]     = f * dx;
    gradient[2 * (begin + k) + 1] = f * dy;
    laplacian[begin + k]          = 2.0 * f * r2 / (r2 + g->eta * h * h);
    weight[begin + k]             = w(q) * ih * ih * dv;
  }
  for (PetscInt k = 0; k < n; k++) sum += weight[begin + k];
  return sum;
}

PG_CLONES static void CubicSplineRows(const Geometry *g, PetscInt rows, PetscReal *gradient, PetscReal *laplacian,
                                      PetscReal *kernel_sum, PetscReal *weight)
{
  for (PetscInt a = 0; a < rows; a++)
    kernel_sum[a] = Row(g, a, gradient, laplacian, weight, PgCubicSplineW, PgCubicSplineDW);
}

static void AnyRows(const Geometry *g, const PgKernel *kernel, PetscInt rows, PetscReal *gradient, PetscReal *laplacian,
                    PetscReal *kernel_sum, PetscReal *weight)
{
  for (PetscInt a = 0; a < rows; a++) kernel_sum[a] = Row(g, a, gradient, laplacian, weight, kernel->w, kernel->dw);
}

static PetscErrorCode Reserve(PgSph sph, PetscInt rows, PetscInt entries)
{
  PetscFunctionBeginUser;
  if (entries > sph->entries || !sph->gradient) {
    sph->entries = entries + entries / 8 + 1;
    PetscCall(PetscFree(sph->gradient));
    PetscCall(PetscFree(sph->laplacian));
    PetscCall(PetscFree(sph->weight));
    PetscCall(PetscMalloc1(2 * sph->entries, &sph->gradient));
    PetscCall(PetscMalloc1(sph->entries, &sph->laplacian));
    PetscCall(PetscMalloc1(sph->entries, &sph->weight));
  }
  if (rows > sph->rows || !sph->kernel_sum) {
    sph->rows = rows + rows / 8 + 1;
    PetscCall(PetscFree(sph->kernel_sum));
    PetscCall(PetscMalloc1(sph->rows, &sph->kernel_sum));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgSphUpdate(PgSph sph)
{
  PetscReal *x, *radius, *volume;
  PetscInt   owned;
  Geometry   g;

  PetscFunctionBeginUser;
  PetscCall(PgNeighborsGetRows(sph->neighbors, &sph->list));
  PetscCall(PgParticlesGetSizes(sph->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(sph->particles, PG_POSITION, &x));
  PetscCall(PgParticlesGetArray(sph->particles, PG_RADIUS, &radius));
  PetscCall(PgParticlesGetArray(sph->particles, sph->volume, &volume));
  PetscCall(Reserve(sph, owned, sph->list.ptr[owned]));
  g = (Geometry){sph->list.ptr, sph->list.col, x, radius, volume, 0.5 * sph->smoothing, sph->eta};
  if (sph->cubic)
    CubicSplineRows(&g, owned, sph->gradient, sph->laplacian, sph->kernel_sum, sph->weight);
  else
    AnyRows(&g, sph->kernel, owned, sph->gradient, sph->laplacian, sph->kernel_sum, sph->weight);
  sph->gradient_fallbacks = sph->laplacian_fallbacks = 0;
  if (sph->laplacian_kind == PG_SPH_CORRECTED) PetscCall(PgSphCorrectLaplacian(sph));
  if (sph->gradient_kind == PG_SPH_CORRECTED) PetscCall(PgSphCorrectGradient(sph));
  PetscFunctionReturn(0);
}
