/* Small strain of a hexagonal lattice of touching discs between two plates.

   Physics: rows along x, contacts of spacing 2r at 0 and +-60 degrees with springs k_n, k_s and friction high enough to
   hold; no rolling resistance. The plates compress at a constant rate; all discs start with the velocities of the
   homogeneous deformation, so that no wave runs.
   Exact, with closed contacts in all three directions:
     C11 = sqrt(3)/4 (3 k_n + k_s), C12 = sqrt(3)/4 (k_n - k_s), E = C11 - C12^2/C11, nu = C12/C11.
   -lattice_sides periodic: no lateral strain, F/delta = C11 L/H', lateral stress C12 delta/H', H' = sqrt(3) r (rows - 1).
   -lattice_sides free (rows of W-1 and W discs as in the panel): the lattice widens, and the contacts along the rows,
   which just touch, open at once. Without them
     lateral strain nu' = 3 (k_n - k_s)/(k_n + 3 k_s) of the vertical one,
     E' = [(9 k_n + 3 k_s) - 9 (k_n - k_s)^2/(k_n + 3 k_s)]/(4 sqrt(3)),
   and every contact force is vertical, 30 degrees off its normal: so the discs at the sides are in equilibrium, too,
   F/delta = E' 2r (W - 1)/H' holds at any size, and only with mu_s > tan(30) = 0.577. Against the nominal E' W/H it is
   off by the edges, order 1 in 1/W.
   Expected order: 1 in the strain (geometry).  Test: tests/verify/dem_lattice.c */
#include "casesimpl.h"

typedef struct {
  PetscInt  columns, rows, sides;
  PetscReal radius; /* [m] */
  PetscReal rate;   /* vertical compression [1/s] */
  PetscReal strain; /* at the end */
} Lattice;

enum { SIDES_FREE, SIDES_PERIODIC };
static const char *const sides_words[] = {"free", "periodic"};

static PetscErrorCode Create(MPI_Comm comm, void **context)
{
  Lattice  *p;
  PetscBool rows = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&p));
  *p = (Lattice){12, 25, SIDES_FREE, 5e-3, 1e-2, 1e-5};
  PetscCall(PgCaseDefaults("-dem_mu_s 1 -dem_mu_r 0 -dem_k_r 0 -dem_mu_theta_r 0 -plate_friction 0"));
  PetscOptionsBegin(comm, "", "case lattice_modulus: small strain of a lattice", "");
  PetscCall(PgOptionInt(PetscOptionsObject, "-lattice_columns", "discs in a row, with free sides in every other one", 4,
                        10000, &p->columns, NULL));
  p->rows = 2 * p->columns + 1;
  PetscCall(PgOptionInt(PetscOptionsObject, "-lattice_rows", "rows, an odd number; default 2 W + 1", 3, 20001, &p->rows,
                        &rows));
  PetscCall(
      PgOptionChoice(PetscOptionsObject, "-lattice_sides", "free or periodic in x", 2, sides_words, &p->sides, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-lattice_radius", "radius of the discs", "m", PG_POSITIVE, 1e3,
                         &p->radius, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-lattice_rate", "rate of vertical compression", "1/s", PG_POSITIVE, 1e3,
                         &p->rate, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-lattice_strain", "vertical compression at the end", "1", PG_POSITIVE,
                         0.5, &p->strain, NULL));
  PetscOptionsEnd();
  PgInputCheck(p->rows % 2 == 1, comm, "option -lattice_rows: %" PetscInt_FMT " is not odd", p->rows);
  *context = p;
  PetscFunctionReturn(0);
}

static PetscReal Height(const Lattice *c) { return PetscSqrtReal(3.0) * c->radius * (PetscReal)(c->rows - 1); }

/* Row, place in it and centre of a disc; short rows come first. */
static PetscInt Locate(const Lattice *c, PetscInt id, PetscReal x[2])
{
  const PetscInt less = c->sides == SIDES_FREE, two = 2 * c->columns - less;
  PetscInt       row = 2 * (id / two), column = id % two;

  if (column >= c->columns - less) {
    row++;
    column -= c->columns - less;
  }
  x[0] = c->radius * (2.0 * (PetscReal)column + (row % 2 ? 1.0 : 2.0));
  x[1] = c->radius * (1.0 + PetscSqrtReal(3.0) * (PetscReal)row);
  return row;
}

static PetscErrorCode Fill(const Lattice *c, PgCaseSetup *setup, PetscInt first, PetscInt owned)
{
  const PetscReal     middle = c->radius * (PetscReal)c->columns;
  PgContactParameters p;
  PgCaseArrays        a;
  PetscReal           widening;

  PetscFunctionBeginUser;
  PetscCall(PgDemGetParameters(setup->dem, &p));
  widening = c->sides == SIDES_FREE ? 3 * (p.k_n - p.k_s) / (p.k_n + 3 * p.k_s) : 0;
  PetscCall(PgCaseGetArrays(setup, &a));
  for (PetscInt i = 0; i < owned; i++) {
    const PetscInt row = Locate(c, first + i, &a.x[2 * i]);

    a.radius[i]    = c->radius;
    a.v[2 * i]     = widening * c->rate * (a.x[2 * i] - middle);
    a.v[2 * i + 1] = -c->rate * (a.x[2 * i + 1] - c->radius);
    a.plate[i]     = row == 0 ? 1.0 : (row == c->rows - 1 ? 2.0 : 0.0);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Setup(void *context, PgCaseSetup *setup)
{
  const Lattice *c    = (const Lattice *)context;
  const PetscInt less = c->sides == SIDES_FREE, total = c->rows * c->columns - less * (c->rows / 2 + 1);
  const PgPlate  lower = {"lower", -1, 0, -1, PETSC_FALSE}, upper = {"upper", 1, -c->rate * Height(c), -1, PETSC_FALSE};
  PetscInt       first, owned;

  PetscFunctionBeginUser;
  PetscCall(PgCaseDealDiscs(setup, total, &first, &owned));
  if (c->sides == SIDES_PERIODIC)
    PetscCall(PgParticlesSetPeriodicX(setup->particles, 0.0, 2.0 * c->radius * (PetscReal)c->columns));
  PetscCall(PgDemAddPlate(setup->dem, &lower, NULL));
  PetscCall(PgDemAddPlate(setup->dem, &upper, &setup->load_plate));
  PetscCall(Fill(c, setup, first, owned));
  PetscCall(PgCaseFinishDiscs(setup));
  setup->height   = Height(c);
  setup->end_time = c->strain / c->rate;
  PetscFunctionReturn(0);
}

const PgCaseInfo PgCaseLatticeModulus = {"lattice_modulus",
                                         "small strain of a hexagonal lattice between two plates",
                                         Create,
                                         Setup,
                                         PgCaseDestroyContext,
                                         NULL};
