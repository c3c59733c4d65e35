/* Start, end and errors: one readable message and an exit status that says what kind of trouble it was. */
#include "baseimpl.h"
#include <hdf5.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static PetscBool collective_error     = PETSC_FALSE; /* the error was reported by PgReport(): every rank has it */
static PetscBool print_stack          = PETSC_FALSE;
static PetscBool began_mpi            = PETSC_FALSE;
static int       status_without_error = 0;

/* Which of our programs this is; other programs that use the library speak for it. */
static void PrintError(const char *message)
{
  static const char library[]                = "porograin";
  char              path[PETSC_MAX_PATH_LEN] = "";
  const char       *name;

  (void)PetscGetProgramName(path, sizeof path);
  name = strrchr(path, '/') ? strrchr(path, '/') + 1 : path;
  if (strncmp(name, library, strlen(library))) name = library;
  PgTerminalClear();
  (void)fflush(stdout);
  (void)fprintf(stderr, "%s: error: %s\n", name, message);
  (void)fflush(stderr);
}

/* PETSc's own handler prints a call stack for a misspelt option; this one prints the message. */
PetscErrorCode PgHandleError(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
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

static PetscErrorCode Report(MPI_Comm comm, const char cause[], const char after[], const char format[],
                             va_list arguments)
{
  PetscMPIInt  rank;
  char         text[4096];
  const size_t used = strlen(cause);

  PetscFunctionBeginUser;
  collective_error = PETSC_TRUE;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) {
    (void)snprintf(text, sizeof text, "%s", cause);
    (void)vsnprintf(text + used, sizeof text - used, format, arguments);
    (void)snprintf(text + strlen(text), sizeof text - strlen(text), "%s", after);
    PrintError(text);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgReport(MPI_Comm comm, const char format[], ...)
{
  PetscErrorCode err;
  va_list        arguments;

  PetscFunctionBeginUser;
  va_start(arguments, format);
  err = Report(comm, "", "", format, arguments);
  va_end(arguments);
  PetscFunctionReturn(err);
}

static PetscErrorCode (*find_cause)(void *, char[], size_t) = NULL;
static void *cause_context                                  = NULL;

PetscErrorCode PgSetCause(PetscErrorCode (*find)(void *context, char cause[], size_t size), void *context)
{
  PetscFunctionBeginUser;
  find_cause    = find;
  cause_context = context;
  PetscFunctionReturn(0);
}

static PetscInt  now_step = -1; /* none */
static PetscReal now_time;

void PgSetNow(PetscInt step, PetscReal time)
{
  now_step = step;
  now_time = time;
}

PetscErrorCode PgReportRun(MPI_Comm comm, const char format[], ...)
{
  PetscErrorCode err;
  va_list        arguments;
  char           cause[2048] = "", now[96] = "";

  PetscFunctionBeginUser;
  if (find_cause) PetscCall((*find_cause)(cause_context, cause, sizeof cause - 32));
  if (cause[0]) (void)snprintf(cause + strlen(cause), 32, ". It shows as: ");
  if (now_step >= 0)
    (void)snprintf(now, sizeof now, "; in step %" PetscInt_FMT ", time %g s", now_step, (double)now_time);
  va_start(arguments, format);
  err = Report(comm, cause, now, format, arguments);
  va_end(arguments);
  PetscFunctionReturn(err);
}

static PetscBool petsc_runs = PETSC_FALSE;
static char      refusal[512]; /* what PETSc says when it does not start */

/* Stays for good: it is there before PETSc, whose own handler would print pages and, on other ranks, abort. */
static PetscErrorCode HandleAnyError(MPI_Comm comm, int line, const char *function, const char *file,
                                     PetscErrorCode code, PetscErrorType type, const char *message, void *context)
{
  if (petsc_runs) return PgHandleError(comm, line, function, file, code, type, message, context);
  if (type == PETSC_ERROR_INITIAL) (void)snprintf(refusal, sizeof refusal, "%s", message ? message : "");
  return code;
}

/* One message of rank 0 of all, before PETSc is there. */
static PetscErrorCode RefuseToStart(PetscErrorCode code, const char message[])
{
  int rank = 0;

  (void)MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank == 0) PrintError(message);
  return code;
}

static PetscErrorCode StartPetsc(int *argc, char ***argv, const char about[])
{
  static PetscBool pushed = PETSC_FALSE;
  PetscErrorCode   err;
  char             message[1024] = "PETSc does not start";
  int              rank          = 0;

  (void)MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  refusal[0] = '\0';
  if (!pushed) (void)PetscPushErrorHandler(HandleAnyError, NULL);
  pushed     = PETSC_TRUE;
  err        = PetscInitialize(argc, argv, NULL, about);
  petsc_runs = (PetscBool)!err;
  if (!err) return 0;
  if (strstr(refusal, "YAML")) {
    collective_error = PETSC_TRUE; /* every rank has read it */
    if (rank != 0 || !argc || !argv || !PgOptionFilesFindYaml(*argc, *argv, message, sizeof message))
      (void)snprintf(message, sizeof message, "options: %s", refusal);
    return RefuseToStart(PETSC_ERR_USER_INPUT, message);
  }
  if (refusal[0]) (void)snprintf(message, sizeof message, "PETSc does not start: %s", refusal);
  for (int i = 1; argc && argv && i + 1 < *argc; i++) { /* PETSc quotes the value without its option */
    if ((*argv)[i][0] == '-' && strlen((*argv)[i + 1]) > 2 && strstr(refusal, (*argv)[i + 1]))
      (void)snprintf(message, sizeof message, "option %s: %s", (*argv)[i], refusal);
  }
  return RefuseToStart(err == PETSC_ERR_USER ? PETSC_ERR_USER_INPUT : err, message);
}

PetscErrorCode PgInitialize(int *argc, char ***argv, const char about[])
{
  char           message[2048] = "";
  int            began = 0, rank = 0;
  PetscErrorCode err = 0;

  PetscFunctionBeginUser;
  PgTerminalLookAround();
  /* HDF5 tidies up in MPI_Finalize() when it begins after MPI, or else when the program ends. After a file that could
     not be read or written its memory may be in disorder, and tidying up crashes: see EndMpi(). */
  (void)H5dont_atexit();
  (void)H5open();
  /* ahead of PETSc, so that all ranks can agree on what is wrong with files of options */
  (void)MPI_Initialized(&began);
  if (!began) {
    int provided;
    (void)MPI_Init_thread(argc, argv, MPI_THREAD_FUNNELED, &provided);
    began_mpi = PETSC_TRUE;
  }
  (void)MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  PgHelpTakeArguments(argc, argv);
  if (rank == 0 && argc && argv) err = PgOptionFilesCheck(*argc, *argv, message, sizeof message);
  (void)MPI_Bcast(&err, 1, MPI_INT, 0, MPI_COMM_WORLD);
  collective_error = (PetscBool)(err != 0);
  if (err) return RefuseToStart(err, message);
  err = StartPetsc(argc, argv, about);
  if (err) return err;
  /* Output into a closed pipe is reported by the write that failed, not by a signal with pages of text. */
  (void)signal(SIGPIPE, SIG_IGN);
  (void)signal(SIGXFSZ, SIG_IGN); /* the same for a limit on the size of files */
  (void)signal(SIGTERM, SIG_DFL); /* PETSc's own handler prints pages; PgSimulationRun() has a better one */
  PetscCall(PetscOptionsHasName(NULL, NULL, "-error_stack", &print_stack));
  PetscCall(PgStagesRegister());
  PetscFunctionReturn(0);
}

/* ".opts", ".yaml": what files of options are called. */
static PetscBool LooksLikeOptionFile(const char name[])
{
  const char *end = strrchr(name, '.');

  return (PetscBool)(end && (!strcmp(end, ".opts") || !strcmp(end, ".yaml")));
}

PetscErrorCode PgRefuseStrayArguments(int argc, char *argv[])
{
  PetscFunctionBeginUser;
  for (int i = 1; i < argc; i++) {
    const PetscBool option = (PetscBool)(argv[i][0] == '-' && (argv[i][1] < '0' || argv[i][1] > '9') &&
                                         argv[i][1] != '.');
    const PetscBool value  = (PetscBool)(!option && i > 1 && argv[i - 1][0] == '-');
    PgInputCheck(option || value || !LooksLikeOptionFile(argv[i]), PETSC_COMM_WORLD,
                 "argument '%s' belongs to no option; did you mean -options_file %s?", argv[i], argv[i]);
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

static int EndMpi(int status)
{
  if (began_mpi && !status) (void)H5close();
  if (began_mpi) (void)MPI_Finalize();
  began_mpi = PETSC_FALSE;
  return status;
}

int PgFinalize(PetscErrorCode err)
{
  const int   status  = err ? ExitStatus(err) : status_without_error;
  PetscMPIInt size    = 1;
  PetscBool   started = PETSC_FALSE;

  (void)PetscInitialized(&started);
  if (started) PgKnownForget();
  PgTerminalEnd();
  PgHelpForget();
  (void)MPI_Comm_size(MPI_COMM_WORLD, &size);
  /* An error that only some ranks have met leaves the others waiting in a collective call. */
  if (err && size > 1 && !collective_error) (void)MPI_Abort(MPI_COMM_WORLD, status);
  if (started && PetscFinalize() && !err) return EndMpi(1);
  petsc_runs = PETSC_FALSE;
  return EndMpi(status);
}
