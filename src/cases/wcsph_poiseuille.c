/* Start of a plane Poiseuille flow of the weakly compressible liquid (Morris, Fox & Zhu 1997).

   Physics   liquid between two plates at rest, y = 0 and y = H; from t = 0 a force g_x per mass drives it along x, which
             is periodic.
   Exact     v = g_x/(2 nu) y (H - y) - sum 4 g_x H^2/(nu pi^3 k^3) sin(k pi y/H) exp(-k^2 pi^2 nu t/H^2), k odd.
   Order     second in the spacing of the particles. */
#include "liquid.h"

static PetscErrorCode Create(PgLiquid l, PetscOptionItems *PetscOptionsObject)
{
  PetscFunctionBeginUser;
  PetscCall(PgOptionReal(PetscOptionsObject, "-wcsph_poiseuille_height", "distance H of the plates", "m", PG_POSITIVE,
                         1e6, &l->height, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode Fill(PgLiquid l)
{
  PetscFunctionBeginUser;
  PgInputCheck(l->g[0] != 0.0 && l->g[1] == 0.0, l->comm,
               "option -wcsph_gravity: a flow between plates needs a force along x alone, not (%g, %g) m/s2",
               (double)l->g[0], (double)l->g[1]);
  PgInputCheck(l->mu > 0.0, l->comm, "option -wcsph_viscosity: a flow between plates needs a viscosity");
  l->speed = PetscAbsReal(l->g[0]) * l->rho_0 * PetscSqr(l->height) / (8.0 * l->mu);
  PetscCall(PgLiquidAddChannel(l, 0.0));
  PetscFunctionReturn(0);
}

static PetscReal Exact(PgLiquid l, PetscReal t, const PetscReal x[2])
{
  const PetscReal H = l->height, rate = l->g[0] * l->rho_0 / l->mu;

  if (t <= 0.0) return 0.0; /* where the series is slow */
  return 0.5 * rate * x[1] * (H - x[1]) -
         4.0 * rate * H * H / (PETSC_PI * PETSC_PI * PETSC_PI) * PgLiquidSeries(l, t, x[1], 2, 3, PETSC_FALSE);
}

static PetscReal Scale(PgLiquid l) { return l->speed; }

static PetscReal End(PgLiquid l) { return 0.1 * PetscSqr(l->height) * l->rho_0 / l->mu; }

const PgLiquidProblem PgLiquidPoiseuille = {.title       = "a liquid driven between plates",
                                            .name        = "wcsph_poiseuille",
                                            .defaults    = "-wcsph_gravity 8e-5,0 -wcsph_sound_speed 0.02 "
                                                           "-neighbors_skin 0.5",
                                            .height      = 0.01,
                                            .speed       = 1e-3,
                                            .columns     = 16,
                                            .of_pressure = PETSC_FALSE,
                                            .create      = Create,
                                            .fill        = Fill,
                                            .exact       = Exact,
                                            .scale       = Scale,
                                            .end         = End};
