/* A disc released on an inclined plane.

   Physics: a wall through the origin, descending towards +x at the angle theta; a disc of radius r starts at rest, at
   the overlap m g cos(theta)/k_n; mu is the friction of the wall, mu_theta = (arm of Eqs. 5-6)/r, k_r = 0.
   Exact, downhill acceleration a and angular acceleration alpha:
     no rolling resistance, tan(theta) <= 3 mu: rolls,  a = 2/3 g sin(theta), alpha = -a/r
     no rolling resistance, tan(theta) > 3 mu:  slips,  a = g (sin(theta) - mu cos(theta)), alpha = -2 mu g cos(theta)/r
     tan(theta) <= mu_theta:                    rests
     mu_theta < tan(theta):                     rolls,  a = 2/3 g (sin(theta) - mu_theta cos(theta)) while it does not slip
   Expected: constant acceleration is exact for the integrator; what is left is the way that loads the springs, m g/k_s
   (dashpots c_s, c_theta make the swing die out): order 1 in 1/sqrt(k_s) for the speed of a slipping disc.
   Test: tests/verify/dem_incline.c */
#include "casesimpl.h"

typedef struct {
  PetscReal radius; /* [m] */
  PetscReal angle;  /* theta [degrees] */
} Incline;

static PetscErrorCode Create(MPI_Comm comm, void **context)
{
  Incline *p;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&p));
  *p = (Incline){7e-3, 20};
  PetscCall(PgCaseDefaults("-gravity 0,-9.81 -dem_k_r 0 -dem_mu_theta_r 0 -dem_c_s 8e3 -dem_c_theta 0.1"));
  PetscOptionsBegin(comm, "", "case disc_on_incline: a disc on a slope", "");
  PetscCall(PgOptionReal(PetscOptionsObject, "-incline_radius", "radius of the disc", "m", PG_POSITIVE, 1e3, &p->radius,
                         NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-incline_angle", "angle of the slope, downward to the right", "degrees",
                         0, 89, &p->angle, NULL));
  PetscOptionsEnd();
  *context = p;
  PetscFunctionReturn(0);
}

static PetscErrorCode Setup(void *context, PgCaseSetup *setup)
{
  const Incline      *c = (const Incline *)context;
  const PetscReal     s = PetscSinReal(c->angle * PETSC_PI / 180), k = PetscCosReal(c->angle * PETSC_PI / 180);
  const PetscReal     pressing = PgCaseDiscMass(setup, c->radius) * -(setup->gravity[0] * s + setup->gravity[1] * k);
  const PgWall        slope    = {.name = "slope", .normal = {s, k}, .friction = -1};
  PgContactParameters p;
  PgCaseDisc          disc = {{0, 0}, {0, 0}, 0, c->radius};

  PetscFunctionBeginUser;
  PgInputCheck(pressing > 0, setup->comm, "case disc_on_incline: -gravity (%g, %g) m/s2 does not press on the slope",
               (double)setup->gravity[0], (double)setup->gravity[1]);
  PetscCall(PgDemGetParameters(setup->dem, &p));
  disc.x[0] = s * (c->radius - pressing / p.k_n);
  disc.x[1] = k * (c->radius - pressing / p.k_n);
  PetscCall(PgDemAddWall(setup->dem, &slope, &setup->load_wall));
  PetscCall(PgCaseFewDiscs(setup, 1, &disc));
  setup->end_time = 0.2;
  PetscFunctionReturn(0);
}

const PgCaseInfo PgCaseDiscOnIncline = {
    "disc_on_incline", "a disc rolls, slips or rests on a slope", Create, Setup, PgCaseDestroyContext, NULL};
