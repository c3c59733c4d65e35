/* Discs change their rank and their place: the owner of the cell gets them, sorted along the curve. */
#include "particlesimpl.h"
#include <stdlib.h>

/* A disc that has to go. */
typedef struct {
  PetscMPIInt rank;
  PetscInt    index;
} Leaver;

/* What is on its way. One disc is 1 + nragged integers (id, number of records of each kind) and its
   migrating fields and records as reals. */
typedef struct {
  PgMessages messages;
  PetscInt  *ints;
  PetscReal *reals;
} Parcel;

enum { KIND_INTS, KIND_REALS, KINDS };

static int CompareLeavers(const void *a, const void *b)
{
  const Leaver *l = (const Leaver *)a, *r = (const Leaver *)b;

  if (l->rank != r->rank) return l->rank < r->rank ? -1 : 1;
  return l->index < r->index ? -1 : l->index > r->index;
}

static uint64_t KeyOf(PgParticles particles, PetscInt i)
{
  PetscInt cell[2];

  PgGridCell(&particles->grid, particles->field[PG_POSITION]->array + 2 * i, cell);
  return PgCurveKey(&particles->grid, cell[0], cell[1]);
}

static PetscInt MigratingReals(PgParticles particles)
{
  PetscInt reals = 0;

  for (PgField f = 0; f < particles->nfields; f++) {
    if (particles->field[f]->info.flags & PG_FIELD_MIGRATE) reals += particles->field[f]->info.components;
  }
  return reals;
}

/* Splits the owned discs into those that stay (entries) and those that leave, by rank. */
static PetscErrorCode Split(PgParticles particles, PgSortEntry entry[], PetscInt *stay, Leaver *leaver[])
{
  uint64_t first, end;
  PetscInt leaving = 0, room = 0;

  PetscFunctionBeginUser;
  PgPartitionOwnRange(particles, &first, &end);
  *stay   = 0;
  *leaver = NULL;
  for (PetscInt i = 0; i < particles->owned; i++) {
    const uint64_t key = KeyOf(particles, i);
    if (key >= first && key < end) {
      entry[*stay].key       = key;
      entry[*stay].id        = particles->id[i];
      entry[(*stay)++].index = i;
      continue;
    }
    if (leaving == room) {
      room = 2 * room + 64;
      PetscCall(PetscRealloc((size_t)room * sizeof **leaver, leaver));
    }
    (*leaver)[leaving].rank    = PgPartitionOwner(particles, key);
    (*leaver)[leaving++].index = i;
  }
  if (leaving) qsort(*leaver, (size_t)leaving, sizeof **leaver, CompareLeavers);
  PetscFunctionReturn(0);
}

static PetscErrorCode PackDisc(PgParticles particles, PetscInt i, PetscInt ints[], PetscReal **reals)
{
  PetscFunctionBeginUser;
  ints[0] = particles->id[i];
  for (PgField f = 0; f < particles->nfields; f++) {
    const PetscInt c = particles->field[f]->info.components;
    if (!(particles->field[f]->info.flags & PG_FIELD_MIGRATE)) continue;
    PetscCall(PetscArraycpy(*reals, particles->field[f]->array + i * c, c));
    *reals += c;
  }
  for (PgRagged r = 0; r < particles->nragged; r++) {
    const PgRaggedStore *ragged = particles->ragged[r];
    const PetscInt       first = ragged->offset[i], n = ragged->offset[i + 1] - first;
    ints[1 + r] = n;
    PetscCall(PetscArraycpy(*reals, ragged->record + first * ragged->components, n * ragged->components));
    *reals += n * ragged->components;
  }
  PetscFunctionReturn(0);
}

/* Sizes of the messages, announced to the receivers. */
static PetscErrorCode Announce(PgParticles particles, PetscInt leaving, const Leaver leaver[], PgMessages *messages)
{
  const PetscInt fixed = MigratingReals(particles);
  PetscMPIInt    nto   = 0, *to;
  PetscInt      *size;

  PetscFunctionBeginUser;
  for (PetscInt l = 0; l < leaving; l++) nto += (l == 0 || leaver[l].rank != leaver[l - 1].rank);
  PetscCall(PetscMalloc2(nto, &to, (size_t)nto * KINDS, &size));
  nto = 0;
  for (PetscInt l = 0; l < leaving; l++) {
    PetscInt reals = fixed;
    for (PgRagged r = 0; r < particles->nragged; r++) {
      const PgRaggedStore *ragged = particles->ragged[r];
      reals += (ragged->offset[leaver[l].index + 1] - ragged->offset[leaver[l].index]) * ragged->components;
    }
    if (l == 0 || leaver[l].rank != leaver[l - 1].rank) {
      to[nto]                        = leaver[l].rank;
      size[nto * KINDS + KIND_INTS]  = 0;
      size[nto * KINDS + KIND_REALS] = 0;
      nto++;
    }
    size[(nto - 1) * KINDS + KIND_INTS] += 1 + particles->nragged;
    size[(nto - 1) * KINDS + KIND_REALS] += reals;
  }
  PetscCall(PgMessagesPlan(particles->comm, KINDS, nto, to, size, messages));
  PetscCall(PetscFree2(to, size));
  PetscFunctionReturn(0);
}

/* Sends the leavers off and receives the arrivals. */
static PetscErrorCode Travel(PgParticles particles, PetscInt leaving, const Leaver leaver[], Parcel *parcel)
{
  PgMessages *messages = &parcel->messages;
  PetscInt   *ints, reals_total = 0;
  PetscReal  *reals, *next;

  PetscFunctionBeginUser;
  PetscCall(Announce(particles, leaving, leaver, messages));
  for (PetscMPIInt m = 0; m < messages->nto; m++) reals_total += messages->to_size[m * KINDS + KIND_REALS];
  PetscCall(PetscMalloc2(leaving * (1 + particles->nragged), &ints, reals_total, &reals));
  next = reals;
  for (PetscInt l = 0; l < leaving; l++)
    PetscCall(PackDisc(particles, leaver[l].index, ints + l * (1 + particles->nragged), &next));
  PetscCall(PetscMalloc1(PgMessagesReceived(messages, KIND_INTS), &parcel->ints));
  PetscCall(PetscMalloc1(PgMessagesReceived(messages, KIND_REALS), &parcel->reals));
  PetscCall(PgMessagesExchange(particles->comm, particles->tag, messages, KIND_INTS, MPIU_INT, ints, parcel->ints));
  PetscCall(PgMessagesExchange(particles->comm, particles->tag, messages, KIND_REALS, MPIU_REAL, reals, parcel->reals));
  PetscCall(PetscFree2(ints, reals));
  PetscFunctionReturn(0);
}

/* Appends the arrivals after the present discs (and over the ghosts). */
static PetscErrorCode Unpack(PgParticles particles, PetscInt arrived, const Parcel *parcel)
{
  const PetscInt   width = 1 + particles->nragged, base = particles->owned;
  const PetscReal *reals = parcel->reals;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesReserve(particles, base + arrived));
  for (PgRagged r = 0; r < particles->nragged; r++) {
    PgRaggedStore *ragged  = particles->ragged[r];
    PetscInt       records = ragged->offset[base];
    for (PetscInt a = 0; a < arrived; a++) records += parcel->ints[a * width + 1 + r];
    PetscCall(PgRaggedReserve(ragged, base + arrived, records));
  }
  for (PetscInt a = 0; a < arrived; a++) {
    particles->id[base + a] = parcel->ints[a * width];
    for (PgField f = 0; f < particles->nfields; f++) {
      const PetscInt c = particles->field[f]->info.components;
      if (!(particles->field[f]->info.flags & PG_FIELD_MIGRATE)) continue;
      PetscCall(PetscArraycpy(particles->field[f]->array + (base + a) * c, reals, c));
      reals += c;
    }
    for (PgRagged r = 0; r < particles->nragged; r++) {
      PgRaggedStore *ragged = particles->ragged[r];
      const PetscInt first = ragged->offset[base + a], n = parcel->ints[a * width + 1 + r];
      PetscCall(PetscArraycpy(ragged->record + first * ragged->components, reals, n * ragged->components));
      ragged->offset[base + a + 1] = first + n;
      reals += n * ragged->components;
    }
  }
  PetscFunctionReturn(0);
}

/* Puts every value where the entries want it. */
static PetscErrorCode Gather(PgParticles particles, PetscInt n, const PgSortEntry entry[])
{
  PetscInt   widest = 1;
  PetscReal *scratch;

  PetscFunctionBeginUser;
  for (PgField f = 0; f < particles->nfields; f++)
    if (particles->field[f]->info.flags & PG_FIELD_MIGRATE)
      widest = PetscMax(widest, particles->field[f]->info.components);
  PetscCall(PetscMalloc1((size_t)n * (size_t)widest, &scratch));
  for (PgField f = 0; f < particles->nfields; f++) {
    const PetscInt c     = particles->field[f]->info.components;
    PetscReal     *array = particles->field[f]->array;
    if (!(particles->field[f]->info.flags & PG_FIELD_MIGRATE)) continue;
    for (PetscInt i = 0; i < n; i++) {
      for (PetscInt k = 0; k < c; k++) scratch[i * c + k] = array[entry[i].index * c + k];
    }
    PetscCall(PetscArraycpy(array, scratch, (size_t)n * (size_t)c));
  }
  PetscCall(PetscFree(scratch));
  for (PetscInt i = 0; i < n; i++) particles->id[i] = entry[i].id;
  PetscFunctionReturn(0);
}

static PetscErrorCode GatherRagged(PgRaggedStore *ragged, PetscInt n, const PgSortEntry entry[])
{
  const PetscInt c = ragged->components;
  PetscInt      *offset;
  PetscReal     *record;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(ragged->offset_capacity, &offset));
  PetscCall(PetscMalloc1((size_t)ragged->record_capacity * (size_t)c, &record));
  offset[0] = 0;
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt first = ragged->offset[entry[i].index], count = ragged->offset[entry[i].index + 1] - first;
    PetscCall(PetscArraycpy(record + offset[i] * c, ragged->record + first * c, count * c));
    offset[i + 1] = offset[i] + count;
  }
  PetscCall(PetscFree(ragged->offset));
  PetscCall(PetscFree(ragged->record));
  ragged->offset = offset;
  ragged->record = record;
  PetscFunctionReturn(0);
}

/* Moves the discs to the owners of their cells and, when due, sorts them. Collective. */
PetscErrorCode PgParticlesMigrate(PgParticles particles, PgSortEntry *entries[], PetscBool *changed)
{
  PetscInt     stay, leaving, arrived = 0;
  Leaver      *leaver;
  PgSortEntry *entry;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(particles->owned, &entry));
  PetscCall(Split(particles, entry, &stay, &leaver));
  leaving = particles->owned - stay;
  if (particles->size > 1) {
    Parcel parcel;
    PetscCall(Travel(particles, leaving, leaver, &parcel));
    arrived = PgMessagesReceived(&parcel.messages, KIND_INTS) / (1 + particles->nragged);
    if (arrived) PetscCall(Unpack(particles, arrived, &parcel));
    PetscCall(PgMessagesDestroy(&parcel.messages));
    PetscCall(PetscFree(parcel.ints));
    PetscCall(PetscFree(parcel.reals));
  }
  PetscCall(PetscFree(leaver));
  if (arrived) PetscCall(PetscRealloc((size_t)(stay + arrived) * sizeof *entry, &entry));
  for (PetscInt a = 0; a < arrived; a++) {
    const PetscInt i      = particles->owned + a;
    entry[stay + a].key   = KeyOf(particles, i);
    entry[stay + a].id    = particles->id[i];
    entry[stay + a].index = i;
  }
  *changed = (PetscBool)(leaving > 0 || arrived > 0);
  if (*changed || ++particles->unsorted >= particles->sort_every) {
    PetscCall(PgSortEntries(stay + arrived, entry, ((uint64_t)1 << (2 * particles->grid.levels)) - 1,
                            PetscMax(particles->global - 1, 0)));
    particles->unsorted = 0;
  }
  for (PetscInt i = 0; i < stay + arrived && !*changed; i++) *changed = (PetscBool)(entry[i].index != i);
  if (*changed) {
    PetscCall(Gather(particles, stay + arrived, entry));
    for (PgRagged r = 0; r < particles->nragged; r++)
      PetscCall(GatherRagged(particles->ragged[r], stay + arrived, entry));
    particles->owned  = stay + arrived;
    particles->ghosts = 0; /* arrivals lie where they were; they are made anew */
  }
  *entries = entry;
  PetscFunctionReturn(0);
}
