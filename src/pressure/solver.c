/* The Krylov solver and its preconditioner: defaults, the user's options, and when to build anew. */
#include "pressureimpl.h"

static PetscErrorCode SetDefaultPreconditioner(PC pc)
{
  PetscFunctionBeginUser;
#if defined(PETSC_HAVE_HYPRE)
  PetscBool chosen;

  PetscCall(PCSetType(pc, PCHYPRE));
  /* PETSc reads -pc_hypre_type only while none is set */
  PetscCall(PetscOptionsHasName(NULL, "pressure_", "-pc_hypre_type", &chosen));
  if (!chosen) PetscCall(PCHYPRESetType(pc, "boomeramg"));
#else
  PetscCall(PCSetType(pc, PCGAMG));
#endif
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureCreateSolver(PgPressure q, KSP *ksp)
{
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(KSPCreate(q->comm, ksp));
  PetscCall(KSPSetOptionsPrefix(*ksp, "pressure_"));
  PetscCall(KSPSetType(*ksp, KSPCG));
  /* the preconditioned norm, PETSc's default, differs from the residual by up to two digits either way */
  PetscCall(KSPSetNormType(*ksp, KSP_NORM_UNPRECONDITIONED));
  /* PETSc measures divergence against b: when b has all but vanished in one step, the residual of the last pressure
     would count as divergence before the first iteration. What truly diverges ends by the number of iterations. */
  PetscCall(KSPSetTolerances(*ksp, 1e-8, PETSC_DEFAULT, 1e30, 1000));
  PetscCall(KSPSetInitialGuessNonzero(*ksp, PETSC_TRUE));
  PetscCall(KSPGetPC(*ksp, &pc));
  PetscCall(SetDefaultPreconditioner(pc));
  PetscFunctionReturn(0);
}

/* Methods that know one norm only (preonly: none; minres: the preconditioned one) refuse ours, which they then
   must not be given. PETSc has no question for that, so its answer to KSPGetNormType() is taken. */
static PetscErrorCode SettleNorm(KSP ksp)
{
  KSPNormType    norm;
  PetscErrorCode refused;

  PetscFunctionBeginUser;
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  refused = KSPGetNormType(ksp, &norm);
  PetscCall(PetscPopErrorHandler());
  if (refused) PetscCall(KSPSetNormType(ksp, KSP_NORM_DEFAULT));
  PetscFunctionReturn(0);
}

/* Whoever asks Richardson's method for one iteration wants a sweep, not a solution: no norm is computed, and none asked
   for. One who switches the norm off by hand, with any number of iterations, must say as well that no solution is
   wanted. */
static PetscErrorCode SettleWork(KSP ksp, PetscBool user_norm, PetscBool *fixed)
{
  PetscBool richardson;
  PetscInt  most;

  PetscFunctionBeginUser;
  PetscCall(PetscObjectTypeCompare((PetscObject)ksp, KSPRICHARDSON, &richardson));
  PetscCall(KSPGetTolerances(ksp, NULL, NULL, NULL, &most));
  *fixed = (PetscBool)(richardson && most == 1 && !user_norm);
  if (*fixed) PetscCall(KSPSetNormType(ksp, KSP_NORM_NONE));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureMentionOptions(void)
{
  static const struct {
    const char *name, *initial, *text;
  } option[] = {
    {"-pressure_ksp_type", "cg", "Krylov method"},
    {"-pressure_ksp_rtol", "1e-08", "norm of the residual to reach, over that of the right-hand side"},
    {"-pressure_ksp_atol", "1e-50", "norm of the residual that is small enough in any case [Pa]"},
    {"-pressure_ksp_max_it", "1000", "most iterations of a solve"},
    {"-pressure_ksp_norm_type", "unpreconditioned", "norm of the residual that is compared with the tolerances"},
    {"-pressure_ksp_divtol", "1e+30", "growth of the residual that counts as divergence"},
    {"-pressure_ksp_monitor", "", "prints the residual of each iteration"},
    {"-pressure_ksp_view", "", "prints the solver"},
#if defined(PETSC_HAVE_HYPRE)
    {"-pressure_pc_type", "hypre", "preconditioner"},
    {"-pressure_pc_hypre_type", "boomeramg", "preconditioner of hypre"},
#else
    {"-pressure_pc_type", "gamg", "preconditioner"},
#endif
    {"-pressure_mat_type", "aij", "kind of matrix, one of the aij types"},
  };

  PetscFunctionBeginUser;
  for (size_t i = 0; i < sizeof option / sizeof *option; i++)
    PetscCall(PgOptionsMention(PG_PRESSURE_SECTION, option[i].name, option[i].initial, "", option[i].text));
  PetscCall(PgOptionsMention(PG_PRESSURE_SECTION, "-pressure_*", "", "",
                             "every option of PETSc's KSP, PC and Mat with this prefix (-pressure_ksp_gmres_restart, "
                             "-pressure_pc_gamg_threshold, -pressure_mg_levels_ksp_max_it, ...): see "
                             "https://petsc.org/release/manualpages/, or -help petsc"));
  PetscFunctionReturn(0);
}

/* What PETSc reads only when it solves would count as unknown before the first step: ask for it here. */
static PetscErrorCode KnowLateOptions(void)
{
  static const char *const name[] = {"-ksp_converged_reason",
                                     "-ksp_converged_reason_view_cancel",
                                     "-ksp_final_residual",
                                     "-ksp_test_null_space",
                                     "-ksp_plot_eigenvalues",
                                     "-ksp_plot_eigenvalues_explicitly",
                                     "-ksp_plot_eigencontours",
                                     "-ksp_view",
                                     "-ksp_view_pre",
                                     "-ksp_view_mat",
                                     "-ksp_view_pmat",
                                     "-ksp_view_rhs",
                                     "-ksp_view_solution",
                                     "-ksp_view_mat_explicit",
                                     "-ksp_view_diagonal_scale",
                                     "-ksp_view_eigenvalues_explicit",
                                     "-ksp_view_preconditioned_operator_explicit"};
  PetscBool                set;

  PetscFunctionBeginUser;
  for (size_t i = 0; i < sizeof name / sizeof *name; i++)
    PetscCall(PetscOptionsHasName(NULL, "pressure_", name[i], &set));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureSolverFromOptions(PgPressure q, KSP ksp)
{
  PetscBool preonly, user_norm;

  PetscFunctionBeginUser;
  PetscCall(KSPSetFromOptions(ksp));
  PetscCall(KnowLateOptions());
  PetscCall(PetscOptionsHasName(NULL, "pressure_", "-ksp_norm_type", &user_norm));
  if (!user_norm) PetscCall(SettleNorm(ksp));
  PetscCall(PetscObjectTypeCompare((PetscObject)ksp, KSPPREONLY, &preonly));
  if (preonly) PetscCall(KSPSetInitialGuessNonzero(ksp, PETSC_FALSE)); /* it knows no guess */
  PetscCall(SettleWork(ksp, user_norm, &q->fixed_work));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureCheckSolver(PgPressure q)
{
  PetscBool needs_symmetry;
  KSPType   type;

  PetscFunctionBeginUser;
  if (q->symmetric) PetscFunctionReturn(0);
  PgInputCheck(!q->singular, q->comm,
               "pressure: no disc has a prescribed pressure, and the corrected Laplacian is not symmetric: which "
               "right-hand sides this singular system can bear is not known; use -sph_laplacian paper, or make a side "
               "drained (-bc_left drained)");
  PetscCall(PetscObjectTypeCompareAny((PetscObject)q->ksp, &needs_symmetry, KSPCG, KSPPIPECG, KSPPIPECGRR, KSPPIPELCG,
                                      KSPPIPEPRCG, KSPPIPECG2, KSPGROPPCG, KSPFCG, KSPPIPEFCG, KSPNASH, KSPSTCG,
                                      KSPGLTR, KSPQCG, KSPMINRES, KSPSYMMLQ, KSPCR, KSPPIPECR, ""));
  if (!needs_symmetry) PetscFunctionReturn(0);
  PetscCall(KSPGetType(q->ksp, &type));
  PgInputCheck(!q->user_type, q->comm,
               "option -pressure_ksp_type: %s needs a symmetric matrix, the corrected Laplacian has none; use gmres or "
               "bcgs, or -sph_laplacian paper",
               type);
  PetscCall(KSPSetType(q->ksp, KSPGMRES));
  PetscCall(PgPressureSolverFromOptions(q, q->ksp));
  PetscFunctionReturn(0);
}

/* BoomerAMG solves its coarsest grid by elimination without pivoting. For a singular matrix the last pivot is
   rounding, and the constant comes back multiplied by 1e16: smoothing there costs nothing and is safe. */
static PetscErrorCode ChooseCoarseSolver(PgPressure q, PC pc)
{
#if defined(PETSC_HAVE_HYPRE)
  const char *const option   = "-pressure_pc_hypre_boomeramg_relax_type_coarse";
  const PetscBool   singular = (PetscBool)(q->islands > 0);
  PetscBool         hypre, boomeramg = PETSC_FALSE, users;

  PetscFunctionBeginUser;
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCHYPRE, &hypre));
  if (hypre) {
    const char *name;
    PetscCall(PCHYPREGetType(pc, &name));
    PetscCall(PetscStrcmp(name, "boomeramg", &boomeramg));
  }
  PetscCall(PetscOptionsHasName(NULL, NULL, option, &users));
  if (!boomeramg || users || singular == q->coarse_is_singular) PetscFunctionReturn(0);
  PetscCall(PetscOptionsSetValue(NULL, option, singular ? "symmetric-SOR/Jacobi" : "Gaussian-elimination"));
  PetscCall(PCSetFromOptions(pc));
  PetscCall(PetscOptionsClearValue(NULL, option));
  q->coarse_is_singular = singular;
  PetscFunctionReturn(0);
#else
  PetscFunctionBeginUser;
  (void)q;
  (void)pc;
  PetscFunctionReturn(0);
#endif
}

/* A preconditioner without a past: nothing that one keeps between builds (orderings, interpolation) may come from
   another pattern or numbering. PCReset() is not enough: the solvers inside GAMG keep their old sizes. */
static PetscErrorCode StartAfresh(PgPressure q)
{
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(KSPReset(q->ksp));
  PetscCall(PCCreate(q->comm, &pc));
  PetscCall(PCSetOptionsPrefix(pc, "pressure_"));
  PetscCall(SetDefaultPreconditioner(pc));
  if (q->from_options) PetscCall(PCSetFromOptions(pc));
  PetscCall(KSPSetPC(q->ksp, pc));
  PetscCall(PCDestroy(&pc));
  q->coarse_is_singular = PETSC_FALSE;
  PetscFunctionReturn(0);
}

static PetscErrorCode SetUpSolvers(void *pressure)
{
  PgPressure q = (PgPressure)pressure;

  PetscFunctionBeginUser;
  PetscCall(KSPSetUp(q->ksp));
  PetscCall(KSPSetUpOnBlocks(q->ksp));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureBuildPreconditioner(PgPressure q)
{
  PC pc;

  PetscFunctionBeginUser;
  if (q->restructured && q->preconditioners) PetscCall(StartAfresh(q));
  PetscCall(KSPGetPC(q->ksp, &pc));
  PetscCall(ChooseCoarseSolver(q, pc));
  PetscCall(KSPSetReusePreconditioner(q->ksp, PETSC_FALSE));
  PetscCall(KSPSetOperators(q->ksp, q->A, q->A));
  if (q->preconditioners)
    PetscCall(SetUpSolvers(q));
  else /* the solvers inside read their options */
    PetscCall(PgOptionsRead(q->comm, "pressure_", SetUpSolvers, PgPressureProbeOptions, q));
  PetscCall(KSPSetReusePreconditioner(q->ksp, PETSC_TRUE));
  q->built            = PETSC_TRUE;
  q->stale            = PETSC_FALSE;
  q->restructured     = PETSC_FALSE;
  q->served           = 0;
  q->first_iterations = 0;
  q->built_fills      = q->fills;
  q->preconditioners++;
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureKeepPreconditioner(PgPressure q, PetscBool *fresh)
{
  PetscBool preonly;

  PetscFunctionBeginUser;
  /* preonly takes the preconditioner for the inverse: an old one would be the inverse of another matrix */
  PetscCall(PetscObjectTypeCompare((PetscObject)q->ksp, KSPPREONLY, &preonly));
  if (!q->built || q->stale || (q->pc_lag && q->served >= q->pc_lag) || (preonly && q->fills != q->built_fills))
    PetscCall(PgPressureBuildPreconditioner(q));
  *fresh = (PetscBool)(q->served == 0);
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureProbeOptions(void *pressure)
{
  PgPressure q = (PgPressure)pressure;
  KSP        ksp;
  Mat        A;

  PetscFunctionBeginUser;
  /* An object prints its options once only, so fresh ones are asked; and so does a prefix, which PETSc remembers even
     when no help was wanted. */
  PetscCall(PetscOptionsHelpPrintedDestroy(&PetscOptionsHelpPrintedSingleton));
  PetscCall(PgPressureCreateSolver(q, &ksp));
  PetscCall(PgPressureSolverFromOptions(q, ksp));
  if (q->A) {
    PetscCall(KSPSetOperators(ksp, q->A, q->A));
    PetscCall(KSPSetUp(ksp)); /* solvers inside the preconditioner exist only then */
    PetscCall(KSPSetUpOnBlocks(ksp));
  }
  PetscCall(KSPDestroy(&ksp));
  PetscCall(PetscOptionsHelpPrintedDestroy(&PetscOptionsHelpPrintedSingleton)); /* matrices of the above */
  PetscCall(MatCreate(q->comm, &A));
  PetscCall(MatSetOptionsPrefix(A, "pressure_"));
  PetscCall(MatSetFromOptions(A));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(0);
}
