/* Loses a piece of memory, so that a test can see how PETSc reports it. */
#include <porograin/base.h>

int main(int argc, char *argv[])
{
  PetscReal *lost;

  if (PgInitialize(&argc, &argv, NULL) || PetscMalloc1(17, &lost)) return 1;
  return PgFinalize(0);
}
