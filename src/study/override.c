/* Options that are set for a while: those of a solver, or of one run among several. */
#include "studyimpl.h"

static PetscErrorCode Save(PgOverride *o, const char name[])
{
  const char *value = NULL;
  PetscBool   had   = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCheck(o->count < PG_OVERRIDES, PETSC_COMM_SELF, PETSC_ERR_PLIB, "more than %d options at once",
             (int)PG_OVERRIDES);
  PetscCall(PetscOptionsFindPair(NULL, NULL, name, &value, &had));
  PetscCall(PetscStrallocpy(name, &o->name[o->count]));
  o->had[o->count]    = had;
  o->before[o->count] = NULL;
  if (had && value) PetscCall(PetscStrallocpy(value, &o->before[o->count]));
  if (had) PetscCall(PetscOptionsClearValue(NULL, name));
  o->count++;
  PetscCall(PgOptionsSetBy(name, PG_OPTION_PROGRAM));
  PetscFunctionReturn(0);
}

PetscErrorCode PgOverrideSet(PgOverride *o, const char name[], const char value[])
{
  PetscFunctionBeginUser;
  PetscCall(Save(o, name));
  PetscCall(PetscOptionsSetValue(NULL, name, value));
  PetscFunctionReturn(0);
}

PetscErrorCode PgOverrideRemove(PgOverride *o, const char name[])
{
  PetscFunctionBeginUser;
  PetscCall(Save(o, name));
  PetscFunctionReturn(0);
}

PetscErrorCode PgOverrideRestore(PgOverride *o, PetscBool used[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = o->count - 1; i >= 0; i--) {
    PetscBool now = PETSC_FALSE;
    PetscCall(PetscOptionsUsed(NULL, o->name[i] + 1, &now));
    if (used) used[i] = now;
    PetscCall(PetscOptionsClearValue(NULL, o->name[i]));
    PetscCall(PgOptionsSetBy(o->name[i], PG_OPTION_USER));
    if (o->had[i]) {
      const char *value;
      PetscBool   set;
      PetscCall(PetscOptionsSetValue(NULL, o->name[i], o->before[i]));
      /* it was read before, or was refused: it must not count as unknown now */
      PetscCall(PetscOptionsFindPair(NULL, NULL, o->name[i], &value, &set));
    }
    PetscCall(PetscFree(o->name[i]));
    PetscCall(PetscFree(o->before[i]));
  }
  o->count = 0;
  PetscFunctionReturn(0);
}
