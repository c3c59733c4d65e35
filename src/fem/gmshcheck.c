/* Whether the elements of a mesh file make one plane mesh of quadrilaterals, said by the numbers that the file has. */
#include "femimpl.h"
#include <stdio.h>
#include <stdlib.h>

/* A side of a quadrilateral. */
typedef struct {
  long      node[2]; /* the smaller one first */
  long      element;
  PetscBool forward; /* counter-clockwise around its element from the smaller node to the larger one */
} Side;

typedef struct {
  const PgFemGmsh *mesh;
  char            *reason;
  size_t           size;
  long             sides;
  Side            *side;
  long            *piece; /* (elements) an element of the same piece, closer to its root */
} Check;

static long Number(const Check *c, long element) { return c->mesh->element[element].number; }
static long NodeNumber(const Check *c, long node) { return c->mesh->node[node].number; }

/* Sign of the area of a quadrilateral when it is convex, 0 when it is not or is as good as flat. */
static int Orientation(const PgFemGmsh *mesh, const PgFemGmshElement *e)
{
  double least = PETSC_MAX_REAL, most = -PETSC_MAX_REAL;

  for (int k = 0; k < 4; k++) {
    const double *a = mesh->node[e->corner[(k + 3) % 4]].x, *b = mesh->node[e->corner[k]].x,
                 *c   = mesh->node[e->corner[(k + 1) % 4]].x;
    const double turn = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
    least             = PetscMin(least, turn);
    most              = PetscMax(most, turn);
  }
  if (least > 1e-12 * most && least > 0.0) return 1; /* 1e-12: far below any useful cell, far above rounding */
  return most < 1e-12 * least && most < 0.0 ? -1 : 0;
}

/* The element by itself; its sides go to the list. */
static void TakeQuadrilateral(Check *c, long element)
{
  const PgFemGmshElement *e       = &c->mesh->element[element];
  const int               turning = Orientation(c->mesh, e);

  for (int k = 0; k < 4 && !c->reason[0]; k++)
    for (int l = 0; l < k; l++)
      if (e->corner[k] == e->corner[l])
        (void)snprintf(c->reason, c->size, "element %ld has node %ld twice", e->number, NodeNumber(c, e->corner[k]));
  if (!turning && !c->reason[0]) {
    double x[2] = {0.0, 0.0};
    for (int k = 0; k < 4; k++)
      for (int d = 0; d < 2; d++) x[d] += 0.25 * c->mesh->node[e->corner[k]].x[d];
    (void)snprintf(c->reason, c->size, "element %ld, the cell at (%g, %g), is not a convex quadrilateral", e->number,
                   x[0], x[1]);
  }
  for (int k = 0; k < 4; k++) {
    const long a = e->corner[k], b = e->corner[(k + 1) % 4];
    c->side[c->sides++] = (Side){{PetscMin(a, b), PetscMax(a, b)}, element, (PetscBool)((a < b) == (turning > 0))};
  }
}

static int BySide(const void *a, const void *b)
{
  const Side *s = (const Side *)a, *t = (const Side *)b;

  for (int k = 0; k < 2; k++)
    if (s->node[k] != t->node[k]) return s->node[k] < t->node[k] ? -1 : 1;
  if (s->forward != t->forward) return s->forward ? 1 : -1;
  return (s->element > t->element) - (s->element < t->element);
}

static PetscBool Same(const Side *a, const Side *b)
{
  return (PetscBool)(a->node[0] == b->node[0] && a->node[1] == b->node[1]);
}

static long Root(Check *c, long element)
{
  while (c->piece[element] != element) {
    c->piece[element] = c->piece[c->piece[element]];
    element           = c->piece[element];
  }
  return element;
}

/* Two quadrilaterals share a side, and run along it in opposite directions; or one of three lies on another. */
static void CheckSides(Check *c)
{
  qsort(c->side, (size_t)c->sides, sizeof *c->side, BySide);
  for (long k = 1; k < c->sides && !c->reason[0]; k++) {
    const Side *s = &c->side[k - 1], *t = &c->side[k];
    if (!Same(s, t)) continue;
    if (s->forward == t->forward)
      (void)snprintf(c->reason, c->size, "elements %ld and %ld lie on each other at the side between nodes %ld and %ld",
                     Number(c, s->element), Number(c, t->element), NodeNumber(c, s->node[0]),
                     NodeNumber(c, s->node[1]));
    c->piece[Root(c, s->element)] = Root(c, t->element);
  }
}

/* All in one piece, hanging together by sides. */
static void CheckPieces(Check *c)
{
  long first = -1;

  for (long e = 0; e < c->mesh->elements && !c->reason[0]; e++) {
    if (c->mesh->element[e].corners != 4) continue;
    if (first < 0) first = e;
    if (Root(c, e) != Root(c, first))
      (void)snprintf(c->reason, c->size,
                     "it is in pieces: no chain of cells with common sides leads from element %ld to element %ld",
                     Number(c, first), Number(c, e));
  }
}

static void CheckLines(Check *c)
{
  for (long e = 0; e < c->mesh->elements && !c->reason[0]; e++) {
    const PgFemGmshElement *line = &c->mesh->element[e];
    const long              a = line->corner[0], b = line->corner[1];
    const Side              key = {{PetscMin(a, b), PetscMax(a, b)}, -1, PETSC_FALSE}; /* before all others there */
    long                    low = 0, high = c->sides;
    if (line->corners != 2) continue;
    while (low < high) { /* the first side that is not before the key */
      const long middle = low + (high - low) / 2;
      if (BySide(&c->side[middle], &key) < 0)
        low = middle + 1;
      else
        high = middle;
    }
    if (low == c->sides || !Same(&c->side[low], &key))
      (void)snprintf(c->reason, c->size, "element %ld, the line between nodes %ld and %ld, is no side of a cell",
                     line->number, NodeNumber(c, a), NodeNumber(c, b));
  }
}

/* All in the plane z = 0 but for rounding. */
static void CheckPlane(Check *c)
{
  double extent = 0.0;

  for (long k = 0; k < c->mesh->nodes; k++)
    for (int d = 0; d < 2; d++) extent = PetscMax(extent, PetscAbsReal(c->mesh->node[k].x[d] - c->mesh->node[0].x[d]));
  for (long k = 0; k < c->mesh->nodes && !c->reason[0]; k++)
    if (PetscAbsReal(c->mesh->node[k].x[2]) > 1e-9 * extent)
      (void)snprintf(c->reason, c->size, "node %ld lies at z = %g, out of the plane z = 0", NodeNumber(c, k),
                     c->mesh->node[k].x[2]);
}

PetscErrorCode PgFemGmshCheck(const PgFemGmsh *mesh, char reason[], size_t size)
{
  Check c = {.mesh = mesh, .reason = reason, .size = size};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(4 * mesh->elements, &c.side, mesh->elements, &c.piece));
  CheckPlane(&c);
  for (long e = 0; e < mesh->elements && !reason[0]; e++) {
    c.piece[e] = e;
    if (mesh->element[e].corners == 3)
      (void)snprintf(reason, size, "element %ld is a triangle, not a quadrilateral (in Gmsh: Recombine Surface)",
                     mesh->element[e].number);
    if (mesh->element[e].corners == 4) TakeQuadrilateral(&c, e);
  }
  if (!reason[0] && !c.sides) (void)snprintf(reason, size, "it has no quadrilaterals");
  if (!reason[0]) CheckSides(&c);
  if (!reason[0]) CheckPieces(&c);
  if (!reason[0]) CheckLines(&c);
  PetscCall(PetscFree2(c.side, c.piece));
  PetscFunctionReturn(0);
}
