/* What all gnuplot scripts have in common. */
#include "plotimpl.h"

PetscErrorCode PgScriptBegin(PgPlot plot, const char name[], PetscReal width, PetscReal height, PetscBool png_only,
                             PgScript *script)
{
  const PetscBool svg = (PetscBool)(plot->svg && !png_only), png = (PetscBool)(plot->png || png_only);
  const int       w = (int)(plot->size * width + 0.5), h = (int)(plot->size * height + 0.5);
  char            file_name[300];
  FILE           *f;

  PetscFunctionBeginUser;
  script->plot = plot;
  script->png  = png;
  script->svg  = svg;
  PetscCall(PetscStrncpy(script->name, name, sizeof script->name));
  PetscCall(PetscSNPrintf(file_name, sizeof file_name, "%s.gp", name));
  PetscCall(PgPlotFolderCreateFile(&plot->folder, file_name, &script->file));
  PetscCall(PgPlotFolderAddScript(&plot->folder, file_name));
  f = script->file;
  (void)fprintf(f, "# Made by porograin-plot %s. To change the figure, edit this and run here:  gnuplot %s.gp\n",
                PG_VERSION, name);
  (void)fprintf(f, "set encoding utf8\ndo for [format in '%s%s%s'] {\n", png ? "png" : "", png && svg ? " " : "",
                svg ? "svg" : "");
  (void)fprintf(
      f,
      "if (format eq 'svg') {\n  set terminal svg size %d,%d enhanced font 'DejaVu Sans,%.3g' background 'white'\n}\n",
      w, h, (double)(11.0 * plot->size));
  (void)fprintf(f,
                "if (format eq 'png') {\n  if (strstrt(GPVAL_TERMINALS, 'pngcairo')) {\n"
                "    set terminal pngcairo size %d,%d enhanced font 'DejaVu Sans,%.3g'\n  } else {\n"
                "    set terminal png size %d,%d enhanced\n  }\n}\n",
                w, h, (double)(11.0 * plot->size), w, h);
  (void)fprintf(f, "set key noenhanced\n");
  PetscFunctionReturn(0);
}

PetscErrorCode PgScriptEnd(PgScript *script)
{
  char file_name[300];

  PetscFunctionBeginUser;
  (void)fprintf(script->file, "unset output\n}\n");
  PetscCall(PetscSNPrintf(file_name, sizeof file_name, "%s.gp", script->name));
  PetscCall(PgPlotFolderCloseFile(&script->plot->folder, file_name, &script->file));
  PetscFunctionReturn(0);
}

PetscErrorCode PgScriptPicture(PgScript *script)
{
  char file_name[300];

  PetscFunctionBeginUser;
  (void)fprintf(script->file, "set output '%s.'.format\n", script->name);
  for (int svg = 0; svg < 2; svg++) {
    if (!(svg ? script->svg : script->png)) continue;
    PetscCall(PetscSNPrintf(file_name, sizeof file_name, "%s.%s", script->name, svg ? "svg" : "png"));
    PetscCall(PgPlotFolderAddPicture(&script->plot->folder, file_name));
  }
  PetscFunctionReturn(0);
}

/* M. Okabe, K. Ito: told apart by colour-blind readers too. */
const char *PgScriptColour(PetscInt series)
{
  static const char *const colour[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"};

  return colour[series % (PetscInt)(sizeof colour / sizeof *colour)];
}

PetscInt PgScriptDash(PetscInt series) { return 1 + series / 7 % 5; }

const char *PgScriptQuote(const char text[], char quoted[], size_t size)
{
  size_t n = 0;

  for (const char *c = text; *c && n + 3 < size; c++) {
    if ((unsigned char)*c < 32) continue;
    if (*c == '\'') quoted[n++] = '\'';
    quoted[n++] = *c;
  }
  quoted[n] = '\0';
  return quoted;
}

/* viridis, and the red-blue scale of C. Brewer: both with lightness that is even, or evenly falls off to both sides. */
PetscErrorCode PgScriptPalette(PgScript *script, PetscBool is_signed, PetscInt steps, const PgPlotRange *range)
{
  static const char viridis[]  = "0 '#440154', 1 '#482878', 2 '#3e4989', 3 '#31688e', 4 '#26828e', 5 '#1f9e89', "
                                 "6 '#35b779', 7 '#6ece58', 8 '#b5de2b', 9 '#fde725'";
  static const char red_blue[] = "0 '#053061', 1 '#2166ac', 2 '#4393c3', 3 '#92c5de', 4 '#d1e5f0', 5 '#f7f7f7', "
                                 "6 '#fddbc7', 7 '#f4a582', 8 '#d6604d', 9 '#b2182b', 10 '#67001f'";

  PetscFunctionBeginUser;
  (void)fprintf(script->file, "set palette maxcolors %d defined (%s)\nset cbrange [%.7g:%.7g]\n", (int)steps,
                is_signed ? red_blue : viridis, (double)range->low, (double)range->high);
  PetscFunctionReturn(0);
}
