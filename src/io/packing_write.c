/* Packings to files. Rank 0 writes, and gets the discs of the others in pieces. The file is written under the name
   FILE.part and takes its own when it is complete and on the disk.

   HDF5 files are made so that damage shows: tables with checksums (format of HDF5 1.10) and values with Fletcher's. */
#include "packingimpl.h"
#include <errno.h>
#include <locale.h>
#include <unistd.h>
#if defined(__APPLE__)
  #include <xlocale.h>
#endif

/* Where the pieces go; on rank 0. */
typedef struct PgPackingSink_s PgPackingSink;
struct PgPackingSink_s {
  const PgPacking *packing;
  const char      *part;         /* name while it is being written */
  char             reason[1100]; /* of the first failure; empty: none */
  PetscErrorCode (*open)(PgPackingSink *sink);
  PetscErrorCode (*put)(PgPackingSink *sink, PetscInt at, PetscInt rows, const PetscReal disc[]);
  PetscErrorCode (*close)(PgPackingSink *sink);
  /* CSV */
  FILE  *stream;
  PgText text;
  /* HDF5 */
  PgHdf      hdf;
  PetscReal *piece;
};

static void SinkFail(PgPackingSink *sink, const char reason[])
{
  if (!sink->reason[0]) (void)snprintf(sink->reason, sizeof sink->reason, "%s", reason);
}

/* ---- CSV ---- */

static PetscErrorCode CsvFlush(PgPackingSink *sink)
{
  PetscFunctionBeginUser;
  if (!sink->reason[0] && fwrite(sink->text.string, 1, sink->text.used, sink->stream) != sink->text.used)
    SinkFail(sink, strerror(errno));
  sink->text.used = 0;
  PetscFunctionReturn(0);
}

static PetscErrorCode CsvOpen(PgPackingSink *sink)
{
  const PgPacking *packing = sink->packing;

  PetscFunctionBeginUser;
  sink->stream = fopen(sink->part, "wb");
  if (!sink->stream) {
    SinkFail(sink, strerror(errno));
    PetscFunctionReturn(0);
  }
  PetscCall(PgTextPrint(&sink->text, "# porograin %s: discs in the order of their ids, SI units\n", PG_VERSION));
  PetscCall(PgTextPrint(&sink->text, "#! discs %" PetscInt_FMT "\n", packing->global));
  if (packing->periodic) {
    PetscCall(PgTextAppend(&sink->text, "#! periodic_x "));
    PetscCall(PgTextReal(&sink->text, packing->low));
    PetscCall(PgTextAppend(&sink->text, " "));
    PetscCall(PgTextReal(&sink->text, packing->high));
    PetscCall(PgTextAppend(&sink->text, "\n"));
  }
  PetscCall(PgTextAppend(&sink->text, "x,y,r,vx,vy\n"));
  PetscCall(CsvFlush(sink));
  PetscFunctionReturn(0);
}

static PetscErrorCode CsvPut(PgPackingSink *sink, PetscInt at, PetscInt rows, const PetscReal disc[])
{
  PetscFunctionBeginUser;
  (void)at;
  for (PetscInt k = 0; k < rows * PG_PACKING_VALUES; k++) {
    PetscCall(PgTextReal(&sink->text, disc[k]));
    PetscCall(PgTextAppend(&sink->text, k % PG_PACKING_VALUES == PG_PACKING_VALUES - 1 ? "\n" : ","));
  }
  PetscCall(CsvFlush(sink));
  PetscFunctionReturn(0);
}

static PetscErrorCode CsvClose(PgPackingSink *sink)
{
  PetscFunctionBeginUser;
  if (sink->stream) {
    if (!sink->reason[0] && (fflush(sink->stream) || fsync(fileno(sink->stream)))) SinkFail(sink, strerror(errno));
    if (fclose(sink->stream)) SinkFail(sink, strerror(errno));
  }
  PetscCall(PgTextDestroy(&sink->text));
  PetscFunctionReturn(0);
}

/* ---- HDF5 ---- */

enum { SETS = 3 };
static const struct {
  const char *path, *unit, *description;
  int         width, first;
} set_info[SETS] = {{"/position", "m", "centre of the disc", 2, PG_PACKING_X},
                    {"/radius", "m", "radius of the disc", 1, PG_PACKING_R},
                    {"/velocity", "m/s", "velocity of the centre", 2, PG_PACKING_VX}};

static PetscErrorCode HdfDataset(PgPackingSink *sink, int set)
{
  PgHdf        *hdf     = &sink->hdf;
  const char   *path    = set_info[set].path;
  const int     rank    = set_info[set].width > 1 ? 2 : 1;
  const hsize_t size[]  = {(hsize_t)sink->packing->global, (hsize_t)set_info[set].width};
  const hsize_t chunk[] = {(hsize_t)PetscMin(sink->packing->global, (PetscInt)PG_PACKING_PIECE), size[1]};
  hid_t         create, space, dataset;

  PetscFunctionBeginUser;
  if (hdf->failed) PetscFunctionReturn(0);
  create = PgHdfWatch(hdf, "describe dataset", path, H5Pcreate(H5P_DATASET_CREATE));
  space  = PgHdfWatch(hdf, "describe dataset", path, H5Screate_simple(rank, size, NULL));
  PgHdfWatch(hdf, "describe dataset", path, H5Pset_chunk(create, rank, chunk));
  PgHdfWatch(hdf, "describe dataset", path, H5Pset_fletcher32(create));
  dataset = H5Dcreate2(hdf->id, path, PG_HDF_REAL, space, H5P_DEFAULT, create, H5P_DEFAULT);
  PgHdfWatch(hdf, "create dataset", path, dataset);
  if (dataset >= 0) (void)H5Dclose(dataset);
  if (space >= 0) (void)H5Sclose(space);
  if (create >= 0) (void)H5Pclose(create);
  PetscCall(PgHdfText(hdf, path, "unit", set_info[set].unit));
  PetscCall(PgHdfText(hdf, path, "description", set_info[set].description));
  PetscFunctionReturn(0);
}

static PetscErrorCode HdfStart(PgPackingSink *sink)
{
  /* No work for a disk that is full: the room is asked for before. Values, and tables without end. */
  const off_t     values  = (off_t)sink->packing->global * PG_PACKING_VALUES * (off_t)sizeof(PetscReal);
  const char     *no_room = PgWhyNoRoomForNew(sink->part, values + values / 50 + 65536);
  PgHdf          *hdf     = &sink->hdf;
  const hsize_t   two     = 2;
  const PetscReal ends[2] = {sink->packing->low, sink->packing->high};
  hid_t           space, attribute;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * PG_PACKING_PIECE, &sink->piece));
  if (no_room) {
    SinkFail(sink, no_room);
    PetscFunctionReturn(0);
  }
  /* The newer layout has checksums of its tables. */
  PetscCall(PgHdfCreate(PETSC_COMM_SELF, sink->part, H5F_LIBVER_V110, hdf));
  PetscCall(PgHdfText(hdf, "/", "format", "porograin packing"));
  PetscCall(PgHdfText(hdf, "/", "program_version", PG_VERSION));
  for (int set = 0; set < SETS; set++) PetscCall(HdfDataset(sink, set));
  if (sink->packing->periodic && !hdf->failed) {
    space     = PgHdfWatch(hdf, "describe attribute", "periodic_x", H5Screate_simple(1, &two, NULL));
    attribute = H5Acreate2(hdf->id, "periodic_x", PG_HDF_REAL, space, H5P_DEFAULT, H5P_DEFAULT);
    PgHdfWatch(hdf, "create attribute", "periodic_x", attribute);
    if (!hdf->failed) PgHdfWatch(hdf, "write attribute", "periodic_x", H5Awrite(attribute, PG_HDF_REAL, ends));
    if (attribute >= 0) (void)H5Aclose(attribute);
    if (space >= 0) (void)H5Sclose(space);
  }
  if (hdf->failed) SinkFail(sink, hdf->trouble);
  PetscFunctionReturn(0);
}

static void HdfRows(PgHdf *hdf, int set, PetscInt at, PetscInt rows, const PetscReal piece[])
{
  const char   *path    = set_info[set].path;
  const hsize_t first[] = {(hsize_t)at, 0}, size[] = {(hsize_t)rows, (hsize_t)set_info[set].width};
  const hid_t   dataset = PgHdfWatch(hdf, "open dataset", path, H5Dopen2(hdf->id, path, H5P_DEFAULT));
  const hid_t   space   = PgHdfWatch(hdf, "select rows of", path, H5Dget_space(dataset));
  const hid_t   memory  = PgHdfWatch(hdf, "select rows of", path, H5Screate_simple(size[1] > 1 ? 2 : 1, size, NULL));

  PgHdfWatch(hdf, "select rows of", path, H5Sselect_hyperslab(space, H5S_SELECT_SET, first, NULL, size, NULL));
  if (!hdf->failed)
    PgHdfWatch(hdf, "write dataset", path, H5Dwrite(dataset, PG_HDF_REAL, memory, space, H5P_DEFAULT, piece));
  if (memory >= 0) (void)H5Sclose(memory);
  if (space >= 0) (void)H5Sclose(space);
  if (dataset >= 0) PgHdfWatch(hdf, "close dataset", path, H5Dclose(dataset));
}

static PetscErrorCode HdfPut(PgPackingSink *sink, PetscInt at, PetscInt rows, const PetscReal disc[])
{
  PetscFunctionBeginUser;
  for (int set = 0; set < SETS && !sink->reason[0]; set++) {
    const int width = set_info[set].width;
    for (PetscInt i = 0; i < rows; i++)
      for (int c = 0; c < width; c++)
        sink->piece[i * width + c] = disc[PG_PACKING_VALUES * i + set_info[set].first + c];
    HdfRows(&sink->hdf, set, at, rows, sink->piece);
    if (sink->hdf.failed) SinkFail(sink, sink->hdf.trouble);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode HdfFinish(PgPackingSink *sink)
{
  PgHdf *hdf = &sink->hdf;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(sink->piece));
  if (!hdf->file) PetscFunctionReturn(0); /* not begun, for want of room */
  PgHdfShut(hdf);
  if (hdf->failed) SinkFail(sink, hdf->trouble);
  PetscFunctionReturn(0);
}

/* ---- both ---- */

static PetscBool IsHdfName(const char file[])
{
  const size_t n = strlen(file);
  return (PetscBool)(n > 3 && !strcmp(file + n - 3, ".h5"));
}

static PetscBool IsCsvName(const char file[])
{
  const size_t n = strlen(file);
  return (PetscBool)(n > 4 && !strcmp(file + n - 4, ".csv"));
}

static PetscErrorCode Part(const char file[], char part[PETSC_MAX_PATH_LEN])
{
  PetscFunctionBeginUser;
  PetscCheck(strlen(file) + 6 < PETSC_MAX_PATH_LEN, PETSC_COMM_WORLD, PETSC_ERR_USER_INPUT,
             "packing '%s': the name is too long", file);
  PetscCall(PetscSNPrintf(part, PETSC_MAX_PATH_LEN, "%s.part", file));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPackingCheckPlace(MPI_Comm comm, const char file[])
{
  PetscMPIInt rank;
  char        part[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PgInputCheck(IsHdfName(file) || IsCsvName(file), comm,
               "packing '%s': the name must end in .csv or .h5, as in 'packing.csv'", file);
  PetscCall(Part(file, part));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PgFileCheck(comm, PETSC_ERR_FILE_OPEN, "cannot write packing", file, rank ? NULL : PgWhyNotWritable(file)));
  PetscCall(PgFileCheck(comm, PETSC_ERR_FILE_OPEN, "cannot write packing", part, rank ? NULL : PgWhyNotWritable(part)));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPackingCheckOutput(MPI_Comm comm, const char file[])
{
  char         output[PETSC_MAX_PATH_LEN] = "";
  const size_t length                     = strlen(file);
  size_t       base;
  PetscBool    clash;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetString(NULL, NULL, "-output", output, sizeof output, NULL));
  base  = strlen(output);
  base  = base > 3 ? base - 3 : 0; /* without .h5 */
  clash = (PetscBool)(base && !strncmp(file, output, base) &&
                      ((length == base + 3 && IsHdfName(file)) || (length == base + 4 && IsCsvName(file))));
  PgInputCheck(!clash, comm, "packing '%s': -output %s writes a file of this name; choose another name for one of them",
               file, output);
  PetscFunctionReturn(0);
}

static void Pack(const PgPacking *packing, PetscInt at, PetscInt rows, PetscReal disc[])
{
  for (PetscInt i = 0; i < rows; i++) {
    PetscReal *d     = disc + (size_t)i * PG_PACKING_VALUES;
    d[PG_PACKING_X]  = packing->position[2 * (at + i)];
    d[PG_PACKING_Y]  = packing->position[2 * (at + i) + 1];
    d[PG_PACKING_R]  = packing->radius[at + i];
    d[PG_PACKING_VX] = packing->velocity[2 * (at + i)];
    d[PG_PACKING_VY] = packing->velocity[2 * (at + i) + 1];
  }
}

/* All discs in the order of ids through rank 0 into the sink. */
static PetscErrorCode Gather(MPI_Comm comm, PgPackingSink *sink)
{
  const PgPacking *packing = sink->packing;
  PetscMPIInt      rank, size, tag = 0;
  PetscReal       *disc;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMalloc1(PG_PACKING_PIECE * PG_PACKING_VALUES, &disc));
  for (PetscMPIInt from = 0; from < size; from++) {
    const PetscInt start = PgPackingRangeStart(packing->global, from, size);
    const PetscInt count = PgPackingRangeStart(packing->global, from + 1, size) - start;
    if (rank && rank != from) continue;
    for (PetscInt at = 0; at < count; at += PG_PACKING_PIECE) {
      const PetscInt    rows   = PetscMin(count - at, (PetscInt)PG_PACKING_PIECE);
      const PetscMPIInt values = (PetscMPIInt)(rows * PG_PACKING_VALUES);
      if (rank == from) Pack(packing, at, rows, disc);
      if (rank) PetscCallMPI(MPI_Send(disc, values, MPIU_REAL, 0, tag, comm));
      if (!rank && from) PetscCallMPI(MPI_Recv(disc, values, MPIU_REAL, from, tag, comm, MPI_STATUS_IGNORE));
      if (!rank && !sink->reason[0]) PetscCall(sink->put(sink, start + at, rows, disc));
    }
  }
  PetscCall(PetscFree(disc));
  PetscFunctionReturn(0);
}

/* On rank 0: the finished file takes the place of an old one, or goes. */
static void Settle(PgPackingSink *sink, const char file[])
{
  const char *reason;

  if (!sink->reason[0] && rename(sink->part, file)) SinkFail(sink, strerror(errno));
  if (sink->reason[0])
    (void)unlink(sink->part);
  else if ((reason = PgSyncDirectory(file)))
    SinkFail(sink, reason);
}

/* Rank 0 opens, every rank sends, rank 0 closes. */
static PetscErrorCode WriteAll(MPI_Comm comm, PgPackingSink *sink, const char file[])
{
  PetscMPIInt rank;
  locale_t    plain = (locale_t)0, before = (locale_t)0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!rank) {
    plain = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    PetscCheck(plain, PETSC_COMM_SELF, PETSC_ERR_SYS, "the system has no C locale to write numbers in");
    before = uselocale(plain);
    PetscCall(sink->open(sink));
  }
  PetscCall(Gather(comm, sink));
  if (!rank) {
    PetscCall(sink->close(sink));
    (void)uselocale(before);
    freelocale(plain);
    Settle(sink, file);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgPackingWrite(MPI_Comm comm, const char file[], const PgPacking *packing)
{
  PgPackingSink *sink;
  char           part[PETSC_MAX_PATH_LEN];
  MPI_Comm       own; /* so that the pieces meet no message of anyone else */
  PetscMPIInt    tag;
  PetscErrorCode err;

  PetscFunctionBeginUser;
  PetscCall(PgPackingCheckPlace(comm, file));
  PetscCall(Part(file, part));
  PetscCall(PetscCommDuplicate(comm, &own, &tag));
  PetscCall(PetscNew(&sink));
  sink->packing = packing;
  sink->part    = part;
  sink->open    = IsHdfName(file) ? HdfStart : CsvOpen;
  sink->put     = IsHdfName(file) ? HdfPut : CsvPut;
  sink->close   = IsHdfName(file) ? HdfFinish : CsvClose;
  PetscCall(WriteAll(own, sink, file));
  err = PgFileCheck(comm, PETSC_ERR_FILE_WRITE, "cannot write packing", file, sink->reason[0] ? sink->reason : NULL);
  PetscCall(PetscFree(sink));
  PetscCall(PetscCommDestroy(&own));
  PetscFunctionReturn(err);
}

PetscErrorCode PgPackingExport(MPI_Comm comm, PgParticles particles)
{
  char           file[PETSC_MAX_PATH_LEN] = "";
  PgPacking      packing;
  PetscErrorCode err;

  PetscFunctionBeginUser;
  PetscOptionsBegin(comm, "", "output: results, checkpoints and restart", "");
  PetscCall(PgOptionString(PetscOptionsObject, "-packing_export",
                           "writes the discs at the start of the run to FILE.csv or FILE.h5", file, sizeof file, NULL));
  PetscOptionsEnd();
  if (file[0]) PetscCall(PgPackingCheckOutput(comm, file));
  if (file[0]) PetscCall(PgPackingCheckPlace(comm, file));
  if (!file[0] || !particles) PetscFunctionReturn(0);
  PetscCall(PgPackingFromParticles(particles, &packing));
  err = PgPackingWrite(comm, file, &packing);
  PetscCall(PgPackingDestroy(&packing));
  PetscFunctionReturn(err);
}
