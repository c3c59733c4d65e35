/* The contact laws of Tak, Park & Park (2013), Eqs. 15-18, and their loops over all pairs. No rolling resistance; a moment
   comes from the tangential force alone. */
#include "demimpl.h"

static PetscReal Clamp(PetscReal value, PetscReal cap) { return PgLi2007Clamp(value, cap); }

/* Eqs. 16, 17 without bond: spring and dashpot, capped by friction, the spring not wound up beyond the cap. */
static PetscReal Friction(const PgContactParameters *p, const PgContactMotion *m, PetscReal dt, PetscReal N,
                          PgContactHistory *h)
{
  const PetscReal viscous = -p->c_s * m->sliding_rate, trial = h->f_s - p->k_s * (m->sliding_rate * dt);
  const PetscReal capped = Clamp(trial + viscous, p->mu_s * N);

  h->f_s = capped == trial + viscous ? trial : capped - viscous;
  if (p->k_s <= 0) h->f_s = 0; /* nothing is left in a spring that is not there */
  return capped;
}

/* Without bond: never tensile, nothing remembered after the contact. */
static PgContactForce Free(const PgContactParameters *p, const PgContactMotion *m, PetscReal pressing, PetscReal dt,
                           PgContactHistory *h)
{
  PgContactForce f = {0, 0, 0};

  if (m->overlap <= 0) {
    h->f_s = 0;
    return f;
  }
  f.F_N = PetscMin(pressing, 0.0);
  f.F_T = Friction(p, m, dt, -f.F_N, h);
  return f;
}

PgContactForce PgContactLawTak2013(const PgContactParameters *p, const PgContactMotion *m, PetscReal dt,
                                   PgContactHistory *h)
{
  const PetscReal normal     = -(p->k_n * m->overlap) - p->c_n * m->overlap_rate; /* Eq. 15; > 0: tension */
  const PetscReal sliding    = h->f_s - p->k_s * (m->sliding_rate * dt);
  const PetscReal tangential = sliding - p->c_s * m->sliding_rate; /* Eq. 16 */
  const PetscBool bonds      = (PetscBool)(p->R_n > 0 || p->R_t > 0);

  if (h->f_r == 0 && dt == 0 && bonds && m->overlap > -p->bond_range) h->f_r = 1;
  if (h->f_r == 0 && m->overlap > 0) h->f_r = -1;
  if (h->f_r > 0 && (normal > p->R_n || PetscAbsReal(tangential) > p->R_t)) h->f_r = -1;
  if (h->f_r > 0) {
    h->f_s = sliding;
    return (PgContactForce){normal, tangential, 0};
  }
  return Free(p, m, normal, dt, h);
}

PetscReal PgContactStiffnessTak2013(const PgContactParameters *p, PetscReal overlap, PetscReal R)
{
  (void)overlap;
  (void)R;
  return p->k_n;
}

PgContactForce PgContactLawHertz(const PgContactParameters *p, const PgContactMotion *m, PetscReal dt,
                                 PgContactHistory *h)
{
  const PetscReal u = PetscMax(m->overlap, 0.0), modulus = p->E / (2 * (1 - p->nu * p->nu));
  const PetscReal spring = 4.0 / 3.0 * modulus * u * PetscSqrtReal(m->R * u); /* Eq. 18 */

  return Free(p, m, -spring - p->c_n * m->overlap_rate, dt, h);
}

PetscReal PgContactStiffnessHertz(const PgContactParameters *p, PetscReal overlap, PetscReal R)
{
  return p->E / (1 - p->nu * p->nu) * PetscSqrtReal(R * PetscMax(overlap, 0.0));
}

typedef PgContactForce PgLaw(const PgContactParameters *, const PgContactMotion *, PetscReal, PgContactHistory *);

static inline __attribute__((always_inline)) void Loop(PgLaw *law, const PgContactParameters *parameters,
                                                       const PgContactList *list, const PgDemDiscs *d, PetscReal dt,
                                                       const PgDemPairs *pairs, PetscInt first, PetscInt end)
{
  for (PetscInt k = first; k < end; k++) {
    const PetscInt   a = list->low[k], j = list->high[k];
    const PetscReal  r_a = d->radius[a], r_j = d->radius[j], spin = r_a * d->spin[a] + r_j * d->spin[j];
    const PetscReal  ux = d->velocity[2 * a] - d->velocity[2 * j];
    const PetscReal  uy = d->velocity[2 * a + 1] - d->velocity[2 * j + 1];
    PetscReal        n[2];
    PgContactMotion  m = {.overlap = PgDemPairGeometry(d, a, j, n), .R = r_a * r_j / (r_a + r_j)};
    PgContactHistory h = {pairs->f_s[k], pairs->f_r[k], pairs->m_r[k]};
    PgContactForce   f;

    m.overlap_rate           = ux * n[0] + uy * n[1];
    m.sliding_rate           = (uy * n[0] - ux * n[1]) + spin;
    m.rolling_rate           = -spin;
    m.spin_rate              = d->spin[a] - d->spin[j];
    f                        = law(parameters, &m, dt, &h);
    pairs->f_s[k]            = h.f_s;
    pairs->f_r[k]            = h.f_r;
    pairs->m_r[k]            = h.m_r;
    pairs->result[4 * k]     = f.F_N * n[0] - f.F_T * n[1];
    pairs->result[4 * k + 1] = f.F_N * n[1] + f.F_T * n[0];
    pairs->result[4 * k + 2] = r_a * f.F_T;
    pairs->result[4 * k + 3] = r_j * f.F_T;
  }
}

void PgDemContactLoopTak2013(const PgContactParameters *parameters, const PgContactList *list, const PgDemDiscs *discs,
                             PetscReal dt, const PgDemPairs *pairs, PetscInt first, PetscInt end)
{
  Loop(PgContactLawTak2013, parameters, list, discs, dt, pairs, first, end);
}

void PgDemContactLoopHertz(const PgContactParameters *parameters, const PgContactList *list, const PgDemDiscs *discs,
                           PetscReal dt, const PgDemPairs *pairs, PetscInt first, PetscInt end)
{
  Loop(PgContactLawHertz, parameters, list, discs, dt, pairs, first, end);
}
