/* A flexible strip footing on saturated ground that has no time to drain, half of it by symmetry.

   Physics   a uniform stress q on a strip of half width b; the ground below is held at its bottom, smooth at its sides,
             impermeable (or, with -up_footing_drained and a permeability, drained at its surface).
   Load      integrated to the very edge of the strip, wherever that lies in a cell.
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

static PetscErrorCode Conditions(PgUp up)
{
  const PetscReal zero = 0.0, traction[2] = {0.0, -up->load};
  const PetscReal low[2] = {-up->width, -PETSC_MAX_REAL}, high[2] = {up->width, PETSC_MAX_REAL};

  PetscFunctionBeginUser;
  PetscCall(PgFemSetCondition(up->fem, "left", PG_FEM_DISPLACEMENT_X, &zero));
  PetscCall(PgFemSetCondition(up->fem, "right", PG_FEM_DISPLACEMENT_X, &zero));
  PetscCall(PgFemSetCondition(up->fem, "bottom", PG_FEM_DISPLACEMENT_X, &zero));
  PetscCall(PgFemSetCondition(up->fem, "bottom", PG_FEM_DISPLACEMENT_Y, &zero));
  PetscCall(PgFemSetLoadWithin(up->fem, "top", PG_FEM_TRACTION, low, high, traction));
  if (up->drained) PetscCall(PgFemSetCondition(up->fem, "top", PG_FEM_PRESSURE, &zero));
  PetscFunctionReturn(0);
}

/* How much of from..to along x the boundary "top" has. */
static PetscErrorCode Covered(PgUp up, PetscReal from, PetscReal to, PetscReal *length)
{
  PgFemEdges edges;
  PgFemNodes nodes;
  PetscReal  mine = 0.0;

  PetscFunctionBeginUser;
  PetscCall(PgFemGetEdges(up->fem, "top", &edges));
  PetscCall(PgFemGetNodes(up->fem, &nodes));
  for (PetscInt e = 0; e < edges.count; e++) {
    const PetscReal a = nodes.x[2 * edges.node[2 * e]], b = nodes.x[2 * edges.node[2 * e + 1]];
    mine += PetscMax(0.0, PetscMin(PetscMax(a, b), to) - PetscMax(PetscMin(a, b), from));
  }
  PetscCallMPI(MPI_Allreduce(&mine, length, 1, MPIU_REAL, MPIU_SUM, up->comm));
  PetscFunctionReturn(0);
}

/* The strip lies about x = 0; a mesh may have both halves of it or the right one. */
static PetscErrorCode CheckStrip(PgUp up)
{
  const PetscReal b = up->width, rounding = 1e-9 * (up->high[0] - up->low[0]);
  PetscReal       left, right;

  PetscFunctionBeginUser;
  PetscCall(Covered(up, -b, 0.0, &left));
  PetscCall(Covered(up, 0.0, b, &right));
  PgInputCheck(
      PetscAbsReal(right - b) <= rounding && (left <= rounding || PetscAbsReal(left - b) <= rounding), up->comm,
      "case up_footing: the strip of half width %g m lies on x = 0, but boundary 'top' has %g m of it to the left "
      "of x = 0 and %g m to the right",
      (double)b, (double)left, (double)right);
  PetscFunctionReturn(0);
}

static PetscErrorCode Prepare(PgUp up)
{
  PgFemMaterial m;

  PetscFunctionBeginUser;
  PetscCall(CheckStrip(up));
  PetscCall(PgFemGetMaterial(up->fem, &m));
  up->probe[0] = PetscMax(up->low[0], 0.0);
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
  const PetscReal top[2] = {PetscMax(up->low[0], 0.0), up->high[1]};

  PetscFunctionBeginUser;
  PetscCall(PgUpSettlementAt(up, top, settlement));
  PetscFunctionReturn(0);
}

const PgUpProblem PgUpFooting = {.name       = "up_footing",
                                 .title      = "a strip footing",
                                 .defaults   = "-up_permeability 0 -up_poisson 0.3 -up_bulk_water 2.2e9",
                                 .cells      = {32, 32},
                                 .size       = {8.0, 8.0},
                                 .load       = 1e4,
                                 .width      = 1.0,
                                 .create     = Create,
                                 .conditions = Conditions,
                                 .prepare    = Prepare,
                                 .settlement = Settlement};
