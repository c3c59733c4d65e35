/* load_system FILE: reads A, b, x as PETSc's own solver examples do, and prints one line:
     rows R nonzeros Z asymmetry |A - A^T|/|A| residual |b - A x|/|b| right-hand side |b|
   Exit status 0: read, 1: not. */
#include <petscksp.h>

static PetscErrorCode Load(const char file[])
{
  PetscViewer viewer;
  Mat         A, T;
  Vec         b, x, r;
  MatInfo     info;
  PetscInt    rows;
  PetscReal   norm, asymmetry, rhs, residual;

  PetscFunctionBeginUser;
  PetscCall(PetscViewerBinaryOpen(PETSC_COMM_WORLD, file, FILE_MODE_READ, &viewer));
  PetscCall(MatCreate(PETSC_COMM_WORLD, &A));
  PetscCall(MatSetFromOptions(A));
  PetscCall(MatLoad(A, viewer));
  PetscCall(MatCreateVecs(A, &x, &b));
  PetscCall(VecLoad(b, viewer));
  PetscCall(VecLoad(x, viewer));
  PetscCall(PetscViewerDestroy(&viewer));
  PetscCall(MatGetSize(A, &rows, NULL));
  PetscCall(MatGetInfo(A, MAT_GLOBAL_SUM, &info));
  PetscCall(VecDuplicate(b, &r));
  PetscCall(MatMult(A, x, r));
  PetscCall(VecAYPX(r, -1.0, b));
  PetscCall(VecNorm(r, NORM_2, &residual));
  PetscCall(VecNorm(b, NORM_2, &rhs));
  PetscCall(MatTranspose(A, MAT_INITIAL_MATRIX, &T));
  PetscCall(MatNorm(A, NORM_FROBENIUS, &norm));
  PetscCall(MatAXPY(T, -1.0, A, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatNorm(T, NORM_FROBENIUS, &asymmetry));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD,
                        "rows %" PetscInt_FMT " nonzeros %.0f asymmetry %.3e residual %.3e right-hand side %.6e\n",
                        rows, info.nz_used, (double)(asymmetry / norm), (double)(residual / rhs), (double)rhs));
  PetscCall(MatDestroy(&A));
  PetscCall(MatDestroy(&T));
  PetscCall(VecDestroy(&b));
  PetscCall(VecDestroy(&x));
  PetscCall(VecDestroy(&r));
  PetscFunctionReturn(0);
}

int main(int argc, char *argv[])
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  if (argc != 2) {
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "usage: load_system FILE\n"));
    return 1;
  }
  if (Load(argv[1])) return 1;
  return PetscFinalize() ? 1 : 0;
}
