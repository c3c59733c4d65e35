/* pressure: the linear system lap p = Z on the discs (Li, Chu & Sheng 2007, Eqs. 52-55): explicit
   Jacobi-like sweeps, or a PETSc matrix solved by a KSP with prefix pressure_. Does not know where the
   right-hand side comes from.

   Rows are scaled by -dV_a: A_ab = c_ab dV_a dV_b, A_aa = -sum_b A_ab, b_a = -Z_a dV_a, symmetric and
   positive (semi)definite for the `paper` Laplacian. The unknown is the excess over a reference pressure, so
   that tolerances are relative to what drives the flow. Discs with a prescribed pressure are eliminated
   symmetrically: their row keeps only its diagonal. */
#pragma once

#include <porograin/sph.h>
#include <petscksp.h>

typedef struct PgPressure_s *PgPressure;

typedef enum { PG_PRESSURE_EXPLICIT, PG_PRESSURE_IMPLICIT } PgPressureMethod;

/* `explicit` fills residual, initial, removed and rhs_norm only when PgPressureRequestResidual() asks for it, and
   has -1 there otherwise. With b = 0 residuals are absolute [Pa]. */
typedef struct {
  PetscInt  iterations; /* Krylov iterations or sweeps */
  PetscReal residual;   /* ||b - A p|| / ||b||, recomputed from the result [1] */
  PetscReal initial;    /* the same for the initial guess; -1 when the Krylov solver works in another norm [1] */
  PetscReal removed;    /* part of b outside the range of a singular A, relative to ||b||; 0 otherwise. `implicit`
                           takes it away and reports the other numbers for what remains */
  PetscReal rhs_norm;   /* ||b|| [Pa] */
  PetscBool singular;   /* some discs are tied to no prescribed pressure: the mean of each island of them is kept
                           (`explicit`: no disc at all has a prescribed pressure) */
  int       reason;     /* KSPConvergedReason; 0 for explicit */
} PgPressureStats;

/* Registers the fields pressure (the unknown), pressure_fixed (1 where prescribed) and
   pressure_prescribed [Pa]. Collective. */
PETSC_EXTERN PetscErrorCode PgPressureCreate(PgParticles particles, PgNeighbors neighbors, PgSph sph,
                                             PgPressure *pressure);
/* Reads -pressure, -pressure_sweeps, -pressure_reference, -pressure_pc_lag, -pressure_rebuild_factor,
   -pressure_error_if_not_converged, -pressure_dump, -pressure_dump_every and all -pressure_ksp_*,
   -pressure_pc_*, -pressure_mat_*. Collective. */
PETSC_EXTERN PetscErrorCode PgPressureSetFromOptions(PgPressure pressure);
PETSC_EXTERN PetscErrorCode PgPressureView(PgPressure pressure, PetscViewer viewer);
PETSC_EXTERN PetscErrorCode PgPressureDestroy(PgPressure *pressure);
PETSC_EXTERN PetscErrorCode PgPressureGetMethod(PgPressure pressure, PgPressureMethod *method);
/* Takes effect with the next PgPressureUpdate(). */
PETSC_EXTERN PetscErrorCode PgPressureSetReference(PgPressure pressure, PetscReal reference); /* [Pa] */
/* Whether explicit solves compute their residual (about one sweep more), until called again. The implicit method
   always does. */
PETSC_EXTERN PetscErrorCode PgPressureRequestResidual(PgPressure pressure, PetscBool request);

/* Takes the coefficients of the present geometry and the fields pressure_fixed and pressure_prescribed
   (owned values; ghosts are exchanged here): matrix pattern when the lists changed, values always.
   coefficient (owned, positive, may be NULL for 1): kappa in div(kappa grad p) = Z, averaged harmonically over
   pairs. Fails, naming it, when a disc without prescribed pressure has no neighbours. Collective. */
PETSC_EXTERN PetscErrorCode PgPressureUpdate(PgPressure pressure, const PetscReal coefficient[]);
/* Solves for the field "pressure", which holds the initial guess on entry, with right-hand side Z [Pa/m2]
   by owned disc; discs with a prescribed pressure get it. Ghost values are current on return. Fails with
   the reason when the solve does not converge or its true residual is above tolerance, after writing the
   system: A, b and the last iterate p - reference, one after the other in a PETSc binary file. With
   -pressure_error_if_not_converged false it goes on, and stats tell. Collective. */
PETSC_EXTERN PetscErrorCode PgPressureSolve(PgPressure pressure, const PetscReal Z[], PgPressureStats *stats);
/* After PgPressureUpdate(), before the first solve: builds the preconditioner, so that the solvers inside it read
   their options (-pressure_mg_levels_*, ...). Nothing to do for `explicit`. Collective. */
PETSC_EXTERN PetscErrorCode PgPressureSetUpSolver(PgPressure pressure);
/* Name for failed systems, default porograin-failed.petsc. */
PETSC_EXTERN PetscErrorCode PgPressureSetFailureFile(PgPressure pressure, const char file[]);
/* What the solves of this program have taken so far. */
typedef struct {
  PetscInt   solves, most; /* most: iterations or sweeps of one solve */
  PetscInt64 iterations;   /* of all */
  PetscInt   dumps;        /* systems written to -pressure_dump */
} PgPressureWork;
PETSC_EXTERN PetscErrorCode PgPressureGetWork(PgPressure pressure, PgPressureWork *work);
/* Number of matrix patterns made, values filled, preconditioners built so far. */
PETSC_EXTERN PetscErrorCode PgPressureGetCounts(PgPressure pressure, PetscInt *patterns, PetscInt *fills,
                                                PetscInt *preconditioners);
/* The next solve builds its preconditioner anew (checkpoints call it, so that a restarted run and the one
   that wrote the checkpoint go on alike). */
PETSC_EXTERN PetscErrorCode PgPressureForgetPreconditioner(PgPressure pressure);
/* Adds what a checkpoint must hold beside the fields: the number of solves, which names dumps. */
PETSC_EXTERN PetscErrorCode PgPressureAddState(PgPressure pressure, PgState state);
/* Makes matrix, right-hand side (of the last solve; Z = 0 when there was none since the update) and KSP available
   to studies, for either method; owned by the pressure object, each may be NULL. After PgPressureUpdate(). The unknown
   is p - reference. The PC inside the KSP is replaced when discs were renumbered: set it by options, not by calls.
   Collective. */
PETSC_EXTERN PetscErrorCode PgPressureGetSystem(PgPressure pressure, Mat *A, Vec *b, KSP *ksp);
/* For PgOptionsCheckUnused(): makes a KSP like ours, and what is inside it, print its option names as help.
   Collective. */
PETSC_EXTERN PetscErrorCode PgPressureProbeOptions(void *pressure);
