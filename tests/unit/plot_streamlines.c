/* The field between the discs and the lines along it. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <porograin/plot.h>

#define OK(call) assert_int_equal((int)(call), 0)

enum { COLUMNS = 24, ROWS = 20, COUNT = COLUMNS * ROWS };
static PetscReal x[COUNT], y[COUNT], r[COUNT], w[2 * COUNT];

/* A triangular packing of two sizes around the origin, and the field (a x + b y + c, d x + e y + f) on it. */
static void Fill(const PetscReal a[6])
{
  for (PetscInt k = 0; k < COUNT; k++) {
    const PetscInt i = k % COLUMNS, j = k / COLUMNS;
    r[k]         = k % 3 ? 2.0 : 1.8;
    x[k]         = 4.0 * ((PetscReal)i + 0.5 * (PetscReal)(j % 2)) - 2.0 * COLUMNS;
    y[k]         = 2.0 * PetscSqrtReal(3.0) * (PetscReal)j - PetscSqrtReal(3.0) * ROWS;
    w[2 * k]     = a[0] * x[k] + a[1] * y[k] + a[2];
    w[2 * k + 1] = a[3] * x[k] + a[4] * y[k] + a[5];
  }
}

static void test_uniform(void **state)
{
  const PetscReal a[6] = {0, 0, 0.3, 0, 0, -0.7};
  PgPlotGrid      grid;
  PetscInt        inside = 0;

  (void)state;
  Fill(a);
  OK(PgPlotGridCreate(COUNT, x, y, r, w, 1.3, 20000, &grid));
  assert_true(grid.nx * grid.ny < 22000);
  for (PetscInt k = 0; k < grid.nx * grid.ny; k++) {
    if (!isfinite(grid.u[k])) continue;
    inside++;
    /* a mean of equal values: rounding of some twenty terms */
    assert_true(PetscAbsReal(grid.u[k] - 0.3) < 1e-14 && PetscAbsReal(grid.v[k] + 0.7) < 1e-14);
  }
  /* the packing takes 92 of 98 by 67 of 72, less gaps along its ragged sides; nothing is left out inside */
  assert_true(inside > 0.85 * grid.nx * grid.ny && inside < grid.nx * grid.ny);
  for (PetscReal s = -25.0; s < 25.0; s += 0.7) {
    const PetscReal at[2] = {s, -0.8 * s}, far[2] = {s, 60.0};
    PetscReal       value[2];
    assert_true(PgPlotGridSample(&grid, at, value));
    assert_false(PgPlotGridSample(&grid, far, value));
  }
  OK(PgPlotGridDestroy(&grid));
}

static PetscReal Nearest(const PgPlotLines *lines, PetscInt line, const PetscReal at[2])
{
  PetscReal least = PETSC_MAX_REAL;

  for (PetscInt k = 0; k < lines->ptr[lines->lines]; k++) {
    const PetscReal dx = lines->point[2 * k] - at[0], dy = lines->point[2 * k + 1] - at[1];
    if (k >= lines->ptr[line] && k < lines->ptr[line + 1]) continue;
    least = PetscMin(least, PetscSqrtReal(dx * dx + dy * dy));
  }
  return least;
}

static void test_spacing(void **state)
{
  const PetscReal a[6] = {0.01, 0.004, 1.0, -0.006, 0.003, 0.4}, separation = 5.0;
  PgPlotGrid      grid;
  PgPlotLines     lines;

  (void)state;
  Fill(a);
  OK(PgPlotGridCreate(COUNT, x, y, r, w, 1.5, 40000, &grid));
  OK(PgPlotStreamlines(&grid, separation, &lines));
  assert_true(lines.lines > 5);
  for (PetscInt l = 0; l < lines.lines; l++)
    for (PetscInt k = lines.ptr[l]; k < lines.ptr[l + 1]; k++) {
      const PetscReal *p = &lines.point[2 * k], *q = p - 2;
      PetscReal        v[2];
      assert_true(Nearest(&lines, l, p) >= 0.5 * separation);
      assert_true(PgPlotGridSample(&grid, p, v));
      /* downstream: along the flow, not against it */
      if (k > lines.ptr[l]) assert_true((p[0] - q[0]) * v[0] + (p[1] - q[1]) * v[1] > 0.0);
    }
  /* no hole: a place inside has a line within two separations (short lines are left out) */
  for (PetscReal px = -40.0; px < 40.0; px += 3.0)
    for (PetscReal py = -28.0; py < 28.0; py += 3.0) {
      const PetscReal at[2] = {px, py};
      assert_true(Nearest(&lines, lines.lines, at) < 2.0 * separation);
    }
  OK(PgPlotLinesDestroy(&lines));
  OK(PgPlotGridDestroy(&grid));
}

/* The lines of a rotation are circles. */
static void test_circles(void **state)
{
  const PetscReal a[6] = {0, -0.2, 0, 0.2, 0, 0};
  PgPlotGrid      grid;
  PgPlotLines     lines;
  PetscReal       longest = 0.0;

  (void)state;
  Fill(a);
  OK(PgPlotGridCreate(COUNT, x, y, r, w, 1.5, 40000, &grid));
  OK(PgPlotStreamlines(&grid, 5.0, &lines));
  for (PetscInt l = 0; l < lines.lines; l++) {
    const PetscReal *first  = &lines.point[2 * lines.ptr[l]];
    const PetscReal  radius = PetscSqrtReal(first[0] * first[0] + first[1] * first[1]);
    PetscReal        length = 0.0;
    if (radius > 25.0) continue; /* nearer to the edge the means see one side only */
    for (PetscInt k = lines.ptr[l] + 1; k < lines.ptr[l + 1]; k++) {
      const PetscReal *p = &lines.point[2 * k];
      length += PetscSqrtReal((p[0] - p[-2]) * (p[0] - p[-2]) + (p[1] - p[-1]) * (p[1] - p[-1]));
      /* the weighted means see a packing that is not quite symmetric: a tenth of a radius of 2 in one turn */
      assert_true(PetscAbsReal(PetscSqrtReal(p[0] * p[0] + p[1] * p[1]) - radius) < 0.2);
    }
    longest = PetscMax(longest, length / radius);
    /* a line that has closed does not go round again: one turn, or two separations, and half of one more */
    assert_true(length < PetscMax(2.0 * PETSC_PI * radius, 10.0) + 2.5);
  }
  assert_true(longest > 0.9 * 2.0 * PETSC_PI);
  OK(PgPlotLinesDestroy(&lines));
  OK(PgPlotGridDestroy(&grid));
}

static void test_still(void **state)
{
  const PetscReal a[6] = {0};
  PgPlotGrid      grid;
  PgPlotLines     lines;

  (void)state;
  Fill(a);
  OK(PgPlotGridCreate(COUNT, x, y, r, w, 1.5, 40000, &grid));
  OK(PgPlotStreamlines(&grid, 5.0, &lines));
  assert_int_equal((int)lines.lines, 0);
  OK(PgPlotLinesDestroy(&lines));
  OK(PgPlotGridDestroy(&grid));
}

int main(int argc, char *argv[])
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_uniform), cmocka_unit_test(test_spacing),
                                     cmocka_unit_test(test_circles), cmocka_unit_test(test_still)};
  int                     failed;

  if (PgInitialize(&argc, &argv, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
