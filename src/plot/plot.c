/* The object of porograin-plot: options, and the order in which figures are made. */
#include "plotimpl.h"

PetscErrorCode PgPlotCreate(MPI_Comm comm, PgPlot *plot)
{
  PetscMPIInt size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PgInputCheck(size == 1, comm, "porograin-plot runs on one process, not on %d", size);
  PetscCall(PetscNew(plot));
  (*plot)->comm = comm;
  (*plot)->png = (*plot)->svg = PETSC_TRUE;
  (*plot)->size               = 1.0;
  (*plot)->clip               = 0.05;
  PetscCall(PetscStrncpy((*plot)->directory, "figures", sizeof(*plot)->directory));
  PetscCall(PetscStrncpy((*plot)->gnuplot, "gnuplot", sizeof(*plot)->gnuplot));
  for (PetscInt f = 0; f < PG_PLOT_PAPER_FIELDS; f++) (*plot)->field[(*plot)->fields++] = PgPlotFieldAt(f);
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotSetFiles(PgPlot plot, int argc, char *argv[])
{
  PetscFunctionBeginUser;
  for (int i = 1; i < argc; i++) {
    const PetscBool option = (PetscBool)(argv[i][0] == '-'), value = (PetscBool)(i > 1 && argv[i - 1][0] == '-');
    if (option || value) continue;
    PgInputCheck(plot->files < PG_PLOT_SOURCES, plot->comm, "more than %d files", (int)PG_PLOT_SOURCES);
    PgInputCheck(strlen(argv[i]) < PETSC_MAX_PATH_LEN, plot->comm, "file name of more than %d characters",
                 PETSC_MAX_PATH_LEN - 1);
    PetscCall(PetscStrallocpy(argv[i], &plot->file[plot->files++]));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode FindField(PgPlot plot, const char option[], const char name[], const PgPlotField **field)
{
  char known[1024] = "";

  PetscFunctionBeginUser;
  *field = PgPlotFieldFind(name);
  for (PetscInt f = 0; PgPlotFieldAt(f); f++) {
    PetscCall(PetscStrlcat(known, f ? ", " : "", sizeof known));
    PetscCall(PetscStrlcat(known, PgPlotFieldAt(f)->name, sizeof known));
  }
  PgInputCheck(*field, plot->comm, "option %s: there is no field '%s'; there are %s", option, name, known);
  PetscFunctionReturn(0);
}

static PetscErrorCode SetFields(PgPlot plot, const char list[])
{
  char **word;
  int    words;

  PetscFunctionBeginUser;
  PetscCall(PetscStrToArray(list, ',', &words, &word));
  PgInputCheck(words > 0 && words <= PG_PLOT_FIELDS, plot->comm, "option -plot_fields: between 1 and %d fields",
               (int)PG_PLOT_FIELDS);
  for (int i = 0; i < words; i++) PetscCall(FindField(plot, "-plot_fields", word[i], &plot->field[i]));
  plot->fields = words;
  PetscCall(PetscStrToArrayDestroy(words, word));
  PetscFunctionReturn(0);
}

static PetscErrorCode SetFormats(PgPlot plot, const char list[])
{
  char **word;
  int    words;

  PetscFunctionBeginUser;
  plot->png = plot->svg = PETSC_FALSE;
  PetscCall(PetscStrToArray(list, ',', &words, &word));
  for (int i = 0; i < words; i++) {
    const PetscBool png = (PetscBool)!strcmp(word[i], "png"), svg = (PetscBool)!strcmp(word[i], "svg");
    PgInputCheck(png || svg, plot->comm, "option -plot_format: there is no format '%s'; there are png, svg", word[i]);
    plot->png = (PetscBool)(plot->png || png);
    plot->svg = (PetscBool)(plot->svg || svg);
  }
  PetscCall(PetscStrToArrayDestroy(words, word));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotSetFromOptions(PgPlot plot)
{
  char      fields[1024] = "the paper's seven", formats[64] = "png,svg", film[128] = "";
  PetscBool formats_set, film_set;
  PetscReal percent = 100.0 * plot->clip;

  PetscFunctionBeginUser;
  PetscOptionsBegin(plot->comm, NULL, "plot: figures from results", NULL);
  PetscCall(PgOptionString(PetscOptionsObject, "-figures", "directory of the figures, made when it is not there",
                           plot->directory, sizeof plot->directory, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-plot_time",
                         "draw the snapshot nearest to this time (default: the last one)", "s", 0.0, 1e30, &plot->time,
                         &plot->time_set));
  PetscCall(PgOptionString(
      PetscOptionsObject, "-plot_fields",
      "fields to draw, separated by commas: effective_strain, volumetric_strain, rotation, porosity, "
      "pressure, streamlines, relative_speed (these are the paper's seven), speed, fluid_speed, "
      "angular_velocity, coordination_number, mean_stress; of a continuum there are pressure, displacement, "
      "volumetric_strain, relative_speed, mean_stress, speed, by default all; of a liquid (cases wcsph_* and tak_*) "
      "speed or velocity, pressure, density, by default all",
      fields, sizeof fields, &plot->fields_set));
  PetscCall(PgOptionString(PetscOptionsObject, "-plot_film",
                           "draw this field of all snapshots as numbered PNG files with one colour scale", film,
                           sizeof film, &film_set));
  PetscCall(PgOptionString(PetscOptionsObject, "-plot_format", "png, svg or both, separated by a comma", formats,
                           sizeof formats, &formats_set));
  PetscCall(PgOptionReal(PetscOptionsObject, "-plot_size", "size of the pictures, a factor", "1", 0.2, 10.0,
                         &plot->size, NULL));
  PetscCall(
      PgOptionReal(PetscOptionsObject, "-plot_clip",
                   "share of the values at either end of a colour scale that may lie beyond it, when they would take "
                   "up more than a third of it",
                   "%", 0.0, 40.0, &percent, NULL));
  PetscCall(PgOptionString(PetscOptionsObject, "-plot_gnuplot", "program that draws the scripts; none: write them only",
                           plot->gnuplot, sizeof plot->gnuplot, NULL));
  PetscOptionsEnd();
  plot->clip = 0.01 * percent;
  if (plot->fields_set) PetscCall(SetFields(plot, fields));
  if (formats_set) PetscCall(SetFormats(plot, formats));
  if (film_set) {
    PetscCall(FindField(plot, "-plot_film", film, &plot->film));
    PgInputCheck(plot->film->drawing == PG_PLOT_DISCS, plot->comm, "option -plot_film: %s is not drawn as discs",
                 plot->film->name);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Mention(void *context)
{
  PgPlot plot;

  PetscFunctionBeginUser;
  (void)context;
  PetscCall(PgPlotCreate(PETSC_COMM_WORLD, &plot));
  PetscCall(PgPlotSetFromOptions(plot));
  PetscCall(PgPlotDestroy(&plot));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotMentionOptions(MPI_Comm comm)
{
  PetscFunctionBeginUser;
  (void)comm;
  PetscCall(PgOptionsApart(Mention, NULL));
  PetscFunctionReturn(0);
}

/* The snapshot nearest to the time asked for. */
static PetscErrorCode Choose(PgPlot plot, PgPlotSource *source)
{
  const PetscInt last = source->snapshots - 1;

  PetscFunctionBeginUser;
  source->chosen = last;
  if (!plot->time_set || last < 0) PetscFunctionReturn(0);
  /* a time that was rounded for printing is still inside */
  PgInputCheck(plot->time >= source->time[0] * (1 - 1e-3) && plot->time <= source->time[last] * (1 + 1e-3), plot->comm,
               "option -plot_time: %.6g s is out of range, the snapshots of %s are from %.6g to %.6g s",
               (double)plot->time, source->file, (double)source->time[0], (double)source->time[last]);
  for (PetscInt s = 0; s <= last; s++)
    if (PetscAbsReal(source->time[s] - plot->time) < PetscAbsReal(source->time[source->chosen] - plot->time))
      source->chosen = s;
  if (PetscAbsReal(source->time[source->chosen] - plot->time) > 1e-3 * source->time[last])
    PetscCall(PetscPrintf(plot->comm, "note: %s has no snapshot at %.6g s, the nearest is drawn, of %.6g s\n",
                          source->file, (double)plot->time, (double)source->time[source->chosen]));
  PetscFunctionReturn(0);
}

/* Files of the same name in different directories must not overwrite each other's figures. */
static PetscErrorCode TellApart(PgPlot plot, PgPlotSource *source)
{
  char     stem[sizeof source->stem];
  PetscInt number = 1;

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(stem, source->stem, sizeof stem));
  for (PetscInt i = 0; i < plot->sources; i++) {
    if (strcmp(plot->source[i].stem, source->stem)) continue;
    number++;
    (void)snprintf(source->stem, sizeof source->stem, "%.100s-%d", stem, (int)number);
    i = -1;
  }
  if (number > 1) PetscCall(PetscStrncpy(source->label, source->file, sizeof source->label));
  PetscFunctionReturn(0);
}

/* What was asked for by name must be there. */
static PetscErrorCode CheckField(PgPlot plot, const PgPlotField *field)
{
  PetscInt  results = 0;
  PetscBool there   = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < plot->sources && !there; i++) {
    if (plot->source[i].study || plot->source[i].snapshots == 0) continue;
    results++;
    PetscCall(PgPlotFieldIsThere(&plot->source[i], plot->source[i].chosen, field, &there));
  }
  PgInputCheck(there, plot->comm, "field %s: %s dataset %s%s", field->name,
               plot->sources > 1 ? "none of the files has a" : "the file has no", field->dataset,
               results ? "" : ", there are no snapshots");
  PetscFunctionReturn(0);
}

static PetscErrorCode Open(PgPlot plot)
{
  PetscFunctionBeginUser;
  PgInputCheck(plot->files > 0, plot->comm, "no file to plot: porograin-plot run.h5 [more.h5 ...] -figures DIR");
  for (PetscInt i = 0; i < plot->files; i++) {
    PgPlotSource *source = &plot->source[plot->sources];
    PetscCall(PgPlotSourceOpen(plot->comm, plot->file[i], source));
    PetscCall(TellApart(plot, source));
    plot->sources++;
    if (!source->study) PetscCall(Choose(plot, source));
  }
  for (PetscInt f = 0; plot->fields_set && f < plot->fields; f++) PetscCall(CheckField(plot, plot->field[f]));
  if (plot->film) PetscCall(CheckField(plot, plot->film));
  PetscFunctionReturn(0);
}

static PetscErrorCode Make(PgPlot plot)
{
  PetscFunctionBeginUser;
  PetscCall(PgPlotLoads(plot));
  for (PetscInt i = 0; i < plot->sources; i++) {
    const PgPlotSource *source = &plot->source[i];
    PetscBool           there  = PETSC_FALSE;
    if (source->study) {
      PetscCall(PgPlotStudy(plot, source));
      continue;
    }
    PetscCall(PgPlotHistory(plot, source));
    if (source->snapshots == 0) {
      PetscCall(PetscPrintf(plot->comm, "note: %s has no snapshots: no pictures of fields\n", source->file));
      continue;
    }
    PetscCall(PgPlotSnapshot(plot, source));
    if (plot->film) PetscCall(PgPlotFieldIsThere(source, 0, plot->film, &there));
    if (there) PetscCall(PgPlotFilm(plot, source));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeAndDraw(PgPlot plot)
{
  PetscBool drawn = PETSC_FALSE;
  PetscInt  files;

  PetscFunctionBeginUser;
  PetscCall(Make(plot));
  if (strcmp(plot->gnuplot, "none")) {
    PetscCall(PgPlotFolderDraw(&plot->folder, plot->gnuplot, &drawn));
    if (!drawn)
      PetscCall(PetscPrintf(plot->comm, "note: no program '%s' (Debian: gnuplot-nox): scripts and data only\n",
                            plot->gnuplot));
  }
  PetscCall(PgPlotFolderKeep(&plot->folder, &files));
  PetscCall(PetscPrintf(plot->comm, "%" PetscInt_FMT " files in %s: ", files, plot->directory));
  if (drawn) PetscCall(PetscPrintf(plot->comm, "%" PetscInt_FMT " pictures, ", plot->folder.pictures.count));
  PetscCall(PetscPrintf(plot->comm, "%" PetscInt_FMT " gnuplot scripts, and their data\n", plot->folder.scripts.count));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPlotRun(PgPlot plot)
{
  PetscErrorCode err;

  PetscFunctionBeginUser;
  PetscCall(PgOptionsCheckUnused(plot->comm, NULL, NULL));
  PetscCall(Open(plot));
  PetscCall(PgPlotFolderOpen(plot->comm, plot->directory, &plot->folder));
  err = MakeAndDraw(plot);
  PetscCall(PgPlotFolderClose(&plot->folder));
  PetscFunctionReturn(err);
}

PetscErrorCode PgPlotDestroy(PgPlot *plot)
{
  PetscFunctionBeginUser;
  if (!*plot) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < (*plot)->files; i++) PetscCall(PetscFree((*plot)->file[i]));
  for (PetscInt i = 0; i < (*plot)->sources; i++) PetscCall(PgPlotSourceClose(&(*plot)->source[i]));
  PetscCall(PetscFree(*plot));
  PetscFunctionReturn(0);
}
