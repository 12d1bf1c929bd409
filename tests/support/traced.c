/*
 * Runs of the program under ptrace.
 */
#define _GNU_SOURCE /* process_vm_readv */
#include "support/traced.h"

#include "base/base.h"
#include "support/kept_mesh.h"

#include <check.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <stdint.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PATH = 512 };

static struct sock_filter load(size_t offset) {
  return (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS,
                                      (unsigned)offset);
}

/* Only calls that may change a file stop; looked at by changes_file. Opening to
 * read does not. */
static int stop_at_changes(void) {
  static const unsigned calls[] = {SYS_write,    SYS_pwrite64, SYS_fsync,
                                   SYS_close,    SYS_rename,   SYS_unlink,
                                   SYS_ftruncate};
  enum { CALLS = sizeof calls / sizeof *calls };
  struct sock_filter rule[CALLS + 6];
  int n = 0;
  rule[n++] = load(offsetof(struct seccomp_data, nr));
  for (int k = 0; k < CALLS; ++k)
    rule[n++] = (struct sock_filter)BPF_JUMP(
        BPF_JMP | BPF_JEQ | BPF_K, calls[k], (unsigned char)(CALLS + 3 - k), 0);
  rule[n++] =
      (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_openat, 0, 2);
  rule[n++] = load(offsetof(struct seccomp_data, args[2]));
  rule[n++] =
      (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, O_ACCMODE, 1, 0);
  rule[n++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
  rule[n++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRACE);
  struct sock_fprog program = {(unsigned short)n, rule};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER,
                 SECCOMP_FILTER_FLAG_SPEC_ALLOW, &program) == 0;
}

static pid_t start(const job *j, const char *const *words, int followed) {
  char deck[PATH], told[PATH];
  snprintf(deck, sizeof deck, "%s/%s", j->dir, j->name);
  snprintf(told, sizeof told, "%s/stderr.txt", j->dir);
  pid_t pid = fork();
  ck_assert_int_ge(pid, 0);
  if (pid > 0) return pid;
  int to = open(told, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (dup2(to, STDERR_FILENO) < 0 || dup2(to, STDOUT_FILENO) < 0) _exit(99);
  kept_mesh_preload("");
  if (followed && ptrace(PTRACE_TRACEME, 0, NULL, NULL) != 0) _exit(98);
  if (followed) raise(SIGSTOP); /* until the tracer is ready for the calls */
  if (followed && !stop_at_changes()) _exit(97);
  const char *second = words[0] == NULL ? NULL : words[1];
  execl(job_program(), job_program(), deck, "--no-timing", words[0], second,
        (char *)NULL);
  _exit(99);
}

/* 1: a file of the folder that is looked at, not one of the messages, nor of
 * those that are rewritten by time unless these count too. */
static int counts(const job *j, const char *path, const traced *t) {
  return strncmp(path, j->dir, strlen(j->dir)) == 0 &&
         strstr(path, "/stderr.txt") == NULL &&
         (t->timed || strstr(path, ".xdmf") == NULL) &&
         (t->of == NULL || strstr(path, t->of) != NULL);
}

/* 1: the descriptor was opened for writing. */
static int is_writable(pid_t pid, unsigned long long fd) {
  char name[64], line[PATH];
  unsigned flags = 0;
  snprintf(name, sizeof name, "/proc/%d/fdinfo/%llu", (int)pid, fd);
  FILE *f = fopen(name, "r");
  if (f == NULL) return 0;
  while (fgets(line, sizeof line, f) != NULL)
    if (sscanf(line, "flags: %o", &flags) == 1) break;
  fclose(f);
  return (flags & O_ACCMODE) != O_RDONLY;
}

/* Descriptors of the run that were looked up since they were opened; a file
 * that is renamed stays in the folder. */
typedef enum { UNKNOWN, WITHIN, ELSEWHERE } place;
enum { MOST_FILES = 256 };
static place known[MOST_FILES];

static int of_folder(const job *j, pid_t pid, unsigned long long fd,
                     const traced *t) {
  char link[64], path[PATH];
  if (fd < MOST_FILES && known[fd] != UNKNOWN) return known[fd] == WITHIN;
  snprintf(link, sizeof link, "/proc/%d/fd/%llu", (int)pid, fd);
  ssize_t n = readlink(link, path, sizeof path - 1);
  if (n < 0) return 0;
  path[n] = '\0';
  const int within = counts(j, path, t);
  if (fd < MOST_FILES) known[fd] = within ? WITHIN : ELSEWHERE;
  return within;
}

/* The descriptor ends: another file may have its number. */
static int closes_file(const job *j, pid_t pid, unsigned long long fd,
                       const traced *t) {
  const int within = of_folder(j, pid, fd, t);
  if (fd < MOST_FILES) known[fd] = UNKNOWN;
  return within && is_writable(pid, fd);
}

/* The path that stands there in the memory of the run; 0: none. */
static int path_at(pid_t pid, unsigned long long address, char path[PATH]) {
  memset(path, 0, PATH);
  struct iovec here = {path, PATH - 1};
  const size_t page = 4096, left = page - address % page;
  struct iovec there[2] = {{(void *)(uintptr_t)address, here.iov_len}};
  if (left < here.iov_len) { /* a page after it may not be there           */
    there[0].iov_len = left;
    there[1] = (struct iovec){(void *)(uintptr_t)(address + left),
                              here.iov_len - left};
  }
  return process_vm_readv(pid, &here, 1, there, 2, 0) > 0;
}

/* 1: that path is of the folder. A build that counts branches writes its counts
 * elsewhere. */
static int names_folder(const job *j, pid_t pid, unsigned long long address,
                        const traced *t) {
  char path[PATH];
  return path_at(pid, address, path) && counts(j, path, t);
}

static int changes_file(const job *j, pid_t pid,
                        const struct user_regs_struct *r, const traced *t) {
  switch (r->orig_rax) {
    case SYS_write:
    case SYS_pwrite64:
    case SYS_fsync:
    case SYS_ftruncate:
      return of_folder(j, pid, r->rdi, t);
    case SYS_close:
      return closes_file(j, pid, r->rdi, t);
    case SYS_openat:
      return (r->rdx & O_ACCMODE) != O_RDONLY &&
             names_folder(j, pid, r->rsi, t);
    case SYS_rename:
    case SYS_unlink:
      return names_folder(j, pid, r->rdi, t);
    default:
      return 0;
  }
}

/* The call is not made; its answer is set at its end. Of close it is. */
static void spoil(pid_t pid, struct user_regs_struct *r, const traced *t) {
  int writes = r->orig_rax == SYS_write || r->orig_rax == SYS_pwrite64;
  if (t->action == TRACE_SHORT && writes)
    r->rdx = (r->rdx + 1) / 2;
  else if (t->action == TRACE_ERROR && r->orig_rax != SYS_close)
    r->orig_rax = (unsigned long long)-1;
  ck_assert_int_eq(ptrace(PTRACE_SETREGS, pid, NULL, r), 0);
}

static void answer(pid_t pid, int number) {
  struct user_regs_struct r;
  ck_assert_int_eq(ptrace(PTRACE_GETREGS, pid, NULL, &r), 0);
  r.rax = (unsigned long long)-(long long)number;
  ck_assert_int_eq(ptrace(PTRACE_SETREGS, pid, NULL, &r), 0);
}

/* Restart files that are renamed to their place, and the folder after them. */
static void note_sync(const job *j, pid_t pid, const struct user_regs_struct *r,
                      traced *t) {
  char link[64], path[PATH] = "";
  if (r->orig_rax == SYS_rename && path_at(pid, r->rsi, path))
    t->restarts += strstr(path, ".rst.h5") != NULL;
  if (r->orig_rax != SYS_fsync) return;
  snprintf(link, sizeof link, "/proc/%d/fd/%llu", (int)pid, r->rdi);
  if (readlink(link, path, sizeof path - 1) > 0 && strcmp(path, j->dir) == 0)
    t->synced = t->restarts;
}

/* At the entry of a call; 1: its answer is to be an error. */
static int meet(const job *j, pid_t pid, traced *t) {
  struct user_regs_struct r;
  ck_assert_int_eq(ptrace(PTRACE_GETREGS, pid, NULL, &r), 0);
  note_sync(j, pid, &r, t);
  if (!changes_file(j, pid, &r, t)) return 0;
  ++t->changes;
  if (t->changes != t->at && !(t->always && t->changes > t->at)) return 0;
  if (t->action == TRACE_SIGNAL)
    ck_assert_int_eq(kill(pid, t->number), 0);
  else if (t->action != TRACE_COUNT)
    spoil(pid, &r, t);
  return t->action == TRACE_ERROR;
}

/* Another process or thread of the run: goes on. */
static void let_go(pid_t who, int code) {
  int signal_no = WIFSTOPPED(code) ? WSTOPSIG(code) : 0;
  if (signal_no == SIGSTOP || signal_no == SIGTRAP) signal_no = 0;
  if (WIFSTOPPED(code)) ptrace(PTRACE_CONT, who, NULL, signal_no);
}

/* The run stops: at a call, at the end of one that is spoilt, for a signal.
 * Whether the end of this call is to be seen. */
static int attend(const job *j, pid_t pid, int code, int spoilt, traced *t) {
  int signal_no = WSTOPSIG(code), fails = 0;
  if (code >> 8 == (SIGTRAP | PTRACE_EVENT_SECCOMP << 8))
    fails = meet(j, pid, t), signal_no = 0;
  else if (signal_no == (SIGTRAP | 0x80) && spoilt)
    answer(pid, t->number), signal_no = 0;
  else if ((signal_no & 0x7f) == SIGTRAP)
    signal_no = 0;
  ptrace(fails ? PTRACE_SYSCALL : PTRACE_CONT, pid, NULL, signal_no);
  return fails;
}

static int ended(int code) {
  return WIFEXITED(code) ? WEXITSTATUS(code) : 1000 + WTERMSIG(code);
}

static int follow(const job *j, pid_t pid, traced *t) {
  int code, spoilt = 0;
  memset(known, 0, sizeof known);
  ck_assert_int_eq(waitpid(pid, &code, 0), pid);
  if (t == NULL) return ended(code);
  ck_assert_msg(WIFSTOPPED(code), "cannot be traced: %x", code);
  ptrace(PTRACE_SETOPTIONS, pid, NULL,
         PTRACE_O_TRACESYSGOOD | PTRACE_O_EXITKILL | PTRACE_O_TRACESECCOMP |
             PTRACE_O_TRACEFORK | PTRACE_O_TRACEVFORK | PTRACE_O_TRACECLONE);
  ptrace(PTRACE_CONT, pid, NULL, 0);
  for (;;) {
    pid_t who = waitpid(-1, &code, __WALL);
    ck_assert_msg(who > 0 || errno == EINTR, "a traced run is lost");
    if (who != pid) {
      let_go(who, code);
      continue;
    }
    if (!WIFSTOPPED(code)) return ended(code);
    spoilt = attend(j, pid, code, spoilt, t);
  }
}

int traced_run(job *j, const char *const *words, traced *t) {
  job told = *j;
  if (t != NULL) t->changes = t->restarts = t->synced = 0;
  int code = follow(j, start(j, words, t != NULL), t);
  snprintf(told.name, sizeof told.name, "stderr");
  free(j->errors);
  j->errors = job_file(&told, "txt");
  return code;
}

/* 1: both are there and equal, or none is. */
static int same_file(const job *a, const job *b, const char *suffix) {
  char one[PATH], other[PATH];
  int c, d;
  snprintf(one, sizeof one, "%s/%s.%s", a->dir, a->name, suffix);
  snprintf(other, sizeof other, "%s/%s.%s", b->dir, b->name, suffix);
  FILE *f = fopen(one, "rb"), *g = fopen(other, "rb");
  if (f == NULL || g == NULL) {
    if (f != NULL) fclose(f);
    if (g != NULL) fclose(g);
    return f == g;
  }
  do {
    c = getc(f);
    d = getc(g);
  } while (c == d && c != EOF);
  fclose(f);
  fclose(g);
  return c == d;
}

const char *traced_difference(const job *a, const job *b) {
  static const char *const files[] = {"sta",  "cvg",  "dat", "h5",
                                      "xdmf", "json", "lst"};
  for (size_t k = 0; k < sizeof files / sizeof *files; ++k)
    if (!same_file(a, b, files[k])) return files[k];
  return NULL;
}
