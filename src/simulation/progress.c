/* How far the run is: a line now and then, or a bar on a terminal; and the summary at its end. */
#include "simulationimpl.h"

static const char *const words[] = {"auto", "bar", "lines", "none"};

PetscErrorCode PgProgressSetFromOptions(PgSimulation sim, PetscOptionItems *PetscOptionsObject)
{
  PetscInt  progress = PG_PROGRESS_AUTO, bar;
  PetscBool every;

  PetscFunctionBeginUser;
  PetscCall(PgOptionChoice(PetscOptionsObject, "-progress",
                           "how the run tells where it is: a bar with the time left when standard output is a terminal "
                           "and no mpiexec stands before it, lines otherwise (auto), or as said",
                           4, words, &progress, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-progress_every",
                         "time between progress lines; default a twentieth of the run", "s", 0.0, 1e9,
                         &sim->progress_time, &every));
  if (progress == PG_PROGRESS_AUTO) {
    bar = PgTerminalIsWatched() && !every; /* who says how often wants lines */
    PetscCallMPI(MPI_Bcast(&bar, 1, MPIU_INT, 0, sim->comm));
    progress = bar ? PG_PROGRESS_BAR : PG_PROGRESS_LINES;
  }
  sim->progress = (PgProgress)progress;
  if (progress != PG_PROGRESS_LINES) sim->progress_time = 0.0;
  PetscFunctionReturn(0);
}

PetscErrorCode PgProgressStart(PgSimulation sim)
{
  PetscFunctionBeginUser;
  sim->started    = MPI_Wtime();
  sim->first_step = sim->last_progress_step = sim->step;
  /* the bar comes with the first step */
  sim->last_progress = sim->progress == PG_PROGRESS_BAR ? 0.0 : sim->started;
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

/* 0:07, 12:45, 3:04:59 */
static void Clock(PetscLogDouble seconds, char text[], size_t size)
{
  const long s = (long)PetscMin(seconds + 0.5, 3.6e9);

  if (s < 3600)
    (void)snprintf(text, size, "%ld:%02ld", s / 60, s % 60);
  else
    (void)snprintf(text, size, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
}

/* The text after the bar: time, load as of the last row of the history, water, what is left. */
static void Tell(PgSimulation sim, PetscLogDouble spent, char text[], size_t size)
{
  const PetscInt done = sim->step - sim->first_step;
  char           left[32], load[48] = "";

  Clock(done > 0 ? spent / (PetscLogDouble)done * (PetscLogDouble)(sim->steps - sim->step) : 0.0, left, sizeof left);
  if (sim->setup.load_plate >= 0 || sim->setup.load_wall >= 0)
    (void)snprintf(load, sizeof load, "  load %.4g kN/m", 1e-3 * (double)sim->row[COLUMN_LOAD]);
  (void)snprintf(text, size, "t %.4g of %.4g s%s  left %s", (double)sim->time, (double)sim->setup.end_time, load, left);
}

PetscErrorCode PgProgressBar(PgSimulation sim)
{
  enum { WIDTH = 512, WIDEST = 40 };
  const PetscLogDouble often = 0.1; /* [s]: faster than that nobody reads */
  const PetscLogDouble now   = MPI_Wtime();
  const double         part  = (double)sim->step / (double)sim->steps;
  char                 text[WIDTH], line[2 * WIDTH], bar[WIDEST + 1];
  PetscMPIInt          rank;
  int                  columns, filled, width;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(sim->comm, &rank));
  if (rank != 0 || (now - sim->last_progress < often && sim->step < sim->steps)) PetscFunctionReturn(0);
  sim->last_progress = now;
  Tell(sim, now - sim->started, text, sizeof text);
  width   = PetscMin(PgTerminalWidth(), WIDTH) - 1;          /* the last column would wrap */
  columns = PetscMin(WIDEST, width - (int)strlen(text) - 9); /* "100 % [", "] " */
  filled  = (int)(part * columns);
  for (int i = 0; i < columns; i++) bar[i] = i < filled ? '#' : '.';
  bar[PetscMax(0, columns)] = '\0';
  if (columns >= 5)
    (void)snprintf(line, sizeof line, "%3d %% [%s] %s", (int)(100.0 * part), bar, text);
  else
    (void)snprintf(line, sizeof line, "%3d %% %s", (int)(100.0 * part), text);
  line[PetscMax(0, width)] = '\0';
  PgTerminalShow(line);
  PetscFunctionReturn(0);
}

/* ---- the summary ---- */

static PetscErrorCode Times(PgSimulation sim)
{
  const PetscLogDouble spent = MPI_Wtime() - sim->started;
  const PetscInt       steps = (sim->step - sim->first_step) * sim->fluid_every;
  PetscInt             global;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(sim->particles, NULL, NULL, &global));
  PetscCall(PetscPrintf(sim->comm, "%.2f s for %" PetscInt_FMT " steps of %" PetscInt_FMT " discs, %.3e disc-steps/s\n",
                        spent, steps, global, spent > 0 ? (double)global * (double)steps / spent : 0.0));
  for (int s = PG_STAGE_LISTS; s < PG_STAGE_COUNT; s++) {
    const PetscLogDouble seconds = PgStageSeconds((PgStage)s);
    if (seconds > 0.0)
      PetscCall(PetscPrintf(sim->comm, "  %-10s %8.2f s  %5.1f %%\n", PgStageName((PgStage)s), seconds,
                            100.0 * seconds / PetscMax(spent, 1e-9)));
  }
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
  PetscInt         preconditioners;
  PetscBool        implicit;

  PetscFunctionBeginUser;
  PetscCall(PgPoreGetParts(sim->pore, NULL, &pressure));
  PetscCall(PgPressureGetMethod(pressure, &method));
  PetscCall(PgPressureGetWork(pressure, &work));
  PetscCall(PgPressureGetCounts(pressure, NULL, NULL, &preconditioners));
  implicit = (PetscBool)(method == PG_PRESSURE_IMPLICIT);
  PetscCall(PetscPrintf(sim->comm,
                        "%" PetscInt_FMT " pressure solves, %" PetscInt64_FMT " %s, %.1f on average, at most "
                        "%" PetscInt_FMT,
                        work.solves, work.iterations, implicit ? "iterations" : "sweeps",
                        (double)work.iterations / PetscMax(1.0, (double)work.solves), work.most));
  if (implicit)
    PetscCall(PetscPrintf(sim->comm, "; %" PetscInt_FMT " preconditioner%s", preconditioners,
                          preconditioners == 1 ? "" : "s"));
  PetscCall(PetscPrintf(sim->comm, "\n"));
  PetscFunctionReturn(0);
}

static PetscErrorCode Files(PgSimulation sim)
{
  PgPressure     pressure;
  PgPressureWork work = {0};

  PetscFunctionBeginUser;
  if (sim->output) {
    PetscInt snapshots, rows;
    PetscCall(PgOutputGetSnapshotCount(sim->output, &snapshots));
    PetscCall(PgOutputGetRowCount(sim->output, &rows));
    PetscCall(PetscPrintf(sim->comm,
                          "results in %s, with .xmf for ParaView and .csv for the history beside it: %" PetscInt_FMT
                          " snapshots, %" PetscInt_FMT " rows of history\n",
                          sim->output_file, snapshots, rows));
  }
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
