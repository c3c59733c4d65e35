/* One-dimensional consolidation (Terzaghi 1943).

   Physics   a saturated column, no lateral strain, impermeable bottom, drained top, a stress q on the top row from t = 0.
             The water is incompressible, so that it carries q at first and hands it over to the grains as it leaves.
   Exact     p/q = sum 2/M sin(M z/H) exp(-M^2 T), U = 1 - sum 2/M^2 exp(-M^2 T), M = (2 j + 1) pi/2,
             T = c_v t/H^2, z from the drained top; c_v = k_p C with the lattice modulus C = sqrt(3)/4 (3 k_n + k_s).
             No contact slides: the ratio of tangential to normal force of the slanted contacts is
             k_s/(sqrt(3) k_n) = 0.385 < mu_s.
   Time      with the paper's k_p consolidation takes 6e-5 s, less than a wave through the column (6e-4 s): that
             would be dynamics. The default k_p is 1000 times smaller, which makes it 100 times slower than the wave.
   Order     first in spacing/H: the drained row is half a row inside the surface; first in the fluid step. */
#include "column.h"
#include <math.h>

static PetscErrorCode Create(MPI_Comm comm, void **context)
{
  const PgColumn1d initial = {{.columns = 8, .rows = 25, .radius = 5e-3, .porosity = -1.0}, 1e4, NAN, 0.07};

  PetscFunctionBeginUser;
  PetscCall(PgColumnCreate(comm, PG_COLUMN_LOADED, &initial, context));
  PetscFunctionReturn(0);
}

const PgCaseInfo PgCaseColumnTerzaghi = {"column_terzaghi",
                                         "one-dimensional consolidation under a load on the top row",
                                         Create,
                                         PgColumnSetup,
                                         PgColumnDestroy,
                                         NULL};
