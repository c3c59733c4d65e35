/* Evenly spaced streamlines, after B. Jobard, W. Lefer, Creating evenly-spaced streamlines of arbitrary density,
   Visualization in Scientific Computing '97: new lines start beside the ones there are, and every line ends where it
   would come too near to another. */
#include "plotimpl.h"

typedef struct {
  const PgPlotGrid *grid;
  PetscReal         separation, nearest, step; /* lines start and end at those distances; step along the arc */
  PetscReal         least;                     /* speed that counts as flow */
  /* accepted points, found through bins of width `separation` */
  PetscInt   points, room, lines, line_room, bx, by;
  PetscReal *point;      /* (2) */
  PetscInt  *next, *ptr; /* next point of the bin; first point of a line */
  PetscInt  *head;
  /* the line that is being drawn: from the seed back and forth */
  PetscInt   count[2], most;
  PetscReal *trial[2]; /* (2) */
} Tracer;

static PetscInt Bin(const Tracer *t, PetscReal x, PetscReal origin, PetscInt bins)
{
  return PetscMax(0, PetscMin(bins - 1, (PetscInt)((x - origin) / t->separation)));
}

static PetscBool IsFree(const Tracer *t, const PetscReal x[2], PetscReal distance)
{
  const PetscInt bi = Bin(t, x[0], t->grid->x0, t->bx), bj = Bin(t, x[1], t->grid->y0, t->by);

  for (PetscInt j = PetscMax(0, bj - 1); j <= PetscMin(t->by - 1, bj + 1); j++)
    for (PetscInt i = PetscMax(0, bi - 1); i <= PetscMin(t->bx - 1, bi + 1); i++)
      for (PetscInt k = t->head[j * t->bx + i]; k >= 0; k = t->next[k]) {
        const PetscReal dx = t->point[2 * k] - x[0], dy = t->point[2 * k + 1] - x[1];
        if (dx * dx + dy * dy < distance * distance) return PETSC_FALSE;
      }
  return PETSC_TRUE;
}

/* Unit vector along the field; false where there is no field or no flow. */
static PetscBool Direction(const Tracer *t, const PetscReal x[2], PetscReal sign, PetscReal d[2])
{
  PetscReal w[2], speed;

  if (!PgPlotGridSample(t->grid, x, w)) return PETSC_FALSE;
  speed = PetscSqrtReal(w[0] * w[0] + w[1] * w[1]);
  if (!(speed > t->least)) return PETSC_FALSE;
  d[0] = sign * w[0] / speed;
  d[1] = sign * w[1] / speed;
  return PETSC_TRUE;
}

static PetscBool StepAlong(const Tracer *t, PetscReal sign, PetscReal x[2])
{
  static const PetscReal at[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
  PetscReal              d[2] = {0.0, 0.0}, move[2] = {0.0, 0.0};

  for (int stage = 0; stage < 4; stage++) {
    const PetscReal y[2] = {x[0] + at[stage] * t->step * d[0], x[1] + at[stage] * t->step * d[1]};
    if (!Direction(t, y, sign, d)) return PETSC_FALSE;
    move[0] += weight[stage] * d[0];
    move[1] += weight[stage] * d[1];
  }
  /* around a point of no flow the directions cancel */
  if (move[0] * move[0] + move[1] * move[1] < 0.25) return PETSC_FALSE;
  x[0] += t->step * move[0];
  x[1] += t->step * move[1];
  return PETSC_TRUE;
}

/* A line that comes back to itself has closed. Points of the last two separations do not count. */
static PetscBool HasClosed(const Tracer *t, int side, const PetscReal x[2])
{
  const PetscInt recent = (PetscInt)(2.0 * t->separation / t->step);

  for (int s = 0; s <= side; s++)
    for (PetscInt k = 0; k < t->count[s]; k += 2) {
      const PetscInt  along = s == side ? t->count[side] - k : t->count[side] + k;
      const PetscReal dx = t->trial[s][2 * k] - x[0], dy = t->trial[s][2 * k + 1] - x[1];
      if (along > recent && dx * dx + dy * dy < 0.25 * t->nearest * t->nearest) return PETSC_TRUE;
    }
  return PETSC_FALSE;
}

static void Trace(Tracer *t, const PetscReal seed[2])
{
  t->count[0] = t->count[1] = 0;
  for (int side = 0; side < 2; side++) {
    PetscReal x[2] = {seed[0], seed[1]};
    while (t->count[side] < t->most) {
      t->trial[side][2 * t->count[side]]     = x[0];
      t->trial[side][2 * t->count[side] + 1] = x[1];
      t->count[side]++;
      if (!StepAlong(t, side ? 1.0 : -1.0, x) || !IsFree(t, x, t->nearest)) break;
      if (t->count[side] % 4 == 0 && HasClosed(t, side, x)) break;
    }
  }
}

static PetscErrorCode Grow(PetscInt need, PetscInt components, PetscInt used, PetscReal **reals, PetscInt **ints)
{
  PetscReal *r;
  PetscInt  *n;

  PetscFunctionBeginUser;
  if (reals) {
    PetscCall(PetscMalloc1(components * need, &r));
    PetscCall(PetscArraycpy(r, *reals, components * used));
    PetscCall(PetscFree(*reals));
    *reals = r;
  }
  PetscCall(PetscMalloc1(need, &n));
  PetscCall(PetscArraycpy(n, *ints, used));
  PetscCall(PetscFree(*ints));
  *ints = n;
  PetscFunctionReturn(0);
}

static void Accept(Tracer *t, const PetscReal x[2])
{
  const PetscInt bin = Bin(t, x[1], t->grid->y0, t->by) * t->bx + Bin(t, x[0], t->grid->x0, t->bx);

  t->point[2 * t->points]     = x[0];
  t->point[2 * t->points + 1] = x[1];
  t->next[t->points]          = t->head[bin];
  t->head[bin]                = t->points++;
}

/* Draws the line through the seed; *accepted is false when it is too short to be looked at. */
static PetscErrorCode Draw(Tracer *t, const PetscReal seed[2], PetscBool *accepted)
{
  PetscInt more;

  PetscFunctionBeginUser;
  Trace(t, seed);
  more      = t->count[0] + t->count[1] - 1; /* the seed is in both */
  *accepted = (PetscBool)((PetscReal)more * t->step >= 2.0 * t->separation);
  if (!*accepted) PetscFunctionReturn(0);
  if (t->points + more > t->room) {
    t->room = 2 * (t->points + more);
    PetscCall(Grow(t->room, 2, t->points, &t->point, &t->next));
  }
  if (t->lines + 2 > t->line_room) {
    t->line_room = 2 * (t->lines + 2);
    PetscCall(Grow(t->line_room, 1, t->lines + 1, NULL, &t->ptr));
  }
  for (PetscInt k = t->count[0] - 1; k > 0; k--) Accept(t, &t->trial[0][2 * k]);
  for (PetscInt k = 0; k < t->count[1]; k++) Accept(t, &t->trial[1][2 * k]);
  t->lines++;
  t->ptr[t->lines] = t->points;
  PetscFunctionReturn(0);
}

/* Lines on both sides of the points of a line. */
static PetscErrorCode DrawBeside(Tracer *t, PetscInt line)
{
  const PetscInt every = PetscMax(1, (PetscInt)(0.5 * t->separation / t->step));

  PetscFunctionBeginUser;
  for (PetscInt k = t->ptr[line]; k < t->ptr[line + 1]; k += every)
    for (int side = -1; side <= 1; side += 2) {
      PetscReal d[2], seed[2];
      PetscBool accepted;
      if (!Direction(t, &t->point[2 * k], 1.0, d)) continue;
      seed[0] = t->point[2 * k] - 1.001 * side * t->separation * d[1];
      seed[1] = t->point[2 * k + 1] + 1.001 * side * t->separation * d[0];
      if (Direction(t, seed, 1.0, d) && IsFree(t, seed, t->separation)) PetscCall(Draw(t, seed, &accepted));
    }
  PetscFunctionReturn(0);
}

static PetscErrorCode Begin(const PgPlotGrid *grid, PetscReal separation, Tracer *t)
{
  const PetscReal width = (PetscReal)grid->nx * grid->step, height = (PetscReal)grid->ny * grid->step;
  PetscReal       fastest = 0.0;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(t, sizeof *t));
  t->grid       = grid;
  t->separation = PetscMax(separation, 2.0 * grid->step);
  t->nearest    = 0.5 * t->separation;
  t->step       = PetscMin(0.5 * grid->step, 0.1 * t->separation);
  t->most       = 16 + (PetscInt)(2.0 * (width + height) / t->step);
  t->bx         = 1 + (PetscInt)(width / t->separation);
  t->by         = 1 + (PetscInt)(height / t->separation);
  t->line_room  = 64;
  for (PetscInt k = 0; k < grid->nx * grid->ny; k++) {
    const PetscReal w2 = grid->u[k] * grid->u[k] + grid->v[k] * grid->v[k];
    if (w2 > fastest) fastest = w2;
  }
  t->least = 1e-9 * PetscSqrtReal(fastest); /* rounding of a field that vanishes somewhere */
  PetscCall(PetscMalloc2(2 * t->most, &t->trial[0], 2 * t->most, &t->trial[1]));
  PetscCall(PetscMalloc1(t->bx * t->by, &t->head));
  for (PetscInt b = 0; b < t->bx * t->by; b++) t->head[b] = -1;
  PetscCall(PetscMalloc1(t->line_room, &t->ptr));
  t->ptr[0] = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotStreamlines(const PgPlotGrid *grid, PetscReal separation, PgPlotLines *lines)
{
  Tracer    t;
  PetscInt  done = 0;
  PetscBool accepted;

  PetscFunctionBeginUser;
  PetscCall(Begin(grid, separation, &t));
  /* The middle first; then what no line has reached, row by row. */
  for (PetscInt k = -1; k < grid->nx * grid->ny; k++) {
    const PetscInt  node = k < 0 ? (grid->ny / 2) * grid->nx + grid->nx / 2 : k;
    const PetscInt  row = node / grid->nx, column = node % grid->nx;
    const PetscReal seed[2] = {grid->x0 + (PetscReal)column * grid->step, grid->y0 + (PetscReal)row * grid->step};
    PetscReal       d[2];
    if (!Direction(&t, seed, 1.0, d) || !IsFree(&t, seed, t.separation)) continue;
    PetscCall(Draw(&t, seed, &accepted));
    for (; done < t.lines; done++) PetscCall(DrawBeside(&t, done));
  }
  lines->lines = t.lines;
  lines->ptr   = t.ptr;
  lines->point = t.point;
  PetscCall(PetscFree2(t.trial[0], t.trial[1]));
  PetscCall(PetscFree(t.head));
  PetscCall(PetscFree(t.next));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotLinesDestroy(PgPlotLines *lines)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(lines->ptr));
  PetscCall(PetscFree(lines->point));
  PetscFunctionReturn(0);
}
