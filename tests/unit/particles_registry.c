/* ranks: 1 2 4 */
/* The registry of fields and variable-length data, and the check of ids. */
#include "particles_discs.h"

static const Cloud cloud = {300, {-0.3, 0.2}, {1.0, 0.7}, 0.02};

static void fields_are_registered_once(void **state)
{
  PgParticles        particles;
  PgField            first, second, other, found;
  PetscInt           count, before;
  const PgFieldInfo *info, *same;
  PgFieldInfo        temperature = {"temperature", 2, "K", "how warm a disc is", PG_FIELD_MIGRATE};

  (void)state;
  OK(PgParticlesCreate(PETSC_COMM_WORLD, &particles));
  OK(PgParticlesGetFieldCount(particles, &before));
  assert_int_equal((int)before, PG_CORE_FIELDS);
  OK(PgParticlesRegisterField(particles, &temperature, &first));
  OK(PgParticlesGetFieldInfo(particles, first, &info));
  for (int k = 0; k < 50; k++) { /* the registry has to grow, what it handed out must stay */
    char        name[32];
    PgFieldInfo more = {name, 1 + k % 4, "1", "filler", 0};
    (void)snprintf(name, sizeof name, "filler_%d", k);
    OK(PgParticlesRegisterField(particles, &more, &other));
  }
  temperature.flags = PG_FIELD_HALO;
  OK(PgParticlesRegisterField(particles, &temperature, &second));
  assert_int_equal((int)second, (int)first);
  OK(PgParticlesGetFieldInfo(particles, first, &same));
  assert_ptr_equal(info, same);
  assert_string_equal(info->name, "temperature");
  assert_string_equal(info->unit, "K");
  assert_string_equal(info->description, "how warm a disc is");
  assert_int_equal((int)info->components, 2);
  assert_int_equal((int)info->flags, PG_FIELD_MIGRATE | PG_FIELD_HALO);
  OK(PgParticlesFindField(particles, "filler_49", &found));
  assert_int_equal((int)found, (int)other);
  OK(PgParticlesFindField(particles, "filler_50", &found));
  assert_int_equal((int)found, -1);
  OK(PgParticlesGetFieldCount(particles, &count));
  assert_int_equal((int)(count - before), 51);
  temperature.components = 3;
  ASSERT_FAILS(PgParticlesRegisterField(particles, &temperature, &second), PETSC_ERR_USER_INPUT,
               "field 'temperature' is registered with 2 components and cannot have 3");
  OK(PgParticlesDestroy(&particles));
}

static void ragged_data_are_registered_once(void **state)
{
  PgParticles particles;
  PgRagged    first, second;
  PetscInt    count, components;
  unsigned    flags;
  const char *name;

  (void)state;
  OK(PgParticlesCreate(PETSC_COMM_WORLD, &particles));
  OK(PgParticlesRegisterRagged(particles, "partners", 3, PG_FIELD_MIGRATE, &first));
  OK(PgParticlesRegisterRagged(particles, "others", 2, PG_FIELD_MIGRATE, &second));
  assert_int_not_equal((int)first, (int)second);
  OK(PgParticlesRegisterRagged(particles, "partners", 3, PG_FIELD_RESTART, &second));
  assert_int_equal((int)first, (int)second);
  OK(PgParticlesGetRaggedCount(particles, &count));
  assert_int_equal((int)count, 2);
  OK(PgParticlesGetRaggedInfo(particles, first, &name, &components, &flags));
  assert_string_equal(name, "partners");
  assert_int_equal((int)components, 3);
  assert_int_equal((int)flags, PG_FIELD_MIGRATE | PG_FIELD_RESTART);
  ASSERT_FAILS(PgParticlesRegisterRagged(particles, "partners", 4, 0, &second), PETSC_ERR_USER_INPUT,
               "'partners' are registered with 3 components and cannot have 4");
  OK(PgParticlesDestroy(&particles));
}

/* A field that neither travels nor is kept has no array before somebody wants it: zero then, like any other. */
static void passing_fields_are_zero(void **state)
{
  PgFieldInfo passing = {"passing", 2, "1", "filled for a snapshot", PG_FIELD_OUTPUT};
  PgParticles particles;
  PgField     field, again;
  PetscInt    owned, ghosts;
  PetscReal  *value;

  (void)state;
  OK(PgParticlesCreate(PETSC_COMM_WORLD, &particles));
  OK(PgParticlesRegisterField(particles, &passing, &field));
  CreateCloud(&cloud, particles);
  OK(PgParticlesDistribute(particles, 0.06));
  OK(PgParticlesHalo(particles, 1, &field));
  OK(PgParticlesGetSizes(particles, &owned, &ghosts, NULL));
  OK(PgParticlesGetArray(particles, field, &value));
  for (PetscInt k = 0; k < 2 * (owned + ghosts); k++) assert_true(value[k] == 0);
  for (PetscInt k = 0; k < 2 * owned; k++) value[k] = 2.5;
  passing.flags = PG_FIELD_MIGRATE; /* from now on it travels */
  OK(PgParticlesRegisterField(particles, &passing, &again));
  OK(PgParticlesForceMigration(particles, 1));
  OK(PgParticlesDistribute(particles, 0.06));
  OK(PgParticlesHalo(particles, 1, &field));
  OK(PgParticlesGetSizes(particles, &owned, &ghosts, NULL));
  OK(PgParticlesGetArray(particles, field, &value));
  for (PetscInt k = 0; k < 2 * (owned + ghosts); k++) assert_true(value[k] == 2.5);
  passing.name = "another"; /* travels before it is asked for */
  OK(PgParticlesRegisterField(particles, &passing, &field));
  passing.name  = "third";
  passing.flags = PG_FIELD_OUTPUT;
  OK(PgParticlesRegisterField(particles, &passing, &field));
  passing.flags = PG_FIELD_MIGRATE;
  OK(PgParticlesRegisterField(particles, &passing, &again));
  OK(PgParticlesForceMigration(particles, 2));
  OK(PgParticlesDistribute(particles, 0.06));
  OK(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  OK(PgParticlesGetArray(particles, field, &value));
  for (PetscInt k = 0; k < 2 * owned; k++) assert_true(value[k] == 0);
  OK(PgParticlesDestroy(&particles));
}

static void late_fields_are_zero(void **state)
{
  const PgFieldInfo late = {"late", 3, "1", "registered after the discs", PG_FIELD_MIGRATE};
  PgParticles       particles;
  PgField           field;
  PetscInt          owned, ghosts, all;
  PetscReal        *value, *position;

  (void)state;
  OK(PgParticlesCreate(PETSC_COMM_WORLD, &particles));
  CreateCloud(&cloud, particles);
  OK(PgParticlesDistribute(particles, 0.06));
  OK(PgParticlesRegisterField(particles, &late, &field));
  OK(PgParticlesGetArray(particles, field, &value));
  OK(PgParticlesGetSizes(particles, &owned, &ghosts, &all));
  assert_int_equal((int)all, (int)cloud.N);
  for (PetscInt k = 0; k < 3 * (owned + ghosts); k++) assert_true(value[k] == 0);
  /* new discs: every field zero, whatever it held */
  for (PetscInt k = 0; k < 3 * (owned + ghosts); k++) value[k] = 7.5;
  {
    PetscMPIInt rank;
    PetscInt    only[2] = {1, 0};
    OK(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
    OK(PgParticlesSetDiscs(particles, rank == 0 ? 2 : 0, only));
    OK(PgParticlesGetSizes(particles, &owned, &ghosts, &all));
    assert_int_equal((int)owned, rank == 0 ? 2 : 0);
    assert_int_equal((int)ghosts, 0);
    assert_int_equal((int)all, 2);
    OK(PgParticlesGetArray(particles, field, &value));
    OK(PgParticlesGetArray(particles, PG_POSITION, &position));
    for (PetscInt k = 0; k < 3 * owned; k++) assert_true(value[k] == 0);
    for (PetscInt k = 0; k < 2 * owned; k++) assert_true(position[k] == 0);
  }
  OK(PgParticlesDestroy(&particles));
}

/* Every rank brings `each` ids in a row, with one of them (`where`) replaced. */
static PetscErrorCode SetIds(PgParticles particles, PetscInt each, PetscInt where, PetscInt by)
{
  PetscMPIInt rank;
  PetscInt    id[16];

  OK(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  for (PetscInt i = 0; i < each; i++) {
    id[i] = rank * each + i;
    if (id[i] == where) id[i] = by;
  }
  return PgParticlesSetDiscs(particles, each, id);
}

static void ids_are_checked(void **state)
{
  PgParticles particles;
  PetscMPIInt size;
  char        message[128];
  PetscInt    revision, later;

  (void)state;
  OK(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  OK(PgParticlesCreate(PETSC_COMM_WORLD, &particles));
  OK(SetIds(particles, 16, -1, -1));
  OK(PgParticlesGetRevision(particles, &revision));
  (void)snprintf(message, sizeof message, "particle id 3 occurs 2 times");
  ASSERT_FAILS(SetIds(particles, 16, 16 * size - 2, 3), PETSC_ERR_USER_INPUT, message);
  (void)snprintf(message, sizeof message, "particle id 5 occurs 0 times");
  ASSERT_FAILS(SetIds(particles, 16, 5, 9), PETSC_ERR_USER_INPUT, message);
  (void)snprintf(message, sizeof message, "particle id %d: the ids of %d particles must be 0 to %d", 16 * size,
                 16 * size, 16 * size - 1);
  ASSERT_FAILS(SetIds(particles, 16, 16 * size - 1, 16 * size), PETSC_ERR_USER_INPUT, message);
  (void)snprintf(message, sizeof message, "particle id -4:");
  ASSERT_FAILS(SetIds(particles, 16, 7, -4), PETSC_ERR_USER_INPUT, message);
  OK(PgParticlesGetRevision(particles, &later));
  assert_int_equal((int)revision, (int)later);
  OK(SetIds(particles, 12, -1, -1));
  OK(PgParticlesGetRevision(particles, &later));
  assert_int_not_equal((int)revision, (int)later);
  OK(PgParticlesDestroy(&particles));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(fields_are_registered_once),
    cmocka_unit_test(ragged_data_are_registered_once),
    cmocka_unit_test(late_fields_are_zero),
    cmocka_unit_test(passing_fields_are_zero),
    cmocka_unit_test(ids_are_checked),
};

TEST_MAIN(tests)
