/* Ties: a chain of pair weights that leads from each free disc to a prescribed pressure, kept from one geometry to the
   next as a forest: every disc remembers the pair by which it was reached. While none of these weights vanishes the
   matrix is regular, and to know that costs one look at each disc. */
#include "pressureimpl.h"

enum { LOOSE, TIED }; /* values of the field island_label here */

PetscBool PgPressureTiesHold(PgPressure q, const PetscReal fixed[])
{
  /* what was fixed when the forest was made has no pair of its own: once it is free the forest is too old */
  for (PetscInt a = 0; a < q->owned; a++)
    if (fixed[a] == 0.0 && (q->tie[a] < 0 || q->weight[q->tie[a]] == 0.0)) return PETSC_FALSE;
  return PETSC_TRUE;
}

static PetscInt EntryOf(PgPressure q, PetscInt row, PetscInt disc)
{
  PetscInt k = q->ptr[row];

  while (k < q->ptr[row + 1] && q->col[k] != disc) k++;
  return k;
}

/* Ties discs to fixed ones and to ghosts that are tied, and what they reach of the owned ones; how many it was. */
static PetscInt Grow(PgPressure q, const PetscReal fixed[], PetscReal label[])
{
  PetscInt *queue = q->island_parent, count = 0;

  for (PetscInt a = 0; a < q->owned; a++) {
    for (PetscInt k = q->ptr[a]; k < q->ptr[a + 1] && fixed[a] == 0.0 && label[a] != TIED; k++) {
      const PetscInt b = q->col[k];
      if (q->weight[k] == 0.0 || !(fixed[b] != 0.0 || (b >= q->owned && label[b] == TIED))) continue;
      q->tie[a]      = k;
      label[a]       = TIED;
      queue[count++] = a;
    }
  }
  for (PetscInt next = 0; next < count; next++) {
    const PetscInt a = queue[next];
    for (PetscInt k = q->ptr[a]; k < q->ptr[a + 1]; k++) {
      const PetscInt b = q->col[k];
      if (b >= q->owned || q->weight[k] == 0.0 || fixed[b] != 0.0 || label[b] == TIED) continue;
      q->tie[b]      = EntryOf(q, b, a);
      label[b]       = TIED;
      queue[count++] = b;
    }
  }
  return count;
}

PetscErrorCode PgPressureTie(PgPressure q)
{
  PetscReal *fixed, *label;
  PetscInt   owned, ghosts, left[2] = {0, 1}; /* discs that are loose, discs tied this time, of all ranks */

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetArray(q->particles, q->fixed, &fixed));
  PetscCall(PgParticlesGetArray(q->particles, q->island_label, &label));
  PetscCall(PgParticlesGetSizes(q->particles, &owned, &ghosts, NULL));
  for (PetscInt a = 0; a < owned + ghosts; a++) label[a] = LOOSE;
  for (PetscInt a = 0; a < owned; a++) q->tie[a] = -1;
  while (left[1] > 0) {
    left[1] = Grow(q, fixed, label);
    left[0] = 0;
    for (PetscInt a = 0; a < owned; a++) left[0] += fixed[a] == 0.0 && label[a] != TIED;
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, left, 2, MPIU_INT, MPI_SUM, q->comm));
    if (left[0] == 0) break;
    PetscCall(PgParticlesHalo(q->particles, 1, &q->island_label));
  }
  q->tied = (PetscBool)(left[0] == 0);
  PetscFunctionReturn(0);
}

PetscErrorCode PgPressureCountLoose(PgPressure q, PetscInt *count, PetscInt *least)
{
  PetscReal      *fixed, *label;
  const PetscInt *id;

  PetscFunctionBeginUser;
  PetscCall(PgPressureReserveTies(q));
  PetscCall(PgPressureTie(q));
  PetscCall(PgParticlesGetArray(q->particles, q->fixed, &fixed));
  PetscCall(PgParticlesGetArray(q->particles, q->island_label, &label));
  PetscCall(PgParticlesGetIds(q->particles, &id));
  *count = 0;
  *least = PETSC_MAX_INT;
  for (PetscInt a = 0; a < q->owned; a++) {
    if (fixed[a] != 0.0 || label[a] == TIED) continue;
    (*count)++;
    *least = PetscMin(*least, id[a]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 1, MPIU_INT, MPI_SUM, q->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, least, 1, MPIU_INT, MPI_MIN, q->comm));
  PetscFunctionReturn(0);
}
