/* Two discs collide head on.

   Physics: the normal spring and dashpot of Eq. 8 between discs of unequal radii, friction not touched; masses m1, m2,
   m' = m1 m2/(m1 + m2), closing speed v. The discs just touch at the start.
   Exact, c_n = 0: contact lasts pi sqrt(m'/k_n), the largest overlap is v sqrt(m'/k_n), restitution 1.
   Exact, c_n > 0, no tension (the law clips it): with beta = c_n/(2 m'), omega^2 = k_n/m' - beta^2 the contact ends when
   k_n u + c_n du/dt = 0, that is at tan(omega t) = -2 beta omega/(omega^2 - beta^2), and the restitution is
   -(du/dt)/v then. (With tension allowed it would be exp(-pi beta/omega) at t = pi/omega.)
   Expected order in the time step: 2 for duration and overlap; 1 for restitution with a dashpot, which works with the
   velocity half a step earlier.  Test: tests/verify/dem_collision.c */
#include "casesimpl.h"

typedef struct {
  PetscReal radius[2]; /* [m] */
  PetscReal speed;     /* of closing [m/s] */
  PetscReal angle;     /* of the line of centres [degrees] */
  PetscReal spin[2];   /* [rad/s] */
} Collision;

static PetscErrorCode Create(MPI_Comm comm, void **context)
{
  Collision *c;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&c));
  *c = (Collision){{4e-3, 6.5e-3}, 1.3, 30, {0, 0}};
  PetscOptionsBegin(comm, "", "case disc_collision: two discs", "");
  PetscCall(PgOptionReals(PetscOptionsObject, "-collision_radius", "radii of the discs", "m", 2, c->radius, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-collision_speed", "speed at which the discs approach each other", "m/s",
                         PG_POSITIVE, 1e3, &c->speed, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-collision_angle", "direction from the first to the second disc",
                         "degrees", -360, 360, &c->angle, NULL));
  PetscCall(PgOptionReals(PetscOptionsObject, "-collision_spin", "angular velocities", "rad/s", 2, c->spin, NULL));
  PetscOptionsEnd();
  PgInputCheck(c->radius[0] > 0 && c->radius[1] > 0, comm, "option -collision_radius: %g, %g m are not both positive",
               (double)c->radius[0], (double)c->radius[1]);
  *context = c;
  PetscFunctionReturn(0);
}

static PetscErrorCode Setup(void *context, PgCaseSetup *setup)
{
  const Collision    *c    = (const Collision *)context;
  const PetscReal     n[2] = {PetscCosReal(c->angle * PETSC_PI / 180), PetscSinReal(c->angle * PETSC_PI / 180)};
  const PetscReal     m1 = PgCaseDiscMass(setup, c->radius[0]), m2 = PgCaseDiscMass(setup, c->radius[1]);
  const PetscReal     apart = c->radius[0] + c->radius[1];
  const PetscReal     v1 = c->speed * m2 / (m1 + m2), v2 = c->speed * m1 / (m1 + m2); /* the centre of mass rests */
  const PgCaseDisc    disc[2] = {{{0, 0}, {v1 * n[0], v1 * n[1]}, c->spin[0], c->radius[0]},
                                 {{apart * n[0], apart * n[1]}, {-v2 * n[0], -v2 * n[1]}, c->spin[1], c->radius[1]}};
  PgContactParameters p;

  PetscFunctionBeginUser;
  PetscCall(PgCaseFewDiscs(setup, 2, disc));
  PetscCall(PgDemGetParameters(setup->dem, &p));
  setup->end_time = 1.5 * PETSC_PI * PetscSqrtReal(m1 * m2 / (m1 + m2) / p.k_n);
  PetscFunctionReturn(0);
}

const PgCaseInfo PgCaseDiscCollision = {"disc_collision",
                                        "two discs collide head on: duration, overlap, restitution",
                                        Create,
                                        Setup,
                                        PgCaseDestroyContext,
                                        NULL};
