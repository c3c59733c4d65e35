/* Undrained loading: the water carries all of a new stress (Skempton 1954, B = 1 for incompressible water).

   Physics   the column of column_terzaghi, but observed at times far shorter than its consolidation: whatever is
             further from the drained top than water can have come by then does not know that it is drained. A sample without
             any outlet would leave the level of the pressure undetermined: the water is incompressible, and only
             pressure gradients act.
   Exact     dp = q, B = dp/q = 1 below the boundary layer of thickness sqrt(4 c_v t), no strain of the grains there.
   Order     none: B = 1 but for the row on the drained side and the layer that has begun to drain. */
#include "column.h"
#include <math.h>

static PetscErrorCode Create(MPI_Comm comm, void **context)
{
  const PgColumn1d initial = {{.columns = 8, .rows = 25, .radius = 5e-3, .porosity = -1.0}, 1e4, NAN, 7e-4};

  PetscFunctionBeginUser;
  PetscCall(PgColumnCreate(comm, PG_COLUMN_LOADED, &initial, context));
  PetscFunctionReturn(0);
}

const PgCaseInfo PgCaseUndrained = {
    "undrained",     "loading too quick for water to leave: pressure rises by the stress",
    Create,          PgColumnSetup,
    PgColumnDestroy, NULL};
