/*
 * Text files: opened, written line by line, and checked.
 */
#include "base/text.h"

#include "base/file.h"
#include "base/memory.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

char *text_path(const char *dir, const char *name, const char *suffix) {
  const char *slash = "";
  if (dir == NULL) dir = "";
  if (dir[0] != '\0' && dir[strlen(dir) - 1] != '/') slash = "/";
  size_t size = strlen(dir) + strlen(name) + strlen(suffix) + 3;
  char *path = memory_new(size, 1);
  if (path != NULL) snprintf(path, size, "%s%s%s.%s", dir, slash, name, suffix);
  return path;
}

enum { BUFFER = 1 << 16 };

status text_failed(const char *path, const char *doing, int error_no) {
  status st = error_no == ENOMEM ? ERR_MEMORY : ERR_FILE;
  return status_fail(st, __func__, __LINE__, "%s: cannot %s: %s", path, doing,
                     error_no != 0 ? strerror(error_no) : "unknown reason");
}

static status take(text_file *t, const char *path, FILE *f, int by_line) {
  status st = OK;
  t->f = f;
  t->path = memory_text(path);
  if (t->path == NULL)
    FAIL(ERR_MEMORY, "memory exhausted: the name of %s", path);
  setvbuf(f, NULL, by_line ? _IOLBF : _IOFBF, BUFFER);
done:
  return st;
}

status text_open(text_file *t, const char *path, int by_line) {
  status st = OK;
  TRY(file_clear(path));
  errno = 0;
  FILE *f = fopen(path, "wx");
  if (f == NULL) TRY(text_failed(path, "open for writing", errno));
  TRY(take(t, path, f, by_line));
done:
  return st;
}

status text_reopen(text_file *t, const char *path, int by_line, long length) {
  status st = OK;
  const char *why = NULL;
  FILE *f = NULL;
  int fd = file_descriptor(AT_FDCWD, path, O_RDWR | O_NOFOLLOW, &why);
  if (fd >= 0 && (f = fdopen(fd, "r+")) == NULL) {
    why = strerror(errno);
    close(fd);
  }
  if (f == NULL)
    FAIL(ERR_FILE, "%s: cannot open to go on with it: %s", path, why);
  TRY(take(t, path, f, by_line));
  if (fseek(t->f, 0, SEEK_END) != 0) TRY(text_failed(path, "read", errno));
  if (ftell(t->f) < length)
    FAIL(ERR_FILE, "%s is shorter than when the restart file was written",
         path);
  if (ftruncate(fileno(t->f), length) != 0 ||
      fseek(t->f, length, SEEK_SET) != 0)
    TRY(text_failed(path, "cut", errno));
done:
  return st;
}

/* A write that failed inside fprintf has left no reason: ask for it again. */
static int reason_again(FILE *f) {
  errno = 0;
  return write(fileno(f), "\n", 1) < 0 ? errno : 0;
}

status text_check(text_file *t) {
  if (t->f == NULL) return OK;
  int bad = ferror(t->f), error_no = 0;
  errno = 0;
  if (fflush(t->f) != 0) {
    bad = 1;
    error_no = errno;
  }
  if (!bad) return OK;
  if (error_no == 0) error_no = reason_again(t->f);
  return text_failed(t->path, "write", error_no);
}

status text_sync(text_file *t, long *length) {
  status st = OK;
  TRY(text_check(t));
  *length = t->f == NULL ? -1 : ftell(t->f);
  if (t->f != NULL && fsync(fileno(t->f)) != 0)
    TRY(text_failed(t->path, "write", errno));
done:
  return st;
}

status text_close(text_file *t) {
  status st = OK;
  if (t->f != NULL) {
    st = text_check(t);
    errno = 0;
    if (fclose(t->f) != 0 && st == OK)
      st = text_failed(t->path, "close", errno);
    t->f = NULL;
  }
  memory_free(t->path);
  t->path = NULL;
  return st;
}

status text_replace(const char *path, const void *what,
                    void (*write)(FILE *f, const void *what)) {
  status st = OK;
  text_file file = {0};
  char *aside = text_path("", path, "tmp");
  if (aside == NULL) FAIL(ERR_MEMORY, "memory exhausted: name of %s", path);
  TRY(text_open(&file, aside, 0));
  write(file.f, what);
  TRY(text_close(&file));
  if (rename(aside, path) != 0) TRY(text_failed(path, "replace", errno));
done:
  if (st != OK) {
    text_close(&file);
    if (aside != NULL) unlink(aside);
  }
  memory_free(aside);
  return st;
}

/* printf gives two digits of the exponent below 100. */
const char *text_number(char text[NUMBER_SIZE], double value, int digits) {
  if (isnan(value)) return strcpy(text, "NaN");
  if (isinf(value)) return strcpy(text, value > 0 ? "Inf" : "-Inf");
  snprintf(text, NUMBER_SIZE, "%.*E", digits, value == 0 ? 0.0 : value);
  char *e = strchr(text, 'E');
  int exponent = atoi(e + 1);
  snprintf(e, (size_t)(text + NUMBER_SIZE - e), "E%c%03d",
           exponent < 0 ? '-' : '+', abs(exponent));
  return text;
}

void text_cell(FILE *f, const char *text, int width) {
  fprintf(f, " %*s", width - 1, text);
}

void text_wrap(FILE *f, const char *text, int indent) {
  enum { WIDTH = 78 };
  int column = indent;
  while (*text != '\0') {
    int length = (int)strcspn(text, " ");
    if (column > indent && column + 1 + length > WIDTH) {
      fprintf(f, "\n%*s", indent, "");
      column = indent;
    }
    column += fprintf(f, "%s%.*s", column > indent ? " " : "", length, text);
    text += length;
    text += strspn(text, " ");
  }
  fputc('\n', f);
}

void text_word(char *word, size_t size, const char *text) {
  size_t i = 0;
  for (; text[i] != '\0' && i + 1 < size; ++i)
    word[i] = isspace((unsigned char)text[i]) ? '_' : text[i];
  word[i] = '\0';
}
