/* Tables: a row goes to the screen, to the CSV file and to the HDF5 file when it is complete. */
#include "tableimpl.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* A failure of rank 0 ends all ranks with one message. */
static PetscErrorCode Share(MPI_Comm comm, PetscErrorCode code, const char trouble[])
{
  int all = (int)code;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&all, 1, MPI_INT, 0, comm));
  if (all) PetscCall(PgReport(comm, "%s", trouble));
  PetscFunctionReturn((PetscErrorCode)all);
}

static PetscErrorCode Name(const PgTableFiles *files, const char suffix[], char name[], size_t length)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, length, "%s%s", files->base, suffix));
  PetscFunctionReturn(0);
}

/* Removes an ending that the user gave, and makes the HDF5 file. */
static PetscErrorCode CreateFiles(PgTableFiles *files)
{
  char           trouble[PETSC_MAX_PATH_LEN + 256] = "", name[PETSC_MAX_PATH_LEN + 16], *dot;
  char          *options                           = NULL;
  PetscMPIInt    rank, size;
  PetscErrorCode code = 0;

  PetscFunctionBeginUser;
  files->created = PETSC_TRUE;
  dot            = strrchr(files->base, '.');
  if (dot && (!strcmp(dot, ".csv") || !strcmp(dot, ".h5"))) *dot = '\0';
  PetscCall(Name(files, ".h5", name, sizeof name));
  PetscCallMPI(MPI_Comm_rank(files->comm, &rank));
  PetscCallMPI(MPI_Comm_size(files->comm, &size));
  PetscCall(PetscOptionsGetAll(NULL, &options));
  if (rank == 0) code = PgTableHdfCreate(files, name, options, size, trouble, sizeof trouble);
  PetscCall(PetscFree(options));
  PetscCall(Share(files->comm, code, trouble));
  PetscFunctionReturn(0);
}

static PetscErrorCode OpenCsv(PgTable t)
{
  char           trouble[PETSC_MAX_PATH_LEN + 256] = "", name[PETSC_MAX_PATH_LEN + 64], suffix[48];
  PetscMPIInt    rank;
  PetscErrorCode code = 0;
  PetscBool      first;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(t->comm, &rank));
  PetscCall(PetscStrcmp(t->name, "study", &first));
  PetscCall(PetscSNPrintf(suffix, sizeof suffix, "%s%s.csv", first ? "" : "-", first ? "" : t->name));
  PetscCall(Name(t->files, suffix, name, sizeof name));
  if (rank == 0) {
    t->csv = fopen(name, "w");
    if (!t->csv) {
      code = PETSC_ERR_FILE_OPEN;
      PetscCall(PetscSNPrintf(trouble, sizeof trouble, "option %s: cannot write %s", t->files->option, name));
    }
  }
  PetscCall(Share(t->comm, code, trouble));
  if (!t->csv) PetscFunctionReturn(0);
  for (PetscInt c = 0; c < t->columns; c++) {
    const PgTableColumn *k = &t->column[c];
    (void)fprintf(t->csv, "%s%s", c ? "," : "", k->name);
    if (k->unit) (void)fprintf(t->csv, " [%s]", k->unit);
  }
  (void)fprintf(t->csv, "\n");
  PetscFunctionReturn(0);
}

PetscErrorCode PgTableFilesFromOutput(MPI_Comm comm, const char output[], PgTableFiles *files)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(files, sizeof *files));
  files->comm   = comm;
  files->option = "-output";
  if (output[0]) PetscCall(PgOutputCheckName(comm, output));
  PetscCall(PetscStrncpy(files->base, output, sizeof files->base));
  PetscFunctionReturn(0);
}

static void Clear(PgTable t)
{
  for (PetscInt c = 0; c < t->columns; c++) {
    t->cell[c].value   = PG_TABLE_EMPTY;
    t->cell[c].text[0] = '\0';
  }
}

PetscErrorCode PgTableCreate(PgTableFiles *files, const char name[], PetscInt columns, const PgTableColumn column[],
                             PgTable *table)
{
  PgTable t;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&t));
  t->comm    = files->comm;
  t->files   = files;
  t->name    = name;
  t->columns = columns;
  t->column  = column;
  *table     = t;
  PetscCall(PetscMalloc1(columns, &t->cell));
  Clear(t);
  if (!files->base[0]) PetscFunctionReturn(0);
  if (!files->created) PetscCall(CreateFiles(files));
  PetscCall(OpenCsv(t));
  PetscFunctionReturn(0);
}

void PgTableReal(PgTable t, PetscInt column, PetscReal value) { t->cell[column].value = value; }

void PgTableText(PgTable t, PetscInt column, const char format[], ...)
{
  va_list arguments;
  size_t  length;

  va_start(arguments, format);
  (void)PetscVSNPrintf(t->cell[column].text, sizeof t->cell[column].text, format, &length, arguments);
  va_end(arguments);
}

static PetscErrorCode PrintHead(PgTable t)
{
  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < t->columns; c++) {
    const PgTableColumn *k = &t->column[c];
    if (k->head) PetscCall(PetscPrintf(t->comm, k->unit ? "%s%*s" : "%s%-*s", c ? "  " : "", k->width, k->head));
  }
  PetscCall(PetscPrintf(t->comm, "\n"));
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintRow(PgTable t)
{
  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < t->columns; c++) {
    const PgTableColumn *k          = &t->column[c];
    char                 number[64] = "-";
    if (!k->head) continue;
    if (!k->unit) {
      PetscCall(PetscPrintf(t->comm, "%s%-*s", c ? "  " : "", k->width, t->cell[c].text));
      continue;
    }
    if (!isnan(t->cell[c].value)) PetscCall(PetscSNPrintf(number, sizeof number, k->format, (double)t->cell[c].value));
    PetscCall(PetscPrintf(t->comm, "%s%*s", c ? "  " : "", k->width, number));
  }
  PetscCall(PetscPrintf(t->comm, "\n"));
  (void)fflush(stdout);
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteCsv(PgTable t, char trouble[], size_t length)
{
  for (PetscInt c = 0; c < t->columns; c++) {
    if (c) (void)fputc(',', t->csv);
    if (t->column[c].unit) {
      if (!isnan(t->cell[c].value)) (void)fprintf(t->csv, "%.12g", (double)t->cell[c].value);
    } else {
      const PetscBool quoted = (PetscBool)(strpbrk(t->cell[c].text, ",\"") != NULL);
      if (quoted) (void)fputc('"', t->csv);
      for (const char *s = t->cell[c].text; *s; s++) {
        if (*s == '"') (void)fputc('"', t->csv);
        (void)fputc(*s, t->csv);
      }
      if (quoted) (void)fputc('"', t->csv);
    }
  }
  (void)fputc('\n', t->csv);
  if (!fflush(t->csv) && !ferror(t->csv)) return 0;
  (void)snprintf(trouble, length, "cannot write the CSV file of %s", t->files->base);
  return PETSC_ERR_FILE_WRITE;
}

PetscErrorCode PgTableEndRow(PgTable t, PetscInt n, const PetscReal history[], const char unit[],
                             const char description[])
{
  char           trouble[PETSC_MAX_PATH_LEN + 256] = "", name[PETSC_MAX_PATH_LEN + 16];
  PetscMPIInt    rank;
  PetscErrorCode code = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(t->comm, &rank));
  if (t->rows == 0) PetscCall(PrintHead(t));
  PetscCall(PrintRow(t));
  if (t->files->base[0]) {
    PetscCall(Name(t->files, ".h5", name, sizeof name));
    if (rank == 0) {
      code = WriteCsv(t, trouble, sizeof trouble);
      if (!code) code = PgTableHdfRow(t, name, n, history, unit, description, trouble, sizeof trouble);
    }
    PetscCall(Share(t->comm, code, trouble));
  }
  t->rows++;
  Clear(t);
  PetscFunctionReturn(0);
}

PetscErrorCode PgTableDestroy(PgTable *table)
{
  PgTable t = *table;

  PetscFunctionBeginUser;
  if (!t) PetscFunctionReturn(0);
  if (t->csv) (void)fclose(t->csv);
  PetscCall(PetscFree(t->cell));
  PetscCall(PetscFree(*table));
  PetscFunctionReturn(0);
}
