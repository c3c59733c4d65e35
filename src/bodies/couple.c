/* Embedded particles, and what the liquid and other bodies do to a body. */
#include "bodiesimpl.h"

PetscErrorCode PgBodiesEmbed(PgBodies bodies, PetscInt body, PetscInt count, const PetscReal x[])
{
  PgBody *b = &bodies->body[body];

  PetscFunctionBeginUser;
  if (b->particles + count > b->room) {
    b->room = PetscMax(b->particles + count, 2 * b->room); /* particles may come one by one */
    PetscCall(PetscRealloc((size_t)b->room * sizeof *b->in, &b->in));
    PetscCall(PetscRealloc((size_t)b->room * 4 * sizeof *b->N, &b->N));
  }
  for (PetscInt k = 0; k < count; k++) {
    PetscBool found = PETSC_FALSE;

    for (PetscInt e = 0; e < b->cells && !found; e++) {
      b->in[b->particles] = e;
      found               = PgBodyLocate(b, e, &x[2 * k], &b->N[4 * b->particles]);
    }
    PgInputCheck(found, bodies->comm, "a particle at (%g, %g) m is outside of body %" PetscInt_FMT, (double)x[2 * k],
                 (double)x[2 * k + 1], body);
    b->particles++;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesEmbedLattice(PgBodies bodies, PetscInt body, PetscReal dx)
{
  PgBody   *b      = &bodies->body[body];
  PetscReal low[2] = {b->X[0], b->X[1]}, high[2] = {b->X[0], b->X[1]};
  PetscInt  n[2];

  PetscFunctionBeginUser;
  PgInputCheck(dx > 0, bodies->comm, "spacing of embedded particles %g m is not positive", (double)dx);
  for (PetscInt i = 0; i < 2 * b->nodes; i++) {
    low[i % 2]  = PetscMin(low[i % 2], b->X[i]);
    high[i % 2] = PetscMax(high[i % 2], b->X[i]);
  }
  for (int d = 0; d < 2; d++) n[d] = (PetscInt)((high[d] - low[d]) / dx + 0.5);
  for (PetscInt j = 0; j < n[1]; j++)
    for (PetscInt i = 0; i < n[0]; i++) {
      const PetscReal x[2] = {low[0] + ((PetscReal)i + 0.5) * dx, low[1] + ((PetscReal)j + 0.5) * dx};
      PetscReal       N[4];
      PetscBool       found = PETSC_FALSE;
      for (PetscInt e = 0; e < b->cells && !found; e++) found = PgBodyLocate(b, e, x, N);
      if (found) PetscCall(PgBodiesEmbed(bodies, body, 1, x));
    }
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesFind(PgBodies bodies, const PetscReal x[2], PetscInt *body)
{
  PetscReal N[4];

  PetscFunctionBeginUser;
  *body = -1;
  for (PetscInt k = 0; k < bodies->count && *body < 0; k++)
    for (PetscInt e = 0; e < bodies->body[k].cells && *body < 0; e++)
      if (PgBodyLocate(&bodies->body[k], e, x, N)) *body = k;
  PetscFunctionReturn(0);
}

/* sum N_s value of the nodes. */
static void At(const PgBody *b, PetscInt particle, const PetscReal value[], PetscReal result[2])
{
  const PetscInt  *node = &b->cell[4 * b->in[particle]];
  const PetscReal *N    = &b->N[4 * particle];

  for (int d = 0; d < 2; d++) {
    result[d] = 0;
    for (int i = 0; i < 4; i++) result[d] += N[i] * value[2 * node[i] + d];
  }
}

PetscErrorCode PgBodiesMotion(void *context, PetscInt count, const PetscInt body[], const PetscInt index[],
                              PetscReal x[], PetscReal v[])
{
  const PgBodies bodies = (PgBodies)context;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < count; k++) {
    const PgBody *b;
    if (body[k] >= bodies->count) continue;
    b = &bodies->body[body[k]];
    At(b, index[k], b->x, &x[2 * k]);
    At(b, index[k], bodies->integrator == PG_BODIES_VERLET ? b->way : b->v, &v[2 * k]);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesJoin(PgBodies bodies, PgWcsph wcsph)
{
  PgWcsphParticle *p;

  PetscFunctionBeginUser;
  bodies->particles = bodies->surface = 0;
  for (PetscInt k = 0; k < bodies->count; k++) {
    bodies->body[k].offset = bodies->particles;
    bodies->particles += bodies->body[k].particles;
    bodies->surface += bodies->body[k].edges;
  }
  PetscCall(PetscFree3(bodies->particle_force, bodies->surface_x, bodies->surface_p));
  PetscCall(PetscMalloc3(2 * bodies->particles, &bodies->particle_force, 2 * bodies->surface, &bodies->surface_x,
                         bodies->surface, &bodies->surface_p));
  PetscCall(PetscCalloc1(bodies->particles, &p));
  for (PetscInt k = 0; k < bodies->count; k++) {
    const PgBody *b = &bodies->body[k];
    for (PetscInt i = 0; i < b->particles; i++) {
      PgWcsphParticle *one = &p[b->offset + i];
      one->kind            = PG_WCSPH_BODY;
      one->body            = k;
      one->index           = i;
      At(b, i, b->x, one->x);
      At(b, i, b->v, one->v);
    }
  }
  PetscCall(PgWcsphAddParticles(wcsph, bodies->particles, p));
  PetscCall(PetscFree(p));
  PetscCall(PgWcsphSetMotion(wcsph, PgBodiesMotion, bodies));
  PetscFunctionReturn(0);
}

/* Each particle is with one rank: adding up zeros of the others is exact, and the rest is done in one order. */
static PetscErrorCode Reactions(PgBodies bodies, PgWcsph wcsph)
{
  PetscReal    *F = bodies->particle_force;
  PgWcsphSolids solids;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetSolids(wcsph, PG_WCSPH_BODY, &solids));
  PetscCall(PetscArrayzero(F, 2 * bodies->particles));
  for (PetscInt k = 0; k < solids.count; k++) {
    PetscInt p;
    if (solids.body[k] >= bodies->count) continue;
    p = bodies->body[solids.body[k]].offset + solids.index[k];
    for (int d = 0; d < 2; d++) F[2 * p + d] = solids.force[2 * k + d];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, F, (PetscMPIInt)(2 * bodies->particles), MPIU_REAL, MPI_SUM, bodies->comm));
  for (PetscInt k = 0; k < bodies->count; k++) {
    PgBody *b = &bodies->body[k];
    PetscCall(PetscArrayzero(b->force, 2 * b->nodes));
    for (PetscInt i = 0; i < b->particles; i++) {
      const PetscInt *node = &b->cell[4 * b->in[i]];
      for (int n = 0; n < 4; n++)
        for (int d = 0; d < 2; d++) b->force[2 * node[n] + d] += b->N[4 * i + n] * F[2 * (b->offset + i) + d];
    }
  }
  PetscFunctionReturn(0);
}

/* Q p with the pressure of the liquid around each node of the surface. */
static PetscErrorCode SurfacePressure(PgBodies bodies, PgWcsph wcsph)
{
  PetscInt at = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < bodies->count; k++)
    for (PetscInt e = 0; e < bodies->body[k].edges; e++, at++)
      for (int d = 0; d < 2; d++)
        bodies->surface_x[2 * at + d] = bodies->body[k].x[2 * bodies->body[k].edge[2 * e] + d];
  PetscCall(PgWcsphInterpolate(wcsph, bodies->surface, bodies->surface_x, bodies->surface_p, NULL, NULL));
  at = 0;
  for (PetscInt k = 0; k < bodies->count; k++) {
    PgBody *b = &bodies->body[k];
    PetscCall(PetscArrayzero(b->f, b->nodes)); /* borrowed: the next evaluation fills it anew */
    for (PetscInt e = 0; e < b->edges; e++, at++) b->f[b->edge[2 * e]] = bodies->surface_p[at];
    PetscCall(PetscArrayzero(b->force, 2 * b->nodes));
    PgBodyPressureForces(b, b->f, b->force);
    if (b->kind != PG_BODY_RIGID) PgBodyInternalForces(b);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesCouple(PgBodies bodies, PgWcsph wcsph)
{
  PetscFunctionBeginUser;
  PetscCheck(bodies->particle_force, bodies->comm, PETSC_ERR_ORDER, "PgBodiesJoin() comes before PgBodiesCouple()");
  if (bodies->coupling == PG_BODIES_Q)
    PetscCall(SurfacePressure(bodies, wcsph));
  else
    PetscCall(Reactions(bodies, wcsph));
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesSetForces(PgBodies bodies, PetscInt body, const PetscReal force[])
{
  PgBody *b = &bodies->body[body];

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(b->force, force, 2 * b->nodes));
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesSetPressure(PgBodies bodies, PetscInt body, const PetscReal pressure[])
{
  PgBody *b = &bodies->body[body];

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(b->force, 2 * b->nodes));
  PgBodyPressureForces(b, pressure, b->force);
  PetscFunctionReturn(0);
}
