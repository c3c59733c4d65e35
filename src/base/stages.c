/* Log stages: PETSc's for -log_view, and the seconds of each for our own summary. */
#include "baseimpl.h"

static const char *const names[PG_STAGE_COUNT] = {"setup",    "lists",     "halo",      "contact", "integrate",
                                                  "porosity", "geometry",  "predictor", "source",  "assemble",
                                                  "pressure", "corrector", "output"};

static PetscLogStage  stage_id[PG_STAGE_COUNT];
static PetscLogDouble seconds[PG_STAGE_COUNT];
static PetscLogDouble entered;
static PgStage        stack[8];
static int            depth = 0;

PetscErrorCode PgStagesRegister(void)
{
  PetscFunctionBeginUser;
  depth = 0;
  for (int i = 0; i < PG_STAGE_COUNT; i++) {
    seconds[i] = 0.0;
    PetscCall(PetscLogStageRegister(names[i], &stage_id[i]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgStagePush(PgStage stage)
{
  const PetscLogDouble now = MPI_Wtime();

  PetscFunctionBeginUser;
  PgAssert(depth < (int)(sizeof stack / sizeof *stack), "log stages nested deeper than %d", depth);
  if (depth > 0) seconds[stack[depth - 1]] += now - entered;
  stack[depth++] = stage;
  entered        = now;
  PetscCall(PetscLogStagePush(stage_id[stage]));
  PetscFunctionReturn(0);
}

PetscErrorCode PgStagePop(void)
{
  const PetscLogDouble now = MPI_Wtime();

  PetscFunctionBeginUser;
  PgAssert(depth > 0, "log stage popped that was never pushed");
  seconds[stack[--depth]] += now - entered;
  entered = now;
  PetscCall(PetscLogStagePop());
  PetscFunctionReturn(0);
}

PetscLogDouble PgStageSeconds(PgStage stage) { return seconds[stage]; }
const char    *PgStageName(PgStage stage) { return names[stage]; }
