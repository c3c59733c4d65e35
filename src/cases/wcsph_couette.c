/* Start of a plane Couette flow of the weakly compressible liquid (Morris, Fox & Zhu 1997).

   Physics   liquid between two plates; the lower one, y = 0, is at rest, the upper one, y = H, moves along x with the
             speed U from t = 0; x is periodic.
   Exact     v = U y/H + sum 2 U/(k pi) (-1)^k sin(k pi y/H) exp(-k^2 pi^2 nu t/H^2).
   Order     second in the spacing of the particles at the start, when the error is that of the layer at the plate; less
             when the flow is steady and the error small. */
#include "liquid.h"

static PetscErrorCode Create(PgLiquid l, PetscOptionItems *PetscOptionsObject)
{
  PetscFunctionBeginUser;
  PetscCall(PgOptionReal(PetscOptionsObject, "-wcsph_couette_height", "distance H of the plates", "m", PG_POSITIVE, 1e6,
                         &l->height, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-wcsph_couette_speed", "speed U of the upper plate", "m/s", -1e6, 1e6,
                         &l->speed, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode Fill(PgLiquid l)
{
  PetscFunctionBeginUser;
  PgInputCheck(l->g[0] == 0.0 && l->g[1] == 0.0, l->comm,
               "option -wcsph_gravity: the flow under a moving plate has no other force, not (%g, %g) m/s2",
               (double)l->g[0], (double)l->g[1]);
  PgInputCheck(l->mu > 0.0, l->comm, "option -wcsph_viscosity: a flow under a moving plate needs a viscosity");
  PgInputCheck(l->speed != 0.0, l->comm, "option -wcsph_couette_speed: the plate must move");
  PetscCall(PgLiquidAddChannel(l, l->speed));
  PetscFunctionReturn(0);
}

static PetscReal Exact(PgLiquid l, PetscReal t, const PetscReal x[2])
{
  if (t <= 0.0) return 0.0; /* where the series is slow */
  return l->speed * (x[1] / l->height - 2.0 / PETSC_PI * PgLiquidSeries(l, t, x[1], 1, 1, PETSC_TRUE));
}

static PetscReal Scale(PgLiquid l) { return PetscAbsReal(l->speed); }

static PetscReal End(PgLiquid l) { return 0.1 * PetscSqr(l->height) * l->rho_0 / l->mu; }

const PgLiquidProblem PgLiquidCouette = {.title       = "a liquid under a moving plate",
                                         .name        = "wcsph_couette",
                                         .defaults    = "-wcsph_sound_speed 0.02 -neighbors_skin 0.5",
                                         .height      = 0.01,
                                         .speed       = 1e-3,
                                         .columns     = 16,
                                         .of_pressure = PETSC_FALSE,
                                         .create      = Create,
                                         .fill        = Fill,
                                         .exact       = Exact,
                                         .scale       = Scale,
                                         .end         = End};
