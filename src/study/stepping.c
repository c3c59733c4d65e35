/* -study stepping: thousands of fluid steps of one run, in which every solver solves every system: each with a
   preconditioner that it keeps and its own last solution as guess, by the same code and the same rule of rebuilding
   as a run (PgPressure). The run itself is made with the solver of its options. */
#include "studyimpl.h"
#include <math.h>

enum {
  COLUMN_SOLVER,
  COLUMN_N,
  COLUMN_FIRST,
  COLUMN_LAST,
  COLUMN_LOAD,
  COLUMN_ITERATIONS,
  COLUMN_LEAST,
  COLUMN_MOST,
  COLUMN_BUILDS,
  COLUMN_LISTS,
  COLUMN_TIME,
  COLUMN_PLAIN,
  COLUMN_BUILD_TIME,
  COLUMN_RESIDUAL,
  COLUMN_FAILED,
  COLUMNS
};

static const PgTableColumn columns[COLUMNS] = {
    [COLUMN_SOLVER]     = {"solver", NULL, "name in the file of solvers", "solver", NULL, 19},
    [COLUMN_N]          = {"N", "1", "unknowns", "N", "%.0f", 7},
    [COLUMN_FIRST]      = {"first_step", "1", "first fluid step of the window", "from", "%.0f", 7},
    [COLUMN_LAST]       = {"last_step", "1", "last fluid step of the window", "to", "%.0f", 7},
    [COLUMN_LOAD]       = {"load", "N/m", "mean load in the window", "load N/m", "%.3g", 9},
    [COLUMN_ITERATIONS] = {"iterations", "1", "mean iterations of a solve", "its", "%.2f", 7},
    [COLUMN_LEAST]      = {"iterations_min", "1", "fewest", "min", "%.0f", 5},
    [COLUMN_MOST]       = {"iterations_max", "1", "most", "max", "%.0f", 5},
    [COLUMN_BUILDS]     = {"builds", "1", "preconditioners built in the window", "builds", "%.0f", 6},
    [COLUMN_LISTS]      = {"list_builds", "1", "pair lists built in the window", "lists", "%.0f", 6},
    [COLUMN_TIME]       = {"time_per_unknown", "us", "mean time of a solve over N, builds included", "us/N", "%.3g", 6},
    [COLUMN_PLAIN] = {"plain_per_unknown", "us", "median time of a solve without build over N", "plain", "%.3g", 6},
    [COLUMN_BUILD_TIME] = {"build_per_unknown", "us", "mean time of a build over N: what solves with one take longer",
                           "build", "%.3g", 6},
    [COLUMN_RESIDUAL]   = {"residual", "1", "largest true residual", "residual", "%.1e", 9},
    [COLUMN_FAILED]     = {"failed", "1", "solves that did not reach tolerance", "failed", "%.0f", 6},
};

/* One solver that goes along, and what it did in each step. */
typedef struct {
  PgSolver  *solver;
  PgPressure pressure;
  PgField    last;       /* its last solution, the excess over the reference */
  PetscInt  *iterations; /* (steps) -1: failed */
  PetscReal *seconds;    /* (steps) */
  PetscBool *built;      /* (steps) */
  PetscReal *residual;   /* (steps) */
  PetscBool  dead;       /* PETSc gave an error */
} Rider;

typedef struct {
  PgStudy      study;
  PgSimulation sim;
  PgParticles  particles;
  PgNeighbors  neighbors;
  PgDem        dem;
  PgPore       pore;
  PgSolverList list;
  Rider       *rider;
  PetscReal    reference; /* [Pa] of the pressure objects */
  PetscInt     steps;     /* that are measured */
  PetscReal   *load;      /* (steps) [N/m] */
  PetscInt    *lists;     /* (steps) builds so far */
  PetscReal   *Z, *p;     /* work space: sources and pressures of the discs of this rank, ghosts included */
  PetscInt     size;
} Ride;

static PetscErrorCode Options(PgStudy study, PetscOptionItems *PetscOptionsObject)
{
  PetscBool set;

  PetscFunctionBeginUser;
  if (!study->help) PetscCall(PetscStrncpy(study->only, "cg-hypre,cg-gamg,cg-cholmod,cg-icc,cg-jacobi", 512));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-study_solvers", &set));
  if (set) study->only[0] = '\0'; /* the choice above is one among the shipped solvers */
  PetscCall(PgStudySolverOptions(study, PetscOptionsObject));
  PetscCall(PgOptionInt(PetscOptionsObject, "-study_steps", "fluid steps measured; 0: to the end of the run", 0,
                        PETSC_MAX_INT, &study->steps, NULL));
  PetscCall(PgOptionInt(PetscOptionsObject, "-study_skip", "fluid steps before the first that is measured", 0,
                        PETSC_MAX_INT, &study->skip, NULL));
  PetscCall(PgOptionInt(PetscOptionsObject, "-study_windows", "parts of the run that are also shown by themselves", 1,
                        100, &study->windows, NULL));
  PetscFunctionReturn(0);
}

/* The reference of PgPressure, read as PgPore reads it. */
static PetscErrorCode Reference(PetscReal *reference)
{
  PetscFunctionBeginUser;
  *reference = 1e5;
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-initial_pressure", reference, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-pressure_reference", reference, NULL));
  PetscFunctionReturn(0);
}

/* Options of a rider: those of its line, and that a failure is counted instead of ending the run. */
static PetscErrorCode Mount(const Rider *rider, PgOverride *o)
{
  PetscFunctionBeginUser;
  PetscCall(PgSolverPut(rider->solver, "pressure_", o));
  PetscCall(PgOverrideSet(o, "-pressure", "implicit"));
  PetscCall(PgOverrideSet(o, "-pressure_error_if_not_converged", "false"));
  PetscCall(PgOverrideRemove(o, "-pressure_dump"));
  PetscFunctionReturn(0);
}

static PetscErrorCode CreateRiders(Ride *ride)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(ride->list.count, &ride->rider));
  for (PetscInt k = 0; k < ride->list.count; k++) {
    Rider      *r = &ride->rider[k];
    PgOverride  o = {0};
    char        name[64];
    PgFieldInfo info = {name, 1, "Pa", "last solution of a solver that goes along", PG_FIELD_MIGRATE};

    r->solver = &ride->list.solver[k];
    PetscCall(PetscSNPrintf(name, sizeof name, "study_solution_%" PetscInt_FMT, k));
    PetscCall(PgParticlesRegisterField(ride->particles, &info, &r->last));
    PetscCall(PetscCalloc4(ride->steps, &r->iterations, ride->steps, &r->seconds, ride->steps, &r->built, ride->steps,
                           &r->residual));
    PetscCall(Mount(r, &o));
    {
      PgSph sph;
      PetscCall(PgPoreGetParts(ride->pore, &sph, NULL));
      PetscCall(PgPressureCreate(ride->particles, ride->neighbors, sph, &r->pressure));
    }
    PetscCall(PgPressureSetFromOptions(r->pressure));
    PetscCall(PgPressureSetReference(r->pressure, ride->reference));
    PetscCall(PgSolverTake(r->solver, &o));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Reserve(Ride *ride)
{
  PetscInt owned, ghosts;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(ride->particles, &owned, &ghosts, NULL));
  if (owned + ghosts <= ride->size) PetscFunctionReturn(0);
  ride->size = owned + ghosts + (owned + ghosts) / 8;
  PetscCall(PetscFree2(ride->Z, ride->p));
  PetscCall(PetscMalloc2(ride->size, &ride->Z, ride->size, &ride->p));
  PetscFunctionReturn(0);
}

/* The source of the step just done, from its right-hand side: b_a = -Z_a dV_a plus what prescribed pressures put there,
   which is the right-hand side of a rider before it has a source. */
static PetscErrorCode RecoverSource(Ride *ride)
{
  PgPressure         pressure;
  Vec                b, lift;
  const PetscScalar *all, *part;
  PetscReal         *volume, *fixed;
  PetscInt           owned;
  PgField            field;

  PetscFunctionBeginUser;
  PetscCall(PgPoreGetParts(ride->pore, NULL, &pressure));
  PetscCall(PgPressureGetSystem(pressure, NULL, &b, NULL));
  PetscCall(PgPressureGetSystem(ride->rider[0].pressure, NULL, &lift, NULL));
  PetscCall(PgParticlesGetSizes(ride->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesFindField(ride->particles, "volume", &field));
  PetscCall(PgParticlesGetArray(ride->particles, field, &volume));
  PetscCall(PgParticlesFindField(ride->particles, "pressure_fixed", &field));
  PetscCall(PgParticlesGetArray(ride->particles, field, &fixed));
  PetscCall(VecGetArrayRead(b, &all));
  PetscCall(VecGetArrayRead(lift, &part));
  for (PetscInt a = 0; a < owned; a++) ride->Z[a] = fixed[a] != 0.0 ? 0.0 : -(all[a] - part[a]) / volume[a];
  PetscCall(VecRestoreArrayRead(b, &all));
  PetscCall(VecRestoreArrayRead(lift, &part));
  PetscFunctionReturn(0);
}

/* One rider's solve: its last solution goes into the field pressure as guess, and the result back into its own field. */
static PetscErrorCode SolveOne(Ride *ride, Rider *r, PetscReal p[], PetscReal rhs, PetscInt step)
{
  PgPressureStats stats;
  PetscReal      *last, begin;
  PetscInt        owned, before, after;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(ride->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(ride->particles, r->last, &last));
  for (PetscInt a = 0; a < owned; a++) p[a] = ride->reference + last[a];
  PetscCall(PgPressureGetCounts(r->pressure, NULL, NULL, &before));
  PetscCall(PgClock(ride->study->comm, &begin));
  PetscCall(PgPressureSolve(r->pressure, ride->Z, &stats));
  PetscCall(PgClockSince(ride->study->comm, begin, &r->seconds[step]));
  PetscCall(PgPressureGetCounts(r->pressure, NULL, NULL, &after));
  /* the source went through a subtraction and a division; a wrong one is wrong by far more */
  PetscCheck(!(PetscAbsReal(stats.rhs_norm - rhs) > 1e-6 * rhs), ride->study->comm, PETSC_ERR_PLIB,
             "||b|| = %g Pa in the run and %g Pa in the study", (double)rhs, (double)stats.rhs_norm);
  r->iterations[step] = stats.reason > 0 ? stats.iterations : -1;
  r->residual[step]   = stats.residual;
  r->built[step]      = (PetscBool)(after > before);
  for (PetscInt a = 0; a < owned; a++) last[a] = p[a] - ride->reference;
  PetscFunctionReturn(0);
}

/* All riders solve the system of the step just done; the run does not notice. */
static PetscErrorCode SolveAll(Ride *ride, PetscInt step)
{
  PetscInt   owned, ghosts;
  PetscReal *p, rhs;
  PgField    field;
  PgPressure pressure;
  Vec        b;

  PetscFunctionBeginUser;
  PetscCall(Reserve(ride));
  PetscCall(PgPoreGetParts(ride->pore, NULL, &pressure));
  PetscCall(PgPressureGetSystem(pressure, NULL, &b, NULL));
  PetscCall(VecNorm(b, NORM_2, &rhs));
  PetscCall(PgParticlesGetSizes(ride->particles, &owned, &ghosts, NULL));
  PetscCall(PgParticlesFindField(ride->particles, "pressure", &field));
  PetscCall(PgParticlesGetArray(ride->particles, field, &p));
  PetscCall(PetscArraycpy(ride->p, p, owned + ghosts));
  for (PetscInt k = 0; k < ride->list.count; k++) {
    Rider         *r = &ride->rider[k];
    PgOverride     o = {0};
    PgTrouble      trouble;
    PetscErrorCode code;

    r->iterations[step] = -1;
    if (r->dead) continue;
    PetscCall(Mount(r, &o)); /* solvers inside a preconditioner read their options when they are made */
    PetscCall(PgTroubleBegin(&trouble));
    code = PgPressureUpdate(r->pressure, NULL);
    if (!code && k == 0) code = RecoverSource(ride);
    if (!code) code = SolveOne(ride, r, p, rhs, step);
    PetscCall(PgTroubleEnd(ride->study->comm, &code));
    PetscCall(PgSolverTake(r->solver, &o));
    if (!code) continue;
    r->dead = PETSC_TRUE;
    PetscCall(PetscPrintf(ride->study->comm, "solver %s gives up at step %" PetscInt_FMT ": %s\n", r->solver->name,
                          step, trouble.message));
  }
  PetscCall(PetscArraycpy(p, ride->p, owned + ghosts));
  PetscFunctionReturn(0);
}

static PetscErrorCode Observe(Ride *ride, PetscInt step)
{
  PetscInt  plates;
  PetscReal total;

  PetscFunctionBeginUser;
  PetscCall(PgDemGetPlateCount(ride->dem, &plates));
  if (plates > 0) PetscCall(PgDemGetLoad(ride->dem, plates - 1, &ride->load[step], &total));
  PetscCall(PgNeighborsGetRevision(ride->neighbors, &ride->lists[step]));
  PetscFunctionReturn(0);
}

/* Figures of a rider in steps [begin, end). */
static PetscErrorCode FillWindow(Ride *ride, const Rider *r, PgTable table, PetscInt begin, PetscInt end)
{
  PetscReal its = 0.0, time = 0.0, with = 0.0, load = 0.0, residual = 0.0, *plain, median, N;
  PetscInt  n = 0, builds = 0, plains = 0, least = PETSC_MAX_INT, most = 0, global;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(ride->particles, NULL, NULL, &global));
  N = (PetscReal)global;
  PetscCall(PetscMalloc1(end - begin, &plain));
  for (PetscInt i = begin; i < end; i++) {
    load += ride->load[i] / (PetscReal)(end - begin);
    if (r->iterations[i] < 0) continue;
    n++;
    its += (PetscReal)r->iterations[i];
    time += r->seconds[i];
    residual = PetscMax(residual, r->residual[i]);
    least    = PetscMin(least, r->iterations[i]);
    most     = PetscMax(most, r->iterations[i]);
    builds += r->built[i];
    if (r->built[i])
      with += r->seconds[i];
    else
      plain[plains++] = r->seconds[i];
  }
  median = PgMedian(plains, plain);
  PetscCall(PetscFree(plain));
  PgTableText(table, COLUMN_SOLVER, "%s", r->solver->name);
  PgTableReal(table, COLUMN_N, N);
  PgTableReal(table, COLUMN_FIRST, (PetscReal)(ride->study->skip + begin + 1));
  PgTableReal(table, COLUMN_LAST, (PetscReal)(ride->study->skip + end));
  PgTableReal(table, COLUMN_LOAD, load);
  PgTableReal(table, COLUMN_LISTS, (PetscReal)(ride->lists[end - 1] - ride->lists[PetscMax(begin - 1, 0)]));
  PgTableReal(table, COLUMN_FAILED, (PetscReal)(end - begin - n));
  if (n) {
    PgTableReal(table, COLUMN_ITERATIONS, its / (PetscReal)n);
    PgTableReal(table, COLUMN_LEAST, (PetscReal)least);
    PgTableReal(table, COLUMN_MOST, (PetscReal)most);
    PgTableReal(table, COLUMN_BUILDS, (PetscReal)builds);
    PgTableReal(table, COLUMN_TIME, 1e6 * time / ((PetscReal)n * N));
    PgTableReal(table, COLUMN_PLAIN, 1e6 * median / N);
    if (builds && plains) PgTableReal(table, COLUMN_BUILD_TIME, 1e6 * (with / (PetscReal)builds - median) / N);
    PgTableReal(table, COLUMN_RESIDUAL, residual);
  }
  PetscFunctionReturn(0);
}

/* The whole run for every solver, with the iterations of each step as history, then its windows. */
static PetscErrorCode Report(Ride *ride)
{
  PgTable    table, windows;
  PetscReal *history;
  PetscInt   parts = ride->study->windows;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(ride->steps, &history));
  PetscCall(PgTableCreate(&ride->study->files, "study", COLUMNS, columns, &table));
  for (PetscInt k = 0; k < ride->list.count; k++) {
    const Rider *r = &ride->rider[k];
    for (PetscInt i = 0; i < ride->steps; i++) history[i] = (PetscReal)r->iterations[i];
    PetscCall(FillWindow(ride, r, table, 0, ride->steps));
    PetscCall(PgTableEndRow(table, ride->steps, history, "1", "iterations of each fluid step, -1: failed"));
  }
  PetscCall(PgTableDestroy(&table));
  PetscCall(PetscFree(history));
  if (parts < 2 || parts > ride->steps) PetscFunctionReturn(0);
  PetscCall(PetscPrintf(ride->study->comm, "\nin %" PetscInt_FMT " parts of the run:\n", parts));
  PetscCall(PgTableCreate(&ride->study->files, "windows", COLUMNS, columns, &windows));
  for (PetscInt k = 0; k < ride->list.count; k++) {
    for (PetscInt w = 0; w < parts; w++) {
      PetscCall(FillWindow(ride, &ride->rider[k], windows, ride->steps * w / parts, ride->steps * (w + 1) / parts));
      PetscCall(PgTableEndRow(windows, 0, NULL, NULL, NULL));
    }
  }
  PetscCall(PgTableDestroy(&windows));
  PetscFunctionReturn(0);
}

/* Steps to the end of the run as its options set it: the simulation has them, but not for others to see. */
static PetscErrorCode CountSteps(Ride *ride)
{
  PgStudy study = ride->study;

  PetscFunctionBeginUser;
  ride->steps = study->steps;
  if (!ride->steps) {
    PetscReal end;
    PetscInt  every = 1;
    PetscReal dt, displacement = 0.012, velocity = 6.18e-2;
    PetscBool set;
    PetscCall(PgSimulationGetTime(ride->sim, NULL, NULL, &dt));
    PetscCall(PetscOptionsGetInt(NULL, NULL, "-fluid_every", &every, NULL));
    PetscCall(PetscOptionsGetReal(NULL, NULL, "-panel_displacement", &displacement, NULL));
    PetscCall(PetscOptionsGetReal(NULL, NULL, "-panel_velocity", &velocity, NULL));
    PetscCall(PetscOptionsGetReal(NULL, NULL, "-end_time", &end, &set));
    if (!set) end = displacement / velocity;
    ride->steps = PetscMax(1, (PetscInt)PetscCeilReal(end / (dt * (PetscReal)every) - 1e-9) - study->skip);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Prepare(PgStudy study, Ride *ride)
{
  PgOverride o = {0};

  PetscFunctionBeginUser;
  ride->study = study;
  PetscCall(PgSolverListRead(study->comm, study->solver_file, study->only, &ride->list));
  PetscCall(PgSolverListCheck(study->comm, &ride->list));
  PetscCall(PgOverrideRemove(&o, "-output")); /* a study does not write over the results of a run */
  PetscCall(PgSimulationCreate(study->comm, &ride->sim));
  PetscCall(PgSimulationSetFromOptions(ride->sim));
  PetscCall(PgSimulationGetParts(ride->sim, &ride->particles, &ride->neighbors, &ride->dem, &ride->pore));
  PgInputCheck(ride->pore, study->comm,
               "-study stepping needs water: -fluid darcy or ns, or -options_file with a case");
  PetscCall(PgSimulationSetUp(ride->sim));
  PetscCall(PgOverrideRestore(&o, NULL));
  PetscCall(Reference(&ride->reference));
  PetscCall(CountSteps(ride));
  PetscCall(PetscCalloc2(ride->steps, &ride->load, ride->steps, &ride->lists));
  PetscCall(CreateRiders(ride));
  PetscFunctionReturn(0);
}

static PetscErrorCode CleanUp(Ride *ride)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < ride->list.count; k++) {
    Rider *r = &ride->rider[k];
    PetscCall(PgPressureDestroy(&r->pressure));
    PetscCall(PetscFree4(r->iterations, r->seconds, r->built, r->residual));
  }
  PetscCall(PetscFree(ride->rider));
  PetscCall(PetscFree2(ride->Z, ride->p));
  PetscCall(PetscFree2(ride->load, ride->lists));
  PetscCall(PgSimulationDestroy(&ride->sim));
  PetscCall(PgSolverListDestroy(&ride->list));
  PetscFunctionReturn(0);
}

static PetscErrorCode RunStudy(PgStudy study)
{
  Ride        ride = {0};
  PetscMPIInt size;
  PetscInt    global;

  PetscFunctionBeginUser;
  PetscCall(Prepare(study, &ride));
  PetscCallMPI(MPI_Comm_size(study->comm, &size));
  PetscCall(PgParticlesGetSizes(ride.particles, NULL, NULL, &global));
  PetscCall(PetscPrintf(study->comm,
                        "%" PetscInt_FMT " solvers of %s go along a run of %" PetscInt_FMT " discs for %" PetscInt_FMT
                        " fluid steps after %" PetscInt_FMT
                        ", kept preconditioners, own last solution as guess; %s time\n",
                        ride.list.count, ride.list.file, global, ride.steps, study->skip, size > 1 ? "wall" : "CPU"));
  (void)fflush(stdout);
  for (PetscInt i = 0; i < study->skip; i++) PetscCall(PgSimulationStep(ride.sim));
  for (PetscInt i = 0; i < ride.steps; i++) {
    PetscCall(PgSimulationStep(ride.sim));
    PetscCall(SolveAll(&ride, i));
    PetscCall(Observe(&ride, i));
  }
  PetscCall(Report(&ride));
  PetscCall(CleanUp(&ride));
  PetscFunctionReturn(0);
}

const PgStudyKind PgStudyStepping = {"stepping", "kept preconditioners over the steps of a run", Options, RunStudy};
