/* Requests to end early; the handler writes one flag and nothing else. */
#include "base/interrupt.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SIGNALLED = 128 }; /* exit code of a process that a signal ended      */

static volatile sig_atomic_t caught; /* the first signal, 0: none            */
static const char *file;             /* borrowed                             */
static int file_seen;

enum {
  STACK = 64 << 10
}; /* bytes                                            */
static int watching;
static char stack[STACK]; /* for the handlers: the other may be used up     */

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

/* ---- ends that nobody chose -------------------------------------------- */

static void say(const char *text) {
  ssize_t ignored = write(STDERR_FILENO, text, strlen(text));
  (void)ignored;
}

static const char *name_of(int signal_no) {
  switch (signal_no) {
    case SIGSEGV:
    case SIGBUS:
      return "an address that is not there";
    case SIGFPE:
      return "a floating-point trap";
    case SIGILL:
      return "an instruction this machine does not know";
    default:
      return "abort";
  }
}

static void on_signal(int signal_no) {
  say("protis: error: the program or a library was ended by ");
  say(name_of(signal_no));
  say(": a defect, or memory was refused to a library; the files of the "
      "results are whole up to the last line of the .sta file\n");
  _exit(status_exit_code(ERR_INTERNAL));
}

/* exit() was called and not by main. */
static void on_exit_of_library(void) {
  if (!watching) return;
  say("protis: error: a library ended the program, most likely for want of "
      "memory; the files of the results are whole up to the last line of the "
      ".sta file\n");
  _exit(status_exit_code(ERR_MEMORY));
}

/* A sanitizer tells more of a crash. */
#ifdef __SANITIZE_ADDRESS__
enum { CATCHES_SIGNALS = 0 };
#else
enum { CATCHES_SIGNALS = 1 };
#endif

static void catch_signals(void) {
  static const int signals[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
  const stack_t other = {.ss_sp = stack, .ss_size = sizeof stack};
  struct sigaction act = {.sa_handler = on_signal, .sa_flags = SA_ONSTACK};
  sigemptyset(&act.sa_mask);
  if (sigaltstack(&other, NULL) != 0) act.sa_flags = 0;
  for (size_t i = 0; i < sizeof signals / sizeof *signals; ++i)
    sigaction(signals[i], &act, NULL);
}

void interrupt_crashes(void) {
  watching = 1;
  atexit(on_exit_of_library);
  if (CATCHES_SIGNALS) catch_signals();
}

void interrupt_over(void) { watching = 0; }
