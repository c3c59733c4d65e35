/* The mesh as arrays: vertices, cells with their vertices counter-clockwise, pieces of boundaries. */
#include "femimpl.h"

static PetscErrorCode OwnNodes(PgFem fem, PetscInt first)
{
  PetscSF         sf;
  PetscInt        leaves;
  const PetscInt *leaf;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < fem->nodes; i++) fem->owned[i] = PETSC_TRUE;
  PetscCall(DMGetPointSF(fem->dm, &sf));
  PetscCall(PetscSFGetGraph(sf, NULL, &leaves, &leaf, NULL));
  for (PetscInt k = 0; k < leaves; k++) {
    const PetscInt i = (leaf ? leaf[k] : k) - first;
    if (i >= 0 && i < fem->nodes) fem->owned[i] = PETSC_FALSE;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemLayOutNodes(PgFem fem, const PetscInt number[])
{
  PetscInt           start, first, last;
  Vec                coordinates;
  const PetscScalar *value;
  PetscSection       section;
  DM                 cdm;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetChart(fem->dm, &start, NULL));
  PetscCall(DMPlexGetDepthStratum(fem->dm, 0, &first, &last));
  fem->nodes = last - first;
  PetscCall(PetscMalloc3(2 * fem->nodes, &fem->x, fem->nodes, &fem->number, fem->nodes, &fem->owned));
  PetscCall(DMGetCoordinateDM(fem->dm, &cdm));
  PetscCall(DMGetLocalSection(cdm, &section));
  PetscCall(DMGetCoordinatesLocal(fem->dm, &coordinates));
  PetscCall(VecGetArrayRead(coordinates, &value));
  for (PetscInt i = 0; i < fem->nodes; i++) {
    PetscInt at;
    PetscCall(PetscSectionGetOffset(section, first + i, &at));
    for (int k = 0; k < 2; k++) {
      fem->x[2 * i + k] = PetscRealPart(value[at + k]);
      if (!fem->file[0]) /* from the unit square, so that the ends are exact */
        fem->x[2 * i + k] = fem->box_low[k] * (1.0 - fem->x[2 * i + k]) + fem->box_high[k] * fem->x[2 * i + k];
    }
    if (fem->map) fem->map(fem->map_context, &fem->x[2 * i]);
    fem->number[i] = number[first + i - start];
  }
  PetscCall(VecRestoreArrayRead(coordinates, &value));
  PetscCall(OwnNodes(fem, first));
  PetscFunctionReturn(0);
}

/* Whether corner k of a cell turns left, as a number: twice the area of the triangle there. */
static PetscReal Corner(const PgFem fem, const PetscInt node[4], int k)
{
  const PetscReal *a = &fem->x[2 * node[(k + 3) % 4]], *b = &fem->x[2 * node[k]], *c = &fem->x[2 * node[(k + 1) % 4]];

  return (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
}

/* Vertices counter-clockwise. *bad: a corner that is not convex, as good as flat, or outward. */
static void Orient(const PgFem fem, PetscInt node[4], PetscBool *bad)
{
  PetscReal least = PETSC_MAX_REAL, most = -PETSC_MAX_REAL;

  for (int k = 0; k < 4; k++) {
    least = PetscMin(least, Corner(fem, node, k));
    most  = PetscMax(most, Corner(fem, node, k));
  }
  if (most < 0.0) {
    const PetscInt  other = node[1];
    const PetscReal swap  = -least;
    node[1]               = node[3];
    node[3]               = other;
    least                 = -most;
    most                  = swap;
  }
  *bad = (PetscBool) !(least > 1e-12 * most); /* 1e-12: far below any useful cell, far above rounding */
}

static PetscErrorCode LayOutCell(PgFem fem, PetscInt cell, PetscInt first_node, PetscInt first_edge, PetscBool *bad)
{
  PetscInt size, *closure = NULL, found = 0, *node = &fem->cell_node[4 * cell], edge[4], edges = 0;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetTransitiveClosure(fem->dm, cell, PETSC_TRUE, &size, &closure));
  for (PetscInt k = 0; k < size; k++) {
    const PetscInt p = closure[2 * k];
    if (p >= first_node && p < first_node + fem->nodes && found < 4) node[found++] = p - first_node;
    if (p >= first_edge && p < first_edge + fem->edges && edges < 4) edge[edges++] = p;
  }
  PetscCall(DMPlexRestoreTransitiveClosure(fem->dm, cell, PETSC_TRUE, &size, &closure));
  PetscCheck(found == 4 && edges == 4, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a cell with %d vertices", (int)found);
  Orient(fem, node, bad);
  for (int s = 0; s < 4; s++) {
    const PetscInt a = node[s] + first_node, b = node[(s + 1) % 4] + first_node;
    fem->cell_edge[4 * cell + s] = -1;
    for (int k = 0; k < 4; k++) {
      const PetscInt *end;
      PetscCall(DMPlexGetCone(fem->dm, edge[k], &end));
      if ((end[0] == a && end[1] == b) || (end[0] == b && end[1] == a))
        fem->cell_edge[4 * cell + s] = edge[k] - first_edge;
    }
    if (fem->cell_edge[4 * cell + s] < 0) *bad = PETSC_TRUE; /* its vertices are not in order */
  }
  PetscFunctionReturn(0);
}

/* Of all bad cells the one with the smallest number, by name of file and place. */
static PetscErrorCode RefuseBad(PgFem fem, PetscInt worst)
{
  PetscReal place[3] = {PETSC_MAX_REAL, 0, 0}, all[2] = {0, 0};
  PetscInt  least = worst < 0 ? PETSC_MAX_INT : fem->cell_number[worst], first;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(&least, &first, 1, MPIU_INT, MPI_MIN, fem->comm));
  if (first == PETSC_MAX_INT) PetscFunctionReturn(0);
  place[0] = place[1] = 0.0;
  if (worst >= 0 && least == first)
    for (int k = 0; k < 4; k++)
      for (int d = 0; d < 2; d++) place[d] += 0.25 * fem->x[2 * fem->cell_node[4 * worst + k] + d];
  PetscCallMPI(MPI_Allreduce(place, all, 2, MPIU_REAL, MPIU_SUM, fem->comm));
  if (fem->file[0])
    PgInputError(fem->comm,
                 "mesh file '%s': the cell at (%g, %g) is not a convex quadrilateral (cell %" PetscInt_FMT
                 " of %" PetscInt_FMT ")",
                 fem->file, (double)all[0], (double)all[1], first + 1, fem->all_cells);
  PgInputError(fem->comm, "mesh: the cell at (%g, %g) is not a convex quadrilateral", (double)all[0], (double)all[1]);
}

PetscErrorCode PgFemLayOutCells(PgFem fem, const PetscInt number[])
{
  PetscInt start, first, last, first_node, first_edge, last_edge, worst = -1;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetChart(fem->dm, &start, NULL));
  PetscCall(DMPlexGetHeightStratum(fem->dm, 0, &first, &last));
  PetscCall(DMPlexGetDepthStratum(fem->dm, 0, &first_node, NULL));
  PetscCall(DMPlexGetHeightStratum(fem->dm, 1, &first_edge, &last_edge));
  PetscCheck(first == 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "cells do not come first");
  fem->cells = last - first;
  fem->edges = last_edge - first_edge;
  PetscCall(PetscMalloc4(4 * fem->cells, &fem->cell_node, 4 * fem->cells, &fem->cell_edge, fem->cells,
                         &fem->cell_number, fem->cells, &fem->cell_material));
  for (PetscInt c = 0; c < fem->cells; c++) {
    PetscBool bad       = PETSC_FALSE;
    fem->cell_number[c] = number[c - start];
    PetscCall(LayOutCell(fem, c, first_node, first_edge, &bad));
    if (bad && (worst < 0 || fem->cell_number[c] < fem->cell_number[worst])) worst = c;
  }
  PetscCall(RefuseBad(fem, worst));
  PetscFunctionReturn(0);
}

/* The pieces that this rank integrates: an edge between two ranks is with the one that owns it. Inside the mesh an edge
   has a cell on either side, and the one with the smaller number counts. */
static PetscErrorCode LayOutBoundary(PgFem fem, PgFemBoundary *b, const PetscBool remote[])
{
  PetscInt first, last, count = 0;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetHeightStratum(fem->dm, 1, &first, &last));
  for (int pass = 0; pass < 2; pass++) {
    count = 0;
    for (PetscInt e = first; e < last; e++) {
      PetscInt        cells, in, s = 0;
      const PetscInt *cell;
      PetscCall(DMLabelGetValue(b->label, e, &in));
      if (in != 1 || remote[e - first]) continue;
      PetscCall(DMPlexGetSupportSize(fem->dm, e, &cells));
      if (cells == 0) continue;
      if (pass == 0) {
        count++;
        continue;
      }
      PetscCall(DMPlexGetSupport(fem->dm, e, &cell));
      while (s < 3 && fem->cell_edge[4 * cell[0] + s] != e - first) s++;
      b->side[count]         = (PgFemSide){cell[0], s};
      b->node[2 * count]     = fem->cell_node[4 * cell[0] + s];
      b->node[2 * count + 1] = fem->cell_node[4 * cell[0] + (s + 1) % 4];
      count++;
    }
    if (pass == 0) PetscCall(PetscMalloc2(count, &b->side, 2 * count, &b->node));
  }
  b->count = count;
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemLayOutBoundaries(PgFem fem)
{
  PetscSF         sf;
  PetscInt        leaves, first;
  const PetscInt *leaf;
  PetscBool      *remote;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetHeightStratum(fem->dm, 1, &first, NULL));
  PetscCall(PetscCalloc1(fem->edges, &remote));
  PetscCall(DMGetPointSF(fem->dm, &sf));
  PetscCall(PetscSFGetGraph(sf, NULL, &leaves, &leaf, NULL));
  for (PetscInt k = 0; k < leaves; k++) {
    const PetscInt e = (leaf ? leaf[k] : k) - first;
    if (e >= 0 && e < fem->edges) remote[e] = PETSC_TRUE;
  }
  for (PetscInt b = 0; b < fem->boundaries; b++) {
    char name[32];
    PgFemLabelName(b, name);
    PetscCall(DMGetLabel(fem->dm, name, &fem->boundary[b].label));
    PetscCheck(fem->boundary[b].label, fem->comm, PETSC_ERR_PLIB, "label %s is lost", name);
    PetscCall(LayOutBoundary(fem, &fem->boundary[b], remote));
  }
  PetscCall(PetscFree(remote));
  PetscFunctionReturn(0);
}
