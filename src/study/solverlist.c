/* The file of solvers: on each line a name, then PETSc options without prefix. Each solver gets a prefix of its own, so
   that the solvers inside it (of blocks, of levels) find their options too and PETSc can say which were read. */
#include "studyimpl.h"
#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>

/* The whole file on every rank; to be freed. */
static PetscErrorCode ReadFile(MPI_Comm comm, const char file[], char **text)
{
  const char *why = NULL;
  PetscMPIInt rank;
  long        size = -1;
  FILE       *in   = NULL;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) {
    why = PgWhyNotFile(file, NULL);
    in  = why ? NULL : fopen(file, "r");
    if (!in && !why) why = strerror(errno);
    if (in && !fseek(in, 0, SEEK_END)) size = ftell(in);
    if (size >= 0) rewind(in);
  }
  PetscCallMPI(MPI_Bcast(&size, 1, MPI_LONG, 0, comm));
  if (size < 0 || size > 1000000) {
    if (in) (void)fclose(in);
    PetscCall(
        PgReport(comm, "option -study_solvers: cannot read %s: %s", file, why ? why : "it is too long for a list"));
    return PETSC_ERR_FILE_OPEN;
  }
  PetscCall(PetscCalloc1((size_t)size + 1, text));
  if (rank == 0) {
    if (fread(*text, 1, (size_t)size, in) != (size_t)size) (*text)[0] = '\0';
    (void)fclose(in);
  }
  PetscCallMPI(MPI_Bcast(*text, (PetscMPIInt)size + 1, MPI_CHAR, 0, comm));
  PetscFunctionReturn(0);
}

static PetscBool IsOption(const char *word)
{
  return (PetscBool)(word[0] == '-' && (isalpha((unsigned char)word[1]) || word[1] == '_'));
}

/* Words of one line; '#' begins a comment. */
static PetscErrorCode Split(char *line, PetscInt most, char *word[], PetscInt *count)
{
  PetscFunctionBeginUser;
  line[strcspn(line, "#\r")] = '\0';
  *count                     = 0;
  for (char *rest = NULL, *w = strtok_r(line, " \t", &rest); w && *count < most; w = strtok_r(NULL, " \t", &rest))
    word[(*count)++] = w;
  PetscFunctionReturn(0);
}

static PetscErrorCode ParseLine(MPI_Comm comm, const char file[], PetscInt number, char *line, PgSolver *s,
                                PetscBool *empty)
{
  enum { WORDS = 2 * PG_OVERRIDES };
  char    *word[WORDS];
  PetscInt words, most = PG_OVERRIDES - 2;

  PetscFunctionBeginUser;
  PetscCall(Split(line, WORDS, word, &words));
  *empty = (PetscBool)(words == 0);
  if (*empty) PetscFunctionReturn(0);
  PgInputCheck(!IsOption(word[0]), comm, "%s:%" PetscInt_FMT ": '%s' is an option, the name of the solver comes first",
               file, number, word[0]);
  PgInputCheck(strlen(word[0]) < sizeof s->name, comm, "%s:%" PetscInt_FMT ": the name '%s' is too long", file, number,
               word[0]);
  PetscCall(PetscStrncpy(s->name, word[0], sizeof s->name));
  s->line = number;
  PetscCall(PetscCalloc3(most, &s->option, most, &s->value, most, &s->used));
  for (PetscInt w = 1; w < words; w++) {
    PgInputCheck(IsOption(word[w]), comm, "%s:%" PetscInt_FMT ": '%s' belongs to no option of solver %s", file, number,
                 word[w], s->name);
    PgInputCheck(s->options < most, comm, "%s:%" PetscInt_FMT ": more than %" PetscInt_FMT " options", file, number,
                 most);
    for (PetscInt i = 0; i < s->options; i++)
      PgInputCheck(strcmp(s->option[i], word[w] + 1) != 0, comm, "%s:%" PetscInt_FMT ": solver %s has option %s twice",
                   file, number, s->name, word[w]);
    PetscCall(PetscStrallocpy(word[w] + 1, &s->option[s->options]));
    if (w + 1 < words && !IsOption(word[w + 1])) PetscCall(PetscStrallocpy(word[++w], &s->value[s->options]));
    s->options++;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode FreeSolver(PgSolver *s)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->options; i++) {
    PetscCall(PetscFree(s->option[i]));
    PetscCall(PetscFree(s->value[i]));
  }
  PetscCall(PetscFree3(s->option, s->value, s->used));
  PetscCall(PetscMemzero(s, sizeof *s));
  PetscFunctionReturn(0);
}

static PetscErrorCode ParseAll(MPI_Comm comm, char *text, PgSolverList *list)
{
  PetscInt number = 0, capacity = 1;

  PetscFunctionBeginUser;
  for (const char *c = text; *c; c++) capacity += *c == '\n';
  PetscCall(PetscCalloc1(capacity, &list->solver));
  for (char *line = text, *next; line; line = next) {
    PgSolver *s = &list->solver[list->count];
    PetscBool empty;

    next = strchr(line, '\n');
    if (next) *next++ = '\0';
    number++;
    PetscCall(ParseLine(comm, list->file, number, line, s, &empty));
    if (empty) continue;
    for (PetscInt i = 0; i < list->count; i++)
      PgInputCheck(strcmp(s->name, list->solver[i].name) != 0, comm,
                   "%s:%" PetscInt_FMT ": solver %s is there already, line %" PetscInt_FMT, list->file, number, s->name,
                   list->solver[i].line);
    PetscCall(PetscSNPrintf(s->prefix, sizeof s->prefix, "study_%" PetscInt_FMT "_", list->count));
    list->count++;
  }
  PgInputCheck(list->count > 0, comm, "%s holds no solver", list->file);
  PetscFunctionReturn(0);
}

static PetscErrorCode NoSuchSolver(MPI_Comm comm, const char name[], const PgSolverList *list)
{
  char   names[2048] = "";
  size_t used        = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < list->count && used < sizeof names; i++)
    used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", i ? ", " : "", list->solver[i].name);
  PgInputError(comm, "option -study_only: no solver '%s' in %s, which has %s", name, list->file, names);
}

/* Keeps the solvers named in `only`, in the order of the file. */
static PetscErrorCode Choose(MPI_Comm comm, const char only[], PgSolverList *list)
{
  PetscBool *keep;
  char     **name;
  int        names;
  PetscInt   kept = 0;

  PetscFunctionBeginUser;
  if (!only[0]) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(list->count, &keep));
  PetscCall(PetscStrToArray(only, ',', &names, &name));
  for (int k = 0; k < names; k++) {
    PetscBool found = PETSC_FALSE;
    for (PetscInt i = 0; i < list->count; i++)
      if (!strcmp(name[k], list->solver[i].name)) keep[i] = found = PETSC_TRUE;
    if (!found) PetscCall(NoSuchSolver(comm, name[k], list));
  }
  PetscCall(PetscStrToArrayDestroy(names, name));
  for (PetscInt i = 0; i < list->count; i++) {
    if (keep[i])
      list->solver[kept++] = list->solver[i];
    else
      PetscCall(FreeSolver(&list->solver[i]));
  }
  list->count = kept;
  PetscCall(PetscFree(keep));
  PetscFunctionReturn(0);
}

PetscErrorCode PgSolverListRead(MPI_Comm comm, const char file[], const char only[], PgSolverList *list)
{
  char *text;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(list, sizeof *list));
  PetscCall(PetscStrncpy(list->file, file, sizeof list->file));
  PetscCall(ReadFile(comm, file, &text));
  PetscCall(ParseAll(comm, text, list));
  PetscCall(PetscFree(text));
  PetscCall(Choose(comm, only, list));
  PetscFunctionReturn(0);
}

PetscErrorCode PgSolverListDestroy(PgSolverList *list)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < list->count; i++) PetscCall(FreeSolver(&list->solver[i]));
  PetscCall(PetscFree(list->solver));
  list->count = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode PgSolverPut(const PgSolver *s, const char prefix[], PgOverride *o)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->options; i++) {
    char name[512];
    PetscCall(PetscSNPrintf(name, sizeof name, "-%s%s", prefix, s->option[i]));
    PetscCall(PgOverrideSet(o, name, s->value[i]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgSolverTake(PgSolver *s, PgOverride *o)
{
  PetscBool used[PG_OVERRIDES] = {PETSC_FALSE};

  PetscFunctionBeginUser;
  PetscCall(PgOverrideRestore(o, used));
  for (PetscInt i = 0; i < s->options; i++) s->used[i] = (PetscBool)(s->used[i] || used[i]);
  PetscFunctionReturn(0);
}

PetscErrorCode PgSolverHas(const PgSolver *s, const char option[], PetscBool *has)
{
  PetscFunctionBeginUser;
  *has = PETSC_FALSE;
  for (PetscInt i = 0; i < s->options && !*has; i++) PetscCall(PetscStrcasecmp(s->option[i], option, has));
  PetscFunctionReturn(0);
}
