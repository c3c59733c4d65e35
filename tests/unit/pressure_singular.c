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

/* ---- islands: discs that nothing ties to a prescribed pressure ---- */

enum { NOBODY, LONE, SIDES };       /* who has a prescribed pressure */
static PetscBool lone = PETSC_TRUE; /* whether the last disc of all is alone, or of the third block */

/* Columns from 9 on stand apart but for the bottom row, which stays; rows from 12 on of them apart again. */
static PetscInt Group(const Bed *bed, PetscInt id)
{
  const PetscInt row = id / bed->columns, column = id % bed->columns;

  if (lone && id == bed->n - 1) return 3;
  if (row == 0 || column < 9) return 0;
  return row < 12 ? 1 : 2;
}

/* Groups are `apart` from each other. */
static void Scatter(Bed *bed, PetscReal apart)
{
  PetscReal *x;

  CHECK(PgParticlesGetArray(bed->particles, PG_POSITION, &x));
  for (PetscInt i = 0; i < 2 * BedOwned(bed); i++) x[i] += apart * (PetscReal)Group(bed, BedIds(bed)[i / 2]);
  CHECK(PgNeighborsBuild(bed->neighbors));
  CHECK(PgSphUpdate(bed->sph));
}

static void Condition(Bed *bed, PetscInt who)
{
  PetscReal *fixed, *value;

  BedFix(bed, (PetscBool)(who == SIDES)); /* bottom row and left column: of group 0 only */
  fixed = BedArray(bed, "pressure_fixed");
  value = BedArray(bed, "pressure_prescribed");
  for (PetscInt i = 0; i < BedOwned(bed); i++) {
    if (who == NOBODY || Group(bed, BedIds(bed)[i]) != 3) continue;
    fixed[i] = 1.0;
    value[i] = 1e5 + 77.0;
  }
}

/* The exact pressures, each island with the mean it has and b without mean there; `square` is that of what b loses. */
static PetscReal *IslandSolution(Bed *bed, const PetscReal Z[], PetscBool tied, PetscReal *square)
{
  const PetscInt n = bed->n;
  PetscReal     *a = DenseMatrix(bed, NULL), *b = Everywhere(bed, Z), *p = Everywhere(bed, BedArray(bed, "pressure"));
  PetscReal     *volume = Everywhere(bed, BedArray(bed, "volume"));
  PetscReal     *fixed  = Everywhere(bed, BedArray(bed, "pressure_fixed"));
  PetscReal     *value  = Everywhere(bed, BedArray(bed, "pressure_prescribed"));

  *square = 0.0;
  for (PetscInt i = 0; i < n; i++) {
    b[i] *= -volume[i];
    if (fixed[i] == 0.0) continue;
    for (PetscInt j = 0; j < n; j++) a[i * n + j] = i == j ? 1.0 : 0.0;
    b[i] = value[i];
  }
  for (PetscInt g = tied ? 1 : 0; g < 3; g++) {
    PetscReal sum = 0.0, mean = 0.0, count = 0.0;
    PetscInt  last = -1;
    for (PetscInt i = 0; i < n; i++) {
      if (Group(bed, i) != g) continue;
      sum += b[i];
      mean += p[i];
      count += 1.0;
      last = i;
    }
    *square += sum * sum / count;
    for (PetscInt i = 0; i < n; i++)
      if (Group(bed, i) == g) b[i] -= sum / count;
    for (PetscInt j = 0; j < n; j++)
      a[last * n + j] = Group(bed, j) == g ? 1.0 : 0.0; /* this equation follows from the others */
    b[last] = mean;
  }
  DenseSolve(n, a, b);
  CHECK(PetscFree(a));
  CHECK(PetscFree(p));
  CHECK(PetscFree(volume));
  CHECK(PetscFree(fixed));
  CHECK(PetscFree(value));
  return b;
}

/* Update, solve, and compare with the dense equations. */
static void SolveIslands(Bed *bed, const PetscReal Z[], PetscInt who)
{
  PgPressureStats stats;
  PetscReal      *exact, square;

  Condition(bed, who);
  exact = IslandSolution(bed, Z, (PetscBool)(who == SIDES), &square);
  CHECK(PgPressureUpdate(bed->pressure, NULL));
  CHECK(PgPressureSolve(bed->pressure, Z, &stats));
  assert_true(stats.singular);
  assert_true(stats.residual <= 1e-7);
  /* sums of 272 terms in another order */
  assert_true(PetscAbsReal(stats.removed - PetscSqrtReal(square / (square + PetscSqr(stats.rhs_norm)))) <= 1e-12);
  /* excess pressures are some kPa: 10 rtol of that */
  assert_true(Error(bed, exact) <= 1e-3);
  CHECK(PetscFree(exact));
}

/* Three blocks apart from each other, and a disc that is alone: with a prescribed pressure on the sides of one block and
   the lone disc, on the lone disc only, as when it has left an undrained packing, and back, within one object. */
static void test_islands(void **state)
{
  /* the last: pairs across the gaps are in the lists, with weight 0 */
  static const struct {
    const char *options;
    PetscReal   apart;
  } variant[]                 = {{"", 0.3},
                                 {"-pressure_pc_type jacobi", 0.3},
                                 {"-pressure_pc_type gamg", 0.3},
                                 {"-pressure_ksp_type gmres", 0.3},
                                 {"-neighbors_skin 1", 0.0195}};
  static const PetscInt who[] = {LONE, SIDES, LONE, SIDES};

  (void)state;
  for (size_t o = 0; o < sizeof variant / sizeof *variant; o++) {
    Bed        bed;
    PetscReal *Z;

    BedCreate(PETSC_COMM_WORLD, 17, 16, 0.1, variant[o].options, &bed);
    Scatter(&bed, variant[o].apart);
    BedGuess(&bed);
    Z = BedSource(&bed);
    for (size_t step = 0; step < sizeof who / sizeof *who; step++) SolveIslands(&bed, Z, who[step]);
    CHECK(PetscFree(Z));
    BedDestroy(&bed);
  }
}

/* The same three blocks without any prescribed pressure: a level for each. */
static void test_islands_undrained(void **state)
{
  Bed        bed;
  PetscReal *Z;

  (void)state;
  lone = PETSC_FALSE;
  BedCreate(PETSC_COMM_WORLD, 17, 16, 0.1, "", &bed);
  Scatter(&bed, 0.3);
  BedGuess(&bed);
  Z = BedSource(&bed);
  SolveIslands(&bed, Z, NOBODY);
  CHECK(PetscFree(Z));
  BedDestroy(&bed);
  lone = PETSC_TRUE;
}

/* Blocks that drift apart and back again with the same lists: the pairs stay, their weights vanish. */
static void test_islands_drift(void **state)
{
  const PgField   position = PG_POSITION;
  Bed             bed;
  PgPressureStats stats;
  PetscReal      *Z, *x, *exact;

  (void)state;
  BedCreate(PETSC_COMM_WORLD, 17, 16, 0.1, "-neighbors_skin 1", &bed);
  Scatter(&bed, 0.015);
  BedGuess(&bed);
  Z = BedSource(&bed);
  for (PetscInt step = 0; step < 4; step++) {
    if (step % 2) {
      SolveIslands(&bed, Z, SIDES);
    } else {
      Condition(&bed, SIDES);
      exact = DenseSolution(&bed, Z, NULL);
      CHECK(PgPressureUpdate(bed.pressure, NULL));
      CHECK(PgPressureSolve(bed.pressure, Z, &stats));
      assert_false(stats.singular);
      /* as above */
      assert_true(Error(&bed, exact) <= 1e-3);
      CHECK(PetscFree(exact));
    }
    CHECK(PgParticlesGetArray(bed.particles, PG_POSITION, &x));
    for (PetscInt i = 0; i < 2 * BedOwned(&bed); i++)
      x[i] += (step % 2 ? -0.0045 : 0.0045) * (PetscReal)Group(&bed, BedIds(&bed)[i / 2]);
    CHECK(PgParticlesHalo(bed.particles, 1, &position));
    CHECK(PgSphUpdate(bed.sph));
  }
  CHECK(PetscFree(Z));
  BedDestroy(&bed);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_mean_kept), cmocka_unit_test(test_all_removed),       cmocka_unit_test(test_changing_sides),
    cmocka_unit_test(test_islands),   cmocka_unit_test(test_islands_undrained), cmocka_unit_test(test_islands_drift),
};

PRESSURE_MAIN(PETSC_FALSE)
