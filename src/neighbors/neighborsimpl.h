/* What the files of this room share. */
#pragma once

#include <porograin/neighbors.h>

/* One disc in a cell, all that a search looks at side by side. */
typedef struct {
  PetscReal x, y, r; /* [m] */
  PetscInt  index;   /* local, ghosts included */
} PgCellDisc;

/* Discs of this rank (ghosts included) by cell, cells by rows: three cells side by side are one range. */
typedef struct {
  PetscReal   low[2];     /* corner [m] */
  PetscReal   per_length; /* cells per length [1/m] */
  PetscInt    cells[2];
  PetscInt   *start; /* (cells + 1) first disc of each cell */
  PgCellDisc *disc;
} PgCellList;

typedef struct {
  PetscInt  count, capacity;
  PetscInt *low, *high; /* local indices */
} PgPairs;

struct PgNeighbors_s {
  PgParticles particles;
  PetscReal   skin_fraction; /* of the mean radius [1] */
  PetscReal   skin;          /* [m]; negative before the first build */
  PetscReal   r_max;         /* largest radius of all discs [m] */
  PetscBool   rows_wanted;
  PetscReal   wide, narrow;   /* reach of a pair in the rows, in larger and smaller radius [1] */
  PetscInt    builds;         /* so far */
  PetscInt    revision;       /* of the particles at the last build */
  PgField     build_position; /* where the discs were then */

  PgPairs   pairs;    /* low, high: padded */
  PetscInt  interior; /* pairs without a ghost */
  PetscInt  contacts; /* pairs without the padding */
  PetscInt *contact_ptr, *contact_sum;
  PetscInt  contact_ptr_capacity, contact_sum_capacity;

  PetscInt *row_ptr, *row_col;
  PetscInt  row_ptr_capacity, row_col_capacity;
  PetscInt *row_pair[4]; /* one, two, one_at, two_at */
  PetscInt  row_pairs, row_pair_capacity[4];

  PetscInt *key, *value; /* scratch of one row: ids of the partners, what is sorted by them */
  PetscInt  scratch_capacity;
};

/* cells.c */
PETSC_INTERN PetscErrorCode PgCellListCreate(PetscInt n, const PetscReal position[], const PetscReal radius[],
                                             PetscReal reach, PgCellList *list);
PETSC_INTERN PetscInt       PgCellListRanges(const PgCellList *list, const PetscReal position[2], PetscInt first[3],
                                             PetscInt end[3]);
PETSC_INTERN PetscErrorCode PgCellListDestroy(PgCellList *list);
PETSC_INTERN PetscErrorCode PgReserveInts(PetscInt held, PetscInt needed, PetscInt *capacity, PetscInt **array);
PETSC_INTERN PetscErrorCode PgReserveScratch(PgNeighbors neighbors, PetscInt needed);
PETSC_INTERN PetscErrorCode PgSortByKey(PetscInt n, PetscInt key[], PetscInt value[]);

/* contacts.c */
PETSC_INTERN PetscErrorCode PgContactsBuild(PgNeighbors neighbors);

/* rows.c */
PETSC_INTERN PetscErrorCode PgRowsBuild(PgNeighbors neighbors);
