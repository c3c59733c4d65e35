/* How HDF5 gets at a file: a driver that never fails to write.

   HDF5 does not survive a disk that fails it. A file that H5Fclose() could not write out stays in the library's
   tables after its memory has been freed, and the library closes it once more when the program ends, inside of
   MPI_Finalize(): a segmentation fault after a run that has said what was wrong. And in a parallel file a failure of
   one rank leaves the others waiting. So one rank writes, through this driver: it remembers the first failure, for
   PgHdf to tell, and writes nothing from then on, while HDF5 believes that all is well and closes the file in peace.

   What cannot be read cannot be made up. HDF5 frees some of its memory twice then, and may crash at any later call:
   the file is left open in its tables, see PgDiskAbandon(). */
#include "ioimpl.h"
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>
#if H5_VERSION_GE(1, 13, 2)
  #include <H5FDdevelop.h>
#endif

typedef struct {
  H5FD_t  head; /* first: HDF5 knows a file by this part */
  PgDisk *disk; /* not owned */
  int     descriptor;
  hbool_t writes;
  haddr_t allocated, end;
} File;

/* Of files that HDF5 shall forget. */
static PgDisk abandoned = {.error = EIO, .descriptor = -1};

/* What is handed from PgDiskAccess() to Open(). */
typedef struct {
  PgDisk *disk;
} Info;

static void Remember(PgDisk *disk)
{
  if (!disk->error) disk->error = errno ? errno : EIO;
}

static H5FD_t *Open(const char *name, unsigned flags, hid_t access, haddr_t limit)
{
  const Info *info = H5Pget_driver_info(access);
  int         how  = O_CLOEXEC | (flags & H5F_ACC_RDWR ? O_RDWR : O_RDONLY);
  struct stat found;
  File       *file;

  (void)limit;
  if (flags & H5F_ACC_TRUNC) how |= O_TRUNC;
  if (flags & H5F_ACC_CREAT) how |= O_CREAT;
  if (flags & H5F_ACC_EXCL) how |= O_EXCL;
  file = calloc(1, sizeof *file);
  if (!file) return NULL;
  file->disk       = info->disk;
  file->writes     = (flags & H5F_ACC_RDWR) != 0;
  file->descriptor = open(name, how, 0666);
  if (file->descriptor < 0 || fstat(file->descriptor, &found)) {
    Remember(file->disk);
    if (file->descriptor >= 0) (void)close(file->descriptor);
    free(file);
    return NULL;
  }
  file->end              = (haddr_t)found.st_size;
  file->disk->descriptor = file->descriptor;
  file->disk->file       = file;
  return &file->head;
}

static void CloseDescriptor(File *file)
{
  /* a file system across a network may say only now that it could not write */
  if (file->descriptor >= 0 && close(file->descriptor) && file->writes) Remember(file->disk);
  file->descriptor       = -1;
  file->disk->descriptor = -1;
  file->disk->file       = NULL;
}

static herr_t Close(H5FD_t *head)
{
  CloseDescriptor((File *)head);
  free(head);
  return 0;
}

static herr_t Query(const H5FD_t *head, unsigned long *flags)
{
  (void)head;
  if (flags)
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
             H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

static haddr_t GetAllocated(const H5FD_t *head, H5FD_mem_t kind)
{
  (void)kind;
  return ((const File *)head)->allocated;
}

static herr_t SetAllocated(H5FD_t *head, H5FD_mem_t kind, haddr_t address)
{
  (void)kind;
  ((File *)head)->allocated = address;
  return 0;
}

static haddr_t GetEnd(const H5FD_t *head, H5FD_mem_t kind)
{
  (void)kind;
  return ((const File *)head)->end;
}

/* Beyond the end of the file there are zeros. */
static herr_t Read(H5FD_t *head, H5FD_mem_t kind, hid_t transfer, haddr_t address, size_t size, void *buffer)
{
  File          *file = (File *)head;
  unsigned char *to   = buffer;

  (void)kind;
  (void)transfer;
  while (size > 0) {
    const ssize_t got = pread(file->descriptor, to, size, (off_t)address);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      Remember(file->disk);
      file->disk->unread = PETSC_TRUE;
      return -1;
    }
    if (got == 0) {
      (void)memset(to, 0, size);
      break;
    }
    to += got;
    address += (haddr_t)got;
    size -= (size_t)got;
  }
  return 0;
}

static herr_t Write(H5FD_t *head, H5FD_mem_t kind, hid_t transfer, haddr_t address, size_t size, const void *buffer)
{
  File *file = (File *)head;

  (void)kind;
  (void)transfer;
  if (!file->disk->error && PgWriteAll(file->descriptor, buffer, size, (off_t)address)) Remember(file->disk);
  file->end = PetscMax(file->end, address + size);
  return 0;
}

/* The size becomes what HDF5 has handed out: room that was asked for and not needed is given back. */
static herr_t Truncate(H5FD_t *head, hid_t transfer, hbool_t closing)
{
  File *file = (File *)head;

  (void)transfer;
  (void)closing;
  if (file->end == file->allocated) return 0;
  if (!file->disk->error && ftruncate(file->descriptor, (off_t)file->allocated)) Remember(file->disk);
  file->end = file->allocated;
  return 0;
}

static const H5FD_class_t driver = {
#if H5_VERSION_GE(1, 13, 2)
    .version = H5FD_CLASS_VERSION,
    .value   = (H5FD_class_value_t)420, /* from the range for drivers that are not registered */
#endif
    .name      = "porograin",
    .maxaddr   = ((haddr_t)1 << (8 * sizeof(off_t) - 1)) - 1,
    .fc_degree = H5F_CLOSE_STRONG,
    .fapl_size = sizeof(Info),
    .open      = Open,
    .close     = Close,
    .query     = Query,
    .get_eoa   = GetAllocated,
    .set_eoa   = SetAllocated,
    .get_eof   = GetEnd,
    .read      = Read,
    .write     = Write,
    .truncate  = Truncate,
    .fl_map    = H5FD_FLMAP_DICHOTOMY,
};

hid_t PgDiskAccess(PgDisk *disk)
{
  static hid_t id     = H5I_INVALID_HID;
  const Info   info   = {disk};
  const hid_t  access = H5Pcreate(H5P_FILE_ACCESS);

  *disk = (PgDisk){.descriptor = -1};
  if (access < 0) return access;
  if (H5Iget_type(id) != H5I_VFL) id = H5FDregister(&driver);
  /* After a failure objects may still be open: closing the file closes them too. */
  if (id >= 0 && H5Pset_driver(access, id, &info) >= 0 && H5Pset_fclose_degree(access, H5F_CLOSE_STRONG) >= 0)
    return access;
  (void)H5Pclose(access);
  return H5I_INVALID_HID;
}

void PgDiskSync(PgDisk *disk)
{
  if (!disk->error && fsync(disk->descriptor)) Remember(disk);
}

void PgDiskAbandon(PgDisk *disk)
{
  File *file = disk->file;

  if (!file) return;
  CloseDescriptor(file);
  file->disk = &abandoned;
}
