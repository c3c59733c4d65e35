/* The registered cases. */
#pragma once

#include <porograin/cases.h>

PETSC_INTERN const PgCaseInfo PgCasePanel, PgCasePacking, PgCaseBox;
PETSC_INTERN const PgCaseInfo PgCaseBedDarcy, PgCaseBedErgun, PgCaseBedNsToDarcy;
PETSC_INTERN const PgCaseInfo PgCaseColumn, PgCaseColumnHydrostatic, PgCaseColumnTerzaghi, PgCaseColumnSeepage,
    PgCaseUndrained;
PETSC_INTERN const PgCaseInfo PgCaseDiscCollision, PgCaseDiscOnPlane, PgCaseDiscOnIncline, PgCaseLatticeModulus,
    PgCaseBiaxial, PgCaseUpTerzaghi, PgCaseUpMandel, PgCaseUpFooting, PgCaseOperatorMms, PgCasePressureMms;
PETSC_INTERN const PgCaseInfo PgCaseWcsphPoiseuille, PgCaseWcsphCouette, PgCaseWcsphHydrostatic;

PETSC_INTERN const PgCaseInfo PgCaseTakTwoElements, PgCaseTakBlock;

/* Makes discs with ids [0, total), dealt out evenly: this rank gets `owned` of them from `first` on. Collective. */
PETSC_INTERN PetscErrorCode PgCaseDealDiscs(PgCaseSetup *setup, PetscInt64 total, PetscInt *first, PetscInt *owned);

/* What a case fills in for the discs of this rank. Addresses last until discs are made or fields added. */
typedef struct {
  PetscReal *x, *v, *radius; /* position [m], velocity [m/s], radius [m] */
  PetscReal *plate;          /* 1 + index of the plate that the disc belongs to, 0: of none [1] */
  PetscReal *side;           /* bits 1 << PG_SIDE_...; NULL in a dry run [1] */
  PetscReal *porosity;       /* of a disc at rest; NULL in a dry run [1] */
} PgCaseArrays;
PETSC_INTERN PetscErrorCode PgCaseGetArrays(const PgCaseSetup *setup, PgCaseArrays *arrays);

/* Makes a few discs, ids in the order of the table. Collective. */
typedef struct {
  PetscReal x[2], v[2], spin, radius; /* [m], [m/s], [rad/s], [m] */
} PgCaseDisc;
PETSC_INTERN PetscErrorCode PgCaseFewDiscs(PgCaseSetup *setup, PetscInt count, const PgCaseDisc disc[]);
PETSC_INTERN PetscReal      PgCaseDiscMass(const PgCaseSetup *setup, PetscReal radius);
/* Frees a context made by PetscNew(). */
PETSC_INTERN PetscErrorCode PgCaseDestroyContext(void **context);

/* Sets the options "-name value -name value ..." that the user has not given; to be called in `create`. An option
   whose name goes on from one that the user gave (-bc_top_pressure from -bc_top) is left out, too. Collective. */
PETSC_INTERN PetscErrorCode PgCaseDefaults(const char options[]);
