/* The object: settings, set-up, and what it shows of its state. */
#include "femimpl.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

PetscErrorCode PgFemCreate(MPI_Comm comm, PgFem *out)
{
  PgFem fem;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&fem));
  fem->comm = comm;
  PetscCallMPI(MPI_Comm_rank(comm, &fem->rank));
  PetscCallMPI(MPI_Comm_size(comm, &fem->ranks));
  fem->box_cells[0] = fem->box_cells[1] = 10;
  fem->box_high[0] = fem->box_high[1] = 1.0;
  fem->stabilisation                  = 3.0;
  fem->theta                          = 1.0;
  fem->error_if_not_converged         = PETSC_TRUE;
  PetscCall(PetscCalloc1(1, &fem->material));
  fem->materials     = 1;
  fem->material->set = PETSC_TRUE;
  PgFemMaterialDefault(&fem->material->material);
  *out = fem;
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemDestroy(PgFem *fem)
{
  PetscFunctionBeginUser;
  if (!*fem) PetscFunctionReturn(0);
  PetscCall(PgFemKeptDestroy(*fem));
  PetscCall(PgFemOutputDestroy(*fem));
  PetscCall(PgFemSystemDestroy(*fem));
  PetscCall(PgFemDofsDestroy(*fem));
  PetscCall(PgFemMeshDestroy(*fem));
  PetscCall(PetscFree((*fem)->material));
  PetscCall(PetscFree((*fem)->condition));
  PetscCall(PetscFree(*fem));
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSetBox(PgFem fem, const PetscInt cells[2], const PetscReal low[2], const PetscReal high[2])
{
  PetscFunctionBeginUser;
  for (int d = 0; d < 2; d++) {
    PgInputCheck(cells[d] > 0, fem->comm, "up: %" PetscInt_FMT " cells along %c, there must be 1 at least", cells[d],
                 'x' + d);
    PgInputCheck(low[d] < high[d] && isfinite(low[d]) && isfinite(high[d]), fem->comm,
                 "up: a rectangle from %g m to %g m along %c", (double)low[d], (double)high[d], 'x' + d);
    fem->box_cells[d] = cells[d];
    fem->box_low[d]   = low[d];
    fem->box_high[d]  = high[d];
  }
  fem->file[0] = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSetMeshFile(PgFem fem, const char file[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(fem->file, file, sizeof fem->file));
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSetMap(PgFem fem, PgFemMap map, void *context)
{
  PetscFunctionBeginUser;
  fem->map         = map;
  fem->map_context = context;
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSetElement(PgFem fem, PgFemElement element)
{
  PetscFunctionBeginUser;
  fem->element = element;
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSetStabilisation(PgFem fem, PetscReal factor)
{
  PetscFunctionBeginUser;
  PgInputCheck(factor >= 0.0 && isfinite(factor), fem->comm, "up: stabilisation %g, it must be >= 0", (double)factor);
  fem->stabilisation = factor;
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSetTheta(PgFem fem, PetscReal theta, PetscInt start)
{
  PetscFunctionBeginUser;
  PgInputCheck(theta >= 0.5 && theta <= 1.0, fem->comm,
               "up: theta is %g, it must be between 0.5 and 1 (below 0.5 steps "
               "grow without bound)",
               (double)theta);
  fem->theta       = theta;
  fem->start_steps = start;
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSetInertia(PgFem fem, PetscBool inertia, PetscReal damping)
{
  PetscFunctionBeginUser;
  PgInputCheck(damping >= 0.0 && isfinite(damping), fem->comm, "up: damping %g 1/s, it must be >= 0", (double)damping);
  fem->inertia = inertia;
  fem->damping = damping;
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSetGravity(PgFem fem, const PetscReal gravity[2])
{
  PetscFunctionBeginUser;
  fem->gravity[0] = gravity[0];
  fem->gravity[1] = gravity[1];
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSetErrorIfNotConverged(PgFem fem, PetscBool error)
{
  PetscFunctionBeginUser;
  fem->error_if_not_converged = error;
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSetMaterial(PgFem fem, const char region[], const PgFemMaterial *material)
{
  PetscInt m = 0;
  char     where[PG_FEM_NAME + 32];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(where, sizeof where, region ? "material of region '%s'" : "material", region));
  PetscCall(PgFemMaterialCheck(fem->comm, where, material));
  if (region)
    for (m = 1; m < fem->materials; m++)
      if (strcmp(fem->material[m].name, region) == 0) break;
  if (m == fem->materials) {
    PetscCall(PetscRealloc((size_t)(m + 1) * sizeof *fem->material, &fem->material));
    PetscCall(PetscMemzero(&fem->material[m], sizeof *fem->material));
    PetscCall(PetscStrncpy(fem->material[m].name, region, PG_FEM_NAME));
    fem->materials++;
  }
  fem->material[m].material = *material;
  fem->material[m].set      = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemGetMaterial(PgFem fem, PgFemMaterial *material)
{
  PetscFunctionBeginUser;
  *material = fem->material[0].material;
  PetscFunctionReturn(0);
}

static PetscErrorCode AddCondition(PgFem fem, const char boundary[], PgFemQuantity quantity, PgFemCondition **condition)
{
  PetscFunctionBeginUser;
  PetscCheck(!fem->dm, fem->comm, PETSC_ERR_ORDER, "conditions come before PgFemSetUp()");
  PetscCall(PetscRealloc((size_t)(fem->conditions + 1) * sizeof *fem->condition, &fem->condition));
  *condition = &fem->condition[fem->conditions++];
  PetscCall(PetscMemzero(*condition, sizeof **condition));
  PetscCall(PetscStrncpy((*condition)->boundary, boundary, PG_FEM_NAME));
  (*condition)->quantity = quantity;
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSetCondition(PgFem fem, const char boundary[], PgFemQuantity quantity, const PetscReal value[])
{
  PgFemCondition *condition = NULL;

  PetscFunctionBeginUser;
  PetscCall(AddCondition(fem, boundary, quantity, &condition));
  condition->value[0] = value[0];
  if (quantity == PG_FEM_TRACTION) condition->value[1] = value[1];
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSetConditionFunction(PgFem fem, const char boundary[], PgFemQuantity quantity,
                                         PgFemFunction function, void *context)
{
  PgFemCondition *condition = NULL;

  PetscFunctionBeginUser;
  PetscCall(AddCondition(fem, boundary, quantity, &condition));
  condition->function = function;
  condition->context  = context;
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSetLoadWithin(PgFem fem, const char boundary[], PgFemQuantity quantity, const PetscReal low[2],
                                  const PetscReal high[2], const PetscReal value[])
{
  PgFemCondition *condition;

  PetscFunctionBeginUser;
  PetscCheck(PgFemComponent(quantity) < 0, fem->comm, PETSC_ERR_ARG_WRONG,
             "only tractions, normal stresses and fluxes act on a part of a boundary");
  PgInputCheck(low[0] < high[0] && low[1] < high[1], fem->comm,
               "up: a load within (%g, %g) and (%g, %g) m: the first corner must be the lower left one", (double)low[0],
               (double)low[1], (double)high[0], (double)high[1]);
  PetscCall(PgFemSetCondition(fem, boundary, quantity, value));
  condition         = &fem->condition[fem->conditions - 1];
  condition->within = PETSC_TRUE;
  for (int d = 0; d < 2; d++) {
    condition->low[d]  = low[d];
    condition->high[d] = high[d];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSetInitial(PgFem fem, void (*initial)(void *, const PetscReal[2], PetscReal[3]), void *context)
{
  PetscFunctionBeginUser;
  fem->initial         = initial;
  fem->initial_context = context;
  PetscFunctionReturn(0);
}

/* Values at the nodes of every cell; those that cells share come out the same. */
static PetscErrorCode StartState(PgFem fem)
{
  static const PetscReal node[9][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, -1}, {1, 0}, {0, 1}, {-1, 0}, {0, 0}};

  PetscFunctionBeginUser;
  if (!fem->initial) PetscFunctionReturn(0);
  for (PetscInt c = 0; c < fem->cells; c++) {
    PetscReal vertex[4][2];
    PgFemCellX(fem, c, vertex);
    for (PetscInt a = 0; a < fem->un; a++) {
      PetscReal x[2] = {0.0, 0.0}, value[3] = {0.0, 0.0, 0.0};
      for (int v = 0; v < 4; v++)
        for (int d = 0; d < 2; d++)
          x[d] += 0.25 * (1.0 + node[v][0] * node[a][0]) * (1.0 + node[v][1] * node[a][1]) * vertex[v][d];
      fem->initial(fem->initial_context, x, value);
      for (int d = 0; d < 2; d++) fem->u[fem->dof[c * fem->dofs + 2 * a + d]] = value[d];
      if (a < 4) fem->u[fem->dof[c * fem->dofs + 2 * fem->un + a]] = value[2];
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSetUp(PgFem fem)
{
  PetscFunctionBeginUser;
  if (fem->dof) PetscFunctionReturn(0);
  PetscCall(PgFemMeshMake(fem));
  PetscCall(PgFemConditionsResolve(fem));
  PetscCall(PgFemDofsMake(fem));
  PetscCall(PgFemCheckHeld(fem));
  PetscCall(StartState(fem));
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemView(PgFem fem, PetscViewer viewer)
{
  static const char *const elements[] = {"Q1-Q1", "Q2-Q1", "Q1, undrained"};
  const PgFemMaterial     *m          = &fem->material[0].material;
  char                     line[512]; /* PETSc would print 3 as "3." */

  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(viewer, "up: %" PetscInt_FMT " nodes, %" PetscInt_FMT " elements %s of %s%s",
                                   fem->all_nodes, fem->all_cells, elements[fem->element],
                                   fem->file[0] ? "mesh file " : "the rectangle", fem->file));
  (void)snprintf(line, sizeof line, ", pressure projection %g/M", (double)fem->stabilisation);
  PetscCall(PetscViewerASCIIPrintf(viewer, "%s; boundaries", fem->element == PG_FEM_Q1Q1 ? line : ""));
  for (PetscInt b = 0; b < fem->boundaries; b++)
    PetscCall(PetscViewerASCIIPrintf(viewer, " %s", fem->boundary[b].name));
  (void)snprintf(
      line, sizeof line,
      "E %g Pa, nu %g, alpha %g, K_s %g Pa, K_f %g Pa, n %g, k %g m2, mu_f %g Pa s, rho_s %g, rho_f %g kg/m3",
      (double)m->E, (double)m->nu, (double)m->alpha, (double)m->K_s, (double)m->K_f, (double)m->n, (double)m->k,
      (double)m->mu_f, (double)m->rho_s, (double)m->rho_f);
  PetscCall(PetscViewerASCIIPrintf(viewer, "\nup: %s\n", line));
  (void)snprintf(line, sizeof line, "M %g Pa, storage %g 1/Pa, c_v %g m2/s; theta %g",
                 (double)PgFemConstrainedModulus(m), (double)PgFemStorage(m), (double)PgFemConsolidation(m),
                 (double)fem->theta);
  PetscCall(PetscViewerASCIIPrintf(viewer, "up: %s", line));
  if (fem->start_steps)
    PetscCall(PetscViewerASCIIPrintf(viewer, " (1 in the first %" PetscInt_FMT " steps)", fem->start_steps));
  (void)snprintf(line, sizeof line, "; inertia, damping %g 1/s", (double)fem->damping);
  PetscCall(PetscViewerASCIIPrintf(viewer, "%s\n", fem->inertia ? line : ""));
  PetscFunctionReturn(0);
}

/* ---- loads from elsewhere ---- */

PetscErrorCode PgFemGetEdges(PgFem fem, const char boundary[], PgFemEdges *edges)
{
  PetscInt b;

  PetscFunctionBeginUser;
  PetscCall(PgFemFindBoundary(fem, boundary, &b));
  edges->count = fem->boundary[b].count;
  edges->node  = fem->boundary[b].node;
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSetEdgeTraction(PgFem fem, const char boundary[], const PetscReal traction[])
{
  PetscInt       at;
  PgFemBoundary *b;

  PetscFunctionBeginUser;
  PetscCall(PgFemFindBoundary(fem, boundary, &at));
  b = &fem->boundary[at];
  if (!b->traction) PetscCall(PetscMalloc1(2 * b->count, &b->traction));
  PetscCall(PetscArraycpy(b->traction, traction, 2 * b->count));
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSetNodalForces(PgFem fem, const PetscReal force[])
{
  PetscFunctionBeginUser;
  if (!fem->force) PetscCall(PetscMalloc1(2 * fem->nodes, &fem->force));
  PetscCall(PetscArraycpy(fem->force, force, 2 * fem->nodes));
  PetscFunctionReturn(0);
}

/* ---- state ---- */

PetscErrorCode PgFemGetStats(PgFem fem, PgFemStats *stats)
{
  PetscFunctionBeginUser;
  *stats = fem->stats;
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemGetTime(PgFem fem, PetscInt *step, PetscReal *time)
{
  PetscFunctionBeginUser;
  if (step) *step = fem->step;
  if (time) *time = fem->time;
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemGetSizes(PgFem fem, PetscInt *nodes, PetscInt *cells)
{
  PetscFunctionBeginUser;
  if (nodes) *nodes = fem->all_nodes;
  if (cells) *cells = fem->all_cells;
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemGetNodes(PgFem fem, PgFemNodes *nodes)
{
  PetscInt first;

  PetscFunctionBeginUser;
  PetscCall(DMPlexGetDepthStratum(fem->dm, 0, &first, NULL));
  for (PetscInt i = 0; i < fem->nodes; i++) {
    PetscInt at;
    PetscCall(PetscSectionGetOffset(fem->section, first + i, &at));
    for (int d = 0; d < 2; d++) {
      fem->out_u[2 * i + d] = fem->u[at + d];
      fem->out_v[2 * i + d] = fem->v[at + d];
    }
    fem->out_p[i] = fem->u[at + 2];
  }
  *nodes = (PgFemNodes){fem->nodes, fem->number, fem->owned, fem->x, fem->out_u, fem->out_v, fem->out_p};
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemGetPlate(PgFem fem, const char boundary[], PetscReal *displacement)
{
  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < fem->plates; m++)
    if (strcmp(fem->condition[fem->plate[m].condition].boundary, boundary) == 0) {
      *displacement = fem->plate[m].displacement;
      PetscFunctionReturn(0);
    }
  SETERRQ(fem->comm, PETSC_ERR_ARG_WRONG, "there is no plate on boundary %s", boundary);
}

/* What a cell's solution says at one of its points. */
static void PointOf(PgFem fem, PetscInt cell, const PgFemCoefficients *c, PetscInt q, const PgFemAt *at,
                    PgFemPoint *point)
{
  const PetscInt *dof  = fem->dof + cell * fem->dofs;
  PetscReal       e[3] = {0}, grad[2] = {0};

  *point = (PgFemPoint){.x = {at->x[0], at->x[1]}, .dV = at->dV, .cell = cell};
  for (PetscInt a = 0; a < fem->un; a++) {
    const PetscReal u[2] = {fem->u[dof[2 * a]], fem->u[dof[2 * a + 1]]}, *g = at->dU[a];
    e[0] += g[0] * u[0];
    e[1] += g[1] * u[1];
    e[2] += g[1] * u[0] + g[0] * u[1];
    for (int d = 0; d < 2; d++) point->displacement[d] += fem->shape.U[q][a] * u[d];
  }
  for (int a = 0; a < 4; a++) {
    const PetscReal p = fem->u[dof[2 * fem->un + a]];
    point->pressure += fem->shape.N[q][a] * p;
    for (int d = 0; d < 2; d++) grad[d] += at->dN[a][d] * p;
  }
  point->volumetric_strain = e[0] + e[1];
  {
    const PgFemMaterial *m      = &fem->material[fem->cell_material[cell]].material;
    const PetscReal      lambda = PgFemConstrainedModulus(m) - 2.0 * c->G;
    if (fem->element == PG_FEM_Q1) point->pressure = -m->alpha * (e[0] + e[1]) / c->S;
    point->stress[0] = lambda * (e[0] + e[1]) + 2.0 * c->G * e[0];
    point->stress[1] = lambda * (e[0] + e[1]) + 2.0 * c->G * e[1];
    point->stress[2] = c->G * e[2];
  }
  for (int d = 0; d < 2 && fem->element != PG_FEM_Q1; d++)
    point->flux[d] = c->D * (-grad[d] + c->rho_f * fem->gravity[d]);
}

PetscErrorCode PgFemIntegrate(PgFem fem, PetscInt count, void (*integrand)(void *, const PgFemPoint *, PetscReal[]),
                              void *context, PetscReal result[])
{
  PetscReal *value, *sum;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(count, &value, count, &sum));
  for (PetscInt cell = 0; cell < fem->cells; cell++) {
    PgFemCoefficients c;
    PetscReal         x[4][2];
    PetscCall(PgFemCoefficientsOf(fem, cell, 1.0, 1.0, &c));
    PgFemCellX(fem, cell, x);
    for (PetscInt q = 0; q < fem->shape.points; q++) {
      PgFemAt    at;
      PgFemPoint point;
      PgFemAtPoint(&fem->shape, fem->un, q, x, &at);
      PointOf(fem, cell, &c, q, &at, &point);
      integrand(context, &point, value);
      for (PetscInt k = 0; k < count; k++) sum[k] += at.dV * value[k];
    }
  }
  if (count) PetscCallMPI(MPI_Allreduce(sum, result, (PetscMPIInt)count, MPIU_REAL, MPIU_SUM, fem->comm));
  PetscCall(PetscFree2(value, sum));
  PetscFunctionReturn(0);
}
