/* What all cases that run themselves do alike. */
#include "run.h"

PetscErrorCode PgCaseRunSetFromOptions(MPI_Comm comm, const PgCaseRunTexts *texts, PgCaseRun *run)
{
  PetscFunctionBeginUser;
  run->comm  = comm;
  run->every = run->history = -1.0;
  run->watch.created        = MPI_Wtime();
  run->watch.most           = 200; /* steps are of one kind: their time does not grow by much from one to the next */
  PetscOptionsBegin(comm, "", "run: what is computed, time step and end", "");
  PetscCall(PgOptionReal(PetscOptionsObject, "-dt", texts->dt, "s", PG_POSITIVE, 1e12, &run->dt, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-end_time", "end of the run; default: of the case", "s", PG_POSITIVE,
                         1e15, &run->end, NULL));
  PetscOptionsEnd();
  PetscOptionsBegin(comm, "", "output: results, checkpoints and restart", "");
  PetscCall(PgOptionReal(PetscOptionsObject, "-output_every", "time between snapshots; default a tenth of the run", "s",
                         0.0, 1e15, &run->every, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-history_every", texts->history, "s", 0.0, 1e15, &run->history, NULL));
  PetscCall(PgMeterSetFromOptions(comm, PetscOptionsObject, &run->meter, NULL));
  if (texts->more) PetscCall((*texts->more)(texts->context, PetscOptionsObject));
  PetscCall(PgEndingSetFromOptions(PetscOptionsObject, &run->watch));
  PetscOptionsEnd();
  PetscFunctionReturn(0);
}

PetscErrorCode PgCaseRunChooseSteps(PgCaseRun *run, PetscInt rows)
{
  PetscFunctionBeginUser;
  PgInputCheck(run->end / run->dt < 1e8, run->comm, "%g steps to t = %g s with a time step of %g s are too many",
               (double)(run->end / run->dt), (double)run->end, (double)run->dt);
  run->steps = PetscMax(1, (PetscInt)PetscCeilReal(run->end / run->dt - PG_CASE_UNEVEN));
  if (run->every < 0.0) run->every = run->dt * (PetscReal)PetscMax(1, run->steps / 10);
  if (run->history < 0.0) run->history = run->dt * (PetscReal)(rows ? PetscMax(1, run->steps / rows) : 1);
  PetscFunctionReturn(0);
}

/* Steps in an interval. */
static PetscInt Interval(const PgCaseRun *run, PetscReal time) { return PetscMax(1, (PetscInt)(time / run->dt + 0.5)); }

PgCaseRunDueNow PgCaseRunDue(const PgCaseRun *run, PetscInt step)
{
  const PetscBool last  = (PetscBool)(step == run->steps);
  const PetscBool lines = (PetscBool)(run->meter.progress == PG_PROGRESS_LINES);

  return (PgCaseRunDueNow){.row      = (PetscBool)(run->output && (last || step % Interval(run, run->history) == 0)),
                           .line     = (PetscBool)(last || (lines && step % PetscMax(1, run->steps / 20) == 0)),
                           .snapshot = (PetscBool)(run->output && (last || step % Interval(run, run->every) == 0))};
}

PetscErrorCode PgCaseRunStart(PgCaseRun *run, PetscInt begun)
{
  PetscFunctionBeginUser;
  PetscCall(PgMeterStart(&run->meter, run->comm, begun, run->steps));
  PetscCall(PgEndingStart(&run->watch, run->comm, begun));
  PetscFunctionReturn(0);
}

PetscErrorCode PgCaseRunGoesOn(PgCaseRun *run, PetscInt step, PetscBool *on)
{
  PetscFunctionBeginUser;
  if (PgMeterBarDue(&run->meter, step))
    PgMeterBar(&run->meter, step, PetscMin((PetscReal)step * run->dt, run->end), run->end, "");
  PetscCall(PgEndingLook(&run->watch, step, &run->ending));
  if (step >= run->steps) run->ending = PG_ENDING_NONE;
  *on = (PetscBool)(step < run->steps && !(run->ending & PG_ENDING_ENDS));
  PetscFunctionReturn(0);
}

PetscErrorCode PgCaseRunTell(const PgCaseRun *run, PetscInt step, PetscReal time, const char file[], PetscInt held)
{
  PetscFunctionBeginUser;
  if (run->ending & PG_ENDING_ENDS) PetscCall(PgEndingTell(run->comm, run->ending, step, time, file, held));
  PetscFunctionReturn(0);
}

PetscErrorCode PgCaseRunWrite(PgCaseRun *run, PgCaseRunDueNow due, PetscReal time, const PetscReal row[])
{
  PetscFunctionBeginUser;
  if (!due.row && !due.snapshot) PetscFunctionReturn(0);
  PetscCall(PgStagePush(PG_STAGE_OUTPUT));
  if (due.row) PetscCall(PgOutputHistory(run->output, row));
  if (due.snapshot) PetscCall(PgOutputSnapshot(run->output, time, 0, NULL));
  PetscCall(PgStagePop());
  PetscFunctionReturn(0);
}

PetscErrorCode PgCaseRunSummary(const PgCaseRun *run, PetscInt steps, PetscInt count, const char one[],
                                const PgSolves *solves, const char solved[])
{
  PetscFunctionBeginUser;
  PgTerminalEnd();
  PetscCall(PgMeterTimes(&run->meter, steps, count, one));
  if (solves) PetscCall(PgMeterSolves(run->comm, solves, solved, "iterations", ""));
  if (run->output) PetscCall(PgOutputTell(run->output));
  PetscFunctionReturn(0);
}
