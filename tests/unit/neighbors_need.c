/* ranks: 1 2 4 */
/* When the lists have to be built anew, and when it is too late for that. */
#include "particles_discs.h"

static const Cloud cloud = {300, {-0.3, 0.2}, {1.0, 0.7}, 0.014};

typedef struct {
  PgParticles particles;
  PgNeighbors neighbors;
  PetscReal   skin; /* [m] */
} Lists;

static void Create(Lists *lists, PetscBool periodic)
{
  PetscReal *r, sum = 0;

  OK(PgParticlesCreate(PETSC_COMM_WORLD, &lists->particles));
  if (periodic) OK(PgParticlesSetPeriodicX(lists->particles, cloud.low[0], cloud.low[0] + cloud.size[0]));
  OK(PgNeighborsCreate(lists->particles, &lists->neighbors));
  OK(PgNeighborsSetFromOptions(lists->neighbors));
  CreateCloud(&cloud, lists->particles);
  r = GatherAll(lists->particles, PG_RADIUS);
  for (PetscInt j = 0; j < cloud.N; j++) sum += r[j];
  lists->skin = 0.3 * sum / (PetscReal)cloud.N;
  OK(PetscFree(r));
}

static void Destroy(Lists *lists)
{
  OK(PgNeighborsDestroy(&lists->neighbors));
  OK(PgParticlesDestroy(&lists->particles));
}

/* Moves the disc with this id, wherever it is. */
static void Move(Lists *lists, PetscInt which, PetscReal dx, PetscReal dy)
{
  const PetscInt *id;
  PetscInt        owned;
  PetscReal      *position;

  OK(PgParticlesGetSizes(lists->particles, &owned, NULL, NULL));
  OK(PgParticlesGetIds(lists->particles, &id));
  OK(PgParticlesGetArray(lists->particles, PG_POSITION, &position));
  for (PetscInt i = 0; i < owned; i++) {
    if (id[i] != which) continue;
    position[2 * i] += dx;
    position[2 * i + 1] += dy;
  }
}

static void half_the_skin_asks_for_a_build(void **state)
{
  Lists       lists;
  PetscBool   need;
  PetscInt    builds, before, after;
  PetscMPIInt size;

  (void)state;
  OK(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  for (int periodic = 0; periodic < 2; periodic++) {
    Create(&lists, (PetscBool)periodic);
    OK(PgNeighborsNeedBuild(lists.neighbors, &need));
    assert_true(need); /* there was no build */
    OK(PgNeighborsBuild(lists.neighbors));
    OK(PgNeighborsNeedBuild(lists.neighbors, &need));
    assert_false(need);
    Move(&lists, 123, 0.6 * 0.49 * lists.skin, -0.8 * 0.49 * lists.skin);
    OK(PgNeighborsNeedBuild(lists.neighbors, &need));
    assert_false(need);
    Move(&lists, 123, 0.6 * 0.02 * lists.skin, -0.8 * 0.02 * lists.skin);
    OK(PgNeighborsNeedBuild(lists.neighbors, &need));
    assert_true(need);
    OK(PgNeighborsBuild(lists.neighbors));
    OK(PgNeighborsNeedBuild(lists.neighbors, &need));
    assert_false(need);
    /* a distribution behind its back: the local numbers in the lists no longer hold */
    OK(PgParticlesGetRevision(lists.particles, &before));
    OK(PgParticlesForceMigration(lists.particles, 1));
    OK(PgParticlesDistribute(lists.particles, 0.1));
    OK(PgParticlesGetRevision(lists.particles, &after));
    OK(PgNeighborsNeedBuild(lists.neighbors, &need));
    assert_int_equal(need, before != after);
    if (size > 1) assert_true(need);
    OK(PgNeighborsBuild(lists.neighbors));
    CreateCloud(&cloud, lists.particles); /* new discs make every list stale */
    OK(PgNeighborsNeedBuild(lists.neighbors, &need));
    assert_true(need);
    OK(PgNeighborsGetRevision(lists.neighbors, &builds));
    assert_int_equal((int)builds, 3);
    Destroy(&lists);
  }
}

static void more_than_the_skin_is_an_error(void **state)
{
  Lists     lists;
  PetscBool need;

  (void)state;
  Create(&lists, PETSC_FALSE);
  OK(PgNeighborsBuild(lists.neighbors));
  Move(&lists, 5, 0, 0.99 * lists.skin);
  Move(&lists, 77, -0.98 * lists.skin, 0);
  OK(PgNeighborsNeedBuild(lists.neighbors, &need));
  assert_true(need);
  Move(&lists, 77, -0.03 * lists.skin, 0);
  ASSERT_FAILS(PgNeighborsNeedBuild(lists.neighbors, &need), PETSC_ERR_NOT_CONVERGED, "particle 77 at (");
  ASSERT_FAILS(PgNeighborsNeedBuild(lists.neighbors, &need), PETSC_ERR_NOT_CONVERGED, "more than their skin of");
  OK(PgNeighborsBuild(lists.neighbors)); /* a build by hand heals it */
  OK(PgNeighborsNeedBuild(lists.neighbors, &need));
  assert_false(need);
  Destroy(&lists);
}

static void not_a_number_is_an_error(void **state)
{
  Lists     lists;
  PetscBool need;

  (void)state;
  for (int y = 0; y < 2; y++) {
    Create(&lists, PETSC_FALSE);
    OK(PgNeighborsBuild(lists.neighbors));
    Move(&lists, 123, y ? 0 : NAN, y ? NAN : 0);
    ASSERT_FAILS(PgNeighborsNeedBuild(lists.neighbors, &need), PETSC_ERR_NOT_CONVERGED, "particle 123 is not finite");
    Destroy(&lists);
  }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(half_the_skin_asks_for_a_build),
    cmocka_unit_test(more_than_the_skin_is_an_error),
    cmocka_unit_test(not_a_number_is_an_error),
};

/* A skin other than the default, so that the option is seen to count. */
int main(int argc, char **argv)
{
  int failed;

  if (PgInitialize(&argc, &argv, "unit test\n")) return 1;
  if (PetscSetFPTrap(PETSC_FP_TRAP_ON)) return 1;
  if (PetscOptionsSetValue(NULL, "-neighbors_skin", "0.3")) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
