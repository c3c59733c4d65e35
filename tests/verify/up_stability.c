/* Stability of the elements of the continuum: the first step of consolidation, and the inf-sup constant. The trouble
   that equal orders have is shown beside the cure. */
#include <porograin/cases.h>
#include <petscksp.h>
#include <stdlib.h>
#include "up_exact.h"
#include "verify.h"

#define DIRECT "-up_ksp_type preonly -up_pc_type lu -up_pc_factor_mat_solver_type mumps "

/* tau = 1/(2 G) as a multiple of 1/M. */
static PetscReal HalfShear(PetscReal nu) { return 2.0 * (1.0 - nu) / (1.0 - 2.0 * nu) / 2.0; }

/* Largest pressure over the load, less 1, after a step of 1e-6 h^2/(6 c_v), and the largest difference of neighbours below
   the drained layer, both with 20 cells. */
static void FirstStep(PetscReal nu, const char element[], PetscReal *overshoot, PetscReal *jump)
{
  char          options[256];
  PgFemMaterial m;
  PgFemNodes    nodes;
  PetscReal     p[21], c;
  PgFem         fem;
  PgUp          up;

  (void)snprintf(options, sizeof options,
                 DIRECT "-up_cells 1,20 -up_bulk_grains 1e22 -up_bulk_water 1e22 -up_poisson %.6g %s", (double)nu,
                 element);
  CHECK(PetscOptionsClear(NULL));
  CHECK(PetscOptionsInsertString(NULL, options));
  CHECK(PgUpCreate(PETSC_COMM_WORLD, "up_terzaghi", &up));
  CHECK(PgUpSetUp(up));
  CHECK(PgUpGetFem(up, &fem));
  CHECK(PgFemGetMaterial(fem, &m));
  c = ExactDiffusivity(&m);
  CHECK(PgFemStep(fem, 1e-6 / (400.0 * 6.0 * c)));
  CHECK(PgFemGetNodes(fem, &nodes));
  for (PetscInt i = 0; i < nodes.count; i++)
    if (nodes.x[2 * i] < 1e-9) p[(PetscInt)(20.0 * nodes.x[2 * i + 1] + 0.5)] = nodes.pressure[i] / 1e4;
  *overshoot = *jump = 0.0;
  for (PetscInt i = 0; i < 20; i++) {
    *overshoot = PetscMax(*overshoot, p[i]);
    if (i < 10) *jump = PetscMax(*jump, PetscAbsReal(p[i + 1] - p[i]));
  }
  *overshoot -= 1.0;
  CHECK(PgUpDestroy(&up));
}

static void Overshoot(void **state)
{
  const PetscReal nu[3] = {0.2, 0.48, 0.4999};

  (void)state;
  for (int k = 0; k < 3; k++) {
    PetscReal overshoot, jump;
    char      name[128], tau[64];
    FirstStep(nu[k], "", &overshoot, &jump);
    (void)snprintf(name, sizeof name, "first step, nu = %g, Q1-Q1, 3/M: max p/q - 1", (double)nu[k]);
    /* the leading terms cancel exactly: rounding times the condition, which grows with M/G */
    VerifyValue("up_terzaghi", name, 0.0, overshoot, 1.0, 1e-6, "rounding times M/G");
    (void)snprintf(name, sizeof name, "first step, nu = %g, Q1-Q1, 3/M: largest jump of p/q between nodes, lower half",
                   (double)nu[k]);
    VerifyValue("up_terzaghi", name, 0.0, jump, 1.0, 1e-6, "rounding times M/G");
    FirstStep(nu[k], "-up_stabilisation 0", &overshoot, &jump);
    (void)snprintf(name, sizeof name, "first step, nu = %g, Q1-Q1 not stabilised: max p/q - 1", (double)nu[k]);
    VerifyValue("up_terzaghi", name, 1.0, overshoot, 0.0, 1e-3,
                "0 and 2 q in turn; the step is not zero, 20^2 times 1e-6");
    (void)snprintf(name, sizeof name, "first step, nu = %g, Q1-Q1 not stabilised: largest jump of p/q, lower half",
                   (double)nu[k]);
    VerifyValue("up_terzaghi", name, 2.0, jump, 0.0, 1e-3, "0 and 2 q in turn; the step is not zero, 20^2 times 1e-6");
    FirstStep(nu[k], "-up_element q2q1", &overshoot, &jump);
    (void)snprintf(name, sizeof name, "first step, nu = %g, Q2-Q1: max p/q - 1", (double)nu[k]);
    /* the layer that no cell resolves, not the element: 2 - sqrt(3) = 0.268 at the first node */
    VerifyValue("up_terzaghi", name, 2.0 - PetscSqrtReal(3.0), overshoot, 0.0, 1e-3, "unresolved drained layer");
    (void)snprintf(tau, sizeof tau, "-up_stabilisation %.10g", (double)HalfShear(nu[k]));
    FirstStep(nu[k], tau, &overshoot, &jump);
    (void)snprintf(name, sizeof name, "first step, nu = %g, Q1-Q1, 1/(2 G): max p/q - 1", (double)nu[k]);
    VerifyReport("up_terzaghi", name, overshoot, "why tau is 3/M here: 1/(2 G) oscillates or smears");
  }
}

static Mat Dense(Mat A, IS rows, IS columns)
{
  Mat sub, dense;

  CHECK(MatCreateSubMatrix(A, rows, columns, MAT_INITIAL_MATRIX, &sub));
  CHECK(MatConvert(sub, MATDENSE, MAT_INITIAL_MATRIX, &dense));
  CHECK(MatDestroy(&sub));
  return dense;
}

static int Ascending(const void *a, const void *b)
{
  const PetscReal x = *(const PetscReal *)a, y = *(const PetscReal *)b;
  return (x > y) - (x < y);
}

/* Eigenvalues of M_p^-1 B, ascending; an array of n. */
static PetscReal *Eigenvalues(Mat B, Mat mass, PetscInt n)
{
  PetscReal *real, *imaginary;
  KSP        ksp;
  PC         pc;

  CHECK(PetscMalloc1(n, &real));
  CHECK(PetscMalloc1(n, &imaginary));
  CHECK(KSPCreate(PETSC_COMM_SELF, &ksp));
  CHECK(KSPSetOperators(ksp, B, mass));
  CHECK(KSPGetPC(ksp, &pc));
  CHECK(PCSetType(pc, PCLU));
  CHECK(KSPSetUp(ksp));
  CHECK(KSPComputeEigenvaluesExplicitly(ksp, n, real, imaginary));
  CHECK(KSPDestroy(&ksp));
  CHECK(PetscFree(imaginary));
  qsort(real, (size_t)n, sizeof *real, Ascending);
  return real;
}

/* J + C^T K^-1 C and M_p/M of a continuum whose water can neither move nor be compressed. */
static void Schur(PgFem fem, Mat *B, Mat *mass)
{
  PgFemSystem system;
  PetscInt    p;
  IS          all;
  Mat         K, C, KC, product, J;

  CHECK(PgFemGetSystem(fem, &system));
  CHECK(ISGetLocalSize(system.pressure, &p));
  CHECK(ISCreateStride(PETSC_COMM_SELF, p, 0, 1, &all));
  K     = Dense(system.A, system.displacement, system.displacement);
  C     = Dense(system.A, system.displacement, system.pressure);
  J     = Dense(system.A, system.pressure, system.pressure);
  *mass = Dense(system.P, all, all);
  CHECK(MatAYPX(*mass, -1.0, J, SAME_NONZERO_PATTERN)); /* P = A_pp - M_p/M, A_pp = -J, all times scale^2 */
  CHECK(MatDuplicate(C, MAT_DO_NOT_COPY_VALUES, &KC));
  CHECK(MatLUFactor(K, NULL, NULL, NULL));
  CHECK(MatMatSolve(K, C, KC));
  CHECK(MatTransposeMatMult(C, KC, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &product));
  CHECK(MatAXPY(product, -1.0, J, SAME_NONZERO_PATTERN));
  *B = product;
  CHECK(MatDestroy(&K));
  CHECK(MatDestroy(&C));
  CHECK(MatDestroy(&J));
  CHECK(MatDestroy(&KC));
  CHECK(ISDestroy(&all));
}

/* Eigenvalues, times M, of C^T K^-1 C + J against the mass matrix: the clamped unit square, impermeable. */
static void InfSup(PetscInt cells, PgFemElement element, PetscReal factor, PetscReal *smallest, PetscInt *null_modes)
{
  static const char *const side[4] = {"left", "right", "bottom", "top"};
  const PetscInt           n[2] = {cells, cells}, pressures = (cells + 1) * (cells + 1);
  const PetscReal          low[2] = {0, 0}, high[2] = {1, 1}, zero = 0.0;
  PetscReal               *eigen;
  PgFemMaterial            m;
  PgFem                    fem;
  Mat                      B, mass;

  CHECK(PetscOptionsClear(NULL));
  CHECK(PetscOptionsInsertString(NULL, "-up_ksp_type preonly -up_pc_type none"));
  PgFemMaterialDefault(&m);
  m.nu  = 0.48;
  m.k   = 0.0;
  m.K_s = m.K_f = 1e25;
  CHECK(PgFemCreate(PETSC_COMM_WORLD, &fem));
  CHECK(PgFemSetBox(fem, n, low, high));
  CHECK(PgFemSetElement(fem, element));
  CHECK(PgFemSetStabilisation(fem, factor));
  CHECK(PgFemSetMaterial(fem, NULL, &m));
  for (int s = 0; s < 4; s++) {
    CHECK(PgFemSetCondition(fem, side[s], PG_FEM_DISPLACEMENT_X, &zero));
    CHECK(PgFemSetCondition(fem, side[s], PG_FEM_DISPLACEMENT_Y, &zero));
  }
  CHECK(PgFemSetUp(fem));
  CHECK(PgFemSetUpSolver(fem, 1.0));
  Schur(fem, &B, &mass);
  eigen       = Eigenvalues(B, mass, pressures);
  *null_modes = 0;
  /* rounding of the largest, about 1, some 1e-13 */
  while (*null_modes < pressures && eigen[*null_modes] < 1e-9) (*null_modes)++;
  *smallest = eigen[*null_modes];
  CHECK(PetscFree(eigen));
  CHECK(MatDestroy(&B));
  CHECK(MatDestroy(&mass));
  CHECK(PgFemDestroy(&fem));
}

static void InfSupConstant(void **state)
{
  static const struct {
    const char  *name;
    PgFemElement element;
    PetscReal    factor;
    PetscInt     nulls;
    PetscBool    stable;
  } kind[] = {{"Q1-Q1, 3/M", PG_FEM_Q1Q1, 3.0, 1, PETSC_TRUE},
              {"Q2-Q1", PG_FEM_Q2Q1, 0.0, 1, PETSC_TRUE},
              {"Q1-Q1 not stabilised", PG_FEM_Q1Q1, 0.0, 8, PETSC_FALSE}};

  (void)state;
  for (int e = 0; e < 3; e++) {
    PetscReal eigenvalue[3];
    PetscInt  nulls = 0;
    char      name[128];
    for (int k = 0; k < 3; k++) InfSup(4 << k, kind[e].element, kind[e].factor, &eigenvalue[k], &nulls);
    (void)snprintf(name, sizeof name, "smallest eigenvalue of M_p^-1 (C^T K^-1 C + J) times M, 16 x 16 over 8 x 8, %s",
                   kind[e].name);
    if (kind[e].stable)
      VerifyRange("up inf-sup", name, 0.97, 1.03, eigenvalue[2] / eigenvalue[1], "does not depend on the mesh");
    else
      VerifyRange("up inf-sup", name, 0.0, 0.5, eigenvalue[2] / eigenvalue[1], "vanishes with the mesh: not stable");
    (void)snprintf(name, sizeof name, "the same with 16 x 16 cells, %s", kind[e].name);
    VerifyReport("up inf-sup", name, eigenvalue[2], "nu 0.48, clamped unit square");
    (void)snprintf(name, sizeof name, "modes without stiffness, the constant one among them, %s", kind[e].name);
    VerifyValue("up inf-sup", name, (PetscReal)kind[e].nulls, (PetscReal)nulls, 1.0, 0.0, "a count");
  }
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(Overshoot), cmocka_unit_test(InfSupConstant)};

int main(int argc, char *argv[])
{
  int failed;

  if (PgInitialize(&argc, &argv, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
