/* What the fuzz targets share. A target reads what it is given; whatever that is, the reader must refuse it or leave
   values that can be used, and must end. */
#pragma once

#include <porograin/base.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerInitialize(int *argc, char ***argv);

static void Demand(int condition)
{
  if (!condition) abort();
}

/* The arguments of the fuzzer are not for PETSc. */
static inline void FuzzStart(void)
{
  static char name[] = "fuzz", *list[] = {name, NULL}, **arguments = list;
  static int  count = 1;

  Demand(!PgInitialize(&count, &arguments, NULL));
  Demand(!PetscOptionsClear(NULL)); /* of the environment */
}

static inline void FuzzWrite(const char file[], const uint8_t *data, size_t size)
{
  FILE *stream = fopen(file, "wb");

  Demand(stream != NULL);
  Demand(size == 0 || fwrite(data, 1, size, stream) == size);
  Demand(!fclose(stream));
}
