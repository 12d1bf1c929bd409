/* Requests to end early; the handler writes one flag and nothing else. */
#include "base/interrupt.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { SIGNALLED = 128 }; /* exit code of a process that a signal ended */

static const struct {
  int signal_no;
  status code;
  const char *name;
  /* 1: the second such signal ends the process; the others are sent repeatedly,
   * or together */
  int urgent;
} requests[] = {{SIGINT, ERR_INTERRUPTED, "SIGINT", 1},
                {SIGTERM, ERR_TERMINATED, "SIGTERM", 1},
                {SIGHUP, ERR_HANGUP, "SIGHUP", 0},
                {SIGXCPU, ERR_CPU_LIMIT, "SIGXCPU", 0},
                {SIGUSR1, ERR_USER_1, "SIGUSR1", 0},
                {SIGUSR2, ERR_USER_2, "SIGUSR2", 0}};
enum { REQUESTS = sizeof requests / sizeof *requests };

static volatile sig_atomic_t caught; /* row of the first + 1, 0: none */
static volatile sig_atomic_t urgent; /* urgent ones so far */
static const char *file;             /* borrowed */
static int known_before;             /* 0: it could not be looked at */
static struct stat file_before;      /* ino 0: there was none */
static int file_seen;

enum { STACK = 64 << 10 }; /* bytes */
static int watching;
static char stack[STACK]; /* for the handlers: the other may be used up */

static void note(int signal_no) {
  int row = 0;
  while (requests[row].signal_no != signal_no) ++row;
  if (requests[row].urgent && urgent++) _exit(SIGNALLED + signal_no);
  if (caught == 0) caught = row + 1;
}

void interrupt_spare_writes(void) {
  const struct sigaction ignore = {.sa_handler = SIG_IGN};
  sigaction(SIGXFSZ, &ignore, NULL);
  sigaction(SIGPIPE, &ignore, NULL);
}

/* 1: the file exists and is no folder; 0: nothing exists; -1: not known. */
static int look_at(const char *path, struct stat *about) {
  int error_no = lstat(path, about) == 0 ? 0 : errno;
  if (error_no == 0 && !S_ISDIR(about->st_mode)) return 1;
  memset(about, 0, sizeof *about);
  return error_no == 0 || error_no == ENOENT ? 0 : -1;
}

/* Under nohup a hangup is not a request. */
static void catch (int row) {
  struct sigaction act = {.sa_handler = note, .sa_flags = SA_RESTART}, old;
  sigemptyset(&act.sa_mask);
  if (!requests[row].urgent &&
      sigaction(requests[row].signal_no, NULL, &old) == 0 &&
      old.sa_handler == SIG_IGN)
    return;
  sigaction(requests[row].signal_no, &act, NULL);
}

void interrupt_catch(const char *stop_file) {
  caught = urgent = 0;
  file_seen = 0;
  file = stop_file;
  known_before = file == NULL || look_at(file, &file_before) >= 0;
  for (int row = 0; row < REQUESTS; ++row) catch (row);
}

/* 1: the file differs from the one at the start, or was touched. */
static int is_made_to_stop(void) {
  struct stat now;
  if (!known_before) {
    known_before = look_at(file, &file_before) >= 0;
    return 0;
  }
  return look_at(file, &now) > 0 &&
         (now.st_ino != file_before.st_ino ||
          now.st_dev != file_before.st_dev ||
          now.st_mtim.tv_sec != file_before.st_mtim.tv_sec ||
          now.st_mtim.tv_nsec != file_before.st_mtim.tv_nsec);
}

/* One that was there before stays. */
static int stops(void) {
  if (!is_made_to_stop()) return 0;
  if (file_before.st_ino == 0) unlink(file);
  return 1;
}

status interrupt_asked(void) {
  if (caught != 0) return requests[caught - 1].code;
  if (!file_seen && file != NULL) file_seen = stops();
  return file_seen ? ERR_INTERRUPTED : OK;
}

const char *interrupt_name(void) {
  if (caught != 0) return requests[caught - 1].name;
  return file_seen ? file : "";
}

static void say(const char *text) {
  ssize_t ignored = write(STDERR_FILENO, text, strlen(text));
  (void)ignored;
}

static const char *name_of(int signal_no) {
  if (signal_no == SIGSEGV || signal_no == SIGBUS)
    return "an address that is not there";
  if (signal_no == SIGFPE) return "a floating-point trap";
  return signal_no == SIGILL ? "an instruction this machine does not know"
                             : "abort";
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

/* A sanitizer reports more about a crash. */
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
