/* ranks: 1 2 4 */
/* Checkpoints hold every bit of fields, variable-length data and state, for any distribution of the discs, and
   replace their predecessor only when they are whole. */
#include "io_testing.h"

enum { DISCS = 37, WIDTH = 3 };

/* What is written. RESTART decides, not OUTPUT. */
static const PgFieldInfo fields[] = {
    {"spring", 1, "N", "restarted scalar", PG_FIELD_MIGRATE | PG_FIELD_RESTART},
    {"tensor", 4, "Pa", "restarted tensor", PG_FIELD_MIGRATE | PG_FIELD_RESTART},
    {"scratch", 2, "m", "not in checkpoints", PG_FIELD_MIGRATE | PG_FIELD_OUTPUT},
};
enum { FIELDS = sizeof fields / sizeof *fields };

/* Numbers of the run. */
typedef struct {
  PetscReal time[2];
  PetscInt  step;
  char      name[16];
} Numbers;

static PgState MakeState(Numbers *numbers, PgStateRule rule)
{
  PgState state;

  ok(PgStateCreate(&state));
  ok(PgStateAddReals(state, "test_time", rule, "the time", 2, numbers->time));
  ok(PgStateAddInts(state, "test_step", rule, "the step", 1, &numbers->step));
  ok(PgStateAddText(state, "test_name", rule, "the name", sizeof numbers->name, numbers->name));
  return state;
}

/* Disc id has id % 4 records, but every 11th 9 of them. */
static PetscInt Records(PetscInt id) { return id % 11 == 10 ? 9 : id % 4; }

static void FillRagged(PgParticles particles, PgRagged ragged)
{
  const PetscInt *id;
  PetscInt        owned, *offset;
  PetscReal      *record;

  ok(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  ok(PgParticlesGetIds(particles, &id));
  ok(PetscMalloc1(owned + 1, &offset));
  offset[0] = 0;
  for (PetscInt i = 0; i < owned; i++) offset[i + 1] = offset[i] + Records(id[i]);
  ok(PetscMalloc1(offset[owned] * WIDTH, &record));
  for (PetscInt i = 0; i < owned; i++)
    for (PetscInt k = offset[i]; k < offset[i + 1]; k++)
      for (PetscInt c = 0; c < WIDTH; c++) record[k * WIDTH + c] = ValueAt(1000 * (k - offset[i]), id[i], c);
  ok(PgParticlesSetRagged(particles, ragged, offset, record));
  ok(PetscFree(record));
  ok(PetscFree(offset));
}

static PgParticles MakeRun(PgRagged *ragged)
{
  PgParticles particles = MakeDiscs(DISCS, FIELDS, fields);

  ok(PgParticlesRegisterRagged(particles, "touching", WIDTH, PG_FIELD_MIGRATE | PG_FIELD_RESTART, ragged));
  FillRagged(particles, *ragged);
  return particles;
}

static void CheckFields(PgParticles particles)
{
  const PetscInt *id;
  PetscInt        owned, count;

  ok(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  ok(PgParticlesGetIds(particles, &id));
  ok(PgParticlesGetFieldCount(particles, &count));
  for (PgField f = 0; f < count; f++) {
    const PgFieldInfo *info;
    PetscReal         *array;

    ok(PgParticlesGetFieldInfo(particles, f, &info));
    ok(PgParticlesGetArray(particles, f, &array));
    for (PetscInt i = 0; i < owned; i++)
      for (PetscInt c = 0; c < info->components; c++) {
        const PetscReal written = f == PG_POSITION ? PositionAt(id[i], c) : ValueAt(f, id[i], c);
        const PetscReal value   = array[i * info->components + c];
        if (info->flags & PG_FIELD_RESTART)
          assert_true(value == written);
        else
          assert_true(value == -1.5);
      }
  }
}

static void CheckRagged(PgParticles particles, PgRagged ragged)
{
  const PetscInt  *id, *offset;
  const PetscReal *record;
  PetscInt         owned;

  ok(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  ok(PgParticlesGetIds(particles, &id));
  ok(PgParticlesGetRagged(particles, ragged, &offset, &record));
  for (PetscInt i = 0; i < owned; i++) {
    assert_int_equal(offset[i + 1] - offset[i], Records(id[i]));
    for (PetscInt k = offset[i]; k < offset[i + 1]; k++)
      for (PetscInt c = 0; c < WIDTH; c++)
        assert_true(record[k * WIDTH + c] == ValueAt(1000 * (k - offset[i]), id[i], c));
  }
}

/* Wipes out what a checkpoint brings back, and moves almost every disc to another rank. */
static void Spoil(PgParticles particles, PgRagged ragged)
{
  PetscInt owned, count;

  ok(PgParticlesForceMigration(particles, 1));
  ok(PgParticlesDistribute(particles, 0.1));
  ok(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  ok(PgParticlesGetFieldCount(particles, &count));
  for (PgField f = 0; f < count; f++) {
    const PgFieldInfo *info;
    PetscReal         *array;

    ok(PgParticlesGetFieldInfo(particles, f, &info));
    ok(PgParticlesGetArray(particles, f, &array));
    for (PetscInt i = 0; i < owned * info->components; i++) array[i] = -1.5;
  }
  ok(PgParticlesSetRagged(particles, ragged, NULL, NULL));
}

static void RemoveCheckpoint(const char file[])
{
  char name[300];

  if (test_rank == 0) {
    (void)unlink(file);
    (void)snprintf(name, sizeof name, "%s.1", file);
    (void)unlink(name);
  }
  ok(MPI_Barrier(PETSC_COMM_WORLD));
}

static void every_bit_comes_back(void **state)
{
  const char  *file    = FileName("bits", ".pgc"), *found;
  Numbers      written = {{0.1, -3.7e-5}, 123456789, "a name"}, read = {{0, 0}, 0, ""};
  PgRagged     ragged;
  PgParticles  particles = MakeRun(&ragged);
  PgState      numbers   = MakeState(&written, PG_STATE_KEEP);
  PgCheckpoint checkpoint;

  (void)state;
  RemoveCheckpoint(file);
  ok(PgCheckpointWrite(particles, numbers, file));
  ok(PgStateDestroy(&numbers));
  Spoil(particles, ragged);
  numbers = MakeState(&read, PG_STATE_KEEP);
  ok(PgCheckpointOpen(PETSC_COMM_WORLD, file, &checkpoint));
  ok(PgCheckpointGetFile(checkpoint, &found));
  assert_string_equal(found, file);
  ok(PgCheckpointReadState(checkpoint, numbers));
  ok(PgCheckpointReadFields(checkpoint, particles));
  ok(PgCheckpointClose(&checkpoint));
  assert_null(checkpoint);
  assert_true(read.time[0] == written.time[0] && read.time[1] == written.time[1]);
  assert_int_equal(read.step, written.step);
  assert_string_equal(read.name, written.name);
  CheckFields(particles);
  CheckRagged(particles, ragged);
  ok(PgStateDestroy(&numbers));
  ok(PgParticlesDestroy(&particles));
  RemoveCheckpoint(file);
}

static PetscInt StepIn(const char where[], const char expected_file[])
{
  Numbers      read    = {{0, 0}, -1, ""};
  PgState      numbers = MakeState(&read, PG_STATE_KEEP);
  PgCheckpoint checkpoint;
  const char  *file;

  ok(PgCheckpointOpen(PETSC_COMM_WORLD, where, &checkpoint));
  ok(PgCheckpointGetFile(checkpoint, &file));
  assert_string_equal(file, expected_file);
  ok(PgCheckpointReadState(checkpoint, numbers));
  ok(PgCheckpointClose(&checkpoint));
  ok(PgStateDestroy(&numbers));
  return read.step;
}

static void WriteStep(PgParticles particles, PetscInt step, const char file[])
{
  Numbers written = {{1.5, 2.5}, step, "x"};
  PgState numbers = MakeState(&written, PG_STATE_KEEP);

  ok(PgCheckpointWrite(particles, numbers, file));
  ok(PgStateDestroy(&numbers));
}

/* Overwrites one byte, on rank 0. */
static void Flip(const char file[], long at)
{
  if (test_rank == 0) {
    FILE         *stream = fopen(file, "r+b");
    unsigned char byte;

    assert_non_null(stream);
    assert_int_equal(fseek(stream, at, at < 0 ? SEEK_END : SEEK_SET), 0);
    assert_int_equal(fread(&byte, 1, 1, stream), 1);
    byte ^= 4;
    assert_int_equal(fseek(stream, -1, SEEK_CUR), 0);
    assert_int_equal(fwrite(&byte, 1, 1, stream), 1);
    assert_int_equal(fclose(stream), 0);
  }
  ok(MPI_Barrier(PETSC_COMM_WORLD));
}

static void the_one_before_is_kept(void **state)
{
  char        file[256], before[300], newer[256], pattern[256];
  const char *directory = FileName("keep", "");
  PgRagged    ragged;
  PgParticles particles = MakeRun(&ragged);

  (void)state;
  (void)snprintf(file, sizeof file, "%s/a.pgc", directory);
  (void)snprintf(before, sizeof before, "%s.1", file);
  (void)snprintf(newer, sizeof newer, "%s/b.pgc", directory);
  (void)snprintf(pattern, sizeof pattern, "%s/[a-b]*", directory);
  if (test_rank == 0) (void)mkdir(directory, 0700);
  ok(MPI_Barrier(PETSC_COMM_WORLD));
  RemoveCheckpoint(file);
  RemoveCheckpoint(newer);
  WriteStep(particles, 10, file);
  assert_int_equal(StepIn(file, file), 10);
  WriteStep(particles, 20, file);
  assert_int_equal(StepIn(file, file), 20);
  assert_int_equal(StepIn(before, before), 10);
  WriteStep(particles, 5, newer); /* sealed last, whatever its step */
  assert_int_equal(StepIn(directory, newer), 5);
  assert_int_equal(StepIn(pattern, newer), 5);
  Flip(newer, 1000);
  assert_int_equal(StepIn(directory, file), 20);
  Flip(file, -1); /* its seal */
  assert_int_equal(StepIn(pattern, before), 10);
  assert_int_equal(StepIn(file, before), 10);
  RemoveCheckpoint(newer);
  if (test_rank == 0) assert_int_equal(unlink(file), 0);
  ok(MPI_Barrier(PETSC_COMM_WORLD));
  assert_int_equal(StepIn(file, before), 10);
  RemoveCheckpoint(file);
  if (test_rank == 0) assert_int_equal(rmdir(directory), 0); /* no temporary file is left */
  ok(PgParticlesDestroy(&particles));
}

/* MATCH: another value is refused in words of the user. */
static void settings_must_match(void **state)
{
  const char *file       = FileName("match", ".pgc");
  Numbers     written    = {{0.1, 0.2}, 7, "panel"},
          now[]          = {{{0.1, 0.25}, 7, "panel"}, {{0.1, 0.2}, 8, "panel"}, {{0.1, 0.2}, 7, "box"}};
  const char  *message[] = {"cannot go on from it: the time is 0.2",
                            "cannot go on from it: the step is 7 in the checkpoint and 8 now",
                            "cannot go on from it: the name is 'panel' in the checkpoint and 'box' now"};
  PgRagged     ragged;
  PgParticles  particles = MakeRun(&ragged);
  PgState      numbers   = MakeState(&written, PG_STATE_MATCH);
  PgCheckpoint checkpoint;
  char         start[256], text[4096];

  (void)state;
  RemoveCheckpoint(file);
  ok(PgCheckpointWrite(particles, numbers, file));
  ok(PgCheckpointOpen(PETSC_COMM_WORLD, file, &checkpoint));
  ok(PgCheckpointReadState(checkpoint, numbers));
  ok(PgCheckpointClose(&checkpoint));
  ok(PgStateDestroy(&numbers));
  (void)snprintf(start, sizeof start, "porograin: error: checkpoint '%s': ", file);
  for (int k = 0; k < 3; k++) {
    numbers = MakeState(&now[k], PG_STATE_MATCH);
    ok(PgCheckpointOpen(PETSC_COMM_WORLD, file, &checkpoint));
    CatchErrors();
    assert_int_not_equal(PgCheckpointReadState(checkpoint, numbers), 0);
    assert_int_not_equal(PgCheckpointClose(&checkpoint), 0);
    CaughtErrors(text);
    CheckMessage(text, start, message[k]);
    ok(PgStateDestroy(&numbers));
  }
  ok(PgParticlesDestroy(&particles));
  RemoveCheckpoint(file);
}

/* A checkpoint never takes the place of another file. */
static void other_files_are_safe(void **state)
{
  const char *file = FileName("precious", ".txt");
  char        text[4096];

  (void)state;
  if (test_rank == 0) {
    FILE *stream = fopen(file, "w");
    assert_non_null(stream);
    assert_true(fputs("data of somebody, and enough of them to be taken for a short file", stream) >= 0);
    assert_int_equal(fclose(stream), 0);
  }
  ok(MPI_Barrier(PETSC_COMM_WORLD));
  CatchErrors();
  assert_int_equal(PgCheckpointCheckPlace(PETSC_COMM_WORLD, file), PETSC_ERR_FILE_OPEN);
  CaughtErrors(text);
  CheckMessage(text, "porograin: error: checkpoint '", "this file is there and is not a checkpoint");
  CatchErrors();
  assert_int_equal(PgCheckpointCheckPlace(PETSC_COMM_WORLD, "nowhere/a.pgc"), PETSC_ERR_FILE_OPEN);
  CaughtErrors(text);
  CheckMessage(text, "porograin: error: checkpoint 'nowhere/a.pgc': ", "No such file or directory");
  RemoveCheckpoint(file);
}

int main(int argc, char *argv[])
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_bit_comes_back),
      cmocka_unit_test(the_one_before_is_kept),
      cmocka_unit_test(settings_must_match),
      cmocka_unit_test(other_files_are_safe),
  };
  PetscErrorCode err;
  int            failed;

  if (StartTests(&argc, &argv, &err)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(err) || failed;
}
