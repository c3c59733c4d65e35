/* What the fuzz targets share. A target reads what it is given; whatever that is, the reader must refuse it or leave
   values that can be used, and must end. */
#pragma once

#include <porograin/base.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerInitialize(int *argc, char ***argv);

#define Demand(condition)                                                                                              \
  do {                                                                                                                 \
    if (!(condition)) Broken(#condition, __FILE__, __LINE__);                                                          \
  } while (0)

static inline void Broken(const char condition[], const char file[], int line)
{
  (void)fprintf(stderr, "%s:%d: not so: %s\n", file, line, condition);
  abort();
}

/* The arguments of the fuzzer are not for PETSc. */
static inline void FuzzStart(void)
{
  static char name[] = "fuzz", *list[] = {name, NULL}, **arguments = list;
  static int  count = 1;

  (void)setenv("OMPI_MCA_opal_signal", "", 1); /* OpenMPI would catch abort() before the fuzzer saves its input */
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
