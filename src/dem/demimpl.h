/* dem, private: the struct behind PgDem and what its files share. */
#pragma once

#include <porograin/dem.h>
#include <float.h>

/* State of the discs that the contact law reads; ghosts included. */
typedef struct {
  const PetscReal *position; /* (2) [m] */
  const PetscReal *velocity; /* (2) [m/s] */
  const PetscReal *spin;     /* [rad/s] */
  const PetscReal *radius;   /* [m] */
} PgDemDiscs;

/* What is kept by pair of the contact list, padding included. */
typedef struct {
  PetscReal *f_s, *f_r, *m_r; /* PgContactHistory as one array each */
  PetscReal *result;          /* (4) force on low (x, y) [N/m], torque on low, torque on high [N] */
} PgDemPairs;

/* A contact law: of one pair, and of all pairs [0, list->padded) at once with the same bits. */
typedef struct {
  const char *name, *citation;
  PgContactForce (*pair)(const PgContactParameters *parameters, const PgContactMotion *motion, PetscReal dt,
                         PgContactHistory *history);
  void (*loop)(const PgContactParameters *parameters, const PgContactList *list, const PgDemDiscs *discs, PetscReal dt,
               const PgDemPairs *pairs);
} PgContactLaw;

struct PgDem_s {
  PgParticles         particles;
  PgNeighbors         neighbors;
  const PgContactLaw *law;
  PgContactParameters parameters;
  PetscReal           local_damping;  /* alpha of Cundall's local damping [1] */
  PetscReal           global_damping; /* viscous, by mass [1/s] */
  PetscReal           plate_friction; /* of plates that do not say [1] */
  PetscReal           guard_overlap;  /* largest overlap over the smaller radius [1] */
  PetscReal           guard_speed;    /* [m/s] */
  PetscReal           gravity[2];     /* [m/s2] */

  PgField  force, torque, fluid_force, external_force;
  PgField  plate, plate_spring, plate_reaction;
  PgField  coordination, stress, share;
  PgRagged history;

  PetscInt   pair_room;      /* pairs the arrays have room for */
  PetscInt   lists;          /* revision of the lists the arrays belong to; -1: none yet */
  PetscBool  pairs_computed; /* result belongs to the present positions */
  PgDemPairs pairs;

  PetscInt  plate_count, plate_room;
  PgPlate  *plates;
  PetscInt  plate_disc_count, plate_disc_room;
  PetscInt *plate_disc;       /* owned discs on plates, ascending local index */
  PetscInt  plate_discs_made; /* revision of the particles when the list was made; -1: to be made */

  PetscInt   work_room, offset_room;
  PetscReal *work; /* scratch of the calls that are not in every step */
  PetscInt  *offset;
};

/* Both discs of a pair count as touching, for the coordination number and the critical time step: a
   packing laid out exactly in contact must count as such whatever the rounding of its coordinates. The
   law itself (Eqs. 8, 9) asks for overlap > 0. */
static inline PetscBool PgDemTouching(PetscReal overlap, PetscReal r_a, PetscReal r_j)
{
  return (PetscBool)(overlap > -1e-9 * PetscMin(r_a, r_j));
}

/* Length of a vector, never 0: the smallest normal number is lost in the square of any length that a radius
   can be told from, and gives the zero vector a direction 0 instead of a division by zero. Written as a sum
   because a compiler may move a division in front of the choice that guards it. */
static inline PetscReal PgDemLength(PetscReal x, PetscReal y)
{
#if defined(PETSC_USE_REAL_SINGLE)
  return PetscSqrtReal((x * x + y * y) + FLT_MIN);
#else
  return PetscSqrtReal((x * x + y * y) + DBL_MIN);
#endif
}

/* n from low to high [1] and overlap [m] of a pair, with the bits of the contact loop. Coincident centres
   have no direction: n = 0, hence no force; the guard reports such an overlap. */
static inline PetscReal PgDemPairGeometry(const PgDemDiscs *discs, PetscInt a, PetscInt j, PetscReal n[2])
{
  const PetscReal dx = discs->position[2 * j] - discs->position[2 * a];
  const PetscReal dy = discs->position[2 * j + 1] - discs->position[2 * a + 1];
  const PetscReal d = PgDemLength(dx, dy), e = 1 / d;

  n[0] = dx * e;
  n[1] = dy * e;
  return (discs->radius[a] + discs->radius[j]) - d;
}

/* The law in the form both the public function and the loop are made of: operations without branches,
   in one order. */
static inline PetscReal PgLi2007Clamp(PetscReal value, PetscReal cap)
{
  const PetscReal upper = value > cap ? cap : value;
  return upper < -cap ? -cap : upper;
}

/* Eqs. 3-6 and 12-15: elastic part advanced, viscous part added, the sum capped. A capped spring keeps
   what stands with the viscous part exactly at the cap. Nothing is left without contact. */
static inline PetscReal PgLi2007Friction(PetscReal k, PetscReal c, PetscReal rate, PetscReal dt, PetscReal cap,
                                         PetscReal overlap, PetscReal *elastic)
{
  const PetscReal trial   = *elastic - k * (rate * dt);
  const PetscReal viscous = -c * rate;
  const PetscReal total   = trial + viscous;
  const PetscReal capped  = PgLi2007Clamp(total, cap);
  const PetscReal kept    = capped == total ? trial : capped - viscous;

  *elastic = overlap > 0 ? kept : 0;
  return overlap > 0 ? capped : 0;
}

static inline PgContactForce PgLi2007(const PgContactParameters *p, const PgContactMotion *m, PetscReal dt,
                                      PgContactHistory *h)
{
  PgContactForce  f;
  const PetscReal u        = m->overlap;
  const PetscReal pressing = -(p->k_n * u) - p->c_n * m->overlap_rate; /* Eq. 8 */
  const PetscReal clipped  = pressing < 0 ? pressing : 0;              /* never tensile */
  PetscReal       F_s, F_r, N;

  f.F_N = u > 0 ? clipped : 0; /* Eq. 9 */
  N     = -f.F_N;
  F_s   = PgLi2007Friction(p->k_s, p->c_s, m->sliding_rate, dt, p->mu_s * N, u, &h->f_s);
  F_r   = PgLi2007Friction(p->k_r, p->c_r, m->rolling_rate, dt, p->mu_r * N, u, &h->f_r);
  f.M_r = PgLi2007Friction(p->k_theta, p->c_theta, m->spin_rate, dt, p->mu_theta_r * N, u, &h->m_r);
  f.F_T = PgLi2007Clamp(F_s + F_r, p->mu_s * N); /* Eqs. 11, 16, 17 */
  return f;
}

PETSC_INTERN void PgDemContactLoopLi2007(const PgContactParameters *parameters, const PgContactList *list,
                                         const PgDemDiscs *discs, PetscReal dt, const PgDemPairs *pairs);
/* The registered laws, ended by an entry without name. */
PETSC_INTERN const PgContactLaw PgContactLaws[];

PETSC_INTERN PetscErrorCode PgDemGetDiscs_Private(PgDem dem, PgDemDiscs *discs);
/* The contact list, if history has been restored for it; an error otherwise. */
PETSC_INTERN PetscErrorCode PgDemGetContacts_Private(PgDem dem, PgContactList *list);
/* Makes the list of owned discs on plates if it is stale, and imposes the motion of the plates on them. */
PETSC_INTERN PetscErrorCode PgDemImposePlates_Private(PgDem dem);
PETSC_INTERN PetscErrorCode PgDemUpdatePlateDiscs_Private(PgDem dem);
/* Friction coefficient of a plate, its own or the default. */
PETSC_INTERN PetscReal PgDemPlateFriction_Private(PgDem dem, const PgPlate *plate);
/* dem->work with room for `count` reals. */
PETSC_INTERN PetscErrorCode PgDemGetWork_Private(PgDem dem, PetscInt count, PetscReal **work);
/* Sum of `count` values on each rank, the same bits on any number of ranks. Collective. */
PETSC_INTERN PetscErrorCode PgDemSum_Private(MPI_Comm comm, PetscInt count, const PetscReal value[], PetscReal *sum);
