/* ranks: 1 2 4 */
/* The matrix against the operator without one, and against dense equations in which nothing is eliminated. */
#include "pressure_setup.h"

/* Entry (i, j) of the sparse matrix by ids, on every rank. To be freed. */
static PetscReal *SparseByIds(Bed *bed, Mat A)
{
  const PetscInt     n = bed->n, owned = BedOwned(bed), *id = BedIds(bed), *cols, *index;
  PetscInt           start, count, *id_of;
  PetscReal         *a;
  const PetscScalar *value;

  CHECK(PgParticlesGetGlobalIndices(bed->particles, &start, &index));
  CHECK(PetscCalloc1(n * n, &a));
  CHECK(PetscCalloc1(n, &id_of));
  for (PetscInt i = 0; i < owned; i++) id_of[start + i] = id[i];
  MPI_Allreduce(MPI_IN_PLACE, id_of, (int)n, MPIU_INT, MPI_SUM, bed->comm);
  for (PetscInt i = 0; i < owned; i++) {
    CHECK(MatGetRow(A, start + i, &count, &cols, &value));
    for (PetscInt k = 0; k < count; k++) a[id[i] * n + id_of[cols[k]]] += value[k];
    CHECK(MatRestoreRow(A, start + i, &count, &cols, &value));
  }
  MPI_Allreduce(MPI_IN_PLACE, a, (int)(n * n), MPIU_REAL, MPI_SUM, bed->comm);
  CHECK(PetscFree(id_of));
  return a;
}

/* Natural sides: symmetric, row sums zero, M-matrix, and equal to the dense equations. */
static void test_natural(void **state)
{
  Bed        bed;
  Mat        A;
  PetscReal *a, *dense;

  (void)state;
  BedCreate(PETSC_COMM_WORLD, 13, 12, 0.1, "-pressure_pc_type jacobi", &bed);
  CHECK(PgPressureUpdate(bed.pressure, NULL));
  CHECK(PgPressureGetSystem(bed.pressure, &A, NULL, NULL));
  a     = SparseByIds(&bed, A);
  dense = DenseMatrix(&bed, NULL);
  for (PetscInt i = 0; i < bed.n; i++) {
    PetscReal sum = 0.0;
    for (PetscInt j = 0; j < bed.n; j++) {
      const PetscReal aij = a[i * bed.n + j];
      sum += aij;
      /* entries are products of three numbers, at most 5: a few units of rounding */
      assert_true(PetscAbsReal(aij - a[j * bed.n + i]) <= 1e-14);
      assert_true(PetscAbsReal(aij - dense[i * bed.n + j]) <= 1e-14);
      if (i != j) assert_true(aij <= 0.0);
    }
    /* a sum of 30 such numbers */
    assert_true(PetscAbsReal(sum) <= 1e-13);
    assert_true(a[i * bed.n + i] > 0.5); /* 4.3 on the lattice, a quarter of it in a corner */
  }
  CHECK(PetscFree(a));
  CHECK(PetscFree(dense));
  BedDestroy(&bed);
}

/* A p = -dV lap p with the operator of sph, for a pressure without symmetry. */
static void CompareWithOperator(Bed *bed)
{
  const PetscInt    *id = BedIds(bed), owned = BedOwned(bed);
  const PetscReal   *volume = BedArray(bed, "volume");
  PetscReal         *p      = BedArray(bed, "pressure"), *lap;
  PgField            field;
  Mat                A;
  Vec                x, y;
  PetscScalar       *v;
  const PetscScalar *w;

  CHECK(PgPressureGetSystem(bed->pressure, &A, NULL, NULL));
  CHECK(PgParticlesFindField(bed->particles, "pressure", &field));
  CHECK(MatCreateVecs(A, &x, &y));
  CHECK(VecGetArray(x, &v));
  for (PetscInt i = 0; i < owned; i++) v[i] = p[i] = 500.0 * PetscSinReal(0.01 * (PetscReal)(id[i] * id[i]));
  CHECK(VecRestoreArray(x, &v));
  CHECK(PgParticlesHalo(bed->particles, 1, &field));
  CHECK(PetscMalloc1(owned + 1, &lap));
  CHECK(PgSphLaplacian(bed->sph, p, lap));
  CHECK(MatMult(A, x, y));
  CHECK(VecGetArrayRead(y, &w));
  /* terms of up to 500 * 5, thirty of them, in another order */
  for (PetscInt i = 0; i < owned; i++) assert_true(PetscAbsReal(w[i] + volume[i] * lap[i]) <= 1e-11);
  CHECK(VecRestoreArrayRead(y, &w));
  CHECK(PetscFree(lap));
  CHECK(VecDestroy(&x));
  CHECK(VecDestroy(&y));
}

/* The same matrix object when discs move, change rank, and change the number of rows of each rank. */
static void test_operator(void **state)
{
  Bed      bed;
  PetscInt patterns, fills;

  (void)state;
  BedCreate(PETSC_COMM_WORLD, 14, 11, 0.1, "-pressure_pc_type jacobi", &bed);
  for (PetscInt round = 0; round < 4; round++) {
    if (round == 1) BedMove(&bed, 2e-4);
    if (round >= 2) { /* 3: by another shift, so that numbers of discs per rank differ */
      CHECK(PgParticlesForceMigration(bed.particles, round - 1));
      CHECK(PgNeighborsBuild(bed.neighbors));
      CHECK(PgSphUpdate(bed.sph));
    }
    CHECK(PgPressureUpdate(bed.pressure, NULL));
    CHECK(PgPressureGetCounts(bed.pressure, &patterns, &fills, NULL));
    assert_int_equal(fills, round + 1);
    assert_int_equal(patterns, PetscMax(round, 1)); /* moving needs no new pattern, new lists do */
    CompareWithOperator(&bed);
  }
  BedDestroy(&bed);
}

/* Periodic sides: columns of images are those of their discs, also when most discs have an image. */
static void test_periodic(void **state)
{
  for (PetscInt columns = 8; columns <= 16; columns += 8) {
    Bed bed;

    (void)state;
    BedCreate(PETSC_COMM_WORLD, columns, 24, 0.1, "-pressure_pc_type jacobi", &bed);
    CHECK(PgParticlesSetPeriodicX(bed.particles, -0.0025, 0.01 * (PetscReal)columns - 0.0025));
    CHECK(PgNeighborsBuild(bed.neighbors));
    CHECK(PgSphUpdate(bed.sph));
    CHECK(PgPressureUpdate(bed.pressure, NULL));
    CompareWithOperator(&bed);
    BedDestroy(&bed);
  }
}

/* Prescribed pressures eliminated symmetrically give the solution of the equations where they are not; with and
   without a coefficient. The matrix stays symmetric, with a positive diagonal in the fixed rows. */
static void Eliminated(PetscBool with_kappa)
{
  Bed             bed;
  Mat             A;
  PgPressureStats stats;
  PetscReal      *Z, *kappa, *exact, *a, *fixed, *local = NULL;
  PetscInt        owned, ghosts;
  const PetscInt *id;

  BedCreate(PETSC_COMM_WORLD, 13, 12, 0.1, "-pressure_pc_type jacobi -pressure_ksp_rtol 1e-12", &bed);
  BedFix(&bed, PETSC_TRUE);
  BedGuess(&bed);
  Z  = BedSource(&bed);
  id = BedIds(&bed);
  CHECK(PgParticlesGetSizes(bed.particles, &owned, &ghosts, NULL));
  CHECK(PetscMalloc1(owned + ghosts + 1, &kappa));
  for (PetscInt i = 0; i < owned + ghosts; i++) kappa[i] = 1.0 + 0.6 * Noise(id[i], 5);
  if (with_kappa) local = kappa;
  exact = DenseSolution(&bed, Z, local);
  CHECK(PgPressureUpdate(bed.pressure, local));
  CHECK(PgPressureSolve(bed.pressure, Z, &stats));
  assert_false(stats.singular);
  assert_true(stats.removed == 0.0);
  /* the smallest eigenvalue is above the diagonal / (2.2 N), so the error is below ||x|| cond rtol
     = 1e3 sqrt(156) * 350 * 1e-12 Pa */
  assert_true(Error(&bed, exact) <= 5e-6);
  {
    const PetscReal *at = BedArray(&bed, "pressure_fixed"), *value = BedArray(&bed, "pressure_prescribed");
    const PetscReal *p = BedArray(&bed, "pressure");
    for (PetscInt i = 0; i < owned; i++)
      if (at[i] != 0.0) assert_true(p[i] == value[i]);
  }

  CHECK(PgPressureGetSystem(bed.pressure, &A, NULL, NULL));
  a     = SparseByIds(&bed, A);
  fixed = Everywhere(&bed, BedArray(&bed, "pressure_fixed"));
  for (PetscInt i = 0; i < bed.n; i++) {
    assert_true(a[i * bed.n + i] > 0.2); /* kappa is above 0.4 */
    for (PetscInt j = 0; j < bed.n; j++) {
      assert_true(PetscAbsReal(a[i * bed.n + j] - a[j * bed.n + i]) <= 1e-14); /* as above */
      if (i != j && (fixed[i] != 0.0 || fixed[j] != 0.0)) assert_true(a[i * bed.n + j] == 0.0);
    }
  }
  CHECK(PetscFree(a));
  CHECK(PetscFree(fixed));
  CHECK(PetscFree(exact));
  CHECK(PetscFree(kappa));
  CHECK(PetscFree(Z));
  BedDestroy(&bed);
}
static void test_eliminated(void **state)
{
  (void)state;
  Eliminated(PETSC_FALSE);
}
static void test_coefficient(void **state)
{
  (void)state;
  Eliminated(PETSC_TRUE);
}

/* A disc far from all others: an error naming it when free, its prescribed pressure when fixed. */
static void test_lone_disc(void **state)
{
  const PetscInt lone = 17;
  for (PetscInt fix = 0; fix < 2; fix++) {
    Bed             bed;
    PgPressureStats stats;
    PetscReal      *x, *fixed, *value, *p, *Z;

    (void)state;
    /* a reference for which reference + (p - reference) is not p */
    BedCreate(PETSC_COMM_WORLD, 9, 9, 0.1, "-pressure_pc_type jacobi -pressure_reference 1e9", &bed);
    CHECK(PgParticlesGetArray(bed.particles, PG_POSITION, &x));
    for (PetscInt i = 0; i < BedOwned(&bed); i++)
      if (BedIds(&bed)[i] == lone) x[2 * i] += 0.5;
    CHECK(PgNeighborsBuild(bed.neighbors));
    CHECK(PgSphUpdate(bed.sph));
    BedFix(&bed, PETSC_TRUE);
    BedGuess(&bed);
    fixed = BedArray(&bed, "pressure_fixed");
    value = BedArray(&bed, "pressure_prescribed");
    for (PetscInt i = 0; i < BedOwned(&bed); i++)
      if (BedIds(&bed)[i] == lone && fix) {
        fixed[i] = 1.0;
        value[i] = 98765.4321;
      }
    if (fix) {
      Z = BedSource(&bed);
      CHECK(PgPressureUpdate(bed.pressure, NULL));
      CHECK(PgPressureSolve(bed.pressure, Z, &stats));
      {
        Mat       A;
        Vec       d;
        PetscReal least;
        CHECK(PgPressureGetSystem(bed.pressure, &A, NULL, NULL));
        CHECK(MatCreateVecs(A, &d, NULL));
        CHECK(MatGetDiagonal(A, d));
        CHECK(VecMin(d, NULL, &least));
        assert_true(least > 0.5); /* the row without neighbours has one too, of usual size */
        CHECK(VecDestroy(&d));
      }
      p = BedArray(&bed, "pressure");
      for (PetscInt i = 0; i < BedOwned(&bed); i++)
        if (fixed[i] != 0.0) assert_true(p[i] == value[i]); /* the lone one among them, and all exactly */
      CHECK(PetscFree(Z));
    } else {
      FAILS(PgPressureUpdate(bed.pressure, NULL), PETSC_ERR_NOT_CONVERGED);
    }
    BedDestroy(&bed);
  }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_natural),    cmocka_unit_test(test_operator),    cmocka_unit_test(test_periodic),
    cmocka_unit_test(test_eliminated), cmocka_unit_test(test_coefficient), cmocka_unit_test(test_lone_disc),
};

PRESSURE_MAIN(PETSC_TRUE)
