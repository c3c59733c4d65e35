/* What ends a run before its time: signals, the limit of wall time, and a reader of our output who has gone. */
#include "baseimpl.h"
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>

/* Set by signal handlers, read by PgEndingLook(). */
static volatile sig_atomic_t came_checkpoint, came_interrupt, came_terminate;

static void Remember(int signal_number)
{
  if (signal_number == SIGUSR1)
    came_checkpoint = 1;
  else if (signal_number == SIGINT)
    came_interrupt = 1;
  else
    came_terminate = 1;
}

enum { CHECKPOINT, INTERRUPT, TERMINATE, SIGNALS };
static const int        signals[SIGNALS] = {SIGUSR1, SIGINT, SIGTERM};
static struct sigaction before[SIGNALS];

PetscErrorCode PgEndingSetFromOptions(PetscOptionItems *PetscOptionsObject, PgEndingWatch *watch)
{
  PetscFunctionBeginUser;
  PetscCall(PgOptionReal(PetscOptionsObject, "-wall_time",
                         "end after so much time of the clock, with a checkpoint where the case has them; 0: no limit",
                         "s", 0.0, 1e9, &watch->wall_time, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode Keep(int k)
{
  struct sigaction action;

  PetscFunctionBeginUser;
  (void)memset(&action, 0, sizeof action);
  action.sa_handler = Remember;
  /* who presses Ctrl-C twice does not want to wait */
  action.sa_flags = SA_RESTART | (signals[k] == SIGINT ? (int)SA_RESETHAND : 0);
  (void)sigemptyset(&action.sa_mask);
  PetscCheck(!sigaction(signals[k], &action, &before[k]), PETSC_COMM_SELF, PETSC_ERR_SYS, "no handler for signal %d",
             signals[k]);
  PetscFunctionReturn(0);
}

PetscErrorCode PgEndingExpect(void)
{
  PetscFunctionBeginUser;
  PetscCall(Keep(CHECKPOINT));
  PetscFunctionReturn(0);
}

PetscErrorCode PgEndingStart(PgEndingWatch *watch, MPI_Comm comm, PetscInt step)
{
  PetscFunctionBeginUser;
  came_interrupt = came_terminate = 0; /* a checkpoint may have been asked for while the run was set up */
  for (int k = 0; k < SIGNALS; k++) PetscCall(Keep(k));
  watch->comm  = comm;
  watch->every = 1;
  watch->next  = step + 1;
  watch->last  = MPI_Wtime();
  PetscFunctionReturn(0);
}

void PgEndingStop(void)
{
  for (int k = 0; k < SIGNALS; k++) (void)sigaction(signals[k], &before[k], NULL);
  came_checkpoint = 0;
}

/* Nobody reads standard output any more. */
static PetscBool PipeIsBroken(void)
{
  struct pollfd out = {.fd = STDOUT_FILENO, .events = POLLOUT};

  return (PetscBool)(poll(&out, 1, 0) > 0 && out.revents & POLLERR);
}

PetscErrorCode PgEndingLook(PgEndingWatch *watch, PetscInt step, int *ending)
{
  enum { WHAT, EVERY };
  const PetscLogDouble patience = 0.2; /* [s]: how long a signal may wait */
  PetscMPIInt          rank;
  int                  all[2] = {PG_ENDING_NONE, 0};

  PetscFunctionBeginUser;
  *ending = PG_ENDING_NONE;
  if (step < watch->next) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Comm_rank(watch->comm, &rank));
  if (came_checkpoint) all[WHAT] |= PG_ENDING_CHECKPOINT;
  if (came_interrupt) all[WHAT] |= PG_ENDING_INTERRUPT;
  if (came_terminate) all[WHAT] |= PG_ENDING_TERMINATE;
  if (rank == 0) {
    const PetscLogDouble now = MPI_Wtime(), spent = now - watch->last;
    const PetscInt       most = PetscMin(watch->most, 2 * watch->every);

    /* there may be no other look before as much time has passed again */
    if (watch->wall_time > 0 && now - watch->created + spent + 2 * watch->cost >= watch->wall_time)
      all[WHAT] |= PG_ENDING_WALL_TIME;
    if (PipeIsBroken()) all[WHAT] |= PG_ENDING_PIPE;
    all[EVERY]  = (int)PetscMax(1, spent > 0 ? PetscMin((PetscReal)most, (PetscReal)watch->every * patience / spent)
                                             : most);
    watch->last = now;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, all, 2, MPI_INT, MPI_BOR, watch->comm)); /* only rank 0 says how often */
  watch->every = all[EVERY];
  watch->next  = step + watch->every;
  if (all[WHAT] & PG_ENDING_CHECKPOINT) came_checkpoint = 0;
  *ending = all[WHAT];
  PetscFunctionReturn(0);
}

PetscErrorCode PgEndingTell(MPI_Comm comm, int ending, PetscInt step, PetscReal time, const char file[], PetscInt held)
{
  const char *why = ending & PG_ENDING_INTERRUPT   ? "signal INT"
                    : ending & PG_ENDING_TERMINATE ? "signal TERM"
                    : ending & PG_ENDING_WALL_TIME ? "option -wall_time"
                                                   : "nobody reads its output";
  char        how[PETSC_MAX_PATH_LEN + 64];

  PetscFunctionBeginUser;
  PgSetExitStatus(PG_STATUS_ENDED_EARLY);
  if (ending & PG_ENDING_PIPE) PetscFunctionReturn(0);
  if (!file)
    (void)snprintf(how, sizeof how, "this case has no checkpoints to go on from");
  else if (file[0] && held >= 0)
    (void)snprintf(how, sizeof how, "go on with -restart %s, which holds step %" PetscInt_FMT, file, held);
  else
    (void)snprintf(how, sizeof how, "there is no checkpoint to go on from (option -checkpoint)");
  PetscCall(
      PetscPrintf(comm, "ended early at step %" PetscInt_FMT ", t = %.6e s (%s): %s\n", step, (double)time, why, how));
  PetscFunctionReturn(0);
}
