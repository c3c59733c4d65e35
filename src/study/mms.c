/* -study mms: the operators and the solved pressure against an exact field, on a unit square of points that is refined
   by two. p = sin(pi x) sin(pi y) + x + y/2; points within the kernel's support of an edge have the exact pressure. */
#include "studyimpl.h"
#include <math.h>

enum {
  COLUMN_PACKING,
  COLUMN_OPERATORS,
  COLUMN_N,
  COLUMN_SPACING,
  COLUMN_GRADIENT,
  COLUMN_GRADIENT_ORDER,
  COLUMN_LAPLACIAN,
  COLUMN_LAPLACIAN_ORDER,
  COLUMN_PRESSURE,
  COLUMN_PRESSURE_ORDER,
  COLUMN_ITERATIONS,
  COLUMN_FALLBACKS,
  COLUMNS
};

static const PgTableColumn columns[COLUMNS] = {
    [COLUMN_PACKING]   = {"packing", NULL, "lattice or jittered", "points", NULL, 8},
    [COLUMN_OPERATORS] = {"operators", NULL, "form of the operators", "operators", NULL, 16},
    [COLUMN_N]         = {"N", "1", "points", "N", "%.0f", 8},
    [COLUMN_SPACING]   = {"spacing", "1", "distance of neighbours; h = 1.25 of it unless -sph_smoothing says else",
                          "spacing", "%.3g", 8},
    [COLUMN_GRADIENT]  = {"gradient_error", "1", "L2 error of the gradient over its L2 norm, inside", "grad p", "%.2e",
                          9},
    [COLUMN_GRADIENT_ORDER] = {"gradient_order", "1", "observed order", "order", "%.2f", 6},
    [COLUMN_LAPLACIAN] = {"laplacian_error", "1", "L2 error of the Laplacian over its L2 norm, inside", "lap p", "%.2e",
                          9},
    [COLUMN_LAPLACIAN_ORDER] = {"laplacian_order", "1", "observed order", "order", "%.2f", 6},
    [COLUMN_PRESSURE]        = {"pressure_error", "1",
                                "L2 error of the solved pressure over the L2 norm of its part that is not linear, inside",
                                "solved p", "%.2e", 9},
    [COLUMN_PRESSURE_ORDER]  = {"pressure_order", "1", "observed order", "order", "%.2f", 6},
    [COLUMN_ITERATIONS]      = {"iterations", "1", "Krylov iterations of the solve", "its", "%.0f", 5},
    [COLUMN_FALLBACKS] = {"fallbacks", "1", "rows whose correction fell back to the plain form", "fallbacks", "%.0f",
                          9},
};

typedef struct {
  const char *name, *gradient, *laplacian, *eta;
} Variant;
static const Variant variants[] = {{"paper, eta 0.1", "paper", "paper", "0.1"},
                                   {"eta 0.01", "paper", "paper", "0.01"},
                                   {"eta 0", "paper", "paper", "0"},
                                   {"corrected", "corrected", "corrected", "0.1"}};

typedef struct {
  PetscReal gradient, laplacian, pressure; /* relative errors */
  PetscInt  n, iterations, fallbacks;
} Errors;

typedef struct {
  MPI_Comm    comm;
  PetscReal   spacing;
  PgParticles particles;
  PgNeighbors neighbors;
  PgSph       sph;
  PgPressure  pressure;
} Square;

static PetscErrorCode Options(PgStudy study, PetscOptionItems *PetscOptionsObject)
{
  PetscFunctionBeginUser;
  PetscCall(PgOptionInt(PetscOptionsObject, "-study_mms_points", "points across the coarsest square", 12, 4096,
                        &study->columns, NULL));
  PetscCall(PgOptionInt(PetscOptionsObject, "-study_mms_levels",
                        "squares, each with half the spacing of the one before", 1, 10, &study->levels, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-study_mms_jitter",
                         "largest displacement of the jittered points in each direction, in spacings", "1", 0.0, 0.4,
                         &study->mms_jitter, NULL));
  PetscFunctionReturn(0);
}

/* The part of the field that every form of the Laplacian reproduces inside. */
static PetscReal LinearPart(const PetscReal x[2]) { return x[0] + 0.5 * x[1]; }

static void Exact(const PetscReal x[2], PetscReal *p, PetscReal gradient[2], PetscReal *laplacian)
{
  const PetscReal pi = PETSC_PI, sx = PetscSinReal(pi * x[0]), sy = PetscSinReal(pi * x[1]);

  *p          = sx * sy + LinearPart(x);
  gradient[0] = pi * PetscCosReal(pi * x[0]) * sy + 1.0;
  gradient[1] = pi * sx * PetscCosReal(pi * x[1]) + 0.5;
  *laplacian  = -2.0 * pi * pi * sx * sy;
}

static PetscErrorCode Destroy(Square *s)
{
  PetscFunctionBeginUser;
  PetscCall(PgPressureDestroy(&s->pressure));
  PetscCall(PgSphDestroy(&s->sph));
  PetscCall(PgNeighborsDestroy(&s->neighbors));
  PetscCall(PgParticlesDestroy(&s->particles));
  PetscFunctionReturn(0);
}

static PetscErrorCode Create(MPI_Comm comm, const Variant *variant, Square *s)
{
  PgOverride o = {0};

  PetscFunctionBeginUser;
  s->comm = comm;
  PetscCall(PgParticlesCreate(comm, &s->particles));
  PetscCall(PgParticlesSetFromOptions(s->particles));
  PetscCall(PgNeighborsCreate(s->particles, &s->neighbors));
  PetscCall(PgNeighborsSetFromOptions(s->neighbors));
  PetscCall(PgSphCreate(s->particles, s->neighbors, &s->sph));
  if (variant) {
    PetscCall(PgOverrideSet(&o, "-sph_gradient", variant->gradient));
    PetscCall(PgOverrideSet(&o, "-sph_laplacian", variant->laplacian));
    PetscCall(PgOverrideSet(&o, "-sph_laplacian_eta", variant->eta));
  }
  PetscCall(PgSphSetFromOptions(s->sph));
  PetscCall(PgOverrideRestore(&o, NULL));
  PetscCall(PgPressureCreate(s->particles, s->neighbors, s->sph, &s->pressure));
  PetscCall(PgPressureSetReference(s->pressure, 0.0));
  PetscCall(PgPressureSetFromOptions(s->pressure));
  PetscFunctionReturn(0);
}

/* Rows of `across` points, shifted in turn by a quarter of the spacing to the right and to the left. All points stand
   for the same area, jittered or not. */
static PetscErrorCode Place(Square *s, PetscInt across, PetscReal jitter)
{
  const PetscReal d = 1.0 / (PetscReal)across, rise = 0.5 * PetscSqrtReal(3.0) * d;
  const PetscInt  rows = (PetscInt)(1.0 / rise), total = rows * across;
  PetscMPIInt     rank, size;
  PetscInt        first, owned, *id;
  PetscReal      *x, *radius, *volume;
  PgField         field;

  PetscFunctionBeginUser;
  s->spacing = d;
  PetscCallMPI(MPI_Comm_rank(s->comm, &rank));
  PetscCallMPI(MPI_Comm_size(s->comm, &size));
  first = (PetscInt)((PetscInt64)total * rank / size);
  owned = (PetscInt)((PetscInt64)total * (rank + 1) / size) - first;
  PetscCall(PetscMalloc1(owned, &id));
  for (PetscInt i = 0; i < owned; i++) id[i] = first + i;
  PetscCall(PgParticlesSetDiscs(s->particles, owned, id));
  PetscCall(PgParticlesGetArray(s->particles, PG_POSITION, &x));
  PetscCall(PgParticlesGetArray(s->particles, PG_RADIUS, &radius));
  PetscCall(PgParticlesFindField(s->particles, "volume", &field));
  PetscCall(PgParticlesGetArray(s->particles, field, &volume));
  for (PetscInt i = 0; i < owned; i++) {
    const PetscInt row = id[i] / across, column = id[i] % across;
    x[2 * i]     = d * ((PetscReal)column + (row % 2 ? 0.75 : 0.25) + jitter * PgNoise(id[i], 0));
    x[2 * i + 1] = rise * ((PetscReal)row + 0.5) + d * jitter * PgNoise(id[i], 1);
    radius[i]    = 0.5 * d;
    volume[i]    = d * rise;
  }
  PetscCall(PetscFree(id));
  PetscCall(PgNeighborsBuild(s->neighbors));
  PetscCall(PgSphUpdate(s->sph));
  PetscFunctionReturn(0);
}

/* Points whose support may reach over an edge have the exact pressure; the others start from zero. Fills the exact
   Laplacian of the owned points. */
static PetscErrorCode Prescribe(Square *s, PetscReal Z[])
{
  const PgKernel *kernel;
  PetscReal       smoothing, band, *x, *p, *fixed, *prescribed;
  PetscInt        owned;
  PgField         field;

  PetscFunctionBeginUser;
  PetscCall(PgSphGetKernel(s->sph, &kernel, &smoothing));
  band = kernel->support * smoothing * 0.5 * s->spacing;
  PetscCall(PgParticlesGetSizes(s->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(s->particles, PG_POSITION, &x));
  PetscCall(PgParticlesFindField(s->particles, "pressure", &field));
  PetscCall(PgParticlesGetArray(s->particles, field, &p));
  PetscCall(PgParticlesFindField(s->particles, "pressure_fixed", &field));
  PetscCall(PgParticlesGetArray(s->particles, field, &fixed));
  PetscCall(PgParticlesFindField(s->particles, "pressure_prescribed", &field));
  PetscCall(PgParticlesGetArray(s->particles, field, &prescribed));
  for (PetscInt a = 0; a < owned; a++) {
    const PetscReal *at   = x + 2 * a;
    const PetscReal  edge = PetscMin(PetscMin(at[0], 1.0 - at[0]), PetscMin(at[1], 1.0 - at[1]));
    PetscReal        gradient[2];
    fixed[a] = edge < band ? 1.0 : 0.0;
    Exact(at, &prescribed[a], gradient, &Z[a]);
    p[a] = 0.0;
  }
  PetscFunctionReturn(0);
}

/* The operators on the exact field, ghosts included: the field pressure holds it. */
static PetscErrorCode Apply(Square *s, PetscReal gradient[], PetscReal laplacian[])
{
  PetscReal *x, *p;
  PetscInt   owned, ghosts;
  PgField    field;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(s->particles, &owned, &ghosts, NULL));
  PetscCall(PgParticlesGetArray(s->particles, PG_POSITION, &x));
  PetscCall(PgParticlesFindField(s->particles, "pressure", &field));
  PetscCall(PgParticlesGetArray(s->particles, field, &p));
  for (PetscInt a = 0; a < owned + ghosts; a++) {
    PetscReal g[2], l;
    Exact(x + 2 * a, &p[a], g, &l);
  }
  PetscCall(PgSphGradient(s->sph, p, gradient));
  PetscCall(PgSphLaplacian(s->sph, p, laplacian));
  PetscFunctionReturn(0);
}

static PetscErrorCode Compare(Square *s, const PetscReal gradient[], const PetscReal laplacian[],
                              const PetscReal solved[], Errors *e)
{
  PetscReal *x, *fixed, sum[6] = {0.0};
  PetscInt   owned;
  PgField    field;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(s->particles, &owned, NULL, &e->n));
  PetscCall(PgParticlesGetArray(s->particles, PG_POSITION, &x));
  PetscCall(PgParticlesFindField(s->particles, "pressure_fixed", &field));
  PetscCall(PgParticlesGetArray(s->particles, field, &fixed));
  for (PetscInt a = 0; a < owned; a++) {
    PetscReal p, g[2], l;
    if (fixed[a] != 0.0) continue;
    Exact(x + 2 * a, &p, g, &l);
    sum[0] += PetscSqr(gradient[2 * a] - g[0]) + PetscSqr(gradient[2 * a + 1] - g[1]);
    sum[1] += PetscSqr(g[0]) + PetscSqr(g[1]);
    sum[2] += PetscSqr(laplacian[a] - l);
    sum[3] += PetscSqr(l);
    sum[4] += PetscSqr(solved[a] - p);
    sum[5] += PetscSqr(p - LinearPart(x + 2 * a));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 6, MPIU_REAL, MPIU_SUM, s->comm));
  e->gradient  = PetscSqrtReal(sum[0] / sum[1]);
  e->laplacian = PetscSqrtReal(sum[2] / sum[3]);
  e->pressure  = PetscSqrtReal(sum[4] / sum[5]);
  PetscFunctionReturn(0);
}

static PetscErrorCode Measure(Square *s, Errors *e)
{
  PetscReal      *Z, *gradient, *laplacian, *solved, *p;
  PetscInt        owned, one, two;
  PgField         field;
  PgPressureStats stats;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(s->particles, &owned, NULL, NULL));
  PetscCall(PetscMalloc4(owned, &Z, 2 * owned, &gradient, owned, &laplacian, owned, &solved));
  PetscCall(Prescribe(s, Z));
  PetscCall(PgPressureUpdate(s->pressure, NULL));
  PetscCall(PgPressureSolve(s->pressure, Z, &stats));
  PetscCall(PgParticlesFindField(s->particles, "pressure", &field));
  PetscCall(PgParticlesGetArray(s->particles, field, &p));
  PetscCall(PetscArraycpy(solved, p, owned));
  PetscCall(Apply(s, gradient, laplacian));
  PetscCall(Compare(s, gradient, laplacian, solved, e));
  PetscCall(PgSphGetFallbacks(s->sph, &one, &two));
  e->iterations = stats.iterations;
  e->fallbacks  = one + two;
  PetscCall(PetscFree4(Z, gradient, laplacian, solved));
  PetscFunctionReturn(0);
}

/* log2 of the ratio: spacings are halved. */
static PetscReal Order(PetscReal before, PetscReal now)
{
  return before > 0.0 && now > 0.0 ? PetscLogReal(before / now) / PetscLogReal(2.0) : PG_TABLE_EMPTY;
}

static PetscErrorCode FillRow(PgTable table, PetscBool jittered, const char name[], PetscReal spacing, const Errors *e,
                              const Errors *before)
{
  PetscFunctionBeginUser;
  PgTableText(table, COLUMN_PACKING, "%s", jittered ? "jittered" : "lattice");
  PgTableText(table, COLUMN_OPERATORS, "%s", name);
  PgTableReal(table, COLUMN_N, (PetscReal)e->n);
  PgTableReal(table, COLUMN_SPACING, spacing);
  PgTableReal(table, COLUMN_GRADIENT, e->gradient);
  PgTableReal(table, COLUMN_LAPLACIAN, e->laplacian);
  PgTableReal(table, COLUMN_PRESSURE, e->pressure);
  PgTableReal(table, COLUMN_GRADIENT_ORDER, Order(before->gradient, e->gradient));
  PgTableReal(table, COLUMN_LAPLACIAN_ORDER, Order(before->laplacian, e->laplacian));
  PgTableReal(table, COLUMN_PRESSURE_ORDER, Order(before->pressure, e->pressure));
  PgTableReal(table, COLUMN_ITERATIONS, (PetscReal)e->iterations);
  PgTableReal(table, COLUMN_FALLBACKS, (PetscReal)e->fallbacks);
  PetscCall(PgTableEndRow(table, 0, NULL, NULL, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode RunVariant(PgStudy study, const Variant *variant, PetscBool jittered, PgTable *table)
{
  Errors before = {0};

  PetscFunctionBeginUser;
  for (PetscInt level = 0; level < study->levels; level++) {
    Square s = {0};
    Errors e = {0};
    PetscCall(Create(study->comm, variant, &s));
    if (!*table) { /* all options have been read now, and nothing is written yet */
      PetscCall(PgOptionsCheckUnused(study->comm, PgPressureProbeOptions, s.pressure));
      PetscCall(PgTableCreate(&study->files, "study", COLUMNS, columns, table));
    }
    PetscCall(Place(&s, study->columns << level, jittered ? study->mms_jitter : 0.0));
    PetscCall(Measure(&s, &e));
    PetscCall(FillRow(*table, jittered, variant ? variant->name : "as given", s.spacing, &e, &before));
    PetscCall(Destroy(&s));
    before = e;
  }
  PetscFunctionReturn(0);
}

/* Operators given by options are studied alone, all variants otherwise. */
static PetscErrorCode GivenByOptions(PetscBool *given)
{
  static const char *const names[] = {"-sph_operators", "-sph_gradient", "-sph_laplacian", "-sph_laplacian_eta"};

  PetscFunctionBeginUser;
  *given = PETSC_FALSE;
  for (size_t i = 0; i < sizeof names / sizeof *names && !*given; i++)
    PetscCall(PetscOptionsHasName(NULL, NULL, names[i], given));
  PetscFunctionReturn(0);
}

static PetscErrorCode RunStudy(PgStudy study)
{
  PgTable   table = NULL;
  PetscBool given;

  PetscFunctionBeginUser;
  PetscCall(GivenByOptions(&given));
  for (int jittered = 0; jittered < (study->mms_jitter > 0.0 ? 2 : 1); jittered++)
    for (size_t v = 0; v < (given ? 1 : sizeof variants / sizeof *variants); v++)
      PetscCall(RunVariant(study, given ? NULL : &variants[v], (PetscBool)jittered, &table));
  PetscCall(PgTableDestroy(&table));
  PetscFunctionReturn(0);
}

const PgStudyKind PgStudyMms = {"mms", "operators and solved pressure against an exact field", Options, RunStudy};
