/* Problems of the weakly compressible liquid: what they share, and their run. */
#include "liquid.h"
#include <string.h>

static const PgLiquidProblem *const problems[] = {&PgLiquidPoiseuille, &PgLiquidCouette, &PgLiquidHydrostatic};
enum { PROBLEMS = sizeof problems / sizeof *problems };

static PetscErrorCode ReadOptions(PgLiquid l)
{
  char title[128];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(title, sizeof title, "case %s: %s", l->problem->name, l->problem->title));
  PetscOptionsBegin(l->comm, "", title, "");
  PetscCall(PgOptionInt(PetscOptionsObject, "-wcsph_cells", "particles of the liquid from bottom to top", 4, 100000,
                        &l->cells, NULL));
  PetscCall(PgOptionInt(PetscOptionsObject, "-wcsph_columns", "particles of the liquid along x", 4, 1000000,
                        &l->columns, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-wcsph_jitter",
                         "largest displacement of the particles of the liquid from their lattice, over its spacing",
                         "1", 0.0, 0.3, &l->jitter, NULL));
  PetscCall(PgOptionInt(PetscOptionsObject, "-wcsph_seed", "of these displacements", 0, PETSC_MAX_INT, &l->seed, NULL));
  PetscCall(l->problem->create(l, PetscOptionsObject));
  PetscOptionsEnd();
  PetscFunctionReturn(0);
}

PetscErrorCode PgLiquidCreateProblem(MPI_Comm comm, const PgLiquidProblem *problem, PgLiquid *out)
{
  const PgCaseRunTexts texts = {.dt      = "time step; default: the largest that is stable",
                                .history = "time between history rows; default a hundredth of the run"};
  PgLiquid             l;

  PetscFunctionBeginUser;
  PetscCall(PgCaseDefaults(problem->defaults));
  PetscCall(PetscNew(&l));
  l->comm    = comm;
  l->problem = problem;
  l->height  = problem->height;
  l->speed   = problem->speed;
  l->cells   = 20;
  l->columns = problem->columns;
  *out       = l;
  PetscCall(PgWcsphCreate(comm, &l->wcsph));
  PetscCall(ReadOptions(l));
  PetscCall(PgWcsphSetFromOptions(l->wcsph));
  PetscCall(PgCaseRunSetFromOptions(comm, &texts, &l->run));
  PetscFunctionReturn(0);
}

PetscErrorCode PgLiquidCreate(MPI_Comm comm, const char name[], PgLiquid *l)
{
  PetscFunctionBeginUser;
  for (int k = 0; k < PROBLEMS; k++)
    if (strcmp(problems[k]->name, name) == 0) {
      PetscCall(PgLiquidCreateProblem(comm, problems[k], l));
      PetscFunctionReturn(0);
    }
  SETERRQ(comm, PETSC_ERR_ARG_UNKNOWN_TYPE, "there is no problem %s of the liquid", name);
}

PetscErrorCode PgLiquidDestroy(PgLiquid *l)
{
  PetscFunctionBeginUser;
  if (!*l) PetscFunctionReturn(0);
  PetscCall(PgOutputDestroy(&(*l)->run.output));
  PetscCall(PgWcsphDestroy(&(*l)->wcsph));
  PetscCall(PetscFree(*l));
  PetscFunctionReturn(0);
}

PetscErrorCode PgLiquidGetWcsph(PgLiquid l, PgWcsph *wcsph)
{
  PetscFunctionBeginUser;
  *wcsph = l->wcsph;
  PetscFunctionReturn(0);
}

PetscErrorCode PgLiquidGetTimes(PgLiquid l, PetscReal *dt, PetscReal *end)
{
  PetscFunctionBeginUser;
  *dt  = l->run.dt;
  *end = l->run.end;
  PetscFunctionReturn(0);
}

/* ---- particles ---- */

PetscErrorCode PgLiquidAddBlock(PgLiquid l, const PgLiquidBlock *block)
{
  const PetscReal  jitter = block->kind == PG_WCSPH_FLUID ? l->jitter * l->dx : 0.0;
  PgWcsphParticle *row;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(block->columns, &row));
  for (PetscInt j = 0; j < block->rows; j++) {
    for (PetscInt i = 0; i < block->columns; i++) {
      const PetscInt place[2] = {i, j};
      row[i].kind             = block->kind;
      row[i].body             = block->body;
      row[i].index            = j * block->columns + i;
      for (int d = 0; d < 2; d++) {
        row[i].x[d] = block->low[d] + l->dx * ((PetscReal)place[d] + 0.5) +
                      jitter * PgNoise(row[i].index, 2 * l->seed + d);
        row[i].v[d] = block->velocity[d];
      }
      row[i].pressure = block->pressure ? block->pressure(l, row[i].x) : 0.0;
    }
    PetscCall(PgWcsphAddParticles(l->wcsph, block->columns, row));
  }
  PetscCall(PetscFree(row));
  PetscFunctionReturn(0);
}

PetscErrorCode PgLiquidAddChannel(PgLiquid l, PetscReal speed)
{
  PgLiquidBlock block  = {.kind = PG_WCSPH_FLUID, .columns = l->columns, .rows = l->cells};
  PetscInt      layers = 0;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphSetPeriodicX(l->wcsph, 0.0, l->dx * (PetscReal)l->columns));
  PetscCall(PgLiquidWallLayers(l, &layers));
  PetscCall(PgLiquidAddBlock(l, &block));
  block.kind   = PG_WCSPH_WALL;
  block.rows   = layers;
  block.low[1] = -l->dx * (PetscReal)layers;
  PetscCall(PgLiquidAddBlock(l, &block));
  block.body        = 1;
  block.low[1]      = l->height;
  block.velocity[0] = speed;
  PetscCall(PgLiquidAddBlock(l, &block));
  PetscFunctionReturn(0);
}

PetscErrorCode PgLiquidWallLayers(PgLiquid l, PetscInt *layers)
{
  PetscReal reach;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetReach(l->wcsph, &reach));
  *layers = (PetscInt)PetscCeilReal(reach / l->dx - 1e-9);
  PetscFunctionReturn(0);
}

PetscReal PgLiquidSeries(PgLiquid l, PetscReal t, PetscReal y, int stride, int power, PetscBool alternate)
{
  const PetscReal decay = PETSC_PI * PETSC_PI * l->mu / l->rho_0 * t / PetscSqr(l->height);
  PetscReal       sum = 0.0, sign = 1.0;

  for (int k = 1; k < 2000; k += stride) {
    const PetscReal size = PetscExpReal(-decay * k * k);
    sum += sign * size * PetscSinReal(k * PETSC_PI * y / l->height) / PetscPowReal((PetscReal)k, (PetscReal)power);
    if (alternate) sign = -sign;
    if (size < 1e-18) break;
  }
  return sum;
}

PetscErrorCode PgLiquidSetUp(PgLiquid l)
{
  PetscReal largest;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetLiquid(l->wcsph, &l->rho_0, &l->mu, &l->c_0, l->g));
  l->dx = l->height / (PetscReal)l->cells;
  PetscCall(PgWcsphSetSpacing(l->wcsph, l->dx));
  PetscCall(l->problem->fill(l));
  PetscCall(PgWcsphSetUp(l->wcsph));
  PetscCall(PgWcsphGetTimeStep(l->wcsph, &largest));
  if (l->run.end <= 0.0) l->run.end = l->problem->end(l);
  PgInputCheck(l->run.dt <= largest * (1.0 + 1e-9), l->comm,
               "option -dt: %g s is more than the largest stable time step of this liquid, %g s", (double)l->run.dt,
               (double)largest);
  if (l->run.dt <= 0.0) l->run.dt = l->run.end / PetscMax(1.0, PetscCeilReal(l->run.end / largest - 1e-9));
  PetscCall(PgCaseRunChooseSteps(&l->run, 100));
  PetscFunctionReturn(0);
}

/* ---- comparison with the exact solution ---- */

PetscErrorCode PgLiquidGetErrors(PgLiquid l, PetscReal *l2, PetscReal *most)
{
  PgParticles particles;
  PgField     kind, pressure;
  PgExactSum  sum[2] = {{.not_finite = 0}};
  PetscReal  *x, *v, *p, *what, t, value[2], worst = 0.0;
  PetscInt    owned;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetParticles(l->wcsph, &particles));
  PetscCall(PgWcsphGetTime(l->wcsph, NULL, &t));
  PetscCall(PgParticlesFindField(particles, "kind", &kind));
  PetscCall(PgParticlesFindField(particles, "pressure", &pressure));
  PetscCall(PgParticlesGetArray(particles, PG_POSITION, &x));
  PetscCall(PgParticlesGetArray(particles, PG_VELOCITY, &v));
  PetscCall(PgParticlesGetArray(particles, kind, &what));
  PetscCall(PgParticlesGetArray(particles, pressure, &p));
  PetscCall(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  for (PetscInt a = 0; a < owned; a++) {
    PetscReal exact, off;
    if (what[a] != (PetscReal)PG_WCSPH_FLUID) continue;
    exact = l->problem->exact(l, t, x + 2 * a);
    off   = PetscAbsReal((l->problem->of_pressure ? p[a] : v[2 * a]) - exact);
    worst = PetscMax(worst, off);
    PgExactSumAdd(&sum[0], off * off);
    PgExactSumAdd(&sum[1], exact * exact);
  }
  PetscCall(PgExactSumReduce(l->comm, 2, sum, value));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPIU_REAL, MPIU_MAX, l->comm));
  *l2   = value[1] > 0.0 ? PetscSqrtReal(value[0] / value[1]) : 0.0;
  *most = worst / l->problem->scale(l);
  PetscFunctionReturn(0);
}

/* ---- the run ---- */

enum {
  TIME,
  KINETIC,
  INTERNAL,
  POTENTIAL,
  SPEED,
  DENSITY_MIN,
  DENSITY_MAX,
  FORCE_X,
  FORCE_Y,
  ERROR_L2,
  ERROR_MAX,
  COLUMNS
};
static const PgColumn columns[COLUMNS] = {
    {"time", "s", "time"},
    {"kinetic_energy", "J/m", "kinetic energy of the liquid"},
    {"internal_energy", "J/m", "energy that the liquid stores as pressure"},
    {"potential_energy", "J/m", "energy of the liquid in the field of gravity"},
    {"speed_max", "m/s", "largest speed of a particle of the liquid"},
    {"density_min", "kg/m3", "smallest density of the liquid"},
    {"density_max", "kg/m3", "largest density of the liquid"},
    {"wall_force_x", "N/m", "force of the liquid on all walls along x"},
    {"wall_force_y", "N/m", "force of the liquid on all walls along y"},
    {"error_l2", "1", "relative L2 norm of the deviation from the exact solution"},
    {"error_max", "1",
     "largest deviation from the exact solution, over the speed of the flow or the pressure at the "
     "bottom"},
};

static PetscErrorCode FillRow(PgLiquid l, PetscReal row[COLUMNS])
{
  PgWcsphTotals totals;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetTotals(l->wcsph, &totals));
  PetscCall(PgWcsphGetTime(l->wcsph, NULL, &row[TIME]));
  PetscCall(PgLiquidGetErrors(l, &row[ERROR_L2], &row[ERROR_MAX]));
  row[KINETIC]     = totals.kinetic;
  row[INTERNAL]    = totals.internal;
  row[POTENTIAL]   = totals.potential;
  row[SPEED]       = totals.speed_max;
  row[DENSITY_MIN] = totals.density_min;
  row[DENSITY_MAX] = totals.density_max;
  row[FORCE_X]     = totals.force[0];
  row[FORCE_Y]     = totals.force[1];
  PetscFunctionReturn(0);
}

static PetscErrorCode Observe(PgLiquid l, PetscInt step)
{
  const PgCaseRunDueNow due = PgCaseRunDue(&l->run, step);
  PetscReal             row[COLUMNS];

  PetscFunctionBeginUser;
  if (!due.row && !due.line && !due.snapshot) PetscFunctionReturn(0);
  PetscCall(FillRow(l, row));
  if (due.line)
    PetscCall(PetscPrintf(l->comm,
                          "t %.4e s  speed max %.4e m/s  density %.6g to %.6g kg/m3  energy %.6e J/m  error L2 %.3e  "
                          "max %.3e\n",
                          (double)row[TIME], (double)row[SPEED], (double)row[DENSITY_MIN], (double)row[DENSITY_MAX],
                          (double)(row[KINETIC] + row[INTERNAL] + row[POTENTIAL]), (double)row[ERROR_L2],
                          (double)row[ERROR_MAX]));
  PetscCall(PgCaseRunWrite(&l->run, due, row[TIME], row));
  PetscFunctionReturn(0);
}

static PetscErrorCode TimeLoop(PgLiquid l)
{
  PetscBool on = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(PgCaseRunStart(&l->run, 0));
  PetscCall(Observe(l, 0));
  for (PetscInt step = 1; on; step++) {
    PetscCall(PgWcsphStep(l->wcsph, l->run.dt));
    PetscCall(Observe(l, step));
    PetscCall(PgCaseRunGoesOn(&l->run, step, &on));
  }
  if (l->run.output) PetscCall(PgOutputFinish(l->run.output));
  PetscFunctionReturn(0);
}

static PetscErrorCode Summary(PgLiquid l)
{
  PgParticles particles;
  PetscInt    count, steps;
  PetscReal   time;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetParticles(l->wcsph, &particles));
  PetscCall(PgParticlesGetSizes(particles, NULL, NULL, &count));
  PetscCall(PgWcsphGetTime(l->wcsph, &steps, &time));
  PetscCall(PgCaseRunSummary(&l->run, steps, count, "particle", NULL, NULL));
  PetscCall(PgCaseRunTell(&l->run, steps, time, NULL, -1));
  PetscFunctionReturn(0);
}

PetscErrorCode PgLiquidRun(PgLiquid l, const char output[])
{
  PgParticles    particles;
  PetscErrorCode err;

  PetscFunctionBeginUser;
  PetscCall(PgStagePush(PG_STAGE_SETUP));
  PetscCall(PgLiquidSetUp(l));
  PetscCall(PgWcsphCheckOptions(l->wcsph, 0, NULL, NULL, NULL));
  PetscCall(PgWcsphGetParticles(l->wcsph, &particles));
  if (output[0]) PetscCall(PgOutputCreate(particles, output, COLUMNS, columns, &l->run.output));
  PetscCall(PgStagePop());
  PetscCall(PetscPrintf(l->comm, "time step %.4e s, %" PetscInt_FMT " steps to t = %.4e s\n", (double)l->run.dt,
                        l->run.steps, (double)l->run.end));
  PetscCall(PgWcsphView(l->wcsph, PETSC_VIEWER_STDOUT_(l->comm)));
  err = TimeLoop(l);
  PgEndingStop();
  if (!err && output[0]) PetscCall(PetscPrintf(l->comm, "wrote %s\n", output));
  if (!err) PetscCall(Summary(l));
  PetscCall(PgOutputDestroy(&l->run.output));
  PetscFunctionReturn(err);
}

/* ---- as cases ---- */

static PetscErrorCode Destroy(void **context)
{
  PetscFunctionBeginUser;
  PetscCall(PgLiquidDestroy((PgLiquid *)context));
  PetscFunctionReturn(0);
}

static PetscErrorCode RunCase(MPI_Comm comm, void *context, const char output[])
{
  PetscFunctionBeginUser;
  (void)comm;
  PetscCall(PgLiquidRun((PgLiquid)context, output));
  PetscFunctionReturn(0);
}

#define PG_LIQUID_CREATE(problem)                                                                                      \
  static PetscErrorCode Create_##problem(MPI_Comm comm, void **context)                                                \
  {                                                                                                                    \
    PetscFunctionBeginUser;                                                                                            \
    PetscCall(PgLiquidCreateProblem(comm, &problem, (PgLiquid *)context));                                             \
    PetscFunctionReturn(0);                                                                                            \
  }
PG_LIQUID_CREATE(PgLiquidPoiseuille)
PG_LIQUID_CREATE(PgLiquidCouette)
PG_LIQUID_CREATE(PgLiquidHydrostatic)

const PgCaseInfo PgCaseWcsphPoiseuille  = {.name    = "wcsph_poiseuille",
                                           .summary = "liquid: start of a flow between plates",
                                           .create  = Create_PgLiquidPoiseuille,
                                           .destroy = Destroy,
                                           .run     = RunCase};
const PgCaseInfo PgCaseWcsphCouette     = {.name    = "wcsph_couette",
                                           .summary = "liquid: start of a flow under a moving plate",
                                           .create  = Create_PgLiquidCouette,
                                           .destroy = Destroy,
                                           .run     = RunCase};
const PgCaseInfo PgCaseWcsphHydrostatic = {.name    = "wcsph_hydrostatic",
                                           .summary = "liquid: a column or a tank at rest",
                                           .create  = Create_PgLiquidHydrostatic,
                                           .destroy = Destroy,
                                           .run     = RunCase};
