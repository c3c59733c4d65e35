/* fem: a saturated porous continuum in plane strain, displacement of the skeleton and pore pressure as unknowns, by
   finite elements on quadrilaterals (Tak, Park & Park 2013, Eqs. 1-11; docs/theory.md, section 12). Mesh, partition and
   numbering are PETSc's DMPlex and PetscSection. Knows options and result files, nothing of particles.

   Stress is positive in tension, pressure in compression; all per metre of thickness; displacements are small.

   Life of an object: Create; SetBox or SetMeshFile; settings, materials, conditions, or SetFromOptions; SetUp; Step as
   often as wanted; Get...; Destroy. Several may live side by side, each with its mesh and its time. */
#pragma once

#include <porograin/io.h>
#include <petscmat.h>

typedef struct PgFem_s *PgFem;

/* Displacement and pressure on one cell. */
typedef enum {
  PG_FEM_Q1Q1, /* both bilinear, stabilised by polynomial pressure projection (Bochev & Dohrmann 2004) */
  PG_FEM_Q2Q1, /* biquadratic and bilinear (Taylor & Hood 1973): stable as it is */
  PG_FEM_Q1    /* bilinear displacement alone, the water locked in its pores: it locks, and is here to show it */
} PgFemElement;

typedef struct {
  PetscReal E, nu;        /* Young's modulus [Pa] and Poisson's ratio [1] of the drained skeleton; -1 < nu < 0.5 */
  PetscReal alpha;        /* Biot's constant, n <= alpha <= 1 [1] */
  PetscReal K_s, K_f;     /* bulk moduli of grains and water [Pa] */
  PetscReal n;            /* porosity, 0 < n < 1 [1] */
  PetscReal k;            /* intrinsic permeability, >= 0 [m2]; 0: impermeable */
  PetscReal mu_f;         /* viscosity of the water [Pa s] */
  PetscReal rho_s, rho_f; /* densities of grains and water [kg/m3] */
} PgFemMaterial;
/* E 1e7, nu 0.2, alpha 1, K_s = K_f = 1e14, n 0.3, k 1e-12, mu_f 1e-3, rho_s 2000, rho_f 1000. */
PETSC_EXTERN void PgFemMaterialDefault(PgFemMaterial *material);
/* Refuses what is no material, naming the quantity; `where` goes into the message. Collective on comm. */
PETSC_EXTERN PetscErrorCode PgFemMaterialCheck(MPI_Comm comm, const char where[], const PgFemMaterial *material);
PETSC_EXTERN PetscReal      PgFemConstrainedModulus(const PgFemMaterial *material); /* M = lambda + 2 G [Pa] */
PETSC_EXTERN PetscReal      PgFemShearModulus(const PgFemMaterial *material);       /* G [Pa] */
PETSC_EXTERN PetscReal      PgFemStorage(const PgFemMaterial *material); /* (alpha - n)/K_s + n/K_f [1/Pa], Eq. 9 */
/* c_v = k/mu_f / (storage + alpha^2/M) [m2/s], of consolidation without lateral strain. */
PETSC_EXTERN PetscReal PgFemConsolidation(const PgFemMaterial *material);

/* ---- making one ---- */

PETSC_EXTERN PetscErrorCode PgFemCreate(MPI_Comm comm, PgFem *fem); /* collective */
PETSC_EXTERN PetscErrorCode PgFemDestroy(PgFem *fem);
/* Rectangle low..high [m] of cells[0] x cells[1] quadrilaterals, sides left, right, bottom, top; one region "1". */
PETSC_EXTERN PetscErrorCode PgFemSetBox(PgFem fem, const PetscInt cells[2], const PetscReal low[2],
                                        const PetscReal high[2]);
/* A Gmsh file (MSH 2.2, 4.0, 4.1) of quadrilaterals of the first order in the plane z = 0. Boundaries and regions are
   its physical curves and surfaces, known by name, or by number when they have none. */
PETSC_EXTERN PetscErrorCode PgFemSetMeshFile(PgFem fem, const char file[]);
/* Moves the vertices of the mesh before anything is made of it: to grade or distort it. Called for every vertex, on
   every rank that has it, and must give the same everywhere. */
typedef void (*PgFemMap)(void *context, PetscReal x[2]);
PETSC_EXTERN PetscErrorCode PgFemSetMap(PgFem fem, PgFemMap map, void *context);

PETSC_EXTERN PetscErrorCode PgFemSetElement(PgFem fem, PgFemElement element);
/* Pressure projection of Q1-Q1 with tau = factor/M (default 3; 0: none). */
PETSC_EXTERN PetscErrorCode PgFemSetStabilisation(PgFem fem, PetscReal factor);
/* Generalised trapezoidal rule, 0.5 <= theta <= 1; the first `start` steps use 1 whatever theta is, since loads
   applied at once do not fit the state at rest; with inertia the first one at least. Default 1, 0. */
PETSC_EXTERN PetscErrorCode PgFemSetTheta(PgFem fem, PetscReal theta, PetscInt start);
/* Inertia of the mixture, and a damping in proportion to mass [1/s]. Default off. */
PETSC_EXTERN PetscErrorCode PgFemSetInertia(PgFem fem, PetscBool inertia, PetscReal damping);
PETSC_EXTERN PetscErrorCode PgFemSetGravity(PgFem fem, const PetscReal gravity[2]); /* [m/s2] */
/* Of one region; region NULL: of all that have none of their own. */
PETSC_EXTERN PetscErrorCode PgFemSetMaterial(PgFem fem, const char region[], const PgFemMaterial *material);
PETSC_EXTERN PetscErrorCode PgFemGetMaterial(PgFem fem, PgFemMaterial *material); /* the one of region NULL */

/* What may be said of a boundary. Where nothing is said it is free of load and lets no water through. */
typedef enum {
  PG_FEM_DISPLACEMENT_X, /* [m] */
  PG_FEM_DISPLACEMENT_Y,
  PG_FEM_PRESSURE,      /* of the water [Pa] */
  PG_FEM_TRACTION,      /* of the mixture, two values [Pa] */
  PG_FEM_NORMAL_STRESS, /* of the mixture, along the outward normal, tension positive [Pa] */
  PG_FEM_FLUX,          /* water that leaves, n v_fs . n [m/s] */
  PG_FEM_PLATE_X,       /* total force of a rigid smooth plate, which moves as one along x [N/m] */
  PG_FEM_PLATE_Y
} PgFemQuantity;
/* Value of a condition, which may depend on time and place. Called for places of this rank alone. */
typedef void (*PgFemFunction)(void *context, PetscReal time, const PetscReal x[2], PetscReal value[2]);
/* Adds a condition; of two that prescribe the same at a node, the later one holds. Loads add up. Boundaries that the
   mesh does not have are found by PgFemSetUp(), which says which there are. */
PETSC_EXTERN PetscErrorCode PgFemSetCondition(PgFem fem, const char boundary[], PgFemQuantity quantity,
                                              const PetscReal value[]);
PETSC_EXTERN PetscErrorCode PgFemSetConditionFunction(PgFem fem, const char boundary[], PgFemQuantity quantity,
                                                      PgFemFunction function, void *context);
/* A load (traction, normal stress, flux) on the part of a boundary inside the rectangle low..high [m]. It is integrated
   to the edges of the rectangle, which may cut cells, so that the whole load arrives on any mesh: what jumps should be
   said in this way, a function is sampled at three points of a side. */
PETSC_EXTERN PetscErrorCode PgFemSetLoadWithin(PgFem fem, const char boundary[], PgFemQuantity quantity,
                                               const PetscReal low[2], const PetscReal high[2],
                                               const PetscReal value[]);
/* u and p at t = 0; default zero. Values 0, 1: displacement [m], 2: pressure [Pa]. */
PETSC_EXTERN PetscErrorCode PgFemSetInitial(PgFem fem,
                                            void (*initial)(void *context, const PetscReal x[2], PetscReal value[3]),
                                            void *context);

/* Options -up_*: element, material, time integration, mesh, solver. Collective. */
PETSC_EXTERN PetscErrorCode PgFemSetFromOptions(PgFem fem);
/* Mesh, partition, numbering. Refuses, naming the culprit: a file that is no mesh, cells that are no convex
   quadrilaterals, boundaries and regions that do not exist, a continuum that nothing holds. Collective. */
PETSC_EXTERN PetscErrorCode PgFemSetUp(PgFem fem);
/* Makes the matrix and the solver for steps of dt, as the first step would: so that all options are read. */
PETSC_EXTERN PetscErrorCode PgFemSetUpSolver(PgFem fem, PetscReal dt);
PETSC_EXTERN PetscErrorCode PgFemView(PgFem fem, PetscViewer viewer);
/* For PgOptionsCheckUnused(). */
PETSC_EXTERN PetscErrorCode PgFemProbeOptions(void *fem);

/* ---- stepping ---- */

/* One step of dt [s]. The matrix and its preconditioner are kept while dt and theta stay. A solve that fails is an
   error of the run unless PgFemSetErrorIfNotConverged() says otherwise. Collective. */
PETSC_EXTERN PetscErrorCode PgFemStep(PgFem fem, PetscReal dt);
typedef struct {
  PetscInt  iterations, unknowns;
  PetscInt  reason;   /* a KSPConvergedReason */
  PetscReal residual; /* of the last solve, recomputed, over its right-hand side */
} PgFemStats;
PETSC_EXTERN PetscErrorCode PgFemGetStats(PgFem fem, PgFemStats *stats);
PETSC_EXTERN PetscErrorCode PgFemSetErrorIfNotConverged(PgFem fem, PetscBool error);
PETSC_EXTERN PetscErrorCode PgFemGetTime(PgFem fem, PetscInt *step, PetscReal *time);

/* The system of the present step, for studies of it: A w = b with the pressure in units of `scale` [Pa]; rows of held
   unknowns hold a diagonal alone; P stands for the Schur complement. All is borrowed. After PgFemSetUpSolver(). */
typedef struct {
  Mat       A, P;
  IS        displacement, pressure;
  PetscReal scale;
} PgFemSystem;
PETSC_EXTERN PetscErrorCode PgFemGetSystem(PgFem fem, PgFemSystem *system);

/* ---- loads that come from elsewhere, such as particles ---- */

/* The pieces of a boundary that this rank integrates; every piece is with one rank. Addresses last until the object
   ends. */
typedef struct {
  PetscInt        count;
  const PetscInt *node; /* (count, 2) numbers of the end points among the nodes of this rank, interior on the left */
} PgFemEdges;
PETSC_EXTERN PetscErrorCode PgFemGetEdges(PgFem fem, const char boundary[], PgFemEdges *edges);
/* Traction on each piece of a boundary from now on, (count, 2) [Pa], beside its conditions; zero before. */
PETSC_EXTERN PetscErrorCode PgFemSetEdgeTraction(PgFem fem, const char boundary[], const PetscReal traction[]);
/* Forces on the nodes of this rank from now on, (nodes, 2) [N/m]; what ranks give for a common node adds up. */
PETSC_EXTERN PetscErrorCode PgFemSetNodalForces(PgFem fem, const PetscReal force[]);

/* ---- what has become of it ---- */

/* Vertices and cells of the whole mesh. */
PETSC_EXTERN PetscErrorCode PgFemGetSizes(PgFem fem, PetscInt *nodes, PetscInt *cells);
/* Vertices of this rank, those shared with others among them. */
typedef struct {
  PetscInt         count;
  const PetscInt  *number;       /* (count) in the whole mesh */
  const PetscBool *owned;        /* (count) each vertex is owned by one rank */
  const PetscReal *x;            /* (count, 2) [m] */
  const PetscReal *displacement; /* (count, 2) [m] */
  const PetscReal *velocity;     /* (count, 2) [m/s] */
  const PetscReal *pressure;     /* (count) [Pa] */
} PgFemNodes;
/* Addresses last until the object ends, values until the next step. */
PETSC_EXTERN PetscErrorCode PgFemGetNodes(PgFem fem, PgFemNodes *nodes);
/* A point inside a cell. Stress is that of the skeleton, sigma'' (xx, yy, xy); flux is n v_fs. */
typedef struct {
  PetscReal x[2], displacement[2], pressure, volumetric_strain, stress[3], flux[2], dV;
  PetscInt  cell; /* of this rank */
} PgFemPoint;
/* result[k] = sum over all quadrature points of dV times value[k]. Collective. */
PETSC_EXTERN PetscErrorCode PgFemIntegrate(PgFem fem, PetscInt count,
                                           void (*integrand)(void *context, const PgFemPoint *point, PetscReal value[]),
                                           void *context, PetscReal result[]);
/* Way of the plate of a condition PG_FEM_PLATE_X or _Y [m]. */
PETSC_EXTERN PetscErrorCode PgFemGetPlate(PgFem fem, const char boundary[], PetscReal *displacement);

/* ---- result files ---- */

/* Creates FILE.h5, FILE.xmf and FILE.csv with the mesh and these columns of history. Collective. */
PETSC_EXTERN PetscErrorCode PgFemCreateOutput(PgFem fem, const char file[], PetscInt columns, const PgColumn column[],
                                              PgOutput *output);
/* The same for a run that goes on: from what it had written so far, see PgOutputContinue(); NULL: from the start. */
typedef struct {
  char        run[PG_RUN_NAME];
  PetscInt    rows, snapshots;
  const char *from;
} PgFemResults;
PETSC_EXTERN PetscErrorCode PgFemContinueOutput(PgFem fem, const char file[], PetscInt columns, const PgColumn column[],
                                                const PgFemResults *before, PgOutput *output);
/* Adds a snapshot: displacement, velocity, pressure of the nodes; effective_stress, flux, volumetric_strain of the
   cells, as means. Everything is in the order of the whole mesh, whatever the number of ranks. Collective. */
PETSC_EXTERN PetscErrorCode PgFemSnapshot(PgFem fem, PgOutput output);

/* ---- checkpoints ---- */

/* Adds all that later steps depend on, as values of the whole mesh, and the mesh itself, which must be the same; on any
   number of ranks. Addresses last until the object ends, values until the next step. After PgFemSetUp(). Collective. */
PETSC_EXTERN PetscErrorCode PgFemAddState(PgFem fem, PgState state);
/* Goes on from what has been read to the addresses of PgFemAddState(). */
PETSC_EXTERN PetscErrorCode PgFemTakeState(PgFem fem);
