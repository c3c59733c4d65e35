/* Registration of cases, and what all of them need. */
#include "casesimpl.h"

static const PgCaseInfo *const cases[] = {
    &PgCasePanel,           &PgCasePacking,           &PgCaseBox,
    &PgCaseBedDarcy,        &PgCaseBedErgun,          &PgCaseBedNsToDarcy,
    &PgCaseColumn,          &PgCaseColumnHydrostatic, &PgCaseColumnTerzaghi,
    &PgCaseColumnSeepage,   &PgCaseUndrained,         &PgCaseDiscCollision,
    &PgCaseDiscOnPlane,     &PgCaseDiscOnIncline,     &PgCaseLatticeModulus,
    &PgCaseBiaxial,         &PgCaseOperatorMms,       &PgCasePressureMms,
    &PgCaseUpTerzaghi,      &PgCaseUpMandel,          &PgCaseUpFooting,
    &PgCaseWcsphPoiseuille, &PgCaseWcsphCouette,      &PgCaseWcsphHydrostatic,
    &PgCaseTakTwoElements,  &PgCaseTakBlock,
};
enum { CASES = sizeof cases / sizeof *cases };
static const char *names[CASES];

PetscErrorCode PgCaseFind(const char name[], const PgCaseInfo **info)
{
  PetscFunctionBeginUser;
  *info = NULL;
  for (size_t i = 0; i < CASES; i++) {
    PetscBool same;
    PetscCall(PetscStrcmp(name, cases[i]->name, &same));
    if (same) *info = cases[i];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgCaseGetNames(PetscInt *count, const char *const *list[])
{
  PetscFunctionBeginUser;
  for (size_t i = 0; i < CASES; i++) names[i] = cases[i]->name;
  *count = CASES;
  *list  = names;
  PetscFunctionReturn(0);
}

PetscErrorCode PgCaseDealDiscs(PgCaseSetup *setup, PetscInt64 total, PetscInt *first, PetscInt *owned)
{
  PetscMPIInt rank, size;
  PetscInt   *id;

  PetscFunctionBeginUser;
  PgInputCheck(total < PETSC_MAX_INT / 64, setup->comm, "%lld discs are too many for the integers of this PETSc",
               (long long)total);
  PetscCallMPI(MPI_Comm_rank(setup->comm, &rank));
  PetscCallMPI(MPI_Comm_size(setup->comm, &size));
  *first = (PetscInt)(total * rank / size);
  *owned = (PetscInt)(total * (rank + 1) / size) - *first;
  PetscCall(PetscMalloc1(*owned, &id));
  for (PetscInt i = 0; i < *owned; i++) id[i] = *first + i;
  PetscCall(PgParticlesSetDiscs(setup->particles, *owned, id));
  PetscCall(PetscFree(id));
  PetscFunctionReturn(0);
}

PetscErrorCode PgCaseGetArrays(const PgCaseSetup *setup, PgCaseArrays *arrays)
{
  PgField field;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(arrays, sizeof *arrays));
  PetscCall(PgParticlesGetArray(setup->particles, PG_POSITION, &arrays->x));
  PetscCall(PgParticlesGetArray(setup->particles, PG_VELOCITY, &arrays->v));
  PetscCall(PgParticlesGetArray(setup->particles, PG_RADIUS, &arrays->radius));
  PetscCall(PgParticlesFindField(setup->particles, "plate", &field));
  PetscCall(PgParticlesGetArray(setup->particles, field, &arrays->plate));
  PetscCall(PgParticlesFindField(setup->particles, "initial_porosity", &field));
  if (field >= 0) PetscCall(PgParticlesGetArray(setup->particles, field, &arrays->porosity));
  if (!setup->pore) PetscFunctionReturn(0);
  PetscCall(PgParticlesFindField(setup->particles, "side", &field));
  PetscCall(PgParticlesGetArray(setup->particles, field, &arrays->side));
  PetscFunctionReturn(0);
}

PetscErrorCode PgCaseFinishDiscs(PgCaseSetup *setup)
{
  PetscReal *x, *start, *radius, *mass;
  PetscInt   owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(setup->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(setup->particles, PG_POSITION, &x));
  PetscCall(PgParticlesGetArray(setup->particles, PG_INITIAL_POSITION, &start));
  PetscCall(PgParticlesGetArray(setup->particles, PG_RADIUS, &radius));
  PetscCall(PgParticlesGetArray(setup->particles, PG_MASS, &mass));
  for (PetscInt i = 0; i < owned; i++) mass[i] = PETSC_PI * radius[i] * radius[i] * setup->solid_density;
  PetscCall(PetscArraycpy(start, x, 2 * owned));
  PetscFunctionReturn(0);
}
