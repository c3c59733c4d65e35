/* panel_fields -head | NAME FILE.h5: what the fields of a panel's run say about the claims of Li, Chu & Sheng (2007) on
   symmetry, bands and flow. Prints a head of a table, or one line: the mean over all snapshots but the first.

   Fields are smoothed over the neighbours at the start (centres within 4 r, the circle of the paper's porosity).
   symmetry   correlation of the effective strain with its mirror image at mid-height, disc by disc (the lattice is
              symmetric: row k and row R - 1 - k); 1 for a symmetric field, about 0 for an unrelated one
   bands      the fifth of the discs with the largest effective strain: its share of the total (0.2 if nothing is
              localised), and inside over outside: mean absolute rotation, mean porosity, mean volumetric strain
   flow       mean over the discs outside, with a band within 10 r, of the component of w = n (u - v) towards the nearest disc of
              the band, over the mean of |w| there; positive: towards the bands
   Discs whose porosity is above 0.4, or whose neighbourhood has grown by more than a half, have left the panel and do not
   count. */
#include <hdf5.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 100 };
static const double most_porosity = 0.4, most_growth = 0.5, share = 0.2;

typedef struct {
  size_t  n;
  double *start, *r, *strain; /* smoothed effective strain */
  double *x, *w, *rotation, *porosity, *volumetric;
  char   *band, *gone;
} Panel;

typedef struct {
  double symmetry, share, rotation[2], porosity[2], volumetric[2], flow;
} Found;

static double *Read(hid_t file, int snapshot, const char name[], size_t columns, size_t *rows)
{
  char    path[128];
  hid_t   set, space;
  hsize_t size[2] = {0, 1};
  double *values;

  (void)snprintf(path, sizeof path, "/snapshots/%06d/%s", snapshot, name);
  if (H5Lexists(file, path, H5P_DEFAULT) <= 0) return NULL;
  set = H5Dopen2(file, path, H5P_DEFAULT);
  if (set < 0) exit(2);
  space = H5Dget_space(set);
  if (H5Sget_simple_extent_ndims(space) > 2 || H5Sget_simple_extent_dims(space, size, NULL) < 1 || size[1] != columns) {
    (void)fprintf(stderr, "%s has another shape\n", path);
    exit(2);
  }
  values = calloc((size_t)size[0] * columns + 1, sizeof *values);
  if (!values || H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) exit(2);
  (void)H5Sclose(space);
  (void)H5Dclose(set);
  *rows = (size_t)size[0];
  return values;
}

static void *Allocate(size_t count, size_t size)
{
  void *memory = calloc(count + 1, size);

  if (!memory) exit(2);
  return memory;
}

static double Distance(const double x[], size_t a, size_t b)
{
  return hypot(x[2 * a] - x[2 * b], x[2 * a + 1] - x[2 * b + 1]);
}

/* Mean over the neighbours at the start that are still there. */
static double *Smooth(const Panel *p, const double raw[])
{
  double *mean = Allocate(p->n, sizeof *mean);

  for (size_t a = 0; a < p->n; a++) {
    double sum = 0.0, count = 0.0;
    for (size_t b = 0; b < p->n; b++)
      if (Distance(p->start, a, b) <= 4.0 * p->r[a] && !p->gone[b]) {
        sum += raw[b];
        count += 1.0;
      }
    mean[a] = count > 0.0 ? sum / count : 0.0;
  }
  return mean;
}

/* The disc at the mirrored place, at mid-height of the lattice. */
static size_t Mirror(const Panel *p, size_t a)
{
  double high = 0.0;
  size_t best = a;
  double least;

  for (size_t b = 0; b < p->n; b++) high = fmax(high, p->start[2 * b + 1] + p->r[b]);
  least = HUGE_VAL;
  for (size_t b = 0; b < p->n; b++) {
    const double d = hypot(p->start[2 * b] - p->start[2 * a], high - p->start[2 * b + 1] - p->start[2 * a + 1]);
    if (d < least) {
      least = d;
      best  = b;
    }
  }
  return best;
}

static double Symmetry(const Panel *p, const size_t mirror[])
{
  double sum = 0.0, count = 0.0, dot = 0.0, square = 0.0;

  for (size_t a = 0; a < p->n; a++) {
    if (p->gone[a] || p->gone[mirror[a]]) continue;
    sum += p->strain[a];
    count += 1.0;
  }
  for (size_t a = 0; a < p->n; a++) {
    const double here = p->strain[a] - sum / count, there = p->strain[mirror[a]] - sum / count;
    if (p->gone[a] || p->gone[mirror[a]]) continue;
    dot += here * there;
    square += here * here;
  }
  return dot / square;
}

static int Descending(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x < y) - (x > y);
}

static void FindBand(Panel *p, Found *f)
{
  double *order = Allocate(p->n, sizeof *order), total = 0.0, inside = 0.0, bound;
  size_t  count = 0;

  for (size_t a = 0; a < p->n; a++)
    if (!p->gone[a]) order[count++] = p->strain[a];
  qsort(order, count, sizeof *order, Descending);
  bound = order[(size_t)(share * (double)count)];
  free(order);
  for (size_t a = 0; a < p->n; a++) {
    p->band[a] = (char)(p->strain[a] > bound && !p->gone[a]);
    if (p->gone[a]) continue;
    total += p->strain[a];
    if (p->band[a]) inside += p->strain[a];
  }
  f->share = inside / total;
}

static void Compare(const Panel *p, const double field[], double mean[2])
{
  double sum[2] = {0.0, 0.0}, count[2] = {0.0, 0.0};

  for (size_t a = 0; a < p->n; a++) {
    if (p->gone[a]) continue;
    sum[p->band[a] != 0] += fabs(field[a]) * (field == p->rotation) + field[a] * (field != p->rotation);
    count[p->band[a] != 0] += 1.0;
  }
  for (int k = 0; k < 2; k++) mean[k] = sum[1 - k] / count[1 - k];
}

static double Flow(const Panel *p)
{
  double toward = 0.0, speed = 0.0;

  for (size_t a = 0; a < p->n; a++) {
    double least = 10.0 * p->r[a];
    size_t best  = a;
    if (p->band[a] || p->gone[a]) continue;
    for (size_t b = 0; b < p->n; b++)
      if (p->band[b] && Distance(p->x, a, b) < least) {
        least = Distance(p->x, a, b);
        best  = b;
      }
    if (best == a) continue;
    toward += (p->w[2 * a] * (p->x[2 * best] - p->x[2 * a]) +
               p->w[2 * a + 1] * (p->x[2 * best + 1] - p->x[2 * a + 1])) /
              least;
    speed += hypot(p->w[2 * a], p->w[2 * a + 1]);
  }
  return speed > 0.0 ? toward / speed : 0.0;
}

/* 0 when there is no such snapshot. */
static int Look(hid_t file, int snapshot, Panel *p, const size_t mirror[], Found *f)
{
  size_t  n[6] = {0};
  double *raw;
  char    path[64];

  (void)snprintf(path, sizeof path, "/snapshots/%06d", snapshot);
  if (H5Lexists(file, path, H5P_DEFAULT) <= 0) return 0;
  raw           = Read(file, snapshot, "effective_strain", 1, &n[0]);
  p->x          = Read(file, snapshot, "position", 2, &n[1]);
  p->rotation   = Read(file, snapshot, "rotation", 1, &n[2]);
  p->volumetric = Read(file, snapshot, "volumetric_strain", 1, &n[3]);
  p->porosity   = Read(file, snapshot, "porosity", 1, &n[4]);
  p->w          = Read(file, snapshot, "relative_velocity", 2, &n[5]);
  if (!p->porosity) p->porosity = Allocate(p->n, sizeof *p->porosity); /* dry */
  if (!p->w) p->w = Allocate(2 * p->n, sizeof *p->w);
  if (!raw || !p->x || !p->rotation || !p->volumetric || !p->porosity || !p->w) exit(2);
  for (size_t a = 0; a < p->n; a++)
    p->gone[a] = (char)(p->porosity[a] > most_porosity || p->volumetric[a] > most_growth);
  p->strain   = Smooth(p, raw);
  f->symmetry = Symmetry(p, mirror);
  FindBand(p, f);
  Compare(p, p->rotation, f->rotation);
  Compare(p, p->porosity, f->porosity);
  Compare(p, p->volumetric, f->volumetric);
  f->flow             = Flow(p);
  double *const old[] = {raw, p->x, p->rotation, p->volumetric, p->porosity, p->w, p->strain};
  for (size_t i = 0; i < sizeof old / sizeof *old; i++) free(old[i]);
  return 1;
}

static void Report(const char name[], const Found found[], int count)
{
  enum { NUMBERS = sizeof(Found) / sizeof(double) };
  double mean[NUMBERS] = {0.0};

  for (int s = 0; s < count; s++)
    for (size_t k = 0; k < NUMBERS; k++) mean[k] += ((const double *)&found[s])[k] / count;
  printf("| `%s` | %.2f | %.2f | %.2f / %.2f | %.3f / %.3f | %.4f / %.4f | %.2f |\n", name, mean[0], mean[1], mean[2],
         mean[3], mean[4], mean[5], mean[6], mean[7], mean[8]);
}

int main(int argc, char *argv[])
{
  Panel   p = {.n = 0};
  Found   found[MOST];
  size_t *mirror, rows;
  hid_t   file;
  int     count = 0;

  if (argc == 2 && !strcmp(argv[1], "-head")) {
    printf("| run | symmetry | share of strain in a fifth | rotation in / out [rad] | porosity in / out | volumetric "
           "strain "
           "in / out | flow towards bands |\n| --- | --- | --- | --- | --- | --- | --- |\n");
    return 0;
  }
  file = argc == 3 ? H5Fopen(argv[2], H5F_ACC_RDONLY, H5P_DEFAULT) : -1;
  if (file < 0) {
    (void)fprintf(stderr, "usage: panel_fields -head | NAME FILE.h5\n");
    return 2;
  }
  p.start = Read(file, 0, "position", 2, &p.n);
  p.r     = Read(file, 0, "radius", 1, &rows);
  p.band  = Allocate(p.n, 1);
  p.gone  = Allocate(p.n, 1);
  mirror  = Allocate(p.n, sizeof *mirror);
  if (!p.start || !p.r || rows != p.n) exit(2);
  for (size_t a = 0; a < p.n; a++) mirror[a] = Mirror(&p, a);
  while (count < MOST && Look(file, count + 1, &p, mirror, &found[count])) count++;
  if (count) Report(argv[1], found, count);
  double *const old[] = {p.start, p.r};
  for (size_t i = 0; i < sizeof old / sizeof *old; i++) free(old[i]);
  free(p.band);
  free(p.gone);
  free(mirror);
  return H5Fclose(file) < 0 || !count ? 2 : 0;
}
