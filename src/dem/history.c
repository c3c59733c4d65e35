/* Contact history across list builds. Between builds it lies by pair of the contact list; across one it
   travels with the discs as records (partner id, f_s, f_r, m_r), on both discs of the pair. The values
   belong to the pair oriented from low to high id, so both records are the same but for the id. */
#include "demimpl.h"

enum { RECORD = 4 };

static PetscErrorCode CountRecords(PgDem dem, const PgContactList *list, PetscInt owned)
{
  const PgDemPairs *p = &dem->pairs;

  PetscFunctionBeginUser;
  PetscCall(PgDemGetOffset_Private(dem, owned + 1));
  dem->offset[0] = 0;
  for (PetscInt i = 0; i < owned; i++) {
    dem->offset[i + 1] = dem->offset[i];
    for (PetscInt k = list->ptr[i]; k < list->ptr[i + 1]; k++) {
      const PetscInt pair = list->sum[k] >> 1;
      dem->offset[i + 1] += p->f_s[pair] != 0 || p->f_r[pair] != 0 || p->m_r[pair] != 0;
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemSaveHistory(PgDem dem)
{
  PgContactList     list;
  const PgDemPairs *p = &dem->pairs;
  const PetscInt   *id;
  PetscInt          owned, lists;
  PetscReal        *record, *next;

  PetscFunctionBeginUser;
  PetscCall(PgNeighborsGetRevision(dem->neighbors, &lists));
  /* nothing has been restored from the records yet: they are the history (the start of a restarted run) */
  if (dem->lists < 0 || dem->lists != lists) PetscFunctionReturn(0);
  PetscCall(PgDemGetContacts_Private(dem, &list));
  PetscCall(PgParticlesGetSizes(dem->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetIds(dem->particles, &id));
  PetscCall(CountRecords(dem, &list, owned));
  PetscCall(PgDemGetWork_Private(dem, RECORD * dem->offset[owned], &record));
  next = record;
  for (PetscInt i = 0; i < owned; i++) {
    for (PetscInt k = list.ptr[i]; k < list.ptr[i + 1]; k++) {
      const PetscInt pair = list.sum[k] >> 1, partner = list.sum[k] & 1 ? list.low[pair] : list.high[pair];

      if (p->f_s[pair] == 0 && p->f_r[pair] == 0 && p->m_r[pair] == 0) continue;
      next[0] = (PetscReal)id[partner];
      next[1] = p->f_s[pair];
      next[2] = p->f_r[pair];
      next[3] = p->m_r[pair];
      next += RECORD;
    }
  }
  PetscCall(PgParticlesSetRagged(dem->particles, dem->history, dem->offset, record));
  PetscCall(PgDemSaveWallHistory_Private(dem));
  PetscFunctionReturn(0);
}

static PetscErrorCode GrowPairs(PgDem dem, PetscInt padded)
{
  PgDemPairs *p = &dem->pairs;
  PetscInt    room;

  PetscFunctionBeginUser;
  if (padded <= dem->pair_room && !(dem->energy && !p->lost)) PetscFunctionReturn(0);
  room = padded + padded / 8; /* the list of a deforming packing grows a little at a time */
  PetscCall(PetscFree4(p->f_s, p->f_r, p->m_r, p->result));
  PetscCall(PetscMalloc4(room, &p->f_s, room, &p->f_r, room, &p->m_r, 4 * room, &p->result));
  PetscCall(PetscFree(p->lost));
  if (dem->energy) PetscCall(PetscMalloc1(PG_LOST * room, &p->lost));
  dem->pair_room = room;
  PetscFunctionReturn(0);
}

/* A bond that is drawn out must stay in the list: it breaks at R_n/k_n at the latest. */
static PetscErrorCode CheckBonds(PgDem dem)
{
  const PgContactParameters *p = &dem->parameters;
  PetscReal                  skin;

  PetscFunctionBeginUser;
  if (!dem->law->stiffness || p->R_n <= 0) PetscFunctionReturn(0);
  PetscCall(PgNeighborsGetSkin(dem->neighbors, &skin));
  PgInputCheck(p->R_n / p->k_n < 0.5 * skin && p->bond_range < 0.5 * skin, PgParticlesComm(dem->particles),
               "bonds of -dem_bond_normal %g N/m are drawn out by %g m before they break, and -dem_bond_range is %g m: "
               "both must be below half the skin of the lists, %g m; give a larger -neighbors_skin",
               (double)p->R_n, (double)(p->R_n / p->k_n), (double)p->bond_range, (double)(0.5 * skin));
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemRestoreHistory(PgDem dem)
{
  PgContactList    list;
  PgDemPairs      *p = &dem->pairs;
  const PetscInt  *id, *offset;
  const PetscReal *record;
  PetscInt         owned;

  PetscFunctionBeginUser;
  PetscCall(CheckBonds(dem));
  PetscCall(PgNeighborsGetContacts(dem->neighbors, &list));
  PetscCall(PgParticlesGetSizes(dem->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetIds(dem->particles, &id));
  PetscCall(PgParticlesGetRagged(dem->particles, dem->history, &offset, &record));
  PetscCall(GrowPairs(dem, list.padded));
  for (PetscInt k = 0; k < list.padded; k++) {
    const PetscInt owner = list.low[k] < owned ? list.low[k] : list.high[k];
    const PetscInt other = list.low[k] < owned ? list.high[k] : list.low[k];

    p->f_s[k] = p->f_r[k] = p->m_r[k] = 0;
    for (PetscInt c = offset[owner]; c < offset[owner + 1]; c++) {
      const PetscReal *h = &record[RECORD * c];

      if ((PetscInt)h[0] != id[other]) continue;
      p->f_s[k] = h[1];
      p->f_r[k] = h[2];
      p->m_r[k] = h[3];
      break;
    }
  }
  PetscCall(PgDemRestoreWallHistory_Private(dem));
  PetscCall(PgNeighborsGetRevision(dem->neighbors, &dem->lists));
  dem->pairs_computed = PETSC_FALSE;
  PetscFunctionReturn(0);
}
