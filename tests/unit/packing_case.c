/* ranks: 1 2 4 timeout: 120 */
/* The case "packing": what chance makes is the same on any number of ranks and keeps its promises; what is read from a
   file becomes the same problem that it was written from; what cannot be is refused. Judged by pairs tried one by one,
   on all discs gathered in the order of their ids. */
#include "io_testing.h"
#include <porograin/simulation.h>

enum { MOST = 700 };
typedef struct {
  PetscInt  discs;
  PetscReal x[2 * MOST], v[2 * MOST], r[MOST], plate[MOST], side[MOST], porosity[MOST], mass[MOST];
  PetscBool periodic;
  PetscReal low, high; /* of x */
  PetscInt  walls, plates;
  PgWall    wall[4];
  PgPlate   plate_info[2];
} Made;

static PgSimulation Start(MPI_Comm comm, const char options[], PetscErrorCode *err)
{
  PgSimulation simulation;

  ok(PetscOptionsClear(NULL));
  ok(PetscOptionsInsertString(NULL, options));
  ok(PgSimulationCreate(comm, &simulation));
  *err = PgSimulationSetFromOptions(simulation);
  if (!*err) {
    *err = PgSimulationSetUp(simulation);
    if (*err) ok(PgStagePop()); /* an error leaves the stage as it is */
  }
  return simulation;
}

static void GatherField(PgParticles particles, PgField field, PetscReal all[])
{
  const PgFieldInfo *info;
  PetscReal         *array;
  PetscInt           start, count, global;

  ok(PgParticlesGetFieldInfo(particles, field, &info));
  ok(PgParticlesGetArray(particles, field, &array));
  ok(PgParticlesGetIdRange(particles, &start, &count));
  ok(PgParticlesGetSizes(particles, NULL, NULL, &global));
  ok(PetscArrayzero(all, global * info->components));
  ok(PgParticlesToIdOrder(particles, info->components, array, all + start * info->components));
  /* one rank holds the value, the others 0: the sum is exact */
  ok(MPI_Allreduce(MPI_IN_PLACE, all, (int)(global * info->components), MPIU_REAL, MPI_SUM,
                   PgParticlesComm(particles)));
}

static void Make(MPI_Comm comm, const char options[], Made *made)
{
  PetscErrorCode err;
  PgSimulation   simulation = Start(comm, options, &err);
  PgParticles    particles;
  PgPore         pore;
  PgDem          dem;
  PgField        field;

  ok(err);
  (void)memset(made, 0, sizeof *made);
  ok(PgSimulationGetParts(simulation, &particles, NULL, &dem, &pore));
  ok(PgParticlesGetSizes(particles, NULL, NULL, &made->discs));
  assert_in_range(made->discs, 1, MOST);
  ok(PgParticlesGetPeriodicX(particles, &made->periodic, &made->low, &made->high));
  GatherField(particles, PG_POSITION, made->x);
  GatherField(particles, PG_VELOCITY, made->v);
  GatherField(particles, PG_RADIUS, made->r);
  GatherField(particles, PG_MASS, made->mass);
  ok(PgParticlesFindField(particles, "plate", &field));
  GatherField(particles, field, made->plate);
  if (pore) {
    ok(PgParticlesFindField(particles, "side", &field));
    GatherField(particles, field, made->side);
    ok(PgParticlesFindField(particles, "initial_porosity", &field));
    GatherField(particles, field, made->porosity);
  }
  ok(PgDemGetWallCount(dem, &made->walls));
  for (PetscInt k = 0; k < made->walls; k++) ok(PgDemGetWall(dem, k, &made->wall[k]));
  ok(PgDemGetPlateCount(dem, &made->plates));
  for (PetscInt k = 0; k < made->plates; k++) ok(PgDemGetPlate(dem, k, &made->plate_info[k]));
  ok(PgSimulationDestroy(&simulation));
}

/* The options must be refused with this in the message. */
static void CheckRefusedOptions(const char options[], const char part[])
{
  char           text[4096];
  PetscErrorCode err;
  PgSimulation   simulation;

  CatchErrors();
  simulation = Start(PETSC_COMM_WORLD, options, &err);
  CaughtErrors(text);
  assert_int_equal(err, PETSC_ERR_USER_INPUT);
  CheckMessage(text, "porograin: error: ", part);
  ok(PgSimulationDestroy(&simulation));
}

/* Largest overlap over the smaller radius, all pairs, images in x included. */
static PetscReal LargestOverlap(const Made *m)
{
  PetscReal worst = -PETSC_MAX_REAL;

  for (PetscInt a = 0; a < m->discs; a++) {
    for (PetscInt b = a + 1; b < m->discs; b++) {
      PetscReal       dx = fabs(m->x[2 * b] - m->x[2 * a]);
      const PetscReal dy = m->x[2 * b + 1] - m->x[2 * a + 1];
      if (m->periodic) dx = PetscMin(dx, m->high - m->low - dx);
      worst = PetscMax(worst, (m->r[a] + m->r[b] - hypot(dx, dy)) / PetscMin(m->r[a], m->r[b]));
    }
  }
  return worst;
}

static PetscReal SolidArea(const Made *m)
{
  PetscReal area = 0;

  for (PetscInt i = 0; i < m->discs; i++) area += PETSC_PI * m->r[i] * m->r[i];
  return area;
}

/* ---- by chance ---- */

#define RUN " -end_time 1e-6 -dt 1e-8 "
static Made world, alone;

/* On all ranks together and on each rank alone: the same bits. */
static void CheckAlike(const char options[])
{
  Make(PETSC_COMM_WORLD, options, &world);
  Make(PETSC_COMM_SELF, options, &alone);
  assert_int_equal(world.discs, alone.discs);
  assert_memory_equal(world.x, alone.x, 2 * (size_t)world.discs * sizeof(PetscReal));
  assert_memory_equal(world.r, alone.r, (size_t)world.discs * sizeof(PetscReal));
}

/* So few discs that many pairs lie between ranks, pressed until they jam: the message tells the largest overlap. */
static void few_discs_on_many_ranks(void **state)
{
  (void)state;
  for (int seed = 0; seed < 10; seed++) {
    char           options[256], together[4096], by_itself[4096];
    PetscErrorCode err = 0;
    PgSimulation   simulation;

    (void)snprintf(options, sizeof options,
                   "-case packing -packing_generate random -packing_count 12 -packing_target_porosity 0.2"
                   " -packing_seed %d" RUN,
                   seed);
    CatchErrors();
    simulation = Start(PETSC_COMM_WORLD, options, &err);
    CaughtErrors(together);
    assert_int_equal(err, PETSC_ERR_USER_INPUT);
    ok(PgSimulationDestroy(&simulation));
    CatchErrors();
    if (!test_rank) {
      simulation = Start(PETSC_COMM_SELF, options, &err);
      ok(PgSimulationDestroy(&simulation));
    }
    CaughtErrors(by_itself);
    assert_int_equal(err, PETSC_ERR_USER_INPUT);
    assert_non_null(strstr(together, "they overlap by up to 0."));
    assert_string_equal(together, by_itself);
  }
}

/* ... and dense as asked, without overlaps, in the box. */
static void chance_is_the_same_on_any_number_of_ranks(void **state)
{
  static const struct {
    const char *options;
    PetscReal   n, width, height, r_least, r_most;
  } plan[] = {
      {"-packing_count 300 -packing_target_porosity 0.2 -packing_radius 0.01 -packing_radius_spread 0.3 -packing_seed "
       "7",
       0.2, 0, 0, 0.007, 0.013},
      {"-packing_size 0.4,0.3 -packing_target_porosity 0.22 -packing_radius 0.01 -packing_second_radius 0.006 "
       "-packing_second_share 0.6 -packing_periodic",
       0.22, 0.4, 0.3, 0.0058, 0.0103},
      {"-packing_count 200 -packing_target_porosity 0.19 -packing_aspect 2.5", 0.19, 0, 0, 5e-3, 5e-3},
  };

  (void)state;
  for (size_t k = 0; k < sizeof plan / sizeof *plan; k++) {
    char      options[512];
    PetscReal right = 0, top = 0, box;

    (void)snprintf(options, sizeof options, "-case packing -packing_generate random %s" RUN, plan[k].options);
    CheckAlike(options);
    /* -packing_relax_overlap, default 1e-6, and rounding of the distance */
    assert_true(LargestOverlap(&world) <= 1e-6 + 1e-12);
    for (PetscInt i = 0; i < world.discs; i++) {
      const PetscReal *x = &world.x[2 * i], r = world.r[i];
      assert_true(r >= plan[k].r_least && r <= plan[k].r_most);
      assert_true(world.v[2 * i] == 0 && world.v[2 * i + 1] == 0);
      /* the walls of the press are as soft as the discs: what overlaps a wall overlaps a disc about as much */
      assert_true(world.periodic || x[0] > r * (1 - 1e-4));
      assert_true(x[1] > r * (1 - 1e-4));
      right = PetscMax(right, x[0] + (world.periodic ? 0 : r));
      top   = PetscMax(top, x[1] + r);
    }
    /* the discs reach as far as the box: the porosity of the box is that of the discs' own bounds but for the gaps at
       the walls, less than half a radius of the smallest box on two sides */
    box = plan[k].width > 0 ? plan[k].width * plan[k].height : SolidArea(&world) / (1 - plan[k].n);
    assert_true(fabs(1 - SolidArea(&world) / box - plan[k].n) < 1e-12);
    if (plan[k].width > 0) {
      assert_true(right <= 0.4 && top <= 0.3 * (1 + 1e-4) && right > 0.39 && top > 0.29);
    } else {
      const PetscReal w = sqrt(box / (k == 2 ? 2.5 : 1)), h = box / w;
      assert_true(right <= w * (1 + 1e-4) && right > 0.97 * w);
      assert_true(top <= h * (1 + 1e-4) && top > 0.97 * h);
    }
  }
}

/* The first output of splitmix64 for seed 1234567 is 6457827717110365317 (values that go with its publication). */
static void numbers_are_those_of_splitmix64(void **state)
{
  const PetscReal u = (PetscReal)(UINT64_C(6457827717110365317) >> 11) / 9007199254740992.0;

  (void)state;
  Make(PETSC_COMM_WORLD,
       "-case packing -packing_generate random -packing_count 30 -packing_target_porosity 0.5 -packing_radius 0.02 "
       "-packing_radius_spread 0.25 -packing_seed 1234567" RUN,
       &world);
  assert_true(fabs(world.r[0] - 0.02 * (1 + 0.25 * (2 * u - 1))) < 1e-16); /* a rounding of 0.02 */
  Make(PETSC_COMM_WORLD,
       "-case packing -packing_generate random -packing_count 30 -packing_target_porosity 0.5 -packing_radius 0.02 "
       "-packing_radius_spread 0.25 -packing_seed 1234568" RUN,
       &alone);
  for (PetscInt i = 0; i < 30; i++) assert_true(world.r[i] != alone.r[i] && world.x[2 * i] != alone.x[2 * i]);
}

static void what_jams_is_refused(void **state)
{
  (void)state;
  CheckRefusedOptions("-case packing -packing_generate random -packing_count 150 -packing_target_porosity 0.13"
                      " -packing_radius_spread 0.2" RUN,
                      "option -packing_target_porosity 0.13: the discs jam before");
  CheckRefusedOptions("-case packing -packing_generate random -packing_count 150 -packing_target_porosity 0.18"
                      " -packing_relax_steps 100 -packing_relax_overlap 1e-9" RUN,
                      "after -packing_relax_steps 100 there are still overlaps");
}

/* ---- on lattices ---- */

static void CheckLattice(const char options[], PetscInt discs, PetscReal width, PetscReal height, PetscInt contacts)
{
  PetscReal right = 0, top = 0;
  PetscInt  touching = 0;

  Make(PETSC_COMM_WORLD, options, &world);
  assert_int_equal(world.discs, discs);
  for (PetscInt i = 0; i < discs; i++) {
    assert_true(world.r[i] == 0.02);
    right = PetscMax(right, world.x[2 * i]);
    top   = PetscMax(top, world.x[2 * i + 1]);
    for (PetscInt j = 0; j < i; j++) {
      PetscReal dx = fabs(world.x[2 * i] - world.x[2 * j]);
      if (world.periodic) dx = PetscMin(dx, world.high - world.low - dx);
      touching += fabs(hypot(dx, world.x[2 * i + 1] - world.x[2 * j + 1]) - 0.04) < 1e-12;
    }
  }
  assert_int_equal(touching, contacts);
  assert_true(LargestOverlap(&world) < 1e-12); /* rounding of coordinates over the radius */
  assert_true(fabs(right - width) < 1e-12 && fabs(top - height) < 1e-12);
}

static void lattices_are_regular(void **state)
{
  const PetscReal rise = 0.02 * sqrt(3.0);

  (void)state;
  /* rows of 5, 4, 5, 4; in rows 4 + 3 + 4 + 3, between rows 8 each */
  CheckLattice("-case packing -packing_generate hexagonal -packing_radius 0.02 -packing_size 0.2,0.15" RUN, 18, 0.18,
               0.02 + 3 * rise, 14 + 24);
  /* four rows of 5, closed in x, so that a disc at 0.2 is at 0: 5 in each row, 10 between rows */
  CheckLattice("-case packing -packing_generate hexagonal -packing_radius 0.02 -packing_size 0.2,0.15 -packing_periodic"
               " -fluid none" RUN,
               20, 0.18, 0.02 + 3 * rise, 20 + 30);
  /* 4 x 3 */
  CheckLattice("-case packing -packing_generate square -packing_radius 0.02 -packing_size 0.161,0.12" RUN, 12, 0.14,
               0.1, 9 + 8);
  /* a count that fills three rows of 3 and a third of the next */
  CheckLattice("-case packing -packing_generate square -packing_radius 0.02 -packing_count 10" RUN, 10, 0.1, 0.14,
               6 + 7);
}

/* ---- from a file ---- */

static void Write(const char text[])
{
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  if (!test_rank) {
    FILE *stream = fopen(FileName("discs", ".csv"), "w");
    assert_non_null(stream);
    (void)fputs(text, stream);
    (void)fclose(stream);
  }
  (void)MPI_Barrier(PETSC_COMM_WORLD);
}

static const char *FromFile(const char more[])
{
  static char options[1024];

  (void)snprintf(options, sizeof options, "-case packing -packing %s " RUN " %s", FileName("discs", ".csv"), more);
  return options;
}

/* Written by the panel and read back: discs, plates and sides are those of the panel. */
static void a_panel_comes_back(void **state)
{
  char options[512];

  (void)state;
  (void)snprintf(options, sizeof options,
                 "-case panel -panel_columns 6 -panel_rows 13 -panel_velocity 0.05 -fluid darcy -packing_export %s",
                 FileName("discs", ".csv"));
  Make(PETSC_COMM_WORLD, options, &alone);
  Make(PETSC_COMM_WORLD,
       FromFile("-packing_plates bottom,top -packing_top_velocity -0.05 -fluid darcy -packing_porosity 0.0931"),
       &world);
  assert_int_equal(world.discs, alone.discs);
  assert_memory_equal(world.x, alone.x, sizeof world.x);
  assert_memory_equal(world.v, alone.v, sizeof world.v);
  assert_memory_equal(world.r, alone.r, sizeof world.r);
  assert_memory_equal(world.mass, alone.mass, sizeof world.mass);
  assert_memory_equal(world.plate, alone.plate, sizeof world.plate);
  assert_memory_equal(world.side, alone.side, sizeof world.side);
  assert_int_equal(world.plates, 2);
  for (int k = 0; k < 2; k++) {
    assert_true(world.plate_info[k].side == alone.plate_info[k].side);
    assert_true(world.plate_info[k].velocity == alone.plate_info[k].velocity);
  }
  for (PetscInt i = 0; i < world.discs; i++) assert_true(world.porosity[i] == 0.0931);
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  if (!test_rank) (void)unlink(FileName("discs", ".csv"));
}

/* A small heap whose sides can be counted by hand; mean radius 0.1. */
static const char heap[] = "x,y,r,vx,vy\n0.1,0.1,0.1,3,4\n0.31,0.1,0.1,0,0\n0.54,0.12,0.12,0,1\n"
                           "0.2,0.3,0.08,0,0\n0.41,0.3,0.1,0,-2\n";

static void walls_sides_and_box(void **state)
{
  /* bits: left 1, right 2, bottom 4, top 8; within 1.25 mean radii of a side of the box 0..0.66 x 0..0.4 */
  static const int sides[] = {1 | 4, 4, 2 | 4, 1 | 8, 8};
  PetscReal        n;

  (void)state;
  Write(heap);
  Make(PETSC_COMM_WORLD,
       FromFile("-packing_walls left,right,bottom,top -packing_top_velocity -0.3 -fluid ns -packing_box 0,0.66,0,0.4"),
       &world);
  assert_int_equal(world.walls, 4);
  for (int s = 0; s < 4; s++) {
    const PgWall *w = &world.wall[s];
    assert_true(w->normal[s / 2] == (s % 2 ? -1 : 1) && w->normal[1 - s / 2] == 0);
    assert_true(w->point[s / 2] == (s == 1 ? 0.66 : s == 3 ? 0.4 : 0));
    assert_int_equal(w->kind, s == 3 ? PG_WALL_MOVING : PG_WALL_FIXED);
    assert_true(w->velocity[1] == (s == 3 ? -0.3 : 0) && w->velocity[0] == 0);
  }
  n = 1 - PETSC_PI * (3 * 0.1 * 0.1 + 0.12 * 0.12 + 0.08 * 0.08) / (0.66 * 0.4);
  for (int i = 0; i < 5; i++) {
    assert_int_equal((int)world.side[i], sides[i]);
    assert_true(fabs(world.porosity[i] - n) < 1e-14);
    assert_true(world.plate[i] == 0);
  }
  assert_true(world.v[0] == 3 && world.v[1] == 4 && world.v[9] == -2);
  /* two discs of radius 1 at distance 1 have 2 pi/3 - sqrt(3)/2 in common */
  Write("1,1,1\n2,1,1\n");
  Make(PETSC_COMM_WORLD, FromFile("-packing_max_overlap 1 -fluid darcy"), &world);
  n = 1 - (2 * PETSC_PI - (2 * PETSC_PI / 3 - sqrt(3.0) / 2)) / 6;
  assert_true(fabs(world.porosity[0] - n) < 1e-14); /* a few roundings of numbers near 1 */
  Write(heap);
  /* the bottom row on a plate, of one that is nearer than 0.25 mean radii */
  Make(PETSC_COMM_WORLD, FromFile("-packing_plates bottom -packing_plate_distance 0.25 -packing_walls top"), &world);
  assert_int_equal(world.walls, 1);
  assert_int_equal(world.plates, 1);
  assert_true(world.wall[0].point[1] == 0.4 && world.wall[0].kind == PG_WALL_FIXED);
  for (int i = 0; i < 5; i++) assert_true(world.plate[i] == (i < 3));
  assert_true(world.v[1] == 0 && world.v[0] == 3 && world.v[5] == 0);
}

static void what_cannot_be_is_refused(void **state)
{
  (void)state;
  Write(heap);
  CheckRefusedOptions("-case packing" RUN, "case packing needs its discs");
  CheckRefusedOptions(FromFile("-packing_generate square"), "contradict each other: give one");
  CheckRefusedOptions(FromFile("-packing_export run.csv -output run.h5"), "packing 'run.csv': -output run.h5 writes");
  {
    char output[256];
    (void)snprintf(output, sizeof output, "-output %s", FileName("discs", ".h5"));
    CheckRefusedOptions(FromFile(output), "choose another name for one of them");
  }
  CheckRefusedOptions(FromFile("-packing_seed 3"), "options -packing and -packing_seed contradict each other");
  CheckRefusedOptions(FromFile("-packing_radius 3"), "options -packing and -packing_radius contradict each other");
  CheckRefusedOptions("-case packing -packing_generate square -packing_count 9 -packing_seed 3" RUN,
                      "option -packing_seed belongs to -packing_generate random");
  CheckRefusedOptions("-case packing -packing_generate square -packing_count 9 -packing_size 1,1" RUN,
                      "needs one of -packing_count N and -packing_size WX,WY");
  CheckRefusedOptions("-case packing -packing_generate square -packing_size 1,-1" RUN,
                      "option -packing_size: 1 x -1 m is no size");
  CheckRefusedOptions("-case packing -packing_generate square -packing_size 0.001,1" RUN, "not one disc fits in");
  CheckRefusedOptions("-case packing -packing_generate random -packing_count 3" RUN, "too narrow for a random packing");
  CheckRefusedOptions("-case packing -packing_generate square -packing_count 9 -packing_box 0,1,0,1" RUN,
                      "option -packing_box belongs to -packing FILE");
  CheckRefusedOptions(FromFile("-packing_box 0,1,3,3"), "is no box");
  CheckRefusedOptions(FromFile("-packing_periodic"), "does not say the period of x: give -packing_box");
  CheckRefusedOptions(FromFile("-packing_walls left,top,right,upper"), "'upper' is not among left, right, bottom, top");
  CheckRefusedOptions(FromFile("-packing_plates left"), "'left' is not among bottom, top");
  CheckRefusedOptions(FromFile("-packing_plates top -packing_walls top"), "side top cannot be both");
  CheckRefusedOptions(FromFile("-packing_top_velocity -1"), "needs a plate or wall at the top");
  CheckRefusedOptions(
      "-case packing -packing_generate square -packing_count 40 -packing_periodic -packing_walls left" RUN,
      "there is no wall on the left or right where x is periodic");
  CheckRefusedOptions(FromFile("-packing_box 0,0.6,0,0.4"), "disc 2 (counted from 0) reaches out of the box by 0.5 of");
  CheckRefusedOptions("-case packing -packing_generate square -packing_count 9 -packing_export discs.dat" RUN,
                      "packing 'discs.dat': the name must end in .csv or .h5");
  Write("#! periodic_x 0 1\n0.5,0.5,0.1\n");
  CheckRefusedOptions(FromFile("-packing_walls left"), "no wall on the left or right where x is periodic, as '");
  /* the worst pair is named, by ids from 0 */
  Write("0,0,1\n5,5,1\n0.75,0,0.5\n5,3.5,0.75\n");
  CheckRefusedOptions(FromFile(""), "discs 0 and 2 (counted from 0) at (0, 0) and (0.75, 0) m overlap by 1.5 of");
  Write("0,0,1\n5,5,1\n5,5,0.5\n5,5,0.75\n");
  CheckRefusedOptions(FromFile("-packing_max_overlap 2"), "have the same centre (5, 5) m; 3 such pairs");
  Write("0,0,1\n5,5,0.00999\n");
  CheckRefusedOptions(FromFile(""), "more than 100 times the smallest");
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  if (!test_rank) (void)unlink(FileName("discs", ".csv"));
}

/* Thousands of discs in one place and one far away: refused, and soon. */
static void a_pile_is_refused(void **state)
{
  const PetscLogDouble start = MPI_Wtime();

  (void)state;
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  if (!test_rank) {
    FILE *stream = fopen(FileName("discs", ".csv"), "w");
    for (int k = 0; k < 60000; k++) (void)fprintf(stream, "%.17g,%.17g,0.1\n", 0.3 + 1e-9 * k, 0.3);
    (void)fputs("1e6,1e6,0.1\n", stream);
    (void)fclose(stream);
  }
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  CheckRefusedOptions(FromFile(""), "overlap by ");
  assert_true(MPI_Wtime() - start < 60); /* all pairs would take hours */
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  if (!test_rank) (void)unlink(FileName("discs", ".csv"));
}

int main(int argc, char *argv[])
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(chance_is_the_same_on_any_number_of_ranks),
      cmocka_unit_test(few_discs_on_many_ranks),
      cmocka_unit_test(numbers_are_those_of_splitmix64),
      cmocka_unit_test(what_jams_is_refused),
      cmocka_unit_test(lattices_are_regular),
      cmocka_unit_test(a_panel_comes_back),
      cmocka_unit_test(walls_sides_and_box),
      cmocka_unit_test(what_cannot_be_is_refused),
      cmocka_unit_test(a_pile_is_refused),
  };
  PetscErrorCode err;
  int            failed;

  (void)MakeDiscs; /* of the header, not used here */
  if (StartTests(&argc, &argv, &err)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(err) || failed;
}
