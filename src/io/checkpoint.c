/* Writing checkpoints: FILE.tmp is written through HDF5, sealed, and only then renamed to FILE, whose predecessor
   stays as FILE.1. Whenever the program or the machine stops, one of the two is whole.

     /               attributes format, format_version, program_version, real_bytes, discs, ranks
     /state/NAME     numbers of the run; texts are attributes of /state
     /fields/NAME    (discs) or (discs, components), in the order of permanent ids
     /ragged/NAME/count   (discs) records of each disc
     /ragged/NAME/record  (records, components), those of disc 0 first */
#include "checkpointimpl.h"
#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

/* Bytes of a dataset beside its values, with its attributes; and of the file beside its datasets. */
enum { DATASET_BYTES = 4096, FILE_BYTES = 65536, NAME_BYTES = PETSC_MAX_PATH_LEN + 16 };

PetscErrorCode PgCheckpointName(MPI_Comm comm, const char file[], const char ending[], char name[], size_t size)
{
  const int length = snprintf(name, size, "%s%s", file, ending);

  PetscFunctionBeginUser;
  PgInputCheck(file[0] && length > 0 && (size_t)length < size - 16, comm, "checkpoint '%s': the name is %s", file,
               file[0] ? "too long" : "empty");
  PetscFunctionReturn(0);
}

/* Never puts a checkpoint in the place of something else. */
static const char *WhyNotPlace(const char file[])
{
  struct stat found;
  PgSealInfo  info;

  if (stat(file, &found)) return errno == ENOENT ? NULL : strerror(errno);
  if (S_ISDIR(found.st_mode)) return strerror(EISDIR);
  if (found.st_size == 0 && S_ISREG(found.st_mode)) return NULL;
  return PgSealGlance(file, PG_SEAL_CHECKPOINT, &info)
             ? "this file is there and is not a checkpoint; choose another name, or remove it"
             : NULL;
}

PetscErrorCode PgCheckpointCheckPlace(MPI_Comm comm, const char file[])
{
  char        temporary[NAME_BYTES];
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PgCheckpointName(comm, file, ".tmp", temporary, sizeof temporary));
  PetscCall(PgFileCheck(comm, PETSC_ERR_FILE_OPEN, "checkpoint", file, rank ? NULL : WhyNotPlace(file)));
  PetscCall(PgFileCheck(comm, PETSC_ERR_FILE_OPEN, "checkpoint", file, rank ? NULL : PgWhyNotWritable(temporary)));
  PetscFunctionReturn(0);
}

/* FILE without "./" in front. */
static const char *Bare(const char file[])
{
  while (!strncmp(file, "./", 2)) file += 2;
  return file;
}

/* Of a run with results in OUTPUT, a name that ends in .h5: whether it is going to write a file of this name. */
static PetscBool IsResult(const char output[], const char file[])
{
  static const char *const endings[] = {".h5",      ".csv",        ".xmf",           ".csv.tmp",
                                        ".xmf.tmp", ".h5.journal", "-postmortem.h5", "-failed.petsc"};
  const size_t             stem      = strlen(output) > 3 ? strlen(output) - 3 : 0;

  if (strncmp(output, file, stem) != 0) return PETSC_FALSE;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(endings); k++)
    if (!strcmp(file + stem, endings[k])) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode PgCheckpointCheckOutput(MPI_Comm comm, const char file[], const char output[])
{
  static const char *const endings[] = {"", ".1", ".tmp"};
  char                     name[NAME_BYTES];

  PetscFunctionBeginUser;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(endings); k++) {
    PetscCall(PgCheckpointName(comm, file, endings[k], name, sizeof name));
    PgInputCheck(!IsResult(Bare(output), Bare(name)), comm,
                 "options -checkpoint and -output: both are going to write the file '%s'; choose another name", name);
  }
  PetscFunctionReturn(0);
}

/* ---- what is in it ---- */

static PetscErrorCode WriteHeader(PgParticles particles, PgHdf *hdf)
{
  PetscMPIInt size;
  PetscInt    discs = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(hdf->comm, &size));
  if (particles) PetscCall(PgParticlesGetSizes(particles, NULL, NULL, &discs));
  PetscCall(PgHdfText(hdf, "/", "format", PG_CHECKPOINT_FORMAT));
  PetscCall(PgHdfInt(hdf, "/", "format_version", PG_CHECKPOINT_VERSION));
  PetscCall(PgHdfText(hdf, "/", "program_version", PG_VERSION));
  PetscCall(PgHdfInt(hdf, "/", "real_bytes", (PetscInt)sizeof(PetscReal)));
  PetscCall(PgHdfInt(hdf, "/", "discs", discs));
  PetscCall(PgHdfInt(hdf, "/", "ranks", size));
  PetscCall(PgHdfGroup(hdf, "/state"));
  PetscCall(PgHdfGroup(hdf, "/fields"));
  PetscCall(PgHdfGroup(hdf, "/ragged"));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteState(PgState state, PgHdf *hdf)
{
  const PgStateItem *item;
  PetscInt           count;
  PetscMPIInt        rank;
  char               path[256];

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(hdf->comm, &rank));
  PetscCall(PgStateGetItems(state, &count, &item));
  for (PetscInt k = 0; k < count; k++, item++) {
    const hsize_t size = (hsize_t)item->count;
    const hid_t   type = item->kind == PG_STATE_INTS ? PG_HDF_INT : PG_HDF_REAL;

    if (item->kind == PG_STATE_TEXT) {
      PetscCall(PgHdfText(hdf, "/state", item->name, item->value));
      continue;
    }
    (void)snprintf(path, sizeof path, "/state/%s", item->name);
    PetscCall(PgHdfDataset(hdf, path, type, 1, &size, 0, "SI", item->meaning));
    PetscCall(PgHdfWriteRows(hdf, path, type, item->count, 0, rank ? 0 : item->count, item->value));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteFields(PgParticles particles, PgHdf *hdf)
{
  const PgFieldInfo *info;
  PetscInt           fields, discs, start, count;
  PetscReal         *owned, *byid;
  char               path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(particles, NULL, NULL, &discs));
  PetscCall(PgParticlesGetIdRange(particles, &start, &count));
  PetscCall(PgParticlesGetFieldCount(particles, &fields));
  for (PgField f = 0; f < fields; f++) {
    PetscCall(PgParticlesGetFieldInfo(particles, f, &info));
    if (!(info->flags & PG_FIELD_RESTART)) continue;
    const hsize_t size[2] = {(hsize_t)discs, (hsize_t)info->components};

    PetscCall(PetscMalloc1(count * info->components, &byid));
    PetscCall(PgParticlesGetArray(particles, f, &owned));
    PetscCall(PgParticlesToIdOrder(particles, info->components, owned, byid));
    (void)snprintf(path, sizeof path, "/fields/%s", info->name);
    PetscCall(
        PgHdfDataset(hdf, path, PG_HDF_REAL, info->components == 1 ? 1 : 2, size, 0, info->unit, info->description));
    PetscCall(PgHdfWriteRows(hdf, path, PG_HDF_REAL, discs, start, count, byid));
    PetscCall(PetscFree(byid));
  }
  PetscFunctionReturn(0);
}

/* Number of records of each disc, and the largest, of all ranks. */
static PetscErrorCode CountRecords(PgParticles particles, const PetscInt offset[], PetscReal records[],
                                   PetscInt *widest)
{
  PetscInt owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  *widest = 0;
  for (PetscInt i = 0; i < owned; i++) {
    records[i] = (PetscReal)(offset[i + 1] - offset[i]);
    *widest    = PetscMax(*widest, offset[i + 1] - offset[i]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, widest, 1, MPIU_INT, MPI_MAX, PgParticlesComm(particles)));
  PetscFunctionReturn(0);
}

/* The records of this rank's ids one after the other: first all first records travel, then all second ones, ... */
static PetscErrorCode RecordsToIdOrder(PgParticles particles, PgRagged ragged, PetscInt components, PetscInt widest,
                                       PetscInt count, const PetscInt first[], PetscReal record[])
{
  const PetscInt  *offset;
  const PetscReal *from;
  PetscReal       *owned_slot, *slot;
  PetscInt         owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetRagged(particles, ragged, &offset, &from));
  PetscCall(PetscCalloc2(owned * components, &owned_slot, count * components, &slot));
  for (PetscInt k = 0; k < widest; k++) {
    for (PetscInt i = 0; i < owned; i++)
      if (offset[i] + k < offset[i + 1])
        PetscCall(PetscArraycpy(owned_slot + i * components, from + (offset[i] + k) * components, components));
    PetscCall(PgParticlesToIdOrder(particles, components, owned_slot, slot));
    for (PetscInt i = 0; i < count; i++)
      if (first[i] + k < first[i + 1])
        PetscCall(PetscArraycpy(record + (first[i] + k) * components, slot + i * components, components));
  }
  PetscCall(PetscFree2(owned_slot, slot));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteRagged(PgParticles particles, PgRagged ragged, const char name[], PetscInt components,
                                  PgHdf *hdf)
{
  const PetscInt *offset;
  PetscReal      *owned_records, *records, *record;
  PetscInt        discs, owned, start, count, widest, *first, *integer, end = 0, total;
  hsize_t         size[2];
  char            path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(particles, &owned, NULL, &discs));
  PetscCall(PgParticlesGetIdRange(particles, &start, &count));
  PetscCall(PgParticlesGetRagged(particles, ragged, &offset, NULL));
  PetscCall(PetscMalloc4(owned, &owned_records, count, &records, count + 1, &first, count, &integer));
  PetscCall(CountRecords(particles, offset, owned_records, &widest));
  PetscCall(PgParticlesToIdOrder(particles, 1, owned_records, records));
  first[0] = 0;
  for (PetscInt i = 0; i < count; i++) {
    integer[i]   = (PetscInt)records[i];
    first[i + 1] = first[i] + integer[i];
  }
  PetscCall(PetscMalloc1(first[count] * components, &record));
  PetscCall(RecordsToIdOrder(particles, ragged, components, widest, count, first, record));
  PetscCallMPI(MPI_Scan(&first[count], &end, 1, MPIU_INT, MPI_SUM, hdf->comm));
  PetscCallMPI(MPI_Allreduce(&first[count], &total, 1, MPIU_INT, MPI_SUM, hdf->comm));
  (void)snprintf(path, sizeof path, "/ragged/%s", name);
  PetscCall(PgHdfGroup(hdf, path));
  (void)snprintf(path, sizeof path, "/ragged/%s/count", name);
  size[0] = (hsize_t)discs;
  PetscCall(PgHdfDataset(hdf, path, PG_HDF_INT, 1, size, 0, "1", "records of each disc"));
  PetscCall(PgHdfWriteRows(hdf, path, PG_HDF_INT, discs, start, count, integer));
  (void)snprintf(path, sizeof path, "/ragged/%s/record", name);
  size[0] = (hsize_t)total;
  size[1] = (hsize_t)components;
  PetscCall(
      PgHdfDataset(hdf, path, PG_HDF_REAL, 2, size, 0, "SI", "records one after the other, those of disc 0 first"));
  PetscCall(PgHdfWriteRows(hdf, path, PG_HDF_REAL, total, end - first[count], first[count], record));
  PetscCall(PetscFree(record));
  PetscCall(PetscFree4(owned_records, records, first, integer));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteAllRagged(PgParticles particles, PgHdf *hdf)
{
  PetscInt    count, components;
  const char *name;
  unsigned    flags;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetRaggedCount(particles, &count));
  for (PgRagged r = 0; r < count; r++) {
    PetscCall(PgParticlesGetRaggedInfo(particles, r, &name, &components, &flags));
    if (flags & PG_FIELD_RESTART) PetscCall(WriteRagged(particles, r, name, components, hdf));
  }
  PetscFunctionReturn(0);
}

/* ---- the file ---- */

/* Upper bound of the size of what discs have in the file [bytes]. */
static PetscErrorCode SizeOfDiscs(PgParticles particles, PetscReal *bytes)
{
  const PgFieldInfo *info;
  PetscInt           discs, owned, fields, ragged, components;
  PetscReal          records = 0;
  unsigned           flags;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(particles, &owned, NULL, &discs));
  PetscCall(PgParticlesGetRaggedCount(particles, &ragged));
  for (PgRagged r = 0; r < ragged; r++) {
    const PetscInt *offset;
    PetscCall(PgParticlesGetRaggedInfo(particles, r, NULL, &components, &flags));
    PetscCall(PgParticlesGetRagged(particles, r, &offset, NULL));
    records += (PetscReal)offset[owned] * (PetscReal)components;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &records, 1, MPIU_REAL, MPIU_SUM, PgParticlesComm(particles)));
  *bytes = (PetscReal)ragged * (2 * DATASET_BYTES + 8 * (PetscReal)discs) + 8 * records;
  PetscCall(PgParticlesGetFieldCount(particles, &fields));
  for (PgField f = 0; f < fields; f++) {
    PetscCall(PgParticlesGetFieldInfo(particles, f, &info));
    *bytes += DATASET_BYTES + 8 * (PetscReal)info->components * (PetscReal)discs;
  }
  PetscFunctionReturn(0);
}

/* The same of the file. */
static PetscErrorCode FileSize(PgParticles particles, PgState state, PetscReal *bytes)
{
  const PgStateItem *item;
  PetscInt           items;

  PetscFunctionBeginUser;
  *bytes = 0.0;
  if (particles) PetscCall(SizeOfDiscs(particles, bytes));
  *bytes += FILE_BYTES;
  PetscCall(PgStateGetItems(state, &items, &item));
  for (PetscInt k = 0; k < items; k++) *bytes += DATASET_BYTES + 8 * (PetscReal)item[k].count;
  PetscFunctionReturn(0);
}

/* Creates the file and makes sure that all of it will fit on the device, before anything large is written. */
static PetscErrorCode CreateWithRoom(MPI_Comm comm, PgParticles particles, PgState state, const char temporary[],
                                     PgHdf *hdf)
{
  PetscMPIInt rank;
  PetscReal   bytes = 0;
  PgHdf       empty;
  char        what[96];

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(FileSize(particles, state, &bytes));
  (void)snprintf(what, sizeof what, "cannot write %.3f MiB into checkpoint", (double)bytes / 1048576.);
  PetscCall(PgFileCheck(comm, PETSC_ERR_FILE_WRITE, what, temporary,
                        rank ? NULL : PgWhyNoRoomForNew(temporary, (off_t)bytes)));
  PetscCall(PgHdfCreate(comm, temporary, H5F_LIBVER_EARLIEST, &empty));
  empty.what = "checkpoint";
  PetscCall(PgHdfClose(&empty));
  PetscCall(
      PgFileCheck(comm, PETSC_ERR_FILE_WRITE, what, temporary, rank ? NULL : PgWhyNoRoom(temporary, 0, (off_t)bytes)));
  PetscCall(PgHdfOpen(comm, temporary, hdf));
  hdf->what = "checkpoint";
  PetscFunctionReturn(0);
}

/* Rank 0: puts the sealed file into place and keeps the one before. NULL or why not. */
static const char *Install(const char temporary[], const char file[], const char before[])
{
  const char *reason;

  if (rename(file, before) && errno != ENOENT) return strerror(errno);
  if (rename(temporary, file)) {
    reason = strerror(errno);
    (void)rename(before, file);
    return reason;
  }
  return PgSyncDirectory(file);
}

static PetscErrorCode Write(MPI_Comm comm, PgParticles particles, PgState state, const char temporary[],
                            const char file[], const char before[])
{
  const char *reason = NULL;
  PetscMPIInt rank;
  PgHdf       hdf;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(CreateWithRoom(comm, particles, state, temporary, &hdf));
  PetscCall(WriteHeader(particles, &hdf));
  PetscCall(WriteState(state, &hdf));
  if (particles) PetscCall(WriteFields(particles, &hdf));
  if (particles) PetscCall(WriteAllRagged(particles, &hdf));
  PetscCall(PgHdfFlush(&hdf));
  PetscCall(PgHdfClose(&hdf));
  if (rank == 0) reason = PgSealFile(temporary, PG_SEAL_CHECKPOINT);
  PetscCall(PgFileCheck(comm, PETSC_ERR_FILE_WRITE, "cannot seal checkpoint", temporary, reason));
  if (rank == 0) reason = Install(temporary, file, before);
  PetscCall(PgFileCheck(comm, PETSC_ERR_FILE_WRITE, "cannot put into place checkpoint", file, reason));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteAndReplace(MPI_Comm comm, PgParticles particles, PgState state, const char file[])
{
  char           temporary[NAME_BYTES], before[NAME_BYTES];
  PetscMPIInt    rank;
  PetscErrorCode err;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PgCheckpointName(comm, file, ".tmp", temporary, sizeof temporary));
  PetscCall(PgCheckpointName(comm, file, ".1", before, sizeof before));
  err = Write(comm, particles, state, temporary, file, before);
  if (err && rank == 0) (void)unlink(temporary);
  PetscFunctionReturn(err);
}

PetscErrorCode PgCheckpointWrite(PgParticles particles, PgState state, const char file[])
{
  PetscFunctionBeginUser;
  PetscCall(WriteAndReplace(PgParticlesComm(particles), particles, state, file));
  PetscFunctionReturn(0);
}

PetscErrorCode PgCheckpointWriteState(MPI_Comm comm, PgState state, const char file[])
{
  PetscFunctionBeginUser;
  PetscCall(WriteAndReplace(comm, NULL, state, file));
  PetscFunctionReturn(0);
}

PetscErrorCode PgCheckpointSeal(const char file[])
{
  const char *reason = PgSealFile(file, PG_SEAL_CHECKPOINT);

  PetscFunctionBeginUser;
  PetscCheck(!reason, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "cannot seal checkpoint '%s': %s", file, reason);
  PetscFunctionReturn(0);
}
