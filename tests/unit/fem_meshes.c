/* ranks: 1 timeout: 120 */
/* Mesh files of Gmsh: what is wrong with one is said by the file's own numbers, before PETSc takes them on trust; binary
   files are as good as text. Every bad file is a good one with one place changed. */
#include <porograin/fem.h>
#include "gmsh_file.h"
#include "verify.h"
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char said[1024];

/* What is printed as an error meanwhile goes to a file. */
static int Divert(void)
{
  const int kept = dup(STDERR_FILENO), file = open("stderr.txt", O_RDWR | O_CREAT | O_TRUNC, 0600);

  assert_true(kept >= 0 && file >= 0 && fflush(stderr) == 0);
  assert_int_equal(dup2(file, STDERR_FILENO), STDERR_FILENO);
  assert_int_equal(close(file), 0);
  return kept;
}

static void Restore(int kept)
{
  FILE  *f;
  size_t size;

  assert_int_equal(fflush(stderr), 0);
  assert_int_equal(dup2(kept, STDERR_FILENO), STDERR_FILENO);
  assert_int_equal(close(kept), 0);
  f = fopen("stderr.txt", "r");
  assert_non_null(f);
  size       = fread(said, 1, sizeof said - 1, f);
  said[size] = 0;
  assert_int_equal(fclose(f), 0);
}

/* Status of a set-up with this mesh; the message is in `said`. */
static PetscErrorCode SetUp(const char file[], const char region[])
{
  const PetscReal zero = 0.0;
  PgFemMaterial   m;
  PetscErrorCode  err;
  PetscInt        nodes = 0, cells = 0;
  PgFem           fem;
  int             kept;

  CHECK(PgFemCreate(PETSC_COMM_WORLD, &fem));
  CHECK(PgFemSetMeshFile(fem, file));
  PgFemMaterialDefault(&m);
  if (region) CHECK(PgFemSetMaterial(fem, region, &m));
  CHECK(PgFemSetCondition(fem, "bottom", PG_FEM_DISPLACEMENT_X, &zero));
  CHECK(PgFemSetCondition(fem, "bottom", PG_FEM_DISPLACEMENT_Y, &zero));
  kept = Divert();
  err  = PgFemSetUp(fem);
  Restore(kept);
  if (!err) {
    CHECK(PgFemGetSizes(fem, &nodes, &cells));
    assert_int_equal(nodes, 12);
    assert_int_equal(cells, 6);
  }
  CHECK(PgFemDestroy(&fem));
  return err;
}

/* 3 x 2 cells: nodes 1 to 12 by rows, elements 1 to 10 are sides, 11 to 16 cells. */
static const GmshRectangle plain22 = {3, 2, {3.0, 2.0}, 0.0, 22, 0}, plain41 = {3, 2, {3.0, 2.0}, 0.0, 41, 0};

static void Refused(const char file[], const char message[])
{
  const PetscErrorCode err = SetUp(file, NULL);

  if (err != PETSC_ERR_USER_INPUT || !strstr(said, message) || !strstr(said, file))
    fail_msg("%s: status %d and '%s' instead of '%s'", file, (int)err, said, message);
}

/* Writes `good` with the first `from` as `to`. */
static void Change(const char good[], const char from[], const char to[], const char bad[])
{
  char        text[8192];
  const char *at;
  FILE       *f = fopen(good, "rb");
  size_t      size;

  assert_non_null(f);
  size       = fread(text, 1, sizeof text - 1, f);
  text[size] = 0;
  assert_true(fclose(f) == 0 && size < sizeof text - 1);
  at = strstr(text, from);
  if (!at) fail_msg("no '%s' in %s", from, good);
  f = fopen(bad, "wb");
  assert_non_null(f);
  (void)fprintf(f, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
  assert_int_equal(fclose(f), 0);
}

typedef struct {
  const char *from, *to, *message;
} Fault;

static void Faults(PetscInt count, const Fault fault[], const char good[])
{
  for (PetscInt k = 0; k < count; k++) {
    Change(good, fault[k].from, fault[k].to, "bad.msh");
    Refused("bad.msh", fault[k].message);
  }
}

static void Text22(void **state)
{
  static const Fault fault[] = {
      {"\n7 2 1 0\n", "\n7 2 1\n", "line 21: not a node"},
      {"\n7 2 1 0\n", "\n7 two 1 0\n", "line 21: not a node"},
      {"\n7 2 1 0\n", "\n7 nan 1 0\n", "line 21: the place of node 7 is not finite"},
      {"\n7 2 1 0\n", "\n7 2 1 0.1\n", "node 7 lies at z = 0.1, out of the plane z = 0"},
      {"\n7 2 1 0\n", "\n8 2 1 0\n", "node 8 stands twice"},
      {"\n7 2 1 0\n", "\n7 3 2 0\n", "is not a convex quadrilateral"},
      {"\n7 2 1 0\n", "\n7 0.2 0.2 0\n", "element 12, the cell at (1.05, 0.3), is not a convex quadrilateral"},
      {"$Nodes\n12\n", "$Nodes\n99999999\n", "line 14: no such number of nodes can be in the file"},
      {"$Nodes\n12\n", "$Nodes\n11\n", "element 5: there is no node 12"},
      {"\n2.2 0 8\n", "\n1.0 0 8\n", "MSH version 1 is not one of 2.2, 4.0, 4.1"},
      {"\n2.2 0 8\n", "\n2.2 0 4\n", "its numbers have 4 bytes, not 8"},
      {"\"left\"", "left", "physical name 4 of 6"},
      {"2 1 \"lower", "2+1 \"lower", "physical name 5 of 6"},
      {"1 3 \"top\"", "1 3 \"left\"", "groups 3 and 4 of curves are both named 'left'"},
      {"2 2 \"upper part\"", "2 2 \"lower part\"", "groups 1 and 2 of surfaces are both named 'lower part'"},
      {"1 1 \"bottom\"", "1 1 \"base\"", "has no boundary 'bottom'; its boundaries: base, right, top, left"},
      {" 7 8 12 11\n", " 7 8 12 99\n", "there is no node 99"},
      {" 7 8 12 11\n", " 7 8 12 7\n", "element 16 has node 7 twice"},
      {" 7 8 12 11\n", " 7 8 12\n", "line 45: not an element of its type"},
      {"16 3 2 2 2 7 8 12 11\n", "16 2 2 2 2 7 8 12\n", "element 16 is a triangle, not a quadrilateral"},
      {"16 3 2 2 2 7 8 12 11\n", "16 5 2 2 2 7 8 12 11\n", "line 45: an element that is no point, line, triangle or"},
      {" 7 8 12 11\n", " 6 7 11 10\n", "elements 15 and 16 lie on each other at the side between nodes 6 and 7"},
      {" 6 7 11 10\n", " 7 8 12 11\n", "elements 15 and 16 lie on each other"},
      {" 3 4 8 7\n", " 3 12 8 7\n", "is not a convex quadrilateral"},
      {"\n10 1 2 4 4 5 9\n", "\n10 1 2 4 4 1 9\n", "element 10, the line between nodes 1 and 9, is no side of a cell"},
      {"$Elements\n16\n", "$Elements\n17\n", "not an element of its type"}};

  (void)state;
  GmshWrite(&plain22, "good22.msh");
  CHECK(SetUp("good22.msh", "upper part"));
  assert_int_equal(SetUp("good22.msh", "lowest part"), PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(said, "has no region 'lowest part'; its regions: lower part, upper part"));
  Faults((PetscInt)(sizeof fault / sizeof *fault), fault, "good22.msh");
  Change("good22.msh", "$Elements\n16\n", "$Elements\n14\n", "fewer.msh");
  /* a cell that only a corner joins to the rest, its line with it */
  Change("good22.msh", "\n12 3 2 1 1 2 3 7 6\n", "\n12 15 2 1 1 2\n", "half.msh");
  Change("half.msh", "\n14 3 2 2 2 5 6 10 9\n", "\n14 15 2 1 1 2\n", "corner.msh");
  Change("corner.msh", "\n13 3 2 1 1 3 4 8 7\n", "\n13 15 2 1 1 2\n", "corners.msh");
  Refused("corners.msh", "it is in pieces: no chain of cells with common sides leads from element 11 to element 15");
}

static void Text41(void **state)
{
  static const Fault fault[] = {
      {"\n2 1 3 3\n", "\n2 9 3 3\n", "a block is on entity 9, which $Entities does not have"},
      {"\n2 1 0 12\n", "\n2 7 0 12\n", "a block is on entity 7, which $Entities does not have"},
      {"\n6 16 1 16\n", "\n5 16 1 16\n", "fewer elements than were said"},
      {"\n2 1 0 12\n", "\n2 1 1 12\n", "parametric nodes are not known here"},
      {"\n2 1 0 12\n", "\n2 1 0 11\n", "not a place of a node"},
      {"\n2 1 3 3\n", "\n2 1 3 -3\n", "more elements than were said"},
      {"\n0 4 2 0\n", "\n0 4 -2 0\n", "no such number of entities can be in the file"}};

  (void)state;
  GmshWrite(&plain41, "good41.msh");
  CHECK(SetUp("good41.msh", "upper part"));
  Faults((PetscInt)(sizeof fault / sizeof *fault), fault, "good41.msh");
}

/* ---- binary ---- */

static void Int(FILE *f, int32_t value) { assert_int_equal(fwrite(&value, 4, 1, f), 1); }
static void Long(FILE *f, int64_t value) { assert_int_equal(fwrite(&value, 8, 1, f), 1); }
static void Double(FILE *f, double value) { assert_int_equal(fwrite(&value, 8, 1, f), 1); }

/* Of node k of 12. */
static void Place(FILE *f, int k)
{
  const int row = k / 4;

  Double(f, k % 4);
  Double(f, row);
  Double(f, 0.0);
}

static FILE *Begin(const char file[], const char version[], int32_t one)
{
  FILE *f = fopen(file, "wb");

  assert_non_null(f);
  (void)fprintf(f, "$MeshFormat\n%s 1 8\n", version);
  Int(f, one);
  (void)fprintf(f, "\n$EndMeshFormat\n%s", GmshNames);
  return f;
}

/* `last`: number of the last corner of the last cell, 11 in truth. */
static void Binary22(const char file[], int32_t last)
{
  FILE *f      = Begin(file, "2.2", 1);
  int   number = 1, corner[4];

  (void)fprintf(f, "$Nodes\n12\n");
  for (int k = 0; k < 12; k++) {
    Int(f, k + 1);
    Place(f, k);
  }
  (void)fprintf(f, "\n$EndNodes\n$Elements\n16\n");
  for (int side = 0; side < 4; side++) {
    const int n = side % 2 ? 2 : 3;
    Int(f, 1);
    Int(f, n);
    Int(f, 2);
    for (int k = 0; k < n; k++) {
      GmshEdge(&plain22, side, k, corner);
      Int(f, number++);
      Int(f, side + 1);
      Int(f, side + 1);
      for (int c = 0; c < 2; c++) Int(f, corner[c]);
    }
  }
  Int(f, 3);
  Int(f, 6);
  Int(f, 2);
  for (int k = 0; k < 6; k++) {
    GmshCorners(&plain22, k % 3, k / 3, corner);
    if (k == 5) corner[3] = last;
    Int(f, number++);
    for (int t = 0; t < 2; t++) Int(f, 1 + k / 3);
    for (int c = 0; c < 4; c++) Int(f, corner[c]);
  }
  (void)fprintf(f, "\n$EndElements\n");
  assert_int_equal(fclose(f), 0);
}

static void Entity(FILE *f, int32_t tag, PetscBool boundary)
{
  Int(f, tag);
  for (int k = 0; k < 6; k++) Double(f, k < 3 ? 0.0 : 1.0);
  Long(f, 1);
  Int(f, tag);
  Long(f, boundary ? 4 : 0);
  for (int k = 0; boundary && k < 4; k++) Int(f, k + 1);
}

/* MSH 4.0 and 4.1 differ in the width of numbers and in the order of some. */
static void Binary4(const char file[], PetscBool old, int64_t last)
{
  FILE *f      = Begin(file, old ? "4" : "4.1", 1);
  int   number = 1, corner[4];

  (void)fprintf(f, "$Entities\n");
  for (int d = 0; d < 4; d++) Long(f, d == 1 ? 4 : d == 2 ? 2 : 0);
  for (int k = 0; k < 6; k++) Entity(f, k < 4 ? k + 1 : k - 3, (PetscBool)(k >= 4));
  (void)fprintf(f, "\n$EndEntities\n$Nodes\n");
  Long(f, 1);
  Long(f, 12);
  for (int k = 0; !old && k < 2; k++) Long(f, k ? 12 : 1);
  Int(f, old ? 1 : 2);
  Int(f, old ? 2 : 1);
  Int(f, 0);
  Long(f, 12);
  for (int k = 0; !old && k < 12; k++) Long(f, k + 1);
  for (int k = 0; k < 12; k++) {
    if (old) Int(f, k + 1);
    Place(f, k);
  }
  (void)fprintf(f, "\n$EndNodes\n$Elements\n");
  Long(f, 6);
  Long(f, 16);
  for (int k = 0; !old && k < 2; k++) Long(f, k ? 16 : 1);
  for (int block = 0; block < 6; block++) {
    const int dimension = block < 4 ? 1 : 2, tag = block < 4 ? block + 1 : block - 3,
              n = block % 2 && block < 4 ? 2 : 3;
    Int(f, old ? tag : dimension);
    Int(f, old ? dimension : tag);
    Int(f, dimension == 1 ? 1 : 3);
    Long(f, n);
    for (int k = 0; k < n; k++) {
      if (block < 4)
        GmshEdge(&plain22, block, k, corner);
      else
        GmshCorners(&plain22, k, block - 4, corner);
      if (block == 5 && k == 2) corner[3] = (int)last;
      for (int c = -1; c < 2 * dimension; c++)
        (old ? Int(f, c < 0 ? number : corner[c]) : Long(f, c < 0 ? number : corner[c]));
      number++;
    }
  }
  (void)fprintf(f, "\n$EndElements\n");
  assert_int_equal(fclose(f), 0);
}

static void Cut(const char file[], long size, const char to[])
{
  char  bytes[8192];
  FILE *f = fopen(file, "rb");

  assert_non_null(f);
  assert_int_equal(fread(bytes, 1, (size_t)size, f), size);
  (void)fclose(f);
  f = fopen(to, "wb");
  assert_non_null(f);
  assert_int_equal(fwrite(bytes, 1, (size_t)size, f), size);
  assert_int_equal(fclose(f), 0);
}

static void Binary(void **state)
{
  (void)state;
  Binary22("binary.msh", 11);
  CHECK(SetUp("binary.msh", "upper part"));
  Binary22("binary.msh", 77777);
  Refused("binary.msh", "element 16: there is no node 77777");
  for (int old = 0; old < 2; old++) {
    Binary4("binary.msh", (PetscBool)old, 11);
    CHECK(SetUp("binary.msh", "upper part"));
    Cut("binary.msh", 1400, "cut.msh");
    Refused("cut.msh", "end too early");
    Cut("binary.msh", 300, "cut.msh");
    Refused("cut.msh", "$Entities ends too early");
    Binary4("binary.msh", (PetscBool)old, 77777);
    Refused("binary.msh", "element 16: there is no node 77777");
    Binary4("binary.msh", (PetscBool)old, 7);
    Refused("binary.msh", "element 16 has node 7 twice");
  }
  assert_int_equal(fclose(Begin("binary.msh", "4.1", 1 << 24)), 0);
  Refused("binary.msh", "its bytes are in the order of another kind of machine");
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(Text22), cmocka_unit_test(Text41), cmocka_unit_test(Binary)};

int main(int argc, char *argv[])
{
  int failed;

  if (PgInitialize(&argc, &argv, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
