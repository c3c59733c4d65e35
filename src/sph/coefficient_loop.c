/* Pair coefficients of all rows at once: the most expensive part of a fluid step after the solve. What both discs of a
   pair share is computed once for the pair and written to the rows of both.

   Built with -fno-math-errno -fno-trapping-math: they let the compiler vectorise the square root and the
   comparisons and change no value. The arithmetic of r_ab -> coefficient is odd or even in r_ab, so that
   both discs of a pair, on whatever rank, get the coefficients that the other rank computes for its copy of the pair. */
#include "kernel.h"
#include "sphimpl.h"

typedef struct {
  const PetscReal *x, *radius, *volume;
  PetscReal        half_smoothing, eta;
} Geometry;

/* A block of pairs in short arrays that stay in the first-level cache. */
enum { BLOCK = 128 };
typedef struct {
  PetscReal d[2 * BLOCK], h[BLOCK];             /* r_ab [m], mean smoothing length [m] */
  PetscReal g[2 * BLOCK], lap[BLOCK], w[BLOCK]; /* grad_a W, c_ab, W */
} Block;

static inline __attribute__((always_inline)) void Load(const Geometry *g, PetscInt n, const PetscInt one[],
                                                       const PetscInt two[], Block *p)
{
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt a = one[i], b = two[i];
    const PgReal2  d = PgTwo(g->x, a) - PgTwo(g->x, b);

    p->d[2 * i]     = d[0];
    p->d[2 * i + 1] = d[1];
    p->h[i]         = g->half_smoothing * (g->radius[a] + g->radius[b]);
  }
}

/* The kernel arrives as constant function pointers and is inlined. One division for all three quotients. */
static inline __attribute__((always_inline)) void Kernel(PetscInt n, PetscReal eta, Block *p, PetscReal (*w)(PetscReal),
                                                         PetscReal (*dw)(PetscReal))
{
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal dx = p->d[2 * i], dy = p->d[2 * i + 1], h = p->h[i], r2 = dx * dx + dy * dy, r = PetscSqrtReal(r2);
    const PetscReal soft = r2 + eta * h * h, hr = h * r, inverse = 1.0 / (hr * soft);
    const PetscReal ih = r * soft * inverse, q = r * ih;
    const PetscReal f = dw(q) * ih * ih * (inverse * soft * h) * ih; /* (dW/dr)/r */

    p->g[2 * i]     = f * dx;
    p->g[2 * i + 1] = f * dy;
    p->lap[i]       = 2.0 * f * r2 * (inverse * hr);
    p->w[i]         = w(q) * ih * ih;
  }
}

static inline __attribute__((always_inline)) void Store(const PgRowList *list, PetscInt first, PetscInt n,
                                                        const Block *p, const PetscReal volume[], PetscReal gradient[],
                                                        PetscReal laplacian[], PetscReal weight[])
{
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt  ka = list->one_at[first + i], kb = list->two_at[first + i];
    const PetscReal va = volume[list->one[first + i]], vb = volume[list->two[first + i]];
    const PgReal2   ga = PgTwo(p->g, i) * vb, gb = PgTwo(p->g, i) * -va;

    gradient[2 * ka]     = ga[0];
    gradient[2 * ka + 1] = ga[1];
    gradient[2 * kb]     = gb[0];
    gradient[2 * kb + 1] = gb[1];
    laplacian[ka]        = p->lap[i] * vb;
    laplacian[kb]        = p->lap[i] * va;
    weight[ka]           = p->w[i] * vb;
    weight[kb]           = p->w[i] * va;
  }
}

static inline __attribute__((always_inline)) void Pairs(const PgRowList *list, const Geometry *g, PetscReal gradient[],
                                                        PetscReal laplacian[], PetscReal weight[],
                                                        PetscReal (*w)(PetscReal), PetscReal (*dw)(PetscReal))
{
  Block block;

  for (PetscInt first = 0; first < list->pairs; first += BLOCK) {
    const PetscInt n = PetscMin(BLOCK, list->pairs - first);
    Load(g, n, list->one + first, list->two + first, &block);
    Kernel(n, g->eta, &block, w, dw);
    Store(list, first, n, &block, g->volume, gradient, laplacian, weight);
  }
}

PG_CLONES static void CubicSplinePairs(const PgRowList *list, const Geometry *g, PetscReal gradient[],
                                       PetscReal laplacian[], PetscReal weight[])
{
  Pairs(list, g, gradient, laplacian, weight, PgCubicSplineW, PgCubicSplineDW);
}

static void AnyPairs(const PgRowList *list, const Geometry *g, const PgKernel *kernel, PetscReal gradient[],
                     PetscReal laplacian[], PetscReal weight[])
{
  Pairs(list, g, gradient, laplacian, weight, kernel->w, kernel->dw);
}

/* sum_b W_ab dV_b, the disc itself first, then by id. */
static void SumKernel(PgSph sph, PetscInt owned, const Geometry *g)
{
  const PetscReal w0 = sph->kernel->w(0.0);

  for (PetscInt a = 0; a < owned; a++) {
    const PetscReal self = 2.0 * g->half_smoothing * g->radius[a];
    PetscReal       sum  = w0 / (self * self) * g->volume[a];
    for (PetscInt k = sph->list.ptr[a]; k < sph->list.ptr[a + 1]; k++) sum += sph->weight[k];
    sph->kernel_sum[a] = sum;
  }
}

static PetscErrorCode Reserve(PgSph sph, PetscInt rows, PetscInt entries)
{
  PetscFunctionBeginUser;
  if (entries >= sph->entries || !sph->gradient) {
    sph->entries = entries + entries / 8 + 1; /* one more, where pairs write the row that a ghost has not */
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
  g = (Geometry){x, radius, volume, 0.5 * sph->smoothing, sph->eta};
  if (sph->cubic)
    CubicSplinePairs(&sph->list, &g, sph->gradient, sph->laplacian, sph->weight);
  else
    AnyPairs(&sph->list, &g, sph->kernel, sph->gradient, sph->laplacian, sph->weight);
  SumKernel(sph, owned, &g);
  sph->gradient_fallbacks = sph->laplacian_fallbacks = 0;
  if (sph->laplacian_kind == PG_SPH_CORRECTED) PetscCall(PgSphCorrectLaplacian(sph));
  if (sph->gradient_kind == PG_SPH_CORRECTED) PetscCall(PgSphCorrectGradient(sph));
  PetscFunctionReturn(0);
}
