/* ranks: 1 2 */
/* Truncation error of gradient and Laplacian.

   Physics: none; the operators of Eqs. 51, 52 and 60 on p = sin(pi x) sin(pi y) + linear in the unit square, at discs whose
   kernel is full, on the hexagonal lattice and with centres displaced by up to 0.1 spacings. h = 1.25 spacings.
   Error: relative L2 norm over those discs. Exact solution: the derivatives of p.
   Expected, with h over spacing fixed:
     lattice, paper       no convergence: factors 1.0224 (gradient) and 0.9238, 1.0114, 1.0224 (Laplacian with
                          eta = 0.1, 0.01, 0), so errors of 0.0224, 0.0762, 0.0114, 0.0224 that do not fall
     lattice, corrected   2: exact for linear and quadratic fields, and the next odd term cancels by symmetry
     disorder, paper      gradient: no convergence, the moments are off by a share of the displacement. Laplacian: grows
                          like 1/h, since the first moments of its row do not vanish and are divided by h^2
     disorder, corrected  1: the first term that is not exact, without the symmetry that cancels it */
#include "mms.h"

typedef struct {
  const char *name, *options;
  PetscReal   jitter;
  PetscReal   gradient, laplacian;                 /* expected order */
  PetscReal   gradient_plateau, laplacian_plateau; /* expected error where the order is 0; 0: not known beforehand */
} Case;

/* Jitter is in radii: 0.2 are 0.1 spacings. */
static const Case cases[] = {
    {"lattice, paper, eta 0.1", "", 0.0, 0, 0, 0.0224, 0.0762},
    {"lattice, paper, eta 0.01", "-sph_laplacian_eta 0.01", 0.0, 0, 0, 0.0224, 0.0114},
    {"lattice, paper, eta 0", "-sph_laplacian_eta 0", 0.0, 0, 0, 0.0224, 0.0224},
    {"lattice, corrected, eta 0.1", "-sph_operators corrected", 0.0, 2, 2, 0, 0},
    {"lattice, corrected, eta 0.01", "-sph_operators corrected -sph_laplacian_eta 0.01", 0.0, 2, 2, 0, 0},
    {"disorder, paper, eta 0.1", "", 0.2, 0, -1, 0, 0},
    {"disorder, paper, eta 0.01", "-sph_laplacian_eta 0.01", 0.2, 0, -1, 0, 0},
    {"disorder, paper, eta 0", "-sph_laplacian_eta 0", 0.2, 0, -1, 0, 0},
    {"disorder, corrected, eta 0.1", "-sph_operators corrected", 0.2, 1, 1, 0, 0},
    {"disorder, corrected, eta 0.01", "-sph_operators corrected -sph_laplacian_eta 0.01", 0.2, 1, 1, 0, 0},
};

static const Box unit = {{0.0, 0.0}, {1.0, 1.0}};

static void Errors(Ground *g, const Packing *packing, PetscReal *gradient, PetscReal *laplacian)
{
  const PetscReal *x     = GroundCore(g, PG_POSITION);
  const PetscInt   owned = GroundOwned(g), local = GroundLocal(g);
  PetscReal       *p, *grad, *lap, sum[4] = {0, 0, 0, 0};

  CHECK(PetscMalloc3(local + 1, &p, 2 * owned + 1, &grad, owned + 1, &lap));
  for (PetscInt a = 0; a < local; a++) p[a] = HillOnSlope(&unit, x + 2 * a);
  CHECK(PgSphGradient(g->sph, p, grad));
  CHECK(PgSphLaplacian(g->sph, p, lap));
  for (PetscInt a = 0; a < owned; a++) {
    PetscReal exact[2];

    if (PackingDepth(packing, GroundIds(g)[a]) < 5.0 + 2.0 * packing->jitter) continue;
    HillGradient(&unit, x + 2 * a, exact);
    for (int i = 0; i < 2; i++) {
      sum[0] += PetscSqr(grad[2 * a + i] - exact[i]);
      sum[1] += PetscSqr(exact[i]);
    }
    sum[2] += PetscSqr(lap[a] - HillLaplacian(&unit, x + 2 * a));
    sum[3] += PetscSqr(HillLaplacian(&unit, x + 2 * a));
  }
  for (int i = 0; i < 4; i++) sum[i] = GroundSum(g, sum[i]);
  *gradient  = PetscSqrtReal(sum[0] / sum[1]);
  *laplacian = PetscSqrtReal(sum[2] / sum[3]);
  CHECK(PetscFree3(p, grad, lap));
}

static void Judge(const Sequence *s, PetscReal order, PetscReal plateau)
{
  const PetscReal found = SequenceOrder(s), last = s->error[s->count - 1];
  char            name[128];

  SequenceLine("operator_mms", s, order, order > 0.0 ? "order - 0.2 at least" : "order within 0.15",
               "next term of the expansion at these h");
  if (order > 0.0) {
    /* what the next term of the expansion may do at these h */
    if (!(found >= order - 0.2)) fail_msg("%s: order %g instead of %g", s->name, (double)found, (double)order);
    return;
  }
  /* no or negative order: the error must not fall */
  NEAR(found, order, 0.15);
  /* the term of order h^2 is about (pi h)^2/8 = 2e-4 relative to 1 at the last refinement, against the smallest plateau of
     0.0114: 2 %; and the digits given */
  if (plateau <= 0.0) return;
  (void)snprintf(name, sizeof name, "%s: error that stays", s->name);
  PlateauLine("operator_mms", name, plateau, last, "3 %", "term of order h^2, digits of the plateau");
  NEAR(last, plateau, 0.03 * plateau);
}

static void OperatorMms(void **state)
{
  (void)state;
  TableHead(PETSC_COMM_WORLD);
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    char     name[96];
    Sequence gradient, laplacian;

    (void)snprintf(name, sizeof name, "gradient, %s", cases[k].name);
    gradient = SequenceStart(name);
    (void)snprintf(name, sizeof name, "laplacian, %s", cases[k].name);
    laplacian = SequenceStart(name);
    for (PetscInt columns = 25; columns <= 200; columns *= 2) {
      const Packing packing = SquarePacking(columns, 1.0, cases[k].jitter);
      Ground        g;
      PetscReal     error[2];

      GroundCreate(PETSC_COMM_WORLD, GROUND_SPH, cases[k].options, &g);
      GroundFill(&g, PackingCount(&packing), PackingPlace, &packing);
      Errors(&g, &packing, &error[0], &error[1]);
      SequenceAdd(&gradient, &g, SmoothingLength(&packing), error[0]);
      SequenceAdd(&laplacian, &g, SmoothingLength(&packing), error[1]);
      GroundDestroy(&g);
    }
    Judge(&gradient, cases[k].gradient, cases[k].gradient_plateau);
    Judge(&laplacian, cases[k].laplacian, cases[k].laplacian_plateau);
  }
}

static const struct CMUnitTest tests[] = {cmocka_unit_test(OperatorMms)};

GROUND_MAIN(tests, PETSC_TRUE)
