/* ranks: 1 2 4 */
/* Where discs and their ghosts are after a distribution, against a search through all discs. */
#include "particles_discs.h"

static const Cloud     cloud  = {700, {-0.3, 0.2}, {1.0, 0.7}, 0.02};
static const PetscReal period = 1.0; /* [m], the width of the cloud */

static PgParticles CreateParticles(PetscBool periodic)
{
  PgParticles particles;

  OK(PgParticlesCreate(PETSC_COMM_WORLD, &particles));
  OK(PgParticlesSetFromOptions(particles));
  if (periodic) OK(PgParticlesSetPeriodicX(particles, cloud.low[0], cloud.low[0] + period));
  return particles;
}

/* Every disc or image within `width` of an owned disc is here, as owned disc or as ghost, none of them twice;
   ghosts hold their owner's values bit by bit. */
static void CheckGhosts(PgParticles particles, PetscReal width, PetscReal length)
{
  PetscReal      *x = GatherAll(particles, PG_POSITION), *v = GatherAll(particles, PG_VELOCITY);
  PetscReal      *r = GatherAll(particles, PG_RADIUS), *position, *velocity, *radius;
  const PetscInt *id;
  PetscInt        owned, ghosts, N, *here;
  const int       images = length > 0 ? 1 : 0;

  OK(PgParticlesGetSizes(particles, &owned, &ghosts, &N));
  OK(PgParticlesGetIds(particles, &id));
  OK(PgParticlesGetArray(particles, PG_POSITION, &position));
  OK(PgParticlesGetArray(particles, PG_VELOCITY, &velocity));
  OK(PgParticlesGetArray(particles, PG_RADIUS, &radius));
  OK(PetscCalloc1(3 * N, &here));
  for (PetscInt i = 0; i < owned + ghosts; i++) {
    const PetscInt j     = id[i];
    const int      image = i < owned ? 0 : ImageOf(position[2 * i], x[2 * j], length);
    assert_in_range(image + 1, 0, 2);
    assert_int_equal((int)here[3 * j + image + 1], 0);
    here[3 * j + image + 1] = 1;
    assert_true(position[2 * i] == (image ? x[2 * j] + image * length : x[2 * j]));
    assert_true(position[2 * i + 1] == x[2 * j + 1]);
    assert_true(velocity[2 * i] == v[2 * j] && velocity[2 * i + 1] == v[2 * j + 1]);
    assert_true(radius[i] == r[j]);
  }
  for (PetscInt i = 0; i < owned; i++) {
    for (PetscInt j = 0; j < N; j++) {
      for (int image = -images; image <= images; image++) {
        const PetscReal dx = x[2 * j] + image * length - position[2 * i], dy = x[2 * j + 1] - position[2 * i + 1];
        if (dx * dx + dy * dy < width * width) assert_int_equal((int)here[3 * j + image + 1], 1);
      }
    }
  }
  OK(PetscFree(here));
  OK(PetscFree(x));
  OK(PetscFree(v));
  OK(PetscFree(r));
}

/* Owned discs are numbered through the ranks, ghosts carry their owner's number. */
static void CheckGlobalIndices(PgParticles particles)
{
  const PetscInt *id, *index;
  PetscInt        owned, ghosts, N, start, end, *number;

  OK(PgParticlesGetSizes(particles, &owned, &ghosts, &N));
  OK(PgParticlesGetIds(particles, &id));
  OK(PgParticlesGetGlobalIndices(particles, &start, &index));
  OK(MPI_Scan(&owned, &end, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  assert_int_equal((int)start, (int)(end - owned));
  OK(PetscCalloc1(N, &number));
  for (PetscInt i = 0; i < owned; i++) number[id[i]] = end - owned + i;
  OK(MPI_Allreduce(MPI_IN_PLACE, number, (int)N, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  for (PetscInt i = 0; i < owned + ghosts; i++) assert_int_equal((int)index[i], (int)number[id[i]]);
  OK(PetscFree(number));
}

/* Values that depend on the id alone are still with their disc. */
static void CheckValues(PgParticles particles)
{
  PetscReal *v = GatherAll(particles, PG_VELOCITY), *r = GatherAll(particles, PG_RADIUS);
  PetscReal *m = GatherAll(particles, PG_MASS);
  PetscInt   N;

  OK(PgParticlesGetSizes(particles, NULL, NULL, &N));
  for (PetscInt j = 0; j < N; j++) {
    assert_true(v[2 * j] == Draw(j, 3) - 0.5 && v[2 * j + 1] == Draw(j, 4) - 0.5);
    assert_true(r[j] == cloud.r * (0.5 + Draw(j, 5)));
    assert_true(m[j] == 1 + Draw(j, 6));
  }
  OK(PetscFree(v));
  OK(PetscFree(r));
  OK(PetscFree(m));
}

static void Walk(PetscBool periodic)
{
  const PetscReal width     = 0.083;
  PgParticles     particles = CreateParticles(periodic);

  CreateCloud(&cloud, particles);
  for (unsigned step = 0; step < 6; step++) {
    if (step == 3) OK(PgParticlesForceMigration(particles, 1));
    OK(PgParticlesDistribute(particles, step == 5 ? 1.3 * width : width));
    CheckValues(particles);
    CheckGlobalIndices(particles);
    CheckGhosts(particles, step == 5 ? 1.3 * width : width, periodic ? period : 0);
    MoveDiscs(particles, 0.05, step);
  }
  OK(PgParticlesDestroy(&particles));
}

static void discs_walk(void **state)
{
  (void)state;
  Walk(PETSC_FALSE);
}

static void discs_walk_round(void **state)
{
  (void)state;
  Walk(PETSC_TRUE);
}

/* Discs far outside the grid belong to its edge cells. */
static void strays_are_kept(void **state)
{
  const PetscReal width     = 0.083;
  PgParticles     particles = CreateParticles(PETSC_FALSE);
  const PetscInt *id;
  PetscInt        owned;
  PetscReal      *position;

  (void)state;
  CreateCloud(&cloud, particles);
  OK(PgParticlesDistribute(particles, width));
  for (int round = 0; round < 2; round++) { /* by a little more than the margin; then so far that the grid follows */
    OK(PgParticlesGetSizes(particles, &owned, NULL, NULL));
    OK(PgParticlesGetIds(particles, &id));
    OK(PgParticlesGetArray(particles, PG_POSITION, &position));
    for (PetscInt i = 0; i < owned; i++) {
      if (id[i] % 5 == 3) position[2 * i] += round ? 3.0 : 0.3;
      if (id[i] % 5 == 4) position[2 * i + 1] -= round ? 2.0 : 0.2;
    }
    OK(PgParticlesDistribute(particles, width));
    CheckGhosts(particles, width, 0);
  }
  OK(PgParticlesDestroy(&particles));
}

/* Wrapped position and crossings together are the unwrapped position. */
static void crossings_are_counted(void **state)
{
  PgParticles particles = CreateParticles(PETSC_TRUE);
  PetscReal   unwrapped[2 * 700], *x, *turns;
  PgField     crossings;
  PetscInt    largest = 0;

  (void)state;
  CreateCloud(&cloud, particles);
  OK(PgParticlesFindField(particles, "crossings", &crossings));
  assert_int_not_equal((int)crossings, -1);
  x = GatherAll(particles, PG_POSITION);
  OK(PetscArraycpy(unwrapped, x, 2 * cloud.N));
  OK(PetscFree(x));
  for (unsigned step = 0; step < 8; step++) {
    MoveDiscs(particles, 0.9, step);
    for (PetscInt j = 0; j < cloud.N; j++) {
      for (unsigned d = 0; d < 2; d++) unwrapped[2 * j + d] += 0.9 * (2 * Draw(j, 100 + 2 * step + d) - 1);
    }
    OK(PgParticlesDistribute(particles, 0.083));
    x     = GatherAll(particles, PG_POSITION);
    turns = GatherAll(particles, crossings);
    for (PetscInt j = 0; j < cloud.N; j++) {
      assert_true(x[2 * j] >= cloud.low[0] && x[2 * j] < cloud.low[0] + period);
      /* a few roundings of numbers below 8 */
      assert_true(PetscAbsReal(x[2 * j] + turns[j] * period - unwrapped[2 * j]) < 100 * PETSC_MACHINE_EPSILON);
      largest = PetscMax(largest, (PetscInt)PetscAbsReal(turns[j]));
    }
    OK(PetscFree(x));
    OK(PetscFree(turns));
  }
  assert_true(largest >= 2);
  OK(PgParticlesDestroy(&particles));
}

static void short_period_is_refused(void **state)
{
  PgParticles particles = CreateParticles(PETSC_TRUE);

  (void)state;
  CreateCloud(&cloud, particles);
  ASSERT_FAILS(PgParticlesDistribute(particles, 0.34), PETSC_ERR_USER_INPUT,
               "the period of 1 m in x must hold at least three cells of width 0.34 m");
  OK(PgParticlesDistribute(particles, 0.33));
  CheckGhosts(particles, 0.33, period);
  OK(PgParticlesDestroy(&particles));
}

static void bad_position_is_named(void **state)
{
  PgParticles     particles = CreateParticles(PETSC_FALSE);
  const PetscInt *id;
  PetscInt        owned;
  PetscReal      *position;

  (void)state;
  CreateCloud(&cloud, particles);
  OK(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  OK(PgParticlesGetIds(particles, &id));
  OK(PgParticlesGetArray(particles, PG_POSITION, &position));
  for (PetscInt i = 0; i < owned; i++) {
    if (id[i] == 431) position[2 * i + 1] = NAN;
  }
  ASSERT_FAILS(PgParticlesDistribute(particles, 0.083), PETSC_ERR_NOT_CONVERGED,
               "the position of particle 431 is not finite");
  OK(PgParticlesDestroy(&particles));
}

/* Fewer discs than ranks, and none at all. */
static void few_discs(void **state)
{
  const Cloud three     = {3, {0.1, 0.2}, {0.03, 0.05}, 0.02};
  PgParticles particles = CreateParticles(PETSC_FALSE);

  (void)state;
  CreateCloud(&three, particles);
  for (int shift = 0; shift < 5; shift++) {
    OK(PgParticlesForceMigration(particles, shift));
    OK(PgParticlesDistribute(particles, 0.06));
    CheckGhosts(particles, 0.06, 0);
    CheckGlobalIndices(particles);
  }
  OK(PgParticlesSetDiscs(particles, 0, NULL));
  OK(PgParticlesDistribute(particles, 0.06));
  OK(PgParticlesDestroy(&particles));
}

static void ForcedLoads(PgParticles particles, PetscInt loads[])
{
  PetscInt owned;

  OK(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  OK(MPI_Allgather(&owned, 1, MPIU_INT, loads, 1, MPIU_INT, PETSC_COMM_WORLD));
}

static PetscInt LargestLoad(PgParticles particles)
{
  PetscInt owned, largest;

  OK(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  OK(MPI_Allreduce(&owned, &largest, 1, MPIU_INT, MPI_MAX, PETSC_COMM_WORLD));
  return largest;
}

/* Crowded on the left: pieces of equal area would be far from equal loads. */
static void load_is_balanced(void **state)
{
  const Cloud many      = {5000, {0, 0}, {1.0, 0.6}, 0.003};
  PgParticles particles = CreateParticles(PETSC_FALSE);
  PetscInt    owned, largest, worst = 0, cuts, before[64], after[64];
  PetscMPIInt size;
  PetscReal  *position, told;

  (void)state;
  OK(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  CreateCloud(&many, particles);
  OK(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  OK(PgParticlesGetArray(particles, PG_POSITION, &position));
  for (PetscInt i = 0; i < owned; i++) position[2 * i] *= position[2 * i];
  OK(PgParticlesDistribute(particles, 0.012));
  for (int round = 0; round < 2; round++) {
    OK(PgParticlesGetSizes(particles, &owned, NULL, NULL));
    largest = LargestLoad(particles);
    worst   = PetscMax(worst, largest);
    assert_true((PetscReal)largest < 1.1 * (PetscReal)many.N / size);
    /* all crowd together on the right: the cuts have to follow, one distribution later */
    OK(PgParticlesGetArray(particles, PG_POSITION, &position));
    for (PetscInt i = 0; i < owned; i++) position[2 * i] = 1 - (1 - position[2 * i]) * 0.6;
    for (int again = 0; again < 2; again++) {
      OK(PgParticlesDistribute(particles, 0.012));
      worst = PetscMax(worst, LargestLoad(particles));
    }
  }
  /* what it tells is what was seen: between the crowding and the cut that follows one rank has far too much */
  OK(PgParticlesGetBalance(particles, &told, &cuts));
  assert_true(told == (PetscReal)worst * size / (PetscReal)many.N);
  assert_true(size == 1 ? told == 1.0 : told > 1.1 && cuts > 1);
  ForcedLoads(particles, before);
  OK(PgParticlesForceMigration(particles, 1));
  OK(PgParticlesDistribute(particles, 0.012));
  ForcedLoads(particles, after);
  /* Rank r has the piece of rank r + 1. The cut is new; on the same discs and grid it is the same. */
  for (int r = 0; r < size; r++) assert_int_equal((int)after[r], (int)before[(r + 1) % size]);
  OK(PgParticlesDestroy(&particles));
}

/* The revision tells when the numbering has changed, and only then. */
static void revision_means_change(void **state)
{
  PgParticles particles;
  PetscInt    first, second, third;
  PetscMPIInt size;

  (void)state;
  OK(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  for (int periodic = 0; periodic < 2; periodic++) {
    OK(PetscOptionsSetValue(NULL, "-particles_sort_every", "1000000"));
    particles = CreateParticles((PetscBool)periodic);
    CreateCloud(&cloud, particles);
    OK(PgParticlesDistribute(particles, 0.083));
    OK(PgParticlesGetRevision(particles, &first));
    OK(PgParticlesDistribute(particles, 0.083));
    OK(PgParticlesGetRevision(particles, &second));
    assert_int_equal((int)first, (int)second);
    MoveDiscs(particles, 0.05, 0);
    OK(PgParticlesDistribute(particles, 0.083));
    OK(PgParticlesGetRevision(particles, &third));
    if (size == 1 && !periodic)
      assert_int_equal((int)second, (int)third);
    else
      assert_int_not_equal((int)second, (int)third);
    CheckGhosts(particles, 0.083, periodic ? period : 0);
    OK(PgParticlesDestroy(&particles));
    OK(PetscOptionsClearValue(NULL, "-particles_sort_every"));
    particles = CreateParticles((PetscBool)periodic);
    CreateCloud(&cloud, particles);
    OK(PgParticlesDistribute(particles, 0.083));
    OK(PgParticlesGetRevision(particles, &first));
    MoveDiscs(particles, 0.05, 0);
    OK(PgParticlesDistribute(particles, 0.083));
    OK(PgParticlesGetRevision(particles, &second));
    assert_int_not_equal((int)first, (int)second);
    OK(PgParticlesDestroy(&particles));
  }
}

/* Arrivals find their place along the curve even where sorting is not due. */
static void migration_sorts(void **state)
{
  PgParticles     often = CreateParticles(PETSC_FALSE), seldom;
  const PetscInt *a, *b;
  PetscInt        owned, same;
  PetscMPIInt     size;

  (void)state;
  OK(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  OK(PetscOptionsSetValue(NULL, "-particles_sort_every", "1000000"));
  seldom = CreateParticles(PETSC_FALSE);
  OK(PetscOptionsClearValue(NULL, "-particles_sort_every"));
  CreateCloud(&cloud, often);
  CreateCloud(&cloud, seldom);
  for (int round = 0; round < 2; round++) {
    OK(PgParticlesDistribute(often, 0.083));
    OK(PgParticlesDistribute(seldom, 0.083));
    OK(PgParticlesGetSizes(often, &owned, NULL, NULL));
    OK(PgParticlesGetSizes(seldom, &same, NULL, NULL));
    assert_int_equal((int)owned, (int)same);
    OK(PgParticlesGetIds(often, &a));
    OK(PgParticlesGetIds(seldom, &b));
    for (PetscInt i = 0; i < owned; i++) assert_int_equal((int)a[i], (int)b[i]);
    if (size == 1) break; /* nobody migrates */
    MoveDiscs(often, 0.05, 0);
    MoveDiscs(seldom, 0.05, 0);
    OK(PgParticlesForceMigration(often, 1));
    OK(PgParticlesForceMigration(seldom, 1));
  }
  OK(PgParticlesDestroy(&often));
  OK(PgParticlesDestroy(&seldom));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(discs_walk),
    cmocka_unit_test(discs_walk_round),
    cmocka_unit_test(strays_are_kept),
    cmocka_unit_test(crossings_are_counted),
    cmocka_unit_test(short_period_is_refused),
    cmocka_unit_test(bad_position_is_named),
    cmocka_unit_test(few_discs),
    cmocka_unit_test(load_is_balanced),
    cmocka_unit_test(revision_means_change),
    cmocka_unit_test(migration_sorts),
};

TEST_MAIN(tests)
