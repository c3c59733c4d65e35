/* Making a result file readable that a killed program has left in the middle of a change. */
#include "ioimpl.h"
#include <errno.h>
#include <unistd.h>

PetscErrorCode PgResultRecover(MPI_Comm comm, const char file[], PetscBool *undone)
{
  const char *reason = NULL;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  *undone = PETSC_FALSE;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0 && PgResultIsBusy(file))
    reason = "a run is writing it: there is nothing to recover before that has ended";
  else if (rank == 0)
    reason = access(file, R_OK) ? strerror(errno) : PgJournalUndo(file, undone);
  PetscCall(PgFileCheck(comm, PETSC_ERR_FILE_READ, "cannot recover result file", file, reason));
  PetscCallMPI(MPI_Bcast(undone, 1, MPIU_BOOL, 0, comm));
  PetscFunctionReturn(0);
}

/* How many snapshots can be read, all ranks. */
static PetscErrorCode CountSnapshots(MPI_Comm comm, const char file[], PetscInt *count)
{
  PgHdf       hdf;
  PetscMPIInt rank;
  char        path[32];

  PetscFunctionBeginUser;
  *count = 0;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PgHdfOpenToRead(comm, file, &hdf));
  if (rank == 0) {
    H5G_info_t info;

    if (!PgHdfWatch(&hdf, "look for", "/snapshots", H5Lexists(hdf.id, "/snapshots", H5P_DEFAULT)))
      PgHdfFail(&hdf, "count snapshots", "",
                "it has no group /snapshots: a checkpoint, a packing, or another file of HDF5");
    for (; !hdf.failed; (*count)++) {
      (void)snprintf(path, sizeof path, "/snapshots/%06lld", (long long)*count);
      if (PgHdfWatch(&hdf, "look for", path, H5Lexists(hdf.id, path, H5P_DEFAULT)) <= 0) break;
      PgHdfWatch(&hdf, "open group", path, H5Gget_info_by_name(hdf.id, path, &info, H5P_DEFAULT));
    }
  }
  PetscCall(PgHdfClose(&hdf));
  PetscCallMPI(MPI_Bcast(count, 1, MPIU_INT, 0, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode PgResultRecoverFromOptions(MPI_Comm comm, PetscBool *asked)
{
  char      file[PETSC_MAX_PATH_LEN] = "";
  PetscBool undone;
  PetscInt  count;

  PetscFunctionBeginUser;
  PetscOptionsBegin(comm, "", "output: results, checkpoints and restart", "");
  PetscCall(PgOptionString(PetscOptionsObject, "-recover",
                           "result file FILE.h5 of a killed run: undo the change it was in the middle of, and end",
                           file, sizeof file, asked));
  PetscOptionsEnd();
  if (!*asked) PetscFunctionReturn(0);
  /* the command of the run that was killed may stand before it, with its file of options */
  PetscCall(PgOptionsCheckAlone(comm, "-recover"));
  PetscCall(PgResultRecover(comm, file, &undone));
  PetscCall(CountSnapshots(comm, file, &count));
  PetscCall(PetscPrintf(comm, "result file '%s': %s; it holds %" PetscInt_FMT " snapshots\n", file,
                        undone ? "a change that was interrupted has been undone" : "nothing to undo", count));
  PetscFunctionReturn(0);
}
