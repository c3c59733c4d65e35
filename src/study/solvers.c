/* -study solvers: every solver of a file on systems of growing size. */
#include "studyimpl.h"
#include <math.h>
#include <string.h>

static const char *const order_words[]   = {"curve", "id"};
static const char *const packing_words[] = {"lattice", "jittered", "random"};

enum {
  COLUMN_SYSTEM,
  COLUMN_N,
  COLUMN_NONZEROS,
  COLUMN_STORED,
  COLUMN_SOLVER,
  COLUMN_ITERATIONS,
  COLUMN_GROWTH,
  COLUMN_RESIDUAL,
  COLUMN_ERROR,
  COLUMN_SETUP,
  COLUMN_SOLVE,
  COLUMN_PER_UNKNOWN,
  COLUMN_LEVELS,
  COLUMN_COMPLEXITY,
  COLUMN_CONDITION,
  COLUMN_NEEDED,
  COLUMN_RUNS,
  COLUMN_CODE,
  COLUMN_REASON,
  COLUMN_OPTIONS,
  COLUMNS
};

static const PgTableColumn columns[COLUMNS] = {
    [COLUMN_SYSTEM]     = {"system", NULL, "case, or file of the system", NULL, NULL, 0},
    [COLUMN_N]          = {"N", "1", "unknowns", "N", "%.0f", 8},
    [COLUMN_NONZEROS]   = {"nonzeros_per_row", "1", "entries that are not zero, per row", "nnz/row", "%.2f", 7},
    [COLUMN_STORED]     = {"stored_per_row", "1", "stored entries per row", NULL, NULL, 0},
    [COLUMN_SOLVER]     = {"solver", NULL, "name in the file of solvers", "solver", NULL, 19},
    [COLUMN_ITERATIONS] = {"iterations", "1", "iterations done", "its", "%.0f", 6},
    [COLUMN_GROWTH] = {"growth", "1", "exponent g of iterations ~ N^g, fitted over the sizes so far", "growth", "%.2f",
                       6},
    [COLUMN_RESIDUAL] = {"residual", "1", "true residual ||b - A x||/||b||, recomputed", "residual", "%.1e", 8},
    [COLUMN_ERROR] = {"error", "1", "largest difference from the reference over its largest value", "error", "%.1e", 8},
    [COLUMN_SETUP] = {"setup", "s", "set-up, median of the runs", "setup s", "%.3g", 8},
    [COLUMN_SOLVE] = {"solve", "s", "solve, median of the runs", "solve s", "%.3g", 8},
    [COLUMN_PER_UNKNOWN] = {"solve_per_unknown", "us", "solve over N", "us/N", "%.3g", 6},
    [COLUMN_LEVELS]      = {"levels", "1", "grids of a multigrid preconditioner", "levels", "%.0f", 6},
    [COLUMN_COMPLEXITY] = {"operator_complexity", "1", "entries of all grids over those of the finest", "op.c.", "%.2f",
                           5},
    [COLUMN_CONDITION]  = {"condition", "1", "condition number of the preconditioned matrix, from the Krylov space",
                           "cond", "%.3g", 8},
    [COLUMN_NEEDED]  = {"iterations_needed", "1", "iterations to rtol; extrapolated when the solver was stopped", NULL,
                        NULL, 0},
    [COLUMN_RUNS]    = {"runs", "1", "runs whose median is given", NULL, NULL, 0},
    [COLUMN_CODE]    = {"reason_code", "1", "KSPConvergedReason", NULL, NULL, 0},
    [COLUMN_REASON]  = {"reason", NULL, "why the solver ended", "ended", NULL, 20},
    [COLUMN_OPTIONS] = {"options", NULL, "options of the solver", NULL, NULL, 0},
};

static PetscErrorCode TrapOptions(PgStudy study, PetscOptionItems *PetscOptionsObject)
{
  PgSystemChoices *c          = &study->system;
  char             traps[256] = "", **word;
  int              words;
  PetscBool        set, imbalance;

  PetscFunctionBeginUser;
  PetscCall(
      PgOptionString(PetscOptionsObject, "-study_trap",
                     "mistakes to show, separated by commas: no_nullspace (the null space of a singular system is "
                     "not attached), unprojected (its right-hand side is not made compatible), "
                     "preconditioned_norm (PETSc's default norm)",
                     traps, sizeof traps, &set));
  PetscCall(PetscStrToArray(traps, ',', &words, &word));
  for (int i = 0; set && i < words; i++) {
    const PetscBool is[3] = {(PetscBool)!strcmp(word[i], "no_nullspace"), (PetscBool)!strcmp(word[i], "unprojected"),
                             (PetscBool)!strcmp(word[i], "preconditioned_norm")};
    PgInputCheck(is[0] || is[1] || is[2], study->comm,
                 "option -study_trap: '%s' is not one of no_nullspace, unprojected, preconditioned_norm", word[i]);
    c->no_nullspace        = (PetscBool)(c->no_nullspace || is[0]);
    c->unprojected         = (PetscBool)(c->unprojected || is[1]);
    c->preconditioned_norm = (PetscBool)(c->preconditioned_norm || is[2]);
  }
  PetscCall(PetscStrToArrayDestroy(words, word));
  PetscCall(
      PgOptionReal(PetscOptionsObject, "-study_imbalance",
                   "singular systems: part of the right-hand side that no solution has, over the rest of it; 0.025 "
                   "with -study_trap unprojected",
                   "1", 0.0, 1e3, &c->imbalance, &imbalance));
  if (c->unprojected && !imbalance) c->imbalance = 0.025;
  PetscFunctionReturn(0);
}

static PetscErrorCode SystemOptions(PgStudy study, PetscOptionItems *PetscOptionsObject)
{
  PgSystemChoices *c       = &study->system;
  PetscInt         packing = c->packing, order = c->by_id;
  PetscBool        packing_set, jitter_set, load;

  PetscFunctionBeginUser;
  PetscCall(PgOptionIntList(PetscOptionsObject, "-study_sizes",
                            "numbers of discs of the panel; each is taken to the nearest 2 W^2 - 1", 17, 2000000000,
                            &study->sizes, &study->sizes_set));
  PetscCall(PgOptionString(PetscOptionsObject, "-study_load",
                           "files of -pressure_dump, separated by commas, instead of a case", study->load,
                           sizeof study->load, &load));
  PgInputCheck(!load || !study->sizes_set, study->comm, "options -study_load and -study_sizes contradict each other");
  PetscCall(PgOptionReal(PetscOptionsObject, "-study_jitter",
                         "largest displacement of a disc in each direction, in its diameters; default 0.02 for "
                         "-study_packing jittered, 0.2 for random",
                         "1", 0.0, 0.4, &c->jitter, &jitter_set));
  if (jitter_set && c->jitter > 0.0) packing = PG_STUDY_JITTERED;
  PetscCall(
      PgOptionChoice(PetscOptionsObject, "-study_packing",
                     "lattice; jittered: discs displaced at random; random: displaced further, radii unequal by up "
                     "to 20 %",
                     3, packing_words, &packing, &packing_set));
  PgInputCheck(!(packing == PG_STUDY_LATTICE && jitter_set && c->jitter > 0.0), study->comm,
               "options -study_packing lattice and -study_jitter contradict each other");
  c->packing = (PgStudyPacking)packing;
  if (!jitter_set) c->jitter = packing == PG_STUDY_RANDOM ? 0.2 : 0.02;
  PetscCall(PgOptionChoice(PetscOptionsObject, "-study_order",
                           "rows in the order in which a run keeps its discs, along a curve, or by permanent id (the "
                           "panel: row by row); incomplete factors depend on it",
                           2, order_words, &order, NULL));
  c->by_id = (PetscBool)order;
  PetscCall(PgOptionInt(PetscOptionsObject, "-study_direct_limit",
                        "unknowns up to which answers are compared with a direct solve", 0, PETSC_MAX_INT,
                        &c->direct_limit, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode Options(PgStudy study, PetscOptionItems *PetscOptionsObject)
{
  PgSolveChoices *c = &study->solve;

  PetscFunctionBeginUser;
  PetscCall(PgStudySolverOptions(study, PetscOptionsObject));
  PetscCall(SystemOptions(study, PetscOptionsObject));
  PetscCall(TrapOptions(study, PetscOptionsObject));
  PetscCall(PgOptionReal(PetscOptionsObject, "-study_rtol", "residual norm to reach, over that of b", "1", 1e-15, 1.0,
                         &c->rtol, NULL));
  PetscCall(PgOptionInt(PetscOptionsObject, "-study_repeats", "runs of each solver; times are their medians", 1, 64,
                        &c->repeats, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-study_repeat_seconds", "no further run of a solver after so long", "s",
                         0.0, 1e9, &c->repeat_seconds, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-study_seconds", "a solve is stopped after so long", "s", PG_POSITIVE,
                         1e9, &c->seconds, NULL));
  PetscCall(PgOptionBool(PetscOptionsObject, "-study_condition",
                         "estimate the condition number of the preconditioned matrix (one more solve)", &c->condition,
                         NULL));
  PetscFunctionReturn(0);
}

/* The case, and the columns of the panel for each size. */
typedef struct {
  const PgCaseInfo *info;
  PetscBool         panel;
  PetscInt          count, size[PG_STUDY_LIST]; /* columns of the panel */
  char            **file;                       /* instead of a case */
} Plan;

static PetscErrorCode MakePlan(PgStudy study, Plan *plan)
{
  const char *const *names;
  PetscInt           count, chosen = 0;
  PetscBool          columns_set, rows_set;
  int                files = 0;

  PetscFunctionBeginUser;
  if (study->load[0]) {
    PetscCall(PetscStrToArray(study->load, ',', &files, &plan->file));
    plan->count = files;
    PetscFunctionReturn(0);
  }
  PetscCall(PgCaseGetNames(&count, &names));
  for (PetscInt i = 0; i < count; i++)
    if (!strcmp(names[i], "panel")) chosen = i;
  PetscOptionsBegin(study->comm, "", "run: what is computed, time step and end", "");
  PetscCall(PgOptionChoice(PetscOptionsObject, "-case", "problem to set up", count, names, &chosen, NULL));
  PetscOptionsEnd();
  PetscCall(PgCaseFind(names[chosen], &plan->info));
  PgInputCheck(plan->info->setup, study->comm,
               "case %s makes packings of its own, not one to study solvers on: 'porograin -case %s' runs it",
               names[chosen], names[chosen]);
  plan->panel = (PetscBool)!strcmp(names[chosen], "panel");
  PetscCall(PetscOptionsHasName(NULL, NULL, "-panel_columns", &columns_set));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-panel_rows", &rows_set));
  PgInputCheck(!study->sizes_set || plan->panel, study->comm,
               "options -study_sizes and -case %s contradict each other: only the panel has sizes", names[chosen]);
  PgInputCheck(!study->sizes_set || !(columns_set || rows_set), study->comm,
               "options -study_sizes and %s contradict each other: the sizes choose columns and rows",
               columns_set ? "-panel_columns" : "-panel_rows");
  plan->count = 1;
  if (!plan->panel || columns_set || rows_set) {
    plan->panel = PETSC_FALSE; /* as the options say */
    PetscFunctionReturn(0);
  }
  plan->count = study->sizes.count;
  for (PetscInt i = 0; i < plan->count; i++)
    plan->size[i] = PetscMax(
        3, (PetscInt)PetscFloorReal(PetscSqrtReal(0.5 * ((PetscReal)study->sizes.value[i] + 1.0)) + 0.5));
  PetscFunctionReturn(0);
}

/* The options are checked when the first system has read its own. */
static PetscErrorCode Make(PgStudy study, const Plan *plan, PetscInt i, PgSystem **system)
{
  PgOverride o = {0};
  PgPressure pressure;
  char       value[32];

  PetscFunctionBeginUser;
  PetscCall(PgSystemCreate(study->comm, system));
  if (plan->file) {
    if (i == 0) PetscCall(PgOptionsCheckUnused(study->comm, NULL, NULL));
    PetscCall(PgSystemLoad(*system, plan->file[i], &study->system));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscSNPrintf(value, sizeof value, "%" PetscInt_FMT, plan->size[i]));
  if (plan->panel) PetscCall(PgOverrideSet(&o, "-panel_columns", value));
  PetscCall(PgSystemFromCase(*system, plan->info, &study->system));
  PetscCall(PgOverrideRestore(&o, NULL));
  if (i == 0) {
    PetscCall(PgPoreGetParts((*system)->pore, NULL, &pressure));
    PetscCall(PgOptionsCheckUnused(study->comm, PgPressureProbeOptions, pressure));
  }
  PetscCall(PgSystemBuild(*system, &study->system));
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintSystem(PgStudy study, const PgSystem *s)
{
  static const char *const sides[] = {"left", "right", "bottom", "top"}, *const kinds[] = {"drained", "impermeable",
                                                                                           "flux", "natural"};
  const PgSystemChoices *c         = &study->system;
  char                   text[256] = "";

  PetscFunctionBeginUser;
  if (s->pore) {
    PetscCall(PetscSNPrintf(text, sizeof text, ", %s", packing_words[c->packing]));
    if (c->packing != PG_STUDY_LATTICE) {
      char one[64];
      PetscCall(PetscSNPrintf(one, sizeof one, " by %.4g diameters", (double)c->jitter));
      PetscCall(PetscStrlcat(text, one, sizeof text));
    }
    if (c->by_id) PetscCall(PetscStrlcat(text, ", rows by id", sizeof text));
    for (int i = 0; i < PG_SIDE_COUNT; i++) {
      PgBoundary bc;
      char       one[64];
      PetscCall(PgPoreGetBoundary(s->pore, (PgSide)i, &bc));
      PetscCall(PetscSNPrintf(one, sizeof one, ", %s %s", sides[i], kinds[bc.kind]));
      PetscCall(PetscStrlcat(text, one, sizeof text));
    }
  }
  PetscCall(PetscPrintf(study->comm, "system %s%s: N = %" PetscInt_FMT ", %ssymmetric%s; errors against %s\n", s->name,
                        text, s->n, s->symmetric ? "" : "not ", s->singular ? ", singular" : "",
                        s->reference ? s->reference_name : "nothing"));
  if (s->singular)
    PetscCall(PetscPrintf(study->comm, "  null space %s, right-hand side: %.2e of it has no solution, %s\n",
                          c->no_nullspace ? "NOT attached" : "attached", (double)s->removed,
                          c->unprojected ? "NOT removed" : "removed"));
  PetscFunctionReturn(0);
}

static PetscErrorCode FillOptions(PgTable table, const PgSolver *solver)
{
  char text[PG_TABLE_TEXT] = "";

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < solver->options; i++) {
    PetscCall(PetscStrlcat(text, i ? " -" : "-", sizeof text));
    PetscCall(PetscStrlcat(text, solver->option[i], sizeof text));
    if (!solver->value[i]) continue;
    PetscCall(PetscStrlcat(text, " ", sizeof text));
    PetscCall(PetscStrlcat(text, solver->value[i], sizeof text));
  }
  PgTableText(table, COLUMN_OPTIONS, "%s", text);
  PetscFunctionReturn(0);
}

static PetscErrorCode FillRow(PgTable table, const PgSystem *s, const PgSolver *solver, const PgSolveResult *r,
                              PetscReal growth)
{
  PetscFunctionBeginUser;
  PgTableText(table, COLUMN_SYSTEM, "%s", s->name);
  PgTableReal(table, COLUMN_N, (PetscReal)s->n);
  PgTableReal(table, COLUMN_NONZEROS, s->nonzeros);
  PgTableReal(table, COLUMN_STORED, s->stored);
  PgTableText(table, COLUMN_SOLVER, "%s", solver->name);
  PgTableText(table, COLUMN_REASON, "%s", r->words);
  PetscCall(FillOptions(table, solver));
  if (!r->failed) {
    PgTableReal(table, COLUMN_ITERATIONS, (PetscReal)r->iterations);
    PgTableReal(table, COLUMN_GROWTH, growth);
    PgTableReal(table, COLUMN_RESIDUAL, r->residual);
    PgTableReal(table, COLUMN_ERROR, r->error);
    PgTableReal(table, COLUMN_SETUP, r->setup);
    PgTableReal(table, COLUMN_SOLVE, r->solve);
    PgTableReal(table, COLUMN_PER_UNKNOWN, 1e6 * r->solve / (PetscReal)s->n);
    if (r->levels) PgTableReal(table, COLUMN_LEVELS, (PetscReal)r->levels);
    PgTableReal(table, COLUMN_COMPLEXITY, r->complexity);
    PgTableReal(table, COLUMN_CONDITION, r->condition);
    PgTableReal(table, COLUMN_NEEDED, r->needed);
    PgTableReal(table, COLUMN_RUNS, (PetscReal)r->runs);
    PgTableReal(table, COLUMN_CODE, (PetscReal)r->reason);
  }
  PetscCall(PgTableEndRow(table, r->failed ? 0 : r->history_length, r->history, "1",
                          "residual norm over that of b, before the first iteration and after each"));
  PetscFunctionReturn(0);
}

/* Iterations of every solver at every size, and their growth. */
typedef struct {
  PetscInt   systems, solvers;
  PetscReal *size;       /* by system */
  PetscReal *iterations; /* (solvers, systems), 0: did not converge */
} Summary;

static PetscErrorCode PrintSummary(PgStudy study, const PgSolverList *list, const Summary *m)
{
  PetscFunctionBeginUser;
  if (m->systems < 2) PetscFunctionReturn(0);
  PetscCall(PetscPrintf(study->comm, "\niterations by size          "));
  for (PetscInt i = 0; i < m->systems; i++) PetscCall(PetscPrintf(study->comm, "%9.0f", (double)m->size[i]));
  PetscCall(PetscPrintf(study->comm, "  growth\n"));
  for (PetscInt k = 0; k < m->solvers; k++) {
    const PetscReal *its    = m->iterations + k * m->systems;
    const PetscReal  growth = PgStudyGrowth(m->systems, m->size, its);
    PetscCall(PetscPrintf(study->comm, "%-28s", list->solver[k].name));
    for (PetscInt i = 0; i < m->systems; i++) {
      if (its[i] > 0.0)
        PetscCall(PetscPrintf(study->comm, "%9.0f", (double)its[i]));
      else
        PetscCall(PetscPrintf(study->comm, "%9s", "-"));
    }
    if (isnan(growth))
      PetscCall(PetscPrintf(study->comm, "       -\n"));
    else
      PetscCall(PetscPrintf(study->comm, "  N^%.2f\n", (double)growth));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode RunSystem(PgStudy study, PgSystem *s, PgSolverList *list, PgTable table, Summary *m,
                                PetscInt which)
{
  PetscFunctionBeginUser;
  m->size[which] = (PetscReal)s->n;
  for (PetscInt k = 0; k < list->count; k++) {
    PetscReal    *its = m->iterations + k * m->systems;
    PgSolveResult result;

    PetscCall(PgSolve(s, &study->system, &list->solver[k], &study->solve, &result));
    if (!result.failed && result.reason > 0) its[which] = (PetscReal)result.iterations;
    PetscCall(FillRow(table, s, &list->solver[k], &result, PgStudyGrowth(which + 1, m->size, its)));
    PetscCall(PgSolveResultFree(&result));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintHead(PgStudy study, const PgSolverList *list)
{
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(study->comm, &size));
  PetscCall(PetscPrintf(
      study->comm,
      "%" PetscInt_FMT " solver%s of %s, rtol %.4g %s, zero guess; %d rank%s, %s time, medians of %" PetscInt_FMT
      " runs or of as many as fit into %.4g s\n",
      list->count, list->count == 1 ? "" : "s", list->file, (double)study->solve.rtol,
      study->system.preconditioned_norm ? "in PETSc's default norm (NOT that of the residual)" : "on ||b - A x||/||b||",
      (int)size, size == 1 ? "" : "s", size > 1 ? "wall" : "CPU", study->solve.repeats,
      (double)study->solve.repeat_seconds));
  PetscFunctionReturn(0);
}

static PetscErrorCode RunStudy(PgStudy study)
{
  Plan         plan = {0};
  PgSolverList list;
  PgTable      table = NULL;
  Summary      m;

  PetscFunctionBeginUser;
  PetscCall(PgSolverListRead(study->comm, study->solver_file, study->only, &list));
  PetscCall(MakePlan(study, &plan));
  PetscCall(PgSolverListCheck(study->comm, &list));
  m = (Summary){plan.count, list.count, NULL, NULL};
  PetscCall(PetscCalloc2(m.systems, &m.size, m.systems * m.solvers, &m.iterations));
  for (PetscInt i = 0; i < plan.count; i++) {
    PgSystem *s;
    PetscCall(Make(study, &plan, i, &s));
    if (!table) {
      PetscCall(PrintHead(study, &list));
      PetscCall(PgTableCreate(&study->files, "study", COLUMNS, columns, &table));
    }
    PetscCall(PrintSystem(study, s));
    PetscCall(RunSystem(study, s, &list, table, &m, i));
    PetscCall(PgSystemDestroy(&s));
  }
  PetscCall(PrintSummary(study, &list, &m));
  PetscCall(PgTableDestroy(&table));
  PetscCall(PetscFree2(m.size, m.iterations));
  if (plan.file) PetscCall(PetscStrToArrayDestroy((int)plan.count, plan.file));
  PetscCall(PgSolverListDestroy(&list));
  PetscFunctionReturn(0);
}

const PgStudyKind PgStudySolvers = {"solvers", "solvers on systems of growing size", Options, RunStudy};
