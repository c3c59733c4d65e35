/* io: result files and checkpoints. One HDF5 file that walks the field registry, an XDMF index beside it for ParaView,
   and a CSV file with the history. Does not know which fields exist. */
#pragma once

#include <porograin/particles.h>
#include <math.h>

typedef struct PgOutput_s *PgOutput;

typedef struct {
  const char *name, *unit, *description;
} PgColumn;

/* Creates FILE (ending .h5), FILE.xmf and FILE.csv (same base name); refuses a name without .h5 or a
   directory that cannot be written, before anything else is written. Writes /provenance: program version,
   git revision, PETSc version, ranks, date, command line, all options. Collective. */
PETSC_EXTERN PetscErrorCode PgOutputCreate(PgParticles particles, const char file[], PetscInt columns,
                                           const PgColumn column[], PgOutput *output);
/* Goes on with the result file of an interrupted run from a state when it had so many rows and snapshots: what came
   later is cut off, in all three files, and a change that was interrupted is undone first. FILE that is not there is
   created; one of another run (see PgOutputGetRun()) or with other columns is refused; one that holds less than asked
   for is told about and taken as it is. `from` is for /provenance. Collective. */
PETSC_EXTERN PetscErrorCode PgOutputContinue(PgParticles particles, const char file[], PetscInt columns,
                                             const PgColumn column[], const char run[], PetscInt rows,
                                             PetscInt snapshots, const char from[], PgOutput *output);
/* Name of the run that made the file, different for every run that was not a restart. */
#define PG_RUN_NAME 20
PETSC_EXTERN PetscErrorCode PgOutputGetRun(PgOutput output, char run[PG_RUN_NAME]);
/* Undoes an interrupted change of a result file, so that it can be read. Collective. */
PETSC_EXTERN PetscErrorCode PgResultRecover(MPI_Comm comm, const char file[], PetscBool *undone);
/* The same for the file of option -recover, when it is given. Collective. */
PETSC_EXTERN PetscErrorCode PgResultRecoverFromOptions(MPI_Comm comm, PetscBool *asked);
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
PETSC_EXTERN PetscErrorCode PgOutputGetRowCount(PgOutput output, PetscInt *count);
/* For the summary of a run: prints the names of the three files, and how many snapshots and rows they hold. Collective. */
PETSC_EXTERN PetscErrorCode PgOutputTell(PgOutput output);
/* Writes rows that wait to the file. Collective. */
PETSC_EXTERN PetscErrorCode PgOutputFlush(PgOutput output);
/* Marks used and unused options in /provenance and writes what is still buffered. Collective. */
PETSC_EXTERN PetscErrorCode PgOutputFinish(PgOutput output);
PETSC_EXTERN PetscErrorCode PgOutputDestroy(PgOutput *output);

/* ---- results on a mesh of quadrilaterals, in the same kind of file ---- */

/* The mesh, in the order of its numbers: this rank has nodes [node_start, node_start + node_count) and likewise cells. */
typedef struct {
  PetscInt         nodes, node_start, node_count;
  PetscInt         cells, cell_start, cell_count;
  const PetscReal *position; /* (node_count, 2) [m] */
  const PetscInt  *corner;   /* (cell_count, 4) numbers of nodes, counter-clockwise */
} PgGrid;
/* Values of the nodes, or of the cells, of this rank in that order. */
typedef struct {
  const char      *name;
  PetscBool        of_cells;
  PetscInt         components; /* 1, 2 or 4 */
  const char      *unit, *description;
  const PetscReal *value;
} PgGridField;
/* As PgOutputCreate(), with /mesh/position and /mesh/cells in FILE.h5 and quadrilaterals in FILE.xmf. The arrays of
   `grid` are borrowed until it returns. PgOutputHistory(), Flush, Finish and Destroy work as with discs. Collective. */
PETSC_EXTERN PetscErrorCode PgOutputCreateGrid(MPI_Comm comm, const char file[], const PgGrid *grid, PetscInt columns,
                                               const PgColumn column[], PgOutput *output);
/* As PgOutputContinue(). Collective. */
PETSC_EXTERN PetscErrorCode PgOutputContinueGrid(MPI_Comm comm, const char file[], const PgGrid *grid, PetscInt columns,
                                                 const PgColumn column[], const char run[], PetscInt rows,
                                                 PetscInt snapshots, const char from[], PgOutput *output);
/* Adds /snapshots/NNNNNN with attribute time and these fields. Collective. */
PETSC_EXTERN PetscErrorCode PgOutputGridSnapshot(PgOutput output, PetscReal time, PetscInt fields,
                                                 const PgGridField field[]);

/* Reads a dataset of a snapshot (any number of ranks; every rank gets all of it; for tests and plots).
   *value is allocated with PetscMalloc. Collective. */
PETSC_EXTERN PetscErrorCode PgResultRead(MPI_Comm comm, const char file[], const char dataset[], PetscInt *rows,
                                         PetscInt *columns, PetscReal **value);
PETSC_EXTERN PetscErrorCode PgResultReadAttribute(MPI_Comm comm, const char file[], const char object[],
                                                  const char name[], PetscReal *value);

/* ---- checkpoints: all that a run needs to go on as if it had never stopped ---- */

/* Refuses a place where no checkpoint can be written, or where something else is. Collective. */
PETSC_EXTERN PetscErrorCode PgCheckpointCheckPlace(MPI_Comm comm, const char file[]);
/* Refuses the name of a file that a run with results in OUTPUT, FILE.h5, is going to write. Collective. */
PETSC_EXTERN PetscErrorCode PgCheckpointCheckOutput(MPI_Comm comm, const char file[], const char output[]);
/* Writes the state and all fields and variable-length data flagged PG_FIELD_RESTART; the former FILE becomes
   FILE.1. FILE is replaced only by one that is complete, sealed with a checksum, and on the disk. Collective. */
PETSC_EXTERN PetscErrorCode PgCheckpointWrite(PgParticles particles, PgState state, const char file[]);
/* The same of a run without discs, which is all in its state. Collective. */
PETSC_EXTERN PetscErrorCode PgCheckpointWriteState(MPI_Comm comm, PgState state, const char file[]);
/* Seals a file made by hand, so that it is read: for tests, and for programs that write checkpoints. For one rank. */
PETSC_EXTERN PetscErrorCode PgCheckpointSeal(const char file[]);

typedef struct PgCheckpoint_s *PgCheckpoint;
/* Chooses a checkpoint and opens it: FILE, or FILE.1 when that is missing or damaged; of a directory or a pattern
   with * ? [] the one that was sealed last. What has no valid seal is never opened as an HDF5 file. Collective. */
PETSC_EXTERN PetscErrorCode PgCheckpointOpen(MPI_Comm comm, const char where[], PgCheckpoint *checkpoint);
PETSC_EXTERN PetscErrorCode PgCheckpointGetFile(PgCheckpoint checkpoint, const char **file);
/* Restores every item, or refuses: missing, of another type or size, not finite, or not MATCHing. Collective. */
PETSC_EXTERN PetscErrorCode PgCheckpointReadState(PgCheckpoint checkpoint, PgState state);
/* Restores the owned values of all fields and variable-length data flagged PG_FIELD_RESTART, whatever the
   distribution; the discs (their number and ids) are there already. Collective. */
PETSC_EXTERN PetscErrorCode PgCheckpointReadFields(PgCheckpoint checkpoint, PgParticles particles);
/* Reports what was wrong with the file, if anything. Collective. */
PETSC_EXTERN PetscErrorCode PgCheckpointClose(PgCheckpoint *checkpoint);

/* ---- packings: discs from and to CSV and HDF5 files; formats and limits are in docs/packings.md ---- */

/* The discs with ids [start, start + count) of `global`, the range of this rank as PgParticlesGetIdRange() has it. */
typedef struct {
  PetscInt   global, start, count;
  PetscReal *position, *velocity; /* (2) [m], (2) [m/s] */
  PetscReal *radius;              /* [m] */
  PetscBool  has_velocity;        /* the file gave it; zero otherwise */
  PetscBool  periodic;            /* x is periodic in [low, high) */
  PetscReal  low, high;           /* [m] */
} PgPacking;

/* Reads FILE, CSV or HDF5 by its content. `group` (may be empty) is the group of an HDF5 file that holds position and
   radius; default the root, or the last snapshot of a result file. Refuses, naming file, line or dataset, and
   reason, whatever is not a packing; memory is asked for when all values have been read and checked. Collective. */
PETSC_EXTERN PetscErrorCode PgPackingRead(MPI_Comm comm, const char file[], const char group[], PgPacking *packing);
/* Allocates the range of this rank, all zero. Collective. */
PETSC_EXTERN PetscErrorCode PgPackingCreate(MPI_Comm comm, PetscInt global, PgPacking *packing);
PETSC_EXTERN PetscErrorCode PgPackingFromParticles(PgParticles particles, PgPacking *packing); /* collective */
PETSC_EXTERN PetscErrorCode PgPackingDestroy(PgPacking *packing);
/* Refuses a name that ends in neither .csv nor .h5, and a place that cannot be written. Collective. */
PETSC_EXTERN PetscErrorCode PgPackingCheckPlace(MPI_Comm comm, const char file[]);
/* Refuses the name of a packing that -output FILE.h5 is going to write, FILE.csv being its history. Collective. */
PETSC_EXTERN PetscErrorCode PgPackingCheckOutput(MPI_Comm comm, const char file[]);
/* Writes all discs by id with digits that read back exactly; FILE is replaced only by a complete file. Collective. */
PETSC_EXTERN PetscErrorCode PgPackingWrite(MPI_Comm comm, const char file[], const PgPacking *packing);
/* Reads -packing_export FILE: checks the place, and writes the discs there unless particles is NULL. Collective. */
PETSC_EXTERN PetscErrorCode PgPackingExport(MPI_Comm comm, PgParticles particles);

/* The reader of CSV text: memory in, discs out, no files, nothing allocated. */
enum { PG_PACKING_X, PG_PACKING_Y, PG_PACKING_R, PG_PACKING_VX, PG_PACKING_VY, PG_PACKING_VALUES };
enum { PG_PACKING_LINE = 4096 }; /* longest line in bytes */
typedef struct {
  PetscInt64 line;                    /* lines met so far */
  PetscInt64 discs, declared;         /* met so far; said by a note, -1: nothing said */
  int        columns;                 /* of the table; 0: not known yet */
  int        role[PG_PACKING_VALUES]; /* of each column */
  PetscBool  periodic;
  PetscReal  low, high;
  char       reason[320]; /* why the text was refused; empty: so far so good */
} PgPackingCsv;
PETSC_EXTERN void PgPackingCsvStart(PgPackingCsv *csv);
/* Takes lines from `text` until `room` discs of PG_PACKING_VALUES values are found or no complete line is left, and
   returns how many bytes it took. `last`: nothing comes after this text. After a refusal it takes nothing. */
PETSC_EXTERN size_t PgPackingCsvParse(PgPackingCsv *csv, const char text[], size_t size, PetscBool last, PetscInt room,
                                      PetscReal disc[], PetscInt *discs);

/* ---- tables: rows of named columns, on the screen, as CSV and as HDF5 ---- */

typedef struct {
  const char *name, *unit, *description; /* in files; unit NULL: text */
  const char *head, *format; /* on the screen: heading and printf format of a double (text: NULL); head NULL:
                                            in files only */
  int         width;         /* on the screen */
} PgTableColumn;

/* Where tables go besides the screen. */
typedef struct {
  MPI_Comm    comm;
  const char *option;                   /* that named the files, for messages */
  char        base[PETSC_MAX_PATH_LEN]; /* empty: nowhere. BASE.csv, BASE-<table>.csv, BASE.h5 */
  PetscBool   created;
} PgTableFiles;
typedef struct PgTable_s *PgTable;

/* Tables beside each other in FILE.h5 and FILE.csv, `output` being FILE.h5 of option -output; empty: nowhere. Refuses a
   name without .h5. Collective. */
PETSC_EXTERN PetscErrorCode PgTableFilesFromOutput(MPI_Comm comm, const char output[], PgTableFiles *files);
/* The table named "study" has the CSV file BASE.csv and the HDF5 group /study. `column` is borrowed. Rows are written
   one by one, so that a program that is stopped leaves those it has done. Collective. */
PETSC_EXTERN PetscErrorCode PgTableCreate(PgTableFiles *files, const char name[], PetscInt columns,
                                          const PgTableColumn column[], PgTable *table);
enum { PG_TABLE_TEXT = 192 }; /* longest text of a cell, with its end mark */
/* Fill a cell of the row that comes next; those not filled are empty. Not collective. */
PETSC_EXTERN void PgTableReal(PgTable table, PetscInt column, PetscReal value);
PETSC_EXTERN void PgTableText(PgTable table, PetscInt column, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(3, 4);
#define PG_TABLE_EMPTY ((PetscReal)NAN)
/* Ends the row; `history` (n values, may be none) goes to /<name>/<row>/history. Collective. */
PETSC_EXTERN PetscErrorCode PgTableEndRow(PgTable table, PetscInt n, const PetscReal history[], const char unit[],
                                          const char description[]);
PETSC_EXTERN PetscErrorCode PgTableDestroy(PgTable *table);
