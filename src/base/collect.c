/* Making objects tell the names of their options: PETSc's do so by printing help, which is caught here. */
#include "baseimpl.h"
#include <stdio.h>
#include <string.h>

static PetscBool without_run = PETSC_FALSE; /* what is met now is not read by this run */

PetscBool PgIsCollecting(void) { return without_run; }

/* "(one of) a b c (Where)": the words; lists of words within one line. */
static void Words(const char line[], char words[2048])
{
  const char *at = strstr(line, "one of)"), *end;

  words[0] = '\0';
  if (!at) return;
  at += strlen("one of)");
  end = strstr(at, " (");
  if (!end) end = at + strlen(at);
  while (at < end) {
    const size_t length = strcspn(at, " \n");
    if (at + length > end) break;
    if (length)
      (void)snprintf(words + strlen(words), 2048 - strlen(words), "%s%.*s", words[0] ? ", " : "", (int)length, at);
    at += length + 1;
  }
}

/* A line "  -name <now 5 : formerly 5>: text": the name, and the words that it may be. */
static PetscErrorCode Take(const char line[])
{
  const size_t  indent = strspn(line, " ");
  size_t        length;
  char          name[256], words[2048];
  PgKnownOption option = {name, "", "", "", "", "", "", words, PETSC_FALSE};

  PetscFunctionBeginUser;
  line += indent;
  if (line[0] != '-' || line[1] == ' ' || line[1] == '-') PetscFunctionReturn(0);
  length = strcspn(line, " :<\n");
  if (length >= sizeof name) PetscFunctionReturn(0);
  (void)snprintf(name, sizeof name, "%.*s", (int)length, line);
  Words(line + length, words);
  option.active = (PetscBool)!without_run;
  PetscCall(PgKnownAdd(&option));
  PetscFunctionReturn(0);
}

/* Stands in for PetscHelpPrintf(). */
static PetscErrorCode TakeHelp(MPI_Comm comm, const char format[], ...)
{
  char    text[8192];
  va_list arguments;

  PetscFunctionBeginUser;
  (void)comm;
  va_start(arguments, format);
  (void)vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  PetscCall(Take(text));
  PetscFunctionReturn(0);
}

/* PETSc prints most of its help through PetscHelpPrintf, but lists of types straight to the terminal, in pieces: they
   are put together to lines. */
static char           piece[8192];
static PetscErrorCode TakePiece(FILE *file, const char format[], va_list arguments)
{
  size_t used = strlen(piece);
  char  *end;

  PetscFunctionBeginUser;
  (void)file;
  (void)vsnprintf(piece + used, sizeof piece - used, format, arguments);
  while ((end = strchr(piece, '\n'))) {
    *end = '\0';
    PetscCall(Take(piece));
    (void)memmove(piece, end + 1, strlen(end + 1) + 1);
  }
  if (strlen(piece) > sizeof piece / 2) piece[0] = '\0';
  PetscFunctionReturn(0);
}

PetscErrorCode PgCollectHelp(PetscErrorCode (*act)(void *), void *context)
{
  PetscErrorCode (*print)(MPI_Comm, const char[], ...)           = PetscHelpPrintf;
  PetscErrorCode (*print_to_file)(FILE *, const char[], va_list) = PetscVFPrintf;
  PetscErrorCode err;
  PetscBool      help;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsHasHelp(NULL, &help));
  if (!help) PetscCall(PetscOptionsSetValue(NULL, "-help", NULL));
  piece[0]        = '\0';
  PetscHelpPrintf = TakeHelp;
  PetscVFPrintf   = TakePiece;
  err             = (*act)(context);
  PetscHelpPrintf = print;
  PetscVFPrintf   = print_to_file;
  if (!help) PetscCall(PetscOptionsClearValue(NULL, "-help"));
  PetscFunctionReturn(err);
}

typedef struct {
  MPI_Comm comm;
  PetscErrorCode (*collect)(MPI_Comm);
} Collection;

static PetscErrorCode Call(void *context)
{
  Collection *c = (Collection *)context;

  PetscFunctionBeginUser;
  PetscCall((*c->collect)(c->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode PgCollectAll(MPI_Comm comm, PetscErrorCode (*collect)(MPI_Comm))
{
  Collection c = {comm, collect};

  PetscFunctionBeginUser;
  PetscCall(PgOptionsApart(Call, &c));
  PetscFunctionReturn(0);
}

PetscErrorCode PgOptionsApart(PetscErrorCode (*act)(void *), void *context)
{
  PetscOptions    empty;
  const PetscBool before = without_run;
  PetscErrorCode  err;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsCreate(&empty));
  PetscCall(PetscOptionsPush(empty));
  without_run = PETSC_TRUE;
  err         = PgCollectHelp(act, context);
  without_run = before;
  PetscCall(PetscOptionsPop());
  PetscCall(PetscOptionsDestroy(&empty));
  PetscFunctionReturn(err);
}
