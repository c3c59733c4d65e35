/* A disc thrown onto a rough horizontal floor.

   Physics: gravity g presses a disc of radius r with N = m g on a fixed wall of friction mu; it starts with speed v0 and
   spin w0, at the overlap m g/k_n of rest.
   Exact, w0 = 0, no rolling resistance: it slides with the deceleration mu g until t = v0/(3 mu g) and rolls with
   v = 2 v0/3 = -r w from then on (I = m r^2/2).
   Exact, rolling from the start (w0 = -v0/r) with the moment arm mu_theta r of Eqs. 5-6 and k_r = 0: deceleration
   2/3 mu_theta g, stop after 3 v0^2/(4 mu_theta g) at t = 3 v0/(2 mu_theta g).
   The springs of the contact swing when sliding turns into rolling: with dashpots c_s, c_theta they die out.
   Expected: with a dashpot friction is at its cap from the first moment on, and constant forces are exact for the
   integrator at any time step; rolling resistance acts after the sliding spring has stretched by 2/3 mu_theta m g/k_s.
   Test: tests/verify/dem_plane.c */
#include "casesimpl.h"

typedef struct {
  PetscReal radius; /* [m] */
  PetscReal speed;  /* v0 [m/s] */
  PetscReal spin;   /* w0 [rad/s] */
} Plane;

static PetscErrorCode Create(MPI_Comm comm, void **context)
{
  Plane *p;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&p));
  *p = (Plane){7e-3, 1, 0};
  PetscCall(PgCaseDefaults("-gravity 0,-9.81 -dem_k_r 0 -dem_mu_theta_r 0 -dem_c_s 8e3 -dem_c_theta 0.1"));
  PetscOptionsBegin(comm, "", "case disc_on_plane: a disc on a floor", "");
  PetscCall(
      PgOptionReal(PetscOptionsObject, "-plane_radius", "radius of the disc", "m", PG_POSITIVE, 1e3, &p->radius, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-plane_speed", "speed at the start", "m/s", -1e3, 1e3, &p->speed, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-plane_spin", "angular velocity at the start; rolling is -speed/radius",
                         "rad/s", -1e9, 1e9, &p->spin, NULL));
  PetscOptionsEnd();
  *context = p;
  PetscFunctionReturn(0);
}

static PetscErrorCode Setup(void *context, PgCaseSetup *setup)
{
  const Plane        *c = (const Plane *)context;
  const PetscReal     g = -setup->gravity[1], m = PgCaseDiscMass(setup, c->radius);
  const PgWall        floor = {.name = "floor", .normal = {0, 1}, .friction = -1};
  PgContactParameters p;
  PgCaseDisc          disc = {{0, c->radius}, {c->speed, 0}, c->spin, c->radius};

  PetscFunctionBeginUser;
  PgInputCheck(g > 0, setup->comm, "case disc_on_plane: -gravity (%g, %g) m/s2 does not point down",
               (double)setup->gravity[0], (double)setup->gravity[1]);
  PetscCall(PgDemGetParameters(setup->dem, &p));
  disc.x[1] -= m * g / p.k_n;
  PetscCall(PgDemAddWall(setup->dem, &floor, &setup->load_wall));
  PetscCall(PgCaseFewDiscs(setup, 1, &disc));
  setup->end_time = 0.2;
  PetscFunctionReturn(0);
}

const PgCaseInfo PgCaseDiscOnPlane = {
    "disc_on_plane", "a disc slides, then rolls on a rough floor", Create, Setup, PgCaseDestroyContext, NULL};
