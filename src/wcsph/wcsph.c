/* The object: life, settings, what it shows. */
#include "wcsphimpl.h"
#include <math.h>

static PetscErrorCode RegisterFields(PgWcsph w)
{
  const unsigned kept = PG_FIELD_MIGRATE | PG_FIELD_HALO | PG_FIELD_OUTPUT | PG_FIELD_RESTART;
  const struct {
    PgFieldInfo info;
    PgField    *field;
  } table[] = {
      {{"kind", 1, "1", "0 liquid, 1 wall, 2 body", kept}, &w->kind},
      {{"body", 1, "1", "number of the wall or body that the particle belongs to", kept}, &w->body},
      {{"body_index", 1, "1", "number of the particle within its body", PG_FIELD_MIGRATE | PG_FIELD_RESTART},
       &w->index},
      {{"density", 1, "kg/m3", "density of the liquid", kept}, &w->rho},
      {{"pressure", 1, "Pa", "pressure of the liquid; at walls and bodies that of the liquid around", kept}, &w->p},
      {{"force", 2, "N/m", "force of all other particles on the particle",
        PG_FIELD_MIGRATE | PG_FIELD_OUTPUT | PG_FIELD_RESTART},
       &w->force},
      {{"slip_velocity", 2, "m/s", "velocity of a wall or body in the viscous term", PG_FIELD_HALO}, &w->slip_velocity},
      {{"solid_rate", 1, "m2/s", "rate of volume of a wall or body particle over the sum of W", PG_FIELD_HALO},
       &w->solid_rate},
      {{"contact_pressure", 1, "Pa", "pressure by which walls and bodies repel each other", PG_FIELD_HALO},
       &w->contact_pressure},
  };

  PetscFunctionBeginUser;
  for (size_t i = 0; i < sizeof table / sizeof *table; i++)
    PetscCall(PgParticlesRegisterField(w->particles, &table[i].info, table[i].field));
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphCreate(MPI_Comm comm, PgWcsph *wcsph)
{
  PgWcsph w;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&w));
  w->comm      = comm;
  w->smoothing = 1.2;
  w->rho_0     = 1000.0;
  w->mu        = 1e-3;
  w->c_0       = 1.0;
  w->delta     = 0.1;
  w->contact   = 1.0;
  w->density   = PG_WCSPH_CONTINUITY;
  w->state     = PG_WCSPH_LINEAR;
  w->solid     = PG_WCSPH_MIRROR;
  w->slip      = PG_WCSPH_NO_SLIP;
  w->built     = -1;
  PetscCall(PgKernelFind("quintic_spline", &w->kernel));
  PetscCall(PgParticlesCreate(comm, &w->particles));
  PetscCall(PgNeighborsCreate(w->particles, &w->neighbors));
  PetscCall(RegisterFields(w));
  *wcsph = w;
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphDestroy(PgWcsph *wcsph)
{
  PgWcsph w = *wcsph;

  PetscFunctionBeginUser;
  if (!w) PetscFunctionReturn(0);
  PetscCall(PgWcsphDestroyParticles(w));
  PetscCall(PetscFree(w->slope));
  PetscCall(PetscFree(w->weight));
  PetscCall(PetscFree(w->pair));
  PetscCall(PetscFree(w->rate));
  PetscCall(PetscFree3(w->local, w->body_of, w->index_of));
  PetscCall(PetscFree2(w->body_x, w->body_v));
  PetscCall(PetscFree5(w->solid_body, w->solid_index, w->solid_x, w->solid_force, w->solid_p));
  PetscCall(PgNeighborsDestroy(&w->neighbors));
  PetscCall(PgParticlesDestroy(&w->particles));
  PetscCall(PetscFree(*wcsph));
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphGetArrays(PgWcsph w, PgWcsphArrays *f)
{
  PetscReal *m, *kind, *body, *index;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(w->particles, &f->owned, &f->ghosts, NULL));
  PetscCall(PgParticlesGetArray(w->particles, PG_POSITION, &f->x));
  PetscCall(PgParticlesGetArray(w->particles, PG_VELOCITY, &f->v));
  PetscCall(PgParticlesGetArray(w->particles, PG_MASS, &m));
  PetscCall(PgParticlesGetArray(w->particles, w->kind, &kind));
  PetscCall(PgParticlesGetArray(w->particles, w->body, &body));
  PetscCall(PgParticlesGetArray(w->particles, w->index, &index));
  PetscCall(PgParticlesGetArray(w->particles, w->rho, &f->rho));
  PetscCall(PgParticlesGetArray(w->particles, w->p, &f->p));
  PetscCall(PgParticlesGetArray(w->particles, w->force, &f->force));
  PetscCall(PgParticlesGetArray(w->particles, w->slip_velocity, &f->slip_velocity));
  PetscCall(PgParticlesGetArray(w->particles, w->contact_pressure, &f->contact_pressure));
  PetscCall(PgParticlesGetArray(w->particles, w->solid_rate, &f->solid_rate));
  f->m     = m;
  f->kind  = kind;
  f->body  = body;
  f->index = index;
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphGetParticles(PgWcsph w, PgParticles *particles)
{
  PetscFunctionBeginUser;
  *particles = w->particles;
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphGetTime(PgWcsph w, PetscInt *step, PetscReal *time)
{
  PetscFunctionBeginUser;
  if (step) *step = w->step;
  if (time) *time = w->time;
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphGetLiquid(PgWcsph w, PetscReal *rho_0, PetscReal *mu, PetscReal *c_0, PetscReal gravity[2])
{
  PetscFunctionBeginUser;
  if (rho_0) *rho_0 = w->rho_0;
  if (mu) *mu = w->mu;
  if (c_0) *c_0 = w->c_0;
  if (gravity) PetscCall(PetscArraycpy(gravity, w->gravity, 2));
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphGetState(PgWcsph w, PgWcsphState *state)
{
  PetscFunctionBeginUser;
  *state = w->state;
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphGetReach(PgWcsph w, PetscReal *reach)
{
  PetscFunctionBeginUser;
  *reach = w->kernel->support * w->smoothing * w->dx;
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphGetEdge(PgWcsph w, PetscReal *epsilon)
{
  const PetscInt reach = (PetscInt)PetscCeilReal(w->kernel->support * w->smoothing);

  PetscFunctionBeginUser;
  *epsilon = 0.0;
  for (PetscInt m = 1; m <= reach; m++)
    for (PetscInt n = 1; n <= reach; n++) {
      const PetscReal r = PetscSqrtReal((PetscReal)(m * m + n * n)), h = w->smoothing;
      *epsilon -= 2.0 * (PetscReal)(m * m * n) * w->kernel->dw(r / h) / (h * h * h * r);
    }
  *epsilon *= w->dx;
  PetscFunctionReturn(0);
}

/* ---- settings ---- */

static PetscErrorCode BeforeSetUp(PgWcsph w)
{
  PetscFunctionBeginUser;
  PetscCheck(!w->set_up, w->comm, PETSC_ERR_ORDER, "settings of the liquid come before PgWcsphSetUp()");
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphSetSpacing(PgWcsph w, PetscReal dx)
{
  PetscFunctionBeginUser;
  PetscCall(BeforeSetUp(w));
  PgInputCheck(isfinite(dx) && dx > 0.0, w->comm, "the spacing of particles is %g m, it must be positive", (double)dx);
  PetscCheck(!w->added, w->comm, PETSC_ERR_ORDER, "the spacing comes before the particles");
  w->dx = dx;
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphSetPeriodicX(PgWcsph w, PetscReal low, PetscReal high)
{
  PetscFunctionBeginUser;
  PetscCall(BeforeSetUp(w));
  PetscCall(PgParticlesSetPeriodicX(w->particles, low, high));
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphSetLiquid(PgWcsph w, PetscReal rho_0, PetscReal mu, PetscReal c_0)
{
  PetscFunctionBeginUser;
  PetscCall(BeforeSetUp(w));
  PgInputCheck(isfinite(rho_0) && rho_0 > 0.0, w->comm, "the density of the liquid is %g kg/m3, it must be > 0",
               (double)rho_0);
  PgInputCheck(isfinite(mu) && mu >= 0.0, w->comm, "the viscosity of the liquid is %g Pa s, it must be >= 0",
               (double)mu);
  PgInputCheck(isfinite(c_0) && c_0 > 0.0, w->comm, "the speed of sound in the liquid is %g m/s, it must be > 0",
               (double)c_0);
  w->rho_0 = rho_0;
  w->mu    = mu;
  w->c_0   = c_0;
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphSetGravity(PgWcsph w, const PetscReal gravity[2])
{
  PetscFunctionBeginUser;
  PetscCall(BeforeSetUp(w));
  w->gravity[0] = gravity[0];
  w->gravity[1] = gravity[1];
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphSetDensity(PgWcsph w, PgWcsphDensity density)
{
  PetscFunctionBeginUser;
  PetscCall(BeforeSetUp(w));
  w->density = density;
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphSetState(PgWcsph w, PgWcsphState state)
{
  PetscFunctionBeginUser;
  PetscCall(BeforeSetUp(w));
  w->state = state;
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphSetSolid(PgWcsph w, PgWcsphSolid solid)
{
  PetscFunctionBeginUser;
  PetscCall(BeforeSetUp(w));
  w->solid = solid;
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphSetSlip(PgWcsph w, PgWcsphSlip slip)
{
  PetscFunctionBeginUser;
  PetscCall(BeforeSetUp(w));
  w->slip = slip;
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphSetKernel(PgWcsph w, const char name[], PetscReal smoothing)
{
  const PgKernel *kernel;

  PetscFunctionBeginUser;
  PetscCall(BeforeSetUp(w));
  PetscCall(PgKernelFind(name, &kernel));
  PgInputCheck(kernel, w->comm, "kernel '%s' is not known; known are cubic_spline and quintic_spline", name);
  PgInputCheck(isfinite(smoothing) && smoothing >= 0.8 && smoothing <= 4.0, w->comm,
               "the smoothing length is %g spacings of particles, it must be between 0.8 and 4", (double)smoothing);
  w->kernel    = kernel;
  w->smoothing = smoothing;
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphSetDiffusion(PgWcsph w, PetscReal delta)
{
  PetscFunctionBeginUser;
  PetscCall(BeforeSetUp(w));
  PgInputCheck(isfinite(delta) && delta >= 0.0 && delta <= 1.0, w->comm,
               "the diffusion of density is %g, it must be between 0 and 1", (double)delta);
  w->delta = delta;
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphSetContact(PgWcsph w, PetscReal stiffness, PetscBool friction)
{
  PetscFunctionBeginUser;
  PetscCall(BeforeSetUp(w));
  PgInputCheck(isfinite(stiffness) && stiffness >= 0.0, w->comm,
               "the stiffness of solids that meet is %g rho_0 c_0^2, it must be >= 0", (double)stiffness);
  w->contact  = stiffness;
  w->friction = friction;
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphSetDamping(PgWcsph w, PetscReal rate, PetscReal end)
{
  PetscFunctionBeginUser;
  PgInputCheck(isfinite(rate) && rate >= 0.0, w->comm, "the damping of the liquid is %g 1/s, it must be >= 0",
               (double)rate);
  w->damping  = rate;
  w->damp_end = end;
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphSetMotion(PgWcsph w, PgWcsphMotion motion, void *context)
{
  PetscFunctionBeginUser;
  w->motion         = motion;
  w->motion_context = context;
  PetscFunctionReturn(0);
}
