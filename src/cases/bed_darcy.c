/* Darcy's law in a fixed bed (theory.md, section 5).

   Physics   water at a constant permeability k_p between a bottom at p_0 + D and a top at p_0, drained both; or
             with the flux w through the bottom prescribed instead (-bc_bottom flux -bc_bottom_flux W).
   Exact     p = p_0 + D (1 - y/L), w = k_p D/L, with L between the centres of the two outer rows, where the
             pressure is prescribed. With a flux: p - p_0 = w (L - y)/k_p. Two layers (-bed_layer_rows) in series,
             -permeability_law kozeny_carman: w = D/(L_1/k_1 + L_2/k_2).
   Order     `corrected` Laplacian: exact but for rounding and the solver. `paper` Laplacian: the kernels of the
             rows next to the sides are cut, an error of first order in spacing/L; with a prescribed flux the pressure is
             off by the lattice factor of the Laplacian besides (0.924 at eta = 0.1, 1.011 at 0.01), at any size. */
#include "bed.h"

static PetscErrorCode Create(MPI_Comm comm, void **context)
{
  const PgBed initial = {{.columns = 8, .rows = 25, .radius = 5e-3, .porosity = -1.0, .held = PETSC_TRUE}, 1e-2};

  PetscFunctionBeginUser;
  PetscCall(PgBedCreate(comm,
                        "-fluid darcy -dt 1e-3 -bc_bottom drained -bc_bottom_pressure 101000 -bc_top drained "
                        "-bc_top_pressure 100000",
                        &initial, context));
  PetscFunctionReturn(0);
}

const PgCaseInfo PgCaseBedDarcy = {"bed_darcy",  "fixed bed under a pressure difference, Darcy's law: linear pressure",
                                   Create,       PgBedSetup,
                                   PgBedDestroy, NULL};
