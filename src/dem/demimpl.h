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
  PetscReal *lost;            /* (PG_LOST) as the law gives it; NULL without energy accounts */
} PgDemPairs;

/* A wall with what is kept about it. */
typedef struct {
  PgWall    wall;
  PetscReal start[2];  /* its point when it was added [m] */
  PetscReal listed[2]; /* its point when the wall contacts were listed [m] */
  PetscInt  servo;     /* number among the servo walls, -1: none */
} PgDemWall;

/* An owned disc near a wall. */
typedef struct {
  PetscInt         disc, wall; /* local index, wall index */
  PgContactHistory history;
  PgContactForce   force;   /* on the disc, at the last evaluation */
  PetscReal        lost[4]; /* as the law gives it */
} PgWallContact;
enum { PG_WALL_RECORD = 7 }; /* reals of one in "wall_history" */

/* A contact law: of one pair, and of the pairs [first, end) of a list at once with the same bits. `lost` is the energy taken
   in the step by the caps of sliding, rolling and moment, and a part of it (negative) that is to be taken off what the
   dashpots get when they are credited with their force times the whole rate [J/m]; NULL: not wanted. The second loop
   fills it, the first does not. */
enum { PG_LOST = 4 };
typedef void PgContactLoop(const PgContactParameters *parameters, const PgContactList *list, const PgDemDiscs *discs,
                           PetscReal dt, const PgDemPairs *pairs, PetscInt first, PetscInt end);
typedef struct {
  const char *name, *citation;
  PgContactForce (*pair)(const PgContactParameters *parameters, const PgContactMotion *motion, PetscReal dt,
                         PgContactHistory *history, PetscReal lost[]);
  PgContactLoop *loop, *loop_energy; /* loop_energy NULL: energy accounts are not kept with this law */
  /* dF_N/du_N at an overlap [N/m]; NULL: k_n, and rolling is part of the law */
  PetscReal (*stiffness)(const PgContactParameters *parameters, PetscReal overlap, PetscReal R);
} PgContactLaw;

struct PgDem_s {
  PgParticles         particles;
  PgNeighbors         neighbors;
  const PgContactLaw *law;
  PgContactParameters parameters;
  PetscReal           local_damping;   /* alpha of Cundall's local damping [1] */
  PetscReal           global_damping;  /* viscous, by mass [1/s] */
  PetscReal           plate_friction;  /* of plates that do not say [1] */
  PetscReal           wall_friction;   /* of walls that do not say [1]; < 0: that of the discs */
  PetscReal           servo_gain;      /* part of the missing force that a servo wall makes up for in a step [1] */
  PetscReal           guard_overlap;   /* largest overlap over the smaller radius [1] */
  PetscReal           guard_speed;     /* [m/s] */
  PetscReal           guard_time_step; /* largest time step over the critical one [1] */
  PetscReal           guard_domain[4]; /* x low, x high, y low, y high that no centre may leave [m] */
  PetscReal           gravity[2];      /* [m/s2] */

  PgField  force, torque, fluid_force, external_force;
  PgField  plate, plate_spring, plate_reaction;
  PgField  coordination, stress, share;
  PgRagged history;

  PetscBool energy; /* accounts are kept, in these fields */
  PgField   energy_account, energy_force, friction_energy;

  PetscInt   pair_room;      /* pairs the arrays have room for */
  PetscInt   lists;          /* revision of the lists the arrays belong to; -1: none yet */
  PetscBool  pairs_computed; /* result belongs to the present positions */
  PgDemPairs pairs;

  PetscInt  plate_count, plate_room;
  PgPlate  *plates;
  PetscInt  plate_disc_count, plate_disc_room;
  PetscInt *plate_disc;       /* owned discs on plates, ascending local index */
  PetscInt  plate_discs_made; /* revision of the particles when the list was made; -1: to be made */

  PetscInt       wall_count, wall_room;
  PgDemWall    **walls;
  PgRagged       wall_history; /* registered with the first wall */
  PetscInt       wall_contact_count, wall_contact_room, wall_spare_room;
  PgWallContact *wall_contact, *wall_spare; /* by ascending local index of the disc, then by wall; scratch */
  PetscInt       wall_lists;                /* revision of the particles that its local indices belong to; -1: none */
  PetscBool      walls_changed;             /* set by calls: list anew */
  PetscInt       servo_count, servo_room;
  PgExactSum    *servo_sum; /* (2) by servo wall: normal force, number of contacts; scratch */
  PetscReal     *servo_value;

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

#if defined(PETSC_USE_REAL_SINGLE)
  #define PG_SMALLEST FLT_MIN
#else
  #define PG_SMALLEST DBL_MIN
#endif

/* Length of a vector, never 0: the smallest normal number is lost in the square of any length that a radius
   can be told from, and gives the zero vector a direction 0 instead of a division by zero. Written as a sum
   because a compiler may move a division in front of the choice that guards it. */
static inline PetscReal PgDemLength(PetscReal x, PetscReal y) { return PetscSqrtReal((x * x + y * y) + PG_SMALLEST); }

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

/* Overlap of a disc with a wall [m]. */
static inline PetscReal PgDemWallOverlap(const PgWall *wall, const PetscReal x[2], PetscReal r)
{
  return r - ((x[0] - wall->point[0]) * wall->normal[0] + (x[1] - wall->point[1]) * wall->normal[1]);
}

/* Kinetic energy of a disc [J/m], I = m r^2/2. */
static inline PetscReal PgDemDiscKinetic(const PgDemDiscs *discs, const PetscReal m[], PetscInt i)
{
  const PetscReal *v = &discs->velocity[2 * i], spin = discs->radius[i] * discs->spin[i];

  return 0.5 * m[i] * (v[0] * v[0] + v[1] * v[1] + 0.5 * spin * spin);
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
static inline __attribute__((always_inline)) PetscReal PgLi2007Friction(PetscReal k, PetscReal c, PetscReal rate,
                                                                        PetscReal dt, PetscReal cap, PetscReal overlap,
                                                                        PetscReal *elastic, PetscReal lost[],
                                                                        PetscInt which)
{
  const PetscReal before  = *elastic;
  const PetscReal trial   = before - k * (rate * dt);
  const PetscReal viscous = -c * rate;
  const PetscReal total   = trial + viscous;
  const PetscReal capped  = PgLi2007Clamp(total, cap);
  const PetscReal kept    = capped == total ? trial : capped - viscous;
  const PetscReal stores  = k > 0 ? 1 : 0; /* nothing is left in a spring that is not there */
  const PetscReal after   = overlap > 0 ? stores * kept : 0;

  if (lost) { /* force times slip (trial - after)/k; without spring there is no telling slip from dashpot */
    const PetscReal slip = overlap > 0 ? (trial - after) / (k + PG_SMALLEST) : 0;
    const PetscReal open = overlap > 0 ? 0 : 0.5 * before * trial / (k + PG_SMALLEST); /* the spring is let go */

    lost[which] = (0.5 * (before + after) + viscous) * slip + open;
    lost[3] -= viscous * slip; /* the dashpot did not slip */
  }
  *elastic = after;
  return overlap > 0 ? capped : 0;
}

static inline __attribute__((always_inline)) PgContactForce
PgLi2007(const PgContactParameters *p, const PgContactMotion *m, PetscReal dt, PgContactHistory *h, PetscReal lost[])
{
  PgContactForce  f;
  const PetscReal u        = m->overlap;
  const PetscReal pressing = -(p->k_n * u) - p->c_n * m->overlap_rate; /* Eq. 8 */
  const PetscReal clipped  = pressing < 0 ? pressing : 0;              /* never tensile */
  PetscReal       F_s, F_r, N;

  f.F_N = u > 0 ? clipped : 0; /* Eq. 9 */
  N     = -f.F_N;
  if (lost) lost[3] = 0;
  F_s   = PgLi2007Friction(p->k_s, p->c_s, m->sliding_rate, dt, p->mu_s * N, u, &h->f_s, lost, 0);
  F_r   = PgLi2007Friction(p->k_r, p->c_r, m->rolling_rate, dt, p->mu_r * N, u, &h->f_r, lost, 1);
  f.M_r = PgLi2007Friction(p->k_theta, p->c_theta, m->spin_rate, dt, p->mu_theta_r * N, u, &h->m_r, lost, 2);
  f.F_T = PgLi2007Clamp(F_s + F_r, p->mu_s * N); /* Eqs. 11, 16, 17 */
  return f;
}

PETSC_INTERN PgContactLoop PgDemContactLoopLi2007, PgDemContactLoopEnergyLi2007;
/* The same of any law, pair by pair. */
PETSC_INTERN PgContactLoop PgDemContactLoopTak2013, PgDemContactLoopHertz;
PETSC_INTERN PetscReal PgContactStiffnessTak2013(const PgContactParameters *parameters, PetscReal overlap, PetscReal R);
PETSC_INTERN PetscReal PgContactStiffnessHertz(const PgContactParameters *parameters, PetscReal overlap, PetscReal R);
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
/* Lists the discs near walls anew where that is needed, keeping what they remember. */
PETSC_INTERN PetscErrorCode PgDemUpdateWallContacts_Private(PgDem dem);
/* v += h F/m and w += h T/I of the owned discs [first, end). */
PETSC_INTERN PetscErrorCode PgDemHalfKick_Private(PgDem dem, PetscReal h, PetscInt first, PetscInt end);
/* Forces of all walls on their discs, histories advanced by dt. */
PETSC_INTERN PetscErrorCode PgDemWallForces_Private(PgDem dem, const PgDemDiscs *discs, PetscReal dt);
/* Velocities of servo walls from the forces on them. Collective. */
PETSC_INTERN PetscErrorCode PgDemServoWalls_Private(PgDem dem, PetscReal dt);
PETSC_INTERN void           PgDemMoveWalls_Private(PgDem dem, PetscReal dt);
/* Force (x, y) and torque on the disc of a wall contact. */
PETSC_INTERN void PgDemWallContactForce_Private(PgDem dem, const PgWallContact *contact, PetscReal r,
                                                PetscReal force[3]);
/* First contact of a disc, or the count of all. */
PETSC_INTERN PetscInt       PgDemFindWallContact_Private(PgDem dem, PetscInt disc);
PETSC_INTERN PetscErrorCode PgDemSaveWallHistory_Private(PgDem dem);
PETSC_INTERN PetscErrorCode PgDemRestoreWallHistory_Private(PgDem dem);
/* Friction coefficient of a wall, its own or the default. */
PETSC_INTERN PetscReal PgDemWallFriction_Private(PgDem dem, const PgWall *wall);
/* Energy: what the caps took, and the work of all forces, in half a step of length h that ends (arrival) or begins
   here; what came between two steps; the start. */
PETSC_INTERN PetscErrorCode PgDemBookWork_Private(PgDem dem, PetscReal h, PetscBool arrival);
PETSC_INTERN PetscErrorCode PgDemBookBetween_Private(PgDem dem);
PETSC_INTERN PetscErrorCode PgDemNoteKinetic_Private(PgDem dem);
PETSC_INTERN PetscErrorCode PgDemFillFrictionEnergy_Private(PgDem dem);
enum { PG_ENERGY_FORCES = 16 }; /* local damping (3), global damping (3), fluid (2), external (2), of pairs (6) */
PETSC_INTERN PetscErrorCode PgDemGetFrictionAccount_Private(PgDem dem, PetscReal **account, PetscInt *stride);
/* dem->offset with room for `count` integers. */
PETSC_INTERN PetscErrorCode PgDemGetOffset_Private(PgDem dem, PetscInt count);
/* dem->work with room for `count` reals. */
PETSC_INTERN PetscErrorCode PgDemGetWork_Private(PgDem dem, PetscInt count, PetscReal **work);
