/* What has become settled in the result file: places of the values of finished snapshots and of full pieces of the
   history. Runs on rank 0 while nobody has the file open. */
#include "ioimpl.h"
#include <errno.h>
#include <stdlib.h>

enum { LEAST = 4096 }; /* shorter ranges cost more than they save */

static const char *Add(PgOutput output, haddr_t offset, hsize_t length)
{
  if (offset == HADDR_UNDEF || length < LEAST) return NULL;
  if (output->settled_count == output->settled_room) {
    output->settled_room = 2 * output->settled_room + 64;
    if (PetscRealloc(output->settled_room * sizeof *output->settled, &output->settled)) return strerror(ENOMEM);
  }
  output->settled[output->settled_count++] = (PgRange){(int64_t)offset, (int64_t)length};
  return NULL;
}

typedef struct {
  PgOutput    output;
  const char *reason;
} Walk;

/* A dataset of a finished snapshot: one contiguous range. */
static herr_t AddDataset(hid_t group, const char *name, const H5L_info_t *info, void *context)
{
  Walk       *walk    = context;
  const hid_t dataset = H5Dopen2(group, name, H5P_DEFAULT);
  hid_t       create;

  (void)info;
  if (dataset < 0) return -1;
  create = H5Dget_create_plist(dataset);
  if (create >= 0 && H5Pget_layout(create) == H5D_CONTIGUOUS)
    walk->reason = Add(walk->output, H5Dget_offset(dataset), H5Dget_storage_size(dataset));
  if (create >= 0) (void)H5Pclose(create);
  (void)H5Dclose(dataset);
  return walk->reason ? 1 : 0;
}

/* Pieces of a column that are full and in the file. */
static const char *AddPieces(PgOutput output, hid_t file, PetscInt column, PetscInt first, PetscInt end)
{
  char        path[PETSC_MAX_PATH_LEN];
  const char *reason = NULL;
  hid_t       dataset, space;

  if (PgHistoryPath(output, column, path, sizeof path)) return "a column has no name";
  dataset = H5Dopen2(file, path, H5P_DEFAULT);
  if (dataset < 0) return "a column of the history is missing";
  space = H5Dget_space(dataset);
  for (PetscInt p = first; p < end && !reason; p++) {
    const hsize_t row    = (hsize_t)p * PG_HISTORY_CHUNK;
    unsigned      filter = 0;
    haddr_t       offset = HADDR_UNDEF;
    hsize_t       size   = 0;

    if (H5Dget_chunk_info_by_coord(dataset, &row, &filter, &offset, &size) >= 0) reason = Add(output, offset, size);
  }
  if (space >= 0) (void)H5Sclose(space);
  (void)H5Dclose(dataset);
  return reason;
}

static const char *Settle(PgOutput output, hid_t file)
{
  const PetscInt first = output->settled_rows / PG_HISTORY_CHUNK, end = output->written / PG_HISTORY_CHUNK;
  Walk           walk = {output, NULL};

  for (PetscInt c = 0; c < output->columns && first < end && !walk.reason; c++)
    walk.reason = AddPieces(output, file, c, first, end);
  for (PetscInt k = output->settled_snapshots; k < output->snapshots && !walk.reason; k++) {
    char group[32];
    (void)snprintf(group, sizeof group, "/snapshots/%06lld", (long long)k);
    if (H5Literate_by_name(file, group, H5_INDEX_NAME, H5_ITER_NATIVE, NULL, AddDataset, &walk, H5P_DEFAULT) < 0)
      walk.reason = "a snapshot of it cannot be read";
  }
  if (walk.reason) return walk.reason;
  output->settled_rows      = end * PG_HISTORY_CHUNK;
  output->settled_snapshots = output->snapshots;
  return NULL;
}

const char *PgSettle(PgOutput output)
{
  const char *reason;
  PgHdf       hdf;

  if (output->settled_snapshots == output->snapshots &&
      output->settled_rows / PG_HISTORY_CHUNK == output->written / PG_HISTORY_CHUNK)
    return NULL;
  if (PgHdfOpenToRead(PETSC_COMM_SELF, output->file, &hdf)) return "its settled parts cannot be looked for";
  reason = hdf.failed ? "HDF5 cannot open it" : Settle(output, hdf.id);
  if (hdf.disk.error) reason = strerror(hdf.disk.error);
  if (reason) PgHdfDismiss(&hdf);
  return PgHdfClose(&hdf) && !reason ? "HDF5 cannot close it" : reason;
}
