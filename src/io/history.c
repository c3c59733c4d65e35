/* The history: one row at a time into FILE.csv, in larger pieces into /history/<name>. */
#include "ioimpl.h"
#include <errno.h>

PetscErrorCode PgHistoryCreate(PgOutput output, PetscInt columns, const PgColumn column[])
{
  PetscFunctionBeginUser;
  PetscCheck(columns >= 0, output->comm, PETSC_ERR_ARG_OUTOFRANGE, "%" PetscInt_FMT " history columns", columns);
  PetscCall(PetscCalloc1(columns, &output->column));
  for (PetscInt c = 0; c < columns; c++) {
    PetscCheck(column[c].name[0] && !strpbrk(column[c].name, "/,\"\n") && !strpbrk(column[c].unit, ",\"\n"),
               output->comm, PETSC_ERR_ARG_WRONG, "history column '%s [%s]' would spoil the CSV header or the path",
               column[c].name, column[c].unit);
    output->columns = c + 1;
    PetscCall(PetscStrallocpy(column[c].name, (char **)&output->column[c].name));
    PetscCall(PetscStrallocpy(column[c].unit, (char **)&output->column[c].unit));
    PetscCall(PetscStrallocpy(column[c].description, (char **)&output->column[c].description));
  }
  if (output->rank == 0) PetscCall(PetscMalloc1(columns * PG_HISTORY_WAITING, &output->row));
  PetscFunctionReturn(0);
}

PetscErrorCode PgHistoryPath(PgOutput output, PetscInt c, char path[], size_t size)
{
  const int length = snprintf(path, size, "/history/%s", output->column[c].name);

  PetscFunctionBeginUser;
  PetscCheck(length > 0 && (size_t)length < size, output->comm, PETSC_ERR_ARG_WRONG, "history column name too long");
  PetscFunctionReturn(0);
}

PetscErrorCode PgHistoryCreateDatasets(PgOutput output, PgHdf *hdf)
{
  const hsize_t none = 0, chunk = PG_HISTORY_CHUNK;
  char          path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(PgHdfGroup(hdf, "/history"));
  for (PetscInt c = 0; c < output->columns; c++) {
    PetscCall(PgHistoryPath(output, c, path, sizeof path));
    PetscCall(
        PgHdfDataset(hdf, path, PG_HDF_REAL, 1, &none, chunk, output->column[c].unit, output->column[c].description));
  }
  PetscFunctionReturn(0);
}

PetscReal PgHistoryBytes(PgOutput output)
{
  const PetscReal rows = output->waiting ? (PetscReal)(output->waiting + PG_HISTORY_CHUNK) : 0;

  /* 4 KiB for the table of pieces of a column. */
  return (PetscReal)output->columns * (rows * (PetscReal)sizeof(PetscReal) + 4096);
}

PetscErrorCode PgHistoryAppend(PgOutput output, PgHdf *hdf)
{
  const PetscInt rows = output->written + output->waiting, count = output->rank == 0 ? output->waiting : 0;
  char           path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  if (!output->waiting) PetscFunctionReturn(0);
  for (PetscInt c = 0; c < output->columns; c++) {
    const PetscReal *data = output->rank == 0 ? output->row + c * PG_HISTORY_WAITING : NULL;
    PetscCall(PgHistoryPath(output, c, path, sizeof path));
    PetscCall(PgHdfWriteRows(hdf, path, PG_HDF_REAL, rows, output->written, count, data));
  }
  PetscFunctionReturn(0);
}

void PgHistoryAppendDone(PgOutput output)
{
  output->written += output->waiting;
  output->waiting = 0;
}

PetscErrorCode PgHistoryHeaderText(PgOutput output, PgText *line)
{
  PetscFunctionBeginUser;
  line->used = 0;
  for (PetscInt c = 0; c < output->columns; c++) {
    PetscCall(PgTextAppend(line, c ? "," : ""));
    PetscCall(PgTextAppend(line, output->column[c].name));
    PetscCall(PgTextAppend(line, " ["));
    PetscCall(PgTextAppend(line, output->column[c].unit));
    PetscCall(PgTextAppend(line, "]"));
  }
  PetscCall(PgTextAppend(line, "\n"));
  PetscFunctionReturn(0);
}

PetscErrorCode PgHistoryRowText(PgOutput output, PetscInt rows, PetscInt r, const PetscReal value[], PgText *line)
{
  PetscFunctionBeginUser;
  line->used = 0;
  for (PetscInt c = 0; c < output->columns; c++) {
    if (c) PetscCall(PgTextAppend(line, ","));
    PetscCall(PgTextReal(line, value[c * rows + r]));
  }
  PetscCall(PgTextAppend(line, "\n"));
  PetscFunctionReturn(0);
}

/* Rank 0: writes one line and hands it to the system; NULL or why not. */
static const char *WriteLine(FILE *stream, const char line[])
{
  errno = 0;
  if (fputs(line, stream) == EOF || fflush(stream) == EOF) return strerror(errno ? errno : EIO);
  return NULL;
}

/* Collective: `line` is that of rank 0. */
static PetscErrorCode WriteCsv(PgOutput output, PgText *line)
{
  PetscFunctionBeginUser;
  PetscCall(PgFileCheck(output->comm, PETSC_ERR_FILE_WRITE, "cannot write history file", output->csv,
                        output->rank ? NULL : WriteLine(output->csv_stream, line->string)));
  PetscFunctionReturn(0);
}

PetscErrorCode PgHistoryOpenCsv(PgOutput output)
{
  const char *reason = NULL;

  PetscFunctionBeginUser;
  if (output->rank == 0) {
    output->csv_stream = fopen(output->csv, "w");
    if (output->csv_stream)
      PgHistoryLock(output->csv_stream);
    else
      reason = strerror(errno);
    PetscCall(PgHistoryHeaderText(output, &output->line));
  }
  PetscCall(PgFileCheck(output->comm, PETSC_ERR_FILE_OPEN, "cannot open history file", output->csv, reason));
  PetscCall(WriteCsv(output, &output->line));
  PetscFunctionReturn(0);
}

PetscErrorCode PgHistoryCloseCsv(PgOutput output)
{
  const char *reason = NULL;

  PetscFunctionBeginUser;
  if (output->csv_stream && fclose(output->csv_stream) == EOF) reason = strerror(errno);
  output->csv_stream = NULL;
  PetscCall(PgFileCheck(output->comm, PETSC_ERR_FILE_WRITE, "cannot close history file", output->csv, reason));
  PetscFunctionReturn(0);
}

PetscErrorCode PgOutputFlush(PgOutput output)
{
  PgHdf hdf;

  PetscFunctionBeginUser;
  if (!output->waiting) PetscFunctionReturn(0);
  PetscCall(PgOutputOpen(output, PgHistoryBytes(output), &hdf));
  PetscCall(PgHistoryAppend(output, &hdf));
  PetscCall(PgHdfFlush(&hdf));
  PetscCall(PgOutputClose(output, &hdf));
  PgHistoryAppendDone(output);
  PetscFunctionReturn(0);
}

PetscErrorCode PgOutputGetRowCount(PgOutput output, PetscInt *count)
{
  PetscFunctionBeginUser;
  *count = output->written + output->waiting;
  PetscFunctionReturn(0);
}

PetscErrorCode PgOutputTell(PgOutput output)
{
  PetscInt rows;

  PetscFunctionBeginUser;
  PetscCall(PgOutputGetRowCount(output, &rows));
  PetscCall(PetscPrintf(output->comm,
                        "results in %s, with .xmf for ParaView and .csv for the history beside it: %" PetscInt_FMT
                        " snapshots, %" PetscInt_FMT " rows of history\n",
                        output->file, output->snapshots, rows));
  PetscFunctionReturn(0);
}

PetscErrorCode PgOutputHistory(PgOutput output, const PetscReal row[])
{
  PetscFunctionBeginUser;
  PetscCheck(!output->finished, output->comm, PETSC_ERR_ORDER, "the output is finished");
  if (output->waiting == PG_HISTORY_WAITING) PetscCall(PgOutputFlush(output));
  if (output->rank == 0) {
    for (PetscInt c = 0; c < output->columns; c++) output->row[c * PG_HISTORY_WAITING + output->waiting] = row[c];
    PetscCall(PgHistoryRowText(output, PG_HISTORY_WAITING, output->waiting, output->row, &output->line));
  }
  output->waiting++;
  PetscCall(WriteCsv(output, &output->line));
  PetscFunctionReturn(0);
}

PetscErrorCode PgHistoryDestroy(PgOutput output)
{
  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < output->columns; c++) {
    PetscCall(PetscFree(output->column[c].name));
    PetscCall(PetscFree(output->column[c].unit));
    PetscCall(PetscFree(output->column[c].description));
  }
  PetscCall(PetscFree(output->column));
  PetscCall(PetscFree(output->row));
  PetscCall(PgTextDestroy(&output->line));
  if (output->csv_stream) (void)fclose(output->csv_stream);
  output->csv_stream = NULL;
  PetscFunctionReturn(0);
}
