/* Forces and moments on the owned discs: contacts, plates, walls, gravity, water, damping (Eqs. 1, 2). */
#include "demimpl.h"

/* Arrays of one evaluation. */
typedef struct {
  PgContactList    list;
  PgDemDiscs       discs;
  const PetscReal *result; /* by pair */
  const PetscReal *mass, *fluid, *external, *plate;
  PetscReal       *force, *torque, *spring, *reaction;
  PetscReal       *noted; /* PG_ENERGY_FORCES by disc, NULL without energy accounts */
  PetscReal       *slid;  /* energy taken by sliding, one by `stride` */
  PetscInt         stride;
} Arrays;

typedef struct {
  PetscReal x, y, torque;
} Sum;

/* Contact forces and moments on disc i, in ascending permanent id of the partners. The high disc of a pair
   gets the opposite force. */
static inline Sum ContactSum(const Arrays *a, PetscInt i)
{
  Sum s = {0, 0, 0};

  for (PetscInt k = a->list.ptr[i]; k < a->list.ptr[i + 1]; k++) {
    const PetscInt   entry = a->list.sum[k], is_high = entry & 1;
    const PetscReal *f    = &a->result[4 * (entry >> 1)];
    const PetscReal  sign = is_high ? -1 : 1;

    s.x += sign * f[0];
    s.y += sign * f[1];
    s.torque += f[2 + is_high];
  }
  return s;
}

/* The forces of the walls on disc i, in the order of the walls. */
static void AddWalls(PgDem dem, const Arrays *a, PetscInt i, Sum *s)
{
  for (PetscInt k = PgDemFindWallContact_Private(dem, i); k < dem->wall_contact_count && dem->wall_contact[k].disc == i;
       k++) {
    PetscReal f[3];

    PgDemWallContactForce_Private(dem, &dem->wall_contact[k], a->discs.radius[i], f);
    s->x += f[0];
    s->y += f[1];
    s->torque += f[2];
  }
}

/* Adds what acts on disc i beside its contacts. */
static inline Sum TotalSum(PgDem dem, const Arrays *a, PetscInt i, Sum s)
{
  s.x += a->mass[i] * dem->gravity[0] + a->fluid[2 * i] + a->external[2 * i];
  s.y += a->mass[i] * dem->gravity[1] + a->fluid[2 * i + 1] + a->external[2 * i + 1];
  return s;
}

/* Cundall's local damping -alpha |F| sign(v) and viscous damping -c m v of one degree of freedom, noted at
   noted[0] and noted[3] unless that is NULL. */
static inline PetscReal Damped(PgDem dem, PetscReal force, PetscReal velocity, PetscReal inertia, PetscReal *noted)
{
  const PetscReal sign   = velocity > 0 ? 1 : (velocity < 0 ? -1 : 0);
  const PetscReal local  = dem->local_damping * (force < 0 ? -force : force) * sign;
  const PetscReal global = dem->global_damping * inertia * velocity;

  if (noted) {
    noted[0] = -local;
    noted[3] = -global;
  }
  return force - local - global;
}

/* What the energy accounts need to know about the forces on disc i beside contacts; no damping yet. */
static void NoteForces(const Arrays *a, PetscInt i, PetscReal noted[PG_ENERGY_FORCES])
{
  for (PetscInt c = 0; c < 6; c++) noted[c] = 0;
  noted[6] = a->fluid[2 * i];
  noted[7] = a->fluid[2 * i + 1];
  noted[8] = a->external[2 * i];
  noted[9] = a->external[2 * i + 1];
}

static inline __attribute__((always_inline)) void FreeDisc(PgDem dem, const Arrays *a, PetscInt i, Sum contact,
                                                           PetscReal *noted)
{
  const PetscReal *v = a->discs.velocity, *w = a->discs.spin, *r = a->discs.radius;
  Sum              s = TotalSum(dem, a, i, contact);

  if (noted) NoteForces(a, i, noted);
  if (dem->local_damping > 0 || dem->global_damping > 0) {
    s.x      = Damped(dem, s.x, v[2 * i], a->mass[i], noted);
    s.y      = Damped(dem, s.y, v[2 * i + 1], a->mass[i], noted ? noted + 1 : NULL);
    s.torque = Damped(dem, s.torque, w[i], 0.5 * a->mass[i] * r[i] * r[i], noted ? noted + 2 : NULL);
  }
  a->force[2 * i]     = s.x;
  a->force[2 * i + 1] = s.y;
  a->torque[i]        = s.torque;
}

static void FreeDiscs(PgDem dem, const Arrays *a, PetscInt first, PetscInt end)
{
  if (a->noted)
    for (PetscInt i = first; i < end; i++) FreeDisc(dem, a, i, ContactSum(a, i), &a->noted[PG_ENERGY_FORCES * i]);
  else
    for (PetscInt i = first; i < end; i++) FreeDisc(dem, a, i, ContactSum(a, i), NULL);
}

/* Discs near walls, up to `end`, computed anew over what FreeDiscs() left. *next: the wall contact to begin with, and to go on with. */
static void WallDiscs(PgDem dem, const Arrays *a, PetscInt end, PetscInt *next)
{
  for (; *next < dem->wall_contact_count && dem->wall_contact[*next].disc < end; (*next)++) {
    const PetscInt k = *next, i = dem->wall_contact[k].disc;
    Sum            contact;

    if (k > 0 && dem->wall_contact[k - 1].disc == i) continue;
    contact = ContactSum(a, i);
    AddWalls(dem, a, i, &contact);
    FreeDisc(dem, a, i, contact, a->noted ? &a->noted[PG_ENERGY_FORCES * i] : NULL);
  }
}

/* The disc on a plate, computed anew over what FreeDiscs() left: its reaction, and its slip on the plate at
   (0, side r) from the centre. What is prescribed gets no force. */
static void PlateDisc(PgDem dem, const Arrays *a, PetscInt i, PetscReal dt)
{
  const PgPlate  *p    = &dem->plates[(PetscInt)a->plate[i] - 1];
  const PetscReal side = p->side > 0 ? 1 : -1, r = a->discs.radius[i];
  const PetscReal v = a->discs.velocity[2 * i], w = a->discs.spin[i], before = a->spring[i];
  PetscReal      *noted   = a->noted ? &a->noted[PG_ENERGY_FORCES * i] : NULL;
  Sum             contact = ContactSum(a, i), s;
  PetscReal       cap, trial;

  if (dem->wall_count) AddWalls(dem, a, i, &contact);
  s                      = TotalSum(dem, a, i, contact);
  a->reaction[2 * i]     = side * contact.y;
  a->reaction[2 * i + 1] = side * s.y;
  a->force[2 * i]        = 0;
  a->force[2 * i + 1]    = 0;
  a->torque[i]           = 0;
  if (noted) NoteForces(a, i, noted);
  if (p->hold) return;
  cap          = PgDemPlateFriction_Private(dem, p) * PetscMax(side * s.y, 0);
  trial        = before - dem->parameters.k_s * ((v - side * r * w) * dt);
  a->spring[i] = PgLi2007Clamp(trial, cap);
  if (noted && dem->parameters.k_s > 0)
    a->slid[a->stride * i] += 0.5 * (before + a->spring[i]) * (trial - a->spring[i]) / dem->parameters.k_s;
  s.x += a->spring[i];
  s.torque -= side * r * a->spring[i];
  a->force[2 * i] = Damped(dem, s.x, v, a->mass[i], noted);
  a->torque[i]    = Damped(dem, s.torque, w, 0.5 * a->mass[i] * r * r, noted ? noted + 2 : NULL);
}

PetscErrorCode PgDemGetContacts_Private(PgDem dem, PgContactList *list)
{
  PetscInt lists;

  PetscFunctionBeginUser;
  PetscCall(PgNeighborsGetRevision(dem->neighbors, &lists));
  PetscCheck(lists == dem->lists, PgParticlesComm(dem->particles), PETSC_ERR_ORDER,
             "PgDemRestoreHistory() has not been called for the present contact list");
  PetscCall(PgNeighborsGetContacts(dem->neighbors, list));
  PetscFunctionReturn(0);
}

static PetscErrorCode GetArrays(PgDem dem, Arrays *a)
{
  PetscFunctionBeginUser;
  PetscCall(PgDemGetContacts_Private(dem, &a->list));
  PetscCall(PgDemGetDiscs_Private(dem, &a->discs));
  a->result = dem->pairs.result;
  PetscCall(PgParticlesGetArray(dem->particles, PG_MASS, (PetscReal **)&a->mass));
  PetscCall(PgParticlesGetArray(dem->particles, dem->fluid_force, (PetscReal **)&a->fluid));
  PetscCall(PgParticlesGetArray(dem->particles, dem->external_force, (PetscReal **)&a->external));
  PetscCall(PgParticlesGetArray(dem->particles, dem->plate, (PetscReal **)&a->plate));
  PetscCall(PgParticlesGetArray(dem->particles, dem->force, &a->force));
  PetscCall(PgParticlesGetArray(dem->particles, dem->torque, &a->torque));
  PetscCall(PgParticlesGetArray(dem->particles, dem->plate_spring, &a->spring));
  PetscCall(PgParticlesGetArray(dem->particles, dem->plate_reaction, &a->reaction));
  a->noted = a->slid = NULL;
  if (!dem->energy) PetscFunctionReturn(0);
  PetscCall(PgParticlesGetArray(dem->particles, dem->energy_force, &a->noted));
  PetscCall(PgDemGetFrictionAccount_Private(dem, &a->slid, &a->stride));
  PetscFunctionReturn(0);
}

/* What has been done in a sweep over the discs. */
typedef struct {
  PetscInt disc, wall_contact, plate_disc; /* the next ones */
} Done;

/* Forces on the discs up to `end`, whose pairs are all known, and their half kick. */
static PetscErrorCode Discs(PgDem dem, const Arrays *a, PetscReal dt, PetscReal kick, PetscInt end, Done *done)
{
  PetscFunctionBeginUser;
  FreeDiscs(dem, a, done->disc, end);
  WallDiscs(dem, a, end, &done->wall_contact);
  for (; done->plate_disc < dem->plate_disc_count && dem->plate_disc[done->plate_disc] < end; done->plate_disc++)
    PlateDisc(dem, a, dem->plate_disc[done->plate_disc], dt);
  if (kick != 0) PetscCall(PgDemHalfKick_Private(dem, kick, done->disc, end));
  done->disc = end;
  PetscFunctionReturn(0);
}

/* Springs and results of so many pairs, and their discs, stay in a second-level cache. */
enum { STRETCH = 1024 };

/* Goes through the pairs, and through the discs behind them: pairs of owned discs come in ascending order of the
   smaller local index, so a disc is done with when a pair of two later ones is reached. What a pair has left is still
   in the cache when it is summed, and so is a disc when it gets its kick. Pairs with ghosts, which come last in the
   list, are computed first. No pair reads a disc after its kick. */
static PetscErrorCode Sweep(PgDem dem, const Arrays *a, PetscReal dt, PetscReal kick)
{
  const PgContactList *list = &a->list;
  PgContactLoop *const loop = dem->energy ? dem->law->loop_energy : dem->law->loop;
  const PetscInt       last = list->interior - list->interior % 8;
  Done                 done = {0, 0, 0};
  PetscInt             owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(dem->particles, &owned, NULL, NULL));
  loop(&dem->parameters, list, &a->discs, dt, &dem->pairs, last, list->padded);
  for (PetscInt first = 0; first < last; first += STRETCH) {
    const PetscInt end = PetscMin(first + STRETCH, last);

    loop(&dem->parameters, list, &a->discs, dt, &dem->pairs, first, end);
    if (end < last) PetscCall(Discs(dem, a, dt, kick, PetscMin(list->low[end], list->high[end]), &done));
  }
  PetscCall(Discs(dem, a, dt, kick, owned, &done));
  dem->pairs_computed = PETSC_TRUE;
  PetscCall(PetscLogFlops(85.0 * list->count + 8.0 * owned));
  PetscFunctionReturn(0);
}

static PetscErrorCode Forces(PgDem dem, PetscReal dt, PetscReal kick)
{
  Arrays a;

  PetscFunctionBeginUser;
  PetscCall(GetArrays(dem, &a));
  if (dt == 0) dem->plate_discs_made = -1; /* the start of a run: the case may have assigned plates since */
  PetscCall(PgDemUpdatePlateDiscs_Private(dem));
  if (dem->wall_count) PetscCall(PgDemWallForces_Private(dem, &a.discs, dt));
  PetscCall(Sweep(dem, &a, dt, kick));
  if (dem->energy) PetscCall(PgDemBookWork_Private(dem, 0.5 * dt, PETSC_TRUE)); /* walls still move as they did */
  if (dem->wall_count) PetscCall(PgDemServoWalls_Private(dem, dt));
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemForces(PgDem dem, PetscReal dt)
{
  PetscFunctionBeginUser;
  PetscCall(Forces(dem, dt, 0));
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemForcesKick(PgDem dem, PetscReal dt)
{
  PetscFunctionBeginUser;
  if (dem->energy) { /* the accounts look at the velocities before and after */
    PetscCall(Forces(dem, dt, 0));
    PetscCall(PgDemKick(dem, dt));
  } else {
    PetscCall(PgDemImposePlates_Private(dem));
    PetscCall(Forces(dem, dt, 0.5 * dt));
  }
  PetscFunctionReturn(0);
}
