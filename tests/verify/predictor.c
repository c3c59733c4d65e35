/* ranks: 1 2 */
/* Velocity of the arriving water, Eqs. 35-40, against the exact solution of u_f = u(x - (u_f - v) dt).

   Physics: none but transport: theta = 1, so u~ is u(x_f); discs move with v, the water with u.
   Exact solution: the implicit equation above, solved by iteration at every disc; p_f = p(x - (u_f - v) dt).
   Expected order of u~ in dt, for one step:
     2  where grad u is exact: u quadratic in x, corrected gradient, inside a lattice; what Eqs. 37-38 neglect is
        u''(u - v)^2 dt^2/2. The same for p
     2  u smooth, corrected gradient, h refined in proportion to dt: grad u is off by h^2, which costs h^2 dt
     1  the paper's gradient, 1.0224 times too large on the lattice: 0.0224 |grad u| |u - v| dt */
#include "mms.h"

typedef struct {
  const char *name, *options;
  PetscBool   smooth; /* sines instead of quadratics, refined with dt */
  PetscReal   order_u, order_p;
} Case;

static const Case cases[] = {
    {"quadratic, corrected gradient", "-sph_gradient corrected -pressure explicit", PETSC_FALSE, 2, 2},
    {"smooth, corrected gradient, h ~ dt", "-sph_gradient corrected -pressure explicit", PETSC_TRUE, 2, 2},
    {"quadratic, paper's gradient", "-pressure explicit", PETSC_FALSE, 1, 1},
};

static void Water(PetscBool smooth, const PetscReal x[2], PetscReal u[2])
{
  const PetscReal X = x[0] - 0.4, Y = x[1] - 0.5;

  if (smooth) {
    u[0] = 0.7 + 0.5 * PetscSinReal(2.0 * X + Y);
    u[1] = -0.3 + 0.4 * PetscCosReal(X - 3.0 * Y);
  } else {
    u[0] = 0.7 + 0.9 * X - 0.4 * Y + 1.1 * X * X - 0.6 * X * Y + 0.8 * Y * Y;
    u[1] = -0.3 - 0.2 * X + 0.5 * Y - 0.7 * X * X + 0.9 * X * Y - 0.5 * Y * Y;
  }
}

static PetscReal Head(PetscBool smooth, const PetscReal x[2])
{
  if (smooth) return 1e4 * PetscSinReal(x[0] - 2.0 * x[1]);
  return 1e4 * (x[0] - 2.0 * x[1] + 0.6 * x[0] * x[0] - x[0] * x[1] + 0.3 * x[1] * x[1]);
}

/* Discs move with velocities of their own: each carries its v along, uniform or not. */
static void Disks(const PetscReal x[2], PetscReal v[2])
{
  v[0] = 0.1 + 0.2 * PetscSinReal(3.0 * x[1]);
  v[1] = -0.6 + 0.1 * x[0];
}

static void Step(const Case *c, PetscInt columns, PetscReal dt, Sequence *velocity, Sequence *pressure)
{
  const Packing packing = SquarePacking(columns, 1.0, 0.0);
  Ground        g;
  PetscReal    *x, *v, *u, *p, error[2] = {0, 0};

  GroundCreate(PETSC_COMM_WORLD, GROUND_NS, c->options, &g);
  GroundFill(&g, PackingCount(&packing), PackingPlace, &packing);
  CHECK(PgPoreSetUp(g.pore, dt));
  x = GroundCore(&g, PG_POSITION);
  v = GroundCore(&g, PG_VELOCITY);
  u = GroundArray(&g, "fluid_velocity");
  p = GroundArray(&g, "pressure");
  for (PetscInt a = 0; a < GroundOwned(&g); a++) {
    Disks(x + 2 * a, v + 2 * a);
    Water(c->smooth, x + 2 * a, u + 2 * a);
    p[a] = Head(c->smooth, x + 2 * a);
  }
  CHECK(PgPoreRefresh(g.pore));
  CHECK(PgPorePredict(g.pore, dt));
  u = GroundArray(&g, "fluid_predictor");
  p = GroundArray(&g, "pressure_guess");
  for (PetscInt a = 0; a < GroundOwned(&g); a++) {
    PetscReal from[2] = {x[2 * a], x[2 * a + 1]}, exact[2];

    if (PackingDepth(&packing, GroundIds(&g)[a]) < 5.0) continue;
    for (int i = 0; i < 100; i++) { /* |grad u| dt is below 0.2: 0.2^100 */
      Water(c->smooth, from, exact);
      for (int e = 0; e < 2; e++) from[e] = x[2 * a + e] - (exact[e] - v[2 * a + e]) * dt;
    }
    for (int e = 0; e < 2; e++) error[0] = PetscMax(error[0], PetscAbsReal(u[2 * a + e] - exact[e]));
    error[1] = PetscMax(error[1], PetscAbsReal(p[a] - Head(c->smooth, from)));
  }
  SequenceAdd(velocity, g.count, dt, GroundMax(&g, error[0]));
  SequenceAdd(pressure, g.count, dt, GroundMax(&g, error[1]) / 1e4);
  GroundDestroy(&g);
}

static void Predictor(void **state)
{
  (void)state;
  CHECK(PetscPrintf(PETSC_COMM_WORLD, "h: time step [s]; error: largest [m/s], and of p over 1e4 Pa\n"));
  TableHead(PETSC_COMM_WORLD);
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    char     name[96];
    Sequence velocity, pressure;

    (void)snprintf(name, sizeof name, "u, %s", cases[k].name);
    velocity = SequenceStart(name);
    (void)snprintf(name, sizeof name, "p, %s", cases[k].name);
    pressure = SequenceStart(name);
    for (PetscInt i = 0; i < 4; i++)
      Step(&cases[k], cases[k].smooth ? 20 << i : 30, 0.04 / (PetscReal)(1 << i), &velocity, &pressure);
    SequenceLine("predictor", &velocity, cases[k].order_u, "order within 0.2", "next term at the smallest dt");
    SequenceLine("predictor", &pressure, cases[k].order_p, "order within 0.2", "next term at the smallest dt");
    /* what the next term may do at the smallest dt */
    NEAR(SequenceOrder(&velocity), cases[k].order_u, 0.2);
    NEAR(SequenceOrder(&pressure), cases[k].order_p, 0.2);
  }
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(Predictor)};

GROUND_MAIN(tests, PETSC_TRUE)
