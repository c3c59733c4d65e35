/* ranks: 1 2 4 timeout: 120 */
/* Packing files: what is written comes back to the bit, damage is noticed, what is no packing is refused by all ranks
   with one message, and a failed write leaves what was there. */
#include "io_testing.h"
#include <sys/resource.h>
#include <signal.h>

static uint64_t Next(uint64_t *seed)
{
  *seed ^= *seed << 13;
  *seed ^= *seed >> 7;
  *seed ^= *seed << 17;
  return *seed;
}

/* Value k of disc id: 53 random bits, many sizes; the radius is the third. */
static PetscReal PackedValue(PetscInt id, int k)
{
  uint64_t        seed = 0x9e3779b97f4a7c15U * (uint64_t)(5 * id + k + 1);
  const uint64_t  bits = (Next(&seed), Next(&seed) >> 11);
  const PetscReal x    = ldexp((double)bits, -53 - (int)(Next(&seed) % 20));

  return k == PG_PACKING_R ? 1e-5 + x : (Next(&seed) & 1 ? -x : x);
}

static void FillPacking(PetscInt global, PgPacking *packing)
{
  ok(PgPackingCreate(PETSC_COMM_WORLD, global, packing));
  for (PetscInt i = 0; i < packing->count; i++) {
    const PetscInt id = packing->start + i;
    for (int c = 0; c < 2; c++) {
      packing->position[2 * i + c] = PackedValue(id, PG_PACKING_X + c);
      packing->velocity[2 * i + c] = PackedValue(id, PG_PACKING_VX + c);
    }
    packing->radius[i] = PackedValue(id, PG_PACKING_R);
  }
}

static PetscBool SamePackings(const PgPacking *a, const PgPacking *b)
{
  const size_t n = (size_t)a->count * sizeof(PetscReal);

  if (a->global != b->global || a->start != b->start || a->count != b->count || a->periodic != b->periodic ||
      a->low != b->low || a->high != b->high)
    return PETSC_FALSE;
  if (!n) return PETSC_TRUE;
  return (PetscBool)(!memcmp(a->position, b->position, 2 * n) && !memcmp(a->velocity, b->velocity, 2 * n) &&
                     !memcmp(a->radius, b->radius, n));
}

static PetscBool OnAllRanks(PetscBool here)
{
  PetscMPIInt all = here;

  ok(MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD));
  return (PetscBool)all;
}

static void RemoveFile(const char file[])
{
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  if (!test_rank) (void)unlink(file);
}

static void what_is_written_comes_back(void **state)
{
  /* fewer discs than ranks; one more than a piece; several pieces for each rank */
  static const PetscInt number[] = {1, 3, 8193, 40001};
  static const char    *ending[] = {".csv", ".h5"};

  (void)state;
  for (size_t k = 0; k < sizeof number / sizeof *number; k++) {
    for (int e = 0; e < 2; e++) {
      const char *file = FileName("packing", ending[e]);
      PgPacking   written, read;

      FillPacking(number[k], &written);
      written.periodic = (PetscBool)(k % 2);
      written.low      = k % 2 ? -0.1 / 3 : 0;
      written.high     = k % 2 ? 2.0 / 3 : 0;
      ok(PgPackingWrite(PETSC_COMM_WORLD, file, &written));
      ok(PgPackingRead(PETSC_COMM_WORLD, file, "", &read));
      assert_true(read.has_velocity);
      assert_true(SamePackings(&written, &read));
      ok(PgPackingDestroy(&read));
      ok(PgPackingDestroy(&written));
      RemoveFile(file);
      if (!test_rank) assert_int_equal(access(FileName("packing", e ? ".h5.part" : ".csv.part"), F_OK), -1);
    }
  }
}

/* The last snapshot by itself, an earlier one by name. */
static void discs_of_a_result_file(void **state)
{
  const PgColumn column = {"time", "s", "time"};
  const char    *file   = FileName("result", ".h5");
  PetscReal     *x;
  PgParticles    particles = MakeDiscs(11, 0, NULL);
  PgPacking      first, last, read;
  PgOutput       output;
  PetscInt       owned;
  char          *whole;

  (void)state;
  RemoveResult("result");
  ok(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  ok(PgParticlesGetArray(particles, PG_RADIUS, &x));
  for (PetscInt i = 0; i < owned; i++) x[i] = 0.01 + 0.1 * PetscAbsReal(x[i]);
  ok(PgOutputCreate(particles, file, 1, &column, &output));
  ok(PgOutputSnapshot(output, 0.25, 0, NULL));
  ok(PgPackingFromParticles(particles, &first));
  ok(PgParticlesGetArray(particles, PG_POSITION, &x));
  for (PetscInt i = 0; i < 2 * owned; i++) x[i] += 0.37;
  ok(PgOutputSnapshot(output, 0.5, 0, NULL));
  ok(PgPackingFromParticles(particles, &last));
  ok(PgOutputFinish(output));
  ok(PgOutputDestroy(&output));
  assert_false(OnAllRanks(SamePackings(&first, &last)));
  ok(PgPackingRead(PETSC_COMM_WORLD, file, "", &read));
  assert_true(SamePackings(&last, &read));
  ok(PgPackingDestroy(&read));
  ok(PgPackingRead(PETSC_COMM_WORLD, file, "snapshots/000000/", &read));
  assert_true(SamePackings(&first, &read));
  ok(PgPackingDestroy(&read));
  ok(PgPackingDestroy(&first));
  ok(PgPackingDestroy(&last));
  ok(PgParticlesDestroy(&particles));
  whole = ReadWholeFile(FileName("result", ".csv"));
  assert_non_null(strstr(whole, "time"));
  free(whole);
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  RemoveResult("result");
}

/* ---- HDF5 files that are no packings ---- */

static hid_t made; /* rank 0 */

static void Start(H5F_libver_t format)
{
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);

  (void)H5Pset_libver_bounds(access, format, H5F_LIBVER_LATEST);
  made = H5Fcreate(FileName("bad", ".h5"), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  assert_true(made >= 0);
  (void)H5Pclose(access);
}

static void Put(const char path[], hid_t type, int rank, hsize_t rows, hsize_t columns, const void *data)
{
  const hsize_t size[3] = {rows, columns, 1};
  const hid_t   space = H5Screate_simple(rank, size, NULL), link = H5Pcreate(H5P_LINK_CREATE);
  hid_t         set;

  (void)H5Pset_create_intermediate_group(link, 1);
  set = H5Dcreate2(made, path, type, space, link, H5P_DEFAULT, H5P_DEFAULT);
  assert_true(set >= 0);
  if (data) assert_true(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
  (void)H5Dclose(set);
  (void)H5Pclose(link);
  (void)H5Sclose(space);
}

static const double good_x[] = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6}, good_r[] = {0.01, 0.02, 0.015};
static const double nan_x[] = {0.1, 0.2, 0.3, NAN, 0.5, 0.6}, zero_r[] = {0.01, 0.02, 0}, inf_r[] = {INFINITY, 1, 1};
static const double far_x[] = {0.1, 0.2, 1e30, 0.4, 0.5, 0.6}, fast[] = {0, 0, 0, 0, -1e9, 0};

static void PutGood(void)
{
  Put("/position", H5T_NATIVE_DOUBLE, 2, 3, 2, good_x);
  Put("/radius", H5T_NATIVE_DOUBLE, 1, 3, 0, good_r);
}

static void PutWords(void)
{
  static const char words[3][8] = {"0.01", "0.02", "0.03"};
  const hid_t       text        = H5Tcopy(H5T_C_S1);

  (void)H5Tset_size(text, 8);
  Put("/position", H5T_NATIVE_DOUBLE, 2, 3, 2, good_x);
  Put("/radius", text, 1, 3, 0, words);
  (void)H5Tclose(text);
}

/* A number whose bytes cannot be right. */
static void PutWide(void)
{
  const hid_t wide = H5Tcopy(H5T_NATIVE_INT);

  (void)H5Tset_size(wide, 4000);
  Put("/position", wide, 2, 3, 2, NULL);
  (void)H5Tclose(wide);
}

static void PutChunks(hsize_t chunk)
{
  const hsize_t size[2] = {3, 2}, unlimited[2] = {H5S_UNLIMITED, 2}, piece[2] = {chunk, 2};
  const hid_t   space = H5Screate_simple(2, size, unlimited), create = H5Pcreate(H5P_DATASET_CREATE);
  hid_t         set;

  (void)H5Pset_chunk(create, 2, piece);
  set = H5Dcreate2(made, "/position", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, create, H5P_DEFAULT);
  assert_true(set >= 0);
  (void)H5Dclose(set);
  (void)H5Pclose(create);
  (void)H5Sclose(space);
}

static void PutElsewhere(void)
{
  const hsize_t size[2] = {3, 2};
  const hid_t   space = H5Screate_simple(2, size, NULL), create = H5Pcreate(H5P_DATASET_CREATE);
  hid_t         set;

  (void)H5Pset_external(create, "/etc/passwd", 0, 48);
  set = H5Dcreate2(made, "/position", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, create, H5P_DEFAULT);
  assert_true(set >= 0);
  (void)H5Dclose(set);
  (void)H5Pclose(create);
  (void)H5Sclose(space);
}

static void PutPeriod(hid_t type, hsize_t values, double low, double high)
{
  const double value[3] = {low, high, 0};
  const hid_t  space    = H5Screate_simple(1, &values, NULL);
  const hid_t  period   = H5Acreate2(made, "periodic_x", type, space, H5P_DEFAULT, H5P_DEFAULT);

  assert_true(period >= 0);
  (void)H5Awrite(period, H5T_NATIVE_DOUBLE, value);
  (void)H5Aclose(period);
  (void)H5Sclose(space);
  PutGood();
}

/* Makes bad file `k`; returns what is to be found in the message, NULL after the last. */
static const char *MakeBad(int k, const char **group, PetscErrorCode *code)
{
  const PetscBool here = (PetscBool)!test_rank;
  const char     *what = NULL;

  *group = "";
  *code  = PETSC_ERR_USER_INPUT;
  if (here) Start(H5F_LIBVER_EARLIEST);
#define CASE(number, action, message)                                                                                  \
  case number:                                                                                                         \
    if (here) action;                                                                                                  \
    what = message;                                                                                                    \
    break
  switch (k) {
    CASE(0, (void)0, "there is no dataset '/position'");
    CASE(1, Put("/position", H5T_NATIVE_DOUBLE, 2, 3, 2, good_x), "there is no dataset '/radius'");
    CASE(2, Put("/position", H5T_NATIVE_DOUBLE, 2, 2, 3, good_x), "dataset '/position': its shape is not (N,2)");
    CASE(3, Put("/position", H5T_NATIVE_DOUBLE, 1, 6, 0, good_x), "dataset '/position': its shape is not (N,2)");
    CASE(4, Put("/position", H5T_NATIVE_DOUBLE, 3, 3, 2, good_x), "dataset '/position': its shape is not (N,2)");
    CASE(5, Put("/position", H5T_NATIVE_DOUBLE, 2, 0, 2, NULL), "dataset '/position': it holds no disc");
    CASE(6, (Put("/position", H5T_NATIVE_DOUBLE, 2, 3, 2, good_x), Put("/radius", H5T_NATIVE_DOUBLE, 1, 2, 0, good_r)),
         "dataset '/radius': 2 rows, but '/position' has 3");
    CASE(7, (Put("/position", H5T_NATIVE_DOUBLE, 2, 3, 2, good_x), Put("/radius", H5T_NATIVE_DOUBLE, 2, 3, 1, good_r)),
         "dataset '/radius': its shape is not (N)");
    CASE(8, PutWords(), "dataset '/radius': it does not hold numbers");
    CASE(9, PutWide(), "dataset '/position': its numbers have an unknown size");
    CASE(10, (Put("/position", H5T_NATIVE_DOUBLE, 2, 3, 2, nan_x), Put("/radius", H5T_NATIVE_DOUBLE, 1, 3, 0, good_r)),
         "dataset '/position', row 1: y is not a finite number");
    CASE(11, (Put("/position", H5T_NATIVE_DOUBLE, 2, 3, 2, good_x), Put("/radius", H5T_NATIVE_DOUBLE, 1, 3, 0, zero_r)),
         "dataset '/radius', row 2: r = 0 m is not positive");
    CASE(12, (Put("/position", H5T_NATIVE_DOUBLE, 2, 3, 2, good_x), Put("/radius", H5T_NATIVE_DOUBLE, 1, 3, 0, inf_r)),
         "dataset '/radius', row 0: r is not a finite number");
    CASE(13, (Put("/position", H5T_NATIVE_DOUBLE, 2, 3, 2, far_x), Put("/radius", H5T_NATIVE_DOUBLE, 1, 3, 0, good_r)),
         "dataset '/position', row 1: x = 1e+30 m is more than 1e+09 radii");
    CASE(14, (PutGood(), Put("/velocity", H5T_NATIVE_DOUBLE, 2, 3, 2, fast)),
         "dataset '/velocity', row 2: vx = -1e+09 m/s is faster");
    CASE(15, (PutGood(), Put("/velocity", H5T_NATIVE_DOUBLE, 1, 3, 0, good_r)),
         "dataset '/velocity': its shape is not (N,2)");
    /* claims 1e13 rows, and holds nothing */
    CASE(16, Put("/position", H5T_NATIVE_DOUBLE, 2, 10000000000000, 2, NULL),
         "more discs than the integers of this PETSc");
    CASE(17,
         (Put("/position", H5T_NATIVE_DOUBLE, 2, 1000000, 2, NULL),
          Put("/radius", H5T_NATIVE_DOUBLE, 1, 1000000, 0, NULL)),
         "dataset '/radius', row 0: r = 0 m is not positive");
    CASE(18, PutChunks(1U << 26), "dataset '/position': its chunks are too large");
    CASE(19, PutElsewhere(), "dataset '/position': it keeps its values in another file");
    CASE(20, PutPeriod(H5T_NATIVE_DOUBLE, 2, 3, 1), "attribute 'periodic_x': the upper end of the period");
    CASE(21, PutPeriod(H5T_NATIVE_DOUBLE, 3, 3, 1), "attribute 'periodic_x' is not two numbers");
    CASE(22, PutPeriod(H5T_NATIVE_DOUBLE, 2, 0, NAN), "attribute 'periodic_x': the ends of the period");
    CASE(23, PutGood(), "there is no group '/snapshots/000001' (option -packing_group)");
    CASE(24, Put("/snapshots/.incomplete/position", H5T_NATIVE_DOUBLE, 2, 3, 2, good_x),
         "it is a result file without a complete snapshot");
    CASE(25, Put("/position/deeper", H5T_NATIVE_DOUBLE, 2, 3, 2, good_x), "open dataset '/position'");
  default:
    break;
  }
#undef CASE
  if (k == 23) *group = "/snapshots/000001";
  if (k == 25) *code = PETSC_ERR_FILE_READ;
  if (here) assert_true(H5Fclose(made) >= 0);
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  return what;
}

static void CheckRefused(const char file[], const char group[], PetscErrorCode code, const char part[])
{
  char      text[4096], start[256];
  PgPacking packing;

  CatchErrors();
  {
    const PetscErrorCode err = PgPackingRead(PETSC_COMM_WORLD, file, group, &packing);
    CaughtErrors(text);
    assert_int_equal(err, code);
  }
  (void)snprintf(start, sizeof start, "porograin: error: packing '%s': ", file);
  CheckMessage(text, start, part);
  assert_null(packing.position);
}

static void hdf5_files_that_are_refused(void **state)
{
  const char    *file = FileName("bad", ".h5"), *group, *part;
  PetscErrorCode code;
  PgPacking      packing;
  int            k;

  (void)state;
  for (k = 0; (part = MakeBad(k, &group, &code)); k++) CheckRefused(file, group, code, part);
  assert_int_equal(k, 26);
  /* the same makers do make good files */
  if (!test_rank) {
    Start(H5F_LIBVER_EARLIEST);
    PutGood();
    (void)H5Fclose(made);
  }
  ok(PgPackingRead(PETSC_COMM_WORLD, file, "/", &packing));
  assert_int_equal(packing.global, 3);
  assert_false(packing.has_velocity);
  if (!test_rank && packing.count) assert_true(packing.position[1] == 0.2 && packing.radius[0] == 0.01);
  ok(PgPackingDestroy(&packing));
  RemoveFile(file);
}

static void files_that_cannot_be_opened(void **state)
{
  const char *csv = FileName("empty", ".csv"), *h5 = FileName("text", ".h5"), *dir = FileName("folder", ".csv");
  const char *pipe = FileName("pipe", ".csv");

  (void)state;
  if (!test_rank) {
    FILE *stream = fopen(csv, "w");
    (void)fclose(stream);
    stream = fopen(h5, "w");
    (void)fputs("x,y,r\n1,2,3\n", stream);
    (void)fclose(stream);
    (void)mkdir(dir, 0700);
    (void)mkfifo(pipe, 0600);
  }
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  CheckRefused(FileName("missing", ".csv"), "", PETSC_ERR_FILE_OPEN, "cannot be opened: No such file");
  CheckRefused(dir, "", PETSC_ERR_FILE_OPEN, "cannot be opened: Is a directory");
  CheckRefused(pipe, "", PETSC_ERR_FILE_OPEN, "cannot be opened: it is not a regular file");
  CheckRefused(csv, "", PETSC_ERR_USER_INPUT, "it is empty");
  CheckRefused(h5, "", PETSC_ERR_FILE_UNEXPECTED, "it does not begin like an HDF5 file");
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  if (!test_rank) (void)rename(h5, csv);
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  CheckRefused(csv, "/snapshots/000000", PETSC_ERR_USER_INPUT, "belongs to HDF5 files");
  RemoveFile(csv);
  RemoveFile(pipe);
  if (!test_rank) (void)rmdir(dir);
}

/* ---- damage ---- */

/* The bytes as a file, for all ranks. */
static void WriteBytes(const char file[], const char bytes[], size_t size)
{
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  if (!test_rank) {
    FILE *stream = fopen(file, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(bytes, 1, size, stream), size);
    (void)fclose(stream);
  }
  (void)MPI_Barrier(PETSC_COMM_WORLD);
}

/* Reads a damaged file; true: all ranks refused it, false: all have discs, which are in *packing. */
static PetscBool Refused(const char file[], PgPacking *packing)
{
  char           text[4096];
  PetscErrorCode err;

  CatchErrors();
  err = PgPackingRead(PETSC_COMM_WORLD, file, "", packing);
  CaughtErrors(text);
  assert_int_equal(OnAllRanks((PetscBool)(err != 0)), err != 0);
  if (err) CheckMessage(text, "porograin: error: packing '", file);
  return (PetscBool)(err != 0);
}

static size_t SizeOf(const char file[])
{
  struct stat found;

  assert_int_equal(stat(file, &found), 0);
  return (size_t)found.st_size;
}

/* One bit of an exported HDF5 file: what is read is the packing itself or nothing. */
static void no_flipped_bit_goes_unnoticed(void **state)
{
  const char *file  = FileName("flipped", ".h5");
  const int   tries = test_size == 1 ? 1500 : 100;
  PgPacking   packing, read;
  uint64_t    seed    = 2862933555777941757U;
  PetscInt    noticed = 0;
  char       *bytes;
  size_t      size;

  (void)state;
  FillPacking(40, &packing);
  ok(PgPackingWrite(PETSC_COMM_WORLD, file, &packing));
  size  = SizeOf(file);
  bytes = ReadWholeFile(file);
  for (int k = 0; k < tries; k++) {
    const size_t at  = Next(&seed) % size;
    const char   bit = (char)(1U << Next(&seed) % 8);

    bytes[at] ^= bit;
    WriteBytes(file, bytes, size);
    bytes[at] ^= bit;
    if (Refused(file, &read)) {
      noticed++;
      continue;
    }
    if (!OnAllRanks(SamePackings(&packing, &read))) fail_msg("bit %d of byte %zu changes the discs", bit, at);
    ok(PgPackingDestroy(&read));
  }
  /* most of the file is values and tables, less is room to spare */
  assert_true(noticed > tries / 3);
  for (size_t cut = 0; cut < size; cut += 1 + size / (test_size == 1 ? 300 : 20)) {
    WriteBytes(file, bytes, cut);
    assert_true(Refused(file, &read));
  }
  free(bytes);
  ok(PgPackingDestroy(&packing));
  RemoveFile(file);
}

/* CSV has no checksum: cut anywhere it is refused all the same. */
static void no_cut_goes_unnoticed(void **state)
{
  const char *file = FileName("cut", ".csv");
  PgPacking   packing, read;
  char       *bytes;
  size_t      size;

  (void)state;
  FillPacking(5, &packing);
  ok(PgPackingWrite(PETSC_COMM_WORLD, file, &packing));
  size  = SizeOf(file);
  bytes = ReadWholeFile(file);
  for (size_t cut = 0; cut < size; cut += test_size == 1 ? 1 : 17) {
    WriteBytes(file, bytes, cut);
    assert_true(Refused(file, &read));
  }
  WriteBytes(file, bytes, size);
  assert_false(Refused(file, &read));
  assert_true(SamePackings(&packing, &read));
  ok(PgPackingDestroy(&read));
  ok(PgPackingDestroy(&packing));
  free(bytes);
  RemoveFile(file);
}

/* Files of others in the old format, which has no checksums: discs or a refusal, no crash. */
static void no_damage_crashes(void **state)
{
  const char *file  = FileName("bad", ".h5");
  const int   tries = test_size == 1 ? 1500 : 60;
  PgPacking   read;
  uint64_t    seed    = 3935559000370003845U;
  PetscInt    refused = 0;
  char       *bytes, *changed;
  size_t      size;

  (void)state;
  if (!test_rank) {
    Start(H5F_LIBVER_EARLIEST);
    PutGood();
    (void)H5Fclose(made);
  }
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  size    = SizeOf(file);
  bytes   = ReadWholeFile(file);
  changed = malloc(size);
  assert_non_null(changed);
  for (int k = 0; k < tries; k++) {
    (void)memcpy(changed, bytes, size);
    for (uint64_t n = 1 + Next(&seed) % 3; n > 0; n--) changed[Next(&seed) % size] = (char)Next(&seed);
    WriteBytes(file, changed, size);
    if (Refused(file, &read)) {
      refused++;
      continue;
    }
    assert_true(read.global > 0);
    for (PetscInt i = 0; i < read.count; i++)
      assert_true(read.radius[i] > 0 && isfinite(read.position[2 * i]) && isfinite(read.position[2 * i + 1]));
    ok(PgPackingDestroy(&read));
  }
  assert_in_range(refused, tries / 20, tries - tries / 20);
  free(changed);
  free(bytes);
  RemoveFile(file);
}

/* ---- places ---- */

static void places_that_are_refused(void **state)
{
  const char *folder = FileName("folder", ".csv");
  char        text[4096];
  PgPacking   packing;

  (void)state;
  if (!test_rank) (void)mkdir(folder, 0700);
  FillPacking(7, &packing);
  CatchErrors();
  assert_int_equal(PgPackingWrite(PETSC_COMM_WORLD, "discs.txt", &packing), PETSC_ERR_USER_INPUT);
  CaughtErrors(text);
  CheckMessage(text, "porograin: error: packing 'discs.txt': ", "must end in .csv or .h5");
  CatchErrors();
  assert_int_equal(PgPackingWrite(PETSC_COMM_WORLD, "nowhere/discs.csv", &packing), PETSC_ERR_FILE_OPEN);
  CaughtErrors(text);
  CheckMessage(text, "porograin: error: cannot write packing 'nowhere/discs.csv'", "No such file or directory");
  CatchErrors();
  assert_int_equal(PgPackingWrite(PETSC_COMM_WORLD, folder, &packing), PETSC_ERR_FILE_OPEN);
  CaughtErrors(text);
  CheckMessage(text, "porograin: error: cannot write packing '", "Is a directory");
  ok(PgPackingDestroy(&packing));
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  if (!test_rank) (void)rmdir(folder);
}

/* A limit on the size of files stands for a full disk: the old file stays, and no part of a new one. */
static void failed_write_leaves_the_old_file(void **state)
{
  static const char *ending[] = {".csv", ".h5"}, *part[] = {".csv.part", ".h5.part"};
  struct rlimit      before, small;
  char               text[4096];

  (void)state;
  (void)signal(SIGXFSZ, SIG_IGN);
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
  small          = before;
  small.rlim_cur = 100000;
  for (int e = 0; e < 2; e++) {
    const char    *file = FileName("packing", ending[e]);
    PgPacking      old, large, read;
    PetscErrorCode err;

    FillPacking(10, &old);
    FillPacking(20000, &large);
    ok(PgPackingWrite(PETSC_COMM_WORLD, file, &old));
    CatchErrors();
    if (!test_rank) assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    err = PgPackingWrite(PETSC_COMM_WORLD, file, &large);
    if (!test_rank) assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    CaughtErrors(text);
    assert_int_equal(err, PETSC_ERR_FILE_WRITE);
    CheckMessage(text, "porograin: error: cannot write packing '", "File too large");
    if (!test_rank) assert_int_equal(access(FileName("packing", part[e]), F_OK), -1);
    ok(PgPackingRead(PETSC_COMM_WORLD, file, "", &read));
    assert_true(SamePackings(&old, &read));
    ok(PgPackingDestroy(&read));
    ok(PgPackingDestroy(&old));
    ok(PgPackingDestroy(&large));
    RemoveFile(file);
  }
}

int main(int argc, char *argv[])
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_is_written_comes_back),
      cmocka_unit_test(discs_of_a_result_file),
      cmocka_unit_test(hdf5_files_that_are_refused),
      cmocka_unit_test(files_that_cannot_be_opened),
      cmocka_unit_test(no_flipped_bit_goes_unnoticed),
      cmocka_unit_test(no_cut_goes_unnoticed),
      cmocka_unit_test(no_damage_crashes),
      cmocka_unit_test(places_that_are_refused),
      cmocka_unit_test(failed_write_leaves_the_old_file),
  };
  PetscErrorCode err;
  int            failed;

  if (StartTests(&argc, &argv, &err)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(err) || failed;
}
