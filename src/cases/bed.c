/* What the cases of water in a fixed bed share: a hexagonal lattice, periodic in x, whose discs are all held. Its
   contacts carry nothing, so their stiffness is chosen not to limit the time step. */
#include "bed.h"

static const char held_discs[] = "-dem_k_n 1 -dem_k_s 1 -dem_k_r 0 -dem_k_theta 0 ";

PetscErrorCode PgBedCreate(MPI_Comm comm, const char defaults[], const PgBed *initial, void **context)
{
  PgBed *bed;
  char   all[1024];

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&bed));
  *bed = *initial;
  PetscCall(PetscStrncpy(all, held_discs, sizeof all));
  PetscCall(PetscStrlcat(all, defaults, sizeof all));
  PetscCall(PgCaseDefaults(all));
  PetscOptionsBegin(comm, "", "case bed_*: water in a fixed bed", "");
  PetscCall(PgLatticeOptions(PetscOptionsObject, "bed", &bed->lattice));
  PetscCall(PgOptionReal(PetscOptionsObject, "-bed_porosity",
                         "porosity, by the spacing of the discs; -1: discs just touch", "1", -1.0, 0.5,
                         &bed->lattice.porosity, NULL));
  PetscCall(PgOptionInt(PetscOptionsObject, "-bed_layer_rows", "rows at the bottom whose discs have -bed_layer_radius",
                        0, 1000000, &bed->lattice.layer_rows, NULL));
  bed->lattice.layer_radius = bed->lattice.radius;
  PetscCall(PgOptionReal(PetscOptionsObject, "-bed_layer_radius", "radius of the discs of the lower layer", "m",
                         PG_POSITIVE, 1e3, &bed->lattice.layer_radius, NULL));
  PetscOptionsEnd();
  PgInputCheck(2.0 * bed->lattice.layer_radius <= PgLatticeSpacing(&bed->lattice) * (1.0 + 1e-12), comm,
               "option -bed_layer_radius: discs of %g m overlap on a lattice of spacing %g m",
               (double)bed->lattice.layer_radius, (double)PgLatticeSpacing(&bed->lattice));
  *context = bed;
  PetscFunctionReturn(0);
}

PetscErrorCode PgBedSetup(void *context, PgCaseSetup *setup)
{
  const PgBed *bed = (const PgBed *)context;

  PetscFunctionBeginUser;
  PgInputCheck(setup->pore, setup->comm, "this case is about water: -fluid none leaves nothing of it");
  PetscCall(PgLatticeSetup(&bed->lattice, setup));
  setup->load_plate = -1; /* held discs give their plate no load */
  setup->end_time   = bed->end_time;
  PetscFunctionReturn(0);
}

PetscErrorCode PgBedDestroy(void **context)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(*context));
  PetscFunctionReturn(0);
}
