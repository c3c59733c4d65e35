/* What the tests of pressure share: a jittered packing of unequal discs with made-up porosities, its lists and
   operators, and a dense copy of the equations, put together on every rank from the coefficients. */
#pragma once

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <porograin/pressure.h>

#define CHECK(call) assert_int_equal((call), 0)

typedef struct {
  MPI_Comm    comm;
  PetscInt    columns, rows, n; /* discs across, up, all */
  PgParticles particles;
  PgNeighbors neighbors;
  PgSph       sph;
  PgPressure  pressure;
} Bed;

/* A number in (-1, 1) that depends on id and salt only. */
static inline PetscReal Noise(PetscInt id, PetscInt salt)
{
  const double x = sin(12.9898 * (double)(id + 1) + 78.233 * (double)salt) * 43758.5453;
  return (PetscReal)(2.0 * (x - floor(x)) - 1.0);
}

static inline PetscReal *BedArray(Bed *bed, const char name[])
{
  PgField    field;
  PetscReal *array;

  CHECK(PgParticlesFindField(bed->particles, name, &field));
  assert_true(field >= 0);
  CHECK(PgParticlesGetArray(bed->particles, field, &array));
  return array;
}

static inline PetscInt BedOwned(Bed *bed)
{
  PetscInt owned;
  CHECK(PgParticlesGetSizes(bed->particles, &owned, NULL, NULL));
  return owned;
}

static inline const PetscInt *BedIds(Bed *bed)
{
  const PetscInt *id;
  CHECK(PgParticlesGetIds(bed->particles, &id));
  return id;
}

/* Options are text as on a command line; they are read by SetFromOptions and taken back. */
static inline void BedCreate(MPI_Comm comm, PetscInt columns, PetscInt rows, PetscReal jitter, const char options[],
                             Bed *bed)
{
  const PetscReal d = 0.01;
  PetscMPIInt     rank, size;
  PetscInt        low, high, *id;
  PetscReal      *x, *r, *m, *volume;

  CHECK(PetscOptionsInsertString(NULL, options));
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  bed->comm    = comm;
  bed->columns = columns;
  bed->rows    = rows;
  bed->n       = columns * rows;
  CHECK(PgParticlesCreate(comm, &bed->particles));
  CHECK(PgParticlesSetFromOptions(bed->particles));
  CHECK(PgNeighborsCreate(bed->particles, &bed->neighbors));
  CHECK(PgNeighborsSetFromOptions(bed->neighbors));
  CHECK(PgSphCreate(bed->particles, bed->neighbors, &bed->sph));
  CHECK(PgSphSetFromOptions(bed->sph));
  CHECK(PgPressureCreate(bed->particles, bed->neighbors, bed->sph, &bed->pressure));
  CHECK(PgPressureSetFromOptions(bed->pressure));
  low  = bed->n * rank / size;
  high = bed->n * (rank + 1) / size;
  CHECK(PetscMalloc1(high - low, &id));
  for (PetscInt i = low; i < high; i++) id[i - low] = i;
  CHECK(PgParticlesSetDiscs(bed->particles, high - low, id));
  CHECK(PetscFree(id));
  CHECK(PgParticlesGetArray(bed->particles, PG_POSITION, &x));
  CHECK(PgParticlesGetArray(bed->particles, PG_RADIUS, &r));
  CHECK(PgParticlesGetArray(bed->particles, PG_MASS, &m));
  volume = BedArray(bed, "volume");
  for (PetscInt i = 0; i < high - low; i++) {
    const PetscInt k = low + i, row = k / columns;
    x[2 * i]     = d * ((PetscReal)(k % columns) + (row % 2 ? 0.5 : 0.0) + jitter * Noise(k, 1));
    x[2 * i + 1] = d * (0.86602540378443865 * (PetscReal)row + jitter * Noise(k, 2));
    r[i]         = 0.5 * d * (0.95 + 0.05 * Noise(k, 3));
    m[i]         = 2000.0 * PETSC_PI * r[i] * r[i];
    volume[i]    = PETSC_PI * r[i] * r[i] / (1.0 - 0.10 - 0.03 * Noise(k, 4));
  }
  CHECK(PgNeighborsBuild(bed->neighbors));
  CHECK(PgSphUpdate(bed->sph));
}

static inline void BedDestroy(Bed *bed)
{
  CHECK(PgPressureDestroy(&bed->pressure));
  CHECK(PgSphDestroy(&bed->sph));
  CHECK(PgNeighborsDestroy(&bed->neighbors));
  CHECK(PgParticlesDestroy(&bed->particles));
  /* nothing of this test's options is left for the next */
  CHECK(PetscOptionsClear(NULL));
}

/* Moves every disc by a smooth displacement of at most `amount` [m], without new lists. */
static inline void BedMove(Bed *bed, PetscReal amount)
{
  const PgField   position = PG_POSITION;
  const PetscInt *id = BedIds(bed), owned = BedOwned(bed);
  PetscReal      *x;

  CHECK(PgParticlesGetArray(bed->particles, PG_POSITION, &x));
  for (PetscInt i = 0; i < owned; i++) {
    const PetscReal a = (PetscReal)(id[i] % bed->columns), b = (PetscReal)(id[i] / bed->columns);
    x[2 * i] += amount * PetscSinReal(0.3 * b) / 2.0;
    x[2 * i + 1] += amount * PetscCosReal(0.2 * a) / 2.0;
  }
  CHECK(PgParticlesHalo(bed->particles, 1, &position));
  CHECK(PgSphUpdate(bed->sph));
}

/* Prescribes p on the bottom row and the left column: p = 1e5 + 300 + 5 id Pa; frees the rest. */
static inline void BedFix(Bed *bed, PetscBool fix)
{
  const PetscInt *id = BedIds(bed), owned = BedOwned(bed);
  PetscReal      *fixed = BedArray(bed, "pressure_fixed"), *value = BedArray(bed, "pressure_prescribed");

  for (PetscInt i = 0; i < owned; i++) {
    fixed[i] = fix && (id[i] < bed->columns || id[i] % bed->columns == 0) ? 1.0 : 0.0;
    value[i] = fixed[i] != 0.0 ? 1e5 + 300.0 + 5.0 * (PetscReal)id[i] : -1.0; /* unused where free */
  }
}

/* Prescribes the other two sides too. With the corrected Laplacian no side may be left natural: the rows there
   extrapolate, and some have a negative diagonal. */
static inline void BedFixAll(Bed *bed)
{
  const PetscInt *id = BedIds(bed), owned = BedOwned(bed);
  PetscReal      *fixed = BedArray(bed, "pressure_fixed"), *value = BedArray(bed, "pressure_prescribed");

  BedFix(bed, PETSC_TRUE);
  for (PetscInt i = 0; i < owned; i++) {
    if (id[i] / bed->columns < bed->rows - 1 && id[i] % bed->columns < bed->columns - 1) continue;
    fixed[i] = 1.0;
    value[i] = 1e5 + 300.0 + 5.0 * (PetscReal)id[i];
  }
}

/* A guess and a right-hand side without symmetry: of the size that a pressure varying by kPa has. */
static inline void BedGuess(Bed *bed)
{
  const PetscInt *id = BedIds(bed), owned = BedOwned(bed);
  PetscReal      *p = BedArray(bed, "pressure");
  for (PetscInt i = 0; i < owned; i++) p[i] = 1e5 + 100.0 * Noise(id[i], 7) + 40.0;
}
static inline PetscReal *BedSource(Bed *bed)
{
  const PetscInt *id = BedIds(bed), owned = BedOwned(bed);
  PetscReal      *Z;
  CHECK(PetscMalloc1(owned + 1, &Z));
  for (PetscInt i = 0; i < owned; i++)
    Z[i] = 2e5 * PetscSinReal(0.17 * (PetscReal)(id[i] % bed->columns) + 0.4) + 1e5 * Noise(id[i], 9);
  return Z;
}

/* An owned array in the order of ids, complete on every rank; to be freed. */
static inline PetscReal *Everywhere(Bed *bed, const PetscReal owned[])
{
  const PetscInt *id = BedIds(bed), count = BedOwned(bed);
  PetscReal      *all;

  CHECK(PetscCalloc1(bed->n, &all));
  for (PetscInt i = 0; i < count; i++) all[id[i]] = owned[i];
  MPI_Allreduce(MPI_IN_PLACE, all, (int)bed->n, MPIU_REAL, MPI_SUM, bed->comm);
  return all;
}

/* Dense matrix by permanent ids from the coefficients: row a of -dV_a lap, nothing eliminated, kappa by owned and
   ghost disc or NULL. To be freed. */
static inline PetscReal *DenseMatrix(Bed *bed, const PetscReal kappa[])
{
  const PetscInt   *id = BedIds(bed), owned = BedOwned(bed), n = bed->n;
  const PetscReal  *volume = BedArray(bed, "volume");
  PetscReal        *a;
  PgSphCoefficients c;

  CHECK(PgSphGetCoefficients(bed->sph, &c));
  CHECK(PetscCalloc1(n * n, &a));
  for (PetscInt i = 0; i < owned; i++) {
    for (PetscInt k = c.ptr[i]; k < c.ptr[i + 1]; k++) {
      const PetscInt j = c.col[k];
      PetscReal      w = -c.laplacian[k] * volume[i];
      if (kappa) w *= 2.0 * kappa[i] * kappa[j] / (kappa[i] + kappa[j]);
      a[id[i] * n + id[j]] -= w;
      a[id[i] * n + id[i]] += w;
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, a, (int)(n * n), MPIU_REAL, MPI_SUM, bed->comm);
  return a;
}

/* Solves a x = b by Gaussian elimination with row pivoting; both are destroyed, the result is in b. */
static inline void DenseSolve(PetscInt n, PetscReal a[], PetscReal b[])
{
  for (PetscInt k = 0; k < n; k++) {
    PetscInt p = k;
    for (PetscInt i = k + 1; i < n; i++)
      if (PetscAbsReal(a[i * n + k]) > PetscAbsReal(a[p * n + k])) p = i;
    if (p != k) {
      for (PetscInt j = 0; j < n; j++) {
        const PetscReal t = a[k * n + j];
        a[k * n + j]      = a[p * n + j];
        a[p * n + j]      = t;
      }
      const PetscReal t = b[k];
      b[k]              = b[p];
      b[p]              = t;
    }
    for (PetscInt i = k + 1; i < n; i++) {
      const PetscReal f = a[i * n + k] / a[k * n + k];
      if (f == 0.0) continue;
      for (PetscInt j = k; j < n; j++) a[i * n + j] -= f * a[k * n + j];
      b[i] -= f * b[k];
    }
  }
  for (PetscInt i = n - 1; i >= 0; i--) {
    for (PetscInt j = i + 1; j < n; j++) b[i] -= a[i * n + j] * b[j];
    b[i] /= a[i * n + i];
  }
}

/* The exact pressures for right-hand side Z with BedFix() or, without fixed discs, the ones with the mean of the
   present field: from the dense equations, where a fixed disc's row says p = prescribed. To be freed. */
static inline PetscReal *DenseSolution(Bed *bed, const PetscReal Z[], const PetscReal kappa[])
{
  const PetscInt n      = bed->n;
  PetscReal     *a      = DenseMatrix(bed, kappa);
  PetscReal     *volume = Everywhere(bed, BedArray(bed, "volume")), *b = Everywhere(bed, Z);
  PetscReal     *fixed = Everywhere(bed, BedArray(bed, "pressure_fixed"));
  PetscReal     *value = Everywhere(bed, BedArray(bed, "pressure_prescribed"));
  PetscReal     *p     = Everywhere(bed, BedArray(bed, "pressure"));
  PetscReal      mean = 0.0, rhs = 0.0;
  PetscBool      any = PETSC_FALSE;

  for (PetscInt i = 0; i < n; i++) {
    b[i] *= -volume[i];
    rhs += b[i];
    mean += p[i];
    if (fixed[i] == 0.0) continue;
    any = PETSC_TRUE;
    for (PetscInt j = 0; j < n; j++) a[i * n + j] = i == j ? 1.0 : 0.0;
    b[i] = value[i];
  }
  if (!any) { /* compatible by taking the mean away; the last equation is redundant: mean p instead */
    for (PetscInt i = 0; i < n; i++) b[i] -= rhs / (PetscReal)n;
    for (PetscInt j = 0; j < n; j++) a[(n - 1) * n + j] = 1.0;
    b[n - 1] = mean;
  }
  DenseSolve(n, a, b);
  CHECK(PetscFree(a));
  CHECK(PetscFree(volume));
  CHECK(PetscFree(fixed));
  CHECK(PetscFree(value));
  CHECK(PetscFree(p));
  return b;
}

/* Largest |p - exact| over the discs of all ranks. */
static inline PetscReal Error(Bed *bed, const PetscReal exact[])
{
  const PetscInt  *id = BedIds(bed), owned = BedOwned(bed);
  const PetscReal *p     = BedArray(bed, "pressure");
  PetscReal        error = 0.0;

  for (PetscInt i = 0; i < owned; i++) {
    assert_true(isfinite(p[i]));
    error = PetscMax(error, PetscAbsReal(p[i] - exact[id[i]]));
  }
  MPI_Allreduce(MPI_IN_PLACE, &error, 1, MPIU_REAL, MPI_MAX, bed->comm);
  return error;
}

/* A call that must fail, with that code; its message goes to standard error. */
#define FAILS(call, code)                                                                                              \
  do {                                                                                                                 \
    PetscErrorCode err_;                                                                                               \
    CHECK(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));                                                       \
    err_ = (call);                                                                                                     \
    CHECK(PetscPopErrorHandler());                                                                                     \
    assert_int_equal(err_, code);                                                                                      \
  } while (0)

/* PetscInitialize for the programs of this folder; hypre divides 0 by 0 in places, so exceptions are trapped only
   where it is not used. */
#define PRESSURE_MAIN(trap)                                                                                            \
  int main(int argc, char *argv[])                                                                                     \
  {                                                                                                                    \
    int failed;                                                                                                        \
    PetscCall(PgInitialize(&argc, &argv, "test"));                                                                     \
    if (trap) PetscCall(PetscSetFPTrap(PETSC_FP_TRAP_ON));                                                             \
    failed = cmocka_run_group_tests(tests, NULL, NULL);                                                                \
    return PgFinalize(0) || failed;                                                                                    \
  }
