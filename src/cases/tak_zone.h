/* One of zones 1 and 2 of example 6.2 of Tak, Park & Park (2013): a continuum, and its side at the liquid, in which
   particles are embedded that move with it. */
#pragma once

#include "tak.h"

/* Columns of particles inside the side, and rows of them beyond the channel: as deep as the kernel reaches. */
enum { PG_TAK_ZONE_LAYERS = 3 };

/* Arrays of the side are the same on all ranks. */
typedef struct {
  MPI_Comm   comm;
  PgFem      fem;
  PetscInt   body;           /* number of the side among the solids of the liquid */
  PetscBool  left;           /* the side is the left one of the zone */
  PetscReal  at, L;          /* x of the side, its height [m] */
  PetscInt   count;          /* pieces of the side */
  PetscInt  *local;          /* (count + 1) node of this rank, if it owns it, or -1 */
  PetscReal *u0, *u1, *v;    /* (count + 1, 2) before and after the present step of the zone [m], [m/s] */
  PetscReal *force, *nodal;  /* (count + 1, 2), (nodes of this rank, 2) [N/m] */
  PetscReal *X, total[2];    /* (particles, 2) [m]; force on the side [N/m] */
  PetscReal *particle_force; /* (particles, 2) [N/m] */
  PetscInt   particles;
} PgTakZone;

/* `rows` particles of spacing dx along the side, and `beyond` more at each end. After fem, body, left, at, L, count. */
PETSC_INTERN PetscErrorCode PgTakZoneSetUp(PgTakZone *zone, PetscReal dx, PetscInt rows, PetscInt beyond);
PETSC_INTERN PetscErrorCode PgTakZoneDestroy(PgTakZone *zone);
PETSC_INTERN PetscErrorCode PgTakZoneAddParticles(const PgTakZone *zone, PgWcsph wcsph);
/* Place and velocity of a particle when the part `done` of the present step is over. */
PETSC_INTERN void PgTakZoneMove(const PgTakZone *zone, PetscInt index, PetscReal done, PetscReal x[2], PetscReal v[2]);
/* Forces of the liquid on the side, for the next step. Collective. */
PETSC_INTERN PetscErrorCode PgTakZoneTakeForces(PgTakZone *zone, const PgWcsphSolids *solids);
/* A step of dt, counted in `solves`. Collective. */
PETSC_INTERN PetscErrorCode PgTakZoneStep(PgTakZone *zone, PetscReal dt, PgSolves *solves);
/* Mean way of the side along the channel [m]. */
PETSC_INTERN PetscReal PgTakZoneWay(const PgTakZone *zone, PetscReal done);
