/* The dem object: fields, options, settings, plates. */
#include "demimpl.h"
#include <string.h>

static PetscErrorCode RegisterFields(PgDem dem)
{
  const unsigned    kept   = PG_FIELD_MIGRATE | PG_FIELD_RESTART;
  const PgFieldInfo info[] = {
      {"force", 2, "N/m", "Force on the disc: contacts, plate, walls, gravity, water, external, damping", kept},
      {"torque", 1, "N", "Moment on the disc: contacts, plate, walls, damping", kept},
      {"fluid_force", 2, "N/m", "Force of the pore water on the disc", kept},
      {"external_force", 2, "N/m", "External force on the disc, f^e of Eq. 1", kept},
      {"plate", 1, "1", "1 + index of the plate that moves the disc, 0 for a free disc", kept},
      {"plate_spring", 1, "N/m", "Elastic friction force of the plate on the disc", kept},
      {"plate_reaction", 2, "N/m", "Vertical reaction of the plate to the disc: to its contacts, to all forces", kept},
      {"coordination_number", 1, "1", "Discs and walls that touch this one, and its plate if that pushes",
       PG_FIELD_OUTPUT},
      {"stress", 4, "Pa",
       "Stress of the contact, wall and plate forces on the disc, tension positive: over pi r^2/(1 - porosity) in "
       "water, "
       "over pi r^2 in a dry run",
       PG_FIELD_OUTPUT},
      {"contact_share", 1, "1", "Springs that share the mass of the disc in the critical time step", PG_FIELD_HALO},
  };
  PgField *const field[] = {&dem->force,  &dem->torque,       &dem->fluid_force,    &dem->external_force,
                            &dem->plate,  &dem->plate_spring, &dem->plate_reaction, &dem->coordination,
                            &dem->stress, &dem->share};

  PetscFunctionBeginUser;
  for (size_t k = 0; k < sizeof(info) / sizeof(*info); k++)
    PetscCall(PgParticlesRegisterField(dem->particles, &info[k], field[k]));
  PetscCall(PgParticlesRegisterRagged(dem->particles, "contact_history", 4, kept, &dem->history));
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemCreate(PgParticles particles, PgNeighbors neighbors, PgDem *dem)
{
  PgDem d;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&d));
  d->particles             = particles;
  d->neighbors             = neighbors;
  d->law                   = &PgContactLaws[0];
  d->parameters.k_n        = 6e8; /* values of the paper's examples */
  d->parameters.k_s        = 4e8;
  d->parameters.k_r        = 2e3;
  d->parameters.k_theta    = 700;
  d->parameters.mu_s       = 0.5;
  d->parameters.mu_r       = 0.5;
  d->parameters.mu_theta_r = 1e-4;
  d->parameters.bond_range = 1e-9;
  d->parameters.E          = 1e8;
  d->parameters.nu         = 0.25;
  d->plate_friction        = 0.5;
  d->wall_friction         = -1;
  d->servo_gain            = 0.5;
  d->guard_overlap         = 0.5;
  d->guard_speed           = 1e3;
  d->guard_time_step       = 1;
  d->guard_domain[0] = d->guard_domain[2] = -PETSC_MAX_REAL;
  d->guard_domain[1] = d->guard_domain[3] = PETSC_MAX_REAL;
  d->lists                                = -1;
  d->plate_discs_made                     = -1;
  d->wall_lists                           = -1;
  PetscCall(RegisterFields(d));
  *dem = d;
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemDestroy(PgDem *dem)
{
  PgDem d = *dem;

  PetscFunctionBeginUser;
  if (!d) PetscFunctionReturn(0);
  PetscCall(PetscFree4(d->pairs.f_s, d->pairs.f_r, d->pairs.m_r, d->pairs.result));
  PetscCall(PetscFree(d->pairs.lost));
  PetscCall(PetscFree(d->plates));
  PetscCall(PetscFree(d->plate_disc));
  for (PetscInt k = 0; k < d->wall_count; k++) PetscCall(PetscFree(d->walls[k]));
  PetscCall(PetscFree(d->walls));
  PetscCall(PetscFree(d->wall_contact));
  PetscCall(PetscFree(d->wall_spare));
  PetscCall(PetscFree2(d->servo_sum, d->servo_value));
  PetscCall(PetscFree(d->work));
  PetscCall(PetscFree(d->offset));
  PetscCall(PetscFree(*dem));
  PetscFunctionReturn(0);
}

/* Stiffnesses, dashpots and friction coefficients as options: name, text, unit, place, smallest value. */
typedef struct {
  const char *name, *text, *unit;
  size_t      place;
  PetscReal   lower;
  const char *law; /* that it belongs to alone; NULL: of others, too */
} ParameterOption;

#define PLACE(member) offsetof(PgContactParameters, member)
static const ParameterOption parameter_options[] = {
    {"-dem_k_n", "Normal stiffness, Eq. 8", "N/m", PLACE(k_n), PG_POSITIVE, NULL},
    {"-dem_k_s", "Sliding stiffness, Eq. 13", "N/m", PLACE(k_s), 0, NULL},
    {"-dem_k_r", "Rolling stiffness, Eq. 13; 0 switches the rolling force off", "N/m", PLACE(k_r), 0, "li2007"},
    {"-dem_k_theta", "Rolling moment stiffness, Eq. 4", "N m/rad", PLACE(k_theta), 0, "li2007"},
    {"-dem_c_n", "Normal dashpot, Eq. 8", "N s/m", PLACE(c_n), 0, NULL},
    {"-dem_c_s", "Sliding dashpot, Eq. 13", "N s/m", PLACE(c_s), 0, NULL},
    {"-dem_c_r", "Rolling dashpot, Eq. 13", "N s/m", PLACE(c_r), 0, "li2007"},
    {"-dem_c_theta", "Rolling moment dashpot, Eq. 4", "N m s/rad", PLACE(c_theta), 0, "li2007"},
    {"-dem_mu_s", "Sliding friction coefficient, Eqs. 14-17", "1", PLACE(mu_s), 0, NULL},
    {"-dem_mu_r", "Rolling friction coefficient, Eqs. 14-15; at most mu_s", "1", PLACE(mu_r), 0, "li2007"},
    {"-dem_mu_theta_r", "Rolling moment arm mu_theta r, Eqs. 5-6", "m", PLACE(mu_theta_r), 0, "li2007"},
    {"-dem_bond_normal", "Strength R_n of a bond in tension", "N/m", PLACE(R_n), 0, "tak2013"},
    {"-dem_bond_tangential", "Strength R_t of a bond in shear", "N/m", PLACE(R_t), 0, "tak2013"},
    {"-dem_bond_range", "Discs nearer to each other than this at the start of a run are bonded", "m", PLACE(bond_range),
     0, "tak2013"},
    {"-dem_hertz_young", "Young's modulus of the discs, Eq. 18 of Tak et al.", "Pa", PLACE(E), PG_POSITIVE, "hertz"},
    {"-dem_hertz_poisson", "Poisson's ratio of the discs, Eq. 18 of Tak et al.; below 0.5", "1", PLACE(nu), 0, "hertz"},
};
enum { PARAMETER_OPTIONS = sizeof(parameter_options) / sizeof(*parameter_options) };

static PetscReal *ParameterAt(PgContactParameters *parameters, const ParameterOption *option)
{
  return (PetscReal *)((char *)parameters + option->place);
}

static PetscErrorCode CheckParameters(PgDem dem)
{
  const PgContactParameters *p = &dem->parameters;

  PetscFunctionBeginUser;
  PgInputCheck(dem->law->stiffness || p->mu_r <= p->mu_s, PgParticlesComm(dem->particles),
               "-dem_mu_r %g is larger than -dem_mu_s %g: Eqs. 16-17 need mu_r <= mu_s", (double)p->mu_r,
               (double)p->mu_s);
  PgInputCheck(p->nu < 0.5, PgParticlesComm(dem->particles), "-dem_hertz_poisson %g must be below 0.5", (double)p->nu);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadLaw(PgDem dem, PetscOptionItems *PetscOptionsObject)
{
  const char *words[16];
  PetscInt    n = 0, chosen = (PetscInt)(dem->law - PgContactLaws);

  PetscFunctionBeginUser;
  for (; PgContactLaws[n].name; n++) words[n] = PgContactLaws[n].name;
  PetscCall(PgOptionChoice(PetscOptionsObject, "-dem_contact_law", "Contact law of a pair", n, words, &chosen, NULL));
  dem->law = &PgContactLaws[chosen];
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadOptions(PgDem dem, PetscOptionItems *PetscOptionsObject, PetscBool *energy)
{
  PetscFunctionBeginUser;
  PetscCall(ReadLaw(dem, PetscOptionsObject));
  for (PetscInt k = 0; k < PARAMETER_OPTIONS; k++) {
    const ParameterOption *o = &parameter_options[k];
    PetscCall(PgOptionReal(PetscOptionsObject, o->name, o->text, o->unit, o->lower, PETSC_MAX_REAL,
                           ParameterAt(&dem->parameters, o), NULL));
  }
  PetscCall(PgOptionReal(PetscOptionsObject, "-dem_local_damping", "Local damping, -alpha |F| sign(v)", "1", 0, 1,
                         &dem->local_damping, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-dem_global_damping", "Viscous damping, -c m v and -c I w", "1/s", 0,
                         PETSC_MAX_REAL, &dem->global_damping, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-plate_friction", "Friction coefficient of the plates", "1", 0,
                         PETSC_MAX_REAL, &dem->plate_friction, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-wall_friction", "Friction coefficient of the walls; default: -dem_mu_s",
                         "1", 0, PETSC_MAX_REAL, &dem->wall_friction, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-wall_servo_gain",
                         "Part of the missing force that a servo wall makes up for in a step", "1", PG_POSITIVE, 1,
                         &dem->servo_gain, NULL));
  PetscCall(PgOptionBool(PetscOptionsObject, "-dem_energy", "Keep energy accounts and show them in the history", energy,
                         NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-dem_guard_overlap",
                         "Stop when an overlap is larger than this part of the smaller radius", "1", PG_POSITIVE, 2,
                         &dem->guard_overlap, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-dem_guard_speed", "Stop when a disc is faster", "m/s", PG_POSITIVE,
                         PETSC_MAX_REAL, &dem->guard_speed, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-dem_guard_time_step",
                         "Stop when the time step is above this multiple of the critical one of the contacts as they "
                         "are",
                         "1", PG_POSITIVE, PETSC_MAX_REAL, &dem->guard_time_step, NULL));
  PetscCall(PgOptionReals(PetscOptionsObject, "-dem_guard_domain",
                          "Stop when the centre of a disc leaves x low, x high, y low, y high; default: no bounds", "m",
                          4, dem->guard_domain, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemSetFromOptions(PgDem dem)
{
  PetscBool energy = dem->energy;

  PetscFunctionBeginUser;
  PetscOptionsBegin(PgParticlesComm(dem->particles), NULL, "dem: discs in contact", NULL);
  PetscCall(ReadOptions(dem, PetscOptionsObject, &energy));
  PetscOptionsEnd();
  /* asked for with a law that has no accounts: PgOptionsCheck() says that it is without effect */
  PetscCall(PgDemSetEnergy(dem, (PetscBool)(energy && dem->law->loop_energy)));
  PetscCall(CheckParameters(dem));
  PetscFunctionReturn(0);
}

static PetscErrorCode ViewWalls(PgDem dem, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < dem->wall_count; k++) {
    const PgWall *w = &dem->walls[k]->wall;

    PetscCall(PetscViewerASCIIPrintf(viewer, "wall %s: through (%g, %g) m, normal (%g, %g), friction %g, ", w->name,
                                     (double)w->point[0], (double)w->point[1], (double)w->normal[0],
                                     (double)w->normal[1], (double)PgDemWallFriction_Private(dem, w)));
    if (w->kind == PG_WALL_FIXED) PetscCall(PetscViewerASCIIPrintf(viewer, "fixed\n"));
    if (w->kind == PG_WALL_MOVING)
      PetscCall(
          PetscViewerASCIIPrintf(viewer, "velocity (%g, %g) m/s\n", (double)w->velocity[0], (double)w->velocity[1]));
    if (w->kind == PG_WALL_SERVO)
      PetscCall(PetscViewerASCIIPrintf(viewer, "held at %g N/m2 with at most %g m/s, gain %g\n", (double)w->stress,
                                       (double)w->max_velocity, (double)dem->servo_gain));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemView(PgDem dem, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(viewer, "Solid phase: contact law %s (%s)\n", dem->law->name, dem->law->citation));
  PetscCall(PetscViewerASCIIPushTab(viewer));
  for (PetscInt k = 0; k < PARAMETER_OPTIONS; k++) {
    const ParameterOption *o = &parameter_options[k];
    if (o->law && strcmp(o->law, dem->law->name) != 0) continue;
    PetscCall(PetscViewerASCIIPrintf(viewer, "%s: %s = %g %s\n", o->text, o->name + 5,
                                     (double)*ParameterAt(&dem->parameters, o), o->unit));
  }
  PetscCall(PetscViewerASCIIPrintf(viewer, "local damping %g, global damping %g 1/s\n", (double)dem->local_damping,
                                   (double)dem->global_damping));
  PetscCall(
      PetscViewerASCIIPrintf(viewer, "gravity (%g, %g) m/s2\n", (double)dem->gravity[0], (double)dem->gravity[1]));
  PetscCall(PetscViewerASCIIPrintf(
      viewer, "guard: overlap %g of the smaller radius, speed %g m/s, time step %g of the critical\n",
      (double)dem->guard_overlap, (double)dem->guard_speed, (double)dem->guard_time_step));
  for (PetscInt k = 0; k < dem->plate_count; k++) {
    const PgPlate *p = &dem->plates[k];
    if (p->hold)
      PetscCall(PetscViewerASCIIPrintf(viewer, "plate %s: holds its discs\n", p->name));
    else
      PetscCall(PetscViewerASCIIPrintf(viewer, "plate %s: %s its discs, velocity %g m/s, friction %g\n", p->name,
                                       p->side > 0 ? "above" : "below", (double)p->velocity,
                                       (double)PgDemPlateFriction_Private(dem, p)));
  }
  PetscCall(ViewWalls(dem, viewer));
  PetscCall(PetscViewerASCIIPopTab(viewer));
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemGetParameters(PgDem dem, PgContactParameters *parameters)
{
  PetscFunctionBeginUser;
  *parameters = dem->parameters;
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemSetParameters(PgDem dem, const PgContactParameters *parameters)
{
  PgContactParameters given = *parameters;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < PARAMETER_OPTIONS; k++) {
    const ParameterOption *o     = &parameter_options[k];
    const PetscReal        value = *ParameterAt(&given, o);
    if (o->law && strcmp(o->law, dem->law->name) != 0) continue;
    PgInputCheck(!PetscIsInfOrNanReal(value) && value >= o->lower, PgParticlesComm(dem->particles),
                 "contact parameter %s = %g %s is below its bound %g", o->name + 5, (double)value, o->unit,
                 (double)o->lower);
  }
  dem->parameters = given;
  PetscCall(CheckParameters(dem));
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemSetGravity(PgDem dem, const PetscReal gravity[2])
{
  PetscFunctionBeginUser;
  dem->gravity[0] = gravity[0];
  dem->gravity[1] = gravity[1];
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemSetDamping(PgDem dem, PetscReal local, PetscReal global)
{
  PetscFunctionBeginUser;
  PgInputCheck(local >= 0 && local <= 1 && global >= 0, PgParticlesComm(dem->particles),
               "damping: local %g must be in [0, 1] and global %g 1/s not negative", (double)local, (double)global);
  dem->local_damping  = local;
  dem->global_damping = global;
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemGetWork_Private(PgDem dem, PetscInt count, PetscReal **work)
{
  PetscFunctionBeginUser;
  if (count > dem->work_room) {
    PetscCall(PetscFree(dem->work));
    PetscCall(PetscMalloc1(count, &dem->work));
    dem->work_room = count;
  }
  *work = dem->work;
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemGetOffset_Private(PgDem dem, PetscInt count)
{
  PetscFunctionBeginUser;
  if (count > dem->offset_room) {
    PetscCall(PetscFree(dem->offset));
    PetscCall(PetscMalloc1(count, &dem->offset));
    dem->offset_room = count;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemGetDiscs_Private(PgDem dem, PgDemDiscs *discs)
{
  PetscReal *x, *v, *w, *r;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetArray(dem->particles, PG_POSITION, &x));
  PetscCall(PgParticlesGetArray(dem->particles, PG_VELOCITY, &v));
  PetscCall(PgParticlesGetArray(dem->particles, PG_ANGULAR_VELOCITY, &w));
  PetscCall(PgParticlesGetArray(dem->particles, PG_RADIUS, &r));
  *discs = (PgDemDiscs){x, v, w, r};
  PetscFunctionReturn(0);
}
