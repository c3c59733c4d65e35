/* -study mms: the operators and the solved pressure against an exact field, all choices of operators in one table: the
   cases operator_mms and pressure_mms, whose files say what is measured. */
#include "studyimpl.h"
#include <math.h>

enum {
  COLUMN_PACKING,
  COLUMN_OPERATORS,
  COLUMN_N,
  COLUMN_SPACING,
  COLUMN_GRADIENT,
  COLUMN_GRADIENT_ORDER,
  COLUMN_LAPLACIAN,
  COLUMN_LAPLACIAN_ORDER,
  COLUMN_PRESSURE,
  COLUMN_PRESSURE_ORDER,
  COLUMN_ITERATIONS,
  COLUMN_FALLBACKS,
  COLUMNS
};

static const PgTableColumn columns[COLUMNS] = {
    [COLUMN_PACKING]   = {"packing", NULL, "lattice or jittered", "points", NULL, 8},
    [COLUMN_OPERATORS] = {"operators", NULL, "form of the operators", "operators", NULL, 16},
    [COLUMN_N]         = {"N", "1", "points", "N", "%.0f", 8},
    [COLUMN_SPACING]   = {"spacing", "1", "distance of neighbours; h = 1.25 of it unless -sph_smoothing says else",
                          "spacing", "%.3g", 8},
    [COLUMN_GRADIENT]  = {"gradient_error", "1", "L2 error of the gradient over its L2 norm, inside", "grad p", "%.2e",
                          9},
    [COLUMN_GRADIENT_ORDER] = {"gradient_order", "1", "observed order", "order", "%.2f", 6},
    [COLUMN_LAPLACIAN] = {"laplacian_error", "1", "L2 error of the Laplacian over its L2 norm, inside", "lap p", "%.2e",
                          9},
    [COLUMN_LAPLACIAN_ORDER] = {"laplacian_order", "1", "observed order", "order", "%.2f", 6},
    [COLUMN_PRESSURE]        = {"pressure_error", "1",
                                "L2 error of the solved pressure over the L2 norm of its part that is not linear, inside",
                                "solved p", "%.2e", 9},
    [COLUMN_PRESSURE_ORDER]  = {"pressure_order", "1", "observed order", "order", "%.2f", 6},
    [COLUMN_ITERATIONS]      = {"iterations", "1", "Krylov iterations of the solve", "its", "%.0f", 5},
    [COLUMN_FALLBACKS] = {"fallbacks", "1", "rows whose correction fell back to the plain form", "fallbacks", "%.0f",
                          9},
};

typedef struct {
  const char *name, *gradient, *laplacian, *eta;
} Variant;
static const Variant variants[] = {{"paper, eta 0.1", "paper", "paper", "0.1"},
                                   {"eta 0.01", "paper", "paper", "0.01"},
                                   {"eta 0", "paper", "paper", "0"},
                                   {"corrected", "corrected", "corrected", "0.1"}};

typedef struct {
  PetscReal gradient, laplacian, pressure; /* relative errors */
  PetscReal h, pressure_h;                 /* smoothing length, also of the packing of the pressure */
  PetscInt  n, iterations, fallbacks;
} Errors;

static PetscErrorCode Options(PgStudy study, PetscOptionItems *PetscOptionsObject)
{
  PetscFunctionBeginUser;
  PetscCall(PgOptionInt(PetscOptionsObject, "-study_mms_points", "points across the coarsest square", 12, 4096,
                        &study->columns, NULL));
  PetscCall(PgOptionInt(PetscOptionsObject, "-study_mms_levels",
                        "squares, each with half the spacing of the one before", 1, 10, &study->levels, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-study_mms_jitter",
                         "largest displacement of the jittered points in each direction, in spacings", "1", 0.0, 0.4,
                         &study->mms_jitter, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode Measure(MPI_Comm comm, const Variant *variant, const PgMmsPacking *packing, PetscBool check,
                              Errors *e)
{
  PgOverride          o = {0};
  PgMmsOperatorErrors operators;
  PgMmsPressureErrors pressure;

  PetscFunctionBeginUser;
  if (variant) {
    PetscCall(PgOverrideSet(&o, "-sph_gradient", variant->gradient));
    PetscCall(PgOverrideSet(&o, "-sph_laplacian", variant->laplacian));
    PetscCall(PgOverrideSet(&o, "-sph_laplacian_eta", variant->eta));
  }
  PetscCall(PgMmsPressure(comm, packing, PG_MMS_DIRICHLET, check, &pressure)); /* reads all that operators read */
  PetscCall(PgMmsOperators(comm, packing, PETSC_FALSE, &operators));
  PetscCall(PgOverrideRestore(&o, NULL));
  e->n          = operators.n;
  e->gradient   = operators.gradient;
  e->laplacian  = operators.laplacian;
  e->pressure   = pressure.error;
  e->h          = operators.h;
  e->pressure_h = pressure.h;
  e->iterations = pressure.iterations;
  e->fallbacks  = operators.fallbacks;
  PetscFunctionReturn(0);
}

static PetscReal Order(PetscReal before, PetscReal now, PetscReal h_before, PetscReal h)
{
  return before > 0.0 && now > 0.0 ? PetscLogReal(before / now) / PetscLogReal(h_before / h) : PG_TABLE_EMPTY;
}

static PetscErrorCode FillRow(PgTable table, PetscBool jittered, const char name[], PetscReal spacing, const Errors *e,
                              const Errors *before)
{
  PetscFunctionBeginUser;
  PgTableText(table, COLUMN_PACKING, "%s", jittered ? "jittered" : "lattice");
  PgTableText(table, COLUMN_OPERATORS, "%s", name);
  PgTableReal(table, COLUMN_N, (PetscReal)e->n);
  PgTableReal(table, COLUMN_SPACING, spacing);
  PgTableReal(table, COLUMN_GRADIENT, e->gradient);
  PgTableReal(table, COLUMN_LAPLACIAN, e->laplacian);
  PgTableReal(table, COLUMN_PRESSURE, e->pressure);
  PgTableReal(table, COLUMN_GRADIENT_ORDER, Order(before->gradient, e->gradient, before->h, e->h));
  PgTableReal(table, COLUMN_LAPLACIAN_ORDER, Order(before->laplacian, e->laplacian, before->h, e->h));
  PgTableReal(table, COLUMN_PRESSURE_ORDER, Order(before->pressure, e->pressure, before->pressure_h, e->pressure_h));
  PgTableReal(table, COLUMN_ITERATIONS, (PetscReal)e->iterations);
  PgTableReal(table, COLUMN_FALLBACKS, (PetscReal)e->fallbacks);
  PetscCall(PgTableEndRow(table, 0, NULL, NULL, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode RunVariant(PgStudy study, const Variant *variant, PetscBool jittered, PgTable *table)
{
  Errors before = {0};

  PetscFunctionBeginUser;
  for (PetscInt level = 0; level < study->levels; level++) {
    const PgMmsPacking packing = {.points = study->columns << level, .jitter = jittered ? study->mms_jitter : 0.0};
    Errors             e       = {0};

    PetscCall(Measure(study->comm, variant, &packing, (PetscBool) !*table, &e));
    /* all options have been read now, and nothing is written yet */
    if (!*table) PetscCall(PgTableCreate(&study->files, "study", COLUMNS, columns, table));
    PetscCall(
        FillRow(*table, jittered, variant ? variant->name : "as given", 1.0 / (PetscReal)packing.points, &e, &before));
    before = e;
  }
  PetscFunctionReturn(0);
}

/* Operators given by options are studied alone, all variants otherwise. */
static PetscErrorCode GivenByOptions(PetscBool *given)
{
  static const char *const names[] = {"-sph_operators", "-sph_gradient", "-sph_laplacian", "-sph_laplacian_eta"};

  PetscFunctionBeginUser;
  *given = PETSC_FALSE;
  for (size_t i = 0; i < sizeof names / sizeof *names && !*given; i++)
    PetscCall(PetscOptionsHasName(NULL, NULL, names[i], given));
  PetscFunctionReturn(0);
}

static PetscErrorCode RunStudy(PgStudy study)
{
  PgTable   table = NULL;
  PetscBool given;

  PetscFunctionBeginUser;
  PetscCall(GivenByOptions(&given));
  for (int jittered = 0; jittered < (study->mms_jitter > 0.0 ? 2 : 1); jittered++)
    for (size_t v = 0; v < (given ? 1 : sizeof variants / sizeof *variants); v++)
      PetscCall(RunVariant(study, given ? NULL : &variants[v], (PetscBool)jittered, &table));
  PetscCall(PgTableDestroy(&table));
  PetscFunctionReturn(0);
}

const PgStudyKind PgStudyMms = {"mms", "operators and solved pressure against an exact field", Options, RunStudy};
