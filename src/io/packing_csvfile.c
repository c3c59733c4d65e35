/* A CSV file as a source of discs: read in blocks, handed to the parser with what was left of the block before. */
#include "packingimpl.h"
#include <errno.h>
#include <fcntl.h>
#include <unistd.h>

enum { BLOCK = 1 << 20 };

typedef struct {
  int          descriptor;
  char        *text; /* BLOCK bytes */
  size_t       at, have;
  PetscBool    end; /* of the file has been met */
  PgPackingCsv csv;
} CsvFile;

static void Rewind(PgPackingSource *source)
{
  CsvFile *f = source->context;

  f->at = f->have = 0;
  f->end          = PETSC_FALSE;
  PgPackingCsvStart(&f->csv);
  if (lseek(f->descriptor, 0, SEEK_SET) < 0)
    PgPackingSourceFail(source, PETSC_ERR_FILE_READ, "cannot be read: %s", strerror(errno));
}

/* Moves what is left to the front and reads on. */
static void Fill(PgPackingSource *source, CsvFile *f)
{
  ssize_t got;

  (void)memmove(f->text, f->text + f->at, f->have - f->at);
  f->have -= f->at;
  f->at = 0;
  do got = read(f->descriptor, f->text + f->have, BLOCK - f->have);
  while (got < 0 && errno == EINTR);
  if (got < 0) PgPackingSourceFail(source, PETSC_ERR_FILE_READ, "cannot be read: %s", strerror(errno));
  if (got == 0) f->end = PETSC_TRUE;
  if (got > 0) f->have += (size_t)got;
}

static PetscInt Next(PgPackingSource *source, PetscInt room, PetscReal disc[])
{
  CsvFile *f     = source->context;
  PetscInt discs = 0;

  while (!source->code) {
    f->at += PgPackingCsvParse(&f->csv, f->text + f->at, f->have - f->at, f->end, room, disc, &discs);
    if (f->csv.reason[0]) PgPackingSourceFail(source, PETSC_ERR_USER_INPUT, "%s", f->csv.reason);
    if (discs || f->end) break;
    Fill(source, f);
  }
  if (source->code) return 0;
  source->total        = PetscMax(source->total, f->csv.discs);
  source->has_velocity = (PetscBool)(f->csv.columns == PG_PACKING_VALUES);
  source->periodic     = f->csv.periodic;
  source->low          = f->csv.low;
  source->high         = f->csv.high;
  return discs;
}

static void Close(PgPackingSource *source)
{
  CsvFile *f = source->context;

  (void)close(f->descriptor);
  (void)PetscFree(f->text);
  (void)PetscFree(source->context);
}

PetscErrorCode PgPackingCsvOpen(PgPackingSource *source)
{
  CsvFile *f;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&f));
  PetscCall(PetscMalloc1(BLOCK, &f->text));
  source->context = f;
  source->next    = Next;
  source->rewind  = Rewind;
  source->close   = Close;
  f->descriptor   = open(source->file, O_RDONLY | O_CLOEXEC);
  if (f->descriptor < 0)
    PgPackingSourceFail(source, PETSC_ERR_FILE_OPEN, "cannot be opened: %s", strerror(errno));
  else
    Rewind(source);
  PetscFunctionReturn(0);
}
