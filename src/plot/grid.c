/* The field between the discs: weighted means at the nodes of a grid. */
#include "plotimpl.h"
#include <porograin/sph.h>

/* Calls for the nodes within `reach` of a disc. */
typedef struct {
  PetscInt low[2], high[2];
} Box;

static Box NodesNear(const PgPlotGrid *grid, PetscReal x, PetscReal y, PetscReal reach)
{
  const PetscInt  most[2] = {grid->nx - 1, grid->ny - 1};
  const PetscReal at[2] = {(x - grid->x0) / grid->step, (y - grid->y0) / grid->step}, n = reach / grid->step;
  Box             box;

  for (int c = 0; c < 2; c++) {
    const PetscReal low = PetscCeilReal(at[c] - n), high = PetscFloorReal(at[c] + n);
    /* compared as reals: a disc may be far outside */
    box.low[c]  = low < 0.0 ? 0 : (low > (PetscReal)most[c] ? most[c] + 1 : (PetscInt)low);
    box.high[c] = high < 0.0 ? -1 : (high > (PetscReal)most[c] ? most[c] : (PetscInt)high);
  }
  return box;
}

static void Spread(const PgPlotGrid *grid, PetscInt n, const PetscReal x[], const PetscReal y[], const PetscReal r[],
                   const PetscReal w[], PetscReal reach, const PgKernel *kernel, PetscReal weight[], PetscBool near[])
{
  for (PetscInt d = 0; d < n; d++) {
    const PetscReal h = 2.0 * r[d], support = kernel->support * h;
    Box             box;
    if (!isfinite(x[d]) || !isfinite(y[d]) || !isfinite(w[2 * d]) || !isfinite(w[2 * d + 1])) continue;
    box = NodesNear(grid, x[d], y[d], PetscMax(support, reach * r[d]));
    for (PetscInt j = box.low[1]; j <= box.high[1]; j++)
      for (PetscInt i = box.low[0]; i <= box.high[0]; i++) {
        const PetscInt  k        = j * grid->nx + i;
        const PetscReal dx       = grid->x0 + (PetscReal)i * grid->step - x[d],
                        dy       = grid->y0 + (PetscReal)j * grid->step - y[d];
        const PetscReal distance = PetscSqrtReal(dx * dx + dy * dy);
        /* W dV: the area of the disc over h^2 is the same for all, W in units of 1/h^2 is left */
        const PetscReal W = distance < support ? kernel->w(distance / h) : 0.0;
        weight[k] += W;
        grid->u[k] += W * w[2 * d];
        grid->v[k] += W * w[2 * d + 1];
        if (distance <= reach * r[d]) near[k] = PETSC_TRUE;
      }
  }
}

PetscErrorCode PgPlotGridCreate(PetscInt discs, const PetscReal x[], const PetscReal y[], const PetscReal r[],
                                const PetscReal w[], PetscReal reach, PetscInt most, PgPlotGrid *grid)
{
  const PgKernel *kernel;
  PetscReal       low[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL}, high[2] = {PETSC_MIN_REAL, PETSC_MIN_REAL}, mean = 0.0;
  PetscReal      *weight, width, height;
  PetscBool      *near;

  PetscFunctionBeginUser;
  PetscCall(PgKernelFind("cubic_spline", &kernel));
  for (PetscInt d = 0; d < discs; d++) {
    low[0]  = PetscMin(low[0], x[d] - reach * r[d]);
    low[1]  = PetscMin(low[1], y[d] - reach * r[d]);
    high[0] = PetscMax(high[0], x[d] + reach * r[d]);
    high[1] = PetscMax(high[1], y[d] + reach * r[d]);
    mean += r[d] / (PetscReal)discs;
  }
  PetscCheck(discs > 0 && mean > 0.0 && most >= 4, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "a grid needs discs and nodes");
  width      = high[0] - low[0];
  height     = high[1] - low[1];
  grid->step = PetscMax(0.25 * mean, PetscSqrtReal(width * height / (PetscReal)most));
  grid->step = PetscMax(grid->step, (width + height) / (PetscReal)most); /* long and thin */
  grid->x0   = low[0];
  grid->y0   = low[1];
  grid->nx   = 2 + (PetscInt)(width / grid->step);
  grid->ny   = 2 + (PetscInt)(height / grid->step);
  PetscCall(PetscCalloc2(grid->nx * grid->ny, &grid->u, grid->nx * grid->ny, &grid->v));
  PetscCall(PetscCalloc2(grid->nx * grid->ny, &weight, grid->nx * grid->ny, &near));
  /* nodes further apart than the discs must not fall between them */
  Spread(grid, discs, x, y, r, w, PetscMax(reach, 0.75 * grid->step / mean), kernel, weight, near);
  for (PetscInt k = 0; k < grid->nx * grid->ny; k++) {
    const PetscBool has = (PetscBool)(near[k] && weight[k] > 0.0);
    grid->u[k]          = has ? grid->u[k] / weight[k] : (PetscReal)NAN;
    grid->v[k]          = has ? grid->v[k] / weight[k] : (PetscReal)NAN;
  }
  PetscCall(PetscFree2(weight, near));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotGridDestroy(PgPlotGrid *grid)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(grid->u, grid->v));
  PetscFunctionReturn(0);
}

PetscBool PgPlotGridSample(const PgPlotGrid *grid, const PetscReal x[2], PetscReal w[2])
{
  const PetscReal at[2] = {(x[0] - grid->x0) / grid->step, (x[1] - grid->y0) / grid->step};
  PetscInt        i, j, k;
  PetscReal       s, t;

  if (!(at[0] >= 0.0 && at[0] < (PetscReal)(grid->nx - 1) && at[1] >= 0.0 && at[1] < (PetscReal)(grid->ny - 1)))
    return PETSC_FALSE;
  i    = (PetscInt)at[0];
  j    = (PetscInt)at[1];
  s    = at[0] - (PetscReal)i;
  t    = at[1] - (PetscReal)j;
  k    = j * grid->nx + i;
  w[0] = (1 - t) * ((1 - s) * grid->u[k] + s * grid->u[k + 1]) +
         t * ((1 - s) * grid->u[k + grid->nx] + s * grid->u[k + grid->nx + 1]);
  w[1] = (1 - t) * ((1 - s) * grid->v[k] + s * grid->v[k + 1]) +
         t * ((1 - s) * grid->v[k + grid->nx] + s * grid->v[k + grid->nx + 1]);
  return (PetscBool)(isfinite(w[0]) && isfinite(w[1]));
}
