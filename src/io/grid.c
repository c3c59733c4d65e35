/* Results on a mesh: the mesh once, then fields of its nodes and cells. */
#include "ioimpl.h"

PetscErrorCode PgGridWriteMesh(PgOutput output, PgHdf *hdf, const PgGrid *grid)
{
  const hsize_t position[2] = {(hsize_t)grid->nodes, 2}, cells[2] = {(hsize_t)grid->cells, 4};

  PetscFunctionBeginUser;
  (void)output;
  PetscCall(PgHdfGroup(hdf, "/mesh"));
  PetscCall(PgHdfDataset(hdf, "/mesh/position", PG_HDF_REAL, 2, position, 0, "m", "place of the node at the start"));
  PetscCall(PgHdfWriteRows(hdf, "/mesh/position", PG_HDF_REAL, grid->nodes, grid->node_start, grid->node_count,
                           grid->position));
  PetscCall(PgHdfDataset(hdf, "/mesh/cells", PG_HDF_INT, 2, cells, 0, "1", "nodes of the cell, counter-clockwise"));
  PetscCall(
      PgHdfWriteRows(hdf, "/mesh/cells", PG_HDF_INT, grid->cells, grid->cell_start, grid->cell_count, grid->corner));
  PetscFunctionReturn(0);
}

/* Everything but the files. */
static PetscErrorCode Prepare(MPI_Comm comm, const char file[], const PgGrid *grid, PetscInt columns,
                              const PgColumn column[], PgOutput *output)
{
  PetscFunctionBeginUser;
  PetscCheck(grid->nodes > 0 && grid->cells > 0, comm, PETSC_ERR_ARG_OUTOFRANGE, "a mesh without cells");
  PetscCall(PgOutputPrepare(comm, NULL, file, columns, column, output));
  (*output)->grid          = *grid;
  (*output)->grid.position = NULL;
  (*output)->grid.corner   = NULL;
  PetscFunctionReturn(0);
}

/* Creates the files of a prepared output; `run` empty: of a new run. */
static PetscErrorCode Create(PgOutput output, const PgGrid *grid, const char run[])
{
  const PetscReal mesh = 16.0 * (PetscReal)grid->nodes + 4.0 * sizeof(PetscInt) * (PetscReal)grid->cells;

  PetscFunctionBeginUser;
  if (run[0])
    PetscCall(PetscStrncpy(output->run, run, sizeof output->run));
  else
    PetscCall(PgRunName(output->comm, output->run));
  PetscCall(PgOutputCheckRoom(output, PgHistoryBytes(output) + PG_PROVENANCE_BYTES + mesh));
  PetscCall(PgOutputWriteFirst(output, grid));
  PetscFunctionReturn(0);
}

PetscErrorCode PgOutputCreateGrid(MPI_Comm comm, const char file[], const PgGrid *grid, PetscInt columns,
                                  const PgColumn column[], PgOutput *output)
{
  PetscErrorCode err;

  PetscFunctionBeginUser;
  PetscCall(Prepare(comm, file, grid, columns, column, output));
  err = Create(*output, grid, "");
  if (err) PetscCall(PgOutputDestroy(output));
  PetscFunctionReturn(err);
}

PetscErrorCode PgOutputContinueGrid(MPI_Comm comm, const char file[], const PgGrid *grid, PetscInt columns,
                                    const PgColumn column[], const char run[], PetscInt rows, PetscInt snapshots,
                                    const char from[], PgOutput *output)
{
  PetscBool      there;
  PetscErrorCode err;

  PetscFunctionBeginUser;
  PetscCall(PgOutputIsThere(comm, file, &there));
  PetscCall(Prepare(comm, file, grid, columns, column, output));
  if (there)
    err = PgOutputTakeUp(*output, run, rows, snapshots, from);
  else
    err = Create(*output, grid, run);
  if (err) PetscCall(PgOutputDestroy(output));
  PetscFunctionReturn(err);
}

static PetscErrorCode WriteField(PgOutput output, PgHdf *hdf, const char group[], const PgGridField *field)
{
  const PgGrid  *grid                  = &output->grid;
  const PetscInt rows                  = field->of_cells ? grid->cells : grid->nodes;
  const PetscInt start                 = field->of_cells ? grid->cell_start : grid->node_start;
  const PetscInt count                 = field->of_cells ? grid->cell_count : grid->node_count;
  const hsize_t  size[PG_HDF_MAX_RANK] = {(hsize_t)rows, 2, 2};
  const int      rank                  = field->components == 1 ? 1 : field->components == 2 ? 2 : 3;
  char           path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCheck(field->components == 1 || field->components == 2 || field->components == 4, output->comm,
             PETSC_ERR_ARG_OUTOFRANGE, "field %s has %" PetscInt_FMT " components, not 1, 2 or 4", field->name,
             field->components);
  (void)snprintf(path, sizeof path, "%s/%s", PG_SNAPSHOT_INCOMPLETE, field->name);
  PetscCall(PgHdfDataset(hdf, path, PG_HDF_REAL, rank, size, 0, field->unit, field->description));
  PetscCall(PgHdfWriteRows(hdf, path, PG_HDF_REAL, rows, start, count, field->value));
  if (output->rank == 0) PetscCall(PgXdmfAddGridField(output, group, field));
  PetscFunctionReturn(0);
}

PetscErrorCode PgOutputGridSnapshot(PgOutput output, PetscReal time, PetscInt fields, const PgGridField field[])
{
  const size_t before = output->grids.used;
  PetscReal    bytes  = 2048.0 * (PetscReal)fields + 16384.0 + PgHistoryBytes(output); /* as for discs */
  char         group[32];
  PgHdf        hdf;

  PetscFunctionBeginUser;
  PetscCheck(!output->finished && !output->particles, output->comm, PETSC_ERR_ORDER, "no open output on a mesh");
  for (PetscInt k = 0; k < fields; k++)
    bytes += 8.0 * (PetscReal)field[k].components *
             (PetscReal)(field[k].of_cells ? output->grid.cells : output->grid.nodes);
  PetscCall(PgOutputOpen(output, bytes, &hdf));
  (void)snprintf(group, sizeof group, "/snapshots/%06lld", (long long)output->snapshots);
  PetscCall(PgHdfRemoveIfThere(&hdf, PG_SNAPSHOT_INCOMPLETE)); /* of an attempt that failed */
  PetscCall(PgHdfGroup(&hdf, PG_SNAPSHOT_INCOMPLETE));
  PetscCall(PgHdfReal(&hdf, PG_SNAPSHOT_INCOMPLETE, "time", time));
  PetscCall(PgHdfText(&hdf, PG_SNAPSHOT_INCOMPLETE, "time_unit", "s"));
  if (output->rank == 0) PetscCall(PgXdmfBeginMesh(output, group, time));
  for (PetscInt k = 0; k < fields; k++) PetscCall(WriteField(output, &hdf, group, &field[k]));
  if (output->rank == 0) PetscCall(PgXdmfEndGrid(output));
  PetscCall(PgSnapshotComplete(output, &hdf, group));
  PetscCall(PgSnapshotClose(output, &hdf, before));
  PetscFunctionReturn(0);
}
