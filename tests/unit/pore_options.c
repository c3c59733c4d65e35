/* ranks: 1 2 */
/* Options of the water that contradict each other or lie outside their bounds are refused, with a message that names
   them and the error that ends a run with exit status 2; what is unstable is refused or warned of; the guard stops
   a run that has blown up. */
#include "ground.h"

typedef struct {
  GroundKind  kind;
  const char *options, *words[3];
} Refusal;

static const Refusal refusals[] = {
    {GROUND_DARCY,
     "-permeability 1e-6 -permeability_law kozeny_carman",
     {"-permeability", "kozeny_carman", "contradict"}},
    {GROUND_DARCY, "-bc_top flux", {"-bc_top flux", "-bc_top_flux", "needs"}},
    {GROUND_NS,
     "-coupling drag_and_pressure -coupling_scheme projection",
     {"-coupling_scheme projection", "-ns_continuity solenoidal", "contradict"}},
    {GROUND_NS, "-ns_drag stokes", {"-ns_drag", "stokes", "ergun_wen_yu"}},
    {GROUND_NS, "-ns_theta 1.5", {"-ns_theta", "1.5", "<= 1"}},
    {GROUND_NS, "-ns_theta 0", {"-ns_theta", "0", ">= 0.01"}},
    {GROUND_NS, "-ns_smoothing 2", {"-ns_smoothing", "2", "<= 1"}},
    {GROUND_DARCY, "-permeability 0", {"-permeability", "m4/(N s)", "out of range"}},
    {GROUND_DARCY, "-permeability many", {"-permeability", "many", "not a number"}},
    {GROUND_DARCY, "-fluid_density -3", {"-fluid_density", "-3", "kg/m3"}},
    {GROUND_DARCY, "-bc_left open", {"-bc_left", "open", "drained"}},
    {GROUND_DARCY, "-porosity sampled", {"-porosity", "sampled", "kinematic"}},
    {GROUND_DARCY, "-porosity_min 0.7", {"-porosity_min", "0.7", "<= 0.5"}},
    {GROUND_DARCY, "-detach_porosity 1", {"-detach_porosity", "1", "<= 0.99"}},
    {GROUND_DARCY, "-bc_tracking always", {"-bc_tracking", "always", "surface"}},
};

/* Only the part of creation that comes before the options are read; a refusal ends a run, nothing is destroyed. */
static PgPore Unread(GroundKind kind)
{
  PgParticles particles;
  PgNeighbors neighbors;
  PgDem       dem;
  PgPore      pore;

  CHECK(PgParticlesCreate(PETSC_COMM_WORLD, &particles));
  CHECK(PgNeighborsCreate(particles, &neighbors));
  CHECK(PgDemCreate(particles, neighbors, &dem));
  CHECK(PgPoreCreate(particles, neighbors, kind == GROUND_DARCY ? PG_FLUID_DARCY : PG_FLUID_NS, &pore));
  return pore;
}

static void Refusals(void **state)
{
  (void)state;
  for (size_t k = 0; k < sizeof refusals / sizeof *refusals; k++) {
    PgPore pore;

    GroundOptions("");
    pore = Unread(refusals[k].kind);
    GroundOptions(refusals[k].options);
    FAILS(PgPoreSetFromOptions(pore), PETSC_ERR_USER_INPUT, refusals[k].words[0], refusals[k].words[1],
          refusals[k].words[2], "porograin: error: ");
  }
  GroundOptions("");
}

/* What looks alike but is no contradiction. */
static void Accepted(void **state)
{
  const Refusal good[] = {
      {GROUND_DARCY, "-permeability 1e-6 -permeability_law constant", {NULL}},
      {GROUND_NS, "-bc_left drained -bc_left_pressure 2e5 -bc_top flux -bc_top_flux -0.13", {NULL}},
      {GROUND_NS, "-coupling drag_and_pressure -coupling_scheme projection -ns_continuity averaged", {NULL}},
      {GROUND_DARCY, "-coupling drag_and_pressure -coupling_scheme projection", {NULL}},
      {GROUND_NS, "-ns_theta 0.01 -ns_smoothing 1 -porosity_min 0.5 -porosity_max 0.5", {NULL}},
  };

  (void)state;
  for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
    PgPore     pore;
    PgBoundary bc;

    GroundOptions("");
    pore = Unread(good[k].kind);
    GroundOptions(good[k].options);
    CHECK(PgPoreSetFromOptions(pore));
    CHECK(PgPoreGetBoundary(pore, PG_SIDE_LEFT, &bc));
    assert_int_equal(bc.kind, PG_BC_DRAINED);
    assert_true(bc.pressure == (k == 1 ? 2e5 : 1e5));
    CHECK(PgPoreGetBoundary(pore, PG_SIDE_TOP, &bc));
    assert_true(k == 1 ? bc.kind == PG_BC_FLUX && bc.flux == -0.13 : bc.kind == PG_BC_DRAINED && bc.flux == 0.0);
  }
  GroundOptions("");
}

/* Drained sides are at the initial pressure unless told otherwise. */
static void InitialPressureOfTheSides(void **state)
{
  PgPore     pore;
  PgBoundary bc;

  (void)state;
  GroundOptions("");
  pore = Unread(GROUND_DARCY);
  GroundOptions("-initial_pressure 3e4 -bc_top_pressure 7e4");
  CHECK(PgPoreSetFromOptions(pore));
  CHECK(PgPoreGetBoundary(pore, PG_SIDE_LEFT, &bc));
  assert_true(bc.pressure == 3e4);
  CHECK(PgPoreGetBoundary(pore, PG_SIDE_TOP, &bc));
  assert_true(bc.pressure == 7e4);
  GroundOptions("");
}

/* The staggered Darcy coupling is stable below 2 k_p (1 - n) rho_s, at k_p = 1e-9 and n = 0.1 3.6e-6 s. */
static void StepOfTheStaggeredDarcyCoupling(void **state)
{
  const char *const options = "-coupling drag_and_pressure -coupling_scheme staggered -permeability 1e-9";
  PgPore            pore;

  (void)state;
  GroundOptions("");
  pore = Unread(GROUND_DARCY);
  GroundOptions(options);
  CHECK(PgPoreSetFromOptions(pore));
  CHECK(PgPoreSetSolidDensity(pore, 2000.0));
  CHECK(PgPoreCheckStep(pore, 3.5e-6));
  FAILS(PgPoreCheckStep(pore, 3.7e-6), PETSC_ERR_USER_INPUT, "-coupling_scheme staggered", "3.7e-06", "3.6e-06",
        "projection");
  /* the projection has no bound */
  GroundOptions("");
  pore = Unread(GROUND_DARCY);
  GroundOptions("-coupling drag_and_pressure -permeability 1e-9");
  CHECK(PgPoreSetFromOptions(pore));
  CHECK(PgPoreCheckStep(pore, 1.0));
  GroundOptions("");
}

/* Warnings, on standard output. */
static void Warnings(void **state)
{
  const struct {
    const char *options, *word;
  } cases[] = {{"-ns_theta 0.5", "-ns_theta 0.5 is below 0.57"},
               {"-coupling drag_and_pressure -coupling_scheme staggered -ns_continuity averaged", "staggered"},
               {"-ns_theta 0.6", NULL}};
  PetscMPIInt rank;

  (void)state;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    FILE  *file = tmpfile(), *terminal = PETSC_STDOUT;
    char   text[1024];
    size_t length;
    PgPore pore;

    assert_non_null(file);
    GroundOptions("");
    pore = Unread(GROUND_NS);
    GroundOptions(cases[k].options);
    CHECK(PgPoreSetFromOptions(pore));
    PETSC_STDOUT = file;
    CHECK(PgPoreCheckStep(pore, 1e-6));
    PETSC_STDOUT = terminal;
    rewind(file);
    length       = fread(text, 1, sizeof text - 1, file);
    text[length] = '\0';
    (void)fclose(file);
    if (rank == 0 && cases[k].word) {
      assert_non_null(strstr(text, "warning: "));
      assert_non_null(strstr(text, cases[k].word));
    } else {
      assert_true(length == 0);
    }
  }
  GroundOptions("");
}

/* A pressure or velocity beyond the guard's bounds, or none at all, ends the run: which disc, where, when. */
static void Guard(void **state)
{
  const Packing packing = {5, 6, 5e-3, 0.1, 0.1};

  (void)state;
  for (int k = 0; k < 4; k++) {
    Ground     g;
    PetscReal *p, *u;

    GroundCreate(PETSC_COMM_WORLD, GROUND_NS, "-pressure explicit -pore_guard_pressure 3e5 -pore_guard_speed 40", &g);
    GroundFill(&g, PackingCount(&packing), PackingPlace, &packing);
    CHECK(PgPoreSetUp(g.pore, 1e-5));
    CHECK(PgPoreGuard(g.pore, 4, 0.25));
    p = GroundArray(&g, "pressure");
    u = GroundArray(&g, "fluid_velocity");
    for (PetscInt a = 0; a < GroundOwned(&g); a++) {
      if (GroundIds(&g)[a] == 7) u[2 * a + 1] = k == 3 ? 41.0 : 39.0;
      if (GroundIds(&g)[a] != 13) continue;
      if (k == 0) p[a] = 2.9e5;
      if (k == 1) p[a] = -3.1e5;
      if (k == 2) p[a] = NAN;
    }
    if (k == 0)
      CHECK(PgPoreGuard(g.pore, 5, 0.5));
    else
      FAILS(PgPoreGuard(g.pore, 5, 0.5), PETSC_ERR_NOT_CONVERGED, "step 5", "0.5 s", k == 3 ? "disc 7 " : "disc 13 ",
            k == 1 ? "-310000" : (k == 2 ? "nan" : ", 41)"), "m/s)\n");
    GroundDestroy(&g);
  }
}

/* Porosities out of range are clipped; when it is too many discs, the run ends and names the first of them. */
static void GuardPorosity(void **state)
{
  const Packing   packing = {5, 6, 5e-3, 0.1, 0.1};
  const PetscReal dt      = 1e-5;

  (void)state;
  /* 27 discs have about the same porosity, and a lower bound above it clips all of them */
  for (int k = 0; k < 3; k++) {
    Ground g;

    GroundCreate(PETSC_COMM_WORLD, GROUND_DARCY,
                 k == 0   ? "-pressure explicit -pore_guard_clipped 0"
                 : k == 1 ? "-pressure explicit -porosity_min 0.5 -pore_guard_clipped 1"
                          : "-pressure explicit -porosity_min 0.5 -pore_guard_clipped 0.99",
                 &g);
    GroundFill(&g, PackingCount(&packing), PackingPlace, &packing);
    CHECK(PgPoreSetUp(g.pore, dt));
    CHECK(PgPorePredict(g.pore, dt));
    CHECK(PgPoreCorrect(g.pore, dt));
    if (k < 2)
      CHECK(PgPoreGuard(g.pore, 5, 0.5));
    else
      FAILS(PgPoreGuard(g.pore, 5, 0.5), PETSC_ERR_NOT_CONVERGED, "step 5, time 0.5 s: the porosity of 27 of 27 discs",
            "more than -pore_guard_clipped 0.99 of them; the first is disc 0 at (", "m, clipped to 0.5\n");
    GroundDestroy(&g);
  }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(Refusals),
    cmocka_unit_test(Accepted),
    cmocka_unit_test(InitialPressureOfTheSides),
    cmocka_unit_test(StepOfTheStaggeredDarcyCoupling),
    cmocka_unit_test(Warnings),
    cmocka_unit_test(Guard),
    cmocka_unit_test(GuardPorosity),
};

/* The last word on refusals: a run that ends with one has exit status 2. */
int main(int argc, char *argv[])
{
  PgPore         pore;
  PetscErrorCode err;
  int            failed, status;

  PetscCall(PgInitialize(&argc, &argv, "test"));
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  pore   = Unread(GROUND_NS);
  GroundOptions("-bc_top flux");
  err    = PgPoreSetFromOptions(pore);
  status = PgFinalize(err);
  if (status != 2) (void)fprintf(stderr, "exit status %d instead of 2\n", status);
  return failed || status != 2;
}
