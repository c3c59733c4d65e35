/* ranks: 1 2 */
/* Solution error of the pressure equation.

   Physics: lap p = Z, as assembled and solved for the pore pressure (Eqs. 52-55, 58), with Z = lap of the exact p.
   Exact solutions: Dirichlet: p = sin(pi X) sin(pi Y) + linear, with X and Y from 0 to 1 across the discs that are
   free; prescribed on all discs whose kernel is not full. Natural sides: p = cos(pi X) + cos(2 pi Y)/2 +
   cos(pi X) cos(pi Y)/3 in the packing's own box, which has no normal derivative there; nothing prescribed, the mean
   kept, the right-hand side made compatible.
   Error: relative L2 norm against the part of p that is not linear; natural: of p less its mean.
   Expected, with h = 1.25 spacings (k: factor of the Laplacian on quadratic fields, 0.9238, 1.0114, 1.0224 for eta = 0.1,
   0.01, 0):
     lattice, paper      no convergence: p/k is found, so the error tends to |1/k - 1| = 0.0825, 0.0113, 0.0219
     lattice, corrected  2
     disorder, paper     no convergence. The truncation error grows like 1/h (operator_mms), but it is a divergence: the
                         weights are symmetric, and what one disc gains another loses. What stays is an effective
                         conductivity that differs from 1
     disorder, corrected 2: the truncation error is of the order h, but in its leading part random without mean, and the
                         solution averages it over the discs in a neighbourhood: random part h * h, mean part h^2
     natural, paper      1 against p/k: discs of the side have lost up to half of their pairs, so a layer of width h
                         conducts badly along the side; against p itself, again no convergence */
#include "mms.h"

typedef struct {
  const char *name, *options;
  PetscReal   jitter; /* in radii: 0.2 are 0.1 spacings */
  PetscReal   order;  /* 0: none */
  PetscReal   factor; /* k of the lattice, four digits; 0: not known beforehand */
} Case;

enum { LATTICE_PAPER = 0, DISORDER_PAPER = 5, DIRICHLET_CASES = 10 };

#define TIGHT "-pressure_ksp_rtol 1e-10 "

static const Case dirichlet[DIRICHLET_CASES] = {
    {"Dirichlet, lattice, paper, eta 0.1", TIGHT, 0.0, 0, 0.9238},
    {"Dirichlet, lattice, paper, eta 0.01", TIGHT "-sph_laplacian_eta 0.01", 0.0, 0, 1.0114},
    {"Dirichlet, lattice, paper, eta 0", TIGHT "-sph_laplacian_eta 0", 0.0, 0, 1.0224},
    {"Dirichlet, lattice, corrected, eta 0.1", TIGHT "-sph_laplacian corrected", 0.0, 2, 0},
    {"Dirichlet, lattice, corrected, eta 0.01", TIGHT "-sph_laplacian corrected -sph_laplacian_eta 0.01", 0.0, 2, 0},
    {"Dirichlet, disorder, paper, eta 0.1", TIGHT, 0.2, 0, 0},
    {"Dirichlet, disorder, paper, eta 0.01", TIGHT "-sph_laplacian_eta 0.01", 0.2, 0, 0},
    {"Dirichlet, disorder, paper, eta 0", TIGHT "-sph_laplacian_eta 0", 0.2, 0, 0},
    {"Dirichlet, disorder, corrected, eta 0.1", TIGHT "-sph_laplacian corrected", 0.2, 2, 0},
    {"Dirichlet, disorder, corrected, eta 0.01", TIGHT "-sph_laplacian corrected -sph_laplacian_eta 0.01", 0.2, 2, 0},
};

/* 1/k by case: how large the part of p that is not linear comes out, for h -> 0. */
static PetscReal amplitude[DIRICHLET_CASES];

static Ground Make(const Case *c, const Packing *packing)
{
  Ground g;

  GroundCreate(PETSC_COMM_WORLD, GROUND_SPH, c->options, &g);
  CHECK(PgPressureSetReference(g.pressure, 0.0));
  GroundFill(&g, PackingCount(packing), PackingPlace, packing);
  return g;
}

/* Adds the error of one refinement, and to `size` how large the part of p that is not linear came out. */
static void DirichletError(const Case *c, PetscInt columns, Sequence *s, Sequence *size)
{
  /* discs nearer than 5 r to the frame that starts at 2 r have a prescribed pressure: the free ones fill, but for their
     own width, the rest of width 1 */
  const Packing    packing = SquarePacking(columns, (PetscReal)columns / (PetscReal)(columns - 6), c->jitter);
  const PetscReal  r       = packing.radius;
  const Box        box = {{6.0 * r, 5.0 * r}, {1.0, PetscSqrtReal(3.0) * r * (PetscReal)(packing.rows - 1) - 8.0 * r}};
  Ground           g   = Make(c, &packing);
  const PetscInt   owned = GroundOwned(&g);
  const PetscReal *x     = GroundCore(&g, PG_POSITION);
  PetscReal       *p = GroundArray(&g, "pressure"), *fixed = GroundArray(&g, "pressure_fixed");
  PetscReal       *prescribed = GroundArray(&g, "pressure_prescribed"), *Z, sum[3] = {0, 0, 0};
  PgPressureStats  stats;

  CHECK(PetscMalloc1(owned + 1, &Z));
  for (PetscInt a = 0; a < owned; a++) {
    fixed[a]      = PackingDepth(&packing, GroundIds(&g)[a]) < 5.0 + 2.0 * packing.jitter ? 1.0 : 0.0;
    prescribed[a] = HillOnSlope(&box, x + 2 * a);
    Z[a]          = HillLaplacian(&box, x + 2 * a);
    p[a]          = 0.0;
  }
  CHECK(PgPressureUpdate(g.pressure, NULL));
  CHECK(PgPressureSolve(g.pressure, Z, &stats));
  assert_true(stats.residual <= 1e-9 && !stats.singular);
  for (PetscInt a = 0; a < owned; a++) {
    const PetscReal hill = Hill(&box, x + 2 * a), error = p[a] - prescribed[a];
    if (fixed[a] != 0.0) continue;
    sum[0] += error * error;
    sum[1] += hill * hill;
    sum[2] += error * hill;
  }
  for (int i = 0; i < 3; i++) sum[i] = GroundSum(&g, sum[i]);
  SequenceAdd(s, &g, SmoothingLength(&packing), PetscSqrtReal(sum[0] / sum[1]));
  size->error[size->count] = 1.0 + sum[2] / sum[1];
  size->h[size->count++]   = SmoothingLength(&packing);
  CHECK(PetscFree(Z));
  GroundDestroy(&g);
}

static void JudgeDirichlet(const Case *c, const Sequence *s, PetscReal size)
{
  const PetscInt k = s->count - 1;
  char           name[128];

  SequenceLine("pressure_mms", s, c->order, c->order > 0.0 ? "order - 0.2 at least, error < 2e-4" : "order within 0.25",
               "next term of the expansion at these h");
  (void)snprintf(name, sizeof name, "%s: size of p for h to 0", c->name);
  if (c->factor > 0.0)
    PlateauLine("pressure_mms", name, 1.0 / c->factor, size, "4e-4",
                "1/k of the lattice; digits of k, term of order h^2");
  if (c->order > 0.0) {
    /* what the next term of the expansion may do at these h */
    if (!(SequenceOrder(s) >= c->order - 0.2)) fail_msg("%s: order %g", s->name, (double)SequenceOrder(s));
    assert_true(s->error[k] < 2e-4);
    return;
  }
  /* no convergence, neither to p nor away from it; the smallest plateau, 0.003, is still being reached from 0.004 */
  NEAR(SequenceOrder(s), 0.0, 0.25);
  assert_true(PetscAbsReal(size - 1.0) > 1e-3 && s->error[k] > 1e-3);
  if (c->factor > 0.0) {
    /* extrapolated to h = 0: what is in proportion to h is gone; 2 pi^2 h^2 = 1e-3 times 0.08 and as much again from the
       place of the boundary stay, and the last digit of k is worth 5e-5 */
    NEAR(size, 1.0 / c->factor, 4e-4);
    NEAR(SequenceLimit(s), PetscAbsReal(1.0 / c->factor - 1.0), 4e-4);
  } else {
    /* disorder of 0.1 spacings changes k by 1 or 2 % */
    NEAR(size, 1.0 / dirichlet[LATTICE_PAPER + (c - dirichlet) - DISORDER_PAPER].factor, 0.02);
  }
}

static void Dirichlet(void **state)
{
  (void)state;
  TableHead(PETSC_COMM_WORLD);
  for (PetscInt k = 0; k < DIRICHLET_CASES; k++) {
    Sequence s = SequenceStart(dirichlet[k].name), size = SequenceStart(dirichlet[k].name);

    for (PetscInt columns = 25; columns <= 200; columns *= 2) DirichletError(&dirichlet[k], columns, &s, &size);
    amplitude[k] = SequenceLimit(&size);
    JudgeDirichlet(&dirichlet[k], &s, amplitude[k]);
  }
}

/* ---- natural sides ---- */

static PetscReal Cosines(const PetscReal low[2], const PetscReal length[2], const PetscReal x[2], PetscReal *laplacian)
{
  const PetscReal kx = PETSC_PI / length[0], ky = PETSC_PI / length[1], X = kx * (x[0] - low[0]),
                  Y = ky * (x[1] - low[1]);
  const PetscReal a = PetscCosReal(X), b = 0.5 * PetscCosReal(2.0 * Y), d = PetscCosReal(X) * PetscCosReal(Y) / 3.0;

  *laplacian = -kx * kx * a - 4.0 * ky * ky * b - (kx * kx + ky * ky) * d;
  return a + b + d;
}

/* k is 1/`size`; adds the errors against p and against p/k, and the part of the right-hand side that was removed. */
static void NaturalError(const Case *c, PetscInt columns, PetscReal size, Sequence s[3])
{
  const Packing   packing = SquarePacking(columns, 1.0, c->jitter);
  const PetscReal r = packing.radius, row = PetscSqrtReal(3.0) * r;
  /* rows end in turn at their cells' sides and half a cell short of them: half of that in the mean */
  const PetscReal  low[2]    = {0.5 * r, r - 0.5 * row};
  const PetscReal  length[2] = {2.0 * r * (PetscReal)packing.columns - r, row * (PetscReal)packing.rows};
  Ground           g         = Make(c, &packing);
  const PetscInt   owned     = GroundOwned(&g);
  const PetscReal *x         = GroundCore(&g, PG_POSITION);
  PetscReal       *p = GroundArray(&g, "pressure"), *Z, *exact, mean[2] = {0, 0}, sum[3] = {0, 0, 0};
  PgPressureStats  stats;

  CHECK(PetscMalloc2(owned + 1, &Z, owned + 1, &exact));
  for (PetscInt a = 0; a < owned; a++) {
    exact[a] = Cosines(low, length, x + 2 * a, &Z[a]);
    p[a]     = 3.0 + 0.01 * Noise(GroundIds(&g)[a], 6); /* the mean to be kept */
    mean[0] += exact[a] / (PetscReal)g.count;
    mean[1] += p[a] / (PetscReal)g.count;
  }
  for (int i = 0; i < 2; i++) mean[i] = GroundSum(&g, mean[i]);
  CHECK(PgPressureUpdate(g.pressure, NULL));
  CHECK(PgPressureSolve(g.pressure, Z, &stats));
  assert_true(stats.residual <= 1e-9 && stats.singular);
  sum[0] = 0.0;
  for (PetscInt a = 0; a < owned; a++) sum[0] += p[a] / (PetscReal)g.count;
  /* sums of up to 1e4 numbers near 3 */
  NEAR(GroundSum(&g, sum[0]), mean[1], 1e-12);
  sum[0] = 0.0;
  for (PetscInt a = 0; a < owned; a++) {
    const PetscReal e = exact[a] - mean[0], q = p[a] - mean[1];
    sum[0] += PetscSqr(q - e);
    sum[1] += PetscSqr(q - e * size);
    sum[2] += PetscSqr(e);
  }
  for (int i = 0; i < 3; i++) sum[i] = GroundSum(&g, sum[i]);
  SequenceAdd(&s[0], &g, SmoothingLength(&packing), PetscSqrtReal(sum[0] / sum[2]));
  SequenceAdd(&s[1], &g, SmoothingLength(&packing), PetscSqrtReal(sum[1] / sum[2]));
  SequenceAdd(&s[2], &g, SmoothingLength(&packing), stats.removed);
  CHECK(PetscFree2(Z, exact));
  GroundDestroy(&g);
}

/* The paper's operator only: the corrected one has no symmetric matrix, and a singular system is refused. */
static void Natural(void **state)
{
  static const char *const names[] = {"natural, lattice, paper, eta 0.1",
                                      "natural, lattice, paper, eta 0.01",
                                      "natural, lattice, paper, eta 0",
                                      NULL,
                                      NULL,
                                      "natural, disorder, paper, eta 0.1",
                                      "natural, disorder, paper, eta 0.01",
                                      "natural, disorder, paper, eta 0"};

  (void)state;
  TableHead(PETSC_COMM_WORLD);
  for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
    char     name[2][96];
    Sequence s[3];

    if (!names[k]) continue;
    (void)snprintf(name[0], sizeof name[0], "%s, against p/k", names[k]);
    (void)snprintf(name[1], sizeof name[1], "%s, removed from b", names[k]);
    s[0] = SequenceStart(names[k]);
    s[1] = SequenceStart(name[0]);
    s[2] = SequenceStart(name[1]);
    for (PetscInt columns = 25; columns <= 200; columns *= 2) NaturalError(&dirichlet[k], columns, amplitude[k], s);
    SequenceLine("pressure_mms", &s[1], 1.0, "order within 0.2", "part of h^2 from the corners");
    /* 1, and a part of h^2 from the corners */
    NEAR(SequenceOrder(&s[1]), 1.0, 0.2);
    /* against p itself the error stays where |1/k - 1| = 0.08 or 0.09; the other plateaus are hidden below the error in
       proportion to h */
    if (amplitude[k] > 1.05) NEAR(SequenceOrder(&s[0]), 0.0, 0.15);
    /* the sum of Z dV vanishes but for the ragged ends of the rows and the disorder of the places */
    assert_true(s[2].error[s[2].count - 1] > 0.0 && s[2].error[s[2].count - 1] < 2e-4);
  }
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(Dirichlet), cmocka_unit_test(Natural)};

GROUND_MAIN(tests, PETSC_FALSE)
