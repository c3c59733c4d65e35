/* What the cases of manufactured solutions share. */
#include "mms.h"
#include <math.h>

/* ---- one packing ---- */

PetscReal PgMmsLatticeFactor(const PgKernel *kernel, PetscReal smoothing, PetscReal eta)
{
  const PetscReal h = 0.5 * smoothing, cell = 0.5 * PetscSqrtReal(3.0); /* in spacings */
  const PetscInt  most = 2 + (PetscInt)(2.0 * kernel->support * h);
  PetscReal       sum  = 0.0;

  for (PetscInt j = -most; j <= most; j++) {
    for (PetscInt i = -most; i <= most; i++) {
      const PetscReal r2 = (PetscReal)(i * i + i * j + j * j), r = PetscSqrtReal(r2);
      if (r2 > 0.0 && r < kernel->support * h)
        sum -= 0.5 * cell * r * kernel->dw(r / h) / (h * h * h) * r2 / (r2 + eta * h * h);
    }
  }
  return sum;
}

static void Row(const PgMmsSet *s, PetscInt id, PetscInt *row, PetscInt *column, PetscInt *length)
{
  const PetscInt points = s->packing.points, rest = id % (2 * points - 1), odd = rest >= points - 1;

  *row    = 2 * (id / (2 * points - 1)) + odd;
  *column = odd ? rest - (points - 1) : rest;
  *length = odd ? points : points - 1;
}

PetscBool PgMmsIsFull(const PgMmsSet *s, PetscInt id)
{
  const PetscReal wide = 2.0 * (PetscReal)s->packing.points, high = PetscSqrtReal(3.0) * (PetscReal)(s->rows - 1);
  PetscInt        row, column, length;
  PetscReal       x, y;

  Row(s, id, &row, &column, &length);
  /* in radii; a frame of outermost places that all rows share begins at 2 */
  x = 2.0 * (PetscReal)column + (row % 2 ? 1.0 : 2.0);
  y = PetscSqrtReal(3.0) * (PetscReal)row;
  return (PetscBool)(PetscMin(PetscMin(x - 2.0, wide - 2.0 - x), PetscMin(y, high - y)) >=
                     s->reach + 4.0 * s->packing.jitter);
}

static PetscErrorCode CreateObjects(PgMmsSet *s, PetscBool pressure)
{
  PetscFunctionBeginUser;
  PetscCall(PgParticlesCreate(s->comm, &s->particles));
  PetscCall(PgParticlesSetFromOptions(s->particles));
  PetscCall(PgNeighborsCreate(s->particles, &s->neighbors));
  PetscCall(PgNeighborsSetFromOptions(s->neighbors));
  PetscCall(PgSphCreate(s->particles, s->neighbors, &s->sph));
  PetscCall(PgSphSetFromOptions(s->sph));
  if (!pressure) PetscFunctionReturn(0);
  PetscCall(PgPressureCreate(s->particles, s->neighbors, s->sph, &s->pressure));
  if (s->packing.points) PetscCall(PgPressureSetReference(s->pressure, 0.0)); /* help shows the default of all runs */
  PetscCall(PgPressureSetFromOptions(s->pressure));
  PetscFunctionReturn(0);
}

static PetscErrorCode Place(PgMmsSet *s)
{
  const PetscInt  points = s->packing.points, salt = 2 * s->packing.seed;
  const PetscInt  total = s->rows / 2 * (2 * points - 1) + (s->rows % 2 ? points - 1 : 0);
  const PetscReal r = s->radius, jitter = 2.0 * s->packing.jitter;
  PgCaseSetup     setup = {.comm = s->comm, .particles = s->particles};
  PetscReal      *x, *radius, *volume;
  PetscInt        first, owned;
  PgField         field;

  PetscFunctionBeginUser;
  PetscCall(PgCaseDealDiscs(&setup, total, &first, &owned));
  PetscCall(PgParticlesGetArray(s->particles, PG_POSITION, &x));
  PetscCall(PgParticlesGetArray(s->particles, PG_RADIUS, &radius));
  PetscCall(PgParticlesFindField(s->particles, "volume", &field));
  PetscCall(PgParticlesGetArray(s->particles, field, &volume));
  for (PetscInt a = 0; a < owned; a++) {
    const PetscInt id = first + a;
    PetscInt       row, column, length;

    Row(s, id, &row, &column, &length);
    x[2 * a]     = r * (2.0 * (PetscReal)column + (row % 2 ? 1.0 : 2.0) + jitter * PgNoise(id, salt));
    x[2 * a + 1] = r * (1.0 + PetscSqrtReal(3.0) * (PetscReal)row + jitter * PgNoise(id, salt + 1));
    radius[a]    = r;
    volume[a]    = 2.0 * PetscSqrtReal(3.0) * r * r;
  }
  PetscCall(PgNeighborsBuild(s->neighbors));
  PetscCall(PgSphUpdate(s->sph));
  PetscFunctionReturn(0);
}

PetscErrorCode PgMmsSetCreate(MPI_Comm comm, const PgMmsPacking *packing, PetscBool pressure, PetscBool frame,
                              PgMmsSet *s)
{
  const PetscReal points = (PetscReal)packing->points;
  const PgKernel *kernel;
  PgSphOperators  gradient, laplacian;
  PetscReal       smoothing, eta;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(s, sizeof *s));
  s->comm    = comm;
  s->packing = *packing;
  PetscCall(CreateObjects(s, pressure));
  PetscCall(PgSphGetKernel(s->sph, &kernel, &smoothing));
  PetscCall(PgSphGetForms(s->sph, &gradient, &laplacian, &eta));
  s->reach = kernel->support * smoothing;
  /* three quarters of the width inside, when the kernel is that of the paper */
  PgInputCheck(points >= 4.0 * (s->reach + 1.0), comm,
               "%" PetscInt_FMT " discs across the packing are too few for a kernel that reaches over %g radii: %g are "
               "needed",
               packing->points, (double)s->reach, (double)(4.0 * (s->reach + 1.0)));
  s->radius = 0.5 / (frame ? points - s->reach - 1.0 : points);
  s->width  = 2.0 * s->radius * points;
  s->rows   = (PetscInt)(s->width / (PetscSqrtReal(3.0) * s->radius));
  if (s->rows % 2 == 0) s->rows--;
  s->h           = smoothing * s->radius;
  s->k_gradient  = gradient == PG_SPH_PAPER ? PgMmsLatticeFactor(kernel, smoothing, 0.0) : 1.0;
  s->k_laplacian = laplacian == PG_SPH_PAPER ? PgMmsLatticeFactor(kernel, smoothing, eta) : 1.0;
  PetscCall(Place(s));
  PetscFunctionReturn(0);
}

PetscErrorCode PgMmsSetDestroy(PgMmsSet *s)
{
  PetscFunctionBeginUser;
  PetscCall(PgPressureDestroy(&s->pressure));
  PetscCall(PgSphDestroy(&s->sph));
  PetscCall(PgNeighborsDestroy(&s->neighbors));
  PetscCall(PgParticlesDestroy(&s->particles));
  PetscFunctionReturn(0);
}

/* ---- the exact field of both cases ---- */

PetscReal PgMmsHill(const PgMmsBox *b, const PetscReal x[2])
{
  return PetscSinReal(PETSC_PI * (x[0] - b->low[0]) / b->length[0]) *
         PetscSinReal(PETSC_PI * (x[1] - b->low[1]) / b->length[1]);
}

PetscReal PgMmsHillOnSlope(const PgMmsBox *b, const PetscReal x[2])
{
  return PgMmsHill(b, x) + 0.7 * x[0] - 0.4 * x[1] + 0.2;
}

void PgMmsHillGradient(const PgMmsBox *b, const PetscReal x[2], PetscReal grad[2])
{
  const PetscReal kx = PETSC_PI / b->length[0], ky = PETSC_PI / b->length[1];
  const PetscReal X = kx * (x[0] - b->low[0]), Y = ky * (x[1] - b->low[1]);

  grad[0] = kx * PetscCosReal(X) * PetscSinReal(Y) + 0.7;
  grad[1] = ky * PetscSinReal(X) * PetscCosReal(Y) - 0.4;
}

PetscReal PgMmsHillLaplacian(const PgMmsBox *b, const PetscReal x[2])
{
  const PetscReal kx = PETSC_PI / b->length[0], ky = PETSC_PI / b->length[1];

  return -(kx * kx + ky * ky) * PgMmsHill(b, x);
}

/* ---- the study ---- */

/* Reads the options of all that will be made once more: so that help and messages know them. */
static PetscErrorCode Mention(MPI_Comm comm, PetscBool pressure)
{
  PgMmsSet s = {.comm = comm};

  PetscFunctionBeginUser;
  PetscCall(CreateObjects(&s, pressure));
  PetscCall(PgMmsSetDestroy(&s));
  PetscFunctionReturn(0);
}

PetscErrorCode PgMmsPlanCreate(MPI_Comm comm, PetscBool pressure, void **context)
{
  static const char *const words[] = {"dirichlet", "natural"};
  PgMmsPlan               *plan;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&plan));
  *context      = plan;
  plan->packing = (PgMmsPacking){.points = 25};
  plan->levels  = 4;
  PetscOptionsBegin(comm, "", "case *_mms: operators and pressure against exact fields", "");
  PetscCall(PgOptionInt(PetscOptionsObject, "-mms_points", "discs in a longer row of the coarsest packing", 12, 4096,
                        &plan->packing.points, NULL));
  PetscCall(PgOptionInt(PetscOptionsObject, "-mms_levels",
                        "packings, each with half the spacing of the one before; an order needs three", 3,
                        PG_MMS_LEVELS, &plan->levels, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-mms_jitter",
                         "largest displacement of a disc in each direction, in spacings: 0 is the lattice, disorder "
                         "begins at 0.02 (with less its orders show on finer packings only)",
                         "1", 0.0, 0.3, &plan->packing.jitter, NULL));
  PetscCall(PgOptionInt(PetscOptionsObject, "-mms_seed", "which displacements of that size", 0, 1000000,
                        &plan->packing.seed, NULL));
  if (pressure)
    PetscCall(PgOptionChoice(PetscOptionsObject, "-mms_sides",
                             "pressure prescribed on discs whose kernel is cut, or sides without any condition", 2,
                             words, &plan->sides, NULL));
  PetscOptionsEnd();
  PetscCall(Mention(comm, pressure));
  PgInputCheck(plan->packing.jitter == 0.0 || plan->packing.jitter >= 0.02, comm,
               "option -mms_jitter: %g is out of range, it must be 0 or between 0.02 and 0.3",
               (double)plan->packing.jitter);
  PgInputCheck((plan->packing.points << (plan->levels - 1)) <= 8192, comm,
               "options -mms_points %" PetscInt_FMT " and -mms_levels %" PetscInt_FMT
               " make a finest packing of %" PetscInt_FMT " discs across, 8192 are allowed",
               plan->packing.points, plan->levels, plan->packing.points << (plan->levels - 1));
  PetscFunctionReturn(0);
}

PgMmsPacking PgMmsLevel(const PgMmsPlan *plan, PetscInt level)
{
  PgMmsPacking packing = plan->packing;

  packing.points <<= level;
  return packing;
}

void PgMmsAdd(PgMmsSequence *s, PetscReal h, PetscReal error)
{
  s->h[s->count]       = h;
  s->error[s->count++] = error;
}

PetscReal PgMmsOrder(const PgMmsSequence *s)
{
  const PetscInt k = s->count - 1;

  if (k < 1) return (PetscReal)NAN;
  return PetscLogReal(s->error[k - 1] / s->error[k]) / PetscLogReal(s->h[k - 1] / s->h[k]);
}

PetscErrorCode PgMmsJudge(MPI_Comm comm, const char name[], PetscInt count, const PgMmsSequence s[])
{
  const PgMmsSequence *missed = NULL;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < count; i++) {
    const PetscReal order = PgMmsOrder(&s[i]);
    const PetscBool holds = (PetscBool)(order >= s[i].expected - s[i].below && order <= s[i].expected + s[i].above);

    if (!holds) missed = &s[i];
    PetscCall(PetscPrintf(comm, "%s: order %.2f, expected %.0f%s: %s\n", s[i].what, (double)order,
                          (double)s[i].expected, s[i].above >= PETSC_MAX_REAL ? " or more" : "",
                          holds ? "holds" : "missed"));
  }
  if (missed)
    PgRunError(comm, "case %s: %s: order %.2f between the last two packings, expected is %g, and at least %.2f%s", name,
               missed->what, (double)PgMmsOrder(missed), (double)missed->expected,
               (double)(missed->expected - missed->below),
               missed->above >= PETSC_MAX_REAL ? "" : " and as much above at most");
  PetscFunctionReturn(0);
}
