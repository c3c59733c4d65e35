/* -study explicit: how far explicit sweeps are from the solved pressure, inside a run at chosen fluid steps. */
#include "studyimpl.h"

enum {
  COLUMN_STEP,
  COLUMN_TIME,
  COLUMN_SWEEPS,
  COLUMN_RESIDUAL,
  COLUMN_ERROR_MAX,
  COLUMN_ERROR_RELATIVE,
  COLUMN_ERROR_L2,
  COLUMN_RANGE,
  COLUMNS
};

static const PgTableColumn columns[COLUMNS] = {
    [COLUMN_STEP]   = {"step", "1", "fluid step", "step", "%.0f", 8},
    [COLUMN_TIME]   = {"time", "s", "simulated time", "time s", "%.3e", 10},
    [COLUMN_SWEEPS] = {"sweeps", "1", "explicit sweeps from the guess of Eq. 59; 0: the guess itself", "sweeps", "%.0f",
                       8},
    [COLUMN_RESIDUAL]       = {"residual", "1", "||b - A p||/||b||", "residual", "%.2e", 9},
    [COLUMN_ERROR_MAX]      = {"error_max", "Pa", "largest difference from the solved pressure", "max Pa", "%.3g", 9},
    [COLUMN_ERROR_RELATIVE] = {"error_relative", "1", "the same over the largest excess pressure", "relative", "%.2e",
                               9},
    [COLUMN_ERROR_L2] = {"error_l2", "1", "L2 norm of the difference over that of the excess pressure", "L2", "%.2e",
                         9},
    [COLUMN_RANGE]    = {"pressure_max", "Pa", "largest excess pressure of the solution", "p* max Pa", "%.4g", 10},
};

static PetscErrorCode Options(PgStudy study, PetscOptionItems *PetscOptionsObject)
{
  PetscFunctionBeginUser;
  PetscCall(PgOptionIntList(PetscOptionsObject, "-study_at", "fluid steps at which sweeps are compared", 1, 1000000000,
                            &study->at, NULL));
  PetscCall(PgOptionIntList(PetscOptionsObject, "-study_sweeps", "numbers of sweeps, ascending", 0, 10000000,
                            &study->sweeps, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-study_time",
                         "simulated time of the runs whose loads are compared; 0: no such runs", "s", 0.0, 1e9,
                         &study->stretch, NULL));
  PetscCall(PgOptionInt(PetscOptionsObject, "-study_samples", "loads compared in that time", 2, 100000, &study->samples,
                        NULL));
  PetscCall(PgOptionString(
      PetscOptionsObject, "-study_variants",
      "runs to compare, the first is the reference: implicit:M, implicitR:M or explicitK:M, with relative "
      "tolerance R, K sweeps, and M steps of the discs in one of the water",
      study->variants, sizeof study->variants, NULL));
  PetscFunctionReturn(0);
}

/* The system of the step just done, its solution x and the guess, all in the unknown of the matrix. What lies between
   the field pressure and the unknown (reference, hydrostatic part) is the same for the guess. */
typedef struct {
  Mat A;
  Vec b, solution, x, r, diagonal;
} State;

static PetscErrorCode Begin(PgSimulation sim, State *s)
{
  PgParticles  particles;
  PgPore       pore;
  PgPressure   pressure;
  KSP          ksp;
  Vec          x;
  PgField      field;
  PetscReal   *p, *guess, *fixed;
  PetscScalar *v;
  PetscInt     owned;

  PetscFunctionBeginUser;
  PetscCall(PgSimulationGetParts(sim, &particles, NULL, NULL, &pore));
  PetscCall(PgPoreGetParts(pore, NULL, &pressure));
  PetscCall(PgPressureGetSystem(pressure, &s->A, &s->b, &ksp));
  PetscCall(KSPGetSolution(ksp, &x));
  PetscCall(VecDuplicate(s->b, &s->solution));
  PetscCall(VecDuplicate(s->b, &s->x));
  PetscCall(VecDuplicate(s->b, &s->r));
  PetscCall(VecDuplicate(s->b, &s->diagonal));
  PetscCall(VecCopy(x, s->solution));
  PetscCall(VecCopy(x, s->x));
  PetscCall(MatGetDiagonal(s->A, s->diagonal));
  PetscCall(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  PetscCall(PgParticlesFindField(particles, "pressure", &field));
  PetscCall(PgParticlesGetArray(particles, field, &p));
  PetscCall(PgParticlesFindField(particles, "pressure_guess", &field));
  PetscCall(PgParticlesGetArray(particles, field, &guess));
  PetscCall(PgParticlesFindField(particles, "pressure_fixed", &field));
  PetscCall(PgParticlesGetArray(particles, field, &fixed));
  PetscCall(VecGetArray(s->x, &v));
  for (PetscInt a = 0; a < owned; a++)
    if (fixed[a] == 0.0) v[a] += guess[a] - p[a];
  PetscCall(VecRestoreArray(s->x, &v));
  PetscFunctionReturn(0);
}

static PetscErrorCode End(State *s)
{
  PetscFunctionBeginUser;
  PetscCall(VecDestroy(&s->solution));
  PetscCall(VecDestroy(&s->x));
  PetscCall(VecDestroy(&s->r));
  PetscCall(VecDestroy(&s->diagonal));
  PetscFunctionReturn(0);
}

/* r = b - A x. */
static PetscErrorCode Residual(State *s)
{
  PetscFunctionBeginUser;
  PetscCall(MatMult(s->A, s->x, s->r));
  PetscCall(VecAYPX(s->r, -1.0, s->b));
  PetscFunctionReturn(0);
}

static PetscErrorCode FillRow(PgTable table, State *s, PetscInt step, PetscReal time, PetscInt sweeps)
{
  PetscReal b, r, most, range, l2, all;

  PetscFunctionBeginUser;
  PetscCall(Residual(s));
  PetscCall(VecNorm(s->b, NORM_2, &b));
  PetscCall(VecNorm(s->r, NORM_2, &r));
  PetscCall(VecWAXPY(s->r, -1.0, s->solution, s->x));
  PetscCall(VecNorm(s->r, NORM_INFINITY, &most));
  PetscCall(VecNorm(s->r, NORM_2, &l2));
  PetscCall(VecNorm(s->solution, NORM_INFINITY, &range));
  PetscCall(VecNorm(s->solution, NORM_2, &all));
  PgTableReal(table, COLUMN_STEP, (PetscReal)step);
  PgTableReal(table, COLUMN_TIME, time);
  PgTableReal(table, COLUMN_SWEEPS, (PetscReal)sweeps);
  PgTableReal(table, COLUMN_RESIDUAL, b > 0.0 ? r / b : r);
  PgTableReal(table, COLUMN_ERROR_MAX, most);
  if (range > 0.0) PgTableReal(table, COLUMN_ERROR_RELATIVE, most / range);
  if (all > 0.0) PgTableReal(table, COLUMN_ERROR_L2, l2 / all);
  PgTableReal(table, COLUMN_RANGE, range);
  PetscCall(PgTableEndRow(table, 0, NULL, NULL, NULL));
  PetscFunctionReturn(0);
}

/* p += D^-1 (b - A p): one sweep of Eq. 55. */
static PetscErrorCode Sweep(State *s, PetscInt count)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < count; i++) {
    PetscCall(Residual(s));
    PetscCall(VecPointwiseDivide(s->r, s->r, s->diagonal));
    PetscCall(VecAXPY(s->x, 1.0, s->r));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode CompareSweeps(PgStudy study, PgSimulation sim, PgTable table)
{
  State     s = {0};
  PetscInt  step, done = 0;
  PetscReal time;

  PetscFunctionBeginUser;
  PetscCall(PgSimulationGetTime(sim, &step, &time, NULL));
  PetscCall(Begin(sim, &s));
  for (PetscInt i = 0; i < study->sweeps.count; i++) {
    PetscCall(Sweep(&s, study->sweeps.value[i] - done));
    done = study->sweeps.value[i];
    PetscCall(FillRow(table, &s, step, time, done));
  }
  PetscCall(End(&s));
  PetscFunctionReturn(0);
}

/* A sweep moves p by (lap p - Z)/L_a, L_a = sum |c_ab| dV_b: over a fluid step dt that is diffusion of pressure
   with D = (1/4) sum |c_ab| dV_b r_ab^2/(L_a dt), the second moment of the weights. Mean over the discs that have
   others on all sides. */
static PetscErrorCode DeriveDiffusivity(PgSimulation sim, PetscReal *mean, PetscReal *spacing)
{
  PgParticles       particles;
  PgPore            pore;
  PgSph             sph;
  PgSphCoefficients c;
  const PgKernel   *kernel;
  PetscReal         smoothing;
  PetscReal        *x, *radius, sum[3] = {0.0, 0.0, 0.0};
  PetscInt          owned;

  PetscFunctionBeginUser;
  PetscCall(PgSimulationGetParts(sim, &particles, NULL, NULL, &pore));
  PetscCall(PgPoreGetParts(pore, &sph, NULL));
  PetscCall(PgSphGetCoefficients(sph, &c));
  PetscCall(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(particles, PG_POSITION, &x));
  PetscCall(PgParticlesGetArray(particles, PG_RADIUS, &radius));
  PetscCall(PgSphGetKernel(sph, &kernel, &smoothing));
  for (PetscInt a = 0; a < owned; a++) {
    PetscReal L = 0.0, moment = 0.0, gx = 0.0, gy = 0.0;
    for (PetscInt k = c.ptr[a]; k < c.ptr[a + 1]; k++) {
      const PetscReal dx = x[2 * c.col[k]] - x[2 * a], dy = x[2 * c.col[k] + 1] - x[2 * a + 1];
      L -= c.laplacian[k];
      moment -= c.laplacian[k] * (dx * dx + dy * dy);
      gx += c.gradient[2 * k];
      gy += c.gradient[2 * k + 1];
    }
    /* surrounded on all sides: the gradients nearly cancel; in the second row from an edge they sum to 0.12/h */
    if (PetscSqrtReal(gx * gx + gy * gy) * smoothing * radius[a] > 0.05) continue;
    sum[0] += moment / (4.0 * L);
    sum[1] += 2.0 * radius[a];
    sum[2] += 1.0;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPIU_SUM, PgParticlesComm(particles)));
  *mean    = sum[2] > 0.0 ? sum[0] / sum[2] : 0.0;
  *spacing = sum[2] > 0.0 ? sum[1] / sum[2] : 1.0;
  PetscFunctionReturn(0);
}

/* Extent of the discs' centres. */
static PetscErrorCode Extent(PgParticles particles, PetscReal extent[2])
{
  PetscReal *x, most[4] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL};
  PetscInt   owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(particles, PG_POSITION, &x));
  for (PetscInt a = 0; a < owned; a++)
    for (int c = 0; c < 2; c++) {
      most[c]     = PetscMax(most[c], x[2 * a + c]);
      most[c + 2] = PetscMax(most[c + 2], -x[2 * a + c]);
    }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 4, MPIU_REAL, MPIU_MAX, PgParticlesComm(particles)));
  extent[0] = most[0] + most[2];
  extent[1] = most[1] + most[3];
  PetscFunctionReturn(0);
}

/* The same from what sweeps do: with b = 0 and all sides drained, the slowest mode sin(pi x/W) sin(pi y/H) shrinks by
   1 - D dt pi^2 (1/W^2 + 1/H^2) in each. *measured = 0 when a side is not drained. */
static PetscErrorCode MeasureDiffusivity(PgSimulation sim, PetscReal *measured)
{
  enum { SETTLE = 4000, COUNT = 1000 };
  PgParticles particles;
  PgPore      pore;
  State       s = {0};
  Vec         b;
  PetscReal   before, after, extent[2];

  PetscFunctionBeginUser;
  *measured = 0.0;
  PetscCall(PgSimulationGetParts(sim, &particles, NULL, NULL, &pore));
  for (int i = 0; i < PG_SIDE_COUNT; i++) {
    PgBoundary bc;
    PetscCall(PgPoreGetBoundary(pore, (PgSide)i, &bc));
    if (bc.kind != PG_BC_DRAINED) PetscFunctionReturn(0);
  }
  PetscCall(Extent(particles, extent));
  PetscCall(Begin(sim, &s));
  b = s.b;
  PetscCall(VecDuplicate(b, &s.b));
  PetscCall(VecSet(s.b, 0.0));
  PetscCall(VecSet(s.x, 1.0)); /* holds every mode; the slowest is left over */
  PetscCall(Sweep(&s, SETTLE));
  PetscCall(VecNorm(s.x, NORM_2, &before));
  PetscCall(Sweep(&s, COUNT));
  PetscCall(VecNorm(s.x, NORM_2, &after));
  if (before > 0.0 && after > 0.0)
    *measured = PetscLogReal(before / after) / COUNT /
                (PETSC_PI * PETSC_PI * (1.0 / PetscSqr(extent[0]) + 1.0 / PetscSqr(extent[1])));
  PetscCall(VecDestroy(&s.b));
  s.b = b;
  PetscCall(End(&s));
  PetscFunctionReturn(0);
}

static PetscErrorCode Diffusivity(PgStudy study, PgSimulation sim)
{
  PetscReal derived = 0.0, spacing = 1.0, measured = 0.0, time, dt = 1.0;
  PetscInt  step;

  PetscFunctionBeginUser;
  PetscCall(PgSimulationGetTime(sim, &step, &time, &dt));
  PetscCall(DeriveDiffusivity(sim, &derived, &spacing));
  PetscCall(MeasureDiffusivity(sim, &measured));
  PetscCall(PetscPrintf(study->comm,
                        "one sweep spreads pressure like diffusion with D = %.3f d^2/dt, d = %g m the spacing, by the "
                        "moments of its weights",
                        (double)(derived / PetscSqr(spacing)), (double)spacing));
  if (measured > 0.0)
    PetscCall(PetscPrintf(study->comm, "; %.3f d^2/dt by the decay of the slowest mode",
                          (double)(measured / PetscSqr(spacing))));
  PetscCall(PetscPrintf(study->comm, ".\nWith one sweep in each time step of %g s that is %.3g m^2/s.\n", (double)dt,
                        (double)(derived / dt)));
  PetscFunctionReturn(0);
}

static PetscErrorCode Sweeps(PgStudy study)
{
  PgOverride   o = {0};
  PgSimulation sim;
  PgTable      table;
  PgPore       pore;
  PetscInt     last = 0, next = 0;

  PetscFunctionBeginUser;
  PetscCall(PgOverrideSet(&o, "-pressure", "implicit"));
  PetscCall(PgOverrideRemove(&o, "-output")); /* a study does not write over the results of a run */
  PetscCall(PgSimulationCreate(study->comm, &sim));
  PetscCall(PgSimulationSetFromOptions(sim));
  PetscCall(PgSimulationGetParts(sim, NULL, NULL, NULL, &pore));
  PgInputCheck(pore, study->comm, "-study explicit needs water: -fluid darcy or ns, or -options_file with a case");
  PetscCall(PgSimulationSetUp(sim));
  PetscCall(PgTableCreate(&study->files, "study", COLUMNS, columns, &table));
  for (PetscInt i = 0; i < study->at.count; i++) last = PetscMax(last, study->at.value[i]);
  for (PetscInt step = 1; step <= last; step++) {
    PetscBool wanted = PETSC_FALSE;
    PetscCall(PgSimulationStep(sim));
    for (PetscInt i = 0; i < study->at.count; i++) wanted = (PetscBool)(wanted || study->at.value[i] == step);
    if (!wanted) continue;
    PetscCall(CompareSweeps(study, sim, table));
    if (next++ == 0) PetscCall(Diffusivity(study, sim));
  }
  PetscCall(PgTableDestroy(&table));
  PetscCall(PgSimulationDestroy(&sim));
  PetscCall(PgOverrideRestore(&o, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode RunStudy(PgStudy study)
{
  PetscFunctionBeginUser;
  PetscCall(Sweeps(study));
  if (study->stretch > 0.0) PetscCall(PgStudyCost(study));
  PetscFunctionReturn(0);
}

const PgStudyKind PgStudyExplicit = {"explicit", "sweeps against the solved pressure inside a run, and what each costs",
                                     Options, RunStudy};
