/* The journal of the result file. HDF5 changes its tables in place and in an order of its own, so that a program
   killed in the middle leaves a file that nobody can read. Before each change everything that may change is
   therefore copied into FILE.h5.journal: all of the file but the values of finished snapshots and full pieces of
   the history, which stay where they are. When the change is complete and on the disk, the journal is removed. If
   one is found later, it undoes the change. All calls are for rank 0.

     8 bytes  size of the file
     8 bytes  number of ranges
     16 bytes for each range: where it starts, its length
     the bytes of the ranges, one after the other
     a seal (seal.c) */
#include "ioimpl.h"
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PIECE = 1 << 20 };

static const char *JournalName(const char file[], const char ending[], char name[PETSC_MAX_PATH_LEN])
{
  const int length = snprintf(name, PETSC_MAX_PATH_LEN, "%s.journal%s", file, ending);

  return length > 0 && length < PETSC_MAX_PATH_LEN ? NULL : strerror(ENAMETOOLONG);
}

/* Copies bytes between files. */
static const char *Copy(int from, off_t from_offset, int to, off_t to_offset, off_t length)
{
  static unsigned char piece[PIECE];
  const char          *reason = NULL;

  while (length > 0 && !reason) {
    const size_t bytes = (size_t)PetscMin(length, (off_t)PIECE);

    reason = PgReadAll(from, piece, bytes, from_offset);
    if (!reason) reason = PgWriteAll(to, piece, bytes, to_offset);
    from_offset += (off_t)bytes;
    to_offset += (off_t)bytes;
    length -= (off_t)bytes;
  }
  return reason;
}

static int ByOffset(const void *a, const void *b)
{
  const PgRange *x = a, *y = b;

  return x->offset < y->offset ? -1 : x->offset > y->offset;
}

/* What the settled ranges leave of [0, size), as ranges; returns their number. */
static size_t Complement(PgRange settled[], size_t count, int64_t size, PgRange rest[])
{
  int64_t end = 0;
  size_t  n   = 0;

  if (count) qsort(settled, count, sizeof *settled, ByOffset);
  for (size_t k = 0; k < count && settled[k].offset < size; k++) {
    if (settled[k].offset > end) rest[n++] = (PgRange){end, settled[k].offset - end};
    end = PetscMax(end, settled[k].offset + settled[k].length);
  }
  if (end < size) rest[n++] = (PgRange){end, size - end};
  return n;
}

static const char *WriteJournal(int file, int journal, int64_t size, const PgRange range[], size_t count)
{
  const int64_t head[2] = {size, (int64_t)count};
  off_t         at      = sizeof head;
  const char   *reason  = PgWriteAll(journal, head, sizeof head, 0);

  if (!reason) reason = PgWriteAll(journal, range, count * sizeof *range, at);
  at += (off_t)(count * sizeof *range);
  for (size_t k = 0; k < count && !reason; k++) {
    reason = Copy(file, range[k].offset, journal, at, range[k].length);
    at += range[k].length;
  }
  return reason;
}

/* Writes, seals and installs the journal of an open file. */
static const char *Save(int file, const char temporary[], const char name[], int64_t size, const PgRange range[],
                        size_t count)
{
  const int   journal = open(temporary, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  const char *reason;

  if (journal < 0) return strerror(errno);
  reason = WriteJournal(file, journal, size, range, count);
  if (close(journal) && !reason) reason = strerror(errno);
  if (!reason) reason = PgSealFile(temporary, PG_SEAL_JOURNAL);
  if (!reason && rename(temporary, name)) reason = strerror(errno);
  if (reason) (void)unlink(temporary);
  return reason ? reason : PgSyncDirectory(name);
}

const char *PgJournalBegin(const char file[], int64_t size, PgRange settled[], size_t count)
{
  char        name[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN];
  const char *reason = JournalName(file, "", name);
  PgRange    *rest;
  int         descriptor;

  if (!reason) reason = JournalName(file, ".tmp", temporary);
  if (reason) return reason;
  descriptor = open(file, O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return strerror(errno);
  rest = malloc((count + 1) * sizeof *rest);
  if (rest)
    reason = Save(descriptor, temporary, name, size, rest, Complement(settled, count, size, rest));
  else
    reason = strerror(ENOMEM);
  free(rest);
  (void)close(descriptor);
  return reason;
}

const char *PgJournalEnd(const char file[])
{
  char        name[PETSC_MAX_PATH_LEN];
  const char *reason     = JournalName(file, "", name);
  const int   descriptor = open(file, O_RDWR | O_CLOEXEC);

  if (!reason && descriptor < 0) reason = strerror(errno);
  if (!reason && fsync(descriptor)) reason = strerror(errno);
  if (descriptor >= 0) (void)close(descriptor);
  if (!reason && unlink(name) && errno != ENOENT) reason = strerror(errno);
  return reason;
}

void PgJournalForget(const char file[])
{
  char name[PETSC_MAX_PATH_LEN];

  if (!JournalName(file, "", name)) (void)unlink(name);
  if (!JournalName(file, ".tmp", name)) (void)unlink(name);
}

/* ---- undoing ---- */

/* The table of ranges, compared with the size of the journal and of the file; NULL in *range after a failure. */
static const char *ReadTable(int journal, int64_t bytes, int64_t head[2], PgRange **range)
{
  int64_t     total;
  const char *reason;

  *range = NULL;
  if (bytes < (int64_t)(2 * sizeof *head)) return "it is too short";
  reason = PgReadAll(journal, head, 2 * sizeof *head, 0);
  if (reason) return reason;
  if (head[0] < 0 || head[1] < 0 || head[1] > bytes / (int64_t)sizeof **range) return "its table makes no sense";
  *range = malloc((size_t)(head[1] + 1) * sizeof **range);
  if (!*range) return strerror(ENOMEM);
  reason = PgReadAll(journal, *range, (size_t)head[1] * sizeof **range, 2 * sizeof *head);
  total  = (int64_t)(2 * sizeof *head) + head[1] * (int64_t)sizeof **range;
  for (int64_t k = 0; k < head[1] && !reason; k++) {
    const PgRange *r = &(*range)[k];
    if (r->offset < 0 || r->length <= 0 || r->offset > head[0] || r->length > head[0] - r->offset ||
        r->length > bytes - total)
      reason = "its table makes no sense";
    else
      total += r->length;
  }
  if (!reason && total != bytes) reason = "its size does not fit its table";
  return reason;
}

static const char *Undo(int journal, int file, int64_t bytes)
{
  int64_t     head[2] = {0, 0}, at;
  PgRange    *range   = NULL;
  const char *reason  = ReadTable(journal, bytes, head, &range);
  struct stat found;

  if (!reason && fstat(file, &found)) reason = strerror(errno);
  if (!reason && found.st_size < head[0] && ftruncate(file, head[0])) reason = strerror(errno);
  at = (int64_t)sizeof head + head[1] * (int64_t)sizeof *range;
  for (int64_t k = 0; !reason && k < head[1]; k++) {
    reason = Copy(journal, at, file, range[k].offset, range[k].length);
    at += range[k].length;
  }
  if (!reason && ftruncate(file, head[0])) reason = strerror(errno);
  if (!reason && fsync(file)) reason = strerror(errno);
  free(range);
  return reason;
}

const char *PgJournalUndo(const char file[], PetscBool *undone)
{
  char        name[PETSC_MAX_PATH_LEN];
  const char *reason = JournalName(file, "", name);
  PgSealInfo  info;
  PetscBool   there;
  struct stat found;
  int         journal, descriptor;

  *undone = PETSC_FALSE;
  if (reason) return reason;
  reason = PgIsThere(name, &there, &found);
  if (reason || !there) return reason;
  reason = PgSealVerify(name, PG_SEAL_JOURNAL, &info);
  if (reason) return reason;
  journal    = open(name, O_RDONLY | O_CLOEXEC);
  descriptor = open(file, O_RDWR | O_CLOEXEC);
  if (journal < 0 || descriptor < 0)
    reason = strerror(errno);
  else
    reason = Undo(journal, descriptor, (int64_t)info.bytes);
  if (journal >= 0) (void)close(journal);
  if (descriptor >= 0) (void)close(descriptor);
  if (!reason && unlink(name)) reason = strerror(errno);
  *undone = (PetscBool)!reason;
  return reason;
}

PetscBool PgJournalIsThere(const char file[])
{
  char        name[PETSC_MAX_PATH_LEN];
  PetscBool   there;
  struct stat found;

  if (JournalName(file, "", name)) return PETSC_FALSE;
  return (PetscBool)(PgIsThere(name, &there, &found) || there);
}
