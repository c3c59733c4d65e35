/* cases: set-up of one problem each: discs, plates, sides, initial porosity, end of the run. A case is
   registered by name; adding one is one file and one line in the table of cases.c. A case without time (operators on
   packings that are refined) does all of its work itself. */
#pragma once

#include <porograin/dem.h>
#include <porograin/fem.h>
#include <porograin/pore.h>
#include <porograin/wcsph.h>

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
  /* Makes the discs (PgParticlesSetDiscs and all fields that describe them), plates and boundary kinds. NULL in a case
     without time. Collective. */
  PetscErrorCode (*setup)(void *context, PgCaseSetup *setup);
  PetscErrorCode (*destroy)(void **context);
  /* A case without time, NULL in others: reads the options of what it makes, refuses those that nobody has read,
     prints its table and writes it beside `output` (FILE.h5 of -output; empty: nowhere). Fails when an order of
     convergence is missed. Collective. */
  PetscErrorCode (*run)(MPI_Comm comm, void *context, const char output[]);
} PgCaseInfo;

PETSC_EXTERN PetscErrorCode PgCaseFind(const char name[], const PgCaseInfo **info); /* NULL: unknown */
PETSC_EXTERN PetscErrorCode PgCaseGetNames(PetscInt *count, const char *const *names[]);

/* Sets mass from radius and density for all owned discs, and initial positions from positions. */
PETSC_EXTERN PetscErrorCode PgCaseFinishDiscs(PgCaseSetup *setup);

/* ---- manufactured solutions: the cases operator_mms and pressure_mms ---- */

/* A hexagonal packing about as high as wide, rows of points - 1 and points discs in turn as in the panel; all discs
   stand for the same area. */
typedef struct {
  PetscInt  points; /* discs in a longer row */
  PetscReal jitter; /* largest displacement of a disc in each direction over the spacing [1] */
  PetscInt  seed;   /* of the displacements */
} PgMmsPacking;

/* Relative L2 norms over the discs whose kernel is full, in a packing of width 1. `rest` is measured against k times the
   exact derivatives, k being what the operator makes of linear and quadratic fields on the lattice. */
typedef struct {
  PetscInt  n, fallbacks;            /* discs; rows whose correction fell back to the plain form */
  PetscReal h;                       /* smoothing length [1] */
  PetscReal gradient, laplacian;     /* against the exact derivatives */
  PetscReal gradient_k, laplacian_k; /* 1 for `corrected` */
  PetscReal gradient_rest, laplacian_rest;
} PgMmsOperatorErrors;
/* Reads the options of the operators, -sph_*. `check` (by all ranks alike): options that nobody has read are refused.
   Collective. */
PETSC_EXTERN PetscErrorCode PgMmsOperators(MPI_Comm comm, const PgMmsPacking *packing, PetscBool check,
                                           PgMmsOperatorErrors *errors);

typedef enum { PG_MMS_DIRICHLET, PG_MMS_NATURAL } PgMmsSides;
/* Relative to the L2 norm of q, the part of the exact pressure that is not linear (natural sides: that differs from its
   mean), over the discs whose pressure is free. The pressure found is size times q, and the rest. */
typedef struct {
  PetscInt  n, iterations;
  PetscReal h;       /* smoothing length, the square of free discs having width 1 [1] */
  PetscReal error;   /* against the exact pressure */
  PetscReal size;    /* of q in what was found, by least squares [1] */
  PetscReal shape;   /* error against size times q */
  PetscReal k;       /* as above, of the Laplacian */
  PetscReal removed; /* part of a singular right-hand side that was taken away, relative */
  PetscReal drift;   /* natural sides: change of the mean pressure, which is to be kept */
  PetscReal residual;
} PgMmsPressureErrors;
/* Reads -sph_* and -pressure_*. Collective. */
PETSC_EXTERN PetscErrorCode PgMmsPressure(MPI_Comm comm, const PgMmsPacking *packing, PgMmsSides sides, PetscBool check,
                                          PgMmsPressureErrors *errors);
/* The factor k of the paper's operators on the hexagonal lattice, h over radius and eta being given: the sum over the
   neighbours of r w'/2, in the Laplacian times r^2/(r^2 + eta h^2); eta = 0 is the gradient's, too. Not collective. */
PETSC_EXTERN PetscReal PgMmsLatticeFactor(const PgKernel *kernel, PetscReal smoothing, PetscReal eta);

/* ---- problems of the saturated continuum: up_terzaghi, up_mandel, up_footing ---- */

typedef struct PgUp_s *PgUp;
/* Reads the options of the problem and of its continuum (-up_*). Collective, as all that follow. */
PETSC_EXTERN PetscErrorCode PgUpCreate(MPI_Comm comm, const char name[], PgUp *up);
PETSC_EXTERN PetscErrorCode PgUpDestroy(PgUp *up);
PETSC_EXTERN PetscErrorCode PgUpGetFem(PgUp up, PgFem *fem);
PETSC_EXTERN PetscErrorCode PgUpSetUp(PgUp up);
/* Default time step and end [s]; after SetUp. */
PETSC_EXTERN PetscErrorCode PgUpGetTimes(PgUp up, PetscReal *dt, PetscReal *end);
PETSC_EXTERN PetscErrorCode PgUpGetSettlement(PgUp up, PetscReal *settlement); /* [m], downward */
PETSC_EXTERN PetscErrorCode PgUpGetProbe(PgUp up, PetscReal *pressure);        /* [Pa], where the case watches it */
/* All of a run of the program: set-up, steps, results, as -dt, -end_time and their kin say; output: FILE.h5 or empty. */
PETSC_EXTERN PetscErrorCode PgUpRun(PgUp up, const char output[]);

/* ---- problems of the weakly compressible liquid: wcsph_poiseuille, wcsph_couette, wcsph_hydrostatic ---- */

typedef struct PgLiquid_s *PgLiquid;
/* Reads the options of the problem and of its liquid (-wcsph_*). Collective, as all that follow. */
PETSC_EXTERN PetscErrorCode PgLiquidCreate(MPI_Comm comm, const char name[], PgLiquid *liquid);
PETSC_EXTERN PetscErrorCode PgLiquidDestroy(PgLiquid *liquid);
PETSC_EXTERN PetscErrorCode PgLiquidGetWcsph(PgLiquid liquid, PgWcsph *wcsph);
/* Makes the particles; after it `wcsph` can be stepped. */
PETSC_EXTERN PetscErrorCode PgLiquidSetUp(PgLiquid liquid);
/* Time step and end of the run [s]; after SetUp. */
PETSC_EXTERN PetscErrorCode PgLiquidGetTimes(PgLiquid liquid, PetscReal *dt, PetscReal *end);
/* Against the exact solution: relative L2 norm over the particles of the liquid, and the largest deviation over the speed
   of the flow or the pressure rho_0 |g| H. */
PETSC_EXTERN PetscErrorCode PgLiquidGetErrors(PgLiquid liquid, PetscReal *l2, PetscReal *most);
/* All of a run of the program: set-up, steps, results; output: FILE.h5 or empty. */
PETSC_EXTERN PetscErrorCode PgLiquidRun(PgLiquid liquid, const char output[]);
