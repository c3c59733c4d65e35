/* ranks: 1 2 */
/* Case disc_collision: duration, largest overlap and restitution; see src/cases/disc_collision.c. */
#include "dem_run.h"

enum { LEVELS = 4 };
static const PetscReal r[2] = {4e-3, 6.5e-3}, rho = 2000, k_n = 6e8, speed = 1.3, angle = 30;

typedef struct {
  PetscReal duration, overlap, restitution;
} Outcome;

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

/* Until the discs have parted. Zero crossing by the chord of the last step, where the force and so the curvature
   vanish; top of the overlap by a parabola through its three largest values. */
static Outcome Collide(PetscReal c_n, PetscInt steps)
{
  const PetscReal dt   = PETSC_PI * PetscSqrtReal(ReducedMass() / k_n) / (PetscReal)steps;
  const PetscReal n[2] = {PetscCosReal(angle * PETSC_PI / 180), PetscSinReal(angle * PETSC_PI / 180)};
  PetscReal       u[3] = {0, 0, 0}, v[4];
  Outcome         o    = {0, 0, 0};
  Run             run;

  RunStart(&run, "-case disc_collision -fluid none -collision_speed %.17g -collision_angle %.17g -dt %.17g -dem_c_n %g",
           (double)speed, (double)angle, (double)dt, (double)c_n);
  for (PetscInt k = 0; k == 0 || u[2] > 0; k++) {
    assert_true(k < 2 * steps);
    RunSteps(&run, 1);
    u[0] = u[1];
    u[1] = u[2];
    u[2] = Overlap(&run);
    if (u[1] > u[0] && u[1] >= u[2]) o.overlap = u[1] + 0.125 * PetscSqr(u[2] - u[0]) / (2 * u[1] - u[0] - u[2]);
  }
  o.duration = RunTime(&run) - dt * u[2] / (u[2] - u[1]);
  RunSteps(&run, 2);
  RunGet(&run, "velocity", 2, 2, v);
  o.restitution = ((v[2] - v[0]) * n[0] + (v[3] - v[1]) * n[1]) / speed;
  RunEnd(&run);
  return o;
}

static void Elastic(void **state)
{
  const PetscReal T = PETSC_PI * PetscSqrtReal(ReducedMass() / k_n), top = speed * PetscSqrtReal(ReducedMass() / k_n);
  PetscReal       h[LEVELS], duration[LEVELS], overlap[LEVELS];
  Outcome         o = {0, 0, 0};

  (void)state;
  for (PetscInt k = 0; k < LEVELS; k++) {
    o           = Collide(0, 25 << k);
    h[k]        = 1 / (PetscReal)(25 << k);
    duration[k] = PetscAbsReal(o.duration / T - 1);
    overlap[k]  = PetscAbsReal(o.overlap / top - 1);
  }
  /* a leapfrog half period is short by the factor 1 - (omega dt)^2/24, 1e-5 with 200 steps in it */
  VerifyValue("disc_collision", "duration pi sqrt(m'/k_n) [s], 200 steps", T, o.duration, 0, 1.1e-5,
              "(omega dt)^2/24 of leapfrog = 1.0e-5");
  /* the next order is (omega dt)^2 = 1.6 % of it at the coarsest step */
  VerifyOrder("disc_collision", "duration", LEVELS, h, duration, 2, 0.1, "leapfrog");
  /* (omega dt)^2/8 too large: 3.1e-5 */
  VerifyValue("disc_collision", "largest overlap v sqrt(m'/k_n) [m], 200 steps", top, o.overlap, 0, 3.5e-5,
              "(omega dt)^2/8 of leapfrog = 3.1e-5");
  VerifyOrder("disc_collision", "largest overlap", LEVELS, h, overlap, 2, 0.1, "leapfrog");
  /* the step in which contact ends is cut: (omega dt)^2/2 of the energy at most, half of it in the speed */
  VerifyValue("disc_collision", "restitution without dashpot, 200 steps", 1, o.restitution, 0, 6.2e-5,
              "contact ends inside a step: (omega dt)^2/4 = 6.2e-5");
}

static void Dashpot(void **state)
{
  const PetscReal m = ReducedMass(), c_n = 3500, beta = c_n / (2 * m), w = PetscSqrtReal(k_n / m - beta * beta);
  const PetscReal end = (PETSC_PI - atan2(2 * beta * w, w * w - beta * beta)) / w;
  const PetscReal e   = -PetscExpReal(-beta * end) * (PetscCosReal(w * end) - beta / w * PetscSinReal(w * end));
  PetscReal       h[LEVELS], error[LEVELS];
  Outcome         o = {0, 0, 0};

  (void)state;
  for (PetscInt k = 0; k < LEVELS; k++) {
    o        = Collide(c_n, 100 << k);
    h[k]     = 1 / (PetscReal)(100 << k);
    error[k] = PetscAbsReal(o.restitution - e);
  }
  /* half a step of the dashpot, omega dt/2 = 2e-3 of its effect 1 - e = 0.5 */
  VerifyValue("disc_collision", "restitution with c_n, no tension, 800 steps", e, o.restitution, 1, 1e-3,
              "dashpot half a step late: omega dt/2 = 2e-3 of 1 - e");
  /* where contact ends inside a step changes the error by (omega dt)^2/4 or less: 5 % of it at the coarsest */
  VerifyOrder("disc_collision", "restitution with c_n", LEVELS, h, error, 1, 0.15, "dashpot half a step late");
  VerifyReport("disc_collision", "difference to exp(-pi beta/omega), which allows tension",
               e - PetscExpReal(-PETSC_PI * beta / w), "the law clips tension");
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(Elastic), cmocka_unit_test(Dashpot)};
RUN_MAIN(tests)
