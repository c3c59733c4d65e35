/* One fluid step, in the order of the paper's procedure; what the schemes have in common. */
#include "poreimpl.h"
#include <math.h>

PetscErrorCode PgPoreReserve(PgPore pore)
{
  PetscInt owned, ghosts, local;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(pore->particles, &owned, &ghosts, NULL));
  local = owned + ghosts;
  if (local <= pore->capacity && pore->Z) PetscFunctionReturn(0);
  pore->capacity = local + local / 8 + 1;
  PetscCall(PetscFree5(pore->grad_p, pore->grad_u, pore->n_flow, pore->head, pore->Z));
  PetscCall(PetscFree2(pore->a, pore->b));
  PetscCall(PetscMalloc5(2 * pore->capacity, &pore->grad_p, 4 * pore->capacity, &pore->grad_u, pore->capacity,
                         &pore->n_flow, pore->capacity, &pore->head, pore->capacity, &pore->Z));
  PetscCall(PetscMalloc2(2 * pore->capacity, &pore->a, 2 * pore->capacity, &pore->b));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPoreGetArrays(PgPore pore, PgPoreArrays *s)
{
  PgParticles p = pore->particles;
  PetscInt    ghosts;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(p, &s->owned, &ghosts, NULL));
  s->local = s->owned + ghosts;
  PetscCall(PgParticlesGetArray(p, PG_POSITION, &s->x));
  PetscCall(PgParticlesGetArray(p, PG_VELOCITY, &s->v));
  PetscCall(PgParticlesGetArray(p, PG_RADIUS, &s->radius));
  PetscCall(PgParticlesGetArray(p, pore->porosity, &s->n));
  PetscCall(PgParticlesGetArray(p, pore->u, &s->u));
  PetscCall(PgParticlesGetArray(p, pore->w, &s->w));
  PetscCall(PgParticlesGetArray(p, pore->p, &s->p));
  PetscCall(PgParticlesGetArray(p, pore->u_tilde, &s->u_tilde));
  PetscCall(PgParticlesGetArray(p, pore->p_guess, &s->p_guess));
  PetscCall(PgParticlesGetArray(p, pore->drag, &s->drag));
  PetscCall(PgParticlesGetArray(p, pore->Q, &s->Q));
  PetscCall(PgParticlesGetArray(p, pore->kick, &s->kick));
  PetscCall(PgParticlesGetArray(p, pore->side, &s->side));
  PetscCall(PgParticlesGetArray(p, pore->surface, &s->surface));
  PetscCall(PgParticlesGetArray(p, pore->detached, &s->detached));
  PetscCall(PgParticlesGetArray(p, pore->plate, &s->plate));
  PetscCall(PgParticlesGetArray(p, pore->volume, &s->volume));
  PetscCall(PgParticlesGetArray(p, pore->fluid_force, &s->fluid_force));
  s->n_flow = pore->n_flow;
  PetscFunctionReturn(0);
}

PetscErrorCode PgCharacteristic(PgPore pore, const PgPoreArrays *s, PetscReal dt_f, PetscReal u_f[], PetscReal p_f[])
{
  PetscFunctionBeginUser;
  for (PetscInt a = 0; a < s->owned; a++) {
    const PetscReal *g  = pore->grad_u + 4 * a;
    const PetscReal  vx = s->v[2 * a], vy = s->v[2 * a + 1];
    const PetscReal  sx = s->u[2 * a] + dt_f * (g[0] * vx + g[1] * vy),
                    sy  = s->u[2 * a + 1] + dt_f * (g[2] * vx + g[3] * vy);
    const PetscReal b00 = 1.0 + dt_f * g[0], b01 = dt_f * g[1], b10 = dt_f * g[2], b11 = 1.0 + dt_f * g[3];
    const PetscReal det = b00 * b11 - b01 * b10;

    if (det > 1e-3) {
      u_f[2 * a]     = (b11 * sx - b01 * sy) / det;
      u_f[2 * a + 1] = (b00 * sy - b10 * sx) / det;
    } else { /* characteristics cross within the step: B has no use, stay where we are and count it */
      u_f[2 * a]     = s->u[2 * a];
      u_f[2 * a + 1] = s->u[2 * a + 1];
      pore->characteristic_failures++;
    }
    p_f[a] = s->p[a] -
             dt_f * (pore->grad_p[2 * a] * (u_f[2 * a] - vx) + pore->grad_p[2 * a + 1] * (u_f[2 * a + 1] - vy));
  }
  PetscFunctionReturn(0);
}

/* p <-> p - rho_f g.x, ghosts included: the pressure equation and all gradients see the excess over
   hydrostatic, so that water at rest is at rest exactly and an impermeable side needs no term of its own. */
static void ShiftPressure(PgPore pore, const PgPoreArrays *s, PetscReal sign)
{
  const PetscReal gx = sign * pore->rho_f * pore->gravity[0], gy = sign * pore->rho_f * pore->gravity[1];

  if (gx == 0.0 && gy == 0.0) return;
  for (PetscInt a = 0; a < s->local; a++) s->p[a] += gx * s->x[2 * a] + gy * s->x[2 * a + 1];
}

PetscErrorCode PgPressureGradient(PgPore pore)
{
  PgPoreArrays s;

  PetscFunctionBeginUser;
  PetscCall(PgPoreGetArrays(pore, &s));
  for (PetscInt a = 0; a < s.local; a++)
    pore->head[a] = s.p[a] - pore->rho_f * (pore->gravity[0] * s.x[2 * a] + pore->gravity[1] * s.x[2 * a + 1]);
  PetscCall(PgSphGradient(pore->sph, pore->head, pore->grad_p));
  PetscCall(PgParticlesGetRevision(pore->particles, &pore->grad_p_revision));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureLaplacian(PgPore pore, const PgPoreArrays *s, PetscReal laplacian[])
{
  PetscFunctionBeginUser;
  for (PetscInt a = 0; a < s->local; a++)
    pore->head[a] = s->p[a] - pore->rho_f * (pore->gravity[0] * s->x[2 * a] + pore->gravity[1] * s->x[2 * a + 1]);
  PetscCall(PgSphLaplacian(pore->sph, pore->head, laplacian));
  PetscFunctionReturn(0);
}

static PetscErrorCode Observe(PgPore pore)
{
  PgPoreArrays s;

  PetscFunctionBeginUser;
  PetscCall(PgPoreGetArrays(pore, &s));
  for (PetscInt a = 0; a < s.owned; a++)
    for (PetscInt i = 2 * a; i < 2 * a + 2; i++) s.w[i] = s.n[a] * (s.u[i] - s.v[i]);
  PetscFunctionReturn(0);
}

/* Discs of impermeable and flux sides follow the contact forces along the normal: walls or a plate are to hold them
   against the water. If nothing does, the side moves as it likes and the water is drawn after it at no cost. */
static PetscErrorCode WarnOfFreeSides(PgPore pore)
{
  PgPoreArrays s;
  PetscInt     count = 0;
  MPI_Comm     comm  = PgParticlesComm(pore->particles);

  PetscFunctionBeginUser;
  pore->free_sides = 0;
  if (!PgPoreIsProjected(pore) || pore->fluid != PG_FLUID_NS) PetscFunctionReturn(0);
  PetscCall(PgPoreGetArrays(pore, &s));
  for (PetscInt a = 0; a < s.owned; a++)
    count += s.plate[a] == 0.0 && (PgBoundaryHolds(pore, &s, a, 0) || PgBoundaryHolds(pore, &s, a, 1));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPIU_INT, MPI_SUM, comm));
  if (!count) PetscFunctionReturn(0);
  PetscCall(PetscPrintf(comm,
                        "warning: %" PetscInt_FMT
                        " discs of impermeable or flux sides are on no plate: with -coupling drag_and_pressure walls "
                        "must hold them, a side that nothing holds is unstable\n",
                        count));
  pore->free_sides = count;
  PetscFunctionReturn(0);
}

/* Water is incompressible: without a drained side nothing holds the level of its pressure, and what flows in cannot
   leave. */
static PetscErrorCode WarnOfClosedBox(PgPore pore)
{
  PgPressureMethod method;
  PgPoreArrays     s;
  PgExactSum       exact[2] = {{.not_finite = 0}, {.not_finite = 0}};
  PetscReal        inflow[2]; /* [m2/s]: net, and without signs */
  MPI_Comm         comm = PgParticlesComm(pore->particles);

  PetscFunctionBeginUser;
  if (PgPoreAnySide(pore, PG_BC_DRAINED)) PetscFunctionReturn(0);
  PetscCall(PgPressureGetMethod(pore->pressure, &method));
  PetscCall(PgPoreGetArrays(pore, &s));
  for (PetscInt a = 0; a < s.owned; a++) {
    const PetscReal q = PgBoundaryInflow(pore, &s, a);
    PgExactSumAdd(&exact[0], q);
    PgExactSumAdd(&exact[1], PetscAbsReal(q));
  }
  PetscCall(PgExactSumReduce(comm, 2, exact, inflow));
  /* what flows in on one side may leave by another: equal but for rounding */
  if (PetscAbsReal(inflow[0]) > 1e-9 * inflow[1])
    PetscCall(PetscPrintf(comm, "warning: no side is drained, and the flux sides let %g m2/s of water %s: %s\n",
                          (double)PetscAbsReal(inflow[0]), inflow[0] > 0.0 ? "in, which cannot leave" : "out",
                          method == PG_PRESSURE_EXPLICIT
                              ? "the mean pressure changes by as much in each step, without end"
                              : "that part is left out of the mass balance (pressure_removed in the history)"));
  else if (method == PG_PRESSURE_EXPLICIT)
    PetscCall(PetscPrintf(comm, "warning: no side is drained, and explicit sweeps do not keep the mean pressure: it "
                                "drifts; -pressure implicit keeps it\n"));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPoreSetUp(PgPore pore, PetscReal dt_f)
{
  PgPoreArrays s;
  PetscReal   *before;
  PgField      fields[2] = {pore->u, PG_VELOCITY};

  PetscFunctionBeginUser;
  (void)dt_f;
  PetscCall(PgPoreReserve(pore));
  PetscCall(PgParticlesHalo(pore->particles, 1, &fields[1]));
  PetscCall(PgPorosityCalibrate(pore));
  PetscCall(PgPoreVolumes(pore));
  PetscCall(PgSphUpdate(pore->sph));
  PetscCall(PgBoundaryStart(pore));
  PetscCall(PgBoundaryUpdate(pore));
  PetscCall(PgPoreGetArrays(pore, &s));
  PetscCall(PgParticlesGetArray(pore->particles, pore->porosity_before, &before));
  for (PetscInt a = 0; a < s.owned; a++) {
    before[a]      = s.n[a];
    s.p[a]         = pore->p_initial;
    s.u[2 * a]     = s.v[2 * a];
    s.u[2 * a + 1] = s.v[2 * a + 1];
  }
  PetscCall(PgPoreRefresh(pore));
  PetscCall(PgPressureUpdate(pore->pressure, NULL));
  PetscCall(WarnOfFreeSides(pore));
  PetscCall(WarnOfClosedBox(pore));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPoreRestart(PgPore pore)
{
  PgPoreArrays s;

  PetscFunctionBeginUser;
  PetscCall(PgPoreRefresh(pore));
  PetscCall(PgPoreGetArrays(pore, &s));
  pore->stats.surface = pore->stats.detached = 0;
  for (PetscInt a = 0; a < s.owned; a++) {
    pore->stats.surface += s.surface[a] != 0.0;
    pore->stats.detached += s.detached[a] != 0.0;
  }
  PetscCall(PgPressureUpdate(pore->pressure, NULL));
  PetscCall(WarnOfFreeSides(pore));
  PetscCall(WarnOfClosedBox(pore));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPoreRefresh(PgPore pore)
{
  PgField      fields[3] = {pore->u, PG_VELOCITY, pore->p};
  PgPoreArrays s;
  PetscReal   *divergence;

  PetscFunctionBeginUser;
  PetscCall(PgPoreReserve(pore));
  PetscCall(PgParticlesHalo(pore->particles, 3, fields));
  PetscCall(PgPoreVolumes(pore));
  PetscCall(PgSphUpdate(pore->sph));
  PetscCall(PgPressureGradient(pore));
  PetscCall(PgPoreGetArrays(pore, &s));
  PetscCall(PgParticlesGetArray(pore->particles, pore->divergence, &divergence));
  PetscCall(PgSphDivergence(pore->sph, s.v, divergence));
  PetscCall(Observe(pore));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPorePredict(PgPore pore, PetscReal dt_f)
{
  PetscInt revision;

  PetscFunctionBeginUser;
  PetscCall(PgStagePush(PG_STAGE_PREDICTOR));
  PetscCall(PgParticlesGetRevision(pore->particles, &revision));
  PetscCheck(revision == pore->grad_p_revision, PgParticlesComm(pore->particles), PETSC_ERR_PLIB,
             "discs were renumbered between two fluid steps without PgPoreRefresh()");
  pore->characteristic_failures = 0;
  PetscCall(pore->scheme->predict(pore, dt_f));
  PetscCall(PgStagePop());
  PetscFunctionReturn(0);
}

static PetscErrorCode Source(PgPore pore, PetscReal dt_f)
{
  PgPoreArrays s;

  PetscFunctionBeginUser;
  PetscCall(PgStagePush(PG_STAGE_SOURCE));
  PetscCall(pore->scheme->source(pore, dt_f, pore->Z));
  PetscCall(PgPoreGetArrays(pore, &s));
  if (pore->guess == PG_GUESS_CHARACTERISTIC) PetscCall(PetscArraycpy(s.p, s.p_guess, s.owned));
  ShiftPressure(pore, &s, -1.0);
  PetscCall(PgStagePop());
  PetscFunctionReturn(0);
}

static PetscErrorCode Velocities(PgPore pore, PetscReal dt_f)
{
  PgField      fields[2] = {pore->u, PG_VELOCITY};
  PgPoreArrays s;
  PetscReal   *divergence;

  PetscFunctionBeginUser;
  PetscCall(PgStagePush(PG_STAGE_CORRECTOR));
  PetscCall(PgPoreGetArrays(pore, &s));
  ShiftPressure(pore, &s, 1.0);
  PetscCall(PgPressureGradient(pore));
  PetscCall(pore->scheme->correct(pore, dt_f));
  PetscCall(PgParticlesHalo(pore->particles, 2, fields));
  if (pore->porosity_kind == PG_POROSITY_KINEMATIC) {
    PetscCall(PgParticlesGetArray(pore->particles, pore->divergence, &divergence));
    PetscCall(PgSphDivergence(pore->sph, s.v, divergence));
  }
  PetscCall(Observe(pore));
  PetscCall(PgStagePop());
  PetscFunctionReturn(0);
}

PetscErrorCode PgPoreCorrect(PgPore pore, PetscReal dt_f)
{
  PgPoreArrays s;
  PetscReal   *before;
  PetscBool    uniform  = PETSC_TRUE;
  PgField      velocity = PG_VELOCITY;

  PetscFunctionBeginUser;
  pore->clipped = 0;
  PetscCall(PgPoreReserve(pore));
  PetscCall(PgPoreGetArrays(pore, &s));
  PetscCall(PgParticlesGetArray(pore->particles, pore->porosity_before, &before));
  PetscCall(PetscArraycpy(before, s.n, s.owned));
  PetscCall(PgParticlesHalo(pore->particles, 1, &velocity)); /* whole-step velocities of the ghosts */
  PetscCall(PgPorosityUpdate(pore, dt_f));
  PetscCall(PgStagePush(PG_STAGE_GEOMETRY));
  PetscCall(PgPoreVolumes(pore));
  PetscCall(PgSphUpdate(pore->sph));
  PetscCall(PgBoundaryUpdate(pore));
  PetscCall(PgStagePop());
  PetscCall(Source(pore, dt_f));
  if (pore->scheme->mobility) PetscCall(pore->scheme->mobility(pore, dt_f, pore->b, &uniform));
  PetscCall(PgPressureUpdate(pore->pressure, uniform ? NULL : pore->b));
  PetscCall(PgPressureSolve(pore->pressure, pore->Z, &pore->stats.pressure));
  PetscCall(Velocities(pore, dt_f));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPoreGetStats(PgPore pore, PgPoreStats *stats)
{
  PgPoreArrays s;
  PetscReal    least = PETSC_MAX_REAL, most[2] = {PETSC_MIN_REAL, 0.0}, sum;
  PgExactSum   exact = {.not_finite = 0};
  PetscInt count[4] = {pore->stats.surface, pore->stats.detached, pore->clipped, pore->characteristic_failures}, global;
  MPI_Comm comm     = PgParticlesComm(pore->particles);

  PetscFunctionBeginUser;
  PetscCall(PgPoreGetArrays(pore, &s));
  PetscCall(PgParticlesGetSizes(pore->particles, NULL, NULL, &global));
  for (PetscInt a = 0; a < s.owned; a++) {
    least   = PetscMin(least, s.p[a]);
    most[0] = PetscMax(most[0], s.p[a]);
    most[1] = PetscMax(most[1], PetscSqrtReal(s.w[2 * a] * s.w[2 * a] + s.w[2 * a + 1] * s.w[2 * a + 1]));
    PgExactSumAdd(&exact, s.p[a]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPIU_REAL, MPIU_MIN, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 2, MPIU_REAL, MPIU_MAX, comm));
  PetscCall(PgExactSumReduce(comm, 1, &exact, &sum));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 4, MPIU_INT, MPI_SUM, comm));
  *stats                         = pore->stats;
  stats->p_min                   = least;
  stats->p_max                   = most[0];
  stats->p_mean                  = sum / (PetscReal)PetscMax(global, 1);
  stats->w_max                   = most[1];
  stats->surface                 = count[0];
  stats->detached                = count[1];
  stats->clipped                 = count[2];
  stats->characteristic_failures = count[3];
  PetscFunctionReturn(0);
}
