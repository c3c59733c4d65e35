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
enum { BLOCK = 64, AHEAD = 128 };
typedef PetscReal Vector __attribute__((vector_size(2 * sizeof(PetscReal)), aligned(sizeof(PetscReal)), may_alias));
typedef struct {
  Vector    x[BLOCK], u[BLOCK]; /* x_j - x_a, v_a - v_j */
  PetscReal r_a[BLOCK], r_j[BLOCK], w_a[BLOCK], w_j[BLOCK];
} Block;

/* Works on both coordinates at once. Written for a vector type because gcc would otherwise turn eight pairs at a time
   into wide vectors, and spend more on that than the subtractions cost. Of two discs in the order along the curve, the
   later one is rarely where the processor expects it: in a large packing it is asked for `ahead` pairs before. */
static inline __attribute__((always_inline)) void Gather(PetscInt n, const PetscInt low[], const PetscInt high[],
                                                         PetscInt ahead, const PgDemDiscs *discs, Block *b)
{
  const Vector *PETSC_RESTRICT x = (const Vector *)discs->position, *PETSC_RESTRICT v = (const Vector *)discs->velocity;
  const PetscReal *PETSC_RESTRICT w = discs->spin, *PETSC_RESTRICT r = discs->radius;

  for (PetscInt k = 0; k < n; k++) {
    const PetscInt a = low[k], j = high[k], later = PetscMax(low[k + ahead], high[k + ahead]);

    __builtin_prefetch(&x[later]);
    __builtin_prefetch(&v[later]);
    __builtin_prefetch(&w[later]);
    __builtin_prefetch(&r[later]);
    b->x[k]   = x[j] - x[a];
    b->u[k]   = v[a] - v[j];
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
    const PetscReal  dx = b->x[k][0], dy = b->x[k][1], ux = b->u[k][0], uy = b->u[k][1];
    const PetscReal  d = PgDemLength(dx, dy), e = 1 / d;
    const PetscReal  nx = dx * e, ny = dy * e;
    const PetscReal  spin = b->r_a[k] * b->w_a[k] + b->r_j[k] * b->w_j[k];
    PgContactMotion  motion;
    PgContactHistory h = {f_s[k], f_r[k], m_r[k]};
    PgContactForce   f;

    motion.overlap      = (b->r_a[k] + b->r_j[k]) - d;
    motion.overlap_rate = ux * nx + uy * ny;
    motion.sliding_rate = (uy * nx - ux * ny) + spin;
    motion.rolling_rate = -spin;
    motion.spin_rate    = b->w_a[k] - b->w_j[k];
    motion.R            = 0; /* not read by this law */
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
                                                       PetscInt first, PetscInt end, PetscBool energy)
{
  const PgContactParameters p = *parameters;
  Block                     block;

  for (; first + BLOCK <= end; first += BLOCK) {
    const PetscInt ahead = PetscMin(AHEAD, list->padded - BLOCK - first);

    Gather(BLOCK, list->low + first, list->high + first, ahead, discs, &block);
    Law(BLOCK, &p, dt, &block, pairs->f_s + first, pairs->f_r + first, pairs->m_r + first, pairs->result + 4 * first,
        energy ? pairs->lost + PG_LOST * first : NULL);
  }
  if (first < end) {
    const PetscInt rest = end - first;
    Gather(rest, list->low + first, list->high + first, 0, discs, &block);
    Law(rest, &p, dt, &block, pairs->f_s + first, pairs->f_r + first, pairs->m_r + first, pairs->result + 4 * first,
        energy ? pairs->lost + PG_LOST * first : NULL);
  }
}

PG_CLONES
void PgDemContactLoopLi2007(const PgContactParameters *parameters, const PgContactList *list, const PgDemDiscs *discs,
                            PetscReal dt, const PgDemPairs *pairs, PetscInt first, PetscInt end)
{
  Loop(parameters, list, discs, dt, pairs, first, end, PETSC_FALSE);
}

/* A separate instance, so that runs without energy accounts do not pay for them. */
PG_CLONES
void PgDemContactLoopEnergyLi2007(const PgContactParameters *parameters, const PgContactList *list,
                                  const PgDemDiscs *discs, PetscReal dt, const PgDemPairs *pairs, PetscInt first,
                                  PetscInt end)
{
  Loop(parameters, list, discs, dt, pairs, first, end, PETSC_TRUE);
}
