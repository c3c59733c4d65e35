/* A hexagonal lattice of discs, periodic in x: what the fixed beds and the columns are made of. */
#pragma once

#include "casesimpl.h"

typedef struct {
  PetscInt  columns, rows;
  PetscReal radius;       /* [m] */
  PetscReal porosity;     /* fixes the spacing; < 0: discs just touch [1] */
  PetscInt  layer_rows;   /* that many rows at the bottom have discs of another radius on the same lattice */
  PetscReal layer_radius; /* [m] */
  PetscBool held;         /* every disc is held; otherwise the bottom row stands on the plate "lower" */
} PgLattice;

/* Reads -PREFIX_columns, -PREFIX_rows, -PREFIX_radius. */
PETSC_INTERN PetscErrorCode PgLatticeOptions(PetscOptionItems *PetscOptionsObject, const char prefix[],
                                             PgLattice *lattice);
/* Distance of neighbours in a row [m]; rows lie sqrt(3)/2 times that apart. */
PETSC_INTERN PetscReal PgLatticeSpacing(const PgLattice *lattice);
/* Height of the centres of the top row above those of the bottom row [m]. */
PETSC_INTERN PetscReal PgLatticeHeight(const PgLattice *lattice);
/* Makes the discs, the period of x, the plate (that of the load), the sides bottom and top, and all fields that
   describe the discs. Ids run along the rows from the bottom. Collective. */
PETSC_INTERN PetscErrorCode PgLatticeSetup(const PgLattice *lattice, PgCaseSetup *setup);
