/* What particles of walls and bodies take from the liquid around them, and what they give. */
#include "wcsphimpl.h"

/* Solids that repel each other by their own density, Eqs. 26 and 35 taken literally, need no law of contact. */
static PetscBool ByDensity(PgWcsph w)
{
  return (PetscBool)(w->solid == PG_WCSPH_OWN && w->density == PG_WCSPH_SUMMATION);
}

PetscErrorCode PgWcsphSolidVelocity(PgWcsph w)
{
  const PetscReal V = w->dx * w->dx, K = ByDensity(w) ? 0.0 : w->contact * w->rho_0 * w->c_0 * w->c_0;
  PgWcsphArrays   f;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetArrays(w, &f));
  for (PetscInt a = 0; a < f.owned; a++) {
    PgReal2   mean = {0, 0};
    PetscReal sum = 0.0, others = 0.0;

    if (PgWcsphIsLiquid(&f, a)) continue;
    for (PetscInt k = w->list.ptr[a]; k < w->list.ptr[a + 1]; k++) {
      if (w->pair[k] == PG_PAIR_OF_SOLID) {
        mean += PgTwo(f.v, w->list.col[k]) * w->weight[k];
        sum += w->weight[k];
      } else if (w->pair[k] == PG_PAIR_SOLIDS) {
        others += w->weight[k];
      }
    }
    for (int d = 0; d < 2; d++) {
      const PetscReal v          = f.v[2 * a + d];
      f.slip_velocity[2 * a + d] = w->slip == PG_WCSPH_PLAIN || sum == 0.0 ? v : 2.0 * v - mean[d] / sum;
    }
    f.contact_pressure[a] = K * PetscMax(0.0, V * others - w->onset);
  }
  PetscFunctionReturn(0);
}

/* sum (p_i + rho_i g.(x_a - x_i)) W / sum W. */
PetscErrorCode PgWcsphSolidPressure(PgWcsph w)
{
  const PgReal2 g = PgTwo(w->gravity, 0);
  PgWcsphArrays f;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetArrays(w, &f));
  for (PetscInt a = 0; a < f.owned; a++) {
    PetscReal p = 0.0, sum = 0.0;

    if (PgWcsphIsLiquid(&f, a)) continue;
    for (PetscInt k = w->list.ptr[a]; k < w->list.ptr[a + 1]; k++) {
      const PetscInt i = w->list.col[k];
      if (w->pair[k] != PG_PAIR_OF_SOLID) continue;
      p += (f.p[i] + f.rho[i] * PgDot(g, PgWcsphR(&f, a, i))) * w->weight[k];
      sum += w->weight[k];
    }
    f.p[a]   = sum > 0.0 ? p / sum : 0.0;
    f.rho[a] = PgWcsphDensityAt(w, f.p[a]);
  }
  PetscFunctionReturn(0);
}
