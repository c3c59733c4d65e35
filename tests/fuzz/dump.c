/* Fuzz target: the reader of pressure systems. What the check accepts, PETSc loads without an error, and the system can
   be used. */
#include "../../src/study/dumpfile.h"
#include "fuzz.h"
#include <math.h>
#include <petscmat.h>

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  (void)argc;
  (void)argv;
  FuzzStart();
  return 0;
}

/* What has been let through can be computed with. */
static void CheckFinite(Mat A, Vec x, Vec b)
{
  const PetscScalar *value;
  PetscReal          largest;
  PetscInt           rows, count;

  Demand(!MatGetSize(A, &rows, NULL));
  for (PetscInt i = 0; i < rows; i++) {
    Demand(!MatGetRow(A, i, &count, NULL, &value));
    for (PetscInt k = 0; k < count; k++) Demand(isfinite(PetscRealPart(value[k])));
    Demand(!MatRestoreRow(A, i, &count, NULL, &value));
  }
  Demand(!VecNorm(b, NORM_INFINITY, &largest) && isfinite(largest));
  Demand(!VecNorm(x, NORM_INFINITY, &largest) && isfinite(largest));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  PetscViewer viewer;
  Mat         A;
  Vec         x, b;
  PetscReal   norm;
  char        reason[256];

  FuzzWrite("dump.petsc", data, size);
  PgDumpFileCheck("dump.petsc", reason, sizeof reason);
  Demand(strlen(reason) < sizeof reason - 1); /* room for all of it */
  if (reason[0]) return 0;
  Demand(!PetscViewerBinaryOpen(PETSC_COMM_SELF, "dump.petsc", FILE_MODE_READ, &viewer));
  Demand(!MatCreate(PETSC_COMM_SELF, &A));
  Demand(!MatSetType(A, MATAIJ));
  Demand(!MatLoad(A, viewer));
  Demand(!MatCreateVecs(A, &x, &b));
  Demand(!VecLoad(b, viewer) && !VecLoad(x, viewer));
  CheckFinite(A, x, b);
  Demand(!MatMult(A, x, b));
  Demand(!VecNorm(b, NORM_1, &norm)); /* finite numbers may overflow here */
  Demand(!PetscViewerDestroy(&viewer) && !MatDestroy(&A) && !VecDestroy(&x) && !VecDestroy(&b));
  return 0;
}
