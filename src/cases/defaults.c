/* Options that a case brings along, so that -case NAME alone is a whole problem. */
#include "casesimpl.h"

/* Whether the user gave this option, or one whose name this one goes on from: who chooses -bc_top chooses away
   the -bc_top_pressure of the case. */
static PetscErrorCode Overruled(const char name[], PetscBool *given)
{
  char   begin[128];
  size_t length;

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(begin, name, sizeof begin));
  PetscCall(PetscStrlen(begin, &length));
  *given = PETSC_FALSE;
  for (size_t end = length; end > 1 && !*given; end--) {
    if (end < length && name[end] != '_') continue;
    begin[end] = '\0';
    PetscCall(PetscOptionsHasName(NULL, NULL, begin, given));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgCaseDefaults(const char options[])
{
  char **word;
  int    words;

  PetscFunctionBeginUser;
  PetscCall(PetscStrToArray(options, ' ', &words, &word));
  PetscCheck(words % 2 == 0, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "defaults are pairs of a name and a value");
  for (int i = 0; i < words; i += 2) {
    PetscBool given;
    PetscCall(Overruled(word[i], &given));
    /* judged by what the user gave: the values set here come after all of them have been looked at */
    if (given) word[i][0] = '\0';
  }
  for (int i = 0; i < words; i += 2) {
    PetscBool set;
    if (!word[i][0]) continue;
    PetscCall(PetscOptionsSetValue(NULL, word[i], word[i + 1]));
    PetscCall(PgOptionsSetBy(word[i], PG_OPTION_CASE));
    /* the user did not give it: it is no unknown option when this run has no use for it */
    PetscCall(PetscOptionsHasName(NULL, NULL, word[i], &set));
  }
  PetscCall(PetscStrToArrayDestroy(words, word));
  PetscFunctionReturn(0);
}
