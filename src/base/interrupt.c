/* Requests to end early; the handler writes one flag and nothing else. */
#include "base/interrupt.h"

#include <signal.h>
#include <stddef.h>
#include <unistd.h>

enum { SIGNALLED = 128 }; /* exit code of a process that a signal ended      */

static volatile sig_atomic_t caught; /* the first signal, 0: none            */
static const char *file;             /* borrowed                             */
static int file_seen;

static void note(int signal_no) {
  if (caught != 0) _exit(SIGNALLED + signal_no);
  caught = signal_no;
}

void interrupt_spare_writes(void) {
  const struct sigaction ignore = {.sa_handler = SIG_IGN};
  sigaction(SIGXFSZ, &ignore, NULL);
}

void interrupt_catch(const char *stop_file) {
  struct sigaction act = {.sa_handler = note, .sa_flags = SA_RESTART};
  sigemptyset(&act.sa_mask);
  caught = 0;
  file_seen = 0;
  file = stop_file;
  if (file != NULL) unlink(file);
  sigaction(SIGINT, &act, NULL);
  sigaction(SIGTERM, &act, NULL);
}

status interrupt_asked(void) {
  if (caught == SIGTERM) return ERR_TERMINATED;
  if (caught != 0) return ERR_INTERRUPTED;
  if (!file_seen && file != NULL) file_seen = unlink(file) == 0;
  return file_seen ? ERR_INTERRUPTED : OK;
}

const char *interrupt_name(void) {
  if (caught == SIGTERM) return "SIGTERM";
  if (caught != 0) return "SIGINT";
  return file_seen ? file : "";
}
