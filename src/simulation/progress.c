/* How far the run is: a line now and then, or a bar on a terminal; and the summary at its end. */
#include "simulationimpl.h"

PetscErrorCode PgProgressSetFromOptions(PgSimulation sim, PetscOptionItems *PetscOptionsObject)
{
  PetscFunctionBeginUser;
  PetscCall(PgMeterSetFromOptions(sim->comm, PetscOptionsObject, &sim->meter, &sim->progress_time));
  if (sim->meter.progress != PG_PROGRESS_LINES) sim->progress_time = 0.0;
  PetscFunctionReturn(0);
}

PetscErrorCode PgProgressStart(PgSimulation sim)
{
  PetscFunctionBeginUser;
  PetscCall(PgMeterStart(&sim->meter, sim->comm, sim->step, sim->steps));
  sim->last_progress      = sim->meter.started;
  sim->last_progress_step = sim->step;
  PetscFunctionReturn(0);
}

PetscErrorCode PgProgressLine(PgSimulation sim)
{
  const PetscReal     *row = sim->row;
  const PetscLogDouble now = MPI_Wtime(), spent = now - sim->last_progress;
  const PetscInt       done = sim->step - sim->last_progress_step;
  PetscInt             global;
  char                 water[160] = "";

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(sim->particles, NULL, NULL, &global));
  if (sim->pore)
    PetscCall(PetscSNPrintf(water, sizeof water, "  p %.4g..%.4g Pa  its %d  res %.1e",
                            (double)row[COLUMN_PRESSURE_MIN], (double)row[COLUMN_PRESSURE_MAX],
                            (int)row[COLUMN_PRESSURE_ITERATIONS], (double)row[COLUMN_PRESSURE_RESIDUAL]));
  PetscCall(PetscPrintf(sim->comm,
                        "step %8" PetscInt_FMT "  t %.4e s  load %11.4e N/m%s  %.2e disc-steps/s  left %.0f s\n",
                        sim->step * sim->fluid_every, (double)sim->time, (double)row[COLUMN_LOAD], water,
                        spent > 0 ? (double)(global * (PetscReal)(done * sim->fluid_every) / spent) : 0.0,
                        done > 0 ? (double)(spent / (PetscReal)done * (PetscReal)(sim->steps - sim->step)) : 0.0));
  (void)fflush(stdout);
  sim->last_progress      = now;
  sim->last_progress_step = sim->step;
  PetscFunctionReturn(0);
}

/* With the load as of the last row of the history. */
PetscErrorCode PgProgressBar(PgSimulation sim)
{
  char load[48] = "";

  PetscFunctionBeginUser;
  if (!PgMeterBarDue(&sim->meter, sim->step)) PetscFunctionReturn(0);
  if (sim->setup.load_plate >= 0 || sim->setup.load_wall >= 0)
    (void)snprintf(load, sizeof load, "  load %.4g kN/m", 1e-3 * (double)sim->row[COLUMN_LOAD]);
  PgMeterBar(&sim->meter, sim->step, sim->time, sim->setup.end_time, load);
  PetscFunctionReturn(0);
}

/* ---- the summary ---- */

static PetscErrorCode Times(PgSimulation sim)
{
  PetscInt global;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(sim->particles, NULL, NULL, &global));
  PetscCall(PgMeterTimes(&sim->meter, (sim->step - sim->meter.first) * sim->fluid_every, global, "disc"));
  PetscFunctionReturn(0);
}

static PetscErrorCode Balance(PgSimulation sim)
{
  PetscMPIInt size;
  PetscReal   worst;
  PetscInt    cuts;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(sim->comm, &size));
  if (size == 1) PetscFunctionReturn(0);
  PetscCall(PgParticlesGetBalance(sim->particles, &worst, &cuts));
  PetscCall(PetscPrintf(
      sim->comm, "%d ranks, at most %.3f of the mean number of discs on one; partitioned %" PetscInt_FMT " time%s\n",
      size, (double)worst, cuts, cuts == 1 ? "" : "s"));
  PetscFunctionReturn(0);
}

static PetscErrorCode Solves(PgSimulation sim)
{
  PgPressure       pressure;
  PgPressureMethod method;
  PgPressureWork   work;
  PgSolves         solves;
  PetscInt         preconditioners;
  PetscBool        implicit;
  char             more[64] = "";

  PetscFunctionBeginUser;
  PetscCall(PgPoreGetParts(sim->pore, NULL, &pressure));
  PetscCall(PgPressureGetMethod(pressure, &method));
  PetscCall(PgPressureGetWork(pressure, &work));
  PetscCall(PgPressureGetCounts(pressure, NULL, NULL, &preconditioners));
  implicit = (PetscBool)(method == PG_PRESSURE_IMPLICIT);
  solves   = (PgSolves){.solves = work.solves, .most = work.most, .iterations = work.iterations};
  if (implicit)
    PetscCall(PetscSNPrintf(more, sizeof more, "; %" PetscInt_FMT " preconditioner%s", preconditioners,
                            preconditioners == 1 ? "" : "s"));
  PetscCall(PgMeterSolves(sim->comm, &solves, "pressure solves", implicit ? "iterations" : "sweeps", more));
  PetscFunctionReturn(0);
}

static PetscErrorCode Files(PgSimulation sim)
{
  PgPressure     pressure;
  PgPressureWork work = {0};

  PetscFunctionBeginUser;
  if (sim->output) PetscCall(PgOutputTell(sim->output));
  if (sim->checkpoints)
    PetscCall(PetscPrintf(sim->comm, "checkpoint in %s, of step %" PetscInt_FMT "\n", sim->checkpoint_file,
                          sim->checkpoint_step * sim->fluid_every));
  if (sim->pore) {
    PetscCall(PgPoreGetParts(sim->pore, NULL, &pressure));
    PetscCall(PgPressureGetWork(pressure, &work));
  }
  if (work.dumps)
    PetscCall(
        PetscPrintf(sim->comm, "%" PetscInt_FMT " pressure systems written (option -pressure_dump)\n", work.dumps));
  PetscFunctionReturn(0);
}

PetscErrorCode PgProgressSummary(PgSimulation sim)
{
  PetscFunctionBeginUser;
  PgTerminalEnd();
  if (sim->setup.load_plate >= 0 || sim->setup.load_wall >= 0)
    PetscCall(PetscPrintf(sim->comm, "peak load %.4e N/m at a displacement of %.4e m, load at the end %.4e N/m\n",
                          (double)sim->peak_load, (double)sim->peak_displacement, (double)sim->row[COLUMN_LOAD]));
  PetscCall(Times(sim));
  PetscCall(Balance(sim));
  if (sim->pore) PetscCall(Solves(sim));
  PetscCall(Files(sim));
  PetscFunctionReturn(0);
}
