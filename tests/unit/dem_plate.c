/* ranks: 1 2 3 */
/* Plates: reaction, slip, torque, prescribed motion; damping; stress. */
#include "dem_setup.h"

static const PetscReal k_n = 6e8, k_s = 1e8;

static void Start(World *world, const PetscReal gravity[2], PetscInt count, const Disc disc[])
{
  const PgContactParameters p      = {.k_n = k_n, .k_s = k_s, .mu_s = 0.5};
  const PgPlate             bottom = {.name = "bottom", .side = -1, .velocity = 0.02, .friction = 0.3};
  const PgPlate             top    = {.name = "top", .side = 1, .velocity = -0.07, .friction = -1};
  const PgPlate             bed    = {.name = "bed", .hold = PETSC_TRUE};
  PetscInt                  index;

  WorldCreate(PETSC_COMM_WORLD, world);
  CHECK(PgDemSetParameters(world->dem, &p));
  CHECK(PgDemSetGravity(world->dem, gravity));
  CHECK(PgDemAddPlate(world->dem, &bottom, &index));
  assert_int_equal(index, 0);
  CHECK(PgDemAddPlate(world->dem, &top, &index));
  assert_int_equal(index, 1);
  CHECK(PgDemAddPlate(world->dem, &bed, &index));
  assert_int_equal(index, 2);
  WorldFill(world, count, disc);
  CHECK(PgDemForces(world->dem, 0));
}

/* A column of two discs between the plates, gravity across and along, forces of water and from outside. */
static void Reactions(void **state)
{
  const PetscReal gravity[2] = {0.7, -9.81}, water[2] = {3, 17}, outer[2] = {-4, 23};
  const PetscReal u = 2e-6, r0 = 5e-3, r1 = 4e-3;
  const Disc      disc[] = {{.x = 0.01, .y = 0.02, .vy = 0.02, .r = r0, .m = 0.17, .plate = 1},
                            {.x = 0.01, .y = 0.02 + r0 + r1 - u, .vy = -0.07, .r = r1, .m = 0.11, .plate = 2},
                            {.x = 0.09, .y = 0.03, .r = r0, .m = 0.19, .plate = 2},
                            {.x = 0.19, .y = 0.03, .r = r0, .m = 0.21, .plate = 3}};
  PetscReal       contact, total, force[8], torque[4], stress[16], touching[4], v[8], x[8];
  World           world;

  (void)state;
  Start(&world, gravity, 4, disc);
  WorldSet(&world, "fluid_force", 2, 1, water);
  WorldSet(&world, "external_force", 2, 1, outer);
  CHECK(PgDemForces(world.dem, 1e-6));
  /* forces 1200 N from an overlap of 2e-6 known to 4e-18 of lengths 3e-2 m: 3e-9 N */
  CHECK(PgDemGetLoad(world.dem, 0, &contact, &total));
  assert_true(PetscAbsReal(contact - k_n * u) < 1e-8 && PetscAbsReal(total - (k_n * u + 0.17 * 9.81)) < 1e-8);
  CHECK(PgDemGetLoad(world.dem, 1, &contact, &total)); /* disc 2 hangs on the plate: pulls with its weight */
  assert_true(PetscAbsReal(contact - k_n * u) < 1e-8);
  assert_true(PetscAbsReal(total - (k_n * u - 0.11 * 9.81 + 17 + 23 - 0.19 * 9.81)) < 1e-8);
  WorldGet(&world, "force", 2, 4, force);
  WorldGet(&world, "torque", 1, 4, torque);
  /* nothing vertical; horizontally weight and forces, and no slip yet */
  for (PetscInt k = 0; k < 4; k++) assert_true(force[2 * k + 1] == 0 && torque[k] == 0);
  assert_true(PetscAbsReal(force[0] - 0.17 * 0.7) < 1e-14 && PetscAbsReal(force[2] - (0.11 * 0.7 + 3 - 4)) < 1e-14);
  assert_true(force[6] == 0);
  CHECK(PgDemComputeObservables(world.dem));
  WorldGet(&world, "stress", 4, 4, stress);
  WorldGet(&world, "coordination_number", 1, 4, touching);
  assert_true(touching[0] == 2 && touching[1] == 2 && touching[2] == 0 && touching[3] == 0);
  /* (0, 0): contact below the top of disc 0, plate at its bottom; both push with their forces at r0 */
  assert_true(PetscAbsReal(stress[3] * PETSC_PI * r0 + 2 * k_n * u + 0.17 * 9.81) < 1e-8);
  assert_true(stress[11] > 0); /* the hanging disc is pulled apart */
  for (PetscInt k = 0; k < 10; k++) WorldStep(&world, 1e-6);
  WorldGet(&world, "velocity", 2, 4, v);
  WorldGet(&world, "position", 2, 4, x);
  assert_true(v[1] == 0.02 && v[3] == -0.07 && v[5] == -0.07 && v[6] == 0 && v[7] == 0);
  assert_true(v[2] < 0); /* a sixth of the swing on its slip springs */
  assert_true(PetscAbsReal(x[5] - (0.03 - 0.07 * 10e-6)) < 1e-16 && x[6] == 0.19 && x[7] == 0.03);
  WorldDestroy(&world);
}

/* The stress of a disc squeezed from both sides, share of the pores included. */
static void StressOfARow(void **state)
{
  const PetscReal   none[2] = {0, 0}, u = 2e-6, r = 5e-3, porosity = 0.2;
  const PgFieldInfo info = {"porosity", 1, "1", "given", PG_FIELD_MIGRATE};
  const PetscReal   c = 0.28, s = 0.96; /* direction of the row */
  Disc              disc[3];
  PetscReal         sigma[12], expected;
  PgField           field;
  World             world;

  (void)state;
  for (PetscInt k = 0; k < 3; k++) {
    const PetscReal at = (2 * r - u) * (PetscReal)k;

    disc[k] = (Disc){.x = 0.1 + at * c, .y = 0.1 + at * s, .r = r, .m = 0.1 + 0.01 * (PetscReal)k};
  }
  Start(&world, none, 3, disc);
  CHECK(PgDemComputeObservables(world.dem));
  WorldGet(&world, "stress", 4, 3, sigma);
  expected = -2 * k_n * u / (PETSC_PI * r); /* two forces at arms r over pi r^2 */
  /* the overlap is known to 1e-12 of itself */
  assert_true(PetscAbsReal(sigma[4] - expected * c * c) < 1e-10 * -expected);
  assert_true(PetscAbsReal(sigma[5] - expected * c * s) < 1e-10 * -expected);
  assert_true(PetscAbsReal(sigma[6] - expected * c * s) < 1e-10 * -expected);
  assert_true(PetscAbsReal(sigma[7] - expected * s * s) < 1e-10 * -expected);
  assert_true(PetscAbsReal(sigma[0] - 0.5 * expected * c * c) < 1e-10 * -expected);
  CHECK(PgParticlesRegisterField(world.particles, &info, &field));
  WorldSet(&world, "porosity", 1, 1, &porosity);
  CHECK(PgDemComputeObservables(world.dem));
  WorldGet(&world, "stress", 4, 3, sigma);
  assert_true(PetscAbsReal(sigma[7] - 0.8 * expected * s * s) < 1e-10 * -expected);
  WorldDestroy(&world);
}

/* Slip spring of both plates: slope k_s on v_x - side r w, torque -side r F_x, cap friction times reaction. */
static void Slip(void **state)
{
  const PetscReal none[2] = {0, 0}, r = 5e-3, dt = 1e-9;
  const PetscReal push[2][2] = {{0, -1300}, {0, 1100}};
  const Disc      disc[]     = {{.x = 0.01, .y = 0.02, .vx = 0.4, .vy = 0.02, .w = 33, .r = r, .m = 0.17, .plate = 1},
                                {.x = 0.05, .y = 0.02, .vx = 0.4, .vy = -0.07, .w = 33, .r = r, .m = 0.17, .plate = 2}};
  PetscReal       force[4], torque[2], spring[2], sigma[8];
  World           world;

  (void)state;
  Start(&world, none, 2, disc);
  for (PetscInt k = 0; k < 2; k++) WorldSet(&world, "external_force", 2, k, push[k]);
  for (PetscInt k = 0; k < 10; k++) CHECK(PgDemForces(world.dem, dt));
  WorldGet(&world, "force", 2, 2, force);
  WorldGet(&world, "torque", 1, 2, torque);
  /* contact points move at 0.4 + 0.165 on the bottom plate, 0.4 - 0.165 under the top one; forces of 0.5 N are
     sums of 10 terms */
  assert_true(PetscAbsReal(force[0] + k_s * 0.565 * 10 * dt) < 1e-14);
  assert_true(PetscAbsReal(force[2] + k_s * 0.235 * 10 * dt) < 1e-14);
  assert_true(PetscAbsReal(torque[0] - r * force[0]) < 1e-16 && PetscAbsReal(torque[1] + r * force[2]) < 1e-16);
  /* f_x at the arm side r over pi r^2; sums of two terms */
  CHECK(PgDemComputeObservables(world.dem));
  WorldGet(&world, "stress", 4, 2, sigma);
  assert_true(PetscAbsReal(sigma[1] * PETSC_PI * r + force[0]) < 1e-14 && sigma[2] == 0);
  assert_true(PetscAbsReal(sigma[5] * PETSC_PI * r - force[2]) < 1e-14 && sigma[6] == 0);
  for (PetscInt k = 0; k < 100; k++) CHECK(PgDemForces(world.dem, 1e-6));
  WorldGet(&world, "force", 2, 2, force);
  WorldGet(&world, "plate_spring", 1, 2, spring);
  /* friction 0.3 of its own, and 0.5 from the default; the stored spring is capped too */
  assert_true(PetscAbsReal(force[0] + 0.3 * 1300) < 1e-12 && PetscAbsReal(force[2] + 0.5 * 1100) < 1e-12);
  assert_true(spring[0] == force[0] && spring[1] == force[2]);
  for (PetscInt k = 0; k < 2; k++) WorldSet(&world, "external_force", 2, k, push[1 - k]);
  CHECK(PgDemForces(world.dem, 1e-6)); /* pulled off: no friction, nothing remembered */
  WorldGet(&world, "force", 2, 2, force);
  WorldGet(&world, "plate_spring", 1, 2, spring);
  assert_true(force[0] == 0 && force[2] == 0 && spring[0] == 0 && spring[1] == 0);
  WorldDestroy(&world);
}

/* A disc thrown onto a rough floor slides at v0 - mu g t, and rolls without slip at 2/3 v0 from then on. */
static void SlideThenRoll(void **state)
{
  const PetscReal gravity[2] = {0, -9.81}, v0 = 0.1, r = 5e-3, dt = 1e-5, mu = 0.3;
  const PgPlate   floor = {.name = "floor", .side = -1, .friction = 0.3};
  const Disc      disc  = {.x = 0.01, .y = 0.02, .vx = v0, .r = r, .m = 0.17, .plate = 4};
  PetscReal       v[2], w;
  World           world;

  (void)state;
  Start(&world, gravity, 0, NULL);
  CHECK(PgDemAddPlate(world.dem, &floor, NULL));
  WorldFill(&world, 1, &disc);
  CHECK(PgDemForces(world.dem, 0));
  for (PetscInt k = 0; k < 600; k++) WorldStep(&world, dt); /* rolling begins at v0/(3 mu g) = 0.01133 s */
  WorldGet(&world, "velocity", 2, 1, v);
  WorldGet(&world, "angular_velocity", 1, 1, &w);
  /* the first steps, until the spring is at its cap of 5e-9 m at 0.1 m/s: less than one step, 3e-5 m/s */
  assert_true(PetscAbsReal(v[0] - (v0 - mu * 9.81 * 600 * dt)) < 4e-5);
  assert_true(PetscAbsReal(w * r + 2 * mu * 9.81 * 600 * dt) < 8e-5);
  for (PetscInt k = 0; k < 700; k++) WorldStep(&world, dt);
  WorldGet(&world, "velocity", 2, 1, v);
  WorldGet(&world, "angular_velocity", 1, 1, &w);
  /* the spring swings on with an amplitude of mu g sqrt(m/(3 k_s)) = 7e-5 m/s of v, twice that of w r */
  assert_true(PetscAbsReal(v[0] - 2 * v0 / 3) < 1e-4);
  assert_true(PetscAbsReal(v[0] + w * r) < 3e-4);
  WorldDestroy(&world);
}

/* Local damping opposes the half-step velocity by alpha |F|, viscous damping takes c m v and c I w; what is
   prescribed is not damped. */
static void Damping(void **state)
{
  const PetscReal none[2] = {0, 0}, r = 5e-3, alpha = 0.3, c = 13, m = 0.17, inertia = 0.5 * m * r * r;
  const PetscReal push[5][2] = {{70, -90}, {70, -90}, {70, -90}, {55, -1300}, {5, 6}};
  const Disc      disc[]     = {{.x = 0.01, .y = 0.01, .vx = 2, .vy = 3, .r = r, .m = m},
                                {.x = 0.04, .y = 0.01, .vx = -2, .vy = -3, .r = r, .m = m},
                                {.x = 0.07, .y = 0.01, .w = -7, .r = r, .m = m},
                                {.x = 0.10, .y = 0.01, .vx = 0.4, .vy = 0.02, .w = 33, .r = r, .m = m, .plate = 1},
                                {.x = 0.13, .y = 0.01, .r = r, .m = m, .plate = 3}};
  PetscReal       f[10], torque[5], slip;
  World           world;

  (void)state;
  Start(&world, none, 5, disc);
  CHECK(PgDemSetDamping(world.dem, alpha, c));
  for (PetscInt k = 0; k < 5; k++) WorldSet(&world, "external_force", 2, k, push[k]);
  CHECK(PgDemForces(world.dem, 1e-9));
  WorldGet(&world, "force", 2, 5, f);
  WorldGet(&world, "torque", 1, 5, torque);
  /* a few roundings of numbers up to 100 */
  assert_true(PetscAbsReal(f[0] - (70 - alpha * 70 - c * m * 2)) < 1e-13);
  assert_true(PetscAbsReal(f[1] - (-90 - alpha * 90 - c * m * 3)) < 1e-13);
  assert_true(PetscAbsReal(f[2] - (70 + alpha * 70 + c * m * 2)) < 1e-13);
  assert_true(PetscAbsReal(f[3] - (-90 + alpha * 90 + c * m * 3)) < 1e-13);
  assert_true(f[4] == 70 && f[5] == -90); /* at rest there is no sign */
  assert_true(PetscAbsReal(torque[2] + c * inertia * -7) < 1e-16);
  slip = k_s * 0.565 * 1e-9;
  assert_true(PetscAbsReal(f[6] - ((55 - slip) * (1 - alpha) - c * m * 0.4)) < 1e-13);
  /* torque of the slip is negative, spin positive: damping adds to it */
  assert_true(PetscAbsReal(torque[3] - (-r * slip * (1 + alpha) - c * inertia * 33)) < 1e-16);
  assert_true(f[7] == 0 && f[8] == 0 && f[9] == 0 && torque[4] == 0);
  WorldDestroy(&world);
}

static int Tests(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Reactions), cmocka_unit_test(StressOfARow),
                                     cmocka_unit_test(Slip), cmocka_unit_test(SlideThenRoll),
                                     cmocka_unit_test(Damping)};

  return cmocka_run_group_tests_name("plates", tests, NULL, NULL);
}

int main(int argc, char *argv[]) { return RunTests(argc, argv, Tests); }
