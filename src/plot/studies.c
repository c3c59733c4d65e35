/* Figures of porograin-study. The rows of a table become series of points, one for each value of its key columns. */
#include "plotimpl.h"

typedef struct {
  PetscInt    rows;
  PgPlotText *key;           /* of each row */
  PetscInt   *series, count; /* of each row; how many */
  PetscInt   *first;         /* row of each series */
} Series;

/* Series by one or two columns, which may hold text or numbers (shown behind `prefix`). */
static PetscErrorCode SeriesCreate(const PgPlotSource *source, const char table[], const char *const by[2],
                                   const char prefix[], Series *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(s, sizeof *s));
  PetscCall(PgPlotSourceRows(source, table, &s->rows));
  PetscCall(PetscCalloc3(s->rows, &s->key, s->rows, &s->series, s->rows, &s->first));
  for (PetscInt i = 0; i < s->rows; i++) {
    PetscInt k = 0;
    for (int b = 0; b < 2 && by[b]; b++) {
      PgPlotText   text;
      PetscReal    number;
      const size_t n = strlen(s->key[i]);
      PetscCall(PgPlotSourceText(source, table, i, by[b], text));
      PetscCall(PgPlotSourceReal(source, table, i, by[b], &number));
      if (!text[0] && isfinite(number)) (void)snprintf(text, sizeof text, "%s%.10g", prefix, (double)number);
      (void)snprintf(s->key[i] + n, PG_PLOT_TEXT - n, "%s%.80s", b ? ", " : "", text);
    }
    while (k < s->count && strcmp(s->key[s->first[k]], s->key[i])) k++;
    if (k == s->count) s->first[s->count++] = i;
    s->series[i] = k;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode SeriesDestroy(Series *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(s->key, s->series, s->first));
  PetscFunctionReturn(0);
}

/* NAME.dat: a block of x and the columns y for each series. drawn[k]: how many points series k has that are > 0 in
   the first column. */
static PetscErrorCode WriteSeries(PgPlot plot, const PgPlotSource *source, const char table[], const Series *s,
                                  const char name[], PetscInt columns, const char *const column[], PetscInt drawn[])
{
  char  file_name[300];
  FILE *file;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(file_name, sizeof file_name, "%s.dat", name));
  PetscCall(PgPlotFolderCreateFile(&plot->folder, file_name, &file));
  (void)fputc('#', file);
  for (PetscInt c = 0; c < columns; c++) (void)fprintf(file, " %s", column[c]);
  (void)fputc('\n', file);
  for (PetscInt k = 0; k < s->count; k++) {
    drawn[k] = 0;
    (void)fprintf(file, "# %s\n", s->key[s->first[k]]);
    for (PetscInt i = 0; i < s->rows; i++) {
      if (s->series[i] != k) continue;
      for (PetscInt c = 0; c < columns; c++) {
        PetscReal value;
        PetscCall(PgPlotSourceReal(source, table, i, column[c], &value));
        (void)fprintf(file, isfinite(value) ? "%.8g " : "nan ", (double)value);
        drawn[k] += c == 1 && value > 0.0;
      }
      (void)fputc('\n', file);
    }
    (void)fprintf(file, "\n\n");
  }
  PetscCall(PgPlotFolderCloseFile(&plot->folder, file_name, &file));
  PetscFunctionReturn(0);
}

static void Style(FILE *f, const char x[], const char y[], PetscBool log_x, PetscBool log_y)
{
  (void)fprintf(
      f, "set xlabel '%s'\nset ylabel '%s'\nset grid lt 1 lw 0.5 lc rgb '#dddddd'\nset border 3\nset tics nomirror\n",
      x, y);
  if (log_x) (void)fprintf(f, "set logscale x\nset format x '10^{%%T}'\n");
  if (log_y) (void)fprintf(f, "set logscale y\nset format y '10^{%%T}'\n");
}

/* Points and lines of all series that have some; x and y are gnuplot expressions of the columns. */
static void DrawSeries(FILE *f, const Series *s, const char name[], const char x[], const char y[],
                       const PetscInt drawn[], const PetscReal growth[])
{
  char     quoted[PG_PLOT_TEXT + 8];
  PetscInt n = 0;

  for (PetscInt k = 0; k < s->count; k++) {
    if (!drawn[k]) continue;
    (void)fprintf(f, "%s'%s.dat' index %d using (%s):(%s) with linespoints lc rgb '%s' dt %d pt %d ps 0.8 title '%s",
                  n ? ", \\\n  " : "", name, (int)k, x, y, PgScriptColour(k), (int)PgScriptDash(k), (int)(1 + k % 13),
                  PgScriptQuote(s->key[s->first[k]], quoted, sizeof quoted));
    if (growth && isfinite(growth[k])) (void)fprintf(f, "  N^%.2f", (double)growth[k]);
    (void)fprintf(f, "'");
    n++;
  }
  (void)fprintf(f, "\n");
}

static void Draw(FILE *f, const Series *s, const char name[], const char x[], const char y[], const PetscInt drawn[],
                 const PetscReal growth[])
{
  (void)fprintf(f, "plot ");
  DrawSeries(f, s, name, x, y, drawn, growth);
}

static PetscInt Sum(PetscInt n, const PetscInt value[])
{
  PetscInt sum = 0;

  for (PetscInt i = 0; i < n; i++) sum += value[i];
  return sum;
}

/* ---- solvers ---- */

/* A tic at each size of the study: between two powers of ten a logarithmic axis has none of its own. Sizes within 30 %
   of the last one that is labelled get none. */
static void SizeTics(FILE *file, PetscInt n, PetscReal size[])
{
  PetscReal last = 0.0;

  (void)PetscSortReal(n, size);
  (void)fprintf(file, "set format x '%%g'\nset xtics (");
  for (PetscInt i = 0; i < n; i++) {
    if (size[i] < 1.3 * last) continue;
    (void)fprintf(file, "%s'%.0f' %.10g", last > 0.0 ? ", " : "", (double)size[i], (double)size[i]);
    last = size[i];
  }
  (void)fprintf(file, ")\n");
}

/* Iterations against N, with the exponents that the study has fitted. */
static PetscErrorCode Growth(PgPlot plot, const PgPlotSource *source, const char table[])
{
  static const char *const by[2] = {"solver", NULL}, *const column[2] = {"N", "iterations_needed"};
  Series     s;
  PetscReal *growth, least = PETSC_MAX_REAL, most = 0.0, *size;
  PetscInt  *drawn, sizes = 0;
  PgScript   script;
  char       name[256];

  PetscFunctionBeginUser;
  PetscCall(SeriesCreate(source, table, by, "", &s));
  PetscCall(PetscMalloc3(s.count, &growth, s.count, &drawn, s.rows, &size));
  for (PetscInt k = 0; k < s.count; k++) growth[k] = (PetscReal)NAN;
  for (PetscInt i = 0; i < s.rows; i++) {
    PetscReal value;
    PetscCall(PgPlotSourceReal(source, table, i, "growth", &value));
    if (isfinite(value)) growth[s.series[i]] = value; /* over the sizes so far: the last is over all */
    PetscCall(PgPlotSourceReal(source, table, i, "N", &size[sizes]));
    least = PetscMin(least, size[sizes]);
    most  = PetscMax(most, size[sizes]);
    sizes++;
  }
  if (most > least) {
    PetscCall(PetscSNPrintf(name, sizeof name, "%s-growth", source->stem));
    PetscCall(WriteSeries(plot, source, table, &s, name, 2, column, drawn));
    PetscCall(PgScriptBegin(plot, name, 820.0, 520.0, PETSC_FALSE, &script));
    PetscCall(PgScriptPicture(&script));
    Style(script.file, "number of unknowns N", "iterations (extrapolated when stopped)", PETSC_TRUE, PETSC_TRUE);
    (void)fprintf(script.file, "set key outside right\nset xrange [%g:%g]\n", 0.8 * (double)least, 1.25 * (double)most);
    SizeTics(script.file, sizes, size);
    Draw(script.file, &s, name, "$1", "$2 > 0 ? $2 : NaN", drawn, growth);
    PetscCall(PgScriptEnd(&script));
  }
  PetscCall(PetscFree3(growth, drawn, size));
  PetscCall(SeriesDestroy(&s));
  PetscFunctionReturn(0);
}

/* Histories of the rows of one system: NAME.dat with a block for each. */
static PetscErrorCode WriteResiduals(PgPlot plot, const PgPlotSource *source, const char table[], const Series *s,
                                     PetscInt system, const char name[], PetscInt block[], PetscInt *longest)
{
  char     file_name[300];
  FILE    *file;
  PetscInt blocks = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(file_name, sizeof file_name, "%s.dat", name));
  PetscCall(PgPlotFolderCreateFile(&plot->folder, file_name, &file));
  (void)fprintf(file, "# iteration  residual norm over that of b\n");
  *longest = 0;
  for (PetscInt i = 0; i < s->rows; i++) {
    char       path[256];
    PetscBool  has;
    PetscReal *value;
    PetscInt   n, columns;
    block[i] = -1;
    if (s->series[i] != system) continue;
    PetscCall(PetscSNPrintf(path, sizeof path, "/%s/%03" PetscInt_FMT "/history", table, i));
    PetscCall(PgPlotSourceHas(source, path, &has));
    if (!has) continue;
    PetscCall(PgResultRead(PETSC_COMM_SELF, source->file, path, &n, &columns, &value));
    if (n > 1) {
      block[i] = blocks++;
      *longest = PetscMax(*longest, n - 1);
      for (PetscInt k = 0; k < n; k++) /* of long histories what a logarithmic axis can show */
        if (k < 1000 || k == n - 1 || k % (k / 500) == 0) (void)fprintf(file, "%d %.6g\n", (int)k, (double)value[k]);
      (void)fprintf(file, "\n\n");
    }
    PetscCall(PetscFree(value));
  }
  PetscCall(PgPlotFolderCloseFile(&plot->folder, file_name, &file));
  PetscFunctionReturn(0);
}

static PetscErrorCode Residuals(PgPlot plot, const PgPlotSource *source, const char table[])
{
  static const char *const by[2] = {"system", "N"};
  Series                   s;
  PetscInt                *block, longest = 0;
  PgScript                 script;
  char                     name[256], quoted[PG_PLOT_TEXT + 8];

  PetscFunctionBeginUser;
  PetscCall(SeriesCreate(source, table, by, "N = ", &s));
  PetscCall(PetscMalloc1(s.rows, &block));
  for (PetscInt k = 0; k < s.count; k++) {
    PetscCall(PetscSNPrintf(name, sizeof name, "%s-residuals-%" PetscInt_FMT, source->stem, k + 1));
    PetscCall(WriteResiduals(plot, source, table, &s, k, name, block, &longest));
    if (!longest) continue;
    PetscCall(PgScriptBegin(plot, name, 820.0, 520.0, PETSC_FALSE, &script));
    PetscCall(PgScriptPicture(&script));
    Style(script.file, "iteration", "residual |b - Ax|/|b|", (PetscBool)(longest > 200), PETSC_TRUE);
    (void)fprintf(script.file, "set title '%s' noenhanced\nset key outside right\nset xrange [%d:%d]\nplot ",
                  PgScriptQuote(s.key[s.first[k]], quoted, sizeof quoted), longest > 200 ? 1 : 0, (int)longest);
    for (PetscInt i = 0, n = 0; i < s.rows; i++) {
      PgPlotText solver;
      if (block[i] < 0) continue;
      PetscCall(PgPlotSourceText(source, table, i, "solver", solver));
      (void)fprintf(script.file, "%s'%s.dat' index %d using 1:2 with lines lw 1.3 lc rgb '%s' dt %d title '%s'",
                    n ? ", \\\n  " : "", name, (int)block[i], PgScriptColour(n), (int)PgScriptDash(n),
                    PgScriptQuote(solver, quoted, sizeof quoted));
      n++;
    }
    (void)fprintf(script.file, "\n");
    PetscCall(PgScriptEnd(&script));
  }
  PetscCall(PetscFree(block));
  PetscCall(SeriesDestroy(&s));
  PetscFunctionReturn(0);
}

/* ---- explicit against implicit ---- */

/* Distance from the solved pressure against the number of sweeps. */
static PetscErrorCode Sweeps(PgPlot plot, const PgPlotSource *source)
{
  static const char *const by[2] = {"step", NULL}, *const column[3] = {"sweeps", "error_relative", "residual"};
  Series    s;
  PetscInt *drawn;
  PgScript  script;
  char      name[256];

  PetscFunctionBeginUser;
  PetscCall(SeriesCreate(source, "study", by, "fluid step ", &s));
  PetscCall(PetscMalloc1(s.count, &drawn));
  PetscCall(PetscSNPrintf(name, sizeof name, "%s-sweeps", source->stem));
  PetscCall(WriteSeries(plot, source, "study", &s, name, 3, column, drawn));
  if (Sum(s.count, drawn)) {
    PetscCall(PgScriptBegin(plot, name, 820.0, 480.0, PETSC_FALSE, &script));
    PetscCall(PgScriptPicture(&script));
    Style(script.file, "explicit sweeps (0: the guess of Eq. 59)", "largest error / largest excess pressure",
          PETSC_TRUE, PETSC_TRUE);
    /* there is no 0 on a logarithmic axis: the guess stands at 0.5 */
    (void)fprintf(script.file, "set xrange [0.4:*]\nset xtics add ('0' 0.5)\nset key outside right\n");
    Draw(script.file, &s, name, "$1 > 0 ? $1 : 0.5", "$2 > 0 ? $2 : NaN", drawn, NULL);
    PetscCall(PgScriptEnd(&script));
  }
  PetscCall(PetscFree(drawn));
  PetscCall(SeriesDestroy(&s));
  PetscFunctionReturn(0);
}

/* What the runs of a study have: the values of M, the steps of the discs in one of the water, each once and in order; and
   the powers of ten between which the times are. */
typedef struct {
  PetscInt count, *every;
  int      decade[2];
} Runs;

static PetscErrorCode RunsCreate(const PgPlotSource *source, PetscInt rows, Runs *runs)
{
  PetscReal least = PETSC_MAX_REAL, most = 0.0;

  PetscFunctionBeginUser;
  runs->count = 0;
  PetscCall(PetscMalloc1(rows, &runs->every));
  for (PetscInt i = 0; i < rows; i++) {
    PetscReal every, time;
    PetscCall(PgPlotSourceReal(source, "cost", i, "fluid_every", &every));
    PetscCall(PgPlotSourceReal(source, "cost", i, "per_step", &time));
    if (isfinite(every)) runs->every[runs->count++] = (PetscInt)every;
    if (!(time > 0.0)) continue;
    least = PetscMin(least, time);
    most  = PetscMax(most, time);
  }
  PetscCall(PetscSortRemoveDupsInt(&runs->count, runs->every));
  runs->decade[0] = most > 0.0 ? (int)PetscFloorReal(PetscLog10Real(least)) : 0;
  runs->decade[1] = most > 0.0 ? (int)PetscFloorReal(PetscLog10Real(most)) : 0;
  PetscFunctionReturn(0);
}

/* Points of one shape, told apart also where they are small: full ones first. */
static int Shape(PetscInt k)
{
  static const int shape[] = {7, 5, 9, 13, 11, 6, 4, 8, 12, 10, 1, 2, 3};

  return shape[k % (PetscInt)(sizeof shape / sizeof *shape)];
}

/* One panel: column y against the time. The colour of a line tells the method, the shape of its points M; the first
   panel explains the lines below itself, the second the shapes. */
static void DrawCost(FILE *f, const Series *s, const char name[], int panel, const Runs *runs, const PetscInt drawn[])
{
  const int y = panel + 2;
  char      quoted[PG_PLOT_TEXT + 8];

  (void)fprintf(f, "set key at screen 0.5,%g center bottom maxrows %d noenhanced\nplot ", panel ? 0.065 : 0.115,
                panel ? 1 : 2);
  for (PetscInt k = 0; k < s->count; k++) {
    if (!drawn[k]) continue;
    (void)fprintf(
        f, "'%s.dat' index %d using 1:($%d > 0 ? $%d : NaN) with lines lw 1.3 lc rgb '%s' dt %d title '%s', \\\n  ",
        name, (int)k, y, y, PgScriptColour(k), (int)PgScriptDash(k),
        panel ? "" : PgScriptQuote(s->key[s->first[k]], quoted, sizeof quoted));
    for (PetscInt m = 0; m < runs->count; m++)
      (void)fprintf(
          f,
          "'' index %d using 1:($4 == %d && $%d > 0 ? $%d : NaN) with points pt %d ps 1.1 lc rgb '%s' notitle, \\\n  ",
          (int)k, (int)runs->every[m], y, y, Shape(m), PgScriptColour(k));
  }
  for (PetscInt m = 0; m < runs->count; m++) {
    (void)fprintf(f, "%sNaN with points pt %d ps 1.1 lc rgb '#666666' ", m ? ", \\\n  " : "", Shape(m));
    if (panel)
      (void)fprintf(f, "title 'M = %d'", (int)runs->every[m]);
    else
      (void)fprintf(f, "notitle");
  }
  (void)fprintf(f, "\n");
}

/* What both panels have. */
static void CostAxes(FILE *f, PetscReal size, const Runs *runs, PetscReal reference, const char reference_name[],
                     PetscReal reference_every)
{
  char quoted[PG_PLOT_TEXT + 8];

  (void)fprintf(f, "set multiplot layout 1,2 margins 0.09,0.98,0.35,0.96 spacing 0.1,0\n");
  Style(f, "time [µs per disc and step of the discs]", "", PETSC_TRUE, PETSC_TRUE);
  (void)fprintf(
      f,
      "set format x '%%g'\nset format y '%%g'\nset autoscale fix\n"
      "set offsets graph 0.08, graph 0.08, graph 0.08, graph 0.08\n"
      "do for [e=%d:%d] {\n  set xtics add (sprintf('%%g', 2*10.0**e) 2*10.0**e, sprintf('%%g', 5*10.0**e) "
      "5*10.0**e)\n}\n"
      "do for [e=-9:3] {\n  set ytics add (sprintf('%%g', 2*10.0**e) 2*10.0**e, sprintf('%%g', 5*10.0**e) "
      "5*10.0**e)\n}\n"
      "set arrow from first %.6g,graph 0 to first %.6g,graph 1 nohead dt 2 lc rgb '#888888'\n"
      "set label 'M: steps of the discs in one of the water; explicitK: K sweeps, implicitR: to a residual "
      "R; dashed: time of the reference (%s, M = %g)' at screen 0.5,0.025 center tc rgb '#666666' font ',%.3g'\n",
      runs->decade[0], runs->decade[1], (double)reference, (double)reference,
      PgScriptQuote(reference_name, quoted, sizeof quoted), (double)reference_every, 9.0 * (double)size);
}

/* Error against cost. The reference, which has no error, is a line at its cost. */
static PetscErrorCode Cost(PgPlot plot, const PgPlotSource *source)
{
  static const char *const by[2]     = {"variant", NULL};
  static const char *const column[4] = {"per_step", "load_error", "pressure_error", "fluid_every"};
  static const char *const label[2]  = {"error of the load (rms)", "error of the pressure (L2)"};
  Series                   s;
  Runs                     runs;
  PetscInt                *drawn;
  PetscReal                reference, reference_every;
  PgScript                 script;
  char                     name[256];

  PetscFunctionBeginUser;
  PetscCall(SeriesCreate(source, "cost", by, "", &s));
  PetscCall(RunsCreate(source, s.rows, &runs));
  PetscCall(PetscMalloc1(s.count, &drawn));
  PetscCall(PetscSNPrintf(name, sizeof name, "%s-cost", source->stem));
  PetscCall(WriteSeries(plot, source, "cost", &s, name, 4, column, drawn));
  if (Sum(s.count, drawn)) {
    PetscCall(PgPlotSourceReal(source, "cost", 0, "per_step", &reference));
    PetscCall(PgPlotSourceReal(source, "cost", 0, "fluid_every", &reference_every));
    PetscCall(PgScriptBegin(plot, name, 960.0, 500.0, PETSC_FALSE, &script));
    PetscCall(PgScriptPicture(&script));
    CostAxes(script.file, plot->size, &runs, reference, s.key[0], reference_every);
    for (int p = 0; p < 2; p++) {
      (void)fprintf(script.file, "set ylabel '%s'\n", label[p]);
      DrawCost(script.file, &s, name, p, &runs, drawn);
    }
    (void)fprintf(script.file, "unset multiplot\n");
    PetscCall(PgScriptEnd(&script));
  }
  PetscCall(PetscFree(drawn));
  PetscCall(PetscFree(runs.every));
  PetscCall(SeriesDestroy(&s));
  PetscFunctionReturn(0);
}

/* ---- operators, and solvers along a run ---- */

/* Errors against the spacing, side by side those that the table has. */
static PetscErrorCode Orders(PgPlot plot, const PgPlotSource *source)
{
  enum { MOST = 4 };
  static const char *const by[2]            = {"operators", "packing"};
  static const char *const errors[MOST]     = {"gradient_error", "laplacian_error", "pressure_error", "shape_error"};
  static const char *const titles[MOST]     = {"gradient", "Laplacian", "solved pressure", "its shape"};
  const char              *column[1 + MOST] = {"spacing"}, *title[1 + MOST] = {""};
  Series                   s;
  PetscInt                *drawn, count = 1;
  PgScript                 script;
  char                     name[256], y[64];

  PetscFunctionBeginUser;
  for (int c = 0; c < MOST; c++) {
    PgPlotText text;
    PetscCall(PgPlotSourceColumn(source, "study", errors[c], text));
    if (!text[0]) continue;
    column[count]  = errors[c];
    title[count++] = titles[c];
  }
  PetscCall(SeriesCreate(source, "study", by, "", &s));
  PetscCall(PetscMalloc1(s.count, &drawn));
  PetscCall(PetscSNPrintf(name, sizeof name, "%s-orders", source->stem));
  PetscCall(WriteSeries(plot, source, "study", &s, name, count, column, drawn));
  if (Sum(s.count, drawn)) {
    PetscCall(PgScriptBegin(plot, name, count > 3 ? 1100.0 : 820.0, 520.0, PETSC_FALSE, &script));
    PetscCall(PgScriptPicture(&script));
    (void)fprintf(script.file, "set multiplot layout 1,%d margins 0.07,0.98,0.33,0.93 spacing 0.07,0\n",
                  (int)count - 1);
    Style(script.file, "spacing", "", PETSC_TRUE, PETSC_TRUE);
    (void)fprintf(script.file, "set offsets graph 0.05, graph 0.05, graph 0.05, graph 0.05\n");
    for (PetscInt c = 1; c < count; c++) {
      (void)fprintf(script.file, "set title '%s'\nset ylabel '%s'\n%s\n", title[c], c == 1 ? "relative L2 error" : "",
                    c == 2 && s.count > 1 ? "set key at screen 0.5,0.02 center bottom maxrows 3 noenhanced"
                                          : "unset key");
      (void)snprintf(y, sizeof y, "$%d > 0 ? $%d : NaN", (int)c + 1, (int)c + 1);
      Draw(script.file, &s, name, "$1", y, drawn, NULL);
    }
    (void)fprintf(script.file, "unset multiplot\n");
    PetscCall(PgScriptEnd(&script));
  }
  PetscCall(PetscFree(drawn));
  PetscCall(SeriesDestroy(&s));
  PetscFunctionReturn(0);
}

static PetscErrorCode Windows(PgPlot plot, const PgPlotSource *source, const char table[])
{
  static const char *const by[2]     = {"solver", NULL};
  static const char *const column[3] = {"last_step", "iterations", "time_per_unknown"};
  Series                   s;
  PetscInt                *drawn;
  PgScript                 script;
  char                     name[256];

  PetscFunctionBeginUser;
  PetscCall(SeriesCreate(source, table, by, "", &s));
  PetscCall(PetscMalloc1(s.count, &drawn));
  PetscCall(PetscSNPrintf(name, sizeof name, "%s-stepping", source->stem));
  PetscCall(WriteSeries(plot, source, table, &s, name, 3, column, drawn));
  if (Sum(s.count, drawn)) {
    PetscCall(PgScriptBegin(plot, name, 820.0, 640.0, PETSC_FALSE, &script));
    PetscCall(PgScriptPicture(&script));
    (void)fprintf(script.file, "set multiplot layout 2,1\nset key outside right\nset lmargin 10\nset rmargin 24\n");
    Style(script.file, "", "iterations of a solve", PETSC_FALSE, PETSC_TRUE);
    (void)fprintf(script.file, "set format y '%%g'\n");
    Draw(script.file, &s, name, "$1", "$2 > 0 ? $2 : NaN", drawn, NULL);
    (void)fprintf(script.file, "set xlabel 'fluid step (end of the window)'\nset ylabel 'time [us per unknown]'\n");
    Draw(script.file, &s, name, "$1", "$3 > 0 ? $3 : NaN", drawn, NULL);
    (void)fprintf(script.file, "unset multiplot\n");
    PetscCall(PgScriptEnd(&script));
  }
  PetscCall(PetscFree(drawn));
  PetscCall(SeriesDestroy(&s));
  PetscFunctionReturn(0);
}

/* Tables are told apart by their columns. */
PetscErrorCode PgPlotStudy(PgPlot plot, const PgPlotSource *source)
{
  const PetscInt before = plot->folder.scripts.count;
  PgPlotText     solver, sweeps, operators, pressure, window, variant;

  PetscFunctionBeginUser;
  PetscCall(PgPlotSourceColumn(source, "study", "solver", solver));
  PetscCall(PgPlotSourceColumn(source, "study", "error_relative", sweeps));
  PetscCall(PgPlotSourceColumn(source, "study", "gradient_error", operators));
  PetscCall(PgPlotSourceColumn(source, "study", "pressure_error", pressure));
  PetscCall(PgPlotSourceColumn(source, "windows", "first_step", window));
  PetscCall(PgPlotSourceColumn(source, "cost", "variant", variant));
  if (window[0]) {
    PetscCall(Windows(plot, source, "windows"));
  } else if (solver[0]) {
    PetscCall(Residuals(plot, source, "study"));
    PetscCall(Growth(plot, source, "study"));
  }
  if (sweeps[0]) PetscCall(Sweeps(plot, source));
  if (operators[0] || pressure[0]) PetscCall(Orders(plot, source));
  if (variant[0]) PetscCall(Cost(plot, source));
  if (plot->folder.scripts.count == before)
    PetscCall(PetscPrintf(plot->comm, "note: %s has nothing that porograin-plot can draw\n", source->file));
  PetscFunctionReturn(0);
}
