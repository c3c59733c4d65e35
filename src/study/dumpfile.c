/* Is a file a system that can be loaded? PETSc believes what its binary files say: a wrong length makes it ask for any
   amount of memory, a wrong column makes it write outside of a matrix. So one rank goes through the file first.

     matrix   1211216, rows, columns, nonzeros; length of each row; columns; values
     vector   1211214, length; values                                                  (right-hand side, solution)

   Integers and reals have the highest byte first and the sizes that PETSc was built with. */
#include "dumpfile.h"
#include <errno.h>
#include <math.h>
#include <petscmat.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>

enum { PIECE = 1 << 13 }; /* numbers read at a time */

typedef struct {
  FILE    *stream;
  uint64_t left;     /* bytes of the file behind the place of reading */
  char     part[32]; /* of the system, for messages */
  char    *reason;   /* empty: so far so good */
  size_t   reason_length;
  int64_t  rows, *length; /* of the matrix */
} Dump;

static void Refuse(Dump *d, const char format[], ...)
{
  size_t  used;
  va_list arguments;

  if (d->reason[0]) return;
  (void)snprintf(d->reason, d->reason_length, "it is not a system written by -pressure_dump: %s: ", d->part);
  used = strlen(d->reason);
  va_start(arguments, format);
  (void)vsnprintf(d->reason + used, d->reason_length - used, format, arguments);
  va_end(arguments);
}

static void Part(Dump *d, const char part[]) { (void)snprintf(d->part, sizeof d->part, "%s", part); }

/* The next bytes; a file that ends too early is refused before anything is read. */
static void Take(Dump *d, void *to, size_t bytes)
{
  if (d->reason[0]) return;
  if (d->left < bytes)
    Refuse(d, "the file ends too early");
  else if (fread(to, 1, bytes, d->stream) != bytes)
    Refuse(d, "it cannot be read: %s", ferror(d->stream) ? strerror(errno) : "it has become shorter");
  d->left -= bytes;
}

static uint64_t Number(const unsigned char *at, size_t bytes)
{
  uint64_t value = 0;

  for (size_t k = 0; k < bytes; k++) value = (value << 8) | at[k];
  return value;
}

static int64_t Integer(const unsigned char *at)
{
  const uint64_t value = Number(at, sizeof(PetscInt));

  return sizeof(PetscInt) == 4 ? (int64_t)(int32_t)(uint32_t)value : (int64_t)value;
}

static double Real(const unsigned char *at)
{
  const uint64_t bits = Number(at, sizeof(PetscReal));
  const uint32_t low  = (uint32_t)bits;
  double         x;
  float          single;

  (void)memcpy(&x, &bits, sizeof x);
  (void)memcpy(&single, &low, sizeof single);
  return sizeof(PetscReal) == 4 ? (double)single : x;
}

static void TakeIntegers(Dump *d, int count, int64_t value[])
{
  unsigned char bytes[4 * sizeof(PetscInt)];

  (void)memset(bytes, 0, sizeof bytes);
  Take(d, bytes, (size_t)count * sizeof(PetscInt));
  for (int k = 0; k < count; k++) value[k] = Integer(bytes + (size_t)k * sizeof(PetscInt));
}

/* Before memory is asked for: are there `count` numbers of so many bytes? */
static void NeedsRoom(Dump *d, int64_t count, size_t bytes, const char what[])
{
  if (!d->reason[0] && (count < 0 || (uint64_t)count > d->left / bytes))
    Refuse(d, "%lld %s are more than the file holds", (long long)count, what);
}

/* ---- the matrix ---- */

static void TakeLengths(Dump *d, int64_t nonzeros)
{
  unsigned char bytes[PIECE * sizeof(PetscInt)];
  int64_t       sum = 0;

  NeedsRoom(d, d->rows, sizeof(PetscInt), "rows");
  if (d->reason[0]) return;
  d->length = malloc((size_t)d->rows * sizeof *d->length);
  if (!d->length) Refuse(d, "no memory for %lld rows", (long long)d->rows);
  for (int64_t at = 0; at < d->rows && !d->reason[0]; at += PIECE) {
    const int count = (int)PetscMin(d->rows - at, (int64_t)PIECE);

    Take(d, bytes, (size_t)count * sizeof(PetscInt));
    for (int k = 0; k < count && !d->reason[0]; k++) {
      const int64_t   length = Integer(bytes + (size_t)k * sizeof(PetscInt));
      const long long row    = at + k;

      if (length < 0 || length > d->rows)
        Refuse(d, "row %lld has %lld nonzeros, it can have at most %lld", row, (long long)length, (long long)d->rows);
      d->length[at + k] = length;
      sum += length;
    }
  }
  if (sum != nonzeros)
    Refuse(d, "its rows have %lld nonzeros, its head says %lld", (long long)sum, (long long)nonzeros);
}

/* Columns of each row are within the matrix and ascend. */
static void TakeColumns(Dump *d, int64_t nonzeros)
{
  unsigned char bytes[PIECE * sizeof(PetscInt)];
  int64_t       row = 0, in_row = 0, before = -1;

  NeedsRoom(d, nonzeros, sizeof(PetscInt), "nonzeros");
  for (int64_t at = 0; at < nonzeros && !d->reason[0]; at += PIECE) {
    const int count = (int)PetscMin(nonzeros - at, (int64_t)PIECE);

    Take(d, bytes, (size_t)count * sizeof(PetscInt));
    for (int k = 0; k < count && !d->reason[0]; k++) {
      const int64_t column = Integer(bytes + (size_t)k * sizeof(PetscInt));

      while (in_row == d->length[row]) {
        row++;
        in_row = 0;
        before = -1;
      }
      if (column < 0 || column >= d->rows)
        Refuse(d, "row %lld has column %lld, the last one is %lld", (long long)row, (long long)column,
               (long long)d->rows - 1);
      if (column <= before)
        Refuse(d, "row %lld has column %lld after column %lld", (long long)row, (long long)column, (long long)before);
      before = column;
      in_row++;
    }
  }
}

static void TakeValues(Dump *d, int64_t count)
{
  unsigned char bytes[PIECE * sizeof(PetscReal)];

  NeedsRoom(d, count, sizeof(PetscReal), "values");
  for (int64_t at = 0; at < count && !d->reason[0]; at += PIECE) {
    const int got = (int)PetscMin(count - at, (int64_t)PIECE);

    Take(d, bytes, (size_t)got * sizeof(PetscReal));
    for (int k = 0; k < got && !d->reason[0]; k++) {
      const double    x  = Real(bytes + (size_t)k * sizeof(PetscReal));
      const long long in = at + k;
      if (!isfinite(x)) Refuse(d, "value %lld is not finite (%g)", in, x);
    }
  }
}

static void TakeMatrix(Dump *d)
{
  int64_t head[4] = {0, 0, 0, 0};

  Part(d, "matrix");
  TakeIntegers(d, 4, head);
  d->rows = head[1];
  if (head[0] != MAT_FILE_CLASSID) Refuse(d, "it does not begin like a matrix of PETSc");
  if (head[1] != head[2])
    Refuse(d, "%lld rows and %lld columns, it must be square", (long long)head[1], (long long)head[2]);
  if (head[1] < 1) Refuse(d, "%lld rows", (long long)head[1]);
  if (head[3] < 0) Refuse(d, "%lld nonzeros: it is not a sparse matrix", (long long)head[3]);
  TakeLengths(d, head[3]);
  TakeColumns(d, head[3]);
  TakeValues(d, head[3]);
}

static void TakeVector(Dump *d, const char part[])
{
  int64_t head[2] = {0, 0};

  Part(d, part);
  TakeIntegers(d, 2, head);
  if (head[0] != VEC_FILE_CLASSID) Refuse(d, "it does not begin like a vector of PETSc");
  if (head[1] != d->rows) Refuse(d, "%lld values for a matrix of %lld rows", (long long)head[1], (long long)d->rows);
  TakeValues(d, d->rows);
}

void PgDumpFileCheck(const char file[], char reason[], size_t length)
{
  Dump        d = {.reason = reason, .reason_length = length};
  PetscInt64  size;
  const char *why = PgWhyNotFile(file, &size);

  reason[0] = 0;
  if (why) {
    (void)snprintf(reason, length, "%s", why);
    return;
  }
  d.stream = fopen(file, "rb");
  if (!d.stream) {
    (void)snprintf(reason, length, "%s", strerror(errno));
    return;
  }
  d.left = (uint64_t)size;
  TakeMatrix(&d);
  TakeVector(&d, "right-hand side");
  TakeVector(&d, "solution");
  Part(&d, "solution");
  if (d.left) Refuse(&d, "%llu bytes follow it", (unsigned long long)d.left);
  free(d.length);
  (void)fclose(d.stream);
}
