/* ranks: 1 2 4 */
/* Strain is that of the motion: none for a rigid one, and the exact value for a uniform deformation, whatever the
   packing and wherever the discs have migrated to. */
#include "dem_setup.h"
#include <math.h>
#include <porograin/simulation.h>

enum { COLUMNS = 9, ROWS = 7, COUNT = COLUMNS * ROWS };

static PetscReal start[2 * COUNT];

/* Discs of unequal radii on a disturbed triangular lattice. */
static void Fill(World *world)
{
  Disc     disc[COUNT] = {{0}};
  uint64_t seed        = 11;

  for (PetscInt k = 0; k < COUNT; k++) {
    const PetscInt i = k % COLUMNS, j = k / COLUMNS;

    disc[k].r        = 5e-3 * (1 + 0.01 * Random(&seed));
    disc[k].x        = 1e-2 * ((PetscReal)i + 0.5 * (PetscReal)(j % 2)) + 3e-4 * Random(&seed);
    disc[k].y        = 1e-2 * 0.5 * PetscSqrtReal(3.0) * (PetscReal)j + 3e-4 * Random(&seed);
    disc[k].m        = 0.15;
    start[2 * k]     = disc[k].x;
    start[2 * k + 1] = disc[k].y;
  }
  WorldFill(world, COUNT, disc);
  for (PetscInt k = 0; k < COUNT; k++) WorldSet(world, "initial_position", 2, k, &start[2 * k]);
}

/* Moves every disc to F X + shift and returns the strains in this rank's range of ids. */
static PetscInt Deform(World *world, PgStrain strain, const PetscReal F[4], const PetscReal shift[2],
                       PetscReal effective[], PetscReal volumetric[])
{
  PetscInt first, count;

  for (PetscInt k = 0; k < COUNT; k++) {
    const PetscReal *X    = &start[2 * k];
    const PetscReal  x[2] = {F[0] * X[0] + F[1] * X[1] + shift[0], F[2] * X[0] + F[3] * X[1] + shift[1]};
    WorldSet(world, "position", 2, k, x);
  }
  WorldBuild(world);
  CHECK(PgStrainCompute(strain, effective, volumetric));
  CHECK(PgParticlesGetIdRange(world->particles, &first, &count));
  return count;
}

static void expect(PetscInt count, const PetscReal value[], PetscReal expected)
{
  /* rounding of sums of twelve products of numbers of size 0.1 over differences of size 0.01, with margin */
  for (PetscInt i = 0; i < count; i++)
    if (!(PetscAbsReal(value[i] - expected) <= 1e-12))
      fail_msg("%.17g is not %.17g", (double)value[i], (double)expected);
}

static void test_strain(void **state)
{
  const PetscReal shift[2] = {0.03, -0.02}, lambda = 0.97, angle = 0.7;
  const PetscReal c = PetscCosReal(angle), s = PetscSinReal(angle);
  const PetscReal rotation[4] = {c, -s, s, c}, compression[4] = {lambda, 0, 0, lambda};
  const PetscReal stretch[4] = {1.02, 0.05, -0.01, 0.94}; /* columns: where the axes go */
  const PetscReal E[3]       = {0.5 * (1.02 * 1.02 + 0.01 * 0.01 - 1), 0.5 * (1.02 * 0.05 - 0.01 * 0.94),
                                0.5 * (0.05 * 0.05 + 0.94 * 0.94 - 1)};
  const PetscReal mean       = (E[0] + E[2]) / 3;
  PetscReal       both[4], effective[COUNT], volumetric[COUNT];
  PgStrain        strain;
  World           world;
  PetscInt        n;

  (void)state;
  WorldCreate(PETSC_COMM_WORLD, &world);
  Fill(&world);
  CHECK(PgStrainCreate(world.particles, world.neighbors, &strain));
  n = Deform(&world, strain, rotation, shift, effective, volumetric);
  expect(n, volumetric, 0);
  expect(n, effective, 0);
  /* in the plane and no strain across it: E = (lambda^2 - 1)/2 twice, its deviator E/3, E/3, -2E/3 */
  n = Deform(&world, strain, compression, shift, effective, volumetric);
  expect(n, volumetric, lambda * lambda - 1);
  expect(n, effective, (1 - lambda * lambda) / 3);
  /* a deformation that is not uniform in its directions, rotated afterwards: the same strain */
  both[0] = c * stretch[0] - s * stretch[2];
  both[1] = c * stretch[1] - s * stretch[3];
  both[2] = s * stretch[0] + c * stretch[2];
  both[3] = s * stretch[1] + c * stretch[3];
  n       = Deform(&world, strain, both, shift, effective, volumetric);
  expect(n, volumetric, 1.02 * 0.94 + 0.05 * 0.01 - 1);
  expect(
      n, effective,
      PetscSqrtReal(2.0 / 3.0 *
                    ((E[0] - mean) * (E[0] - mean) + (E[2] - mean) * (E[2] - mean) + mean * mean + 2 * E[1] * E[1])));
  CHECK(PgStrainDestroy(&strain));
  WorldDestroy(&world);
}

int main(int argc, char *argv[])
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_strain)};
  int                     failed;

  if (PgInitialize(&argc, &argv, NULL)) return 1;
  if (PetscSetFPTrap(PETSC_FP_TRAP_ON)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
