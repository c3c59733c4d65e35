/* Loads on boundaries: tractions, normal stresses, water that leaves, forces on plates and nodes. */
#include "femimpl.h"

/* A piece of a boundary with what its integrals need. */
typedef struct {
  const PetscReal *x0, *x1; /* ends [m] */
  PetscReal        length, normal[2];
  PetscInt         first, second, middle; /* nodes of the cell: at the ends, and on the edge; middle -1: none */
  const PetscInt  *dof;                   /* unknowns of the cell */
} Piece;

static void PieceOf(const PgFem fem, const PgFemBoundary *b, PetscInt k, Piece *piece)
{
  const PgFemSide  side = b->side[k];
  const PetscReal *x0 = &fem->x[2 * b->node[2 * k]], *x1 = &fem->x[2 * b->node[2 * k + 1]];
  const PetscReal  d[2] = {x1[0] - x0[0], x1[1] - x0[1]}, length = PetscSqrtReal(d[0] * d[0] + d[1] * d[1]);

  *piece = (Piece){.x0     = x0,
                   .x1     = x1,
                   .length = length,
                   .normal = {d[1] / length, -d[0] / length},
                   .first  = side.side,
                   .second = (side.side + 1) % 4,
                   .middle = fem->un == 9 ? 4 + side.side : -1,
                   .dof    = fem->dof + side.cell * fem->dofs};
}

/* Shortens from..to, parts of the piece's length, to what lies between low and high along one direction. */
static void Shorten(PetscReal a, PetscReal b, PetscReal low, PetscReal high, PetscReal *from, PetscReal *to)
{
  if (PetscMax(a, b) < low || PetscMin(a, b) > high) {
    *to = *from;
    return;
  }
  /* the bound lies between a and b where it is divided by their distance */
  if (a < low) *from = PetscMax(*from, (low - a) / (b - a));
  if (a > high) *from = PetscMax(*from, (high - a) / (b - a));
  if (b < low) *to = PetscMin(*to, (low - a) / (b - a));
  if (b > high) *to = PetscMin(*to, (high - a) / (b - a));
}

static void Add(const PgFem fem, const Piece *piece, PetscReal s, PetscReal ds, const PetscReal traction[2],
                PetscReal water, PetscReal load[])
{
  const PetscReal N[2] = {1.0 - s, s}, bubble = piece->middle < 0 ? 0.0 : 4.0 * s * (1.0 - s);
  const PetscInt  v[2] = {piece->first, piece->second};
  const PetscInt *dof  = piece->dof;

  for (int i = 0; i < 2; i++) {
    for (int e = 0; e < 2; e++) load[dof[2 * v[e] + i]] += ds * traction[i] * (N[e] - 0.5 * bubble);
    if (piece->middle >= 0) load[dof[2 * piece->middle + i]] += ds * traction[i] * bubble;
  }
  for (int e = 0; e < 2; e++) load[dof[2 * fem->un + v[e]]] += ds * water * N[e] * fem->scale;
}

static const PetscReal point[3]  = {0.5 - 0.5 * 0.774596669241483377, 0.5, 0.5 + 0.5 * 0.774596669241483377};
static const PetscReal weight[3] = {5. / 18., 8. / 18., 5. / 18.};

/* One condition on the part of the piece that it is meant for: to its very end, which may lie inside a cell. */
static void AddCondition(const PgFem fem, const PgFemCondition *condition, const Piece *piece, PetscReal time,
                         PetscReal dt, PetscReal load[])
{
  PetscReal from = 0.0, to = 1.0;

  for (int d = 0; condition->within && d < 2; d++)
    Shorten(piece->x0[d], piece->x1[d], condition->low[d], condition->high[d], &from, &to);
  for (int q = 0; q < 3 && to > from; q++) {
    const PetscReal s = from + (to - from) * point[q], ds = (to - from) * weight[q] * piece->length;
    const PetscReal x[2] = {(1.0 - s) * piece->x0[0] + s * piece->x1[0], (1.0 - s) * piece->x0[1] + s * piece->x1[1]};
    PetscReal       value[2], traction[2] = {0.0, 0.0}, water = 0.0;
    PgFemConditionValue(condition, time, x, value);
    for (int d = 0; d < 2; d++) {
      if (condition->quantity == PG_FEM_TRACTION) traction[d] = value[d];
      if (condition->quantity == PG_FEM_NORMAL_STRESS) traction[d] = value[0] * piece->normal[d];
    }
    if (condition->quantity == PG_FEM_FLUX) water = value[0] * dt;
    Add(fem, piece, s, ds, traction, water, load);
  }
}

static void AddBoundary(const PgFem fem, PetscInt boundary, PetscReal time, PetscReal time_flux, PetscReal dt,
                        PetscReal load[])
{
  const PgFemBoundary *b = &fem->boundary[boundary];

  for (PetscInt k = 0; k < b->count; k++) {
    Piece piece;
    PieceOf(fem, b, k, &piece);
    for (PetscInt c = 0; c < fem->conditions; c++) {
      const PgFemCondition *condition = &fem->condition[c];
      if (condition->at != boundary || PgFemComponent(condition->quantity) >= 0) continue;
      AddCondition(fem, condition, &piece, condition->quantity == PG_FEM_FLUX ? time_flux : time, dt, load);
    }
    for (int q = 0; q < 3 && b->traction; q++)
      Add(fem, &piece, point[q], weight[q] * piece.length, &b->traction[2 * k], 0.0, load);
  }
}

PetscErrorCode PgFemAddLoads(PgFem fem, PetscReal time, PetscReal time_flux, PetscReal dt, PetscReal load[])
{
  PetscInt first, last;

  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < fem->boundaries; b++) {
    PetscBool any = (PetscBool)(fem->boundary[b].traction != NULL);
    for (PetscInt k = 0; k < fem->conditions; k++)
      if (fem->condition[k].at == b && PgFemComponent(fem->condition[k].quantity) < 0) any = PETSC_TRUE;
    if (any) AddBoundary(fem, b, time, time_flux, dt, load);
  }
  for (PetscInt m = 0; m < fem->plates; m++) {
    const PgFemPlate *plate = &fem->plate[m];
    const PetscReal   x[2]  = {0.0, 0.0};
    PetscReal         value[2];
    if (plate->owner != fem->rank) continue;
    PgFemConditionValue(&fem->condition[plate->condition], time, x, value);
    load[plate->master_local] += value[0];
  }
  if (fem->force) {
    PetscCall(DMPlexGetDepthStratum(fem->dm, 0, &first, &last));
    for (PetscInt i = 0; i < fem->nodes; i++) {
      PetscInt at;
      PetscCall(PetscSectionGetOffset(fem->section, first + i, &at));
      for (int d = 0; d < 2; d++) load[at + d] += fem->force[2 * i + d];
    }
  }
  PetscFunctionReturn(0);
}
