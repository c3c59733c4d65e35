/* Any packing: discs from a file, on a lattice, or pressed together at random, in a box whose sides can be plates (rows
   of discs with prescribed motion, as in the panel) or rigid walls. docs/packings.md is its tutorial. No exact
   solution: what follows from the discs is up to the user. */
#include "packingimpl.h"

static const char *const make_words[PG_MAKE_COUNT] = {"hexagonal", "square", "random"};
static const char *const side_words[PG_SIDE_COUNT] = {"left", "right", "bottom", "top"};

typedef struct {
  char          file[PETSC_MAX_PATH_LEN], group[PETSC_MAX_PATH_LEN];
  PgPackingPlan plan;
  PetscBool     from_file;
  PetscBool     periodic_set, box_set, top_set, porosity_set;
  PetscReal     box[4];         /* x low, x high, y low, y high [m] */
  PetscReal     max_overlap;    /* over the smaller radius [1] */
  PetscReal     porosity;       /* initial, for the water [1] */
  unsigned      plates, walls;  /* bit s: side s */
  PetscReal     plate_distance; /* of the discs that belong to a plate, over the mean radius [1] */
  PetscReal     side_distance;  /* of the discs that form a side for the water, over the mean radius [1] */
  PetscReal     top_velocity;   /* upward [m/s] */
  PetscReal     end_time;       /* [s] 0: to be given */
  PetscBool     weigh;          /* the bottom wall shows its load */
} PackingCase;

/* ---- options ---- */

/* Words separated by commas, among the `n` first sides from `first` on. */
static PetscErrorCode ReadSides(PetscOptionItems *PetscOptionsObject, const char name[], const char text[], int first,
                                unsigned *sides)
{
  char   given[256] = "";
  char **word;
  int    words;

  PetscFunctionBeginUser;
  PetscCall(PgOptionString(PetscOptionsObject, name, text, given, sizeof given, NULL));
  PetscCall(PetscStrToArray(given, ',', &words, &word));
  *sides = 0;
  for (int k = 0; k < words; k++) {
    int found = -1;
    for (int s = first; s < PG_SIDE_COUNT; s++)
      if (!strcmp(word[k], side_words[s])) found = s;
    PgInputCheck(found >= 0, PetscOptionsObject->comm, "option %s: '%s' is not among %sbottom, top", name, word[k],
                 first ? "" : "left, right, ");
    *sides |= 1U << found;
  }
  PetscCall(PetscStrToArrayDestroy(words, word));
  PetscFunctionReturn(0);
}

/* Options of the makers; `belongs` says what each needs. */
enum { NEEDS_MAKE = 1, NEEDS_RANDOM = 2 };

static PetscErrorCode Belongs(PetscOptionItems *PetscOptionsObject, const PackingCase *c, const char name[],
                              unsigned needs, PetscBool set)
{
  PetscFunctionBeginUser;
  PgInputCheck(!set || !c->from_file, PetscOptionsObject->comm,
               "options -packing and %s contradict each other: the discs come from the file", name);
  PgInputCheck(!set || needs == NEEDS_MAKE || c->plan.make == PG_MAKE_RANDOM, PetscOptionsObject->comm,
               "option %s belongs to -packing_generate random", name);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadReals(PetscOptionItems *PetscOptionsObject, PackingCase *c)
{
  PgPackingPlan *p = &c->plan;
  const struct {
    const char *name, *text, *unit;
    PetscReal   lower, upper;
    PetscReal  *value;
    unsigned    needs;
  } option[] = {
      {"-packing_aspect", "height over width of the box that -packing_count asks for", "1", 1e-3, 1e3, &p->aspect,
       NEEDS_MAKE},
      {"-packing_radius", "radius of the discs", "m", 1e-9, 1e3, &p->radius, NEEDS_MAKE},
      {"-packing_radius_spread", "S: radii are uniform in radius*(1 - S) to radius*(1 + S)", "1", 0, 0.9, &p->spread,
       NEEDS_RANDOM},
      {"-packing_second_radius", "radius of a second size of discs", "m", 1e-9, 1e3, &p->second, NEEDS_RANDOM},
      {"-packing_second_share", "part of the discs that have the second radius", "1", 0, 1, &p->share, NEEDS_RANDOM},
      {"-packing_target_porosity", "porosity of a random packing: 1 - area of the discs/area of the box", "1", 0.05,
       0.95, &p->target, NEEDS_RANDOM},
      {"-packing_relax_overlap", "largest overlap that may remain in a random packing, over the smaller radius", "1",
       1e-10, 0.5, &p->overlap, NEEDS_RANDOM},
  };

  PetscFunctionBeginUser;
  for (size_t k = 0; k < sizeof option / sizeof *option; k++) {
    PetscBool set;
    PetscCall(PgOptionReal(PetscOptionsObject, option[k].name, option[k].text, option[k].unit, option[k].lower,
                           option[k].upper, option[k].value, &set));
    PetscCall(Belongs(PetscOptionsObject, c, option[k].name, option[k].needs, set));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadInts(PetscOptionItems *PetscOptionsObject, PackingCase *c)
{
  PgPackingPlan *p = &c->plan;
  const struct {
    const char *name, *text;
    PetscInt    lower, upper;
    PetscInt   *value;
    unsigned    needs;
  } option[] = {
      {"-packing_count", "number of discs", 1, PETSC_MAX_INT / 64 - 1, &p->count, NEEDS_MAKE},
      {"-packing_relax_steps", "most steps that a random packing relaxes", 100, 100000000, &p->steps, NEEDS_RANDOM},
      {"-packing_seed", "seed of a random packing", 0, PETSC_MAX_INT - 1, &p->seed, NEEDS_RANDOM},
  };

  PetscFunctionBeginUser;
  for (size_t k = 0; k < sizeof option / sizeof *option; k++) {
    PetscBool set;
    PetscCall(PgOptionInt(PetscOptionsObject, option[k].name, option[k].text, option[k].lower, option[k].upper,
                          option[k].value, &set));
    PetscCall(Belongs(PetscOptionsObject, c, option[k].name, option[k].needs, set));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadSource(PetscOptionItems *PetscOptionsObject, PackingCase *c)
{
  PetscInt  make = PG_MAKE_HEXAGONAL;
  PetscBool generate, group, size, help = PetscOptionsObject->printhelp;

  PetscFunctionBeginUser;
  PetscCall(PgOptionString(PetscOptionsObject, "-packing", "file with the discs, CSV (x,y,r[,vx,vy]) or HDF5", c->file,
                           sizeof c->file, &c->from_file));
  PetscCall(PgOptionString(PetscOptionsObject, "-packing_group",
                           "group of an HDF5 file that holds the discs; default: the root or the last snapshot",
                           c->group, sizeof c->group, &group));
  PetscCall(PgOptionChoice(PetscOptionsObject, "-packing_generate", "makes the discs", PG_MAKE_COUNT, make_words, &make,
                           &generate));
  c->plan.make = (PgPackingMake)make;
  PgInputCheck(c->from_file || generate || help, PetscOptionsObject->comm,
               "case packing needs its discs: -packing FILE or -packing_generate hexagonal|square|random");
  PgInputCheck(!c->from_file || !generate, PetscOptionsObject->comm,
               "options -packing and -packing_generate contradict each other: give one");
  if (c->from_file) PetscCall(PgPackingCheckOutput(PetscOptionsObject->comm, c->file));
  PgInputCheck(!group || c->from_file, PetscOptionsObject->comm, "option -packing_group belongs to -packing FILE");
  PetscCall(ReadInts(PetscOptionsObject, c));
  PetscCall(PgOptionReals(PetscOptionsObject, "-packing_size", "width and height of the box to fill", "m", 2,
                          c->plan.size, &size));
  PetscCall(Belongs(PetscOptionsObject, c, "-packing_size", NEEDS_MAKE, size));
  PetscCall(ReadReals(PetscOptionsObject, c));
  PgInputCheck(!generate || (c->plan.count > 0) != (PetscBool)size, PetscOptionsObject->comm,
               "option -packing_generate needs one of -packing_count N and -packing_size WX,WY, and not both");
  PgInputCheck(!size || (c->plan.size[0] > 0 && c->plan.size[1] > 0), PetscOptionsObject->comm,
               "option -packing_size: %g x %g m is no size", (double)c->plan.size[0], (double)c->plan.size[1]);
  PgInputCheck(!(c->plan.second > 0 && c->plan.spread > 0), PetscOptionsObject->comm,
               "options -packing_radius_spread and -packing_second_radius contradict each other: give one");
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadBox(PetscOptionItems *PetscOptionsObject, PackingCase *c)
{
  PetscFunctionBeginUser;
  PetscCall(PgOptionReals(PetscOptionsObject, "-packing_box",
                          "x low, x high, y low, y high of the box; default: what the discs need", "m", 4, c->box,
                          &c->box_set));
  PgInputCheck(!c->box_set || c->from_file, PetscOptionsObject->comm, "option -packing_box belongs to -packing FILE");
  PgInputCheck(!c->box_set || (c->box[1] > c->box[0] && c->box[3] > c->box[2]), PetscOptionsObject->comm,
               "option -packing_box: %g,%g,%g,%g m is no box: each upper end must lie above its lower end",
               (double)c->box[0], (double)c->box[1], (double)c->box[2], (double)c->box[3]);
  PetscCall(PgOptionBool(PetscOptionsObject, "-packing_periodic",
                         "x is periodic, with the width of the box; default: what the file says", &c->plan.periodic,
                         &c->periodic_set));
  PetscCall(PgOptionReal(PetscOptionsObject, "-packing_max_overlap",
                         "largest overlap of two discs that is accepted, over the smaller radius", "1", 0, 2,
                         &c->max_overlap, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadBoundaries(PetscOptionItems *PetscOptionsObject, PackingCase *c)
{
  const unsigned left_right = 1U << PG_SIDE_LEFT | 1U << PG_SIDE_RIGHT, top = 1U << PG_SIDE_TOP;

  PetscFunctionBeginUser;
  PetscCall(ReadSides(PetscOptionsObject, "-packing_plates", "sides that are plates: bottom,top", PG_SIDE_BOTTOM,
                      &c->plates));
  PetscCall(ReadSides(PetscOptionsObject, "-packing_walls", "sides that are rigid walls: left,right,bottom,top",
                      PG_SIDE_LEFT, &c->walls));
  PetscCall(PgOptionReal(PetscOptionsObject, "-packing_plate_distance",
                         "discs nearer to a plate than this belong to it, over the mean radius", "1", 0, 10,
                         &c->plate_distance, NULL));
  PetscCall(
      PgOptionReal(PetscOptionsObject, "-packing_side_distance",
                   "discs nearer to a side of the box than this form that side for the water, over the mean radius",
                   "1", 0, 10, &c->side_distance, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-packing_top_velocity", "velocity of the top plate or wall, downward < 0",
                         "m/s", -1e3, 1e3, &c->top_velocity, &c->top_set));
  PetscCall(PgOptionReal(PetscOptionsObject, "-packing_porosity", "initial porosity; default: of the discs in the box",
                         "1", 0.01, 0.98, &c->porosity, &c->porosity_set));
  for (int s = 0; s < PG_SIDE_COUNT; s++)
    PgInputCheck(!(c->plates & c->walls & 1U << s), PetscOptionsObject->comm,
                 "options -packing_plates and -packing_walls: side %s cannot be both", side_words[s]);
  PgInputCheck(!c->plan.periodic || !(c->walls & left_right), PetscOptionsObject->comm,
               "option -packing_walls: there is no wall on the left or right where x is periodic");
  PgInputCheck(!c->top_set || ((c->plates | c->walls) & top), PetscOptionsObject->comm,
               "option -packing_top_velocity needs a plate or wall at the top: -packing_plates bottom,top or "
               "-packing_walls bottom,top");
  PetscFunctionReturn(0);
}

static PetscErrorCode Create(MPI_Comm comm, void **context)
{
  PackingCase *c;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&c));
  c->plan = (PgPackingPlan){
      .aspect = 1, .radius = 5e-3, .share = 0.5, .target = 0.18, .overlap = 1e-6, .steps = 40000, .seed = 1};
  c->max_overlap    = 0.5;
  c->plate_distance = 0.5;
  c->side_distance  = 1.25; /* of hexagonal rows, all of which end at a side, takes the ends of both */
  PetscOptionsBegin(comm, "", "case packing: discs from a file, a lattice, or chance", "");
  PetscCall(ReadSource(PetscOptionsObject, c));
  PetscCall(ReadBox(PetscOptionsObject, c));
  PetscCall(ReadBoundaries(PetscOptionsObject, c));
  PetscOptionsEnd();
  *context = c;
  PetscFunctionReturn(0);
}

/* A packing within walls that settles under its weight: a whole problem without further options, and with
   `packing`'s other ones. Exact at rest: the bottom bears the weight of the discs, as the history's load. */
static PetscErrorCode CreateBox(MPI_Comm comm, void **context)
{
  PetscBool    file, size, walls, periodic = PETSC_FALSE;
  PackingCase *c;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsHasName(NULL, NULL, "-packing", &file));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-packing_size", &size));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-packing_walls", &walls));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-packing_periodic", &periodic, NULL));
  PetscCall(PgCaseDefaults("-gravity 0,-9.81 -dem_local_damping 0.7 -wall_friction 0"));
  if (!file)
    PetscCall(PgCaseDefaults(size ? "-packing_generate hexagonal" : "-packing_generate hexagonal -packing_count 400"));
  if (!walls) { /* with -packing FILE, too, from whose name this one goes on */
    PetscCall(PetscOptionsSetValue(NULL, "-packing_walls", periodic ? "bottom,top" : "left,right,bottom,top"));
    PetscCall(PgOptionsSetBy("-packing_walls", PG_OPTION_CASE));
  }
  PetscCall(Create(comm, context));
  c           = (PackingCase *)*context;
  c->end_time = 0.02;
  c->weigh    = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* ---- discs and box ---- */

/* The smallest box that holds all discs. */
static PetscErrorCode BoundingBox(MPI_Comm comm, const PgPacking *packing, PgBox *box)
{
  PetscReal most[4] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL};

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < packing->count; i++) {
    for (int d = 0; d < 2; d++) {
      const PetscReal x = packing->position[2 * i + d], r = packing->radius[i];
      most[d]     = PetscMax(most[d], r - x);
      most[2 + d] = PetscMax(most[2 + d], x + r);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 4, MPIU_REAL, MPIU_MAX, comm));
  *box = (PgBox){{0 - most[0], 0 - most[1]}, {most[2], most[3]}}; /* 0 - 0 is 0, and not -0 */
  PetscFunctionReturn(0);
}

static PetscErrorCode BoxOfFile(MPI_Comm comm, const PackingCase *c, PgPacking *packing, PgBox *box)
{
  const unsigned  left_right = 1U << PG_SIDE_LEFT | 1U << PG_SIDE_RIGHT;
  const PetscBool known      = packing->periodic;

  PetscFunctionBeginUser;
  if (c->periodic_set) packing->periodic = c->plan.periodic;
  PetscCall(BoundingBox(comm, packing, box));
  if (c->box_set) {
    *box = (PgBox){{c->box[0], c->box[2]}, {c->box[1], c->box[3]}};
  } else if (packing->periodic) {
    PgInputCheck(known, comm,
                 "option -packing_periodic: '%s' does not say the period of x: give -packing_box XLOW,XHIGH,YLOW,YHIGH",
                 c->file);
    box->low[0]  = packing->low;
    box->high[0] = packing->high;
  }
  packing->low  = box->low[0];
  packing->high = box->high[0];
  PgInputCheck(!packing->periodic || !(c->walls & left_right), comm,
               "option -packing_walls: there is no wall on the left or right where x is periodic, as '%s' says",
               c->file);
  PetscFunctionReturn(0);
}

static PetscErrorCode GetDiscs(MPI_Comm comm, const PackingCase *c, PetscBool only_ids, PgPacking *packing, PgBox *box)
{
  PetscLogDouble start = MPI_Wtime();

  PetscFunctionBeginUser;
  if (c->from_file) {
    PetscCall(PgPackingRead(comm, c->file, c->group, packing));
    PetscCall(BoxOfFile(comm, c, packing, box));
    PetscCall(PetscPrintf(comm, "packing: %" PetscInt_FMT " discs from '%s'\n", packing->global, c->file));
  } else {
    PetscCall(PgPackingGenerate(comm, &c->plan, only_ids, packing, box));
    PetscCall(PetscPrintf(comm, "packing: %" PetscInt_FMT " discs, %s, made in %.1f s\n", packing->global,
                          make_words[c->plan.make], MPI_Wtime() - start));
  }
  PetscFunctionReturn(0);
}

/* ---- findings ---- */

static PetscErrorCode Report(MPI_Comm comm, const PgPacking *packing, const PgBox *box, const PgPackingFindings *f)
{
  const PetscReal area = (box->high[0] - box->low[0]) * (box->high[1] - box->low[1]);
  const PetscReal n = 1 - f->area / area, n_once = 1 - (f->area - f->common_area) / area;

  PetscFunctionBeginUser;
  PetscCall(PetscPrintf(comm, "  radius %g to %g m, mean %g m; velocities %s\n", (double)f->radius_min,
                        (double)f->radius_max, (double)f->radius_mean,
                        packing->has_velocity ? "from the file" : "zero"));
  /* with all digits: what -packing_box must be given for the same box */
  PetscCall(PetscPrintf(comm, "  box %.17g,%.17g,%.17g,%.17g m%s\n", (double)box->low[0], (double)box->high[0],
                        (double)box->low[1], (double)box->high[1], packing->periodic ? ", periodic in x" : ""));
  PetscCall(PetscPrintf(comm, "  porosity %.6f in the box", (double)n));
  if (f->common_area > 1e-9 * f->area)
    PetscCall(PetscPrintf(comm, " (%.6f with overlaps counted once)", (double)n_once));
  if (f->samples)
    PetscCall(PetscPrintf(comm, ", %.4f in %lld sample circles of radius 4 r inside it", (double)f->sampled,
                          (long long)f->samples));
  PetscCall(PetscPrintf(comm, "\n"));
  if (f->pair[0] < 0)
    PetscCall(PetscPrintf(comm, "  no disc touches another\n"));
  else
    PetscCall(PetscPrintf(
        comm, "  %lld pair%s; %s %.3g of the smaller radius, discs %" PetscInt_FMT " and %" PetscInt_FMT "\n",
        (long long)f->touching, f->touching == 1 ? " touches" : "s touch",
        f->overlap > 0 ? "largest overlap" : "smallest gap", (double)PetscAbsReal(f->overlap), f->pair[0], f->pair[1]));
  PetscFunctionReturn(0);
}

static PetscErrorCode Refuse(MPI_Comm comm, const PackingCase *c, const char from[], const PgPackingFindings *f)
{
  PetscFunctionBeginUser;
  PgInputCheck(!f->coincident, comm,
               "packing '%s': discs %" PetscInt_FMT " and %" PetscInt_FMT
               " (counted from 0) have the same centre (%g, %g) m; %lld such pairs",
               from, f->pair[0], f->pair[1], (double)f->place[0], (double)f->place[1], (long long)f->coincident);
  PgInputCheck(f->overlap <= c->max_overlap, comm,
               "packing '%s': discs %" PetscInt_FMT " and %" PetscInt_FMT
               " (counted from 0) at (%g, %g) and (%g, %g) m overlap by %g of the smaller radius, more than "
               "-packing_max_overlap %g",
               from, f->pair[0], f->pair[1], (double)f->place[0], (double)f->place[1], (double)f->place[2],
               (double)f->place[3], (double)f->overlap, (double)c->max_overlap);
  PgInputCheck(f->outside <= PetscMax(c->max_overlap, 1e-9), comm,
               "packing '%s': disc %" PetscInt_FMT
               " (counted from 0) reaches out of the box by %g of its radius, more than -packing_max_overlap %g",
               from, f->outside_disc, (double)f->outside, (double)c->max_overlap);
  PetscFunctionReturn(0);
}

/* Porosity where the user has given none. Without water it is only to be looked at: 0, not known, where it is none. */
static PetscErrorCode BulkPorosity(MPI_Comm comm, const PgBox *box, const PgPackingFindings *f, PetscBool water,
                                   PetscReal *porosity)
{
  const PetscReal area = (box->high[0] - box->low[0]) * (box->high[1] - box->low[1]);
  PetscBool       usable;

  PetscFunctionBeginUser;
  *porosity = 1 - (f->area - f->common_area) / area;
  usable    = (PetscBool)(*porosity >= 0.01 && *porosity <= 0.98);
  if (!usable && !water) *porosity = 0.0;
  PgInputCheck(
      usable || !water, comm,
      "the discs leave a porosity of %g in the box, with which water cannot be computed: give -packing_porosity",
      (double)*porosity);
  PetscFunctionReturn(0);
}

/* ---- set-up ---- */

static PetscErrorCode AddPlates(const PackingCase *c, PgCaseSetup *setup, PetscInt plate[PG_SIDE_COUNT])
{
  const PgPlate lower = {"lower", -1.0, 0.0, -1.0, PETSC_FALSE};
  const PgPlate upper = {"upper", 1.0, c->top_velocity, -1.0, PETSC_FALSE};

  PetscFunctionBeginUser;
  for (int s = 0; s < PG_SIDE_COUNT; s++) {
    plate[s] = -1;
    if (c->plates & 1U << s) PetscCall(PgDemAddPlate(setup->dem, s == PG_SIDE_BOTTOM ? &lower : &upper, &plate[s]));
  }
  setup->load_plate = plate[PG_SIDE_TOP] >= 0 ? plate[PG_SIDE_TOP] : plate[PG_SIDE_BOTTOM];
  PetscFunctionReturn(0);
}

static PetscErrorCode AddWalls(const PackingCase *c, const PgBox *box, PgCaseSetup *setup)
{
  PetscFunctionBeginUser;
  for (int s = 0; s < PG_SIDE_COUNT; s++) {
    const int axis = s / 2, upper = s % 2;
    PgWall    wall = {.kind = PG_WALL_FIXED, .friction = -1};
    PetscInt  index;

    if (!(c->walls & 1U << s)) continue;
    PetscCall(PetscStrncpy(wall.name, side_words[s], sizeof wall.name));
    wall.point[axis]  = upper ? box->high[axis] : box->low[axis];
    wall.normal[axis] = upper ? -1 : 1;
    if (s == PG_SIDE_TOP && c->top_set) {
      wall.kind        = PG_WALL_MOVING;
      wall.velocity[1] = c->top_velocity;
    }
    PetscCall(PgDemAddWall(setup->dem, &wall, &index));
    if (c->weigh && s == PG_SIDE_BOTTOM) setup->load_wall = index;
  }
  PetscFunctionReturn(0);
}

/* Gap between the disc and a side of the box. */
static PetscReal Gap(const PgBox *box, int side, const PetscReal x[2], PetscReal r)
{
  const int axis = side / 2;
  return (side % 2 ? box->high[axis] - x[axis] : x[axis] - box->low[axis]) - r;
}

static PetscErrorCode PutDiscs(const PackingCase *c, const PgPacking *packing, const PgBox *box, PetscReal mean_radius,
                               const PetscInt plate_index[PG_SIDE_COUNT], PgCaseSetup *setup)
{
  PgCaseArrays a;

  PetscFunctionBeginUser;
  PetscCall(PgCaseGetArrays(setup, &a));
  PetscCall(PetscArraycpy(a.x, packing->position, 2 * packing->count));
  PetscCall(PetscArraycpy(a.v, packing->velocity, 2 * packing->count));
  PetscCall(PetscArraycpy(a.radius, packing->radius, packing->count));
  for (PetscInt i = 0; i < packing->count; i++) {
    unsigned sides = 0;

    for (int s = packing->periodic ? PG_SIDE_BOTTOM : PG_SIDE_LEFT; s < PG_SIDE_COUNT; s++) {
      const PetscReal gap = Gap(box, s, &a.x[2 * i], a.radius[i]);
      if (gap < c->side_distance * mean_radius) sides |= 1U << s;
      if (plate_index[s] < 0 || gap >= c->plate_distance * mean_radius) continue;
      a.plate[i]     = 1.0 + (PetscReal)plate_index[s];
      a.v[2 * i + 1] = s == PG_SIDE_TOP ? c->top_velocity : 0.0;
    }
    if (a.side) a.side[i] = (PetscReal)sides;
    if (a.porosity) a.porosity[i] = c->porosity;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeDiscs(PackingCase *c, const PgPacking *packing, const PgBox *box, PetscReal mean_radius,
                                PgCaseSetup *setup)
{
  PetscInt *id, plate[PG_SIDE_COUNT];

  PetscFunctionBeginUser;
  if (packing->periodic) PetscCall(PgParticlesSetPeriodicX(setup->particles, packing->low, packing->high));
  PetscCall(PetscMalloc1(packing->count, &id));
  for (PetscInt i = 0; i < packing->count; i++) id[i] = packing->start + i;
  PetscCall(PgParticlesSetDiscs(setup->particles, packing->count, id));
  PetscCall(PetscFree(id));
  PetscCall(AddPlates(c, setup, plate));
  PetscCall(AddWalls(c, box, setup));
  PetscCall(PutDiscs(c, packing, box, mean_radius, plate, setup));
  PetscCall(PgCaseFinishDiscs(setup));
  setup->height = box->high[1] - box->low[1];
  PetscFunctionReturn(0);
}

static PetscErrorCode Setup(void *context, PgCaseSetup *setup)
{
  PackingCase      *c       = (PackingCase *)context;
  const char       *from    = c->from_file ? c->file : make_words[c->plan.make];
  PgPacking         packing = {0};
  PgPackingFindings f       = {0};
  PgBox             box;

  PetscFunctionBeginUser;
  PetscCall(GetDiscs(setup->comm, c, setup->restart, &packing, &box));
  if (!setup->restart) {
    PetscCall(PgPackingInspect(setup->comm, from, &packing, &box, &f));
    PetscCall(Report(setup->comm, &packing, &box, &f));
    PetscCall(Refuse(setup->comm, c, from, &f));
    if (!c->porosity_set)
      PetscCall(BulkPorosity(setup->comm, &box, &f, (PetscBool)(setup->pore != NULL), &c->porosity));
  }
  PetscCall(MakeDiscs(c, &packing, &box, f.radius_mean, setup));
  if (c->end_time > 0) setup->end_time = c->end_time;
  PetscCall(PgPackingDestroy(&packing));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(void **context)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(*context));
  PetscFunctionReturn(0);
}

const PgCaseInfo PgCaseBox = {
    "box", "a packing within four walls that settles under gravity", CreateBox, Setup, Destroy, NULL};
const PgCaseInfo PgCasePacking = {
    "packing", "discs from a file, on a lattice, or pressed together at random", Create, Setup, Destroy, NULL};
