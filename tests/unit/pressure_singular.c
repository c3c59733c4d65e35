/* ranks: 1 2 4 */
/* No disc has a prescribed pressure: the constant is in the null space. b is made compatible, what is taken away is
   reported, the mean of p is kept; and a solver that is not told about all this is not believed. */
#include "pressure_setup.h"

static PetscReal Mean(Bed *bed)
{
  PetscReal *p = Everywhere(bed, BedArray(bed, "pressure")), sum = 0.0;
  for (PetscInt i = 0; i < bed->n; i++) sum += p[i];
  CHECK(PetscFree(p));
  return sum / (PetscReal)bed->n;
}

/* Part of b that is its mean, relative to all of it; from all discs, in the order of ids. */
static PetscReal MeanPart(Bed *bed, const PetscReal Z[])
{
  PetscReal *z = Everywhere(bed, Z), *volume = Everywhere(bed, BedArray(bed, "volume")), sum = 0.0, square = 0.0;
  for (PetscInt i = 0; i < bed->n; i++) {
    sum += z[i] * volume[i];
    square += PetscSqr(z[i] * volume[i]);
  }
  CHECK(PetscFree(z));
  CHECK(PetscFree(volume));
  return PetscAbsReal(sum) / PetscSqrtReal((PetscReal)bed->n * square);
}

static void test_mean_kept(void **state)
{
  static const char *const options[] = {"", "-pressure_pc_type jacobi", "-pressure_pc_type gamg",
                                        "-pressure_ksp_type gmres",
                                        "-pressure_pc_hypre_boomeramg_relax_type_coarse Gaussian-elimination"};

  (void)state;
  for (size_t o = 0; o < sizeof options / sizeof *options; o++) {
    Bed             bed;
    PgPressureStats stats;
    PetscReal      *Z, *exact, before, part;

    BedCreate(PETSC_COMM_WORLD, 17, 16, 0.1, options[o], &bed);
    BedFix(&bed, PETSC_FALSE);
    BedGuess(&bed);
    Z      = BedSource(&bed);
    before = Mean(&bed);
    part   = MeanPart(&bed, Z);
    exact  = DenseSolution(&bed, Z, NULL);
    assert_true(part > 0.1); /* a right-hand side far from compatible */
    for (PetscInt step = 0; step < 3; step++) {
      CHECK(PgPressureUpdate(bed.pressure, NULL));
      CHECK(PgPressureSolve(bed.pressure, Z, &stats));
      assert_true(stats.singular);
      assert_true(stats.reason > 0);
      assert_true(stats.residual <= 1e-7);
      /* sums of 272 terms in another order */
      assert_true(PetscAbsReal(stats.removed - part) <= 1e-12);
      /* a mean of 1e5 Pa with its rounding */
      assert_true(PetscAbsReal(Mean(&bed) - before) <= 1e-9);
      /* excess pressures are some kPa: 10 rtol of that */
      assert_true(Error(&bed, exact) <= 1e-3);
    }
    CHECK(PetscFree(Z));
    CHECK(PetscFree(exact));
    BedDestroy(&bed);
  }
}

/* b is nothing but its mean: nothing is left to solve for, and the guess is smoothed away to its mean. */
static void test_all_removed(void **state)
{
  Bed             bed;
  PgPressureStats stats;
  PetscReal      *Z, *volume, *exact, mean;

  (void)state;
  BedCreate(PETSC_COMM_WORLD, 13, 12, 0.1, "", &bed);
  BedFix(&bed, PETSC_FALSE);
  BedGuess(&bed);
  Z      = BedSource(&bed);
  volume = BedArray(&bed, "volume");
  for (PetscInt i = 0; i < BedOwned(&bed); i++) Z[i] = 3.0 / volume[i];
  mean = Mean(&bed);
  CHECK(PgPressureUpdate(bed.pressure, NULL));
  CHECK(PgPressureSolve(bed.pressure, Z, &stats));
  assert_true(PetscAbsReal(stats.removed - 1.0) <= 1e-12);
  assert_true(stats.reason > 0);
  CHECK(PetscMalloc1(bed.n, &exact));
  for (PetscInt i = 0; i < bed.n; i++) exact[i] = mean;
  assert_true(Error(&bed, exact) <= 1e-6); /* what remains of b is rounding of 3 Pa, times a condition of 300 */
  CHECK(PetscFree(exact));
  CHECK(PetscFree(Z));
  BedDestroy(&bed);
}

/* From drained to natural sides and back, within one object. */
static void test_changing_sides(void **state)
{
  Bed             bed;
  PgPressureStats stats;
  PetscReal      *Z, *exact;

  (void)state;
  BedCreate(PETSC_COMM_WORLD, 13, 12, 0.1, "", &bed);
  BedGuess(&bed);
  Z = BedSource(&bed);
  for (PetscInt step = 0; step < 4; step++) {
    BedFix(&bed, (PetscBool)(step % 2));
    exact = DenseSolution(&bed, Z, NULL);
    CHECK(PgPressureUpdate(bed.pressure, NULL));
    CHECK(PgPressureSolve(bed.pressure, Z, &stats));
    assert_int_equal(stats.singular, step % 2 == 0);
    assert_true((stats.removed > 0.0) == (step % 2 == 0));
    assert_true(Error(&bed, exact) <= 1e-3); /* as above */
    CHECK(PetscFree(exact));
  }
  CHECK(PetscFree(Z));
  BedDestroy(&bed);
}

/* A block of discs without connection to those with a prescribed pressure: singular in a way that nobody looked for,
   with a right-hand side that is not compatible there. Whatever the solver says, no such pressure is passed on. */
static void test_island(void **state)
{
  static const char *const options[] = {"", "-pressure_pc_type jacobi", "-pressure_pc_type gamg"};

  (void)state;
  for (size_t o = 0; o < sizeof options / sizeof *options; o++) {
    for (PetscInt stop = 0; stop < 2; stop++) {
      Bed             bed;
      PgPressureStats stats;
      PetscReal      *Z, *x;
      char            text[256];

      CHECK(PetscSNPrintf(text, sizeof text, "%s -pressure_error_if_not_converged %d", options[o], (int)stop));
      BedCreate(PETSC_COMM_WORLD, 17, 16, 0.1, text, &bed);
      CHECK(PgParticlesGetArray(bed.particles, PG_POSITION, &x));
      for (PetscInt i = 0; i < BedOwned(&bed); i++)
        if (BedIds(&bed)[i] % bed.columns > 8 && BedIds(&bed)[i] >= bed.columns) x[2 * i] += 0.3;
      CHECK(PgNeighborsBuild(bed.neighbors));
      CHECK(PgSphUpdate(bed.sph));
      BedFix(&bed, PETSC_TRUE); /* bottom row and left column: none of the island */
      BedGuess(&bed);
      Z = BedSource(&bed);
      CHECK(PgPressureSetFailureFile(bed.pressure, "pressure_singular-island.petsc"));
      CHECK(PgPressureUpdate(bed.pressure, NULL));
      if (stop) {
        FAILS(PgPressureSolve(bed.pressure, Z, &stats), PETSC_ERR_NOT_CONVERGED);
      } else { /* the residual tells: no pressure balances the mean of the sources */
        CHECK(PgPressureSolve(bed.pressure, Z, &stats));
        assert_false(stats.singular);
        assert_true(!(stats.residual < 1e-3));
      }
      CHECK(PetscFree(Z));
      BedDestroy(&bed);
    }
  }
  (void)remove("pressure_singular-island.petsc");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_mean_kept),
    cmocka_unit_test(test_all_removed),
    cmocka_unit_test(test_changing_sides),
    cmocka_unit_test(test_island),
};

PRESSURE_MAIN(PETSC_FALSE)
