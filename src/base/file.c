/* Whether a name is that of a file. */
#include "baseimpl.h"
#include <errno.h>
#include <sys/stat.h>

const char *PgWhyNotFile(const char file[], PetscInt64 *size)
{
  struct stat found;

  if (stat(file, &found)) return strerror(errno);
  if (S_ISDIR(found.st_mode)) return strerror(EISDIR);
  if (!S_ISREG(found.st_mode)) return "it is not a regular file";
  if (size) *size = (PetscInt64)found.st_size;
  return NULL;
}
