/* porograin: simulates discs with pore water between them. */
#include <porograin/simulation.h>

static const char about[] =
    "porograin: saturated granular materials, discs by DEM and pore water by characteristic-based SPH\n"
    "  porograin -options_file options/panel_case1_ns.opts -pressure implicit -pressure_ksp_monitor -output panel.h5\n"
    "  porograin -case panel -fluid none -dem_local_damping 0.7 -panel_displacement 0.002\n\n";

static PetscErrorCode Run(int argc, char *argv[])
{
  PgSimulation simulation;
  PetscBool    help, recover = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PgRefuseStrayArguments(argc, argv));
  PetscCall(PgResultRecoverFromOptions(PETSC_COMM_WORLD, &recover));
  if (recover) PetscFunctionReturn(0);
  PetscCall(PgSimulationCreate(PETSC_COMM_WORLD, &simulation));
  PetscCall(PgSimulationSetFromOptions(simulation));
  PetscCall(PetscOptionsHasHelp(NULL, &help));
  if (!help) {
    PetscCall(PgSimulationSetUp(simulation));
    PetscCall(PgSimulationView(simulation, PETSC_VIEWER_STDOUT_WORLD));
    PetscCall(PgSimulationRun(simulation));
  }
  PetscCall(PgSimulationDestroy(&simulation));
  PetscFunctionReturn(0);
}

int main(int argc, char *argv[])
{
  PetscErrorCode err = PgInitialize(&argc, &argv, about);

  if (err) return 1;
  err = Run(argc, argv);
  return PgFinalize(err);
}
