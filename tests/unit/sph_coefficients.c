/* ranks: 1 2 4 */
/* Pair coefficients: values, symmetries, and the same bits on any number of ranks. */
#include "ground.h"

static const Packing lattice  = {11, 13, 5e-3, 0.0, 0.0};
static const Packing disorder = {9, 12, 0.37, 0.25, 0.3};

/* Areas that are no constant where the radii are none. */
static void Place(const void *context, PetscInt id, Disc *disc)
{
  PackingPlace(context, id, disc);
  if (((const Packing *)context)->spread > 0.0) disc->volume *= 1.0 + 0.3 * Noise(id, 5);
}

static Ground Make(MPI_Comm comm, const Packing *packing, const char options[])
{
  Ground g;

  GroundCreate(comm, GROUND_SPH, options, &g);
  GroundFill(&g, PackingCount(packing), Place, packing);
  return g;
}

/* Dense copies by permanent id, complete on every rank: what the rows hold for the pair (a, b). */
typedef struct {
  PetscInt   n;
  PetscReal *gradient_x, *gradient_y, *laplacian, *weight; /* [a*n + b] */
  PetscReal *sum, *x, *r, *volume;
} Dense;

static Dense Collect(Ground *g)
{
  const PetscInt   *id = GroundIds(g), owned = GroundOwned(g), n = g->count;
  PgSphCoefficients c;
  Dense             d = {.n = n};

  CHECK(PgSphGetCoefficients(g->sph, &c));
  CHECK(PetscCalloc4(n * n, &d.gradient_x, n * n, &d.gradient_y, n * n, &d.laplacian, n * n, &d.weight));
  for (PetscInt a = 0; a < owned; a++) {
    for (PetscInt k = c.ptr[a]; k < c.ptr[a + 1]; k++) {
      const PetscInt at = id[a] * n + id[c.col[k]];
      d.gradient_x[at]  = c.gradient[2 * k];
      d.gradient_y[at]  = c.gradient[2 * k + 1];
      d.laplacian[at]   = c.laplacian[k];
      d.weight[at]      = c.weight[k];
    }
  }
  for (int i = 0; i < 4; i++) {
    PetscReal *array[4] = {d.gradient_x, d.gradient_y, d.laplacian, d.weight};
    MPI_Allreduce(MPI_IN_PLACE, array[i], (int)(n * n), MPIU_REAL, MPI_SUM, g->comm);
  }
  d.sum    = GroundGather(g, c.kernel_sum, 1);
  d.x      = GroundGather(g, GroundCore(g, PG_POSITION), 2);
  d.r      = GroundGather(g, GroundCore(g, PG_RADIUS), 1);
  d.volume = GroundGatherField(g, "volume", 1);
  return d;
}

static void Release(Dense *d)
{
  CHECK(PetscFree4(d->gradient_x, d->gradient_y, d->laplacian, d->weight));
  CHECK(PetscFree(d->sum));
  CHECK(PetscFree(d->x));
  CHECK(PetscFree(d->r));
  CHECK(PetscFree(d->volume));
}

/* Eqs. 52, 60, 63 once more, written down independently. */
static PetscReal W(PetscReal q)
{
  const PetscReal s = 10.0 / (7.0 * PETSC_PI);
  if (q < 1.0) return s * (1.0 - 1.5 * q * q + 0.75 * q * q * q);
  return q < 2.0 ? 0.25 * s * PetscPowReal(2.0 - q, 3) : 0.0;
}
static PetscReal DW(PetscReal q)
{
  const PetscReal s = 10.0 / (7.0 * PETSC_PI);
  if (q < 1.0) return s * (-3.0 * q + 2.25 * q * q);
  return q < 2.0 ? -0.75 * s * PetscPowReal(2.0 - q, 2) : 0.0;
}

/* Every pair against the formulas, with unequal radii, areas, and neither default h/r nor default eta. */
static void Formulas(void **state)
{
  const PetscReal smoothing = 2.2, eta = 0.04;
  Ground          g     = Make(PETSC_COMM_WORLD, &disorder, "-sph_smoothing 2.2 -sph_laplacian_eta 0.04");
  Dense           d     = Collect(&g);
  PetscInt        pairs = 0;

  (void)state;
  for (PetscInt a = 0; a < d.n; a++) {
    const PetscReal own = smoothing * d.r[a];
    PetscReal       sum = W(0.0) / (own * own) * d.volume[a];

    for (PetscInt b = 0; b < d.n; b++) {
      const PetscInt  at = a * d.n + b;
      const PetscReal dx = d.x[2 * a] - d.x[2 * b], dy = d.x[2 * a + 1] - d.x[2 * b + 1], dV = d.volume[b];
      const PetscReal r = PetscSqrtReal(dx * dx + dy * dy), h = 0.5 * smoothing * (d.r[a] + d.r[b]), q = r / h;
      const PetscReal slope = DW(q) / (h * h * h) * dV;

      if (a == b) continue;
      /* a dozen roundings; beside them, near the end of the support, the cancellation in 2 - q */
      NEAR(d.weight[at], W(q) / (h * h) * dV, 1e-14 * W(0.0) / (h * h) * dV);
      NEAR(d.gradient_x[at], slope * dx / r, 1e-14 / (h * h * h) * dV);
      NEAR(d.gradient_y[at], slope * dy / r, 1e-14 / (h * h * h) * dV);
      NEAR(d.laplacian[at], 2.0 * slope * r / (r * r + eta * h * h), 2e-14 / (h * h * h * r) * dV);
      assert_true(d.laplacian[at] <= 0.0);
      sum += W(q) / (h * h) * dV;
      pairs += q < 2.0;
    }
    NEAR(d.sum[a], sum, 1e-14 * 20.0);
  }
  assert_true(pairs > 7 * d.n);
  Release(&d);
  GroundDestroy(&g);
}

/* Anchors: sum W dV = 1.0051 inside the lattice with h = 1.25 spacings, where the neighbours are three rings of 6, and
   0.643 at the end of a long row, where 3, 4 and 3 of them remain. */
static void KernelSumOfTheLattice(void **state)
{
  Ground            g  = Make(PETSC_COMM_WORLD, &lattice, "");
  const PetscInt   *id = GroundIds(&g), owned = GroundOwned(&g);
  const PetscReal   ring[3] = {1.0, PetscSqrtReal(3.0), 2.0}, scale = PetscSqrtReal(3.0) / 2.0 / (1.25 * 1.25);
  PetscReal         expected = W(0.0), end = W(0.0);
  PetscInt          inside = 0, ends = 0;
  PgSphCoefficients c;

  (void)state;
  for (int i = 0; i < 3; i++) {
    expected += 6.0 * W(ring[i] / 1.25);
    end += (i == 1 ? 4.0 : 3.0) * W(ring[i] / 1.25);
  }
  expected *= scale; /* area of a cell over h^2 */
  end *= scale;
  NEAR(expected, 1.0051, 5e-5); /* half of the last digit given */
  NEAR(end, 0.643, 5e-4);       /* the same */
  CHECK(PgSphGetCoefficients(g.sph, &c));
  for (PetscInt a = 0; a < owned; a++) {
    PetscInt near = 0, row, column, length;

    PackingRow(&lattice, id[a], &row, &column, &length);
    if (row % 2 && row > 1 && row < lattice.rows - 2 && (column == 0 || column == length - 1)) {
      ends++;
      NEAR(c.kernel_sum[a], end, 1e-14 * 11.0); /* 11 terms below 1 */
    }
    if (PackingDepth(&lattice, id[a]) < 5.0) continue;
    inside++;
    for (PetscInt k = c.ptr[a]; k < c.ptr[a + 1]; k++) near += c.weight[k] > 0.0;
    assert_int_equal((int)near, 18);
    NEAR(c.kernel_sum[a], expected, 1e-14 * 19.0); /* 19 terms below 1 */
  }
  assert_true(GroundTotal(&g, inside) >= 20);
  assert_int_equal((int)GroundTotal(&g, ends), 8);
  GroundDestroy(&g);
}

/* Equal areas: both discs of a pair have exactly opposite gradients and equal Laplacian weights, on whatever ranks. */
static void ExactSymmetryOfEqualDiscs(void **state)
{
  Ground   g     = Make(PETSC_COMM_WORLD, &lattice, "");
  Dense    d     = Collect(&g);
  PetscInt pairs = 0;

  (void)state;
  for (PetscInt a = 0; a < d.n; a++) {
    for (PetscInt b = 0; b < a; b++) {
      const PetscInt ab = a * d.n + b, ba = b * d.n + a;
      assert_true(d.gradient_x[ab] == -d.gradient_x[ba] && d.gradient_y[ab] == -d.gradient_y[ba]);
      assert_true(d.laplacian[ab] == d.laplacian[ba] && d.weight[ab] == d.weight[ba]);
      pairs += d.laplacian[ab] < 0.0;
    }
  }
  assert_true(pairs > 7 * d.n);
  Release(&d);
  GroundDestroy(&g);
}

/* Unequal areas: the same of the entries times dV_a, but for rounding. */
static void SymmetryOfUnequalDiscs(void **state)
{
  const PetscReal   eps = 4.0 * PETSC_MACHINE_EPSILON; /* up to four operations on each side, half an epsilon each */
  Ground            g   = Make(PETSC_COMM_WORLD, &disorder, "-sph_laplacian_eta 0.01");
  PgSphCoefficients c;
  Dense             d;

  (void)state;
  CHECK(PgSphGetCoefficients(g.sph, &c));
  assert_true(c.symmetric);
  d = Collect(&g);
  for (PetscInt a = 0; a < d.n; a++) {
    for (PetscInt b = 0; b < a; b++) {
      const PetscInt  ab = a * d.n + b, ba = b * d.n + a;
      const PetscReal va = d.volume[a], vb = d.volume[b];
      NEAR(d.gradient_x[ab] * va, -d.gradient_x[ba] * vb, eps * PetscAbsReal(d.gradient_x[ab] * va));
      NEAR(d.gradient_y[ab] * va, -d.gradient_y[ba] * vb, eps * PetscAbsReal(d.gradient_y[ab] * va));
      NEAR(d.laplacian[ab] * va, d.laplacian[ba] * vb, eps * PetscAbsReal(d.laplacian[ab] * va));
    }
  }
  Release(&d);
  GroundDestroy(&g);
}

/* One world over all ranks against one that this rank has for itself, bit by bit. */
static void SameBitsAsAlone(const Packing *packing, const char options[])
{
  Ground   all = Make(PETSC_COMM_WORLD, packing, options), alone;
  Dense    d   = Collect(&all), e;
  PetscInt gradients, laplacians, alone_gradients, alone_laplacians;

  CHECK(PgSphGetFallbacks(all.sph, &gradients, &laplacians));
  GroundDestroy(&all);
  alone = Make(PETSC_COMM_SELF, packing, options);
  e     = Collect(&alone);
  CHECK(PgSphGetFallbacks(alone.sph, &alone_gradients, &alone_laplacians));
  AssertSame(d.gradient_x, e.gradient_x, d.n * d.n, "gradient_x");
  AssertSame(d.gradient_y, e.gradient_y, d.n * d.n, "gradient_y");
  AssertSame(d.laplacian, e.laplacian, d.n * d.n, "laplacian");
  AssertSame(d.weight, e.weight, d.n * d.n, "weight");
  AssertSame(d.sum, e.sum, d.n, "kernel sum");
  assert_int_equal((int)gradients, (int)alone_gradients);
  assert_int_equal((int)laplacians, (int)alone_laplacians);
  Release(&d);
  Release(&e);
  GroundDestroy(&alone);
}

static void SameBitsOnAnyRanks(void **state)
{
  const Packing three = {2, 2, 5e-3, 0.2, 0.3}; /* fewer discs than ranks */

  (void)state;
  SameBitsAsAlone(&disorder, "");
  SameBitsAsAlone(&disorder, "-sph_operators corrected -sph_laplacian_eta 0.01");
  SameBitsAsAlone(&lattice, "-sph_operators corrected");
  SameBitsAsAlone(&three, "-sph_operators corrected");
}

/* A refusal ends the run: the object is not used again. */
static void Refusals(void **state)
{
  const struct {
    const char *options, *words[4];
  } cases[] = {{"-sph_kernel gauss", {"-sph_kernel", "gauss", "cubic_spline", ""}},
               {"-sph_laplacian_eta -0.5", {"-sph_laplacian_eta", "-0.5", ">= 0", ""}},
               {"-sph_smoothing 0.7", {"-sph_smoothing", "0.7", ">= 1.5", ""}},
               {"-sph_operators exact", {"-sph_operators", "exact", "paper", "corrected"}}};

  (void)state;
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    Ground g;

    GroundCreate(PETSC_COMM_WORLD, GROUND_SPH, "", &g);
    GroundOptions(cases[k].options);
    FAILS(PgSphSetFromOptions(g.sph), PETSC_ERR_USER_INPUT, cases[k].words[0], cases[k].words[1], cases[k].words[2],
          cases[k].words[3]);
  }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(Formulas),
    cmocka_unit_test(KernelSumOfTheLattice),
    cmocka_unit_test(ExactSymmetryOfEqualDiscs),
    cmocka_unit_test(SymmetryOfUnequalDiscs),
    cmocka_unit_test(SameBitsOnAnyRanks),
    cmocka_unit_test(Refusals),
};

GROUND_MAIN(tests, PETSC_TRUE)
