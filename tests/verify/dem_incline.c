/* ranks: 1 2 */
/* Case disc_on_incline: rolls, slips, rests; see src/cases/disc_on_incline.c. */
#include "dem_run.h"

enum { LEVELS = 3 };
static const PetscReal r = 7e-3, g = 9.81, mu = 0.5, T = 0.04, k_s = 4e8, k_theta = 700;

typedef struct {
  PetscReal way, v, roll; /* downhill [m], [m/s]; r w [m/s] */
  PetscReal v_half;       /* v at T/2 [m/s] */
} Motion;

static Motion Slide(PetscReal degrees, PetscReal mu_theta, PetscReal stiffness, PetscReal dt)
{
  const PetscReal s = PetscSinReal(degrees * PETSC_PI / 180), c = PetscCosReal(degrees * PETSC_PI / 180);
  PetscReal       a[2], x[2], v[2], half[2], w;
  Run             run;

  RunStart(
      &run,
      "-case disc_on_incline -fluid none -incline_radius %.17g -incline_angle %.17g -dt %.17g -dem_mu_theta_r %.17g "
      "-dem_k_s %.17g -dem_c_s %.17g",
      (double)r, (double)degrees, (double)dt, (double)(mu_theta * r), (double)stiffness,
      (double)(8e3 * PetscSqrtReal(stiffness / k_s)));
  RunGet(&run, "position", 2, 1, a);
  RunUntil(&run, 0.5 * T);
  RunGet(&run, "velocity", 2, 1, half);
  RunUntil(&run, T);
  RunGet(&run, "position", 2, 1, x);
  RunGet(&run, "velocity", 2, 1, v);
  RunGet(&run, "angular_velocity", 1, 1, &w);
  RunEnd(&run);
  return (Motion){(x[0] - a[0]) * c - (x[1] - a[1]) * s, v[0] * c - v[1] * s, r * w, half[0] * c - half[1] * s};
}

static void Rolls(void **state)
{
  const PetscReal s = PetscSinReal(PETSC_PI / 9), a = 2.0 / 3 * g * s, m = PETSC_PI * r * r * 2000;
  const Motion    at = Slide(20, 0, k_s, 1e-5);

  (void)state;
  /* the spring stretches by m g sin/(3 k_s) = 9e-10 m, meanwhile the disc slides without turning */
  VerifyValue("disc_on_incline", "20 degrees: rolls, way a T^2/2 with a = 2/3 g sin [m]", 0.5 * a * T * T, at.way, 0,
              2 * m * g * s / (3 * k_s) / (0.5 * a * T * T),
              "twice the stretch of the sliding spring, m g sin/(3 k_s)");
  VerifyValue("disc_on_incline", "20 degrees: rolls, v = a T [m/s]", a * T, at.v, 0, 1e-9,
              "rounding 2e-10 of the weight by the overlap; angular momentum about the contact is kept");
  VerifyValue("disc_on_incline", "20 degrees: no slip, v + r w over v", 0, at.v + at.roll, a * T, 1e-8,
              "spring and dashpot at rest");
}

/* tan 60 = 1.73 > 3 mu = 1.5. Friction is at its cap when the spring has been loaded, which takes some 1/sqrt(k_s/m):
   the rigid contact is the limit of stiff springs, at order 1 in 1/sqrt(k_s). */
static void Slips(void **state)
{
  const PetscReal s = PetscSinReal(PETSC_PI / 3), c = 0.5, a = g * (s - mu * c), roll = 2 * mu * g * c;
  PetscReal       h[LEVELS], v[LEVELS], w[LEVELS];
  Motion          at = {0, 0, 0, 0};

  (void)state;
  for (PetscInt k = 0; k < LEVELS; k++) {
    const PetscReal stiffness = k_s * (PetscReal)(1 << (2 * k));

    h[k] = PetscSqrtReal(k_s / stiffness);
    at   = Slide(60, 0, stiffness, 8e-6 * h[k]);
    v[k] = PetscAbsReal(at.v / (a * T) - 1);
    w[k] = PetscAbsReal(at.roll / (-roll * T) - 1);
  }
  /* k_s = 6.4e9 N/m: loaded in about 1/20000 s with k_s = 4e8 N/m, a quarter of that here; without friction meanwhile */
  VerifyValue("disc_on_incline", "60 degrees: slips, v = g (sin - mu cos) T [m/s], k_s = 6.4e9 N/m", a * T, at.v, 0,
              1e-4, "mu g cos for 1e-5 s in which the spring is loaded");
  VerifyValue("disc_on_incline", "60 degrees: r w = -2 mu g cos T [m/s], k_s = 6.4e9 N/m", -roll * T, at.roll, 0,
              2.5e-4, "1e-5 s in which the spring is loaded, of T");
  /* steps of k_s by 4 keep dt sqrt(k_s) and the damping ratio: the same start, scaled in time */
  VerifyOrder("disc_on_incline", "60 degrees: v against rigid contact, in 1/sqrt(k_s)", LEVELS, h, v, 1, 0.02,
              "loading time of the spring");
  VerifyOrder("disc_on_incline", "60 degrees: r w against rigid contact, in 1/sqrt(k_s)", LEVELS, h, w, 1, 0.02,
              "loading time of the spring");
}

static void Rests(void **state)
{
  const PetscReal s = PetscSinReal(PETSC_PI / 9), m = PETSC_PI * r * r * 2000, tilt = PetscTanReal(PETSC_PI / 9);
  const PetscReal stretch = m * g * s * (1 / k_s + r * r / k_theta);
  const PetscReal a       = 2.0 / 3 * g * (s - 0.9 * tilt * PetscCosReal(PETSC_PI / 9));
  Motion          at      = Slide(20, 1.5 * tilt, k_s, 1e-5);

  (void)state;
  /* the springs take it all, sliding spring m g sin/k_s, moment spring r^2 m g sin/k_theta; at 1.5 the swing onto them,
     damped at 0.4 of critical, does not reach the cap */
  VerifyValue("disc_on_incline", "mu_theta = 1.5 tan(theta): rests, way of the springs [m]", stretch, at.way, 0, 1e-6,
              "rounding 1e-17 m of the overlap and of the way");
  at = Slide(20, 1.01 * tilt, k_s, 1e-5);
  VerifyValue("disc_on_incline", "mu_theta = 1.01 tan(theta): rests, speed over g sin T", 0, at.v, g * s * T, 1e-12,
              "dashpots: the swing decays with 2000 1/s for 0.04 s");
  at = Slide(20, 0.9 * tilt, k_s, 1e-5);
  /* a disc rolls faster until the moment spring is at its cap, some 5e-3 s: after that the acceleration is constant */
  VerifyValue("disc_on_incline", "mu_theta = 0.9 tan(theta): rolls, a = 2/3 g (sin - mu_theta cos) [m/s2]", a,
              (at.v - at.v_half) / (0.5 * T), 0, 1e-9, "rounding 2e-10 of the weight by the overlap");
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(Rolls), cmocka_unit_test(Slips), cmocka_unit_test(Rests)};
RUN_MAIN(tests)
