/* Files of options, looked at before PETSc reads them. PETSc finds a missing file or a bad line on one rank only and
   leaves the others waiting, and says of a YAML file neither name nor line. */
#include "baseimpl.h"
#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum {
  DEEPEST = 8,      /* files named in files */
  LARGEST = 1000000 /* bytes */
};

typedef struct {
  char  *message;
  size_t length;
  int   *prefixes; /* pushed and not yet popped */
} Answer;

static PetscErrorCode CheckFile(const char given[], PetscBool yaml, int depth, const Answer *answer);

/* As PETSc tells an option from a value: -9.81 and -inf are values. */
PetscBool PgIsOptionName(const char word[])
{
  char *end = NULL;

  if (!word || word[0] != '-') return PETSC_FALSE;
  if (word[1] == '-') word++;
  if (!isalpha((unsigned char)word[1])) return PETSC_FALSE;
  (void)strtod(word, &end);
  return (PetscBool)(end == word || isalnum((unsigned char)*end) || *end == '_');
}

/* What an option whose value is a file of options asks for. */
static PetscErrorCode CheckNamed(const char option[], const char value[], int depth, const Answer *answer)
{
  const PetscBool yaml = (PetscBool)!strcasecmp(option, "-options_file_yaml");

  if (!yaml && strcasecmp(option, "-options_file") != 0) return 0;
  if (!value || !value[0] || value[0] == '-') {
    (void)snprintf(answer->message, answer->length, "option %s needs the name of a file", option);
    return PETSC_ERR_USER_INPUT;
  }
  return CheckFile(value, yaml, depth + 1, answer);
}

/* Prefixes are put in front of the names that follow: PETSc fails when more are popped than were pushed, and on those
   that cannot begin a name. */
static PetscErrorCode CheckPrefix(const char option[], const char value[], const Answer *answer)
{
  enum { MOST = 20, LONGEST = 20 }; /* PETSc bears 25, and 512 letters in all */

  if (!strcasecmp(option, "-prefix_pop")) {
    if (--*answer->prefixes >= 0) return 0;
    (void)snprintf(answer->message, answer->length, "-prefix_pop without -prefix_push before it");
    return PETSC_ERR_USER_INPUT;
  }
  if (strcasecmp(option, "-prefix_push") != 0) return 0;
  if (value && isalpha((unsigned char)value[0]) && strlen(value) <= LONGEST && ++*answer->prefixes <= MOST) return 0;
  (void)snprintf(answer->message, answer->length, "-prefix_push needs up to %d letters, at most %d times", (int)LONGEST,
                 (int)MOST);
  return PETSC_ERR_USER_INPUT;
}

/* The next word of a line, quotes around it taken off; NULL at the end. */
static char *NextWord(char **rest)
{
  char *word = *rest + strspn(*rest, " \t\r\n");
  char  end  = *word;

  if (!end) return NULL;
  if (end == '"') { /* PETSc 3.18 knows no single quotes */
    char *close = strchr(++word, end);
    *rest       = close ? close + 1 : word + strlen(word);
    if (close) *close = '\0';
    return word;
  }
  *rest = word + strcspn(word, " \t\r\n");
  if (**rest) *(*rest)++ = '\0';
  return word;
}

static void Printable(char word[])
{
  for (char *c = word; *c; c++)
    if (!isprint((unsigned char)*c)) *c = '?';
}

/* Quotes are around a whole value at the end of the line: others PETSc takes for something else. */
static PetscBool QuotesAreFine(const char line[])
{
  const char *first = line + strspn(line, " \t\r\n"), *open = strchr(line, '"'), *close;

  if (!open) return PETSC_TRUE;
  close = strchr(open + 1, '"');
  return (PetscBool)(open > first && isspace((unsigned char)open[-1]) && close && close > open + 1 &&
                     close[1 + strspn(close + 1, " \t\r\n")] == '\0');
}

static PetscErrorCode CheckLine(const char file[], int number, char line[], int depth, const Answer *answer)
{
  char *word[3] = {NULL, NULL, NULL}, *rest = line;

  line[strcspn(line, "#")] = '\0';
  if (!QuotesAreFine(line)) {
    (void)snprintf(answer->message, answer->length,
                   "options file '%s', line %d: quotes (\") must be around a whole value, the last of its line", file,
                   number);
    return PETSC_ERR_USER_INPUT;
  }
  for (int k = 0; k < 3; k++) {
    word[k] = NextWord(&rest);
    if (!word[k]) break;
  }
  if (!word[0]) return 0;
  if (!strcasecmp(word[0], "alias")) {
    if (PgIsOptionName(word[1]) && PgIsOptionName(word[2]) && !NextWord(&rest)) return 0;
    (void)snprintf(answer->message, answer->length,
                   "options file '%s', line %d: alias needs two names of options, as in 'alias -new -old'", file,
                   number);
    return PETSC_ERR_USER_INPUT;
  }
  if (PgIsOptionName(word[0]) && !PgIsOptionName(word[1]) && !word[2]) {
    char           what[128];
    const Answer   inner = {what, sizeof what, answer->prefixes};
    PetscErrorCode err   = CheckPrefix(word[0], word[1], &inner);

    if (!err && !word[1]) err = CheckNamed(word[0], NULL, depth, &inner);
    if (err) (void)snprintf(answer->message, answer->length, "options file '%s', line %d: %s", file, number, what);
    return err ? err : CheckNamed(word[0], word[1], depth, answer);
  }
  for (int k = 0; k < 3; k++)
    if (word[k]) Printable(word[k]);
  if (!PgIsOptionName(word[0]))
    (void)snprintf(answer->message, answer->length,
                   "options file '%s', line %d: '%.60s' is no option: options start with '-'", file, number, word[0]);
  else if (PgIsOptionName(word[1]))
    (void)snprintf(answer->message, answer->length,
                   "options file '%s', line %d: two options, %.60s and %.60s, in one line", file, number, word[0],
                   word[1]);
  else
    (void)snprintf(answer->message, answer->length,
                   "options file '%s', line %d: '%.60s' is one word too many: a list of values has commas and no "
                   "blanks",
                   file, number, word[2]);
  return PETSC_ERR_USER_INPUT;
}

static PetscBool IsYaml(const char file[])
{
  static const char *const ends[] = {".yaml", ".yml", ".json"};
  const size_t             length = strlen(file);

  for (size_t k = 0; k < sizeof ends / sizeof *ends; k++)
    if (length > strlen(ends[k]) && !strcmp(file + length - strlen(ends[k]), ends[k])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* A name as PETSc takes it: FILE:yaml is a file in YAML. */
static PetscBool Name(const char given[], PetscBool yaml, char file[PETSC_MAX_PATH_LEN])
{
  size_t length;

  (void)snprintf(file, PETSC_MAX_PATH_LEN, "%s", given);
  length = strlen(file);
  if (length > 5 && !strcmp(file + length - 5, ":yaml")) {
    file[length - 5] = '\0';
    return PETSC_TRUE;
  }
  return (PetscBool)(yaml || IsYaml(file));
}

/* Opens a file that can be read twice, here and by PETSc, and to its end; NULL or why not. */
static const char *WhyNotOpened(const char file[], FILE **in)
{
  PetscInt64  size;
  const char *reason = PgWhyNotFile(file, &size);

  if (reason) return reason;
  if (size > LARGEST) return "it is larger than a megabyte: this is no file of options";
  *in = fopen(file, "r");
  return *in ? NULL : strerror(errno);
}

/* A file that comes with the program, named as from its own folder or by its last part alone. */
static PetscBool IsShipped(const char file[], char found[], size_t size)
{
  char        name[PETSC_MAX_PATH_LEN];
  const char *last = strrchr(file, '/');
  char       *real;

  (void)snprintf(name, sizeof name, "options/%.1000s", last ? last + 1 : file);
  if (!PgShippedFind(file, found, size) && !PgShippedFind(name, found, size)) return PETSC_FALSE;
  real = realpath(found, NULL);
  if (real) (void)snprintf(found, size, "%s", real);
  free(real);
  return PETSC_TRUE;
}

static PetscErrorCode CheckFile(const char given[], PetscBool yaml, int depth, const Answer *answer)
{
  char           file[PETSC_MAX_PATH_LEN], shipped[PETSC_MAX_PATH_LEN], *line = NULL;
  const char    *reason;
  size_t         room = 0;
  ssize_t        size;
  FILE          *in  = NULL;
  PetscErrorCode err = 0;

  if (strchr(given, '$') || given[0] == '~') return 0; /* PETSc replaces such words */
  yaml = Name(given, yaml, file);
  if (depth > DEEPEST) {
    (void)snprintf(answer->message, answer->length, "options file '%s': more than %d files that name each other", file,
                   (int)DEEPEST);
    return PETSC_ERR_USER_INPUT;
  }
  reason = WhyNotOpened(file, &in);
  if (reason) {
    if (IsShipped(file, shipped, sizeof shipped))
      (void)snprintf(answer->message, answer->length, "options file '%s': %s; did you mean '%s'?", file, reason,
                     shipped);
    else
      (void)snprintf(answer->message, answer->length, "options file '%s': %s", file, reason);
    return PETSC_ERR_FILE_OPEN;
  }
  for (int number = 1; !err && (size = getline(&line, &room, in)) >= 0; number++) {
    if (number == 1 && (!strncmp(line, "%YAML ", 6) || !strncmp(line, "---", 3))) yaml = PETSC_TRUE;
    if (strlen(line) != (size_t)size) { /* PETSc would not see the rest of the line */
      (void)snprintf(answer->message, answer->length,
                     "options file '%s', line %d: a zero byte: this is not a text file", file, number);
      err = PETSC_ERR_USER_INPUT;
    } else if (!yaml) {
      err = CheckLine(file, number, line, depth, answer);
    }
  }
  free(line);
  (void)fclose(in);
  return err;
}

static PetscErrorCode CheckWords(const char text[], const Answer *answer)
{
  char          *copy = strdup(text), *rest = copy, *word;
  PetscErrorCode err = 0;

  if (!copy) return 0;
  word = NextWord(&rest);
  while (word && !err) {
    char *next = NextWord(&rest);
    err        = CheckNamed(word, next, 0, answer);
    word       = next;
  }
  free(copy);
  return err;
}

/* Files that PETSc reads without being asked. */
static PetscErrorCode CheckPetscrc(const Answer *answer)
{
  const char    *home                        = getenv("HOME");
  char           file[3][PETSC_MAX_PATH_LEN] = {"", ".petscrc", "petscrc"};
  struct stat    found;
  PetscErrorCode err = 0;

  if (home && home[0]) (void)snprintf(file[0], sizeof file[0], "%s/.petscrc", home);
  for (int k = 0; k < 3 && !err; k++)
    if (file[k][0] && !stat(file[k], &found) && !S_ISDIR(found.st_mode))
      err = CheckFile(file[k], PETSC_FALSE, 0, answer);
  return err;
}

PetscErrorCode PgOptionFilesCheck(int argc, char *const argv[], char message[], size_t length)
{
  int            prefixes    = 0;
  const Answer   answer      = {message, length, &prefixes};
  const char    *environment = getenv("PETSC_OPTIONS");
  PetscBool      skip        = PETSC_FALSE;
  PetscErrorCode err         = 0;

  for (int i = 1; i < argc && !err; i++) {
    if (!strcasecmp(argv[i], "-skip_petscrc")) skip = PETSC_TRUE;
    err = CheckNamed(argv[i], i + 1 < argc ? argv[i + 1] : NULL, 0, &answer);
  }
  if (!err && environment) err = CheckWords(environment, &answer);
  if (!err && !skip) err = CheckPetscrc(&answer);
  return err;
}

/* ---- YAML ---- */

static PetscBool IsGoodYaml(const char text[])
{
  PetscOptions   scratch;
  PetscErrorCode err;

  if (PetscOptionsCreate(&scratch)) return PETSC_TRUE;
  err = PetscOptionsInsertStringYAML(scratch, text);
  (void)PetscOptionsDestroy(&scratch);
  return (PetscBool)!err;
}

/* The line after the last with which the file could end and be understood. */
static int BadLine(char text[])
{
  int good = 0, lines = 0;

  for (char *end = text; (end = strchr(end, '\n')); end++) {
    const char after = end[1];
    lines++;
    end[1] = '\0';
    if (IsGoodYaml(text)) good = lines;
    end[1] = after;
  }
  return good + 1;
}

static char *ReadAll(const char file[])
{
  FILE  *in   = fopen(file, "r");
  char  *text = NULL;
  size_t size = 0, room = 0;

  while (in && !feof(in)) {
    char *more = (char *)realloc(text, room + 4097);
    if (!more) break;
    text = more;
    room += 4096;
    size += fread(text + size, 1, room - size, in);
    text[size] = '\0';
    if (ferror(in)) break;
  }
  if (in) (void)fclose(in);
  return text;
}

PetscBool PgOptionFilesFindYaml(int argc, char *const argv[], char message[], size_t length)
{
  PetscBool bad = PETSC_FALSE;

  for (int i = 1; i + 1 < argc && !bad; i++) {
    const PetscBool yaml = (PetscBool)!strcasecmp(argv[i], "-options_file_yaml");
    char            file[PETSC_MAX_PATH_LEN], *text;
    if (!yaml && strcasecmp(argv[i], "-options_file") != 0) continue;
    (void)Name(argv[i + 1], yaml, file);
    text = ReadAll(file);
    if (text && (yaml || IsYaml(file) || strcmp(file, argv[i + 1]) != 0 || text[0] == '%' || text[0] == '-') &&
        !IsGoodYaml(text)) {
      (void)snprintf(message, length, "options file '%s': not understood as YAML from line %d on", file, BadLine(text));
      bad = PETSC_TRUE;
    }
    free(text);
  }
  return bad;
}

/* ---- line by line, for whoever wants to know which file an option stands in ---- */

PetscErrorCode PgOptionFileRead(const char given[], PetscBool yaml, char **text)
{
  char        file[PETSC_MAX_PATH_LEN];
  int         length = -1;
  PetscMPIInt rank;
  char       *read = NULL;

  PetscFunctionBeginUser;
  *text = NULL;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  if (rank == 0 && !Name(given, yaml, file)) read = ReadAll(file); /* not what PETSc would replace: '$', '~' */
  if (read && (!strncmp(read, "%YAML ", 6) || !strncmp(read, "---", 3))) {
    free(read);
    read = NULL;
  }
  if (read) length = (int)strlen(read);
  PetscCallMPI(MPI_Bcast(&length, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  if (length >= 0) {
    PetscCall(PetscMalloc1(length + 1, text));
    if (rank == 0) (void)snprintf(*text, (size_t)length + 1, "%s", read);
    PetscCallMPI(MPI_Bcast(*text, length + 1, MPI_CHAR, 0, PETSC_COMM_WORLD));
  }
  free(read);
  PetscFunctionReturn(0);
}

PetscBool PgOptionFileNext(char **rest, char *word[3])
{
  while (*rest && **rest) {
    char *line = *rest, *end = strchr(line, '\n');

    *rest = end ? end + 1 : NULL;
    if (end) *end = '\0';
    line[strcspn(line, "#")] = '\0';
    for (int k = 0; k < 3; k++) word[k] = NextWord(&line);
    if (word[0]) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}
