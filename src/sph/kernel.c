/* Smoothing kernels. Adding one: a pair of functions and a line in the table. */
#include "kernel.h"

static const PgKernel kernels[] = {
    {"cubic_spline",
     "Monaghan (1992); Li, Chu & Sheng (2007), Eq. 63",
     2.0,
     {2.0 / 3.0, PG_CUBIC_SPLINE_CONSTANT, 1.0 / PETSC_PI},
     PgCubicSplineW,
     PgCubicSplineDW},
    /* Tak, Park & Park print 120 in one dimension and 3/(359 pi) in three: integrals of 14400 and 1.0028 */
    {"quintic_spline",
     "Schoenberg (1946); Morris, Fox & Zhu (1997); Tak, Park & Park (2013), Eq. 37",
     3.0,
     {1.0 / 120.0, PG_QUINTIC_SPLINE_CONSTANT, 1.0 / (120.0 * PETSC_PI)},
     PgQuinticSplineW,
     PgQuinticSplineDW},
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
