/* /provenance: what made the file. Texts come from rank 0, since HDF5 wants the same on every rank. */
#include "ioimpl.h"
#include <time.h>
#include <unistd.h>
#include <xxhash.h>

/* The build may define the commit it was made from. */
#if !defined(PG_GIT_REVISION)
  #define PG_GIT_REVISION "unknown"
#endif

static const char GROUP[] = "/provenance";

static PetscErrorCode WriteFromRankZero(PgHdf *hdf, const char name[], PgText *text)
{
  PetscFunctionBeginUser;
  PetscCall(PgTextBroadcast(text, hdf->comm));
  PetscCall(PgHdfText(hdf, GROUP, name, text->string));
  text->used = 0;
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteDate(PgHdf *hdf, const char name[], PgText *text)
{
  char         date[32] = "";
  const time_t now      = time(NULL);
  struct tm    utc;

  PetscFunctionBeginUser;
  if (gmtime_r(&now, &utc)) (void)strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", &utc);
  PetscCall(PgTextAppend(text, date));
  PetscCall(WriteFromRankZero(hdf, name, text));
  PetscFunctionReturn(0);
}

/* Arguments with blanks or other signs of the shell are quoted, so that the line can be run again. */
static PetscErrorCode AppendArgument(PgText *text, const char argument[])
{
  PetscFunctionBeginUser;
  if (argument[0] && !strpbrk(argument, " \t\n'\"\\$`*?[]{}()<>|&;#~!")) {
    PetscCall(PgTextAppend(text, argument));
    PetscFunctionReturn(0);
  }
  PetscCall(PgTextAppend(text, "'"));
  for (const char *c = argument; *c; c++) {
    const char plain[2] = {*c, 0};
    PetscCall(PgTextAppend(text, *c == '\'' ? "'\\''" : plain));
  }
  PetscCall(PgTextAppend(text, "'"));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteCommandLine(PgHdf *hdf, PgText *text)
{
  int    count;
  char **argument;

  PetscFunctionBeginUser;
  PetscCall(PetscGetArgs(&count, &argument));
  for (int k = 0; k < count; k++) {
    if (k) PetscCall(PgTextAppend(text, " "));
    PetscCall(AppendArgument(text, argument[k]));
  }
  PetscCall(WriteFromRankZero(hdf, "command_line", text));
  PetscFunctionReturn(0);
}

/* PETSc hands out all options as one line "-name value -name value ...". A name starts with a letter, so
   that a negative number is a value. Cuts the line into one string for each option. */
static PetscErrorCode GetOptions(char **line, PetscInt *count, char ***option)
{
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetAll(NULL, line));
  for (int pass = 0; pass < 2; pass++) {
    n = 0;
    for (char *c = *line; *c; c++) {
      const char start = c[1] == '-' ? c[2] : c[1];
      if (*c != '-' || !((start >= 'a' && start <= 'z') || (start >= 'A' && start <= 'Z'))) continue;
      if (c > *line && c[-1] != ' ' && c[-1] != 0) continue;
      if (pass) {
        (*option)[n] = c;
        if (c > *line) c[-1] = 0;
      }
      n++;
    }
    if (!pass) PetscCall(PetscMalloc1(n, option));
  }
  for (PetscInt k = 0; k < n; k++) { /* the blank after the value */
    const size_t length = strlen((*option)[k]);
    if (length && (*option)[k][length - 1] == ' ') (*option)[k][length - 1] = 0;
  }
  *count = n;
  PetscFunctionReturn(0);
}

static PetscBool IsAmong(const char option[], PetscInt count, char **name)
{
  for (PetscInt k = 0; k < count; k++) {
    const size_t length = strlen(name[k]);
    if (strncmp(option + 1, name[k], length) == 0 && (option[length + 1] == ' ' || option[length + 1] == 0))
      return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* The options, one on a line, that are among the `count` unused ones of name[] (unused), or that are not. */
static PetscErrorCode WriteOptions(PgHdf *hdf, const char attribute[], PetscBool unused, PetscInt count, char **name,
                                   PgText *text)
{
  char    *line, **option;
  PetscInt options = 0;

  PetscFunctionBeginUser;
  PetscCall(GetOptions(&line, &options, &option));
  for (PetscInt k = 0; k < options; k++) {
    if (IsAmong(option[k], count, name) != unused) continue;
    if (text->used) PetscCall(PgTextAppend(text, "\n"));
    PetscCall(PgTextAppend(text, option[k]));
  }
  PetscCall(PetscFree(option));
  PetscCall(PetscFree(line));
  PetscCall(WriteFromRankZero(hdf, attribute, text));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteVersions(PgHdf *hdf, PgText *text)
{
  unsigned    major, minor, release;
  char        mpi[MPI_MAX_LIBRARY_VERSION_STRING];
  PetscMPIInt size, length;
  PetscInt    petsc[3];

  PetscFunctionBeginUser;
  PetscCall(PgHdfText(hdf, GROUP, "program", "porograin"));
  PetscCall(PgHdfText(hdf, GROUP, "program_version", PG_VERSION));
  PetscCall(PgHdfText(hdf, GROUP, "git_revision", PG_GIT_REVISION));
  PetscCall(PetscGetVersionNumber(&petsc[0], &petsc[1], &petsc[2], NULL));
  PetscCall(PgTextPrint(text, "%d.%d.%d", (int)petsc[0], (int)petsc[1], (int)petsc[2]));
  PetscCall(WriteFromRankZero(hdf, "petsc_version", text));
  (void)H5get_libversion(&major, &minor, &release);
  PetscCall(PgTextPrint(text, "%u.%u.%u", major, minor, release));
  PetscCall(WriteFromRankZero(hdf, "hdf5_version", text));
  PetscCallMPI(MPI_Get_library_version(mpi, &length));
  PetscCall(PgTextAppend(text, mpi));
  PetscCall(WriteFromRankZero(hdf, "mpi_version", text));
  PetscCallMPI(MPI_Comm_size(hdf->comm, &size));
  PetscCall(PgHdfInt(hdf, GROUP, "ranks", size));
  PetscFunctionReturn(0);
}

PetscErrorCode PgProvenanceStart(PgHdf *hdf)
{
  PgText text = {NULL, 0, 0};
  char   host[256];

  PetscFunctionBeginUser;
  PetscCall(PgHdfGroup(hdf, GROUP));
  PetscCall(WriteVersions(hdf, &text));
  PetscCall(WriteDate(hdf, "date", &text));
  PetscCall(PetscGetHostName(host, sizeof host));
  PetscCall(PgTextAppend(&text, host));
  PetscCall(WriteFromRankZero(hdf, "hostname", &text));
  PetscCall(WriteCommandLine(hdf, &text));
  PetscCall(WriteOptions(hdf, "options", PETSC_FALSE, 0, NULL, &text));
  PetscCall(PgTextDestroy(&text));
  PetscFunctionReturn(0);
}

PetscErrorCode PgProvenanceFinish(PgHdf *hdf)
{
  PgText   text = {NULL, 0, 0};
  char   **name, **value;
  PetscInt count;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsLeftGet(NULL, &count, &name, &value));
  PetscCall(WriteOptions(hdf, "options_used", PETSC_FALSE, count, name, &text));
  PetscCall(WriteOptions(hdf, "options_unused", PETSC_TRUE, count, name, &text));
  PetscCall(PetscOptionsLeftRestore(NULL, &count, &name, &value));
  PetscCall(WriteDate(hdf, "date_finished", &text));
  PetscCall(PgTextDestroy(&text));
  PetscFunctionReturn(0);
}

PetscErrorCode PgProvenanceRestart(PgHdf *hdf, const char from[], PetscInt rows, PetscInt snapshots)
{
  PgText text = {NULL, 0, 0};

  PetscFunctionBeginUser;
  PetscCall(PgTextPrint(&text, "%s, with %lld rows and %lld snapshots", from, (long long)rows, (long long)snapshots));
  PetscCall(WriteFromRankZero(hdf, "restarted_from", &text));
  PetscCall(WriteDate(hdf, "date_restarted", &text));
  PetscCall(WriteCommandLine(hdf, &text));
  PetscCall(PgTextDestroy(&text));
  PetscFunctionReturn(0);
}

/* A name for a run that no other run has: when, where and by which process it was started. */
PetscErrorCode PgRunName(MPI_Comm comm, char name[PG_RUN_NAME])
{
  struct {
    struct timespec now;
    pid_t           process;
    char            host[256];
  } seed;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscMemzero(&seed, sizeof seed));
  if (rank == 0) {
    (void)clock_gettime(CLOCK_REALTIME, &seed.now);
    seed.process = getpid();
    PetscCall(PetscGetHostName(seed.host, sizeof seed.host));
  }
  (void)snprintf(name, PG_RUN_NAME, "%016llx", (unsigned long long)XXH64(&seed, sizeof seed, 0));
  PetscCallMPI(MPI_Bcast(name, PG_RUN_NAME, MPI_CHAR, 0, comm));
  PetscFunctionReturn(0);
}
