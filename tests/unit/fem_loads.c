/* ranks: 1 2 4 timeout: 120 */
/* What a caller hands to the continuum and gets from it: tractions on edges and forces on nodes against conditions, plates,
   regions, numbers of nodes; a uniform pressure that nothing determines; what holds nothing is refused. */
#include <porograin/fem.h>
#include "gmsh_file.h"
#include "verify.h"

static const PetscReal zero = 0.0;

/* A column of two parts on a mesh of Gmsh, held at its sides and bottom; conditions of the top are the caller's. */
static void Column(PgFemElement element, PgFem *fem)
{
  const GmshRectangle mesh = {4, 6, {0.8, 1.2}, 0.0, 41, 0};
  PgFemMaterial       m;

  GmshWrite(&mesh, "column.msh");
  PgFemMaterialDefault(&m);
  CHECK(PgFemCreate(PETSC_COMM_WORLD, fem));
  CHECK(PgFemSetMeshFile(*fem, "column.msh"));
  CHECK(PgFemSetElement(*fem, element));
  CHECK(PgFemSetMaterial(*fem, NULL, &m));
  m.E = 4e7;
  CHECK(PgFemSetMaterial(*fem, "upper part", &m));
  CHECK(PgFemSetCondition(*fem, "left", PG_FEM_DISPLACEMENT_X, &zero));
  CHECK(PgFemSetCondition(*fem, "right", PG_FEM_DISPLACEMENT_X, &zero));
  CHECK(PgFemSetCondition(*fem, "bottom", PG_FEM_DISPLACEMENT_Y, &zero));
}

/* Mean and smallest vertical displacement of the top. */
static PetscReal Top(PgFem fem, PetscReal *least)
{
  PetscReal  sum[2] = {0.0, 0.0}, all[2], low = PETSC_MAX_REAL;
  PgFemNodes nodes;

  CHECK(PgFemGetNodes(fem, &nodes));
  for (PetscInt i = 0; i < nodes.count; i++) {
    if (nodes.x[2 * i + 1] < 1.2 - 1e-9) continue;
    low = PetscMin(low, nodes.displacement[2 * i + 1]);
    if (!nodes.owned[i]) continue;
    sum[0] += nodes.displacement[2 * i + 1];
    sum[1] += 1.0;
  }
  CHECK(MPI_Allreduce(sum, all, 2, MPIU_REAL, MPIU_SUM, PETSC_COMM_WORLD));
  CHECK(MPI_Allreduce(&low, least, 1, MPIU_REAL, MPIU_MIN, PETSC_COMM_WORLD));
  return all[0] / all[1];
}

enum { BY_CONDITION, BY_EDGES, BY_NODES, BY_PLATE, WAYS };

static void LoadTop(PgFem fem, int way, const PetscReal traction[2])
{
  PgFemEdges edges;
  PgFemNodes nodes;
  PetscReal *value;

  CHECK(PgFemGetEdges(fem, "top", &edges));
  CHECK(PgFemGetNodes(fem, &nodes));
  CHECK(PetscCalloc1(2 * PetscMax(edges.count, nodes.count), &value));
  for (PetscInt e = 0; e < edges.count; e++) {
    const PetscInt  a = edges.node[2 * e], b = edges.node[2 * e + 1];
    const PetscReal length = PetscAbsReal(nodes.x[2 * a] - nodes.x[2 * b]);
    for (int d = 0; d < 2; d++) {
      if (way == BY_EDGES) value[2 * e + d] = traction[d];
      if (way != BY_NODES) continue;
      value[2 * a + d] += 0.5 * length * traction[d];
      value[2 * b + d] += 0.5 * length * traction[d];
    }
  }
  if (way == BY_EDGES) CHECK(PgFemSetEdgeTraction(fem, "top", value));
  if (way == BY_NODES) CHECK(PgFemSetNodalForces(fem, value));
  CHECK(PetscFree(value));
}

/* Drained, two parts of different stiffness: q (h/2)(1/M_1 + 1/M_2), whichever way the load comes. */
static void WaysToLoad(void **state)
{
  const PetscReal traction[2] = {0.0, -1e4}, force = -1e4 * 0.8;
  PgFemMaterial   m;
  PetscReal       exact, least;

  (void)state;
  PgFemMaterialDefault(&m);
  exact = -1e4 * 0.6 * (1.0 / PgFemConstrainedModulus(&m) + 0.25 / PgFemConstrainedModulus(&m));
  for (int element = 0; element < 2; element++)
    for (int way = 0; way < WAYS; way++) {
      PgFem     fem;
      PetscReal found;
      if (element && way == BY_NODES) continue; /* the middles of edges have their share, too */
      Column(element ? PG_FEM_Q2Q1 : PG_FEM_Q1Q1, &fem);
      if (way == BY_CONDITION) CHECK(PgFemSetCondition(fem, "top", PG_FEM_TRACTION, traction));
      if (way == BY_PLATE) CHECK(PgFemSetCondition(fem, "top", PG_FEM_PLATE_Y, &force));
      CHECK(PgFemSetCondition(fem, "top", PG_FEM_PRESSURE, &zero));
      CHECK(PgFemSetCondition(fem, "bottom", PG_FEM_PRESSURE, &zero));
      CHECK(PgFemSetUp(fem));
      LoadTop(fem, way, traction);
      /* a step of 1e12 s: steady */
      CHECK(PgFemStep(fem, 1e12));
      found = Top(fem, &least);
      /* rounding of the direct solver, and 1e-10 that is left of the consolidation */
      assert_true(PetscAbsReal(found / exact - 1.0) < 1e-9);
      assert_true(PetscAbsReal(least / exact - 1.0) < 1e-9);
      if (way == BY_PLATE) {
        CHECK(PgFemGetPlate(fem, "top", &found));
        assert_true(PetscAbsReal(found / exact - 1.0) < 1e-9);
      }
      CHECK(PgFemDestroy(&fem));
    }
}

/* A plate that is pushed on one side only tilts nothing: all its nodes move as one. */
static void PlateStaysLevel(void **state)
{
  const PetscReal force = -8e3;
  PetscReal       mean, least;
  PgFemNodes      nodes;
  PetscReal      *value;
  PgFem           fem;

  (void)state;
  Column(PG_FEM_Q2Q1, &fem);
  CHECK(PgFemSetCondition(fem, "top", PG_FEM_PLATE_Y, &force));
  CHECK(PgFemSetCondition(fem, "top", PG_FEM_PRESSURE, &zero));
  CHECK(PgFemSetUp(fem));
  CHECK(PgFemGetNodes(fem, &nodes));
  CHECK(PetscCalloc1(2 * nodes.count, &value));
  for (PetscInt i = 0; i < nodes.count; i++)
    if (nodes.owned[i] && nodes.x[2 * i + 1] > 0.9 && nodes.x[2 * i] < 0.3) value[2 * i + 1] = -500.0;
  CHECK(PgFemSetNodalForces(fem, value));
  CHECK(PgFemStep(fem, 100.0));
  mean = Top(fem, &least);
  assert_true(mean < -1e-6);
  /* the same number is handed to all of them; the mean is rounded */
  assert_true(PetscAbsReal(least / mean - 1.0) < 1e-14);
  CHECK(PetscFree(value));
  CHECK(PgFemDestroy(&fem));
}

static void Numbers(void **state)
{
  PetscInt   all, cells, mine[2] = {0, 0}, sum[2];
  PgFemNodes nodes;
  PgFem      fem;

  (void)state;
  Column(PG_FEM_Q1Q1, &fem);
  CHECK(PgFemSetUp(fem));
  CHECK(PgFemGetSizes(fem, &all, &cells));
  assert_int_equal(all, 35);
  assert_int_equal(cells, 24);
  CHECK(PgFemGetNodes(fem, &nodes));
  for (PetscInt i = 0; i < nodes.count; i++) {
    const GmshRectangle mesh = {4, 6, {0.8, 1.2}, 0.0, 41, 0};
    PetscReal           x[2];
    assert_true(nodes.number[i] >= 0 && nodes.number[i] < all);
    /* the order of the file */
    GmshVertex(&mesh, nodes.number[i] % 5, nodes.number[i] / 5, x);
    assert_true(x[0] == nodes.x[2 * i] && x[1] == nodes.x[2 * i + 1]);
    if (!nodes.owned[i]) continue;
    mine[0]++;
    mine[1] += nodes.number[i];
  }
  CHECK(MPI_Allreduce(mine, sum, 2, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  assert_int_equal(sum[0], all);
  assert_int_equal(sum[1], all * (all - 1) / 2);
  CHECK(PgFemDestroy(&fem));
}

/* Clamped all around, neither flow nor compression: any uniform pressure will do, and the step leaves its mean. */
static void FreePressure(void **state)
{
  const PetscReal          inflow     = -1e-6;
  static const char *const side[4]    = {"left", "right", "bottom", "top"};
  const PetscInt           cells[2]   = {6, 6};
  const PetscReal          gravity[2] = {0.0, -10.0}, low[2] = {0, 0}, high[2] = {1, 1};
  PetscReal                least = PETSC_MAX_REAL, most = -PETSC_MAX_REAL, mine[2], all[2];
  PgFemMaterial            m;
  PgFemStats               stats;
  PgFemNodes               nodes;
  PgFem                    fem;

  (void)state;
  PgFemMaterialDefault(&m);
  m.k   = 0.0;
  m.K_s = m.K_f = 1e28;
  CHECK(PgFemCreate(PETSC_COMM_WORLD, &fem));
  CHECK(PgFemSetBox(fem, cells, low, high));
  CHECK(PgFemSetMaterial(fem, NULL, &m));
  CHECK(PgFemSetGravity(fem, gravity));
  for (int s = 0; s < 4; s++) {
    CHECK(PgFemSetCondition(fem, side[s], PG_FEM_DISPLACEMENT_X, &zero));
    CHECK(PgFemSetCondition(fem, side[s], PG_FEM_DISPLACEMENT_Y, &zero));
  }
  CHECK(PgFemSetUp(fem));
  CHECK(PgFemStep(fem, 1.0));
  CHECK(PgFemGetStats(fem, &stats));
  assert_true(stats.residual < 1e-9);
  CHECK(PgFemGetNodes(fem, &nodes));
  for (PetscInt i = 0; i < nodes.count; i++) {
    least = PetscMin(least, nodes.pressure[i]);
    most  = PetscMax(most, nodes.pressure[i]);
  }
  mine[0] = least;
  mine[1] = -most;
  CHECK(MPI_Allreduce(mine, all, 2, MPIU_REAL, MPIU_MIN, PETSC_COMM_WORLD));
  /* the water bears the weight rho g h = 1.7e4 Pa over the height but for the stabilisation, about a mean of zero */
  assert_true(all[0] < -5e3 && all[1] < -5e3 && all[0] > -2e4 && all[1] > -2e4);
  CHECK(PgFemDestroy(&fem));

  /* water that is pressed in has no place to go */
  CHECK(PgFemCreate(PETSC_COMM_WORLD, &fem));
  CHECK(PgFemSetBox(fem, cells, low, high));
  CHECK(PgFemSetMaterial(fem, NULL, &m));
  CHECK(PgFemSetCondition(fem, "top", PG_FEM_FLUX, &inflow));
  for (int s = 0; s < 4; s++) {
    CHECK(PgFemSetCondition(fem, side[s], PG_FEM_DISPLACEMENT_X, &zero));
    CHECK(PgFemSetCondition(fem, side[s], PG_FEM_DISPLACEMENT_Y, &zero));
  }
  CHECK(PgFemSetUp(fem));
  CHECK(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  assert_int_equal(PgFemStep(fem, 1.0), PETSC_ERR_USER_INPUT);
  CHECK(PetscPopErrorHandler());
  CHECK(PgFemDestroy(&fem));
}

/* Status of setting up a square that these conditions hold; `boundary` NULL: no more. */
static PetscErrorCode Held(PetscBool inertia, const char *const boundary[3], const PgFemQuantity quantity[3])
{
  PgFem          fem;
  PetscErrorCode err;

  CHECK(PgFemCreate(PETSC_COMM_WORLD, &fem));
  CHECK(PgFemSetInertia(fem, inertia, 0.0));
  for (int k = 0; k < 3 && boundary[k]; k++) CHECK(PgFemSetCondition(fem, boundary[k], quantity[k], &zero));
  CHECK(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  err = PgFemSetUp(fem);
  CHECK(PetscPopErrorHandler());
  CHECK(PgFemDestroy(&fem));
  return err;
}

static void NothingHolds(void **state)
{
  const PgFemQuantity x = PG_FEM_DISPLACEMENT_X, y = PG_FEM_DISPLACEMENT_Y, plate = PG_FEM_PLATE_Y, p = PG_FEM_PRESSURE;

  (void)state;
  assert_int_equal(Held(PETSC_FALSE, (const char *const[3]){"left"}, (const PgFemQuantity[3]){x}),
                   PETSC_ERR_USER_INPUT);
  assert_int_equal(Held(PETSC_FALSE, (const char *const[3]){"left", "top"}, (const PgFemQuantity[3]){p, y}),
                   PETSC_ERR_USER_INPUT);
  assert_int_equal(Held(PETSC_FALSE, (const char *const[3]){NULL}, (const PgFemQuantity[3]){x}), PETSC_ERR_USER_INPUT);
  /* a plate keeps from turning, not from sinking */
  assert_int_equal(Held(PETSC_FALSE, (const char *const[3]){"left", "top"}, (const PgFemQuantity[3]){x, plate}),
                   PETSC_ERR_USER_INPUT);
  assert_int_equal(Held(PETSC_FALSE, (const char *const[3]){"left", "bottom"}, (const PgFemQuantity[3]){x, y}), 0);
  assert_int_equal(Held(PETSC_TRUE, (const char *const[3]){NULL}, (const PgFemQuantity[3]){x}), 0);
  assert_int_equal(Held(PETSC_FALSE, (const char *const[3]){"left", "roof"}, (const PgFemQuantity[3]){x, y}),
                   PETSC_ERR_USER_INPUT);
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(WaysToLoad), cmocka_unit_test(PlateStaysLevel),
                                          cmocka_unit_test(Numbers), cmocka_unit_test(FreePressure),
                                          cmocka_unit_test(NothingHolds)};

int main(int argc, char *argv[])
{
  int failed;

  if (PgInitialize(&argc, &argv, NULL)) return 1;
  if (PetscOptionsInsertString(NULL, "-up_ksp_rtol 1e-12")) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
