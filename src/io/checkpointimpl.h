/* What writing, finding and reading checkpoints share. */
#pragma once

#include "ioimpl.h"

#define PG_CHECKPOINT_FORMAT "porograin checkpoint"
/* Raised when the layout of the file changes. */
#define PG_CHECKPOINT_VERSION 1

struct PgCheckpoint_s {
  MPI_Comm    comm;
  PetscMPIInt rank;
  char        file[PETSC_MAX_PATH_LEN]; /* the one that was chosen */
  PgHdf       hdf;                      /* open on rank 0 */
};

/* FILE with an ending. Collective. */
PETSC_INTERN PetscErrorCode PgCheckpointName(MPI_Comm comm, const char file[], const char ending[], char name[],
                                             size_t size);
/* checkpoint_find.c: rank 0 chooses a valid checkpoint for the name, directory or pattern `where`; a remark for
   the user goes to `remark`. NULL or why there is none. */
PETSC_INTERN const char *PgCheckpointFind(const char where[], char file[PETSC_MAX_PATH_LEN], char remark[],
                                          size_t remark_size);

/* checkpoint_read.c: for rank 0, but the last */
/* Opens a dataset that must have this type and shape; negative, and a failure, otherwise. */
PETSC_INTERN hid_t PgCheckpointOpenDataset(PgHdf *hdf, const char path[], hid_t type, int rank, const hsize_t size[]);
PETSC_INTERN void  PgCheckpointReadRows(PgHdf *hdf, const char path[], hid_t dataset, hid_t type, PetscInt start,
                                        PetscInt rows, PetscInt columns, int rank, void *value);
PETSC_INTERN void  PgCheckpointCheckFinite(PgHdf *hdf, const char path[], PetscInt start, PetscInt rows,
                                           PetscInt columns, const PetscReal value[]);
PETSC_INTERN PetscInt PgCheckpointReadNumber(PgHdf *hdf, const char name[]); /* -1: none */
/* A failure so far as an error return; its words are kept for PgCheckpointClose(). Collective. */
PETSC_INTERN PetscErrorCode PgCheckpointVerdict(PgCheckpoint c);
