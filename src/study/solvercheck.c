/* Whether PETSc understands the file of solvers: each is tried on a small matrix before the study begins. */
#include "studyimpl.h"
#include <ctype.h>
#include <string.h>

/* The five-point Laplacian on a square of points: large enough for several levels of a multigrid. */
static PetscErrorCode Poisson(MPI_Comm comm, Mat *A)
{
  enum { SIDE = 30 };
  PetscInt start, end;

  PetscFunctionBeginUser;
  PetscCall(MatCreateAIJ(comm, PETSC_DECIDE, PETSC_DECIDE, SIDE * SIDE, SIDE * SIDE, 5, NULL, 5, NULL, A));
  PetscCall(MatGetOwnershipRange(*A, &start, &end));
  for (PetscInt i = start; i < end; i++) {
    const PetscInt  x = i % SIDE, y = i / SIDE, column[5] = {i, i - 1, i + 1, i - SIDE, i + SIDE};
    const PetscBool there[5] = {PETSC_TRUE, (PetscBool)(x > 0), (PetscBool)(x < SIDE - 1), (PetscBool)(y > 0),
                                (PetscBool)(y < SIDE - 1)};
    for (int k = 0; k < 5; k++)
      if (there[k]) PetscCall(MatSetValue(*A, i, column[k], k ? -1.0 : 4.0, INSERT_VALUES));
  }
  PetscCall(MatAssemblyBegin(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatSetOption(*A, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(MatSetOption(*A, MAT_SPD, PETSC_TRUE));
  PetscFunctionReturn(0);
}

static PetscErrorCode Try(Mat A, const PgSolver *s, Vec b, Vec x)
{
  KSP ksp;

  PetscFunctionBeginUser;
  PetscCall(KSPCreate(PetscObjectComm((PetscObject)A), &ksp));
  PetscCall(KSPSetOptionsPrefix(ksp, s->prefix));
  PetscCall(KSPSetOperators(ksp, A, A));
  PetscCall(KSPSetFromOptions(ksp));
  PetscCall(KSPSetTolerances(ksp, 1e-2, 0.0, PETSC_DEFAULT, 20));
  PetscCall(KSPSetUp(ksp));
  PetscCall(KSPSetUpOnBlocks(ksp));
  PetscCall(KSPSolve(ksp, b, x));
  PetscCall(KSPDestroy(&ksp));
  PetscFunctionReturn(0);
}

/* Whether PETSc's message is about a type that it may have been built without: no misspelling then. */
static PetscBool IsMissingPackage(const char message[])
{
  static const char *const optional[] = {"hypre",   "ml",           "parms",  "spai",     "hpddm",
                                         "amgx",    "mumps",        "klu",    "cholmod",  "umfpack",
                                         "superlu", "superlu_dist", "pastix", "strumpack"};
  const char              *last       = strrchr(message, ' ');

  for (size_t k = 0; last && k < sizeof optional / sizeof *optional; k++)
    if (!strcmp(last + 1, optional[k])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* What PETSc says of a misspelt value. Hypre's types come through the same lists, but are there when hypre is. */
static PetscBool IsBadValue(const char message[])
{
  static const char factorization[] = "Could not locate solver type ";
  char              package[64];

  if (!strncmp(message, "Unknown option ", 15)) return PETSC_TRUE;
  if (strncmp(message, factorization, sizeof factorization - 1)) return PETSC_FALSE;
  (void)snprintf(package, sizeof package, " %.*s", (int)strcspn(message + sizeof factorization - 1, " "),
                 message + sizeof factorization - 1);
  return (PetscBool)!IsMissingPackage(package);
}

/* Options of one level of a multigrid (..._levels_3_...) exist only when the system has that level. The small matrix
   has level 1: they are tried as options of it. NULL: no such option. */
static char *LevelOf(char option[])
{
  char *at = strstr(option, "levels_");

  return at && isdigit((unsigned char)at[7]) && !isdigit((unsigned char)at[8]) ? at + 7 : NULL;
}

static void ToFirstLevel(PgSolver *s, char before[])
{
  for (PetscInt i = 0; i < s->options; i++) {
    char *level = LevelOf(s->option[i]);
    before[i]   = level ? *level : '\0';
    if (level) *level = '1';
  }
}

static void BackToLevels(PgSolver *s, const char before[])
{
  for (PetscInt i = 0; i < s->options; i++)
    if (before[i]) *LevelOf(s->option[i]) = before[i];
}

static PetscErrorCode CheckUsed(MPI_Comm comm, const char file[], const PgSolver *s)
{
  PetscBool unknown = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->options; i++) {
    if (s->used[i]) continue;
    PetscCall(PgReport(comm,
                       "%s:%" PetscInt_FMT ": solver %s: nobody reads option -%s%s%s; misspelt, or of another solver",
                       file, s->line, s->name, s->option[i], s->value[i] ? " " : "", s->value[i] ? s->value[i] : ""));
    unknown = PETSC_TRUE;
  }
  PetscFunctionReturn(unknown ? PETSC_ERR_USER_INPUT : 0);
}

PetscErrorCode PgSolverListCheck(MPI_Comm comm, PgSolverList *list)
{
  Mat            A;
  Vec            b, x;
  PetscErrorCode bad = 0;

  PetscFunctionBeginUser;
  PetscCall(Poisson(comm, &A));
  PetscCall(MatCreateVecs(A, &x, &b));
  PetscCall(VecSet(b, 1.0));
  for (PetscInt i = 0; i < list->count; i++) {
    PgSolver      *s = &list->solver[i];
    PgTrouble      trouble;
    PgOverride     o = {0};
    PetscErrorCode code;
    char           level[PG_OVERRIDES];

    ToFirstLevel(s, level);
    PetscCall(PgSolverPut(s, s->prefix, &o));
    PetscCall(PgTroubleBegin(&trouble));
    code = Try(A, s, b, x);
    PetscCall(PgTroubleEnd(comm, &code));
    PetscCall(PgSolverTake(s, &o));
    BackToLevels(s, level);
    if (code == 0) {
      code = CheckUsed(comm, list->file, s);
      if (code) bad = code;
    } else if (IsBadValue(trouble.message) || ((code == PETSC_ERR_ARG_UNKNOWN_TYPE || code == PETSC_ERR_ARG_WRONG ||
                                                code == PETSC_ERR_USER_INPUT || code == PETSC_ERR_ARG_OUTOFRANGE) &&
                                               !IsMissingPackage(trouble.message))) {
      PetscCall(PgReport(comm, "%s:%" PetscInt_FMT ": solver %s: %s", list->file, s->line, s->name, trouble.message));
      bad = PETSC_ERR_USER_INPUT;
    }
  }
  PetscCall(VecDestroy(&b));
  PetscCall(VecDestroy(&x));
  PetscCall(MatDestroy(&A));
  PetscFunctionReturn(bad);
}
