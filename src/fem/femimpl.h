/* What the files of this room share.

   A cell has `un` nodes of displacement, 4 or 9: its vertices counter-clockwise, the middles of its edges 0-1, 1-2, 2-3,
   3-0, its centre; and 4 of pressure, its vertices. Its unknowns are ordered ux, uy of node 0, of node 1, ..., then p of
   vertices 0 to 3. The geometry is bilinear whatever the element. */
#pragma once

#include <porograin/fem.h>
#include <petscdmplex.h>
#include <petscksp.h>
#include <petscsf.h>

enum { PG_FEM_NAME = 64, PG_FEM_UN = 9, PG_FEM_DOFS = 2 * PG_FEM_UN + 4, PG_FEM_POINTS = 9 };

typedef struct {
  char          boundary[PG_FEM_NAME];
  PgFemQuantity quantity;
  PetscReal     value[2];
  PgFemFunction function; /* NULL: the value */
  void         *context;
  PetscBool     within;          /* a load on the part of the boundary in this rectangle alone */
  PetscReal     low[2], high[2]; /* [m] */
  PetscInt      at;              /* number of the boundary in the mesh */
} PgFemCondition;

/* A piece of a boundary. */
typedef struct {
  PetscInt cell, side; /* of this rank; side s runs from vertex s to vertex s + 1 */
} PgFemSide;

typedef struct {
  char       name[PG_FEM_NAME];
  PetscInt   tag;      /* of the physical curve; of "Face Sets" */
  PetscInt   count;    /* pieces that this rank integrates */
  PgFemSide *side;     /* (count) */
  PetscInt  *node;     /* (count, 2) */
  PetscReal *traction; /* (count, 2) from elsewhere [Pa], NULL: none */
  DMLabel    label;    /* its points, vertices included, on every rank that has them; owned by the mesh */
} PgFemBoundary;

typedef struct {
  char          name[PG_FEM_NAME]; /* empty: the rest */
  PetscBool     set;
  PgFemMaterial material;
} PgFemRegion;

/* Unknowns that move as one: the vertical, say, of all nodes under a plate. */
typedef struct {
  PetscInt  condition, component;
  PetscInt  master_local;  /* local unknown, -1: not on this rank */
  PetscInt  master_global; /* the same everywhere */
  PetscInt  owner;         /* rank */
  PetscInt  count, *slave; /* local unknowns, all but the master */
  PetscReal displacement;  /* [m] */
} PgFemPlate;

/* Shape functions at the quadrature points of the unit square; the same for all cells. */
typedef struct {
  PetscInt  points;
  PetscReal weight[PG_FEM_POINTS];
  PetscReal N[PG_FEM_POINTS][4], dN[PG_FEM_POINTS][4][2];                 /* bilinear */
  PetscReal U[PG_FEM_POINTS][PG_FEM_UN], dU[PG_FEM_POINTS][PG_FEM_UN][2]; /* of displacement */
} PgFemShape;

/* The same in a cell. */
typedef struct {
  PetscReal dV, x[2];
  PetscReal dN[4][2], dU[PG_FEM_UN][2]; /* [1/m] */
} PgFemAt;

/* Coefficients of a cell's equations in one step. */
typedef struct {
  PetscReal lambda, G, alpha, S, D, tau, rho, rho_f; /* D = k/mu_f */
  PetscReal dt, theta;
  PetscReal mass;  /* factor of the mass matrix beside K [1/s2] */
  PetscReal scale; /* of the pressure: unknown is p/scale [Pa] */
} PgFemCoefficients;

typedef struct PgFemKept_s *PgFemKept;

struct PgFem_s {
  MPI_Comm    comm;
  PetscMPIInt rank, ranks;

  /* settings */
  char            file[PETSC_MAX_PATH_LEN]; /* empty: the rectangle */
  PetscInt        box_cells[2];
  PetscReal       box_low[2], box_high[2];
  PgFemMap        map;
  void           *map_context;
  PgFemElement    element;
  PetscReal       stabilisation, theta, damping, gravity[2];
  PetscInt        start_steps;
  PetscBool       inertia, error_if_not_converged, from_options;
  PetscInt        materials, conditions;
  PgFemRegion    *material; /* [0] is that of the rest */
  PgFemCondition *condition;
  void (*initial)(void *, const PetscReal[2], PetscReal[3]);
  void *initial_context;

  /* mesh: vertices and cells of this rank */
  DM         dm;
  PetscInt   nodes, cells, edges;   /* of this rank */
  PetscInt   all_nodes, all_cells;  /* of the mesh */
  PetscReal *x;                     /* (nodes, 2) */
  PetscInt  *number;                /* (nodes) in the whole mesh */
  PetscBool *owned;                 /* (nodes) */
  PetscInt  *cell_number;           /* (cells) in the whole mesh */
  PetscInt  *cell_node, *cell_edge; /* (cells, 4) */
  PetscInt  *cell_material;         /* (cells) */
  PetscInt  *region_tag;            /* of the regions below */
  char (*region_name)[PG_FEM_NAME]; /* (regions) */
  PetscInt       regions, boundaries;
  PgFemBoundary *boundary;

  /* unknowns */
  PetscSection section;     /* of the points of this rank */
  PetscInt     un, dofs;    /* nodes of displacement, unknowns of a cell */
  PetscInt     size, mine;  /* unknowns on this rank; owned by it */
  PetscInt    *dof, *index; /* (cells, dofs) local number; number in the system, that of the master for slaves */
  PetscInt    *global;      /* (size) number in the system, >= 0 */
  PetscBool   *is_pressure, *fixed; /* (size) fixed: held, or a slave */
  PetscInt     plates;
  PgFemPlate  *plate;
  PgFemShape   shape;

  /* state, by local unknown; velocity and acceleration of pressure are not used */
  PetscReal *u, *v, *a, *next, *load; /* (size) */
  PetscReal *force;                   /* (nodes, 2) from elsewhere, NULL: none */
  PetscReal *out_u, *out_v, *out_p;   /* what PgFemGetNodes() shows */
  PetscReal  time;
  PetscInt   step;

  /* the system */
  PetscReal  scale;                 /* of the pressure [Pa] */
  PetscReal  built_dt, built_theta; /* of the matrix, 0: none */
  Mat        A, P;                  /* P: preconditions the Schur complement */
  Vec        b, w, r, local;        /* local: by local unknown */
  VecScatter scatter;               /* from the system to local unknowns */
  IS         is_u, is_p;
  PetscInt  *p_index; /* (size) number among the pressures, -1 */
  KSP        ksp;
  PetscBool  singular; /* a uniform pressure is free */
  PetscBool  stiff;    /* the skeleton hardly changes its volume: no multigrid for it */
  PgFemStats stats;

  /* results: from nodes and cells of this rank to its share of the file's order */
  PetscSF  node_sf, cell_sf;
  PetscInt node_start, node_count, cell_start, cell_count;

  PgFemKept kept; /* for checkpoints; NULL: none so far */
};

/* mesh.c */
PETSC_INTERN PetscErrorCode PgFemMeshMake(PgFem fem);
PETSC_INTERN PetscErrorCode PgFemMeshDestroy(PgFem fem);
PETSC_INTERN void           PgFemLabelName(PetscInt boundary, char name[32]);
PETSC_INTERN PetscErrorCode PgFemFindBoundary(PgFem fem, const char name[], PetscInt *at);

/* layout.c: from the distributed mesh; `number` of each of its points in the whole one */
PETSC_INTERN PetscErrorCode PgFemLayOutNodes(PgFem fem, const PetscInt number[]);
PETSC_INTERN PetscErrorCode PgFemLayOutCells(PgFem fem, const PetscInt number[]);
PETSC_INTERN PetscErrorCode PgFemLayOutBoundaries(PgFem fem);

/* gmshscan.c: what stands in a mesh file. On one rank; reason stays empty when all went well. */
typedef struct {
  long   number;
  double x[3];
} PgFemGmshNode;
typedef struct {
  long number;
  int  corners;   /* 1: point, 2: line, 3: triangle, 4: quadrilateral */
  long corner[4]; /* places among the nodes */
} PgFemGmshElement;
typedef struct {
  long              nodes, elements;
  PgFemGmshNode    *node; /* by their numbers */
  PgFemGmshElement *element;
} PgFemGmsh;
PETSC_INTERN PetscErrorCode PgFemGmshScan(const char file[], PgFemGmsh *mesh, char reason[], size_t size);
PETSC_INTERN PetscErrorCode PgFemGmshFree(PgFemGmsh *mesh);
/* gmshcheck.c: whether it is one mesh of quadrilaterals; on one rank, as above */
PETSC_INTERN PetscErrorCode PgFemGmshCheck(const PgFemGmsh *mesh, char reason[], size_t size);

/* gmsh.c: the mesh of a file, before it is distributed, and the names of its physical groups */
typedef struct {
  PetscInt dimension, tag;
  char     name[PG_FEM_NAME];
} PgFemGroup;
PETSC_INTERN PetscErrorCode PgFemGmshRead(MPI_Comm comm, const char file[], DM *dm, PetscInt *groups,
                                          PgFemGroup **group);

/* dofs.c */
PETSC_INTERN PetscErrorCode PgFemDofsMake(PgFem fem);
PETSC_INTERN PetscErrorCode PgFemDofsDestroy(PgFem fem);

/* element.c */
PETSC_INTERN void PgFemShapeMake(PgFemElement element, PgFemShape *shape);
PETSC_INTERN void PgFemAtPoint(const PgFemShape *shape, PetscInt un, PetscInt q, const PetscReal x[4][2], PgFemAt *at);
/* The matrix of a cell, dofs x dofs by rows; and, for the preconditioner, 4 x 4 of its pressures. */
PETSC_INTERN void PgFemElementMatrix(const PgFemShape *shape, PetscInt un, const PgFemCoefficients *c,
                                     const PetscReal x[4][2], PetscReal matrix[], PetscReal schur[16]);
/* What is left of the equations of a cell when u, p (unscaled) are its values at the end of the step, u0, p0 those at
   its start, and a = dv/dt + damping v; `load` is rho_f g and rho g, all in one. */
PETSC_INTERN void PgFemElementResidual(const PgFemShape *shape, PetscInt un, const PgFemCoefficients *c,
                                       const PetscReal x[4][2], const PetscReal end[], const PetscReal start[],
                                       const PetscReal a[], const PetscReal gravity[2], PetscReal residual[]);

/* conditions.c */
PETSC_INTERN PetscErrorCode PgFemConditionsResolve(PgFem fem);
PETSC_INTERN PetscErrorCode PgFemConditionsMark(PgFem fem);
PETSC_INTERN PetscErrorCode PgFemCheckHeld(PgFem fem);
/* Writes the prescribed values of `time` into the local unknowns. */
PETSC_INTERN PetscErrorCode PgFemPrescribe(PgFem fem, PetscReal time, PetscReal value[]);
/* The component that a condition holds or moves, 2: pressure, -1: a load. */
PETSC_INTERN PetscInt PgFemComponent(PgFemQuantity quantity);
PETSC_INTERN void     PgFemConditionValue(const PgFemCondition *condition, PetscReal time, const PetscReal x[2],
                                          PetscReal value[2]);

/* loads.c: adds loads on boundaries: forces at `time`, water that leaves at `time_flux` for dt seconds. */
PETSC_INTERN PetscErrorCode PgFemAddLoads(PgFem fem, PetscReal time, PetscReal time_flux, PetscReal dt,
                                          PetscReal load[]);

/* system.c */
PETSC_INTERN PetscErrorCode PgFemCoefficientsOf(PgFem fem, PetscInt cell, PetscReal dt, PetscReal theta,
                                                PgFemCoefficients *c);
PETSC_INTERN void           PgFemCellX(PgFem fem, PetscInt cell, PetscReal x[4][2]);
PETSC_INTERN PetscErrorCode PgFemSystemBuild(PgFem fem, PetscReal dt, PetscReal theta);
PETSC_INTERN PetscErrorCode PgFemSystemDestroy(PgFem fem);

/* output.c */
PETSC_INTERN PetscErrorCode PgFemOutputDestroy(PgFem fem);

/* state.c */
PETSC_INTERN PetscErrorCode PgFemKeptDestroy(PgFem fem);

/* solver.c */
PETSC_INTERN PetscErrorCode PgFemSolverBuild(PgFem fem);
PETSC_INTERN PetscErrorCode PgFemSolve(PgFem fem);
