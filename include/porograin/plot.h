/* plot: what porograin-plot does. Reads results and studies, writes gnuplot scripts and data, and lets gnuplot draw.
   Runs on one process. */
#pragma once

#include <porograin/io.h>

typedef struct PgPlot_s *PgPlot;

PETSC_EXTERN PetscErrorCode PgPlotCreate(MPI_Comm comm, PgPlot *plot);
/* Takes the file names from the command line: arguments that are neither an option nor stand behind one. */
PETSC_EXTERN PetscErrorCode PgPlotSetFiles(PgPlot plot, int argc, char *argv[]);
/* Reads -figures and -plot_*. */
PETSC_EXTERN PetscErrorCode PgPlotSetFromOptions(PgPlot plot);
/* Makes all options known, for help (PgProgram). */
PETSC_EXTERN PetscErrorCode PgPlotMentionOptions(MPI_Comm comm);
/* Makes all figures in a folder of its own beside the final names and moves them there when all are complete: a
   failure leaves what was there before. */
PETSC_EXTERN PetscErrorCode PgPlotRun(PgPlot plot);
PETSC_EXTERN PetscErrorCode PgPlotDestroy(PgPlot *plot);

/* ---- a vector field between the discs ---- */

/* Values at the nodes (x0 + i step, y0 + j step), [j*nx + i]; NaN where no disc is near. Any length unit. */
typedef struct {
  PetscInt   nx, ny;
  PetscReal  x0, y0, step;
  PetscReal *u, *v;
} PgPlotGrid;
/* Weighted mean of the discs around a node, sum W w / sum W with the kernel of the operators and h = 2 r. A node
   has a value when it is within `reach` radii of the centre of a disc. At most about `most` nodes, at least 4 to a
   radius when there are so many. */
PETSC_EXTERN PetscErrorCode PgPlotGridCreate(PetscInt discs, const PetscReal x[], const PetscReal y[],
                                             const PetscReal r[], const PetscReal w[], PetscReal reach, PetscInt most,
                                             PgPlotGrid *grid);
PETSC_EXTERN PetscErrorCode PgPlotGridDestroy(PgPlotGrid *grid);
/* Bilinear value; false where a node of the cell has none. */
PETSC_EXTERN PetscBool PgPlotGridSample(const PgPlotGrid *grid, const PetscReal x[2], PetscReal w[2]);

/* Lines along the field, from upstream to downstream, no two nearer than half of `separation`, everywhere about
   that far apart (Jobard & Lefer 1997), by Runge-Kutta steps of fourth order along the arc. */
typedef struct {
  PetscInt   lines;
  PetscInt  *ptr;   /* points of line l: ptr[l] .. ptr[l+1]-1 */
  PetscReal *point; /* (2) */
} PgPlotLines;
PETSC_EXTERN PetscErrorCode PgPlotStreamlines(const PgPlotGrid *grid, PetscReal separation, PgPlotLines *lines);
PETSC_EXTERN PetscErrorCode PgPlotLinesDestroy(PgPlotLines *lines);
