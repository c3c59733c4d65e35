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

/* Calls for each overlap that may change, from both ends of each pair; `fill` writes them, without it they are counted:
   first those for the vector loop, then those of discs more than twice as large as the other. */
static void Sort(const PgRowList *list, PetscReal circle, const PetscReal x[], const PetscReal radius[], PetscReal way,
                 PetscBool fill, PgOverlaps *o)
{
  PetscInt n[2] = {0, fill ? o->count : 0}; /* next of either kind */

  for (PetscInt q = 0; q < list->pairs; q++) {
    const PetscInt  disc[2] = {list->one[q], list->two[q]}, at[2] = {list->one_at[q], list->two_at[q]};
    const PetscReal dx = x[2 * disc[1]] - x[2 * disc[0]], dy = x[2 * disc[1] + 1] - x[2 * disc[0] + 1];
    const PetscReal d    = PetscSqrtReal(dx * dx + dy * dy);
    const PetscBool same = (PetscBool)(radius[disc[0]] == radius[disc[1]]);

    for (int c = 0; c < 2; c++) {
      const PetscReal R = circle * radius[disc[c]], r = radius[disc[1 - c]];
      const PetscInt  i = n[2.0 * r > R];
      if (IsSettled(R, r, d, way, &o->area[at[c]], &o->inside[at[c]]) || (same && c == 1)) continue;
      if (fill) {
        o->circle[i] = disc[c];
        o->disc[i]   = disc[1 - c];
        o->at[i]     = at[c];
        o->too[i]    = same ? at[1] : at[c];
      }
      n[2.0 * r > R]++;
    }
  }
  if (fill) return;
  o->count = n[0];
  o->all   = n[0] + n[1];
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
  if (!o->area || list.ptr[s.owned] > o->entries) {
    o->entries = list.ptr[s.owned] + list.ptr[s.owned] / 8;
    PetscCall(PetscFree2(o->area, o->inside));
    PetscCall(PetscMalloc2(o->entries + 1, &o->area, o->entries + 1, &o->inside)); /* see two_at of PgRowList */
  }
  /* of two discs, each at most half the skin from where it was at the build: now, and whenever the lists serve */
  Sort(&list, circle, s.x, s.radius, 2.0 * skin, PETSC_FALSE, o);
  if (!o->circle || o->all > o->capacity) {
    o->capacity = o->all + o->all / 8 + 1;
    PetscCall(PetscFree4(o->circle, o->disc, o->at, o->too));
    PetscCall(PetscMalloc4(o->capacity, &o->circle, o->capacity, &o->disc, o->capacity, &o->at, o->capacity, &o->too));
  }
  Sort(&list, circle, s.x, s.radius, 2.0 * skin, PETSC_TRUE, o);
  PetscFunctionReturn(0);
}
