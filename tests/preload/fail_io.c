/* To be loaded before the C library (LD_PRELOAD): makes one call fail that has to do with files whose name contains
   FAIL_IO_PATH, the FAIL_IO_AT-th of the process (0: none), with the error number FAIL_IO_ERROR; with
   FAIL_IO_FROM_THEN_ON all that follow, too, as on a disk that is full or broken. Number and name of each call are
   appended to the file FAIL_IO_LOG, "failed" behind those that were made to. With FAIL_IO_RANK only on that rank of
   Open MPI. The text that stdio buffers counts when it is flushed. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { DESCRIPTORS = 1024 };

static unsigned char watched[DESCRIPTORS];
static int           calls;

/* The function of this name that would have been called without us. */
#define REAL(name)                                                                                                     \
  static __typeof__(name) *real;                                                                                       \
  if (!real) *(void **)&real = dlsym(RTLD_NEXT, #name)

static int Number(const char name[], int otherwise)
{
  const char *const value = getenv(name);

  return value ? atoi(value) : otherwise;
}

static int IsPath(const char file[])
{
  const char *const part = getenv("FAIL_IO_PATH"), *const only = getenv("FAIL_IO_RANK"),
                    *const rank = getenv("OMPI_COMM_WORLD_RANK");

  return part && file && strstr(file, part) && !(only && strcmp(rank ? rank : "0", only));
}

static int IsWatched(int descriptor) { return descriptor >= 0 && descriptor < DESCRIPTORS && watched[descriptor]; }

static void Watch(int descriptor, int yes)
{
  if (descriptor >= 0 && descriptor < DESCRIPTORS) watched[descriptor] = (unsigned char)yes;
}

/* Counts a call: the error number it shall fail with, or 0. */
static int Count(const char name[])
{
  const int         at = Number("FAIL_IO_AT", 0), code = Number("FAIL_IO_ERROR", ENOSPC);
  const char *const log  = getenv("FAIL_IO_LOG");
  const int         fail = ++calls == at || (at > 0 && calls > at && getenv("FAIL_IO_FROM_THEN_ON"));
  char              line[128];

  if (log) {
    const int     before     = errno;
    const int     length     = snprintf(line, sizeof line, "%d %s%s\n", calls, name, fail ? " failed" : "");
    const int     descriptor = open(log, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    const ssize_t put        = write(descriptor, line, (size_t)length);
    (void)put;
    (void)close(descriptor);
    errno = before;
  }
  if (fail) errno = code;
  return fail ? code : 0;
}

int open(const char *file, int flags, ...)
{
  const int ours = IsPath(file);
  int       mode = 0, descriptor;

  REAL(open);
  if (flags & (O_CREAT | O_TMPFILE)) {
    va_list arguments;
    va_start(arguments, flags);
    mode = va_arg(arguments, int);
    va_end(arguments);
  }
  if (ours && Count("open")) return -1;
  descriptor = real(file, flags, mode);
  Watch(descriptor, ours);
  return descriptor;
}

FILE *fopen(const char *file, const char *mode)
{
  const int ours = IsPath(file);
  FILE     *stream;

  REAL(fopen);
  if (ours && Count("fopen")) return NULL;
  stream = real(file, mode);
  if (stream) Watch(fileno(stream), ours);
  return stream;
}

/* What is closed is gone, whatever the call says. */
int close(int descriptor)
{
  const int ours = IsWatched(descriptor);
  int       status;

  REAL(close);
  Watch(descriptor, 0);
  status = real(descriptor);
  return ours && Count("close") ? -1 : status;
}

int fclose(FILE *stream)
{
  const int ours = IsWatched(fileno(stream));
  int       status;

  REAL(fclose);
  Watch(fileno(stream), 0);
  status = real(stream);
  return ours && Count("fclose") ? EOF : status;
}

int fflush(FILE *stream)
{
  REAL(fflush);
  return stream && IsWatched(fileno(stream)) && Count("fflush") ? EOF : real(stream);
}

/* Calls on an open file. */
#define ON_OPEN_FILE(type, name, parameters, arguments)                                                                \
  type name parameters                                                                                                 \
  {                                                                                                                    \
    REAL(name);                                                                                                        \
    return IsWatched(descriptor) && Count(#name) ? -1 : real arguments;                                                \
  }

ON_OPEN_FILE(ssize_t, pread, (int descriptor, void *to, size_t size, off_t offset), (descriptor, to, size, offset))
ON_OPEN_FILE(ssize_t, pwrite, (int descriptor, const void *from, size_t size, off_t offset),
             (descriptor, from, size, offset))
ON_OPEN_FILE(int, fsync, (int descriptor), (descriptor))
ON_OPEN_FILE(int, ftruncate, (int descriptor, off_t size), (descriptor, size))
ON_OPEN_FILE(int, fstat, (int descriptor, struct stat *found), (descriptor, found))

int posix_fallocate(int descriptor, off_t offset, off_t size)
{
  const int code = IsWatched(descriptor) ? Count("posix_fallocate") : 0;

  REAL(posix_fallocate);
  return code ? code : real(descriptor, offset, size);
}

/* Calls on a name. */
#define ON_NAME(name, parameters, arguments)                                                                           \
  int name parameters                                                                                                  \
  {                                                                                                                    \
    REAL(name);                                                                                                        \
    return IsPath(file) && Count(#name) ? -1 : real arguments;                                                         \
  }

ON_NAME(stat, (const char *file, struct stat *found), (file, found))
ON_NAME(access, (const char *file, int mode), (file, mode))
ON_NAME(truncate, (const char *file, off_t size), (file, size))
ON_NAME(rename, (const char *file, const char *to), (file, to))
ON_NAME(unlink, (const char *file), (file))
