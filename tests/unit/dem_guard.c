/* ranks: 1 2 3 */
/* What stops a run, and what is refused: error codes and messages. */
#include "dem_setup.h"
#include <unistd.h>

/* The text that rank 0 writes to standard error while `act` runs is held against `words`. */
static FILE *captured;
static int   saved;

static void Capture(void)
{
  fflush(stderr);
  captured = tmpfile();
  assert_non_null(captured);
  saved = dup(2);
  assert_true(dup2(fileno(captured), 2) == 2);
}

static void Expect(PetscInt count, const char *const words[])
{
  char        text[4096];
  size_t      length;
  PetscMPIInt rank;

  fflush(stderr);
  assert_true(dup2(saved, 2) == 2);
  close(saved);
  rewind(captured);
  length       = fread(text, 1, sizeof(text) - 1, captured);
  text[length] = 0;
  fclose(captured);
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank == 0)
    for (PetscInt k = 0; k < count; k++)
      if (!strstr(text, words[k])) fail_msg("'%s' is not in: %s", words[k], text);
  if (rank > 0) assert_null(strstr(text, "error:"));
}

#define EXPECT(...)                                                                                                    \
  do {                                                                                                                 \
    const char *const words[] = {__VA_ARGS__};                                                                         \
    Expect((PetscInt)(sizeof(words) / sizeof(*words)), words);                                                         \
  } while (0)

static void Start(World *world)
{
  const Disc disc[] = {{.x = 0.01, .y = 0.02, .r = 5e-3, .m = 0.17, .vx = 1.25},
                       {.x = 0.0195, .y = 0.02, .r = 5e-3, .m = 0.17, .vy = 3},
                       {.x = 0.11, .y = 0.03, .r = 4e-3, .m = 0.11, .vx = -2, .w = 6}};

  WorldCreate(PETSC_COMM_WORLD, world);
  WorldFill(world, 3, disc);
  CHECK(PgDemForces(world->dem, 0));
}

static void GuardQuiet(void **state)
{
  World world;

  (void)state;
  Start(&world);
  CHECK(PgDemGuard(world.dem, 1200, 0.012));
  WorldDestroy(&world);
}

static void GuardSpeed(void **state)
{
  const PetscReal fast[2] = {900, -1200}, faster[2] = {1600, -1200};
  World           world;

  (void)state;
  Start(&world);
  WorldSet(&world, "velocity", 2, 0, fast);
  WorldSet(&world, "velocity", 2, 2, faster);
  Capture();
  assert_int_equal(PgDemGuard(world.dem, 1200, 0.0125), PETSC_ERR_NOT_CONVERGED);
  EXPECT("porograin: error: step 1200, time 0.0125 s: disc 2 at (0.11, 0.03) m", "velocity (1600, -1200) m/s",
         "speed 2000 m/s is above -dem_guard_speed 1000");
  WorldDestroy(&world);
}

static void GuardOverlap(void **state)
{
  const PetscReal inside[2] = {0.0125, 0.02};
  World           world;

  (void)state;
  Start(&world);
  WorldSet(&world, "position", 2, 1, inside);
  WorldHalo(&world);
  Capture();
  assert_int_equal(PgDemGuard(world.dem, 77, 0.5), PETSC_ERR_NOT_CONVERGED);
  EXPECT("step 77, time 0.5 s: disc 0 at (0.01, 0.02) m, velocity (1.25, 0) m/s", "overlap with disc 1 is 1.5",
         "above -dem_guard_overlap 0.5");
  WorldDestroy(&world);
}

static void GuardNotFinite(void **state)
{
  const PetscReal fast[2] = {1600, -1200}, bad = INFINITY;
  World           world;

  (void)state;
  Start(&world);
  WorldSet(&world, "velocity", 2, 0, fast);
  WorldSet(&world, "torque", 1, 2, &bad);
  Capture();
  assert_int_equal(PgDemGuard(world.dem, 77, 0.5), PETSC_ERR_NOT_CONVERGED);
  EXPECT("disc 2 at (0.11, 0.03) m", "spin 6 rad/s", "not finite; force (0, 0) N/m, torque inf");
  WorldDestroy(&world);
}

/* Not a number anywhere: in what moves a disc, and in what moves it next. */
static void GuardNotFiniteAnywhere(void **state)
{
  static const struct {
    const char *field;
    PetscInt    components, at;
  } where[] = {{"position", 2, 0}, {"position", 2, 1}, {"velocity", 2, 0},         {"velocity", 2, 1},
               {"force", 2, 0},    {"force", 2, 1},    {"angular_velocity", 1, 0}, {"torque", 1, 0}};

  (void)state;
  for (size_t k = 0; k < sizeof where / sizeof *where; k++) {
    PetscReal bad[2] = {0.01, 0.02};
    World     world;

    Start(&world);
    bad[where[k].at] = k % 2 ? NAN : -INFINITY;
    WorldSet(&world, where[k].field, where[k].components, 1, bad);
    Capture();
    assert_int_equal(PgDemGuard(world.dem, 3, 0.5), PETSC_ERR_NOT_CONVERGED);
    EXPECT("step 3, time 0.5 s: disc 1 at (", "not finite; force (", k % 2 ? "nan" : "-inf");
    WorldDestroy(&world);
  }
}

static void GuardDomain(void **state)
{
  const PetscReal inside[2] = {0.129, 0.011}, left[2] = {-0.0015, 0.02}, above[2] = {0.01, 0.0402};
  World           world;

  (void)state;
  CHECK(PetscOptionsSetValue(NULL, "-dem_guard_domain", "-1e-3,0.13,0.01,0.04"));
  Start(&world);
  CHECK(PgDemSetFromOptions(world.dem));
  WorldSet(&world, "position", 2, 2, inside);
  CHECK(PgDemGuard(world.dem, 5, 0.25));
  WorldSet(&world, "position", 2, 0, above);
  WorldSet(&world, "position", 2, 2, left); /* farther out than disc 0 */
  Capture();
  assert_int_equal(PgDemGuard(world.dem, 6, 0.5), PETSC_ERR_NOT_CONVERGED);
  EXPECT("step 6, time 0.5 s: disc 2 at (-0.0015, 0.02) m, velocity (-2, 0) m/s, spin 6 rad/s",
         "it has left -dem_guard_domain -0.001,0.13,0.01,0.04");
  WorldDestroy(&world);
  CHECK(PetscOptionsClearValue(NULL, "-dem_guard_domain"));
}

/* A disc that comes to lie between two others, one of them light, bears a smaller time step than before. */
static void GuardTimeStep(void **state)
{
  const PetscReal between[2] = {0.028, 0.02};
  PetscReal       dt, later;
  char            limit[64];
  World           world;

  (void)state;
  Start(&world);
  CHECK(PgDemCriticalTimeStep(world.dem, &dt));
  CHECK(PgDemGuardTimeStep(world.dem, 7, 0.5, dt));
  Capture();
  assert_int_equal(PgDemGuardTimeStep(world.dem, 7, 0.5, dt * 1.001), PETSC_ERR_NOT_CONVERGED);
  EXPECT("step 7, time 0.5 s: disc 0 at (0.01, 0.02) m, mass 0.17 kg/m, with 1 springs on it bears a time step of at");
  WorldSet(&world, "position", 2, 2, between);
  CHECK(PgNeighborsBuild(world.neighbors));
  CHECK(PgDemCriticalTimeStep(world.dem, &later));
  assert_true(later < 0.85 * dt); /* disc 1 has two springs now: about 1/sqrt(2), masses and radii differ */
  CHECK(PetscSNPrintf(limit, sizeof limit, "at most %g s; %g s is above", (double)later, (double)dt));
  Capture();
  assert_int_equal(PgDemGuardTimeStep(world.dem, 8, 0.75, dt), PETSC_ERR_NOT_CONVERGED);
  EXPECT("step 8, time 0.75 s: disc 1 at (0.0195, 0.02) m, mass 0.17 kg/m, with 2 springs on it", limit,
         "-dem_guard_time_step 1 times that: give a smaller -dt");
  CHECK(PetscOptionsSetValue(NULL, "-dem_guard_time_step", "1.5"));
  CHECK(PgDemSetFromOptions(world.dem));
  CHECK(PetscOptionsClearValue(NULL, "-dem_guard_time_step"));
  CHECK(PgDemGuardTimeStep(world.dem, 8, 0.75, 1.499 * later));
  Capture();
  assert_int_equal(PgDemGuardTimeStep(world.dem, 8, 0.75, 1.501 * later), PETSC_ERR_NOT_CONVERGED);
  EXPECT("above -dem_guard_time_step 1.5 times that");
  WorldDestroy(&world);
}

/* Sets options, expects SetFromOptions to refuse them, and takes them back. */
static void Refused(PetscInt count, const char *const option[], const char *const value[], PetscErrorCode expected)
{
  World world;

  WorldCreate(PETSC_COMM_WORLD, &world);
  for (PetscInt k = 0; k < count; k++) CHECK(PetscOptionsSetValue(NULL, option[k], value[k]));
  Capture();
  assert_int_equal(PgDemSetFromOptions(world.dem), expected);
  for (PetscInt k = 0; k < count; k++) CHECK(PetscOptionsClearValue(NULL, option[k]));
  WorldDestroy(&world);
}

static void Options(void **state)
{
  (void)state;
  Refused(1, (const char *const[]){"-dem_mu_s"}, (const char *const[]){"0.4"}, PETSC_ERR_USER_INPUT);
  EXPECT("-dem_mu_r 0.5 is larger than -dem_mu_s 0.4", "mu_r <= mu_s");
  Refused(1, (const char *const[]){"-dem_k_n"}, (const char *const[]){"0"}, PETSC_ERR_USER_INPUT);
  EXPECT("-dem_k_n", "N/m");
  Refused(1, (const char *const[]){"-dem_local_damping"}, (const char *const[]){"1.5"}, PETSC_ERR_USER_INPUT);
  EXPECT("-dem_local_damping", "1.5");
  Refused(1, (const char *const[]){"-dem_contact_law"}, (const char *const[]){"maxwell"}, PETSC_ERR_USER_INPUT);
  EXPECT("-dem_contact_law", "maxwell", "li2007", "tak2013", "hertz");
}

static void AcceptedOptions(void **state)
{
  const char *const   option[] = {"-dem_k_n", "-dem_k_r", "-dem_mu_s", "-dem_mu_theta_r", "-dem_c_theta"};
  const char *const   value[]  = {"5e8", "0", "0.7", "3e-4", "0.2"};
  const PgPlate       plate    = {.name = "floor", .side = -1, .friction = -1};
  PgPlate             got;
  PgContactParameters p;
  World               world;

  (void)state;
  WorldCreate(PETSC_COMM_WORLD, &world);
  for (PetscInt k = 0; k < 5; k++) CHECK(PetscOptionsSetValue(NULL, option[k], value[k]));
  CHECK(PetscOptionsSetValue(NULL, "-plate_friction", "0.35"));
  CHECK(PgDemAddPlate(world.dem, &plate, NULL));
  CHECK(PgDemSetFromOptions(world.dem));
  for (PetscInt k = 0; k < 5; k++) CHECK(PetscOptionsClearValue(NULL, option[k]));
  CHECK(PetscOptionsClearValue(NULL, "-plate_friction"));
  CHECK(PgDemGetParameters(world.dem, &p));
  assert_true(p.k_n == 5e8 && p.k_s == 4e8 && p.k_r == 0 && p.k_theta == 700 && p.mu_s == 0.7 && p.mu_r == 0.5);
  assert_true(p.mu_theta_r == 3e-4 && p.c_theta == 0.2 && p.c_n == 0 && p.c_s == 0 && p.c_r == 0);
  CHECK(PgDemGetPlate(world.dem, 0, &got));
  assert_true(got.friction == 0.35 && got.side == -1);
  WorldDestroy(&world);
}

/* Every setting is printed. */
static void View(void **state)
{
  const PgPlate   plate[]    = {{.name = "lid", .side = 1, .velocity = -0.25, .friction = 0.35},
                                {.name = "bed", .hold = PETSC_TRUE}};
  const PetscReal gravity[2] = {0.5, -9.5};
  World           world;

  (void)state;
  WorldCreate(PETSC_COMM_WORLD, &world);
  for (PetscInt k = 0; k < 2; k++) CHECK(PgDemAddPlate(world.dem, &plate[k], NULL));
  CHECK(PgDemSetGravity(world.dem, gravity));
  CHECK(PgDemSetDamping(world.dem, 0.75, 12.5));
  Capture();
  CHECK(PgDemView(world.dem, PETSC_VIEWER_STDERR_WORLD));
  EXPECT("li2007", "k_n = 6e+08 N/m", "k_s = 4e+08 N/m", "k_r = 2000. N/m", "k_theta = 700. N m/rad", "mu_s = 0.5",
         "mu_theta_r = 0.0001 m", "local damping 0.75, global damping 12.5 1/s", "gravity (0.5, -9.5)",
         "speed 1000. m/s", "plate lid: above its discs, velocity -0.25 m/s, friction 0.35",
         "plate bed: holds its discs");
  WorldDestroy(&world);
}

static void Calls(void **state)
{
  PgContactParameters p     = {.k_n = 6e8, .k_s = 4e8, .c_r = -3, .mu_s = 0.5};
  const PgPlate       plate = {.name = "tilted", .side = 0.5};
  World               world;

  (void)state;
  WorldCreate(PETSC_COMM_WORLD, &world);
  Capture();
  assert_int_equal(PgDemSetParameters(world.dem, &p), PETSC_ERR_USER_INPUT);
  EXPECT("contact parameter c_r = -3 N s/m");
  Capture();
  assert_int_equal(PgDemAddPlate(world.dem, &plate, NULL), PETSC_ERR_USER_INPUT);
  EXPECT("plate tilted: side 0.5");
  Capture();
  assert_int_equal(PgDemSetDamping(world.dem, 1.2, 0), PETSC_ERR_USER_INPUT);
  EXPECT("local 1.2");
  WorldDestroy(&world);
}

static int Tests(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(GuardQuiet),
                                     cmocka_unit_test(GuardSpeed),
                                     cmocka_unit_test(GuardOverlap),
                                     cmocka_unit_test(GuardNotFinite),
                                     cmocka_unit_test(GuardNotFiniteAnywhere),
                                     cmocka_unit_test(GuardDomain),
                                     cmocka_unit_test(GuardTimeStep),
                                     cmocka_unit_test(Options),
                                     cmocka_unit_test(AcceptedOptions),
                                     cmocka_unit_test(View),
                                     cmocka_unit_test(Calls)};

  return cmocka_run_group_tests_name("guard and options", tests, NULL, NULL);
}

int main(int argc, char *argv[]) { return RunTests(argc, argv, Tests); }
