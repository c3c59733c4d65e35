/* A few discs, made on rank 0: for cases of one or two. */
#include "casesimpl.h"

PetscErrorCode PgCaseFewDiscs(PgCaseSetup *setup, PetscInt count, const PgCaseDisc disc[])
{
  PetscMPIInt rank;
  PetscInt    owned;
  PetscReal  *x, *v, *w, *r;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(setup->comm, &rank));
  owned = rank == 0 ? count : 0;
  {
    PetscInt *id;
    PetscCall(PetscMalloc1(count, &id));
    for (PetscInt i = 0; i < count; i++) id[i] = i;
    PetscCall(PgParticlesSetDiscs(setup->particles, owned, id));
    PetscCall(PetscFree(id));
  }
  PetscCall(PgParticlesGetArray(setup->particles, PG_POSITION, &x));
  PetscCall(PgParticlesGetArray(setup->particles, PG_VELOCITY, &v));
  PetscCall(PgParticlesGetArray(setup->particles, PG_ANGULAR_VELOCITY, &w));
  PetscCall(PgParticlesGetArray(setup->particles, PG_RADIUS, &r));
  for (PetscInt i = 0; i < owned; i++) {
    x[2 * i]     = disc[i].x[0];
    x[2 * i + 1] = disc[i].x[1];
    v[2 * i]     = disc[i].v[0];
    v[2 * i + 1] = disc[i].v[1];
    w[i]         = disc[i].spin;
    r[i]         = disc[i].radius;
  }
  PetscCall(PgCaseFinishDiscs(setup));
  PetscFunctionReturn(0);
}

PetscReal PgCaseDiscMass(const PgCaseSetup *setup, PetscReal radius)
{
  return PETSC_PI * radius * radius * setup->solid_density;
}

PetscErrorCode PgCaseDestroyContext(void **context)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(*context));
  PetscFunctionReturn(0);
}
