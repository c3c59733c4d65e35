/* The hexagonal lattice of the fixed beds and columns. */
#include "lattice.h"

PetscErrorCode PgLatticeOptions(PetscOptionItems *PetscOptionsObject, const char prefix[], PgLattice *lattice)
{
  char name[64];

  PetscFunctionBeginUser;
  /* a period must hold three cells of the neighbour search, 5.2 radii each */
  PetscCall(PetscSNPrintf(name, sizeof name, "-%s_columns", prefix));
  PetscCall(
      PgOptionInt(PetscOptionsObject, name, "discs in a row, in one period of x", 8, 1000000, &lattice->columns, NULL));
  PetscCall(PetscSNPrintf(name, sizeof name, "-%s_rows", prefix));
  PetscCall(PgOptionInt(PetscOptionsObject, name, "rows of discs", 4, 1000000, &lattice->rows, NULL));
  PetscCall(PetscSNPrintf(name, sizeof name, "-%s_radius", prefix));
  PetscCall(
      PgOptionReal(PetscOptionsObject, name, "radius of the discs", "m", PG_POSITIVE, 1e3, &lattice->radius, NULL));
  PetscFunctionReturn(0);
}

PetscReal PgLatticeSpacing(const PgLattice *lattice)
{
  const PetscReal touching = 1.0 - PETSC_PI / (2.0 * PetscSqrtReal(3.0));

  if (lattice->porosity < 0.0) return 2.0 * lattice->radius;
  return 2.0 * lattice->radius * PetscSqrtReal((1.0 - touching) / (1.0 - lattice->porosity));
}

PetscReal PgLatticeHeight(const PgLattice *lattice)
{
  return 0.5 * PetscSqrtReal(3.0) * PgLatticeSpacing(lattice) * (PetscReal)(lattice->rows - 1);
}

static PetscErrorCode Place(const PgLattice *lattice, PgCaseSetup *setup, PetscInt first, PetscInt owned)
{
  const PetscReal s = PgLatticeSpacing(lattice), cell = 0.5 * PetscSqrtReal(3.0) * s * s;
  PgCaseArrays    a;

  PetscFunctionBeginUser;
  PetscCall(PgCaseGetArrays(setup, &a));
  for (PetscInt i = 0; i < owned; i++) {
    const PetscInt  row = (first + i) / lattice->columns, column = (first + i) % lattice->columns;
    const PetscReal r = row < lattice->layer_rows ? lattice->layer_radius : lattice->radius;

    a.radius[i]    = r;
    a.x[2 * i]     = s * ((PetscReal)column + (row % 2 ? 0.75 : 0.25));
    a.x[2 * i + 1] = lattice->radius + 0.5 * PetscSqrtReal(3.0) * s * (PetscReal)row;
    a.plate[i]     = lattice->held || row == 0 ? 1.0 : 0.0;
    if (a.side) a.side[i] = (PetscReal)((row == 0) << PG_SIDE_BOTTOM | (row == lattice->rows - 1) << PG_SIDE_TOP);
    if (a.porosity) a.porosity[i] = 1.0 - PETSC_PI * r * r / cell;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgLatticeSetup(const PgLattice *lattice, PgCaseSetup *setup)
{
  const PetscInt64 total = (PetscInt64)lattice->columns * lattice->rows;
  const PgPlate    bed = {"bed", -1.0, 0.0, 0.0, PETSC_TRUE}, lower = {"lower", -1.0, 0.0, 0.0, PETSC_FALSE};
  PetscInt         first, owned;

  PetscFunctionBeginUser;
  PetscCall(PgCaseDealDiscs(setup, total, &first, &owned));
  PetscCall(PgParticlesSetPeriodicX(setup->particles, 0.0, PgLatticeSpacing(lattice) * (PetscReal)lattice->columns));
  PetscCall(PgDemAddPlate(setup->dem, lattice->held ? &bed : &lower, &setup->load_plate));
  PetscCall(Place(lattice, setup, first, owned));
  PetscCall(PgCaseFinishDiscs(setup));
  setup->height = PgLatticeHeight(lattice);
  PetscFunctionReturn(0);
}
