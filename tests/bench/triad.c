/* triad: a = b + s c over arrays that fit no cache, as in STREAM: best GB/s of ten, of CPU time. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

int main(void)
{
  const size_t n = 20000000;
  double      *a = malloc(n * sizeof *a), *b = malloc(n * sizeof *b), *c = malloc(n * sizeof *c), best = 1e300;

  if (!a || !b || !c) return 1;
  for (size_t i = 0; i < n; i++) a[i] = 0.0, b[i] = 1.0, c[i] = (double)i;
  for (int k = 0; k < 10; k++) {
    const clock_t begin = clock();
    for (size_t i = 0; i < n; i++) a[i] = b[i] + 3.0 * c[i];
    const double t = (double)(clock() - begin) / CLOCKS_PER_SEC;
    if (t < best) best = t;
  }
  printf("%.4g %g\n", 3.0 * (double)n * sizeof *a / best * 1e-9, a[n / 2]);
  return 0;
}
