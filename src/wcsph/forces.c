/* Forces of pairs (T67): pressure and viscosity, Eq. 35. Each is computed in the row of both particles, to the same bits
   with opposite sign. */
#include "wcsphimpl.h"

/* m_a m_b (p_a/rho_a^2 + p_b/rho_b^2), or what stands for it. */
static inline PetscReal PressureTerm(PgWcsph w, const PgWcsphArrays *f, PgWcsphPair pair, PetscInt a, PetscInt b)
{
  const PetscReal V = w->dx * w->dx;
  PetscInt        i = a, k = b;

  if (pair == PG_PAIR_SOLIDS && !(w->solid == PG_WCSPH_OWN && w->density == PG_WCSPH_SUMMATION))
    return V * V * (f->contact_pressure[a] + f->contact_pressure[b]);
  if (pair == PG_PAIR_LIQUID || w->solid == PG_WCSPH_OWN)
    return f->m[a] * f->m[b] * (f->p[a] / (f->rho[a] * f->rho[a]) + f->p[b] / (f->rho[b] * f->rho[b]));
  if (pair == PG_PAIR_OF_SOLID) {
    i = b;
    k = a;
  }
  if (w->solid == PG_WCSPH_MIRROR)
    return f->m[i] * V * (2.0 * f->p[i] / f->rho[i] + PgDot(PgTwo(w->gravity, 0), PgWcsphR(f, k, i)));
  if (w->solid == PG_WCSPH_ADJOINT) return f->m[i] * V / f->rho[i] * (f->p[i] + f->p[k]);
  return f->m[i] * V * f->rho[k] * (f->p[i] / (f->rho[i] * f->rho[i]) + f->p[k] / (f->rho[k] * f->rho[k]));
}

/* Velocity and volume of a particle in the viscous term. */
static inline PgReal2 ViscousVelocity(const PgWcsphArrays *f, PetscInt a, PgWcsphPair pair)
{
  return PgTwo(pair != PG_PAIR_SOLIDS && !PgWcsphIsLiquid(f, a) ? f->slip_velocity : f->v, a);
}

static inline PetscReal Volume(PgWcsph w, const PgWcsphArrays *f, PetscInt a)
{
  return PgWcsphIsLiquid(f, a) ? f->m[a] / f->rho[a] : w->dx * w->dx;
}

PetscErrorCode PgWcsphPairForces(PgWcsph w)
{
  PgWcsphArrays f;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetArrays(w, &f));
  for (PetscInt a = 0; a < f.owned; a++) {
    PgReal2 force = {0, 0};

    for (PetscInt k = w->list.ptr[a]; k < w->list.ptr[a + 1]; k++) {
      const PetscInt    b    = w->list.col[k];
      const PgWcsphPair pair = (PgWcsphPair)w->pair[k];
      if (pair == PG_PAIR_SAME_SOLID || w->slope[k] == 0.0) continue;
      force -= PgWcsphR(&f, a, b) * (PressureTerm(w, &f, pair, a, b) * w->slope[k]);
      if (pair == PG_PAIR_SOLIDS && !w->friction) continue;
      force += (ViscousVelocity(&f, a, pair) - ViscousVelocity(&f, b, pair)) *
               (2.0 * w->mu * (Volume(w, &f, a) * Volume(w, &f, b)) * w->slope[k]);
    }
    f.force[2 * a]     = force[0];
    f.force[2 * a + 1] = force[1];
  }
  PetscFunctionReturn(0);
}
