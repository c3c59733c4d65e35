/* Data of the drawings between the discs: streamlines with arrow heads, and contours of the magnitude. */
#include "plotimpl.h"

enum { MOST_NODES = 160000 }; /* of the grid, in the data file too */

/* The grid over the discs in the picture. */
static PetscErrorCode Grid(const PgPlotDiscs *discs, const PetscReal w[], PetscReal reach, PgPlotGrid *grid)
{
  PetscReal *x, *y, *r, *u;
  PetscInt   n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(discs->count, &x, discs->count, &y, discs->count, &r, 2 * discs->count, &u));
  for (PetscInt i = 0; i < discs->count; i++) {
    if (!PgPlotDiscsInView(discs, i)) continue;
    x[n]         = discs->x[i];
    y[n]         = discs->y[i];
    r[n]         = discs->r[i];
    u[2 * n]     = w[2 * i];
    u[2 * n + 1] = w[2 * i + 1];
    n++;
  }
  PetscCall(PgPlotGridCreate(n, x, y, r, u, reach, MOST_NODES, grid));
  PetscCall(PetscFree4(x, y, r, u));
  PetscFunctionReturn(0);
}

/* Triangles along each line, in its middle and about every eight separations. */
static void Arrows(FILE *file, const PgPlotLines *lines, PetscReal separation)
{
  const PetscReal size = 0.45 * separation;

  for (PetscInt l = 0; l < lines->lines; l++) {
    const PetscInt  first = lines->ptr[l], last = lines->ptr[l + 1] - 1;
    const PetscReal dx    = lines->point[2 * first + 2] - lines->point[2 * first];
    const PetscReal dy    = lines->point[2 * first + 3] - lines->point[2 * first + 1],
                    step  = PetscSqrtReal(dx * dx + dy * dy);
    const PetscInt arrows = 1 + (PetscInt)((PetscReal)(last - first) * step / (8.0 * separation));
    const PetscInt back   = PetscMax(1, (PetscInt)(0.5 * size / step));
    for (PetscInt a = 0; a < arrows; a++) {
      const PetscInt   k = first + (PetscInt)(((PetscReal)a + 0.5) / (PetscReal)arrows * (PetscReal)(last - first));
      const PetscReal *p = &lines->point[2 * k], *q = &lines->point[2 * PetscMax(first, k - back)];
      const PetscReal  length = PetscSqrtReal((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]));
      PetscReal        d[2];
      if (!(length > 0.0)) continue;
      d[0] = (p[0] - q[0]) / length;
      d[1] = (p[1] - q[1]) / length;
      (void)fprintf(file, "%.5g %.5g\n", (double)(p[0] + 0.5 * size * d[0]), (double)(p[1] + 0.5 * size * d[1]));
      for (int side = -1; side <= 1; side += 2)
        (void)fprintf(file, "%.5g %.5g\n", (double)(p[0] - 0.5 * size * d[0] + 0.35 * side * size * d[1]),
                      (double)(p[1] - 0.5 * size * d[1] - 0.35 * side * size * d[0]));
      (void)fprintf(file, "%.5g %.5g\n\n", (double)(p[0] + 0.5 * size * d[0]), (double)(p[1] + 0.5 * size * d[1]));
    }
  }
}

PetscErrorCode PgPlotStreamlinesWrite(PgPlot plot, const char name[], const PgPlotDiscs *discs, const PetscReal w[])
{
  const PetscReal width = discs->high[0] - discs->low[0], height = discs->high[1] - discs->low[1];
  const PetscReal separation = PetscMax(PetscMax(width, height) / 45.0, PetscMin(width, height) / 28.0);
  PgPlotGrid      grid;
  PgPlotLines     lines;
  char            file_name[300];
  FILE           *file;

  PetscFunctionBeginUser;
  /* 1.5 radii: no gaps inside, and lines reach the edge of the packing */
  PetscCall(Grid(discs, w, 1.5, &grid));
  PetscCall(PgPlotStreamlines(&grid, separation, &lines));
  PetscCall(PetscSNPrintf(file_name, sizeof file_name, "%s-streamlines.dat", name));
  PetscCall(PgPlotFolderCreateFile(&plot->folder, file_name, &file));
  (void)fprintf(file, "# x [mm]  y [mm]; a line of its own after each blank line, downstream\n");
  if (!lines.lines) (void)fprintf(file, "nan nan\n");
  for (PetscInt l = 0; l < lines.lines; l++, (void)fputc('\n', file))
    for (PetscInt k = lines.ptr[l]; k < lines.ptr[l + 1]; k++)
      if (k % 2 == 0 || k == lines.ptr[l + 1] - 1)
        (void)fprintf(file, "%.5g %.5g\n", (double)lines.point[2 * k], (double)lines.point[2 * k + 1]);
  PetscCall(PgPlotFolderCloseFile(&plot->folder, file_name, &file));
  PetscCall(PetscSNPrintf(file_name, sizeof file_name, "%s-arrows.dat", name));
  PetscCall(PgPlotFolderCreateFile(&plot->folder, file_name, &file));
  (void)fprintf(file, "# x [mm]  y [mm] of the corners of arrow heads\n");
  if (!lines.lines) (void)fprintf(file, "nan nan\n");
  Arrows(file, &lines, separation);
  PetscCall(PgPlotFolderCloseFile(&plot->folder, file_name, &file));
  PetscCall(PgPlotLinesDestroy(&lines));
  PetscCall(PgPlotGridDestroy(&grid));
  PetscFunctionReturn(0);
}

/* Pieces of the line f = level in each cell of the grid. */
static void Contour(FILE *file, const PgPlotGrid *grid, const PetscReal f[], PetscReal level)
{
  static const PetscInt corner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

  for (PetscInt j = 0; j + 1 < grid->ny; j++)
    for (PetscInt i = 0; i + 1 < grid->nx; i++) {
      PetscReal value[4], cut[4][2];
      PetscInt  cuts = 0;
      for (int c = 0; c < 4; c++) value[c] = f[(j + corner[c][1]) * grid->nx + i + corner[c][0]] - level;
      if (!isfinite(value[0] + value[1] + value[2] + value[3])) continue;
      for (int c = 0; c < 4; c++) {
        const int       d = (c + 1) % 4;
        const PetscReal s = value[c] / (value[c] - value[d]);
        if ((value[c] < 0.0) == (value[d] < 0.0)) continue;
        for (int k = 0; k < 2; k++)
          cut[cuts][k] = (k ? grid->y0 : grid->x0) +
                         grid->step *
                             ((PetscReal)(k ? j : i) + (1 - s) * (PetscReal)corner[c][k] + s * (PetscReal)corner[d][k]);
        cuts++;
      }
      for (PetscInt k = 0; k + 1 < cuts; k += 2)
        (void)fprintf(file, "%.5g %.5g\n%.5g %.5g\n\n", (double)cut[k][0], (double)cut[k][1], (double)cut[k + 1][0],
                      (double)cut[k + 1][1]);
    }
}

PetscErrorCode PgPlotContoursWrite(PgPlot plot, const char name[], const PgPlotDiscs *discs, const PetscReal w[],
                                   PgPlotRange *range, PetscInt *colours)
{
  PgPlotGrid  grid;
  PgPlotRange full = PG_PLOT_NO_RANGE;
  PetscReal  *speed, step;
  char        file_name[300];
  FILE       *file;

  PetscFunctionBeginUser;
  PetscCall(Grid(discs, w, 1.3, &grid));
  PetscCall(PetscMalloc1(grid.nx * grid.ny, &speed));
  for (PetscInt k = 0; k < grid.nx * grid.ny; k++)
    speed[k] = PetscSqrtReal(grid.u[k] * grid.u[k] + grid.v[k] * grid.v[k]);
  PetscCall(PgPlotRangeAdd(grid.nx * grid.ny, speed, PETSC_FALSE, plot->clip, &full));
  full.low = 0.0;
  PgPlotRangeFinish(PETSC_FALSE, &full);
  step      = PgPlotRound(full.high / 9.0);
  *colours  = PetscMax(2, (PetscInt)PetscCeilReal(full.high / step - 1e-6));
  full.high = step * (PetscReal)*colours;
  *range    = full;
  PetscCall(PetscSNPrintf(file_name, sizeof file_name, "%s-grid.dat", name));
  PetscCall(PgPlotFolderCreateFile(&plot->folder, file_name, &file));
  (void)fprintf(file, "# x [mm]  y [mm]  magnitude [mm/s]  w_x [mm/s]  w_y [mm/s], rows of a grid\n");
  for (PetscInt j = 0; j < grid.ny; j++, (void)fputc('\n', file))
    for (PetscInt i = 0; i < grid.nx; i++) {
      const PetscInt k = j * grid.nx + i;
      (void)fprintf(file, "%.6g %.6g ", (double)(grid.x0 + (PetscReal)i * grid.step),
                    (double)(grid.y0 + (PetscReal)j * grid.step));
      if (isfinite(speed[k]))
        (void)fprintf(file, "%.4g %.4g %.4g\n", (double)speed[k], (double)grid.u[k], (double)grid.v[k]);
      else
        (void)fprintf(file, "nan nan nan\n");
    }
  PetscCall(PgPlotFolderCloseFile(&plot->folder, file_name, &file));
  PetscCall(PetscSNPrintf(file_name, sizeof file_name, "%s-contours.dat", name));
  PetscCall(PgPlotFolderCreateFile(&plot->folder, file_name, &file));
  (void)fprintf(file, "# x [mm]  y [mm]; pieces of contour lines\nnan nan\n\n");
  for (PetscInt c = 1; c < *colours; c++) Contour(file, &grid, speed, step * (PetscReal)c);
  PetscCall(PgPlotFolderCloseFile(&plot->folder, file_name, &file));
  PetscCall(PetscFree(speed));
  PetscCall(PgPlotGridDestroy(&grid));
  PetscFunctionReturn(0);
}
