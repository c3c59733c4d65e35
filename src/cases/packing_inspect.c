/* A look at a packing before it is used: overlaps, discs outside the box, porosity. Pairs are not stored and the search
   ends where overlaps abound, so that a file with all discs in one place is refused like any other. Sums are exact and
   a pair is measured by the owner of its smaller id: the findings are the same on any number of ranks. */
#include "packingimpl.h"

enum { SAMPLES = 20000 };            /* circles for the sampled porosity, about */
enum { PILED_UP = 200000 };          /* overlaps deeper than the smaller radius on a rank that end the search */
static const PetscReal circle = 4.0; /* radius of a sample in units of r_a, Eq. 61 */

typedef struct {
  PgParticles        particles;
  const PgBox       *box;
  PgPackingFindings *f;
  PetscReal          reach;  /* centres of partners are nearer [m] */
  PetscInt           stride; /* ids between samples; 0: none */
  PetscInt           owned, local, piled;
  const PetscInt    *id;
  PetscReal         *x, *r;
  /* cells, as start of their discs */
  PetscReal low[2], per_length;
  PetscInt  cells[2], *start, *disc;
  /* of this rank */
  PgExactSum area, common, sampled, circles;
} Search;

/* ---- discs where their neighbours are ---- */

static PetscErrorCode Radii(MPI_Comm comm, const char from[], const PgPacking *packing, PgPackingFindings *f)
{
  PetscReal  most[2] = {0, -PETSC_MAX_REAL};
  PgExactSum sum     = {.not_finite = 0};

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < packing->count; i++) {
    most[0] = PetscMax(most[0], packing->radius[i]);
    most[1] = PetscMax(most[1], -packing->radius[i]);
    PgExactSumAdd(&sum, packing->radius[i]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 2, MPIU_REAL, MPIU_MAX, comm));
  PetscCall(PgExactSumReduce(comm, 1, &sum, &f->radius_mean));
  f->radius_mean /= (PetscReal)packing->global;
  f->radius_min = -most[1];
  f->radius_max = most[0];
  PgInputCheck(f->radius_max <= 100 * f->radius_min, comm,
               "packing '%s': the largest radius, %g m, is more than 100 times the smallest, %g m: the search for "
               "neighbours cannot deal with that",
               from, (double)f->radius_max, (double)f->radius_min);
  PetscFunctionReturn(0);
}

static PetscErrorCode Distribute(MPI_Comm comm, const PgPacking *packing, Search *s)
{
  const PetscReal contact = 2 * s->f->radius_max, sample = (circle + 1) * s->f->radius_max;
  const PetscReal period = packing->high - packing->low;
  PetscReal      *x, *r;
  PetscInt       *id;

  PetscFunctionBeginUser;
  /* a short period has no room for the circles of samples */
  s->stride = packing->periodic && period < 3.1 * sample ? 0 : PetscMax(1, packing->global / SAMPLES);
  s->reach  = s->stride ? sample : contact;
  PetscCall(PgParticlesCreate(comm, &s->particles));
  if (packing->periodic) PetscCall(PgParticlesSetPeriodicX(s->particles, packing->low, packing->high));
  PetscCall(PetscMalloc1(packing->count, &id));
  for (PetscInt i = 0; i < packing->count; i++) id[i] = packing->start + i;
  PetscCall(PgParticlesSetDiscs(s->particles, packing->count, id));
  PetscCall(PetscFree(id));
  PetscCall(PgParticlesGetArray(s->particles, PG_POSITION, &x));
  PetscCall(PgParticlesGetArray(s->particles, PG_RADIUS, &r));
  PetscCall(PetscArraycpy(x, packing->position, 2 * packing->count));
  PetscCall(PetscArraycpy(r, packing->radius, packing->count));
  PetscCall(PgParticlesDistribute(s->particles, s->reach));
  PetscCall(PgParticlesGetSizes(s->particles, &s->owned, &s->local, NULL));
  s->local += s->owned;
  PetscCall(PgParticlesGetArray(s->particles, PG_POSITION, &s->x));
  PetscCall(PgParticlesGetArray(s->particles, PG_RADIUS, &s->r));
  PetscCall(PgParticlesGetIds(s->particles, &s->id));
  PetscFunctionReturn(0);
}

/* ---- cells ---- */

static PetscInt CellIndex(const Search *s, PetscInt i, int d)
{
  const PetscInt cell = (PetscInt)((s->x[2 * i + d] - s->low[d]) * s->per_length);
  return PetscMax(0, PetscMin(cell, s->cells[d] - 1));
}

static PetscInt CellOf(const Search *s, PetscInt i) { return CellIndex(s, i, 1) * s->cells[0] + CellIndex(s, i, 0); }

static PetscErrorCode SortIntoCells(Search *s)
{
  PetscReal extent[2] = {0, 0}, cell = s->reach * (1 + 4 * PETSC_SQRT_MACHINE_EPSILON);
  PetscInt  cells;

  PetscFunctionBeginUser;
  for (int d = 0; d < 2; d++) {
    PetscReal high = -PETSC_MAX_REAL;
    s->low[d]      = PETSC_MAX_REAL;
    for (PetscInt i = 0; i < s->local; i++) {
      s->low[d] = PetscMin(s->low[d], s->x[2 * i + d]);
      high      = PetscMax(high, s->x[2 * i + d]);
    }
    extent[d] = s->local ? high - s->low[d] : 0;
  }
  while ((extent[0] / cell + 1) * (extent[1] / cell + 1) > 4 * (PetscReal)s->local + 64) cell *= 1.25;
  s->per_length = 1 / cell;
  for (int d = 0; d < 2; d++) s->cells[d] = (PetscInt)(extent[d] / cell) + 1;
  cells = s->cells[0] * s->cells[1];
  PetscCall(PetscCalloc1(cells + 2, &s->start));
  PetscCall(PetscMalloc1(s->local, &s->disc));
  /* counted two places ahead, as in the pair lists: placing the discs moves start[c + 1] from begin to end of c */
  for (PetscInt i = 0; i < s->local; i++) s->start[CellOf(s, i) + 2]++;
  for (PetscInt c = 0; c < cells; c++) s->start[c + 2] += s->start[c + 1];
  for (PetscInt i = 0; i < s->local; i++) s->disc[s->start[CellOf(s, i) + 1]++] = i;
  PetscFunctionReturn(0);
}

/* ---- pairs ---- */

static PetscBool IsSample(const Search *s, PetscInt a)
{
  const PetscReal R = circle * s->r[a];

  if (!s->stride || s->id[a] % s->stride) return PETSC_FALSE;
  for (int d = 0; d < 2; d++) {
    PetscBool periodic;
    (void)PgParticlesGetPeriodicX(s->particles, &periodic, NULL, NULL);
    if (d == 0 && periodic) continue;
    if (s->x[2 * a + d] - R < s->box->low[d] || s->x[2 * a + d] + R > s->box->high[d]) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Whether the pair is the worse one; of equal ones that of the smaller ids, so that every rank agrees. */
static PetscBool IsWorse(const PgPackingFindings *f, PetscReal overlap, PetscInt low, PetscInt high)
{
  if (f->pair[0] < 0 || overlap != f->overlap) return (PetscBool)(f->pair[0] < 0 || overlap > f->overlap);
  return (PetscBool)(low < f->pair[0] || (low == f->pair[0] && high < f->pair[1]));
}

/* a has the smaller id and is owned. */
static void Touch(Search *s, PetscInt a, PetscInt b, PetscReal d)
{
  PgPackingFindings *f       = s->f;
  const PetscReal    least   = PetscMin(s->r[a], s->r[b]);
  const PetscReal    overlap = (s->r[a] + s->r[b] - d) / least;

  if (IsWorse(f, overlap, s->id[a], s->id[b])) {
    f->overlap = overlap;
    f->pair[0] = s->id[a];
    f->pair[1] = s->id[b];
    for (int c = 0; c < 2; c++) {
      f->place[c]     = s->x[2 * a + c];
      f->place[2 + c] = s->x[2 * b + c];
    }
  }
  if (overlap <= -1e-9) return;
  f->touching++;
  f->coincident += d < 1e-9 * least;
  s->piled += overlap > 1;
  if (overlap > 0) PgExactSumAdd(&s->common, PgLensArea(s->r[a], s->r[b], d));
}

static void LookAround(Search *s, PetscInt a)
{
  const PetscBool sample = IsSample(s, a);
  const PetscReal R      = circle * s->r[a];
  const PetscInt  ix = CellIndex(s, a, 0), iy = CellIndex(s, a, 1);

  if (sample) {
    s->f->samples++;
    PgExactSumAdd(&s->circles, PETSC_PI * R * R);
    PgExactSumAdd(&s->sampled, PETSC_PI * s->r[a] * s->r[a]);
  }
  for (PetscInt jy = PetscMax(iy - 1, 0); jy <= PetscMin(iy + 1, s->cells[1] - 1); jy++) {
    const PetscInt first = jy * s->cells[0] + PetscMax(ix - 1, 0);
    const PetscInt last  = jy * s->cells[0] + PetscMin(ix + 1, s->cells[0] - 1);
    for (PetscInt k = s->start[first]; k < s->start[last + 1] && s->piled < PILED_UP; k++) {
      const PetscInt  b  = s->disc[k];
      const PetscReal dx = s->x[2 * b] - s->x[2 * a], dy = s->x[2 * b + 1] - s->x[2 * a + 1];
      const PetscReal d = PetscSqrtReal(dx * dx + dy * dy);
      if (b == a) continue;
      if (s->id[a] < s->id[b] && d < 1.5 * (s->r[a] + s->r[b])) Touch(s, a, b, d);
      if (sample && d < R + s->r[b]) PgExactSumAdd(&s->sampled, PgLensArea(R, s->r[b], d));
    }
  }
}

static void LookOutside(Search *s, PetscInt a)
{
  PgPackingFindings *f = s->f;
  PetscBool          periodic;

  (void)PgParticlesGetPeriodicX(s->particles, &periodic, NULL, NULL);
  for (int d = periodic; d < 2; d++) {
    const PetscReal x   = s->x[2 * a + d];
    const PetscReal out = PetscMax(s->box->low[d] - x, x - s->box->high[d]) / s->r[a] + 1;
    if (out < f->outside || (out == f->outside && f->outside_disc >= 0 && s->id[a] > f->outside_disc)) continue;
    f->outside      = out;
    f->outside_disc = s->id[a];
  }
}

/* ---- all ranks ---- */

static PetscErrorCode Agree(MPI_Comm comm, Search *s)
{
  PgPackingFindings *f        = s->f;
  PetscInt64         count[3] = {f->touching, f->coincident, f->samples};
  PgExactSum         sum[4]   = {s->area, s->common, s->sampled, s->circles};
  PetscReal          value[4];
  PetscMPIInt        holder;

  PetscFunctionBeginUser;
  PetscCall(PgFindHolder(comm, f->overlap, f->pair[0], f->pair[1], &holder));
  if (holder >= 0) {
    PetscCallMPI(MPI_Bcast(&f->overlap, 1, MPIU_REAL, holder, comm));
    PetscCallMPI(MPI_Bcast(f->pair, 2, MPIU_INT, holder, comm));
    PetscCallMPI(MPI_Bcast(f->place, 4, MPIU_REAL, holder, comm));
  }
  PetscCall(PgFindHolder(comm, f->outside, f->outside_disc, 0, &holder));
  if (holder >= 0) {
    PetscCallMPI(MPI_Bcast(&f->outside, 1, MPIU_REAL, holder, comm));
    PetscCallMPI(MPI_Bcast(&f->outside_disc, 1, MPIU_INT, holder, comm));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 3, MPIU_INT64, MPI_SUM, comm));
  PetscCall(PgExactSumReduce(comm, 4, sum, value));
  f->touching    = count[0];
  f->coincident  = count[1];
  f->samples     = count[2];
  f->area        = value[0];
  f->common_area = value[1];
  f->sampled     = f->samples ? 1 - value[2] / value[3] : 0;
  PetscFunctionReturn(0);
}

PetscErrorCode PgPackingInspect(MPI_Comm comm, const char from[], const PgPacking *packing, const PgBox *box,
                                PgPackingFindings *findings)
{
  Search *s;

  PetscFunctionBeginUser;
  *findings = (PgPackingFindings){
      .overlap = -PETSC_MAX_REAL, .pair = {-1, -1}, .outside = -PETSC_MAX_REAL, .outside_disc = -1};
  PetscCall(Radii(comm, from, packing, findings));
  PetscCall(PetscNew(&s));
  s->box = box;
  s->f   = findings;
  PetscCall(Distribute(comm, packing, s));
  PetscCall(SortIntoCells(s));
  for (PetscInt a = 0; a < s->owned; a++) {
    PgExactSumAdd(&s->area, PETSC_PI * s->r[a] * s->r[a]);
    LookOutside(s, a);
    if (s->piled < PILED_UP) LookAround(s, a);
  }
  PetscCall(Agree(comm, s));
  PetscCall(PetscFree(s->start));
  PetscCall(PetscFree(s->disc));
  PetscCall(PgParticlesDestroy(&s->particles));
  PetscCall(PetscFree(s));
  PetscFunctionReturn(0);
}
