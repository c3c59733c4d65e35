/* base: what every room needs and nothing about particles or physics: option reading with bounds and
   known names, errors a user can read, one log stage per phase of the step, and a debug assertion. */
#pragma once

#include <petscviewer.h>

#define PG_VERSION "0.1.0"

/* Debian builds PETSc without debugging, so PetscAssert() does nothing there: an assertion of our own,
   switched by our build type. */
#if defined(PG_DEBUG)
  #define PgAssert(cond, ...)                                                                                          \
    do {                                                                                                               \
      if (PetscUnlikely(!(cond))) SETERRQ(PETSC_COMM_SELF, PETSC_ERR_PLIB, __VA_ARGS__);                               \
    } while (0)
#else
  #define PgAssert(cond, ...)                                                                                          \
    do {                                                                                                               \
    } while (0)
#endif

/* Before a function whose loops gcc turns into vector instructions: compiles it for wider ones too, and the machine
   picks. The operations and their order are the same (no fused multiply-add, no reassociation), so are the bits. */
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) &&                       \
    !defined(__SANITIZE_ADDRESS__)
  #define PG_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
  #define PG_CLONES
#endif

/* Two numbers side by side, in one instruction where the machine has it. */
typedef PetscReal     PgReal2 __attribute__((vector_size(2 * sizeof(PetscReal))));
static inline PgReal2 PgTwo(const PetscReal v[], PetscInt i) { return (PgReal2){v[2 * i], v[2 * i + 1]}; }

/* Bad input, found by every rank of comm alike (collective): one message, from rank 0, then an error
   return on all ranks. */
#define PgInputError(comm, ...)                                                                                        \
  do {                                                                                                                 \
    PetscCall(PgReport((comm), __VA_ARGS__));                                                                          \
    return PETSC_ERR_USER_INPUT;                                                                                       \
  } while (0)
#define PgInputCheck(cond, comm, ...)                                                                                  \
  do {                                                                                                                 \
    if (PetscUnlikely(!(cond))) PgInputError((comm), __VA_ARGS__);                                                     \
  } while (0)

/* A run that cannot go on, found by every rank of comm alike (collective). */
#define PgRunError(comm, ...)                                                                                          \
  do {                                                                                                                 \
    PetscCall(PgReportRun((comm), __VA_ARGS__));                                                                       \
    return PETSC_ERR_NOT_CONVERGED;                                                                                    \
  } while (0)

/* Prints "porograin: error: ..." on standard error from rank 0 of comm. Collective. */
PETSC_EXTERN PetscErrorCode PgReport(MPI_Comm comm, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
/* The same, with the cause in front when PgSetCause() has named somebody who finds one. Collective. */
PETSC_EXTERN PetscErrorCode PgReportRun(MPI_Comm comm, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
/* Whom to ask, before a failure of the run is reported, whether something else is behind it: what is noticed first is
   often only the consequence. find() writes the cause, or leaves `cause` empty; it is collective and must not fail with
   PgRunError() itself. NULL: nobody. */
PETSC_EXTERN PetscErrorCode PgSetCause(PetscErrorCode (*find)(void *context, char cause[], size_t size), void *context);
/* The step that is being done and the time at its end [s], for failures of what does not know it; step < 0: none. The same
   on all ranks. */
PETSC_EXTERN void PgSetNow(PetscInt step, PetscReal time);

/* Starts MPI (unless the caller did) and PETSc with porograin's error handler (one readable message instead of a call
   stack; the stack comes back with -error_stack) and its log stages. Files of options are looked at first: a missing
   or malformed one is an error of all ranks, to be handed to PgFinalize(). -help and -version are taken out of the
   arguments for PgHelp(); `about` heads PETSc's own help. Collective on all. */
PETSC_EXTERN PetscErrorCode PgInitialize(int *argc, char ***argv, const char about[]);
/* Refuses an argument that belongs to no option, which PETSc would pass over in silence. Collective. */
PETSC_EXTERN PetscErrorCode PgRefuseStrayArguments(int argc, char *argv[]);
/* Why `file` cannot be read, seen before it is opened (a pipe would wait for ever), NULL: nothing speaks against it; its
   size in bytes, which may be NULL. The answer lasts until the next call of strerror(). Not collective. */
PETSC_EXTERN const char *PgWhyNotFile(const char file[], PetscInt64 *size);
/* Where `name`, a file that comes with the program ("options/solvers/all.txt"), is: there, seen from the present
   folder, or else beside the program as it was installed or built. `name` itself when it is nowhere. Collective. */
PETSC_EXTERN PetscErrorCode PgShippedFile(MPI_Comm comm, const char name[], char file[], size_t size);
/* Ends PETSc, when it was started, and returns the exit status that belongs to `err`: 0 done, 2 bad input, 3 failed run,
   4 file trouble, 1 anything else. An error that only some ranks saw ends the others by MPI_Abort(). */
PETSC_EXTERN int PgFinalize(PetscErrorCode err);
/* Exit status of a run that ends without an error, but not as asked; default 0. */
PETSC_EXTERN void PgSetExitStatus(int status);
enum { PG_STATUS_ENDED_EARLY = 5 };
/* Whether an error has been reported by all ranks together, so that collective calls still make sense. */
PETSC_EXTERN PetscBool PgErrorIsCollective(void);

/* ---- options ---- */

/* Each reads one option inside a PetscOptionsBegin() block, like PetscOptionsReal() and its kin, and
   besides (1) refuses a value outside [lower, upper] or not finite with a message that names option,
   value, unit and bound, and (2) remembers the name for PgOptionsCheckUnused(). *value holds the
   default on entry, which may lie outside the bounds ("of the run"). Collective on the communicator of the block. */
PETSC_EXTERN PetscErrorCode PgOptionReal(PetscOptionItems *PetscOptionsObject, const char name[], const char text[],
                                         const char unit[], PetscReal lower, PetscReal upper, PetscReal *value,
                                         PetscBool *set);
PETSC_EXTERN PetscErrorCode PgOptionInt(PetscOptionItems *PetscOptionsObject, const char name[], const char text[],
                                        PetscInt lower, PetscInt upper, PetscInt *value, PetscBool *set);
PETSC_EXTERN PetscErrorCode PgOptionBool(PetscOptionItems *PetscOptionsObject, const char name[], const char text[],
                                         PetscBool *value, PetscBool *set);
/* Exactly `n` finite reals separated by commas. */
PETSC_EXTERN PetscErrorCode PgOptionReals(PetscOptionItems *PetscOptionsObject, const char name[], const char text[],
                                          const char unit[], PetscInt n, PetscReal value[], PetscBool *set);
/* One of `n` words; *value is its index. */
PETSC_EXTERN PetscErrorCode PgOptionChoice(PetscOptionItems *PetscOptionsObject, const char name[], const char text[],
                                           PetscInt n, const char *const words[], PetscInt *value, PetscBool *set);
PETSC_EXTERN PetscErrorCode PgOptionString(PetscOptionItems *PetscOptionsObject, const char name[], const char text[],
                                           char value[], size_t length, PetscBool *set);
/* Smallest number that counts as positive: the lower bound of quantities that must be > 0. */
#define PG_POSITIVE PETSC_MACHINE_EPSILON *PETSC_MACHINE_EPSILON

/* An option that has an effect only in company. */
typedef struct {
  const char *option; /* a name that ends in '*' stands for all that begin so */
  /* "-pressure explicit", "-fluid darcy|ns"; "-pressure_pc_lag !0|1": any other value; "-output": any value; "no -output";
     "walls": a fact; alternatives are separated by " or " */
  const char *needs;
  const char *reason; /* "only a drained side has a pressure" */
} PgOptionRule;
typedef struct {
  PetscInt            count;
  const PgOptionRule *rule;
  PetscBool (*fact)(void *context, const char name[]); /* what is true of the run beside its options */
  void *context;
} PgOptionRules;

/* Ends in an error when an option has no effect by the rules (NULL: none), or is read by nobody as in
   PgOptionsCheckUnused(). One that stands in a file (or PETSC_OPTIONS), and was overruled by what stands in a later
   file or on the command line, does not end the run: all of those are named in one line of warning. Collective. */
PETSC_EXTERN PetscErrorCode PgOptionsCheck(MPI_Comm comm, const PgOptionRules *rules, PetscErrorCode (*probe)(void *),
                                           void *context);
/* Two options that exclude each other: when both are given in the same place ends in an error; else the later one wins,
   and *loser is the name of the other, which the caller must not use; "" when there is no conflict. The next
   PgOptionsCheck() warns of it. Collective. */
PETSC_EXTERN PetscErrorCode PgOptionsOneOf(MPI_Comm comm, const char one[], const char other[], const char **loser);

/* Who has set an option that was not given as it stands: PgOptionsCheck() leaves alone what a program sets in the place of
   the user, and takes what a case brings along for chosen with -case. */
typedef enum { PG_OPTION_USER, PG_OPTION_CASE, PG_OPTION_PROGRAM } PgOptionBase;
PETSC_EXTERN PetscErrorCode PgOptionsSetBy(const char name[], PgOptionBase by);

/* Ends in an error when the command line, an options file or PETSC_OPTIONS holds an option that nobody
   asked for, naming each with the nearest known name. `probe` (may be NULL) is called to make PETSc
   objects print their -help into a collector, so that their names are known too. To be called when all
   objects are set up, before anything is written. Collective. */
PETSC_EXTERN PetscErrorCode PgOptionsCheckUnused(MPI_Comm comm, PetscErrorCode (*probe)(void *), void *context);
/* For an option that makes a program do something else than its work: ends in one error when the command line holds
   options that nobody has read so far. Those of files are let pass. Collective. */
PETSC_EXTERN PetscErrorCode PgOptionsCheckAlone(MPI_Comm comm, const char name[]);
/* What is read from here on is read only by runs that are given `needs` ("-fluid darcy"), for messages and help; NULL
   ends that. */
PETSC_EXTERN PetscErrorCode PgOptionsBelongTo(const char needs[]);
/* Enters an option that others read into help and messages; a name that ends in '*' stands for all that begin so. */
PETSC_EXTERN PetscErrorCode PgOptionsMention(const char section[], const char name[], const char initial[],
                                             const char allowed[], const char text[]);
/* Calls act(context) with an empty set of options, so that objects made there have their defaults and only tell the
   names of their options. Collective. */
PETSC_EXTERN PetscErrorCode PgOptionsApart(PetscErrorCode (*act)(void *), void *context);
/* Calls act(context), in which objects of PETSc read options with this prefix (without '-'). When PETSc refuses one,
   ends in PETSC_ERR_USER_INPUT with a message that names option, value and what is allowed; other errors go their
   usual way. probe(context) makes such objects anew, perhaps many times, and forgets them. Collective. */
PETSC_EXTERN PetscErrorCode PgOptionsRead(MPI_Comm comm, const char prefix[], PetscErrorCode (*act)(void *),
                                          PetscErrorCode (*probe)(void *), void *context);

/* ---- help ---- */

typedef struct {
  const char *name, *purpose;
  const char *examples;                /* lines */
  const char *often;                   /* the options that the short help shows, separated by blanks */
  const char *own;                     /* the section of the options that no other program has; NULL: all */
  PetscErrorCode (*collect)(MPI_Comm); /* makes everything that reads options, by PgOptionsApart() */
} PgProgram;
/* Prints what -help [TOPIC] or -version ask for; *done: that was all there is to do. Collective. */
PETSC_EXTERN PetscErrorCode PgHelp(MPI_Comm comm, const PgProgram *program, PetscBool *done);

/* ---- a line of the terminal that is written over ---- */

/* Whether somebody watches standard output: it is a terminal that can move its cursor, and no mpiexec or the like
   stands before it. */
PETSC_EXTERN PetscBool PgTerminalIsWatched(void);
/* Columns of the terminal; 80 when there is none. */
PETSC_EXTERN int PgTerminalWidth(void);
/* Shows `text` (one line, no wider than the terminal) in the place of the text before, until something else is printed
   through PETSc or PgReport(), which takes its place. For rank 0. */
PETSC_EXTERN void PgTerminalShow(const char text[]);
PETSC_EXTERN void PgTerminalClear(void);
/* Takes the line away for good; PgFinalize() does it too. */
PETSC_EXTERN void PgTerminalEnd(void);

/* ---- how far a run is, and what it has cost ---- */

typedef enum { PG_PROGRESS_AUTO, PG_PROGRESS_BAR, PG_PROGRESS_LINES, PG_PROGRESS_NONE } PgProgress;

typedef struct {
  MPI_Comm       comm;
  PetscMPIInt    rank;
  PgProgress     progress;       /* the same on all ranks; never AUTO once options have been read */
  PetscInt       first, last;    /* step from which this program goes on, and that at the end of the run */
  PetscLogDouble started, shown; /* the clock at the start, and when the bar was last drawn [s] */
} PgMeter;
/* Reads -progress and, unless `every` is NULL, -progress_every into it [s]. Collective. */
PETSC_EXTERN PetscErrorCode PgMeterSetFromOptions(MPI_Comm comm, PetscOptionItems *PetscOptionsObject, PgMeter *meter,
                                                  PetscReal *every);
/* The clock of the run starts here. */
PETSC_EXTERN PetscErrorCode PgMeterStart(PgMeter *meter, MPI_Comm comm, PetscInt first, PetscInt last);
/* Whether the bar is to be drawn after this step: on rank 0 alone, of a run that has a bar, and not too often. */
PETSC_EXTERN PetscBool PgMeterBarDue(const PgMeter *meter, PetscInt step);
/* Draws it: simulated time and its end [s], `more` (which may be empty), and the time that is left by the clock. */
PETSC_EXTERN void PgMeterBar(PgMeter *meter, PetscInt step, PetscReal time, PetscReal end, const char more[]);
/* For the summary: the time since the start for so many steps of `count` things, of which one is called `one`, and the
   part of it that each log stage has taken on rank 0. Collective. */
PETSC_EXTERN PetscErrorCode PgMeterTimes(const PgMeter *meter, PetscInt steps, PetscInt count, const char one[]);

/* Solves of a run, and their iterations in all and at most. Start with zeros. */
typedef struct {
  PetscInt   solves, most;
  PetscInt64 iterations;
} PgSolves;
PETSC_EXTERN void PgSolvesAdd(PgSolves *work, PetscInt iterations);
/* For the summary: "5 pressure solves, 60 iterations, ...", with `more` (which may be empty) behind it. Collective. */
PETSC_EXTERN PetscErrorCode PgMeterSolves(MPI_Comm comm, const PgSolves *work, const char what[], const char unit[],
                                          const char more[]);

/* ---- what ends a run before its time ---- */

typedef enum {
  PG_ENDING_NONE       = 0,
  PG_ENDING_CHECKPOINT = 1, /* write a checkpoint and go on */
  PG_ENDING_INTERRUPT  = 2, /* end */
  PG_ENDING_TERMINATE  = 4, /* write a checkpoint and end */
  PG_ENDING_WALL_TIME  = 8, /* the same */
  PG_ENDING_PIPE       = 16 /* the same, without words */
} PgEnding;
/* Those that end the run, and those that ask for a checkpoint. */
#define PG_ENDING_ENDS  (PG_ENDING_INTERRUPT | PG_ENDING_TERMINATE | PG_ENDING_WALL_TIME | PG_ENDING_PIPE)
#define PG_ENDING_SAVES (PG_ENDING_CHECKPOINT | PG_ENDING_TERMINATE | PG_ENDING_WALL_TIME | PG_ENDING_PIPE)

typedef struct {
  MPI_Comm       comm;
  PetscReal      wall_time; /* limit [s], 0: none */
  PetscLogDouble created;   /* the clock when the run began [s] */
  PetscLogDouble cost;      /* of a checkpoint [s of wall time] */
  PetscInt       most;      /* steps between two looks at most */
  PetscInt       next, every;
  PetscLogDouble last; /* the clock at the last look [s] */
} PgEndingWatch;
/* Reads -wall_time. Collective. */
PETSC_EXTERN PetscErrorCode PgEndingSetFromOptions(PetscOptionItems *PetscOptionsObject, PgEndingWatch *watch);
/* A program that is going to run something calls this first: USR1, which asks for a checkpoint, is kept for the run from here
   on and does not end a program that is setting it up. */
PETSC_EXTERN PetscErrorCode PgEndingExpect(void);
/* From here to PgEndingStop() the signals TERM, INT and USR1 are kept for PgEndingLook(). `created` and `most` are set. */
PETSC_EXTERN PetscErrorCode PgEndingStart(PgEndingWatch *watch, MPI_Comm comm, PetscInt step);
/* What has come up since the last time, as a sum of PgEnding; the same on all ranks. After each step. Collective. */
PETSC_EXTERN PetscErrorCode PgEndingLook(PgEndingWatch *watch, PetscInt step, int *ending);
PETSC_EXTERN void           PgEndingStop(void);
/* One line on how to go on after `step` at `time` [s], and the exit status of an early end. `file` is the last checkpoint,
   which holds step `held` (< 0: none has been written); NULL: the case has none. Collective. */
PETSC_EXTERN PetscErrorCode PgEndingTell(MPI_Comm comm, int ending, PetscInt step, PetscReal time, const char file[],
                                         PetscInt held);

/* ---- one record among those of all ranks ---- */

/* The rank with the largest value, of equal ones with the smallest ids (first, then second), for a message that is the
   same on any number of ranks. A rank without a record gives first < 0; *holder < 0: no rank has one. Collective. */
PETSC_EXTERN PetscErrorCode PgFindHolder(MPI_Comm comm, PetscReal value, PetscInt first, PetscInt second,
                                         PetscMPIInt *holder);

/* ---- sums over all discs ---- */

/* A sum that is exact, hence the same for any order of the terms and any number of ranks; up to 2^30
   terms. Start with {.not_finite = 0}. A term that is not finite makes the sum NaN. */
typedef struct {
  long long word[69], not_finite;
} PgExactSum;
PETSC_EXTERN void PgExactSumAdd(PgExactSum *sum, PetscReal x);
/* Adds up `count` sums over the ranks of comm (they are used up) and rounds them to value. Collective. */
PETSC_EXTERN PetscErrorCode PgExactSumReduce(MPI_Comm comm, PetscInt count, PgExactSum sum[], PetscReal value[]);

/* ---- numbers by chance ---- */

/* Uniform in [-1, 1]: a function of the arguments alone, hence the same for any number of ranks. */
PETSC_EXTERN PetscReal PgNoise(PetscInt id, PetscInt component);

/* ---- state: what a run must remember beside the fields of its discs ---- */

/* A list of named values, the same on all ranks, each at an address where it is read when the state is saved
   and written when it is restored. Rooms add theirs; who saves and restores does not know what they mean. */
typedef struct PgState_s *PgState;
typedef enum { PG_STATE_REALS, PG_STATE_INTS, PG_STATE_TEXT } PgStateKind;
typedef enum {
  PG_STATE_KEEP, /* restored */
  PG_STATE_MATCH /* must have the value that is restored: a setting that the run cannot change on its way */
} PgStateRule;
typedef struct {
  const char *name;    /* of the dataset, with the room in front: "simulation_time" */
  const char *meaning; /* MATCH: what the user calls it, e.g. "option -dt [s]" */
  PgStateKind kind;
  PgStateRule rule;
  PetscInt    count; /* values, or bytes of a text with its end mark */
  void       *value; /* PetscReal *, PetscInt * or char * */
} PgStateItem;

PETSC_EXTERN PetscErrorCode PgStateCreate(PgState *state);
PETSC_EXTERN PetscErrorCode PgStateDestroy(PgState *state);
/* The strings are copied, `value` is borrowed. `meaning` may be NULL for KEEP. */
PETSC_EXTERN PetscErrorCode PgStateAddReals(PgState state, const char name[], PgStateRule rule, const char meaning[],
                                            PetscInt count, PetscReal value[]);
PETSC_EXTERN PetscErrorCode PgStateAddInts(PgState state, const char name[], PgStateRule rule, const char meaning[],
                                           PetscInt count, PetscInt value[]);
PETSC_EXTERN PetscErrorCode PgStateAddText(PgState state, const char name[], PgStateRule rule, const char meaning[],
                                           PetscInt size, char value[]);
PETSC_EXTERN PetscErrorCode PgStateGetItems(PgState state, PetscInt *count, const PgStateItem *items[]);

/* ---- log stages: one for each phase of the step ---- */

typedef enum {
  PG_STAGE_SETUP,
  PG_STAGE_LISTS,     /* migration, ghosts, pair lists */
  PG_STAGE_HALO,      /* ghost values */
  PG_STAGE_CONTACT,   /* contact forces and moments */
  PG_STAGE_INTEGRATE, /* velocities and positions of the discs */
  PG_STAGE_POROSITY,
  PG_STAGE_GEOMETRY,  /* kernel weights of all pairs */
  PG_STAGE_PREDICTOR, /* drag and intermediate velocity */
  PG_STAGE_SOURCE,    /* right-hand side of the pressure equation */
  PG_STAGE_ASSEMBLE,
  PG_STAGE_PRESSURE,  /* sweeps or Krylov solve, and the true residual */
  PG_STAGE_CORRECTOR, /* velocities from the new pressure */
  PG_STAGE_OUTPUT,
  PG_STAGE_COUNT
} PgStage;

PETSC_EXTERN PetscErrorCode PgStagePush(PgStage stage);
PETSC_EXTERN PetscErrorCode PgStagePop(void);
/* Wall seconds of this rank spent in `stage` so far (not counting stages pushed inside it). */
PETSC_EXTERN PetscLogDouble PgStageSeconds(PgStage stage);
PETSC_EXTERN const char    *PgStageName(PgStage stage);
