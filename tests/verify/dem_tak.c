/* ranks: 1 2 */
/* Contact laws of Tak, Park & Park (2013), Eqs. 15-18, in runs of the case disc_collision: Hertz' impact, and bonds that
   hold, swing and break. */
#include "dem_run.h"

static const PetscReal r[2] = {4e-3, 6.5e-3}, rho = 2000, k_n = 6e8, k_s = 4e8, angle = 30;

static PetscReal ReducedMass(void)
{
  const PetscReal a = PETSC_PI * r[0] * r[0] * rho, b = PETSC_PI * r[1] * r[1] * rho;
  return a * b / (a + b);
}

static PetscReal Overlap(Run *run)
{
  PetscReal x[4];

  RunGet(run, "position", 2, 2, x);
  return r[0] + r[1] - hypot(x[2] - x[0], x[3] - x[1]);
}

/* Speed at which the discs part, and the sliding rate of their contact. */
static void Rates(Run *run, PetscReal *parting, PetscReal *sliding)
{
  PetscReal x[4], v[4], w[2], d;

  RunGet(run, "position", 2, 2, x);
  RunGet(run, "velocity", 2, 2, v);
  RunGet(run, "angular_velocity", 1, 2, w);
  d        = hypot(x[2] - x[0], x[3] - x[1]);
  *parting = ((v[2] - v[0]) * (x[2] - x[0]) + (v[3] - v[1]) * (x[3] - x[1])) / d;
  *sliding = (-(v[0] - v[2]) * (x[3] - x[1]) + (v[1] - v[3]) * (x[2] - x[0])) / d + r[0] * w[0] + r[1] * w[1];
}

enum { LEVELS = 3 };

static void HertzImpact(void **state)
{
  const PetscReal E = 5e9, nu = 0.3, speed = 1.3, modulus = E / (2 * (1 - nu * nu)), R = r[0] * r[1] / (r[0] + r[1]);
  const PetscReal top = PetscPowReal(15 * ReducedMass() * speed * speed / (16 * modulus * PetscSqrtReal(R)), 0.4);
  /* (4/5) sqrt(pi) Gamma(2/5)/Gamma(9/10) */
  const PetscReal T = 2.9432750568 * top / speed;
  PetscReal       h[LEVELS], duration[LEVELS], overlap[LEVELS], rebound = 0, sliding, last[2] = {0, 0};

  (void)state;
  for (PetscInt level = 0; level < LEVELS; level++) {
    const PetscInt  steps = 50 << level;
    const PetscReal dt    = T / (PetscReal)steps;
    PetscReal       u[3] = {0, 0, 0}, most = 0, end;
    Run             run;

    RunStart(&run,
             "-case disc_collision -fluid none -collision_speed %.17g -collision_angle %.17g -dt %.17g "
             "-dem_contact_law hertz -dem_hertz_young %g -dem_hertz_poisson %g",
             (double)speed, (double)angle, (double)dt, (double)E, (double)nu);
    for (PetscInt k = 0; k == 0 || u[2] > 0; k++) {
      assert_true(k < 2 * steps);
      RunSteps(&run, 1);
      u[0] = u[1];
      u[1] = u[2];
      u[2] = Overlap(&run);
      if (u[1] > u[0] && u[1] >= u[2]) most = u[1] + 0.125 * PetscSqr(u[2] - u[0]) / (2 * u[1] - u[0] - u[2]);
    }
    end = RunTime(&run) - dt * u[2] / (u[2] - u[1]);
    RunSteps(&run, 2);
    Rates(&run, &rebound, &sliding);
    RunEnd(&run);
    h[level]        = 1 / (PetscReal)steps;
    last[0]         = end;
    last[1]         = most;
    duration[level] = PetscAbsReal(end / T - 1);
    overlap[level]  = PetscAbsReal(most / top - 1);
  }
  /* (omega dt)^2/8 of leapfrog at the largest overlap, where omega = 1.37 v/u: 5.1e-5 */
  VerifyValue("hertz", "duration 2.9433 u/v [s], 200 steps", T, last[0], 0, 5.1e-5, "leapfrog, (omega dt)^2/8");
  VerifyValue("hertz", "largest overlap [m], 200 steps", top, last[1], 0, 5.1e-5, "leapfrog, (omega dt)^2/8");
  /* the force grows like u^1.5, whose second derivative is not bounded at first touch: orders wander a little */
  VerifyOrder("hertz", "duration", LEVELS, h, duration, 2, 0.3, "leapfrog");
  VerifyOrder("hertz", "largest overlap", LEVELS, h, overlap, 2, 0.3, "leapfrog");
  VerifyValue("hertz", "rebound over speed, 200 steps", 1, rebound / speed, 0, 1e-5,
              "contact ends inside a step, in which the force is below (2/200)^1.5 of its top");
}

/* A bonded pair that approaches with v passes through zero overlap with v again and is drawn out; it breaks when
   k_n s = R_n, and what is left is m' w^2 = m' v^2 - R_n^2/k_n. */
static void BondInTension(void **state)
{
  const PetscReal m = ReducedMass(), speed = 0.7, most = speed * PetscSqrtReal(m * k_n),
                  dt      = 2e-3 * PetscSqrtReal(m / k_n);
  const PetscReal part[3] = {0.5, 0.9, 1.01};

  (void)state;
  for (PetscInt k = 0; k < 3; k++) {
    const PetscReal R_n = part[k] * most, left = speed * PetscSqrtReal(PetscMax(0, 1 - part[k] * part[k]));
    PetscReal       parting, sliding, least = 0;
    Run             run;

    RunStart(&run,
             "-case disc_collision -fluid none -collision_speed %.17g -collision_angle %.17g -dt %.17g "
             "-dem_contact_law tak2013 -dem_bond_normal %.17g -dem_bond_tangential 1e9",
             (double)speed, (double)angle, (double)dt, (double)R_n);
    for (PetscInt step = 0; step < 4200; step++) { /* 1.3 periods */
      RunSteps(&run, 1);
      least = PetscMin(least, Overlap(&run));
    }
    Rates(&run, &parting, &sliding);
    RunEnd(&run);
    if (part[k] < 1) {
      /* in which step of omega dt = 2e-3 it breaks: 2e-3 p/sqrt(1 - p^2) of what is left, p = R_n over the top */
      VerifyValue("tak2013", "speed after a bond broke in tension [m/s]", left, parting, 0,
                  2e-3 * part[k] / PetscSqrtReal(1 - part[k] * part[k]), "breaks within one step of R_n");
    } else {
      /* never reached: it swings for ever. (omega dt)^2/8 = 5e-7 and 1000 steps between extremes of the sampling */
      VerifyValue("tak2013", "extent of a bond that holds [m]", -speed * PetscSqrtReal(m / k_n), least, 0, 1e-5,
                  "sampled within half a step of the extreme");
    }
  }
}

/* Spins that shear the bond: the contact point swings with sqrt(3 k_s/m'), the force with s sqrt(k_s m'/3). */
static void BondInShear(void **state)
{
  const PetscReal m = ReducedMass(), spin = 200, s = r[0] * spin + r[1] * spin, most = s * PetscSqrtReal(k_s * m / 3);
  const PetscReal dt = 2e-3 * PetscSqrtReal(m / (3 * k_s)), part = 0.8;
  PetscReal       parting, sliding;
  Run             run;

  (void)state;
  RunStart(&run,
           "-case disc_collision -fluid none -collision_speed 1e-9 -collision_spin %g,%g -collision_angle %.17g "
           "-dt %.17g -dem_contact_law tak2013 -dem_bond_normal 1e4 -dem_bond_tangential %.17g -dem_mu_s 0",
           (double)spin, (double)spin, (double)angle, (double)dt, (double)(part * most));
  RunSteps(&run, 800);
  Rates(&run, &parting, &sliding);
  RunEnd(&run);
  /* what the spring holds when it breaks is lost: s^2 (1 - 0.8^2); which step it is is worth 2e-3 * 0.8/0.6 of the rate */
  VerifyValue("tak2013", "sliding rate after a bond broke in shear [m/s]", s * PetscSqrtReal(1 - part * part), sliding,
              0, 2.7e-3, "breaks within one step of R_t");
}

/* A bond with dashpot that does not break: each half period takes exp(-pi zeta/sqrt(1 - zeta^2)), tension allowed. */
static void BondWithDashpot(void **state)
{
  const PetscReal m = ReducedMass(), speed = 0.7, w = PetscSqrtReal(k_n / m), dt = PETSC_PI / w / 2000;
  const PetscReal zeta[2] = {0.1, 0.3};

  (void)state;
  for (PetscInt k = 0; k < 2; k++) {
    const PetscReal root = PetscSqrtReal(1 - zeta[k] * zeta[k]), e = PetscExpReal(-PETSC_PI * zeta[k] / root);
    const PetscInt  half = (PetscInt)(2000 / root + 0.5);
    PetscReal       parting, sliding;
    Run             run;

    RunStart(&run,
             "-case disc_collision -fluid none -collision_speed %.17g -collision_angle %.17g -dt %.17g -dem_c_n %.17g "
             "-dem_contact_law tak2013 -dem_bond_normal 1e5 -dem_bond_tangential 1e5",
             (double)speed, (double)angle, (double)dt, (double)(2 * zeta[k] * PetscSqrtReal(m * k_n)));
    RunSteps(&run, half);
    Rates(&run, &parting, &sliding);
    RunEnd(&run);
    /* the dashpot acts half a step late, omega dt/2 = 8e-4 of 2 zeta; and the end within half a step of zero */
    VerifyValue("tak2013", k ? "restitution of a bond, zeta 0.3" : "restitution of a bond, zeta 0.1", e,
                parting / speed, 0, 2e-3, "dashpot half a step late");
  }
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(HertzImpact), cmocka_unit_test(BondInTension),
                                          cmocka_unit_test(BondInShear), cmocka_unit_test(BondWithDashpot)};

RUN_MAIN(tests)
