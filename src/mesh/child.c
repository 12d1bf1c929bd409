/*
 * The child's side of the mesh reader: load libgmsh, mesh the geometry, send
 * what it holds. Every end of this file is _exit: nothing that the parent
 * registered or buffered may run or be written twice. What gmsh allocates is
 * freed by that, but for the elements, which are many.
 *
 * libgmsh is loaded by the name that belongs to the header gmshc.h, whose calls
 * change from one minor version to the next.
 */
#define _GNU_SOURCE /* memfd_create */
#include "mesh/raw.h"

#include "base/base.h"
#include "base/file.h"
#include "base/system/limits.h"
#include "mesh/msh/geo.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <gmshc.h>
#include <locale.h>
#include <poll.h>
#include <signal.h>
#include <stdarg.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#define TEXT_OF(x) #x
#define TEXT(x) TEXT_OF(x)
#define LIBGMSH \
  "libgmsh.so." TEXT(GMSH_API_VERSION_MAJOR) "." TEXT(GMSH_API_VERSION_MINOR)

#define CALL_FIELD(name) __typeof__(&gmsh##name) name;
typedef struct gmsh_calls {
  GMSH_BEFORE_MESH(CALL_FIELD) GMSH_CALLS(CALL_FIELD)
} gmsh_calls;

typedef struct child {
  const raw_request *request;
  int fd;
  char *path;      /* of the geometry in full, or NULL */
  char *temporary; /* folder for copies of it */
  gmsh_calls gmsh;
} child;

enum { LEFT_BY_ITSELF = 71, MAX_WARNING = 5, TEXT_SIZE = 1024 };
enum { PROBE = 64 << 20, CRASH_STACK = 64 << 10 }; /* bytes */
enum { MOST_CPU = 3600 };                          /* s */

static void put(const child *c, const void *data, size_t n) {
  while (n > 0) {
    ssize_t w = write(c->fd, data, n);
    if (w < 0 && errno == EINTR) continue;
    if (w <= 0) _exit(LEFT_BY_ITSELF); /* the reader has closed the pipe */
    data = (const char *)data + w;
    n -= w;
  }
}

/* One record: head, then n items of the size given. */
static void send(const child *c, wire_head head, const void *data,
                 size_t size) {
  head.magic = WIRE_MAGIC;
  put(c, &head, sizeof head);
  put(c, data, head.n * size);
}

static void send_array(const child *c, wire_kind kind, size_t n, size_t size,
                       const void *data) {
  send(c, (wire_head){.kind = kind, .n = n}, data, size);
}

static void send_text(const child *c, wire_kind kind, int dim, int tag,
                      const char *text) {
  send(c, (wire_head){0, kind, dim, tag, strlen(text)}, text, 1);
}

/* gmsh uses the full name of the file: replace it by what the user wrote. */
static void name_as_given(const child *c, char text[TEXT_SIZE]) {
  const char *file = c->request->source->file;
  char *at = c->path != NULL ? strstr(text, c->path) : NULL;
  size_t n = c->path != NULL ? strlen(c->path) : 0, k = strlen(file);
  if (at == NULL || k > n) return;
  memmove(at + k, at + n, strlen(at + n) + 1);
  memcpy(at, file, k);
}

static void give_up(const child *c, status code, const char *format, ...)
    __attribute__((noreturn, format(printf, 3, 4)));
static void give_up(const child *c, status code, const char *format, ...) {
  char text[TEXT_SIZE];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  name_as_given(c, text);
  send_text(c, WIRE_FAILURE, 0, (int)code, text);
  _exit(0);
}

/* gmsh may exit by itself (Exit in a .geo): skip the exit handlers. */
static void leave_at_once(void) { _exit(LEFT_BY_ITSELF); }

/* End with the parent, which reads what is written to fd. The kernel forgets it
 * where the user changes. */
static void end_with_reader(int fd) {
  struct pollfd pipe = {.fd = fd};
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
  if (poll(&pipe, 1, 0) > 0 && (pipe.revents & POLLERR) != 0)
    _exit(LEFT_BY_ITSELF);
}

/* Isolate the process: streams, signals, core files; it ends with the parent.
 * The error output of gmsh goes to error_fd, which never blocks; what does not
 * fit is lost. */
static void detach(int fd, int error_fd) {
  static const int signals[] = {SIGINT,  SIGTERM, SIGHUP,  SIGQUIT, SIGPIPE,
                                SIGCHLD, SIGABRT, SIGSEGV, SIGFPE,  SIGBUS,
                                SIGILL,  SIGALRM, SIGUSR1, SIGUSR2, SIGXCPU};
  for (size_t i = 0; i < sizeof signals / sizeof *signals; ++i)
    signal(signals[i], SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, NULL);
  end_with_reader(fd);
  setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0});
  fcntl(fd, F_SETFD, FD_CLOEXEC);
  fcntl(error_fd, F_SETFL, O_NONBLOCK);
  int nothing = open("/dev/null", O_RDWR);
  if (nothing >= 0) {
    dup2(nothing, STDIN_FILENO);
    dup2(nothing, STDOUT_FILENO);
  }
  dup2(error_fd, STDERR_FILENO);
  setlocale(LC_ALL, "C");
  atexit(leave_at_once);
}

static void set_limit(unsigned what, double most) {
  struct rlimit l;
  if (getrlimit(what, &l) != 0 || !(most < (double)l.rlim_cur)) return;
  l.rlim_cur = (rlim_t)most;
  setrlimit(what, &l);
}

/* A .geo is a program of the user, with limits of time and memory. Neither the
 * environment nor files in the home folder affect the mesh, and no preferences
 * are written: no folder can be made below a device. */
static void confine(void) {
  limits l;
  limits_read("", &l);
  set_limit(RLIMIT_CPU, MOST_CPU);
#ifndef __SANITIZE_ADDRESS__ /* it reserves terabytes of addresses itself */
  set_limit(RLIMIT_DATA, l.memory);
#endif
  clearenv();
  setenv("HOME", "/dev/null", 1);
}

/* Called by the C++ library instead of throwing bad_alloc, which gmsh would
 * catch in places; the parent recognises the text. */
static void no_memory(void) {
  static const char word[] = "\nstd::bad_alloc\n";
  ssize_t ignored = write(STDERR_FILENO, word, sizeof word - 1);
  (void)ignored;
  _exit(LEFT_BY_ITSELF);
}

/* Parts of gmsh in C do not check the result of malloc. If not even a small
 * mesh would fit now, lack of memory is taken as the reason. */
static void on_crash(int number) {
  void *probe = mmap(NULL, PROBE, PROT_READ | PROT_WRITE,
                     MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (probe == MAP_FAILED) no_memory();
  signal(number, SIG_DFL);
  raise(number);
}

/* On a separate stack: the failure may be that the old one could not grow. */
static void watch_crashes(void) {
  static const int crash[] = {SIGSEGV, SIGBUS, SIGABRT};
  stack_t stack = {.ss_sp = memory_new(1, CRASH_STACK), .ss_size = CRASH_STACK};
  if (stack.ss_sp == NULL || sigaltstack(&stack, NULL) != 0) return;
  struct sigaction act = {.sa_handler = on_crash, .sa_flags = SA_ONSTACK};
  for (size_t i = 0; i < sizeof crash / sizeof *crash; ++i)
    sigaction(crash[i], &act, NULL);
}

/* std::set_new_handler of the library that gmsh itself is linked with. */
static void watch_memory(void *library) {
  void (*(*set_handler)(void (*)(void)))(void) = NULL;
  void *symbol = dlsym(library, "_ZSt15set_new_handlerPFvvE");
  if (symbol == NULL) return;
  memcpy(&set_handler, &symbol, sizeof symbol);
  set_handler(no_memory);
}

void mesh_gmsh_load(void) { (void)dlopen(LIBGMSH, RTLD_LAZY | RTLD_LOCAL); }

static void load(child *c) {
  void *library = dlopen(LIBGMSH, RTLD_LAZY | RTLD_LOCAL);
  if (library == NULL) {
    const char *why = dlerror();
    int memory = strstr(why, "annot allocate") || strstr(why, "failed to map");
    give_up(c, memory ? ERR_MEMORY : ERR_MESH, "cannot load %s: %s", LIBGMSH,
            why);
  }
#define CALL_LOAD(name)                                      \
  do {                                                       \
    void *symbol_ = dlsym(library, "gmsh" #name);            \
    if (symbol_ == NULL)                                     \
      give_up(c, ERR_MESH, "%s has no gmsh" #name, LIBGMSH); \
    memcpy(&c->gmsh.name, &symbol_, sizeof symbol_);         \
  } while (0);
  GMSH_BEFORE_MESH(CALL_LOAD)
  GMSH_CALLS(CALL_LOAD)
  watch_memory(library);
  watch_crashes();
}

int child_tells_of_memory(const char *text) {
  return strstr(text, "bad_alloc") != NULL ||
         strstr(text, "Out of memory") != NULL ||
         strstr(text, "out of memory") != NULL ||
         strstr(text, "out of dynamic memory") != NULL ||
         strstr(text, "annot allocate memory") != NULL;
}

/* 1: it tells of a file '...' that cannot be read. */
static int names_no_file(const char *text) {
  static const char word[] = " file '";
  char path[PATH_MAX];
  const char *from = strstr(text, word), *end = strrchr(text, '\'');
  if (from == NULL || end < (from += sizeof word - 1)) return 0;
  snprintf(path, sizeof path, "%.*s", (int)(end - from), from);
  return access(path, R_OK) != 0;
}

/* A step of gmsh failed: its last error gives the reason. */
static void check(const child *c, int error, const char *doing) {
  if (!error) return;
  char *last = NULL;
  int ignored;
  c->gmsh.LoggerGetLastError(&last, &ignored);
  status code = ERR_MESH;
  if (last != NULL && child_tells_of_memory(last)) code = ERR_MEMORY;
  if (last != NULL && names_no_file(last)) code = ERR_FILE;
  give_up(c, code, "gmsh fails to %s: %s", doing,
          last != NULL && last[0] != '\0' ? last : "no reason given");
}

#define CALL(c, doing, call, ...) \
  do {                            \
    int error_;                   \
    call(__VA_ARGS__, &error_);   \
    check((c), error_, (doing));  \
  } while (0)

static void set(const child *c, const char *option, double value) {
  CALL(c, option, c->gmsh.OptionSetNumber, option, value);
}

/* Numbers for the .geo are set as on the command line of gmsh, before the file
 * is read: they override DefineConstant. */
static void start(const child *c) {
  const mesh_source *r = c->request->source;
  int n = r->n_number, error;
  char **argv = memory_new(3 * (size_t)n + 2, sizeof *argv);
  char *text = memory_new((size_t)n + 1, 40);
  if (argv == NULL || text == NULL)
    give_up(c, ERR_MEMORY, "memory exhausted: %d numbers for gmsh", n);
  char *program = text + 40 * n, *set_number = program + 8;
  int argc = 0;
  argv[argc++] = strcpy(program, "protis");
  strcpy(set_number, "-setnumber");
  for (int i = 0; i < n; ++i) {
    char *value = text + 40 * i;
    snprintf(value, 40, "%.17g", r->numbers[i].value);
    argv[argc++] = set_number;
    argv[argc] = memory_text(r->numbers[i].name);
    if (argv[argc++] == NULL)
      give_up(c, ERR_MEMORY, "memory exhausted: numbers for gmsh");
    argv[argc++] = value;
  }
  /* The graphical interface of gmsh would write preferences to /etc for
   * root. */
  const uid_t user = geteuid(), nobody = 65534;
  int changed = user == 0 && seteuid(nobody) == 0;
  c->gmsh.Initialize(argc, argv, 0, &error);
  if (changed && seteuid(user) != 0) _exit(LEFT_BY_ITSELF);
  end_with_reader(c->fd);
  check(c, error, "start");
  set(c, "General.Terminal", 1);
  c->gmsh.LoggerStart(&error);
}

/* The earlier mesh as a view of gmsh: per element the coordinates x of all
 * vertices, then y, then z, then the sizes there, in units of the .geo. */
static double *view_of_sizes(const child *c, const mesh_sizes *s, size_t *n) {
  const mesh_source *r = c->request->source;
  const mesh *m = s->of;
  size_t vertices = (size_t)m->dim + 1, k = 0;
  *n = 4 * vertices * (size_t)m->n_elem;
  double *data = memory_new(*n, sizeof *data);
  if (data == NULL) give_up(c, ERR_MEMORY, "memory exhausted: sizes for gmsh");
  for (int e = 0; e < m->n_elem; ++e) {
    const int *node = m->elem + vertices * e;
    for (int i = 0; i < 3; ++i)
      for (size_t a = 0; a < vertices; ++a)
        data[k++] = (i < m->dim ? m->x[m->dim * node[a] + i] : m->z) / r->scale;
    for (size_t a = 0; a < vertices; ++a) data[k++] = s->at[node[a]] / r->scale;
  }
  return data;
}

/* Copy the geometry without the lines that fix numbers of elements; 0: it
 * cannot be written. */
static int drop_counts(const char *from, const char *to) {
  static const char *const words[] = {"Transfinite ", "Recombine ", "Field[",
                                      "Background Field"};
  ENDS_BY(file_leave) FILE *in = fopen(from, "r");
  FILE *out = in != NULL ? fopen(to, "w") : NULL;
  char *line = NULL;
  size_t capacity = 0;
  if (out == NULL) return 0;
  while (getline(&line, &capacity, in) > 0) {
    int kept = 1;
    for (size_t i = 0; i < sizeof words / sizeof *words; ++i)
      kept &= strncmp(line, words[i], strlen(words[i])) != 0;
    if (kept) fputs(line, out);
  }
  int whole = feof(in) && !ferror(out);
  free(line);
  return fclose(out) == 0 && whole;
}

/*
 * Transfinite curves would keep their number of segments whatever the sizes.
 * Those of the built-in kernel cannot be removed in a model: the geometry is
 * written out and read again without them.
 */
static void free_counts(const child *c) {
  char folder[PATH_MAX], all[PATH_MAX + 20], rest[PATH_MAX + 20];
  int error;
  c->gmsh.ModelMeshRemoveConstraints(NULL, 0, &error);
  if (c->request->is_solid) return;
  snprintf(folder, sizeof folder, "%s/protis_XXXXXX", c->temporary);
  if (mkdtemp(folder) == NULL)
    give_up(c, ERR_FILE, "cannot make a folder in %s: %s", c->temporary,
            strerror(errno));
  snprintf(all, sizeof all, "%s/all.geo_unrolled", folder);
  snprintf(rest, sizeof rest, "%s/rest.geo", folder);
  c->gmsh.Write(all, &error);
  errno = 0;
  int copied = !error && drop_counts(all, rest);
  int why = errno;
  if (copied) c->gmsh.Clear(&error);
  if (copied && !error) c->gmsh.Open(rest, &error);
  unlink(all);
  unlink(rest);
  rmdir(folder);
  check(c, error, "write the geometry and read it again");
  if (!copied)
    give_up(c, ERR_FILE, "cannot copy the geometry to %s: %s", c->temporary,
            why != 0 ? strerror(why) : "unknown reason");
}

static const char take_sizes[] = "take the sizes";

/* Field of the sizes at the nodes of an earlier mesh. */
static int add_sizes(const child *c, const mesh_sizes *s) {
  size_t n;
  int view, field, n_elem = s->of->n_elem;
  double *data = view_of_sizes(c, s, &n);
  CALL(c, take_sizes, view = c->gmsh.ViewAdd, "sizes", -1);
  CALL(c, take_sizes, c->gmsh.ViewAddListData, view,
       s->of->dim == 2 ? "ST" : "SS", n_elem, data, n);
  CALL(c, take_sizes, field = c->gmsh.ModelMeshFieldAdd, "PostView", -1);
  CALL(c, take_sizes, c->gmsh.ModelMeshFieldSetNumber, field, "ViewTag", view);
  memory_free(data);
  return field;
}

/* In place of those of the .geo. */
static void set_sizes(const child *c) {
  const mesh_sizes *s = c->request->source->sizes;
  double fields[MESH_SIZES];
  size_t n = 0;
  for (; n < MESH_SIZES && s[n].of != NULL; ++n)
    fields[n] = add_sizes(c, &s[n]);
  int least = (int)fields[0];
  if (n > 1) {
    CALL(c, take_sizes, least = c->gmsh.ModelMeshFieldAdd, "Min", -1);
    CALL(c, take_sizes, c->gmsh.ModelMeshFieldSetNumbers, least, "FieldsList",
         fields, n);
  }
  CALL(c, take_sizes, c->gmsh.ModelMeshFieldSetAsBackgroundMesh, least);
  set(c, "Mesh.MeshSizeExtendFromBoundary", 0);
  set(c, "Mesh.MeshSizeFromPoints", 0);
  set(c, "Mesh.MeshSizeFromCurvature", 0);
  set(c, "Mesh.MeshSizeMin", 0);
  set(c, "Mesh.MeshSizeMax", 1e22);
  set(c, "Mesh.MeshSizeFactor", 1);
}

/* 1: there is an options file (x.geo.opt), which gmsh would execute after the
 * file. */
static int has_options(const char *path) {
  char name[PATH_MAX + 8];
  snprintf(name, sizeof name, "%s.opt", path);
  return access(name, F_OK) == 0;
}

static void refuse_options(const child *c, const char *path)
    __attribute__((noreturn));
static void refuse_options(const child *c, const char *path) {
  give_up(c, ERR_MESH,
          "%s is merged and has an options file of gmsh: %s.opt would be "
          "executed; remove it, or Include the file in the place of Merge",
          path, path);
}

/* Options files of merged files, before gmsh reads them. */
static void check_merged(const child *c) {
  geo_text g;
  status st = geo_read(c->request->source->file, &g);
  if (st != OK) give_up(c, st, "%s", status_message());
  for (int i = 1; i < g.n_file; ++i)
    if (g.merged[i] && has_options(g.file[i])) refuse_options(c, g.file[i]);
  geo_free(&g);
}

/* The same for names that only gmsh can evaluate, by its log. */
static void check_log(const child *c, char *line) {
  static const char start[] = "Info: Reading '", end[] = ".opt'...";
  char *path = line + sizeof start - 1, *at = strstr(line, end);
  if (strncmp(line, start, sizeof start - 1) != 0 || at == NULL) return;
  *at = '\0';
  if (access(path, F_OK) == 0) refuse_options(c, path);
  *at = end[0];
}

/* Where there are such options the file is included by a file in memory, which
 * has no options file; a few elements of some meshes differ for that. */
static void open_geo(child *c) {
  char name[32];
  check_merged(c);
  c->path = realpath(c->request->source->file, NULL);
  int fd = memfd_create("protis", MFD_CLOEXEC);
  if (fd < 0 || c->path == NULL)
    give_up(c, ERR_MESH, "cannot pass the geometry to gmsh: %s",
            strerror(errno));
  snprintf(name, sizeof name, "/proc/self/fd/%d", fd);
  const char *file = has_options(c->path) ? name : c->path;
  if (file == name && strpbrk(c->path, "\"\n\\") != NULL)
    give_up(c, ERR_MESH,
            "the path has quotes or backslashes and there is an options file "
            "of gmsh; rename it or remove the options file");
  dprintf(fd, "Include \"%s\";\n", c->path);
  CALL(c, "read the file", c->gmsh.Open, file);
}

/* Highest dimension of the physical groups: 3, or 2, or less; -1 if none. */
static int send_groups(const child *c) {
  int *dim_tag, dim = -1;
  size_t n;
  CALL(c, "list the physical groups", c->gmsh.ModelGetPhysicalGroups, &dim_tag,
       &n, -1);
  for (size_t i = 0; i + 1 < n; i += 2) {
    char *name;
    CALL(c, "name the physical groups", c->gmsh.ModelGetPhysicalName,
         dim_tag[i], dim_tag[i + 1], &name);
    send_text(c, WIRE_GROUP, dim_tag[i], dim_tag[i + 1], name);
    if (dim_tag[i] > dim) dim = dim_tag[i];
  }
  return dim;
}

typedef struct elements { /* of one entity, as gmsh gives them */
  int *type;
  size_t n_type, **no, *no_n, no_nn, **node, *node_n, node_nn;
} elements;

static void get_elements(const child *c, int dim, int tag, elements *e) {
  CALL(c, "list the elements", c->gmsh.ModelMeshGetElements, &e->type,
       &e->n_type, &e->no, &e->no_n, &e->no_nn, &e->node, &e->node_n,
       &e->node_nn, dim, tag);
}

static void free_elements(const child *c, elements *e) {
  for (size_t i = 0; i < e->no_nn; ++i) c->gmsh.Free(e->no[i]);
  for (size_t i = 0; i < e->node_nn; ++i) c->gmsh.Free(e->node[i]);
  c->gmsh.Free(e->no);
  c->gmsh.Free(e->node);
  c->gmsh.Free(e->no_n);
  c->gmsh.Free(e->node_n);
  c->gmsh.Free(e->type);
}

static int has_elements(const child *c, int dim) {
  elements e;
  get_elements(c, dim, -1, &e);
  size_t n = 0;
  for (size_t i = 0; i < e.n_type; ++i) n += e.no_n[i];
  free_elements(c, &e);
  return n > 0;
}

static void send_block(const child *c, int dim, const elements *e, size_t i,
                       const int *physical, size_t n_physical) {
  char *name;
  int type_dim, order, n_per, n_corner;
  double *local;
  size_t n_local;
  CALL(c, "name a type of elements", c->gmsh.ModelMeshGetElementProperties,
       e->type[i], &name, &type_dim, &order, &n_per, &local, &n_local,
       &n_corner);
  send_text(c, WIRE_BLOCK, dim, e->type[i], name);
  send_array(c, WIRE_PHYSICAL, n_physical, sizeof(int), physical);
  send_array(c, WIRE_ELEM_NO, e->no_n[i], sizeof(size_t), e->no[i]);
  send_array(c, WIRE_ELEM_NODE, e->node_n[i], sizeof(size_t), e->node[i]);
}

/* The elements of one entity; how many are of dimension top in no group. */
static size_t send_entity(const child *c, int dim, int tag, int top) {
  int *physical;
  size_t n_physical, loose = 0;
  CALL(c, "list the groups of an entity",
       c->gmsh.ModelGetPhysicalGroupsForEntity, dim, tag, &physical,
       &n_physical);
  if (n_physical > 0 || dim == top) {
    elements e;
    get_elements(c, dim, tag, &e);
    for (size_t i = 0; i < n_physical; ++i) /* the sign is an orientation */
      physical[i] = abs(physical[i]);
    for (size_t i = 0; i < e.n_type; ++i)
      if (n_physical == 0)
        loose += e.no_n[i];
      else if (e.no_n[i] > 0)
        send_block(c, dim, &e, i, physical, n_physical);
    free_elements(c, &e);
  }
  return loose;
}

static void send_entities(const child *c, int top) {
  int *dim_tag, census[4] = {0, 0, 0, 0};
  size_t n, loose = 0;
  CALL(c, "list the entities", c->gmsh.ModelGetEntities, &dim_tag, &n, -1);
  for (size_t i = 0; i + 1 < n; i += 2) {
    if (dim_tag[i] >= 0 && dim_tag[i] < 4) ++census[dim_tag[i]];
    if (top >= 2) loose += send_entity(c, dim_tag[i], dim_tag[i + 1], top);
  }
  send_array(c, WIRE_CENSUS, 4, sizeof(int), census);
  send_array(c, WIRE_LOOSE, 1, sizeof(size_t), &loose);
}

/* gmsh continues after some errors: the mesh is then not valid. */
static void send_warnings(const child *c, const char *doing) {
  char **line;
  size_t n;
  int n_warning = 0;
  CALL(c, "list its messages", c->gmsh.LoggerGet, &line, &n);
  for (size_t i = 0; i < n; ++i) {
    check_log(c, line[i]);
    if (strncmp(line[i], "Error: ", 7) == 0)
      give_up(c, ERR_MESH, "gmsh fails to %s: %s", doing, line[i] + 7);
    if (strncmp(line[i], "Warning: ", 9) == 0 && n_warning++ < MAX_WARNING)
      send_text(c, WIRE_WARNING, 0, 0, line[i] + 9);
  }
}

/* 1: the .geo has left a number another value than it was given. */
static int is_replaced(const child *c, const mesh_number *of) {
  char name[32], **line;
  int error, fd = memfd_create("protis", MFD_CLOEXEC);
  size_t before = 0, n = 0;
  if (fd < 0) give_up(c, ERR_MESH, "cannot ask gmsh: %s", strerror(errno));
  snprintf(name, sizeof name, "/proc/self/fd/%d", fd);
  dprintf(fd,
          "If (Exists(%s))\nIf (#%s() != 1)\nPrintf(\"replaced\");\n"
          "ElseIf (%s(0) != %.17g)\nPrintf(\"replaced\");\nEndIf\nEndIf\n",
          of->name, of->name, of->name, of->value);
  CALL(c, "list its messages", c->gmsh.LoggerGet, &line, &before);
  c->gmsh.Merge(name, &error); /* fails where the name is a word of gmsh */
  close(fd);
  CALL(c, "list its messages", c->gmsh.LoggerGet, &line, &n);
  for (size_t i = before; i < n; ++i)
    if (strstr(line[i], ": replaced") != NULL) return 1;
  return 0;
}

/* A number that statements replace by another has no effect; after all else,
 * as the question is a file that gmsh merges. */
static void check_numbers(const child *c) {
  const mesh_source *r = c->request->source;
  geo_text g = {0};
  for (EACH(const mesh_number, of, r->numbers, r->n_number)) {
    geo_setting how;
    const char *file = r->file;
    int line = 0;
    char where[16] = "", text[1024];
    if (!is_replaced(c, of)) continue;
    if (g.n_file == 0 && geo_read(r->file, &g) != OK) return;
    if (geo_sets(&g, of->name, &how, &file, &line) != OK) return;
    if (how == GEO_CHANGES) continue;
    if (line > 0) snprintf(where, sizeof where, ":%d", line);
    snprintf(
        text, sizeof text,
        "%s%s gives %s a value: %s = %g %s; write DefineConstant[ %s = ... "
        "] there, or take another name",
        file, where, of->name, of->name, of->value,
        of->in_deck ? OWN_VALUE : NO_EFFECT, of->name);
    if (!of->in_deck) give_up(c, ERR_MESH, "%s", text);
    send_text(c, WIRE_WARNING, 0, 0, text);
  }
}

void child_run(const raw_request *request, int fd, int error_fd) {
  child here = {.request = request, .fd = fd}, *c = &here;
  const char *folder = getenv("TMPDIR");
  c->temporary = memory_text(folder != NULL && *folder ? folder : "/tmp");
  detach(fd, error_fd);
  if (c->temporary == NULL) give_up(c, ERR_MEMORY, "memory exhausted: a name");
  confine();
  load(c);
  start(c);
  open_geo(c);
  if (request->source->sizes[0].of != NULL) {
    free_counts(c);
    set_sizes(c);
  }
  int dim = send_groups(c);
  const char *doing = "read the file";
  if (dim >= 2 && !has_elements(c, dim)) {
    doing = "mesh the geometry";
    /* One thread: the same input gives the same mesh. Linear elements. */
    set(c, "General.NumThreads", 1);
    set(c, "Mesh.MaxNumThreads1D", 1);
    set(c, "Mesh.MaxNumThreads2D", 1);
    set(c, "Mesh.MaxNumThreads3D", 1);
    set(c, "Mesh.ElementOrder", 1);
    CALL(c, doing, c->gmsh.ModelMeshGenerate, dim);
  }
  send_warnings(c, doing);
  send_entities(c, dim);
  size_t *no, n, n_x, n_parameter;
  double *x, *parameter;
  CALL(c, "list the nodes", c->gmsh.ModelMeshGetNodes, &no, &n, &x, &n_x,
       &parameter, &n_parameter, -1, -1, 0, 0);
  send_array(c, WIRE_NODE_NO, n, sizeof(size_t), no);
  send_array(c, WIRE_NODE_X, n_x, sizeof(double), x);
  if (request->source->sizes[0].of == NULL) check_numbers(c);
  send_array(c, WIRE_END, 0, 1, NULL);
  _exit(0);
}
