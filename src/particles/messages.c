/* Messages to ranks that do not know beforehand who sends to them. */
#include "particlesimpl.h"

/* Tells the receivers what will come: `kinds` sizes for each message. Collective. */
PetscErrorCode PgMessagesPlan(MPI_Comm comm, PetscInt kinds, PetscMPIInt nto, const PetscMPIInt to[],
                              const PetscInt to_size[], PgMessages *messages)
{
  PetscMPIInt *from, count;
  PetscInt    *size;

  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(kinds, &count));
  messages->kinds = kinds;
  messages->nto   = nto;
  PetscCall(PetscMalloc1(nto, &messages->to));
  PetscCall(PetscMalloc1((size_t)nto * (size_t)kinds, &messages->to_size));
  PetscCall(PetscArraycpy(messages->to, to, nto));
  PetscCall(PetscArraycpy(messages->to_size, to_size, (size_t)nto * (size_t)kinds));
  PetscCall(PetscCommBuildTwoSided(comm, count, MPIU_INT, nto, to, to_size, &messages->nfrom, &from, &size));
  PetscCall(PetscMalloc1(messages->nfrom, &messages->from));
  PetscCall(PetscMalloc1((size_t)messages->nfrom * (size_t)kinds, &messages->from_size));
  /* They arrive in any order; a fixed one makes what is built from them repeatable. */
  for (PetscMPIInt m = 0; m < messages->nfrom; m++) {
    PetscMPIInt place = 0;
    for (PetscMPIInt other = 0; other < messages->nfrom; other++) place += (from[other] < from[m]);
    messages->from[place] = from[m];
    PetscCall(
        PetscArraycpy(messages->from_size + (size_t)place * (size_t)kinds, size + (size_t)m * (size_t)kinds, kinds));
  }
  PetscCall(PetscFree(from));
  PetscCall(PetscFree(size));
  PetscFunctionReturn(0);
}

PetscInt PgMessagesReceived(const PgMessages *messages, PetscInt kind)
{
  PetscInt total = 0;

  for (PetscMPIInt m = 0; m < messages->nfrom; m++) total += messages->from_size[m * messages->kinds + kind];
  return total;
}

/* Sends the data of one kind. Both buffers hold the messages one after the other, in the order of the
   ranks in `to` and `from`. Collective. */
PetscErrorCode PgMessagesExchange(MPI_Comm comm, PetscMPIInt tag, const PgMessages *messages, PetscInt kind,
                                  MPI_Datatype type, const void *send, void *receive)
{
  MPI_Request *request;
  MPI_Aint     extent, lower;
  PetscMPIInt  n;
  const char  *out = (const char *)send;
  char        *in  = (char *)receive;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Type_get_extent(type, &lower, &extent));
  PetscCall(PetscMalloc1(messages->nto + messages->nfrom, &request));
  for (PetscMPIInt m = 0; m < messages->nfrom; m++) {
    PetscCall(PetscMPIIntCast(messages->from_size[m * messages->kinds + kind], &n));
    PetscCallMPI(MPI_Irecv(in, n, type, messages->from[m], tag, comm, &request[m]));
    in += (MPI_Aint)n * extent;
  }
  for (PetscMPIInt m = 0; m < messages->nto; m++) {
    PetscCall(PetscMPIIntCast(messages->to_size[m * messages->kinds + kind], &n));
    PetscCallMPI(MPI_Isend(out, n, type, messages->to[m], tag, comm, &request[messages->nfrom + m]));
    out += (MPI_Aint)n * extent;
  }
  PetscCallMPI(MPI_Waitall(messages->nto + messages->nfrom, request, MPI_STATUSES_IGNORE));
  PetscCall(PetscFree(request));
  PetscFunctionReturn(0);
}

PetscErrorCode PgMessagesDestroy(PgMessages *messages)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(messages->to));
  PetscCall(PetscFree(messages->to_size));
  PetscCall(PetscFree(messages->from));
  PetscCall(PetscFree(messages->from_size));
  PetscFunctionReturn(0);
}
