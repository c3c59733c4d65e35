/* ranks: 1 2 */
/* Damaged and foreign checkpoints are refused on every rank, with one message that names file, dataset and reason.
   The seal tells any change of bytes; behind a good seal everything is compared with what the run needs. */
#include "io_testing.h"
#include <sys/types.h>

enum { DISCS = 23, SEAL = 32 };

static PgRagged    touching;
static PgParticles discs;
static const char *good, *bad;

static PgState MakeState(PetscReal *time, PetscInt *step, char name[16])
{
  PgState state;

  ok(PgStateCreate(&state));
  ok(PgStateAddReals(state, "test_time", PG_STATE_KEEP, NULL, 1, time));
  ok(PgStateAddInts(state, "test_step", PG_STATE_KEEP, NULL, 1, step));
  ok(PgStateAddText(state, "test_name", PG_STATE_KEEP, NULL, 16, name));
  return state;
}

/* Every disc has one record. */
static int SetUp(void **state)
{
  const PgFieldInfo extra[]  = {{"spring", 2, "N", "a field", PG_FIELD_MIGRATE | PG_FIELD_RESTART}};
  PetscReal         time     = 0.25, *record;
  PetscInt          step     = 3, owned, *offset;
  char              name[16] = "name";
  PgState           numbers;

  (void)state;
  good  = FileName("good", ".pgc");
  bad   = FileName("bad", ".pgc");
  discs = MakeDiscs(DISCS, 1, extra);
  ok(PgParticlesRegisterRagged(discs, "touching", 2, PG_FIELD_MIGRATE | PG_FIELD_RESTART, &touching));
  ok(PgParticlesGetSizes(discs, &owned, NULL, NULL));
  ok(PetscMalloc2(owned + 1, &offset, 2 * owned, &record));
  for (PetscInt i = 0; i <= owned; i++) offset[i] = i;
  for (PetscInt i = 0; i < 2 * owned; i++) record[i] = 0.5 + (PetscReal)i;
  ok(PgParticlesSetRagged(discs, touching, offset, record));
  ok(PetscFree2(offset, record));
  numbers = MakeState(&time, &step, name);
  ok(PgCheckpointWrite(discs, numbers, good));
  ok(PgStateDestroy(&numbers));
  return 0;
}

static int TearDown(void **state)
{
  (void)state;
  if (test_rank == 0) {
    (void)unlink(good);
    (void)unlink(bad);
  }
  ok(PgParticlesDestroy(&discs));
  return 0;
}

/* Reads all of the bad file, as a restart does; the first error. */
static PetscErrorCode ReadBad(void)
{
  PetscReal      time = 0;
  PetscInt       step = 0;
  char           name[16];
  PgCheckpoint   checkpoint;
  PgState        numbers = MakeState(&time, &step, name);
  PetscErrorCode err     = PgCheckpointOpen(PETSC_COMM_WORLD, bad, &checkpoint);

  if (err) {
    assert_null(checkpoint);
  } else {
    err = PgCheckpointReadState(checkpoint, numbers);
    if (!err) err = PgCheckpointReadFields(checkpoint, discs);
    if (PgCheckpointClose(&checkpoint) && !err) err = PETSC_ERR_PLIB;
  }
  ok(PgStateDestroy(&numbers));
  return err;
}

static void MustBeRefused(const char reason[])
{
  char start[256], text[4096];

  ok(MPI_Barrier(PETSC_COMM_WORLD));
  CatchErrors();
  assert_int_not_equal(ReadBad(), 0);
  CaughtErrors(text);
  (void)snprintf(start, sizeof start, "'%s': ", bad);
  CheckMessage(text, "porograin: error: ", start);
  CheckMessage(text, "porograin: error: ", reason);
}

/* ---- bytes ---- */

static unsigned char *content;
static long           length;

static void Load(void)
{
  FILE *stream = fopen(good, "rb");

  assert_non_null(stream);
  (void)fseek(stream, 0, SEEK_END);
  length = ftell(stream);
  rewind(stream);
  content = malloc((size_t)length);
  assert_non_null(content);
  assert_int_equal(fread(content, 1, (size_t)length, stream), length);
  assert_int_equal(fclose(stream), 0);
}

static void Store(long bytes)
{
  FILE *stream;

  if (test_rank) return;
  stream = fopen(bad, "wb");
  assert_non_null(stream);
  assert_int_equal(fwrite(content, 1, (size_t)bytes, stream), bytes);
  assert_int_equal(fclose(stream), 0);
}

/* A bit in each of 300 places, among them all of the seal. */
static void no_flipped_bit_is_accepted(void **state)
{
  (void)state;
  Load();
  Store(length);
  ok(MPI_Barrier(PETSC_COMM_WORLD));
  ok(ReadBad()); /* so that it is the bit */
  for (long k = 0; k < 300; k++) {
    const long at = k < SEAL ? length - 1 - k : (k - SEAL) * (length - SEAL) / (300 - SEAL);
    content[at] ^= (unsigned char)(1 << (k % 8));
    Store(length);
    content[at] ^= (unsigned char)(1 << (k % 8));
    MustBeRefused("");
  }
  free(content);
}

static void no_truncated_file_is_accepted(void **state)
{
  (void)state;
  Load();
  for (long k = 0; k < 100; k++) { /* short ones, around the seal, and others */
    Store(k < 20 ? k : k < 60 ? length - (k - 19) : (k - 60) * length / 40);
    MustBeRefused("");
  }
  Store(0);
  MustBeRefused("it is empty");
  content = realloc(content, (size_t)length + 1);
  assert_non_null(content);
  content[length] = 0;
  Store(length + 1);
  MustBeRefused("it has no seal at its end");
  free(content);
}

static void other_things_are_no_checkpoints(void **state)
{
  (void)state;
  if (test_rank == 0) {
    (void)unlink(bad);
    assert_int_equal(mkdir(bad, 0700), 0);
  }
  MustBeRefused("there is no checkpoint");
  ok(MPI_Barrier(PETSC_COMM_WORLD));
  if (test_rank == 0) {
    assert_int_equal(rmdir(bad), 0);
    assert_int_equal(mkfifo(bad, 0600), 0); /* must not be waited for */
  }
  MustBeRefused("it is not a regular file");
  ok(MPI_Barrier(PETSC_COMM_WORLD));
  if (test_rank == 0) assert_int_equal(unlink(bad), 0);
  MustBeRefused("No such file or directory");
}

/* ---- content behind a good seal ---- */

/* Replaces a dataset; value NULL: nothing is written. */
static void Put(hid_t file, const char path[], hid_t type, int rank, const hsize_t size[], const void *value)
{
  const hid_t space = H5Screate_simple(rank, size, NULL);
  hid_t       dataset;

  if (H5Lexists(file, path, H5P_DEFAULT) > 0) assert_true(H5Ldelete(file, path, H5P_DEFAULT) >= 0);
  dataset = H5Dcreate2(file, path, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  assert_true(dataset >= 0);
  if (value) assert_true(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0);
  (void)H5Dclose(dataset);
  (void)H5Sclose(space);
}

static void PutNumber(hid_t file, const char name[], int value)
{
  hid_t attribute, space = H5Screate(H5S_SCALAR);

  assert_true(H5Adelete(file, name) >= 0);
  attribute = H5Acreate2(file, name, H5T_NATIVE_INT, space, H5P_DEFAULT, H5P_DEFAULT);
  assert_true(H5Awrite(attribute, H5T_NATIVE_INT, &value) >= 0);
  (void)H5Aclose(attribute);
  (void)H5Sclose(space);
}

static double values[4 * DISCS]; /* some numbers */
static int    ones[DISCS];       /* as many records as there are */

static void Fill(void)
{
  for (int k = 0; k < 4 * DISCS; k++) values[k] = 0.37 * k - 1.0;
  for (int k = 0; k < DISCS; k++) ones[k] = 1;
}

static const hsize_t n1[1] = {DISCS}, n2[2] = {DISCS, 2}, one[1] = {1}, two[1] = {2};

#define CHANGE(name, ...)                                                                                              \
  static void name(hid_t file) { __VA_ARGS__; }
CHANGE(FieldMissing, H5Ldelete(file, "/fields/spring", H5P_DEFAULT))
CHANGE(FieldOfAnotherModel, Put(file, "/fields/salinity", H5T_NATIVE_DOUBLE, 1, n1, values))
CHANGE(FieldTooShort, {
  const hsize_t size[2] = {DISCS - 1, 2};
  Put(file, "/fields/spring", H5T_NATIVE_DOUBLE, 2, size, values);
})
CHANGE(FieldTransposed, {
  const hsize_t size[2] = {2, DISCS};
  Put(file, "/fields/spring", H5T_NATIVE_DOUBLE, 2, size, values);
})
CHANGE(FieldFlat, {
  const hsize_t size[1] = {2 * DISCS};
  Put(file, "/fields/spring", H5T_NATIVE_DOUBLE, 1, size, values);
})
CHANGE(FieldHuge, {
  const hsize_t size[2] = {(hsize_t)1 << 40, 2};
  Put(file, "/fields/spring", H5T_NATIVE_DOUBLE, 2, size, NULL);
})
CHANGE(FieldOfIntegers, {
  const hsize_t size[2] = {DISCS, 2};
  Put(file, "/fields/spring", H5T_NATIVE_INT64, 2, size, values);
})
CHANGE(FieldOfSingles, {
  float single[2 * DISCS];
  for (int k = 0; k < 2 * DISCS; k++) single[k] = (float)values[k];
  Put(file, "/fields/spring", H5T_NATIVE_FLOAT, 2, n2, single);
})
CHANGE(FieldOfTexts, {
  hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, 8);
  Put(file, "/fields/spring", type, 2, n2, values);
  H5Tclose(type);
})
CHANGE(FieldNan, {
  values[17] = NAN;
  Put(file, "/fields/spring", H5T_NATIVE_DOUBLE, 2, n2, values);
  Fill();
})
CHANGE(FieldInfinite, {
  values[2 * DISCS - 1] = -INFINITY;
  Put(file, "/fields/spring", H5T_NATIVE_DOUBLE, 2, n2, values);
  Fill();
})
CHANGE(FieldIsGroup, {
  H5Ldelete(file, "/fields/spring", H5P_DEFAULT);
  H5Gclose(H5Gcreate2(file, "/fields/spring", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
})
CHANGE(FieldsMissing, H5Ldelete(file, "/fields", H5P_DEFAULT))
CHANGE(StateMissing, H5Ldelete(file, "/state", H5P_DEFAULT))
CHANGE(TimeMissing, H5Ldelete(file, "/state/test_time", H5P_DEFAULT))
CHANGE(TimeTwice, Put(file, "/state/test_time", H5T_NATIVE_DOUBLE, 1, two, values))
CHANGE(TimeNan, {
  const double nan_value = NAN;
  Put(file, "/state/test_time", H5T_NATIVE_DOUBLE, 1, one, &nan_value);
})
CHANGE(StepReal, Put(file, "/state/test_step", H5T_NATIVE_DOUBLE, 1, one, values))
CHANGE(NameMissing, H5Adelete_by_name(file, "/state", "test_name", H5P_DEFAULT))
CHANGE(CountNegative, {
  ones[5] = -1;
  Put(file, "/ragged/touching/count", H5T_NATIVE_INT, 1, n1, ones);
  Fill();
})
CHANGE(CountHuge, {
  ones[0] = 2147483647;
  Put(file, "/ragged/touching/count", H5T_NATIVE_INT, 1, n1, ones);
  Fill();
})
CHANGE(CountOneMore, {
  ones[DISCS - 1] = 2;
  Put(file, "/ragged/touching/count", H5T_NATIVE_INT, 1, n1, ones);
  Fill();
})
CHANGE(CountReal, Put(file, "/ragged/touching/count", H5T_NATIVE_DOUBLE, 1, n1, values))
CHANGE(RecordNan, {
  values[3] = NAN;
  Put(file, "/ragged/touching/record", H5T_NATIVE_DOUBLE, 2, n2, values);
  Fill();
})
CHANGE(RecordNarrow, Put(file, "/ragged/touching/record", H5T_NATIVE_DOUBLE, 1, n1, values))
CHANGE(RaggedMissing, H5Ldelete(file, "/ragged/touching", H5P_DEFAULT))
CHANGE(OtherDiscs, PutNumber(file, "discs", DISCS + 1))
CHANGE(OtherPrecision, PutNumber(file, "real_bytes", 4))
CHANGE(LaterVersion, PutNumber(file, "format_version", 99))
CHANGE(VersionMissing, H5Adelete(file, "format_version"))
CHANGE(FormatMissing, H5Adelete(file, "format"))
CHANGE(FormatNumber, PutNumber(file, "format", 1))

static const struct {
  void (*change)(hid_t);
  const char *reason;
} changes[] = {
    {FieldMissing, "cannot read dataset '/fields/spring': it is missing"},
    {FieldOfAnotherModel, "cannot use dataset '/fields/salinity': this run has no such field"},
    {FieldTooShort, "cannot read dataset '/fields/spring': its shape is (22, 2) where this run needs (23, 2)"},
    {FieldTransposed, "cannot read dataset '/fields/spring': its shape is (2, 23) where this run needs (23, 2)"},
    {FieldFlat, "cannot read dataset '/fields/spring': its shape is (46) where this run needs (23, 2)"},
    {FieldHuge, "cannot read dataset '/fields/spring': its shape is (1099511627776, 2) where this run needs (23, 2)"},
    {FieldOfIntegers, "cannot read dataset '/fields/spring': it does not hold real numbers"},
    {FieldOfSingles, "cannot read dataset '/fields/spring': its real numbers have another precision"},
    {FieldOfTexts, "cannot read dataset '/fields/spring': it does not hold real numbers"},
    {FieldNan, "cannot use dataset '/fields/spring': row 8 is not finite"},
    {FieldInfinite, "cannot use dataset '/fields/spring': row 22 is not finite (-inf)"},
    {FieldIsGroup, "cannot open dataset '/fields/spring': "},
    {FieldsMissing, "cannot read dataset '/fields/position': it is missing"},
    {StateMissing, "cannot read dataset '/state/test_time': it is missing"},
    {TimeMissing, "cannot read dataset '/state/test_time': it is missing"},
    {TimeTwice, "cannot read dataset '/state/test_time': its shape is (2) where this run needs (1)"},
    {TimeNan, "cannot use dataset '/state/test_time': row 0 is not finite"},
    {StepReal, "cannot read dataset '/state/test_step': it does not hold integers"},
    {NameMissing, "cannot read attribute '/state, test_name': it is missing"},
    {CountNegative, "cannot use dataset '/ragged/touching/count': disc 5 has -1 records"},
    {CountHuge, "cannot use dataset '/ragged/touching/count': disc 0 has 2.14748e+09 records"},
    {CountOneMore, "cannot read dataset '/ragged/touching/record': its shape is (23, 2) where this run needs (24, 2)"},
    {CountReal, "cannot read dataset '/ragged/touching/count': it does not hold integers"},
    {RecordNan, "cannot use dataset '/ragged/touching/record': row 1 is not finite"},
    {RecordNarrow, "cannot read dataset '/ragged/touching/record': its shape is (23) where this run needs (23, 2)"},
    {RaggedMissing, "cannot open group '/ragged/touching': it is missing"},
    {OtherDiscs, "cannot go on from it: it holds 24 discs, this run has 23"},
    {OtherPrecision, "cannot use the file: its real numbers have 4 bytes, those of this build of PETSc 8"},
    {LaterVersion, "cannot use the file: its layout has version 99, this program knows 1"},
    {VersionMissing, "cannot read attribute '/, format_version': it is missing"},
    {FormatMissing, "cannot read attribute '/, format': it is missing"},
    {FormatNumber, "cannot read attribute '/, format': it is not a text"},
};

static void no_other_content_is_accepted(void **state)
{
  (void)state;
  Fill();
  Load();
  for (size_t k = 0; k < sizeof changes / sizeof *changes; k++) {
    Store(length - SEAL);
    if (test_rank == 0) {
      const hid_t file = H5Fopen(bad, H5F_ACC_RDWR, H5P_DEFAULT);
      assert_true(file >= 0);
      changes[k].change(file);
      assert_true(H5Fclose(file) >= 0);
      ok(PgCheckpointSeal(bad));
    }
    MustBeRefused(changes[k].reason);
  }
  free(content);
}

int main(int argc, char *argv[])
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(no_flipped_bit_is_accepted),
      cmocka_unit_test(no_truncated_file_is_accepted),
      cmocka_unit_test(other_things_are_no_checkpoints),
      cmocka_unit_test(no_other_content_is_accepted),
  };
  PetscErrorCode err;
  int            failed;

  if (StartTests(&argc, &argv, &err)) return 1;
  failed = cmocka_run_group_tests(tests, SetUp, TearDown);
  return PgFinalize(err) || failed;
}
