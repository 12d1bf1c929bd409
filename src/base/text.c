/* Text for files and messages: numbers, columns, text from outside. */
#include "base/text.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

char *text_buffer(void) {
  static _Thread_local char buffers[TEXT_BUFFERS][TEXT_BUFFER];
  static _Thread_local unsigned next;
  return buffers[next++ % TEXT_BUFFERS];
}

const char *text_of(const char *format, ...) {
  char *text = text_buffer();
  va_list args;
  va_start(args, format);
  vsnprintf(text, TEXT_BUFFER, format, args);
  va_end(args);
  return text;
}

void text_add(char *text, size_t size, const char *format, ...) {
  const size_t used = strlen(text);
  va_list args;
  va_start(args, format);
  vsnprintf(text + used, size - used, format, args);
  va_end(args);
}

const char *text_number(double value, int digits) {
  if (isnan(value)) return "NaN";
  if (isinf(value)) return value > 0 ? "Inf" : "-Inf";
  char *text = text_buffer();
  snprintf(text, TEXT_BUFFER, "%.*E", digits, value == 0 ? 0.0 : value);
  char *e = strchr(text, 'E');
  int exponent = atoi(e + 1);
  snprintf(e, text + TEXT_BUFFER - e, "E%c%03d", exponent < 0 ? '-' : '+',
           abs(exponent));
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

/* Well-formed UTF-8: first byte, and what the second may be (Unicode 3.9,
 * table 3-7); the bytes after those are 80..BF. */
static const struct {
  unsigned char first, last, low, high, length;
} utf8[] = {{0x00, 0x7F, 0x00, 0x00, 1}, {0xC2, 0xDF, 0x80, 0xBF, 2},
            {0xE0, 0xE0, 0xA0, 0xBF, 3}, {0xE1, 0xEC, 0x80, 0xBF, 3},
            {0xED, 0xED, 0x80, 0x9F, 3}, {0xEE, 0xEF, 0x80, 0xBF, 3},
            {0xF0, 0xF0, 0x90, 0xBF, 4}, {0xF1, 0xF3, 0x80, 0xBF, 4},
            {0xF4, 0xF4, 0x80, 0x8F, 4}};

/* Length of the sequence at s; 0: none there. */
static int utf8_length(const unsigned char *s) {
  for (size_t i = 0; i < sizeof utf8 / sizeof *utf8; ++i) {
    if (s[0] < utf8[i].first || s[0] > utf8[i].last) continue;
    int n = utf8[i].length;
    if (n > 1 && (s[1] < utf8[i].low || s[1] > utf8[i].high)) return 0;
    for (int k = 2; k < n; ++k)
      if ((s[k] & 0xC0) != 0x80) return 0;
    return n;
  }
  return 0;
}

/* Characters not shown, or that change others: C0, DEL, C1, marks of direction,
 * lines and joins, tags (Unicode, general categories Cc, Cf, Zl, Zp). */
static const struct {
  unsigned first, last;
} unseen[] = {{0x00, 0x08},     {0x0A, 0x1F},     {0x7F, 0x9F},
              {0xAD, 0xAD},     {0x061C, 0x061C}, {0x180E, 0x180E},
              {0x200B, 0x200F}, {0x2028, 0x202E}, {0x2060, 0x206F},
              {0xFEFF, 0xFEFF}, {0xFFF9, 0xFFFB}, {0xE0000, 0xE007F}};

static unsigned code_of(const unsigned char *s, int n) {
  unsigned code = n == 1 ? s[0] : s[0] & (0x7Fu >> n);
  for (int k = 1; k < n; ++k) code = code << 6 | (s[k] & 0x3Fu);
  return code;
}

static int is_seen(unsigned code) {
  for (size_t i = 0; i < sizeof unseen / sizeof *unseen; ++i)
    if (code >= unseen[i].first && code <= unseen[i].last) return 0;
  return 1;
}

int text_piece(const char **text, char piece[PIECE_SIZE]) {
  const unsigned char *s = (const unsigned char *)*text;
  int n = utf8_length(s), length = 0;
  piece[0] = '\0';
  if (*s == '\0') return 0;
  int seen = n > 0 && is_seen(code_of(s, n));
  if (n == 0) n = 1;
  *text += n;
  for (int k = 0; k < n && !seen; ++k)
    length +=
        snprintf(piece + length, PIECE_SIZE - (size_t)length, "\\x%02X", s[k]);
  if (!seen) return length;
  memcpy(piece, s, n);
  piece[n] = '\0';
  return n;
}

size_t text_shown(char *out, size_t size, const char *text) {
  char piece[PIECE_SIZE];
  size_t used = 0, n;
  while ((n = text_piece(&text, piece)) > 0 && used + n < size) {
    memcpy(out + used, piece, n);
    used += n;
  }
  out[used] = '\0';
  return used;
}

void text_shown_lines(char *out, size_t size, char *text) {
  size_t used = 0;
  char *rest = NULL;
  out[0] = '\0';
  for (char *line = strtok_r(text, "\n", &rest);
       line != NULL && used + 1 < size; line = strtok_r(NULL, "\n", &rest)) {
    if (used > 0) out[used++] = '\n';
    used += text_shown(out + used, size - used, line);
  }
}

void text_put(FILE *f, const char *text) {
  char piece[PIECE_SIZE];
  while (text_piece(&text, piece) > 0) fputs(piece, f);
}

/* The byte that \xHH at p denotes; -1: it is no such text. */
static int hidden_byte(const char *p) {
  static const char digits[] = "0123456789ABCDEF";
  if (p[0] != '\\' || p[1] != 'x' || p[2] == '\0' || p[3] == '\0') return -1;
  const char *high = strchr(digits, p[2]), *low = strchr(digits, p[3]);
  if (high == NULL || low == NULL) return -1;
  int byte = (int)(16 * (high - digits) + (low - digits));
  int plain = byte == 0 || byte == '\n' || (byte >= ' ' && byte < 0x7F);
  return plain ? -1 : byte;
}

void text_plain(char *text) {
  char *to = text;
  for (const char *p = text; *p != '\0'; ++to) {
    int byte = hidden_byte(p);
    *to = byte >= 0 ? (char)byte : *p;
    p += byte >= 0 ? 4 : 1;
  }
  *to = '\0';
}

void text_word(char *word, size_t size, const char *text) {
  size_t i = 0;
  for (; text[i] != '\0' && i + 1 < size; ++i)
    word[i] = isspace((unsigned char)text[i]) ? '_' : text[i];
  word[i] = '\0';
}

void _gfortran_concat_string(size_t n, char *to, size_t n_a, const char *a,
                             size_t n_b, const char *b) {
  if (n_a > n) n_a = n;
  if (n_b > n - n_a) n_b = n - n_a;
  memcpy(to, a, n_a);
  memcpy(to + n_a, b, n_b);
  memset(to + n_a + n_b, ' ', n - n_a - n_b);
}
