/* Smoothing kernels. Adding one: a pair of functions and a line in the table. */
#include "kernel.h"

static const PgKernel kernels[] = {
    {"cubic_spline", "Monaghan (1992); Li, Chu & Sheng (2007), Eq. 63", 2.0, PgCubicSplineW, PgCubicSplineDW},
};

PetscErrorCode PgKernelFind(const char name[], const PgKernel **kernel)
{
  PetscFunctionBeginUser;
  *kernel = NULL;
  for (size_t i = 0; i < sizeof kernels / sizeof *kernels; i++) {
    PetscBool same;
    PetscCall(PetscStrcmp(name, kernels[i].name, &same));
    if (same) *kernel = &kernels[i];
  }
  PetscFunctionReturn(0);
}
