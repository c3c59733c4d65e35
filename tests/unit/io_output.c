/* ranks: 1 2 4 */
/* Results written by any number of ranks and read back: values by id, attributes, history, index. */
#include "io_testing.h"

enum { DISCS = 23, EXTRA_FIELDS = 3 };

static const PgFieldInfo extra_field[EXTRA_FIELDS] = {
    {"alpha", 1, "Pa", "a scalar that is written", PG_FIELD_OUTPUT},
    {"hidden", 2, "m", "a vector that is not written", PG_FIELD_MIGRATE},
    {"sigma", 4, "N/m", "a tensor that is written", PG_FIELD_MIGRATE | PG_FIELD_OUTPUT},
};

static const PgColumn column[] = {
    {"time", "s", "time of the row"},
    {"load", "N/m", "what the plate feels"},
    {"steps", "1", "number of steps"},
};
enum { COLUMNS = 3 };

static void HistoryRow(PetscInt k, PetscReal row[COLUMNS])
{
  row[0] = 0.1 * (PetscReal)k; /* 0.1 has no short binary form: the text needs all its digits */
  row[1] = -2. / (3. + (PetscReal)k);
  row[2] = 7. + (PetscReal)k;
}

static void AddRows(PgOutput output, PetscInt from, PetscInt to)
{
  PetscReal row[COLUMNS];

  for (PetscInt k = from; k < to; k++) {
    HistoryRow(k, row);
    ok(PgOutputHistory(output, row));
  }
}

static void CheckDataset(const char file[], const char path[], PetscInt rows, PetscInt columns, PetscInt seed)
{
  PetscInt   n, m;
  PetscReal *value;

  ok(PgResultRead(PETSC_COMM_WORLD, file, path, &n, &m, &value));
  assert_int_equal(n, rows);
  assert_int_equal(m, columns);
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt c = 0; c < m; c++)
      assert_true(value[i * m + c] == (seed == PG_POSITION ? PositionAt(i, c) : ValueAt(seed, i, c)));
  ok(PetscFree(value));
}

static void CheckHistory(const char file[], PetscInt rows)
{
  for (int c = 0; c < COLUMNS; c++) {
    char       path[64];
    PetscInt   n, m;
    PetscReal *value, row[COLUMNS];

    (void)snprintf(path, sizeof path, "/history/%s", column[c].name);
    ok(PgResultRead(PETSC_COMM_WORLD, file, path, &n, &m, &value));
    assert_int_equal(n, rows);
    assert_int_equal(m, 1);
    for (PetscInt k = 0; k < n; k++) {
      HistoryRow(k, row);
      assert_true(value[k] == row[c]);
    }
    ok(PetscFree(value));
  }
}

static void CheckCsv(const char file[], PetscInt rows)
{
  char *text, *c;

  if (test_rank) return;
  text = ReadWholeFile(file);
  c    = strchr(text, '\n');
  assert_non_null(c);
  *c++ = 0;
  assert_string_equal(text, "time [s],load [N/m],steps [1]");
  for (PetscInt k = 0; k < rows; k++) {
    PetscReal row[COLUMNS];
    HistoryRow(k, row);
    for (int m = 0; m < COLUMNS; m++) {
      assert_true(strtod(c, &c) == row[m]);
      assert_int_equal(*c++, m < COLUMNS - 1 ? ',' : '\n');
    }
  }
  assert_int_equal(*c, 0);
  free(text);
}

/* The text attribute as a reader that knows nothing of porograin sees it, on rank 0. */
static char *TextAttribute(const char file[], const char object[], const char name[])
{
  hid_t h       = H5Fopen(file, H5F_ACC_RDONLY, H5P_DEFAULT), a, type;
  char *in_file = NULL, *copy;

  assert_true(h >= 0);
  a = H5Aopen_by_name(h, object, name, H5P_DEFAULT, H5P_DEFAULT);
  assert_true(a >= 0);
  type = H5Aget_type(a);
  assert_true(H5Tis_variable_str(type) > 0);
  assert_true(H5Aread(a, type, &in_file) >= 0);
  copy = strdup(in_file);
  (void)H5free_memory(in_file);
  (void)H5Tclose(type);
  (void)H5Aclose(a);
  (void)H5Fclose(h);
  return copy;
}

static void CheckText(const char file[], const char object[], const char name[], const char expected[])
{
  char *text;

  if (test_rank) return;
  text = TextAttribute(file, object, name);
  assert_string_equal(text, expected);
  free(text);
}

static void CheckAbsent(const char file[], const char path[])
{
  PetscInt   n, m;
  PetscReal *value;
  char       text[4096];

  CatchErrors();
  assert_int_equal(PgResultRead(PETSC_COMM_WORLD, file, path, &n, &m, &value), PETSC_ERR_FILE_READ);
  CaughtErrors(text);
  assert_null(value);
  CheckMessage(text, "porograin: error: result file '", path);
}

static void fields_come_back_by_id(void **state)
{
  const char *const file      = FileName("fields", ".h5");
  PgParticles       particles = MakeDiscs(DISCS, EXTRA_FIELDS, extra_field);
  PgOutput          output;
  PetscInt          n, m, start, count;
  PetscReal        *id, time;
  PetscReal        *extra;

  (void)state;
  ok(PgOutputCreate(particles, file, COLUMNS, column, &output));
  ok(PgOutputSnapshot(output, 0., 0, NULL));
  /* The second one has other values, other owners, and fields that no particle store holds. */
  ok(PgParticlesForceMigration(particles, 1));
  ok(PgParticlesDistribute(particles, 0.1));
  ok(PgParticlesGetFieldCount(particles, &n));
  for (PgField f = 0; f < n; f++) FillField(particles, f, f == PG_POSITION ? f : f + 50);
  ok(PgParticlesGetIdRange(particles, &start, &count));
  ok(PetscMalloc1(2 * count, &extra));
  for (PetscInt k = 0; k < count; k++)
    for (PetscInt c = 0; c < 2; c++) extra[2 * k + c] = ValueAt(99, start + k, c);
  {
    const PgExtraField field = {"strain_like", 2, "1", "made after the fact", extra};
    ok(PgOutputSnapshot(output, 0.125, 1, &field));
  }
  ok(PetscFree(extra));
  ok(PgOutputGetSnapshotCount(output, &n));
  assert_int_equal(n, 2);
  ok(PgOutputFinish(output));
  ok(PgOutputDestroy(&output));
  assert_null(output);

  ok(PgResultReadAttribute(PETSC_COMM_WORLD, file, "/snapshots", "count", &time));
  assert_true(time == 2.);
  ok(PgResultReadAttribute(PETSC_COMM_WORLD, file, "/snapshots/000001", "time", &time));
  assert_true(time == 0.125);
  ok(PgResultRead(PETSC_COMM_WORLD, file, "/snapshots/000001/id", &n, &m, &id));
  assert_int_equal(n, DISCS);
  for (PetscInt k = 0; k < n; k++) assert_true(id[k] == (PetscReal)k);
  ok(PetscFree(id));
  CheckDataset(file, "/snapshots/000000/position", DISCS, 2, PG_POSITION);
  CheckDataset(file, "/snapshots/000000/alpha", DISCS, 1, PG_CORE_FIELDS);
  CheckDataset(file, "/snapshots/000000/sigma", DISCS, 4, PG_CORE_FIELDS + 2);
  CheckDataset(file, "/snapshots/000001/position", DISCS, 2, PG_POSITION);
  CheckDataset(file, "/snapshots/000001/alpha", DISCS, 1, PG_CORE_FIELDS + 50);
  CheckDataset(file, "/snapshots/000001/sigma", DISCS, 4, PG_CORE_FIELDS + 52);
  CheckDataset(file, "/snapshots/000001/strain_like", DISCS, 2, 99);
  CheckAbsent(file, "/snapshots/000001/hidden");
  CheckAbsent(file, "/snapshots/000000/strain_like");
  CheckAbsent(file, "/snapshots/.incomplete");
  CheckText(file, "/snapshots/000000/sigma", "unit", "N/m");
  CheckText(file, "/snapshots/000000/sigma", "description", "a tensor that is written");
  CheckText(file, "/snapshots/000001/strain_like", "description", "made after the fact");
  CheckText(file, "/snapshots/000001", "time_unit", "s");
  CheckText(file, "/history/load", "unit", "N/m");
  ok(PgParticlesDestroy(&particles));
  RemoveResult("fields");
}

/* Two snapshots of 3 discs: on four ranks some own none, and one has no row to write. */
static void ranks_without_discs(void **state)
{
  const char *const file      = FileName("few", ".h5");
  PgParticles       particles = MakeDiscs(3, EXTRA_FIELDS, extra_field);
  PgOutput          output;

  (void)state;
  ok(PgOutputCreate(particles, file, 0, NULL, &output));
  ok(PgOutputSnapshot(output, 1.5, 0, NULL));
  ok(PgOutputFinish(output));
  ok(PgOutputDestroy(&output));
  CheckDataset(file, "/snapshots/000000/position", 3, 2, PG_POSITION);
  CheckDataset(file, "/snapshots/000000/sigma", 3, 4, PG_CORE_FIELDS + 2);
  ok(PgParticlesDestroy(&particles));
  RemoveResult("few");
}

/* What a killed run leaves behind: the files as they are between two snapshots. */
static void CopyFile(const char from[], const char to[])
{
  if (test_rank == 0) {
    struct stat found;
    char       *bytes  = ReadWholeFile(from);
    FILE       *stream = fopen(to, "wb");

    assert_int_equal(stat(from, &found), 0);
    assert_non_null(stream);
    assert_int_equal(fwrite(bytes, 1, (size_t)found.st_size, stream), found.st_size);
    assert_int_equal(fclose(stream), 0);
    free(bytes);
  }
  ok(MPI_Barrier(PETSC_COMM_WORLD));
}

static void history_goes_on_and_a_kill_leaves_it(void **state)
{
  const char *const file = FileName("history", ".h5"), *const copy = FileName("copy", ".h5");
  PgParticles particles = MakeDiscs(DISCS, EXTRA_FIELDS, extra_field);
  PgOutput    output;
  PetscReal   count;

  (void)state;
  ok(PgOutputCreate(particles, file, COLUMNS, column, &output));
  AddRows(output, 0, 5);
  CheckCsv(FileName("history", ".csv"), 5);
  ok(PgOutputSnapshot(output, 0., 0, NULL));
  CheckHistory(file, 5);
  ok(PgOutputSnapshot(output, 0.1, 0, NULL)); /* without a row in between */
  AddRows(output, 5, 6);
  ok(PgOutputSnapshot(output, 0.2, 0, NULL));
  AddRows(output, 6, 2600); /* more than is kept in memory, more than a chunk of the file */
  CopyFile(file, copy);
  CheckDataset(copy, "/snapshots/000002/alpha", DISCS, 1, PG_CORE_FIELDS);
  ok(PgResultReadAttribute(PETSC_COMM_WORLD, copy, "/snapshots", "count", &count));
  assert_true(count == 3.);
  if (test_rank == 0) (void)unlink(copy);
  CheckCsv(FileName("history", ".csv"), 2600);
  ok(PgOutputFinish(output));
  ok(PgOutputFinish(output)); /* nothing twice */
  ok(PgOutputDestroy(&output));
  CheckHistory(file, 2600);
  ok(PgParticlesDestroy(&particles));
  RemoveResult("history");
}

/* Elements open and close in order, attributes are quoted, and no '&' or '<' stands bare in a text. */
static void CheckXml(const char text[])
{
  char open_names[16][64];
  int  depth = 0;

  for (const char *c = text; *c; c++) {
    if (*c == '&') assert_true(!strncmp(c, "&amp;", 5) || !strncmp(c, "&lt;", 4) || !strncmp(c, "&quot;", 6));
    if (*c != '<') continue;
    {
      const char *const end    = strchr(c, '>');
      const size_t      name   = strcspn(c + 1, " >/");
      int               quotes = 0;

      assert_non_null(end);
      for (const char *q = c; q < end; q++) quotes += *q == '"';
      assert_int_equal(quotes % 2, 0);
      if (c[1] == '/') {
        assert_true(depth > 0);
        depth--;
        assert_int_equal(strncmp(c + 2, open_names[depth], (size_t)(end - c - 2)), 0);
        assert_int_equal(open_names[depth][end - c - 2], 0);
      } else if (c[1] != '?' && c[1] != '!' && end[-1] != '/') {
        assert_true(depth < 16 && name < 63);
        (void)memset(open_names[depth], 0, 64);
        (void)memcpy(open_names[depth], c + 1, name);
        depth++;
      }
      c = end;
    }
  }
  assert_int_equal(depth, 0);
}

static int Count(const char text[], const char what[])
{
  int n = 0;

  for (const char *c = text; (c = strstr(c, what)); c++) n++;
  return n;
}

static void index_for_paraview(void **state)
{
  const char *const file      = FileName("a&b c", ".h5");
  PgParticles       particles = MakeDiscs(DISCS, EXTRA_FIELDS, extra_field);
  PgOutput          output;

  (void)state;
  ok(PgOutputCreate(particles, file, 0, NULL, &output));
  ok(PgOutputSnapshot(output, 0.1, 0, NULL));
  ok(PgOutputSnapshot(output, 0.25, 0, NULL));
  if (test_rank == 0) {
    char *text = ReadWholeFile(FileName("a&b c", ".xmf")), expected[256];

    CheckXml(text);
    assert_int_equal(Count(text, "<Time Value=\"0.1\"/>"), 1);
    assert_int_equal(Count(text, "<Time Value=\"0.25\"/>"), 1);
    assert_int_equal(Count(text, "<Topology TopologyType=\"Polyvertex\" NumberOfElements=\"23\""), 2);
    assert_int_equal(Count(text, "<Attribute Name=\"sigma\" AttributeType=\"Matrix\" Center=\"Node\">"), 2);
    assert_int_equal(Count(text, "hidden"), 0);
    (void)snprintf(expected, sizeof expected,
                   "Precision=\"%d\" Dimensions=\"23 4\">io_test_a&amp;b c_%dranks.h5:/snapshots/000001/sigma<",
                   (int)sizeof(PetscReal), test_size);
    assert_int_equal(Count(text, expected), 1);
    free(text);
  }
  ok(PgOutputDestroy(&output)); /* a run that fails does not finish */
  ok(PgParticlesDestroy(&particles));
  RemoveResult("a&b c");
}

static void provenance(void **state)
{
  const char *const file      = FileName("provenance", ".h5");
  PgParticles       particles = MakeDiscs(DISCS, 0, NULL);
  PgOutput          output;
  PetscReal         ranks, value;
  PetscBool         set;

  (void)state;
  ok(PetscOptionsSetValue(NULL, "-io_test_flux", "-0.13"));
  /* Neither the name that starts the used one nor the name that it starts is taken for it. */
  ok(PetscOptionsSetValue(NULL, "-io_test_flu", "3"));
  ok(PetscOptionsSetValue(NULL, "-io_test_fluxx", "a b"));
  ok(PetscOptionsSetValue(NULL, "-io_test_flag", NULL));
  ok(PgOutputCreate(particles, file, 0, NULL, &output));
  ok(PetscOptionsGetReal(NULL, NULL, "-io_test_flux", &value, &set));
  ok(PgOutputFinish(output));
  ok(PgOutputDestroy(&output));
  ok(PgResultReadAttribute(PETSC_COMM_WORLD, file, "/provenance", "ranks", &ranks));
  assert_int_equal((int)ranks, test_size);
  CheckText(file, "/provenance", "program_version", PG_VERSION);
  CheckText(file, "/provenance", "options_unused", "-io_test_flag\n-io_test_flu 3\n-io_test_fluxx a b");
  if (test_rank == 0) {
    char *all   = TextAttribute(file, "/provenance", "options"),
         *used  = TextAttribute(file, "/provenance", "options_used");
    char *date  = TextAttribute(file, "/provenance", "date"),
         *petsc = TextAttribute(file, "/provenance", "petsc_version");
    int major, minor, release;

    assert_non_null(strstr(all, "-io_test_flag\n-io_test_flu 3\n-io_test_flux -0.13\n-io_test_fluxx a b"));
    assert_non_null(strstr(used, "-io_test_flux -0.13"));
    assert_null(strstr(used, "-io_test_fluxx"));
    assert_int_equal(strlen(date), strlen("2000-01-01T00:00:00Z"));
    assert_int_equal(sscanf(petsc, "%d.%d.%d", &major, &minor, &release), 3);
    assert_int_equal(major, PETSC_VERSION_MAJOR);
    assert_int_equal(minor, PETSC_VERSION_MINOR);
    free(all);
    free(used);
    free(date);
    free(petsc);
  }
  ok(PetscOptionsClearValue(NULL, "-io_test_flux"));
  ok(PetscOptionsClearValue(NULL, "-io_test_flu"));
  ok(PetscOptionsClearValue(NULL, "-io_test_fluxx"));
  ok(PetscOptionsClearValue(NULL, "-io_test_flag"));
  ok(PgParticlesDestroy(&particles));
  RemoveResult("provenance");
}

int main(int argc, char *argv[])
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(fields_come_back_by_id),
      cmocka_unit_test(ranks_without_discs),
      cmocka_unit_test(history_goes_on_and_a_kill_leaves_it),
      cmocka_unit_test(index_for_paraview),
      cmocka_unit_test(provenance),
  };
  PetscErrorCode err;
  int            failed;

  if (StartTests(&argc, &argv, &err)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(err) || failed;
}
