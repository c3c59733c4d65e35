/* What the files of the case "packing" share. */
#pragma once

#include "casesimpl.h"
#include <porograin/io.h>

typedef enum { PG_MAKE_HEXAGONAL, PG_MAKE_SQUARE, PG_MAKE_RANDOM, PG_MAKE_COUNT } PgPackingMake;

/* What is to be made. */
typedef struct {
  PgPackingMake make;
  PetscInt      count;   /* of discs; 0: from the size */
  PetscReal     size[2]; /* of the box [m]; 0: from the count */
  PetscReal     aspect;  /* height over width of the box when the count is given [1] */
  PetscReal     radius;  /* [m] */
  PetscReal     spread;  /* radii are uniform in radius*(1 +- spread) [1] */
  PetscReal     second;  /* radius of the second size [m]; 0: there is none */
  PetscReal     share;   /* of the discs that have it [1] */
  PetscReal     target;  /* porosity in the box [1] */
  PetscReal     overlap; /* largest that may remain, over the smaller radius [1] */
  PetscInt      steps;   /* most of the pressing */
  PetscInt      seed;
  PetscBool     periodic; /* in x */
} PgPackingPlan;

/* The rectangle that the discs fill: walls, plates and sides lie on it. */
typedef struct {
  PetscReal low[2], high[2]; /* [m] */
} PgBox;

/* ---- packing_make.c ---- */

/* Uniform in [0, 1), the `draw`-th (0 .. 7) number that belongs to disc `id`: a function of the three arguments, so
   that it is the same on any number of ranks. */
PETSC_INTERN PetscReal PgPackingRandom(PetscInt seed, PetscInt id, PetscInt draw);
PETSC_INTERN PetscReal PgPackingDrawRadius(const PgPackingPlan *plan, PetscInt id);
/* Makes the discs of the plan. With `only_ids` the number of discs and the box are right, their places and radii
   need not be. Collective. */
PETSC_INTERN PetscErrorCode PgPackingGenerate(MPI_Comm comm, const PgPackingPlan *plan, PetscBool only_ids,
                                              PgPacking *packing, PgBox *box);

/* ---- packing_press.c ---- */

/* Brings the discs, with the radii that they have, to places where no overlap is above plan->overlap. Refuses what
   jams. Collective. */
PETSC_INTERN PetscErrorCode PgPackingPress(MPI_Comm comm, const PgPackingPlan *plan, const PgBox *box,
                                           PgPacking *packing);

/* ---- packing_inspect.c ---- */

typedef struct {
  PetscReal  radius_min, radius_mean, radius_max; /* [m] */
  PetscReal  overlap;                             /* largest, over the smaller radius [1]; < 0: a gap */
  PetscInt   pair[2];                             /* its discs; -1: no pair is near */
  PetscReal  place[4];                            /* their centres [m] */
  PetscInt64 touching;                            /* pairs */
  PetscInt64 coincident;                          /* pairs with the same centre */
  PetscReal  outside;                             /* farthest that a disc reaches out of the box, over its radius [1] */
  PetscInt   outside_disc;
  PetscReal  area;        /* of all discs [m2] */
  PetscReal  common_area; /* of it counted twice, in overlaps [m2] */
  PetscInt64 samples;     /* circles of radius 4 r_a, Eq. 61, that lie inside the box */
  PetscReal  sampled;     /* porosity in all of them together [1] */
} PgPackingFindings;

/* Looks at all pairs; stops early where discs are piled up. `from` names the packing in messages. Collective. */
PETSC_INTERN PetscErrorCode PgPackingInspect(MPI_Comm comm, const char from[], const PgPacking *packing,
                                             const PgBox *box, PgPackingFindings *findings);
