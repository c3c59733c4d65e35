/* The fields of the discs and their variable-length data from a checkpoint, for any distribution. */
#include "checkpointimpl.h"

/* No disc touches so many others: radii differ by a factor of 100 at most. */
enum { MOST_RECORDS = 1 << 12 };

/* Rows [start, start + rows) of a dataset of reals for every rank, read and sent piece by piece; rank 0 sends even
   after a failure, so that nobody waits for ever. */
static PetscErrorCode Scatter(PgCheckpoint c, const char path[], PetscInt total, PetscInt start, PetscInt rows,
                              PetscInt columns, int rank, PetscReal value[])
{
  const hsize_t  size[2] = {(hsize_t)total, (hsize_t)columns};
  const PetscInt most    = PetscMax(1, (1 << 24) / columns); /* rows in a message */
  PetscMPIInt    ranks;
  PetscReal     *piece   = NULL;
  hid_t          dataset = -1;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(c->comm, &ranks));
  if (c->rank == 0) {
    dataset = PgCheckpointOpenDataset(&c->hdf, path, PG_HDF_REAL, rank, size);
    if (ranks > 1) PetscCall(PetscCalloc1(PetscMin(most, total) * columns, &piece));
  }
  for (PetscMPIInt r = 0; r < ranks; r++) {
    PetscInt range[2] = {start, rows};

    if (r && c->rank == r) PetscCallMPI(MPI_Send(range, 2, MPIU_INT, 0, 1, c->comm));
    if (r && c->rank == 0) PetscCallMPI(MPI_Recv(range, 2, MPIU_INT, r, 1, c->comm, MPI_STATUS_IGNORE));
    if (c->rank != 0 && c->rank != r) continue;
    for (PetscInt done = 0; done < range[1]; done += most) {
      const PetscInt count = PetscMin(most, range[1] - done);
      PetscReal     *to    = r ? piece : value + done * columns;

      if (c->rank == 0) {
        PgCheckpointReadRows(&c->hdf, path, dataset, PG_HDF_REAL, range[0] + done, count, columns, rank, to);
        PgCheckpointCheckFinite(&c->hdf, path, range[0] + done, count, columns, to);
      }
      if (r && c->rank == 0) PetscCallMPI(MPI_Send(to, (PetscMPIInt)(count * columns), MPIU_REAL, r, 2, c->comm));
      if (r && c->rank == r)
        PetscCallMPI(MPI_Recv(value + done * columns, (PetscMPIInt)(count * columns), MPIU_REAL, 0, 2, c->comm,
                              MPI_STATUS_IGNORE));
    }
  }
  PetscCall(PetscFree(piece));
  if (dataset >= 0) (void)H5Dclose(dataset);
  PetscCall(PgHdfAgree(&c->hdf));
  PetscFunctionReturn(0);
}

/* Every dataset of the group must be one that the run knows: otherwise the checkpoint is of another model. */
typedef struct {
  PgParticles particles;
  PgHdf      *hdf;
} Walk;

static herr_t IsKnownField(hid_t group, const char *name, const H5L_info_t *info, void *context)
{
  Walk              *walk  = context;
  PgField            field = -1;
  const PgFieldInfo *known = NULL;
  char               path[PETSC_MAX_PATH_LEN];

  (void)group;
  (void)info;
  if (!PgParticlesFindField(walk->particles, name, &field) && field >= 0)
    (void)PgParticlesGetFieldInfo(walk->particles, field, &known);
  if (known && known->flags & PG_FIELD_RESTART) return 0;
  (void)snprintf(path, sizeof path, "/fields/%s", name);
  PgHdfFail(walk->hdf, "use dataset", path, "this run has no such field");
  return 1;
}

static PetscErrorCode ReadFields(PgCheckpoint c, PgParticles particles)
{
  const PgFieldInfo *info;
  PetscInt           fields, discs, start, count;
  PetscReal         *owned, *byid;
  char               path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(particles, NULL, NULL, &discs));
  PetscCall(PgParticlesGetIdRange(particles, &start, &count));
  PetscCall(PgParticlesGetFieldCount(particles, &fields));
  for (PgField f = 0; f < fields && !c->hdf.failed; f++) {
    PetscCall(PgParticlesGetFieldInfo(particles, f, &info));
    if (!(info->flags & PG_FIELD_RESTART)) continue;
    (void)snprintf(path, sizeof path, "/fields/%s", info->name);
    PetscCall(PetscCalloc1(count * info->components, &byid));
    PetscCall(Scatter(c, path, discs, start, count, info->components, info->components == 1 ? 1 : 2, byid));
    if (!c->hdf.failed) {
      PetscCall(PgParticlesGetArray(particles, f, &owned));
      PetscCall(PgParticlesFromIdOrder(particles, info->components, byid, owned));
    }
    PetscCall(PetscFree(byid));
  }
  if (c->rank == 0 && !c->hdf.failed) {
    Walk walk = {particles, &c->hdf};
    PgHdfWatch(&c->hdf, "walk through group", "/fields",
               H5Literate_by_name(c->hdf.id, "/fields", H5_INDEX_NAME, H5_ITER_NATIVE, NULL, IsKnownField, &walk,
                                  H5P_DEFAULT));
  }
  PetscCall(PgHdfAgree(&c->hdf));
  PetscFunctionReturn(0);
}

/* Rank 0: the records of each disc as reals, for one exchange; the sum is their number. */
static void CheckCounts(PgHdf *hdf, const char path[], PetscInt start, PetscInt count, const PetscReal records[])
{
  char reason[128];

  for (PetscInt i = 0; i < count && !hdf->failed; i++) {
    if (records[i] >= 0 && records[i] <= MOST_RECORDS) continue;
    (void)snprintf(reason, sizeof reason, "disc %lld has %g records", (long long)start + i, (double)records[i]);
    PgHdfFail(hdf, "use dataset", path, reason);
  }
}

/* Counts are integers in the file. */
static PetscErrorCode ScatterCounts(PgCheckpoint c, const char path[], PetscInt total, PetscInt start, PetscInt rows,
                                    PetscReal records[])
{
  const hsize_t size    = (hsize_t)total;
  PetscInt     *integer = NULL;
  PetscMPIInt   ranks, *counts = NULL, *starts = NULL, mine = (PetscMPIInt)rows, first = (PetscMPIInt)start;
  hid_t         dataset = -1;
  PetscInt     *local;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(c->comm, &ranks));
  PetscCall(PetscMalloc1(rows, &local));
  if (c->rank == 0) {
    PetscCall(PetscCalloc1(total, &integer));
    PetscCall(PetscMalloc2(ranks, &counts, ranks, &starts));
    dataset = PgCheckpointOpenDataset(&c->hdf, path, PG_HDF_INT, 1, &size);
    PgCheckpointReadRows(&c->hdf, path, dataset, PG_HDF_INT, 0, total, 1, 1, integer);
    if (dataset >= 0) (void)H5Dclose(dataset);
  }
  PetscCallMPI(MPI_Gather(&mine, 1, MPI_INT, counts, 1, MPI_INT, 0, c->comm));
  PetscCallMPI(MPI_Gather(&first, 1, MPI_INT, starts, 1, MPI_INT, 0, c->comm));
  PetscCallMPI(MPI_Scatterv(integer, counts, starts, MPIU_INT, local, mine, MPIU_INT, 0, c->comm));
  for (PetscInt i = 0; i < rows; i++) records[i] = (PetscReal)local[i];
  CheckCounts(&c->hdf, path, start, rows, records);
  PetscCall(PetscFree(integer));
  PetscCall(PetscFree2(counts, starts));
  PetscCall(PetscFree(local));
  PetscCall(PgHdfAgree(&c->hdf));
  PetscFunctionReturn(0);
}

/* From records in the order of ids to those of the owned discs, slot by slot, as they were written. */
static PetscErrorCode RecordsFromIdOrder(PgParticles particles, PgRagged ragged, PetscInt components, PetscInt count,
                                         const PetscReal records[], const PetscReal record[])
{
  PetscReal *owned_records, *owned_slot, *slot, *to;
  PetscInt   owned, widest = 0, at, *offset;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  PetscCall(PetscMalloc4(owned, &owned_records, owned * components, &owned_slot, count * components, &slot, owned + 1,
                         &offset));
  PetscCall(PgParticlesFromIdOrder(particles, 1, records, owned_records));
  offset[0] = 0;
  for (PetscInt i = 0; i < owned; i++) offset[i + 1] = offset[i] + (PetscInt)owned_records[i];
  for (PetscInt i = 0; i < count; i++) widest = PetscMax(widest, (PetscInt)records[i]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &widest, 1, MPIU_INT, MPI_MAX, PgParticlesComm(particles)));
  PetscCall(PetscMalloc1(offset[owned] * components, &to));
  for (PetscInt k = 0; k < widest; k++) {
    PetscCall(PetscArrayzero(slot, count * components));
    at = 0;
    for (PetscInt i = 0; i < count; at += (PetscInt)records[i++])
      if (k < (PetscInt)records[i])
        PetscCall(PetscArraycpy(slot + i * components, record + (at + k) * components, components));
    PetscCall(PgParticlesFromIdOrder(particles, components, slot, owned_slot));
    for (PetscInt i = 0; i < owned; i++)
      if (offset[i] + k < offset[i + 1])
        PetscCall(PetscArraycpy(to + (offset[i] + k) * components, owned_slot + i * components, components));
  }
  PetscCall(PgParticlesSetRagged(particles, ragged, offset, to));
  PetscCall(PetscFree(to));
  PetscCall(PetscFree4(owned_records, owned_slot, slot, offset));
  PetscFunctionReturn(0);
}

/* Before memory is asked for: the records of all discs are those of the file, and can be counted. */
static PetscErrorCode CheckTotal(PgCheckpoint c, const char name[], PetscInt components, PetscInt count,
                                 const PetscReal records[])
{
  PetscReal total = 0;
  char      path[PETSC_MAX_PATH_LEN], reason[64];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < count; i++) total += records[i]; /* exact: integers below 2^53 */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPIU_REAL, MPIU_SUM, c->comm));
  if (c->rank == 0) {
    const hsize_t size[2] = {(hsize_t)total, (hsize_t)components};
    hid_t         dataset = -1;

    (void)snprintf(path, sizeof path, "/ragged/%s/record", name);
    (void)snprintf(reason, sizeof reason, "%.0f records are too many", (double)total);
    if (total > (PetscReal)(PETSC_MAX_INT / components))
      PgHdfFail(&c->hdf, "read dataset", path, reason);
    else
      dataset = PgCheckpointOpenDataset(&c->hdf, path, PG_HDF_REAL, 2, size);
    if (dataset >= 0) (void)H5Dclose(dataset);
  }
  PetscCall(PgHdfAgree(&c->hdf));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadRagged(PgCheckpoint c, PgParticles particles, PgRagged ragged, const char name[],
                                 PetscInt components)
{
  PetscInt   discs, start, count, mine = 0, end = 0, total = 0;
  PetscReal *records, *record = NULL;
  char       path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(particles, NULL, NULL, &discs));
  PetscCall(PgParticlesGetIdRange(particles, &start, &count));
  PetscCall(PetscMalloc1(count, &records));
  (void)snprintf(path, sizeof path, "/ragged/%s", name);
  if (c->rank == 0 && H5Lexists(c->hdf.id, path, H5P_DEFAULT) <= 0)
    PgHdfFail(&c->hdf, "open group", path, "it is missing");
  PetscCall(PgHdfAgree(&c->hdf));
  (void)snprintf(path, sizeof path, "/ragged/%s/count", name);
  if (!c->hdf.failed) PetscCall(ScatterCounts(c, path, discs, start, count, records));
  if (!c->hdf.failed) PetscCall(CheckTotal(c, name, components, count, records));
  if (!c->hdf.failed) {
    for (PetscInt i = 0; i < count; i++) mine += (PetscInt)records[i];
    PetscCallMPI(MPI_Scan(&mine, &end, 1, MPIU_INT, MPI_SUM, c->comm));
    PetscCallMPI(MPI_Allreduce(&mine, &total, 1, MPIU_INT, MPI_SUM, c->comm));
    PetscCall(PetscCalloc1(mine * components, &record));
    (void)snprintf(path, sizeof path, "/ragged/%s/record", name);
    PetscCall(Scatter(c, path, total, end - mine, mine, components, 2, record));
  }
  if (!c->hdf.failed) PetscCall(RecordsFromIdOrder(particles, ragged, components, count, records, record));
  PetscCall(PetscFree(record));
  PetscCall(PetscFree(records));
  PetscFunctionReturn(0);
}

PetscErrorCode PgCheckpointReadFields(PgCheckpoint c, PgParticles particles)
{
  PetscInt    discs, ragged, components;
  const char *name;
  unsigned    flags;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(particles, NULL, NULL, &discs));
  if (c->rank == 0) {
    const PetscInt found = PgCheckpointReadNumber(&c->hdf, "discs");
    char           reason[128];

    (void)snprintf(reason, sizeof reason, "it holds %lld discs, this run has %lld", (long long)found, (long long)discs);
    if (found != discs) PgHdfFail(&c->hdf, "go on from it", "", reason);
  }
  PetscCall(PgHdfAgree(&c->hdf));
  if (!c->hdf.failed) PetscCall(ReadFields(c, particles));
  PetscCall(PgParticlesGetRaggedCount(particles, &ragged));
  for (PgRagged r = 0; r < ragged && !c->hdf.failed; r++) {
    PetscCall(PgParticlesGetRaggedInfo(particles, r, &name, &components, &flags));
    if (flags & PG_FIELD_RESTART) PetscCall(ReadRagged(c, particles, r, name, components));
  }
  PetscFunctionReturn(PgCheckpointVerdict(c));
}
