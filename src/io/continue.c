/* Going on with the result file of an interrupted run: an interrupted change is undone, what the restarted run
   will write again is cut off, and the two files beside it are made anew from it. */
#include "ioimpl.h"
#include <errno.h>
#include <sys/stat.h>
#include <unistd.h>

/* What is found in the file. */
typedef struct {
  PetscInt rows, snapshots;
  char     run[PG_RUN_NAME];
} Found;

static void ReadRun(PgHdf *hdf, char run[PG_RUN_NAME])
{
  char *text      = NULL;
  hid_t attribute = PgHdfWatch(hdf, "open attribute", "/provenance, run",
                               H5Aopen_by_name(hdf->id, "/provenance", "run", H5P_DEFAULT, H5P_DEFAULT));
  hid_t type;

  run[0] = 0;
  if (attribute < 0) return;
  type = H5Aget_type(attribute);
  if (type >= 0 && H5Tis_variable_str(type) > 0 && H5Aread(attribute, type, &text) >= 0 && text) {
    (void)snprintf(run, PG_RUN_NAME, "%s", text);
    (void)H5free_memory(text);
  }
  if (type >= 0) (void)H5Tclose(type);
  (void)H5Aclose(attribute);
}

/* Rows of a column; a failure when it is not a growing column of reals. */
static PetscInt CountRows(PgHdf *hdf, const char path[])
{
  hsize_t     size = 0;
  hid_t       space, type;
  const hid_t dataset = PgHdfWatch(hdf, "open dataset", path, H5Dopen2(hdf->id, path, H5P_DEFAULT));

  if (dataset < 0) return 0;
  space = H5Dget_space(dataset);
  type  = H5Dget_type(dataset);
  if (space < 0 || type < 0 || H5Sget_simple_extent_ndims(space) != 1 || H5Tget_class(type) != H5T_FLOAT)
    PgHdfFail(hdf, "go on with dataset", path, "it is not a column of real numbers");
  else
    (void)H5Sget_simple_extent_dims(space, &size, NULL);
  if (size > (hsize_t)PETSC_MAX_INT) PgHdfFail(hdf, "go on with dataset", path, "it is too long");
  if (type >= 0) (void)H5Tclose(type);
  if (space >= 0) (void)H5Sclose(space);
  (void)H5Dclose(dataset);
  return (PetscInt)size;
}

/* Rank 0: what the file holds. */
static void Examine(PgOutput output, PgHdf *hdf, Found *found)
{
  H5G_info_t info;
  char       path[PETSC_MAX_PATH_LEN];

  ReadRun(hdf, found->run);
  if (PgHdfWatch(hdf, "open group", "/history", H5Gget_info_by_name(hdf->id, "/history", &info, H5P_DEFAULT)) < 0)
    return;
  if ((PetscInt)info.nlinks != output->columns)
    PgHdfFail(hdf, "go on with group", "/history", "it does not have the columns of this run");
  for (PetscInt c = 0; c < output->columns && !hdf->failed; c++) {
    PetscInt rows;
    if (PgHistoryPath(output, c, path, sizeof path)) return;
    rows = CountRows(hdf, path);
    if (c && rows != found->rows) PgHdfFail(hdf, "go on with dataset", path, "the columns differ in length");
    found->rows = rows;
  }
  for (found->snapshots = 0; !hdf->failed; found->snapshots++) {
    (void)snprintf(path, sizeof path, "/snapshots/%06lld", (long long)found->snapshots);
    if (PgHdfWatch(hdf, "look for", path, H5Lexists(hdf->id, path, H5P_DEFAULT)) <= 0) break;
  }
}

/* ---- the index for ParaView, from the file ---- */

typedef struct {
  PgOutput       output;
  PgHdf         *hdf;
  const char    *group; /* of the snapshot */
  PetscErrorCode err;
} Walk;

static herr_t IndexDataset(hid_t group, const char *name, const H5L_info_t *info, void *context)
{
  Walk    *walk = context;
  hsize_t  size[H5S_MAX_RANK];
  hid_t    dataset = H5Dopen2(group, name, H5P_DEFAULT), space, type;
  int      rank;
  PetscInt components = 1;

  (void)info;
  if (dataset < 0) return -1;
  space = H5Dget_space(dataset);
  type  = H5Dget_type(dataset);
  rank  = space >= 0 ? H5Sget_simple_extent_dims(space, size, NULL) : 0;
  for (int k = 1; k < rank; k++) components *= (PetscInt)size[k];
  if (rank >= 1 && rank <= PG_HDF_MAX_RANK && type >= 0) {
    /* a plane mesh of quadrilaterals never has as many nodes as cells */
    const PgGridField field = {
        .name = name, .of_cells = (PetscBool)((PetscInt)size[0] == walk->output->grid.cells), .components = components};
    if (walk->output->particles)
      walk->err = PgXdmfAddField(walk->output, walk->group, name, components,
                                 (PetscBool)(H5Tget_class(type) == H5T_INTEGER), (PetscInt)size[0]);
    else
      walk->err = PgXdmfAddGridField(walk->output, walk->group, &field);
  }
  if (type >= 0) (void)H5Tclose(type);
  if (space >= 0) (void)H5Sclose(space);
  (void)H5Dclose(dataset);
  return walk->err ? -1 : 0;
}

/* Rank 0. */
static PetscErrorCode IndexSnapshot(PgOutput output, PgHdf *hdf, PetscInt number)
{
  char      group[32];
  Walk      walk = {output, hdf, group, 0};
  PetscReal time = 0.0;
  PetscInt  rows = 0;
  hid_t     attribute;

  PetscFunctionBeginUser;
  (void)snprintf(group, sizeof group, "/snapshots/%06lld", (long long)number);
  attribute = PgHdfWatch(hdf, "open attribute time of", group,
                         H5Aopen_by_name(hdf->id, group, "time", H5P_DEFAULT, H5P_DEFAULT));
  if (attribute < 0) PetscFunctionReturn(0);
  PgHdfWatch(hdf, "read attribute time of", group, H5Aread(attribute, PG_HDF_REAL, &time));
  (void)H5Aclose(attribute);
  if (output->particles) {
    PetscCall(PgParticlesGetSizes(output->particles, NULL, NULL, &rows));
    PetscCall(PgXdmfBeginGrid(output, group, time, rows));
  } else {
    PetscCall(PgXdmfBeginMesh(output, group, time));
  }
  PgHdfWatch(hdf, "walk through group", group,
             H5Literate_by_name(hdf->id, group, H5_INDEX_NAME, H5_ITER_NATIVE, NULL, IndexDataset, &walk, H5P_DEFAULT));
  PetscCall(walk.err);
  PetscCall(PgXdmfEndGrid(output));
  PetscFunctionReturn(0);
}

/* ---- the history as text, from the file ---- */

/* Rank 0: all columns of the file, one after the other. */
static PetscErrorCode ReadHistory(PgOutput output, PgHdf *hdf, PetscInt rows, PetscReal **value)
{
  char path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1((size_t)rows * (size_t)output->columns + 1, value));
  for (PetscInt c = 0; c < output->columns && rows; c++) {
    hid_t dataset;
    PetscCall(PgHistoryPath(output, c, path, sizeof path));
    dataset = PgHdfWatch(hdf, "open dataset", path, H5Dopen2(hdf->id, path, H5P_DEFAULT));
    if (dataset < 0) break;
    PgHdfWatch(hdf, "read dataset", path,
               H5Dread(dataset, PG_HDF_REAL, H5S_ALL, H5S_ALL, H5P_DEFAULT, *value + (size_t)c * (size_t)rows));
    (void)H5Dclose(dataset);
  }
  PetscFunctionReturn(0);
}

/* Rank 0: the table under a temporary name, put into place when it is whole. */
static PetscErrorCode WriteCsv(PgOutput output, PetscInt rows, const PetscReal value[], const char **reason)
{
  char  temporary[PETSC_MAX_PATH_LEN];
  FILE *stream;
  int   bad;

  PetscFunctionBeginUser;
  (void)snprintf(temporary, sizeof temporary, "%s.tmp", output->csv);
  stream = fopen(temporary, "w");
  if (!stream) {
    *reason = strerror(errno);
    PetscFunctionReturn(0);
  }
  errno = 0;
  PetscCall(PgHistoryHeaderText(output, &output->line));
  bad = fputs(output->line.string, stream) == EOF;
  for (PetscInt r = 0; r < rows && !bad; r++) {
    PetscCall(PgHistoryRowText(output, rows, r, value, &output->line));
    bad = fputs(output->line.string, stream) == EOF;
  }
  bad |= fflush(stream) == EOF;
  if (bad) *reason = strerror(errno ? errno : EIO);
  (void)fclose(stream);
  if (!*reason && rename(temporary, output->csv)) *reason = strerror(errno);
  if (*reason) {
    (void)unlink(temporary);
    PetscFunctionReturn(0);
  }
  output->csv_stream = fopen(output->csv, "a");
  if (output->csv_stream)
    PgHistoryLock(output->csv_stream);
  else
    *reason = strerror(errno);
  PetscFunctionReturn(0);
}

/* Makes the files beside the result file say what it says. Collective. */
static PetscErrorCode MakeCompanions(PgOutput output)
{
  PgHdf       hdf;
  PetscReal  *value  = NULL;
  const char *reason = NULL;

  PetscFunctionBeginUser;
  PetscCall(PgHdfOpenToRead(output->comm, output->file, &hdf));
  if (output->rank == 0 && !hdf.failed) {
    for (PetscInt k = 0; k < output->snapshots && !hdf.failed; k++) PetscCall(IndexSnapshot(output, &hdf, k));
    if (!hdf.failed) PetscCall(ReadHistory(output, &hdf, output->written, &value));
  }
  PetscCall(PgHdfClose(&hdf));
  if (output->rank == 0) PetscCall(WriteCsv(output, output->written, value, &reason));
  PetscCall(PetscFree(value));
  PetscCall(PgFileCheck(output->comm, PETSC_ERR_FILE_WRITE, "cannot write history file", output->csv, reason));
  PetscCall(PgXdmfWrite(output));
  PetscFunctionReturn(0);
}

/* ---- cutting ---- */

static PetscErrorCode Cut(PgOutput output, const Found *found, const char from[])
{
  PgHdf hdf;
  char  path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(PgOutputOpen(output, PG_PROVENANCE_BYTES, &hdf));
  for (PetscInt k = output->snapshots; k < found->snapshots; k++) {
    (void)snprintf(path, sizeof path, "/snapshots/%06lld", (long long)k);
    PetscCall(PgHdfRemoveIfThere(&hdf, path));
  }
  for (PetscInt c = 0; c < output->columns; c++) {
    PetscCall(PgHistoryPath(output, c, path, sizeof path));
    PetscCall(PgHdfWriteRows(&hdf, path, PG_HDF_REAL, output->written, 0, 0, NULL));
  }
  PetscCall(PgHdfInt(&hdf, "/snapshots", "count", output->snapshots));
  PetscCall(PgProvenanceRestart(&hdf, from, output->written, output->snapshots));
  PetscCall(PgHdfFlush(&hdf));
  PetscCall(PgOutputClose(output, &hdf));
  PetscFunctionReturn(0);
}

/* The file as found, for all ranks, and whether it can be gone on with. */
static PetscErrorCode ExamineTogether(PgOutput output, const char run[], Found *found)
{
  PgHdf       hdf;
  const char *reason = NULL;
  struct stat status;

  PetscFunctionBeginUser;
  PetscCall(PgHdfOpenToRead(output->comm, output->file, &hdf));
  if (output->rank == 0 && !hdf.failed) Examine(output, &hdf, found);
  PetscCall(PgHdfClose(&hdf));
  PetscCallMPI(MPI_Bcast(found, sizeof *found, MPI_BYTE, 0, output->comm));
  PgInputCheck(!strcmp(found->run, run), output->comm,
               "result file '%s' belongs to another run than the checkpoint: name another one, or remove it",
               output->file);
  if (output->rank == 0 && stat(output->file, &status)) reason = strerror(errno);
  if (output->rank == 0 && !reason) output->file_size = status.st_size;
  PetscCall(PgFileCheck(output->comm, PETSC_ERR_FILE_READ, "result file", output->file, reason));
  PetscFunctionReturn(0);
}

PetscErrorCode PgOutputTakeUp(PgOutput output, const char run[], PetscInt rows, PetscInt snapshots, const char from[])
{
  Found     found = {0, 0, ""};
  PetscBool undone;

  PetscFunctionBeginUser;
  PetscCall(PgResultRecover(output->comm, output->file, &undone));
  if (undone)
    PetscCall(
        PetscPrintf(output->comm, "result file '%s': a change that was interrupted has been undone\n", output->file));
  PetscCall(ExamineTogether(output, run, &found));
  if (found.rows < rows || found.snapshots < snapshots)
    PetscCall(PetscPrintf(output->comm,
                          "warning: result file '%s' has %" PetscInt_FMT " rows and %" PetscInt_FMT
                          " snapshots where the checkpoint knows of %" PetscInt_FMT " and %" PetscInt_FMT
                          ": there will be a gap\n",
                          output->file, found.rows, found.snapshots, rows, snapshots));
  PetscCall(PetscStrncpy(output->run, run, sizeof output->run));
  output->written   = PetscMin(rows, found.rows);
  output->snapshots = PetscMin(snapshots, found.snapshots);
  PetscCall(Cut(output, &found, from));
  PetscCall(MakeCompanions(output));
  PetscFunctionReturn(0);
}

PetscErrorCode PgOutputIsThere(MPI_Comm comm, const char file[], PetscBool *there)
{
  PetscMPIInt rank;
  struct stat status;
  const char *reason = NULL;

  PetscFunctionBeginUser;
  *there = PETSC_FALSE;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) reason = PgIsThere(file, there, &status);
  PetscCall(PgFileCheck(comm, PETSC_ERR_FILE_OPEN, "result file", file, reason));
  PetscCallMPI(MPI_Bcast(there, 1, MPIU_BOOL, 0, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode PgOutputContinue(PgParticles particles, const char file[], PetscInt columns, const PgColumn column[],
                                const char run[], PetscInt rows, PetscInt snapshots, const char from[],
                                PgOutput *output)
{
  PetscBool      there;
  PetscErrorCode err;

  PetscFunctionBeginUser;
  PetscCall(PgOutputIsThere(PgParticlesComm(particles), file, &there));
  if (!there) {
    if (run[0])
      PetscCall(PgOutputCreateAs(particles, file, columns, column, run, output));
    else /* the run had no result file before */
      PetscCall(PgOutputCreate(particles, file, columns, column, output));
    PetscFunctionReturn(0);
  }
  PetscCall(PgOutputPrepare(PgParticlesComm(particles), particles, file, columns, column, output));
  err = PgOutputTakeUp(*output, run, rows, snapshots, from);
  if (err) PetscCall(PgOutputDestroy(output));
  PetscFunctionReturn(err);
}

PetscErrorCode PgOutputGetRun(PgOutput output, char run[PG_RUN_NAME])
{
  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(run, output->run, PG_RUN_NAME));
  PetscFunctionReturn(0);
}
