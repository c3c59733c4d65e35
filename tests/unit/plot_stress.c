/* ranks: 1 2 */
/* The stress of all discs times their areas is the load on the plates times their distance (Love, Weber), in a panel
   that is compressed slowly. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include <porograin/simulation.h>

#define OK(call) assert_int_equal((int)(call), 0)

/* Sum of (c, d) of stress times area, and the heights of the touching points of the plates. */
static void Integrate(PgParticles particles, PetscReal integral[4], PetscReal height[2])
{
  PgField    stress, plate;
  PetscReal *x, *r, *sigma, *on;
  PetscInt   owned;

  OK(PgParticlesFindField(particles, "stress", &stress));
  OK(PgParticlesFindField(particles, "plate", &plate));
  assert_true(stress >= 0 && plate >= 0);
  OK(PgParticlesGetArray(particles, PG_POSITION, &x));
  OK(PgParticlesGetArray(particles, PG_RADIUS, &r));
  OK(PgParticlesGetArray(particles, stress, &sigma));
  OK(PgParticlesGetArray(particles, plate, &on));
  OK(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  integral[0] = integral[1] = integral[2] = integral[3] = 0;
  height[0] = height[1] = -PETSC_MAX_REAL; /* of -y below, of y above */
  for (PetscInt i = 0; i < owned; i++) {
    for (int c = 0; c < 4; c++) integral[c] += sigma[4 * i + c] * PETSC_PI * r[i] * r[i];
    if (on[i] == 1) height[0] = PetscMax(height[0], r[i] - x[2 * i + 1]);
    if (on[i] == 2) height[1] = PetscMax(height[1], r[i] + x[2 * i + 1]);
  }
  OK(MPI_Allreduce(MPI_IN_PLACE, integral, 4, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  OK(MPI_Allreduce(MPI_IN_PLACE, height, 2, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
}

static void test_load(void **state)
{
  PgSimulation simulation;
  PgParticles  particles;
  PgNeighbors  neighbors;
  PgDem        dem;
  PgPore       pore;
  PetscReal    integral[4], height[2], below, above, distance;

  (void)state;
  /* so rough that the lattice stands without side walls: its contacts lie at 30 degrees from the vertical, tan 0.58 */
  OK(PetscOptionsInsertString(NULL, "-case panel -fluid none -panel_columns 8 -panel_velocity 1e-3 -dem_local_damping "
                                    "0.7 -dem_mu_s 1.2 -plate_friction 1.2"));
  OK(PgSimulationCreate(PETSC_COMM_WORLD, &simulation));
  OK(PgSimulationSetFromOptions(simulation));
  OK(PgSimulationSetUp(simulation));
  for (PetscInt k = 0; k < 4000; k++) OK(PgSimulationStep(simulation));
  OK(PgSimulationGetParts(simulation, &particles, &neighbors, &dem, &pore));
  OK(PgDemComputeObservables(dem));
  OK(PgDemGetLoad(dem, 0, &below, NULL));
  OK(PgDemGetLoad(dem, 1, &above, NULL));
  Integrate(particles, integral, height);
  distance = height[0] + height[1];
  assert_true(above > 1000);
  /* the balance of forces: what is left of the speed of the plate, and damping, that lets 0.7 of a force rest */
  assert_true(PetscAbsReal(above - below) < 0.01 * above);
  /* the load is within 1 % the same at every height */
  assert_true(PetscAbsReal(integral[3] + above * distance) < 0.01 * above * distance);
  /* no moments: the same shear both ways, up to the same 1 % */
  assert_true(PetscAbsReal(integral[1] - integral[2]) < 0.01 * above * distance);
  /* free sides: across, only the friction of the plates holds */
  assert_true(PetscAbsReal(integral[0]) < 0.05 * above * distance);
  OK(PgSimulationDestroy(&simulation));
}

int main(int argc, char *argv[])
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_load)};
  int                     failed;

  if (PgInitialize(&argc, &argv, NULL)) return 1;
  if (PetscSetFPTrap(PETSC_FP_TRAP_ON)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
