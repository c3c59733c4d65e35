/* ranks: 1 2 4 */
/* Contact history across list builds and migration: a run that rebuilds its lists all the time and deals the
   discs out anew to other ranks equals, bit by bit, a serial run with wide lists that never does. */
#include "dem_setup.h"

enum { COLUMNS = 10, ROWS = 9, N = COLUMNS * ROWS, STEPS = 90 };

static const PgContactParameters parameters = {.k_n        = 6e8,
                                               .k_s        = 4e8,
                                               .k_r        = 2e6,
                                               .k_theta    = 700,
                                               .c_n        = 200,
                                               .c_s        = 90,
                                               .c_r        = 20,
                                               .c_theta    = 2e-4,
                                               .mu_s       = 0.5,
                                               .mu_r       = 0.4,
                                               .mu_theta_r = 1e-4};

typedef struct {
  PetscReal position[2 * N], velocity[2 * N], spin[N], rotation[N], force[2 * N], torque[N], spring[N];
  PetscReal coordination[N], stress[4 * N], contact, total, energy, critical;
} Result;

static void Start(MPI_Comm comm, World *world)
{
  const PgPlate   bottom     = {.name = "bottom", .side = -1, .velocity = 0, .friction = 0.3};
  const PgPlate   top        = {.name = "top", .side = 1, .velocity = -0.3, .friction = -1};
  const PetscReal gravity[2] = {1.3, -9.7};
  static Disc     disc[N];

  FillHeap(COLUMNS, ROWS, 0.02, disc);
  for (PetscInt k = 0; k < COLUMNS; k++) {
    disc[k].plate         = 1;
    disc[k].vy            = 0;
    disc[N - 1 - k].plate = 2;
    disc[N - 1 - k].vy    = -0.3;
  }
  WorldCreate(comm, world);
  CHECK(PgDemSetParameters(world->dem, &parameters));
  CHECK(PgDemSetGravity(world->dem, gravity));
  CHECK(PgDemSetDamping(world->dem, 0.2, 11));
  CHECK(PgDemAddPlate(world->dem, &bottom, NULL));
  CHECK(PgDemAddPlate(world->dem, &top, NULL));
  WorldFill(world, N, disc);
  CHECK(PgDemForces(world->dem, 0));
}

static void Finish(World *world, Result *r)
{
  CHECK(PgDemComputeObservables(world->dem));
  WorldGet(world, "position", 2, N, r->position);
  WorldGet(world, "velocity", 2, N, r->velocity);
  WorldGet(world, "angular_velocity", 1, N, r->spin);
  WorldGet(world, "rotation", 1, N, r->rotation);
  WorldGet(world, "force", 2, N, r->force);
  WorldGet(world, "torque", 1, N, r->torque);
  WorldGet(world, "plate_spring", 1, N, r->spring);
  WorldGet(world, "coordination_number", 1, N, r->coordination);
  WorldGet(world, "stress", 4, N, r->stress);
  CHECK(PgDemGetLoad(world->dem, 1, &r->contact, &r->total));
  CHECK(PgDemKineticEnergy(world->dem, &r->energy));
  CHECK(PgDemCriticalTimeStep(world->dem, &r->critical));
}

static void AssertSameBits(PetscInt n, const PetscReal a[], const PetscReal b[])
{
  for (PetscInt k = 0; k < n; k++) assert_true(a[k] == b[k]);
}

static void RebuildsAndMigration(void **state)
{
  static Result quiet, busy;
  PetscInt      slipped = 0;
  World         world;

  (void)state;
  CHECK(PetscOptionsSetValue(NULL, "-neighbors_skin", "0.9"));
  Start(PETSC_COMM_SELF, &world);
  CHECK(PetscOptionsClearValue(NULL, "-neighbors_skin"));
  for (PetscInt k = 0; k < STEPS; k++) WorldStep(&world, 1.3e-6);
  assert_int_equal(world.builds, 1);
  Finish(&world, &quiet);
  WorldDestroy(&world);

  Start(PETSC_COMM_WORLD, &world);
  for (PetscInt k = 0; k < STEPS; k++) {
    WorldStep(&world, 1.3e-6);
    if (k % 7 == 3) {
      CHECK(PgParticlesForceMigration(world.particles, 1 + k % 3));
      WorldBuild(&world);
    }
  }
  assert_true(world.builds >= 14);
  Finish(&world, &busy);
  WorldDestroy(&world);

  for (PetscInt k = 0; k < N; k++) slipped += quiet.spring[k] != 0;
  assert_true(slipped > COLUMNS); /* the plates press */
  AssertSameBits(2 * N, quiet.position, busy.position);
  AssertSameBits(2 * N, quiet.velocity, busy.velocity);
  AssertSameBits(N, quiet.spin, busy.spin);
  AssertSameBits(N, quiet.rotation, busy.rotation);
  AssertSameBits(2 * N, quiet.force, busy.force);
  AssertSameBits(N, quiet.torque, busy.torque);
  AssertSameBits(N, quiet.spring, busy.spring);
  AssertSameBits(N, quiet.coordination, busy.coordination);
  AssertSameBits(4 * N, quiet.stress, busy.stress);
  assert_true(quiet.contact == busy.contact && quiet.total == busy.total && quiet.total != 0);
  assert_true(quiet.energy == busy.energy && quiet.energy > 0);
  assert_true(quiet.critical == busy.critical);
}

/* Both discs of a pair, on whatever ranks, hold the same record. */
static void BothSidesAgree(void **state)
{
  static PetscReal dense[N][N][3];
  const PetscInt  *offset, *id;
  const PetscReal *record;
  PetscInt         owned, count = 0;
  PgRagged         history = -1;
  World            world;

  (void)state;
  Start(PETSC_COMM_WORLD, &world);
  for (PetscInt k = 0; k < 40; k++) WorldStep(&world, 1.3e-6);
  CHECK(PgDemSaveHistory(world.dem));
  CHECK(PgParticlesGetRaggedCount(world.particles, &count));
  for (PetscInt k = 0; k < count; k++) {
    const char *name;
    PetscInt    components;
    unsigned    flags;

    CHECK(PgParticlesGetRaggedInfo(world.particles, k, &name, &components, &flags));
    if (strcmp(name, "contact_history")) continue;
    history = k;
    assert_int_equal(components, 4);
    assert_true(flags & PG_FIELD_RESTART);
  }
  assert_true(history >= 0);
  CHECK(PgParticlesGetRagged(world.particles, history, &offset, &record));
  CHECK(PgParticlesGetSizes(world.particles, &owned, NULL, NULL));
  CHECK(PgParticlesGetIds(world.particles, &id));
  memset(dense, 0, sizeof(dense));
  for (PetscInt i = 0; i < owned; i++)
    for (PetscInt c = offset[i]; c < offset[i + 1]; c++)
      memcpy(dense[id[i]][(PetscInt)record[4 * c]], &record[4 * c + 1], sizeof(dense[0][0]));
  MPI_Allreduce(MPI_IN_PLACE, dense, N * N * 3, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD);
  count = 0;
  for (PetscInt a = 0; a < N; a++) {
    for (PetscInt j = 0; j < a; j++) {
      assert_memory_equal(dense[a][j], dense[j][a], sizeof(dense[a][j]));
      count += dense[a][j][0] != 0 && dense[a][j][1] != 0 && dense[a][j][2] != 0;
    }
  }
  assert_true(count > N); /* there are about 3 pairs by disc, the larger part of them in contact */
  WorldDestroy(&world);
}

/* Forces for a list whose history has not been restored are refused. */
static void ForgottenRestore(void **state)
{
  World world;

  (void)state;
  Start(PETSC_COMM_WORLD, &world);
  CHECK(PgNeighborsBuild(world.neighbors));
  assert_int_equal(PgDemForces(world.dem, 1e-6), PETSC_ERR_ORDER);
  WorldDestroy(&world);
}

static int Tests(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(RebuildsAndMigration), cmocka_unit_test(BothSidesAgree),
                                     cmocka_unit_test(ForgottenRestore)};

  return cmocka_run_group_tests_name("contact history", tests, NULL, NULL);
}

int main(int argc, char *argv[]) { return RunTests(argc, argv, Tests); }
