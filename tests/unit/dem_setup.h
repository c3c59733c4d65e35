/* What the tests of dem share: a few discs with their lists and a dem object, stepped as a dry run does. */
#pragma once

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include <string.h>
#include <porograin/dem.h>

#define CHECK(call) assert_int_equal((call), 0)

typedef struct {
  PetscReal x, y, vx, vy, w, r, m;
  PetscInt  plate; /* 1 + index; 0: free */
} Disc;

typedef struct {
  MPI_Comm    comm;
  PgParticles particles;
  PgNeighbors neighbors;
  PgDem       dem;
  PetscInt    builds;
} World;

/* Without options: the settings of a test are set by calls. */
static inline void WorldCreate(MPI_Comm comm, World *world)
{
  world->comm   = comm;
  world->builds = 0;
  CHECK(PgParticlesCreate(comm, &world->particles));
  CHECK(PgParticlesSetFromOptions(world->particles));
  CHECK(PgNeighborsCreate(world->particles, &world->neighbors));
  CHECK(PgNeighborsSetFromOptions(world->neighbors));
  CHECK(PgDemCreate(world->particles, world->neighbors, &world->dem));
}

static inline void WorldDestroy(World *world)
{
  CHECK(PgDemDestroy(&world->dem));
  CHECK(PgNeighborsDestroy(&world->neighbors));
  CHECK(PgParticlesDestroy(&world->particles));
}

static inline PetscReal *WorldArray(World *world, const char name[])
{
  PgField    field;
  PetscReal *array;

  CHECK(PgParticlesFindField(world->particles, name, &field));
  assert_true(field >= 0);
  CHECK(PgParticlesGetArray(world->particles, field, &array));
  return array;
}

static inline PetscReal *CoreArray(World *world, PgField field)
{
  PetscReal *array;

  CHECK(PgParticlesGetArray(world->particles, field, &array));
  return array;
}

static inline void WorldBuild(World *world)
{
  CHECK(PgDemSaveHistory(world->dem));
  CHECK(PgNeighborsBuild(world->neighbors));
  CHECK(PgDemRestoreHistory(world->dem));
  world->builds++;
}

/* Disc k of the table gets permanent id k; they start out dealt to the ranks in turn. */
static inline void WorldFill(World *world, PetscInt count, const Disc disc[])
{
  PetscMPIInt rank, size;
  PetscInt   *id, owned = 0;
  PetscReal  *x, *v, *w, *r, *m, *plate;

  MPI_Comm_rank(world->comm, &rank);
  MPI_Comm_size(world->comm, &size);
  CHECK(PetscMalloc1(count, &id));
  for (PetscInt k = rank; k < count; k += size) id[owned++] = k;
  CHECK(PgParticlesSetDiscs(world->particles, owned, id));
  x     = CoreArray(world, PG_POSITION);
  v     = CoreArray(world, PG_VELOCITY);
  w     = CoreArray(world, PG_ANGULAR_VELOCITY);
  r     = CoreArray(world, PG_RADIUS);
  m     = CoreArray(world, PG_MASS);
  plate = WorldArray(world, "plate");
  for (PetscInt i = 0; i < owned; i++) {
    const Disc *d = &disc[id[i]];

    x[2 * i]     = d->x;
    x[2 * i + 1] = d->y;
    v[2 * i]     = d->vx;
    v[2 * i + 1] = d->vy;
    w[i]         = d->w;
    r[i]         = d->r;
    m[i]         = d->m;
    plate[i]     = (PetscReal)d->plate;
  }
  CHECK(PetscFree(id));
  WorldBuild(world);
}

static inline void WorldHalo(World *world)
{
  const PgField fields[] = {PG_POSITION, PG_VELOCITY, PG_ANGULAR_VELOCITY};

  CHECK(PgParticlesHalo(world->particles, 3, fields));
}

/* What comes before the forces of a step. */
static inline void WorldMove(World *world, PetscReal dt)
{
  PetscBool need;

  CHECK(PgDemKickDrift(world->dem, dt));
  CHECK(PgNeighborsNeedBuild(world->neighbors, &need));
  if (need)
    WorldBuild(world);
  else
    WorldHalo(world);
}

static inline void WorldStep(World *world, PetscReal dt)
{
  WorldMove(world, dt);
  CHECK(PgDemForces(world->dem, dt));
  CHECK(PgDemKick(world->dem, dt));
}

/* The values of all discs by permanent id, on every rank. Other ranks contribute 0, so the sum is exact. */
static inline void WorldGet(World *world, const char name[], PetscInt components, PetscInt count, PetscReal byid[])
{
  const PetscReal *a = WorldArray(world, name);
  const PetscInt  *id;
  PetscInt         owned;

  CHECK(PgParticlesGetSizes(world->particles, &owned, NULL, NULL));
  CHECK(PgParticlesGetIds(world->particles, &id));
  memset(byid, 0, sizeof(*byid) * (size_t)(count * components));
  for (PetscInt i = 0; i < owned; i++)
    for (PetscInt c = 0; c < components; c++) byid[id[i] * components + c] = a[i * components + c];
  MPI_Allreduce(MPI_IN_PLACE, byid, (PetscMPIInt)(count * components), MPIU_REAL, MPI_SUM, world->comm);
}

/* Writes into the owned disc with this id, wherever it is (ghosts: call WorldHalo()). */
static inline void WorldSet(World *world, const char name[], PetscInt components, PetscInt which,
                            const PetscReal value[])
{
  PetscReal      *a = WorldArray(world, name);
  const PetscInt *id;
  PetscInt        owned;

  CHECK(PgParticlesGetSizes(world->particles, &owned, NULL, NULL));
  CHECK(PgParticlesGetIds(world->particles, &id));
  for (PetscInt i = 0; i < owned; i++)
    for (PetscInt c = 0; c < components && id[i] == which; c++) a[i * components + c] = value[c];
}

/* A repeatable number in [-1, 1). */
static inline PetscReal Random(uint64_t *state)
{
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (PetscReal)(*state >> 11) * 0x1p-52 - 1;
}

/* rows * columns discs whose radii differ by up to `spread`, a little disordered and overlapping (by up to
   about twice the spread times the radius), with random velocities. */
static inline void FillHeap(PetscInt columns, PetscInt rows, PetscReal spread, Disc disc[])
{
  uint64_t seed = 20071;

  for (PetscInt k = 0; k < rows * columns; k++) {
    const PetscInt row = k / columns, column = k % columns;
    Disc          *d = &disc[k];

    memset(d, 0, sizeof(*d));
    d->r  = 5e-3 * (1 + spread * Random(&seed));
    d->x  = 9.99e-3 * ((PetscReal)column + (row % 2 ? 0.5 : 0)) + 5e-4 * spread * Random(&seed);
    d->y  = 8.65e-3 * (PetscReal)row + 5e-4 * spread * Random(&seed);
    d->m  = PETSC_PI * d->r * d->r * 2000;
    d->vx = 0.7 * Random(&seed);
    d->vy = 0.4 * Random(&seed);
    d->w  = 90 * Random(&seed);
  }
}

static inline int RunTests(int argc, char *argv[], int (*tests)(void))
{
  int failed = PgInitialize(&argc, &argv, "tests of dem\n") || PetscSetFPTrap(PETSC_FP_TRAP_ON);

  if (!failed) failed = tests();
  return PgFinalize(0) || failed;
}
