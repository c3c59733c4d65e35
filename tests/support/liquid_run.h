/* Runs of the problems wcsph_* for tests: options in, errors out. */
#pragma once

#include "verify.h"
#include <porograin/cases.h>
#include <string.h>

typedef struct {
  PgLiquid  liquid;
  PgWcsph   wcsph;
  PetscReal dt, end;
} LiquidRun;

/* Options "-name value ..." of this run alone. */
static inline void LiquidStart(LiquidRun *run, const char name[], const char options[])
{
  CHECK(PetscOptionsClear(NULL));
  CHECK(PetscOptionsInsertString(NULL, options));
  CHECK(PgLiquidCreate(PETSC_COMM_WORLD, name, &run->liquid));
  CHECK(PgLiquidSetUp(run->liquid));
  CHECK(PgLiquidGetWcsph(run->liquid, &run->wcsph));
  CHECK(PgLiquidGetTimes(run->liquid, &run->dt, &run->end));
}

/* Steps to `end`; the time step divides the end of the run. */
static inline void LiquidStepTo(LiquidRun *run, PetscReal end)
{
  PetscReal t = 0.0;

  for (;;) {
    CHECK(PgWcsphGetTime(run->wcsph, NULL, &t));
    if (t > end - 0.5 * run->dt) break;
    CHECK(PgWcsphStep(run->wcsph, run->dt));
  }
}

static inline void LiquidErrors(const char name[], const char options[], PetscReal *l2, PetscReal *most)
{
  LiquidRun run;

  LiquidStart(&run, name, options);
  LiquidStepTo(&run, run.end);
  CHECK(PgLiquidGetErrors(run.liquid, l2, most));
  CHECK(PgLiquidDestroy(&run.liquid));
}
