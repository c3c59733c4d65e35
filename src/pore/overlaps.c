/* Which overlaps of discs with sample circles must be computed in each step: found once for each build of the lists. */
#include "poreimpl.h"

PetscErrorCode PgOverlapsDestroy(PgOverlaps *o)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree4(o->circle, o->disc, o->at, o->too));
  PetscCall(PetscFree2(o->area, o->inside));
  PetscFunctionReturn(0);
}

/* What an overlap is when the disc does not come near the edge of the circle; false when it may. */
static PetscBool IsSettled(PetscReal R, PetscReal r, PetscReal d, PetscReal way, PetscReal *area, char *inside)
{
  *inside = d < R;
  *area   = d < R ? r * r * PETSC_PI : 0.0;
  return (PetscBool)(2.0 * r <= R && (d + way < R - r || d - way > R + r));
}

static void Add(PgOverlaps *o, PetscInt i, PetscInt circle, PetscInt disc, PetscInt at, PetscInt too)
{
  o->circle[i] = circle;
  o->disc[i]   = disc;
  o->at[i]     = at;
  o->too[i]    = too;
}

/* From both ends: those for the vector loop, and those of discs more than twice as large as the other. */
static void Sort(const PgRowList *list, PetscReal circle, const PetscReal x[], const PetscReal radius[], PetscReal way,
                 PgOverlaps *o)
{
  PetscInt end = 2 * list->pairs, wide = end;

  o->count = 0;
  for (PetscInt q = 0; q < list->pairs; q++) {
    const PetscInt  disc[2] = {list->one[q], list->two[q]}, at[2] = {list->one_at[q], list->two_at[q]};
    const PetscReal dx = x[2 * disc[1]] - x[2 * disc[0]], dy = x[2 * disc[1] + 1] - x[2 * disc[0] + 1];
    const PetscReal d    = PetscSqrtReal(dx * dx + dy * dy);
    const PetscBool same = (PetscBool)(radius[disc[0]] == radius[disc[1]]);

    for (int c = 0; c < 2; c++) {
      const PetscReal R = circle * radius[disc[c]], r = radius[disc[1 - c]];
      if (IsSettled(R, r, d, way, &o->area[at[c]], &o->inside[at[c]])) continue;
      if (2.0 * r > R)
        Add(o, --wide, disc[c], disc[1 - c], at[c], at[c]);
      else if (!same || c == 0)
        Add(o, o->count++, disc[c], disc[1 - c], at[c], same ? at[1] : at[c]);
    }
  }
  o->all = o->count;
  for (PetscInt i = wide; i < end; i++, o->all++) Add(o, o->all, o->circle[i], o->disc[i], o->at[i], o->too[i]);
}

PetscErrorCode PgOverlapsUpdate(PgPore pore, PetscReal circle)
{
  PgOverlaps  *o = &pore->overlaps;
  PgRowList    list;
  PgPoreArrays s;
  PetscInt     revision;
  PetscReal    skin;

  PetscFunctionBeginUser;
  PetscCall(PgNeighborsGetRevision(pore->neighbors, &revision));
  if (o->circle && revision == o->revision) PetscFunctionReturn(0);
  o->revision = revision;
  PetscCall(PgNeighborsGetRows(pore->neighbors, &list));
  PetscCall(PgNeighborsGetSkin(pore->neighbors, &skin));
  PetscCall(PgPoreGetArrays(pore, &s));
  if (!o->circle || list.pairs > o->pairs || list.ptr[s.owned] > o->entries) {
    PetscCall(PgOverlapsDestroy(o));
    o->pairs   = list.pairs + list.pairs / 8;
    o->entries = list.ptr[s.owned] + list.ptr[s.owned] / 8;
    PetscCall(PetscMalloc4(2 * o->pairs + 1, &o->circle, 2 * o->pairs + 1, &o->disc, 2 * o->pairs + 1, &o->at,
                           2 * o->pairs + 1, &o->too));
    PetscCall(PetscMalloc2(o->entries + 1, &o->area, o->entries + 1, &o->inside)); /* see two_at of PgRowList */
  }
  /* of two discs, each at most half the skin from where it was at the build: now, and whenever the lists serve */
  Sort(&list, circle, s.x, s.radius, 2.0 * skin, o);
  PetscFunctionReturn(0);
}
