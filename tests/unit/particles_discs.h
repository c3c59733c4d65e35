/* Discs for the tests of particles and neighbors: values that depend on the permanent id alone, so that every
   rank can tell what they have to be, whoever owns them. */
#pragma once

#include <porograin/neighbors.h>
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

#define OK(call) assert_int_equal((int)(call), 0)

/* Splitmix64 of (id, stream), in [0, 1). */
static inline double Draw(PetscInt id, unsigned stream)
{
  uint64_t z = (uint64_t)id * 1000003U + stream + 1U;

  for (int k = 0; k < 2; k++) {
    z += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    z ^= z >> 31;
  }
  return (double)(z >> 11) * 0x1.0p-53;
}

typedef struct {
  PetscInt  N;
  PetscReal low[2], size[2]; /* [m] */
  PetscReal r;               /* mean radius [m]; from r/2 to 3r/2 */
} Cloud;

/* The ids of a cloud that start on this rank: scattered at random. */
static inline void CreateCloud(const Cloud *cloud, PgParticles particles)
{
  PetscMPIInt     rank, size;
  PetscInt       *mine, owned = 0;
  const PetscInt *id;
  PetscReal      *position, *radius, *velocity, *mass;

  OK(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  OK(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  OK(PetscMalloc1(cloud->N, &mine));
  for (PetscInt i = cloud->N - 1; i >= 0; i--) {
    if ((int)(Draw(i, 0) * size) == rank) mine[owned++] = i;
  }
  OK(PgParticlesSetDiscs(particles, owned, mine));
  OK(PetscFree(mine));
  OK(PgParticlesGetIds(particles, &id));
  OK(PgParticlesGetArray(particles, PG_POSITION, &position));
  OK(PgParticlesGetArray(particles, PG_VELOCITY, &velocity));
  OK(PgParticlesGetArray(particles, PG_RADIUS, &radius));
  OK(PgParticlesGetArray(particles, PG_MASS, &mass));
  for (PetscInt i = 0; i < owned; i++) {
    for (unsigned d = 0; d < 2; d++) {
      position[2 * i + d] = cloud->low[d] + cloud->size[d] * Draw(id[i], 1 + d);
      velocity[2 * i + d] = Draw(id[i], 3 + d) - 0.5;
    }
    radius[i] = cloud->r * (0.5 + Draw(id[i], 5));
    mass[i]   = 1 + Draw(id[i], 6);
  }
}

/* Moves every owned disc by up to `far` in each direction. */
static inline void MoveDiscs(PgParticles particles, PetscReal far, unsigned step)
{
  PetscInt        owned;
  const PetscInt *id;
  PetscReal      *position;

  OK(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  OK(PgParticlesGetIds(particles, &id));
  OK(PgParticlesGetArray(particles, PG_POSITION, &position));
  for (PetscInt i = 0; i < owned; i++) {
    for (unsigned d = 0; d < 2; d++) position[2 * i + d] += far * (2 * Draw(id[i], 100 + 2 * step + d) - 1);
  }
}

/* The owners' values of all discs on every rank, by id; fails unless every id is owned once. Free with
   PetscFree(). */
static inline PetscReal *GatherAll(PgParticles particles, PgField field)
{
  const PgFieldInfo *info;
  const PetscInt    *id;
  PetscInt           owned, N, c, *owners;
  PetscReal         *array, *all;

  OK(PgParticlesGetFieldInfo(particles, field, &info));
  OK(PgParticlesGetArray(particles, field, &array));
  OK(PgParticlesGetSizes(particles, &owned, NULL, &N));
  OK(PgParticlesGetIds(particles, &id));
  c = info->components;
  OK(PetscCalloc1(N * c + 1, &all));
  OK(PetscCalloc1(N + 1, &owners));
  for (PetscInt i = 0; i < owned; i++) {
    assert_in_range(id[i], 0, N - 1);
    owners[id[i]]++;
    for (PetscInt k = 0; k < c; k++) all[id[i] * c + k] = array[i * c + k];
  }
  OK(MPI_Allreduce(MPI_IN_PLACE, owners, (int)N, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  OK(MPI_Allreduce(MPI_IN_PLACE, all, (int)(N * c), MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  for (PetscInt i = 0; i < N; i++) assert_int_equal((int)owners[i], 1);
  OK(PetscFree(owners));
  return all;
}

/* Which image a ghost is: periods added to the x of its owner. */
static inline int ImageOf(PetscReal x, PetscReal owner_x, PetscReal period)
{
  return period > 0 ? (int)lround((double)((x - owner_x) / period)) : 0;
}

/* Standard error between these two calls, which only rank 0 is meant to write. */
static int   capture_saved = -1;
static FILE *capture_file;

static inline void CaptureErrors(void)
{
  (void)fflush(stderr);
  capture_saved = dup(2);
  capture_file  = tmpfile();
  assert_non_null(capture_file);
  assert_true(dup2(fileno(capture_file), 2) == 2);
}

static inline void CapturedErrors(char *text, size_t size)
{
  size_t n;

  (void)fflush(stderr);
  (void)dup2(capture_saved, 2);
  (void)close(capture_saved);
  rewind(capture_file);
  n       = fread(text, 1, size - 1, capture_file);
  text[n] = '\0';
  (void)fclose(capture_file);
}

/* All ranks get `status`; rank 0 says `word`. */
#define ASSERT_FAILS(call, status, word)                                                                               \
  do {                                                                                                                 \
    char        text_[2048];                                                                                           \
    PetscMPIInt rank_;                                                                                                 \
    int         err_;                                                                                                  \
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank_);                                                                           \
    CaptureErrors();                                                                                                   \
    err_ = (int)(call);                                                                                                \
    CapturedErrors(text_, sizeof text_);                                                                               \
    assert_int_equal(err_, (int)(status));                                                                             \
    if (rank_ == 0 && !strstr(text_, word)) fail_msg("'%s' lacks '%s'", text_, word);                                  \
  } while (0)

/* main() of a test program. */
#define TEST_MAIN(tests)                                                                                               \
  int main(int argc, char **argv)                                                                                      \
  {                                                                                                                    \
    int failed;                                                                                                        \
    if (PgInitialize(&argc, &argv, "unit test\n")) return 1;                                                           \
    if (PetscSetFPTrap(PETSC_FP_TRAP_ON)) return 1;                                                                    \
    failed = cmocka_run_group_tests(tests, NULL, NULL);                                                                \
    return PgFinalize(0) || failed;                                                                                    \
  }
