/* What the verification of the water shares: a run of a registered case from options, means over the rows of its lattice,
   and lines of the verification table. */
#pragma once

#include "verify.h"
#include <string.h>
#include <porograin/simulation.h>

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
