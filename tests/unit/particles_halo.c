/* ranks: 1 2 4 */
/* Ghost values of several fields at once, and the order of permanent ids. */
#include "particles_discs.h"

static const Cloud     cloud  = {500, {-0.3, 0.2}, {1.0, 0.7}, 0.02};
static const PetscReal period = 1.0; /* [m] */

static void Exchange(PetscBool periodic)
{
  const PgFieldInfo info[2] = {{"stress_like", 4, "Pa", "four components", PG_FIELD_MIGRATE},
                               {"pressure_like", 1, "Pa", "one component", PG_FIELD_MIGRATE}};
  PgParticles       particles;
  PgField           fields[3], core_only = PG_ROTATION;
  const PetscInt   *id;
  PetscInt          owned, ghosts, images = 0;
  PetscReal        *four, *one, *position, *rotation, *x;

  OK(PgParticlesCreate(PETSC_COMM_WORLD, &particles));
  if (periodic) OK(PgParticlesSetPeriodicX(particles, cloud.low[0], cloud.low[0] + period));
  OK(PgParticlesRegisterField(particles, &info[0], &fields[0]));
  OK(PgParticlesRegisterField(particles, &info[1], &fields[2]));
  fields[1] = PG_POSITION;
  CreateCloud(&cloud, particles);
  OK(PgParticlesDistribute(particles, 0.083));
  for (unsigned step = 0; step < 3; step++) {
    MoveDiscs(particles, 0.01, step); /* discs may leave [low, high): images stay one period away */
    OK(PgParticlesGetSizes(particles, &owned, &ghosts, NULL));
    OK(PgParticlesGetIds(particles, &id));
    OK(PgParticlesGetArray(particles, fields[0], &four));
    OK(PgParticlesGetArray(particles, PG_POSITION, &position));
    OK(PgParticlesGetArray(particles, fields[2], &one));
    OK(PgParticlesGetArray(particles, PG_ROTATION, &rotation));
    for (PetscInt i = 0; i < owned; i++) {
      for (unsigned k = 0; k < 4; k++) four[4 * i + k] = Draw(id[i], 50 + 10 * step + k);
      one[i]      = Draw(id[i], 57 + 10 * step);
      rotation[i] = Draw(id[i], 58 + 10 * step);
    }
    for (PetscInt i = owned; i < owned + ghosts; i++) rotation[i] = -1;
    x = GatherAll(particles, PG_POSITION);
    OK(PgParticlesHaloBegin(particles, 3, fields));
    OK(PgParticlesHaloEnd(particles, 3, fields));
    for (PetscInt i = owned; i < owned + ghosts; i++) {
      const int image = ImageOf(position[2 * i], x[2 * id[i]], periodic ? period : 0);
      images += image != 0;
      assert_true(position[2 * i] == (image ? x[2 * id[i]] + image * period : x[2 * id[i]]));
      assert_true(position[2 * i + 1] == x[2 * id[i] + 1]);
      for (unsigned k = 0; k < 4; k++) assert_true(four[4 * i + k] == Draw(id[i], 50 + 10 * step + k));
      assert_true(one[i] == Draw(id[i], 57 + 10 * step));
      assert_true(rotation[i] == -1); /* not asked for */
    }
    OK(PgParticlesHalo(particles, 1, &core_only));
    for (PetscInt i = owned; i < owned + ghosts; i++) assert_true(rotation[i] == Draw(id[i], 58 + 10 * step));
    OK(PetscFree(x));
  }
  OK(MPI_Allreduce(MPI_IN_PLACE, &images, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  assert_true(periodic ? images > 0 : images == 0);
  OK(PgParticlesDestroy(&particles));
}

static void fields_reach_ghosts(void **state)
{
  (void)state;
  Exchange(PETSC_FALSE);
}

static void fields_reach_images(void **state)
{
  (void)state;
  Exchange(PETSC_TRUE);
}

static void IdOrder(const Cloud *discs)
{
  PgParticles     particles;
  const PetscInt *id;
  PetscInt        owned, start, count, sum, next;
  PetscMPIInt     size;
  PetscReal      *mine, *byid, *back;

  OK(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  OK(PgParticlesCreate(PETSC_COMM_WORLD, &particles));
  CreateCloud(discs, particles);
  OK(PgParticlesGetIdRange(particles, &start, &count));
  OK(MPI_Allreduce(&count, &sum, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  OK(MPI_Scan(&count, &next, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  assert_int_equal((int)sum, (int)discs->N);
  assert_int_equal((int)(next - count), (int)start);
  assert_true(PetscAbsReal((PetscReal)count - (PetscReal)discs->N / size) < 1);
  for (int round = 0; round < 3; round++) { /* before any distribution, after one, after everything moved */
    if (round == 2) OK(PgParticlesForceMigration(particles, 1));
    if (round) OK(PgParticlesDistribute(particles, 0.083));
    OK(PgParticlesGetSizes(particles, &owned, NULL, NULL));
    OK(PgParticlesGetIds(particles, &id));
    for (PetscInt c = 1; c <= 3; c++) {
      OK(PetscMalloc3(owned * c, &mine, count * c, &byid, owned * c, &back));
      for (PetscInt i = 0; i < owned * c; i++) mine[i] = Draw(id[i / c], 70 + (unsigned)(i % c));
      OK(PgParticlesToIdOrder(particles, c, mine, byid));
      for (PetscInt k = 0; k < count * c; k++) assert_true(byid[k] == Draw(start + k / c, 70 + (unsigned)(k % c)));
      OK(PgParticlesFromIdOrder(particles, c, byid, back));
      for (PetscInt i = 0; i < owned * c; i++) assert_true(back[i] == mine[i]);
      OK(PetscFree3(mine, byid, back));
    }
  }
  OK(PgParticlesDestroy(&particles));
}

static void id_order_there_and_back(void **state)
{
  const Cloud three = {3, {0.1, 0.2}, {0.3, 0.5}, 0.02}, odd = {37, {0.1, 0.2}, {0.3, 0.5}, 0.02};

  (void)state;
  IdOrder(&cloud);
  IdOrder(&odd);
  IdOrder(&three);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(fields_reach_ghosts),
    cmocka_unit_test(fields_reach_images),
    cmocka_unit_test(id_order_there_and_back),
};

TEST_MAIN(tests)
