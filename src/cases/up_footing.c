/* A flexible strip footing on saturated ground that has no time to drain, half of it by symmetry.

   Physics   a uniform stress q on a strip of half width b; the ground below is held at its bottom, smooth at its sides,
             impermeable (or, with -up_footing_drained and a permeability, drained at its surface).
   Exact     of a half plane: the skeleton keeps its volume, so the water carries the mean stress, p = q theta/pi with
             theta the angle under which the strip is seen (Flamant).
   Locking   with the water locked in its pores bilinear displacements alone (-up_element q1) cannot keep the volume of
             every cell and bend: with the default material and 16 x 16 cells a third of the settlement comes out. Q1-Q1
             without stabilisation has pressures that alternate from node to node; with it, and with Q2-Q1, neither. */
#include "up.h"

static PetscErrorCode Create(PgUp up, PetscOptionItems *PetscOptionsObject)
{
  PetscFunctionBeginUser;
  PetscCall(PgOptionReal(PetscOptionsObject, "-up_footing_width", "half width b of the strip", "m", PG_POSITIVE, 1e6,
                         &up->width, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-up_footing_load", "stress on the strip, downward", "Pa", -1e12, 1e12,
                         &up->load, NULL));
  PetscCall(PgOptionReals(PetscOptionsObject, "-up_footing_size", "half width and depth of the ground", "m", 2,
                          up->size, NULL));
  PetscCall(PgOptionBool(PetscOptionsObject, "-up_footing_drained", "the surface lets water out", &up->drained, NULL));
  PgInputCheck(up->size[0] > up->width && up->size[1] > 0.0, up->comm,
               "option -up_footing_size: %g m by %g m, the ground must be wider than the strip, %g m, and deep",
               (double)up->size[0], (double)up->size[1], (double)up->width);
  PetscFunctionReturn(0);
}

static void Strip(void *context, PetscReal time, const PetscReal x[2], PetscReal value[2])
{
  const PgUp up = (PgUp)context;

  (void)time;
  value[0] = 0.0;
  value[1] = x[0] < up->width ? -up->load : 0.0;
}

static PetscErrorCode Conditions(PgUp up)
{
  const PetscReal zero = 0.0;

  PetscFunctionBeginUser;
  PetscCall(PgFemSetCondition(up->fem, "left", PG_FEM_DISPLACEMENT_X, &zero));
  PetscCall(PgFemSetCondition(up->fem, "right", PG_FEM_DISPLACEMENT_X, &zero));
  PetscCall(PgFemSetCondition(up->fem, "bottom", PG_FEM_DISPLACEMENT_X, &zero));
  PetscCall(PgFemSetCondition(up->fem, "bottom", PG_FEM_DISPLACEMENT_Y, &zero));
  PetscCall(PgFemSetConditionFunction(up->fem, "top", PG_FEM_TRACTION, Strip, up));
  if (up->drained) PetscCall(PgFemSetCondition(up->fem, "top", PG_FEM_PRESSURE, &zero));
  PetscFunctionReturn(0);
}

static PetscErrorCode Prepare(PgUp up)
{
  PgFemMaterial m;

  PetscFunctionBeginUser;
  PetscCall(PgFemGetMaterial(up->fem, &m));
  up->probe[0] = up->low[0];
  up->probe[1] = up->high[1] - up->width;
  up->dt = up->end = 1.0; /* what cannot drain does not depend on time */
  if (m.k > 0.0 && up->drained) {
    up->end = up->width * up->width / PgFemConsolidation(&m);
    up->dt  = 1e-2 * up->end;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Settlement(PgUp up, PetscReal *settlement)
{
  const PetscReal top[2] = {up->low[0], up->high[1]};

  PetscFunctionBeginUser;
  PetscCall(PgUpSettlementAt(up, top, settlement));
  PetscFunctionReturn(0);
}

const PgUpProblem PgUpFooting = {.name       = "up_footing",
                                 .defaults   = "-up_permeability 0 -up_poisson 0.3 -up_bulk_water 2.2e9",
                                 .cells      = {32, 32},
                                 .size       = {8.0, 8.0},
                                 .load       = 1e4,
                                 .width      = 1.0,
                                 .create     = Create,
                                 .conditions = Conditions,
                                 .prepare    = Prepare,
                                 .settlement = Settlement};
