/* ranks: 1 2 4 */
/* Variable-length data follow their disc through migration and sorting. */
#include "particles_discs.h"

static const Cloud cloud = {400, {-0.3, 0.2}, {1.0, 0.7}, 0.02};

/* Number of records of a disc, and their values, from its id. */
static PetscInt  Records(PetscInt id, unsigned salt) { return (PetscInt)(Draw(id, 40 + salt) * 5); }
static PetscReal Value(PetscInt id, PetscInt record, PetscInt component, unsigned salt)
{
  return (PetscReal)id + 0.1 * (PetscReal)record + 0.01 * (PetscReal)component + 0.001 * salt;
}

static void Fill(PgParticles particles, PgRagged ragged, PetscInt components, unsigned salt)
{
  const PetscInt *id;
  PetscInt        owned, *offset;
  PetscReal      *record;

  OK(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  OK(PgParticlesGetIds(particles, &id));
  OK(PetscMalloc2(owned + 1, &offset, 5 * owned * components, &record));
  offset[0] = 0;
  for (PetscInt i = 0; i < owned; i++) {
    offset[i + 1] = offset[i] + Records(id[i], salt);
    for (PetscInt k = offset[i]; k < offset[i + 1]; k++) {
      for (PetscInt c = 0; c < components; c++) record[k * components + c] = Value(id[i], k - offset[i], c, salt);
    }
  }
  OK(PgParticlesSetRagged(particles, ragged, offset, record));
  OK(PetscFree2(offset, record));
}

/* Records of this rank that are right; a wrong one fails. */
static PetscInt Check(PgParticles particles, PgRagged ragged, PetscInt components, unsigned salt)
{
  const PetscInt  *id, *offset;
  PetscInt         owned;
  const PetscReal *record;

  OK(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  OK(PgParticlesGetIds(particles, &id));
  OK(PgParticlesGetRagged(particles, ragged, &offset, &record));
  assert_int_equal((int)offset[0], 0);
  for (PetscInt i = 0; i < owned; i++) {
    assert_int_equal((int)(offset[i + 1] - offset[i]), (int)Records(id[i], salt));
    for (PetscInt k = offset[i]; k < offset[i + 1]; k++) {
      for (PetscInt c = 0; c < components; c++)
        assert_true(record[k * components + c] == Value(id[i], k - offset[i], c, salt));
    }
  }
  return offset[owned];
}

static void records_follow_their_disc(void **state)
{
  PgParticles particles;
  PgRagged    a, b;
  PetscInt    expected = 0, total;

  (void)state;
  OK(PgParticlesCreate(PETSC_COMM_WORLD, &particles));
  OK(PgParticlesRegisterRagged(particles, "a", 3, PG_FIELD_MIGRATE, &a));
  CreateCloud(&cloud, particles);
  OK(PgParticlesRegisterRagged(particles, "b", 1, PG_FIELD_MIGRATE, &b));
  for (PetscInt j = 0; j < cloud.N; j++) expected += Records(j, 0);
  for (int round = 0; round < 2; round++) { /* filled before any distribution, and again later */
    Fill(particles, a, 3, 0);
    Fill(particles, b, 1, 1);
    for (unsigned step = 0; step < 5; step++) {
      OK(PgParticlesForceMigration(particles, (PetscInt)step));
      OK(PgParticlesDistribute(particles, 0.083));
      total = Check(particles, a, 3, 0);
      (void)Check(particles, b, 1, 1);
      OK(MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
      assert_int_equal((int)total, (int)expected);
      MoveDiscs(particles, 0.05, step);
    }
  }
  OK(PgParticlesDestroy(&particles));
}

static void records_can_be_given_up(void **state)
{
  PgParticles     particles;
  PgRagged        a;
  const PetscInt *offset;
  PetscInt        owned;

  (void)state;
  OK(PgParticlesCreate(PETSC_COMM_WORLD, &particles));
  OK(PgParticlesRegisterRagged(particles, "a", 2, PG_FIELD_MIGRATE, &a));
  CreateCloud(&cloud, particles);
  Fill(particles, a, 2, 0);
  OK(PgParticlesDistribute(particles, 0.083));
  OK(PgParticlesSetRagged(particles, a, NULL, NULL));
  OK(PgParticlesForceMigration(particles, 1));
  OK(PgParticlesDistribute(particles, 0.083));
  OK(PgParticlesGetRagged(particles, a, &offset, NULL));
  OK(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  for (PetscInt i = 0; i <= owned; i++) assert_int_equal((int)offset[i], 0);
  Fill(particles, a, 2, 3);
  OK(PgParticlesForceMigration(particles, 2));
  OK(PgParticlesDistribute(particles, 0.083));
  (void)Check(particles, a, 2, 3);
  OK(PgParticlesDestroy(&particles));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(records_follow_their_disc),
    cmocka_unit_test(records_can_be_given_up),
};

TEST_MAIN(tests)
