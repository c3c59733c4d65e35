/* Inertia of the continuum: a column held at its bottom swings in its first mode, with the stiffness of the skeleton when
   its water offers none, and with that of both when the water cannot leave; damping in proportion to mass. */
#include <porograin/fem.h>
#include "up_exact.h"
#include "verify.h"

static const PetscReal height = 1.0;

static void Mode(void *context, const PetscReal x[2], PetscReal value[3])
{
  const PetscReal amplitude = 1e-3;

  value[0] = 0.0;
  value[1] = amplitude * PetscSinReal(0.5 * PETSC_PI * x[1] / height);
  /* the pressure that goes with it in closed pores */
  value[2] = -*(const PetscReal *)context * amplitude * 0.5 * PETSC_PI / height *
             PetscCosReal(0.5 * PETSC_PI * x[1] / height);
}

/* Displacement of the top over that at the start, after `part` of a period of the undamped column. */
static PetscReal Swing(PetscBool closed, PetscInt cells, PetscInt steps, PetscReal part, PetscReal damping)
{
  const PetscInt  n[2]   = {1, cells};
  const PetscReal low[2] = {0, 0}, high[2] = {0.1, height}, zero = 0.0;
  PgFemMaterial   m;
  PgFemNodes      nodes;
  PetscReal       stiffness, coupling, rho, period, u = 0.0;
  PgFem           fem;

  PgFemMaterialDefault(&m);
  m.E       = 3e7;
  m.nu      = 0.3;
  m.k       = 0.0;
  m.alpha   = 0.9;
  m.K_s     = closed ? 4e8 : 4.0; /* water and grains that take up any volume */
  m.K_f     = closed ? 5e7 : 0.5;
  coupling  = m.alpha / ExactStorage(&m);
  stiffness = ExactM(&m) + m.alpha * coupling;
  rho       = (1.0 - m.n) * m.rho_s + m.n * m.rho_f;
  period    = 4.0 * height * PetscSqrtReal(rho / stiffness);
  CHECK(PgFemCreate(PETSC_COMM_WORLD, &fem));
  CHECK(PgFemSetBox(fem, n, low, high));
  CHECK(PgFemSetMaterial(fem, NULL, &m));
  CHECK(PgFemSetStabilisation(fem, 0.0));
  CHECK(PgFemSetInertia(fem, PETSC_TRUE, damping / period));
  CHECK(PgFemSetTheta(fem, 0.5, 0));
  CHECK(PgFemSetInitial(fem, Mode, &coupling));
  CHECK(PgFemSetCondition(fem, "left", PG_FEM_DISPLACEMENT_X, &zero));
  CHECK(PgFemSetCondition(fem, "right", PG_FEM_DISPLACEMENT_X, &zero));
  CHECK(PgFemSetCondition(fem, "bottom", PG_FEM_DISPLACEMENT_Y, &zero));
  CHECK(PgFemSetUp(fem));
  for (PetscInt k = 0; k < steps; k++) CHECK(PgFemStep(fem, part * period / (PetscReal)steps));
  CHECK(PgFemGetNodes(fem, &nodes));
  for (PetscInt i = 0; i < nodes.count; i++)
    if (nodes.x[2 * i + 1] > height - 1e-9) u = nodes.displacement[2 * i + 1] / 1e-3;
  CHECK(PgFemDestroy(&fem));
  return u;
}

static void Frequency(void **state)
{
  (void)state;
  for (int closed = 0; closed < 2; closed++) {
    PetscReal error[3], h[3];
    for (int k = 0; k < 3; k++) {
      h[k]     = 1.0 / (PetscReal)(4 << k);
      error[k] = PetscAbsReal(Swing((PetscBool)closed, 4 << k, 300, 0.25, 0.0));
    }
    /* 300 steps leave (omega dt)^2/2 = 1.4e-5 of the first one */
    VerifyOrder("up inertia",
                closed ? "top after a quarter of the period, closed pores"
                       : "top after a quarter of the period, skeleton",
                3, h, error, 2.0, 0.15, "elements; 300 steps");
  }
}

static void Steps(void **state)
{
  const PetscReal finest = Swing(PETSC_TRUE, 8, 1600, 0.7, 0.0);
  PetscReal       error[3], h[3], mass = 0.3, exact;

  (void)state;
  for (int k = 0; k < 3; k++) {
    h[k]     = 0.7 / (PetscReal)(50 << k);
    error[k] = PetscAbsReal(Swing(PETSC_TRUE, 8, 50 << k, 0.7, 0.0) - finest);
  }
  VerifyOrder("up inertia", "top after 0.7 of the period in dt, trapezoidal rule", 3, h, error, 2.0, 0.15,
              "against 1600 steps");
  /* u'' + c u' + w^2 u = 0 after a whole period of the undamped swing, c = 0.3/period */
  exact = PetscExpReal(-0.5 * mass) * (PetscCosReal(PetscSqrtReal(PetscSqr(2.0 * PETSC_PI) - 0.25 * mass * mass)) +
                                       0.5 * mass / PetscSqrtReal(PetscSqr(2.0 * PETSC_PI) - 0.25 * mass * mass) *
                                           PetscSinReal(PetscSqrtReal(PetscSqr(2.0 * PETSC_PI) - 0.25 * mass * mass)));
  /* 32 cells: (pi/2 h)^2/24 = 1e-4 of the frequency, of second order at the top of the swing; the first of 600 steps */
  VerifyValue("up inertia", "top after a period, damping 0.3 over the period", exact,
              Swing(PETSC_TRUE, 32, 600, 1.0, mass), 0.0, 5e-4, "first step of 600 is of first order: (omega dt)^2");
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(Frequency), cmocka_unit_test(Steps)};

int main(int argc, char *argv[])
{
  int failed;

  if (PgInitialize(&argc, &argv, NULL)) return 1;
  if (PetscOptionsInsertString(NULL, "-up_ksp_type preonly -up_pc_type lu")) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
