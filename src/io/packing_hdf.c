/* An HDF5 file as a source of discs: datasets position (N,2), radius (N) and, if there, velocity (N,2), read by rank 0
   in pieces. What the file claims is checked before it is used: HDF5 converts and allocates as it is told. */
#include "packingimpl.h"

enum { POSITION, RADIUS, VELOCITY, SETS };

typedef struct {
  PgHdf      hdf; /* of rank 0 alone */
  char       path[SETS][PETSC_MAX_PATH_LEN];
  hid_t      dataset[SETS];
  PetscInt64 row;
  PetscReal *piece; /* PG_PACKING_PIECE rows of a dataset */
} HdfFile;

static const char *const set_name[SETS]  = {"position", "radius", "velocity"};
static const int         set_width[SETS] = {2, 1, 2};
static const int         set_first[SETS] = {PG_PACKING_X, PG_PACKING_R, PG_PACKING_VX};

/* What HDF5 could not do. */
static PetscBool Failed(PgPackingSource *source)
{
  const HdfFile *f = source->context;

  if (f->hdf.failed) PgPackingSourceFail(source, f->hdf.code, "%s", f->hdf.trouble);
  return (PetscBool)(source->code != 0);
}

/* ---- where the discs are ---- */

typedef struct {
  long long number;
  char      name[64];
} LastSnapshot;

/* Snapshots are named by their number, with at least six digits; one that is not complete has another name. */
static herr_t TakeLater(hid_t group, const char *name, const H5L_info_t *info, void *context)
{
  LastSnapshot *last = context;
  const size_t  n    = strlen(name);

  (void)group;
  (void)info;
  if (n < 6 || n > 18 || strspn(name, "0123456789") != n) return 0;
  if (atoll(name) > last->number) {
    last->number = atoll(name);
    (void)snprintf(last->name, sizeof last->name, "%s", name);
  }
  return 0;
}

/* 1 there, 0 not. H5Lexists() fails where a parent is missing. */
static PetscBool Exists(HdfFile *f, const char path[])
{
  char   part[PETSC_MAX_PATH_LEN];
  size_t n = 0;

  while (path[n]) {
    while (path[n] == '/') n++;
    if (!path[n]) break;
    while (path[n] && path[n] != '/') n++;
    (void)snprintf(part, sizeof part, "%.*s", (int)n, path);
    if (PgHdfWatch(&f->hdf, "look for", part, H5Lexists(f->hdf.id, part, H5P_DEFAULT)) <= 0) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* The group that holds the discs, without '/' at its end. */
static void FindGroup(PgPackingSource *source, const char asked[], char group[PETSC_MAX_PATH_LEN])
{
  HdfFile     *f    = source->context;
  LastSnapshot last = {-1, ""};
  hsize_t      at   = 0;
  size_t       n    = strlen(asked);

  group[0] = 0;
  if (n) {
    while (n && asked[n - 1] == '/') n--;
    (void)snprintf(group, PETSC_MAX_PATH_LEN, "%s%.*s", asked[0] == '/' ? "" : "/", (int)n, asked);
    if (n && !Exists(f, group) && !f->hdf.failed)
      PgPackingSourceFail(source, PETSC_ERR_USER_INPUT, "there is no group '%s' (option -packing_group)", group);
    return;
  }
  if (Exists(f, "/position") || f->hdf.failed || !Exists(f, "/snapshots")) return;
  PgHdfWatch(
      &f->hdf, "list", "/snapshots",
      H5Literate_by_name(f->hdf.id, "/snapshots", H5_INDEX_NAME, H5_ITER_NATIVE, &at, TakeLater, &last, H5P_DEFAULT));
  if (last.number < 0)
    PgPackingSourceFail(source, PETSC_ERR_USER_INPUT, "it is a result file without a complete snapshot");
  else
    (void)snprintf(group, PETSC_MAX_PATH_LEN, "/snapshots/%s", last.name);
}

/* ---- datasets ---- */

/* NULL or why the dataset is not N rows of `width` numbers. */
static const char *WhyNotRows(hid_t dataset, int width, hsize_t *rows)
{
  hsize_t     size[H5S_MAX_RANK] = {0};
  const hid_t space = H5Dget_space(dataset), type = H5Dget_type(dataset);
  const int   rank        = space < 0 ? -1 : H5Sget_simple_extent_dims(space, size, NULL);
  const H5T_class_t class = type < 0 ? H5T_NO_CLASS : H5Tget_class(type);
  const size_t bytes      = type < 0 ? 0 : H5Tget_size(type);

  if (space >= 0) (void)H5Sclose(space);
  if (type >= 0) (void)H5Tclose(type);
  if (class != H5T_FLOAT && class != H5T_INTEGER) return "it does not hold numbers";
  if (bytes < 1 || bytes > 16) return "its numbers have an unknown size";
  if (rank != (width > 1 ? 2 : 1)) return width > 1 ? "its shape is not (N,2)" : "its shape is not (N)";
  if (width > 1 && size[1] != (hsize_t)width) return "its shape is not (N,2)";
  *rows = size[0];
  return NULL;
}

/* Pieces of a chunked dataset are held in memory whole, whatever the file says their size is. */
static const char *WhyNotLayout(hid_t dataset)
{
  const double most   = 1 << 26; /* values */
  double       values = 1;
  hsize_t      chunk[H5S_MAX_RANK];
  const hid_t  create = H5Dget_create_plist(dataset);
  const char  *reason = NULL;
  int          rank;

  if (create < 0) return "its layout cannot be read";
  if (H5Pget_external_count(create) != 0) reason = "it keeps its values in another file";
  if (H5Pget_layout(create) == H5D_VIRTUAL) reason = "it takes its values from other datasets";
  if (!reason && H5Pget_layout(create) == H5D_CHUNKED) {
    rank = H5Pget_chunk(create, H5S_MAX_RANK, chunk);
    for (int k = 0; k < rank; k++) values *= (double)chunk[k];
    if (rank < 1 || values > most) reason = "its chunks are too large";
  }
  (void)H5Pclose(create);
  return reason;
}

static void OpenDataset(PgPackingSource *source, int set)
{
  HdfFile    *f    = source->context;
  const char *path = f->path[set], *reason;
  hsize_t     rows = 0;

  f->dataset[set] = PgHdfWatch(&f->hdf, "open dataset", path, H5Dopen2(f->hdf.id, path, H5P_DEFAULT));
  if (Failed(source)) return;
  reason = WhyNotRows(f->dataset[set], set_width[set], &rows);
  if (!reason) reason = WhyNotLayout(f->dataset[set]);
  if (reason)
    PgPackingSourceFail(source, PETSC_ERR_USER_INPUT, "dataset '%s': %s", path, reason);
  else if (rows > (hsize_t)PG_PACKING_MOST)
    PgPackingSourceFail(source, PETSC_ERR_USER_INPUT,
                        "dataset '%s': %llu rows are more discs than the integers of this PETSc can count", path,
                        (unsigned long long)rows);
  else if (!rows)
    PgPackingSourceFail(source, PETSC_ERR_USER_INPUT, "dataset '%s': it holds no disc", path);
  else if (set == POSITION)
    source->total = (PetscInt64)rows;
  else if ((PetscInt64)rows != source->total)
    PgPackingSourceFail(source, PETSC_ERR_USER_INPUT, "dataset '%s': %llu rows, but '%s' has %lld", path,
                        (unsigned long long)rows, f->path[POSITION], (long long)source->total);
}

static void OpenDatasets(PgPackingSource *source, const char asked[])
{
  HdfFile *f = source->context;
  char     group[PETSC_MAX_PATH_LEN];

  FindGroup(source, asked, group);
  for (int set = 0; set < SETS && !Failed(source); set++) {
    PetscBool there;

    (void)PetscSNPrintf(f->path[set], sizeof f->path[set], "%s/%s", group, set_name[set]);
    there = Exists(f, f->path[set]);
    if (Failed(source)) return;
    if (!there && set != VELOCITY)
      PgPackingSourceFail(source, PETSC_ERR_USER_INPUT, "there is no dataset '%s'", f->path[set]);
    if (there) OpenDataset(source, set);
    if (there && set == VELOCITY) source->has_velocity = PETSC_TRUE;
  }
}

/* The attribute periodic_x (2) that the writer leaves on the root. */
static void ReadPeriod(PgPackingSource *source)
{
  HdfFile    *f = source->context;
  const char *reason;
  PetscReal   ends[2] = {0, 0};
  hid_t       attribute, space, type;

  if (PgHdfWatch(&f->hdf, "look for attribute", "periodic_x", H5Aexists(f->hdf.id, "periodic_x")) <= 0) return;
  attribute = PgHdfWatch(&f->hdf, "open attribute", "periodic_x", H5Aopen(f->hdf.id, "periodic_x", H5P_DEFAULT));
  if (attribute < 0) return;
  space = H5Aget_space(attribute);
  type  = H5Aget_type(attribute);
  if (space < 0 || type < 0 || H5Tget_class(type) != H5T_FLOAT || H5Sget_simple_extent_npoints(space) != 2)
    PgPackingSourceFail(source, PETSC_ERR_USER_INPUT, "attribute 'periodic_x' is not two numbers");
  else
    PgHdfWatch(&f->hdf, "read attribute", "periodic_x", H5Aread(attribute, PG_HDF_REAL, ends));
  if (space >= 0) (void)H5Sclose(space);
  if (type >= 0) (void)H5Tclose(type);
  (void)H5Aclose(attribute);
  if (Failed(source)) return;
  reason = PgPackingCheckPeriod(ends[0], ends[1]);
  if (reason) PgPackingSourceFail(source, PETSC_ERR_USER_INPUT, "attribute 'periodic_x': %s", reason);
  source->periodic = PETSC_TRUE;
  source->low      = ends[0];
  source->high     = ends[1];
}

/* ---- reading ---- */

/* Rows [f->row, f->row + rows) of a dataset into f->piece. */
static void ReadRows(HdfFile *f, int set, PetscInt rows)
{
  const char   *path   = f->path[set];
  const hsize_t at[2]  = {(hsize_t)f->row, 0};
  const hsize_t size[] = {(hsize_t)rows, (hsize_t)set_width[set]};
  const int     rank   = set_width[set] > 1 ? 2 : 1;
  const hid_t   memory = PgHdfWatch(&f->hdf, "select rows of", path, H5Screate_simple(rank, size, NULL));
  const hid_t   space  = PgHdfWatch(&f->hdf, "select rows of", path, H5Dget_space(f->dataset[set]));

  PgHdfWatch(&f->hdf, "select rows of", path, H5Sselect_hyperslab(space, H5S_SELECT_SET, at, NULL, size, NULL));
  if (!f->hdf.failed)
    PgHdfWatch(&f->hdf, "read dataset", path,
               H5Dread(f->dataset[set], PG_HDF_REAL, memory, space, H5P_DEFAULT, f->piece));
  if (space >= 0) (void)H5Sclose(space);
  if (memory >= 0) (void)H5Sclose(memory);
}

static void CheckRows(PgPackingSource *source, PetscInt rows, const PetscReal disc[])
{
  const HdfFile *f = source->context;
  char           reason[96];

  for (PetscInt i = 0; i < rows; i++) {
    const int k   = PgPackingCheckDisc(disc + PG_PACKING_VALUES * i, reason, sizeof reason);
    const int set = k >= PG_PACKING_VX ? VELOCITY : (k == PG_PACKING_R ? RADIUS : POSITION);
    if (k < 0) continue;
    PgPackingSourceFail(source, PETSC_ERR_USER_INPUT, "dataset '%s', row %lld: %s", f->path[set], (long long)f->row + i,
                        reason);
    return;
  }
}

static PetscInt Next(PgPackingSource *source, PetscInt room, PetscReal disc[])
{
  HdfFile       *f    = source->context;
  const PetscInt rows = (PetscInt)PetscMin(PetscMin(room, (PetscInt)PG_PACKING_PIECE), source->total - f->row);

  if (source->code || rows <= 0) return 0;
  (void)memset(disc, 0, (size_t)rows * PG_PACKING_VALUES * sizeof *disc);
  for (int set = 0; set < SETS; set++) {
    if (f->dataset[set] < 0) continue;
    ReadRows(f, set, rows);
    if (Failed(source)) return 0;
    for (PetscInt i = 0; i < rows; i++)
      for (int c = 0; c < set_width[set]; c++)
        disc[PG_PACKING_VALUES * i + set_first[set] + c] = f->piece[i * set_width[set] + c];
  }
  CheckRows(source, rows, disc);
  if (source->code) return 0;
  f->row += rows;
  return rows;
}

static void Rewind(PgPackingSource *source) { ((HdfFile *)source->context)->row = 0; }

static void Close(PgPackingSource *source)
{
  HdfFile *f = source->context;

  for (int set = 0; set < SETS; set++)
    if (f->dataset[set] >= 0) (void)H5Dclose(f->dataset[set]);
  if (source->code) PgHdfDismiss(&f->hdf);
  (void)PgHdfClose(&f->hdf);
  (void)PetscFree(f->piece);
  (void)PetscFree(source->context);
}

PetscErrorCode PgPackingHdfOpen(PgPackingSource *source, const char group[])
{
  HdfFile *f;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&f));
  PetscCall(PetscMalloc1(2 * PG_PACKING_PIECE, &f->piece));
  for (int set = 0; set < SETS; set++) f->dataset[set] = H5I_INVALID_HID;
  source->context = f;
  source->next    = Next;
  source->rewind  = Rewind;
  source->close   = Close;
  PetscCall(PgHdfOpenToRead(PETSC_COMM_SELF, source->file, &f->hdf));
  if (!Failed(source)) OpenDatasets(source, group);
  if (!Failed(source)) ReadPeriod(source);
  (void)Failed(source);
  PetscFunctionReturn(0);
}
