/* Velocity Verlet in two halves. Each half kick is a loop of its own with its own rounding, so that Kick
   followed by KickDrift gives the same bits however the two are arranged. */
#include "demimpl.h"

/* v += h F/m and w += h T/I with I = m r^2/2, Eqs. 1 and 2. Discs on plates have no force along what is
   prescribed, so this leaves their prescribed velocities alone. */
PG_CLONES PetscErrorCode PgDemHalfKick_Private(PgDem dem, PetscReal h, PetscInt first, PetscInt end)
{
  PetscReal *restrict v, *restrict w, *F, *T, *m, *r;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetArray(dem->particles, PG_VELOCITY, (PetscReal **)&v));
  PetscCall(PgParticlesGetArray(dem->particles, PG_ANGULAR_VELOCITY, (PetscReal **)&w));
  PetscCall(PgParticlesGetArray(dem->particles, PG_MASS, &m));
  PetscCall(PgParticlesGetArray(dem->particles, PG_RADIUS, &r));
  PetscCall(PgParticlesGetArray(dem->particles, dem->force, &F));
  PetscCall(PgParticlesGetArray(dem->particles, dem->torque, &T));
  for (PetscInt i = first; i < end; i++) {
    const PetscReal a = h / m[i];

    v[2 * i] += a * F[2 * i];
    v[2 * i + 1] += a * F[2 * i + 1];
    w[i] += a * T[i] / (0.5 * r[i] * r[i]);
  }
  PetscCall(PetscLogFlops(9.0 * (end - first)));
  PetscFunctionReturn(0);
}

PG_CLONES static PetscErrorCode Drift(PgDem dem, PetscReal dt, PetscInt first, PetscInt end)
{
  PetscReal *restrict x, *restrict q, *v, *w;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetArray(dem->particles, PG_POSITION, (PetscReal **)&x));
  PetscCall(PgParticlesGetArray(dem->particles, PG_ROTATION, (PetscReal **)&q));
  PetscCall(PgParticlesGetArray(dem->particles, PG_VELOCITY, &v));
  PetscCall(PgParticlesGetArray(dem->particles, PG_ANGULAR_VELOCITY, &w));
  for (PetscInt i = 2 * first; i < 2 * end; i++) x[i] += dt * v[i];
  for (PetscInt i = first; i < end; i++) q[i] += dt * w[i];
  PetscCall(PetscLogFlops(6.0 * (end - first)));
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemKickDrift(PgDem dem, PetscReal dt)
{
  enum { STRETCH = 512 }; /* discs that stay in the cache from kick to drift */
  PetscInt owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(dem->particles, &owned, NULL, NULL));
  if (dem->energy) {
    PetscCall(PgDemBookBetween_Private(dem)); /* imposes the plates, too */
    PetscCall(PgDemHalfKick_Private(dem, 0.5 * dt, 0, owned));
    PetscCall(PgDemBookWork_Private(dem, 0.5 * dt, PETSC_FALSE));
    PetscCall(Drift(dem, dt, 0, owned));
  } else {
    PetscCall(PgDemImposePlates_Private(dem));
    for (PetscInt first = 0; first < owned; first += STRETCH) {
      const PetscInt end = PetscMin(first + STRETCH, owned);

      PetscCall(PgDemHalfKick_Private(dem, 0.5 * dt, first, end));
      PetscCall(Drift(dem, dt, first, end));
    }
  }
  PgDemMoveWalls_Private(dem, dt);
  dem->pairs_computed = PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemKick(PgDem dem, PetscReal dt)
{
  PetscInt owned;

  PetscFunctionBeginUser;
  PetscCall(PgDemImposePlates_Private(dem));
  PetscCall(PgParticlesGetSizes(dem->particles, &owned, NULL, NULL));
  PetscCall(PgDemHalfKick_Private(dem, 0.5 * dt, 0, owned));
  if (dem->energy) PetscCall(PgDemNoteKinetic_Private(dem));
  PetscFunctionReturn(0);
}
