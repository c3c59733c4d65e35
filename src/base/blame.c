/* Values that PETSc refuses. Its message names the value at most; which option it was, and what it may be, is found by
   trying: the objects are made anew with one option after the other left out. */
#include "baseimpl.h"
#include <stdio.h>
#include <string.h>

enum { MOST = 128 };

typedef struct {
  char       *line; /* holds the names and values */
  PetscInt    count;
  const char *name[MOST], *value[MOST]; /* name with its '-'; value NULL: none */
  PetscErrorCode (*probe)(void *);
  void *context;
} Suspects;

static char message[2048]; /* what PETSc said first */

/* Codes that stand for a bad value, which all ranks meet alike. */
static PetscBool IsAboutInput(PetscErrorCode code)
{
  static const PetscErrorCode codes[] = {PETSC_ERR_USER,
                                         PETSC_ERR_SUP,
                                         PETSC_ERR_ARG_WRONG,
                                         PETSC_ERR_ARG_OUTOFRANGE,
                                         PETSC_ERR_ARG_SIZ,
                                         PETSC_ERR_ARG_INCOMP,
                                         PETSC_ERR_ARG_WRONGSTATE,
                                         PETSC_ERR_ARG_NULL,
                                         PETSC_ERR_ARG_UNKNOWN_TYPE,
                                         PETSC_ERR_MISSING_FACTOR,
                                         PETSC_ERR_ARG_NOTSAMETYPE};
  for (size_t i = 0; i < sizeof codes / sizeof *codes; i++)
    if (code == codes[i]) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Keeps what may be a user's mistake; everything else goes the usual way. */
static PetscErrorCode Keep(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                           PetscErrorType type, const char *text, void *context)
{
  if (!IsAboutInput(code) && context) return code; /* only tried */
  if (!IsAboutInput(code)) return PgHandleError(comm, line, function, file, code, type, text, NULL);
  if (type == PETSC_ERROR_INITIAL) (void)snprintf(message, sizeof message, "%s", text ? text : "");
  return code;
}

static PetscBool IsName(const char word[])
{
  const char c = word[0] == '-' && word[1] == '-' ? word[2] : word[1];

  return (PetscBool)(word[0] == '-' && ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')));
}

/* The options of the user that begin with the prefix. */
static PetscErrorCode Gather(const char prefix[], Suspects *s)
{
  char *rest = NULL, *last = NULL;

  PetscFunctionBeginUser;
  s->count = 0;
  PetscCall(PetscOptionsGetAll(NULL, &s->line));
  for (char *word = strtok_r(s->line, " ", &rest); word; word = strtok_r(NULL, " ", &rest)) {
    if (IsName(word)) {
      last = NULL;
      if (s->count == MOST || strncmp(word + 1, prefix, strlen(prefix)) != 0) continue;
      s->name[s->count]    = word;
      s->value[s->count++] = NULL;
      last                 = word;
    } else if (last) {
      s->value[s->count - 1] = word;
      last                   = NULL;
    }
  }
  PetscFunctionReturn(0);
}

/* Whether objects can be made with the options that `use` names, and no others. */
static PetscErrorCode Works(Suspects *s, const PetscBool use[], PetscBool *works)
{
  PetscOptions   some;
  PetscErrorCode err;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsCreate(&some));
  PetscCall(PetscOptionsPush(some));
  for (PetscInt i = 0; i < s->count; i++)
    if (use[i]) PetscCall(PetscOptionsSetValue(NULL, s->name[i], s->value[i]));
  message[0] = '\0';
  PetscCall(PetscPushErrorHandler(Keep, s));
  err = PgCollectHelp(s->probe, s->context);
  PetscCall(PetscPopErrorHandler());
  PetscCall(PetscOptionsPop());
  PetscCall(PetscOptionsDestroy(&some));
  *works = (PetscBool)!err;
  PetscFunctionReturn(0);
}

/* The option without which all is well; of several, the one whose value PETSc's message quotes. When there is none,
   more than one is bad: the first that spoils what works so far, and what PETSc says of that. */
static PetscErrorCode FindCulprit(Suspects *s, PetscInt *culprit)
{
  PetscBool use[MOST] = {PETSC_FALSE}, works;
  PetscInt  quoted    = -1;
  char      first[sizeof message];

  PetscFunctionBeginUser;
  (void)snprintf(first, sizeof first, "%s", message);
  *culprit = -1;
  PetscCall(Works(s, use, &works));
  if (!works) PetscFunctionReturn(0); /* not the fault of an option */
  for (PetscInt i = 0; i < s->count; i++) use[i] = PETSC_TRUE;
  for (PetscInt i = 0; i < s->count; i++) {
    use[i] = PETSC_FALSE;
    PetscCall(Works(s, use, &works));
    use[i] = PETSC_TRUE;
    if (!works) continue;
    *culprit = i;
    if (s->value[i] && strstr(first, s->value[i])) quoted = i;
  }
  if (quoted >= 0) *culprit = quoted;
  (void)snprintf(message, sizeof message, "%s", first);
  if (*culprit >= 0) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < s->count; i++) use[i] = PETSC_FALSE;
  for (PetscInt i = 0; i < s->count; i++) {
    use[i] = PETSC_TRUE;
    PetscCall(Works(s, use, &works));
    if (works) continue;
    *culprit = i;
    PetscFunctionReturn(0);
  }
  PetscFunctionReturn(0);
}

/* Of words separated by ", ". */
static void NearestWord(const char words[], const char value[], char nearest[128])
{
  PetscInt best = PETSC_MAX_INT;

  nearest[0] = '\0';
  while (*words) {
    const size_t length = strcspn(words, ",");
    char         word[128];
    (void)snprintf(word, sizeof word, "%.*s", (int)length, words);
    if (!strncmp(word, value, strlen(value))) { /* cut short */
      (void)snprintf(nearest, 128, "%s", word);
      return;
    }
    if (PgDistance(word, value) < best) {
      best = PgDistance(word, value);
      (void)snprintf(nearest, 128, "%s", word);
    }
    words += length;
    while (*words == ',' || *words == ' ') words++;
  }
}

static PetscBool IsWord(const char words[], const char value[])
{
  const size_t length = strlen(value);

  for (const char *at = strstr(words, value); at; at = strstr(at + 1, value))
    if ((at == words || at[-1] == ' ') && (!at[length] || at[length] == ',')) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The last "ksp_...", "pc_..." or "mat_..." of a name. */
static const char *Tail(const char name[])
{
  static const char *const begin[] = {"ksp_", "pc_", "mat_"};
  const char              *tail    = NULL;

  for (size_t k = 0; k < sizeof begin / sizeof *begin; k++)
    for (const char *at = strstr(name, begin[k]); at; at = strstr(at + 1, begin[k]))
      if (at[-1] == '_' && (!tail || at > tail)) tail = at;
  return tail;
}

/* The words that PETSc knows for an option: it says them in its message, or in its help; solvers inside others (of
   levels, of blocks) know the same. Separated by ", ", empty when there are none. */
static void KnownWords(const char name[], char words[], size_t size)
{
  const PgKnownOption *known = PgKnownFind(name);
  const char          *list = strstr(message, "Available options:"), *tail = Tail(name);

  words[0] = '\0';
  if (list) {
    for (list += strlen("Available options:"); *list;) {
      const size_t gap = strspn(list, " \n"), length = strcspn(list + gap, " \n");
      if (length)
        (void)snprintf(words + strlen(words), size - strlen(words), "%s%.*s", words[0] ? ", " : "", (int)length,
                       list + gap);
      list += gap + length;
    }
    return;
  }
  for (PetscInt i = 0; tail && i < PgKnownCount() && !(known && known->words[0]); i++) {
    const char *other = Tail(PgKnownAt(i)->name);
    if (other && !strcmp(other, tail)) known = PgKnownAt(i);
  }
  if (known) (void)snprintf(words, size, "%s", known->words);
}

static PetscErrorCode Say(MPI_Comm comm, const char name[], const char value[])
{
  char words[2048], nearest[128];

  PetscFunctionBeginUser;
  KnownWords(name, words, sizeof words);
  if (!value) {
    PetscCall(PgReport(comm, "option %s needs a value (PETSc: %s)", name, message));
  } else if (words[0] && !IsWord(words, value)) {
    NearestWord(words, value, nearest);
    PetscCall(PgReport(comm, "option %s: '%s' is not one of %s; did you mean '%s'?", name, value, words, nearest));
  } else if (strstr(message, "has no numeric value")) {
    PetscCall(PgReport(comm, "option %s: '%s' is not a number", name, value));
  } else if (strstr(message, "has no integer value")) {
    PetscCall(PgReport(comm, "option %s: '%s' is not a whole number", name, value));
  } else if (strstr(message, "logical value")) {
    PetscCall(PgReport(comm, "option %s: '%s' is not one of true, false", name, value));
  } else {
    PetscCall(PgReport(comm, "option %s: %s is refused by PETSc: %s", name, value, message));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgOptionsRead(MPI_Comm comm, const char              prefix[], PetscErrorCode (*act)(void *),
                             PetscErrorCode (*probe)(void *), void *context)
{
  Suspects       s = {.probe = probe, .context = context};
  PetscInt       culprit;
  PetscErrorCode err;

  PetscFunctionBeginUser;
  message[0] = '\0';
  PetscCall(PetscPushErrorHandler(Keep, NULL));
  err = (*act)(context);
  PetscCall(PetscPopErrorHandler());
  if (!err || !message[0]) return err;
  PetscCall(Gather(prefix, &s));
  PetscCall(FindCulprit(&s, &culprit));
  if (culprit >= 0)
    PetscCall(Say(comm, s.name[culprit], s.value[culprit]));
  else
    PetscCall(PgReport(comm, "%s", message));
  PetscCall(PetscFree(s.line));
  return PETSC_ERR_USER_INPUT;
}
