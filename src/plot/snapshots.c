/* The fields of a snapshot, each in a picture of its own and all on one sheet, and films. */
#include "plotimpl.h"

/* What the pictures of a snapshot share. */
typedef struct {
  PgPlot              plot;
  const PgPlotSource *source;
  PetscInt            snapshot, fields;
  const PgPlotField  *field[PG_PLOT_FIELDS]; /* those that are there */
  PetscReal          *value[PG_PLOT_FIELDS];
  PetscInt            column[PG_PLOT_FIELDS], colours[PG_PLOT_FIELDS];
  PgPlotRange         range[PG_PLOT_FIELDS];
  PgPlotDiscs         discs;
  char                base[200], when[160];
} Sheet;

/* Header of that column in the data. */
#define KIND "  0 liquid, 1 wall, 2 body"

static PetscErrorCode When(const PgPlotSource *source, PetscReal time, char text[], size_t size)
{
  PetscReal displacement;
  PetscBool known;
  size_t    n;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(text, size, "t = %.4g s", (double)time));
  PetscCall(PgPlotDisplacement(source, time, &displacement, &known));
  n = strlen(text);
  if (known) PetscCall(PetscSNPrintf(text + n, size - n, ", displacement %.3g mm", 1e3 * (double)displacement));
  n = strlen(text);
  if (source->magnified > 1.0)
    (void)snprintf(text + n, size - n, ", drawn %g times", (double)source->magnified); /* PETSc writes "200." */
  PetscFunctionReturn(0);
}

/* x, y, r, the kind where there is a liquid, and a column for each field that is drawn as discs. */
static PetscErrorCode WriteDiscs(Sheet *s)
{
  char  name[300];
  FILE *file;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, sizeof name, "%s-discs.dat", s->base));
  PetscCall(PgPlotFolderCreateFile(&s->plot->folder, name, &file));
  (void)fprintf(file, "# %s\n# x [mm]  y [mm]  radius [mm]%s", s->when, s->discs.kind ? KIND : "");
  for (PetscInt f = 0, column = s->discs.kind ? 4 : 3; f < s->fields; f++) {
    s->column[f] = s->field[f]->drawing == PG_PLOT_DISCS ? ++column : 0;
    if (s->column[f]) (void)fprintf(file, "  %s [%s]", s->field[f]->name, s->field[f]->unit);
  }
  (void)fputc('\n', file);
  for (PetscInt i = 0; i < s->discs.count; i++) {
    (void)fprintf(file, "%.6g %.6g %.5g", (double)s->discs.x[i], (double)s->discs.y[i], (double)s->discs.r[i]);
    if (s->discs.kind) (void)fprintf(file, " %d", (int)s->discs.kind[i]);
    for (PetscInt f = 0; f < s->fields; f++)
      if (s->column[f]) (void)fprintf(file, " %.5g", (double)s->value[f][i]);
    (void)fputc('\n', file);
  }
  PetscCall(PgPlotFolderCloseFile(&s->plot->folder, name, &file));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteFlow(Sheet *s, PetscInt f)
{
  const PgPlotField *field = s->field[f];
  PetscReal         *w;
  PetscInt           n = s->discs.count;

  PetscFunctionBeginUser;
  PetscCall(PgPlotSourceSnapshot(s->source, s->snapshot, field->dataset, 2, &n, &w));
  for (PetscInt i = 0; i < 2 * n; i++) w[i] *= field->scale;
  if (field->drawing == PG_PLOT_STREAMLINES)
    PetscCall(PgPlotStreamlinesWrite(s->plot, s->base, &s->discs, w));
  else
    PetscCall(PgPlotContoursWrite(s->plot, s->base, &s->discs, w, &s->range[f], &s->colours[f]));
  PetscCall(PetscFree(w));
  PetscFunctionReturn(0);
}

/* The f-th of the fields to draw; without being asked, of a continuum or a liquid all that there are. NULL behind the last. */
static const PgPlotField *Wanted(PgPlot plot, const PgPlotSource *source, PetscInt f)
{
  if (source->mesh && !plot->fields_set) return PgPlotMeshFieldAt(f);
  if (source->liquid && !plot->fields_set) return PgPlotLiquidFieldAt(f);
  return f < plot->fields ? plot->field[f] : NULL;
}

static PetscErrorCode SheetCreate(PgPlot plot, const PgPlotSource *source, Sheet *s)
{
  const PgPlotField *field;
  char               missing[512] = "";

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(s, sizeof *s));
  s->plot     = plot;
  s->source   = source;
  s->snapshot = source->chosen;
  PetscCall(PetscStrncpy(s->base, source->stem, sizeof s->base));
  PetscCall(When(source, source->time[s->snapshot], s->when, sizeof s->when));
  PetscCall(PgPlotDiscsRead(source, s->snapshot, &s->discs));
  for (PetscInt f = 0; (field = Wanted(plot, source, f)) != NULL; f++) {
    PetscBool there;
    PetscCall(PgPlotFieldIsThere(source, s->snapshot, field, &there));
    if (!there) {
      PetscCall(PetscStrlcat(missing, missing[0] ? ", " : "", sizeof missing));
      PetscCall(PetscStrlcat(missing, field->name, sizeof missing));
      continue;
    }
    s->field[s->fields] = field = PgPlotFieldIn(source, field);
    if (field->drawing == PG_PLOT_DISCS)
      PetscCall(PgPlotFieldRead(source, s->snapshot, field, &s->discs, &s->value[s->fields]));
    s->fields++;
  }
  if (missing[0])
    PetscCall(PetscPrintf(plot->comm, "note: %s has no data for these pictures: %s\n", source->file, missing));
  if (s->discs.outside)
    PetscCall(PetscPrintf(plot->comm,
                          "note: %s: %" PetscInt_FMT " discs that have burst off lie outside of the pictures\n",
                          source->file, s->discs.outside));
  PetscFunctionReturn(0);
}

static PetscErrorCode SheetDestroy(Sheet *s)
{
  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < s->fields; f++) PetscCall(PetscFree(s->value[f]));
  PetscCall(PgPlotDiscsDestroy(&s->discs));
  PetscFunctionReturn(0);
}

enum { MOST_SVG = 2500 }; /* discs of a picture: gnuplot writes 2 to 4 kB for each */

static PetscReal BarStep(const Sheet *s, PetscInt f)
{
  const PgPlotRange *range = &s->range[f];

  if (s->field[f]->drawing != PG_PLOT_CONTOURS) return PgPlotRound((range->high - range->low) / 6.0);
  return (s->colours[f] > 12 ? 2.0 : 1.0) * range->high / (PetscReal)s->colours[f];
}

/* Width that the labels of a colour bar need [pixels]. */
static PetscReal BarWidth(const Sheet *s, PetscInt f)
{
  if (s->field[f]->drawing == PG_PLOT_STREAMLINES || PgPlotRangeIsZero(&s->range[f])) return 0.0;
  return PG_PLOT_CHARACTER * (PetscReal)PgPlotBarLabelsOf(&s->range[f], BarStep(s, f)).length;
}

static PetscErrorCode DrawField(PgScript *script, const Sheet *s, PetscInt f)
{
  const PgPlotField *field = s->field[f];
  const PgPlotRange *range = &s->range[f];
  FILE              *file  = script->file;
  char               data[256];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(data, sizeof data, "'%s-discs.dat'", s->base));
  if (field->drawing == PG_PLOT_STREAMLINES) {
    (void)fprintf(file, "unset colorbox\n");
    (void)fprintf(
        file,
        "plot %s using 1:2:3 with circles lc rgb '#e4e4e4' fs solid 1.0 noborder notitle, \\\n"
        "  '%s-streamlines.dat' using 1:2 with lines lc rgb '#1f3b73' lw 1 notitle, \\\n"
        "  '%s-arrows.dat' using 1:2 with filledcurves closed fs solid 1.0 noborder lc rgb '#1f3b73' notitle\n",
        data, s->base, s->base);
  } else if (field->drawing == PG_PLOT_CONTOURS) {
    PetscCall(PgScriptPalette(script, PETSC_FALSE, s->colours[f], range));
    PgPlotLabelBar(file, range, BarStep(s, f));
    (void)fprintf(file,
                  "plot '%s-grid.dat' using 1:2:3 with image notitle, \\\n"
                  "  '%s-contours.dat' using 1:2 with lines lc rgb '#404040' lw 0.5 notitle\n",
                  s->base, s->base);
  } else {
    PetscCall(PgScriptPalette(script, field->is_signed, 0, range));
    PgPlotLabelBar(file, range, BarStep(s, f));
    if (s->source->mesh) {
      char name[256];
      PetscCall(PetscSNPrintf(name, sizeof name, "%s-%s", s->base, field->name));
      PgPlotMeshDraw(file, name, data, s->column[f]);
    } else {
      PgPlotDrawDiscs(file, data, s->column[f], s->discs.count, field->is_signed, s->source->liquid);
    }
  }
  PetscFunctionReturn(0);
}

/* "(a) " for the fields of the paper. */
static void Letter(const PgPlotField *field, char letter[8])
{
  letter[0] = '\0';
  for (PetscInt i = 0; i < PG_PLOT_PAPER_FIELDS; i++)
    if (PgPlotFieldAt(i) == field) (void)snprintf(letter, 8, "(%c) ", (char)('a' + i));
}

/* The lines of the title: what, when (not on a sheet, which says it once), and how far the values go that the colours
   do not show. */
static void Title(FILE *file, const Sheet *s, PetscInt f, PetscBool sheet)
{
  const PgPlotField *field = s->field[f];
  const PgPlotRange *range = &s->range[f];
  const PetscBool    lines = (PetscBool)(field->drawing == PG_PLOT_STREAMLINES);
  const PetscBool    below = (PetscBool)(!lines && range->min < range->low);
  const PetscBool    above = (PetscBool)(!lines && range->max > range->high);
  char               letter[8];

  Letter(field, letter);
  (void)fprintf(file, "set title \"%s%s", letter, field->title);
  if (!lines) (void)fprintf(file, " [%s]", PgPlotUnit(field));
  if (!sheet) (void)fprintf(file, "\\n{/*0.85 %s}", s->when);
  (void)fprintf(file, "\\n{/*0.85 ");
  if (!lines && PgPlotRangeIsZero(range)) {
    (void)fprintf(file, "0 everywhere }\"\n");
    return;
  }
  if (below) (void)fprintf(file, "least %.4g", (double)range->min);
  if (above) (void)fprintf(file, "%slargest %.4g", below ? ", " : "", (double)range->max);
  (void)fprintf(file, " }\"\n");
}

static PetscErrorCode Single(Sheet *s, PetscInt f)
{
  PgScript        script;
  PetscReal       pixels[2];
  char            name[256];
  const PetscBool png_only = (PetscBool)(s->discs.count > MOST_SVG);

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, sizeof name, "%s-%s", s->base, s->field[f]->name));
  PgPlotPixels(s->discs.low, s->discs.high, 600.0, pixels);
  PetscCall(PgScriptBegin(s->plot, name, pixels[0] + 160.0 + PetscMax(60.0, BarWidth(s, f)), pixels[1] + 140.0,
                          png_only, &script));
  PetscCall(PgScriptPicture(&script));
  PgPlotAxes(script.file, s->discs.low, s->discs.high);
  (void)fprintf(script.file, "set xlabel 'x [mm]'\nset ylabel 'y [mm]'\n");
  Title(script.file, s, f, PETSC_FALSE);
  PetscCall(DrawField(&script, s, f));
  PetscCall(PgScriptEnd(&script));
  PetscFunctionReturn(0);
}

/* Places on a sheet, in pixels from its upper left corner: cells of equal size, each with room for the labels of
   its axes on the left and below, a title above, and a colour bar with its labels on the right. */
enum { LABEL = 54, LEAST_LEFT = 82, RIGHT = 44, ABOVE = 50, BELOW = 62, HEAD = 34 };
typedef struct {
  PetscInt  columns, rows;
  PetscReal left, pixels[2], bar; /* left: of the axes; bar: for its labels */
} Cells;

static PetscReal CellWidth(const Cells *c) { return c->left + c->pixels[0] + RIGHT + c->bar; }
static PetscReal CellHeight(const Cells *c) { return c->pixels[1] + ABOVE + BELOW; }

/* Width of "y [mm]" with the numbers at the tics [pixels]; of three digits the least, which the load needs as well. */
static PetscReal LeftOf(const PgPlotDiscs *discs)
{
  return PetscMax(LEAST_LEFT, LABEL + PG_PLOT_CHARACTER * (PetscReal)PgPlotTicLength(discs->low, discs->high, 1));
}

static void Place(FILE *file, PetscInt cell, const Cells *cells)
{
  const PetscReal cw = CellWidth(cells), ch = CellHeight(cells), *pixels = cells->pixels;
  const PetscReal width = cw * (PetscReal)cells->columns, height = ch * (PetscReal)cells->rows + HEAD;
  const PetscInt  row = cell / cells->columns, column = cell % cells->columns;
  const PetscReal left = cw * (PetscReal)column + cells->left, top = HEAD + ch * (PetscReal)row + ABOVE;
  const PetscReal bottom = 1.0 - (top + pixels[1]) / height;

  (void)fprintf(file,
                "set lmargin at screen %.4f\nset rmargin at screen %.4f\nset tmargin at screen %.4f\nset bmargin at "
                "screen %.4f\n",
                (double)(left / width), (double)((left + pixels[0]) / width), (double)(1.0 - top / height),
                (double)bottom);
  (void)fprintf(file, "set colorbox user origin screen %.4f,%.4f size screen %.4f,%.4f\n",
                (double)((left + pixels[0] + 10.0) / width), (double)bottom, (double)(13.0 / width),
                (double)(pixels[1] / height));
}

/* Between the tics of an axis from 0 to `most` of so many pixels: at most about five, with room between their labels. */
static PetscReal LoadTicStep(PetscReal most, PetscReal pixels)
{
  PetscReal step = 1.0;

  for (int tics = 5; most > 0.0 && tics > 1; tics--) {
    size_t longest = 0;
    step           = PgPlotRound(most / tics);
    for (PetscInt k = 1; (PetscReal)k * step <= most; k++) {
      char text[64];
      (void)snprintf(text, sizeof text, "%g", (double)((PetscReal)k * step)); /* as gnuplot writes it */
      longest = PetscMax(longest, strlen(text));
    }
    if (pixels * step >= most * PG_PLOT_CHARACTER * (PetscReal)(longest + 2)) break;
  }
  return step;
}

/* In the last cell, when it is free: where on the curve of the load the snapshot is. */
static PetscErrorCode LoadCell(const Sheet *s, PetscReal pixels, FILE *file)
{
  PetscReal displacement, *all, most = 0.0;
  PetscBool known;
  PetscInt  n;

  PetscFunctionBeginUser;
  PetscCall(PgPlotDisplacement(s->source, s->source->time[s->snapshot], &displacement, &known));
  PetscCall(PgPlotSourceHistory(s->source, "displacement", &n, &all));
  for (PetscInt i = 0; i < n; i++) most = PetscMax(most, 1e3 * all[i]);
  PetscCall(PetscFree(all));
  (void)fprintf(
      file,
      "set size noratio\nset xrange [0:*]\nset autoscale xfixmax\nset yrange [*:*]\nset xtics %.4g\n"
      "set ytics autofreq\nset title \"load [kN/m]\\n{/*0.85 }\"\nset xlabel 'displacement [mm]'\nset ylabel ''\n",
      (double)LoadTicStep(most, pixels));
  if (known)
    (void)fprintf(file, "set arrow from first %.6g,graph 0 to first %.6g,graph 1 nohead dt 2 lc rgb '#888888'\n",
                  1e3 * (double)displacement, 1e3 * (double)displacement);
  (void)fprintf(file, "plot '%s-load.dat' using 1:2 with lines lc rgb '#0072B2' notitle\n", s->source->stem);
  PetscFunctionReturn(0);
}

/* All fields in rows of four. */
static PetscErrorCode All(Sheet *s)
{
  const PetscInt  count = s->fields + (s->source->load && s->fields % 4), columns = PetscMin(4, count);
  const PetscBool png_only = (PetscBool)(s->discs.count * s->fields > MOST_SVG);
  Cells           cells    = {.columns = columns, .rows = (count + columns - 1) / columns, .bar = 40.0};
  PgScript        script;
  char            name[256], quoted[300];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, sizeof name, "%s-fields", s->base));
  cells.left = LeftOf(&s->discs);
  PgPlotPixels(s->discs.low, s->discs.high, PG_PLOT_SHEET, cells.pixels);
  for (PetscInt f = 0; f < s->fields; f++) cells.bar = PetscMax(cells.bar, BarWidth(s, f));
  PetscCall(PgScriptBegin(s->plot, name, CellWidth(&cells) * (PetscReal)columns,
                          CellHeight(&cells) * (PetscReal)cells.rows + HEAD, png_only, &script));
  PetscCall(PgScriptPicture(&script));
  (void)fprintf(script.file, "set multiplot title '%s: %s' noenhanced\n",
                PgScriptQuote(s->source->label, quoted, sizeof quoted), s->when);
  PgPlotAxes(script.file, s->discs.low, s->discs.high);
  for (PetscInt f = 0; f < count; f++) {
    Place(script.file, f, &cells);
    if (f == s->fields) {
      PetscCall(LoadCell(s, cells.pixels[0], script.file));
      break;
    }
    (void)fprintf(script.file, "set xlabel '%s'\nset ylabel '%s'\n", f + columns >= count ? "x [mm]" : "",
                  f % columns == 0 ? "y [mm]" : "");
    Title(script.file, s, f, PETSC_TRUE);
    PetscCall(DrawField(&script, s, f));
  }
  (void)fprintf(script.file, "unset multiplot\n");
  PetscCall(PgScriptEnd(&script));
  PetscFunctionReturn(0);
}

/* Nothing bursts off a mesh: its extremes are what is to be seen. */
static PetscReal Clip(PgPlot plot, const PgPlotSource *source) { return source->mesh ? 0.0 : plot->clip; }

static PetscErrorCode WriteCells(PgPlot plot, const char base[], const PgPlotDiscs *discs, const char field[],
                                 const PetscReal value[])
{
  char name[256];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, sizeof name, "%s-%s", base, field));
  PetscCall(PgPlotMeshWrite(plot, name, discs, value));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotSnapshot(PgPlot plot, const PgPlotSource *source)
{
  Sheet s;

  PetscFunctionBeginUser;
  PetscCall(SheetCreate(plot, source, &s));
  if (s.fields) PetscCall(WriteDiscs(&s));
  for (PetscInt f = 0; f < s.fields; f++) {
    const PgPlotRange none = PG_PLOT_NO_RANGE;
    s.range[f]             = none;
    if (s.field[f]->drawing != PG_PLOT_DISCS) {
      PetscCall(WriteFlow(&s, f));
      continue;
    }
    PetscCall(PgPlotRangeAdd(s.discs.count, s.value[f], s.field[f]->is_signed, Clip(plot, source), &s.range[f]));
    PgPlotRangeFinish(s.field[f]->is_signed, &s.range[f]);
    if (source->mesh) PetscCall(WriteCells(plot, s.base, &s.discs, s.field[f]->name, s.value[f]));
  }
  for (PetscInt f = 0; f < s.fields; f++) PetscCall(Single(&s, f));
  if (s.fields > 1) PetscCall(All(&s));
  PetscCall(SheetDestroy(&s));
  PetscFunctionReturn(0);
}

/* ---- film ---- */

static PetscErrorCode Frame(PgPlot plot, const PgPlotSource *source, PetscInt frame, const char base[],
                            const PgPlotField *field, PgPlotRange *range, PetscReal low[2], PetscReal high[2],
                            PetscInt *count)
{
  PgPlotDiscs discs;
  PetscReal  *value;
  char        name[300];
  FILE       *file;

  PetscFunctionBeginUser;
  PetscCall(PgPlotDiscsRead(source, frame, &discs));
  PetscCall(PgPlotFieldRead(source, frame, field, &discs, &value));
  PetscCall(PgPlotRangeAdd(discs.count, value, field->is_signed, Clip(plot, source), range));
  for (int c = 0; c < 2; c++) {
    low[c]  = PetscMin(low[c], discs.low[c]);
    high[c] = PetscMax(high[c], discs.high[c]);
  }
  PetscCall(PetscSNPrintf(name, sizeof name, "%s-%06" PetscInt_FMT ".dat", base, frame));
  PetscCall(PgPlotFolderCreateFile(&plot->folder, name, &file));
  (void)fprintf(file, "# x [mm]  y [mm]  radius [mm]%s  %s [%s]\n", discs.kind ? KIND : "", field->name, field->unit);
  for (PetscInt i = 0; i < discs.count; i++) {
    (void)fprintf(file, "%.6g %.6g %.5g ", (double)discs.x[i], (double)discs.y[i], (double)discs.r[i]);
    if (discs.kind) (void)fprintf(file, "%d ", (int)discs.kind[i]);
    (void)fprintf(file, "%.5g\n", (double)value[i]);
  }
  PetscCall(PgPlotFolderCloseFile(&plot->folder, name, &file));
  PetscCall(PetscSNPrintf(name, sizeof name, "%s-%06" PetscInt_FMT ".png", base, frame));
  PetscCall(PgPlotFolderAddPicture(&plot->folder, name));
  *count = discs.count;
  (void)snprintf(name, sizeof name, "%06lld", (long long)frame);
  if (source->mesh) PetscCall(WriteCells(plot, base, &discs, name, value));
  PetscCall(PetscFree(value));
  PetscCall(PgPlotDiscsDestroy(&discs));
  PetscFunctionReturn(0);
}

/* A length which at the size of the pictures is an even number of pixels, as video encoders want. */
static PetscReal Even(PgPlot plot, PetscReal pixels)
{
  return 2.0 * PetscFloorReal(0.5 * plot->size * pixels) / plot->size;
}

PetscErrorCode PgPlotFilm(PgPlot plot, const PgPlotSource *source)
{
  const PgPlotField *field  = PgPlotFieldIn(source, plot->film);
  PgPlotRange        range  = PG_PLOT_NO_RANGE;
  PetscReal          low[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL}, high[2] = {PETSC_MIN_REAL, PETSC_MIN_REAL}, pixels[2];
  PetscInt           count = 0;
  PetscReal          step, bar;
  PgScript           script;
  char               base[200], when[160];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(base, sizeof base, "%s-film-%s", source->stem, field->name));
  for (PetscInt i = 0; i < source->snapshots; i++)
    PetscCall(Frame(plot, source, i, base, field, &range, low, high, &count));
  PgPlotRangeFinish(field->is_signed, &range);
  step = PgPlotRound((range.high - range.low) / 6.0);
  bar  = PG_PLOT_CHARACTER * (PetscReal)PetscMax(8, PgPlotBarLabelsOf(&range, step).length);
  /* one scale and one frame for all */
  PgPlotPixels(low, high, 600.0, pixels);
  PetscCall(PgScriptBegin(plot, base, Even(plot, pixels[0] + 156.0 + bar), Even(plot, pixels[1] + 120.0), PETSC_TRUE,
                          &script));
  PgPlotAxes(script.file, low, high);
  (void)fprintf(script.file, "set xlabel 'x [mm]'\nset ylabel 'y [mm]'\n");
  PetscCall(PgScriptPalette(&script, field->is_signed, 0, &range));
  PgPlotLabelBar(script.file, &range, step);
  for (PetscInt i = 0; i < source->snapshots; i++) {
    char data[300];
    PetscCall(When(source, source->time[i], when, sizeof when));
    (void)fprintf(script.file, "set output '%s-%06d.png'\nset title \"%s [%s]\\n{/*0.85 %s%s}\"\n", base, (int)i,
                  field->title, PgPlotUnit(field), when, PgPlotRangeIsZero(&range) ? ", 0 everywhere" : "");
    PetscCall(PetscSNPrintf(data, sizeof data, "'%s-%06" PetscInt_FMT ".dat'", base, i));
    if (source->mesh) {
      char frame[300];
      PetscCall(PetscSNPrintf(frame, sizeof frame, "%s-%06" PetscInt_FMT, base, i));
      PgPlotMeshDraw(script.file, frame, data, 4);
    } else {
      PgPlotDrawDiscs(script.file, data, source->liquid ? 5 : 4, count, field->is_signed, source->liquid);
    }
  }
  PetscCall(PgScriptEnd(&script));
  PetscFunctionReturn(0);
}
