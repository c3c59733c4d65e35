/* Porosity at the discs, Eqs. 25b, 61, 62, and its rate. */
#include "poreimpl.h"

/* The sample circle of disc a has this radius in units of r_a. */
static const PetscReal sample_radius = 4.0;

PetscReal PgLensArea(PetscReal R, PetscReal r, PetscReal d)
{
  PetscReal x, X, h;

  if (d >= R + r) return 0.0;
  if (d <= PetscAbsReal(R - r)) return PETSC_PI * PetscMin(R, r) * PetscMin(R, r);
  X = (d * d + (R - r) * (R + r)) / (2.0 * d); /* of the chord, from the centre of R */
  x = d - X;
  /* half the chord, from the sides of the triangle: no difference of squares, so that a thin lens keeps its digits */
  h = PetscSqrtReal(PetscMax(0.0, (R + r - d) * (d + r - R) * (d - r + R) * (d + r + R))) / (2.0 * d);
  return R * R * PetscAtan2Real(h, X) + r * r * PetscAtan2Real(h, x) - d * h;
}

/* Area of discs inside the sample circle of each owned disc, the disc itself first, then by id. */
static PetscErrorCode SolidArea(PgPore pore, const PgPoreArrays *s, PetscReal area[])
{
  PgRowList list;

  PetscFunctionBeginUser;
  PetscCall(PgNeighborsGetRows(pore->neighbors, &list));
  PetscCall(PgOverlapsUpdate(pore, sample_radius));
  PgOverlapLoop(&pore->overlaps, sample_radius, s->x, s->radius);
  for (PetscInt a = 0; a < s->owned; a++) {
    const PetscInt end = list.ptr[a + 1];
    PetscReal      sum = PETSC_PI * s->radius[a] * s->radius[a];
    for (PetscInt k = list.ptr[a]; k < end; k++) sum += pore->overlaps.area[k];
    area[a] = sum;
  }
  PetscFunctionReturn(0);
}

/* Kernel-weighted solid fraction. */
static PetscErrorCode SolidFraction(PgPore pore, const PgPoreArrays *s, PetscReal fraction[])
{
  PgRowList       list;
  const PgKernel *kernel;
  PetscReal       smoothing;

  PetscFunctionBeginUser;
  PetscCall(PgNeighborsGetRows(pore->neighbors, &list));
  PetscCall(PgSphGetKernel(pore->sph, &kernel, &smoothing));
  for (PetscInt a = 0; a < s->owned; a++) {
    const PetscReal self = smoothing * s->radius[a];
    PetscReal       sum  = kernel->w(0.0) / (self * self) * s->radius[a] * s->radius[a];
    for (PetscInt k = list.ptr[a]; k < list.ptr[a + 1]; k++) {
      const PetscInt  b  = list.col[k];
      const PetscReal dx = s->x[2 * b] - s->x[2 * a], dy = s->x[2 * b + 1] - s->x[2 * a + 1];
      const PetscReal h = 0.5 * smoothing * (s->radius[a] + s->radius[b]), q = PetscSqrtReal(dx * dx + dy * dy) / h;
      if (q < kernel->support) sum += kernel->w(q) / (h * h) * s->radius[b] * s->radius[b];
    }
    fraction[a] = PETSC_PI * sum;
  }
  PetscFunctionReturn(0);
}

/* n_a: mean of the samples of the discs whose centres lie in the circle of a, Eq. 62, as SolidArea() has found them. */
static PetscErrorCode MeanOfSamples(PgPore pore, const PgPoreArrays *s, const PetscReal sample[], PetscReal n[])
{
  const char *inside = pore->overlaps.inside;
  PgRowList   list;

  PetscFunctionBeginUser;
  PetscCall(PgNeighborsGetRows(pore->neighbors, &list));
  for (PetscInt a = 0; a < s->owned; a++) {
    const PetscInt end   = list.ptr[a + 1];
    PetscReal      sum   = sample[a];
    PetscInt       count = 1;
    for (PetscInt k = list.ptr[a]; k < end; k++) {
      sum += sample[list.col[k]] * inside[k]; /* by 0 or 1 */
      count += inside[k];
    }
    n[a] = sum / (PetscReal)count;
  }
  PetscFunctionReturn(0);
}

/* Keeps n inside its bounds and counts every clip. */
static void Clip(PgPore pore, PetscInt owned, PetscReal n[])
{
  for (PetscInt a = 0; a < owned; a++) {
    if (n[a] >= pore->n_min && n[a] <= pore->n_max) continue;
    n[a] = n[a] < pore->n_min ? pore->n_min : pore->n_max; /* NaN stays NaN for the guard: both comparisons fail */
    pore->clipped++;
  }
}

static PetscErrorCode FromSamples(PgPore pore, const PgPoreArrays *s)
{
  PetscReal *sample;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesHalo(pore->particles, 1, &pore->porosity_sample));
  PetscCall(PgParticlesGetArray(pore->particles, pore->porosity_sample, &sample));
  PetscCall(MeanOfSamples(pore, s, sample, s->n));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPorosityCalibrate(PgPore pore)
{
  PgPoreArrays s;
  PetscReal   *initial, *sample, *area;

  PetscFunctionBeginUser;
  PetscCall(PgPoreGetArrays(pore, &s));
  PetscCall(PgParticlesGetArray(pore->particles, pore->porosity_initial, &initial));
  PetscCall(PgParticlesGetArray(pore->particles, pore->porosity_sample, &sample));
  PetscCall(PgParticlesGetArray(pore->particles, pore->rae_area, &area));
  if (pore->porosity_kind == PG_POROSITY_KERNEL)
    PetscCall(SolidFraction(pore, &s, area));
  else
    PetscCall(SolidArea(pore, &s, area));
  /* the area of the (at edges "embowed") sample that makes the start come out as given */
  for (PetscInt a = 0; a < s.owned; a++) {
    area[a] /= 1.0 - initial[a];
    sample[a] = initial[a];
  }
  if (pore->porosity_kind == PG_POROSITY_KERNEL)
    PetscCall(PetscArraycpy(s.n, initial, s.owned));
  else
    PetscCall(FromSamples(pore, &s));
  Clip(pore, s.owned, s.n);
  PetscCall(PgParticlesHalo(pore->particles, 1, &pore->porosity));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPorosityUpdate(PgPore pore, PetscReal dt_f)
{
  PgPoreArrays s;
  PetscReal   *sample, *area, *divergence;

  PetscFunctionBeginUser;
  PetscCall(PgStagePush(PG_STAGE_POROSITY));
  PetscCall(PgPoreGetArrays(pore, &s));
  PetscCall(PgParticlesGetArray(pore->particles, pore->porosity_sample, &sample));
  PetscCall(PgParticlesGetArray(pore->particles, pore->rae_area, &area));
  PetscCall(PgParticlesGetArray(pore->particles, pore->divergence, &divergence));
  switch (pore->porosity_kind) {
  case PG_POROSITY_RAE:
    PetscCall(SolidArea(pore, &s, pore->Z));
    for (PetscInt a = 0; a < s.owned; a++) sample[a] = 1.0 - pore->Z[a] / area[a];
    PetscCall(FromSamples(pore, &s));
    break;
  case PG_POROSITY_KERNEL:
    PetscCall(SolidFraction(pore, &s, pore->Z));
    for (PetscInt a = 0; a < s.owned; a++) s.n[a] = 1.0 - pore->Z[a] / area[a];
    break;
  case PG_POROSITY_KINEMATIC: /* Dn/Dt = (1 - n) div v, with div v of the start of the step */
    for (PetscInt a = 0; a < s.owned; a++) s.n[a] = 1.0 - (1.0 - s.n[a]) * PetscExpReal(-divergence[a] * dt_f);
    break;
  }
  Clip(pore, s.owned, s.n);
  PetscCall(PgParticlesHalo(pore->particles, 1, &pore->porosity));
  PetscCall(PgStagePop());
  PetscFunctionReturn(0);
}

PetscErrorCode PgPoreVolumes(PgPore pore)
{
  PgPoreArrays s;

  PetscFunctionBeginUser;
  PetscCall(PgPoreGetArrays(pore, &s));
  for (PetscInt a = 0; a < s.local; a++) {
    /* with n near 1 the area of a blown-out disc would poison the gradients of its neighbours */
    pore->n_flow[a] = PetscMin(s.n[a], pore->detach_n);
    s.volume[a]     = PETSC_PI * s.radius[a] * s.radius[a] / (1.0 - pore->n_flow[a]);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgPorosityDerivative(PgPore pore, const PgPoreArrays *s, PetscReal dt_f, const PetscReal divergence[],
                                    PetscReal rate[])
{
  PetscReal *before;

  PetscFunctionBeginUser;
  if (pore->rate_kind == PG_RATE_SAMPLED) {
    PetscCall(PgParticlesGetArray(pore->particles, pore->porosity_before, &before));
    for (PetscInt a = 0; a < s->owned; a++) rate[a] = (s->n[a] - before[a]) / dt_f;
  } else {
    for (PetscInt a = 0; a < s->owned; a++) rate[a] = (1.0 - pore->n_flow[a]) * divergence[a];
  }
  PetscFunctionReturn(0);
}
