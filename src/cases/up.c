/* Problems of the saturated continuum: what they share, and their run. */
#include "up.h"
#include <string.h>

static const PgUpProblem *const problems[] = {&PgUpTerzaghi, &PgUpMandel, &PgUpFooting};
enum { PROBLEMS = sizeof problems / sizeof *problems };

static PetscErrorCode ReadOptions(PgUp up)
{
  char title[128];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(title, sizeof title, "case %s: %s", up->problem->name, up->problem->title));
  PetscOptionsBegin(up->comm, "", title, "");
  PetscCall(up->problem->create(up, PetscOptionsObject));
  PetscOptionsEnd();
  {
    const PetscReal low[2] = {0.0, 0.0};
    PetscCall(PgFemSetBox(up->fem, up->problem->cells, low, up->size));
  }
  PetscCall(PgFemSetFromOptions(up->fem));
  PetscFunctionReturn(0);
}

PetscErrorCode PgUpCreateProblem(MPI_Comm comm, const PgUpProblem *problem, PgUp *out)
{
  PgCaseRunTexts texts = {.dt      = "time step; default: of the case",
                          .history = "time between history rows; default every step",
                          .more    = PgUpRestartOptions};
  PgUp           up;

  PetscFunctionBeginUser;
  if (problem->defaults[0]) PetscCall(PgCaseDefaults(problem->defaults));
  PetscCall(PetscNew(&up));
  up->comm    = comm;
  up->problem = problem;
  up->size[0] = problem->size[0];
  up->size[1] = problem->size[1];
  up->load    = problem->load;
  up->width   = problem->width;
  *out        = up;
  PetscCall(PgFemCreate(comm, &up->fem));
  PetscCall(ReadOptions(up));
  texts.context = up;
  PetscCall(PgCaseRunSetFromOptions(comm, &texts, &up->run));
  PetscCall(problem->conditions(up));
  PetscFunctionReturn(0);
}

PetscErrorCode PgUpCreate(MPI_Comm comm, const char name[], PgUp *up)
{
  PetscFunctionBeginUser;
  for (int k = 0; k < PROBLEMS; k++)
    if (strcmp(problems[k]->name, name) == 0) {
      PetscCall(PgUpCreateProblem(comm, problems[k], up));
      PetscFunctionReturn(0);
    }
  SETERRQ(comm, PETSC_ERR_ARG_UNKNOWN_TYPE, "there is no problem %s of the continuum", name);
}

PetscErrorCode PgUpDestroy(PgUp *up)
{
  PetscFunctionBeginUser;
  if (!*up) PetscFunctionReturn(0);
  PetscCall(PgFemDestroy(&(*up)->fem));
  PetscCall(PetscFree(*up));
  PetscFunctionReturn(0);
}

PetscErrorCode PgUpSetUp(PgUp up)
{
  PgFemNodes nodes;
  PetscReal  mine[4] = {PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MAX_REAL}, all[4];

  PetscFunctionBeginUser;
  PetscCall(PgFemSetUp(up->fem));
  PetscCall(PgFemGetNodes(up->fem, &nodes));
  for (PetscInt i = 0; i < nodes.count; i++)
    for (int d = 0; d < 2; d++) {
      mine[d]     = PetscMin(mine[d], nodes.x[2 * i + d]);
      mine[2 + d] = PetscMin(mine[2 + d], -nodes.x[2 * i + d]);
    }
  PetscCallMPI(MPI_Allreduce(mine, all, 4, MPIU_REAL, MPIU_MIN, up->comm));
  for (int d = 0; d < 2; d++) {
    up->low[d]  = all[d];
    up->high[d] = -all[2 + d];
  }
  PetscCall(up->problem->prepare(up));
  PetscFunctionReturn(0);
}

PetscErrorCode PgUpGetFem(PgUp up, PgFem *fem)
{
  PetscFunctionBeginUser;
  *fem = up->fem;
  PetscFunctionReturn(0);
}

PetscErrorCode PgUpGetTimes(PgUp up, PetscReal *dt, PetscReal *end)
{
  PetscFunctionBeginUser;
  *dt  = up->dt;
  *end = up->end;
  PetscFunctionReturn(0);
}

PetscErrorCode PgUpGetSettlement(PgUp up, PetscReal *settlement)
{
  PetscFunctionBeginUser;
  PetscCall(up->problem->settlement(up, settlement));
  PetscFunctionReturn(0);
}

/* The owned node nearest to x; of several the one with the smallest number, on any number of ranks. */
static PetscErrorCode Nearest(PgUp up, const PetscReal x[2], const PgFemNodes *nodes, PetscInt *node, PetscMPIInt *rank)
{
  PetscReal   mine = PETSC_MAX_REAL, all = PETSC_MAX_REAL;
  PetscInt    number[2] = {PETSC_MAX_INT, -1}, least;
  PetscMPIInt me;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(up->comm, &me));
  for (int pass = 0; pass < 2; pass++) {
    for (PetscInt i = 0; i < nodes->count; i++) {
      const PetscReal d = PetscSqr(nodes->x[2 * i] - x[0]) + PetscSqr(nodes->x[2 * i + 1] - x[1]);
      if (!nodes->owned[i]) continue;
      if (pass == 0) mine = PetscMin(mine, d);
      if (pass == 1 && d <= all && nodes->number[i] < number[0]) {
        number[0] = nodes->number[i];
        number[1] = i;
      }
    }
    if (pass == 0) PetscCallMPI(MPI_Allreduce(&mine, &all, 1, MPIU_REAL, MPIU_MIN, up->comm));
  }
  PetscCallMPI(MPI_Allreduce(&number[0], &least, 1, MPIU_INT, MPI_MIN, up->comm));
  *node = number[0] == least ? number[1] : -1;
  {
    const PetscMPIInt candidate = *node >= 0 ? me : -1;
    PetscCallMPI(MPI_Allreduce(&candidate, rank, 1, MPI_INT, MPI_MAX, up->comm));
  }
  PetscFunctionReturn(0);
}

/* Displacement and pressure of the node nearest to x. */
static PetscErrorCode ValuesAt(PgUp up, const PetscReal x[2], PetscReal value[3])
{
  PgFemNodes  nodes;
  PetscInt    node = -1;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCall(PgFemGetNodes(up->fem, &nodes));
  PetscCall(Nearest(up, x, &nodes, &node, &rank));
  if (node >= 0) {
    value[0] = nodes.displacement[2 * node];
    value[1] = nodes.displacement[2 * node + 1];
    value[2] = nodes.pressure[node];
  }
  PetscCallMPI(MPI_Bcast(value, 3, MPIU_REAL, rank, up->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode PgUpSettlementAt(PgUp up, const PetscReal x[2], PetscReal *settlement)
{
  PetscReal value[3];

  PetscFunctionBeginUser;
  PetscCall(ValuesAt(up, x, value));
  *settlement = 0.0 - value[1];
  PetscFunctionReturn(0);
}

PetscErrorCode PgUpGetProbe(PgUp up, PetscReal *pressure)
{
  PetscReal value[3];

  PetscFunctionBeginUser;
  PetscCall(ValuesAt(up, up->probe, value));
  *pressure = value[2];
  PetscFunctionReturn(0);
}

/* ---- the run ---- */

enum { TIME, DISPLACEMENT, PROBE, MIN, MEAN, MAX, ITERATIONS, RESIDUAL, COLUMNS };
static const PgColumn columns[COLUMNS] = {
    {"time", "s", "time"},
    {"displacement", "m", "settlement of the plate or of the loaded surface"},
    {"pressure_probe", "Pa", "pore pressure at the place that the case watches"},
    {"pressure_min", "Pa", "smallest pore pressure of a node"},
    {"pressure_mean", "Pa", "mean pore pressure of the continuum"},
    {"pressure_max", "Pa", "largest pore pressure of a node"},
    {"pressure_iterations", "1", "iterations of the solver for displacement and pressure"},
    {"pressure_residual", "1", "residual of the solve, recomputed, over its right-hand side"},
};

/* The last step is cut to the end of the run. */
static PetscReal StepSize(const PgCaseRun *run, PetscInt step)
{
  const PetscReal left = run->end - (PetscReal)(step - 1) * run->dt;

  return step == run->steps && left < (1.0 - PG_CASE_UNEVEN) * run->dt ? left : run->dt;
}

static void Volume(void *context, const PgFemPoint *point, PetscReal value[])
{
  (void)context;
  value[0] = point->pressure;
  value[1] = 1.0;
}

static PetscErrorCode FillRow(PgUp up, PetscReal row[COLUMNS])
{
  PgFemNodes nodes;
  PgFemStats stats;
  PetscReal  mine[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL}, all[2], mean[2];

  PetscFunctionBeginUser;
  PetscCall(PgFemGetNodes(up->fem, &nodes));
  PetscCall(PgFemGetStats(up->fem, &stats));
  for (PetscInt i = 0; i < nodes.count; i++) {
    mine[0] = PetscMin(mine[0], nodes.pressure[i]);
    mine[1] = PetscMin(mine[1], -nodes.pressure[i]);
  }
  PetscCallMPI(MPI_Allreduce(mine, all, 2, MPIU_REAL, MPIU_MIN, up->comm));
  PetscCall(PgFemIntegrate(up->fem, 2, Volume, NULL, mean));
  PetscCall(PgFemGetTime(up->fem, NULL, &row[TIME]));
  PetscCall(PgUpGetSettlement(up, &row[DISPLACEMENT]));
  PetscCall(PgUpGetProbe(up, &row[PROBE]));
  row[MIN]        = all[0];
  row[MAX]        = 0.0 - all[1];
  row[MEAN]       = mean[0] / mean[1];
  row[ITERATIONS] = (PetscReal)stats.iterations;
  row[RESIDUAL]   = stats.residual;
  PetscFunctionReturn(0);
}

static PetscErrorCode Observe(PgUp up, PetscInt step)
{
  const PgCaseRunDueNow due = PgCaseRunDue(&up->run, step);
  PetscReal             row[COLUMNS];

  PetscFunctionBeginUser;
  if (!due.row && !due.line && !due.snapshot) PetscFunctionReturn(0);
  PetscCall(FillRow(up, row));
  if (due.line)
    PetscCall(PetscPrintf(
        up->comm, "t %.4e s  settlement %.6e m  p probe %.4e  min %.4e  mean %.4e  max %.4e Pa  iterations %d\n",
        (double)row[TIME], (double)row[DISPLACEMENT], (double)row[PROBE], (double)row[MIN], (double)row[MEAN],
        (double)row[MAX], (int)row[ITERATIONS]));
  PetscCall(PgStagePush(PG_STAGE_OUTPUT));
  if (due.row) PetscCall(PgOutputHistory(up->run.output, row));
  if (due.snapshot) PetscCall(PgFemSnapshot(up->fem, up->run.output));
  PetscCall(PgStagePop());
  PetscFunctionReturn(0);
}

static PetscErrorCode TimeLoop(PgUp up)
{
  PgFemStats stats;
  PetscInt   begun;
  PetscBool  on;

  PetscFunctionBeginUser;
  PetscCall(PgFemGetTime(up->fem, &begun, NULL));
  PetscCall(PgCaseRunStart(&up->run, begun));
  if (!up->again.restart[0]) PetscCall(Observe(up, 0));
  on = (PetscBool)(begun < up->run.steps);
  for (PetscInt step = begun + 1; on; step++) {
    PetscCall(PgFemStep(up->fem, StepSize(&up->run, step)));
    PetscCall(PgFemGetStats(up->fem, &stats));
    PgSolvesAdd(&up->solves, stats.iterations);
    PetscCall(Observe(up, step));
    PetscCall(PgCaseRunGoesOn(&up->run, step, &on));
    PetscCall(PgUpCheckpoint(up, step));
  }
  if (up->run.output) PetscCall(PgOutputFinish(up->run.output));
  PetscFunctionReturn(0);
}

static PetscErrorCode Summary(PgUp up)
{
  const PgUpRestartSettings *again = &up->again;
  PgFemNodes                 nodes;
  PetscInt                   count = 0, step;
  PetscReal                  time;

  PetscFunctionBeginUser;
  PetscCall(PgFemGetNodes(up->fem, &nodes));
  for (PetscInt i = 0; i < nodes.count; i++) count += nodes.owned[i] ? 1 : 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPIU_INT, MPI_SUM, up->comm));
  PetscCall(PgCaseRunSummary(&up->run, up->solves.solves, count, "node", &up->solves,
                             "solves for displacement and pressure"));
  if (again->written)
    PetscCall(PetscPrintf(up->comm, "checkpoint in %s, of step %" PetscInt_FMT "\n", again->checkpoint, again->held));
  PetscCall(PgFemGetTime(up->fem, &step, &time));
  PetscCall(PgCaseRunTell(&up->run, step, time, again->written ? again->checkpoint : again->restart, again->held));
  PetscFunctionReturn(0);
}

/* Everything that can be refused, before anything is written. */
static PetscErrorCode Begin(PgUp up, const char output[])
{
  PetscInt begun;

  PetscFunctionBeginUser;
  PetscCall(PgUpSetUp(up));
  if (up->run.dt <= 0.0) up->run.dt = up->dt;
  if (up->run.end <= 0.0) up->run.end = up->end;
  PetscCall(PgCaseRunChooseSteps(&up->run, 0));
  if (up->again.restart[0]) PetscCall(PgUpRestart(up));
  PetscCall(PgFemGetTime(up->fem, &begun, NULL));
  PetscCall(PgFemSetUpSolver(up->fem, StepSize(&up->run, PetscMin(begun + 1, up->run.steps))));
  PetscCall(PgOptionsCheckUnused(up->comm, PgFemProbeOptions, up->fem));
  PetscCall(PgUpCheckPlaces(up, output));
  if (output[0])
    PetscCall(PgFemContinueOutput(up->fem, output, COLUMNS, columns, up->again.restart[0] ? &up->again.before : NULL,
                                  &up->run.output));
  PetscFunctionReturn(0);
}

PetscErrorCode PgUpRun(PgUp up, const char output[])
{
  PetscErrorCode err;

  PetscFunctionBeginUser;
  PetscCall(PgStagePush(PG_STAGE_SETUP));
  PetscCall(Begin(up, output));
  PetscCall(PgStagePop());
  PetscCall(PgFemView(up->fem, PETSC_VIEWER_STDOUT_(up->comm)));
  err = TimeLoop(up);
  PgEndingStop();
  if (!err && output[0]) PetscCall(PetscPrintf(up->comm, "wrote %s\n", output));
  if (!err) PetscCall(Summary(up));
  PetscCall(PgOutputDestroy(&up->run.output));
  PetscFunctionReturn(err);
}

/* ---- as cases ---- */

static PetscErrorCode Destroy(void **context)
{
  PetscFunctionBeginUser;
  PetscCall(PgUpDestroy((PgUp *)context));
  PetscFunctionReturn(0);
}

static PetscErrorCode RunCase(MPI_Comm comm, void *context, const char output[])
{
  PetscFunctionBeginUser;
  (void)comm;
  PetscCall(PgUpRun((PgUp)context, output));
  PetscFunctionReturn(0);
}

#define PG_UP_CREATE(problem)                                                                                          \
  static PetscErrorCode Create_##problem(MPI_Comm comm, void **context)                                                \
  {                                                                                                                    \
    PetscFunctionBeginUser;                                                                                            \
    PetscCall(PgUpCreateProblem(comm, &problem, (PgUp *)context));                                                     \
    PetscFunctionReturn(0);                                                                                            \
  }
PG_UP_CREATE(PgUpTerzaghi)
PG_UP_CREATE(PgUpMandel)
PG_UP_CREATE(PgUpFooting)

const PgCaseInfo PgCaseUpTerzaghi = {.name    = "up_terzaghi",
                                     .summary = "continuum: consolidation of a column",
                                     .create  = Create_PgUpTerzaghi,
                                     .destroy = Destroy,
                                     .run     = RunCase};
const PgCaseInfo PgCaseUpMandel   = {.name    = "up_mandel",
                                     .summary = "continuum: a slab pressed between plates",
                                     .create  = Create_PgUpMandel,
                                     .destroy = Destroy,
                                     .run     = RunCase};
const PgCaseInfo PgCaseUpFooting  = {.name    = "up_footing",
                                     .summary = "continuum: a strip footing on ground that cannot drain",
                                     .create  = Create_PgUpFooting,
                                     .destroy = Destroy,
                                     .run     = RunCase};
