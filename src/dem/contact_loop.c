/* The contact law of all pairs of the list: the loop in which a dry run spends most of its time.

   The build compiles this file with -O3 -fno-math-errno -fno-trapping-math -ffp-contract=off, so that gcc
   turns the loop into vector instructions. None of these changes a value: -fno-math-errno only drops the
   call that would set errno for a negative root (there is none), -fno-trapping-math only lets both sides of
   a choice be computed before choosing (both are finite here), -ffp-contract=off keeps the machine from
   joining a product and a sum into one rounding. Addition order is as written: no -ffast-math.

   On x86-64, gcc compiles the functions for wider vectors, too, and the dynamic linker picks (PG_CLONES). */
#include "demimpl.h"

/* The motion of a block of pairs, gathered from the discs one by one into short arrays that stay in the
   first-level cache, so that the arithmetic works on contiguous data. */
enum { BLOCK = 64 };
typedef struct {
  PetscReal dx[BLOCK], dy[BLOCK]; /* x_j - x_a */
  PetscReal ux[BLOCK], uy[BLOCK]; /* v_a - v_j */
  PetscReal r_a[BLOCK], r_j[BLOCK], w_a[BLOCK], w_j[BLOCK];
} Block;

static inline __attribute__((always_inline)) void Gather(PetscInt n, const PetscInt low[], const PetscInt high[],
                                                         const PgDemDiscs *discs, Block *b)
{
  const PetscReal *PETSC_RESTRICT x = discs->position, *PETSC_RESTRICT v = discs->velocity;
  const PetscReal *PETSC_RESTRICT w = discs->spin, *PETSC_RESTRICT r = discs->radius;

  for (PetscInt k = 0; k < n; k++) {
    const PetscInt a = low[k], j = high[k];

    b->dx[k]  = x[2 * j] - x[2 * a];
    b->dy[k]  = x[2 * j + 1] - x[2 * a + 1];
    b->ux[k]  = v[2 * a] - v[2 * j];
    b->uy[k]  = v[2 * a + 1] - v[2 * j + 1];
    b->r_a[k] = r[a];
    b->r_j[k] = r[j];
    b->w_a[k] = w[a];
    b->w_j[k] = w[j];
  }
}

static inline __attribute__((always_inline)) void Law(PetscInt n, const PgContactParameters *p, PetscReal dt,
                                                      const Block *b, PetscReal *PETSC_RESTRICT f_s,
                                                      PetscReal *PETSC_RESTRICT f_r, PetscReal *PETSC_RESTRICT m_r,
                                                      PetscReal *PETSC_RESTRICT result, PetscReal *PETSC_RESTRICT lost)
{
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal  d = PgDemLength(b->dx[k], b->dy[k]), e = 1 / d;
    const PetscReal  nx = b->dx[k] * e, ny = b->dy[k] * e;
    const PetscReal  spin = b->r_a[k] * b->w_a[k] + b->r_j[k] * b->w_j[k];
    PgContactMotion  motion;
    PgContactHistory h = {f_s[k], f_r[k], m_r[k]};
    PgContactForce   f;

    motion.overlap      = (b->r_a[k] + b->r_j[k]) - d;
    motion.overlap_rate = b->ux[k] * nx + b->uy[k] * ny;
    motion.sliding_rate = (b->uy[k] * nx - b->ux[k] * ny) + spin;
    motion.rolling_rate = -spin;
    motion.spin_rate    = b->w_a[k] - b->w_j[k];
    f                   = PgLi2007(p, &motion, dt, &h, lost ? &lost[PG_LOST * k] : NULL);
    f_s[k]              = h.f_s;
    f_r[k]              = h.f_r;
    m_r[k]              = h.m_r;
    result[4 * k]       = f.F_N * nx - f.F_T * ny;
    result[4 * k + 1]   = f.F_N * ny + f.F_T * nx;
    result[4 * k + 2]   = b->r_a[k] * f.F_T + f.M_r;
    result[4 * k + 3]   = b->r_j[k] * f.F_T - f.M_r;
  }
}

static inline __attribute__((always_inline)) void Loop(const PgContactParameters *parameters, const PgContactList *list,
                                                       const PgDemDiscs *discs, PetscReal dt, const PgDemPairs *pairs,
                                                       PetscBool energy)
{
  const PgContactParameters p = *parameters;
  Block                     block;
  PetscInt                  first = 0;

  for (; first + BLOCK <= list->padded; first += BLOCK) {
    Gather(BLOCK, list->low + first, list->high + first, discs, &block);
    Law(BLOCK, &p, dt, &block, pairs->f_s + first, pairs->f_r + first, pairs->m_r + first, pairs->result + 4 * first,
        energy ? pairs->lost + PG_LOST * first : NULL);
  }
  if (first < list->padded) {
    const PetscInt rest = list->padded - first;
    Gather(rest, list->low + first, list->high + first, discs, &block);
    Law(rest, &p, dt, &block, pairs->f_s + first, pairs->f_r + first, pairs->m_r + first, pairs->result + 4 * first,
        energy ? pairs->lost + PG_LOST * first : NULL);
  }
}

PG_CLONES
void PgDemContactLoopLi2007(const PgContactParameters *parameters, const PgContactList *list, const PgDemDiscs *discs,
                            PetscReal dt, const PgDemPairs *pairs)
{
  Loop(parameters, list, discs, dt, pairs, PETSC_FALSE);
}

/* A separate instance, so that runs without energy accounts do not pay for them. */
PG_CLONES
void PgDemContactLoopEnergyLi2007(const PgContactParameters *parameters, const PgContactList *list,
                                  const PgDemDiscs *discs, PetscReal dt, const PgDemPairs *pairs)
{
  Loop(parameters, list, discs, dt, pairs, PETSC_TRUE);
}
