/* Checkpoints of the continuum, and going on from them. A run that goes on makes the same matrix from the same settings,
   and nothing but the state passes from one step to the next. */
#include "up.h"

PetscErrorCode PgUpRestartOptions(void *context, PetscOptionItems *PetscOptionsObject)
{
  PgUpRestartSettings *again = &((PgUp)context)->again;

  PetscFunctionBeginUser;
  again->every = -1.0;
  again->held  = -1;
  PetscCall(PgOptionString(PetscOptionsObject, "-checkpoint",
                           "checkpoint FILE, written at the end too; the one before it is kept as FILE.1",
                           again->checkpoint, sizeof again->checkpoint, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-checkpoint_every",
                         "simulated time between checkpoints; default a tenth of the run", "s", 0.0, 1e15,
                         &again->every, NULL));
  PetscCall(PgOptionString(PetscOptionsObject, "-restart",
                           "go on from a checkpoint: FILE (or FILE.1 if that is damaged), or the latest of a directory "
                           "or pattern",
                           again->restart, sizeof again->restart, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode PgUpCheckPlaces(PgUp up, const char output[])
{
  const PgUpRestartSettings *again = &up->again;

  PetscFunctionBeginUser;
  if (!again->checkpoint[0]) PetscFunctionReturn(0);
  if (output[0]) PetscCall(PgCheckpointCheckOutput(up->comm, again->checkpoint, output));
  PetscCall(PgCheckpointCheckPlace(up->comm, again->checkpoint));
  PetscFunctionReturn(0);
}

/* What tells one run from another comes first. */
static PetscErrorCode AddState(PgUp up, char name[128], PgState state)
{
  PgUpRestartSettings *again = &up->again;

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(name, up->problem->name, 128));
  PetscCall(PgStateAddText(state, "simulation_case", PG_STATE_MATCH, "option -case", 128, name));
  PetscCall(PgStateAddReals(state, "simulation_dt", PG_STATE_MATCH, "the time step (option -dt) [s]", 1, &up->run.dt));
  PetscCall(PgStateAddText(state, "output_run", PG_STATE_KEEP, NULL, sizeof again->before.run, again->before.run));
  PetscCall(PgStateAddInts(state, "output_rows", PG_STATE_KEEP, NULL, 1, &again->before.rows));
  PetscCall(PgStateAddInts(state, "output_snapshots", PG_STATE_KEEP, NULL, 1, &again->before.snapshots));
  PetscCall(PgFemAddState(up->fem, state));
  PetscFunctionReturn(0);
}

PetscErrorCode PgUpCheckpoint(PgUp up, PetscInt step)
{
  PgUpRestartSettings *again    = &up->again;
  const PetscReal      interval = again->every < 0.0 ? up->run.end / 10.0 : again->every;
  const PetscInt       every    = PetscMax(1, (PetscInt)PetscMin(interval / up->run.dt + 0.5, 1e9));
  const PetscLogDouble start    = MPI_Wtime();
  const PetscBool      due      = (PetscBool)(step == up->run.steps || (interval > 0.0 && step % every == 0));
  char                 name[128];
  PgState              state;
  PetscErrorCode       err;

  PetscFunctionBeginUser;
  if (!again->checkpoint[0] || !(due || up->run.ending & PG_ENDING_SAVES)) PetscFunctionReturn(0);
  PetscCall(PgStagePush(PG_STAGE_OUTPUT));
  if (up->run.output) {
    PetscCall(PgOutputFlush(up->run.output));
    PetscCall(PgOutputGetRun(up->run.output, again->before.run));
    PetscCall(PgOutputGetRowCount(up->run.output, &again->before.rows));
    PetscCall(PgOutputGetSnapshotCount(up->run.output, &again->before.snapshots));
  }
  PetscCall(PgStateCreate(&state));
  PetscCall(AddState(up, name, state));
  err = PgCheckpointWriteState(up->comm, state, again->checkpoint);
  PetscCall(PgStateDestroy(&state));
  PetscCall(err);
  PetscCall(PgStagePop());
  again->held        = step;
  again->written     = PETSC_TRUE;
  up->run.watch.cost = MPI_Wtime() - start;
  PetscFunctionReturn(0);
}

static PetscErrorCode Read(PgUp up)
{
  PgUpRestartSettings *again = &up->again;
  PgCheckpoint         checkpoint;
  PgState              state;
  PetscErrorCode       err, closing;
  const char          *file;
  char                 name[128];

  PetscFunctionBeginUser;
  PetscCall(PgCheckpointOpen(up->comm, again->restart, &checkpoint));
  PetscCall(PgCheckpointGetFile(checkpoint, &file));
  PetscCall(PetscStrncpy(again->restart, file, sizeof again->restart));
  again->before.from = again->restart;
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
  PgUpRestartSettings *again = &up->again;
  PetscInt             step;
  PetscReal            time, off;

  PetscFunctionBeginUser;
  PetscCall(Read(up));
  PetscCall(PgFemGetTime(up->fem, &step, &time));
  off = PetscAbsReal(time - (PetscReal)step * up->run.dt);
  PgInputCheck(step >= 0 && again->before.rows >= 0 && again->before.snapshots >= 0 && off < up->run.dt, up->comm,
               "checkpoint '%s': step %" PetscInt_FMT " does not go with time %g s", again->restart, step,
               (double)time);
  PgInputCheck(
      step >= up->run.steps || off < PG_CASE_UNEVEN * up->run.dt * (PetscReal)PetscMax(1, step), up->comm,
      "checkpoint '%s': it is of the end of a run, t = %g s, whose last step was shorter than -dt %g s: a longer "
      "run goes on from the one before it, %s.1",
      again->restart, (double)time, (double)up->run.dt, again->restart);
  PetscCall(PgFemTakeState(up->fem));
  again->held = step;
  PetscCall(PetscPrintf(up->comm, "continued from %s, step %" PetscInt_FMT ", t = %.6e s\n", again->restart, step,
                        (double)time));
  PetscFunctionReturn(0);
}
