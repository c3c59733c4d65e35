/* The registered cases. */
#pragma once

#include <porograin/cases.h>

PETSC_INTERN const PgCaseInfo PgCasePanel;
