/* What is read off the discs: loads, coordination number, stress, kinetic energy (model: Eqs. 1, 2). */
#include "demimpl.h"

/* A sum that does not depend on the order of its terms: all are rounded to integers in one unit that the
   largest of all ranks fixes, the remainders to a finer one, and integers add up exactly. The units are so
   small that the result is as good as a sum in extended precision. */
PetscErrorCode PgDemSum_Private(MPI_Comm comm, PetscInt count, const PetscReal value[], PetscReal *sum)
{
  struct {
    PetscReal largest, bad;
  } local            = {0, 0}, all;
  PetscInt64 part[2] = {0, 0}, terms = count;
  int        exponent, bits          = 1;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < count; k++) {
    if (PetscIsInfOrNanReal(value[k]))
      local.bad = 1;
    else
      local.largest = PetscMax(local.largest, PetscAbsReal(value[k]));
  }
  PetscCallMPI(MPI_Allreduce(&local, &all, 2, MPIU_REAL, MPIU_MAX, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &terms, 1, MPIU_INT64, MPI_SUM, comm));
  *sum = all.bad > 0 ? NAN : 0;
  if (all.bad > 0 || all.largest == 0) PetscFunctionReturn(0);
  while (((PetscInt64)1 << bits) <= terms) bits++;
  (void)frexp((double)all.largest, &exponent); /* |value| < 2^exponent, number of terms < 2^bits */
  for (PetscInt k = 0; k < count; k++) {
    const double scaled = ldexp((double)value[k], 62 - bits - exponent);
    const double coarse = nearbyint(scaled);

    part[0] += (PetscInt64)coarse;
    part[1] += (PetscInt64)nearbyint(ldexp(scaled - coarse, 62 - bits));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, part, 2, MPIU_INT64, MPI_SUM, comm));
  *sum = (PetscReal)(ldexp((double)part[0], exponent + bits - 62) + ldexp((double)part[1], exponent + 2 * (bits - 62)));
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemGetLoad(PgDem dem, PetscInt plate, PetscReal *contact, PetscReal *total)
{
  MPI_Comm   comm = PgParticlesComm(dem->particles);
  PetscReal *on, *reaction, *work;
  PetscInt   count = 0;

  PetscFunctionBeginUser;
  PetscCheck(plate >= 0 && plate < dem->plate_count, PgParticlesComm(dem->particles), PETSC_ERR_ARG_OUTOFRANGE,
             "no plate %" PetscInt_FMT " among %" PetscInt_FMT, plate, dem->plate_count);
  PetscCall(PgDemUpdatePlateDiscs_Private(dem));
  PetscCall(PgDemGetWork_Private(dem, 2 * dem->plate_disc_count, &work));
  PetscCall(PgParticlesGetArray(dem->particles, dem->plate, &on));
  PetscCall(PgParticlesGetArray(dem->particles, dem->plate_reaction, &reaction));
  for (PetscInt k = 0; k < dem->plate_disc_count; k++) {
    const PetscInt i = dem->plate_disc[k];

    if ((PetscInt)on[i] != plate + 1) continue;
    work[count]                           = reaction[2 * i];
    work[dem->plate_disc_count + count++] = reaction[2 * i + 1];
  }
  if (contact) PetscCall(PgDemSum_Private(comm, count, work, contact));
  if (total) PetscCall(PgDemSum_Private(comm, count, work + dem->plate_disc_count, total));
  PetscFunctionReturn(0);
}

PetscErrorCode PgDemKineticEnergy(PgDem dem, PetscReal *energy)
{
  PetscReal *m, *work;
  PgDemDiscs d;
  PetscInt   owned;

  PetscFunctionBeginUser;
  PetscCall(PgDemGetDiscs_Private(dem, &d));
  PetscCall(PgParticlesGetSizes(dem->particles, &owned, NULL, NULL));
  PetscCall(PgParticlesGetArray(dem->particles, PG_MASS, &m));
  PetscCall(PgDemGetWork_Private(dem, owned, &work));
  for (PetscInt i = 0; i < owned; i++) {
    const PetscReal *v = &d.velocity[2 * i], spin = d.radius[i] * d.spin[i];
    work[i] = 0.5 * m[i] * (v[0] * v[0] + v[1] * v[1] + 0.5 * spin * spin); /* I = m r^2/2 */
  }
  PetscCall(PgDemSum_Private(PgParticlesComm(dem->particles), owned, work, energy));
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
  dem->law->loop(&dem->parameters, list, discs, 0, &p);
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
    if (plate[i] > 0 && !dem->plates[(PetscInt)plate[i] - 1].hold) {
      const PetscReal side = dem->plates[(PetscInt)plate[i] - 1].side, push = reaction[2 * i + 1];

      touching[i] += push > 0;
      sigma[1] += spring[i] * side * r; /* force (spring, -side push) at (0, side r) */
      sigma[3] -= push * r;
    }
    for (PetscInt c = 0; c < 4; c++) sigma[c] *= (1 - n) / (PETSC_PI * r * r);
  }
  PetscFunctionReturn(0);
}
