/* The HDF5 file of tables: /provenance, and for each table /<name>/<row> with the columns as attributes and the
   history as dataset. Small, and the same on all ranks, so rank 0 writes it alone. It is opened for each row, so that
   a program that is stopped leaves a complete file. */
#include "tableimpl.h"
#include <math.h>
#include <stdio.h>

/* Ends the use of the file: 0, or the code of the first failure and what it was. */
static PetscErrorCode Shut(PgHdf *hdf, const char option[], char trouble[], size_t length)
{
  PgHdfShut(hdf);
  if (!hdf->failed) return 0;
  (void)snprintf(trouble, length, "%s%scannot write %s%s%s", option, option[0] ? ": " : "", hdf->file,
                 hdf->disk.error ? ": " : "", hdf->disk.error ? strerror(hdf->disk.error) : "");
  return hdf->code;
}

static herr_t Attribute(hid_t object, const char name[], hid_t type, const void *value)
{
  const hid_t  space = H5Screate(H5S_SCALAR), at = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  const herr_t status = at < 0 ? -1 : H5Awrite(at, type, value);

  if (at >= 0) (void)H5Aclose(at);
  (void)H5Sclose(space);
  return status;
}

static herr_t Text(hid_t object, const char name[], const char value[])
{
  const hid_t  type = H5Tcopy(H5T_C_S1);
  const size_t n    = strlen(value);
  herr_t       status;

  (void)H5Tset_size(type, n ? n : 1); /* HDF5 has no empty strings of fixed length */
  (void)H5Tset_cset(type, H5T_CSET_UTF8);
  (void)H5Tset_strpad(type, H5T_STR_NULLPAD);
  status = Attribute(object, name, type, value);
  (void)H5Tclose(type);
  return status;
}

/* The options, as much of them as fits into an attribute of an old file format. */
static herr_t Provenance(hid_t file, const char *options, PetscMPIInt ranks)
{
  const hid_t group      = H5Gcreate2(file, "/provenance", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  char        petsc[256] = "", *all = NULL;
  herr_t      status;

  if (group < 0) return -1;
  (void)PetscGetVersion(petsc, sizeof petsc);
  status = Text(group, "version", "porograin " PG_VERSION);
  if (status >= 0) status = Text(group, "petsc", petsc);
  if (status >= 0) status = Attribute(group, "ranks", H5T_NATIVE_INT, &ranks);
  (void)PetscMalloc1(32768, &all);
  if (all) {
    (void)PetscStrncpy(all, options ? options : "", 32768);
    if (status >= 0) status = Text(group, "options", all);
    (void)PetscFree(all);
  }
  (void)H5Gclose(group);
  return status;
}

PetscErrorCode PgTableHdfCreate(const PgTableFiles *files, const char file[], const char *options, PetscMPIInt ranks,
                                char trouble[], size_t length)
{
  PgHdf hdf;
  char  option[128];

  (void)snprintf(option, sizeof option, "option %s", files->option);
  if (PgHdfCreate(PETSC_COMM_SELF, file, H5F_LIBVER_EARLIEST, &hdf)) return PETSC_ERR_FILE_OPEN;
  if (!hdf.failed) {
    option[0] = '\0'; /* the name was good */
    PgHdfWatch(&hdf, "write", "/provenance", Provenance(hdf.id, options, ranks));
  }
  return Shut(&hdf, option, trouble, length);
}

static herr_t History(hid_t group, PetscInt n, const PetscReal history[], const char unit[], const char description[])
{
  const hsize_t size   = (hsize_t)n;
  const hid_t   space  = H5Screate_simple(1, &size, NULL);
  const hid_t   set    = H5Dcreate2(group, "history", PG_HDF_REAL, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  herr_t        status = set < 0 ? -1 : H5Dwrite(set, PG_HDF_REAL, H5S_ALL, H5S_ALL, H5P_DEFAULT, history);

  if (status >= 0) status = Text(set, "unit", unit);
  if (status >= 0) status = Text(set, "description", description);
  if (set >= 0) (void)H5Dclose(set);
  (void)H5Sclose(space);
  return status;
}

static hid_t OpenGroup(hid_t file, PgTable t)
{
  char  name[128];
  hid_t group;

  (void)snprintf(name, sizeof name, "/%s", t->name);
  group = H5Lexists(file, name, H5P_DEFAULT) > 0 ? H5Gopen2(file, name, H5P_DEFAULT)
                                                 : H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  if (group < 0) return group;
  if (t->rows == 0) { /* what the attributes of the rows mean */
    for (PetscInt c = 0; c < t->columns; c++) {
      char text[320];
      (void)snprintf(text, sizeof text, "%s%s%s%s", t->column[c].description, t->column[c].unit ? " [" : "",
                     t->column[c].unit ? t->column[c].unit : "", t->column[c].unit ? "]" : "");
      (void)Text(group, t->column[c].name, text);
    }
  }
  return group;
}

PetscErrorCode PgTableHdfRow(PgTable t, const char file[], PetscInt n, const PetscReal history[], const char unit[],
                             const char description[], char trouble[], size_t length)
{
  char  name[32];
  PgHdf hdf;
  hid_t group = -1, row = -1;

  if (PgHdfOpen(PETSC_COMM_SELF, file, &hdf)) return PETSC_ERR_FILE_WRITE;
  (void)snprintf(name, sizeof name, "%03" PetscInt_FMT, t->rows);
  if (!hdf.failed) group = PgHdfWatch(&hdf, "open group", t->name, OpenGroup(hdf.id, t));
  if (group >= 0)
    row = PgHdfWatch(&hdf, "create group", name, H5Gcreate2(group, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  if (row >= 0) {
    herr_t status = 0;
    for (PetscInt c = 0; c < t->columns && status >= 0; c++) {
      if (!t->column[c].unit)
        status = Text(row, t->column[c].name, t->cell[c].text);
      else if (!isnan(t->cell[c].value))
        status = Attribute(row, t->column[c].name, PG_HDF_REAL, &t->cell[c].value);
    }
    if (status >= 0 && n > 0) status = History(row, n, history, unit, description);
    PgHdfWatch(&hdf, "write row", name, status);
    (void)H5Gclose(row);
  }
  if (group >= 0) (void)H5Gclose(group);
  return Shut(&hdf, "", trouble, length);
}
