/* Options -up_*. */
#include "femimpl.h"

#define SECTION "up: saturated continuum by finite elements (Tak, Park & Park 2013)"

static PetscErrorCode MaterialOptions(PetscOptionItems *PetscOptionsObject, PgFemMaterial *m)
{
  PetscFunctionBeginUser;
  PetscCall(PgOptionReal(PetscOptionsObject, "-up_young", "Young's modulus E of the drained skeleton", "Pa",
                         PG_POSITIVE, 1e20, &m->E, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-up_poisson", "Poisson's ratio nu of the drained skeleton, below 0.5",
                         "1", -1.0, 0.5, &m->nu, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-up_biot", "Biot's constant alpha, at least the porosity, Eq. 9", "1",
                         0.0, 1.0, &m->alpha, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-up_bulk_grains", "bulk modulus K_s of the grains, Eq. 9", "Pa",
                         PG_POSITIVE, 1e30, &m->K_s, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-up_bulk_water", "bulk modulus K_f of the water, Eq. 9", "Pa",
                         PG_POSITIVE, 1e30, &m->K_f, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-up_porosity", "porosity n", "1", 0.0, 1.0, &m->n, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-up_permeability", "intrinsic permeability k, Eq. 5; 0: impermeable",
                         "m2", 0.0, 1e3, &m->k, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-up_viscosity", "viscosity mu_f of the water, Eq. 5", "Pa s", PG_POSITIVE,
                         1e6, &m->mu_f, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-up_density_grains", "density rho_s of the grains", "kg/m3", PG_POSITIVE,
                         1e9, &m->rho_s, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-up_density_water", "density rho_f of the water", "kg/m3", PG_POSITIVE,
                         1e9, &m->rho_f, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode ElementOptions(PgFem fem, PetscOptionItems *PetscOptionsObject)
{
  static const char *const words[] = {"q1q1", "q2q1", "q1"};
  PetscInt                 element = (PetscInt)fem->element;

  PetscFunctionBeginUser;
  PetscCall(
      PgOptionChoice(PetscOptionsObject, "-up_element",
                     "element: both fields bilinear and stabilised, Taylor-Hood, or bilinear displacement with the "
                     "water locked in",
                     3, words, &element, NULL));
  fem->element = (PgFemElement)element;
  PetscCall(PgOptionReal(PetscOptionsObject, "-up_stabilisation",
                         "pressure projection of q1q1: tau times the constrained modulus M; 0: none", "1", 0.0, 1e6,
                         &fem->stabilisation, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-up_theta",
                         "time integration: 1 backward Euler, 0.5 trapezoidal rule (second order)", "1", 0.5, 1.0,
                         &fem->theta, NULL));
  PetscCall(PgOptionInt(PetscOptionsObject, "-up_start_steps",
                        "steps at the start with theta 1, which damp what does not fit the state at rest", 0, 1000000,
                        &fem->start_steps, NULL));
  PetscCall(PgOptionBool(PetscOptionsObject, "-up_inertia", "inertia of the mixture", &fem->inertia, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-up_damping", "damping in proportion to mass, with inertia", "1/s", 0.0,
                         1e12, &fem->damping, NULL));
  PetscCall(PgOptionReals(PetscOptionsObject, "-up_gravity", "acceleration of gravity", "m/s2", 2, fem->gravity, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode MeshOptions(PgFem fem, PetscOptionItems *PetscOptionsObject)
{
  PetscReal cells[2] = {(PetscReal)fem->box_cells[0], (PetscReal)fem->box_cells[1]};
  PetscInt  whole[2];
  PetscBool given;

  PetscFunctionBeginUser;
  PetscCall(PgOptionReals(PetscOptionsObject, "-up_cells", "cells along x and y of the built-in rectangle", "1", 2,
                          cells, &given));
  for (int d = 0; d < 2; d++) {
    PgInputCheck(cells[d] >= 1.0 && cells[d] <= 100000.0 && cells[d] == PetscFloorReal(cells[d]), fem->comm,
                 "option -up_cells: %g is no number of cells, it must be a whole number from 1 to 100000",
                 (double)cells[d]);
    whole[d] = (PetscInt)cells[d];
  }
  PetscCall(
      PgOptionString(PetscOptionsObject, "-up_mesh",
                     "mesh FILE of Gmsh (MSH 2.2, 4.0 or 4.1) with quadrilaterals, whose physical curves have the "
                     "names that the case needs",
                     fem->file, sizeof fem->file, NULL));
  PgInputCheck(!fem->file[0] || !given, fem->comm, "options -up_mesh and -up_cells contradict each other: give one");
  fem->box_cells[0] = whole[0];
  fem->box_cells[1] = whole[1];
  PetscFunctionReturn(0);
}

/* What PETSc reads, for help and messages. */
static PetscErrorCode MentionSolver(void)
{
  static const struct {
    const char *name, *initial, *text;
  } option[] = {
      {"-up_ksp_type", "gmres", "Krylov method"},
      {"-up_ksp_rtol", "1e-10", "norm of the residual to reach, over that of the right-hand side"},
      {"-up_ksp_max_it", "500", "most iterations of a solve"},
      {"-up_ksp_monitor", "", "prints the residual of each iteration"},
      {"-up_pc_type", "fieldsplit", "preconditioner; lu solves directly"},
      {"-up_*", "",
       "every option of PETSc's KSP, PC and partitioner with this prefix; the blocks of displacement and "
       "pressure have -up_fieldsplit_u_* and -up_fieldsplit_p_*"},
  };

  PetscFunctionBeginUser;
  for (size_t i = 0; i < sizeof option / sizeof *option; i++)
    PetscCall(PgOptionsMention(SECTION, option[i].name, option[i].initial, "", option[i].text));
  PetscFunctionReturn(0);
}

PetscErrorCode PgFemSetFromOptions(PgFem fem)
{
  PgFemMaterial material = fem->material[0].material;

  PetscFunctionBeginUser;
  PetscOptionsBegin(fem->comm, "", SECTION, "");
  PetscCall(MeshOptions(fem, PetscOptionsObject));
  PetscCall(ElementOptions(fem, PetscOptionsObject));
  PetscCall(MaterialOptions(PetscOptionsObject, &material));
  PetscOptionsEnd();
  PetscCall(PgFemMaterialCheck(fem->comm, "options -up_*", &material));
  fem->material[0].material = material;
  PgInputCheck(fem->damping == 0.0 || fem->inertia, fem->comm, "option -up_damping needs -up_inertia");
  PetscCall(MentionSolver());
  fem->from_options = PETSC_TRUE;
  PetscFunctionReturn(0);
}
