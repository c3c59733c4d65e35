/* Halo exchange: the owners' values of any set of fields to their ghosts, one message to each neighbour. */
#include "particlesimpl.h"

/* MPI type of `components` reals in a row, made once. */
PetscErrorCode PgParticlesUnit(PgParticles particles, PetscInt components, MPI_Datatype *unit)
{
  PetscMPIInt n;

  PetscFunctionBeginUser;
  if (components >= particles->nunits) {
    PetscCall(PetscRealloc((size_t)(components + 1) * sizeof *particles->unit, &particles->unit));
    while (particles->nunits <= components) particles->unit[particles->nunits++] = MPI_DATATYPE_NULL;
  }
  if (particles->unit[components] == MPI_DATATYPE_NULL) {
    PetscCall(PetscMPIIntCast(components, &n));
    PetscCallMPI(MPI_Type_contiguous(n, MPIU_REAL, &particles->unit[components]));
    PetscCallMPI(MPI_Type_commit(&particles->unit[components]));
  }
  *unit = particles->unit[components];
  PetscFunctionReturn(0);
}

static PetscErrorCode ReserveBuffer(size_t needed, size_t *size, PetscReal **buffer)
{
  PetscFunctionBeginUser;
  if (needed > *size) {
    PetscCall(PetscFree(*buffer));
    *size = needed + needed / 8;
    PetscCall(PetscMalloc1(*size, buffer));
  }
  PetscFunctionReturn(0);
}

static PetscInt Components(PgParticles particles, PetscInt count, const PgField fields[])
{
  PetscInt components = 0;

  for (PetscInt f = 0; f < count; f++) components += particles->field[fields[f]]->info.components;
  return components;
}

static void Pack(PgParticles particles, PetscInt count, const PgField fields[], PetscInt components)
{
  PetscReal *buffer = particles->root_buffer;

  for (PetscInt f = 0; f < count; f++) {
    const PetscInt   c     = particles->field[fields[f]]->info.components;
    const PetscReal *array = particles->field[fields[f]]->array;
    for (PetscInt b = 0; b < particles->nroots; b++) {
      for (PetscInt k = 0; k < c; k++) buffer[b * components + k] = array[particles->root[b] * c + k];
    }
    buffer += c;
  }
}

static void Unpack(PgParticles particles, PetscInt count, const PgField fields[], PetscInt components)
{
  const PetscReal *buffer = particles->leaf_buffer;
  const PetscReal  period = particles->high - particles->low;

  for (PetscInt f = 0; f < count; f++) {
    const PetscInt c     = particles->field[fields[f]]->info.components;
    PetscReal     *array = particles->field[fields[f]]->array + particles->owned * c;
    for (PetscInt g = 0; g < particles->ghosts; g++) {
      for (PetscInt k = 0; k < c; k++) array[g * c + k] = buffer[g * components + k];
    }
    if (fields[f] == PG_POSITION && particles->periodic) {
      for (PetscInt g = 0; g < particles->ghosts; g++) {
        if (particles->image[g]) array[2 * g] += (PetscReal)particles->image[g] * period;
      }
    }
    buffer += c;
  }
}

PetscErrorCode PgParticlesHaloBegin(PgParticles particles, PetscInt count, const PgField fields[])
{
  const PetscInt components = Components(particles, count, fields);
  MPI_Datatype   unit;

  PetscFunctionBeginUser;
  if (!particles->any_ghosts || components == 0) PetscFunctionReturn(0);
  PetscCheck(particles->halo_active == 0, PETSC_COMM_SELF, PETSC_ERR_ORDER, "a halo exchange is under way already");
  for (PetscInt f = 0; f < count; f++) {
    PetscReal *array;
    PetscCall(PgParticlesGetArray(particles, fields[f], &array)); /* makes one that nobody has asked for */
  }
  PetscCall(PgStagePush(PG_STAGE_HALO));
  PetscCall(
      ReserveBuffer((size_t)(particles->nroots * components), &particles->root_buffer_size, &particles->root_buffer));
  PetscCall(
      ReserveBuffer((size_t)(particles->ghosts * components), &particles->leaf_buffer_size, &particles->leaf_buffer));
  Pack(particles, count, fields, components);
  PetscCall(PgParticlesUnit(particles, components, &unit));
  PetscCall(PetscSFBcastBegin(particles->halo, unit, particles->root_buffer, particles->leaf_buffer, MPI_REPLACE));
  particles->halo_active = components;
  PetscCall(PgStagePop());
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesHaloEnd(PgParticles particles, PetscInt count, const PgField fields[])
{
  const PetscInt components = Components(particles, count, fields);
  MPI_Datatype   unit;

  PetscFunctionBeginUser;
  if (!particles->any_ghosts || components == 0) PetscFunctionReturn(0);
  PetscCheck(particles->halo_active == components, PETSC_COMM_SELF, PETSC_ERR_ORDER,
             "halo exchange ends with %" PetscInt_FMT " components but began with %" PetscInt_FMT, components,
             particles->halo_active);
  PetscCall(PgStagePush(PG_STAGE_HALO));
  PetscCall(PgParticlesUnit(particles, components, &unit));
  PetscCall(PetscSFBcastEnd(particles->halo, unit, particles->root_buffer, particles->leaf_buffer, MPI_REPLACE));
  particles->halo_active = 0;
  Unpack(particles, count, fields, components);
  PetscCall(PgStagePop());
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesHalo(PgParticles particles, PetscInt count, const PgField fields[])
{
  PetscFunctionBeginUser;
  PetscCall(PgParticlesHaloBegin(particles, count, fields));
  PetscCall(PgParticlesHaloEnd(particles, count, fields));
  PetscFunctionReturn(0);
}

PetscErrorCode PgHaloDestroy(PgParticles particles)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSFDestroy(&particles->halo)); /* before the types it uses */
  PetscCall(PetscSFDestroy(&particles->byid));
  for (PetscInt u = 0; u < particles->nunits; u++) {
    if (particles->unit[u] != MPI_DATATYPE_NULL) PetscCallMPI(MPI_Type_free(&particles->unit[u]));
  }
  PetscCall(PetscFree(particles->unit));
  PetscCall(PetscFree(particles->root_buffer));
  PetscCall(PetscFree(particles->leaf_buffer));
  PetscFunctionReturn(0);
}
