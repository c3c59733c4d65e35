/* The mesh: made or read by PETSc, distributed by it, and then laid out as arrays of this rank. */
#include "femimpl.h"
#include <string.h>

static PetscErrorCode AddBoundary(PgFem fem, PetscInt tag, const char name[])
{
  PgFemBoundary *b;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < fem->boundaries; k++)
    PgInputCheck(strcmp(fem->boundary[k].name, name) != 0, fem->comm,
                 "mesh file '%s': groups %" PetscInt_FMT " and %" PetscInt_FMT " of curves are both named '%s'",
                 fem->file, fem->boundary[k].tag, tag, name);
  PetscCall(PetscRealloc((size_t)(fem->boundaries + 1) * sizeof *fem->boundary, &fem->boundary));
  b = &fem->boundary[fem->boundaries++];
  PetscCall(PetscMemzero(b, sizeof *b));
  b->tag = tag;
  PetscCall(PetscStrncpy(b->name, name, sizeof b->name));
  PetscFunctionReturn(0);
}

static PetscErrorCode AddRegion(PgFem fem, PetscInt tag, const char name[])
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < fem->regions; k++)
    PgInputCheck(strcmp(fem->region_name[k], name) != 0, fem->comm,
                 "mesh file '%s': groups %" PetscInt_FMT " and %" PetscInt_FMT " of surfaces are both named '%s'",
                 fem->file, fem->region_tag[k], tag, name);
  PetscCall(PetscRealloc((size_t)(fem->regions + 1) * sizeof *fem->region_tag, &fem->region_tag));
  PetscCall(PetscRealloc((size_t)(fem->regions + 1) * sizeof *fem->region_name, &fem->region_name));
  fem->region_tag[fem->regions] = tag;
  PetscCall(PetscStrncpy(fem->region_name[fem->regions++], name, PG_FEM_NAME));
  PetscFunctionReturn(0);
}

/* The numbers of a label, as all ranks together have them. */
static PetscErrorCode LabelValues(PgFem fem, const char name[], PetscInt *count, const PetscInt *value[], IS *all)
{
  DMLabel label;
  IS      mine = NULL;

  PetscFunctionBeginUser;
  PetscCall(DMGetLabel(fem->dm, name, &label));
  if (label)
    PetscCall(DMLabelGetValueIS(label, &mine));
  else
    PetscCall(ISCreateGeneral(PETSC_COMM_SELF, 0, NULL, PETSC_COPY_VALUES, &mine));
  {
    PetscInt        n;
    const PetscInt *v;
    IS              distributed;
    PetscCall(ISGetLocalSize(mine, &n));
    PetscCall(ISGetIndices(mine, &v));
    PetscCall(ISCreateGeneral(fem->comm, n, v, PETSC_COPY_VALUES, &distributed));
    PetscCall(ISRestoreIndices(mine, &v));
    PetscCall(ISAllGather(distributed, all));
    PetscCall(ISDestroy(&distributed));
  }
  PetscCall(ISDestroy(&mine));
  PetscCall(ISSortRemoveDups(*all));
  PetscCall(ISGetLocalSize(*all, count));
  PetscCall(ISGetIndices(*all, value));
  PetscFunctionReturn(0);
}

/* Groups that have a name get it, others their number. A name is listed even when the group is empty. */
static PetscErrorCode NameGroups(PgFem fem, const char label[], PetscInt dimension, PetscInt groups,
                                 const PgFemGroup group[], PetscErrorCode (*add)(PgFem, PetscInt, const char[]))
{
  PetscInt        count;
  const PetscInt *value;
  IS              all;

  PetscFunctionBeginUser;
  PetscCall(LabelValues(fem, label, &count, &value, &all));
  for (PetscInt k = 0; k < count; k++) {
    char name[PG_FEM_NAME];
    if (value[k] <= 0) continue; /* in no group */
    (void)PetscSNPrintf(name, sizeof name, "%" PetscInt_FMT, value[k]);
    for (PetscInt g = 0; g < groups; g++)
      if (group[g].dimension == dimension && group[g].tag == value[k])
        PetscCall(PetscStrncpy(name, group[g].name, sizeof name));
    PetscCall(add(fem, value[k], name));
  }
  PetscCall(ISRestoreIndices(all, &value));
  PetscCall(ISDestroy(&all));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeBox(PgFem fem)
{
  static const char *const sides[4] = {"bottom", "right", "top", "left"}; /* in the order of PETSc's Face Sets */
  const PetscReal          low[2] = {0.0, 0.0}, high[2] = {1.0, 1.0};

  PetscFunctionBeginUser;
  PetscCall(DMPlexCreateBoxMesh(fem->comm, 2, PETSC_FALSE, fem->box_cells, low, high, NULL, PETSC_TRUE, &fem->dm));
  for (PetscInt s = 0; s < 4; s++) PetscCall(AddBoundary(fem, s + 1, sides[s]));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeFromFile(PgFem fem)
{
  PetscInt    groups;
  PgFemGroup *group;

  PetscFunctionBeginUser;
  PetscCall(PgFemGmshRead(fem->comm, fem->file, &fem->dm, &groups, &group));
  PetscCall(NameGroups(fem, "Face Sets", 1, groups, group, AddBoundary));
  PetscCall(NameGroups(fem, "Cell Sets", 2, groups, group, AddRegion));
  PetscCall(PetscFree(group));
  PetscFunctionReturn(0);
}

void PgFemLabelName(PetscInt b, char name[32]) { (void)PetscSNPrintf(name, 32, "pg_boundary_%d", (int)b); }

/* A rank may have a vertex of a boundary and none of its edges: each boundary becomes a label that holds vertices,
   too, while the mesh is whole. */
static PetscErrorCode CompleteLabels(PgFem fem)
{
  DMLabel faces;

  PetscFunctionBeginUser;
  PetscCall(DMGetLabel(fem->dm, "Face Sets", &faces));
  for (PetscInt b = 0; b < fem->boundaries; b++) {
    char    name[32];
    DMLabel label;
    IS      points = NULL;
    PgFemLabelName(b, name);
    PetscCall(DMCreateLabel(fem->dm, name));
    PetscCall(DMGetLabel(fem->dm, name, &label));
    if (faces) PetscCall(DMLabelGetStratumIS(faces, fem->boundary[b].tag, &points));
    if (points) {
      PetscInt        count, start, end;
      const PetscInt *point;
      PetscCall(ISGetLocalSize(points, &count));
      PetscCall(ISGetIndices(points, &point));
      PetscCall(DMPlexGetHeightStratum(fem->dm, 1, &start, &end));
      for (PetscInt k = 0; k < count; k++)
        if (point[k] >= start && point[k] < end) PetscCall(DMLabelSetValue(label, point[k], 1));
      PetscCall(ISRestoreIndices(points, &point));
      PetscCall(ISDestroy(&points));
    }
    PetscCall(DMPlexLabelComplete(fem->dm, label));
  }
  PetscFunctionReturn(0);
}

/* Numbers of points before the distribution: the same on any number of ranks. */
static PetscErrorCode NumberPoints(DM dm, PetscSection *section, IS *numbers)
{
  PetscInt start, end, *number;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetChart(dm, &start, &end));
  PetscCall(PetscSectionCreate(PetscObjectComm((PetscObject)dm), section));
  PetscCall(PetscSectionSetChart(*section, start, end));
  for (PetscInt p = start; p < end; p++) PetscCall(PetscSectionSetDof(*section, p, 1));
  PetscCall(PetscSectionSetUp(*section));
  PetscCall(PetscMalloc1(end - start, &number));
  for (PetscInt depth = 0; depth < 3; depth++) {
    PetscInt first, last;
    PetscCall(DMPlexGetDepthStratum(dm, depth, &first, &last));
    for (PetscInt p = first; p < last; p++) number[p - start] = p - first;
  }
  PetscCall(ISCreateGeneral(PetscObjectComm((PetscObject)dm), end - start, number, PETSC_OWN_POINTER, numbers));
  PetscFunctionReturn(0);
}

static PetscErrorCode ChoosePartitioner(PgFem fem)
{
  PetscPartitioner partitioner;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetPartitioner(fem->dm, &partitioner));
  PetscCall(PetscObjectSetOptionsPrefix((PetscObject)partitioner, "up_"));
#if defined(PETSC_HAVE_PTSCOTCH)
  PetscCall(PetscPartitionerSetType(partitioner, PETSCPARTITIONERPTSCOTCH));
#elif defined(PETSC_HAVE_PARMETIS)
  PetscCall(PetscPartitionerSetType(partitioner, PETSCPARTITIONERPARMETIS));
#else
  PetscCall(PetscPartitionerSetType(partitioner, PETSCPARTITIONERSIMPLE));
#endif
  if (fem->from_options) PetscCall(PetscPartitionerSetFromOptions(partitioner));
  PetscFunctionReturn(0);
}

/* Leaves the numbers of this rank's points in `numbers`, by point. */
static PetscErrorCode Distribute(PgFem fem, IS *numbers)
{
  PetscSection before, after;
  PetscSF      moved;
  DM           spread = NULL;
  IS           whole;

  PetscFunctionBeginUser;
  PetscCall(NumberPoints(fem->dm, &before, &whole));
  PetscCall(ChoosePartitioner(fem));
  PetscCall(DMPlexDistribute(fem->dm, 0, &moved, &spread));
  if (!spread) {
    *numbers = whole;
    PetscCall(PetscSectionDestroy(&before));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscSectionCreate(fem->comm, &after));
  PetscCall(DMPlexDistributeFieldIS(fem->dm, moved, before, whole, after, numbers));
  PetscCall(PetscSectionDestroy(&before));
  PetscCall(PetscSectionDestroy(&after));
  PetscCall(ISDestroy(&whole));
  PetscCall(PetscSFDestroy(&moved));
  PetscCall(DMDestroy(&fem->dm));
  fem->dm = spread;
  PetscFunctionReturn(0);
}

/* "a, b, c" for messages. */
static void Names(PetscInt count, const char *(*name)(PgFem, PetscInt), PgFem fem, char list[512])
{
  size_t used = 0;

  list[0] = '\0';
  for (PetscInt k = 0; k < count && used < 480; k++)
    used += (size_t)snprintf(list + used, 512 - used, "%s%s", k ? ", " : "", name(fem, k));
  if (!count) (void)snprintf(list, 512, "none");
}
static const char *BoundaryName(PgFem fem, PetscInt k) { return fem->boundary[k].name; }
static const char *RegionName(PgFem fem, PetscInt k) { return fem->region_name[k]; }

PetscErrorCode PgFemFindBoundary(PgFem fem, const char name[], PetscInt *at)
{
  char list[512];

  PetscFunctionBeginUser;
  *at = -1;
  for (PetscInt b = 0; b < fem->boundaries; b++)
    if (strcmp(fem->boundary[b].name, name) == 0) *at = b;
  Names(fem->boundaries, BoundaryName, fem, list);
  PgInputCheck(*at >= 0, fem->comm, "%s%s%s has no boundary '%s'; its boundaries: %s",
               fem->file[0] ? "mesh file '" : "the rectangle", fem->file, fem->file[0] ? "'" : "", name, list);
  PetscFunctionReturn(0);
}

/* Which material each cell has. */
static PetscErrorCode AssignMaterials(PgFem fem)
{
  DMLabel sets;

  PetscFunctionBeginUser;
  PetscCall(DMGetLabel(fem->dm, "Cell Sets", &sets));
  for (PetscInt c = 0; c < fem->cells; c++) fem->cell_material[c] = 0;
  for (PetscInt m = 1; m < fem->materials; m++) {
    PetscInt region = -1;
    char     list[512];
    for (PetscInt r = 0; r < fem->regions; r++)
      if (strcmp(fem->region_name[r], fem->material[m].name) == 0) region = r;
    Names(fem->regions, RegionName, fem, list);
    PgInputCheck(region >= 0, fem->comm, "%s%s%s has no region '%s'; its regions: %s",
                 fem->file[0] ? "mesh file '" : "the rectangle", fem->file, fem->file[0] ? "'" : "",
                 fem->material[m].name, list);
    for (PetscInt c = 0; sets && c < fem->cells; c++) {
      PetscInt tag;
      PetscCall(DMLabelGetValue(sets, c, &tag));
      if (tag == fem->region_tag[region]) fem->cell_material[c] = m;
    }
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode CountAll(PgFem fem)
{
  PetscInt mine[2] = {0, fem->cells}, all[2];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < fem->nodes; i++) mine[0] += fem->owned[i] ? 1 : 0;
  PetscCallMPI(MPI_Allreduce(mine, all, 2, MPIU_INT, MPI_SUM, fem->comm));
  fem->all_nodes = all[0];
  fem->all_cells = all[1];
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemMeshMake(PgFem fem)
{
  IS              numbers;
  const PetscInt *number;
  PetscInt        first, last;

  PetscFunctionBeginUser;
  if (fem->file[0])
    PetscCall(MakeFromFile(fem));
  else
    PetscCall(MakeBox(fem));
  PetscCall(CompleteLabels(fem));
  PetscCall(Distribute(fem, &numbers));
  PetscCall(DMPlexGetHeightStratum(fem->dm, 0, &first, &last));
  fem->cells = last - first;
  PetscCall(ISGetIndices(numbers, &number));
  PetscCall(PgFemLayOutNodes(fem, number));
  PetscCall(CountAll(fem));
  PetscCall(PgFemLayOutCells(fem, number));
  PetscCall(ISRestoreIndices(numbers, &number));
  PetscCall(ISDestroy(&numbers));
  PetscCall(PgFemLayOutBoundaries(fem));
  PetscCall(AssignMaterials(fem));
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemMeshDestroy(PgFem fem)
{
  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < fem->boundaries; b++) {
    PetscCall(PetscFree2(fem->boundary[b].side, fem->boundary[b].node));
    PetscCall(PetscFree(fem->boundary[b].traction));
  }
  PetscCall(PetscFree(fem->boundary));
  PetscCall(PetscFree(fem->region_tag));
  PetscCall(PetscFree(fem->region_name));
  PetscCall(PetscFree3(fem->x, fem->number, fem->owned));
  PetscCall(PetscFree4(fem->cell_node, fem->cell_edge, fem->cell_number, fem->cell_material));
  PetscCall(DMDestroy(&fem->dm));
  PetscFunctionReturn(0);
}
