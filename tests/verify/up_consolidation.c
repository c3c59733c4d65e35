/* ranks: 1 2 */
/* Consolidation of the continuum: cases up_terzaghi and up_mandel against their series, with orders in the size of
   cells and in the step. */
#include <porograin/cases.h>
#include "up_exact.h"
#include "verify.h"

static PetscMPIInt ranks;

static void Options(const char text[])
{
  CHECK(PetscOptionsClear(NULL));
  CHECK(PetscOptionsInsertString(NULL, text));
}

/* Small systems many times over: directly. */
#define SOLVER "-up_ksp_type preonly -up_pc_type lu -up_pc_factor_mat_solver_type mumps "

typedef struct {
  PgUp          up;
  PgFem         fem;
  PgFemMaterial m;
  PetscReal     unit; /* time that belongs to T = 1 [s] */
} Problem;

static void Start(Problem *p, const char name[], PetscReal length, const char options[])
{
  Options(options);
  CHECK(PgUpCreate(PETSC_COMM_WORLD, name, &p->up));
  CHECK(PgUpSetUp(p->up));
  CHECK(PgUpGetFem(p->up, &p->fem));
  CHECK(PgFemGetMaterial(p->fem, &p->m));
  p->unit = length * length / ExactDiffusivity(&p->m);
}

static void Steps(Problem *p, PetscReal T, PetscInt steps)
{
  for (PetscInt k = 0; k < steps; k++) CHECK(PgFemStep(p->fem, T * p->unit / (PetscReal)steps));
}

/* ---- Terzaghi ---- */

typedef struct {
  PetscReal T, load, first; /* first: p at first over the load */
} Column;

static void ColumnError(void *context, const PgFemPoint *point, PetscReal value[])
{
  const Column   *c     = (const Column *)context;
  const PetscReal exact = c->first * TerzaghiPressure(1.0 - point->x[1], c->T);

  value[0] = PetscSqr(point->pressure / c->load - exact);
  value[1] = PetscSqr(exact);
}

/* Relative error of p in the L2 norm at T = 0.1, and of the settlement over its end. */
static void TerzaghiErrors(const char element[], PetscReal nu, PetscInt cells, PetscReal *pressure,
                           PetscReal *settlement)
{
  Column    column = {.T = 0.1, .load = 1e4};
  PetscReal sum[2], way, M;
  char      options[256];
  Problem   p;

  (void)snprintf(options, sizeof options, SOLVER "-up_cells 1,%d -up_poisson %g %s", (int)cells, (double)nu, element);
  Start(&p, "up_terzaghi", 1.0, options);
  column.first = TerzaghiFirst(&p.m);
  Steps(&p, column.T, cells * cells / 2);
  CHECK(PgFemIntegrate(p.fem, 2, ColumnError, &column, sum));
  CHECK(PgUpGetSettlement(p.up, &way));
  M           = ExactM(&p.m);
  *pressure   = PetscSqrtReal(sum[0] / sum[1]);
  *settlement = PetscAbsReal(way / (column.load / M) - 1.0 +
                             p.m.alpha * column.first * (1.0 - TerzaghiSettlement(column.T)));
  CHECK(PgUpDestroy(&p.up));
}

static void Terzaghi(void **state)
{
  static const struct {
    const char *name, *options;
    PetscReal   nu;
  } element[]          = {{"Q1-Q1, 3/M", "", 0.2},
                          {"Q2-Q1", "-up_element q2q1", 0.2},
                          {"Q2-Q1", "-up_element q2q1", 0.48},
                          {"Q1-Q1, 3/M", "", 0.48},
                          {"Q1-Q1, 3/M, compressible", "-up_biot 0.8 -up_bulk_grains 6e7 -up_bulk_water 1e7", 0.2},
                          {"Q1-Q1, not stabilised", "-up_stabilisation 0", 0.2}};
  const PetscInt count = ranks == 1 ? 6 : 1;

  (void)state;
  for (PetscInt e = 0; e < count; e++) {
    PetscReal pressure[3], settlement[3], h[3];
    char      name[128];
    for (int k = 0; k < 3; k++) {
      h[k] = 1.0 / (10.0 * (PetscReal)(1 << k));
      TerzaghiErrors(element[e].options, element[e].nu, 10 << k, &pressure[k], &settlement[k]);
    }
    (void)snprintf(name, sizeof name, "p(z) at T = 0.1, L2, dt = 0.2 h^2, nu = %g, %s", (double)element[e].nu,
                   element[e].name);
    /* the next term of the error goes with h^4: some h^2 of the one that is left */
    VerifyOrder("up_terzaghi", name, 3, h, pressure, 2.0, 0.1, "elements and backward Euler with dt as h^2");
    (void)snprintf(name, sizeof name, "settlement at T = 0.1 over its end, nu = %g, %s", (double)element[e].nu,
                   element[e].name);
    VerifyOrder("up_terzaghi", name, 3, h, settlement, 2.0, 0.1, "elements and backward Euler with dt as h^2");
  }
}

/* The slowest mode of the column, unloaded, as 20 cells have it: p = P cos(pi y/2) and u = U sin(pi y/2) at the nodes, in
   equilibrium there; both decay as exp(-rate t) but for the steps. */
typedef struct {
  PetscReal U, rate;
} Decay;

static Decay DecayOf(const PgFemMaterial *m)
{
  const PetscReal h = 1.0 / 20.0, k = 0.5 * PETSC_PI * h, M = ExactM(m), second = 2.0 - 2.0 * PetscCosReal(k);
  Decay           d;

  /* K u = C p and C' u' + (S + J) p' + D p = 0 at a node; J is 3/M h^2/12 times the second difference */
  d.U    = 1e4 * m->alpha * h * PetscSinReal(k) / (M * second);
  d.rate = m->k / m->mu_f * second / h /
           (PetscSqr(m->alpha * PetscSinReal(k)) * h / (M * second) + 3.0 / M * h * second / 12.0 +
            ExactStorage(m) * h * (2.0 + PetscCosReal(k)) / 3.0);
  return d;
}

static void Mode(void *context, const PetscReal x[2], PetscReal value[3])
{
  value[0] = 0.0;
  value[1] = ((const Decay *)context)->U * PetscSinReal(0.5 * PETSC_PI * x[1]);
  value[2] = 1e4 * PetscCosReal(0.5 * PETSC_PI * x[1]);
}

/* Settlement of the top at T = 0.2 by so many steps, over the exact one. */
static PetscReal ModeSettlement(const char options[], PetscInt steps)
{
  PetscReal way;
  Decay     decay;
  Problem   p;

  Options(options);
  CHECK(PgUpCreate(PETSC_COMM_WORLD, "up_terzaghi", &p.up));
  CHECK(PgUpGetFem(p.up, &p.fem));
  CHECK(PgFemGetMaterial(p.fem, &p.m));
  decay = DecayOf(&p.m);
  CHECK(PgFemSetInitial(p.fem, Mode, &decay));
  CHECK(PgUpSetUp(p.up));
  p.unit = 1.0 / ExactDiffusivity(&p.m);
  Steps(&p, 0.2, steps);
  CHECK(PgUpGetSettlement(p.up, &way));
  CHECK(PgUpDestroy(&p.up));
  return -way / (decay.U * PetscExpReal(-decay.rate * 0.2 * p.unit));
}

static void TimeStep(void **state)
{
  (void)state;
  if (ranks > 1) skip();
  for (int method = 0; method < 2; method++) {
    const char *const options = method ? SOLVER "-up_cells 1,20 -up_terzaghi_load 0 -up_theta 0.5"
                                       : SOLVER "-up_cells 1,20 -up_terzaghi_load 0";
    PetscReal         error[3], h[3];
    for (int k = 0; k < 3; k++) {
      h[k]     = 0.2 / (PetscReal)(10 << k);
      error[k] = PetscAbsReal(ModeSettlement(options, 10 << k) - 1.0);
    }
    VerifyOrder("up_terzaghi",
                method ? "decay of the slowest mode to T = 0.2 in dt, theta 0.5"
                       : "decay of the slowest mode to T = 0.2 in dt, backward Euler",
                3, h, error, method ? 2.0 : 1.0, 0.1, "the exact decay of what the cells can represent");
  }
}

/* ---- Mandel ---- */

typedef struct {
  const PgFemMaterial *m;
  PetscReal            T, force;
} Slab;

static void SlabError(void *context, const PgFemPoint *point, PetscReal value[])
{
  const Slab *s = (const Slab *)context;
  PetscReal   exact, plate;

  Mandel(s->m, s->force, 1.0, point->x[0], s->T, &exact, &plate);
  value[0] = PetscSqr(point->pressure - exact);
  value[1] = PetscSqr(exact);
}

/* Compressible water and grains, so that every term of Eq. 9 counts. */
#define SLAB "-up_biot 0.8 -up_bulk_grains 2e8 -up_bulk_water 5e7 -up_poisson 0.2 "

static void MandelErrors(const char element[], PetscInt cells, PetscReal *pressure, PetscReal *plate)
{
  PetscReal sum[2], way, exact, none;
  char      options[256];
  Problem   p;
  Slab      slab;

  (void)snprintf(options, sizeof options, SOLVER SLAB "-up_cells %d,%d %s", (int)cells, (int)(cells / 4), element);
  Start(&p, "up_mandel", 1.0, options);
  slab = (Slab){&p.m, 0.1, 1e4};
  Steps(&p, slab.T, cells * cells / 2);
  CHECK(PgFemIntegrate(p.fem, 2, SlabError, &slab, sum));
  CHECK(PgUpGetSettlement(p.up, &way));
  Mandel(&p.m, slab.force, 1.0, 0.0, slab.T, &none, &exact);
  *pressure = PetscSqrtReal(sum[0] / sum[1]);
  *plate    = PetscAbsReal((way + exact) / exact);
  CHECK(PgUpDestroy(&p.up));
}

static void MandelOrders(void **state)
{
  static const char *const name[2] = {"Q1-Q1, 3/M", "Q2-Q1"}, *const options[2] = {"", "-up_element q2q1"};

  (void)state;
  for (int e = 0; e < (ranks == 1 ? 2 : 1); e++) {
    PetscReal pressure[3], plate[3], h[3];
    char      what[128];
    for (int k = 0; k < 3; k++) {
      h[k] = 1.0 / (8.0 * (PetscReal)(1 << k));
      MandelErrors(options[e], 8 << k, &pressure[k], &plate[k]);
    }
    (void)snprintf(what, sizeof what, "p at T = 0.1, L2, dt = 0.2 h^2, %s", name[e]);
    VerifyOrder("up_mandel", what, 3, h, pressure, 2.0, 0.15, "elements and backward Euler with dt as h^2");
    (void)snprintf(what, sizeof what, "way of the plate at T = 0.1, %s", name[e]);
    VerifyOrder("up_mandel", what, 3, h, plate, 2.0, 0.15, "elements and backward Euler with dt as h^2");
  }
}

/* The pressure in the core rises above its first value before it falls. */
static void MandelCryer(void **state)
{
  PetscReal highest = 0.0, when = 0.0, exact_highest = 0.0, exact_when = 0.0, first, undrained, nu_u, B, none, now;
  Problem   p;

  (void)state;
  Start(&p, "up_mandel", 1.0, SOLVER SLAB "-up_cells 24,6 -up_theta 0.5 -up_start_steps 4");
  Undrained(&p.m, &nu_u, &B);
  undrained = 1e4 * B * (1.0 + nu_u) / 3.0;
  for (PetscInt k = 0; k < 4; k++) CHECK(PgFemStep(p.fem, 1e-4 * p.unit));
  CHECK(PgUpGetProbe(p.up, &first));
  Mandel(&p.m, 1e4, 1.0, 0.0, 4e-4, &now, &none);
  VerifyValue("up_mandel", "p in the core at T = 4e-4 over F B (1 + nu_u)/(3 a)", now / undrained, first / undrained,
              0.0, 6e-3, "four steps of first order, and a drained layer of half a cell: the half of 0.011");
  for (PetscInt k = 1; k <= 100; k++) {
    const PetscReal T = 4e-4 + 4e-3 * (PetscReal)k;
    PetscReal       exact;
    CHECK(PgFemStep(p.fem, 4e-3 * p.unit));
    CHECK(PgUpGetProbe(p.up, &now));
    Mandel(&p.m, 1e4, 1.0, 0.0, T, &exact, &none);
    if (now > highest) {
      highest = now;
      when    = T;
    }
    if (exact > exact_highest) {
      exact_highest = exact;
      exact_when    = T;
    }
  }
  VerifyValue("up_mandel", "highest p in the core over F B (1 + nu_u)/(3 a)", exact_highest / undrained,
              highest / undrained, 0.0, 1e-3, "h^2 = 2e-3 of the part that varies");
  /* a flat top: a millionth of p there is some steps */
  VerifyValue("up_mandel", "T when p in the core is highest", exact_when, when, 1.0, 9e-3,
              "two steps, the top is flat");
  assert_true(highest > 1.02 * first);
  CHECK(PgUpDestroy(&p.up));
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(Terzaghi), cmocka_unit_test(TimeStep),
                                          cmocka_unit_test(MandelOrders), cmocka_unit_test(MandelCryer)};

int main(int argc, char *argv[])
{
  int failed;

  if (PgInitialize(&argc, &argv, NULL)) return 1;
  if (MPI_Comm_size(PETSC_COMM_WORLD, &ranks)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
