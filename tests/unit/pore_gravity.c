/* ranks: 1 2 4 */
/* Water at rest under gravity stays at rest, and the pressure of an ambient that is not zero does not matter: a box with
   impermeable bottom and sides and a drained top, its discs held in place (on a plate) or free, started from hydrostatic
   pressure. What is solved for is the excess over hydrostatic pressure, so nothing but rounding can move. */
#include "ground.h"

static const Packing   disorder = {9, 11, 5e-3, 0.15, 0.12};
static const PetscReal dt = 2e-4, rho_f = 1000.0, gravity[2] = {0.0, -9.81};

#define BOX                                                                                                            \
  " -bc_left impermeable -bc_right impermeable -bc_bottom impermeable -bc_top drained -coupling drag_and_pressure"     \
  " -ns_continuity averaged -pressure_ksp_type cg -pressure_pc_type jacobi -pressure_ksp_rtol 1e-10 "

typedef struct {
  const Packing *packing;
  PetscBool      held;
} Case;

/* The top row is level, so that its drained pressure is one of water at rest. */
static void Place(const void *context, PetscInt id, Disc *disc)
{
  const Case *c = (const Case *)context;
  PetscInt    row, column, length;

  PackingPlace(c->packing, id, disc);
  PackingRow(c->packing, id, &row, &column, &length);
  if (row == c->packing->rows - 1) disc->x[1] = c->packing->radius * (1.0 + PetscSqrtReal(3.0) * (PetscReal)row);
  disc->plate = c->held ? 1 : 0;
}

static PetscReal Top(void) { return disorder.radius * (1.0 + PetscSqrtReal(3.0) * (PetscReal)(disorder.rows - 1)); }

static Ground Make(GroundKind kind, const char options[], PetscBool held)
{
  const Case c = {&disorder, held};
  Ground     g;
  PetscReal *x, *p;

  GroundCreate(PETSC_COMM_WORLD, kind, options, &g);
  CHECK(PgPoreSetGravity(g.pore, gravity));
  CHECK(PgPoreSetSolidDensity(g.pore, 2000.0));
  GroundFill(&g, PackingCount(&disorder), Place, &c);
  CHECK(PgPoreSetUp(g.pore, dt));
  x = GroundCore(&g, PG_POSITION);
  p = GroundArray(&g, "pressure");
  for (PetscInt a = 0; a < GroundOwned(&g); a++) p[a] = 1e5 + rho_f * gravity[1] * (x[2 * a + 1] - Top());
  CHECK(PgPoreRefresh(g.pore));
  return g;
}

static void HydrostaticRest(void **state)
{
  const char *const options[] = {BOX "-sph_gradient corrected -pressure implicit", BOX "-sph_gradient paper",
                                 BOX "-sph_gradient corrected -pressure explicit", BOX "-ns_theta 0.7",
                                 BOX "-coupling_scheme staggered -permeability 6.5e-7"};

  (void)state;
  for (size_t k = 0; k < sizeof options / sizeof *options; k++) {
    for (int kind = GROUND_DARCY; kind <= GROUND_NS; kind++) {
      for (int held = 0; held < 2; held++) {
        Ground     g = Make((GroundKind)kind, options[k], (PetscBool)held);
        PetscReal *x, *p, *u, *v, *force, *r;

        for (int step = 0; step < 5; step++) {
          CHECK(PgPorePredict(g.pore, dt));
          CHECK(PgPoreCorrect(g.pore, dt));
        }
        CHECK(PgPorePredict(g.pore, dt));
        x     = GroundCore(&g, PG_POSITION);
        r     = GroundCore(&g, PG_RADIUS);
        v     = GroundCore(&g, PG_VELOCITY);
        p     = GroundArray(&g, "pressure");
        u     = GroundArray(&g, "fluid_velocity");
        force = GroundArray(&g, "fluid_force");
        for (PetscInt a = 0; a < GroundOwned(&g); a++) {
          const PetscReal buoyancy = -PETSC_PI * r[a] * r[a] * rho_f * gravity[1];
          /* p and p - rho_f g.x cost a rounding each of 1e5 Pa, 1.5e-11 Pa, twice a step for five steps; the solver may
             stop at 1e-7 Pa of diagonal over N, which is 1e-9 Pa a row at 94 discs, 2e-7 Pa in the field at most */
          NEAR(p[a], 1e5 + rho_f * gravity[1] * (x[2 * a + 1] - Top()), 1e-6);
          for (int i = 0; i < 2; i++) {
            /* rounding of p over the spacing: 1e-10 Pa/1e-2 m = 1e-8 Pa/m, and as much as 2e-5 Pa/m from the solver:
               times k_p/n = 7e-6 or dt/rho_f = 2e-7 m4/(N s) for the water, dt/rho_s for the discs */
            NEAR(u[2 * a + i], 0.0, 1e-10);
            NEAR(v[2 * a + i], 0.0, 1e-10);
            assert_true(!held || v[2 * a + i] == 0.0);
            /* V times those gradients, over 1 - n for the Darcy drag: 1e-9 N/m */
            NEAR(force[2 * a + i], i == 0 ? 0.0 : buoyancy, 1e-8);
          }
          assert_true(buoyancy > 0.5);
        }
        GroundDestroy(&g);
      }
    }
  }
}

/* Without the excess the same box would not be at rest: uniform pressure in the same box makes water and discs move. */
static void OtherPressuresMove(void **state)
{
  Ground     g = Make(GROUND_DARCY, BOX "-sph_gradient corrected", PETSC_FALSE);
  PetscReal *p, *u, least = PETSC_MAX_REAL;

  (void)state;
  p = GroundArray(&g, "pressure");
  for (PetscInt a = 0; a < GroundOwned(&g); a++) p[a] = 1e5;
  CHECK(PgPoreRefresh(g.pore));
  CHECK(PgPorePredict(g.pore, dt));
  {
    PetscReal *force = GroundArray(&g, "fluid_force"), *r = GroundCore(&g, PG_RADIUS);
    /* the Darcy projection has only buoyancy here, which does not know p */
    for (PetscInt a = 0; a < GroundOwned(&g); a++) NEAR(force[2 * a + 1], PETSC_PI * r[a] * r[a] * 9810.0, 1e-12 * 1.0);
  }
  GroundDestroy(&g);
  g = Make(GROUND_NS, BOX "-sph_gradient corrected -pressure explicit -pressure_guess last", PETSC_FALSE);
  p = GroundArray(&g, "pressure");
  for (PetscInt a = 0; a < GroundOwned(&g); a++) p[a] = 1e5;
  CHECK(PgPoreRefresh(g.pore));
  CHECK(PgPorePredict(g.pore, dt));
  CHECK(PgPoreCorrect(g.pore, dt));
  u = GroundArray(&g, "fluid_velocity");
  for (PetscInt a = 0; a < GroundOwned(&g); a++) {
    if (PackingDepth(&disorder, GroundIds(&g)[a]) < 5.0) continue;
    least = PetscMin(least, -u[2 * a + 1]);
  }
  MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPIU_REAL, MPI_MIN, PETSC_COMM_WORLD);
  /* free fall for one step, dt g = 2e-3 m/s, less what the sweep has built up */
  assert_true(least > 1e-4 && least < 2.1e-3);
  GroundDestroy(&g);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(HydrostaticRest),
    cmocka_unit_test(OtherPressuresMove),
};

GROUND_MAIN(tests, PETSC_TRUE)
