/* Systems from files of -pressure_dump: A, b and x one after the other, PETSc binary. What PETSc does not store, that
   A is symmetric and that the constant is in its null space, is found by trying. */
#include "dumpfile.h"
#include "studyimpl.h"

/* Two vectors without any symmetry tell A from its transpose. */
static PetscErrorCode FindSymmetry(Mat A, Vec x, Vec y, Vec Ax, PetscBool *symmetric)
{
  PetscInt    start, end;
  PetscScalar yAx, xAy, *u, *v;
  PetscReal   norm_Ax, norm_y;

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(A, &start, &end));
  PetscCall(VecGetArrayWrite(x, &u));
  PetscCall(VecGetArrayWrite(y, &v));
  for (PetscInt i = start; i < end; i++) {
    u[i - start] = PgNoise(i, 0);
    v[i - start] = PgNoise(i, 1);
  }
  PetscCall(VecRestoreArrayWrite(x, &u));
  PetscCall(VecRestoreArrayWrite(y, &v));
  PetscCall(MatMult(A, x, Ax));
  PetscCall(VecDot(y, Ax, &yAx));
  PetscCall(VecNorm(Ax, NORM_2, &norm_Ax));
  PetscCall(VecNorm(y, NORM_2, &norm_y));
  PetscCall(MatMult(A, y, Ax));
  PetscCall(VecDot(x, Ax, &xAy));
  /* rounding of sums of n terms is far below; entries that differ are far above */
  *symmetric = (PetscBool)(PetscAbsScalar(yAx - xAy) <= 1e-12 * norm_Ax * norm_y);
  PetscFunctionReturn(0);
}

/* Whether all rows sum to zero, to the rounding with which diagonals were summed. */
static PetscErrorCode FindNullSpace(Mat A, Vec one, Vec sum, PetscBool *singular)
{
  PetscReal most, diagonal;

  PetscFunctionBeginUser;
  PetscCall(VecSet(one, 1.0));
  PetscCall(MatMult(A, one, sum));
  PetscCall(VecNorm(sum, NORM_INFINITY, &most));
  PetscCall(MatGetDiagonal(A, sum));
  PetscCall(VecNorm(sum, NORM_INFINITY, &diagonal));
  *singular = (PetscBool)(most <= 1e-12 * diagonal);
  PetscFunctionReturn(0);
}

static PetscErrorCode Describe(Mat A)
{
  Vec          x, y, z;
  PetscBool    symmetric = PETSC_FALSE, singular = PETSC_FALSE;
  MatNullSpace constant;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(A, &x, &y));
  PetscCall(VecDuplicate(y, &z));
  PetscCall(FindSymmetry(A, x, y, z, &symmetric));
  PetscCall(FindNullSpace(A, x, y, &singular));
  PetscCall(MatSetOption(A, MAT_SYMMETRIC, symmetric));
  PetscCall(MatSetOption(A, MAT_SYMMETRY_ETERNAL, symmetric));
  PetscCall(MatSetOption(A, MAT_SPD, (PetscBool)(symmetric && !singular)));
  if (singular) {
    PetscCall(MatNullSpaceCreate(PetscObjectComm((PetscObject)A), PETSC_TRUE, 0, NULL, &constant));
    PetscCall(MatSetNullSpace(A, constant));
    if (symmetric) PetscCall(MatSetTransposeNullSpace(A, constant));
    PetscCall(MatNullSpaceDestroy(&constant));
  }
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&y));
  PetscCall(VecDestroy(&z));
  PetscFunctionReturn(0);
}

static PetscErrorCode Read(PgSystem *s, const char file[])
{
  PetscViewer viewer;

  PetscFunctionBeginUser;
  PetscCall(PetscViewerCreate(s->comm, &viewer));
  PetscCall(PetscViewerSetType(viewer, PETSCVIEWERBINARY));
  PetscCall(PetscViewerBinarySkipInfo(viewer)); /* options in a file beside it are not part of the system */
  PetscCall(PetscViewerFileSetMode(viewer, FILE_MODE_READ));
  PetscCall(PetscViewerFileSetName(viewer, file));
  PetscCall(MatCreate(s->comm, &s->A));
  PetscCall(MatSetType(s->A, MATAIJ));
  PetscCall(MatLoad(s->A, viewer));
  PetscCall(MatCreateVecs(s->A, &s->reference, &s->b));
  PetscCall(VecLoad(s->b, viewer));
  PetscCall(VecLoad(s->reference, viewer));
  PetscCall(PetscViewerDestroy(&viewer));
  PetscFunctionReturn(0);
}

/* On rank 0, and its verdict for all. */
static PetscErrorCode Check(MPI_Comm comm, const char file[])
{
  PetscMPIInt rank, refused = 0;
  char        reason[256] = "";

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!rank) PgDumpFileCheck(file, reason, sizeof reason);
  if (reason[0]) refused = 1;
  PetscCallMPI(MPI_Bcast(&refused, 1, MPI_INT, 0, comm));
  if (refused) {
    PetscCall(PgReport(comm, "option -study_load: '%s': %s", file, reason));
    return PETSC_ERR_FILE_READ;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgSystemLoad(PgSystem *s, const char file[], const PgSystemChoices *choices)
{
  PetscErrorCode err;

  PetscFunctionBeginUser;
  err = Check(s->comm, file);
  if (err) PetscFunctionReturn(err);
  PetscCall(Read(s, file));
  s->reference_name = "the solution in the file";
  PetscCall(PetscStrncpy(s->name, file, sizeof s->name));
  PetscCall(Describe(s->A));
  PetscCall(PgSystemFinish(s, choices));
  PetscFunctionReturn(0);
}
