/* One step of the generalised trapezoidal rule (T59). The equations are linear: what is left of them at the guess,
   the old state with the new values of held unknowns, is solved for. */
#include "femimpl.h"

/* v and a at the end of the step when u goes from `start` to `end`. */
static void Rates(PetscReal end, PetscReal start, PetscReal v, PetscReal a, PetscReal dt, PetscReal theta,
                  PetscReal *v_end, PetscReal *a_end)
{
  *v_end = (end - start) / (theta * dt) - (1.0 - theta) / theta * v;
  *a_end = (*v_end - v) / (theta * dt) - (1.0 - theta) / theta * a;
}

static PetscErrorCode Assemble(PgFem fem, PetscReal dt, PetscReal theta)
{
  PetscReal end[PG_FEM_DOFS], start[PG_FEM_DOFS], a[PG_FEM_DOFS], left[PG_FEM_DOFS], x[4][2];

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(fem->load, fem->size));
  for (PetscInt c = 0; c < fem->cells; c++) {
    const PetscInt   *dof = fem->dof + c * fem->dofs;
    PgFemCoefficients k;
    PetscCall(PgFemCoefficientsOf(fem, c, dt, theta, &k));
    PgFemCellX(fem, c, x);
    for (PetscInt i = 0; i < fem->dofs; i++) {
      end[i]   = fem->next[dof[i]];
      start[i] = fem->u[dof[i]];
      if (fem->inertia && i < 2 * fem->un) {
        PetscReal v_end, a_end;
        Rates(end[i], start[i], fem->v[dof[i]], fem->a[dof[i]], dt, theta, &v_end, &a_end);
        a[i] = a_end + fem->damping * v_end;
      }
    }
    PgFemElementResidual(&fem->shape, fem->un, &k, x, end, start, fem->inertia ? a : NULL, fem->gravity, left);
    for (PetscInt i = 0; i < fem->dofs; i++) fem->load[dof[i]] += left[i];
  }
  PetscCall(PgFemAddLoads(fem, fem->time + dt, fem->time + theta * dt, dt, fem->load));
  PetscFunctionReturn(0);
}

/* Adds up what ranks have, with slaves counting for their masters. */
static PetscErrorCode FillRhs(PgFem fem)
{
  PetscScalar *local;

  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < fem->plates; m++) {
    const PgFemPlate *plate = &fem->plate[m];
    PetscReal         mine  = 0.0, all;
    for (PetscInt k = 0; k < plate->count; k++) mine += fem->load[plate->slave[k]];
    PetscCallMPI(MPI_Allreduce(&mine, &all, 1, MPIU_REAL, MPIU_SUM, fem->comm));
    if (plate->owner == fem->rank) fem->load[plate->master_local] += all;
  }
  PetscCall(VecGetArray(fem->local, &local));
  for (PetscInt d = 0; d < fem->size; d++) local[d] = fem->fixed[d] ? 0.0 : fem->load[d];
  PetscCall(VecRestoreArray(fem->local, &local));
  PetscCall(VecSet(fem->b, 0.0));
  PetscCall(VecScatterBegin(fem->scatter, fem->local, fem->b, ADD_VALUES, SCATTER_REVERSE));
  PetscCall(VecScatterEnd(fem->scatter, fem->local, fem->b, ADD_VALUES, SCATTER_REVERSE));
  PetscFunctionReturn(0);
}

static PetscErrorCode TakeSolution(PgFem fem)
{
  const PetscScalar *local;

  PetscFunctionBeginUser;
  PetscCall(VecScatterBegin(fem->scatter, fem->w, fem->local, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(fem->scatter, fem->w, fem->local, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGetArrayRead(fem->local, &local));
  for (PetscInt d = 0; d < fem->size; d++)
    if (!fem->fixed[d]) fem->next[d] += PetscRealPart(local[d]) * (fem->is_pressure[d] ? fem->scale : 1.0);
  PetscCall(VecRestoreArrayRead(fem->local, &local));
  for (PetscInt m = 0; m < fem->plates; m++) {
    PgFemPlate *plate = &fem->plate[m];
    if (plate->owner == fem->rank) plate->displacement = fem->next[plate->master_local];
    PetscCallMPI(MPI_Bcast(&plate->displacement, 1, MPIU_REAL, (PetscMPIInt)plate->owner, fem->comm));
    for (PetscInt k = 0; k < plate->count; k++) fem->next[plate->slave[k]] = plate->displacement;
  }
  PetscFunctionReturn(0);
}

/* Of the next step. The acceleration at the start is not known, which backward Euler does not ask for. */
static PetscReal NextTheta(const PgFem fem)
{
  return fem->step < fem->start_steps || (fem->inertia && fem->step == 0) ? 1.0 : fem->theta;
}

PetscErrorCode PgFemSetUpSolver(PgFem fem, PetscReal dt)
{
  PetscFunctionBeginUser;
  PetscCheck(fem->dof, fem->comm, PETSC_ERR_ORDER, "PgFemSetUp() comes before PgFemSetUpSolver()");
  PgInputCheck(dt > 0.0 && dt < PETSC_MAX_REAL, fem->comm, "up: a step of %g s; it must be > 0 s", (double)dt);
  PetscCall(PgFemSystemBuild(fem, dt, NextTheta(fem)));
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemStep(PgFem fem, PetscReal dt)
{
  const PetscReal theta = NextTheta(fem);

  PetscFunctionBeginUser;
  PetscCheck(fem->dof, fem->comm, PETSC_ERR_ORDER, "PgFemSetUp() comes before PgFemStep()");
  PgInputCheck(dt > 0.0 && dt < PETSC_MAX_REAL, fem->comm, "up: a step of %g s; it must be > 0 s", (double)dt);
  PetscCall(PgStagePush(PG_STAGE_ASSEMBLE));
  PetscCall(PgFemSystemBuild(fem, dt, theta));
  PetscCall(PetscArraycpy(fem->next, fem->u, fem->size));
  PetscCall(PgFemPrescribe(fem, fem->time + dt, fem->next));
  PetscCall(Assemble(fem, dt, theta));
  PetscCall(FillRhs(fem));
  PetscCall(PgStagePop());
  PetscCall(PgStagePush(PG_STAGE_PRESSURE));
  PetscCall(PgFemSolve(fem));
  PetscCall(PgStagePop());
  PetscCall(TakeSolution(fem));
  for (PetscInt d = 0; d < fem->size; d++) {
    PetscReal v = (fem->next[d] - fem->u[d]) / dt, a = 0.0;
    if (fem->inertia) Rates(fem->next[d], fem->u[d], fem->v[d], fem->a[d], dt, theta, &v, &a);
    fem->v[d] = v;
    fem->a[d] = a;
    fem->u[d] = fem->next[d];
  }
  fem->time += dt;
  fem->step++;
  PetscFunctionReturn(0);
}
