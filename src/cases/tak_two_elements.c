/* Example 6.1 of Tak, Park & Park (2013): two rigid elements in a channel, liquid between them.

   Physics   a force on the left side of the left element drives the train of element, liquid and element along a channel;
             nothing holds the train. The channel is as high as elements and liquid, 9 spacings; walls above and below.
   Exact     while the walls take nothing, the train moves as one: p at the left end of the liquid is F/H times the mass of
             all that is to the right of it over the whole, 0.6 for the densities of the paper, 0.4 at the right end; all
             moves by F t^2/(2 m).
   Choices   every number that the paper does not give has its reason in options/tak_two_elements.opts and
             docs/tak2013.md. */
#include "tak.h"
#include <math.h>

enum { SIDE = 9 }; /* particles along a side of an element, of the liquid, and across the channel */

typedef struct {
  PgTak     tak;
  PetscReal force, start;  /* [N/m], [s] */
  PetscReal solid_density; /* [kg/m3] */
  PetscInt  layers, spare; /* of the walls: rows, columns beyond the elements at each end */
  PetscReal work, before;  /* of the force [J/m]; way of the left element a step ago [m] */
} Channel;

static PetscErrorCode Create(MPI_Comm comm, void **context)
{
  Channel *c;

  PetscFunctionBeginUser;
  PetscCall(PgCaseDefaults("-wcsph_rest_density 1000 -wcsph_viscosity 0.1 -wcsph_sound_speed 0.2 -neighbors_skin 0.5"));
  PetscCall(PetscNew(&c));
  *context = c;
  PetscCall(PgTakCreate(comm, &c->tak));
  c->tak.dx        = 0.02;
  c->force         = 1e-4;
  c->start         = 20.0;
  c->solid_density = 2000.0;
  c->layers        = 3;
  c->spare         = 2;
  PetscOptionsBegin(comm, "", "case tak_two_elements: two elements in a channel", "");
  PetscCall(PgOptionReal(PetscOptionsObject, "-tak_spacing",
                         "spacing of particles; elements, liquid and channel are 9 spacings high and long", "m",
                         PG_POSITIVE, 1e6, &c->tak.dx, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-tak_force", "force on the left side of the left element, to the right",
                         "N/m", -1e12, 1e12, &c->force, NULL));
  PetscCall(
      PgOptionReal(PetscOptionsObject, "-tak_force_start", "when it begins to act", "s", 0.0, 1e15, &c->start, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-tak_solid_density", "density of the elements", "kg/m3", PG_POSITIVE,
                         1e12, &c->solid_density, NULL));
  PetscCall(
      PgOptionInt(PetscOptionsObject, "-tak_wall_layers", "layers of particles of the walls", 1, 10, &c->layers, NULL));
  PetscCall(PgOptionInt(PetscOptionsObject, "-tak_wall_spare", "columns of the walls beyond the elements, at each end",
                        0, 100000, &c->spare, NULL));
  PetscOptionsEnd();
  PetscCall(PgTakRunOptions(&c->tak, 60.0));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(void **context)
{
  Channel *c = (Channel *)*context;

  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(0);
  PetscCall(PgTakDestroy(&c->tak));
  PetscCall(PetscFree(*context));
  PetscFunctionReturn(0);
}

static PetscErrorCode Fill(Channel *c)
{
  PgTak           *tak = &c->tak;
  const PetscReal  L = SIDE * tak->dx, beyond = tak->dx * (PetscReal)c->spare;
  const PetscInt   one[2] = {1, 1}, columns = 3 * SIDE + 2 * c->spare;
  const PgBodyMesh like = {.kind = PG_BODY_RIGID, .rho = c->solid_density};

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < 2; k++) {
    const PetscReal low[2] = {k ? 2 * L : 0, 0}, high[2] = {low[0] + L, L};
    PetscCall(PgBodiesAddBox(tak->bodies, &like, one, low, high, NULL));
    PetscCall(PgBodiesEmbedLattice(tak->bodies, k, tak->dx));
  }
  {
    const PetscReal middle[2] = {L, 0}, bottom[2] = {-beyond, -tak->dx * (PetscReal)c->layers}, top[2] = {-beyond, L};
    PetscCall(PgTakAddBlock(tak, PG_WCSPH_FLUID, 0, middle, SIDE, SIDE));
    PetscCall(PgTakAddBlock(tak, PG_WCSPH_WALL, 0, bottom, columns, c->layers));
    PetscCall(PgTakAddBlock(tak, PG_WCSPH_WALL, 1, top, columns, c->layers));
  }
  PetscCall(PgBodiesJoin(tak->bodies, tak->wcsph));
  PetscCall(PgWcsphSetUp(tak->wcsph));
  PetscCall(PgBodiesCouple(tak->bodies, tak->wcsph));
  PetscFunctionReturn(0);
}

enum {
  TIME,
  P_A,
  P_B,
  X_LEFT,
  X_RIGHT,
  V_LEFT,
  V_RIGHT,
  Y_LEFT,
  Y_RIGHT,
  MOMENTUM,
  IMPULSE,
  ENERGY,
  WORK,
  OUT,
  COLUMNS
};
static const PgColumn columns[COLUMNS] = {
    {"time", "s", "time"},
    {"pressure_a", "Pa", "pressure of the liquid at A, half a spacing from the middle of the face of the left element"},
    {"pressure_b", "Pa", "the same at B, at the right element"},
    {"displacement_left", "m", "way of the centre of the left element along the channel"},
    {"displacement_right", "m", "the same of the right element"},
    {"velocity_left", "m/s", "velocity of the left element along the channel"},
    {"velocity_right", "m/s", "the same of the right element"},
    {"lift_left", "m", "way of the centre of the left element across the channel"},
    {"lift_right", "m", "the same of the right element"},
    {"momentum", "kg/s", "momentum of liquid and elements along the channel"},
    {"impulse", "kg/s", "force times the time for which it has acted"},
    {"energy", "J/m", "kinetic energy of all and what the compressed liquid stores"},
    {"work", "J/m", "work of the force"},
    {"outside", "1", "particles of the liquid that are in a wall or in an element"},
};

static PetscErrorCode CountOutside(Channel *c, const PgBodyState body[2], PetscReal *outside)
{
  const PetscReal left = body[0].centre[0] + 0.5 * SIDE * c->tak.dx, right = body[1].centre[0] - 0.5 * SIDE * c->tak.dx;
  PgParticles     particles;
  PgField         kind;
  PetscReal      *x, *k;
  PetscInt        owned, count = 0;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetParticles(c->tak.wcsph, &particles));
  PetscCall(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  PetscCall(PgParticlesFindField(particles, "kind", &kind));
  PetscCall(PgParticlesGetArray(particles, kind, &k));
  PetscCall(PgParticlesGetArray(particles, PG_POSITION, &x));
  for (PetscInt i = 0; i < owned; i++)
    count += k[i] == (PetscReal)PG_WCSPH_FLUID &&
             (x[2 * i] < left || x[2 * i] > right || x[2 * i + 1] < 0 || x[2 * i + 1] > SIDE * c->tak.dx);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPIU_INT, MPI_SUM, c->tak.comm));
  *outside = (PetscReal)count;
  PetscFunctionReturn(0);
}

static PetscErrorCode FillRow(Channel *c, PetscReal row[COLUMNS])
{
  const PetscReal half = 0.5 * SIDE * c->tak.dx;
  PgBodyState     body[2];
  PgWcsphTotals   totals;
  PetscReal       x[4], p[2];

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetTime(c->tak.wcsph, NULL, &row[TIME]));
  PetscCall(PgWcsphGetTotals(c->tak.wcsph, &totals));
  for (PetscInt k = 0; k < 2; k++) {
    PetscCall(PgBodiesGet(c->tak.bodies, k, &body[k]));
    x[2 * k]     = body[k].centre[0] + (k ? -1 : 1) * (half + 0.5 * c->tak.dx);
    x[2 * k + 1] = half;
  }
  PetscCall(PgWcsphInterpolate(c->tak.wcsph, 2, x, p, NULL, NULL));
  row[P_A]      = p[0];
  row[P_B]      = p[1];
  row[X_LEFT]   = body[0].centre[0] - half;
  row[X_RIGHT]  = body[1].centre[0] - 5 * half;
  row[V_LEFT]   = body[0].velocity[0];
  row[V_RIGHT]  = body[1].velocity[0];
  row[Y_LEFT]   = body[0].centre[1] - half;
  row[Y_RIGHT]  = body[1].centre[1] - half;
  row[MOMENTUM] = totals.momentum[0] + body[0].mass * body[0].velocity[0] + body[1].mass * body[1].velocity[0];
  row[IMPULSE]  = c->force * PetscMax(0.0, row[TIME] - c->start);
  row[ENERGY]   = totals.kinetic + totals.internal + body[0].kinetic + body[1].kinetic;
  row[WORK]     = c->work;
  PetscCall(CountOutside(c, body, &row[OUT]));
  PetscFunctionReturn(0);
}

static PetscErrorCode Observe(Channel *c)
{
  const PgCaseRunDueNow due = PgCaseRunDue(&c->tak.run, c->tak.step);
  PetscReal             value[COLUMNS];

  PetscFunctionBeginUser;
  if (!due.row && !due.line && !due.snapshot) PetscFunctionReturn(0);
  PetscCall(FillRow(c, value));
  if (due.line)
    PetscCall(PetscPrintf(c->tak.comm, "t %.4e s  p A %.4e  p B %.4e Pa  way %.6e  %.6e m  outside %d\n",
                          (double)value[TIME], (double)value[P_A], (double)value[P_B], (double)value[X_LEFT],
                          (double)value[X_RIGHT], (int)value[OUT]));
  PetscCall(PgCaseRunWrite(&c->tak.run, due, value[TIME], value));
  PetscFunctionReturn(0);
}

/* The force acts in the steps that begin at or after its start, as a traction on the left side. */
static PetscErrorCode Load(Channel *c, PetscBool *loaded)
{
  const PetscReal traction[2] = {c->force / (SIDE * c->tak.dx), 0};
  PetscReal       time;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetTime(c->tak.wcsph, NULL, &time));
  if (*loaded || time < c->start - 1e-9 * c->tak.run.dt) PetscFunctionReturn(0);
  PetscCall(PgBodiesAddTraction(c->tak.bodies, 0, 0, 0.0, traction));
  *loaded = PETSC_TRUE;
  PetscFunctionReturn(0);
}

static PetscErrorCode TimeLoop(Channel *c)
{
  PetscBool   loaded = PETSC_FALSE, on = PETSC_TRUE;
  PgBodyState left;

  PetscFunctionBeginUser;
  PetscCall(Observe(c));
  while (on) {
    PetscCall(Load(c, &loaded));
    PetscCall(PgBodiesGet(c->tak.bodies, 0, &left));
    c->before = left.centre[0];
    PetscCall(PgTakStep(&c->tak));
    PetscCall(PgBodiesGet(c->tak.bodies, 0, &left));
    if (loaded) c->work += c->force * (left.centre[0] - c->before);
    PetscCall(Observe(c));
    PetscCall(PgCaseRunGoesOn(&c->tak.run, c->tak.step, &on));
  }
  if (c->tak.run.output) PetscCall(PgOutputFinish(c->tak.run.output));
  PetscFunctionReturn(0);
}

static const PgOptionRule rules[] = {
    {"-wcsph_contact", "-bodies_coupling reactions", "Q p knows no contact"},
    {"-wcsph_contact_friction", "-bodies_coupling reactions", "Q p knows no friction"},
};

static PetscErrorCode RunCase(MPI_Comm comm, void *context, const char output[])
{
  const PgOptionRules all = {.count = sizeof rules / sizeof *rules, .rule = rules};
  Channel            *c   = (Channel *)context;
  PetscErrorCode      err;

  PetscFunctionBeginUser;
  PetscCall(PgStagePush(PG_STAGE_SETUP));
  PetscCall(Fill(c));
  PetscCall(PgTakChooseSteps(&c->tak));
  PetscCall(PgTakStart(&c->tak, output, COLUMNS, columns, &all, NULL, NULL));
  PetscCall(PgStagePop());
  err = TimeLoop(c);
  PgEndingStop();
  if (!err && output[0]) PetscCall(PetscPrintf(comm, "wrote %s\n", output));
  if (!err) PetscCall(PgTakSummary(&c->tak, NULL));
  PetscFunctionReturn(err);
}

const PgCaseInfo PgCaseTakTwoElements = {.name    = "tak_two_elements",
                                         .summary = "two rigid elements with liquid between them, in a channel",
                                         .create  = Create,
                                         .destroy = Destroy,
                                         .run     = RunCase};
