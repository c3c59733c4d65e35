/* ranks: 1 2 4 */
/* Exact sums: the same bits for any order and any spread over the ranks. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <porograin/base.h>

/* A term of widely spread magnitude and either sign from a counter. */
static PetscReal Term(PetscInt i)
{
  const uint64_t z = ((uint64_t)i + 1) * 0x9E3779B97F4A7C15u;
  return ldexp((double)(int64_t)z, (int)(z % 151) - 120);
}

static PetscErrorCode SumOf(PetscInt n, PetscInt stride, PetscReal *value)
{
  PgExactSum  sum = {.not_finite = 0};
  PetscMPIInt rank, size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt i = (k * stride) % n;
    if (k % size == rank) PgExactSumAdd(&sum, Term(i));
  }
  PetscCall(PgExactSumReduce(PETSC_COMM_WORLD, 1, &sum, value));
  PetscFunctionReturn(0);
}

static void order_does_not_matter(void **state)
{
  PetscReal a, b;
  (void)state;
  assert_int_equal(SumOf(10007, 1, &a), 0);
  assert_int_equal(SumOf(10007, 4999, &b), 0); /* 10007 is prime: another order of the same terms */
  assert_true(a == b);
  /* the same sum in exact rational arithmetic, rounded once */
  assert_true(a == -0x1.bc633c1eac805p+93);
}

static void keeps_what_rounding_loses(void **state)
{
  PgExactSum  sum[2] = {{.not_finite = 0}, {.not_finite = 0}};
  PetscReal   value[2];
  PetscMPIInt rank;
  (void)state;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank == 0) {
    const PetscReal terms[] = {1e300, 3.25, -1e300, 0x1p-1074, -7.5e-9};
    for (int i = 0; i < 5; i++) PgExactSumAdd(&sum[0], terms[i]);
    for (int i = 0; i < 5; i++) PgExactSumAdd(&sum[1], -terms[i]);
  }
  assert_int_equal(PgExactSumReduce(PETSC_COMM_WORLD, 2, sum, value), 0);
  assert_true(value[0] == 3.25 - 7.5e-9);
  assert_true(value[1] == -value[0]);
}

static void not_finite_is_seen(void **state)
{
  PgExactSum sum = {.not_finite = 0};
  PetscReal  value;
  (void)state;
  PgExactSumAdd(&sum, 1.0);
  PgExactSumAdd(&sum, (PetscReal)INFINITY);
  assert_int_equal(PgExactSumReduce(PETSC_COMM_WORLD, 1, &sum, &value), 0);
  assert_true(isnan(value));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(order_does_not_matter),
                                     cmocka_unit_test(keeps_what_rounding_loses), cmocka_unit_test(not_finite_is_seen)};
  int                     failed;

  if (PgInitialize(&argc, &argv, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
