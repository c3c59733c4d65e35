/* When the lists have to be built anew, and the order of a build. */
#include "neighborsimpl.h"
#include <math.h>

PetscErrorCode PgNeighborsCreate(PgParticles particles, PgNeighbors *neighbors)
{
  const PgFieldInfo build_position = {"build_position", 2, "m", "centre of the disc when the lists were built",
                                      PG_FIELD_MIGRATE | PG_FIELD_RESTART};
  PgNeighbors       n;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&n));
  n->particles     = particles;
  n->skin_fraction = 0.2;
  n->skin          = -1;
  n->wide          = -PETSC_MAX_REAL;
  n->narrow        = -PETSC_MAX_REAL;
  PetscCall(PgParticlesRegisterField(particles, &build_position, &n->build_position));
  *neighbors = n;
  PetscFunctionReturn(0);
}

PetscErrorCode PgNeighborsSetFromOptions(PgNeighbors neighbors)
{
  PetscFunctionBeginUser;
  PetscOptionsBegin(PgParticlesComm(neighbors->particles), NULL, "neighbors: pair lists", "");
  PetscCall(PgOptionReal(PetscOptionsObject, "-neighbors_skin",
                         "skin of the pair lists as a fraction of the mean radius: wider means longer lists and fewer "
                         "builds",
                         "1", PETSC_SQRT_MACHINE_EPSILON, PETSC_MAX_REAL, &neighbors->skin_fraction, NULL));
  PetscOptionsEnd();
  PetscFunctionReturn(0);
}

PetscErrorCode PgNeighborsView(PgNeighbors neighbors, PetscViewer viewer)
{
  PetscInt owned;
  int64_t  count[2] = {0, 0};

  PetscFunctionBeginUser;
  PetscCall(
      PetscViewerASCIIPrintf(viewer, "Neighbors: skin %g of the mean radius\n", (double)neighbors->skin_fraction));
  PetscCall(PetscViewerASCIIPushTab(viewer));
  if (neighbors->rows_wanted)
    PetscCall(PetscViewerASCIIPrintf(viewer, "rows reach %g of the larger and %g of the smaller radius\n",
                                     (double)neighbors->wide, (double)neighbors->narrow));
  if (neighbors->builds) {
    PetscCall(PgParticlesGetSizes(neighbors->particles, &owned, NULL, NULL));
    /* a pair with a ghost is held twice, once by each owner */
    count[0] = neighbors->interior + neighbors->contacts;
    if (neighbors->rows_wanted) count[1] = neighbors->row_ptr[owned];
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 2, MPI_INT64_T, MPI_SUM, PgParticlesComm(neighbors->particles)));
    PetscCall(PetscViewerASCIIPrintf(viewer, "skin %g m, %" PetscInt_FMT " build%s\n", (double)neighbors->skin,
                                     neighbors->builds, neighbors->builds == 1 ? "" : "s"));
    PetscCall(PetscViewerASCIIPrintf(viewer, "%lld possible contacts, %lld row entries\n", (long long)(count[0] / 2),
                                     (long long)count[1]));
  }
  PetscCall(PetscViewerASCIIPopTab(viewer));
  PetscFunctionReturn(0);
}

PetscErrorCode PgNeighborsDestroy(PgNeighbors *neighbors)
{
  PgNeighbors n = *neighbors;

  PetscFunctionBeginUser;
  if (!n) PetscFunctionReturn(0);
  PetscCall(PetscFree(n->pairs.low));
  PetscCall(PetscFree(n->pairs.high));
  PetscCall(PetscFree(n->contact_ptr));
  PetscCall(PetscFree(n->contact_sum));
  PetscCall(PetscFree(n->row_ptr));
  PetscCall(PetscFree(n->row_col));
  for (int i = 0; i < 4; i++) PetscCall(PetscFree(n->row_pair[i]));
  PetscCall(PetscFree(n->key));
  PetscCall(PetscFree(n->value));
  PetscCall(PetscFree(*neighbors));
  PetscFunctionReturn(0);
}

PetscErrorCode PgNeighborsRequestRows(PgNeighbors neighbors, PetscReal wide, PetscReal narrow)
{
  PetscFunctionBeginUser;
  PetscCheck(!neighbors->builds, PETSC_COMM_SELF, PETSC_ERR_ORDER, "rows must be requested before the first build");
  PetscCheck(wide + narrow > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "a reach of %g times the larger and %g times the smaller radius is not positive", (double)wide,
             (double)narrow);
  neighbors->rows_wanted = PETSC_TRUE;
  if (neighbors->wide > 0) { /* w (M - m) + (w + n) m bounds both reaches when w and w + n are the larger ones */
    const PetscReal sum = PetscMax(wide + narrow, neighbors->wide + neighbors->narrow);
    wide                = PetscMax(wide, neighbors->wide);
    narrow              = sum - wide;
  }
  neighbors->wide   = wide;
  neighbors->narrow = narrow;
  PetscFunctionReturn(0);
}

PetscErrorCode PgNeighborsGetRevision(PgNeighbors neighbors, PetscInt *revision)
{
  PetscFunctionBeginUser;
  *revision = neighbors->builds;
  PetscFunctionReturn(0);
}

PetscErrorCode PgNeighborsGetSkin(PgNeighbors neighbors, PetscReal *skin)
{
  PetscFunctionBeginUser;
  PetscCheck(neighbors->builds, PETSC_COMM_SELF, PETSC_ERR_ORDER, "the lists were never built: they have no skin yet");
  *skin = neighbors->skin;
  PetscFunctionReturn(0);
}

PetscErrorCode PgNeighborsGetContacts(PgNeighbors neighbors, PgContactList *list)
{
  PetscFunctionBeginUser;
  PetscCheck(neighbors->builds, PETSC_COMM_SELF, PETSC_ERR_ORDER, "the contact list was never built");
  list->count    = neighbors->contacts;
  list->padded   = neighbors->pairs.count;
  list->low      = neighbors->pairs.low;
  list->high     = neighbors->pairs.high;
  list->ptr      = neighbors->contact_ptr;
  list->sum      = neighbors->contact_sum;
  list->interior = neighbors->interior;
  PetscFunctionReturn(0);
}

PetscErrorCode PgNeighborsGetRows(PgNeighbors neighbors, PgRowList *list)
{
  PetscFunctionBeginUser;
  PetscCheck(neighbors->builds && neighbors->rows_wanted, PETSC_COMM_SELF, PETSC_ERR_ORDER, "the row list was never %s",
             neighbors->rows_wanted ? "built" : "requested");
  list->ptr    = neighbors->row_ptr;
  list->col    = neighbors->row_col;
  list->pairs  = neighbors->row_pairs;
  list->one    = neighbors->row_pair[0];
  list->two    = neighbors->row_pair[1];
  list->one_at = neighbors->row_pair[2];
  list->two_at = neighbors->row_pair[3];
  PetscFunctionReturn(0);
}

/* ---- when to build ---- */

/* Squared displacement since the build; infinite when it is not a number. */
static inline PetscReal Displacement2(const PetscReal now[2], const PetscReal then[2])
{
  const PetscReal dx = now[0] - then[0], dy = now[1] - then[1], d2 = dx * dx + dy * dy;

  return islessequal(d2, PETSC_MAX_REAL) ? d2 : PETSC_MAX_REAL;
}

/* Names the disc that has moved furthest. */
static PetscErrorCode ReportTooFar(PgNeighbors neighbors, const PetscReal now[], const PetscReal then[],
                                   PetscReal furthest)
{
  MPI_Comm        comm = PgParticlesComm(neighbors->particles);
  PetscInt        owned, found = -1, which = -1;
  const PetscInt *id;
  PetscMPIInt     holder;
  PetscReal       at[2] = {0, 0};

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(neighbors->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetIds(neighbors->particles, &id));
  for (PetscInt i = 0; i < owned; i++) {
    if (Displacement2(now + 2 * i, then + 2 * i) >= furthest && (found < 0 || id[i] < id[found])) found = i;
  }
  if (found >= 0) {
    which = id[found];
    at[0] = now[2 * found];
    at[1] = now[2 * found + 1];
  }
  PetscCall(PgFindHolder(comm, 0, which, 0, &holder));
  PetscCallMPI(MPI_Bcast(&which, 1, MPIU_INT, holder, comm));
  PetscCallMPI(MPI_Bcast(at, 2, MPIU_REAL, holder, comm));
  if (furthest >= PETSC_MAX_REAL)
    PgRunError(comm, "the position (%g, %g) m of particle %" PetscInt_FMT " is not finite or out of bounds",
               (double)at[0], (double)at[1], which);
  PgRunError(comm,
             "particle %" PetscInt_FMT " at (%g, %g) m has moved by %g m since the pair lists were built, more than "
             "their skin of %g m: it is too fast for the time step (or for -neighbors_skin)",
             which, (double)at[0], (double)at[1], (double)PetscSqrtReal(furthest), (double)neighbors->skin);
}

PetscErrorCode PgNeighborsNeedBuild(PgNeighbors neighbors, PetscBool *need)
{
  const PetscReal skin = neighbors->skin;
  PetscReal      *now, *then, furthest = 0;
  PetscInt        owned, revision;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetRevision(neighbors->particles, &revision));
  *need = PETSC_TRUE;
  if (!neighbors->builds || revision != neighbors->revision) PetscFunctionReturn(0);
  PetscCall(PgParticlesGetSizes(neighbors->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(neighbors->particles, PG_POSITION, &now));
  PetscCall(PgParticlesGetArray(neighbors->particles, neighbors->build_position, &then));
  for (PetscInt i = 0; i < owned; i++) {
    const PetscReal d2 = Displacement2(now + 2 * i, then + 2 * i);
    furthest           = PetscMax(furthest, d2);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &furthest, 1, MPIU_REAL, MPI_MAX, PgParticlesComm(neighbors->particles)));
  if (furthest > skin * skin) PetscCall(ReportTooFar(neighbors, now, then, furthest));
  *need = (PetscBool)(furthest > 0.25 * skin * skin);
  PetscFunctionReturn(0);
}

/* ---- build ---- */

/* Finds the largest radius and, the first time, the skin. The mean radius is summed in fixed point, so that
   the skin has the same bits on any number of ranks. */
static PetscErrorCode SurveyRadii(PgNeighbors neighbors)
{
  const PetscReal scale = 1073741824; /* 2^30: room for 2^33 discs */
  MPI_Comm        comm  = PgParticlesComm(neighbors->particles);
  PetscReal      *radius, most[2] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL};
  PetscInt        owned, global;
  int64_t         sum = 0;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(neighbors->particles, &owned, NULL, &global));
  PetscCall(PgParticlesGetArray(neighbors->particles, PG_RADIUS, &radius));
  for (PetscInt i = 0; i < owned; i++) {
    const PetscReal r = isfinite(radius[i]) ? radius[i] : 0;
    most[0]           = PetscMax(most[0], r);
    most[1]           = PetscMax(most[1], -r);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 2, MPIU_REAL, MPI_MAX, comm));
  if (!global) most[0] = 1; /* without discs any length will do */
  PgInputCheck(most[1] < 0, comm, "the radius of every disc must be positive and finite");
  neighbors->r_max = most[0];
  if (neighbors->skin >= 0) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < owned; i++) sum += (int64_t)(radius[i] / neighbors->r_max * scale);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_INT64_T, MPI_SUM, comm));
  neighbors->skin = neighbors->skin_fraction * neighbors->r_max;
  if (global) neighbors->skin *= (PetscReal)sum / scale / (PetscReal)global;
  PetscFunctionReturn(0);
}

static PetscErrorCode Build(PgNeighbors neighbors)
{
  PetscReal width, *now, *then;
  PetscInt  owned;
  PetscBool rows = neighbors->rows_wanted;

  PetscFunctionBeginUser;
  PetscCall(SurveyRadii(neighbors));
  width = 2 * neighbors->r_max + neighbors->skin;
  if (rows) width = PetscMax(width, (neighbors->wide + neighbors->narrow) * neighbors->r_max + neighbors->skin);
  PetscCall(PgParticlesDistribute(neighbors->particles, width));
  PetscCall(PgParticlesGetRevision(neighbors->particles, &neighbors->revision));
  PetscCall(PgParticlesGetSizes(neighbors->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(neighbors->particles, PG_POSITION, &now));
  PetscCall(PgParticlesGetArray(neighbors->particles, neighbors->build_position, &then));
  PetscCall(PetscArraycpy(then, now, 2 * owned));
  PetscCall(PgContactsBuild(neighbors));
  if (rows) PetscCall(PgRowsBuild(neighbors));
  neighbors->builds++;
  PetscFunctionReturn(0);
}

PetscErrorCode PgNeighborsBuild(PgNeighbors neighbors)
{
  PetscErrorCode err;

  PetscFunctionBeginUser;
  PetscCall(PgStagePush(PG_STAGE_LISTS));
  err = Build(neighbors);
  PetscCall(PgStagePop());
  PetscCall(err);
  PetscFunctionReturn(0);
}
