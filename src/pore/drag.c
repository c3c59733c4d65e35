/* Drag laws, Eqs. 20-23, and the permeability that goes with them, Eq. 66. */
#include "poreimpl.h"

/* Ergun below n = 0.8, Wen and Yu above. */
static PetscReal ErgunWenYu(PetscReal n, PetscReal d, PetscReal speed, PetscReal rho_f, PetscReal mu)
{
  PetscReal re, c_d_speed;

  if (n <= 0.8) {
    const PetscReal a = (1.0 - n) / (n * d); /* 150 mu a^2 + 1.75 rho_f |v - u| a */
    return a * ((150.0 * mu) * a + (1.75 * rho_f) * speed);
  }
  re = speed * rho_f * n * d / mu;
  /* C_D |v - u| stays finite at rest, where C_D alone does not */
  if (re < 1000.0)
    c_d_speed = 24.0 * (1.0 + 0.15 * PetscPowReal(re, 0.687)) * mu / (rho_f * n * d);
  else
    c_d_speed = 0.43 * speed;
  return 0.75 * c_d_speed * rho_f * (1.0 - n) / d * PetscPowReal(n, -2.65);
}

/* The part of Ergun's law that is linear in the velocity: what Darcy's law with Eq. 66 stands for. */
static PetscReal Linear(PetscReal n, PetscReal d, PetscReal speed, PetscReal rho_f, PetscReal mu)
{
  (void)speed;
  (void)rho_f;
  return 150.0 * (1.0 - n) * (1.0 - n) / (n * n) * mu / (d * d);
}

static const PgDragLaw laws[] = {
    {"ergun_wen_yu", "Tsuji, Kawaguchi & Tanaka (1993); Li, Chu & Sheng (2007), Eqs. 20-23", ErgunWenYu},
    {"linear", "Li, Chu & Sheng (2007), Eqs. 65, 66", Linear},
};

PetscErrorCode PgDragLawFind(const char name[], const PgDragLaw **law)
{
  PetscFunctionBeginUser;
  *law = NULL;
  for (size_t i = 0; i < sizeof laws / sizeof *laws; i++) {
    PetscBool same;
    PetscCall(PetscStrcmp(name, laws[i].name, &same));
    if (same) *law = &laws[i];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgDragForce(PgPore pore, const PgPoreArrays *s, const PetscReal u[], PetscReal F[])
{
  const PetscBool ergun = (PetscBool)(pore->drag_law->beta == ErgunWenYu);

  PetscFunctionBeginUser;
  if (ergun) PgErgunLoop(s->owned, 150.0 * pore->mu, 1.75 * pore->rho_f, s, u, F);
  for (PetscInt a = 0; a < s->owned; a++) {
    PetscReal rx, ry, beta;

    if (ergun && s->n[a] <= 0.8) continue;
    rx           = s->v[2 * a] - u[2 * a];
    ry           = s->v[2 * a + 1] - u[2 * a + 1];
    beta         = s->detached[a] != 0.0 ? 0.0
                                         : pore->drag_law->beta(s->n[a], 2.0 * s->radius[a], PetscSqrtReal(rx * rx + ry * ry),
                                                                pore->rho_f, pore->mu);
    F[2 * a]     = beta * rx;
    F[2 * a + 1] = beta * ry;
  }
  PetscFunctionReturn(0);
}
