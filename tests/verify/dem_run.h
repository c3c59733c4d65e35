/* What the verification of the discs shares: a run of a registered case from options. */
#pragma once

#include "verify.h"
#include <string.h>
#include <porograin/simulation.h>

#define SQRT3 1.7320508075688772

typedef struct {
  PgSimulation sim;
  PgParticles  particles;
  PgDem        dem;
  PetscReal    dt;
} Run;

static inline void RunStart(Run *run, const char format[], ...)
{
  char    options[2048];
  va_list arguments;

  va_start(arguments, format);
  (void)vsnprintf(options, sizeof options, format, arguments);
  va_end(arguments);
  CHECK(PetscOptionsClear(NULL));
  CHECK(PetscOptionsInsertString(NULL, options));
  CHECK(PgSimulationCreate(PETSC_COMM_WORLD, &run->sim));
  CHECK(PgSimulationSetFromOptions(run->sim));
  CHECK(PgSimulationSetUp(run->sim));
  CHECK(PgSimulationGetParts(run->sim, &run->particles, NULL, &run->dem, NULL));
  CHECK(PgSimulationGetTime(run->sim, NULL, NULL, &run->dt));
}

static inline void RunEnd(Run *run)
{
  CHECK(PgSimulationDestroy(&run->sim));
  CHECK(PetscOptionsClear(NULL));
}

static inline PetscReal RunTime(Run *run)
{
  PetscReal time;
  CHECK(PgSimulationGetTime(run->sim, NULL, &time, NULL));
  return time;
}

static inline void RunSteps(Run *run, PetscInt steps)
{
  for (PetscInt k = 0; k < steps; k++) CHECK(PgSimulationStep(run->sim));
}

static inline void RunUntil(Run *run, PetscReal end)
{
  while (RunTime(run) < end * (1.0 - 1e-9)) CHECK(PgSimulationStep(run->sim));
}

static inline PetscReal *RunField(Run *run, const char name[])
{
  PgField    field;
  PetscReal *array;

  CHECK(PgParticlesFindField(run->particles, name, &field));
  if (field < 0) fail_msg("no field '%s'", name);
  CHECK(PgParticlesGetArray(run->particles, field, &array));
  return array;
}

/* The values of discs 0 .. count-1 by permanent id, on every rank. Other ranks contribute 0, so the sum is exact. */
static inline void RunGet(Run *run, const char name[], PetscInt components, PetscInt count, PetscReal byid[])
{
  const PetscReal *a = RunField(run, name);
  const PetscInt  *id;
  PetscInt         owned;

  CHECK(PgParticlesGetSizes(run->particles, &owned, NULL, NULL));
  CHECK(PgParticlesGetIds(run->particles, &id));
  memset(byid, 0, sizeof(*byid) * (size_t)(count * components));
  for (PetscInt i = 0; i < owned; i++)
    for (PetscInt c = 0; c < components && id[i] < count; c++) byid[id[i] * components + c] = a[i * components + c];
  MPI_Allreduce(MPI_IN_PLACE, byid, (PetscMPIInt)(count * components), MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD);
}

/* A test program; floating-point exceptions are trapped. */
#define RUN_MAIN(tests)                                                                                                \
  int main(int argc, char *argv[])                                                                                     \
  {                                                                                                                    \
    int failed;                                                                                                        \
    PetscCall(PgInitialize(&argc, &argv, "verification"));                                                             \
    PetscCall(PetscSetFPTrap(PETSC_FP_TRAP_ON));                                                                       \
    failed = cmocka_run_group_tests(tests, NULL, NULL);                                                                \
    return PgFinalize(0) || failed;                                                                                    \
  }
