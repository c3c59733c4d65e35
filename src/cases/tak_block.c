/* Example 6.2 of Tak, Park & Park (2013): two blocks of saturated ground, between them liquid with three bodies in it.

   Physics   a traction presses on the left side of zone 1, which lets water out there; zone 1 pushes on the liquid and the
             bodies of zone 3, that on zone 2, whose right side is fixed. All slide on top and bottom, which let no water
             through.
   Exact     once at rest the traction is everywhere: the liquid, the bodies and the pore water of what has had no time to
             drain carry it, 1 Pa.
   Choices   sizes and shapes are not in the paper: zones of 18 spacings square, bodies of squares of 4 spacings. What is
             embedded in the sides of zones 1 and 2 reaches beyond the channel, so that the corners of the liquid lean on
             the zones and not on the channel. */
#include "tak_zone.h"

enum { SIDE = 18, LAYERS = PG_TAK_ZONE_LAYERS, ZONES = 2, BODIES = 3 };

typedef struct {
  PgTak     tak;
  PgTakZone zone[ZONES];
  PgSolves  solves;     /* of the zones */
  PetscReal traction;   /* [Pa] */
  PetscReal E, nu, rho; /* of the bodies */
  PetscInt  cells[2];   /* of each zone, along and across */
  PetscInt  every, sub; /* steps in a step of the zones, those done of it */
  PetscInt  kind;       /* PgBodyKind */
  PetscBool corners;    /* of the liquid lean on the zones */
} Block;

static const char *const kinds[] = {"rigid", "linear", "finite"};

static PetscErrorCode ReadOptions(Block *b, PetscOptionItems *PetscOptionsObject)
{
  PetscReal cells[2] = {(PetscReal)b->cells[0], (PetscReal)b->cells[1]};

  PetscFunctionBeginUser;
  PetscCall(PgOptionReal(PetscOptionsObject, "-tak_block_spacing",
                         "spacing of particles; each zone is 18 by 18 of them", "m", PG_POSITIVE, 1e6, &b->tak.dx,
                         NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-tak_block_traction", "traction on the left side of zone 1, to the right",
                         "Pa", -1e12, 1e12, &b->traction, NULL));
  PetscCall(PgOptionChoice(PetscOptionsObject, "-tak_block_bodies",
                           "bodies that are rigid, deform by small strains, or by Green's strain", 3, kinds, &b->kind,
                           NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-tak_block_young", "Young's modulus of the bodies", "Pa", PG_POSITIVE,
                         1e15, &b->E, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-tak_block_poisson", "Poisson's ratio of the bodies", "1", 0.0, 0.499,
                         &b->nu, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-tak_block_density", "density of the bodies", "kg/m3", PG_POSITIVE, 1e12,
                         &b->rho, NULL));
  PetscCall(PgOptionReals(PetscOptionsObject, "-tak_block_cells", "cells of zones 1 and 2, along and across", "1", 2,
                          cells, NULL));
  PetscCall(PgOptionInt(PetscOptionsObject, "-tak_block_every", "steps of the liquid in a step of the zones", 1, 100000,
                        &b->every, NULL));
  PetscCall(
      PgOptionBool(PetscOptionsObject, "-tak_block_corners",
                   "the sides of the zones reach beyond the channel, whose walls end there; else the walls go on, and "
                   "take a part of the thrust",
                   &b->corners, NULL));
  for (int d = 0; d < 2; d++) {
    b->cells[d] = (PetscInt)cells[d];
    PgInputCheck((PetscReal)b->cells[d] == cells[d] && cells[d] >= 1 && cells[d] <= 1e4, b->tak.comm,
                 "option -tak_block_cells: %g is no number of cells between 1 and 10000", (double)cells[d]);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Conditions(Block *b, PetscInt k)
{
  const PetscReal zero = 0.0, traction[2] = {b->traction, 0.0};
  PgFem           fem = b->zone[k].fem;

  PetscFunctionBeginUser;
  PetscCall(PgFemSetCondition(fem, "bottom", PG_FEM_DISPLACEMENT_Y, &zero));
  PetscCall(PgFemSetCondition(fem, "top", PG_FEM_DISPLACEMENT_Y, &zero));
  if (k == 0) {
    PetscCall(PgFemSetCondition(fem, "left", PG_FEM_TRACTION, traction));
    PetscCall(PgFemSetCondition(fem, "left", PG_FEM_PRESSURE, &zero));
  } else {
    PetscCall(PgFemSetCondition(fem, "right", PG_FEM_DISPLACEMENT_X, &zero));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Create(MPI_Comm comm, void **context)
{
  Block *b;

  PetscFunctionBeginUser;
  PetscCall(PgCaseDefaults(
      "-wcsph_rest_density 1000 -wcsph_viscosity 0.1 -wcsph_sound_speed 0.5 -wcsph_contact 0 -neighbors_skin 0.5 "
      "-up_young 3e7 -up_poisson 0.48 -up_porosity 0.3 -up_permeability 1e-17 -up_viscosity 0.1 -up_density_grains "
      "2000 "
      "-up_density_water 1000 -up_inertia true -up_damping 1 -up_ksp_type preonly -up_pc_type lu "
      "-up_pc_factor_mat_solver_type mumps"));
  PetscCall(PetscNew(&b));
  *context = b;
  PetscCall(PgTakCreate(comm, &b->tak));
  b->tak.dx   = 0.02;
  b->traction = 1.0;
  b->E        = 1e9;
  b->nu       = 0.48;
  b->rho      = 2000.0;
  b->cells[0] = 100;
  b->cells[1] = 3;
  b->every    = 1;
  b->kind     = PG_BODY_FINITE;
  b->corners  = PETSC_TRUE;
  PetscOptionsBegin(comm, "", "case tak_block: blocks, liquid and bodies", "");
  PetscCall(ReadOptions(b, PetscOptionsObject));
  PetscOptionsEnd();
  PetscCall(PgTakRunOptions(&b->tak, 20.0));
  for (PetscInt k = 0; k < ZONES; k++) {
    const PetscReal L = SIDE * b->tak.dx, low[2] = {k ? 2 * L : 0, 0}, high[2] = {low[0] + L, L};

    PgTakZone *z = &b->zone[k];

    z->comm  = comm;
    z->body  = BODIES + k;
    z->left  = (PetscBool)k;
    z->at    = k ? low[0] : high[0];
    z->L     = L;
    z->count = b->cells[1];
    PetscCall(PgFemCreate(comm, &z->fem));
    PetscCall(PgFemSetBox(z->fem, b->cells, low, high));
    PetscCall(PgFemSetFromOptions(z->fem));
    PetscCall(Conditions(b, k));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(void **context)
{
  Block *b = (Block *)*context;

  PetscFunctionBeginUser;
  if (!b) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < ZONES; k++) PetscCall(PgTakZoneDestroy(&b->zone[k]));
  PetscCall(PgTakDestroy(&b->tak));
  PetscCall(PetscFree(*context));
  PetscFunctionReturn(0);
}

/* ---- set-up ---- */

/* Lower left corners and sizes of the bodies in spacings, each of squares of 4. */
static PetscErrorCode AddBodies(Block *b)
{
  static const PetscInt place[BODIES][4] = {{2, 1, 4, 16}, {8, 2, 8, 8}, {8, 12, 8, 4}};
  const PgBodyMesh      like             = {.kind = (PgBodyKind)b->kind, .E = b->E, .nu = b->nu, .rho = b->rho};

  PetscFunctionBeginUser;
  for (int k = 0; k < BODIES; k++) {
    const PetscInt  cells[2] = {place[k][2] / 4, place[k][3] / 4};
    const PetscReal dx = b->tak.dx, low[2] = {dx * (PetscReal)(SIDE + place[k][0]), dx * (PetscReal)place[k][1]};
    const PetscReal high[2] = {low[0] + dx * (PetscReal)place[k][2], low[1] + dx * (PetscReal)place[k][3]};

    PetscCall(PgBodiesAddBox(b->tak.bodies, &like, cells, low, high, NULL));
    PetscCall(PgBodiesEmbedLattice(b->tak.bodies, k, dx));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Motion(void *context, PetscInt count, const PetscInt body[], const PetscInt index[],
                             PetscReal x[], PetscReal v[])
{
  const Block    *b    = (const Block *)context;
  const PetscReal done = (PetscReal)b->sub / (PetscReal)b->every;

  PetscFunctionBeginUser;
  PetscCall(PgBodiesMotion(b->tak.bodies, count, body, index, x, v));
  for (PetscInt n = 0; n < count; n++) {
    if (body[n] < BODIES) continue;
    PgTakZoneMove(&b->zone[body[n] - BODIES], index[n], done, &x[2 * n], &v[2 * n]);
  }
  PetscFunctionReturn(0);
}

/* ---- forces of the liquid on the zones, and the way of their sides ---- */

static PetscErrorCode TakeForces(Block *b)
{
  PgWcsphSolids solids;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetSolids(b->tak.wcsph, PG_WCSPH_BODY, &solids));
  for (PetscInt k = 0; k < ZONES; k++) PetscCall(PgTakZoneTakeForces(&b->zone[k], &solids));
  PetscFunctionReturn(0);
}

static PetscErrorCode StepZones(Block *b)
{
  const PetscReal dt = b->tak.run.dt * (PetscReal)b->every;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < ZONES; k++) PetscCall(PgTakZoneStep(&b->zone[k], dt, &b->solves));
  b->sub = 0;
  PetscFunctionReturn(0);
}

static PetscErrorCode Fill(Block *b)
{
  const PetscInt  more = b->corners ? 0 : LAYERS;
  const PetscReal dx = b->tak.dx, L = SIDE * dx, low[2] = {L, 0}, left = L - dx * (PetscReal)more;
  const PetscReal below[2] = {left, -LAYERS * dx}, above[2] = {left, L};

  PetscReal reach;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetReach(b->tak.wcsph, &reach));
  /* particles half a spacing from a face see its layers at 1, 2, 3 spacings */
  PgInputCheck(
      reach < (LAYERS + 1) * dx * (1.0 - 1e-9), b->tak.comm,
      "option -wcsph_smoothing: the kernel reaches %g spacings, the sides of the zones and the walls are %d deep "
      "and bear less than %d",
      (double)(reach / dx), LAYERS, LAYERS + 1);
  PetscCall(AddBodies(b));
  PetscCall(PgTakAddBlock(&b->tak, PG_WCSPH_FLUID, 0, low, SIDE, SIDE));
  PetscCall(PgTakAddBlock(&b->tak, PG_WCSPH_WALL, 0, below, SIDE + 2 * more, LAYERS));
  PetscCall(PgTakAddBlock(&b->tak, PG_WCSPH_WALL, 1, above, SIDE + 2 * more, LAYERS));
  PetscCall(PgBodiesJoin(b->tak.bodies, b->tak.wcsph));
  for (PetscInt k = 0; k < ZONES; k++) {
    PetscCall(PgTakZoneSetUp(&b->zone[k], dx, SIDE, b->corners ? LAYERS : 0));
    PetscCall(PgTakZoneAddParticles(&b->zone[k], b->tak.wcsph));
  }
  PetscCall(PgWcsphSetMotion(b->tak.wcsph, Motion, b));
  PetscCall(PgWcsphSetUp(b->tak.wcsph));
  PetscCall(PgBodiesCouple(b->tak.bodies, b->tak.wcsph));
  PetscCall(TakeForces(b));
  PetscFunctionReturn(0);
}

/* ---- results ---- */

enum { TIME, P_LIQUID, P_STD, STRESS_1, STRESS_2, PORE_1, PORE_2, WAY_1, WAY_2, STRAIN, ELASTIC, ENERGY, COLUMNS };
static const PgColumn columns[COLUMNS] = {
    {"time", "s", "time"},
    {"pressure_liquid", "Pa", "mean pressure of the liquid, by volume"},
    {"pressure_deviation", "Pa", "standard deviation of the pressure of its particles"},
    {"stress_1", "Pa", "force of the liquid on zone 1 over the height, compression positive"},
    {"stress_2", "Pa", "the same on zone 2"},
    {"pore_pressure_1", "Pa", "mean pore pressure of the right half of zone 1"},
    {"pore_pressure_2", "Pa", "mean pore pressure of zone 2"},
    {"displacement_1", "m", "mean way of the right side of zone 1, to the right"},
    {"displacement_2", "m", "mean way of the left side of zone 2, to the right"},
    {"body_strain", "1", "area that the bodies have lost over that which they had"},
    {"body_energy", "J/m", "elastic energy of the bodies"},
    {"energy", "J/m", "kinetic energy of liquid and bodies, and what the liquid stores"},
};

static PetscErrorCode Pressure(Block *b, PetscReal *mean, PetscReal *deviation)
{
  PgExactSum  sum[3] = {{.not_finite = 0}, {.not_finite = 0}, {.not_finite = 0}};
  PgParticles particles;
  PgField     field[3];
  PetscReal  *kind, *rho, *p, *m, value[3];
  PetscInt    owned;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetParticles(b->tak.wcsph, &particles));
  PetscCall(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  PetscCall(PgParticlesFindField(particles, "kind", &field[0]));
  PetscCall(PgParticlesFindField(particles, "density", &field[1]));
  PetscCall(PgParticlesFindField(particles, "pressure", &field[2]));
  PetscCall(PgParticlesGetArray(particles, field[0], &kind));
  PetscCall(PgParticlesGetArray(particles, field[1], &rho));
  PetscCall(PgParticlesGetArray(particles, field[2], &p));
  PetscCall(PgParticlesGetArray(particles, PG_MASS, &m));
  for (PetscInt i = 0; i < owned; i++) {
    const PetscReal V = m[i] / rho[i];
    if (kind[i] != (PetscReal)PG_WCSPH_FLUID) continue;
    PgExactSumAdd(&sum[0], V);
    PgExactSumAdd(&sum[1], V * p[i]);
    PgExactSumAdd(&sum[2], V * p[i] * p[i]);
  }
  PetscCall(PgExactSumReduce(b->tak.comm, 3, sum, value));
  *mean      = value[1] / value[0];
  *deviation = PetscSqrtReal(PetscMax(0.0, value[2] / value[0] - *mean * *mean));
  PetscFunctionReturn(0);
}

static void Pore(void *context, const PgFemPoint *point, PetscReal value[])
{
  const PetscReal from = *(const PetscReal *)context;

  value[0] = point->x[0] > from ? point->pressure : 0.0;
  value[1] = point->x[0] > from ? 1.0 : 0.0;
}

static PetscReal Area(const PgBodyState *s, const PetscReal x[])
{
  PetscReal area = 0.0;

  for (PetscInt e = 0; e < s->edges; e++) {
    const PetscReal *p = &x[2 * s->edge[2 * e]], *q = &x[2 * s->edge[2 * e + 1]];
    area += 0.5 * (p[0] * q[1] - q[0] * p[1]);
  }
  return area;
}

static PetscErrorCode FillRow(Block *b, PetscReal row[COLUMNS])
{
  PgWcsphTotals totals;
  PetscReal     area[2] = {0, 0};

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetTime(b->tak.wcsph, NULL, &row[TIME]));
  PetscCall(PgWcsphGetTotals(b->tak.wcsph, &totals));
  PetscCall(Pressure(b, &row[P_LIQUID], &row[P_STD]));
  row[ELASTIC] = 0.0;
  row[ENERGY]  = totals.kinetic + totals.internal;
  for (PetscInt k = 0; k < BODIES; k++) {
    PgBodyState s;
    PetscCall(PgBodiesGet(b->tak.bodies, k, &s));
    area[0] += Area(&s, s.X);
    area[1] += Area(&s, s.x);
    row[ELASTIC] += s.elastic;
    row[ENERGY] += s.kinetic + s.elastic;
  }
  row[STRAIN] = 1.0 - area[1] / area[0];
  for (PetscInt k = 0; k < ZONES; k++) {
    const PgTakZone *z    = &b->zone[k];
    const PetscReal  from = k ? 0.0 : 0.5 * z->L;
    PetscReal        pore[2];

    PetscCall(PgFemIntegrate(z->fem, 2, Pore, (void *)&from, pore));
    row[PORE_1 + k]   = pore[0] / pore[1];
    row[WAY_1 + k]    = PgTakZoneWay(z, (PetscReal)b->sub / (PetscReal)b->every);
    row[STRESS_1 + k] = (k ? 1 : -1) * z->total[0] / z->L;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Observe(Block *b)
{
  const PgCaseRunDueNow due = PgCaseRunDue(&b->tak.run, b->tak.step);
  PetscReal             value[COLUMNS];

  PetscFunctionBeginUser;
  if (!due.row && !due.line && !due.snapshot) PetscFunctionReturn(0);
  PetscCall(FillRow(b, value));
  if (due.line)
    PetscCall(PetscPrintf(b->tak.comm,
                          "t %.4e s  liquid %.4f Pa  on zones %.4f %.4f Pa  pores %.4f %.4f Pa  way %.4e m\n",
                          (double)value[TIME], (double)value[P_LIQUID], (double)value[STRESS_1],
                          (double)value[STRESS_2], (double)value[PORE_1], (double)value[PORE_2], (double)value[WAY_1]));
  PetscCall(PgCaseRunWrite(&b->tak.run, due, value[TIME], value));
  PetscFunctionReturn(0);
}

/* The zones go first, with the forces of the liquid as it is; then liquid and bodies, their sides moving evenly. */
static PetscErrorCode TimeLoop(Block *b)
{
  PetscBool on = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(Observe(b));
  while (on) {
    if (b->tak.step % b->every == 0) PetscCall(StepZones(b));
    b->sub++;
    PetscCall(PgTakStep(&b->tak));
    PetscCall(TakeForces(b));
    PetscCall(Observe(b));
    PetscCall(PgCaseRunGoesOn(&b->tak.run, b->tak.step, &on));
  }
  if (b->tak.run.output) PetscCall(PgOutputFinish(b->tak.run.output));
  PetscFunctionReturn(0);
}

static const PgOptionRule rules[] = {
    {"-tak_block_young", "-tak_block_bodies linear|finite", "rigid bodies do not deform"},
    {"-tak_block_poisson", "-tak_block_bodies linear|finite", "rigid bodies do not deform"},
};

static PetscErrorCode RunCase(MPI_Comm comm, void *context, const char output[])
{
  const PgOptionRules all = {.count = sizeof rules / sizeof *rules, .rule = rules};
  Block              *b   = (Block *)context;
  PetscErrorCode      err;

  PetscFunctionBeginUser;
  PetscCall(PgStagePush(PG_STAGE_SETUP));
  PetscCall(Fill(b));
  PetscCall(PgTakChooseSteps(&b->tak));
  for (PetscInt k = 0; k < ZONES; k++) PetscCall(PgFemSetUpSolver(b->zone[k].fem, b->tak.run.dt * (PetscReal)b->every));
  PetscCall(PgTakStart(&b->tak, output, COLUMNS, columns, &all, PgFemProbeOptions, b->zone[0].fem));
  PetscCall(PgStagePop());
  for (PetscInt k = 0; k < ZONES; k++) PetscCall(PgFemView(b->zone[k].fem, PETSC_VIEWER_STDOUT_(comm)));
  err = TimeLoop(b);
  PgEndingStop();
  if (!err && output[0]) PetscCall(PetscPrintf(comm, "wrote %s\n", output));
  if (!err) PetscCall(PgTakSummary(&b->tak, &b->solves));
  PetscFunctionReturn(err);
}

const PgCaseInfo PgCaseTakBlock = {.name    = "tak_block",
                                   .summary = "two blocks of saturated ground with liquid and bodies between them",
                                   .create  = Create,
                                   .destroy = Destroy,
                                   .run     = RunCase};
