/* Darcy's law, Eqs. 26-29, 56-58. */
#include "poreimpl.h"

/* Extra mobility of the mixture when discs are moved by the same pressure: dt/((1 - n) rho_s). */
static PetscReal SolidMobility(PgPore pore, const PgPoreArrays *s, PetscInt a, PetscReal dt_f)
{
  if (pore->coupling != PG_COUPLING_DRAG_AND_PRESSURE || pore->coupling_scheme != PG_SCHEME_PROJECTION) return 0.0;
  return PgPoreIsFree(s, a) ? dt_f / ((1.0 - pore->n_flow[a]) * pore->rho_s) : 0.0;
}

/* Drag n w V/((1 - n) k_p) of Eq. 29 with w/k_p = -grad p; with the pressure gradient -V grad p the sum is
   -V grad p/(1 - n). grad_p is that of the excess over hydrostatic pressure. */
static PetscErrorCode Predict(PgPore pore, PetscReal dt_f)
{
  const PetscBool pressure  = (PetscBool)(pore->coupling == PG_COUPLING_DRAG_AND_PRESSURE);
  const PetscBool projected = (PetscBool)(pressure && pore->coupling_scheme == PG_SCHEME_PROJECTION);
  PgPoreArrays    s;

  PetscFunctionBeginUser;
  PetscCall(PgPoreGetArrays(pore, &s));
  for (PetscInt a = 0; a < s.owned; a++) {
    const PetscReal V_p = PETSC_PI * s.radius[a] * s.radius[a], n = s.n[a];
    for (int i = 0; i < 2; i++) {
      /* the projection takes over the force, but for the vertical one of discs on a plate */
      const PetscBool here = (PetscBool)(!projected || (s.plate[a] != 0.0 && i == 1));
      PetscReal       f    = here ? -V_p * pore->grad_p[2 * a + i] * (n + (pressure ? 1.0 - n : 0.0)) / (1.0 - n) : 0.0;
      if (pressure) f -= V_p * pore->rho_f * pore->gravity[i];
      s.fluid_force[2 * a + i] = s.detached[a] != 0.0 ? 0.0 : f;
    }
  }
  PetscCall(PgSphVectorGradient(pore->sph, s.u, pore->grad_u));
  PetscCall(PgCharacteristic(pore, &s, dt_f, pore->b, s.p_guess));
  PetscFunctionReturn(0);
}

/* (k_p + dt/((1 - n) rho_s)) lap p = Dn/Dt + n div v - inflow per area. */
static PetscErrorCode Source(PgPore pore, PetscReal dt_f, PetscReal Z[])
{
  PgPoreArrays s;

  PetscFunctionBeginUser;
  PetscCall(PgPoreGetArrays(pore, &s));
  PetscCall(PgPorosityChange(pore, &s, dt_f, pore->a, Z));
  for (PetscInt a = 0; a < s.owned; a++) {
    const PetscReal k_p = PgPermeability(pore, pore->n_flow[a], s.radius[a]);
    Z[a]                = (Z[a] + pore->n_flow[a] * pore->a[a] - PgBoundaryInflow(pore, &s, a) / s.volume[a]) /
           (k_p + SolidMobility(pore, &s, a, dt_f));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Correct(PgPore pore, PetscReal dt_f)
{
  PgPoreArrays s;

  PetscFunctionBeginUser;
  PetscCall(PgPoreGetArrays(pore, &s));
  for (PetscInt a = 0; a < s.owned; a++) {
    const PetscReal k_p      = PgPermeability(pore, pore->n_flow[a], s.radius[a]),
                    mobility = SolidMobility(pore, &s, a, dt_f);
    for (PetscInt i = 2 * a; i < 2 * a + 2; i++) {
      if (mobility > 0.0) s.v[i] -= mobility * pore->grad_p[i];
      s.u[i] = s.detached[a] != 0.0 ? s.v[i] : s.v[i] - k_p * pore->grad_p[i] / pore->n_flow[a];
    }
  }
  PetscFunctionReturn(0);
}

const PgFluidScheme PgSchemeDarcy = {"darcy", Predict, Source, Correct};
