/* What the tests of sph and pore share: packings that depend on permanent ids only, so that they are the same on any
   communicator, and the objects of a world of discs with operators and water. Public headers only. */
#pragma once

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include <porograin/dem.h>
#include <porograin/pore.h>

#define CHECK(call) assert_int_equal((call), 0)

/* |a - b| <= tolerance; a NaN fails. */
#define NEAR(a, b, tolerance)                                                                                          \
  do {                                                                                                                 \
    const double a_ = (double)(a), b_ = (double)(b), t_ = (double)(tolerance);                                         \
    if (!(fabs(a_ - b_) <= t_))                                                                                        \
      fail_msg("%s = %.17g, expected %s = %.17g: off by %g, allowed %g", #a, a_, #b, b_, fabs(a_ - b_), t_);           \
  } while (0)

/* ---- packings ---- */

typedef struct {
  PetscReal x[2], v[2];   /* [m], [m/s] */
  PetscReal r, volume;    /* [m], [m2] */
  PetscReal porosity;     /* [1], initial */
  PetscInt  sides, plate; /* bits of the sides it forms; 1 + index of a plate */
} Disc;

/* A disc of the world, from its id. */
typedef void (*PlaceDisc)(const void *context, PetscInt id, Disc *disc);

/* Rows of columns - 1 and columns discs in turn, hexagonal, as in the panel. */
typedef struct {
  PetscInt  columns, rows;
  PetscReal radius; /* half the spacing of the lattice [m] */
  PetscReal jitter; /* largest displacement in each direction over the radius */
  PetscReal spread; /* radii from radius*(1 - spread) to radius */
} Packing;

/* A number in (-1, 1) that depends on id and salt only. */
static inline PetscReal Noise(PetscInt id, PetscInt salt)
{
  const double x = sin(12.9898 * (double)(id + 1) + 78.233 * (double)salt) * 43758.5453;
  return (PetscReal)(2.0 * (x - floor(x)) - 1.0);
}

static inline PetscInt PackingCount(const Packing *p)
{
  return (p->rows / 2) * (2 * p->columns - 1) + (p->rows % 2 ? p->columns - 1 : 0);
}

static inline void PackingRow(const Packing *p, PetscInt id, PetscInt *row, PetscInt *column, PetscInt *length)
{
  const PetscInt pair = id / (2 * p->columns - 1), rest = id % (2 * p->columns - 1);
  const PetscInt odd = rest >= p->columns - 1;

  *row    = 2 * pair + odd;
  *column = odd ? rest - (p->columns - 1) : rest;
  *length = odd ? p->columns : p->columns - 1;
}

/* A PlaceDisc. The area of a disc is its cell of the lattice, whatever its radius, and the porosity goes with it. */
static inline void PackingPlace(const void *context, PetscInt id, Disc *disc)
{
  const Packing  *p = (const Packing *)context;
  const PetscReal r = p->radius, cell = 2.0 * PetscSqrtReal(3.0) * r * r;
  PetscInt        row, column, length;

  PackingRow(p, id, &row, &column, &length);
  memset(disc, 0, sizeof *disc);
  disc->x[0]     = r * (2.0 * (PetscReal)column + (row % 2 ? 1.0 : 2.0) + p->jitter * Noise(id, 1));
  disc->x[1]     = r * (1.0 + PetscSqrtReal(3.0) * (PetscReal)row + p->jitter * Noise(id, 2));
  disc->r        = r * (1.0 - p->spread * 0.5 * (1.0 + Noise(id, 3)));
  disc->volume   = cell;
  disc->porosity = 1.0 - PETSC_PI * disc->r * disc->r / cell;
  disc->sides = (column == 0) << PG_SIDE_LEFT | (column == length - 1) << PG_SIDE_RIGHT | (row == 0) << PG_SIDE_BOTTOM |
                (row == p->rows - 1) << PG_SIDE_TOP;
}

/* Distance of the disc's lattice place from the frame of outermost lattice places that all rows share, over the radius:
   its kernel is full when this exceeds 5 (the support 2h) and the jitter. */
static inline PetscReal PackingDepth(const Packing *p, PetscInt id)
{
  PetscInt  row, column, length;
  PetscReal x, y;

  PackingRow(p, id, &row, &column, &length);
  x = 2.0 * (PetscReal)column + (row % 2 ? 1.0 : 2.0);
  y = PetscSqrtReal(3.0) * (PetscReal)row;
  return PetscMin(PetscMin(x - 2.0, 2.0 * (PetscReal)p->columns - 2.0 - x),
                  PetscMin(y, PetscSqrtReal(3.0) * (PetscReal)(p->rows - 1) - y));
}

/* The factor by which the operators of the paper are off on the lattice, by its three rings of 6 neighbours: sum over
   the rings of r w'(r)/2 for the gradient, and that times r^2/(r^2 + eta h^2) for the Laplacian. */
static inline PetscReal LatticeFactor(PetscReal eta)
{
  const PetscReal h = 1.25, ring[3] = {1.0, PetscSqrtReal(3.0), 2.0}, cell = PetscSqrtReal(3.0) / 2.0;
  PetscReal       sum = 0.0;
  const PgKernel *kernel;

  CHECK(PgKernelFind("cubic_spline", &kernel));
  for (int i = 0; i < 3; i++) {
    const PetscReal r = ring[i];
    sum -= 3.0 * cell * r * kernel->dw(r / h) / (h * h * h) * r * r / (r * r + eta * h * h);
  }
  return sum;
}

/* ---- the world ---- */

typedef enum { GROUND_SPH, GROUND_DARCY, GROUND_NS } GroundKind;

typedef struct {
  MPI_Comm    comm;
  PetscInt    count; /* discs of all ranks */
  PgParticles particles;
  PgNeighbors neighbors;
  PgDem       dem;  /* NULL for GROUND_SPH, */
  PgPore      pore; /* NULL, too */
  PgSph       sph;
  PgPressure  pressure; /* pore's own unless GROUND_SPH */
} Ground;

/* Options are text as on a command line; GroundDestroy() forgets them. */
static inline void GroundOptions(const char options[])
{
  CHECK(PetscOptionsClear(NULL));
  CHECK(PetscOptionsInsertString(NULL, options));
}

static inline void GroundCreate(MPI_Comm comm, GroundKind kind, const char options[], Ground *g)
{
  memset(g, 0, sizeof *g);
  g->comm = comm;
  GroundOptions(options);
  CHECK(PgParticlesCreate(comm, &g->particles));
  CHECK(PgParticlesSetFromOptions(g->particles));
  CHECK(PgNeighborsCreate(g->particles, &g->neighbors));
  CHECK(PgNeighborsSetFromOptions(g->neighbors));
  if (kind == GROUND_SPH) {
    CHECK(PgSphCreate(g->particles, g->neighbors, &g->sph));
    CHECK(PgSphSetFromOptions(g->sph));
    CHECK(PgPressureCreate(g->particles, g->neighbors, g->sph, &g->pressure));
    CHECK(PgPressureSetFromOptions(g->pressure));
    return;
  }
  CHECK(PgDemCreate(g->particles, g->neighbors, &g->dem));
  CHECK(PgPoreCreate(g->particles, g->neighbors, kind == GROUND_DARCY ? PG_FLUID_DARCY : PG_FLUID_NS, &g->pore));
  CHECK(PgPoreSetFromOptions(g->pore));
  CHECK(PgPoreGetParts(g->pore, &g->sph, &g->pressure));
}

static inline void GroundDestroy(Ground *g)
{
  if (g->pore) {
    CHECK(PgPoreDestroy(&g->pore));
    CHECK(PgDemDestroy(&g->dem));
  } else {
    CHECK(PgPressureDestroy(&g->pressure));
    CHECK(PgSphDestroy(&g->sph));
  }
  CHECK(PgNeighborsDestroy(&g->neighbors));
  CHECK(PgParticlesDestroy(&g->particles));
  CHECK(PetscOptionsClear(NULL));
}

static inline PetscInt GroundOwned(Ground *g)
{
  PetscInt owned;
  CHECK(PgParticlesGetSizes(g->particles, &owned, NULL, NULL));
  return owned;
}

static inline PetscInt GroundLocal(Ground *g)
{
  PetscInt owned, ghosts;
  CHECK(PgParticlesGetSizes(g->particles, &owned, &ghosts, NULL));
  return owned + ghosts;
}

static inline const PetscInt *GroundIds(Ground *g)
{
  const PetscInt *id;
  CHECK(PgParticlesGetIds(g->particles, &id));
  return id;
}

static inline PetscReal *GroundCore(Ground *g, PgField field)
{
  PetscReal *array;
  CHECK(PgParticlesGetArray(g->particles, field, &array));
  return array;
}

static inline PgField GroundField(Ground *g, const char name[])
{
  PgField field;
  CHECK(PgParticlesFindField(g->particles, name, &field));
  if (field < 0) fail_msg("no field '%s'", name);
  return field;
}

static inline PetscReal *GroundArray(Ground *g, const char name[]) { return GroundCore(g, GroundField(g, name)); }

/* Fills the world, discs dealt to the ranks in turn, and builds lists; with GROUND_SPH the operators too. */
static inline void GroundFill(Ground *g, PetscInt count, PlaceDisc place, const void *context)
{
  PetscMPIInt rank, size;
  PetscInt   *id, owned = 0;
  PetscReal  *x, *v, *r, *m, *volume, *side, *porosity, *plate;

  MPI_Comm_rank(g->comm, &rank);
  MPI_Comm_size(g->comm, &size);
  g->count = count;
  CHECK(PetscMalloc1(count + 1, &id));
  for (PetscInt k = rank; k < count; k += size) id[owned++] = k;
  CHECK(PgParticlesSetDiscs(g->particles, owned, id));
  x        = GroundCore(g, PG_POSITION);
  v        = GroundCore(g, PG_VELOCITY);
  r        = GroundCore(g, PG_RADIUS);
  m        = GroundCore(g, PG_MASS);
  volume   = GroundArray(g, "volume");
  side     = g->pore ? GroundArray(g, "side") : NULL;
  porosity = g->pore ? GroundArray(g, "initial_porosity") : NULL;
  plate    = g->pore ? GroundArray(g, "plate") : NULL;
  for (PetscInt i = 0; i < owned; i++) {
    Disc disc;
    place(context, id[i], &disc);
    for (int k = 0; k < 2; k++) {
      x[2 * i + k] = disc.x[k];
      v[2 * i + k] = disc.v[k];
    }
    r[i]      = disc.r;
    m[i]      = 2000.0 * PETSC_PI * disc.r * disc.r;
    volume[i] = disc.volume;
    if (!g->pore) continue;
    side[i]     = (PetscReal)disc.sides;
    porosity[i] = disc.porosity;
    plate[i]    = (PetscReal)disc.plate;
  }
  CHECK(PetscFree(id));
  CHECK(PgNeighborsBuild(g->neighbors));
  if (!g->pore) CHECK(PgSphUpdate(g->sph));
}

/* The values of owned discs by permanent id, complete on every rank; to be freed. */
static inline PetscReal *GroundGather(Ground *g, const PetscReal owned[], PetscInt components)
{
  const PetscInt *id = GroundIds(g), n = GroundOwned(g), c = components;
  PetscReal      *all;

  CHECK(PetscCalloc1(g->count * c + 1, &all));
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt k = 0; k < c; k++) all[id[i] * c + k] = owned[i * c + k];
  MPI_Allreduce(MPI_IN_PLACE, all, (int)(g->count * c), MPIU_REAL, MPI_SUM, g->comm);
  return all;
}

static inline PetscReal *GroundGatherField(Ground *g, const char name[], PetscInt components)
{
  return GroundGather(g, GroundArray(g, name), components);
}

/* Equal bit by bit, where a sum over ranks has not turned -0 into 0. */
static inline void AssertSame(const PetscReal a[], const PetscReal b[], PetscInt n, const char what[])
{
  for (PetscInt i = 0; i < n; i++)
    if (!(a[i] == b[i])) fail_msg("%s, entry %d: %.17g and %.17g differ", what, (int)i, (double)a[i], (double)b[i]);
}

/* Sum and largest over all ranks. */
static inline PetscReal GroundSum(Ground *g, PetscReal value)
{
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPIU_REAL, MPI_SUM, g->comm);
  return value;
}
static inline PetscReal GroundMax(Ground *g, PetscReal value)
{
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPIU_REAL, MPI_MAX, g->comm);
  return value;
}
static inline PetscInt GroundTotal(Ground *g, PetscInt value)
{
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPIU_INT, MPI_SUM, g->comm);
  return value;
}

/* Moves every disc to factor * x + (shift_x, shift_y), with new lists. */
static inline void GroundMove(Ground *g, PetscReal factor, PetscReal shift_x, PetscReal shift_y)
{
  const PetscInt owned = GroundOwned(g);
  PetscReal     *x     = GroundCore(g, PG_POSITION);

  for (PetscInt i = 0; i < owned; i++) {
    x[2 * i]     = factor * x[2 * i] + shift_x;
    x[2 * i + 1] = factor * x[2 * i + 1] + shift_y;
  }
  CHECK(PgNeighborsBuild(g->neighbors));
}

/* ---- failures ---- */

static int   ground_stderr = -1;
static FILE *ground_caught;

static inline void CatchErrors(void)
{
  (void)fflush(stderr);
  ground_stderr = dup(2);
  ground_caught = tmpfile();
  assert_non_null(ground_caught);
  assert_true(dup2(fileno(ground_caught), 2) == 2);
}

static inline void CaughtErrors(char *text, size_t size)
{
  size_t length;

  (void)fflush(stderr);
  (void)dup2(ground_stderr, 2);
  (void)close(ground_stderr);
  rewind(ground_caught);
  length       = fread(text, 1, size - 1, ground_caught);
  text[length] = '\0';
  (void)fclose(ground_caught);
}

/* All ranks of the world get `code`; rank 0 says each of the words, the others say nothing. */
#define FAILS(call, code, ...)                                                                                         \
  do {                                                                                                                 \
    const char *const words_[] = {__VA_ARGS__};                                                                        \
    char              text_[4096];                                                                                     \
    PetscMPIInt       rank_;                                                                                           \
    int               err_;                                                                                            \
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank_);                                                                           \
    CatchErrors();                                                                                                     \
    err_ = (int)(call);                                                                                                \
    CaughtErrors(text_, sizeof text_);                                                                                 \
    if (err_ != (int)(code)) fail_msg("error %d instead of %d; it said: %s", err_, (int)(code), text_);                \
    for (size_t i_ = 0; i_ < sizeof words_ / sizeof *words_; i_++)                                                     \
      if (rank_ == 0 && !strstr(text_, words_[i_])) fail_msg("'%s' is not in: %s", words_[i_], text_);                 \
    if (rank_ > 0 && strstr(text_, "error:")) fail_msg("rank %d wrote: %s", (int)rank_, text_);                        \
  } while (0)

/* main() of a test program. hypre divides by zero in places: no trap where it is used. */
#define GROUND_MAIN(tests, trap)                                                                                       \
  int main(int argc, char *argv[])                                                                                     \
  {                                                                                                                    \
    int failed;                                                                                                        \
    PetscCall(PgInitialize(&argc, &argv, "test"));                                                                     \
    if (trap) PetscCall(PetscSetFPTrap(PETSC_FP_TRAP_ON));                                                             \
    failed = cmocka_run_group_tests(tests, NULL, NULL);                                                                \
    return PgFinalize(0) || failed;                                                                                    \
  }
