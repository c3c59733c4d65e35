/* Files that come with the program. */
#include "baseimpl.h"
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

/* Folder of the running program, with '/' at its end; empty where the system does not tell. */
static void ProgramFolder(char folder[], size_t size)
{
  const ssize_t n     = readlink("/proc/self/exe", folder, size - 1);
  char         *slash = NULL;

  folder[n > 0 ? n : 0]                  = '\0';
  slash                                  = strrchr(folder, '/');
  folder[slash ? slash + 1 - folder : 0] = '\0';
}

PetscBool PgShippedFind(const char name[], char file[], size_t size)
{
  /* installed, and built in a folder of the source */
  static const char *const place[] = {"../share/porograin/", "../"};
  char                     folder[PETSC_MAX_PATH_LEN];
  struct stat              found;

  ProgramFolder(folder, sizeof folder);
  for (size_t i = 0; folder[0] && i < sizeof place / sizeof *place; i++) {
    const int n = snprintf(file, size, "%s%s%s", folder, place[i], name);
    if (n > 0 && (size_t)n < size && access(file, R_OK) == 0 && !stat(file, &found) && S_ISREG(found.st_mode))
      return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscErrorCode PgShippedFile(MPI_Comm comm, const char name[], char file[], size_t size)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(file, name, size));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0 && access(name, R_OK) != 0 && !PgShippedFind(name, file, size))
    PetscCall(PetscStrncpy(file, name, size));
  PetscCallMPI(MPI_Bcast(file, (PetscMPIInt)size, MPI_CHAR, 0, comm));
  PetscFunctionReturn(0);
}
