/* Columns of the history: those of every run, then energy accounts with -dem_energy, then force and way of every wall. */
#include "simulationimpl.h"
#include <ctype.h>

enum { TEXT = 96, WALL_COLUMNS = 3 };

static const PgColumn energy_columns[] = {
    {"energy_elastic_normal", "J/m", "elastic energy of the normal springs"},
    {"energy_elastic_sliding", "J/m", "elastic energy of the sliding springs, plates included"},
    {"energy_elastic_rolling", "J/m", "elastic energy of the rolling springs"},
    {"energy_elastic_moment", "J/m", "elastic energy of the rolling moment springs"},
    {"energy_friction_sliding", "J/m", "taken by sliding friction since the start"},
    {"energy_friction_rolling", "J/m", "taken by the cap of the rolling force"},
    {"energy_friction_moment", "J/m", "taken by the cap of the rolling moment"},
    {"energy_dashpots", "J/m", "taken by dashpots, and where normal forces are clipped"},
    {"energy_local_damping", "J/m", "taken by local damping"},
    {"energy_global_damping", "J/m", "taken by viscous damping"},
    {"energy_rolling_excess", "J/m", "taken by the rolling force beyond what its springs get"},
    {"work_plates", "J/m", "work of the plates on the discs"},
    {"work_walls", "J/m", "work of the walls on the discs"},
    {"work_gravity", "J/m", "work of gravity on the discs"},
    {"work_external", "J/m", "work of external forces on the discs"},
    {"work_fluid", "J/m", "work of the water on the discs"},
    {"energy_residual", "J/m", "what does not add up, second order in the time step"},
};
enum { ENERGY_COLUMNS = sizeof energy_columns / sizeof *energy_columns };

/* "wall_NAME" with letters, digits and _ only; the number of the wall when the name is empty or taken. */
static PetscErrorCode WallName(PgSimulation sim, PetscInt wall, char name[TEXT])
{
  PgWall    w, other;
  PetscBool taken;

  PetscFunctionBeginUser;
  PetscCall(PgDemGetWall(sim->dem, wall, &w));
  taken = (PetscBool)(w.name[0] == '\0');
  for (PetscInt k = 0; k < wall && !taken; k++) {
    PetscCall(PgDemGetWall(sim->dem, k, &other));
    PetscCall(PetscStrcmp(w.name, other.name, &taken));
  }
  if (taken)
    PetscCall(PetscSNPrintf(name, TEXT, "wall_%" PetscInt_FMT, wall));
  else
    PetscCall(PetscSNPrintf(name, TEXT, "wall_%s", w.name));
  for (char *c = name; *c; c++)
    if (!isalnum((unsigned char)*c)) *c = '_';
  PetscFunctionReturn(0);
}

static PetscErrorCode AddWallColumn(PgSimulation sim, const char wall[], const char what[], const char unit[],
                                    const char text[])
{
  char *name;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * TEXT, &name));
  PetscCall(PetscSNPrintf(name, 2 * TEXT, "%s_%s", wall, what));
  sim->column[sim->columns++] = (PgColumn){name, unit, text};
  PetscFunctionReturn(0);
}

PetscErrorCode PgColumnsSetUp(PgSimulation sim)
{
  PetscInt  walls;
  PetscBool energy;

  PetscFunctionBeginUser;
  PetscCall(PgDemHasEnergy(sim->dem, &energy));
  PetscCall(PgDemGetWallCount(sim->dem, &walls));
  PetscCall(PetscMalloc1(COLUMN_COUNT + ENERGY_COLUMNS + WALL_COLUMNS * walls, &sim->column));
  PetscCall(PetscCalloc1(COLUMN_COUNT + ENERGY_COLUMNS + WALL_COLUMNS * walls, &sim->row));
  for (int k = 0; k < COLUMN_COUNT; k++) sim->column[k] = PgHistoryColumns[k];
  sim->columns = COLUMN_COUNT;
  for (int k = 0; energy && k < ENERGY_COLUMNS; k++) sim->column[sim->columns++] = energy_columns[k];
  sim->wall_column = sim->columns;
  for (PetscInt k = 0; k < walls; k++) {
    char name[TEXT];
    PetscCall(WallName(sim, k, name));
    PetscCall(AddWallColumn(sim, name, "force", "N/m", "normal force of the discs on the wall"));
    PetscCall(AddWallColumn(sim, name, "shear", "N/m",
                            "tangential force of the discs on the wall, normal turned by -90 degrees"));
    PetscCall(AddWallColumn(sim, name, "displacement", "m", "way of the wall along its normal, into the discs"));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgColumnsDestroy(PgSimulation sim)
{
  PetscFunctionBeginUser;
  for (PetscInt k = sim->wall_column; sim->column && k < sim->columns; k++) PetscCall(PetscFree(sim->column[k].name));
  PetscCall(PetscFree(sim->column));
  PetscCall(PetscFree(sim->row));
  PetscFunctionReturn(0);
}

PetscErrorCode PgColumnsFill(PgSimulation sim)
{
  PetscReal *row = sim->row + sim->wall_column;
  PetscInt   walls;

  PetscFunctionBeginUser;
  if (sim->wall_column > COLUMN_COUNT) {
    PgEnergy e;
    PetscCall(PgDemGetEnergy(sim->dem, &e));
    {
      const PetscReal value[ENERGY_COLUMNS] = {
          e.elastic_normal,   e.elastic_sliding, e.elastic_rolling, e.elastic_moment, e.friction_sliding,
          e.friction_rolling, e.friction_moment, e.dashpots,        e.local_damping,  e.global_damping,
          e.rolling_excess,   e.work_plates,     e.work_walls,      e.work_gravity,   e.work_external,
          e.work_fluid,       e.residual};
      PetscCall(PetscArraycpy(sim->row + COLUMN_COUNT, value, ENERGY_COLUMNS));
    }
  }
  PetscCall(PgDemGetWallCount(sim->dem, &walls));
  for (PetscInt k = 0; k < walls; k++, row += WALL_COLUMNS) {
    PgWall    w;
    PetscReal f[2];

    PetscCall(PgDemGetWall(sim->dem, k, &w));
    PetscCall(PgDemGetWallForce(sim->dem, k, f));
    row[0] = 0 - (f[0] * w.normal[0] + f[1] * w.normal[1]);
    row[1] = f[0] * w.normal[1] - f[1] * w.normal[0];
    PetscCall(PgDemGetWallDisplacement(sim->dem, k, &row[2]));
    if (k != sim->setup.load_wall) continue;
    sim->row[COLUMN_DISPLACEMENT] = row[2];
    sim->row[COLUMN_LOAD] = sim->row[COLUMN_LOAD_TOTAL] = row[0];
  }
  PetscFunctionReturn(0);
}
