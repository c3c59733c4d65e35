/* A growing string. */
#include "ioimpl.h"
#include <stdarg.h>
#include <stdlib.h>

/* Room for `more` characters and the end mark. */
static PetscErrorCode MakeRoom(PgText *text, size_t more)
{
  PetscFunctionBeginUser;
  if (text->used + more + 1 > text->room) {
    const size_t room = 2 * (text->used + more + 1);
    PetscCall(PetscRealloc(room, &text->string));
    text->room = room;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgTextAppend(PgText *text, const char string[])
{
  const size_t length = strlen(string);

  PetscFunctionBeginUser;
  PetscCall(MakeRoom(text, length));
  PetscCall(PetscMemcpy(text->string + text->used, string, length + 1));
  text->used += length;
  PetscFunctionReturn(0);
}

PetscErrorCode PgTextPrint(PgText *text, const char format[], ...)
{
  char    line[1024];
  int     length;
  va_list arguments;

  PetscFunctionBeginUser;
  va_start(arguments, format);
  length = vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  PetscCheck(length >= 0 && length < (int)sizeof line, PETSC_COMM_SELF, PETSC_ERR_PLIB, "line too long");
  PetscCall(PgTextAppend(text, line));
  PetscFunctionReturn(0);
}

PetscErrorCode PgTextReal(PgText *text, PetscReal value)
{
  char number[32];

  PetscFunctionBeginUser;
  for (int digits = 15; digits <= 17; digits++) {
    (void)snprintf(number, sizeof number, "%.*g", digits, (double)value);
    if (strtod(number, NULL) == (double)value) break;
  }
  PetscCall(PgTextAppend(text, number));
  PetscFunctionReturn(0);
}

PetscErrorCode PgTextAppendXml(PgText *text, const char string[])
{
  PetscFunctionBeginUser;
  for (const char *c = string; *c; c++) {
    const char plain[2] = {*c, 0};
    PetscCall(PgTextAppend(text, *c == '&'   ? "&amp;"
                                 : *c == '<' ? "&lt;"
                                 : *c == '>' ? "&gt;"
                                 : *c == '"' ? "&quot;"
                                             : plain));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgTextBroadcast(PgText *text, MPI_Comm comm)
{
  PetscMPIInt rank, length;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscMPIIntCast((PetscInt)text->used, &length));
  PetscCallMPI(MPI_Bcast(&length, 1, MPI_INT, 0, comm));
  if (rank) text->used = 0;
  PetscCall(MakeRoom(text, rank ? (size_t)length : 0));
  PetscCallMPI(MPI_Bcast(text->string, length, MPI_CHAR, 0, comm));
  text->used           = (size_t)length;
  text->string[length] = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode PgTextDestroy(PgText *text)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(text->string));
  text->used = text->room = 0;
  PetscFunctionReturn(0);
}
