/* Islands: discs that no chain of pair weights ties to a prescribed pressure. Each is a singular block of the matrix of
   its own, with the constant on it as null space: its right-hand side must have no mean there, and the mean of its
   pressure is what it was. Usually there is none, or one that is everything (no side drained); but a disc that has left
   an undrained packing has a prescribed pressure, and the packing is an island all the same. */
#include "pressureimpl.h"

/* The least member of the set of a, in a forest where each disc points to a lesser one or to itself. */
static PetscInt Root(PetscInt parent[], PetscInt a)
{
  while (parent[a] != a) {
    parent[a] = parent[parent[a]];
    a         = parent[a];
  }
  return a;
}

PetscErrorCode PgPressureReserveTies(PgPressure q)
{
  PetscFunctionBeginUser;
  if (q->owned <= q->island_capacity) PetscFunctionReturn(0);
  q->island_capacity = q->owned + q->owned / 8;
  PetscCall(PetscFree3(q->island, q->island_parent, q->tie));
  PetscCall(
      PetscMalloc3(q->island_capacity, &q->island, q->island_capacity, &q->island_parent, q->island_capacity, &q->tie));
  PetscFunctionReturn(0);
}

/* Sets of owned free discs that pair weights between them tie together. */
static void JoinOwned(PgPressure q, const PetscReal fixed[])
{
  PetscInt *parent = q->island_parent;

  for (PetscInt a = 0; a < q->owned; a++) parent[a] = a;
  for (PetscInt a = 0; a < q->owned; a++) {
    if (fixed[a] != 0.0) continue;
    for (PetscInt k = q->ptr[a]; k < q->ptr[a + 1]; k++) {
      const PetscInt b = q->col[k];
      PetscInt       s, t;
      if (b >= a || q->weight[k] == 0.0 || fixed[b] != 0.0) continue; /* the other row of the pair, or a ghost */
      s                      = Root(parent, a);
      t                      = Root(parent, b);
      parent[PetscMax(s, t)] = PetscMin(s, t);
    }
  }
}

/* Takes the least label of the neighbours over to the roots; whether any fell. TIED is less than every id. */
#define TIED (-1.0)
static PetscBool LowerRoots(PgPressure q, const PetscReal fixed[], PetscReal label[], PetscBool first)
{
  PetscBool lowered = PETSC_FALSE;

  for (PetscInt a = 0; a < q->owned; a++) {
    PetscInt root;
    if (fixed[a] != 0.0) continue;
    root = Root(q->island_parent, a);
    for (PetscInt k = q->ptr[a]; k < q->ptr[a + 1] && label[root] != TIED; k++) {
      const PetscInt  b    = q->col[k];
      const PetscReal ties = fixed[b] != 0.0 ? TIED : label[b];
      if (q->weight[k] == 0.0 || (b < q->owned && !(first && fixed[b] != 0.0)) || !(ties < label[root])) continue;
      label[root] = ties;
      lowered     = PETSC_TRUE;
    }
  }
  return lowered;
}

/* Labels of owned discs and ghosts: TIED, or the id of one disc of the island, the same for all of it. */
static PetscErrorCode Spread(PgPressure q, const PetscReal fixed[], PetscReal label[])
{
  const PetscInt *id;
  PetscInt        owned, ghosts;
  int             again = 1; /* whether a label fell, or it is the first time and there are ghosts */

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetIds(q->particles, &id));
  PetscCall(PgParticlesGetSizes(q->particles, &owned, &ghosts, NULL));
  for (PetscInt a = 0; a < owned; a++) label[a] = (PetscReal)id[a];
  for (PetscInt b = owned; b < owned + ghosts; b++) label[b] = PETSC_MAX_REAL; /* not known yet */
  for (PetscBool first = PETSC_TRUE; again; first = PETSC_FALSE) {
    again = LowerRoots(q, fixed, label, first) || (first && ghosts > 0);
    for (PetscInt a = 0; a < owned; a++) label[a] = label[Root(q->island_parent, a)];
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &again, 1, MPI_INT, MPI_LOR, q->comm));
    if (again) PetscCall(PgParticlesHalo(q->particles, 1, &q->island_label));
  }
  PetscFunctionReturn(0);
}

/* The disc whose id is the label of its island. */
static PetscBool IsRoot(const PetscReal fixed[], const PetscReal label[], const PetscInt id[], PetscInt a)
{
  return (PetscBool)(fixed[a] == 0.0 && label[a] == (PetscReal)id[a]);
}

/* Room for what is kept of each island, and of each rank. What is there is lost. */
static PetscErrorCode ReserveIslands(PgPressure q, PetscInt islands)
{
  PetscFunctionBeginUser;
  if (islands <= q->islands_room) PetscFunctionReturn(0);
  q->islands_room = 2 * islands;
  PetscCall(PetscFree4(q->island_size, q->island_sum, q->island_mean, q->island_root));
  PetscCall(PetscMalloc4(q->islands_room, &q->island_size, q->islands_room, &q->island_sum, q->islands_room,
                         &q->island_mean, q->islands_room, &q->island_root));
  PetscFunctionReturn(0);
}

/* Labels of all islands into island_root, in the order of ranks. */
static PetscErrorCode GatherRoots(PgPressure q, const PetscReal fixed[], const PetscReal label[])
{
  const PetscInt *id;
  PetscMPIInt     size, rank, mine = 0, total = 0, *counts, *starts;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(q->comm, &size));
  PetscCallMPI(MPI_Comm_rank(q->comm, &rank));
  PetscCall(PgParticlesGetIds(q->particles, &id));
  for (PetscInt a = 0; a < q->owned; a++) mine += IsRoot(fixed, label, id, a);
  if (!q->island_counts) PetscCall(PetscMalloc1(2 * size, &q->island_counts));
  counts = q->island_counts;
  starts = q->island_counts + size;
  PetscCallMPI(MPI_Allgather(&mine, 1, MPI_INT, counts, 1, MPI_INT, q->comm));
  for (PetscMPIInt r = 0; r < size; r++) {
    starts[r] = total;
    total += counts[r];
  }
  q->islands = total;
  PetscCall(ReserveIslands(q, total));
  for (PetscInt a = 0, at = starts[rank]; a < q->owned; a++)
    if (IsRoot(fixed, label, id, a)) q->island_root[at++] = label[a];
  PetscCallMPI(MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, q->island_root, counts, starts, MPIU_REAL, q->comm));
  PetscFunctionReturn(0);
}

/* Which island each disc belongs to, and how many discs they have. */
static PetscErrorCode Number(PgPressure q, const PetscReal fixed[], const PetscReal label[])
{
  PetscFunctionBeginUser;
  PetscCall(GatherRoots(q, fixed, label));
  for (PetscInt i = 0; i < q->islands; i++) q->island_size[i] = 0.0;
  for (PetscInt a = 0; a < q->owned; a++) {
    PetscInt i = 0;
    while (i < q->islands && (fixed[a] != 0.0 || q->island_root[i] != label[a])) i++;
    q->island[a] = i < q->islands ? i : -1;
    if (i < q->islands) q->island_size[i] += 1.0;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, q->island_size, (PetscMPIInt)q->islands, MPIU_REAL, MPIU_SUM, q->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureFindIslands(PgPressure q)
{
  PetscReal *fixed, *label;
  PetscInt   global;

  PetscFunctionBeginUser;
  q->islands = q->singular ? 1 : 0;
  q->whole   = q->singular;
  PetscCall(ReserveIslands(q, q->islands));
  if (!q->symmetric) PetscFunctionReturn(0); /* what blocks of another matrix can bear is not known */
  if (q->tied) PetscFunctionReturn(0);
  PetscCall(PgPressureReserveTies(q));
  if (!q->singular) PetscCall(PgPressureTie(q));
  if (q->tied) PetscFunctionReturn(0);
  PetscCall(PgParticlesGetArray(q->particles, q->fixed, &fixed));
  PetscCall(PgParticlesGetArray(q->particles, q->island_label, &label));
  JoinOwned(q, fixed);
  PetscCall(Spread(q, fixed, label));
  PetscCall(Number(q, fixed, label));
  PetscCall(PgParticlesGetSizes(q->particles, NULL, NULL, &global));
  q->whole = (PetscBool)(q->islands == 1 && q->island_size[0] == (PetscReal)global);
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureIslandMeans(PgPressure q, Vec v, PetscReal mean[])
{
  const PetscScalar *value;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < q->islands; i++) mean[i] = 0.0;
  PetscCall(VecGetArrayRead(v, &value));
  for (PetscInt a = 0; a < q->owned; a++)
    if (q->island[a] >= 0) mean[q->island[a]] += PetscRealPart(value[a]);
  PetscCall(VecRestoreArrayRead(v, &value));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, mean, (PetscMPIInt)q->islands, MPIU_REAL, MPIU_SUM, q->comm));
  for (PetscInt i = 0; i < q->islands; i++) mean[i] /= q->island_size[i];
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureIslandShift(PgPressure q, Vec v, const PetscReal shift[])
{
  PetscScalar *value;

  PetscFunctionBeginUser;
  PetscCall(VecGetArray(v, &value));
  for (PetscInt a = 0; a < q->owned; a++)
    if (q->island[a] >= 0) value[a] += shift[q->island[a]];
  PetscCall(VecRestoreArray(v, &value));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureRemoveIslandMeans(MatNullSpace space, Vec v, void *pressure)
{
  PgPressure q = (PgPressure)pressure;

  PetscFunctionBeginUser;
  (void)space;
  PetscCall(PgPressureIslandMeans(q, v, q->island_sum));
  for (PetscInt i = 0; i < q->islands; i++) q->island_sum[i] = -q->island_sum[i];
  PetscCall(PgPressureIslandShift(q, v, q->island_sum));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureDestroyIslands(PgPressure q)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(q->island, q->island_parent, q->tie));
  PetscCall(PetscFree4(q->island_size, q->island_sum, q->island_mean, q->island_root));
  PetscCall(PetscFree(q->island_counts));
  PetscFunctionReturn(0);
}
