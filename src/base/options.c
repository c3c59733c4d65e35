/* Reading options: bounds, and messages that name option, value and what is allowed. */
#include "baseimpl.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static char belongs[128] = "";

PetscErrorCode PgOptionsBelongTo(const char needs[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(belongs, needs ? needs : "", sizeof belongs));
  PetscFunctionReturn(0);
}

/* A number as C prints it; PETSc's own functions would write 2000 as "2000.". */
static const char *Number(char out[32], PetscReal x)
{
  (void)snprintf(out, 32, "%g", (double)x);
  return out;
}

static PetscErrorCode Remember(PetscOptionItems *block, const char *name, const char *initial, const char *unit,
                               const char *allowed, const char *text)
{
  char                full[512];
  const PetscBool     number = (PetscBool)(unit[0] == '1' && !unit[1]);
  const PgKnownOption option = {.name    = full,
                                .initial = initial,
                                .unit    = number ? "" : unit,
                                .text    = text,
                                .allowed = allowed,
                                .section = block->title ? block->title : "",
                                .needs   = belongs,
                                .active  = (PetscBool)!PgIsCollecting()};

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(full, sizeof full, "-%s%s", block->prefix ? block->prefix : "", name + 1));
  PetscCall(PgKnownAdd(&option));
  PetscFunctionReturn(0);
}

PetscErrorCode PgOptionsMention(const char section[], const char name[], const char initial[], const char allowed[],
                                const char text[])
{
  const PgKnownOption option = {name, initial, "", text, allowed, section, belongs, "", (PetscBool)!PgIsCollecting()};

  PetscFunctionBeginUser;
  PetscCall(PgKnownAdd(&option));
  PetscFunctionReturn(0);
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

/* " Pa" for messages and tables, nothing for a number without dimension. */
static const char *After(const char *unit) { return unit[0] == '1' && !unit[1] ? "" : unit; }

/* ">= 0 Pa, <= 1 Pa" with "," or " and" between them, as far as there are bounds. */
static void BoundsOfReal(PetscReal lower, PetscReal upper, const char unit[], const char between[], char out[96])
{
  const char *gap = unit[0] ? " " : "";
  char        low[48], high[48];

  out[0] = '\0';
  if (lower == (PG_POSITIVE))
    (void)snprintf(low, sizeof low, "> 0%s%s", gap, unit);
  else
    (void)snprintf(low, sizeof low, ">= %g%s%s", (double)lower, gap, unit);
  (void)snprintf(high, sizeof high, "<= %g%s%s", (double)upper, gap, unit);
  if (lower > -1e300 && upper < 1e300)
    (void)snprintf(out, 96, "%s%s %s", low, between, high);
  else if (lower > -1e300 || upper < 1e300)
    (void)snprintf(out, 96, "%s", lower > -1e300 ? low : high);
}

PetscErrorCode PgOptionReal(PetscOptionItems *PetscOptionsObject, const char name[], const char text[],
                            const char unit[], PetscReal lower, PetscReal upper, PetscReal *value, PetscBool *set)
{
  const char *given, *gap = After(unit)[0] ? " " : "";
  char        initial[32], now[32], bounds[96], help[512];

  PetscFunctionBeginUser;
  BoundsOfReal(lower, upper, "", ",", bounds);
  PetscCall(PetscSNPrintf(help, sizeof help, "%s [%s]", text, unit));
  PetscCall(Remember(PetscOptionsObject, name, Number(initial, *value), unit, bounds, text));
  PetscCall(Given(PetscOptionsObject, name, &given));
  if (given) PetscCall(ReadReal(PetscOptionsObject, name, given, value));
  PetscCall(PrintHelp(PetscOptionsObject, name, Number(now, *value), help));
  if (set) *set = (PetscBool)(given != NULL);
  BoundsOfReal(lower, upper, After(unit), " and", bounds);
  PgInputCheck(!given || (*value >= lower && *value <= upper), PetscOptionsObject->comm,
               "option -%s%s: %s%s%s is out of range, it must be %s", Prefix(PetscOptionsObject), name + 1, given, gap,
               After(unit), bounds);
  PetscFunctionReturn(0);
}

PetscErrorCode PgOptionInt(PetscOptionItems *PetscOptionsObject, const char name[], const char text[], PetscInt lower,
                           PetscInt upper, PetscInt *value, PetscBool *set)
{
  const char *given;
  char        initial[64], now[64], bounds[96];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(initial, sizeof initial, "%" PetscInt_FMT, *value));
  /* a bound that is that of the integers of this PETSc says nothing */
  PetscCall(PetscSNPrintf(bounds, sizeof bounds,
                          upper < PETSC_MAX_INT / 64 - 1 ? "%" PetscInt_FMT " to %" PetscInt_FMT : ">= %" PetscInt_FMT,
                          lower, upper));
  PetscCall(Remember(PetscOptionsObject, name, initial, "1", bounds, text));
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
  PetscCall(Remember(PetscOptionsObject, name, *value ? "true" : "false", "1", "true, false", text));
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
  char        initial[256] = "", help[512], count[64];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    char one[32];
    PetscCall(PetscStrlcat(initial, i ? "," : "", sizeof initial));
    PetscCall(PetscStrlcat(initial, Number(one, value[i]), sizeof initial));
  }
  PetscCall(PetscSNPrintf(count, sizeof count, "%" PetscInt_FMT " numbers", n));
  PetscCall(PetscSNPrintf(help, sizeof help, "%s [%s]", text, unit));
  PetscCall(Remember(PetscOptionsObject, name, initial, unit, count, text));
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

PetscErrorCode PgOptionChoice(PetscOptionItems *PetscOptionsObject, const char name[], const char text[], PetscInt n,
                              const char *const words[], PetscInt *value, PetscBool *set)
{
  const char *given;
  char        list[512] = "", help[3072];
  PetscInt    found = -1, nearest = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    if (i) PetscCall(PetscStrlcat(list, ", ", sizeof list));
    PetscCall(PetscStrlcat(list, words[i], sizeof list));
  }
  PetscCall(PetscSNPrintf(help, sizeof help, "%s; one of %s", text, list));
  PetscCall(Remember(PetscOptionsObject, name, words[*value], "1", list, text));
  PetscCall(Given(PetscOptionsObject, name, &given));
  if (given) {
    for (PetscInt i = 0; i < n; i++) {
      PetscBool same;
      PetscCall(PetscStrcmp(words[i], given, &same));
      if (same) found = i;
      if (PgDistance(words[i], given) < PgDistance(words[nearest], given)) nearest = i;
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
  PetscCall(Remember(PetscOptionsObject, name, value, "1", "", text));
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
