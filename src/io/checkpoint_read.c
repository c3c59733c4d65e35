/* Reading checkpoints: rank 0 reads and hands out, so that no rank waits in a parallel call for one that has
   failed. Everything is compared with what the run expects before memory is asked for or values are used. */
#include "checkpointimpl.h"
#include <math.h>
#include <stdlib.h>

/* ---- opening ---- */

static void ReadText(PgHdf *hdf, const char object[], const char name[], size_t size, char value[])
{
  char    path[256];
  hid_t   attribute, type, space;
  char   *text = NULL;
  hsize_t one;

  value[0] = 0;
  (void)snprintf(path, sizeof path, "%s, %s", object, name);
  if (H5Aexists_by_name(hdf->id, object, name, H5P_DEFAULT) <= 0) {
    PgHdfFail(hdf, "read attribute", path, "it is missing");
    return;
  }
  attribute = PgHdfWatch(hdf, "open attribute", path, H5Aopen_by_name(hdf->id, object, name, H5P_DEFAULT, H5P_DEFAULT));
  if (attribute < 0) return;
  type  = PgHdfWatch(hdf, "read attribute", path, H5Aget_type(attribute));
  space = PgHdfWatch(hdf, "read attribute", path, H5Aget_space(attribute));
  if (type >= 0 && H5Tis_variable_str(type) <= 0) PgHdfFail(hdf, "read attribute", path, "it is not a text");
  one = space >= 0 ? (hsize_t)H5Sget_simple_extent_npoints(space) : 1;
  if (one != 1) PgHdfFail(hdf, "read attribute", path, "it is not one text");
  if (!hdf->failed && H5Aread(attribute, type, &text) >= 0 && text) {
    if (strlen(text) >= size)
      PgHdfFail(hdf, "read attribute", path, "it is too long");
    else
      (void)snprintf(value, size, "%s", text);
    (void)H5free_memory(text);
  } else {
    PgHdfFail(hdf, "read attribute", path, "HDF5 cannot read it");
  }
  if (space >= 0) (void)H5Sclose(space);
  if (type >= 0) (void)H5Tclose(type);
  (void)H5Aclose(attribute);
}

PetscInt PgCheckpointReadNumber(PgHdf *hdf, const char name[])
{
  char      path[256];
  hid_t     attribute, type;
  long long value = -1;

  if (hdf->failed) return -1;
  (void)snprintf(path, sizeof path, "/, %s", name);
  if (H5Aexists_by_name(hdf->id, "/", name, H5P_DEFAULT) <= 0) {
    PgHdfFail(hdf, "read attribute", path, "it is missing");
    return -1;
  }
  attribute = PgHdfWatch(hdf, "open attribute", path, H5Aopen_by_name(hdf->id, "/", name, H5P_DEFAULT, H5P_DEFAULT));
  if (attribute < 0) return -1;
  type = PgHdfWatch(hdf, "read attribute", path, H5Aget_type(attribute));
  if (type >= 0) {
    hid_t space = H5Aget_space(attribute);
    if (H5Tget_class(type) != H5T_INTEGER || H5Sget_simple_extent_npoints(space) != 1)
      PgHdfFail(hdf, "read attribute", path, "it is not an integer");
    else
      PgHdfWatch(hdf, "read attribute", path, H5Aread(attribute, H5T_NATIVE_LLONG, &value));
    if (space >= 0) (void)H5Sclose(space);
    (void)H5Tclose(type);
  }
  (void)H5Aclose(attribute);
  return value < 0 || value > PETSC_MAX_INT ? -1 : (PetscInt)value;
}

/* Rank 0: is this a checkpoint that this program can read? */
static void CheckHeader(PgHdf *hdf)
{
  char     format[64], reason[256];
  PetscInt version, bytes;

  ReadText(hdf, "/", "format", sizeof format, format);
  if (!hdf->failed && strcmp(format, PG_CHECKPOINT_FORMAT)) PgHdfFail(hdf, "use the file", "", "it is no checkpoint");
  version = PgCheckpointReadNumber(hdf, "format_version");
  if (!hdf->failed && version != PG_CHECKPOINT_VERSION) {
    (void)snprintf(reason, sizeof reason, "its layout has version %lld, this program knows %d", (long long)version,
                   PG_CHECKPOINT_VERSION);
    PgHdfFail(hdf, "use the file", "", reason);
  }
  bytes = PgCheckpointReadNumber(hdf, "real_bytes");
  if (!hdf->failed && bytes != (PetscInt)sizeof(PetscReal)) {
    (void)snprintf(reason, sizeof reason, "its real numbers have %lld bytes, those of this build of PETSc %d",
                   (long long)bytes, (int)sizeof(PetscReal));
    PgHdfFail(hdf, "use the file", "", reason);
  }
}

PetscErrorCode PgCheckpointOpen(MPI_Comm comm, const char where[], PgCheckpoint *checkpoint)
{
  PgCheckpoint   c;
  const char    *reason       = NULL;
  char           remark[2048] = "";
  PetscErrorCode err;

  PetscFunctionBeginUser;
  *checkpoint = NULL;
  PetscCall(PetscNew(&c));
  c->comm = comm;
  PetscCallMPI(MPI_Comm_rank(comm, &c->rank));
  if (c->rank == 0) reason = PgCheckpointFind(where, c->file, remark, sizeof remark);
  if (remark[0]) PetscCall(PetscPrintf(PETSC_COMM_SELF, "warning: %s\n", remark));
  err = PgFileCheck(comm, PETSC_ERR_FILE_READ, "cannot restart from", where, reason);
  if (err) {
    PetscCall(PetscFree(c));
    PetscFunctionReturn(err);
  }
  PetscCallMPI(MPI_Bcast(c->file, sizeof c->file, MPI_CHAR, 0, comm));
  PetscCall(PgHdfOpenToRead(comm, c->file, &c->hdf));
  c->hdf.what = "checkpoint";
  if (c->rank == 0 && !c->hdf.failed) CheckHeader(&c->hdf);
  PetscCall(PgHdfAgree(&c->hdf));
  *checkpoint = c;
  if (c->hdf.failed) PetscCall(PgCheckpointClose(checkpoint));
  PetscFunctionReturn(0);
}

PetscErrorCode PgCheckpointGetFile(PgCheckpoint checkpoint, const char **file)
{
  PetscFunctionBeginUser;
  *file = checkpoint->file;
  PetscFunctionReturn(0);
}

PetscErrorCode PgCheckpointClose(PgCheckpoint *checkpoint)
{
  PetscErrorCode err;

  PetscFunctionBeginUser;
  if (!*checkpoint) PetscFunctionReturn(0);
  err = PgHdfClose(&(*checkpoint)->hdf);
  PetscCall(PetscFree(*checkpoint));
  PetscFunctionReturn(err);
}

/* ---- datasets, all on rank 0 ---- */

static void DescribeShape(int rank, const hsize_t size[], char text[], size_t room)
{
  size_t used = 0;

  text[0] = 0;
  for (int k = 0; k < rank && used < room; k++)
    used += (size_t)snprintf(text + used, room - used, "%s%llu", k ? ", " : "", (unsigned long long)size[k]);
}

static void CheckShape(PgHdf *hdf, const char path[], hid_t dataset, int rank, const hsize_t size[])
{
  hsize_t     found[H5S_MAX_RANK];
  char        is[128], must[128], reason[512];
  const hid_t space      = PgHdfWatch(hdf, "read dataset", path, H5Dget_space(dataset));
  const int   found_rank = space >= 0 ? H5Sget_simple_extent_dims(space, found, NULL) : -1;

  if (space >= 0) (void)H5Sclose(space);
  if (found_rank == rank && !memcmp(found, size, (size_t)rank * sizeof *size)) return;
  DescribeShape(found_rank, found, is, sizeof is);
  DescribeShape(rank, size, must, sizeof must);
  (void)snprintf(reason, sizeof reason, "its shape is (%s) where this run needs (%s)", is, must);
  PgHdfFail(hdf, "read dataset", path, reason);
}

static void CheckType(PgHdf *hdf, const char path[], hid_t dataset, hid_t type)
{
  const hid_t found = PgHdfWatch(hdf, "read dataset", path, H5Dget_type(dataset));

  if (found < 0) return;
  if (H5Tget_class(found) != H5Tget_class(type))
    PgHdfFail(hdf, "read dataset", path,
              H5Tget_class(type) == H5T_FLOAT ? "it does not hold real numbers" : "it does not hold integers");
  else if (H5Tget_class(type) == H5T_FLOAT && H5Tget_size(found) != H5Tget_size(type))
    PgHdfFail(hdf, "read dataset", path, "its real numbers have another precision");
  (void)H5Tclose(found);
}

/* Opens a dataset that must have this type and shape; negative and a failure otherwise. */
hid_t PgCheckpointOpenDataset(PgHdf *hdf, const char path[], hid_t type, int rank, const hsize_t size[])
{
  hid_t dataset;

  if (hdf->failed) return -1;
  if (H5Lexists(hdf->id, path, H5P_DEFAULT) <= 0) {
    PgHdfFail(hdf, "read dataset", path, "it is missing");
    return -1;
  }
  dataset = PgHdfWatch(hdf, "open dataset", path, H5Dopen2(hdf->id, path, H5P_DEFAULT));
  if (dataset < 0) return -1;
  CheckType(hdf, path, dataset, type);
  if (!hdf->failed) CheckShape(hdf, path, dataset, rank, size);
  if (hdf->failed) {
    (void)H5Dclose(dataset);
    return -1;
  }
  return dataset;
}

void PgCheckpointReadRows(PgHdf *hdf, const char path[], hid_t dataset, hid_t type, PetscInt start, PetscInt rows,
                          PetscInt columns, int rank, void *value)
{
  const hsize_t offset[2] = {(hsize_t)start, 0}, size[2] = {(hsize_t)rows, (hsize_t)columns};
  hid_t         file_space, memory_space;

  if (hdf->failed || rows == 0) return;
  file_space   = PgHdfWatch(hdf, "read dataset", path, H5Dget_space(dataset));
  memory_space = PgHdfWatch(hdf, "read dataset", path, H5Screate_simple(rank, size, NULL));
  PgHdfWatch(hdf, "read dataset", path, H5Sselect_hyperslab(file_space, H5S_SELECT_SET, offset, NULL, size, NULL));
  if (!hdf->failed)
    PgHdfWatch(hdf, "read dataset", path, H5Dread(dataset, type, memory_space, file_space, H5P_DEFAULT, value));
  if (memory_space >= 0) (void)H5Sclose(memory_space);
  if (file_space >= 0) (void)H5Sclose(file_space);
}

void PgCheckpointCheckFinite(PgHdf *hdf, const char path[], PetscInt start, PetscInt rows, PetscInt columns,
                             const PetscReal value[])
{
  char reason[128];

  if (hdf->failed) return;
  for (PetscInt i = 0; i < rows * columns; i++) {
    if (isfinite(value[i])) continue;
    (void)snprintf(reason, sizeof reason, "row %lld is not finite (%g)", (long long)start + i / columns,
                   (double)value[i]);
    PgHdfFail(hdf, "use dataset", path, reason);
    return;
  }
}

/* A dataset of `count` numbers on all ranks. */
static PetscErrorCode ReadForAll(PgCheckpoint c, const char path[], hid_t type, MPI_Datatype mpi_type, PetscInt count,
                                 void *value)
{
  const hsize_t size    = (hsize_t)count;
  hid_t         dataset = -1;

  PetscFunctionBeginUser;
  if (c->rank == 0) {
    dataset = PgCheckpointOpenDataset(&c->hdf, path, type, 1, &size);
    PgCheckpointReadRows(&c->hdf, path, dataset, type, 0, count, 1, 1, value);
    if (mpi_type == MPIU_REAL) PgCheckpointCheckFinite(&c->hdf, path, 0, count, 1, value);
    if (dataset >= 0) (void)H5Dclose(dataset);
  }
  PetscCall(PgHdfAgree(&c->hdf));
  if (!c->hdf.failed) PetscCallMPI(MPI_Bcast(value, (PetscMPIInt)count, mpi_type, 0, c->comm));
  PetscFunctionReturn(0);
}

/* ---- state ---- */

/* With the fewest digits that read back as the same number. */
static const char *Digits(PetscReal value, char text[32])
{
  for (int digits = 6; digits <= 17; digits++) {
    (void)snprintf(text, 32, "%.*g", digits, (double)value);
    if (strtod(text, NULL) == (double)value) break;
  }
  return text;
}

/* The value of a MATCHing item must be the one that is there. */
static void CheckMatch(PgHdf *hdf, const PgStateItem *item, const void *found)
{
  char      reason[1024] = "", is[32], now[32];
  const int length       = (int)sizeof reason;

  if (hdf->failed) return;
  switch (item->kind) {
  case PG_STATE_TEXT:
    if (strcmp(item->value, found))
      (void)snprintf(reason, (size_t)length, "%s is '%.200s' in the checkpoint and '%.200s' now", item->meaning,
                     (const char *)found, (const char *)item->value);
    break;
  case PG_STATE_REALS:
    for (PetscInt k = 0; k < item->count && !reason[0]; k++)
      if (((const PetscReal *)found)[k] != ((const PetscReal *)item->value)[k])
        (void)snprintf(reason, (size_t)length, "%s is %s in the checkpoint and %s now", item->meaning,
                       Digits(((const PetscReal *)found)[k], is), Digits(((const PetscReal *)item->value)[k], now));
    break;
  case PG_STATE_INTS:
    for (PetscInt k = 0; k < item->count && !reason[0]; k++)
      if (((const PetscInt *)found)[k] != ((const PetscInt *)item->value)[k])
        (void)snprintf(reason, (size_t)length, "%s is %lld in the checkpoint and %lld now", item->meaning,
                       (long long)((const PetscInt *)found)[k], (long long)((const PetscInt *)item->value)[k]);
    break;
  }
  if (reason[0]) PgHdfFail(hdf, "go on from it", "", reason);
}

static PetscErrorCode ReadItem(PgCheckpoint c, const PgStateItem *item)
{
  const size_t bytes = (size_t)item->count * (item->kind == PG_STATE_TEXT   ? 1
                                              : item->kind == PG_STATE_INTS ? sizeof(PetscInt)
                                                                            : sizeof(PetscReal));
  char         path[256];
  void        *found;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(bytes + 1, (char **)&found));
  (void)snprintf(path, sizeof path, "/state/%s", item->name);
  if (item->kind == PG_STATE_TEXT) {
    if (c->rank == 0) ReadText(&c->hdf, "/state", item->name, bytes, found);
    PetscCall(PgHdfAgree(&c->hdf));
    PetscCallMPI(MPI_Bcast(found, (PetscMPIInt)bytes, MPI_CHAR, 0, c->comm));
  } else {
    const PetscBool integer = (PetscBool)(item->kind == PG_STATE_INTS);
    PetscCall(
        ReadForAll(c, path, integer ? PG_HDF_INT : PG_HDF_REAL, integer ? MPIU_INT : MPIU_REAL, item->count, found));
  }
  if (item->rule == PG_STATE_MATCH)
    CheckMatch(&c->hdf, item, found);
  else if (!c->hdf.failed)
    PetscCall(PetscMemcpy(item->value, found, bytes));
  PetscCall(PetscFree(found));
  PetscFunctionReturn(0);
}

/* A failure so far as an error return; its words are kept for PgCheckpointClose(). */
PetscErrorCode PgCheckpointVerdict(PgCheckpoint c)
{
  PetscFunctionBeginUser;
  PetscCall(PgHdfAgree(&c->hdf));
  PetscFunctionReturn(c->hdf.failed ? c->hdf.code : 0);
}

PetscErrorCode PgCheckpointReadState(PgCheckpoint c, PgState state)
{
  const PgStateItem *item;
  PetscInt           count;

  PetscFunctionBeginUser;
  PetscCall(PgStateGetItems(state, &count, &item));
  for (PetscInt k = 0; k < count && !c->hdf.failed; k++) PetscCall(ReadItem(c, &item[k]));
  PetscFunctionReturn(PgCheckpointVerdict(c));
}
