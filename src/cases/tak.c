/* The examples of Tak, Park & Park (2013): what they share. */
#include "tak.h"

PetscErrorCode PgTakCreate(MPI_Comm comm, PgTak *tak)
{
  PetscFunctionBeginUser;
  tak->comm = comm;
  PetscCall(PgWcsphCreate(comm, &tak->wcsph));
  PetscCall(PgBodiesCreate(comm, &tak->bodies));
  PetscFunctionReturn(0);
}

PetscErrorCode PgTakDestroy(PgTak *tak)
{
  PetscFunctionBeginUser;
  PetscCall(PgOutputDestroy(&tak->output));
  PetscCall(PgWcsphDestroy(&tak->wcsph));
  PetscCall(PgBodiesDestroy(&tak->bodies));
  PetscFunctionReturn(0);
}

PetscErrorCode PgTakRunOptions(PgTak *tak, PetscReal end)
{
  PetscFunctionBeginUser;
  tak->end   = end;
  tak->every = tak->history = -1.0;
  PetscOptionsBegin(tak->comm, "", "run: what is computed, time step and end", "");
  PetscCall(PgOptionReal(PetscOptionsObject, "-dt", "time step; default: of the case", "s", PG_POSITIVE, 1e12, &tak->dt,
                         NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-end_time", "end of the run; default: of the case", "s", PG_POSITIVE,
                         1e15, &tak->end, NULL));
  PetscOptionsEnd();
  PetscOptionsBegin(tak->comm, "", "output: results, checkpoints and restart", "");
  PetscCall(PgOptionReal(PetscOptionsObject, "-output_every", "time between snapshots; default a tenth of the run", "s",
                         0.0, 1e15, &tak->every, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-history_every",
                         "time between history rows; default a thousandth of the run", "s", 0.0, 1e15, &tak->history,
                         NULL));
  PetscCall(PgMeterSetFromOptions(tak->comm, PetscOptionsObject, &tak->meter, NULL));
  PetscOptionsEnd();
  PetscCall(PgWcsphSetSpacing(tak->wcsph, tak->dx));
  PetscCall(PgWcsphSetFromOptions(tak->wcsph));
  PetscCall(PgBodiesSetFromOptions(tak->bodies));
  PetscFunctionReturn(0);
}

PetscErrorCode PgTakAddBlock(PgTak *tak, PgWcsphKind kind, PetscInt body, const PetscReal low[2], PetscInt columns,
                             PetscInt rows)
{
  PgWcsphParticle *p;
  PetscInt         count = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(columns * rows, &p));
  for (PetscInt j = 0; j < rows; j++)
    for (PetscInt i = 0; i < columns; i++) {
      const PetscReal x[2] = {low[0] + ((PetscReal)i + 0.5) * tak->dx, low[1] + ((PetscReal)j + 0.5) * tak->dx};
      PetscInt        in   = -1;

      if (kind == PG_WCSPH_FLUID) PetscCall(PgBodiesFind(tak->bodies, x, &in));
      if (in >= 0) continue;
      p[count].kind  = kind;
      p[count].body  = body;
      p[count].index = count;
      p[count].x[0]  = x[0];
      p[count].x[1]  = x[1];
      count++;
    }
  PetscCall(PgWcsphAddParticles(tak->wcsph, count, p));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

PetscErrorCode PgTakChooseSteps(PgTak *tak)
{
  PetscReal bound;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetTimeStep(tak->wcsph, &bound));
  if (tak->dt <= 0.0) tak->dt = bound;
  PgInputCheck(tak->dt <= bound * (1.0 + 1e-9), tak->comm,
               "option -dt %g s: particles of %g m with this viscosity and speed of sound bear %g s at most",
               (double)tak->dt, (double)tak->dx, (double)bound);
  PgInputCheck(tak->end / tak->dt < 1e9, tak->comm, "%g steps to t = %g s with -dt %g s are too many",
               (double)(tak->end / tak->dt), (double)tak->end, (double)tak->dt);
  tak->steps = PetscMax(1, (PetscInt)PetscCeilReal(tak->end / tak->dt - 1e-9));
  if (tak->every < 0.0) tak->every = tak->dt * (PetscReal)PetscMax(1, tak->steps / 10);
  if (tak->history < 0.0) tak->history = tak->dt * (PetscReal)PetscMax(1, tak->steps / 1000);
  PetscFunctionReturn(0);
}

PetscErrorCode PgTakStart(PgTak *tak, const char output[], PetscInt columns, const PgColumn column[],
                          PetscErrorCode (*probe)(void *), void *context)
{
  PgParticles particles;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphCheckOptions(tak->wcsph, probe, context));
  PetscCall(PgWcsphGetParticles(tak->wcsph, &particles));
  if (output[0]) PetscCall(PgOutputCreate(particles, output, columns, column, &tak->output));
  PetscCall(PgWcsphView(tak->wcsph, PETSC_VIEWER_STDOUT_(tak->comm)));
  PetscCall(PgBodiesView(tak->bodies, PETSC_VIEWER_STDOUT_(tak->comm)));
  PetscCall(PgMeterStart(&tak->meter, tak->comm, 0, tak->steps));
  PetscFunctionReturn(0);
}

PetscErrorCode PgTakStep(PgTak *tak)
{
  PetscFunctionBeginUser;
  PetscCall(PgBodiesKickDrift(tak->bodies, tak->dt));
  PetscCall(PgWcsphKick(tak->wcsph, 0.5 * tak->dt));
  PetscCall(PgWcsphDrift(tak->wcsph, tak->dt));
  PetscCall(PgWcsphForces(tak->wcsph));
  PetscCall(PgBodiesCouple(tak->bodies, tak->wcsph));
  PetscCall(PgBodiesKick(tak->bodies, tak->dt));
  PetscCall(PgWcsphKick(tak->wcsph, 0.5 * tak->dt));
  tak->step++;
  PetscFunctionReturn(0);
}

PetscErrorCode PgTakDue(const PgTak *tak, PetscBool *row, PetscBool *line, PetscBool *snapshot)
{
  const PetscBool last    = (PetscBool)(tak->step == tak->steps);
  const PetscInt  every   = PetscMax(1, (PetscInt)(tak->every / tak->dt + 0.5));
  const PetscInt  history = PetscMax(1, (PetscInt)(tak->history / tak->dt + 0.5));

  PetscFunctionBeginUser;
  *row      = (PetscBool)(tak->output && (last || tak->step % history == 0));
  *line     = (PetscBool)(last ||
                      (tak->meter.progress == PG_PROGRESS_LINES && tak->step % PetscMax(1, tak->steps / 20) == 0));
  *snapshot = (PetscBool)(tak->output && (last || tak->step % every == 0));
  PetscFunctionReturn(0);
}

PetscErrorCode PgTakWrite(PgTak *tak, PetscBool row, PetscBool snapshot, PetscReal time, const PetscReal values[])
{
  PetscFunctionBeginUser;
  PetscCall(PgStagePush(PG_STAGE_OUTPUT));
  if (row) PetscCall(PgOutputHistory(tak->output, values));
  if (snapshot) PetscCall(PgOutputSnapshot(tak->output, time, 0, NULL));
  PetscCall(PgStagePop());
  PetscFunctionReturn(0);
}

void PgTakBar(PgTak *tak)
{
  if (PgMeterBarDue(&tak->meter, tak->step))
    PgMeterBar(&tak->meter, tak->step, (PetscReal)tak->step * tak->dt, tak->end, "");
}

PetscErrorCode PgTakSummary(PgTak *tak, const PgSolves *solves)
{
  PgParticles particles;
  PetscInt    count;

  PetscFunctionBeginUser;
  PgTerminalEnd();
  PetscCall(PgWcsphGetParticles(tak->wcsph, &particles));
  PetscCall(PgParticlesGetSizes(particles, NULL, NULL, &count));
  PetscCall(PgMeterTimes(&tak->meter, tak->steps, count, "particle"));
  if (solves) PetscCall(PgMeterSolves(tak->comm, solves, "solves of the zones", "iterations", ""));
  if (tak->output) PetscCall(PgOutputTell(tak->output));
  PetscFunctionReturn(0);
}
