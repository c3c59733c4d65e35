/* stacked_solvers FILE...: puts each file of a solver behind each other one, and the same in a file that names both, and
   sets a small panel up with them. The solver must be the one of the last file alone, in all that PETSc shows of it
   (-ksp_view). Prints the pairs that are not, and their number; exit status 0: none. */
#include <mpi.h>
#include <porograin/simulation.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VIEW = 65536, WORDS = 20, WORD = 512 };

static PetscErrorCode View(char text[VIEW])
{
  static const char scratch[] = "stacked_solvers.view";
  PgSimulation      simulation;
  PgPore            pore;
  PgPressure        pressure;
  KSP               ksp;
  PetscViewer       viewer;
  FILE             *file;

  PetscFunctionBeginUser;
  PetscCall(PgSimulationCreate(PETSC_COMM_WORLD, &simulation));
  PetscCall(PgSimulationSetFromOptions(simulation));
  PetscCall(PgSimulationSetUp(simulation));
  PetscCall(PgSimulationGetParts(simulation, NULL, NULL, NULL, &pore));
  PetscCall(PgPoreGetParts(pore, NULL, &pressure));
  PetscCall(PgPressureGetSystem(pressure, NULL, NULL, &ksp));
  PetscCall(PetscViewerASCIIOpen(PETSC_COMM_WORLD, scratch, &viewer));
  PetscCall(KSPView(ksp, viewer));
  PetscCall(PetscViewerDestroy(&viewer));
  PetscCall(PgSimulationDestroy(&simulation));
  file = fopen(scratch, "r");
  PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s", scratch);
  text[fread(text, 1, VIEW - 1, file)] = '\0';
  (void)fclose(file);
  PetscFunctionReturn(0);
}

static void Append(int *count, char word[WORDS][WORD], const char text[])
{
  (void)snprintf(word[(*count)++], WORD, "%s", text);
}

/* The solver that is set up with these files, in their order; whether it was refused. */
static int SetUp(const char *one, const char *two, char text[VIEW])
{
  static const char *const short_run[] = {
      "stacked_solvers", "-skip_petscrc", "-fluid", "ns", "-panel_columns", "4", "-panel_rows", "9",
      "-end_time",       "1e-5"};
  static char    word[WORDS][WORD];
  char          *argument[WORDS + 1] = {NULL}, **arguments = argument;
  int            count = 0;
  PetscErrorCode err;

  for (size_t k = 0; k < sizeof short_run / sizeof *short_run; k++) Append(&count, word, short_run[k]);
  for (int k = 0; k < 2; k++) {
    if (!(k ? two : one)) continue;
    Append(&count, word, "-options_file");
    Append(&count, word, k ? two : one);
  }
  for (int k = 0; k < count; k++) argument[k] = word[k];
  text[0] = '\0';
  err     = PgInitialize(&count, &arguments, NULL);
  if (!err) err = View(text);
  return PgFinalize(err) != 0 || !text[0];
}

/* A file that names the two, for the other way to put one behind the other. */
static const char *Both(const char *one, const char *two)
{
  static const char name[] = "stacked_solvers.opts";
  FILE             *file   = fopen(name, "w");

  if (!file) return NULL;
  (void)fprintf(file, "-options_file %s\n-options_file %s\n", one, two);
  return fclose(file) ? NULL : name;
}

int main(int argc, char *argv[])
{
  char *alone = (char *)malloc(VIEW), *stacked = (char *)malloc(VIEW);
  int   wrong = 0, pairs = 0;

  (void)MPI_Init(&argc, &argv);
  for (int two = 1; alone && stacked && two < argc; two++) {
    if (SetUp(argv[two], NULL, alone)) {
      printf("%s alone\n", argv[two]);
      wrong++;
    }
    for (int one = 1; one < argc; one++) {
      if (one == two) continue;
      pairs++;
      /* every third pair in one file: what PETSc reads is the same, what the check of options sees is not */
      if (!((one + two) % 3 ? SetUp(argv[one], argv[two], stacked)
                            : SetUp(Both(argv[one], argv[two]), NULL, stacked)) &&
          !strcmp(alone, stacked))
        continue;
      printf("%s behind %s\n%s\n", argv[two], argv[one], stacked);
      wrong++;
    }
  }
  fprintf(stderr, "%d pairs, %d wrong\n", pairs, wrong);
  free(alone);
  free(stacked);
  (void)MPI_Finalize();
  return wrong != 0;
}
