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

  if (result >= 0 || hdf->failed) return result;
  (void)H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, TakeInnermost, &in);
  /* HDF5 puts the time of day with a line feed into some messages. */
  for (char *c = reason; *c; c++)
    if (*c == '\n' || *c == '\r') *c = ' ';
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

static void Begin(MPI_Comm comm, const char file[], PgHdf *hdf)
{
  (void)memset(hdf, 0, sizeof *hdf);
  hdf->comm = comm;
  hdf->file = file;
  hdf->what = "result file";
  hdf->id   = H5I_INVALID_HID;
  hdf->code = PETSC_ERR_FILE_OPEN;
  (void)H5Eget_auto2(H5E_DEFAULT, &hdf->print, &hdf->print_context);
  (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

static PetscErrorCode OpenCollectively(MPI_Comm comm, const char file[], PetscBool create, PgHdf *hdf)
{
  hid_t access;

  PetscFunctionBeginUser;
  Begin(comm, file, hdf);
  access = PgHdfWatch(hdf, "prepare the access", "", H5Pcreate(H5P_FILE_ACCESS));
  PgHdfWatch(hdf, "set the MPI-IO access", "", H5Pset_fapl_mpio(access, comm, MPI_INFO_NULL));
  /* After a failure objects may still be open: closing the file closes them too. */
  PgHdfWatch(hdf, "set the closing mode", "", H5Pset_fclose_degree(access, H5F_CLOSE_STRONG));
  PetscCall(PgHdfAgree(hdf));
  if (!hdf->failed) {
    hdf->id = create ? H5Fcreate(file, H5F_ACC_TRUNC, H5P_DEFAULT, access) : H5Fopen(file, H5F_ACC_RDWR, access);
    PgHdfWatch(hdf, create ? "create the file" : "open the file", "", hdf->id);
    PetscCall(PgHdfAgree(hdf));
  }
  (void)H5Pclose(access);
  if (!hdf->failed) hdf->code = PETSC_ERR_FILE_WRITE;
  PetscFunctionReturn(0);
}

PetscErrorCode PgHdfCreate(MPI_Comm comm, const char file[], PgHdf *hdf)
{
  PetscFunctionBeginUser;
  PetscCall(OpenCollectively(comm, file, PETSC_TRUE, hdf));
  PetscFunctionReturn(0);
}

PetscErrorCode PgHdfOpen(MPI_Comm comm, const char file[], PgHdf *hdf)
{
  PetscFunctionBeginUser;
  PetscCall(OpenCollectively(comm, file, PETSC_FALSE, hdf));
  PetscFunctionReturn(0);
}

PetscErrorCode PgHdfOpenToRead(MPI_Comm comm, const char file[], PgHdf *hdf)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  Begin(comm, file, hdf);
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) hdf->id = PgHdfWatch(hdf, "open the file", "", H5Fopen(file, H5F_ACC_RDONLY, H5P_DEFAULT));
  PetscCall(PgHdfAgree(hdf));
  if (!hdf->failed) hdf->code = PETSC_ERR_FILE_READ;
  PetscFunctionReturn(0);
}

PetscErrorCode PgHdfFlush(PgHdf *hdf)
{
  PetscFunctionBeginUser;
  if (hdf->failed) PetscFunctionReturn(0);
  PgHdfWatch(hdf, "write out the file", "", H5Fflush(hdf->id, H5F_SCOPE_GLOBAL));
  PetscCall(PgHdfAgree(hdf));
  PetscFunctionReturn(0);
}

PetscErrorCode PgHdfClose(PgHdf *hdf)
{
  PetscFunctionBeginUser;
  if (hdf->id >= 0) PgHdfWatch(hdf, "close the file", "", H5Fclose(hdf->id));
  hdf->id = H5I_INVALID_HID;
  (void)H5Eset_auto2(H5E_DEFAULT, hdf->print, hdf->print_context);
  PetscCall(PgHdfAgree(hdf));
  if (hdf->failed) {
    PetscCall(PgReport(hdf->comm, "%s '%s': %s", hdf->what, hdf->file, hdf->trouble));
    PetscFunctionReturn(hdf->code);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgHdfGroup(PgHdf *hdf, const char path[])
{
  hid_t group;

  PetscFunctionBeginUser;
  if (hdf->failed) PetscFunctionReturn(0);
  group = PgHdfWatch(hdf, "create group", path, H5Gcreate2(hdf->id, path, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  if (group >= 0) PgHdfWatch(hdf, "close group", path, H5Gclose(group));
  PetscCall(PgHdfAgree(hdf));
  PetscFunctionReturn(0);
}

PetscErrorCode PgHdfRemoveIfThere(PgHdf *hdf, const char path[])
{
  hid_t there;

  PetscFunctionBeginUser;
  if (hdf->failed) PetscFunctionReturn(0);
  there = PgHdfWatch(hdf, "look for", path, H5Lexists(hdf->id, path, H5P_DEFAULT));
  if (there > 0) PgHdfWatch(hdf, "remove", path, H5Ldelete(hdf->id, path, H5P_DEFAULT));
  PetscCall(PgHdfAgree(hdf));
  PetscFunctionReturn(0);
}

PetscErrorCode PgHdfMove(PgHdf *hdf, const char from[], const char to[])
{
  PetscFunctionBeginUser;
  if (hdf->failed) PetscFunctionReturn(0);
  PgHdfWatch(hdf, "move a group to", to, H5Lmove(hdf->id, from, hdf->id, to, H5P_DEFAULT, H5P_DEFAULT));
  PetscCall(PgHdfAgree(hdf));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteAttribute(PgHdf *hdf, const char object[], const char name[], hid_t type, const void *value)
{
  hid_t space, attribute, there;
  char  path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
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
  PetscCall(PgHdfAgree(hdf));
  PetscFunctionReturn(0);
}

PetscErrorCode PgHdfText(PgHdf *hdf, const char object[], const char name[], const char value[])
{
  hid_t type;

  PetscFunctionBeginUser;
  if (hdf->failed) PetscFunctionReturn(0);
  /* Variable length: no limit of 64 KiB for long lists of options, and h5py hands out str, not bytes. */
  type = PgHdfWatch(hdf, "make a string type for", object, H5Tcopy(H5T_C_S1));
  PgHdfWatch(hdf, "make a string type for", object, H5Tset_size(type, H5T_VARIABLE));
  PgHdfWatch(hdf, "make a string type for", object, H5Tset_cset(type, H5T_CSET_UTF8));
  PetscCall(WriteAttribute(hdf, object, name, type, &value));
  (void)H5Tclose(type);
  PetscFunctionReturn(0);
}

PetscErrorCode PgHdfReal(PgHdf *hdf, const char object[], const char name[], PetscReal value)
{
  PetscFunctionBeginUser;
  if (hdf->failed) PetscFunctionReturn(0);
  PetscCall(WriteAttribute(hdf, object, name, PG_HDF_REAL, &value));
  PetscFunctionReturn(0);
}

PetscErrorCode PgHdfInt(PgHdf *hdf, const char object[], const char name[], PetscInt value)
{
  PetscFunctionBeginUser;
  if (hdf->failed) PetscFunctionReturn(0);
  PetscCall(WriteAttribute(hdf, object, name, PG_HDF_INT, &value));
  PetscFunctionReturn(0);
}

PetscErrorCode PgHdfDataset(PgHdf *hdf, const char path[], hid_t type, int rank, const hsize_t size[],
                            hsize_t chunk_rows, const char unit[], const char description[])
{
  hsize_t limit[PG_HDF_MAX_RANK], chunk[PG_HDF_MAX_RANK];
  hid_t   space, create, dataset;

  PetscFunctionBeginUser;
  if (hdf->failed) PetscFunctionReturn(0);
  PetscCheck(rank >= 1 && rank <= PG_HDF_MAX_RANK, hdf->comm, PETSC_ERR_PLIB, "rank %d of dataset %s", rank, path);
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
  PetscCall(PgHdfAgree(hdf));
  PetscCall(PgHdfText(hdf, path, "unit", unit));
  PetscCall(PgHdfText(hdf, path, "description", description));
  PetscFunctionReturn(0);
}

/* Opens the dataset and gives it `rows` rows; size[] is its shape, *rank 0 after a failure. */
static hid_t OpenRows(PgHdf *hdf, const char path[], PetscInt rows, int *rank, hsize_t size[])
{
  hid_t dataset, space;

  *rank   = 0;
  dataset = PgHdfWatch(hdf, "open dataset", path, H5Dopen2(hdf->id, path, H5P_DEFAULT));
  if (dataset < 0) return dataset;
  space = PgHdfWatch(hdf, "open dataset", path, H5Dget_space(dataset));
  if (space >= 0) {
    const int found = H5Sget_simple_extent_dims(space, NULL, NULL);
    if (found >= 1 && found <= PG_HDF_MAX_RANK)
      *rank = H5Sget_simple_extent_dims(space, size, NULL);
    else
      PgHdfFail(hdf, "write dataset", path, "it has no rows");
    (void)H5Sclose(space);
  }
  if (*rank && size[0] != (hsize_t)rows) {
    size[0] = (hsize_t)rows;
    PgHdfWatch(hdf, "extend dataset", path, H5Dset_extent(dataset, size));
  }
  return dataset;
}

PetscErrorCode PgHdfWriteRows(PgHdf *hdf, const char path[], hid_t type, PetscInt rows, PetscInt start, PetscInt count,
                              const void *data)
{
  hsize_t offset[PG_HDF_MAX_RANK] = {0}, size[PG_HDF_MAX_RANK] = {0};
  hid_t   dataset, file_space, memory_space, transfer;
  int     rank;

  PetscFunctionBeginUser;
  if (hdf->failed) PetscFunctionReturn(0);
  dataset = OpenRows(hdf, path, rows, &rank, size);
  PetscCall(PgHdfAgree(hdf));
  if (!hdf->failed) {
    static const char unused = 0;

    offset[0]    = count ? (hsize_t)start : 0;
    size[0]      = (hsize_t)count;
    file_space   = PgHdfWatch(hdf, "select rows of", path, H5Dget_space(dataset));
    memory_space = PgHdfWatch(hdf, "select rows of", path, H5Screate_simple(rank, size, NULL));
    if (count) {
      PgHdfWatch(hdf, "select rows of", path,
                 H5Sselect_hyperslab(file_space, H5S_SELECT_SET, offset, NULL, size, NULL));
    } else {
      PgHdfWatch(hdf, "select rows of", path, H5Sselect_none(file_space));
      PgHdfWatch(hdf, "select rows of", path, H5Sselect_none(memory_space));
    }
    /* Every rank has one contiguous piece, so that there is nothing to gain from a collective transfer; and
       in one a failure of one rank leaves the others waiting. */
    transfer = PgHdfWatch(hdf, "set the transfer of", path, H5Pcreate(H5P_DATASET_XFER));
    PgHdfWatch(hdf, "set the transfer of", path, H5Pset_dxpl_mpio(transfer, H5FD_MPIO_INDEPENDENT));
    if (!hdf->failed)
      PgHdfWatch(hdf, "write dataset", path,
                 H5Dwrite(dataset, type, memory_space, file_space, transfer, count ? data : &unused));
    if (transfer >= 0) (void)H5Pclose(transfer);
    if (memory_space >= 0) (void)H5Sclose(memory_space);
    if (file_space >= 0) (void)H5Sclose(file_space);
  }
  if (dataset >= 0) PgHdfWatch(hdf, "close dataset", path, H5Dclose(dataset));
  PetscCall(PgHdfAgree(hdf));
  PetscFunctionReturn(0);
}
