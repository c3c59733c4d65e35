/* porograin-plot: figures from result files and studies. */
#include <porograin/plot.h>

static const PgProgram program = {
    .name     = "porograin-plot",
    .purpose  = "figures from results of porograin and porograin-study, by gnuplot",
    .examples = "  porograin-plot run.h5 -figures DIR\n"
                "  porograin-plot dry.h5 darcy.h5 ns.h5 -figures DIR -plot_time 0.1 -plot_format png\n"
                "  porograin-plot run.h5 -figures DIR -plot_fields pressure,streamlines\n"
                "  porograin-plot run.h5 -figures DIR -plot_film pressure\n"
                "  porograin-plot study.h5 -figures DIR\n",
    .often    = "-figures -plot_time -plot_fields -plot_film",
    .own      = "plot",
    .collect  = PgPlotMentionOptions};

static PetscErrorCode Run(int argc, char *argv[])
{
  PgPlot    plot;
  PetscBool help, done;

  PetscFunctionBeginUser;
  PetscCall(PgHelp(PETSC_COMM_WORLD, &program, &done));
  if (done) PetscFunctionReturn(0);
  PetscCall(PetscOptionsHasHelp(NULL, &help));
  PetscCall(PgPlotCreate(PETSC_COMM_WORLD, &plot));
  PetscCall(PgPlotSetFiles(plot, argc, argv));
  PetscCall(PgPlotSetFromOptions(plot));
  if (!help) PetscCall(PgPlotRun(plot));
  PetscCall(PgPlotDestroy(&plot));
  PetscFunctionReturn(0);
}

int main(int argc, char *argv[])
{
  PetscErrorCode err = PgInitialize(&argc, &argv, NULL);

  if (!err) err = Run(argc, argv);
  return PgFinalize(err);
}
