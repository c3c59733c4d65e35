/* Whether what a checkpoint holds about the water can be used. */
#include "poreimpl.h"

PetscErrorCode PgPoreCheckState(PgPore pore, const char file[])
{
  MPI_Comm        comm = PgParticlesComm(pore->particles);
  const PetscInt *id;
  PetscReal      *porosity, *area, *side;
  PetscInt        owned, bad = -1;
  PetscMPIInt     holder;
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
    if (good || (bad >= 0 && id[a] >= bad)) continue;
    bad = id[a];
    PetscCall(PetscSNPrintf(text, sizeof text, "disc %" PetscInt_FMT " has porosity %g, sample_area %g m2, side %g",
                            bad, (double)porosity[a], (double)area[a], (double)side[a]));
  }
  PetscCall(PgFindHolder(comm, 0, bad, 0, &holder));
  if (holder < 0) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Bcast(text, sizeof text, MPI_CHAR, holder, comm));
  PetscCall(PgReport(comm, "checkpoint '%s': %s", file, text));
  PetscFunctionReturn(PETSC_ERR_FILE_READ);
}
