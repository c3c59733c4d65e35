/* ranks: 1 */
/* timeout: 300 */
/* Steady steps: while the pair lists stand, a step builds no list, makes no matrix pattern and allocates nothing.
   Allocations are counted in two ways: those through PETSc's PetscMalloc(), whose caller is known by file and line, and
   all others by taking the place of malloc() and its kin (glibc only, and not with sanitizers, which do the same). */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include <porograin/simulation.h>
#include <errno.h>
#include <execinfo.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if defined(__has_feature)
  #if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
    #define SANITIZED
  #endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  #define SANITIZED
#endif

#define OK(call) assert_int_equal((int)(call), 0)

/* ---- counting ---- */

typedef enum { OURS, PETSCS, OTHERS, SOURCES } Source;

static int      counting; /* 1 within the steps that are watched */
static int      within;   /* within one of the counting functions: not counted twice */
static PetscInt counts[SOURCES];
static char     where[SOURCES][64][160]; /* the first places of each, for the message of a failed test */
static PetscInt places[SOURCES];

static void Note(Source source, const char place[])
{
  counts[source]++;
  for (PetscInt k = 0; k < places[source]; k++)
    if (!strncmp(where[source][k], place, sizeof where[source][k] - 1)) return;
  if (places[source] < 64) (void)snprintf(where[source][places[source]++], sizeof where[source][0], "%s", place);
}

/* Ours when the source lies in the src folder beside this test. */
static PetscBool IsOurs(const char file[])
{
  const char *const here = __FILE__, *tests = strstr(here, "tests/unit/");
  const size_t      root = tests ? (size_t)(tests - here) : 0;

  return (PetscBool)(!strncmp(file, here, root) && !strncmp(file + root, "src/", 4));
}

static void NotePetsc(int line, const char function[], const char file[])
{
  char place[160];

  if (!counting || within) return;
  within = 1;
  (void)snprintf(place, sizeof place, "%s(), %s:%d", function, file, line);
  Note(IsOurs(file) ? OURS : PETSCS, place);
  within = 0;
}

static PetscErrorCode CountingMalloc(size_t bytes, PetscBool clear, int line, const char function[], const char file[],
                                     void **result)
{
  int outer;

  *result = NULL;
  if (!bytes) return 0;
  NotePetsc(line, function, file);
  outer   = within;
  within  = 1;
  *result = clear ? calloc(1, bytes) : malloc(bytes);
  within  = outer;
  return *result ? 0 : PETSC_ERR_MEM;
}

static PetscErrorCode CountingFree(void *address, int line, const char function[], const char file[])
{
  (void)line;
  (void)function;
  (void)file;
  free(address);
  return 0;
}

static PetscErrorCode CountingRealloc(size_t bytes, int line, const char function[], const char file[], void **result)
{
  int outer;

  NotePetsc(line, function, file);
  outer   = within;
  within  = 1;
  *result = realloc(*result, bytes);
  within  = outer;
  return *result || !bytes ? 0 : PETSC_ERR_MEM;
}

#if defined(__GLIBC__) && !defined(SANITIZED)
void *__libc_malloc(size_t);
void *__libc_calloc(size_t, size_t);
void *__libc_realloc(void *, size_t);
void *__libc_memalign(size_t, size_t);
void *malloc(size_t bytes);
void *calloc(size_t count, size_t bytes);
void *realloc(void *old, size_t bytes);
void *aligned_alloc(size_t alignment, size_t bytes);
int   posix_memalign(void **result, size_t alignment, size_t bytes);

/* The libraries on the call stack, innermost first, without this program and repetitions. */
static void NoteStack(void)
{
  void  *stack[24];
  char **symbol, place[160] = "";
  int    depth;

  if (!counting || within) return;
  within = 1;
  depth  = backtrace(stack, 24);
  symbol = backtrace_symbols(stack, depth);
  for (int k = 0; symbol && k < depth; k++) {
    char *slash = strrchr(symbol[k], '/'), *name = slash ? slash + 1 : symbol[k], *end = strpbrk(name, "(");
    if (end) *end = 0;
    if (strncmp(name, "lib", 3) || strstr(place, name) || strlen(place) + strlen(name) + 4 > sizeof place) continue;
    (void)strcat(place, place[0] ? " < " : "");
    (void)strcat(place, name);
  }
  free(symbol);
  Note(OTHERS, place);
  within = 0;
}

void *malloc(size_t bytes)
{
  NoteStack();
  return __libc_malloc(bytes);
}
void *calloc(size_t count, size_t bytes)
{
  NoteStack();
  return __libc_calloc(count, bytes);
}
void *realloc(void *old, size_t bytes)
{
  NoteStack();
  return __libc_realloc(old, bytes);
}
void *aligned_alloc(size_t alignment, size_t bytes)
{
  NoteStack();
  return __libc_memalign(alignment, bytes);
}
int posix_memalign(void **result, size_t alignment, size_t bytes)
{
  NoteStack();
  *result = __libc_memalign(alignment, bytes);
  return *result ? 0 : ENOMEM;
}
static const PetscBool counts_all = PETSC_TRUE;
#else
static const PetscBool counts_all = PETSC_FALSE;
#endif

static void Forget(void)
{
  for (int s = 0; s < SOURCES; s++) counts[s] = places[s] = 0;
}

static void Print(const char reading[])
{
  static const char *const names[SOURCES] = {"porograin", "PETSc", "others"};

  print_message("%s: allocations of", reading);
  for (int s = 0; s < SOURCES; s++) print_message(" %s %d", names[s], (int)counts[s]);
  print_message("\n");
  for (int s = 0; s < SOURCES; s++)
    for (PetscInt k = 0; k < places[s]; k++) print_message("  %s: %s\n", names[s], where[s][k]);
}

/* ---- runs ---- */

typedef struct {
  const char *name, *options;
  PetscBool   implicit;
  PetscBool   hypre; /* it allocates in each solve, and nothing can be done about it */
} Reading;

/* Small steps: lists that were just built stand for more than a hundred of them. */
#define COMMON "-case panel -panel_columns 9 -dem_local_damping 0.7 -dt 1e-6 -end_time 1 "
#define PAPER  "-ns_continuity solenoidal -coupling drag -sph_operators paper "
#define DOCUMENTED                                                                                                     \
  "-ns_continuity averaged -coupling drag_and_pressure -sph_gradient corrected -sph_laplacian_eta 0.01 "               \
  "-bc_tracking surface "
static const Reading readings[] = {
    {"dry", COMMON "-fluid none", PETSC_FALSE, PETSC_FALSE},
    {"Navier-Stokes, paper, explicit", COMMON PAPER "-fluid ns -pressure explicit", PETSC_FALSE, PETSC_FALSE},
    {"Navier-Stokes, theta 0.7, smoothing, explicit",
     COMMON PAPER "-fluid ns -ns_theta 0.7 -ns_smoothing 0.02 -pressure explicit -pressure_sweeps 3", PETSC_FALSE,
     PETSC_FALSE},
    {"Darcy, kernel porosity, explicit", COMMON "-fluid darcy -coupling drag -porosity kernel -pressure explicit",
     PETSC_FALSE, PETSC_FALSE},
    {"Darcy, kinematic porosity, corrected Laplacian",
     COMMON "-fluid darcy -coupling drag_and_pressure -porosity kinematic -sph_operators corrected -fluid_every 3 "
            "-pressure_pc_type bjacobi",
     PETSC_TRUE, PETSC_FALSE},
    {"Navier-Stokes, documented, hypre", COMMON DOCUMENTED "-fluid ns", PETSC_TRUE, PETSC_TRUE},
    {"Navier-Stokes, documented, no side drained",
     COMMON DOCUMENTED
     "-fluid ns -bc_left impermeable -bc_right impermeable -bc_top impermeable -bc_bottom impermeable "
     "-pressure_pc_type bjacobi",
     PETSC_TRUE, PETSC_FALSE},
    {"Navier-Stokes, documented, gamg", COMMON DOCUMENTED "-fluid ns -pressure_pc_type gamg", PETSC_TRUE, PETSC_FALSE},
};

static PgSimulation Start(const char options[])
{
  PgSimulation simulation;

  OK(PetscOptionsClear(NULL));
  OK(PetscOptionsInsertString(NULL, options));
  OK(PgSimulationCreate(PETSC_COMM_WORLD, &simulation));
  OK(PgSimulationSetFromOptions(simulation));
  OK(PgSimulationSetUp(simulation));
  return simulation;
}

static void Revisions(PgSimulation simulation, PetscInt *lists, PetscInt *patterns, PetscInt *fills)
{
  PgNeighbors neighbors;
  PgPressure  pressure;
  PgPore      pore;

  *patterns = *fills = 0;
  OK(PgSimulationGetParts(simulation, NULL, &neighbors, NULL, &pore));
  OK(PgNeighborsGetRevision(neighbors, lists));
  if (!pore) return;
  OK(PgPoreGetParts(pore, NULL, &pressure));
  OK(PgPressureGetCounts(pressure, patterns, fills, NULL));
}

/* Nobody allocates, but for (1) hypre in its cycles, (2) messages between ranks: PetscSF compares its data types, which
   are derived ones, by their contents, and MPI makes requests and buffers, (3) PETSc in the solve of a singular system:
   KSPSolve() makes a copy of the right-hand side for whatever has a null space. We never do. */
static void CheckSources(const Reading *reading)
{
  PetscMPIInt size;

  OK(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  assert_int_equal(counts[OURS], 0);
  if (strstr(reading->options, "-bc_left impermeable")) return;
  for (PetscInt k = 0; k < places[PETSCS]; k++)
    assert_true(size > 1 && !strncmp(where[PETSCS][k], "MPIPetsc_Type_", strlen("MPIPetsc_Type_")));
  for (PetscInt k = 0; k < places[OTHERS]; k++)
    assert_true((reading->hypre && strstr(where[OTHERS][k], "libHYPRE")) ||
                (size > 1 && strstr(where[OTHERS][k], "libmpi")));
}

static void test_no_allocation(void **state)
{
  enum { WARM_UP = 30, STEPS = 50 };
  (void)state;

  for (size_t r = 0; r < sizeof readings / sizeof *readings; r++) {
    PgSimulation simulation = Start(readings[r].options);
    PetscInt     lists[2], patterns[2], fills[2];

    for (PetscInt step = 0; step < WARM_UP; step++) OK(PgSimulationStep(simulation));
    Revisions(simulation, &lists[0], &patterns[0], &fills[0]);
    Forget();
    for (PetscInt step = 0; step < STEPS; step++) {
      counting           = 1;
      PetscErrorCode err = PgSimulationStep(simulation);
      counting           = 0;
      OK(err);
    }
    Revisions(simulation, &lists[1], &patterns[1], &fills[1]);
    Print(readings[r].name);
    assert_int_equal(lists[1], lists[0]); /* or the test shows nothing */
    assert_int_equal(patterns[1], patterns[0]);
    assert_int_equal(fills[1] - fills[0], readings[r].implicit ? STEPS : 0);
    CheckSources(&readings[r]);
    OK(PgSimulationDestroy(&simulation));
  }
}

/* The counters count: a build in the middle of a watched stretch is seen by both. */
static void test_counters(void **state)
{
  PgSimulation   simulation = Start(readings[0].options);
  PetscErrorCode err;

  (void)state;
  Forget();
  counting = 1;
  err      = PgSimulationBuildLists(simulation);
  counting = 0;
  OK(err);
  assert_true(counts[OURS] > 0);
  Forget();
  counting = 1;
  free(malloc(17));
  counting = 0;
  if (counts_all) assert_int_equal(counts[OTHERS], 1);
  OK(PgSimulationDestroy(&simulation));
}

/* With a narrow skin lists are built every few steps: exactly then, and not more often, the pattern is made anew. */
static void test_patterns_follow_lists(void **state)
{
  PgSimulation simulation = Start(COMMON DOCUMENTED "-fluid ns -neighbors_skin 2e-4");
  PetscInt     lists, patterns, fills, new_lists, new_patterns, new_fills, built = 0, stood = 0;

  (void)state;
  Revisions(simulation, &lists, &patterns, &fills);
  for (PetscInt step = 0; step < 60; step++) {
    OK(PgSimulationStep(simulation));
    Revisions(simulation, &new_lists, &new_patterns, &new_fills);
    assert_int_equal(new_patterns - patterns, new_lists > lists ? 1 : 0);
    assert_int_equal(new_fills - fills, 1);
    built += new_lists > lists;
    stood += new_lists == lists;
    lists    = new_lists;
    patterns = new_patterns;
    fills    = new_fills;
  }
  assert_true(built > 5);
  assert_true(stood > 5);
  OK(PgSimulationDestroy(&simulation));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_no_allocation),
    cmocka_unit_test(test_counters),
    cmocka_unit_test(test_patterns_follow_lists),
};

int main(int argc, char *argv[])
{
  void *stack[4];
  int   failed;

  (void)backtrace(stack, 4); /* loads what it needs, with malloc(), the first time */
  /* before PETSc allocates anything */
  PetscCall(PetscMallocSet(CountingMalloc, CountingFree, CountingRealloc));
  PetscCall(PgInitialize(&argc, &argv, "test"));
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
