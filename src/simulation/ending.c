/* What ends a run before its time: signals, the limit of wall time, and a reader of our output who has gone. */
#include "simulationimpl.h"
#include <poll.h>
#include <signal.h>
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

enum { SIGNALS = 3 };
static const int        signals[SIGNALS] = {SIGUSR1, SIGINT, SIGTERM};
static struct sigaction before[SIGNALS];

PetscErrorCode PgEndingStart(PgSimulation sim)
{
  PetscFunctionBeginUser;
  came_checkpoint = came_interrupt = came_terminate = 0;
  for (int k = 0; k < SIGNALS; k++) {
    struct sigaction action;
    (void)memset(&action, 0, sizeof action);
    action.sa_handler = Remember;
    /* who presses Ctrl-C twice does not want to wait */
    action.sa_flags = SA_RESTART | (signals[k] == SIGINT ? (int)SA_RESETHAND : 0);
    (void)sigemptyset(&action.sa_mask);
    PetscCheck(!sigaction(signals[k], &action, &before[k]), PETSC_COMM_SELF, PETSC_ERR_SYS, "no handler for signal %d",
               signals[k]);
  }
  sim->look_every = 1;
  sim->next_look  = sim->step + 1;
  sim->last_look  = MPI_Wtime();
  PetscFunctionReturn(0);
}

PetscErrorCode PgEndingStop(PgSimulation sim)
{
  PetscFunctionBeginUser;
  (void)sim;
  for (int k = 0; k < SIGNALS; k++) (void)sigaction(signals[k], &before[k], NULL);
  PetscFunctionReturn(0);
}

/* Nobody reads standard output any more. */
static int PipeIsBroken(void)
{
  struct pollfd out = {.fd = STDOUT_FILENO, .events = POLLOUT};

  return poll(&out, 1, 0) > 0 && out.revents & POLLERR;
}

PetscErrorCode PgEndingLook(PgSimulation sim, int *ending)
{
  enum { WHAT, EVERY };
  const PetscLogDouble patience = 0.2; /* [s]: how long a signal may wait */
  PetscMPIInt          rank;
  int                  all[2] = {PG_ENDING_NONE, 0};

  PetscFunctionBeginUser;
  *ending = PG_ENDING_NONE;
  if (sim->step < sim->next_look) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Comm_rank(sim->comm, &rank));
  if (came_checkpoint) all[WHAT] |= PG_ENDING_CHECKPOINT;
  if (came_interrupt) all[WHAT] |= PG_ENDING_INTERRUPT;
  if (came_terminate) all[WHAT] |= PG_ENDING_TERMINATE;
  if (rank == 0) {
    const PetscLogDouble now = MPI_Wtime(), spent = now - sim->last_look;
    const PetscInt       most = PetscMin(sim->guard_every, 2 * sim->look_every);

    if (sim->wall_time > 0 && now - sim->created + 2 * sim->checkpoint_cost >= sim->wall_time)
      all[WHAT] |= PG_ENDING_WALL_TIME;
    if (PipeIsBroken()) all[WHAT] |= PG_ENDING_PIPE;
    all[EVERY] = (int)PetscMax(1, spent > 0 ? PetscMin((PetscReal)most, (PetscReal)sim->look_every * patience / spent)
                                            : most);
    sim->last_look = now;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, all, 2, MPI_INT, MPI_BOR, sim->comm)); /* only rank 0 says how often */
  sim->look_every = all[EVERY];
  sim->next_look  = sim->step + sim->look_every;
  if (all[WHAT] & PG_ENDING_CHECKPOINT) came_checkpoint = 0;
  *ending = all[WHAT];
  PetscFunctionReturn(0);
}

PetscErrorCode PgEndingTell(PgSimulation sim, int ending)
{
  const char *why  = ending & PG_ENDING_INTERRUPT   ? "signal INT"
                     : ending & PG_ENDING_TERMINATE ? "signal TERM"
                     : ending & PG_ENDING_WALL_TIME ? "option -wall_time"
                                                    : "nobody reads its output";
  const char *file = sim->checkpoint_file[0] ? sim->checkpoint_file : sim->restart_file;

  PetscFunctionBeginUser;
  PgSetExitStatus(PG_STATUS_ENDED_EARLY);
  if (ending & PG_ENDING_PIPE) PetscFunctionReturn(0);
  if (sim->checkpoint_step >= 0 && file[0])
    PetscCall(PetscPrintf(sim->comm,
                          "ended early at step %" PetscInt_FMT ", t = %.6e s (%s): go on with -restart %s, which holds "
                          "step %" PetscInt_FMT "\n",
                          sim->step * sim->fluid_every, (double)sim->time, why, file,
                          sim->checkpoint_step * sim->fluid_every));
  else
    PetscCall(PetscPrintf(sim->comm,
                          "ended early at step %" PetscInt_FMT ", t = %.6e s (%s): there is no checkpoint to go on "
                          "from (option -checkpoint)\n",
                          sim->step * sim->fluid_every, (double)sim->time, why));
  PetscFunctionReturn(0);
}
