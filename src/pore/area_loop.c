/* Area of discs inside sample circles, Eq. 61: the exact overlap of two circles for every pair of the row
   list, in a form that the compiler turns into vector instructions.

   Built with -fno-math-errno -fno-trapping-math, which change no value. libm's arc cosine cannot be
   vectorised, hence one of our own: the usual reduction to [0, 1/2] with the rational approximation of
   fdlibm's e_asin.c (Sun Microsystems 1993; error below 1 ulp). */
#include "poreimpl.h"

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
  #define PG_CLONES __attribute__((target_clones("avx2", "default")))
#else
  #define PG_CLONES
#endif

/* asin(y) = y + y t R(t) with t = y^2 <= 1/4 */
static inline PetscReal ArcRational(PetscReal t)
{
  const PetscReal p = t * (1.66666666666666657415e-01 +
                           t * (-3.25565818622400915405e-01 +
                                t * (2.01212532134862925881e-01 +
                                     t * (-4.00555345006794114027e-02 +
                                          t * (7.91534994289814532176e-04 + t * 3.47933107596021167570e-05)))));
  const PetscReal q = 1.0 + t * (-2.40339491173441421878e+00 +
                                 t * (2.02094576023350569471e+00 +
                                      t * (-6.88283971605453293030e-01 + t * 7.70381505559019352791e-02)));
  return p / q;
}

/* max(t, 0) as arithmetic: of a comparison the compiler may take the root first and choose afterwards, and the root of
   a negative number, though thrown away, is what -fp_trap stops at. The same bits: doubling and halving are exact. */
static inline PetscReal Positive(PetscReal t) { return 0.5 * (t + PetscAbsReal(t)); }

/* 0 or pi beyond [-1, 1], which rounding may reach. */
static inline PetscReal ArcCosine(PetscReal u)
{
  const PetscReal a     = PetscAbsReal(u);
  const PetscReal z     = 0.5 * Positive(1.0 - a);
  const PetscReal t     = a < 0.5 ? a * a : z;
  const PetscReal y     = a < 0.5 ? a : PetscSqrtReal(z);
  const PetscReal asin  = y + y * ArcRational(t);
  const PetscReal small = 0.5 * PETSC_PI - (u < 0.0 ? -asin : asin);
  const PetscReal large = u < 0.0 ? PETSC_PI - 2.0 * asin : 2.0 * asin;
  return a < 0.5 ? small : large;
}

/* Area of the disc of radius r at distance sqrt(d2) inside the circle of radius R. */
static inline PetscReal Overlap(PetscReal R, PetscReal r, PetscReal d2)
{
  const PetscReal inner = PetscAbsReal(R - r), outer = R + r, least = r < R ? r : R;
  /* outside [inner, outer] the chord is not there: evaluate at a bound, then choose */
  const PetscReal c2 = d2 < inner * inner ? inner * inner : (d2 > outer * outer ? outer * outer : d2);
  const PetscReal d  = PetscSqrtReal(c2);
  const PetscReal x = (c2 + r * r - R * R) / (2.0 * d), X = d - x; /* of the chord, from either centre */
  const PetscReal h    = PetscSqrtReal(Positive(r * r - x * x));
  const PetscReal lens = r * r * ArcCosine(x / r) + R * R * ArcCosine(X / R) - d * h;

  return d2 >= outer * outer ? 0.0 : (d2 <= inner * inner ? PETSC_PI * least * least : lens);
}

PG_CLONES void PgSolidAreaLoop(PetscInt owned, const PgRowList *list, PetscReal circle, const PetscReal x[],
                               const PetscReal radius[], PetscReal area[])
{
  enum { BLOCK = 64 };
  PetscReal part[BLOCK];

  for (PetscInt a = 0; a < owned; a++) {
    const PetscReal xa = x[2 * a], ya = x[2 * a + 1], R = circle * radius[a];
    PetscReal       sum = PETSC_PI * radius[a] * radius[a];

    for (PetscInt begin = list->ptr[a]; begin < list->ptr[a + 1]; begin += BLOCK) {
      const PetscInt  n   = PetscMin(BLOCK, list->ptr[a + 1] - begin);
      const PetscInt *col = list->col + begin;
      for (PetscInt k = 0; k < n; k++) {
        const PetscReal dx = x[2 * col[k]] - xa, dy = x[2 * col[k] + 1] - ya;
        part[k] = Overlap(R, radius[col[k]], dx * dx + dy * dy);
      }
      for (PetscInt k = 0; k < n; k++) sum += part[k];
    }
    area[a] = sum;
  }
}
