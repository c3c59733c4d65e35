/* ranks: 4 */
/* timeout: 240 */
/* The same run on 1, 2 and 4 of the ranks, with discs that are sent to another rank all the time, has the same bits
   after 2000 steps, dry or with explicit pressure. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include <porograin/simulation.h>
#include <string.h>
#include <unistd.h>

#define OK(call) assert_int_equal((int)(call), 0)

enum { STEPS = 2000, SHIFT_EVERY = 11, FIELDS = 64 };

/* Fields of all discs in the order of ids, on every rank of the run, and what happened on the way. */
typedef struct {
  PetscInt    count, global, components[FIELDS];
  char        name[FIELDS][64];
  PetscReal  *value[FIELDS];
  PetscReal   load, energy;
  PetscInt    builds;
  PetscInt    migrations; /* discs that changed their rank, summed over the steps */
  PetscMPIInt size;
} Outcome;

static PgSimulation Start(MPI_Comm comm, const char options[])
{
  PgSimulation simulation;

  OK(PetscOptionsClear(NULL));
  OK(PetscOptionsInsertString(NULL, options));
  OK(PgSimulationCreate(comm, &simulation));
  OK(PgSimulationSetFromOptions(simulation));
  OK(PgSimulationSetUp(simulation));
  return simulation;
}

/* Counts owned discs that were not owned at the last call; `owned_before` has one entry for each disc of the run. */
static PetscInt Arrivals(PgParticles particles, PetscInt global, char owned_before[])
{
  const PetscInt *id;
  PetscInt        owned, arrived = 0;

  OK(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  OK(PgParticlesGetIds(particles, &id));
  for (PetscInt i = 0; i < owned; i++) arrived += !owned_before[id[i]];
  OK(PetscArrayzero(owned_before, global));
  for (PetscInt i = 0; i < owned; i++) owned_before[id[i]] = 1;
  return arrived;
}

/* Every field that files hold, and those that a restart needs. */
static void TakeFields(MPI_Comm comm, PgParticles particles, Outcome *outcome)
{
  const PgFieldInfo *info;
  PetscInt           fields, start, count;
  PetscReal         *owned, *byid;

  OK(PgParticlesGetFieldCount(particles, &fields));
  OK(PgParticlesGetIdRange(particles, &start, &count));
  outcome->count = 0;
  for (PgField f = 0; f < fields; f++) {
    PetscMPIInt *lengths, *starts, mine;
    PetscReal   *all;
    PetscInt     c, k = outcome->count;

    OK(PgParticlesGetFieldInfo(particles, f, &info));
    c = info->components;
    /* the position at the last list build belongs to the lists, which forced migration makes more often */
    if (!(info->flags & (PG_FIELD_OUTPUT | PG_FIELD_RESTART)) || !strcmp(info->name, "build_position")) continue;
    assert_true(k < FIELDS);
    OK(PetscMalloc1(c * count, &byid));
    OK(PetscMalloc1(c * outcome->global, &all));
    OK(PetscMalloc2(outcome->size, &lengths, outcome->size, &starts));
    OK(PgParticlesGetArray(particles, f, &owned));
    OK(PgParticlesToIdOrder(particles, c, owned, byid));
    mine = (PetscMPIInt)(c * count);
    OK(MPI_Allgather(&mine, 1, MPI_INT, lengths, 1, MPI_INT, comm));
    starts[0] = 0;
    for (PetscMPIInt r = 1; r < outcome->size; r++) starts[r] = starts[r - 1] + lengths[r - 1];
    OK(MPI_Allgatherv(byid, mine, MPIU_REAL, all, lengths, starts, MPIU_REAL, comm));
    OK(PetscFree2(lengths, starts));
    OK(PetscFree(byid));
    outcome->value[k]      = all;
    outcome->components[k] = c;
    OK(PetscStrncpy(outcome->name[k], info->name, sizeof outcome->name[k]));
    outcome->count++;
  }
}

static void Run(MPI_Comm comm, const char options[], Outcome *outcome)
{
  PgSimulation simulation = Start(comm, options);
  PgParticles  particles;
  PgNeighbors  neighbors;
  PgDem        dem;
  char        *owned_before;
  PetscReal    total;

  OK(MPI_Comm_size(comm, &outcome->size));
  OK(PgSimulationGetParts(simulation, &particles, &neighbors, &dem, NULL));
  OK(PgParticlesGetSizes(particles, NULL, NULL, &outcome->global));
  OK(PetscCalloc1(outcome->global, &owned_before));
  (void)Arrivals(particles, outcome->global, owned_before);
  outcome->migrations = 0;
  for (PetscInt step = 0; step < STEPS; step++) {
    /* takes place with the next build */
    if (step % SHIFT_EVERY == SHIFT_EVERY - 1) OK(PgParticlesForceMigration(particles, step / SHIFT_EVERY));
    OK(PgSimulationStep(simulation));
    outcome->migrations += Arrivals(particles, outcome->global, owned_before);
  }
  OK(MPI_Allreduce(MPI_IN_PLACE, &outcome->migrations, 1, MPIU_INT, MPI_SUM, comm));
  OK(PgNeighborsGetRevision(neighbors, &outcome->builds));
  OK(PgDemGetLoad(dem, 1, &outcome->load, &total));
  OK(PgDemKineticEnergy(dem, &outcome->energy));
  TakeFields(comm, particles, outcome);
  OK(PetscFree(owned_before));
  OK(PgSimulationDestroy(&simulation));
}

static void Compare(const char reading[], const Outcome *one, const Outcome *many)
{
  assert_int_equal(many->count, one->count);
  assert_true(one->count > 10);
  for (PetscInt k = 0; k < one->count; k++) {
    const PetscInt values = one->global * one->components[k];
    assert_string_equal(many->name[k], one->name[k]);
    for (PetscInt i = 0; i < values; i++)
      if (memcmp(&many->value[k][i], &one->value[k][i], sizeof(PetscReal)))
        fail_msg("%s on %d ranks: %s of disc %d is %.17g, on one rank %.17g", reading, many->size, one->name[k],
                 (int)(i / one->components[k]), (double)many->value[k][i], (double)one->value[k][i]);
  }
  assert_memory_equal(&many->load, &one->load, sizeof many->load);
  assert_memory_equal(&many->energy, &one->energy, sizeof many->energy);
  assert_int_equal(many->builds, one->builds);
  /* every shift moves nearly all discs: half of that, for a last one that came after the last build */
  assert_true(many->migrations > STEPS / SHIFT_EVERY * one->global / 2);
}

static void Forget(Outcome *outcome)
{
  for (PetscInt k = 0; k < outcome->count; k++) OK(PetscFree(outcome->value[k]));
}

/* The ranks that are left out wait without keeping a processor busy. */
static void Wait(void)
{
  MPI_Request request;
  int         done = 0;

  OK(MPI_Ibarrier(PETSC_COMM_WORLD, &request));
  while (!done) {
    OK(MPI_Test(&request, &done, MPI_STATUS_IGNORE));
    if (!done) (void)usleep(2000);
  }
}

static void OnAnyRanks(const char reading[], const char options[])
{
  static const PetscMPIInt sizes[] = {1, 2, 4};
  PetscMPIInt              rank;
  Outcome                  one = {0}, many = {0};

  OK(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
    MPI_Comm comm;
    OK(MPI_Comm_split(PETSC_COMM_WORLD, rank < sizes[s] ? 0 : MPI_UNDEFINED, rank, &comm));
    if (comm != MPI_COMM_NULL) {
      Run(comm, options, s ? &many : &one);
      if (s && rank == 0) Compare(reading, &one, &many);
      if (s) Forget(&many);
      OK(MPI_Comm_free(&comm));
    }
    Wait();
  }
  if (rank == 0) {
    print_message("%s: %d discs, %d list builds, %d discs changed rank on the last run\n", reading, (int)many.global,
                  (int)many.builds, (int)many.migrations);
    Forget(&one);
  }
}

/* A narrow skin: lists are built every few steps. No damping: discs move and lose contacts. */
#define COMMON "-case panel -panel_columns 7 -dt 2e-6 -end_time 1 -neighbors_skin 2e-4 -particles_balance 1 "

static void test_dry(void **state)
{
  (void)state;
  OnAnyRanks("dry", COMMON "-fluid none -dem_c_n 40 -dem_c_theta 1e-4");
}

static void test_navier_stokes(void **state)
{
  (void)state;
  OnAnyRanks("Navier-Stokes",
             COMMON "-fluid ns -ns_continuity solenoidal -coupling drag -sph_operators paper -pressure explicit "
                    "-dem_local_damping 0.7");
}

static void test_darcy(void **state)
{
  (void)state;
  OnAnyRanks("Darcy", COMMON "-fluid darcy -coupling drag_and_pressure -sph_gradient corrected -bc_tracking surface "
                             "-porosity_rate sampled -pressure explicit -pressure_sweeps 2 -bc_top flux -bc_top_flux "
                             "-0.13 -dem_local_damping 0.3");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_dry),
    cmocka_unit_test(test_navier_stokes),
    cmocka_unit_test(test_darcy),
};

int main(int argc, char *argv[])
{
  int failed;

  PetscCall(PgInitialize(&argc, &argv, "test"));
  PetscCall(PetscSetFPTrap(PETSC_FP_TRAP_ON));
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
