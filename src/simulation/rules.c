/* Which options have an effect only in company: a table, so that none is passed over in silence. What to do about one that
   has none is decided in one place, PgOptionsCheck(). */
#include "simulationimpl.h"

#define SIDE(side)                                                                                                     \
  {"-bc_" side "_pressure", "-bc_" side " drained", "only a drained side has a pressure"},                             \
  {                                                                                                                    \
    "-bc_" side "_flux", "-bc_" side " flux", "only a flux side has a flux"                                            \
  }

static const char rolling[] = "only that law has a rolling resistance";
static const char solves[]  = "only -pressure implicit has a solver and its tolerances";
static const char factors[] = "the matrix of each solve is factored anew";

static const PgOptionRule rules[] = {
    {"-fluid_every", "-fluid darcy|ns", "there is no water to step"},
    {"-output_every", "-output", "there is no file for snapshots"},
    {"-checkpoint_every", "-checkpoint", "there is no file for checkpoints"},
    {"-progress_every", "-progress auto|lines", "there are no lines of progress"},
    {"-plate_friction", "plates", "there is nothing that it belongs to"},
    {"-wall_friction", "walls", "there is nothing that it belongs to"},
    {"-wall_servo_gain", "servo walls", "there is nothing that it belongs to"},
    {"-dem_bond_*", "-dem_contact_law tak2013", "only that law has bonds"},
    {"-dem_hertz_*", "-dem_contact_law hertz", "only that law asks for an elastic material"},
    {"-dem_k_n", "-dem_contact_law li2007|tak2013", "Hertz' law takes the stiffness from the material"},
    {"-dem_k_r", "-dem_contact_law li2007", rolling},
    {"-dem_k_theta", "-dem_contact_law li2007", rolling},
    {"-dem_c_r", "-dem_contact_law li2007", rolling},
    {"-dem_c_theta", "-dem_contact_law li2007", rolling},
    {"-dem_mu_r", "-dem_contact_law li2007", rolling},
    {"-dem_mu_theta_r", "-dem_contact_law li2007", rolling},
    {"-dem_energy", "-dem_contact_law li2007", "the accounts are those of that law"},
    {"-packing_aspect", "-packing_count", "-packing_size has an aspect of its own"},
    {"-packing_second_share", "-packing_second_radius", "there is one size of discs only"},
    {"-packing_plate_distance", "-packing_plates", "there are no plates"},
    {"-packing_side_distance", "-fluid darcy|ns", "only water sees these sides"},
    {"-bed_layer_radius", "-bed_layer_rows", "there is one layer only"},
    {"-packing_porosity", "-fluid darcy|ns or -output", "only water and result files have a porosity"},
    {"-ns_*", "-fluid ns", "it belongs to the Navier-Stokes scheme"},
    {"-permeability", "-fluid darcy", "the Navier-Stokes scheme has a drag law (-ns_drag) in its place"},
    {"-permeability_law", "-fluid darcy", "the Navier-Stokes scheme has a drag law (-ns_drag) in its place"},
    {"-coupling_scheme", "-coupling drag_and_pressure", "the drag alone needs no scheme"},
    {"-porosity_rate", "-fluid darcy or -ns_continuity averaged",
     "div u = 0 does not contain the rate of the porosity"},
    SIDE("left"),
    SIDE("right"),
    SIDE("bottom"),
    SIDE("top"),
    {"-bc_surface_sum", "-bc_tracking surface", "discs do not become surface later"},
    {"-sph_operators", "no -sph_gradient or no -sph_laplacian", "these two say all that there is to choose"},
    {"-pressure_sweeps", "-pressure explicit", "only explicit steps are made of sweeps"},
    {"-pressure_dump_every", "-pressure_dump", "there is no file for systems"},
    {"-pressure_pc_lag", "-pressure implicit", solves},
    {"-pressure_rebuild_factor", "-pressure implicit", solves},
    {"-pressure_pc_lag", "-pressure_ksp_type !preonly", factors},
    {"-pressure_rebuild_factor", "-pressure_ksp_type !preonly", factors},
    {"-pressure_rebuild_factor", "-pressure_pc_lag !1", "each solve has a preconditioner of its own"},
    {"-pressure_rebuild_factor", "-pressure_ksp_type !richardson or -pressure_ksp_max_it !1",
     "iterations do not grow when there is one"},
    {"-pressure_guess", "-pressure explicit or -pressure_ksp_type !preonly or a free level of pressure",
     "a factor gives the solution from any start"},
    {"-pressure_error_if_not_converged", "-pressure implicit", solves},
    {"-pressure_ksp_*", "-pressure implicit", solves},
    {"-pressure_pc_*", "-pressure implicit", solves},
    {"-pressure_sub_*", "-pressure implicit", solves},
    {"-pressure_mg_*", "-pressure implicit", solves},
    {"-pressure_mat_*", "-pressure implicit", solves},
    {"-pressure_pc_hypre_*", "-pressure_pc_type hypre", "it belongs to another preconditioner"},
};

/* What is true of the run beside its options. */
static PetscBool Fact(void *simulation, const char name[])
{
  PgSimulation sim = (PgSimulation)simulation;
  PetscInt     plates, walls, servos = 0;

  if (!strcmp(name, "a free level of pressure")) { /* the equation leaves it open, and the guess decides */
    for (int k = 0; k < PG_SIDE_COUNT; k++) {
      PgBoundary side;
      if (!sim->pore || PgPoreGetBoundary(sim->pore, (PgSide)k, &side)) return PETSC_TRUE;
      if (side.kind == PG_BC_DRAINED) return PETSC_FALSE;
    }
    return PETSC_TRUE;
  }
  if (PgDemGetPlateCount(sim->dem, &plates) || PgDemGetWallCount(sim->dem, &walls)) return PETSC_TRUE;
  if (!strcmp(name, "plates")) return (PetscBool)(plates > 0);
  for (PetscInt k = 0; k < walls; k++) {
    PgWall wall;
    if (PgDemGetWall(sim->dem, k, &wall)) return PETSC_TRUE;
    servos += wall.kind == PG_WALL_SERVO;
  }
  return (PetscBool)(!strcmp(name, "walls") ? walls > 0 : servos > 0);
}

PetscErrorCode PgSimulationCheckOptions(PgSimulation sim)
{
  const PgOptionRules all      = {sizeof rules / sizeof *rules, rules, Fact, sim};
  PgPressure          pressure = NULL;

  PetscFunctionBeginUser;
  if (sim->pore) PetscCall(PgPoreGetParts(sim->pore, NULL, &pressure));
  PetscCall(PgOptionsCheck(sim->comm, &all, pressure ? PgPressureProbeOptions : NULL, pressure));
  PetscFunctionReturn(0);
}
