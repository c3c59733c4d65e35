/* Options -wcsph_*, and what the object says of its settings. */
#include "wcsphimpl.h"

static const char *const density_words[] = {"continuity", "summation"};
static const char *const state_words[]   = {"linear", "tait"};
static const char *const solid_words[]   = {"adjoint", "mirror", "extrapolated", "own"};
static const char *const slip_words[]    = {"no_slip", "plain"};
static const char *const kernel_words[]  = {"cubic_spline", "quintic_spline"};

static PetscErrorCode LiquidOptions(PgWcsph w, PetscOptionItems *PetscOptionsObject)
{
  PetscFunctionBeginUser;
  PetscCall(PgOptionReal(PetscOptionsObject, "-wcsph_rest_density", "density rho_0 at pressure 0", "kg/m3", PG_POSITIVE,
                         1e9, &w->rho_0, NULL));
  PetscCall(
      PgOptionReal(PetscOptionsObject, "-wcsph_viscosity", "viscosity mu, Eq. 35", "Pa s", 0.0, 1e9, &w->mu, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-wcsph_sound_speed",
                         "numerical speed of sound c_0; ten times the speeds of the flow, and c_0^2 a hundred times "
                         "pressure over density",
                         "m/s", PG_POSITIVE, 1e9, &w->c_0, NULL));
  PetscCall(PgOptionReals(PetscOptionsObject, "-wcsph_gravity", "force on the liquid per mass, gravity", "m/s2", 2,
                          w->gravity, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-wcsph_diffusion",
                         "diffusion delta of density (Molteni and Colagrossi), hydrostatic part excepted", "1", 0.0,
                         1.0, &w->delta, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-wcsph_damping", "rate of a damping -rate v of the liquid at the start",
                         "1/s", 0.0, 1e12, &w->damping, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-wcsph_damping_end", "when that damping ends", "s", 0.0, 1e15,
                         &w->damp_end, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode SchemeOptions(PgWcsph w, PetscOptionItems *PetscOptionsObject)
{
  PetscInt density = (PetscInt)w->density, state = (PetscInt)w->state, solid = (PetscInt)w->solid,
           slip = (PetscInt)w->slip, kernel;
  PetscBool cubic;

  PetscFunctionBeginUser;
  PetscCall(PetscStrcmp(w->kernel->name, kernel_words[0], &cubic));
  kernel = !cubic;
  PetscCall(PgOptionChoice(PetscOptionsObject, "-wcsph_kernel", "kernel, Eqs. 36, 37", 2, kernel_words, &kernel, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-wcsph_smoothing", "smoothing length h over the spacing of particles",
                         "1", 0.8, 4.0, &w->smoothing, NULL));
  PetscCall(PgOptionChoice(PetscOptionsObject, "-wcsph_density",
                           "density: its rate by continuity, or from the positions by Eq. 26", 2, density_words,
                           &density, NULL));
  PetscCall(PgOptionChoice(PetscOptionsObject, "-wcsph_state", "equation of state", 2, state_words, &state, NULL));
  PetscCall(PgOptionChoice(
      PetscOptionsObject, "-wcsph_wall",
      "pressure of walls and bodies: of the liquid around, which also takes their change of volume; of the partner; of "
      "the liquid around as Adami, Hu and Adams have it, which does not keep the energy; or by a density of their own",
      4, solid_words, &solid, NULL));
  PetscCall(PgOptionChoice(PetscOptionsObject, "-wcsph_wall_velocity",
                           "velocity of walls and bodies in the viscous term: such that the liquid sticks to them, or "
                           "their own (first order only)",
                           2, slip_words, &slip, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-wcsph_contact",
                         "stiffness of walls and bodies against each other, over rho_0 c_0^2; 0: none", "1", 0.0, 1e6,
                         &w->contact, NULL));
  PetscCall(PgOptionBool(PetscOptionsObject, "-wcsph_contact_friction",
                         "viscous friction between walls and bodies, Eq. 35", &w->friction, NULL));
  w->density = (PgWcsphDensity)density;
  w->state   = (PgWcsphState)state;
  w->solid   = (PgWcsphSolid)solid;
  w->slip    = (PgWcsphSlip)slip;
  PetscCall(PgKernelFind(kernel_words[kernel], &w->kernel));
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphSetFromOptions(PgWcsph w)
{
  PetscFunctionBeginUser;
  PetscCheck(!w->set_up, w->comm, PETSC_ERR_ORDER, "options come before PgWcsphSetUp()");
  PetscOptionsBegin(w->comm, "", "wcsph: weakly compressible liquid (Tak, Park & Park 2013)", "");
  PetscCall(LiquidOptions(w, PetscOptionsObject));
  PetscCall(SchemeOptions(w, PetscOptionsObject));
  PetscOptionsEnd();
  PetscCall(PgParticlesSetFromOptions(w->particles));
  PetscCall(PgNeighborsSetFromOptions(w->neighbors));
  PetscFunctionReturn(0);
}

static const PgOptionRule rules[] = {
    {"-wcsph_diffusion", "-wcsph_density continuity", "Eq. 26 leaves nothing to diffuse"},
    {"-wcsph_damping", "-wcsph_damping_end", "it ends at once"},
    {"-wcsph_damping_end", "-wcsph_damping", "there is no damping to end"},
    {"-wcsph_contact", "bodies", "nothing meets"},
    {"-wcsph_contact", "-wcsph_wall adjoint|mirror|extrapolated or -wcsph_density continuity",
     "walls and bodies meet by their densities"},
    {"-wcsph_contact_friction", "bodies", "nothing meets"},
    {"-wcsph_seed", "-wcsph_jitter", "nothing is displaced"},
};

static PetscBool Fact(void *wcsph, const char name[])
{
  (void)name;
  return (PetscBool)(((PgWcsph)wcsph)->added_bodies > 0);
}

PetscErrorCode PgWcsphCheckOptions(PgWcsph w, PetscInt count, const PgOptionRule more[],
                                   PetscErrorCode (*probe)(void *), void *context)
{
  const PetscInt own = (PetscInt)(sizeof rules / sizeof *rules);
  PgOptionRules  all = {.count = own + count, .fact = Fact, .context = w};
  PgOptionRule  *rule;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(all.count, &rule));
  for (PetscInt k = 0; k < all.count; k++) rule[k] = k < own ? rules[k] : more[k - own];
  all.rule = rule;
  PetscCall(PgOptionsCheck(w->comm, &all, probe, context));
  PetscCall(PetscFree(rule));
  PetscFunctionReturn(0);
}

PetscErrorCode PgWcsphView(PgWcsph w, PetscViewer viewer)
{
  PetscInt  global;
  PetscReal dt;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(w->particles, NULL, NULL, &global));
  PetscCall(PgWcsphGetTimeStep(w, &dt));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "wcsph: %" PetscInt_FMT " particles, spacing %g m, kernel %s, h = %g m; density by "
                                   "%s, state %s, diffusion %g\n",
                                   global, (double)w->dx, w->kernel->name, (double)w->h, density_words[w->density],
                                   state_words[w->state], (double)w->delta));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "wcsph: rho_0 %g kg/m3, mu %g Pa s, c_0 %g m/s, gravity (%g, %g) m/s2; walls: "
                                   "pressure %s, velocity %s; largest time step %g s\n",
                                   (double)w->rho_0, (double)w->mu, (double)w->c_0, (double)w->gravity[0],
                                   (double)w->gravity[1], solid_words[w->solid], slip_words[w->slip], (double)dt));
  PetscFunctionReturn(0);
}
