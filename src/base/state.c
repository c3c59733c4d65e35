/* The list of named values that a run must remember. */
#include "baseimpl.h"

struct PgState_s {
  PetscInt     count, room;
  PgStateItem *items; /* strings are owned */
};

PetscErrorCode PgStateCreate(PgState *state)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(state));
  PetscFunctionReturn(0);
}

PetscErrorCode PgStateDestroy(PgState *state)
{
  PetscFunctionBeginUser;
  if (!*state) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < (*state)->count; k++) {
    PetscCall(PetscFree((*state)->items[k].name));
    PetscCall(PetscFree((*state)->items[k].meaning));
  }
  PetscCall(PetscFree((*state)->items));
  PetscCall(PetscFree(*state));
  PetscFunctionReturn(0);
}

static PetscErrorCode Add(PgState state, const char name[], PgStateKind kind, PgStateRule rule, const char meaning[],
                          PetscInt count, void *value)
{
  PgStateItem *item;

  PetscFunctionBeginUser;
  PetscCheck(name[0] && !strchr(name, '/') && strlen(name) < 100, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG,
             "'%s' cannot name a state", name);
  for (PetscInt k = 0; k < state->count; k++)
    PetscCheck(strcmp(state->items[k].name, name), PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "state '%s' is added twice",
               name);
  if (state->count == state->room) {
    state->room = 2 * state->room + 16;
    PetscCall(PetscRealloc((size_t)state->room * sizeof *state->items, &state->items));
  }
  item  = &state->items[state->count];
  *item = (PgStateItem){.kind = kind, .rule = rule, .count = count, .value = value};
  PetscCall(PetscStrallocpy(name, (char **)&item->name));
  PetscCall(PetscStrallocpy(meaning ? meaning : name, (char **)&item->meaning));
  state->count++;
  PetscFunctionReturn(0);
}

PetscErrorCode PgStateAddReals(PgState state, const char name[], PgStateRule rule, const char meaning[], PetscInt count,
                               PetscReal value[])
{
  PetscFunctionBeginUser;
  PetscCall(Add(state, name, PG_STATE_REALS, rule, meaning, count, value));
  PetscFunctionReturn(0);
}

PetscErrorCode PgStateAddInts(PgState state, const char name[], PgStateRule rule, const char meaning[], PetscInt count,
                              PetscInt value[])
{
  PetscFunctionBeginUser;
  PetscCall(Add(state, name, PG_STATE_INTS, rule, meaning, count, value));
  PetscFunctionReturn(0);
}

PetscErrorCode PgStateAddText(PgState state, const char name[], PgStateRule rule, const char meaning[], PetscInt size,
                              char value[])
{
  PetscFunctionBeginUser;
  PetscCall(Add(state, name, PG_STATE_TEXT, rule, meaning, size, value));
  PetscFunctionReturn(0);
}

PetscErrorCode PgStateGetItems(PgState state, PetscInt *count, const PgStateItem *items[])
{
  PetscFunctionBeginUser;
  *count = state->count;
  *items = state->items;
  PetscFunctionReturn(0);
}
