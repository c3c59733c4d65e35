/* Ergun's law for all discs, where most of the drag is computed.

   Built with -fno-math-errno -fno-trapping-math: they let the compiler vectorise the square root and change no value. */
#include "poreimpl.h"

PG_CLONES void PgErgunLoop(PetscInt count, PetscReal viscous, PetscReal inertial, const PgPoreArrays *s,
                           const PetscReal u[], PetscReal F[])
{
  const PetscReal *v = s->v, *n = s->n, *radius = s->radius, *detached = s->detached;

  for (PetscInt a = 0; a < count; a++) {
    const PetscReal rx = v[2 * a] - u[2 * a], ry = v[2 * a + 1] - u[2 * a + 1];
    const PetscReal speed = PetscSqrtReal(rx * rx + ry * ry), k = (1.0 - n[a]) / (n[a] * (2.0 * radius[a]));
    const PetscReal all = k * (viscous * k + inertial * speed), beta = detached[a] != 0.0 ? 0.0 : all;
    F[2 * a]     = beta * rx;
    F[2 * a + 1] = beta * ry;
  }
}
