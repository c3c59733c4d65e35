/* ranks: 1 timeout: 300 */
/* Energy and momentum of the weakly compressible liquid with walls and a body, without viscosity and diffusion. What the
   pressure of a wall does to the liquid must be what the liquid stores: then the energy is kept but for the time step
   (second order). And a body that is pushed along a channel which it fills must not stick to the walls. */
#include "verify.h"
#include <porograin/wcsph.h>

enum { CELLS = 10, COLUMNS = 12, LAYERS = 4 };
static const PetscReal dx = 0.1;

/* A box of 1.2 x 1 m, periodic along x, with a swirl. */
static PgWcsph Box(PgWcsphSolid solid, PgWcsphDensity density, PgWcsphState state)
{
  PgWcsph w;

  CHECK(PgWcsphCreate(PETSC_COMM_WORLD, &w));
  CHECK(PgWcsphSetSpacing(w, dx));
  CHECK(PgWcsphSetPeriodicX(w, 0.0, COLUMNS * dx));
  CHECK(PgWcsphSetLiquid(w, 1000.0, 0.0, 10.0));
  CHECK(PgWcsphSetDiffusion(w, 0.0));
  CHECK(PgWcsphSetSolid(w, solid));
  CHECK(PgWcsphSetDensity(w, density));
  CHECK(PgWcsphSetState(w, state));
  for (int j = -2 * LAYERS; j < CELLS + 2 * LAYERS; j++)
    for (int i = 0; i < COLUMNS; i++) {
      const PetscReal x = (i + 0.5) * dx, y = (j + 0.5) * dx, k = 2.0 * PETSC_PI / (COLUMNS * dx);
      PgWcsphParticle p = {.kind = PG_WCSPH_WALL, .body = j > 0, .x = {x, y}};
      if (j >= 0 && j < CELLS) {
        p.kind = PG_WCSPH_FLUID;
        p.body = 0;
        p.v[0] = 0.01 * PetscSinReal(k * x);
        p.v[1] = 0.02 * PetscSinReal(PETSC_PI * y) * (1.0 + 0.5 * PetscCosReal(k * x));
      }
      CHECK(PgWcsphAddParticles(w, 1, &p));
    }
  CHECK(PgWcsphSetUp(w));
  return w;
}

static PetscReal Energy(PgWcsph w)
{
  PgWcsphTotals totals;

  CHECK(PgWcsphGetTotals(w, &totals));
  return totals.kinetic + totals.internal + totals.potential;
}

/* Largest deviation of the energy from its start over 2.5 s, 12 times sound across and back; *last: what is left of it. */
static PetscReal Drift(PgWcsphSolid solid, PgWcsphDensity density, PgWcsphState state, int steps, PetscReal *last)
{
  PgWcsph   w     = Box(solid, density, state);
  PetscReal first = Energy(w), worst = 0.0;

  for (int n = 0; n < steps; n++) {
    CHECK(PgWcsphStep(w, 2.5 / steps));
    *last = Energy(w) / first;
    worst = PetscMax(worst, PetscAbsReal(*last - 1.0));
  }
  CHECK(PgWcsphDestroy(&w));
  return worst;
}

static void Walls(void **state)
{
  static const struct {
    const char    *what;
    PgWcsphSolid   solid;
    PgWcsphDensity density;
    PgWcsphState   state;
  } run[] = {
      {"mirror", PG_WCSPH_MIRROR, PG_WCSPH_CONTINUITY, PG_WCSPH_LINEAR},
      {"adjoint", PG_WCSPH_ADJOINT, PG_WCSPH_CONTINUITY, PG_WCSPH_LINEAR},
      {"own", PG_WCSPH_OWN, PG_WCSPH_CONTINUITY, PG_WCSPH_LINEAR},
      {"and liquid by Eqs. 26 and 35 alone", PG_WCSPH_OWN, PG_WCSPH_SUMMATION, PG_WCSPH_LINEAR},
      {"mirror, Tait", PG_WCSPH_MIRROR, PG_WCSPH_CONTINUITY, PG_WCSPH_TAIT},
  };
  PetscReal h[3], error[3], last;

  (void)state;
  for (int k = 0; k < 5; k++) {
    char quantity[96];
    for (int r = 0; r < 3; r++) {
      h[r]     = 2.5 / (500 << r);
      error[r] = Drift(run[k].solid, run[k].density, run[k].state, 500 << r, &last);
    }
    (void)snprintf(quantity, sizeof quantity, "swirl in a box, walls %s: drift of the energy", run[k].what);
    VerifyOrder("wcsph energy", quantity, 3, h, error, 2.0, 0.3, "velocity Verlet; the operators are adjoint");
    if (!(error[0] < 2e-2)) fail_msg("%s: %g", quantity, (double)error[0]);
  }
  (void)Drift(PG_WCSPH_EXTRAPOLATED, PG_WCSPH_CONTINUITY, PG_WCSPH_LINEAR, 500, &last);
  VerifyRange("wcsph energy", "swirl in a box, walls extrapolated: energy left after 2.5 s", 0.2, 0.95, last,
              "as published, with any time step: the pressure of walls is adjoint to nothing");
}

/* ---- a body of 9 x 9 particles in a channel of nine ---- */

enum { SIDE = 9, LENGTH = 31, FIRST = 10 };

typedef struct {
  PetscReal x[2], v[2], start[2 * SIDE * SIDE];
} Body;

static PetscErrorCode Move(void *context, PetscInt count, const PetscInt body[], const PetscInt index[], PetscReal x[],
                           PetscReal v[])
{
  const Body *b = (const Body *)context;

  (void)body;
  for (PetscInt n = 0; n < count; n++)
    for (int d = 0; d < 2; d++) {
      x[2 * n + d] = b->x[d] + b->start[2 * index[n] + d];
      v[2 * n + d] = b->v[d];
    }
  return 0;
}

static PgWcsph Channel(PgWcsphSolid solid, Body *b)
{
  PgWcsph w;

  CHECK(PgWcsphCreate(PETSC_COMM_WORLD, &w));
  CHECK(PgWcsphSetSpacing(w, 0.02));
  CHECK(PgWcsphSetPeriodicX(w, 0.0, LENGTH * 0.02));
  CHECK(PgWcsphSetLiquid(w, 1000.0, 0.0, 0.2));
  CHECK(PgWcsphSetDiffusion(w, 0.0));
  CHECK(PgWcsphSetSolid(w, solid));
  CHECK(PgWcsphSetMotion(w, Move, b));
  for (int j = -LAYERS; j < SIDE + LAYERS; j++)
    for (int i = 0; i < LENGTH; i++) {
      const PetscBool inside = (PetscBool)(j >= 0 && j < SIDE);
      PgWcsphParticle p      = {.kind = PG_WCSPH_FLUID, .x = {(i + 0.5) * 0.02, (j + 0.5) * 0.02}};
      if (!inside) {
        p.kind = PG_WCSPH_WALL;
        p.body = j > 0;
      } else if (i >= FIRST && i < FIRST + SIDE) {
        p.kind  = PG_WCSPH_BODY;
        p.index = j * SIDE + i - FIRST;
        for (int d = 0; d < 2; d++) b->start[2 * p.index + d] = p.x[d];
      }
      CHECK(PgWcsphAddParticles(w, 1, &p));
    }
  CHECK(PgWcsphSetUp(w));
  return w;
}

static void Acceleration(PgWcsph w, PetscReal push, PetscReal mass, PetscReal a[2])
{
  PgWcsphSolids solids;

  CHECK(PgWcsphGetSolids(w, PG_WCSPH_BODY, &solids));
  a[0] = push / mass;
  a[1] = 0.0;
  for (PetscInt n = 0; n < solids.count; n++)
    for (int d = 0; d < 2; d++) a[d] += solids.force[2 * n + d] / mass;
}

typedef struct {
  PetscReal way, energy, impulse; /* over that of a rigid train, over work, over impulse */
} Push;

static Push PushBody(PgWcsphSolid solid)
{
  const PetscReal area = 0.02 * 0.02, mass = SIDE * SIDE * area * 2000.0, force = 1e-4, end = 40.0, dt = end / 1400;
  const PetscReal train = mass + SIDE * (LENGTH - SIDE) * area * 1000.0;
  PgWcsphTotals   totals;
  Body            b = {.x = {0, 0}};
  PgWcsph         w = Channel(solid, &b);
  PetscReal       a[2];
  Push            p;

  Acceleration(w, force, mass, a);
  for (int n = 0; n < 1400; n++) {
    CHECK(PgWcsphKick(w, 0.5 * dt));
    for (int d = 0; d < 2; d++) {
      b.v[d] += 0.5 * dt * a[d];
      b.x[d] += dt * b.v[d];
    }
    CHECK(PgWcsphDrift(w, dt));
    CHECK(PgWcsphForces(w));
    CHECK(PgWcsphKick(w, 0.5 * dt));
    Acceleration(w, force, mass, a);
    for (int d = 0; d < 2; d++) b.v[d] += 0.5 * dt * a[d];
  }
  CHECK(PgWcsphGetTotals(w, &totals));
  p.way     = b.x[0] / (0.5 * force * end * end / train);
  p.energy  = (totals.kinetic + totals.internal + 0.5 * mass * (b.v[0] * b.v[0] + b.v[1] * b.v[1])) / (force * b.x[0]);
  p.impulse = (totals.momentum[0] + mass * b.v[0]) / (force * end);
  CHECK(PgWcsphDestroy(&w));
  return p;
}

static void Locking(void **state)
{
  Push p = PushBody(PG_WCSPH_MIRROR);

  (void)state;
  VerifyValue("wcsph body in a channel", "energy over work, walls mirror", 1.0, p.energy, 0.0, 1e-4, "as in the box");
  VerifyValue("wcsph body in a channel", "momentum over impulse, walls mirror", 1.0, p.impulse, 0.0, 1e-4,
              "a plane wall takes nothing along itself");
  VerifyValue("wcsph body in a channel", "way over that of a rigid train, walls mirror", 1.0, p.way, 0.0, 0.02,
              "the liquid is compressed at the start, and its outer layers lag");
  p = PushBody(PG_WCSPH_ADJOINT);
  VerifyValue("wcsph body in a channel", "energy over work, walls adjoint", 1.0, p.energy, 0.0, 1e-4, "as in the box");
  VerifyReport("wcsph body in a channel", "momentum over impulse, walls adjoint", p.impulse,
               "the gradient of pressure along the walls pushes");
  p = PushBody(PG_WCSPH_EXTRAPOLATED);
  VerifyReport("wcsph body in a channel", "energy over work, walls extrapolated", p.energy, "made by the walls");
  VerifyReport("wcsph body in a channel", "momentum over impulse, walls extrapolated", p.impulse, "as with adjoint");
  p = PushBody(PG_WCSPH_OWN);
  VerifyValue("wcsph body in a channel", "energy over work, walls own", 1.0, p.energy, 0.0, 1e-4, "as in the box");
  VerifyRange("wcsph body in a channel", "way over that of a rigid train, walls own", 0.5, 0.9, p.way,
              "it sticks: the density of walls remembers what has slid along them");
}

/* ---- a piston: what a face loses where it ends at walls ---- */

/* Nine rows of liquid between a piston from the left and a wall; pushed by `force` and damped until it rests. */
static PgWcsph Cylinder(PgWcsphSolid solid, Body *b)
{
  PgWcsph w;

  CHECK(PgWcsphCreate(PETSC_COMM_WORLD, &w));
  CHECK(PgWcsphSetSpacing(w, 0.02));
  CHECK(PgWcsphSetLiquid(w, 1000.0, 0.1, 0.5));
  CHECK(PgWcsphSetSolid(w, solid));
  CHECK(PgWcsphSetDamping(w, 1.0, 1e3));
  CHECK(PgWcsphSetMotion(w, Move, b));
  for (int j = -LAYERS; j < SIDE + LAYERS; j++)
    for (int i = -SIDE - LAYERS; i < 12 + LAYERS; i++) {
      PgWcsphParticle p = {.kind = PG_WCSPH_FLUID, .x = {(i + 0.5) * 0.02, (j + 0.5) * 0.02}};
      if (j < 0 || j >= SIDE || i >= 12) {
        p.kind = PG_WCSPH_WALL;
      } else if (i < 0) {
        if (i < -SIDE) continue;
        p.kind  = PG_WCSPH_BODY;
        p.index = j * SIDE + i + SIDE;
        for (int d = 0; d < 2; d++) b->start[2 * p.index + d] = p.x[d];
      }
      CHECK(PgWcsphAddParticles(w, 1, &p));
    }
  CHECK(PgWcsphSetUp(w));
  return w;
}

static void Edges(void **state)
{
  static const char *const  what[]  = {"walls mirror", "walls adjoint"};
  static const PgWcsphSolid solid[] = {PG_WCSPH_MIRROR, PG_WCSPH_ADJOINT};
  const PetscReal           mass = SIDE * SIDE * 0.02 * 0.02 * 2000.0, force = 1e-3, height = SIDE * 0.02, dt = 0.012;

  (void)state;
  for (int k = 0; k < 2; k++) {
    Body      b = {.x = {0, 0}};
    PgWcsph   w = Cylinder(solid[k], &b);
    PetscReal a[2], p, epsilon, x[2] = {0.12, 0.5 * height};
    char      quantity[96];

    Acceleration(w, force, mass, a);
    for (int n = 0; n < 3000; n++) {
      CHECK(PgWcsphKick(w, 0.5 * dt));
      b.v[0] += 0.5 * dt * (a[0] - b.v[0]);
      b.x[0] += dt * b.v[0];
      CHECK(PgWcsphDrift(w, dt));
      CHECK(PgWcsphForces(w));
      CHECK(PgWcsphKick(w, 0.5 * dt));
      Acceleration(w, force, mass, a);
      b.v[0] += 0.5 * dt * (a[0] - b.v[0]);
    }
    CHECK(PgWcsphInterpolate(w, 1, x, &p, NULL, NULL));
    CHECK(PgWcsphGetEdge(w, &epsilon));
    (void)snprintf(quantity, sizeof quantity, "pressure behind a piston of nine particles over F/H, %s", what[k]);
    VerifyValue("wcsph piston", quantity, 1.0 / (1.0 - 2.0 * epsilon / height), p * height / force, 0.0, 2e-3,
                "T73 on the lattice of the start, which is compressed by 2.4e-5 and still settles");
    CHECK(PgWcsphDestroy(&w));
  }
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(Walls), cmocka_unit_test(Locking), cmocka_unit_test(Edges)};

int main(int argc, char *argv[])
{
  int failed;

  if (PgInitialize(&argc, &argv, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
