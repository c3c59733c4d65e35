/* ranks: 1 2 4 */
/* Boundary kinds of model section 6: who has a prescribed pressure, what is done to velocities, the inflow of the Darcy
   scheme; surface tracking with its hysteresis; discs outside the water. */
#include "ground.h"

static const Packing   disorder = {10, 12, 5e-3, 0.15, 0.15};
static const Packing   lattice  = {10, 12, 5e-3, 0.0, 0.0};
static const PetscReal dt       = 1e-4;

#define SOLVER " -pressure_ksp_type cg -pressure_pc_type jacobi -pressure_ksp_rtol 1e-12 "

static PetscBool On(PetscReal side, PgSide s) { return (PetscBool)(((int)side >> s) & 1); }

/* Velocities of the discs without symmetry. */
static void Move(Ground *g)
{
  PetscReal *v = GroundCore(g, PG_VELOCITY);
  for (PetscInt a = 0; a < GroundOwned(g); a++) {
    v[2 * a]     = 0.03 * Noise(GroundIds(g)[a], 21) + 0.01;
    v[2 * a + 1] = 0.03 * Noise(GroundIds(g)[a], 22) - 0.02;
  }
}

static void Step(Ground *g)
{
  CHECK(PgPorePredict(g->pore, dt));
  CHECK(PgPoreCorrect(g->pore, dt));
}

/* Two drained sides of different pressure; a disc of both takes the first of left, right, bottom, top. The others have
   none, whatever the kind. */
static void PrescribedPressures(void **state)
{
  (void)state;
  for (int kind = GROUND_DARCY; kind <= GROUND_NS; kind++) {
    Ground     g;
    PetscReal *side, *fixed, *p;
    PetscInt   seen = 0;

    GroundCreate(PETSC_COMM_WORLD, (GroundKind)kind,
                 SOLVER "-bc_left_pressure 2e5 -bc_bottom_pressure 3e5 -bc_right impermeable -bc_top flux "
                        "-bc_top_flux -0.01",
                 &g);
    GroundFill(&g, PackingCount(&disorder), PackingPlace, &disorder);
    Move(&g);
    CHECK(PgPoreSetUp(g.pore, dt));
    Step(&g);
    side  = GroundArray(&g, "side");
    fixed = GroundArray(&g, "pressure_fixed");
    p     = GroundArray(&g, "pressure");
    for (PetscInt a = 0; a < GroundOwned(&g); a++) {
      const PetscBool left = On(side[a], PG_SIDE_LEFT), bottom = On(side[a], PG_SIDE_BOTTOM);
      assert_true(fixed[a] == (left || bottom ? 1.0 : 0.0));
      if (left)
        assert_true(p[a] == 2e5);
      else if (bottom)
        assert_true(p[a] == 3e5);
      else
        assert_true(p[a] != 2e5 && p[a] != 3e5 && p[a] != 1e5);
      seen += left && bottom;
    }
    assert_int_equal((int)GroundTotal(&g, seen), 1);
    GroundDestroy(&g);
  }
}

/* Impermeable and flux sides set the normal velocity of the water, in u~ and in u^n+1; nothing else is touched, so the
   rest obeys Eq. 47; corners obey both of their sides. */
static void VelocitiesOfTheSides(void **state)
{
  const PetscReal flux[2] = {0.04, -0.13}; /* of bottom and top */
  Ground          g;
  PetscReal      *predicted, *side, *u, *v, *tilde, *n, *p, *drag, *grad;
  PgField         pressure;
  PetscInt        corners = 0, sides[PG_SIDE_COUNT] = {0};

  (void)state;
  GroundCreate(PETSC_COMM_WORLD, GROUND_NS,
               SOLVER "-ns_theta 0.8 -bc_left impermeable -bc_right drained -bc_bottom flux -bc_bottom_flux 0.04 "
                      "-bc_top flux -bc_top_flux -0.13",
               &g);
  GroundFill(&g, PackingCount(&disorder), PackingPlace, &disorder);
  Move(&g);
  CHECK(PgPoreSetUp(g.pore, dt));
  CHECK(PgPorePredict(g.pore, dt));
  predicted = GroundGatherField(&g, "fluid_predictor", 2);
  CHECK(PgPoreCorrect(g.pore, dt));
  side     = GroundArray(&g, "side");
  u        = GroundArray(&g, "fluid_velocity");
  v        = GroundCore(&g, PG_VELOCITY);
  tilde    = GroundArray(&g, "fluid_predictor");
  n        = GroundArray(&g, "porosity");
  p        = GroundArray(&g, "pressure");
  drag     = GroundArray(&g, "drag");
  pressure = GroundField(&g, "pressure");
  CHECK(PgParticlesHalo(g.particles, 1, &pressure));
  CHECK(PetscMalloc1(2 * GroundOwned(&g) + 1, &grad));
  CHECK(PgSphGradient(g.sph, p, grad));
  for (PetscInt a = 0; a < GroundOwned(&g); a++) {
    const PetscBool bottom = On(side[a], PG_SIDE_BOTTOM), top = On(side[a], PG_SIDE_TOP);
    const PetscBool set[2] = {On(side[a], PG_SIDE_LEFT), (PetscBool)(bottom || top)};

    for (int i = 0; i < 2; i++) {
      const PetscReal w = i == 0 ? 0.0 : flux[top];
      if (set[i]) {
        /* v + w/n, or v alone: the same operations */
        assert_true(u[2 * a + i] == v[2 * a + i] + w / n[a]);
        assert_true(tilde[2 * a + i] == u[2 * a + i]);
      } else {
        const PetscReal step = -0.8 * dt / 1000.0 * (grad[2 * a + i] - drag[2 * a + i]);
        assert_true(tilde[2 * a + i] == predicted[2 * GroundIds(&g)[a] + i]);
        /* three roundings; the gradient is of the excess over g.x = 0, which is p itself */
        NEAR(u[2 * a + i], tilde[2 * a + i] + step, 1e-15 * (1.0 + PetscAbsReal(step)));
      }
    }
    corners += set[0] && set[1];
    for (int s = 0; s < PG_SIDE_COUNT; s++) sides[s] += On(side[a], (PgSide)s);
  }
  assert_int_equal((int)GroundTotal(&g, corners), 2);
  for (int s = 0; s < PG_SIDE_COUNT; s++) assert_true(GroundTotal(&g, sides[s]) >= 9);
  CHECK(PetscFree(grad));
  CHECK(PetscFree(predicted));
  GroundDestroy(&g);
}

/* Darcy: the inflow of a disc of a flux side, q_in 2r, is a source of water; impermeable and natural sides have none.
   With discs at rest k_p dV lap p = -q_in 2r in the paper's form, which conserves: all of it leaves through the drained
   side. */
static void InflowOfTheDarcyScheme(void **state)
{
  const PetscReal k_p = 6.5e-7;
  Ground          g;
  PetscReal      *side, *r, *p, *volume, *lap, *fixed, in = 0.0, out = 0.0;
  PgField         pressure;

  (void)state;
  GroundCreate(PETSC_COMM_WORLD, GROUND_DARCY,
               SOLVER "-bc_left flux -bc_left_flux 0.02 -bc_right flux -bc_right_flux 0.05 -bc_bottom drained "
                      "-bc_top flux -bc_top_flux -0.13",
               &g);
  GroundFill(&g, PackingCount(&disorder), PackingPlace, &disorder);
  CHECK(PgPoreSetUp(g.pore, dt));
  Step(&g);
  side     = GroundArray(&g, "side");
  r        = GroundCore(&g, PG_RADIUS);
  p        = GroundArray(&g, "pressure");
  fixed    = GroundArray(&g, "pressure_fixed");
  volume   = GroundArray(&g, "volume");
  pressure = GroundField(&g, "pressure");
  CHECK(PgParticlesHalo(g.particles, 1, &pressure));
  CHECK(PetscMalloc1(GroundOwned(&g) + 1, &lap));
  CHECK(PgSphLaplacian(g.sph, p, lap));
  for (PetscInt a = 0; a < GroundOwned(&g); a++) {
    const PetscReal width  = 2.0 * r[a];
    const PetscReal inflow = (On(side[a], PG_SIDE_LEFT) ? 0.02 * width : 0.0) +
                             (On(side[a], PG_SIDE_RIGHT) ? -0.05 * width : 0.0) +
                             (On(side[a], PG_SIDE_TOP) ? 0.13 * width : 0.0);
    if (fixed[a] != 0.0) {
      assert_true(On(side[a], PG_SIDE_BOTTOM));
      out += k_p * volume[a] * lap[a];
      continue;
    }
    in += inflow;
    /* the solve leaves 1e-12 of ||b||, about sqrt(9) * 0.13 * 2r */
    NEAR(k_p * volume[a] * lap[a], -inflow, 1e-11 * 0.13 * 0.01);
  }
  in  = GroundSum(&g, in);
  out = GroundSum(&g, out);
  assert_true(in > 5.0 * 0.13 * 0.01);
  NEAR(out, in, 1e-10 * in); /* sums of some 100 of them */
  CHECK(PetscFree(lap));
  GroundDestroy(&g);
}

/* Impermeable and natural sides of the Darcy scheme are the same: nothing. */
static void NaturalIsImpermeableForDarcy(void **state)
{
  const char *const kinds[] = {SOLVER "-bc_left_pressure 1.5e5 -bc_top impermeable -bc_bottom impermeable",
                               SOLVER "-bc_left_pressure 1.5e5 -bc_top natural -bc_bottom natural"};
  PetscReal        *p[2], *u[2];
  PetscInt          count = 0;

  (void)state;
  for (int k = 0; k < 2; k++) {
    Ground g;
    GroundCreate(PETSC_COMM_WORLD, GROUND_DARCY, kinds[k], &g);
    GroundFill(&g, PackingCount(&disorder), PackingPlace, &disorder);
    Move(&g);
    CHECK(PgPoreSetUp(g.pore, dt));
    Step(&g);
    p[k]  = GroundGatherField(&g, "pressure", 1);
    u[k]  = GroundGatherField(&g, "fluid_velocity", 2);
    count = g.count;
    GroundDestroy(&g);
  }
  AssertSame(p[0], p[1], count, "pressure");
  AssertSame(u[0], u[1], 2 * count, "fluid velocity");
  for (int k = 0; k < 2; k++) {
    CHECK(PetscFree(p[k]));
    CHECK(PetscFree(u[k]));
  }
}

/* ---- surface ---- */

/* No disc formed a side, but for two in the middle of the packing, and two more sit on a plate. */
static void PlaceFree(const void *context, PetscInt id, Disc *disc)
{
  PackingPlace(context, id, disc);
  disc->sides = id == 60 || id == 61 ? 1 << PG_SIDE_LEFT : 0;
  disc->plate = id == 70 || id == 3 ? 1 : 0;
}

/* The side a disc without side bits faces decides its pressure. Discs with fewer than 0.6 of their kernel are
   outside. */
static void FacingSide(void **state)
{
  Ground            g;
  PetscReal        *surface, *detached, *fixed, *p, *side, *plate;
  PgSphCoefficients c;
  PetscInt          drained = 0, dry = 0, facing[PG_SIDE_COUNT] = {0};
  PgPoreStats       stats;

  (void)state;
  GroundCreate(PETSC_COMM_WORLD, GROUND_DARCY,
               SOLVER "-bc_tracking surface -bc_left_pressure 1.1e5 -bc_right_pressure 1.2e5 -bc_bottom impermeable "
                      "-bc_top_pressure 1.4e5",
               &g);
  GroundFill(&g, PackingCount(&lattice), PlaceFree, &lattice);
  CHECK(PgPoreSetUp(g.pore, dt));
  Step(&g);
  surface  = GroundArray(&g, "surface");
  detached = GroundArray(&g, "detached");
  fixed    = GroundArray(&g, "pressure_fixed");
  p        = GroundArray(&g, "pressure");
  side     = GroundArray(&g, "side");
  plate    = GroundArray(&g, "plate");
  CHECK(PgSphGetCoefficients(g.sph, &c));
  for (PetscInt a = 0; a < GroundOwned(&g); a++) {
    const PetscInt id = GroundIds(&g)[a];
    PetscInt       row, column, length;
    PetscBool      end, cap;

    PackingRow(&lattice, id, &row, &column, &length);
    end = (PetscBool)(column == 0 || column == length - 1);
    cap = (PetscBool)(row == 0 || row == lattice.rows - 1);
    if (side[a] != 0.0 || plate[a] != 0.0) {
      assert_true(surface[a] == 0.0);
      continue;
    }
    assert_true(surface[a] == (c.kernel_sum[a] < 0.92 ? 1.0 : 0.0));
    assert_true(detached[a] == (c.kernel_sum[a] < 0.6 ? 1.0 : 0.0));
    dry += detached[a] != 0.0;
    drained += surface[a] != 0.0 && fixed[a] != 0.0;
    if (detached[a] != 0.0) continue;
    if (end && length == lattice.columns && row > 1 && row < lattice.rows - 2) {
      assert_true(fixed[a] == 1.0 && p[a] == (column == 0 ? 1.1e5 : 1.2e5));
      facing[column == 0 ? PG_SIDE_LEFT : PG_SIDE_RIGHT]++;
    }
    if (cap && column > 1 && column < length - 2) {
      assert_true(surface[a] == 1.0);
      assert_true(row == 0 ? fixed[a] == 0.0 : fixed[a] == 1.0 && p[a] == 1.4e5);
      facing[row == 0 ? PG_SIDE_BOTTOM : PG_SIDE_TOP]++;
    }
    if (PackingDepth(&lattice, id) > 4.0) assert_true(surface[a] == 0.0 && fixed[a] == 0.0);
  }
  for (int s = 0; s < PG_SIDE_COUNT; s++) assert_true(GroundTotal(&g, facing[s]) >= 3);
  CHECK(PgPoreGetStats(g.pore, &stats));
  assert_int_equal((int)stats.surface, (int)GroundTotal(&g, drained)); /* on a drained surface, as the header says */
  assert_int_equal((int)stats.detached, (int)GroundTotal(&g, dry));
  assert_true(stats.detached > 0);
  GroundDestroy(&g);
}

/* A disc joins the surface below the bound and leaves it 0.03 above: followed through contractions and dilations of a
   disordered packing whose sums lie around the bound. */
static void HysteresisOfTheSurface(void **state)
{
  const PetscReal scale[] = {1.0, 1.015, 1.0 / 1.015, 0.985, 1.0 / 0.985, 0.97};
  PetscReal      *was;
  PetscInt        stayed = 0, stayed_out = 0, joined = 0, left = 0;
  Ground          g;

  (void)state;
  GroundCreate(PETSC_COMM_WORLD, GROUND_DARCY,
               SOLVER "-porosity kinematic -bc_tracking surface -bc_surface_sum 0.98 -detach_kernel_sum 0 "
                      "-detach_porosity 0.99",
               &g);
  GroundFill(&g, PackingCount(&disorder), PlaceFree, &disorder);
  CHECK(PgPoreSetUp(g.pore, dt));
  was = GroundGatherField(&g, "surface", 1);
  for (size_t k = 0; k < sizeof scale / sizeof *scale; k++) {
    PgSphCoefficients c;
    PetscReal        *surface, *side, *plate, *fixed;

    CHECK(PgPorePredict(g.pore, dt));
    GroundMove(&g, scale[k], 0.0, 0.0);
    CHECK(PgPoreCorrect(g.pore, dt));
    CHECK(PgPoreRefresh(g.pore));
    CHECK(PgSphGetCoefficients(g.sph, &c));
    surface = GroundArray(&g, "surface");
    side    = GroundArray(&g, "side");
    plate   = GroundArray(&g, "plate");
    fixed   = GroundArray(&g, "pressure_fixed");
    for (PetscInt a = 0; a < GroundOwned(&g); a++) {
      const PetscBool before = (PetscBool)(was[GroundIds(&g)[a]] != 0.0);
      const PetscReal sum    = c.kernel_sum[a];
      if (side[a] != 0.0 || plate[a] != 0.0) {
        assert_true(surface[a] == 0.0);
        assert_true(fixed[a] == (side[a] != 0.0 ? 1.0 : 0.0));
        continue;
      }
      if (sum < 0.98)
        assert_true(surface[a] == 1.0);
      else if (sum >= 1.01)
        assert_true(surface[a] == 0.0);
      else
        assert_true(surface[a] == (before ? 1.0 : 0.0));
      assert_true(fixed[a] == surface[a]);
      stayed += sum >= 0.98 && surface[a] != 0.0;
      stayed_out += sum < 1.01 && surface[a] == 0.0;
      joined += !before && surface[a] != 0.0;
      left += before && surface[a] == 0.0;
    }
    CHECK(PetscFree(was));
    was = GroundGatherField(&g, "surface", 1);
  }
  assert_true(GroundTotal(&g, stayed) > 0 && GroundTotal(&g, stayed_out) > 0);
  assert_true(GroundTotal(&g, joined) > 0 && GroundTotal(&g, left) > 0);
  CHECK(PetscFree(was));
  GroundDestroy(&g);
}

/* -bc_tracking initial, the default: only the sides of the start. */
static void NoTracking(void **state)
{
  Ground      g;
  PetscReal  *fixed, *side;
  PgPoreStats stats;

  (void)state;
  GroundCreate(PETSC_COMM_WORLD, GROUND_DARCY, SOLVER "-detach_kernel_sum 0", &g);
  GroundFill(&g, PackingCount(&lattice), PlaceFree, &lattice);
  CHECK(PgPoreSetUp(g.pore, dt));
  Step(&g);
  fixed = GroundArray(&g, "pressure_fixed");
  side  = GroundArray(&g, "side");
  for (PetscInt a = 0; a < GroundOwned(&g); a++) assert_true(fixed[a] == (side[a] != 0.0 ? 1.0 : 0.0));
  CHECK(PgPoreGetStats(g.pore, &stats));
  assert_int_equal((int)stats.surface, 0);
  GroundDestroy(&g);
}

/* ---- discs outside the water ---- */

enum { ALONE = 0, PAIR = 1, POROUS = 3, AWAY = 4, EXTRA = 5 };

/* The packing, and after it: a disc alone, a touching pair, one with a large porosity in a gap above the packing, one
   that is away at first. */
static void PlaceStrays(const void *context, PetscInt id, Disc *disc)
{
  const Packing  *p     = (const Packing *)context;
  const PetscInt  stray = id - PackingCount(p);
  const PetscReal r     = p->radius;

  PackingPlace(context, stray < 0 ? id : 0, disc);
  if (stray < 0) return;
  disc->sides = 0;
  disc->x[0]  = stray == ALONE ? 0.4 : (stray == PAIR ? 0.3 : (stray == PAIR + 1 ? 0.3 + 1.9 * r : 0.05));
  disc->x[1]  = stray == ALONE ? 0.3 : (stray == AWAY ? 0.5 : 0.05);
  if (stray == POROUS) {
    disc->x[1]     = r * (1.0 + PetscSqrtReal(3.0) * 0.5 * (PetscReal)(p->rows - 1)); /* in the middle, overlapping */
    disc->porosity = 0.6;
  }
}

static PetscInt StrayIndex(Ground *g, PetscInt stray)
{
  for (PetscInt a = 0; a < GroundOwned(g); a++)
    if (GroundIds(g)[a] == g->count - EXTRA + stray) return a;
  return -1;
}

/* Outside: the pressure of the start, u = v in u~ and u, no force of the water, not even buoyancy, and the projection
   leaves it alone. A disc that comes back is in again. */
static void DetachedDiscs(void **state)
{
  const PetscReal gravity[2] = {0.5, -9.81};

  (void)state;
  for (int kind = GROUND_DARCY; kind <= GROUND_NS; kind++) {
    Ground      g;
    PetscReal  *before;
    PetscInt    owned;
    PgPoreStats stats;

    GroundCreate(PETSC_COMM_WORLD, (GroundKind)kind,
                 SOLVER "-porosity kernel -coupling drag_and_pressure -initial_pressure 1.3e5 -ns_continuity averaged",
                 &g);
    CHECK(PgPoreSetGravity(g.pore, gravity));
    GroundFill(&g, PackingCount(&disorder) + EXTRA, PlaceStrays, &disorder);
    CHECK(PgPoreSetUp(g.pore, dt));
    Move(&g);
    CHECK(PgPoreRefresh(g.pore));
    before = GroundGather(&g, GroundCore(&g, PG_VELOCITY), 2);
    for (int step = 0; step < 2; step++) {
      Step(&g);
      for (PetscInt stray = 0; stray < EXTRA; stray++) {
        const PetscInt a = StrayIndex(&g, stray);
        if (a < 0) continue;
        assert_true(GroundArray(&g, "detached")[a] == 1.0 && GroundArray(&g, "pressure_fixed")[a] == 1.0);
        /* to and from the excess over hydrostatic pressure: two roundings */
        NEAR(GroundArray(&g, "pressure")[a], 1.3e5, 1e-15 * 4.0 * 1.3e5);
        for (int i = 0; i < 2; i++) {
          const PetscReal v = GroundCore(&g, PG_VELOCITY)[2 * a + i];
          assert_true(v == before[2 * GroundIds(&g)[a] + i] && v != 0.0);
          assert_true(GroundArray(&g, "fluid_velocity")[2 * a + i] == v);
          assert_true(kind == GROUND_DARCY || GroundArray(&g, "fluid_predictor")[2 * a + i] == v);
          assert_true(GroundArray(&g, "fluid_force")[2 * a + i] == 0.0);
          assert_true(GroundArray(&g, "relative_velocity")[2 * a + i] == 0.0);
        }
      }
      CHECK(PgPoreGetStats(g.pore, &stats));
      assert_int_equal((int)stats.detached, EXTRA);
    }
    /* the others do feel it */
    owned = GroundOwned(&g);
    for (PetscInt a = 0; a < owned; a++)
      if (GroundArray(&g, "detached")[a] == 0.0) assert_true(GroundArray(&g, "fluid_force")[2 * a + 1] != 0.0);
    CHECK(PgPorePredict(g.pore, dt));
    {
      const PetscInt a = StrayIndex(&g, AWAY);
      if (a >= 0) { /* into the middle of the packing */
        GroundCore(&g, PG_POSITION)[2 * a]     = 0.051;
        GroundCore(&g, PG_POSITION)[2 * a + 1] = 0.042;
      }
    }
    CHECK(PgNeighborsBuild(g.neighbors));
    CHECK(PgPoreCorrect(g.pore, dt));
    CHECK(PgPoreGetStats(g.pore, &stats));
    assert_int_equal((int)stats.detached, EXTRA - 1);
    {
      const PetscInt a = StrayIndex(&g, AWAY);
      if (a >= 0) assert_true(GroundArray(&g, "detached")[a] == 0.0 && GroundArray(&g, "pressure_fixed")[a] == 0.0);
    }
    CHECK(PetscFree(before));
    GroundDestroy(&g);
  }
}

/* A disc that formed a side is judged by the kernel sum of its own start: the corners of a packing, with 0.4 of their
   kernel, are in, and are out when that falls to a fraction of it. */
static void SidesAreJudgedByTheirStart(void **state)
{
  Ground            g;
  PgSphCoefficients c;
  PetscReal        *detached, *start, *x;
  PetscInt          corner = -1, low = 0;
  PgPoreStats       stats;

  (void)state;
  GroundCreate(PETSC_COMM_WORLD, GROUND_DARCY, SOLVER "-porosity kinematic", &g);
  GroundFill(&g, PackingCount(&lattice), PackingPlace, &lattice);
  CHECK(PgPoreSetUp(g.pore, dt));
  CHECK(PgSphGetCoefficients(g.sph, &c));
  detached = GroundArray(&g, "detached");
  start    = GroundArray(&g, "initial_kernel_sum");
  for (PetscInt a = 0; a < GroundOwned(&g); a++) {
    assert_true(detached[a] == 0.0 && start[a] == PetscMin(1.0, c.kernel_sum[a]));
    low += start[a] < 0.55;
  }
  assert_true(GroundTotal(&g, low) >= 2);
  CHECK(PgPorePredict(g.pore, dt));
  x = GroundCore(&g, PG_POSITION);
  for (PetscInt a = 0; a < GroundOwned(&g); a++) {
    if (GroundIds(&g)[a] != 0) continue;
    x[2 * a] -= 0.012; /* away, but with neighbours yet */
    x[2 * a + 1] -= 0.004;
  }
  CHECK(PgNeighborsBuild(g.neighbors));
  CHECK(PgPoreCorrect(g.pore, dt));
  CHECK(PgSphGetCoefficients(g.sph, &c));
  detached = GroundArray(&g, "detached");
  start    = GroundArray(&g, "initial_kernel_sum");
  for (PetscInt a = 0; a < GroundOwned(&g); a++) {
    assert_true(detached[a] == (c.kernel_sum[a] < 0.6 * start[a] ? 1.0 : 0.0));
    if (GroundIds(&g)[a] == 0) corner = a;
  }
  if (corner >= 0) assert_true(detached[corner] == 1.0 && c.ptr[corner + 1] > c.ptr[corner]);
  CHECK(PgPoreGetStats(g.pore, &stats));
  assert_int_equal((int)stats.detached, 1);
  GroundDestroy(&g);
}

/* With the rules switched off, a disc whose list holds neighbours beyond the kernel's reach must not leave a row
   without entries. */
static void PlaceBeyondReach(const void *context, PetscInt id, Disc *disc)
{
  const PetscInt last = PackingCount((const Packing *)context);

  PackingPlace(context, id < last ? id : 0, disc);
  if (id < last) return;
  disc->sides = 0;
  /* the reach is 2h = 5 r, that of the lists 5.2 r: the end of the second row is the nearest */
  PackingPlace(context, ((const Packing *)context)->columns - 1, disc);
  disc->sides = 0;
  disc->x[0] -= 5.1 * disc->r;
}

static void NoKernelNeighbours(void **state)
{
  Ground      g;
  PgPoreStats stats;
  PetscInt    listed = 0;

  (void)state;
  for (int kind = GROUND_DARCY; kind <= GROUND_NS; kind++) {
    PgRowList list;

    GroundCreate(PETSC_COMM_WORLD, (GroundKind)kind,
                 SOLVER "-porosity kinematic -detach_porosity 0.99 -detach_kernel_sum 0 -bc_tracking initial", &g);
    GroundFill(&g, PackingCount(&lattice) + 1, PlaceBeyondReach, &lattice);
    CHECK(PgPoreSetUp(g.pore, dt));
    Move(&g);
    CHECK(PgPoreRefresh(g.pore));
    Step(&g);
    CHECK(PgNeighborsGetRows(g.neighbors, &list));
    for (PetscInt a = 0; a < GroundOwned(&g); a++) {
      if (GroundIds(&g)[a] < g.count - 1) continue;
      listed = list.ptr[a + 1] - list.ptr[a];
      assert_true(GroundArray(&g, "detached")[a] == 1.0 && GroundArray(&g, "pressure")[a] == 1e5);
    }
    assert_true(GroundTotal(&g, listed) > 0);
    CHECK(PgPoreGetStats(g.pore, &stats));
    assert_int_equal((int)stats.detached, 1);
    GroundDestroy(&g);
    listed = 0;
  }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(PrescribedPressures),
    cmocka_unit_test(VelocitiesOfTheSides),
    cmocka_unit_test(InflowOfTheDarcyScheme),
    cmocka_unit_test(NaturalIsImpermeableForDarcy),
    cmocka_unit_test(FacingSide),
    cmocka_unit_test(HysteresisOfTheSurface),
    cmocka_unit_test(NoTracking),
    cmocka_unit_test(DetachedDiscs),
    cmocka_unit_test(SidesAreJudgedByTheirStart),
    cmocka_unit_test(NoKernelNeighbours),
};

GROUND_MAIN(tests, PETSC_TRUE)
