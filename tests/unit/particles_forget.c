/* ranks: 1 2 4 */
/* PgParticlesForgetPartition(): the next distribution is that of a new store with the same discs, whatever happened
   before. Restarted runs rely on it to have their discs, and so the rows of the pressure matrix, in the same order. */
#include "particles_discs.h"

static const Cloud cloud = {300, {-1.3, 0.4}, {2.1, 3.7}, 0.05};

/* A new store with the positions of an old one. */
static PgParticles Again(PgParticles old)
{
  PgParticles     particles;
  PetscReal      *all = GatherAll(old, PG_POSITION), *position;
  const PetscInt *id;
  PetscInt        owned;

  OK(PgParticlesCreate(PETSC_COMM_WORLD, &particles));
  CreateCloud(&cloud, particles);
  OK(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  OK(PgParticlesGetIds(particles, &id));
  OK(PgParticlesGetArray(particles, PG_POSITION, &position));
  for (PetscInt i = 0; i < owned; i++)
    for (PetscInt d = 0; d < 2; d++) position[2 * i + d] = all[2 * id[i] + d];
  OK(PetscFree(all));
  return particles;
}

/* Local discs, ghosts included, in the same order. */
static PetscBool SameOrder(PgParticles a, PgParticles b)
{
  const PetscInt *id_a, *id_b;
  PetscInt        owned[2], ghosts[2];
  PetscMPIInt     same = 1;

  OK(PgParticlesGetSizes(a, &owned[0], &ghosts[0], NULL));
  OK(PgParticlesGetSizes(b, &owned[1], &ghosts[1], NULL));
  OK(PgParticlesGetIds(a, &id_a));
  OK(PgParticlesGetIds(b, &id_b));
  same = owned[0] == owned[1] && ghosts[0] == ghosts[1];
  for (PetscInt i = 0; same && i < owned[0] + ghosts[0]; i++) same = id_a[i] == id_b[i];
  OK(MPI_Allreduce(MPI_IN_PLACE, &same, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD));
  return (PetscBool)same;
}

static void the_past_is_forgotten(void **state)
{
  PgParticles old, fresh;

  (void)state;
  OK(PgParticlesCreate(PETSC_COMM_WORLD, &old));
  CreateCloud(&cloud, old);
  OK(PgParticlesDistribute(old, 0.3));
  OK(PgParticlesForceMigration(old, 1));
  for (unsigned step = 0; step < 3; step++) { /* the grid of the start stays, and the discs move in it */
    MoveDiscs(old, 0.11, step);
    OK(PgParticlesDistribute(old, 0.3));
  }
  fresh = Again(old);
  OK(PgParticlesDistribute(fresh, 0.3));
  assert_false(SameOrder(old, fresh)); /* or there is nothing to forget */
  OK(PgParticlesForgetPartition(old));
  OK(PgParticlesDistribute(old, 0.3));
  assert_true(SameOrder(old, fresh));
  OK(PgParticlesDestroy(&fresh));
  OK(PgParticlesDestroy(&old));
}

int main(int argc, char *argv[])
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_past_is_forgotten)};
  int                     failed;

  if (PgInitialize(&argc, &argv, "unit test of particles") || PetscSetFPTrap(PETSC_FP_TRAP_ON)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
