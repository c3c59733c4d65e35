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
  PetscReal      *x, *radius, *plate, *side = NULL, *porosity = NULL;
  PgField         field;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetArray(setup->particles, PG_POSITION, &x));
  PetscCall(PgParticlesGetArray(setup->particles, PG_RADIUS, &radius));
  PetscCall(PgParticlesFindField(setup->particles, "plate", &field));
  PetscCall(PgParticlesGetArray(setup->particles, field, &plate));
  if (setup->pore) {
    PetscCall(PgParticlesFindField(setup->particles, "side", &field));
    PetscCall(PgParticlesGetArray(setup->particles, field, &side));
    PetscCall(PgParticlesFindField(setup->particles, "initial_porosity", &field));
    PetscCall(PgParticlesGetArray(setup->particles, field, &porosity));
  }
  for (PetscInt i = 0; i < owned; i++) {
    const PetscInt  row = (first + i) / lattice->columns, column = (first + i) % lattice->columns;
    const PetscReal r = row < lattice->layer_rows ? lattice->layer_radius : lattice->radius;

    radius[i]    = r;
    x[2 * i]     = s * ((PetscReal)column + (row % 2 ? 0.75 : 0.25));
    x[2 * i + 1] = lattice->radius + 0.5 * PetscSqrtReal(3.0) * s * (PetscReal)row;
    plate[i]     = lattice->held || row == 0 ? 1.0 : 0.0;
    if (side) side[i] = (PetscReal)((row == 0) << PG_SIDE_BOTTOM | (row == lattice->rows - 1) << PG_SIDE_TOP);
    if (porosity) porosity[i] = 1.0 - PETSC_PI * r * r / cell;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgLatticeSetup(const PgLattice *lattice, PgCaseSetup *setup)
{
  const PetscInt64 total = (PetscInt64)lattice->columns * lattice->rows;
  const PgPlate    bed = {"bed", -1.0, 0.0, 0.0, PETSC_TRUE}, lower = {"lower", -1.0, 0.0, 0.0, PETSC_FALSE};
  PetscMPIInt      rank, size;
  PetscInt         first, owned, *id;

  PetscFunctionBeginUser;
  PgInputCheck(total < PETSC_MAX_INT / 64, setup->comm, "%lld discs are too many for the integers of this PETSc",
               (long long)total);
  PetscCallMPI(MPI_Comm_rank(setup->comm, &rank));
  PetscCallMPI(MPI_Comm_size(setup->comm, &size));
  first = (PetscInt)(total * rank / size);
  owned = (PetscInt)(total * (rank + 1) / size) - first;
  PetscCall(PetscMalloc1(owned, &id));
  for (PetscInt i = 0; i < owned; i++) id[i] = first + i;
  PetscCall(PgParticlesSetDiscs(setup->particles, owned, id));
  PetscCall(PetscFree(id));
  PetscCall(PgParticlesSetPeriodicX(setup->particles, 0.0, PgLatticeSpacing(lattice) * (PetscReal)lattice->columns));
  PetscCall(PgDemAddPlate(setup->dem, lattice->held ? &bed : &lower, &setup->load_plate));
  PetscCall(Place(lattice, setup, first, owned));
  PetscCall(PgCaseFinishDiscs(setup));
  setup->height = PgLatticeHeight(lattice);
  PetscFunctionReturn(0);
}
