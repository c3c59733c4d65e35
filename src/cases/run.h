/* Steps, results and progress of a case that runs itself: what -dt, -end_time, -output_every, -history_every and -progress
   say, and what follows from it. */
#pragma once

#include "casesimpl.h"

typedef struct {
  MPI_Comm      comm;
  PetscReal     dt, end;        /* [s], 0: of the case */
  PetscReal     every, history; /* between snapshots, between rows [s], < 0: default */
  PetscInt      steps;
  PgOutput      output; /* NULL: none */
  PgMeter       meter;
  PgEndingWatch watch;
  int           ending; /* what has come up after the last step, as a sum of PgEnding */
} PgCaseRun;

/* The end of a run may be off a whole number of steps by this part of one, for rounding. */
#define PG_CASE_UNEVEN 1e-6

/* Reads the options; dt and end keep what they had where nothing is said. `more`, which may be NULL, reads further ones
   that belong to results. Collective, as all that follow but PgCaseRunDue(). */
typedef struct {
  const char *dt, *history; /* what the help says of their defaults */
  PetscErrorCode (*more)(void *context, PetscOptionItems *PetscOptionsObject);
  void *context;
} PgCaseRunTexts;
PETSC_INTERN PetscErrorCode PgCaseRunSetFromOptions(MPI_Comm comm, const PgCaseRunTexts *texts, PgCaseRun *run);
/* Chooses what has not been said, with dt and end as they are now: `rows` of history, 0: one each step. */
PETSC_INTERN PetscErrorCode PgCaseRunChooseSteps(PgCaseRun *run, PetscInt rows);
/* Due after `step`: a row of the history, a line on the terminal, a snapshot; the first and last of them if there are results. */
typedef struct {
  PetscBool row, line, snapshot;
} PgCaseRunDueNow;
PETSC_INTERN PgCaseRunDueNow PgCaseRunDue(const PgCaseRun *run, PetscInt step);
/* The clock starts, and signals are kept until PgEndingStop(), which follows also when the run has failed; `begun` steps
   have been done before. */
PETSC_INTERN PetscErrorCode PgCaseRunStart(PgCaseRun *run, PetscInt begun);
/* After each step: whether another one follows, or the run has reached its end, or an earlier one. */
PETSC_INTERN PetscErrorCode PgCaseRunGoesOn(PgCaseRun *run, PetscInt step, PetscBool *on);
/* Results of particles. */
PETSC_INTERN PetscErrorCode PgCaseRunWrite(PgCaseRun *run, PgCaseRunDueNow due, PetscReal time, const PetscReal row[]);
/* When the run has ended before its time: how to go on, and the status. As PgEndingTell() has it. */
PETSC_INTERN PetscErrorCode PgCaseRunTell(const PgCaseRun *run, PetscInt step, PetscReal time, const char file[],
                                          PetscInt held);
/* What `steps` of `count` things have cost, solves if any (NULL), and the files. */
PETSC_INTERN PetscErrorCode PgCaseRunSummary(const PgCaseRun *run, PetscInt steps, PetscInt count, const char one[],
                                             const PgSolves *solves, const char solved[]);
