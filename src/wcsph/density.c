/* Density: continuity (T64), diffusion (T66), summation (Eq. 26). */
#include "wcsphimpl.h"

/* What partner b adds to d rho_a/dt over v_ab.grad W, so that the work of the pressure is what is stored (T65). */
static inline PetscReal Carried(PgWcsph w, const PgWcsphArrays *f, PgWcsphPair pair, PetscInt a, PetscInt b)
{
  if (pair == PG_PAIR_LIQUID || w->solid == PG_WCSPH_OWN) return f->m[b];
  return (w->solid == PG_WCSPH_MIRROR ? 2.0 : 1.0) * w->dx * w->dx * f->rho[a];
}

static inline PetscBool HasDensity(PgWcsph w, const PgWcsphArrays *f, PetscInt a)
{
  return (PetscBool)(PgWcsphIsLiquid(f, a) || w->solid == PG_WCSPH_OWN);
}

/* Rate of volume of solid particles, dx^2 sum V_i v_ki.grad W, over the sum of W: each W of it goes to a partner. */
static PetscErrorCode SolidRate(PgWcsph w, const PgWcsphArrays *f)
{
  PetscFunctionBeginUser;
  for (PetscInt a = 0; a < f->owned; a++) {
    const PgReal2 v_a = PgTwo(f->v, a);
    PetscReal     sum = 0.0, rate = 0.0;

    if (PgWcsphIsLiquid(f, a)) continue;
    for (PetscInt k = w->list.ptr[a]; k < w->list.ptr[a + 1]; k++) {
      const PetscInt i = w->list.col[k];
      if (w->pair[k] != PG_PAIR_OF_SOLID) continue;
      rate += f->m[i] / f->rho[i] * (PgDot(v_a - PgTwo(f->v, i), PgWcsphR(f, a, i)) * w->slope[k]);
      sum += w->weight[k];
    }
    f->solid_rate[a] = sum > 0.0 ? w->dx * w->dx * rate / sum : 0.0;
  }
  PetscCall(PgStagePush(PG_STAGE_HALO));
  PetscCall(PgParticlesHalo(w->particles, 1, &w->solid_rate));
  PetscCall(PgStagePop());
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphDensityRate(PgWcsph w, PetscReal rate[])
{
  const PetscBool adjoint = (PetscBool)(w->solid == PG_WCSPH_ADJOINT);
  PgWcsphArrays   f;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetArrays(w, &f));
  if (adjoint) PetscCall(SolidRate(w, &f));
  for (PetscInt a = 0; a < f.owned; a++) {
    const PgReal2   v_a   = PgTwo(f.v, a);
    const PetscReal share = f.rho[a] * f.rho[a] / f.m[a];
    PetscReal       sum   = 0.0;

    rate[a] = 0.0;
    if (!HasDensity(w, &f, a)) continue;
    for (PetscInt k = w->list.ptr[a]; k < w->list.ptr[a + 1]; k++) {
      const PetscInt    b    = w->list.col[k];
      const PgWcsphPair pair = (PgWcsphPair)w->pair[k];
      if (pair > PG_PAIR_OF_SOLID) continue;
      sum += Carried(w, &f, pair, a, b) * (PgDot(v_a - PgTwo(f.v, b), PgWcsphR(&f, a, b)) * w->slope[k]);
      if (adjoint && pair == PG_PAIR_AT_SOLID) sum += share * (w->weight[k] * f.solid_rate[b]);
    }
    rate[a] = sum;
  }
  PetscFunctionReturn(0);
}

/* delta h c_0 sum 2 (rho_b - rho_a - drho^H) r_ba.grad W V/r^2: between particles that have a density of their own. What
   differs by gravity alone, drho^H, does not diffuse. */
PetscErrorCode PgWcsphAddDiffusion(PgWcsph w, PetscReal rate[])
{
  const PetscReal factor = -2.0 * w->delta * w->h * w->c_0 * w->dx * w->dx;
  const PgReal2   g      = PgTwo(w->gravity, 0);
  PgWcsphArrays   f;

  PetscFunctionBeginUser;
  if (w->delta == 0.0) PetscFunctionReturn(0);
  PetscCall(PgWcsphGetArrays(w, &f));
  for (PetscInt a = 0; a < f.owned; a++) {
    PetscReal sum = 0.0;

    if (!HasDensity(w, &f, a)) continue;
    for (PetscInt k = w->list.ptr[a]; k < w->list.ptr[a + 1]; k++) {
      const PetscInt  b    = w->list.col[k];
      const PetscReal mean = 0.5 * (f.rho[a] + f.rho[b]);
      if (w->pair[k] == PG_PAIR_SOLIDS || !HasDensity(w, &f, b)) continue;
      sum += w->slope[k] * ((f.rho[b] - f.rho[a]) + mean * PgDot(g, PgWcsphR(&f, a, b)) / PgWcsphSound2(w, mean));
    }
    rate[a] += factor * sum;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphSumDensity(PgWcsph w)
{
  const PetscReal self = w->kernel->w(0.0) / (w->h * w->h);
  PgWcsphArrays   f;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetArrays(w, &f));
  for (PetscInt a = 0; a < f.owned; a++) {
    PetscReal sum = self;

    if (!HasDensity(w, &f, a)) continue;
    for (PetscInt k = w->list.ptr[a]; k < w->list.ptr[a + 1]; k++) sum += w->weight[k];
    f.rho[a] = f.m[a] * sum;
  }
  PetscFunctionReturn(0);
}
