/* The guard of the water: stops a run that has gone wrong, and says where. */
#include "poreimpl.h"
#include <math.h>

static PetscErrorCode GuardValues(PgPore pore, PetscInt step, PetscReal time)
{
  PgPoreArrays    s;
  const PetscInt *id;
  PetscReal       worst = 1.0, all;
  PetscInt        disc = -1, mine = PETSC_MAX_INT, first;
  PetscMPIInt     rank, owner     = PETSC_MPI_INT_MAX;
  PetscReal       where[7] = {0};
  MPI_Comm        comm     = PgParticlesComm(pore->particles);

  PetscFunctionBeginUser;
  PetscCall(PgPoreGetArrays(pore, &s));
  PetscCall(PgParticlesGetIds(pore->particles, &id));
  for (PetscInt a = 0; a < s.owned; a++) {
    const PetscReal speed = PetscSqrtReal(s.u[2 * a] * s.u[2 * a] + s.u[2 * a + 1] * s.u[2 * a + 1]);
    PetscReal       bad   = PetscMax(PetscAbsReal(s.p[a]) / pore->guard_pressure, speed / pore->guard_speed);
    if (!isfinite(s.p[a]) || !isfinite(speed) || !isfinite(s.n[a])) bad = PETSC_MAX_REAL;
    /* of equal ones the lowest id: the message is the same on any number of ranks */
    if (bad > worst || (disc >= 0 && bad == worst && id[a] < id[disc])) {
      worst = bad;
      disc  = a;
    }
  }
  PetscCallMPI(MPI_Allreduce(&worst, &all, 1, MPIU_REAL, MPIU_MAX, comm));
  if (all <= 1.0) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (disc >= 0 && worst == all) mine = id[disc];
  PetscCallMPI(MPI_Allreduce(&mine, &first, 1, MPIU_INT, MPI_MIN, comm));
  if (mine == first && mine != PETSC_MAX_INT) owner = rank;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &owner, 1, MPI_INT, MPI_MIN, comm));
  if (owner == rank) {
    const PetscReal data[7] = {(PetscReal)id[disc], s.x[2 * disc],     s.x[2 * disc + 1], s.p[disc],
                               s.u[2 * disc],       s.u[2 * disc + 1], s.n[disc]};
    PetscCall(PetscArraycpy(where, data, 7));
  }
  PetscCallMPI(MPI_Bcast(where, 7, MPIU_REAL, owner, comm));
  PgRunError(comm,
             "the water has blown up at step %" PetscInt_FMT ", time %g s: disc %" PetscInt_FMT
             " at (%g, %g) m has pressure %g Pa, "
             "velocity (%g, %g) m/s, porosity %g (bounds: -pore_guard_pressure %g Pa, -pore_guard_speed %g m/s)%s%s",
             step, (double)time, (PetscInt)where[0], (double)where[1], (double)where[2], (double)where[3],
             (double)where[4], (double)where[5], (double)where[6], (double)pore->guard_pressure,
             (double)pore->guard_speed, pore->advice, pore->side_advice);
}

/* Names the first disc whose porosity is clipped. */
static PetscErrorCode GuardPorosity(PgPore pore, PetscInt step, PetscReal time)
{
  PgPoreArrays    s;
  const PetscInt *id;
  PetscInt        mine = pore->clipped, clipped, global, first = PETSC_MAX_INT, disc = -1, least;
  PetscMPIInt     rank, owner = PETSC_MPI_INT_MAX;
  PetscReal       where[4] = {0};
  MPI_Comm        comm     = PgParticlesComm(pore->particles);

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(pore->particles, NULL, NULL, &global));
  PetscCallMPI(MPI_Allreduce(&mine, &clipped, 1, MPIU_INT, MPI_SUM, comm));
  if ((PetscReal)clipped <= pore->guard_clipped * (PetscReal)global) PetscFunctionReturn(0);
  PetscCall(PgPoreGetArrays(pore, &s));
  PetscCall(PgParticlesGetIds(pore->particles, &id));
  for (PetscInt a = 0; a < s.owned; a++)
    if ((s.n[a] == pore->n_min || s.n[a] == pore->n_max) && id[a] < first) {
      first = id[a];
      disc  = a;
    }
  PetscCallMPI(MPI_Allreduce(&first, &least, 1, MPIU_INT, MPI_MIN, comm));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (disc >= 0 && first == least) owner = rank;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &owner, 1, MPI_INT, MPI_MIN, comm));
  if (owner == rank) {
    const PetscReal data[4] = {(PetscReal)id[disc], s.x[2 * disc], s.x[2 * disc + 1], s.n[disc]};
    PetscCall(PetscArraycpy(where, data, 4));
  }
  if (owner < PETSC_MPI_INT_MAX) PetscCallMPI(MPI_Bcast(where, 4, MPIU_REAL, owner, comm));
  PgRunError(comm,
             "step %" PetscInt_FMT ", time %g s: the porosity of %" PetscInt_FMT " of %" PetscInt_FMT
             " discs is out of range and was clipped, more than -pore_guard_clipped %g of them; the first is disc "
             "%" PetscInt_FMT " at (%g, %g) m, clipped to %g",
             step, (double)time, clipped, global, (double)pore->guard_clipped, (PetscInt)where[0], (double)where[1],
             (double)where[2], (double)where[3]);
}

PetscErrorCode PgPoreGuard(PgPore pore, PetscInt step, PetscReal time)
{
  PetscFunctionBeginUser;
  PetscCall(GuardValues(pore, step, time));
  PetscCall(GuardPorosity(pore, step, time));
  PetscFunctionReturn(0);
}
