/*
 * Makes meshes for the programs under test: libgmsh is loaded once for all of
 * them, which costs more than most meshes. Each is made in a process of its own
 * by the reader's own code, into the file that mesh.c asks for.
 * usage: mesher FOLDER SOCKET     listens at SOCKET until its parent ends
 *
 * A request: the words key, folder of the program, file, "p n v s", then name
 * and value of each number, each ended by a zero byte. The answer: one byte,
 * the file FOLDER/key is there or will not be. The n views of sizes are the
 * files FOLDER/key-i.p, of elements with v vertices; s = 1: geometry of
 * OpenCASCADE.
 */
#define _GNU_SOURCE /* accept4 */
#include "mesh/raw.h"

#include <fcntl.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MOST = 1 << 16, NUMBERS = 100, HEAD = 4 };

/* The words of the request; their number, 0: it is none. */
static int receive(int fd, char text[MOST], char *words[HEAD + 2 * NUMBERS]) {
  const ssize_t got = recv(fd, text, MOST, 0);
  int n = 0;
  if (got < 2 || text[got - 1] != '\0') return 0;
  for (char *at = text; at < text + got; at += strlen(at) + 1) {
    if (n == HEAD + 2 * NUMBERS) return 0;
    words[n++] = at;
  }
  return n >= HEAD && (n - HEAD) % 2 == 0 ? n : 0;
}

/* The sizes of a view: a mesh in which no elements share a node. */
static int take_view(const char *name, int vertices, mesh_sizes *sizes) {
  struct stat is;
  const int fd = open(name, O_RDONLY);
  if (fd < 0 || fstat(fd, &is) != 0 || is.st_size == 0) return 0;
  const size_t n = (size_t)is.st_size / sizeof(double) / 4;
  double *data = malloc(4 * n * sizeof *data), *at = malloc(n * sizeof *at);
  mesh *m = calloc(1, sizeof *m);
  m->dim = vertices - 1;
  m->n_elem = (int)n / vertices;
  m->elem = malloc(n * sizeof *m->elem);
  m->x = malloc(n * m->dim * sizeof *m->x);
  if (read(fd, data, 4 * n * sizeof *data) < is.st_size) return 0;
  for (int k = 0; k < (int)n; ++k) {
    const double *of = data + 4 * vertices * (k / vertices) + k % vertices;
    for (int i = 0; i < m->dim; ++i) m->x[m->dim * k + i] = of[i * vertices];
    m->z = of[2 * vertices];
    at[k] = of[3 * vertices];
    m->elem[k] = k;
  }
  *sizes = (mesh_sizes){m, at};
  close(fd);
  unlink(name);
  free(data);
  return 1;
}

static void make(const char *whole, const char *part, int n,
                 char *const *words) {
  mesh_number numbers[NUMBERS];
  mesh_source source = {
      .file = words[2], .scale = 1.0, .n_number = (n - HEAD) / 2};
  int pid, n_view, vertices, is_solid;
  char view[4300];
  source.numbers = numbers;
  for (int i = 0; i < source.n_number; ++i)
    numbers[i] = (mesh_number){words[HEAD + 2 * i],
                               strtod(words[HEAD + 2 * i + 1], NULL), 0};
  if (sscanf(words[3], "%d %d %d %d", &pid, &n_view, &vertices, &is_solid) != 4)
    _exit(1);
  for (int i = 0; i < n_view; ++i) {
    snprintf(view, sizeof view, "%s-%d.%d", whole, i, pid);
    if (!take_view(view, vertices, &source.sizes[i])) _exit(1);
  }
  const int to = open(part, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  const int nothing = open("/dev/null", O_WRONLY);
  if (to < 0 || nothing < 0 || chdir(words[1]) != 0) _exit(1);
  child_run(&(raw_request){&source, is_solid}, to, nothing);
}

/* 1: the stream has a mesh. What fails is left to the program, whose messages
 * name the file as it was given. */
static int is_mesh(const char *path) {
  wire_head last = {0};
  const int fd = open(path, O_RDONLY);
  const int there = fd >= 0 && lseek(fd, -(off_t)sizeof last, SEEK_END) >= 0 &&
                    read(fd, &last, sizeof last) == sizeof last;
  if (fd >= 0) close(fd);
  return there && last.magic == WIRE_MAGIC && last.kind == WIRE_END;
}

/* A request in a thread of its own: of the two forks that it would take
 * otherwise, each copies the map of libgmsh and all it is linked with. */
typedef struct request {
  const char *folder;
  int fd;
  char text[MOST], *words[HEAD + 2 * NUMBERS], whole[4200], part[4300];
} request;

static void *serve(void *data) {
  request *r = data;
  int code = 1, n = receive(r->fd, r->text, r->words);
  if (n > 0) {
    snprintf(r->whole, sizeof r->whole, "%s/%s", r->folder, r->words[0]);
    snprintf(r->part, sizeof r->part, "%s.%d", r->whole, r->fd);
    const pid_t pid = fork();
    if (pid == 0) make(r->whole, r->part, n, r->words);
    if (pid > 0 && waitpid(pid, &code, 0) == pid && code == 0 &&
        is_mesh(r->part))
      rename(r->part, r->whole);
    else
      unlink(r->part);
  }
  send(r->fd, "", 1, MSG_NOSIGNAL);
  close(r->fd);
  free(r);
  return NULL;
}

int main(int argc, char **argv) {
  struct sockaddr_un at = {.sun_family = AF_UNIX};
  const int fd = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  if (argc != 3 || fd < 0 || strlen(argv[2]) >= sizeof at.sun_path) return 1;
  snprintf(at.sun_path, sizeof at.sun_path, "%s", argv[2]);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  mesh_gmsh_load();
  if (bind(fd, (struct sockaddr *)&at, sizeof at) != 0 || listen(fd, 16) != 0)
    return 1;
  for (;;) {
    const int one = accept4(fd, NULL, NULL, SOCK_CLOEXEC);
    request *r = one < 0 ? NULL : calloc(1, sizeof *r);
    pthread_t thread;
    if (r == NULL) continue;
    *r = (request){.folder = argv[1], .fd = one};
    if (pthread_create(&thread, NULL, serve, r) != 0) return 1;
    pthread_detach(thread);
  }
}
