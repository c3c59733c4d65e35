/* Quadrilaterals with four nodes, Eqs. 40-42: shape functions, masses, internal forces, and the surface integrals of
   pressure, Eqs. 43-46. */
#include "bodiesimpl.h"
#include <math.h>

static const PetscReal gauss = 0.57735026918962576451;

void PgBodyShape(PetscReal xi, PetscReal eta, PetscReal N[4], PetscReal dN[8])
{
  static const PetscReal sx[4] = {-1, 1, 1, -1}, sy[4] = {-1, -1, 1, 1};

  for (int i = 0; i < 4; i++) {
    N[i] = 0.25 * (1 + sx[i] * xi) * (1 + sy[i] * eta);
    if (!dN) continue;
    dN[2 * i]     = 0.25 * sx[i] * (1 + sy[i] * eta);
    dN[2 * i + 1] = 0.25 * sy[i] * (1 + sx[i] * xi);
  }
}

/* Place and derivatives by (xi, eta) of a cell as it was added; returns det J. */
static PetscReal Map(const PgBody *b, PetscInt cell, PetscReal xi, PetscReal eta, PetscReal N[4], PetscReal dN[8],
                     PetscReal x[2], PetscReal J[4])
{
  PgBodyShape(xi, eta, N, dN);
  x[0] = x[1] = J[0] = J[1] = J[2] = J[3] = 0;
  for (int i = 0; i < 4; i++) {
    const PetscReal *X = &b->X[2 * b->cell[4 * cell + i]];
    for (int d = 0; d < 2; d++) {
      x[d] += N[i] * X[d];
      J[2 * d] += dN[2 * i] * X[d];
      J[2 * d + 1] += dN[2 * i + 1] * X[d];
    }
  }
  return J[0] * J[3] - J[1] * J[2];
}

PetscBool PgBodyLocate(const PgBody *b, PetscInt cell, const PetscReal x[2], PetscReal N[4])
{
  PetscReal xi = 0, eta = 0;

  for (int k = 0; k < 25; k++) {
    PetscReal       dN[8], at[2], J[4];
    const PetscReal det = Map(b, cell, xi, eta, N, dN, at, J), rx = x[0] - at[0], ry = x[1] - at[1];

    xi += (J[3] * rx - J[1] * ry) / det;
    eta += (J[0] * ry - J[2] * rx) / det;
    if (PetscAbsReal(xi) > 4 || PetscAbsReal(eta) > 4) return PETSC_FALSE;
  }
  PgBodyShape(xi, eta, N, NULL);
  /* a point on an edge, but for rounding, is inside */
  return (PetscBool)(PetscAbsReal(xi) <= 1 + 1e-9 && PetscAbsReal(eta) <= 1 + 1e-9);
}

/* Derivatives of N_s by place at point `q` of Gauss, and the area that it stands for. */
static PetscReal Gradient(const PgBody *b, PetscInt cell, int q, PetscReal dNdX[8])
{
  PetscReal       N[4], dN[8], x[2], J[4];
  const PetscReal xi = q % 2 ? gauss : -gauss, eta = q / 2 ? gauss : -gauss;
  const PetscReal det = Map(b, cell, xi, eta, N, dN, x, J);

  for (int i = 0; i < 4; i++) {
    dNdX[2 * i]     = (J[3] * dN[2 * i] - J[2] * dN[2 * i + 1]) / det;
    dNdX[2 * i + 1] = (J[0] * dN[2 * i + 1] - J[1] * dN[2 * i]) / det;
  }
  return det;
}

/* Largest eigenvalue of M^-1 K of a cell, at most: row sums (Gershgorin). The largest of all cells bounds that of the
   whole, each node's mass being the sum of what its cells give it (Irons). */
static PetscReal Stiffest(const PgBody *b, PetscInt cell, const PetscReal m[4])
{
  PetscReal K[8][8] = {{0}}, most = 0;

  for (int q = 0; q < 4; q++) {
    PetscReal       g[8];
    const PetscReal dV = Gradient(b, cell, q, g);
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++) {
        const PetscReal dot = g[2 * i] * g[2 * j] + g[2 * i + 1] * g[2 * j + 1];
        for (int c = 0; c < 2; c++)
          for (int d = 0; d < 2; d++)
            K[2 * i + c][2 * j + d] += dV * (b->lambda * g[2 * i + c] * g[2 * j + d] +
                                             b->G * (g[2 * i + d] * g[2 * j + c] + (c == d ? dot : 0)));
      }
  }
  for (int r = 0; r < 8; r++) {
    PetscReal sum = 0;
    for (int s = 0; s < 8; s++) sum += PetscAbsReal(K[r][s]);
    most = PetscMax(most, sum / m[r / 2]);
  }
  return most;
}

static PetscBool Convex(PgBody *b, PetscInt cell)
{
  PetscInt *c = &b->cell[4 * cell];

  for (int again = 0; again < 2; again++) {
    int left = 0, right = 0;
    for (int i = 0; i < 4; i++) {
      const PetscReal *p = &b->X[2 * c[i]], *q = &b->X[2 * c[(i + 1) % 4]], *r = &b->X[2 * c[(i + 2) % 4]];
      const PetscReal  turn = (q[0] - p[0]) * (r[1] - q[1]) - (q[1] - p[1]) * (r[0] - q[0]);
      left += turn > 0;
      right += turn < 0;
    }
    if (left == 4) return PETSC_TRUE;
    if (right != 4) return PETSC_FALSE;
    { /* the other way around */
      const PetscInt second = c[1];
      c[1]                  = c[3];
      c[3]                  = second;
    }
  }
  return PETSC_FALSE;
}

PetscBool PgBodyPrepare(PgBody *b, PetscInt *cell)
{
  PetscReal moment[2] = {0, 0}, second = 0, most = 0;

  for (PetscInt e = 0; e < b->cells; e++) {
    PetscReal m[4] = {0, 0, 0, 0};

    *cell = e;
    if (!Convex(b, e)) return PETSC_FALSE;
    for (int q = 0; q < 4; q++) {
      PetscReal       N[4], dN[8], x[2], J[4];
      const PetscReal dm = b->rho * Map(b, e, q % 2 ? gauss : -gauss, q / 2 ? gauss : -gauss, N, dN, x, J);

      b->mass += dm;
      for (int d = 0; d < 2; d++) moment[d] += dm * x[d];
      second += dm * (x[0] * x[0] + x[1] * x[1]);
      for (int i = 0; i < 4; i++) m[i] += dm * N[i];
    }
    for (int i = 0; i < 4; i++) b->m[b->cell[4 * e + i]] += m[i];
    most = PetscMax(most, Stiffest(b, e, m));
  }
  for (int d = 0; d < 2; d++) b->X_c[d] = moment[d] / b->mass;
  b->inertia = second - b->mass * (b->X_c[0] * b->X_c[0] + b->X_c[1] * b->X_c[1]);
  b->limit   = b->kind == PG_BODY_RIGID ? PETSC_MAX_REAL : 2 / PetscSqrtReal(most);
  return PETSC_TRUE;
}

/* Stress S of a strain (xx, yy, xy), C_T of plane strain; returns the energy density. */
static PetscReal Stress(const PgBody *b, const PetscReal e[3], PetscReal S[3])
{
  const PetscReal trace = b->lambda * (e[0] + e[1]);

  S[0] = trace + 2 * b->G * e[0];
  S[1] = trace + 2 * b->G * e[1];
  S[2] = 2 * b->G * e[2];
  return 0.5 * (S[0] * e[0] + S[1] * e[1] + 2 * S[2] * e[2]);
}

void PgBodyInternalForces(PgBody *b)
{
  for (PetscInt i = 0; i < 2 * b->nodes; i++) b->f[i] = 0;
  b->elastic = 0;
  for (PetscInt cell = 0; cell < b->cells; cell++) {
    const PetscInt *node = &b->cell[4 * cell];
    for (int q = 0; q < 4; q++) {
      PetscReal       g[8], H[4] = {0, 0, 0, 0}, e[3], S[3], P[4];
      const PetscReal dV = Gradient(b, cell, q, g);

      for (int i = 0; i < 4; i++)
        for (int c = 0; c < 2; c++) {
          const PetscReal u = b->x[2 * node[i] + c] - b->X[2 * node[i] + c];
          H[2 * c] += u * g[2 * i];
          H[2 * c + 1] += u * g[2 * i + 1];
        }
      e[0] = H[0];
      e[1] = H[3];
      e[2] = 0.5 * (H[1] + H[2]);
      if (b->kind == PG_BODY_FINITE) {
        e[0] += 0.5 * (H[0] * H[0] + H[2] * H[2]);
        e[1] += 0.5 * (H[1] * H[1] + H[3] * H[3]);
        e[2] += 0.5 * (H[0] * H[1] + H[2] * H[3]);
      } else {
        H[0] = H[1] = H[2] = H[3] = 0;
      }
      b->elastic += dV * Stress(b, e, S);
      P[0] = (1 + H[0]) * S[0] + H[1] * S[2]; /* (1 + H) S */
      P[1] = (1 + H[0]) * S[2] + H[1] * S[1];
      P[2] = H[2] * S[0] + (1 + H[3]) * S[2];
      P[3] = H[2] * S[2] + (1 + H[3]) * S[1];
      for (int i = 0; i < 4; i++)
        for (int c = 0; c < 2; c++) b->f[2 * node[i] + c] -= dV * (P[2 * c] * g[2 * i] + P[2 * c + 1] * g[2 * i + 1]);
    }
  }
}

/* Eqs. 43-46 from -1 to 1 with the normal n into the body: h_d l/6 (2 p_a + p_b) n and its like. */
void PgBodyPressureForces(const PgBody *b, const PetscReal p[], PetscReal force[])
{
  for (PetscInt e = 0; e < b->edges; e++) {
    const PetscInt  i = b->edge[2 * e], j = b->edge[2 * e + 1];
    const PetscReal ln[2] = {b->x[2 * i + 1] - b->x[2 * j + 1], b->x[2 * j] - b->x[2 * i]};

    for (int d = 0; d < 2; d++) {
      force[2 * i + d] += ln[d] * (2 * p[i] + p[j]) / 6;
      force[2 * j + d] += ln[d] * (p[i] + 2 * p[j]) / 6;
    }
  }
}
