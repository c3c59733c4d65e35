/* Ergun's pressure drop in a fixed bed (Li, Chu & Sheng 2007, Eq. 20; Ergun 1952).

   Physics   the averaged Navier-Stokes equations in a fixed bed under a pressure difference, from rest until steady;
             or with the Darcy velocity U through the bottom prescribed (-bc_bottom flux -bc_bottom_flux U).
   Exact     D/L = 150 (1-n)^2 mu U/(n^3 d^2) + 1.75 (1-n) rho_f U^2/(n^3 d), U = n u uniform. The default D is that of
             U = 0.13 m/s, the inflow of the paper's Case II, where the quadratic part is 17 times the linear one.
   Order     steady state of a uniform velocity: exact but for rounding, the solver and what is left of the start,
             with the `corrected` operators; first order in spacing/L with the `paper` Laplacian (cut kernels). */
#include "bed.h"

static PetscErrorCode Create(MPI_Comm comm, void **context)
{
  const PgBed initial = {{.columns = 8, .rows = 25, .radius = 5e-3, .porosity = -1.0, .held = PETSC_TRUE}, 2e-2};

  PetscFunctionBeginUser;
  PetscCall(PgBedCreate(comm,
                        "-fluid ns -dt 1e-4 -ns_continuity averaged -bc_bottom drained -bc_bottom_pressure 832000 "
                        "-bc_top drained -bc_top_pressure 100000 -detach_porosity 0.9",
                        &initial, context));
  PetscFunctionReturn(0);
}

const PgCaseInfo PgCaseBedErgun = {"bed_ergun",  "fixed bed under a pressure difference, Navier-Stokes: Ergun's law",
                                   Create,       PgBedSetup,
                                   PgBedDestroy, NULL};
