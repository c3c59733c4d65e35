/* The list of pairs that may touch. */
#include "neighborsimpl.h"

static PetscErrorCode ReservePairs(PgPairs *pairs, PetscInt needed)
{
  PetscInt capacity = pairs->capacity;

  PetscFunctionBeginUser;
  PetscCall(PgReserveInts(pairs->count, needed, &capacity, &pairs->low));
  PetscCall(PgReserveInts(pairs->count, needed, &pairs->capacity, &pairs->high));
  PetscFunctionReturn(0);
}

static inline void AddPair(PgPairs *pairs, const PetscInt id[], PetscInt i, PetscInt j)
{
  const PetscBool first = (PetscBool)(id[i] < id[j]);

  pairs->low[pairs->count]    = first ? i : j;
  pairs->high[pairs->count++] = first ? j : i;
}

/* Each owned disc looks around: a pair of owned discs is found by the one with the smaller local index, a
   pair with a ghost always. A disc meets no partner twice, as owned disc and image or as two images: the
   period is at least three cells long. */
static PetscErrorCode FindPairs(PgNeighbors neighbors, const PgCellList *cells, PgPairs *boundary)
{
  const PetscReal skin     = neighbors->skin;
  PgPairs        *interior = &neighbors->pairs;
  const PetscInt *id;
  PetscReal      *position, *radius;
  PetscInt        owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(neighbors->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetIds(neighbors->particles, &id));
  PetscCall(PgParticlesGetArray(neighbors->particles, PG_POSITION, &position));
  PetscCall(PgParticlesGetArray(neighbors->particles, PG_RADIUS, &radius));
  interior->count = 0;
  for (PetscInt i = 0; i < owned; i++) {
    const PetscReal x = position[2 * i], y = position[2 * i + 1], reach = radius[i] + skin;
    PetscInt        first[3], end[3];
    const PetscInt  candidates = PgCellListRanges(cells, position + 2 * i, first, end);
    PetscCall(ReservePairs(interior, interior->count + candidates));
    PetscCall(ReservePairs(boundary, boundary->count + candidates));
    for (int k = 0; k < 3; k++) {
      for (const PgCellDisc *disc = cells->disc + first[k]; disc < cells->disc + end[k]; disc++) {
        const PetscReal dx = disc->x - x, dy = disc->y - y, touch = reach + disc->r;
        if (disc->index <= i || dx * dx + dy * dy >= touch * touch) continue;
        AddPair(disc->index < owned ? interior : boundary, id, i, disc->index);
      }
    }
  }
  PetscFunctionReturn(0);
}

/* Boundary pairs after the interior ones, then copies of the last pair up to a multiple of 8. */
static PetscErrorCode Join(PgNeighbors neighbors, const PgPairs *boundary)
{
  PgPairs *pairs = &neighbors->pairs;

  PetscFunctionBeginUser;
  neighbors->interior = pairs->count;
  PetscCall(ReservePairs(pairs, pairs->count + boundary->count + 8));
  PetscCall(PetscArraycpy(pairs->low + pairs->count, boundary->low, boundary->count));
  PetscCall(PetscArraycpy(pairs->high + pairs->count, boundary->high, boundary->count));
  pairs->count += boundary->count;
  neighbors->contacts = pairs->count;
  while (pairs->count % 8) {
    pairs->low[pairs->count]  = pairs->low[neighbors->contacts - 1];
    pairs->high[pairs->count] = pairs->high[neighbors->contacts - 1];
    pairs->count++;
  }
  PetscFunctionReturn(0);
}

/* The pairs of each owned disc in ascending id of the partner. */
static PetscErrorCode SortSums(PgNeighbors neighbors)
{
  const PetscInt *low = neighbors->pairs.low, *high = neighbors->pairs.high, *id;
  PetscInt        owned, *ptr, *sum;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(neighbors->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetIds(neighbors->particles, &id));
  PetscCall(PgReserveInts(0, owned + 2, &neighbors->contact_ptr_capacity, &neighbors->contact_ptr));
  PetscCall(PgReserveInts(0, neighbors->interior + neighbors->contacts, &neighbors->contact_sum_capacity,
                          &neighbors->contact_sum));
  ptr = neighbors->contact_ptr;
  sum = neighbors->contact_sum;
  PetscCall(PetscArrayzero(ptr, owned + 2));
  for (PetscInt p = 0; p < neighbors->contacts; p++) {
    if (low[p] < owned) ptr[low[p] + 2]++;
    if (high[p] < owned) ptr[high[p] + 2]++;
  }
  for (PetscInt i = 0; i < owned; i++) ptr[i + 2] += ptr[i + 1];
  for (PetscInt p = 0; p < neighbors->contacts; p++) {
    if (low[p] < owned) sum[ptr[low[p] + 1]++] = 2 * p;
    if (high[p] < owned) sum[ptr[high[p] + 1]++] = 2 * p + 1;
  }
  for (PetscInt i = 0; i < owned; i++) {
    PetscInt *row = sum + ptr[i], n = ptr[i + 1] - ptr[i];
    PetscCall(PgReserveScratch(neighbors, n));
    for (PetscInt k = 0; k < n; k++) neighbors->key[k] = id[row[k] % 2 ? low[row[k] / 2] : high[row[k] / 2]];
    PetscCall(PgSortByKey(n, neighbors->key, row));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgContactsBuild(PgNeighbors neighbors)
{
  PgCellList cells;
  PgPairs    boundary = {0, 0, NULL, NULL};
  PetscReal *position, *radius;
  PetscInt   owned, ghosts;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(neighbors->particles, &owned, &ghosts, NULL));
  PetscCall(PgParticlesGetArray(neighbors->particles, PG_POSITION, &position));
  PetscCall(PgParticlesGetArray(neighbors->particles, PG_RADIUS, &radius));
  PetscCall(PgCellListCreate(owned + ghosts, position, radius, 2 * neighbors->r_max + neighbors->skin, &cells));
  PetscCall(FindPairs(neighbors, &cells, &boundary));
  PetscCall(PgCellListDestroy(&cells));
  PetscCall(Join(neighbors, &boundary));
  PetscCall(PetscFree(boundary.low));
  PetscCall(PetscFree(boundary.high));
  PetscCall(SortSums(neighbors));
  PetscFunctionReturn(0);
}
