/* Results in the order of the whole mesh. */
#include "femimpl.h"

/* Each rank gets a range of numbers; `item` (owned ones) of this rank have these numbers. */
static PetscErrorCode MakeOrder(MPI_Comm comm, PetscInt all, PetscInt owned, const PetscInt item[],
                                const PetscInt number[], PetscInt *start, PetscInt *count, PetscSF *sf)
{
  PetscLayout  layout;
  PetscSFNode *remote;
  PetscInt    *local;

  PetscFunctionBeginUser;
  PetscCall(PetscLayoutCreateFromSizes(comm, PETSC_DECIDE, all, 1, &layout));
  PetscCall(PetscLayoutGetRange(layout, start, count));
  *count -= *start;
  PetscCall(PetscMalloc1(owned, &remote));
  PetscCall(PetscMalloc1(owned, &local));
  for (PetscInt k = 0; k < owned; k++) {
    PetscMPIInt rank;
    local[k] = item[k];
    PetscCall(PetscLayoutFindOwnerIndex(layout, number[item[k]], &rank, &remote[k].index));
    remote[k].rank = rank;
  }
  PetscCall(PetscSFCreate(comm, sf));
  PetscCall(PetscSFSetGraph(*sf, *count, owned, local, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscCall(PetscLayoutDestroy(&layout));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeOrders(PgFem fem)
{
  PetscInt *item, owned = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(PetscMax(fem->nodes, fem->cells), &item));
  for (PetscInt i = 0; i < fem->nodes; i++)
    if (fem->owned[i]) item[owned++] = i;
  PetscCall(MakeOrder(fem->comm, fem->all_nodes, owned, item, fem->number, &fem->node_start, &fem->node_count,
                      &fem->node_sf));
  for (PetscInt c = 0; c < fem->cells; c++) item[c] = c;
  PetscCall(MakeOrder(fem->comm, fem->all_cells, fem->cells, item, fem->cell_number, &fem->cell_start, &fem->cell_count,
                      &fem->cell_sf));
  PetscCall(PetscFree(item));
  PetscFunctionReturn(0);
}

/* `unit` of MPI, `components` of them for each node or cell. */
static PetscErrorCode Order(PetscSF sf, MPI_Datatype unit, PetscInt components, const void *from, void *to)
{
  MPI_Datatype type;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)components, unit, &type));
  PetscCallMPI(MPI_Type_commit(&type));
  PetscCall(PetscSFReduceBegin(sf, type, from, to, MPI_REPLACE));
  PetscCall(PetscSFReduceEnd(sf, type, from, to, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&type));
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemContinueOutput(PgFem fem, const char file[], PetscInt columns, const PgColumn column[],
                                   const PgFemResults *before, PgOutput *output)
{
  PetscReal     *position;
  PetscInt      *corner, *mine;
  PgGrid         grid;
  PetscErrorCode err;

  PetscFunctionBeginUser;
  if (!fem->node_sf) PetscCall(MakeOrders(fem));
  PetscCall(PetscMalloc3(2 * fem->node_count, &position, 4 * fem->cell_count, &corner, 4 * fem->cells, &mine));
  for (PetscInt k = 0; k < 4 * fem->cells; k++) mine[k] = fem->number[fem->cell_node[k]];
  PetscCall(Order(fem->node_sf, MPIU_REAL, 2, fem->x, position));
  PetscCall(Order(fem->cell_sf, MPIU_INT, 4, mine, corner));
  grid = (PgGrid){fem->all_nodes,  fem->node_start, fem->node_count, fem->all_cells,
                  fem->cell_start, fem->cell_count, position,        corner};
  if (before)
    err = PgOutputContinueGrid(fem->comm, file, &grid, columns, column, before->run, before->rows, before->snapshots,
                               before->from, output);
  else
    err = PgOutputCreateGrid(fem->comm, file, &grid, columns, column, output);
  PetscCall(PetscFree3(position, corner, mine));
  PetscFunctionReturn(err);
}

PetscErrorCode PgFemCreateOutput(PgFem fem, const char file[], PetscInt columns, const PgColumn column[],
                                 PgOutput *output)
{
  PetscFunctionBeginUser;
  PetscCall(PgFemContinueOutput(fem, file, columns, column, NULL, output));
  PetscFunctionReturn(0);
}

enum { STRESS = 4, FLUX = 2, MEANS = STRESS + FLUX + 1 };

typedef struct {
  PetscReal *mean, *volume; /* (cells, MEANS), (cells) */
} Means;

static void AddMeans(void *context, const PgFemPoint *point, PetscReal value[])
{
  Means          *means       = (Means *)context;
  const PetscReal here[MEANS] = {point->stress[0], point->stress[2], point->stress[2],        point->stress[1],
                                 point->flux[0],   point->flux[1],   point->volumetric_strain};

  (void)value;
  for (int k = 0; k < MEANS; k++) means->mean[MEANS * point->cell + k] += point->dV * here[k];
  means->volume[point->cell] += point->dV;
}

/* Means of the cells in the order of the file, one field after the other. */
static PetscErrorCode CellFields(PgFem fem, PetscReal ordered[])
{
  static const PetscInt first[4] = {0, STRESS, STRESS + FLUX, MEANS};
  PetscReal            *one;
  Means                 means;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(MEANS * fem->cells, &means.mean, fem->cells, &means.volume, STRESS * fem->cells, &one));
  PetscCall(PgFemIntegrate(fem, 0, AddMeans, &means, NULL));
  for (int f = 0; f < 3; f++) {
    const PetscInt n = first[f + 1] - first[f];
    for (PetscInt c = 0; c < fem->cells; c++)
      for (PetscInt k = 0; k < n; k++) one[c * n + k] = means.mean[MEANS * c + first[f] + k] / means.volume[c];
    PetscCall(Order(fem->cell_sf, MPIU_REAL, n, one, ordered + first[f] * fem->cell_count));
  }
  PetscCall(PetscFree3(means.mean, means.volume, one));
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSnapshot(PgFem fem, PgOutput output)
{
  const PetscInt n = fem->node_count, m = fem->cell_count;
  PetscReal     *node, *cell;
  PgFemNodes     nodes;

  PetscFunctionBeginUser;
  PetscCheck(fem->node_sf, fem->comm, PETSC_ERR_ORDER, "PgFemCreateOutput() comes before PgFemSnapshot()");
  PetscCall(PetscMalloc2(5 * n, &node, MEANS * m, &cell));
  PetscCall(PgFemGetNodes(fem, &nodes));
  PetscCall(Order(fem->node_sf, MPIU_REAL, 2, nodes.displacement, node));
  PetscCall(Order(fem->node_sf, MPIU_REAL, 2, nodes.velocity, node + 2 * n));
  PetscCall(Order(fem->node_sf, MPIU_REAL, 1, nodes.pressure, node + 4 * n));
  PetscCall(CellFields(fem, cell));
  {
    const PgGridField field[] = {
        {"displacement", PETSC_FALSE, 2, "m", "displacement of the skeleton", node},
        {"velocity", PETSC_FALSE, 2, "m/s", "velocity of the skeleton", node + 2 * n},
        {"pressure", PETSC_FALSE, 1, "Pa", "pressure of the pore water", node + 4 * n},
        {"effective_stress", PETSC_TRUE, 4, "Pa", "mean stress of the skeleton in the cell, tension positive", cell},
        {"flux", PETSC_TRUE, 2, "m/s", "mean n (v_f - v_s) in the cell, Darcy's velocity", cell + STRESS * m},
        {"volumetric_strain", PETSC_TRUE, 1, "1", "mean div u in the cell", cell + (STRESS + FLUX) * m},
    };
    PetscCall(PgOutputGridSnapshot(output, fem->time, sizeof field / sizeof *field, field));
  }
  PetscCall(PetscFree2(node, cell));
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemOutputDestroy(PgFem fem)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSFDestroy(&fem->node_sf));
  PetscCall(PetscSFDestroy(&fem->cell_sf));
  PetscFunctionReturn(0);
}
