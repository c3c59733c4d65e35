/* Exact solutions of consolidation: Terzaghi's column, Mandel's slab, and the undrained half plane under a strip. */
#pragma once

#include <porograin/fem.h>
#include <math.h>

/* Moduli and the rest by themselves, not by the functions that are tested: M = E (1 - nu)/((1 + nu)(1 - 2 nu)),
   G = E/(2 (1 + nu)), (alpha - n)/K_s + n/K_f, c_v. */
static inline PetscReal ExactM(const PgFemMaterial *m)
{
  return m->E * (1.0 - m->nu) / (1.0 + m->nu) / (1.0 - 2.0 * m->nu);
}
static inline PetscReal ExactG(const PgFemMaterial *m) { return m->E / (2.0 + 2.0 * m->nu); }
static inline PetscReal ExactStorage(const PgFemMaterial *m)
{
  return m->alpha / m->K_s + m->n * (1.0 / m->K_f - 1.0 / m->K_s);
}
static inline PetscReal ExactDiffusivity(const PgFemMaterial *m)
{
  return m->k / (m->mu_f * (ExactStorage(m) + m->alpha * m->alpha / ExactM(m)));
}

/* p/q at depth z/H and T = c_v t/H^2; water and grains as good as incompressible. */
static inline PetscReal TerzaghiPressure(PetscReal z, PetscReal T)
{
  PetscReal sum = 0.0;

  for (int j = 0; j < 400; j++) {
    const PetscReal m = 0.5 * PETSC_PI * (2.0 * j + 1.0);
    sum += 2.0 / m * PetscSinReal(m * z) * PetscExpReal(-m * m * T);
  }
  return sum;
}

/* Settlement over its end q H/M. */
static inline PetscReal TerzaghiSettlement(PetscReal T)
{
  PetscReal sum = 0.0;

  for (int j = 0; j < 400; j++) {
    const PetscReal m = 0.5 * PETSC_PI * (2.0 * j + 1.0);
    sum += 2.0 / (m * m) * PetscExpReal(-m * m * T);
  }
  return 1.0 - sum;
}

/* The load that the water takes at first, and the settlement at first over that in the end, both without lateral strain:
   p_0 = q alpha/(alpha^2 + M S), u_0/u_end = 1 - alpha p_0/q. Then p = p_0 times the series, and the settlement goes from
   u_0 to u_end by its series, with the c_v of compressible constituents (Detournay & Cheng 1993). */
static inline PetscReal TerzaghiFirst(const PgFemMaterial *m)
{
  return m->alpha / (m->alpha * m->alpha + ExactM(m) * ExactStorage(m));
}

/* Undrained Poisson's ratio and Skempton's B. */
static inline void Undrained(const PgFemMaterial *m, PetscReal *nu_u, PetscReal *B)
{
  const PetscReal K = m->E / (3.0 * (1.0 - 2.0 * m->nu)), G = ExactG(m), biot = 1.0 / ExactStorage(m);
  const PetscReal K_u = K + m->alpha * m->alpha * biot;

  *B    = m->alpha * biot / K_u;
  *nu_u = (3.0 * K_u - 2.0 * G) / (2.0 * (3.0 * K_u + G));
}

/* Root j of tan s = ratio s, in (j pi, (j + 1/2) pi), by bisection. */
static inline PetscReal MandelRoot(int j, PetscReal ratio)
{
  PetscReal low = j * PETSC_PI + 1e-9, high = (j + 0.5) * PETSC_PI - 1e-12;

  for (int k = 0; k < 200; k++) {
    const PetscReal s = 0.5 * (low + high);
    /* sin s - ratio s cos s has the sign of tan s - ratio s where cos s keeps its own */
    const PetscReal f = (PetscSinReal(s) - ratio * s * PetscCosReal(s)) * (j % 2 ? -1.0 : 1.0);
    if (f < 0.0)
      low = s;
    else
      high = s;
  }
  return 0.5 * (low + high);
}

/* Pressure at x/a, and way of the plate over its distance from the middle; force F on half a plate, T = c t/a^2. */
static inline void Mandel(const PgFemMaterial *m, PetscReal force, PetscReal a, PetscReal x, PetscReal T,
                          PetscReal *pressure, PetscReal *plate)
{
  PetscReal       nu_u, B, sum = 0.0, way = 0.0;
  const PetscReal G = ExactG(m);

  Undrained(m, &nu_u, &B);
  for (int j = 0; j < 200; j++) {
    const PetscReal s    = MandelRoot(j, (1.0 - m->nu) / (nu_u - m->nu));
    const PetscReal sine = PetscSinReal(s), cosine = PetscCosReal(s), decay = PetscExpReal(-s * s * T);
    sum += sine / (s - sine * cosine) * (PetscCosReal(s * x) - cosine) * decay;
    way += sine * cosine / (s - sine * cosine) * decay;
  }
  *pressure = 2.0 * force * B * (1.0 + nu_u) / (3.0 * a) * sum;
  *plate    = force / (G * a) * (-0.5 * (1.0 - m->nu) + (1.0 - nu_u) * way);
}

/* A half plane y < 0 of an incompressible mixture under a stress q on |x| < b: displacement (G being the shear modulus)
   and pressure = mean stress of the plane, from the line load of Flamant. The displacement of the middle is that of b = 1
   with logarithms of metres. */
static inline void StripSum(PetscReal x, PetscReal depth, PetscReal sign, PetscReal sum[3])
{
  const PetscReal r2 = x * x + depth * depth, log_r2 = r2 > 0.0 ? PetscLogReal(r2) : 0.0;

  sum[0] += sign * 0.5 * depth * log_r2;
  sum[1] += sign * 0.5 * x * log_r2;
  sum[2] += sign * atan2(x, depth);
}

static inline void Strip(PetscReal q, PetscReal b, PetscReal G, const PetscReal x[2], PetscReal u[2], PetscReal *p)
{
  PetscReal sum[3] = {0.0, 0.0, 0.0};

  StripSum(x[0] + b, -x[1], 1.0, sum);
  StripSum(x[0] - b, -x[1], -1.0, sum);
  u[0] = q / (2.0 * PETSC_PI * G) * sum[0];
  u[1] = q / (2.0 * PETSC_PI * G) * sum[1];
  *p   = q / PETSC_PI * sum[2];
}
