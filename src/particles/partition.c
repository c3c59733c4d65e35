/* Which rank owns which cell: cells numbered along a Hilbert curve, each rank a contiguous piece of it. */
#include "particlesimpl.h"
#include <math.h>

enum { MAX_CELLS = 65536 }; /* in a direction: keys stay below 2^32, and indices exact in rounding */

/* Number of the cell along the Hilbert curve: from the coarsest level down, each quadrant is traversed like
   the whole, with the axes swapped in the first and last one, and reversed in the last. */
uint64_t PgCurveKey(const PgGrid *grid, PetscInt ix, PetscInt iy)
{
  uint64_t key  = 0;
  unsigned swap = 0, reverse = 0;

  for (int level = grid->levels - 1; level >= 0; level--) {
    unsigned x = (((unsigned)ix >> level) & 1U) ^ reverse;
    unsigned y = (((unsigned)iy >> level) & 1U) ^ reverse;
    unsigned t = (x ^ y) & swap;
    x ^= t;
    y ^= t;
    key = (key << 2) | ((3U * x) ^ y);
    swap ^= y ^ 1U;
    reverse ^= (y ^ 1U) & x;
  }
  return key;
}

static inline PetscInt CellIndex(PetscReal x, PetscReal low, PetscReal per_length, PetscInt cells)
{
  const PetscReal t = (x - low) * per_length;

  if (!(t > 0)) return 0;
  if (t >= (PetscReal)(cells - 1)) return cells - 1;
  return (PetscInt)t;
}

/* Outside the grid: the nearest edge cell. Two discs within a cell width then still differ by at most one in
   each index, so the neighbours of a cell hold all partners. */
void PgGridCell(const PgGrid *grid, const PetscReal position[2], PetscInt cell[2])
{
  for (int d = 0; d < 2; d++) cell[d] = CellIndex(position[d], grid->low[d], grid->per_length[d], grid->cells[d]);
}

/* The last piece that starts at or before the key: pieces without a cell are skipped. */
PetscMPIInt PgPartitionOwner(PgParticles particles, uint64_t key)
{
  PetscInt low = 0, high = particles->size;

  while (high - low > 1) {
    const PetscInt middle = low + (high - low) / 2;
    if (particles->splitter[middle] <= key)
      low = middle;
    else
      high = middle;
  }
  return (PetscMPIInt)((low - particles->shift + particles->size) % particles->size);
}

void PgPartitionOwnRange(PgParticles particles, uint64_t *first, uint64_t *end)
{
  const PetscInt piece = (particles->rank + particles->shift) % particles->size;

  *first = particles->splitter[piece];
  *end   = particles->splitter[piece + 1];
}

static PetscErrorCode SetGrid(PgParticles particles, PetscReal width, const PetscReal low[2], const PetscReal high[2])
{
  PgGrid *grid = &particles->grid;
  /* Rounding must not put two discs just within `width` of each other two cells apart. */
  const PetscReal least = width * (1 + 4 * PETSC_SQRT_MACHINE_EPSILON);

  PetscFunctionBeginUser;
  for (int d = 0; d < 2; d++) {
    /* room to move before the grid has to follow */
    const PetscReal margin = 0.1 * (high[d] - low[d]) + width;
    const PetscReal extent = high[d] - low[d] + 2 * margin;
    const PetscReal cell   = PetscMax(least, extent / (MAX_CELLS - 1));
    grid->cells[d]         = (PetscInt)PetscCeilReal(extent / cell);
    grid->low[d]           = low[d] - margin;
    grid->high[d]          = high[d] + margin;
    grid->per_length[d]    = 1 / cell;
  }
  if (particles->periodic) {
    const PetscReal period = particles->high - particles->low;
    const PetscReal cells  = PetscFloorReal(period / least);
    PgInputCheck(cells >= 3, particles->comm,
                 "the period of %g m in x must hold at least three cells of width %g m (the largest reach of a pair)",
                 (double)period, (double)width);
    grid->cells[0]      = (PetscInt)PetscMin(cells, (PetscReal)MAX_CELLS);
    grid->low[0]        = particles->low;
    grid->high[0]       = particles->high;
    grid->per_length[0] = (PetscReal)grid->cells[0] / period;
  }
  grid->levels = 1;
  while (((PetscInt)1 << grid->levels) < PetscMax(grid->cells[0], grid->cells[1])) grid->levels++;
  grid->width = width;
  PetscFunctionReturn(0);
}

/* Number of sorted keys below each bound, over all ranks. */
static PetscErrorCode CountBelow(PgParticles particles, const PgSortEntry sorted[], const uint64_t bound[],
                                 int64_t count[])
{
  const PetscMPIInt cuts = particles->size - 1;

  PetscFunctionBeginUser;
  for (PetscMPIInt c = 0; c < cuts; c++) {
    PetscInt low = 0, high = particles->owned;
    while (low < high) {
      const PetscInt middle = low + (high - low) / 2;
      if (sorted[middle].key < bound[c])
        low = middle + 1;
      else
        high = middle;
    }
    count[c] = low;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, cuts, MPI_INT64_T, MPI_SUM, particles->comm));
  PetscFunctionReturn(0);
}

/* All cuts at once by bisection on the key: the first key with at least its share of discs below it, or the
   one before when that is nearer to the share. */
static PetscErrorCode Bisect(PgParticles particles, const PgSortEntry sorted[])
{
  const PetscMPIInt cuts = particles->size - 1;
  const int         bits = 2 * particles->grid.levels;
  uint64_t         *low, *high, *middle;
  int64_t          *count, *before;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc5(cuts, &low, cuts, &high, cuts, &middle, cuts, &count, cuts, &before));
  for (PetscMPIInt c = 0; c < cuts; c++) {
    low[c]  = 0;
    high[c] = (uint64_t)1 << bits;
  }
  for (int step = 0; step <= bits; step++) {
    for (PetscMPIInt c = 0; c < cuts; c++) middle[c] = low[c] + (high[c] - low[c]) / 2;
    PetscCall(CountBelow(particles, sorted, middle, count));
    for (PetscMPIInt c = 0; c < cuts; c++) {
      const int64_t share = (int64_t)particles->global * (c + 1) / particles->size;
      if (low[c] == high[c]) continue;
      if (count[c] >= share)
        high[c] = middle[c];
      else
        low[c] = middle[c] + 1;
    }
  }
  for (PetscMPIInt c = 0; c < cuts; c++) middle[c] = high[c] ? high[c] - 1 : 0;
  PetscCall(CountBelow(particles, sorted, high, count));
  PetscCall(CountBelow(particles, sorted, middle, before));
  for (PetscMPIInt c = 0; c < cuts; c++) {
    const int64_t share        = (int64_t)particles->global * (c + 1) / particles->size;
    particles->splitter[c + 1] = share - before[c] < count[c] - share ? middle[c] : high[c];
  }
  particles->splitter[0]               = 0;
  particles->splitter[particles->size] = (uint64_t)1 << bits;
  PetscCall(PetscFree5(low, high, middle, count, before));
  PetscFunctionReturn(0);
}

/* Largest load after the cut. */
static PetscErrorCode CutLoad(PgParticles particles, const PgSortEntry sorted[])
{
  int64_t *below, largest = 0, last = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(particles->size, &below));
  PetscCall(CountBelow(particles, sorted, particles->splitter + 1, below));
  below[particles->size - 1] = particles->global;
  for (PetscMPIInt p = 0; p < particles->size; p++) {
    largest = PetscMax(largest, below[p] - last);
    last    = below[p];
  }
  particles->cut_load   = (PetscReal)largest;
  particles->worst_load = PetscMax(particles->worst_load, particles->cut_load);
  particles->cuts++;
  PetscCall(PetscFree(below));
  PetscFunctionReturn(0);
}

static PetscErrorCode Cut(PgParticles particles)
{
  const PetscReal *position = particles->field[PG_POSITION]->array;
  PgSortEntry     *entry;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(particles->owned, &entry));
  for (PetscInt i = 0; i < particles->owned; i++) {
    PetscInt cell[2];
    PgGridCell(&particles->grid, position + 2 * i, cell);
    entry[i].key   = PgCurveKey(&particles->grid, cell[0], cell[1]);
    entry[i].id    = particles->id[i];
    entry[i].index = i;
  }
  if (particles->size > 1)
    PetscCall(PgSortEntries(particles->owned, entry, ((uint64_t)1 << (2 * particles->grid.levels)) - 1,
                            PetscMax(particles->global - 1, 0)));
  PetscCall(Bisect(particles, entry));
  PetscCall(CutLoad(particles, entry));
  PetscCall(PetscFree(entry));
  particles->recut = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Names the disc whose position is not a number. */
static PetscErrorCode ReportNotFinite(PgParticles particles)
{
  const PetscReal *position = particles->field[PG_POSITION]->array;
  PetscInt         id       = PETSC_MAX_INT;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < particles->owned; i++) {
    if (!isfinite(position[2 * i]) || !isfinite(position[2 * i + 1])) id = PetscMin(id, particles->id[i]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &id, 1, MPIU_INT, MPI_MIN, particles->comm));
  PgRunError(particles->comm, "the position of particle %" PetscInt_FMT " is not finite", id);
}

/* Keeps x in [low, high) and counts how often a disc has gone round. */
static void Wrap(PgParticles particles)
{
  const PetscReal period    = particles->high - particles->low;
  PetscReal      *position  = particles->field[PG_POSITION]->array;
  PetscReal      *crossings = particles->field[particles->crossings]->array;

  for (PetscInt i = 0; i < particles->owned; i++) {
    PetscReal *x = &position[2 * i];
    PetscReal  turns;
    if (isgreaterequal(*x, particles->low) && isless(*x, particles->high)) continue;
    if (!isfinite(*x)) continue; /* the survey reports it */
    turns = PetscFloorReal((*x - particles->low) / period);
    *x -= turns * period;
    if (isgreaterequal(*x, particles->high)) { /* a hair below `low`, rounded up */
      *x = particles->low;
      turns += 1;
    }
    if (isless(*x, particles->low)) *x = particles->low;
    crossings[i] += turns;
  }
}

/* Does the grid still fit? Discs may leave it by a quarter of its size: the edge cells hold them. */
static PetscBool Outgrown(const PgGrid *grid, const PetscReal low[2], const PetscReal high[2])
{
  for (int d = 0; d < 2; d++) {
    const PetscReal room = 0.25 * (grid->high[d] - grid->low[d]);
    if (low[d] < grid->low[d] - room || high[d] > grid->high[d] + room) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Makes grid and cuts fit the present discs. Collective. */
PetscErrorCode PgPartitionUpdate(PgParticles particles, PetscReal width)
{
  enum { LOW_X, LOW_Y, HIGH_X, HIGH_Y, LOAD, NOT_FINITE, COUNT };
  const PetscReal *position = particles->field[PG_POSITION]->array;
  PetscReal        most[COUNT], low[2], high[2], mean;

  PetscFunctionBeginUser;
  if (particles->periodic) Wrap(particles);
  for (int m = 0; m < COUNT; m++) most[m] = -PETSC_MAX_REAL;
  most[LOAD]       = (PetscReal)particles->owned;
  most[NOT_FINITE] = 0;
  for (PetscInt i = 0; i < particles->owned; i++) {
    const PetscReal x = position[2 * i], y = position[2 * i + 1];
    if (!isfinite(x) || !isfinite(y)) {
      most[NOT_FINITE] = 1;
      continue;
    }
    most[LOW_X]  = PetscMax(most[LOW_X], -x);
    most[LOW_Y]  = PetscMax(most[LOW_Y], -y);
    most[HIGH_X] = PetscMax(most[HIGH_X], x);
    most[HIGH_Y] = PetscMax(most[HIGH_Y], y);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, COUNT, MPIU_REAL, MPI_MAX, particles->comm));
  if (most[NOT_FINITE] > 0) PetscCall(ReportNotFinite(particles));
  for (int d = 0; d < 2; d++) { /* without any disc: an empty box at the origin */
    low[d]  = particles->global ? -most[LOW_X + d] : 0;
    high[d] = particles->global ? most[HIGH_X + d] : 0;
  }
  mean = (PetscReal)particles->global / particles->size;
  if (!particles->recut) particles->worst_load = PetscMax(particles->worst_load, most[LOAD]);
  if (particles->grid.width != width || Outgrown(&particles->grid, low, high)) {
    PetscCall(SetGrid(particles, width, low, high));
    particles->recut = PETSC_TRUE;
  }
  /* Where cells hold many discs a cut may miss the threshold: no use in trying again until it gets worse. */
  if (most[LOAD] > particles->balance * mean && most[LOAD] > 1.05 * particles->cut_load) particles->recut = PETSC_TRUE;
  if (particles->recut) PetscCall(Cut(particles));
  PetscFunctionReturn(0);
}
