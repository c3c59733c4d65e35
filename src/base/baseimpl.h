/* What the files of this room share. */
#pragma once

#include <porograin/base.h>

PETSC_INTERN PetscErrorCode PgStagesRegister(void);
PETSC_INTERN void           PgOptionsForget(void);
PETSC_INTERN void           PgTerminalLookAround(void);
