/* ranks: 1 2 */
/* Case disc_on_plane: slide to roll, and rolling resistance; see src/cases/disc_on_plane.c. */
#include "dem_run.h"

enum { LEVELS = 3 };
static const PetscReal r = 7e-3, g = 9.81, mu = 0.5, k_s = 4e8;

typedef struct {
  PetscReal x, v, roll; /* roll: r w */
} Motion;

static Motion Now(Run *run)
{
  PetscReal x[2], v[2], w;

  RunGet(run, "position", 2, 1, x);
  RunGet(run, "velocity", 2, 1, v);
  RunGet(run, "angular_velocity", 1, 1, &w);
  return (Motion){x[0], v[0], r * w};
}

/* With a dashpot friction is at its cap from the first moment on, and constant forces are exact for the integrator:
   what is left is rounding, at any time step. */
static void SlideToRoll(void **state)
{
  const PetscReal v0 = 0.3, T = v0 / (3 * mu * g);
  PetscReal       slid = 0, began = 0, t = 0;
  Motion          m = {0, 0, 0};

  (void)state;
  for (PetscInt k = 0; k < LEVELS; k++) {
    const PetscInt  steps = 800 << k; /* up to half of T */
    const PetscReal dt    = 0.5 * T / (PetscReal)steps;
    Run             run;

    RunStart(&run, "-case disc_on_plane -fluid none -plane_radius %.17g -plane_speed %.17g -dt %.17g", (double)r,
             (double)v0, (double)dt);
    RunSteps(&run, steps);
    m    = Now(&run);
    slid = PetscMax(slid, PetscAbsReal(m.v / (v0 - mu * g * RunTime(&run)) - 1));
    /* the sliding rate falls at 3 mu g: from 2 % of the start on, before the springs take over, to zero */
    while (m.v + m.roll > 0.02 * v0) {
      RunSteps(&run, 1);
      m = Now(&run);
    }
    t     = RunTime(&run) + (m.v + m.roll) / (3 * mu * g);
    began = PetscMax(began, PetscAbsReal(t / T - 1));
    RunUntil(&run, 1.5 * T);
    m = Now(&run);
    RunEnd(&run);
  }
  /* up to 9600 steps, each with a rounding of 1e-16 of the numbers, and the weight is known to 1e-12: the overlap is
     5e-9 m of a radius 7e-3 m */
  VerifyValue("disc_on_plane", "speed while sliding over v0 - mu g t, worst of 3 time steps", 1, 1 + slid, 0, 1e-10,
              "overlap 5e-9 m is a difference of 7e-3 m: rounding 2e-10 of the weight");
  VerifyValue("disc_on_plane", "rolling begins at v0/(3 mu g) [s], worst of 3 time steps", T, T * (1 + began), 0, 1e-10,
              "rounding of the overlap");
  /* angular momentum about the contact point is kept by every step; the swing of the damped spring is gone: its slow
     mode decays at k_s/c_s = 5e4 1/s for 0.01 s */
  VerifyValue("disc_on_plane", "speed of rolling 2 v0/3 [m/s], r = 7 mm", 2 * v0 / 3, m.v, 0, 1e-10,
              "rounding; spring and dashpot at rest");
  VerifyValue("disc_on_plane", "rolling without slip, v + r w over v0", 0, m.v + m.roll, v0, 1e-10,
              "rounding; spring and dashpot at rest");
}

static void RollingStop(void **state)
{
  const PetscReal v0 = 0.1, mu_theta = 0.3, T = 3 * v0 / (2 * mu_theta * g), way = 3 * v0 * v0 / (4 * mu_theta * g);
  const PetscReal mg = PETSC_PI * r * r * 2000 * g, stretch = 2 * mu_theta * mg / (3 * k_s);
  PetscReal       far = 0, stopped = 0, drift = 0;

  (void)state;
  for (PetscInt k = 0; k < LEVELS; k++) {
    const PetscReal dt = T / (PetscReal)(4000 << k);
    PetscReal       t, x;
    Motion          m, last;
    Run             run;

    RunStart(&run,
             "-case disc_on_plane -fluid none -plane_radius %.17g -plane_speed %.17g -plane_spin %.17g -dt %.17g "
             "-dem_mu_theta_r %.17g",
             (double)r, (double)v0, (double)(-v0 / r), (double)dt, (double)(mu_theta * r));
    /* before the springs take over: the moment has left its cap when w < c_theta/k_theta times its rate, 0.3 % */
    for (m = Now(&run); m.v > 0.02 * v0; m = Now(&run)) RunSteps(&run, 1);
    t = RunTime(&run) + m.v / (2 * mu_theta * g / 3);
    for (last = m; m.v > 0; m = Now(&run)) {
      last = m;
      RunSteps(&run, 1);
    }
    x       = PetscMax(m.x, last.x);
    far     = PetscMax(far, PetscAbsReal(x / way - 1));
    stopped = PetscMax(stopped, PetscAbsReal(t / T - 1));
    RunUntil(&run, 1.3 * T);
    drift = PetscMax(drift, PetscAbsReal(Now(&run).x - x));
    RunEnd(&run);
  }
  /* before friction can turn the disc back, the sliding spring stretches to 2/3 mu_theta m g/k_s = 1.5e-9 m; the last
     step ends up to 2/3 mu_theta g dt^2/2 = 2e-10 m before the stop */
  VerifyValue("disc_on_plane", "stops after 3 v0^2/(4 mu_theta g) [m], k_r = 0, worst of 3 time steps", way,
              way * (1 + far), 0, 1.2 * stretch / way,
              "stretch of the sliding spring, 2/3 mu_theta m g/k_s = 1.5e-9 m");
  VerifyValue("disc_on_plane", "stops at 3 v0/(2 mu_theta g) [s], worst of 3 time steps", T, T * (1 + stopped), 0,
              2 * stretch / way, "stretch of the sliding spring");
  /* the moment spring swings back by its angle at the cap, mu_theta r m g/k_theta = 9e-6 rad */
  VerifyValue("disc_on_plane", "stays where it stopped: drift over the way", 0, drift, way, 5e-5,
              "recoil of the moment spring, 2 r 9e-6 rad");
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(SlideToRoll), cmocka_unit_test(RollingStop)};
RUN_MAIN(tests)
