/* What the columns of grains and water share: a hexagonal lattice of touching discs, periodic in x, so that there is
   no lateral strain. The bottom row stands on a smooth plate, whose reaction is the load of the history; the
   top row is free. */
#include "column.h"
#include <math.h>

PetscErrorCode PgColumnCreate(MPI_Comm comm, const char defaults[], const PgColumn1d *initial, void **context)
{
  PgColumn1d *column;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&column));
  *column = *initial;
  PetscCall(PgCaseDefaults(defaults));
  PetscOptionsBegin(comm, "", "case column_*: column of grains and water", "");
  PetscCall(PgLatticeOptions(PetscOptionsObject, "column", &column->lattice));
  PetscCall(PgOptionReal(PetscOptionsObject, "-column_load", "stress on the top row, downward", "Pa", 0.0, 1e12,
                         &column->load, NULL));
  if (!isnan(column->gradient))
    PetscCall(PgOptionReal(PetscOptionsObject, "-column_gradient",
                           "excess head of the bottom over that of the top, over the height", "1", -1e3, 1e3,
                           &column->gradient, NULL));
  PetscOptionsEnd();
  *context = column;
  PetscFunctionReturn(0);
}

/* The pressure of a drained bottom: that of water at rest, and the excess that drives the seepage. */
static PetscErrorCode SetGradient(const PgColumn1d *column, PgCaseSetup *setup)
{
  PgBoundary top, bottom;
  PetscReal  rho_f = 1000.0;

  PetscFunctionBeginUser;
  PetscCall(PgPoreGetBoundary(setup->pore, PG_SIDE_TOP, &top));
  PetscCall(PgPoreGetBoundary(setup->pore, PG_SIDE_BOTTOM, &bottom));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-fluid_density", &rho_f, NULL));
  PgInputCheck(top.kind == PG_BC_DRAINED && bottom.kind == PG_BC_DRAINED, setup->comm,
               "option -column_gradient needs -bc_bottom drained and -bc_top drained");
  bottom.pressure = top.pressure -
                    rho_f * setup->gravity[1] * PgLatticeHeight(&column->lattice) * (1.0 + column->gradient);
  PetscCall(PgPoreSetBoundary(setup->pore, PG_SIDE_BOTTOM, &bottom));
  PetscFunctionReturn(0);
}

PetscErrorCode PgColumnSetup(void *context, PgCaseSetup *setup)
{
  const PgColumn1d *column  = (const PgColumn1d *)context;
  const PgLattice  *lattice = &column->lattice;
  PgField           field;
  const PetscInt   *id;
  PetscReal        *force;
  PetscInt          owned;

  PetscFunctionBeginUser;
  PetscCall(PgLatticeSetup(lattice, setup));
  PetscCall(PgParticlesFindField(setup->particles, "external_force", &field));
  PetscCall(PgParticlesGetArray(setup->particles, field, &force));
  PetscCall(PgParticlesGetIds(setup->particles, &id));
  PetscCall(PgParticlesGetSizes(setup->particles, &owned, NULL, NULL));
  for (PetscInt i = 0; i < owned; i++)
    if (id[i] / lattice->columns == lattice->rows - 1) force[2 * i + 1] = -column->load * PgLatticeSpacing(lattice);
  if (setup->pore && !isnan(column->gradient)) PetscCall(SetGradient(column, setup));
  setup->end_time = column->end_time;
  PetscFunctionReturn(0);
}

PetscErrorCode PgColumnDestroy(void **context)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(*context));
  PetscFunctionReturn(0);
}
