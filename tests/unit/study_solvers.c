/* ranks: 1 2 4 */
/* One study through the library: what its HDF5 file says must hold together, and agree with an independent program. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <porograin/study.h>

#define CHECK(call) assert_int_equal((call), 0)

/* Two sizes of three solvers, the second of which cannot converge. */
static const char solvers[] = "cg-jacobi -ksp_type cg -pc_type jacobi\n"
                              "# a comment\n"
                              "short -ksp_type richardson -pc_type jacobi -ksp_max_it 30 # another\n"
                              "\n"
                              "gmres-sor -ksp_type gmres -pc_type bjacobi -sub_pc_type sor\n";

static PetscReal Attribute(const char *row, const char *name)
{
  PetscReal value = -1.0;
  char      object[64];

  (void)snprintf(object, sizeof object, "/study/%s", row);
  CHECK(PgResultReadAttribute(PETSC_COMM_WORLD, "study.h5", object, name, &value));
  return value;
}

static void RunStudy(void)
{
  PgStudy     study;
  PetscMPIInt rank;

  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank == 0) {
    FILE *file = fopen("solvers.txt", "w");
    assert_non_null(file);
    assert_true(fputs(solvers, file) >= 0);
    assert_int_equal(fclose(file), 0);
  }
  MPI_Barrier(PETSC_COMM_WORLD);
  CHECK(PetscOptionsSetValue(NULL, "-study_sizes", "161,721"));
  CHECK(PetscOptionsSetValue(NULL, "-study_jitter", "0.05"));
  CHECK(PetscOptionsSetValue(NULL, "-study_solvers", "solvers.txt"));
  CHECK(PetscOptionsSetValue(NULL, "-study_repeats", "2"));
  CHECK(PetscOptionsSetValue(NULL, "-study_output", "study.h5"));
  CHECK(PgStudyCreate(PETSC_COMM_WORLD, &study));
  CHECK(PgStudySetFromOptions(study));
  CHECK(PgStudyRun(study));
  CHECK(PgStudyDestroy(&study));
  MPI_Barrier(PETSC_COMM_WORLD);
}

static void test_rows(void **state)
{
  const char *const row[6] = {"000", "001", "002", "003", "004", "005"};

  (void)state;
  RunStudy();
  for (int i = 0; i < 6; i++) {
    PetscReal *history = NULL;
    PetscInt   rows, columns;
    char       path[64];
    const int  its = (int)Attribute(row[i], "iterations");

    /* W = 9 and 19: 2 W^2 - 1 */
    assert_int_equal((int)Attribute(row[i], "N"), i < 3 ? 161 : 721);
    assert_int_equal((int)Attribute(row[i], "runs"), 2);
    (void)snprintf(path, sizeof path, "/study/%s/history", row[i]);
    CHECK(PgResultRead(PETSC_COMM_WORLD, "study.h5", path, &rows, &columns, &history));
    assert_int_equal(rows, its + 1);
    /* a zero guess leaves b itself; one rounding in the division */
    assert_true(fabs(history[0] - 1.0) < 1e-14);
    /* what the solver thought last is what is left, but for the drift of its recurrence */
    assert_true(fabs(history[its] - Attribute(row[i], "residual")) < 1e-3 * history[its]);
    if (i % 3 == 1) {
      assert_int_equal(its, 30);
      assert_true(history[its] > 1e-3);
      assert_true(Attribute(row[i], "reason_code") < 0.0);
      assert_true(Attribute(row[i], "iterations_needed") > 300.0);
    } else {
      assert_true(history[its] <= 1e-8);
      assert_true(its < 2 || history[its - 1] > 1e-8);
      assert_true(Attribute(row[i], "reason_code") > 0.0);
      /* 10 x rtol: the condition of these systems is a few hundred, but the slow modes are solved best */
      assert_true(Attribute(row[i], "error") <= 1e-7);
    }
    CHECK(PetscFree(history));
  }
}

/* Conjugate gradients with the diagonal need the same number on any number of ranks: that which an independent
   program needs for the same systems. */
static void test_same_on_all_ranks(void **state)
{
  (void)state;
  assert_int_equal((int)Attribute("000", "iterations"), 36);
  assert_int_equal((int)Attribute("003", "iterations"), 77);
}

static void test_growth(void **state)
{
  const PetscReal size[2] = {161.0, 721.0}, count[2] = {36.0, 77.0};

  (void)state;
  /* the file holds doubles */
  assert_true(fabs(Attribute("003", "growth") - PgStudyGrowth(2, size, count)) < 1e-14);
}

int main(int argc, char *argv[])
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_rows), cmocka_unit_test(test_same_on_all_ranks),
                                     cmocka_unit_test(test_growth)};
  int                     failed;

  PetscCall(PgInitialize(&argc, &argv, "test"));
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
