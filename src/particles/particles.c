/* The particle store: creation, options, sizes, and the order of a distribution. */
#include "particlesimpl.h"

static const PgFieldInfo core_field[PG_CORE_FIELDS] = {
    [PG_POSITION]         = {"position", 2, "m", "centre of the disc",
                             PG_FIELD_MIGRATE | PG_FIELD_HALO | PG_FIELD_OUTPUT | PG_FIELD_RESTART},
    [PG_VELOCITY]         = {"velocity", 2, "m/s", "velocity of the centre",
                             PG_FIELD_MIGRATE | PG_FIELD_HALO | PG_FIELD_OUTPUT | PG_FIELD_RESTART},
    [PG_ANGULAR_VELOCITY] = {"angular_velocity", 1, "rad/s", "angular velocity, counterclockwise",
                             PG_FIELD_MIGRATE | PG_FIELD_HALO | PG_FIELD_OUTPUT | PG_FIELD_RESTART},
    [PG_ROTATION]         = {"rotation", 1, "rad", "rotation since the start, counterclockwise",
                             PG_FIELD_MIGRATE | PG_FIELD_OUTPUT | PG_FIELD_RESTART},
    [PG_RADIUS]           = {"radius", 1, "m", "radius of the disc",
                             PG_FIELD_MIGRATE | PG_FIELD_HALO | PG_FIELD_OUTPUT | PG_FIELD_RESTART},
    [PG_MASS]             = {"mass", 1, "kg/m", "mass of the disc per metre of thickness",
                             PG_FIELD_MIGRATE | PG_FIELD_HALO | PG_FIELD_RESTART},
    [PG_INITIAL_POSITION] = {"initial_position", 2, "m", "centre of the disc at the start",
                             PG_FIELD_MIGRATE | PG_FIELD_RESTART},
};

PetscErrorCode PgParticlesCreate(MPI_Comm comm, PgParticles *particles)
{
  PgParticles p;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&p));
  PetscCall(PetscCommDuplicate(comm, &p->comm, &p->tag));
  PetscCallMPI(MPI_Comm_rank(p->comm, &p->rank));
  PetscCallMPI(MPI_Comm_size(p->comm, &p->size));
  p->balance    = 1.1;
  p->sort_every = 1;
  p->unsorted   = PETSC_MAX_INT - 1;
  p->recut      = PETSC_TRUE;
  p->grid.width = -1;
  p->crossings  = -1;
  PetscCall(PetscCalloc1(p->size + 1, &p->splitter));
  for (PgField f = 0; f < PG_CORE_FIELDS; f++) {
    PgField field;
    PetscCall(PgParticlesRegisterField(p, &core_field[f], &field));
    PgAssert(field == f, "core field '%s' got index %" PetscInt_FMT, core_field[f].name, field);
  }
  *particles = p;
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesSetFromOptions(PgParticles particles)
{
  PetscFunctionBeginUser;
  PetscOptionsBegin(particles->comm, NULL, "particles: partition over the processes", "");
  PetscCall(PgOptionReal(PetscOptionsObject, "-particles_balance",
                         "largest load over the mean before the discs are partitioned anew", "1", 1.0, PETSC_MAX_REAL,
                         &particles->balance, NULL));
  PetscCall(PgOptionInt(PetscOptionsObject, "-particles_sort_every", "list builds between sortings along the curve", 1,
                        PETSC_MAX_INT - 1, &particles->sort_every, NULL));
  PetscOptionsEnd();
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesView(PgParticles particles, PetscViewer viewer)
{
  PetscInt load[2];

  PetscFunctionBeginUser;
  load[0] = particles->owned;
  load[1] = particles->ghosts;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, load, 2, MPIU_INT, MPI_MAX, particles->comm));
  PetscCall(PetscViewerASCIIPrintf(viewer, "Particles: %" PetscInt_FMT " discs, %" PetscInt_FMT " fields on %d ranks\n",
                                   particles->global, particles->nfields, particles->size));
  PetscCall(PetscViewerASCIIPushTab(viewer));
  PetscCall(PetscViewerASCIIPrintf(viewer, "largest rank: %" PetscInt_FMT " discs, %" PetscInt_FMT " ghosts\n", load[0],
                                   load[1]));
  if (particles->grid.width > 0)
    PetscCall(PetscViewerASCIIPrintf(
        viewer, "partition: Hilbert curve over %" PetscInt_FMT " x %" PetscInt_FMT " cells of at least %g m\n",
        particles->grid.cells[0], particles->grid.cells[1], (double)particles->grid.width));
  PetscCall(
      PetscViewerASCIIPrintf(viewer, "partitioned anew above a load of %g of the mean\n", (double)particles->balance));
  PetscCall(PetscViewerASCIIPrintf(viewer, "sorted every %" PetscInt_FMT " distributions\n", particles->sort_every));
  if (particles->periodic)
    PetscCall(
        PetscViewerASCIIPrintf(viewer, "periodic in x: [%g, %g) m\n", (double)particles->low, (double)particles->high));
  PetscCall(PetscViewerASCIIPopTab(viewer));
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesGetBalance(PgParticles particles, PetscReal *worst, PetscInt *cuts)
{
  PetscFunctionBeginUser;
  *worst = particles->worst_load * particles->size / PetscMax(particles->global, 1);
  *cuts  = particles->cuts;
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesDestroy(PgParticles *particles)
{
  PgParticles p = *particles;

  PetscFunctionBeginUser;
  if (!p) PetscFunctionReturn(0);
  PetscCall(PgHaloDestroy(p));
  PetscCall(PgGhostsDestroy(p));
  PetscCall(PgParticlesDestroyRegistry(p));
  PetscCall(PetscFree(p->splitter));
  PetscCall(PetscCommDestroy(&p->comm));
  PetscCall(PetscFree(*particles));
  PetscFunctionReturn(0);
}

MPI_Comm PgParticlesComm(PgParticles particles) { return particles->comm; }

/* Global indices of the owned discs. Collective. */
PetscErrorCode PgParticlesNumber(PgParticles particles)
{
  PetscInt end = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Scan(&particles->owned, &end, 1, MPIU_INT, MPI_SUM, particles->comm));
  particles->start = end - particles->owned;
  for (PetscInt i = 0; i < particles->owned; i++) particles->index[i] = particles->start + i;
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesSetDiscs(PgParticles particles, PetscInt owned, const PetscInt id[])
{
  PetscInt global;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(&owned, &global, 1, MPIU_INT, MPI_SUM, particles->comm));
  PetscCall(PgParticlesCheckIds(particles, owned, id, global));
  PetscCall(PgGhostsDestroy(particles));
  particles->owned = 0;
  PetscCall(PgParticlesReserve(particles, owned));
  particles->owned      = owned;
  particles->global     = global;
  particles->worst_load = 0;
  particles->cuts       = 0;
  PetscCall(PetscArraycpy(particles->id, id, owned));
  for (PgField f = 0; f < particles->nfields; f++) {
    PgFieldStore *store = particles->field[f];
    if (!store->array) continue;
    PetscCall(PetscArrayzero(store->array, (size_t)particles->capacity * (size_t)store->info.components));
  }
  for (PgRagged r = 0; r < particles->nragged; r++) PetscCall(PgParticlesSetRagged(particles, r, NULL, NULL));
  PetscCall(PgParticlesNumber(particles));
  particles->grid.width = -1;
  particles->recut      = PETSC_TRUE;
  particles->unsorted   = PETSC_MAX_INT - 1;
  particles->revision++;
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesGetSizes(PgParticles particles, PetscInt *owned, PetscInt *ghosts, PetscInt *global)
{
  PetscFunctionBeginUser;
  if (owned) *owned = particles->owned;
  if (ghosts) *ghosts = particles->ghosts;
  if (global) *global = particles->global;
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesGetIds(PgParticles particles, const PetscInt *id[])
{
  PetscFunctionBeginUser;
  *id = particles->id;
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesGetGlobalIndices(PgParticles particles, PetscInt *start, const PetscInt *index[])
{
  PetscFunctionBeginUser;
  if (start) *start = particles->start;
  if (index) *index = particles->index;
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesGetRevision(PgParticles particles, PetscInt *revision)
{
  PetscFunctionBeginUser;
  *revision = particles->revision;
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesSetPeriodicX(PgParticles particles, PetscReal low, PetscReal high)
{
  const PgFieldInfo crossings = {"crossings", 1, "1", "times the disc has crossed the periodic boundary towards +x",
                                 PG_FIELD_MIGRATE | PG_FIELD_RESTART};

  PetscFunctionBeginUser;
  PgInputCheck(high > low, particles->comm, "periodic x: the upper end %g m must lie above the lower end %g m",
               (double)high, (double)low);
  PetscCall(PgParticlesRegisterField(particles, &crossings, &particles->crossings));
  particles->periodic   = PETSC_TRUE;
  particles->low        = low;
  particles->high       = high;
  particles->grid.width = -1;
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesGetPeriodicX(PgParticles particles, PetscBool *periodic, PetscReal *low, PetscReal *high)
{
  PetscFunctionBeginUser;
  *periodic = particles->periodic;
  if (low) *low = particles->low;
  if (high) *high = particles->high;
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesForceMigration(PgParticles particles, PetscInt shift)
{
  PetscFunctionBeginUser;
  particles->shift = ((shift % particles->size) + particles->size) % particles->size;
  particles->recut = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesForgetPartition(PgParticles particles)
{
  PetscFunctionBeginUser;
  particles->grid.width = -1;
  particles->shift      = 0;
  particles->recut      = PETSC_TRUE;
  particles->unsorted   = PETSC_MAX_INT - 1;
  PetscFunctionReturn(0);
}

PetscErrorCode PgParticlesDistribute(PgParticles particles, PetscReal width)
{
  PgSortEntry *entry;
  PgField     *fields;
  PetscInt     count = 0;
  PetscBool    changed;

  PetscFunctionBeginUser;
  PgInputCheck(width > 0, particles->comm, "the cell width %g m of the partition must be positive", (double)width);
  PetscCheck(particles->halo_active == 0, PETSC_COMM_SELF, PETSC_ERR_ORDER, "a halo exchange is still under way");
  PetscCall(PgPartitionUpdate(particles, width));
  PetscCall(PgParticlesMigrate(particles, &entry, &changed));
  PetscCall(PgGhostsUpdate(particles, entry, changed));
  PetscCall(PetscFree(entry));
  PetscCall(PetscMalloc1(particles->nfields, &fields));
  for (PgField f = 0; f < particles->nfields; f++) {
    if (particles->field[f]->info.flags & PG_FIELD_HALO) fields[count++] = f;
  }
  PetscCall(PgParticlesHalo(particles, count, fields));
  PetscCall(PetscFree(fields));
  PetscFunctionReturn(0);
}
