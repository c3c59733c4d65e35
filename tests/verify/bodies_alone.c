/* Meshed discrete elements without liquid: surface integrals of pressure (Eqs. 43-46), vibration (Eq. 48), energy and
   stability of the integrators (Eqs. 47-50), turning, rigid motion. */
#include "verify.h"
#include <math.h>
#include <porograin/bodies.h>

/* A square of side L with its corner at the origin. */
static PetscInt Square(PgBodies b, PgBodyKind kind, PetscReal E, PetscReal nu, PetscReal L, PetscInt n)
{
  const PgBodyMesh like   = {.kind = kind, .E = E, .nu = nu, .rho = 2000};
  const PetscReal  low[2] = {0, 0}, high[2] = {L, L};
  const PetscInt   cells[2] = {n, n};
  PetscInt         body;

  CHECK(PgBodiesAddBox(b, &like, cells, low, high, &body));
  return body;
}

static PgBodyState Get(PgBodies b)
{
  PgBodyState s;
  CHECK(PgBodiesGet(b, 0, &s));
  return s;
}

/* ---- Q ---- */

/* A leaning polygon of three cells, one of them given clockwise; node 5 is inside. */
static const PetscReal polygon[14] = {0, 0, 1.1, -0.2, 1.6, 0.7, 0.7, 1.5, 0.15, 1.2, 0.45, 0.55, 1.35, 0.25};
static const PetscInt  parts[12]   = {0, 1, 6, 5, 5, 3, 2, 6, 0, 5, 3, 4};
static const PetscInt  hull[6]     = {0, 1, 6, 2, 3, 4};

static void PressureOnSurface(void **state)
{
  const PgBodyMesh mesh = {.nodes = 7, .cells = 3, .x = polygon, .cell = parts, .kind = PG_BODY_RIGID, .rho = 1700};
  const PetscReal  rho = 1000, g = 9.81;
  PetscReal        p[7], area = 0, net[2] = {0, 0}, moment = 0;
  PgBodies         b;
  PgBodyState      s;

  (void)state;
  CHECK(PgBodiesCreate(PETSC_COMM_WORLD, &b));
  CHECK(PgBodiesAdd(b, &mesh, NULL));
  s = Get(b);
  assert_int_equal(s.edges, 6);
  for (int i = 0; i < 6; i++) {
    const PetscReal *from = &polygon[2 * hull[i]], *to = &polygon[2 * hull[(i + 1) % 6]];
    area += 0.5 * (from[0] * to[1] - to[0] * from[1]);
  }
  /* the cells cover the polygon: three rounded products each */
  VerifyValue("bodies", "mass of a polygon of three cells [kg/m]", 1700 * area, s.mass, 0, 1e-14, "rounding");
  for (int i = 0; i < 7; i++) p[i] = 7;
  CHECK(PgBodiesSetPressure(b, 0, p));
  s = Get(b);
  for (int i = 0; i < 7; i++) {
    for (int d = 0; d < 2; d++) net[d] += s.force[2 * i + d];
    moment += s.x[2 * i] * s.force[2 * i + 1] - s.x[2 * i + 1] * s.force[2 * i];
  }
  /* sums of 12 terms of about 7 N */
  VerifyValue("bodies", "net force of a uniform pressure [N/m]", 0, hypot(net[0], net[1]), 7, 1e-14, "rounding");
  VerifyValue("bodies", "net moment of a uniform pressure [N]", 0, moment, 7, 1e-14, "rounding");
  for (int i = 0; i < 7; i++) p[i] = 1e4 - rho * g * s.x[2 * i + 1];
  CHECK(PgBodiesSetPressure(b, 0, p));
  s      = Get(b);
  net[0] = net[1] = moment = 0;
  for (int i = 0; i < 7; i++) {
    for (int d = 0; d < 2; d++) net[d] += s.force[2 * i + d];
    moment += (s.x[2 * i] - s.centre[0]) * s.force[2 * i + 1] - (s.x[2 * i + 1] - s.centre[1]) * s.force[2 * i];
  }
  /* terms of up to 1e4 N */
  VerifyValue("bodies", "Archimedes: lift of a body in water at rest [N/m]", rho * g * area, net[1], 0, 1e-14,
              "rounding: the integrals are exact");
  VerifyValue("bodies", "Archimedes: force sideways over the lift [1]", 0, net[0] / net[1], 1, 1e-14, "rounding");
  CHECK(PgBodiesDestroy(&b));
}

/* ---- energy of a uniform strain, on leaning cells ---- */

static void UniformStrain(void **state)
{
  const PetscReal E = 3e6, nu = 0.3, lambda = E * nu / ((1 + nu) * (1 - 2 * nu)), G = E / (2 * (1 + nu));
  const PetscReal H[4] = {0.11, -0.23, 0.34, -0.07};

  (void)state;
  for (int finite = 0; finite < 2; finite++) {
    const PgBodyMesh mesh = {.nodes = 7,
                             .cells = 3,
                             .x     = polygon,
                             .cell  = parts,
                             .kind  = finite ? PG_BODY_FINITE : PG_BODY_LINEAR,
                             .E     = E,
                             .nu    = nu,
                             .rho   = 1};
    PetscReal        u[14], e[3] = {H[0], H[3], 0.5 * (H[1] + H[2])}, energy;
    PgBodies         b;

    if (finite) {
      e[0] += 0.5 * (H[0] * H[0] + H[2] * H[2]);
      e[1] += 0.5 * (H[1] * H[1] + H[3] * H[3]);
      e[2] += 0.5 * (H[0] * H[1] + H[2] * H[3]);
    }
    energy = 0.5 * lambda * PetscSqr(e[0] + e[1]) + G * (e[0] * e[0] + e[1] * e[1] + 2 * e[2] * e[2]);
    for (int i = 0; i < 7; i++)
      for (int d = 0; d < 2; d++) u[2 * i + d] = H[2 * d] * polygon[2 * i] + H[2 * d + 1] * polygon[2 * i + 1];
    CHECK(PgBodiesCreate(PETSC_COMM_WORLD, &b));
    CHECK(PgBodiesAdd(b, &mesh, NULL));
    CHECK(PgBodiesSetState(b, 0, u, NULL));
    /* strains are the same at all points but for rounding; rho is 1, so the mass is the area */
    VerifyValue("bodies", finite ? "energy of a uniform finite strain [J/m]" : "energy of a uniform small strain [J/m]",
                energy * Get(b).mass, Get(b).elastic, 0, 1e-14, "rounding");
    CHECK(PgBodiesDestroy(&b));
  }
}

/* ---- vibration ---- */

/* Lame's mode of a free square, u = (cos sin, -sin cos)(pi x/L, pi y/L), for any Poisson's ratio: omega = pi sqrt(2)
   c_s/L. Period from the turning of the projection on the mode. */
static PetscReal LamePeriod(PgBodyKind kind, PetscReal nu, PetscInt n, PetscReal *energy)
{
  const PetscReal E = 1e7, L = 0.2, c_s = PetscSqrtReal(E / (2 * (1 + nu)) / 2000), a = PETSC_PI / L;
  const PetscReal T = 2 * PETSC_PI / (a * PetscSqrtReal(2.0) * c_s);
  /* no steps of its own: the error is that of the cells */
  const PetscReal dt = T / (PetscReal)(64 * n);
  PetscReal      *u, before = 1, now = 1, start, most = 0;
  PetscInt        k;
  PgBodies        b;
  PgBodyState     s;

  CHECK(PgBodiesCreate(PETSC_COMM_WORLD, &b));
  Square(b, kind, E, nu, L, n);
  s = Get(b);
  CHECK(PetscMalloc1(2 * s.nodes, &u));
  for (PetscInt i = 0; i < s.nodes; i++) {
    u[2 * i]     = 1e-7 * cos(a * s.X[2 * i]) * sin(a * s.X[2 * i + 1]);
    u[2 * i + 1] = -1e-7 * sin(a * s.X[2 * i]) * cos(a * s.X[2 * i + 1]);
  }
  CHECK(PgBodiesSetState(b, 0, u, NULL));
  start = Get(b).elastic;
  for (k = 1; now > 0; k++) { /* a quarter of the period */
    PetscReal sum = 0;
    assert_true(k < 64 * n);
    CHECK(PgBodiesKickDrift(b, dt));
    CHECK(PgBodiesKick(b, dt));
    s = Get(b);
    for (PetscInt i = 0; i < 2 * s.nodes; i++) sum += s.m[i / 2] * u[i] * (s.x[i] - s.X[i]);
    before = now;
    now    = sum;
    most   = PetscMax(most, PetscAbsReal((s.elastic + s.kinetic) / start - 1));
  }
  if (energy) *energy = most;
  CHECK(PetscFree(u));
  CHECK(PgBodiesDestroy(&b));
  return 4 * dt * ((PetscReal)(k - 1) - now / (now - before)) / T;
}

static void Vibration(void **state)
{
  enum { LEVELS = 3 };
  PetscReal h[LEVELS], error[LEVELS], period[LEVELS], last = 0, energy = 0;

  (void)state;
  for (int level = 0; level < LEVELS; level++) {
    const PetscInt n = 4 << level;
    last             = LamePeriod(PG_BODY_LINEAR, 0.3, n, &energy);
    h[level]         = 1 / (PetscReal)n;
    period[level]    = last;
    error[level]     = PetscAbsReal(last - 1);
  }
  /* (pi h/L)^2/12 of lumped bilinear cells is 3.2e-3 */
  VerifyValue("bodies", "period of Lame's mode of a free square, nu 0.3, 16 cells, over the exact one", 1, last, 0,
              3.2e-3, "lumped bilinear cells, (pi h/L)^2/12");
  /* without the error of second order: (pi h/L)^4/60 at 8 cells is 4e-4, a sixteenth of it at 16, a third of the difference */
  VerifyValue("bodies", "the same, extrapolated from 8 and 16 cells", 1, (4 * period[2] - period[1]) / 3, 0, 1.2e-4,
              "error of fourth order");
  VerifyOrder("bodies", "period of Lame's mode", LEVELS, h, error, 2, 0.1, "bilinear cells");
  /* (omega dt)^2/8 of velocity Verlet with 1024 steps in a period is 5e-6 for the mode itself, and more for what the
     lattice mixes in */
  VerifyValue("bodies", "energy in a quarter of the period over the start", 1, 1 + energy, 0, 2e-5, "velocity Verlet");
  /* strains of 1e-6: so is the difference between the two */
  VerifyValue("bodies", "the same period with Green's strain, 8 cells, over that of small strains", 1,
              LamePeriod(PG_BODY_FINITE, 0.3, 8, NULL) / LamePeriod(PG_BODY_LINEAR, 0.3, 8, NULL), 0, 1e-6,
              "strains of 1e-6");
}

/* A bar of n cells in a row, nu = 0, vibrates along as lumped masses with springs do: omega = (2 c/h) sin(pi h/(2 L)). */
static void Bar(void **state)
{
  enum { N = 10 };
  const PetscReal E = 1e9, rho = 2000, L = 0.5, c = PetscSqrtReal(E / rho), h = L / N, low[2] = {0, 0};
  const PetscReal omega = 2 * c / h * sin(PETSC_PI * h / (2 * L)), dt = 2 * PETSC_PI / omega / 4000,
                  high[2]   = {L, 0.04};
  const PgBodyMesh like     = {.kind = PG_BODY_LINEAR, .E = E, .nu = 0, .rho = rho};
  const PetscInt   cells[2] = {N, 1};
  PetscReal        u[4 * (N + 1)], worst = 0;
  PgBodies         b;
  PgBodyState      s;

  (void)state;
  CHECK(PgBodiesCreate(PETSC_COMM_WORLD, &b));
  CHECK(PgBodiesAddBox(b, &like, cells, low, high, NULL));
  s = Get(b);
  for (PetscInt i = 0; i < s.nodes; i++) {
    u[2 * i]     = 1e-6 * cos(PETSC_PI * s.X[2 * i] / L);
    u[2 * i + 1] = 0;
  }
  CHECK(PgBodiesSetState(b, 0, u, NULL));
  for (PetscInt k = 1; k <= 4000; k++) {
    const PetscReal now = cos(omega * dt * (PetscReal)k);
    CHECK(PgBodiesKickDrift(b, dt));
    CHECK(PgBodiesKick(b, dt));
    s = Get(b);
    for (PetscInt i = 0; i < 2 * s.nodes; i++)
      worst = PetscMax(worst, PetscAbsReal((s.x[i] - s.X[i]) - u[i] * now) / 1e-6);
  }
  /* phase of Verlet, (omega dt)^2/24 of 2 pi: 6.5e-7, and 1e-10 of rounding in x - X */
  VerifyValue("bodies", "bar of 10 cells, largest departure from its mode in a period over the amplitude", 0, worst, 1,
              1e-6, "phase of velocity Verlet");
  /* the bar as a continuum: omega L/(pi c) */
  VerifyValue("bodies", "frequency of a bar of 10 cells over c/(2 L)", 1, omega * L / (PETSC_PI * c), 0, 5e-3,
              "lumped masses, (pi h/L)^2/24 = 4.1e-3");
  CHECK(PgBodiesDestroy(&b));
}

/* ---- integrators ---- */

/* One cell, nu = 0, stretched: omega^2 = 4 E/(rho L^2). Energy after `steps` of z/omega over the start, and before them
   `skip`. */
static PetscReal EnergyRatio(PgBodiesIntegrator integrator, PetscReal z, PetscInt skip, PetscInt steps,
                             PetscReal *phase)
{
  const PetscReal E = 1e8, L = 0.2, omega = PetscSqrtReal(4 * E / (2000 * L * L)), dt = z / omega;
  PetscReal       u[8], start = 0;
  PgBodies        b;
  PgBodyState     s;

  CHECK(PgBodiesCreate(PETSC_COMM_WORLD, &b));
  CHECK(PgBodiesSetIntegrator(b, integrator));
  Square(b, PG_BODY_LINEAR, E, 0, L, 1);
  s = Get(b);
  for (int i = 0; i < 4; i++) {
    u[2 * i]     = 1e-4 * (s.X[2 * i] / L - 0.5); /* K u is linear whatever its size */
    u[2 * i + 1] = 0;
  }
  CHECK(PgBodiesSetState(b, 0, u, NULL));
  start = Get(b).elastic;
  for (PetscInt k = 0; k < skip + steps; k++) {
    if (k == skip && k) start = Get(b).elastic + Get(b).kinetic;
    CHECK(PgBodiesKickDrift(b, dt));
    CHECK(PgBodiesKick(b, dt));
  }
  s = Get(b);
  if (phase) *phase = (s.x[0] - s.X[0]) / u[0];
  CHECK(PgBodiesDestroy(&b));
  return (s.elastic + s.kinetic) / start;
}

/* Largest |lambda| of Eqs. 47-50 with a_{n+1} = -omega^2 u_n: lambda^3 + (z^2/2 - 2) lambda^2 + lambda + z^2/2 = 0, whose
   real root r is near -z^2/2, and the product of all is -z^2/2. */
static PetscReal LiteralRadius(PetscReal z)
{
  const PetscReal c = 0.5 * z * z;
  PetscReal       r = -c;

  for (int k = 0; k < 60; k++) r -= (((r + c - 2) * r + 1) * r + c) / ((3 * r + 2 * (c - 2)) * r + 1);
  return PetscSqrtReal(-c / r);
}

static void Integrators(void **state)
{
  const PetscReal z[3] = {0.05, 0.5, 1.0};
  PetscReal       h[3], error[3];

  (void)state;
  /* E/E_0 - 1 = O(z^2/4) at any time, bounded */
  VerifyValue("bodies", "Verlet, 0.1 of 1/omega, 10 periods: energy over the start", 1,
              EnergyRatio(PG_BODIES_VERLET, 0.1, 0, 628, NULL), 0, 2.5e-3, "z^2/4 of velocity Verlet, bounded");
  VerifyValue("bodies", "Verlet, 0.1 of 1/omega, 1000 periods: energy over the start", 1,
              EnergyRatio(PG_BODIES_VERLET, 0.1, 0, 62832, NULL), 0, 2.5e-3, "z^2/4 of velocity Verlet, bounded");
  VerifyReport("bodies", "Eqs. 47-50 as printed, 0.1 of 1/omega, 10 periods: energy over the start",
               EnergyRatio(PG_BODIES_LITERAL, 0.1, 0, 628, NULL), "unstable without damping");
  for (int k = 0; k < 3; k++) {
    const PetscInt  steps = k ? 300 : 1257; /* about whole half periods, where the energy says the same */
    const PetscReal ratio = EnergyRatio(PG_BODIES_LITERAL, z[k], 200, steps, NULL);
    char            name[96];
    (void)snprintf(name, sizeof name, "Eqs. 47-50 as printed, growth in a step of %g/omega", (double)z[k]);
    /* what the energy swings within a period, z of it, over the steps: z/steps */
    VerifyValue("bodies", name, LiteralRadius(z[k]), PetscPowReal(ratio, 0.5 / (PetscReal)steps), 0,
                z[k] / (PetscReal)steps, "energy swings by z within a period");
  }
  for (int k = 0; k < 3; k++) {
    const PetscInt n = 20 << k;
    PetscReal      phase;
    (void)EnergyRatio(PG_BODIES_VERLET, 2 * PETSC_PI / (PetscReal)n, 0, 10 * n + n / 4, &phase);
    h[k]     = 1 / (PetscReal)n;
    error[k] = PetscAbsReal(phase); /* zero after ten periods and a quarter */
  }
  VerifyOrder("bodies", "Verlet, displacement after ten periods and a quarter", 3, h, error, 2, 0.1, "velocity Verlet");
}

/* Steps of its own for what is stiff: a step of 20 times the bound gives the same as 20 and more small ones. */
static void OwnSteps(void **state)
{
  const PetscReal E = 1e9, L = 0.1, traction[2] = {-50, 0};
  PetscReal       way[2], limit;

  (void)state;
  for (int k = 0; k < 2; k++) {
    PgBodies b;
    PetscInt steps = k ? 400 : 20;
    CHECK(PgBodiesCreate(PETSC_COMM_WORLD, &b));
    Square(b, PG_BODY_FINITE, E, 0.48, L, 1);
    CHECK(PgBodiesGetTimeStep(b, &limit));
    CHECK(PgBodiesAddTraction(b, 0, 0, L, traction));
    for (PetscInt n = 0; n < steps; n++) {
      CHECK(PgBodiesKickDrift(b, 400 * limit / (PetscReal)steps));
      CHECK(PgBodiesKick(b, 400 * limit / (PetscReal)steps));
    }
    way[k] = Get(b).centre[0] - 0.5 * L;
    CHECK(PgBodiesDestroy(&b));
  }
  /* the centre of mass: a constant force, whatever the steps; 4000 roundings of positions of 0.1 m are 6e-14 m */
  VerifyValue("bodies", "way of a body of E 1e9 in steps 20 times its bound [m]", way[1], way[0], 0, 3e-9,
              "rounding of the positions");
  VerifyValue("bodies", "the same against F t^2/(2 m) [m]", -50 * L / (2000 * L * L) * 0.5 * PetscSqr(400 * limit),
              way[0], 0, 3e-9, "rounding of the positions");
}

/* A free square that turns by a right angle and more: with Green's strain it keeps its angular momentum, and its shape but
   for what the spin draws out. */
static void Turning(void **state)
{
  const PetscReal L = 0.2, v[2] = {0.3, -0.2}, spin = 20, dt = 1e-5;
  PetscReal       start, energy, least;
  PgBodies        b;
  PgBodyState     s;

  (void)state;
  CHECK(PgBodiesCreate(PETSC_COMM_WORLD, &b));
  Square(b, PG_BODY_FINITE, 1e7, 0.3, L, 3);
  CHECK(PgBodiesSetVelocity(b, 0, v, spin));
  s      = Get(b);
  start  = s.angular;
  energy = s.kinetic;
  for (int k = 0; k < 10000; k++) {
    CHECK(PgBodiesKickDrift(b, dt));
    CHECK(PgBodiesKick(b, dt));
  }
  s     = Get(b);
  least = s.x[2 * 15] - s.x[0]; /* the diagonal has turned by 20 * 0.1 = 2 rad, less what the spin draws out */
  /* Verlet keeps it to rounding: 10000 steps */
  VerifyValue("bodies", "angular momentum of a square that turns by 2 rad [kg m/s]", start, s.angular, 0, 1e-12,
              "rounding of 10000 steps");
  VerifyValue("bodies", "energy of a square that turns by 2 rad over the start", 1, (s.kinetic + s.elastic) / energy, 0,
              1e-6, "(omega dt)^2 of what the spin sets swinging");
  /* rho w^2 L^2/E = 3.2e-3 is the strain of the spin at most */
  VerifyValue("bodies", "diagonal of the turned square along x [m]",
              L * PetscSqrtReal(2.0) * PetscCosReal(PETSC_PI / 4 + 2), least, 0, 1e-2, "strain rho w^2 L^2/E");
  CHECK(PgBodiesDestroy(&b));
}

/* Rigid: a force off the centre gives linear and angular acceleration; half a step at the ends as Verlet has it. */
static void RigidMotion(void **state)
{
  const PetscReal L = 0.2, m = 2000 * L * L, inertia = m * L * L / 6, F[8] = {0, 3, 0, 0, 0, 0, 0, 0},
                  g[2] = {0.5, -9.81};
  const PetscReal dt   = 1e-4;
  PgBodies        b;
  PgBodyState     s;

  (void)state;
  CHECK(PgBodiesCreate(PETSC_COMM_WORLD, &b));
  CHECK(PgBodiesSetGravity(b, g));
  Square(b, PG_BODY_RIGID, 0, 0, L, 1);
  CHECK(PgBodiesSetForces(b, 0, F));
  for (int k = 0; k < 1000; k++) {
    CHECK(PgBodiesKickDrift(b, dt));
    CHECK(PgBodiesKick(b, dt));
  }
  s = Get(b);
  VerifyValue("bodies", "rigid: way of the centre in 0.1 s, x [m]", 0.5 * 0.5 * 0.01, s.centre[0] - 0.1, 0, 1e-11,
              "rounding of 1000 steps");
  VerifyValue("bodies", "rigid: way of the centre in 0.1 s, y [m]", 0.5 * (3 / m - 9.81) * 0.01, s.centre[1] - 0.1, 0,
              1e-11, "rounding of 1000 steps");
  /* the arm turns with the angle, which is 1.4e-2 */
  VerifyValue("bodies", "rigid: spin after 0.1 s [rad/s]", -0.1 * 3 / inertia * 0.1, s.spin, 0, 1e-2,
              "arm turns by the angle");
  CHECK(PgBodiesDestroy(&b));
}

static PetscErrorCode TryAdd(PetscInt break_it)
{
  PetscReal       x[8]    = {0, 0, 1, 0, 1, 1, 0, 1};
  PetscInt        cell[4] = {0, 1, 2, 3};
  PgBodyMesh      mesh    = {.nodes = 4, .cells = 1, .x = x, .cell = cell, .kind = PG_BODY_LINEAR, .E = 1, .rho = 1};
  const PetscReal out[2] = {1.1, 0.5}, traction[2] = {1, 0};
  PetscErrorCode  err;
  PgBodies        b;

  CHECK(PgBodiesCreate(PETSC_COMM_WORLD, &b));
  if (break_it == 1) mesh.rho = 0;
  if (break_it == 2) mesh.E = -1;
  if (break_it == 3) mesh.nu = 0.5;
  if (break_it == 4) cell[2] = 4;
  if (break_it == 5) x[4] = x[5] = 0.2;
  if (break_it == 6) mesh.rho = NAN;
  CHECK(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  err = PgBodiesAdd(b, &mesh, NULL);
  if (!err && break_it == 7) err = PgBodiesEmbed(b, 0, 1, out);
  if (!err && break_it == 8) err = PgBodiesAddTraction(b, 0, 0, 0.5, traction);
  CHECK(PetscPopErrorHandler());
  CHECK(PgBodiesDestroy(&b));
  return err;
}

static void Refusals(void **state)
{
  (void)state;
  assert_int_equal(TryAdd(0), 0);
  for (PetscInt k = 1; k <= 8; k++) assert_int_equal(TryAdd(k), PETSC_ERR_USER_INPUT);
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(PressureOnSurface), cmocka_unit_test(UniformStrain),
                                          cmocka_unit_test(Vibration),         cmocka_unit_test(Bar),
                                          cmocka_unit_test(Integrators),       cmocka_unit_test(OwnSteps),
                                          cmocka_unit_test(Turning),           cmocka_unit_test(RigidMotion),
                                          cmocka_unit_test(Refusals)};

int main(int argc, char *argv[])
{
  int failed;

  PetscCall(PgInitialize(&argc, &argv, "verification"));
  PetscCall(PetscSetFPTrap(PETSC_FP_TRAP_ON));
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PgFinalize(0) || failed;
}
