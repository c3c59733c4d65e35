/* cases: set-up of one problem each: discs, plates, sides, initial porosity, end of the run. A case is
   registered by name; adding one is one file and one line in the table of cases.c. */
#pragma once

#include <porograin/dem.h>
#include <porograin/pore.h>

/* What a case gets and what it fills in. */
typedef struct {
  MPI_Comm    comm;
  PgParticles particles;
  PgDem       dem;
  PgPore      pore;          /* NULL in a dry run */
  PetscReal   solid_density; /* rho_s [kg/m3] */
  PetscReal   gravity[2];    /* [m/s2] */
  PetscBool   restart;       /* ids, plates and boundary kinds are needed; the fields will come from a checkpoint */

  /* filled in by the case */
  PetscReal end_time;   /* [s] */
  PetscReal height;     /* between plates at the start [m]: displacement/height is the nominal strain */
  PetscInt  load_plate; /* whose load and displacement the history shows, -1: none */
  PetscInt  load_wall;  /* the same of a wall: force along its normal, way into the discs; -1: none */
} PgCaseSetup;

typedef struct {
  const char *name, *summary;
  /* Reads the options of the case (before any disc exists). Collective. */
  PetscErrorCode (*create)(MPI_Comm comm, void **context);
  /* Makes the discs (PgParticlesSetDiscs and all fields that describe them), plates and boundary kinds. Collective. */
  PetscErrorCode (*setup)(void *context, PgCaseSetup *setup);
  PetscErrorCode (*destroy)(void **context);
} PgCaseInfo;

PETSC_EXTERN PetscErrorCode PgCaseFind(const char name[], const PgCaseInfo **info); /* NULL: unknown */
PETSC_EXTERN PetscErrorCode PgCaseGetNames(PetscInt *count, const char *const *names[]);

/* Sets mass from radius and density for all owned discs, and initial positions from positions. */
PETSC_EXTERN PetscErrorCode PgCaseFinishDiscs(PgCaseSetup *setup);
