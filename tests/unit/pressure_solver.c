/* ranks: 1 2 4 */
/* The implicit solve: any solver of PETSc gives the pressures of the dense equations, the preconditioner is kept
   and rebuilt by its rules, nothing is allocated in steady stepping, and options are read or left. */
#include "pressure_setup.h"
#include <stdlib.h>

/* ---- every allocation of PETSc is counted ---- */

static PetscInt allocations = 0;

static PetscErrorCode CountingMalloc(size_t bytes, PetscBool clear, int line, const char function[], const char file[],
                                     void **result)
{
  (void)line;
  (void)function;
  (void)file;
  *result = NULL;
  if (!bytes) return 0;
  allocations++;
  *result = clear ? calloc(1, bytes) : malloc(bytes);
  return *result ? 0 : PETSC_ERR_MEM;
}
static PetscErrorCode CountingFree(void *address, int line, const char function[], const char file[])
{
  (void)line;
  (void)function;
  (void)file;
  free(address);
  return 0;
}
static PetscErrorCode CountingRealloc(size_t bytes, int line, const char function[], const char file[], void **result)
{
  (void)line;
  (void)function;
  (void)file;
  allocations++;
  *result = realloc(*result, bytes);
  return *result || !bytes ? 0 : PETSC_ERR_MEM;
}

/* ---- solutions ---- */

/* Solves with these options; largest error against the dense solution [Pa]. */
static PetscReal Solved(const char options[], PgPressureStats *stats)
{
  Bed        bed;
  PetscReal *Z, *exact, error;

  BedCreate(PETSC_COMM_WORLD, 13, 12, 0.1, options, &bed);
  if (strstr(options, "corrected"))
    BedFixAll(&bed);
  else
    BedFix(&bed, PETSC_TRUE);
  BedGuess(&bed);
  Z     = BedSource(&bed);
  exact = DenseSolution(&bed, Z, NULL);
  CHECK(PgPressureUpdate(bed.pressure, NULL));
  CHECK(PgPressureSolve(bed.pressure, Z, stats));
  error = Error(&bed, exact);
  CHECK(PetscFree(Z));
  CHECK(PetscFree(exact));
  BedDestroy(&bed);
  return error;
}

/* The equations themselves do not depend on the ranks, so the dense solution is the same on all: agreement with it
   within t is agreement between 1, 2 and 4 ranks within 2 t. */
static void test_solvers(void **state)
{
  static const char *const options[] = {
      "",
      "-pressure_pc_type jacobi",
      "-pressure_pc_type gamg",
      "-pressure_ksp_type gmres",
      "-pressure_ksp_type bcgs -pressure_pc_type bjacobi",
      "-pressure_ksp_type cg -pressure_pc_type cholesky -pressure_pc_factor_mat_solver_type mumps",
      "-pressure_ksp_type preonly -pressure_pc_type cholesky -pressure_pc_factor_mat_solver_type mumps",
      "-pressure_ksp_type minres -pressure_pc_type jacobi -pressure_ksp_rtol 1e-10", /* preconditioned norm only */
      "-sph_laplacian corrected",
      "-sph_laplacian corrected -pressure_ksp_type bcgs",
  };

  (void)state;
  for (size_t i = 0; i < sizeof options / sizeof *options; i++) {
    PgPressureStats stats;
    const PetscReal error = Solved(options[i], &stats);
    assert_true(stats.reason > 0);
    assert_true(stats.residual <= 1e-7);
    /* excess pressures are up to 1.3 kPa; the relative error follows the residual within 10 for a right-hand side
       that is no single eigenvector: 10 rtol * 1.3 kPa = 1.3e-4 Pa */
    assert_true(error <= 1.3e-4);
  }
}

/* Nothing moves: b = 0, and the excess pressure of the guess must go away, absolutely. */
static void test_zero_rhs(void **state)
{
  static const char *const options[] = {"", "-sph_laplacian corrected"};

  (void)state;
  for (size_t o = 0; o < 2; o++) {
    Bed             bed;
    PgPressureStats stats;
    PetscReal      *Z, *value, *exact;

    BedCreate(PETSC_COMM_WORLD, 13, 12, 0.1, options[o], &bed);
    BedFixAll(&bed);
    value = BedArray(&bed, "pressure_prescribed");
    for (PetscInt i = 0; i < BedOwned(&bed); i++) value[i] = 1e5;
    BedGuess(&bed);
    CHECK(PetscCalloc1(BedOwned(&bed) + 1, &Z));
    CHECK(PetscMalloc1(bed.n, &exact));
    for (PetscInt i = 0; i < bed.n; i++) exact[i] = 1e5;
    for (PetscInt pass = 0; pass < 2; pass++) { /* the second time the guess is right */
      CHECK(PgPressureUpdate(bed.pressure, NULL));
      CHECK(PgPressureSolve(bed.pressure, Z, &stats));
      assert_true(stats.rhs_norm == 0.0);
      assert_true(stats.reason > 0);
      if (pass) assert_int_equal(stats.iterations, 0);
      /* the promise of the absolute tolerance is 2e-7 Pa; 1e5 Pa has 1.5e-11 Pa of rounding */
      assert_true(Error(&bed, exact) <= 2e-7);
    }
    CHECK(PetscFree(Z));
    CHECK(PetscFree(exact));
    BedDestroy(&bed);
  }
}

/* Fewer cells than ranks: with four ranks there are some without discs. */
static void test_empty_ranks(void **state)
{
  static const char *const options[] = {"", "-pressure_pc_type jacobi", "-pressure explicit -pressure_sweeps 400"};

  (void)state;
  for (size_t o = 0; o < sizeof options / sizeof *options; o++) {
    Bed             bed;
    PgPressureStats stats;
    PetscReal      *Z, *exact;
    PetscInt        fewest;
    PetscMPIInt     size;

    BedCreate(PETSC_COMM_WORLD, 4, 3, 0.1, options[o], &bed);
    BedFix(&bed, PETSC_TRUE);
    BedGuess(&bed);
    fewest = BedOwned(&bed);
    MPI_Allreduce(MPI_IN_PLACE, &fewest, 1, MPIU_INT, MPI_MIN, PETSC_COMM_WORLD);
    MPI_Comm_size(PETSC_COMM_WORLD, &size);
    if (size == 4) assert_int_equal(fewest, 0);
    Z     = BedSource(&bed);
    exact = DenseSolution(&bed, Z, NULL);
    for (PetscInt step = 0; step < 2; step++) {
      CHECK(PgPressureUpdate(bed.pressure, NULL));
      CHECK(PgPressureSolve(bed.pressure, Z, &stats));
      assert_true(Error(&bed, exact) <= 1.3e-4); /* as in test_solvers */
    }
    CHECK(PetscFree(Z));
    CHECK(PetscFree(exact));
    BedDestroy(&bed);
  }
}

/* Residual of the guess and after, as the matrix sees them. */
static void test_stats(void **state)
{
  Bed                bed;
  PgPressureStats    stats;
  Mat                A;
  Vec                b, x, r;
  KSP                ksp;
  PetscReal         *Z, *guess, *p, *fixed, *value, norm[2], rhs;
  KSPConvergedReason reason;

  (void)state;
  BedCreate(PETSC_COMM_WORLD, 13, 12, 0.1, "-pressure_reference 100100", &bed);
  BedFix(&bed, PETSC_TRUE);
  BedGuess(&bed);
  guess = Everywhere(&bed, BedArray(&bed, "pressure"));
  Z     = BedSource(&bed);
  CHECK(PgPressureUpdate(bed.pressure, NULL));
  CHECK(PgPressureSetUpSolver(bed.pressure));
  CHECK(PgPressureSolve(bed.pressure, Z, &stats));
  CHECK(PgPressureGetSystem(bed.pressure, &A, &b, &ksp));
  CHECK(KSPGetConvergedReason(ksp, &reason));
  assert_int_equal(reason, stats.reason);
  CHECK(VecDuplicate(b, &x));
  CHECK(VecDuplicate(b, &r));
  CHECK(VecNorm(b, NORM_2, &rhs));
  p     = BedArray(&bed, "pressure");
  fixed = BedArray(&bed, "pressure_fixed");
  value = BedArray(&bed, "pressure_prescribed");
  for (PetscInt pass = 0; pass < 2; pass++) {
    PetscScalar *v;
    CHECK(VecGetArray(x, &v));
    for (PetscInt i = 0; i < BedOwned(&bed); i++)
      v[i] = (fixed[i] != 0.0 ? value[i] : pass ? p[i] : guess[BedIds(&bed)[i]]) - 100100.0;
    CHECK(VecRestoreArray(x, &v));
    CHECK(MatMult(A, x, r));
    CHECK(VecAXPY(r, -1.0, b));
    CHECK(VecNorm(r, NORM_2, &norm[pass]));
  }
  /* the same sums in another order */
  assert_true(PetscAbsReal(stats.rhs_norm - rhs) <= 1e-12 * rhs);
  assert_true(PetscAbsReal(stats.initial - norm[0] / rhs) <= 1e-12 * stats.initial);
  /* p was rounded to 1.5e-11 Pa on the way from the solver to the field */
  assert_true(PetscAbsReal(stats.residual - norm[1] / rhs) <= 1e-12);
  assert_true(stats.residual > 0.0 && stats.residual <= 1e-8 && stats.initial > 1e-3);
  CHECK(VecDestroy(&x));
  CHECK(VecDestroy(&r));
  CHECK(PetscFree(guess));
  CHECK(PetscFree(Z));
  BedDestroy(&bed);
}

/* ---- keeping the preconditioner ---- */

static PetscInt Built(Bed *bed)
{
  PetscInt count;
  CHECK(PgPressureGetCounts(bed->pressure, NULL, NULL, &count));
  return count;
}

static void Step(Bed *bed, const PetscReal Z[], PgPressureStats *stats)
{
  CHECK(PgPressureUpdate(bed->pressure, NULL));
  CHECK(PgPressureSolve(bed->pressure, Z, stats));
  assert_true(stats->reason > 0);
}

/* Disc k takes the place of disc n - 1 - k: the packing stays what it was. */
static void SwapPlaces(Bed *bed)
{
  const PetscInt *id = BedIds(bed);
  PetscReal      *x, *all[2];

  CHECK(PgParticlesGetArray(bed->particles, PG_POSITION, &x));
  for (PetscInt c = 0; c < 2; c++) {
    PetscReal *part;
    CHECK(PetscMalloc1(BedOwned(bed) + 1, &part));
    for (PetscInt i = 0; i < BedOwned(bed); i++) part[i] = x[2 * i + c];
    all[c] = Everywhere(bed, part);
    CHECK(PetscFree(part));
  }
  for (PetscInt i = 0; i < BedOwned(bed); i++)
    for (PetscInt c = 0; c < 2; c++) x[2 * i + c] = all[c][bed->n - 1 - id[i]];
  CHECK(PetscFree(all[0]));
  CHECK(PetscFree(all[1]));
  CHECK(PgNeighborsBuild(bed->neighbors));
  CHECK(PgSphUpdate(bed->sph));
}

static void test_kept(void **state)
{
  Bed             bed;
  PgPressureStats stats;
  PetscReal      *Z;
  PetscInt        patterns, fills, built;

  (void)state;
  BedCreate(PETSC_COMM_WORLD, 20, 21, 0.1, "", &bed);
  BedFix(&bed, PETSC_TRUE);
  BedGuess(&bed);
  Z = BedSource(&bed);
  CHECK(PgPressureUpdate(bed.pressure, NULL));
  CHECK(PgPressureSetUpSolver(bed.pressure));
  assert_int_equal(Built(&bed), 1);
  for (PetscInt step = 0; step < 6; step++) {
    BedMove(&bed, 1e-5);
    Step(&bed, Z, &stats);
  }
  CHECK(PgPressureGetCounts(bed.pressure, &patterns, &fills, &built));
  assert_int_equal(built, 1);
  assert_int_equal(patterns, 1);
  assert_int_equal(fills, 7);
  /* new lists in which every disc keeps its row: a new pattern, the preconditioner is kept */
  CHECK(PgNeighborsBuild(bed.neighbors));
  CHECK(PgSphUpdate(bed.sph));
  Step(&bed, Z, &stats);
  CHECK(PgPressureGetCounts(bed.pressure, &patterns, &fills, &built));
  assert_int_equal(patterns, 2);
  assert_int_equal(fills, 8);
  CHECK(PetscFree(Z));
  /* on request */
  CHECK(PgPressureForgetPreconditioner(bed.pressure));
  Z     = BedSource(&bed);
  built = Built(&bed);
  Step(&bed, Z, &stats);
  Step(&bed, Z, &stats);
  assert_int_equal(Built(&bed), built + 1);
  /* discs change places, so rows belong to other discs and no rank changes size: it must go */
  CHECK(PetscFree(Z));
  SwapPlaces(&bed);
  BedFix(&bed, PETSC_TRUE);
  Z     = BedSource(&bed);
  built = Built(&bed);
  Step(&bed, Z, &stats);
  assert_int_equal(Built(&bed), built + 1); /* before that solve, not because of it */
  CHECK(PetscFree(Z));
  BedDestroy(&bed);
}

/* preonly takes its preconditioner for the inverse: of this matrix, not of the last. */
static void test_preonly(void **state)
{
  Bed             bed;
  PgPressureStats stats;
  PetscReal      *Z;

  (void)state;
  BedCreate(PETSC_COMM_WORLD, 13, 12, 0.1,
            "-pressure_ksp_type preonly -pressure_pc_type cholesky -pressure_pc_factor_mat_solver_type mumps "
            "-pressure_error_if_not_converged false",
            &bed);
  BedFix(&bed, PETSC_TRUE);
  Z = BedSource(&bed);
  for (PetscInt step = 0; step < 3; step++) {
    BedMove(&bed, 1e-4);
    Step(&bed, Z, &stats);
    assert_true(stats.residual <= 1e-12); /* a direct solve: rounding */
    assert_int_equal(Built(&bed), step + 1);
  }
  CHECK(PetscFree(Z));
  BedDestroy(&bed);
}

/* Iterations grow because the matrix left the preconditioner behind: one solve suffers, the next builds. */
static void test_rebuilt_by_iterations(void **state)
{
  Bed             bed;
  PgPressureStats first, grown, after;
  PetscReal      *Z, *kappa;

  (void)state;
  BedCreate(PETSC_COMM_WORLD, 20, 21, 0.1, "", &bed);
  BedFix(&bed, PETSC_TRUE);
  BedGuess(&bed);
  Z = BedSource(&bed);
  CHECK(PetscMalloc1(BedOwned(&bed) + 1, &kappa));
  Step(&bed, Z, &first);
  for (PetscInt i = 0; i < BedOwned(&bed); i++) kappa[i] = BedIds(&bed)[i] % 20 < 10 ? 1.0 : 300.0;
  BedGuess(&bed);
  CHECK(PgPressureUpdate(bed.pressure, kappa));
  CHECK(PgPressureSolve(bed.pressure, Z, &grown));
  assert_int_equal(Built(&bed), 1);
  assert_true((PetscReal)grown.iterations > 1.5 * (PetscReal)first.iterations + 2.0);
  BedGuess(&bed);
  CHECK(PgPressureUpdate(bed.pressure, kappa));
  CHECK(PgPressureSolve(bed.pressure, Z, &after));
  assert_int_equal(Built(&bed), 2);
  assert_true(after.iterations < grown.iterations);
  CHECK(PgPressureUpdate(bed.pressure, kappa));
  CHECK(PgPressureSolve(bed.pressure, Z, &after));
  assert_int_equal(Built(&bed), 2);
  CHECK(PetscFree(kappa));
  CHECK(PetscFree(Z));
  BedDestroy(&bed);
}

static void test_lag(void **state)
{
  Bed             bed;
  PgPressureStats stats;
  PetscReal      *Z;

  (void)state;
  BedCreate(PETSC_COMM_WORLD, 10, 11, 0.1, "-pressure_pc_lag 3", &bed);
  BedFix(&bed, PETSC_TRUE);
  BedGuess(&bed);
  Z = BedSource(&bed);
  for (PetscInt step = 1; step <= 10; step++) {
    Step(&bed, Z, &stats);
    assert_int_equal(Built(&bed), (step + 2) / 3);
  }
  CHECK(PetscFree(Z));
  BedDestroy(&bed);
}

/* What a checkpoint asks for: after PgPressureForgetPreconditioner() an object with a past and one without give the same
   bits from the same state. GAMG and MUMPS add up what other ranks send in the order in which it comes (seen on four
   ranks): of them the same bits are asked on one rank only. */
static void test_forget(void **state)
{
  static const char *const options[] = {"", "-pressure_pc_type gamg",
                                        "-pressure_pc_type cholesky -pressure_pc_factor_mat_solver_type mumps"};
  PetscMPIInt              ranks;

  (void)state;
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  for (size_t o = 0; o < sizeof options / sizeof *options; o++) {
    Bed             bed;
    PgPressureStats stats;
    PetscReal      *Z, *p, *guess, *first;

    BedCreate(PETSC_COMM_WORLD, 20, 21, 0.1, options[o], &bed);
    BedGuess(&bed);
    for (PetscInt step = 0; step < 3; step++) {
      BedMove(&bed, 5e-4);
      CHECK(PgNeighborsBuild(bed.neighbors));
      CHECK(PgSphUpdate(bed.sph));
      BedFix(&bed, PETSC_TRUE);
      Z = BedSource(&bed);
      Step(&bed, Z, &stats);
      CHECK(PetscFree(Z));
    }
    CHECK(PetscMalloc2(BedOwned(&bed) + 1, &guess, BedOwned(&bed) + 1, &first));
    p = BedArray(&bed, "pressure");
    CHECK(PetscArraycpy(guess, p, BedOwned(&bed)));
    CHECK(PgPressureForgetPreconditioner(bed.pressure));
    BedMove(&bed, 1e-5);
    Z = BedSource(&bed);
    for (PetscInt i = 0; i < BedOwned(&bed); i++) Z[i] *= 1.3;
    Step(&bed, Z, &stats);
    CHECK(PetscArraycpy(first, p, BedOwned(&bed)));
    CHECK(PetscArraycpy(p, guess, BedOwned(&bed)));
    CHECK(PgPressureDestroy(&bed.pressure));
    CHECK(PgPressureCreate(bed.particles, bed.neighbors, bed.sph, &bed.pressure));
    CHECK(PgPressureSetFromOptions(bed.pressure));
    Step(&bed, Z, &stats);
    /* both solutions have a relative residual of 1e-8; the test of the solvers shows errors of at most 1.3e-4 Pa */
    for (PetscInt i = 0; i < BedOwned(&bed); i++)
      if (o == 0 || ranks == 1)
        assert_true(p[i] == first[i]);
      else
        assert_true(PetscAbsReal(p[i] - first[i]) <= 2.6e-4);
    CHECK(PetscFree2(guess, first));
    CHECK(PetscFree(Z));
    BedDestroy(&bed);
  }
}

/* A factor kept over many steps, with the pattern replaced under it, still gives the right pressures; a factor
   rebuilt after new pairs must not reuse the ordering of the old ones. */
static void test_direct_factor(void **state)
{
  Bed             bed;
  PgPressureStats stats;
  PetscReal      *Z, *exact;

  (void)state;
  BedCreate(PETSC_COMM_WORLD, 13, 12, 0.1,
            "-pressure_pc_type cholesky -pressure_pc_factor_mat_solver_type mumps -pressure_pc_lag 4", &bed);
  for (PetscInt step = 0; step < 12; step++) {
    if (step % 2) { /* pairs come and go */
      BedMove(&bed, 2e-3);
      CHECK(PgNeighborsBuild(bed.neighbors));
      CHECK(PgSphUpdate(bed.sph));
    }
    BedFix(&bed, PETSC_TRUE);
    Z     = BedSource(&bed);
    exact = DenseSolution(&bed, Z, NULL);
    Step(&bed, Z, &stats);
    assert_true(Error(&bed, exact) <= 1.3e-4); /* as in test_solvers */
    CHECK(PetscFree(Z));
    CHECK(PetscFree(exact));
  }
  BedDestroy(&bed);
}

/* Allocations of one exchange of ghosts: PetscSF makes one when it looks at a type of several numbers. */
static PetscInt HaloAllocations(Bed *bed, PetscInt count)
{
  static const char *const names[2] = {"pressure_fixed", "pressure_prescribed"};
  const PetscInt           before   = allocations;
  PgField                  field[2];

  for (PetscInt i = 0; i < count; i++) CHECK(PgParticlesFindField(bed->particles, names[i], &field[i]));
  CHECK(PgParticlesHalo(bed->particles, count, field));
  return allocations - before;
}

/* Neither the update nor the solve of a steady step allocates, whatever the method. */
static void test_no_allocation(void **state)
{
  static const char *const options[] = {"", "-pressure_pc_type jacobi", "-sph_laplacian corrected",
                                        "-pressure explicit",
                                        "-pressure_pc_type cholesky -pressure_pc_factor_mat_solver_type mumps"};

  (void)state;
  for (size_t o = 0; o < sizeof options / sizeof *options; o++) {
    Bed             bed;
    PgPressureStats stats;
    PetscReal      *Z;
    PetscInt        before, created, halos;

    BedCreate(PETSC_COMM_WORLD, 13, 12, 0.1, options[o], &bed);
    BedFixAll(&bed);
    BedGuess(&bed);
    Z = BedSource(&bed);
    CHECK(PgPressureRequestResidual(bed.pressure, PETSC_TRUE));
    for (PetscInt step = 0; step < 3; step++) { /* Krylov bases grow on first need */
      BedMove(&bed, 1e-5);
      BedGuess(&bed);
      CHECK(PgPressureUpdate(bed.pressure, NULL));
      CHECK(PgPressureSolve(bed.pressure, Z, &stats));
    }
    created = 0;
    for (PetscInt step = 0; step < 5; step++) {
      BedMove(&bed, 1e-5);
      BedGuess(&bed);
      before = allocations;
      CHECK(PgPressureUpdate(bed.pressure, NULL));
      CHECK(PgPressureSolve(bed.pressure, Z, &stats));
      created += allocations - before;
    }
    assert_true(allocations > 0); /* the counter works */
    halos = HaloAllocations(&bed, 2) + (strstr(options[o], "explicit") ? 2 : 1) * HaloAllocations(&bed, 1);
    assert_int_equal(created, 5 * halos);
    CHECK(PetscFree(Z));
    BedDestroy(&bed);
  }
}

/* ---- options ---- */

static PetscBool Unused(const char option[])
{
  PetscInt  n;
  char    **names, **values;
  PetscBool found = PETSC_FALSE;

  CHECK(PetscOptionsLeftGet(NULL, &n, &names, &values));
  for (PetscInt i = 0; i < n; i++) {
    PetscBool same;
    CHECK(PetscStrcmp(names[i], option, &same));
    found = (PetscBool)(found || same);
  }
  CHECK(PetscOptionsLeftRestore(NULL, &n, &names, &values));
  return found;
}

/* Misspelt names stay unused, for base to find; nested ones that exist are read before the first step. */
static void test_options(void **state)
{
  Bed bed;

  (void)state;
  BedCreate(PETSC_COMM_WORLD, 13, 12, 0.1,
            "-pressure_ksp_rtoll 1e-3 -pressure_ksp_rtol 1e-9 -pressure_mg_levels_ksp_max_it 3 "
            "-pressure_mg_levels_ksp_maxit 3 -pressure_pc_type gamg -pressure_sweep 2 -pressure_mat_type aij",
            &bed);
  BedFix(&bed, PETSC_TRUE);
  assert_true(Unused("pressure_mg_levels_ksp_max_it"));
  CHECK(PgPressureUpdate(bed.pressure, NULL));
  CHECK(PgPressureSetUpSolver(bed.pressure));
  assert_true(Unused("pressure_ksp_rtoll"));
  assert_true(Unused("pressure_mg_levels_ksp_maxit"));
  assert_true(Unused("pressure_sweep"));
  assert_false(Unused("pressure_ksp_rtol"));
  assert_false(Unused("pressure_mg_levels_ksp_max_it"));
  assert_false(Unused("pressure_pc_type"));
  assert_false(Unused("pressure_mat_type"));
  BedDestroy(&bed);
}

/* What PETSc prints as help, for the names. */
static char           help[400000];
static size_t         help_length = 0;
static PetscErrorCode CollectList(FILE *file, const char format[], va_list arguments)
{
  const int n = vsnprintf(help + help_length, sizeof help - help_length, format, arguments);

  (void)file;
  if (n > 0) help_length = PetscMin(help_length + (size_t)n, sizeof help - 1);
  return 0;
}

static PetscErrorCode Collect(MPI_Comm comm, const char format[], ...)
{
  va_list        arguments;
  PetscErrorCode err;

  (void)comm;
  va_start(arguments, format);
  err = CollectList(NULL, format, arguments);
  va_end(arguments);
  return err;
}

static void test_probe(void **state)
{
  Bed bed;
  PetscErrorCode (*print)(MPI_Comm, const char[], ...)        = PetscHelpPrintf;
  PetscErrorCode (*print_list)(FILE *, const char[], va_list) = PetscVFPrintf;

  (void)state;
  BedCreate(PETSC_COMM_WORLD, 13, 12, 0.1, "-pressure_pc_type gamg", &bed);
  BedFix(&bed, PETSC_TRUE);
  CHECK(PgPressureUpdate(bed.pressure, NULL));
  CHECK(PgPressureSetUpSolver(bed.pressure));
  CHECK(PetscOptionsSetValue(NULL, "-help", NULL));
  PetscHelpPrintf = Collect;
  PetscVFPrintf   = CollectList;
  help_length     = 0;
  CHECK(PgPressureProbeOptions(bed.pressure));
  PetscHelpPrintf = print;
  PetscVFPrintf   = print_list;
  CHECK(PetscOptionsClearValue(NULL, "-help"));
  assert_non_null(strstr(help, "-pressure_ksp_rtol"));
  assert_non_null(strstr(help, "-pressure_pc_gamg_threshold"));
  assert_non_null(strstr(help, "-pressure_mg_levels_1_ksp_max_it"));
  {
    PetscMPIInt rank;
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
    if (rank == 0) { /* PETSc prints lists of types there only */
      assert_non_null(strstr(help, "-pressure_mat_type"));
      assert_non_null(strstr(help, "-pressure_ksp_type"));
    }
  }
  BedDestroy(&bed);
}

/* Solvers that cannot work are refused when the matrix is known. */
static void test_refused(void **state)
{
  Bed bed;

  (void)state;
  BedCreate(PETSC_COMM_WORLD, 8, 8, 0.1, "-sph_laplacian corrected -pressure_ksp_type cg", &bed);
  BedFix(&bed, PETSC_TRUE);
  FAILS(PgPressureUpdate(bed.pressure, NULL), PETSC_ERR_USER_INPUT);
  BedDestroy(&bed);
  BedCreate(PETSC_COMM_WORLD, 8, 8, 0.1, "-sph_laplacian corrected", &bed);
  BedFix(&bed, PETSC_FALSE);
  FAILS(PgPressureUpdate(bed.pressure, NULL), PETSC_ERR_USER_INPUT);
  BedDestroy(&bed);
  BedCreate(PETSC_COMM_WORLD, 8, 8, 0.1, "-pressure_mat_type sbaij", &bed);
  BedFix(&bed, PETSC_TRUE);
  FAILS(PgPressureUpdate(bed.pressure, NULL), PETSC_ERR_USER_INPUT);
  BedDestroy(&bed);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_solvers),       cmocka_unit_test(test_zero_rhs), cmocka_unit_test(test_empty_ranks),
    cmocka_unit_test(test_stats),         cmocka_unit_test(test_kept),     cmocka_unit_test(test_rebuilt_by_iterations),
    cmocka_unit_test(test_lag),           cmocka_unit_test(test_forget),   cmocka_unit_test(test_direct_factor),
    cmocka_unit_test(test_no_allocation), cmocka_unit_test(test_options),  cmocka_unit_test(test_probe),
    cmocka_unit_test(test_refused),       cmocka_unit_test(test_preonly),
};

int main(int argc, char *argv[])
{
  int failed;

  /* before PETSc allocates anything */
  PetscCall(PetscMallocSet(CountingMalloc, CountingFree, CountingRealloc));
  PetscCall(PgInitialize(&argc, &argv, "test"));
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
