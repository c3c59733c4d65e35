/* Packings: discs from a file to the ranks, by range of ids. Rank 0 goes through the file twice: first all of it is
   read and checked, then memory is asked for and pieces are sent. So no rank holds more than its share and a piece,
   and a bad file is refused by all ranks together before anything has been made of it. */
#include "packingimpl.h"
#include <errno.h>
#include <math.h>
#include <stdarg.h>

void PgPackingSourceFail(PgPackingSource *source, PetscErrorCode code, const char format[], ...)
{
  va_list arguments;

  if (source->code) return;
  source->code = code;
  va_start(arguments, format);
  (void)vsnprintf(source->reason, sizeof source->reason, format, arguments);
  va_end(arguments);
}

PetscErrorCode PgPackingCreate(MPI_Comm comm, PetscInt global, PgPacking *packing)
{
  PetscMPIInt rank, size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  (void)memset(packing, 0, sizeof *packing);
  packing->global = global;
  packing->start  = PgPackingRangeStart(global, rank, size);
  packing->count  = PgPackingRangeStart(global, rank + 1, size) - packing->start;
  PetscCall(PetscCalloc3(2 * (size_t)packing->count, &packing->position, 2 * (size_t)packing->count, &packing->velocity,
                         packing->count, &packing->radius));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPackingDestroy(PgPacking *packing)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(packing->position, packing->velocity, packing->radius));
  (void)memset(packing, 0, sizeof *packing);
  PetscFunctionReturn(0);
}

PetscErrorCode PgPackingFromParticles(PgParticles particles, PgPacking *packing)
{
  PetscReal *x, *v, *r;
  PetscInt   global;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(particles, NULL, NULL, &global));
  PetscCall(PgPackingCreate(PgParticlesComm(particles), global, packing));
  PetscCall(PgParticlesGetPeriodicX(particles, &packing->periodic, &packing->low, &packing->high));
  PetscCall(PgParticlesGetArray(particles, PG_POSITION, &x));
  PetscCall(PgParticlesGetArray(particles, PG_VELOCITY, &v));
  PetscCall(PgParticlesGetArray(particles, PG_RADIUS, &r));
  PetscCall(PgParticlesToIdOrder(particles, 2, x, packing->position));
  PetscCall(PgParticlesToIdOrder(particles, 2, v, packing->velocity));
  PetscCall(PgParticlesToIdOrder(particles, 1, r, packing->radius));
  packing->has_velocity = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* ---- rank 0: which reader, and a first pass ---- */

static PetscBool EndsIn(const char file[], const char ending[])
{
  const size_t n = strlen(file), m = strlen(ending);
  return (PetscBool)(n >= m && !strcmp(file + n - m, ending));
}

static PetscErrorCode Open(PgPackingSource *source, const char group[])
{
  static const unsigned char signature[8] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
  unsigned char              head[8]      = {0};
  PetscInt64                 size;
  const char                *reason = PgWhyNotFile(source->file, &size);
  FILE                      *stream;
  PetscBool                  hdf = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (reason) {
    PgPackingSourceFail(source, PETSC_ERR_FILE_OPEN, "cannot be opened: %s", reason);
  } else if (!(stream = fopen(source->file, "rb"))) {
    PgPackingSourceFail(source, PETSC_ERR_FILE_OPEN, "cannot be opened: %s", strerror(errno));
  } else {
    hdf = (PetscBool)(fread(head, 1, sizeof head, stream) == sizeof head && !memcmp(head, signature, sizeof head));
    (void)fclose(stream);
    if (size == 0)
      PgPackingSourceFail(source, PETSC_ERR_USER_INPUT, "it is empty");
    else if (!hdf && (EndsIn(source->file, ".h5") || EndsIn(source->file, ".hdf5")))
      PgPackingSourceFail(source, PETSC_ERR_FILE_UNEXPECTED,
                          "it does not begin like an HDF5 file: it is damaged, or "
                          "another kind of file (a table must not be named .h5)");
    else if (!hdf && group[0])
      PgPackingSourceFail(source, PETSC_ERR_USER_INPUT, "option -packing_group '%s' belongs to HDF5 files", group);
  }
  if (source->code) PetscFunctionReturn(0);
  if (hdf)
    PetscCall(PgPackingHdfOpen(source, group));
  else
    PetscCall(PgPackingCsvOpen(source));
  PetscFunctionReturn(0);
}

/* Reads and checks everything. */
static void Survey(PgPackingSource *source, PetscReal disc[])
{
  PetscInt64 met = 0;
  PetscInt   got;

  while ((got = source->next(source, PG_PACKING_PIECE, disc)) > 0) met += got;
  source->total = met;
  source->rewind(source);
}

/* ---- all ranks ---- */

/* The failure of rank 0 on all ranks. */
static PetscErrorCode Verdict(MPI_Comm comm, const PgPackingSource *source)
{
  PetscMPIInt code = (PetscMPIInt)source->code;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&code, 1, MPI_INT, 0, comm));
  if (code) {
    PetscCall(PgReport(comm, "packing '%s': %s", source->file, source->reason));
    PetscFunctionReturn((PetscErrorCode)code);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode CreateFromSource(MPI_Comm comm, const PgPackingSource *source, PgPacking *packing)
{
  PetscInt64 head[3] = {source->total, source->has_velocity, source->periodic};
  PetscReal  ends[2] = {source->low, source->high};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(head, 3, MPIU_INT64, 0, comm));
  PetscCallMPI(MPI_Bcast(ends, 2, MPIU_REAL, 0, comm));
  PetscCall(PgPackingCreate(comm, (PetscInt)head[0], packing));
  packing->has_velocity = (PetscBool)head[1];
  packing->periodic     = (PetscBool)head[2];
  packing->low          = ends[0];
  packing->high         = ends[1];
  PetscFunctionReturn(0);
}

/* `rows` discs from the source; zeros when it has failed, which the last verdict tells. */
static void Take(PgPackingSource *source, PetscInt rows, PetscReal disc[])
{
  PetscInt have = 0;

  while (have < rows) {
    const PetscInt got = source->next(source, rows - have, disc + (size_t)have * PG_PACKING_VALUES);
    if (!got) break;
    have += got;
  }
  if (have < rows) {
    PgPackingSourceFail(source, PETSC_ERR_FILE_READ, "it has changed while it was read");
    (void)memset(disc + (size_t)have * PG_PACKING_VALUES, 0, (size_t)(rows - have) * PG_PACKING_VALUES * sizeof *disc);
  }
}

static void Unpack(PgPacking *packing, PetscInt at, PetscInt rows, const PetscReal disc[])
{
  for (PetscInt i = 0; i < rows; i++) {
    const PetscReal *d                  = disc + (size_t)i * PG_PACKING_VALUES;
    packing->position[2 * (at + i)]     = d[PG_PACKING_X];
    packing->position[2 * (at + i) + 1] = d[PG_PACKING_Y];
    packing->velocity[2 * (at + i)]     = d[PG_PACKING_VX];
    packing->velocity[2 * (at + i) + 1] = d[PG_PACKING_VY];
    packing->radius[at + i]             = d[PG_PACKING_R];
  }
}

/* Every rank its range, in pieces. */
static PetscErrorCode Scatter(MPI_Comm comm, PgPackingSource *source, PetscReal disc[], PgPacking *packing)
{
  PetscMPIInt rank, size, tag = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  for (PetscMPIInt to = 0; to < size; to++) {
    const PetscInt count = PgPackingRangeStart(packing->global, to + 1, size) -
                           PgPackingRangeStart(packing->global, to, size);
    if (rank && rank != to) continue;
    for (PetscInt at = 0; at < count; at += PG_PACKING_PIECE) {
      const PetscInt    rows   = PetscMin(count - at, (PetscInt)PG_PACKING_PIECE);
      const PetscMPIInt values = (PetscMPIInt)(rows * PG_PACKING_VALUES);
      if (!rank) Take(source, rows, disc);
      if (!rank && to) PetscCallMPI(MPI_Send(disc, values, MPIU_REAL, to, tag, comm));
      if (rank) PetscCallMPI(MPI_Recv(disc, values, MPIU_REAL, 0, tag, comm, MPI_STATUS_IGNORE));
      if (rank == to) Unpack(packing, at, rows, disc);
    }
  }
  /* what was met in the first pass must be all there is */
  if (!rank && !source->code && source->next(source, 1, disc))
    PgPackingSourceFail(source, PETSC_ERR_FILE_READ, "it has changed while it was read");
  PetscFunctionReturn(0);
}

static PetscErrorCode Read(MPI_Comm comm, PgPackingSource *source, const char group[], PgPacking *packing)
{
  PetscMPIInt    rank;
  PetscReal     *disc;
  PetscErrorCode err;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscMalloc1(PG_PACKING_PIECE * PG_PACKING_VALUES, &disc));
  if (!rank) {
    PetscCall(Open(source, group));
    if (!source->code) Survey(source, disc);
  }
  err = Verdict(comm, source);
  if (!err) {
    PetscCall(CreateFromSource(comm, source, packing));
    PetscCall(Scatter(comm, source, disc, packing));
    err = Verdict(comm, source);
    if (err) PetscCall(PgPackingDestroy(packing));
  }
  if (source->close) source->close(source);
  PetscCall(PetscFree(disc));
  PetscFunctionReturn(err);
}

PetscErrorCode PgPackingRead(MPI_Comm comm, const char file[], const char group[], PgPacking *packing)
{
  PgPackingSource *source;
  MPI_Comm         own; /* so that the pieces meet no message of anyone else */
  PetscMPIInt      tag;
  PetscErrorCode   err;

  PetscFunctionBeginUser;
  (void)memset(packing, 0, sizeof *packing);
  PetscCall(PetscCommDuplicate(comm, &own, &tag));
  PetscCall(PetscNew(&source));
  source->file = file;
  err          = Read(own, source, group, packing);
  PetscCall(PetscFree(source));
  PetscCall(PetscCommDestroy(&own));
  PetscFunctionReturn(err);
}
