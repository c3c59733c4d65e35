/* The operators: one pass over the row list each, in ascending id of the neighbour. */
#include "sphimpl.h"

/* Loops over the row of disc a: places k, partners col[k]. */
typedef struct {
  const PetscInt  *ptr, *col;
  const PetscReal *g;
} Rows;

static Rows RowsOf(PgSph sph) { return (Rows){sph->list.ptr, sph->list.col, sph->gradient}; }

PG_CLONES PetscErrorCode PgSphGradient(PgSph sph, const PetscReal f[], PetscReal grad[])
{
  const Rows r = RowsOf(sph);
  PetscInt   owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(sph->particles, &owned, NULL, NULL));
  for (PetscInt a = 0; a < owned; a++) {
    const PetscInt  end  = r.ptr[a + 1];
    const PetscReal here = f[a];
    PgReal2         s    = {0, 0};
    for (PetscInt k = r.ptr[a]; k < end; k++) s += PgTwo(r.g, k) * (f[r.col[k]] - here);
    grad[2 * a]     = s[0];
    grad[2 * a + 1] = s[1];
  }
  PetscFunctionReturn(0);
}

PG_CLONES PetscErrorCode PgSphVectorGradient(PgSph sph, const PetscReal u[], PetscReal grad[])
{
  const Rows r = RowsOf(sph);
  PetscInt   owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(sph->particles, &owned, NULL, NULL));
  for (PetscInt a = 0; a < owned; a++) {
    const PetscInt end  = r.ptr[a + 1];
    const PgReal2  here = PgTwo(u, a);
    PgReal2        x = {0, 0}, y = {0, 0};
    for (PetscInt k = r.ptr[a]; k < end; k++) {
      const PgReal2 d = PgTwo(u, r.col[k]) - here, g = PgTwo(r.g, k);
      x += g * d[0];
      y += g * d[1];
    }
    grad[4 * a]     = x[0];
    grad[4 * a + 1] = x[1];
    grad[4 * a + 2] = y[0];
    grad[4 * a + 3] = y[1];
  }
  PetscFunctionReturn(0);
}

PG_CLONES PetscErrorCode PgSphDivergence(PgSph sph, const PetscReal u[], PetscReal div[])
{
  const Rows r = RowsOf(sph);
  PetscInt   owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(sph->particles, &owned, NULL, NULL));
  for (PetscInt a = 0; a < owned; a++) {
    const PetscInt end  = r.ptr[a + 1];
    const PgReal2  here = PgTwo(u, a);
    PgReal2        s    = {0, 0};
    for (PetscInt k = r.ptr[a]; k < end; k++) s += PgTwo(r.g, k) * (PgTwo(u, r.col[k]) - here);
    div[a] = s[0] + s[1];
  }
  PetscFunctionReturn(0);
}

PG_CLONES PetscErrorCode PgSphDivergencesAndGradient(PgSph sph, const PetscReal u[], const PetscReal v[],
                                                     const PetscReal f[], PetscReal div_u[], PetscReal div_v[],
                                                     PetscReal grad_f[])
{
  const Rows r = RowsOf(sph);
  PetscInt   owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(sph->particles, &owned, NULL, NULL));
  for (PetscInt a = 0; a < owned; a++) {
    const PetscInt  end = r.ptr[a + 1];
    const PgReal2   u_a = PgTwo(u, a), v_a = PgTwo(v, a);
    const PetscReal f_a = f[a];
    PgReal2         du = {0, 0}, dv = {0, 0}, df = {0, 0};
    for (PetscInt k = r.ptr[a]; k < end; k++) {
      const PetscInt b = r.col[k];
      const PgReal2  g = PgTwo(r.g, k);
      du += g * (PgTwo(u, b) - u_a);
      dv += g * (PgTwo(v, b) - v_a);
      df += g * (f[b] - f_a);
    }
    div_u[a]          = du[0] + du[1];
    div_v[a]          = dv[0] + dv[1];
    grad_f[2 * a]     = df[0];
    grad_f[2 * a + 1] = df[1];
  }
  PetscFunctionReturn(0);
}

PG_CLONES PetscErrorCode PgSphLaplacian(PgSph sph, const PetscReal f[], PetscReal lap[])
{
  PetscInt owned;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(sph->particles, &owned, NULL, NULL));
  for (PetscInt a = 0; a < owned; a++) {
    PetscReal s = 0.0;
    for (PetscInt k = sph->list.ptr[a]; k < sph->list.ptr[a + 1]; k++)
      s += sph->laplacian[k] * (f[a] - f[sph->list.col[k]]);
    lap[a] = s;
  }
  PetscFunctionReturn(0);
}
