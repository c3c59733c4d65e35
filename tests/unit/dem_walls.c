/* ranks: 1 2 4 */
/* Walls: the law at a wall, memory across list builds and migration, motion, servo control, observables. */
#include "dem_setup.h"

enum { COLUMNS = 9, ROWS = 8, N = COLUMNS * ROWS, STEPS = 120, WALLS = 5 };

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

static void AddWall(World *world, const PgWall *wall) { CHECK(PgDemAddWall(world->dem, wall, NULL)); }

/* One disc and an inclined wall that moves: force and torque of every part of the law, written out. */
static void AtAWall(PetscReal w)
{
  const PetscReal     r = 4e-3, u = 3e-6, dt = 1e-9, nx = 0.6, ny = 0.8; /* n from disc to wall */
  const PetscReal     v[2] = {0.31, -0.12}, vw[2] = {-0.05, 0.02};
  const PgWall        wall = {.name     = "slope",
                              .kind     = PG_WALL_MOVING,
                              .point    = {0.1 + (r - u) * nx - 3 * ny, 0.2 + (r - u) * ny + 3 * nx},
                              .normal   = {-nx, -ny},
                              .velocity = {vw[0], vw[1]},
                              .friction = 0.3};
  const Disc          disc = {.x = 0.1, .y = 0.2, .vx = v[0], .vy = v[1], .w = w, .r = r, .m = 0.17};
  PgContactForce      f;
  PgContactHistory    h = {0, 0, 0};
  PgContactMotion     motion;
  PgContactParameters p = parameters;
  PetscReal           force[2], torque, on_wall[2];
  World               world;

  WorldCreate(PETSC_COMM_WORLD, &world);
  CHECK(PgDemSetParameters(world.dem, &p));
  AddWall(&world, &wall);
  WorldFill(&world, 1, &disc);
  motion = (PgContactMotion){.overlap      = u,
                             .overlap_rate = (v[0] - vw[0]) * nx + (v[1] - vw[1]) * ny,
                             .sliding_rate = -(v[0] - vw[0]) * ny + (v[1] - vw[1]) * nx + r * w,
                             .rolling_rate = -r * w,
                             .spin_rate    = w};
  p.mu_s = p.mu_r = 0.3;
  for (PetscInt k = 0; k < 2000; k++) { /* from sticking to all caps; the disc does not move */
    CHECK(PgDemForces(world.dem, k < 1000 ? dt : 1e4 * dt));
    f = PgContactLawLi2007(&p, &motion, k < 1000 ? dt : 1e4 * dt, &h);
    if (k != 5 && k != 1999) continue;
    WorldGet(&world, "force", 2, 1, force);
    WorldGet(&world, "torque", 1, 1, &torque);
    /* the overlap is a difference of lengths up to 3 m: known to 4e-16, forces to 1e-9 of 1800 N */
    assert_true(PetscAbsReal(force[0] - (f.F_N * nx - f.F_T * ny)) < 3e-6);
    assert_true(PetscAbsReal(force[1] - (f.F_N * ny + f.F_T * nx)) < 3e-6);
    assert_true(PetscAbsReal(torque - (r * f.F_T + f.M_r)) < 3e-8);
    CHECK(PgDemGetWallForce(world.dem, 0, on_wall));
    assert_true(on_wall[0] == -force[0] && on_wall[1] == -force[1]);
    /* the friction of the wall, not that of the discs; rolling adds to it or cancels it */
    if (k == 5) assert_true(PetscAbsReal(f.F_T) < 0.2 * PetscAbsReal(f.F_N) && f.F_T != 0);
    if (k == 1999) assert_true(w > 0 ? f.F_T == 0.3 * -f.F_N : f.F_T == 0);
  }
  WorldDestroy(&world);
}

static void LawAtAWall(void **state)
{
  (void)state;
  AtAWall(23);
  AtAWall(-23);
}

/* Friction that a wall does not give is the default of walls, or that of the discs. */
static void DefaultFriction(void **state)
{
  const PgWall wall = {.name = "floor", .normal = {0, 1}, .friction = -1};
  PgWall       got;
  PetscInt     count;
  World        world;

  (void)state;
  WorldCreate(PETSC_COMM_WORLD, &world);
  CHECK(PgDemSetParameters(world.dem, &parameters));
  AddWall(&world, &wall);
  CHECK(PgDemGetWall(world.dem, 0, &got));
  assert_true(got.friction == 0.5);
  CHECK(PetscOptionsSetValue(NULL, "-wall_friction", "0.125"));
  CHECK(PgDemSetFromOptions(world.dem));
  CHECK(PetscOptionsClearValue(NULL, "-wall_friction"));
  CHECK(PgDemGetWall(world.dem, 0, &got));
  assert_true(got.friction == 0.125);
  CHECK(PgDemGetWallCount(world.dem, &count));
  assert_int_equal(count, 1);
  WorldDestroy(&world);
}

/* ---- a heap in a box of five walls ---- */

typedef struct {
  PetscReal position[2 * N], velocity[2 * N], spin[N], force[2 * N], torque[N], reaction[2 * N];
  PetscReal coordination[N], stress[4 * N], on_wall[WALLS][2], critical;
  PgWall    wall[WALLS];
  PetscBool accounts;
  PgEnergy  energy;
} Result;

static void Start(MPI_Comm comm, PetscBool energy, World *world)
{
  const PgPlate   press      = {.name = "press", .side = 1, .velocity = -0.3, .friction = 0.2};
  const PetscReal gravity[2] = {1.3, -9.7}, width = 9.99e-3 * (COLUMNS - 0.5) + 9.8e-3;
  const PgWall    floor  = {.name = "floor", .point = {0, -4.9e-3}, .normal = {0, 1}, .friction = 0.3};
  const PgWall    left   = {.name = "left", .point = {-4.9e-3, 0}, .normal = {1, 0}, .friction = -1};
  const PgWall    right  = {.name         = "right",
                            .kind         = PG_WALL_SERVO,
                            .point        = {width - 4.9e-3, 0},
                            .normal       = {-1, 0},
                            .friction     = -1,
                            .stress       = 2e5,
                            .length       = 0.06,
                            .max_velocity = 5};
  const PgWall    corner = {.name     = "corner",
                            .kind     = PG_WALL_MOVING,
                            .point    = {-2e-3, -2e-3},
                            .normal   = {0.8, 0.6},
                            .velocity = {3, 1},
                            .friction = 0.4};
  const PgWall    away   = {.name = "away", .point = {0, 9}, .normal = {0, -1}, .friction = 0.4};
  static Disc     disc[N];

  FillHeap(COLUMNS, ROWS, 0.02, disc);
  for (PetscInt k = 0; k < COLUMNS; k++) {
    disc[N - 1 - k].plate = 1;
    disc[N - 1 - k].vy    = -0.3;
  }
  WorldCreate(comm, world);
  CHECK(PgDemSetParameters(world->dem, &parameters));
  CHECK(PgDemSetEnergy(world->dem, energy));
  CHECK(PgDemSetGravity(world->dem, gravity));
  CHECK(PgDemSetDamping(world->dem, 0.2, 11));
  CHECK(PgDemAddPlate(world->dem, &press, NULL));
  AddWall(world, &floor);
  AddWall(world, &left);
  AddWall(world, &right);
  WorldFill(world, N, disc);
  AddWall(world, &corner); /* walls may come when the lists are there already */
  AddWall(world, &away);
  CHECK(PgDemForces(world->dem, 0));
}

static void Finish(World *world, Result *r)
{
  CHECK(PgDemComputeObservables(world->dem));
  WorldGet(world, "position", 2, N, r->position);
  WorldGet(world, "velocity", 2, N, r->velocity);
  WorldGet(world, "angular_velocity", 1, N, r->spin);
  WorldGet(world, "force", 2, N, r->force);
  WorldGet(world, "torque", 1, N, r->torque);
  WorldGet(world, "plate_reaction", 2, N, r->reaction);
  WorldGet(world, "coordination_number", 1, N, r->coordination);
  WorldGet(world, "stress", 4, N, r->stress);
  for (PetscInt k = 0; k < WALLS; k++) {
    CHECK(PgDemGetWallForce(world->dem, k, r->on_wall[k]));
    CHECK(PgDemGetWall(world->dem, k, &r->wall[k]));
  }
  CHECK(PgDemCriticalTimeStep(world->dem, &r->critical));
  CHECK(PgDemHasEnergy(world->dem, &r->accounts));
  if (r->accounts) CHECK(PgDemGetEnergy(world->dem, &r->energy));
}

static void AssertSameBits(PetscInt n, const PetscReal a[], const PetscReal b[])
{
  for (PetscInt k = 0; k < n; k++)
    if (a[k] != b[k]) fail_msg("value %d of %d: %.17g and %.17g", (int)k, (int)n, (double)a[k], (double)b[k]);
}

/* A serial run with wide lists that builds them once. */
static void Quiet(PetscBool energy, Result *result)
{
  World world;

  CHECK(PetscOptionsSetValue(NULL, "-neighbors_skin", "0.9"));
  Start(PETSC_COMM_SELF, energy, &world);
  CHECK(PetscOptionsClearValue(NULL, "-neighbors_skin"));
  for (PetscInt k = 0; k < STEPS; k++) WorldStep(&world, 1.3e-6);
  assert_int_equal(world.builds, 1);
  Finish(&world, result);
  WorldDestroy(&world);
}

/* Lists rebuilt all the time and discs dealt out anew to other ranks give the bits of that run. So do the energy
   accounts, and keeping them changes nothing else. */
static void RebuildsAndMigration(void **state)
{
  static Result quiet, accounted, busy;
  World         world;

  (void)state;
  Quiet(PETSC_FALSE, &quiet);
  Quiet(PETSC_TRUE, &accounted);
  assert_true(!quiet.accounts && accounted.accounts);

  Start(PETSC_COMM_WORLD, PETSC_TRUE, &world);
  for (PetscInt k = 0; k < STEPS; k++) {
    WorldStep(&world, 1.3e-6);
    if (k % 7 == 3) {
      CHECK(PgParticlesForceMigration(world.particles, 1 + k % 3));
      WorldBuild(&world);
    }
    if (k % 7 == 5) { /* forces of walls are there between builds and evaluations, too */
      PetscReal before[2], after[2];
      CHECK(PgDemGetWallForce(world.dem, 0, before));
      WorldBuild(&world);
      CHECK(PgDemGetWallForce(world.dem, 0, after));
      assert_true(before[0] == after[0] && before[1] == after[1]);
    }
  }
  assert_true(world.builds >= 30);
  Finish(&world, &busy);
  WorldDestroy(&world);

  for (PetscInt k = 0; k < 4; k++) /* each of them matters, sideways as well */
    assert_true(PetscAbsReal(quiet.on_wall[k][0]) > 10 && PetscAbsReal(quiet.on_wall[k][1]) > 10);
  assert_true(quiet.on_wall[4][0] == 0 && quiet.on_wall[4][1] == 0);
  assert_true(quiet.wall[2].point[0] != 9.99e-3 * (COLUMNS - 0.5) + 4.9e-3 && quiet.wall[2].velocity[0] != 0);
  AssertSameBits(2 * N, quiet.position, busy.position);
  AssertSameBits(2 * N, quiet.velocity, busy.velocity);
  AssertSameBits(N, quiet.spin, busy.spin);
  AssertSameBits(2 * N, quiet.force, busy.force);
  AssertSameBits(N, quiet.torque, busy.torque);
  AssertSameBits(2 * N, quiet.reaction, busy.reaction);
  AssertSameBits(N, quiet.coordination, busy.coordination);
  AssertSameBits(4 * N, quiet.stress, busy.stress);
  for (PetscInt k = 0; k < WALLS; k++) {
    AssertSameBits(2, quiet.on_wall[k], busy.on_wall[k]);
    AssertSameBits(2, quiet.wall[k].point, busy.wall[k].point);
    AssertSameBits(2, quiet.wall[k].velocity, busy.wall[k].velocity);
  }
  assert_true(quiet.critical == busy.critical);
  AssertSameBits(sizeof(PgEnergy) / sizeof(PetscReal), (const PetscReal *)&accounted.energy,
                 (const PetscReal *)&busy.energy);
  assert_true(busy.energy.friction_sliding > 0 && busy.energy.work_walls != 0 && busy.energy.work_plates != 0);
}

/* A wall that comes from far beyond the skin meets discs at rest, whose lists never need a build, and sweeps them up:
   both get at least the speed of the wall (exactly twice that without damping). */
static void WallFromAfar(void **state)
{
  const PgContactParameters p = {.k_n = 6e8};
  const Disc   disc[2] = {{.x = 0.05, .y = 0.02, .r = 4e-3, .m = 0.17}, {.x = 0.05, .y = 0.07, .r = 6e-3, .m = 0.19}};
  const PgWall wall    = {.name = "piston", .kind = PG_WALL_MOVING, .normal = {1, 0}, .velocity = {2, 0}};
  PetscReal    v[4], way;
  World        world;

  (void)state;
  WorldCreate(PETSC_COMM_WORLD, &world);
  CHECK(PgDemSetParameters(world.dem, &p));
  AddWall(&world, &wall);
  WorldFill(&world, 2, disc);
  CHECK(PgDemForces(world.dem, 0));
  for (PetscInt k = 0; k < 12200; k++) WorldStep(&world, 2e-6); /* 0.0488 m: both have been hit once */
  WorldGet(&world, "velocity", 2, 2, v);
  /* the collision takes 25 steps: the energy is known to (omega dt)^2/2 = 1 % */
  assert_true(PetscAbsReal(v[0] - 4) < 0.04 && PetscAbsReal(v[2] - 4) < 0.04);
  assert_true(v[1] == 0 && v[3] == 0);
  CHECK(PgDemGetWallDisplacement(world.dem, 0, &way));
  assert_true(PetscAbsReal(way - 0.0488) < 1e-12); /* 12200 sums with rounding 3e-18 */
  WorldDestroy(&world);
}

/* A servo wall on a row of three discs over a fixed wall: the force becomes stress times length, whether that is given
   or the distance of two side walls; the discs come to rest at the overlaps of that force. */
static void Servo(void **state)
{
  const PgContactParameters p    = {.k_n = 6e8, .k_s = 1e8, .mu_s = 0.5};
  const PetscReal           r[3] = {5e-3, 4e-3, 6e-3}, stress = 3e4, length = 0.04;
  const PgWall              floor   = {.name = "floor", .normal = {0, 1}};
  const PgWall              left    = {.name = "left", .point = {-0.02, 0}, .normal = {1, 0}};
  const PgWall              right   = {.name = "right", .point = {0.02, 0}, .normal = {-1, 0}};
  PgWall                    lid     = {.name         = "lid",
                                       .kind         = PG_WALL_SERVO,
                                       .point        = {0, 0.0301},
                                       .normal       = {0, -1},
                                       .stress       = stress,
                                       .max_velocity = 0.5};
  Disc                      disc[3] = {{.y = r[0], .r = r[0], .m = 0.17},
                                       {.y = 2 * r[0] + r[1], .r = r[1], .m = 0.11},
                                       {.y = 2 * r[0] + 2 * r[1] + r[2], .r = r[2], .m = 0.21}};

  (void)state;
  for (PetscInt given = 0; given < 2; given++) {
    const PetscReal u = stress * length / p.k_n;
    PetscReal       force[2], x[6], way;
    PgWall          now;
    World           world;

    lid.length = given ? length : 0;
    WorldCreate(PETSC_COMM_WORLD, &world);
    CHECK(PgDemSetParameters(world.dem, &p));
    CHECK(PgDemSetDamping(world.dem, 0.5, 0));
    AddWall(&world, &floor);
    AddWall(&world, &lid);
    if (!given) {
      AddWall(&world, &left);
      AddWall(&world, &right);
    }
    WorldFill(&world, 3, disc);
    CHECK(PgDemForces(world.dem, 0));
    WorldStep(&world, 2e-6);
    CHECK(PgDemGetWall(world.dem, 1, &now));
    assert_true(now.velocity[1] == -0.5); /* it has 0.1 mm to go: at full speed */
    for (PetscInt k = 0; k < 5000; k++) WorldStep(&world, 2e-6);
    CHECK(PgDemGetWallForce(world.dem, 1, force));
    /* the discs swing with a period of 50 steps, damped by a factor of 2 or more in each: 2^-80 of the start; the force
       is known from lengths of 0.03 m to 3e-18*6e8 N */
    assert_true(PetscAbsReal(force[1] - stress * length) < 1e-8 && force[0] == 0);
    CHECK(PgDemGetWallForce(world.dem, 0, force));
    assert_true(PetscAbsReal(force[1] + stress * length) < 1e-8);
    WorldGet(&world, "position", 2, 3, x);
    assert_true(PetscAbsReal(x[1] - (r[0] - u)) < 1e-16 && PetscAbsReal(x[3] - (2 * r[0] + r[1] - 2 * u)) < 1e-16);
    CHECK(PgDemGetWallDisplacement(world.dem, 1, &way));
    assert_true(PetscAbsReal(way - (1e-4 + 4 * u)) < 1e-15);
    WorldDestroy(&world);
  }
}

/* Stress and number of contacts of a disc in a corner; a wall that is near without touching does not count. */
static void Observables(void **state)
{
  const PgContactParameters p = {.k_n = 6e8};
  const PetscReal           r = 5e-3, u = 2e-6, v = 3e-6;
  const Disc                disc  = {.x = 0.3 + r - u, .y = 0.2 + r - v, .r = r, .m = 0.2};
  const PgWall              left  = {.name = "left", .point = {0.3, 7}, .normal = {1, 0}};
  const PgWall              floor = {.name = "floor", .point = {-3, 0.2}, .normal = {0, 1}};
  const PgWall              near  = {.name = "near", .point = {0.3 + 2.1 * r, 0}, .normal = {-1, 0}};
  const PetscReal           arm   = 1 / (PETSC_PI * r);
  PetscReal                 touching, s[4], dt;
  World                     world;

  (void)state;
  WorldCreate(PETSC_COMM_WORLD, &world);
  CHECK(PgDemSetParameters(world.dem, &p));
  AddWall(&world, &near);
  WorldFill(&world, 1, &disc);
  CHECK(PgDemForces(world.dem, 0));
  CHECK(PgDemCriticalTimeStep(world.dem, &dt)); /* nothing touches: what is near counts */
  assert_true(PetscAbsReal(dt * PetscSqrtReal(p.k_n / disc.m) / 2 - 1) < 1e-14); /* rounding */
  AddWall(&world, &left);
  AddWall(&world, &floor);
  CHECK(PgDemForces(world.dem, 0));
  CHECK(PgDemComputeObservables(world.dem));
  WorldGet(&world, "coordination_number", 1, 1, &touching);
  WorldGet(&world, "stress", 4, 1, s);
  assert_true(touching == 2);
  /* overlaps of 2e-6 known to 6e-17 of lengths 0.3 */
  assert_true(PetscAbsReal(s[0] + p.k_n * u * arm) < 1e-9 * p.k_n * u * arm);
  assert_true(PetscAbsReal(s[3] + p.k_n * v * arm) < 1e-9 * p.k_n * v * arm);
  assert_true(s[1] == 0 && s[2] == 0);
  CHECK(PgDemCriticalTimeStep(world.dem, &dt)); /* two springs share the disc, the other side cannot give way */
  assert_true(PetscAbsReal(dt * PetscSqrtReal(2 * p.k_n / disc.m) / 2 - 1) < 1e-14); /* rounding */
  WorldDestroy(&world);
}

/* A disc of a plate that leans against a wall: the wall pushes it sideways and carries part of its load. */
static void PlateAndWall(void **state)
{
  const PgContactParameters p = {.k_n = 6e8, .k_s = 4e8, .mu_s = 0.5};
  const PetscReal           r = 5e-3, u = 2e-6;
  const Disc                disc  = {.x = 0, .y = 0, .vy = -0.1, .r = r, .m = 0.2, .plate = 1};
  const PgPlate             press = {.name = "press", .side = 1, .velocity = -0.1, .friction = 0.25};
  const PgWall slope = {.name = "slope", .point = {0.8 * (u - r), 0.6 * (u - r)}, .normal = {0.8, 0.6}, .friction = 0};
  PetscReal    contact, total, force[2];
  World        world;

  (void)state;
  WorldCreate(PETSC_COMM_WORLD, &world);
  CHECK(PgDemSetParameters(world.dem, &p));
  CHECK(PgDemAddPlate(world.dem, &press, NULL));
  AddWall(&world, &slope);
  WorldFill(&world, 1, &disc);
  CHECK(PgDemForces(world.dem, 0));
  CHECK(PgDemGetLoad(world.dem, 0, &contact, &total));
  WorldGet(&world, "force", 2, 1, force);
  /* 1200 N from an overlap known to 1e-18 of 2e-6 */
  assert_true(PetscAbsReal(contact - 0.6 * p.k_n * u) < 1e-8 && contact == total);
  assert_true(PetscAbsReal(force[0] - 0.8 * p.k_n * u) < 1e-8 && force[1] == 0);
  WorldDestroy(&world);
}

/* A moved wall is where it was put, and what it remembers stays with it. */
static void SetWall(void **state)
{
  const PgContactParameters p     = {.k_n = 6e8, .k_s = 4e8, .mu_s = 0.5};
  const Disc                disc  = {.x = 0.1, .y = 0.004, .vx = 0.2, .r = 4.1e-3, .m = 0.2};
  const PgWall              floor = {.name = "floor", .normal = {0, 1}, .friction = 0.4};
  PgWall                    wall;
  PetscReal                 force[2], slid;
  World                     world;

  (void)state;
  WorldCreate(PETSC_COMM_WORLD, &world);
  CHECK(PgDemSetParameters(world.dem, &p));
  AddWall(&world, &floor);
  WorldFill(&world, 1, &disc);
  for (PetscInt k = 0; k < 50; k++) CHECK(PgDemForces(world.dem, 1e-7));
  slid = 0.2 * 50e-7 * p.k_s;
  CHECK(PgDemGetWallForce(world.dem, 0, force));
  assert_true(PetscAbsReal(force[0] - slid) < 1e-10 && PetscAbsReal(force[1] + p.k_n * 1e-4) < 1e-8);
  CHECK(PgDemGetWall(world.dem, 0, &wall));
  wall.point[1] = 1e-5;
  CHECK(PgDemSetWall(world.dem, 0, &wall));
  CHECK(PgDemForces(world.dem, 0));
  CHECK(PgDemGetWallForce(world.dem, 0, force));
  assert_true(PetscAbsReal(force[0] - slid) < 1e-10 && PetscAbsReal(force[1] + p.k_n * 1.1e-4) < 1e-8);
  wall.point[1] = -0.3;
  CHECK(PgDemSetWall(world.dem, 0, &wall));
  CHECK(PgDemForces(world.dem, 0));
  CHECK(PgDemGetWallForce(world.dem, 0, force));
  assert_true(force[0] == 0 && force[1] == 0);
  WorldDestroy(&world);
}

/* What cannot be a wall. */
static void Refused(void **state)
{
  PgWall wall = {.name = "bad", .normal = {0.7, 0.7}};
  World  world;
  Disc   disc = {.x = 0.1, .y = 0.02, .r = 4e-3, .m = 0.2};

  (void)state;
  WorldCreate(PETSC_COMM_WORLD, &world);
  assert_int_equal(PgDemAddWall(world.dem, &wall, NULL), PETSC_ERR_USER_INPUT);
  wall.normal[0] = 1;
  wall.normal[1] = 0;
  wall.point[0]  = NAN;
  assert_int_equal(PgDemAddWall(world.dem, &wall, NULL), PETSC_ERR_USER_INPUT);
  wall.point[0] = 0;
  wall.kind     = PG_WALL_SERVO;
  assert_int_equal(PgDemAddWall(world.dem, &wall, NULL), PETSC_ERR_USER_INPUT); /* no max_velocity */
  wall.max_velocity = 1;
  CHECK(PgDemAddWall(world.dem, &wall, NULL));
  WorldFill(&world, 1, &disc);
  assert_int_equal(PgDemForces(world.dem, 1e-6), PETSC_ERR_USER_INPUT); /* a length from nowhere */
  WorldDestroy(&world);

  WorldCreate(PETSC_COMM_WORLD, &world);
  CHECK(PgParticlesSetPeriodicX(world.particles, 0, 0.1));
  wall.kind = PG_WALL_FIXED;
  assert_int_equal(PgDemAddWall(world.dem, &wall, NULL), PETSC_ERR_USER_INPUT);
  wall.normal[0] = 0;
  wall.normal[1] = -1;
  CHECK(PgDemAddWall(world.dem, &wall, NULL));
  WorldDestroy(&world);
}

/* A disc pushed through a wall stops the run. */
static void Guard(void **state)
{
  const Disc   disc[2] = {{.x = 0.1, .y = 0.02, .r = 4e-3, .m = 0.2}, {.x = 0.2, .y = 0.02, .r = 4e-3, .m = 0.2}};
  const PgWall wall    = {.name = "shutter", .point = {0, 0.019}, .normal = {0, 1}};
  const PgWall deep    = {.name = "press", .point = {0.201, 0.02}, .normal = {-1, 0}};
  World        world;

  (void)state;
  WorldCreate(PETSC_COMM_WORLD, &world);
  WorldFill(&world, 2, disc);
  AddWall(&world, &deep);
  CHECK(PgDemForces(world.dem, 0));
  assert_int_equal(PgDemGuard(world.dem, 7, 0.1), PETSC_ERR_NOT_CONVERGED);
  WorldDestroy(&world);
  WorldCreate(PETSC_COMM_WORLD, &world);
  WorldFill(&world, 1, disc);
  AddWall(&world, &wall);
  CHECK(PgDemForces(world.dem, 0));
  assert_int_equal(PgDemGuard(world.dem, 7, 0.1), PETSC_ERR_NOT_CONVERGED); /* 3/4 of the radius */
  WorldDestroy(&world);
}

static int Tests(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(LawAtAWall),   cmocka_unit_test(DefaultFriction), cmocka_unit_test(RebuildsAndMigration),
      cmocka_unit_test(WallFromAfar), cmocka_unit_test(Servo),           cmocka_unit_test(Observables),
      cmocka_unit_test(SetWall),      cmocka_unit_test(PlateAndWall),    cmocka_unit_test(Refused),
      cmocka_unit_test(Guard)};

  return cmocka_run_group_tests_name("walls", tests, NULL, NULL);
}

int main(int argc, char *argv[]) { return RunTests(argc, argv, Tests); }
