/* One-dimensional consolidation of the continuum (Terzaghi 1943).

   Physics   a saturated column of height H, no lateral strain, bottom held and impermeable; the top is drained and bears
             a load q from t = 0.
   Exact     with water and grains incompressible, p/q = sum 2/m sin(m z/H) exp(-m^2 T), settlement = q H/M (1 - sum 2/m^2
             exp(-m^2 T)), m = (2 j + 1) pi/2, T = c_v t/H^2, z from the top, c_v = (k/mu_f) M.
   Order     second in the size of cells when dt goes with its square (backward Euler), for Q1-Q1 and Q2-Q1 alike: the
             pressure is bilinear in both. */
#include "up.h"

static PetscErrorCode Create(PgUp up, PetscOptionItems *PetscOptionsObject)
{
  PetscFunctionBeginUser;
  PetscCall(PgOptionReal(PetscOptionsObject, "-up_terzaghi_height", "height of the column; it is a tenth as wide", "m",
                         PG_POSITIVE, 1e6, &up->size[1], NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-up_terzaghi_load", "stress on the top, downward", "Pa", -1e12, 1e12,
                         &up->load, NULL));
  up->size[0] = 0.1 * up->size[1];
  PetscFunctionReturn(0);
}

static PetscErrorCode Conditions(PgUp up)
{
  const PetscReal zero = 0.0, stress = -up->load;

  PetscFunctionBeginUser;
  PetscCall(PgFemSetCondition(up->fem, "left", PG_FEM_DISPLACEMENT_X, &zero));
  PetscCall(PgFemSetCondition(up->fem, "right", PG_FEM_DISPLACEMENT_X, &zero));
  PetscCall(PgFemSetCondition(up->fem, "bottom", PG_FEM_DISPLACEMENT_Y, &zero));
  PetscCall(PgFemSetCondition(up->fem, "top", PG_FEM_NORMAL_STRESS, &stress));
  PetscCall(PgFemSetCondition(up->fem, "top", PG_FEM_PRESSURE, &zero));
  PetscFunctionReturn(0);
}

static PetscErrorCode Prepare(PgUp up)
{
  PgFemMaterial   m;
  const PetscReal height = up->high[1] - up->low[1];

  PetscFunctionBeginUser;
  PetscCall(PgFemGetMaterial(up->fem, &m));
  up->probe[0] = up->low[0];
  up->probe[1] = up->low[1];
  up->dt       = 1.0;
  if (m.k > 0.0) up->dt = 1e-3 * height * height / PgFemConsolidation(&m);
  up->end = 1e3 * up->dt;
  PetscFunctionReturn(0);
}

static PetscErrorCode Settlement(PgUp up, PetscReal *settlement)
{
  const PetscReal top[2] = {up->low[0], up->high[1]};

  PetscFunctionBeginUser;
  PetscCall(PgUpSettlementAt(up, top, settlement));
  PetscFunctionReturn(0);
}

const PgUpProblem PgUpTerzaghi = {.name       = "up_terzaghi",
                                  .title      = "consolidation of a column",
                                  .defaults   = "",
                                  .cells      = {2, 20},
                                  .size       = {0.1, 1.0},
                                  .load       = 1e4,
                                  .width      = 0.0,
                                  .create     = Create,
                                  .conditions = Conditions,
                                  .prepare    = Prepare,
                                  .settlement = Settlement};
