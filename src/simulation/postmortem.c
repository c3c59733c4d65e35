/* The state of a run that has failed, for whoever looks for the reason. It never goes into a checkpoint. */
#include "simulationimpl.h"

/* FILE-postmortem.h5 beside the results, or else beside the checkpoint; empty when the run writes neither. */
static PetscErrorCode Name(PgSimulation sim, char file[PETSC_MAX_PATH_LEN])
{
  const char *beside = sim->output_file[0] ? sim->output_file : sim->checkpoint_file;
  size_t      length = strlen(beside);

  PetscFunctionBeginUser;
  file[0] = 0;
  if (length > 3 && !strcmp(beside + length - 3, ".h5")) length -= 3;
  if (length) PetscCall(PetscSNPrintf(file, PETSC_MAX_PATH_LEN, "%.*s-postmortem.h5", (int)length, beside));
  PetscFunctionReturn(0);
}

static PetscErrorCode Write(PgSimulation sim, const char file[])
{
  PgOutput       output;
  PetscErrorCode err;

  PetscFunctionBeginUser;
  PetscCall(PgOutputCreate(sim->particles, file, sim->columns, sim->column, &output));
  err = PgMonitorFillRow(sim);
  if (!err) err = PgOutputHistory(output, sim->row);
  if (!err) err = PgMonitorSnapshot(sim, output);
  if (!err) err = PgOutputFinish(output);
  PetscCall(PgOutputDestroy(&output));
  PetscFunctionReturn(err);
}

PetscErrorCode PgPostMortem(PgSimulation sim)
{
  char           file[PETSC_MAX_PATH_LEN];
  PetscMPIInt    size;
  PetscErrorCode err = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(sim->comm, &size));
  if (size > 1 && !PgErrorIsCollective()) PetscFunctionReturn(0); /* not all ranks are here */
  PetscCall(Name(sim, file));
  if (file[0]) err = Write(sim, file);
  PetscCall(PetscFPrintf(sim->comm, PETSC_STDERR,
                         "porograin: the run failed at step %" PetscInt_FMT ", time %g s%s%s%s\n",
                         sim->step * sim->fluid_every, (double)sim->time, file[0] && !err ? "; its state is in '" : "",
                         err ? "" : file, file[0] && !err ? "'" : ""));
  PetscFunctionReturn(0);
}
