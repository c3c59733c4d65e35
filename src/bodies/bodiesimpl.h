/* What the files of this room share. */
#pragma once

#include <porograin/bodies.h>

typedef struct {
  PgBodyKind kind;
  PetscInt   nodes, cells, edges;
  PetscInt  *cell, *edge; /* (cells, 4) counter-clockwise; (edges, 2) of the surface, the body on the left */
  PetscReal *X, *x, *v,
      *a; /* (nodes, 2): before, now [m], [m/s]; acceleration of the literal scheme; of Verlet's own steps [m/s2] */
  PetscReal *force, *load, *f;   /* (nodes, 2): of others, standing, internal [N/m] */
  PetscReal *m;                  /* (nodes) lumped [kg/m] */
  PetscReal  E, nu, rho, lambda; /* [Pa], [1], [kg/m3], [Pa] */
  PetscReal  G, limit;           /* [Pa]; bound of the time step [s] */
  PetscReal  elastic;            /* energy at the last evaluation of f [J/m] */

  PetscReal mass, inertia, X_c[2];  /* [kg/m], [kg m], [m] */
  PetscReal u_c[2], v_c[2], a_c[2]; /* of a rigid body: way, velocity, acceleration of its centre */
  PetscReal angle, spin, spin_rate; /* [rad], [rad/s], [rad/s2] */
  PetscReal way_c[2], way_angle,
      *way; /* literal scheme: velocities at the start of the step; Verlet: `way`, velocity over the step */

  PetscInt   particles, room;
  PetscInt  *in;     /* (particles) cell */
  PetscReal *N;      /* (particles, 4) N_s */
  PetscInt   offset; /* particles of bodies before this one */
} PgBody;

struct PgBodies_s {
  MPI_Comm           comm;
  PetscInt           count, room;
  PgBody            *body;
  PetscReal          gravity[2], damping;
  PgBodiesCoupling   coupling;
  PgBodiesIntegrator integrator;
  PetscInt           particles;
  PetscReal         *particle_force, *surface_x, *surface_p; /* made by Join */
  PetscInt           surface;                                /* nodes of surfaces, of all bodies */
};

/* N_s and its derivatives at a point of the square; of the point x of a cell the inverse: PETSC_FALSE outside. */
PETSC_INTERN void      PgBodyShape(PetscReal xi, PetscReal eta, PetscReal N[4], PetscReal dN[8]);
PETSC_INTERN PetscBool PgBodyLocate(const PgBody *body, PetscInt cell, const PetscReal x[2], PetscReal N[4]);
/* Masses, inertia, bound of the time step. PETSC_FALSE, with the cell: not convex. */
PETSC_INTERN PetscBool PgBodyPrepare(PgBody *body, PetscInt *cell);
/* body->f and body->elastic at the present positions. */
PETSC_INTERN void PgBodyInternalForces(PgBody *body);
/* Nodes of a rigid body from the motion of its centre. */
PETSC_INTERN void PgBodyMoveNodes(PgBody *body);
/* All forces of others: coupling, load, gravity; total and moment about the centre. */
PETSC_INTERN void PgBodyResultant(PgBodies bodies, const PgBody *body, PetscReal force[2], PetscReal *torque);
/* Adds Q p to `force`, the surface as it is now. */
PETSC_INTERN void PgBodyPressureForces(const PgBody *body, const PetscReal p[], PetscReal force[]);
