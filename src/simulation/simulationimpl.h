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
  PetscReal dt;           /* step of the discs [s] */
  PetscReal dt_critical;  /* at the start [s] */
  PetscReal disc_sums[2]; /* of radii [m] and masses [kg/m], as the case made them */
  PetscReal dt_safety;    /* dt/dt_critical when -dt is absent */
  PetscInt  fluid_every;  /* steps of the discs in a fluid step */
  PetscInt  step, steps;  /* fluid steps done and in all */
  PetscReal time;         /* [s] */
  PetscBool dt_set, end_set;

  /* monitors, in fluid steps; 0 is never */
  char           output_file[PETSC_MAX_PATH_LEN];
  PetscReal      output_time, history_time, progress_time; /* as asked [s], < 0: default */
  PetscInt       output_every, history_every, progress_every, guard_every;
  PetscInt       columns, wall_column; /* of the history; the first of the walls */
  PgColumn      *column;
  PetscReal     *row; /* of the present step */
  PetscReal      peak_load, peak_displacement;
  PgMeter        meter;
  PetscLogDouble last_progress;          /* the clock at the last line [s] */
  PetscInt       last_progress_step;     /* the step of that line */
  PetscInt       checkpoints;            /* written by this program */
  PetscReal     *effective, *volumetric; /* strain by id, scratch */
  PetscReal     *porosity;               /* by id, scratch; of runs without water */
  PgField        porosity_start;         /* -1: water has its own, or nobody asks for it */

  /* restart and end */
  char          case_name[64], fluid_name[16]; /* as checkpoints know them */
  char          checkpoint_file[PETSC_MAX_PATH_LEN], restart_file[PETSC_MAX_PATH_LEN];
  PetscReal     checkpoint_time;  /* between checkpoints, as asked [s], < 0: default */
  PetscInt      checkpoint_every; /* [fluid steps] */
  PetscInt      checkpoint_step;  /* of the last one, -1: none */
  PetscInt      builds_before;    /* list builds of the run that this program did not make itself */
  PetscInt      rows, snapshots;  /* in the result file at the checkpoint */
  char          run[PG_RUN_NAME]; /* of the result file */
  PgEndingWatch watch;            /* its steps are fluid steps */
};

/* simulation.c: names of PgFluid */
PETSC_INTERN const char *const PgFluidWords[3];

/* restart.c */
/* Takes the discs of the checkpoint, placed where they were at the start of the run. */
PETSC_INTERN PetscErrorCode PgRestartBegin(PgSimulation sim, PgCheckpoint *checkpoint);
/* Lists, histories and state of the time of the checkpoint; with it the checkpoint is closed. */
PETSC_INTERN PetscErrorCode PgRestartFinish(PgSimulation sim, PgCheckpoint *checkpoint);

/* postmortem.c: the state of a run that has failed, as a result file of its own. Collective. */
PETSC_INTERN PetscErrorCode PgPostMortem(PgSimulation sim);

/* columns.c: which columns this run has; those beyond the fixed ones of the present step */
PETSC_INTERN PetscErrorCode PgColumnsSetUp(PgSimulation sim);
PETSC_INTERN PetscErrorCode PgColumnsFill(PgSimulation sim);
PETSC_INTERN PetscErrorCode PgColumnsDestroy(PgSimulation sim);

PETSC_INTERN PetscErrorCode PgMonitorStart(PgSimulation sim);
PETSC_INTERN PetscErrorCode PgMonitorStep(PgSimulation sim);
PETSC_INTERN PetscErrorCode PgMonitorEnd(PgSimulation sim);
/* Computes the row of the present step; the snapshot of it goes into `output`. */
PETSC_INTERN PetscErrorCode PgMonitorFillRow(PgSimulation sim);
PETSC_INTERN PetscErrorCode PgMonitorSnapshot(PgSimulation sim, PgOutput output);
/* List builds since the start of the run, also before a restart. */
PETSC_INTERN PetscErrorCode PgMonitorGetBuilds(PgSimulation sim, PetscInt *builds);
PETSC_INTERN PetscErrorCode PgSimulationGuard(PgSimulation sim);
/* rules.c: refuses options that are unknown or have no effect. Collective. */
PETSC_INTERN PetscErrorCode PgSimulationCheckOptions(PgSimulation sim);

/* progress.c: how far the run is, as lines or as a bar, and the summary at its end */
/* Reads -progress and -progress_every. */
PETSC_INTERN PetscErrorCode PgProgressSetFromOptions(PgSimulation sim, PetscOptionItems *PetscOptionsObject);
PETSC_INTERN PetscErrorCode PgProgressStart(PgSimulation sim);
/* A line from the row of the present step. */
PETSC_INTERN PetscErrorCode PgProgressLine(PgSimulation sim);
/* The bar, when it is its turn; called after every step. Not collective. */
PETSC_INTERN PetscErrorCode PgProgressBar(PgSimulation sim);
PETSC_INTERN PetscErrorCode PgProgressSummary(PgSimulation sim);
/* Whether the row of the present step goes into the history. */
PETSC_INTERN PetscBool PgMonitorDue(PgSimulation sim, PetscInt every);
