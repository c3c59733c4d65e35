/* Biaxial test: a hexagonal lattice compressed between two smooth walls, confined by two others.

   Physics: rows of W-1 and W discs as in the panel; the lower wall is at rest, the upper one moves down at a constant
   velocity, the side walls are servo-controlled to the confining stress. No friction at the walls.
   No exact curve. What is known: when the lattice begins to slip, the contacts along the rows have opened and the
   oblique ones, 30 degrees off the vertical, carry forces inclined against their normals by the angle of friction
   phi = atan(mu_s); equilibrium then makes the stress ratio
     sigma_1/sigma_3 = sqrt(3)/tan(30 - phi),   phi < 30 degrees
   (Rowe's result for regular rods, sqrt(3) tan(60 + phi)). No friction law lets the first slip happen above it, and the
   geometry only lowers it from then on: an upper bound for slow loading that stiff discs come close to. In forces:
     F_upper/F_side <= 2 (W - 1)/((rows - 1) tan(30 - phi)).
   For mu_s >= tan(30) = 0.577 there is no such bound: the lattice does not slip before its discs give way.
   Before slip, with the contacts along the rows closed, the slope of sigma_1 over the strain at constant confinement is
   E of lattice_modulus, but for the edges (order 1 in 1/W).  Test: tests/verify/dem_biaxial.c */
#include "casesimpl.h"

typedef struct {
  PetscInt  columns, rows;
  PetscReal radius;       /* [m] */
  PetscReal stress;       /* sigma_3 [Pa] */
  PetscReal velocity;     /* of the upper wall, downward [m/s] */
  PetscReal displacement; /* at the end [m] */
} Biaxial;

static PetscErrorCode Create(MPI_Comm comm, void **context)
{
  Biaxial  *p;
  PetscBool rows = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&p));
  *p = (Biaxial){12, 25, 5e-3, 1e5, 0.01, 2e-4};
  PetscCall(
      PgCaseDefaults("-dem_mu_s 0.3 -dem_mu_r 0 -dem_k_r 0 -dem_mu_theta_r 0 -dem_local_damping 0.7 -wall_friction 0"));
  PetscOptionsBegin(comm, "", "case biaxial: a confined lattice", "");
  PetscCall(PgOptionInt(PetscOptionsObject, "-biaxial_columns",
                        "discs in a long row W; rows have W-1 and W discs in turn", 4, 10000, &p->columns, NULL));
  p->rows = 2 * p->columns + 1;
  PetscCall(PgOptionInt(PetscOptionsObject, "-biaxial_rows", "rows, an odd number; default 2 W + 1", 3, 20001, &p->rows,
                        &rows));
  PetscCall(PgOptionReal(PetscOptionsObject, "-biaxial_radius", "radius of the discs", "m", PG_POSITIVE, 1e3,
                         &p->radius, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-biaxial_stress", "confining stress on the side walls", "Pa", 0, 1e12,
                         &p->stress, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-biaxial_velocity", "downward velocity of the upper wall", "m/s", 0, 1e3,
                         &p->velocity, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-biaxial_displacement", "of the upper wall at the end", "m", 0, 1e3,
                         &p->displacement, NULL));
  PetscOptionsEnd();
  PgInputCheck(p->rows % 2 == 1, comm, "option -biaxial_rows: %" PetscInt_FMT " is not odd", p->rows);
  *context = p;
  PetscFunctionReturn(0);
}

static PetscErrorCode AddWalls(const Biaxial *c, PgCaseSetup *setup)
{
  const PetscReal width = 2 * c->radius * (PetscReal)c->columns;
  const PetscReal top   = c->radius * (2 + PetscSqrtReal(3.0) * (PetscReal)(c->rows - 1));
  const PetscReal fast  = PetscMax(0.1, 10 * c->velocity); /* of the side walls, to meet the discs soon */
  const PgWall    lower = {.name = "lower", .normal = {0, 1}, .friction = -1};
  const PgWall    upper = {.name     = "upper",
                           .kind     = PG_WALL_MOVING,
                           .point    = {0, top},
                           .normal   = {0, -1},
                           .velocity = {0, -c->velocity},
                           .friction = -1};
  const PgWall    left  = {.name         = "left",
                           .kind         = PG_WALL_SERVO,
                           .normal       = {1, 0},
                           .friction     = -1,
                           .stress       = c->stress,
                           .max_velocity = fast};
  PgWall          right = left;

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(right.name, "right", sizeof right.name));
  right.point[0]  = width;
  right.normal[0] = -1;
  PetscCall(PgDemAddWall(setup->dem, &lower, NULL));
  PetscCall(PgDemAddWall(setup->dem, &upper, &setup->load_wall));
  PetscCall(PgDemAddWall(setup->dem, &left, NULL));
  PetscCall(PgDemAddWall(setup->dem, &right, NULL));
  setup->height = top;
  PetscFunctionReturn(0);
}

static PetscErrorCode Setup(void *context, PgCaseSetup *setup)
{
  const Biaxial *c     = (const Biaxial *)context;
  const PetscInt total = c->rows * c->columns - (c->rows / 2 + 1), two = 2 * c->columns - 1;
  PetscInt       first, owned;
  PetscReal     *x, *r;

  PetscFunctionBeginUser;
  PetscCall(PgCaseDealDiscs(setup, total, &first, &owned));
  PetscCall(PgParticlesGetArray(setup->particles, PG_POSITION, &x));
  PetscCall(PgParticlesGetArray(setup->particles, PG_RADIUS, &r));
  for (PetscInt i = 0; i < owned; i++) {
    const PetscInt rest = (first + i) % two, odd = rest >= c->columns - 1;
    const PetscInt row = 2 * ((first + i) / two) + odd, column = odd ? rest - (c->columns - 1) : rest;

    r[i]         = c->radius;
    x[2 * i]     = c->radius * (2.0 * (PetscReal)column + (odd ? 1.0 : 2.0));
    x[2 * i + 1] = c->radius * (1.0 + PetscSqrtReal(3.0) * (PetscReal)row);
  }
  PetscCall(PgCaseFinishDiscs(setup));
  PetscCall(AddWalls(c, setup));
  if (c->velocity > 0) setup->end_time = c->displacement / c->velocity;
  PetscFunctionReturn(0);
}

const PgCaseInfo PgCaseBiaxial = {
    "biaxial", "a hexagonal lattice compressed under servo-controlled confinement", Create, Setup, PgCaseDestroyContext,
    NULL};
