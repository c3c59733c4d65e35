/* ranks: 1 2 */
/* Energy and momentum budget: what the accounts do not explain falls with the second power of the time step, with
   friction, rolling resistance, dashpots, damping, gravity, plates and walls at work; impulses of walls, gravity and
   damping explain the momentum to rounding. Cases panel, disc_collision, disc_on_plane, biaxial. */
#include "dem_run.h"

enum { LEVELS = 4 };

static PgEnergy Energy(Run *run)
{
  PgEnergy e;
  CHECK(PgDemGetEnergy(run->dem, &e));
  return e;
}

static PetscReal Taken(const PgEnergy *e)
{
  return e->friction_sliding + e->friction_rolling + e->friction_moment + e->dashpots + e->local_damping +
         e->global_damping + e->rolling_excess;
}

static PetscReal Elastic(const PgEnergy *e)
{
  return e->elastic_normal + e->elastic_sliding + e->elastic_rolling + e->elastic_moment;
}

/* Runs to `end` with dt and returns the largest residual on the way (looked at `looks` times) over the work done. */
static PetscReal Residual(const char options[], PetscReal dt, PetscReal end, PetscInt looks, PgEnergy *last)
{
  PetscReal worst = 0;
  Run       run;

  RunStart(&run, "%s -fluid none -dem_energy true -dt %.17g -end_time %.17g", options, (double)dt, (double)end);
  for (PetscInt k = 1; k <= looks; k++) {
    RunUntil(&run, end * (PetscReal)k / (PetscReal)looks);
    *last = Energy(&run);
    worst = PetscMax(worst, PetscAbsReal(last->residual));
  }
  RunEnd(&run);
  return worst;
}

static void Budget(const char name[], const char options[], PetscReal dt, PetscReal end, PetscReal tolerance,
                   PetscReal order_tolerance, PgEnergy *e)
{
  PetscReal h[LEVELS], off[LEVELS], scale = 0;
  char      quantity[128];

  for (PetscInt k = 0; k < LEVELS; k++) {
    h[k]   = dt / (PetscReal)(1 << k);
    off[k] = Residual(options, h[k], end, 20, e);
    scale  = e->kinetic + Elastic(e) + PetscAbsReal(Taken(e));
    off[k] /= scale;
  }
  (void)snprintf(quantity, sizeof quantity, "%s: residual over energy now and taken", name);
  CHECK(PetscPrintf(
      PETSC_COMM_WORLD,
      "  %s: kinetic %.3e elastic %.3e friction %.3e %.3e %.3e dashpots %.3e damping %.3e %.3e excess %.3e; "
      "work of plates %.3e walls %.3e gravity %.3e J/m\n",
      name, (double)e->kinetic, (double)Elastic(e), (double)e->friction_sliding, (double)e->friction_rolling,
      (double)e->friction_moment, (double)e->dashpots, (double)e->local_damping, (double)e->global_damping,
      (double)e->rolling_excess, (double)e->work_plates, (double)e->work_walls, (double)e->work_gravity));
  VerifyValue("energy budget", quantity, 0, off[LEVELS - 1], 1, tolerance, "second order in the time step");
  (void)snprintf(quantity, sizeof quantity, "%s: residual, in the time step", name);
  VerifyOrder("energy budget", quantity, LEVELS, h, off, 2, order_tolerance,
              "events inside steps are of second order, with a factor that varies");
}

static void Pair(void **state)
{
  PgEnergy e;

  (void)state;
  Budget(
      "oblique collision, all dashpots and caps",
      "-case disc_collision -collision_speed 1.3 -collision_spin 90,-250 -dem_c_n 900 -dem_c_s 400 -dem_c_theta 1e-3 "
      "-dem_mu_s 0.3 -dem_mu_r 0.2 -dem_k_r 2e7 -dem_c_r 30",
      8e-7, 5e-5, 1e-4, 0.5, &e);
  assert_true(e.friction_sliding > 0 && e.dashpots > 0 && e.friction_moment > 0);
}

static void Plane(void **state)
{
  const PetscReal v0 = 0.3, m = PETSC_PI * 49e-6 * 2000;
  PgEnergy        e;

  (void)state;
  Budget("slide to roll with dashpots",
         "-case disc_on_plane -plane_radius 7e-3 -plane_speed 0.3 -wall_friction 0.5 -dem_c_s 8e3", 1.2e-5, 0.03, 1e-9,
         0.05, &e);
  Budget("slide to roll",
         "-case disc_on_plane -plane_radius 7e-3 -plane_speed 0.3 -wall_friction 0.5 -dem_c_s 0 -dem_c_theta 0", 1.2e-5,
         0.03, 1e-8, 0.6, &e);
  /* until the disc rolls with 2 v0/3. At the start half a step is without friction: dt/2 of v0/(3 mu g), of the speed
     v0 instead of the mean v0/2 */
  VerifyValue("energy budget", "slide to roll: sliding friction takes m v0^2/6 [J/m]", m * v0 * v0 / 6,
              e.friction_sliding, 0, 1.1 * 1.5e-6 / 0.0204, "half a step without friction, dt/T");
}

static void Panel(void **state)
{
  PgEnergy e;

  (void)state;
  Budget("panel 12 x 25, mu_s = 0.5, local damping 0.7",
         "-case panel -panel_columns 12 -panel_rows 25 -dem_local_damping 0.7", 4e-6, 2e-3, 1e-3, 0.6, &e);
  assert_true(e.work_plates > 0 && e.friction_sliding > 0 && e.local_damping > 0);
  VerifyReport("energy budget", "panel: share of the plate work that friction takes",
               (e.friction_sliding + e.friction_rolling + e.friction_moment) / e.work_plates, "no reference");
  VerifyReport("energy budget", "panel: share of the plate work that local damping takes",
               e.local_damping / e.work_plates, "no reference");
  VerifyReport("energy budget", "panel: excess of the rolling force over the plate work",
               e.rolling_excess / e.work_plates, "k_r is small: the law is not conservative in it");
}

static void Walls(void **state)
{
  PgEnergy e;

  (void)state;
  Budget("biaxial 12 x 25 with gravity and dashpots",
         "-case biaxial -biaxial_columns 12 -biaxial_velocity 0.1 -gravity 3,-9.81 -dem_mu_theta_r 1e-4 -dem_c_n 300 "
         "-dem_c_s 200 -dem_local_damping 0.2 -dem_global_damping 20 -wall_friction 0.2",
         2e-6, 2e-3, 1e-3, 0.6, &e);
  assert_true(e.work_walls != 0 && e.work_gravity != 0 && e.global_damping > 0);
}

enum { DISCS = 12 * 25 - 13 };

/* Momentum and mass of all discs, summed in the order of ids. */
static void Momentum(Run *run, PetscReal p[2], PetscReal *mass)
{
  static PetscReal v[2 * DISCS], m[DISCS];

  RunGet(run, "velocity", 2, DISCS, v);
  RunGet(run, "mass", 1, DISCS, m);
  p[0] = p[1] = *mass = 0;
  for (PetscInt k = 0; k < DISCS; k++) {
    p[0] += m[k] * v[2 * k];
    p[1] += m[k] * v[2 * k + 1];
    *mass += m[k];
  }
}

/* Without damping only walls and gravity change the momentum: half a step of the old and half a step of the new force
   each. */
static void Impulses(void **state)
{
  const PetscReal g[2]       = {30, -981};
  PetscReal       impulse[2] = {0, 0}, before[2], after[2], mass, before_walls[2], total = 0;
  Run             run;

  (void)state;
  RunStart(&run, "-case biaxial -fluid none -biaxial_columns 12 -biaxial_velocity 0.3 -gravity 30,-981 -dem_k_r 2e6 "
                 "-dem_mu_r 0.2 -dem_mu_theta_r 1e-4 -dem_c_n 300 -dem_c_s 200 -dem_c_r 20 -dem_local_damping 0 "
                 "-wall_friction 0.2 -dt 1.5e-6");
  Momentum(&run, before, &mass);
  before_walls[0] = before_walls[1] = 0;
  for (PetscInt k = 0; k < 400; k++) {
    PetscReal walls[2] = {0, 0};

    RunSteps(&run, 1);
    for (PetscInt w = 0; w < 4; w++) {
      PetscReal force[2];
      CHECK(PgDemGetWallForce(run.dem, w, force));
      walls[0] -= force[0];
      walls[1] -= force[1];
      total += (PetscAbsReal(force[0]) + PetscAbsReal(force[1])) * run.dt;
    }
    for (PetscInt c = 0; c < 2; c++) {
      impulse[c] += (0.5 * (before_walls[c] + walls[c]) + mass * g[c]) * run.dt;
      before_walls[c] = walls[c];
    }
  }
  Momentum(&run, after, &mass);
  RunEnd(&run);
  total += mass * 981 * 400 * 1.5e-6;
  /* 800 half kicks round velocities of up to 1 m/s by 1e-16; sums of 287 terms */
  for (PetscInt c = 0; c < 2; c++)
    VerifyValue("momentum budget",
                c ? "vertical: change against impulses, over their sum"
                  : "horizontal: change against impulses, over their sum",
                impulse[c], after[c] - before[c], total, 1e-13, "rounding of 800 half kicks");
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(Pair), cmocka_unit_test(Plane), cmocka_unit_test(Panel),
                                          cmocka_unit_test(Walls), cmocka_unit_test(Impulses)};
RUN_MAIN(tests)
