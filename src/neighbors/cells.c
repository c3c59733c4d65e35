/* Cell list of one rank, by counting sort. */
#include "neighborsimpl.h"
#include <stdlib.h>

/* Discs outside of the cells belong to the nearest one: partners stay in cells that touch. */
static inline PetscInt CellIndex(PetscReal x, PetscReal low, PetscReal per_length, PetscInt cells)
{
  const PetscReal i = (x - low) * per_length;

  return i <= 0 ? 0 : i >= (PetscReal)cells ? cells - 1 : (PetscInt)i;
}

static PetscBool TooMany(PetscInt n, const PetscReal extent[2], PetscReal cell)
{
  return (PetscBool)((extent[0] / cell + 1) * (extent[1] / cell + 1) > 4 * (PetscReal)n + 64);
}

static int Ascending(const void *a, const void *b)
{
  const PetscReal x = *(const PetscReal *)a, y = *(const PetscReal *)b;

  return (x > y) - (x < y);
}

/* The place and size of a box that leaves a growing share of the discs outside, up to an eighth on each side, until its
   cells are few enough: a disc that has flown off must not make all others share a cell. */
static PetscErrorCode TrimBox(PetscInt n, const PetscReal position[], PetscReal cell, PetscReal low[2],
                              PetscReal extent[2])
{
  PetscReal *sorted[2];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &sorted[0], n, &sorted[1]));
  for (int d = 0; d < 2; d++) {
    for (PetscInt i = 0; i < n; i++) sorted[d][i] = position[2 * i + d];
    qsort(sorted[d], (size_t)n, sizeof **sorted, Ascending); /* PetscSortReal() does not bear equal places */
  }
  for (PetscInt share = 1024; share >= 8 && TooMany(n, extent, cell); share /= 2) {
    const PetscInt out = (n + share - 1) / share;
    for (int d = 0; d < 2 && 2 * out < n; d++) {
      low[d]    = sorted[d][out];
      extent[d] = sorted[d][n - 1 - out] - low[d];
    }
  }
  PetscCall(PetscFree2(sorted[0], sorted[1]));
  PetscFunctionReturn(0);
}

/* Cells a little wider than `reach`, so that rounding cannot put partners two cells apart; wider still where
   the discs are so scattered that there would be many more cells than discs. */
static PetscErrorCode SetCells(PetscInt n, const PetscReal position[], PetscReal reach, PgCellList *list)
{
  PetscReal low[2] = {0, 0}, extent[2] = {0, 0}, cell = reach * (1 + 4 * PETSC_SQRT_MACHINE_EPSILON);

  PetscFunctionBeginUser;
  for (int d = 0; d < 2 && n > 0; d++) {
    PetscReal high = position[d];
    low[d]         = position[d];
    for (PetscInt i = 1; i < n; i++) {
      low[d] = PetscMin(low[d], position[2 * i + d]);
      high   = PetscMax(high, position[2 * i + d]);
    }
    extent[d] = high - low[d];
  }
  if (TooMany(n, extent, cell)) PetscCall(TrimBox(n, position, cell, low, extent));
  while (TooMany(n, extent, cell)) cell *= 1.25;
  for (int d = 0; d < 2; d++) {
    list->low[d]   = low[d];
    list->cells[d] = (PetscInt)(extent[d] / cell) + 1;
  }
  list->per_length = 1 / cell;
  PetscFunctionReturn(0);
}

static inline PetscInt CellOf(const PgCellList *list, const PetscReal position[2])
{
  const PetscInt ix = CellIndex(position[0], list->low[0], list->per_length, list->cells[0]);
  const PetscInt iy = CellIndex(position[1], list->low[1], list->per_length, list->cells[1]);

  return iy * list->cells[0] + ix;
}

PetscErrorCode PgCellListCreate(PetscInt n, const PetscReal position[], const PetscReal radius[], PetscReal reach,
                                PgCellList *list)
{
  PetscInt cells;

  PetscFunctionBeginUser;
  PetscCall(SetCells(n, position, reach, list));
  cells = list->cells[0] * list->cells[1];
  PetscCall(PetscCalloc1(cells + 2, &list->start));
  PetscCall(PetscMalloc1(n, &list->disc));
  /* Counted two places ahead: after the sums start[c + 1] is where cell c begins, and placing the discs
     moves it to where the cell ends, which is where cell c + 1 begins. */
  for (PetscInt i = 0; i < n; i++) list->start[CellOf(list, position + 2 * i) + 2]++;
  for (PetscInt c = 0; c < cells; c++) list->start[c + 2] += list->start[c + 1];
  for (PetscInt i = 0; i < n; i++) {
    PgCellDisc *disc = &list->disc[list->start[CellOf(list, position + 2 * i) + 1]++];
    disc->x          = position[2 * i];
    disc->y          = position[2 * i + 1];
    disc->r          = radius[i];
    disc->index      = i;
  }
  PetscFunctionReturn(0);
}

/* The discs in the cell of `position` and its neighbours, as up to three ranges (empty ones included);
   returns their number. */
PetscInt PgCellListRanges(const PgCellList *list, const PetscReal position[2], PetscInt first[3], PetscInt end[3])
{
  const PetscInt ix   = CellIndex(position[0], list->low[0], list->per_length, list->cells[0]);
  const PetscInt iy   = CellIndex(position[1], list->low[1], list->per_length, list->cells[1]);
  const PetscInt left = PetscMax(ix - 1, 0), right = PetscMin(ix + 1, list->cells[0] - 1);
  PetscInt       count = 0;

  for (int k = 0; k < 3; k++) {
    const PetscInt row = iy - 1 + k;
    first[k] = end[k] = 0;
    if (row < 0 || row >= list->cells[1]) continue;
    first[k] = list->start[row * list->cells[0] + left];
    end[k]   = list->start[row * list->cells[0] + right + 1];
    count += end[k] - first[k];
  }
  return count;
}

PetscErrorCode PgCellListDestroy(PgCellList *list)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(list->start));
  PetscCall(PetscFree(list->disc));
  PetscFunctionReturn(0);
}

/* Room for `needed` integers, of which `held` survive; grows by a quarter at least. */
PetscErrorCode PgReserveInts(PetscInt held, PetscInt needed, PetscInt *capacity, PetscInt **array)
{
  PetscInt *larger;

  PetscFunctionBeginUser;
  if (needed <= *capacity) PetscFunctionReturn(0);
  *capacity = PetscMax(needed, *capacity + *capacity / 4) + 64;
  PetscCall(PetscMalloc1(*capacity, &larger));
  if (held) PetscCall(PetscArraycpy(larger, *array, held));
  PetscCall(PetscFree(*array));
  *array = larger;
  PetscFunctionReturn(0);
}

PetscErrorCode PgReserveScratch(PgNeighbors neighbors, PetscInt needed)
{
  PetscInt capacity = neighbors->scratch_capacity;

  PetscFunctionBeginUser;
  PetscCall(PgReserveInts(0, needed, &capacity, &neighbors->key));
  PetscCall(PgReserveInts(0, needed, &neighbors->scratch_capacity, &neighbors->value));
  PetscFunctionReturn(0);
}

/* Ascending keys, all different. Rows are short as a rule. */
PetscErrorCode PgSortByKey(PetscInt n, PetscInt key[], PetscInt value[])
{
  PetscFunctionBeginUser;
  if (n > 64) {
    PetscCall(PetscSortIntWithArray(n, key, value));
    PetscFunctionReturn(0);
  }
  for (PetscInt i = 1; i < n; i++) {
    const PetscInt k = key[i], v = value[i];
    PetscInt       j = i;
    for (; j > 0 && key[j - 1] > k; j--) {
      key[j]   = key[j - 1];
      value[j] = value[j - 1];
    }
    key[j]   = k;
    value[j] = v;
  }
  PetscFunctionReturn(0);
}
