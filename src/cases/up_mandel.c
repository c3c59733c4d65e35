/* Mandel's problem (1953), a quarter of it by symmetry.

   Physics   a slab between two rigid smooth plates that are pressed together by 2 F from t = 0; its sides x = +-a are
             drained and free of load. While the edges drain and soften, the load moves to the core, so that the pressure
             there rises above its first value before it falls: the effect of Mandel and Cryer, which the equation of
             diffusion alone does not have.
   Exact     p = 2 F B (1 + nu_u)/(3 a) sum sin s/(s - sin s cos s) (cos(s x/a) - cos s) exp(-s^2 c t/a^2), s the positive
             roots of tan s = (1 - nu)/(nu_u - nu) s (Cheng & Detournay 1988).
   Order     second in the size of cells when dt goes with its square. */
#include "up.h"

static PetscErrorCode Create(PgUp up, PetscOptionItems *PetscOptionsObject)
{
  PetscFunctionBeginUser;
  PetscCall(PgOptionReal(PetscOptionsObject, "-up_mandel_width", "half width a of the slab", "m", PG_POSITIVE, 1e6,
                         &up->size[0], NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-up_mandel_height", "half height of the slab", "m", PG_POSITIVE, 1e6,
                         &up->size[1], NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-up_mandel_force", "half F of the force on a plate", "N/m", -1e15, 1e15,
                         &up->load, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode Conditions(PgUp up)
{
  const PetscReal zero = 0.0, force = -up->load;

  PetscFunctionBeginUser;
  PetscCall(PgFemSetCondition(up->fem, "left", PG_FEM_DISPLACEMENT_X, &zero));
  PetscCall(PgFemSetCondition(up->fem, "bottom", PG_FEM_DISPLACEMENT_Y, &zero));
  PetscCall(PgFemSetCondition(up->fem, "right", PG_FEM_PRESSURE, &zero));
  PetscCall(PgFemSetCondition(up->fem, "top", PG_FEM_PLATE_Y, &force));
  PetscFunctionReturn(0);
}

static PetscErrorCode Prepare(PgUp up)
{
  PgFemMaterial   m;
  const PetscReal width = up->high[0] - up->low[0];

  PetscFunctionBeginUser;
  PetscCall(PgFemGetMaterial(up->fem, &m));
  up->probe[0] = up->low[0];
  up->probe[1] = up->low[1];
  up->dt       = 1.0;
  if (m.k > 0.0) up->dt = 2e-3 * width * width / PgFemConsolidation(&m);
  up->end = 500.0 * up->dt;
  PetscFunctionReturn(0);
}

static PetscErrorCode Settlement(PgUp up, PetscReal *settlement)
{
  PetscFunctionBeginUser;
  PetscCall(PgFemGetPlate(up->fem, "top", settlement));
  *settlement = -*settlement;
  PetscFunctionReturn(0);
}

const PgUpProblem PgUpMandel = {.name       = "up_mandel",
                                .title      = "a slab pressed between plates",
                                .defaults   = "",
                                .cells      = {20, 20},
                                .size       = {1.0, 1.0},
                                .load       = 1e4,
                                .width      = 0.0,
                                .create     = Create,
                                .conditions = Conditions,
                                .prepare    = Prepare,
                                .settlement = Settlement};
