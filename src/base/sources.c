/* Where an option was given. PETSc does not tell: what it has read (its own files, PETSC_OPTIONS, the command line with the
   files that it names) is read once more, each into a set of options of its own. */
#include "baseimpl.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { DEEPEST = 25, LONGEST = 512 }; /* prefixes that PETSc bears, and their letters */

typedef struct {
  PetscOptions options;
  int          layer;
  char         where[PETSC_MAX_PATH_LEN + 8];
} Source;

static Source *source  = NULL; /* in the order in which PETSc takes them: the last that has a name counts */
static int     sources = 0;

/* ---- options that the program itself has set ---- */

typedef struct {
  char        *name; /* without '-' */
  PgOptionBase by;
} Mark;

static Mark *mark  = NULL;
static int   marks = 0;

static const char *Bare(const char name[]) { return name + strspn(name, "-"); }

static Mark *FindMark(const char name[])
{
  for (int k = 0; k < marks; k++)
    if (!strcasecmp(mark[k].name, Bare(name))) return &mark[k];
  return NULL;
}

static PetscErrorCode ForgetMarks(void)
{
  PetscFunctionBeginUser;
  for (int k = 0; k < marks; k++) PetscCall(PetscFree(mark[k].name));
  free(mark);
  mark  = NULL;
  marks = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode PgOptionsSetBy(const char name[], PgOptionBase by)
{
  Mark *old = FindMark(name), *more;

  PetscFunctionBeginUser;
  if (PgIsCollecting() || (!old && by == PG_OPTION_USER)) PetscFunctionReturn(0);
  if (old) {
    old->by = by;
    PetscFunctionReturn(0);
  }
  if (!mark) PetscCall(PetscRegisterFinalize(ForgetMarks));
  more = (Mark *)realloc(mark, (size_t)(marks + 1) * sizeof *more);
  PetscCheck(more, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for the name of an option");
  mark = more;
  PetscCall(PetscStrallocpy(Bare(name), &mark[marks].name));
  mark[marks++].by = by;
  PetscFunctionReturn(0);
}

/* ---- what the user has given ---- */

static PetscErrorCode Add(int layer, const char where[], PetscOptions *options)
{
  Source *more = (Source *)realloc(source, (size_t)(sources + 1) * sizeof *more);

  PetscFunctionBeginUser;
  PetscCheck(more, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for the sources of options");
  source = more;
  PetscCall(PetscOptionsCreate(&source[sources].options));
  source[sources].layer = layer;
  (void)snprintf(source[sources].where, sizeof source[sources].where, "%s", where);
  *options = source[sources++].options;
  PetscFunctionReturn(0);
}

static PetscErrorCode AddPetscrc(void)
{
  char         home[PETSC_MAX_PATH_LEN];
  PetscOptions options;
  size_t       length;

  PetscFunctionBeginUser;
  PetscCall(Add(PG_LAYER_PETSCRC, ".petscrc", &options));
  PetscCall(PetscGetHomeDirectory(home, sizeof home - 16));
  PetscCall(PetscStrlen(home, &length));
  if (length) {
    PetscCall(PetscStrlcat(home, "/.petscrc", sizeof home));
    PetscCall(PetscOptionsInsertFile(PETSC_COMM_WORLD, options, home, PETSC_FALSE));
  }
  PetscCall(PetscOptionsInsertFile(PETSC_COMM_WORLD, options, ".petscrc", PETSC_FALSE));
  PetscCall(PetscOptionsInsertFile(PETSC_COMM_WORLD, options, "petscrc", PETSC_FALSE));
  PetscFunctionReturn(0);
}

static PetscErrorCode AddEnvironment(void)
{
  const char  *text   = getenv("PETSC_OPTIONS");
  int          length = text ? (int)strlen(text) + 1 : 0;
  PetscMPIInt  rank;
  PetscOptions options;
  char        *copy;

  PetscFunctionBeginUser;
  PetscCall(Add(PG_LAYER_ENVIRONMENT, "PETSC_OPTIONS", &options));
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCallMPI(MPI_Bcast(&length, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  if (!length) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(length, &copy));
  if (rank == 0) (void)snprintf(copy, (size_t)length, "%s", text);
  PetscCallMPI(MPI_Bcast(copy, length, MPI_CHAR, 0, PETSC_COMM_WORLD)); /* as PETSc does: rank 0's */
  PetscCall(PetscOptionsInsertString(options, copy));
  PetscCall(PetscFree(copy));
  PetscFunctionReturn(0);
}

/* Prefixes in front of the names that follow, as PETSc takes them. */
typedef struct {
  char text[LONGEST];
  int  depth, length[DEEPEST + 1];
} Prefixes;

static PetscBool TakePrefix(const char word[], const char next[], Prefixes *prefix)
{
  if (!strcasecmp(word, "-prefix_push") && prefix->depth < DEEPEST) {
    (void)snprintf(prefix->text + prefix->length[prefix->depth], (size_t)(LONGEST - prefix->length[prefix->depth]),
                   "%s", next);
    prefix->length[++prefix->depth] = (int)strlen(prefix->text);
    return PETSC_TRUE;
  }
  if (!strcasecmp(word, "-prefix_pop") && prefix->depth > 0) {
    prefix->text[prefix->length[--prefix->depth]] = '\0';
    return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static PetscErrorCode AddArguments(int argc, char *argv[])
{
  Prefixes     prefix = {.depth = 0};
  PetscOptions now    = NULL;
  int          files  = 0;

  PetscFunctionBeginUser;
  for (int i = 1; i < argc; i++) {
    const char *next = i + 1 < argc ? argv[i + 1] : "";
    const int   yaml = !strcasecmp(argv[i], "-options_file_yaml");
    char        where[PETSC_MAX_PATH_LEN + 8], name[LONGEST + 256];
    if (!PgIsOptionName(argv[i]) || TakePrefix(argv[i], next, &prefix)) continue;
    if (yaml || !strcasecmp(argv[i], "-options_file")) {
      PetscOptions options;
      (void)snprintf(where, sizeof where, "'%s'", next);
      PetscCall(Add(PG_LAYER_FILE + files++, where, &options));
      if (yaml)
        PetscCall(PetscOptionsInsertFileYAML(PETSC_COMM_WORLD, options, next, PETSC_FALSE));
      else
        PetscCall(PetscOptionsInsertFile(PETSC_COMM_WORLD, options, next, PETSC_FALSE));
      now = NULL;
      continue;
    }
    if (!now) PetscCall(Add(PG_LAYER_COMMAND_LINE, "the command line", &now));
    (void)snprintf(name, sizeof name, "-%s%s", prefix.text, Bare(argv[i]));
    PetscCall(PetscOptionsSetValue(now, name, PgIsOptionName(next) ? NULL : next));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgSourcesBegin(void)
{
  int       argc = 0;
  char    **argv = NULL;
  PetscBool skip = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PgSourcesEnd());
  PetscCall(PetscGetArgs(&argc, &argv));
  for (int i = 1; i < argc; i++) skip = (PetscBool)(skip || !strcasecmp(argv[i], "-skip_petscrc"));
  if (!skip) PetscCall(AddPetscrc());
  PetscCall(AddEnvironment());
  PetscCall(AddArguments(argc, argv));
  PetscFunctionReturn(0);
}

PetscErrorCode PgSourcesEnd(void)
{
  PetscFunctionBeginUser;
  for (int k = 0; k < sources; k++) PetscCall(PetscOptionsDestroy(&source[k].options));
  free(source);
  source  = NULL;
  sources = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode PgSourceOf(const char name[], int *layer, const char **where)
{
  const Mark *set = FindMark(name);
  PetscBool   has = PETSC_FALSE;

  PetscFunctionBeginUser;
  *layer = PG_LAYER_PROGRAM;
  if (where) *where = "";
  if (set && set->by == PG_OPTION_PROGRAM) PetscFunctionReturn(0);
  if (set && set->by == PG_OPTION_CASE) {
    PetscCall(PgSourceOf("-case", layer, where));
    PetscFunctionReturn(0);
  }
  for (int k = sources - 1; k >= 0 && !has; k--) {
    PetscCall(PetscOptionsHasName(source[k].options, NULL, name, &has));
    if (!has) continue;
    *layer = source[k].layer;
    if (where) *where = source[k].where;
  }
  PetscFunctionReturn(0);
}

PetscBool PgIsOfUser(const char name[])
{
  const Mark *set = FindMark(name);

  return (PetscBool)(!set || set->by == PG_OPTION_USER);
}
