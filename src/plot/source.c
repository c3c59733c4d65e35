/* Files to be plotted. Datasets are read by the room io; here is what it does not tell: which kind of file it is,
   what there is in it, and the rows of studies. */
#include "plotimpl.h"
#include <hdf5.h>

#if defined(PETSC_USE_REAL_SINGLE)
  #define REAL_TYPE H5T_NATIVE_FLOAT
#else
  #define REAL_TYPE H5T_NATIVE_DOUBLE
#endif

/* HDF5 prints pages of its own about what is not there; negative when the file cannot be opened. */
static hid_t OpenQuietly(const char file[])
{
  if (PgWhyNotFile(file, NULL)) return H5I_INVALID_HID;
  (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  return H5Fopen(file, H5F_ACC_RDONLY, H5P_DEFAULT);
}

/* HDF5 wants each part of the path to be there. */
static PetscBool Exists(hid_t file, const char object[])
{
  char part[PETSC_MAX_PATH_LEN];

  for (const char *c = object + 1;; c++) {
    if (*c != '/' && *c) continue;
    (void)snprintf(part, sizeof part, "%.*s", (int)(c - object), object);
    if (H5Lexists(file, part, H5P_DEFAULT) <= 0) return PETSC_FALSE;
    if (!*c) return PETSC_TRUE;
  }
}

PetscErrorCode PgPlotSourceHas(const PgPlotSource *source, const char object[], PetscBool *has)
{
  const hid_t file = OpenQuietly(source->file);

  PetscFunctionBeginUser;
  *has = (PetscBool)(file >= 0 && Exists(file, object));
  if (file >= 0) (void)H5Fclose(file);
  PetscFunctionReturn(0);
}

/* Name of the file without its directory and .h5; for file names with nothing that a shell or gnuplot reads. */
static void Name(PgPlotSource *source)
{
  const char *slash = strrchr(source->file, '/');
  size_t      n;

  (void)snprintf(source->label, sizeof source->label, "%.120s", slash ? slash + 1 : source->file);
  n = strlen(source->label);
  if (n > 3 && !strcmp(source->label + n - 3, ".h5")) source->label[n - 3] = '\0';
  (void)snprintf(source->stem, sizeof source->stem, "%s", source->label);
  for (char *c = source->stem; *c; c++)
    if (!strchr("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-", *c) ||
        (c == source->stem && (*c == '.' || *c == '-')))
      *c = '_';
}

static PetscErrorCode ReadTimes(PgPlotSource *source)
{
  PetscReal count;

  PetscFunctionBeginUser;
  PetscCall(PgResultReadAttribute(PETSC_COMM_SELF, source->file, "/snapshots", "count", &count));
  source->snapshots = (PetscInt)count;
  PetscCall(PetscMalloc1(source->snapshots + 1, &source->time));
  for (PetscInt s = 0; s < source->snapshots; s++) {
    char group[64];
    PetscCall(PetscSNPrintf(group, sizeof group, "/snapshots/%06" PetscInt_FMT, s));
    PetscCall(PgResultReadAttribute(PETSC_COMM_SELF, source->file, group, "time", &source->time[s]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotSourceOpen(MPI_Comm comm, const char file[], PgPlotSource *source)
{
  PetscBool result, study, restart;
  hid_t     id;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(source, sizeof *source));
  PetscCall(PetscStrncpy(source->file, file, sizeof source->file));
  Name(source);
  id = OpenQuietly(file);
  if (id < 0) { /* the room io says why */
    PetscReal unused;
    PetscCall(PgResultReadAttribute(PETSC_COMM_SELF, file, "/snapshots", "count", &unused));
    PgInputError(comm, "result file '%s': cannot open the file", file);
  }
  result  = Exists(id, "/snapshots");
  study   = (PetscBool)(Exists(id, "/study") || Exists(id, "/cost"));
  restart = (PetscBool)(Exists(id, "/fields") || Exists(id, "/state"));
  (void)H5Fclose(id);
  PgInputCheck(result || study, comm, "'%s' is %s: it has neither /snapshots nor /study", file,
               restart ? "a checkpoint, not a result" : "not a result of porograin or porograin-study");
  source->study = (PetscBool)!result;
  if (result) PetscCall(ReadTimes(source));
  if (result) PetscCall(PgPlotMeshOpen(source));
  if (result) PetscCall(PgPlotSourceHas(source, "/snapshots/000000/kind", &source->liquid));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotSourceClose(PgPlotSource *source)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(source->time));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotSourceSnapshot(const PgPlotSource *source, PetscInt snapshot, const char dataset[],
                                    PetscInt columns, PetscInt *rows, PetscReal **value)
{
  char     path[256];
  PetscInt r, c;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof path, "/snapshots/%06" PetscInt_FMT "/%s", snapshot, dataset));
  PetscCall(PgResultRead(PETSC_COMM_SELF, source->file, path, &r, &c, value));
  if ((*rows >= 0 && r != *rows) || c != columns) {
    PetscCall(PetscFree(*value));
    PetscCall(PgReport(PETSC_COMM_SELF,
                       "result file '%s': dataset '%s' has %" PetscInt_FMT " x %" PetscInt_FMT
                       " values, not what belongs to its discs",
                       source->file, path, r, c));
    PetscFunctionReturn(PETSC_ERR_FILE_UNEXPECTED);
  }
  *rows = r;
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotSourceHistory(const PgPlotSource *source, const char column[], PetscInt *rows, PetscReal **value)
{
  char      path[256];
  PetscBool has;
  PetscInt  columns;

  PetscFunctionBeginUser;
  *rows  = 0;
  *value = NULL;
  PetscCall(PetscSNPrintf(path, sizeof path, "/history/%s", column));
  PetscCall(PgPlotSourceHas(source, path, &has));
  if (has) PetscCall(PgResultRead(PETSC_COMM_SELF, source->file, path, rows, &columns, value));
  PetscFunctionReturn(0);
}

/* ---- studies ---- */

PetscErrorCode PgPlotSourceRows(const PgPlotSource *source, const char table[], PetscInt *rows)
{
  const hid_t file = OpenQuietly(source->file);
  char        path[256];

  PetscFunctionBeginUser;
  *rows = 0;
  for (PetscBool more = (PetscBool)(file >= 0); more; *rows += more) {
    PetscCall(PetscSNPrintf(path, sizeof path, "/%s/%03" PetscInt_FMT, table, *rows));
    more = Exists(file, path);
  }
  if (file >= 0) (void)H5Fclose(file);
  PetscFunctionReturn(0);
}

static hid_t OpenAttribute(hid_t file, const char object[], const char name[])
{
  if (file < 0 || !Exists(file, object)) return -1;
  if (H5Aexists_by_name(file, object, name, H5P_DEFAULT) <= 0) return -1;
  return H5Aopen_by_name(file, object, name, H5P_DEFAULT, H5P_DEFAULT);
}

PetscErrorCode PgPlotSourceReal(const PgPlotSource *source, const char table[], PetscInt row, const char column[],
                                PetscReal *value)
{
  const hid_t file = OpenQuietly(source->file);
  hid_t       attribute, type, space;
  char        path[256];

  PetscFunctionBeginUser;
  *value = (PetscReal)NAN;
  PetscCall(PetscSNPrintf(path, sizeof path, "/%s/%03" PetscInt_FMT, table, row));
  attribute = OpenAttribute(file, path, column);
  if (attribute >= 0) {
    type  = H5Aget_type(attribute);
    space = H5Aget_space(attribute);
    if (H5Tget_class(type) != H5T_STRING && H5Sget_simple_extent_npoints(space) == 1)
      if (H5Aread(attribute, REAL_TYPE, value) < 0) *value = (PetscReal)NAN;
    (void)H5Sclose(space);
    (void)H5Tclose(type);
    (void)H5Aclose(attribute);
  }
  if (file >= 0) (void)H5Fclose(file);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadText(const char file[], const char object[], const char name[], PgPlotText text)
{
  const hid_t id        = OpenQuietly(file);
  const hid_t attribute = OpenAttribute(id, object, name);
  hid_t       type;

  PetscFunctionBeginUser;
  text[0] = '\0';
  if (attribute >= 0) {
    type = H5Aget_type(attribute);
    if (H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) <= 0) {
      const hid_t memory = H5Tcopy(H5T_C_S1);
      (void)H5Tset_size(memory, PG_PLOT_TEXT); /* cuts off what is longer, and ends it */
      (void)H5Tset_cset(memory, H5Tget_cset(type));
      if (H5Aread(attribute, memory, text) < 0) text[0] = '\0';
      text[PG_PLOT_TEXT - 1] = '\0';
      (void)H5Tclose(memory);
    }
    (void)H5Tclose(type);
    (void)H5Aclose(attribute);
  }
  if (id >= 0) (void)H5Fclose(id);
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotSourceText(const PgPlotSource *source, const char table[], PetscInt row, const char column[],
                                PgPlotText text)
{
  char path[256];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof path, "/%s/%03" PetscInt_FMT, table, row));
  PetscCall(ReadText(source->file, path, column, text));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotSourceColumn(const PgPlotSource *source, const char table[], const char column[], PgPlotText text)
{
  char path[256];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof path, "/%s", table));
  PetscCall(ReadText(source->file, path, column, text));
  PetscFunctionReturn(0);
}
