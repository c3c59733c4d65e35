/* wcsph: a weakly compressible viscous liquid by smoothed particles (Tak, Park & Park 2013, Eqs. 19-37; docs/theory.md,
   section 13), with walls and with particles of bodies that somebody else moves. Knows no elements. Two dimensions,
   everything per metre of thickness.

   All particles are in one store of the room particles, so that any number of ranks will do; a run is bitwise the same
   on any of them. Life of an object: Create; settings or SetFromOptions; AddParticles as often as wanted; SetUp; steps;
   Get...; Destroy.

   One step of dt by velocity Verlet, with bodies b that belong to the caller:

     PgWcsphKick(w, dt/2)        v += dt/2 a of the liquid                    b: v += dt/2 a, then x += dt v
     PgWcsphDrift(w, dt)         x += dt v, density over half of the step; asks the caller for the particles of bodies
     PgWcsphForces(w)            lists, density over the other half, forces   b: PgWcsphGetSolids(), a
     PgWcsphKick(w, dt/2)                                                     b: v += dt/2 a

   Forces at t_n+1 are computed with the velocities of t_n+1/2, which matters for viscosity alone. */
#pragma once

#include <porograin/particles.h>
#include <porograin/sph.h>

typedef struct PgWcsph_s *PgWcsph;

typedef enum {
  PG_WCSPH_FLUID, /* moves by its forces */
  PG_WCSPH_WALL,  /* keeps its velocity; `body` tells walls apart */
  PG_WCSPH_BODY   /* moved by the callback of PgWcsphSetMotion() */
} PgWcsphKind;

typedef enum { PG_WCSPH_CONTINUITY, PG_WCSPH_SUMMATION } PgWcsphDensity;
typedef enum { PG_WCSPH_LINEAR, PG_WCSPH_TAIT } PgWcsphState;
/* Pressure of a wall or body particle k as its partner i in the liquid meets it, and what it does to the density of i.
   All but EXTRAPOLATED keep the energy: the work of the pressure on i and k is what the liquid stores. Particles of
   solids do not meet in any of them but OWN with SUMMATION: see PgWcsphSetContact(). */
typedef enum {
  PG_WCSPH_ADJOINT, /* p_k = mean of p_i + rho_i g.(x_k - x_i) over the liquid around k (Adami, Hu & Adams 2012), and
                            what the flow does to the volume of k goes to the density of that liquid, same weights */
  PG_WCSPH_MIRROR,  /* p_k = p_i + rho_i g.(x_k - x_i), and k adds twice to d rho_i/dt: nothing is stored on k, and a
                            plane wall takes no force along itself from the pressure */
  PG_WCSPH_EXTRAPOLATED, /* p_k as for ADJOINT, but nothing of k goes to the liquid: as published */
  PG_WCSPH_OWN           /* k has a density of its own, from its partners in the liquid and by diffusion (or, with
                            SUMMATION, by Eq. 26); what slides along it leaves its mark there */
} PgWcsphSolid;
/* Velocity of a wall or body particle in the viscous term. */
typedef enum {
  PG_WCSPH_NO_SLIP, /* 2 v_k - <v>, <v> being the Shepard mean of the liquid around k */
  PG_WCSPH_PLAIN    /* v_k, as the paper says: first order only */
} PgWcsphSlip;

/* ---- making one ---- */

PETSC_EXTERN PetscErrorCode PgWcsphCreate(MPI_Comm comm, PgWcsph *wcsph); /* collective, as all that follow */
PETSC_EXTERN PetscErrorCode PgWcsphDestroy(PgWcsph *wcsph);
/* Spacing dx of the lattice of particles [m]; before AddParticles. */
PETSC_EXTERN PetscErrorCode PgWcsphSetSpacing(PgWcsph wcsph, PetscReal dx);
PETSC_EXTERN PetscErrorCode PgWcsphSetPeriodicX(PgWcsph wcsph, PetscReal low, PetscReal high);
/* rho_0 [kg/m3] > 0, mu [Pa s] >= 0, numerical speed of sound c_0 [m/s] > 0; defaults 1000, 1e-3, 1. */
PETSC_EXTERN PetscErrorCode PgWcsphSetLiquid(PgWcsph wcsph, PetscReal rho_0, PetscReal mu, PetscReal c_0);
PETSC_EXTERN PetscErrorCode PgWcsphSetGravity(PgWcsph wcsph, const PetscReal gravity[2]); /* [m/s2] */
PETSC_EXTERN PetscErrorCode PgWcsphSetDensity(PgWcsph wcsph, PgWcsphDensity density);     /* default CONTINUITY */
PETSC_EXTERN PetscErrorCode PgWcsphSetState(PgWcsph wcsph, PgWcsphState state);           /* default LINEAR */
PETSC_EXTERN PetscErrorCode PgWcsphSetSolid(PgWcsph wcsph, PgWcsphSolid solid);           /* default MIRROR */
PETSC_EXTERN PetscErrorCode PgWcsphSetSlip(PgWcsph wcsph, PgWcsphSlip slip);              /* default NO_SLIP */
/* "cubic_spline" or "quintic_spline" and h/dx; default quintic, 1.2. */
PETSC_EXTERN PetscErrorCode PgWcsphSetKernel(PgWcsph wcsph, const char kernel[], PetscReal smoothing);
/* Diffusion of density (Molteni & Colagrossi 2009, without its effect on hydrostatic pressure); default 0.1. */
PETSC_EXTERN PetscErrorCode PgWcsphSetDiffusion(PgWcsph wcsph, PetscReal delta);
/* Solids that meet, walls and different bodies (Eq. 35 between them with Eq. 26 for the density beyond that of faces
   that just touch): stiffness over rho_0 c_0^2 (0: they do not feel each other), and whether there is viscous friction
   between them. Defaults 1, off. */
PETSC_EXTERN PetscErrorCode PgWcsphSetContact(PgWcsph wcsph, PetscReal stiffness, PetscBool friction);
/* -rate v acts on the liquid until `end` [1/s], [s]; default none. */
PETSC_EXTERN PetscErrorCode PgWcsphSetDamping(PgWcsph wcsph, PetscReal rate, PetscReal end);
/* Options -wcsph_*. */
PETSC_EXTERN PetscErrorCode PgWcsphSetFromOptions(PgWcsph wcsph);

/* To be called when everything is set up: refuses options without effect and unknown ones, as PgOptionsCheck(), by the
   rules of this room and `count` more, which know the same facts; probe as there, may be NULL. */
PETSC_EXTERN PetscErrorCode PgWcsphCheckOptions(PgWcsph wcsph, PetscInt count, const PgOptionRule more[],
                                                PetscErrorCode (*probe)(void *), void *context);

/* Every rank gives the same particles; permanent ids are given in this order. */
typedef struct {
  PgWcsphKind kind;
  PetscInt    body;       /* number of the wall or body; 0 for liquid */
  PetscInt    index;      /* number within the body, for its owner */
  PetscReal   x[2], v[2]; /* [m], [m/s] */
  PetscReal   pressure;   /* of liquid at the start [Pa]: its mass is that of dx^2 at this pressure */
} PgWcsphParticle;
PETSC_EXTERN PetscErrorCode PgWcsphAddParticles(PgWcsph wcsph, PetscInt count, const PgWcsphParticle particle[]);

/* Fills in where the particles of bodies are at the end of the drift and their velocity in it. Called by each rank for
   those that it owns, `count` may be 0; not collective. */
typedef PetscErrorCode (*PgWcsphMotion)(void *context, PetscInt count, const PetscInt body[], const PetscInt index[],
                                        PetscReal x[], PetscReal v[]);
PETSC_EXTERN PetscErrorCode PgWcsphSetMotion(PgWcsph wcsph, PgWcsphMotion motion, void *context);

/* Distributes the particles and computes the first forces. Refuses a period narrower than three
   reaches of the kernel. */
PETSC_EXTERN PetscErrorCode PgWcsphSetUp(PgWcsph wcsph);
PETSC_EXTERN PetscErrorCode PgWcsphView(PgWcsph wcsph, PetscViewer viewer);

/* ---- stepping ---- */

/* min(h/(4 c_0), h^2/(8 nu), sqrt(h/|g|)/4) [s]: a bound for dt that does not change during a run. Bodies whose contact is
   stiffer than the liquid take the place of c_0 with c_0 times the root of that. */
PETSC_EXTERN PetscErrorCode PgWcsphGetTimeStep(PgWcsph wcsph, PetscReal *dt);
PETSC_EXTERN PetscErrorCode PgWcsphKick(PgWcsph wcsph, PetscReal dt);
PETSC_EXTERN PetscErrorCode PgWcsphDrift(PgWcsph wcsph, PetscReal dt);
/* Fails, naming the particle, when a density is not finite or off rho_0 by half: the run has blown up. */
PETSC_EXTERN PetscErrorCode PgWcsphForces(PgWcsph wcsph);
/* Kick, Drift, Forces, Kick: one step without bodies. */
PETSC_EXTERN PetscErrorCode PgWcsphStep(PgWcsph wcsph, PetscReal dt);
PETSC_EXTERN PetscErrorCode PgWcsphGetTime(PgWcsph wcsph, PetscInt *step, PetscReal *time);

/* ---- what was set ---- */

/* Each may be NULL but `wcsph`; not collective, as the next two. */
PETSC_EXTERN PetscErrorCode PgWcsphGetLiquid(PgWcsph wcsph, PetscReal *rho_0, PetscReal *mu, PetscReal *c_0,
                                             PetscReal gravity[2]);
PETSC_EXTERN PetscErrorCode PgWcsphGetState(PgWcsph wcsph, PgWcsphState *state);
PETSC_EXTERN PetscErrorCode PgWcsphGetReach(PgWcsph wcsph, PetscReal *reach); /* of the kernel [m]; after SetSpacing */
/* Length epsilon by which a face that ends at a wall is too short for the pressure, T73: the liquid pushes a piston that
   fills a channel of height H with p (H - 2 epsilon), and the walls beside it with the rest [m]. After SetSpacing. */
PETSC_EXTERN PetscErrorCode PgWcsphGetEdge(PgWcsph wcsph, PetscReal *epsilon);

/* ---- what has become of it ---- */

/* The store, with the fields of the room particles (mass; radius is dx/2) and
   "kind", "body", "body_index"   as PgWcsphParticle
   "density", "pressure"          [kg/m3], [Pa]; of solids only with OWN and EXTRAPOLATED
   "force"                        (2) on the particle from all of the others [N/m]: without gravity and damping */
PETSC_EXTERN PetscErrorCode PgWcsphGetParticles(PgWcsph wcsph, PgParticles *particles);

/* Particles of walls or bodies that this rank owns. The force on each is the exact opposite, to the bit, of what it does
   to its partners. Addresses are valid until the next PgWcsphForces(). Not collective. */
typedef struct {
  PetscInt         count;
  const PetscInt  *body, *index;
  const PetscReal *x;        /* (count, 2) [m] */
  const PetscReal *force;    /* (count, 2) pressure and viscosity [N/m] */
  const PetscReal *pressure; /* (count) mean of the liquid around, Shepard; 0 where there is none [Pa] */
} PgWcsphSolids;
PETSC_EXTERN PetscErrorCode PgWcsphGetSolids(PgWcsph wcsph, PgWcsphKind kind, PgWcsphSolids *solids);

/* Pressure and velocity of the liquid at points that are the same on all ranks, by Shepard's mean; `weight` is the sum
   of V W there: 1 inside of the liquid, 0 where there is none (then the values are 0). Velocity and weight may be NULL.
   The same bits on any number of ranks. */
PETSC_EXTERN PetscErrorCode PgWcsphInterpolate(PgWcsph wcsph, PetscInt count, const PetscReal x[], PetscReal pressure[],
                                               PetscReal velocity[], PetscReal weight[]);

typedef struct {
  PetscReal kinetic, internal, potential; /* of the liquid (and of solids that store energy) [J/m] */
  PetscReal momentum[2];                  /* of the liquid [kg/s] */
  PetscReal force[2];                     /* on walls [N/m] */
  PetscReal density_min, density_max;     /* of the liquid [kg/m3] */
  PetscReal speed_max;                    /* of the liquid [m/s] */
} PgWcsphTotals;
PETSC_EXTERN PetscErrorCode PgWcsphGetTotals(PgWcsph wcsph, PgWcsphTotals *totals);
