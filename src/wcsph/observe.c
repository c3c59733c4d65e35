/* What others ask of the liquid. */
#include "wcsphimpl.h"

PetscErrorCode PgWcsphGetSolids(PgWcsph w, PgWcsphKind kind, PgWcsphSolids *solids)
{
  PgWcsphArrays f;
  PetscInt      n = 0;

  PetscFunctionBeginUser;
  PetscCheck(w->set_up, w->comm, PETSC_ERR_ORDER, "PgWcsphSetUp() comes first");
  PetscCall(PgWcsphGetArrays(w, &f));
  if (f.owned > w->solids_room || !w->solid_body) {
    w->solids_room = f.owned + f.owned / 8 + 16;
    PetscCall(PetscFree5(w->solid_body, w->solid_index, w->solid_x, w->solid_force, w->solid_p));
    PetscCall(PetscMalloc5(w->solids_room, &w->solid_body, w->solids_room, &w->solid_index, 2 * w->solids_room,
                           &w->solid_x, 2 * w->solids_room, &w->solid_force, w->solids_room, &w->solid_p));
  }
  for (PetscInt a = 0; a < f.owned; a++) {
    if (f.kind[a] != (PetscReal)kind) continue;
    w->solid_body[n]  = (PetscInt)f.body[a];
    w->solid_index[n] = (PetscInt)f.index[a];
    w->solid_p[n]     = f.p[a];
    for (int d = 0; d < 2; d++) {
      w->solid_x[2 * n + d]     = f.x[2 * a + d];
      w->solid_force[2 * n + d] = f.force[2 * a + d];
    }
    n++;
  }
  *solids = (PgWcsphSolids){n, w->solid_body, w->solid_index, w->solid_x, w->solid_force, w->solid_p};
  PetscFunctionReturn(0);
}

enum { POINT_SUMS = 5 };

/* Adds what liquid particle a means at x; an image of it on the other side of a period counts, too. */
static void AddAt(PgWcsph w, const PgWcsphArrays *f, PetscInt a, const PetscReal x[2], PetscReal period,
                  PgExactSum sum[POINT_SUMS])
{
  const PgReal2 g = PgTwo(w->gravity, 0);

  for (int image = period > 0.0 ? -1 : 0; image <= (period > 0.0 ? 1 : 0); image++) {
    const PgReal2   d = {x[0] - (f->x[2 * a] + image * period), x[1] - f->x[2 * a + 1]};
    const PetscReal r = PetscSqrtReal(PgDot(d, d));
    PetscReal       W;
    if (!(r < w->kernel->support * w->h)) continue;
    W = w->kernel->w(r / w->h) / (w->h * w->h);
    PgExactSumAdd(&sum[0], W);
    PgExactSumAdd(&sum[1], W * (f->p[a] + f->rho[a] * PgDot(g, d)));
    PgExactSumAdd(&sum[2], W * f->v[2 * a]);
    PgExactSumAdd(&sum[3], W * f->v[2 * a + 1]);
    PgExactSumAdd(&sum[4], W * f->m[a] / f->rho[a]);
  }
}

PetscErrorCode PgWcsphInterpolate(PgWcsph w, PetscInt count, const PetscReal x[], PetscReal pressure[],
                                  PetscReal velocity[], PetscReal weight[])
{
  PgWcsphArrays f;
  PgExactSum   *sum;
  PetscReal    *value, low, high, period = 0.0;
  PetscBool     periodic;

  PetscFunctionBeginUser;
  PetscCheck(w->set_up, w->comm, PETSC_ERR_ORDER, "PgWcsphSetUp() comes first");
  PetscCall(PgWcsphGetArrays(w, &f));
  PetscCall(PgParticlesGetPeriodicX(w->particles, &periodic, &low, &high));
  if (periodic) period = high - low;
  PetscCall(PetscCalloc2(POINT_SUMS * count, &sum, POINT_SUMS * count, &value));
  for (PetscInt n = 0; n < count; n++)
    for (PetscInt a = 0; a < f.owned; a++)
      if (PgWcsphIsLiquid(&f, a)) AddAt(w, &f, a, x + 2 * n, period, sum + POINT_SUMS * n);
  PetscCall(PgExactSumReduce(w->comm, POINT_SUMS * count, sum, value));
  for (PetscInt n = 0; n < count; n++) {
    const PetscReal *s     = value + POINT_SUMS * n;
    const PetscReal  scale = s[0] > 0.0 ? 1.0 / s[0] : 0.0;
    pressure[n]            = s[1] * scale;
    if (velocity) velocity[2 * n] = s[2] * scale;
    if (velocity) velocity[2 * n + 1] = s[3] * scale;
    if (weight) weight[n] = s[4];
  }
  PetscCall(PetscFree2(sum, value));
  PetscFunctionReturn(0);
}

enum { KINETIC, INTERNAL, POTENTIAL, MOMENTUM_X, MOMENTUM_Y, FORCE_X, FORCE_Y, SUMS };

static PetscErrorCode AddTotals(PgWcsph w, const PgWcsphArrays *f, PgExactSum sum[SUMS])
{
  const PetscReal V = w->dx * w->dx, K = w->contact * w->rho_0 * w->c_0 * w->c_0;
  PetscReal      *crossings = NULL, low = 0.0, high = 0.0;
  PetscBool       periodic;
  PgField         field;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetPeriodicX(w->particles, &periodic, &low, &high));
  if (periodic) {
    PetscCall(PgParticlesFindField(w->particles, "crossings", &field));
    PetscCall(PgParticlesGetArray(w->particles, field, &crossings));
  }
  for (PetscInt a = 0; a < f->owned; a++) {
    const PgReal2 v = PgTwo(f->v, a);
    if (!PgWcsphIsLiquid(f, a)) {
      if (w->solid == PG_WCSPH_OWN) PgExactSumAdd(&sum[INTERNAL], f->m[a] * PgWcsphEnergy(w, f->rho[a]));
      if (K > 0.0) PgExactSumAdd(&sum[INTERNAL], 0.5 * V * PetscSqr(f->contact_pressure[a]) / K);
      if (f->kind[a] != (PetscReal)PG_WCSPH_WALL) continue;
      PgExactSumAdd(&sum[FORCE_X], f->force[2 * a]);
      PgExactSumAdd(&sum[FORCE_Y], f->force[2 * a + 1]);
      continue;
    }
    PgExactSumAdd(&sum[KINETIC], 0.5 * f->m[a] * PgDot(v, v));
    PgExactSumAdd(&sum[INTERNAL], f->m[a] * PgWcsphEnergy(w, f->rho[a]));
    PgExactSumAdd(&sum[POTENTIAL],
                  -f->m[a] * (w->gravity[0] * (f->x[2 * a] + (crossings ? crossings[a] : 0.0) * (high - low)) +
                              w->gravity[1] * f->x[2 * a + 1]));
    PgExactSumAdd(&sum[MOMENTUM_X], f->m[a] * v[0]);
    PgExactSumAdd(&sum[MOMENTUM_Y], f->m[a] * v[1]);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphGetTotals(PgWcsph w, PgWcsphTotals *totals)
{
  PgWcsphArrays f;
  PgExactSum    sum[SUMS] = {{.not_finite = 0}};
  PetscReal     value[SUMS], most[3] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL, 0.0};

  PetscFunctionBeginUser;
  PetscCheck(w->set_up, w->comm, PETSC_ERR_ORDER, "PgWcsphSetUp() comes first");
  PetscCall(PgWcsphGetArrays(w, &f));
  PetscCall(AddTotals(w, &f, sum));
  for (PetscInt a = 0; a < f.owned; a++) {
    const PgReal2 v = PgTwo(f.v, a);
    if (!PgWcsphIsLiquid(&f, a)) continue;
    most[0] = PetscMax(most[0], f.rho[a]);
    most[1] = PetscMax(most[1], -f.rho[a]);
    most[2] = PetscMax(most[2], PgDot(v, v));
  }
  PetscCall(PgExactSumReduce(w->comm, SUMS, sum, value));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 3, MPIU_REAL, MPIU_MAX, w->comm));
  *totals = (PgWcsphTotals){.kinetic     = value[KINETIC],
                            .internal    = value[INTERNAL],
                            .potential   = value[POTENTIAL],
                            .momentum    = {value[MOMENTUM_X], value[MOMENTUM_Y]},
                            .force       = {value[FORCE_X], value[FORCE_Y]},
                            .density_min = -most[1],
                            .density_max = most[0],
                            .speed_max   = PetscSqrtReal(most[2])};
  PetscFunctionReturn(0);
}
