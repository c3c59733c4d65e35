/* Forces and moments on the owned discs: contacts, plates, gravity, water, damping (Eqs. 1, 2). */
#include "demimpl.h"

/* Arrays of one evaluation. */
typedef struct {
  PgContactList    list;
  PgDemDiscs       discs;
  const PetscReal *result; /* by pair */
  const PetscReal *mass, *fluid, *external, *plate;
  PetscReal       *force, *torque, *spring, *reaction;
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

static inline Sum TotalSum(PgDem dem, const Arrays *a, PetscInt i)
{
  Sum s = ContactSum(a, i);

  s.x += a->mass[i] * dem->gravity[0] + a->fluid[2 * i] + a->external[2 * i];
  s.y += a->mass[i] * dem->gravity[1] + a->fluid[2 * i + 1] + a->external[2 * i + 1];
  return s;
}

/* Cundall's local damping -alpha |F| sign(v) and viscous damping -c m v of one degree of freedom. */
static inline PetscReal Damped(PgDem dem, PetscReal force, PetscReal velocity, PetscReal inertia)
{
  const PetscReal sign  = velocity > 0 ? 1 : (velocity < 0 ? -1 : 0);
  const PetscReal local = dem->local_damping * (force < 0 ? -force : force) * sign;

  return force - local - dem->global_damping * inertia * velocity;
}

static void FreeDiscs(PgDem dem, const Arrays *a, PetscInt owned)
{
  const PetscBool  damped = (PetscBool)(dem->local_damping > 0 || dem->global_damping > 0);
  const PetscReal *v = a->discs.velocity, *w = a->discs.spin, *r = a->discs.radius;

  for (PetscInt i = 0; i < owned; i++) {
    Sum s = TotalSum(dem, a, i);

    if (damped) {
      s.x      = Damped(dem, s.x, v[2 * i], a->mass[i]);
      s.y      = Damped(dem, s.y, v[2 * i + 1], a->mass[i]);
      s.torque = Damped(dem, s.torque, w[i], 0.5 * a->mass[i] * r[i] * r[i]);
    }
    a->force[2 * i]     = s.x;
    a->force[2 * i + 1] = s.y;
    a->torque[i]        = s.torque;
  }
}

/* The disc on a plate, computed anew over what FreeDiscs() left: its reaction, and its slip on the plate at
   (0, side r) from the centre. What is prescribed gets no force. */
static void PlateDisc(PgDem dem, const Arrays *a, PetscInt i, PetscReal dt)
{
  const PgPlate  *p    = &dem->plates[(PetscInt)a->plate[i] - 1];
  const PetscReal side = p->side > 0 ? 1 : -1, r = a->discs.radius[i];
  const PetscReal v = a->discs.velocity[2 * i], w = a->discs.spin[i];
  const Sum       contact = ContactSum(a, i);
  Sum             s       = TotalSum(dem, a, i);
  PetscReal       cap;

  a->reaction[2 * i]     = side * contact.y;
  a->reaction[2 * i + 1] = side * s.y;
  a->force[2 * i]        = 0;
  a->force[2 * i + 1]    = 0;
  a->torque[i]           = 0;
  if (p->hold) return;
  cap          = PgDemPlateFriction_Private(dem, p) * PetscMax(side * s.y, 0);
  a->spring[i] = PgLi2007Clamp(a->spring[i] - dem->parameters.k_s * ((v - side * r * w) * dt), cap);
  s.x += a->spring[i];
  s.torque -= side * r * a->spring[i];
  a->force[2 * i] = Damped(dem, s.x, v, a->mass[i]);
  a->torque[i]    = Damped(dem, s.torque, w, 0.5 * a->mass[i] * r * r);
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
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemForces(PgDem dem, PetscReal dt)
{
  Arrays   a;
  PetscInt owned;

  PetscFunctionBeginUser;
  PetscCall(GetArrays(dem, &a));
  if (dt == 0) dem->plate_discs_made = -1; /* the start of a run: the case may have assigned plates since */
  PetscCall(PgDemUpdatePlateDiscs_Private(dem));
  PetscCall(PgParticlesGetSizes(dem->particles, &owned, NULL, NULL));
  dem->law->loop(&dem->parameters, &a.list, &a.discs, dt, &dem->pairs);
  dem->pairs_computed = PETSC_TRUE;
  FreeDiscs(dem, &a, owned);
  for (PetscInt k = 0; k < dem->plate_disc_count; k++) PlateDisc(dem, &a, dem->plate_disc[k], dt);
  PetscCall(PetscLogFlops(85.0 * a.list.count + 8.0 * owned));
  PetscFunctionReturn(0);
}
