/* ranks: 1 2 */
/* The averaged Navier-Stokes equations where the bed is not the touching lattice: porosity that changes in space, and the
   drag law of Wen and Yu above n = 0.8. The beds of case bed_ergun, held, under a pressure difference; porosities are
   written over those of the lattice, `kinematic`, so that they stay.

   Graded    n(y) = 0.3 + 0.1 y/H, steady. Exact: n u = U, u = U/n falls by a quarter; of the averaged continuity only
             n div u + u.grad n = 0 is left. p_0 - p_H = int Ergun(n(y), U) dy + rho_f (u_H^2 - u_0^2)/2.
   Wen, Yu   uniform, u = U/n. Force of the water on a disc over its volume: W n^-3.65, pressure gradient
             W (1 - n) n^-4.65, where W = 3/4 C_D rho_f U^2/d with Re = U d/nu: the porosity is in the powers alone. A sphere
             of d = 0.1 mm and 3000 kg/m3 in a fluid of 10 kg/m3 and nu = 1e-5 m2/s sinks at 0.13734 m/s:
             W = (rho_s - rho_f) g there. */
#include "water.h"

#define BED                                                                                                            \
  "-case bed_ergun -bed_columns 8 -porosity kinematic -sph_operators corrected -coupling drag" WATER_SOLVER            \
  " -pressure_ksp_type gmres -pressure_sub_pc_type ilu "

/* Porosity n(y) = low + slope (y - y of the lowest row), written over that of the lattice. */
static void SetPorosity(Water *w, PetscReal low, PetscReal slope, PetscReal radius)
{
  const PetscReal *x = WaterField(w, "position");
  PetscReal       *n = WaterField(w, "porosity");

  for (PetscInt i = 0; i < WaterOwned(w); i++) n[i] = low + slope * (x[2 * i + 1] - radius);
  CHECK(PgPoreRefresh(w->pore));
}

/* ---- graded porosity ---- */

enum { LEVELS = 3 };
static const PetscReal U_graded = 0.03, low = 0.3, rise = 0.1, H = 0.5 * SQRT3 * 0.24;

/* Pressure at the bottom over that at the top: midpoint rule, exact to 1e-8 with a thousand points. */
static PetscReal Drop(PetscReal mu, PetscReal d)
{
  const PetscInt  points = 1000;
  const PetscReal U = U_graded, rho = 1000.0;
  PetscReal       sum = 0.5 * rho * U * U * (1.0 / PetscSqr(low + rise) - 1.0 / PetscSqr(low));

  for (PetscInt k = 0; k < points; k++) {
    const PetscReal n = low + rise * ((PetscReal)k + 0.5) / (PetscReal)points, n3 = n * n * n;
    sum += (150.0 * (1.0 - n) * (1.0 - n) * mu * U / (n3 * d * d) + 1.75 * (1.0 - n) * rho * U * U / (n3 * d)) * H /
           (PetscReal)points;
  }
  return sum;
}

/* Largest error of n u/U in all rows, that in the middle, and u/U at the top. */
static PetscReal Graded(PetscInt rows, PetscReal *middle, PetscReal *top)
{
  const PetscReal porosity = low + 0.5 * rise, spacing = 1e-2 * 24.0 / (PetscReal)(rows - 1);
  const PetscReal d = spacing * PetscSqrtReal((1.0 - porosity) / (1.0 - TOUCHING_POROSITY));
  /* a viscosity in proportion to d^2 keeps the relaxation time, 1 to 2 ms */
  const PetscReal mu = 0.1 * PetscSqr(d / 1e-2);
  PetscReal       w_y[MOST_ROWS], u[MOST_ROWS], error = 0.0;
  Water           w;

  WaterStart(&w, 8, rows,
             BED "-bed_rows %d -bed_radius %.17g -bed_porosity %.17g -fluid_viscosity %.17g -dt 1e-4 "
                 "-bc_bottom_pressure %.17g",
             (int)rows, (double)(0.5 * d), (double)porosity, (double)mu, (double)(1e5 + Drop(mu, d)));
  SetPorosity(&w, low, rise / H, 0.5 * d);
  WaterRun(&w, 0.03);
  WaterRows(&w, "relative_velocity", 2, 1, w_y, NULL);
  WaterRows(&w, "fluid_velocity", 2, 1, u, NULL);
  WaterEnd(&w);
  for (PetscInt k = 0; k < rows; k++) error = PetscMax(error, PetscAbsReal(w_y[k] / U_graded - 1.0));
  *middle = PetscAbsReal(w_y[rows / 2] / U_graded - 1.0);
  *top    = u[rows - 1] / U_graded;
  return error;
}

static void GradedPorosity(void **state)
{
  static const PetscInt rows[LEVELS] = {13, 25, 49};
  PetscReal             h[LEVELS], error[LEVELS], middle[LEVELS], top;

  (void)state;
  for (int k = 0; k < LEVELS; k++) {
    h[k]     = 1.0 / (PetscReal)(rows[k] - 1);
    error[k] = Graded(rows[k], &middle[k], &top);
  }
  /* kernels are cut at the two ends: the corrected gradient is of first order there */
  VerifyOrder("averaged continuity", "steady n u = U through porosity 0.3 to 0.4, worst row, in spacing/H", LEVELS, h,
              error, 1.0, 0.1, "gradients at the ends, where kernels are cut");
  /* second order inside; twice the time step takes 1.5e-5 off the last error, 1.2e-4, and 5e-4 off the first */
  VerifyOrder("averaged continuity", "steady n u = U through porosity 0.3 to 0.4, middle row, in spacing/H", LEVELS, h,
              middle, 2.0, 0.3, "second order inside, and what the time step adds");
  /* half the error of the worst row, a row of an end */
  VerifyValue("averaged continuity", "u/U at the top, n = 0.4, 49 rows", 1.0 / (low + rise), top, 0.0, 4e-3,
              "first order at the ends, 0.3/96");
}

/* ---- Wen and Yu ---- */

/* Force on a disc over its volume, and U, in the middle row, under the pressure gradient that belongs to W and U. */
static void Stream(PetscReal n, PetscReal d, PetscReal rho_f, PetscReal W, PetscReal U, const char options[],
                   PetscReal *force, PetscReal *flux)
{
  enum { ROWS = 9, STEPS = 250 };
  const PetscReal spacing  = d * PetscSqrtReal((1.0 - TOUCHING_POROSITY) / 0.5);
  const PetscReal gradient = W * (1.0 - n) * PetscPowReal(n, -4.65), tau = rho_f * U / (n * gradient);
  PetscReal       f[MOST_ROWS], w_y[MOST_ROWS];
  Water           w;

  WaterStart(&w, 8, ROWS,
             BED "-bed_rows %d -bed_radius %.17g -bed_porosity 0.5 -detach_porosity 0.98 -bc_bottom_pressure %.17g "
                 "-dt %.17g -end_time 1 %s",
             (int)ROWS, (double)(0.5 * d), (double)(1e5 + gradient * 0.5 * SQRT3 * spacing * (ROWS - 1)),
             (double)(0.1 * tau), options);
  SetPorosity(&w, n, 0.0, 0.0);
  for (int k = 0; k < STEPS; k++) CHECK(PgSimulationStep(w.sim));
  WaterRows(&w, "fluid_force", 2, 1, f, NULL);
  WaterRows(&w, "relative_velocity", 2, 1, w_y, NULL);
  WaterEnd(&w);
  *force = f[ROWS / 2] / (0.25 * PETSC_PI * d * d);
  *flux  = w_y[ROWS / 2];
}

static void WenYu(void **state)
{
  static const PetscReal n[]    = {0.85, 0.95};
  const PetscReal        weight = (3000.0 - 10.0) * 9.81;
  PetscReal              force, U;
  char                   name[128];

  (void)state;
  for (int k = 0; k < 2; k++) {
    Stream(n[k], 1e-4, 10.0, weight, 0.13734, "-fluid_density 10 -fluid_viscosity 1e-4 -solid_density 3000", &force,
           &U);
    (void)snprintf(name, sizeof name, "U in which discs of 0.1 mm hover [m/s], n = %g", (double)n[k]);
    /* 0.13734 is known to half its last digit, 4e-5; what is left of the start is e^-25 */
    VerifyValue("Wen and Yu", name, 0.13734, U, 0.0, 4e-5, "reference has 5 digits");
    (void)snprintf(name, sizeof name, "force on them, over the weight under water and n^-3.65, n = %g", (double)n[k]);
    /* the force belongs to the pressure gradient, whatever U is: start e^-25, solver */
    VerifyValue("Wen and Yu", name, 1.0, force / (weight * PetscPowReal(n[k], -3.65)), 1.0, 1e-6,
                "rest of the start e^-25, solver");
  }
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(GradedPorosity), cmocka_unit_test(WenYu)};
WATER_MAIN(tests)
