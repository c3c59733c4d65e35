/* What the files of this room share. */
#pragma once

#include <porograin/plot.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- folder.c: figures appear all together, or not at all ---- */

typedef struct {
  char   **item;
  PetscInt count, room;
} PgNames;

typedef struct {
  MPI_Comm  comm;
  char      final[PETSC_MAX_PATH_LEN], work[PETSC_MAX_PATH_LEN]; /* where files go, and where they are made */
  PetscBool made;                                                /* `final` was not there before */
  PgNames   scripts, pictures;                                   /* to be run, and what must be there afterwards */
} PgPlotFolder;

PETSC_INTERN PetscErrorCode PgPlotFolderOpen(MPI_Comm comm, const char directory[], PgPlotFolder *folder);
PETSC_INTERN PetscErrorCode PgPlotFolderCreateFile(PgPlotFolder *folder, const char name[], FILE **file);
/* Reports what a full disk has swallowed. */
PETSC_INTERN PetscErrorCode PgPlotFolderCloseFile(PgPlotFolder *folder, const char name[], FILE **file);
PETSC_INTERN PetscErrorCode PgPlotFolderAddScript(PgPlotFolder *folder, const char name[]);
PETSC_INTERN PetscErrorCode PgPlotFolderAddPicture(PgPlotFolder *folder, const char name[]);
/* Runs gnuplot on every script. *drawn is false when there is no such program. */
PETSC_INTERN PetscErrorCode PgPlotFolderDraw(PgPlotFolder *folder, const char program[], PetscBool *drawn);
/* Moves all files to where they belong. */
PETSC_INTERN PetscErrorCode PgPlotFolderKeep(PgPlotFolder *folder, PetscInt *files);
/* Removes what was not kept. */
PETSC_INTERN PetscErrorCode PgPlotFolderClose(PgPlotFolder *folder);

/* ---- source.c: a file to be plotted ---- */

typedef struct {
  char       file[PETSC_MAX_PATH_LEN];
  char       label[128], stem[128]; /* for legends, and for file names */
  PetscBool  study, load;           /* load: STEM-load.dat has been written */
  PetscBool  mesh;                  /* a continuum: cells of a mesh in the place of discs */
  PetscBool  liquid;                /* particles of a liquid, walls and bodies: the dataset `kind` tells */
  PetscReal  magnified;             /* mesh: how many times displacements are drawn */
  PetscInt   snapshots, chosen;
  PetscReal *time; /* of the snapshots [s] */
} PgPlotSource;

enum { PG_PLOT_TEXT = 192 };
typedef char PgPlotText[PG_PLOT_TEXT];

PETSC_INTERN PetscErrorCode PgPlotSourceOpen(MPI_Comm comm, const char file[], PgPlotSource *source);
PETSC_INTERN PetscErrorCode PgPlotSourceClose(PgPlotSource *source);
PETSC_INTERN PetscErrorCode PgPlotSourceHas(const PgPlotSource *source, const char object[], PetscBool *has);
/* A dataset of the snapshot, which must have `rows` rows (-1: any) and `columns` columns. */
PETSC_INTERN PetscErrorCode PgPlotSourceSnapshot(const PgPlotSource *source, PetscInt snapshot, const char dataset[],
                                                 PetscInt columns, PetscInt *rows, PetscReal **value);
/* A column of the history; *value is NULL when there is none. */
PETSC_INTERN PetscErrorCode PgPlotSourceHistory(const PgPlotSource *source, const char column[], PetscInt *rows,
                                                PetscReal **value);
/* Rows of a table of a study, 0 when it has no such table. */
PETSC_INTERN PetscErrorCode PgPlotSourceRows(const PgPlotSource *source, const char table[], PetscInt *rows);
/* One value of a row; NaN, or an empty text, when there is none. */
PETSC_INTERN PetscErrorCode PgPlotSourceReal(const PgPlotSource *source, const char table[], PetscInt row,
                                             const char column[], PetscReal *value);
PETSC_INTERN PetscErrorCode PgPlotSourceText(const PgPlotSource *source, const char table[], PetscInt row,
                                             const char column[], PgPlotText text);
/* What the table says about a column; empty when it has no such column. */
PETSC_INTERN PetscErrorCode PgPlotSourceColumn(const PgPlotSource *source, const char table[], const char column[],
                                               PgPlotText text);

/* ---- fields.c: what can be drawn of a snapshot ---- */

typedef enum { PG_PLOT_DISCS, PG_PLOT_STREAMLINES, PG_PLOT_CONTOURS } PgPlotDrawing;
typedef struct {
  const char *name, *title, *unit; /* name: in -plot_fields and file names; unit: as drawn */
  const char *dataset;
  PetscInt    columns; /* of the dataset */
  PetscReal   scale;   /* unit as drawn = scale * unit of the file */
  PetscReal (*value)(const PetscReal row[]);
  PetscBool     is_signed; /* colours symmetric about 0 */
  PgPlotDrawing drawing;
} PgPlotField;

enum { PG_PLOT_FIELDS = 24, PG_PLOT_PAPER_FIELDS = 7 };
PETSC_INTERN const PgPlotField *PgPlotFieldFind(const char name[]);
PETSC_INTERN const PgPlotField *PgPlotFieldAt(PetscInt index); /* NULL behind the last; first those of the paper */
/* Those of a liquid; NULL behind the last. */
PETSC_INTERN const PgPlotField *PgPlotLiquidFieldAt(PetscInt index);
/* What this name means in this file: on a mesh some fields are others, and most are none (NULL). */
PETSC_INTERN const PgPlotField *PgPlotFieldIn(const PgPlotSource *source, const PgPlotField *field);
/* The discs of a snapshot in millimetres; on a mesh the corners of its cells, four by four, with radius 0. */
typedef struct {
  PetscInt   count;
  PetscReal *x, *y, *r;
  PetscReal *kind;            /* in files with a liquid: 0 liquid, 1 wall, 2 body; else NULL */
  PetscReal  low[2], high[2]; /* around all discs but those that have burst off */
  PetscInt   outside;         /* how many those are */
} PgPlotDiscs;
PETSC_INTERN PetscErrorCode PgPlotDiscsRead(const PgPlotSource *source, PetscInt snapshot, PgPlotDiscs *discs);
PETSC_INTERN PetscBool      PgPlotDiscsInView(const PgPlotDiscs *discs, PetscInt disc);
PETSC_INTERN PetscErrorCode PgPlotDiscsDestroy(PgPlotDiscs *discs);
/* The values of a field, one for each disc, as drawn; NaN of walls and bodies in a liquid. */
PETSC_INTERN PetscErrorCode PgPlotFieldRead(const PgPlotSource *source, PetscInt snapshot, const PgPlotField *field,
                                            const PgPlotDiscs *discs, PetscReal **value);
PETSC_INTERN PetscErrorCode PgPlotFieldIsThere(const PgPlotSource *source, PetscInt snapshot, const PgPlotField *field,
                                               PetscBool *there);
/* Limits of the colours. A few discs that burst off must not take all colours: an end at which -plot_clip percent of
   the values reach beyond 1.5 times the rest is cut off there, and `min`, `max` tell how far they go. Several sets of
   values may be added. Start with PG_PLOT_NO_RANGE. Finish makes signed ranges symmetric, and none empty. */
typedef struct {
  PetscReal low, high, min, max;
} PgPlotRange;
#define PG_PLOT_NO_RANGE                                                                                               \
  {                                                                                                                    \
    PETSC_MAX_REAL, PETSC_MIN_REAL, PETSC_MAX_REAL, PETSC_MIN_REAL                                                     \
  }
PETSC_INTERN PetscErrorCode PgPlotRangeAdd(PetscInt count, const PetscReal value[], PetscBool is_signed, PetscReal clip,
                                           PgPlotRange *range);
/* Finished, of values that are all 0: a scale would be made up. */
PETSC_INTERN PetscBool PgPlotRangeIsZero(const PgPlotRange *range);
PETSC_INTERN void      PgPlotRangeFinish(PetscBool is_signed, PgPlotRange *range);
/* A round number near x. */
PETSC_INTERN PetscReal PgPlotRound(PetscReal x);

/* ---- mesh.c: cells of a continuum, which to the rest are four discs each ---- */

PETSC_INTERN const PgPlotField *PgPlotMeshFieldFind(const char name[]);
PETSC_INTERN const PgPlotField *PgPlotMeshFieldAt(PetscInt index); /* NULL behind the last */
/* Whether it is one, and how many times to draw its displacements. */
PETSC_INTERN PetscErrorCode PgPlotMeshOpen(PgPlotSource *source);
PETSC_INTERN PetscErrorCode PgPlotMeshRead(const PgPlotSource *source, PetscInt snapshot, PgPlotDiscs *discs);
PETSC_INTERN PetscErrorCode PgPlotMeshValues(const PgPlotSource *source, PetscInt snapshot, const PgPlotField *field,
                                             PetscReal **value);
/* NAME-cells.txt: the cells as gnuplot draws them. */
PETSC_INTERN PetscErrorCode PgPlotMeshWrite(PgPlot plot, const char name[], const PgPlotDiscs *discs,
                                            const PetscReal value[]);
PETSC_INTERN void           PgPlotMeshDraw(FILE *script, const char name[], const char data[], PetscInt column);

/* ---- the object ---- */

enum { PG_PLOT_SOURCES = 32 };
struct PgPlot_s {
  MPI_Comm           comm;
  PetscInt           files, sources; /* files: named on the command line; sources: opened so far */
  char              *file[PG_PLOT_SOURCES];
  PgPlotSource       source[PG_PLOT_SOURCES];
  char               directory[PETSC_MAX_PATH_LEN], gnuplot[PETSC_MAX_PATH_LEN];
  PetscBool          png, svg;
  PetscReal          time; /* [s] */
  PetscBool          time_set, fields_set;
  PetscReal          size, clip; /* clip as a fraction */
  PetscInt           fields;
  const PgPlotField *field[PG_PLOT_FIELDS], *film;
  PgPlotFolder       folder;
};

/* ---- script.c: a gnuplot script ---- */

typedef struct {
  PgPlot    plot;
  char      name[256]; /* without .gp */
  FILE     *file;
  PetscBool png, svg;
} PgScript;

/* Opens NAME.gp, which draws a picture of width x height pixels in all formats (or in PNG alone) at -plot_size 1. */
PETSC_INTERN PetscErrorCode PgScriptBegin(PgPlot plot, const char name[], PetscReal width, PetscReal height,
                                          PetscBool png_only, PgScript *script);
/* The picture NAME.png, NAME.svg begins; what comes before goes for several pictures. */
PETSC_INTERN PetscErrorCode PgScriptPicture(PgScript *script);
PETSC_INTERN PetscErrorCode PgScriptEnd(PgScript *script);
/* One of several series in a plot: "lc rgb '#...' dt D". */
PETSC_INTERN const char *PgScriptColour(PetscInt series);
PETSC_INTERN PetscInt    PgScriptDash(PetscInt series);
/* The text with what would end a string in a script replaced. */
PETSC_INTERN const char *PgScriptQuote(const char text[], char quoted[], size_t size);
/* colours for values in `range` */
PETSC_INTERN PetscErrorCode PgScriptPalette(PgScript *script, PetscBool is_signed, PetscInt steps,
                                            const PgPlotRange *range);

/* ---- drawing.c: pieces of pictures of discs ---- */

#define PG_PLOT_CHARACTER 9.4   /* width of a digit in 11 points, in a PNG; in an SVG it is 7 [pixels] */
#define PG_PLOT_SHEET     380.0 /* longer side of the axes on a sheet [pixels]; no picture has smaller ones */
/* Labels of a colour bar: every `step`, with as many digits as tell neighbours apart. */
typedef struct {
  PetscReal step;
  char      format[16];
  PetscInt  length; /* characters of the longest */
} PgPlotBarLabels;

PETSC_INTERN PgPlotBarLabels PgPlotBarLabelsOf(const PgPlotRange *range, PetscReal step);
PETSC_INTERN void            PgPlotLabelBar(FILE *file, const PgPlotRange *range, PetscReal step);
PETSC_INTERN PetscReal       PgPlotMargin(const PetscReal low[2], const PetscReal high[2]);
PETSC_INTERN PetscReal       PgPlotTicStep(const PetscReal low[2], const PetscReal high[2], int axis);
/* Characters of the longest number at the tics. */
PETSC_INTERN PetscInt PgPlotTicLength(const PetscReal low[2], const PetscReal high[2], int axis);
PETSC_INTERN void     PgPlotAxes(FILE *f, const PetscReal low[2], const PetscReal high[2]);
PETSC_INTERN void PgPlotPixels(const PetscReal low[2], const PetscReal high[2], PetscReal longest, PetscReal pixels[2]);
PETSC_INTERN const char *PgPlotUnit(const PgPlotField *field);
PETSC_INTERN void PgPlotDrawDiscs(FILE *f, const char data[], PetscInt column, PetscInt discs, PetscBool is_signed,
                                  PetscBool liquid);

/* ---- figures: snapshots.c, curves.c, studies.c ---- */

PETSC_INTERN PetscErrorCode PgPlotSnapshot(PgPlot plot, const PgPlotSource *source);
PETSC_INTERN PetscErrorCode PgPlotFilm(PgPlot plot, const PgPlotSource *source);
PETSC_INTERN PetscErrorCode PgPlotLoads(PgPlot plot);
PETSC_INTERN PetscErrorCode PgPlotHistory(PgPlot plot, const PgPlotSource *source);
PETSC_INTERN PetscErrorCode PgPlotStudy(PgPlot plot, const PgPlotSource *source);
/* The way of the plate at a time [m], from the history; *known tells whether there is one. */
PETSC_INTERN PetscErrorCode PgPlotDisplacement(const PgPlotSource *source, PetscReal time, PetscReal *displacement,
                                               PetscBool *known);

/* ---- flow.c: data of the drawings between the discs; lengths in mm ---- */

/* NAME-streamlines.dat and NAME-arrows.dat. */
PETSC_INTERN PetscErrorCode PgPlotStreamlinesWrite(PgPlot plot, const char name[], const PgPlotDiscs *discs,
                                                   const PetscReal w[]);
/* NAME-grid.dat and NAME-contours.dat; range and number of colours. */
PETSC_INTERN PetscErrorCode PgPlotContoursWrite(PgPlot plot, const char name[], const PgPlotDiscs *discs,
                                                const PetscReal w[], PgPlotRange *range, PetscInt *colours);
