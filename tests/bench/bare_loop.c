/* bare_loop COLUMNS STEPS: a DEM step without a program around it, as a yardstick: the panel's lattice, a fixed list of
   nearest neighbours, normal, sliding and rolling springs and a rolling moment with their Coulomb caps, explicit Euler.
   Terms cost what the law of Li, Chu & Sheng (2007) costs; it is not that law. Prints disc-steps per CPU second, the
   best of five. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

typedef struct {
  double x, y, vx, vy, w, angle;
} Disc;
typedef struct {
  double slide, roll, moment;
} Springs;
typedef struct {
  long  count, pairs;
  Disc *disc;
  double (*force)[3];
  int (*pair)[2];
  Springs *springs;
  char    *held;
} Panel;

static double Now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double Cap(double f, double most) { return fmin(fmax(f, -most), most); }

static void Forces(Panel *p, double dt)
{
  const double r = 5e-3, k_n = 6e8, k_s = 4e8, k_r = 2e3, k_theta = 700, mu = 0.5, arm = 1e-4;

  for (long i = 0; i < p->count; i++) p->force[i][0] = p->force[i][1] = p->force[i][2] = 0.0;
  for (long q = 0; q < p->pairs; q++) {
    const int    i = p->pair[q][0], j = p->pair[q][1];
    const Disc  *a = &p->disc[i], *b = &p->disc[j];
    const double dx = b->x - a->x, dy = b->y - a->y, d2 = dx * dx + dy * dy;
    Springs     *s = &p->springs[q];
    if (d2 >= 4 * r * r) {
      *s = (Springs){0, 0, 0};
      continue;
    }
    const double d = sqrt(d2), nx = dx / d, ny = dy / d, normal = k_n * (2 * r - d);
    const double shear = ((a->vy - b->vy) * nx - (a->vx - b->vx) * ny) + r * (a->w + b->w);
    s->slide           = Cap(s->slide - k_s * shear * dt, mu * normal);
    s->roll            = Cap(s->roll + k_r * r * (a->w + b->w) * dt, mu * normal);
    s->moment          = Cap(s->moment - k_theta * (a->w - b->w) * dt, arm * normal);
    const double t = Cap(s->slide + s->roll, mu * normal), fx = -normal * nx - t * ny, fy = -normal * ny + t * nx;
    p->force[i][0] += fx;
    p->force[i][1] += fy;
    p->force[i][2] += r * t + s->moment;
    p->force[j][0] -= fx;
    p->force[j][1] -= fy;
    p->force[j][2] += r * t - s->moment;
  }
}

static void Move(Panel *p, double dt)
{
  const double mass = 3.14159265358979 * 25e-6 * 2000.0, inertia = 0.5 * mass * 25e-6;

  for (long i = 0; i < p->count; i++) {
    Disc        *a    = &p->disc[i];
    const double free = p->held[i] ? 0.0 : dt;
    a->vx += free / mass * p->force[i][0];
    a->vy += free / mass * p->force[i][1];
    a->w += dt / inertia * p->force[i][2];
    a->x += dt * a->vx;
    a->y += dt * a->vy;
    a->angle += dt * a->w;
  }
}

static int Make(Panel *p, int columns)
{
  const double spacing = 0.01 * (1 - 1e-5); /* all contacts closed */
  long         i       = 0;

  p->count   = 2L * columns * columns - 1;
  p->disc    = calloc((size_t)p->count, sizeof *p->disc);
  p->force   = calloc((size_t)p->count, sizeof *p->force);
  p->held    = calloc((size_t)p->count, 1);
  p->pair    = calloc(3 * (size_t)p->count, sizeof *p->pair);
  p->springs = calloc(3 * (size_t)p->count, sizeof *p->springs);
  if (!p->disc || !p->force || !p->held || !p->pair || !p->springs) return 1;
  for (int row = 0; row <= 2 * columns; row++) {
    const int length = row % 2 ? columns : columns - 1, above = row % 2 ? columns - 1 : columns;
    for (int k = 0; k < length; k++, i++) {
      p->disc[i] = (Disc){spacing * (k + (row % 2 ? 0.5 : 1.0)), spacing * row * 0.8660254037844386, 0, 0, 0, 0};
      p->held[i] = k == 0 || k == length - 1 || row == 0 || row == 2 * columns;
      if (row == 2 * columns) p->disc[i].vy = -6.18e-2;
      if (k + 1 < length) p->pair[p->pairs][0] = (int)i, p->pair[p->pairs++][1] = (int)i + 1;
      for (int up = row % 2 ? k - 1 : k; row < 2 * columns && up <= (row % 2 ? k : k + 1); up++)
        if (up >= 0 && up < above) p->pair[p->pairs][0] = (int)i, p->pair[p->pairs++][1] = (int)(i - k + length + up);
    }
  }
  return 0;
}

int main(int argc, char *argv[])
{
  const int columns = argc > 1 ? atoi(argv[1]) : 100, steps = argc > 2 ? atoi(argv[2]) : 200;
  double    best = 1e300;
  Panel     p    = {0};

  if (columns < 2 || columns > 20000 || Make(&p, columns)) return 1;
  for (int k = 0; k < 5; k++) {
    double t = Now();
    for (int s = 0; s < steps; s++) {
      Forces(&p, 1e-6);
      Move(&p, 1e-6);
    }
    t = Now() - t;
    if (t < best) best = t;
  }
  printf("%.4g\n", (double)p.count * steps / best);
  return 0;
}
