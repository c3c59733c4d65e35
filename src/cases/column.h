/* What the columns of grains and water share. */
#pragma once

#include "lattice.h"

typedef struct {
  PgLattice lattice;
  PetscReal load;     /* on the top row, downward [Pa] */
  PetscReal gradient; /* of the head, upward; NAN: the bottom has no prescribed head [1] */
  PetscReal end_time; /* [s] */
} PgColumn1d;

/* Options of a column that is loaded on its drained top. */
#define PG_COLUMN_LOADED                                                                                               \
  "-fluid darcy -permeability 6.5e-10 -dt 5e-6 -fluid_every 10 -coupling drag_and_pressure -bc_bottom impermeable "    \
  "-bc_top drained -bc_top_pressure 100000"

/* Sets the options that come with the case and reads -column_*; `initial` is what they start from. Collective. */
PETSC_INTERN PetscErrorCode PgColumnCreate(MPI_Comm comm, const char defaults[], const PgColumn1d *initial,
                                           void **context);
PETSC_INTERN PetscErrorCode PgColumnSetup(void *context, PgCaseSetup *setup);
PETSC_INTERN PetscErrorCode PgColumnDestroy(void **context);
