/* ranks: 1 timeout: 60 */
/* The reader of CSV packings, a function of text: what it takes, what it refuses and with which words, that pieces do
   not matter, and that nothing upsets it. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include "../fuzz/packing_csv.c"
#include <dirent.h>
#include <locale.h>
#include <stdio.h>
#include <sys/stat.h>

static Reading reading;

static void ReadText(const char text[]) { ReadInPieces(text, strlen(text), 7, 3, &reading); }

static void CheckDisc(PetscInt i, PetscReal x, PetscReal y, PetscReal r, PetscReal vx, PetscReal vy)
{
  const PetscReal expected[] = {x, y, r, vx, vy}, *found = &reading.disc[PG_PACKING_VALUES * i];

  for (int k = 0; k < PG_PACKING_VALUES; k++) assert_true(found[k] == expected[k]);
}

/* Each text holds the same two discs. */
static void what_is_taken(void **state)
{
  static const char *const with_velocity[] = {
      "x,y,r,vx,vy\n0.125,2.5,0.75,-3,1e-3\n-4,0.5,1.5,0,7\n",
      "0.125,2.5,0.75,-3,1e-3\n-4,0.5,1.5,0,7\n",
      "# comment, with commas\n\n x , y,\tr,vx ,vy \r\n\r\n+.125,25e-1,7.5E-1,-3.,+1e-3\r\n   # "
      "nothing\r\n-4,.5,1.5,0,7 # end\r\n",
      "vy,r,vx,y,x\n1e-3,0.75,-3,2.5,0.125\n7,1.5,0,0.5,-4\n",
      "\"x [m]\",Y [m],\"Radius\", vx [m/s] ,\"VY\"\n0.125,2.5,0.75,-3,1e-3\n-4,0.5,1.5,0,7\n",
      "\xef\xbb\xbfx,y,r,vx,vy\n0.125,2.5,0.75,-3,1e-3\n-4,0.5,1.5,0,7\n",
      "#! discs 2\nx,y,r,vx,vy\n0.125,2.5,0.75,-3,1e-3\n-4,0.5,1.5,0,7\n# the end\n",
      "0.125000000000000000000000000000,2.5,0.75,-3,0.001\n-4,0.5,1.5,0,7\n\n\n",
  };

  (void)state;
  for (size_t k = 0; k < sizeof with_velocity / sizeof *with_velocity; k++) {
    ReadText(with_velocity[k]);
    assert_string_equal(reading.csv.reason, "");
    assert_int_equal(reading.discs, 2);
    assert_int_equal(reading.csv.columns, 5);
    assert_false(reading.csv.periodic);
    CheckDisc(0, 0.125, 2.5, 0.75, -3, 1e-3);
    CheckDisc(1, -4, 0.5, 1.5, 0, 7);
  }
  ReadText("#! periodic_x -0.5 3.25\nr,x,y\n0.75,0.125,2.5\n");
  assert_string_equal(reading.csv.reason, "");
  assert_int_equal(reading.csv.columns, 3);
  CheckDisc(0, 0.125, 2.5, 0.75, 0, 0);
  assert_true(reading.csv.periodic && reading.csv.low == -0.5 && reading.csv.high == 3.25);
}

/* What is refused, and how. */
static const struct {
  const char *text, *reason;
} refused[] = {
    {"", "it holds no disc"},
    {"\n# only a comment\n", "it holds no disc"},
    {"x,y,r\n", "it holds no disc"},
    {"1,2,3\n4,5,6", "line 2: the last line has no end: the file may have been cut"},
    {"1,2,3\n4,5\n", "line 2: 2 values separated by commas, the table has 3 columns"},
    {"1,2,3\n4,5,6,7\n", "line 2: 4 values separated by commas, the table has 3 columns"},
    {"1,2,3,\n", "line 1: 4 values separated by commas; without a line of names"},
    {"1,2\n", "line 1: 2 values separated by commas"},
    {"1 2 3\n", "line 1: 1 values separated by commas"},
    {"1;2;3\n", "line 1: 1 values separated by commas"},
    {"1,2,3,4,5,6\n", "line 1: 6 values separated by commas"},
    {"x,y,r,vx,vy,q\n1,2,3,4,5,6\n", "line 1: 6 columns; at most x,y,r,vx,vy"},
    {"x,y,mass\n1,2,3\n", "line 1: unknown column 'mass'; the names are x, y, r"},
    {"x;y;r\n1;2;3\n", "line 1: unknown column 'x;y;r'; names and values are separated by commas"},
    {"x\ty\tr\n1\t2\t3\n", "line 1: unknown column 'x?y?r'; names and values are separated by commas"},
    {"x,y,vx,vy\n1,2,3,4\n", "line 1: there is no column r"},
    {"x,r\n1,2\n", "line 1: there is no column y"},
    {"x,y,r,vx\n1,2,3,4\n", "line 1: of vx and vy there must be both or none"},
    {"x,y,r,x\n1,2,3,4\n", "line 1: columns 1 and 4 have the same name x"},
    {"x [mm],y,r\n1,2,3\n", "line 1: column x is in 'mm', it must be in m"},
    {"x,y,r\nx,y,r\n", "line 2: x = 'x' is not a number"},
    {"1,abc,3\n", "line 1: y = 'abc' is not a number"},
    {"1,2,0x1p3\n", "line 1: r = '0x1p3' is not a number"},
    {"1,2,3e\n", "line 1: r = '3e' is not a number"},
    {"1,2,1d-3\n", "line 1: r = '1d-3' is not a number"},
    {"1,2,1 000\n", "line 1: r = '1 000' is not a number"},
    {"1,,3\n", "line 1: y = '' is empty"},
    {"1,2,nan\n", "line 1: r = 'nan' is not a finite number"},
    {"NaN,2,3\n", "line 1: x = 'NaN' is not a finite number"},
    {"1,-Inf,3\n", "line 1: y = '-Inf' is not a finite number"},
    {"1,2,1e999\n", "line 1: r = '1e999' is not a finite number"},
    {"1,2,0\n", "line 1: r = 0 m is not positive"},
    {"1,2,-0.5\n", "line 1: r = -0.5 m is not positive"},
    {"1,2,1e-400\n", "line 1: r = 0 m is not positive"},
    {"1e-9,0,1e-13\n", "line 1: r = 1e-13 m is not between 1e-12 and 1e6 m"},
    {"1,2,1e7\n", "line 1: r = 1e+07 m is not between"},
    {"1e300,2,1\n", "line 1: x = 1e+300 m is more than 1e+09 radii from the origin"},
    {"1,2,3,4e7,5\n", "line 1: vx = 4e+07 m/s is faster than 1e6 m/s"},
    {"1,2,3\n\n4,5,6\r7,8,9\n", "line 3: a carriage return inside"},
    {"#! discs 3\n1,2,3\n4,5,6\n", "2 discs, but the note '#! discs 3' above the table: the file has been cut"},
    {"#! discs 1\n1,2,3\n4,5,6\n", "2 discs, but the note '#! discs 1'"},
    {"#! discs 1.5\n1,2,3\n", "line 1: '#! discs 1.5' does not say a number of discs once"},
    {"#! discs\n1,2,3\n", "line 1: '#! discs ' does not say"},
    {"#! discs 1\n#! discs 1\n1,2,3\n", "line 2: '#! discs 1' does not say a number of discs once"},
    {"1,2,3\n#! discs 1\n", "line 2: a note (#!) must stand above the table"},
    {"#! periodic_x 3 1\n1,2,3\n", "line 1: the upper end of the period in x does not lie above the lower end"},
    {"#! periodic_x 3\n1,2,3\n", "line 1: an end of the period in x is empty"},
    {"#! periodic_x 3 inf\n1,2,3\n", "line 1: an end of the period in x is not a finite number"},
    {"#! periodic_x 1 2\n#! periodic_x 1 2\n1,2,3\n", "line 2: a second period in x"},
    {"#! radius 3\n1,2,3\n", "line 1: unknown note '#! radius'"},
};

static void what_is_refused(void **state)
{
  static char long_line[PG_PACKING_LINE + 3];

  (void)state;
  for (size_t k = 0; k < sizeof refused / sizeof *refused; k++) {
    ReadText(refused[k].text);
    if (strncmp(reading.csv.reason, refused[k].reason, strlen(refused[k].reason)))
      fail_msg("'%s': expected '%s', got '%s'", refused[k].text, refused[k].reason, reading.csv.reason);
  }
  ReadInPieces("1,2,\0003\n", 7, 3, 1, &reading);
  assert_string_equal(reading.csv.reason, "line 1: a zero byte: this is not a text file");
  (void)memset(long_line, '7', sizeof long_line);
  ReadInPieces(long_line, sizeof long_line, 100, 1, &reading);
  assert_string_equal(reading.csv.reason, "line 1: longer than 4096 bytes: this is not a table of discs");
  ReadText("1,2,0.00000000000000000000000000000000000000000000000000000000000000000001\n");
  assert_non_null(strstr(reading.csv.reason, "...' is too long for a number"));
}

/* A comma for the decimal point: made for this test where localedef is installed. */
static void locale_of_the_program(void **state)
{
  PetscReal shown;

  (void)state;
  (void)mkdir("locales", 0700);
  if (!setlocale(LC_NUMERIC, "de_DE.UTF-8")) {
    if (system("localedef -i de_DE -f UTF-8 ./locales/de_DE.UTF-8 >localedef.out 2>&1")) skip();
    assert_int_equal(setenv("LOCPATH", "./locales", 1), 0);
    if (!setlocale(LC_NUMERIC, "de_DE.UTF-8")) skip();
  }
  assert_string_equal(localeconv()->decimal_point, ",");
  ReadText("0.125,2.5,0.75\n");
  shown = strtod("0,5", NULL);
  (void)setlocale(LC_NUMERIC, "C");
  assert_string_equal(reading.csv.reason, "");
  CheckDisc(0, 0.125, 2.5, 0.75, 0, 0);
  assert_true(shown == 0.5); /* the locale of the program is as it was */
}

/* Every number with enough digits is the nearest double: against the digits of %.17g. */
static void digits_are_exact(void **state)
{
  uint64_t seed = 88172645463325252U;

  (void)state;
  for (int k = 0; k < 2000; k++) {
    char      text[128];
    PetscReal r;

    seed ^= seed << 13;
    seed ^= seed >> 7;
    seed ^= seed << 17;
    r = ldexp(1.0 + (double)(seed >> 12) * 0x1p-52, (int)(seed % 30) - 20);
    (void)snprintf(text, sizeof text, "%.17g,%.17g,%.17g\n", -1.7 * r, 0.3 * r, r);
    ReadText(text);
    assert_string_equal(reading.csv.reason, "");
    CheckDisc(0, -1.7 * r, 0.3 * r, r, 0, 0);
  }
}

/* ---- whatever the text ---- */

static uint64_t Next(uint64_t *seed)
{
  *seed ^= *seed << 13;
  *seed ^= *seed >> 7;
  *seed ^= *seed << 17;
  return *seed;
}

/* A few bytes changed, cut out, doubled or replaced by ones that mean something. */
static size_t Mutate(uint64_t *seed, uint8_t text[], size_t size, size_t room)
{
  static const char telling[] = "\n\r,#! .-+eE09xyrv\"[]\0nai";

  for (uint64_t k = Next(seed) % 6; k > 0 && size > 4; k--) {
    const size_t at = 1 + Next(seed) % (size - 1), length = 1 + Next(seed) % PetscMin(size - at, (size_t)9);
    switch (Next(seed) % 5) {
    case 0:
      text[at] ^= (uint8_t)(1U << Next(seed) % 8);
      break;
    case 1:
      text[at] = (uint8_t)telling[Next(seed) % (sizeof telling - 1)];
      break;
    case 2:
      (void)memmove(text + at, text + at + length, size - at - length);
      size -= length;
      break;
    case 3:
      if (size + length > room) break;
      (void)memmove(text + at + length, text + at, size - at);
      size += length;
      break;
    default:
      size = at + 1;
    }
  }
  return size;
}

static void no_text_upsets_it(void **state)
{
  const char    *here = __FILE__, *tests = strstr(here, "unit/");
  char           folder[PETSC_MAX_PATH_LEN], path[2 * PETSC_MAX_PATH_LEN];
  uint64_t       seed  = 1442695040888963407U;
  PetscInt       tried = 0, taken = 0;
  struct dirent *entry;
  DIR           *corpus;

  (void)state;
  assert_non_null(tests);
  (void)snprintf(folder, sizeof folder, "%.*sfuzz/corpus/packing_csv", (int)(tests - here), here);
  corpus = opendir(folder);
  assert_non_null(corpus);
  while ((entry = readdir(corpus))) {
    uint8_t text[4096], changed[8192];
    FILE   *stream;
    size_t  size;

    if (entry->d_name[0] == '.') continue;
    (void)snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
    stream = fopen(path, "rb");
    assert_non_null(stream);
    size = fread(text, 1, sizeof text, stream);
    (void)fclose(stream);
    for (int k = 0; k < 4000; k++) {
      size_t n;
      (void)memcpy(changed, text, size);
      changed[0] = (uint8_t)Next(&seed);
      n          = k ? Mutate(&seed, changed, size, sizeof changed) : size;
      assert_int_equal(LLVMFuzzerTestOneInput(changed, n), 0); /* aborts when something is wrong */
      ReadInPieces((const char *)changed + 1, n - 1, n, 16, &reading);
      tried++;
      taken += !reading.csv.reason[0];
    }
  }
  (void)closedir(corpus);
  /* of both kinds there were many, or the mutations are too tame or too wild to test anything */
  assert_true(tried >= 20000);
  assert_in_range(taken, tried / 50, tried / 2);
}

int main(int argc, char *argv[])
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_is_taken),    cmocka_unit_test(what_is_refused),   cmocka_unit_test(locale_of_the_program),
      cmocka_unit_test(digits_are_exact), cmocka_unit_test(no_text_upsets_it),
  };
  PetscErrorCode err;
  int            failed;

  err = PgInitialize(&argc, &argv, "unit test of io");
  if (err) return 1;
  err = PetscSetFPTrap(PETSC_FP_TRAP_ON);
  if (err) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(err) || failed;
}
