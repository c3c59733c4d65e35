/* Checkpoints of the continuum, and going on from them. A run that goes on makes the same matrix from the same settings,
   and nothing but the state passes from one step to the next. */
#include "up.h"

PetscErrorCode PgUpRestartOptions(PgUp up, PetscOptionItems *PetscOptionsObject)
{
  PgUpRunSettings *run = &up->run;

  PetscFunctionBeginUser;
  run->checkpoint_every = -1.0;
  PetscCall(PgOptionString(PetscOptionsObject, "-checkpoint",
                           "checkpoint FILE, written at the end too; the one before it is kept as FILE.1",
                           run->checkpoint, sizeof run->checkpoint, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-checkpoint_every",
                         "simulated time between checkpoints; default a tenth of the run", "s", 0.0, 1e15,
                         &run->checkpoint_every, NULL));
  PetscCall(PgOptionString(PetscOptionsObject, "-restart",
                           "go on from a checkpoint: FILE (or FILE.1 if that is damaged), or the latest of a directory "
                           "or pattern",
                           run->restart, sizeof run->restart, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode PgUpCheckPlaces(PgUp up, const char output[])
{
  const PgUpRunSettings *run = &up->run;

  PetscFunctionBeginUser;
  if (!run->checkpoint[0]) PetscFunctionReturn(0);
  if (output[0]) PetscCall(PgCheckpointCheckOutput(up->comm, run->checkpoint, output));
  PetscCall(PgCheckpointCheckPlace(up->comm, run->checkpoint));
  PetscFunctionReturn(0);
}

/* What tells one run from another comes first. */
static PetscErrorCode AddState(PgUp up, char name[128], PgState state)
{
  PgUpRunSettings *run = &up->run;

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(name, up->problem->name, 128));
  PetscCall(PgStateAddText(state, "simulation_case", PG_STATE_MATCH, "option -case", 128, name));
  PetscCall(PgStateAddReals(state, "simulation_dt", PG_STATE_MATCH, "the time step (option -dt) [s]", 1, &run->dt));
  PetscCall(PgStateAddText(state, "output_run", PG_STATE_KEEP, NULL, sizeof run->before.run, run->before.run));
  PetscCall(PgStateAddInts(state, "output_rows", PG_STATE_KEEP, NULL, 1, &run->before.rows));
  PetscCall(PgStateAddInts(state, "output_snapshots", PG_STATE_KEEP, NULL, 1, &run->before.snapshots));
  PetscCall(PgFemAddState(up->fem, state));
  PetscFunctionReturn(0);
}

PetscErrorCode PgUpCheckpoint(PgUp up, PetscInt step)
{
  PgUpRunSettings *run      = &up->run;
  const PetscReal  interval = run->checkpoint_every < 0.0 ? run->end / 10.0 : run->checkpoint_every;
  const PetscInt   every    = PetscMax(1, (PetscInt)PetscMin(interval / run->dt + 0.5, 1e9));
  char             name[128];
  PgState          state;
  PetscErrorCode   err;

  PetscFunctionBeginUser;
  if (!run->checkpoint[0] || (step < run->steps && (interval <= 0.0 || step % every))) PetscFunctionReturn(0);
  PetscCall(PgStagePush(PG_STAGE_OUTPUT));
  if (run->output) {
    PetscCall(PgOutputFlush(run->output));
    PetscCall(PgOutputGetRun(run->output, run->before.run));
    PetscCall(PgOutputGetRowCount(run->output, &run->before.rows));
    PetscCall(PgOutputGetSnapshotCount(run->output, &run->before.snapshots));
  }
  PetscCall(PgStateCreate(&state));
  PetscCall(AddState(up, name, state));
  err = PgCheckpointWriteState(up->comm, state, run->checkpoint);
  PetscCall(PgStateDestroy(&state));
  PetscCall(err);
  PetscCall(PgStagePop());
  PetscFunctionReturn(0);
}

static PetscErrorCode Read(PgUp up)
{
  PgUpRunSettings *run = &up->run;
  PgCheckpoint     checkpoint;
  PgState          state;
  PetscErrorCode   err, closing;
  const char      *file;
  char             name[128];

  PetscFunctionBeginUser;
  PetscCall(PgCheckpointOpen(up->comm, run->restart, &checkpoint));
  PetscCall(PgCheckpointGetFile(checkpoint, &file));
  PetscCall(PetscStrncpy(run->restart, file, sizeof run->restart));
  run->before.from = run->restart;
  PetscCall(PgStateCreate(&state));
  PetscCall(AddState(up, name, state));
  err = PgCheckpointReadState(checkpoint, state);
  PetscCall(PgStateDestroy(&state));
  closing = PgCheckpointClose(&checkpoint); /* the words of the failure come from here */
  if (closing) err = closing;
  PetscFunctionReturn(err);
}

PetscErrorCode PgUpRestart(PgUp up)
{
  PgUpRunSettings *run = &up->run;
  PetscInt         step;
  PetscReal        time, off;

  PetscFunctionBeginUser;
  PetscCall(Read(up));
  PetscCall(PgFemGetTime(up->fem, &step, &time));
  off = PetscAbsReal(time - (PetscReal)step * run->dt);
  PgInputCheck(step >= 0 && run->before.rows >= 0 && run->before.snapshots >= 0 && off < run->dt, up->comm,
               "checkpoint '%s': step %" PetscInt_FMT " does not go with time %g s", run->restart, step, (double)time);
  PgInputCheck(
      step >= run->steps || off < PG_UP_UNEVEN * run->dt * (PetscReal)PetscMax(1, step), up->comm,
      "checkpoint '%s': it is of the end of a run, t = %g s, whose last step was shorter than -dt %g s: a longer "
      "run goes on from the one before it, %s.1",
      run->restart, (double)time, (double)run->dt, run->restart);
  PetscCall(PgFemTakeState(up->fem));
  PetscCall(PetscPrintf(up->comm, "continued from %s, step %" PetscInt_FMT ", t = %.6e s\n", run->restart, step,
                        (double)time));
  PetscFunctionReturn(0);
}
