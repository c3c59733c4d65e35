/* What the files of this room share. */
#pragma once

#include <porograin/wcsph.h>

/* What two particles are to each other, by entry of the row list. */
typedef enum {
  PG_PAIR_LIQUID,     /* both are liquid */
  PG_PAIR_AT_SOLID,   /* the particle of the row is liquid, its partner solid */
  PG_PAIR_OF_SOLID,   /* the other way around */
  PG_PAIR_SAME_SOLID, /* of one wall or one body */
  PG_PAIR_SOLIDS      /* of two */
} PgWcsphPair;

struct PgWcsph_s {
  MPI_Comm    comm;
  PgParticles particles;
  PgNeighbors neighbors;

  /* settings */
  PetscReal       dx;                /* spacing of the lattice [m] */
  PetscReal       smoothing, h;      /* h/dx, h [m] */
  PetscReal       rho_0, mu, c_0;    /* [kg/m3], [Pa s], [m/s] */
  PetscReal       gravity[2];        /* [m/s2] */
  PetscReal       delta;             /* of the diffusion of density [1] */
  PetscReal       contact, onset;    /* stiffness over rho_0 c_0^2 [1]; sum of V W at which solids touch [1] */
  PetscReal       damping, damp_end; /* [1/s], [s] */
  PetscBool       friction;          /* viscous, between solids */
  const PgKernel *kernel;
  PgWcsphDensity  density;
  PgWcsphState    state;
  PgWcsphSolid    solid;
  PgWcsphSlip     slip;
  PgWcsphMotion   motion;
  void           *motion_context;

  /* particles before SetUp: those of this rank */
  PetscInt         added, added_bodies; /* by all ranks, those of bodies */
  PetscInt         kept, room;          /* by this one, capacity */
  PgWcsphParticle *particle;
  PetscInt        *particle_id;
  PetscBool        set_up;

  PgField kind, body, index, rho, p, force, slip_velocity, contact_pressure, solid_rate;

  /* by entry of the row list; by owned particle */
  PetscInt       entries, rows, built; /* capacities; revision of the lists */
  PetscReal     *slope, *weight;       /* W'/r [1/m4], W [1/m2] */
  unsigned char *pair;                 /* a PgWcsphPair */
  PetscReal     *rate;                 /* of density [kg/(m3 s)] */
  PgRowList      list;

  /* particles of bodies of this rank, for the callback; of the last kind that GetSolids() was asked for */
  PetscInt   bodies, bodies_room, solids_room;
  PetscInt  *local, *body_of, *index_of, *solid_body, *solid_index;
  PetscReal *body_x, *body_v, *solid_x, *solid_force, *solid_p;

  PetscReal time, pending; /* [s]; dt of a drift whose second half of the density is to come */
  PetscInt  step;
};

/* Arrays of the store, ghosts included. */
typedef struct {
  PetscReal       *x, *v, *rho, *p, *force, *slip_velocity, *contact_pressure, *solid_rate;
  const PetscReal *m, *kind, *body, *index;
  PetscInt         owned, ghosts;
} PgWcsphArrays;

static inline PetscBool PgWcsphIsLiquid(const PgWcsphArrays *a, PetscInt i)
{
  return (PetscBool)(a->kind[i] == (PetscReal)PG_WCSPH_FLUID);
}

/* r_ab = x_a - x_b: the exact opposite of r_ba. */
static inline PgReal2 PgWcsphR(const PgWcsphArrays *f, PetscInt a, PetscInt b)
{
  return PgTwo(f->x, a) - PgTwo(f->x, b);
}

static inline PetscReal PgDot(PgReal2 a, PgReal2 b) { return a[0] * b[0] + a[1] * b[1]; }

/* wcsph.c */
PETSC_INTERN PetscErrorCode PgWcsphGetArrays(PgWcsph w, PgWcsphArrays *arrays);

/* state.c: pressure of a density, its inverse, square of the speed of sound, energy per mass */
PETSC_INTERN PetscReal PgWcsphPressure(const struct PgWcsph_s *w, PetscReal rho);
PETSC_INTERN PetscReal PgWcsphDensityAt(const struct PgWcsph_s *w, PetscReal p);
PETSC_INTERN PetscReal PgWcsphSound2(const struct PgWcsph_s *w, PetscReal rho);
PETSC_INTERN PetscReal PgWcsphEnergy(const struct PgWcsph_s *w, PetscReal rho);

/* pairs.c: W'/r and W of all pairs at the present positions; kinds of pairs, when the lists are new */
PETSC_INTERN PetscErrorCode PgWcsphUpdatePairs(PgWcsph w);

/* density.c: d rho/dt of owned particles by continuity, without or with diffusion; Eq. 26 */
PETSC_INTERN PetscErrorCode PgWcsphDensityRate(PgWcsph w, PetscReal rate[]);
PETSC_INTERN PetscErrorCode PgWcsphAddDiffusion(PgWcsph w, PetscReal rate[]);
PETSC_INTERN PetscErrorCode PgWcsphSumDensity(PgWcsph w);

/* solids.c: velocity of solids in the viscous term, pressure by which solids repel each other (own velocities and
   positions of ghosts are current); pressure of the liquid around (their pressures, too) */
PETSC_INTERN PetscErrorCode PgWcsphSolidVelocity(PgWcsph w);
PETSC_INTERN PetscErrorCode PgWcsphSolidPressure(PgWcsph w);

/* forces.c */
PETSC_INTERN PetscErrorCode PgWcsphPairForces(PgWcsph w);

/* particles.c */
PETSC_INTERN PetscErrorCode PgWcsphDestroyParticles(PgWcsph w);
