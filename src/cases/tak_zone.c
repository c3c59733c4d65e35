/* Zones 1 and 2 of example 6.2: what passes between a continuum and the particles embedded in its side. */
#include "tak_zone.h"

PetscErrorCode PgTakZoneSetUp(PgTakZone *z, PetscReal dx, PetscInt inside, PetscInt beyond)
{
  const PetscInt rows = inside + 2 * beyond;
  PgFemNodes     nodes;

  PetscFunctionBeginUser;
  PetscCall(PgFemSetUp(z->fem));
  PetscCall(PgFemGetNodes(z->fem, &nodes));
  z->particles = PG_TAK_ZONE_LAYERS * rows;
  PetscCall(PetscCalloc5(z->count + 1, &z->local, 2 * (z->count + 1), &z->u0, 2 * (z->count + 1), &z->u1,
                         2 * (z->count + 1), &z->v, 2 * (z->count + 1), &z->force));
  PetscCall(PetscCalloc3(2 * nodes.count, &z->nodal, 2 * z->particles, &z->X, 2 * z->particles, &z->particle_force));
  for (PetscInt j = 0; j <= z->count; j++) z->local[j] = -1;
  for (PetscInt i = 0; i < nodes.count; i++)
    if (nodes.owned[i] && PetscAbsReal(nodes.x[2 * i] - z->at) < 1e-6 * dx)
      z->local[(PetscInt)(nodes.x[2 * i + 1] / z->L * (PetscReal)z->count + 0.5)] = i;
  for (PetscInt c = 0; c < PG_TAK_ZONE_LAYERS; c++)
    for (PetscInt r = 0; r < rows; r++) {
      PetscReal *X = &z->X[2 * (c * rows + r)];
      X[0]         = z->at + (z->left ? 1 : -1) * ((PetscReal)c + 0.5) * dx;
      X[1]         = ((PetscReal)(r - beyond) + 0.5) * dx;
    }
  PetscFunctionReturn(0);
}

PetscErrorCode PgTakZoneDestroy(PgTakZone *z)
{
  PetscFunctionBeginUser;
  PetscCall(PgFemDestroy(&z->fem));
  PetscCall(PetscFree5(z->local, z->u0, z->u1, z->v, z->force));
  PetscCall(PetscFree3(z->nodal, z->X, z->particle_force));
  PetscFunctionReturn(0);
}

PetscErrorCode PgTakZoneAddParticles(const PgTakZone *z, PgWcsph wcsph)
{
  PgWcsphParticle *p;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(z->particles, &p));
  for (PetscInt i = 0; i < z->particles; i++) {
    p[i].kind  = PG_WCSPH_BODY;
    p[i].body  = z->body;
    p[i].index = i;
    PetscCall(PetscArraycpy(p[i].x, &z->X[2 * i], 2));
  }
  PetscCall(PgWcsphAddParticles(wcsph, z->particles, p));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

/* Displacement of the side at a height, or velocity: linear between the nodes, constant beyond. */
static void AtHeight(const PgTakZone *z, PetscReal y, PetscInt *j, PetscReal *part)
{
  const PetscReal s = PetscMin(PetscMax(y / z->L, 0.0), 1.0) * (PetscReal)z->count;

  *j    = PetscMin((PetscInt)s, z->count - 1);
  *part = s - (PetscReal)*j;
}

void PgTakZoneMove(const PgTakZone *z, PetscInt index, PetscReal done, PetscReal x[2], PetscReal v[2])
{
  PetscInt  j;
  PetscReal part;

  AtHeight(z, z->X[2 * index + 1], &j, &part);
  for (int d = 0; d < 2; d++) {
    const PetscReal before = (1 - part) * z->u0[2 * j + d] + part * z->u0[2 * j + 2 + d];
    const PetscReal after  = (1 - part) * z->u1[2 * j + d] + part * z->u1[2 * j + 2 + d];
    x[d]                   = z->X[2 * index + d] + before + done * (after - before);
    v[d]                   = (1 - part) * z->v[2 * j + d] + part * z->v[2 * j + 2 + d];
  }
}

PetscErrorCode PgTakZoneTakeForces(PgTakZone *z, const PgWcsphSolids *solids)
{
  PgFemNodes nodes;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(z->particle_force, 2 * z->particles));
  for (PetscInt n = 0; n < solids->count; n++)
    if (solids->body[n] == z->body)
      PetscCall(PetscArraycpy(&z->particle_force[2 * solids->index[n]], &solids->force[2 * n], 2));
  PetscCallMPI(
      MPI_Allreduce(MPI_IN_PLACE, z->particle_force, (PetscMPIInt)(2 * z->particles), MPIU_REAL, MPI_SUM, z->comm));
  PetscCall(PetscArrayzero(z->force, 2 * (z->count + 1)));
  z->total[0] = z->total[1] = 0.0;
  for (PetscInt i = 0; i < z->particles; i++) {
    PetscInt  j;
    PetscReal part;
    AtHeight(z, z->X[2 * i + 1], &j, &part);
    for (int d = 0; d < 2; d++) {
      const PetscReal F = z->particle_force[2 * i + d];
      z->force[2 * j + d] += (1 - part) * F;
      z->force[2 * j + 2 + d] += part * F;
      z->total[d] += F;
    }
  }
  PetscCall(PgFemGetNodes(z->fem, &nodes));
  PetscCall(PetscArrayzero(z->nodal, 2 * nodes.count));
  for (PetscInt j = 0; j <= z->count; j++)
    if (z->local[j] >= 0) PetscCall(PetscArraycpy(&z->nodal[2 * z->local[j]], &z->force[2 * j], 2));
  PetscCall(PgFemSetNodalForces(z->fem, z->nodal));
  PetscFunctionReturn(0);
}

PetscErrorCode PgTakZoneStep(PgTakZone *z, PetscReal dt, PgSolves *solves)
{
  const PetscInt n = 2 * (z->count + 1);
  PgFemNodes     nodes;
  PgFemStats     stats;

  PetscFunctionBeginUser;
  PetscCall(PgFemStep(z->fem, dt));
  PetscCall(PgFemGetStats(z->fem, &stats));
  PgSolvesAdd(solves, stats.iterations);
  PetscCall(PgFemGetNodes(z->fem, &nodes));
  PetscCall(PetscArraycpy(z->u0, z->u1, n));
  PetscCall(PetscArrayzero(z->u1, n));
  for (PetscInt j = 0; j <= z->count; j++)
    if (z->local[j] >= 0) PetscCall(PetscArraycpy(&z->u1[2 * j], &nodes.displacement[2 * z->local[j]], 2));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, z->u1, (PetscMPIInt)n, MPIU_REAL, MPI_SUM, z->comm));
  for (PetscInt i = 0; i < n; i++) z->v[i] = (z->u1[i] - z->u0[i]) / dt;
  PetscFunctionReturn(0);
}

PetscReal PgTakZoneWay(const PgTakZone *z, PetscReal done)
{
  PetscReal way = 0.0;

  for (PetscInt j = 0; j <= z->count; j++) /* trapezoidal over the side */
    way += (j == 0 || j == z->count ? 0.5 : 1.0) * (z->u0[2 * j] + done * (z->u1[2 * j] - z->u0[2 * j]));
  return way / (PetscReal)z->count;
}
