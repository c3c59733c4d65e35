/* -help and -version. PETSc's own -help prints hundreds of lines that no newcomer has asked for: this one is short and
   says how to see more. -help petsc is PETSc's own. */
#include "baseimpl.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { WIDTH = 100 };

static PetscBool help_asked = PETSC_FALSE, version_asked = PETSC_FALSE;
static char      topic[256] = "";
static char    **arguments  = NULL; /* without those taken out */

static PetscBool IsHelp(const char word[])
{
  return (PetscBool)(!strcmp(word, "-help") || !strcmp(word, "--help") || !strcmp(word, "-h"));
}

static PetscBool IsVersion(const char word[])
{
  return (PetscBool)(!strcmp(word, "-version") || !strcmp(word, "--version"));
}

void PgHelpForget(void)
{
  free(arguments);
  arguments  = NULL;
  help_asked = version_asked = PETSC_FALSE;
  topic[0]                   = '\0';
}

void PgHelpTakeArguments(int *argc, char ***argv)
{
  static char petsc_help[] = "-help";
  int         count        = 0;

  PgHelpForget();
  if (!argc || !argv || !*argv) return;
  arguments = (char **)calloc((size_t)*argc + 1, sizeof *arguments);
  if (!arguments) return;
  for (int i = 0; i < *argc; i++) {
    char *word = (*argv)[i];
    if (i > 0 && IsVersion(word)) {
      version_asked = PETSC_TRUE;
    } else if (i > 0 && IsHelp(word)) {
      const PetscBool named = (PetscBool)(i + 1 < *argc && (*argv)[i + 1][0] != '-');
      if (named && !strcmp((*argv)[i + 1], "petsc")) {
        arguments[count++] = petsc_help;
      } else {
        help_asked = PETSC_TRUE;
        if (named) (void)snprintf(topic, sizeof topic, "%s", (*argv)[i + 1]);
      }
      if (named) i++;
    } else {
      arguments[count++] = word;
    }
  }
  *argc = count;
  *argv = arguments;
}

/* ---- one option ---- */

/* A default that the text explains is no number of its own: 0 for "default: of the case". */
static const char *Default(const PgKnownOption *option)
{
  return strstr(option->text, "default") ? "" : option->initial;
}

/* Prints text in lines of at most WIDTH letters, each after `indent` blanks. */
static PetscErrorCode Wrap(MPI_Comm comm, int indent, const char text[])
{
  PetscFunctionBeginUser;
  while (*text) {
    const size_t most = (size_t)(WIDTH - indent);
    size_t       end  = strlen(text);
    if (end > most) {
      for (end = most; end > 0 && text[end] != ' ';) end--;
      if (end == 0) end = strcspn(text, " ");
    }
    PetscCall(PetscPrintf(comm, "%*s%.*s\n", indent, "", (int)end, text));
    text += end;
    while (*text == ' ') text++;
  }
  PetscFunctionReturn(0);
}

/* What is allowed, unless the text has said all of it: names of cases, each followed by what it is. */
static const char *Allowed(const PgKnownOption *o)
{
  const char *word = o->allowed;
  char        shown[128];

  while (*word) {
    const int length = (int)strcspn(word, ",");
    (void)snprintf(shown, sizeof shown, " %.*s (", length, word);
    if (!strstr(o->text, shown)) return o->allowed;
    word += length;
    word += strspn(word, ", ");
  }
  return "";
}

/* `with`: whether to say what a run needs to read it. */
static PetscErrorCode PrintOption(MPI_Comm comm, const PgKnownOption *o, PetscBool with)
{
  const char *initial = Default(o), *unit = o->unit, *allowed = Allowed(o);
  char        line[2048];

  PetscFunctionBeginUser;
  PetscCall(PetscPrintf(comm, "  %s%s%s%s\n", o->name, unit[0] ? " [" : "", unit, unit[0] ? "]" : ""));
  PetscCall(Wrap(comm, 6, o->text));
  line[0] = '\0';
  if (initial[0]) (void)snprintf(line, sizeof line, "default %s", initial);
  if (allowed[0])
    (void)snprintf(line + strlen(line), sizeof line - strlen(line), "%sallowed: %s", line[0] ? "; " : "", allowed);
  if (with && o->needs[0])
    (void)snprintf(line + strlen(line), sizeof line - strlen(line), "%swith %s", line[0] ? "; " : "", o->needs);
  PetscCall(Wrap(comm, 6, line));
  PetscFunctionReturn(0);
}

/* What the short help says of an option: of one whose text describes each word that is allowed, the words only. */
static PetscErrorCode PrintBrief(MPI_Comm comm, const PgKnownOption *o)
{
  PgKnownOption brief = *o;
  char          text[512], allowed[1024];

  PetscFunctionBeginUser;
  if (o->allowed[0] && !Allowed(o)[0]) {
    (void)snprintf(text, sizeof text, "%.*s", (int)strcspn(o->text, ":"), o->text);
    (void)snprintf(allowed, sizeof allowed, "%s; what they are: -help %s", o->allowed, o->name + 1);
    brief.text    = text;
    brief.allowed = allowed;
  }
  PetscCall(PrintOption(comm, &brief, PETSC_TRUE));
  PetscFunctionReturn(0);
}

/* A cell of a table in Markdown: '|' would end it. */
static PetscErrorCode Cell(MPI_Comm comm, const char text[])
{
  PetscFunctionBeginUser;
  for (; *text; text++) PetscCall(PetscPrintf(comm, *text == '|' ? "\\|" : "%c", *text));
  PetscCall(PetscPrintf(comm, " | "));
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintRow(MPI_Comm comm, const PgKnownOption *o, PetscBool with)
{
  char meaning[4096];
  PetscFunctionBeginUser;
  PetscCall(PetscPrintf(comm, "| `%s` | ", o->name));
  PetscCall(Cell(comm, o->unit));
  PetscCall(Cell(comm, Default(o)));
  PetscCall(Cell(comm, o->allowed));
  (void)snprintf(meaning, sizeof meaning, with && o->needs[0] ? "%s (with %s)" : "%s", o->text, o->needs);
  PetscCall(Cell(comm, meaning));
  PetscCall(PetscPrintf(comm, "\n"));
  PetscFunctionReturn(0);
}

/* ---- sections ---- */

/* "key: title" gives the length of the key; "case panel: title" that of "case panel". */
static size_t KeyLength(const char section[]) { return strcspn(section, ":"); }

static const char *Title(const char section[])
{
  const char *title = section + KeyLength(section);
  return *title ? title + 1 + strspn(title + 1, " ") : section;
}

static PetscBool SameKey(const char a[], const char b[])
{
  const size_t n = KeyLength(a);
  return (PetscBool)(n == KeyLength(b) && !strncasecmp(a, b, n));
}

/* The first option of each section stands for it. */
static PetscBool IsFirst(PetscInt i)
{
  if (!PgKnownAt(i)->section[0]) return PETSC_FALSE;
  for (PetscInt k = 0; k < i; k++)
    if (SameKey(PgKnownAt(k)->section, PgKnownAt(i)->section)) return PETSC_FALSE;
  return PETSC_TRUE;
}

static PetscBool IsCase(const char section[]) { return (PetscBool)!strncmp(section, "case ", 5); }

/* Whether the topic names this section: its key, or that of a case without the word "case". */
static PetscBool Names(const char section[])
{
  const size_t n = KeyLength(section), m = strlen(topic);
  if (!n) return PETSC_FALSE;
  if (n == m && !strncasecmp(section, topic, n)) return PETSC_TRUE;
  return (PetscBool)(IsCase(section) && n == m + 5 && !strncasecmp(section + 5, topic, m));
}

static PetscErrorCode PrintSection(MPI_Comm comm, const char section[], PetscBool table)
{
  const int   length  = (int)KeyLength(section);
  const char *needs   = NULL;
  PetscBool   uniform = PETSC_TRUE;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < PgKnownCount(); i++) {
    const PgKnownOption *o = PgKnownAt(i);
    if (!SameKey(o->section, section)) continue;
    if (needs && strcmp(needs, o->needs) != 0) uniform = PETSC_FALSE;
    needs = o->needs;
  }
  PetscCall(PetscPrintf(comm, table ? "\n## %.*s: %s\n\n" : "\n%.*s: %s\n\n", length, section, Title(section)));
  if (needs && needs[0] && uniform) PetscCall(PetscPrintf(comm, table ? "With `%s`.\n\n" : "  with %s\n\n", needs));
  if (table)
    PetscCall(PetscPrintf(comm, "| option | unit | default | allowed | meaning |\n| --- | --- | --- | --- | --- |\n"));
  for (PetscInt i = 0; i < PgKnownCount(); i++) {
    const PgKnownOption *o = PgKnownAt(i);
    if (!SameKey(o->section, section)) continue;
    if (table)
      PetscCall(PrintRow(comm, o, (PetscBool)!uniform));
    else
      PetscCall(PrintOption(comm, o, (PetscBool)!uniform));
  }
  PetscFunctionReturn(0);
}

/* ---- what can be asked for ---- */

static PetscErrorCode PrintShort(MPI_Comm comm, const PgProgram *program)
{
  char *often, *rest = NULL;

  PetscFunctionBeginUser;
  PetscCall(PetscPrintf(comm, "%s %s: %s\n\n%s\nOften used:\n\n", program->name, PG_VERSION, program->purpose,
                        program->examples));
  PetscCall(PetscStrallocpy(program->often, &often));
  for (char *name = strtok_r(often, " ", &rest); name; name = strtok_r(NULL, " ", &rest)) {
    const PgKnownOption *o = PgKnownFind(name);
    if (o) PetscCall(PrintBrief(comm, o));
  }
  PetscCall(PetscFree(often));
  PetscCall(PetscPrintf(comm, "\nMore, with -help and one of these words:\n\n"));
  for (PetscInt i = 0; i < PgKnownCount(); i++) {
    const char *section = PgKnownAt(i)->section;
    if (IsFirst(i) && !IsCase(section))
      PetscCall(PetscPrintf(comm, "  %-10.*s %s\n", (int)KeyLength(section), section, Title(section)));
  }
  for (PetscInt i = 0, cases = 0; i < PgKnownCount(); i++) {
    const char *section = PgKnownAt(i)->section;
    if (!IsFirst(i) || !IsCase(section)) continue;
    if (!cases++) PetscCall(PetscPrintf(comm, "  the name of a case with options of its own:\n"));
    PetscCall(PetscPrintf(comm, "    %.*s: %s\n", (int)KeyLength(section) - 5, section + 5, Title(section)));
  }
  PetscCall(PetscPrintf(
      comm,
      "  %-10s every option\n  %-10s one option, or all whose names hold this word: -help %s\n"
      "  %-10s the table of all options in Markdown\n"
      "  %-10s PETSc's own help, with the solver options of this command line\n\n"
      "-version prints the versions of the program and of what it stands on.\n"
      "Options can also stand in files (-options_file FILE, plain or YAML) and in PETSC_OPTIONS; of an option\n"
      "given twice the last counts, and the command line counts more than PETSC_OPTIONS.\n"
      "Exit status: 0 done, 2 bad input, 3 the run failed, 4 trouble with a file, 5 ended early by a signal or\n"
      "-wall_time, 1 anything else.\n",
      "all", "NAME", PgKnownFind("dem_k_n") ? "dem_k" : "plot_f", "markdown", "petsc"));
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintSections(MPI_Comm comm, const PgProgram *program, PetscBool table)
{
  PetscFunctionBeginUser;
  for (int cases = 0; cases < 2; cases++) { /* they come last */
    for (PetscInt i = 0; i < PgKnownCount(); i++) {
      const char *section = PgKnownAt(i)->section;
      if (!IsFirst(i) || IsCase(section) != (PetscBool)cases) continue;
      /* the table of a program holds its own options; others are in theirs */
      if (table && program->own && !SameKey(section, program->own)) continue;
      PetscCall(PrintSection(comm, section, table));
    }
  }
  PetscFunctionReturn(0);
}

/* Whether this is among what an option needs. */
static PetscBool Needs(const PgKnownOption *o, const char needs[])
{
  const char *at = strstr(o->needs, needs);
  return (PetscBool)(at && (!at[strlen(needs)] || at[strlen(needs)] == ' '));
}

/* A section, the options of a case, or options whose names hold the topic. */
static PetscErrorCode PrintTopic(MPI_Comm comm)
{
  const char          *word = topic[0] == '-' ? topic + 1 : topic;
  const PgKnownOption *nearest;
  PetscInt             found = 0;
  char                 needs[sizeof topic + 8];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < PgKnownCount(); i++) {
    if (!IsFirst(i) || !Names(PgKnownAt(i)->section)) continue;
    PetscCall(PrintSection(comm, PgKnownAt(i)->section, PETSC_FALSE));
    found++;
  }
  if (found) PetscFunctionReturn(0);
  (void)snprintf(needs, sizeof needs, "-case %s", topic);
  for (PetscInt i = 0; i < PgKnownCount(); i++) {
    const PgKnownOption *o = PgKnownAt(i);
    if (!Needs(o, needs)) continue;
    PetscCall(PrintOption(comm, o, PETSC_FALSE));
    found++;
  }
  if (found) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < PgKnownCount(); i++) {
    const PgKnownOption *o = PgKnownAt(i);
    if (!o->section[0] || !strstr(o->name, word)) continue;
    PetscCall(PrintOption(comm, o, PETSC_TRUE));
    found++;
  }
  if (found) PetscFunctionReturn(0);
  nearest = PgKnownNearest(word);
  PgInputCheck(!nearest, comm, "option -help: there is no section and no option '%s'; did you mean %s?", topic,
               nearest->name);
  PgInputError(comm, "option -help: there is no section and no option '%s'; -help alone lists the sections", topic);
}

PetscErrorCode PgHelp(MPI_Comm comm, const PgProgram *program, PetscBool *done)
{
  PetscFunctionBeginUser;
  *done = (PetscBool)(help_asked || version_asked);
  PgOptionsSetCollector(program->collect);
  if (version_asked) PetscCall(PgVersionPrint(comm, program->name));
  if (!help_asked) PetscFunctionReturn(0);
  PetscCall(PgCollectAll(comm, program->collect));
  if (!topic[0] || !strcmp(topic, "intro"))
    PetscCall(PrintShort(comm, program));
  else if (!strcmp(topic, "all") || !strcmp(topic, "markdown"))
    PetscCall(PrintSections(comm, program, (PetscBool)!strcmp(topic, "markdown")));
  else
    PetscCall(PrintTopic(comm));
  PetscFunctionReturn(0);
}
