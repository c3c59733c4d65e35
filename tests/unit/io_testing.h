/* What the tests of io share: discs scattered over the ranks with values that follow from the permanent
   id, and standard error as text. */
#pragma once

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include <porograin/io.h>
#include <errno.h>
#include <fcntl.h>
#include <hdf5.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#define ok(call) assert_int_equal((call), 0)

static PetscMPIInt test_rank, test_size;

/* Names carry the number of ranks: the same test may run with other numbers at the same time. The
   string lives as long as the program. */
static const char *FileName(const char stem[], const char ending[])
{
  static char names[64][128];
  char        name[128];

  (void)snprintf(name, sizeof name, "io_test_%s_%dranks%s", stem, test_size, ending);
  for (size_t k = 0; k < sizeof names / sizeof names[0]; k++) {
    if (!names[k][0]) (void)memcpy(names[k], name, sizeof name);
    if (!strcmp(names[k], name)) return names[k];
  }
  fail_msg("too many names");
  return NULL;
}

static inline void RemoveResult(const char stem[])
{
  if (test_rank == 0) {
    (void)unlink(FileName(stem, ".h5"));
    (void)unlink(FileName(stem, ".xmf"));
    (void)unlink(FileName(stem, ".csv"));
  }
  (void)MPI_Barrier(PETSC_COMM_WORLD);
}

/* Component c of `seed` at disc id: no two equal, none 0 or 1. */
static PetscReal ValueAt(PetscInt seed, PetscInt id, PetscInt c)
{
  return -3.7 + 0.001 * (PetscReal)seed + 1.3 * (PetscReal)id + 0.17 * (PetscReal)c;
}

/* Positions of neighbouring ids are far apart, so that no rank owns a row of ids. */
static PetscReal PositionAt(PetscInt id, PetscInt c)
{
  return c ? fmod(0.754877666 * (PetscReal)(id + 1), 1.) : fmod(0.569840291 * (PetscReal)(id + 1), 1.);
}

static void FillField(PgParticles particles, PgField field, PetscInt seed)
{
  const PgFieldInfo *info;
  const PetscInt    *id;
  PetscInt           owned;
  PetscReal         *array;

  ok(PgParticlesGetFieldInfo(particles, field, &info));
  ok(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  ok(PgParticlesGetIds(particles, &id));
  ok(PgParticlesGetArray(particles, field, &array));
  for (PetscInt i = 0; i < owned; i++)
    for (PetscInt c = 0; c < info->components; c++)
      array[i * info->components + c] = field == PG_POSITION ? PositionAt(id[i], c) : ValueAt(seed, id[i], c);
}

/* `n` discs, all made on the last rank and then distributed; every field has the seed of its index. */
static PgParticles MakeDiscs(PetscInt n, PetscInt extra_fields, const PgFieldInfo extra[])
{
  const PetscInt mine = test_rank == test_size - 1 ? n : 0;
  PgParticles    particles;
  PgField        field;
  PetscInt      *id, fields;

  ok(PgParticlesCreate(PETSC_COMM_WORLD, &particles));
  for (PetscInt k = 0; k < extra_fields; k++) ok(PgParticlesRegisterField(particles, &extra[k], &field));
  ok(PetscMalloc1(mine, &id));
  for (PetscInt k = 0; k < mine; k++) id[k] = n - 1 - k;
  ok(PgParticlesSetDiscs(particles, mine, id));
  ok(PetscFree(id));
  ok(PgParticlesGetFieldCount(particles, &fields));
  for (PgField f = 0; f < fields; f++) FillField(particles, f, f);
  ok(PgParticlesDistribute(particles, 0.1));
  /* Fields that do not migrate have lost their values. */
  for (PgField f = 0; f < fields; f++) FillField(particles, f, f);
  return particles;
}

/* Standard error of rank 0 between the two calls, on every rank. */
static int caught_error = -1;

static inline void CatchErrors(void)
{
  (void)fflush(stderr);
  caught_error = dup(STDERR_FILENO);
  if (test_rank == 0) {
    const int file = open(FileName("stderr", ".txt"), O_RDWR | O_CREAT | O_TRUNC, 0600);
    assert_true(file >= 0);
    (void)dup2(file, STDERR_FILENO);
    (void)close(file);
  }
}

static inline void CaughtErrors(char text[4096])
{
  (void)fflush(stderr);
  (void)memset(text, 0, 4096);
  if (test_rank == 0) {
    (void)lseek(STDERR_FILENO, 0, SEEK_SET);
    (void)!read(STDERR_FILENO, text, 4095);
    (void)unlink(FileName("stderr", ".txt"));
  }
  (void)dup2(caught_error, STDERR_FILENO);
  (void)close(caught_error);
  ok(MPI_Bcast(text, 4096, MPI_CHAR, 0, PETSC_COMM_WORLD));
}

/* One message, and nothing of PETSc's or HDF5's own printing with it. */
static inline void CheckMessage(const char text[], const char start[], const char part[])
{
  if (strncmp(text, start, strlen(start)) || !strstr(text, part)) {
    print_error("expected '%s ... %s', got '%s'\n", start, part, text);
    fail();
  }
  assert_ptr_equal(strchr(text, '\n'), text + strlen(text) - 1);
}

static inline char *ReadWholeFile(const char file[])
{
  FILE *stream = fopen(file, "rb");
  char *text;
  long  size;

  assert_non_null(stream);
  (void)fseek(stream, 0, SEEK_END);
  size = ftell(stream);
  rewind(stream);
  text = calloc((size_t)size + 1, 1);
  assert_non_null(text);
  assert_int_equal(fread(text, 1, (size_t)size, stream), size);
  (void)fclose(stream);
  return text;
}

static int StartTests(int *argc, char ***argv, PetscErrorCode *err)
{
  *err = PgInitialize(argc, argv, "unit test of io");
  if (*err) return 1;
  (void)MPI_Comm_rank(PETSC_COMM_WORLD, &test_rank);
  (void)MPI_Comm_size(PETSC_COMM_WORLD, &test_size);
  *err = PetscSetFPTrap(PETSC_FP_TRAP_ON);
  return *err != 0;
}
