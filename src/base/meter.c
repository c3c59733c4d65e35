/* How far a run is, as a bar on a terminal, and what it has cost at its end: the same for every kind of run. */
#include "baseimpl.h"

static const char *const words[] = {"auto", "bar", "lines", "none"};

PetscErrorCode PgMeterSetFromOptions(MPI_Comm comm, PetscOptionItems *PetscOptionsObject, PgMeter *meter,
                                     PetscReal *every)
{
  PetscInt  progress = PG_PROGRESS_AUTO, bar;
  PetscBool given    = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PgOptionChoice(PetscOptionsObject, "-progress",
                           "how the run tells where it is: a bar with the time left when standard output is a terminal "
                           "and no mpiexec stands before it, lines otherwise (auto), or as said",
                           4, words, &progress, NULL));
  if (every)
    PetscCall(PgOptionReal(PetscOptionsObject, "-progress_every",
                           "time between progress lines; default a twentieth of the run", "s", 0.0, 1e9, every,
                           &given));
  if (progress == PG_PROGRESS_AUTO) {
    bar = PgTerminalIsWatched() && !given; /* who says how often wants lines */
    PetscCallMPI(MPI_Bcast(&bar, 1, MPIU_INT, 0, comm));
    progress = bar ? PG_PROGRESS_BAR : PG_PROGRESS_LINES;
  }
  meter->progress = (PgProgress)progress;
  PetscFunctionReturn(0);
}

PetscErrorCode PgMeterStart(PgMeter *meter, MPI_Comm comm, PetscInt first, PetscInt last)
{
  PetscFunctionBeginUser;
  meter->comm    = comm;
  meter->first   = first;
  meter->last    = last;
  meter->started = MPI_Wtime();
  meter->shown   = 0.0; /* the bar comes with the first step */
  PetscCallMPI(MPI_Comm_rank(comm, &meter->rank));
  PetscFunctionReturn(0);
}

/* ---- the bar ---- */

/* 0:07, 12:45, 3:04:59 */
static void Clock(PetscLogDouble seconds, char text[], size_t size)
{
  const long s = (long)PetscMin(seconds + 0.5, 3.6e9);

  if (s < 3600)
    (void)snprintf(text, size, "%ld:%02ld", s / 60, s % 60);
  else
    (void)snprintf(text, size, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
}

PetscBool PgMeterBarDue(const PgMeter *meter, PetscInt step)
{
  const PetscLogDouble often = 0.1; /* [s]: faster than that nobody reads */

  return (PetscBool)(meter->progress == PG_PROGRESS_BAR && meter->rank == 0 &&
                     (step >= meter->last || MPI_Wtime() - meter->shown >= often));
}

void PgMeterBar(PgMeter *meter, PetscInt step, PetscReal time, PetscReal end, const char more[])
{
  enum { WIDTH = 512, WIDEST = 40 };
  const PetscLogDouble now  = MPI_Wtime();
  const double         part = (double)step / (double)PetscMax(1, meter->last);
  const PetscInt       done = step - meter->first;
  char                 text[WIDTH], line[2 * WIDTH], bar[WIDEST + 1], left[32];
  int                  columns, filled, width;

  meter->shown = now;
  Clock(done > 0 ? (now - meter->started) / (PetscLogDouble)done * (PetscLogDouble)(meter->last - step) : 0.0, left,
        sizeof left);
  (void)snprintf(text, sizeof text, "t %.4g of %.4g s%s  left %s", (double)time, (double)end, more, left);
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
}

/* ---- the summary ---- */

PetscErrorCode PgMeterTimes(const PgMeter *meter, PetscInt steps, PetscInt count, const char one[])
{
  const PetscLogDouble spent = MPI_Wtime() - meter->started;

  PetscFunctionBeginUser;
  PetscCall(PetscPrintf(meter->comm, "%.2f s for %" PetscInt_FMT " steps of %" PetscInt_FMT " %ss, %.3e %s-steps/s\n",
                        spent, steps, count, one, spent > 0 ? (double)count * (double)steps / spent : 0.0, one));
  for (int s = PG_STAGE_LISTS; s < PG_STAGE_COUNT; s++) {
    const PetscLogDouble seconds = PgStageSeconds((PgStage)s);
    if (seconds > 0.0)
      PetscCall(PetscPrintf(meter->comm, "  %-10s %8.2f s  %5.1f %%\n", PgStageName((PgStage)s), seconds,
                            100.0 * seconds / PetscMax(spent, 1e-9)));
  }
  PetscFunctionReturn(0);
}

void PgSolvesAdd(PgSolves *work, PetscInt iterations)
{
  work->solves++;
  work->iterations += iterations;
  work->most = PetscMax(work->most, iterations);
}

PetscErrorCode PgMeterSolves(MPI_Comm comm, const PgSolves *work, const char what[], const char unit[],
                             const char more[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscPrintf(comm,
                        "%" PetscInt_FMT " %s, %" PetscInt64_FMT " %s, %.1f on average, at most %" PetscInt_FMT "%s\n",
                        work->solves, what, work->iterations, unit,
                        (double)work->iterations / PetscMax(1.0, (double)work->solves), work->most, more));
  PetscFunctionReturn(0);
}
