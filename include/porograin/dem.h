/* dem: the solid phase. Discs with sliding and rolling friction (Li, Chu & Sheng 2007, Eqs. 1-17), or with bonds or
   Hertz' contact (Tak, Park & Park 2013, Eqs. 15-18), plates with prescribed motion, damping, and their motion in time. Knows nothing about water: what the
   water does to a disc arrives as a force in the field "fluid_force". */
#pragma once

#include <porograin/neighbors.h>

typedef struct PgDem_s *PgDem;

/* Pair (a, j): n = (x_j - x_a)/|x_j - x_a|, t = (-n_y, n_x), overlap u_N = r_a + r_j - |x_j - x_a|. */
typedef struct {
  PetscReal k_n, k_s, k_r; /* normal, sliding, rolling stiffness [N/m], Eqs. 8, 13 */
  PetscReal k_theta;       /* rolling moment stiffness [N m/rad], Eq. 4 */
  PetscReal c_n, c_s, c_r; /* dashpots [N s/m], Eqs. 8, 13 */
  PetscReal c_theta;       /* moment dashpot [N m s/rad], Eq. 4 */
  PetscReal mu_s, mu_r;    /* friction coefficients of the sliding and rolling force [1], Eqs. 14-17 */
  PetscReal mu_theta_r;    /* rolling moment arm mu_theta*r [m], Eqs. 5-6 */
  /* of the laws of Tak, Park & Park (2013), with their equation numbers */
  PetscReal R_n, R_t;   /* strength of a bond in tension and in shear [N/m], Eqs. 15-16; both 0: no bonds */
  PetscReal bond_range; /* discs nearer to each other than this at the start of a run are bonded [m] */
  PetscReal E, nu;      /* Young's modulus [Pa] and Poisson's ratio [1] of the discs, Eq. 18 */
} PgContactParameters;

/* Motion of the pair relative to its contact point, and what it remembers. */
typedef struct {
  PetscReal overlap;      /* u_N [m] */
  PetscReal overlap_rate; /* du_N/dt [m/s] */
  PetscReal sliding_rate; /* du_s/dt = (v_a - v_j).t + r_a w_a + r_j w_j [m/s] */
  PetscReal rolling_rate; /* du_r/dt = -(r_a w_a + r_j w_j) [m/s] */
  PetscReal spin_rate;    /* dth_r/dt = w_a - w_j [rad/s] */
  PetscReal R;            /* r_a r_j/(r_a + r_j), of a wall r_a [m]; read by Hertz' law alone */
} PgContactMotion;
typedef struct {
  PetscReal f_s, f_r; /* elastic sliding and rolling force [N], Eq. 13; in the law tak2013, which knows no rolling, f_r
                         is 1 for a bond, -1 for a contact without, 0 for discs that have not met */
  PetscReal m_r;      /* elastic rolling moment [N m], Eq. 4 */
} PgContactHistory;
/* Force F_N n + F_T t on a and its opposite on j; torque r_a F_T + M_r on a, r_j F_T - M_r on j. */
typedef struct {
  PetscReal F_N, F_T, M_r; /* [N], [N], [N m] */
} PgContactForce;

/* The contact law of one touching pair: forces at the end of a step of length dt, history updated.
   Elastic parts are capped with the force so that springs do not wind up. A pure function. */
PETSC_EXTERN PgContactForce PgContactLawLi2007(const PgContactParameters *parameters, const PgContactMotion *motion,
                                               PetscReal dt, PgContactHistory *history);

/* Tak, Park & Park (2013), Eqs. 15-17: spring and dashpot in both directions. A bond holds in tension, too, until the
   tension exceeds R_n or the tangential force R_t, and is then broken for good; without bond there is no tension, and
   friction caps the tangential force. Discs that touch in an evaluation with dt = 0, the start of a run, are bonded. */
PETSC_EXTERN PgContactForce PgContactLawTak2013(const PgContactParameters *parameters, const PgContactMotion *motion,
                                                PetscReal dt, PgContactHistory *history);
/* Eq. 18: F_N = 4/3 E/(2(1 - nu^2)) sqrt(R) u_N^{3/2} for two discs of one material, the number for spheres [N] taken by
   metre of thickness, and a dashpot c_n; Eqs. 16, 17 tangentially. */
PETSC_EXTERN PgContactForce PgContactLawHertz(const PgContactParameters *parameters, const PgContactMotion *motion,
                                              PetscReal dt, PgContactHistory *history);

/* A plate: a horizontal rigid surface that prescribes the vertical velocity of the discs assigned to it
   (field "plate": 1 + index of the plate, 0 for free discs). Horizontally a disc slips on the plate
   through a spring k_s on the contact-point displacement, capped by friction times the reaction. */
typedef struct {
  char      name[32];
  PetscReal side;     /* +1: above its discs, -1: below */
  PetscReal velocity; /* prescribed vertical velocity [m/s] */
  PetscReal friction; /* coefficient [1] */
  PetscBool hold;     /* PETSC_TRUE: its discs are fixed altogether (a bed); velocity and friction unused */
} PgPlate;

/* Registers the fields force, torque, fluid_force, external_force (f^e of Eq. 1, zero unless a case fills
   it), plate, plate_spring, plate_reaction, contact_share, coordination_number, stress and the ragged data
   contact_history. Collective. */
PETSC_EXTERN PetscErrorCode PgDemCreate(PgParticles particles, PgNeighbors neighbors, PgDem *dem);
/* Reads -dem_*, the contact law -dem_contact_law among them, -plate_friction and -wall_*. Collective. */
PETSC_EXTERN PetscErrorCode PgDemSetFromOptions(PgDem dem);
PETSC_EXTERN PetscErrorCode PgDemView(PgDem dem, PetscViewer viewer);
PETSC_EXTERN PetscErrorCode PgDemDestroy(PgDem *dem);
PETSC_EXTERN PetscErrorCode PgDemGetParameters(PgDem dem, PgContactParameters *parameters);
PETSC_EXTERN PetscErrorCode PgDemSetParameters(PgDem dem, const PgContactParameters *parameters);
PETSC_EXTERN PetscErrorCode PgDemSetGravity(PgDem dem, const PetscReal gravity[2]);        /* [m/s2] */
PETSC_EXTERN PetscErrorCode PgDemSetDamping(PgDem dem, PetscReal local, PetscReal global); /* [1], [1/s] */
/* plate->friction < 0 takes -plate_friction. */
PETSC_EXTERN PetscErrorCode PgDemAddPlate(PgDem dem, const PgPlate *plate, PetscInt *index);
PETSC_EXTERN PetscErrorCode PgDemGetPlate(PgDem dem, PetscInt index, PgPlate *plate);
PETSC_EXTERN PetscErrorCode PgDemGetPlateCount(PgDem dem, PetscInt *count);

/* A wall: a rigid straight line of infinite length. Discs touch it by the contact law of the discs, with
   the wall as partner of infinite mass that does not turn, and remember their contact with it like any
   other. Overlap = r - distance of the centre from the line; n from the disc to the line. */
typedef enum {
  PG_WALL_FIXED,
  PG_WALL_MOVING, /* velocity is prescribed */
  PG_WALL_SERVO   /* moves along its normal until the force on it is what `stress` asks for: in each step at
                     gain*(target - force), gain = -wall_servo_gain/(k_n dt) over the number of its contacts */
} PgWallKind;
typedef struct {
  char       name[32];
  PgWallKind kind;
  PetscReal  point[2], normal[2]; /* a point of the line [m]; unit normal into the discs */
  PetscReal  velocity[2];         /* [m/s]; of a servo wall: what it has now */
  PetscReal  friction; /* sliding coefficient mu_s against the wall [1]; < 0: -wall_friction, or that of the discs */
  PetscReal  stress;   /* servo: target of normal force over length, compression > 0 [N/m2 = N/m per m] */
  PetscReal  length;   /* servo: length over which the stress acts [m]; 0: distance of the two walls beside it, or the
                        period of x */
  PetscReal  max_velocity; /* servo: bound of its velocity [m/s] */
} PgWall;
/* The first wall registers the variable-length data "wall_history". In periodic x a wall must be horizontal. */
PETSC_EXTERN PetscErrorCode PgDemAddWall(PgDem dem, const PgWall *wall, PetscInt *index);
PETSC_EXTERN PetscErrorCode PgDemGetWall(PgDem dem, PetscInt index, PgWall *wall);
PETSC_EXTERN PetscErrorCode PgDemSetWall(PgDem dem, PetscInt index, const PgWall *wall);
PETSC_EXTERN PetscErrorCode PgDemGetWallCount(PgDem dem, PetscInt *count);
/* How far a wall has moved along its normal since it was added [m]. */
PETSC_EXTERN PetscErrorCode PgDemGetWallDisplacement(PgDem dem, PetscInt index, PetscReal *displacement);
/* Force of the discs on a wall at the last evaluation [N/m], exact sum over discs. Collective. */
PETSC_EXTERN PetscErrorCode PgDemGetWallForce(PgDem dem, PetscInt index, PetscReal force[2]);

/* Largest stable time step: 2/omega_max, with omega bounded by the stiffest contact when each disc's mass
   and inertia are shared out among its contacts (sliding with rotation included; Irons' element bound),
   reduced by the dashpots. PETSC_MAX_REAL without contacts. Needs built lists. Collective. */
PETSC_EXTERN PetscErrorCode PgDemCriticalTimeStep(PgDem dem, PetscReal *dt);

/* One step of velocity Verlet is KickDrift, [list build, halo], Forces, Kick:
   KickDrift: v += dt/2 F/m, w += dt/2 T/I, x += dt v, rotation += dt w (owned discs), walls move by dt.
   Forces:    contact forces and moments, plates, walls, gravity, fluid_force and damping at the present
              positions, tangential increments with the half-step velocities; advances the history by dt;
              gives servo walls the velocity of the next step. Ghost positions, velocities and spins must
              be current.
   Kick:      v += dt/2 F/m, w += dt/2 T/I.
   Forces with dt = 0 evaluates without advancing anything: the start of a run, where changes of the field
   "plate" are taken up too (otherwise at list builds). Collective. */
PETSC_EXTERN PetscErrorCode PgDemKickDrift(PgDem dem, PetscReal dt);
PETSC_EXTERN PetscErrorCode PgDemForces(PgDem dem, PetscReal dt);
PETSC_EXTERN PetscErrorCode PgDemKick(PgDem dem, PetscReal dt);
/* Forces and Kick with the same bits, in one pass through the discs where no energy accounts are kept. Collective. */
PETSC_EXTERN PetscErrorCode PgDemForcesKick(PgDem dem, PetscReal dt);

/* Contact history across a list build: Save before PgNeighborsBuild() puts it into the ragged data (so
   that it migrates, and checkpoints see it), Restore after it. Save leaves the records alone while none have
   been restored for the present lists: after reading a checkpoint they are the history. Collective. */
PETSC_EXTERN PetscErrorCode PgDemSaveHistory(PgDem dem);
PETSC_EXTERN PetscErrorCode PgDemRestoreHistory(PgDem dem);

/* Vertical reaction of a plate on its discs, positive when it pushes them [N/m]: from contacts alone,
   and total (all forces on its discs). Collective. */
PETSC_EXTERN PetscErrorCode PgDemGetLoad(PgDem dem, PetscInt plate, PetscReal *contact, PetscReal *total);
/* Fills the fields coordination_number and stress (sum over contacts of f (x) branch vector over the area
   of the disc's share, tension positive). Collective. */
PETSC_EXTERN PetscErrorCode PgDemComputeObservables(PgDem dem);
/* Translational and rotational kinetic energy of all discs [J/m]. Collective. */
PETSC_EXTERN PetscErrorCode PgDemKineticEnergy(PgDem dem, PetscReal *energy);
/* Where energy came from and went to since the start [J/m], in the accounts of the trapezoidal rule: work of a
   force in a step is its mean before and after, times the way at the half-step velocity. */
typedef struct {
  PetscReal kinetic;                                                          /* now, translation and rotation */
  PetscReal elastic_normal, elastic_sliding, elastic_rolling, elastic_moment; /* now, in contacts and plate springs */
  PetscReal friction_sliding, friction_rolling, friction_moment;              /* taken by slip at the caps */
  PetscReal dashpots;                                                         /* and where a normal force is clipped */
  PetscReal local_damping, global_damping;                                    /* taken by damping */
  PetscReal rolling_excess; /* taken from the discs by the rolling force F_r beyond what its spring gets: F_r acts
                               on the sliding of the contact points, its spring on rolling (and the cap of F_s + F_r) */
  PetscReal work_plates, work_walls, work_gravity, work_external; /* given to the discs */
  PetscReal work_fluid; /* by fluid_force, and by changes of velocity between the steps (pressure projection) */
  PetscReal residual;   /* what does not add up: now + taken - given - start; second order in the time step */
} PgEnergy;
/* Keeps the accounts (also: -dem_energy), in the fields energy_account and energy_force; friction_energy is filled by
   PgDemComputeObservables(). To be called before the first evaluation, which is the start. */
PETSC_EXTERN PetscErrorCode PgDemSetEnergy(PgDem dem, PetscBool on);
PETSC_EXTERN PetscErrorCode PgDemHasEnergy(PgDem dem, PetscBool *on);
/* Exact sums over discs. Collective. */
PETSC_EXTERN PetscErrorCode PgDemGetEnergy(PgDem dem, PgEnergy *energy);
/* Stops the run (error with step, time, particle id, position and values) when a velocity or force is not
   finite, a disc is faster than -dem_guard_speed, an overlap exceeds -dem_guard_overlap times the smaller
   radius, or a disc leaves -dem_guard_domain. Collective. */
PETSC_EXTERN PetscErrorCode PgDemGuard(PgDem dem, PetscInt step, PetscReal time);
/* The same when dt is above -dem_guard_time_step times the critical one of the contacts as they are; nothing is
   said while nothing touches. Collective. */
PETSC_EXTERN PetscErrorCode PgDemGuardTimeStep(PgDem dem, PetscInt step, PetscReal time, PetscReal dt);

/* Adds what a checkpoint must hold beside fields and histories: walls and plates. Addresses stay valid until a wall
   or plate is added. */
PETSC_EXTERN PetscErrorCode PgDemAddState(PgDem dem, PgState state);
/* Refuses restored values that no run can have produced: masses, radii, plates, partners of the contact history.
   Collective. */
PETSC_EXTERN PetscErrorCode PgDemCheckState(PgDem dem, const char file[]);
