/* The press: discs at random places become a dense packing.

   The discs start so small that they fill FIRST_SOLID of the box and grow in steps to their radii, in a box with
   smooth walls, as soft frictionless discs (Lubachevsky & Stillinger's idea with the forces of a DEM). While they
   grow they are hardly damped: their motion lets them find room, where damped discs jam earlier and even out slowly.
   Then they relax with damping until no overlap is above what is allowed. Below the density where discs jam, both
   energies die out together; above it the kinetic energy dies out and the elastic energy stays.

   Units of the press: length of the packing, stiffness 1, mean mass 1, so that the time of a contact is about 1.
   It runs in a store of its own; being the DEM of the program, it has the same bits on any number of ranks. */
#include "packingimpl.h"

typedef struct {
  MPI_Comm    comm;
  PgParticles particles;
  PgNeighbors neighbors;
  PgDem       dem;
  PgField     full_radius;
  PetscReal   dt;
  PetscInt    steps;
} Press;

static PetscErrorCode AddWalls(Press *press, const PgBox *box, PetscBool periodic)
{
  static const char *const name[4] = {"left", "right", "bottom", "top"};

  PetscFunctionBeginUser;
  for (int k = periodic ? 2 : 0; k < 4; k++) {
    PgWall         wall = {.kind = PG_WALL_FIXED, .friction = 0};
    const PetscInt axis = k / 2, upper = k % 2;

    PetscCall(PetscStrncpy(wall.name, name[k], sizeof wall.name));
    wall.point[axis]  = upper ? box->high[axis] : box->low[axis];
    wall.normal[axis] = upper ? -1 : 1;
    PetscCall(PgDemAddWall(press->dem, &wall, NULL));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode SetUpParts(Press *press)
{
  const PgFieldInfo   full = {"full_radius", 1, "m", "radius at the end of the pressing",
                              PG_FIELD_MIGRATE | PG_FIELD_HALO};
  PgContactParameters soft = {0};

  PetscFunctionBeginUser;
  soft.k_n = 1;
  PetscCall(PgParticlesCreate(press->comm, &press->particles));
  PetscCall(PgParticlesRegisterField(press->particles, &full, &press->full_radius));
  PetscCall(PgNeighborsCreate(press->particles, &press->neighbors));
  PetscCall(PgDemCreate(press->particles, press->neighbors, &press->dem));
  PetscCall(PgDemSetParameters(press->dem, &soft));
  PetscFunctionReturn(0);
}

static PetscErrorCode PutDiscs(Press *press, const PgPacking *packing)
{
  PetscReal *x, *r, *full, *mass, mean, least = PETSC_MAX_REAL;
  PetscInt  *id;
  PgExactSum radii = {.not_finite = 0};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(packing->count, &id));
  for (PetscInt i = 0; i < packing->count; i++) id[i] = packing->start + i;
  PetscCall(PgParticlesSetDiscs(press->particles, packing->count, id));
  PetscCall(PetscFree(id));
  PetscCall(PgParticlesGetArray(press->particles, PG_POSITION, &x));
  PetscCall(PgParticlesGetArray(press->particles, PG_RADIUS, &r));
  PetscCall(PgParticlesGetArray(press->particles, PG_MASS, &mass));
  PetscCall(PgParticlesGetArray(press->particles, press->full_radius, &full));
  PetscCall(PetscArraycpy(x, packing->position, 2 * packing->count));
  for (PetscInt i = 0; i < packing->count; i++) {
    full[i] = r[i] = packing->radius[i];
    least          = PetscMin(least, full[i]);
    PgExactSumAdd(&radii, full[i]);
  }
  PetscCall(PgExactSumReduce(press->comm, 1, &radii, &mean));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPIU_REAL, MPIU_MIN, press->comm));
  mean /= (PetscReal)packing->global;
  for (PetscInt i = 0; i < packing->count; i++) mass[i] = (full[i] / mean) * (full[i] / mean);
  press->dt = 0.3 * least / mean; /* of sqrt(m/k) of the smallest disc: stable for up to about ten contacts */
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildLists(Press *press)
{
  PetscFunctionBeginUser;
  PetscCall(PgDemSaveHistory(press->dem));
  PetscCall(PgNeighborsBuild(press->neighbors));
  PetscCall(PgDemRestoreHistory(press->dem));
  PetscFunctionReturn(0);
}

static PetscErrorCode SetScale(Press *press, PetscReal scale)
{
  PetscReal *r, *full;
  PetscInt   owned, ghosts;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(press->particles, &owned, &ghosts, NULL));
  PetscCall(PgParticlesGetArray(press->particles, PG_RADIUS, &r));
  PetscCall(PgParticlesGetArray(press->particles, press->full_radius, &full));
  for (PetscInt i = 0; i < owned + ghosts; i++) r[i] = scale * full[i];
  PetscCall(BuildLists(press));
  PetscCall(PgDemForces(press->dem, 0.0));
  PetscFunctionReturn(0);
}

/* Whatever presses, no disc may leave its neighbours behind in a step. */
static PetscErrorCode LimitSpeed(Press *press)
{
  PetscReal *v, skin, most;
  PetscInt   owned;

  PetscFunctionBeginUser;
  PetscCall(PgNeighborsGetSkin(press->neighbors, &skin));
  PetscCall(PgParticlesGetSizes(press->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(press->particles, PG_VELOCITY, &v));
  most = 0.25 * skin / press->dt;
  for (PetscInt i = 0; i < owned; i++) {
    const PetscReal speed2 = v[2 * i] * v[2 * i] + v[2 * i + 1] * v[2 * i + 1];
    if (speed2 <= most * most) continue;
    v[2 * i] *= most / PetscSqrtReal(speed2);
    v[2 * i + 1] *= most / PetscSqrtReal(speed2);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Step(Press *press)
{
  static const PgField moving[3] = {PG_POSITION, PG_VELOCITY, PG_ANGULAR_VELOCITY};
  PetscBool            build;

  PetscFunctionBeginUser;
  PetscCall(PgDemKickDrift(press->dem, press->dt));
  PetscCall(PgNeighborsNeedBuild(press->neighbors, &build));
  if (build)
    PetscCall(BuildLists(press));
  else
    PetscCall(PgParticlesHalo(press->particles, 3, moving));
  PetscCall(PgDemForces(press->dem, press->dt));
  PetscCall(PgDemKick(press->dem, press->dt));
  PetscCall(LimitSpeed(press));
  press->steps++;
  PetscFunctionReturn(0);
}

/* Largest overlap over the smaller radius, and elastic energy. */
static PetscErrorCode Measure(Press *press, PetscReal *overlap, PetscReal *elastic, PetscReal *kinetic)
{
  PgContactList   list;
  PetscReal      *x, *r, worst = 0;
  PgExactSum      sum = {.not_finite = 0};
  PetscInt        owned;
  const PetscInt *id;

  PetscFunctionBeginUser;
  PetscCall(PgNeighborsGetContacts(press->neighbors, &list));
  PetscCall(PgParticlesGetSizes(press->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetIds(press->particles, &id));
  PetscCall(PgParticlesGetArray(press->particles, PG_POSITION, &x));
  PetscCall(PgParticlesGetArray(press->particles, PG_RADIUS, &r));
  for (PetscInt k = 0; k < list.count; k++) {
    const PetscInt  a = list.low[k], b = list.high[k];
    const PetscReal dx = x[2 * b] - x[2 * a], dy = x[2 * b + 1] - x[2 * a + 1];
    const PetscReal d = r[a] + r[b] - PetscSqrtReal(dx * dx + dy * dy);
    if (d <= 0 || a >= owned) continue; /* the owner of the smaller id counts the pair */
    worst = PetscMax(worst, d / PetscMin(r[a], r[b]));
    PgExactSumAdd(&sum, 0.5 * d * d);
  }
  PetscCallMPI(MPI_Allreduce(&worst, overlap, 1, MPIU_REAL, MPIU_MAX, press->comm));
  PetscCall(PgExactSumReduce(press->comm, 1, &sum, elastic));
  PetscCall(PgDemKineticEnergy(press->dem, kinetic));
  PetscFunctionReturn(0);
}

static PetscErrorCode Steps(Press *press, PetscInt steps)
{
  PetscFunctionBeginUser;
  for (PetscInt s = 0; s < steps; s++) PetscCall(Step(press));
  PetscFunctionReturn(0);
}

/* Numbers found by trying: 5000 discs at a porosity of 0.18 take a third of the steps that 1 % growth with full
   damping needs. */
static PetscErrorCode Grow(Press *press, PetscReal target)
{
  const PetscReal first_solid = 0.4, growth = 1.02;
  PetscReal       scale = PetscSqrtReal(PetscMin(1.0, first_solid / (1 - target)));

  PetscFunctionBeginUser;
  PetscCall(SetScale(press, scale));
  /* discs that happen to lie on each other are driven apart slowly */
  PetscCall(PgDemSetDamping(press->dem, 0, 1));
  press->dt /= 10;
  PetscCall(Steps(press, 300));
  press->dt *= 10;
  PetscCall(PgDemSetDamping(press->dem, 0, 0.005));
  while (scale < 1) {
    PetscCall(SetScale(press, scale));
    PetscCall(Steps(press, 60));
    scale *= growth;
  }
  PetscCall(SetScale(press, 1.0));
  PetscFunctionReturn(0);
}

static PetscErrorCode Relax(Press *press, const PgPackingPlan *plan)
{
  const PetscInt  last = press->steps + plan->steps;
  const PetscReal rest = 1e-4; /* kinetic over elastic energy; about 0.1 while both decay */
  PetscReal       overlap, elastic, kinetic;
  PetscBool       jammed = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PgDemSetDamping(press->dem, 0.2, 0.01));
  do {
    PetscCall(Steps(press, 100));
    PetscCall(Measure(press, &overlap, &elastic, &kinetic));
    if (overlap <= plan->overlap) PetscFunctionReturn(0);
    jammed = (PetscBool)(kinetic < rest * elastic);
  } while (!jammed && press->steps < last);
  PgInputCheck(
      !jammed, press->comm,
      "option -packing_target_porosity %g: the discs jam before; pressed together all the same, they overlap by "
      "up to %.2g of the smaller radius. Ask for a larger porosity (random packings jam at 0.16 to 0.17, those "
      "of a few hundred discs between walls at more), or allow this overlap: -packing_relax_overlap %.1g",
      (double)plan->target, (double)overlap, (double)(2 * overlap));
  PgInputError(
      press->comm,
      "option -packing_target_porosity %g: after -packing_relax_steps %" PetscInt_FMT
      " there are still overlaps of %.2g of the smaller radius, more than -packing_relax_overlap %g. Ask for a "
      "larger porosity (random packings jam at 0.16 to 0.17), more steps, or allow the overlap",
      (double)plan->target, plan->steps, (double)overlap, (double)plan->overlap);
}

PetscErrorCode PgPackingPress(MPI_Comm comm, const PgPackingPlan *plan, const PgBox *box, PgPacking *packing)
{
  Press          press = {.comm = comm};
  PetscReal     *x;
  PetscErrorCode err;

  PetscFunctionBeginUser;
  PetscCall(SetUpParts(&press));
  if (plan->periodic) PetscCall(PgParticlesSetPeriodicX(press.particles, box->low[0], box->high[0]));
  PetscCall(AddWalls(&press, box, plan->periodic));
  PetscCall(PutDiscs(&press, packing));
  PetscCall(PgNeighborsBuild(press.neighbors));
  PetscCall(PgDemRestoreHistory(press.dem));
  PetscCall(Grow(&press, plan->target));
  err = Relax(&press, plan);
  if (!err) {
    PetscCall(PgParticlesGetArray(press.particles, PG_POSITION, &x));
    PetscCall(PgParticlesToIdOrder(press.particles, 2, x, packing->position));
  }
  PetscCall(PgDemDestroy(&press.dem));
  PetscCall(PgNeighborsDestroy(&press.neighbors));
  PetscCall(PgParticlesDestroy(&press.particles));
  PetscFunctionReturn(err);
}
