/* bodies: discrete elements of any shape, each a mesh of quadrilaterals, rigid or deformable, with embedded particles by
   which the liquid and other bodies feel them (Tak, Park & Park 2013, Eqs. 38-50; docs/theory.md, section 14). Plane
   strain, everything per metre of thickness, stress positive in tension, pressure in compression.

   Bodies are few: every rank holds all of them and does the same with them, to the bit. Life of an object: Create;
   settings or SetFromOptions; Add and Embed as often as wanted; Join; steps; Get...; Destroy. All of it is collective.

   One step of dt with a liquid w: PgBodiesKickDrift(b, dt), PgWcsphKick(w, dt/2), PgWcsphDrift(w, dt), PgWcsphForces(w),
   PgBodiesCouple(b, w), PgBodiesKick(b, dt), PgWcsphKick(w, dt/2). */
#pragma once

#include <porograin/wcsph.h>

typedef struct PgBodies_s *PgBodies;

typedef enum {
  PG_BODY_RIGID,
  PG_BODY_LINEAR, /* K u of Eq. 38: small strains, small rotations */
  PG_BODY_FINITE  /* the same material with Green's strain: turns without stress, keeps angular momentum */
} PgBodyKind;
typedef enum {
  PG_BODIES_REACTIONS, /* what the embedded particles feel from others, handed to the nodes by N_s: keeps momentum */
  PG_BODIES_Q          /* Q p, Eqs. 43-46, with the pressure of the liquid at the nodes of the surface; no viscosity, no
                          contact */
} PgBodiesCoupling;
typedef enum {
  PG_BODIES_VERLET, /* velocity Verlet, with smaller steps of its own for what is stiff in a body */
  PG_BODIES_LITERAL /* Eqs. 47-50 as printed, the acceleration at u_n moving u_n+1: unstable without damping */
} PgBodiesIntegrator;

typedef struct {
  PetscInt         nodes, cells;
  const PetscReal *x;    /* (nodes, 2) [m] */
  const PetscInt  *cell; /* (cells, 4) corners, in either sense around */
  PgBodyKind       kind;
  PetscReal        E, nu; /* Young's modulus [Pa], Poisson's ratio [1]; of deformable bodies */
  PetscReal        rho;   /* [kg/m3] */
} PgBodyMesh;

PETSC_EXTERN PetscErrorCode PgBodiesCreate(MPI_Comm comm, PgBodies *bodies);
PETSC_EXTERN PetscErrorCode PgBodiesDestroy(PgBodies *bodies);
PETSC_EXTERN PetscErrorCode PgBodiesSetGravity(PgBodies bodies, const PetscReal gravity[2]); /* [m/s2] */
PETSC_EXTERN PetscErrorCode PgBodiesSetDamping(PgBodies bodies, PetscReal rate); /* -rate m v [1/s], default 0 */
PETSC_EXTERN PetscErrorCode PgBodiesSetCoupling(PgBodies bodies, PgBodiesCoupling coupling); /* default REACTIONS */
PETSC_EXTERN PetscErrorCode PgBodiesSetIntegrator(PgBodies bodies, PgBodiesIntegrator integrator); /* default VERLET */
/* Options -bodies_*. */
PETSC_EXTERN PetscErrorCode PgBodiesSetFromOptions(PgBodies bodies);
PETSC_EXTERN PetscErrorCode PgBodiesView(PgBodies bodies, PetscViewer viewer);

/* Adds a body; its number is from 0 on. Refuses cells that are no convex quadrilaterals, corners that do not exist, and
   materials that are none. */
PETSC_EXTERN PetscErrorCode PgBodiesAdd(PgBodies bodies, const PgBodyMesh *mesh, PetscInt *body);
/* A rectangle of cells[0] x cells[1]; nodes row by row from the bottom left. nodes, cells, x and cell of `like` are not
   read. */
PETSC_EXTERN PetscErrorCode PgBodiesAddBox(PgBodies bodies, const PgBodyMesh *like, const PetscInt cells[2],
                                           const PetscReal low[2], const PetscReal high[2], PetscInt *body);
/* Particles at these points of the body as it was added, which move with it. Refuses points outside of its mesh. */
PETSC_EXTERN PetscErrorCode PgBodiesEmbed(PgBodies bodies, PetscInt body, PetscInt count, const PetscReal x[]);
/* Particles at the middles of squares of side dx, from the bottom left of what bounds the body on, that lie in it. */
PETSC_EXTERN PetscErrorCode PgBodiesEmbedLattice(PgBodies bodies, PetscInt body, PetscReal dx);
/* Adds the particles of all bodies to a liquid, as its bodies 0, 1, ..., and moves them from now on. Before
   PgWcsphSetUp(). */
PETSC_EXTERN PetscErrorCode PgBodiesJoin(PgBodies bodies, PgWcsph wcsph);
/* What moves them, a PgWcsphMotion with the bodies as context: for callers who move others, too, and leave these to it. It
   passes over numbers that are no bodies of its own. Not collective. */
PETSC_EXTERN PetscErrorCode PgBodiesMotion(void *bodies, PetscInt count, const PetscInt body[], const PetscInt index[],
                                           PetscReal x[], PetscReal v[]);
/* The body in whose mesh a point is, as added; -1: none. Not collective. */
PETSC_EXTERN PetscErrorCode PgBodiesFind(PgBodies bodies, const PetscReal x[2], PetscInt *body);

/* Forces on the nodes from now on, beside all others, (nodes, 2) [N/m]; NULL: none. */
PETSC_EXTERN PetscErrorCode PgBodiesSetLoad(PgBodies bodies, PetscInt body, const PetscReal force[]);
/* A traction [Pa] on those edges of the surface whose ends both have x[d] = at when the body is added, as forces on the
   nodes: adds to the load. Refuses when there is none. */
PETSC_EXTERN PetscErrorCode PgBodiesAddTraction(PgBodies bodies, PetscInt body, int d, PetscReal at,
                                                const PetscReal traction[2]);
PETSC_EXTERN PetscErrorCode PgBodiesSetVelocity(PgBodies bodies, PetscInt body, const PetscReal v[2], PetscReal spin);
/* Displacement and velocity of the nodes of a deformable body, (nodes, 2) [m], [m/s]; NULL: as they are. */
PETSC_EXTERN PetscErrorCode PgBodiesSetState(PgBodies bodies, PetscInt body, const PetscReal u[], const PetscReal v[]);

/* A bound of the stable time step of what is deformable, PETSC_MAX_REAL without: the Verlet scheme takes as many steps of
   its own in a step as keep it. */
PETSC_EXTERN PetscErrorCode PgBodiesGetTimeStep(PgBodies bodies, PetscReal *dt);
/* First half of a step of dt and the way; what others do to the bodies, taken by Couple or the calls below; second half. */
PETSC_EXTERN PetscErrorCode PgBodiesKickDrift(PgBodies bodies, PetscReal dt);
PETSC_EXTERN PetscErrorCode PgBodiesCouple(PgBodies bodies, PgWcsph wcsph);
PETSC_EXTERN PetscErrorCode PgBodiesKick(PgBodies bodies, PetscReal dt);
/* In the place of Couple: forces on the nodes (nodes, 2) [N/m]; or Q p of pressures at all nodes (nodes) [Pa], of which
   those of the surface are read. */
PETSC_EXTERN PetscErrorCode PgBodiesSetForces(PgBodies bodies, PetscInt body, const PetscReal force[]);
PETSC_EXTERN PetscErrorCode PgBodiesSetPressure(PgBodies bodies, PetscInt body, const PetscReal pressure[]);

/* Addresses last as long as the object, values until the next call that changes them. */
typedef struct {
  PetscInt         nodes, cells, particles, edges;
  const PetscInt  *cell;                   /* (cells, 4) counter-clockwise */
  const PetscInt  *edge;                   /* (edges, 2) of the surface, the body on the left */
  const PetscReal *X, *x, *v, *force, *m;  /* (nodes, 2) before and now [m], [m/s], of others [N/m]; (nodes) [kg/m] */
  PetscReal        mass, inertia;          /* [kg/m], about the centre, as added [kg m] */
  PetscReal        centre[2], velocity[2]; /* of mass [m], [m/s] */
  PetscReal        spin, angle;            /* rigid bodies [rad/s], [rad] */
  PetscReal        kinetic, elastic, angular; /* [J/m]; angular momentum about the origin [kg m/s] */
} PgBodyState;
PETSC_EXTERN PetscErrorCode PgBodiesGet(PgBodies bodies, PetscInt body, PgBodyState *state);
PETSC_EXTERN PetscErrorCode PgBodiesGetCount(PgBodies bodies, PetscInt *count);
