/* The averaged Navier-Stokes equations relax to Darcy's law in a fixed bed (Eqs. 64-66).

   Physics   water at rest in a fixed bed, to both ends of which a pressure difference D is applied at t = 0; drag by the
             linear part of Ergun's law (-ns_drag linear), or the whole law at small velocities.
   Exact     w = (k_p D/L) (1 - exp(-t/tau)), tau = rho_f n^2 d^2/(150 (1-n)^2 mu) = 7 ms, k_p by Eq. 66. With the
             whole law the limit is lower by the quadratic part, at first order w/(7.85 mm/s).
   Order     first in the fluid step (the drag is taken at the intermediate velocity): the rate observed is
             -log(1 - dt/tau)/dt. In space exact with the `corrected` operators, the velocity being uniform. */
#include "bed.h"

static PetscErrorCode Create(MPI_Comm comm, void **context)
{
  const PgBed initial = {{.columns = 8, .rows = 25, .radius = 5e-3, .porosity = -1.0, .held = PETSC_TRUE}, 3.5e-2};

  PetscFunctionBeginUser;
  PetscCall(PgBedCreate(comm,
                        "-fluid ns -dt 1e-4 -ns_continuity averaged -ns_drag linear -bc_bottom drained "
                        "-bc_bottom_pressure 100300 -bc_top drained -bc_top_pressure 100000",
                        &initial, context));
  PetscFunctionReturn(0);
}

const PgCaseInfo PgCaseBedNsToDarcy = {"bed_ns_to_darcy",
                                       "fixed bed, water set in motion: Navier-Stokes relaxes to Darcy's law",
                                       Create,
                                       PgBedSetup,
                                       PgBedDestroy,
                                       NULL};
