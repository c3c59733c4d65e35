/* The guard: stops a run that has gone wrong, and says where. */
#include "demimpl.h"
#include <stdio.h>

typedef enum { FINE, OUTSIDE, OVERLAP, FAST, NOT_FINITE } Trouble;

/* The worst disc of a rank: by kind of trouble, then by how bad, then by permanent id. */
typedef struct {
  Trouble   kind;
  PetscInt  disc, partner; /* local indices; partner < 0: wall -1 - partner */
  PetscReal value;         /* overlap fraction, speed, or way out of the domain */
} Offender;

/* What is sent about it. */
enum { SENT = 10 };

static PetscBool Worse(Trouble kind, PetscReal value, PetscInt id, const Offender *than, const PetscInt ids[])
{
  if (kind != than->kind) return (PetscBool)(kind > than->kind);
  if (value != than->value) return (PetscBool)(value > than->value);
  return (PetscBool)(id < ids[than->disc]);
}

/* How far a centre is outside the domain [m]; 0: inside. */
static PetscReal Outside(const PetscReal domain[4], const PetscReal x[2])
{
  const PetscReal dx = PetscMax(domain[0] - x[0], x[0] - domain[1]), dy = PetscMax(domain[2] - x[1], x[1] - domain[3]);

  return PetscMax(0, PetscMax(dx, dy));
}

static PetscErrorCode WorstDisc(PgDem dem, const PgDemDiscs *discs, const PetscInt id[], Offender *worst)
{
  PetscReal *force, *torque;
  PetscInt   owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(dem->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(dem->particles, dem->force, &force));
  PetscCall(PgParticlesGetArray(dem->particles, dem->torque, &torque));
  for (PetscInt i = 0; i < owned; i++) {
    const PetscReal *x = &discs->position[2 * i], *v = &discs->velocity[2 * i], *f = &force[2 * i];
    const PetscReal  all[] = {x[0], x[1], v[0], v[1], f[0], f[1], discs->spin[i], torque[i]};
    Trouble          kind  = FINE;
    PetscReal        value = 0;

    for (size_t c = 0; c < sizeof(all) / sizeof(*all); c++)
      if (PetscIsInfOrNanReal(all[c])) kind = NOT_FINITE;
    if (kind == FINE) {
      value = hypot(v[0], v[1]);
      if (value > dem->guard_speed) kind = FAST;
    }
    if (kind == FINE) {
      value = Outside(dem->guard_domain, x);
      if (value > 0) kind = OUTSIDE;
    }
    if (kind != FINE && Worse(kind, value, id[i], worst, id)) *worst = (Offender){kind, i, i, value};
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode WorstPair(PgDem dem, const PgDemDiscs *discs, const PetscInt id[], Offender *worst)
{
  PgContactList list;

  PetscFunctionBeginUser;
  PetscCall(PgNeighborsGetContacts(dem->neighbors, &list));
  for (PetscInt k = 0; k < list.count; k++) {
    const PetscInt  a = list.low[k], j = list.high[k];
    PetscReal       n[2];
    const PetscReal part = PgDemPairGeometry(discs, a, j, n) / PetscMin(discs->radius[a], discs->radius[j]);

    if (part > dem->guard_overlap && Worse(OVERLAP, part, id[a], worst, id)) *worst = (Offender){OVERLAP, a, j, part};
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode WorstAtWall(PgDem dem, const PgDemDiscs *discs, const PetscInt id[], Offender *worst)
{
  PetscInt owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(dem->particles, &owned, NULL, NULL));
  for (PetscInt k = 0; k < dem->wall_count; k++) {
    for (PetscInt i = 0; i < owned; i++) {
      const PetscReal r    = discs->radius[i];
      const PetscReal part = PgDemWallOverlap(&dem->walls[k]->wall, &discs->position[2 * i], r) / r;

      if (part > dem->guard_overlap && Worse(OVERLAP, part, id[i], worst, id))
        *worst = (Offender){OVERLAP, i, -1 - k, part};
    }
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode WorstKind(MPI_Comm comm, const Offender *mine, Trouble *kind)
{
  PetscMPIInt k = (PetscMPIInt)mine->kind;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &k, 1, MPI_INT, MPI_MAX, comm));
  *kind = (Trouble)k;
  PetscFunctionReturn(0);
}

/* Every rank gets the data of the worst disc of all. */
static PetscErrorCode Agree(PgDem dem, const PgDemDiscs *discs, const PetscInt id[], const Offender *mine, Trouble kind,
                            PetscReal sent[SENT])
{
  MPI_Comm       comm = PgParticlesComm(dem->particles);
  const PetscInt i    = mine->disc;
  PetscMPIInt    holder;
  PetscReal     *force, *torque;

  PetscFunctionBeginUser;
  PetscCall(PgFindHolder(comm, mine->value, mine->kind == kind ? id[i] : -1, 0, &holder));
  PetscCall(PgParticlesGetArray(dem->particles, dem->force, &force));
  PetscCall(PgParticlesGetArray(dem->particles, dem->torque, &torque));
  if (mine->kind == kind) {
    const PetscReal *x = &discs->position[2 * i], *v = &discs->velocity[2 * i];
    const PetscReal  all[SENT] = {(PetscReal)id[i],
                                  x[0],
                                  x[1],
                                  v[0],
                                  v[1],
                                  discs->spin[i],
                                  mine->value,
                                 mine->partner < 0 ? (PetscReal)mine->partner : (PetscReal)id[mine->partner],
                                  0,
                                  0};

    PetscCall(PetscArraycpy(sent, all, SENT));
    if (kind == NOT_FINITE) { /* an owned disc: it has a force */
      sent[7] = force[2 * i];
      sent[8] = force[2 * i + 1];
      sent[9] = torque[i];
    }
  }
  PetscCallMPI(MPI_Bcast(sent, SENT, MPIU_REAL, holder, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemGuard(PgDem dem, PetscInt step, PetscReal time)
{
  MPI_Comm        comm  = PgParticlesComm(dem->particles);
  Offender        worst = {FINE, 0, 0, 0};
  PgDemDiscs      discs;
  const PetscInt *id;
  PetscReal       s[SENT];
  Trouble         kind;
  char            where[256];

  PetscFunctionBeginUser;
  PetscCall(PgDemGetDiscs_Private(dem, &discs));
  PetscCall(PgParticlesGetIds(dem->particles, &id));
  PetscCall(WorstDisc(dem, &discs, id, &worst));
  PetscCall(WorstKind(comm, &worst, &kind));
  if (kind != NOT_FINITE) { /* distances mean nothing then */
    PetscCall(WorstPair(dem, &discs, id, &worst));
    PetscCall(WorstAtWall(dem, &discs, id, &worst));
    PetscCall(WorstKind(comm, &worst, &kind));
  }
  if (kind == FINE) PetscFunctionReturn(0);
  PetscCall(Agree(dem, &discs, id, &worst, kind, s));
  (void)snprintf(
      where, sizeof where,
      "step %" PetscInt_FMT ", time %g s: disc %" PetscInt_FMT " at (%g, %g) m, velocity (%g, %g) m/s, spin %g rad/s",
      step, (double)time, (PetscInt)s[0], (double)s[1], (double)s[2], (double)s[3], (double)s[4], (double)s[5]);
  if (kind == NOT_FINITE)
    PgRunError(comm, "%s: not finite; force (%g, %g) N/m, torque %g N", where, (double)s[7], (double)s[8],
               (double)s[9]);
  if (kind == FAST)
    PgRunError(comm, "%s: speed %g m/s is above -dem_guard_speed %g", where, (double)s[6], (double)dem->guard_speed);
  if (kind == OUTSIDE)
    PgRunError(comm, "%s: it has left -dem_guard_domain %g,%g,%g,%g", where, (double)dem->guard_domain[0],
               (double)dem->guard_domain[1], (double)dem->guard_domain[2], (double)dem->guard_domain[3]);
  if (s[7] < 0)
    PgRunError(comm, "%s: overlap with wall %s is %g of the radius, above -dem_guard_overlap %g", where,
               dem->walls[-1 - (PetscInt)s[7]]->wall.name, (double)s[6], (double)dem->guard_overlap);
  PgRunError(comm, "%s: overlap with disc %" PetscInt_FMT " is %g of the smaller radius, above -dem_guard_overlap %g",
             where, (PetscInt)s[7], (double)s[6], (double)dem->guard_overlap);
}
