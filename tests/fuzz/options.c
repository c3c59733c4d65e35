/* Fuzz target: options files. PETSc reads without an error what the check has let pass; of YAML, which begins with
   "---" or "%YAML ", the check has only seen the text. */
#include "../../src/base/baseimpl.h"
#include "fuzz.h"

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  (void)argc;
  (void)argv;
  (void)unsetenv("PETSC_OPTIONS");
  FuzzStart();
  return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  static char    program[] = "fuzz", option[] = "-options_file", name[] = "input.opts", skip[] = "-skip_petscrc";
  char *const    arguments[]   = {program, option, name, skip};
  char           message[4096] = "";
  PetscErrorCode err;
  PetscOptions   options;

  /* names of files in which PETSc puts in directories and variables are left to PETSc */
  if (memchr(data, '$', size) || memchr(data, '~', size)) return 0;
  FuzzWrite(name, data, size);
  err = PgOptionFilesCheck(4, arguments, message, sizeof message);
  Demand((err == 0) == (message[0] == 0));
  Demand(strlen(message) < sizeof message - 1);
  if (err || (size > 2 && !memcmp(data, "---", 3)) || (size > 5 && !memcmp(data, "%YAML ", 6))) return 0;
  Demand(!PetscOptionsCreate(&options));
  Demand(!PetscOptionsInsertFile(PETSC_COMM_SELF, options, name, PETSC_TRUE));
  Demand(!PetscOptionsDestroy(&options));
  return 0;
}
