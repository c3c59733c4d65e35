/* Clocks, medians, and calls that may fail without ending the study. */
#include "studyimpl.h"
#include <stdlib.h>
#include <sys/resource.h>

PetscErrorCode PgClock(MPI_Comm comm, PetscReal *seconds)
{
  PetscMPIInt   size;
  struct rusage r;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  if (size > 1) {
    PetscCallMPI(MPI_Barrier(comm));
    *seconds = MPI_Wtime();
    PetscFunctionReturn(0);
  }
  (void)getrusage(RUSAGE_SELF, &r);
  *seconds = (PetscReal)(r.ru_utime.tv_sec + r.ru_stime.tv_sec) +
             1e-6 * (PetscReal)(r.ru_utime.tv_usec + r.ru_stime.tv_usec);
  PetscFunctionReturn(0);
}

PetscErrorCode PgClockSince(MPI_Comm comm, PetscReal start, PetscReal *seconds)
{
  PetscReal now;

  PetscFunctionBeginUser;
  PetscCall(PgClock(comm, &now));
  *seconds = now - start;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, seconds, 1, MPIU_REAL, MPIU_MAX, comm));
  PetscFunctionReturn(0);
}

static int Compare(const void *a, const void *b)
{
  const PetscReal x = *(const PetscReal *)a, y = *(const PetscReal *)b;
  return (x > y) - (x < y);
}

PetscReal PgMedian(PetscInt n, PetscReal value[])
{
  if (n < 1) return PG_TABLE_EMPTY;
  qsort(value, (size_t)n, sizeof *value, Compare);
  return n % 2 ? value[n / 2] : 0.5 * (value[n / 2 - 1] + value[n / 2]);
}

/* Keeps the message of the innermost error instead of printing it. */
static PetscErrorCode Keep(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                           PetscErrorType type, const char *message, void *context)
{
  PgTrouble *trouble = (PgTrouble *)context;

  (void)comm;
  (void)line;
  (void)function;
  (void)file;
  if (type == PETSC_ERROR_INITIAL && message) (void)PetscStrncpy(trouble->message, message, sizeof trouble->message);
  return code;
}

PetscErrorCode PgTroubleBegin(PgTrouble *trouble)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(trouble, sizeof *trouble));
  PetscCall(PetscPushErrorHandler(Keep, trouble));
  PetscFunctionReturn(0);
}

PetscErrorCode PgTroubleEnd(MPI_Comm comm, PetscErrorCode *code)
{
  int worst = (int)*code;

  PetscFunctionBeginUser;
  PetscCall(PetscPopErrorHandler());
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_INT, MPI_MAX, comm));
  *code = (PetscErrorCode)worst;
  PetscFunctionReturn(0);
}
