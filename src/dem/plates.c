/* Plates: which discs they move. The forces on these discs are in forces.c. */
#include "demimpl.h"

PetscErrorCode PgDemAddPlate(PgDem dem, const PgPlate *plate, PetscInt *index)
{
  PetscFunctionBeginUser;
  PgInputCheck(plate->hold || plate->side == 1 || plate->side == -1, PgParticlesComm(dem->particles),
               "plate %s: side %g is neither +1 (above its discs) nor -1 (below)", plate->name, (double)plate->side);
  if (dem->plate_count == dem->plate_room) {
    dem->plate_room += 4;
    PetscCall(PetscRealloc((size_t)dem->plate_room * sizeof(*dem->plates), &dem->plates));
  }
  dem->plates[dem->plate_count] = *plate;
  dem->plate_discs_made         = -1;
  if (index) *index = dem->plate_count;
  dem->plate_count++;
  PetscFunctionReturn(0);
}

PetscReal PgDemPlateFriction_Private(PgDem dem, const PgPlate *plate)
{
  return plate->friction < 0 ? dem->plate_friction : plate->friction;
}

PetscErrorCode PgDemGetPlate(PgDem dem, PetscInt index, PgPlate *plate)
{
  PetscFunctionBeginUser;
  PetscCheck(index >= 0 && index < dem->plate_count, PgParticlesComm(dem->particles), PETSC_ERR_ARG_OUTOFRANGE,
             "no plate %" PetscInt_FMT " among %" PetscInt_FMT, index, dem->plate_count);
  *plate          = dem->plates[index];
  plate->friction = PgDemPlateFriction_Private(dem, plate);
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemGetPlateCount(PgDem dem, PetscInt *count)
{
  PetscFunctionBeginUser;
  *count = dem->plate_count;
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemUpdatePlateDiscs_Private(PgDem dem)
{
  PetscInt   revision, owned, count = 0;
  PetscReal *plate;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetRevision(dem->particles, &revision));
  if (revision == dem->plate_discs_made) PetscFunctionReturn(0);
  PetscCall(PgParticlesGetSizes(dem->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(dem->particles, dem->plate, &plate));
  for (PetscInt i = 0; i < owned; i++) count += plate[i] != 0;
  if (count > dem->plate_disc_room) {
    PetscCall(PetscFree(dem->plate_disc));
    PetscCall(PetscMalloc1(count, &dem->plate_disc));
    dem->plate_disc_room = count;
  }
  dem->plate_disc_count = 0;
  for (PetscInt i = 0; i < owned; i++) {
    if (plate[i] == 0) continue;
    PetscCheck(plate[i] >= 1 && plate[i] <= (PetscReal)dem->plate_count, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "field plate holds %g, but there are %" PetscInt_FMT " plates", (double)plate[i], dem->plate_count);
    dem->plate_disc[dem->plate_disc_count++] = i;
  }
  dem->plate_discs_made = revision;
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemImposePlates_Private(PgDem dem)
{
  PetscReal *plate, *v, *w;

  PetscFunctionBeginUser;
  PetscCall(PgDemUpdatePlateDiscs_Private(dem));
  PetscCall(PgParticlesGetArray(dem->particles, dem->plate, &plate));
  PetscCall(PgParticlesGetArray(dem->particles, PG_VELOCITY, &v));
  PetscCall(PgParticlesGetArray(dem->particles, PG_ANGULAR_VELOCITY, &w));
  for (PetscInt k = 0; k < dem->plate_disc_count; k++) {
    const PetscInt i = dem->plate_disc[k];
    const PgPlate *p = &dem->plates[(PetscInt)plate[i] - 1];

    v[2 * i + 1] = p->hold ? 0 : p->velocity;
    if (p->hold) v[2 * i] = w[i] = 0;
  }
  PetscFunctionReturn(0);
}
