/* One solver on one system: from a zero guess, all in the same norm, the residual recomputed from the answer. What a
   solver says of itself is put into words; what it cannot do is a result, too. */
#include "studyimpl.h"
#include <math.h>

/* The convergence test of all solvers: PETSc's, and a limit on time that all ranks reach together. */
typedef struct {
  void     *standard;
  PetscReal deadline;
  PetscBool expired;
} Patience;

static PetscErrorCode Test(KSP ksp, PetscInt it, PetscReal norm, KSPConvergedReason *reason, void *context)
{
  Patience *p = (Patience *)context;

  PetscFunctionBeginUser;
  PetscCall(KSPConvergedDefault(ksp, it, norm, reason, p->standard));
  if (*reason || it % 64) PetscFunctionReturn(0); /* asking the other ranks costs a message: now and then */
  p->expired = (PetscBool)(MPI_Wtime() > p->deadline);
  PetscCallMPI(MPI_Bcast(&p->expired, 1, MPIU_BOOL, 0, PetscObjectComm((PetscObject)ksp)));
  if (p->expired) *reason = KSP_DIVERGED_ITS;
  PetscFunctionReturn(0);
}

/* Everything that lives as long as one solve. */
typedef struct {
  PgSystem              *system;
  const PgSystemChoices *how;
  PgSolver              *solver;
  const PgSolveChoices  *choices;
  PgSolveResult         *result;
  KSP                    ksp;
  Vec                    x, r;
  Patience               patience;
  PetscReal             *history;
  PetscInt               history_size;
  PetscBool              condition; /* the next set-up is for a condition number */
} Run;

/* BoomerAMG's elimination on the coarsest grid has no pivoting: with a singular matrix it must smooth there, unless
   the line says otherwise or the trap is to be shown. */
static PetscErrorCode CoarseSmoother(Run *run)
{
#if defined(PETSC_HAVE_HYPRE)
  const char *const option = "pc_hypre_boomeramg_relax_type_coarse";
  PC                pc;
  PetscBool         hypre, boomeramg = PETSC_FALSE, has;
  char              name[128];

  PetscFunctionBeginUser;
  if (!run->system->singular || run->how->no_nullspace) PetscFunctionReturn(0);
  PetscCall(KSPGetPC(run->ksp, &pc));
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCHYPRE, &hypre));
  if (hypre) {
    const char *type;
    PetscCall(PCHYPREGetType(pc, &type));
    PetscCall(PetscStrcmp(type, "boomeramg", &boomeramg));
  }
  PetscCall(PgSolverHas(run->solver, option, &has));
  if (!boomeramg || has) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(name, sizeof name, "-%s%s", run->solver->prefix, option));
  PetscCall(PetscOptionsSetValue(NULL, name, "symmetric-SOR/Jacobi"));
  PetscCall(PCSetFromOptions(pc));
  PetscCall(PetscOptionsClearValue(NULL, name));
  PetscFunctionReturn(0);
#else
  PetscFunctionBeginUser;
  (void)run;
  PetscFunctionReturn(0);
#endif
}

/* Methods without the true residual norm (preonly: none at all) get the norm they have. */
static PetscErrorCode SettleNorm(KSP ksp)
{
  KSPNormType    norm;
  PetscErrorCode refused;
  PgTrouble      trouble;

  PetscFunctionBeginUser;
  PetscCall(PgTroubleBegin(&trouble));
  refused = KSPGetNormType(ksp, &norm);
  PetscCall(PgTroubleEnd(PetscObjectComm((PetscObject)ksp), &refused));
  if (refused) PetscCall(KSPSetNormType(ksp, KSP_NORM_DEFAULT));
  PetscFunctionReturn(0);
}

static PetscErrorCode SetUp(Run *run)
{
  PetscBool preonly, has;
  PetscInt  most;

  PetscFunctionBeginUser;
  PetscCall(KSPCreate(run->system->comm, &run->ksp));
  PetscCall(KSPSetOptionsPrefix(run->ksp, run->solver->prefix));
  PetscCall(KSPSetOperators(run->ksp, run->system->A, run->system->A));
  PetscCall(KSPSetTolerances(run->ksp, run->choices->rtol, 0.0, PETSC_DEFAULT, 10000));
  if (!run->how->preconditioned_norm) PetscCall(KSPSetNormType(run->ksp, KSP_NORM_UNPRECONDITIONED));
  PetscCall(KSPSetFromOptions(run->ksp));
  PetscCall(PgSolverHas(run->solver, "ksp_norm_type", &has));
  if (!has) PetscCall(SettleNorm(run->ksp));
  PetscCall(CoarseSmoother(run));
  PetscCall(PetscObjectTypeCompare((PetscObject)run->ksp, KSPPREONLY, &preonly));
  PetscCall(KSPGetTolerances(run->ksp, NULL, NULL, NULL, &most));
  if (!preonly) PetscCall(KSPSetConvergenceTest(run->ksp, Test, &run->patience, NULL));
  if (run->history_size < most + 1) {
    run->history_size = most + 1;
    PetscCall(PetscFree(run->history));
    PetscCall(PetscMalloc1(run->history_size, &run->history));
  }
  PetscCall(KSPSetResidualHistory(run->ksp, run->history, run->history_size, PETSC_TRUE));
  if (run->condition) PetscCall(KSPSetComputeSingularValues(run->ksp, PETSC_TRUE));
  PetscCall(KSPSetUp(run->ksp));
  PetscCall(KSPSetUpOnBlocks(run->ksp));
  PetscFunctionReturn(0);
}

static PetscErrorCode Solve(Run *run)
{
  PetscFunctionBeginUser;
  PetscCall(VecSet(run->x, 0.0));
  run->patience.expired  = PETSC_FALSE;
  run->patience.deadline = MPI_Wtime() + run->choices->seconds;
  PetscCall(KSPSolve(run->ksp, run->system->b, run->x));
  PetscFunctionReturn(0);
}

/* Set-up and solve in turn, with new objects each time, and the medians. */
static PetscErrorCode Repeat(Run *run)
{
  enum { MOST = 64 };
  MPI_Comm             comm = run->system->comm;
  PetscReal            setup[MOST], solve[MOST], begin;
  const PetscLogDouble first = MPI_Wtime();
  PetscInt             n     = 0;
  PetscBool            more  = PETSC_TRUE;

  PetscFunctionBeginUser;
  while (more) {
    PetscCall(KSPDestroy(&run->ksp));
    PetscCall(PgClock(comm, &begin));
    PetscCall(SetUp(run));
    PetscCall(PgClockSince(comm, begin, &setup[n]));
    PetscCall(PgClock(comm, &begin));
    PetscCall(Solve(run));
    PetscCall(PgClockSince(comm, begin, &solve[n]));
    n++;
    more = (PetscBool)(n < PetscMin(run->choices->repeats, MOST) && MPI_Wtime() - first < run->choices->repeat_seconds);
    PetscCallMPI(MPI_Bcast(&more, 1, MPIU_BOOL, 0, comm));
  }
  run->result->runs  = n;
  run->result->setup = PgMedian(n, setup);
  run->result->solve = PgMedian(n, solve);
  PetscFunctionReturn(0);
}

/* Iterations to tolerance at the rate of the last third of what was done. */
static PetscReal Extrapolate(PetscInt n, const PetscReal h[], PetscReal rtol)
{
  const PetscInt begin = 2 * n / 3;
  PetscReal      rate;

  if (n < 20 || !(h[n - 1] > 0.0) || !(h[begin] > h[n - 1])) return PG_TABLE_EMPTY;
  rate = PetscLogReal(h[begin] / h[n - 1]) / (PetscReal)(n - 1 - begin);
  return (PetscReal)(n - 1) + PetscLogReal(h[n - 1] / rtol) / rate;
}

static const char *Words(KSPConvergedReason reason)
{
  switch (reason) {
  case KSP_CONVERGED_RTOL:
    return "converged to rtol";
  case KSP_CONVERGED_ATOL:
    return "converged to atol";
  case KSP_CONVERGED_ITS:
    return "applied once";
  case KSP_CONVERGED_HAPPY_BREAKDOWN:
    return "converged (happy breakdown)";
  case KSP_DIVERGED_NULL:
    return "failed: breakdown";
  case KSP_DIVERGED_ITS:
    return "stopped at its iteration limit";
  case KSP_DIVERGED_DTOL:
    return "diverged: residual grew by dtol";
  case KSP_DIVERGED_BREAKDOWN:
    return "failed: breakdown of the method";
  case KSP_DIVERGED_BREAKDOWN_BICG:
    return "failed: breakdown of BiCG";
  case KSP_DIVERGED_NONSYMMETRIC:
    return "failed: matrix is not symmetric";
  case KSP_DIVERGED_INDEFINITE_PC:
    return "failed: preconditioner is indefinite";
  case KSP_DIVERGED_NANORINF:
    return "failed: NaN or infinity";
  case KSP_DIVERGED_INDEFINITE_MAT:
    return "failed: matrix is indefinite";
  case KSP_DIVERGED_PC_FAILED:
    return "failed: preconditioner could not be built";
  default:
    return reason > 0 ? "converged" : "failed";
  }
}

static PetscErrorCode Describe(Run *run)
{
  PgSolveResult  *result = run->result;
  KSPNormType     norm;
  const PetscReal rtol = run->choices->rtol;
  const char     *more = "", *but = "";
  char            needed[64] = "";

  PetscFunctionBeginUser;
  PetscCall(KSPGetNormType(run->ksp, &norm));
  if (norm == KSP_NORM_PRECONDITIONED) more = " in the preconditioned norm";
  if (norm == KSP_NORM_NATURAL) more = " in the natural norm";
  /* what the solver calls converged need not be, in another norm or by a factor that does not fit */
  if (result->reason > 0 && result->residual > 10.0 * rtol)
    but = ", but the residual is above 10 rtol";
  else if (result->reason > 0 && run->system->reference && result->error > 10.0 * rtol)
    but = ", but the error is above 10 rtol";
  if (result->reason == KSP_DIVERGED_ITS && !isnan(result->needed))
    PetscCall(PetscSNPrintf(needed, sizeof needed, ", at its last rate %.2g", (double)result->needed));
  if (run->patience.expired)
    PetscCall(PetscSNPrintf(result->words, sizeof result->words, "stopped after %g s%s%s",
                            (double)run->choices->seconds, needed, more));
  else
    PetscCall(PetscSNPrintf(result->words, sizeof result->words, "%s%s%s%s", Words(result->reason), needed, more, but));
  PetscFunctionReturn(0);
}

/* The true residual and the difference from the reference, without its mean when any constant is a solution. */
static PetscErrorCode Judge(Run *run)
{
  PgSystem *s     = run->system;
  PetscReal scale = s->rhs_norm > 0.0 ? s->rhs_norm : 1.0, norm, largest;
  PetscInt  size;

  PetscFunctionBeginUser;
  PetscCall(MatMult(s->A, run->x, run->r));
  PetscCall(VecAYPX(run->r, -1.0, s->b));
  PetscCall(VecNorm(run->r, NORM_2, &norm));
  run->result->residual = norm / scale;
  if (!s->reference) PetscFunctionReturn(0);
  PetscCall(VecGetSize(s->b, &size));
  PetscCall(VecWAXPY(run->r, -1.0, s->reference, run->x));
  if (s->singular) {
    PetscScalar sum;
    PetscCall(VecSum(run->r, &sum));
    PetscCall(VecShift(run->r, -sum / (PetscReal)size));
  }
  PetscCall(VecNorm(run->r, NORM_INFINITY, &norm));
  PetscCall(VecNorm(s->reference, NORM_INFINITY, &largest));
  run->result->error = largest > 0.0 ? norm / largest : norm;
  PetscFunctionReturn(0);
}

static PetscErrorCode Read(Run *run)
{
  PgSolveResult  *result = run->result;
  const PetscReal scale  = run->system->rhs_norm > 0.0 ? run->system->rhs_norm : 1.0;
  PetscInt        n;

  PetscFunctionBeginUser;
  PetscCall(KSPGetIterationNumber(run->ksp, &result->iterations));
  PetscCall(KSPGetConvergedReason(run->ksp, &result->reason));
  PetscCall(KSPGetResidualHistory(run->ksp, NULL, &n));
  for (PetscInt i = 0; i < n; i++) run->history[i] /= scale;
  result->needed = result->reason > 0 ? (PetscReal)result->iterations
                                      : Extrapolate(n, run->history, run->choices->rtol);
  PetscCall(PetscMalloc1(n, &result->history));
  PetscCall(PetscArraycpy(result->history, run->history, n));
  result->history_length = n;
  PetscCall(Judge(run));
  PetscCall(Describe(run));
  PetscFunctionReturn(0);
}

/* Levels, and entries of all levels over those of the first. BoomerAMG gives its operators away, so this is the last
   thing done with it. */
static PetscErrorCode Hierarchy(Run *run)
{
  PC        pc;
  PetscBool mg, hypre, boomeramg = PETSC_FALSE;
  PetscReal grid;

  PetscFunctionBeginUser;
  PetscCall(KSPGetPC(run->ksp, &pc));
  PetscCall(PetscObjectTypeCompareAny((PetscObject)pc, &mg, PCMG, PCGAMG, PCML, ""));
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCHYPRE, &hypre));
  if (mg) {
    PetscCall(PCMGGetLevels(pc, &run->result->levels));
    PetscCall(PCMGGetGridComplexity(pc, &grid, &run->result->complexity));
  }
#if defined(PETSC_HAVE_HYPRE)
  if (hypre) {
    const char *type;
    PetscCall(PCHYPREGetType(pc, &type));
    PetscCall(PetscStrcmp(type, "boomeramg", &boomeramg));
  }
#endif
  if (boomeramg) {
    Mat      *coarse;
    PetscInt  levels;
    PetscReal finest = run->system->stored * (PetscReal)run->system->n, sum = finest;
    PetscCall(PCGetCoarseOperators(pc, &levels, &coarse));
    for (PetscInt l = 0; l < levels - 1; l++) {
      MatInfo info;
      PetscCall(MatGetInfo(coarse[l], MAT_GLOBAL_SUM, &info));
      sum += (PetscReal)info.nz_used;
      PetscCall(MatDestroy(&coarse[l]));
    }
    PetscCall(PetscFree(coarse));
    run->result->levels     = levels;
    run->result->complexity = sum / finest;
  }
  PetscFunctionReturn(0);
}

/* Ratio of the largest to the smallest singular value of the preconditioned matrix, as the Krylov space sees them: by
   a solve of its own that is not timed. */
static PetscErrorCode Condition(Run *run)
{
  PetscBool able;
  PetscReal most, least;

  PetscFunctionBeginUser;
  PetscCall(PetscObjectTypeCompareAny((PetscObject)run->ksp, &able, KSPCG, KSPGMRES, KSPFGMRES, ""));
  if (!able || run->result->reason <= 0) PetscFunctionReturn(0);
  PetscCall(KSPDestroy(&run->ksp));
  run->condition = PETSC_TRUE;
  PetscCall(SetUp(run));
  PetscCall(Solve(run));
  PetscCall(KSPComputeExtremeSingularValues(run->ksp, &most, &least));
  if (least > 0.0) run->result->condition = most / least;
  PetscFunctionReturn(0);
}

static PetscErrorCode All(Run *run)
{
  PetscFunctionBeginUser;
  PetscCall(Repeat(run));
  PetscCall(Read(run));
  if (run->choices->condition) PetscCall(Condition(run));
  PetscCall(Hierarchy(run));
  PetscFunctionReturn(0);
}

PetscErrorCode PgSolve(PgSystem *system, const PgSystemChoices *how, PgSolver *solver, const PgSolveChoices *choices,
                       PgSolveResult *result)
{
  Run        run = {.system = system, .how = how, .solver = solver, .choices = choices, .result = result};
  PgTrouble  trouble;
  PgOverride options = {0};

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(result, sizeof *result));
  result->residual = result->error = result->setup = result->solve = PG_TABLE_EMPTY;
  result->complexity = result->condition = result->needed = PG_TABLE_EMPTY;
  PetscCall(VecDuplicate(system->b, &run.x));
  PetscCall(VecDuplicate(system->b, &run.r));
  PetscCall(KSPConvergedDefaultCreate(&run.patience.standard));
  PetscCall(PgSolverPut(solver, solver->prefix, &options));
  PetscCall(PgTroubleBegin(&trouble));
  result->failed = All(&run);
  (void)KSPDestroy(&run.ksp);
  PetscCall(PgTroubleEnd(system->comm, &result->failed));
  PetscCall(PgSolverTake(solver, &options));
  if (result->failed)
    PetscCall(PetscSNPrintf(result->words, sizeof result->words, "failed: %s",
                            trouble.message[0] ? trouble.message : "PETSc gave an error"));
  PetscCall(KSPConvergedDefaultDestroy(run.patience.standard));
  PetscCall(PetscFree(run.history));
  PetscCall(VecDestroy(&run.x));
  PetscCall(VecDestroy(&run.r));
  PetscFunctionReturn(0);
}

PetscErrorCode PgSolveResultFree(PgSolveResult *result)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(result->history));
  PetscFunctionReturn(0);
}

/* MUMPS on any number of ranks; PETSc's own factors on one. */
static PetscErrorCode Factorise(Mat A, Vec b, Vec x)
{
  KSP         ksp;
  PC          pc;
  PetscMPIInt size;
  PetscBool   known, spd, mumps = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(PetscObjectComm((PetscObject)A), &size));
  PetscCall(MatIsSPDKnown(A, &known, &spd));
  spd = (PetscBool)(known && spd);
  PetscCall(MatGetFactorAvailable(A, MATSOLVERMUMPS, spd ? MAT_FACTOR_CHOLESKY : MAT_FACTOR_LU, &mumps));
  PetscCheck(mumps || size == 1, PETSC_COMM_SELF, PETSC_ERR_SUP, "no parallel direct solver in this PETSc");
  PetscCall(KSPCreate(PetscObjectComm((PetscObject)A), &ksp));
  PetscCall(KSPSetOptionsPrefix(ksp, "study_direct_"));
  PetscCall(KSPSetOperators(ksp, A, A));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, spd ? PCCHOLESKY : PCLU));
  if (mumps) PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(KSPSolve(ksp, b, x));
  PetscCall(KSPDestroy(&ksp));
  PetscFunctionReturn(0);
}

PetscErrorCode PgSolveDirect(Mat A, Vec b, Vec x, PetscBool *done)
{
  PgTrouble      trouble;
  PetscErrorCode code;
  PetscReal      norm;

  PetscFunctionBeginUser;
  PetscCall(PgTroubleBegin(&trouble));
  code = Factorise(A, b, x);
  PetscCall(PgTroubleEnd(PetscObjectComm((PetscObject)A), &code));
  *done = PETSC_FALSE;
  if (code) PetscFunctionReturn(0);
  PetscCall(VecNorm(x, NORM_2, &norm));
  *done = (PetscBool)isfinite(norm);
  PetscFunctionReturn(0);
}
