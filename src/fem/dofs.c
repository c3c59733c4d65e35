/* Unknowns: a PetscSection of field 0, displacement, and field 1, pressure, on the points of the mesh. */
#include "femimpl.h"

static PetscErrorCode MakeSection(PgFem fem)
{
  const PetscBool high = (PetscBool)(fem->element == PG_FEM_Q2Q1);
  PetscInt        start, end, first, last;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetChart(fem->dm, &start, &end));
  PetscCall(DMPlexGetDepthStratum(fem->dm, 0, &first, &last));
  PetscCall(PetscSectionCreate(fem->comm, &fem->section));
  PetscCall(PetscSectionSetNumFields(fem->section, 2));
  PetscCall(PetscSectionSetFieldName(fem->section, 0, "u"));
  PetscCall(PetscSectionSetFieldName(fem->section, 1, "p"));
  PetscCall(PetscSectionSetFieldComponents(fem->section, 0, 2));
  PetscCall(PetscSectionSetChart(fem->section, start, end));
  for (PetscInt p = start; p < end; p++) {
    const PetscBool vertex = (PetscBool)(p >= first && p < last);
    if (!vertex && !high) continue;
    PetscCall(PetscSectionSetDof(fem->section, p, vertex ? 3 : 2));
    PetscCall(PetscSectionSetFieldDof(fem->section, p, 0, 2));
    if (vertex) PetscCall(PetscSectionSetFieldDof(fem->section, p, 1, 1));
  }
  PetscCall(PetscSectionSetUp(fem->section));
  PetscCall(PetscSectionGetStorageSize(fem->section, &fem->size));
  PetscCall(DMSetLocalSection(fem->dm, fem->section));
  PetscFunctionReturn(0);
}

/* Numbers in the system: those of points of other ranks are kept as -(number + 1) by PETSc. */
static PetscErrorCode NumberUnknowns(PgFem fem)
{
  PetscSection all;
  PetscInt     start, end, first, last;

  PetscFunctionBeginUser;
  PetscCall(DMGetGlobalSection(fem->dm, &all));
  PetscCall(PetscSectionGetConstrainedStorageSize(all, &fem->mine));
  PetscCall(DMPlexGetChart(fem->dm, &start, &end));
  PetscCall(DMPlexGetDepthStratum(fem->dm, 0, &first, &last));
  PetscCall(PetscMalloc1(fem->size, &fem->global));
  PetscCall(PetscCalloc2(fem->size, &fem->is_pressure, fem->size, &fem->fixed));
  for (PetscInt p = start; p < end; p++) {
    PetscInt count, at, number;
    PetscCall(PetscSectionGetDof(fem->section, p, &count));
    PetscCall(PetscSectionGetOffset(fem->section, p, &at));
    PetscCall(PetscSectionGetOffset(all, p, &number));
    for (PetscInt k = 0; k < count; k++) {
      fem->global[at + k]      = (number < 0 ? -(number + 1) : number) + k;
      fem->is_pressure[at + k] = (PetscBool)(k == 2);
    }
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode NumberCells(PgFem fem)
{
  PetscInt first_node, first_edge;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepthStratum(fem->dm, 0, &first_node, NULL));
  PetscCall(DMPlexGetHeightStratum(fem->dm, 1, &first_edge, NULL));
  /* one more: whether there is an array says whether all is set up, on a rank without cells, too */
  PetscCall(PetscMalloc2(fem->cells * fem->dofs + 1, &fem->dof, fem->cells * fem->dofs + 1, &fem->index));
  for (PetscInt c = 0; c < fem->cells; c++) {
    PetscInt *dof = fem->dof + c * fem->dofs, at;
    for (PetscInt a = 0; a < fem->un; a++) {
      const PetscInt point = a < 4   ? first_node + fem->cell_node[4 * c + a]
                             : a < 8 ? first_edge + fem->cell_edge[4 * c + a - 4]
                                     : c;
      PetscCall(PetscSectionGetOffset(fem->section, point, &at));
      dof[2 * a]     = at;
      dof[2 * a + 1] = at + 1;
      if (a < 4) dof[2 * fem->un + a] = at + 2;
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemDofsMake(PgFem fem)
{
  PetscFunctionBeginUser;
  fem->un   = fem->element == PG_FEM_Q2Q1 ? 9 : 4;
  fem->dofs = 2 * fem->un + 4;
  PgFemShapeMake(fem->element, &fem->shape);
  PetscCall(MakeSection(fem));
  PetscCall(NumberUnknowns(fem));
  PetscCall(NumberCells(fem));
  PetscCall(PgFemConditionsMark(fem));
  for (PetscInt k = 0; k < fem->cells * fem->dofs; k++)
    fem->index[k] = fem->fixed[fem->dof[k]] ? -1 : fem->global[fem->dof[k]];
  for (PetscInt m = 0; m < fem->plates; m++) { /* slaves count for their master */
    const PgFemPlate *plate = &fem->plate[m];
    PetscBool        *slave;
    PetscCall(PetscCalloc1(fem->size, &slave));
    for (PetscInt k = 0; k < plate->count; k++) slave[plate->slave[k]] = PETSC_TRUE;
    for (PetscInt k = 0; k < fem->cells * fem->dofs; k++)
      if (slave[fem->dof[k]]) fem->index[k] = plate->master_global;
    PetscCall(PetscFree(slave));
  }
  PetscCall(PetscCalloc5(fem->size, &fem->u, fem->size, &fem->v, fem->size, &fem->a, fem->size, &fem->next, fem->size,
                         &fem->load));
  PetscCall(PetscCalloc3(2 * fem->nodes, &fem->out_u, 2 * fem->nodes, &fem->out_v, fem->nodes, &fem->out_p));
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemDofsDestroy(PgFem fem)
{
  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < fem->plates; m++) PetscCall(PetscFree(fem->plate[m].slave));
  PetscCall(PetscFree(fem->plate));
  PetscCall(PetscFree(fem->global));
  PetscCall(PetscFree2(fem->is_pressure, fem->fixed));
  PetscCall(PetscFree2(fem->dof, fem->index));
  PetscCall(PetscFree5(fem->u, fem->v, fem->a, fem->next, fem->load));
  PetscCall(PetscFree3(fem->out_u, fem->out_v, fem->out_p));
  PetscCall(PetscFree(fem->force));
  PetscCall(PetscSectionDestroy(&fem->section));
  PetscFunctionReturn(0);
}
