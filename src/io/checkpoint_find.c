/* Which checkpoint to restart from. Runs on rank 0 alone; the seal decides before HDF5 sees anything. */
#include "checkpointimpl.h"
#include <dirent.h>
#include <errno.h>
#include <glob.h>
#include <stdlib.h>
#include <sys/stat.h>

typedef struct {
  char    *file;
  uint64_t sealed;
} Candidate;

typedef struct {
  Candidate *candidate;
  size_t     count, room;
} Candidates;

static int LaterFirst(const void *a, const void *b)
{
  const Candidate *x = a, *y = b;

  if (x->sealed != y->sealed) return x->sealed < y->sealed ? 1 : -1;
  return strcmp(x->file, y->file);
}

/* Takes what looks like a checkpoint; 0 when there is no memory. */
static int Consider(Candidates *all, const char directory[], const char name[])
{
  const size_t length = strlen(directory) + strlen(name) + 2;
  PgSealInfo   info;
  char        *file;

  if (all->count == all->room) {
    const size_t room   = 2 * all->room + 16;
    Candidate   *larger = realloc(all->candidate, room * sizeof *larger);
    if (!larger) return 0;
    all->candidate = larger;
    all->room      = room;
  }
  file = malloc(length);
  if (!file) return 0;
  (void)snprintf(file, length, "%s%s%s", directory, directory[0] ? "/" : "", name);
  if (length > PETSC_MAX_PATH_LEN - 16 || PgSealGlance(file, PG_SEAL_CHECKPOINT, &info)) {
    free(file);
    return 1;
  }
  all->candidate[all->count++] = (Candidate){file, info.sealed};
  return 1;
}

static const char *ListDirectory(const char where[], Candidates *all)
{
  DIR           *directory = opendir(where);
  struct dirent *entry;
  int            memory = 1;

  if (!directory) return strerror(errno);
  while (memory && (entry = readdir(directory)) != NULL)
    if (entry->d_name[0] != '.') memory = Consider(all, where, entry->d_name);
  (void)closedir(directory);
  return memory ? NULL : strerror(ENOMEM);
}

static const char *ListPattern(const char where[], Candidates *all)
{
  glob_t    found;
  const int status = glob(where, 0, NULL, &found);
  int       memory = status != GLOB_NOSPACE;

  for (size_t k = 0; memory && status == 0 && k < found.gl_pathc; k++) memory = Consider(all, "", found.gl_pathv[k]);
  if (status == 0) globfree(&found);
  return memory ? NULL : strerror(ENOMEM);
}

/* The first of the candidates that is whole. */
static const char *TakeLatest(Candidates *all, char file[PETSC_MAX_PATH_LEN], char remark[], size_t remark_size)
{
  const char *reason = "there is no checkpoint";
  PgSealInfo  info;

  if (all->count) qsort(all->candidate, all->count, sizeof *all->candidate, LaterFirst);
  for (size_t k = 0; k < all->count; k++) {
    const char *const name = all->candidate[k].file;

    reason = PgSealVerify(name, PG_SEAL_CHECKPOINT, &info);
    if (!reason) {
      (void)snprintf(file, PETSC_MAX_PATH_LEN, "%s", name);
      return NULL;
    }
    (void)snprintf(remark, remark_size, "checkpoint '%s' is passed over: %s", name, reason);
    reason = "no checkpoint there is valid";
  }
  return reason;
}

static const char *FindAmongMany(const char where[], PetscBool directory, char file[PETSC_MAX_PATH_LEN], char remark[],
                                 size_t remark_size)
{
  Candidates  all    = {NULL, 0, 0};
  const char *reason = directory ? ListDirectory(where, &all) : ListPattern(where, &all);

  if (!reason) reason = TakeLatest(&all, file, remark, remark_size);
  for (size_t k = 0; k < all.count; k++) free(all.candidate[k].file);
  free(all.candidate);
  return reason;
}

const char *PgCheckpointFind(const char where[], char file[PETSC_MAX_PATH_LEN], char remark[], size_t remark_size)
{
  const char *reason;
  struct stat found;
  PgSealInfo  info;
  const int   there = stat(where, &found) == 0;

  remark[0] = 0;
  if (strlen(where) > PETSC_MAX_PATH_LEN - 16) return strerror(ENAMETOOLONG);
  if (there && S_ISDIR(found.st_mode)) return FindAmongMany(where, PETSC_TRUE, file, remark, remark_size);
  if (!there && strpbrk(where, "*?[")) return FindAmongMany(where, PETSC_FALSE, file, remark, remark_size);
  (void)snprintf(file, PETSC_MAX_PATH_LEN, "%s", where);
  reason = PgSealVerify(file, PG_SEAL_CHECKPOINT, &info);
  if (!reason) return NULL;
  (void)snprintf(file, PETSC_MAX_PATH_LEN, "%s.1", where);
  if (PgSealVerify(file, PG_SEAL_CHECKPOINT, &info)) return reason;
  (void)snprintf(remark, remark_size, "checkpoint '%s': %s; the one before it, '%s', is taken", where, reason, file);
  return NULL;
}
