/* The panel of Li, Chu & Sheng (2007), section 5: a hexagonal packing between two rigid plates.

   Rows of W-1 and W discs in turn, the first and the last of W-1; with W = 25 and 51 rows these are 1249
   discs of radius 5 mm, 0.25 m wide and 0.443 m high, just touching. The lower plate is at rest, the upper
   one moves down at 6.18e-2 m/s. Case I: all sides drained at the initial pressure. Case II: water flows in
   through the top, -bc_top flux -bc_top_flux -0.13. */
#include "casesimpl.h"

typedef struct {
  PetscInt  columns, rows;
  PetscReal radius;       /* [m] */
  PetscReal velocity;     /* of the upper plate, downward [m/s] */
  PetscReal displacement; /* of the upper plate at the end [m] */
} Panel;

/* Initial porosities of section 5: the infinite lattice 1 - pi/(2 sqrt 3) inside, and what the paper gives
   for edges and corners. */
static const PetscReal porosity_inside = 0.0931, porosity_edge = 0.0945, porosity_corner = 0.1025;

static PetscErrorCode Create(MPI_Comm comm, void **context)
{
  Panel    *panel;
  PetscBool rows = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&panel));
  *panel = (Panel){25, 51, 5e-3, 6.18e-2, 0.012};
  PetscOptionsBegin(comm, "", "case panel: hexagonal packing between plates", "");
  PetscCall(PgOptionInt(PetscOptionsObject, "-panel_columns",
                        "discs in a long row W; rows have W-1 and W discs in turn", 3, 40000, &panel->columns, NULL));
  panel->rows = 2 * panel->columns + 1;
  PetscCall(
      PgOptionInt(PetscOptionsObject, "-panel_rows", "rows of discs, default 2 W + 1", 3, 80001, &panel->rows, &rows));
  PetscCall(PgOptionReal(PetscOptionsObject, "-panel_radius", "radius of the discs", "m", PG_POSITIVE, 1e3,
                         &panel->radius, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-panel_velocity", "downward velocity of the upper plate", "m/s", 0.0, 1e3,
                         &panel->velocity, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-panel_displacement", "displacement of the upper plate at the end", "m",
                         0.0, 1e3, &panel->displacement, NULL));
  PetscOptionsEnd();
  *context = panel;
  PetscFunctionReturn(0);
}

/* Number of discs in the rows below row k. */
static PetscInt64 Below(const Panel *panel, PetscInt64 k)
{
  return (k / 2) * (2 * (PetscInt64)panel->columns - 1) + (k % 2 ? panel->columns - 1 : 0);
}

static void Locate(const Panel *panel, PetscInt id, PetscInt *row, PetscInt *column, PetscInt *length)
{
  PetscInt64 k = 2 * ((PetscInt64)id / (2 * panel->columns - 1));

  if (id >= Below(panel, k + 1)) k++;
  *row    = (PetscInt)k;
  *column = (PetscInt)(id - Below(panel, k));
  *length = k % 2 ? panel->columns : panel->columns - 1;
}

static PetscErrorCode Place(const Panel *panel, PgCaseSetup *setup, PetscInt first, PetscInt owned)
{
  PgCaseArrays a;

  PetscFunctionBeginUser;
  PetscCall(PgCaseGetArrays(setup, &a));
  for (PetscInt i = 0; i < owned; i++) {
    const PetscReal r = panel->radius;
    PetscInt        row, column, length, sides;
    PetscBool       end, cap;

    Locate(panel, first + i, &row, &column, &length);
    end            = (PetscBool)(column == 0 || column == length - 1);
    cap            = (PetscBool)(row == 0 || row == panel->rows - 1);
    a.radius[i]    = r;
    a.x[2 * i]     = r * (2.0 * (PetscReal)column + (row % 2 ? 1.0 : 2.0));
    a.x[2 * i + 1] = r * (1.0 + PetscSqrtReal(3.0) * (PetscReal)row);
    a.plate[i]     = row == 0 ? 1.0 : (row == panel->rows - 1 ? 2.0 : 0.0);
    a.v[2 * i + 1] = row == panel->rows - 1 ? -panel->velocity : 0.0;
    sides = (column == 0) << PG_SIDE_LEFT | (column == length - 1) << PG_SIDE_RIGHT | (row == 0) << PG_SIDE_BOTTOM |
            (row == panel->rows - 1) << PG_SIDE_TOP;
    if (a.side) a.side[i] = (PetscReal)sides;
    if (a.porosity) a.porosity[i] = end && cap ? porosity_corner : (end || cap ? porosity_edge : porosity_inside);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Setup(void *context, PgCaseSetup *setup)
{
  const Panel     *panel = (const Panel *)context;
  const PetscInt64 total = Below(panel, panel->rows);
  const PgPlate    lower = {"lower", -1.0, 0.0, -1.0, PETSC_FALSE},
                upper    = {"upper", 1.0, -panel->velocity, -1.0, PETSC_FALSE};
  PetscInt first, owned, index;

  PetscFunctionBeginUser;
  PgInputCheck(total < PETSC_MAX_INT / 64, setup->comm,
               "options -panel_columns %" PetscInt_FMT " -panel_rows %" PetscInt_FMT
               ": %lld discs are too many for the integers of this PETSc",
               panel->columns, panel->rows, (long long)total);
  PetscCall(PgCaseDealDiscs(setup, total, &first, &owned));
  PetscCall(PgDemAddPlate(setup->dem, &lower, &index));
  PetscCall(PgDemAddPlate(setup->dem, &upper, &setup->load_plate));
  PetscCall(Place(panel, setup, first, owned));
  PetscCall(PgCaseFinishDiscs(setup));
  setup->height = panel->radius * (2.0 + PetscSqrtReal(3.0) * (PetscReal)(panel->rows - 1));
  if (panel->velocity > 0.0) setup->end_time = panel->displacement / panel->velocity;
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(void **context)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(*context));
  PetscFunctionReturn(0);
}

const PgCaseInfo PgCasePanel = {
    "panel", "hexagonal packing compressed between two plates (Li, Chu & Sheng 2007, section 5)",
    Create,  Setup,
    Destroy, NULL};
