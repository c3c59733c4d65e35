/* ranks: 1 2 4
   timeout: 60

   Forces and kick in one pass through the discs give the bits of the two passes one after the other: in a packing with
   several stretches of pairs, discs on plates, discs at walls, dampings and list builds. */
#include "dem_setup.h"

enum { COLUMNS = 40, ROWS = 40, DISCS = ROWS * COLUMNS, STEPS = 100 };

static void MakeWorld(const Disc disc[], PetscBool energy, World *world)
{
  const PgContactParameters p = {
      .k_n = 6e8, .k_s = 4e8, .k_r = 2e3, .k_theta = 700, .mu_s = 0.5, .mu_r = 0.4, .mu_theta_r = 1e-4, .c_n = 300};
  const PgPlate top    = {.name = "top", .side = 1, .velocity = -0.3, .friction = 0.2};
  const PgPlate bottom = {.name = "bottom", .hold = PETSC_TRUE};
  const PgWall  left   = {.name = "left", .point = {-4.9e-3, 0}, .normal = {1, 0}, .friction = 0.3};
  const PgWall  right  = {.name     = "right",
                          .kind     = PG_WALL_MOVING,
                          .point    = {9.99e-3 * (COLUMNS - 0.5) + 4.9e-3, 0},
                          .normal   = {-1, 0},
                          .velocity = {-0.1, 0}};

  CHECK(PetscOptionsSetValue(NULL, "-neighbors_skin", "0.005")); /* lists are built anew during the test */
  WorldCreate(PETSC_COMM_WORLD, world);
  CHECK(PgDemSetParameters(world->dem, &p));
  CHECK(PgDemSetDamping(world->dem, 0.3, 5));
  CHECK(PgDemSetEnergy(world->dem, energy));
  CHECK(PgDemAddPlate(world->dem, &bottom, NULL));
  CHECK(PgDemAddPlate(world->dem, &top, NULL));
  CHECK(PgDemAddWall(world->dem, &left, NULL));
  CHECK(PgDemAddWall(world->dem, &right, NULL));
  WorldFill(world, DISCS, disc);
  CHECK(PgDemForces(world->dem, 0));
}

static void SameBits(World *one, World *two, const char name[], PetscInt components)
{
  static PetscReal a[2 * DISCS], b[2 * DISCS];
  PetscReal        most = 0;

  WorldGet(one, name, components, DISCS, a);
  WorldGet(two, name, components, DISCS, b);
  assert_memory_equal(a, b, sizeof(*a) * (size_t)(components * DISCS));
  for (PetscInt k = 0; k < components * DISCS; k++) most = PetscMax(most, PetscAbsReal(a[k]));
  assert_true(most > 0); /* zeros would agree, too */
}

static void AtOnceAndApart(void **state)
{
  const PetscReal dt = 2e-6;
  static Disc     disc[DISCS];

  (void)state;
  FillHeap(COLUMNS, ROWS, 0.01, disc);
  for (PetscInt k = 0; k < COLUMNS; k++) {
    disc[k].plate                   = 1;
    disc[DISCS - COLUMNS + k].plate = 2;
  }
  for (PetscBool energy = PETSC_FALSE; energy <= PETSC_TRUE; energy++) {
    PgContactList list;
    World         apart, at_once;

    MakeWorld(disc, PETSC_FALSE, &apart);
    MakeWorld(disc, energy, &at_once);
    CHECK(PgNeighborsGetContacts(at_once.neighbors, &list));
    for (PetscInt k = 1; k < list.interior; k++)
      assert_true(PetscMin(list.low[k - 1], list.high[k - 1]) <= PetscMin(list.low[k], list.high[k]));
    for (PetscInt step = 0; step < STEPS; step++) {
      WorldStep(&apart, dt);
      WorldMove(&at_once, dt);
      CHECK(PgDemForcesKick(at_once.dem, dt));
    }
    assert_true(apart.builds > 1 && apart.builds == at_once.builds);
    SameBits(&apart, &at_once, "position", 2);
    SameBits(&apart, &at_once, "velocity", 2);
    SameBits(&apart, &at_once, "angular_velocity", 1);
    SameBits(&apart, &at_once, "force", 2);
    SameBits(&apart, &at_once, "torque", 1);
    SameBits(&apart, &at_once, "plate_reaction", 2);
    WorldDestroy(&at_once);
    WorldDestroy(&apart);
  }
}

static int Tests(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(AtOnceAndApart)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(int argc, char *argv[]) { return RunTests(argc, argv, Tests); }
