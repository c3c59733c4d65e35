/* The weakly compressible liquid at rest under gravity.

   Physics   a column of height H on a bottom, periodic along x, or a tank with side walls; its surface is free. It starts
             with the pressure of rest, or (-wcsph_hydrostatic_from_rest) with none: then it falls by as much as it is
             compressed, and rings like a pipe that is closed at one end.
   Exact     p = rho_0 c_0^2 (exp(|g| (H - y)/c_0^2) - 1) for the linear state, rho_0 |g| (H - y) up to |g| H/c_0^2.
   Order     first for the largest error, which is that of the topmost layer. */
#include "liquid.h"

static PetscErrorCode Create(PgLiquid l, PetscOptionItems *PetscOptionsObject)
{
  PetscFunctionBeginUser;
  PetscCall(PgOptionReal(PetscOptionsObject, "-wcsph_hydrostatic_height", "height H of the liquid", "m", PG_POSITIVE,
                         1e6, &l->height, NULL));
  PetscCall(PgOptionBool(PetscOptionsObject, "-wcsph_hydrostatic_tank",
                         "a tank with walls at its sides in place of a periodic column", &l->tank, NULL));
  PetscCall(PgOptionBool(PetscOptionsObject, "-wcsph_hydrostatic_from_rest",
                         "starts without pressure, so that the column falls and rings", &l->from_rest, NULL));
  PetscFunctionReturn(0);
}

/* dp/dy = -rho(p) |g|, integrated for both equations of state: int dp/rho(p) = |g| (H - y). */
static PetscReal Rest(PgLiquid l, const PetscReal x[2])
{
  const PetscReal head = -l->g[1] * (l->height - x[1]), c2 = PetscSqr(l->c_0);
  PgWcsphState    state;

  if (PgWcsphGetState(l->wcsph, &state)) return 0.0;
  if (state == PG_WCSPH_LINEAR) return l->rho_0 * c2 * (PetscExpReal(head / c2) - 1.0);
  /* p = B (s^7 - 1), int_1^s 7 B s^6 ds/(rho_0 s) = c_0^2 (s^6 - 1)/6 */
  return l->rho_0 * c2 / 7.0 * (PetscPowReal(1.0 + 6.0 * head / c2, 7.0 / 6.0) - 1.0);
}

static PetscErrorCode Fill(PgLiquid l)
{
  PgLiquidBlock block = {
      .kind = PG_WCSPH_FLUID, .columns = l->columns, .rows = l->cells, .pressure = l->from_rest ? NULL : Rest};
  PetscInt layers;

  PetscFunctionBeginUser;
  PgInputCheck(l->g[0] == 0.0 && l->g[1] < 0.0, l->comm,
               "option -wcsph_gravity: a liquid at rest needs a gravity downward, not (%g, %g) m/s2", (double)l->g[0],
               (double)l->g[1]);
  PgInputCheck(-l->g[1] * l->height <= 0.1 * PetscSqr(l->c_0), l->comm,
               "option -wcsph_sound_speed: with %g m/s a column of %g m is compressed by %.3g, more than 0.1",
               (double)l->c_0, (double)l->height, (double)(-l->g[1] * l->height / PetscSqr(l->c_0)));
  PetscCall(PgLiquidWallLayers(l, &layers));
  if (!l->tank) PetscCall(PgWcsphSetPeriodicX(l->wcsph, 0.0, l->dx * (PetscReal)l->columns));
  PetscCall(PgLiquidAddBlock(l, &block));
  block.kind   = PG_WCSPH_WALL;
  block.rows   = layers;
  block.low[1] = -l->dx * (PetscReal)layers;
  if (l->tank) {
    block.low[0]  = -l->dx * (PetscReal)layers;
    block.columns = l->columns + 2 * layers;
  }
  PetscCall(PgLiquidAddBlock(l, &block));
  if (!l->tank) PetscFunctionReturn(0);
  block.rows    = l->cells + layers; /* as far above the surface as the kernel reaches */
  block.columns = layers;
  block.low[1]  = 0.0;
  for (int side = 0; side < 2; side++) {
    block.low[0] = side ? l->dx * (PetscReal)l->columns : -l->dx * (PetscReal)layers;
    PetscCall(PgLiquidAddBlock(l, &block));
  }
  PetscFunctionReturn(0);
}

static PetscReal Exact(PgLiquid l, PetscReal t, const PetscReal x[2])
{
  (void)t;
  return Rest(l, x);
}

static PetscReal Scale(PgLiquid l) { return -l->rho_0 * l->g[1] * l->height; }

static PetscReal End(PgLiquid l) { return 80.0 * l->height / l->c_0; } /* twenty periods of sound */

const PgLiquidProblem PgLiquidHydrostatic = {.title       = "a liquid at rest",
                                             .name        = "wcsph_hydrostatic",
                                             .defaults    = "-wcsph_gravity 0,-9.81 -wcsph_sound_speed 40 "
                                                            "-wcsph_viscosity 1 -neighbors_skin 0.5",
                                             .height      = 1.0,
                                             .speed       = 0.0,
                                             .columns     = 16,
                                             .of_pressure = PETSC_TRUE,
                                             .create      = Create,
                                             .fill        = Fill,
                                             .exact       = Exact,
                                             .scale       = Scale,
                                             .end         = End};
