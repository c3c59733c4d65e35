/* The guard of the water: stops a run that has gone wrong, says where, and what may be behind it. */
#include "poreimpl.h"
#include <math.h>
#include <stdio.h>

/* ---- what is known to go wrong ---- */

static PetscBool NaturalSides(PgPore pore)
{
  return (PetscBool)(pore->fluid == PG_FLUID_NS && PgPoreAnySide(pore, PG_BC_NATURAL));
}

static PetscBool SmallTheta(PgPore pore) { return PgPoreThetaIsSmall(pore); }

static PetscBool Staggered(PgPore pore) { return PgPoreIsLooselyCoupled(pore); }

static PetscBool FreeSides(PgPore pore) { return (PetscBool)(pore->free_sides > 0); }

static PetscBool Incremental(PgPore pore)
{
  return (PetscBool)(pore->fluid == PG_FLUID_NS && pore->coupling == PG_COUPLING_DRAG_AND_PRESSURE &&
                     pore->coupling_scheme == PG_SCHEME_INCREMENTAL);
}

static PetscBool Adrift(PgPore pore)
{
  PgPressureMethod method;

  (void)PgPressureGetMethod(pore->pressure, &method);
  return (PetscBool)(method == PG_PRESSURE_EXPLICIT && !PgPoreAnySide(pore, PG_BC_DRAINED));
}

static PetscBool NothingDetached(PgPore pore) { return (PetscBool)(pore->detach_n > 0.9 && pore->detach_sum <= 0.0); }

typedef struct {
  PetscBool (*applies)(PgPore pore);
  const char *text;
} Advice;

/* Unstable by itself. */
static const Advice unstable[] = {
    {NaturalSides,
     "sides of kind natural are unstable with the Navier-Stokes scheme: use drained, impermeable or flux"},
    {SmallTheta, "-ns_theta below 0.57 is unstable with the paper's operators"},
    {Staggered, "-coupling_scheme staggered is unstable with averaged continuity: use projection"},
    {FreeSides, "an impermeable or flux side that neither plate nor wall holds is unstable with -coupling "
                "drag_and_pressure"},
    {Incremental, "-coupling_scheme incremental has been unstable with the Navier-Stokes scheme: try projection"},
};
/* Allowed, and to be looked at when nothing of the above explains why the water is beyond its bounds. */
static const Advice doubtful[] = {
    {Adrift, "no side is drained, and explicit sweeps do not keep the mean pressure: use -pressure implicit"},
    {NothingDetached,
     "-detach_porosity and -detach_kernel_sum are off: discs that have left the packing count as in the "
     "water"},
};

static void Append(PgPore pore, size_t count, const Advice advice[], char text[], size_t size)
{
  for (size_t k = 0; k < count; k++) {
    const size_t used = strlen(text);
    if (advice[k].applies(pore)) (void)snprintf(text + used, size - used, "; %s", advice[k].text);
  }
}

/* "; this; that", or nothing. */
static void Advise(PgPore pore, PetscReal beyond, char text[], size_t size)
{
  text[0] = '\0';
  Append(pore, sizeof unstable / sizeof *unstable, unstable, text, size);
  if (!text[0] && beyond > 1.0) Append(pore, sizeof doubtful / sizeof *doubtful, doubtful, text, size);
}

/* ---- the guard ---- */

enum { QUOTED = 7, TEXT = 1024 };

/* How far the worst disc is beyond the bounds; what is to be said about it when that is more than `above`. */
static PetscErrorCode WorstDisc(PgPore pore, PetscReal above, PetscReal *beyond, PetscReal where[QUOTED])
{
  PgPoreArrays    s;
  const PetscInt *id;
  PetscReal       worst = above;
  PetscInt        disc  = -1;
  PetscMPIInt     holder;
  MPI_Comm        comm = PgParticlesComm(pore->particles);

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
  PetscCallMPI(MPI_Allreduce(&worst, beyond, 1, MPIU_REAL, MPIU_MAX, comm));
  if (*beyond <= above) PetscFunctionReturn(0);
  if (disc >= 0) {
    const PetscReal data[QUOTED] = {(PetscReal)id[disc], s.x[2 * disc],     s.x[2 * disc + 1], s.p[disc],
                                    s.u[2 * disc],       s.u[2 * disc + 1], s.n[disc]};
    PetscCall(PetscArraycpy(where, data, QUOTED));
  }
  PetscCall(PgFindHolder(comm, worst, disc < 0 ? -1 : id[disc], 0, &holder));
  PetscCallMPI(MPI_Bcast(where, QUOTED, MPIU_REAL, holder, comm));
  PetscFunctionReturn(0);
}

static void Describe(PgPore pore, const PetscReal where[QUOTED], PetscReal beyond, char text[], size_t size)
{
  size_t used;

  (void)snprintf(text, size,
                 "disc %" PetscInt_FMT " at (%g, %g) m has pressure %g Pa, velocity (%g, %g) m/s, porosity %g",
                 (PetscInt)where[0], (double)where[1], (double)where[2], (double)where[3], (double)where[4],
                 (double)where[5], (double)where[6]);
  used = strlen(text);
  if (beyond > 1.0)
    (void)snprintf(text + used, size - used, " (bounds: -pore_guard_pressure %g Pa, -pore_guard_speed %g m/s)",
                   (double)pore->guard_pressure, (double)pore->guard_speed);
  used = strlen(text);
  Advise(pore, beyond, text + used, size - used);
}

static PetscErrorCode GuardValues(PgPore pore, PetscInt step, PetscReal time)
{
  PetscReal beyond, where[QUOTED] = {0};
  char      text[TEXT];

  PetscFunctionBeginUser;
  PetscCall(WorstDisc(pore, 1.0, &beyond, where));
  if (beyond <= 1.0) PetscFunctionReturn(0);
  Describe(pore, where, beyond, text, sizeof text);
  PetscCall(PgReport(PgParticlesComm(pore->particles),
                     "the water has blown up at step %" PetscInt_FMT ", time %g s: %s", step, (double)time, text));
  return PETSC_ERR_NOT_CONVERGED;
}

PetscErrorCode PgPoreFindCause(void *context, char cause[], size_t size)
{
  PgPore    pore = (PgPore)context;
  PetscReal beyond, where[QUOTED] = {0};
  char      text[TEXT], known[TEXT];

  PetscFunctionBeginUser;
  cause[0] = '\0';
  PetscCall(WorstDisc(pore, -1.0, &beyond, where));
  Describe(pore, where, beyond, text, sizeof text);
  Advise(pore, beyond, known, sizeof known);
  if (beyond > 1.0)
    (void)snprintf(cause, size, "the water has blown up: %s", text);
  else if (known[0])
    (void)snprintf(cause, size, "the water may be behind it: %s", text);
  PetscFunctionReturn(0);
}

/* Names the first disc whose porosity is clipped. */
static PetscErrorCode GuardPorosity(PgPore pore, PetscInt step, PetscReal time)
{
  PgPoreArrays    s;
  const PetscInt *id;
  PetscInt        mine = pore->clipped, clipped, global, disc = -1;
  PetscMPIInt     holder;
  PetscReal       where[4] = {0};
  MPI_Comm        comm     = PgParticlesComm(pore->particles);

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(pore->particles, NULL, NULL, &global));
  PetscCallMPI(MPI_Allreduce(&mine, &clipped, 1, MPIU_INT, MPI_SUM, comm));
  if ((PetscReal)clipped <= pore->guard_clipped * (PetscReal)global) PetscFunctionReturn(0);
  PetscCall(PgPoreGetArrays(pore, &s));
  PetscCall(PgParticlesGetIds(pore->particles, &id));
  for (PetscInt a = 0; a < s.owned; a++)
    if ((s.n[a] == pore->n_min || s.n[a] == pore->n_max) && (disc < 0 || id[a] < id[disc])) disc = a;
  if (disc >= 0) {
    const PetscReal data[4] = {(PetscReal)id[disc], s.x[2 * disc], s.x[2 * disc + 1], s.n[disc]};
    PetscCall(PetscArraycpy(where, data, 4));
  }
  PetscCall(PgFindHolder(comm, 0, disc < 0 ? -1 : id[disc], 0, &holder));
  if (holder >= 0) PetscCallMPI(MPI_Bcast(where, 4, MPIU_REAL, holder, comm));
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
