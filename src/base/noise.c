/* Numbers that look like chance. */
#include "baseimpl.h"
#include <stdint.h>

PetscReal PgNoise(PetscInt id, PetscInt component)
{
  uint64_t z = (uint64_t)id * 0x9E3779B97F4A7C15ull + ((uint64_t)component + 1) * 0xD1B54A32D192ED03ull;

  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
  z ^= z >> 31;
  return (PetscReal)(z >> 11) * (PetscReal)(2.0 / 9007199254740992.0) - 1.0;
}
