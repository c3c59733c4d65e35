/* -study explicit, second part: the same stretch of a run with sweeps and with the solver, sub-cycled or not; how far
   loads and pressures are from the reference, and the time each took. */
#include "studyimpl.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  COLUMN_VARIANT,
  COLUMN_SWEEPS,
  COLUMN_EVERY,
  COLUMN_STEPS,
  COLUMN_SECONDS,
  COLUMN_PER_STEP,
  COLUMN_LOAD,
  COLUMN_LOAD_ERROR,
  COLUMN_LOAD_WORST,
  COLUMN_PRESSURE_ERROR,
  COLUMN_PRESSURE_MAX,
  COLUMN_RESIDUAL,
  COLUMN_REMARK,
  COLUMNS
};

static const PgTableColumn columns[COLUMNS] = {
    [COLUMN_VARIANT]  = {"variant", NULL, "method", "method", NULL, 12},
    [COLUMN_SWEEPS]   = {"sweeps", "1", "explicit sweeps in a fluid step", NULL, NULL, 0},
    [COLUMN_EVERY]    = {"fluid_every", "1", "steps of the discs in a fluid step", "M", "%.0f", 5},
    [COLUMN_STEPS]    = {"steps", "1", "steps of the discs", "steps", "%.0f", 7},
    [COLUMN_SECONDS]  = {"seconds", "s", "time of the run: CPU on one rank, wall on several", "time s", "%.3g", 8},
    [COLUMN_PER_STEP] = {"per_step", "us", "the same for each disc and step of the discs", "us/disc/step", "%.3g", 12},
    [COLUMN_LOAD]     = {"load", "N/m", "largest load of the loading plate", "peak N/m", "%.4g", 10},
    [COLUMN_LOAD_ERROR]     = {"load_error", "1", "rms difference of the loads from the reference over its largest",
                               "load rms", "%.2e", 9},
    [COLUMN_LOAD_WORST]     = {"load_error_max", "1", "largest difference of the loads over the reference's largest",
                               "load max", "%.2e", 9},
    [COLUMN_PRESSURE_ERROR] = {"pressure_error", "1",
                               "L2 difference of the pressures at the end over that of the reference's excess", "p L2",
                               "%.2e", 9},
    [COLUMN_PRESSURE_MAX]   = {"pressure_max", "Pa", "largest pressure at the end", "p max Pa", "%.4g", 10},
    [COLUMN_RESIDUAL]       = {"residual", "1", "true residual of the last fluid step", "residual", "%.1e", 9},
    [COLUMN_REMARK]         = {"remark", NULL, "how the run ended", "ended", NULL, 12},
};

typedef struct {
  char      name[32];
  PetscInt  sweeps, every; /* sweeps 0: implicit */
  PetscReal rtol;          /* implicit; 0: as the options say */
} Variant;

typedef struct {
  PetscInt   samples, done, steps, discs; /* loads asked for and taken; steps of the discs */
  PetscReal *load;                        /* (samples) [N/m] */
  PetscReal *pressure;                    /* by id, those of this rank; at the end [Pa] */
  PetscInt   count;
  PetscReal  seconds, pressure_max, residual;
  char       remark[96];
} Outcome;

/* One word of the list: implicit:M, implicitRTOL:M or explicitK:M. */
static PetscBool ParseOne(char *word, Variant *v)
{
  char           *colon = strchr(word, ':'), *end = NULL;
  const PetscBool implicit = (PetscBool)!strncmp(word, "implicit", 8),
                  sweeps   = (PetscBool)!strncmp(word, "explicit", 8);
  long every;

  if (!colon || !(implicit || sweeps)) return PETSC_FALSE;
  every  = strtol(colon + 1, &end, 10);
  *colon = '\0';
  if (end == colon + 1 || *end || every < 1 || every > 1000000) return PETSC_FALSE;
  (void)PetscStrncpy(v->name, word, sizeof v->name);
  v->every  = (PetscInt)every;
  v->sweeps = 0;
  v->rtol   = 0.0;
  if (implicit && !word[8]) return PETSC_TRUE;
  if (implicit)
    v->rtol = (PetscReal)strtod(word + 8, &end);
  else
    v->sweeps = (PetscInt)strtol(word + 8, &end, 10);
  if (end == word + 8 || *end) return PETSC_FALSE;
  return (PetscBool)(implicit ? v->rtol > 0.0 && v->rtol < 1.0 : v->sweeps > 0);
}

static PetscErrorCode Parse(PgStudy study, PetscInt most, Variant v[], PetscInt *count)
{
  char **word;
  int    words;

  PetscFunctionBeginUser;
  PetscCall(PetscStrToArray(study->variants, ',', &words, &word));
  PgInputCheck(words > 0 && words <= most, study->comm, "option -study_variants: between 1 and %" PetscInt_FMT " runs",
               most);
  for (int i = 0; i < words; i++)
    PgInputCheck(ParseOne(word[i], &v[i]), study->comm,
                 "option -study_variants: '%s' is not like implicit:10, implicit1e-4:10 or explicit5:1", word[i]);
  PetscCall(PetscStrToArrayDestroy(words, word));
  *count = words;
  PetscFunctionReturn(0);
}

static PetscInt LeastCommonMultiple(PetscInt a, PetscInt b)
{
  PetscInt x = a, y = b;

  while (y) {
    const PetscInt r = x % y;
    x                = y;
    y                = r;
  }
  return a / x * b;
}

static PetscErrorCode Start(PgStudy study, const Variant *v, PgOverride *o, PgSimulation *sim)
{
  char number[32];

  PetscFunctionBeginUser;
  PetscCall(PgOverrideSet(o, "-pressure", v->sweeps ? "explicit" : "implicit"));
  PetscCall(PetscSNPrintf(number, sizeof number, "%" PetscInt_FMT, PetscMax(v->sweeps, 1)));
  PetscCall(PgOverrideSet(o, "-pressure_sweeps", number));
  PetscCall(PetscSNPrintf(number, sizeof number, "%" PetscInt_FMT, v->every));
  PetscCall(PgOverrideSet(o, "-fluid_every", number));
  PetscCall(PetscSNPrintf(number, sizeof number, "%.17g", (double)v->rtol));
  if (v->rtol > 0.0) PetscCall(PgOverrideSet(o, "-pressure_ksp_rtol", number));
  PetscCall(PgOverrideRemove(o, "-output"));
  PetscCall(PgSimulationCreate(study->comm, sim));
  PetscCall(PgSimulationSetFromOptions(*sim));
  PetscCall(PgSimulationSetUp(*sim));
  PetscFunctionReturn(0);
}

/* The load of the last plate, the one that a case moves. */
static PetscErrorCode Load(PgSimulation sim, PetscReal *load)
{
  PgDem     dem;
  PetscInt  plates;
  PetscReal total;

  PetscFunctionBeginUser;
  *load = 0.0;
  PetscCall(PgSimulationGetParts(sim, NULL, NULL, &dem, NULL));
  PetscCall(PgDemGetPlateCount(dem, &plates));
  if (plates > 0) PetscCall(PgDemGetLoad(dem, plates - 1, load, &total));
  PetscFunctionReturn(0);
}

/* Steps through all samples, or until the water has blown up. Only the steps are timed. */
static PetscErrorCode Step(PgSimulation sim, const Variant *v, PetscInt interval, Outcome *r)
{
  MPI_Comm    comm;
  PgParticles particles;
  PgPore      pore;
  PgPoreStats stats;

  PetscFunctionBeginUser;
  PetscCall(PgSimulationGetParts(sim, &particles, NULL, NULL, &pore));
  comm = PgParticlesComm(particles);
  for (r->done = 0; r->done < r->samples; r->done++) {
    PetscReal begin, spent;
    PetscCall(PgClock(comm, &begin));
    for (PetscInt i = 0; i < interval / v->every; i++) PetscCall(PgSimulationStep(sim));
    PetscCall(PgClockSince(comm, begin, &spent));
    r->seconds += spent;
    PetscCall(Load(sim, &r->load[r->done]));
    PetscCall(PgPoreGetStats(pore, &stats));
    r->pressure_max = stats.p_max;
    if (!(PetscMax(PetscAbsReal(stats.p_min), PetscAbsReal(stats.p_max)) < 1e9)) {
      PetscCall(PetscSNPrintf(r->remark, sizeof r->remark, "water blown up"));
      PetscFunctionReturn(0);
    }
  }
  PetscCall(PetscSNPrintf(r->remark, sizeof r->remark, "as asked"));
  PetscFunctionReturn(0);
}

/* Residual of the pressure in use, and the pressures by id. */
static PetscErrorCode Finish(PgSimulation sim, Outcome *r)
{
  PgParticles particles;
  PgPore      pore;
  PgPressure  pressure;
  PgField     field;
  PetscReal  *p;
  PetscInt    start;
  PgPoreStats stats;

  PetscFunctionBeginUser;
  PetscCall(PgSimulationGetParts(sim, &particles, NULL, NULL, &pore));
  PetscCall(PgPoreGetParts(pore, NULL, &pressure));
  PetscCall(PgParticlesFindField(particles, "pressure", &field));
  PetscCall(PgParticlesGetArray(particles, field, &p));
  PetscCall(PgParticlesGetSizes(particles, NULL, NULL, &r->discs));
  PetscCall(PgParticlesGetIdRange(particles, &start, &r->count));
  PetscCall(PetscMalloc1(r->count, &r->pressure));
  PetscCall(PgParticlesToIdOrder(particles, 1, p, r->pressure));
  PetscCall(PgPressureRequestResidual(pressure, PETSC_TRUE));
  PetscCall(PgSimulationStep(sim));
  PetscCall(PgPoreGetStats(pore, &stats));
  r->residual = stats.pressure.residual;
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(PgStudy study, const Variant *v, PetscInt interval, Outcome *r)
{
  PgOverride     o   = {0};
  PgSimulation   sim = NULL;
  PgTrouble      trouble;
  PetscErrorCode code;

  PetscFunctionBeginUser;
  r->samples = study->samples;
  PetscCall(PetscCalloc1(r->samples, &r->load));
  PetscCall(Start(study, v, &o, &sim));
  PetscCall(PgTroubleBegin(&trouble));
  code = Step(sim, v, interval, r);
  PetscCall(PgTroubleEnd(study->comm, &code));
  r->steps = r->done * interval;
  if (code) PetscCall(PetscSNPrintf(r->remark, sizeof r->remark, "failed, see above"));
  if (r->done == r->samples) PetscCall(Finish(sim, r));
  PetscCall(PgSimulationDestroy(&sim));
  PetscCall(PgOverrideRestore(&o, NULL));
  PetscFunctionReturn(0);
}

/* Differences from the reference; a run that did not come to its end is compared as far as it got. */
static PetscErrorCode Compare(PgStudy study, const Outcome *r, const Outcome *reference, PetscReal *rms,
                              PetscReal *worst, PetscReal *pressure)
{
  PetscReal peak = 0.0, sum = 0.0, most = 0.0, p[3] = {0.0, 0.0, 0.0};
  PetscInt  n = PetscMin(r->done, reference->done);

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < reference->done; i++) peak = PetscMax(peak, PetscAbsReal(reference->load[i]));
  for (PetscInt i = 0; i < n; i++) {
    sum += PetscSqr(r->load[i] - reference->load[i]);
    most = PetscMax(most, PetscAbsReal(r->load[i] - reference->load[i]));
  }
  *rms = *worst = *pressure = PG_TABLE_EMPTY;
  if (n > 0 && peak > 0.0) {
    *rms   = PetscSqrtReal(sum / (PetscReal)n) / peak;
    *worst = most / peak;
  }
  if (!r->pressure || !reference->pressure) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < reference->count; i++) p[0] += reference->pressure[i];
  p[1] = (PetscReal)reference->count;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, p, 2, MPIU_REAL, MPIU_SUM, study->comm));
  {
    const PetscReal mean = p[0] / p[1]; /* the excess that matters is that over the mean */
    p[0] = p[1] = 0.0;
    for (PetscInt i = 0; i < reference->count; i++) {
      p[0] += PetscSqr(r->pressure[i] - reference->pressure[i]);
      p[1] += PetscSqr(reference->pressure[i] - mean);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, p, 2, MPIU_REAL, MPIU_SUM, study->comm));
  if (p[1] > 0.0) *pressure = PetscSqrtReal(p[0] / p[1]);
  PetscFunctionReturn(0);
}

static PetscErrorCode FillRow(PgStudy study, PgTable table, const Variant *v, const Outcome *r,
                              const Outcome *reference)
{
  PetscReal peak = 0.0, rms, worst, pressure;
  PetscInt  discs;

  PetscFunctionBeginUser;
  PetscCall(Compare(study, r, reference, &rms, &worst, &pressure));
  discs = reference->discs;
  for (PetscInt i = 0; i < r->done; i++) peak = PetscMax(peak, r->load[i]);
  PgTableText(table, COLUMN_VARIANT, "%s", v->name);
  PgTableReal(table, COLUMN_SWEEPS, (PetscReal)v->sweeps);
  PgTableReal(table, COLUMN_EVERY, (PetscReal)v->every);
  PgTableReal(table, COLUMN_STEPS, (PetscReal)r->steps);
  PgTableReal(table, COLUMN_SECONDS, r->seconds);
  if (r->steps && discs)
    PgTableReal(table, COLUMN_PER_STEP, 1e6 * r->seconds / ((PetscReal)r->steps * (PetscReal)discs));
  PgTableReal(table, COLUMN_LOAD, peak);
  PgTableReal(table, COLUMN_LOAD_ERROR, rms);
  PgTableReal(table, COLUMN_LOAD_WORST, worst);
  PgTableReal(table, COLUMN_PRESSURE_ERROR, pressure);
  PgTableReal(table, COLUMN_PRESSURE_MAX, r->pressure_max);
  if (r->pressure) PgTableReal(table, COLUMN_RESIDUAL, r->residual);
  PgTableText(table, COLUMN_REMARK, "%s", r->remark);
  PetscCall(PgTableEndRow(table, r->done, r->load, "N/m", "load of the loading plate at equal intervals of time"));
  PetscFunctionReturn(0);
}

/* Steps of the discs between two samples: a multiple of every M. */
static PetscErrorCode Interval(PgStudy study, PetscInt count, const Variant v[], PetscInt *interval, PetscReal *dt)
{
  PgOverride   o = {0};
  PgSimulation sim;
  PetscInt     all = 1;

  PetscFunctionBeginUser;
  PetscCall(Start(study, &v[0], &o, &sim));
  PetscCall(PgSimulationGetTime(sim, NULL, NULL, dt));
  PetscCall(PgSimulationDestroy(&sim));
  PetscCall(PgOverrideRestore(&o, NULL));
  for (PetscInt i = 0; i < count; i++) all = LeastCommonMultiple(all, v[i].every);
  *interval = all *
              PetscMax(1, (PetscInt)PetscCeilReal(study->stretch / (*dt * (PetscReal)(study->samples * all)) - 1e-9));
  PetscFunctionReturn(0);
}

PetscErrorCode PgStudyCost(PgStudy study)
{
  enum { MOST = 64 };
  Variant   v[MOST];
  Outcome   reference = {0};
  PetscInt  count = 0, interval = 1;
  PetscReal dt;
  PgTable   table;

  PetscFunctionBeginUser;
  PetscCall(Parse(study, MOST, v, &count));
  PetscCall(Interval(study, count, v, &interval, &dt));
  PetscCall(PetscPrintf(study->comm,
                        "\nruns of %g s: loads compared every %" PetscInt_FMT
                        " steps of the discs, time step %g s; reference: %s with M = %" PetscInt_FMT "\n",
                        (double)((PetscReal)(interval * study->samples) * dt), interval, (double)dt, v[0].name,
                        v[0].every));
  PetscCall(PgTableCreate(&study->files, "cost", COLUMNS, columns, &table));
  for (PetscInt i = 0; i < count; i++) {
    Outcome r = {0};
    PetscCall(Run(study, &v[i], interval, &r));
    PetscCall(FillRow(study, table, &v[i], &r, i ? &reference : &r));
    if (i == 0) {
      reference = r;
    } else {
      PetscCall(PetscFree(r.load));
      PetscCall(PetscFree(r.pressure));
    }
  }
  PetscCall(PetscFree(reference.load));
  PetscCall(PetscFree(reference.pressure));
  PetscCall(PgTableDestroy(&table));
  PetscFunctionReturn(0);
}
