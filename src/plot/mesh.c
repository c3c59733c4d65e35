/* A continuum: its cells, displaced and coloured. */
#include "plotimpl.h"

static PetscReal First(const PetscReal row[]) { return row[0]; }
static PetscReal Magnitude(const PetscReal row[]) { return PetscSqrtReal(row[0] * row[0] + row[1] * row[1]); }
static PetscReal MeanCompression(const PetscReal s[]) { return -0.5 * (s[0] + s[3]); }

static const PgPlotField fields[] = {
    {"pressure", "pressure", "kPa", "pressure", 1, 1e-3, First, PETSC_FALSE, PG_PLOT_DISCS},
    {"displacement", "displacement", "mm", "displacement", 2, 1e3, Magnitude, PETSC_FALSE, PG_PLOT_DISCS},
    {"volumetric_strain", "volumetric strain", "1", "volumetric_strain", 1, 1.0, First, PETSC_TRUE, PG_PLOT_DISCS},
    {"relative_speed", "magnitude of the flux w", "mm/s", "flux", 2, 1e3, Magnitude, PETSC_FALSE, PG_PLOT_DISCS},
    {"mean_stress", "mean effective stress", "kPa", "effective_stress", 4, 1e-3, MeanCompression, PETSC_TRUE,
     PG_PLOT_DISCS},
    {"speed", "speed of the skeleton", "mm/s", "velocity", 2, 1e3, Magnitude, PETSC_FALSE, PG_PLOT_DISCS},
};

const PgPlotField *PgPlotMeshFieldAt(PetscInt index)
{
  return index >= 0 && index < (PetscInt)(sizeof fields / sizeof *fields) ? &fields[index] : NULL;
}

const PgPlotField *PgPlotMeshFieldFind(const char name[])
{
  for (size_t i = 0; i < sizeof fields / sizeof *fields; i++)
    if (!strcmp(fields[i].name, name)) return &fields[i];
  return NULL;
}

/* Nodes of the cells, counter-clockwise, as they count from 0. */
static PetscErrorCode ReadMesh(const PgPlotSource *source, PetscInt *cells, PetscReal **corner, PetscInt *nodes,
                               PetscReal **position)
{
  PetscInt  columns[2];
  PetscBool wrong;

  PetscFunctionBeginUser;
  PetscCall(PgResultRead(PETSC_COMM_SELF, source->file, "/mesh/cells", cells, &columns[0], corner));
  PetscCall(PgResultRead(PETSC_COMM_SELF, source->file, "/mesh/position", nodes, &columns[1], position));
  wrong = (PetscBool)(columns[0] != 4 || columns[1] != 2);
  for (PetscInt i = 0; !wrong && i < 4 * *cells; i++)
    wrong = (PetscBool) !((*corner)[i] >= 0.0 && (*corner)[i] < (PetscReal)*nodes);
  if (!wrong) PetscFunctionReturn(0);
  PetscCall(PetscFree(*corner));
  PetscCall(PetscFree(*position));
  PetscCall(PgReport(PETSC_COMM_SELF, "result file '%s': /mesh is none of cells with four corners", source->file));
  PetscFunctionReturn(PETSC_ERR_FILE_UNEXPECTED);
}

PetscErrorCode PgPlotMeshOpen(PgPlotSource *source)
{
  PetscReal *corner, *position, *u, most = 0.0, low[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL};
  PetscReal  high[2] = {PETSC_MIN_REAL, PETSC_MIN_REAL};
  PetscInt   cells, nodes;

  PetscFunctionBeginUser;
  source->magnified = 1.0;
  PetscCall(PgPlotSourceHas(source, "/mesh", &source->mesh));
  if (!source->mesh) PetscFunctionReturn(0);
  PetscCall(ReadMesh(source, &cells, &corner, &nodes, &position));
  for (PetscInt i = 0; i < 2 * nodes; i++) {
    low[i % 2]  = PetscMin(low[i % 2], position[i]);
    high[i % 2] = PetscMax(high[i % 2], position[i]);
  }
  PetscCall(PetscFree(corner));
  PetscCall(PetscFree(position));
  for (PetscInt s = 0; s < source->snapshots; s++) {
    PetscCall(PgPlotSourceSnapshot(source, s, "displacement", 2, &nodes, &u));
    for (PetscInt i = 0; i < nodes; i++) most = PetscMax(most, Magnitude(&u[2 * i]));
    PetscCall(PetscFree(u));
  }
  /* the largest shows as about a twentieth of the height */
  if (isfinite(most) && most > 0.0)
    source->magnified = PetscMax(1.0, PgPlotRound(0.05 * PetscMax(high[0] - low[0], high[1] - low[1]) / most));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotMeshRead(const PgPlotSource *source, PetscInt snapshot, PgPlotDiscs *d)
{
  PetscReal *corner, *position, *u;
  PetscInt   cells, nodes;

  PetscFunctionBeginUser;
  PetscCall(ReadMesh(source, &cells, &corner, &nodes, &position));
  PetscCall(PgPlotSourceSnapshot(source, snapshot, "displacement", 2, &nodes, &u));
  d->count   = 4 * cells;
  d->outside = 0;
  PetscCall(PetscMalloc3(d->count, &d->x, d->count, &d->y, d->count, &d->r));
  for (int c = 0; c < 2; c++) {
    PetscReal *x = c ? d->y : d->x;
    d->low[c]    = PETSC_MAX_REAL;
    d->high[c]   = PETSC_MIN_REAL;
    for (PetscInt i = 0; i < d->count; i++) {
      const PetscInt node = (PetscInt)corner[i];
      x[i]                = 1e3 * (position[2 * node + c] + source->magnified * u[2 * node + c]);
      d->r[i]             = 0.0;
      d->low[c]           = PetscMin(d->low[c], x[i]);
      d->high[c]          = PetscMax(d->high[c], x[i]);
    }
  }
  PetscCall(PetscFree(corner));
  PetscCall(PetscFree(position));
  PetscCall(PetscFree(u));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotMeshValues(const PgPlotSource *source, PetscInt snapshot, const PgPlotField *field,
                                PetscReal **value)
{
  PetscReal *corner, *position, *rows;
  PetscInt   cells, nodes, n = -1;

  PetscFunctionBeginUser;
  PetscCall(ReadMesh(source, &cells, &corner, &nodes, &position));
  PetscCall(PgPlotSourceSnapshot(source, snapshot, field->dataset, field->columns, &n, &rows));
  PgInputCheck(n == nodes || n == cells, PETSC_COMM_SELF,
               "result file '%s': dataset '%s' has %" PetscInt_FMT " rows, the mesh %" PetscInt_FMT
               " nodes and %" PetscInt_FMT " cells",
               source->file, field->dataset, n, nodes, cells);
  PetscCall(PetscMalloc1(4 * cells, value));
  for (PetscInt i = 0; i < 4 * cells; i++) {
    const PetscInt row = n == nodes ? (PetscInt)corner[i] : i / 4;
    (*value)[i]        = field->scale * field->value(&rows[field->columns * row]);
  }
  PetscCall(PetscFree(corner));
  PetscCall(PetscFree(position));
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotMeshWrite(PgPlot plot, const char name[], const PgPlotDiscs *d, const PetscReal value[])
{
  char  file_name[300];
  FILE *file;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(file_name, sizeof file_name, "%s-cells.txt", name));
  PetscCall(PgPlotFolderCreateFile(&plot->folder, file_name, &file));
  (void)fprintf(file, "# cells, drawn by %s.gp: corners [mm], and the colour of the mean of their values\n", name);
  for (PetscInt i = 0; i < d->count; i += 4) {
    const PetscReal mean = 0.25 * (value[i] + value[i + 1] + value[i + 2] + value[i + 3]);
    if (!isfinite(mean)) continue;
    (void)fprintf(file, "set object polygon from");
    for (PetscInt k = 0; k < 5; k++)
      (void)fprintf(file, "%s %.6g,%.6g", k ? " to" : "", (double)d->x[i + k % 4], (double)d->y[i + k % 4]);
    (void)fprintf(file, " fs solid 1.0 border lc palette cb %.5g fc palette cb %.5g lw 1\n", (double)mean,
                  (double)mean);
  }
  PetscCall(PgPlotFolderCloseFile(&plot->folder, file_name, &file));
  PetscFunctionReturn(0);
}

void PgPlotMeshDraw(FILE *script, const char name[], const char data[], PetscInt column)
{
  (void)fprintf(script,
                "load '%s-cells.txt'\nplot %s using (NaN):(NaN):%d with dots lc palette notitle # the colour bar\n"
                "unset object\n",
                name, data, (int)column);
}
