/* Spoils one thing in an HDF5 file, which a test then hands to a program:

     damage FILE remove PATH            the object is gone
     damage FILE rows PATH N            N rows of zeros where there were others (2^40 are never written)
     damage FILE flat PATH              one column less than it should have: the values in one dimension
     damage FILE type PATH int|float|text
     damage FILE value PATH K X         number K, counted over all columns, becomes X (nan and inf too)
     damage FILE group PATH             a group of that name
     damage FILE attribute NAME N       an integer attribute of the root
     damage FILE seal                   a good seal, as a checkpoint has it, over what is there now */
#include <hdf5.h>
#include <porograin/io.h>
#include <stdlib.h>
#include <string.h>

static void Demand(int condition, const char what[])
{
  if (condition) return;
  (void)fprintf(stderr, "damage: cannot %s\n", what);
  exit(1);
}

static void Replace(hid_t file, const char path[], hid_t type, int rank, const hsize_t size[])
{
  const hid_t space = H5Screate_simple(rank, size, NULL);
  hid_t       dataset;

  Demand(H5Ldelete(file, path, H5P_DEFAULT) >= 0, path);
  dataset = H5Dcreate2(file, path, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  Demand(dataset >= 0, path);
  (void)H5Dclose(dataset);
  (void)H5Sclose(space);
}

static int Shape(hid_t file, const char path[], hsize_t size[2])
{
  const hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT), space = H5Dget_space(dataset);
  const int   rank = H5Sget_simple_extent_dims(space, size, NULL);

  Demand(rank == 1 || rank == 2, path);
  if (rank == 1) size[1] = 1;
  (void)H5Sclose(space);
  (void)H5Dclose(dataset);
  return rank;
}

static void Set(hid_t file, const char path[], size_t at, double x)
{
  const hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT);
  hsize_t     size[2];
  double     *value;

  (void)Shape(file, path, size);
  Demand(at < size[0] * size[1], path);
  value = calloc((size_t)(size[0] * size[1]), sizeof *value);
  Demand(value && H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0, path);
  value[at] = x;
  Demand(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0, path);
  free(value);
  (void)H5Dclose(dataset);
}

static void Attribute(hid_t file, const char name[], int x)
{
  const hid_t space = H5Screate(H5S_SCALAR);
  hid_t       attribute;

  if (H5Aexists(file, name) > 0) Demand(H5Adelete(file, name) >= 0, name);
  attribute = H5Acreate2(file, name, H5T_NATIVE_INT, space, H5P_DEFAULT, H5P_DEFAULT);
  Demand(attribute >= 0 && H5Awrite(attribute, H5T_NATIVE_INT, &x) >= 0, name);
  (void)H5Aclose(attribute);
  (void)H5Sclose(space);
}

static void Act(hid_t file, int count, char *word[])
{
  const char *act = word[0], *path = word[1], *more = count > 2 ? word[2] : "";
  hsize_t     size[2] = {0, 0};

  if (!strcmp(act, "remove")) {
    Demand(H5Ldelete(file, path, H5P_DEFAULT) >= 0, path);
  } else if (!strcmp(act, "group")) {
    hid_t group;

    (void)H5Ldelete(file, path, H5P_DEFAULT);
    group = H5Gcreate2(file, path, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    Demand(group >= 0 && H5Gclose(group) >= 0, path);
  } else if (!strcmp(act, "attribute")) {
    Attribute(file, path, atoi(more));
  } else if (!strcmp(act, "value")) {
    Demand(count > 3, "set a value without one");
    Set(file, path, (size_t)atol(more), strtod(word[3], NULL));
  } else if (!strcmp(act, "rows")) {
    const int rank = Shape(file, path, size);
    size[0]        = (hsize_t)atoll(more);
    Replace(file, path, H5T_NATIVE_DOUBLE, rank, size);
  } else if (!strcmp(act, "flat")) {
    (void)Shape(file, path, size);
    size[0] *= size[1];
    Replace(file, path, H5T_NATIVE_DOUBLE, 1, size);
  } else if (!strcmp(act, "type")) {
    const int rank = Shape(file, path, size);
    Replace(file, path,
            !strcmp(more, "int")     ? H5T_NATIVE_INT
            : !strcmp(more, "float") ? H5T_NATIVE_FLOAT
                                     : H5T_C_S1,
            rank, size);
  } else {
    Demand(0, act);
  }
}

int main(int argc, char *argv[])
{
  char name[] = "damage", *list[] = {name, NULL}, **arguments = list;
  int  count = 1;

  Demand(argc >= 3, "do anything without FILE and what to do");
  if (PgInitialize(&count, &arguments, NULL)) return 1;
  if (!strcmp(argv[2], "seal")) {
    Demand(!PgCheckpointSeal(argv[1]), "seal");
  } else {
    const hid_t file = H5Fopen(argv[1], H5F_ACC_RDWR, H5P_DEFAULT);

    Demand(file >= 0 && argc >= 4, "open the file");
    Act(file, argc - 2, argv + 2);
    Demand(H5Fclose(file) >= 0, "close the file");
  }
  return PgFinalize(0);
}
