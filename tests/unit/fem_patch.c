/* ranks: 1 2 4 timeout: 120 */
/* Patch tests of the continuum on distorted meshes: what the elements can represent comes out to rounding, from loads,
   held values and the change of volume, with compressible constituents, in one step from rest. Meshes of Gmsh in both
   formats, cells of either orientation, two regions. */
#include <porograin/fem.h>
#include "gmsh_file.h"
#include "verify.h"

#define DIRECT "-up_ksp_type preonly -up_pc_type lu -up_pc_factor_mat_solver_type mumps"

static const PgFemMaterial material = {.E     = 2e7,
                                       .nu    = 0.3,
                                       .alpha = 0.8,
                                       .K_s   = 3e8,
                                       .K_f   = 1e8,
                                       .n     = 0.35,
                                       .k     = 1e-11,
                                       .mu_f  = 1e-3,
                                       .rho_s = 2600.0,
                                       .rho_f = 1000.0};

/* u = offset + F x, p constant, such that alpha tr F + S p = 0: no water need move. */
typedef struct {
  PetscReal offset[2], F[2][2], p, stress[3]; /* of the mixture */
} Linear;

static Linear Field(const PgFemMaterial *m)
{
  Linear          l = {.offset = {1e-3, -2e-3}, .F = {{3e-3, 1.5e-3}, {-0.7e-3, 0.0}}, .p = 2e4};
  const PetscReal G = PgFemShearModulus(m), lambda = PgFemConstrainedModulus(m) - 2.0 * G;
  PetscReal       trace;

  l.F[1][1]   = -PgFemStorage(m) * l.p / m->alpha - l.F[0][0];
  trace       = l.F[0][0] + l.F[1][1];
  l.stress[0] = lambda * trace + 2.0 * G * l.F[0][0] - m->alpha * l.p;
  l.stress[1] = lambda * trace + 2.0 * G * l.F[1][1] - m->alpha * l.p;
  l.stress[2] = G * (l.F[0][1] + l.F[1][0]);
  return l;
}

static PetscReal At(const Linear *l, int d, const PetscReal x[2])
{
  return l->offset[d] + l->F[d][0] * x[0] + l->F[d][1] * x[1];
}

static void DisplacementX(void *context, PetscReal time, const PetscReal x[2], PetscReal value[2])
{
  (void)time;
  value[0] = At((const Linear *)context, 0, x);
}

static void DisplacementY(void *context, PetscReal time, const PetscReal x[2], PetscReal value[2])
{
  (void)time;
  value[0] = At((const Linear *)context, 1, x);
}

/* Largest error over the largest value, displacement and pressure. */
static void Errors(PgFem fem, const Linear *l, PetscReal error[2])
{
  PetscReal  mine[2] = {0.0, 0.0};
  PgFemNodes nodes;

  CHECK(PgFemGetNodes(fem, &nodes));
  for (PetscInt i = 0; i < nodes.count; i++) {
    for (int d = 0; d < 2; d++)
      mine[0] = PetscMax(mine[0], PetscAbsReal(nodes.displacement[2 * i + d] - At(l, d, &nodes.x[2 * i])) / 5e-3);
    mine[1] = PetscMax(mine[1], PetscAbsReal(nodes.pressure[i] / l->p - 1.0));
  }
  CHECK(MPI_Allreduce(mine, error, 2, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
}

static void Patch(PgFemElement element, PetscInt version, PetscReal theta)
{
  const GmshRectangle mesh           = {7, 5, {1.4, 0.9}, 0.3, version, 3};
  Linear              l              = Field(&material);
  const PetscReal     traction[3][2] = {
          {l.stress[0], l.stress[2]}, {l.stress[2], l.stress[1]}, {-l.stress[2], -l.stress[1]}};
  PetscReal error[2];
  PgFem     fem;

  GmshWrite(&mesh, "patch.msh");
  CHECK(PgFemCreate(PETSC_COMM_WORLD, &fem));
  CHECK(PgFemSetMeshFile(fem, "patch.msh"));
  CHECK(PgFemSetElement(fem, element));
  CHECK(PgFemSetTheta(fem, theta, 0));
  CHECK(PgFemSetMaterial(fem, NULL, &material));
  CHECK(PgFemSetMaterial(fem, "upper part", &material));
  CHECK(PgFemSetConditionFunction(fem, "left", PG_FEM_DISPLACEMENT_X, DisplacementX, &l));
  CHECK(PgFemSetConditionFunction(fem, "left", PG_FEM_DISPLACEMENT_Y, DisplacementY, &l));
  CHECK(PgFemSetCondition(fem, "left", PG_FEM_PRESSURE, &l.p));
  CHECK(PgFemSetCondition(fem, "right", PG_FEM_TRACTION, traction[0]));
  CHECK(PgFemSetCondition(fem, "top", PG_FEM_TRACTION, traction[1]));
  CHECK(PgFemSetCondition(fem, "bottom", PG_FEM_TRACTION, traction[2]));
  CHECK(PgFemSetUp(fem));
  CHECK(PgFemStep(fem, 10.0));
  Errors(fem, &l, error);
  /* rounding of 1e-16 times the condition of the matrix, some 1e4 for so few cells */
  assert_true(error[0] < 1e-11);
  assert_true(error[1] < 1e-11);
  /* nothing changes any more */
  CHECK(PgFemStep(fem, 10.0));
  Errors(fem, &l, error);
  assert_true(error[0] < 1e-11 && error[1] < 1e-11);
  CHECK(PgFemDestroy(&fem));
}

static void ConstantStrain(void **state)
{
  (void)state;
  for (int version = 0; version < 2; version++) {
    Patch(PG_FEM_Q1Q1, version ? 41 : 22, 1.0);
    Patch(PG_FEM_Q2Q1, version ? 41 : 22, 0.5);
  }
}

/* Water that seeps with a constant velocity through a skeleton without strain: alpha grad p = rho g. */
typedef struct {
  PetscReal gradient[2], alpha;
} Seep;

static PetscReal SeepAt(const Seep *s, const PetscReal x[2])
{
  return 5e3 + s->gradient[0] * x[0] + s->gradient[1] * x[1];
}

static void SeepState(void *context, const PetscReal x[2], PetscReal value[3])
{
  value[2] = SeepAt((const Seep *)context, x);
}

static void SeepPressure(void *context, PetscReal time, const PetscReal x[2], PetscReal value[2])
{
  (void)time;
  value[0] = SeepAt((const Seep *)context, x);
}

static void SeepStress(void *context, PetscReal time, const PetscReal x[2], PetscReal value[2])
{
  const Seep *s = (const Seep *)context;

  (void)time;
  value[0] = -s->alpha * SeepAt(s, x);
}

static void Seepage(void **state)
{
  static const char *const name[4]    = {"right", "top", "left", "bottom"};
  const GmshRectangle      mesh       = {6, 6, {1.0, 1.0}, 0.3, 22, 0};
  const PgFemMaterial     *m          = &material;
  const PetscReal          gravity[2] = {1.0, -9.0}, zero = 0.0;
  PetscReal                flux[2], worst[2]              = {0.0, 0.0}, all[2];
  Seep                     seep = {.alpha = material.alpha};
  PgFemNodes               nodes;

  (void)state;
  for (int d = 0; d < 2; d++) {
    seep.gradient[d] = ((1.0 - m->n) * m->rho_s + m->n * m->rho_f) * gravity[d] / m->alpha;
    flux[d]          = m->k / m->mu_f * (m->rho_f * gravity[d] - seep.gradient[d]);
  }
  GmshWrite(&mesh, "seepage.msh");
  for (int element = 0; element < 2; element++) {
    PgFem fem;
    CHECK(PgFemCreate(PETSC_COMM_WORLD, &fem));
    CHECK(PgFemSetMeshFile(fem, "seepage.msh"));
    CHECK(PgFemSetElement(fem, element ? PG_FEM_Q2Q1 : PG_FEM_Q1Q1));
    CHECK(PgFemSetTheta(fem, 0.7, 0));
    CHECK(PgFemSetMaterial(fem, NULL, m));
    CHECK(PgFemSetGravity(fem, gravity));
    CHECK(PgFemSetInitial(fem, SeepState, &seep));
    CHECK(PgFemSetCondition(fem, "left", PG_FEM_DISPLACEMENT_X, &zero));
    CHECK(PgFemSetCondition(fem, "left", PG_FEM_DISPLACEMENT_Y, &zero));
    for (int s = 0; s < 2; s++) {
      CHECK(PgFemSetCondition(fem, name[s], PG_FEM_FLUX, &flux[s]));
      CHECK(PgFemSetConditionFunction(fem, name[s + 2], PG_FEM_PRESSURE, SeepPressure, &seep));
    }
    for (int s = 0; s < 4; s++)
      if (s != 2) CHECK(PgFemSetConditionFunction(fem, name[s], PG_FEM_NORMAL_STRESS, SeepStress, &seep));
    CHECK(PgFemSetUp(fem));
    for (int k = 0; k < 3; k++) CHECK(PgFemStep(fem, 10.0));
    CHECK(PgFemGetNodes(fem, &nodes));
    for (PetscInt i = 0; i < nodes.count; i++) {
      worst[0] = PetscMax(worst[0], PetscAbsReal(nodes.pressure[i] - SeepAt(&seep, &nodes.x[2 * i])) / 3e4);
      for (int d = 0; d < 2; d++) worst[1] = PetscMax(worst[1], PetscAbsReal(nodes.displacement[2 * i + d]) / 1e-3);
    }
    CHECK(MPI_Allreduce(worst, all, 2, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
    /* p is some 3e4 Pa, which over E would be 1e-3 m: rounding of that times the condition of the matrix */
    assert_true(all[0] < 1e-11);
    assert_true(all[1] < 1e-11);
    CHECK(PgFemDestroy(&fem));
  }
}

/* A rigid plate presses a closed box of distorted cells, along x or y: one strain, one pressure, whatever the cells. */
static void Plate(PgFemElement element, int along)
{
  static const char *const side[2][4]   = {{"left", "bottom", "top", "right"}, {"bottom", "left", "right", "top"}};
  const GmshRectangle      mesh         = {6, 5, {1.4, 0.9}, 0.3, 41, 4};
  const PgFemQuantity      displacement = along ? PG_FEM_DISPLACEMENT_Y : PG_FEM_DISPLACEMENT_X,
                      across            = along ? PG_FEM_DISPLACEMENT_X : PG_FEM_DISPLACEMENT_Y;
  const PetscReal zero = 0.0, force = -3e4, S = PgFemStorage(&material), alpha = material.alpha;
  const PetscReal strain   = force / mesh.size[1 - along] / (PgFemConstrainedModulus(&material) + alpha * alpha / S);
  PetscReal       worst[2] = {0.0, 0.0}, all[2], way;
  PgFemNodes      nodes;
  PgFem           fem;

  GmshWrite(&mesh, "plate.msh");
  CHECK(PgFemCreate(PETSC_COMM_WORLD, &fem));
  CHECK(PgFemSetMeshFile(fem, "plate.msh"));
  CHECK(PgFemSetElement(fem, element));
  CHECK(PgFemSetMaterial(fem, NULL, &material));
  CHECK(PgFemSetCondition(fem, side[along][0], displacement, &zero));
  CHECK(PgFemSetCondition(fem, side[along][1], across, &zero));
  CHECK(PgFemSetCondition(fem, side[along][2], across, &zero));
  CHECK(PgFemSetCondition(fem, side[along][3], along ? PG_FEM_PLATE_Y : PG_FEM_PLATE_X, &force));
  CHECK(PgFemSetUp(fem));
  for (int k = 0; k < 2; k++) CHECK(PgFemStep(fem, 10.0)); /* in the second one nothing changes */
  CHECK(PgFemGetPlate(fem, side[along][3], &way));
  CHECK(PgFemGetNodes(fem, &nodes));
  for (PetscInt i = 0; i < nodes.count; i++) {
    const PetscReal u = nodes.displacement[2 * i + along] / (strain * mesh.size[along]);
    worst[0]          = PetscMax(worst[0], PetscAbsReal(u - nodes.x[2 * i + along] / mesh.size[along]));
    worst[1]          = PetscMax(worst[1], PetscAbsReal(nodes.pressure[i] / (-alpha * strain / S) - 1.0));
  }
  CHECK(MPI_Allreduce(worst, all, 2, MPIU_REAL, MPIU_MAX, PETSC_COMM_WORLD));
  /* rounding of 1e-16 times the condition of the matrix, some 1e4 for so few cells */
  assert_true(all[0] < 1e-11 && all[1] < 1e-11);
  assert_true(PetscAbsReal(way / (strain * mesh.size[along]) - 1.0) < 1e-11);
  CHECK(PgFemDestroy(&fem));
}

static void Plates(void **state)
{
  (void)state;
  Plate(PG_FEM_Q1Q1, 1);
  Plate(PG_FEM_Q2Q1, 0);
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(ConstantStrain), cmocka_unit_test(Seepage),
                                          cmocka_unit_test(Plates)};

int main(int argc, char *argv[])
{
  int failed;

  if (PgInitialize(&argc, &argv, NULL)) return 1;
  if (PetscOptionsInsertString(NULL, DIRECT)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
