/* measure COMMAND ...: runs it with its output thrown away and prints CPU seconds (user and system, children
   included), wall seconds, and the largest resident size of one process in kB. Exit status: that of the command. */
#include <fcntl.h>
#include <stdio.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

static double Seconds(struct timeval t) { return (double)t.tv_sec + 1e-6 * (double)t.tv_usec; }

int main(int argc, char *argv[])
{
  struct timeval begin, end;
  struct rusage  use;
  int            status;
  pid_t          child;

  if (argc < 2) return 2;
  gettimeofday(&begin, NULL);
  child = fork();
  if (child < 0) return 1;
  if (child == 0) {
    const int nowhere = open("/dev/null", O_WRONLY);
    if (nowhere >= 0) {
      dup2(nowhere, STDOUT_FILENO);
      dup2(nowhere, STDERR_FILENO);
    }
    execvp(argv[1], argv + 1);
    _exit(127);
  }
  if (waitpid(child, &status, 0) < 0) return 1;
  gettimeofday(&end, NULL);
  getrusage(RUSAGE_CHILDREN, &use);
  printf("%.4f %.4f %ld\n", Seconds(use.ru_utime) + Seconds(use.ru_stime), Seconds(end) - Seconds(begin),
         use.ru_maxrss);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}
