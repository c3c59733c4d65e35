/* Lines of the verification table, and failure where a value or an order is missed:

     VERIFY | case | quantity | reference | computed | error | order | tolerance | reason

   tests/support/verification_table.sh makes docs/verification.md from them. */
#pragma once

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <petscsys.h>

#ifndef CHECK
  #define CHECK(call) assert_int_equal((call), 0)
#endif

static inline void VerifyLine(const char what[], const char quantity[], const char reference[], const char computed[],
                              const char error[], const char order[], const char tolerance[], const char reason[])
{
  CHECK(PetscPrintf(PETSC_COMM_WORLD, "VERIFY | %s | %s | %s | %s | %s | %s | %s | %s\n", what, quantity, reference,
                    computed, error, order, tolerance, reason));
}

/* |computed - reference| <= tolerance*scale; scale 0 is |reference|. The table says of any other scale what it is. */
static inline void VerifyValue(const char what[], const char quantity[], PetscReal reference, PetscReal computed,
                               PetscReal scale, PetscReal tolerance, const char reason[])
{
  const PetscReal unit = scale > 0.0 ? scale : PetscAbsReal(reference), error = PetscAbsReal(computed - reference);
  char            r[32], c[32], e[32], t[64];

  (void)snprintf(r, sizeof r, "%.6g", (double)reference);
  (void)snprintf(c, sizeof c, "%.6g", (double)computed);
  (void)snprintf(e, sizeof e, "%.2e", (double)(error / unit));
  if (unit == PetscAbsReal(reference))
    (void)snprintf(t, sizeof t, "%.2g", (double)tolerance);
  else if (unit == 1.0)
    (void)snprintf(t, sizeof t, "%.2g (absolute)", (double)tolerance);
  else
    (void)snprintf(t, sizeof t, "%.2g of %.4g", (double)tolerance, (double)unit);
  VerifyLine(what, quantity, r, c, e, "", t, reason);
  if (!(error <= tolerance * unit))
    fail_msg("%s, %s: %.9g instead of %.9g, off by %.3g of %.3g, allowed %.3g", what, quantity, (double)computed,
             (double)reference, (double)(error / unit), (double)unit, (double)tolerance);
}

/* low <= computed <= high; no single reference. */
static inline void VerifyRange(const char what[], const char quantity[], PetscReal low, PetscReal high,
                               PetscReal computed, const char reason[])
{
  char r[64], c[32];

  (void)snprintf(r, sizeof r, "%.5g to %.5g", (double)low, (double)high);
  (void)snprintf(c, sizeof c, "%.6g", (double)computed);
  VerifyLine(what, quantity, r, c, "", "", "inside", reason);
  if (!(computed >= low && computed <= high))
    fail_msg("%s, %s: %.9g is not between %.9g and %.9g", what, quantity, (double)computed, (double)low, (double)high);
}

/* Reported, nothing to compare with. */
static inline void VerifyReport(const char what[], const char quantity[], PetscReal computed, const char reason[])
{
  char c[32];

  (void)snprintf(c, sizeof c, "%.6g", (double)computed);
  VerifyLine(what, quantity, "none", c, "", "", "reported", reason);
}

/* The order observed between every two of `count` refinements is at least expected - tolerance; each error is printed,
   the last order in the line of the table. */
static inline void VerifyOrder(const char what[], const char quantity[], PetscInt count, const PetscReal h[],
                               const PetscReal error[], PetscReal expected, PetscReal tolerance, const char reason[])
{
  PetscReal order = 0.0, least = PETSC_MAX_REAL;
  char      e[32], o[64], t[32], r[32];

  for (PetscInt k = 0; k < count; k++) {
    order = k ? PetscLogReal(error[k - 1] / error[k]) / PetscLogReal(h[k - 1] / h[k]) : 0.0;
    if (k) least = PetscMin(least, order);
    CHECK(PetscPrintf(PETSC_COMM_WORLD, "  %s, %s: h = %.4g, error %.4e, order %.3f\n", what, quantity, (double)h[k],
                      (double)error[k], (double)order));
  }
  (void)snprintf(r, sizeof r, "order %.3g", (double)expected);
  (void)snprintf(e, sizeof e, "%.2e", (double)error[count - 1]);
  (void)snprintf(o, sizeof o, "%.2f", (double)order);
  (void)snprintf(t, sizeof t, "order >= %.3g", (double)(expected - tolerance));
  VerifyLine(what, quantity, r, o, e, o, t, reason);
  if (!(least >= expected - tolerance))
    fail_msg("%s, %s: order %.3g, expected %.3g, allowed %.3g below", what, quantity, (double)least, (double)expected,
             (double)tolerance);
}
