/* An HDF5 file between opening and closing, with errors that every rank agrees on. */
#include "ioimpl.h"

typedef struct {
  char   *text;
  size_t  size;
  hbool_t mpi; /* the message so far is of an MPI function: MPI's own words come one level up */
} Innermost;

static herr_t TakeInnermost(unsigned level, const H5E_error2_t *error, void *context)
{
  Innermost   *in   = context;
  const char  *desc = error->desc ? error->desc : "";
  const size_t used = strlen(in->text);

  if (level == 0) {
    (void)snprintf(in->text, in->size, "%s", desc);
    in->mpi = strncmp(desc, "MPI_", 4) == 0;
  } else if (level == 1 && in->mpi) {
    (void)snprintf(in->text + used, in->size - used, ": %s", desc);
  }
  return 0;
}

void PgHdfFail(PgHdf *hdf, const char action[], const char object[], const char reason[])
{
  if (hdf->failed) return;
  hdf->failed = PETSC_TRUE;
  if (object[0])
    (void)snprintf(hdf->trouble, sizeof hdf->trouble, "cannot %s '%s': %s", action, object, reason);
  else
    (void)snprintf(hdf->trouble, sizeof hdf->trouble, "cannot %s: %s", action, reason);
}

hid_t PgHdfWatch(PgHdf *hdf, const char action[], const char object[], hid_t result)
{
  char      reason[512] = "";
  Innermost in          = {reason, sizeof reason, 0};

  if (hdf->failed || (result >= 0 && !hdf->disk.error)) return result;
  if (hdf->disk.error) {
    PgHdfFail(hdf, action, object, strerror(hdf->disk.error));
    return result;
  }
  (void)H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, TakeInnermost, &in);
  /* HDF5 puts the time of day with a line feed into some messages. */
  for (char *c = reason; *c; c++)
    if (*c == '\n' || *c == '\r') *c = ' ';
  if (!strcmp(reason, "file signature not found"))
    (void)snprintf(reason, sizeof reason, "it is not a file of HDF5, or its beginning is damaged");
  PgHdfFail(hdf, action, object, reason[0] ? reason : "HDF5 gives no reason");
  return result;
}

PetscErrorCode PgHdfAgree(PgHdf *hdf)
{
  PetscMPIInt rank, size, mine, first, code = (PetscMPIInt)hdf->code;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(hdf->comm, &rank));
  PetscCallMPI(MPI_Comm_size(hdf->comm, &size));
  mine = hdf->failed ? rank : size;
  PetscCallMPI(MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, hdf->comm));
  if (first < size) {
    PetscCallMPI(MPI_Bcast(hdf->trouble, sizeof hdf->trouble, MPI_CHAR, first, hdf->comm));
    PetscCallMPI(MPI_Bcast(&code, 1, MPI_INT, first, hdf->comm));
    hdf->failed = PETSC_TRUE;
    hdf->code   = (PetscErrorCode)code;
  }
  PetscFunctionReturn(0);
}

typedef enum { CREATE, CHANGE, READ } Purpose;

static void OpenHere(const char file[], Purpose purpose, H5F_libver_t oldest, PgHdf *hdf)
{
  const char *reason = purpose == READ ? PgWhyNotFile(file, NULL) : NULL;
  hid_t       access;

  if (reason) {
    PgHdfFail(hdf, "open the file", "", reason);
    return;
  }
  access = PgHdfWatch(hdf, "prepare the access", "", PgDiskAccess(&hdf->disk));
  if (access < 0) return;
  PgHdfWatch(hdf, "set the format", "", H5Pset_libver_bounds(access, oldest, H5F_LIBVER_LATEST));
  if (!hdf->failed && purpose == CREATE)
    hdf->id = PgHdfWatch(hdf, "create the file", "", H5Fcreate(file, H5F_ACC_TRUNC, H5P_DEFAULT, access));
  else if (!hdf->failed)
    hdf->id = PgHdfWatch(hdf, "open the file", "",
                         H5Fopen(file, purpose == CHANGE ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access));
  (void)H5Pclose(access);
}

static PetscErrorCode Open(MPI_Comm comm, const char file[], Purpose purpose, H5F_libver_t oldest, PgHdf *hdf)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  (void)memset(hdf, 0, sizeof *hdf);
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  hdf->comm = comm;
  hdf->here = (PetscBool)(rank == 0);
  hdf->file = file;
  hdf->what = "result file";
  hdf->id   = H5I_INVALID_HID;
  hdf->code = PETSC_ERR_FILE_OPEN;
  (void)H5Eget_auto2(H5E_DEFAULT, &hdf->print, &hdf->print_context);
  (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  if (hdf->here) OpenHere(file, purpose, oldest, hdf);
  PetscCall(PgHdfAgree(hdf));
  if (!hdf->failed) hdf->code = purpose == READ ? PETSC_ERR_FILE_READ : PETSC_ERR_FILE_WRITE;
  PetscFunctionReturn(0);
}

PetscErrorCode PgHdfCreate(MPI_Comm comm, const char file[], H5F_libver_t oldest, PgHdf *hdf)
{
  PetscFunctionBeginUser;
  PetscCall(Open(comm, file, CREATE, oldest, hdf));
  PetscFunctionReturn(0);
}

PetscErrorCode PgHdfOpen(MPI_Comm comm, const char file[], PgHdf *hdf)
{
  PetscFunctionBeginUser;
  PetscCall(Open(comm, file, CHANGE, H5F_LIBVER_EARLIEST, hdf));
  PetscFunctionReturn(0);
}

PetscErrorCode PgHdfOpenToRead(MPI_Comm comm, const char file[], PgHdf *hdf)
{
  PetscFunctionBeginUser;
  PetscCall(Open(comm, file, READ, H5F_LIBVER_EARLIEST, hdf));
  PetscFunctionReturn(0);
}

PetscErrorCode PgHdfFlush(PgHdf *hdf)
{
  PetscFunctionBeginUser;
  if (hdf->failed) PetscFunctionReturn(0);
  if (hdf->here) {
    herr_t status = H5Fflush(hdf->id, H5F_SCOPE_GLOBAL);
    if (status >= 0) PgDiskSync(&hdf->disk);
    PgHdfWatch(hdf, "write out the file", "", status);
  }
  PetscCall(PgHdfAgree(hdf));
  PetscFunctionReturn(0);
}

void PgHdfDismiss(PgHdf *hdf)
{
  hdf->failed     = PETSC_FALSE;
  hdf->disk.error = 0;
  hdf->print      = NULL;
}

void PgHdfShut(PgHdf *hdf)
{
  if (hdf->disk.unread)
    PgDiskAbandon(&hdf->disk);
  else if (hdf->id >= 0)
    PgHdfWatch(hdf, "close the file", "", H5Fclose(hdf->id));
  hdf->id = H5I_INVALID_HID;
  /* After a failure HDF5 may have lost count of its own memory, and would print lines about that in the end. */
  if (!hdf->failed) (void)H5Eset_auto2(H5E_DEFAULT, hdf->print, hdf->print_context);
}

PetscErrorCode PgHdfClose(PgHdf *hdf)
{
  PetscFunctionBeginUser;
  PgHdfShut(hdf);
  PetscCall(PgHdfAgree(hdf));
  if (hdf->failed) {
    PetscCall(PgReport(hdf->comm, "%s '%s': %s", hdf->what, hdf->file, hdf->trouble));
    PetscFunctionReturn(hdf->code);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgHdfGroup(PgHdf *hdf, const char path[])
{
  PetscFunctionBeginUser;
  if (hdf->failed) PetscFunctionReturn(0);
  if (hdf->here) {
    const hid_t group = PgHdfWatch(hdf, "create group", path,
                                   H5Gcreate2(hdf->id, path, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    if (group >= 0) PgHdfWatch(hdf, "close group", path, H5Gclose(group));
  }
  PetscCall(PgHdfAgree(hdf));
  PetscFunctionReturn(0);
}

PetscErrorCode PgHdfRemoveIfThere(PgHdf *hdf, const char path[])
{
  PetscFunctionBeginUser;
  if (hdf->failed) PetscFunctionReturn(0);
  if (hdf->here) {
    const hid_t there = PgHdfWatch(hdf, "look for", path, H5Lexists(hdf->id, path, H5P_DEFAULT));
    if (there > 0) PgHdfWatch(hdf, "remove", path, H5Ldelete(hdf->id, path, H5P_DEFAULT));
  }
  PetscCall(PgHdfAgree(hdf));
  PetscFunctionReturn(0);
}

PetscErrorCode PgHdfMove(PgHdf *hdf, const char from[], const char to[])
{
  PetscFunctionBeginUser;
  if (hdf->failed) PetscFunctionReturn(0);
  if (hdf->here) PgHdfWatch(hdf, "move a group to", to, H5Lmove(hdf->id, from, hdf->id, to, H5P_DEFAULT, H5P_DEFAULT));
  PetscCall(PgHdfAgree(hdf));
  PetscFunctionReturn(0);
}

static void WriteAttribute(PgHdf *hdf, const char object[], const char name[], hid_t type, const void *value)
{
  hid_t space, attribute, there;
  char  path[PETSC_MAX_PATH_LEN];

  (void)snprintf(path, sizeof path, "%s, %s", object, name);
  there = PgHdfWatch(hdf, "look for attribute", path, H5Aexists_by_name(hdf->id, object, name, H5P_DEFAULT));
  if (there > 0) PgHdfWatch(hdf, "replace attribute", path, H5Adelete_by_name(hdf->id, object, name, H5P_DEFAULT));
  space     = PgHdfWatch(hdf, "describe attribute", path, H5Screate(H5S_SCALAR));
  attribute = PgHdfWatch(hdf, "create attribute", path,
                         H5Acreate_by_name(hdf->id, object, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  if (attribute >= 0) {
    PgHdfWatch(hdf, "write attribute", path, H5Awrite(attribute, type, value));
    PgHdfWatch(hdf, "close attribute", path, H5Aclose(attribute));
  }
  if (space >= 0) (void)H5Sclose(space);
}

static void WriteText(PgHdf *hdf, const char object[], const char name[], const char value[])
{
  /* Variable length: no limit of 64 KiB for long lists of options, and h5py hands out str, not bytes. */
  const hid_t type = PgHdfWatch(hdf, "make a string type for", object, H5Tcopy(H5T_C_S1));

  PgHdfWatch(hdf, "make a string type for", object, H5Tset_size(type, H5T_VARIABLE));
  PgHdfWatch(hdf, "make a string type for", object, H5Tset_cset(type, H5T_CSET_UTF8));
  if (!hdf->failed) WriteAttribute(hdf, object, name, type, &value);
  (void)H5Tclose(type);
}

PetscErrorCode PgHdfText(PgHdf *hdf, const char object[], const char name[], const char value[])
{
  PetscFunctionBeginUser;
  if (hdf->failed) PetscFunctionReturn(0);
  if (hdf->here) WriteText(hdf, object, name, value);
  PetscCall(PgHdfAgree(hdf));
  PetscFunctionReturn(0);
}

PetscErrorCode PgHdfReal(PgHdf *hdf, const char object[], const char name[], PetscReal value)
{
  PetscFunctionBeginUser;
  if (hdf->failed) PetscFunctionReturn(0);
  if (hdf->here) WriteAttribute(hdf, object, name, PG_HDF_REAL, &value);
  PetscCall(PgHdfAgree(hdf));
  PetscFunctionReturn(0);
}

PetscErrorCode PgHdfInt(PgHdf *hdf, const char object[], const char name[], PetscInt value)
{
  PetscFunctionBeginUser;
  if (hdf->failed) PetscFunctionReturn(0);
  if (hdf->here) WriteAttribute(hdf, object, name, PG_HDF_INT, &value);
  PetscCall(PgHdfAgree(hdf));
  PetscFunctionReturn(0);
}

static void CreateDataset(PgHdf *hdf, const char path[], hid_t type, int rank, const hsize_t size[], hsize_t chunk_rows)
{
  hsize_t limit[PG_HDF_MAX_RANK], chunk[PG_HDF_MAX_RANK];
  hid_t   space, create, dataset;

  for (int k = 0; k < rank; k++) limit[k] = chunk[k] = size[k];
  create = PgHdfWatch(hdf, "describe dataset", path, H5Pcreate(H5P_DATASET_CREATE));
  /* Every row gets written: filling in zeros first would double the traffic. */
  PgHdfWatch(hdf, "describe dataset", path, H5Pset_fill_time(create, H5D_FILL_TIME_NEVER));
  if (chunk_rows) {
    limit[0] = H5S_UNLIMITED;
    chunk[0] = chunk_rows;
    PgHdfWatch(hdf, "describe dataset", path, H5Pset_chunk(create, rank, chunk));
  }
  space   = PgHdfWatch(hdf, "describe dataset", path, H5Screate_simple(rank, size, limit));
  dataset = PgHdfWatch(hdf, "create dataset", path,
                       H5Dcreate2(hdf->id, path, type, space, H5P_DEFAULT, create, H5P_DEFAULT));
  if (dataset >= 0) PgHdfWatch(hdf, "close dataset", path, H5Dclose(dataset));
  if (space >= 0) (void)H5Sclose(space);
  if (create >= 0) (void)H5Pclose(create);
}

PetscErrorCode PgHdfDataset(PgHdf *hdf, const char path[], hid_t type, int rank, const hsize_t size[],
                            hsize_t chunk_rows, const char unit[], const char description[])
{
  PetscFunctionBeginUser;
  if (hdf->failed) PetscFunctionReturn(0);
  PetscCheck(rank >= 1 && rank <= PG_HDF_MAX_RANK, hdf->comm, PETSC_ERR_PLIB, "rank %d of dataset %s", rank, path);
  if (hdf->here) {
    CreateDataset(hdf, path, type, rank, size, chunk_rows);
    if (!hdf->failed) WriteText(hdf, path, "unit", unit);
    if (!hdf->failed) WriteText(hdf, path, "description", description);
  }
  PetscCall(PgHdfAgree(hdf));
  PetscFunctionReturn(0);
}

/* ---- rows ---- */

/* A dataset that rows are written to, on rank 0. */
typedef struct {
  const char *path;
  hid_t       dataset, type;
  int         rank;
  hsize_t     size[PG_HDF_MAX_RANK];
} Rows;

/* Opens the dataset and gives it so many rows. */
static void OpenRows(PgHdf *hdf, PetscInt count, Rows *rows)
{
  hid_t space;

  rows->dataset = PgHdfWatch(hdf, "open dataset", rows->path, H5Dopen2(hdf->id, rows->path, H5P_DEFAULT));
  if (rows->dataset < 0) return;
  space = PgHdfWatch(hdf, "open dataset", rows->path, H5Dget_space(rows->dataset));
  if (space >= 0) {
    const int found = H5Sget_simple_extent_dims(space, NULL, NULL);
    if (found >= 1 && found <= PG_HDF_MAX_RANK)
      rows->rank = H5Sget_simple_extent_dims(space, rows->size, NULL);
    else
      PgHdfFail(hdf, "write dataset", rows->path, "it has no rows");
    (void)H5Sclose(space);
  }
  if (rows->rank && rows->size[0] != (hsize_t)count) {
    rows->size[0] = (hsize_t)count;
    PgHdfWatch(hdf, "extend dataset", rows->path, H5Dset_extent(rows->dataset, rows->size));
  }
}

static void PutRows(PgHdf *hdf, const Rows *rows, PetscInt start, PetscInt count, const void *data)
{
  hsize_t offset[PG_HDF_MAX_RANK] = {(hsize_t)start}, size[PG_HDF_MAX_RANK];
  hid_t   file_space, memory_space;

  if (hdf->failed || !count) return;
  (void)memcpy(size, rows->size, sizeof size);
  size[0]      = (hsize_t)count;
  file_space   = PgHdfWatch(hdf, "select rows of", rows->path, H5Dget_space(rows->dataset));
  memory_space = PgHdfWatch(hdf, "select rows of", rows->path, H5Screate_simple(rows->rank, size, NULL));
  PgHdfWatch(hdf, "select rows of", rows->path,
             H5Sselect_hyperslab(file_space, H5S_SELECT_SET, offset, NULL, size, NULL));
  if (!hdf->failed)
    PgHdfWatch(hdf, "write dataset", rows->path,
               H5Dwrite(rows->dataset, rows->type, memory_space, file_space, H5P_DEFAULT, data));
  if (memory_space >= 0) (void)H5Sclose(memory_space);
  if (file_space >= 0) (void)H5Sclose(file_space);
}

/* Rank 0: the rows of the other ranks, piece by piece; they are received even after a failure, so that nobody
   waits for ever. */
static PetscErrorCode Receive(PgHdf *hdf, const Rows *rows, PetscInt most, size_t row_bytes)
{
  PetscMPIInt ranks;
  PetscInt   *range, longest = 0, none[2] = {0, 0};
  char       *piece;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(hdf->comm, &ranks));
  PetscCall(PetscMalloc1(2 * ranks, &range));
  PetscCallMPI(MPI_Gather(none, 2, MPIU_INT, range, 2, MPIU_INT, 0, hdf->comm));
  for (PetscMPIInt r = 1; r < ranks; r++) longest = PetscMax(longest, range[2 * r + 1]);
  PetscCall(PetscMalloc1((size_t)PetscMin(most, longest) * row_bytes, &piece));
  for (PetscMPIInt r = 1; r < ranks; r++) {
    const PetscInt start = range[2 * r], count = range[2 * r + 1];
    for (PetscInt done = 0; done < count; done += most) {
      const PetscInt now = PetscMin(most, count - done);
      PetscCallMPI(
          MPI_Recv(piece, (PetscMPIInt)((size_t)now * row_bytes), MPI_BYTE, r, 0, hdf->comm, MPI_STATUS_IGNORE));
      PutRows(hdf, rows, start + done, now, piece);
    }
  }
  PetscCall(PetscFree(piece));
  PetscCall(PetscFree(range));
  PetscFunctionReturn(0);
}

static PetscErrorCode Send(PgHdf *hdf, PetscInt most, size_t row_bytes, PetscInt start, PetscInt count,
                           const char *data)
{
  PetscInt mine[2] = {start, count};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Gather(mine, 2, MPIU_INT, NULL, 0, MPIU_INT, 0, hdf->comm));
  for (PetscInt done = 0; done < count; done += most) {
    const PetscInt now = PetscMin(most, count - done);
    PetscCallMPI(
        MPI_Send(data + (size_t)done * row_bytes, (PetscMPIInt)((size_t)now * row_bytes), MPI_BYTE, 0, 0, hdf->comm));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgHdfWriteRows(PgHdf *hdf, const char path[], hid_t type, PetscInt rows, PetscInt start, PetscInt count,
                              const void *data)
{
  const PetscInt64 message = 1 << 18; /* bytes */
  Rows             to      = {.path = path, .dataset = H5I_INVALID_HID, .type = type};
  PetscInt64       row_bytes;
  PetscInt         most;

  PetscFunctionBeginUser;
  if (hdf->failed) PetscFunctionReturn(0);
  if (hdf->here) OpenRows(hdf, rows, &to);
  PetscCall(PgHdfAgree(hdf));
  if (!hdf->failed) {
    row_bytes = hdf->here ? (PetscInt64)H5Tget_size(type) : 0;
    for (int k = 1; k < to.rank; k++) row_bytes *= (PetscInt64)to.size[k];
    PetscCallMPI(MPI_Bcast(&row_bytes, 1, MPIU_INT64, 0, hdf->comm));
    most = (PetscInt)PetscMax(1, message / PetscMax(1, row_bytes));
    if (hdf->here) {
      PutRows(hdf, &to, start, count, data);
      PetscCall(Receive(hdf, &to, most, (size_t)row_bytes));
    } else {
      PetscCall(Send(hdf, most, (size_t)row_bytes, start, count, data));
    }
  }
  if (to.dataset >= 0) PgHdfWatch(hdf, "close dataset", path, H5Dclose(to.dataset));
  PetscCall(PgHdfAgree(hdf));
  PetscFunctionReturn(0);
}
