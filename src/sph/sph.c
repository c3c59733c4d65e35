/* The object: options, life, and what it shows to other rooms. */
#include "sphimpl.h"

static const char *const operator_words[] = {"paper", "corrected"};

PetscErrorCode PgSphCreate(PgParticles particles, PgNeighbors neighbors, PgSph *sph)
{
  const PgFieldInfo volume = {"volume", 1, "m2", "area of the porous medium that goes with the disc, pi r^2/(1 - n)",
                              PG_FIELD_MIGRATE | PG_FIELD_HALO | PG_FIELD_RESTART};
  PgSph             s;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  s->particles      = particles;
  s->neighbors      = neighbors;
  s->smoothing      = 2.5;
  s->eta            = 0.1;
  s->gradient_kind  = PG_SPH_PAPER;
  s->laplacian_kind = PG_SPH_PAPER;
  PetscCall(PgKernelFind("cubic_spline", &s->kernel));
  s->cubic = PETSC_TRUE;
  PetscCall(PgParticlesRegisterField(particles, &volume, &s->volume));
  *sph = s;
  PetscFunctionReturn(0);
}

PetscErrorCode PgSphSetFromOptions(PgSph sph)
{
  PetscInt  both = 0, gradient = sph->gradient_kind, laplacian = sph->laplacian_kind;
  PetscBool set;
  char      name[64];

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(name, sph->kernel->name, sizeof name));
  PetscOptionsBegin(PgParticlesComm(sph->particles), "", "sph: operators", "");
  PetscCall(
      PgOptionChoice(PetscOptionsObject, "-sph_operators",
                     "as printed (Eqs. 51, 52, 60), or with the gradient exact for linear and the Laplacian exact for "
                     "quadratic fields (not symmetric)",
                     2, operator_words, &both, &set));
  if (set) gradient = laplacian = both;
  PetscCall(PgOptionChoice(PetscOptionsObject, "-sph_gradient",
                           "gradient and divergence alone, overrides -sph_operators", 2, operator_words, &gradient,
                           NULL));
  PetscCall(PgOptionChoice(PetscOptionsObject, "-sph_laplacian", "Laplacian alone, overrides -sph_operators", 2,
                           operator_words, &laplacian, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-sph_laplacian_eta", "eta in r^2 + eta h^2 of the Laplacian, Eq. 52", "1",
                         0.0, 1.0, &sph->eta, NULL));
  PetscCall(PgOptionReal(PetscOptionsObject, "-sph_smoothing", "smoothing length h over the radius of the disc", "1",
                         1.5, 6.0, &sph->smoothing, NULL));
  PetscCall(PgOptionString(PetscOptionsObject, "-sph_kernel",
                           "smoothing kernel: cubic_spline, Eq. 63, or quintic_spline, which reaches half as far again",
                           name, sizeof name, NULL));
  PetscOptionsEnd();
  PetscCall(PgKernelFind(name, &sph->kernel));
  PgInputCheck(sph->kernel, PgParticlesComm(sph->particles),
               "option -sph_kernel: '%s' is not known; known are cubic_spline and quintic_spline", name);
  PetscCall(PetscStrcmp(sph->kernel->name, "cubic_spline", &sph->cubic));
  sph->gradient_kind  = (PgSphOperators)gradient;
  sph->laplacian_kind = (PgSphOperators)laplacian;
  {
    const PetscReal reach = 0.5 * sph->kernel->support * sph->smoothing;
    PetscCall(PgNeighborsRequestRows(sph->neighbors, reach, reach));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgSphView(PgSph sph, PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "SPH operators: gradient %s, Laplacian %s with eta %g; kernel %s, h = %g r\n",
                                   operator_words[sph->gradient_kind], operator_words[sph->laplacian_kind],
                                   (double)sph->eta, sph->kernel->name, (double)sph->smoothing));
  PetscFunctionReturn(0);
}

PetscErrorCode PgSphDestroy(PgSph *sph)
{
  PetscFunctionBeginUser;
  if (!*sph) PetscFunctionReturn(0);
  PetscCall(PetscFree((*sph)->gradient));
  PetscCall(PetscFree((*sph)->laplacian));
  PetscCall(PetscFree((*sph)->weight));
  PetscCall(PetscFree((*sph)->kernel_sum));
  PetscCall(PetscFree(*sph));
  PetscFunctionReturn(0);
}

PetscErrorCode PgSphGetCoefficients(PgSph sph, PgSphCoefficients *c)
{
  PetscFunctionBeginUser;
  c->ptr        = sph->list.ptr;
  c->col        = sph->list.col;
  c->gradient   = sph->gradient;
  c->laplacian  = sph->laplacian;
  c->weight     = sph->weight;
  c->kernel_sum = sph->kernel_sum;
  c->symmetric  = (PetscBool)(sph->laplacian_kind == PG_SPH_PAPER);
  PetscFunctionReturn(0);
}

PetscErrorCode PgSphGetKernel(PgSph sph, const PgKernel **kernel, PetscReal *smoothing)
{
  PetscFunctionBeginUser;
  *kernel    = sph->kernel;
  *smoothing = sph->smoothing;
  PetscFunctionReturn(0);
}

PetscErrorCode PgSphGetForms(PgSph sph, PgSphOperators *gradient, PgSphOperators *laplacian, PetscReal *eta)
{
  PetscFunctionBeginUser;
  if (gradient) *gradient = sph->gradient_kind;
  if (laplacian) *laplacian = sph->laplacian_kind;
  if (eta) *eta = sph->eta;
  PetscFunctionReturn(0);
}

PetscErrorCode PgSphGetFallbacks(PgSph sph, PetscInt *gradients, PetscInt *laplacians)
{
  PetscInt count[2] = {sph->gradient_fallbacks, sph->laplacian_fallbacks};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 2, MPIU_INT, MPI_SUM, PgParticlesComm(sph->particles)));
  *gradients  = count[0];
  *laplacians = count[1];
  PetscFunctionReturn(0);
}
