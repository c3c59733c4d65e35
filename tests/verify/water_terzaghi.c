/* ranks: 1 2 */
/* Consolidation against Terzaghi's series (case column_terzaghi) in both schemes, with orders in the spacing and in the
   step; undrained response (case undrained). */
#include "water.h"

enum { COLUMNS = 8, REFINEMENTS = 3 };
static const PetscInt  rows_of[REFINEMENTS] = {13, 25, 49};
static const PetscReal q = 1e4, p_top = 1e5;

/* Ten times softer than the paper's, water a hundred times slower: consolidation takes 80 times as long as a wave. */
static const PetscReal k_n = 6e7, k_s = 4e7, k_p = 6.5e-9;

/* On two ranks the consolidation alone says that they do as one. */
static PetscBool Once(void)
{
  PetscMPIInt ranks;
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  return (PetscBool)(ranks == 1);
}

static PetscReal RadiusOf(PetscInt rows) { return 5e-3 * 24.0 / (PetscReal)(rows - 1); }
static PetscReal Height(void) { return SQRT3 * 5e-3 * 24.0; }
static PetscReal Modulus(void) { return 0.25 * SQRT3 * (3.0 * k_n + k_s); }
static PetscReal TimeOf(PetscReal T) { return T * Height() * Height() / (k_p * Modulus()); }

static PetscReal ExactPressure(PetscReal z, PetscReal T)
{
  PetscReal sum = 0.0;

  for (int j = 0; j < 200; j++) {
    const PetscReal M = 0.5 * PETSC_PI * (2.0 * j + 1.0);
    sum += 2.0 / M * PetscSinReal(M * z) * PetscExpReal(-M * M * T);
  }
  return sum;
}

static PetscReal ExactDegree(PetscReal T)
{
  PetscReal sum = 0.0;

  for (int j = 0; j < 200; j++) {
    const PetscReal M = 0.5 * PETSC_PI * (2.0 * j + 1.0);
    sum += 2.0 / (M * M) * PetscExpReal(-M * M * T);
  }
  return 1.0 - sum;
}

/* `steps`: steps of the discs until T = 0.1. */
static void Start(Water *w, const char name[], PetscInt rows, PetscReal steps, const char options[])
{
  const PetscReal r = RadiusOf(rows);

  WaterStart(
      w, COLUMNS, rows,
      "-case %s -column_columns %d -column_rows %d -column_radius %.15g -column_load %.15g -dem_k_n %.15g -dem_k_s "
      "%.15g -dem_k_r 200 -dem_k_theta 70  -dt %.17g -sph_gradient corrected "
      "-sph_laplacian_eta 0.01" WATER_SOLVER " %s",
      name, (int)COLUMNS, (int)rows, (double)r, (double)q, (double)k_n, (double)k_s, (double)(TimeOf(0.1) / steps),
      options);
}

/* 0.7 of the critical time step for touching discs with these stiffnesses. */
static PetscReal StepsOf(PetscInt rows) { return 40.0 * (PetscReal)(rows - 1); }

/* Root mean square error of p over q, and error of the settlement over its end. */
static void Compare(Water *w, PetscReal T, PetscReal *pressure, PetscReal *degree)
{
  PetscReal p[MOST_ROWS], y[MOST_ROWS], start[MOST_ROWS], sum = 0.0;

  WaterRows(w, "pressure", 1, 0, p, NULL);
  WaterRows(w, "position", 2, 1, y, NULL);
  WaterRows(w, "initial_position", 2, 1, start, NULL);
  for (PetscInt k = 0; k < w->rows; k++)
    sum += PetscSqr((p[k] - p_top) / q - ExactPressure((PetscReal)(w->rows - 1 - k) / (PetscReal)(w->rows - 1), T)) /
           (PetscReal)w->rows;
  *pressure = PetscSqrtReal(sum);
  *degree   = (start[w->rows - 1] - y[w->rows - 1]) / (q * Height() / Modulus()) - ExactDegree(T);
}

enum { TIMES = 3 };
static const PetscReal T[TIMES] = {0.05, 0.2, 0.5};

/* A tenth of the critical dashpots. They take away waves of the discs of one or two rows, which the water does not feel;
   they relax in 1e-5 s, consolidation takes 0.07 s. */
static void Dashpots(PetscInt rows, char options[], size_t size)
{
  (void)snprintf(options, size, "-coupling_scheme incremental -dem_c_n %.15g -dem_c_s %.15g",
                 (double)(1.2e5 * RadiusOf(rows)), (double)(8e4 * RadiusOf(rows)));
}

/* The viscosity that gives k_p by Eq. 66, or Darcy's law with k_p itself. */
static void SchemeOptions(PetscBool ns, PetscInt rows, char options[], size_t size)
{
  const PetscReal n = TOUCHING_POROSITY, d = 2.0 * RadiusOf(rows);

  if (ns)
    (void)snprintf(options, size,
                   "-fluid ns -fluid_every 5 -ns_continuity averaged -ns_drag linear -fluid_viscosity %.15g",
                   (double)(n * n * n * d * d / (150.0 * (1.0 - n) * (1.0 - n) * k_p)));
  else
    (void)snprintf(options, size, "-fluid darcy -permeability %.15g", (double)k_p);
}

/* `error`: computed minus exact degree of consolidation, each refinement. */
static void Degrees(const char scheme[], PetscReal at, const PetscReal h[REFINEMENTS],
                    const PetscReal error[REFINEMENTS])
{
  const PetscReal exact = ExactDegree(at), fine = error[REFINEMENTS - 1], coarse = error[REFINEMENTS - 2];
  PetscReal       size[REFINEMENTS];
  char            name[96];

  for (int k = 0; k < REFINEMENTS; k++) size[k] = PetscAbsReal(error[k]);
  (void)snprintf(name, sizeof name, "U at T = %g, %s", (double)at, scheme);
  VerifyOrder("column_terzaghi", name, REFINEMENTS, h, size, 1.0, 0.3, "ends of first order, waves of 1e-3 q");
  (void)snprintf(name, sizeof name, "U at T = %g, 49 rows, %s", (double)at, scheme);
  /* where the column ends is known to a row */
  VerifyValue("column_terzaghi", name, exact, exact + fine, 1.0, 0.02, "one row of 48");
  (void)snprintf(name, sizeof name, "U at T = %g, extrapolated from 25 and 49 rows, %s", (double)at, scheme);
  /* 2 fine - coarse has thrice the waves of 1e-3 q, and what is of second order, a few (1/48)^2; if less of the volume
     change went into the water, 2 % of it, U were 5e-3 larger at T = 0.2 and 6e-3 at 0.5, beside 1e-3 to 4e-3 seen */
  VerifyValue("column_terzaghi", name, exact, exact + 2.0 * fine - coarse, 1.0, 5e-3,
              "waves of 1e-3 q thrice, second order");
}

static void Scheme(PetscBool ns)
{
  const char *const scheme = ns ? "Navier-Stokes" : "Darcy";
  PetscReal         pressure[TIMES][REFINEMENTS], degree[TIMES][REFINEMENTS], h[REFINEMENTS];
  char              name[96], dashpots[256], options[256], all[512];
  Water             w;

  for (int k = 0; k < REFINEMENTS; k++) {
    SchemeOptions(ns, rows_of[k], options, sizeof options);
    Dashpots(rows_of[k], dashpots, sizeof dashpots);
    (void)snprintf(all, sizeof all, "%s %s", dashpots, options);
    Start(&w, "column_terzaghi", rows_of[k], StepsOf(rows_of[k]), all);
    for (int i = 0; i < TIMES; i++) {
      WaterRun(&w, TimeOf(T[i]));
      Compare(&w, T[i], &pressure[i][k], &degree[i][k]);
    }
    h[k] = RadiusOf(rows_of[k]);
    WaterEnd(&w);
  }
  for (int i = 0; i < TIMES; i++) {
    (void)snprintf(name, sizeof name, "p(z) at T = %g, rms over q, %s", (double)T[i], scheme);
    /* the drained row is a row inside the surface, kernels are cut at both ends: first order; waves that run up and down
       the column leave some 1e-3 q, hence the tolerance */
    VerifyOrder("column_terzaghi", name, REFINEMENTS, h, pressure[i], 1.0, 0.3, "ends of first order, waves of 1e-3 q");
    Degrees(scheme, T[i], h, degree[i]);
  }
}

static void Consolidation(void **state)
{
  (void)state;
  Scheme(PETSC_FALSE);
  if (Once()) Scheme(PETSC_TRUE);
}

/* U at T with 25 rows. */
static PetscReal Degree(PetscReal at, PetscReal steps, const char options[])
{
  PetscReal pressure, degree;
  Water     w;

  Start(&w, "column_terzaghi", 25, steps, options);
  WaterRun(&w, TimeOf(at));
  Compare(&w, at, &pressure, &degree);
  WaterEnd(&w);
  return degree + ExactDegree(at);
}

static void TimeStep(void **state)
{
  const char *const incremental = "-permeability 6.5e-9 -coupling_scheme incremental -fluid_every 1";
  const char *const projection  = "-permeability 6.5e-9 -coupling_scheme projection -fluid_every 2";
  const PetscReal   steps = StepsOf(25), limit = Once() ? Degree(0.2, steps, incremental) : 0.0;
  PetscReal         h[3], error[3], U = 0.0, more;

  (void)state;
  if (!Once()) skip();
  for (int k = 0; k < 3; k++) {
    h[k]     = 2.0 * TimeOf(0.1) / (steps * (PetscReal)(2 << k));
    U        = Degree(0.2, steps * (PetscReal)(2 << k), projection);
    error[k] = PetscAbsReal(U - limit);
  }
  /* the discs move for a step before the pressure of its end acts on them, as if k_p were larger by dt_f/(2 (1-n) rho_s):
     by 0.08 of it in the smallest step, by 0.3 in the largest, so that the order is not quite one */
  VerifyOrder("column_terzaghi", "U at T = 0.2 in dt_f, projection, 25 rows", 3, h, error, 1.0, 0.25,
              "terms of second order of dt_f/(2 (1-n) rho_s k_p)");
  more = h[2] / (2.0 * (1.0 - TOUCHING_POROSITY) * 2000.0 * k_p);
  VerifyValue("column_terzaghi", "U at T = 0.2, projection, as if k_p had dt_f/(2 (1-n) rho_s) more",
              Degree(0.2 * (1.0 + more), steps, incremental), U, 0.0, 0.01, "cut kernels where the pressure is steep");
  /* with the force of the old pressure in the meantime that is gone; steps of the water of 2, 5 and 10 steps of the discs */
  for (int k = 0; k < 3; k++) {
    static const char *const every[3] = {"-fluid_every 10", "-fluid_every 5", "-fluid_every 2"};
    char                     options[128], name[96];
    (void)snprintf(options, sizeof options, "-permeability 6.5e-9 -coupling_scheme incremental %s", every[k]);
    (void)snprintf(name, sizeof name, "U at T = 0.2, incremental, %s, against -fluid_every 1", every[k]);
    VerifyValue("column_terzaghi", name, limit, Degree(0.2, steps, options), 0.0, k ? 3e-3 : 8e-3,
                k ? "waves of 1e-3 q" : "waves of 1e-3 q, steps of 1/16 of the wave's way through the column");
  }
}

static void Undrained(void **state)
{
  PetscReal p[MOST_ROWS], h[REFINEMENTS], error[REFINEMENTS], B = 0.0, coarser = 0.0;
  char      dashpots[256], all[512];
  Water     w;

  (void)state;
  for (int k = 0; k < REFINEMENTS; k++) {
    Dashpots(rows_of[k], dashpots, sizeof dashpots);
    (void)snprintf(all, sizeof all, "-permeability 6.5e-9 %s", dashpots);
    Start(&w, "undrained", rows_of[k], StepsOf(rows_of[k]), all);
    WaterRun(&w, TimeOf(0.03));
    WaterRows(&w, "pressure", 1, 0, p, NULL);
    coarser  = B;
    B        = (p[0] - p_top) / q;
    h[k]     = RadiusOf(rows_of[k]);
    error[k] = PetscAbsReal(B - 1.0);
    WaterEnd(&w);
  }
  /* forces of the water on the rows next to the drained one do not add up to q exactly: a share of row over drained
     layer, which is 0.35 H thick; that the bottom is drained is felt by 9e-5 yet */
  VerifyOrder("undrained", "B at the bottom at T = 0.03", REFINEMENTS, h, error, 1.0, 0.3,
              "cut kernels at the drained end");
  VerifyValue("undrained", "B at the bottom at T = 0.03, 49 rows", 1.0, B, 0.0, 0.05,
              "a share of row over drained layer");
  /* twice the spacing has twice that share: what is left is of second order, some (row/layer)^2 = 1/17^2, and the waves */
  VerifyValue("undrained", "B at the bottom, extrapolated from 25 and 49 rows", 1.0, 2.0 * B - coarser, 0.0, 0.01,
              "second order of row over drained layer");
}

/* Water that leaves the layer between a quarter and three quarters of the height from T = 0.2 to 0.4, by its velocity
   relative to the discs, over the way by which the discs shorten that layer. */
static PetscReal Balance(PetscInt rows)
{
  const PetscInt low = rows / 4, high = rows - 1 - rows / 4;
  PetscReal      y[MOST_ROWS], w_y[MOST_ROWS], shorter, passed = 0.0;
  char           dashpots[256], all[512];
  Water          w;

  Dashpots(rows, dashpots, sizeof dashpots);
  (void)snprintf(all, sizeof all, "-permeability %.15g %s", (double)k_p, dashpots);
  Start(&w, "column_terzaghi", rows, StepsOf(rows), all);
  WaterRun(&w, TimeOf(0.2));
  WaterRows(&w, "position", 2, 1, y, NULL);
  shorter = y[high] - y[low];
  while (WaterTime(&w) < TimeOf(0.4) * (1.0 - 1e-9)) {
    const PetscReal before = WaterTime(&w);
    CHECK(PgSimulationStep(w.sim));
    WaterRows(&w, "relative_velocity", 2, 1, w_y, NULL);
    passed += (w_y[high] - w_y[low]) * (WaterTime(&w) - before);
  }
  WaterRows(&w, "position", 2, 1, y, NULL);
  shorter -= y[high] - y[low];
  WaterEnd(&w);
  return passed / shorter;
}

static void MassBalance(void **state)
{
  PetscReal coarse, fine;

  (void)state;
  if (!Once()) skip();
  coarse = Balance(25);
  fine   = Balance(49);
  /* the water's velocity comes from the gradient, its balance from the Laplacian, which is 1.0114 times too large on the
     lattice (theory.md, section 3); the rest is of second order in the spacing. A term n div v that is 2 % off is off by
     1.9e-3 of the balance: half of that, of which waves of the discs and the factor's digits take 5e-4. */
  VerifyValue(
      "column_terzaghi",
      "water that leaves the middle half, T = 0.2 to 0.4, over its shortening, extrapolated from 25 and 49 rows",
      1.0 / 1.0114, (4.0 * fine - coarse) / 3.0, 0.0, 1e-3, "half of what 2 % of n div v make");
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(Consolidation), cmocka_unit_test(MassBalance),
                                          cmocka_unit_test(TimeStep), cmocka_unit_test(Undrained)};
WATER_MAIN(tests)
