/* Runs a fuzz target over files and folders instead of invented input: the corpus in the default tests, and single
   inputs that a fuzzer has found, for a debugger. */
#include "fuzz.h"
#include <dirent.h>
#include <sys/stat.h>

__attribute__((weak)) int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  (void)argc;
  (void)argv;
  return 0;
}

static int Replay(const char file[])
{
  FILE       *stream = fopen(file, "rb");
  struct stat found;
  uint8_t    *data;

  Demand(stream && !fstat(fileno(stream), &found));
  data = malloc((size_t)found.st_size + 1);
  Demand(data && fread(data, 1, (size_t)found.st_size, stream) == (size_t)found.st_size);
  Demand(!fclose(stream));
  (void)LLVMFuzzerTestOneInput(data, (size_t)found.st_size);
  free(data);
  return 1;
}

static int ReplayFolder(const char folder[])
{
  DIR           *listing = opendir(folder);
  struct dirent *entry;
  char           file[4096];
  int            count = 0;

  if (!listing) return Replay(folder);
  while ((entry = readdir(listing))) {
    if (entry->d_name[0] == '.') continue;
    (void)snprintf(file, sizeof file, "%s/%s", folder, entry->d_name);
    count += Replay(file);
  }
  (void)closedir(listing);
  return count;
}

int main(int argc, char *argv[])
{
  int count = 0;

  (void)LLVMFuzzerInitialize(&argc, &argv);
  for (int k = 1; k < argc; k++) count += ReplayFolder(argv[k]);
  (void)printf("%d inputs\n", count);
  return count ? 0 : 1; /* PETSc, where it was started, is left to the end of the process */
}
