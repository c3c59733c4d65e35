/* The contact laws of Tak, Park & Park (2013), Eqs. 15-18, for one pair: bonds that hold and break, friction, Hertz. */
#include "dem_setup.h"

static const PgContactParameters parameters = {.k_n        = 6.3e8,
                                               .k_s        = 4.1e8,
                                               .c_n        = 310,
                                               .c_s        = 170,
                                               .mu_s       = 0.45,
                                               .R_n        = 900,
                                               .R_t        = 500,
                                               .bond_range = 1e-9,
                                               .E          = 3e9,
                                               .nu         = 0.31};

/* One rounding of the arithmetic; results pass through fewer than 20. */
#define EPS (20 * PETSC_MACHINE_EPSILON)

static PgContactHistory Bonded(void)
{
  const PgContactMotion touch = {.overlap = 0};
  PgContactHistory      h     = {0, 0, 0};

  (void)PgContactLawTak2013(&parameters, &touch, 0, &h);
  assert_true(h.f_r == 1);
  return h;
}

/* Eq. 15 in both directions up to R_n, dashpot included; beyond, no tension ever again, but pressure as before. */
static void Tension(void **state)
{
  PgContactHistory h = Bonded();
  PgContactMotion  m = {.overlap = -1.4e-6, .overlap_rate = -0.05};
  PgContactForce   f;

  (void)state;
  f = PgContactLawTak2013(&parameters, &m, 1e-7, &h);
  assert_true(PetscAbsReal(f.F_N - (6.3e8 * 1.4e-6 + 310 * 0.05)) < EPS * 900 && f.F_N < 900);
  m.overlap = -1.40475e-6; /* 885 N of spring and 15.5 N of dashpot: above 900 N only together */
  f         = PgContactLawTak2013(&parameters, &m, 1e-7, &h);
  assert_true(f.F_N == 0 && f.F_T == 0 && h.f_r == -1);
  m.overlap_rate = 0;
  m.overlap      = -1e-9;
  assert_true(PgContactLawTak2013(&parameters, &m, 1e-7, &h).F_N == 0);
  m.overlap = 2e-3; /* pressure far above R_n does not count as tension */
  assert_true(PetscAbsReal(PgContactLawTak2013(&parameters, &m, 1e-7, &h).F_N + 6.3e8 * 2e-3) < EPS * 2e6);
  h = Bonded();
  assert_true(PetscAbsReal(PgContactLawTak2013(&parameters, &m, 1e-7, &h).F_N + 6.3e8 * 2e-3) < EPS * 2e6);
  assert_true(h.f_r == 1);
  m.overlap = -1e-9; /* not mended by a new start, either */
  h.f_r     = -1;
  (void)PgContactLawTak2013(&parameters, &m, 0, &h);
  assert_true(h.f_r == -1);
}

/* Eq. 16 without cap up to |F_t| = R_t, also under tension; afterwards Eq. 17. */
static void Shear(void **state)
{
  const PetscReal  dt = 1e-7, u = 5e-7, N = 6.3e8 * u;
  PgContactHistory h = Bonded();
  PgContactMotion  m = {.overlap = -1e-6, .sliding_rate = 1.1};
  PgContactForce   f = {0, 0, 0};
  PetscInt         k = 0;

  (void)state;
  while (h.f_r > 0 && k < 100) {
    f = PgContactLawTak2013(&parameters, &m, dt, &h);
    k++;
    if (h.f_r > 0) assert_true(PetscAbsReal(f.F_T + 4.1e8 * 1.1 * dt * (PetscReal)k + 170 * 1.1) < 10 * EPS * 500);
  }
  /* 187 N of dashpot and 45.1 N in each step: the seventh is beyond 500 N */
  assert_int_equal(k, 7);
  assert_true(f.F_T == 0); /* drawn apart: nothing is left */
  m.overlap      = u;
  m.sliding_rate = -1.1;
  h              = Bonded();
  for (k = 0; k < 7; k++) f = PgContactLawTak2013(&parameters, &m, dt, &h);
  assert_true(h.f_r == -1 && PetscAbsReal(f.F_T - 0.45 * N) < EPS * N); /* in the step in which it breaks */
  m.sliding_rate = 0;
  f              = PgContactLawTak2013(&parameters, &m, dt, &h);
  assert_true(f.F_T < 0.45 * N); /* the dashpot is gone, and the spring holds what stood beside it */
  m.sliding_rate = 40;
  for (k = 0; k < 30; k++) f = PgContactLawTak2013(&parameters, &m, dt, &h);
  assert_true(PetscAbsReal(f.F_T + 0.45 * N) < EPS * N); /* against the motion */
  m.overlap = 0;
  f         = PgContactLawTak2013(&parameters, &m, dt, &h);
  assert_true(f.F_T == 0 && h.f_s == 0);
}

/* Discs that meet later, or are not asked to bond, do not; an evaluation with dt = 0 moves no spring. */
static void WhoIsBonded(void **state)
{
  const PgContactMotion apart = {.overlap = -2e-9}, pressed = {.overlap = 1e-6, .sliding_rate = 0.2};
  PgContactParameters   p = parameters;
  PgContactHistory      h = {0, 0, 0};

  (void)state;
  (void)PgContactLawTak2013(&p, &apart, 0, &h);
  assert_true(h.f_r == 0);
  (void)PgContactLawTak2013(&p, &pressed, 1e-7, &h);
  assert_true(h.f_r == -1);
  h = (PgContactHistory){0, 0, 0};
  (void)PgContactLawTak2013(&p, &pressed, 0, &h);
  assert_true(h.f_r == 1 && h.f_s == 0);
  h     = (PgContactHistory){0, 0, 0};
  p.R_n = p.R_t = 0;
  (void)PgContactLawTak2013(&p, &pressed, 0, &h);
  assert_true(h.f_r == -1 && h.f_s == 0);
}

/* Eq. 18; its derivative is the stiffness that the critical time step goes by. */
static void Hertz(void **state)
{
  const PetscReal     R = 2.5e-3, u = 3e-6, modulus = 3e9 / (2 * (1 - 0.31 * 0.31));
  PgContactParameters p = parameters;
  PgContactMotion     m = {.overlap = u, .R = R};
  PgContactHistory    h = {0, 0, 0};
  PgContactForce      f;

  (void)state;
  p.c_n = 0;
  f     = PgContactLawHertz(&p, &m, 1e-7, &h);
  assert_true(PetscAbsReal(f.F_N / (-4.0 / 3.0 * modulus * PetscSqrtReal(R) * PetscPowReal(u, 1.5)) - 1) < EPS);
  p.c_n          = 310;
  m.overlap_rate = 1e-3;
  m.sliding_rate = 3;
  f              = PgContactLawHertz(&p, &m, 1e-5, &h);
  assert_true(PetscAbsReal(f.F_N / (-4.0 / 3.0 * modulus * PetscSqrtReal(R) * PetscPowReal(u, 1.5) - 0.31) - 1) < EPS);
  assert_true(PetscAbsReal(f.F_T - 0.45 * f.F_N) < EPS);
  m.overlap = 0;
  f         = PgContactLawHertz(&p, &m, 1e-5, &h);
  assert_true(f.F_N == 0 && f.F_T == 0 && h.f_s == 0);
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(Tension), cmocka_unit_test(Shear),
                                          cmocka_unit_test(WhoIsBonded), cmocka_unit_test(Hertz)};

static int Tests(void) { return cmocka_run_group_tests(tests, NULL, NULL); }

int main(int argc, char *argv[]) { return RunTests(argc, argv, Tests); }
