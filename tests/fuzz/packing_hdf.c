/* Fuzz target: the reader of HDF5 packings. Every disc that is accepted can be used. */
#include "fuzz.h"
#include <math.h>
#include <porograin/io.h>

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  (void)argc;
  (void)argv;
  FuzzStart();
  return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  PgPacking packing;

  FuzzWrite("packing.h5", data, size);
  if (PgPackingRead(PETSC_COMM_SELF, "packing.h5", "", &packing)) return 0;
  Demand(packing.global > 0 && packing.count == packing.global && packing.start == 0);
  for (PetscInt i = 0; i < packing.count; i++) {
    Demand(isfinite(packing.position[2 * i]) && isfinite(packing.position[2 * i + 1]));
    Demand(isfinite(packing.velocity[2 * i]) && isfinite(packing.velocity[2 * i + 1]));
    Demand(isfinite(packing.radius[i]) && packing.radius[i] > 0);
  }
  if (packing.periodic) Demand(isfinite(packing.low) && packing.low < packing.high);
  Demand(!PgPackingDestroy(&packing));
  return 0;
}
