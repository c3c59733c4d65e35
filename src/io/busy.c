/* One run at a time writes a result file. It holds a lock of the system on FILE.csv, which it has open from its
   beginning to its end: the lock goes with the process, however that ends. (FILE.h5 is opened anew for each change, and
   HDF5 puts locks of its own there.) Where a file system has no locks nobody is refused. All calls are for rank 0. */
#include "ioimpl.h"
#include <errno.h>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

void PgHistoryLock(FILE *csv) { (void)flock(fileno(csv), LOCK_EX | LOCK_NB); }

PetscBool PgResultIsBusy(const char file[])
{
  char         csv[PETSC_MAX_PATH_LEN];
  const size_t length = strlen(file);
  int          descriptor;
  PetscBool    busy;

  if (length < 4 || length + 2 > sizeof csv || strcmp(file + length - 3, ".h5") != 0) return PETSC_FALSE;
  (void)snprintf(csv, sizeof csv, "%.*s.csv", (int)length - 3, file);
  descriptor = open(csv, O_RDONLY | O_NONBLOCK | O_CLOEXEC); /* a pipe shall not keep us waiting */
  if (descriptor < 0) return PETSC_FALSE;
  busy = (PetscBool)(flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK);
  (void)close(descriptor);
  return busy;
}
