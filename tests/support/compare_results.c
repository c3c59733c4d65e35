/* compare_results A.h5 B.h5 [TOLERANCE [DATASET...]]: compares all snapshots of two result files, disc by disc by
   permanent id. Exit status 0: equal, 1: not, 2: a file cannot be read.

   Without TOLERANCE (or with 0) every value must have the same bits. With one, the largest difference in a dataset
   must not exceed TOLERANCE times the largest change that this dataset has undergone in A since its first
   snapshot (a maximum over discs, components and snapshots: so pressure is measured by its excess over the initial
   one, positions by displacements, and what never changed must be equal). The largest differences are printed then.
   With DATASETs only these are compared. */
#include <hdf5.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { EQUAL, DIFFERENT, UNREADABLE };
enum { MOST_NAMES = 64 };

typedef struct {
  const char *file;
  hid_t       id;
  hsize_t     snapshots;
} Result;

typedef struct {
  hsize_t rows, columns;
  double *value; /* (rows, columns) */
} Table;

static void Leave(int status, const char format[], ...)
{
  va_list arguments;

  va_start(arguments, format);
  (void)vfprintf(stderr, format, arguments);
  va_end(arguments);
  (void)fputc('\n', stderr);
  exit(status);
}

static void *Allocate(size_t count, size_t size)
{
  void *memory = calloc(count ? count : 1, size);

  if (!memory) Leave(UNREADABLE, "no memory for %zu values", count);
  return memory;
}

static hsize_t CountLinks(const Result *result, const char group[])
{
  H5G_info_t info;

  if (H5Gget_info_by_name(result->id, group, &info, H5P_DEFAULT) < 0)
    Leave(UNREADABLE, "%s has no group %s", result->file, group);
  return info.nlinks;
}

static Result Open(const char file[])
{
  Result result = {.file = file, .id = H5Fopen(file, H5F_ACC_RDONLY, H5P_DEFAULT)};

  if (result.id < 0) Leave(UNREADABLE, "%s is not an HDF5 file that can be read", file);
  result.snapshots = CountLinks(&result, "/snapshots");
  return result;
}

static double SnapshotTime(const Result *result, const char group[])
{
  double      time;
  const hid_t attribute = H5Aopen_by_name(result->id, group, "time", H5P_DEFAULT, H5P_DEFAULT);

  if (attribute < 0 || H5Aread(attribute, H5T_NATIVE_DOUBLE, &time) < 0)
    Leave(UNREADABLE, "%s: %s has no attribute time", result->file, group);
  (void)H5Aclose(attribute);
  return time;
}

static Table Read(const Result *result, const char group[], const char name[])
{
  char        path[256];
  hsize_t     size[H5S_MAX_RANK];
  Table       table  = {1, 1, NULL};
  const int   length = snprintf(path, sizeof path, "%s/%s", group, name);
  const hid_t set    = length < (int)sizeof path ? H5Dopen2(result->id, path, H5P_DEFAULT) : -1;
  const hid_t space  = set < 0 ? -1 : H5Dget_space(set);
  const int   rank   = space < 0 ? -1 : H5Sget_simple_extent_dims(space, size, NULL);

  if (rank < 1) Leave(UNREADABLE, "%s has no dataset %s/%s", result->file, group, name);
  table.rows = size[0];
  for (int k = 1; k < rank; k++) table.columns *= size[k];
  table.value = Allocate((size_t)(table.rows * table.columns), sizeof *table.value);
  if (H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, table.value) < 0)
    Leave(UNREADABLE, "%s: cannot read %s", result->file, path);
  (void)H5Sclose(space);
  (void)H5Dclose(set);
  return table;
}

/* row[id]: where the disc with this permanent id stands. */
static size_t *Places(const Result *result, const char group[])
{
  Table   id  = Read(result, group, "id");
  size_t *row = Allocate((size_t)id.rows, sizeof *row);

  for (hsize_t i = 0; i < id.rows; i++) row[i] = (size_t)id.rows;
  for (hsize_t i = 0; i < id.rows; i++) {
    if (!(id.value[i] >= 0 && id.value[i] < (double)id.rows) || row[(size_t)id.value[i]] < id.rows)
      Leave(DIFFERENT, "%s: the ids of %s are not 0 .. N-1, each once", result->file, group);
    row[(size_t)id.value[i]] = (size_t)i;
  }
  free(id.value);
  return row;
}

/* Values in ascending id. */
static Table ReadById(const Result *result, const char group[], const char name[])
{
  Table   table = Read(result, group, name);
  size_t *row   = Places(result, group);
  double *byid  = Allocate((size_t)(table.rows * table.columns), sizeof *byid);

  for (size_t i = 0; i < table.rows; i++)
    (void)memcpy(byid + i * table.columns, table.value + row[i] * table.columns, (size_t)table.columns * sizeof *byid);
  free(row);
  free(table.value);
  table.value = byid;
  return table;
}

static int SameBits(double a, double b) { return memcmp(&a, &b, sizeof a) == 0; }

/* Largest |x - y|; NaN counts as infinite. */
static double Distance(const Table *x, const Table *y)
{
  double most = 0;

  for (size_t i = 0; i < x->rows * x->columns; i++) {
    const double d = fabs(x->value[i] - y->value[i]);
    if (!(d <= most)) most = isnan(d) ? INFINITY : d;
  }
  return most;
}

static void CompareBits(const Table *a, const Table *b, const char group[], const char name[])
{
  for (size_t i = 0; i < a->rows * a->columns; i++)
    if (!SameBits(a->value[i], b->value[i]))
      Leave(DIFFERENT, "%s/%s of disc %zu, component %zu: %.17g and %.17g", group, name, i / (size_t)a->columns,
            i % (size_t)a->columns, a->value[i], b->value[i]);
}

static void CompareDataset(const Result *a, const Result *b, const char name[], double tolerance)
{
  double difference = 0, change = 0;
  Table  first = {0, 0, NULL};

  for (hsize_t k = 0; k < a->snapshots; k++) {
    char  group[32];
    Table x, y;

    (void)snprintf(group, sizeof group, "/snapshots/%06u", (unsigned)k);
    x = ReadById(a, group, name);
    y = ReadById(b, group, name);
    if (x.rows != y.rows || x.columns != y.columns) Leave(DIFFERENT, "%s/%s has another shape", group, name);
    if (!(tolerance > 0)) CompareBits(&x, &y, group, name);
    if (k == 0) first = x;
    difference = fmax(difference, Distance(&x, &y));
    change     = fmax(change, Distance(&x, &first));
    free(y.value);
    if (k > 0) free(x.value);
  }
  free(first.value);
  if (!(tolerance > 0)) return;
  (void)printf("%-22s largest difference %9.3e, largest change %9.3e, ratio %9.3e\n", name, difference, change,
               difference > 0 ? difference / change : 0.0);
  if (!(difference <= tolerance * change))
    Leave(DIFFERENT, "%s differs by %g, more than %g times its change %g", name, difference, tolerance, change);
}

static size_t ListDatasets(const Result *result, const char group[], char names[MOST_NAMES][64])
{
  const hsize_t count = CountLinks(result, group);

  if (count > MOST_NAMES) Leave(UNREADABLE, "%s: %s holds more than %d datasets", result->file, group, MOST_NAMES);
  for (hsize_t k = 0; k < count; k++)
    if (H5Lget_name_by_idx(result->id, group, H5_INDEX_NAME, H5_ITER_INC, k, names[k], sizeof names[k], H5P_DEFAULT) <
        0)
      Leave(UNREADABLE, "%s: cannot list %s", result->file, group);
  return (size_t)count;
}

/* The same snapshots at the same times with the same datasets. */
static void CompareContents(const Result *a, const Result *b)
{
  static char mine[MOST_NAMES][64], theirs[MOST_NAMES][64];

  if (a->snapshots != b->snapshots || a->snapshots < 2)
    Leave(DIFFERENT, "%llu and %llu snapshots: equal numbers, and two at least, are needed",
          (unsigned long long)a->snapshots, (unsigned long long)b->snapshots);
  for (hsize_t k = 0; k < a->snapshots; k++) {
    char   group[32];
    size_t count, others;

    (void)snprintf(group, sizeof group, "/snapshots/%06u", (unsigned)k);
    if (!SameBits(SnapshotTime(a, group), SnapshotTime(b, group))) Leave(DIFFERENT, "%s: times differ", group);
    count  = ListDatasets(a, group, mine);
    others = ListDatasets(b, group, theirs);
    if (count != others) Leave(DIFFERENT, "%s: %zu and %zu datasets", group, count, others);
    for (size_t i = 0; i < count; i++)
      if (strcmp(mine[i], theirs[i])) Leave(DIFFERENT, "%s: datasets %s and %s", group, mine[i], theirs[i]);
  }
}

int main(int argc, char *argv[])
{
  const double tolerance = argc > 3 ? atof(argv[3]) : 0.0;
  char         names[MOST_NAMES][64];
  size_t       count;
  Result       a, b;

  if (argc < 3) Leave(UNREADABLE, "usage: compare_results A.h5 B.h5 [TOLERANCE [DATASET...]]");
  (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  a = Open(argv[1]);
  b = Open(argv[2]);
  CompareContents(&a, &b);
  if (argc > 4) {
    for (int k = 4; k < argc; k++) CompareDataset(&a, &b, argv[k], tolerance);
  } else {
    count = ListDatasets(&a, "/snapshots/000000", names);
    for (size_t k = 0; k < count; k++) CompareDataset(&a, &b, names[k], tolerance);
  }
  (void)H5Fclose(a.id);
  (void)H5Fclose(b.id);
  return EQUAL;
}
