/* The memory of every option met: it answers a misspelt name, and it is the table of -help. */
#include "baseimpl.h"
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static PgKnownOption *known       = NULL;
static PetscInt       known_count = 0, known_size = 0;

PetscInt PgKnownCount(void) { return known_count; }

const PgKnownOption *PgKnownAt(PetscInt i) { return &known[i]; }

static const char *Bare(const char name[]) { return name[0] == '-' ? name + 1 : name; }

static PgKnownOption *Find(const char name[])
{
  for (PetscInt i = 0; i < known_count; i++)
    if (!strcasecmp(Bare(known[i].name), Bare(name))) return &known[i];
  return NULL;
}

const PgKnownOption *PgKnownFind(const char name[]) { return Find(name); }

const PgKnownOption *PgKnownPattern(const char name[])
{
  for (PetscInt i = 0; i < known_count; i++) {
    const char  *pattern = Bare(known[i].name);
    const size_t length  = strlen(pattern);
    if (length && pattern[length - 1] == '*' && !strncasecmp(pattern, Bare(name), length - 1)) return &known[i];
  }
  return NULL;
}

static PetscErrorCode Copy(const char from[], const char **to)
{
  char *copy;

  PetscFunctionBeginUser;
  PetscCall(PetscStrallocpy(from, &copy));
  *to = copy;
  PetscFunctionReturn(0);
}

static PetscErrorCode Replace(const char **text, const char by[])
{
  void *old = (void *)*text;

  PetscFunctionBeginUser;
  PetscCall(Copy(by, text));
  PetscCall(PetscFree(old));
  PetscFunctionReturn(0);
}

/* Met again, perhaps by another case: what it needs is then either of both, and its default may differ. */
static PetscErrorCode Merge(PgKnownOption *old, const PgKnownOption *again)
{
  char both[1024];

  PetscFunctionBeginUser;
  old->active = (PetscBool)(old->active || again->active);
  if (!old->words[0] && again->words) PetscCall(Replace(&old->words, again->words));
  if (!old->section[0] || !again->section[0]) PetscFunctionReturn(0); /* PETSc's help does not say more */
  if (strcmp(old->initial, again->initial) && strcmp(old->needs, again->needs))
    PetscCall(Replace(&old->initial, "of the case"));
  if (!old->needs[0] || strstr(old->needs, again->needs)) {
    if (!again->needs[0]) PetscCall(Replace(&old->needs, ""));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscSNPrintf(both, sizeof both, "%s or %s", old->needs, again->needs));
  PetscCall(Replace(&old->needs, both));
  PetscFunctionReturn(0);
}

PetscErrorCode PgKnownAdd(const PgKnownOption *option)
{
  PgKnownOption *old = Find(option->name), *added;

  PetscFunctionBeginUser;
  if (old) {
    PetscCall(Merge(old, option));
    PetscFunctionReturn(0);
  }
  if (known_count == known_size) {
    const PetscInt size = known_size ? 2 * known_size : 256;
    PgKnownOption *more = (PgKnownOption *)realloc(known, (size_t)size * sizeof *more);
    PetscCheck(more, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for the names of %" PetscInt_FMT " options", size);
    known      = more;
    known_size = size;
  }
  added         = &known[known_count];
  added->active = option->active;
  PetscCall(Copy(option->name, &added->name));
  PetscCall(Copy(option->initial, &added->initial));
  PetscCall(Copy(option->unit, &added->unit));
  PetscCall(Copy(option->text, &added->text));
  PetscCall(Copy(option->allowed, &added->allowed));
  PetscCall(Copy(option->section, &added->section));
  PetscCall(Copy(option->needs, &added->needs));
  PetscCall(Copy(option->words ? option->words : "", &added->words));
  known_count++;
  PetscFunctionReturn(0);
}

void PgKnownForget(void)
{
  for (PetscInt i = 0; i < known_count; i++) {
    const char *text[] = {known[i].name,    known[i].initial, known[i].unit,  known[i].text,
                          known[i].allowed, known[i].section, known[i].needs, known[i].words};
    for (size_t k = 0; k < sizeof text / sizeof *text; k++) {
      void *copy = (void *)text[k];
      (void)PetscFree(copy);
    }
  }
  free(known);
  known       = NULL;
  known_count = known_size = 0;
}

PetscInt PgDistance(const char a[], const char b[])
{
  enum { MAX = 96 };
  PetscInt     d[MAX + 1][MAX + 1];
  const size_t m = PetscMin(strlen(a), (size_t)MAX), n = PetscMin(strlen(b), (size_t)MAX);

  for (size_t i = 0; i <= m; i++) d[i][0] = (PetscInt)i;
  for (size_t j = 0; j <= n; j++) d[0][j] = (PetscInt)j;
  for (size_t i = 1; i <= m; i++) {
    for (size_t j = 1; j <= n; j++) {
      PetscInt best = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      best          = PetscMin(best, PetscMin(d[i - 1][j], d[i][j - 1]) + 1);
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) best = PetscMin(best, d[i - 2][j - 2] + 1);
      d[i][j] = best;
    }
  }
  return d[m][n];
}

const PgKnownOption *PgKnownNearest(const char name[])
{
  PetscInt             best    = PETSC_MAX_INT;
  const PgKnownOption *nearest = NULL;

  for (PetscInt i = 0; i < known_count; i++) {
    const PetscInt d = PgDistance(Bare(known[i].name), Bare(name));
    if (strchr(known[i].name, '*') || d > best) continue;
    /* one that this run reads goes before one that it does not */
    if (nearest && d == best && !(known[i].active && !nearest->active)) continue;
    best    = d;
    nearest = &known[i];
  }
  /* beyond a third of the letters it is another word, not a misspelling */
  return best <= (PetscInt)PetscMax(2, strlen(Bare(name)) / 3) ? nearest : NULL;
}
