/* The object: fields, options, life. */
#include "poreimpl.h"

static const char *const side_words[PG_SIDE_COUNT] = {"left", "right", "bottom", "top"};
static const char *const kind_words[]              = {"drained", "impermeable", "flux", "natural"};
static const char *const porosity_words[]          = {"rae", "kinematic", "kernel"};
static const char *const rate_words[]              = {"kinematic", "sampled"};
static const char *const continuity_words[]        = {"solenoidal", "averaged"};
static const char *const coupling_words[]          = {"drag", "drag_and_pressure"};
static const char *const scheme_words[]            = {"projection", "staggered", "incremental"};
static const char *const tracking_words[]          = {"initial", "surface"};
static const char *const permeability_words[]      = {"constant", "kozeny_carman"};
static const char *const guess_words[]             = {"characteristic", "last"};

static PetscErrorCode RegisterFields(PgPore pore)
{
  enum { STATE = PG_FIELD_MIGRATE | PG_FIELD_HALO | PG_FIELD_RESTART, KEPT = PG_FIELD_MIGRATE | PG_FIELD_RESTART };
  /* a field of the room dem; here the ghosts' values count, too */
  const PgFieldInfo plate = {"plate", 1, "1", "", PG_FIELD_HALO};
  const struct {
    PgField    *field;
    PgFieldInfo info;
  } table[] = {
      {&pore->porosity, {"porosity", 1, "1", "porosity n at the disc, Eq. 62", STATE | PG_FIELD_OUTPUT}},
      {&pore->u, {"fluid_velocity", 2, "m/s", "velocity u of the water at the disc", STATE | PG_FIELD_OUTPUT}},
      {&pore->w,
       {"relative_velocity", 2, "m/s", "n (u - v): velocity of the water relative to the discs",
        KEPT | PG_FIELD_OUTPUT}},
      {&pore->porosity_sample, {"porosity_sample", 1, "1", "porosity in the sample circle, Eq. 61", STATE}},
      {&pore->porosity_initial, {"initial_porosity", 1, "1", "porosity to which the sample is calibrated", KEPT}},
      {&pore->porosity_before, {"porosity_before", 1, "1", "porosity at the start of the fluid step", KEPT}},
      {&pore->rae_area, {"sample_area", 1, "m2", "area of the sample, Eq. 61 (kernel porosity: its norm)", KEPT}},
      {&pore->kernel_start, {"initial_kernel_sum", 1, "1", "sum of W dV at the start, at most 1", KEPT}},
      {&pore->u_tilde, {"fluid_predictor", 2, "m/s", "intermediate velocity of the water, Eq. 46", STATE}},
      {&pore->p_guess, {"pressure_guess", 1, "Pa", "pressure carried along the characteristic, Eq. 59", KEPT}},
      {&pore->drag, {"drag", 2, "N/m3", "force of the discs on the water, Eqs. 20-23", STATE}},
      {&pore->Q, {"fluid_acceleration", 2, "m/s2", "forces on the water per mass, Eq. 41", STATE}},
      {&pore->kick,
       {"pressure_kick", 2, "m/s",
        "velocity that the pressure of t_n gives the disc in the fluid step, to be replaced by "
        "that of t_n+1",
        KEPT}},
      {&pore->side, {"side", 1, "1", "bit s: formed side s (left, right, bottom, top) at the start", KEPT}},
      {&pore->surface, {"surface", 1, "1", "1: came to the surface later", KEPT}},
      {&pore->detached, {"detached", 1, "1", "1: outside the water", KEPT}},
      {&pore->divergence, {"solid_divergence", 1, "1/s", "div v at the end of the fluid step", KEPT}},
  };

  PetscFunctionBeginUser;
  for (size_t i = 0; i < sizeof table / sizeof *table; i++)
    PetscCall(PgParticlesRegisterField(pore->particles, &table[i].info, table[i].field));
  PetscCall(PgParticlesFindField(pore->particles, "fluid_force", &pore->fluid_force));
  PetscCall(PgParticlesRegisterField(pore->particles, &plate, &pore->plate));
  PetscCall(PgParticlesFindField(pore->particles, "volume", &pore->volume));
  PetscCall(PgParticlesFindField(pore->particles, "pressure", &pore->p));
  PetscCall(PgParticlesFindField(pore->particles, "pressure_fixed", &pore->p_fixed));
  PetscCall(PgParticlesFindField(pore->particles, "pressure_prescribed", &pore->p_prescribed));
  PetscCheck(pore->fluid_force >= 0 && pore->plate >= 0, PgParticlesComm(pore->particles), PETSC_ERR_ORDER,
             "create the discs' dynamics (PgDem) before the water");
  PetscFunctionReturn(0);
}

PetscErrorCode PgPoreCreate(PgParticles particles, PgNeighbors neighbors, PgFluid fluid, PgPore *pore)
{
  PgPore p;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&p));
  p->particles        = particles;
  p->neighbors        = neighbors;
  p->fluid            = fluid;
  p->scheme           = fluid == PG_FLUID_DARCY ? &PgSchemeDarcy : &PgSchemeNavierStokes;
  p->rho_f            = 1.0e3;
  p->rho_s            = 2.0e3;
  p->mu               = 1.01e-3;
  p->k_p              = 6.5e-7;
  p->p_initial        = 1.0e5;
  p->theta            = 1.0;
  p->n_min            = 0.01;
  p->n_max            = 0.98;
  p->surface_sum      = 0.92;
  p->surface_sum_back = 0.95;
  p->detach_n         = 0.4;
  p->detach_sum       = 0.6;
  p->guard_pressure   = 1.0e9;
  p->guard_speed      = 1.0e3;
  p->guard_clipped    = 0.5;
  p->grad_p_revision  = -1;
  for (int s = 0; s < PG_SIDE_COUNT; s++) p->boundary[s] = (PgBoundary){PG_BC_DRAINED, p->p_initial, 0.0};
  PetscCall(PgDragLawFind("ergun_wen_yu", &p->drag_law));
  PetscCall(PgSphCreate(particles, neighbors, &p->sph));
  PetscCall(PgPressureCreate(particles, neighbors, p->sph, &p->pressure));
  PetscCall(PgNeighborsRequestRows(neighbors, 4.0, 1.0)); /* a sample circle of 4 r_a and the disc that crosses it */
  PetscCall(RegisterFields(p));
  *pore = p;
  PetscFunctionReturn(0);
}

static PetscErrorCode BoundaryOptions(PgPore pore, PetscOptionItems *PetscOptionsObject)
{
  PetscInt tracking = pore->tracking;

  PetscFunctionBeginUser;
  for (int s = 0; s < PG_SIDE_COUNT; s++) {
    PgBoundary *bc   = &pore->boundary[s];
    PetscInt    kind = bc->kind;
    PetscBool   flux;
    char        name[64], text[96];

    PetscCall(PetscSNPrintf(name, sizeof name, "-bc_%s", side_words[s]));
    PetscCall(PetscSNPrintf(text, sizeof text, "kind of the %s side for the water", side_words[s]));
    PetscCall(PgOptionChoice(PetscOptionsObject, name, text, 4, kind_words, &kind, NULL));
    bc->kind = (PgBoundaryKind)kind;
    PetscCall(PetscSNPrintf(name, sizeof name, "-bc_%s_pressure", side_words[s]));
    bc->pressure = pore->p_initial;
    PetscCall(
        PgOptionReal(PetscOptionsObject, name, "pressure of a drained side", "Pa", -1e12, 1e12, &bc->pressure, NULL));
    PetscCall(PetscSNPrintf(name, sizeof name, "-bc_%s_flux", side_words[s]));
    PetscCall(PgOptionReal(PetscOptionsObject, name, "Darcy velocity through a flux side along the positive axis",
                           "m/s", -1e3, 1e3, &bc->flux, &flux));
    PgInputCheck(flux || kind != PG_BC_FLUX, PetscOptionsObject->comm,
                 "option -bc_%s flux needs -bc_%s_flux W, the Darcy velocity through that side along the positive axis "
                 "[m/s]",
                 side_words[s], side_words[s]);
  }
  PetscCall(
      PgOptionChoice(PetscOptionsObject, "-bc_tracking",
                     "drained discs: those of the sides at the start, or also those that come to the surface later", 2,
                     tracking_words, &tracking, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-bc_surface_sum", "kernel sum below which a disc is at the surface", "1",
                         0.0, 2.0, &pore->surface_sum, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-detach_porosity", "porosity above which a disc is outside the water",
                         "1", 0.0, 0.99, &pore->detach_n, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-detach_kernel_sum", "kernel sum below which a disc is outside the water",
                         "1", 0.0, 1.0, &pore->detach_sum, NULL));
  pore->surface_sum_back = pore->surface_sum + 0.03; /* hysteresis, so that discs do not flicker */
  pore->tracking         = (PgTracking)tracking;
  PetscFunctionReturn(0);
}

static PetscErrorCode SchemeOptions(PgPore pore, PetscOptionItems *PetscOptionsObject)
{
  PetscInt continuity = pore->continuity, coupling = pore->coupling, scheme, porosity = pore->porosity_kind,
           rate = pore->rate_kind, local = pore->k_p_local, guess = pore->guess;
  const char *loser = "";
  char        law[64];

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(law, pore->drag_law->name, sizeof law));
  PetscCall(PgOptionReal(PetscOptionsObject, "-permeability", "Darcy permeability k_p, Eq. 26", "m4/(N s)", PG_POSITIVE,
                         1e3, &pore->k_p, NULL));
  PetscCall(PgOptionChoice(PetscOptionsObject, "-permeability_law",
                           "k_p constant, or from the local porosity by Eq. 66", 2, permeability_words, &local, NULL));
  if (local) PetscCall(PgOptionsOneOf(PetscOptionsObject->comm, "-permeability", "-permeability_law", &loser));
  if (!strcmp(loser, "-permeability_law")) local = 0;
  PetscCall(PgOptionReal(PetscOptionsObject, "-ns_theta", "implicitness of the forces on the water, Eq. 41", "1", 0.01,
                         1.0, &pore->theta, NULL));
  PetscCall(PgOptionChoice(PetscOptionsObject, "-ns_continuity",
                           "div u = 0 (Eq. 48), or mass balance with the change of porosity (Eq. 30)", 2,
                           continuity_words, &continuity, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-ns_smoothing",
                         "fraction of u~ replaced by its kernel mean in each fluid step (XSPH)", "1", 0.0, 1.0,
                         &pore->smoothing, NULL));
  PetscCall(PgOptionString(PetscOptionsObject, "-ns_drag",
                           "drag law, Eqs. 20-23: ergun_wen_yu or linear (Eq. 65 alone)", law, sizeof law, NULL));
  PetscCall(PgDragLawFind(law, &pore->drag_law));
  PgInputCheck(pore->drag_law, PetscOptionsObject->comm, "option -ns_drag: '%s' is not one of ergun_wen_yu, linear",
               law);
  PetscCall(PgOptionChoice(PetscOptionsObject, "-coupling",
                           "force of the water on discs: drag (Eqs. 24, 29), or also the pressure gradient", 2,
                           coupling_words, &coupling, NULL));
  /* div u = 0 does not contain the discs' velocity: nothing to project */
  scheme = pore->fluid == PG_FLUID_NS && continuity == PG_CONTINUITY_SOLENOIDAL ? PG_SCHEME_STAGGERED
                                                                                : PG_SCHEME_PROJECTION;
  PetscCall(PgOptionChoice(
      PetscOptionsObject, "-coupling_scheme",
      "pressure-gradient force: both phases projected with the new pressure; force of the old one; or that, "
      "corrected by projection with the increment; default: projection, but staggered with -fluid ns "
      "-ns_continuity solenoidal",
      3, scheme_words, &scheme, NULL));
  PgInputCheck(!(pore->fluid == PG_FLUID_NS && continuity == PG_CONTINUITY_SOLENOIDAL &&
                 coupling == PG_COUPLING_DRAG_AND_PRESSURE && scheme != PG_SCHEME_STAGGERED),
               PetscOptionsObject->comm,
               "options -coupling_scheme %s and -ns_continuity solenoidal contradict each other: div u = 0 "
               "does not contain the discs' velocity",
               scheme_words[scheme]);
  PetscCall(PgOptionChoice(PetscOptionsObject, "-porosity",
                           "sample circle (Eqs. 61, 62), (1-n) div v, or kernel-weighted", 3, porosity_words, &porosity,
                           NULL));
  PetscCall(PgOptionChoice(PetscOptionsObject, "-porosity_rate",
                           "Dn/Dt in the mass balance: (1-n) div v, or difference of samples", 2, rate_words, &rate,
                           NULL));
  PetscCall(
      PgOptionChoice(PetscOptionsObject, "-pressure_guess",
                     "start of the pressure solve: carried along the characteristic (Eq. 59), or the last solution", 2,
                     guess_words, &guess, NULL));
  pore->guess           = (PgGuess)guess;
  pore->k_p_local       = (PetscBool)local;
  pore->continuity      = (PgContinuity)continuity;
  pore->coupling        = (PgCoupling)coupling;
  pore->coupling_scheme = (PgCouplingScheme)scheme;
  pore->porosity_kind   = (PgPorosityKind)porosity;
  pore->rate_kind       = (PgPorosityRate)rate;
  PetscFunctionReturn(0);
}

PetscErrorCode PgPoreSetFromOptions(PgPore pore)
{
  MPI_Comm comm = PgParticlesComm(pore->particles);

  PetscFunctionBeginUser;
  PetscOptionsBegin(comm, "", "water: pore water, drag, porosity and sides", "");
  PetscCall(PgOptionReal(PetscOptionsObject, "-fluid_density", "density of the water rho_f", "kg/m3", PG_POSITIVE, 1e6,
                         &pore->rho_f, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-fluid_viscosity", "viscosity of the water mu", "N s/m2", PG_POSITIVE,
                         1e6, &pore->mu, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-initial_pressure", "pressure of the water at the start", "Pa", -1e12,
                         1e12, &pore->p_initial, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-porosity_min", "porosities below are clipped and counted", "1", 1e-6,
                         0.5, &pore->n_min, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-porosity_max", "porosities above are clipped and counted", "1", 0.5,
                         0.999, &pore->n_max, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-pore_guard_pressure", "largest |p| of a run that goes on", "Pa",
                         PG_POSITIVE, 1e300, &pore->guard_pressure, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-pore_guard_clipped",
                         "largest part of the discs whose porosity is clipped in a step of a run that goes on", "1",
                         0.0, 1.0, &pore->guard_clipped, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-pore_guard_speed", "largest |u| of a run that goes on", "m/s",
                         PG_POSITIVE, 1e300, &pore->guard_speed, NULL));
  PetscCall(SchemeOptions(pore, PetscOptionsObject));
  PetscCall(BoundaryOptions(pore, PetscOptionsObject));
  PetscOptionsEnd();
  PetscCall(PgPressureSetReference(pore->pressure, pore->p_initial));
  PetscCall(PgSphSetFromOptions(pore->sph));
  PetscCall(PgPressureSetFromOptions(pore->pressure));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPoreCheckStep(PgPore pore, PetscReal dt_f)
{
  MPI_Comm comm = PgParticlesComm(pore->particles);

  PetscFunctionBeginUser;
  if (PgPoreThetaIsSmall(pore))
    PetscCall(PetscPrintf(comm,
                          "warning: -ns_theta %g is below 0.57: with the paper's operators long waves of the pressure "
                          "grow below 0.566\n",
                          (double)pore->theta));
  if (PgPoreIsLooselyCoupled(pore))
    PetscCall(PetscPrintf(comm, "warning: -coupling_scheme staggered with -ns_continuity averaged is unstable for "
                                "every time step (added mass of the pore water)\n"));
  if (PgPoreIsStaggered(pore) && pore->fluid == PG_FLUID_DARCY) {
    const PetscReal bound = 2.0 * pore->k_p * (1.0 - 0.1) * pore->rho_s; /* 2 k_p (1 - n) rho_s at n = 0.1 */
    PgInputCheck(dt_f < bound, comm,
                 "-coupling_scheme staggered with Darcy's law is unstable for a fluid step of %g s: it must be below 2 "
                 "k_p (1 - n) rho_s = %g s, or use -coupling_scheme projection",
                 (double)dt_f, (double)bound);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgPoreView(PgPore pore, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(viewer, "pore water: %s, rho_f = %g kg/m3, mu = %g N s/m2, initial pressure %g Pa\n",
                                   pore->scheme->name, (double)pore->rho_f, (double)pore->mu, (double)pore->p_initial));
  if (pore->fluid == PG_FLUID_NS)
    PetscCall(PetscViewerASCIIPrintf(viewer, "  theta %g, continuity %s, drag %s, smoothing %g\n", (double)pore->theta,
                                     continuity_words[pore->continuity], pore->drag_law->name,
                                     (double)pore->smoothing));
  else
    PetscCall(PetscViewerASCIIPrintf(viewer, "  permeability %s %g m4/(N s)\n", permeability_words[pore->k_p_local],
                                     (double)pore->k_p));
  PetscCall(
      PetscViewerASCIIPrintf(viewer, "  coupling %s%s%s, porosity %s with rate %s\n", coupling_words[pore->coupling],
                             pore->coupling == PG_COUPLING_DRAG_AND_PRESSURE ? " by " : "",
                             pore->coupling == PG_COUPLING_DRAG_AND_PRESSURE ? scheme_words[pore->coupling_scheme] : "",
                             porosity_words[pore->porosity_kind], rate_words[pore->rate_kind]));
  for (int s = 0; s < PG_SIDE_COUNT; s++) {
    const PgBoundary *bc = &pore->boundary[s];
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %s: %s", side_words[s], kind_words[bc->kind]));
    if (bc->kind == PG_BC_DRAINED) PetscCall(PetscViewerASCIIPrintf(viewer, " at %g Pa", (double)bc->pressure));
    if (bc->kind == PG_BC_FLUX) PetscCall(PetscViewerASCIIPrintf(viewer, " %g m/s", (double)bc->flux));
    PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  }
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "  drained discs: %s; outside the water above n = %g or below a kernel sum of %g\n",
                                   tracking_words[pore->tracking], (double)pore->detach_n, (double)pore->detach_sum));
  PetscCall(PgSphView(pore->sph, viewer));
  PetscCall(PgPressureView(pore->pressure, viewer));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPoreDestroy(PgPore *pore)
{
  PetscFunctionBeginUser;
  if (!*pore) PetscFunctionReturn(0);
  PetscCall(PgOverlapsDestroy(&(*pore)->overlaps));
  PetscCall(PetscFree5((*pore)->grad_p, (*pore)->grad_u, (*pore)->n_flow, (*pore)->head, (*pore)->Z));
  PetscCall(PetscFree2((*pore)->a, (*pore)->b));
  PetscCall(PgPressureDestroy(&(*pore)->pressure));
  PetscCall(PgSphDestroy(&(*pore)->sph));
  PetscCall(PetscFree(*pore));
  PetscFunctionReturn(0);
}

PetscErrorCode PgPoreSetGravity(PgPore pore, const PetscReal gravity[2])
{
  PetscFunctionBeginUser;
  pore->gravity[0] = gravity[0];
  pore->gravity[1] = gravity[1];
  PetscFunctionReturn(0);
}

PetscErrorCode PgPoreSetSolidDensity(PgPore pore, PetscReal rho_s)
{
  PetscFunctionBeginUser;
  pore->rho_s = rho_s;
  PetscFunctionReturn(0);
}

PetscErrorCode PgPoreSetBoundary(PgPore pore, PgSide side, const PgBoundary *boundary)
{
  PetscFunctionBeginUser;
  pore->boundary[side] = *boundary;
  PetscFunctionReturn(0);
}

PetscErrorCode PgPoreGetBoundary(PgPore pore, PgSide side, PgBoundary *boundary)
{
  PetscFunctionBeginUser;
  *boundary = pore->boundary[side];
  PetscFunctionReturn(0);
}

PetscErrorCode PgPoreGetParts(PgPore pore, PgSph *sph, PgPressure *pressure)
{
  PetscFunctionBeginUser;
  if (sph) *sph = pore->sph;
  if (pressure) *pressure = pore->pressure;
  PetscFunctionReturn(0);
}

PetscErrorCode PgPoreSetInitialPressure(PgPore pore, PetscReal pressure)
{
  PetscFunctionBeginUser;
  pore->p_initial = pressure;
  PetscFunctionReturn(0);
}
