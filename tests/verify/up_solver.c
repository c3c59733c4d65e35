/* ranks: 1 2 */
/* The solver of the continuum: iterations do not depend on the size of cells, for both elements, with water that drains
   and water that does not, with a skeleton near incompressibility too; what it finds is what a direct solver finds. */
#include <porograin/cases.h>
#include "verify.h"

static PetscMPIInt ranks;

#define DIRECT "-up_ksp_type preonly -up_pc_type lu -up_pc_factor_mat_solver_type mumps "

/* Iterations of the last of two steps, and the settlement. */
static PetscInt Run(const char name[], const char options[], PetscReal *settlement)
{
  PgFemStats stats;
  PetscReal  dt, end;
  PgFem      fem;
  PgUp       up;

  CHECK(PetscOptionsClear(NULL));
  CHECK(PetscOptionsInsertString(NULL, options));
  CHECK(PgUpCreate(PETSC_COMM_WORLD, name, &up));
  CHECK(PgUpSetUp(up));
  CHECK(PgUpGetFem(up, &fem));
  CHECK(PgUpGetTimes(up, &dt, &end));
  for (int k = 0; k < 2; k++) CHECK(PgFemStep(fem, dt));
  CHECK(PgUpGetSettlement(up, settlement));
  CHECK(PgFemGetStats(fem, &stats));
  assert_true(stats.reason > 0 && stats.residual < 1e-9); /* ten times the tolerance asked for */
  CHECK(PgUpDestroy(&up));
  return stats.iterations;
}

static void Growth(const char name[], const char what[], const char options[], PetscInt coarsest)
{
  PetscInt  iterations[3] = {0, 0, 0};
  PetscReal settlement, direct;
  char      all[512], line[256];

  for (int k = 0; k < 3; k++) {
    const PetscInt n = coarsest << k;
    (void)snprintf(all, sizeof all, "-up_cells %d,%d %s", (int)n, (int)n, options);
    iterations[k] = Run(name, all, &settlement);
    if (k != 1) continue;
    (void)snprintf(all, sizeof all, "-up_cells %d,%d " DIRECT "%s", (int)n, (int)n, options);
    (void)Run(name, all, &direct);
    (void)snprintf(line, sizeof line, "%s: settlement over that of a direct solver, %d x %d", what, (int)n, (int)n);
    /* relative residual 1e-10, times the condition that is left after preconditioning, some 10 */
    VerifyValue(name, line, 1.0, settlement / direct, 0.0, 1e-7, "tolerance of the solver 1e-10");
  }
  (void)snprintf(line, sizeof line, "%s: iterations with %d, %d, %d cells across: %d, %d and", what, (int)coarsest,
                 (int)(2 * coarsest), (int)(4 * coarsest), (int)iterations[0], (int)iterations[1]);
  /* BoomerAMG itself grows a little */
  VerifyRange(name, line, 1.0, 1.35 * (PetscReal)iterations[0] + 2.0, (PetscReal)iterations[2],
              "16 times the unknowns: at most a third more and 2");
}

static void Iterations(void **state)
{
  (void)state;
  Growth("up_footing", "undrained, Q1-Q1", "", 16);
  if (ranks > 1) return;
  Growth("up_footing", "undrained, Q2-Q1", "-up_element q2q1", 12);
  Growth("up_footing", "undrained, nu 0.48, Q1-Q1", "-up_poisson 0.48", 16);
  Growth("up_footing", "undrained, nu 0.4999, Q1-Q1", "-up_poisson 0.4999", 16);
  Growth("up_footing", "undrained, nu 0.4999, Q2-Q1", "-up_poisson 0.4999 -up_element q2q1", 8);
  Growth("up_footing", "draining, Q1-Q1", "-up_footing_drained -up_permeability 1e-12", 16);
  Growth("up_mandel", "draining, Q1-Q1, plate", "", 16);
}

/* Long cells are hard for multigrid of the displacements, not for the rest. */
static void LongCells(void **state)
{
  PetscReal settlement, direct;
  PetscInt  iterations;

  (void)state;
  if (ranks > 1) skip();
  iterations = Run("up_footing", "-up_cells 160,16", &settlement);
  VerifyReport("up_footing", "undrained, cells of 1:10, 160 x 16: iterations", (PetscReal)iterations,
               "multigrid for the displacements, the default");
  iterations = Run(
      "up_footing",
      "-up_cells 160,16 -up_fieldsplit_u_pc_type cholesky -up_fieldsplit_u_pc_factor_mat_solver_type mumps", &direct);
  VerifyRange("up_footing", "undrained, cells of 1:10, 160 x 16, displacements factorised: iterations", 1.0, 22.0,
              (PetscReal)iterations, "as with squares: 17, and as much more as a fourfold mesh");
  VerifyValue("up_footing", "undrained, cells of 1:10: settlement over that with displacements factorised", 1.0,
              settlement / direct, 0.0, 1e-7, "tolerance of the solver 1e-10");
}

/* The other way: MINRES with a block diagonal preconditioner. */
static void Minres(void **state)
{
  PetscReal      settlement, direct;
  const PetscInt iterations = Run("up_footing",
                                  "-up_cells 24,24 -up_ksp_type minres -up_ksp_pc_side left "
                                  "-up_pc_fieldsplit_schur_fact_type diag -up_ksp_rtol 1e-12",
                                  &settlement);

  (void)state;
  (void)Run("up_footing", "-up_cells 24,24 " DIRECT, &direct);
  VerifyValue("up_footing", "MINRES, block diagonal: settlement over that of a direct solver", 1.0, settlement / direct,
              0.0, 1e-6, "tolerance in the preconditioned norm");
  VerifyReport("up_footing", "MINRES, block diagonal: iterations, 24 x 24", (PetscReal)iterations, "an alternative");
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(Iterations), cmocka_unit_test(LongCells),
                                          cmocka_unit_test(Minres)};

int main(int argc, char *argv[])
{
  int failed;

  if (PgInitialize(&argc, &argv, NULL)) return 1;
  if (MPI_Comm_size(PETSC_COMM_WORLD, &ranks)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
