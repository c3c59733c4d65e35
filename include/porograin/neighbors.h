/* neighbors: who is near whom. Cell list, Verlet skin and two pair lists; knows neither kernels nor
   forces. Both lists are ordered by permanent id where sums are formed, so that a sum over a row has the
   same rounding on any number of ranks and however often the lists are rebuilt. */
#pragma once

#include <porograin/particles.h>

typedef struct PgNeighbors_s *PgNeighbors;

/* Pairs that may touch: centres nearer than r_low + r_high + skin at the time of the build, each once,
   with at least one disc owned. low is the disc with the smaller permanent id, so that two ranks that
   both hold a pair compute the same bits. The arrays are padded with copies of the last pair to a
   multiple of 8 (`padded`), for loops without remainder; results of the padding are never read. */
typedef struct {
  PetscInt        count, padded;
  const PetscInt *low, *high; /* local indices, ghosts included */
  /* by owned disc: entries of disc i are sum[ptr[i]] .. sum[ptr[i+1]-1], in ascending id of the partner;
     an entry is 2*pair for low, 2*pair + 1 for high. */
  const PetscInt *ptr, *sum;
  PetscInt        interior; /* pairs [0, interior) touch owned discs only, in ascending order of the smaller index */
} PgContactList;

/* Rows of owned discs with all partners (the disc itself not included) whose distance at the time of the
   build was below reach(r_a, r_b) + skin, in ascending id. */
typedef struct {
  const PetscInt *ptr, *col; /* CSR; col are local indices, ghosts included */
  /* The same pairs once each, for what both discs of a pair share: the disc `one[q]` (owned) has the other as its entry
     one_at[q], and the disc `two[q]` has the first as its entry two_at[q]. Where `two` is a ghost, which has no row
     here, two_at is ptr[owned], one past the last entry. */
  PetscInt        pairs;
  const PetscInt *one, *two, *one_at, *two_at;
} PgRowList;

/* Collective. */
PETSC_EXTERN PetscErrorCode PgNeighborsCreate(PgParticles particles, PgNeighbors *neighbors);
/* Reads -neighbors_skin (fraction of the mean radius, default 0.2). Collective. */
PETSC_EXTERN PetscErrorCode PgNeighborsSetFromOptions(PgNeighbors neighbors);
PETSC_EXTERN PetscErrorCode PgNeighborsView(PgNeighbors neighbors, PetscViewer viewer);
PETSC_EXTERN PetscErrorCode PgNeighborsDestroy(PgNeighbors *neighbors);
/* Asks for the row list too. The reach of a pair is wide * max(r_a, r_b) + narrow * min(r_a, r_b); after several
   calls it is at least the largest of theirs. Before the first build. */
PETSC_EXTERN PetscErrorCode PgNeighborsRequestRows(PgNeighbors neighbors, PetscReal wide, PetscReal narrow);

/* True on every rank when some disc has moved by more than half the skin since the last build, or there
   was none. Fails when one has moved further than the lists can bear. Collective. */
PETSC_EXTERN PetscErrorCode PgNeighborsNeedBuild(PgNeighbors neighbors, PetscBool *need);
/* Distributes the particles (all arrays move) and builds the lists. Collective. */
PETSC_EXTERN PetscErrorCode PgNeighborsBuild(PgNeighbors neighbors);
/* Number of builds so far: whatever is kept per list entry is stale when it has changed. */
PETSC_EXTERN PetscErrorCode PgNeighborsGetRevision(PgNeighbors neighbors, PetscInt *revision);
/* Skin of the lists [m]. No disc is further than half of it from where it was at the build when
   PgNeighborsNeedBuild() has said no. After the first build. */
PETSC_EXTERN PetscErrorCode PgNeighborsGetSkin(PgNeighbors neighbors, PetscReal *skin);
PETSC_EXTERN PetscErrorCode PgNeighborsGetContacts(PgNeighbors neighbors, PgContactList *list);
PETSC_EXTERN PetscErrorCode PgNeighborsGetRows(PgNeighbors neighbors, PgRowList *list);
