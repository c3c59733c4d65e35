/* Contacts of discs with walls: the list of discs near walls, forces, histories.

   Only owned discs are listed, each with the walls it may come to touch before the list is made anew. A disc is
   within half the skin of its place at the last build of the pair lists whenever forces are computed, hence
   within a whole skin of where it was when this list was made; a wall may move by another half. */
#include "demimpl.h"

/* Record of the variable-length data: wall, f_s, f_r, m_r, F_N, F_T, M_r. */

void PgDemWallContactForce_Private(PgDem dem, const PgWallContact *c, PetscReal r, PetscReal force[3])
{
  const PetscReal *normal = dem->walls[c->wall]->wall.normal;
  const PetscReal  n[2] = {-normal[0], -normal[1]}, t[2] = {-n[1], n[0]};

  force[0] = c->force.F_N * n[0] + c->force.F_T * t[0];
  force[1] = c->force.F_N * n[1] + c->force.F_T * t[1];
  force[2] = r * c->force.F_T + c->force.M_r;
}

PetscInt PgDemFindWallContact_Private(PgDem dem, PetscInt disc)
{
  PetscInt low = 0, high = dem->wall_contact_count;

  while (low < high) {
    const PetscInt middle = low + (high - low) / 2;
    if (dem->wall_contact[middle].disc < disc)
      low = middle + 1;
    else
      high = middle;
  }
  return low < dem->wall_contact_count && dem->wall_contact[low].disc == disc ? low : dem->wall_contact_count;
}

/* ---- list ---- */

static PetscErrorCode AddContact(PgDem dem, PetscInt *count, PetscInt disc, PetscInt wall)
{
  PetscFunctionBeginUser;
  if (*count == dem->wall_spare_room) {
    dem->wall_spare_room += dem->wall_spare_room / 2 + 64;
    PetscCall(PetscRealloc((size_t)dem->wall_spare_room * sizeof(*dem->wall_spare), &dem->wall_spare));
  }
  dem->wall_spare[(*count)++] = (PgWallContact){.disc = disc, .wall = wall};
  PetscFunctionReturn(0);
}

/* The list at the present positions into the spare array. */
static PetscErrorCode ListDiscs(PgDem dem, PetscInt *count)
{
  PetscInt   owned;
  PetscReal  skin;
  PgDemDiscs discs;

  PetscFunctionBeginUser;
  PetscCall(PgDemGetDiscs_Private(dem, &discs));
  PetscCall(PgParticlesGetSizes(dem->particles, &owned, NULL, NULL));
  PetscCall(PgNeighborsGetSkin(dem->neighbors, &skin));
  *count = 0;
  for (PetscInt i = 0; i < owned; i++)
    for (PetscInt k = 0; k < dem->wall_count; k++)
      if (PgDemWallOverlap(&dem->walls[k]->wall, &discs.position[2 * i], discs.radius[i]) > -1.5 * skin)
        PetscCall(AddContact(dem, count, i, k));
  for (PetscInt k = 0; k < dem->wall_count; k++)
    PetscCall(PetscArraycpy(dem->walls[k]->listed, dem->walls[k]->wall.point, 2));
  dem->walls_changed = PETSC_FALSE;
  PetscFunctionReturn(0);
}

static void Swap(PgDem dem, PetscInt count)
{
  PgWallContact *contact = dem->wall_contact;
  const PetscInt room    = dem->wall_contact_room;

  dem->wall_contact       = dem->wall_spare;
  dem->wall_contact_room  = dem->wall_spare_room;
  dem->wall_contact_count = count;
  dem->wall_spare         = contact;
  dem->wall_spare_room    = room;
}

static PetscBool WallsMoved(PgDem dem, PetscReal skin)
{
  for (PetscInt k = 0; k < dem->wall_count; k++) {
    const PgDemWall *w   = dem->walls[k];
    const PetscReal  way = (w->wall.point[0] - w->listed[0]) * w->wall.normal[0] +
                          (w->wall.point[1] - w->listed[1]) * w->wall.normal[1];

    if (!(PetscAbsReal(way) <= 0.5 * skin)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscErrorCode PgDemUpdateWallContacts_Private(PgDem dem)
{
  PetscInt  revision, count, old = 0;
  PetscReal skin;

  PetscFunctionBeginUser;
  if (!dem->wall_count) PetscFunctionReturn(0);
  PetscCall(PgParticlesGetRevision(dem->particles, &revision));
  PetscCall(PgNeighborsGetSkin(dem->neighbors, &skin));
  if (revision == dem->wall_lists && !dem->walls_changed && !WallsMoved(dem, skin)) PetscFunctionReturn(0);
  PetscCall(ListDiscs(dem, &count));
  if (revision == dem->wall_lists) { /* both lists are in the same order */
    for (PetscInt k = 0; k < count; k++) {
      PgWallContact *c = &dem->wall_spare[k];
      while (old < dem->wall_contact_count &&
             (dem->wall_contact[old].disc < c->disc ||
              (dem->wall_contact[old].disc == c->disc && dem->wall_contact[old].wall < c->wall)))
        old++;
      if (old == dem->wall_contact_count) break;
      if (dem->wall_contact[old].disc == c->disc && dem->wall_contact[old].wall == c->wall) *c = dem->wall_contact[old];
    }
  }
  Swap(dem, count);
  dem->wall_lists = revision;
  PetscFunctionReturn(0);
}

/* ---- history across list builds ---- */

PetscErrorCode PgDemSaveWallHistory_Private(PgDem dem)
{
  PetscInt   owned, k = 0, records = 0;
  PetscReal *record, *next;

  PetscFunctionBeginUser;
  if (!dem->wall_count) PetscFunctionReturn(0);
  PetscCall(PgDemUpdateWallContacts_Private(dem));
  PetscCall(PgParticlesGetSizes(dem->particles, &owned, NULL, NULL));
  PetscCall(PgDemGetOffset_Private(dem, owned + 1));
  PetscCall(PgDemGetWork_Private(dem, PG_WALL_RECORD * dem->wall_contact_count, &record));
  next           = record;
  dem->offset[0] = 0;
  for (PetscInt i = 0; i < owned; i++) {
    for (; k < dem->wall_contact_count && dem->wall_contact[k].disc == i; k++) {
      const PgWallContact *c = &dem->wall_contact[k];

      if (c->force.F_N == 0 && c->history.f_s == 0 && c->history.f_r == 0 && c->history.m_r == 0) continue;
      *next++ = (PetscReal)c->wall;
      *next++ = c->history.f_s;
      *next++ = c->history.f_r;
      *next++ = c->history.m_r;
      *next++ = c->force.F_N;
      *next++ = c->force.F_T;
      *next++ = c->force.M_r;
      records++;
    }
    dem->offset[i + 1] = records;
  }
  PetscCall(PgParticlesSetRagged(dem->particles, dem->wall_history, dem->offset, record));
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemRestoreWallHistory_Private(PgDem dem)
{
  const PetscInt  *offset;
  const PetscReal *record;
  PetscInt         count;

  PetscFunctionBeginUser;
  if (!dem->wall_count) PetscFunctionReturn(0);
  PetscCall(ListDiscs(dem, &count));
  Swap(dem, count);
  PetscCall(PgParticlesGetRevision(dem->particles, &dem->wall_lists));
  PetscCall(PgParticlesGetRagged(dem->particles, dem->wall_history, &offset, &record));
  for (PetscInt k = 0; k < count; k++) {
    PgWallContact *c = &dem->wall_contact[k];

    for (PetscInt i = offset[c->disc]; i < offset[c->disc + 1]; i++) {
      const PetscReal *h = &record[PG_WALL_RECORD * i];

      if ((PetscInt)h[0] != c->wall) continue;
      c->history = (PgContactHistory){h[1], h[2], h[3]};
      c->force   = (PgContactForce){h[4], h[5], h[6]};
      break;
    }
  }
  PetscFunctionReturn(0);
}

/* ---- forces ---- */

PetscErrorCode PgDemWallForces_Private(PgDem dem, const PgDemDiscs *discs, PetscReal dt)
{
  PetscFunctionBeginUser;
  PetscCall(PgDemUpdateWallContacts_Private(dem));
  for (PetscInt k = 0; k < dem->wall_contact_count; k++) {
    PgWallContact      *c    = &dem->wall_contact[k];
    const PgWall       *w    = &dem->walls[c->wall]->wall;
    const PetscReal     n[2] = {-w->normal[0], -w->normal[1]}, r = discs->radius[c->disc], spin = discs->spin[c->disc];
    const PetscReal     vx = discs->velocity[2 * c->disc] - w->velocity[0];
    const PetscReal     vy = discs->velocity[2 * c->disc + 1] - w->velocity[1];
    PgContactParameters p  = dem->parameters;
    PgContactMotion     motion;

    p.mu_s              = PgDemWallFriction_Private(dem, w);
    p.mu_r              = PetscMin(p.mu_r, p.mu_s); /* Eqs. 16-17 */
    motion.overlap      = PgDemWallOverlap(w, &discs->position[2 * c->disc], r);
    motion.overlap_rate = vx * n[0] + vy * n[1];
    motion.sliding_rate = (vy * n[0] - vx * n[1]) + r * spin;
    motion.rolling_rate = -(r * spin);
    motion.spin_rate    = spin;
    motion.R            = r;
    p.R_n = p.R_t = 0; /* walls are not bonded */
    c->force      = dem->law->pair(&p, &motion, dt, &c->history, dem->energy ? c->lost : NULL);
  }
  PetscFunctionReturn(0);
}
