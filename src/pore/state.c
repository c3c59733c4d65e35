/* Whether what a checkpoint holds about the water can be used. */
#include "poreimpl.h"

PetscErrorCode PgPoreCheckState(PgPore pore, const char file[])
{
  MPI_Comm        comm = PgParticlesComm(pore->particles);
  const PetscInt *id;
  PetscReal      *porosity, *area, *side;
  PetscInt        owned, bad = PETSC_MAX_INT, first;
  PetscMPIInt     rank, holder;
  char            text[160] = "";

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(pore->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetIds(pore->particles, &id));
  PetscCall(PgParticlesGetArray(pore->particles, pore->porosity, &porosity));
  PetscCall(PgParticlesGetArray(pore->particles, pore->rae_area, &area));
  PetscCall(PgParticlesGetArray(pore->particles, pore->side, &side));
  for (PetscInt a = 0; a < owned; a++) {
    const PetscBool good = (PetscBool)(porosity[a] > 0.0 && porosity[a] < 1.0 && area[a] > 0.0 && side[a] >= 0.0 &&
                                       side[a] < (PetscReal)(1 << PG_SIDE_COUNT));
    if (good || id[a] >= bad) continue;
    bad = id[a];
    PetscCall(PetscSNPrintf(text, sizeof text, "disc %" PetscInt_FMT " has porosity %g, sample_area %g m2, side %g",
                            bad, (double)porosity[a], (double)area[a], (double)side[a]));
  }
  PetscCallMPI(MPI_Allreduce(&bad, &first, 1, MPIU_INT, MPI_MIN, comm));
  if (first == PETSC_MAX_INT) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  holder = bad == first ? rank : PETSC_MPI_INT_MAX;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &holder, 1, MPI_INT, MPI_MIN, comm));
  PetscCallMPI(MPI_Bcast(text, sizeof text, MPI_CHAR, holder, comm));
  PetscCall(PgReport(comm, "checkpoint '%s': %s", file, text));
  PetscFunctionReturn(PETSC_ERR_FILE_READ);
}
