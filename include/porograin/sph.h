/* sph: kernel, pair coefficients and the operators gradient, divergence and Laplacian on the row list.
   Knows neither the physics of water nor how ranks talk: ghosts of the arguments must be current. */
#pragma once

#include <porograin/neighbors.h>

typedef struct PgSph_s *PgSph;

/* A smoothing kernel in two dimensions, W(r, h) = w(r/h)/h^2. In d dimensions it is w(r/h)/h^d times
   constant[d - 1]/constant[1]. */
typedef struct {
  const char *name, *citation;
  PetscReal   support;          /* in units of h */
  PetscReal   constant[3];      /* in front of the piecewise polynomial, in one, two and three dimensions */
  PetscReal (*w)(PetscReal q);  /* with its constant: integral of w over the plane is 1 */
  PetscReal (*dw)(PetscReal q); /* derivative of w */
} PgKernel;
PETSC_EXTERN PetscErrorCode PgKernelFind(const char name[], const PgKernel **kernel); /* NULL when unknown */

typedef enum { PG_SPH_PAPER, PG_SPH_CORRECTED } PgSphOperators;

/* Coefficients of row a, entry b of the row list, at the present geometry. */
typedef struct {
  const PetscInt  *ptr, *col;  /* the row list */
  const PetscReal *gradient;   /* (2) grad_a W_ab dV_b [1/m]: grad f = sum gradient (f_b - f_a); corrected when asked */
  const PetscReal *laplacian;  /* c_ab dV_b [1/m2], Eq. 52: lap f = sum laplacian (f_a - f_b); <= 0 for `paper` */
  const PetscReal *weight;     /* W_ab dV_b [1] */
  const PetscReal *kernel_sum; /* by owned disc: sum_b W_ab dV_b, the disc itself included [1] */
  PetscBool        symmetric;  /* laplacian[ab] dV_a = laplacian[ba] dV_b */
} PgSphCoefficients;

/* Registers the field "volume" (dV = pi r^2/(1 - n) per unit thickness [m2], set by the owner of the
   porosity) and requests rows of reach 2h. Collective. */
PETSC_EXTERN PetscErrorCode PgSphCreate(PgParticles particles, PgNeighbors neighbors, PgSph *sph);
/* Reads -sph_operators paper|corrected, -sph_gradient and -sph_laplacian (each operator by itself),
   -sph_laplacian_eta, -sph_kernel, -sph_smoothing (h/r). Collective. */
PETSC_EXTERN PetscErrorCode PgSphSetFromOptions(PgSph sph);
PETSC_EXTERN PetscErrorCode PgSphView(PgSph sph, PetscViewer viewer);
PETSC_EXTERN PetscErrorCode PgSphDestroy(PgSph *sph);
/* Computes all coefficients from positions, radii and volumes (ghosts included). Once for each geometry:
   all operators below, and the pressure matrix, share them. Collective. */
PETSC_EXTERN PetscErrorCode PgSphUpdate(PgSph sph);
PETSC_EXTERN PetscErrorCode PgSphGetCoefficients(PgSph sph, PgSphCoefficients *coefficients);
PETSC_EXTERN PetscErrorCode PgSphGetKernel(PgSph sph, const PgKernel **kernel, PetscReal *smoothing); /* h/r */
/* Form of gradient and divergence, form of the Laplacian, and its eta; each may be NULL. */
PETSC_EXTERN PetscErrorCode PgSphGetForms(PgSph sph, PgSphOperators *gradient, PgSphOperators *laplacian,
                                          PetscReal *eta);
/* Rows whose correction was ill-conditioned and fell back to the plain form, all ranks. Collective. */
PETSC_EXTERN PetscErrorCode PgSphGetFallbacks(PgSph sph, PetscInt *gradients, PetscInt *laplacians);

/* Arguments hold owned and ghost values, results owned ones. u and v are interleaved vectors, grad u is
   (du_x/dx, du_x/dy, du_y/dx, du_y/dy). Not collective. */
PETSC_EXTERN PetscErrorCode PgSphGradient(PgSph sph, const PetscReal f[], PetscReal grad[]);
PETSC_EXTERN PetscErrorCode PgSphVectorGradient(PgSph sph, const PetscReal u[], PetscReal grad[]);
PETSC_EXTERN PetscErrorCode PgSphDivergence(PgSph sph, const PetscReal u[], PetscReal div[]);
/* div u, div v and grad f in one pass over the rows. */
PETSC_EXTERN PetscErrorCode PgSphDivergencesAndGradient(PgSph sph, const PetscReal u[], const PetscReal v[],
                                                        const PetscReal f[], PetscReal div_u[], PetscReal div_v[],
                                                        PetscReal grad_f[]);
PETSC_EXTERN PetscErrorCode PgSphLaplacian(PgSph sph, const PetscReal f[], PetscReal lap[]);
