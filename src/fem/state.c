/* What a run of the continuum needs to go on, as values of the whole mesh on every rank: they do not depend on the
   number of ranks, and a mesh of 1e5 nodes takes 7 MB. */
#include "femimpl.h"

enum {
  PLACE   = 2,
  VERTEX  = 7 /* u, p, v, a */,
  MIDDLE  = 6 /* u, v, a */,
  MIDDLES = 5 /* of a cell's edges, and its centre */
};

struct PgFemKept_s {
  char       element[8];
  PetscInt   sizes[2]; /* nodes, cells */
  PetscReal *place;    /* (nodes, PLACE) */
  PetscReal *vertex;   /* (nodes, VERTEX) */
  PetscReal *middle;   /* (cells, MIDDLES, MIDDLE), of Q2-Q1 */
  PetscReal *plate;    /* (plates) */
};

/* What one rank has and all others have as zero, on all of them; no bit changes, not even the sign of a zero. */
static PetscErrorCode Share(MPI_Comm comm, PetscInt count, PetscReal value[])
{
  const PetscInt piece = 1 << 24; /* MPI counts with int */

  PetscFunctionBeginUser;
  for (PetscInt at = 0; at < count; at += piece)
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, value + at,
                               (PetscMPIInt)(PetscMin(piece, count - at) * (PetscInt)sizeof *value), MPI_BYTE, MPI_BOR,
                               comm));
  PetscFunctionReturn(0);
}

static PetscErrorCode Make(PgFem fem)
{
  static const char *const elements[] = {"q1q1", "q2q1", "q1"};
  const PetscInt           nodes = fem->all_nodes, cells = fem->un == PG_FEM_UN ? fem->all_cells : 0;
  PgFemKept                kept;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&kept));
  fem->kept = kept;
  PetscCall(PetscStrncpy(kept->element, elements[fem->element], sizeof kept->element));
  kept->sizes[0] = fem->all_nodes;
  kept->sizes[1] = fem->all_cells;
  PetscCall(PetscCalloc4(nodes * PLACE, &kept->place, nodes * VERTEX, &kept->vertex, cells * MIDDLES * MIDDLE,
                         &kept->middle, fem->plates, &kept->plate));
  for (PetscInt i = 0; i < fem->nodes; i++)
    if (fem->owned[i]) PetscCall(PetscArraycpy(kept->place + PLACE * fem->number[i], fem->x + 2 * i, PLACE));
  PetscCall(Share(fem->comm, nodes * PLACE, kept->place));
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemKeptDestroy(PgFem fem)
{
  PetscFunctionBeginUser;
  if (!fem->kept) PetscFunctionReturn(0);
  PetscCall(PetscFree4(fem->kept->place, fem->kept->vertex, fem->kept->middle, fem->kept->plate));
  PetscCall(PetscFree(fem->kept));
  PetscFunctionReturn(0);
}

/* Local unknown ux of a middle: those of edges are with both of their cells, and the same in both. */
static PetscInt MiddleDof(const PgFem fem, PetscInt cell, PetscInt middle)
{
  return fem->dof[cell * fem->dofs + 2 * (4 + middle)];
}

static PetscErrorCode Gather(PgFem fem)
{
  PgFemKept kept = fem->kept;
  PetscInt  first, at;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepthStratum(fem->dm, 0, &first, NULL));
  PetscCall(PetscArrayzero(kept->vertex, fem->all_nodes * VERTEX));
  for (PetscInt i = 0; i < fem->nodes; i++) {
    PetscReal *value = kept->vertex + VERTEX * fem->number[i];
    if (!fem->owned[i]) continue;
    PetscCall(PetscSectionGetOffset(fem->section, first + i, &at));
    PetscCall(PetscArraycpy(value, fem->u + at, 3));
    PetscCall(PetscArraycpy(value + 3, fem->v + at, 2));
    PetscCall(PetscArraycpy(value + 5, fem->a + at, 2));
  }
  PetscCall(Share(fem->comm, fem->all_nodes * VERTEX, kept->vertex));
  for (PetscInt m = 0; m < fem->plates; m++) kept->plate[m] = fem->plate[m].displacement;
  if (fem->un < PG_FEM_UN) PetscFunctionReturn(0);
  PetscCall(PetscArrayzero(kept->middle, fem->all_cells * MIDDLES * MIDDLE));
  for (PetscInt c = 0; c < fem->cells; c++)
    for (PetscInt k = 0; k < MIDDLES; k++) {
      PetscReal *value = kept->middle + MIDDLE * (MIDDLES * fem->cell_number[c] + k);
      at               = MiddleDof(fem, c, k);
      PetscCall(PetscArraycpy(value, fem->u + at, 2));
      PetscCall(PetscArraycpy(value + 2, fem->v + at, 2));
      PetscCall(PetscArraycpy(value + 4, fem->a + at, 2));
    }
  PetscCall(Share(fem->comm, fem->all_cells * MIDDLES * MIDDLE, kept->middle));
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemAddState(PgFem fem, PgState state)
{
  PgFemKept kept;

  PetscFunctionBeginUser;
  PetscCheck(fem->dof, fem->comm, PETSC_ERR_ORDER, "PgFemSetUp() comes before PgFemAddState()");
  if (!fem->kept) PetscCall(Make(fem));
  kept = fem->kept;
  PetscCall(Gather(fem));
  PetscCall(
      PgStateAddText(state, "up_element", PG_STATE_MATCH, "option -up_element", sizeof kept->element, kept->element));
  PetscCall(
      PgStateAddInts(state, "up_sizes", PG_STATE_MATCH, "the number of nodes or cells of the mesh", 2, kept->sizes));
  PetscCall(PgStateAddReals(state, "up_places", PG_STATE_MATCH, "a coordinate of a node of the mesh [m]",
                            PLACE * fem->all_nodes, kept->place));
  PetscCall(PgStateAddInts(state, "up_step", PG_STATE_KEEP, NULL, 1, &fem->step));
  PetscCall(PgStateAddReals(state, "up_time", PG_STATE_KEEP, NULL, 1, &fem->time));
  PetscCall(PgStateAddReals(state, "up_nodes", PG_STATE_KEEP, NULL, VERTEX * fem->all_nodes, kept->vertex));
  if (fem->un == PG_FEM_UN)
    PetscCall(
        PgStateAddReals(state, "up_middles", PG_STATE_KEEP, NULL, MIDDLE * MIDDLES * fem->all_cells, kept->middle));
  if (fem->plates) PetscCall(PgStateAddReals(state, "up_plates", PG_STATE_KEEP, NULL, fem->plates, kept->plate));
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemTakeState(PgFem fem)
{
  const PgFemKept kept = fem->kept;
  PetscInt        first, at;

  PetscFunctionBeginUser;
  PetscCheck(kept, fem->comm, PETSC_ERR_ORDER, "PgFemAddState() comes before PgFemTakeState()");
  PetscCall(DMPlexGetDepthStratum(fem->dm, 0, &first, NULL));
  for (PetscInt i = 0; i < fem->nodes; i++) {
    const PetscReal *value = kept->vertex + VERTEX * fem->number[i];
    PetscCall(PetscSectionGetOffset(fem->section, first + i, &at));
    PetscCall(PetscArraycpy(fem->u + at, value, 3));
    PetscCall(PetscArraycpy(fem->v + at, value + 3, 2));
    PetscCall(PetscArraycpy(fem->a + at, value + 5, 2));
  }
  for (PetscInt m = 0; m < fem->plates; m++) fem->plate[m].displacement = kept->plate[m];
  if (fem->un < PG_FEM_UN) PetscFunctionReturn(0);
  for (PetscInt c = 0; c < fem->cells; c++)
    for (PetscInt k = 0; k < MIDDLES; k++) {
      const PetscReal *value = kept->middle + MIDDLE * (MIDDLES * fem->cell_number[c] + k);
      at                     = MiddleDof(fem, c, k);
      PetscCall(PetscArraycpy(fem->u + at, value, 2));
      PetscCall(PetscArraycpy(fem->v + at, value + 2, 2));
      PetscCall(PetscArraycpy(fem->a + at, value + 4, 2));
    }
  PetscFunctionReturn(0);
}
