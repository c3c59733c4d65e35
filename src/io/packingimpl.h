/* What the files about packings share. */
#pragma once

#include "ioimpl.h"

/* Discs that are read, sent and written at a time. */
enum { PG_PACKING_PIECE = 8192 };

/* A file that hands out its discs in order, as often as asked. For rank 0 alone. */
typedef struct PgPackingSource_s PgPackingSource;
struct PgPackingSource_s {
  const char    *file;
  PetscErrorCode code;         /* of the first failure; 0: none */
  char           reason[1200]; /* of the failure */
  PetscInt64     total;        /* discs, when all have been met once */
  PetscBool      has_velocity, periodic;
  PetscReal      low, high; /* [m] */

  /* Up to `room` further discs of PG_PACKING_VALUES values, checked one by one; 0 at the end and after a failure. */
  PetscInt (*next)(PgPackingSource *source, PetscInt room, PetscReal disc[]);
  void (*rewind)(PgPackingSource *source);
  void (*close)(PgPackingSource *source);
  void *context;
};

PETSC_INTERN void PgPackingSourceFail(PgPackingSource *source, PetscErrorCode code, const char format[], ...)
    PETSC_ATTRIBUTE_FORMAT(3, 4);
PETSC_INTERN PetscErrorCode PgPackingCsvOpen(PgPackingSource *source);
PETSC_INTERN PetscErrorCode PgPackingHdfOpen(PgPackingSource *source, const char group[]);

/* Index of the first value that no disc can have, with the reason; -1: the disc is fine. */
PETSC_INTERN int         PgPackingCheckDisc(const PetscReal disc[], char reason[], size_t size);
PETSC_INTERN const char *PgPackingValueName(int value);
/* Whether the ends of a period make sense; NULL or why not. */
PETSC_INTERN const char *PgPackingCheckPeriod(PetscReal low, PetscReal high);

/* Most discs of a packing: what the integers of this PETSc can count, with the list entries that come with them. */
#define PG_PACKING_MOST ((PetscInt64)(PETSC_MAX_INT / 64))

/* First id of a rank; the formula of PgParticlesGetIdRange(). */
static inline PetscInt PgPackingRangeStart(PetscInt global, PetscMPIInt rank, PetscMPIInt size)
{
  return (PetscInt)((int64_t)rank * global / size);
}
