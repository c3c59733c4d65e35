/* The object: options, life, the registry of methods, and what it shows to other rooms. */
#include "pressureimpl.h"

static PetscFunctionList methods = NULL;

static PetscErrorCode ForgetMethods(void)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFunctionListDestroy(&methods));
  PetscFunctionReturn(0);
}

static PetscErrorCode RegisterMethods(void)
{
  PetscFunctionBeginUser;
  if (methods) PetscFunctionReturn(0);
  PetscCall(PetscFunctionListAdd(&methods, "explicit", PgPressureCreate_Explicit));
  PetscCall(PetscFunctionListAdd(&methods, "implicit", PgPressureCreate_Implicit));
  PetscCall(PetscRegisterFinalize(ForgetMethods));
  PetscFunctionReturn(0);
}

static PetscErrorCode SetMethod(PgPressure pressure, const char name[])
{
  PetscErrorCode (*create)(PgPressure);

  PetscFunctionBeginUser;
  PetscCall(PetscFunctionListFind(methods, name, &create));
  PetscCheck(create, pressure->comm, PETSC_ERR_ARG_UNKNOWN_TYPE, "no pressure method '%s'", name);
  PetscCall(PetscStrncpy(pressure->method, name, sizeof pressure->method));
  PetscCall((*create)(pressure));
  PetscFunctionReturn(0);
}

/* Capacity for `needed` reals in each of the arrays; what they held is lost. */
PetscErrorCode PgPressureGrow(PetscInt needed, PetscInt *capacity, PetscInt arrays, PetscReal **array[])
{
  PetscFunctionBeginUser;
  if (needed <= *capacity) PetscFunctionReturn(0);
  *capacity = needed + needed / 8; /* lists grow and shrink by a little: room for it saves allocations */
  for (PetscInt i = 0; i < arrays; i++) {
    PetscCall(PetscFree(*array[i]));
    PetscCall(PetscMalloc1(*capacity, array[i]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureCreate(PgParticles particles, PgNeighbors neighbors, PgSph sph, PgPressure *pressure)
{
  const PgFieldInfo p          = {"pressure", 1, "Pa", "pore pressure",
                                  PG_FIELD_MIGRATE | PG_FIELD_HALO | PG_FIELD_OUTPUT | PG_FIELD_RESTART};
  const PgFieldInfo fixed      = {"pressure_fixed", 1, "1", "1 where the pressure is prescribed, 0 elsewhere",
                                  PG_FIELD_MIGRATE | PG_FIELD_HALO | PG_FIELD_RESTART};
  const PgFieldInfo prescribed = {"pressure_prescribed", 1, "Pa", "prescribed pressure, where there is one",
                                  PG_FIELD_MIGRATE | PG_FIELD_HALO | PG_FIELD_RESTART};
  const PgFieldInfo island     = {"pressure_island", 1, "1",
                                  "id of one of the discs that share a level of pressure, the same for all of them; -1 "
                                      "where a prescribed pressure sets the level",
                                  PG_FIELD_HALO};
  PgPressure        q;

  PetscFunctionBeginUser;
  PetscCall(RegisterMethods());
  PetscCall(PetscNew(&q));
  q->particles = particles;
  q->neighbors = neighbors;
  q->sph       = sph;
  q->comm      = PgParticlesComm(particles);
  PetscCall(PgParticlesRegisterField(particles, &p, &q->p));
  PetscCall(PgParticlesRegisterField(particles, &fixed, &q->fixed));
  PetscCall(PgParticlesRegisterField(particles, &prescribed, &q->prescribed));
  PetscCall(PgParticlesRegisterField(particles, &island, &q->island_label));
  PetscCall(PgParticlesFindField(particles, "volume", &q->volume));
  q->coefficient            = -1;
  q->reference              = 1e5;
  q->sweeps                 = 1;
  q->rebuild_factor         = 1.5;
  q->error_if_not_converged = PETSC_TRUE;
  q->neighbors_revision     = -1;
  q->particles_revision     = -1;
  q->known                  = -1;
  PetscCall(PetscStrncpy(q->failure, "porograin-failed.petsc", sizeof q->failure));
  PetscCall(PgPressureCreateSolver(q, &q->ksp));
  PetscCall(KSPSetResidualHistory(q->ksp, q->history, 1, PETSC_TRUE));
  PetscCall(SetMethod(q, "implicit"));
  *pressure = q;
  PetscFunctionReturn(0);
}

static PetscErrorCode ChooseMethod(PgPressure q, PetscOptionItems *PetscOptionsObject)
{
  const char **name;
  int          count;
  PetscInt     choice = 0;
  char         chosen[32];

  PetscFunctionBeginUser;
  PetscCall(PetscFunctionListGet(methods, &name, &count));
  while (count > 0 && !name[count - 1]) count--; /* PETSc 3.18 counts the NULL at the end, too */
  while (count > 0 && !name[count - 1]) count--; /* some versions of PETSc count the end mark */
  for (int i = 0; i < count; i++) {
    PetscBool same;
    PetscCall(PetscStrcmp(name[i], q->method, &same));
    if (same) choice = i;
  }
  PetscCall(PgOptionChoice(PetscOptionsObject, "-pressure",
                           "how Eq. 55 is solved: sweeps of the paper, or a Krylov solver to tolerance", count, name,
                           &choice, NULL));
  PetscCall(PetscStrncpy(chosen, name[choice], sizeof chosen));
  PetscCall(PetscFree(name));
  PetscCall(SetMethod(q, chosen));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadSolverOptions(void *pressure)
{
  PgPressure q = (PgPressure)pressure;

  PetscFunctionBeginUser;
  PetscCall(PgPressureSolverFromOptions(q, q->ksp));
  PetscFunctionReturn(0);
}

/* PETSc takes any number. */
static PetscErrorCode CheckTolerances(PgPressure q)
{
  PetscReal rtol, atol, dtol;
  PetscInt  max_it;

  PetscFunctionBeginUser;
  PetscCall(KSPGetTolerances(q->ksp, &rtol, &atol, &dtol, &max_it));
  PgInputCheck(rtol >= 0.0 && rtol < 1.0, q->comm,
               "option -pressure_ksp_rtol: %g is out of range, it must be >= 0 and < 1", (double)rtol);
  PgInputCheck(atol >= 0.0 && atol < PETSC_INFINITY, q->comm,
               "option -pressure_ksp_atol: %g Pa is out of range, it must be >= 0 Pa", (double)atol);
  PgInputCheck(dtol > 0.0, q->comm, "option -pressure_ksp_divtol: %g is out of range, it must be > 0", (double)dtol);
  PgInputCheck(max_it >= 1, q->comm, "option -pressure_ksp_max_it: %" PetscInt_FMT " is out of range, it must be >= 1",
               max_it);
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureSetFromOptions(PgPressure q)
{
  PetscBool user_lag, user_error;

  PetscFunctionBeginUser;
  PetscOptionsBegin(q->comm, "", PG_PRESSURE_SECTION, "");
  PetscCall(ChooseMethod(q, PetscOptionsObject));
  PetscCall(PgOptionInt(PetscOptionsObject, "-pressure_sweeps", "explicit: sweeps of Eq. 55 per solve", 1,
                        PETSC_MAX_INT, &q->sweeps, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-pressure_reference",
                         "pressure whose excess is the unknown, so that tolerances are relative to what drives the "
                         "flow; best the pressure of the drained sides",
                         "Pa", -1e12, 1e12, &q->reference, NULL));
  PetscCall(PgOptionInt(PetscOptionsObject, "-pressure_pc_lag",
                        "solves one preconditioner serves at most; 0: until iterations grow or discs are renumbered; "
                        "default: 0, but 1 for a single sweep (-pressure_ksp_type richardson -pressure_ksp_max_it 1)",
                        0, PETSC_MAX_INT, &q->pc_lag, &user_lag));
  PetscCall(PgOptionReal(PetscOptionsObject, "-pressure_rebuild_factor",
                         "a new preconditioner when iterations exceed this times those of the first solve after the "
                         "last build, plus 2",
                         "1", 1.0, 1e6, &q->rebuild_factor, NULL));
  PetscCall(PgOptionBool(PetscOptionsObject, "-pressure_error_if_not_converged",
                         "end the run when a solve fails or its true residual is above tolerance; default: true, but "
                         "false for a single sweep",
                         &q->error_if_not_converged, &user_error));
  PetscCall(PgOptionString(PetscOptionsObject, "-pressure_dump",
                           "file for matrix, right-hand side and solution of chosen solves (PETSc binary)", q->dump,
                           sizeof q->dump, NULL));
  PetscCall(PgOptionInt(PetscOptionsObject, "-pressure_dump_every",
                        "write every so many solves, each to a numbered file; 0: the first solve only", 0,
                        PETSC_MAX_INT, &q->dump_every, NULL));
  PetscOptionsEnd();
  PetscCall(PetscOptionsHasName(NULL, "pressure_", "-ksp_type", &q->user_type));
  PetscCall(PetscOptionsHasName(NULL, "pressure_", "-ksp_atol", &q->user_atol));
  PetscCall(PgPressureMentionOptions());
  if (q->dump[0]) PetscCall(PgPressureCheckDump(q));
  PetscCall(PgOptionsRead(q->comm, "pressure_", ReadSolverOptions, PgPressureProbeOptions, q));
  PetscCall(CheckTolerances(q));
  if (q->fixed_work && !user_error) q->error_if_not_converged = PETSC_FALSE;
  if (q->fixed_work && !user_lag) q->pc_lag = 1; /* the diagonal is that of this matrix */
  q->from_options = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureView(PgPressure q, PetscViewer viewer)
{
  const PetscBool implicit = (PetscBool)(q->ops.kind == PG_PRESSURE_IMPLICIT);

  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(viewer, "pressure: %s, reference %g Pa\n", q->method, (double)q->reference));
  PetscCall(PetscViewerASCIIPushTab(viewer));
  if (implicit) {
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "preconditioner kept for %" PetscInt_FMT " solves (0: no limit), rebuilt above "
                                     "%g times its first iterations plus 2; %s when a solve fails\n",
                                     q->pc_lag, (double)q->rebuild_factor,
                                     q->error_if_not_converged ? "stop" : "go on"));
  } else {
    PetscCall(PetscViewerASCIIPrintf(viewer, "%" PetscInt_FMT " sweeps per solve\n", q->sweeps));
  }
  PetscCall(PetscViewerASCIIPrintf(viewer, "a failed system is written to %s\n", q->failure));
  if (q->dump[0])
    PetscCall(PetscViewerASCIIPrintf(viewer, "systems are written to %s every %" PetscInt_FMT " solves (0: once)\n",
                                     q->dump, q->dump_every));
  if (implicit && q->fixed_work)
    PetscCall(PetscViewerASCIIPrintf(viewer, "a single sweep in each solve: convergence is not asked for\n"));
  if (implicit) {
    KSPType   type;
    PC        pc;
    PCType    preconditioner;
    PetscReal rtol;
    PetscCall(KSPGetType(q->ksp, &type));
    PetscCall(KSPGetPC(q->ksp, &pc));
    PetscCall(PCGetType(pc, &preconditioner));
    PetscCall(KSPGetTolerances(q->ksp, &rtol, NULL, NULL, NULL));
    PetscCall(PetscViewerASCIIPrintf(viewer, "solver %s with %s, rtol %g; all of it by -pressure_ksp_view\n", type,
                                     preconditioner, (double)rtol));
  }
  PetscCall(PetscViewerASCIIPopTab(viewer));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureDestroy(PgPressure *pressure)
{
  PgPressure q = *pressure;

  PetscFunctionBeginUser;
  if (!q) PetscFunctionReturn(0);
  PetscCall(KSPDestroy(&q->ksp));
  PetscCall(PgPressureDestroyMatrix(q));
  PetscCall(PgPressureDestroyIslands(q));
  PetscCall(PetscFree(q->entry_at));
  PetscCall(PetscFree(q->diagonal_at));
  PetscCall(PetscFree(q->weight));
  PetscCall(PetscFree(q->diagonal));
  PetscCall(PetscFree(q->source));
  PetscCall(PetscFree(q->lift));
  PetscCall(PetscFree(q->next));
  PetscCall(PetscFree(q->row_id));
  PetscCall(PetscFree(*pressure));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureGetMethod(PgPressure q, PgPressureMethod *method)
{
  PetscFunctionBeginUser;
  *method = q->ops.kind;
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureSetReference(PgPressure q, PetscReal reference)
{
  PetscFunctionBeginUser;
  q->reference = reference;
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureRequestResidual(PgPressure q, PetscBool request)
{
  PetscFunctionBeginUser;
  q->residual_requested = request;
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureSetFailureFile(PgPressure q, const char file[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(q->failure, file, sizeof q->failure));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureGetWork(PgPressure q, PgPressureWork *work)
{
  PetscFunctionBeginUser;
  *work = q->work;
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureGetCounts(PgPressure q, PetscInt *patterns, PetscInt *fills, PetscInt *preconditioners)
{
  PetscFunctionBeginUser;
  if (patterns) *patterns = q->patterns;
  if (fills) *fills = q->fills;
  if (preconditioners) *preconditioners = q->preconditioners;
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureForgetPreconditioner(PgPressure q)
{
  PetscFunctionBeginUser;
  /* a restarted run knows neither the factors nor the ordering or coarsening made for an earlier pattern */
  q->stale = q->restructured = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureAddState(PgPressure q, PgState state)
{
  PetscFunctionBeginUser;
  PetscCall(PgStateAddInts(state, "pressure_solves", PG_STATE_KEEP, NULL, 1, &q->solves));
  PetscFunctionReturn(0);
}

/* Ghosts of the conditions in one message; the coefficient travels as a field from its first use on. */
static PetscErrorCode ExchangeConditions(PgPressure q, const PetscReal coefficient[], const PetscReal **kappa)
{
  PgField    field[3] = {q->fixed, q->prescribed, -1};
  PetscInt   count    = 2;
  PetscReal *all;

  PetscFunctionBeginUser;
  *kappa = NULL;
  if (coefficient) {
    const PgFieldInfo info = {"pressure_coefficient", 1, "1", "kappa in div(kappa grad p) = Z", PG_FIELD_HALO};
    PetscInt          owned;
    if (q->coefficient < 0) PetscCall(PgParticlesRegisterField(q->particles, &info, &q->coefficient));
    PetscCall(PgParticlesGetSizes(q->particles, &owned, NULL, NULL));
    PetscCall(PgParticlesGetArray(q->particles, q->coefficient, &all));
    PetscCall(PetscArraycpy(all, coefficient, owned));
    *kappa         = all;
    field[count++] = q->coefficient;
  }
  PetscCall(PgParticlesHalo(q->particles, count, field));
  PetscFunctionReturn(0);
}

static PetscErrorCode Update(PgPressure q, const PetscReal coefficient[])
{
  const PetscReal *kappa;

  PetscFunctionBeginUser;
  PetscCall(ExchangeConditions(q, coefficient, &kappa));
  PetscCall(PgPressureComputeWeights(q, kappa));
  q->matrix_current = q->source_current = PETSC_FALSE;
  PetscCall((*q->ops.update)(q));
  PetscFunctionReturn(0);
}

/* The stage ends even when the work fails, for callers that live on. */
PetscErrorCode PgPressureUpdate(PgPressure q, const PetscReal coefficient[])
{
  PetscErrorCode err;

  PetscFunctionBeginUser;
  PetscCall(PgStagePush(PG_STAGE_ASSEMBLE));
  err = Update(q, coefficient);
  PetscCall(PgStagePop());
  PetscCall(err);
  PetscFunctionReturn(0);
}

static PetscErrorCode Solve(PgPressure q, const PetscReal Z[], PgPressureStats *stats)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(stats, sizeof *stats));
  stats->singular = q->ops.kind == PG_PRESSURE_IMPLICIT ? (PetscBool)(q->islands > 0) : q->singular;
  PetscCall(PgPressureComputeSource(q, Z));
  PetscCall((*q->ops.solve)(q, stats));
  if (q->dump[0] && (q->dump_every ? q->solves % q->dump_every == 0 : q->solves == 0)) PetscCall(PgPressureDump(q));
  q->solves++;
  q->work.solves++;
  q->work.iterations += stats->iterations;
  q->work.most = PetscMax(q->work.most, stats->iterations);
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureSolve(PgPressure q, const PetscReal Z[], PgPressureStats *stats)
{
  PetscErrorCode err;

  PetscFunctionBeginUser;
  PetscCall(PgStagePush(PG_STAGE_PRESSURE));
  err = Solve(q, Z, stats);
  PetscCall(PgStagePop());
  PetscCall(err);
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureSetUpSolver(PgPressure q)
{
  PetscFunctionBeginUser;
  if (q->ops.setup) PetscCall((*q->ops.setup)(q));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureGetSystem(PgPressure q, Mat *A, Vec *b, KSP *ksp)
{
  PetscFunctionBeginUser;
  if (!q->matrix_current) PetscCall(PgPressureAssemble(q));
  /* an implicit solve left its own right-hand side, explicit sweeps have none; before any solve Z is 0 */
  if (!q->source_current) PetscCall(PgPressureComputeSource(q, NULL));
  if (!q->rhs_current) PetscCall(PgPressureFillRhs(q));
  if (A) *A = q->A;
  if (b) *b = q->b;
  if (ksp) *ksp = q->ksp;
  PetscFunctionReturn(0);
}
