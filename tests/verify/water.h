/* What the verification of the water shares: a run of a registered case from options, means over the rows of its lattice,
   and lines of the verification table. */
#pragma once

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <porograin/simulation.h>

#define CHECK(call) assert_int_equal((call), 0)

/* ---- lines of the table: VERIFY | case | quantity | reference | computed | error | order | tolerance | reason ---- */

static inline void VerifyLine(const char what[], const char quantity[], const char reference[], const char computed[],
                              const char error[], const char order[], const char tolerance[], const char reason[])
{
  CHECK(PetscPrintf(PETSC_COMM_WORLD, "VERIFY | %s | %s | %s | %s | %s | %s | %s | %s\n", what, quantity, reference,
                    computed, error, order, tolerance, reason));
}

/* |computed - reference| <= tolerance*|reference|; a reference of 0 is compared with `scale`. */
static inline void VerifyValue(const char what[], const char quantity[], PetscReal reference, PetscReal computed,
                               PetscReal scale, PetscReal tolerance, const char reason[])
{
  const PetscReal unit = scale > 0.0 ? scale : PetscAbsReal(reference), error = PetscAbsReal(computed - reference);
  char            r[32], c[32], e[32], t[32];

  (void)snprintf(r, sizeof r, "%.6g", (double)reference);
  (void)snprintf(c, sizeof c, "%.6g", (double)computed);
  (void)snprintf(e, sizeof e, "%.2e", (double)(error / unit));
  (void)snprintf(t, sizeof t, "%.2g", (double)tolerance);
  VerifyLine(what, quantity, r, c, e, "", t, reason);
  if (!(error <= tolerance * unit))
    fail_msg("%s, %s: %.9g instead of %.9g, off by %.3g of %.3g, allowed %.3g", what, quantity, (double)computed,
             (double)reference, (double)(error / unit), (double)unit, (double)tolerance);
}

/* The order observed between every two of `count` refinements is at least expected - tolerance; each error is printed,
   the last order in the line of the table. */
static inline void VerifyOrder(const char what[], const char quantity[], PetscInt count, const PetscReal h[],
                               const PetscReal error[], PetscReal expected, PetscReal tolerance, const char reason[])
{
  PetscReal order = 0.0, least = PETSC_MAX_REAL;
  char      e[32], o[64], t[32], r[32];

  for (PetscInt k = 0; k < count; k++) {
    order = k ? PetscLogReal(error[k - 1] / error[k]) / PetscLogReal(h[k - 1] / h[k]) : 0.0;
    if (k) least = PetscMin(least, order);
    CHECK(PetscPrintf(PETSC_COMM_WORLD, "  %s, %s: h = %.4g, error %.4e, order %.3f\n", what, quantity, (double)h[k],
                      (double)error[k], (double)order));
  }
  (void)snprintf(r, sizeof r, "order %.3g", (double)expected);
  (void)snprintf(e, sizeof e, "%.2e", (double)error[count - 1]);
  (void)snprintf(o, sizeof o, "%.2f", (double)order);
  (void)snprintf(t, sizeof t, "order >= %.3g", (double)(expected - tolerance));
  VerifyLine(what, quantity, r, o, e, o, t, reason);
  if (!(least >= expected - tolerance))
    fail_msg("%s, %s: order %.3g, expected %.3g, allowed %.3g below", what, quantity, (double)least, (double)expected,
             (double)tolerance);
}

/* ---- a run ---- */

typedef struct {
  PgSimulation sim;
  PgParticles  particles;
  PgDem        dem;
  PgPore       pore;
  PetscInt     columns, rows; /* of the lattice: ids run along its rows */
} Water;

/* CG with an incomplete factorisation on each rank: enough for some hundred discs, and quick. */
#define WATER_SOLVER " -pressure_pc_type bjacobi -pressure_sub_pc_type icc -pressure_ksp_rtol 1e-10"

static inline void WaterStart(Water *w, PetscInt columns, PetscInt rows, const char format[], ...)
{
  char    options[2048];
  va_list arguments;

  va_start(arguments, format);
  (void)vsnprintf(options, sizeof options, format, arguments);
  va_end(arguments);
  CHECK(PetscOptionsClear(NULL));
  CHECK(PetscOptionsInsertString(NULL, options));
  w->columns = columns;
  w->rows    = rows;
  CHECK(PgSimulationCreate(PETSC_COMM_WORLD, &w->sim));
  CHECK(PgSimulationSetFromOptions(w->sim));
  CHECK(PgSimulationSetUp(w->sim));
  CHECK(PgSimulationGetParts(w->sim, &w->particles, NULL, &w->dem, &w->pore));
}

static inline void WaterEnd(Water *w)
{
  CHECK(PgSimulationDestroy(&w->sim));
  CHECK(PetscOptionsClear(NULL));
}

static inline PetscReal WaterTime(Water *w)
{
  PetscReal time;
  CHECK(PgSimulationGetTime(w->sim, NULL, &time, NULL));
  return time;
}

static inline void WaterRun(Water *w, PetscReal end)
{
  while (WaterTime(w) < end * (1.0 - 1e-9)) CHECK(PgSimulationStep(w->sim));
}

static inline PetscReal *WaterField(Water *w, const char name[])
{
  PgField    field;
  PetscReal *array;

  CHECK(PgParticlesFindField(w->particles, name, &field));
  if (field < 0) fail_msg("no field '%s'", name);
  CHECK(PgParticlesGetArray(w->particles, field, &array));
  return array;
}

static inline PetscInt WaterOwned(Water *w)
{
  PetscInt owned;
  CHECK(PgParticlesGetSizes(w->particles, &owned, NULL, NULL));
  return owned;
}

/* Mean of a component over each row, on every rank; spread (may be NULL) is the largest deviation from it. */
static inline void WaterRows(Water *w, const char name[], PetscInt components, PetscInt component, PetscReal mean[],
                             PetscReal *spread)
{
  const PetscReal *f     = WaterField(w, name);
  const PetscInt   owned = WaterOwned(w), *id;
  PetscReal        most  = 0.0;

  CHECK(PgParticlesGetIds(w->particles, &id));
  for (PetscInt k = 0; k < w->rows; k++) mean[k] = 0.0;
  for (PetscInt i = 0; i < owned; i++)
    mean[id[i] / w->columns] += f[components * i + component] / (PetscReal)w->columns;
  MPI_Allreduce(MPI_IN_PLACE, mean, (int)w->rows, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD);
  for (PetscInt i = 0; i < owned; i++)
    most = PetscMax(most, PetscAbsReal(f[components * i + component] - mean[id[i] / w->columns]));
  MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD);
  if (spread) *spread = most;
}

/* main() of a test program; hypre and others divide by zero in places, so no trap. */
#define WATER_MAIN(tests)                                                                                              \
  int main(int argc, char *argv[])                                                                                     \
  {                                                                                                                    \
    int failed;                                                                                                        \
    PetscCall(PgInitialize(&argc, &argv, "verification"));                                                             \
    failed = cmocka_run_group_tests(tests, NULL, NULL);                                                                \
    return PgFinalize(0) || failed;                                                                                    \
  }

enum { MOST_ROWS = 400 };
#define SQRT3             1.7320508075688772
#define TOUCHING_POROSITY (1.0 - PETSC_PI / (2.0 * SQRT3))
