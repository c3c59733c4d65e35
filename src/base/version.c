/* What this program is made of. */
#include "baseimpl.h"
#include <H5public.h>
#include <petscpkg_version.h>
#include <stdio.h>
#include <string.h>

/* The build defines the commit it was made from, and how it was compiled. */
#if !defined(PG_GIT_REVISION)
  #define PG_GIT_REVISION "unknown"
#endif
#if !defined(PG_BUILD_TYPE)
  #define PG_BUILD_TYPE "unknown"
#endif

PetscErrorCode PgVersionPrint(MPI_Comm comm, const char program[])
{
  unsigned    major = 0, minor = 0, release = 0;
  char        mpi[MPI_MAX_LIBRARY_VERSION_STRING];
  PetscMPIInt length;
  PetscInt    petsc[3];

  PetscFunctionBeginUser;
  PetscCall(PetscGetVersionNumber(&petsc[0], &petsc[1], &petsc[2], NULL));
  (void)H5get_libversion(&major, &minor, &release);
  PetscCallMPI(MPI_Get_library_version(mpi, &length));
  mpi[strcspn(mpi, ",\n")] = '\0';
  PetscCall(PetscPrintf(comm, "%s %s\n", program, PG_VERSION));
  PetscCall(PetscPrintf(comm, "revision %s, build type %s", PG_GIT_REVISION, PG_BUILD_TYPE));
#if defined(PG_DEBUG)
  PetscCall(PetscPrintf(comm, ", with assertions"));
#endif
  PetscCall(PetscPrintf(comm, "\nPETSc %d.%d.%d, %zu-byte integers, real numbers of %zu bytes\n", (int)petsc[0],
                        (int)petsc[1], (int)petsc[2], sizeof(PetscInt), sizeof(PetscReal)));
#if defined(PETSC_HAVE_HYPRE)
  PetscCall(PetscPrintf(comm, "hypre %d.%d.%d\n", PETSC_PKG_HYPRE_VERSION_MAJOR, PETSC_PKG_HYPRE_VERSION_MINOR,
                        PETSC_PKG_HYPRE_VERSION_SUBMINOR));
#else
  PetscCall(PetscPrintf(comm, "hypre: not in this PETSc\n"));
#endif
  PetscCall(PetscPrintf(comm, "HDF5 %u.%u.%u\n", major, minor, release));
  PetscCall(PetscPrintf(comm, "MPI %s\n", mpi));
  PetscFunctionReturn(0);
}
