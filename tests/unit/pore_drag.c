/* ranks: 1 2 */
/* Drag laws of Eqs. 20-23 against numbers evaluated by hand, and the permeability of Eq. 66. */
#include "ground.h"

static const PgDragLaw *Law(const char name[])
{
  const PgDragLaw *law;
  CHECK(PgDragLawFind(name, &law));
  assert_non_null(law);
  assert_string_equal(law->name, name);
  return law;
}

static void Found(void **state)
{
  const PgDragLaw *law = Law("linear");

  (void)state;
  CHECK(PgDragLawFind("stokes", &law));
  assert_null(law);
}

/* Values of Eqs. 20-23 computed apart from this program, rho_f = 1000 kg/m3, mu = 1.01e-3 N s/m2. */
static void HandEvaluated(void **state)
{
  const struct {
    PetscReal n, d, speed, beta;
  } cases[] = {
      {0.0931, 0.01, 0.0, 143758.01739464514}, {0.0931, 0.01, 1.4, 2530336.9647630663},
      {0.4, 0.004, 0.25, 185367.1875},         {0.8, 0.01, 0.05, 2282.1875},          /* Ergun, up to n = 0.8 */
      {0.85, 0.01, 1e-3, 81.33663102560394},   {0.85, 0.01, 0.02, 299.8170886765238}, /* Wen-Yu, Re = 8, 168 */
      {0.92, 0.002, 0.6, 9653.909388481501},   {0.95, 0.01, 2.5, 4618.194055931379},  /* Re = 1093, 23515 */
  };
  const PgDragLaw *law = Law("ergun_wen_yu");

  (void)state;
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
    /* the numbers have 16 digits; a power costs a few roundings */
    NEAR(law->beta(cases[k].n, cases[k].d, cases[k].speed, 1000.0, 1.01e-3), cases[k].beta, 1e-13 * cases[k].beta);
}

/* Pressure drop of the CFDEM Ergun test: d = 1 mm, n = 0.451335, 15.6 mm long, nu = 1.5e-4 m2/s, rho = 10 kg/m3. The
   water feels beta (U/n), U the superficial velocity. */
static void ErgunColumn(void **state)
{
  const PetscReal  n = 0.451335, U[3] = {0.002, 0.011, 0.020}, drop[3] = {22.99, 126.62, 230.51};
  const PgDragLaw *law = Law("ergun_wen_yu");

  (void)state;
  for (int k = 0; k < 3; k++)
    NEAR(law->beta(n, 1e-3, U[k] / n, 10.0, 1.5e-3) * U[k] / n * 0.0156, drop[k], 0.005); /* half the last digit */
}

/* Terminal velocity of one sphere, the CFDEM settling test: rho_s = 3000, rho = 10 kg/m3, d = 0.1 mm, nu = 1e-5 m2/s. At
   n = 1 the drag on the solid, beta n/(1 - n) for a unit volume of it, carries its weight at 0.13734 m/s. */
static void SettlingSphere(void **state)
{
  const PgDragLaw *law = Law("ergun_wen_yu");
  const PetscReal  n = 1.0 - 1e-9, u = 0.13734, weight = (3000.0 - 10.0) * 9.81;

  (void)state;
  /* the speed is known to half its last digit, 4e-5 of it; the drag grows less than quadratically */
  NEAR(law->beta(n, 1e-4, u, 10.0, 1e-4) * u * n / (1.0 - n), weight, 2.0 * 4e-5 * weight);
}

/* Continuous within each branch, finite at rest, where C_D is not; the jumps at n = 0.8 and Re = 1000 are the paper's. */
static void ContinuityAndRest(void **state)
{
  const PgDragLaw *law = Law("ergun_wen_yu");
  const PetscReal  rho = 1000.0, mu = 1.01e-3, d = 0.01, n[] = {0.05, 0.0931, 0.4, 0.799, 0.81, 0.97};
  PetscReal        below, above, speed;

  (void)state;
  for (size_t k = 0; k < sizeof n / sizeof *n; k++) {
    const PetscReal m = n[k], rest = law->beta(m, d, 0.0, rho, mu);
    const PetscReal stokes = m <= 0.8 ? 150.0 * PetscSqr((1.0 - m) / (m * d)) * mu
                                      : 18.0 * mu * (1.0 - m) / (m * d * d) * PetscPowReal(m, -2.65);
    NEAR(rest, stokes, 1e-13 * stokes);
    /* Re^0.687 at 1e-15 m/s is below 3e-8; times 0.15 */
    NEAR(law->beta(m, d, 1e-15, rho, mu), rest, 5e-9 * rest);
    for (speed = 1e-4; speed < 0.09; speed *= 1.7) { /* Re below 1000 */
      const PetscReal at = law->beta(m, d, speed, rho, mu), next = law->beta(m, d, speed * (1.0 + 1e-9), rho, mu);
      /* beta grows at most in proportion to the speed */
      assert_true(next >= at && next <= at * (1.0 + 1.1e-9));
    }
  }
  /* the laws meet within the scatter of the measurements behind them: the same order of magnitude at n = 0.8 */
  below = law->beta(0.8, d, 0.05, rho, mu);
  above = law->beta(0.8 + 1e-12, d, 0.05, rho, mu);
  assert_true(above < below && above > 0.3 * below);
  /* 24 (1 + 0.15 1000^0.687)/1000 = 0.43829 on one side of Re = 1000, 0.43 on the other */
  speed = 1000.0 * mu / (rho * 0.9 * d);
  below = law->beta(0.9, d, speed * (1.0 - 1e-12), rho, mu);
  above = law->beta(0.9, d, speed * (1.0 + 1e-12), rho, mu);
  NEAR(above / below, 0.43 / 0.43829, 1.2e-5); /* half the last digit */
}

/* "linear" is what Ergun's law is at rest, at any speed and porosity. */
static void LinearLaw(void **state)
{
  const PgDragLaw *law = Law("linear"), *ergun = Law("ergun_wen_yu");

  (void)state;
  for (PetscReal n = 0.03; n < 0.8; n += 0.07) {
    const PetscReal beta = law->beta(n, 0.004, 2.0, 1000.0, 1.01e-3);
    NEAR(beta, ergun->beta(n, 0.004, 0.0, 1000.0, 1.01e-3), 1e-14 * beta);
    assert_true(beta == law->beta(n, 0.004, 0.1, 700.0, 1.01e-3));
  }
  /* Eq. 66: k_p = n/beta, 6.476e-7 for the panel */
  NEAR(0.0931 / law->beta(0.0931, 0.01, 0.0, 1000.0, 1.01e-3), 6.476e-7, 0.0005e-7); /* half the last digit */
}

/* k_p as the Darcy scheme uses it: the ratio of w to -grad p on a packing of unequal discs, pressed from left to right. */
static void PermeabilityOfTheScheme(void **state)
{
  const Packing     packing   = {9, 10, 5e-3, 0.1, 0.15};
  const char *const options[] = {"-permeability 3e-7", "-permeability_law kozeny_carman"};

  (void)state;
  for (int k = 0; k < 2; k++) {
    char       text[256];
    Ground     g;
    PetscInt   owned, seen = 0;
    PetscReal *n, *w, *r, *p, *grad;
    PgField    pressure;

    CHECK(PetscSNPrintf(text, sizeof text,
                        "%s -bc_left_pressure 1.4e5 -bc_bottom natural -bc_top natural "
                        "-fluid_viscosity 1.2e-3 -pressure_ksp_type cg -pressure_pc_type jacobi",
                        options[k]));
    GroundCreate(PETSC_COMM_WORLD, GROUND_DARCY, text, &g);
    GroundFill(&g, PackingCount(&packing), PackingPlace, &packing);
    CHECK(PgPoreSetUp(g.pore, 1e-4));
    CHECK(PgPorePredict(g.pore, 1e-4));
    CHECK(PgPoreCorrect(g.pore, 1e-4));
    owned    = GroundOwned(&g);
    n        = GroundArray(&g, "porosity");
    w        = GroundArray(&g, "relative_velocity");
    r        = GroundCore(&g, PG_RADIUS);
    p        = GroundArray(&g, "pressure");
    pressure = GroundField(&g, "pressure");
    CHECK(PgParticlesHalo(g.particles, 1, &pressure));
    CHECK(PetscMalloc1(2 * owned + 1, &grad));
    CHECK(PgSphGradient(g.sph, p, grad));
    for (PetscInt a = 0; a < owned; a++) {
      const PetscReal d   = 2.0 * r[a];
      const PetscReal k_p = k ? PetscPowReal(n[a], 3) * d * d / (150.0 * PetscSqr(1.0 - n[a]) * 1.2e-3) : 3e-7;
      const PetscReal big = 4e4 / 0.08; /* the mean gradient [Pa/m] */
      seen += PetscAbsReal(grad[2 * a]) > 0.1 * big;
      for (int i = 0; i < 2; i++) {
        /* w = n (w/n), and a gradient whose terms are some 100 times larger than it */
        NEAR(w[2 * a + i], -k_p * grad[2 * a + i], 1e-12 * k_p * big);
      }
    }
    assert_true(2 * GroundTotal(&g, seen) > g.count);
    CHECK(PetscFree(grad));
    GroundDestroy(&g);
  }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(Found),
    cmocka_unit_test(HandEvaluated),
    cmocka_unit_test(ErgunColumn),
    cmocka_unit_test(SettlingSphere),
    cmocka_unit_test(ContinuityAndRest),
    cmocka_unit_test(LinearLaw),
    cmocka_unit_test(PermeabilityOfTheScheme),
};

GROUND_MAIN(tests, PETSC_TRUE)
