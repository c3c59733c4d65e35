/* Writing a system: A, b, x one after the other in one PETSc binary file, to be read by MatLoad() and VecLoad(). */
#include "pressureimpl.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

/* Whether rank 0 can open the file; asked first, because PETSc would fail on rank 0 alone. */
static PetscErrorCode CanWrite(MPI_Comm comm, const char file[], PetscBool *can)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  *can = PETSC_FALSE;
  if (rank == 0) {
    FILE *f = fopen(file, "wb");
    if (f) *can = (PetscBool)(fclose(f) == 0);
  }
  PetscCallMPI(MPI_Bcast(can, 1, MPIU_BOOL, 0, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureWriteSystem(PgPressure q, const char file[], PetscBool *written)
{
  PetscViewer viewer;

  PetscFunctionBeginUser;
  PetscCall(CanWrite(q->comm, file, written));
  if (!*written) PetscFunctionReturn(0);
  PetscCall(PetscViewerCreate(q->comm, &viewer));
  PetscCall(PetscViewerSetType(viewer, PETSCVIEWERBINARY));
  PetscCall(PetscViewerBinarySetSkipInfo(viewer, PETSC_TRUE));
  PetscCall(PetscViewerFileSetMode(viewer, FILE_MODE_WRITE));
  PetscCall(PetscViewerFileSetName(viewer, file));
  PetscCall(MatView(q->A, viewer));
  PetscCall(VecView(q->b, viewer));
  PetscCall(VecView(q->x, viewer));
  PetscCall(PetscViewerDestroy(&viewer));
  PetscFunctionReturn(0);
}

/* FILE.petsc becomes FILE-000123.petsc. */
static PetscErrorCode NumberedName(const char file[], PetscInt number, char name[], size_t length)
{
  const char *slash = strrchr(file, '/'), *dot = strrchr(slash ? slash : file, '.');
  const int   stem = (int)(dot ? (size_t)(dot - file) : strlen(file));

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, length, "%.*s-%06" PetscInt_FMT "%s", stem, file, number, dot ? dot : ""));
  PetscFunctionReturn(0);
}

/* x as the result of this solve, whichever method made it. */
static PetscErrorCode TakeResult(PgPressure q)
{
  PetscReal   *p;
  PetscScalar *x;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetArray(q->particles, q->p, &p));
  PetscCall(VecGetArrayWrite(q->x, &x));
  for (PetscInt a = 0; a < q->owned; a++) x[a] = p[a] - q->reference;
  PetscCall(VecRestoreArrayWrite(q->x, &x));
  PetscFunctionReturn(0);
}

static PetscErrorCode NextName(PgPressure q, char name[], size_t length)
{
  PetscFunctionBeginUser;
  if (q->dump_every)
    PetscCall(NumberedName(q->dump, q->solves, name, length));
  else
    PetscCall(PetscStrncpy(name, q->dump, length));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureCheckDump(PgPressure q)
{
  char        name[PETSC_MAX_PATH_LEN + 16], reason[256] = "";
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCall(NextName(q, name, sizeof name));
  PetscCallMPI(MPI_Comm_rank(q->comm, &rank));
  if (rank == 0) {
    struct stat before;
    const int   there = stat(name, &before) == 0;
    FILE       *f     = fopen(name, "ab"); /* leaves what is there as it is */
    if (!f) (void)snprintf(reason, sizeof reason, "%s", strerror(errno));
    if (f) (void)fclose(f);
    if (f && !there) (void)remove(name);
  }
  PetscCallMPI(MPI_Bcast(reason, sizeof reason, MPI_CHAR, 0, q->comm));
  if (reason[0]) {
    PetscCall(PgReport(q->comm, "option -pressure_dump: cannot write '%s': %s", name, reason));
    return PETSC_ERR_FILE_OPEN;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureDump(PgPressure q)
{
  char      name[PETSC_MAX_PATH_LEN + 16];
  PetscBool written;

  PetscFunctionBeginUser;
  PetscCall(PgPressureGetSystem(q, NULL, NULL, NULL));
  PetscCall(TakeResult(q));
  PetscCall(NextName(q, name, sizeof name));
  PetscCall(PgPressureWriteSystem(q, name, &written));
  if (!written) {
    PetscCall(PgReport(q->comm, "option -pressure_dump: cannot write '%s'", name));
    return PETSC_ERR_FILE_OPEN;
  }
  q->work.dumps++;
  PetscFunctionReturn(0);
}
