/* Checkpoints and going on from them.

   A checkpoint is an event of the run that writes it, too: partition, lists and preconditioner are made anew from
   the state alone. A run that goes on from the file does the same, so that both have the same bits in the same
   order from then on. */
#include "simulationimpl.h"

/* What tells one problem from another: compared before anything else is looked at. */
static PetscErrorCode AddIdentity(PgSimulation sim, PgState state)
{
  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(sim->case_name, sim->case_info->name, sizeof sim->case_name));
  PetscCall(PetscStrncpy(sim->fluid_name, PgFluidWords[sim->fluid], sizeof sim->fluid_name));
  PetscCall(
      PgStateAddText(state, "simulation_case", PG_STATE_MATCH, "option -case", sizeof sim->case_name, sim->case_name));
  PetscCall(PgStateAddText(state, "simulation_fluid", PG_STATE_MATCH, "option -fluid", sizeof sim->fluid_name,
                           sim->fluid_name));
  PetscFunctionReturn(0);
}

static PetscErrorCode AddState(PgSimulation sim, PetscInt *builds, PgState state)
{
  PgPressure pressure;

  PetscFunctionBeginUser;
  PetscCall(PgStateAddReals(state, "simulation_radii", PG_STATE_MATCH,
                            "the sum of all radii, by the options of the case, [m]", 1, &sim->disc_sums[0]));
  PetscCall(PgStateAddReals(state, "simulation_masses", PG_STATE_MATCH,
                            "the mass of all discs, by the options of the case and -solid_density, [kg/m]", 1,
                            &sim->disc_sums[1]));
  PetscCall(PgStateAddReals(state, "simulation_dt", PG_STATE_MATCH, "the time step (option -dt) [s]", 1, &sim->dt));
  PetscCall(
      PgStateAddInts(state, "simulation_fluid_every", PG_STATE_MATCH, "option -fluid_every", 1, &sim->fluid_every));
  PetscCall(PgStateAddInts(state, "simulation_step", PG_STATE_KEEP, NULL, 1, &sim->step));
  PetscCall(PgStateAddReals(state, "simulation_time", PG_STATE_KEEP, NULL, 1, &sim->time));
  PetscCall(PgStateAddReals(state, "simulation_peak_load", PG_STATE_KEEP, NULL, 1, &sim->peak_load));
  PetscCall(PgStateAddReals(state, "simulation_peak_displacement", PG_STATE_KEEP, NULL, 1, &sim->peak_displacement));
  PetscCall(PgStateAddInts(state, "simulation_list_builds", PG_STATE_KEEP, NULL, 1, builds));
  PetscCall(PgStateAddText(state, "output_run", PG_STATE_KEEP, NULL, sizeof sim->run, sim->run));
  PetscCall(PgStateAddInts(state, "output_rows", PG_STATE_KEEP, NULL, 1, &sim->rows));
  PetscCall(PgStateAddInts(state, "output_snapshots", PG_STATE_KEEP, NULL, 1, &sim->snapshots));
  PetscCall(PgDemAddState(sim->dem, state));
  if (sim->pore) {
    PetscCall(PgPoreGetParts(sim->pore, NULL, &pressure));
    PetscCall(PgPressureAddState(pressure, state));
  }
  PetscFunctionReturn(0);
}

/* ---- writing ---- */

/* Everything that is derived from the state, made anew from it alone. */
static PetscErrorCode MakeAnew(PgSimulation sim)
{
  PgPressure pressure;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesForgetPartition(sim->particles));
  PetscCall(PgSimulationBuildLists(sim));
  if (sim->pore) {
    PetscCall(PgPoreRefresh(sim->pore));
    PetscCall(PgPoreGetParts(sim->pore, NULL, &pressure));
    PetscCall(PgPressureForgetPreconditioner(pressure));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgSimulationCheckpoint(PgSimulation sim)
{
  const PetscLogDouble start = MPI_Wtime();
  PgState              state;
  PetscInt             builds;
  PetscErrorCode       err;

  PetscFunctionBeginUser;
  if (!sim->checkpoint_file[0] || sim->checkpoint_step == sim->step) PetscFunctionReturn(0);
  PetscCall(PgSimulationGuard(sim)); /* a state that has gone wrong must not replace a good one */
  PetscCall(MakeAnew(sim));
  PetscCall(PgStagePush(PG_STAGE_OUTPUT));
  if (sim->output) {
    PetscCall(PgOutputFlush(sim->output));
    PetscCall(PgOutputGetRun(sim->output, sim->run));
    PetscCall(PgOutputGetRowCount(sim->output, &sim->rows));
    PetscCall(PgOutputGetSnapshotCount(sim->output, &sim->snapshots));
  }
  PetscCall(PgMonitorGetBuilds(sim, &builds));
  PetscCall(PgStateCreate(&state));
  PetscCall(AddIdentity(sim, state));
  PetscCall(AddState(sim, &builds, state));
  err = PgCheckpointWrite(sim->particles, state, sim->checkpoint_file);
  PetscCall(PgStateDestroy(&state));
  PetscCall(err);
  PetscCall(PgStagePop());
  sim->checkpoints++;
  sim->checkpoint_step = sim->step;
  sim->watch.cost      = MPI_Wtime() - start;
  PetscFunctionReturn(0);
}

/* ---- reading ---- */

/* The words of the failure come from PgCheckpointClose(). */
static PetscErrorCode CloseAfter(PetscErrorCode err, PgCheckpoint *checkpoint)
{
  const PetscErrorCode closing = PgCheckpointClose(checkpoint);

  return closing ? closing : err;
}

static PetscErrorCode ReadDiscs(PgSimulation sim, PgCheckpoint checkpoint)
{
  PgState        identity;
  PetscErrorCode err;

  PetscFunctionBeginUser;
  PetscCall(PgStateCreate(&identity));
  PetscCall(AddIdentity(sim, identity));
  err = PgCheckpointReadState(checkpoint, identity);
  PetscCall(PgStateDestroy(&identity));
  if (!err) err = PgCheckpointReadFields(checkpoint, sim->particles);
  PetscFunctionReturn(err);
}

PetscErrorCode PgRestartBegin(PgSimulation sim, PgCheckpoint *checkpoint)
{
  PetscErrorCode err;
  PetscReal     *x, *start;
  const char    *file;
  PgField        crossings;
  PetscInt       owned;

  PetscFunctionBeginUser;
  PetscCall(PgCheckpointOpen(sim->comm, sim->restart_file, checkpoint));
  err = ReadDiscs(sim, *checkpoint);
  if (err) PetscFunctionReturn(CloseAfter(err, checkpoint));
  PetscCall(PgCheckpointGetFile(*checkpoint, &file));
  err = PgDemCheckState(sim->dem, file);
  if (!err && sim->pore) err = PgPoreCheckState(sim->pore, file);
  if (err) PetscFunctionReturn(CloseAfter(err, checkpoint));
  PetscCall(PgParticlesGetSizes(sim->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(sim->particles, PG_POSITION, &x));
  PetscCall(PgParticlesGetArray(sim->particles, PG_INITIAL_POSITION, &start));
  PetscCall(PetscArraycpy(x, start, 2 * owned));
  PetscCall(PgParticlesFindField(sim->particles, "crossings", &crossings));
  if (crossings >= 0) {
    PetscCall(PgParticlesGetArray(sim->particles, crossings, &x));
    PetscCall(PetscArrayzero(x, owned));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadRest(PgSimulation sim, PgCheckpoint checkpoint, PetscInt *builds)
{
  PgState        state;
  PetscErrorCode err;

  PetscFunctionBeginUser;
  PetscCall(PgStateCreate(&state));
  PetscCall(AddState(sim, builds, state));
  err = PgCheckpointReadState(checkpoint, state);
  PetscCall(PgStateDestroy(&state));
  if (!err) err = PgCheckpointReadFields(checkpoint, sim->particles); /* positions, after lists of the start */
  PetscFunctionReturn(err);
}

PetscErrorCode PgRestartFinish(PgSimulation sim, PgCheckpoint *checkpoint)
{
  PgPressure     pressure;
  PetscInt       builds, own;
  const char    *file;
  char           name[PETSC_MAX_PATH_LEN];
  PetscErrorCode err;

  PetscFunctionBeginUser;
  err = ReadRest(sim, *checkpoint, &builds);
  PetscCall(PgCheckpointGetFile(*checkpoint, &file));
  PetscCall(PetscStrncpy(name, file, sizeof name));
  err = CloseAfter(err, checkpoint);
  if (err) PetscFunctionReturn(err);
  PgInputCheck(sim->step >= 0 && sim->rows >= 0 && sim->snapshots >= 0 &&
                   sim->time == (PetscReal)sim->step * (sim->dt * (PetscReal)sim->fluid_every),
               sim->comm, "checkpoint '%s': step %" PetscInt_FMT " does not go with time %g s", name, sim->step,
               (double)sim->time);
  PetscCall(PgParticlesForgetPartition(sim->particles));
  PetscCall(PgNeighborsBuild(sim->neighbors));
  PetscCall(PgDemRestoreHistory(sim->dem));
  PetscCall(PgNeighborsGetRevision(sim->neighbors, &own));
  sim->builds_before   = builds - own;
  sim->checkpoint_step = sim->step;
  if (sim->pore) {
    PetscCall(PgPoreRestart(sim->pore));
    PetscCall(PgPoreGetParts(sim->pore, NULL, &pressure));
    PetscCall(PgPressureSetUpSolver(pressure)); /* reads nested solver options */
    PetscCall(PgPressureForgetPreconditioner(pressure));
  }
  PetscCall(PetscStrncpy(sim->restart_file, name, sizeof sim->restart_file));
  PetscFunctionReturn(0);
}
