/* ranks: 1 2 4 */
/* Both pair lists against a search through all pairs. */
#include "particles_discs.h"

static const Cloud     cloud  = {600, {-0.3, 0.2}, {1.0, 0.7}, 0.014};
static const PetscReal period = 1.0, wide = 3.5, narrow = 1.5;

typedef enum { CONTACT, ROW } Kind;

static PetscReal Skin(const PetscReal r[], PetscInt N)
{
  PetscReal sum = 0;

  for (PetscInt j = 0; j < N; j++) sum += r[j];
  return 0.2 * sum / (PetscReal)N;
}

/* Partners of the owned disc `id` at x, in ascending id: the place of each, by id and image. */
static PetscInt Expected(Kind kind, const PetscReal x[], const PetscReal r[], PetscInt N, PetscReal skin, PetscInt id,
                         PetscReal length, PetscInt partner[], PetscReal at[])
{
  const int images = length > 0 ? 1 : 0;
  PetscInt  n      = 0;

  for (PetscInt j = 0; j < N; j++) {
    for (int image = -images; image <= images; image++) {
      const PetscReal xj = image ? x[2 * j] + image * length : x[2 * j];
      const PetscReal dx = xj - x[2 * id], dy = x[2 * j + 1] - x[2 * id + 1];
      const PetscReal big = PetscMax(r[j], r[id]), small = PetscMin(r[j], r[id]);
      const PetscReal reach = (kind == CONTACT ? r[j] + r[id] : wide * big + narrow * small) + skin;
      if ((j == id && image == 0) || dx * dx + dy * dy >= reach * reach) continue;
      partner[n] = j;
      at[n++]    = xj;
    }
  }
  return n;
}

/* Order and padding of the contact list, and each owned disc's pairs. Returns their number. */
static PetscInt CheckContacts(PgParticles particles, PgNeighbors neighbors, const PetscReal x[], const PetscReal r[],
                              PetscReal skin, PetscReal length)
{
  PgContactList   list;
  const PetscInt *id;
  PetscInt        owned, N, *partner;
  PetscReal      *position, *at;

  OK(PgParticlesGetSizes(particles, &owned, NULL, &N));
  OK(PgParticlesGetIds(particles, &id));
  OK(PgParticlesGetArray(particles, PG_POSITION, &position));
  OK(PgNeighborsGetContacts(neighbors, &list));
  assert_true(list.padded % 8 == 0 && list.padded >= list.count && list.padded < list.count + 8);
  for (PetscInt p = 0; p < list.padded; p++) {
    const PetscBool both = (PetscBool)(list.low[p] < owned && list.high[p] < owned);
    if (p >= list.count) {
      assert_int_equal((int)list.low[p], (int)list.low[list.count - 1]);
      assert_int_equal((int)list.high[p], (int)list.high[list.count - 1]);
      continue;
    }
    assert_true(id[list.low[p]] < id[list.high[p]]);
    assert_true(list.low[p] < owned || list.high[p] < owned);
    assert_int_equal((int)both, p < list.interior);
  }
  OK(PetscMalloc2(3 * N, &partner, 3 * N, &at));
  for (PetscInt i = 0; i < owned; i++) {
    const PetscInt n = Expected(CONTACT, x, r, N, skin, id[i], length, partner, at);
    assert_int_equal((int)(list.ptr[i + 1] - list.ptr[i]), (int)n);
    for (PetscInt k = 0; k < n; k++) {
      const PetscInt entry = list.sum[list.ptr[i] + k], p = entry / 2;
      const PetscInt me = entry % 2 ? list.high[p] : list.low[p], other = entry % 2 ? list.low[p] : list.high[p];
      assert_in_range(p, 0, list.count - 1);
      assert_int_equal((int)me, (int)i);
      assert_int_equal((int)id[other], (int)partner[k]);
      assert_true(position[2 * other] == at[k]);
    }
  }
  assert_int_equal((int)list.ptr[0], 0);
  assert_int_equal((int)list.ptr[owned], (int)(list.interior + list.count));
  OK(PetscFree2(partner, at));
  return list.ptr[owned];
}

/* Every entry belongs to one pair, at the end that its row and column say. */
static void CheckEnds(const PgRowList *list, PetscInt owned)
{
  const PetscInt entries = list->ptr[owned];
  PetscInt      *row, *met;

  OK(PetscMalloc2(entries + 1, &row, entries + 1, &met));
  OK(PetscArrayzero(met, entries + 1));
  for (PetscInt i = 0; i < owned; i++)
    for (PetscInt k = list->ptr[i]; k < list->ptr[i + 1]; k++) row[k] = i;
  for (PetscInt q = 0; q < list->pairs; q++) {
    const PetscInt a = list->one_at[q], b = list->two_at[q];
    assert_true(a < entries && row[a] == list->one[q] && list->col[a] == list->two[q]);
    met[a]++;
    if (list->two[q] >= owned) {
      assert_int_equal((int)b, (int)entries);
    } else {
      assert_true(b < entries && row[b] == list->two[q] && list->col[b] == list->one[q]);
      met[b]++;
    }
  }
  for (PetscInt k = 0; k < entries; k++) assert_int_equal((int)met[k], 1);
  OK(PetscFree2(row, met));
}

static PetscInt CheckRows(PgParticles particles, PgNeighbors neighbors, const PetscReal x[], const PetscReal r[],
                          PetscReal skin, PetscReal length)
{
  PgRowList       list;
  const PetscInt *id;
  PetscInt        owned, N, *partner;
  PetscReal      *position, *at;

  OK(PgParticlesGetSizes(particles, &owned, NULL, &N));
  OK(PgParticlesGetIds(particles, &id));
  OK(PgParticlesGetArray(particles, PG_POSITION, &position));
  OK(PgNeighborsGetRows(neighbors, &list));
  assert_int_equal((int)list.ptr[0], 0);
  OK(PetscMalloc2(3 * N, &partner, 3 * N, &at));
  for (PetscInt i = 0; i < owned; i++) {
    const PetscInt n = Expected(ROW, x, r, N, skin, id[i], length, partner, at);
    assert_int_equal((int)(list.ptr[i + 1] - list.ptr[i]), (int)n);
    for (PetscInt k = 0; k < n; k++) {
      const PetscInt other = list.col[list.ptr[i] + k];
      assert_int_equal((int)id[other], (int)partner[k]);
      assert_true(position[2 * other] == at[k]);
    }
  }
  OK(PetscFree2(partner, at));
  CheckEnds(&list, owned);
  return list.ptr[owned];
}

/* Pairs of both lists, over all ranks. */
static void CheckLists(PgParticles particles, PgNeighbors neighbors, PetscReal length, PetscInt entries[2])
{
  PetscReal *x = GatherAll(particles, PG_POSITION), *r = GatherAll(particles, PG_RADIUS), skin;
  PetscInt   N;

  OK(PgParticlesGetSizes(particles, NULL, NULL, &N));
  skin       = Skin(r, N);
  entries[0] = CheckContacts(particles, neighbors, x, r, skin, length);
  entries[1] = CheckRows(particles, neighbors, x, r, skin, length);
  OK(MPI_Allreduce(MPI_IN_PLACE, entries, 2, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  OK(PetscFree(x));
  OK(PetscFree(r));
}

/* Puts the first discs far off, two and two side by side, the last pair further than whole numbers of cells reach. */
static void FlyOff(PgParticles particles)
{
  static const PetscReal far[3][2] = {{900.0, -400.0}, {-2e5, 0.4}, {3e12, 3e12}};
  const PetscInt        *id;
  PetscInt               owned;
  PetscReal             *position;

  OK(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  OK(PgParticlesGetIds(particles, &id));
  OK(PgParticlesGetArray(particles, PG_POSITION, &position));
  for (PetscInt i = 0; i < owned; i++) {
    if (id[i] >= 6) continue;
    position[2 * i]     = far[id[i] / 2][0] + 0.01 * (PetscReal)(id[i] % 2);
    position[2 * i + 1] = far[id[i] / 2][1];
  }
}

static void Run(const Cloud *discs, PetscReal length, PetscBool some_fly, PetscInt least_contacts)
{
  PgParticles particles;
  PgNeighbors neighbors;
  PetscInt    entries[2], builds;

  OK(PgParticlesCreate(PETSC_COMM_WORLD, &particles));
  if (length > 0) OK(PgParticlesSetPeriodicX(particles, discs->low[0], discs->low[0] + length));
  OK(PgNeighborsCreate(particles, &neighbors));
  OK(PgNeighborsSetFromOptions(neighbors));
  /* The largest reach of equal discs is 5 r, that of very unequal ones 3.5 times the larger radius: together
     they are `wide` and `narrow`. */
  OK(PgNeighborsRequestRows(neighbors, 3.5, 1.0));
  OK(PgNeighborsRequestRows(neighbors, 2.5, 2.5));
  CreateCloud(discs, particles);
  if (some_fly) FlyOff(particles);
  for (unsigned step = 0; step < 4; step++) {
    if (step == 2) OK(PgParticlesForceMigration(particles, 1));
    OK(PgNeighborsBuild(neighbors));
    OK(PgNeighborsGetRevision(neighbors, &builds));
    assert_int_equal((int)builds, (int)step + 1);
    CheckLists(particles, neighbors, length, entries);
    /* there was something to compare */
    assert_true(entries[0] >= least_contacts && entries[1] >= least_contacts);
    MoveDiscs(particles, 0.01, step);
  }
  OK(PgNeighborsDestroy(&neighbors));
  OK(PgParticlesDestroy(&particles));
}

static void lists_are_complete(void **state)
{
  (void)state;
  Run(&cloud, 0, PETSC_FALSE, 200);
}

static void periodic_lists_are_complete(void **state)
{
  (void)state;
  Run(&cloud, period, PETSC_FALSE, 200);
}

/* A period of just over three cells: every cell is next to every other one. */
static void short_period(void **state)
{
  const Cloud narrow_cloud = {120, {0.4, 0.2}, {0.35, 0.7}, 0.014};

  (void)state;
  Run(&narrow_cloud, 0.35, PETSC_FALSE, 30);
}

/* Discs that have left all others behind keep their partners, and the others theirs. */
static void discs_that_have_flown_off(void **state)
{
  (void)state;
  Run(&cloud, 0, PETSC_TRUE, 200);
}

/* More ranks than discs. */
static void few_discs(void **state)
{
  const Cloud three = {3, {0.1, 0.2}, {0.02, 0.02}, 0.014};

  (void)state;
  Run(&three, 0, PETSC_FALSE, 6);
}

static void no_discs(void **state)
{
  PgParticles   particles;
  PgNeighbors   neighbors;
  PgContactList list;
  PetscBool     need;

  (void)state;
  OK(PgParticlesCreate(PETSC_COMM_WORLD, &particles));
  OK(PgNeighborsCreate(particles, &neighbors));
  OK(PgParticlesSetDiscs(particles, 0, NULL));
  OK(PgNeighborsBuild(neighbors));
  OK(PgNeighborsGetContacts(neighbors, &list));
  assert_int_equal((int)list.padded, 0);
  OK(PgNeighborsNeedBuild(neighbors, &need));
  assert_false(need);
  OK(PgNeighborsDestroy(&neighbors));
  OK(PgParticlesDestroy(&particles));
}

static void radii_must_be_positive(void **state)
{
  PgParticles     particles;
  PgNeighbors     neighbors;
  const PetscInt *id;
  PetscInt        owned;
  PetscReal      *radius;

  (void)state;
  OK(PgParticlesCreate(PETSC_COMM_WORLD, &particles));
  OK(PgNeighborsCreate(particles, &neighbors));
  CreateCloud(&cloud, particles);
  OK(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  OK(PgParticlesGetIds(particles, &id));
  OK(PgParticlesGetArray(particles, PG_RADIUS, &radius));
  for (PetscInt i = 0; i < owned; i++) {
    if (id[i] == 17) radius[i] = 0;
  }
  ASSERT_FAILS(PgNeighborsBuild(neighbors), PETSC_ERR_USER_INPUT,
               "the radius of every disc must be positive and finite");
  OK(PgNeighborsDestroy(&neighbors));
  OK(PgParticlesDestroy(&particles));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(lists_are_complete),
    cmocka_unit_test(periodic_lists_are_complete),
    cmocka_unit_test(short_period),
    cmocka_unit_test(few_discs),
    cmocka_unit_test(discs_that_have_flown_off),
    cmocka_unit_test(no_discs),
    cmocka_unit_test(radii_must_be_positive),
};

TEST_MAIN(tests)
