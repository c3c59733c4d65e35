/* The registry: every array of the store, and how they grow. */
#include "particlesimpl.h"

/* The first discs get the room they need: without migration no more come. Arrays then grow by an eighth at least, so
   that a slowly changing number of discs rarely allocates and little memory lies idle. */
static PetscInt Grown(PetscInt capacity, PetscInt needed)
{
  if (needed <= capacity) return capacity;
  return capacity ? needed + needed / 8 + 16 : needed;
}

/* What neither travels nor is kept is only filled where it is wanted, for a snapshot say, and has no room before. */
static PetscBool Passing(const PgFieldStore *store)
{
  return (PetscBool) !(store->info.flags & (PG_FIELD_MIGRATE | PG_FIELD_HALO | PG_FIELD_RESTART));
}

static PetscErrorCode GrowReals(PetscBool keep, size_t held, size_t size, PetscReal **array)
{
  PetscReal *larger;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(size, &larger));
  if (keep && held) PetscCall(PetscArraycpy(larger, *array, held));
  PetscCall(PetscFree(*array));
  *array = larger;
  PetscFunctionReturn(0);
}

static PetscErrorCode GrowInts(size_t held, size_t size, PetscInt **array)
{
  PetscInt *larger;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(size, &larger));
  if (held) PetscCall(PetscArraycpy(larger, *array, held));
  PetscCall(PetscFree(*array));
  *array = larger;
  PetscFunctionReturn(0);
}

/* Makes room for `discs`, ghosts included. Values of the discs that are there survive. */
PetscErrorCode PgParticlesReserve(PgParticles particles, PetscInt discs)
{
  const PetscInt capacity = Grown(particles->capacity, discs);
  const size_t   held     = (size_t)particles->owned + (size_t)particles->ghosts;

  PetscFunctionBeginUser;
  if (capacity == particles->capacity) PetscFunctionReturn(0);
  for (PgField f = 0; f < particles->nfields; f++) {
    PgFieldStore *store = particles->field[f];
    const size_t  c     = (size_t)store->info.components;
    if (!store->array && Passing(store)) continue;
    PetscCall(GrowReals(PETSC_TRUE, held * c, (size_t)capacity * c, &store->array));
  }
  PetscCall(GrowInts(held, (size_t)capacity, &particles->id));
  PetscCall(GrowInts(held, (size_t)capacity, &particles->index));
  particles->capacity = capacity;
  PetscFunctionReturn(0);
}

/* Makes room for the records of `discs` discs. What is there survives. */
PetscErrorCode PgRaggedReserve(PgRaggedStore *ragged, PetscInt discs, PetscInt records)
{
  const PetscInt offsets = Grown(ragged->offset_capacity, discs + 1);
  const PetscInt size    = Grown(ragged->record_capacity, records);
  const size_t   c       = (size_t)ragged->components;

  PetscFunctionBeginUser;
  if (offsets != ragged->offset_capacity) {
    PetscCall(GrowInts((size_t)ragged->offset_capacity, (size_t)offsets, &ragged->offset));
    ragged->offset_capacity = offsets;
  }
  if (size != ragged->record_capacity) {
    PetscCall(GrowReals(PETSC_TRUE, (size_t)ragged->record_capacity * c, (size_t)size * c, &ragged->record));
    ragged->record_capacity = size;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesFindField(PgParticles particles, const char name[], PgField *field)
{
  PetscFunctionBeginUser;
  *field = -1;
  for (PgField f = 0; f < particles->nfields; f++) {
    PetscBool same;
    PetscCall(PetscStrcmp(particles->field[f]->info.name, name, &same));
    if (same) *field = f;
  }
  PetscFunctionReturn(0);
}

/* Room for one more pointer in a list of pointers. */
static PetscErrorCode GrowList(PetscInt count, PetscInt *capacity, size_t bytes, void *list)
{
  PetscFunctionBeginUser;
  if (count == *capacity) {
    *capacity = 2 * count + 16;
    PetscCall(PetscRealloc((size_t)*capacity * bytes, list));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesRegisterField(PgParticles particles, const PgFieldInfo *info, PgField *field)
{
  PgFieldStore *store;
  PgField       found;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesFindField(particles, info->name, &found));
  if (found >= 0) {
    store = particles->field[found];
    PgInputCheck(store->info.components == info->components, particles->comm,
                 "field '%s' is registered with %" PetscInt_FMT " components and cannot have %" PetscInt_FMT,
                 info->name, store->info.components, info->components);
    store->info.flags |= info->flags;
    if (!store->array && !Passing(store))
      PetscCall(PetscCalloc1((size_t)particles->capacity * (size_t)info->components, &store->array));
    *field = found;
    PetscFunctionReturn(0);
  }
  PgInputCheck(info->components > 0, particles->comm,
               "field '%s' has %" PetscInt_FMT " components, it needs at least 1", info->name, info->components);
  PetscCall(GrowList(particles->nfields, &particles->fields_capacity, sizeof(PgFieldStore *), &particles->field));
  PetscCall(PetscNew(&store));
  store->info = *info;
  PetscCall(PetscStrallocpy(info->name, (char **)&store->info.name));
  PetscCall(PetscStrallocpy(info->unit ? info->unit : "1", (char **)&store->info.unit));
  PetscCall(PetscStrallocpy(info->description ? info->description : "", (char **)&store->info.description));
  if (!Passing(store)) PetscCall(PetscCalloc1((size_t)particles->capacity * (size_t)info->components, &store->array));
  *field                   = particles->nfields++;
  particles->field[*field] = store;
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesGetFieldCount(PgParticles particles, PetscInt *count)
{
  PetscFunctionBeginUser;
  *count = particles->nfields;
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckField(PgParticles particles, PgField field)
{
  PetscFunctionBeginUser;
  PetscCheck(field >= 0 && field < particles->nfields, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "no field %" PetscInt_FMT ", %" PetscInt_FMT " are registered", field, particles->nfields);
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesGetFieldInfo(PgParticles particles, PgField field, const PgFieldInfo **info)
{
  PetscFunctionBeginUser;
  PetscCall(CheckField(particles, field));
  *info = &particles->field[field]->info;
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesGetArray(PgParticles particles, PgField field, PetscReal **array)
{
  PgFieldStore *store;

  PetscFunctionBeginUser;
  PetscCall(CheckField(particles, field));
  store = particles->field[field];
  if (!store->array)
    PetscCall(PetscCalloc1((size_t)particles->capacity * (size_t)store->info.components, &store->array));
  *array = store->array;
  PetscFunctionReturn(0);
}

/* ---- variable-length data ---- */

PetscErrorCode PgParticlesRegisterRagged(PgParticles particles, const char name[], PetscInt components, unsigned flags,
                                         PgRagged *ragged)
{
  PgRaggedStore *store;

  PetscFunctionBeginUser;
  PgInputCheck(components > 0, particles->comm,
               "variable-length data '%s' have %" PetscInt_FMT " components, they need at least 1", name, components);
  for (PgRagged r = 0; r < particles->nragged; r++) {
    PetscBool same;
    store = particles->ragged[r];
    PetscCall(PetscStrcmp(store->name, name, &same));
    if (!same) continue;
    PgInputCheck(store->components == components, particles->comm,
                 "variable-length data '%s' are registered with %" PetscInt_FMT
                 " components and cannot have %" PetscInt_FMT,
                 name, store->components, components);
    store->flags |= flags;
    *ragged = r;
    PetscFunctionReturn(0);
  }
  PetscCall(GrowList(particles->nragged, &particles->ragged_capacity, sizeof(PgRaggedStore *), &particles->ragged));
  PetscCall(PetscNew(&store));
  PetscCall(PetscStrallocpy(name, &store->name));
  store->components = components;
  store->flags      = flags;
  PetscCall(PgRaggedReserve(store, particles->owned, 0));
  *ragged                    = particles->nragged++;
  particles->ragged[*ragged] = store;
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckRagged(PgParticles particles, PgRagged ragged)
{
  PetscFunctionBeginUser;
  PetscCheck(ragged >= 0 && ragged < particles->nragged, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "no variable-length data %" PetscInt_FMT ", %" PetscInt_FMT " are registered", ragged, particles->nragged);
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesSetRagged(PgParticles particles, PgRagged ragged, const PetscInt offset[],
                                    const PetscReal record[])
{
  PgRaggedStore *store;

  PetscFunctionBeginUser;
  PetscCall(CheckRagged(particles, ragged));
  store = particles->ragged[ragged];
  if (!offset) {
    PetscCall(PetscFree(store->record));
    store->record_capacity = 0;
    PetscCall(PgRaggedReserve(store, particles->owned, 0));
    PetscCall(PetscArrayzero(store->offset, particles->owned + 1));
    PetscFunctionReturn(0);
  }
  PgAssert(offset[0] == 0, "records of '%s' start at %" PetscInt_FMT " instead of 0", store->name, offset[0]);
  PetscCall(PgRaggedReserve(store, particles->owned, offset[particles->owned]));
  PetscCall(PetscArraycpy(store->offset, offset, particles->owned + 1));
  PetscCall(PetscArraycpy(store->record, record, (size_t)offset[particles->owned] * (size_t)store->components));
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesGetRagged(PgParticles particles, PgRagged ragged, const PetscInt *offset[],
                                    const PetscReal *record[])
{
  PetscFunctionBeginUser;
  PetscCall(CheckRagged(particles, ragged));
  if (offset) *offset = particles->ragged[ragged]->offset;
  if (record) *record = particles->ragged[ragged]->record;
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesGetRaggedCount(PgParticles particles, PetscInt *count)
{
  PetscFunctionBeginUser;
  *count = particles->nragged;
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesGetRaggedInfo(PgParticles particles, PgRagged ragged, const char *name[],
                                        PetscInt *components, unsigned *flags)
{
  PetscFunctionBeginUser;
  PetscCall(CheckRagged(particles, ragged));
  if (name) *name = particles->ragged[ragged]->name;
  if (components) *components = particles->ragged[ragged]->components;
  if (flags) *flags = particles->ragged[ragged]->flags;
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesDestroyRegistry(PgParticles particles)
{
  PetscFunctionBeginUser;
  for (PgField f = 0; f < particles->nfields; f++) {
    PgFieldStore *store = particles->field[f];
    PetscCall(PetscFree(store->info.name));
    PetscCall(PetscFree(store->info.unit));
    PetscCall(PetscFree(store->info.description));
    PetscCall(PetscFree(store->array));
    PetscCall(PetscFree(store));
  }
  for (PgRagged r = 0; r < particles->nragged; r++) {
    PgRaggedStore *store = particles->ragged[r];
    PetscCall(PetscFree(store->name));
    PetscCall(PetscFree(store->offset));
    PetscCall(PetscFree(store->record));
    PetscCall(PetscFree(store));
  }
  PetscCall(PetscFree(particles->field));
  PetscCall(PetscFree(particles->ragged));
  PetscCall(PetscFree(particles->id));
  PetscCall(PetscFree(particles->index));
  PetscFunctionReturn(0);
}
