/* What the files about tables share. */
#pragma once

#include "ioimpl.h"

typedef struct {
  PetscReal value;               /* NaN: empty */
  char      text[PG_TABLE_TEXT]; /* of a text column */
} PgTableCell;

struct PgTable_s {
  MPI_Comm             comm;
  PgTableFiles        *files;
  const char          *name; /* group in the HDF5 file */
  PetscInt             columns, rows;
  const PgTableColumn *column; /* not owned */
  PgTableCell         *cell;   /* of the row being filled */
  FILE                *csv;    /* rank 0 */
};

/* table_hdf.c: rank 0 alone; 0 or an error code whose message is in `trouble`. */
PETSC_INTERN PetscErrorCode PgTableHdfCreate(const PgTableFiles *files, const char file[], const char *options,
                                             PetscMPIInt ranks, char trouble[], size_t length);
PETSC_INTERN PetscErrorCode PgTableHdfRow(PgTable table, const char file[], PetscInt n, const PetscReal history[],
                                          const char unit[], const char description[], char trouble[], size_t length);
