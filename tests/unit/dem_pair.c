/* ranks: 1 2 */
/* Collisions of discs with known answers, symmetry of a pair, momentum. */
#include "dem_setup.h"

static const PetscReal r_a = 4e-3, r_j = 6.5e-3, m_a = 0.13, m_j = 0.29, k_n = 6e8;

static PgContactParameters Parameters(PetscReal k_s, PetscReal mu, PetscReal c_n)
{
  PgContactParameters p = {.k_n = k_n, .k_s = k_s, .k_theta = 700, .c_n = c_n, .mu_s = mu, .mu_theta_r = mu * 2e-4};
  return p;
}

/* Disc 0 at the origin of a direction that is not an axis, disc 1 just touching it. */
static void Approach(PetscReal speed, Disc disc[2])
{
  const PetscReal nx = 0.8, ny = 0.6, x0 = 0.03, y0 = 0.02;

  memset(disc, 0, 2 * sizeof(*disc));
  disc[0] = (Disc){.x = x0, .y = y0, .r = r_a, .m = m_a, .vx = 0.7 * speed * nx, .vy = 0.7 * speed * ny};
  disc[1] = (Disc){.x  = x0 + (r_a + r_j) * nx,
                   .y  = y0 + (r_a + r_j) * ny,
                   .r  = r_j,
                   .m  = m_j,
                   .vx = -0.3 * speed * nx,
                   .vy = -0.3 * speed * ny};
}

static PetscReal Overlap(World *world)
{
  PetscReal x[4];

  WorldGet(world, "position", 2, 2, x);
  return r_a + r_j - hypot(x[2] - x[0], x[3] - x[1]);
}

/* Rate at which the centres part. */
static PetscReal Separation(World *world)
{
  PetscReal v[4];

  WorldGet(world, "velocity", 2, 2, v);
  return (v[2] - v[0]) * 0.8 + (v[3] - v[1]) * 0.6;
}

static void Start(World *world, const PgContactParameters *p, PetscInt count, const Disc disc[])
{
  WorldCreate(PETSC_COMM_WORLD, world);
  CHECK(PgDemSetParameters(world->dem, p));
  WorldFill(world, count, disc);
  CHECK(PgDemForces(world->dem, 0));
}

/* Elastic collision: duration pi sqrt(m/k) with the reduced mass, no loss of energy. */
static void ElasticCollision(void **state)
{
  const PetscReal           m = m_a * m_j / (m_a + m_j), omega = PetscSqrtReal(k_n / m), T = PETSC_PI / omega;
  const PetscReal           dt = T / 400;
  const PgContactParameters p  = Parameters(4e8, 0.5, 0);
  PetscReal                 before, after, u = 0, last = 0, t = 0;
  Disc                      disc[2];
  World                     world;

  (void)state;
  Approach(1.3, disc);
  Start(&world, &p, 2, disc);
  CHECK(PgDemKineticEnergy(world.dem, &before));
  for (PetscInt k = 0; k == 0 || u > 0; k++) {
    last = u;
    WorldStep(&world, dt);
    t += dt;
    u = Overlap(&world);
    assert_true(k < 500);
  }
  t -= dt * u / (u - last); /* where the overlap was 0 */
  /* leapfrog lengthens a half period by the factor 1 - (omega dt)^2/24 = 1 - 2.6e-6; the straight line in the
     last step and rounding of the overlap (1e-18 of 1e-7 per step) are smaller */
  assert_true(PetscAbsReal(t / T - 1) < 1e-5);
  WorldStep(&world, dt);
  CHECK(PgDemKineticEnergy(world.dem, &after));
  /* the step in which the contact opens is cut: at most (omega dt)^2/2 = 3e-5 of the energy */
  assert_true(PetscAbsReal(after / before - 1) < 1e-4);
  WorldDestroy(&world);
}

/* With a dashpot and without tension, contact ends when k u + c du/dt = 0, at tan(omega t) =
   -2 beta omega/(omega^2 - beta^2): the restitution is -du/dt then. (Without the clip it would be
   exp(-pi beta/omega), a smaller number.) */
static void Restitution(void **state)
{
  const PetscReal m = m_a * m_j / (m_a + m_j), c_n = 3500, beta = c_n / (2 * m);
  const PetscReal omega = PetscSqrtReal(k_n / m - beta * beta), speed = 0.9;
  const PetscReal end = (PETSC_PI - atan2(2 * beta * omega, omega * omega - beta * beta)) / omega;
  const PetscReal e   = -PetscExpReal(-beta * end) *
                      (PetscCosReal(omega * end) - beta / omega * PetscSinReal(omega * end));
  const PgContactParameters p = Parameters(4e8, 0.5, c_n);
  PetscReal                 got[2], error[2];

  (void)state;
  /* the case tells the two answers apart */
  assert_true(e - PetscExpReal(-PETSC_PI * beta / omega) > 0.02);
  for (PetscInt fine = 0; fine < 2; fine++) {
    const PetscInt  steps = fine ? 4000 : 2000;
    const PetscReal dt    = PETSC_PI / omega / (PetscReal)steps;
    Disc            disc[2];
    World           world;

    Approach(speed, disc);
    Start(&world, &p, 2, disc);
    for (PetscInt k = 0; k < steps + 10; k++) WorldStep(&world, dt);
    assert_true(Overlap(&world) < 0);
    got[fine]   = Separation(&world) / speed;
    error[fine] = got[fine] - e;
    WorldDestroy(&world);
  }
  /* the dashpot works with the velocity half a step earlier: first order, omega dt/2 = 4e-4 times beta/omega */
  assert_true(PetscAbsReal(error[1]) < 4e-4);
  assert_true(error[0] / error[1] > 1.6 && error[0] / error[1] < 2.5);
}

/* Second order in the time step while contact lasts: overlap of a head-on collision against the sine. */
static void NormalOrder(void **state)
{
  const PetscReal           m = m_a * m_j / (m_a + m_j), omega = PetscSqrtReal(k_n / m), t = 2.3 / omega;
  const PgContactParameters p = Parameters(4e8, 0.5, 0);
  PetscReal                 error[3];

  (void)state;
  for (PetscInt level = 0; level < 3; level++) {
    const PetscInt steps = 20 << level;
    Disc           disc[2];
    World          world;

    Approach(1.3, disc);
    Start(&world, &p, 2, disc);
    for (PetscInt k = 0; k < steps; k++) WorldStep(&world, t / (PetscReal)steps);
    error[level] = PetscAbsReal(Overlap(&world) - 1.3 / omega * PetscSinReal(2.3));
    WorldDestroy(&world);
  }
  /* factor 4, up to terms of fourth order, (omega dt)^2 = 1 % of it at the coarsest step */
  for (PetscInt level = 0; level < 2; level++)
    assert_true(error[level] / error[level + 1] > 3.9 && error[level] / error[level + 1] < 4.1);
}

/* An oblique collision with spin, below all caps: the solution settles at second order too. */
static void ObliqueOrder(void **state)
{
  const PgContactParameters p = Parameters(4e8, 40, 0);
  const PetscReal           t = 2.1e-5;
  PetscReal                 v[4][6], ratio;

  (void)state;
  for (PetscInt level = 0; level < 4; level++) {
    const PetscInt steps = 32 << level;
    Disc           disc[2];
    World          world;

    Approach(1.3, disc);
    disc[0].vx += 0.5;
    disc[1].vy -= 0.2;
    disc[0].w = 35;
    disc[1].w = -110;
    Start(&world, &p, 2, disc);
    for (PetscInt k = 0; k < steps; k++) WorldStep(&world, t / (PetscReal)steps);
    assert_true(Overlap(&world) > 0);
    WorldGet(&world, "velocity", 2, 2, v[level]);
    WorldGet(&world, "angular_velocity", 1, 2, v[level] + 4);
    WorldDestroy(&world);
  }
  /* terms of the next order are (omega dt)^2 = 1 % or less; the cap releases only in the first step, where the
     overlap starts from 0 (third order in dt) */
  for (PetscInt c = 0; c < 6; c++) {
    ratio = (v[1][c] - v[2][c]) / (v[2][c] - v[3][c]);
    assert_true(ratio > 3.6 && ratio < 4.4);
  }
}

/* Torques r_a F_T + M_r and r_j F_T - M_r, slopes of the sliding and rolling springs, in the frame n, t; the
   discs do not move. */
static void Torques(void **state)
{
  const PgContactParameters p = {
      .k_n = k_n, .k_s = 4e8, .k_r = 3e7, .k_theta = 700, .mu_s = 0.5, .mu_r = 0.4, .mu_theta_r = 1e-4};
  const PetscReal u = 3e-6, dt = 1e-9, N = k_n * u;
  PetscReal       force[4], torque[2], slip, roll, turn;
  Disc            disc[2];
  World           world;

  (void)state;
  Approach(0, disc);
  disc[0].x += 0.8 * u;
  disc[0].y += 0.6 * u;
  disc[0].vx = -0.6 * 0.4; /* 0.4 m/s along t = (-0.6, 0.8) */
  disc[0].vy = 0.8 * 0.4;
  disc[0].w  = 21;
  disc[1].w  = 340;
  Start(&world, &p, 2, disc);
  for (PetscInt k = 0; k < 50; k++) CHECK(PgDemForces(world.dem, dt));
  WorldGet(&world, "force", 2, 2, force);
  WorldGet(&world, "torque", 1, 2, torque);
  roll = -(r_a * 21 + r_j * 340) * 50 * dt;
  slip = 0.4 * 50 * dt - roll;
  turn = (21 - 340) * 50 * dt;
  /* the overlap is a difference of lengths 1e-2 m: relative error 1e-18/3e-6, forces 1800 N; below 1e-8 N */
  assert_true(PetscAbsReal(force[0] * 0.8 + force[1] * 0.6 + N) < 1e-8);
  assert_true(PetscAbsReal(force[1] * 0.8 - force[0] * 0.6 + p.k_s * slip + p.k_r * roll) < 1e-8);
  assert_true(force[2] == -force[0] && force[3] == -force[1]);
  assert_true(PetscAbsReal(torque[0] - (r_a * -(p.k_s * slip + p.k_r * roll) - p.k_theta * turn)) < 1e-10);
  assert_true(PetscAbsReal(torque[1] - (r_j * -(p.k_s * slip + p.k_r * roll) + p.k_theta * turn)) < 1e-10);
  /* far beyond all caps */
  for (PetscInt k = 0; k < 1000; k++) CHECK(PgDemForces(world.dem, 1e-6));
  WorldGet(&world, "force", 2, 2, force);
  WorldGet(&world, "torque", 1, 2, torque);
  assert_true(PetscAbsReal(force[1] * 0.8 - force[0] * 0.6 - (-0.5 + 0.4) * N) < 1e-8);
  assert_true(PetscAbsReal(torque[0] - (r_a * -0.1 * N + 1e-4 * N)) < 1e-10);
  assert_true(PetscAbsReal(torque[1] - (r_j * -0.1 * N - 1e-4 * N)) < 1e-10);
  WorldDestroy(&world);
}

/* The same two discs under exchanged ids move the same way, bit by bit. */
static void Exchange(void **state)
{
  const PgContactParameters p = {.k_n        = k_n,
                                 .k_s        = 4e8,
                                 .k_r        = 3e6,
                                 .k_theta    = 700,
                                 .c_n        = 90,
                                 .c_s        = 40,
                                 .c_r        = 3,
                                 .c_theta    = 1e-3,
                                 .mu_s       = 0.5,
                                 .mu_r       = 0.4,
                                 .mu_theta_r = 1e-4};
  PetscReal                 x[2][4], v[2][4], w[2][2];

  (void)state;
  for (PetscInt swapped = 0; swapped < 2; swapped++) {
    Disc  disc[2], swap;
    World world;

    Approach(1.3, disc);
    disc[0].vx += 0.5;
    disc[0].w = 35;
    disc[1].w = -110;
    if (swapped) {
      swap    = disc[0];
      disc[0] = disc[1];
      disc[1] = swap;
    }
    Start(&world, &p, 2, disc);
    for (PetscInt k = 0; k < 60; k++) WorldStep(&world, 1e-6);
    WorldGet(&world, "position", 2, 2, x[swapped]);
    WorldGet(&world, "velocity", 2, 2, v[swapped]);
    WorldGet(&world, "angular_velocity", 1, 2, w[swapped]);
    WorldDestroy(&world);
  }
  assert_true(PetscAbsReal(w[0][0] - 35) > 1 && PetscAbsReal(w[0][1] + 110) > 1);
  for (PetscInt c = 0; c < 4; c++) assert_true(x[0][c] == x[1][(c + 2) % 4] && v[0][c] == v[1][(c + 2) % 4]);
  for (PetscInt c = 0; c < 2; c++) assert_true(w[0][c] == w[1][1 - c]);
}

enum { N = 42 };

/* Momentum of a heap without outer forces: what one disc gets, its partner loses, exactly; only the kicks
   round. */
static void Momentum(void **state)
{
  PgContactParameters p = {.k_n        = k_n,
                           .k_s        = 4e8,
                           .k_r        = 3e6,
                           .k_theta    = 700,
                           .c_n        = 90,
                           .c_s        = 40,
                           .c_r        = 3,
                           .c_theta    = 1e-3,
                           .mu_s       = 0.5,
                           .mu_r       = 0.4,
                           .mu_theta_r = 1e-4};
  static Disc         disc[N];
  PetscReal           v[2 * N], force[2 * N], sum[2] = {0, 0}, scale = 0;
  World               world;

  (void)state;
  FillHeap(7, 6, 0.02, disc);
  for (PetscInt k = 0; k < N; k++) {
    sum[0] -= disc[k].m * disc[k].vx;
    sum[1] -= disc[k].m * disc[k].vy;
    scale += disc[k].m;
  }
  Start(&world, &p, N, disc);
  for (PetscInt k = 0; k < 25; k++) WorldStep(&world, 1e-6);
  WorldGet(&world, "velocity", 2, N, v);
  for (PetscInt k = 0; k < N; k++) {
    sum[0] += disc[k].m * v[2 * k];
    sum[1] += disc[k].m * v[2 * k + 1];
  }
  /* 50 half kicks, each rounds velocities of up to 40 m/s by half an epsilon of them */
  assert_true(PetscAbsReal(sum[0]) < 50 * 40 * 0.5 * PETSC_MACHINE_EPSILON * scale);
  assert_true(PetscAbsReal(sum[1]) < 50 * 40 * 0.5 * PETSC_MACHINE_EPSILON * scale);

  WorldGet(&world, "force", 2, N, force);
  sum[0] = sum[1] = scale = 0;
  for (PetscInt k = 0; k < N; k++) {
    sum[0] += force[2 * k];
    sum[1] += force[2 * k + 1];
    scale += PetscAbsReal(force[2 * k]) + PetscAbsReal(force[2 * k + 1]);
  }
  assert_true(scale > 1e4);
  /* 6 terms in the force of a disc, N in the sum */
  assert_true(PetscAbsReal(sum[0]) < (N + 6) * PETSC_MACHINE_EPSILON * scale);
  assert_true(PetscAbsReal(sum[1]) < (N + 6) * PETSC_MACHINE_EPSILON * scale);
  WorldDestroy(&world);
}

/* The friction force acts at r_a from the centre of a and r_j from that of j, points that lie u_N apart, so a
   pair changes the angular momentum, spin included, at the rate u_N F_T, and nothing else does. */
static void AngularMomentum(void **state)
{
  const PgContactParameters p = {.k_n = k_n, .k_s = 4e8, .k_theta = 700, .mu_s = 0.5, .mu_theta_r = 1e-4};
  const PetscReal           u = 3e-5;
  PetscReal                 x[4], force[4], torque[2], F_T, moment;
  Disc                      disc[2];
  World                     world;

  (void)state;
  Approach(0, disc);
  disc[0].x += 0.8 * u;
  disc[0].y += 0.6 * u;
  disc[0].w = 21;
  disc[1].w = 340;
  Start(&world, &p, 2, disc);
  for (PetscInt k = 0; k < 1000; k++) CHECK(PgDemForces(world.dem, 1e-6));
  WorldGet(&world, "position", 2, 2, x);
  WorldGet(&world, "force", 2, 2, force);
  WorldGet(&world, "torque", 1, 2, torque);
  F_T    = force[1] * 0.8 - force[0] * 0.6;
  moment = x[0] * force[1] - x[1] * force[0] + x[2] * force[3] - x[3] * force[2] + torque[0] + torque[1];
  assert_true(PetscAbsReal(F_T + 0.5 * k_n * u) < 1e-7); /* at its cap of 9000 N, rounding 1e-11 of it */
  /* terms up to 20000 N * 0.04 m = 800 N m with 1e-16 each, 10 of them */
  assert_true(PetscAbsReal(moment - u * F_T) < 1e-12);
  WorldDestroy(&world);
}

static int Tests(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(ElasticCollision), cmocka_unit_test(Restitution),
                                     cmocka_unit_test(NormalOrder),      cmocka_unit_test(ObliqueOrder),
                                     cmocka_unit_test(Torques),          cmocka_unit_test(Exchange),
                                     cmocka_unit_test(Momentum),         cmocka_unit_test(AngularMomentum)};

  return cmocka_run_group_tests_name("pairs", tests, NULL, NULL);
}

int main(int argc, char *argv[]) { return RunTests(argc, argv, Tests); }
