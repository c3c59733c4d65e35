/* What the two examples of Tak, Park & Park (2013) share: a liquid by particles on a lattice, bodies, their steps, results. */
#pragma once

#include "run.h"
#include <porograin/bodies.h>

typedef struct {
  MPI_Comm  comm;
  PgWcsph   wcsph;
  PgBodies  bodies;
  PetscReal dx; /* spacing of the lattice [m] */
  PetscInt  step;
  PgCaseRun run;
} PgTak;

/* Liquid and bodies with their options, -dt and its kin. */
PETSC_INTERN PetscErrorCode PgTakCreate(MPI_Comm comm, PgTak *tak);
PETSC_INTERN PetscErrorCode PgTakDestroy(PgTak *tak);
PETSC_INTERN PetscErrorCode PgTakRunOptions(PgTak *tak, PetscReal end);
/* columns x rows particles from `low` on; liquid leaves out where bodies are. */
PETSC_INTERN PetscErrorCode PgTakAddBlock(PgTak *tak, PgWcsphKind kind, PetscInt body, const PetscReal low[2],
                                          PetscInt columns, PetscInt rows);
PETSC_INTERN PetscErrorCode PgTakChooseSteps(PgTak *tak); /* after PgWcsphSetUp() */
/* Refuses unread options and those without effect, by the case's own rules, too; makes the result file. */
PETSC_INTERN PetscErrorCode PgTakStart(PgTak *tak, const char output[], PetscInt columns, const PgColumn column[],
                                       const PgOptionRules *rules, PetscErrorCode (*probe)(void *), void *context);
/* What the run has cost, and its files; `solves` of what else is in it, which may be NULL. Collective. */
PETSC_INTERN PetscErrorCode PgTakSummary(PgTak *tak, const PgSolves *solves);
/* One step of liquid and bodies. */
PETSC_INTERN PetscErrorCode PgTakStep(PgTak *tak);
