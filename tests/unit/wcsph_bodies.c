/* ranks: 1 2 timeout: 120 */
/* The weakly compressible liquid as whoever owns bodies meets it: forces that are reactions, pressure at points, two
   bodies that meet, and what is refused. */
#include "ground.h"
#include <porograin/wcsph.h>

static const PetscReal dx = 0.02;

static PgWcsph Make(PetscReal mu)
{
  PgWcsph w;

  CHECK(PgWcsphCreate(PETSC_COMM_WORLD, &w));
  CHECK(PgWcsphSetSpacing(w, dx));
  CHECK(PgWcsphSetLiquid(w, 1000.0, mu, 2.0));
  return w;
}

static void Add(PgWcsph w, PgWcsphKind kind, PetscInt body, PetscInt index, PetscReal x, PetscReal y, PetscReal u,
                PetscReal v, PetscReal p)
{
  const PgWcsphParticle particle = {
      .kind = kind, .body = body, .index = index, .x = {x, y}, .v = {u, v}, .pressure = p};

  CHECK(PgWcsphAddParticles(w, 1, &particle));
}

static PetscReal SumForces(PgWcsph w, PetscReal *largest)
{
  PgParticles particles;
  PgField     field;
  PgExactSum  sum[2] = {{.not_finite = 0}};
  PetscReal  *force, value[2], most = 0.0;
  PetscInt    owned;

  CHECK(PgWcsphGetParticles(w, &particles));
  CHECK(PgParticlesFindField(particles, "force", &field));
  CHECK(PgParticlesGetArray(particles, field, &force));
  CHECK(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  for (PetscInt k = 0; k < 2 * owned; k++) {
    PgExactSumAdd(&sum[k % 2], force[k]);
    most = PetscMax(most, PetscAbsReal(force[k]));
  }
  CHECK(PgExactSumReduce(PETSC_COMM_WORLD, 2, sum, value));
  CHECK(MPI_Allreduce(&most, largest, 1, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  return PetscMax(PetscAbsReal(value[0]), PetscAbsReal(value[1]));
}

/* A body in a liquid in disorder between walls, periodic along x, everything in motion: all forces cancel, whatever the
   choices. */
static void Reactions(void **state)
{
  (void)state;
  for (int solid = PG_WCSPH_ADJOINT; solid <= PG_WCSPH_OWN; solid++) {
    PgWcsph   w    = Make(0.3);
    PetscReal most = 0.0, sum;
    CHECK(PgWcsphSetPeriodicX(w, 0.0, 20 * dx));
    CHECK(PgWcsphSetSolid(w, (PgWcsphSolid)solid));
    CHECK(PgWcsphSetContact(w, 1.5, PETSC_TRUE));
    for (int j = -4; j < 14; j++)
      for (int i = 0; i < 20; i++) {
        const PetscInt    n    = 20 * (j + 4) + i;
        const PgWcsphKind kind = j < 0 || j >= 10                            ? PG_WCSPH_WALL
                                 : j > 5 && i > 4 && i < 8 /* near a wall */ ? PG_WCSPH_BODY
                                                                             : PG_WCSPH_FLUID;
        Add(w, kind, j > 0, n, dx * (i + 0.5 + 0.2 * PgNoise(n, 0)), dx * (j + 0.5 + 0.2 * PgNoise(n, 1)),
            0.1 * PgNoise(n, 2), 0.1 * PgNoise(n, 3), 20.0 * PgNoise(n, 4));
      }
    CHECK(PgWcsphSetUp(w));
    CHECK(PgWcsphStep(w, 1e-4));
    sum = SumForces(w, &most);
    assert_true(most > 0.1);
    /* each of 360 forces is rounded after some 40 terms of its own size */
    NEAR(sum, 0.0, 1e-12 * most);
    CHECK(PgWcsphDestroy(&w));
  }
}

/* The pressure of rest, interpolated with the weight of what lies between; nothing where there is no liquid. */
static void AtPoints(void **state)
{
  const PetscReal g[2] = {0.0, -0.2}, x[8] = {0.2, 0.1, 0.013, 0.107, 0.2, 0.6, 0.1, 0.295};
  PetscReal       p[4], v[8], weight[4];
  PgWcsph         w = Make(0.0);
  PgWcsphSolids   walls;

  (void)state;
  CHECK(PgWcsphSetGravity(w, g));
  CHECK(PgWcsphSetPeriodicX(w, 0.0, 20 * dx));
  for (int j = -4; j < 15; j++)
    for (int i = 0; i < 20; i++)
      Add(w, j < 0 ? PG_WCSPH_WALL : PG_WCSPH_FLUID, 0, 0, dx * (i + 0.5), dx * (j + 0.5), 0.25, 0.0,
          200.0 * (0.3 - dx * (j + 0.5)));
  CHECK(PgWcsphSetUp(w));
  CHECK(PgWcsphInterpolate(w, 4, x, p, v, weight));
  /* rho differs by 1 % from what it was when the pressures were set: 3e-3 of 40 Pa is measured; the sum of V W varies by
     1e-3 between particles */
  NEAR(p[0], 200.0 * 0.2, 0.01);
  NEAR(p[1], 200.0 * 0.193, 0.01);
  NEAR(p[3], 200.0 * 0.005, 0.05); /* at the surface: all of the liquid is below */
  NEAR(weight[0], 1.0, 2e-3);
  NEAR(v[0], 0.25, 1e-14);
  NEAR(v[3], 0.0, 1e-14);
  assert_true(p[2] == 0.0 && weight[2] == 0.0 && v[4] == 0.0);
  CHECK(PgWcsphGetSolids(w, PG_WCSPH_WALL, &walls));
  for (PetscInt n = 0; n < walls.count; n++) /* further down no liquid is in reach; 1.5 % of what 7 cm of it weigh */
    if (walls.x[2 * n + 1] > -3.0 * dx) NEAR(walls.pressure[n], 200.0 * (0.3 - walls.x[2 * n + 1]), 0.2);
  CHECK(PgWcsphDestroy(&w));
}

/* ---- two bodies that meet ---- */

enum { SIDE = 5, BODIES = 2 };
typedef struct {
  PetscReal x[BODIES][2], v[BODIES][2], start[BODIES][SIDE * SIDE][2];
} Pair;

static PetscErrorCode Move(void *context, PetscInt count, const PetscInt body[], const PetscInt index[], PetscReal x[],
                           PetscReal v[])
{
  const Pair *pair = (const Pair *)context;

  for (PetscInt n = 0; n < count; n++)
    for (int d = 0; d < 2; d++) {
      x[2 * n + d] = pair->x[body[n]][d] + pair->start[body[n]][index[n]][d];
      v[2 * n + d] = pair->v[body[n]][d];
    }
  return 0;
}

static void Accelerations(PgWcsph w, PetscReal mass, PetscReal a[BODIES][2])
{
  PgExactSum    sum[2 * BODIES] = {{.not_finite = 0}};
  PetscReal     value[2 * BODIES];
  PgWcsphSolids solids;

  CHECK(PgWcsphGetSolids(w, PG_WCSPH_BODY, &solids));
  for (PetscInt n = 0; n < solids.count; n++)
    for (int d = 0; d < 2; d++) PgExactSumAdd(&sum[2 * solids.body[n] + d], solids.force[2 * n + d]);
  CHECK(PgExactSumReduce(PETSC_COMM_WORLD, 2 * BODIES, sum, value));
  for (int k = 0; k < 2 * BODIES; k++) a[k / 2][k % 2] = value[k] / mass;
}

/* Kinetic energy of translation after the bodies have met, over that before; *momentum over one body's. */
static PetscReal Collide(int steps, PetscReal *momentum)
{
  const PetscReal mass = SIDE * SIDE * dx * dx * 2000.0, speed = 0.02, dt = 6.0 / steps;
  Pair            pair = {.v = {{0.02, 0.0}, {-0.02, 0.0}}};
  PgWcsph         w    = Make(0.0);
  PetscReal       a[BODIES][2], energy = 0.0;

  CHECK(PgWcsphSetMotion(w, Move, &pair));
  for (int b = 0; b < BODIES; b++)
    for (int n = 0; n < SIDE * (SIDE - b); n++) { /* not alike, for a symmetry would hide errors */
      pair.start[b][n][0] = dx * (n % SIDE + 0.5) + b * (SIDE + 2) * dx; /* 2 dx apart, and out of line */
      pair.start[b][n][1] = dx * (n / SIDE + 0.5) + b * 0.3 * dx;
      Add(w, PG_WCSPH_BODY, b, n, pair.start[b][n][0], pair.start[b][n][1], pair.v[b][0], 0.0, 0.0);
    }
  CHECK(PgWcsphSetUp(w));
  Accelerations(w, mass, a);
  for (int n = 0; n < steps; n++) {
    for (int k = 0; k < 2 * BODIES; k++) {
      pair.v[k / 2][k % 2] += 0.5 * dt * a[k / 2][k % 2];
      pair.x[k / 2][k % 2] += dt * pair.v[k / 2][k % 2];
    }
    CHECK(PgWcsphDrift(w, dt));
    CHECK(PgWcsphForces(w));
    Accelerations(w, mass, a);
    for (int k = 0; k < 2 * BODIES; k++) pair.v[k / 2][k % 2] += 0.5 * dt * a[k / 2][k % 2];
  }
  assert_true(pair.v[0][0] < -0.01 && pair.v[1][0] > 0.01); /* they have met, and parted */
  *momentum = PetscAbsReal(pair.v[0][0] + pair.v[1][0]) / speed;
  for (int k = 0; k < 2 * BODIES; k++) energy += 0.5 * PetscSqr(pair.v[k / 2][k % 2]) / (speed * speed);
  CHECK(PgWcsphDestroy(&w));
  return energy;
}

static void Meeting(void **state)
{
  PetscReal momentum, coarse, fine;

  (void)state;
  coarse = PetscAbsReal(Collide(750, &momentum) - 1.0);
  /* sums of forces with exact opposites, rounded in each step */
  NEAR(momentum, 0.0, 1e-12);
  fine = PetscAbsReal(Collide(6000, &momentum) - 1.0);
  NEAR(momentum, 0.0, 1e-12);
  /* an energy of places alone: what is missing is the time step's, within c dt^2, c by where a step meets the kink of
     (T71): 7e-4 and 3e-5 are measured */
  NEAR(coarse, 0.0, 2e-3);
  NEAR(fine, 0.0, 2e-3 / 16.0);
}

/* ---- what is refused ---- */

static void Refused(void **state)
{
  const PetscReal nan = NAN;
  PgWcsph         w;
  PgWcsphParticle bad = {.kind = PG_WCSPH_FLUID, .x = {0.0, nan}};

  (void)state;
  CHECK(PgWcsphCreate(PETSC_COMM_WORLD, &w));
  assert_int_equal(PgWcsphSetSpacing(w, 0.0), PETSC_ERR_USER_INPUT);
  assert_int_equal(PgWcsphSetSpacing(w, nan), PETSC_ERR_USER_INPUT);
  assert_int_equal(PgWcsphSetLiquid(w, -1.0, 0.0, 1.0), PETSC_ERR_USER_INPUT);
  assert_int_equal(PgWcsphSetLiquid(w, 1.0, -1e-3, 1.0), PETSC_ERR_USER_INPUT);
  assert_int_equal(PgWcsphSetLiquid(w, 1.0, 0.0, nan), PETSC_ERR_USER_INPUT);
  assert_int_equal(PgWcsphSetKernel(w, "gauss", 1.2), PETSC_ERR_USER_INPUT);
  assert_int_equal(PgWcsphSetKernel(w, "cubic_spline", 0.5), PETSC_ERR_USER_INPUT);
  assert_int_equal(PgWcsphSetDiffusion(w, 1.5), PETSC_ERR_USER_INPUT);
  assert_int_equal(PgWcsphSetContact(w, -1.0, PETSC_FALSE), PETSC_ERR_USER_INPUT);
  CHECK(PgWcsphSetSpacing(w, dx));
  assert_int_equal(PgWcsphAddParticles(w, 1, &bad), PETSC_ERR_USER_INPUT);
  assert_int_equal(PgWcsphSetUp(w), PETSC_ERR_USER_INPUT); /* there is no particle */
  CHECK(PgWcsphDestroy(&w));
  w = Make(0.0); /* two particles at one place */
  for (int i = 0; i < 12; i++) Add(w, PG_WCSPH_FLUID, 0, 0, dx * (i % 11), 0.0, 0.0, 0.0, 0.0);
  assert_int_equal(PgWcsphSetUp(w), PETSC_ERR_USER_INPUT);
  CHECK(PgWcsphDestroy(&w));
  w = Make(0.0); /* a liquid that has been torn to a quarter of its density */
  CHECK(PgWcsphSetDensity(w, PG_WCSPH_SUMMATION));
  for (int i = 0; i < 12; i++) Add(w, PG_WCSPH_FLUID, 0, 0, 2.0 * dx * i, 0.0, 0.0, 0.0, 0.0);
  assert_int_equal(PgWcsphSetUp(w), PETSC_ERR_NOT_CONVERGED);
  CHECK(PgWcsphDestroy(&w));
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(Reactions), cmocka_unit_test(AtPoints),
                                          cmocka_unit_test(Meeting), cmocka_unit_test(Refused)};

GROUND_MAIN(tests, PETSC_TRUE)
