/* The equations of one cell: Eqs. 10 and 11 of Tak, Park & Park (2013), with (T54) to (T58) of docs/theory.md. */
#include "femimpl.h"

static const PetscReal corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};

/* Lagrange's polynomials of -1, 0, 1 at s; `node` in that order. */
static void Quadratic(PetscReal s, PetscInt node, PetscReal *l, PetscReal *dl)
{
  *l  = node == 0 ? 0.5 * s * (s - 1.0) : node == 1 ? 1.0 - s * s : 0.5 * s * (s + 1.0);
  *dl = node == 0 ? s - 0.5 : node == 1 ? -2.0 * s : s + 0.5;
}

static void Bilinear(const PetscReal s[2], PetscReal N[4], PetscReal dN[4][2])
{
  for (int a = 0; a < 4; a++) {
    N[a]     = 0.25 * (1.0 + corner[a][0] * s[0]) * (1.0 + corner[a][1] * s[1]);
    dN[a][0] = 0.25 * corner[a][0] * (1.0 + corner[a][1] * s[1]);
    dN[a][1] = 0.25 * corner[a][1] * (1.0 + corner[a][0] * s[0]);
  }
}

static void Biquadratic(const PetscReal s[2], PetscReal U[PG_FEM_UN], PetscReal dU[PG_FEM_UN][2])
{
  /* corners, middles of the sides, centre: their places among -1, 0, 1 */
  static const PetscInt at[PG_FEM_UN][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0}, {2, 1}, {1, 2}, {0, 1}, {1, 1}};

  for (int a = 0; a < PG_FEM_UN; a++) {
    PetscReal l[2], dl[2];
    for (int d = 0; d < 2; d++) Quadratic(s[d], at[a][d], &l[d], &dl[d]);
    U[a]     = l[0] * l[1];
    dU[a][0] = dl[0] * l[1];
    dU[a][1] = l[0] * dl[1];
  }
}

void PgFemShapeMake(PgFemElement element, PgFemShape *shape)
{
  const PetscReal two[2] = {-1.0 / PetscSqrtReal(3.0), 1.0 / PetscSqrtReal(3.0)}, one[2] = {1.0, 1.0};
  const PetscReal three[3]  = {-PetscSqrtReal(0.6), 0.0, PetscSqrtReal(0.6)};
  const PetscReal weight[3] = {5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
  const PetscBool high      = (PetscBool)(element == PG_FEM_Q2Q1);
  const PetscInt  n         = high ? 3 : 2;

  shape->points = n * n;
  for (PetscInt q = 0; q < n * n; q++) {
    const PetscInt  i = q % n, j = q / n;
    const PetscReal s[2] = {high ? three[i] : two[i], high ? three[j] : two[j]};
    shape->weight[q]     = high ? weight[i] * weight[j] : one[i] * one[j];
    Bilinear(s, shape->N[q], shape->dN[q]);
    if (high) {
      Biquadratic(s, shape->U[q], shape->dU[q]);
      continue;
    }
    for (int a = 0; a < 4; a++) {
      shape->U[q][a] = shape->N[q][a];
      for (int d = 0; d < 2; d++) shape->dU[q][a][d] = shape->dN[q][a][d];
    }
  }
}

void PgFemAtPoint(const PgFemShape *shape, PetscInt un, PetscInt q, const PetscReal x[4][2], PgFemAt *at)
{
  PetscReal F[2][2] = {{0, 0}, {0, 0}}, det, inverse[2][2]; /* F: of x by the unit square */

  at->x[0] = at->x[1] = 0.0;
  for (int a = 0; a < 4; a++)
    for (int i = 0; i < 2; i++) {
      at->x[i] += shape->N[q][a] * x[a][i];
      for (int j = 0; j < 2; j++) F[i][j] += x[a][i] * shape->dN[q][a][j];
    }
  det           = F[0][0] * F[1][1] - F[0][1] * F[1][0];
  at->dV        = det * shape->weight[q];
  inverse[0][0] = F[1][1] / det;
  inverse[1][1] = F[0][0] / det;
  inverse[0][1] = -F[0][1] / det;
  inverse[1][0] = -F[1][0] / det;
  for (int a = 0; a < 4; a++)
    for (int i = 0; i < 2; i++) at->dN[a][i] = shape->dN[q][a][0] * inverse[0][i] + shape->dN[q][a][1] * inverse[1][i];
  for (PetscInt a = 0; a < un; a++)
    for (int i = 0; i < 2; i++) at->dU[a][i] = shape->dU[q][a][0] * inverse[0][i] + shape->dU[q][a][1] * inverse[1][i];
}

static void AddStiffness(const PgFemShape *shape, PetscInt q, PetscInt un, PetscInt dofs, const PgFemCoefficients *c,
                         const PgFemAt *at, PetscReal matrix[])
{
  for (PetscInt a = 0; a < un; a++)
    for (PetscInt b = 0; b < un; b++) {
      const PetscReal *ga = at->dU[a], *gb = at->dU[b];
      const PetscReal  same = c->G * (ga[0] * gb[0] + ga[1] * gb[1]) +
                             c->rho * c->mass * shape->U[q][a] * shape->U[q][b];
      for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
          matrix[(2 * a + i) * dofs + 2 * b + j] += at->dV * (c->lambda * ga[i] * gb[j] + c->G * ga[j] * gb[i] +
                                                              (i == j ? same : 0.0));
    }
}

void PgFemElementMatrix(const PgFemShape *shape, PetscInt un, const PgFemCoefficients *c, const PetscReal x[4][2],
                        PetscReal matrix[], PetscReal schur[16])
{
  const PetscInt  dofs = 2 * un + 4, p = 2 * un;
  const PetscReal s = c->scale, M = c->lambda + 2.0 * c->G;
  PetscReal       mass[4][4] = {{0}}, mean[4] = {0}, volume = 0.0;

  for (PetscInt k = 0; k < dofs * dofs; k++) matrix[k] = 0.0;
  for (PetscInt q = 0; q < shape->points; q++) {
    const PetscReal *N = shape->N[q];
    PgFemAt          at;
    PgFemAtPoint(shape, un, q, x, &at);
    AddStiffness(shape, q, un, dofs, c, &at, matrix);
    for (PetscInt a = 0; a < un; a++)
      for (int i = 0; i < 2; i++)
        for (int j = 0; j < 4; j++) {
          const PetscReal value = -at.dV * c->alpha * at.dU[a][i] * N[j] * s;
          matrix[(2 * a + i) * dofs + p + j] += value;
          matrix[(p + j) * dofs + 2 * a + i] += value;
        }
    volume += at.dV;
    for (int i = 0; i < 4; i++) {
      mean[i] += at.dV * N[i];
      for (int j = 0; j < 4; j++) {
        mass[i][j] += at.dV * N[i] * N[j];
        matrix[(p + i) * dofs + p + j] -= at.dV * c->theta * c->dt * c->D *
                                          (at.dN[i][0] * at.dN[j][0] + at.dN[i][1] * at.dN[j][1]) * s * s;
      }
    }
  }
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      PetscReal *value = &matrix[(p + i) * dofs + p + j];
      *value -= (c->S * mass[i][j] + c->tau * (mass[i][j] - mean[i] * mean[j] / volume)) * s * s;
      schur[4 * i + j] = *value - c->alpha * c->alpha / M * mass[i][j] * s * s;
    }
}

/* Values at a quadrature point. */
typedef struct {
  PetscReal stress[3], div_change; /* total stress xx, yy, xy; alpha times the change of div u */
  PetscReal a[2], p_change, flow[2];
} Values;

static void Evaluate(const PgFemShape *shape, PetscInt q, PetscInt un, const PgFemCoefficients *c, const PgFemAt *at,
                     const PetscReal end[], const PetscReal start[], const PetscReal a[], const PetscReal gravity[2],
                     Values *v)
{
  const PetscInt p    = 2 * un;
  PetscReal      e[3] = {0}, before = 0.0, pressure = 0.0, old = 0.0, grad[2] = {0};

  v->a[0] = v->a[1] = 0.0;
  for (PetscInt k = 0; k < un; k++) {
    const PetscReal *g = at->dU[k];
    e[0] += g[0] * end[2 * k];
    e[1] += g[1] * end[2 * k + 1];
    e[2] += g[1] * end[2 * k] + g[0] * end[2 * k + 1];
    before += g[0] * start[2 * k] + g[1] * start[2 * k + 1];
    for (int i = 0; i < 2 && a; i++) v->a[i] += shape->U[q][k] * a[2 * k + i];
  }
  for (int j = 0; j < 4; j++) {
    pressure += shape->N[q][j] * end[p + j];
    old += shape->N[q][j] * start[p + j];
    for (int i = 0; i < 2; i++) grad[i] += at->dN[j][i] * (c->theta * end[p + j] + (1.0 - c->theta) * start[p + j]);
  }
  v->stress[0]  = c->lambda * (e[0] + e[1]) + 2.0 * c->G * e[0] - c->alpha * pressure;
  v->stress[1]  = c->lambda * (e[0] + e[1]) + 2.0 * c->G * e[1] - c->alpha * pressure;
  v->stress[2]  = c->G * e[2];
  v->div_change = c->alpha * (e[0] + e[1] - before);
  v->p_change   = pressure - old;
  for (int i = 0; i < 2; i++) v->flow[i] = c->D * (-grad[i] + c->rho_f * gravity[i]);
}

void PgFemElementResidual(const PgFemShape *shape, PetscInt un, const PgFemCoefficients *c, const PetscReal x[4][2],
                          const PetscReal end[], const PetscReal start[], const PetscReal a[],
                          const PetscReal gravity[2], PetscReal residual[])
{
  const PetscInt p       = 2 * un;
  PetscReal      mean[4] = {0}, change = 0.0, volume = 0.0;

  for (PetscInt k = 0; k < 2 * un + 4; k++) residual[k] = 0.0;
  for (PetscInt q = 0; q < shape->points; q++) {
    PgFemAt at;
    Values  v;
    PgFemAtPoint(shape, un, q, x, &at);
    Evaluate(shape, q, un, c, &at, end, start, a, gravity, &v);
    for (PetscInt k = 0; k < un; k++) {
      const PetscReal *g = at.dU[k], N = at.dV * c->rho * shape->U[q][k];
      residual[2 * k] += N * (gravity[0] - v.a[0]) - at.dV * (g[0] * v.stress[0] + g[1] * v.stress[2]);
      residual[2 * k + 1] += N * (gravity[1] - v.a[1]) - at.dV * (g[0] * v.stress[2] + g[1] * v.stress[1]);
    }
    volume += at.dV;
    change += at.dV * v.p_change;
    for (int j = 0; j < 4; j++) {
      mean[j] += at.dV * shape->N[q][j];
      residual[p + j] += at.dV * c->scale *
                         (shape->N[q][j] * (v.div_change + (c->S + c->tau) * v.p_change) -
                          c->dt * (at.dN[j][0] * v.flow[0] + at.dN[j][1] * v.flow[1]));
    }
  }
  for (int j = 0; j < 4; j++) residual[p + j] -= c->scale * c->tau * mean[j] * change / volume;
}
