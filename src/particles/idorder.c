/* The order of permanent ids: rank r holds ids [r N/P, (r + 1) N/P). */
#include "particlesimpl.h"

static PetscInt RangeStart(PgParticles particles, PetscInt global, PetscMPIInt rank)
{
  return (PetscInt)((int64_t)rank * global / particles->size);
}

/* The last rank whose range starts at or before the id. */
static PetscMPIInt RangeOwner(PgParticles particles, PetscInt global, PetscInt id)
{
  return (PetscMPIInt)((((int64_t)id + 1) * particles->size - 1) / global);
}

PetscErrorCode PgParticlesGetIdRange(PgParticles particles, PetscInt *start, PetscInt *count)
{
  const PetscInt first = RangeStart(particles, particles->global, particles->rank);

  PetscFunctionBeginUser;
  if (start) *start = first;
  if (count) *count = RangeStart(particles, particles->global, particles->rank + 1) - first;
  PetscFunctionReturn(0);
}

/* Star forest with the id order as roots and the owned discs as leaves. */
static PetscErrorCode UpdateForest(PgParticles particles)
{
  PetscInt     count;
  PetscSFNode *remote;

  PetscFunctionBeginUser;
  if (particles->byid && particles->byid_revision == particles->revision) PetscFunctionReturn(0);
  PetscCall(PgParticlesGetIdRange(particles, NULL, &count));
  PetscCall(PetscMalloc1(particles->owned, &remote));
  for (PetscInt i = 0; i < particles->owned; i++) {
    const PetscMPIInt rank = RangeOwner(particles, particles->global, particles->id[i]);
    remote[i].rank         = rank;
    remote[i].index        = particles->id[i] - RangeStart(particles, particles->global, rank);
  }
  if (!particles->byid) PetscCall(PetscSFCreate(particles->comm, &particles->byid));
  PetscCall(PetscSFReset(particles->byid));
  PetscCall(
      PetscSFSetGraph(particles->byid, count, particles->owned, NULL, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscCall(PetscSFSetUp(particles->byid));
  particles->byid_revision = particles->revision;
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesToIdOrder(PgParticles particles, PetscInt components, const PetscReal owned[],
                                    PetscReal byid[])
{
  MPI_Datatype unit;

  PetscFunctionBeginUser;
  if (particles->size == 1) { /* saves the memory of the forest */
    for (PetscInt i = 0; i < particles->owned; i++)
      PetscCall(PetscArraycpy(byid + particles->id[i] * components, owned + i * components, components));
    PetscFunctionReturn(0);
  }
  PetscCall(UpdateForest(particles));
  PetscCall(PgParticlesUnit(particles, components, &unit));
  PetscCall(PetscSFReduceBegin(particles->byid, unit, owned, byid, MPI_REPLACE));
  PetscCall(PetscSFReduceEnd(particles->byid, unit, owned, byid, MPI_REPLACE));
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesFromIdOrder(PgParticles particles, PetscInt components, const PetscReal byid[],
                                      PetscReal owned[])
{
  MPI_Datatype unit;

  PetscFunctionBeginUser;
  if (particles->size == 1) {
    for (PetscInt i = 0; i < particles->owned; i++)
      PetscCall(PetscArraycpy(owned + i * components, byid + particles->id[i] * components, components));
    PetscFunctionReturn(0);
  }
  PetscCall(UpdateForest(particles));
  PetscCall(PgParticlesUnit(particles, components, &unit));
  PetscCall(PetscSFBcastBegin(particles->byid, unit, byid, owned, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(particles->byid, unit, byid, owned, MPI_REPLACE));
  PetscFunctionReturn(0);
}

/* ---- check of new ids ---- */

/* Sends every id to the rank of its range and counts there. */
static PetscErrorCode CountIds(PgParticles particles, PetscInt owned, const PetscInt id[], PetscInt global,
                               PetscInt times[])
{
  PgMessages  messages;
  PetscMPIInt nto = 0, *to, last = -1;
  PetscInt   *sorted, *size, *received;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(owned, &sorted, particles->size, &to, particles->size, &size));
  PetscCall(PetscArraycpy(sorted, id, owned));
  PetscCall(PetscSortInt(owned, sorted));
  for (PetscInt i = 0; i < owned; i++) {
    const PetscMPIInt rank = RangeOwner(particles, global, sorted[i]);
    if (rank != last) {
      to[nto]     = rank;
      size[nto++] = 0;
      last        = rank;
    }
    size[nto - 1]++;
  }
  PetscCall(PgMessagesPlan(particles->comm, 1, nto, to, size, &messages));
  PetscCall(PetscMalloc1(PgMessagesReceived(&messages, 0), &received));
  PetscCall(PgMessagesExchange(particles->comm, particles->tag, &messages, 0, MPIU_INT, sorted, received));
  for (PetscInt r = 0; r < PgMessagesReceived(&messages, 0); r++)
    times[received[r] - RangeStart(particles, global, particles->rank)]++;
  PetscCall(PetscFree(received));
  PetscCall(PgMessagesDestroy(&messages));
  PetscCall(PetscFree3(sorted, to, size));
  PetscFunctionReturn(0);
}

/* An error unless the ids of all ranks are 0 .. global - 1, each once. Collective. */
PetscErrorCode PgParticlesCheckIds(PgParticles particles, PetscInt owned, const PetscInt id[], PetscInt global)
{
  const PetscInt start = RangeStart(particles, global, particles->rank);
  const PetscInt count = RangeStart(particles, global, particles->rank + 1) - start;
  PetscInt       wrong = PETSC_MAX_INT, occurs = 0, *times;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < owned; i++) {
    if (id[i] < 0 || id[i] >= global) wrong = PetscMin(wrong, id[i]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &wrong, 1, MPIU_INT, MPI_MIN, particles->comm));
  PgInputCheck(wrong == PETSC_MAX_INT, particles->comm,
               "particle id %" PetscInt_FMT ": the ids of %" PetscInt_FMT " particles must be 0 to %" PetscInt_FMT,
               wrong, global, global - 1);
  PetscCall(PetscCalloc1(count, &times));
  PetscCall(CountIds(particles, owned, id, global, times));
  for (PetscInt i = count - 1; i >= 0; i--) {
    if (times[i] != 1) wrong = start + i;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &wrong, 1, MPIU_INT, MPI_MIN, particles->comm));
  if (wrong >= start && wrong < start + count) occurs = times[wrong - start];
  PetscCall(PetscFree(times));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &occurs, 1, MPIU_INT, MPI_MAX, particles->comm));
  PgInputCheck(wrong == PETSC_MAX_INT, particles->comm,
               "particle id %" PetscInt_FMT " occurs %" PetscInt_FMT " times; every id must occur once", wrong, occurs);
  PetscFunctionReturn(0);
}
