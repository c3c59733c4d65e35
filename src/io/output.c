/* The result file: one group for each snapshot, complete and closed when a call returns. */
#include "ioimpl.h"

static PetscErrorCode AllocateNames(PgOutput output, const char file[])
{
  const size_t stem = strlen(file) - strlen(".h5");
  const char  *slash;

  PetscFunctionBeginUser;
  PetscCall(PetscStrallocpy(file, &output->file));
  PetscCall(PetscMalloc1(stem + 5, &output->xmf));
  PetscCall(PetscMalloc1(stem + 5, &output->csv));
  (void)snprintf(output->xmf, stem + 5, "%.*s.xmf", (int)stem, file);
  (void)snprintf(output->csv, stem + 5, "%.*s.csv", (int)stem, file);
  slash        = strrchr(output->file, '/');
  output->base = slash ? slash + 1 : output->file;
  PetscFunctionReturn(0);
}

PetscErrorCode PgOutputWriteFirst(PgOutput output, const PgGrid *grid)
{
  PgHdf hdf;

  PetscFunctionBeginUser;
  if (output->rank == 0) PgJournalForget(output->file);
  PetscCall(PgHdfCreate(output->comm, output->file, H5F_LIBVER_EARLIEST, &hdf));
  PetscCall(PgProvenanceStart(&hdf));
  PetscCall(PgHdfText(&hdf, "/provenance", "run", output->run));
  PetscCall(PgHdfGroup(&hdf, "/snapshots"));
  PetscCall(PgHdfInt(&hdf, "/snapshots", "count", 0));
  PetscCall(PgHistoryCreateDatasets(output, &hdf));
  if (grid) PetscCall(PgGridWriteMesh(output, &hdf, grid));
  PetscCall(PgHdfFlush(&hdf));
  PetscCall(PgOutputClose(output, &hdf));
  PetscCall(PgXdmfWrite(output));
  PetscCall(PgHistoryOpenCsv(output));
  PetscFunctionReturn(0);
}

PetscErrorCode PgOutputPrepare(MPI_Comm comm, PgParticles particles, const char file[], PetscInt columns,
                               const PgColumn column[], PgOutput *output)
{
  PetscErrorCode err;
  PgOutput       out;

  PetscFunctionBeginUser;
  *output = NULL;
  PetscCall(PgOutputCheckName(comm, file));
  PetscCall(PetscNew(&out));
  out->particles = particles;
  out->comm      = comm;
  PetscCallMPI(MPI_Comm_rank(comm, &out->rank));
  err = AllocateNames(out, file);
  if (!err) err = PgOutputCheckPlaces(comm, out->file, out->xmf, out->csv);
  if (!err) err = PgHistoryCreate(out, columns, column);
  if (err) {
    PetscCall(PgOutputDestroy(&out));
    PetscFunctionReturn(err);
  }
  *output = out;
  PetscFunctionReturn(0);
}

PetscErrorCode PgOutputCreateAs(PgParticles particles, const char file[], PetscInt columns, const PgColumn column[],
                                const char run[], PgOutput *output)
{
  PetscErrorCode err;

  PetscFunctionBeginUser;
  PetscCall(PgOutputPrepare(PgParticlesComm(particles), particles, file, columns, column, output));
  PetscCall(PetscStrncpy((*output)->run, run, sizeof(*output)->run));
  err = PgOutputCheckRoom(*output, PgHistoryBytes(*output) + PG_PROVENANCE_BYTES);
  if (!err) err = PgOutputWriteFirst(*output, NULL);
  if (err) PetscCall(PgOutputDestroy(output));
  PetscFunctionReturn(err);
}

PetscErrorCode PgOutputCreate(PgParticles particles, const char file[], PetscInt columns, const PgColumn column[],
                              PgOutput *output)
{
  char run[PG_RUN_NAME];

  PetscFunctionBeginUser;
  PetscCall(PgRunName(PgParticlesComm(particles), run));
  PetscCall(PgOutputCreateAs(particles, file, columns, column, run, output));
  PetscFunctionReturn(0);
}

typedef struct {
  PgHdf   *hdf;
  char     group[32]; /* the name it will have */
  PetscInt rows, start, count;
} Snapshot;

static PetscErrorCode WriteField(PgOutput output, Snapshot *s, const char name[], PetscInt components,
                                 PetscBool integer, const char unit[], const char description[], const void *byid)
{
  const hsize_t size[PG_HDF_MAX_RANK] = {(hsize_t)s->rows, 2, 2}; /* (N), (N,2) or (N,2,2) */
  const int     rank                  = components == 1 ? 1 : components == 2 ? 2 : 3;
  const hid_t   type                  = integer ? PG_HDF_INT : PG_HDF_REAL;
  char          path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCheck(components == 1 || components == 2 || components == 4, output->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "field %s has %" PetscInt_FMT " components, not 1, 2 or 4", name, components);
  PetscCheck(name[0] && !strchr(name, '/') && strlen(name) < 200, output->comm, PETSC_ERR_ARG_WRONG,
             "'%s' cannot name a dataset", name);
  (void)snprintf(path, sizeof path, "%s/%s", PG_SNAPSHOT_INCOMPLETE, name);
  PetscCall(PgHdfDataset(s->hdf, path, type, rank, size, 0, unit, description));
  PetscCall(PgHdfWriteRows(s->hdf, path, type, s->rows, s->start, s->count, byid));
  if (output->rank == 0) PetscCall(PgXdmfAddField(output, s->group, name, components, integer, s->rows));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteIds(PgOutput output, Snapshot *s)
{
  PetscInt *id;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->count, &id));
  for (PetscInt k = 0; k < s->count; k++) id[k] = s->start + k;
  PetscCall(WriteField(output, s, "id", 1, PETSC_TRUE, "1", "permanent number of the disc", id));
  PetscCall(PetscFree(id));
  PetscFunctionReturn(0);
}

static PetscBool IsWritten(PgField field, const PgFieldInfo *info)
{
  return (PetscBool)(field == PG_POSITION || (info->flags & PG_FIELD_OUTPUT));
}

static PetscErrorCode WriteFields(PgOutput output, Snapshot *s)
{
  const PgFieldInfo *info;
  PetscInt           fields;
  PetscReal         *owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetFieldCount(output->particles, &fields));
  for (PgField f = 0; f < fields; f++) {
    PetscCall(PgParticlesGetFieldInfo(output->particles, f, &info));
    if (!IsWritten(f, info)) continue;
    if (s->count * info->components > output->byid_size) {
      output->byid_size = s->count * info->components;
      PetscCall(PetscRealloc((size_t)output->byid_size * sizeof(PetscReal), &output->byid));
    }
    PetscCall(PgParticlesGetArray(output->particles, f, &owned));
    PetscCall(PgParticlesToIdOrder(output->particles, info->components, owned, output->byid));
    PetscCall(
        WriteField(output, s, info->name, info->components, PETSC_FALSE, info->unit, info->description, output->byid));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgSnapshotComplete(PgOutput output, PgHdf *hdf, const char group[])
{
  PetscFunctionBeginUser;
  PetscCall(PgHistoryAppend(output, hdf));
  /* The data are in the file before it says so. */
  PetscCall(PgHdfFlush(hdf));
  PetscCall(PgHdfMove(hdf, PG_SNAPSHOT_INCOMPLETE, group));
  PetscCall(PgHdfInt(hdf, "/snapshots", "count", output->snapshots + 1));
  PetscCall(PgHdfFlush(hdf));
  PetscFunctionReturn(0);
}

PetscErrorCode PgSnapshotClose(PgOutput output, PgHdf *hdf, size_t before)
{
  const PetscErrorCode err = PgOutputClose(output, hdf);

  PetscFunctionBeginUser;
  if (err && output->grids.string) { /* the index shall not name what is not there */
    output->grids.used           = before;
    output->grids.string[before] = 0;
  }
  PetscCall(err);
  output->snapshots++;
  PgHistoryAppendDone(output);
  PetscCall(PgXdmfWrite(output));
  PetscFunctionReturn(0);
}

/* Opens the file with room for the snapshot. */
static PetscErrorCode OpenForSnapshot(PgOutput output, PetscInt extras, const PgExtraField extra[], PgHdf *hdf)
{
  const PgFieldInfo *info;
  PetscInt           rows, fields, components = 1 /* id */, datasets = 1 + extras;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(output->particles, NULL, NULL, &rows));
  PetscCall(PgParticlesGetFieldCount(output->particles, &fields));
  for (PgField f = 0; f < fields; f++) {
    PetscCall(PgParticlesGetFieldInfo(output->particles, f, &info));
    if (!IsWritten(f, info)) continue;
    components += info->components;
    datasets++;
  }
  for (PetscInt k = 0; k < extras; k++) components += extra[k].components;
  /* 8 bytes for a value, 2 KiB for the tables and texts of a dataset, 16 KiB for those of the group. */
  PetscCall(PgOutputOpen(
      output, 8 * (PetscReal)components * (PetscReal)rows + 2048 * (PetscReal)datasets + 16384 + PgHistoryBytes(output),
      hdf));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteSnapshot(PgOutput output, PgHdf *hdf, PetscReal time, PetscInt extras,
                                    const PgExtraField extra[])
{
  Snapshot s = {.hdf = hdf};

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(output->particles, NULL, NULL, &s.rows));
  PetscCall(PgParticlesGetIdRange(output->particles, &s.start, &s.count));
  (void)snprintf(s.group, sizeof s.group, "/snapshots/%06lld", (long long)output->snapshots);
  PetscCall(PgHdfRemoveIfThere(hdf, PG_SNAPSHOT_INCOMPLETE)); /* of an attempt that failed */
  PetscCall(PgHdfGroup(hdf, PG_SNAPSHOT_INCOMPLETE));
  PetscCall(PgHdfReal(hdf, PG_SNAPSHOT_INCOMPLETE, "time", time));
  PetscCall(PgHdfText(hdf, PG_SNAPSHOT_INCOMPLETE, "time_unit", "s"));
  if (output->rank == 0) PetscCall(PgXdmfBeginGrid(output, s.group, time, s.rows));
  PetscCall(WriteIds(output, &s));
  PetscCall(WriteFields(output, &s));
  for (PetscInt k = 0; k < extras; k++)
    PetscCall(WriteField(output, &s, extra[k].name, extra[k].components, PETSC_FALSE, extra[k].unit,
                         extra[k].description, extra[k].byid));
  if (output->rank == 0) PetscCall(PgXdmfEndGrid(output));
  PetscCall(PgSnapshotComplete(output, hdf, s.group));
  PetscFunctionReturn(0);
}

PetscErrorCode PgOutputSnapshot(PgOutput output, PetscReal time, PetscInt extras, const PgExtraField extra[])
{
  const size_t before = output->grids.used;
  PgHdf        hdf;

  PetscFunctionBeginUser;
  PetscCheck(!output->finished, output->comm, PETSC_ERR_ORDER, "the output is finished");
  PetscCall(OpenForSnapshot(output, extras, extra, &hdf));
  PetscCall(WriteSnapshot(output, &hdf, time, extras, extra));
  PetscCall(PgSnapshotClose(output, &hdf, before));
  PetscFunctionReturn(0);
}

PetscErrorCode PgOutputGetSnapshotCount(PgOutput output, PetscInt *count)
{
  PetscFunctionBeginUser;
  *count = output->snapshots;
  PetscFunctionReturn(0);
}

PetscErrorCode PgOutputFinish(PgOutput output)
{
  PgHdf hdf;

  PetscFunctionBeginUser;
  if (output->finished) PetscFunctionReturn(0);
  PetscCall(PgOutputOpen(output, PgHistoryBytes(output) + PG_PROVENANCE_BYTES, &hdf));
  PetscCall(PgHistoryAppend(output, &hdf));
  PetscCall(PgProvenanceFinish(&hdf));
  PetscCall(PgHdfFlush(&hdf));
  PetscCall(PgOutputClose(output, &hdf));
  PgHistoryAppendDone(output);
  PetscCall(PgHistoryCloseCsv(output));
  output->finished = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode PgOutputDestroy(PgOutput *output)
{
  PetscFunctionBeginUser;
  if (!*output) PetscFunctionReturn(0);
  PetscCall(PgHistoryDestroy(*output));
  PetscCall(PgTextDestroy(&(*output)->grids));
  PetscCall(PetscFree((*output)->byid));
  PetscCall(PetscFree((*output)->settled));
  PetscCall(PetscFree((*output)->file));
  PetscCall(PetscFree((*output)->xmf));
  PetscCall(PetscFree((*output)->csv));
  PetscCall(PetscFree(*output));
  PetscFunctionReturn(0);
}
