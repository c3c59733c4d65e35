/* Energy accounts: where the energy of the discs came from and where it went.

   Velocity Verlet changes the kinetic energy of a disc in a step by half the sum of the old and the new force times
   the way dt v at the half-step velocity, and by dt^2/8 times the change of F^2/m, which adds up to the difference
   between the end and the start and is all that the budget may be off by while directions do not change. So every
   work is booked in two halves with that velocity: with the forces at the old positions before the drift, with those
   at the new positions after their evaluation. Springs are then exact: the mean force times the way is the change of
   f^2/(2k) and what slip at a cap took, mean force times slip.

   Of the work on a pair each disc books its own part (v_a t + r_a w_a of the sliding rate, say), so that no ghost
   velocities are needed and nothing of the lists is; only sums over discs have a meaning there. What caps take is shared equally. Accounts are
   kept by disc and summed up exactly when asked for, so they are the same on any number of ranks. */
#include "demimpl.h"

enum {
  STARTED,
  START,
  KINETIC,
  SLIDING,
  ROLLING,
  MOMENT,
  DASHPOTS,
  LOCAL,
  GLOBAL,
  EXCESS,
  PLATES,
  WALLS,
  GRAVITY,
  FLUID,
  EXTERNAL,
  ACCOUNTS
};
enum { NOTED_PAIRS = 10 }; /* place in energy_force */

PetscErrorCode PgDemSetEnergy(PgDem dem, PetscBool on)
{
  const unsigned    kept   = PG_FIELD_MIGRATE | PG_FIELD_RESTART;
  const PgFieldInfo info[] = {
      {"energy_account", ACCOUNTS, "J/m", "Energy accounts of the disc", kept},
      {"energy_force", PG_ENERGY_FORCES, "N/m",
       "Forces of local (3) and global damping (3), water and outside at the last evaluation; factors of (v_x, v_y, w) "
       "in what dashpots and rolling forces take",
       kept},
      {"friction_energy", 1, "J/m", "Energy that slip in the contacts of the disc has taken, half of each contact",
       PG_FIELD_OUTPUT}};

  PetscFunctionBeginUser;
  dem->energy = on;
  if (!on) PetscFunctionReturn(0);
  PetscCall(PgParticlesRegisterField(dem->particles, &info[0], &dem->energy_account));
  PetscCall(PgParticlesRegisterField(dem->particles, &info[1], &dem->energy_force));
  PetscCall(PgParticlesRegisterField(dem->particles, &info[2], &dem->friction_energy));
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemHasEnergy(PgDem dem, PetscBool *on)
{
  PetscFunctionBeginUser;
  *on = dem->energy;
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemGetFrictionAccount_Private(PgDem dem, PetscReal **account, PetscInt *stride)
{
  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetArray(dem->particles, dem->energy_account, account));
  *account += SLIDING;
  *stride = ACCOUNTS;
  PetscFunctionReturn(0);
}

/* Arrays of one booking. */
typedef struct {
  PgContactList    list;
  PgDemDiscs       discs;
  const PetscReal *m, *plate, *spring, *reaction;
  PetscReal       *noted;   /* PG_ENERGY_FORCES by disc */
  PetscReal       *account; /* ACCOUNTS by disc */
  PetscInt         owned;
} Books;

static PetscErrorCode GetBooks(PgDem dem, Books *b)
{
  PetscFunctionBeginUser;
  PetscCall(PgDemGetContacts_Private(dem, &b->list));
  PetscCall(PgDemGetDiscs_Private(dem, &b->discs));
  PetscCall(PgParticlesGetSizes(dem->particles, &b->owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(dem->particles, PG_MASS, (PetscReal **)&b->m));
  PetscCall(PgParticlesGetArray(dem->particles, dem->plate, (PetscReal **)&b->plate));
  PetscCall(PgParticlesGetArray(dem->particles, dem->plate_spring, (PetscReal **)&b->spring));
  PetscCall(PgParticlesGetArray(dem->particles, dem->plate_reaction, (PetscReal **)&b->reaction));
  PetscCall(PgParticlesGetArray(dem->particles, dem->energy_force, &b->noted));
  PetscCall(PgParticlesGetArray(dem->particles, dem->energy_account, &b->account));
  PetscFunctionReturn(0);
}

/* ---- what springs hold ---- */

typedef struct {
  PetscReal normal, sliding, rolling, moment; /* [J/m] */
} Elastic;

static PetscReal Stored(PetscReal force, PetscReal k) { return k > 0 ? 0.5 * force * force / k : 0; }

static void AddElastic(const PgContactParameters *p, PetscReal overlap, PetscReal f_s, PetscReal f_r, PetscReal m_r,
                       PetscReal share, Elastic *e)
{
  const PetscReal u = PetscMax(overlap, 0);

  e->normal += share * 0.5 * p->k_n * u * u;
  e->sliding += share * Stored(f_s, p->k_s);
  e->rolling += share * Stored(f_r, p->k_r);
  e->moment += share * Stored(m_r, p->k_theta);
}

/* Of disc i: half of its contacts with discs, all of those with walls and its plate. */
static Elastic DiscElastic(PgDem dem, const Books *b, PetscInt i)
{
  const PgContactParameters *p = &dem->parameters;
  Elastic                    e = {0, 0, 0, 0};

  for (PetscInt k = b->list.ptr[i]; k < b->list.ptr[i + 1]; k++) {
    const PetscInt pair = b->list.sum[k] >> 1;
    PetscReal      n[2];

    AddElastic(p, PgDemPairGeometry(&b->discs, b->list.low[pair], b->list.high[pair], n), dem->pairs.f_s[pair],
               dem->pairs.f_r[pair], dem->pairs.m_r[pair], 0.5, &e);
  }
  for (PetscInt k = PgDemFindWallContact_Private(dem, i); k < dem->wall_contact_count && dem->wall_contact[k].disc == i;
       k++) {
    const PgWallContact *c = &dem->wall_contact[k];

    AddElastic(p, PgDemWallOverlap(&dem->walls[c->wall]->wall, &b->discs.position[2 * i], b->discs.radius[i]),
               c->history.f_s, c->history.f_r, c->history.m_r, 1, &e);
  }
  e.sliding += Stored(b->spring[i], p->k_s);
  return e;
}

/* ---- work ---- */

/* What dashpots and the rolling force take is linear in the velocities of each disc: the factors of (v_x, v_y, w). */
typedef struct {
  PetscReal dashpots[3], excess[3];
} Factors;

/* Adds those of one side of a contact, side 1 for the disc that n, t and the force belong to, -1 for its partner:
   overlap rate side v.n, sliding rate side v.t + r w, rolling rate -r w, spin rate side w. */
static void AddFactors(const PgContactParameters *p, const PgContactForce *f, const PgContactHistory *history,
                       PetscReal overlap, const PetscReal n[2], PetscReal side, PetscReal r, Factors *factors)
{
  const PetscReal normal  = f->F_N + p->k_n * PetscMax(overlap, 0);
  const PetscReal sliding = (f->F_T - history->f_s) - history->f_r; /* dashpots, or the cap of F_s + F_r */
  PetscReal      *other   = p->c_s > 0 || p->c_r > 0 ? factors->dashpots : factors->excess;

  factors->dashpots[0] += side * normal * n[0];
  factors->dashpots[1] += side * normal * n[1];
  factors->dashpots[2] += side * (f->M_r - history->m_r);
  other[0] -= side * sliding * n[1];
  other[1] += side * sliding * n[0];
  other[2] += sliding * r;
  factors->excess[0] -= side * history->f_r * n[1];
  factors->excess[1] += side * history->f_r * n[0];
  factors->excess[2] += 2 * r * history->f_r;
}

/* Of all pairs of disc i, noted behind the forces until the next evaluation, whatever happens to the lists. */
static void NotePairs(PgDem dem, const Books *b, PetscInt i, PetscReal noted[])
{
  Factors factors = {{0, 0, 0}, {0, 0, 0}};

  for (PetscInt k = b->list.ptr[i]; k < b->list.ptr[i + 1]; k++) {
    const PetscInt         entry = b->list.sum[k], pair = entry >> 1, a = b->list.low[pair], j = b->list.high[pair];
    const PetscReal       *f       = &dem->pairs.result[4 * pair];
    const PgContactHistory history = {dem->pairs.f_s[pair], dem->pairs.f_r[pair], dem->pairs.m_r[pair]};
    PetscReal              n[2];
    const PetscReal        overlap = PgDemPairGeometry(&b->discs, a, j, n);
    const PetscReal        F_T     = f[1] * n[0] - f[0] * n[1];
    const PgContactForce   force   = {f[0] * n[0] + f[1] * n[1], F_T, f[2] - b->discs.radius[a] * F_T};

    if (overlap > 0)
      AddFactors(&dem->parameters, &force, &history, overlap, n, entry & 1 ? -1 : 1, b->discs.radius[i], &factors);
  }
  for (PetscInt d = 0; d < 3; d++) {
    noted[d]     = factors.dashpots[d];
    noted[3 + d] = factors.excess[d];
  }
}

static void BookWalls(PgDem dem, const Books *b, PetscReal h)
{
  for (PetscInt k = 0; k < dem->wall_contact_count; k++) {
    const PgWallContact *c = &dem->wall_contact[k];
    const PgWall        *w = &dem->walls[c->wall]->wall;
    const PetscReal     *v = &b->discs.velocity[2 * c->disc], r = b->discs.radius[c->disc];
    const PetscReal      u[3]    = {v[0] - w->velocity[0], v[1] - w->velocity[1], b->discs.spin[c->disc]};
    const PetscReal      n[2]    = {-w->normal[0], -w->normal[1]};
    const PetscReal      overlap = PgDemWallOverlap(w, &b->discs.position[2 * c->disc], r);
    PetscReal           *account = &b->account[ACCOUNTS * c->disc], f[3];
    Factors              factors = {{0, 0, 0}, {0, 0, 0}};

    PgDemWallContactForce_Private(dem, c, r, f);
    account[WALLS] += h * (f[0] * w->velocity[0] + f[1] * w->velocity[1]);
    if (!(overlap > 0)) continue;
    AddFactors(&dem->parameters, &c->force, &c->history, overlap, n, 1, r, &factors);
    for (PetscInt d = 0; d < 3; d++) {
      account[DASHPOTS] -= h * factors.dashpots[d] * u[d];
      account[EXCESS] -= h * factors.excess[d] * u[d];
    }
  }
}

/* What acts on disc i beside walls. */
static void BookDisc(PgDem dem, const Books *b, PetscInt i, PetscReal h)
{
  const PetscReal *v = &b->discs.velocity[2 * i], w = b->discs.spin[i];
  const PetscReal *f       = &b->noted[PG_ENERGY_FORCES * i];
  PetscReal       *account = &b->account[ACCOUNTS * i];

  account[LOCAL] -= h * (f[0] * v[0] + f[1] * v[1] + f[2] * w);
  account[GLOBAL] -= h * (f[3] * v[0] + f[4] * v[1] + f[5] * w);
  account[FLUID] += h * (f[6] * v[0] + f[7] * v[1]);
  account[EXTERNAL] += h * (f[8] * v[0] + f[9] * v[1]);
  account[DASHPOTS] -= h * (f[10] * v[0] + f[11] * v[1] + f[12] * w);
  account[EXCESS] -= h * (f[13] * v[0] + f[14] * v[1] + f[15] * w);
  account[GRAVITY] += h * b->m[i] * (dem->gravity[0] * v[0] + dem->gravity[1] * v[1]);
}

/* What the caps took in the step that ends here; DASHPOTS comes right after the three of them. */
static void BookCaps(PgDem dem, const Books *b)
{
  for (PetscInt i = 0; i < b->owned; i++)
    for (PetscInt k = b->list.ptr[i]; k < b->list.ptr[i + 1]; k++)
      for (PetscInt c = 0; c < PG_LOST; c++)
        b->account[ACCOUNTS * i + SLIDING + c] += 0.5 * dem->pairs.lost[PG_LOST * (b->list.sum[k] >> 1) + c];
  for (PetscInt k = 0; k < dem->wall_contact_count; k++)
    for (PetscInt c = 0; c < PG_LOST; c++)
      b->account[ACCOUNTS * dem->wall_contact[k].disc + SLIDING + c] += dem->wall_contact[k].lost[c];
}

/* The start: what every disc has when it is first evaluated. */
static void BookStart(PgDem dem, const Books *b)
{
  for (PetscInt i = 0; i < b->owned; i++) {
    PetscReal *account = &b->account[ACCOUNTS * i];
    Elastic    e;

    if (account[STARTED] != 0) continue;
    e                = DiscElastic(dem, b, i);
    account[KINETIC] = PgDemDiscKinetic(&b->discs, b->m, i);
    account[START]   = account[KINETIC] + ((e.normal + e.sliding) + (e.rolling + e.moment));
    account[STARTED] = 1;
  }
}

PetscErrorCode PgDemBookWork_Private(PgDem dem, PetscReal h, PetscBool arrival)
{
  Books b;

  PetscFunctionBeginUser;
  PetscCall(GetBooks(dem, &b));
  if (arrival) {
    BookStart(dem, &b);
    for (PetscInt i = 0; i < b.owned; i++) NotePairs(dem, &b, i, &b.noted[PG_ENERGY_FORCES * i + NOTED_PAIRS]);
  }
  if (h == 0) PetscFunctionReturn(0);
  if (arrival) BookCaps(dem, &b);
  BookWalls(dem, &b, h);
  for (PetscInt i = 0; i < b.owned; i++) BookDisc(dem, &b, i, h);
  for (PetscInt k = 0; k < dem->plate_disc_count; k++) {
    const PetscInt i = dem->plate_disc[k];
    const PgPlate *q = &dem->plates[(PetscInt)b.plate[i] - 1];

    if (q->hold) continue;
    b.account[ACCOUNTS * i + PLATES] -= h * (q->side > 0 ? 1 : -1) * b.reaction[2 * i + 1] *
                                        b.discs.velocity[2 * i + 1];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemNoteKinetic_Private(PgDem dem)
{
  Books b;

  PetscFunctionBeginUser;
  PetscCall(GetBooks(dem, &b));
  for (PetscInt i = 0; i < b.owned; i++) b.account[ACCOUNTS * i + KINETIC] = PgDemDiscKinetic(&b.discs, b.m, i);
  PetscFunctionReturn(0);
}

/* Velocities may have been changed since the last step: by the water, and now by the plates. */
PetscErrorCode PgDemBookBetween_Private(PgDem dem)
{
  Books b;

  PetscFunctionBeginUser;
  PetscCall(GetBooks(dem, &b));
  for (PetscInt i = 0; i < b.owned; i++) {
    PetscReal      *account = &b.account[ACCOUNTS * i];
    const PetscReal now     = PgDemDiscKinetic(&b.discs, b.m, i);

    account[FLUID] += now - account[KINETIC];
    account[KINETIC] = now;
  }
  PetscCall(PgDemImposePlates_Private(dem));
  for (PetscInt k = 0; k < dem->plate_disc_count; k++) {
    PetscReal *account = &b.account[ACCOUNTS * dem->plate_disc[k]];

    account[PLATES] += PgDemDiscKinetic(&b.discs, b.m, dem->plate_disc[k]) - account[KINETIC];
  }
  PetscFunctionReturn(0);
}

/* ---- what is read ---- */

PetscErrorCode PgDemGetEnergy(PgDem dem, PgEnergy *energy)
{
  enum { NOW = 5 }; /* kinetic and elastic energies, before the accounts */
  PgExactSum sum[NOW + ACCOUNTS];
  PetscReal  value[NOW + ACCOUNTS], *a = value + NOW;
  Books      b;

  PetscFunctionBeginUser;
  PetscCheck(dem->energy, PgParticlesComm(dem->particles), PETSC_ERR_ORDER, "no energy accounts are kept");
  PetscCall(PetscMemzero(sum, sizeof(sum)));
  PetscCall(GetBooks(dem, &b));
  PetscCall(PgDemUpdateWallContacts_Private(dem));
  for (PetscInt i = 0; i < b.owned; i++) {
    const Elastic e = DiscElastic(dem, &b, i);

    PgExactSumAdd(&sum[0], PgDemDiscKinetic(&b.discs, b.m, i));
    PgExactSumAdd(&sum[1], e.normal);
    PgExactSumAdd(&sum[2], e.sliding);
    PgExactSumAdd(&sum[3], e.rolling);
    PgExactSumAdd(&sum[4], e.moment);
    for (PetscInt c = 0; c < ACCOUNTS; c++) PgExactSumAdd(&sum[NOW + c], b.account[ACCOUNTS * i + c]);
  }
  PetscCall(PgExactSumReduce(PgParticlesComm(dem->particles), NOW + ACCOUNTS, sum, value));
  *energy          = (PgEnergy){.kinetic          = value[0],
                                .elastic_normal   = value[1],
                                .elastic_sliding  = value[2],
                                .elastic_rolling  = value[3],
                                .elastic_moment   = value[4],
                                .friction_sliding = a[SLIDING],
                                .friction_rolling = a[ROLLING],
                                .friction_moment  = a[MOMENT],
                                .dashpots         = a[DASHPOTS],
                                .local_damping    = a[LOCAL],
                                .global_damping   = a[GLOBAL],
                                .rolling_excess   = a[EXCESS],
                                .work_plates      = a[PLATES],
                                .work_walls       = a[WALLS],
                                .work_gravity     = a[GRAVITY],
                                .work_external    = a[EXTERNAL],
                                .work_fluid       = a[FLUID]};
  energy->residual = (value[0] + value[1] + value[2] + value[3] + value[4]) +
                     (a[SLIDING] + a[ROLLING] + a[MOMENT] + a[DASHPOTS] + a[LOCAL] + a[GLOBAL] + a[EXCESS]) -
                     (a[PLATES] + a[WALLS] + a[GRAVITY] + a[EXTERNAL] + a[FLUID]) - a[START];
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemFillFrictionEnergy_Private(PgDem dem)
{
  PetscReal *account, *friction;
  PetscInt   owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(dem->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(dem->particles, dem->energy_account, &account));
  PetscCall(PgParticlesGetArray(dem->particles, dem->friction_energy, &friction));
  for (PetscInt i = 0; i < owned; i++) {
    const PetscReal *a = &account[ACCOUNTS * i];
    friction[i]        = a[SLIDING] + a[ROLLING] + a[MOMENT];
  }
  PetscFunctionReturn(0);
}
