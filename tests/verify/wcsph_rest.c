/* ranks: 1 timeout: 300 */
/* The weakly compressible liquid under gravity: pressure of a column and of a tank at rest, and why a column that starts
   without pressure is far from it for a long time: it rings, and what damps that is viscosity and the diffusion of
   density alone. */
#include "liquid_run.h"

#define COMMON "-wcsph_columns 12 -wcsph_sound_speed 20 "

static void Column(void **state)
{
  PetscReal h[3], l2[3], most[3];

  (void)state;
  for (int k = 0; k < 3; k++) {
    char options[256];
    (void)snprintf(options, sizeof options, COMMON "-wcsph_cells %d -end_time 2", 10 << k);
    h[k] = 1.0 / (PetscReal)(10 << k);
    LiquidErrors("wcsph_hydrostatic", options, &l2[k], &most[k]);
  }
  VerifyRange("wcsph_hydrostatic", "column of 20 particles after 20 periods of sound: largest error of p over rho g H",
              0.0, 1e-2, most[1], "that of the topmost layer, a fifth of rho g dx");
  VerifyRange("wcsph_hydrostatic", "column of 20 particles: error of p, L2", 0.0, 1e-2, l2[1], "measured 3.5e-3");
  VerifyOrder("wcsph_hydrostatic", "largest error of p", 3, h, most, 1.0, 0.2, "one layer of particles at the surface");
  VerifyOrder("wcsph_hydrostatic", "error of p, L2", 3, h, l2, 1.5, 0.15, "the same, in the mean of the squares");
}

static void Choices(void **state)
{
  static const char *const what[]    = {"Tait", "walls adjoint", "walls extrapolated", "walls own", "no diffusion"};
  static const char *const options[] = {"-wcsph_state tait", "-wcsph_wall adjoint", "-wcsph_wall extrapolated",
                                        "-wcsph_wall own", "-wcsph_diffusion 0"};

  (void)state;
  for (int k = 0; k < 5; k++) {
    char      all[256], quantity[128];
    PetscReal l2, most;
    (void)snprintf(all, sizeof all, COMMON "-wcsph_cells 20 -end_time 0.5 %s", options[k]);
    (void)snprintf(quantity, sizeof quantity, "column of 20 particles, %s: error of p, L2", what[k]);
    LiquidErrors("wcsph_hydrostatic", all, &l2, &most);
    VerifyRange("wcsph_hydrostatic", quantity, 0.0, 1e-2, l2, "0.34 to 0.5 %, most of it at the surface");
  }
}

static void Tank(void **state)
{
  PetscReal l2, most;

  (void)state;
  LiquidErrors("wcsph_hydrostatic",
               "-wcsph_columns 20 -wcsph_sound_speed 20 -wcsph_cells 20 -wcsph_hydrostatic_tank true -end_time 2", &l2,
               &most);
  VerifyRange("wcsph_hydrostatic", "tank of 20 x 20 particles: error of p, L2", 0.0, 1e-2, l2, "measured 4e-3");
  VerifyRange("wcsph_hydrostatic", "tank of 20 x 20 particles: largest error of p over rho g H", 0.0, 1.5e-2, most,
              "measured 1.1e-2, where the surface meets the walls");
}

/* Largest L2 error in one period around the n-th. */
static PetscReal Amplitude(LiquidRun *run, PetscReal period, PetscReal n)
{
  PetscReal largest = 0.0, t = 0.0;

  LiquidStepTo(run, (n - 0.5) * period);
  while (t < (n + 0.5) * period) {
    PetscReal l2, most;
    CHECK(PgWcsphStep(run->wcsph, run->dt));
    CHECK(PgWcsphGetTime(run->wcsph, NULL, &t));
    CHECK(PgLiquidGetErrors(run->liquid, &l2, &most));
    largest = PetscMax(largest, l2);
  }
  return largest;
}

/* A column that starts without pressure rings with the period 4 H/c_0. exp(-rate t) is left of it, rate = (nu + delta h
   c_0)(pi/2H)^2/2: for plane waves of rho and v, diffusion of either adds half its rate. */
static void Ringing(void **state)
{
  static const struct {
    const char *what, *options;
    PetscReal   nu, delta;
  } run[]           = {{"mu = 200 Pa s", "-wcsph_viscosity 200 -wcsph_diffusion 0", 0.2, 0.0},
                       {"mu = 20 Pa s", "-wcsph_viscosity 20 -wcsph_diffusion 0", 0.02, 0.0},
                       {"mu = 20 Pa s, delta = 0.1", "-wcsph_viscosity 20 -wcsph_diffusion 0.1", 0.02, 0.1}};
  const PetscReal c = 20.0, period = 4.0 / c, dx = 0.05;

  (void)state;
  for (int k = 0; k < 3; k++) {
    const PetscReal rate = (run[k].nu + run[k].delta * 1.2 * dx * c) * PetscSqr(0.5 * PETSC_PI) / 2.0;
    PetscReal       early, late;
    LiquidRun       r;
    char            options[256], quantity[160];
    (void)snprintf(options, sizeof options, COMMON "-wcsph_cells 20 -wcsph_hydrostatic_from_rest true -end_time 4 %s",
                   run[k].options);
    LiquidStart(&r, "wcsph_hydrostatic", options);
    early = Amplitude(&r, period, 4.0);
    late  = Amplitude(&r, period, 14.0);
    (void)snprintf(quantity, sizeof quantity, "from rest without pressure, %s: rate of decay of the error [1/s]",
                   run[k].what);
    VerifyValue("wcsph_hydrostatic", quantity, rate, PetscLogReal(early / late) / (10.0 * period), 0.0, 0.15,
                "of the first mode; what is left of the others, and the surface");
    VerifyReport("wcsph_hydrostatic",
                 k == 0   ? "the same: error of p after 8 s by that rate"
                 : k == 1 ? "mu = 20 Pa s: error of p after 8 s by that rate"
                          : "mu = 20 Pa s, delta = 0.1: error of p after 8 s by that rate",
                 PetscExpReal(-8.0 * rate), "does not depend on the number of particles");
    CHECK(PgLiquidDestroy(&r.liquid));
  }
}

static void DampedStart(void **state)
{
  PetscReal l2, most;

  (void)state;
  LiquidErrors("wcsph_hydrostatic",
               "-wcsph_columns 12 -wcsph_cells 20 -wcsph_hydrostatic_from_rest true -wcsph_damping 60 "
               "-wcsph_damping_end 0.3 -end_time 0.6",
               &l2, &most);
  VerifyRange("wcsph_hydrostatic", "from rest without pressure, damped until t = 0.3 s: error of p, L2", 0.0, 1e-2, l2,
              "measured 5e-3; the column is shorter by rho g H/(2 K) = 0.3 %");
}

/* Mean height of the liquid. */
static PetscReal MeanHeight(const LiquidRun *run)
{
  PgParticles particles;
  PgField     field;
  PetscReal  *x, *kind, sum = 0.0;
  PetscInt    owned, count = 0;

  CHECK(PgWcsphGetParticles(run->wcsph, &particles));
  CHECK(PgParticlesFindField(particles, "kind", &field));
  CHECK(PgParticlesGetArray(particles, field, &kind));
  CHECK(PgParticlesGetArray(particles, PG_POSITION, &x));
  CHECK(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  for (PetscInt a = 0; a < owned; a++) {
    if (kind[a] != (PetscReal)PG_WCSPH_FLUID) continue;
    sum += x[2 * a + 1];
    count++;
  }
  return sum / (PetscReal)count;
}

/* Error of p of a column that starts off its lattice and is damped until 1.5 s; *shorter: by what part of its height. */
static PetscReal Settle(int cells, double jitter, PetscReal *shorter)
{
  char      options[256];
  LiquidRun run;
  PetscReal l2, most;

  (void)snprintf(options, sizeof options,
                 COMMON "-wcsph_damping 20 -wcsph_damping_end 1.5 -end_time 2 -wcsph_cells %d -wcsph_jitter %g", cells,
                 jitter);
  LiquidStart(&run, "wcsph_hydrostatic", options);
  *shorter = MeanHeight(&run);
  LiquidStepTo(&run, run.end);
  *shorter = 2.0 * (*shorter - MeanHeight(&run));
  CHECK(PgLiquidGetErrors(run.liquid, &l2, &most));
  CHECK(PgLiquidDestroy(&run.liquid));
  return l2;
}

/* Particles off their lattice put themselves in order. The sum of V W is larger by (T74) in disorder, and takes the density
   with it: the column falls and rings as one that starts without pressure. Damped while it does so it comes to rest. */
static void Disorder(void **state)
{
  /* W is sigma (66 - 60 q^2 + ...)/h^2, its Laplacian at 0 -240 sigma/h^4; places in a square have a variance of j^2/3 */
  const PetscReal epsilon = 0.01 / 3.0 * 240.0 * 7.0 / (478.0 * PETSC_PI) / PetscPowReal(1.2, 4.0);
  PetscReal       l2, most, shorter;

  (void)state;
  LiquidErrors("wcsph_hydrostatic", COMMON "-wcsph_cells 20 -wcsph_jitter 0.1 -end_time 2", &l2, &most);
  VerifyReport("wcsph_hydrostatic",
               "column of 20 particles, displaced by up to 0.1 dx at the start: error of p after 2 s, L2", l2,
               "it settles and rings");
  l2 = Settle(20, 0.1, &shorter);
  VerifyRange("wcsph_hydrostatic", "column of 20 particles, displaced by up to 0.1 dx and damped: error of p, L2", 0.0,
              1e-2, l2, "measured 8.5e-3, with other seeds 6.4e-3 to 9.7e-3");
  l2 = Settle(40, 0.1, &shorter);
  VerifyRange("wcsph_hydrostatic", "column of 40 particles, displaced by up to 0.1 dx and damped: error of p, L2", 0.0,
              6e-3, l2, "measured 4.9e-3");
  VerifyValue("wcsph_hydrostatic", "column of 40 particles, displaced by up to 0.1 dx and damped: loss of height",
              epsilon, shorter, 0.0, 0.15, "T74; a tenth of the disorder is left");
  l2 = Settle(20, 0.3, &shorter);
  VerifyReport("wcsph_hydrostatic", "column of 20 particles, displaced by up to 0.3 dx and damped: error of p, L2", l2,
               "1.6 % are T74, the rest is what is left of the disorder");
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(Column),      cmocka_unit_test(Choices),
                                          cmocka_unit_test(Tank),        cmocka_unit_test(Ringing),
                                          cmocka_unit_test(DampedStart), cmocka_unit_test(Disorder)};

int main(int argc, char *argv[])
{
  int failed;

  if (PgInitialize(&argc, &argv, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
