/* Velocity Verlet in two halves. Each half kick is a loop of its own with its own rounding, so that Kick
   followed by KickDrift gives the same bits however the two are arranged. */
#include "demimpl.h"

/* v += h F/m and w += h T/I with I = m r^2/2, Eqs. 1 and 2. Discs on plates have no force along what is
   prescribed, so this leaves their prescribed velocities alone. */
static PetscErrorCode HalfKick(PgDem dem, PetscReal h)
{
  PetscInt owned;
  PetscReal *restrict v, *restrict w, *F, *T, *m, *r;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(dem->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(dem->particles, PG_VELOCITY, (PetscReal **)&v));
  PetscCall(PgParticlesGetArray(dem->particles, PG_ANGULAR_VELOCITY, (PetscReal **)&w));
  PetscCall(PgParticlesGetArray(dem->particles, PG_MASS, &m));
  PetscCall(PgParticlesGetArray(dem->particles, PG_RADIUS, &r));
  PetscCall(PgParticlesGetArray(dem->particles, dem->force, &F));
  PetscCall(PgParticlesGetArray(dem->particles, dem->torque, &T));
  for (PetscInt i = 0; i < owned; i++) {
    const PetscReal a = h / m[i];

    v[2 * i] += a * F[2 * i];
    v[2 * i + 1] += a * F[2 * i + 1];
    w[i] += a * T[i] / (0.5 * r[i] * r[i]);
  }
  PetscCall(PetscLogFlops(9.0 * owned));
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemKickDrift(PgDem dem, PetscReal dt)
{
  PetscInt owned;
  PetscReal *restrict x, *restrict q, *v, *w;

  PetscFunctionBeginUser;
  if (dem->energy)
    PetscCall(PgDemBookBetween_Private(dem)); /* imposes the plates, too */
  else
    PetscCall(PgDemImposePlates_Private(dem));
  PetscCall(HalfKick(dem, 0.5 * dt));
  if (dem->energy) PetscCall(PgDemBookWork_Private(dem, 0.5 * dt, PETSC_FALSE));
  PetscCall(PgParticlesGetSizes(dem->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(dem->particles, PG_POSITION, (PetscReal **)&x));
  PetscCall(PgParticlesGetArray(dem->particles, PG_ROTATION, (PetscReal **)&q));
  PetscCall(PgParticlesGetArray(dem->particles, PG_VELOCITY, &v));
  PetscCall(PgParticlesGetArray(dem->particles, PG_ANGULAR_VELOCITY, &w));
  for (PetscInt i = 0; i < 2 * owned; i++) x[i] += dt * v[i];
  for (PetscInt i = 0; i < owned; i++) q[i] += dt * w[i];
  PgDemMoveWalls_Private(dem, dt);
  dem->pairs_computed = PETSC_FALSE;
  PetscCall(PetscLogFlops(6.0 * owned));
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemKick(PgDem dem, PetscReal dt)
{
  PetscFunctionBeginUser;
  PetscCall(PgDemImposePlates_Private(dem));
  PetscCall(HalfKick(dem, 0.5 * dt));
  if (dem->energy) PetscCall(PgDemNoteKinetic_Private(dem));
  PetscFunctionReturn(0);
}
