/* Fuzz target: the reader of meshes. Whatever the file, it is refused with a reason, or PETSc makes a mesh of
   quadrilaterals of it whose coordinates are there. */
#include "../../src/fem/femimpl.h"
#include "fuzz.h"

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  (void)argc;
  (void)argv;
  FuzzStart();
  return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  DM          dm    = NULL;
  PgFemGroup *group = NULL;
  PetscInt    groups, start, end;
  Vec         place;
  PetscReal   largest;

  FuzzWrite("mesh.msh", data, size);
  if (PgFemGmshRead(PETSC_COMM_SELF, "mesh.msh", &dm, &groups, &group)) return 0;
  Demand(dm != NULL && groups >= 0);
  for (PetscInt k = 0; k < groups; k++) Demand(group[k].tag > 0 && strlen(group[k].name) < PG_FEM_NAME);
  Demand(!DMPlexGetHeightStratum(dm, 0, &start, &end) && end > start);
  Demand(!DMGetCoordinatesLocal(dm, &place) && !VecNorm(place, NORM_INFINITY, &largest));
  Demand(!PetscFree(group) && !DMDestroy(&dm));
  return 0;
}
