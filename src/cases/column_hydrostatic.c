/* A saturated column at rest under gravity, the plainest of the columns: `column` is another name for it.

   Physics   grains settle under their weight in water, drained at the top, on an impermeable bottom; the water acts on
             them by drag and pressure gradient (-coupling drag_and_pressure), so that they feel buoyancy.
   Exact     at rest p = p_0 + rho_f g (y_top - y), u = 0, and the plate carries the submerged weight of the grains,
             (rho_s - rho_f) g V each; without water their weight.
   Order     none: the pressure is solved as excess over the hydrostatic one, which is zero. What is left is what is
             left of the motion, and rounding. */
#include "column.h"
#include <math.h>

static PetscErrorCode Create(MPI_Comm comm, void **context)
{
  const PgColumn1d initial = {{.columns = 8, .rows = 25, .radius = 5e-3, .porosity = -1.0}, 0.0, NAN, 0.04};

  PetscFunctionBeginUser;
  PetscCall(PgColumnCreate(comm,
                           "-fluid darcy -gravity 0,-9.81 -dt 4e-6 -fluid_every 10 -coupling drag_and_pressure "
                           "-bc_bottom impermeable -bc_top drained -bc_top_pressure 100000 -dem_local_damping 0.7",
                           &initial, context));
  PetscFunctionReturn(0);
}

const PgCaseInfo PgCaseColumn = {"column", "the same as column_hydrostatic", Create, PgColumnSetup, PgColumnDestroy,
                                 NULL};
const PgCaseInfo PgCaseColumnHydrostatic = {"column_hydrostatic",
                                            "saturated column settling to rest under gravity",
                                            Create,
                                            PgColumnSetup,
                                            PgColumnDestroy,
                                            NULL};
