/* Pressure systems: of the discs of a case, or read from a file written by -pressure_dump. */
#include "studyimpl.h"
#include <math.h>

PetscErrorCode PgSystemCreate(MPI_Comm comm, PgSystem **system)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(system));
  (*system)->comm = comm;
  PetscFunctionReturn(0);
}

PetscErrorCode PgSystemDestroy(PgSystem **system)
{
  PgSystem *s = *system;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  PetscCall(VecDestroy(&s->b));
  PetscCall(VecDestroy(&s->reference));
  PetscCall(MatDestroy(&s->A));
  PetscCall(PgPoreDestroy(&s->pore));
  PetscCall(PgDemDestroy(&s->dem));
  PetscCall(PgNeighborsDestroy(&s->neighbors));
  PetscCall(PgParticlesDestroy(&s->particles));
  if (s->info) PetscCall(s->info->destroy(&s->context));
  PetscCall(PetscFree(*system));
  PetscFunctionReturn(0);
}

/* Only the matrix is wanted, which is the same for both fluids; Darcy's law bears sides of every kind. The study's
   own default is drained at bottom and top. */
PetscErrorCode PgSystemFromCase(PgSystem *s, const PgCaseInfo *info, const PgSystemChoices *choices)
{
  const PgBoundary natural = {PG_BC_NATURAL, 0.0, 0.0};

  PetscFunctionBeginUser;
  (void)choices;
  s->info = info;
  PetscCall(info->create(s->comm, &s->context));
  PetscCall(PgParticlesCreate(s->comm, &s->particles));
  PetscCall(PgNeighborsCreate(s->particles, &s->neighbors));
  PetscCall(PgDemCreate(s->particles, s->neighbors, &s->dem));
  PetscCall(PgPoreCreate(s->particles, s->neighbors, PG_FLUID_DARCY, &s->pore));
  PetscCall(PgParticlesSetFromOptions(s->particles));
  PetscCall(PgNeighborsSetFromOptions(s->neighbors));
  PetscCall(PgPoreSetBoundary(s->pore, PG_SIDE_LEFT, &natural));
  PetscCall(PgPoreSetBoundary(s->pore, PG_SIDE_RIGHT, &natural));
  PetscCall(PgPoreSetFromOptions(s->pore));
  PetscFunctionReturn(0);
}

/* Before the lists are built, so that no disc can leave their skin. A random packing has unequal radii too: rows of
   unequal volumes and reaches. */
static PetscErrorCode Disturb(PgSystem *s, const PgSystemChoices *choices)
{
  PetscReal      *x, *start, *radius;
  const PetscInt *id;
  PetscInt        owned;

  PetscFunctionBeginUser;
  if (choices->packing == PG_STUDY_LATTICE) PetscFunctionReturn(0);
  PetscCall(PgParticlesGetSizes(s->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(s->particles, PG_POSITION, &x));
  PetscCall(PgParticlesGetArray(s->particles, PG_INITIAL_POSITION, &start));
  PetscCall(PgParticlesGetArray(s->particles, PG_RADIUS, &radius));
  PetscCall(PgParticlesGetIds(s->particles, &id));
  for (PetscInt a = 0; a < owned; a++) {
    const PetscReal d = 2.0 * radius[a];
    for (int c = 0; c < 2; c++) x[2 * a + c] += d * choices->jitter * PgNoise(id[a], c);
    if (choices->packing == PG_STUDY_RANDOM) radius[a] *= 1.0 + 0.2 * PgNoise(id[a], 2);
  }
  PetscCall(PetscArraycpy(start, x, 2 * owned));
  PetscFunctionReturn(0);
}

/* Range of the centres in both directions, and the largest radius. */
static PetscErrorCode Range(PgSystem *s, PetscReal low[2], PetscReal high[2], PetscReal *radius)
{
  PetscReal *x, *r, most[5] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL, 0.0};
  PetscInt   owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(s->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(s->particles, PG_POSITION, &x));
  PetscCall(PgParticlesGetArray(s->particles, PG_RADIUS, &r));
  for (PetscInt a = 0; a < owned; a++) {
    for (int c = 0; c < 2; c++) {
      most[c]     = PetscMax(most[c], x[2 * a + c]);
      most[c + 2] = PetscMax(most[c + 2], -x[2 * a + c]);
    }
    most[4] = PetscMax(most[4], r[a]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 5, MPIU_REAL, MPIU_MAX, s->comm));
  for (int c = 0; c < 2; c++) {
    high[c] = most[c];
    low[c]  = -most[c + 2];
  }
  *radius = most[4];
  PetscFunctionReturn(0);
}

/* A smooth factor along one axis that vanishes at drained ends, from 0 to 1 along the axis. */
static PetscReal Shape(PetscReal t, PetscBool low, PetscBool high)
{
  if (low && high) return PetscSinReal(PETSC_PI * t);
  if (low) return PetscSinReal(0.5 * PETSC_PI * t);
  return high ? PetscCosReal(0.5 * PETSC_PI * t) : 1.0 + 0.5 * PetscCosReal(2.0 * PETSC_PI * t);
}

/* The excess pressure that the right-hand side is made from, e with b = A e. Without any drained side it is smooth
   along both axes and has no mean to speak of. */
static PetscErrorCode Excess(PgSystem *s, Vec e)
{
  PetscReal    low[2] = {0.0, 0.0}, high[2] = {1.0, 1.0}, radius = 0.0, *x, *fixed;
  PetscBool    drained[4], any = PETSC_FALSE;
  PetscInt     owned;
  PetscScalar *value;
  PgField      field;

  PetscFunctionBeginUser;
  for (int i = 0; i < PG_SIDE_COUNT; i++) {
    PgBoundary bc;
    PetscCall(PgPoreGetBoundary(s->pore, (PgSide)i, &bc));
    drained[i] = (PetscBool)(bc.kind == PG_BC_DRAINED);
    any        = (PetscBool)(any || drained[i]);
  }
  PetscCall(Range(s, low, high, &radius));
  for (int c = 0; c < 2; c++) { /* a side that is not drained lies at the edge of its discs */
    if (!drained[2 * c]) low[c] -= radius;
    if (!drained[2 * c + 1]) high[c] += radius;
  }
  PetscCall(PgParticlesFindField(s->particles, "pressure_fixed", &field));
  PetscCall(PgParticlesGetArray(s->particles, field, &fixed));
  PetscCall(PgParticlesGetArray(s->particles, PG_POSITION, &x));
  PetscCall(PgParticlesGetSizes(s->particles, &owned, NULL, NULL));
  PetscCall(VecGetArrayWrite(e, &value));
  for (PetscInt a = 0; a < owned; a++) {
    const PetscReal X = (x[2 * a] - low[0]) / (high[0] - low[0]), Y = (x[2 * a + 1] - low[1]) / (high[1] - low[1]);
    if (fixed[a] != 0.0)
      value[a] = 0.0;
    else if (!any)
      value[a] = PetscCosReal(PETSC_PI * X) * PetscCosReal(2.0 * PETSC_PI * Y);
    else
      value[a] = Shape(X, drained[0], drained[1]) * Shape(Y, drained[2], drained[3]);
  }
  PetscCall(VecRestoreArrayWrite(e, &value));
  PetscFunctionReturn(0);
}

/* Rows of A in the order of permanent ids, those of the panel row by row, instead of that in which the discs are kept:
   incomplete factors depend on it. */
static PetscErrorCode OrderById(PgSystem *s, Vec e)
{
  const PetscInt    *index;
  const PetscScalar *before;
  PetscScalar       *after;
  PetscReal         *from, *to;
  PetscInt           owned, start, first, count, *row;
  IS                 rows;
  Mat                A;
  Vec                sorted;
  MatNullSpace       constant;
  PetscBool          known, symmetric, spd_known, spd;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(s->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetGlobalIndices(s->particles, &start, &index));
  PetscCall(PgParticlesGetIdRange(s->particles, &first, &count));
  PetscCall(PetscMalloc3(owned, &from, count, &to, count, &row));
  for (PetscInt a = 0; a < owned; a++) from[a] = (PetscReal)index[a];
  PetscCall(PgParticlesToIdOrder(s->particles, 1, from, to));
  for (PetscInt i = 0; i < count; i++) row[i] = (PetscInt)to[i];
  PetscCall(ISCreateGeneral(s->comm, count, row, PETSC_COPY_VALUES, &rows));
  PetscCall(MatCreateSubMatrix(s->A, rows, rows, MAT_INITIAL_MATRIX, &A));
  PetscCall(ISDestroy(&rows));
  PetscCall(MatGetNullSpace(s->A, &constant));
  PetscCall(MatSetNullSpace(A, constant));
  PetscCall(MatSetTransposeNullSpace(A, constant));
  PetscCall(MatIsSymmetricKnown(s->A, &known, &symmetric));
  PetscCall(MatIsSPDKnown(s->A, &spd_known, &spd));
  PetscCall(MatSetOption(A, MAT_SYMMETRIC, (PetscBool)(known && symmetric)));
  PetscCall(MatSetOption(A, MAT_SYMMETRY_ETERNAL, (PetscBool)(known && symmetric)));
  PetscCall(MatSetOption(A, MAT_SPD, (PetscBool)(spd_known && spd)));
  PetscCall(MatCreateVecs(A, &sorted, NULL));
  PetscCall(VecGetArrayRead(e, &before));
  for (PetscInt a = 0; a < owned; a++) from[a] = PetscRealPart(before[a]);
  PetscCall(VecRestoreArrayRead(e, &before));
  PetscCall(PgParticlesToIdOrder(s->particles, 1, from, to));
  PetscCall(VecGetArrayWrite(sorted, &after));
  for (PetscInt i = 0; i < count; i++) after[i] = to[i];
  PetscCall(VecRestoreArrayWrite(sorted, &after));
  PetscCall(PetscFree3(from, to, row));
  PetscCall(MatDestroy(&s->A));
  s->A         = A;
  s->reference = sorted;
  PetscFunctionReturn(0);
}

PetscErrorCode PgSystemBuild(PgSystem *s, const PgSystemChoices *choices)
{
  PgCaseSetup setup = {0};
  PgPressure  pressure;
  Vec         e;

  PetscFunctionBeginUser;
  setup.comm          = s->comm;
  setup.particles     = s->particles;
  setup.dem           = s->dem;
  setup.pore          = s->pore;
  setup.solid_density = 2000.0;
  PetscCall(s->info->setup(s->context, &setup));
  PetscCall(Disturb(s, choices));
  PetscCall(PgNeighborsBuild(s->neighbors));
  PetscCall(PgPoreSetUp(s->pore, 1.0));
  PetscCall(PgPoreGetParts(s->pore, NULL, &pressure));
  PetscCall(PgPressureGetSystem(pressure, &s->A, NULL, NULL));
  PetscCall(PetscObjectReference((PetscObject)s->A));
  PetscCall(PetscStrncpy(s->name, s->info->name, sizeof s->name));
  PetscCall(MatCreateVecs(s->A, &e, NULL));
  PetscCall(Excess(s, e));
  s->reference = e;
  if (choices->by_id) {
    PetscCall(OrderById(s, e));
    PetscCall(VecDestroy(&e));
  }
  PetscCall(VecDuplicate(s->reference, &s->b));
  PetscCall(MatMult(s->A, s->reference, s->b));
  s->reference_name = "the pressure that the right-hand side was made from";
  PetscCall(PgSystemFinish(s, choices));
  PetscFunctionReturn(0);
}

/* Stored entries, and those that are not zero. */
static PetscErrorCode CountEntries(PgSystem *s)
{
  PetscInt  start, end;
  PetscReal count[2] = {0.0, 0.0};

  PetscFunctionBeginUser;
  PetscCall(MatGetOwnershipRange(s->A, &start, &end));
  for (PetscInt i = start; i < end; i++) {
    PetscInt           n;
    const PetscScalar *value;
    PetscCall(MatGetRow(s->A, i, &n, NULL, &value));
    count[0] += (PetscReal)n;
    for (PetscInt k = 0; k < n; k++) count[1] += value[k] != 0.0;
    PetscCall(MatRestoreRow(s->A, i, &n, NULL, &value));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 2, MPIU_REAL, MPIU_SUM, s->comm));
  s->stored   = count[0] / (PetscReal)s->n;
  s->nonzeros = count[1] / (PetscReal)s->n;
  PetscFunctionReturn(0);
}

/* The part of b that no solution has is put there on request, and taken away unless that is the trap to be shown. */
static PetscErrorCode MakeCompatible(PgSystem *s, const PgSystemChoices *choices)
{
  MatNullSpace constant;
  PetscScalar  sum;
  PetscReal    norm;

  PetscFunctionBeginUser;
  PetscCall(VecNorm(s->b, NORM_2, &norm));
  PetscCall(VecShift(s->b, choices->imbalance * norm / PetscSqrtReal((PetscReal)s->n)));
  PetscCall(VecNorm(s->b, NORM_2, &norm));
  PetscCall(VecSum(s->b, &sum));
  s->removed = norm > 0.0 ? PetscAbsScalar(sum) / (PetscSqrtReal((PetscReal)s->n) * norm) : 0.0;
  PetscCall(MatGetNullSpace(s->A, &constant));
  if (!choices->unprojected) PetscCall(MatNullSpaceRemove(constant, s->b));
  if (!choices->no_nullspace) PetscFunctionReturn(0);
  PetscCall(MatSetNullSpace(s->A, NULL));
  PetscCall(MatSetTransposeNullSpace(s->A, NULL));
  PetscFunctionReturn(0);
}

/* What is left to do for systems from either source: facts, compatibility, and the direct solution to compare with. */
PetscErrorCode PgSystemFinish(PgSystem *s, const PgSystemChoices *choices)
{
  MatNullSpace constant;
  PetscBool    known, done = PETSC_FALSE;
  Vec          x;

  PetscFunctionBeginUser;
  PetscCall(MatGetSize(s->A, &s->n, NULL));
  PetscCall(CountEntries(s));
  PetscCall(MatGetNullSpace(s->A, &constant));
  s->singular = (PetscBool)(constant != NULL);
  PetscCall(MatIsSymmetricKnown(s->A, &known, &s->symmetric));
  s->symmetric = (PetscBool)(known && s->symmetric);
  if (s->singular) PetscCall(MakeCompatible(s, choices));
  PetscCall(VecNorm(s->b, NORM_2, &s->rhs_norm));
  if (s->singular || s->n > choices->direct_limit) PetscFunctionReturn(0);
  PetscCall(VecDuplicate(s->b, &x));
  PetscCall(PgSolveDirect(s->A, s->b, x, &done));
  if (done) {
    PetscCall(VecDestroy(&s->reference));
    s->reference      = x;
    s->reference_name = "a direct solve";
  } else {
    PetscCall(VecDestroy(&x));
  }
  PetscFunctionReturn(0);
}
