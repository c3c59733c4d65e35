/* pore: the water between the discs. Porosity, drag, the characteristic-based SPH schemes for the
   averaged Navier-Stokes equations and for Darcy's law (Li, Chu & Sheng 2007, Eqs. 18-66), boundary
   kinds, and the force of the water on the discs. Does not know how the pressure is solved, nor files. */
#pragma once

#include <porograin/pressure.h>

typedef struct PgPore_s *PgPore;

typedef enum { PG_FLUID_NONE, PG_FLUID_DARCY, PG_FLUID_NS } PgFluid;

typedef enum { PG_SIDE_LEFT, PG_SIDE_RIGHT, PG_SIDE_BOTTOM, PG_SIDE_TOP, PG_SIDE_COUNT } PgSide;
typedef enum { PG_BC_DRAINED, PG_BC_IMPERMEABLE, PG_BC_FLUX, PG_BC_NATURAL } PgBoundaryKind;
typedef struct {
  PgBoundaryKind kind;
  PetscReal      pressure; /* of a drained side [Pa] */
  PetscReal      flux;     /* Darcy velocity through a flux side along the positive axis [m/s] */
} PgBoundary;

typedef struct {
  PgPressureStats pressure;
  PetscReal       p_min, p_mean, p_max;    /* [Pa] */
  PetscReal       w_max;                   /* largest |n (u - v)| [m/s] */
  PetscInt        surface;                 /* discs on a drained surface by tracking */
  PetscInt        detached;                /* discs outside the water */
  PetscInt        characteristic_failures; /* discs whose matrix B could not be inverted, Eq. 38 */
  PetscInt        clipped;                 /* porosities clipped in this step */
} PgPoreStats;

/* Drag of the discs on the water per unit volume of water, F^sf = beta (v - u), Eqs. 20-23. */
typedef struct {
  const char *name, *citation;
  PetscReal (*beta)(PetscReal n, PetscReal diameter, PetscReal speed, PetscReal rho_f, PetscReal mu); /* [N s/m4] */
} PgDragLaw;
PETSC_EXTERN PetscErrorCode PgDragLawFind(const char name[], const PgDragLaw **law);

/* Area of the lens common to two circles of radii R and r with centres d apart [m2]. */
PETSC_EXTERN PetscReal PgLensArea(PetscReal R, PetscReal r, PetscReal d);

/* Registers the fields porosity, fluid_velocity, relative_velocity, side (bit s set: formed side s at the
   start) and its working fields; creates its sph and pressure objects. Collective. */
PETSC_EXTERN PetscErrorCode PgPoreCreate(PgParticles particles, PgNeighbors neighbors, PgFluid fluid, PgPore *pore);
/* Reads -fluid_density, -fluid_viscosity, -permeability, -permeability_law, -ns_*, -coupling*,
   -porosity*, -bc_*, -detach_* and, through its parts, -sph_* and -pressure*. Collective. */
PETSC_EXTERN PetscErrorCode PgPoreSetFromOptions(PgPore pore);
PETSC_EXTERN PetscErrorCode PgPoreView(PgPore pore, PetscViewer viewer);
PETSC_EXTERN PetscErrorCode PgPoreDestroy(PgPore *pore);
PETSC_EXTERN PetscErrorCode PgPoreSetGravity(PgPore pore, const PetscReal gravity[2]); /* [m/s2] */
/* Density of the discs [kg/m3], of the two-phase projection. */
PETSC_EXTERN PetscErrorCode PgPoreSetSolidDensity(PgPore pore, PetscReal rho_s);
PETSC_EXTERN PetscErrorCode PgPoreSetBoundary(PgPore pore, PgSide side, const PgBoundary *boundary);
PETSC_EXTERN PetscErrorCode PgPoreGetBoundary(PgPore pore, PgSide side, PgBoundary *boundary);
PETSC_EXTERN PetscErrorCode PgPoreGetParts(PgPore pore, PgSph *sph, PgPressure *pressure);
/* Uniform initial pressure [Pa]; from -initial_pressure, or set by the case. */
PETSC_EXTERN PetscErrorCode PgPoreSetInitialPressure(PgPore pore, PetscReal pressure);

/* Calibrates the porosity to the field "initial_porosity" that the case has filled, sets pressures and
   velocities, and computes the first geometry. Needs built lists and current ghosts. Collective. */
PETSC_EXTERN PetscErrorCode PgPoreSetUp(PgPore pore, PetscReal dt_f);
/* The same for a run that goes on from a checkpoint: all fields are there, nothing is calibrated or reset.
   Collective. */
PETSC_EXTERN PetscErrorCode PgPoreRestart(PgPore pore);
/* Refuses restored values that no run can have produced: porosities, sides. Collective. */
PETSC_EXTERN PetscErrorCode PgPoreCheckState(PgPore pore, const char file[]);
/* Recomputes geometry, gradients and ghosts from the state as it is: after a list build between two fluid
   steps, and after a restart. Collective. */
PETSC_EXTERN PetscErrorCode PgPoreRefresh(PgPore pore);
/* Refuses, or warns of, choices that are unstable with a fluid step of dt_f. Collective. */
PETSC_EXTERN PetscErrorCode PgPoreCheckStep(PgPore pore, PetscReal dt_f);
/* Start of a fluid step of length dt_f: drag and intermediate state from the geometry of t_n; fills
   "fluid_force", which acts on the discs until the end of the step. Collective. */
PETSC_EXTERN PetscErrorCode PgPorePredict(PgPore pore, PetscReal dt_f);
/* End of the fluid step, discs moved and lists and ghosts current: new porosity and geometry, pressure,
   velocities; with the two-phase projection the discs' velocities too. Collective. */
PETSC_EXTERN PetscErrorCode PgPoreCorrect(PgPore pore, PetscReal dt_f);
PETSC_EXTERN PetscErrorCode PgPoreGetStats(PgPore pore, PgPoreStats *stats);
/* What in the water may be behind a failure that somebody else has noticed: its worst disc when it is beyond the bounds of
   the guard, or when a setting is known to be unstable; else an empty text. For PgSetCause(), `pore` is a PgPore.
   Collective. */
PETSC_EXTERN PetscErrorCode PgPoreFindCause(void *pore, char cause[], size_t size);
/* Stops the run when a pressure or velocity is not finite or beyond -pore_guard_pressure,
   -pore_guard_speed, or when more than -pore_guard_clipped of the porosities are out of range. Collective. */
PETSC_EXTERN PetscErrorCode PgPoreGuard(PgPore pore, PetscInt step, PetscReal time);
