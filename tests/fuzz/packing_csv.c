/* Fuzz target: the reader of CSV packings.
   The first byte chooses how the rest is cut into pieces. Whatever the text: discs and refusal do not depend on the
   pieces, every disc is one that can be used, and the reader ends. */
#include "fuzz.h"
#include <porograin/io.h>
#include <math.h>

enum { MOST_DISCS = 4096 };
typedef struct {
  PgPackingCsv csv;
  PetscInt     discs;
  PetscReal    disc[MOST_DISCS * PG_PACKING_VALUES];
} Reading;

/* Reads as a program reads a file: `piece` bytes more whenever nothing is left to take, `room` discs at a time. */
static void ReadInPieces(const char text[], size_t size, size_t piece, PetscInt room, Reading *reading)
{
  size_t at = 0, have = 0;

  PgPackingCsvStart(&reading->csv);
  reading->discs = 0;
  for (;;) {
    const PetscBool last = (PetscBool)(have == size);
    PetscReal       disc[16 * PG_PACKING_VALUES];
    PetscInt        discs;
    const size_t    used = PgPackingCsvParse(&reading->csv, text + at, have - at, last, room, disc, &discs);

    Demand(used <= have - at && discs >= 0 && discs <= room);
    at += used;
    for (PetscInt i = 0; i < discs && reading->discs < MOST_DISCS; i++)
      (void)memcpy(&reading->disc[PG_PACKING_VALUES * reading->discs++], &disc[PG_PACKING_VALUES * i],
                   PG_PACKING_VALUES * sizeof *disc);
    if (reading->csv.reason[0]) return;
    if (discs) continue;
    if (last) {
      Demand(at == size);
      return;
    }
    have = size - have < piece ? size : have + piece;
  }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  static Reading whole, parts;
  const char    *text  = size ? (const char *)data + 1 : "";
  const size_t   n     = size ? size - 1 : 0;
  const size_t   piece = size ? 1 + data[0] : 1;

  if (n > 100000) return 0;
  ReadInPieces(text, n, n + 1, 16, &whole);
  ReadInPieces(text, n, piece, 1 + (PetscInt)(piece % 16), &parts);
  Demand(!strcmp(whole.csv.reason, parts.csv.reason));
  Demand(strlen(whole.csv.reason) < sizeof whole.csv.reason - 1);
  Demand(whole.discs == parts.discs && whole.csv.discs == parts.csv.discs && whole.csv.line == parts.csv.line);
  Demand(!memcmp(whole.disc, parts.disc, (size_t)whole.discs * PG_PACKING_VALUES * sizeof *whole.disc));
  Demand(whole.csv.reason[0] || (whole.csv.discs > 0 && whole.csv.columns >= 3));
  for (PetscInt i = 0; i < whole.discs; i++) {
    const PetscReal *d = &whole.disc[PG_PACKING_VALUES * i];
    for (int k = 0; k < PG_PACKING_VALUES; k++) Demand(isfinite(d[k]));
    Demand(d[PG_PACKING_R] > 0);
  }
  return 0;
}
