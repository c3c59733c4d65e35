/* Options without effect. One rule: such an option ends the run, unless it stands in a file (or in PETSC_OPTIONS) and what
   takes its effect away was given later, in another file or on the command line. That is a switch thrown on top of a
   file, and what it makes idle is named in one line of warning. */
#include "baseimpl.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { NAME = 256, AGAINST = 512 };

/* ---- the line of warning ---- */

typedef struct {
  char option[NAME], by[NAME]; /* with their values */
} Idle;

static Idle *idle  = NULL;
static int   idles = 0;

static PetscErrorCode AddIdle(const char option[], const char by[])
{
  Idle *more = (Idle *)realloc(idle, (size_t)(idles + 1) * sizeof *more);

  PetscFunctionBeginUser;
  PetscCheck(more, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for the name of an option");
  idle = more;
  (void)snprintf(idle[idles].option, NAME, "%s", option);
  (void)snprintf(idle[idles++].by, NAME, "%s", by);
  PetscFunctionReturn(0);
}

static PetscErrorCode ForgetIdle(void)
{
  PetscFunctionBeginUser;
  free(idle);
  idle  = NULL;
  idles = 0;
  PetscFunctionReturn(0);
}

static int ByName(const void *a, const void *b) { return strcmp(((const Idle *)a)->option, ((const Idle *)b)->option); }

PetscErrorCode PgIdleReport(MPI_Comm comm, PetscBool print)
{
  PetscFunctionBeginUser;
  if (idles) qsort(idle, (size_t)idles, sizeof *idle, ByName); /* PETSc's order depends on its version */
  for (int i = 0; print && i < idles; i++) {
    PetscBool first = PETSC_TRUE;
    int       count = 0;
    for (int k = 0; k < i; k++) first = (PetscBool)(first && strcmp(idle[k].by, idle[i].by) != 0);
    if (!first) continue; /* named together with an earlier one */
    PetscCall(PetscPrintf(comm, i ? "; " : "warning: without effect: "));
    for (int k = i; k < idles; k++)
      if (!strcmp(idle[k].by, idle[i].by)) PetscCall(PetscPrintf(comm, "%s%s", count++ ? ", " : "", idle[k].option));
    PetscCall(PetscPrintf(comm, " (%s overrules %s)", idle[i].by, count > 1 ? "them" : "it"));
  }
  if (print && idles) PetscCall(PetscPrintf(comm, "\n"));
  PetscCall(ForgetIdle());
  PetscFunctionReturn(0);
}

/* "-name value" */
static void Given(const char name[], const char value[], char text[NAME])
{
  (void)snprintf(text, NAME, "%s%s%s", name, value && value[0] ? " " : "", value ? value : "");
}

PetscErrorCode PgIdleBecause(const char name[], const char value[], const char by[], const char by_value[],
                             PetscBool *fine)
{
  int  layer, over;
  char option[NAME], overrules[NAME];

  PetscFunctionBeginUser;
  *fine = PETSC_FALSE;
  PetscCall(PgSourceOf(name, &layer, NULL));
  PetscCall(PgSourceOf(by, &over, NULL));
  if (layer == PG_LAYER_PROGRAM || layer == PG_LAYER_COMMAND_LINE || over <= layer) PetscFunctionReturn(0);
  Given(name, value, option);
  Given(by, by_value, overrules);
  PetscCall(AddIdle(option, overrules));
  *fine = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* ---- what a rule asks for ---- */

/* What stands against the effect of an option. */
typedef struct {
  PetscBool holds;         /* nothing does */
  PetscBool program;       /* the program itself decides */
  char      text[AGAINST]; /* " with -fluid none (the default)" */
  char      by[NAME], by_value[NAME];
  int       layer; /* of `by` */
} Verdict;

static void Against(Verdict *v, const char word[], const char name[], const char value[], const char where[])
{
  const size_t used = strlen(v->text);

  (void)snprintf(v->text + used, AGAINST - used, "%s %s %s%s%s%s%s%s", used ? "," : "", word, name, value[0] ? " " : "",
                 value, where[0] ? " (" : "", where, where[0] ? ")" : "");
}

/* Whether `value` is among the words separated by '|'. */
static PetscBool IsAmong(const char words[], const char value[])
{
  const size_t length = strlen(value);

  for (const char *at = words; *at; at += strcspn(at, "|"), at += *at == '|')
    if (strcspn(at, "|") == length && !strncmp(at, value, length)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* What was given last has decided. */
static PetscErrorCode Decide(Verdict *v, const char name[], const char value[], const char **where)
{
  int layer;

  PetscFunctionBeginUser;
  PetscCall(PgSourceOf(name, &layer, where));
  if (where && layer == PG_LAYER_COMMAND_LINE) *where = ""; /* goes without saying */
  if (layer == PG_LAYER_PROGRAM) v->program = PETSC_TRUE;
  if (layer <= v->layer) PetscFunctionReturn(0);
  v->layer = layer;
  (void)snprintf(v->by, NAME, "%s", name);
  (void)snprintf(v->by_value, NAME, "%s", value);
  PetscFunctionReturn(0);
}

/* One alternative: "walls" (a fact), "no -name", "-name", "-name one|other" or "-name !one|other". */
static PetscErrorCode Term(const PgOptionRules *rules, char term[], Verdict *v)
{
  const PetscBool      absent = (PetscBool)!strncmp(term, "no ", 3);
  char                *name = term + (absent ? 3 : 0), *words = strchr(name, ' ');
  const char          *value = NULL, *now, *where = "";
  const PgKnownOption *known;
  PetscBool            given;

  PetscFunctionBeginUser;
  if (name[0] != '-') {
    v->holds = (*rules->fact)(rules->context, name);
    if (v->holds) PetscFunctionReturn(0);
    Against(v, "in a run without", name, "", "");
    PetscCall(PetscOptionsFindPair(NULL, NULL, "-case", &value, &given)); /* it decides on facts */
    if (given) PetscCall(Decide(v, "-case", value ? value : "", NULL));
    PetscFunctionReturn(0);
  }
  if (words) *words++ = '\0';
  known = PgKnownFind(name);
  if (!known || !known->active) { /* not read in this run: others speak of that */
    v->holds = PETSC_TRUE;
    PetscFunctionReturn(0);
  }
  PetscCall(PetscOptionsFindPair(NULL, NULL, name, &value, &given));
  now = given ? (value ? value : "") : known->initial;
  if (!words)
    v->holds = (PetscBool)(given != absent);
  else
    v->holds = words[0] == '!' ? (PetscBool)!IsAmong(words + 1, now) : IsAmong(words, now);
  if (v->holds) PetscFunctionReturn(0);
  if (given) PetscCall(Decide(v, name, now, &where));
  if (!given && !PgIsOfUser(name)) v->program = PETSC_TRUE;
  if (words || absent)
    Against(v, "with", name, now, given ? where : "the default");
  else
    Against(v, "without", name, "", "");
  PetscFunctionReturn(0);
}

static PetscErrorCode Judge(const PgOptionRules *rules, const char needs[], Verdict *v)
{
  char text[NAME], *term = text, * or ;

  PetscFunctionBeginUser;
  *v = (Verdict){.layer = PG_LAYER_PROGRAM};
  (void)snprintf(text, sizeof text, "%s", needs);
  while (term && !v->holds) {
    or = strstr(term, " or ");
    if (or) * or = '\0';
    PetscCall(Term(rules, term, v));
    term = or ? or +4 : NULL;
  }
  PetscFunctionReturn(0);
}

static PetscBool Matches(const char pattern[], const char name[])
{
  const size_t length = strlen(pattern);

  return (PetscBool)(pattern[length - 1] == '*' ? !strncasecmp(pattern, name, length - 1) : !strcasecmp(pattern, name));
}

static PetscErrorCode CheckOne(MPI_Comm comm, const PgOptionRules *rules, const char name[], const char value[],
                               PetscInt *refused, PetscBool *spoken)
{
  int layer;

  PetscFunctionBeginUser;
  *spoken = PETSC_FALSE;
  PetscCall(PgSourceOf(name, &layer, NULL));
  if (layer == PG_LAYER_PROGRAM || !PgIsOfUser(name)) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < rules->count && !*spoken; k++) {
    const PgOptionRule *rule = &rules->rule[k];
    PetscBool           fine = PETSC_FALSE;
    Verdict             v;
    char                option[NAME];
    if (!Matches(rule->option, name)) continue;
    PetscCall(Judge(rules, rule->needs, &v));
    if (v.holds || v.program) continue;
    *spoken = PETSC_TRUE;
    if (v.by[0]) PetscCall(PgIdleBecause(name, value, v.by, v.by_value, &fine));
    if (fine) continue;
    Given(name, value, option);
    PetscCall(PgReport(comm, "option %s has no effect%s: %s", option, v.text, rule->reason));
    (*refused)++;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgEffectCheck(MPI_Comm comm, const PgOptionRules *rules, PetscInt *refused, char ***spoken,
                             PetscInt *count)
{
  char *line, *rest = NULL, *word, *next;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetAll(NULL, &line));
  *count = 0;
  PetscCall(PetscCalloc1(strlen(line) / 2 + 1, spoken));
  for (word = strtok_r(line, " ", &rest); word; word = next) {
    PetscBool said = PETSC_FALSE;
    next           = strtok_r(NULL, " ", &rest);
    if (!PgIsOptionName(word)) continue;
    PetscCall(CheckOne(comm, rules, word, next && !PgIsOptionName(next) ? next : "", refused, &said));
    if (said) PetscCall(PetscStrallocpy(word, &(*spoken)[(*count)++]));
  }
  PetscCall(PetscFree(line));
  PetscFunctionReturn(0);
}

/* ---- one of two ---- */

PetscErrorCode PgOptionsOneOf(MPI_Comm comm, const char one[], const char other[], const char **loser)
{
  const char *name[2] = {one, other}, *value[2] = {NULL, NULL};
  int         layer[2];

  PetscFunctionBeginUser;
  *loser = "";
  for (int k = 0; k < 2; k++) {
    const PgKnownOption *known = PgKnownFind(name[k]);
    PetscBool            given;
    if (!known || !known->active) PetscFunctionReturn(0); /* not of this run: it is not to count as read */
    PetscCall(PetscOptionsFindPair(NULL, NULL, name[k], &value[k], &given));
    if (!given) PetscFunctionReturn(0);
  }
  PetscCall(PgSourcesBegin());
  for (int k = 0; k < 2; k++) PetscCall(PgSourceOf(name[k], &layer[k], NULL));
  if (layer[0] != layer[1]) {
    const int lost = layer[0] < layer[1] ? 0 : 1;
    PetscBool fine;
    PetscCall(PgIdleBecause(name[lost], value[lost], name[1 - lost], value[1 - lost], &fine));
    *loser = name[lost];
  }
  PetscCall(PgSourcesEnd());
  PgInputCheck((*loser)[0], comm, "options %s %s and %s %s contradict each other: give one", one,
               value[0] ? value[0] : "", other, value[1] ? value[1] : "");
  PetscFunctionReturn(0);
}
