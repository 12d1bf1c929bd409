/*
 * Status codes, the error record, and how an iteration ended.
 *
 * A function that can fail returns a status. RAISE starts a failure and stores
 * its message, PASS passes one up and records the function; both return at
 * once. Memory of locals is freed by OWNED (memory.h). Where else is to be
 * released, FAIL and TRY do the same, but jump to the single label "done:" of a
 * function that declares "status st = OK;". Only main prints the record and
 * turns the code into the exit code of the process.
 */
#pragma once

/* clang-format off */
#define STATUS_LIST(X)                                                       \
  X(OK,            0, "no error")                                            \
  X(ERR_UNSETTLED, 1, "finished, but an increment did not "                  \
                       "converge to its tolerance")                           \
  X(ERR_DECK,      2, "command line or input deck not valid")                \
  X(ERR_MESH,      3, "mesh not valid")                                      \
  X(ERR_FILE,      4, "file cannot be opened, read or written")              \
  X(ERR_MEMORY,    5, "memory exhausted")                                    \
  X(ERR_SINGULAR,  6, "no unique equilibrium: singular, not positive "       \
                      "definite or not a number")                            \
  X(ERR_INTERNAL,  7, "defect of the program")                               \
  X(ERR_INTERRUPTED, 130, "interrupted by SIGINT or JOB.stop")               \
  X(ERR_HANGUP,    129, "interrupted by SIGHUP")                              \
  X(ERR_USER_1,    138, "interrupted by SIGUSR1")                             \
  X(ERR_USER_2,    140, "interrupted by SIGUSR2")                             \
  X(ERR_TERMINATED,  143, "interrupted by SIGTERM")                           \
  X(ERR_CPU_LIMIT,   152, "interrupted by SIGXCPU")
/* clang-format on */

#define STATUS_ENUM(name, exit_code, text) name,
typedef enum { STATUS_LIST(STATUS_ENUM) STATUS_COUNT } status;

#define RAISE(code, ...) \
  return status_fail((code), __func__, __LINE__, __VA_ARGS__)

#define PASS(call)                      \
  do {                                  \
    status st_ = (call);                \
    if (st_ != OK) {                    \
      status_trace(__func__, __LINE__); \
      return st_;                       \
    }                                   \
  } while (0)

#define FAIL(code, ...)                                        \
  do {                                                         \
    st = status_fail((code), __func__, __LINE__, __VA_ARGS__); \
    goto done;                                                 \
  } while (0)

#define TRY(call)                       \
  do {                                  \
    st = (call);                        \
    if (st != OK) {                     \
      status_trace(__func__, __LINE__); \
      goto done;                        \
    }                                   \
  } while (0)

/* Store the message of a new failure, discard the record before; return
 * code. */
status status_fail(status code, const char *function, int line,
                   const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/* Record one function that passed the error up. */
void status_trace(const char *function, int line);

const char *status_message(void); /* what went wrong, one or more lines */
const char *status_path(void);    /* functions passed, innermost first */
const char *status_name(status s);
const char *status_text(status s);
int status_exit_code(status s);
int status_is_request(status s); /* 1: to end early, see base/interrupt.h */
void status_clear(void);

/* Above zero the result is usable, below zero the reason why not. */
/* clang-format off */
#define OUTCOME_LIST(X)                                                       \
  X(CONVERGED,           1, "CONVERGED",  "converged")                        \
  X(RUNNING,             0, "RUNNING",    "running")                          \
  X(STOPPED_ITERATIONS, -1, "ITERATIONS", "limit of iterations")              \
  X(STOPPED_STAGNATION, -2, "STAGNATION", "no further progress")              \
  X(STOPPED_RAY,        -3, "RAY",        "no equilibrium")                   \
  X(STOPPED_NAN,        -4, "NAN",        "not a number")                     \
  X(STOPPED_CYCLE,      -5, "CYCLE",      "cycle of states")                  \
  X(STOPPED_SINGULAR,   -6, "SINGULAR",   "singular")                         \
  X(STOPPED_UNFIT,      -7, "UNFIT", "method does not apply to the problem")   \
  X(STOPPED_UNSTABLE,   -8, "UNSTABLE",   "increment not stable")
/* clang-format on */
/* Stagnation: no progress above the rounding level; a ray: there is no
 * equilibrium; a cycle: statuses came again; singular: a linear system has no
 * solution; unstable: an explicit integrator met rates beyond its limit. */
#define OUTCOME_ENUM(name, value, code, text) name = value,
typedef enum { OUTCOME_LIST(OUTCOME_ENUM) } outcome;
/* In a few words, for listings and messages. */
const char *outcome_text(outcome o);
/* In a word, for programs. */
const char *outcome_code(outcome o);
/* 1 if there is no result to continue with: a ray, singular, not a number, a
 * method that does not apply. */
int outcome_is_fatal(outcome o);
