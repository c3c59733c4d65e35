/* The registered contact laws. */
#include "demimpl.h"

PgContactForce PgContactLawLi2007(const PgContactParameters *parameters, const PgContactMotion *motion, PetscReal dt,
                                  PgContactHistory *history)
{
  return PgLi2007(parameters, motion, dt, history, NULL);
}

static PgContactForce PairLi2007(const PgContactParameters *parameters, const PgContactMotion *motion, PetscReal dt,
                                 PgContactHistory *history, PetscReal lost[])
{
  return PgLi2007(parameters, motion, dt, history, lost);
}

const PgContactLaw PgContactLaws[] = {
    {"li2007", "Li, Chu & Sheng, Int. J. Numer. Meth. Engng 72 (2007) 858-882, Eqs. 3-17", PairLi2007,
     PgDemContactLoopLi2007, PgDemContactLoopEnergyLi2007},
    {NULL, NULL, NULL, NULL, NULL},
};
