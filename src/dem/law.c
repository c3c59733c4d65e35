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

static PgContactForce PairTak2013(const PgContactParameters *parameters, const PgContactMotion *motion, PetscReal dt,
                                  PgContactHistory *history, PetscReal lost[])
{
  (void)lost;
  return PgContactLawTak2013(parameters, motion, dt, history);
}

static PgContactForce PairHertz(const PgContactParameters *parameters, const PgContactMotion *motion, PetscReal dt,
                                PgContactHistory *history, PetscReal lost[])
{
  (void)lost;
  return PgContactLawHertz(parameters, motion, dt, history);
}

const PgContactLaw PgContactLaws[] = {
    {"li2007", "Li, Chu & Sheng, Int. J. Numer. Meth. Engng 72 (2007) 858-882, Eqs. 3-17", PairLi2007,
     PgDemContactLoopLi2007, PgDemContactLoopEnergyLi2007, NULL},
    {"tak2013", "Tak, Park & Park, J. Eng. Mater. Technol. 135 (2013) 021013, Eqs. 15-17", PairTak2013,
     PgDemContactLoopTak2013, NULL, PgContactStiffnessTak2013},
    {"hertz", "Tak, Park & Park, J. Eng. Mater. Technol. 135 (2013) 021013, Eqs. 16-18", PairHertz,
     PgDemContactLoopHertz, NULL, PgContactStiffnessHertz},
    {NULL, NULL, NULL, NULL, NULL, NULL},
};
