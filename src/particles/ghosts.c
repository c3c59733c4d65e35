/* Ghosts: copies of the discs in the cells next to mine, and periodic images. Senders know from the cells
   who needs their discs; receivers are told. */
#include "particlesimpl.h"
#include <stdlib.h>

static int CompareSends(const void *a, const void *b)
{
  const PgGhostSend *l = (const PgGhostSend *)a, *r = (const PgGhostSend *)b;

  if (l->rank != r->rank) return l->rank < r->rank ? -1 : 1;
  if (l->disc != r->disc) return l->disc < r->disc ? -1 : 1;
  return l->shift < r->shift ? -1 : l->shift > r->shift;
}

/* True when all eight neighbours of the cell are surely mine: an aligned block of 2^k x 2^k cells is one
   range of keys, so it is enough to find one that holds the neighbours and lies in my range. */
static PetscBool DeepInside(const PgGrid *grid, PetscBool periodic, const PetscInt cell[2], uint64_t key,
                            uint64_t first, uint64_t end)
{
  if (periodic && (cell[0] == 0 || cell[0] == grid->cells[0] - 1)) return PETSC_FALSE;
  for (int level = 1; level <= grid->levels; level++) {
    const PetscInt last = ((PetscInt)1 << level) - 1;
    const uint64_t keys = (uint64_t)1 << (2 * level), base = key & ~(keys - 1);
    const PetscInt x = cell[0] & last, y = cell[1] & last;
    if (base < first || base + keys > end) return PETSC_FALSE;
    if (x > 0 && x < last && y > 0 && y < last) return PETSC_TRUE;
  }
  return PETSC_TRUE; /* the whole grid is mine */
}

/* Who needs the disc in `cell`: each (rank, shift) once. */
static PetscInt Takers(PgParticles particles, const PetscInt cell[2], PgGhostSend taker[8])
{
  const PgGrid *grid  = &particles->grid;
  PetscInt      count = 0;

  for (int n = 0; n < 9; n++) {
    PetscInt    ix = cell[0] + n % 3 - 1, iy = cell[1] + n / 3 - 1, shift = 0, known;
    PetscMPIInt rank;
    if (n == 4 || iy < 0 || iy >= grid->cells[1]) continue;
    if (ix < 0 || ix >= grid->cells[0]) {
      if (!particles->periodic) continue;
      shift = ix < 0 ? 1 : -1;
      ix += shift * grid->cells[0];
    }
    rank = PgPartitionOwner(particles, PgCurveKey(grid, ix, iy));
    if (rank == particles->rank && shift == 0) continue;
    for (known = 0; known < count; known++) {
      if (taker[known].rank == rank && taker[known].shift == shift) break;
    }
    if (known < count) continue;
    taker[count].rank    = rank;
    taker[count++].shift = shift;
  }
  return count;
}

/* Lists what this rank has to send, and its boundary discs. */
static PetscErrorCode Collect(PgParticles particles, const PgSortEntry entry[], PetscInt *nsend, PgGhostSend *send[],
                              PetscInt *nroots, PetscInt *root[])
{
  const PetscReal *position   = particles->field[PG_POSITION]->array;
  PetscInt         room_sends = 0, room_roots = 0;
  uint64_t         first, end;

  PetscFunctionBeginUser;
  *nsend  = 0;
  *nroots = 0;
  *send   = NULL;
  *root   = NULL;
  if (particles->size == 1 && !particles->periodic) PetscFunctionReturn(0);
  PgPartitionOwnRange(particles, &first, &end);
  for (PetscInt i = 0; i < particles->owned; i++) {
    PetscInt    cell[2], count;
    PgGhostSend taker[8];
    PgGridCell(&particles->grid, position + 2 * i, cell);
    if (DeepInside(&particles->grid, particles->periodic, cell, entry[i].key, first, end)) continue;
    count = Takers(particles, cell, taker);
    if (!count) continue;
    if (*nsend + count > room_sends) {
      room_sends = 2 * room_sends + 64;
      PetscCall(PetscRealloc((size_t)room_sends * sizeof **send, send));
    }
    if (*nroots == room_roots) {
      room_roots = 2 * room_roots + 64;
      PetscCall(PetscRealloc((size_t)room_roots * sizeof **root, root));
    }
    for (PetscInt t = 0; t < count; t++) {
      taker[t].disc       = i;
      taker[t].root       = *nroots;
      (*send)[(*nsend)++] = taker[t];
    }
    (*root)[(*nroots)++] = i;
  }
  if (*nsend) qsort(*send, (size_t)*nsend, sizeof **send, CompareSends);
  PetscFunctionReturn(0);
}

static PetscBool SameSends(PetscInt n, const PgGhostSend a[], PetscInt m, const PgGhostSend b[])
{
  if (n != m) return PETSC_FALSE;
  for (PetscInt s = 0; s < n; s++) {
    if (CompareSends(&a[s], &b[s])) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Tells the receivers about their ghosts: number among my boundary discs, shift, id and global index. */
static PetscErrorCode Tell(PgParticles particles, PgMessages *messages, PetscInt *told[])
{
  const PgGhostSend *send = particles->send;
  PetscMPIInt        nto  = 0, *to;
  PetscInt          *size, *about;

  PetscFunctionBeginUser;
  for (PetscInt s = 0; s < particles->nsend; s++) nto += (s == 0 || send[s].rank != send[s - 1].rank);
  PetscCall(PetscMalloc3(nto, &to, nto, &size, 4 * (size_t)particles->nsend, &about));
  nto = 0;
  for (PetscInt s = 0; s < particles->nsend; s++) {
    if (s == 0 || send[s].rank != send[s - 1].rank) {
      to[nto]     = send[s].rank;
      size[nto++] = 0;
    }
    size[nto - 1] += 4;
    about[4 * s]     = send[s].root;
    about[4 * s + 1] = send[s].shift;
    about[4 * s + 2] = particles->id[send[s].disc];
    about[4 * s + 3] = particles->start + send[s].disc;
  }
  PetscCall(PgMessagesPlan(particles->comm, 1, nto, to, size, messages));
  PetscCall(PetscMalloc1(PgMessagesReceived(messages, 0), told));
  PetscCall(PgMessagesExchange(particles->comm, particles->tag, messages, 0, MPIU_INT, about, *told));
  PetscCall(PetscFree3(to, size, about));
  PetscFunctionReturn(0);
}

/* Makes room for the ghosts and the star forest that feeds them. */
static PetscErrorCode Receive(PgParticles particles)
{
  PgMessages   messages;
  PetscInt    *told, g = 0;
  PetscSFNode *remote;

  PetscFunctionBeginUser;
  PetscCall(Tell(particles, &messages, &told));
  particles->ghosts = 0;
  PetscCall(PgParticlesReserve(particles, particles->owned + PgMessagesReceived(&messages, 0) / 4));
  particles->ghosts = PgMessagesReceived(&messages, 0) / 4;
  PetscCall(PetscFree(particles->image));
  PetscCall(PetscMalloc1(particles->ghosts, &particles->image));
  PetscCall(PetscMalloc1(particles->ghosts, &remote));
  for (PetscMPIInt m = 0; m < messages.nfrom; m++) {
    for (PetscInt k = 0; k < messages.from_size[m] / 4; k++, g++) {
      remote[g].rank                         = messages.from[m];
      remote[g].index                        = told[4 * g];
      particles->image[g]                    = told[4 * g + 1];
      particles->id[particles->owned + g]    = told[4 * g + 2];
      particles->index[particles->owned + g] = told[4 * g + 3];
    }
  }
  if (!particles->halo) PetscCall(PetscSFCreate(particles->comm, &particles->halo));
  PetscCall(PetscSFReset(particles->halo));
  PetscCall(PetscSFSetGraph(particles->halo, particles->nroots, particles->ghosts, NULL, PETSC_OWN_POINTER, remote,
                            PETSC_OWN_POINTER));
  PetscCall(PetscSFSetUp(particles->halo));
  PetscCall(PgMessagesDestroy(&messages));
  PetscCall(PetscFree(told));
  PetscFunctionReturn(0);
}

/* Finds the ghosts after a migration. Nothing moves, and the revision stays, when no rank has changed
   anything. Collective. */
PetscErrorCode PgGhostsUpdate(PgParticles particles, const PgSortEntry entry[], PetscBool changed)
{
  PgGhostSend *send;
  PetscInt     nsend, nroots, *root, any[2];

  PetscFunctionBeginUser;
  PetscCall(Collect(particles, entry, &nsend, &send, &nroots, &root));
  any[0] = changed || !SameSends(nsend, send, particles->nsend, particles->send);
  any[1] = nsend > 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, any, 2, MPIU_INT, MPI_MAX, particles->comm));
  PetscCall(PetscFree(particles->send));
  PetscCall(PetscFree(particles->root));
  particles->nsend      = nsend;
  particles->send       = send;
  particles->nroots     = nroots;
  particles->root       = root;
  particles->any_ghosts = (PetscBool)any[1];
  if (any[0]) {
    particles->revision++;
    PetscCall(PgParticlesNumber(particles));
    if (particles->any_ghosts)
      PetscCall(Receive(particles));
    else
      particles->ghosts = 0;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgGhostsDestroy(PgParticles particles)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(particles->send));
  PetscCall(PetscFree(particles->root));
  PetscCall(PetscFree(particles->image));
  particles->nsend = particles->nroots = particles->ghosts = 0;
  particles->any_ghosts                                    = PETSC_FALSE;
  PetscFunctionReturn(0);
}
