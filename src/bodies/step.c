/* Motion in time, Eqs. 47-50. */
#include "bodiesimpl.h"
#include <math.h>

void PgBodyMoveNodes(PgBody *b)
{
  const PetscReal c = PetscCosReal(b->angle), s = PetscSinReal(b->angle);

  for (PetscInt i = 0; i < b->nodes; i++) {
    const PetscReal X = b->X[2 * i] - b->X_c[0], Y = b->X[2 * i + 1] - b->X_c[1];
    const PetscReal x = c * X - s * Y, y = s * X + c * Y;

    b->x[2 * i]     = b->X_c[0] + b->u_c[0] + x;
    b->x[2 * i + 1] = b->X_c[1] + b->u_c[1] + y;
    b->v[2 * i]     = b->v_c[0] - b->spin * y;
    b->v[2 * i + 1] = b->v_c[1] + b->spin * x;
  }
}

void PgBodyResultant(PgBodies bodies, const PgBody *b, PetscReal force[2], PetscReal *torque)
{
  const PetscReal centre[2] = {b->X_c[0] + b->u_c[0], b->X_c[1] + b->u_c[1]};

  *torque = 0;
  for (int d = 0; d < 2; d++) force[d] = 0;
  for (PetscInt i = 0; i < b->nodes; i++) {
    const PetscReal F[2] = {b->force[2 * i] + b->load[2 * i], b->force[2 * i + 1] + b->load[2 * i + 1]};
    for (int d = 0; d < 2; d++) force[d] += F[d];
    *torque += (b->x[2 * i] - centre[0]) * F[1] - (b->x[2 * i + 1] - centre[1]) * F[0];
  }
  for (int d = 0; d < 2; d++) force[d] += b->mass * bodies->gravity[d];
}

/* Steps of its own that a body takes in one of dt. */
static PetscInt OwnSteps(const PgBody *b, PetscReal dt)
{
  return b->kind == PG_BODY_RIGID ? 1 : PetscMax(1, (PetscInt)PetscCeilReal(dt / (0.9 * b->limit)));
}

/* Acceleration by what acts from outside, without the part that moves the body as it is, which the kicks at the ends of the
   step give: accelerations a - a_c - w x r that neither push nor turn it. */
static void Straining(PgBody *b)
{
  PetscReal push[2] = {0, 0}, centre[2] = {0, 0}, turn = 0, inertia = 0;

  for (PetscInt i = 0; i < 2 * b->nodes; i++) {
    push[i % 2] += (b->force[i] + b->load[i]) / b->mass;
    centre[i % 2] += b->m[i / 2] * b->x[i] / b->mass;
  }
  for (PetscInt i = 0; i < b->nodes; i++) {
    const PetscReal x = b->x[2 * i] - centre[0], y = b->x[2 * i + 1] - centre[1];
    turn += x * (b->force[2 * i + 1] + b->load[2 * i + 1]) - y * (b->force[2 * i] + b->load[2 * i]);
    inertia += b->m[i] * (x * x + y * y);
  }
  for (PetscInt i = 0; i < b->nodes; i++) {
    const PetscReal x = b->x[2 * i] - centre[0], y = b->x[2 * i + 1] - centre[1];
    b->a[2 * i]     = (b->force[2 * i] + b->load[2 * i]) / b->m[i] - push[0] + turn / inertia * y;
    b->a[2 * i + 1] = (b->force[2 * i + 1] + b->load[2 * i + 1]) / b->m[i] - push[1] - turn / inertia * x;
  }
}

/* v += h a of what acts from outside, in a step of dt; damping by its exact factor over h. */
static void KickOutside(PgBodies bodies, PgBody *b, PetscReal h, PetscReal dt)
{
  const PetscReal keep = PetscExpReal(-bodies->damping * h);

  if (b->kind == PG_BODY_RIGID) {
    PetscReal force[2], torque;
    PgBodyResultant(bodies, b, force, &torque);
    for (int d = 0; d < 2; d++) b->v_c[d] = keep * b->v_c[d] + h * force[d] / b->mass;
    b->spin = keep * b->spin + h * torque / b->inertia;
    return;
  }
  if (OwnSteps(b, dt) > 1) Straining(b);
  for (PetscInt i = 0; i < 2 * b->nodes; i++)
    b->v[i] = keep * b->v[i] + h * ((b->force[i] + b->load[i]) / b->m[i / 2] - b->a[i] + bodies->gravity[i % 2]);
}

static void KickInside(PgBody *b, PetscReal h)
{
  for (PetscInt i = 0; i < 2 * b->nodes; i++) b->v[i] += h * (b->f[i] / b->m[i / 2] + b->a[i]);
}

/* Velocity Verlet. Where a step is too long for what is stiff inside, the outside pushes and turns the body at the ends of
   the step, and as many steps inside follow as the bound asks for (Tuckerman, Berne & Martyna 1992). What strains the body
   then acts all through these, as it was at the start of the step: as kicks it would set a stiff body ringing. */
static PetscErrorCode DriftVerlet(PgBody *b, PetscReal dt)
{
  const PetscInt  steps = OwnSteps(b, dt);
  const PetscReal h     = dt / (PetscReal)steps;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(b->way, b->x, 2 * b->nodes));
  if (b->kind == PG_BODY_RIGID) {
    for (int d = 0; d < 2; d++) b->u_c[d] += dt * b->v_c[d];
    b->angle += dt * b->spin;
    PgBodyMoveNodes(b);
  } else {
    for (PetscInt k = 0; k < steps; k++) {
      KickInside(b, 0.5 * h);
      for (PetscInt i = 0; i < 2 * b->nodes; i++) b->x[i] += h * b->v[i];
      PgBodyInternalForces(b);
      KickInside(b, 0.5 * h);
    }
  }
  /* what the liquid takes for their velocity is what takes them there: its density then knows of no other way */
  for (PetscInt i = 0; i < 2 * b->nodes; i++) b->way[i] = (b->x[i] - b->way[i]) / dt;
  PetscFunctionReturn(0);
}

/* Eq. 47; the velocities of t_n are kept for Eq. 50. */
static PetscErrorCode PredictLiteral(PgBody *b, PetscReal dt)
{
  PetscFunctionBeginUser;
  if (b->kind == PG_BODY_RIGID) {
    for (int d = 0; d < 2; d++) {
      b->way_c[d] = b->v_c[d];
      b->v_c[d] += 0.5 * dt * b->a_c[d];
    }
    b->way_angle = b->spin;
    b->spin += 0.5 * dt * b->spin_rate;
    PgBodyMoveNodes(b);
  } else {
    PetscCall(PetscArraycpy(b->way, b->v, 2 * b->nodes));
    for (PetscInt i = 0; i < 2 * b->nodes; i++) b->v[i] += 0.5 * dt * b->a[i];
  }
  PetscFunctionReturn(0);
}

/* Eqs. 48-50: the acceleration at u_n. */
static PetscErrorCode CorrectLiteral(PgBodies bodies, PgBody *b, PetscReal dt)
{
  PetscFunctionBeginUser;
  if (b->kind == PG_BODY_RIGID) {
    PetscReal force[2], torque;
    PgBodyResultant(bodies, b, force, &torque);
    for (int d = 0; d < 2; d++) {
      b->a_c[d] = force[d] / b->mass - bodies->damping * b->v_c[d];
      b->v_c[d] += 0.5 * dt * b->a_c[d];
      b->u_c[d] += dt * b->way_c[d] + 0.5 * dt * dt * b->a_c[d];
    }
    b->spin_rate = torque / b->inertia - bodies->damping * b->spin;
    b->spin += 0.5 * dt * b->spin_rate;
    b->angle += dt * b->way_angle + 0.5 * dt * dt * b->spin_rate;
    PgBodyMoveNodes(b);
    PetscFunctionReturn(0);
  }
  PgBodyInternalForces(b);
  for (PetscInt i = 0; i < 2 * b->nodes; i++) {
    b->a[i] = (b->force[i] + b->load[i] + b->f[i]) / b->m[i / 2] + bodies->gravity[i % 2] - bodies->damping * b->v[i];
    b->v[i] += 0.5 * dt * b->a[i];
    b->x[i] += dt * b->way[i] + 0.5 * dt * dt * b->a[i];
  }
  PgBodyInternalForces(b); /* the energy that PgBodiesGet() tells is that of u_n+1 */
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesKickDrift(PgBodies bodies, PetscReal dt)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < bodies->count; k++) {
    PgBody *b = &bodies->body[k];

    if (bodies->integrator == PG_BODIES_LITERAL) {
      PetscCall(PredictLiteral(b, dt));
    } else {
      KickOutside(bodies, b, 0.5 * dt, dt);
      PetscCall(DriftVerlet(b, dt));
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgBodiesKick(PgBodies bodies, PetscReal dt)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < bodies->count; k++) {
    PgBody *b = &bodies->body[k];

    if (bodies->integrator == PG_BODIES_LITERAL) {
      PetscCall(CorrectLiteral(bodies, b, dt));
    } else {
      KickOutside(bodies, b, 0.5 * dt, dt);
      if (b->kind == PG_BODY_RIGID) PgBodyMoveNodes(b);
    }
    for (PetscInt i = 0; i < 2 * b->nodes; i++)
      if (!isfinite(b->x[i]) || !isfinite(b->v[i]))
        PgRunError(bodies->comm,
                   "body %" PetscInt_FMT ", node %" PetscInt_FMT
                   " at (%g, %g) m, velocity (%g, %g) m/s: not finite; give a smaller -dt",
                   k, i / 2, (double)b->x[i / 2 * 2], (double)b->x[i / 2 * 2 + 1], (double)b->v[i / 2 * 2],
                   (double)b->v[i / 2 * 2 + 1]);
  }
  PetscFunctionReturn(0);
}
