/* What is said of boundaries: held values, plates, and whether they hold the whole. Loads: loads.c. */
#include "femimpl.h"

PetscErrorCode PgFemConditionsResolve(PgFem fem)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < fem->conditions; k++)
    PetscCall(PgFemFindBoundary(fem, fem->condition[k].boundary, &fem->condition[k].at));
  PetscFunctionReturn(0);
}

/* Calls act for every unknown of one kind on a boundary: component 0, 1 of displacement, 2: pressure. x is its place. */
typedef PetscErrorCode (*Act)(PgFem fem, PetscInt dof, const PetscReal x[2], void *context);

static PetscErrorCode ForBoundary(PgFem fem, const PgFemBoundary *b, PetscInt component, Act act, void *context)
{
  IS              points;
  PetscInt        count, first, last;
  const PetscInt *point;

  PetscFunctionBeginUser;
  PetscCall(DMLabelGetStratumIS(b->label, 1, &points));
  if (!points) PetscFunctionReturn(0);
  PetscCall(DMPlexGetDepthStratum(fem->dm, 0, &first, &last));
  PetscCall(ISGetLocalSize(points, &count));
  PetscCall(ISGetIndices(points, &point));
  for (PetscInt k = 0; k < count; k++) {
    PetscInt  unknowns, at;
    PetscReal x[2];
    PetscCall(PetscSectionGetDof(fem->section, point[k], &unknowns));
    if (component >= unknowns) continue;
    PetscCall(PetscSectionGetOffset(fem->section, point[k], &at));
    if (point[k] >= first && point[k] < last) {
      for (int d = 0; d < 2; d++) x[d] = fem->x[2 * (point[k] - first) + d];
    } else { /* an edge: its middle */
      const PetscInt *end;
      PetscCall(DMPlexGetCone(fem->dm, point[k], &end));
      for (int d = 0; d < 2; d++) x[d] = 0.5 * (fem->x[2 * (end[0] - first) + d] + fem->x[2 * (end[1] - first) + d]);
    }
    PetscCall(act(fem, at + component, x, context));
  }
  PetscCall(ISRestoreIndices(points, &point));
  PetscCall(ISDestroy(&points));
  PetscFunctionReturn(0);
}

PetscInt PgFemComponent(PgFemQuantity quantity)
{
  switch (quantity) {
  case PG_FEM_DISPLACEMENT_X:
  case PG_FEM_PLATE_X:
    return 0;
  case PG_FEM_DISPLACEMENT_Y:
  case PG_FEM_PLATE_Y:
    return 1;
  case PG_FEM_PRESSURE:
    return 2;
  default:
    return -1;
  }
}

static PetscBool IsPlate(PgFemQuantity quantity)
{
  return (PetscBool)(quantity == PG_FEM_PLATE_X || quantity == PG_FEM_PLATE_Y);
}

void PgFemConditionValue(const PgFemCondition *condition, PetscReal time, const PetscReal x[2], PetscReal value[2])
{
  value[0] = condition->value[0];
  value[1] = condition->value[1];
  if (condition->function) condition->function(condition->context, time, x, value);
}

/* ---- held values ---- */

static PetscErrorCode Fix(PgFem fem, PetscInt dof, const PetscReal x[2], void *context)
{
  PetscFunctionBeginUser;
  (void)x;
  (void)context;
  fem->fixed[dof] = PETSC_TRUE;
  PetscFunctionReturn(0);
}

typedef struct {
  const PgFemCondition *condition;
  PetscReal             time, *value;
} Prescription;

static PetscErrorCode Prescribe(PgFem fem, PetscInt dof, const PetscReal x[2], void *context)
{
  const Prescription *p = (const Prescription *)context;
  PetscReal           value[2];

  PetscFunctionBeginUser;
  (void)fem;
  PgFemConditionValue(p->condition, p->time, x, value);
  p->value[dof] = value[0];
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemPrescribe(PgFem fem, PetscReal time, PetscReal value[])
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < fem->conditions; k++) {
    const PgFemCondition *condition = &fem->condition[k];
    Prescription          p         = {condition, time, value};
    const PetscInt        component = PgFemComponent(condition->quantity);
    if (component < 0 || IsPlate(condition->quantity)) continue;
    PetscCall(ForBoundary(fem, &fem->boundary[condition->at], component, Prescribe, &p));
  }
  PetscFunctionReturn(0);
}

/* ---- plates ---- */

static PetscErrorCode Enslave(PgFem fem, PetscInt dof, const PetscReal x[2], void *context)
{
  PgFemPlate *plate = (PgFemPlate *)context;

  PetscFunctionBeginUser;
  (void)fem;
  (void)x;
  if (dof != plate->master_local) {
    PetscCall(PetscRealloc((size_t)(plate->count + 1) * sizeof *plate->slave, &plate->slave));
    plate->slave[plate->count++] = dof;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode CountFixed(PgFem fem, PetscInt dof, const PetscReal x[2], void *context)
{
  PetscFunctionBeginUser;
  (void)x;
  if (fem->fixed[dof]) (*(PetscInt *)context)++;
  PetscFunctionReturn(0);
}

/* The vertex with the smallest number leads; its owner has the row of the plate. */
static PetscErrorCode ChooseMaster(PgFem fem, const PgFemBoundary *b, PgFemPlate *plate)
{
  PetscInt least = PETSC_MAX_INT, node = -1, first, last, mine[2] = {-1, -1}, all[2];

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepthStratum(fem->dm, 0, &first, &last));
  for (PetscInt i = 0; i < fem->nodes; i++) {
    PetscInt in;
    PetscCall(DMLabelGetValue(b->label, first + i, &in));
    if (in == 1 && fem->number[i] < least) {
      least = fem->number[i];
      node  = i;
    }
  }
  PetscCallMPI(MPI_Allreduce(&least, &mine[0], 1, MPIU_INT, MPI_MIN, fem->comm));
  plate->master_local = -1;
  if (node >= 0 && least == mine[0]) {
    PetscCall(PetscSectionGetOffset(fem->section, first + node, &plate->master_local));
    plate->master_local += plate->component;
  }
  mine[0] = mine[1] = -1;
  if (plate->master_local >= 0 && fem->owned[node]) {
    mine[0] = fem->global[plate->master_local];
    mine[1] = fem->rank;
  }
  PetscCallMPI(MPI_Allreduce(mine, all, 2, MPIU_INT, MPI_MAX, fem->comm));
  plate->master_global = all[0];
  plate->owner         = all[1];
  PetscFunctionReturn(0);
}

static PetscErrorCode AddPlate(PgFem fem, PetscInt condition)
{
  const PgFemBoundary *b     = &fem->boundary[fem->condition[condition].at];
  PgFemPlate          *plate = &fem->plate[fem->plates++];
  PetscInt             held  = 0, all;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(plate, sizeof *plate));
  plate->condition = condition;
  plate->component = PgFemComponent(fem->condition[condition].quantity);
  PetscCall(ForBoundary(fem, b, plate->component, CountFixed, &held));
  PetscCallMPI(MPI_Allreduce(&held, &all, 1, MPIU_INT, MPI_SUM, fem->comm));
  PgInputCheck(all == 0, fem->comm,
               "boundary '%s' is under a plate that moves along %c, but other conditions hold nodes of it along %c",
               b->name, 'x' + (int)plate->component, 'x' + (int)plate->component);
  PetscCall(ChooseMaster(fem, b, plate));
  PgInputCheck(plate->master_global >= 0, fem->comm, "boundary '%s' is under a plate but has no nodes", b->name);
  PetscCall(ForBoundary(fem, b, plate->component, Enslave, plate));
  for (PetscInt k = 0; k < plate->count; k++) fem->fixed[plate->slave[k]] = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemConditionsMark(PgFem fem)
{
  PetscInt plates = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < fem->conditions; k++) {
    const PgFemCondition *condition = &fem->condition[k];
    const PetscInt        component = PgFemComponent(condition->quantity);
    if (IsPlate(condition->quantity))
      plates++;
    else if (component >= 0)
      PetscCall(ForBoundary(fem, &fem->boundary[condition->at], component, Fix, NULL));
  }
  if (fem->element == PG_FEM_Q1)
    for (PetscInt d = 0; d < fem->size; d++)
      if (fem->is_pressure[d]) fem->fixed[d] = PETSC_TRUE;
  PetscCall(PetscMalloc1(plates, &fem->plate));
  for (PetscInt k = 0; k < fem->conditions; k++)
    if (IsPlate(fem->condition[k].quantity)) PetscCall(AddPlate(fem, k));
  PetscFunctionReturn(0);
}

/* ---- whether anything holds the whole ---- */

typedef struct {
  PetscReal centre[2], length, gram[9];
  PetscInt  component;
  PetscReal master; /* plate: what turning moves the master by, over length */
  PetscBool plate;
} Holding;

/* Motions without strain: along x, along y, turning; their values at an unknown. */
static PetscErrorCode Hold(PgFem fem, PetscInt dof, const PetscReal x[2], void *context)
{
  Holding  *h    = (Holding *)context;
  PetscReal m[3] = {h->component == 0, h->component == 1, 0.0};

  PetscFunctionBeginUser;
  (void)fem;
  (void)dof;
  m[2] = (h->component == 0 ? -(x[1] - h->centre[1]) : x[0] - h->centre[0]) / h->length;
  if (h->plate) { /* all nodes under it move alike */
    m[0] = m[1] = 0.0;
    m[2] -= h->master;
  }
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) h->gram[3 * i + j] += m[i] * m[j];
  PetscFunctionReturn(0);
}

static PetscErrorCode Extent(PgFem fem, Holding *h)
{
  PetscReal mine[4] = {PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MAX_REAL}, all[4];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < fem->nodes; i++)
    for (int d = 0; d < 2; d++) {
      mine[d]     = PetscMin(mine[d], fem->x[2 * i + d]);
      mine[2 + d] = PetscMin(mine[2 + d], -fem->x[2 * i + d]);
    }
  PetscCallMPI(MPI_Allreduce(mine, all, 4, MPIU_REAL, MPIU_MIN, fem->comm));
  for (int d = 0; d < 2; d++) h->centre[d] = 0.5 * (all[d] - all[2 + d]);
  h->length = PetscMax(-all[2] - all[0], -all[3] - all[1]);
  PetscFunctionReturn(0);
}

/* Smallest pivot over the largest entry of a matrix that is a sum of squares. */
static PetscReal SmallestPivot(PetscReal a[9])
{
  PetscReal largest = PetscMax(a[0], PetscMax(a[4], a[8])), least = largest;

  for (int step = 0; step < 3; step++) {
    int       k     = -1;
    PetscReal pivot = -1.0;
    for (int i = 0; i < 3; i++)
      if (a[4 * i] > pivot) {
        pivot = a[4 * i];
        k     = i;
      }
    least = PetscMin(least, pivot);
    if (pivot <= 0.0 || k < 0) return 0.0;
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        if (i != k && j != k) a[3 * i + j] -= a[3 * i + k] * a[3 * k + j] / pivot;
    a[4 * k] = -1.0; /* done */
  }
  return least / largest;
}

PetscErrorCode PgFemCheckHeld(PgFem fem)
{
  Holding   h = {.component = 0};
  PetscReal all[9];

  PetscFunctionBeginUser;
  if (fem->inertia) PetscFunctionReturn(0);
  PetscCall(Extent(fem, &h));
  for (PetscInt k = 0; k < fem->conditions; k++) {
    const PgFemCondition *condition = &fem->condition[k];
    h.component                     = PgFemComponent(condition->quantity);
    h.plate                         = IsPlate(condition->quantity);
    if (h.component < 0 || h.component == 2) continue;
    if (h.plate) { /* against the node of smallest number, on the rank that has it */
      PetscReal mine = -PETSC_MAX_REAL;
      for (PetscInt m = 0; m < fem->plates; m++) {
        const PgFemPlate *plate = &fem->plate[m];
        if (plate->condition != k || plate->master_local < 0) continue;
        for (PetscInt i = 0; i < 4 * fem->cells; i++) {
          const PetscInt c = i / 4, a = i % 4;
          if (fem->dof[c * fem->dofs + 2 * a + plate->component] != plate->master_local) continue;
          mine = (h.component == 0 ? -(fem->x[2 * fem->cell_node[i] + 1] - h.centre[1])
                                   : fem->x[2 * fem->cell_node[i]] - h.centre[0]) /
                 h.length;
        }
      }
      PetscCallMPI(MPI_Allreduce(&mine, &h.master, 1, MPIU_REAL, MPIU_MAX, fem->comm));
    }
    PetscCall(ForBoundary(fem, &fem->boundary[condition->at], h.component, Hold, &h));
  }
  PetscCallMPI(MPI_Allreduce(h.gram, all, 9, MPIU_REAL, MPIU_SUM, fem->comm));
  {
    const PetscReal x = all[0], y = all[4];
    PgInputCheck(SmallestPivot(all) > 1e-12, fem->comm,
                 "nothing keeps the continuum from %s: prescribe displacements on a boundary, or switch inertia on "
                 "(-up_inertia)",
                 x <= 0.0   ? "moving along x"
                 : y <= 0.0 ? "moving along y"
                            : "turning");
  }
  PetscFunctionReturn(0);
}
