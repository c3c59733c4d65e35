/* Packings made by rule or by chance.

   Random numbers: splitmix64 (Steele, Lea & Flood 2014), whose n-th output is a function of seed and n alone. A disc
   draws outputs 8 id .. 8 id + 7. PETSc's PetscRandom goes on from number to number on each rank, so that its discs
   would depend on the number of ranks. */
#include "packingimpl.h"

enum { DRAWS = 8 };

static uint64_t Mix(uint64_t z)
{
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return z ^ (z >> 31);
}

PetscReal PgPackingRandom(PetscInt seed, PetscInt id, PetscInt draw)
{
  const uint64_t n = (uint64_t)DRAWS * (uint64_t)id + (uint64_t)draw;
  const uint64_t z = Mix((uint64_t)seed + (n + 1) * UINT64_C(0x9e3779b97f4a7c15));

  return (PetscReal)(z >> 11) * (PetscReal)0x1p-53;
}

enum { DRAW_RADIUS, DRAW_X, DRAW_Y };

PetscReal PgPackingDrawRadius(const PgPackingPlan *plan, PetscInt id)
{
  const PetscReal u = PgPackingRandom(plan->seed, id, DRAW_RADIUS);

  if (plan->second > 0) return u < plan->share ? plan->second : plan->radius;
  return plan->radius * (1 + plan->spread * (2 * u - 1));
}

/* ---- lattices ---- */

/* Rows of `columns` discs; in a hexagonal packing every other one is shifted by a radius and, unless x is periodic,
   one disc shorter. */
typedef struct {
  PetscInt  columns, shorter;
  PetscReal r, rise;
} Lattice;

static PetscInt64 DiscsBelow(const Lattice *lattice, PetscInt64 row)
{
  return row * lattice->columns - row / 2 * lattice->shorter;
}

static void LatticeRow(const Lattice *lattice, PetscInt id, PetscInt *row, PetscInt *column)
{
  PetscInt64 k = 2 * ((PetscInt64)id / (2 * (PetscInt64)lattice->columns - lattice->shorter));

  if (id >= DiscsBelow(lattice, k + 1)) k++;
  *row    = (PetscInt)k;
  *column = (PetscInt)(id - DiscsBelow(lattice, k));
}

static PetscErrorCode CheckCount(MPI_Comm comm, PetscReal count)
{
  const PetscReal most = (PetscReal)(PETSC_MAX_INT / 64);

  PetscFunctionBeginUser;
  PgInputCheck(count >= 1, comm, "option -packing_size: not one disc fits in");
  PgInputCheck(count < most, comm, "%g discs are too many for the integers of this PETSc", (double)count);
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeLattice(MPI_Comm comm, const PgPackingPlan *plan, PgPacking *packing, PgBox *box)
{
  const PetscReal r = plan->radius, most = 1 + 1e-9; /* a size may be a multiple of 2 r but for rounding */
  const PetscBool hexagonal = (PetscBool)(plan->make == PG_MAKE_HEXAGONAL);
  Lattice         lattice   = {1, hexagonal && !plan->periodic, r, hexagonal ? PetscSqrtReal(3.0) * r : 2 * r};
  PetscReal       columns, rows;
  PetscInt        global = plan->count, row, column;

  PetscFunctionBeginUser;
  if (global) {
    columns = PetscMax(1.0, PetscFloorReal(PetscSqrtReal(global * lattice.rise / (2 * r * plan->aspect)) + 0.5));
  } else {
    columns = PetscFloorReal(plan->size[0] / (2 * r) * most);
    rows    = PetscFloorReal((plan->size[1] * most - 2 * r) / lattice.rise) + 1;
    PetscCall(CheckCount(comm, columns < 1 || rows < 1 ? 0.0 : columns * rows));
    global = (PetscInt)(rows * columns - PetscFloorReal(rows / 2) * (PetscReal)lattice.shorter);
  }
  lattice.columns = (PetscInt)columns;
  LatticeRow(&lattice, global - 1, &row, &column);
  *box = (PgBox){{0, 0}, {2 * r * columns, 2 * r + lattice.rise * (PetscReal)row}};
  PetscCall(PgPackingCreate(comm, global, packing));
  for (PetscInt i = 0; i < packing->count; i++) {
    LatticeRow(&lattice, packing->start + i, &row, &column);
    packing->radius[i]           = r;
    packing->position[2 * i]     = r * (2 * (PetscReal)column + (hexagonal && row % 2 ? 2 : 1));
    packing->position[2 * i + 1] = r + lattice.rise * (PetscReal)row;
  }
  PetscFunctionReturn(0);
}

/* ---- random ---- */

/* Mean of pi r^2 of what PgPackingDrawRadius() draws. */
static PetscReal MeanArea(const PgPackingPlan *plan)
{
  const PetscReal first = PETSC_PI * plan->radius * plan->radius;

  if (plan->second > 0) return plan->share * PETSC_PI * plan->second * plan->second + (1 - plan->share) * first;
  return first * (1 + plan->spread * plan->spread / 3);
}

/* Draws radii, and fits the box to the discs or, by a little, the discs to the box. */
static PetscErrorCode DrawDiscs(MPI_Comm comm, const PgPackingPlan *plan, PgPacking *packing, PgBox *box)
{
  PgExactSum sum  = {.not_finite = 0};
  PetscReal  area = plan->size[0] * plan->size[1], solid, scale = 1;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < packing->count; i++) {
    const PetscReal r  = PgPackingDrawRadius(plan, packing->start + i);
    packing->radius[i] = r;
    PgExactSumAdd(&sum, PETSC_PI * r * r);
  }
  PetscCall(PgExactSumReduce(comm, 1, &sum, &solid));
  if (plan->count) {
    area = solid / (1 - plan->target);
    *box = (PgBox){{0, 0}, {PetscSqrtReal(area / plan->aspect), PetscSqrtReal(area * plan->aspect)}};
  } else {
    scale = PetscSqrtReal((1 - plan->target) * area / solid);
    *box  = (PgBox){{0, 0}, {plan->size[0], plan->size[1]}};
  }
  for (PetscInt i = 0; i < packing->count; i++) {
    const PetscInt id = packing->start + i;

    packing->radius[i] *= scale;
    for (int d = 0; d < 2; d++) {
      const PetscReal margin       = d == 0 && plan->periodic ? 0 : packing->radius[i];
      packing->position[2 * i + d] = margin +
                                     PgPackingRandom(plan->seed, id, d ? DRAW_Y : DRAW_X) * (box->high[d] - 2 * margin);
    }
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeRandom(MPI_Comm comm, const PgPackingPlan *plan, PetscBool only_ids, PgPacking *packing,
                                 PgBox *box)
{
  PetscInt  global = plan->count;
  PetscReal r_max  = PetscMax(plan->radius * (1 + plan->spread), plan->second);
  PetscReal narrowest;

  PetscFunctionBeginUser;
  if (!global) {
    const PetscReal count = (1 - plan->target) * plan->size[0] * plan->size[1] / MeanArea(plan);
    PetscCall(CheckCount(comm, count));
    global = (PetscInt)PetscFloorReal(count + 0.5);
  }
  PetscCall(PgPackingCreate(comm, global, packing));
  PetscCall(DrawDiscs(comm, plan, packing, box));
  narrowest = PetscMin(box->high[0], box->high[1]);
  PgInputCheck(narrowest > 4 * r_max, comm,
               "a box of %g x %g m is too narrow for a random packing: the largest of %" PetscInt_FMT
               " discs has a radius of %g m",
               (double)box->high[0], (double)box->high[1], global, (double)r_max);
  if (!only_ids) PetscCall(PgPackingPress(comm, plan, box, packing));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPackingGenerate(MPI_Comm comm, const PgPackingPlan *plan, PetscBool only_ids, PgPacking *packing,
                                 PgBox *box)
{
  PetscFunctionBeginUser;
  if (plan->make == PG_MAKE_RANDOM)
    PetscCall(MakeRandom(comm, plan, only_ids, packing, box));
  else
    PetscCall(MakeLattice(comm, plan, packing, box));
  packing->periodic = plan->periodic;
  packing->low      = box->low[0];
  packing->high     = box->high[0];
  PetscFunctionReturn(0);
}
