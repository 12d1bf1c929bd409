/* The scanner. Lines are counted only when a failure names one. */
#include "mesh/msh/scan.h"

#include "base/base.h"
#include "base/file.h"
#include "base/system/input.h"

#include <ctype.h>
#include <errno.h>
#include <stdarg.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

enum { SHOWN = 24, WORD = 128, DIGITS = 18, POWERS = 27 };

/* ---- the file ------------------------------------------------------------ */

static status read_all(scan *s, int fd) {
  size_t got = 0;
  s->data = memory_new(s->size + 1, 1);
  if (s->data == NULL)
    RAISE(ERR_MEMORY, "%s: memory exhausted: its %zu bytes", s->path, s->size);
  while (got < s->size) {
    ssize_t n = read(fd, s->data + got, s->size - got);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0)
      RAISE(ERR_FILE, "%s: cannot be read: %s", s->path, strerror(errno));
    if (n == 0) RAISE(ERR_FILE, "%s: it became shorter while read", s->path);
    got += n;
  }
  return OK;
}

status scan_open(scan *s, const char *path, status wrong) {
  struct stat about;
  const char *why;
  *s = (scan){.path = path, .wrong = wrong};
  ENDS_BY(descriptor_leave) int fd = input_open(path, &why);
  if (fd < 0) RAISE(ERR_FILE, "%s: cannot be read: %s", path, why);
  if (fstat(fd, &about) != 0)
    RAISE(ERR_FILE, "%s: cannot be read: %s", path, strerror(errno));
  s->size = about.st_size;
  PASS(read_all(s, fd));
  if (s->size >= 3 && memcmp(s->data, "\xEF\xBB\xBF", 3) == 0) s->at = 3;
  return OK;
}

void scan_close(scan *s) {
  memory_free(s->data);
  *s = (scan){0};
}

status scan_fail(const scan *s, const char *format, ...) {
  char text[256];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  long line = 1;
  for (size_t i = 0; i < s->at; ++i) line += s->data[i] == '\n';
  if (s->binary_file) RAISE(s->wrong, "%s: byte %zu: %s", s->path, s->at, text);
  RAISE(s->wrong, "%s:%ld: %s", s->path, line, text);
}

/* ---- words --------------------------------------------------------------- */

static int is_digit(char c) { return c >= '0' && c <= '9'; }

static void skip_blanks(scan *s) {
  while (s->data[s->at] == ' ' || s->data[s->at] == '\t') ++s->at;
}

/* After a word: a blank, the end of the line or of the file. */
static int ends_word(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\0';
}

/* The next word, for a message. */
static status not_expected(const scan *s, const char *wanted) {
  char word[SHOWN + 1];
  size_t n = 0;
  for (; n < SHOWN && !ends_word(s->data[s->at + n]); ++n)
    word[n] =
        isprint((unsigned char)s->data[s->at + n]) ? s->data[s->at + n] : '?';
  word[n] = '\0';
  if (n == 0 && s->at + 1 >= s->size)
    return scan_fail(s, "the file ends where %s is expected: it is cut short",
                     wanted);
  if (n == 0)
    return scan_fail(s, "%s where %s is expected",
                     s->data[s->at] == '\0' ? "a zero byte" : "the line ends",
                     wanted);
  return scan_fail(s, "\"%s\" where %s is expected", word, wanted);
}

/* A whole number of at most 18 digits. */
static status word_whole(scan *s, int64_t least, int64_t most, int64_t *value) {
  skip_blanks(s);
  const char *start = s->data + s->at, *p = start + (*start == '-');
  int64_t v = 0;
  int n = 0;
  for (; is_digit(*p) && n < DIGITS; ++p, ++n) v = 10 * v + (*p - '0');
  if (*start == '-') v = -v;
  if (n == 0 || !ends_word(*p) || v < least || v > most) {
    char wanted[48];
    if (is_digit(*p))
      snprintf(wanted, sizeof wanted, "a whole number of at most %d digits",
               DIGITS);
    else if (v > most)
      snprintf(wanted, sizeof wanted, "a whole number up to %lld",
               (long long)most);
    else
      snprintf(wanted, sizeof wanted, "a whole number%s",
               least < 0 ? "" : " not below zero");
    return not_expected(s, wanted);
  }
  s->at += p - start;
  *value = v;
  return OK;
}

typedef struct decimal { /* mantissa * 10^power */
  uint64_t mantissa;     /* right up to DIGITS digits */
  int n_digit;           /* without leading zeros */
  int power;
} decimal;

static const char *read_digits(const char *p, decimal *d, int fraction) {
  for (; is_digit(*p); ++p) {
    d->n_digit += d->n_digit > 0 || *p != '0';
    if (d->n_digit <= DIGITS)
      d->mantissa = 10 * d->mantissa + (uint64_t)(*p - '0');
    d->power -= fraction;
  }
  return p;
}

/* The end of a number without sign, or NULL. */
static const char *read_decimal(const char *p, decimal *d) {
  const char *whole = read_digits(p, d, 0), *end = whole;
  if (*whole == '.') end = read_digits(whole + 1, d, 1);
  if (end - p - (*whole == '.') <= 0) return NULL;
  if (*end != 'e' && *end != 'E') return end;
  int sign = end[1] == '-' ? -1 : 1, e = 0;
  p = end + 1 + (end[1] == '-' || end[1] == '+');
  if (!is_digit(*p)) return NULL;
  for (; is_digit(*p); ++p)
    if (e < 10000) e = 10 * e + (*p - '0');
  d->power += sign * e;
  return p;
}

/* The nearest double where 64 bits of mantissa decide it; 0 if they do not. */
static int convert(const decimal *d, double *value) {
  static const long double ten[POWERS + 1] = {
      1e0L,  1e1L,  1e2L,  1e3L,  1e4L,  1e5L,  1e6L,  1e7L,  1e8L,  1e9L,
      1e10L, 1e11L, 1e12L, 1e13L, 1e14L, 1e15L, 1e16L, 1e17L, 1e18L, 1e19L,
      1e20L, 1e21L, 1e22L, 1e23L, 1e24L, 1e25L, 1e26L, 1e27L};
  if (d->n_digit > DIGITS || abs(d->power) > POWERS) return 0;
  long double v = (long double)d->mantissa;
  v = d->power < 0 ? v / ten[-d->power] : v * ten[d->power];
  *value = (double)v;
  return (double)(v - v * LDBL_EPSILON) == *value &&
         (double)(v + v * LDBL_EPSILON) == *value;
}

/* Words of printf for what is no number: the mesh says where they stand. */
static int not_finite(const char *word, double *value) {
  *value = strncasecmp(word, "nan", 3) == 0 ? (double)NAN : (double)INFINITY;
  return (strncasecmp(word, "nan", 3) == 0 ||
          strncasecmp(word, "inf", 3) == 0) &&
         ends_word(word[3]);
}

/* Any word that read_decimal took: correctly rounded, in any locale. */
static status convert_word(const scan *s, const char *word, size_t n,
                           double *value) {
  char text[WORD];
  if (n >= WORD) return not_expected(s, "a number of fewer digits");
  memcpy(text, word, n);
  text[n] = '\0';
  if (number_real(text, value) != NULL) *value = INFINITY; /* too large */
  return OK;
}

static status word_real(scan *s, double *value) {
  skip_blanks(s);
  const char *start = s->data + s->at;
  const char *p = start + (*start == '-' || *start == '+');
  decimal d = {0};
  const char *end = read_decimal(p, &d);
  if (end == NULL && not_finite(p, value))
    end = p + 3;
  else if (end == NULL || !ends_word(*end))
    return not_expected(s, "a number");
  else if (!convert(&d, value))
    PASS(convert_word(s, p, end - p, value));
  if (*start == '-') *value = -*value;
  s->at += end - start;
  return OK;
}

/* ---- numbers ------------------------------------------------------------- */

/* The next "size" bytes in the order of this machine. */
static status take_bytes(scan *s, void *to, size_t size) {
  if (s->size - s->at < size)
    return scan_fail(s, "the file ends inside a number");
  memcpy(to, s->data + s->at, size);
  s->at += size;
  unsigned char *b = to;
  for (size_t i = 0; s->swapped && i < size / 2; ++i) {
    unsigned char t = b[i];
    b[i] = b[size - 1 - i];
    b[size - 1 - i] = t;
  }
  return OK;
}

status scan_int(scan *s, int *value) {
  int32_t four = 0;
  int64_t word = 0;
  if (s->binary) {
    PASS(take_bytes(s, &four, sizeof four));
    *value = four;
  } else {
    PASS(word_whole(s, INT_MIN, INT_MAX, &word));
    *value = (int)word;
  }
  return OK;
}

status scan_size(scan *s, size_t *value) {
  uint64_t eight = 0;
  int64_t word = 0;
  if (s->binary) {
    PASS(take_bytes(s, &eight, sizeof eight));
    *value = (size_t)eight;
  } else {
    PASS(word_whole(s, 0, INT64_MAX, &word));
    *value = (size_t)word;
  }
  return OK;
}

status scan_real(scan *s, double *value) {
  return s->binary ? take_bytes(s, value, sizeof *value) : word_real(s, value);
}

status scan_fits(const scan *s, size_t n, size_t text_bytes,
                 size_t binary_bytes, const char *what) {
  if (n <= (s->size - s->at) / (s->binary ? binary_bytes : text_bytes))
    return OK;
  return scan_fail(s, "%zu %s do not fit into the rest of the file", n, what);
}

/* ---- lines and sections -------------------------------------------------- */

status scan_line(scan *s) {
  if (s->binary) return OK;
  skip_blanks(s);
  if (s->data[s->at] == '\r') ++s->at;
  if (s->data[s->at] == '\n') {
    ++s->at;
    return OK;
  }
  return s->at >= s->size ? OK : not_expected(s, "the end of the line");
}

static void skip_empty_lines(scan *s) {
  s->at += strspn(s->data + s->at, " \t\r\n");
}

status scan_quoted(scan *s, const char **text, size_t *length) {
  skip_blanks(s);
  if (s->data[s->at] != '"') return not_expected(s, "a name in \"quotes\"");
  *text = s->data + s->at + 1;
  *length = strcspn(*text, "\"\r\n");
  if ((*text)[*length] != '"') return scan_fail(s, "a name has no end");
  s->at += *length + 2;
  return OK;
}

/* 1 if $EndName is the next word. */
static int is_mark(const scan *s, size_t at, const char *name) {
  size_t k = strlen("$End"), n = strlen(name);
  return at + k + n <= s->size && memcmp(s->data + at, "$End", k) == 0 &&
         memcmp(s->data + at + k, name, n) == 0 &&
         ends_word(s->data[at + k + n]);
}

status scan_end(scan *s, const char *name, const char *what) {
  s->binary = 0;
  skip_empty_lines(s);
  if (s->at < s->size && is_mark(s, s->at, name)) {
    s->at += 4 + strlen(name);
    return scan_line(s);
  }
  return not_expected(s, text_of("$End%s (%s are complete)", name, what));
}

status scan_skip(scan *s, const char *name) {
  for (size_t at = s->at; at < s->size; ++at) {
    const char *dollar = memchr(s->data + at, '$', s->size - at);
    if (dollar == NULL) break;
    at = dollar - s->data;
    if (!is_mark(s, at, name)) continue;
    s->at = at;
    return scan_end(s, name, "its lines");
  }
  return scan_fail(s, "$%s has no $End%s: the file is cut short", name, name);
}

/* "2.2 0 8", and a one in binary files that shows the order of bytes. */
static status read_format(scan *s) {
  int bytes, one = 1;
  if (s->version > 0.0) return scan_fail(s, "$MeshFormat is given twice");
  PASS(scan_real(s, &s->version));
  PASS(scan_int(s, &s->binary_file));
  PASS(scan_int(s, &bytes));
  PASS(scan_line(s));
  if (s->binary_file < 0 || s->binary_file > 1 || bytes != 8)
    return scan_fail(s,
                     "$MeshFormat has file type %d, data size %d; 0 (ASCII) "
                     "or 1 (binary) and 8 are read",
                     s->binary_file, bytes);
  if (s->binary_file) {
    s->binary = 1;
    PASS(scan_int(s, &one));
    s->swapped = one == 1 << 24;
    if (one != 1 && !s->swapped)
      return scan_fail(s, "the mark of the order of bytes is damaged");
  }
  return scan_end(s, "MeshFormat", "its numbers");
}

status scan_section(scan *s, char name[SCAN_NAME]) {
  do {
    skip_empty_lines(s);
    name[0] = '\0';
    if (s->at >= s->size) return OK;
    size_t n = 0;
    const char *p = s->data + s->at;
    if (*p != '$') return not_expected(s, "$ and the name of a section");
    while (!ends_word(p[n + 1]) && n + 1 < SCAN_NAME) ++n;
    memcpy(name, p + 1, n);
    name[n] = '\0';
    if (n == 0 || !ends_word(p[n + 1]) || strncmp(name, "End", 3) == 0)
      return not_expected(s, "the start of a section");
    s->at += n + 1;
    PASS(scan_line(s));
    if (strcmp(name, "MeshFormat") == 0) PASS(read_format(s));
  } while (strcmp(name, "MeshFormat") == 0);
  return OK;
}

void scan_start_binary(scan *s) { s->binary = s->binary_file; }
