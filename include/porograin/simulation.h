/* simulation: the order of one step, sub-cycling, the time loop, monitors and observables. No formulas of
   contacts or water. */
#pragma once

#include <porograin/cases.h>
#include <porograin/io.h>

typedef struct PgSimulation_s *PgSimulation;

/* Collective, all of them. */
PETSC_EXTERN PetscErrorCode PgSimulationCreate(MPI_Comm comm, PgSimulation *simulation);
/* Reads -case, -fluid, -dt, -dt_safety, -fluid_every, -end_time, -gravity, -solid_density, -output*,
   -history_every, -progress_every, -guard_every, -checkpoint, -checkpoint_every, -restart, -wall_time and, through the rooms, everything else. */
PETSC_EXTERN PetscErrorCode PgSimulationSetFromOptions(PgSimulation simulation);
/* Makes all options of all cases known, for help and for messages (PgProgram). Collective. */
PETSC_EXTERN PetscErrorCode PgSimulationMentionOptions(MPI_Comm comm);
/* Does the work of a case without time (see PgCaseInfo) in place of set-up, view and run; *done is false, and nothing
   happened, when the case has steps. After PgSimulationSetFromOptions(). */
PETSC_EXTERN PetscErrorCode PgSimulationRunCase(PgSimulation simulation, PetscBool *done);
/* Makes the discs, lists and first geometry, chooses or checks the time step, sets up the solver, refuses
   unknown options, and only then opens the output. */
PETSC_EXTERN PetscErrorCode PgSimulationSetUp(PgSimulation simulation);
PETSC_EXTERN PetscErrorCode PgSimulationView(PgSimulation simulation, PetscViewer viewer);
/* Steps to the end time with history, snapshots, progress lines, guards and checkpoints, or until a signal or
   -wall_time ends it. A failure leaves FILE-postmortem.h5 behind. */
PETSC_EXTERN PetscErrorCode PgSimulationRun(PgSimulation simulation);
/* Writes a checkpoint of the present step to -checkpoint FILE, unless there is one already. Partition, lists and
   preconditioner are made anew, as a run that goes on from the file will do. */
PETSC_EXTERN PetscErrorCode PgSimulationCheckpoint(PgSimulation simulation);
/* One fluid step: -fluid_every steps of the discs and one of the water (a dry run: the discs alone). */
PETSC_EXTERN PetscErrorCode PgSimulationStep(PgSimulation simulation);
PETSC_EXTERN PetscErrorCode PgSimulationDestroy(PgSimulation *simulation);

/* Rebuilds the lists now, keeping histories; what is derived from them is recomputed. */
PETSC_EXTERN PetscErrorCode PgSimulationBuildLists(PgSimulation simulation);
PETSC_EXTERN PetscErrorCode PgSimulationGetParts(PgSimulation simulation, PgParticles *particles,
                                                 PgNeighbors *neighbors, PgDem *dem, PgPore *pore);
PETSC_EXTERN PetscErrorCode PgSimulationGetTime(PgSimulation simulation, PetscInt *step, PetscReal *time,
                                                PetscReal *dt);

/* Nominal strain of every disc in the order of permanent ids (owned id range): from the best-fit
   deformation gradient F of its neighbours at the start, volumetric strain det F - 1 and effective strain
   sqrt(2/3 e:e), e the deviator of the Green-Lagrange strain. */
typedef struct PgStrain_s  *PgStrain;
PETSC_EXTERN PetscErrorCode PgStrainCreate(PgParticles particles, PgNeighbors neighbors, PgStrain *strain);
PETSC_EXTERN PetscErrorCode PgStrainCompute(PgStrain strain, PetscReal effective[], PetscReal volumetric[]);
PETSC_EXTERN PetscErrorCode PgStrainDestroy(PgStrain *strain);
