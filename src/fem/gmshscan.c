/* Nodes and elements of a mesh file of Gmsh, text or binary, before PETSc reads it: PETSc 3.18 takes the numbers in it on
   trust, and a node or an entity that is not there ends in a segmentation fault. Formats as in Gmsh's reference manual,
   MSH 2.2, 4.0, 4.1. */
#include "femimpl.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LINE = 4096, WORDS = 128 };

typedef struct {
  FILE       *stream;
  PgFemGmsh  *mesh;
  char       *reason;
  size_t      size;
  int         version; /* 22, 40, 41 */
  PetscBool   binary;
  long        line, most; /* most: bytes of the file, more of anything cannot be in it */
  long        room, elements_room;
  char        text[LINE];
  const char *word[WORDS];
  int         words;
  long        entities, (*entity)[2]; /* dimension, tag */
} Scan;

/* What is wrong, and in which line where there are lines. */
static PetscBool Bad(Scan *s, const char what[])
{
  if (s->reason[0]) return PETSC_TRUE;
  if (s->binary)
    (void)snprintf(s->reason, s->size, "%s", what);
  else
    (void)snprintf(s->reason, s->size, "line %ld: %s", s->line, what);
  return PETSC_TRUE;
}

static PetscBool BadNumber(Scan *s, const char format[], long number)
{
  char what[128];

  (void)snprintf(what, sizeof what, format, number);
  return Bad(s, what);
}

/* The next line as words; PETSC_TRUE: there is none. */
static PetscBool NextLine(Scan *s)
{
  char *rest = NULL;

  s->words = 0;
  if (!fgets(s->text, sizeof s->text, s->stream)) return PETSC_TRUE;
  s->line++;
  for (char *w = strtok_r(s->text, " \t\r\n", &rest); w && s->words < WORDS; w = strtok_r(NULL, " \t\r\n", &rest))
    s->word[s->words++] = w;
  return PETSC_FALSE;
}

static PetscBool Whole(const char word[], long *number)
{
  char *end;

  *number = strtol(word, &end, 10);
  return (PetscBool)(end == word || *end);
}

static PetscBool Real(const char word[], double *number)
{
  char *end;

  *number = strtod(word, &end);
  return (PetscBool)(end == word || *end);
}

/* Numbers of these kinds: i and l whole, of 4 and 8 bytes, into `whole`; d into `real`. In text they are one line, and
   nothing else is on it. PETSC_TRUE: they are not there. */
static PetscBool Take(Scan *s, const char kinds[], long whole[], double real[])
{
  const int count = (int)strlen(kinds);

  if (!s->binary && (NextLine(s) || s->words != count)) return PETSC_TRUE;
  for (int k = 0; k < count; k++) {
    PetscBool bad;
    if (!s->binary) {
      bad = kinds[k] == 'd' ? Real(s->word[k], real++) : Whole(s->word[k], whole++);
    } else if (kinds[k] == 'd') {
      bad = (PetscBool)(fread(real++, 8, 1, s->stream) != 1);
    } else {
      int32_t small = 0;
      int64_t large = 0;
      bad = (PetscBool)(kinds[k] == 'i' ? fread(&small, 4, 1, s->stream) != 1 : fread(&large, 8, 1, s->stream) != 1);
      *whole++ = kinds[k] == 'i' ? (long)small : (long)large;
    }
    if (bad) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static PetscBool Find(Scan *s, const char section[])
{
  char text[LINE];

  while (fgets(text, sizeof text, s->stream)) {
    s->line++;
    if (strncmp(text, section, strlen(section)) == 0) return PETSC_FALSE;
  }
  if (!s->reason[0]) (void)snprintf(s->reason, s->size, "it has no %s", section);
  return PETSC_TRUE;
}

/* The number of a section's entries; it stands in a line of its own in MSH 2.2, in binary files, too. */
static PetscBool Head(Scan *s, const char kinds[], long number[])
{
  const PetscBool binary = s->binary;
  PetscBool       bad;

  if (s->version == 22) s->binary = PETSC_FALSE;
  bad       = Take(s, kinds, number, NULL);
  s->binary = binary;
  return bad;
}

/* ---- entities: what blocks of MSH 4 refer to ---- */

/* One entity: its number, its box, its physical groups and its boundary. */
static PetscBool TakeEntity(Scan *s, long dimension)
{
  const char *head = dimension == 0 && s->version == 41 ? "iddd" : "idddddd";
  long        tag  = 0, count, skipped;
  double      box[6];

  if (!s->binary) {
    if (NextLine(s) || s->words < (int)strlen(head) + 1 || Whole(s->word[0], &tag)) return Bad(s, "not an entity");
  } else {
    if (Take(s, head, &tag, box)) return Bad(s, "$Entities ends too early");
    for (int list = 0; list < (dimension ? 2 : 1); list++) { /* groups; boundary */
      if (Take(s, "l", &count, NULL) || count < 0 || count > s->most) return Bad(s, "$Entities ends too early");
      for (long k = 0; k < count; k++)
        if (Take(s, "i", &skipped, NULL)) return Bad(s, "$Entities ends too early");
    }
  }
  s->entity[s->entities][0]   = dimension;
  s->entity[s->entities++][1] = tag;
  return PETSC_FALSE;
}

static PetscErrorCode ScanEntities(Scan *s)
{
  long count[4] = {0, 0, 0, 0}, all = 0;

  PetscFunctionBeginUser;
  if (s->version == 22 || Find(s, "$Entities")) PetscFunctionReturn(0);
  if (Take(s, "llll", count, NULL)) (void)Bad(s, "not four numbers of entities");
  for (int d = 0; d < 4 && !s->reason[0]; d++) {
    if (count[d] < 0 || count[d] > s->most) (void)Bad(s, "no such number of entities can be in the file");
    all += count[d];
  }
  if (s->reason[0]) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(all, &s->entity));
  for (int d = 0; d < 4; d++)
    for (long k = 0; k < count[d]; k++)
      if (TakeEntity(s, d)) PetscFunctionReturn(0);
  PetscFunctionReturn(0);
}

/* The first two numbers of a block of MSH 4 are an entity; 4.0 has its tag first. */
static PetscBool CheckEntity(Scan *s, const long head[2])
{
  const long dimension = head[s->version == 40 ? 1 : 0], tag = head[s->version == 40 ? 0 : 1];

  for (long k = 0; k < s->entities; k++)
    if (s->entity[k][0] == dimension && s->entity[k][1] == tag) return PETSC_FALSE;
  return BadNumber(s, "a block is on entity %ld, which $Entities does not have", tag);
}

/* ---- nodes ---- */

static PetscBool AddNode(Scan *s, long number)
{
  if (number <= 0) return Bad(s, "the number of a node must be > 0");
  if (s->mesh->nodes == s->room) return Bad(s, "more nodes than were said");
  s->mesh->node[s->mesh->nodes++].number = number;
  return PETSC_FALSE;
}

static PetscBool Place(Scan *s, PgFemGmshNode *node)
{
  for (int d = 0; d < 3; d++)
    if (!isfinite(node->x[d])) return BadNumber(s, "the place of node %ld is not finite", node->number);
  return PETSC_FALSE;
}

/* `count` nodes; those of MSH 4.1 have all their numbers first. */
static PetscBool TakeNodes(Scan *s, long count)
{
  const long first = s->mesh->nodes;
  long       number;
  double     x[3];

  if (count < 0 || count > s->most) return Bad(s, "no such number of nodes can be in the file");
  for (long k = 0; k < count; k++) {
    if (Take(s, s->version == 41 ? "l" : "iddd", &number, x)) return Bad(s, "not a node");
    if (AddNode(s, number)) return PETSC_TRUE;
    if (s->version == 41) continue;
    memcpy(s->mesh->node[first + k].x, x, sizeof x);
    if (Place(s, &s->mesh->node[first + k])) return PETSC_TRUE;
  }
  for (long k = 0; s->version == 41 && k < count; k++)
    if (Take(s, "ddd", NULL, s->mesh->node[first + k].x))
      return Bad(s, "not a place of a node");
    else if (Place(s, &s->mesh->node[first + k]))
      return PETSC_TRUE;
  return PETSC_FALSE;
}

static int Ascending(const void *a, const void *b)
{
  const long x = ((const PgFemGmshNode *)a)->number, y = ((const PgFemGmshNode *)b)->number;
  return (x > y) - (x < y);
}

static PetscErrorCode ScanNodes(Scan *s)
{
  PgFemGmsh *mesh      = s->mesh;
  long       number[4] = {-1, -1, -1, -1}, blocks = 1;

  PetscFunctionBeginUser;
  if (Find(s, "$Nodes")) PetscFunctionReturn(0);
  if (Head(s, s->version == 22 ? "i" : s->version == 40 ? "ll" : "llll", number)) number[0] = number[1] = -1;
  s->room = number[s->version == 22 ? 0 : 1];
  if (s->version != 22) blocks = number[0];
  if (s->room < 1 || s->room > s->most || blocks < 1 || blocks > s->most) {
    (void)Bad(s, "no such number of nodes can be in the file");
    PetscFunctionReturn(0);
  }
  PetscCall(PetscCalloc1(s->room, &mesh->node));
  for (long b = 0; b < blocks && !s->reason[0]; b++) {
    long count = s->room;
    if (s->version != 22) {
      if (Take(s, "iiil", number, NULL)) {
        (void)Bad(s, "not the head of a block of nodes");
        break;
      }
      count = number[3];
      (void)CheckEntity(s, number);
      if (number[2]) (void)Bad(s, "parametric nodes are not known here");
    }
    if (s->reason[0] || TakeNodes(s, count)) break;
  }
  if (!s->reason[0] && mesh->nodes != s->room) (void)Bad(s, "fewer nodes than were said");
  qsort(mesh->node, (size_t)mesh->nodes, sizeof *mesh->node, Ascending);
  for (long k = 1; k < mesh->nodes && !s->reason[0]; k++)
    if (mesh->node[k].number == mesh->node[k - 1].number)
      (void)snprintf(s->reason, s->size, "node %ld stands twice", mesh->node[k].number);
  PetscFunctionReturn(0);
}

/* ---- elements ---- */

/* Corners of the kinds of elements that a plane mesh may have, 0: none of them. */
static int Corners(long type) { return type == 15 ? 1 : type == 1 ? 2 : type == 2 ? 3 : type == 3 ? 4 : 0; }

static PetscErrorCode AddElement(Scan *s, long number, long type, const long corner[])
{
  PgFemGmsh        *mesh = s->mesh;
  PgFemGmshElement *e;

  PetscFunctionBeginUser;
  if (mesh->elements == s->elements_room) {
    s->elements_room = 2 * s->elements_room + 1024;
    PetscCall(PetscRealloc((size_t)s->elements_room * sizeof *mesh->element, &mesh->element));
  }
  e          = &mesh->element[mesh->elements++];
  e->number  = number;
  e->corners = Corners(type);
  for (int k = 0; k < e->corners; k++) {
    const PgFemGmshNode  key  = {.number = corner[k]};
    const PgFemGmshNode *node = (const PgFemGmshNode *)bsearch(&key, mesh->node, (size_t)mesh->nodes,
                                                               sizeof *mesh->node, Ascending);
    if (!node) {
      char what[128];
      (void)snprintf(what, sizeof what, "element %ld: there is no node %ld", number, corner[k]);
      (void)Bad(s, what);
      PetscFunctionReturn(0);
    }
    e->corner[k] = (long)(node - mesh->node);
  }
  PetscFunctionReturn(0);
}

/* The rest of an element of a block: its number and its nodes behind so many tags. */
static PetscErrorCode TakeElement(Scan *s, long type, long tags)
{
  static const char fours[] = "iiiiiiiiiiiiiiii", eights[] = "llllllllllllllll";
  const int         count = 1 + (int)tags + Corners(type), all = (int)sizeof fours - 1;
  long              number[sizeof fours];

  PetscFunctionBeginUser;
  if (!Corners(type)) {
    (void)Bad(s, "an element that is no point, line, triangle or quadrilateral of the first order");
    PetscFunctionReturn(0);
  }
  if (tags < 0 || count > all || Take(s, (s->version == 41 ? eights : fours) + all - count, number, NULL)) {
    (void)Bad(s, s->binary ? "its elements end too early" : "not an element of its type");
    PetscFunctionReturn(0);
  }
  PetscCall(AddElement(s, number[0], type, number + 1 + tags));
  PetscFunctionReturn(0);
}

/* A line of MSH 2.2: number, type, tags and nodes. */
static PetscErrorCode TakeElementLine(Scan *s)
{
  long number[WORDS];

  PetscFunctionBeginUser;
  (void)NextLine(s);
  for (int k = 0; k < s->words; k++)
    if (Whole(s->word[k], &number[k])) s->words = 0;
  if (s->words > 2 && !Corners(number[1]))
    (void)Bad(s, "an element that is no point, line, triangle or quadrilateral of the first order");
  else if (s->words < 4 || number[2] < 0 || number[2] > WORDS || s->words != 3 + number[2] + Corners(number[1]))
    (void)Bad(s, "not an element of its type");
  else
    PetscCall(AddElement(s, number[0], number[1], number + 3 + number[2]));
  PetscFunctionReturn(0);
}

static PetscErrorCode ScanElements(Scan *s)
{
  long number[4] = {-1, -1, -1, -1}, all, left, blocks;

  PetscFunctionBeginUser;
  if (Find(s, "$Elements")) PetscFunctionReturn(0);
  if (Head(s, s->version == 22 ? "i" : s->version == 40 ? "ll" : "llll", number)) number[0] = number[1] = -1;
  all = left = number[s->version == 22 ? 0 : 1];
  blocks     = number[0];
  if (all < 1 || all > s->most) (void)Bad(s, "no such number of elements can be in the file");
  while ((s->version == 22 ? left > 0 : blocks-- > 0) && !s->reason[0]) {
    const PetscBool lines = (PetscBool)(s->version == 22 && !s->binary);
    long            count = 1, type = 0, tags = 0;
    if (!lines && Take(s, s->version == 22 ? "iii" : "iiil", number, NULL)) {
      (void)Bad(s, s->binary ? "its elements end too early" : "not the head of a block of elements");
      break;
    }
    if (s->version == 22 && !lines) {
      type  = number[0];
      count = number[1];
      tags  = number[2];
    } else if (!lines) {
      type  = number[2];
      count = number[3];
      (void)CheckEntity(s, number);
    }
    if (count < 0 || count > left) (void)Bad(s, "more elements than were said");
    for (long k = 0; k < count && !s->reason[0]; k++)
      PetscCall(lines ? TakeElementLine(s) : TakeElement(s, type, tags));
    left -= count;
  }
  if (left) (void)Bad(s, "fewer elements than were said");
  PetscFunctionReturn(0);
}

/* ---- the file ---- */

static void ScanFormat(Scan *s)
{
  double version;
  int    binary, bytes;
  char   text[LINE];

  if (Find(s, "$MeshFormat")) return;
  if (!fgets(text, sizeof text, s->stream) || sscanf(text, "%lf %d %d", &version, &binary, &bytes) != 3) {
    (void)Bad(s, "no version of a mesh of Gmsh");
    return;
  }
  s->line++;
  s->version = version == 2.2 ? 22 : version == 4.0 ? 40 : version == 4.1 ? 41 : 0;
  s->binary  = (PetscBool)(binary != 0);
  if (!s->version) (void)snprintf(s->reason, s->size, "MSH version %g is not one of 2.2, 4.0, 4.1", version);
  if (!s->reason[0] && bytes != 8) (void)snprintf(s->reason, s->size, "its numbers have %d bytes, not 8", bytes);
  if (!s->reason[0] && s->binary) {
    long one = 0;
    if (Take(s, "i", &one, NULL) || one != 1) (void)Bad(s, "its bytes are in the order of another kind of machine");
  }
}

PetscErrorCode PgFemGmshScan(const char file[], PgFemGmsh *mesh, char reason[], size_t size)
{
  Scan s = {.reason = reason, .size = size, .mesh = mesh};

  PetscFunctionBeginUser;
  *mesh    = (PgFemGmsh){.nodes = 0};
  s.stream = fopen(file, "rb");
  if (!s.stream) PetscFunctionReturn(0); /* told elsewhere */
  (void)fseek(s.stream, 0, SEEK_END);
  s.most = ftell(s.stream);
  rewind(s.stream);
  ScanFormat(&s);
  if (!reason[0]) PetscCall(ScanEntities(&s));
  if (!reason[0]) PetscCall(ScanNodes(&s));
  if (!reason[0]) PetscCall(ScanElements(&s));
  (void)fclose(s.stream);
  PetscCall(PetscFree(s.entity));
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemGmshFree(PgFemGmsh *mesh)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(mesh->node));
  PetscCall(PetscFree(mesh->element));
  PetscFunctionReturn(0);
}
