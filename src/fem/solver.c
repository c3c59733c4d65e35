/* The solver. By default GMRES with a block triangular preconditioner: one multigrid cycle for the displacements, one
   for an approximate Schur complement, S + J + theta dt D + alpha^2/M times the mass matrix (T60). Multigrid cannot
   handle a skeleton that hardly changes its volume: its block is factorised then. */
#include "femimpl.h"
#include <string.h>

/* Options that stand for our defaults: set where the user has said nothing, and taken back when they have been read. */
static const char *const defaults[][2] = {
    {"-up_ksp_type", "gmres"},
    {"-up_ksp_gmres_restart", "60"},
    {"-up_ksp_pc_side", "right"},
    {"-up_pc_type", "fieldsplit"},
    {"-up_pc_fieldsplit_type", "schur"},
    {"-up_pc_fieldsplit_schur_fact_type", "upper"},
    {"-up_fieldsplit_u_ksp_type", "preonly"},
    {"-up_fieldsplit_p_ksp_type", "preonly"},
#if defined(PETSC_HAVE_HYPRE)
    {"-up_fieldsplit_u_pc_type", "hypre"},
    {"-up_fieldsplit_u_pc_hypre_type", "boomeramg"},
    {"-up_fieldsplit_p_pc_type", "hypre"},
    {"-up_fieldsplit_p_pc_hypre_type", "boomeramg"},
#else
    {"-up_fieldsplit_u_pc_type", "gamg"},
    {"-up_fieldsplit_p_pc_type", "gamg"},
#endif
};
/* Instead of those above when the skeleton keeps its volume. */
static const char *const stiff_defaults[][2] = {
#if defined(PETSC_HAVE_MUMPS)
    {"-up_fieldsplit_u_pc_type", "cholesky"},
    {"-up_fieldsplit_u_pc_factor_mat_solver_type", "mumps"},
#endif
    {NULL, NULL}};
enum {
  DEFAULTS = sizeof defaults / sizeof *defaults,
  STIFF    = sizeof stiff_defaults / sizeof *stiff_defaults - 1,
  ALL      = DEFAULTS + STIFF
};

/* lambda over G from which the block of displacements is factorised, nu = 0.484: cycles of multigrid take twice the
   iterations there, and grow with the mesh beyond. */
#define STIFF_RATIO 30.0

static PetscErrorCode FindStiff(PgFem fem)
{
  PetscReal mine = 0.0, all;

  PetscFunctionBeginUser;
  for (PetscInt cell = 0; cell < fem->cells; cell++) {
    PgFemCoefficients c;
    PetscCall(PgFemCoefficientsOf(fem, cell, 1.0, 1.0, &c));
    mine = PetscMax(mine, c.lambda / c.G);
  }
  PetscCallMPI(MPI_Allreduce(&mine, &all, 1, MPIU_REAL, MPIU_MAX, fem->comm));
  fem->stiff = (PetscBool)(all > STIFF_RATIO);
  PetscFunctionReturn(0);
}

/* Option k of both lists; NULL: not in this run. */
static const char *const *Default(const PgFem fem, int k)
{
  if (k >= DEFAULTS) return fem->stiff ? stiff_defaults[k - DEFAULTS] : NULL;
  for (int s = 0; fem->stiff && s < STIFF; s++)
    if (strcmp(defaults[k][0], stiff_defaults[s][0]) == 0) return NULL;
  return defaults[k];
}

static PetscErrorCode PushDefaults(const PgFem fem, PetscBool pushed[ALL])
{
  PetscFunctionBeginUser;
  for (int k = 0; k < ALL; k++) {
    const char *const *option = Default(fem, k);
    PetscBool          given  = PETSC_TRUE;
    if (option) PetscCall(PetscOptionsHasName(NULL, NULL, option[0], &given));
    pushed[k] = (PetscBool)!given;
    if (pushed[k]) PetscCall(PetscOptionsSetValue(NULL, option[0], option[1]));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode PopDefaults(const PgFem fem, const PetscBool pushed[ALL])
{
  PetscFunctionBeginUser;
  for (int k = 0; k < ALL; k++)
    if (pushed[k]) PetscCall(PetscOptionsClearValue(NULL, Default(fem, k)[0]));
  PetscFunctionReturn(0);
}

/* Motions without strain, for multigrid of the displacements; a held unknown has no part in them. */
static PetscErrorCode AttachMotions(PgFem fem)
{
  PetscInt     count, start;
  PetscScalar *value;
  Vec          x;
  MatNullSpace motions;

  PetscFunctionBeginUser;
  PetscCall(ISGetLocalSize(fem->is_u, &count));
  PetscCall(VecCreate(fem->comm, &x));
  PetscCall(VecSetSizes(x, count, PETSC_DETERMINE));
  PetscCall(VecSetBlockSize(x, 2));
  PetscCall(VecSetFromOptions(x));
  PetscCall(VecGetOwnershipRange(fem->b, &start, NULL));
  PetscCall(VecGetArray(x, &value));
  {
    const PetscInt *index;
    PetscInt       *place;
    PetscCall(PetscMalloc1(fem->mine, &place));
    PetscCall(ISGetIndices(fem->is_u, &index));
    for (PetscInt k = 0; k < count; k++) place[index[k] - start] = k;
    PetscCall(ISRestoreIndices(fem->is_u, &index));
    for (PetscInt c = 0; c < fem->cells; c++) {
      PetscReal vertex[4][2];
      PgFemCellX(fem, c, vertex);
      for (PetscInt a = 0; a < fem->un; a++) {
        static const PetscReal corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
        static const PetscReal node[9][2]   = {{-1, -1}, {1, -1}, {1, 1},  {-1, 1}, {0, -1},
                                               {1, 0},   {0, 1},  {-1, 0}, {0, 0}};
        const PetscInt         g            = fem->global[fem->dof[c * fem->dofs + 2 * a]];
        if (g < start || g >= start + fem->mine) continue;
        for (int d = 0; d < 2; d++) {
          PetscReal sum = 0.0;
          for (int v = 0; v < 4; v++)
            sum += 0.25 * (1.0 + corner[v][0] * node[a][0]) * (1.0 + corner[v][1] * node[a][1]) * vertex[v][d];
          value[place[g - start] + d] = sum;
        }
      }
    }
    PetscCall(PetscFree(place));
  }
  PetscCall(VecRestoreArray(x, &value));
  PetscCall(MatNullSpaceCreateRigidBody(x, &motions));
  PetscCall(PetscObjectCompose((PetscObject)fem->is_u, "nearnullspace", (PetscObject)motions));
  PetscCall(MatNullSpaceDestroy(&motions));
  PetscCall(VecDestroy(&x));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeSolver(PgFem fem, KSP *ksp)
{
  PC        pc;
  PetscBool split;

  PetscFunctionBeginUser;
  PetscCall(KSPCreate(fem->comm, ksp));
  PetscCall(KSPSetOptionsPrefix(*ksp, "up_"));
  PetscCall(KSPSetTolerances(*ksp, 1e-10, PETSC_DEFAULT, 1e30, 500));
  PetscCall(KSPSetOperators(*ksp, fem->A, fem->A));
  PetscCall(KSPSetFromOptions(*ksp));
  PetscCall(KSPGetPC(*ksp, &pc));
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCFIELDSPLIT, &split));
  if (split) {
    PetscCall(PCFieldSplitSetIS(pc, "u", fem->is_u));
    PetscCall(PCFieldSplitSetIS(pc, "p", fem->is_p));
    PetscCall(PCFieldSplitSetSchurPre(pc, PC_FIELDSPLIT_SCHUR_PRE_USER, fem->P));
  }
  PetscFunctionReturn(0);
}

/* PETSc reads options of solvers inside a preconditioner when it is set up. */
static PetscErrorCode SetUpSolver(void *context)
{
  PgFem     fem = (PgFem)context;
  PetscBool pushed[ALL];

  PetscFunctionBeginUser;
  PetscCall(PushDefaults(fem, pushed));
  if (!fem->ksp) PetscCall(MakeSolver(fem, &fem->ksp));
  PetscCall(KSPSetOperators(fem->ksp, fem->A, fem->A));
  PetscCall(KSPSetUp(fem->ksp));
  PetscCall(KSPSetUpOnBlocks(fem->ksp));
  PetscCall(PopDefaults(fem, pushed));
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSolverBuild(PgFem fem)
{
  PetscFunctionBeginUser;
  if (!fem->ksp) {
    PetscCall(FindStiff(fem));
    PetscCall(AttachMotions(fem));
  }
  PetscCall(PgOptionsRead(fem->comm, "up_", SetUpSolver, PgFemProbeOptions, fem));
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemProbeOptions(void *context)
{
  PgFem     fem = (PgFem)context;
  PetscBool pushed[ALL];
  KSP       ksp;

  PetscFunctionBeginUser;
  if (!fem->A) PetscFunctionReturn(0);
  PetscCall(PetscOptionsHelpPrintedDestroy(&PetscOptionsHelpPrintedSingleton));
  PetscCall(PushDefaults(fem, pushed));
  PetscCall(MakeSolver(fem, &ksp));
  PetscCall(KSPSetUp(ksp));
  PetscCall(KSPSetUpOnBlocks(ksp));
  PetscCall(KSPDestroy(&ksp));
  PetscCall(PopDefaults(fem, pushed));
  PetscFunctionReturn(0);
}

/* A uniform pressure is free: then as much water must flow in as out, and its mean stays as it is. */
static PetscErrorCode CheckBalance(PgFem fem)
{
  const Vec   *constant;
  MatNullSpace space;
  PetscInt     count;
  PetscReal    norm;
  PetscScalar  part;

  PetscFunctionBeginUser;
  PetscCall(MatGetNullSpace(fem->A, &space));
  PetscCall(MatNullSpaceGetVecs(space, NULL, &count, &constant));
  PetscCall(VecDot(fem->b, constant[0], &part));
  PetscCall(VecNorm(fem->b, NORM_2, &norm));
  PgInputCheck(
      PetscAbsScalar(part) <= 1e-8 * norm, fem->comm,
      "up: more water flows in than out (%g of the loads), but water and grains cannot be compressed, no side is "
      "drained and none gives way",
      (double)(PetscAbsScalar(part) / norm));
  PetscCall(MatNullSpaceRemove(space, fem->b));
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSolve(PgFem fem)
{
  PetscReal          rhs, residual, rtol;
  KSPConvergedReason reason;

  PetscFunctionBeginUser;
  if (fem->singular) PetscCall(CheckBalance(fem));
  PetscCall(VecNorm(fem->b, NORM_2, &rhs));
  PetscCall(VecSet(fem->w, 0.0));
  PetscCall(KSPSolve(fem->ksp, fem->b, fem->w));
  PetscCall(KSPGetConvergedReason(fem->ksp, &reason));
  PetscCall(KSPGetIterationNumber(fem->ksp, &fem->stats.iterations));
  PetscCall(KSPGetTolerances(fem->ksp, &rtol, NULL, NULL, NULL));
  PetscCall(MatMult(fem->A, fem->w, fem->r));
  PetscCall(VecAYPX(fem->r, -1.0, fem->b));
  PetscCall(VecNorm(fem->r, NORM_2, &residual));
  fem->stats.reason   = (PetscInt)reason;
  fem->stats.residual = rhs > 0.0 ? residual / rhs : residual;
  if (!fem->error_if_not_converged) PetscFunctionReturn(0);
  /* a solver that stops on another norm may leave ten times as much */
  if (reason <= 0 || !(fem->stats.residual <= PetscMax(10.0 * rtol, 1e-9)))
    PgRunError(fem->comm,
               "up: the solver ended with %s after %" PetscInt_FMT
               " iterations, relative residual %g (rtol %g), step %" PetscInt_FMT " of the continuum, after time %g s",
               KSPConvergedReasons[reason], fem->stats.iterations, (double)fem->stats.residual, (double)rtol,
               fem->step + 1, (double)fem->time);
  PetscFunctionReturn(0);
}
