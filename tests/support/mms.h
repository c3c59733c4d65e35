/* What the verification with manufactured solutions shares: packings that fill the unit square, a table of errors at
   several refinements, and the judgement of a sequence of errors. */
#pragma once

#include "ground.h"
#include "verify.h"

/* About as high as wide. */
static inline Packing SquarePacking(PetscInt columns, PetscReal width, PetscReal jitter)
{
  Packing p = {columns, 0, 0.5 * width / (PetscReal)columns, jitter, 0.0};

  p.rows = (PetscInt)(width / (PetscSqrtReal(3.0) * p.radius));
  if (p.rows % 2 == 0) p.rows--;
  return p;
}

/* The smoothing length of these packings: 2.5 radii. */
static inline PetscReal SmoothingLength(const Packing *p) { return 2.5 * p->radius; }

typedef struct {
  char      name[96];
  PetscInt  count; /* refinements so far */
  PetscReal error[8], h[8];
} Sequence;

static inline Sequence SequenceStart(const char name[])
{
  Sequence s = {.count = 0};
  (void)snprintf(s.name, sizeof s.name, "%s", name);
  return s;
}

/* Order between the last two refinements. */
static inline PetscReal SequenceOrder(const Sequence *s)
{
  const PetscInt k = s->count - 1;
  return k < 1 ? 0.0 : PetscLogReal(s->error[k - 1] / s->error[k]) / PetscLogReal(s->h[k - 1] / s->h[k]);
}

/* A value that is approached in proportion to h: from the last two refinements. */
static inline PetscReal SequenceLimit(const Sequence *s)
{
  const PetscInt k = s->count - 1;
  return (s->error[k] * s->h[k - 1] - s->error[k - 1] * s->h[k]) / (s->h[k - 1] - s->h[k]);
}

static inline void TableHead(MPI_Comm comm)
{
  CHECK(PetscPrintf(comm, "%-52s %7s %10s %11s %7s\n", "case", "N", "h", "error", "order"));
}

static inline void SequenceAdd(Sequence *s, PetscInt count, PetscReal h, PetscReal error)
{
  assert_true(s->count < 8);
  s->error[s->count] = error;
  s->h[s->count]     = h;
  s->count++;
  if (s->count == 1)
    CHECK(PetscPrintf(PETSC_COMM_WORLD, "%-52s %7" PetscInt_FMT " %10.3e %11.4e %7s\n", s->name, count, (double)h,
                      (double)error, "-"));
  else
    CHECK(PetscPrintf(PETSC_COMM_WORLD, "%-52s %7" PetscInt_FMT " %10.3e %11.4e %7.2f\n", s->name, count, (double)h,
                      (double)error, (double)SequenceOrder(s)));
}

/* Lines of the table of verification. What they state is asserted by the test that calls them. */
static inline void SequenceLine(const char what[], const Sequence *s, PetscReal order, const char tolerance[],
                                const char reason[])
{
  char reference[32], found[32], error[32];

  (void)snprintf(reference, sizeof reference, "order %g", (double)order);
  (void)snprintf(found, sizeof found, "%.2f", (double)SequenceOrder(s));
  (void)snprintf(error, sizeof error, "%.2e", (double)s->error[s->count - 1]);
  VerifyLine(what, s->name, reference, found, error, found, tolerance, reason);
}

static inline void PlateauLine(const char what[], const char name[], PetscReal plateau, PetscReal value,
                               const char tolerance[], const char reason[])
{
  char quantity[128], reference[32], found[32], error[32];

  (void)snprintf(quantity, sizeof quantity, "%s", name);
  (void)snprintf(reference, sizeof reference, "%.4g", (double)plateau);
  (void)snprintf(found, sizeof found, "%.4g", (double)value);
  (void)snprintf(error, sizeof error, "%.1e", (double)PetscAbsReal(value / plateau - 1.0));
  VerifyLine(what, quantity, reference, found, error, "", tolerance, reason);
}
