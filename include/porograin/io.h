/* io: result files. One HDF5 file that walks the field registry, an XDMF index beside it for ParaView,
   and a CSV file with the history. Does not know which fields exist. */
#pragma once

#include <porograin/particles.h>

typedef struct PgOutput_s *PgOutput;

typedef struct {
  const char *name, *unit, *description;
} PgColumn;

/* Creates FILE (ending .h5), FILE.xmf and FILE.csv (same base name); refuses a name without .h5 or a
   directory that cannot be written, before anything else is written. Writes /provenance: program version,
   git revision, PETSc version, ranks, date, command line, all options. Collective. */
PETSC_EXTERN PetscErrorCode PgOutputCreate(PgParticles particles, const char file[], PetscInt columns,
                                           const PgColumn column[], PgOutput *output);
/* Adds /snapshots/NNNNNN with attribute time and every field flagged PG_FIELD_OUTPUT, in the order of
   permanent ids, plus `extra` fields already in that order (see PgParticlesGetIdRange()); rewrites the
   XDMF index. The file is complete and closed on return. Collective. */
typedef struct {
  const char      *name;
  PetscInt         components;
  const char      *unit, *description;
  const PetscReal *byid;
} PgExtraField;
PETSC_EXTERN PetscErrorCode PgOutputSnapshot(PgOutput output, PetscReal time, PetscInt extras,
                                             const PgExtraField extra[]);
/* Adds one row to the history (buffered on rank 0; in FILE.csv at once, in /history/<name> with the next
   snapshot and at the end). Collective. */
PETSC_EXTERN PetscErrorCode PgOutputHistory(PgOutput output, const PetscReal row[]);
PETSC_EXTERN PetscErrorCode PgOutputGetSnapshotCount(PgOutput output, PetscInt *count);
/* Marks used and unused options in /provenance and writes what is still buffered. Collective. */
PETSC_EXTERN PetscErrorCode PgOutputFinish(PgOutput output);
PETSC_EXTERN PetscErrorCode PgOutputDestroy(PgOutput *output);

/* Reads a dataset of a snapshot (any number of ranks; every rank gets all of it; for tests and plots).
   *value is allocated with PetscMalloc. Collective. */
PETSC_EXTERN PetscErrorCode PgResultRead(MPI_Comm comm, const char file[], const char dataset[], PetscInt *rows,
                                         PetscInt *columns, PetscReal **value);
PETSC_EXTERN PetscErrorCode PgResultReadAttribute(MPI_Comm comm, const char file[], const char object[],
                                                  const char name[], PetscReal *value);
