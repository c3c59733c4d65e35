/* One step, in the order of the algorithm. */
#include "simulationimpl.h"

PetscErrorCode PgSimulationBuildLists(PgSimulation sim)
{
  PetscFunctionBeginUser;
  PetscCall(PgStagePush(PG_STAGE_LISTS));
  PetscCall(PgDemSaveHistory(sim->dem));
  PetscCall(PgNeighborsBuild(sim->neighbors));
  PetscCall(PgDemRestoreHistory(sim->dem));
  PetscCall(PgStagePop());
  PetscFunctionReturn(0);
}

static PetscErrorCode MoveDiscs(PgSimulation sim)
{
  static const PgField moving[3] = {PG_POSITION, PG_VELOCITY, PG_ANGULAR_VELOCITY};
  PetscBool            build;

  PetscFunctionBeginUser;
  PetscCall(PgStagePush(PG_STAGE_INTEGRATE));
  PetscCall(PgDemKickDrift(sim->dem, sim->dt));
  PetscCall(PgNeighborsNeedBuild(sim->neighbors, &build));
  PetscCall(PgStagePop());
  if (build)
    PetscCall(PgSimulationBuildLists(sim)); /* leaves the ghosts current */
  else
    PetscCall(PgParticlesHalo(sim->particles, 3, moving));
  PetscCall(PgStagePush(PG_STAGE_CONTACT));
  PetscCall(PgDemForcesKick(sim->dem, sim->dt));
  PetscCall(PgStagePop());
  PetscFunctionReturn(0);
}

static PetscErrorCode Step(PgSimulation sim)
{
  const PetscReal dt_f = sim->dt * (PetscReal)sim->fluid_every;

  PetscFunctionBeginUser;
  if (sim->pore) PetscCall(PgPorePredict(sim->pore, dt_f));
  for (PetscInt m = 0; m < sim->fluid_every; m++) PetscCall(MoveDiscs(sim));
  sim->step++;
  sim->time = (PetscReal)sim->step * dt_f;
  if (sim->pore) {
    PgPressure pressure;
    /* explicit sweeps compute their residual only where a row of the history shows it */
    PetscCall(PgPoreGetParts(sim->pore, NULL, &pressure));
    PetscCall(PgPressureRequestResidual(
        pressure, (PetscBool)(PgMonitorDue(sim, sim->history_every) || PgMonitorDue(sim, sim->progress_every))));
    PetscCall(PgPoreCorrect(sim->pore, dt_f));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Guard(PgSimulation sim)
{
  PetscFunctionBeginUser;
  PetscCall(PgDemGuard(sim->dem, sim->step * sim->fluid_every, sim->time));
  PetscCall(PgDemGuardTimeStep(sim->dem, sim->step * sim->fluid_every, sim->time, sim->dt));
  if (sim->pore) PetscCall(PgPoreGuard(sim->pore, sim->step * sim->fluid_every, sim->time));
  PetscFunctionReturn(0);
}

/* Water that blows up throws the discs about, and lists, contacts or the solver may notice first: the water is asked
   before they speak. */
static PetscErrorCode WithCause(PgSimulation sim, PetscErrorCode (*act)(PgSimulation))
{
  PetscErrorCode err;

  PetscFunctionBeginUser;
  if (sim->pore) PetscCall(PgSetCause(PgPoreFindCause, sim->pore));
  err = (*act)(sim);
  PetscCall(PgSetCause(NULL, NULL));
  PetscFunctionReturn(err);
}

PetscErrorCode PgSimulationStep(PgSimulation sim)
{
  PetscErrorCode err;

  PetscFunctionBeginUser;
  PgSetNow((sim->step + 1) * sim->fluid_every, (PetscReal)(sim->step + 1) * sim->dt * (PetscReal)sim->fluid_every);
  err = WithCause(sim, Step);
  PgSetNow(-1, 0.0);
  PetscFunctionReturn(err);
}

PetscErrorCode PgSimulationGuard(PgSimulation sim)
{
  PetscFunctionBeginUser;
  PetscCall(WithCause(sim, Guard));
  PetscFunctionReturn(0);
}

/* One step with its guard. A failure leaves a snapshot of the state behind. */
static PetscErrorCode Advance(PgSimulation sim)
{
  PetscErrorCode err;

  PetscFunctionBeginUser;
  err = PgSimulationStep(sim);
  if (!err && PgMonitorDue(sim, sim->guard_every)) err = PgSimulationGuard(sim);
  if (err) (void)PgPostMortem(sim);
  PetscFunctionReturn(err);
}

static PetscErrorCode Checkpoint(PgSimulation sim)
{
  PetscErrorCode err;

  PetscFunctionBeginUser;
  err = PgSimulationCheckpoint(sim);
  if (err == PETSC_ERR_NOT_CONVERGED) (void)PgPostMortem(sim); /* the guard */
  PetscFunctionReturn(err);
}

static PetscErrorCode Loop(PgSimulation sim, int *ending)
{
  PetscFunctionBeginUser;
  *ending = PG_ENDING_NONE;
  while (sim->step < sim->steps && !(*ending & PG_ENDING_ENDS)) {
    PetscCall(Advance(sim));
    PetscCall(PgMonitorStep(sim));
    PetscCall(PgEndingLook(&sim->watch, sim->step, ending));
    if (PgMonitorDue(sim, sim->checkpoint_every) || *ending & PG_ENDING_CHECKPOINT) PetscCall(Checkpoint(sim));
  }
  /* at the end, so that the run can be made longer; after Ctrl-C the user does not want to wait */
  if (!(*ending & PG_ENDING_INTERRUPT)) PetscCall(Checkpoint(sim));
  if (sim->step == sim->steps) *ending = PG_ENDING_NONE;
  PetscFunctionReturn(0);
}

PetscErrorCode PgSimulationRun(PgSimulation sim)
{
  PetscErrorCode err;
  int            ending;

  PetscFunctionBeginUser;
  PetscCall(PgMonitorStart(sim));
  sim->watch.most = sim->guard_every;
  PetscCall(PgEndingStart(&sim->watch, sim->comm, sim->step));
  err = Loop(sim, &ending);
  PgEndingStop();
  PetscCall(err);
  PetscCall(PgMonitorEnd(sim));
  if (ending)
    PetscCall(PgEndingTell(sim->comm, ending, sim->step * sim->fluid_every, sim->time,
                           sim->checkpoints ? sim->checkpoint_file : sim->restart_file,
                           sim->checkpoint_step < 0 ? -1 : sim->checkpoint_step * sim->fluid_every));
  PetscFunctionReturn(0);
}
