/* Solution error of the pressure equation.

   Physics   lap p = Z, as assembled and solved for the pore pressure (Eqs. 52-55, 58), with Z = lap of the exact p, on a
             hexagonal packing that is refined by two, on the lattice or displaced at random by up to -mms_jitter
             spacings. h = 1.25 spacings unless -sph_smoothing says else.
   Exact     -mms_sides dirichlet: p = q + 0.7 x - 0.4 y + 0.2, q = sin(pi X) sin(pi Y), with X and Y from 0 to 1 across
             the discs that are free; prescribed on all discs whose kernel is not full.
             -mms_sides natural: p = q = cos(pi X) + cos(2 pi Y)/2 + cos(pi X) cos(pi Y)/3 in the packing's own box,
             which has no normal derivative there; nothing prescribed, the mean kept, the right-hand side made compatible.
   Error     L2 norms over the free discs, relative to that of q (natural: of q less its mean). `size` is how large q
             comes out, by least squares, `shape` the error against size times q.
   Order     with h over spacing fixed, k being the factor of the Laplacian on quadratic fields (0.9238, 1.0114, 1.0224
             for eta = 0.1, 0.01, 0 on the lattice at h = 1.25):
               dirichlet, lattice, paper       none: p/k is found, so the error tends to |1/k - 1| = 0.0825, 0.0113,
                                               0.0219. Its shape: 1, since values of q are prescribed
                                               where q/k would fit, and they are of the size h at the edge
               dirichlet, disorder, paper      none. The truncation error grows like 1/h (operator_mms), but it is a
                                               divergence: the weights are symmetric, and what one disc gains another
                                               loses. What stays is an effective k that differs from 1. Its shape: 1
               dirichlet, lattice, corrected   2
               dirichlet, disorder, corrected  2: the truncation error is of the order h, but in its leading part random
                                               without mean, and the solution averages it over the discs in a
                                               neighbourhood: random part h * h, mean part h^2
               natural, paper                  shape 1: discs of the side have lost up to half of their pairs, so a layer
                                               of width h conducts badly along the side. `corrected` has no symmetric
                                               matrix, and a singular system without one is refused
   Judged    on the last two packings; what the next term of the expansion may do there is allowed for.
   Test: tests/verify/pressure_mms.c */
#include "mms.h"
#include <math.h>

enum {
  COLUMN_N,
  COLUMN_SPACING,
  COLUMN_H,
  COLUMN_PRESSURE,
  COLUMN_PRESSURE_ORDER,
  COLUMN_SIZE,
  COLUMN_SHAPE,
  COLUMN_SHAPE_ORDER,
  COLUMN_REMOVED,
  COLUMN_ITERATIONS,
  COLUMNS
};

static const PgTableColumn columns[COLUMNS] = {
    [COLUMN_N]        = {"N", "1", "discs", "N", "%.0f", 8},
    [COLUMN_SPACING]  = {"spacing", "1", "distance of neighbours over the width of the packing", NULL, NULL, 0},
    [COLUMN_H]        = {"h", "1", "smoothing length", "h", "%.3e", 9},
    [COLUMN_PRESSURE] = {"pressure_error", "1", "L2 error of the solved pressure over the L2 norm of q", "solved p",
                         "%.2e", 9},
    [COLUMN_PRESSURE_ORDER] = {"pressure_order", "1", "its observed order", "order", "%.2f", 6},
    [COLUMN_SIZE] = {"size", "1", "how large q comes out in the solved pressure, by least squares", "size of q", "%.5f",
                     9},
    [COLUMN_SHAPE]       = {"shape_error", "1", "the same error against size times q", "shape", "%.2e", 9},
    [COLUMN_SHAPE_ORDER] = {"shape_order", "1", "its observed order", "order", "%.2f", 6},
    [COLUMN_REMOVED]     = {"removed", "1", "part of the right-hand side without a solution, over its norm", "removed",
                            "%.1e", 8},
    [COLUMN_ITERATIONS]  = {"iterations", "1", "Krylov iterations of the solve", "its", "%.0f", 5},
};

enum { ERROR, SHAPE, SEQUENCES };

/* Where q vanishes: from the frame of outermost places that all rows share inwards by the reach less a radius, between
   the last discs that are prescribed and the first that are free. */
static PgMmsBox DirichletBox(const PgMmsSet *s)
{
  const PetscReal r = s->radius, margin = (s->reach - 1.0) * r;

  return (PgMmsBox){{2.0 * r + margin, r + margin},
                    {1.0, PetscSqrtReal(3.0) * r * (PetscReal)(s->rows - 1) - 2.0 * margin}};
}

/* Rows end in turn at their cells' sides and half a cell short of them: half of that in the mean. */
static PgMmsBox NaturalBox(const PgMmsSet *s)
{
  const PetscReal r = s->radius, row = PetscSqrtReal(3.0) * r;

  return (PgMmsBox){{0.5 * r, r - 0.5 * row}, {s->width - r, row * (PetscReal)s->rows}};
}

static PetscReal Cosines(const PgMmsBox *box, const PetscReal x[2], PetscReal *laplacian)
{
  const PetscReal kx = PETSC_PI / box->length[0], ky = PETSC_PI / box->length[1];
  const PetscReal X = kx * (x[0] - box->low[0]), Y = ky * (x[1] - box->low[1]);
  const PetscReal a = PetscCosReal(X), b = 0.5 * PetscCosReal(2.0 * Y), c = PetscCosReal(X) * PetscCosReal(Y) / 3.0;

  *laplacian = -kx * kx * a - 4.0 * ky * ky * b - (kx * kx + ky * ky) * c;
  return a + b + c;
}

/* Prescribes what is prescribed, and fills the right-hand side, q and the part of p that is not q; the guess is 0, or
   what has the mean that natural sides are to keep. */
static PetscErrorCode Prescribe(PgMmsSet *s, PgMmsSides sides, PetscReal Z[], PetscReal q[], PetscReal linear[])
{
  const PgMmsBox  box = sides == PG_MMS_NATURAL ? NaturalBox(s) : DirichletBox(s);
  PetscReal      *x, *p, *fixed, *prescribed;
  const PetscInt *id;
  PetscInt        owned;
  PgField         field;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(s->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetIds(s->particles, &id));
  PetscCall(PgParticlesGetArray(s->particles, PG_POSITION, &x));
  PetscCall(PgParticlesFindField(s->particles, "pressure", &field));
  PetscCall(PgParticlesGetArray(s->particles, field, &p));
  PetscCall(PgParticlesFindField(s->particles, "pressure_fixed", &field));
  PetscCall(PgParticlesGetArray(s->particles, field, &fixed));
  PetscCall(PgParticlesFindField(s->particles, "pressure_prescribed", &field));
  PetscCall(PgParticlesGetArray(s->particles, field, &prescribed));
  for (PetscInt a = 0; a < owned; a++) {
    if (sides == PG_MMS_NATURAL) {
      q[a]      = Cosines(&box, x + 2 * a, &Z[a]);
      linear[a] = 0.0;
      p[a]      = 3.0 + 0.01 * PgNoise(id[a], 2 * s->packing.seed + 2);
      fixed[a] = prescribed[a] = 0.0;
    } else {
      q[a]          = PgMmsHill(&box, x + 2 * a);
      Z[a]          = PgMmsHillLaplacian(&box, x + 2 * a);
      prescribed[a] = PgMmsHillOnSlope(&box, x + 2 * a);
      linear[a]     = prescribed[a] - q[a];
      fixed[a]      = PgMmsIsFull(s, id[a]) ? 0.0 : 1.0;
      p[a]          = 0.0;
    }
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Mean(PgMmsSet *s, PetscInt n, const PetscReal value[], PetscReal *mean)
{
  PetscInt owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(s->particles, &owned, NULL, NULL));
  *mean = 0.0;
  for (PetscInt a = 0; a < owned; a++) *mean += value[a] / (PetscReal)n;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, mean, 1, MPIU_REAL, MPIU_SUM, s->comm));
  PetscFunctionReturn(0);
}

/* How what was found, less `away`, compares with q over the discs that are free. */
static PetscErrorCode Compare(PgMmsSet *s, const PetscReal q[], const PetscReal away[], PetscReal mean_q,
                              PetscReal mean_p, PgMmsPressureErrors *e)
{
  PetscReal *p, *fixed, sum[3] = {0.0};
  PetscInt   owned;
  PgField    field;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(s->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesFindField(s->particles, "pressure", &field));
  PetscCall(PgParticlesGetArray(s->particles, field, &p));
  PetscCall(PgParticlesFindField(s->particles, "pressure_fixed", &field));
  PetscCall(PgParticlesGetArray(s->particles, field, &fixed));
  for (PetscInt a = 0; a < owned; a++) {
    const PetscReal exact = q[a] - mean_q, error = p[a] - away[a] - mean_p - exact;
    if (fixed[a] != 0.0) continue;
    sum[0] += error * error;
    sum[1] += exact * exact;
    sum[2] += error * exact;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPIU_SUM, s->comm));
  e->error = PetscSqrtReal(sum[0] / sum[1]);
  e->size  = 1.0 + sum[2] / sum[1];
  e->shape = PetscSqrtReal(PetscMax(0.0, sum[0] / sum[1] - PetscSqr(sum[2] / sum[1])));
  PetscFunctionReturn(0);
}

static PetscErrorCode Measure(PgMmsSet *s, PgMmsSides sides, PgMmsPressureErrors *e)
{
  PetscReal      *Z, *q, *away, *p, mean_q = 0.0, before = 0.0, after = 0.0;
  PetscInt        owned;
  PgField         field;
  PgPressureStats stats;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(s->particles, &owned, NULL, &e->n));
  PetscCall(PetscMalloc3(owned, &Z, owned, &q, owned, &away));
  PetscCall(PgParticlesFindField(s->particles, "pressure", &field));
  PetscCall(Prescribe(s, sides, Z, q, away));
  PetscCall(PgParticlesGetArray(s->particles, field, &p));
  if (sides == PG_MMS_NATURAL) {
    PetscCall(Mean(s, e->n, q, &mean_q));
    PetscCall(Mean(s, e->n, p, &before));
  }
  PetscCall(PgPressureUpdate(s->pressure, NULL));
  PetscCall(PgPressureSolve(s->pressure, Z, &stats));
  PetscCall(PgParticlesGetArray(s->particles, field, &p));
  if (sides == PG_MMS_NATURAL) PetscCall(Mean(s, e->n, p, &after));
  PetscCall(Compare(s, q, away, mean_q, before, e));
  PetscCall(PetscFree3(Z, q, away));
  e->h          = s->h;
  e->k          = s->k_laplacian;
  e->drift      = after - before;
  e->removed    = stats.removed;
  e->iterations = stats.iterations;
  e->residual   = stats.residual;
  PetscFunctionReturn(0);
}

PetscErrorCode PgMmsPressure(MPI_Comm comm, const PgMmsPacking *packing, PgMmsSides sides, PetscBool check,
                             PgMmsPressureErrors *errors)
{
  PgMmsSet s;

  PetscFunctionBeginUser;
  PetscCall(PgMmsSetCreate(comm, packing, PETSC_TRUE, (PetscBool)(sides == PG_MMS_DIRICHLET), &s));
  /* before the check: what is inside of solvers is read when they are set up */
  PetscCall(Measure(&s, sides, errors));
  if (check) PetscCall(PgOptionsCheckUnused(comm, PgPressureProbeOptions, s.pressure));
  PetscCall(PgMmsSetDestroy(&s));
  PetscFunctionReturn(0);
}

static PetscErrorCode Create(MPI_Comm comm, void **context)
{
  PetscFunctionBeginUser;
  /* the error of the solver must not show beside that of the operator */
  PetscCall(PgCaseDefaults("-pressure_ksp_rtol 1e-10"));
  PetscCall(PgMmsPlanCreate(comm, PETSC_TRUE, context));
  PetscFunctionReturn(0);
}

static PetscErrorCode FillRow(PgTable table, const PgMmsPacking *packing, const PgMmsPlan *plan,
                              const PgMmsPressureErrors *e, const PgMmsSequence s[])
{
  PetscFunctionBeginUser;
  PgTableReal(table, COLUMN_N, (PetscReal)e->n);
  PgTableReal(table, COLUMN_SPACING, 1.0 / (PetscReal)packing->points);
  PgTableReal(table, COLUMN_H, e->h);
  PgTableReal(table, COLUMN_PRESSURE, e->error);
  PgTableReal(table, COLUMN_PRESSURE_ORDER, PgMmsOrder(&s[ERROR]));
  PgTableReal(table, COLUMN_SIZE, e->size);
  PgTableReal(table, COLUMN_SHAPE, e->shape);
  PgTableReal(table, COLUMN_SHAPE_ORDER, PgMmsOrder(&s[SHAPE]));
  if (plan->sides == PG_MMS_NATURAL) PgTableReal(table, COLUMN_REMOVED, e->removed);
  PgTableReal(table, COLUMN_ITERATIONS, (PetscReal)e->iterations);
  PetscCall(PgTableEndRow(table, 0, NULL, NULL, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode Judge(MPI_Comm comm, const PgMmsPressureErrors *e, const PgMmsSequence s[])
{
  PgMmsSequence judged = e->k == 1.0 ? s[ERROR] : s[SHAPE];

  PetscFunctionBeginUser;
  if (e->k != 1.0)
    PetscCall(
        PetscPrintf(comm,
                    "k of the Laplacian on the lattice %.4f: q comes out 1/k = %.4f times as large there, and the "
                    "error tends to %.4f\n",
                    (double)e->k, 1.0 / (double)e->k, (double)PetscAbsReal(1.0 / e->k - 1.0)));
  judged.what     = e->k == 1.0 ? "solved pressure" : "shape of the solved pressure";
  judged.expected = e->k == 1.0 ? 2.0 : 1.0;
  judged.below    = 0.2; /* the next term of the expansion at these h */
  judged.above    = PETSC_MAX_REAL;
  PetscCall(PgMmsJudge(comm, "pressure_mms", 1, &judged));
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(MPI_Comm comm, void *context, const char output[])
{
  const PgMmsPlan    *plan         = (const PgMmsPlan *)context;
  const PgMmsSides    sides        = (PgMmsSides)plan->sides;
  PgMmsSequence       s[SEQUENCES] = {{.what = NULL}};
  PgMmsPressureErrors e            = {0};
  PgPressureMethod    method;
  PgTableFiles        files;
  PgTable             table = NULL;

  PetscFunctionBeginUser;
  PetscCall(PgTableFilesFromOutput(comm, output, &files));
  for (PetscInt level = 0; level < plan->levels; level++) {
    const PgMmsPacking packing = PgMmsLevel(plan, level);
    PgMmsSet           set;

    PetscCall(PgMmsSetCreate(comm, &packing, PETSC_TRUE, (PetscBool)(sides == PG_MMS_DIRICHLET), &set));
    PetscCall(PgPressureGetMethod(set.pressure, &method));
    PgInputCheck(method == PG_PRESSURE_IMPLICIT, comm,
                 "case pressure_mms is about the solution of the equation: -pressure explicit does not solve it");
    PetscCall(Measure(&set, sides, &e));
    if (level == 0) {
      PetscCall(PgOptionsCheckUnused(comm, PgPressureProbeOptions, set.pressure));
      PetscCall(PgSphView(set.sph, PETSC_VIEWER_STDOUT_(comm)));
      PetscCall(PgPressureView(set.pressure, PETSC_VIEWER_STDOUT_(comm)));
      PetscCall(PgTableCreate(&files, "study", COLUMNS, columns, &table));
    }
    PetscCall(PgMmsSetDestroy(&set));
    PgMmsAdd(&s[ERROR], e.h, e.error);
    PgMmsAdd(&s[SHAPE], e.h, e.shape);
    PetscCall(FillRow(table, &packing, plan, &e, s));
  }
  PetscCall(PgTableDestroy(&table));
  PetscCall(Judge(comm, &e, s));
  PetscFunctionReturn(0);
}

const PgCaseInfo PgCasePressureMms = {"pressure_mms",
                                      "pressure equation solved for an exact field on packings that are refined: order",
                                      Create,
                                      NULL,
                                      PgCaseDestroyContext,
                                      Run};
