/* Exact sums: every double is added without rounding into an accumulator as wide as the exponent range
   (after Kulisch), so that the result does not depend on the order, nor on how the terms are spread over
   ranks. Used where a sum over all discs is shown or decided upon; never in an inner loop. */
#include "baseimpl.h"
#include <math.h>

enum { WORD = 32, LOWEST = -1074 }; /* bits of a word; exponent of the smallest positive double */

void PgExactSumAdd(PgExactSum *sum, PetscReal x)
{
  int               exponent, position, word;
  double            mantissa;
  unsigned __int128 bits;
  const int         sign = x < 0 ? -1 : 1;

  if (!isfinite(x)) {
    sum->not_finite++;
    return;
  }
  if (x == 0.0) return;
  mantissa = frexp(fabs((double)x), &exponent); /* in [1/2, 1): 53 bits */
  position = exponent - 53 - LOWEST;
  bits     = (unsigned __int128)ldexp(mantissa, 53);
  if (position < 0) { /* subnormal: its low bits are zero */
    bits >>= -position;
    position = 0;
  }
  word = position / WORD;
  bits <<= position % WORD;
  sum->word[word] += sign * (long long)(bits & 0xffffffffu);
  sum->word[word + 1] += sign * (long long)((bits >> WORD) & 0xffffffffu);
  sum->word[word + 2] += sign * (long long)(bits >> (2 * WORD));
}

PetscErrorCode PgExactSumReduce(MPI_Comm comm, PetscInt count, PgExactSum sum[], PetscReal value[])
{
  const int words = (int)(sizeof sum->word / sizeof *sum->word);

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, (PetscMPIInt)(count * (PetscInt)(sizeof *sum / sizeof(long long))),
                             MPI_LONG_LONG, MPI_SUM, comm));
  for (PetscInt i = 0; i < count; i++) {
    long long carry  = 0;
    double    result = 0.0;

    for (int w = 0; w < words; w++) { /* every word into [0, 2^32) but the last, which keeps the sign */
      const long long full = sum[i].word[w] + carry;
      carry                = w < words - 1 ? full >> WORD : 0;
      sum[i].word[w]       = w < words - 1 ? full - carry * (1LL << WORD) : full;
    }
    if (sum[i].word[words - 1] < 0) { /* sign and magnitude, so that the leading words do not cancel */
      carry = 0;
      for (int w = 0; w < words; w++) {
        const long long full = -sum[i].word[w] + carry;
        carry                = w < words - 1 ? full >> WORD : 0;
        sum[i].word[w]       = w < words - 1 ? full - carry * (1LL << WORD) : full;
      }
      for (int w = words - 1; w >= 0; w--) result -= ldexp((double)sum[i].word[w], LOWEST + w * WORD);
    } else {
      for (int w = words - 1; w >= 0; w--) result += ldexp((double)sum[i].word[w], LOWEST + w * WORD);
    }
    value[i] = sum[i].not_finite ? (PetscReal)NAN : (PetscReal)result;
  }
  PetscFunctionReturn(0);
}
