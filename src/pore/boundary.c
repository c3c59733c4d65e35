/* Sides, surface tracking and detached discs: who has a prescribed pressure, and what boundary kinds do
   to velocities. */
#include "poreimpl.h"

static const PetscReal axis[PG_SIDE_COUNT][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}}; /* outward */

static PetscBool OnSide(PetscReal side, int s) { return (PetscBool)(((int)side >> s) & 1); }

/* The drained side that this disc formed at the start, or -1. */
static int DrainedSide(PgPore pore, PetscReal side)
{
  if (side == 0.0) return -1;
  for (int s = 0; s < PG_SIDE_COUNT; s++)
    if (OnSide(side, s) && pore->boundary[s].kind == PG_BC_DRAINED) return s;
  return -1;
}

/* Outward direction of a surface disc: away from where its kernel finds matter. */
static int FacingSide(const PgSphCoefficients *c, PetscInt a)
{
  PetscReal gx = 0.0, gy = 0.0;

  for (PetscInt k = c->ptr[a]; k < c->ptr[a + 1]; k++) {
    gx += c->gradient[2 * k];
    gy += c->gradient[2 * k + 1];
  }
  if (PetscAbsReal(gx) >= PetscAbsReal(gy)) return gx > 0 ? PG_SIDE_LEFT : PG_SIDE_RIGHT;
  return gy > 0 ? PG_SIDE_BOTTOM : PG_SIDE_TOP;
}

PetscErrorCode PgBoundaryStart(PgPore pore)
{
  PgSphCoefficients c;
  PgPoreArrays      s;
  PetscReal        *start;

  PetscFunctionBeginUser;
  PetscCall(PgPoreGetArrays(pore, &s));
  PetscCall(PgSphGetCoefficients(pore->sph, &c));
  PetscCall(PgParticlesGetArray(pore->particles, pore->kernel_start, &start));
  for (PetscInt a = 0; a < s.owned; a++) start[a] = PetscMin(1.0, c.kernel_sum[a]);
  PetscFunctionReturn(0);
}

/* Whether some disc is within the kernel's reach: the list holds others, too. */
static PetscBool HasNeighbour(const PgSphCoefficients *c, PetscInt a)
{
  for (PetscInt k = c->ptr[a]; k < c->ptr[a + 1]; k++)
    if (c->weight[k] > 0.0) return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscBool IsDetached(PgPore pore, const PgPoreArrays *s, const PgSphCoefficients *c, const PetscReal start[],
                            PetscInt a)
{
  /* a disc that formed a side has had fewer neighbours from the start */
  const PetscReal threshold = pore->detach_sum * (s->side[a] != 0.0 || s->plate[a] != 0.0 ? start[a] : 1.0);

  return (PetscBool)(s->n[a] > pore->detach_n || c->kernel_sum[a] < threshold || !HasNeighbour(c, a));
}

static PetscBool IsSurface(PgPore pore, const PgPoreArrays *s, const PgSphCoefficients *c, PetscInt a)
{
  if (pore->tracking == PG_TRACKING_INITIAL || s->plate[a] != 0.0 || s->side[a] != 0.0) return PETSC_FALSE;
  return (PetscBool)(c->kernel_sum[a] < (s->surface[a] != 0.0 ? pore->surface_sum_back : pore->surface_sum));
}

PetscErrorCode PgBoundaryUpdate(PgPore pore)
{
  PgSphCoefficients c;
  PgPoreArrays      s;
  PetscReal        *start, *fixed, *prescribed;

  PetscFunctionBeginUser;
  PetscCall(PgPoreGetArrays(pore, &s));
  PetscCall(PgSphGetCoefficients(pore->sph, &c));
  PetscCall(PgParticlesGetArray(pore->particles, pore->kernel_start, &start));
  PetscCall(PgParticlesGetArray(pore->particles, pore->p_fixed, &fixed));
  PetscCall(PgParticlesGetArray(pore->particles, pore->p_prescribed, &prescribed));
  pore->stats.surface = pore->stats.detached = 0;
  for (PetscInt a = 0; a < s.owned; a++) {
    int drained = DrainedSide(pore, s.side[a]);

    s.detached[a] = IsDetached(pore, &s, &c, start, a) ? 1.0 : 0.0;
    s.surface[a]  = IsSurface(pore, &s, &c, a) ? 1.0 : 0.0;
    if (drained < 0 && s.surface[a] != 0.0) {
      const int facing = FacingSide(&c, a);
      if (pore->boundary[facing].kind == PG_BC_DRAINED) drained = facing;
    }
    fixed[a]      = drained >= 0 || s.detached[a] != 0.0 ? 1.0 : 0.0;
    prescribed[a] = drained >= 0 ? pore->boundary[drained].pressure : pore->p_initial;
    /* in terms of the excess over hydrostatic pressure, which is what is solved for */
    prescribed[a] -= pore->rho_f * (pore->gravity[0] * s.x[2 * a] + pore->gravity[1] * s.x[2 * a + 1]);
    pore->stats.surface += s.surface[a] != 0.0 && drained >= 0;
    pore->stats.detached += s.detached[a] != 0.0;
  }
  PetscFunctionReturn(0);
}

PetscBool PgBoundaryHolds(PgPore pore, const PgPoreArrays *s, PetscInt a, int e)
{
  if (s->side[a] == 0.0 || s->detached[a] != 0.0) return PETSC_FALSE;
  for (int i = 0; i < PG_SIDE_COUNT; i++) {
    const PgBoundaryKind kind = pore->boundary[i].kind;
    if (axis[i][e] != 0.0 && OnSide(s->side[a], i) && (kind == PG_BC_IMPERMEABLE || kind == PG_BC_FLUX))
      return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscReal PgBoundaryFlux(PgPore pore, const PgPoreArrays *s, PetscInt a, int e)
{
  PetscReal flux = 0.0;

  for (int i = 0; i < PG_SIDE_COUNT; i++)
    if (axis[i][e] != 0.0 && OnSide(s->side[a], i) && pore->boundary[i].kind == PG_BC_FLUX)
      flux = pore->boundary[i].flux;
  return flux;
}

PetscErrorCode PgBoundaryVelocity(PgPore pore, const PgPoreArrays *s, PetscReal u[])
{
  PetscFunctionBeginUser;
  for (PetscInt a = 0; a < s->owned; a++) {
    if (s->detached[a] != 0.0) {
      u[2 * a]     = s->v[2 * a];
      u[2 * a + 1] = s->v[2 * a + 1];
      continue;
    }
    if (s->side[a] == 0.0) continue;
    for (int i = 0; i < PG_SIDE_COUNT; i++) {
      const PgBoundary *bc = &pore->boundary[i];
      const int         e  = axis[i][0] != 0.0 ? 0 : 1;
      if (!OnSide(s->side[a], i) || bc->kind == PG_BC_DRAINED || bc->kind == PG_BC_NATURAL) continue;
      u[2 * a + e] = s->v[2 * a + e] + (bc->kind == PG_BC_FLUX ? bc->flux / pore->n_flow[a] : 0.0);
    }
  }
  PetscFunctionReturn(0);
}

PetscReal PgBoundaryInflow(PgPore pore, const PgPoreArrays *s, PetscInt a)
{
  PetscReal inflow = 0.0;

  for (int i = 0; i < PG_SIDE_COUNT; i++) {
    const PgBoundary *bc = &pore->boundary[i];
    if (!OnSide(s->side[a], i) || bc->kind != PG_BC_FLUX) continue;
    inflow -= bc->flux * (axis[i][0] + axis[i][1]) * 2.0 * s->radius[a];
  }
  return inflow;
}

PetscReal PgBoundaryForce(PgPore pore, const PgPoreArrays *s, const PetscReal F[], PetscInt a)
{
  PetscReal force = 0.0;

  for (int i = 0; i < PG_SIDE_COUNT; i++) {
    const PgBoundaryKind kind = pore->boundary[i].kind;
    if (!OnSide(s->side[a], i) || kind == PG_BC_DRAINED || kind == PG_BC_NATURAL) continue;
    force += (axis[i][0] * F[2 * a] + axis[i][1] * F[2 * a + 1]) * 2.0 * s->radius[a];
  }
  return force;
}
