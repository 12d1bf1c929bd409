/*
 * Loaded before the C library of a program under test (LD_PRELOAD): what its
 * mesh reader sends is kept at the first run and given out again at later ones,
 * because loading libgmsh costs more than a small job.
 *
 *   MESH_KEPT  folder of the kept streams, each named by what was asked of
 *              gmsh: its numbers and options, name and text of the .geo
 *   MESH_MAKER socket of mesher.c, which makes those that are not there
 *
 * What is asked is found by a process forked where libgmsh would be loaded. It
 * gets the calls below in its place, and either gives out a kept stream, which
 * mesher.c may have to make, or ends with the name under which one may be kept.
 * Files that reach beyond their text are always made by the program's own gmsh.
 */
#define _GNU_SOURCE
#include "mesh.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

static int sink = -1;   /* of the stream, as the reader marks it            */
static int copy = -1;   /* the stream is being kept                         */
static int answer = -1; /* of the process that finds the name               */
static uint64_t key = 14695981039346656037u;
static int may_keep = 1;
static const char *kept, *maker;
static char path[4096]; /* of the stream that is being kept                 */

static void *real(const char *name) { return dlsym(RTLD_NEXT, name); }

/* The reader clears the environment of the process that meshes. */
static void look(void) __attribute__((constructor));
static void look(void) {
  kept = getenv("MESH_KEPT");
  maker = getenv("MESH_MAKER");
}

static void name_stream(char name[4096], const char *suffix) {
  snprintf(name, 4096, "%s/%016llx%s", kept, (unsigned long long)key, suffix);
}

/* The reader marks the end of the pipe that it writes to. */
int fcntl(int fd, int command, ...) {
  static int (*next)(int, int, ...);
  void *found = next == NULL ? real("fcntl") : NULL;
  va_list args;
  va_start(args, command);
  long value = va_arg(args, long);
  va_end(args);
  if (found != NULL) memcpy(&next, &found, sizeof next);
  if (command == F_SETFD && value == FD_CLOEXEC) sink = fd;
  return next(fd, command, value);
}

/* ---- what is asked of gmsh ----------------------------------------------- */

static void mix(const void *data, size_t n) {
  for (const unsigned char *p = data; n > 0; ++p, --n)
    key = (key ^ *p) * 1099511628211u;
}

static int n_word;
static char **word;
static const char *geo;
/* Sizes: views of an earlier mesh of the geometry, written out as it is. */
static int by_sizes, is_written, n_view, vertices;
static struct {
  double *data;
  size_t n;
} view[MESH_SIZES];

static void mix_text(const char *text) { mix(text, strlen(text) + 1); }

/* Of the program, then "-setnumber", name and value of each number: in any
 * order they give one mesh. */
void gmshInitialize(int argc, char **argv, int ignored, int *error) {
  const uint64_t before = key;
  uint64_t sum = 0;
  (void)ignored;
  n_word = argc;
  word = argv;
  for (int i = 1; i < argc; i += 3) {
    key = before;
    mix_text(argv[i + 1]);
    mix_text(argv[i + 2]);
    key =
        (key ^ key >> 29) * 0xbf58476d1ce4e5b9u; /* sums of near ones differ */
    sum += key ^ key >> 32;
  }
  key = before;
  mix(&sum, sizeof sum);
  *error = 0;
}

void gmshLoggerStart(int *error) { *error = 0; }

void gmshOptionSetNumber(const char *name, double value, int *error) {
  mix(name, strlen(name));
  mix(&value, sizeof value);
  *error = 0;
}

/* Where mesher.c finds the sizes. */
static void keep_view(const char *name, int i) {
  char file[4200];
  snprintf(file, sizeof file, "%s-%d.%d", name, i, (int)getpid());
  FILE *f = fopen(file, "wb");
  if (f == NULL) return;
  fwrite(view[i].data, sizeof(double), view[i].n, f);
  fclose(f);
}

/* The stream made by mesher.c, if it is there: the words of its request. */
static void have_made(const char *name) {
  static char text[1 << 16], *end = text;
  char *const last = text + sizeof text;
  struct sockaddr_un at = {.sun_family = AF_UNIX};
  const int fd = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  if (maker == NULL ||
      snprintf(at.sun_path, sizeof at.sun_path, "%s", maker) >=
          (int)sizeof at.sun_path ||
      connect(fd, (struct sockaddr *)&at, sizeof at) != 0 ||
      getcwd(end + 17, 4096) == NULL)
    return;
  snprintf(end, 17, "%s", strrchr(name, '/') + 1);
  end += 17;
  end += strlen(end) + 1;
  end += snprintf(end, (size_t)(last - end), "%s", geo) + 1;
  end += snprintf(end, 40, "%d %d %d %d", (int)getpid(), n_view, vertices,
                  !is_written) +
         1;
  for (int i = 0; i < n_view; ++i) keep_view(name, i);
  for (int i = 1; i < n_word; ++i)
    if (i % 3 != 1 && end < last)
      end += snprintf(end, (size_t)(last - end), "%s", word[i]) + 1;
  if (end < last && send(fd, text, (size_t)(end - text), MSG_NOSIGNAL) > 0)
    if (recv(fd, text, 1, 0) < 0) _exit(1);
}

/* The text of a file and of those it includes. */
static void mix_file(const char *name, int depth) {
  static const char *const beyond[] = {"Shape",   "Get",   "System",
                                       "Current", "Print", "Exit"};
  static const char *const others[] = {"Include", "Merge"};
  char text[1 << 15], file[2048], other[4096];
  const char *slash = strrchr(name, '/'), *at;
  const int folder = slash != NULL ? (int)(slash + 1 - name) : 0;
  FILE *f = fopen(name, "rb");
  const size_t n = f == NULL ? sizeof text : fread(text, 1, sizeof text - 1, f);
  if (f != NULL) fclose(f);
  may_keep &= depth < 4 && n < sizeof text - 1 && memchr(text, '\0', n) == NULL;
  if (!may_keep) return;
  text[n] = '\0';
  for (size_t i = 0; i < sizeof beyond / sizeof *beyond; ++i)
    may_keep &= strstr(text, beyond[i]) == NULL;
  mix_text(name + folder);
  mix_text(text);
  for (size_t i = 0; i < sizeof others / sizeof *others; ++i)
    for (at = text; may_keep && (at = strstr(at, others[i])) != NULL;) {
      int end = 0;
      at += strlen(others[i]);
      sscanf(at, " \"%2047[^\"]\";%n", file, &end);
      may_keep = end > 0 && file[0] != '/';
      at += end;
      if (!may_keep) return;
      snprintf(other, sizeof other, "%.*s%s", folder, name, file);
      mix_file(other, depth + 1);
    }
}

void gmshOpen(const char *name, int *error) {
  *error = 0;
  if (by_sizes) return;
  geo = name;
  mix_file(name, 0);
}

void gmshModelMeshRemoveConstraints(int *tags, size_t n, int *error) {
  (void)tags, (void)n;
  by_sizes = 1;
  *error = 0;
}

void gmshWrite(const char *name, int *error) {
  FILE *f = fopen(name, "w");
  *error = f == NULL || fclose(f) != 0;
  is_written = 1;
}

void gmshClear(int *error) { *error = 0; }

int gmshViewAdd(const char *name, int tag, int *error) {
  (void)name, (void)tag;
  *error = n_view == MESH_SIZES;
  return n_view;
}

void gmshViewAddListData(int tag, const char *kind, int n_elem, double *data,
                         size_t n, int *error) {
  double *own = malloc(n * sizeof *own);
  *error = own == NULL;
  if (own == NULL) return;
  memcpy(own, data, n * sizeof *own);
  mix_text(kind);
  mix(own, n * sizeof *own);
  vertices = n_elem > 0 ? (int)(n / 4 / (size_t)n_elem) : 0;
  view[tag].data = own;
  view[tag].n = n;
  ++n_view;
}

int gmshModelMeshFieldAdd(const char *kind, int tag, int *error) {
  (void)kind, (void)tag;
  *error = 0;
  return 0;
}

void gmshModelMeshFieldSetNumber(int tag, const char *option, double value,
                                 int *error) {
  (void)tag, (void)option, (void)value;
  *error = 0;
}

void gmshModelMeshFieldSetNumbers(int tag, const char *option, double *values,
                                  size_t n, int *error) {
  (void)tag, (void)option, (void)values, (void)n;
  *error = 0;
}

void gmshModelMeshFieldSetAsBackgroundMesh(int tag, int *error) {
  (void)tag;
  *error = 0;
}

/* The first call after what is to be meshed is known. */
void gmshModelGetPhysicalGroups(void) {
  static char part[65536];
  char name[4096];
  ssize_t n;
  if (!may_keep) _exit(1);
  name_stream(name, "");
  if (access(name, R_OK) != 0) have_made(name);
  int from = open(name, O_RDONLY | O_CLOEXEC), to = sink;
  sink = -1;
  if (from < 0) _exit(write(answer, &key, sizeof key) != sizeof key);
  while ((n = read(from, part, sizeof part)) > 0)
    if (write(to, part, (size_t)n) != n) break;
  _exit(0);
}

#define NEVER(name) \
  void gmsh##name(void) { _exit(1); }
GMSH_CALLS(NEVER)

/* ---- in the place of the C library's ------------------------------------- */

/* In the new process what takes the place of libgmsh, else NULL. */
static void *ask(void *(*next)(const char *, int), int flags) {
  int ends[2], code;
  Dl_info here;
  void *self = (void *)(uintptr_t)gmshOpen;
  if (pipe(ends) != 0) return NULL;
  pid_t pid = fork();
  if (pid == 0) {
    answer = ends[1];
    return dladdr(self, &here) ? next(here.dli_fname, flags) : NULL;
  }
  close(ends[1]);
  ssize_t n = read(ends[0], &key, sizeof key);
  close(ends[0]);
  if (pid < 0 || waitpid(pid, &code, 0) != pid) return NULL;
  if (n == (ssize_t)sizeof key) {
    char own[32];
    snprintf(own, sizeof own, ".%d", (int)getpid());
    name_stream(path, own);
    copy = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  } else if (code == 0) {
    _exit(0);
  }
  return NULL;
}

/* The reader loads libgmsh: here its work begins. What loads it for later
 * readers does not need it. */
void *dlopen(const char *file, int flags) {
  static void *(*next)(const char *, int);
  void *found = next == NULL ? real("dlopen") : NULL, *asked = NULL;
  if (found != NULL) memcpy(&next, &found, sizeof next);
  if (file != NULL && kept != NULL && strncmp(file, "libgmsh", 7) == 0) {
    const char *name = program_invocation_short_name;
    if (sink < 0 && (strcmp(name, "protis") == 0 || strcmp(name, "calls") == 0))
      return NULL;
    if (sink >= 0) asked = ask(next, flags);
  }
  return asked != NULL ? asked : next(file, flags);
}

/* The last record: the reader may end this process when it has it. */
static int is_end(const void *data, size_t n) {
  wire_head head;
  if (n != sizeof head) return 0;
  memcpy(&head, data, n);
  return head.magic == WIRE_MAGIC && head.kind == WIRE_END;
}

static ssize_t next_write(int fd, const void *data, size_t n) {
  static ssize_t (*next)(int, const void *, size_t);
  void *found = next == NULL ? real("write") : NULL;
  if (found != NULL) memcpy(&next, &found, sizeof next);
  return next(fd, data, n);
}

static void keep(const void *data, ssize_t n) {
  if (copy >= 0 && n > 0 && next_write(copy, data, (size_t)n) != n) copy = -1;
}

ssize_t write(int fd, const void *data, size_t n) {
  char name[4096];
  if (fd != sink) return next_write(fd, data, n);
  if (answer >= 0) _exit(1); /* gmsh was not even asked                       */
  if (!is_end(data, n)) {
    const ssize_t done = next_write(fd, data, n);
    keep(data, done);
    return done;
  }
  keep(data, (ssize_t)n);
  name_stream(name, "");
  if (copy >= 0) rename(path, name);
  return next_write(fd, data, n);
}
