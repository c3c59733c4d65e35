/* The object: bodies, settings, options, what is known of a body. */
#include "bodiesimpl.h"
#include <math.h>

static const char *const coupling_words[]   = {"reactions", "q"};
static const char *const integrator_words[] = {"verlet", "literal"};
static const char *const kind_words[]       = {"rigid", "linear", "finite"};

PetscErrorCode PgBodiesCreate(MPI_Comm comm, PgBodies *bodies)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(bodies));
  (*bodies)->comm = comm;
  PetscFunctionReturn(0);
}

static PetscErrorCode FreeBody(PgBody *b)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(b->cell, b->edge, b->m));
  PetscCall(PetscFree4(b->X, b->x, b->v, b->a));
  PetscCall(PetscFree4(b->force, b->load, b->f, b->way));
  PetscCall(PetscFree(b->in));
  PetscCall(PetscFree(b->N));
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesDestroy(PgBodies *bodies)
{
  PetscFunctionBeginUser;
  if (!*bodies) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < (*bodies)->count; k++) PetscCall(FreeBody(&(*bodies)->body[k]));
  PetscCall(PetscFree((*bodies)->body));
  PetscCall(PetscFree3((*bodies)->particle_force, (*bodies)->surface_x, (*bodies)->surface_p));
  PetscCall(PetscFree(*bodies));
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesSetGravity(PgBodies bodies, const PetscReal gravity[2])
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(bodies->gravity, gravity, 2));
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesSetDamping(PgBodies bodies, PetscReal rate)
{
  PetscFunctionBeginUser;
  PgInputCheck(isfinite(rate) && rate >= 0, bodies->comm, "damping of bodies %g 1/s is negative", (double)rate);
  bodies->damping = rate;
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesSetCoupling(PgBodies bodies, PgBodiesCoupling coupling)
{
  PetscFunctionBeginUser;
  bodies->coupling = coupling;
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesSetIntegrator(PgBodies bodies, PgBodiesIntegrator integrator)
{
  PetscFunctionBeginUser;
  bodies->integrator = integrator;
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesSetFromOptions(PgBodies bodies)
{
  PetscInt coupling = (PetscInt)bodies->coupling, integrator = (PetscInt)bodies->integrator;

  PetscFunctionBeginUser;
  PetscOptionsBegin(bodies->comm, "", "bodies: meshed discrete elements (Tak, Park & Park 2013)", "");
  PetscCall(PgOptionChoice(PetscOptionsObject, "-bodies_coupling",
                           "force of the liquid on a body: reactions of its particles, or Q p of Eqs. 43-46", 2,
                           coupling_words, &coupling, NULL));
  PetscCall(PgOptionChoice(PetscOptionsObject, "-bodies_integrator",
                           "velocity Verlet, or Eqs. 47-50 as printed, which are unstable", 2, integrator_words,
                           &integrator, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-bodies_damping", "damping of bodies in proportion to mass", "1/s", 0.0,
                         1e12, &bodies->damping, NULL));
  PetscOptionsEnd();
  bodies->coupling   = (PgBodiesCoupling)coupling;
  bodies->integrator = (PgBodiesIntegrator)integrator;
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesView(PgBodies bodies, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(viewer, "bodies: %" PetscInt_FMT ", coupling %s, integrator %s, damping %g 1/s\n",
                                   bodies->count, coupling_words[bodies->coupling],
                                   integrator_words[bodies->integrator], (double)bodies->damping));
  for (PetscInt k = 0; k < bodies->count; k++) {
    const PgBody *b = &bodies->body[k];
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "  body %" PetscInt_FMT ": %s, %" PetscInt_FMT " nodes, %" PetscInt_FMT
                                     " cells, %" PetscInt_FMT " particles, mass %g kg/m\n",
                                     k, kind_words[b->kind], b->nodes, b->cells, b->particles, (double)b->mass));
  }
  PetscFunctionReturn(0);
}

/* Sides of cells that no other cell has, in the sense of their cell. */
static void FindSurface(PgBody *b)
{
  b->edges = 0;
  for (PetscInt e = 0; e < b->cells; e++)
    for (int s = 0; s < 4; s++) {
      const PetscInt from = b->cell[4 * e + s], to = b->cell[4 * e + (s + 1) % 4];
      PetscBool      shared = PETSC_FALSE;

      for (PetscInt g = 0; g < b->cells && !shared; g++)
        for (int t = 0; t < 4; t++)
          if (b->cell[4 * g + t] == to && b->cell[4 * g + (t + 1) % 4] == from) shared = PETSC_TRUE;
      if (shared) continue;
      b->edge[2 * b->edges]     = from;
      b->edge[2 * b->edges + 1] = to;
      b->edges++;
    }
}

static PetscErrorCode CheckMesh(PgBodies bodies, const PgBodyMesh *mesh)
{
  PetscFunctionBeginUser;
  PgInputCheck(mesh->nodes >= 4 && mesh->cells >= 1, bodies->comm,
               "a body of %" PetscInt_FMT " nodes and %" PetscInt_FMT " cells", mesh->nodes, mesh->cells);
  PgInputCheck(isfinite(mesh->rho) && mesh->rho > 0, bodies->comm, "density of a body %g kg/m3 is not positive",
               (double)mesh->rho);
  if (mesh->kind != PG_BODY_RIGID)
    PgInputCheck(isfinite(mesh->E) && isfinite(mesh->nu) && mesh->E > 0 && mesh->nu > -1 && mesh->nu < 0.5,
                 bodies->comm,
                 "material of a body: Young's modulus %g Pa must be positive, Poisson's ratio %g between -1 and 0.5",
                 (double)mesh->E, (double)mesh->nu);
  for (PetscInt i = 0; i < 4 * mesh->cells; i++)
    PgInputCheck(mesh->cell[i] >= 0 && mesh->cell[i] < mesh->nodes, bodies->comm,
                 "cell %" PetscInt_FMT " of a body has node %" PetscInt_FMT " of %" PetscInt_FMT, i / 4, mesh->cell[i],
                 mesh->nodes);
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesAdd(PgBodies bodies, const PgBodyMesh *mesh, PetscInt *number)
{
  const PetscInt n = mesh->nodes;
  PetscInt       bad;
  PetscBool      convex;
  PgBody        *b;

  PetscFunctionBeginUser;
  PetscCall(CheckMesh(bodies, mesh));
  if (bodies->count == bodies->room) {
    bodies->room += 8;
    PetscCall(PetscRealloc((size_t)bodies->room * sizeof *bodies->body, &bodies->body));
  }
  b = &bodies->body[bodies->count++];
  PetscCall(PetscMemzero(b, sizeof *b));
  b->kind   = mesh->kind;
  b->nodes  = n;
  b->cells  = mesh->cells;
  b->rho    = mesh->rho;
  b->E      = mesh->E;
  b->nu     = mesh->nu;
  b->lambda = b->E * b->nu / ((1 + b->nu) * (1 - 2 * b->nu));
  b->G      = b->E / (2 * (1 + b->nu));
  PetscCall(PetscCalloc3(4 * b->cells, &b->cell, 8 * b->cells, &b->edge, n, &b->m));
  PetscCall(PetscCalloc4(2 * n, &b->X, 2 * n, &b->x, 2 * n, &b->v, 2 * n, &b->a));
  PetscCall(PetscCalloc4(2 * n, &b->force, 2 * n, &b->load, 2 * n, &b->f, 2 * n, &b->way));
  PetscCall(PetscArraycpy(b->cell, mesh->cell, 4 * b->cells));
  PetscCall(PetscArraycpy(b->X, mesh->x, 2 * n));
  PetscCall(PetscArraycpy(b->x, mesh->x, 2 * n));
  convex = PgBodyPrepare(b, &bad);
  PgInputCheck(convex, bodies->comm, "cell %" PetscInt_FMT " of a body is no convex quadrilateral", bad);
  for (PetscInt i = 0; i < n; i++)
    PgInputCheck(b->m[i] > 0, bodies->comm, "node %" PetscInt_FMT " of a body belongs to no cell", i);
  FindSurface(b);
  if (number) *number = bodies->count - 1;
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesAddBox(PgBodies bodies, const PgBodyMesh *like, const PetscInt cells[2], const PetscReal low[2],
                              const PetscReal high[2], PetscInt *body)
{
  PgBodyMesh mesh = *like;
  PetscReal *x;
  PetscInt  *cell, nx = cells[0], ny = cells[1];

  PetscFunctionBeginUser;
  PgInputCheck(nx >= 1 && ny >= 1, bodies->comm, "a body of %" PetscInt_FMT " by %" PetscInt_FMT " cells", nx, ny);
  PetscCall(PetscMalloc2(2 * (nx + 1) * (ny + 1), &x, 4 * nx * ny, &cell));
  for (PetscInt j = 0; j <= ny; j++)
    for (PetscInt i = 0; i <= nx; i++) {
      PetscReal *at = &x[2 * (j * (nx + 1) + i)];
      at[0]         = low[0] + (high[0] - low[0]) * (PetscReal)i / (PetscReal)nx;
      at[1]         = low[1] + (high[1] - low[1]) * (PetscReal)j / (PetscReal)ny;
    }
  for (PetscInt j = 0; j < ny; j++)
    for (PetscInt i = 0; i < nx; i++) {
      const PetscInt first = j * (nx + 1) + i, of[4] = {first, first + 1, first + nx + 2, first + nx + 1};
      PetscCall(PetscArraycpy(&cell[4 * (j * nx + i)], of, 4));
    }
  mesh.nodes = (nx + 1) * (ny + 1);
  mesh.cells = nx * ny;
  mesh.x     = x;
  mesh.cell  = cell;
  PetscCall(PgBodiesAdd(bodies, &mesh, body));
  PetscCall(PetscFree2(x, cell));
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesSetLoad(PgBodies bodies, PetscInt body, const PetscReal force[])
{
  PgBody *b = &bodies->body[body];

  PetscFunctionBeginUser;
  if (force)
    PetscCall(PetscArraycpy(b->load, force, 2 * b->nodes));
  else
    PetscCall(PetscArrayzero(b->load, 2 * b->nodes));
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesAddTraction(PgBodies bodies, PetscInt body, int d, PetscReal at, const PetscReal traction[2])
{
  PgBody   *b     = &bodies->body[body];
  PetscBool found = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt e = 0; e < b->edges; e++) {
    const PetscInt  i = b->edge[2 * e], j = b->edge[2 * e + 1];
    const PetscReal l = hypot(b->X[2 * j] - b->X[2 * i], b->X[2 * j + 1] - b->X[2 * i + 1]);

    if (PetscAbsReal(b->X[2 * i + d] - at) > 1e-9 * l || PetscAbsReal(b->X[2 * j + d] - at) > 1e-9 * l) continue;
    found = PETSC_TRUE;
    for (int c = 0; c < 2; c++) {
      b->load[2 * i + c] += 0.5 * l * traction[c];
      b->load[2 * j + c] += 0.5 * l * traction[c];
    }
  }
  PgInputCheck(found, bodies->comm, "body %" PetscInt_FMT " has no side at %c = %g m", body, d ? 'y' : 'x', (double)at);
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesSetVelocity(PgBodies bodies, PetscInt body, const PetscReal v[2], PetscReal spin)
{
  PgBody *b = &bodies->body[body];

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(b->v_c, v, 2));
  b->spin = spin;
  if (b->kind == PG_BODY_RIGID) {
    PgBodyMoveNodes(b);
    PetscFunctionReturn(0);
  }
  for (PetscInt i = 0; i < b->nodes; i++) {
    b->v[2 * i]     = v[0] - spin * (b->x[2 * i + 1] - b->X_c[1]);
    b->v[2 * i + 1] = v[1] + spin * (b->x[2 * i] - b->X_c[0]);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesSetState(PgBodies bodies, PetscInt body, const PetscReal u[], const PetscReal v[])
{
  PgBody *b = &bodies->body[body];

  PetscFunctionBeginUser;
  PetscCheck(b->kind != PG_BODY_RIGID, bodies->comm, PETSC_ERR_ARG_WRONG,
             "the nodes of a rigid body do not move alone");
  for (PetscInt i = 0; u && i < 2 * b->nodes; i++) b->x[i] = b->X[i] + u[i];
  if (v) PetscCall(PetscArraycpy(b->v, v, 2 * b->nodes));
  PgBodyInternalForces(b);
  if (bodies->integrator == PG_BODIES_LITERAL)
    for (PetscInt i = 0; i < 2 * b->nodes; i++) b->a[i] = b->f[i] / b->m[i / 2];
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesGetTimeStep(PgBodies bodies, PetscReal *dt)
{
  PetscFunctionBeginUser;
  *dt = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < bodies->count; k++) *dt = PetscMin(*dt, bodies->body[k].limit);
  PetscFunctionReturn(0);
}

static void Sums(const PgBody *b, PgBodyState *s)
{
  for (PetscInt i = 0; i < b->nodes; i++) {
    const PetscReal m = b->m[i], *x = &b->x[2 * i], *v = &b->v[2 * i];
    for (int d = 0; d < 2; d++) {
      s->centre[d] += m * x[d] / b->mass;
      s->velocity[d] += m * v[d] / b->mass;
    }
    s->kinetic += 0.5 * m * (v[0] * v[0] + v[1] * v[1]);
    s->angular += m * (x[0] * v[1] - x[1] * v[0]);
  }
  s->elastic = b->elastic;
}

static void Rigid(const PgBody *b, PgBodyState *s)
{
  for (int d = 0; d < 2; d++) {
    s->centre[d]   = b->X_c[d] + b->u_c[d];
    s->velocity[d] = b->v_c[d];
  }
  s->spin    = b->spin;
  s->angle   = b->angle;
  s->kinetic = 0.5 * b->mass * (b->v_c[0] * b->v_c[0] + b->v_c[1] * b->v_c[1]) + 0.5 * b->inertia * b->spin * b->spin;
  s->angular = b->mass * (s->centre[0] * b->v_c[1] - s->centre[1] * b->v_c[0]) + b->inertia * b->spin;
}

PetscErrorCode PgBodiesGet(PgBodies bodies, PetscInt body, PgBodyState *state)
{
  const PgBody *b = &bodies->body[body];
  PgBodyState   s = {.nodes     = b->nodes,
                     .cells     = b->cells,
                     .particles = b->particles,
                     .edges     = b->edges,
                     .cell      = b->cell,
                     .edge      = b->edge,
                     .X         = b->X,
                     .x         = b->x,
                     .v         = b->v,
                     .force     = b->force,
                     .m         = b->m,
                     .mass      = b->mass,
                     .inertia   = b->inertia};

  PetscFunctionBeginUser;
  if (b->kind == PG_BODY_RIGID)
    Rigid(b, &s);
  else
    Sums(b, &s);
  *state = s;
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesGetCount(PgBodies bodies, PetscInt *count)
{
  PetscFunctionBeginUser;
  *count = bodies->count;
  PetscFunctionReturn(0);
}
