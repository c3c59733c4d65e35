/* porograin: simulates discs with pore water between them. */
#include <porograin/simulation.h>

static const PgProgram program = {
    .name     = "porograin",
    .purpose  = "discs (DEM) and the pore water between them (SPH)",
    .examples = "  porograin -options_file options/panel_case1_ns.opts -output panel.h5\n"
                "  porograin -options_file options/panel_case1_ns.opts -pressure_ksp_type cg -pressure_ksp_monitor\n"
                "  porograin -case packing -packing discs.csv -fluid darcy -end_time 0.01 -output run.h5\n"
                "  porograin -case up_terzaghi -up_element q2q1 -output column.h5\n"
                "  mpiexec -n 4 porograin -options_file options/panel_case1_dry.opts -panel_columns 100\n",
    .often    = "-case -fluid -end_time -dt -output -pressure",
    .collect  = PgSimulationMentionOptions};

static PetscErrorCode Run(int argc, char *argv[])
{
  PgSimulation simulation;
  PetscBool    help, done = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PgHelp(PETSC_COMM_WORLD, &program, &done));
  if (!done) PetscCall(PgRefuseStrayArguments(argc, argv));
  if (!done) PetscCall(PgResultRecoverFromOptions(PETSC_COMM_WORLD, &done));
  if (done) PetscFunctionReturn(0);
  PetscCall(PgEndingExpect());
  PetscCall(PgSimulationCreate(PETSC_COMM_WORLD, &simulation));
  PetscCall(PgSimulationSetFromOptions(simulation));
  PetscCall(PetscOptionsHasHelp(NULL, &help)); /* -help petsc: the objects have printed theirs */
  if (!help) PetscCall(PgSimulationRunCase(simulation, &done));
  if (!help && !done) {
    PetscCall(PgSimulationSetUp(simulation));
    PetscCall(PgSimulationView(simulation, PETSC_VIEWER_STDOUT_WORLD));
    PetscCall(PgSimulationRun(simulation));
  }
  PetscCall(PgSimulationDestroy(&simulation));
  PetscFunctionReturn(0);
}

int main(int argc, char *argv[])
{
  PetscErrorCode err = PgInitialize(&argc, &argv, NULL);

  if (!err) err = Run(argc, argv);
  return PgFinalize(err);
}
