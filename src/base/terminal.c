/* One line at the bottom of a terminal that is written over and over, while all other output goes on above it. */
#include "baseimpl.h"
#include <stdlib.h>
#include <sys/ioctl.h>
#include <unistd.h>

static PetscBool launched = PETSC_FALSE; /* by mpiexec or its like, which stands between us and the terminal */
static PetscBool shown    = PETSC_FALSE; /* our line stands there, the cursor behind it */
static PetscBool open_end = PETSC_FALSE; /* the last line of the other output is not finished */
static PetscErrorCode (*print_before)(FILE *, const char[], va_list) = NULL;

/* To be called before MPI_Init(), which may set some of these itself. */
void PgTerminalLookAround(void)
{
  static const char *const marks[] = {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK", "PMI_SIZE", "MPI_LOCALNRANKS"};

  for (size_t i = 0; i < sizeof marks / sizeof *marks; i++)
    if (getenv(marks[i])) launched = PETSC_TRUE;
}

PetscBool PgTerminalIsWatched(void)
{
  const char *const kind = getenv("TERM");

  /* Open MPI gives its processes a terminal of their own, wherever the output goes in the end */
  return (PetscBool)(!launched && isatty(STDOUT_FILENO) && kind && strcmp(kind, "dumb") != 0);
}

int PgTerminalWidth(void)
{
  struct winsize size;

  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

void PgTerminalClear(void)
{
  if (!shown) return;
  shown = PETSC_FALSE;
  (void)fputs("\r\033[K", stdout);
  (void)fflush(stdout);
}

/* In the place of PetscVFPrintf, through which everything goes that PETSc and we print. */
static PetscErrorCode PrintAbove(FILE *file, const char format[], va_list arguments)
{
  const size_t n = strlen(format);

  PgTerminalClear();
  if (n > 0 && (file == stdout || file == stderr)) open_end = (PetscBool)(format[n - 1] != '\n');
  return (*print_before)(file, format, arguments);
}

void PgTerminalShow(const char text[])
{
  if (!print_before) {
    print_before  = PetscVFPrintf;
    PetscVFPrintf = PrintAbove;
  }
  if (open_end) return;
  (void)fprintf(stdout, "\r%s\033[K", text);
  (void)fflush(stdout);
  shown = PETSC_TRUE;
}

void PgTerminalEnd(void)
{
  PgTerminalClear();
  if (print_before) PetscVFPrintf = print_before;
  print_before = NULL;
  open_end     = PETSC_FALSE;
}
