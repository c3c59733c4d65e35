/* The row list: all partners of each owned disc within the reach of the pair. */
#include "neighborsimpl.h"

/* Collects the partners of disc i in the scratch row; returns their number. */
static PetscInt Partners(PgNeighbors neighbors, const PgCellList *cells, const PetscInt id[], PetscInt i,
                         const PetscReal position[2], PetscReal r, const PetscInt first[3], const PetscInt end[3])
{
  PetscInt n = 0;

  for (int k = 0; k < 3; k++) {
    for (const PgCellDisc *disc = cells->disc + first[k]; disc < cells->disc + end[k]; disc++) {
      const PetscReal dx = disc->x - position[0], dy = disc->y - position[1];
      const PetscReal reach = neighbors->wide * PetscMax(r, disc->r) + neighbors->narrow * PetscMin(r, disc->r) +
                              neighbors->skin;
      if (dx * dx + dy * dy >= reach * reach || disc->index == i) continue;
      neighbors->key[n]     = id[disc->index];
      neighbors->value[n++] = disc->index;
    }
  }
  return n;
}

/* Entry of disc `partner` in row i, whose ids ascend. A period narrower than two reaches gives a disc and its image the
   same id. */
static PetscInt FindEntry(const PgNeighbors neighbors, const PetscInt id[], PetscInt i, PetscInt partner)
{
  PetscInt low = neighbors->row_ptr[i], high = neighbors->row_ptr[i + 1];

  while (low < high) {
    const PetscInt middle = low + (high - low) / 2;
    if (id[neighbors->row_col[middle]] < id[partner])
      low = middle + 1;
    else
      high = middle;
  }
  while (low < neighbors->row_ptr[i + 1] && neighbors->row_col[low] != partner) low++;
  return low;
}

/* Each pair once, in the order of the rows: the disc with the smaller local index first, so that ghosts are second. */
static PetscErrorCode PairRows(PgNeighbors neighbors, PetscInt owned, const PetscInt id[])
{
  const PetscInt *ptr = neighbors->row_ptr, *col = neighbors->row_col;
  PetscInt        count = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < owned; i++)
    for (PetscInt k = ptr[i]; k < ptr[i + 1]; k++) count += col[k] > i;
  for (int f = 0; f < 4; f++)
    PetscCall(PgReserveInts(0, count, &neighbors->row_pair_capacity[f], &neighbors->row_pair[f]));
  neighbors->row_pairs = count;
  count                = 0;
  for (PetscInt i = 0; i < owned; i++) {
    for (PetscInt k = ptr[i]; k < ptr[i + 1]; k++) {
      if (col[k] < i) continue;
      neighbors->row_pair[0][count] = i;
      neighbors->row_pair[1][count] = col[k];
      neighbors->row_pair[2][count] = k;
      neighbors->row_pair[3][count] = col[k] < owned ? FindEntry(neighbors, id, col[k], i) : ptr[owned];
      PgAssert(col[k] >= owned || neighbors->row_pair[3][count] < ptr[col[k] + 1],
               "disc %" PetscInt_FMT " is not in the row of its partner %" PetscInt_FMT, i, col[k]);
      count++;
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgRowsBuild(PgNeighbors neighbors)
{
  PgParticles     particles = neighbors->particles;
  PgCellList      cells;
  const PetscInt *id;
  PetscReal      *position, *radius;
  PetscInt        owned, ghosts, entries = 0;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(particles, &owned, &ghosts, NULL));
  PetscCall(PgParticlesGetIds(particles, &id));
  PetscCall(PgParticlesGetArray(particles, PG_POSITION, &position));
  PetscCall(PgParticlesGetArray(particles, PG_RADIUS, &radius));
  PetscCall(PgReserveInts(0, owned + 1, &neighbors->row_ptr_capacity, &neighbors->row_ptr));
  PetscCall(PgCellListCreate(owned + ghosts, position, radius,
                             (neighbors->wide + neighbors->narrow) * neighbors->r_max + neighbors->skin, &cells));
  for (PetscInt i = 0; i < owned; i++) {
    PetscInt first[3], end[3], n = PgCellListRanges(&cells, position + 2 * i, first, end);
    PetscCall(PgReserveScratch(neighbors, n));
    n = Partners(neighbors, &cells, id, i, position + 2 * i, radius[i], first, end);
    PetscCall(PgSortByKey(n, neighbors->key, neighbors->value));
    PetscCall(PgReserveInts(entries, entries + n, &neighbors->row_col_capacity, &neighbors->row_col));
    neighbors->row_ptr[i] = entries;
    PetscCall(PetscArraycpy(neighbors->row_col + entries, neighbors->value, n));
    entries += n;
  }
  neighbors->row_ptr[owned] = entries;
  PetscCall(PgCellListDestroy(&cells));
  PetscCall(PairRows(neighbors, owned, id));
  PetscFunctionReturn(0);
}
