/* What the files of this room share. */
#pragma once

#include <porograin/simulation.h>

/* Columns of the history, in the order of files. */
typedef enum {
  COLUMN_TIME,
  COLUMN_DISPLACEMENT,
  COLUMN_LOAD,
  COLUMN_LOAD_TOTAL,
  COLUMN_KINETIC_ENERGY,
  COLUMN_PRESSURE_MIN,
  COLUMN_PRESSURE_MEAN,
  COLUMN_PRESSURE_MAX,
  COLUMN_PRESSURE_ITERATIONS,
  COLUMN_PRESSURE_RESIDUAL,
  COLUMN_PRESSURE_REMOVED,
  COLUMN_RELATIVE_SPEED,
  COLUMN_SURFACE,
  COLUMN_DETACHED,
  COLUMN_CLIPPED,
  COLUMN_CHARACTERISTIC,
  COLUMN_LIST_BUILDS,
  COLUMN_COUNT
} PgColumnIndex;
PETSC_INTERN const PgColumn PgHistoryColumns[COLUMN_COUNT];

struct PgSimulation_s {
  MPI_Comm    comm;
  PgParticles particles;
  PgNeighbors neighbors;
  PgDem       dem;
  PgPore      pore; /* NULL when dry */
  PgFluid     fluid;
  PgStrain    strain;
  PgOutput    output; /* NULL without -output */

  const PgCaseInfo *case_info;
  void             *case_context;
  PgCaseSetup       setup;

  /* time */
  PetscReal dt;          /* step of the discs [s] */
  PetscReal dt_critical; /* at the start [s] */
  PetscReal dt_safety;   /* dt/dt_critical when -dt is absent */
  PetscInt  fluid_every; /* steps of the discs in a fluid step */
  PetscInt  step, steps; /* fluid steps done and in all */
  PetscReal time;        /* [s] */
  PetscBool dt_set, end_set;

  /* monitors, in fluid steps; 0 is never */
  char           output_file[PETSC_MAX_PATH_LEN];
  PetscReal      output_time, history_time, progress_time; /* as asked [s], < 0: default */
  PetscInt       output_every, history_every, progress_every, guard_every;
  PetscReal      row[COLUMN_COUNT];
  PetscReal      peak_load, peak_displacement;
  PetscLogDouble started, last_progress;
  PetscInt       last_progress_step;
  PetscReal     *effective, *volumetric; /* strain by id, scratch */
};

PETSC_INTERN PetscErrorCode PgMonitorStart(PgSimulation sim);
PETSC_INTERN PetscErrorCode PgMonitorStep(PgSimulation sim);
PETSC_INTERN PetscErrorCode PgMonitorEnd(PgSimulation sim);
PETSC_INTERN PetscErrorCode PgSimulationGuard(PgSimulation sim);
/* Whether the row of the present step goes into the history. */
PETSC_INTERN PetscBool PgMonitorDue(PgSimulation sim, PetscInt every);
