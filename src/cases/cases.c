/* Registration of cases, and what all of them need. */
#include "casesimpl.h"

static const PgCaseInfo *const cases[] = {
    &PgCasePanel,          &PgCasePacking,           &PgCaseBedDarcy,       &PgCaseBedErgun,
    &PgCaseBedNsToDarcy,   &PgCaseColumnHydrostatic, &PgCaseColumnTerzaghi, &PgCaseColumnSeepage,
    &PgCaseUndrained,      &PgCaseDiscCollision,     &PgCaseDiscOnPlane,    &PgCaseDiscOnIncline,
    &PgCaseLatticeModulus, &PgCaseBiaxial,
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
