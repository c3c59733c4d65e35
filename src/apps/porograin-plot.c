/* porograin-plot: figures from result files and studies. */
#include <porograin/plot.h>

static const char about[] = "porograin-plot: figures from results of porograin and porograin-study, by gnuplot\n"
                            "  porograin-plot run.h5 -figures DIR\n"
                            "  porograin-plot dry.h5 darcy.h5 ns.h5 -figures DIR -plot_time 0.1 -plot_format png\n"
                            "  porograin-plot run.h5 -figures DIR -plot_fields pressure,streamlines\n"
                            "  porograin-plot run.h5 -figures DIR -plot_film pressure\n"
                            "  porograin-plot study.h5 -figures DIR\n\n";

static PetscErrorCode Run(int argc, char *argv[])
{
  PgPlot    plot;
  PetscBool help;

  PetscFunctionBeginUser;
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
  PetscErrorCode err = PgInitialize(&argc, &argv, about);

  if (err) return 1;
  err = Run(argc, argv);
  return PgFinalize(err);
}
