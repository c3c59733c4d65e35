/* The particles: given one by one, put into the store, first forces. */
#include "wcsphimpl.h"
#include <math.h>

PetscErrorCode PgWcsphDestroyParticles(PgWcsph w)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(w->particle));
  PetscCall(PetscFree(w->particle_id));
  w->kept = w->room = 0;
  PetscFunctionReturn(0);
}

static PetscErrorCode Check(PgWcsph w, PetscInt id, const PgWcsphParticle *p)
{
  PetscFunctionBeginUser;
  PgInputCheck(isfinite(p->x[0]) && isfinite(p->x[1]) && isfinite(p->v[0]) && isfinite(p->v[1]) &&
                   isfinite(p->pressure),
               w->comm, "position, velocity or pressure of particle %" PetscInt_FMT " of the liquid is not finite", id);
  PetscCheck(p->kind == PG_WCSPH_FLUID || p->kind == PG_WCSPH_WALL || p->kind == PG_WCSPH_BODY, w->comm,
             PETSC_ERR_ARG_OUTOFRANGE, "particle %" PetscInt_FMT " has no kind", id);
  PetscCheck(p->body >= 0 && p->index >= 0, w->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "particle %" PetscInt_FMT " has a negative number of its body", id);
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphAddParticles(PgWcsph w, PetscInt count, const PgWcsphParticle particle[])
{
  PetscMPIInt rank, size;

  PetscFunctionBeginUser;
  PetscCheck(!w->set_up, w->comm, PETSC_ERR_ORDER, "particles come before PgWcsphSetUp()");
  PetscCheck(w->dx > 0.0, w->comm, PETSC_ERR_ORDER, "PgWcsphSetSpacing() comes before the particles");
  PetscCallMPI(MPI_Comm_rank(w->comm, &rank));
  PetscCallMPI(MPI_Comm_size(w->comm, &size));
  for (PetscInt i = 0; i < count; i++) {
    const PetscInt id = w->added + i;
    PetscCall(Check(w, id, &particle[i]));
    w->added_bodies += particle[i].kind == PG_WCSPH_BODY;
    if (id % size != rank) continue;
    if (w->kept == w->room) {
      w->room = 2 * w->room + 256;
      PetscCall(PetscRealloc((size_t)w->room * sizeof *w->particle, &w->particle));
      PetscCall(PetscRealloc((size_t)w->room * sizeof *w->particle_id, &w->particle_id));
    }
    w->particle_id[w->kept] = id;
    w->particle[w->kept++]  = particle[i];
  }
  w->added += count;
  PetscFunctionReturn(0);
}

static PetscErrorCode FillStore(PgWcsph w)
{
  PgWcsphArrays f;
  PetscReal    *radius, *start, *m, *kind, *body, *index;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesSetDiscs(w->particles, w->kept, w->particle_id));
  PetscCall(PgWcsphGetArrays(w, &f));
  PetscCall(PgParticlesGetArray(w->particles, PG_RADIUS, &radius));
  PetscCall(PgParticlesGetArray(w->particles, PG_INITIAL_POSITION, &start));
  PetscCall(PgParticlesGetArray(w->particles, PG_MASS, &m));
  PetscCall(PgParticlesGetArray(w->particles, w->kind, &kind));
  PetscCall(PgParticlesGetArray(w->particles, w->body, &body));
  PetscCall(PgParticlesGetArray(w->particles, w->index, &index));
  for (PetscInt i = 0; i < w->kept; i++) {
    const PgWcsphParticle *p = &w->particle[i];
    for (int d = 0; d < 2; d++) {
      f.x[2 * i + d] = start[2 * i + d] = p->x[d];
      f.v[2 * i + d]                    = p->v[d];
    }
    radius[i] = 0.5 * w->dx;
    kind[i]   = (PetscReal)p->kind;
    body[i]   = (PetscReal)p->body;
    index[i]  = (PetscReal)p->index;
    f.rho[i]  = PgWcsphDensityAt(w, p->pressure);
    m[i]      = f.rho[i] * w->dx * w->dx;
  }
  PetscCall(PgWcsphDestroyParticles(w));
  PetscFunctionReturn(0);
}

/* sum V W at a particle of a plane face, of the particles of another whose face lies one spacing away. */
static PetscReal TouchingFaces(PgWcsph w)
{
  const PetscInt reach = (PetscInt)PetscCeilReal(w->kernel->support * w->smoothing);
  PetscReal      sum   = 0.0;

  for (PetscInt j = 1; j <= reach; j++)
    for (PetscInt i = -reach; i <= reach; i++) {
      const PetscReal r = PetscSqrtReal((PetscReal)(i * i + j * j));
      sum += w->kernel->w(r / w->smoothing) / (w->smoothing * w->smoothing);
    }
  return sum;
}

/* Two particles at the same place would not push each other apart. */
static PetscErrorCode RefuseTwins(PgWcsph w)
{
  PgWcsphArrays   f;
  const PetscInt *id;
  PetscInt        twin[2] = {-1, -1};
  PetscReal       x[2]    = {0, 0};
  PetscMPIInt     holder;

  PetscFunctionBeginUser;
  PetscCall(PgWcsphGetArrays(w, &f));
  PetscCall(PgParticlesGetIds(w->particles, &id));
  for (PetscInt a = 0; a < f.owned; a++)
    for (PetscInt k = w->list.ptr[a]; k < w->list.ptr[a + 1]; k++) {
      const PgReal2 d = PgWcsphR(&f, a, w->list.col[k]);
      if (PgDot(d, d) > PetscSqr(1e-3 * w->dx) || (twin[0] >= 0 && id[a] > twin[0])) continue;
      twin[0] = id[a];
      twin[1] = id[w->list.col[k]];
      x[0]    = f.x[2 * a];
      x[1]    = f.x[2 * a + 1];
    }
  PetscCall(PgFindHolder(w->comm, 0.0, twin[0], twin[1], &holder));
  if (holder < 0) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Bcast(twin, 2, MPIU_INT, holder, w->comm));
  PetscCallMPI(MPI_Bcast(x, 2, MPIU_REAL, holder, w->comm));
  PgInputError(w->comm, "particles %" PetscInt_FMT " and %" PetscInt_FMT " are both at (%g, %g) m", twin[0], twin[1],
               (double)x[0], (double)x[1]);
}

PetscErrorCode PgWcsphSetUp(PgWcsph w)
{
  const PetscReal reach = 2.0 * w->kernel->support * w->smoothing; /* in units of the radius dx/2 */

  PetscFunctionBeginUser;
  PetscCheck(!w->set_up && w->dx > 0.0, w->comm, PETSC_ERR_ORDER, "PgWcsphSetUp() comes once, after the particles");
  PgInputCheck(w->added > 0, w->comm, "there are no particles of a liquid");
  w->h     = w->smoothing * w->dx;
  w->onset = TouchingFaces(w);
  PetscCall(FillStore(w));
  PetscCall(PgNeighborsRequestRows(w->neighbors, 0.5 * reach, 0.5 * reach));
  w->set_up = PETSC_TRUE;
  PetscCall(PgWcsphForces(w));
  PetscCall(RefuseTwins(w));
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphGetTimeStep(PgWcsph w, PetscReal *dt)
{
  const PetscReal h = w->smoothing * w->dx, g = PetscSqrtReal(PetscSqr(w->gravity[0]) + PetscSqr(w->gravity[1]));

  PetscFunctionBeginUser;
  *dt = 0.25 * h / w->c_0;
  /* bodies of like density that meet ring as a liquid would with this factor on rho_0 c_0^2 */
  if (w->added_bodies > 0 && w->contact > 1.0) *dt /= PetscSqrtReal(w->contact);
  if (w->mu > 0.0) *dt = PetscMin(*dt, 0.125 * h * h * w->rho_0 / w->mu);
  if (g > 0.0) *dt = PetscMin(*dt, 0.25 * PetscSqrtReal(h / g));
  PetscFunctionReturn(0);
}
