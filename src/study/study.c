/* The object: which study, its options, and what all studies share. */
#include "studyimpl.h"
#include <math.h>
#include <stdlib.h>

static const PgStudyKind *const kinds[] = {&PgStudySolvers, &PgStudyMms, &PgStudyExplicit, &PgStudyStepping};
enum { KINDS = sizeof kinds / sizeof *kinds };
static const char shipped_solvers[] = "options/solvers/all.txt";

PetscErrorCode PgStudyCreate(MPI_Comm comm, PgStudy *study)
{
  PgStudy s;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  s->comm                 = comm;
  s->files.comm           = comm;
  s->files.option         = "-study_output";
  s->sizes                = (PgIntList){3, {1249, 5000, 20000}};
  s->system.packing       = PG_STUDY_LATTICE;
  s->system.direct_limit  = 250000;
  s->solve.rtol           = 1e-8;
  s->solve.repeats        = 3;
  s->solve.repeat_seconds = 10.0;
  s->solve.seconds        = 300.0;
  s->columns              = 25;
  s->levels               = 4;
  s->mms_jitter           = 0.1;
  s->at                   = (PgIntList){4, {1, 10, 100, 1000}};
  s->sweeps               = (PgIntList){10, {0, 1, 2, 5, 10, 20, 50, 100, 1000, 10000}};
  s->stretch              = 4e-3;
  s->samples              = 40;
  s->steps                = 0;
  s->windows              = 4;
  PetscCall(PetscStrncpy(s->solver_file, shipped_solvers, sizeof s->solver_file));
  PetscCall(PetscStrncpy(s->variants,
                         "implicit:1,implicit1e-5:1,implicit1e-2:1,implicit:10,implicit1e-2:10,implicit:50,explicit1:1,"
                         "explicit1:10,explicit1:50,explicit10:1,explicit10:10,explicit10:50,explicit100:10,"
                         "explicit100:50",
                         sizeof s->variants));
  *study = s;
  PetscFunctionReturn(0);
}

PetscErrorCode PgOptionIntList(PetscOptionItems *PetscOptionsObject, const char name[], const char text[],
                               PetscInt lower, PetscInt upper, PgIntList *list, PetscBool *set)
{
  MPI_Comm  comm        = PetscOptionsObject->comm;
  char      value[1024] = "", **part;
  int       parts;
  PetscBool given;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < list->count; i++) {
    char one[32];
    PetscCall(PetscSNPrintf(one, sizeof one, "%s%" PetscInt_FMT, i ? "," : "", list->value[i]));
    PetscCall(PetscStrlcat(value, one, sizeof value));
  }
  PetscCall(PgOptionString(PetscOptionsObject, name, text, value, sizeof value, &given));
  if (set) *set = given;
  if (!given) PetscFunctionReturn(0);
  PetscCall(PetscStrToArray(value, ',', &parts, &part));
  PgInputCheck(parts > 0 && parts <= PG_STUDY_LIST, comm, "option %s: %d numbers, it needs between 1 and %d", name,
               parts, (int)PG_STUDY_LIST);
  list->count = parts;
  for (int i = 0; i < parts; i++) {
    char        *end = NULL;
    const double x   = strtod(part[i], &end);
    PgInputCheck(end != part[i] && *end == '\0' && x == floor(x), comm, "option %s: '%s' is not a whole number", name,
                 part[i]);
    PgInputCheck(x >= (double)lower && x <= (double)upper, comm,
                 "option %s: %s is out of range, it must be between %" PetscInt_FMT " and %" PetscInt_FMT, name,
                 part[i], lower, upper);
    list->value[i] = (PetscInt)x;
  }
  PetscCall(PetscStrToArrayDestroy(parts, part));
  PetscFunctionReturn(0);
}

PetscErrorCode PgStudySolverOptions(PgStudy study, PetscOptionItems *PetscOptionsObject)
{
  PetscBool given;

  PetscFunctionBeginUser;
  PetscCall(PgOptionString(PetscOptionsObject, "-study_solvers",
                           "file of solvers: on each line a name, then PETSc options without prefix",
                           study->solver_file, sizeof study->solver_file, &given));
  if (!given && !study->help)
    PetscCall(PgShippedFile(study->comm, shipped_solvers, study->solver_file, sizeof study->solver_file));
  PetscCall(PgOptionString(PetscOptionsObject, "-study_only", "names of solvers of that file, others are passed over",
                           study->only, sizeof study->only, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode PgStudySetFromOptions(PgStudy study)
{
  const char *words[KINDS];
  char        text[512] = "what to study";

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsHasHelp(NULL, &study->help));
  for (int k = 0; k < KINDS; k++) {
    char one[160];
    words[k] = kinds[k]->name;
    PetscCall(PetscSNPrintf(one, sizeof one, "%s %s (%s)", k ? "," : ":", kinds[k]->name, kinds[k]->summary));
    PetscCall(PetscStrlcat(text, one, sizeof text));
  }
  PetscOptionsBegin(study->comm, "", "study: solvers, operators and time steps compared", "");
  PetscCall(PgOptionChoice(PetscOptionsObject, "-study", text, KINDS, words, &study->kind, NULL));
  PetscCall(PgOptionString(PetscOptionsObject, "-study_output",
                           "base name of the files: NAME.csv (further tables NAME-<table>.csv) and NAME.h5",
                           study->files.base, sizeof study->files.base, NULL));
  for (int k = 0; k < KINDS; k++) {
    char needs[64];
    if (!study->help && k != study->kind) continue;
    PetscCall(PetscSNPrintf(needs, sizeof needs, "-study %s", kinds[k]->name));
    PetscCall(PgOptionsBelongTo(needs));
    PetscCall(kinds[k]->options(study, PetscOptionsObject));
    PetscCall(PgOptionsBelongTo(NULL));
  }
  PetscOptionsEnd();
  PetscFunctionReturn(0);
}

static PetscErrorCode Mention(void *context)
{
  PgStudy study;

  PetscFunctionBeginUser;
  (void)context;
  PetscCall(PgStudyCreate(PETSC_COMM_WORLD, &study));
  PetscCall(PgStudySetFromOptions(study));
  PetscCall(PgStudyDestroy(&study));
  PetscFunctionReturn(0);
}

PetscErrorCode PgStudyMentionOptions(MPI_Comm comm)
{
  PetscFunctionBeginUser;
  PetscCall(PgOptionsApart(Mention, NULL));
  PetscCall(PgSimulationMentionOptions(comm));
  PetscFunctionReturn(0);
}

/* Makes the rooms print their options. */
static PetscErrorCode Help(PgStudy study)
{
  PgSimulation simulation;

  PetscFunctionBeginUser;
  PetscCall(PgSimulationCreate(study->comm, &simulation));
  PetscCall(PgSimulationSetFromOptions(simulation));
  PetscCall(PgSimulationDestroy(&simulation));
  PetscFunctionReturn(0);
}

PetscErrorCode PgStudyRun(PgStudy study)
{
  PetscFunctionBeginUser;
  if (study->help)
    PetscCall(Help(study));
  else
    PetscCall(kinds[study->kind]->run(study));
  PetscFunctionReturn(0);
}

PetscErrorCode PgStudyDestroy(PgStudy *study)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(*study));
  PetscFunctionReturn(0);
}

PetscReal PgStudyGrowth(PetscInt entries, const PetscReal size[], const PetscReal count[])
{
  PetscReal n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, d;

  for (PetscInt i = 0; i < entries; i++) {
    PetscReal u, v;
    if (!(count[i] > 0.0) || !(size[i] > 0.0)) continue;
    u = PetscLogReal(size[i]);
    v = PetscLogReal(count[i]);
    n += 1.0;
    x += u;
    y += v;
    xx += u * u;
    xy += u * v;
  }
  d = n * xx - x * x;
  /* sizes that differ by less than a percent say nothing about growth */
  return n > 1.0 && d > 1e-4 * n * n ? (n * xy - x * y) / d : (PetscReal)NAN;
}
