/* The material: what it must be, and what follows from it. */
#include "femimpl.h"
#include <math.h>

void PgFemMaterialDefault(PgFemMaterial *material)
{
  *material = (PgFemMaterial){.E     = 1e7,
                              .nu    = 0.2,
                              .alpha = 1.0,
                              .K_s   = 1e14,
                              .K_f   = 1e14,
                              .n     = 0.3,
                              .k     = 1e-12,
                              .mu_f  = 1e-3,
                              .rho_s = 2000.0,
                              .rho_f = 1000.0};
}

PetscReal PgFemShearModulus(const PgFemMaterial *m) { return 0.5 * m->E / (1.0 + m->nu); }

PetscReal PgFemConstrainedModulus(const PgFemMaterial *m)
{
  return m->E * (1.0 - m->nu) / ((1.0 + m->nu) * (1.0 - 2.0 * m->nu));
}

PetscReal PgFemStorage(const PgFemMaterial *m) { return (m->alpha - m->n) / m->K_s + m->n / m->K_f; }

PetscReal PgFemConsolidation(const PgFemMaterial *m)
{
  return m->k / m->mu_f / (PgFemStorage(m) + m->alpha * m->alpha / PgFemConstrainedModulus(m));
}

PetscErrorCode PgFemMaterialCheck(MPI_Comm comm, const char where[], const PgFemMaterial *m)
{
  const struct {
    const char *name, *unit;
    PetscReal   value;
  } positive[] = {{"Young's modulus", "Pa", m->E},
                  {"bulk modulus of the grains", "Pa", m->K_s},
                  {"bulk modulus of the water", "Pa", m->K_f},
                  {"viscosity", "Pa s", m->mu_f},
                  {"density of the grains", "kg/m3", m->rho_s},
                  {"density of the water", "kg/m3", m->rho_f}};

  PetscFunctionBeginUser;
  for (size_t i = 0; i < sizeof positive / sizeof *positive; i++)
    PgInputCheck(positive[i].value > 0.0 && isfinite(positive[i].value), comm, "%s: the %s is %g %s, it must be > 0",
                 where, positive[i].name, (double)positive[i].value, positive[i].unit);
  PgInputCheck(m->nu > -1.0 && m->nu < 0.5, comm,
               "%s: Poisson's ratio is %g, it must be > -1 and < 0.5 (it is that of the drained skeleton: water that "
               "cannot leave makes the mixture incompressible by itself)",
               where, (double)m->nu);
  PgInputCheck(m->n > 0.0 && m->n < 1.0, comm, "%s: the porosity is %g, it must be > 0 and < 1", where, (double)m->n);
  PgInputCheck(m->alpha >= m->n && m->alpha <= 1.0, comm,
               "%s: Biot's constant is %g, it must be between the porosity %g and 1", where, (double)m->alpha,
               (double)m->n);
  PgInputCheck(m->k >= 0.0 && isfinite(m->k), comm, "%s: the permeability is %g m2, it must be >= 0", where,
               (double)m->k);
  PetscFunctionReturn(0);
}
