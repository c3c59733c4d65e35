/* porograin-study: compares solvers of the pressure equation, and the operators with exact fields. */
#include <porograin/study.h>

static const PgProgram program = {
    .name     = "porograin-study",
    .purpose  = "pressure solvers against each other, explicit against implicit, operators against exact fields",
    .examples = "  porograin-study -study_sizes 1249,20000,200000 -study_solvers options/solvers/all.txt -study_output "
                "solvers\n"
                "  porograin-study -study mms\n"
                "  porograin-study -study explicit -options_file options/panel_case1_ns.opts\n"
                "  porograin-study -study stepping -options_file options/panel_case1_ns.opts -fluid_every 25\n",
    .often    = "-study -study_sizes -study_solvers -study_output",
    .own      = "study",
    .collect  = PgStudyMentionOptions};

static PetscErrorCode Run(int argc, char *argv[])
{
  PgStudy   study;
  PetscBool done;

  PetscFunctionBeginUser;
  PetscCall(PgHelp(PETSC_COMM_WORLD, &program, &done));
  if (done) PetscFunctionReturn(0);
  PetscCall(PgRefuseStrayArguments(argc, argv));
  PetscCall(PgStudyCreate(PETSC_COMM_WORLD, &study));
  PetscCall(PgStudySetFromOptions(study));
  PetscCall(PgStudyRun(study));
  PetscCall(PgStudyDestroy(&study));
  PetscFunctionReturn(0);
}

int main(int argc, char *argv[])
{
  PetscErrorCode err = PgInitialize(&argc, &argv, NULL);

  if (!err) err = Run(argc, argv);
  return PgFinalize(err);
}
