/* ranks: 1 2 4 */
/* The contact law of one pair against Eqs. 3-17, and the loop over all pairs against a plain O(N^2) loop
   over that law, bit by bit. */
#include "dem_setup.h"

static const PgContactParameters parameters = {.k_n        = 6.3e8,
                                               .k_s        = 4.1e8,
                                               .k_r        = 2.3e6,
                                               .k_theta    = 710,
                                               .c_n        = 310,
                                               .c_s        = 170,
                                               .c_r        = 30,
                                               .c_theta    = 3e-4,
                                               .mu_s       = 0.45,
                                               .mu_r       = 0.31,
                                               .mu_theta_r = 1.3e-4};

/* One rounding of the arithmetic; results pass through fewer than 20. */
#define EPS (20 * PETSC_MACHINE_EPSILON)

static void NormalForce(void **state)
{
  PgContactMotion  m = {.overlap = 2.5e-6, .overlap_rate = 0.3};
  PgContactHistory h = {0, 0, 0};
  PgContactForce   f;

  (void)state;
  f = PgContactLawLi2007(&parameters, &m, 1e-6, &h); /* Eq. 8 */
  assert_true(PetscAbsReal(f.F_N + (6.3e8 * 2.5e-6 + 310 * 0.3)) < EPS * 1700);
  m.overlap_rate = -40; /* dashpot stronger than the spring: would pull */
  f              = PgContactLawLi2007(&parameters, &m, 1e-6, &h);
  assert_true(f.F_N == 0 && f.F_T == 0 && f.M_r == 0);
  m.overlap      = 0; /* Eq. 9: no contact, even when approaching; nothing is remembered */
  m.overlap_rate = 12;
  m.sliding_rate = m.rolling_rate = m.spin_rate = 3;
  h                                             = (PgContactHistory){7, 8, 9};
  f                                             = PgContactLawLi2007(&parameters, &m, 1e-6, &h);
  assert_true(f.F_N == 0 && f.F_T == 0 && f.M_r == 0);
  assert_true(h.f_s == 0 && h.f_r == 0 && h.m_r == 0);
}

/* Each spring: slope before the cap (Eqs. 4, 13), viscous part in the force but not in the memory, cap on
   the sum (Eqs. 5, 6, 14, 15), and a memory that stands with the viscous part at the cap. */
static void Springs(void **state)
{
  const PetscReal  u = 2.5e-6, N = 6.3e8 * u, dt = 1e-7;
  PgContactMotion  m = {.overlap = u, .sliding_rate = 0.02, .rolling_rate = -0.9, .spin_rate = 5};
  PgContactHistory h = {0, 0, 0};
  PgContactForce   f;

  (void)state;
  for (PetscInt k = 1; k <= 10; k++) {
    f = PgContactLawLi2007(&parameters, &m, dt, &h);
    /* the terms are below 3.5 in size, added up in 10 steps */
    assert_true(PetscAbsReal(h.f_s + 4.1e8 * 0.02 * dt * (PetscReal)k) < 10 * EPS * 10);
    assert_true(PetscAbsReal(h.f_r - 2.3e6 * 0.9 * dt * (PetscReal)k) < 10 * EPS * 10);
    assert_true(PetscAbsReal(h.m_r + 710 * 5 * dt * (PetscReal)k) < 10 * EPS);
    assert_true(PetscAbsReal(f.F_T - (h.f_s - 170 * 0.02 + h.f_r + 30 * 0.9)) < EPS * 30);
    assert_true(PetscAbsReal(f.M_r - (h.m_r - 3e-4 * 5)) < EPS);
  }
  m.sliding_rate = 1.1; /* viscous part 187 N, cap 709 N */
  m.spin_rate    = 800; /* viscous part 0.24 N m, cap 0.205 N m: the dashpot alone is beyond the cap */
  for (PetscInt k = 0; k < 30; k++) f = PgContactLawLi2007(&parameters, &m, dt * 10, &h);
  assert_true(PetscAbsReal(h.f_s - 170 * 1.1 + 0.45 * N) < EPS * N);
  assert_true(PetscAbsReal(f.M_r + 1.3e-4 * N) < EPS * N);
  assert_true(PetscAbsReal(h.m_r - 3e-4 * 800 + 1.3e-4 * N) < EPS * N);
}

/* The rolling force has its own cap; the sum is capped again by mu_s (Eqs. 16, 17), which leaves the
   memories of both as they are. */
static void CapOfTheSum(void **state)
{
  const PetscReal     u = 2.5e-6, N = 6.3e8 * u;
  PgContactParameters p = parameters;
  PgContactMotion     m = {.overlap = u, .sliding_rate = -2, .rolling_rate = -3};
  PgContactHistory    h = {0, 0, 0};
  PgContactForce      f;

  (void)state;
  p.c_s = p.c_r = 0;
  for (PetscInt k = 0; k < 400; k++) f = PgContactLawLi2007(&p, &m, 1e-6, &h);
  assert_true(PetscAbsReal(h.f_s - 0.45 * N) < EPS * N);
  assert_true(PetscAbsReal(h.f_r - 0.31 * N) < EPS * N);
  assert_true(PetscAbsReal(f.F_T - 0.45 * N) < EPS * N);
  m.sliding_rate = m.rolling_rate = 0; /* unloading by half takes the caps along */
  m.overlap                       = 0.5 * u;
  f                               = PgContactLawLi2007(&p, &m, 1e-6, &h);
  assert_true(PetscAbsReal(h.f_s - 0.225 * N) < EPS * N);
  assert_true(PetscAbsReal(h.f_r - 0.155 * N) < EPS * N);
  assert_true(PetscAbsReal(f.F_T - 0.225 * N) < EPS * N);
}

/* dt = 0 evaluates without advancing. */
static void NoTime(void **state)
{
  PgContactMotion  m = {.overlap = 2.5e-6, .sliding_rate = 0.02, .rolling_rate = -0.9, .spin_rate = 5};
  PgContactHistory h = {11, -12, 0.013}, before = h;
  PgContactForce   f = PgContactLawLi2007(&parameters, &m, 0, &h);

  (void)state;
  assert_memory_equal(&h, &before, sizeof(h));
  assert_true(PetscAbsReal(f.F_T - (11 - 170 * 0.02 - 12 + 30 * 0.9)) < EPS * 40);
}

enum { COLUMNS = 9, ROWS = 8, N = COLUMNS * ROWS, STEPS = 40 };

/* Forces on all discs by a plain loop over all pairs, with a memory for every pair; discs by id. */
static void Oracle(const PetscReal r[], const PetscReal x[], const PetscReal v[], const PetscReal w[], PetscReal dt,
                   PgContactHistory memory[], PetscReal force[], PetscReal torque[])
{
  for (PetscInt a = 0; a < N; a++) {
    force[2 * a] = force[2 * a + 1] = torque[a] = 0;
    for (PetscInt b = 0; b < N; b++) {
      const PetscInt   low = PetscMin(a, b), high = PetscMax(a, b);
      const PetscReal  sign = a == low ? 1 : -1;
      PgContactHistory h;
      PgContactMotion  m;
      PgContactForce   f;
      PetscReal        dx, dy, d, nx, ny, ux, uy;

      if (a == b) continue;
      h         = memory[low * N + high];
      dx        = x[2 * high] - x[2 * low];
      dy        = x[2 * high + 1] - x[2 * low + 1];
      d         = sqrt(dx * dx + dy * dy);
      m.overlap = (r[low] + r[high]) - d;
      if (m.overlap <= 0) {
        if (a == low) memory[low * N + high] = (PgContactHistory){0, 0, 0};
        continue;
      }
      nx             = dx * (1 / d);
      ny             = dy * (1 / d);
      ux             = v[2 * low] - v[2 * high];
      uy             = v[2 * low + 1] - v[2 * high + 1];
      m.overlap_rate = ux * nx + uy * ny;
      m.rolling_rate = -(r[low] * w[low] + r[high] * w[high]);
      m.sliding_rate = (uy * nx - ux * ny) - m.rolling_rate;
      m.spin_rate    = w[low] - w[high];
      f              = PgContactLawLi2007(&parameters, &m, dt, &h);
      if (a == high) memory[low * N + high] = h; /* row a == low has been summed with the old memory */
      force[2 * a] += sign * (f.F_N * nx - f.F_T * ny);
      force[2 * a + 1] += sign * (f.F_N * ny + f.F_T * nx);
      torque[a] += r[a] * f.F_T + sign * f.M_r;
    }
  }
}

static void LoopAgainstOracle(void **state)
{
  static PgContactHistory memory[N * N];
  static Disc             disc[N];
  PetscReal               x[2 * N], v[2 * N], w[N], r[N], force[2 * N], torque[N], got[2 * N], got_torque[N];
  World                   world;
  PetscInt                loaded = 0;

  (void)state;
  memset(memory, 0, sizeof(memory));
  FillHeap(COLUMNS, ROWS, 0.06, disc);
  for (PetscInt k = 0; k < N; k++) r[k] = disc[k].r;
  WorldCreate(PETSC_COMM_WORLD, &world);
  CHECK(PgDemSetParameters(world.dem, &parameters));
  WorldFill(&world, N, disc);
  for (PetscInt step = 0; step < STEPS; step++) {
    const PetscReal dt = step ? 1.1e-6 : 0;

    if (step) {
      PetscBool need;

      CHECK(PgDemKickDrift(world.dem, dt));
      CHECK(PgNeighborsNeedBuild(world.neighbors, &need));
      if (need || step == STEPS / 2)
        WorldBuild(&world);
      else
        WorldHalo(&world);
    }
    CHECK(PgDemForces(world.dem, dt));
    WorldGet(&world, "position", 2, N, x);
    WorldGet(&world, "velocity", 2, N, v);
    WorldGet(&world, "angular_velocity", 1, N, w);
    WorldGet(&world, "force", 2, N, got);
    WorldGet(&world, "torque", 1, N, got_torque);
    Oracle(r, x, v, w, dt, memory, force, torque);
    for (PetscInt k = 0; k < N; k++) {
      assert_true(got[2 * k] == force[2 * k] && got[2 * k + 1] == force[2 * k + 1] && got_torque[k] == torque[k]);
      loaded += torque[k] != 0;
    }
    if (step) CHECK(PgDemKick(world.dem, dt));
  }
  assert_true(loaded > STEPS * N / 2); /* most discs have been in frictional contact */
  WorldDestroy(&world);
}

/* Coincident centres, discs without contact and discs alone: no force, no trap. */
static void DegeneratePairs(void **state)
{
  const Disc disc[] = {{.x = 0.1, .y = 0.2, .r = 4e-3, .m = 0.11, .w = 2},
                       {.x = 0.1, .y = 0.2, .r = 5e-3, .m = 0.15, .vx = 3},
                       {.x = 0.1105, .y = 0.2, .r = 5e-3, .m = 0.16},
                       {.x = 0.7, .y = 0.9, .r = 3e-3, .m = 0.07}};
  PetscReal  force[8];
  World      world;

  (void)state;
  WorldCreate(PETSC_COMM_WORLD, &world);
  CHECK(PgDemSetParameters(world.dem, &parameters));
  WorldFill(&world, 4, disc);
  CHECK(PgDemForces(world.dem, 1e-6));
  WorldGet(&world, "force", 2, 4, force);
  for (PetscInt k = 0; k < 8; k++) assert_true(force[k] == 0);
  WorldDestroy(&world);
}

static int Tests(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(NormalForce),       cmocka_unit_test(Springs),
                                     cmocka_unit_test(CapOfTheSum),       cmocka_unit_test(NoTime),
                                     cmocka_unit_test(LoopAgainstOracle), cmocka_unit_test(DegeneratePairs)};

  return cmocka_run_group_tests_name("contact law", tests, NULL, NULL);
}

int main(int argc, char *argv[]) { return RunTests(argc, argv, Tests); }
