/* ranks: 1 2 4 */
/* The one record among those of all ranks: the largest value, then the smallest ids; ranks without one do not count. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include <porograin/base.h>

static PetscMPIInt rank, size;

static PetscMPIInt Holder(PetscReal value, PetscInt first, PetscInt second)
{
  PetscMPIInt holder = -7;

  assert_int_equal(PgFindHolder(PETSC_COMM_WORLD, value, first, second, &holder), 0);
  return holder;
}

static void the_largest_value_wins(void **state)
{
  (void)state;
  assert_int_equal(Holder((PetscReal)rank, 100 - rank, 0), size - 1);
  /* negative values, as of a smallest limit, and the largest id with the largest value */
  assert_int_equal(Holder(-1.0 - (PetscReal)rank, 100 - rank, 0), 0);
}

static void of_equal_values_the_smallest_ids(void **state)
{
  (void)state;
  assert_int_equal(Holder(2.5, 100 - rank, 0), size - 1);
  assert_int_equal(Holder(2.5, 100 + rank, 50 - rank), 0);
  assert_int_equal(Holder(2.5, 100, 50 - rank), size - 1);
  /* all alike: the first rank */
  assert_int_equal(Holder(2.5, 100, 50), 0);
}

static void a_rank_without_a_record_does_not_count(void **state)
{
  const PetscBool mine = (PetscBool)(rank == size - 1);

  (void)state;
  assert_int_equal(Holder(mine ? -PETSC_MAX_REAL : 1e9, mine ? 17 : -1, 0), size - 1);
  assert_int_equal(Holder(2.5, mine ? 17 : -1, 0), size - 1);
  assert_int_equal(Holder(1e9, -1, 0), -1);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_largest_value_wins),
    cmocka_unit_test(of_equal_values_the_smallest_ids),
    cmocka_unit_test(a_rank_without_a_record_does_not_count),
};

int main(int argc, char **argv)
{
  int failed;

  if (PgInitialize(&argc, &argv, "unit test\n")) return 1;
  if (MPI_Comm_rank(PETSC_COMM_WORLD, &rank) || MPI_Comm_size(PETSC_COMM_WORLD, &size)) return 1;
  failed = cmocka_run_group_tests_name("holder", tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
