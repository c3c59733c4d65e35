/* The undrained strip footing: against the exact solution of the half plane, which is prescribed on the cuts; locking and
   oscillation shown, and cured. Then the case up_footing, whose ground has a bottom. */
#include <porograin/cases.h>
#include "up_exact.h"
#include "verify.h"

static const PetscReal q = 1e4, G = 4e6, size = 4.0;

static void ExactX(void *context, PetscReal time, const PetscReal x[2], PetscReal value[2])
{
  PetscReal u[2], p;

  (void)context;
  (void)time;
  Strip(q, 1.0, G, x, u, &p);
  value[0] = u[0];
}

static void ExactY(void *context, PetscReal time, const PetscReal x[2], PetscReal value[2])
{
  PetscReal u[2], p;

  (void)context;
  (void)time;
  Strip(q, 1.0, G, x, u, &p);
  value[0] = u[1];
}

/* Squares of the errors of u and p, and of p itself. */
static void Errors(void *context, const PgFemPoint *point, PetscReal value[])
{
  PetscReal u[2], p;

  (void)context;
  Strip(q, 1.0, G, point->x, u, &p);
  value[0] = PetscSqr(point->displacement[0] - u[0]) + PetscSqr(point->displacement[1] - u[1]);
  value[1] = PetscSqr(u[0]) + PetscSqr(u[1]);
  value[2] = PetscSqr(point->pressure - p);
  value[3] = PetscSqr(p);
}

/* Relative errors in the L2 norm, and the settlement of the middle against the far corner over the exact one. */
static void HalfPlane(PetscInt cells, PgFemElement element, PetscReal factor, PetscReal *displacement,
                      PetscReal *pressure, PetscReal *settlement)
{
  const PetscInt  n[2]   = {cells, cells};
  const PetscReal low[2] = {0.0, -size}, high[2] = {size, 0.0}, corner[2] = {size, -size}, top[2] = {0.0, 0.0},
                  zero = 0, traction[2] = {0.0, -q}, edge[2] = {1.0, 1.0};
  PetscReal     sum[4], u[2], p, far, middle, found = 0.0;
  PgFemMaterial m;
  PgFemNodes    nodes;
  PgFem         fem;

  CHECK(PetscOptionsClear(NULL));
  CHECK(PetscOptionsInsertString(NULL, "-up_ksp_type preonly -up_pc_type lu -up_pc_factor_mat_solver_type mumps"));
  PgFemMaterialDefault(&m);
  m.nu  = 0.25;
  m.E   = 2.0 * G * (1.0 + m.nu);
  m.k   = 0.0;
  m.K_s = m.K_f = 1e16;
  CHECK(PgFemCreate(PETSC_COMM_WORLD, &fem));
  CHECK(PgFemSetBox(fem, n, low, high));
  CHECK(PgFemSetElement(fem, element));
  CHECK(PgFemSetStabilisation(fem, factor));
  CHECK(PgFemSetMaterial(fem, NULL, &m));
  CHECK(PgFemSetCondition(fem, "left", PG_FEM_DISPLACEMENT_X, &zero));
  CHECK(PgFemSetConditionFunction(fem, "right", PG_FEM_DISPLACEMENT_X, ExactX, NULL));
  CHECK(PgFemSetConditionFunction(fem, "right", PG_FEM_DISPLACEMENT_Y, ExactY, NULL));
  CHECK(PgFemSetConditionFunction(fem, "bottom", PG_FEM_DISPLACEMENT_X, ExactX, NULL));
  CHECK(PgFemSetConditionFunction(fem, "bottom", PG_FEM_DISPLACEMENT_Y, ExactY, NULL));
  CHECK(PgFemSetLoadWithin(fem, "top", PG_FEM_TRACTION, low, edge, traction));
  CHECK(PgFemSetUp(fem));
  CHECK(PgFemStep(fem, 1.0));
  CHECK(PgFemIntegrate(fem, 4, Errors, NULL, sum));
  *displacement = PetscSqrtReal(sum[0] / sum[1]);
  *pressure     = PetscSqrtReal(sum[2] / sum[3]);
  Strip(q, 1.0, G, corner, u, &p);
  far = u[1];
  Strip(q, 1.0, G, top, u, &p);
  middle = u[1];
  CHECK(PgFemGetNodes(fem, &nodes));
  for (PetscInt i = 0; i < nodes.count; i++)
    if (nodes.x[2 * i] < 1e-9 && nodes.x[2 * i + 1] > -1e-9) found = nodes.displacement[2 * i + 1];
  *settlement = (found - far) / (middle - far);
  CHECK(PgFemDestroy(&fem));
}

static void Exact(void **state)
{
  static const struct {
    const char  *name;
    PgFemElement element;
    PetscReal    factor;
  } kind[] = {{"Q1-Q1, 3/M", PG_FEM_Q1Q1, 3.0}, {"Q2-Q1", PG_FEM_Q2Q1, 0.0}};
  PetscReal u[3], p[3], settlement[3], h[3];
  char      name[128];

  (void)state;
  for (int e = 0; e < 2; e++) {
    for (int k = 0; k < 3; k++) {
      h[k] = size / (PetscReal)(8 << k);
      HalfPlane(8 << k, kind[e].element, kind[e].factor, &u[k], &p[k], &settlement[k]);
    }
    (void)snprintf(name, sizeof name, "half plane: displacement, L2, %s", kind[e].name);
    VerifyOrder("up_footing", name, 3, h, u, 2.0, 0.2, "logarithm at the edge of the strip");
    (void)snprintf(name, sizeof name, "half plane: pressure, L2, %s", kind[e].name);
    /* p jumps there */
    VerifyOrder("up_footing", name, 3, h, p, 1.0, 0.1, "the stress jumps at the edge of the strip");
    (void)snprintf(name, sizeof name, "half plane: settlement of the middle over the exact one, 32 x 32, %s",
                   kind[e].name);
    VerifyValue("up_footing", name, 1.0, settlement[2], 0.0, 1e-3, "h^2 = 1/64 of the edge's share");
  }
  HalfPlane(32, PG_FEM_Q1Q1, 0.0, &u[0], &p[0], &settlement[0]);
  VerifyRange("up_footing", "half plane: relative error of p, 32 x 32, Q1-Q1 not stabilised", 10.0, 1e12, p[0],
              "modes of p that no equation feels: any multiple of them");
}

/* Settlement, and smallest and largest p over q below the loaded layer of cells, of the case. */
static void Case(PetscInt cells, const char element[], PetscReal *settlement, PetscReal *low, PetscReal *high)
{
  char       options[256];
  PgFemNodes nodes;
  PgFem      fem;
  PgUp       up;

  (void)snprintf(options, sizeof options,
                 "-up_ksp_type preonly -up_pc_type lu -up_pc_factor_mat_solver_type mumps -up_cells %d,%d %s",
                 (int)cells, (int)cells, element);
  CHECK(PetscOptionsClear(NULL));
  CHECK(PetscOptionsInsertString(NULL, options));
  CHECK(PgUpCreate(PETSC_COMM_WORLD, "up_footing", &up));
  CHECK(PgUpSetUp(up));
  CHECK(PgUpGetFem(up, &fem));
  CHECK(PgFemStep(fem, 1.0));
  CHECK(PgUpGetSettlement(up, settlement));
  CHECK(PgFemGetNodes(fem, &nodes));
  *low  = PETSC_MAX_REAL;
  *high = -PETSC_MAX_REAL;
  for (PetscInt i = 0; i < nodes.count; i++) {
    if (nodes.x[2 * i + 1] > 8.0 - 0.9) continue; /* the edge of the strip has a jump */
    *low  = PetscMin(*low, nodes.pressure[i] / 1e4);
    *high = PetscMax(*high, nodes.pressure[i] / 1e4);
  }
  CHECK(PgUpDestroy(&up));
}

static void Locking(void **state)
{
  PetscReal reference, settlement[3], low, high, error[3], h[3];

  (void)state;
  Case(48, "-up_element q2q1", &reference, &low, &high);
  VerifyReport("up_footing", "settlement [m], Q2-Q1, 48 x 48", reference, "reference of the lines below");
  for (int k = 0; k < 3; k++) {
    h[k] = 8.0 / (PetscReal)(8 << k);
    Case(8 << k, "", &settlement[k], &low, &high);
    error[k] = PetscAbsReal(settlement[k] / reference - 1.0);
  }
  VerifyOrder("up_footing", "settlement, Q1-Q1, 3/M", 3, h, error, 1.5, 0.2,
              "logarithm at the edge, corners that are held");
  VerifyRange("up_footing", "largest p/q one strip deep and more, 32 x 32, Q1-Q1, 3/M", 0.4, 0.6, high,
              "0.5 on the axis of a half plane, at depth b");
  VerifyRange("up_footing", "smallest p/q one strip deep and more, 32 x 32, Q1-Q1, 3/M", -0.01, 0.05, low,
              "no suction in compressed ground; corners");
  for (int k = 0; k < 3; k++) {
    char name[128];
    Case(8 << k, "-up_element q1", &settlement[k], &low, &high);
    (void)snprintf(name, sizeof name, "locking: settlement over the reference, %d x %d, Q1, water locked in", 8 << k,
                   8 << k);
    VerifyRange("up_footing", name, 0.05, 0.7, settlement[k] / reference, "volume kept in each cell leaves no bending");
  }
  for (int k = 0; k < 2; k++) {
    static const char *const nu[2]     = {"0.48", "0.4999"};
    static const PetscReal   low_q1[2] = {0.97, 0.3}, high_q1[2] = {0.99, 0.5};
    char                     options[64], name[128];
    (void)snprintf(options, sizeof options, "-up_poisson %s -up_element q2q1", nu[k]);
    Case(32, options, &reference, &low, &high);
    Case(16, options, &settlement[0], &low, &high);
    (void)snprintf(options, sizeof options, "-up_poisson %s", nu[k]);
    Case(32, options, &settlement[1], &low, &high);
    (void)snprintf(name, sizeof name, "stiff skeleton, nu %s: settlement over Q2-Q1 32 x 32, Q2-Q1 16 x 16", nu[k]);
    VerifyValue("up_footing", name, 1.0, settlement[0] / reference, 0.0, 0.01, "the edge of the strip, some h^1.5");
    (void)snprintf(name, sizeof name, "stiff skeleton, nu %s: settlement over Q2-Q1 32 x 32, Q1-Q1 32 x 32", nu[k]);
    VerifyRange("up_footing", name, low_q1[k], high_q1[k], settlement[1] / reference,
                "no water, but the skeleton itself locks the bilinear displacements: use Q2-Q1");
  }
  Case(32, "-up_stabilisation 0", &settlement[0], &low, &high);
  VerifyRange("up_footing", "largest p/q one strip deep and more, 32 x 32, Q1-Q1 not stabilised", 0.7, 2.0, high,
              "alternates from node to node about 0.5");
}

static void VerticalStress(void *context, const PgFemPoint *point, PetscReal value[])
{
  (void)context;
  value[0] = point->stress[1] - point->pressure;
  value[1] = 1.0;
}

/* The whole load arrives, wherever the edge of the strip lies in a cell: on ground with smooth sides the vertical stress
   of the mixture has the mean -q b/width, whatever the mesh. */
static void WholeLoad(void **state)
{
  static const struct {
    const char *options;
    PetscReal   b;
  } kind[] = {{"-up_cells 9,9 -up_element q2q1", 1.0},
              {"-up_cells 12,5 -up_element q2q1", 1.0},
              {"-up_cells 4,4 -up_footing_width 0.1", 0.1}};

  (void)state;
  for (size_t k = 0; k < sizeof kind / sizeof *kind; k++) {
    PetscReal sum[2];
    char      name[128];
    PgFem     fem;
    PgUp      up;
    CHECK(PetscOptionsClear(NULL));
    CHECK(PetscOptionsInsertString(NULL, "-up_ksp_type preonly -up_pc_type lu"));
    CHECK(PetscOptionsInsertString(NULL, kind[k].options));
    CHECK(PgUpCreate(PETSC_COMM_WORLD, "up_footing", &up));
    CHECK(PgUpSetUp(up));
    CHECK(PgUpGetFem(up, &fem));
    CHECK(PgFemStep(fem, 1.0));
    CHECK(PgFemIntegrate(fem, 2, VerticalStress, NULL, sum));
    (void)snprintf(name, sizeof name, "mean vertical stress [Pa], %s", kind[k].options);
    VerifyValue("up_footing", name, -1e4 * kind[k].b / 8.0, sum[0] / sum[1], 0.0, 1e-10,
                "equilibrium; rounding of 1e-16 times the condition");
    CHECK(PgUpDestroy(&up));
  }
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(Exact), cmocka_unit_test(Locking),
                                          cmocka_unit_test(WholeLoad)};

int main(int argc, char *argv[])
{
  int failed;

  if (PgInitialize(&argc, &argv, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
