/* Area of discs inside sample circles, Eq. 61: exact overlaps of circles and discs.

   Two discs of one size have the same overlap either way: it is computed once for the pair. Pairs whose disc cannot
   reach the circle's edge before the lists are built again (the nearest neighbours) keep what they have, the whole disc
   or nothing: the formula would give the same bits.

   Built with -fno-math-errno -fno-trapping-math, which change no value. libm's arc cosine cannot be vectorised;
   a lens needs no arc cosine but the difference of an arc and its triangle, which has approximations of its own. */
#include "poreimpl.h"

enum { BLOCK = 128 }; /* overlaps at a time: their arrays fit the first-level cache */

/* max(t, 0) as arithmetic: of a comparison the compiler may take the root first and choose afterwards, and the root of
   a negative number, though thrown away, is what -fp_trap stops at. The same bits: doubling and halving are exact. */
static inline PetscReal Positive(PetscReal t) { return 0.5 * (t + PetscAbsReal(t)); }

/* (phi - sin phi cos phi)/sin^3 phi with t = sin^2 phi <= 1/4: interpolated in Chebyshev points, error 6e-17. The area
   between an arc and its chord is this times the half chord to the third, over the radius. */
static inline PetscReal FlatSegment(PetscReal t)
{
  const PetscReal z = t - 0.125;

  return 0.693489828446115397 +
         z * (0.23048179984419262 +
              z * (0.138713356185922981 +
                   z * (0.101645640152327452 +
                        z * (0.0825489752623911055 +
                             z * (0.0714568044274994096 +
                                  z * (0.0646114893584731065 +
                                       z * (0.0603054902167612858 +
                                            z * (0.0576608682961566171 +
                                                 z * (0.0561284021144225972 +
                                                      z * (0.0555376890459340772 +
                                                           z * (0.0587448932236651067 +
                                                                z * 0.0595485340838416352)))))))))));
}

/* acos(u) - u sqrt(1 - u^2) for -1 <= u <= 1, the area beyond the chord at u in the unit disc; w = 1 - u^2 and root its
   square root. Near the ends it is w^1.5 f(w) (the same f as above), in the middle pi/2 - u g(u^2); f and g as rational
   functions on [0, 1/2], interpolated in Chebyshev points, errors 1.4e-16 and 6e-17. */
static inline PetscReal Segment(PetscReal u, PetscReal w, PetscReal root)
{
  const int       middle = w > 0.5;
  const PetscReal z      = (middle ? u * u : w) - 0.25;
  const PetscReal p0     = middle ? 1.91322295498103645 : 0.724688589648636361,
                  p1     = middle ? -6.79509958536495695 : -2.67031415247304516,
                  p2     = middle ? 9.118643166803448 : 3.65956984992028422,
                  p3     = middle ? -5.76181063923561876 : -2.28757139561769662,
                  p4     = middle ? 1.73669539734881861 : 0.63737714547089297,
                  p5     = middle ? -0.221335822840975194 : -0.0636207854402166956,
                  p6     = middle ? 0.00809975572981284052 : 0.000987664285513037985;
  const PetscReal q1     = middle ? -3.36226119062239626 : -4.05827387115914551,
                  q2     = middle ? 4.16470785061089632 : 6.30861001896841955,
                  q3     = middle ? -2.32551441622489374 : -4.68687888626810345,
                  q4     = middle ? 0.570326243242335051 : 1.68544722375227463,
                  q5     = middle ? -0.0491734135121466021 : -0.258941075079655081,
                  q6     = middle ? 0.000644878696539806832 : 0.0113895244849372204;
  const PetscReal p      = p0 + z * (p1 + z * (p2 + z * (p3 + z * (p4 + z * (p5 + z * p6)))));
  const PetscReal q      = 1.0 + z * (q1 + z * (q2 + z * (q3 + z * (q4 + z * (q5 + z * q6)))));
  const PetscReal f      = (middle ? u : w * root) * (p / q);

  return middle ? 0.5 * PETSC_PI - f : (u < 0.0 ? PETSC_PI - f : f);
}

/* Area of the disc of radius r <= R/2 at distance sqrt(d2) > 0 inside the circle of radius R. Where they do not cross, u is
   beyond -1 or 1 and the result is the whole disc or zero, exactly. */
static inline PetscReal Lens(PetscReal R, PetscReal r, PetscReal d2)
{
  const PetscReal d = PetscSqrtReal(d2), twice = 2.0 * d * r, inverse = 1.0 / (twice * R);
  const PetscReal u = (d2 - (R - r) * (R + r)) * (R * inverse); /* of the chord, from the centre of the disc, over r */
  const PetscReal w = Positive((1.0 - u) * (1.0 + u)), root = PetscSqrtReal(w); /* half chord over r */
  const PetscReal ratio = r * (twice * inverse);

  return r * r * (Segment(u, w, root) + ratio * w * root * FlatSegment(ratio * ratio * w));
}

static inline PetscReal Distance2(const PetscReal x[], PetscInt a, PetscInt b)
{
  PgReal2 d = PgTwo(x, b) - PgTwo(x, a);
  d *= d;
  return d[0] + d[1];
}

PG_CLONES void PgOverlapLoop(const PgOverlaps *o, PetscReal circle, const PetscReal x[], const PetscReal radius[])
{
  PetscReal d2[BLOCK], R[BLOCK], r[BLOCK], lens[BLOCK];

  for (PetscInt first = 0; first < o->count; first += BLOCK) {
    const PetscInt n = PetscMin(BLOCK, o->count - first), *at = o->at + first, *too = o->too + first;

    for (PetscInt i = 0; i < n; i++) {
      const PetscInt a = o->circle[first + i], b = o->disc[first + i];
      R[i]  = circle * radius[a];
      r[i]  = radius[b];
      d2[i] = Distance2(x, a, b);
    }
    for (PetscInt i = 0; i < n; i++) lens[i] = Lens(R[i], r[i], d2[i]);
    for (PetscInt i = 0; i < n; i++) {
      const char inside = d2[i] <= R[i] * R[i];
      o->area[at[i]] = o->area[too[i]] = lens[i];
      o->inside[at[i]] = o->inside[too[i]] = inside;
    }
  }
  for (PetscInt i = o->count; i < o->all; i++) { /* a disc more than twice as large as the other */
    const PetscInt  a = o->circle[i], b = o->disc[i];
    const PetscReal R_a = circle * radius[a], square = Distance2(x, a, b);
    o->area[o->at[i]]   = PgLensArea(R_a, radius[b], PetscSqrtReal(square));
    o->inside[o->at[i]] = square <= R_a * R_a;
  }
}
