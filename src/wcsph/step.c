/* One step, by velocity Verlet. */
#include "wcsphimpl.h"
#include <math.h>

PetscErrorCode PgWcsphKick(PgWcsph w, PetscReal dt)
{
  /* by its exact factor, which no rate makes unstable */
  const PetscReal keep = PetscExpReal(w->time < w->damp_end ? -w->damping * dt : 0.0);
  PgWcsphArrays   f;

  PetscFunctionBeginUser;
  PetscCall(PgStagePush(PG_STAGE_INTEGRATE));
  PetscCall(PgWcsphGetArrays(w, &f));
  for (PetscInt a = 0; a < f.owned; a++) {
    if (!PgWcsphIsLiquid(&f, a)) continue;
    for (int d = 0; d < 2; d++)
      f.v[2 * a + d] = keep * f.v[2 * a + d] + dt * (f.force[2 * a + d] / f.m[a] + w->gravity[d]);
  }
  PetscCall(PgStagePop());
  PetscFunctionReturn(0);
}

/* Asks where the particles of bodies are at the end of the drift, and sets their velocities. */
static PetscErrorCode AskBodies(PgWcsph w, const PgWcsphArrays *f)
{
  PetscFunctionBeginUser;
  if (!w->motion) PetscFunctionReturn(0);
  for (PetscInt n = 0; n < w->bodies; n++)
    for (int d = 0; d < 2; d++) {
      w->body_x[2 * n + d] = f->x[2 * w->local[n] + d];
      w->body_v[2 * n + d] = f->v[2 * w->local[n] + d];
    }
  PetscCall(w->motion(w->motion_context, w->bodies, w->body_of, w->index_of, w->body_x, w->body_v));
  for (PetscInt n = 0; n < w->bodies; n++)
    for (int d = 0; d < 2; d++) f->v[2 * w->local[n] + d] = w->body_v[2 * n + d];
  PetscFunctionReturn(0);
}

static PetscErrorCode Halo(PgWcsph w, PetscInt count, const PgField field[])
{
  PetscFunctionBeginUser;
  PetscCall(PgStagePush(PG_STAGE_HALO));
  PetscCall(PgParticlesHalo(w->particles, count, field));
  PetscCall(PgStagePop());
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphDrift(PgWcsph w, PetscReal dt)
{
  const PgField velocity = PG_VELOCITY;
  PgWcsphArrays f;

  PetscFunctionBeginUser;
  PetscCheck(w->set_up && w->pending == 0.0, w->comm, PETSC_ERR_ORDER, "a drift follows PgWcsphForces()");
  PetscCall(PgWcsphGetArrays(w, &f));
  PetscCall(AskBodies(w, &f));
  if (w->density == PG_WCSPH_CONTINUITY) {
    PetscCall(Halo(w, 1, &velocity));
    PetscCall(PgStagePush(PG_STAGE_PREDICTOR));
    PetscCall(PgWcsphDensityRate(w, w->rate));
    for (PetscInt a = 0; a < f.owned; a++) w->rate[a] *= 0.5;
    PetscCall(PgWcsphAddDiffusion(w, w->rate));
    for (PetscInt a = 0; a < f.owned; a++) f.rho[a] += dt * w->rate[a];
    PetscCall(PgStagePop());
  }
  for (PetscInt i = 0; i < 2 * f.owned; i++)
    if (f.kind[i / 2] != (PetscReal)PG_WCSPH_BODY || !w->motion) f.x[i] += dt * f.v[i];
  if (w->motion)
    for (PetscInt n = 0; n < w->bodies; n++)
      for (int d = 0; d < 2; d++) f.x[2 * w->local[n] + d] = w->body_x[2 * n + d];
  w->pending = dt;
  w->time += dt;
  w->step++;
  PetscFunctionReturn(0);
}

/* Particles of bodies of this rank; addresses in the store change with the lists. */
static PetscErrorCode FindBodies(PgWcsph w)
{
  PgWcsphArrays f;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetArrays(w, &f));
  w->bodies = 0;
  for (PetscInt a = 0; a < f.owned; a++) w->bodies += f.kind[a] == (PetscReal)PG_WCSPH_BODY;
  if (w->bodies > w->bodies_room || !w->local) {
    w->bodies_room = w->bodies + w->bodies / 8 + 16;
    PetscCall(PetscFree3(w->local, w->body_of, w->index_of));
    PetscCall(PetscFree2(w->body_x, w->body_v));
    PetscCall(PetscMalloc3(w->bodies_room, &w->local, w->bodies_room, &w->body_of, w->bodies_room, &w->index_of));
    PetscCall(PetscMalloc2(2 * w->bodies_room, &w->body_x, 2 * w->bodies_room, &w->body_v));
  }
  for (PetscInt a = 0, n = 0; a < f.owned; a++) {
    if (f.kind[a] != (PetscReal)PG_WCSPH_BODY) continue;
    w->local[n]      = a;
    w->body_of[n]    = (PetscInt)f.body[a];
    w->index_of[n++] = (PetscInt)f.index[a];
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode UpdateLists(PgWcsph w)
{
  const PgField moved[] = {PG_POSITION, PG_VELOCITY, w->rho}; /* density of the first half */
  PetscBool     need;

  PetscFunctionBeginUser;
  PetscCall(PgNeighborsNeedBuild(w->neighbors, &need));
  if (need) {
    PetscCall(PgNeighborsBuild(w->neighbors));
    PetscCall(FindBodies(w));
  } else {
    PetscCall(Halo(w, 3, moved));
  }
  PetscFunctionReturn(0);
}

/* The liquid has blown up where its density is off by half. */
static PetscErrorCode Guard(PgWcsph w, const PgWcsphArrays *f)
{
  const PetscInt *id;
  PetscReal       worst = -1.0, where[3] = {0, 0, 0};
  PetscInt        which = -1;
  PetscMPIInt     holder;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetIds(w->particles, &id));
  for (PetscInt a = 0; a < f->owned; a++) {
    PetscReal off = PetscAbsReal(f->rho[a] / w->rho_0 - 1.0);
    if (!PgWcsphIsLiquid(f, a) || isless(off, 0.5)) continue;
    if (!isfinite(off)) off = PETSC_MAX_REAL;
    if (off < worst || (off == worst && id[a] > which)) continue;
    worst    = off;
    which    = id[a];
    where[0] = f->x[2 * a];
    where[1] = f->x[2 * a + 1];
    where[2] = f->rho[a];
  }
  PetscCall(PgFindHolder(w->comm, worst, which, 0, &holder));
  if (holder < 0) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Bcast(&which, 1, MPIU_INT, holder, w->comm));
  PetscCallMPI(MPI_Bcast(where, 3, MPIU_REAL, holder, w->comm));
  PgRunError(w->comm,
             "the density of particle %" PetscInt_FMT " at (%g, %g) m is %g kg/m3 at t = %g s, step %" PetscInt_FMT
             ", %g at rest: the liquid has blown up (smaller -dt, larger -wcsph_sound_speed)",
             which, (double)where[0], (double)where[1], (double)where[2], (double)w->time, w->step, (double)w->rho_0);
}

static PetscErrorCode UpdateDensity(PgWcsph w)
{
  PgWcsphArrays f;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetArrays(w, &f));
  if (w->density == PG_WCSPH_SUMMATION) {
    PetscCall(PgWcsphSumDensity(w));
  } else if (w->pending > 0.0) {
    PetscCall(PgWcsphDensityRate(w, w->rate));
    for (PetscInt a = 0; a < f.owned; a++) f.rho[a] += 0.5 * w->pending * w->rate[a];
  }
  for (PetscInt a = 0; a < f.owned; a++)
    if (PgWcsphIsLiquid(&f, a) || w->solid == PG_WCSPH_OWN) f.p[a] = PgWcsphPressure(w, f.rho[a]);
  w->pending = 0.0;
  PetscCall(Guard(w, &f));
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphForces(PgWcsph w)
{
  const PgField updated[] = {w->rho, w->p, w->slip_velocity, w->contact_pressure}, solid[] = {w->rho, w->p};

  PetscFunctionBeginUser;
  PetscCall(UpdateLists(w));
  PetscCall(PgStagePush(PG_STAGE_GEOMETRY));
  PetscCall(PgWcsphUpdatePairs(w));
  PetscCall(PgStagePop());
  PetscCall(PgStagePush(PG_STAGE_CORRECTOR));
  PetscCall(UpdateDensity(w));
  PetscCall(PgWcsphSolidVelocity(w));
  PetscCall(PgStagePop());
  PetscCall(Halo(w, 4, updated));
  if (w->solid != PG_WCSPH_OWN) PetscCall(PgWcsphSolidPressure(w));
  if (w->solid == PG_WCSPH_EXTRAPOLATED || w->solid == PG_WCSPH_ADJOINT) PetscCall(Halo(w, 2, solid));
  PetscCall(PgStagePush(PG_STAGE_CONTACT));
  PetscCall(PgWcsphPairForces(w));
  PetscCall(PgStagePop());
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphStep(PgWcsph w, PetscReal dt)
{
  PetscFunctionBeginUser;
  PetscCall(PgWcsphKick(w, 0.5 * dt));
  PetscCall(PgWcsphDrift(w, dt));
  PetscCall(PgWcsphForces(w));
  PetscCall(PgWcsphKick(w, 0.5 * dt));
  PetscFunctionReturn(0);
}
