/* Nominal strain: the deformation of the neighbourhood that a disc had at the start.

   Kept in the order of permanent ids, where it never moves: partners at the start and their offsets are
   fixed, only present positions are fetched. */
#include "simulationimpl.h"
#include <petscsf.h>

struct PgStrain_s {
  PgParticles  particles;
  PetscInt     count;    /* discs of this id range */
  PetscInt    *ptr;      /* partners of disc i: ptr[i] .. ptr[i+1]-1 */
  PetscReal   *offset;   /* (2) their positions relative to the disc at the start [m] */
  PetscReal   *position; /* (2) present positions of this id range */
  PetscReal   *partner;  /* (2) and of the partners */
  PetscSF      sf;       /* from id range to partner entries */
  MPI_Datatype pair;     /* two reals */
};

enum { MOST = 12 }; /* partners kept of one disc: nearest in id order; a lattice has 6 */

static PetscErrorCode Partners(PgParticles particles, PgNeighbors neighbors, PetscReal *owned_partner)
{
  PgContactList   list;
  const PetscInt *id;
  PetscInt        owned;

  PetscFunctionBeginUser;
  PetscCall(PgNeighborsGetContacts(neighbors, &list));
  PetscCall(PgParticlesGetIds(particles, &id));
  PetscCall(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  for (PetscInt i = 0; i < owned; i++) {
    PetscInt n = 0;
    for (PetscInt k = list.ptr[i]; k < list.ptr[i + 1] && n < MOST; k++) {
      const PetscInt pair           = list.sum[k] / 2;
      owned_partner[MOST * i + n++] = (PetscReal)id[list.sum[k] % 2 ? list.low[pair] : list.high[pair]];
    }
    for (; n < MOST; n++) owned_partner[MOST * i + n] = -1.0;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode FetchPositions(PgStrain strain, PgField field)
{
  PetscReal *x;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetArray(strain->particles, field, &x));
  PetscCall(PgParticlesToIdOrder(strain->particles, 2, x, strain->position));
  PetscCall(PetscSFBcastBegin(strain->sf, strain->pair, strain->position, strain->partner, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(strain->sf, strain->pair, strain->position, strain->partner, MPI_REPLACE));
  PetscFunctionReturn(0);
}

/* The period to add so that an offset is that of the nearest image. */
static PetscReal NearestImage(PetscBool periodic, PetscReal period, PetscReal dx)
{
  return periodic ? dx - period * PetscFloorReal(dx / period + 0.5) : dx;
}

PetscErrorCode PgStrainCreate(PgParticles particles, PgNeighbors neighbors, PgStrain *strain)
{
  PgStrain    s;
  PetscReal  *owned_partner, *partner, low, high;
  PetscInt    owned, start, global, *remote, entries = 0;
  PetscBool   periodic;
  PetscLayout layout;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  s->particles = particles;
  PetscCall(PgParticlesGetSizes(particles, &owned, NULL, &global));
  PetscCall(PgParticlesGetIdRange(particles, &start, &s->count));
  PetscCall(PetscMalloc2(MOST * owned, &owned_partner, MOST * s->count, &partner));
  PetscCall(Partners(particles, neighbors, owned_partner));
  PetscCall(PgParticlesToIdOrder(particles, MOST, owned_partner, partner));
  PetscCall(PetscMalloc1(s->count + 1, &s->ptr));
  PetscCall(PetscMalloc1(MOST * s->count, &remote));
  s->ptr[0] = 0;
  for (PetscInt i = 0; i < s->count; i++) {
    for (PetscInt k = 0; k < MOST; k++)
      if (partner[MOST * i + k] >= 0.0) remote[entries++] = (PetscInt)partner[MOST * i + k];
    s->ptr[i + 1] = entries;
  }
  PetscCall(PetscFree2(owned_partner, partner));
  PetscCall(PetscMalloc3(2 * s->count, &s->position, 2 * entries, &s->partner, 2 * entries, &s->offset));
  PetscCall(PetscLayoutCreate(PgParticlesComm(particles), &layout));
  PetscCall(PetscLayoutSetLocalSize(layout, s->count));
  PetscCall(PetscLayoutSetUp(layout));
  PetscCallMPI(MPI_Type_contiguous(2, MPIU_REAL, &s->pair));
  PetscCallMPI(MPI_Type_commit(&s->pair));
  PetscCall(PetscSFCreate(PgParticlesComm(particles), &s->sf));
  PetscCall(PetscSFSetGraphLayout(s->sf, layout, entries, NULL, PETSC_COPY_VALUES, remote));
  PetscCall(PetscLayoutDestroy(&layout));
  PetscCall(PetscFree(remote));
  PetscCall(FetchPositions(s, PG_INITIAL_POSITION));
  PetscCall(PgParticlesGetPeriodicX(particles, &periodic, &low, &high));
  for (PetscInt i = 0; i < s->count; i++)
    for (PetscInt k = s->ptr[i]; k < s->ptr[i + 1]; k++) {
      s->offset[2 * k]     = NearestImage(periodic, high - low, s->partner[2 * k] - s->position[2 * i]);
      s->offset[2 * k + 1] = s->partner[2 * k + 1] - s->position[2 * i + 1];
    }
  *strain = s;
  PetscFunctionReturn(0);
}

/* Least-squares F with F X = x over the partners: (sum x X^T)(sum X X^T)^-1. Zero strain when the partners
   lie on one line and do not determine it. */
static void FromGradient(const PetscReal A[4], const PetscReal B[3], PetscReal *effective, PetscReal *volumetric)
{
  const PetscReal det = B[0] * B[2] - B[1] * B[1], trace = B[0] + B[2];
  PetscReal       F[4], E[3], mean, exx, eyy, ezz;

  *effective = *volumetric = 0.0;
  if (!(det > 1e-6 * trace * trace)) return; /* of a lattice: 0.25 trace^2 */
  F[0]        = (A[0] * B[2] - A[1] * B[1]) / det;
  F[1]        = (A[1] * B[0] - A[0] * B[1]) / det;
  F[2]        = (A[2] * B[2] - A[3] * B[1]) / det;
  F[3]        = (A[3] * B[0] - A[2] * B[1]) / det;
  *volumetric = F[0] * F[3] - F[1] * F[2] - 1.0;
  E[0]        = 0.5 * (F[0] * F[0] + F[2] * F[2] - 1.0);
  E[1]        = 0.5 * (F[0] * F[1] + F[2] * F[3]);
  E[2]        = 0.5 * (F[1] * F[1] + F[3] * F[3] - 1.0);
  mean        = (E[0] + E[2]) / 3.0; /* plane strain: E_zz = 0 */
  exx         = E[0] - mean;
  eyy         = E[2] - mean;
  ezz         = -mean;
  *effective  = PetscSqrtReal(2.0 / 3.0 * (exx * exx + eyy * eyy + ezz * ezz + 2.0 * E[1] * E[1]));
}

PetscErrorCode PgStrainCompute(PgStrain strain, PetscReal effective[], PetscReal volumetric[])
{
  PetscReal low, high;
  PetscBool periodic;

  PetscFunctionBeginUser;
  PetscCall(FetchPositions(strain, PG_POSITION));
  PetscCall(PgParticlesGetPeriodicX(strain->particles, &periodic, &low, &high));
  for (PetscInt i = 0; i < strain->count; i++) {
    PetscReal A[4] = {0}, B[3] = {0};
    for (PetscInt k = strain->ptr[i]; k < strain->ptr[i + 1]; k++) {
      const PetscReal X = strain->offset[2 * k], Y = strain->offset[2 * k + 1];
      const PetscReal x = NearestImage(periodic, high - low, strain->partner[2 * k] - strain->position[2 * i]);
      const PetscReal y = strain->partner[2 * k + 1] - strain->position[2 * i + 1];
      A[0] += x * X;
      A[1] += x * Y;
      A[2] += y * X;
      A[3] += y * Y;
      B[0] += X * X;
      B[1] += X * Y;
      B[2] += Y * Y;
    }
    FromGradient(A, B, &effective[i], &volumetric[i]);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgStrainDestroy(PgStrain *strain)
{
  PetscFunctionBeginUser;
  if (!*strain) PetscFunctionReturn(0);
  PetscCall(PetscFree((*strain)->ptr));
  PetscCall(PetscFree3((*strain)->position, (*strain)->partner, (*strain)->offset));
  PetscCall(PetscSFDestroy(&(*strain)->sf));
  PetscCallMPI(MPI_Type_free(&(*strain)->pair));
  PetscCall(PetscFree(*strain));
  PetscFunctionReturn(0);
}
