/* Start, end and errors: one readable message and an exit status that says what kind of trouble it was. */
#include "baseimpl.h"
#include <signal.h>
#include <stdarg.h>

static PetscBool collective_error     = PETSC_FALSE; /* the error was reported by PgReport(): every rank has it */
static PetscBool print_stack          = PETSC_FALSE;
static int       status_without_error = 0;

static void PrintError(const char *message)
{
  PgTerminalClear();
  (void)fflush(stdout);
  (void)fprintf(stderr, "porograin: error: %s\n", message);
  (void)fflush(stderr);
}

/* PETSc's own handler prints a call stack for a misspelt option; this one prints the message. */
static PetscErrorCode HandleError(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                                  PetscErrorType type, const char *message, void *context)
{
  PetscMPIInt rank = 0, world = 0;
  char        text[PETSC_MAX_PATH_LEN + 1024];

  (void)context;
  (void)MPI_Comm_rank(PETSC_COMM_WORLD, &world);
  if (comm != MPI_COMM_NULL) (void)MPI_Comm_rank(comm, &rank);
  if (type == PETSC_ERROR_INITIAL && rank == 0) {
    if (world == 0)
      (void)PetscSNPrintf(text, sizeof text, "%s (%s, %s:%d)", message, function, file, line);
    else
      (void)PetscSNPrintf(text, sizeof text, "rank %d: %s (%s, %s:%d)", world, message, function, file, line);
    PrintError(text);
  } else if (print_stack && rank == 0) {
    (void)fprintf(stderr, "  called from %s(), %s:%d\n", function, file, line);
  }
  return code;
}

PetscErrorCode PgReport(MPI_Comm comm, const char format[], ...)
{
  PetscMPIInt rank;
  char        text[4096];
  size_t      length;
  va_list     arguments;

  PetscFunctionBeginUser;
  collective_error = PETSC_TRUE;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) {
    va_start(arguments, format);
    PetscCall(PetscVSNPrintf(text, sizeof text, format, &length, arguments));
    va_end(arguments);
    PrintError(text);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgInitialize(int *argc, char ***argv, const char about[])
{
  PetscFunctionBeginUser;
  PgTerminalLookAround();
  PetscCall(PetscInitialize(argc, argv, NULL, about));
  PetscCall(PetscPushErrorHandler(HandleError, NULL));
  /* Output into a closed pipe is reported by the write that failed, not by a signal with pages of text. */
  (void)signal(SIGPIPE, SIG_IGN);
  (void)signal(SIGXFSZ, SIG_IGN); /* the same for a limit on the size of files */
  (void)signal(SIGTERM, SIG_DFL); /* PETSc's own handler prints pages; PgSimulationRun() has a better one */
  PetscCall(PetscOptionsHasName(NULL, NULL, "-error_stack", &print_stack));
  PetscCall(PgStagesRegister());
  PetscFunctionReturn(0);
}

PetscErrorCode PgRefuseStrayArguments(int argc, char *argv[])
{
  PetscFunctionBeginUser;
  for (int i = 1; i < argc; i++) {
    const PetscBool option = (PetscBool)(argv[i][0] == '-' && (argv[i][1] < '0' || argv[i][1] > '9') &&
                                         argv[i][1] != '.');
    const PetscBool value  = (PetscBool)(!option && i > 1 && argv[i - 1][0] == '-');
    PgInputCheck(
        option || value, PETSC_COMM_WORLD,
        "argument '%s' belongs to no option: options start with '-', a list of values has commas and no blanks",
        argv[i]);
  }
  PetscFunctionReturn(0);
}

static int ExitStatus(PetscErrorCode err)
{
  switch (err) {
  case 0:
    return 0;
  case PETSC_ERR_USER_INPUT:
  case PETSC_ERR_ARG_UNKNOWN_TYPE:
  case PETSC_ERR_ARG_WRONG:
  case PETSC_ERR_ARG_OUTOFRANGE:
    return 2;
  case PETSC_ERR_NOT_CONVERGED:
  case PETSC_ERR_CONV_FAILED:
  case PETSC_ERR_FP:
    return 3;
  case PETSC_ERR_FILE_OPEN:
  case PETSC_ERR_FILE_READ:
  case PETSC_ERR_FILE_WRITE:
  case PETSC_ERR_FILE_UNEXPECTED:
    return 4;
  default:
    return 1;
  }
}

PetscBool PgErrorIsCollective(void) { return collective_error; }

void PgSetExitStatus(int status) { status_without_error = status; }

int PgFinalize(PetscErrorCode err)
{
  const int   status = err ? ExitStatus(err) : status_without_error;
  PetscMPIInt size   = 1;

  PgOptionsForget();
  PgTerminalEnd();
  (void)PetscPopErrorHandler();
  (void)MPI_Comm_size(PETSC_COMM_WORLD, &size);
  /* An error that only some ranks have met leaves the others waiting in a collective call. */
  if (err && size > 1 && !collective_error) (void)MPI_Abort(PETSC_COMM_WORLD, status);
  if (PetscFinalize() && !err) return 1;
  return status;
}
