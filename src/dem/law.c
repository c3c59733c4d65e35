/* The registered contact laws. */
#include "demimpl.h"

PgContactForce PgContactLawLi2007(const PgContactParameters *parameters, const PgContactMotion *motion, PetscReal dt,
                                  PgContactHistory *history)
{
  return PgLi2007(parameters, motion, dt, history);
}

const PgContactLaw PgContactLaws[] = {
    {"li2007", "Li, Chu & Sheng, Int. J. Numer. Meth. Engng 72 (2007) 858-882, Eqs. 3-17", PgContactLawLi2007,
     PgDemContactLoopLi2007},
    {NULL, NULL, NULL, NULL},
};
