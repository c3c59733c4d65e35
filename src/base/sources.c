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

static PetscErrorCode AddVariable(const char name[], PetscErrorCode (*insert)(PetscOptions, const char[]))
{
  const char  *text   = getenv(name);
  int          length = text ? (int)strlen(text) + 1 : 0;
  PetscMPIInt  rank;
  PetscOptions options;
  char        *copy;

  PetscFunctionBeginUser;
  PetscCall(Add(PG_LAYER_ENVIRONMENT, name, &options));
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCallMPI(MPI_Bcast(&length, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  if (!length) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(length, &copy));
  if (rank == 0) (void)snprintf(copy, (size_t)length, "%s", text);
  PetscCallMPI(MPI_Bcast(copy, length, MPI_CHAR, 0, PETSC_COMM_WORLD)); /* as PETSc does: rank 0's */
  PetscCall((*insert)(options, copy));
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

/* -name value, with the prefix in force. */
static PetscErrorCode Set(PetscOptions options, const Prefixes *prefix, const char name[], const char value[])
{
  char full[LONGEST + 256];

  PetscFunctionBeginUser;
  (void)snprintf(full, sizeof full, "-%s%s", prefix->text, Bare(name));
  PetscCall(PetscOptionsSetValue(options, full, value));
  PetscFunctionReturn(0);
}

static PetscBool NamesFile(const char word[], PetscBool *yaml)
{
  *yaml = (PetscBool)!strcasecmp(word, "-options_file_yaml");
  return (PetscBool)(*yaml || !strcasecmp(word, "-options_file"));
}

/* A file that PETSc reads in one piece. */
static PetscErrorCode AddWhole(const char file[], PetscBool yaml, const Prefixes *prefix, int layer)
{
  char         where[PETSC_MAX_PATH_LEN + 8];
  PetscOptions options;

  PetscFunctionBeginUser;
  (void)snprintf(where, sizeof where, "'%s'", file);
  PetscCall(Add(layer, where, &options));
  if (prefix->text[0]) PetscCall(PetscOptionsPrefixPush(options, prefix->text));
  if (yaml)
    PetscCall(PetscOptionsInsertFileYAML(PETSC_COMM_WORLD, options, file, PETSC_FALSE));
  else
    PetscCall(PetscOptionsInsertFile(PETSC_COMM_WORLD, options, file, PETSC_FALSE));
  PetscFunctionReturn(0);
}

/* A file, and those that it names: each is a layer, and what stands in the file itself, be it before or behind such a
   name, the layer on top of them. */
static PetscErrorCode AddFile(const char file[], PetscBool yaml, Prefixes *prefix, int depth, int *files)
{
  const int    first = sources, open = PG_LAYER_PROGRAM - 1 - depth; /* until the number of its layer is known */
  char         where[PETSC_MAX_PATH_LEN + 8], *text, *rest, *word[3];
  PetscOptions now = NULL;

  PetscFunctionBeginUser;
  PetscCall(PgOptionFileRead(file, yaml, &text));
  if (!text || depth > DEEPEST) {
    PetscCall(PetscFree(text));
    PetscCall(AddWhole(file, yaml, prefix, PG_LAYER_FILE + (*files)++));
    PetscFunctionReturn(0);
  }
  (void)snprintf(where, sizeof where, "'%s'", file);
  for (rest = text; PgOptionFileNext(&rest, word);) {
    PetscBool other_yaml;
    if (TakePrefix(word[0], word[1] ? word[1] : "", prefix)) continue;
    if (NamesFile(word[0], &other_yaml)) {
      PetscCall(AddFile(word[1] ? word[1] : "", other_yaml, prefix, depth + 1, files));
      now = NULL;
      continue;
    }
    if (!now) PetscCall(Add(open, where, &now));
    if (strcasecmp(word[0], "alias") != 0)
      PetscCall(Set(now, prefix, word[0], word[1]));
    else if (word[1] && word[2])
      PetscCall(PetscOptionsSetAlias(now, word[1], word[2]));
  }
  for (int k = first; k < sources; k++)
    if (source[k].layer == open) source[k].layer = PG_LAYER_FILE + *files;
  (*files)++;
  PetscCall(PetscFree(text));
  PetscFunctionReturn(0);
}

static PetscErrorCode AddArguments(int argc, char *argv[])
{
  Prefixes     prefix = {.depth = 0};
  PetscOptions now    = NULL;
  int          files  = 0;

  PetscFunctionBeginUser;
  for (int i = 1; i < argc; i++) {
    const char *next = i + 1 < argc ? argv[i + 1] : "";
    PetscBool   yaml;
    if (!PgIsOptionName(argv[i]) || TakePrefix(argv[i], next, &prefix)) continue;
    if (NamesFile(argv[i], &yaml)) {
      PetscCall(AddFile(next, yaml, &prefix, 0, &files));
      now = NULL;
      continue;
    }
    if (!now) PetscCall(Add(PG_LAYER_COMMAND_LINE, "the command line", &now));
    if (!strcasecmp(argv[i], "-options_string_yaml"))
      PetscCall(PetscOptionsInsertStringYAML(now, next));
    else
      PetscCall(Set(now, &prefix, argv[i], PgIsOptionName(next) ? NULL : next));
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
  PetscCall(AddVariable("PETSC_OPTIONS", PetscOptionsInsertString));
  PetscCall(AddVariable("PETSC_OPTIONS_YAML", PetscOptionsInsertStringYAML));
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
  *layer = PG_LAYER_COMMAND_LINE;
  if (where) *where = "the command line";
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
