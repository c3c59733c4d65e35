/* What can be drawn of a snapshot. A new field is a line in the table. */
#include "plotimpl.h"

static PetscReal First(const PetscReal row[]) { return row[0]; }
static PetscReal Magnitude(const PetscReal row[]) { return PetscSqrtReal(row[0] * row[0] + row[1] * row[1]); }
static PetscReal MeanCompression(const PetscReal s[]) { return -0.5 * (s[0] + s[3]); }

/* First those of Figs. 6, 7, 9, 10 of Li, Chu & Sheng (2007), (a) to (g). */
static const PgPlotField fields[] = {
    {"effective_strain", "effective strain", "1", "effective_strain", 1, 1.0, First, PETSC_FALSE, PG_PLOT_DISCS},
    {"volumetric_strain", "volumetric strain", "1", "volumetric_strain", 1, 1.0, First, PETSC_TRUE, PG_PLOT_DISCS},
    {"rotation", "rotation", "rad", "rotation", 1, 1.0, First, PETSC_TRUE, PG_PLOT_DISCS},
    {"porosity", "porosity", "1", "porosity", 1, 1.0, First, PETSC_FALSE, PG_PLOT_DISCS},
    {"pressure", "pressure", "kPa", "pressure", 1, 1e-3, First, PETSC_FALSE, PG_PLOT_DISCS},
    {"streamlines", "streamlines of w = n(u - v)", "mm/s", "relative_velocity", 2, 1e3, Magnitude, PETSC_FALSE,
     PG_PLOT_STREAMLINES},
    {"relative_speed", "magnitude of w = n(u - v)", "mm/s", "relative_velocity", 2, 1e3, Magnitude, PETSC_FALSE,
     PG_PLOT_CONTOURS},
    {"speed", "speed of the discs", "mm/s", "velocity", 2, 1e3, Magnitude, PETSC_FALSE, PG_PLOT_DISCS},
    {"fluid_speed", "speed of the water", "mm/s", "fluid_velocity", 2, 1e3, Magnitude, PETSC_FALSE, PG_PLOT_DISCS},
    {"angular_velocity", "angular velocity", "rad/s", "angular_velocity", 1, 1.0, First, PETSC_TRUE, PG_PLOT_DISCS},
    {"coordination_number", "contacts", "1", "coordination_number", 1, 1.0, First, PETSC_FALSE, PG_PLOT_DISCS},
    {"mean_stress", "mean contact stress, compression > 0", "kPa", "stress", 4, 1e-3, MeanCompression, PETSC_TRUE,
     PG_PLOT_DISCS},
    {"displacement", "displacement", "mm", "displacement", 2, 1e3, Magnitude, PETSC_FALSE, PG_PLOT_DISCS},
    {"density", "density", "kg/m³", "density", 1, 1.0, First, PETSC_FALSE, PG_PLOT_DISCS},
};

/* Of particles of a liquid: all that they have. */
static const PgPlotField of_liquid[] = {
    {"speed", "speed of the liquid", "mm/s", "velocity", 2, 1e3, Magnitude, PETSC_FALSE, PG_PLOT_DISCS},
    {"pressure", "pressure", "kPa", "pressure", 1, 1e-3, First, PETSC_FALSE, PG_PLOT_DISCS},
    {"density", "density", "kg/m³", "density", 1, 1.0, First, PETSC_FALSE, PG_PLOT_DISCS},
};

const PgPlotField *PgPlotLiquidFieldAt(PetscInt index)
{
  return index >= 0 && index < (PetscInt)(sizeof of_liquid / sizeof *of_liquid) ? &of_liquid[index] : NULL;
}

const PgPlotField *PgPlotFieldIn(const PgPlotSource *source, const PgPlotField *field)
{
  if (source->mesh) return PgPlotMeshFieldFind(field->name);
  for (PetscInt f = 0; source->liquid && PgPlotLiquidFieldAt(f); f++)
    if (!strcmp(PgPlotLiquidFieldAt(f)->name, field->name)) return PgPlotLiquidFieldAt(f);
  return field;
}

const PgPlotField *PgPlotFieldAt(PetscInt index)
{
  return index >= 0 && index < (PetscInt)(sizeof fields / sizeof *fields) ? &fields[index] : NULL;
}

const PgPlotField *PgPlotFieldFind(const char name[])
{
  if (!strcmp(name, "velocity")) name = "speed"; /* as the dataset is called */
  for (size_t i = 0; i < sizeof fields / sizeof *fields; i++)
    if (!strcmp(fields[i].name, name)) return &fields[i];
  return NULL;
}

PetscErrorCode PgPlotFieldIsThere(const PgPlotSource *source, PetscInt snapshot, const PgPlotField *field,
                                  PetscBool *there)
{
  char path[256];

  PetscFunctionBeginUser;
  *there = PETSC_FALSE;
  field  = PgPlotFieldIn(source, field);
  if (!field) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(path, sizeof path, "/snapshots/%06" PetscInt_FMT "/%s", snapshot, field->dataset));
  PetscCall(PgPlotSourceHas(source, path, there));
  PetscFunctionReturn(0);
}

/* The window of one coordinate: without the discs that are further out than 12 % of the width of 98 % of them. */
static PetscErrorCode Window(PetscInt n, const PetscReal x[], const PetscReal r[], PetscReal *low, PetscReal *high)
{
  PetscReal *sorted, first, last;
  PetscInt   m = 0;

  PetscFunctionBeginUser;
  *low  = PETSC_MAX_REAL;
  *high = PETSC_MIN_REAL;
  PetscCall(PetscMalloc1(n, &sorted));
  for (PetscInt i = 0; i < n; i++)
    if (isfinite(x[i])) sorted[m++] = x[i];
  if (m) {
    PetscCall(PetscSortReal(m, sorted));
    first = sorted[m / 100];
    last  = sorted[m - 1 - m / 100];
    for (PetscInt i = 0; i < n; i++) {
      if (!isfinite(x[i]) || !isfinite(r[i])) continue;
      if (x[i] < first - 0.12 * (last - first) - r[i] || x[i] > last + 0.12 * (last - first) + r[i]) continue;
      *low  = PetscMin(*low, x[i] - r[i]);
      *high = PetscMax(*high, x[i] + r[i]);
    }
  }
  PetscCall(PetscFree(sorted));
  PetscFunctionReturn(0);
}

PetscBool PgPlotDiscsInView(const PgPlotDiscs *d, PetscInt i)
{
  return (PetscBool)(d->x[i] > d->low[0] && d->x[i] < d->high[0] && d->y[i] > d->low[1] && d->y[i] < d->high[1]);
}

static PetscErrorCode View(PgPlotDiscs *discs)
{
  PetscFunctionBeginUser;
  PetscCall(Window(discs->count, discs->x, discs->r, &discs->low[0], &discs->high[0]));
  PetscCall(Window(discs->count, discs->y, discs->r, &discs->low[1], &discs->high[1]));
  discs->outside = 0;
  for (PetscInt i = 0; i < discs->count; i++) discs->outside += !PgPlotDiscsInView(discs, i);
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotDiscsRead(const PgPlotSource *source, PetscInt snapshot, PgPlotDiscs *discs)
{
  PetscReal *position, *radius;
  PetscInt   n = -1;

  PetscFunctionBeginUser;
  discs->kind = NULL;
  if (source->mesh) {
    PetscCall(PgPlotMeshRead(source, snapshot, discs));
    PetscFunctionReturn(0);
  }
  PetscCall(PgPlotSourceSnapshot(source, snapshot, "position", 2, &n, &position));
  PetscCall(PgPlotSourceSnapshot(source, snapshot, "radius", 1, &n, &radius));
  if (source->liquid) PetscCall(PgPlotSourceSnapshot(source, snapshot, "kind", 1, &n, &discs->kind));
  discs->count = n;
  PetscCall(PetscMalloc3(n, &discs->x, n, &discs->y, n, &discs->r));
  for (PetscInt i = 0; i < n; i++) {
    discs->x[i] = 1e3 * position[2 * i];
    discs->y[i] = 1e3 * position[2 * i + 1];
    discs->r[i] = 1e3 * radius[i];
  }
  PetscCall(View(discs));
  PetscCall(PetscFree(position));
  PetscCall(PetscFree(radius));
  if (!(discs->high[0] > discs->low[0]) || !(discs->high[1] > discs->low[1])) {
    PetscCall(PgPlotDiscsDestroy(discs));
    PetscCall(PgReport(PETSC_COMM_SELF, "result file '%s': snapshot %" PetscInt_FMT " has no discs to draw",
                       source->file, snapshot));
    PetscFunctionReturn(PETSC_ERR_FILE_UNEXPECTED);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotDiscsDestroy(PgPlotDiscs *discs)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(discs->x, discs->y, discs->r));
  PetscCall(PetscFree(discs->kind));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotFieldRead(const PgPlotSource *source, PetscInt snapshot, const PgPlotField *field,
                               const PgPlotDiscs *discs, PetscReal **value)
{
  PetscReal *rows;
  PetscInt   n = discs->count;

  PetscFunctionBeginUser;
  if (source->mesh) {
    PetscCall(PgPlotMeshValues(source, snapshot, field, value));
    PetscFunctionReturn(0);
  }
  PetscCall(PgPlotSourceSnapshot(source, snapshot, field->dataset, field->columns, &n, &rows));
  PetscCall(PetscMalloc1(n, value));
  for (PetscInt i = 0; i < n; i++)
    (*value)[i] = discs->kind && discs->kind[i] > 0.0 ? (PetscReal)NAN
                                                      : field->scale * field->value(&rows[field->columns * i]);
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(0);
}

/* Where to cut sorted values off at the upper end. */
static PetscReal Cut(PetscInt n, const PetscReal sorted[], PetscReal clip)
{
  const PetscReal middle = sorted[n / 2], most = sorted[n - 1];
  const PetscReal rest = sorted[PetscMin(n - 1, (PetscInt)((1.0 - clip) * (PetscReal)n))];

  /* where all but a few are 0, or differ from it by round-off, the few are what is to be seen */
  return most - middle > 1.5 * (rest - middle) && rest - middle > 1e-6 * (most - middle) ? rest : most;
}

PetscErrorCode PgPlotRangeAdd(PetscInt count, const PetscReal value[], PetscBool is_signed, PetscReal clip,
                              PgPlotRange *range)
{
  PetscReal *v, high;
  PetscInt   n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(count, &v));
  for (PetscInt i = 0; i < count; i++) {
    if (!isfinite(value[i])) continue;
    range->min = PetscMin(range->min, value[i]);
    range->max = PetscMax(range->max, value[i]);
    v[n++]     = is_signed ? PetscAbsReal(value[i]) : value[i];
  }
  if (n) {
    PetscCall(PetscSortReal(n, v));
    high        = Cut(n, v, clip);
    range->high = PetscMax(range->high, high);
    for (PetscInt i = 0; i < n / 2; i++) { /* the lower end is the upper end of the negatives */
      const PetscReal swap = v[i];
      v[i]                 = -v[n - 1 - i];
      v[n - 1 - i]         = -swap;
    }
    if (n % 2) v[n / 2] = -v[n / 2];
    range->low = PetscMin(range->low, is_signed ? -high : -Cut(n, v, clip));
  }
  PetscCall(PetscFree(v));
  PetscFunctionReturn(0);
}

PetscBool PgPlotRangeIsZero(const PgPlotRange *range) { return (PetscBool)(range->min == 0.0 && range->max == 0.0); }

void PgPlotRangeFinish(PetscBool is_signed, PgPlotRange *range)
{
  PetscReal least;

  if (!(range->low <= range->high)) { /* no values */
    range->low = range->high = 0.0;
    range->min = range->max = (PetscReal)NAN;
  }
  /* a scale that begins near 0 begins at 0 */
  if (!is_signed && range->low > 0.0 && range->low < 0.2 * range->high) range->low = 0.0;
  /* gnuplot wants some width; so do its five digits on the axis */
  least = 1e-4 * PetscMax(PetscAbsReal(range->low), PetscAbsReal(range->high));
  if (range->high - range->low > least && range->high - range->low > 1e-12) return;
  least = PetscMax(least, 1e-9);
  range->high += least;
  if (is_signed || range->low != 0.0) range->low -= least;
}

PetscReal PgPlotRound(PetscReal x)
{
  const PetscReal ten = PetscPowReal(10.0, PetscFloorReal(PetscLog10Real(x))), m = x / ten;

  return ten * (m < 1.5 ? 1.0 : (m < 3.5 ? 2.0 : (m < 7.5 ? 5.0 : 10.0)));
}
