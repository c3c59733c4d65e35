/* Upward seepage and the critical gradient.

   Physics   a saturated column under gravity, drained at both ends; the head of the bottom exceeds that of the top by i
             times the height.
   Exact     the effective stress grows linearly with depth, (1 - i/i_c) (1 - n) (rho_s - rho_f) g z, with
             i_c = (1 - n) (rho_s/rho_f - 1) = 0.907 on the lattice, and so does the load of the plate; above i_c the
             column lifts off.
   Order     exact with the `corrected` Laplacian (linear pressure), first order in spacing/H with `paper`. */
#include "column.h"
#include <math.h>

static PetscErrorCode Create(MPI_Comm comm, void **context)
{
  const PgColumn1d initial = {{.columns = 8, .rows = 25, .radius = 5e-3, .porosity = -1.0}, 0.0, 0.5, 0.04};

  PetscFunctionBeginUser;
  PetscCall(PgColumnCreate(comm,
                           "-fluid darcy -gravity 0,-9.81 -dt 4e-6 -fluid_every 10 -coupling drag_and_pressure "
                           "-bc_bottom drained -bc_top drained -bc_top_pressure 100000 -dem_local_damping 0.7",
                           &initial, context));
  PetscFunctionReturn(0);
}

const PgCaseInfo PgCaseColumnSeepage = {"column_seepage", "upward seepage through a column: critical gradient",
                                        Create,           PgColumnSetup,
                                        PgColumnDestroy,  NULL};
