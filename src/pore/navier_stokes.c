/* The averaged Navier-Stokes scheme, Eqs. 18-24, 35-55. */
#include "poreimpl.h"

/* Force of the water on disc a per unit length: drag (Eq. 24), and the pressure gradient where it is not
   left to the projection. */
static void ForceOnDiscs(PgPore pore, const PgPoreArrays *s, const PetscReal F[], PetscReal dt_f)
{
  const PetscBool pressure  = (PetscBool)(pore->coupling == PG_COUPLING_DRAG_AND_PRESSURE);
  const PetscBool staggered = (PetscBool)(pressure && pore->coupling_scheme == PG_SCHEME_STAGGERED);
  const PetscBool increment = (PetscBool)(pressure && pore->coupling_scheme == PG_SCHEME_INCREMENTAL);

  for (PetscInt a = 0; a < s->owned; a++) {
    const PetscReal V_p = PETSC_PI * s->radius[a] * s->radius[a], n = s->n[a];
    for (int i = 0; i < 2; i++) {
      PetscReal f = -n * F[2 * a + i] * V_p / (1.0 - n);
      /* a disc on a plate is not projected: its vertical force belongs to the reaction of the plate */
      const PetscBool on_plate = (PetscBool)(pressure && s->plate[a] != 0.0 && i == 1);
      const PetscBool kick     = (PetscBool)(increment && PgPoreIsFree(s, a)); /* to be replaced by the new one */
      const PetscReal moving   = kick ? PgPoreGradient(pore, s, a, i, F[2 * a + i]) : 0.0;
      s->kick[2 * a + i]       = kick ? -dt_f / pore->rho_s * moving : 0.0;
      if (kick) f -= V_p * moving;
      if ((staggered || on_plate) && s->detached[a] == 0.0) f -= V_p * pore->grad_p[2 * a + i];
      if (pressure) f -= V_p * pore->rho_f * pore->gravity[i]; /* buoyancy: the hydrostatic part of -V grad p */
      s->fluid_force[2 * a + i] = s->detached[a] != 0.0 ? 0.0 : f;
    }
  }
}

/* Q = -(grad p - F)/rho_f of t_n (gravity is in the excess pressure), carried along the characteristic: the (1 - theta) part of Eq. 46. */
static PetscErrorCode ExplicitForce(PgPore pore, const PgPoreArrays *s, PetscReal dt_f, const PetscReal u_f[],
                                    PetscReal grad_Q[])
{
  const PetscReal weight = (1.0 - pore->theta) * dt_f;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 2 * s->owned; i++) s->Q[i] = -(pore->grad_p[i] - s->drag[i]) / pore->rho_f;
  PetscCall(PgParticlesHalo(pore->particles, 1, &pore->Q));
  PetscCall(PgSphVectorGradient(pore->sph, s->Q, grad_Q));
  for (PetscInt a = 0; a < s->owned; a++) {
    const PetscReal cx = (u_f[2 * a] - s->v[2 * a]) * dt_f, cy = (u_f[2 * a + 1] - s->v[2 * a + 1]) * dt_f;
    for (int i = 0; i < 2; i++)
      s->u_tilde[2 * a + i] += weight * (s->Q[2 * a + i] - grad_Q[4 * a + 2 * i] * cx - grad_Q[4 * a + 2 * i + 1] * cy);
  }
  PetscFunctionReturn(0);
}

/* XSPH: u~ <- u~ + S (mean of u~ over the kernel - u~). */
static PetscErrorCode Smooth(PgPore pore, const PgPoreArrays *s)
{
  PgSphCoefficients c;

  PetscFunctionBeginUser;
  PetscCall(PgSphGetCoefficients(pore->sph, &c));
  PetscCall(PgParticlesHalo(pore->particles, 1, &pore->u_tilde));
  for (PetscInt a = 0; a < s->owned; a++) {
    PetscReal sx = 0.0, sy = 0.0;
    for (PetscInt k = c.ptr[a]; k < c.ptr[a + 1]; k++) {
      sx += c.weight[k] * (s->u_tilde[2 * c.col[k]] - s->u_tilde[2 * a]);
      sy += c.weight[k] * (s->u_tilde[2 * c.col[k] + 1] - s->u_tilde[2 * a + 1]);
    }
    pore->a[2 * a]     = sx / c.kernel_sum[a];
    pore->a[2 * a + 1] = sy / c.kernel_sum[a];
  }
  for (PetscInt i = 0; i < 2 * s->owned; i++) s->u_tilde[i] += pore->smoothing * pore->a[i];
  PetscFunctionReturn(0);
}

static PetscErrorCode Predict(PgPore pore, PetscReal dt_f)
{
  PgPoreArrays s;

  PetscFunctionBeginUser;
  PetscCall(PgPoreGetArrays(pore, &s));
  PetscCall(PgDragForce(pore, &s, s.u, s.drag));
  ForceOnDiscs(pore, &s, s.drag, dt_f);
  PetscCall(PgSphVectorGradient(pore->sph, s.u, pore->grad_u));
  PetscCall(PgCharacteristic(pore, &s, dt_f, pore->b, s.p_guess));
  PetscCall(PetscArraycpy(s.u_tilde, pore->b, 2 * s.owned));
  if (pore->theta < 1.0) PetscCall(ExplicitForce(pore, &s, dt_f, pore->b, pore->grad_u));
  if (pore->smoothing > 0.0) PetscCall(Smooth(pore, &s));
  PetscFunctionReturn(0);
}

/* Z = rho_f/(theta dt) (div u~ - S) + div F, S = -[Dn/Dt + (u~ - v).grad n]/n with `averaged` continuity and 0 else, from
   the sum rho_f/(theta dt) u~ + F, which takes the place of Q. */
static PetscErrorCode Divergences(PgPore pore, const PgPoreArrays *s, PetscReal dt_f, PetscReal Z[])
{
  const PetscReal scale = pore->rho_f / (pore->theta * dt_f);

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 2 * s->owned; i++) s->Q[i] = scale * s->u_tilde[i] + s->drag[i];
  PetscCall(PgParticlesHalo(pore->particles, 1, &pore->Q));
  if (pore->continuity != PG_CONTINUITY_AVERAGED) {
    PetscCall(PgSphDivergence(pore->sph, s->Q, Z));
    PetscFunctionReturn(0);
  }
  PetscCall(PgSphDivergencesAndGradient(pore->sph, s->Q, s->v, pore->n_flow, Z, pore->grad_u, pore->b));
  PetscCall(PgPorosityDerivative(pore, s, dt_f, pore->grad_u, pore->a));
  for (PetscInt a = 0; a < s->owned; a++) {
    const PetscReal advected = (s->u_tilde[2 * a] - s->v[2 * a]) * pore->b[2 * a] +
                               (s->u_tilde[2 * a + 1] - s->v[2 * a + 1]) * pore->b[2 * a + 1];
    Z[a] += scale * ((pore->a[a] + advected) / pore->n_flow[a]);
  }
  PetscFunctionReturn(0);
}

/* Eq. 50; `averaged` continuity adds -rho_f/(theta dt) S with S = -[Dn/Dt + (u~ - v).grad n]/n, and the
   two-phase projection divides by 1 + (1 - n) rho_f/(n theta rho_s), having added what the old pressure has done to v*
   already (`incremental`). */
static PetscErrorCode Source(PgPore pore, PetscReal dt_f, PetscReal Z[])
{
  const PetscBool   project = PgPoreIsProjected(pore);
  PgPoreArrays      s;
  PgSphCoefficients c;

  PetscFunctionBeginUser;
  PetscCall(PgPoreGetArrays(pore, &s));
  PetscCall(PgSphGetCoefficients(pore->sph, &c));
  PetscCall(PgBoundaryVelocity(pore, &s, s.u_tilde));
  PetscCall(PgDragForce(pore, &s, s.u_tilde, s.drag));
  PetscCall(Divergences(pore, &s, dt_f, Z));
  if (project && pore->coupling_scheme == PG_SCHEME_INCREMENTAL)
    PetscCall(PgPressureLaplacian(pore, &s, pore->a));
  else
    PetscCall(PetscArrayzero(pore->a, s.owned));
  for (PetscInt a = 0; a < s.owned; a++) {
    if (project && PgPoreHasAddedMass(&s, &c, a)) {
      const PetscReal added = (1.0 - pore->n_flow[a]) * pore->rho_f / (pore->n_flow[a] * pore->theta * pore->rho_s);
      Z[a]                  = (Z[a] + added * pore->a[a]) / (1.0 + added);
    }
    /* where u.e is prescribed Eq. 47 leaves dp/de = F.e, which a side with nothing said about its pressure has not */
    if (s.side[a] != 0.0) Z[a] -= PgBoundaryForce(pore, &s, s.drag, a) / s.volume[a];
  }
  PetscFunctionReturn(0);
}

/* Eq. 47 (with the time step that its first form lacks), and v = v* - dt/rho_s grad p. */
static PetscErrorCode Correct(PgPore pore, PetscReal dt_f)
{
  const PetscReal scale   = pore->theta * dt_f / pore->rho_f;
  const PetscBool project = PgPoreIsProjected(pore);
  PgPoreArrays    s;

  PetscFunctionBeginUser;
  PetscCall(PgPoreGetArrays(pore, &s));
  for (PetscInt a = 0; a < s.owned; a++) {
    const PetscBool moves = (PetscBool)(project && PgPoreIsFree(&s, a));
    for (int e = 0; e < 2; e++) {
      const PetscInt i = 2 * a + e;
      s.u[i]           = s.u_tilde[i] - scale * (pore->grad_p[i] - s.drag[i]);
      /* where u.e is prescribed Eq. 47 leaves dp/de = F.e, see Source() */
      if (moves) s.v[i] -= s.kick[i] + dt_f / pore->rho_s * PgPoreGradient(pore, &s, a, e, s.drag[i]);
    }
  }
  PetscCall(PgBoundaryVelocity(pore, &s, s.u));
  PetscFunctionReturn(0);
}

const PgFluidScheme PgSchemeNavierStokes = {"ns", Predict, Source, NULL, Correct};
