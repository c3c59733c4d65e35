/* ranks: 1 */
/* The exponent of growth that the table of solvers shows. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <porograin/study.h>

static void test_power_law(void **state)
{
  const PetscReal size[4] = {1249.0, 19999.0, 199711.0, 999697.0};
  PetscReal       count[4];

  (void)state;
  for (int i = 0; i < 4; i++) count[i] = 2.7 * pow(size[i], 0.48);
  /* logarithms of numbers to 1e6 lose about two digits */
  assert_true(fabs(PgStudyGrowth(4, size, count) - 0.48) < 1e-13);
  for (int i = 0; i < 4; i++) count[i] = 7.0;
  assert_true(fabs(PgStudyGrowth(4, size, count)) < 1e-13);
}

/* Least squares by hand for logarithms (0, 1, 2; 0, 3, 2): slope (6 - 0)/... = 1. */
static void test_least_squares(void **state)
{
  const PetscReal size[3] = {1.0, exp(1.0), exp(2.0)}, count[3] = {1.0, exp(3.0), exp(2.0)};

  (void)state;
  /* exact up to the rounding of exp and log */
  assert_true(fabs(PgStudyGrowth(3, size, count) - 1.0) < 1e-14);
}

/* Solvers that did not converge count 0 iterations and must not bend the line. */
static void test_gaps(void **state)
{
  const PetscReal size[4]  = {1249.0, 4999.0, 19999.0, 199711.0};
  const PetscReal count[4] = {3.0 * pow(1249.0, 0.7), 0.0, 3.0 * pow(19999.0, 0.7), 0.0};
  const PetscReal same[2] = {500.0, 500.0}, two[2] = {10.0, 12.0}, none[2] = {0.0, 0.0};

  (void)state;
  /* as above */
  assert_true(fabs(PgStudyGrowth(4, size, count) - 0.7) < 1e-13);
  assert_true(isnan(PgStudyGrowth(2, same, two)));
  assert_true(isnan(PgStudyGrowth(2, size, none)));
  assert_true(isnan(PgStudyGrowth(1, size, count)));
}

int main(int argc, char *argv[])
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_power_law), cmocka_unit_test(test_least_squares),
                                     cmocka_unit_test(test_gaps)};
  int                     failed;

  PetscCall(PgInitialize(&argc, &argv, "test"));
  PetscCall(PetscSetFPTrap(PETSC_FP_TRAP_ON));
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
