/* Which checkpoint to restart from. Runs on rank 0 alone; the seal decides before HDF5 sees anything. */
#include "checkpointimpl.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <glob.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

/* Where the text that marks a checkpoint is found. */
enum { HEAD_BYTES = 65536 };

typedef struct {
  char    *file;
  uint64_t sealed;
} Candidate;

/* What was refused, and why: "'a.pgc': it is empty; 'b.pgc': ...". */
typedef struct {
  char   text[1600];
  size_t used;
  int    count, left_out;
} Refused;

typedef struct {
  Candidate *candidate;
  size_t     count, room;
  PetscBool  named; /* by the user, with a pattern: each of them is meant */
  Refused    refused;
} Candidates;

static int LaterFirst(const void *a, const void *b)
{
  const Candidate *x = a, *y = b;

  if (x->sealed != y->sealed) return x->sealed < y->sealed ? 1 : -1;
  return strcmp(x->file, y->file);
}

static void Refuse(Refused *refused, const char file[], const char reason[])
{
  const size_t left   = sizeof refused->text - refused->used;
  const int    length = snprintf(refused->text + refused->used, left, "%s'%s': %s", refused->count ? "; " : "", file,
                                 reason);

  if (length < 0 || (size_t)length >= left) {
    refused->text[refused->used] = 0;
    refused->left_out++;
  } else {
    refused->used += (size_t)length;
  }
  refused->count++;
}

/* A file without a seal that was to be a checkpoint, by its name or by what is left of it. */
static PetscBool LooksLikeOne(const char file[])
{
  static const char format[] = PG_CHECKPOINT_FORMAT;
  const char *const ending   = strstr(file, ".pgc");
  char              head[HEAD_BYTES];
  struct stat       found;
  ssize_t           size = 0;
  int               descriptor;

  if (ending && (!ending[4] || !strcmp(ending + 4, ".1"))) return PETSC_TRUE;
  descriptor = open(file, O_RDONLY | O_NONBLOCK | O_CLOEXEC); /* a pipe shall not keep us waiting */
  if (descriptor < 0) return PETSC_FALSE;
  if (!fstat(descriptor, &found) && S_ISREG(found.st_mode)) size = pread(descriptor, head, sizeof head, 0);
  (void)close(descriptor);
  for (ssize_t k = 0; k + (ssize_t)sizeof format <= size; k++)
    if (!memcmp(head + k, format, sizeof format - 1)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Takes what looks like a checkpoint; 0 when there is no memory. */
static int Consider(Candidates *all, const char directory[], const char name[])
{
  const size_t length = strlen(directory) + strlen(name) + 2;
  const char  *reason;
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
  reason = length > PETSC_MAX_PATH_LEN - 16 ? strerror(ENAMETOOLONG) : PgSealGlance(file, PG_SEAL_CHECKPOINT, &info);
  if (reason) {
    if (all->named || LooksLikeOne(file)) Refuse(&all->refused, file, reason);
    free(file);
    return 1;
  }
  all->candidate[all->count++] = (Candidate){file, info.sealed};
  return 1;
}

/* What is hidden, and what a write has left that did not come to its end, is not meant. */
static PetscBool IsMeant(const char name[])
{
  const size_t length = strlen(name);

  return (PetscBool)(name[0] != '.' && !(length > 4 && !strcmp(name + length - 4, ".tmp")));
}

static const char *ListDirectory(const char where[], Candidates *all)
{
  DIR           *directory = opendir(where);
  struct dirent *entry;
  int            memory = 1;

  if (!directory) return strerror(errno);
  while (memory && (entry = readdir(directory)) != NULL)
    if (IsMeant(entry->d_name)) memory = Consider(all, where, entry->d_name);
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

/* The first of the candidates that is whole, or all that was refused. */
static const char *TakeLatest(Candidates *all, char file[PETSC_MAX_PATH_LEN], char remark[], size_t remark_size)
{
  static char words[sizeof all->refused.text + 96];
  Refused    *refused  = &all->refused;
  char        more[48] = "";
  PgSealInfo  info;

  file[0] = 0;
  if (all->count) qsort(all->candidate, all->count, sizeof *all->candidate, LaterFirst);
  for (size_t k = 0; k < all->count && !file[0]; k++) {
    const char *const name = all->candidate[k].file, *const reason = PgSealVerify(name, PG_SEAL_CHECKPOINT, &info);

    if (reason)
      Refuse(refused, name, reason);
    else
      (void)snprintf(file, PETSC_MAX_PATH_LEN, "%s", name);
  }
  if (!refused->count) return file[0] ? NULL : "there is no checkpoint";
  if (refused->left_out) (void)snprintf(more, sizeof more, "; and %d more", refused->left_out);
  if (file[0]) {
    (void)snprintf(remark, remark_size, "checkpoint passed over: %s%s", refused->text, more);
    return NULL;
  }
  (void)snprintf(words, sizeof words, "no checkpoint there is valid: %s%s", refused->text, more);
  return words;
}

static const char *FindAmongMany(const char where[], PetscBool directory, char file[PETSC_MAX_PATH_LEN], char remark[],
                                 size_t remark_size)
{
  Candidates  all    = {.named = (PetscBool)!directory};
  const char *reason = directory ? ListDirectory(where, &all) : ListPattern(where, &all);

  if (!reason) reason = TakeLatest(&all, file, remark, remark_size);
  for (size_t k = 0; k < all.count; k++) free(all.candidate[k].file);
  free(all.candidate);
  return reason;
}

const char *PgCheckpointFind(const char where[], char file[PETSC_MAX_PATH_LEN], char remark[], size_t remark_size)
{
  static char words[PETSC_MAX_PATH_LEN + 320];
  const char *reason, *before;
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
  before = PgSealVerify(file, PG_SEAL_CHECKPOINT, &info);
  if (before) {
    if (stat(file, &found)) return reason;
    (void)snprintf(words, sizeof words, "%s; the one before it, '%s': %s", reason, file, before);
    return words;
  }
  (void)snprintf(remark, remark_size, "checkpoint '%s': %s; the one before it, '%s', is taken", where, reason, file);
  return NULL;
}
