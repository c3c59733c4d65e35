/* Curves from the history: load against displacement of all runs, and what a run did in time. */
#include "plotimpl.h"

PetscErrorCode PgPlotDisplacement(const PgPlotSource *source, PetscReal time, PetscReal *displacement, PetscBool *known)
{
  PetscReal *t, *d;
  PetscInt   n, m;

  PetscFunctionBeginUser;
  PetscCall(PgPlotSourceHistory(source, "time", &n, &t));
  PetscCall(PgPlotSourceHistory(source, "displacement", &m, &d));
  *known = (PetscBool)(n > 0 && n == m);
  for (PetscInt i = 0; *known && i < n; i++) {
    if (i + 1 < n && t[i + 1] < time) continue;
    *displacement = d[i];
    if (i + 1 < n && t[i + 1] > t[i]) /* time lies before i + 1: between, or before the first */
      *displacement += (d[i + 1] - d[i]) * PetscMax(0.0, PetscMin(1.0, (time - t[i]) / (t[i + 1] - t[i])));
    break;
  }
  PetscCall(PetscFree(t));
  PetscCall(PetscFree(d));
  PetscFunctionReturn(0);
}

/* ---- load against displacement ---- */

static PetscErrorCode WriteLoad(PgPlot plot, const PgPlotSource *source, PetscBool *written)
{
  PetscReal *displacement, *load;
  PetscInt   n, m;
  char       name[256];
  FILE      *file;

  PetscFunctionBeginUser;
  PetscCall(PgPlotSourceHistory(source, "displacement", &n, &displacement));
  PetscCall(PgPlotSourceHistory(source, "load", &m, &load));
  *written = PETSC_FALSE;
  for (PetscInt i = 1; i < n && n == m; i++)
    if (displacement[i] != displacement[0]) *written = PETSC_TRUE;
  if (*written) {
    PetscCall(PetscSNPrintf(name, sizeof name, "%s-load.dat", source->stem));
    PetscCall(PgPlotFolderCreateFile(&plot->folder, name, &file));
    (void)fprintf(file, "# displacement of the plate [mm]  load [kN/m]\n");
    for (PetscInt i = 0; i < n; i++)
      (void)fprintf(file, "%.6g %.6g\n", 1e3 * (double)displacement[i], 1e-3 * (double)load[i]);
    PetscCall(PgPlotFolderCloseFile(&plot->folder, name, &file));
  } else if (!source->mesh) {
    PetscCall(PetscPrintf(plot->comm, "note: %s has no history of a load over a displacement: it is not in load.gp\n",
                          source->file));
  }
  PetscCall(PetscFree(displacement));
  PetscCall(PetscFree(load));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotLoads(PgPlot plot)
{
  PetscBool written[PG_PLOT_SOURCES] = {PETSC_FALSE};
  PetscInt  curves                   = 0;
  PgScript  script;
  char      quoted[300];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < plot->sources; i++) {
    written[i] = PETSC_FALSE;
    if (!plot->source[i].study) PetscCall(WriteLoad(plot, &plot->source[i], &written[i]));
    plot->source[i].load = written[i];
    curves += written[i];
  }
  if (!curves) PetscFunctionReturn(0);
  PetscCall(PgScriptBegin(plot, "load", 760.0, 480.0, PETSC_FALSE, &script));
  PetscCall(PgScriptPicture(&script));
  (void)fprintf(
      script.file,
      "set xlabel 'displacement of the plate [mm]'\nset ylabel 'load [kN/m]'\nset grid lt 1 lw 0.5 lc rgb '#dddddd'\n"
      "set border 3\nset tics nomirror\nset xrange [0:*]\nset autoscale xfixmax\nset yrange [*:*]\n"
      "set key outside top center horizontal\nplot ");
  for (PetscInt i = 0, c = 0; i < plot->sources; i++) {
    if (!written[i]) continue;
    (void)fprintf(script.file, "%s'%s-load.dat' using 1:2 with lines lw 1.3 lc rgb '%s' dt %d title '%s'",
                  c ? ", \\\n  " : "", plot->source[i].stem, PgScriptColour(c), (int)PgScriptDash(c),
                  PgScriptQuote(plot->source[i].label, quoted, sizeof quoted));
    c++;
  }
  (void)fprintf(script.file, "\n");
  PetscCall(PgScriptEnd(&script));
  PetscFunctionReturn(0);
}

/* ---- history ---- */

enum { COLUMNS = 10, SETTLEMENT = 9 };
static const struct {
  const char *name, *label; /* of the curve */
  PetscReal   scale;
} column[COLUMNS] = {{"time", "", 1.0},
                     {"load", "load", 1e-3},
                     {"kinetic_energy", "kinetic energy", 1.0},
                     {"pressure_min", "smallest", 1e-3},
                     {"pressure_mean", "mean", 1e-3},
                     {"pressure_max", "largest", 1e-3},
                     {"pressure_probe", "probe", 1e-3},
                     {"pressure_iterations", "iterations", 1.0},
                     {"pressure_residual", "residual", 1.0},
                     {"displacement", "displacement", 1e3}};
enum { PANELS = 6 };
static const struct {
  PetscInt    first, last; /* columns */
  const char *label;
  PetscBool   logarithmic;
} panel[PANELS] = {{1, 1, "load [kN/m]", PETSC_FALSE},
                   {2, 2, "kinetic energy [J/m]", PETSC_TRUE},
                   {SETTLEMENT, SETTLEMENT, "displacement [mm]", PETSC_FALSE},
                   {3, 6, "pressure [kPa]", PETSC_FALSE},
                   {7, 7, "pressure iterations", PETSC_FALSE},
                   {8, 8, "residual |b - Ap|/|b|", PETSC_TRUE}};

/* *rows is 0 when there is no history; columns that are not there stay NULL. */
static PetscErrorCode ReadHistory(const PgPlotSource *source, PetscInt *rows, PetscReal *value[])
{
  PetscFunctionBeginUser;
  *rows = 0;
  for (PetscInt c = 0; c < COLUMNS; c++) {
    PetscInt n;
    PetscCall(PgPlotSourceHistory(source, column[c].name, &n, &value[c]));
    if (c == 0) *rows = n;
    /* the way of a plate that moves at a given speed is nothing to see; a settlement is */
    if (n != *rows || (c == SETTLEMENT && !source->mesh)) PetscCall(PetscFree(value[c]));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteHistory(PgPlot plot, const PgPlotSource *source, PetscInt rows, PetscReal *const value[],
                                   PetscReal smallest[], PetscReal largest[])
{
  char  name[256];
  FILE *file;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, sizeof name, "%s-history.dat", source->stem));
  PetscCall(PgPlotFolderCreateFile(&plot->folder, name, &file));
  (void)fprintf(
      file,
      "# time [s]  load [kN/m]  kinetic energy [J/m]  pressure min, mean, max, probe [kPa]  iterations  residual  "
      "displacement [mm]\n");
  for (PetscInt c = 0; c < COLUMNS; c++) {
    smallest[c] = PETSC_MAX_REAL;
    largest[c]  = 0.0;
  }
  for (PetscInt i = 0; i < rows; i++, (void)fputc('\n', file))
    for (PetscInt c = 0; c < COLUMNS; c++) {
      const PetscReal v = value[c] ? column[c].scale * value[c][i] : (PetscReal)NAN;
      if (isfinite(v)) largest[c] = PetscMax(largest[c], PetscAbsReal(v));
      if (isfinite(v) && v > 0.0) smallest[c] = PetscMin(smallest[c], v);
      (void)fprintf(file, isfinite(v) ? "%.7g " : "nan ", (double)v);
    }
  PetscCall(PgPlotFolderCloseFile(&plot->folder, name, &file));
  PetscFunctionReturn(0);
}

static void DrawPanel(FILE *f, const char stem[], PetscInt p, const PetscBool there[], PetscBool last)
{
  (void)fprintf(f, "set ylabel '%s'\nset xlabel '%s'\n%s\n%s\n", panel[p].label, last ? "time [s]" : "",
                panel[p].logarithmic ? "set logscale y\nset format y '10^{%T}'"
                                     : "unset logscale y\nset format y '%g'\nset ytics autofreq",
                panel[p].first < panel[p].last ? "set key outside top right horizontal" : "unset key");
  (void)fprintf(f, "plot ");
  for (PetscInt c = panel[p].first; c <= panel[p].last; c++) {
    if (!there[c]) continue;
    /* a residual of 0, before the first solve, has no place on a logarithmic axis */
    (void)fprintf(
        f, panel[p].logarithmic ? "%s'%s-history.dat' using 1:($%d > 0 ? $%d : NaN)" : "%s'%s-history.dat' using 1:%d",
        c > panel[p].first ? ", \\\n  " : "", stem, (int)c + 1, (int)c + 1);
    (void)fprintf(f, " with lines lc rgb '%s' title '%s'", PgScriptColour(c - panel[p].first), column[c].label);
  }
  (void)fprintf(f, "\n");
}

/* There is nothing to see in what is zero all the time, nor in one value on a logarithmic axis. */
static PetscBool HasSomething(PetscInt p, PetscReal *const value[], const PetscReal smallest[],
                              const PetscReal largest[])
{
  for (PetscInt c = panel[p].first; c <= panel[p].last; c++)
    if (value[c] && largest[c] > (panel[p].logarithmic ? smallest[c] : 0.0)) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode PgPlotHistory(PgPlot plot, const PgPlotSource *source)
{
  PetscReal *value[COLUMNS], smallest[COLUMNS], largest[COLUMNS];
  PetscBool  there[COLUMNS];
  PetscInt   rows, shown[PANELS], panels = 0;
  PgScript   script;
  char       name[256], quoted[300];

  PetscFunctionBeginUser;
  PetscCall(ReadHistory(source, &rows, value));
  if (rows > 1) PetscCall(WriteHistory(plot, source, rows, value, smallest, largest));
  for (PetscInt p = 0; rows > 1 && p < PANELS; p++)
    if (HasSomething(p, value, smallest, largest)) shown[panels++] = p;
  for (PetscInt c = 0; c < COLUMNS; c++) {
    there[c] = (PetscBool)(value[c] != NULL);
    PetscCall(PetscFree(value[c]));
  }
  if (!panels) {
    PetscCall(PetscPrintf(plot->comm, "note: %s has no history to draw\n", source->file));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscSNPrintf(name, sizeof name, "%s-history", source->stem));
  PetscCall(PgScriptBegin(plot, name, 760.0, 40.0 + 190.0 * (PetscReal)panels, PETSC_FALSE, &script));
  PetscCall(PgScriptPicture(&script));
  (void)fprintf(script.file,
                "set multiplot layout %d,1 title '%s' noenhanced\nset grid lt 1 lw 0.5 lc rgb '#dddddd'\nset border 3\n"
                "set tics nomirror\nset lmargin 11\nset rmargin 5\n",
                (int)panels, PgScriptQuote(source->label, quoted, sizeof quoted));
  for (PetscInt p = 0; p < panels; p++)
    DrawPanel(script.file, source->stem, shown[p], there, (PetscBool)(p + 1 == panels));
  (void)fprintf(script.file, "unset multiplot\n");
  PetscCall(PgScriptEnd(&script));
  PetscFunctionReturn(0);
}
