/* ranks: 1 2 */
/* Consolidation against Terzaghi's series (case column_terzaghi) in both schemes, with orders in the spacing and in the
   step; undrained response (case undrained). */
#include "water.h"

enum { COLUMNS = 8, REFINEMENTS = 3 };
static const PetscInt  rows_of[REFINEMENTS] = {13, 25, 49};
static const PetscReal q = 1e4, p_top = 1e5;

/* Ten times softer than the paper's, water a hundred times slower: consolidation takes 80 times as long as a wave. */
static const PetscReal k_n = 6e7, k_s = 4e7, k_p = 6.5e-9;

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

/* `steps`: steps of the discs until T = 0.1. Dashpots, a tenth of the critical ones, take away waves of the discs of one
   or two rows, which the water does not feel; they relax in 1e-5 s, consolidation takes 0.07 s. */
static void Start(Water *w, const char name[], PetscInt rows, PetscReal steps, const char options[])
{
  const PetscReal r = RadiusOf(rows);

  WaterStart(
      w, COLUMNS, rows,
      "-case %s -column_columns %d -column_rows %d -column_radius %.15g -column_load %.15g -dem_k_n %.15g -dem_k_s "
      "%.15g -dem_k_r 200 -dem_k_theta 70 -dem_c_n %.15g -dem_c_s %.15g -dt %.17g -sph_gradient corrected "
      "-sph_laplacian_eta 0.01" WATER_SOLVER " %s",
      name, (int)COLUMNS, (int)rows, (double)r, (double)q, (double)k_n, (double)k_s, 1.2e5 * (double)r, 8e4 * (double)r,
      (double)(TimeOf(0.1) / steps), options);
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

/* The viscosity that gives k_p by Eq. 66, or Darcy's law with k_p itself. */
static void SchemeOptions(PetscBool ns, PetscInt rows, char options[], size_t size)
{
  const PetscReal n = TOUCHING_POROSITY, d = 2.0 * RadiusOf(rows);

  if (ns)
    (void)snprintf(options, size, "-fluid ns -ns_continuity averaged -ns_drag linear -fluid_viscosity %.15g",
                   (double)(n * n * n * d * d / (150.0 * (1.0 - n) * (1.0 - n) * k_p)));
  else
    (void)snprintf(options, size, "-fluid darcy -permeability %.15g", (double)k_p);
}

static void Scheme(PetscBool ns)
{
  const char *const scheme = ns ? "Navier-Stokes" : "Darcy";
  PetscReal         pressure[TIMES][REFINEMENTS], degree[TIMES][REFINEMENTS], h[REFINEMENTS];
  char              name[96], options[256], all[512];
  Water             w;

  for (int k = 0; k < REFINEMENTS; k++) {
    SchemeOptions(ns, rows_of[k], options, sizeof options);
    (void)snprintf(all, sizeof all, "-coupling_scheme incremental %s", options);
    Start(&w, "column_terzaghi", rows_of[k], StepsOf(rows_of[k]), all);
    for (int i = 0; i < TIMES; i++) {
      WaterRun(&w, TimeOf(T[i]));
      Compare(&w, T[i], &pressure[i][k], &degree[i][k]);
      degree[i][k] = PetscAbsReal(degree[i][k]);
    }
    h[k] = RadiusOf(rows_of[k]);
    WaterEnd(&w);
  }
  for (int i = 0; i < TIMES; i++) {
    (void)snprintf(name, sizeof name, "p(z) at T = %g, rms over q, %s", (double)T[i], scheme);
    /* the drained row is a row inside the surface, kernels are cut at both ends: first order; waves that run up and down
       the column leave some 1e-3 q, hence the tolerance */
    VerifyOrder("column_terzaghi", name, REFINEMENTS, h, pressure[i], 1.0, 0.3, "ends of first order, waves of 1e-3 q");
    (void)snprintf(name, sizeof name, "U at T = %g, %s", (double)T[i], scheme);
    if (i > 0)
      VerifyOrder("column_terzaghi", name, REFINEMENTS, h, degree[i], 1.0, 0.3, "ends of first order, waves of 1e-3 q");
    else /* two errors of opposite sign at the drained end: no clean order, but small */
      VerifyValue("column_terzaghi", name, ExactDegree(T[i]), ExactDegree(T[i]) + degree[i][REFINEMENTS - 1], 1.0, 0.02,
                  "one row of 48");
  }
}

static void Consolidation(void **state)
{
  PetscMPIInt ranks;

  (void)state;
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  Scheme(PETSC_FALSE);
  if (ranks == 1) Scheme(PETSC_TRUE); /* on two ranks it would be the same again */
}

/* U at T = 0.2 with 25 rows. */
static PetscReal Degree(PetscReal steps, const char options[])
{
  PetscReal pressure, degree;
  Water     w;

  Start(&w, "column_terzaghi", 25, steps, options);
  WaterRun(&w, TimeOf(0.2));
  Compare(&w, 0.2, &pressure, &degree);
  WaterEnd(&w);
  return degree + ExactDegree(0.2);
}

static void TimeStep(void **state)
{
  const PetscReal steps = StepsOf(25), limit = Degree(4.0 * steps, "-permeability 6.5e-9 -coupling_scheme incremental");
  PetscReal       h[3], error[3];

  (void)state;
  /* the discs move for a step before the pressure of its end acts on them: as if k_p were larger by
     dt_f/(2 (1-n) rho_s), which is 0.3 k_p here with the largest step */
  for (int k = 0; k < 3; k++) {
    h[k]     = 1.0 / (PetscReal)(1 << k);
    error[k] = PetscAbsReal(Degree(steps * (PetscReal)(2 << k), "-permeability 6.5e-9 -coupling_scheme projection") -
                            limit);
  }
  VerifyOrder("column_terzaghi", "U at T = 0.2 in dt, projection, 25 rows", 3, h, error, 1.0, 0.25,
              "k_p + dt/(2 (1-n) rho_s): terms of second order");
  /* with the force of the old pressure in the meantime that is gone; steps of the water of 1, 2 and 4 steps of the discs */
  for (int k = 0; k < 3; k++) {
    static const char *const every[3] = {"-fluid_every 4", "-fluid_every 2", "-fluid_every 1"};
    char                     options[128], name[96];
    (void)snprintf(options, sizeof options, "-permeability 6.5e-9 -coupling_scheme incremental %s", every[k]);
    (void)snprintf(name, sizeof name, "U at T = 0.2, incremental, %s, against a quarter of the step", every[k]);
    VerifyValue("column_terzaghi", name, limit, Degree(steps, options), 0.0, 3e-3,
                "second order in dt; waves of 1e-3 q");
  }
}

static void Undrained(void **state)
{
  PetscReal p[MOST_ROWS], h[REFINEMENTS], error[REFINEMENTS], B = 0.0;
  Water     w;

  (void)state;
  for (int k = 0; k < REFINEMENTS; k++) {
    Start(&w, "undrained", rows_of[k], StepsOf(rows_of[k]), "-permeability 6.5e-9 -coupling_scheme incremental");
    WaterRun(&w, TimeOf(0.01));
    WaterRows(&w, "pressure", 1, 0, p, NULL);
    B        = (p[0] - p_top) / q;
    h[k]     = RadiusOf(rows_of[k]);
    error[k] = PetscAbsReal(B - 1.0);
    WaterEnd(&w);
  }
  /* forces of the water on the rows next to the drained one do not add up to q exactly: a share of row over drained
     layer, which is 0.2 H thick */
  VerifyOrder("undrained", "B at the bottom at T = 0.01", REFINEMENTS, h, error, 1.0, 0.3,
              "cut kernels at the drained end");
  VerifyValue("undrained", "B at the bottom at T = 0.01, 49 rows", 1.0, B, 0.0, 0.05,
              "a share of row over drained layer");
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(Consolidation), cmocka_unit_test(TimeStep),
                                          cmocka_unit_test(Undrained)};
WATER_MAIN(tests)
