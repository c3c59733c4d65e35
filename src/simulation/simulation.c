/* The object: options, set-up in the one order that refuses everything before anything is written. */
#include "simulationimpl.h"

const char *const PgFluidWords[3] = {"none", "darcy", "ns"};

PetscErrorCode PgSimulationCreate(MPI_Comm comm, PgSimulation *simulation)
{
  PgSimulation sim;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&sim));
  sim->comm                = comm;
  sim->dt_safety           = 0.3;
  sim->fluid_every         = 1;
  sim->setup.comm          = comm;
  sim->setup.load_plate    = -1;
  sim->setup.load_wall     = -1;
  sim->setup.solid_density = 2000.0;
  sim->output_time = sim->history_time = sim->progress_time = -1.0;
  sim->guard_every                                          = 200;
  sim->checkpoint_time                                      = -1.0;
  sim->checkpoint_step                                      = -1;
  sim->porosity_start                                       = -1;
  sim->watch.created                                        = MPI_Wtime();
  PetscCall(PgParticlesCreate(comm, &sim->particles));
  PetscCall(PgNeighborsCreate(sim->particles, &sim->neighbors));
  PetscCall(PgDemCreate(sim->particles, sim->neighbors, &sim->dem));
  sim->setup.particles = sim->particles;
  sim->setup.dem       = sim->dem;
  *simulation          = sim;
  PetscFunctionReturn(0);
}

static PetscErrorCode TimeOptions(PgSimulation sim, PetscOptionItems *PetscOptionsObject)
{
  PetscFunctionBeginUser;
  PetscCall(PgOptionReal(PetscOptionsObject, "-dt",
                         "time step of the discs; default: -dt_safety times the critical one", "s", PG_POSITIVE, 1e3,
                         &sim->dt, &sim->dt_set));
  PetscCall(PgOptionReal(PetscOptionsObject, "-dt_safety",
                         "fraction of the critical time step taken in the place of -dt", "1", 1e-6, 1.0,
                         &sim->dt_safety, NULL));
  PetscCall(PgOptionInt(PetscOptionsObject, "-fluid_every", "steps of the discs in one step of the water", 1, 1000000,
                        &sim->fluid_every, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-end_time", "end of the run; default: of the case", "s", 0.0, 1e9,
                         &sim->setup.end_time, &sim->end_set));
  PetscCall(PgOptionInt(PetscOptionsObject, "-guard_every",
                        "steps of the discs between checks for a run that has gone wrong", 1, 1000000,
                        &sim->guard_every, NULL));
  PetscFunctionReturn(0);
}

/* The case first: it may set options of its own for all that is read later. */
static PetscErrorCode ChooseCase(PgSimulation sim)
{
  const char *const *names;
  PetscInt           count, chosen          = 0;
  char               needs[128], text[2048] = "problem to set up: ";

  PetscFunctionBeginUser;
  PetscCall(PgCaseGetNames(&count, &names));
  for (PetscInt i = 0; i < count; i++) {
    char one[256];
    PetscCall(PgCaseFind(names[i], &sim->case_info));
    PetscCall(PetscSNPrintf(one, sizeof one, "%s%s (%s)", i ? ", " : "", names[i], sim->case_info->summary));
    PetscCall(PetscStrlcat(text, one, sizeof text));
  }
  PetscOptionsBegin(sim->comm, "", "run: what is computed, time step and end", "");
  PetscCall(PgOptionChoice(PetscOptionsObject, "-case", text, count, names, &chosen, NULL));
  PetscOptionsEnd();
  PetscCall(PgCaseFind(names[chosen], &sim->case_info));
  PetscCall(PetscSNPrintf(needs, sizeof needs, "-case %s", names[chosen]));
  PetscCall(PgOptionsBelongTo(needs));
  PetscCall(sim->case_info->create(sim->comm, &sim->case_context));
  PetscCall(PgOptionsBelongTo(NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode CaseOptions(PgSimulation sim, PetscOptionItems *PetscOptionsObject)
{
  PetscInt fluid = PG_FLUID_NONE;

  PetscFunctionBeginUser;
  PetscCall(PgOptionChoice(PetscOptionsObject, "-fluid", "dry, Darcy's law, or averaged Navier-Stokes equations", 3,
                           PgFluidWords, &fluid, NULL));
  sim->fluid = (PgFluid)fluid;
  PetscCall(PgOptionReal(PetscOptionsObject, "-solid_density", "density of the discs rho_s", "kg/m3", PG_POSITIVE, 1e6,
                         &sim->setup.solid_density, NULL));
  PetscCall(PgOptionReals(PetscOptionsObject, "-gravity", "acceleration of gravity, in both phases", "m/s2", 2,
                          sim->setup.gravity, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode OutputFile(PgSimulation sim, PetscOptionItems *PetscOptionsObject)
{
  PetscFunctionBeginUser;
  PetscCall(PgOptionString(PetscOptionsObject, "-output",
                           "result file, FILE.h5; FILE.xmf and FILE.csv are written beside it", sim->output_file,
                           sizeof sim->output_file, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode OutputOptions(PgSimulation sim, PetscOptionItems *PetscOptionsObject)
{
  PetscFunctionBeginUser;
  PetscCall(OutputFile(sim, PetscOptionsObject));
  PetscCall(PgOptionReal(PetscOptionsObject, "-output_every", "time between snapshots; default a tenth of the run", "s",
                         0.0, 1e9, &sim->output_time, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-history_every",
                         "time between history rows; default a thousandth of the run", "s", 0.0, 1e9,
                         &sim->history_time, NULL));
  PetscCall(PgProgressSetFromOptions(sim, PetscOptionsObject));
  PetscCall(PgOptionString(PetscOptionsObject, "-checkpoint",
                           "checkpoint FILE, written at the end too; the one before it is kept as FILE.1",
                           sim->checkpoint_file, sizeof sim->checkpoint_file, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-checkpoint_every",
                         "simulated time between checkpoints; default a tenth of the run", "s", 0.0, 1e9,
                         &sim->checkpoint_time, NULL));
  PetscCall(PgOptionString(PetscOptionsObject, "-restart",
                           "go on from a checkpoint: FILE (or FILE.1 if that is damaged), or the latest of a directory "
                           "or pattern",
                           sim->restart_file, sizeof sim->restart_file, NULL));
  PetscCall(PgEndingSetFromOptions(PetscOptionsObject, &sim->watch));
  PetscFunctionReturn(0);
}

/* Without water nobody else keeps the porosity that snapshots start from. */
static PetscErrorCode KeepPorosity(PgSimulation sim)
{
  const PgFieldInfo info = {"initial_porosity", 1, "1", "porosity at the start; 0: not known",
                            PG_FIELD_MIGRATE | PG_FIELD_RESTART};

  PetscFunctionBeginUser;
  if (sim->output_file[0] || sim->checkpoint_file[0] || sim->restart_file[0])
    PetscCall(PgParticlesRegisterField(sim->particles, &info, &sim->porosity_start));
  PetscFunctionReturn(0);
}

PetscErrorCode PgSimulationSetFromOptions(PgSimulation sim)
{
  PetscFunctionBeginUser;
  PetscCall(ChooseCase(sim));
  if (sim->case_info->run) { /* what else it reads it does when it runs */
    PetscOptionsBegin(sim->comm, "", "output: results, checkpoints and restart", "");
    PetscCall(OutputFile(sim, PetscOptionsObject));
    PetscOptionsEnd();
    PetscFunctionReturn(0);
  }
  PetscOptionsBegin(sim->comm, "", "run: what is computed, time step and end", "");
  PetscCall(CaseOptions(sim, PetscOptionsObject));
  PetscCall(TimeOptions(sim, PetscOptionsObject));
  PetscOptionsEnd();
  PetscOptionsBegin(sim->comm, "", "output: results, checkpoints and restart", "");
  PetscCall(OutputOptions(sim, PetscOptionsObject));
  PetscOptionsEnd();
  PetscCall(PgPackingExport(sim->comm, NULL));
  if (sim->fluid == PG_FLUID_NONE) sim->fluid_every = 1;
  PetscCall(PgParticlesSetFromOptions(sim->particles));
  PetscCall(PgNeighborsSetFromOptions(sim->neighbors));
  PetscCall(PgDemSetFromOptions(sim->dem));
  PetscCall(PgDemSetGravity(sim->dem, sim->setup.gravity));
  if (sim->fluid != PG_FLUID_NONE) {
    PetscCall(PgOptionsBelongTo("-fluid darcy or -fluid ns"));
    PetscCall(PgPoreCreate(sim->particles, sim->neighbors, sim->fluid, &sim->pore));
    PetscCall(PgPoreSetGravity(sim->pore, sim->setup.gravity));
    PetscCall(PgPoreSetSolidDensity(sim->pore, sim->setup.solid_density));
    PetscCall(PgPoreSetFromOptions(sim->pore));
    PetscCall(PgOptionsBelongTo(NULL));
    sim->setup.pore = sim->pore;
  } else {
    PetscCall(KeepPorosity(sim));
  }
  PetscFunctionReturn(0);
}

/* Creates a run of this case, and lets go of it: its options are known then. */
static PetscErrorCode Mention(void *context)
{
  const char  *name = (const char *)context;
  PgSimulation sim;
  PetscBool    panel, recover;

  PetscFunctionBeginUser;
  PetscCall(PetscStrcmp(name, "panel", &panel));
  PetscCall(PetscOptionsSetValue(NULL, "-case", name));
  PetscCall(PetscOptionsSetValue(NULL, "-fluid", panel ? "ns" : "none"));
  PetscCall(PgSimulationCreate(PETSC_COMM_WORLD, &sim));
  PetscCall(PgSimulationSetFromOptions(sim));
  PetscCall(PgSimulationDestroy(&sim));
  PetscCall(PgResultRecoverFromOptions(PETSC_COMM_WORLD, &recover));
  PetscFunctionReturn(0);
}

PetscErrorCode PgSimulationMentionOptions(MPI_Comm comm)
{
  const char *const *names;
  PetscInt           count;

  PetscFunctionBeginUser;
  (void)comm;
  PetscCall(PgCaseGetNames(&count, &names));
  for (PetscInt i = 0; i < count; i++) {
    char name[128];
    PetscCall(PetscStrncpy(name, names[i], sizeof name));
    PetscCall(PgOptionsApart(Mention, name));
  }
  PetscFunctionReturn(0);
}

static PetscInt Interval(PetscReal asked, PetscReal fallback, PetscReal dt_f)
{
  const PetscReal interval = asked < 0.0 ? fallback : asked;

  if (interval <= 0.0) return 0;
  return PetscMax(1, (PetscInt)PetscFloorReal(interval / dt_f + 0.5));
}

/* Of two options that exclude each other the one that was given later. */
static PetscErrorCode ChooseTimes(PgSimulation sim)
{
  const char *loser;

  PetscFunctionBeginUser;
  PetscCall(PgOptionsOneOf(sim->comm, "-end_time", "-panel_displacement", &loser));
  if (!strcmp(loser, "-end_time")) sim->end_set = PETSC_FALSE;
  PetscCall(PgOptionsOneOf(sim->comm, "-dt", "-dt_safety", &loser));
  if (!strcmp(loser, "-dt")) sim->dt_set = PETSC_FALSE;
  PetscFunctionReturn(0);
}

static PetscErrorCode SetUpTime(PgSimulation sim, PetscReal case_end)
{
  const PetscReal asked_end = sim->setup.end_time;
  PetscReal       dt_f, end;

  PetscFunctionBeginUser;
  PetscCall(ChooseTimes(sim));
  end = sim->end_set ? asked_end : case_end;
  PgInputCheck(end > 0.0, sim->comm, "the run has no end: give -end_time > 0 s");
  PetscCall(PgDemCriticalTimeStep(sim->dem, &sim->dt_critical));
  PgInputCheck(!sim->dt_set || sim->dt <= sim->dt_critical, sim->comm,
               "option -dt: %g s is above the critical time step %g s of the contacts", (double)sim->dt,
               (double)sim->dt_critical);
  if (!sim->dt_set) {
    PgInputCheck(sim->dt_critical < 1e300, sim->comm, "no contact at the start to derive a time step from: give -dt");
    sim->dt = sim->dt_safety * sim->dt_critical;
  }
  dt_f                = sim->dt * (PetscReal)sim->fluid_every;
  sim->setup.end_time = end;
  PgInputCheck(end / dt_f < 1e9, sim->comm, "%g steps to t = %g s with -dt %g s are too many", (double)(end / dt_f),
               (double)end, (double)sim->dt);
  sim->steps = (PetscInt)PetscCeilReal(end / dt_f - 1e-9); /* the end may be a multiple of the step but for rounding */
  sim->output_every     = Interval(sim->output_time, end / 10.0, dt_f);
  sim->history_every    = Interval(sim->history_time, end / 1000.0, dt_f);
  sim->progress_every   = Interval(sim->progress_time, end / 20.0, dt_f);
  sim->guard_every      = PetscMax(1, sim->guard_every / sim->fluid_every);
  sim->checkpoint_every = Interval(sim->checkpoint_time, end / 10.0, dt_f);
  if (sim->pore) PetscCall(PgPoreCheckStep(sim->pore, dt_f));
  PetscFunctionReturn(0);
}

static PetscErrorCode SetUpWater(PgSimulation sim)
{
  PgPressure pressure;

  PetscFunctionBeginUser;
  PetscCall(PgPoreSetUp(sim->pore, sim->dt * (PetscReal)sim->fluid_every));
  PetscCall(PgPoreGetParts(sim->pore, NULL, &pressure));
  PetscCall(PgPressureSetUpSolver(pressure)); /* so that PETSc reads nested solver options before the check */
  PetscFunctionReturn(0);
}

static PetscErrorCode NameFailures(PgSimulation sim)
{
  PgPressure pressure;
  char       file[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  if (!sim->pore || !sim->output_file[0]) PetscFunctionReturn(0);
  PetscCall(PgPoreGetParts(sim->pore, NULL, &pressure));
  PetscCall(PetscSNPrintf(file, sizeof file, "%.*s-failed.petsc", (int)PetscMax(0, (int)strlen(sim->output_file) - 3),
                          sim->output_file));
  PetscCall(PgPressureSetFailureFile(pressure, file));
  PetscFunctionReturn(0);
}

static PetscErrorCode SetUpOutput(PgSimulation sim)
{
  PetscFunctionBeginUser;
  PetscCall(PgColumnsSetUp(sim));
  if (sim->checkpoint_file[0]) {
    if (sim->output_file[0]) PetscCall(PgCheckpointCheckOutput(sim->comm, sim->checkpoint_file, sim->output_file));
    PetscCall(PgCheckpointCheckPlace(sim->comm, sim->checkpoint_file));
  }
  if (!sim->output_file[0]) {
    sim->output_every = 0;
    PetscFunctionReturn(0);
  }
  if (sim->restart_file[0])
    PetscCall(PgOutputContinue(sim->particles, sim->output_file, sim->columns, sim->column, sim->run, sim->rows,
                               sim->snapshots, sim->restart_file, &sim->output));
  else
    PetscCall(PgOutputCreate(sim->particles, sim->output_file, sim->columns, sim->column, &sim->output));
  PetscFunctionReturn(0);
}

PetscErrorCode PgSimulationRunCase(PgSimulation sim, PetscBool *done)
{
  PetscMPIInt size;

  PetscFunctionBeginUser;
  *done = (PetscBool)(sim->case_info->run != NULL);
  if (!*done) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Comm_size(sim->comm, &size));
  PetscCall(PetscPrintf(sim->comm, "porograin %s: case %s on %d rank%s\n", PG_VERSION, sim->case_info->name, (int)size,
                        size == 1 ? "" : "s"));
  PetscCall(sim->case_info->run(sim->comm, sim->case_context, sim->output_file));
  PetscFunctionReturn(0);
}

/* Radii and masses that the case has given its discs, which a run that goes on must give them again. */
static PetscErrorCode SumDiscs(PgSimulation sim)
{
  PgExactSum sum[2];
  PetscReal *radius, *mass;
  PetscInt   owned;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(sum, 2));
  PetscCall(PgParticlesGetSizes(sim->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(sim->particles, PG_RADIUS, &radius));
  PetscCall(PgParticlesGetArray(sim->particles, PG_MASS, &mass));
  for (PetscInt i = 0; i < owned; i++) {
    PgExactSumAdd(&sum[0], radius[i]);
    PgExactSumAdd(&sum[1], mass[i]);
  }
  PetscCall(PgExactSumReduce(sim->comm, 2, sum, sim->disc_sums));
  PetscFunctionReturn(0);
}

PetscErrorCode PgSimulationSetUp(PgSimulation sim)
{
  const PetscReal asked_end  = sim->setup.end_time;
  PgCheckpoint    checkpoint = NULL;
  PetscReal       case_end;
  PetscInt        ids, start;

  PetscFunctionBeginUser;
  PgInputCheck(sim->case_info->setup, sim->comm, "case %s has no steps in time: 'porograin -case %s' does all of it",
               sim->case_info->name, sim->case_info->name);
  PetscCall(PgStagePush(PG_STAGE_SETUP));
  sim->setup.restart = (PetscBool)(sim->restart_file[0] != 0);
  PetscCall(sim->case_info->setup(sim->case_context, &sim->setup));
  PetscCall(SumDiscs(sim));
  if (sim->setup.restart) PetscCall(PgRestartBegin(sim, &checkpoint));
  case_end = sim->setup.end_time;
  PetscCall(PgNeighborsBuild(sim->neighbors));
  PetscCall(PgDemRestoreHistory(sim->dem));
  sim->setup.end_time = asked_end;
  PetscCall(SetUpTime(sim, case_end));
  PetscCall(PgParticlesGetIdRange(sim->particles, &start, &ids));
  if (sim->output_file[0] ||
      sim->checkpoint_file[0]) { /* 300 bytes a disc that a run without snapshots does not need */
    PetscCall(PetscMalloc3(ids, &sim->effective, ids, &sim->volumetric, sim->pore ? 0 : ids, &sim->porosity));
    PetscCall(PgStrainCreate(sim->particles, sim->neighbors, &sim->strain)); /* from the lists of the start */
  }
  if (sim->setup.restart) {
    PetscCall(PgRestartFinish(sim, &checkpoint));
  } else {
    PetscCall(PgDemForces(sim->dem, 0.0));
    if (sim->pore) PetscCall(SetUpWater(sim));
  }
  PetscCall(NameFailures(sim));
  PetscCall(PgSimulationCheckOptions(sim));
  PetscCall(PgPackingExport(sim->comm, sim->particles));
  PetscCall(SetUpOutput(sim));
  PetscCall(PgStagePop());
  PetscFunctionReturn(0);
}

PetscErrorCode PgSimulationView(PgSimulation sim, PetscViewer viewer)
{
  PetscInt    global;
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(sim->comm, &size));
  PetscCall(PgParticlesGetSizes(sim->particles, NULL, NULL, &global));
  PetscCall(PetscViewerASCIIPrintf(viewer, "porograin %s: case %s, %" PetscInt_FMT " discs on %d rank%s, fluid %s\n",
                                   PG_VERSION, sim->case_info->name, global, (int)size, size == 1 ? "" : "s",
                                   PgFluidWords[sim->fluid]));
  PetscCall(PetscViewerASCIIPrintf(viewer, "time step %.4e s, %.1f %% of the critical %.4e s", (double)sim->dt,
                                   100.0 * (double)(sim->dt / sim->dt_critical), (double)sim->dt_critical));
  if (sim->pore)
    PetscCall(PetscViewerASCIIPrintf(viewer, "; water every %" PetscInt_FMT " steps, %.4e s", sim->fluid_every,
                                     (double)(sim->dt * (PetscReal)sim->fluid_every)));
  PetscCall(PetscViewerASCIIPrintf(viewer, "; %" PetscInt_FMT " steps to t = %.4e s\n", sim->steps * sim->fluid_every,
                                   (double)sim->setup.end_time));
  PetscCall(PgNeighborsView(sim->neighbors, viewer));
  PetscCall(PgDemView(sim->dem, viewer));
  if (sim->pore) PetscCall(PgPoreView(sim->pore, viewer));
  PetscFunctionReturn(0);
}

PetscErrorCode PgSimulationDestroy(PgSimulation *simulation)
{
  PgSimulation sim = *simulation;

  PetscFunctionBeginUser;
  if (!sim) PetscFunctionReturn(0);
  PetscCall(PgOutputDestroy(&sim->output));
  PetscCall(PgStrainDestroy(&sim->strain));
  PetscCall(PetscFree3(sim->effective, sim->volumetric, sim->porosity));
  PetscCall(PgColumnsDestroy(sim));
  PetscCall(PgPoreDestroy(&sim->pore));
  PetscCall(PgDemDestroy(&sim->dem));
  PetscCall(PgNeighborsDestroy(&sim->neighbors));
  PetscCall(PgParticlesDestroy(&sim->particles));
  if (sim->case_info) PetscCall(sim->case_info->destroy(&sim->case_context));
  PetscCall(PetscFree(*simulation));
  PetscFunctionReturn(0);
}

PetscErrorCode PgSimulationGetParts(PgSimulation sim, PgParticles *particles, PgNeighbors *neighbors, PgDem *dem,
                                    PgPore *pore)
{
  PetscFunctionBeginUser;
  if (particles) *particles = sim->particles;
  if (neighbors) *neighbors = sim->neighbors;
  if (dem) *dem = sim->dem;
  if (pore) *pore = sim->pore;
  PetscFunctionReturn(0);
}

PetscErrorCode PgSimulationGetTime(PgSimulation sim, PetscInt *step, PetscReal *time, PetscReal *dt)
{
  PetscFunctionBeginUser;
  if (step) *step = sim->step;
  if (time) *time = sim->time;
  if (dt) *dt = sim->dt;
  PetscFunctionReturn(0);
}
