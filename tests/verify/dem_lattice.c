/* ranks: 1 2 */
/* Case lattice_modulus: elastic moduli of the hexagonal lattice, and the initial slope of the panel; see
   src/cases/lattice_modulus.c. */
#include "dem_run.h"

enum { LEVELS = 3, MOST = 3000 };
static const PetscReal r = 5e-3, k_n = 6e8, k_s = 4e8;

typedef struct {
  PetscReal slope;   /* dF/d(delta) [N/m per m] */
  PetscReal lateral; /* lateral stress over vertical strain [Pa], mean of the discs not on plates */
} Answer;

static Answer Compress(const char sides[], PetscInt columns, PetscInt rows, PetscReal strain, const char more[])
{
  const PetscReal  height = SQRT3 * r * (PetscReal)(rows - 1);
  const PetscInt   first = columns * 2, last = columns * (rows - 2); /* periodic: without the two rows at each plate */
  static PetscReal stress[4 * MOST];
  PetscReal        load, sum = 0;
  Run              run;

  RunStart(&run,
           "-case lattice_modulus -fluid none -lattice_sides %s -lattice_columns %d -lattice_rows %d -lattice_radius "
           "%.17g -lattice_rate 1e-2 -lattice_strain %.17g -dt_safety 0.2 %s",
           sides, (int)columns, (int)rows, (double)r, (double)strain, more);
  RunUntil(&run, strain / 1e-2);
  CHECK(PgDemGetLoad(run.dem, 1, &load, NULL));
  if (!strcmp(sides, "periodic")) {
    assert_true(columns * rows <= MOST);
    CHECK(PgDemComputeObservables(run.dem));
    RunGet(&run, "stress", 4, columns * rows, stress);
    /* the area of the disc is that of its cell here, 2 sqrt(3) r^2, not pi r^2 */
    for (PetscInt k = first; k < last; k++) sum -= stress[4 * k] * PETSC_PI / (2 * SQRT3) / (PetscReal)(last - first);
  }
  strain = RunTime(&run) * 1e-2;
  RunEnd(&run);
  return (Answer){load / (strain * height), sum / strain};
}

/* Without lateral strain: C11 and C12, exact but for the change of geometry with strain. */
static void Constrained(void **state)
{
  const PetscReal C11 = SQRT3 / 4 * (3 * k_n + k_s), C12 = SQRT3 / 4 * (k_n - k_s), E = C11 - C12 * C12 / C11;
  PetscReal       h[LEVELS], e11[LEVELS], e12[LEVELS], c11 = 0, c12 = 0;

  (void)state;
  for (PetscInt k = 0; k < LEVELS; k++) {
    const PetscReal strain = 4e-4 / (PetscReal)(1 << k);
    const Answer    a      = Compress("periodic", 8, 17, strain, "");

    h[k]   = strain;
    c11    = a.slope * SQRT3 * r * 16 / (2 * r * 8);
    c12    = a.lateral;
    e11[k] = PetscAbsReal(c11 / C11 - 1);
    e12[k] = PetscAbsReal(c12 / C12 - 1);
  }
  /* strain changes the directions of the contacts: what is left falls with it */
  VerifyValue("lattice_modulus", "C11 [Pa], periodic, strain 1e-4", C11, c11, 0, 2e-5, "geometry: 0.1 of strain 1e-4");
  VerifyOrder("lattice_modulus", "C11 against strain", LEVELS, h, e11, 1, 0.05, "geometry");
  /* the difference of two large parts, 3 k_n and 3 k_s: an error of each is 5 times larger in it */
  VerifyValue("lattice_modulus", "C12 [Pa], periodic, strain 1e-4", C12, c12, 0, 3e-4, "geometry: 2.4 of strain 1e-4");
  VerifyOrder("lattice_modulus", "C12 against strain", LEVELS, h, e12, 1, 0.05, "geometry");
  VerifyValue("lattice_modulus", "E = C11 - C12^2/C11 [Pa]", E, c11 - c12 * c12 / c11, 0, 2e-5,
              "geometry: 0.1 of strain 1e-4");
}

/* The panel with free sides: contacts along the rows open. */
static void FreeSides(void **state)
{
  const PetscReal E       = ((9 * k_n + 3 * k_s) - 9 * (k_n - k_s) * (k_n - k_s) / (k_n + 3 * k_s)) / (4 * SQRT3);
  const PetscReal nominal = 9.447e8 * 0.25 / 0.443, opened = E * 0.25 / (r * (2 + SQRT3 * 50)),
                  mine = E * 2 * r * 24 / (SQRT3 * r * 50);
  PetscReal h[LEVELS], off[LEVELS];
  Answer    a = {0, 0}, slips;

  (void)state;
  for (PetscInt k = 0; k < LEVELS; k++) {
    const PetscInt  W     = 6 << k;
    const PetscReal width = 2 * r * (PetscReal)W, height = r * (2 + SQRT3 * 2 * (PetscReal)W);

    a      = Compress("free", W, 2 * W + 1, 1e-5, "");
    h[k]   = 1 / (PetscReal)W;
    off[k] = PetscAbsReal(a.slope * height / width / E - 1);
  }
  VerifyOrder("lattice_modulus", "free sides: E' from nominal width and height, in 1/W", LEVELS, h, off, 1, 0.05,
              "edges: widths W - 1 and W, heights with and without a diameter");
  a = Compress("free", 25, 51, 1e-5, "");
  /* geometry at strain 1e-5 */
  VerifyValue("lattice_modulus", "panel, mu_s = 1: slope E' 2r (W-1)/H' [N/m2]", mine, a.slope, 0, 3e-5,
              "geometry at strain 1e-5");
  /* 1 - 1/W times 1 + 2r/H': -4 % + 2.3 % */
  VerifyValue("lattice_modulus", "panel, mu_s = 1: slope against E' W/H [N/m2]", opened, a.slope, 0, 0.02,
              "edges, -1/W + 2r/H' = -1.7 %");
  VerifyValue("lattice_modulus", "panel, mu_s = 1: slope against E W/H of closed rows [N/m2]", nominal, a.slope, 0,
              0.05, "rows open, -2.2 %, and edges, -1.7 %");
  slips = Compress("free", 25, 51, 1e-5, "-dem_mu_s 0.5");
  /* the contact forces of the elastic solution are 30 degrees off their normals: mu_s = 0.5 slips from the start */
  VerifyRange("lattice_modulus", "panel, mu_s = 0.5: slope over that of mu_s = 1", 0.3, 0.97, slips.slope / a.slope,
              "mu_s < tan(30): every contact slips from the start, only inertia holds the sides");
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(Constrained), cmocka_unit_test(FreeSides)};
RUN_MAIN(tests)
