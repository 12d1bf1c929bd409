/*
 * The examples that the program carries with it: lists them, copies one.
 */
#include "manual/embedded.h"
#include "manual/manual.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* The deck that has the name of its folder. */
static int is_main_deck(const embedded_file *f) {
  const size_t n = strlen(f->folder);
  return strncmp(f->name, f->folder, n) == 0 &&
         strcmp(f->name + n, ".inp") == 0;
}

const char *example_name(const void *ctx, int i) {
  (void)ctx;
  for (const embedded_file *f = embedded_files; f->folder != NULL; ++f)
    if (is_main_deck(f) && i-- == 0) return f->folder;
  return NULL;
}

void examples_print(FILE *out) {
  static const char card[] = "*HEADING\n";
  for (const embedded_file *f = embedded_files; f->folder != NULL; ++f) {
    if (!is_main_deck(f)) continue;
    const char *at = strstr(f->text, card);
    const char *title = at == NULL ? "" : at + sizeof card - 1;
    fprintf(out, "%-18s %.*s\n", f->folder, (int)strcspn(title, "\n"), title);
  }
  fputs("protis --example NAME copies one into the current folder\n", out);
}

/* As a file of the current folder, which must not be there. */
static status write_new(const embedded_file *f) {
  int fd = open(f->name, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW, 0666);
  if (fd < 0) RAISE(ERR_FILE, "%s: cannot write: %s", f->name, strerror(errno));
  FILE *out = fdopen(fd, "w");
  size_t n = out == NULL ? 0 : fwrite(f->text, 1, f->size, out);
  int failed = out == NULL ? close(fd) != 0 : fclose(out) != 0;
  if (n != f->size || failed)
    RAISE(ERR_FILE, "%s: cannot write: %s", f->name, strerror(errno));
  return OK;
}

status example_copy(const char *name, FILE *out) {
  struct stat info;
  int found = 0;
  for (const embedded_file *f = embedded_files; f->folder != NULL; ++f) {
    if (strcmp(f->folder, name) != 0) continue;
    found |= is_main_deck(f);
    if (lstat(f->name, &info) == 0)
      RAISE(ERR_FILE, "%s is there already; nothing is copied", f->name);
  }
  if (!found) RAISE(ERR_DECK, "there is no example %s", name);
  for (const embedded_file *f = embedded_files; f->folder != NULL; ++f) {
    if (strcmp(f->folder, name) != 0) continue;
    PASS(write_new(f));
    fprintf(out, "%s\n", f->name);
  }
  return OK;
}
