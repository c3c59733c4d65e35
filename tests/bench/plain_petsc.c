/* plain_petsc -f FILE.000000,FILE.000001,...: solves the systems that porograin -pressure_dump wrote (A, b, p), one
   after the other, with nothing but PETSc: the solver of the first is kept, the last solution is the guess. Prints CPU
   microseconds per unknown and solve (the first, which builds the preconditioner, left out) and the mean iterations.
   Any -ksp_* and -pc_* options; cg and the true residual, as in porograin. */
#include <petscksp.h>
#include <time.h>

static PetscErrorCode Load(const char file[], Mat *A, Vec *b)
{
  PetscViewer viewer;

  PetscFunctionBeginUser;
  PetscCall(PetscViewerBinaryOpen(PETSC_COMM_WORLD, file, FILE_MODE_READ, &viewer));
  PetscCall(MatCreate(PETSC_COMM_WORLD, A));
  PetscCall(MatSetType(*A, MATAIJ));
  PetscCall(MatLoad(*A, viewer));
  PetscCall(MatSetOption(*A, MAT_SPD, PETSC_TRUE));
  PetscCall(MatCreateVecs(*A, b, NULL));
  PetscCall(VecLoad(*b, viewer));
  PetscCall(PetscViewerDestroy(&viewer));
  PetscFunctionReturn(0);
}

int main(int argc, char *argv[])
{
  char    *file[64];
  PetscInt count = 64, n, its, sum = 0;
  clock_t  spent = 0;
  Mat      A;
  Vec      x = NULL, b;
  KSP      ksp;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetStringArray(NULL, NULL, "-f", file, &count, NULL));
  PetscCall(KSPCreate(PETSC_COMM_WORLD, &ksp));
  PetscCall(KSPSetType(ksp, KSPCG));
  PetscCall(KSPSetNormType(ksp, KSP_NORM_UNPRECONDITIONED));
  PetscCall(KSPSetTolerances(ksp, 1e-8, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  PetscCall(KSPSetInitialGuessNonzero(ksp, PETSC_TRUE));
  PetscCall(KSPSetFromOptions(ksp));
  for (PetscInt k = 0; k < count; k++) {
    clock_t begin;
    PetscCall(Load(file[k], &A, &b));
    if (!x) PetscCall(VecDuplicate(b, &x));
    if (k == 0) PetscCall(VecSet(x, 0.0));
    begin = clock();
    PetscCall(KSPSetOperators(ksp, A, A));
    PetscCall(KSPSetReusePreconditioner(ksp, k ? PETSC_TRUE : PETSC_FALSE));
    PetscCall(KSPSolve(ksp, b, x));
    PetscCall(KSPGetIterationNumber(ksp, &its));
    if (k) spent += clock() - begin;
    if (k) sum += its;
    PetscCall(MatDestroy(&A));
    PetscCall(VecDestroy(&b));
    PetscCall(PetscFree(file[k]));
  }
  PetscCall(VecGetSize(x, &n));
  if (count > 1)
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%.4g %.3g\n",
                          1e6 * (double)spent / CLOCKS_PER_SEC / (double)n / (double)(count - 1),
                          (double)sum / (double)(count - 1)));
  PetscCall(VecDestroy(&x));
  PetscCall(KSPDestroy(&ksp));
  PetscCall(PetscFinalize());
  return count > 1 ? 0 : 1;
}
