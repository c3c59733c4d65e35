/* Sorting discs along the curve. */
#include "particlesimpl.h"

enum { DIGIT_BITS = 11, DIGITS = 1 << DIGIT_BITS };

static PetscBool InOrder(PetscInt n, const PgSortEntry entry[])
{
  for (PetscInt i = 1; i < n; i++) {
    if (entry[i - 1].key > entry[i].key) return PETSC_FALSE;
    if (entry[i - 1].key == entry[i].key && entry[i - 1].id > entry[i].id) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static inline uint64_t Digit(const PgSortEntry *entry, PetscBool by_key, int shift)
{
  return ((by_key ? entry->key : (uint64_t)entry->id) >> shift) & (DIGITS - 1);
}

/* One stable pass over one digit of the key or of the id. */
static void Pass(PetscInt n, const PgSortEntry from[], PgSortEntry to[], PetscBool by_key, int shift)
{
  PetscInt place[DIGITS + 1] = {0};

  for (PetscInt i = 0; i < n; i++) place[Digit(&from[i], by_key, shift) + 1]++;
  for (PetscInt d = 0; d < DIGITS; d++) place[d + 1] += place[d];
  for (PetscInt i = 0; i < n; i++) to[place[Digit(&from[i], by_key, shift)]++] = from[i];
}

/* Sorts by (key, id). */
PetscErrorCode PgSortEntries(PetscInt n, PgSortEntry entry[], uint64_t max_key, PetscInt max_id)
{
  PgSortEntry *other, *from = entry, *to;

  PetscFunctionBeginUser;
  if (InOrder(n, entry)) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(n, &other));
  to = other;
  for (int part = 0; part < 2; part++) {
    const PetscBool by_key = (PetscBool)(part == 1);
    const uint64_t  max    = by_key ? max_key : (uint64_t)max_id;
    for (int shift = 0; shift < 64 && (max >> shift) > 0; shift += DIGIT_BITS) {
      PgSortEntry *swap = to;
      Pass(n, from, to, by_key, shift);
      to   = from;
      from = swap;
    }
  }
  if (from != entry) PetscCall(PetscArraycpy(entry, from, n));
  PetscCall(PetscFree(other));
  PetscFunctionReturn(0);
}
