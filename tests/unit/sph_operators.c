/* ranks: 1 2 4 */
/* Operators on known fields: what the paper's forms return on the perfect lattice, and what the corrected ones are
   exact for. */
#include "ground.h"

static const Packing lattice  = {13, 15, 5e-3, 0.0, 0.0};
static const Packing disorder = {12, 14, 5e-3, 0.3, 0.15};

static Ground Make(const Packing *packing, const char options[])
{
  Ground g;

  GroundCreate(PETSC_COMM_WORLD, GROUND_SPH, options, &g);
  GroundFill(&g, PackingCount(packing), PackingPlace, packing);
  return g;
}

/* Coefficients of f = c0 + c1 x + c2 y + c3 x^2 + c4 x y + c5 y^2, lengths in units of the radius. */
typedef PetscReal Quadratic[6];

static PetscReal Value(const Quadratic c, PetscReal x, PetscReal y)
{
  return c[0] + c[1] * x + c[2] * y + c[3] * x * x + c[4] * x * y + c[5] * y * y;
}

/* At all local discs, ghosts included. */
static PetscReal *Sample(Ground *g, const Quadratic c, PetscReal unit)
{
  const PetscInt   n = GroundLocal(g);
  const PetscReal *x = GroundCore(g, PG_POSITION);
  PetscReal       *f;

  CHECK(PetscMalloc1(n + 1, &f));
  for (PetscInt i = 0; i < n; i++) f[i] = Value(c, x[2 * i] / unit, x[2 * i + 1] / unit);
  return f;
}

/* Gradient of a linear field: 1.022 times too large on the lattice, the same for every disc inside. */
static void GradientOfThePaper(void **state)
{
  const Quadratic c    = {0.7, 3.0, -2.0, 0.0, 0.0, 0.0};
  const PetscReal unit = lattice.radius, factor = LatticeFactor(0.0);
  Ground          g  = Make(&lattice, "");
  const PetscInt *id = GroundIds(&g), owned = GroundOwned(&g);
  PetscReal      *f      = Sample(&g, c, unit), *grad;
  PetscInt        inside = 0;

  (void)state;
  NEAR(factor, 1.0224, 5e-5); /* the last digit given */
  CHECK(PetscMalloc1(2 * owned + 1, &grad));
  CHECK(PgSphGradient(g.sph, f, grad));
  for (PetscInt a = 0; a < owned; a++) {
    if (PackingDepth(&lattice, id[a]) < 5.0) continue;
    inside++;
    /* differences of values of about 100 with weights of about 1/unit */
    NEAR(grad[2 * a] * unit, factor * 3.0, 1e-12);
    NEAR(grad[2 * a + 1] * unit, factor * -2.0, 1e-12);
  }
  assert_true(GroundTotal(&g, inside) > 30);
  CHECK(PetscFree(f));
  CHECK(PetscFree(grad));
  GroundDestroy(&g);
}

/* Laplacian of r^2, which is 4: times 0.924, 1.011 and 1.022 for eta = 0.1, 0.01 and 0. A linear part adds nothing. */
static void LaplacianOfThePaper(void **state)
{
  const Quadratic c = {-1.0, 0.4, 0.9, 1.0, 0.3, 1.0};
  const struct {
    const char *options;
    PetscReal   eta, factor;
  } cases[] = {{"", 0.1, 0.9238},
               {"-sph_laplacian_eta 0.01", 0.01, 1.0114},
               {"-sph_laplacian_eta 0", 0.0, 1.0224}}; /* the first is the default */

  (void)state;
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    const PetscReal unit = lattice.radius, factor = LatticeFactor(cases[k].eta);
    Ground          g  = Make(&lattice, cases[k].options);
    const PetscInt *id = GroundIds(&g), owned = GroundOwned(&g);
    PetscReal      *f      = Sample(&g, c, unit), *lap;
    PetscInt        inside = 0;

    NEAR(factor, cases[k].factor, 5e-5); /* the last digit given */
    CHECK(PetscMalloc1(owned + 1, &lap));
    CHECK(PgSphLaplacian(g.sph, f, lap));
    for (PetscInt a = 0; a < owned; a++) {
      if (PackingDepth(&lattice, id[a]) < 5.0) continue;
      inside++;
      /* differences of values of about 1e3 with weights of about 1/unit^2 */
      NEAR(lap[a] * unit * unit, 4.0 * factor, 1e-11);
    }
    assert_true(GroundTotal(&g, inside) > 30);
    CHECK(PetscFree(f));
    CHECK(PetscFree(lap));
    GroundDestroy(&g);
  }
}

/* Rows for which the corrected gradient of a linear field is not exact; they must be the ones that fell back, which
   their number tells. */
static PetscInt InexactGradients(Ground *g, PetscReal unit)
{
  const Quadratic c       = {0.7, 3.0, -2.0, 0.0, 0.0, 0.0};
  const PetscInt  owned   = GroundOwned(g);
  PetscReal      *f       = Sample(g, c, unit), *grad;
  PetscInt        inexact = 0;

  CHECK(PetscMalloc1(2 * owned + 1, &grad));
  CHECK(PgSphGradient(g->sph, f, grad));
  for (PetscInt a = 0; a < owned; a++) {
    /* values of about 100 and weights up to the largest correction, 10: rounding stays below 1e-11, and a plain row
       at the edge is off by half */
    inexact += !(PetscAbsReal(grad[2 * a] * unit - 3.0) < 1e-10 && PetscAbsReal(grad[2 * a + 1] * unit + 2.0) < 1e-10);
  }
  CHECK(PetscFree(f));
  CHECK(PetscFree(grad));
  return GroundTotal(g, inexact);
}

static PetscInt InexactLaplacians(Ground *g, PetscReal unit)
{
  const Quadratic c       = {-1.0, 0.4, 0.9, 1.3, 0.35, -0.4};
  const PetscInt  owned   = GroundOwned(g);
  PetscReal      *f       = Sample(g, c, unit), *lap;
  PetscInt        inexact = 0;

  CHECK(PetscMalloc1(owned + 1, &lap));
  CHECK(PgSphLaplacian(g->sph, f, lap));
  /* values of about 1e3, weights of about 1/unit^2 times a correction of at most 5: rounding below 1e-11 */
  for (PetscInt a = 0; a < owned; a++) inexact += !(PetscAbsReal(lap[a] * unit * unit - 1.8) < 1e-10);
  CHECK(PetscFree(f));
  CHECK(PetscFree(lap));
  return GroundTotal(g, inexact);
}

static void CorrectedOperatorsAreExact(void **state)
{
  const Packing *const packings[] = {&lattice, &disorder};
  const char *const    etas[]     = {"-sph_operators corrected", "-sph_operators corrected -sph_laplacian_eta 0"};

  (void)state;
  for (int p = 0; p < 2; p++) {
    for (int e = 0; e < 2; e++) {
      Ground            g = Make(packings[p], etas[e]);
      PetscInt          gradients, laplacians;
      PgSphCoefficients c;

      CHECK(PgSphGetCoefficients(g.sph, &c));
      assert_false(c.symmetric);
      CHECK(PgSphGetFallbacks(g.sph, &gradients, &laplacians));
      assert_int_equal((int)InexactGradients(&g, packings[p]->radius), (int)gradients);
      assert_int_equal((int)InexactLaplacians(&g, packings[p]->radius), (int)laplacians);
      print_message("%s, %s: %d discs, fallbacks: gradient %d, Laplacian %d\n", p ? "disorder" : "lattice", etas[e],
                    (int)g.count, (int)gradients, (int)laplacians);
      /* edges and corners of a packing do not need the fallback for the gradient, and few do for the Laplacian */
      assert_int_equal((int)gradients, 0);
      assert_true(laplacians <= g.count / 20);
      GroundDestroy(&g);
    }
  }
}

/* Each operator has its own choice, which overrides the common one. */
static void ChoicesOfEach(void **state)
{
  const struct {
    const char *options;
    PetscBool   gradient, laplacian; /* exact inside */
  } cases[] = {{"-sph_gradient corrected", PETSC_TRUE, PETSC_FALSE},
               {"-sph_laplacian corrected", PETSC_FALSE, PETSC_TRUE},
               {"-sph_operators corrected -sph_laplacian paper", PETSC_TRUE, PETSC_FALSE},
               {"-sph_operators paper", PETSC_FALSE, PETSC_FALSE}};

  (void)state;
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    Ground            g = Make(&disorder, cases[k].options);
    PgSphCoefficients c;

    CHECK(PgSphGetCoefficients(g.sph, &c));
    assert_int_equal(c.symmetric, !cases[k].laplacian);
    if (cases[k].gradient)
      assert_int_equal((int)InexactGradients(&g, disorder.radius), 0);
    else
      assert_int_equal((int)InexactGradients(&g, disorder.radius), (int)g.count);
    if (cases[k].laplacian)
      assert_true(InexactLaplacians(&g, disorder.radius) <= g.count / 20);
    else
      assert_int_equal((int)InexactLaplacians(&g, disorder.radius), (int)g.count);
    GroundDestroy(&g);
  }
}

/* Discs on a line, and one alone: nothing determines the correction across the line. */
static void PlaceLine(const void *context, PetscInt id, Disc *disc)
{
  (void)context;
  memset(disc, 0, sizeof *disc);
  disc->x[0]   = id < 7 ? 0.01 * (PetscReal)id : 0.5;
  disc->x[1]   = id < 7 ? 0.004 * (PetscReal)id : 0.5;
  disc->r      = 5e-3 + 1e-4 * (PetscReal)id;
  disc->volume = 9e-5;
}

static void FallbackKeepsThePlainForm(void **state)
{
  PetscReal *plain[3], *kept[3];
  PetscInt   gradients, laplacians;

  (void)state;
  for (int run = 0; run < 2; run++) {
    Ground            g;
    PgSphCoefficients c;
    PetscReal        *f, *grad, *lap, **result = run ? kept : plain;
    const Quadratic   q = {0.2, 1.0, 2.0, 0.3, 0.0, 0.1};

    GroundCreate(PETSC_COMM_WORLD, GROUND_SPH, run ? "-sph_operators corrected" : "", &g);
    GroundFill(&g, 8, PlaceLine, NULL);
    CHECK(PgSphGetFallbacks(g.sph, &gradients, &laplacians));
    assert_int_equal((int)gradients, run ? 8 : 0);
    assert_int_equal((int)laplacians, run ? 8 : 0);
    CHECK(PgSphGetCoefficients(g.sph, &c));
    CHECK(PetscMalloc2(2 * GroundOwned(&g), &grad, GroundOwned(&g), &lap));
    f = Sample(&g, q, 5e-3);
    CHECK(PgSphGradient(g.sph, f, grad));
    CHECK(PgSphLaplacian(g.sph, f, lap));
    result[0] = GroundGather(&g, grad, 2);
    result[1] = GroundGather(&g, lap, 1);
    result[2] = GroundGather(&g, c.kernel_sum, 1);
    CHECK(PetscFree(f));
    CHECK(PetscFree2(grad, lap));
    GroundDestroy(&g);
  }
  AssertSame(plain[0], kept[0], 16, "gradient");
  AssertSame(plain[1], kept[1], 8, "Laplacian");
  AssertSame(plain[2], kept[2], 8, "kernel sum");
  assert_true(plain[1][3] != 0.0 && plain[0][14] == 0.0 && plain[1][7] == 0.0); /* the eighth is alone */
  for (int i = 0; i < 3; i++) {
    CHECK(PetscFree(plain[i]));
    CHECK(PetscFree(kept[i]));
  }
}

/* Divergence and vector gradient of u = (f, g) are the gradients of f and g. */
static void VectorOperators(void **state)
{
  const Quadratic c[2]  = {{0.1, 1.0, -2.0, 0.3, 0.2, -0.1}, {1.0, 0.5, 3.0, -0.2, 0.15, 0.4}};
  Ground          g     = Make(&disorder, "-sph_gradient corrected");
  const PetscInt  owned = GroundOwned(&g), local = GroundLocal(&g);
  PetscReal      *f[2], *u, *grad[2], *full, *div;

  (void)state;
  CHECK(PetscMalloc5(2 * local + 1, &u, 2 * owned + 1, &grad[0], 2 * owned + 1, &grad[1], 4 * owned + 1, &full,
                     owned + 1, &div));
  for (int k = 0; k < 2; k++) {
    f[k] = Sample(&g, c[k], disorder.radius);
    for (PetscInt i = 0; i < local; i++) u[2 * i + k] = f[k][i];
    CHECK(PgSphGradient(g.sph, f[k], grad[k]));
  }
  CHECK(PgSphVectorGradient(g.sph, u, full));
  CHECK(PgSphDivergence(g.sph, u, div));
  for (PetscInt a = 0; a < owned; a++) {
    for (int k = 0; k < 2; k++) {
      /* the same sums in the same order */
      assert_true(full[4 * a + 2 * k] == grad[k][2 * a] && full[4 * a + 2 * k + 1] == grad[k][2 * a + 1]);
    }
    /* the same terms in another order: some 20 of values up to 1e3 and weights up to 10/radius */
    NEAR(div[a] * disorder.radius, (grad[0][2 * a] + grad[1][2 * a + 1]) * disorder.radius, 1e-11);
  }
  for (int k = 0; k < 2; k++) CHECK(PetscFree(f[k]));
  CHECK(PetscFree5(u, grad[0], grad[1], full, div));
  GroundDestroy(&g);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(GradientOfThePaper),         cmocka_unit_test(LaplacianOfThePaper),
    cmocka_unit_test(CorrectedOperatorsAreExact), cmocka_unit_test(ChoicesOfEach),
    cmocka_unit_test(FallbackKeepsThePlainForm),  cmocka_unit_test(VectorOperators),
};

GROUND_MAIN(tests, PETSC_TRUE)
