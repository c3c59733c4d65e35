/* Critical time step. Irons' element bound: split the mass and inertia of every disc among the springs on
   it; then no frequency of the whole is above the highest frequency of one spring with its shares. */
#include "demimpl.h"

/* Whether disc i counts as one that touches wall k, or, with `all`, as one that may. */
static PetscBool AtWall(PgDem dem, const PgDemDiscs *discs, PetscInt i, PetscInt k, PetscBool all, PetscReal skin)
{
  const PetscReal r = discs->radius[i], overlap = PgDemWallOverlap(&dem->walls[k]->wall, &discs->position[2 * i], r);

  return all ? (PetscBool)(overlap > -skin) : PgDemTouching(overlap, r, r);
}

/* Number of springs that share a disc: touching discs, walls and its plate, or, when no pair of the whole
   packing touches nor any disc a wall, all pairs of the list and walls within the skin. Collective. */
static PetscErrorCode CountShares(PgDem dem, const PgContactList *list, const PgDemDiscs *discs, PetscReal skin,
                                  PetscBool *all)
{
  PetscInt    owned;
  PetscReal  *share, *plate;
  PetscMPIInt touch = 0;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(dem->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(dem->particles, dem->share, &share));
  PetscCall(PgParticlesGetArray(dem->particles, dem->plate, &plate));
  for (PetscInt i = 0; i < owned; i++) {
    share[i] = plate[i] > 0;
    for (PetscInt k = list->ptr[i]; k < list->ptr[i + 1]; k++) {
      const PetscInt a = list->low[list->sum[k] >> 1], j = list->high[list->sum[k] >> 1];
      PetscReal      n[2];

      if (!PgDemTouching(PgDemPairGeometry(discs, a, j, n), discs->radius[a], discs->radius[j])) continue;
      share[i] += 1;
      touch = 1;
    }
    for (PetscInt k = 0; k < dem->wall_count; k++) {
      if (!AtWall(dem, discs, i, k, PETSC_FALSE, skin)) continue;
      share[i] += 1;
      touch = 1;
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &touch, 1, MPI_INT, MPI_MAX, PgParticlesComm(dem->particles)));
  *all = (PetscBool)!touch;
  for (PetscInt i = 0; *all && i < owned; i++) {
    share[i] += (PetscReal)(list->ptr[i + 1] - list->ptr[i]);
    for (PetscInt k = 0; k < dem->wall_count; k++) share[i] += AtWall(dem, discs, i, k, PETSC_TRUE, skin);
  }
  PetscCall(PgParticlesHalo(dem->particles, 1, &dem->share));
  PetscFunctionReturn(0);
}

/* 2/omega (sqrt(1 + zeta^2) - zeta) with omega2 = omega^2 and D = 2 zeta omega, written so that neither has
   to be positive alone. */
static PetscReal Limit(PetscReal omega2, PetscReal D)
{
  const PetscReal rate = PetscSqrtReal(omega2 + 0.25 * D * D) + 0.5 * D;
  return rate > 0 ? 2 / rate : PETSC_MAX_REAL;
}

/* inverse: sum of z/m; swing: sum of r^2 z/I; turn: sum of z/I, over the discs of the spring. The tangential
   springs and the moment are added up: a bound of their coupled modes. */
static PetscReal ContactLimit(const PgContactParameters *p, PetscReal inverse, PetscReal swing, PetscReal turn)
{
  const PetscReal normal     = Limit(p->k_n * inverse, p->c_n * inverse);
  const PetscReal tangential = Limit((p->k_s + p->k_r) * (inverse + swing) + p->k_theta * turn,
                                     (p->c_s + p->c_r) * (inverse + swing) + p->c_theta * turn);

  return PetscMin(normal, tangential);
}

/* Springs and dashpots of a contact as they act now. A Hertzian one, which is soft at first touch, counts as if pressed
   by a hundredth of its radius at least. */
static PgContactParameters Acting(PgDem dem, PetscReal overlap, PetscReal R)
{
  PgContactParameters p = dem->parameters;

  if (!dem->law->stiffness) return p;
  p.k_n = dem->law->stiffness(&p, PetscMax(overlap, 0.01 * R), R);
  p.k_r = p.k_theta = p.c_r = p.c_theta = 0;
  return p;
}

/* The spring that limits the time step: the largest stable one, and an owned disc at its end (-1: no spring). */
typedef struct {
  PetscReal       limit; /* [s] */
  PetscInt        disc;
  const PetscInt *id;
} Stiffest;

/* Of equal ones the disc with the lowest id: so the message is the same on any number of ranks. */
static void Consider(Stiffest *stiffest, PetscReal limit, PetscInt disc)
{
  if (limit > stiffest->limit ||
      (limit == stiffest->limit && stiffest->disc >= 0 && stiffest->id[disc] >= stiffest->id[stiffest->disc]))
    return;
  stiffest->limit = limit;
  stiffest->disc  = disc;
}

/* Of this rank. `all`: nothing touches, and the springs that may come are considered. Collective. */
static PetscErrorCode FindStiffest(PgDem dem, Stiffest *stiffest, PetscBool *all)
{
  PgContactList list;
  PgDemDiscs    discs;
  PetscReal    *share, *m, *plate, skin;
  PetscInt      owned;

  PetscFunctionBeginUser;
  *stiffest = (Stiffest){PETSC_MAX_REAL, -1, NULL};
  PetscCall(PgParticlesGetIds(dem->particles, &stiffest->id));
  PetscCall(PgNeighborsGetContacts(dem->neighbors, &list));
  PetscCall(PgDemGetDiscs_Private(dem, &discs));
  PetscCall(PgNeighborsGetSkin(dem->neighbors, &skin));
  PetscCall(CountShares(dem, &list, &discs, skin, all));
  PetscCall(PgParticlesGetSizes(dem->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(dem->particles, dem->share, &share));
  PetscCall(PgParticlesGetArray(dem->particles, PG_MASS, &m));
  PetscCall(PgParticlesGetArray(dem->particles, dem->plate, &plate));
  for (PetscInt k = 0; k < list.count; k++) {
    const PetscInt            a = list.low[k], j = list.high[k];
    const PetscReal           r_a = discs.radius[a], r_j = discs.radius[j];
    const PetscReal           z_a = share[a] / m[a], z_j = share[j] / m[j]; /* I = m r^2/2 */
    PetscReal                 n[2];
    const PetscReal           overlap = PgDemPairGeometry(&discs, a, j, n);
    const PgContactParameters p       = Acting(dem, overlap, r_a * r_j / (r_a + r_j));

    if (!*all && !PgDemTouching(overlap, r_a, r_j)) continue;
    Consider(stiffest, ContactLimit(&p, z_a + z_j, 2 * (z_a + z_j), 2 * (z_a / (r_a * r_a) + z_j / (r_j * r_j))),
             a < owned ? a : j);
  }
  for (PetscInt i = 0; i < owned; i++) { /* the other side of a wall contact is of infinite mass */
    const PetscReal z = share[i] / m[i], r = discs.radius[i];
    for (PetscInt k = 0; k < dem->wall_count; k++) {
      const PgContactParameters p = Acting(dem, PgDemWallOverlap(&dem->walls[k]->wall, &discs.position[2 * i], r), r);
      if (AtWall(dem, &discs, i, k, *all, skin)) Consider(stiffest, ContactLimit(&p, z, 2 * z, 2 * z / (r * r)), i);
    }
  }
  for (PetscInt i = 0; i < owned; i++)
    if (plate[i] > 0) Consider(stiffest, Limit(dem->parameters.k_s * 3 * share[i] / m[i], 0), i);
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemCriticalTimeStep(PgDem dem, PetscReal *dt)
{
  Stiffest  stiffest;
  PetscBool all = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(FindStiffest(dem, &stiffest, &all));
  PetscCallMPI(MPI_Allreduce(&stiffest.limit, dt, 1, MPIU_REAL, MPIU_MIN, PgParticlesComm(dem->particles)));
  PetscFunctionReturn(0);
}

/* Names the disc; the same on all ranks. */
static PetscErrorCode ReportTooStiff(PgDem dem, const Stiffest *stiffest, PetscReal limit, PetscInt step,
                                     PetscReal time, PetscReal dt)
{
  MPI_Comm        comm = PgParticlesComm(dem->particles);
  const PetscInt *id;
  PetscReal      *x, *m, *share, sent[5] = {0};
  PetscInt        mine = -1;
  PetscMPIInt     holder;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetIds(dem->particles, &id));
  PetscCall(PgParticlesGetArray(dem->particles, PG_POSITION, &x));
  PetscCall(PgParticlesGetArray(dem->particles, PG_MASS, &m));
  PetscCall(PgParticlesGetArray(dem->particles, dem->share, &share));
  if (stiffest->disc >= 0) mine = id[stiffest->disc];
  PetscCall(PgFindHolder(comm, -stiffest->limit, mine, 0, &holder));
  if (stiffest->disc >= 0) {
    const PetscInt  i      = stiffest->disc;
    const PetscReal all[5] = {(PetscReal)id[i], x[2 * i], x[2 * i + 1], m[i], share[i]};
    PetscCall(PetscArraycpy(sent, all, 5));
  }
  PetscCallMPI(MPI_Bcast(sent, 5, MPIU_REAL, holder, comm));
  PgRunError(comm,
             "step %" PetscInt_FMT ", time %g s: disc %" PetscInt_FMT
             " at (%g, %g) m, mass %g kg/m, with %g springs on it bears a time step of at most %g s; %g s is above "
             "-dem_guard_time_step %g times that: give a smaller -dt",
             step, (double)time, (PetscInt)sent[0], (double)sent[1], (double)sent[2], (double)sent[3], (double)sent[4],
             (double)limit, (double)dt, (double)dem->guard_time_step);
}

PetscErrorCode PgDemGuardTimeStep(PgDem dem, PetscInt step, PetscReal time, PetscReal dt)
{
  Stiffest  stiffest;
  PetscReal limit;
  PetscBool all = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(FindStiffest(dem, &stiffest, &all));
  PetscCallMPI(MPI_Allreduce(&stiffest.limit, &limit, 1, MPIU_REAL, MPIU_MIN, PgParticlesComm(dem->particles)));
  if (!all && dt > dem->guard_time_step * limit) PetscCall(ReportTooStiff(dem, &stiffest, limit, step, time, dt));
  PetscFunctionReturn(0);
}
