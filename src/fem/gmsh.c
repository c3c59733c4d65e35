/* Meshes of Gmsh. PETSc reads them; what is done here is to look first, on one rank, so that a file that is none is an
   error of all ranks with the file's name in it, and to read the names of physical groups: PETSc 3.18 cuts off their
   last letter, and takes a curve and a surface of the same number for one. */
#include "femimpl.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LINE = 4096, REASON = 512 };

/* "dimension tag "name"" */
static PetscBool ReadGroup(const char line[], PgFemGroup *group)
{
  const char *from = strchr(line, '"'), *to = from ? strrchr(line, '"') : NULL;
  char       *end;

  if (!from || to == from || to - from - 1 >= PG_FEM_NAME || to - from == 1) return PETSC_FALSE;
  group->dimension = (PetscInt)strtol(line, &end, 10);
  if (end == line || *end != ' ' || group->dimension < 0 || group->dimension > 3) return PETSC_FALSE;
  line       = end;
  group->tag = (PetscInt)strtol(line, &end, 10);
  if (end == line || *end != ' ' || group->tag <= 0 || end + strspn(end, " ") != from) return PETSC_FALSE;
  if (to[1 + strspn(to + 1, " \t\r\n")]) return PETSC_FALSE;
  (void)snprintf(group->name, PG_FEM_NAME, "%.*s", (int)(to - from - 1), from + 1);
  return PETSC_TRUE;
}

/* Rank 0: the names of the file; reason stays empty when all went well, *opened tells a file that is bad from none. */
static PetscErrorCode ReadGroups(const char file[], PetscInt *groups, PgFemGroup **group, char reason[REASON],
                                 PetscBool *opened)
{
  char        line[LINE];
  const char *why    = PgWhyNotFile(file, NULL);
  FILE       *stream = why ? NULL : fopen(file, "rb");
  long        said   = 0;

  PetscFunctionBeginUser;
  *groups = 0;
  *group  = NULL;
  *opened = (PetscBool)(stream != NULL);
  if (!stream) {
    (void)snprintf(reason, REASON, "%s", why ? why : strerror(errno));
    PetscFunctionReturn(0);
  }
  if (!fgets(line, sizeof line, stream) || strncmp(line, "$MeshFormat", 11) != 0)
    (void)snprintf(reason, REASON, "it does not begin with $MeshFormat: not a mesh of Gmsh");
  while (!reason[0] && fgets(line, sizeof line, stream) && strncmp(line, "$PhysicalNames", 14) != 0)
    ;
  if (!reason[0] && !feof(stream) && fgets(line, sizeof line, stream)) {
    said = strtol(line, NULL, 10);
    if (said < 0 || said > 100000) (void)snprintf(reason, REASON, "it says that it has %ld physical names", said);
  }
  if (!reason[0]) PetscCall(PetscCalloc1(said, group));
  while (!reason[0] && *groups < said) {
    if (!fgets(line, sizeof line, stream) || !ReadGroup(line, *group + *groups))
      (void)snprintf(reason, REASON,
                     "physical name %ld of %ld: not a dimension, a number and a name of 1 to %d letters",
                     (long)*groups + 1, said, PG_FEM_NAME - 1);
    else
      (*groups)++;
  }
  (void)fclose(stream);
  PetscFunctionReturn(0);
}

/* Keeps the first words of an error that PETSc finds in the file. */
static PetscErrorCode Keep(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                           PetscErrorType type, const char *text, void *reason)
{
  (void)comm;
  (void)line;
  (void)function;
  (void)file;
  if (type == PETSC_ERROR_INITIAL) (void)snprintf((char *)reason, REASON, "%s", text ? text : "PETSc cannot read it");
  return code;
}

/* Rank 0: whether PETSc reads it, and finds what we can use. */
static PetscErrorCode Try(const char file[], char reason[REASON])
{
  DM             dm = NULL;
  PetscErrorCode err;
  PetscInt       dimension, start, end;
  Vec            coordinates;
  PetscSection   section;

  PetscFunctionBeginUser;
  PetscCall(PetscPushErrorHandler(Keep, reason));
  err = DMPlexCreateGmshFromFile(PETSC_COMM_SELF, file, PETSC_TRUE, &dm);
  PetscCall(PetscPopErrorHandler());
  if (err) {
    if (!reason[0]) (void)snprintf(reason, REASON, "PETSc cannot read it");
    PetscFunctionReturn(0);
  }
  PetscCall(DMGetDimension(dm, &dimension));
  PetscCall(DMPlexGetHeightStratum(dm, 0, &start, &end));
  if (dimension != 2)
    (void)snprintf(reason, REASON, "its cells have %d dimensions, not 2", (int)dimension);
  else if (start == end)
    (void)snprintf(reason, REASON, "it has no cells");
  PetscCall(DMGetCoordinatesLocal(dm, &coordinates));
  PetscCall(DMGetCoordinateSection(dm, &section));
  if (!reason[0]) {
    PetscInt first, last, values;
    PetscCall(VecGetLocalSize(coordinates, &values));
    PetscCall(DMPlexGetDepthStratum(dm, 0, &first, &last));
    if (values != 2 * (last - first))
      (void)snprintf(reason, REASON, "its cells are curved: only cells of the first order are known here");
  }
  PetscCall(DMDestroy(&dm));
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemGmshRead(MPI_Comm comm, const char file[], DM *dm, PetscInt *groups, PgFemGroup **group)
{
  char        reason[REASON] = "";
  PetscBool   opened         = PETSC_TRUE;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  *groups = 0;
  *group  = NULL;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) PetscCall(ReadGroups(file, groups, group, reason, &opened));
  if (rank == 0 && !reason[0]) {
    PgFemGmsh mesh;
    PetscCall(PgFemGmshScan(file, &mesh, reason, sizeof reason));
    if (!reason[0]) PetscCall(PgFemGmshCheck(&mesh, reason, sizeof reason));
    PetscCall(PgFemGmshFree(&mesh));
  }
  if (rank == 0 && !reason[0]) PetscCall(Try(file, reason));
  PetscCallMPI(MPI_Bcast(reason, REASON, MPI_CHAR, 0, comm));
  PetscCallMPI(MPI_Bcast(&opened, 1, MPIU_BOOL, 0, comm));
  PetscCallMPI(MPI_Bcast(groups, 1, MPIU_INT, 0, comm));
  if (reason[0]) {
    PetscCall(PetscFree(*group));
    PetscCall(PgReport(comm, "mesh file '%s': %s", file, reason));
    return opened ? PETSC_ERR_USER_INPUT : PETSC_ERR_FILE_OPEN;
  }
  if (rank) PetscCall(PetscMalloc1(*groups, group));
  PetscCallMPI(MPI_Bcast(*group, (PetscMPIInt)(*groups * (PetscInt)sizeof **group), MPI_BYTE, 0, comm));
  PetscCall(DMPlexCreateGmshFromFile(comm, file, PETSC_TRUE, dm));
  PetscFunctionReturn(0);
}
