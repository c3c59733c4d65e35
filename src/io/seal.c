/* Seals: a finished file ends in a footer with a checksum of everything before it, so that a file that was cut
   short, extended or damaged anywhere is told from a good one without opening it by its format. HDF5 does not
   mind bytes after its own. All calls are for one rank.

   The footer, integers with the lowest byte first:
     8 bytes  what kind of file, e.g. "PgCheckp"
     8 bytes  when it was sealed [ns since 1970]
     8 bytes  size of the file, footer included
     8 bytes  XXH64 of all bytes before */
#include "ioimpl.h"
#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include <xxhash.h>

enum { FOOTER = 32, HASHED = 24, PIECE = 1 << 20 };

static void PutNumber(unsigned char *at, uint64_t value)
{
  for (int k = 0; k < 8; k++) at[k] = (unsigned char)(value >> (8 * k));
}

static uint64_t GetNumber(const unsigned char *at)
{
  uint64_t value = 0;

  for (int k = 7; k >= 0; k--) value = (value << 8) | at[k];
  return value;
}

const char *PgReadAll(int descriptor, void *buffer, size_t size, off_t offset)
{
  unsigned char *to = buffer;

  while (size > 0) {
    const ssize_t got = pread(descriptor, to, size, offset);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return strerror(errno);
    if (got == 0) return "it ends too early";
    to += got;
    offset += got;
    size -= (size_t)got;
  }
  return NULL;
}

const char *PgWriteAll(int descriptor, const void *buffer, size_t size, off_t offset)
{
  const unsigned char *from = buffer;

  while (size > 0) {
    const ssize_t put = pwrite(descriptor, from, size, offset);
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) return strerror(errno);
    from += put;
    offset += put;
    size -= (size_t)put;
  }
  return NULL;
}

/* Checksum of the first `size` bytes. */
static const char *Hash(int descriptor, uint64_t size, const unsigned char more[], size_t more_size, uint64_t *hash)
{
  static unsigned char piece[PIECE];
  const char          *reason = NULL;
  XXH64_state_t       *state  = XXH64_createState();

  if (!state) return "no memory for its checksum";
  (void)XXH64_reset(state, 0);
  for (uint64_t done = 0; done < size && !reason; done += PIECE) {
    const size_t length = (size_t)PetscMin(size - done, (uint64_t)PIECE);
    reason              = PgReadAll(descriptor, piece, length, (off_t)done);
    if (!reason) (void)XXH64_update(state, piece, length);
  }
  (void)XXH64_update(state, more, more_size);
  *hash = XXH64_digest(state);
  (void)XXH64_freeState(state);
  return reason;
}

static const char *Seal(int descriptor, const char kind[8])
{
  unsigned char   footer[FOOTER];
  struct stat     found;
  struct timespec now = {0, 0};
  uint64_t        hash;
  const char     *reason;

  if (fstat(descriptor, &found)) return strerror(errno);
  (void)clock_gettime(CLOCK_REALTIME, &now);
  (void)memcpy(footer, kind, 8);
  PutNumber(footer + 8, (uint64_t)now.tv_sec * 1000000000U + (uint64_t)now.tv_nsec);
  PutNumber(footer + 16, (uint64_t)found.st_size + FOOTER);
  reason = Hash(descriptor, (uint64_t)found.st_size, footer, HASHED, &hash);
  if (reason) return reason;
  PutNumber(footer + HASHED, hash);
  reason = PgWriteAll(descriptor, footer, FOOTER, found.st_size);
  if (reason) return reason;
  return fsync(descriptor) ? strerror(errno) : NULL;
}

const char *PgSealFile(const char file[], const char kind[8])
{
  const int   descriptor = open(file, O_RDWR | O_CLOEXEC);
  const char *reason;

  if (descriptor < 0) return strerror(errno);
  reason = Seal(descriptor, kind);
  if (close(descriptor) && !reason) reason = strerror(errno);
  return reason;
}

/* What the footer says, without believing it: kind and size. */
static const char *ReadFooter(int descriptor, const char kind[8], unsigned char footer[FOOTER])
{
  struct stat found;
  const char *reason;

  if (fstat(descriptor, &found)) return strerror(errno);
  if (S_ISDIR(found.st_mode)) return strerror(EISDIR);
  if (!S_ISREG(found.st_mode)) return "it is not a regular file";
  if (found.st_size == 0) return "it is empty";
  if (found.st_size <= FOOTER) return "it is too short";
  reason = PgReadAll(descriptor, footer, FOOTER, found.st_size - FOOTER);
  if (reason) return reason;
  if (memcmp(footer, kind, 8)) return "it has no seal at its end: it is incomplete, damaged, or no such file at all";
  if (GetNumber(footer + 16) != (uint64_t)found.st_size) return "it does not have the size that its seal says";
  return NULL;
}

static const char *Verify(int descriptor, const char kind[8], PetscBool whole, PgSealInfo *info)
{
  unsigned char footer[FOOTER] = {0};
  uint64_t      hash           = 0;
  const char   *reason         = ReadFooter(descriptor, kind, footer);

  if (reason) return reason;
  info->sealed = GetNumber(footer + 8);
  info->bytes  = (off_t)(GetNumber(footer + 16) - FOOTER);
  if (!whole) return NULL;
  reason = Hash(descriptor, (uint64_t)info->bytes, footer, HASHED, &hash);
  if (reason) return reason;
  return hash == GetNumber(footer + HASHED) ? NULL : "its checksum is wrong: it is damaged";
}

static const char *OpenAndVerify(const char file[], const char kind[8], PetscBool whole, PgSealInfo *info)
{
  const int   descriptor = open(file, O_RDONLY | O_NONBLOCK | O_CLOEXEC); /* a pipe shall not keep us waiting */
  const char *reason;

  if (descriptor < 0) return strerror(errno);
  reason = Verify(descriptor, kind, whole, info);
  (void)close(descriptor);
  return reason;
}

const char *PgSealVerify(const char file[], const char kind[8], PgSealInfo *info)
{
  return OpenAndVerify(file, kind, PETSC_TRUE, info);
}

const char *PgSealGlance(const char file[], const char kind[8], PgSealInfo *info)
{
  return OpenAndVerify(file, kind, PETSC_FALSE, info);
}

/* Names are part of the directory: a rename lasts when the directory has been written out. */
const char *PgSyncDirectory(const char file[])
{
  char        directory[PETSC_MAX_PATH_LEN];
  const char *slash = strrchr(file, '/'), *reason = NULL;
  int         descriptor;

  if (!slash)
    (void)snprintf(directory, sizeof directory, ".");
  else
    (void)snprintf(directory, sizeof directory, "%.*s", (int)PetscMax(1, slash - file), file);
  descriptor = open(directory, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return strerror(errno);
  if (fsync(descriptor) && errno != EINVAL && errno != EROFS) reason = strerror(errno);
  (void)close(descriptor);
  return reason;
}
