/* What is read off the discs: loads, coordination number, stress, kinetic energy (model: Eqs. 1, 2). */
#include "demimpl.h"

PetscErrorCode PgDemGetLoad(PgDem dem, PetscInt plate, PetscReal *contact, PetscReal *total)
{
  PgExactSum sum[2] = {{.not_finite = 0}, {.not_finite = 0}};
  PetscReal *on, *reaction, value[2];

  PetscFunctionBeginUser;
  PetscCheck(plate >= 0 && plate < dem->plate_count, PgParticlesComm(dem->particles), PETSC_ERR_ARG_OUTOFRANGE,
             "no plate %" PetscInt_FMT " among %" PetscInt_FMT, plate, dem->plate_count);
  PetscCall(PgDemUpdatePlateDiscs_Private(dem));
  PetscCall(PgParticlesGetArray(dem->particles, dem->plate, &on));
  PetscCall(PgParticlesGetArray(dem->particles, dem->plate_reaction, &reaction));
  for (PetscInt k = 0; k < dem->plate_disc_count; k++) {
    const PetscInt i = dem->plate_disc[k];

    if ((PetscInt)on[i] != plate + 1) continue;
    PgExactSumAdd(&sum[0], reaction[2 * i]);
    PgExactSumAdd(&sum[1], reaction[2 * i + 1]);
  }
  PetscCall(PgExactSumReduce(PgParticlesComm(dem->particles), 2, sum, value));
  if (contact) *contact = value[0];
  if (total) *total = value[1];
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemKineticEnergy(PgDem dem, PetscReal *energy)
{
  PgExactSum sum = {.not_finite = 0};
  PetscReal *m;
  PgDemDiscs d;
  PetscInt   owned;

  PetscFunctionBeginUser;
  PetscCall(PgDemGetDiscs_Private(dem, &d));
  PetscCall(PgParticlesGetSizes(dem->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(dem->particles, PG_MASS, &m));
  for (PetscInt i = 0; i < owned; i++) PgExactSumAdd(&sum, PgDemDiscKinetic(&d, m, i));
  PetscCall(PgExactSumReduce(PgParticlesComm(dem->particles), 1, &sum, energy));
  PetscFunctionReturn(0);
}

/* Pair forces at the present positions when no evaluation has left them (after a restart, or a list build):
   nothing that the run depends on is changed. */
static PetscErrorCode ComputePairs(PgDem dem, const PgContactList *list, const PgDemDiscs *discs)
{
  const PetscInt n = list->padded;
  PgDemPairs     p = dem->pairs;

  PetscFunctionBeginUser;
  if (dem->pairs_computed) PetscFunctionReturn(0);
  PetscCall(PetscMalloc3(n, &p.f_s, n, &p.f_r, n, &p.m_r));
  PetscCall(PetscArraycpy(p.f_s, dem->pairs.f_s, n));
  PetscCall(PetscArraycpy(p.f_r, dem->pairs.f_r, n));
  PetscCall(PetscArraycpy(p.m_r, dem->pairs.m_r, n));
  dem->law->loop(&dem->parameters, list, discs, 0, &p, 0, n);
  PetscCall(PetscFree3(p.f_s, p.f_r, p.m_r));
  PetscFunctionReturn(0);
}

/* Adds the contacts of disc i: sigma += f (x) l with l = r_i n from its centre to the contact point. */
static void ContactStress(PgDem dem, const PgContactList *list, const PgDemDiscs *discs, PetscInt i,
                          PetscReal *touching, PetscReal sigma[4])
{
  for (PetscInt k = list->ptr[i]; k < list->ptr[i + 1]; k++) {
    const PetscInt   pair = list->sum[k] >> 1, a = list->low[pair], j = list->high[pair];
    const PetscReal *f = &dem->pairs.result[4 * pair], r = discs->radius[i];
    PetscReal        n[2];

    if (PgDemTouching(PgDemPairGeometry(discs, a, j, n), discs->radius[a], discs->radius[j])) *touching += 1;
    for (PetscInt c = 0; c < 2; c++) /* on the high disc both f and n are the opposite */
      for (PetscInt d = 0; d < 2; d++) sigma[2 * c + d] += f[c] * (r * n[d]);
  }
}

/* The same for its walls. */
static void WallStress(PgDem dem, const PgDemDiscs *discs, PetscInt i, PetscReal *touching, PetscReal sigma[4])
{
  for (PetscInt k = PgDemFindWallContact_Private(dem, i); k < dem->wall_contact_count && dem->wall_contact[k].disc == i;
       k++) {
    const PgWall   *w = &dem->walls[dem->wall_contact[k].wall]->wall;
    const PetscReal r = discs->radius[i];
    PetscReal       f[3];

    if (PgDemTouching(PgDemWallOverlap(w, &discs->position[2 * i], r), r, r)) *touching += 1;
    PgDemWallContactForce_Private(dem, &dem->wall_contact[k], r, f);
    for (PetscInt c = 0; c < 2; c++)
      for (PetscInt d = 0; d < 2; d++) sigma[2 * c + d] -= f[c] * (r * w->normal[d]);
  }
}

PetscErrorCode PgDemComputeObservables(PgDem dem)
{
  PgContactList list;
  PgDemDiscs    discs;
  PgField       field;
  PetscInt      owned;
  PetscReal    *touching, *stress, *plate, *spring, *reaction, *porosity = NULL;

  PetscFunctionBeginUser;
  PetscCall(PgDemGetContacts_Private(dem, &list));
  PetscCall(PgDemGetDiscs_Private(dem, &discs));
  PetscCall(ComputePairs(dem, &list, &discs));
  PetscCall(PgDemUpdateWallContacts_Private(dem));
  PetscCall(PgParticlesGetSizes(dem->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(dem->particles, dem->coordination, &touching));
  PetscCall(PgParticlesGetArray(dem->particles, dem->stress, &stress));
  PetscCall(PgParticlesGetArray(dem->particles, dem->plate, &plate));
  PetscCall(PgParticlesGetArray(dem->particles, dem->plate_spring, &spring));
  PetscCall(PgParticlesGetArray(dem->particles, dem->plate_reaction, &reaction));
  PetscCall(PgParticlesFindField(dem->particles, "porosity", &field));
  if (field >= 0) PetscCall(PgParticlesGetArray(dem->particles, field, &porosity));
  for (PetscInt i = 0; i < owned; i++) {
    const PetscReal n = porosity && porosity[i] > 0 && porosity[i] < 1 ? porosity[i] : 0, r = discs.radius[i];
    PetscReal      *sigma = &stress[4 * i];

    touching[i] = sigma[0] = sigma[1] = sigma[2] = sigma[3] = 0;
    ContactStress(dem, &list, &discs, i, &touching[i], sigma);
    if (dem->wall_count) WallStress(dem, &discs, i, &touching[i], sigma);
    if (plate[i] > 0 && !dem->plates[(PetscInt)plate[i] - 1].hold) {
      const PetscReal side = dem->plates[(PetscInt)plate[i] - 1].side, push = reaction[2 * i + 1];

      touching[i] += push > 0;
      sigma[1] += spring[i] * side * r; /* force (spring, -side push) at (0, side r) */
      sigma[3] -= push * r;
    }
    for (PetscInt c = 0; c < 4; c++) sigma[c] *= (1 - n) / (PETSC_PI * r * r);
  }
  if (dem->energy) PetscCall(PgDemFillFrictionEnergy_Private(dem));
  PetscFunctionReturn(0);
}
