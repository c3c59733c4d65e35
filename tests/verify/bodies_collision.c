/* ranks: 1 2 */
/* Two bodies that collide with nothing between them but the repulsion of their embedded particles (Tak, Park & Park 2013:
   the search for neighbours is the detection of contacts): momentum, angular momentum, energy, on any number of ranks. */
#include "verify.h"
#include <math.h>
#include <porograin/bodies.h>

typedef struct {
  PetscReal momentum, angular, energy, parting, nearest, elastic, way[4];
} Outcome;

static void Sum(PgBodies b, PetscReal *px, PetscReal *py, PetscReal *angular, PetscReal *energy, PetscReal *elastic)
{
  *px = *py = *angular = *energy = *elastic = 0;
  for (PetscInt k = 0; k < 2; k++) {
    PgBodyState s;
    CHECK(PgBodiesGet(b, k, &s));
    *px += s.mass * s.velocity[0];
    *py += s.mass * s.velocity[1];
    *angular += s.angular;
    *energy += s.kinetic + s.elastic;
    *elastic += s.elastic;
  }
}

/* Squares of 0.2 m approach with 0.02 m/s; the second stands higher by `offset`. */
static Outcome Collide(MPI_Comm comm, PgBodyKind kind, PetscReal offset, PetscReal dt)
{
  const PetscReal  L = 0.2, gap = 0.01, speed = 0.02, dx = 0.02;
  const PgBodyMesh like     = {.kind = kind, .E = 3e5, .nu = 0.3, .rho = 1000};
  const PetscInt   cells[2] = {kind == PG_BODY_RIGID ? 1 : 3, kind == PG_BODY_RIGID ? 1 : 3};
  const PetscInt   steps    = (PetscInt)(2.4 / dt + 0.5);
  PetscReal        px, py, angular, energy, elastic, end[3], most = 0;
  Outcome          o = {.nearest = gap};
  PgBodyState      s[2];
  PgBodies         b;
  PgWcsph          w;

  CHECK(PgBodiesCreate(comm, &b));
  CHECK(PgWcsphCreate(comm, &w));
  CHECK(PgWcsphSetSpacing(w, dx));
  CHECK(PgWcsphSetLiquid(w, 1000, 0, 1));
  for (PetscInt k = 0; k < 2; k++) {
    const PetscReal low[2] = {k ? L + gap : 0, k ? offset : 0}, high[2] = {low[0] + L, low[1] + L};
    const PetscReal v[2] = {k ? -0.5 * speed : 0.5 * speed, 0};
    CHECK(PgBodiesAddBox(b, &like, cells, low, high, NULL));
    CHECK(PgBodiesEmbedLattice(b, k, dx));
    CHECK(PgBodiesSetVelocity(b, k, v, 0));
  }
  CHECK(PgBodiesJoin(b, w));
  CHECK(PgWcsphSetUp(w));
  CHECK(PgBodiesCouple(b, w));
  Sum(b, &px, &py, &angular, &energy, &elastic);
  for (PetscInt k = 0; k < steps; k++) {
    CHECK(PgBodiesKickDrift(b, dt));
    CHECK(PgWcsphKick(w, 0.5 * dt));
    CHECK(PgWcsphDrift(w, dt));
    CHECK(PgWcsphForces(w));
    CHECK(PgBodiesCouple(b, w));
    CHECK(PgBodiesKick(b, dt));
    CHECK(PgWcsphKick(w, 0.5 * dt));
    Sum(b, &end[0], &end[1], &end[2], &o.energy, &elastic);
    most      = PetscMax(most, hypot(end[0] - px, end[1] - py));
    o.angular = PetscMax(o.angular, PetscAbsReal(end[2] - angular));
    o.elastic = elastic;
    for (PetscInt i = 0; i < 2; i++) CHECK(PgBodiesGet(b, i, &s[i]));
    o.nearest = PetscMin(o.nearest, s[1].centre[0] - s[0].centre[0] - L);
  }
  for (PetscInt i = 0; i < 2; i++)
    for (int d = 0; d < 2; d++) o.way[2 * i + d] = s[i].centre[d];
  o.momentum = most / (1000 * L * L * speed);
  o.angular /= 1000 * L * L * L * speed;
  o.energy  = o.energy / energy - 1;
  o.parting = s[1].velocity[0] - s[0].velocity[0];
  CHECK(PgWcsphDestroy(&w));
  CHECK(PgBodiesDestroy(&b));
  return o;
}

static void HeadOn(void **state)
{
  static const PetscReal   dt[3]   = {8e-3, 2e-3, 5e-4};
  static const char *const name[3] = {"head on, dt 8e-3 s: kinetic energy after over before, less 1",
                                      "head on, dt 2e-3 s: kinetic energy after over before, less 1",
                                      "head on, dt 5e-4 s: kinetic energy after over before, less 1"};
  PetscReal                energy[3];
  Outcome                  o = {0};

  (void)state;
  for (int k = 0; k < 3; k++) {
    o         = Collide(PETSC_COMM_WORLD, PG_BODY_RIGID, 0, dt[k]);
    energy[k] = PetscAbsReal(o.energy);
    VerifyReport("bodies collision", name[k], o.energy, "velocity Verlet");
  }
  /* forces on two particles are opposite to the bit; what is left is the rounding of sums over particles, nodes, steps */
  VerifyValue("bodies collision", "head on: change of momentum over m v", 0, o.momentum, 1, 1e-13, "rounding");
  VerifyValue("bodies collision", "head on: change of angular momentum over m v L", 0, o.angular, 1, 1e-13, "rounding");
  /* the force sets in with a kink, at which Verlet errs by a part of a step: second order, not smoothly so; (omega dt)^2/8
     with a contact of 0.6 s is 8.6e-7 at 5e-4 s */
  VerifyValue("bodies collision", "head on: energy, dt 5e-4 s", 1, 1 + o.energy, 0, 1e-5, "velocity Verlet, a kink");
  assert_true(energy[1] < 0.25 * energy[0] && energy[2] < 0.25 * energy[1]);
  VerifyValue("bodies collision", "head on: speed of parting over that of closing", 1, o.parting / 0.02, 0, 1e-5,
              "no energy is lost");
  /* half of the gap of the start is past, and they overlap by less than half a spacing */
  VerifyRange("bodies collision", "head on: smallest gap of the faces [m]", -0.01, 0.005, o.nearest,
              "repulsion of a liquid with c_0 = 1 m/s");
}

static void OffCentre(void **state)
{
  const Outcome o = Collide(PETSC_COMM_WORLD, PG_BODY_RIGID, 0.03, 2e-3);

  (void)state;
  VerifyValue("bodies collision", "off centre: change of momentum over m v", 0, o.momentum, 1, 1e-13, "rounding");
  VerifyValue("bodies collision", "off centre: change of angular momentum over m v L", 0, o.angular, 1, 1e-13,
              "rounding: forces are along the line of centres");
  VerifyValue("bodies collision", "off centre: energy, dt 2e-3 s", 1, 1 + o.energy, 0, 1e-3, "velocity Verlet, a kink");
}

static void Deformable(void **state)
{
  const Outcome o = Collide(PETSC_COMM_WORLD, PG_BODY_FINITE, 0.03, 2e-3);

  (void)state;
  VerifyValue("bodies collision", "deformable: change of momentum over m v", 0, o.momentum, 1, 1e-12, "rounding");
  VerifyValue("bodies collision", "deformable: change of angular momentum over m v L", 0, o.angular, 1, 1e-11,
              "rounding");
  VerifyValue("bodies collision", "deformable: kinetic and elastic energy", 1, 1 + o.energy, 0, 1e-3,
              "own steps inside of a step");
  assert_true(o.elastic > 0);
}

/* The same bits on any number of ranks: all of them together, and each for itself. */
static void Ranks(void **state)
{
  const Outcome all  = Collide(PETSC_COMM_WORLD, PG_BODY_FINITE, 0.03, 8e-3);
  const Outcome self = Collide(PETSC_COMM_SELF, PG_BODY_FINITE, 0.03, 8e-3);

  (void)state;
  assert_memory_equal(all.way, self.way, sizeof all.way);
  assert_true(all.energy == self.energy);
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(HeadOn), cmocka_unit_test(OffCentre),
                                          cmocka_unit_test(Deformable), cmocka_unit_test(Ranks)};

int main(int argc, char *argv[])
{
  int failed;

  PetscCall(PgInitialize(&argc, &argv, "verification"));
  PetscCall(PetscSetFPTrap(PETSC_FP_TRAP_ON));
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
