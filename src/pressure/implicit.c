/* The implicit method: Eq. 55 of Li, Chu & Sheng (2007) for all discs at once, by a Krylov solver. What the solver
   says is not believed: the residual is recomputed from its result. */
#include "pressureimpl.h"

static PetscErrorCode Update(PgPressure q)
{
  PetscFunctionBeginUser;
  PetscCall(PgPressureCheckSolver(q));
  PetscCall(PgPressureAssemble(q));
  PetscFunctionReturn(0);
}

static PetscErrorCode SetUpSolver(PgPressure q)
{
  PetscBool fresh;

  PetscFunctionBeginUser;
  PetscCall(PgPressureKeepPreconditioner(q, &fresh));
  PetscFunctionReturn(0);
}

/* x from the field pressure. */
static PetscErrorCode LoadGuess(PgPressure q)
{
  PetscReal   *p, *fixed, *prescribed;
  PetscScalar *x;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetArray(q->particles, q->p, &p));
  PetscCall(PgParticlesGetArray(q->particles, q->fixed, &fixed));
  PetscCall(PgParticlesGetArray(q->particles, q->prescribed, &prescribed));
  PetscCall(VecGetArrayWrite(q->x, &x));
  for (PetscInt a = 0; a < q->owned; a++) x[a] = (fixed[a] != 0.0 ? prescribed[a] : p[a]) - q->reference;
  PetscCall(VecRestoreArrayWrite(q->x, &x));
  PetscFunctionReturn(0);
}

/* The field pressure from x; prescribed values exactly, not to solver tolerance. */
static PetscErrorCode StoreResult(PgPressure q)
{
  PetscReal         *p, *fixed, *prescribed;
  const PetscScalar *x;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetArray(q->particles, q->p, &p));
  PetscCall(PgParticlesGetArray(q->particles, q->fixed, &fixed));
  PetscCall(PgParticlesGetArray(q->particles, q->prescribed, &prescribed));
  PetscCall(VecGetArrayRead(q->x, &x));
  for (PetscInt a = 0; a < q->owned; a++) p[a] = fixed[a] != 0.0 ? prescribed[a] : q->reference + x[a];
  PetscCall(VecRestoreArrayRead(q->x, &x));
  PetscCall(PgParticlesHalo(q->particles, 1, &q->p));
  PetscFunctionReturn(0);
}

/* A singular symmetric matrix can only produce right-hand sides without mean, on each island: takes the means away, and
   tells how much that was. */
static PetscErrorCode MakeCompatible(PgPressure q, PetscReal norm, PetscReal *removed)
{
  PetscScalar  sum;
  PetscReal    square = 0.0;
  PetscInt     global;
  MatNullSpace space;

  PetscFunctionBeginUser;
  PetscCall(MatGetNullSpace(q->A, &space));
  if (q->whole) {
    PetscCall(VecGetSize(q->b, &global));
    PetscCall(VecSum(q->b, &sum));
    PetscCall(MatNullSpaceRemove(space, q->b));
    square = PetscSqr(PetscRealPart(sum)) / (PetscReal)global;
  } else {
    PetscCall(MatNullSpaceRemove(space, q->b)); /* leaves what it added in island_sum */
    for (PetscInt i = 0; i < q->islands; i++) square += q->island_size[i] * PetscSqr(q->island_sum[i]);
  }
  *removed = norm > 0.0 ? PetscSqrtReal(square) / norm : 0.0;
  PetscFunctionReturn(0);
}

/* The mean of the pressure of each island, before the solve, and given back after it. */
static PetscErrorCode NoteMeans(PgPressure q)
{
  PetscReal *before = q->island_mean;

  PetscFunctionBeginUser;
  if (!q->islands) PetscFunctionReturn(0);
  if (q->whole) {
    PetscScalar sum;
    PetscCall(VecSum(q->x, &sum));
    before[0] = PetscRealPart(sum);
  } else {
    PetscCall(PgPressureIslandMeans(q, q->x, before));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode KeepMeans(PgPressure q)
{
  PetscReal *before = q->island_mean;

  PetscFunctionBeginUser;
  if (!q->islands) PetscFunctionReturn(0);
  if (q->whole) {
    PetscScalar after;
    PetscInt    global;
    PetscCall(VecGetSize(q->x, &global));
    PetscCall(VecSum(q->x, &after));
    PetscCall(VecShift(q->x, (before[0] - after) / (PetscReal)global));
  } else {
    PetscCall(PgPressureIslandMeans(q, q->x, q->island_sum));
    for (PetscInt i = 0; i < q->islands; i++) before[i] -= q->island_sum[i];
    PetscCall(PgPressureIslandShift(q, q->x, before));
  }
  PetscFunctionReturn(0);
}

/* The absolute tolerance, for right-hand sides that vanish: nothing moves, and there is nothing to be relative
   to. The smallest eigenvalue of a panel drained on one side is the diagonal over 2.2 N (measured), so a
   residual of 1e-7 Pa * diagonal/N is an error of about 2e-7 Pa in the pressure at most. Nor can a residual be
   asked for that is below the rounding of the terms it is made of: those of the guess, and what was
   removed from b. */
static PetscErrorCode ChooseTolerance(PgPressure q, PetscReal given_rhs, PetscReal guess, PetscReal *rtol,
                                      PetscReal *atol)
{
  PetscReal dtol, rounding;
  PetscInt  max_it, global;

  PetscFunctionBeginUser;
  PetscCall(VecGetSize(q->b, &global));
  PetscCall(KSPGetTolerances(q->ksp, rtol, atol, &dtol, &max_it));
  rounding = 4.0 * PETSC_MACHINE_EPSILON * (q->largest * guess + given_rhs);
  if (!q->user_atol) *atol = PetscMax(1e-7 * q->smallest / (PetscReal)global, rounding);
  PetscFunctionReturn(0);
}

/* Runs the solver and recomputes what it leaves: ||b - A x||. With b = 0 PETSc would take rtol relative to the
   residual of the guess; only the absolute tolerance counts there. */
static PetscErrorCode Run(PgPressure q, PetscReal rhs, PetscReal rtol, PetscReal atol, KSPConvergedReason *reason,
                          PetscReal *residual)
{
  PetscReal dtol;
  PetscInt  max_it;

  PetscFunctionBeginUser;
  PetscCall(KSPGetTolerances(q->ksp, NULL, NULL, &dtol, &max_it));
  PetscCall(KSPSetTolerances(q->ksp, rhs > 0.0 ? rtol : 0.0, atol, dtol, max_it));
  PetscCall(KSPSolve(q->ksp, q->b, q->x));
  PetscCall(KSPSetTolerances(q->ksp, rtol, atol, dtol, max_it));
  PetscCall(KSPGetConvergedReason(q->ksp, reason));
  PetscCall(MatMult(q->A, q->x, q->r));
  PetscCall(VecAYPX(q->r, -1.0, q->b));
  PetscCall(VecNorm(q->r, NORM_2, residual));
  PetscFunctionReturn(0);
}

/* Where the residual is largest, in words; one that is not a number is the largest. The same on all ranks. */
static PetscErrorCode DescribeWorst(PgPressure q, char text[], size_t length)
{
  const PetscScalar *r, *x;
  const PetscInt    *id;
  PetscReal         *position, sent[5] = {0}, worst = -1.0;
  PetscInt           at = 0;
  PetscMPIInt        holder;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetIds(q->particles, &id));
  PetscCall(PgParticlesGetArray(q->particles, PG_POSITION, &position));
  PetscCall(VecGetArrayRead(q->r, &r));
  PetscCall(VecGetArrayRead(q->x, &x));
  for (PetscInt i = 0; i < q->owned; i++) {
    const PetscReal size = PetscIsInfOrNanScalar(r[i]) ? PETSC_MAX_REAL : PetscAbsScalar(r[i]);
    if (size < worst || (size == worst && id[i] > id[at])) continue;
    worst = size;
    at    = i;
  }
  PetscCall(PgFindHolder(q->comm, worst, q->owned ? id[at] : -1, 0, &holder));
  if (q->owned) {
    const PetscReal values[5] = {(PetscReal)id[at], position[2 * at], position[2 * at + 1], PetscRealPart(r[at]),
                                 PetscRealPart(x[at]) + q->reference};
    PetscCall(PetscArraycpy(sent, values, 5));
  }
  PetscCall(VecRestoreArrayRead(q->r, &r));
  PetscCall(VecRestoreArrayRead(q->x, &x));
  PetscCallMPI(MPI_Bcast(sent, 5, MPIU_REAL, holder, q->comm));
  PetscCall(PetscSNPrintf(text, length,
                          "largest at disc %" PetscInt_FMT " at (%g, %g) m: residual %g Pa, pressure %g Pa",
                          (PetscInt)sent[0], (double)sent[1], (double)sent[2], (double)sent[3], (double)sent[4]));
  PetscFunctionReturn(0);
}

/* What is known to be behind a failure, with a cure; empty: nothing is. */
static PetscErrorCode Diagnose(PgPressure q, const PgPressureStats *stats, char why[], size_t length)
{
  PetscInt loose, least;

  PetscFunctionBeginUser;
  why[0] = '\0';
  if (!q->islands && q->symmetric) PetscFunctionReturn(0);
  PetscCall(PgPressureCountLoose(q, &loose, &least));
  if (!q->symmetric && loose)
    PetscCall(PetscSNPrintf(why, length,
                            "nothing ties %" PetscInt_FMT " discs (disc %" PetscInt_FMT
                            " is one) to a prescribed pressure, and the corrected Laplacian is not symmetric: which "
                            "right-hand sides this singular system can bear is not known; use -sph_laplacian paper; ",
                            loose, least));
  else if (loose && stats->reason == KSP_DIVERGED_PC_FAILED)
    PetscCall(PetscSNPrintf(why, length,
                            "the matrix is singular, as nothing ties %" PetscInt_FMT " discs (disc %" PetscInt_FMT
                            " is one) to a prescribed pressure, and has no complete factor: use a Krylov method "
                            "(options/solvers/cg-hypre.opts), MUMPS that looks for null pivots "
                            "(options/solvers/mumps.opts), or make a side drained; ",
                            loose, least));
  PetscFunctionReturn(0);
}

/* "LU with FACTOR_NUMERIC_ZEROPIVOT", of a preconditioner that could not be built. */
static PetscErrorCode DescribeFailedFactor(PgPressure q, char text[], size_t length)
{
  PC             pc;
  PCType         type;
  PCFailedReason reason;

  PetscFunctionBeginUser;
  PetscCall(KSPGetPC(q->ksp, &pc));
  PetscCall(PCGetType(pc, &type));
  PetscCall(PCGetFailedReason(pc, &reason));
  PetscCall(PetscSNPrintf(text, length, "the preconditioner (%s) could not be built: %s", type,
                          reason ? PCFailedReasons[reason] : "unknown reason"));
  PetscFunctionReturn(0);
}

static PetscErrorCode Fail(PgPressure q, const PgPressureStats *stats, PetscReal rtol, PetscReal atol)
{
  const PetscBool finite = (PetscBool)!PetscIsInfOrNanReal(stats->residual);
  PetscBool       written;
  const char     *note;
  char            worst[256], why[512];

  PetscFunctionBeginUser;
  if (stats->reason == KSP_DIVERGED_PC_FAILED)
    PetscCall(DescribeFailedFactor(q, worst, sizeof worst));
  else if (finite)
    PetscCall(DescribeWorst(q, worst, sizeof worst));
  else
    PetscCall(PetscSNPrintf(worst, sizeof worst, "the result holds values that are no numbers"));
  PetscCall(PgPressureWriteSystem(q, q->failure, &written));
  PetscCall(Diagnose(q, stats, why, sizeof why));
  note = written ? "the system was written to" : "the system could not be written to";
  if (stats->reason > 0)
    PgRunError(q->comm,
               "pressure: %sthe solver reported %s after %" PetscInt_FMT
               " iterations but the true residual is %g (rtol %g, atol %g, ||b|| = %g Pa, residuals relative to it), "
               "%s; %s %s",
               why, KSPConvergedReasons[stats->reason], stats->iterations, (double)stats->residual, (double)rtol,
               (double)atol, (double)stats->rhs_norm, worst, note, q->failure);
  if (!finite)
    PgRunError(q->comm,
               "pressure: %sthe solver stopped with %s after %" PetscInt_FMT
               " iterations (rtol %g, ||b|| = %g Pa), %s; %s %s",
               why, KSPConvergedReasons[stats->reason], stats->iterations, (double)rtol, (double)stats->rhs_norm, worst,
               note, q->failure);
  PgRunError(q->comm,
             "pressure: %sthe solver stopped with %s after %" PetscInt_FMT
             " iterations, relative residual %g (rtol %g, ||b|| = %g Pa), %s; %s %s",
             why, KSPConvergedReasons[stats->reason], stats->iterations, (double)stats->residual, (double)rtol,
             (double)stats->rhs_norm, worst, note, q->failure);
}

/* What this solve says about the next: growing iterations, or a failure that is let pass, ask for a new
   preconditioner. */
static void JudgePreconditioner(PgPressure q, PetscInt iterations, PetscBool good)
{
  if (q->served == 0) q->first_iterations = iterations;
  q->served++;
  if (!good || (PetscReal)iterations > q->rebuild_factor * (PetscReal)q->first_iterations + 2.0) q->stale = PETSC_TRUE;
}

static PetscErrorCode Solve(PgPressure q, PgPressureStats *stats)
{
  PetscReal          rhs, guess, residual, rtol = 0.0, atol = 0.0, scale;
  PetscBool          fresh, good;
  KSPConvergedReason reason;
  KSPNormType        norm;

  PetscFunctionBeginUser;
  PetscCall(PgPressureFillRhs(q));
  PetscCall(LoadGuess(q));
  PetscCall(VecNorm(q->b, NORM_2, &rhs));
  PetscCall(VecNorm(q->x, NORM_2, &guess));
  PetscCall(ChooseTolerance(q, rhs, guess, &rtol, &atol));
  PetscCall(NoteMeans(q));
  if (q->islands) {
    PetscCall(MakeCompatible(q, rhs, &stats->removed));
    PetscCall(VecNorm(q->b, NORM_2, &rhs));
  }
  PetscCall(PgPressureKeepPreconditioner(q, &fresh));
  q->history[0] = -1.0;
  PetscCall(Run(q, rhs, rtol, atol, &reason, &residual));
  good = (PetscBool)(reason > 0 && residual <= 10.0 * PetscMax(rtol * rhs, atol));
  if (!good && !fresh && q->error_if_not_converged) {
    /* an old preconditioner may be to blame: one more try before the run ends */
    PetscCall(PetscInfo(q->ksp, "Failed with a kept preconditioner, once more with a new one\n"));
    PetscCall(LoadGuess(q));
    PetscCall(PgPressureBuildPreconditioner(q));
    PetscCall(Run(q, rhs, rtol, atol, &reason, &residual));
    good = (PetscBool)(reason > 0 && residual <= 10.0 * PetscMax(rtol * rhs, atol));
  }
  PetscCall(KeepMeans(q));
  scale = rhs > 0.0 ? rhs : 1.0;
  PetscCall(KSPGetIterationNumber(q->ksp, &stats->iterations));
  PetscCall(KSPGetNormType(q->ksp, &norm));
  stats->reason   = (int)reason;
  stats->rhs_norm = rhs;
  stats->residual = residual / scale;
  stats->initial  = norm == KSP_NORM_UNPRECONDITIONED && q->history[0] >= 0.0 ? q->history[0] / scale : -1.0;
  if (!good && q->error_if_not_converged) PetscCall(Fail(q, stats, rtol, atol));
  JudgePreconditioner(q, stats->iterations, good);
  PetscCall(StoreResult(q));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureCreate_Implicit(PgPressure q)
{
  PetscFunctionBeginUser;
  q->ops = (PgPressureOps){PG_PRESSURE_IMPLICIT, Update, Solve, SetUpSolver};
  PetscFunctionReturn(0);
}
