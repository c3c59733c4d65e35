/* The files that -pressure_dump writes, looked at before PETSc loads them. */
#pragma once

#include <porograin/base.h>

/* Leaves in `reason` why the file is no system that can be loaded, naming the part and the place; empty when it is
   one. A number that was changed into another finite one cannot be seen. For one rank. */
PETSC_INTERN void PgDumpFileCheck(const char file[], char reason[], size_t length);
