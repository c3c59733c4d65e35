/* Options: bounds, and a memory of every name met, so that an unknown one can be answered with the
   nearest known one. */
#include "baseimpl.h"
#include <math.h>
#include <stdlib.h>

typedef struct {
  char *name, *initial, *unit, *text;
} KnownOption;

static KnownOption *known       = NULL;
static PetscInt     known_count = 0, known_size = 0;

static PetscErrorCode Remember(const char *prefix, const char *name, const char *initial, const char *unit,
                               const char *text)
{
  char full[512];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(full, sizeof full, "-%s%s", prefix ? prefix : "", name + 1));
  for (PetscInt i = 0; i < known_count; i++) {
    PetscBool same;
    PetscCall(PetscStrcmp(known[i].name, full, &same));
    if (same) PetscFunctionReturn(0);
  }
  if (known_count == known_size) {
    const PetscInt size = known_size ? 2 * known_size : 128;
    KnownOption   *more = (KnownOption *)realloc(known, (size_t)size * sizeof *more);
    PetscCheck(more, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for the names of %" PetscInt_FMT " options", size);
    known      = more;
    known_size = size;
  }
  PetscCall(PetscStrallocpy(full, &known[known_count].name));
  PetscCall(PetscStrallocpy(initial, &known[known_count].initial));
  PetscCall(PetscStrallocpy(unit, &known[known_count].unit));
  PetscCall(PetscStrallocpy(text, &known[known_count].text));
  known_count++;
  PetscFunctionReturn(0);
}

void PgOptionsForget(void)
{
  for (PetscInt i = 0; i < known_count; i++) {
    (void)PetscFree(known[i].name);
    (void)PetscFree(known[i].initial);
    (void)PetscFree(known[i].unit);
    (void)PetscFree(known[i].text);
  }
  free(known);
  known       = NULL;
  known_count = known_size = 0;
}

static const char *Prefix(PetscOptionItems *block) { return block->prefix ? block->prefix : ""; }

/* The text given for an option, NULL when it was not given. */
static PetscErrorCode Given(PetscOptionItems *block, const char *name, const char **text)
{
  PetscBool set = PETSC_FALSE;

  PetscFunctionBeginUser;
  *text = NULL;
  PetscCall(PetscOptionsFindPair(block->options, block->prefix, name, text, &set));
  if (!set) *text = NULL;
  if (set && !*text) *text = ""; /* given without a value */
  PetscFunctionReturn(0);
}

/* One line of -help, as PETSc writes it. PETSc's own functions would read the value again. */
static PetscErrorCode PrintHelp(PetscOptionItems *block, const char *name, const char *now, const char *text)
{
  PetscFunctionBeginUser;
  if (block->printhelp)
    PetscCall((*PetscHelpPrintf)(block->comm, "  -%s%s: <now %s>: %s\n", Prefix(block), name + 1, now, text));
  PetscFunctionReturn(0);
}

/* Numbers are read here and not by PETSc, whose message does not name the option. */
static PetscErrorCode ReadReal(PetscOptionItems *block, const char *name, const char *text, PetscReal *value)
{
  char  *end = NULL;
  double x;

  PetscFunctionBeginUser;
  PgInputCheck(text && text[0], block->comm, "option -%s%s needs a number", Prefix(block), name + 1);
  x = strtod(text, &end);
  PgInputCheck(end != text && *end == '\0', block->comm, "option -%s%s: '%s' is not a number", Prefix(block), name + 1,
               text);
  PgInputCheck(isfinite(x), block->comm, "option -%s%s: %s is not a finite number", Prefix(block), name + 1, text);
  *value = (PetscReal)x;
  PetscFunctionReturn(0);
}

PetscErrorCode PgOptionReal(PetscOptionItems *PetscOptionsObject, const char name[], const char text[],
                            const char unit[], PetscReal lower, PetscReal upper, PetscReal *value, PetscBool *set)
{
  const char *given;
  char        initial[64], now[64], help[512];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(initial, sizeof initial, "%g", (double)*value));
  PetscCall(PetscSNPrintf(help, sizeof help, "%s [%s]", text, unit));
  PetscCall(Remember(PetscOptionsObject->prefix, name, initial, unit, text));
  PetscCall(Given(PetscOptionsObject, name, &given));
  if (given) PetscCall(ReadReal(PetscOptionsObject, name, given, value));
  PetscCall(PetscSNPrintf(now, sizeof now, "%g", (double)*value));
  PetscCall(PrintHelp(PetscOptionsObject, name, now, help));
  if (set) *set = (PetscBool)(given != NULL);
  PgInputCheck(!given || *value >= lower, PetscOptionsObject->comm,
               "option -%s%s: %g %s is out of range, it must be %s %g %s", Prefix(PetscOptionsObject), name + 1,
               (double)*value, unit, lower == (PG_POSITIVE) ? ">" : ">=", lower == (PG_POSITIVE) ? 0.0 : (double)lower,
               unit);
  PgInputCheck(!given || *value <= upper, PetscOptionsObject->comm,
               "option -%s%s: %g %s is out of range, it must be <= %g %s", Prefix(PetscOptionsObject), name + 1,
               (double)*value, unit, (double)upper, unit);
  PetscFunctionReturn(0);
}

PetscErrorCode PgOptionInt(PetscOptionItems *PetscOptionsObject, const char name[], const char text[], PetscInt lower,
                           PetscInt upper, PetscInt *value, PetscBool *set)
{
  const char *given;
  char        initial[64], now[64];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(initial, sizeof initial, "%" PetscInt_FMT, *value));
  PetscCall(Remember(PetscOptionsObject->prefix, name, initial, "1", text));
  PetscCall(Given(PetscOptionsObject, name, &given));
  if (given) {
    PetscReal x;
    PetscCall(ReadReal(PetscOptionsObject, name, given, &x));
    PgInputCheck(x == floor(x), PetscOptionsObject->comm, "option -%s%s: %s is not a whole number",
                 Prefix(PetscOptionsObject), name + 1, given);
    PgInputCheck(x >= (PetscReal)lower && x <= (PetscReal)upper, PetscOptionsObject->comm,
                 "option -%s%s: %s is out of range, it must be between %" PetscInt_FMT " and %" PetscInt_FMT,
                 Prefix(PetscOptionsObject), name + 1, given, lower, upper);
    *value = (PetscInt)x;
  }
  PetscCall(PetscSNPrintf(now, sizeof now, "%" PetscInt_FMT, *value));
  PetscCall(PrintHelp(PetscOptionsObject, name, now, text));
  if (set) *set = (PetscBool)(given != NULL);
  PetscFunctionReturn(0);
}

PetscErrorCode PgOptionBool(PetscOptionItems *PetscOptionsObject, const char name[], const char text[],
                            PetscBool *value, PetscBool *set)
{
  static const char *const yes[] = {"", "true", "yes", "on", "1"}, *const no[] = {"false", "no", "off", "0"};
  const char *given = NULL;
  PetscBool   found, known_word = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(Remember(PetscOptionsObject->prefix, name, *value ? "true" : "false", "1", text));
  PetscCall(PetscOptionsFindPair(PetscOptionsObject->options, PetscOptionsObject->prefix, name, &given, &found));
  if (found) {
    for (size_t i = 0; i < sizeof yes / sizeof *yes + sizeof no / sizeof *no; i++) {
      const PetscBool   means = (PetscBool)(i < sizeof yes / sizeof *yes);
      const char *const word  = means ? yes[i] : no[i - sizeof yes / sizeof *yes];
      PetscBool         same;
      PetscCall(PetscStrcasecmp(given ? given : "", word, &same));
      if (!same) continue;
      *value     = means;
      known_word = PETSC_TRUE;
    }
    PgInputCheck(known_word, PetscOptionsObject->comm, "option -%s%s: '%s' is not one of true, false",
                 Prefix(PetscOptionsObject), name + 1, given);
  }
  PetscCall(PrintHelp(PetscOptionsObject, name, *value ? "true" : "false", text));
  if (set) *set = found;
  PetscFunctionReturn(0);
}

PetscErrorCode PgOptionReals(PetscOptionItems *PetscOptionsObject, const char name[], const char text[],
                             const char unit[], PetscInt n, PetscReal value[], PetscBool *set)
{
  const char *given;
  char        initial[256] = "", help[512];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    char one[32];
    PetscCall(PetscSNPrintf(one, sizeof one, "%s%g", i ? "," : "", (double)value[i]));
    PetscCall(PetscStrlcat(initial, one, sizeof initial));
  }
  PetscCall(PetscSNPrintf(help, sizeof help, "%s [%s]", text, unit));
  PetscCall(Remember(PetscOptionsObject->prefix, name, initial, unit, text));
  PetscCall(Given(PetscOptionsObject, name, &given));
  if (given) {
    char **part;
    int    parts;
    PetscCall(PetscStrToArray(given, ',', &parts, &part));
    if (parts != n) PetscCall(PetscStrToArrayDestroy(parts, part));
    PgInputCheck(parts == n, PetscOptionsObject->comm,
                 "option -%s%s: '%s' has %d values, it needs %" PetscInt_FMT " separated by commas",
                 Prefix(PetscOptionsObject), name + 1, given, parts, n);
    for (PetscInt i = 0; i < n; i++) PetscCall(ReadReal(PetscOptionsObject, name, part[i], &value[i]));
    PetscCall(PetscStrToArrayDestroy(parts, part));
  }
  PetscCall(PrintHelp(PetscOptionsObject, name, given ? given : initial, help));
  if (set) *set = (PetscBool)(given != NULL);
  PetscFunctionReturn(0);
}

/* Edit distance with neighbouring letters swapped counted as one edit. */
static PetscInt Distance(const char *a, const char *b)
{
  enum { MAX = 96 };
  PetscInt d[MAX + 1][MAX + 1];
  size_t   m = 0, n = 0;

  while (m < MAX && a[m]) m++;
  while (n < MAX && b[n]) n++;
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

PetscErrorCode PgOptionChoice(PetscOptionItems *PetscOptionsObject, const char name[], const char text[], PetscInt n,
                              const char *const words[], PetscInt *value, PetscBool *set)
{
  const char *given;
  char        list[512] = "", help[1024];
  PetscInt    found = -1, nearest = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    if (i) PetscCall(PetscStrlcat(list, ", ", sizeof list));
    PetscCall(PetscStrlcat(list, words[i], sizeof list));
  }
  PetscCall(PetscSNPrintf(help, sizeof help, "%s; one of %s", text, list));
  PetscCall(Remember(PetscOptionsObject->prefix, name, words[*value], "1", help));
  PetscCall(Given(PetscOptionsObject, name, &given));
  if (given) {
    for (PetscInt i = 0; i < n; i++) {
      PetscBool same;
      PetscCall(PetscStrcmp(words[i], given, &same));
      if (same) found = i;
      if (Distance(words[i], given) < Distance(words[nearest], given)) nearest = i;
    }
    PgInputCheck(found >= 0, PetscOptionsObject->comm, "option -%s%s: '%s' is not one of %s; did you mean '%s'?",
                 Prefix(PetscOptionsObject), name + 1, given, list, words[nearest]);
    *value = found;
  }
  PetscCall(PrintHelp(PetscOptionsObject, name, words[*value], help));
  if (set) *set = (PetscBool)(given != NULL);
  PetscFunctionReturn(0);
}

PetscErrorCode PgOptionString(PetscOptionItems *PetscOptionsObject, const char name[], const char text[], char value[],
                              size_t length, PetscBool *set)
{
  const char *given;

  PetscFunctionBeginUser;
  PetscCall(Remember(PetscOptionsObject->prefix, name, value, "1", text));
  PetscCall(Given(PetscOptionsObject, name, &given));
  if (given) {
    size_t n;
    PetscCall(PetscStrlen(given, &n));
    PgInputCheck(n > 0, PetscOptionsObject->comm, "option -%s%s needs a value", Prefix(PetscOptionsObject), name + 1);
    PgInputCheck(n < length, PetscOptionsObject->comm,
                 "option -%s%s: the value has %zu characters, at most %zu are allowed", Prefix(PetscOptionsObject),
                 name + 1, n, length - 1);
  }
  if (given) PetscCall(PetscStrncpy(value, given, length));
  PetscCall(PrintHelp(PetscOptionsObject, name, value[0] ? value : "(none)", text));
  if (set) *set = (PetscBool)(given != NULL);
  PetscFunctionReturn(0);
}

/* ---- unknown options ---- */

/* Options that PETSc reads only when it ends, or that belong to its logging and memory checks. */
static PetscBool BelongsToPetsc(const char *name)
{
  static const char *const prefix[] = {"log_",         "malloc",          "options_",
                                       "objects_dump", "memory_view",     "info",
                                       "on_error_",    "fp_trap",         "no_signal_handler",
                                       "mpi_",         "debugger_",       "start_in_debugger",
                                       "help",         "skip_petscrc",    "petsc_",
                                       "x_virtual",    "get_total_flops", "use_gpu_aware_mpi",
                                       "version",      "error_stack",     "checkfunctionlist"};
  for (size_t i = 0; i < sizeof prefix / sizeof *prefix; i++) {
    PetscBool begins = PETSC_FALSE;
    (void)PetscStrbeginswith(name, prefix[i], &begins);
    if (begins) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Stands in for PetscHelpPrintf(): lines of -help look like "  -name: <now ...": keep the names. */
static PetscErrorCode CollectHelp(MPI_Comm comm, const char format[], ...)
{
  char    text[8192], *name;
  size_t  length;
  va_list arguments;

  PetscFunctionBeginUser;
  (void)comm;
  va_start(arguments, format);
  PetscCall(PetscVSNPrintf(text, sizeof text, format, &length, arguments));
  va_end(arguments);
  name = text;
  while (*name == ' ') name++;
  if (name[0] == '-' && name[1] != ' ' && name[1] != '-') {
    char *end = name;
    while (*end && *end != ' ' && *end != ':' && *end != '<' && *end != '\n') end++;
    *end = '\0';
    PetscCall(Remember(NULL, name, "", "1", "an option of PETSc"));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode CollectNames(PetscErrorCode (*probe)(void *), void *context)
{
  PetscErrorCode (*print)(MPI_Comm, const char[], ...) = PetscHelpPrintf;
  PetscBool help;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsHasHelp(NULL, &help));
  if (!help) PetscCall(PetscOptionsSetValue(NULL, "-help", NULL));
  PetscHelpPrintf = CollectHelp;
  PetscCall(probe(context));
  PetscHelpPrintf = print;
  if (!help) PetscCall(PetscOptionsClearValue(NULL, "-help"));
  PetscFunctionReturn(0);
}

static const char *Nearest(const char *name)
{
  PetscInt    best   = PETSC_MAX_INT;
  const char *word   = NULL;
  size_t      length = 0;

  while (name[length]) length++;
  for (PetscInt i = 0; i < known_count; i++) {
    const PetscInt d = Distance(known[i].name + 1, name);
    if (d < best) {
      best = d;
      word = known[i].name;
    }
  }
  /* beyond a third of the letters it is another word, not a misspelling */
  return best <= (PetscInt)PetscMax(2, length / 3) ? word : NULL;
}

PetscErrorCode PgOptionsCheckUnused(MPI_Comm comm, PetscErrorCode (*probe)(void *), void *context)
{
  PetscInt count, unknown = 0;
  char   **name, **value;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsLeftGet(NULL, &count, &name, &value));
  for (PetscInt i = 0; i < count; i++) {
    const char *nearest;
    if (BelongsToPetsc(name[i])) continue;
    if (!unknown++ && probe) PetscCall(CollectNames(probe, context));
    nearest = Nearest(name[i]);
    if (nearest)
      PetscCall(PgReport(comm, "unknown option -%s%s%s; did you mean %s?", name[i], value[i] ? " " : "",
                         value[i] ? value[i] : "", nearest));
    else
      PetscCall(PgReport(comm, "unknown option -%s%s%s; -help lists all options", name[i], value[i] ? " " : "",
                         value[i] ? value[i] : ""));
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &count, &name, &value));
  PetscFunctionReturn(unknown ? PETSC_ERR_USER_INPUT : 0);
}

PetscErrorCode PgOptionsWriteTable(MPI_Comm comm, const char file[])
{
  PetscMPIInt rank;
  FILE       *out;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank) PetscFunctionReturn(0);
  out = fopen(file, "w");
  PetscCheck(out, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "cannot write %s", file);
  (void)fprintf(out, "| option | default | unit | meaning |\n| --- | --- | --- | --- |\n");
  for (PetscInt i = 0; i < known_count; i++) {
    (void)fprintf(out, "| `%s` | %s | %s | %s |\n", known[i].name, known[i].initial, known[i].unit, known[i].text);
  }
  PetscCheck(!fclose(out), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "cannot write %s", file);
  PetscFunctionReturn(0);
}
