/* Equations of state (T63): linear p = c_0^2 (rho - rho_0), and Tait's. */
#include "wcsphimpl.h"

static const PetscReal gamma_tait = 7.0;

PetscReal PgWcsphPressure(const struct PgWcsph_s *w, PetscReal rho)
{
  if (w->state == PG_WCSPH_LINEAR) return w->c_0 * w->c_0 * (rho - w->rho_0);
  return w->rho_0 * w->c_0 * w->c_0 / gamma_tait * (PetscPowReal(rho / w->rho_0, gamma_tait) - 1.0);
}

PetscReal PgWcsphDensityAt(const struct PgWcsph_s *w, PetscReal p)
{
  const PetscReal K = w->rho_0 * w->c_0 * w->c_0;

  if (w->state == PG_WCSPH_LINEAR) return w->rho_0 * (1.0 + p / K);
  return w->rho_0 * PetscPowReal(PetscMax(0.0, 1.0 + gamma_tait * p / K), 1.0 / gamma_tait);
}

PetscReal PgWcsphSound2(const struct PgWcsph_s *w, PetscReal rho)
{
  const PetscReal c2 = w->c_0 * w->c_0;

  return w->state == PG_WCSPH_LINEAR ? c2 : c2 * PetscPowReal(rho / w->rho_0, gamma_tait - 1.0);
}

/* int p/rho^2 d rho from rho_0. */
PetscReal PgWcsphEnergy(const struct PgWcsph_s *w, PetscReal rho)
{
  const PetscReal c2 = w->c_0 * w->c_0, s = rho / w->rho_0;

  if (w->state == PG_WCSPH_LINEAR) return c2 * (PetscLogReal(s) + 1.0 / s - 1.0);
  return c2 / gamma_tait * ((PetscPowReal(s, gamma_tait - 1.0) - 1.0) / (gamma_tait - 1.0) + 1.0 / s - 1.0);
}
