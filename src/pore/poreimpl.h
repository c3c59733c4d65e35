/* What the files of this room share. */
#pragma once

#include <porograin/pore.h>

typedef enum { PG_POROSITY_RAE, PG_POROSITY_KINEMATIC, PG_POROSITY_KERNEL } PgPorosityKind;
typedef enum { PG_RATE_KINEMATIC, PG_RATE_SAMPLED } PgPorosityRate;
typedef enum { PG_CONTINUITY_SOLENOIDAL, PG_CONTINUITY_AVERAGED } PgContinuity;
typedef enum { PG_COUPLING_DRAG, PG_COUPLING_DRAG_AND_PRESSURE } PgCoupling;
typedef enum { PG_SCHEME_PROJECTION, PG_SCHEME_STAGGERED, PG_SCHEME_INCREMENTAL } PgCouplingScheme;
typedef enum { PG_TRACKING_INITIAL, PG_TRACKING_SURFACE } PgTracking;
typedef enum { PG_GUESS_CHARACTERISTIC, PG_GUESS_LAST } PgGuess;

/* What a fluid scheme does inside the common frame of step.c. */
typedef struct {
  const char *name;
  /* From the state of t_n: intermediate velocity, characteristic pressure, force on the discs. */
  PetscErrorCode (*predict)(PgPore pore, PetscReal dt_f);
  /* Right-hand side Z of lap p = Z, or of div(kappa grad p) = Z where there is a mobility, at t_n+1. */
  PetscErrorCode (*source)(PgPore pore, PetscReal dt_f, PetscReal Z[]);
  /* kappa at t_n+1, unless it is the same everywhere and was divided out of Z. May be NULL. */
  PetscErrorCode (*mobility)(PgPore pore, PetscReal dt_f, PetscReal kappa[], PetscBool *uniform);
  /* Velocities of water and discs from the new pressure gradient. */
  PetscErrorCode (*correct)(PgPore pore, PetscReal dt_f);
} PgFluidScheme;

/* Overlaps of discs with sample circles. */
typedef struct {
  PetscInt   revision;          /* of the lists */
  PetscInt   capacity, entries; /* of what is computed, of entries of the row list */
  PetscInt   count, all;        /* to be computed: by the vector loop, and with those of much larger discs */
  PetscInt  *circle, *disc;     /* whose circle, which disc (local indices) */
  PetscInt  *at, *too; /* entries of the row list that take the result, the same one twice unless radii are equal */
  PetscReal *area;     /* by entry of the row list [m2] */
  char      *inside;   /* by entry: the centre of the disc is in the circle */
} PgOverlaps;

struct PgPore_s {
  PgParticles          particles;
  PgNeighbors          neighbors;
  PgSph                sph;
  PgPressure           pressure;
  PgFluid              fluid;
  const PgFluidScheme *scheme;
  const PgDragLaw     *drag_law;

  /* parameters */
  PetscReal        rho_f;      /* density of the water [kg/m3] */
  PetscReal        rho_s;      /* density of the discs [kg/m3], Eq. of motion in the two-phase projection */
  PetscReal        mu;         /* viscosity [N s/m2] */
  PetscReal        k_p;        /* Darcy permeability [m4/(N s)], Eq. 26 */
  PetscBool        k_p_local;  /* k_p from the local porosity, Eq. 66 */
  PetscReal        gravity[2]; /* [m/s2] */
  PetscReal        p_initial;  /* [Pa] */
  PetscReal        theta;      /* implicitness of the forces on the water, Eq. 41 */
  PetscReal        smoothing;  /* fraction of u~ replaced by its kernel mean in each step */
  PgContinuity     continuity;
  PgCoupling       coupling;
  PgCouplingScheme coupling_scheme;
  PgPorosityKind   porosity_kind;
  PgPorosityRate   rate_kind;
  PetscReal        n_min, n_max;
  PgBoundary       boundary[PG_SIDE_COUNT];
  PgTracking       tracking;
  PetscReal        surface_sum, surface_sum_back; /* kernel sums: becomes surface below, stops being above */
  PetscReal        detach_n, detach_sum;
  PetscReal        guard_pressure, guard_speed, guard_clipped;
  PgGuess          guess;

  /* fields */
  PgField porosity, porosity_sample, porosity_initial, porosity_before, rae_area, kernel_start;
  PgField u, w, p, p_fixed, p_prescribed, u_tilde, p_guess, drag, Q, kick;
  PgField side, surface, detached, fluid_force, plate, volume, divergence;

  /* scratch by local index, ghosts included; valid inside one call, but grad_p lives from the end of a
     step to the start of the next */
  PetscInt   capacity;
  PetscReal *grad_p; /* (2) of the excess over hydrostatic pressure */
  PetscReal *grad_u; /* (4) */
  PetscReal *n_flow; /* (1) porosity, at most detach_n: the one that the flow sees */
  PetscReal *head;   /* (1) p - rho_f g.x */
  PetscReal *a, *b;  /* (2), (2) */
  PetscReal *Z;      /* (1) */
  PetscInt   grad_p_revision;

  PgOverlaps overlaps;

  PgPoreStats stats;
  PetscInt    free_sides; /* discs of impermeable or flux sides that no plate holds, of all ranks */
  PetscInt    clipped, characteristic_failures; /* of this rank in this step */
};

PETSC_INTERN const PgFluidScheme PgSchemeDarcy, PgSchemeNavierStokes;

/* arrays of one fluid step, fetched once */
typedef struct {
  PetscInt   owned, local;
  PetscReal *x, *v, *radius, *n, *u, *p, *u_tilde, *p_guess, *drag, *Q, *kick, *side, *surface, *detached, *plate,
      *volume;
  PetscReal       *fluid_force, *w;
  const PetscReal *n_flow;
} PgPoreArrays;
PETSC_INTERN PetscErrorCode PgPoreGetArrays(PgPore pore, PgPoreArrays *arrays);
PETSC_INTERN PetscErrorCode PgPoreReserve(PgPore pore);

/* overlaps.c, area_loop.c: area of each disc of the row list inside the circle of radius circle*r_a about its owner, and
   whether its centre lies in it */
PETSC_INTERN PetscErrorCode PgOverlapsUpdate(PgPore pore, PetscReal circle);
PETSC_INTERN PetscErrorCode PgOverlapsDestroy(PgOverlaps *overlaps);
PETSC_INTERN void           PgOverlapLoop(const PgOverlaps *overlaps, PetscReal circle, const PetscReal x[],
                                          const PetscReal radius[]);
PETSC_INTERN PetscErrorCode PgPorosityCalibrate(PgPore pore);
PETSC_INTERN PetscErrorCode PgPorosityUpdate(PgPore pore, PetscReal dt_f);
/* Dn/Dt along the discs [1/s]: kinematic, (1 - n) div v with the velocities v* at the end of the step, or the difference
   of the sampled porosities of both ends. */
PETSC_INTERN PetscErrorCode PgPorosityDerivative(PgPore pore, const PgPoreArrays *s, PetscReal dt_f,
                                                 const PetscReal divergence[], PetscReal rate[]);
PETSC_INTERN PetscErrorCode PgPoreVolumes(PgPore pore);

PETSC_INTERN PetscErrorCode PgBoundaryStart(PgPore pore);
PETSC_INTERN PetscErrorCode PgBoundaryUpdate(PgPore pore);
/* u.e = v.e (+ w/n on flux sides) on impermeable and flux sides, u = v on detached discs. */
PETSC_INTERN PetscErrorCode PgBoundaryVelocity(PgPore pore, const PgPoreArrays *s, PetscReal u[]);
/* Whether a side of disc a, impermeable or flux, prescribes what water does along axis e. */
PETSC_INTERN PetscBool PgBoundaryHolds(PgPore pore, const PgPoreArrays *s, PetscInt a, int e);
/* Darcy velocity that such a side prescribes along the positive axis e [m/s]; 0 if none does. */
PETSC_INTERN PetscReal PgBoundaryFlux(PgPore pore, const PgPoreArrays *s, PetscInt a, int e);
/* Inflow [m/s] through the flux sides of disc a times its width 2r [m2/s]. */
PETSC_INTERN PetscReal PgBoundaryInflow(PgPore pore, const PgPoreArrays *s, PetscInt a);
/* Outward component of F on impermeable and flux sides of disc a times its width 2r. */
PETSC_INTERN PetscReal PgBoundaryForce(PgPore pore, const PgPoreArrays *s, const PetscReal F[], PetscInt a);

/* F^sf on the water at owned discs, zero where detached [N/m3]. */
PETSC_INTERN PetscErrorCode PgDragForce(PgPore pore, const PgPoreArrays *s, const PetscReal u[], PetscReal F[]);
/* The same by Ergun's law: `viscous` is 150 mu, `inertial` 1.75 rho_f. Discs more porous than it holds for are wrong. */
PETSC_INTERN void PgErgunLoop(PetscInt count, PetscReal viscous, PetscReal inertial, const PgPoreArrays *s,
                              const PetscReal u[], PetscReal F[]);
/* u(x_f) = B^-1 u*, Eqs. 38-40, and p(x_f), Eq. 59, from grad_u and grad_p. */
PETSC_INTERN PetscErrorCode PgCharacteristic(PgPore pore, const PgPoreArrays *s, PetscReal dt_f, PetscReal u_f[],
                                             PetscReal p_f[]);
PETSC_INTERN PetscErrorCode PgPressureGradient(PgPore pore);
/* Laplacian of the excess pressure of t_n on the geometry of t_n+1, before the solve. */
PETSC_INTERN PetscErrorCode PgPressureLaplacian(PgPore pore, const PgPoreArrays *s, PetscReal laplacian[]);

static inline PetscBool PgPoreAnySide(PgPore pore, PgBoundaryKind kind)
{
  for (int s = 0; s < PG_SIDE_COUNT; s++)
    if (pore->boundary[s].kind == kind) return PETSC_TRUE;
  return PETSC_FALSE;
}

static inline PetscBool PgPoreIsStaggered(PgPore pore)
{
  return (PetscBool)(pore->coupling == PG_COUPLING_DRAG_AND_PRESSURE && pore->coupling_scheme == PG_SCHEME_STAGGERED);
}

/* Unstable for every time step: the added mass of the water is larger than the mass of the discs. */
static inline PetscBool PgPoreIsLooselyCoupled(PgPore pore)
{
  return (PetscBool)(PgPoreIsStaggered(pore) && pore->fluid == PG_FLUID_NS &&
                     pore->continuity == PG_CONTINUITY_AVERAGED);
}

/* With the paper's operators long waves of the pressure grow below 0.566. */
static inline PetscBool PgPoreThetaIsSmall(PgPore pore)
{
  return (PetscBool)(pore->fluid == PG_FLUID_NS && pore->theta < 0.57);
}

static inline PetscBool PgPoreIsProjected(PgPore pore)
{
  return (PetscBool)(pore->coupling == PG_COUPLING_DRAG_AND_PRESSURE && pore->coupling_scheme != PG_SCHEME_STAGGERED);
}

/* Discs that the two-phase projection moves. */
static inline PetscBool PgPoreIsFree(const PgPoreArrays *s, PetscInt a)
{
  return (PetscBool)(s->plate[a] == 0.0 && s->detached[a] == 0.0);
}

/* The gradient of the pressure that moves a disc along axis e: what its side prescribes, else the computed one. On an
   impermeable or flux side the computed normal gradient has no part in the mass balance, which has the prescribed one;
   discs moved by it would gain energy in every step. */
static inline PetscReal PgPoreGradient(PgPore pore, const PgPoreArrays *s, PetscInt a, int e, PetscReal prescribed)
{
  return s->side[a] != 0.0 && PgBoundaryHolds(pore, s, a, e) ? prescribed : pore->grad_p[2 * a + e];
}

/* Discs whose equation has the added mass: those that the projection moves, and those on a plate next to them, since
   div v sees the neighbours move. Without it on the plates their equations ask for pressures that are too large by the
   whole factor, and the coupling grows without bound from any plate that is not drained. */
static inline PetscBool PgPoreHasAddedMass(const PgPoreArrays *s, const PgSphCoefficients *c, PetscInt a)
{
  if (s->detached[a] != 0.0) return PETSC_FALSE;
  if (s->plate[a] == 0.0) return PETSC_TRUE;
  for (PetscInt k = c->ptr[a]; k < c->ptr[a + 1]; k++)
    if (c->weight[k] > 0.0 && s->plate[c->col[k]] == 0.0) return PETSC_TRUE;
  return PETSC_FALSE;
}
