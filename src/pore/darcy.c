/* Darcy's law, Eqs. 26-29, 56-58. */
#include "poreimpl.h"

/* k_p, as given or by Eq. 66 from porosity and diameter. */
static inline PetscReal Permeability(PgPore pore, PetscReal n, PetscReal radius)
{
  const PetscReal d = 2.0 * radius;

  if (!pore->k_p_local) return pore->k_p;
  return n * n * n * d * d / (150.0 * (1.0 - n) * (1.0 - n) * pore->mu);
}

/* Extra mobility of the mixture when discs are moved by the same pressure: dt/((1 - n) rho_s). */
static PetscReal SolidMobility(PgPore pore, PetscInt a, PetscReal dt_f)
{
  return dt_f / ((1.0 - pore->n_flow[a]) * pore->rho_s);
}

/* The gradient that moves disc a along axis e: on flux sides w = -k_p dp/de is prescribed. */
static PetscReal Moving(PgPore pore, const PgPoreArrays *s, PetscInt a, int e, PetscReal n)
{
  if (s->side[a] == 0.0) return pore->grad_p[2 * a + e];
  return PgPoreGradient(pore, s, a, e, -PgBoundaryFlux(pore, s, a, e) / Permeability(pore, n, s->radius[a]));
}

/* Drag n w V/((1 - n) k_p) of Eq. 29 with w/k_p = -grad p; with the pressure gradient -V grad p the sum is
   -V grad p/(1 - n). grad_p is that of the excess over hydrostatic pressure. */
static PetscErrorCode Predict(PgPore pore, PetscReal dt_f)
{
  const PetscBool pressure  = (PetscBool)(pore->coupling == PG_COUPLING_DRAG_AND_PRESSURE);
  const PetscBool projected = PgPoreIsProjected(pore),
                  increment = (PetscBool)(pore->coupling_scheme == PG_SCHEME_INCREMENTAL);
  PgPoreArrays s;

  PetscFunctionBeginUser;
  PetscCall(PgPoreGetArrays(pore, &s));
  for (PetscInt a = 0; a < s.owned; a++) {
    const PetscReal V_p = PETSC_PI * s.radius[a] * s.radius[a], n = s.n[a];
    for (int i = 0; i < 2; i++) {
      /* the projection takes over the force, but for the vertical one of discs on a plate; or replaces it by the new one */
      const PetscBool kick = (PetscBool)(projected && increment && PgPoreIsFree(&s, a));
      const PetscBool here = (PetscBool)(!projected || kick || (s.plate[a] != 0.0 && i == 1));
      const PetscReal g    = kick ? Moving(pore, &s, a, i, n) : pore->grad_p[2 * a + i];
      PetscReal       f    = here ? -V_p * g * (n + (pressure ? 1.0 - n : 0.0)) / (1.0 - n) : 0.0;
      s.kick[2 * a + i]    = kick ? f * dt_f / (V_p * pore->rho_s) : 0.0;
      if (pressure) f -= V_p * pore->rho_f * pore->gravity[i];
      s.fluid_force[2 * a + i] = s.detached[a] != 0.0 ? 0.0 : f;
    }
  }
  PetscCall(PgSphVectorGradient(pore->sph, s.u, pore->grad_u));
  PetscCall(PgCharacteristic(pore, &s, dt_f, pore->b, s.p_guess));
  PetscFunctionReturn(0);
}

/* kappa = k_p + dt/((1 - n) rho_s). */
static PetscErrorCode Mobility(PgPore pore, PetscReal dt_f, PetscReal kappa[], PetscBool *uniform)
{
  const PetscBool   projected = PgPoreIsProjected(pore);
  PgSphCoefficients c;
  PgPoreArrays      s;

  PetscFunctionBeginUser;
  PetscCall(PgPoreGetArrays(pore, &s));
  PetscCall(PgSphGetCoefficients(pore->sph, &c));
  for (PetscInt a = 0; a < s.owned; a++) {
    kappa[a] = Permeability(pore, pore->n_flow[a], s.radius[a]);
    if (projected && PgPoreHasAddedMass(&s, &c, a)) kappa[a] += SolidMobility(pore, a, dt_f);
  }
  *uniform = (PetscBool)!pore->k_p_local;
  PetscFunctionReturn(0);
}

/* div(kappa grad p) = Dn/Dt + n div v - inflow per area. Through a side water flows relative to the discs,
   k_p dp/dn = w, whether they move or not: that source is in proportion to the share of k_p in kappa. With a constant
   k_p, kappa changes little from disc to disc and is divided out. What the old pressure has done to v* already is added
   (`incremental`). */
static PetscErrorCode Source(PgPore pore, PetscReal dt_f, PetscReal Z[])
{
  PetscReal   *kappa = pore->b;
  PgPoreArrays s;
  PetscBool    uniform;

  PetscFunctionBeginUser;
  PetscCall(PgPoreGetArrays(pore, &s));
  PetscCall(Mobility(pore, dt_f, kappa, &uniform));
  PetscCall(PgSphDivergence(pore->sph, s.v, pore->a));
  PetscCall(PgPorosityDerivative(pore, &s, dt_f, pore->a, Z));
  for (PetscInt a = 0; a < s.owned; a++) Z[a] += pore->n_flow[a] * pore->a[a];
  if (PgPoreIsProjected(pore) && pore->coupling_scheme == PG_SCHEME_INCREMENTAL)
    PetscCall(PgPressureLaplacian(pore, &s, pore->a));
  else
    PetscCall(PetscArrayzero(pore->a, s.owned));
  for (PetscInt a = 0; a < s.owned; a++) {
    const PetscReal k_p    = Permeability(pore, pore->n_flow[a], s.radius[a]);
    const PetscReal inflow = s.side[a] != 0.0 ? kappa[a] / k_p * (PgBoundaryInflow(pore, &s, a) / s.volume[a]) : 0.0;

    Z[a] += (kappa[a] - k_p) * pore->a[a] - inflow;
    if (uniform) Z[a] /= kappa[a];
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Correct(PgPore pore, PetscReal dt_f)
{
  PgPoreArrays s;

  PetscFunctionBeginUser;
  PetscCall(PgPoreGetArrays(pore, &s));
  for (PetscInt a = 0; a < s.owned; a++) {
    const PetscReal k_p      = Permeability(pore, pore->n_flow[a], s.radius[a]);
    const PetscReal mobility = PgPoreIsProjected(pore) && PgPoreIsFree(&s, a) ? SolidMobility(pore, a, dt_f) : 0.0;

    for (int e = 0; e < 2; e++) {
      const PetscInt i = 2 * a + e;
      if (mobility > 0.0) s.v[i] -= s.kick[i] + mobility * Moving(pore, &s, a, e, pore->n_flow[a]);
      s.u[i] = s.detached[a] != 0.0 ? s.v[i] : s.v[i] - k_p * pore->grad_p[i] / pore->n_flow[a];
    }
  }
  PetscFunctionReturn(0);
}

const PgFluidScheme PgSchemeDarcy = {"darcy", Predict, Source, Mobility, Correct};
