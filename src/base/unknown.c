/* Options that nobody asked for: unknown, misspelt, or of another kind of run. */
#include "baseimpl.h"
#include <stdio.h>
#include <string.h>
#include <strings.h>

static PetscErrorCode (*all_options)(MPI_Comm) = NULL;

void PgOptionsSetCollector(PetscErrorCode (*collect)(MPI_Comm)) { all_options = collect; }

/* Options of PETSc itself. Some it reads only when it ends, so that they would count as unknown before. */
static const char *const petsc_options[] = {"citations",
                                            "check_pointer_intensity",
                                            "checkfunctionlist",
                                            "debugger_pause",
                                            "debugger_ranks",
                                            "device_enable",
                                            "device_select",
                                            "device_view",
                                            "display",
                                            "error_output_none",
                                            "error_output_stdout",
                                            "error_stack",
                                            "fp_trap",
                                            "get_total_flops",
                                            "h",
                                            "help",
                                            "history",
                                            "info",
                                            "info_exclude",
                                            "log",
                                            "log_all",
                                            "log_exclude",
                                            "log_summary",
                                            "log_sync",
                                            "log_threshold",
                                            "log_trace",
                                            "log_view",
                                            "log_view_gpu_time",
                                            "log_view_memory",
                                            "malloc",
                                            "malloc_coalesce",
                                            "malloc_debug",
                                            "malloc_dump",
                                            "malloc_hbw",
                                            "malloc_info",
                                            "malloc_requested_size",
                                            "malloc_test",
                                            "malloc_view",
                                            "malloc_view_threshold",
                                            "memory_view",
                                            "mpi_return_on_error",
                                            "no_signal_handler",
                                            "not_shared_tmp",
                                            "nox",
                                            "nox_warning",
                                            "objects_dump",
                                            "on_error_abort",
                                            "on_error_attach_debugger",
                                            "on_error_emacs",
                                            "on_error_mpiabort",
                                            "options_file",
                                            "options_file_yaml",
                                            "options_left",
                                            "options_monitor",
                                            "options_monitor_cancel",
                                            "options_string_yaml",
                                            "options_suppress_deprecated_warnings",
                                            "options_view",
                                            "petsc_ci",
                                            "petsc_ci_portable_error_output",
                                            "petsc_sleep",
                                            "prefix_pop",
                                            "prefix_push",
                                            "saws_options",
                                            "shared_tmp",
                                            "skip_petscrc",
                                            "start_in_debugger",
                                            "stop_for_debugger",
                                            "tmp",
                                            "use_gpu_aware_mpi",
                                            "version",
                                            "x_virtual"};
enum { PETSC_OPTIONS = sizeof petsc_options / sizeof *petsc_options };

static PetscBool BelongsToPetsc(const char name[])
{
  for (size_t i = 0; i < PETSC_OPTIONS; i++)
    if (!strcasecmp(name, petsc_options[i])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* All names there are: of PETSc, of objects that the run has made, and of those that another run would make. */
static PetscErrorCode LearnNames(MPI_Comm comm, PetscErrorCode (*probe)(void *), void *context)
{
  PetscFunctionBeginUser;
  for (size_t i = 0; i < PETSC_OPTIONS; i++) {
    const PgKnownOption option = {petsc_options[i], "", "", "", "", "", "", "", PETSC_TRUE};
    PetscCall(PgKnownAdd(&option));
  }
  if (probe) PetscCall(PgCollectHelp(probe, context));
  if (all_options) PetscCall(PgCollectAll(comm, all_options));
  PetscFunctionReturn(0);
}

static const char *Dash(const char name[]) { return name[0] == '-' ? "" : "-"; }

/* "-fluid" of "-fluid darcy or -fluid ns": the option that decides. */
static void Decisive(const char needs[], char name[128])
{
  (void)snprintf(name, 128, "%.*s", (int)PetscMin(strcspn(needs, " "), 127), needs);
}

/* An option of another kind of run, by the choice of `needs`. */
static PetscErrorCode NotThisRun(MPI_Comm comm, const char name[], const char value[], const char needs[],
                                 PetscInt *refused)
{
  char        option[256], by[128];
  const char *choice = NULL;
  PetscBool   given, fine = PETSC_FALSE;

  PetscFunctionBeginUser;
  (void)snprintf(option, sizeof option, "-%s", name);
  Decisive(needs[0] ? needs : "-case", by); /* the case, when it is one that reads all its options itself */
  PetscCall(PetscOptionsFindPair(NULL, NULL, by, &choice, &given));
  if (given) PetscCall(PgIdleBecause(option, value, by, choice, &fine));
  if (fine) PetscFunctionReturn(0);
  if (needs[0])
    PetscCall(PgReport(comm, "option %s%s%s is not read in this run, it needs %s", option, value[0] ? " " : "", value,
                       needs));
  else
    PetscCall(PgReport(comm, "option %s%s%s is of no use to this case", option, value[0] ? " " : "", value));
  (*refused)++;
  PetscFunctionReturn(0);
}

/* An option of a solver whose type was changed by a later file or the command line: what the first solver wanted has no
   effect on the second. `pattern` is the known option "-pressure_*" and its like. */
static PetscErrorCode OfFormerSolver(const PgKnownOption *pattern, const char name[], const char value[],
                                     PetscBool *fine)
{
  static const char *const type[] = {"pc_type", "ksp_type", "pc_hypre_type"};
  const char              *bare   = pattern->name + (pattern->name[0] == '-');
  char                     option[256], by[256];

  PetscFunctionBeginUser;
  (void)snprintf(option, sizeof option, "-%s", name);
  for (size_t k = 0; k < sizeof type / sizeof *type && !*fine; k++) {
    const char *choice = NULL;
    PetscBool   given;
    (void)snprintf(by, sizeof by, "-%.*s%s", (int)(strlen(bare) - 1), bare, type[k]);
    PetscCall(PetscOptionsFindPair(NULL, NULL, by, &choice, &given));
    if (given) PetscCall(PgIdleBecause(option, value, by, choice, fine));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Refuse(MPI_Comm comm, const char name[], const char given[], PetscInt *refused)
{
  const PgKnownOption *exact = PgKnownFind(name), *pattern = PgKnownPattern(name), *nearest;
  const char          *value = given ? given : "", *gap = given ? " " : "";

  PetscFunctionBeginUser;
  if (name[0] == '-' || strchr(name, '=')) { /* as programs of GNU have them */
    (*refused)++;
    if (name[0] == '-')
      PetscCall(PgReport(comm, "unknown option -%s%s%s; options begin with one '-', as in %s", name, gap, value, name));
    else
      PetscCall(PgReport(comm, "unknown option -%s%s%s; a blank, not '=', stands between an option and its value", name,
                         gap, value));
    PetscFunctionReturn(0);
  }
  if (pattern && pattern->active && strchr(pattern->name, '*')) {
    PetscBool fine = PETSC_FALSE;
    PetscCall(OfFormerSolver(pattern, name, value, &fine));
    if (fine) PetscFunctionReturn(0);
  }
  if (!exact && pattern && !pattern->active) exact = pattern; /* no run so far has made what would read it */
  if (exact && !exact->active && (exact->needs[0] || exact != pattern)) {
    PetscCall(NotThisRun(comm, name, value, exact->needs, refused));
    PetscFunctionReturn(0);
  }
  (*refused)++;
  nearest = PgKnownNearest(name);
  if (exact && exact->active) /* no other name is nearer */
    PetscCall(PgReport(comm, "option -%s%s%s is not read by the solver of this run", name, gap, value));
  else if (!nearest && pattern)
    PetscCall(PgReport(comm, "unknown option -%s%s%s: misspelt, or of a solver that this run does not use", name, gap,
                       value));
  else if (!nearest)
    PetscCall(PgReport(comm, "unknown option -%s%s%s; -help all lists all options", name, gap, value));
  else if (!nearest->active && nearest->needs[0])
    PetscCall(PgReport(comm, "unknown option -%s%s%s; did you mean %s%s (which needs %s)?", name, gap, value,
                       Dash(nearest->name), nearest->name, nearest->needs));
  else
    PetscCall(PgReport(comm, "unknown option -%s%s%s; did you mean %s%s?", name, gap, value, Dash(nearest->name),
                       nearest->name));
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckUnread(MPI_Comm comm, PetscInt spoken, char *const said[], PetscErrorCode (*probe)(void *),
                                  void *context, PetscInt *refused)
{
  PetscInt  count;
  PetscBool learnt = PETSC_FALSE;
  char    **name, **value;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsLeftGet(NULL, &count, &name, &value));
  for (PetscInt i = 0; i < count; i++) {
    PetscBool known = BelongsToPetsc(name[i]);
    for (PetscInt k = 0; k < spoken; k++) known = (PetscBool)(known || !strcasecmp(said[k] + 1, name[i]));
    if (known) continue;
    if (!learnt) PetscCall(LearnNames(comm, probe, context));
    learnt = PETSC_TRUE;
    PetscCall(Refuse(comm, name[i], value[i], refused));
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &count, &name, &value));
  PetscFunctionReturn(0);
}

PetscErrorCode PgOptionsCheck(MPI_Comm comm, const PgOptionRules *rules, PetscErrorCode (*probe)(void *), void *context)
{
  PetscInt spoken = 0, refused = 0;
  char   **said = NULL;

  PetscFunctionBeginUser;
  PetscCall(PgSourcesBegin());
  if (rules) PetscCall(PgEffectCheck(comm, rules, &refused, &said, &spoken));
  PetscCall(CheckUnread(comm, spoken, said, probe, context, &refused));
  for (PetscInt k = 0; k < spoken; k++) PetscCall(PetscFree(said[k]));
  PetscCall(PetscFree(said));
  PetscCall(PgSourcesEnd());
  PetscCall(PgIdleReport(comm, (PetscBool)!refused));
  PetscFunctionReturn(refused ? PETSC_ERR_USER_INPUT : 0);
}

PetscErrorCode PgOptionsCheckUnused(MPI_Comm comm, PetscErrorCode (*probe)(void *), void *context)
{
  PetscFunctionBeginUser;
  PetscCall(PgOptionsCheck(comm, NULL, probe, context));
  PetscFunctionReturn(0);
}

PetscErrorCode PgOptionsCheckAlone(MPI_Comm comm, const char name[])
{
  PetscInt count;
  char   **other, **value, list[1024] = "";

  PetscFunctionBeginUser;
  PetscCall(PgSourcesBegin());
  PetscCall(PetscOptionsLeftGet(NULL, &count, &other, &value));
  for (PetscInt i = 0; i < count; i++) {
    const size_t used = strlen(list);
    char         option[256];
    int          layer;
    (void)snprintf(option, sizeof option, "-%s", other[i]);
    PetscCall(PgSourceOf(option, &layer, NULL));
    if (layer != PG_LAYER_COMMAND_LINE || BelongsToPetsc(other[i])) continue;
    (void)snprintf(list + used, sizeof list - used, "%s%s%s%s", used ? ", " : "", option, value[i] ? " " : "",
                   value[i] ? value[i] : "");
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &count, &other, &value));
  PetscCall(PgSourcesEnd());
  PgInputCheck(!list[0], comm, "option %s does its work alone and has no use for %s", name, list);
  PetscFunctionReturn(0);
}
