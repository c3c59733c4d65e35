/* ranks: 1 2 4 */
/* The critical time step: values, and that it is safe without being needlessly small. */
#include "dem_setup.h"

static const PgContactParameters paper = {
    .k_n = 6e8, .k_s = 4e8, .k_r = 2e3, .k_theta = 700, .mu_s = 0.5, .mu_r = 0.5, .mu_theta_r = 1e-4};

enum { COLUMNS = 9, ROWS = 9, N = COLUMNS * ROWS };

/* A hexagonal patch at this distance of centres, its rim held. */
static void Patch(PetscReal distance, PetscReal speed, Disc disc[N])
{
  uint64_t seed = 3;

  for (PetscInt k = 0; k < N; k++) {
    const PetscInt row = k / COLUMNS, column = k % COLUMNS;
    const PetscInt rim = row == 0 || row == ROWS - 1 || column == 0 || column == COLUMNS - 1;
    Disc          *d   = &disc[k];

    memset(d, 0, sizeof(*d));
    d->x     = distance * ((PetscReal)column + (row % 2 ? 0.5 : 0));
    d->y     = distance * 0.5 * PetscSqrtReal(3) * (PetscReal)row;
    d->r     = 5e-3;
    d->m     = PETSC_PI * d->r * d->r * 2000;
    d->plate = rim;
    d->vx    = rim ? 0 : speed * Random(&seed);
    d->vy    = rim ? 0 : speed * Random(&seed);
    d->w     = rim ? 0 : speed / d->r * Random(&seed);
  }
}

static void Start(World *world, const PgContactParameters *p, PetscInt count, const Disc disc[])
{
  const PgPlate rim = {.name = "rim", .hold = PETSC_TRUE};

  WorldCreate(PETSC_COMM_WORLD, world);
  CHECK(PgDemSetParameters(world->dem, p));
  CHECK(PgDemAddPlate(world->dem, &rim, NULL));
  WorldFill(world, count, disc);
}

static PetscReal Critical(const PgContactParameters *p, PetscInt count, const Disc disc[])
{
  PetscReal dt;
  World     world;

  Start(&world, p, count, disc);
  CHECK(PgDemCriticalTimeStep(world.dem, &dt));
  WorldDestroy(&world);
  return dt;
}

/* The lattice of the panel: 6 contacts share each disc; 36 (k_s + k_r)/m + 48 k_theta/(m r^2)/... written out
   below. Discs that touch exactly, whatever their rounding, count. */
static void PanelValue(void **state)
{
  const PetscReal r = 5e-3, m = PETSC_PI * r * r * 2000;
  const PetscReal omega2 = (paper.k_s + paper.k_r) * (12 / m + 24 / m) + paper.k_theta * 24 / (m * r * r);
  static Disc     disc[N];
  PetscReal       dt;

  (void)state;
  Patch(2 * r, 0, disc);
  dt = Critical(&paper, N, disc);
  assert_true(PetscAbsReal(dt / (2 / PetscSqrtReal(omega2)) - 1) < 1e-14); /* rounding */
  assert_true(PetscAbsReal(dt - 6.45e-6) < 0.01e-6);                       /* near 7e-6 s, known from runs */
}

/* Two discs: the stiffest of both modes, unequal inertia, dashpots of the same mode; the plate's spring. */
static void PairValues(void **state)
{
  const PetscReal r0 = 4e-3, r1 = 6e-3, m0 = 0.1, m1 = 0.23, G = 1 / m0 + 1 / m1;
  Disc disc[] = {{.x = 0.1, .y = 0.1, .r = r0, .m = m0}, {.x = 0.1 + r0 + r1 - 1e-6, .y = 0.1, .r = r1, .m = m1}};
  PgContactParameters p = {.k_n = 6e8, .k_s = 1e8};
  PetscReal           omega, zeta;

  (void)state;
  /* relative errors are a few roundings */
  assert_true(PetscAbsReal(Critical(&p, 2, disc) * PetscSqrtReal(6e8 * G) / 2 - 1) < 1e-14);
  p.c_n = 7000;
  omega = PetscSqrtReal(6e8 * G);
  zeta  = 7000 * G / (2 * omega);
  assert_true(zeta > 0.1);
  assert_true(PetscAbsReal(Critical(&p, 2, disc) * omega / (2 * (PetscSqrtReal(1 + zeta * zeta) - zeta)) - 1) < 1e-14);
  p.c_n     = 0;
  p.k_s     = 3e8;
  p.k_theta = 900;
  omega     = PetscSqrtReal(3e8 * 3 * G + 900 * 2 * (1 / (m0 * r0 * r0) + 1 / (m1 * r1 * r1)));
  assert_true(PetscAbsReal(Critical(&p, 2, disc) * omega / 2 - 1) < 1e-14);
  p.c_s     = 2000;
  p.c_theta = 0.01;
  zeta      = (2000 * 3 * G + 0.01 * 2 * (1 / (m0 * r0 * r0) + 1 / (m1 * r1 * r1))) / (2 * omega);
  assert_true(PetscAbsReal(Critical(&p, 2, disc) * omega / (2 * (PetscSqrtReal(1 + zeta * zeta) - zeta)) - 1) < 1e-14);
  p.c_s = p.c_theta = p.k_theta = 0;
  p.k_s                         = 1e8;
  disc[1].x += 1e-4; /* near, not touching: the pair of the list counts */
  assert_true(PetscAbsReal(Critical(&p, 2, disc) * PetscSqrtReal(6e8 * G) / 2 - 1) < 1e-14);
  disc[1].x += 0.1;
  assert_true(Critical(&p, 2, disc) == PETSC_MAX_REAL);
  disc[1].plate = 1;
  assert_true(PetscAbsReal(Critical(&p, 2, disc) * PetscSqrtReal(3e8 / m1) / 2 - 1) < 1e-14);
}

/* Exact contact counts as contact, a gap does not, once anything touches: discs 0 and 1 touch but for rounding,
   2 is near 1, and a heavy pair overlaps elsewhere. */
static void WhoTouches(void **state)
{
  const PetscReal           r = 5e-3, m = 0.1, G = 2 / m;
  const PgContactParameters p      = {.k_n = 6e8, .k_s = 1e8};
  const Disc                disc[] = {{.x = 0.1, .y = 0.1, .r = r, .m = m},
                                      {.x = 0.1 + 2 * r * 0.8, .y = 0.1 + 2 * r * 0.6 + 1e-14, .r = r, .m = m},
                                      {.x = 0.1 + 4 * r * 0.8, .y = 0.1 + 4 * r * 0.6 + 1e-4, .r = r, .m = m},
                                      {.x = 0.2, .y = 0.1, .r = r, .m = 10 * m},
                                      {.x = 0.2 + 1.999 * r, .y = 0.1, .r = r, .m = 10 * m}};

  (void)state;
  assert_true(PetscAbsReal(Critical(&p, 5, disc) * PetscSqrtReal(6e8 * G) / 2 - 1) < 1e-14); /* rounding */
}

/* A light pair among heavy ones decides wherever it is, also where its discs belong to two ranks: its ghost must
   come with its number of contacts. */
static void AcrossRanks(void **state)
{
  enum { PAIRS = 16 };
  const PetscReal           r = 5e-3, m = 0.1;
  const PgContactParameters p     = {.k_n = 6e8, .k_s = 1e8};
  PetscInt                  split = 0;
  PetscMPIInt               size;

  (void)state;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  for (PetscInt light = 0; light < PAIRS; light++) {
    Disc      disc[2 * PAIRS];
    PetscReal dt;
    PetscInt  ghosts;
    World     world;

    for (PetscInt k = 0; k < 2 * PAIRS; k++)
      disc[k] = (Disc){.x = 0.0257 * (PetscReal)(k / 2) + (k % 2 ? 1.999 * r : 0),
                       .y = 0.1,
                       .r = r,
                       .m = k / 2 == light ? m : 3 * m};
    Start(&world, &p, 2 * PAIRS, disc);
    CHECK(PgParticlesGetSizes(world.particles, NULL, &ghosts, NULL));
    CHECK(PgDemCriticalTimeStep(world.dem, &dt));
    assert_true(PetscAbsReal(dt * PetscSqrtReal(6e8 * 2 / m) / 2 - 1) < 1e-14); /* rounding */
    WorldDestroy(&world);
    split += ghosts;
  }
  MPI_Allreduce(MPI_IN_PLACE, &split, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD);
  assert_true(size == 1 || split > 0);
}

/* Largest kinetic energy over the first, in a compressed patch whose contacts neither open nor slip. */
static PetscReal Growth(PetscReal fraction, PetscInt steps)
{
  PgContactParameters p = paper;
  static Disc         disc[N];
  PetscReal           dt, first, energy, largest = 0;
  World               world;

  p.mu_s = p.mu_r = 1e6;
  p.mu_theta_r    = 1e3;
  Patch(9.99e-3, 1e-3, disc);
  Start(&world, &p, N, disc);
  CHECK(PgDemCriticalTimeStep(world.dem, &dt));
  CHECK(PgDemForces(world.dem, 0));
  CHECK(PgDemKineticEnergy(world.dem, &first));
  for (PetscInt k = 0; k < steps && largest < 1e6 * first; k++) {
    WorldStep(&world, fraction * dt);
    CHECK(PgDemKineticEnergy(world.dem, &energy));
    largest = PetscMax(largest, energy);
  }
  WorldDestroy(&world);
  return largest / first;
}

static void SafeAndTight(void **state)
{
  (void)state;
  /* All energy is kinetic at the start and stays below 1/(1 - (omega dt/2)^2) times that in each mode; the
     fastest mode is at 0.8 of the bound, which gives 1.7. Growth by 1 % in a step would make 1e8 of it. */
  assert_true(Growth(0.95, 2000) < 2);
  assert_true(Growth(1.6, 2000) > 1e6);
}

static int Tests(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(PanelValue), cmocka_unit_test(PairValues),
                                     cmocka_unit_test(WhoTouches), cmocka_unit_test(AcrossRanks),
                                     cmocka_unit_test(SafeAndTight)};

  return cmocka_run_group_tests_name("critical time step", tests, NULL, NULL);
}

int main(int argc, char *argv[]) { return RunTests(argc, argv, Tests); }
