/* ranks: 1 2 4 */
/* What cannot be written or read is an error on every rank, with one message that names the file. */
#include "io_testing.h"
#include <signal.h>
#include <sys/resource.h>

static const PgColumn column[] = {{"time", "s", "time of the row"}};

/* PgOutputCreate() refuses the name with these words and leaves nothing behind. */
static void CheckRefused(PgParticles particles, PetscErrorCode code, const char file[], const char message[],
                         const char part[])
{
  PgOutput    output = (PgOutput)&column; /* anything but NULL */
  char        text[4096];
  struct stat found;

  CatchErrors();
  assert_int_equal(PgOutputCreate(particles, file, 1, column, &output), code);
  CaughtErrors(text);
  CheckMessage(text, message, part);
  assert_null(output);
  if (!strstr(file, "taken")) assert_int_equal(stat(file, &found), -1);
}

static void names_and_places_are_refused(void **state)
{
  PgParticles particles = MakeDiscs(5, 0, NULL);
  char        path[256], message[512];

  (void)state;
  CheckRefused(particles, PETSC_ERR_USER_INPUT, "io_test_run.dat",
               "porograin: error: result file 'io_test_run.dat': ", "must end in .h5");
  CheckRefused(particles, PETSC_ERR_USER_INPUT, "io_test.h5.txt",
               "porograin: error: result file 'io_test.h5.txt': ", "must end in .h5");
  CheckRefused(particles, PETSC_ERR_USER_INPUT, "io_test_dir/.h5",
               "porograin: error: result file 'io_test_dir/.h5': ", "must end in .h5");
  CheckRefused(particles, PETSC_ERR_USER_INPUT, "", "porograin: error: result file '': ", "must end in .h5");
  CheckRefused(particles, PETSC_ERR_USER_INPUT, "io_test_a:b.h5",
               "porograin: error: result file 'io_test_a:b.h5': ", "must not hold ':'");
  CheckRefused(particles, PETSC_ERR_FILE_OPEN, "io_test_nowhere/run.h5",
               "porograin: error: directory of the result file 'io_test_nowhere': ", "No such file or directory");
  CheckRefused(particles, PETSC_ERR_FILE_OPEN, "/dev/null/run.h5",
               "porograin: error: directory of the result file '/dev/null': ", "Not a directory");
  /* Nobody can make files there, root included. */
  CheckRefused(particles, PETSC_ERR_FILE_OPEN, "/proc/io_test_run.h5",
               "porograin: error: result file '/proc/io_test_run.h5': ", "");

  /* One of the three names is taken by a directory. */
  for (int k = 0; k < 3; k++) {
    const char *const ending[] = {".h5", ".xmf", ".csv"};
    (void)snprintf(path, sizeof path, "%s", FileName("taken", ending[k]));
    if (test_rank == 0) assert_int_equal(mkdir(path, 0700), 0);
    ok(MPI_Barrier(PETSC_COMM_WORLD));
    (void)snprintf(message, sizeof message, "porograin: error: result file '%s': Is a directory", path);
    CheckRefused(particles, PETSC_ERR_FILE_OPEN, FileName("taken", ".h5"), message, "");
    if (test_rank == 0) assert_int_equal(rmdir(path), 0);
    ok(MPI_Barrier(PETSC_COMM_WORLD));
  }
  ok(PgParticlesDestroy(&particles));
}

/* A refused run does not touch the results of the one before. */
static void results_survive_a_refusal(void **state)
{
  PgParticles particles = MakeDiscs(5, 0, NULL);
  char        text[4096];
  PgOutput    output;

  (void)state;
  if (test_rank == 0) {
    FILE *stream = fopen(FileName("kept_taken", ".h5"), "w");
    (void)fputs("results of another day", stream);
    (void)fclose(stream);
    assert_int_equal(mkdir(FileName("kept_taken", ".csv"), 0700), 0);
  }
  ok(MPI_Barrier(PETSC_COMM_WORLD));
  CatchErrors();
  assert_int_equal(PgOutputCreate(particles, FileName("kept_taken", ".h5"), 1, column, &output), PETSC_ERR_FILE_OPEN);
  CaughtErrors(text);
  if (test_rank == 0) {
    char *kept = ReadWholeFile(FileName("kept_taken", ".h5"));
    assert_string_equal(kept, "results of another day");
    free(kept);
    (void)rmdir(FileName("kept_taken", ".csv"));
  }
  RemoveResult("kept_taken");
  ok(PgParticlesDestroy(&particles));
}

/* The history file on a full device. */
static void csv_on_a_full_disk(void **state)
{
  PgParticles particles = MakeDiscs(5, 0, NULL);
  char        text[4096], message[512];
  PgOutput    output;

  (void)state;
  if (access("/dev/full", W_OK)) skip();
  if (test_rank == 0) {
    (void)unlink(FileName("full", ".csv")); /* of a run that was cut off */
    assert_int_equal(symlink("/dev/full", FileName("full", ".csv")), 0);
  }
  ok(MPI_Barrier(PETSC_COMM_WORLD));
  CatchErrors();
  assert_int_equal(PgOutputCreate(particles, FileName("full", ".h5"), 1, column, &output), PETSC_ERR_FILE_WRITE);
  CaughtErrors(text);
  assert_null(output);
  (void)snprintf(message, sizeof message,
                 "porograin: error: cannot write history file '%s': ", FileName("full", ".csv"));
  CheckMessage(text, message, "No space left on device");
  ok(PgParticlesDestroy(&particles));
  RemoveResult("full");
}

/* After a failed second snapshot the file still says what it said, and the next one takes the place. */
static void CheckRecovery(PgOutput output, const char stem[])
{
  const char *const file = FileName(stem, ".h5");
  PetscReal         value;

  ok(PgResultReadAttribute(PETSC_COMM_WORLD, file, "/snapshots", "count", &value));
  assert_true(value == 1.);
  ok(PgResultReadAttribute(PETSC_COMM_WORLD, file, "/snapshots/000000", "time", &value));
  assert_true(value == 0.5);
  ok(PgOutputSnapshot(output, 0.875, 0, NULL));
  ok(PgResultReadAttribute(PETSC_COMM_WORLD, file, "/snapshots/000001", "time", &value));
  assert_true(value == 0.875);
  if (test_rank == 0) {
    char *index = ReadWholeFile(FileName(stem, ".xmf"));
    assert_null(strstr(index, "0.75"));
    assert_non_null(strstr(index, "<Time Value=\"0.875\"/>"));
    free(index);
  }
  ok(MPI_Barrier(PETSC_COMM_WORLD));
}

/* A limit on the size of files, below the end of the next snapshot, on one rank. */
static void Limit(const char file[], PetscMPIInt limited_rank, struct rlimit *before)
{
  struct rlimit limit;
  struct stat   found;

  assert_int_equal(stat(file, &found), 0);
  assert_int_equal(getrlimit(RLIMIT_FSIZE, before), 0);
  limit          = *before;
  limit.rlim_cur = (rlim_t)found.st_size + 200000; /* less than half of a snapshot */
  (void)signal(SIGXFSZ, SIG_IGN);
  ok(MPI_Barrier(PETSC_COMM_WORLD));
  if (test_rank == limited_rank) assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
}

/* It stands for a disk that fills up; the snapshot is refused before HDF5 begins. */
static void no_room_for_a_snapshot(void **state)
{
  const char *const file      = FileName("limit", ".h5");
  PgParticles       particles = MakeDiscs(20000, 0, NULL);
  struct rlimit     before;
  char              text[4096];
  PgOutput          output;
  PetscReal         row = 2.5;

  (void)state;
  ok(PgOutputCreate(particles, file, 1, column, &output));
  ok(PgOutputSnapshot(output, 0.5, 0, NULL));
  ok(PgOutputHistory(output, &row));
  Limit(file, 0, &before);
  CatchErrors();
  assert_int_equal(PgOutputSnapshot(output, 0.75, 0, NULL), PETSC_ERR_FILE_WRITE);
  CaughtErrors(text);
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
  CheckMessage(text, "porograin: error: cannot write ", file);
  CheckRecovery(output, "limit");
  ok(PgOutputDestroy(&output));
  ok(PgParticlesDestroy(&particles));
  RemoveResult("limit");
}

static void no_room_for_a_new_file(void **state)
{
  PgParticles   particles = MakeDiscs(5, 0, NULL);
  struct rlimit before, limit;
  char          text[4096], message[512];
  PgOutput      output;

  (void)state;
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
  limit          = before;
  limit.rlim_cur = 4096;
  (void)signal(SIGXFSZ, SIG_IGN);
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
  CatchErrors();
  assert_int_equal(PgOutputCreate(particles, FileName("new", ".h5"), 1, column, &output), PETSC_ERR_FILE_WRITE);
  CaughtErrors(text);
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
  assert_null(output);
  (void)snprintf(message, sizeof message, "porograin: error: cannot write result file '%s': ", FileName("new", ".h5"));
  CheckMessage(text, message, "File too large");
  assert_int_equal(access(FileName("new", ".h5"), F_OK), -1);
  ok(PgParticlesDestroy(&particles));
}

/* Rank 0 alone writes: what the others may write does not matter. On two ranks the positions, 320 KB of a rank, come
   in more than one message. */
static void other_ranks_need_no_disk(void **state)
{
  const PetscInt discs     = 40000;
  PgParticles    particles = MakeDiscs(discs, 0, NULL);
  struct rlimit  before;
  PgOutput       output;
  PetscInt       rows, columns;
  PetscReal     *x;

  (void)state;
  if (test_size == 1) skip();
  ok(PgOutputCreate(particles, FileName("others", ".h5"), 1, column, &output));
  Limit(FileName("others", ".h5"), test_size - 1, &before);
  ok(PgOutputSnapshot(output, 0.5, 0, NULL));
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
  ok(PgResultRead(PETSC_COMM_WORLD, FileName("others", ".h5"), "/snapshots/000000/position", &rows, &columns, &x));
  assert_int_equal(rows, discs);
  assert_int_equal(columns, 2);
  for (PetscInt k = 0; k < 2 * rows; k++) assert_true(x[k] == PositionAt(k / 2, k % 2));
  ok(PetscFree(x));
  ok(PgOutputDestroy(&output));
  ok(PgParticlesDestroy(&particles));
  RemoveResult("others");
}

static void CheckUnreadable(const char file[], const char path[], PetscErrorCode code, const char part[])
{
  char       text[4096], message[512];
  PetscInt   n, m;
  PetscReal *value;

  CatchErrors();
  assert_int_equal(PgResultRead(PETSC_COMM_WORLD, file, path, &n, &m, &value), code);
  CaughtErrors(text);
  assert_null(value);
  (void)snprintf(message, sizeof message, "porograin: error: result file '%s': cannot ", file);
  CheckMessage(text, message, part);
}

static void what_cannot_be_read(void **state)
{
  const char *const file      = FileName("read", ".h5");
  PgParticles       particles = MakeDiscs(5, 0, NULL);
  char              text[4096];
  PgOutput          output;
  PetscReal         value;

  (void)state;
  ok(PgOutputCreate(particles, file, 1, column, &output));
  ok(PgOutputSnapshot(output, 0.5, 0, NULL));
  CheckUnreadable("io_test_nowhere.h5", "/snapshots/000000/id", PETSC_ERR_FILE_OPEN, "No such file or directory");
  CheckUnreadable(FileName("read", ".csv"), "/snapshots/000000/id", PETSC_ERR_FILE_OPEN, "it is not a file of HDF5");
  CheckUnreadable(file, "/snapshots/000007/id", PETSC_ERR_FILE_READ, "/snapshots/000007/id");
  CheckUnreadable(file, "/snapshots/000000", PETSC_ERR_FILE_READ, "dataset '/snapshots/000000'");
  CatchErrors();
  assert_int_equal(PgResultReadAttribute(PETSC_COMM_WORLD, file, "/snapshots/000000", "tide", &value),
                   PETSC_ERR_FILE_READ);
  CaughtErrors(text);
  CheckMessage(text, "porograin: error: result file '", "attribute '/snapshots/000000, tide'");
  CatchErrors();
  assert_int_equal(PgResultReadAttribute(PETSC_COMM_WORLD, file, "/provenance", "date", &value), PETSC_ERR_FILE_READ);
  CaughtErrors(text);
  CheckMessage(text, "porograin: error: result file '", "'/provenance, date': it is not a number");

  /* Half of the file is not taken for the file. */
  if (test_rank == 0) {
    struct stat found;
    assert_int_equal(stat(file, &found), 0);
    assert_int_equal(truncate(file, found.st_size / 2), 0);
  }
  ok(MPI_Barrier(PETSC_COMM_WORLD));
  CheckUnreadable(file, "/snapshots/000000/id", PETSC_ERR_FILE_OPEN, "truncated file");

  /* Nor written to. */
  CatchErrors();
  assert_int_equal(PgOutputSnapshot(output, 0.625, 0, NULL), PETSC_ERR_FILE_WRITE);
  CaughtErrors(text);
  CheckMessage(text, "porograin: error: cannot write ", "the file has been cut since it was written");
  ok(PgOutputDestroy(&output));
  ok(PgParticlesDestroy(&particles));
  RemoveResult("read");
}

int main(int argc, char *argv[])
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(names_and_places_are_refused), cmocka_unit_test(results_survive_a_refusal),
      cmocka_unit_test(csv_on_a_full_disk),           cmocka_unit_test(no_room_for_a_snapshot),
      cmocka_unit_test(no_room_for_a_new_file),       cmocka_unit_test(other_ranks_need_no_disk),
      cmocka_unit_test(what_cannot_be_read),
  };
  PetscErrorCode err;
  int            failed;

  if (StartTests(&argc, &argv, &err)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(err) || failed;
}
