/* Walls: what they are, where they are, and how they move. Their contacts are in wall_contacts.c. */
#include "demimpl.h"

static PetscErrorCode CheckWall(PgDem dem, const PgWall *w)
{
  MPI_Comm        comm   = PgParticlesComm(dem->particles);
  const PetscReal all[]  = {w->point[0],    w->point[1], w->normal[0], w->normal[1], w->velocity[0],
                            w->velocity[1], w->friction, w->stress,    w->length,    w->max_velocity};
  const PetscReal length = hypot(w->normal[0], w->normal[1]);
  PetscReal       low, high;
  PetscBool       periodic;

  PetscFunctionBeginUser;
  for (size_t k = 0; k < sizeof(all) / sizeof(*all); k++)
    PgInputCheck(!PetscIsInfOrNanReal(all[k]), comm, "wall %s: a value is not finite", w->name);
  PgInputCheck(PetscAbsReal(length - 1) < 1e-6, comm, "wall %s: its normal (%g, %g) has length %g, not 1", w->name,
               (double)w->normal[0], (double)w->normal[1], (double)length);
  PgInputCheck(w->kind != PG_WALL_SERVO || (w->max_velocity > 0 && w->length >= 0), comm,
               "servo wall %s: needs a max_velocity > 0 (%g m/s) and a length >= 0 (%g m)", w->name,
               (double)w->max_velocity, (double)w->length);
  PetscCall(PgParticlesGetPeriodicX(dem->particles, &periodic, &low, &high));
  PgInputCheck(!periodic || w->normal[0] == 0, comm, "wall %s: a wall must be horizontal where x is periodic", w->name);
  PetscFunctionReturn(0);
}

/* What the given wall becomes: normal of length 1 to rounding, no motion where none is meant. */
static PgWall Tidy(const PgWall *given)
{
  PgWall          w      = *given;
  const PetscReal length = hypot(w.normal[0], w.normal[1]);

  w.normal[0] /= length;
  w.normal[1] /= length;
  if (w.kind == PG_WALL_FIXED) w.velocity[0] = w.velocity[1] = 0;
  return w;
}

static PetscErrorCode NumberServos(PgDem dem)
{
  PetscFunctionBeginUser;
  dem->servo_count = 0;
  for (PetscInt k = 0; k < dem->wall_count; k++)
    dem->walls[k]->servo = dem->walls[k]->wall.kind == PG_WALL_SERVO ? dem->servo_count++ : -1;
  if (dem->servo_count <= dem->servo_room) PetscFunctionReturn(0);
  PetscCall(PetscFree2(dem->servo_sum, dem->servo_value));
  PetscCall(PetscMalloc2(2 * dem->servo_count, &dem->servo_sum, 2 * dem->servo_count, &dem->servo_value));
  dem->servo_room = dem->servo_count;
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemAddWall(PgDem dem, const PgWall *wall, PetscInt *index)
{
  PgDemWall *w;

  PetscFunctionBeginUser;
  PetscCall(CheckWall(dem, wall));
  if (!dem->wall_count)
    PetscCall(PgParticlesRegisterRagged(dem->particles, "wall_history", PG_WALL_RECORD,
                                        PG_FIELD_MIGRATE | PG_FIELD_RESTART, &dem->wall_history));
  if (dem->wall_count == dem->wall_room) {
    dem->wall_room += 4;
    PetscCall(PetscRealloc((size_t)dem->wall_room * sizeof(*dem->walls), &dem->walls));
  }
  PetscCall(PetscNew(&w));
  w->wall     = Tidy(wall);
  w->start[0] = w->wall.point[0];
  w->start[1] = w->wall.point[1];

  dem->walls[dem->wall_count] = w;
  dem->walls_changed          = PETSC_TRUE;
  if (index) *index = dem->wall_count;
  dem->wall_count++;
  PetscCall(NumberServos(dem));
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckIndex(PgDem dem, PetscInt index)
{
  PetscFunctionBeginUser;
  PetscCheck(index >= 0 && index < dem->wall_count, PgParticlesComm(dem->particles), PETSC_ERR_ARG_OUTOFRANGE,
             "no wall %" PetscInt_FMT " among %" PetscInt_FMT, index, dem->wall_count);
  PetscFunctionReturn(0);
}

PetscReal PgDemWallFriction_Private(PgDem dem, const PgWall *wall)
{
  if (wall->friction >= 0) return wall->friction;
  return dem->wall_friction >= 0 ? dem->wall_friction : dem->parameters.mu_s;
}

PetscErrorCode PgDemGetWall(PgDem dem, PetscInt index, PgWall *wall)
{
  PetscFunctionBeginUser;
  PetscCall(CheckIndex(dem, index));
  *wall          = dem->walls[index]->wall;
  wall->friction = PgDemWallFriction_Private(dem, wall);
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemSetWall(PgDem dem, PetscInt index, const PgWall *wall)
{
  PetscFunctionBeginUser;
  PetscCall(CheckIndex(dem, index));
  PetscCall(CheckWall(dem, wall));
  dem->walls[index]->wall = Tidy(wall);
  dem->walls_changed      = PETSC_TRUE;
  PetscCall(NumberServos(dem));
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemGetWallCount(PgDem dem, PetscInt *count)
{
  PetscFunctionBeginUser;
  *count = dem->wall_count;
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemGetWallDisplacement(PgDem dem, PetscInt index, PetscReal *displacement)
{
  const PgDemWall *w;

  PetscFunctionBeginUser;
  PetscCall(CheckIndex(dem, index));
  w             = dem->walls[index];
  *displacement = (w->wall.point[0] - w->start[0]) * w->wall.normal[0] +
                  (w->wall.point[1] - w->start[1]) * w->wall.normal[1];
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemGetWallForce(PgDem dem, PetscInt index, PetscReal force[2])
{
  PgExactSum sum[2] = {{.not_finite = 0}, {.not_finite = 0}};
  PgDemDiscs discs;

  PetscFunctionBeginUser;
  PetscCall(CheckIndex(dem, index));
  PetscCall(PgDemUpdateWallContacts_Private(dem));
  PetscCall(PgDemGetDiscs_Private(dem, &discs));
  for (PetscInt k = 0; k < dem->wall_contact_count; k++) {
    const PgWallContact *c = &dem->wall_contact[k];
    PetscReal            f[3];

    if (c->wall != index) continue;
    PgDemWallContactForce_Private(dem, c, discs.radius[c->disc], f);
    PgExactSumAdd(&sum[0], -f[0]);
    PgExactSumAdd(&sum[1], -f[1]);
  }
  PetscCall(PgExactSumReduce(PgParticlesComm(dem->particles), 2, sum, force));
  PetscFunctionReturn(0);
}

/* ---- motion ---- */

void PgDemMoveWalls_Private(PgDem dem, PetscReal dt)
{
  for (PetscInt k = 0; k < dem->wall_count; k++) {
    PgWall *w = &dem->walls[k]->wall;

    w->point[0] += dt * w->velocity[0];
    w->point[1] += dt * w->velocity[1];
  }
}

/* Distance of the two walls beside this one, at right angles to it and facing each other; else the period of x.
   -1: neither. */
static PetscErrorCode LengthBeside(PgDem dem, const PgWall *servo, PetscReal *length)
{
  const PetscReal t[2]   = {servo->normal[1], -servo->normal[0]};
  PetscInt        before = 0, behind = 0;
  PetscReal       from = 0, to = 0, low, high;
  PetscBool       periodic;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < dem->wall_count; k++) {
    const PgWall   *w      = &dem->walls[k]->wall;
    const PetscReal facing = w->normal[0] * t[0] + w->normal[1] * t[1];
    const PetscReal at     = w->point[0] * t[0] + w->point[1] * t[1];

    if (facing > 1 - 1e-9) {
      from = at;
      before++;
    } else if (facing < -1 + 1e-9) {
      to = at;
      behind++;
    }
  }
  *length = before == 1 && behind == 1 && to > from ? to - from : -1;
  PetscCall(PgParticlesGetPeriodicX(dem->particles, &periodic, &low, &high));
  if (periodic) *length = high - low;
  PetscFunctionReturn(0);
}

static PetscErrorCode ServoVelocity(PgDem dem, PgWall *w, PetscReal force, PetscReal contacts, PetscReal dt)
{
  const PetscReal gain   = dem->servo_gain / (dem->parameters.k_n * PetscMax(contacts, 1) * dt);
  PetscReal       length = w->length, speed;

  PetscFunctionBeginUser;
  if (length == 0) PetscCall(LengthBeside(dem, w, &length));
  PgInputCheck(length > 0, PgParticlesComm(dem->particles),
               "servo wall %s: no two walls beside it give the length that its stress acts on: give one", w->name);
  speed          = PgLi2007Clamp(gain * (w->stress * length - force), w->max_velocity);
  w->velocity[0] = speed * w->normal[0];
  w->velocity[1] = speed * w->normal[1];
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemServoWalls_Private(PgDem dem, PetscReal dt)
{
  PetscFunctionBeginUser;
  if (!dem->servo_count || dt == 0) PetscFunctionReturn(0);
  PetscCall(PetscArrayzero(dem->servo_sum, 2 * dem->servo_count));
  for (PetscInt k = 0; k < dem->wall_contact_count; k++) {
    const PgWallContact *c  = &dem->wall_contact[k];
    const PetscInt       at = dem->walls[c->wall]->servo;

    if (at < 0 || c->force.F_N == 0) continue;
    PgExactSumAdd(&dem->servo_sum[2 * at], -c->force.F_N);
    PgExactSumAdd(&dem->servo_sum[2 * at + 1], 1);
  }
  PetscCall(PgExactSumReduce(PgParticlesComm(dem->particles), 2 * dem->servo_count, dem->servo_sum, dem->servo_value));
  for (PetscInt k = 0; k < dem->wall_count; k++) {
    const PetscInt at = dem->walls[k]->servo;
    if (at >= 0)
      PetscCall(ServoVelocity(dem, &dem->walls[k]->wall, dem->servo_value[2 * at], dem->servo_value[2 * at + 1], dt));
  }
  PetscFunctionReturn(0);
}
