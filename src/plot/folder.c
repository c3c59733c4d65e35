/* The folder in which figures are made before they get their names: all of them appear, or none. */
#include "plotimpl.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static PetscErrorCode Add(PgNames *names, const char name[])
{
  PetscFunctionBeginUser;
  if (names->count == names->room) {
    const PetscInt room = names->room ? 2 * names->room : 16;
    char         **more;
    PetscCall(PetscMalloc1(room, &more));
    for (PetscInt i = 0; i < names->count; i++) more[i] = names->item[i];
    PetscCall(PetscFree(names->item));
    names->item = more;
    names->room = room;
  }
  PetscCall(PetscStrallocpy(name, &names->item[names->count]));
  names->count++;
  PetscFunctionReturn(0);
}

static PetscErrorCode Forget(PgNames *names)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < names->count; i++) PetscCall(PetscFree(names->item[i]));
  PetscCall(PetscFree(names->item));
  names->count = names->room = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotFolderAddScript(PgPlotFolder *folder, const char name[])
{
  PetscFunctionBeginUser;
  PetscCall(Add(&folder->scripts, name));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotFolderAddPicture(PgPlotFolder *folder, const char name[])
{
  PetscFunctionBeginUser;
  PetscCall(Add(&folder->pictures, name));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotFolderOpen(MPI_Comm comm, const char directory[], PgPlotFolder *folder)
{
  struct stat status;
  char        reason[256] = "";

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(folder, sizeof *folder));
  folder->comm = comm;
  PetscCall(PetscStrncpy(folder->final, directory, sizeof folder->final));
  if (mkdir(directory, 0777) == 0)
    folder->made = PETSC_TRUE;
  else if (errno != EEXIST)
    (void)snprintf(reason, sizeof reason, "cannot make it: %s", strerror(errno));
  else if (stat(directory, &status) == 0 && !S_ISDIR(status.st_mode))
    (void)snprintf(reason, sizeof reason, "it is there, and not a directory");
  if (!reason[0]) {
    PetscCall(PetscSNPrintf(folder->work, sizeof folder->work, "%s/.unfinished-XXXXXX", directory));
    if (!mkdtemp(folder->work)) {
      (void)snprintf(reason, sizeof reason, "cannot write there: %s", strerror(errno));
      if (folder->made) (void)rmdir(folder->final);
      folder->work[0] = '\0';
    }
  }
  if (reason[0]) {
    PetscCall(PgReport(comm, "option -figures: directory '%s': %s", directory, reason));
    return PETSC_ERR_FILE_OPEN;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotFolderCreateFile(PgPlotFolder *folder, const char name[], FILE **file)
{
  char path[2 * PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/%s", folder->work, name));
  *file = fopen(path, "w");
  if (!*file) {
    PetscCall(PgReport(folder->comm, "cannot write '%s/%s': %s", folder->final, name, strerror(errno)));
    PetscFunctionReturn(PETSC_ERR_FILE_WRITE);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotFolderCloseFile(PgPlotFolder *folder, const char name[], FILE **file)
{
  const int failed = ferror(*file), closed = fclose(*file);

  PetscFunctionBeginUser;
  *file = NULL;
  if (failed || closed) {
    PetscCall(PgReport(folder->comm, "cannot write '%s/%s': %s", folder->final, name, strerror(errno)));
    PetscFunctionReturn(PETSC_ERR_FILE_WRITE);
  }
  PetscFunctionReturn(0);
}

/* 127: there is no such program. */
static int RunIn(const char directory[], const char program[], char *script)
{
  int         status = 0;
  char       *word[] = {NULL, script, NULL};
  char        name[PETSC_MAX_PATH_LEN];
  const pid_t child = (word[0] = name, (void)snprintf(name, sizeof name, "%s", program), fork());

  if (child < 0) return 126;
  if (child == 0) {
    const int null = open("/dev/null", O_RDWR);
    if (null >= 0) {
      (void)dup2(null, 0);
      (void)dup2(null, 1);
    }
    if (chdir(directory)) _exit(126);
    /* the scripts are in UTF-8; in another locale gnuplot warns of each */
    (void)setenv("LC_ALL", "C.UTF-8", 1);
    (void)execvp(name, word);
    _exit(errno == ENOENT ? 127 : 126);
  }
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return 126;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

PetscErrorCode PgPlotFolderDraw(PgPlotFolder *folder, const char program[], PetscBool *drawn)
{
  struct stat status;
  char        path[2 * PETSC_MAX_PATH_LEN], absolute[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  *drawn = PETSC_FALSE;
  /* It runs in another directory: a relative path to the program would lead nowhere. */
  if (strchr(program, '/') && realpath(program, absolute)) program = absolute;
  for (PetscInt i = 0; i < folder->scripts.count; i++) {
    const int exit = RunIn(folder->work, program, folder->scripts.item[i]);
    if (exit == 127) PetscFunctionReturn(0);
    if (exit) {
      PetscCall(PgReport(folder->comm, "%s failed on %s (status %d); what it said stands above", program,
                         folder->scripts.item[i], exit));
      PetscFunctionReturn(PETSC_ERR_FILE_WRITE);
    }
  }
  for (PetscInt i = 0; i < folder->pictures.count; i++) {
    PetscCall(PetscSNPrintf(path, sizeof path, "%s/%s", folder->work, folder->pictures.item[i]));
    if (stat(path, &status) || status.st_size == 0) {
      PetscCall(PgReport(folder->comm, "%s made no picture %s", program, folder->pictures.item[i]));
      PetscFunctionReturn(PETSC_ERR_FILE_WRITE);
    }
  }
  *drawn = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Names of all files in the working folder, so that what gnuplot made beside is kept too. */
static PetscErrorCode List(PgPlotFolder *folder, PgNames *names)
{
  DIR           *directory;
  struct dirent *entry;

  PetscFunctionBeginUser;
  directory = opendir(folder->work);
  while (directory && (entry = readdir(directory)))
    if (strcmp(entry->d_name, ".") && strcmp(entry->d_name, "..")) PetscCall(Add(names, entry->d_name));
  if (directory) (void)closedir(directory);
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotFolderKeep(PgPlotFolder *folder, PetscInt *files)
{
  PgNames        names = {NULL, 0, 0};
  char           from[2 * PETSC_MAX_PATH_LEN], to[2 * PETSC_MAX_PATH_LEN];
  PetscErrorCode code = 0;

  PetscFunctionBeginUser;
  PetscCall(List(folder, &names));
  for (PetscInt i = 0; i < names.count && !code; i++) {
    PetscCall(PetscSNPrintf(from, sizeof from, "%s/%s", folder->work, names.item[i]));
    PetscCall(PetscSNPrintf(to, sizeof to, "%s/%s", folder->final, names.item[i]));
    if (rename(from, to) == 0) continue;
    PetscCall(PgReport(folder->comm, "cannot write '%s': %s", to, strerror(errno)));
    code = PETSC_ERR_FILE_WRITE;
  }
  *files = names.count;
  if (names.count) folder->made = PETSC_FALSE;
  PetscCall(Forget(&names));
  PetscFunctionReturn(code);
}

PetscErrorCode PgPlotFolderClose(PgPlotFolder *folder)
{
  PgNames names = {NULL, 0, 0};
  char    path[2 * PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  if (folder->work[0]) {
    PetscCall(List(folder, &names));
    for (PetscInt i = 0; i < names.count; i++) {
      PetscCall(PetscSNPrintf(path, sizeof path, "%s/%s", folder->work, names.item[i]));
      (void)unlink(path);
    }
    (void)rmdir(folder->work);
    if (folder->made) (void)rmdir(folder->final);
    folder->work[0] = '\0';
    PetscCall(Forget(&names));
  }
  PetscCall(Forget(&folder->scripts));
  PetscCall(Forget(&folder->pictures));
  PetscFunctionReturn(0);
}
