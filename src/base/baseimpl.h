/* What the files of this room share. */
#pragma once

#include <porograin/base.h>

PETSC_INTERN PetscErrorCode PgStagesRegister(void);
PETSC_INTERN void           PgTerminalLookAround(void);

/* error.c: the handler that prints one message where PETSc's prints a call stack */
PETSC_INTERN PetscErrorCode PgHandleError(MPI_Comm comm, int line, const char *function, const char *file,
                                          PetscErrorCode code, PetscErrorType type, const char *message, void *context);
/* version.c */
PETSC_INTERN PetscErrorCode PgVersionPrint(MPI_Comm comm, const char program[]);

/* ---- known.c: the memory of every option met ---- */

typedef struct {
  const char *name, *initial, *unit, *text;
  const char *allowed; /* bounds or words, as shown to a user; may be empty */
  const char *section; /* "key: title" of the block that reads it; empty for an option of PETSc */
  const char *needs;   /* what a run must be given to read it, empty: nothing */
  const char *words;   /* that PETSc's help names for it; NULL or empty: none */
  PetscBool   active;  /* met by this run, and not only while options were collected */
} PgKnownOption;

/* Copies *option, unless one of this name is known already. */
PETSC_INTERN PetscErrorCode       PgKnownAdd(const PgKnownOption *option);
PETSC_INTERN PetscInt             PgKnownCount(void);
PETSC_INTERN const PgKnownOption *PgKnownAt(PetscInt i);
/* Names with or without their '-'. NULL: there is none. A name that ends in '*' stands for all that begin so. */
PETSC_INTERN const PgKnownOption *PgKnownFind(const char name[]);
PETSC_INTERN const PgKnownOption *PgKnownPattern(const char name[]);
PETSC_INTERN const PgKnownOption *PgKnownNearest(const char name[]);
PETSC_INTERN void                 PgKnownForget(void);
/* Edit distance with neighbouring letters swapped counted as one edit. */
PETSC_INTERN PetscInt PgDistance(const char a[], const char b[]);

/* ---- collect.c: making objects tell the names of their options ---- */

/* Whether objects are made only to tell their options. */
PETSC_INTERN PetscBool PgIsCollecting(void);
/* Calls act(context) while what PETSc prints as -help goes into the memory of options. */
PETSC_INTERN PetscErrorCode PgCollectHelp(PetscErrorCode (*act)(void *), void *context);
/* The same for all that a program may read, with an empty set of options, as if the user had given none. */
PETSC_INTERN PetscErrorCode PgCollectAll(MPI_Comm comm, PetscErrorCode (*collect)(MPI_Comm));

/* unknown.c: what to call for the options that other runs read; may be NULL. */
PETSC_INTERN void PgOptionsSetCollector(PetscErrorCode (*collect)(MPI_Comm));

/* ---- sources.c: where an option was given ---- */

/* Who wins: the larger one. Files count up from PG_LAYER_FILE, and one that names others stands on top of them; what nobody
   has seen coming (a YAML text, a call) counts as given on the command line. */
enum {
  PG_LAYER_PROGRAM = -1, /* not by the user, nor by a case for him: to be left alone */
  PG_LAYER_PETSCRC,
  PG_LAYER_ENVIRONMENT,
  PG_LAYER_FILE,
  PG_LAYER_COMMAND_LINE = 1000000
};
/* Reads what the user has given once more; valid until PgSourcesEnd(). Collective. */
PETSC_INTERN PetscErrorCode PgSourcesBegin(void);
PETSC_INTERN PetscErrorCode PgSourcesEnd(void);
/* The layer of an option that is set, and in words where that is (may be NULL); what a case sets counts as given with
   -case. */
PETSC_INTERN PetscErrorCode PgSourceOf(const char name[], int *layer, const char **where);
/* Whether neither the program nor a case has set it. */
PETSC_INTERN PetscBool PgIsOfUser(const char name[]);

/* ---- effect.c: options without effect ---- */

/* Whether `name` may be idle because of `by`, which was given later than the file that `name` stands in; then it will be
   named by PgIdleReport(). Between PgSourcesBegin() and PgSourcesEnd(). */
PETSC_INTERN PetscErrorCode PgIdleBecause(const char name[], const char value[], const char by[], const char by_value[],
                                          PetscBool *fine);
/* Prints the line of warning, unless the run ends anyway, and begins a new one. Collective. */
PETSC_INTERN PetscErrorCode PgIdleReport(MPI_Comm comm, PetscBool print);
/* Reports what has no effect by the rules and adds to *refused; `spoken`, to be freed with its `count` names: all of which
   something was said or will be. Between PgSourcesBegin() and PgSourcesEnd(). Collective. */
PETSC_INTERN PetscErrorCode PgEffectCheck(MPI_Comm comm, const PgOptionRules *rules, PetscInt *refused, char ***spoken,
                                          PetscInt *count);

/* ---- optionfiles.c ---- */

/* As PETSc tells an option from a value: -9.81 and -inf are values. */
PETSC_INTERN PetscBool PgIsOptionName(const char word[]);

/* Looks at the files that the command line, PETSC_OPTIONS and PETSc's own places name, before PETSc reads them: it
   would stop on one rank only, with pages of text. Returns 0 or a code of PETSc and the message. One rank calls it. */
PETSC_INTERN PetscErrorCode PgOptionFilesCheck(int argc, char *const argv[], char message[], size_t length);
/* The file and line of what PETSc's YAML reader does not understand; PETSc itself says neither. */
PETSC_INTERN PetscBool PgOptionFilesFindYaml(int argc, char *const argv[], char message[], size_t length);

/* The text of a plain file of options, to be freed with PetscFree(); NULL: it is in YAML, or has a name that PETSc replaces.
   Collective. */
PETSC_INTERN PetscErrorCode PgOptionFileRead(const char given[], PetscBool yaml, char **text);
/* The words of the next line that has any: an option and its value (NULL: none), or alias and two names; false at the end.
   *rest starts as the text, which is taken apart. */
PETSC_INTERN PetscBool PgOptionFileNext(char **rest, char *word[3]);

/* ---- shipped.c ---- */

/* Whether `name` is a file that comes with the program, beside it as it was installed or built, and where. */
PETSC_INTERN PetscBool PgShippedFind(const char name[], char file[], size_t size);

/* ---- help.c ---- */

/* Takes -help [TOPIC] and -version out of the arguments. */
PETSC_INTERN void PgHelpTakeArguments(int *argc, char ***argv);
PETSC_INTERN void PgHelpForget(void);
