/* Kernel and its slope for all pairs at the present positions. Both particles of a pair, on whatever rank, get the same
   bits. */
#include "wcsphimpl.h"

static PetscErrorCode Reserve(PgWcsph w, PetscInt rows, PetscInt entries)
{
  PetscFunctionBeginUser;
  if (entries >= w->entries || !w->slope) {
    w->entries = entries + entries / 8 + 1; /* one more, where pairs write the row that a ghost has not */
    PetscCall(PetscFree(w->slope));
    PetscCall(PetscFree(w->weight));
    PetscCall(PetscFree(w->pair));
    PetscCall(PetscMalloc1(w->entries, &w->slope));
    PetscCall(PetscMalloc1(w->entries, &w->weight));
    PetscCall(PetscMalloc1(w->entries, &w->pair));
  }
  if (rows > w->rows || !w->rate) {
    w->rows = rows + rows / 8 + 1;
    PetscCall(PetscFree(w->rate));
    PetscCall(PetscMalloc1(w->rows, &w->rate));
  }
  PetscFunctionReturn(0);
}

static PgWcsphPair Classify(const PgWcsphArrays *f, PetscInt a, PetscInt b)
{
  if (PgWcsphIsLiquid(f, a)) return PgWcsphIsLiquid(f, b) ? PG_PAIR_LIQUID : PG_PAIR_AT_SOLID;
  if (PgWcsphIsLiquid(f, b)) return PG_PAIR_OF_SOLID;
  return f->kind[a] == f->kind[b] && f->body[a] == f->body[b] ? PG_PAIR_SAME_SOLID : PG_PAIR_SOLIDS;
}

static PetscErrorCode NewLists(PgWcsph w, const PgWcsphArrays *f)
{
  PetscFunctionBeginUser;
  PetscCall(PgNeighborsGetRows(w->neighbors, &w->list));
  PetscCall(Reserve(w, f->owned, w->list.ptr[f->owned]));
  for (PetscInt a = 0; a < f->owned; a++)
    for (PetscInt k = w->list.ptr[a]; k < w->list.ptr[a + 1]; k++)
      w->pair[k] = (unsigned char)Classify(f, a, w->list.col[k]);
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphUpdatePairs(PgWcsph w)
{
  const PgRowList *list = &w->list;
  const PetscReal  ih = 1.0 / w->h, ih2 = ih * ih, reach = w->kernel->support * w->h;
  PgWcsphArrays    f;
  PetscInt         revision;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetArrays(w, &f));
  PetscCall(PgNeighborsGetRevision(w->neighbors, &revision));
  if (revision != w->built) PetscCall(NewLists(w, &f));
  w->built = revision;
  for (PetscInt q = 0; q < list->pairs; q++) {
    const PgReal2   d     = PgWcsphR(&f, list->one[q], list->two[q]);
    const PetscReal r     = PetscSqrtReal(PgDot(d, d));
    PetscReal       slope = 0.0, weight = 0.0;

    if (r < reach) {
      weight = w->kernel->w(r * ih) * ih2;
      if (r > 0.0) slope = w->kernel->dw(r * ih) * ih2 * ih / r;
    }
    w->slope[list->one_at[q]] = w->slope[list->two_at[q]] = slope;
    w->weight[list->one_at[q]] = w->weight[list->two_at[q]] = weight;
  }
  PetscFunctionReturn(0);
}
