/*
 * The parent's side of the mesh reader: start the child, take its records, and
 * derive the reason of a failure from its exit status.
 */
#include "mesh/raw.h"

#include "base/base.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum { TAIL_SIZE = 65536, LAST_SIZE = 400 };

/* n bytes, or fewer at the end of the stream. */
static size_t read_bytes(int fd, void *data, size_t n) {
  size_t got = 0;
  while (got < n) {
    ssize_t r = read(fd, (char *)data + got, n - got);
    if (r < 0 && errno == EINTR) continue;
    if (r <= 0) break;
    got += r;
  }
  return got;
}

/* Store one record; the raw mesh owns the payload from here on if it is an
 * array (*payload is then NULL). 0 if it does not fit to what came before. */
static status store_block_part(raw_mesh *raw, const wire_head *head,
                               void **payload) {
  if (raw->n_block == 0)
    RAISE(ERR_MESH, "the mesh reader sent parts of nothing");
  raw_block *b = &raw->block[raw->n_block - 1];
  void *part = *payload;
  if (head->kind == WIRE_PHYSICAL && b->physical == NULL) {
    b->physical = part;
    b->n_physical = (int)head->n;
  } else if (head->kind == WIRE_ELEM_NO && b->no == NULL) {
    b->no = part;
    b->n = head->n;
  } else if (head->kind == WIRE_ELEM_NODE && b->node == NULL && b->n > 0 &&
             head->n % b->n == 0) {
    b->node = part;
    b->n_per = head->n / b->n;
  } else {
    RAISE(ERR_MESH, "the mesh reader sent parts that do not fit");
  }
  *payload = NULL;
  return OK;
}

/* Counts of fixed number are copied; the payload is not kept. */
static status copy_items(const wire_head *head, uint64_t wanted, void *to,
                         const void *data, size_t bytes) {
  if (head->n != wanted) RAISE(ERR_MESH, "the mesh reader sent a wrong count");
  memcpy(to, data, bytes);
  return OK;
}

/* Room for a new block, group or warning: the lists grow by doubling. */
#define APPEND(list, n)                                 \
  do {                                                  \
    if ((n) == 0 || ((n) >= 8 && ((n) & ((n)-1)) == 0)) \
      PASS_RESIZE(list, n, (n) < 8 ? 8 : 2 * (n));      \
  } while (0)

static status store(raw_mesh *raw, const wire_head *head, void **payload) {
  void *data = *payload;
  switch ((wire_kind)head->kind) {
    case WIRE_CENSUS:
      return copy_items(head, 4, raw->n_entity, data, sizeof raw->n_entity);
    case WIRE_LOOSE:
      return copy_items(head, 1, &raw->n_loose, data, sizeof raw->n_loose);
    case WIRE_NODE_NO:
      if (raw->node_no != NULL)
        RAISE(ERR_MESH, "the mesh reader sent nodes twice");
      raw->node_no = data;
      raw->n_node = head->n;
      break;
    case WIRE_NODE_X:
      if (raw->xyz != NULL || head->n != 3 * (uint64_t)raw->n_node)
        RAISE(ERR_MESH, "the mesh reader sent coordinates that do not fit");
      raw->xyz = data;
      break;
    case WIRE_GROUP:
      APPEND(raw->group, raw->n_group);
      raw->group[raw->n_group++] = (raw_group){head->dim, head->tag, data};
      break;
    case WIRE_BLOCK:
      APPEND(raw->block, raw->n_block);
      raw->block[raw->n_block++] =
          (raw_block){.dim = head->dim, .type = head->tag, .type_name = data};
      break;
    case WIRE_WARNING:
      APPEND(raw->warning, raw->n_warning);
      raw->warning[raw->n_warning++] = data;
      break;
    case WIRE_FAILURE:
      RAISE(head->tag == ERR_MEMORY || head->tag == ERR_FILE ? (status)head->tag
                                                             : ERR_MESH,
            "%s", (const char *)data);
    default:
      return store_block_part(raw, head, payload);
  }
  *payload = NULL;
  return OK;
}

/* What the later steps require: every array is present. */
static status check_complete(const raw_mesh *raw) {
  if (raw->node_no == NULL || raw->xyz == NULL)
    RAISE(ERR_MESH, "the mesh reader sent no nodes");
  for (int i = 0; i < raw->n_block; ++i)
    if (raw->block[i].node == NULL || raw->block[i].physical == NULL)
      RAISE(ERR_MESH, "the mesh reader sent half a block of elements");
  return OK;
}

status raw_receive(int fd, raw_mesh *raw, int *stopped) {
#define WIRE_SIZE(name, type) sizeof(type),
  static const size_t item_size[] = {WIRE_LIST(WIRE_SIZE)};
  *stopped = 0;
  OWNS(raw);
  for (;;) {
    wire_head head;
    *stopped = read_bytes(fd, &head, sizeof head) != sizeof head;
    if (*stopped)
      RAISE(ERR_MESH, "the mesh reader stopped before the mesh was complete");
    if (head.magic != WIRE_MAGIC || head.kind >= WIRE_COUNT ||
        head.n > (uint64_t)1 << 40)
      RAISE(ERR_MESH, "the mesh reader sent what is no mesh");
    if (head.kind == WIRE_END) return check_complete(raw);
    size_t size = head.n * item_size[head.kind];
    /* texts end in a zero byte */
    OWNED_GET(void, payload, memory_new(size + 1, 1));
    *stopped = read_bytes(fd, payload, size) != size;
    if (*stopped)
      RAISE(ERR_MESH, "the mesh reader stopped before the mesh was complete");
    PASS(store(raw, &head, &payload));
  }
}

/* The last line of gmsh that reports an error, else its last line. */
static void last_error(const char *text, char *last, size_t size) {
  last[0] = '\0';
  int found = 0;
  while (*text != '\0') {
    size_t length = strcspn(text, "\n");
    int error =
        strncmp(text, "Error", 5) == 0 || strncmp(text, "Fatal", 5) == 0;
    if (length > 0 && (error || !found))
      snprintf(last, size, "%.*s", (int)(length < size ? length : size - 1),
               text);
    found |= error;
    text += length + (text[length] != '\0');
  }
}

/* 1: the child had all the CPU time that a process of this user may take: the
 * soft limit ends it by SIGXCPU, the hard one by SIGKILL. */
static int had_all_time(void) {
  struct rlimit limit;
  struct rusage used;
  if (getrlimit(RLIMIT_CPU, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY ||
      getrusage(RUSAGE_CHILDREN, &used) != 0)
    return 0;
  const double s =
      (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
      1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
  return s >= 0.5 * (double)limit.rlim_cur; /* the limit counts whole ticks */
}

/* How the child ended, when it did not send a whole mesh. */
static status child_failure(int ended, int code, int error_fd) {
  char last[LAST_SIZE];
  OWNED_NEW(char, text, TAIL_SIZE + 1);
  /* A process started by gmsh may hold the other end: do not wait for it. */
  fcntl(error_fd, F_SETFL, O_NONBLOCK);
  read_bytes(error_fd, text, TAIL_SIZE);
  last_error(text, last, sizeof last);
  const char *said = last[0] != '\0' ? "; it said: " : "";
  int killed = ended && WIFSIGNALED(code);
  if (child_tells_of_memory(text))
    RAISE(ERR_MEMORY,
          "gmsh ran out of memory; give it more (--max-memory, ulimit -v) or "
          "make the mesh coarser; a damaged file may require too much");
  if (killed && had_all_time())
    RAISE(ERR_CPU_LIMIT,
          "gmsh reached the limit of CPU time while reading the mesh");
  if (killed && WTERMSIG(code) == SIGKILL)
    RAISE(ERR_MEMORY,
          "gmsh was killed: the system is out of memory, or the process was "
          "killed; free memory or make the mesh coarser%s%s",
          said, last);
  if (killed)
    RAISE(ERR_MESH, "gmsh was ended by signal %d (%s)%s%s", WTERMSIG(code),
          strsignal(WTERMSIG(code)), said, last);
  RAISE(ERR_MESH, "gmsh ended by itself before the mesh was complete%s%s", said,
        last);
}

static void close_end(int *end) {
  if (*end >= 0) close(*end);
  *end = -1;
}

static void close_ends(int (*ends)[2]) {
  close_end(&(*ends)[0]);
  close_end(&(*ends)[1]);
}

/* Where standard streams are closed, a pipe would get their descriptors. */
static void leave_standard(int *end) {
  if (*end > STDERR_FILENO) return;
  int other = fcntl(*end, F_DUPFD, STDERR_FILENO + 1);
  close_end(end);
  *end = other;
}

/* 0 and -1 in both if there is no pipe. */
static int open_pipe(int ends[2]) {
  if (pipe(ends) != 0) {
    ends[0] = ends[1] = -1;
    return 0;
  }
  leave_standard(&ends[0]);
  leave_standard(&ends[1]);
  return ends[0] >= 0 && ends[1] >= 0;
}

status raw_read(const raw_request *request, raw_mesh **out) {
  ENDS_BY(close_ends) int data[2] = {-1, -1};
  ENDS_BY(close_ends) int error[2] = {-1, -1};
  int stopped = 0, code = 0;
  PASS_NEW(*out, 1);
  if (!open_pipe(data) || !open_pipe(error))
    RAISE(ERR_MESH, "no pipe for the mesh reader: %s", strerror(errno));
  pid_t pid = fork();
  if (pid < 0)
    RAISE(errno == ENOMEM ? ERR_MEMORY : ERR_MESH,
          "no process for the mesh reader: %s", strerror(errno));
  if (pid == 0) {
    close(data[0]);
    close(error[0]);
    child_run(request, data[1], error[1]);
  }
  close_end(&data[1]);
  close_end(&error[1]);
  status st = raw_receive(data[0], *out, &stopped);
  close_end(&data[0]);
  if (!stopped) kill(pid, SIGKILL); /* its output has ended */
  /* Wait for the child; 1 if its end is known (not if SIGCHLD is ignored). */
  pid_t r;
  do r = waitpid(pid, &code, 0);
  while (r < 0 && errno == EINTR);
  timer_child_ended();
  int ended = r == pid;
  return stopped ? child_failure(ended, code, error[0]) : st;
}
