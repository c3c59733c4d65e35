/* Pieces of pictures of discs: axes, colour bars, the discs. */
#include "plotimpl.h"

#define MARGIN 0.02

/* On each side of the axes [mm]. */
PetscReal PgPlotMargin(const PetscReal low[2], const PetscReal high[2])
{
  return MARGIN * PetscMax(high[0] - low[0], high[1] - low[1]);
}

/* Tics of an axis at the multiples of `step`: how many, and the characters of the longest number. */
static PetscInt Tics(const PetscReal low[2], const PetscReal high[2], int axis, PetscReal step, PetscInt *longest)
{
  const PetscReal margin = PgPlotMargin(low, high);
  PetscInt        n      = 0;

  *longest = 0;
  for (PetscReal k = PetscCeilReal((low[axis] - margin) / step); k * step <= high[axis] + margin; k += 1.0) {
    char text[64];
    (void)snprintf(text, sizeof text, "%g", (double)(k * step)); /* as gnuplot writes it */
    *longest = PetscMax(*longest, (PetscInt)strlen(text));
    n++;
  }
  return n;
}

/* Between two tics: the same on both axes, but where the shorter would have less than two, or where numbers below it
   would touch each other: then more, as long as there are two. */
PetscReal PgPlotTicStep(const PetscReal low[2], const PetscReal high[2], int axis)
{
  const PetscReal longest = PetscMax(high[0] - low[0], high[1] - low[1]);
  PetscReal       step;
  PetscInt        characters, ignored;

  /* a third is rounded to less than half */
  step = PetscMin(PgPlotRound(longest / 5.0), PgPlotRound((high[axis] - low[axis]) / 3.0));
  while (axis == 0) {
    const PetscReal next = PgPlotRound(2.1 * step); /* 1, 2, 5, 10 */
    (void)Tics(low, high, axis, step, &characters);
    if (PG_PLOT_SHEET * step >= longest * PG_PLOT_CHARACTER * (PetscReal)(characters + 1)) break;
    if (Tics(low, high, axis, next, &ignored) < 2) break;
    step = next;
  }
  return step;
}

PetscInt PgPlotTicLength(const PetscReal low[2], const PetscReal high[2], int axis)
{
  PetscInt characters;

  (void)Tics(low, high, axis, PgPlotTicStep(low, high, axis), &characters);
  return characters;
}

/* Axes in mm, the same scale on both, `low` to `high` and a margin. */
void PgPlotAxes(FILE *f, const PetscReal low[2], const PetscReal high[2])
{
  const PetscReal margin = PgPlotMargin(low, high);

  (void)fprintf(f,
                "set size ratio -1\nset xrange [%.5g:%.5g]\nset yrange [%.5g:%.5g]\nset tics out nomirror\n"
                "set xtics %.3g\nset ytics %.3g\nset border 3 lc rgb '#666666'\n",
                (double)(low[0] - margin), (double)(high[0] + margin), (double)(low[1] - margin),
                (double)(high[1] + margin), (double)PgPlotTicStep(low, high, 0), (double)PgPlotTicStep(low, high, 1));
}

const char *PgPlotUnit(const PgPlotField *field) { return strcmp(field->unit, "1") ? field->unit : "–"; }

/* Discs coloured by a column, in a liquid walls grey and bodies darker, as column 4 tells. Where a colour is white, few
   discs get an outline. */
void PgPlotDrawDiscs(FILE *f, const char data[], PetscInt column, PetscInt discs, PetscBool is_signed, PetscBool liquid)
{
  if (liquid) /* without a place, not without a radius: gnuplot would take one of its own */
    (void)fprintf(f,
                  "plot %s using ($4 > 0 ? $1 : NaN):2:3:($4 > 1 ? 0x808080 : 0xb8b8b8) with circles lc rgb variable "
                  "fs solid 1.0 noborder notitle, \\\n"
                  "  %s using ($4 > 0 ? NaN : $1):2:3:%d with circles lc palette fs solid 1.0 noborder notitle\n",
                  data, data, (int)column);
  else
    (void)fprintf(f, "plot %s using 1:2:3:%d with circles lc palette fs solid 1.0 %s notitle\n", data, (int)column,
                  is_signed && discs <= 20000 ? "border lc rgb '#b4b4b4'" : "noborder");
}

PgPlotBarLabels PgPlotBarLabelsOf(const PgPlotRange *range, PetscReal step)
{
  const PetscReal most   = PetscMax(PetscAbsReal(range->low), PetscAbsReal(range->high));
  const int       finest = (int)PetscFloorReal(PetscLog10Real(step) + 1e-9);
  const int       first  = most > 0.0 ? (int)PetscFloorReal(PetscLog10Real(most)) : finest;
  PgPlotBarLabels labels;
  char            text[2][64];

  labels.step = step;
  if (first < 6 && finest > -5)
    (void)snprintf(labels.format, sizeof labels.format, "%%.%df", PetscMax(0, -finest));
  else
    (void)snprintf(labels.format, sizeof labels.format, "%%.%de", PetscMax(0, first - finest));
  for (int end = 0; end < 2; end++)
    (void)snprintf(text[end], sizeof *text, labels.format, (double)(end ? range->high : range->low)); /* NOLINT */
  labels.length = (PetscInt)PetscMax(strlen(text[0]), strlen(text[1]));
  return labels;
}

void PgPlotLabelBar(FILE *file, const PgPlotRange *range, PetscReal step)
{
  const PgPlotBarLabels labels = PgPlotBarLabelsOf(range, step);

  if (PgPlotRangeIsZero(range)) (void)fprintf(file, "unset colorbox\n");
  (void)fprintf(file, "set cbtics %.5g\nset format cb '%s'\n", (double)labels.step, labels.format);
}

/* Size of the axes of a picture, whose longer side has `longest` pixels. */
void PgPlotPixels(const PetscReal low[2], const PetscReal high[2], PetscReal longest, PetscReal pixels[2])
{
  const PetscReal margin = 2.0 * PgPlotMargin(low, high);
  const PetscReal width = high[0] - low[0] + margin, height = high[1] - low[1] + margin;

  pixels[0] = PetscMax(120.0, longest * width / PetscMax(width, height));
  pixels[1] = PetscMax(120.0, longest * height / PetscMax(width, height));
}
