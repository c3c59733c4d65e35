/* A look at a mesh file of Gmsh in text form before PETSc reads it: PETSc 3.18 takes the numbers in it on trust, and a cell
   with a node that is not there ends in a segmentation fault. Formats as in Gmsh's reference manual, MSH 2.2, 4.0, 4.1. */
#include "femimpl.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LINE = 4096, NUMBERS = 64 };

typedef struct {
  FILE  *stream;
  char  *reason;
  size_t size;
  int    words;                   /* of the line before */
  long   line, nodes, room, most; /* most: bytes of the file, more of anything cannot be in it */
  long  *node;
} Scan;

static PetscBool Bad(Scan *s, const char what[])
{
  if (!s->reason[0]) (void)snprintf(s->reason, s->size, "line %ld: %s", s->line, what);
  return PETSC_TRUE;
}

/* The numbers of the next line, as far as they are whole; their count, -1: there is no such line. */
static int Next(Scan *s, long number[NUMBERS])
{
  char text[LINE], *at = text, *end;
  int  count = 0;

  if (!fgets(text, sizeof text, s->stream)) return -1;
  s->line++;
  s->words = 0;
  for (const char *c = text; *c; c++)
    if (!strchr(" \t\r\n", *c) && (c == text || strchr(" \t\r\n", c[-1]))) s->words++;
  for (; count < NUMBERS; count++, at = end) {
    number[count] = strtol(at, &end, 10);
    if (end == at || (*end && !strchr(" \t\r\n", *end))) break;
  }
  return count;
}

static PetscBool Find(Scan *s, const char section[])
{
  char text[LINE];

  while (fgets(text, sizeof text, s->stream)) {
    s->line++;
    if (strncmp(text, section, strlen(section)) == 0) return PETSC_TRUE;
  }
  (void)snprintf(s->reason, s->size, "it has no %s", section);
  return PETSC_FALSE;
}

static PetscBool AddNode(Scan *s, long number)
{
  if (number <= 0) return Bad(s, "the number of a node must be > 0");
  if (s->nodes == s->room) return Bad(s, "more nodes than were said");
  s->node[s->nodes++] = number;
  return PETSC_FALSE;
}

static int Ascending(const void *a, const void *b)
{
  const long x = *(const long *)a, y = *(const long *)b;
  return (x > y) - (x < y);
}

/* `count` lines of "number x y z" (four words), or of a number alone. */
static PetscBool TakeNodes(Scan *s, long count, int words)
{
  long number[NUMBERS];

  if (count < 0 || count > s->most) return Bad(s, "no such number of nodes can be in the file");
  for (long k = 0; k < count; k++)
    if (Next(s, number) < 1 || s->words != words || AddNode(s, number[0])) return Bad(s, "not a node");
  return PETSC_FALSE;
}

static PetscErrorCode ScanNodes(Scan *s, int version)
{
  long number[NUMBERS], blocks = 1;

  PetscFunctionBeginUser;
  if (!Find(s, "$Nodes")) PetscFunctionReturn(0);
  if (Next(s, number) < (version == 22 ? 1 : 2)) number[0] = number[1] = -1;
  s->room = number[version == 22 ? 0 : 1];
  if (version != 22) blocks = number[0];
  if (s->room < 1 || s->room > s->most || blocks < 1 || blocks > s->most) {
    (void)Bad(s, "no such number of nodes can be in the file");
    PetscFunctionReturn(0);
  }
  PetscCall(PetscMalloc1(s->room, &s->node));
  for (long b = 0; b < blocks && !s->reason[0]; b++) {
    long count = s->room;
    if (version != 22) {
      if (Next(s, number) < 4) (void)Bad(s, "not the head of a block of nodes");
      count = number[3];
    }
    if (s->reason[0] || TakeNodes(s, count, version == 41 ? 1 : 4)) break;
    for (long k = 0; version == 41 && k < count; k++) /* coordinates come after the numbers */
      if (Next(s, number) < 0 || s->words != 3) (void)Bad(s, "not a place of a node");
  }
  if (!s->reason[0] && s->nodes != s->room) (void)Bad(s, "fewer nodes than were said");
  qsort(s->node, (size_t)s->nodes, sizeof *s->node, Ascending);
  for (long k = 1; k < s->nodes; k++)
    if (s->node[k] == s->node[k - 1] && !s->reason[0])
      (void)snprintf(s->reason, s->size, "node %ld stands twice", s->node[k]);
  PetscFunctionReturn(0);
}

/* Corners of the kinds of elements that a plane mesh may have, 0: none of them. */
static int Corners(long type) { return type == 15 ? 1 : type == 1 ? 2 : type == 2 ? 3 : type == 3 ? 4 : 0; }

static PetscBool TakeElement(Scan *s, const long node[], int count)
{
  for (int k = 0; k < count; k++)
    if (!s->nodes || !bsearch(&node[k], s->node, (size_t)s->nodes, sizeof *s->node, Ascending)) {
      if (!s->reason[0]) (void)snprintf(s->reason, s->size, "line %ld: there is no node %ld", s->line, node[k]);
      return PETSC_TRUE;
    }
  return PETSC_FALSE;
}

static void ScanElements(Scan *s, int version)
{
  long number[NUMBERS], count, blocks = 1, type = 0;

  if (!Find(s, "$Elements")) return;
  if (Next(s, number) < 1) number[0] = -1;
  count = number[0];
  if (version != 22) blocks = number[0];
  if (count < 1 || count > s->most) (void)Bad(s, "no such number of elements can be in the file");
  for (long b = 0; b < blocks && !s->reason[0]; b++) {
    if (version != 22) {
      if (Next(s, number) < 4) (void)Bad(s, "not the head of a block of elements");
      count = number[3];
      type  = number[2];
    }
    if (count < 0 || count > s->most) (void)Bad(s, "no such number of elements can be in the file");
    for (long k = 0; k < count && !s->reason[0]; k++) {
      const int found = Next(s, number);
      int       first = 1;
      if (version == 22) {
        type  = found > 2 ? number[1] : 0;
        first = found > 2 && number[2] >= 0 && number[2] < NUMBERS ? 3 + (int)number[2] : NUMBERS;
      }
      if (!Corners(type))
        (void)Bad(s, "an element that is no point, line, triangle or quadrilateral of the first order");
      else if (found != first + Corners(type))
        (void)Bad(s, "not an element of its type");
      else
        (void)TakeElement(s, number + first, Corners(type));
    }
  }
}

PetscErrorCode PgFemGmshCheck(const char file[], char reason[], size_t size)
{
  Scan   s = {.reason = reason, .size = size};
  double version;
  int    binary;
  char   text[LINE];

  PetscFunctionBeginUser;
  s.stream = fopen(file, "rb");
  if (!s.stream) PetscFunctionReturn(0); /* told elsewhere */
  (void)fseek(s.stream, 0, SEEK_END);
  s.most = ftell(s.stream);
  rewind(s.stream);
  (void)Find(&s, "$MeshFormat");
  if (!fgets(text, sizeof text, s.stream) || sscanf(text, "%lf %d", &version, &binary) != 2)
    (void)Bad(&s, "no version of a mesh of Gmsh");
  else {
    const int known = version == 2.2 ? 22 : version == 4.0 ? 40 : version == 4.1 ? 41 : 0;
    s.line++;
    if (!known) (void)snprintf(reason, size, "MSH version %g is not one of 2.2, 4.0, 4.1", version);
    if (known && !binary) {
      PetscCall(ScanNodes(&s, known));
      if (!reason[0]) ScanElements(&s, known);
    }
  }
  (void)fclose(s.stream);
  PetscCall(PetscFree(s.node));
  PetscFunctionReturn(0);
}
