/* ranks: 1 2 4 */
/* The Navier-Stokes predictor, Eqs. 35-46 and 59, on fields for which following the water is exact. Velocity and
   pressure of the arriving water are found here by iterating u_f = u(x - (u_f - v) dt), without the matrix B. */
#include "ground.h"

static const Packing lattice  = {19, 23, 5e-3, 0.0, 0.0};
static const Packing disorder = {10, 12, 5e-3, 0.25, 0.15};

/* u = u0 + G x, v uniform, p = p0 + g.x + x.H x/2 (H symmetric). */
typedef struct {
  PetscReal u0[2], G[4], v[2], p0, g[2], H[3];
} Flow;

static const Flow flow = {{0.8, -0.5}, {30.0, -45.0, 20.0, 15.0}, {-0.3, 0.7}, 1.3e5, {4e5, -7e5}, {2e6, -3e6, 5e6}};

static void Velocity(const Flow *f, const PetscReal x[2], PetscReal u[2])
{
  for (int i = 0; i < 2; i++) u[i] = f->u0[i] + f->G[2 * i] * x[0] + f->G[2 * i + 1] * x[1];
}

static void PressureGradient(const Flow *f, const PetscReal x[2], PetscReal grad[2])
{
  grad[0] = f->g[0] + f->H[0] * x[0] + f->H[1] * x[1];
  grad[1] = f->g[1] + f->H[1] * x[0] + f->H[2] * x[1];
}

static PetscReal Pressure(const Flow *f, const PetscReal x[2])
{
  return f->p0 + f->g[0] * x[0] + f->g[1] * x[1] +
         0.5 * (f->H[0] * x[0] * x[0] + 2.0 * f->H[1] * x[0] * x[1] + f->H[2] * x[1] * x[1]);
}

/* Where the water that arrives at the disc at x was, relative to a disc that stands still. */
static void Origin(const Flow *f, const PetscReal x[2], PetscReal dt, PetscReal origin[2])
{
  PetscReal u[2];

  origin[0] = x[0];
  origin[1] = x[1];
  for (int i = 0; i < 200; i++) { /* |G| dt is 0.1 at most: one digit each */
    Velocity(f, origin, u);
    for (int e = 0; e < 2; e++) origin[e] = x[e] - (u[e] - f->v[e]) * dt;
  }
}

static Ground Make(const Packing *packing, const Flow *f, const char options[], PetscReal dt)
{
  Ground     g;
  PetscReal *x, *v, *u, *p, *n;

  GroundCreate(PETSC_COMM_WORLD, GROUND_NS, options, &g);
  GroundFill(&g, PackingCount(packing), PackingPlace, packing);
  n = GroundArray(&g, "initial_porosity");
  v = GroundCore(&g, PG_VELOCITY);
  for (PetscInt a = 0; a < GroundOwned(&g); a++) {
    n[a]         = 0.0931;
    v[2 * a]     = f->v[0];
    v[2 * a + 1] = f->v[1];
  }
  CHECK(PgPoreSetUp(g.pore, dt));
  x = GroundCore(&g, PG_POSITION);
  u = GroundArray(&g, "fluid_velocity");
  p = GroundArray(&g, "pressure");
  for (PetscInt a = 0; a < GroundOwned(&g); a++) {
    Velocity(f, x + 2 * a, u + 2 * a);
    p[a] = Pressure(f, x + 2 * a);
  }
  CHECK(PgPoreRefresh(g.pore));
  return g;
}

/* Linear u and p, uniform v, theta = 1: u~ and the guess of the pressure are what the water brings along, exactly, at
   every disc of a disordered packing. */
static void LinearFieldsAreCarriedExactly(void **state)
{
  const PetscReal dt = 1.5e-3;
  Flow            f  = flow;
  Ground          g;
  PetscReal      *x, *u, *p, moved = 0.0;
  PgPoreStats     stats;

  (void)state;
  for (int i = 0; i < 3; i++) f.H[i] = 0.0;
  g = Make(&disorder, &f, "-sph_gradient corrected -pressure explicit", dt);
  CHECK(PgPorePredict(g.pore, dt));
  x = GroundCore(&g, PG_POSITION);
  u = GroundArray(&g, "fluid_predictor");
  p = GroundArray(&g, "pressure_guess");
  for (PetscInt a = 0; a < GroundOwned(&g); a++) {
    PetscReal from[2], expected[2];

    Origin(&f, x + 2 * a, dt, from);
    Velocity(&f, from, expected);
    moved = PetscMax(moved, PetscAbsReal(from[0] - x[2 * a]));
    /* velocities of about 5 m/s; gradients with weights up to 10/radius, times dt |u| = 7 mm: some 30 eps */
    for (int i = 0; i < 2; i++) NEAR(u[2 * a + i], expected[i], 1e-12);
    /* the same for pressures of about 2e5 Pa */
    NEAR(p[a], Pressure(&f, from), 1e-7);
  }
  assert_true(GroundMax(&g, moved) > 1e-3); /* a fifth of a radius */
  CHECK(PgPoreGetStats(g.pore, &stats));
  assert_int_equal((int)stats.characteristic_failures, 0);
  GroundDestroy(&g);
}

/* With the paper's gradient the lattice carries with 1.0224 G: closed form of Eqs. 38-40. */
static void GradientOfThePaperOnTheLattice(void **state)
{
  const PetscReal dt = 1.5e-3;
  /* times the area that goes with n = 0.0931 over a cell of the lattice */
  const PetscReal factor = LatticeFactor(0.0) * PETSC_PI / (PetscSqrtReal(12.0) * (1.0 - 0.0931));
  Ground          g      = Make(&lattice, &flow, "-pressure explicit", dt);
  PetscReal      *x      = GroundCore(&g, PG_POSITION), *u;
  PetscInt        inside = 0;

  (void)state;
  CHECK(PgPorePredict(g.pore, dt));
  u = GroundArray(&g, "fluid_predictor");
  for (PetscInt a = 0; a < GroundOwned(&g); a++) {
    const PetscReal *G = flow.G, t = factor * dt;
    PetscReal        B[4] = {1.0 + t * G[0], t * G[1], t * G[2], 1.0 + t * G[3]}, s[2], det = B[0] * B[3] - B[1] * B[2];

    if (PackingDepth(&lattice, GroundIds(&g)[a]) < 5.0) continue;
    inside++;
    Velocity(&flow, x + 2 * a, s);
    for (int i = 0; i < 2; i++) s[i] += t * (G[2 * i] * flow.v[0] + G[2 * i + 1] * flow.v[1]);
    /* as in the test above */
    NEAR(u[2 * a], (B[3] * s[0] - B[1] * s[1]) / det, 1e-12);
    NEAR(u[2 * a + 1], (B[0] * s[1] - B[2] * s[0]) / det, 1e-12);
  }
  assert_true(GroundTotal(&g, inside) > 100);
  GroundDestroy(&g);
}

/* theta < 1: u~ = u_f + (1 - theta) dt Q(x_f) with Q = -(grad p - F)/rho_f linear: a quadratic pressure and a drag
   linear in u, both exact inside the lattice. */
static void ExplicitShareOfTheForces(void **state)
{
  const PetscReal dt = 1.5e-3, theta = 0.7, n = 0.0931, d = 0.01, mu = 1.01e-3, rho = 900.0;
  const PetscReal beta = 150.0 * PetscSqr((1.0 - n) / (n * d)) * mu;
  Ground          g    = Make(&lattice, &flow,
                              "-sph_gradient corrected -pressure explicit -ns_theta 0.7 -ns_drag linear -fluid_density 900", dt);
  PetscReal      *x = GroundCore(&g, PG_POSITION), *u, *p, largest = 0.0;
  PetscInt        inside = 0;

  (void)state;
  CHECK(PgPorePredict(g.pore, dt));
  u = GroundArray(&g, "fluid_predictor");
  p = GroundArray(&g, "pressure_guess");
  for (PetscInt a = 0; a < GroundOwned(&g); a++) {
    PetscReal from[2], u_f[2], grad[2], here[2];

    if (PackingDepth(&lattice, GroundIds(&g)[a]) < 10.0) continue; /* its neighbours are inside, too */
    inside++;
    Origin(&flow, x + 2 * a, dt, from);
    Velocity(&flow, from, u_f);
    PressureGradient(&flow, from, grad);
    for (int i = 0; i < 2; i++) {
      const PetscReal Q = -(grad[i] - beta * (flow.v[i] - u_f[i])) / rho;
      /* Q is about 1e3 m/s2, from pressure differences of 1e4 Pa over 1e-2 m: eps * 1e4/1e-2/rho * dt, some 100 terms */
      NEAR(u[2 * a + i], u_f[i] + (1.0 - theta) * dt * Q, 1e-11);
      largest = PetscMax(largest, PetscAbsReal((1.0 - theta) * dt * Q));
    }
    /* Eq. 59 is linear: p - grad p.(u_f - v) dt */
    PressureGradient(&flow, x + 2 * a, here);
    NEAR(p[a], Pressure(&flow, x + 2 * a) + here[0] * (from[0] - x[2 * a]) + here[1] * (from[1] - x[2 * a + 1]), 1e-7);
  }
  assert_true(GroundTotal(&g, inside) > 10);
  assert_true(GroundMax(&g, largest) > 0.1);
  GroundDestroy(&g);
}

/* Characteristics that cross within the step: u stays, and the discs are counted, in this step only. */
static void CrossingCharacteristics(void **state)
{
  const PetscReal dt = 1.5e-3;
  Flow            f  = flow;
  Ground          g;
  PetscReal      *x, *u, *v;
  PgPoreStats     stats;

  (void)state;
  f.G[0] = -1.0 / dt; /* det B = (1 - 1)(1 + G_yy dt) - G_xy G_yx dt^2 with G_xy = 0 */
  f.G[1] = 0.0;
  for (int i = 0; i < 3; i++) f.H[i] = 0.0;
  g = Make(&disorder, &f, "-sph_gradient corrected -pressure explicit", dt);
  CHECK(PgPorePredict(g.pore, dt));
  CHECK(PgPoreGetStats(g.pore, &stats));
  assert_int_equal((int)stats.characteristic_failures, (int)g.count);
  u = GroundArray(&g, "fluid_predictor");
  v = GroundArray(&g, "fluid_velocity");
  for (PetscInt i = 0; i < 2 * GroundOwned(&g); i++) assert_true(u[i] == v[i]);
  x = GroundCore(&g, PG_POSITION);
  for (PetscInt a = 0; a < GroundOwned(&g); a++) Velocity(&flow, x + 2 * a, v + 2 * a);
  CHECK(PgPoreRefresh(g.pore));
  CHECK(PgPorePredict(g.pore, dt));
  CHECK(PgPoreGetStats(g.pore, &stats));
  assert_int_equal((int)stats.characteristic_failures, 0);
  GroundDestroy(&g);
}

/* XSPH: u~ + S (sum W dV u~_b/sum W dV - u~), the disc itself among the b; nothing for linear u inside the lattice. */
static void Smoothing(void **state)
{
  const PetscReal dt = 1.5e-3, S = 0.3;

  (void)state;
  for (int k = 0; k < 2; k++) {
    const Packing    *packing = k ? &disorder : &lattice;
    Ground            g       = Make(packing, &flow, "-sph_gradient corrected -pressure explicit", dt);
    PetscReal        *plain, *smooth;
    PgSphCoefficients c;
    PetscInt          inside  = 0;
    PetscReal         changed = 0.0;

    CHECK(PgPorePredict(g.pore, dt));
    plain = GroundGatherField(&g, "fluid_predictor", 2);
    GroundDestroy(&g);
    g = Make(packing, &flow, "-sph_gradient corrected -pressure explicit -ns_smoothing 0.3", dt);
    CHECK(PgPorePredict(g.pore, dt));
    smooth = GroundArray(&g, "fluid_predictor");
    CHECK(PgSphGetCoefficients(g.sph, &c));
    for (PetscInt a = 0; a < GroundOwned(&g); a++) {
      const PetscInt id = GroundIds(&g)[a];
      for (int i = 0; i < 2; i++) {
        const PetscReal own  = plain[2 * id + i];
        PetscReal       mean = own, weights = 0.0;
        for (PetscInt b = c.ptr[a]; b < c.ptr[a + 1]; b++) weights += c.weight[b];
        mean *= c.kernel_sum[a] - weights;
        for (PetscInt b = c.ptr[a]; b < c.ptr[a + 1]; b++) mean += c.weight[b] * plain[2 * GroundIds(&g)[c.col[b]] + i];
        mean /= c.kernel_sum[a];
        /* sums of some 20 numbers of about 5 */
        NEAR(smooth[2 * a + i], own + S * (mean - own), 1e-13);
        changed = PetscMax(changed, PetscAbsReal(smooth[2 * a + i] - own));
        if (k == 0 && PackingDepth(packing, id) >= 5.0) {
          inside++;
          NEAR(smooth[2 * a + i], own, 1e-13);
        }
      }
    }
    assert_true(GroundMax(&g, changed) > 1e-2);
    assert_true(k == 1 || GroundTotal(&g, inside) > 100);
    CHECK(PetscFree(plain));
    GroundDestroy(&g);
  }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(LinearFieldsAreCarriedExactly),
    cmocka_unit_test(GradientOfThePaperOnTheLattice),
    cmocka_unit_test(ExplicitShareOfTheForces),
    cmocka_unit_test(CrossingCharacteristics),
    cmocka_unit_test(Smoothing),
};

GROUND_MAIN(tests, PETSC_TRUE)
