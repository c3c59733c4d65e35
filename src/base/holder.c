/* Which rank has the record that a message is to quote. */
#include <porograin/base.h>

PetscErrorCode PgFindHolder(MPI_Comm comm, PetscReal value, PetscInt first, PetscInt second, PetscMPIInt *holder)
{
  const PetscInt id[2]     = {first, second};
  PetscBool      candidate = (PetscBool)(first >= 0);
  PetscReal      most      = candidate ? value : -PETSC_MAX_REAL;
  PetscMPIInt    rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_REAL, MPIU_MAX, comm));
  candidate = (PetscBool)(candidate && value == most);
  for (int k = 0; k < 2; k++) {
    PetscInt least = candidate ? id[k] : PETSC_MAX_INT;
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPIU_INT, MPI_MIN, comm));
    candidate = (PetscBool)(candidate && id[k] == least);
  }
  *holder = candidate ? rank : PETSC_MPI_INT_MAX;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, holder, 1, MPI_INT, MPI_MIN, comm));
  if (*holder == PETSC_MPI_INT_MAX) *holder = -1;
  PetscFunctionReturn(0);
}
