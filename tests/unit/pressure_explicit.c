/* ranks: 1 2 4 */
/* The explicit sweep against its definition (bitwise, on any number of ranks), against Richardson with Jacobi, and
   its residual against the matrix. */
#include "pressure_setup.h"

/* Sweeps done by every rank for the whole bed, with the sums in ascending id: what any rank must reproduce bit by
   bit. The weights are those of the owners. norm: of the residual after the last sweep, and of b. To be freed. */
static PetscReal *SweepEverywhere(Bed *bed, const PetscReal Z[], PetscInt sweeps, PetscReal norm[2])
{
  PgExactSum        square[2] = {{.not_finite = 0}, {.not_finite = 0}};
  const PetscReal   reference = 1e5;
  const PetscInt    n = bed->n, owned = BedOwned(bed), *id = BedIds(bed);
  const PetscReal  *volume = BedArray(bed, "volume");
  PetscReal        *w, *p = Everywhere(bed, BedArray(bed, "pressure")), *next, *b = Everywhere(bed, Z);
  PetscReal        *fixed = Everywhere(bed, BedArray(bed, "pressure_fixed"));
  PetscReal        *value = Everywhere(bed, BedArray(bed, "pressure_prescribed"));
  PetscReal        *dV    = Everywhere(bed, volume);
  PgSphCoefficients c;

  CHECK(PgSphGetCoefficients(bed->sph, &c));
  CHECK(PetscCalloc1(n * n, &w));
  CHECK(PetscMalloc1(n, &next));
  for (PetscInt i = 0; i < owned; i++)
    for (PetscInt k = c.ptr[i]; k < c.ptr[i + 1]; k++) w[id[i] * n + id[c.col[k]]] = -c.laplacian[k] * volume[i];
  MPI_Allreduce(MPI_IN_PLACE, w, (int)(n * n), MPIU_REAL, MPI_SUM, bed->comm);
  for (PetscInt i = 0; i < n; i++)
    if (fixed[i] != 0.0) p[i] = value[i];
  for (PetscInt s = 0; s < sweeps; s++) {
    for (PetscInt i = 0; i < n; i++) {
      PetscReal flow = -b[i] * dV[i], diagonal = 0.0;
      for (PetscInt j = 0; j < n; j++) { /* weights of zero add nothing, not even rounding */
        flow += w[i * n + j] * (p[j] - reference);
        diagonal += w[i * n + j];
      }
      next[i] = fixed[i] != 0.0 ? value[i] : reference + flow / diagonal;
    }
    CHECK(PetscArraycpy(p, next, n));
  }
  for (PetscInt i = 0; i < n; i++) {
    PetscReal diagonal = 0.0, rhs, r;
    for (PetscInt j = 0; j < n; j++) diagonal += w[i * n + j];
    rhs = fixed[i] != 0.0 ? diagonal * (value[i] - reference) : -b[i] * dV[i];
    r   = rhs - diagonal * (p[i] - reference);
    for (PetscInt j = 0; j < n && fixed[i] == 0.0; j++) {
      if (w[i * n + j] == 0.0) continue;
      r += w[i * n + j] * (p[j] - reference);
      if (fixed[j] != 0.0) rhs += w[i * n + j] * (p[j] - reference);
    }
    PgExactSumAdd(&square[0], r * r);
    PgExactSumAdd(&square[1], rhs * rhs);
  }
  CHECK(PgExactSumReduce(PETSC_COMM_SELF, 2, square, norm));
  norm[0] = PetscSqrtReal(norm[0]);
  norm[1] = PetscSqrtReal(norm[1]);
  CHECK(PetscFree(w));
  CHECK(PetscFree(next));
  CHECK(PetscFree(b));
  CHECK(PetscFree(fixed));
  CHECK(PetscFree(value));
  CHECK(PetscFree(dV));
  return p;
}

static void CheckSweeps(PetscInt sweeps, PetscBool fix, PetscBool request)
{
  Bed             bed;
  PgPressureStats stats;
  PgField         field;
  PetscReal      *Z, *expected, *p, norm[2];
  PetscInt        owned, ghosts, patterns;
  const PetscInt *id;
  char            options[128];

  CHECK(PetscSNPrintf(options, sizeof options, "-pressure explicit -pressure_sweeps %" PetscInt_FMT, sweeps));
  BedCreate(PETSC_COMM_WORLD, 13, 12, 0.1, options, &bed);
  BedFix(&bed, fix);
  BedGuess(&bed);
  Z        = BedSource(&bed);
  expected = SweepEverywhere(&bed, Z, sweeps, norm);
  CHECK(PgPressureUpdate(bed.pressure, NULL));
  CHECK(PgPressureRequestResidual(bed.pressure, request));
  CHECK(PgPressureSolve(bed.pressure, Z, &stats));
  assert_int_equal(stats.iterations, sweeps);
  assert_int_equal(stats.reason, 0);
  assert_true(stats.residual == (request ? norm[0] / norm[1] : -1.0)); /* bitwise, too */
  assert_true(stats.rhs_norm == (request ? norm[1] : -1.0));
  assert_int_equal(stats.singular, !fix);
  CHECK(PgParticlesGetSizes(bed.particles, &owned, &ghosts, NULL));
  CHECK(PgParticlesFindField(bed.particles, "pressure", &field));
  CHECK(PgParticlesGetArray(bed.particles, field, &p));
  id = BedIds(&bed);
  for (PetscInt i = 0; i < owned + ghosts; i++) assert_true(p[i] == expected[id[i]]); /* ghosts too */
  CHECK(PgPressureGetCounts(bed.pressure, &patterns, NULL, NULL));
  assert_int_equal(patterns, 0); /* no matrix was needed */
  CHECK(PetscFree(Z));
  CHECK(PetscFree(expected));
  BedDestroy(&bed);
}

static void test_sweeps(void **state)
{
  (void)state;
  CheckSweeps(1, PETSC_TRUE, PETSC_FALSE);
  CheckSweeps(7, PETSC_TRUE, PETSC_TRUE);
  CheckSweeps(3, PETSC_FALSE, PETSC_TRUE);
}

/* k sweeps are k steps of Richardson with the inverse diagonal, from the same guess. */
static void CheckRichardson(PetscInt sweeps, PetscBool fix)
{
  Bed             bed;
  PgPressureStats stats;
  PetscReal      *Z, *swept;
  char            options[256];

  CHECK(PetscSNPrintf(options, sizeof options, "-pressure explicit -pressure_sweeps %" PetscInt_FMT, sweeps));
  BedCreate(PETSC_COMM_WORLD, 13, 12, 0.1, options, &bed);
  BedFix(&bed, fix);
  BedGuess(&bed);
  Z = BedSource(&bed);
  if (!fix) { /* without the mean, which only the implicit method takes away */
    PetscReal      *volume = BedArray(&bed, "volume"), sum = 0.0;
    const PetscInt *id = BedIds(&bed);
    for (PetscInt i = 0; i < BedOwned(&bed); i++) Z[i] = (id[i] % 2 ? 1.0 : -1.0) * 1e5 / (volume[i] / 1e-4);
    for (PetscInt i = 0; i < BedOwned(&bed); i++) sum += Z[i] * volume[i];
    MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPIU_REAL, MPI_SUM, bed.comm);
    assert_true(PetscAbsReal(sum) < 1e-8); /* 156 discs, half of them +10, half -10 Pa */
  }
  CHECK(PgPressureUpdate(bed.pressure, NULL));
  CHECK(PgPressureSolve(bed.pressure, Z, &stats));
  swept = Everywhere(&bed, BedArray(&bed, "pressure"));
  CHECK(PetscFree(Z));
  BedDestroy(&bed);

  CHECK(PetscSNPrintf(options, sizeof options,
                      "-pressure_ksp_type richardson -pressure_pc_type jacobi -pressure_ksp_norm_type none "
                      "-pressure_ksp_max_it %" PetscInt_FMT " -pressure_error_if_not_converged false",
                      sweeps));
  BedCreate(PETSC_COMM_WORLD, 13, 12, 0.1, options, &bed);
  BedFix(&bed, fix);
  BedGuess(&bed);
  Z = BedSource(&bed);
  if (!fix) {
    PetscReal      *volume = BedArray(&bed, "volume");
    const PetscInt *id     = BedIds(&bed);
    for (PetscInt i = 0; i < BedOwned(&bed); i++) Z[i] = (id[i] % 2 ? 1.0 : -1.0) * 1e5 / (volume[i] / 1e-4);
  }
  CHECK(PgPressureUpdate(bed.pressure, NULL));
  CHECK(PgPressureSolve(bed.pressure, Z, &stats));
  assert_int_equal(stats.iterations, sweeps);
  if (fix) {
    /* pressures of 1e5 Pa, of which each sweep forgets a few units of rounding (1.5e-11 Pa) */
    assert_true(Error(&bed, swept) <= 1e-10 * (PetscReal)sweeps);
  } else {
    /* equal but for a constant, which the implicit method keeps and the sweep does not */
    PetscReal *p = Everywhere(&bed, BedArray(&bed, "pressure"));
    for (PetscInt i = 0; i < bed.n; i++)
      assert_true(PetscAbsReal((p[i] - swept[i]) - (p[0] - swept[0])) <= 1e-10 * (PetscReal)sweeps);
    CHECK(PetscFree(p));
  }
  CHECK(PetscFree(Z));
  CHECK(PetscFree(swept));
  BedDestroy(&bed);
}

static void test_richardson(void **state)
{
  (void)state;
  CheckRichardson(1, PETSC_TRUE);
  CheckRichardson(5, PETSC_TRUE);
  CheckRichardson(1, PETSC_FALSE);
}

/* The residual on request, and the matrix made on demand: ||b - A x||/||b|| of both, before and after. */
static void test_residual(void **state)
{
  Bed             bed;
  PgPressureStats stats;
  Mat             A;
  Vec             b, x, r;
  PetscReal      *Z, norm[2], rhs;

  (void)state;
  BedCreate(PETSC_COMM_WORLD, 13, 12, 0.1, "-pressure explicit -pressure_sweeps 2 -pressure_reference 100200", &bed);
  BedFix(&bed, PETSC_TRUE);
  BedGuess(&bed);
  Z = BedSource(&bed);
  CHECK(PgPressureUpdate(bed.pressure, NULL));
  for (PetscInt pass = 0; pass < 2; pass++) {
    PetscReal   *p = BedArray(&bed, "pressure"), *fixed = BedArray(&bed, "pressure_fixed");
    PetscReal   *value = BedArray(&bed, "pressure_prescribed");
    PetscScalar *v;
    if (pass) {
      CHECK(PgPressureRequestResidual(bed.pressure, PETSC_TRUE));
      CHECK(PgPressureSolve(bed.pressure, Z, &stats));
    }
    CHECK(PgPressureGetSystem(bed.pressure, &A, &b, NULL));
    CHECK(VecDuplicate(b, &x));
    CHECK(VecDuplicate(b, &r));
    CHECK(VecGetArray(x, &v));
    for (PetscInt i = 0; i < BedOwned(&bed); i++) v[i] = (fixed[i] != 0.0 ? value[i] : p[i]) - 100200.0;
    CHECK(VecRestoreArray(x, &v));
    if (!pass) { /* before a solve the system has Z = 0; the one of the solve differs by -Z dV in free rows */
      const PetscReal *volume = BedArray(&bed, "volume");
      CHECK(VecCopy(b, r));
      CHECK(VecGetArray(r, &v));
      for (PetscInt i = 0; i < BedOwned(&bed); i++)
        if (fixed[i] == 0.0) v[i] -= Z[i] * volume[i];
      CHECK(VecRestoreArray(r, &v));
      CHECK(VecNorm(r, NORM_2, &rhs));
      CHECK(VecScale(r, -1.0));
      CHECK(MatMultAdd(A, x, r, r));
      CHECK(VecNorm(r, NORM_2, &norm[0]));
    } else {
      CHECK(MatMult(A, x, r));
      CHECK(VecAXPY(r, -1.0, b));
      CHECK(VecNorm(r, NORM_2, &norm[1]));
      CHECK(VecNorm(b, NORM_2, &rhs));
    }
    CHECK(VecDestroy(&x));
    CHECK(VecDestroy(&r));
  }
  /* sums of a few hundred squares in another order */
  assert_true(PetscAbsReal(stats.rhs_norm - rhs) <= 1e-12 * rhs);
  assert_true(PetscAbsReal(stats.initial - norm[0] / rhs) <= 1e-12 * stats.initial);
  assert_true(PetscAbsReal(stats.residual - norm[1] / rhs) <= 1e-12);
  assert_true(stats.residual < stats.initial);
  assert_true(stats.residual > 1e-3); /* two sweeps do not solve it */
  assert_true(stats.removed == 0.0);
  CHECK(PetscFree(Z));
  BedDestroy(&bed);
}

/* Enough sweeps do solve it. */
static void test_convergence(void **state)
{
  Bed             bed;
  PgPressureStats stats;
  PetscReal      *Z, *exact;

  (void)state;
  BedCreate(PETSC_COMM_WORLD, 8, 7, 0.1, "-pressure explicit -pressure_sweeps 1500", &bed);
  BedFix(&bed, PETSC_TRUE);
  BedGuess(&bed);
  Z     = BedSource(&bed);
  exact = DenseSolution(&bed, Z, NULL);
  CHECK(PgPressureRequestResidual(bed.pressure, PETSC_TRUE));
  CHECK(PgPressureUpdate(bed.pressure, NULL));
  CHECK(PgPressureSolve(bed.pressure, Z, &stats));
  /* 56 discs: each sweep leaves at most 1 - 1/56 of the error of a few hundred Pa: nothing but rounding remains */
  assert_true(Error(&bed, exact) <= 1e-7);
  assert_true(stats.residual <= 1e-9);
  CHECK(PetscFree(Z));
  CHECK(PetscFree(exact));
  BedDestroy(&bed);
}

/* All sides natural: the residual sees the part of b that no pressure can balance, the sweep goes on regardless. */
static void test_incompatible(void **state)
{
  Bed             bed;
  PgPressureStats stats;
  PetscReal      *Z, *volume, sum[2] = {0.0, 0.0};

  (void)state;
  BedCreate(PETSC_COMM_WORLD, 9, 8, 0.1, "-pressure explicit", &bed);
  BedFix(&bed, PETSC_FALSE);
  BedGuess(&bed);
  Z      = BedSource(&bed);
  volume = BedArray(&bed, "volume");
  for (PetscInt i = 0; i < BedOwned(&bed); i++) {
    sum[0] -= Z[i] * volume[i];
    sum[1] += PetscSqr(Z[i] * volume[i]);
  }
  MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, bed.comm);
  CHECK(PgPressureRequestResidual(bed.pressure, PETSC_TRUE));
  CHECK(PgPressureUpdate(bed.pressure, NULL));
  CHECK(PgPressureSolve(bed.pressure, Z, &stats));
  /* sums of 72 terms in another order */
  assert_true(PetscAbsReal(stats.removed - PetscAbsReal(sum[0]) / PetscSqrtReal(72.0 * sum[1])) <= 1e-13);
  assert_true(stats.removed > 0.1 && stats.removed < 1.0);
  assert_true(stats.residual >= stats.removed);
  CHECK(PetscFree(Z));
  BedDestroy(&bed);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_sweeps),      cmocka_unit_test(test_richardson),   cmocka_unit_test(test_residual),
    cmocka_unit_test(test_convergence), cmocka_unit_test(test_incompatible),
};

PRESSURE_MAIN(PETSC_TRUE)
