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
  PetscCall(PgDemForces(sim->dem, sim->dt));
  PetscCall(PgStagePop());
  PetscCall(PgStagePush(PG_STAGE_INTEGRATE));
  PetscCall(PgDemKick(sim->dem, sim->dt));
  PetscCall(PgStagePop());
  PetscFunctionReturn(0);
}

PetscErrorCode PgSimulationStep(PgSimulation sim)
{
  const PetscReal dt_f = sim->dt * (PetscReal)sim->fluid_every;

  PetscFunctionBeginUser;
  if (sim->pore) PetscCall(PgPorePredict(sim->pore, dt_f));
  for (PetscInt m = 0; m < sim->fluid_every; m++) PetscCall(MoveDiscs(sim));
  if (sim->pore) PetscCall(PgPoreCorrect(sim->pore, dt_f));
  sim->step++;
  sim->time = (PetscReal)sim->step * dt_f;
  PetscFunctionReturn(0);
}

PetscErrorCode PgSimulationGuard(PgSimulation sim)
{
  PetscFunctionBeginUser;
  PetscCall(PgDemGuard(sim->dem, sim->step * sim->fluid_every, sim->time));
  if (sim->pore) PetscCall(PgPoreGuard(sim->pore, sim->step * sim->fluid_every, sim->time));
  PetscFunctionReturn(0);
}

PetscErrorCode PgSimulationRun(PgSimulation sim)
{
  PetscFunctionBeginUser;
  PetscCall(PgMonitorStart(sim));
  while (sim->step < sim->steps) {
    PetscCall(PgSimulationStep(sim));
    if (PgMonitorDue(sim, sim->guard_every)) PetscCall(PgSimulationGuard(sim));
    PetscCall(PgMonitorStep(sim));
  }
  PetscCall(PgMonitorEnd(sim));
  PetscFunctionReturn(0);
}
