/* The explicit method: sweeps of p_a = (L_b + Z_a)/L_a (Li, Chu & Sheng 2007, Eq. 55), every disc from the
   pressures its neighbours had before the sweep. That is the Richardson iteration with the inverse diagonal as
   preconditioner, x += D^-1 (b - A x), written without a matrix. */
#include "pressureimpl.h"

static PetscErrorCode Update(PgPressure q)
{
  PetscFunctionBeginUser;
  (void)q; /* the weights are all a sweep needs */
  PetscFunctionReturn(0);
}

/* One sweep. When asked, *residual takes the sum of (D (x_new - x_old))^2: the squared residual before the sweep. */
PG_CLONES static PetscErrorCode Sweep(PgPressure q, PetscReal p[], const PetscReal fixed[], PgExactSum *residual)
{
  PetscFunctionBeginUser;
  for (PetscInt a = 0; a < q->owned; a++) {
    PetscReal flow = q->source[a];
    if (fixed[a] != 0.0) {
      q->next[a] = p[a];
      continue;
    }
    for (PetscInt k = q->ptr[a]; k < q->ptr[a + 1]; k++) flow += q->weight[k] * (p[q->col[k]] - q->reference);
    q->next[a] = q->reference + flow / q->diagonal[a];
    if (residual) PgExactSumAdd(residual, PetscSqr(flow - q->diagonal[a] * (p[a] - q->reference)));
  }
  PetscCall(PetscArraycpy(p, q->next, q->owned));
  PetscFunctionReturn(0);
}

/* Compares with a right-hand side of zero as it stands, see PgPressureStats. */
static PetscReal Relative(PetscReal norm, PetscReal rhs) { return rhs > 0.0 ? norm / rhs : norm; }

static PetscErrorCode Solve(PgPressure q, PgPressureStats *stats)
{
  PgExactSum exact = {.not_finite = 0};
  PetscReal *p, *fixed, *prescribed, first, residual, sum;
  PetscInt   global;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetArray(q->particles, q->p, &p));
  PetscCall(PgParticlesGetArray(q->particles, q->fixed, &fixed));
  PetscCall(PgParticlesGetArray(q->particles, q->prescribed, &prescribed));
  for (PetscInt a = 0; a < q->owned; a++)
    if (fixed[a] != 0.0) p[a] = prescribed[a];
  for (PetscInt sweep = 0; sweep < q->sweeps; sweep++) {
    PetscCall(PgParticlesHalo(q->particles, 1, &q->p));
    PetscCall(Sweep(q, p, fixed, sweep == 0 && q->residual_requested ? &exact : NULL));
  }
  PetscCall(PgParticlesHalo(q->particles, 1, &q->p));

  stats->iterations = q->sweeps;
  stats->residual = stats->initial = stats->removed = stats->rhs_norm = -1.0;
  if (!q->residual_requested) PetscFunctionReturn(0);
  PetscCall(PgPressureResidual(q, &residual, &stats->rhs_norm, &sum));
  PetscCall(PgExactSumReduce(q->comm, 1, &exact, &first));
  PetscCall(PgParticlesGetSizes(q->particles, NULL, NULL, &global));
  stats->residual = Relative(residual, stats->rhs_norm);
  stats->initial  = Relative(PetscSqrtReal(first), stats->rhs_norm);
  stats->removed  = q->singular && sum > 0.0 ? sum / PetscSqrtReal((PetscReal)global) / stats->rhs_norm : 0.0;
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureCreate_Explicit(PgPressure q)
{
  PetscFunctionBeginUser;
  q->ops = (PgPressureOps){PG_PRESSURE_EXPLICIT, Update, Solve, NULL};
  PetscFunctionReturn(0);
}
