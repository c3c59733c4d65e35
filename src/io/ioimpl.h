/* What the files of this room share. */
#pragma once

#include <porograin/io.h>
#include <hdf5.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/stat.h>

#if defined(PETSC_USE_REAL_SINGLE)
  #define PG_HDF_REAL H5T_NATIVE_FLOAT
#elif defined(PETSC_USE_REAL_DOUBLE)
  #define PG_HDF_REAL H5T_NATIVE_DOUBLE
#else
  #error "result files hold single or double precision reals only"
#endif
#if defined(PETSC_USE_64BIT_INDICES)
  #define PG_HDF_INT H5T_NATIVE_INT64
#else
  #define PG_HDF_INT H5T_NATIVE_INT
#endif

/* ---- disk.c: the way from HDF5 to a file, all calls are for one rank ---- */
typedef struct {
  int       error;      /* errno of the first failure, 0: none; nothing has been written since */
  int       descriptor; /* -1: not open */
  PetscBool unread;     /* something could not be read: HDF5 is not to be trusted with this file any more */
  void     *file;       /* HDF5's idea of it */
} PgDisk;

/* How to open files with H5Fcreate() and H5Fopen(): the disk must live until the file is closed. Negative after a
   failure of HDF5. The caller closes it with H5Pclose(). */
PETSC_INTERN hid_t PgDiskAccess(PgDisk *disk);
/* Waits until what was written is on the disk. */
PETSC_INTERN void PgDiskSync(PgDisk *disk);
/* In the place of H5Fclose(): closes the file behind HDF5's back, which will never touch it again. */
PETSC_INTERN void PgDiskAbandon(PgDisk *disk);

/* ---- hdf.c: an HDF5 file between opening and closing ----

   Rank 0 alone has the file open: the others send their rows to it. The first failure is remembered and makes the calls that follow do nothing, so that callers are
   straight lines with one check at the end: PgHdfClose() prints it once and returns its code on every
   rank. PetscErrorCode returned by the other calls is about PETSc and MPI only. All calls are collective
   on comm, with the same arguments on every rank but for the rows that are written. */
typedef struct {
  MPI_Comm       comm;
  const char    *file;
  const char    *what; /* kind of file, for messages */
  PgDisk         disk;
  hid_t          id;   /* of rank 0 */
  PetscBool      here; /* this is rank 0 of comm */
  PetscBool      failed;
  PetscErrorCode code;          /* what the failure is returned as */
  char           trouble[1024]; /* "cannot write dataset '/a/b': ..." */
  H5E_auto2_t    print;         /* HDF5's own error printing, off while the file is open */
  void          *print_context;
} PgHdf;

#define PG_HDF_MAX_RANK 3

/* The PgHdf must stay where it is until PgHdfClose(). Truncates an existing file; `oldest` is the first version of
   HDF5 that shall be able to read the file. */
PETSC_INTERN PetscErrorCode PgHdfCreate(MPI_Comm comm, const char file[], H5F_libver_t oldest, PgHdf *hdf);
PETSC_INTERN PetscErrorCode PgHdfOpen(MPI_Comm comm, const char file[], PgHdf *hdf);
PETSC_INTERN PetscErrorCode PgHdfOpenToRead(MPI_Comm comm, const char file[], PgHdf *hdf);
PETSC_INTERN PetscErrorCode PgHdfClose(PgHdf *hdf);
/* The same on rank 0 alone, without a word: the failure is in hdf. Not collective. */
PETSC_INTERN void PgHdfShut(PgHdf *hdf);
/* Forgets a failure that the caller tells of: PgHdfClose() will not. */
PETSC_INTERN void           PgHdfDismiss(PgHdf *hdf);
PETSC_INTERN PetscErrorCode PgHdfFlush(PgHdf *hdf);
/* Passes on `result` of an HDF5 call and remembers the failure if it is negative, or the disk's. Not collective. */
PETSC_INTERN hid_t PgHdfWatch(PgHdf *hdf, const char action[], const char object[], hid_t result);
/* Remembers a failure that HDF5 does not know of. Not collective. */
PETSC_INTERN void PgHdfFail(PgHdf *hdf, const char action[], const char object[], const char reason[]);
/* After this call all ranks have failed, with the words of the lowest rank that has, or none. */
PETSC_INTERN PetscErrorCode PgHdfAgree(PgHdf *hdf);
PETSC_INTERN PetscErrorCode PgHdfGroup(PgHdf *hdf, const char path[]);
PETSC_INTERN PetscErrorCode PgHdfRemoveIfThere(PgHdf *hdf, const char path[]);
PETSC_INTERN PetscErrorCode PgHdfMove(PgHdf *hdf, const char from[], const char to[]);
/* Attributes; an existing one of that name is replaced. */
PETSC_INTERN PetscErrorCode PgHdfText(PgHdf *hdf, const char object[], const char name[], const char value[]);
PETSC_INTERN PetscErrorCode PgHdfReal(PgHdf *hdf, const char object[], const char name[], PetscReal value);
PETSC_INTERN PetscErrorCode PgHdfInt(PgHdf *hdf, const char object[], const char name[], PetscInt value);
/* A dataset of `rank` dimensions with its attributes; chunk_rows > 0: with a growing first dimension. */
PETSC_INTERN PetscErrorCode PgHdfDataset(PgHdf *hdf, const char path[], hid_t type, int rank, const hsize_t size[],
                                         hsize_t chunk_rows, const char unit[], const char description[]);
/* Makes the dataset `rows` long and writes rows [start, start + count) of this rank (count may be 0). */
PETSC_INTERN PetscErrorCode PgHdfWriteRows(PgHdf *hdf, const char path[], hid_t type, PetscInt rows, PetscInt start,
                                           PetscInt count, const void *data);

/* ---- seal.c: files that know whether they are complete; all calls are for one rank ----

   A reason is NULL when all went well, and otherwise a text that lives on. */
typedef struct {
  uint64_t sealed; /* [ns since 1970] */
  off_t    bytes;  /* before the footer */
} PgSealInfo;

#define PG_SEAL_CHECKPOINT "PgCheckp"
#define PG_SEAL_JOURNAL    "PgJourna"

/* Appends the footer and waits until the file is on the disk. */
PETSC_INTERN const char *PgSealFile(const char file[], const char kind[8]);
PETSC_INTERN const char *PgSealVerify(const char file[], const char kind[8], PgSealInfo *info);
/* Looks at the footer alone. */
PETSC_INTERN const char *PgSealGlance(const char file[], const char kind[8], PgSealInfo *info);
/* Waits until the names in the directory of the file are on the disk. */
PETSC_INTERN const char *PgSyncDirectory(const char file[]);
PETSC_INTERN const char *PgReadAll(int descriptor, void *buffer, size_t size, off_t offset);
PETSC_INTERN const char *PgWriteAll(int descriptor, const void *buffer, size_t size, off_t offset);

/* ---- journal.c: undoing an interrupted change of the result file; all calls are for rank 0 ---- */
typedef struct {
  int64_t offset, length; /* [bytes] */
} PgRange;

/* Before a change: saves all of the file, which has `size` bytes, but the settled ranges (they are sorted here). */
PETSC_INTERN const char *PgJournalBegin(const char file[], int64_t size, PgRange settled[], size_t count);
/* The change is complete: waits until the file is on the disk. */
PETSC_INTERN const char *PgJournalEnd(const char file[]);
/* Undoes a change that was not completed, if there is one. */
PETSC_INTERN const char *PgJournalUndo(const char file[], PetscBool *undone);
PETSC_INTERN PetscBool   PgJournalIsThere(const char file[]);
/* For a new file: what is left of an old one must not undo it. */
PETSC_INTERN void PgJournalForget(const char file[]);

/* ---- text.c: a growing string ---- */
typedef struct {
  char  *string;
  size_t used, room;
} PgText;

PETSC_INTERN PetscErrorCode PgTextAppend(PgText *text, const char string[]);
PETSC_INTERN PetscErrorCode PgTextPrint(PgText *text, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
PETSC_INTERN PetscErrorCode PgTextAppendXml(PgText *text, const char string[]); /* with &, <, >, " escaped */
/* With the fewest digits that read back as the same number. */
PETSC_INTERN PetscErrorCode PgTextReal(PgText *text, PetscReal value);
/* The text of rank 0 on all ranks. Collective. */
PETSC_INTERN PetscErrorCode PgTextBroadcast(PgText *text, MPI_Comm comm);
PETSC_INTERN PetscErrorCode PgTextDestroy(PgText *text);

/* ---- the output object ---- */

/* Rows of the history kept in memory at most: when so many wait, they go to the file before a snapshot. */
#define PG_HISTORY_WAITING 1024
/* Bytes for /provenance, most of them for the lists of options. */
#define PG_PROVENANCE_BYTES 262144
/* Rows of a piece of /history/<name> in the file, 4 KiB: little for a short run, few pieces for a long one. */
#define PG_HISTORY_CHUNK 512

/* A snapshot is written under this name and linked to its own when it is complete. */
#define PG_SNAPSHOT_INCOMPLETE "/snapshots/.incomplete"

struct PgOutput_s {
  PgParticles particles; /* not owned; NULL: on a mesh */
  PgGrid      grid;      /* without its arrays; no nodes: of discs */
  MPI_Comm    comm;
  PetscMPIInt rank;
  char       *file, *xmf, *csv;
  const char *base;             /* file without its directory, for the XDMF index beside it */
  off_t       file_size;        /* rank 0: when it was closed */
  char        run[PG_RUN_NAME]; /* the run that the file belongs to */
  PetscInt    snapshots;        /* complete ones in the file */
  PetscBool   finished;
  PetscReal  *byid; /* work space: one field, rows of this rank in the order of files */
  PetscInt    byid_size;
  /* history */
  PetscInt   columns;
  PgColumn  *column;     /* with copies of the strings */
  PetscInt   written;    /* rows in the HDF5 file */
  PetscInt   waiting;    /* rows not yet there */
  PetscReal *row;        /* rank 0: [column][PG_HISTORY_WAITING], so that a column is contiguous */
  FILE      *csv_stream; /* rank 0 */
  PgText     line;       /* rank 0: the row as text */
  /* rank 0: what FILE.xmf says about the snapshots */
  PgText grids;
  /* rank 0: what the journal need not save, because nothing will ever change it */
  PgRange *settled;
  size_t   settled_count, settled_room;
  PetscInt settled_snapshots, settled_rows;
};

/* A failure of rank 0 (reason != NULL there), for all ranks: prints "what 'file': reason" and returns
   `code`. Collective. */
PETSC_INTERN PetscErrorCode PgFileCheck(MPI_Comm comm, PetscErrorCode code, const char what[], const char file[],
                                        const char reason[]);

/* check.c */
PETSC_INTERN PetscErrorCode PgOutputCheckName(MPI_Comm comm, const char file[]);
PETSC_INTERN PetscErrorCode PgOutputCheckPlaces(MPI_Comm comm, const char file[], const char xmf[], const char csv[]);
/* Makes sure that a new result file of this size will fit on the device. Collective. */
PETSC_INTERN PetscErrorCode PgOutputCheckRoom(PgOutput output, PetscReal bytes);
/* Opens the result file when it is sure that so many bytes more will fit into it, with a journal. Collective. */
PETSC_INTERN PetscErrorCode PgOutputOpen(PgOutput output, PetscReal more, PgHdf *hdf);
/* Closes it; after a failure the file is as it was before it was opened. Collective. */
PETSC_INTERN PetscErrorCode PgOutputClose(PgOutput output, PgHdf *hdf);
/* For rank 0, all four: NULL or why not. */
PETSC_INTERN const char *PgIsThere(const char file[], PetscBool *there, struct stat *found);
PETSC_INTERN const char *PgWhyNotWritable(const char file[]);
PETSC_INTERN const char *PgWhyNoRoom(const char file[], off_t size, off_t more);
PETSC_INTERN const char *PgWhyNoRoomForNew(const char file[], off_t bytes);

/* output.c: the parts of an output before anything is written */
PETSC_INTERN PetscErrorCode PgOutputCreateAs(PgParticles particles, const char file[], PetscInt columns,
                                             const PgColumn column[], const char run[], PgOutput *output);
PETSC_INTERN PetscErrorCode PgOutputPrepare(MPI_Comm comm, PgParticles particles, const char file[], PetscInt columns,
                                            const PgColumn column[], PgOutput *output);
/* continue.c: whether the file is there; and of an output that is prepared, takes up the files of the run. Collective. */
PETSC_INTERN PetscErrorCode PgOutputIsThere(MPI_Comm comm, const char file[], PetscBool *there);
PETSC_INTERN PetscErrorCode PgOutputTakeUp(PgOutput output, const char run[], PetscInt rows, PetscInt snapshots,
                                           const char from[]);
/* Creates the three files, before any snapshot; `grid` is NULL for discs. */
PETSC_INTERN PetscErrorCode PgOutputWriteFirst(PgOutput output, const PgGrid *grid);
PETSC_INTERN PetscErrorCode PgGridWriteMesh(PgOutput output, PgHdf *hdf, const PgGrid *grid);
/* A snapshot between the opening and the closing of the file, when its data are in INCOMPLETE: history, name, count. */
PETSC_INTERN PetscErrorCode PgSnapshotComplete(PgOutput output, PgHdf *hdf, const char group[]);
/* Closes the file and counts the snapshot, or forgets what the index says of it, `before` having been its length. */
PETSC_INTERN PetscErrorCode PgSnapshotClose(PgOutput output, PgHdf *hdf, size_t before);

/* settled.c: for rank 0, looks for what has become settled in the closed file; NULL or why not */
PETSC_INTERN const char *PgSettle(PgOutput output);

/* provenance.c */
PETSC_INTERN PetscErrorCode PgProvenanceStart(PgHdf *hdf);
PETSC_INTERN PetscErrorCode PgProvenanceFinish(PgHdf *hdf);
PETSC_INTERN PetscErrorCode PgProvenanceRestart(PgHdf *hdf, const char from[], PetscInt rows, PetscInt snapshots);
PETSC_INTERN PetscErrorCode PgRunName(MPI_Comm comm, char name[PG_RUN_NAME]);

/* history.c */
/* A run that writes a result file locks its history, and tells others so; rank 0. */
PETSC_INTERN void           PgHistoryLock(FILE *csv);
PETSC_INTERN PetscBool      PgResultIsBusy(const char file[]);
PETSC_INTERN PetscErrorCode PgHistoryCreate(PgOutput output, PetscInt columns, const PgColumn column[]);
PETSC_INTERN PetscErrorCode PgHistoryCreateDatasets(PgOutput output, PgHdf *hdf);
PETSC_INTERN PetscErrorCode PgHistoryOpenCsv(PgOutput output);
/* The name of a column in the file. */
PETSC_INTERN PetscErrorCode PgHistoryPath(PgOutput output, PetscInt c, char path[], size_t size);
/* Rank 0: the header line, or row `r` of columns that hold `rows` each, as text. */
PETSC_INTERN PetscErrorCode PgHistoryHeaderText(PgOutput output, PgText *line);
PETSC_INTERN PetscErrorCode PgHistoryRowText(PgOutput output, PetscInt rows, PetscInt r, const PetscReal value[],
                                             PgText *line);
PETSC_INTERN PetscErrorCode PgHistoryCloseCsv(PgOutput output);
/* Upper bound of what appending the waiting rows adds to the file. */
PETSC_INTERN PetscReal PgHistoryBytes(PgOutput output);
/* The rows count as written when the caller has closed the file without an error and calls Done. */
PETSC_INTERN PetscErrorCode PgHistoryAppend(PgOutput output, PgHdf *hdf);
PETSC_INTERN void           PgHistoryAppendDone(PgOutput output);
PETSC_INTERN PetscErrorCode PgHistoryDestroy(PgOutput output);

/* xdmf.c: all but the last are for rank 0 */
PETSC_INTERN PetscErrorCode PgXdmfBeginGrid(PgOutput output, const char group[], PetscReal time, PetscInt rows);
PETSC_INTERN PetscErrorCode PgXdmfAddField(PgOutput output, const char group[], const char name[], PetscInt components,
                                           PetscBool integer, PetscInt rows);
PETSC_INTERN PetscErrorCode PgXdmfEndGrid(PgOutput output);
PETSC_INTERN PetscErrorCode PgXdmfBeginMesh(PgOutput output, const char group[], PetscReal time);
PETSC_INTERN PetscErrorCode PgXdmfAddGridField(PgOutput output, const char group[], const PgGridField *field);
PETSC_INTERN PetscErrorCode PgXdmfWrite(PgOutput output); /* collective */
