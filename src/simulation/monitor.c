/* History rows and snapshots, and when each is due. */
#include "simulationimpl.h"

const PgColumn PgHistoryColumns[COLUMN_COUNT] = {
    [COLUMN_TIME] = {"time", "s", "simulated time"},
    [COLUMN_DISPLACEMENT] =
        {"displacement", "m",
         "displacement of the loading plate against its side, or of the loading wall into the discs"},
    [COLUMN_LOAD] = {"load", "N/m", "reaction of the loading plate or wall to contact forces, positive in compression"},
    [COLUMN_LOAD_TOTAL]     = {"load_total", "N/m",
                               "reaction of the loading plate to all forces on its discs; of a wall: load"},
    [COLUMN_KINETIC_ENERGY] = {"kinetic_energy", "J/m", "translational and rotational kinetic energy of the discs"},
    [COLUMN_PRESSURE_MIN]   = {"pressure_min", "Pa", "smallest pore pressure"},
    [COLUMN_PRESSURE_MEAN]  = {"pressure_mean", "Pa", "mean pore pressure over the discs"},
    [COLUMN_PRESSURE_MAX]   = {"pressure_max", "Pa", "largest pore pressure"},
    [COLUMN_PRESSURE_ITERATIONS] = {"pressure_iterations", "1",
                                    "Krylov iterations or explicit sweeps of the last fluid step"},
    [COLUMN_PRESSURE_RESIDUAL]   = {"pressure_residual", "1",
                                    "true relative residual ||b - A p||/||b|| of the pressure used"},
    [COLUMN_PRESSURE_REMOVED]    = {"pressure_removed", "1",
                                    "part of the right-hand side removed to make a singular system solvable"},
    [COLUMN_RELATIVE_SPEED]      = {"relative_speed_max", "m/s", "largest |n (u - v)|"},
    [COLUMN_SURFACE]             = {"surface_discs", "1", "discs that came to a drained surface"},
    [COLUMN_DETACHED]            = {"detached_discs", "1", "discs outside the water"},
    [COLUMN_CLIPPED]             = {"clipped_porosities", "1", "porosities clipped in the last fluid step"},
    [COLUMN_CHARACTERISTIC]      = {"characteristic_failures", "1",
                                    "discs whose characteristic could not be followed in the last fluid step"},
    [COLUMN_LIST_BUILDS]         = {"list_builds", "1", "pair list builds so far"},
};

PetscBool PgMonitorDue(PgSimulation sim, PetscInt every)
{
  if (every <= 0) return PETSC_FALSE;
  return (PetscBool)(sim->step % every == 0 || sim->step == sim->steps);
}

PetscErrorCode PgMonitorGetBuilds(PgSimulation sim, PetscInt *builds)
{
  PetscFunctionBeginUser;
  PetscCall(PgNeighborsGetRevision(sim->neighbors, builds));
  *builds += sim->builds_before;
  PetscFunctionReturn(0);
}

PetscErrorCode PgMonitorFillRow(PgSimulation sim)
{
  PetscReal *row = sim->row;
  PetscInt   builds;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(row, sim->columns));
  row[COLUMN_TIME] = sim->time;
  if (sim->setup.load_plate >= 0) {
    PgPlate plate;
    PetscCall(PgDemGetPlate(sim->dem, sim->setup.load_plate, &plate));
    row[COLUMN_DISPLACEMENT] = -plate.side * plate.velocity * sim->time;
    PetscCall(PgDemGetLoad(sim->dem, sim->setup.load_plate, &row[COLUMN_LOAD], &row[COLUMN_LOAD_TOTAL]));
  }
  PetscCall(PgDemKineticEnergy(sim->dem, &row[COLUMN_KINETIC_ENERGY]));
  if (sim->pore) {
    PgPoreStats stats;
    PetscCall(PgPoreGetStats(sim->pore, &stats));
    row[COLUMN_PRESSURE_MIN]        = stats.p_min;
    row[COLUMN_PRESSURE_MEAN]       = stats.p_mean;
    row[COLUMN_PRESSURE_MAX]        = stats.p_max;
    row[COLUMN_PRESSURE_ITERATIONS] = (PetscReal)stats.pressure.iterations;
    row[COLUMN_PRESSURE_RESIDUAL]   = stats.pressure.residual;
    row[COLUMN_PRESSURE_REMOVED]    = stats.pressure.removed;
    row[COLUMN_RELATIVE_SPEED]      = stats.w_max;
    row[COLUMN_SURFACE]             = (PetscReal)stats.surface;
    row[COLUMN_DETACHED]            = (PetscReal)stats.detached;
    row[COLUMN_CLIPPED]             = (PetscReal)stats.clipped;
    row[COLUMN_CHARACTERISTIC]      = (PetscReal)stats.characteristic_failures;
  }
  PetscCall(PgMonitorGetBuilds(sim, &builds));
  row[COLUMN_LIST_BUILDS] = (PetscReal)builds;
  PetscCall(PgColumnsFill(sim));
  PetscFunctionReturn(0);
}

/* The peak is that of the history, however the run tells where it is. */
static PetscErrorCode AddRow(PgSimulation sim)
{
  PetscFunctionBeginUser;
  if (sim->row[COLUMN_LOAD] > sim->peak_load) {
    sim->peak_load         = sim->row[COLUMN_LOAD];
    sim->peak_displacement = sim->row[COLUMN_DISPLACEMENT];
  }
  if (sim->output) PetscCall(PgOutputHistory(sim->output, sim->row));
  PetscFunctionReturn(0);
}

/* Porosity of a run without water: discs keep their areas while the neighbourhood grows by the volumetric strain. Within
   the bounds of the porosity that water sees. */
static PetscErrorCode Porosity(PgSimulation sim, PetscBool *known)
{
  const PetscReal least = 0.01, most = 0.98;
  PetscReal      *start, largest     = 0.0;
  PetscInt        first, count;

  PetscFunctionBeginUser;
  *known = PETSC_FALSE;
  if (sim->porosity_start < 0) PetscFunctionReturn(0);
  PetscCall(PgParticlesGetArray(sim->particles, sim->porosity_start, &start));
  PetscCall(PgParticlesToIdOrder(sim->particles, 1, start, sim->porosity));
  PetscCall(PgParticlesGetIdRange(sim->particles, &first, &count));
  for (PetscInt i = 0; i < count; i++) {
    const PetscReal grown = 1.0 + sim->volumetric[i];
    PetscReal       n     = least;
    largest               = PetscMax(largest, sim->porosity[i]);
    if (grown > 0.0) n = 1.0 - (1.0 - sim->porosity[i]) / grown;
    sim->porosity[i] = PetscMax(least, PetscMin(most, n));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPIU_REAL, MPIU_MAX, sim->comm));
  *known = (PetscBool)(largest > 0.0);
  PetscFunctionReturn(0);
}

PetscErrorCode PgMonitorSnapshot(PgSimulation sim, PgOutput output)
{
  PetscBool porosity;

  PetscFunctionBeginUser;
  if (!output) PetscFunctionReturn(0);
  PetscCall(PgStagePush(PG_STAGE_OUTPUT));
  PetscCall(PgDemComputeObservables(sim->dem));
  PetscCall(PgStrainCompute(sim->strain, sim->effective, sim->volumetric));
  PetscCall(Porosity(sim, &porosity));
  {
    const PgExtraField extra[3] = {
        {"effective_strain", 1, "1", "nominal effective strain sqrt(2/3 e:e) of the neighbourhood at the start",
         sim->effective},
        {"volumetric_strain", 1, "1", "nominal volumetric strain det F - 1 of the neighbourhood at the start",
         sim->volumetric},
        {"porosity", 1, "1", "porosity n of the neighbourhood, 1 - (1 - n_0)/(1 + volumetric strain): without water",
         sim->porosity}};
    PetscCall(PgOutputSnapshot(output, sim->time, porosity ? 3 : 2, extra));
  }
  PetscCall(PgStagePop());
  PetscFunctionReturn(0);
}

PetscErrorCode PgMonitorStart(PgSimulation sim)
{
  PetscFunctionBeginUser;
  PetscCall(PgProgressStart(sim));
  if (sim->restart_file[0]) {
    PetscCall(PetscPrintf(sim->comm, "continued from %s, step %" PetscInt_FMT ", t = %.6e s\n", sim->restart_file,
                          sim->step * sim->fluid_every, (double)sim->time));
    PetscFunctionReturn(0); /* what belongs to this step was written before */
  }
  PetscCall(PgMonitorFillRow(sim));
  PetscCall(AddRow(sim));
  if (sim->output_every) PetscCall(PgMonitorSnapshot(sim, sim->output));
  PetscFunctionReturn(0);
}

PetscErrorCode PgMonitorStep(PgSimulation sim)
{
  const PetscBool history = PgMonitorDue(sim, sim->history_every), progress = PgMonitorDue(sim, sim->progress_every);

  PetscFunctionBeginUser;
  if (history || progress || sim->step == sim->steps) {
    PetscCall(PgMonitorFillRow(sim));
    if (history) PetscCall(AddRow(sim));
    if (progress) PetscCall(PgProgressLine(sim));
  }
  if (PgMonitorDue(sim, sim->output_every)) PetscCall(PgMonitorSnapshot(sim, sim->output));
  PetscCall(PgProgressBar(sim));
  PetscFunctionReturn(0);
}

PetscErrorCode PgMonitorEnd(PgSimulation sim)
{
  PetscFunctionBeginUser;
  if (sim->output) PetscCall(PgOutputFinish(sim->output));
  PetscCall(PgProgressSummary(sim));
  PetscFunctionReturn(0);
}
