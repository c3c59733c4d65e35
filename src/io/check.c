/* What can be refused before anything is written: names, directories, a full disk. */
#include "ioimpl.h"
#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

PetscErrorCode PgFileCheck(MPI_Comm comm, PetscErrorCode code, const char what[], const char file[],
                           const char reason[])
{
  PetscMPIInt failed = reason ? 1 : 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, comm));
  if (failed) {
    PetscCall(PgReport(comm, "%s '%s': %s", what, file, reason ? reason : ""));
    PetscFunctionReturn(code);
  }
  PetscFunctionReturn(0);
}

static const char *BaseName(const char file[])
{
  const char *slash = strrchr(file, '/');
  return slash ? slash + 1 : file;
}

PetscErrorCode PgOutputCheckName(MPI_Comm comm, const char file[])
{
  const char  *base   = BaseName(file);
  const size_t length = strlen(base);

  PetscFunctionBeginUser;
  PgInputCheck(length > 3 && strcmp(base + length - 3, ".h5") == 0, comm,
               "result file '%s': the name must end in .h5, as in 'run.h5'", file);
  PgInputCheck(!strchr(base, ':'), comm,
               "result file '%s': the name must not hold ':', which ends the file name in the index for ParaView",
               file);
  PetscFunctionReturn(0);
}

/* What cannot be looked at is not absent: it must not be made anew, nor removed. */
const char *PgIsThere(const char file[], PetscBool *there, struct stat *found)
{
  *there = (PetscBool)(stat(file, found) == 0);
  return *there || errno == ENOENT || errno == ENOTDIR ? NULL : strerror(errno);
}

/* Opens the file for writing as the real writing will, and leaves no trace; NULL or why not. */
const char *PgWhyNotWritable(const char file[])
{
  struct stat before;
  PetscBool   there;
  const char *reason = PgIsThere(file, &there, &before);
  int         descriptor;

  if (reason) return reason;
  descriptor = open(file, O_WRONLY | O_CREAT | O_NONBLOCK | O_CLOEXEC, 0666);
  if (descriptor < 0) return strerror(errno);
  (void)close(descriptor);
  if (!there) (void)unlink(file);
  return NULL;
}

static const char *WhyNotDirectory(const char directory[])
{
  struct stat found;

  if (stat(directory, &found)) return strerror(errno);
  return S_ISDIR(found.st_mode) ? NULL : strerror(ENOTDIR);
}

static PetscErrorCode DirectoryOf(const char file[], char **directory)
{
  char *slash;

  PetscFunctionBeginUser;
  PetscCall(PetscStrallocpy(file, directory));
  slash = strrchr(*directory, '/');
  if (!slash) {
    PetscCall(PetscFree(*directory));
    PetscCall(PetscStrallocpy(".", directory));
  } else {
    slash[slash == *directory ? 1 : 0] = 0;
  }
  PetscFunctionReturn(0);
}

/* Whether the three files can be made where they are asked for, and no other run makes them: PETSC_ERR_FILE_OPEN. */
PetscErrorCode PgOutputCheckPlaces(MPI_Comm comm, const char file[], const char xmf[], const char csv[])
{
  const char *const places[] = {file, xmf, csv};
  char             *directory;
  PetscMPIInt       rank;
  PetscErrorCode    err;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(DirectoryOf(file, &directory));
  err = PgFileCheck(comm, PETSC_ERR_FILE_OPEN, "directory of the result file", directory,
                    rank ? NULL : WhyNotDirectory(directory));
  if (!err)
    err = PgFileCheck(comm, PETSC_ERR_FILE_OPEN, "result file", file,
                      !rank && PgResultIsBusy(file) ? "another run is writing it" : NULL);
  for (size_t k = 0; !err && k < PETSC_STATIC_ARRAY_LENGTH(places); k++)
    err = PgFileCheck(comm, PETSC_ERR_FILE_OPEN, "result file", places[k], rank ? NULL : PgWhyNotWritable(places[k]));
  PetscCall(PetscFree(directory));
  PetscFunctionReturn(err);
}

/* A disk that fills up while HDF5 writes its tables spoils what is in the file already, and a run on
   several ranks may not even come back from the call. So the blocks are asked for before HDF5 writes; it
   gives back what it did not need when it closes the file. NULL or why there is no room. */
static const char *Allocate(int descriptor, off_t size, off_t more)
{
  const int err = posix_fallocate(descriptor, size, more);

  /* Other codes say that this file system cannot tell. */
  if (err != ENOSPC && err != EFBIG && err != EDQUOT) return NULL;
  return strerror(ftruncate(descriptor, size) ? errno : err);
}

const char *PgWhyNoRoom(const char file[], off_t size, off_t more)
{
  const int   descriptor = open(file, O_WRONLY | O_CLOEXEC);
  const char *reason     = NULL;
  struct stat found;

  if (descriptor < 0) return strerror(errno);
  if (fstat(descriptor, &found))
    reason = strerror(errno);
  else if (found.st_size < size) /* HDF5 would notice, if the new blocks did not make up for it */
    reason = "the file has been cut since it was written";
  else
    reason = Allocate(descriptor, found.st_size, more);
  (void)close(descriptor);
  return reason;
}

/* For a new file: an old one of this name stays as it is, but its blocks will be free. */
const char *PgWhyNoRoomForNew(const char file[], off_t bytes)
{
  struct stat before;
  PetscBool   there;
  const char *reason = PgIsThere(file, &there, &before);
  int         descriptor;

  if (reason) return reason;
  descriptor = open(file, O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) return strerror(errno);
  if (!there) before.st_size = before.st_blocks = 0;
  if ((off_t)before.st_blocks * 512 < bytes) {
    reason = Allocate(descriptor, before.st_size, bytes);
    if (!reason && ftruncate(descriptor, before.st_size)) reason = strerror(errno);
  }
  (void)close(descriptor);
  if (!there) (void)unlink(file);
  return reason;
}

PetscErrorCode PgOutputCheckRoom(PgOutput output, PetscReal bytes)
{
  PetscFunctionBeginUser;
  PetscCall(PgFileCheck(output->comm, PETSC_ERR_FILE_WRITE, "cannot write result file", output->file,
                        output->rank ? NULL : PgWhyNoRoomForNew(output->file, (off_t)bytes)));
  PetscFunctionReturn(0);
}

PetscErrorCode PgOutputOpen(PgOutput output, PetscReal more, PgHdf *hdf)
{
  char        what[96];
  const char *reason = NULL;

  PetscFunctionBeginUser;
  (void)snprintf(what, sizeof what, "cannot write %.3f MiB more into result file", (double)more / 1048576.);
  PetscCall(PgFileCheck(output->comm, PETSC_ERR_FILE_WRITE, what, output->file,
                        output->rank ? NULL : PgWhyNoRoom(output->file, output->file_size, (off_t)more)));
  if (output->rank == 0) {
    reason = PgSettle(output);
    if (!reason)
      reason = PgJournalBegin(output->file, (int64_t)output->file_size, output->settled, output->settled_count);
    if (reason && truncate(output->file, output->file_size)) reason = strerror(errno);
  }
  PetscCall(
      PgFileCheck(output->comm, PETSC_ERR_FILE_WRITE, "cannot write the journal of result file", output->file, reason));
  PetscCall(PgHdfOpen(output->comm, output->file, hdf));
  PetscFunctionReturn(0);
}

PetscErrorCode PgOutputClose(PgOutput output, PgHdf *hdf)
{
  PetscErrorCode err    = PgHdfClose(hdf);
  const char    *reason = NULL;
  PetscBool      undone;
  struct stat    found;

  PetscFunctionBeginUser;
  if (output->rank == 0) {
    reason = err ? PgJournalUndo(output->file, &undone) : PgJournalEnd(output->file);
    if (!reason && stat(output->file, &found)) reason = strerror(errno);
    if (!reason) output->file_size = found.st_size;
  }
  if (err) PetscFunctionReturn(err);
  PetscCall(PgFileCheck(output->comm, PETSC_ERR_FILE_WRITE, "cannot write out result file", output->file, reason));
  PetscFunctionReturn(0);
}
