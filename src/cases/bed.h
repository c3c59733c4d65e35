/* What the cases of water in a fixed bed share. */
#pragma once

#include "lattice.h"

typedef struct {
  PgLattice lattice;
  PetscReal end_time; /* [s] */
} PgBed;

/* Sets the options that come with the case and reads -bed_*; `initial` is what they start from. Collective. */
PETSC_INTERN PetscErrorCode PgBedCreate(MPI_Comm comm, const char defaults[], const PgBed *initial, void **context);
PETSC_INTERN PetscErrorCode PgBedSetup(void *context, PgCaseSetup *setup);
PETSC_INTERN PetscErrorCode PgBedDestroy(void **context);
