/* What a checkpoint must hold about the solid phase beside the fields and histories, and whether what it holds can
   be used. */
#include "demimpl.h"

static PetscErrorCode AddWall(PgState state, PetscInt k, PgDemWall *w)
{
  const PgStateRule rule = w->wall.kind == PG_WALL_SERVO ? PG_STATE_KEEP : PG_STATE_MATCH;
  char              name[64], meaning[128];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, sizeof name, "dem_wall_%" PetscInt_FMT "_point", k));
  PetscCall(PgStateAddReals(state, name, PG_STATE_KEEP, NULL, 2, w->wall.point));
  PetscCall(PetscSNPrintf(name, sizeof name, "dem_wall_%" PetscInt_FMT "_start", k));
  PetscCall(PgStateAddReals(state, name, PG_STATE_KEEP, NULL, 2, w->start));
  PetscCall(PetscSNPrintf(name, sizeof name, "dem_wall_%" PetscInt_FMT "_velocity", k));
  PetscCall(PetscSNPrintf(meaning, sizeof meaning, "velocity of wall %s [m/s]", w->wall.name));
  PetscCall(PgStateAddReals(state, name, rule, meaning, 2, w->wall.velocity));
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemAddState(PgDem dem, PgState state)
{
  char name[64], meaning[128];

  PetscFunctionBeginUser;
  PetscCall(PgStateAddInts(state, "dem_plates", PG_STATE_MATCH, "the number of plates", 1, &dem->plate_count));
  for (PetscInt k = 0; k < dem->plate_count; k++) {
    PgPlate *p = &dem->plates[k];

    /* the displacement of a plate is its velocity times the time since the start */
    PetscCall(PetscSNPrintf(name, sizeof name, "dem_plate_%" PetscInt_FMT "_velocity", k));
    PetscCall(PetscSNPrintf(meaning, sizeof meaning, "velocity of plate %s [m/s]", p->name));
    PetscCall(PgStateAddReals(state, name, PG_STATE_MATCH, meaning, 1, &p->velocity));
  }
  PetscCall(PgStateAddInts(state, "dem_walls", PG_STATE_MATCH, "the number of walls", 1, &dem->wall_count));
  for (PetscInt k = 0; k < dem->wall_count; k++) PetscCall(AddWall(state, k, dem->walls[k]));
  PetscFunctionReturn(0);
}

typedef struct {
  const char *name;
  PetscInt    id;
  PetscReal   value;
} Bad;

static void Note(Bad *bad, const char name[], PetscInt id, PetscReal value)
{
  if (id < bad->id) *bad = (Bad){name, id, value};
}

static PetscErrorCode FindBad(PgDem dem, Bad *bad)
{
  const PetscInt  *id, *offset;
  const PetscReal *record;
  PetscReal       *radius, *mass, *plate;
  PetscInt         owned, discs;

  PetscFunctionBeginUser;
  PetscCall(PgParticlesGetSizes(dem->particles, &owned, NULL, &discs));
  PetscCall(PgParticlesGetIds(dem->particles, &id));
  PetscCall(PgParticlesGetArray(dem->particles, PG_RADIUS, &radius));
  PetscCall(PgParticlesGetArray(dem->particles, PG_MASS, &mass));
  PetscCall(PgParticlesGetArray(dem->particles, dem->plate, &plate));
  PetscCall(PgParticlesGetRagged(dem->particles, dem->history, &offset, &record));
  for (PetscInt i = 0; i < owned; i++) {
    if (!(radius[i] > 0)) Note(bad, "radius", id[i], radius[i]);
    if (!(mass[i] > 0)) Note(bad, "mass", id[i], mass[i]);
    if (!(plate[i] >= 0 && plate[i] <= (PetscReal)dem->plate_count && plate[i] == PetscFloorReal(plate[i])))
      Note(bad, "plate", id[i], plate[i]);
    for (PetscInt c = offset[i]; c < offset[i + 1]; c++) {
      const PetscReal partner = record[4 * c];
      if (!(partner >= 0 && partner < (PetscReal)discs && partner == PetscFloorReal(partner)))
        Note(bad, "contact_history (partner)", id[i], partner);
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemCheckState(PgDem dem, const char file[])
{
  MPI_Comm    comm = PgParticlesComm(dem->particles);
  Bad         bad  = {"", PETSC_MAX_INT, 0};
  PetscMPIInt holder;
  char        text[160] = "";

  PetscFunctionBeginUser;
  PetscCall(FindBad(dem, &bad));
  PetscCall(PgFindHolder(comm, 0, bad.id == PETSC_MAX_INT ? -1 : bad.id, 0, &holder));
  if (holder < 0) PetscFunctionReturn(0);
  PetscCall(
      PetscSNPrintf(text, sizeof text, "%s of disc %" PetscInt_FMT " is %g", bad.name, bad.id, (double)bad.value));
  PetscCallMPI(MPI_Bcast(text, sizeof text, MPI_CHAR, holder, comm));
  PetscCall(PgReport(comm, "checkpoint '%s': %s", file, text));
  PetscFunctionReturn(PETSC_ERR_FILE_READ);
}
