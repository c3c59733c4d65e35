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
  PetscCall(PgOutputDestroy(&tak->run.output));
  PetscCall(PgWcsphDestroy(&tak->wcsph));
  PetscCall(PgBodiesDestroy(&tak->bodies));
  PetscFunctionReturn(0);
}

PetscErrorCode PgTakRunOptions(PgTak *tak, PetscReal end)
{
  const PgCaseRunTexts texts = {.dt      = "time step; default: of the case",
                                .history = "time between history rows; default a thousandth of the run"};
  PetscReal            gravity[2];

  PetscFunctionBeginUser;
  tak->run.end = end;
  PetscCall(PgCaseRunSetFromOptions(tak->comm, &texts, &tak->run));
  PetscCall(PgWcsphSetSpacing(tak->wcsph, tak->dx));
  PetscCall(PgWcsphSetFromOptions(tak->wcsph));
  PetscCall(PgBodiesSetFromOptions(tak->bodies));
  PetscCall(PgWcsphGetLiquid(tak->wcsph, NULL, NULL, NULL, gravity));
  PgInputCheck(gravity[0] == 0.0 && gravity[1] == 0.0, tak->comm,
               "option -wcsph_gravity: these examples have none, and their elements and zones would not feel it");
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
  if (tak->run.dt <= 0.0) tak->run.dt = bound;
  PgInputCheck(
      tak->run.dt <= bound * (1.0 + 1e-9), tak->comm,
      "option -dt %g s: particles of %g m with this viscosity, speed of sound and -wcsph_contact bear %g s at most",
      (double)tak->run.dt, (double)tak->dx, (double)bound);
  PetscCall(PgCaseRunChooseSteps(&tak->run, 1000));
  PetscFunctionReturn(0);
}

PetscErrorCode PgTakStart(PgTak *tak, const char output[], PetscInt columns, const PgColumn column[],
                          const PgOptionRules *rules, PetscErrorCode (*probe)(void *), void *context)
{
  PgParticles particles;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphCheckOptions(tak->wcsph, rules->count, rules->rule, probe, context));
  PetscCall(PgWcsphGetParticles(tak->wcsph, &particles));
  if (output[0]) PetscCall(PgOutputCreate(particles, output, columns, column, &tak->run.output));
  PetscCall(PgWcsphView(tak->wcsph, PETSC_VIEWER_STDOUT_(tak->comm)));
  PetscCall(PgBodiesView(tak->bodies, PETSC_VIEWER_STDOUT_(tak->comm)));
  PetscCall(PgCaseRunStart(&tak->run, 0));
  PetscFunctionReturn(0);
}

PetscErrorCode PgTakStep(PgTak *tak)
{
  PetscErrorCode err;

  PetscFunctionBeginUser;
  PgSetNow(tak->step + 1, (PetscReal)(tak->step + 1) * tak->run.dt);
  err = PgBodiesKickDrift(tak->bodies, tak->run.dt);
  PgSetNow(-1, 0.0);
  PetscCall(err);
  PetscCall(PgWcsphKick(tak->wcsph, 0.5 * tak->run.dt));
  PetscCall(PgWcsphDrift(tak->wcsph, tak->run.dt));
  PetscCall(PgWcsphForces(tak->wcsph));
  PetscCall(PgBodiesCouple(tak->bodies, tak->wcsph));
  PgSetNow(tak->step + 1, (PetscReal)(tak->step + 1) * tak->run.dt);
  err = PgBodiesKick(tak->bodies, tak->run.dt);
  PgSetNow(-1, 0.0);
  PetscCall(err);
  PetscCall(PgWcsphKick(tak->wcsph, 0.5 * tak->run.dt));
  tak->step++;
  PetscFunctionReturn(0);
}

PetscErrorCode PgTakSummary(PgTak *tak, const PgSolves *solves)
{
  PgParticles particles;
  PetscInt    count;
  PetscReal   time;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetParticles(tak->wcsph, &particles));
  PetscCall(PgParticlesGetSizes(particles, NULL, NULL, &count));
  PetscCall(PgWcsphGetTime(tak->wcsph, NULL, &time));
  PetscCall(PgCaseRunSummary(&tak->run, tak->step, count, "particle", solves, "solves of the zones"));
  PetscCall(PgCaseRunTell(&tak->run, tak->step, time, NULL, -1));
  PetscFunctionReturn(0);
}
