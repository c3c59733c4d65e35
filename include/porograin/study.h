/* study: what porograin-study does. Compares solvers of the pressure equation with each other on systems of
   growing size, the operators with exact fields, explicit sweeps with the solved pressure inside a run, and
   kept preconditioners over thousands of steps. Every study prints tables and, with -study_output, writes
   them as CSV and HDF5. */
#pragma once

#include <porograin/simulation.h>

typedef struct PgStudy_s *PgStudy;

/* Collective, all of them. */
PETSC_EXTERN PetscErrorCode PgStudyCreate(MPI_Comm comm, PgStudy *study);
/* Reads -study solvers|mms|explicit|stepping, -study_output and the -study_* options of that study; those of all
   studies when help is asked for. */
PETSC_EXTERN PetscErrorCode PgStudySetFromOptions(PgStudy study);
/* Makes all options of all studies, and of the runs in them, known, for help and for messages (PgProgram). */
PETSC_EXTERN PetscErrorCode PgStudyMentionOptions(MPI_Comm comm);
PETSC_EXTERN PetscErrorCode PgStudyRun(PgStudy study);
PETSC_EXTERN PetscErrorCode PgStudyDestroy(PgStudy *study);

/* Least-squares exponent g of count ~ size^g over the entries with a positive count; NaN with less than two different
   sizes. */
PETSC_EXTERN PetscReal PgStudyGrowth(PetscInt entries, const PetscReal size[], const PetscReal count[]);
