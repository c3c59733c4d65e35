/* Reading results back: rank 0 reads, all ranks get it. Files are checked before memory is asked for. */
#include "ioimpl.h"

/* Rank 0: a file in the middle of a change may be in any state. */
static const char *WhyNotReadable(const char file[])
{
  if (!PgJournalIsThere(file)) return NULL;
  return PgResultIsBusy(file)
             ? "a run is writing to it just now: try again"
             : "it is being written, or was when its run was killed: run porograin -recover FILE when that has ended";
}

/* Class and shape of the dataset as rows and columns; a failure is remembered in hdf. */
static void GetShape(PgHdf *hdf, const char path[], hid_t dataset, PetscInt64 shape[2])
{
  hsize_t size[H5S_MAX_RANK];
  hid_t   space, type;
  int     rank = -1;

  shape[0] = shape[1] = 1;
  type                = PgHdfWatch(hdf, "read dataset", path, H5Dget_type(dataset));
  if (type >= 0 && H5Tget_class(type) != H5T_FLOAT && H5Tget_class(type) != H5T_INTEGER)
    PgHdfFail(hdf, "read dataset", path, "it does not hold numbers");
  space = PgHdfWatch(hdf, "read dataset", path, H5Dget_space(dataset));
  if (space >= 0) rank = H5Sget_simple_extent_dims(space, size, NULL);
  PgHdfWatch(hdf, "read dataset", path, rank);
  for (int k = 0; k < rank && !hdf->failed; k++) {
    PetscInt64 *extent = &shape[k > 0];
    if (size[k] > (hsize_t)PETSC_MAX_INT || (size[k] && *extent > (PetscInt64)PETSC_MAX_INT / (PetscInt64)size[k]))
      PgHdfFail(hdf, "read dataset", path, "it has more values than an integer of this build can count");
    else
      *extent *= (PetscInt64)size[k];
  }
  if (!hdf->failed && shape[1] && shape[0] > (PetscInt64)PETSC_MAX_INT / shape[1])
    PgHdfFail(hdf, "read dataset", path, "it has more values than an integer of this build can count");
  if (space >= 0) (void)H5Sclose(space);
  if (type >= 0) (void)H5Tclose(type);
}

/* On rank 0; *value stays NULL after a failure. */
static PetscErrorCode ReadDataset(PgHdf *hdf, const char path[], PetscInt64 shape[2], PetscReal **value)
{
  hid_t dataset;

  PetscFunctionBeginUser;
  dataset = PgHdfWatch(hdf, "open dataset", path, H5Dopen2(hdf->id, path, H5P_DEFAULT));
  if (dataset < 0) PetscFunctionReturn(0);
  GetShape(hdf, path, dataset, shape);
  if (!hdf->failed) {
    PetscCall(PetscMalloc1((size_t)(shape[0] * shape[1]) + 1, value));
    PgHdfWatch(hdf, "read dataset", path, H5Dread(dataset, PG_HDF_REAL, H5S_ALL, H5S_ALL, H5P_DEFAULT, *value));
  }
  (void)H5Dclose(dataset);
  PetscFunctionReturn(0);
}

static PetscErrorCode Broadcast(MPI_Comm comm, PetscInt64 count, PetscReal value[])
{
  const PetscInt64 most = 1 << 27; /* reals in a message: MPI counts are int, and so are bytes in places */

  PetscFunctionBeginUser;
  for (PetscInt64 done = 0; done < count; done += most)
    PetscCallMPI(MPI_Bcast(value + done, (PetscMPIInt)PetscMin(most, count - done), MPIU_REAL, 0, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode PgResultRead(MPI_Comm comm, const char file[], const char dataset[], PetscInt *rows, PetscInt *columns,
                            PetscReal **value)
{
  PgHdf          hdf;
  PetscMPIInt    rank;
  PetscInt64     shape[2] = {0, 0};
  PetscErrorCode err;

  PetscFunctionBeginUser;
  *value = NULL;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PgFileCheck(comm, PETSC_ERR_FILE_READ, "result file", file, rank ? NULL : WhyNotReadable(file)));
  PetscCall(PgHdfOpenToRead(comm, file, &hdf));
  if (rank == 0 && !hdf.failed) PetscCall(ReadDataset(&hdf, dataset, shape, value));
  err = PgHdfClose(&hdf);
  if (err) {
    PetscCall(PetscFree(*value));
    PetscFunctionReturn(err);
  }
  PetscCallMPI(MPI_Bcast(shape, 2, MPIU_INT64, 0, comm));
  if (rank) PetscCall(PetscMalloc1((size_t)(shape[0] * shape[1]) + 1, value));
  PetscCall(Broadcast(comm, shape[0] * shape[1], *value));
  *rows    = (PetscInt)shape[0];
  *columns = (PetscInt)shape[1];
  PetscFunctionReturn(0);
}

static void ReadAttribute(PgHdf *hdf, const char object[], const char name[], PetscReal *value)
{
  char  path[PETSC_MAX_PATH_LEN];
  hid_t attribute, type, space;

  (void)snprintf(path, sizeof path, "%s, %s", object, name);
  attribute = PgHdfWatch(hdf, "open attribute", path, H5Aopen_by_name(hdf->id, object, name, H5P_DEFAULT, H5P_DEFAULT));
  if (attribute < 0) return;
  type  = PgHdfWatch(hdf, "read attribute", path, H5Aget_type(attribute));
  space = PgHdfWatch(hdf, "read attribute", path, H5Aget_space(attribute));
  if (type >= 0 && H5Tget_class(type) != H5T_FLOAT && H5Tget_class(type) != H5T_INTEGER)
    PgHdfFail(hdf, "read attribute", path, "it is not a number");
  if (space >= 0 && H5Sget_simple_extent_npoints(space) != 1)
    PgHdfFail(hdf, "read attribute", path, "it is not one number");
  if (!hdf->failed) PgHdfWatch(hdf, "read attribute", path, H5Aread(attribute, PG_HDF_REAL, value));
  if (space >= 0) (void)H5Sclose(space);
  if (type >= 0) (void)H5Tclose(type);
  (void)H5Aclose(attribute);
}

PetscErrorCode PgResultReadAttribute(MPI_Comm comm, const char file[], const char object[], const char name[],
                                     PetscReal *value)
{
  PgHdf       hdf;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PgFileCheck(comm, PETSC_ERR_FILE_READ, "result file", file, rank ? NULL : WhyNotReadable(file)));
  PetscCall(PgHdfOpenToRead(comm, file, &hdf));
  if (rank == 0 && !hdf.failed) ReadAttribute(&hdf, object, name, value);
  PetscCall(PgHdfClose(&hdf));
  PetscCall(Broadcast(comm, 1, value));
  PetscFunctionReturn(0);
}
