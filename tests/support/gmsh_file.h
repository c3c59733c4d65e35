/* Meshes of Gmsh for tests: a rectangle of quadrilaterals, MSH 2.2 or 4.1, with inner vertices moved, the rectangle
   split into two regions, and physical names for its sides and regions. */
#pragma once

#include <petscsys.h>
#include <stdio.h>

typedef struct {
  PetscInt  nx, ny;
  PetscReal size[2];
  PetscReal distortion; /* inner vertices are moved by up to so many cells */
  PetscInt  version;    /* 22 or 41 */
  PetscInt  turned;     /* every so-manieth cell is written clockwise; 0: none */
} GmshRectangle;

/* Numbers without pattern in [-1, 1], the same everywhere. */
static inline PetscReal GmshNoise(PetscInt k)
{
  const PetscReal x = PetscSinReal(12.9898 * (PetscReal)k + 1.0) * 43758.5453;
  return 2.0 * (x - PetscFloorReal(x)) - 1.0;
}

static inline void GmshVertex(const GmshRectangle *g, PetscInt i, PetscInt j, PetscReal x[2])
{
  const PetscBool inner = (PetscBool)(i > 0 && i < g->nx && j > 0 && j < g->ny);
  const PetscReal d     = inner ? g->distortion : 0.0;
  const PetscInt  k     = 2 * (j * (g->nx + 1) + i);

  x[0] = g->size[0] * ((PetscReal)i + d * GmshNoise(k)) / (PetscReal)g->nx;
  x[1] = g->size[1] * ((PetscReal)j + d * GmshNoise(k + 1)) / (PetscReal)g->ny;
}

/* Numbers of the cell's corners, from 1. */
static inline void GmshCorners(const GmshRectangle *g, PetscInt i, PetscInt j, int corner[4])
{
  const int a = (int)(j * (g->nx + 1) + i + 1), row = (int)(g->nx + 1);
  const int cell = (int)(j * g->nx + i);

  corner[0] = a;
  corner[1] = a + 1;
  corner[2] = a + row + 1;
  corner[3] = a + row;
  if (g->turned && cell % g->turned == 0) {
    corner[1] = a + row;
    corner[3] = a + 1;
  }
}

static const char *const GmshNames = "$PhysicalNames\n6\n1 1 \"bottom\"\n1 2 \"right\"\n1 3 \"top\"\n1 4 \"left\"\n"
                                     "2 1 \"lower part\"\n2 2 \"upper part\"\n$EndPhysicalNames\n";

/* Edge k of a side, from 1; sides in the order bottom, right, top, left. */
static inline void GmshEdge(const GmshRectangle *g, int side, PetscInt k, int end[2])
{
  const int row = (int)(g->nx + 1), last = (int)(g->ny * row);

  end[0] = side == 0   ? (int)k + 1
           : side == 1 ? (int)(k * row) + row
           : side == 2 ? last + (int)k + 1
                       : (int)(k * row) + 1;
  end[1] = end[0] + (side % 2 ? row : 1);
}

static inline void GmshWrite22(const GmshRectangle *g, FILE *f)
{
  const PetscInt edges = 2 * (g->nx + g->ny), cells = g->nx * g->ny;
  int            number = 1, end[2], corner[4];

  (void)fprintf(f, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n%s$Nodes\n%d\n", GmshNames, (int)((g->nx + 1) * (g->ny + 1)));
  for (PetscInt j = 0; j <= g->ny; j++)
    for (PetscInt i = 0; i <= g->nx; i++) {
      PetscReal x[2];
      GmshVertex(g, i, j, x);
      (void)fprintf(f, "%d %.17g %.17g 0\n", (int)(j * (g->nx + 1) + i + 1), (double)x[0], (double)x[1]);
    }
  (void)fprintf(f, "$EndNodes\n$Elements\n%d\n", (int)(edges + cells));
  for (int side = 0; side < 4; side++)
    for (PetscInt k = 0; k < (side % 2 ? g->ny : g->nx); k++) {
      GmshEdge(g, side, k, end);
      (void)fprintf(f, "%d 1 2 %d %d %d %d\n", number++, side + 1, side + 1, end[0], end[1]);
    }
  for (PetscInt j = 0; j < g->ny; j++)
    for (PetscInt i = 0; i < g->nx; i++) {
      const int part = 2 * j < g->ny ? 1 : 2;
      GmshCorners(g, i, j, corner);
      (void)fprintf(f, "%d 3 2 %d %d %d %d %d %d\n", number++, part, part, corner[0], corner[1], corner[2], corner[3]);
    }
  (void)fprintf(f, "$EndElements\n");
}

/* One block of vertices on surface 1; one block of elements for each side and part. */
static inline void GmshWrite41(const GmshRectangle *g, FILE *f)
{
  const int nodes = (int)((g->nx + 1) * (g->ny + 1)), edges = 2 * (int)(g->nx + g->ny), cells = (int)(g->nx * g->ny);
  int       number = 1, end[2], corner[4];

  (void)fprintf(f, "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n%s$Entities\n0 4 2 0\n", GmshNames);
  for (int side = 1; side <= 4; side++) (void)fprintf(f, "%d 0 0 0 1 1 0 1 %d 0\n", side, side);
  for (int part = 1; part <= 2; part++) (void)fprintf(f, "%d 0 0 0 1 1 0 1 %d 0\n", part, part);
  (void)fprintf(f, "$EndEntities\n$Nodes\n1 %d 1 %d\n2 1 0 %d\n", nodes, nodes, nodes);
  for (int k = 1; k <= nodes; k++) (void)fprintf(f, "%d\n", k);
  for (PetscInt j = 0; j <= g->ny; j++)
    for (PetscInt i = 0; i <= g->nx; i++) {
      PetscReal x[2];
      GmshVertex(g, i, j, x);
      (void)fprintf(f, "%.17g %.17g 0\n", (double)x[0], (double)x[1]);
    }
  (void)fprintf(f, "$EndNodes\n$Elements\n6 %d 1 %d\n", edges + cells, edges + cells);
  for (int side = 0; side < 4; side++) {
    const PetscInt n = side % 2 ? g->ny : g->nx;
    (void)fprintf(f, "1 %d 1 %d\n", side + 1, (int)n);
    for (PetscInt k = 0; k < n; k++) {
      GmshEdge(g, side, k, end);
      (void)fprintf(f, "%d %d %d\n", number++, end[0], end[1]);
    }
  }
  for (int part = 1; part <= 2; part++) {
    int count = 0;
    for (PetscInt j = 0; j < g->ny; j++) count += (2 * j < g->ny ? 1 : 2) == part ? (int)g->nx : 0;
    (void)fprintf(f, "2 %d 3 %d\n", part, count);
    for (PetscInt j = 0; j < g->ny; j++)
      for (PetscInt i = 0; i < g->nx && (2 * j < g->ny ? 1 : 2) == part; i++) {
        GmshCorners(g, i, j, corner);
        (void)fprintf(f, "%d %d %d %d %d\n", number++, corner[0], corner[1], corner[2], corner[3]);
      }
  }
  (void)fprintf(f, "$EndElements\n");
}

/* Rank 0 writes, all wait. */
static inline void GmshWrite(const GmshRectangle *g, const char file[])
{
  PetscMPIInt rank = 0;
  FILE       *f;

  (void)MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank == 0) {
    f = fopen(file, "w");
    if (!f) (void)MPI_Abort(PETSC_COMM_WORLD, 1);
    if (g->version == 41)
      GmshWrite41(g, f);
    else
      GmshWrite22(g, f);
    (void)fclose(f);
  }
  (void)MPI_Barrier(PETSC_COMM_WORLD);
}
