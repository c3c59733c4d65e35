/* Fuzz target: the reader of checkpoints. The first byte chooses what is done with the rest:

     even  the file, as it is
     odd   objects of a good checkpoint to be replaced by others, which then gets a good seal

   What is accepted has finite values and sensible counts. Damaged bytes behind a good seal are not tried: the checksum
   is what stands between them and HDF5, which does not survive all of them. */
#include "fuzz.h"
#include <hdf5.h>
#include <math.h>
#include <porograin/io.h>

enum { DISCS = 7 };
static const char  good[] = "good.pgc", bad[] = "bad.pgc";
static PgParticles discs;
static PgRagged    touching;
static uint8_t     content[1 << 17];
static size_t      length;

static PgState MakeState(PetscReal time[2], PetscInt *step, char name[16])
{
  PgState state;

  Demand(!PgStateCreate(&state));
  Demand(!PgStateAddReals(state, "test_time", PG_STATE_KEEP, NULL, 2, time));
  Demand(!PgStateAddInts(state, "test_step", PG_STATE_KEEP, NULL, 1, step));
  Demand(!PgStateAddText(state, "test_name", PG_STATE_KEEP, NULL, 16, name));
  return state;
}

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  const PgFieldInfo spring = {"spring", 2, "N", "a field", PG_FIELD_MIGRATE | PG_FIELD_RESTART};
  PetscReal         record[2 * DISCS], time[2] = {0.25, 0.5}, *position;
  PetscInt          step     = 3, id[DISCS], offset[DISCS + 1];
  char              name[16] = "name";
  PgField           field;
  PgState           state;
  FILE             *stream;

  (void)argc;
  (void)argv;
  FuzzStart();
  Demand(!PgParticlesCreate(PETSC_COMM_SELF, &discs));
  Demand(!PgParticlesRegisterField(discs, &spring, &field));
  for (PetscInt i = 0; i < DISCS; i++) id[i] = i;
  Demand(!PgParticlesSetDiscs(discs, DISCS, id));
  Demand(!PgParticlesGetArray(discs, PG_POSITION, &position));
  for (PetscInt i = 0; i < 2 * DISCS; i++) position[i] = 0.25 * (PetscReal)i;
  Demand(!PgParticlesDistribute(discs, 0.1));
  Demand(!PgParticlesRegisterRagged(discs, "touching", 2, PG_FIELD_MIGRATE | PG_FIELD_RESTART, &touching));
  for (PetscInt i = 0; i <= DISCS; i++) offset[i] = i;
  for (PetscInt i = 0; i < 2 * DISCS; i++) record[i] = 0.5 + (PetscReal)i;
  Demand(!PgParticlesSetRagged(discs, touching, offset, record));
  state = MakeState(time, &step, name);
  Demand(!PgCheckpointWrite(discs, state, good));
  Demand(!PgStateDestroy(&state));
  stream = fopen(good, "rb");
  Demand(stream != NULL);
  length = fread(content, 1, sizeof content, stream);
  Demand(length > 32 && length < sizeof content && !fclose(stream));
  length -= 32; /* without its seal */
  return 0;
}

/* Four bytes each: which object, its type, its shape, its values. */
static void ReplaceObjects(const uint8_t *data, size_t size)
{
  static const char *const path[] = {"/fields/position",
                                     "/fields/spring",
                                     "/fields/radius",
                                     "/ragged/touching/count",
                                     "/ragged/touching/record",
                                     "/state/test_time",
                                     "/state/test_step",
                                     "/fields/new",
                                     "/fields",
                                     "/ragged/touching",
                                     "/state"};
  static const hsize_t     rows[] = {0, 1, 2, DISCS - 1, DISCS, DISCS + 1, 2 * DISCS, (hsize_t)1 << 40};
  hid_t                    file;

  FuzzWrite(bad, content, length);
  file = H5Fopen(bad, H5F_ACC_RDWR, H5P_DEFAULT);
  Demand(file >= 0);
  for (; size >= 4; data += 4, size -= 4) {
    const hid_t   type[]    = {H5T_NATIVE_DOUBLE, H5T_NATIVE_INT,   H5T_NATIVE_FLOAT,
                               H5T_C_S1,          H5T_NATIVE_UCHAR, H5T_STD_I64BE};
    const hsize_t extent[2] = {rows[data[2] & 7], (hsize_t)(data[2] >> 3 & 3)};
    const char   *name      = path[data[0] % (sizeof path / sizeof *path)];
    const hid_t   t         = type[data[1] % (sizeof type / sizeof *type)];
    const int     rank      = data[2] >> 5 & 3; /* 0 to 3, the third extent is none */
    const hsize_t all[3]    = {extent[0], extent[1], 1};
    hid_t         space, dataset;

    if (H5Lexists(file, name, H5P_DEFAULT) > 0) (void)H5Ldelete(file, name, H5P_DEFAULT);
    if (data[3] == 0) continue;
    space   = rank ? H5Screate_simple(rank, all, NULL) : H5Screate(H5S_SCALAR);
    dataset = H5Dcreate2(file, name, t, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    if (dataset >= 0 && data[3] > 1 && H5Sget_simple_extent_npoints(space) < 4096) {
      static union {
        double  real[4096];
        uint8_t byte[4096 * sizeof(double)];
      } values;
      for (size_t k = 0; k < sizeof values; k++) values.byte[k] = data[3];
      for (int k = 0; k < 4096 && data[3] < 8; k++) values.real[k] = data[3] == 2 ? (double)NAN : (double)data[3];
      (void)H5Dwrite(dataset, t, H5S_ALL, H5S_ALL, H5P_DEFAULT, &values);
    }
    if (dataset >= 0) (void)H5Dclose(dataset);
    (void)H5Sclose(space);
  }
  (void)H5Fclose(file);
}

static void CheckDiscs(void)
{
  const PgFieldInfo *info;
  const PetscInt    *offset;
  const PetscReal   *record;
  PetscReal         *value;
  PetscInt           fields;

  Demand(!PgParticlesGetFieldCount(discs, &fields));
  for (PgField f = 0; f < fields; f++) {
    Demand(!PgParticlesGetFieldInfo(discs, f, &info) && !PgParticlesGetArray(discs, f, &value));
    if (!(info->flags & PG_FIELD_RESTART)) continue;
    for (PetscInt i = 0; i < DISCS * info->components; i++) Demand(isfinite(value[i]));
  }
  Demand(!PgParticlesGetRagged(discs, touching, &offset, &record));
  for (PetscInt i = 0; i < DISCS; i++) Demand(offset[i] <= offset[i + 1]);
  for (PetscInt i = 0; i < 2 * offset[DISCS]; i++) Demand(isfinite(record[i]));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  PetscReal      time[2] = {0, 0};
  PetscInt       step    = 0;
  char           name[16];
  PgCheckpoint   checkpoint;
  PgState        state;
  PetscErrorCode err;
  const int      replace = size ? data[0] & 1 : 0;

  if (size) {
    data++;
    size--;
  }
  (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  if (replace) {
    ReplaceObjects(data, size);
    Demand(!PgCheckpointSeal(bad));
  } else {
    FuzzWrite(bad, data, size);
  }
  state = MakeState(time, &step, name);
  err   = PgCheckpointOpen(PETSC_COMM_SELF, bad, &checkpoint);
  if (!err) {
    err = PgCheckpointReadState(checkpoint, state);
    if (!err) err = PgCheckpointReadFields(checkpoint, discs);
    if (PgCheckpointClose(&checkpoint)) Demand(err != 0);
  }
  Demand(!PgStateDestroy(&state));
  if (!err) CheckDiscs();
  if (!err) Demand(isfinite(time[0]) && isfinite(time[1]) && memchr(name, 0, sizeof name));
  return 0;
}
