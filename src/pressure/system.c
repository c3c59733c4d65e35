/* The equations of the present geometry without a matrix: pair weights, right-hand side, residual
   (Li, Chu & Sheng 2007, Eqs. 52-55). Sums run in ascending id of the partner, so they have the same rounding
   on any number of ranks. */
#include "pressureimpl.h"

/* What all ranks must know of each other, as one maximum. */
enum { ANY_FIXED, BAD_DISC, SMALLEST, LARGEST, NEW_LISTS, NEW_NUMBERS, NEW_SIZE, UNTIED, FACTS };

static PetscErrorCode Reserve(PgPressure q)
{
  PetscReal **by_entry[] = {&q->weight};
  PetscReal **by_disc[]  = {&q->diagonal, &q->source, &q->lift, &q->next};

  PetscFunctionBeginUser;
  PetscCall(PgPressureGrow(q->ptr[q->owned], &q->entries, 1, by_entry));
  PetscCall(PgPressureGrow(q->owned, &q->rows, 4, by_disc));
  PetscFunctionReturn(0);
}

/* The diagonal of a disc with a prescribed pressure and no neighbours: any positive number near the others
   will do. In two dimensions the diagonal has no unit; on the hexagonal lattice it is 4.3 kappa. */
static const PetscReal lone_diagonal = 4.0;

PG_CLONES static void WeighRows(PgPressure q, const PetscReal laplacian[], const PetscReal volume[],
                                const PetscReal kappa[])
{
  for (PetscInt a = 0; a < q->owned; a++) {
    PetscReal sum = 0.0;
    for (PetscInt k = q->ptr[a]; k < q->ptr[a + 1]; k++) {
      PetscReal w = -laplacian[k] * volume[a];
      if (kappa) {
        const PetscReal ka = kappa[a], kb = kappa[q->col[k]];
        w *= 2.0 * ka * kb / (ka + kb);
      }
      q->weight[k] = w;
      sum += w;
    }
    q->diagonal[a] = sum;
  }
}

static void Inspect(PgPressure q, const PetscReal fixed[], const PetscReal kappa[], const PetscInt id[],
                    PetscReal fact[FACTS])
{
  /* rows of the corrected Laplacian at a side can have one; a Krylov solver bears it, a sweep does not */
  const PetscBool negative_allowed = (PetscBool)(!q->symmetric && q->ops.kind == PG_PRESSURE_IMPLICIT);

  for (PetscInt a = 0; a < q->owned; a++) {
    if (fixed[a] != 0.0) {
      fact[ANY_FIXED] = 1.0;
      if (!(q->diagonal[a] > 0.0)) q->diagonal[a] = lone_diagonal * (kappa ? kappa[a] : 1.0);
    } else if (!(q->diagonal[a] > 0.0) && !(negative_allowed && q->diagonal[a] < 0.0)) {
      fact[BAD_DISC] = PetscMax(fact[BAD_DISC], (PetscReal)id[a]);
    }
    fact[SMALLEST] = PetscMax(fact[SMALLEST], -PetscAbsReal(q->diagonal[a]));
    fact[LARGEST]  = PetscMax(fact[LARGEST], PetscAbsReal(q->diagonal[a]));
  }
}

/* Whether rows belong to other discs than at the last call. The revision of the particles alone would say so too
   often: it counts changes among the ghosts. */
static PetscErrorCode CompareRows(PgPressure q, PetscBool *changed)
{
  const PetscInt *id;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetIds(q->particles, &id));
  *changed = PETSC_TRUE;
  if (q->owned == q->known) PetscCall(PetscArraycmp(id, q->row_id, q->owned, changed));
  if (q->owned == q->known) *changed = (PetscBool) !*changed;
  if (!*changed) PetscFunctionReturn(0);
  if (q->owned > q->known_size) {
    PetscCall(PetscFree(q->row_id));
    PetscCall(PetscMalloc1(q->owned + q->owned / 8, &q->row_id));
    q->known_size = q->owned + q->owned / 8;
  }
  PetscCall(PetscArraycpy(q->row_id, id, q->owned));
  q->known = q->owned;
  PetscFunctionReturn(0);
}

static PetscErrorCode Agree(PgPressure q, const PetscReal fixed[], PetscReal fact[FACTS])
{
  PetscInt  lists, numbers, rows = q->owned;
  PetscBool renumbered = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PgNeighborsGetRevision(q->neighbors, &lists));
  PetscCall(PgParticlesGetRevision(q->particles, &numbers));
  if (numbers != q->particles_revision) PetscCall(CompareRows(q, &renumbered));
  if (q->A) PetscCall(MatGetLocalSize(q->A, &rows, NULL));
  fact[NEW_LISTS]       = lists != q->neighbors_revision || numbers != q->particles_revision;
  fact[NEW_NUMBERS]     = renumbered;
  fact[NEW_SIZE]        = rows != q->owned;
  fact[UNTIED]          = !q->tied || fact[NEW_LISTS] > 0.0 || !PgPressureTiesHold(q, fixed);
  q->neighbors_revision = lists;
  q->particles_revision = numbers;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, fact, FACTS, MPIU_REAL, MPI_MAX, q->comm));
  q->new_lists   = (PetscBool)(q->new_lists || fact[NEW_LISTS] > 0.0);
  q->new_numbers = (PetscBool)(q->new_numbers || fact[NEW_NUMBERS] > 0.0);
  q->resize      = (PetscBool)(q->resize || fact[NEW_SIZE] > 0.0);
  q->tied        = (PetscBool)(fact[UNTIED] == 0.0);
  q->singular    = (PetscBool)(fact[ANY_FIXED] == 0.0);
  q->smallest    = -fact[SMALLEST];
  q->largest     = fact[LARGEST];
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureComputeWeights(PgPressure q, const PetscReal kappa[])
{
  PgSphCoefficients c;
  PetscReal        *volume, *fixed, fact[FACTS] = {0.0, -1.0, -PETSC_MAX_REAL, 0.0, 0.0, 0.0, 0.0, 0.0};
  const PetscInt   *id;

  PetscFunctionBeginUser;
  PetscCall(PgSphGetCoefficients(q->sph, &c));
  PetscCall(PgParticlesGetSizes(q->particles, &q->owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(q->particles, q->volume, &volume));
  PetscCall(PgParticlesGetArray(q->particles, q->fixed, &fixed));
  PetscCall(PgParticlesGetIds(q->particles, &id));
  q->ptr       = c.ptr;
  q->col       = c.col;
  q->symmetric = c.symmetric;
  PetscCall(Reserve(q));
  WeighRows(q, c.laplacian, volume, kappa);
  Inspect(q, fixed, kappa, id, fact);
  PetscCall(Agree(q, fixed, fact));
  if (fact[BAD_DISC] >= 0.0)
    PgRunError(
        q->comm,
        "pressure: the equation of disc %" PetscInt_FMT
        " has no usable diagonal: the disc has no neighbours, its pair weights are not finite, or (explicit sweeps "
        "with the corrected Laplacian) their sum is negative",
        (PetscInt)fact[BAD_DISC]);
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureComputeSource(PgPressure q, const PetscReal Z[])
{
  PetscReal *volume, *fixed, *prescribed;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetArray(q->particles, q->volume, &volume));
  PetscCall(PgParticlesGetArray(q->particles, q->fixed, &fixed));
  PetscCall(PgParticlesGetArray(q->particles, q->prescribed, &prescribed));
  for (PetscInt a = 0; a < q->owned; a++) {
    if (fixed[a] != 0.0)
      q->source[a] = q->diagonal[a] * (prescribed[a] - q->reference);
    else
      q->source[a] = Z ? -Z[a] * volume[a] : 0.0;
  }
  q->source_current = PETSC_TRUE;
  q->rhs_current    = PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureResidual(PgPressure q, PetscReal *residual, PetscReal *rhs, PetscReal *sum)
{
  PgExactSum exact[3] = {{.not_finite = 0}, {.not_finite = 0}, {.not_finite = 0}};
  PetscReal *p, *fixed, total[3];

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetArray(q->particles, q->p, &p));
  PetscCall(PgParticlesGetArray(q->particles, q->fixed, &fixed));
  for (PetscInt a = 0; a < q->owned; a++) {
    PetscReal b = q->source[a], r = b - q->diagonal[a] * (p[a] - q->reference);
    if (fixed[a] == 0.0) {
      for (PetscInt k = q->ptr[a]; k < q->ptr[a + 1]; k++) {
        const PetscReal flow = q->weight[k] * (p[q->col[k]] - q->reference);
        r += flow;
        if (fixed[q->col[k]] != 0.0) b += flow;
      }
    }
    PgExactSumAdd(&exact[0], r * r);
    PgExactSumAdd(&exact[1], b * b);
    PgExactSumAdd(&exact[2], b);
  }
  PetscCall(PgExactSumReduce(q->comm, 3, exact, total));
  *residual = PetscSqrtReal(total[0]);
  *rhs      = PetscSqrtReal(total[1]);
  *sum      = PetscAbsReal(total[2]);
  PetscFunctionReturn(0);
}
