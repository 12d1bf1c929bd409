/* Choice of the reader, and its failure as a message of the deck. */
#include "exchange/exchange.h"

#include "base/base.h"
#include "base/file.h"
#include "base/system/input.h"
#include "exchange/parts.h"

#include <errno.h>

/*
 * A linear complementarity problem as text: n, the matrix M by rows, q. Numbers
 * are parted by blanks, commas, semicolons or line ends; # starts a comment
 * that ends with its line. A byte order mark may precede it.
 */

/* Up to FEW_UNKNOWNS the place where a short file ends is reported. */
enum { WORD = 80, FEW_UNKNOWNS = 300 };

typedef struct words {
  FILE *f;
  const char *path;
  int line_no;      /* of the next character */
  int word_line_no; /* of the last word */
} words;

static int is_gap(int c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',' ||
         c == ';';
}

/* The next character that counts: comments are skipped. */
static int next_char(words *w) {
  int c = getc(w->f);
  if (c == '#')
    while (c != '\n' && c != EOF) c = getc(w->f);
  if (c == '\n') ++w->line_no;
  return c;
}

/* The next word; empty at the end of the file. Messages show none: the file may
 * be another one than is meant. */
static status next_word(words *w, char word[WORD]) {
  int c, n = 0;
  do c = next_char(w);
  while (is_gap(c));
  w->word_line_no = w->line_no;
  for (; c != EOF && !is_gap(c); c = next_char(w)) {
    if (n + 1 == WORD)
      RAISE(ERR_DECK,
            "%s:%d: a word of more than %d characters; expected a "
            "number",
            w->path, w->word_line_no, WORD - 1);
    word[n++] = (char)c;
  }
  word[n] = '\0';
  if (ferror(w->f)) PASS(text_failed(w->path, "read", errno));
  return OK;
}

static status next_real(words *w, const char *what, int row, double *value) {
  char word[WORD];
  PASS(next_word(w, word));
  if (word[0] == '\0')
    RAISE(ERR_DECK, "%s: the file ends in %s %d", w->path, what, row);
  const char *wrong = number_real(word, value);
  if (wrong != NULL)
    RAISE(ERR_DECK, "%s:%d: %s %d: %s", w->path, w->word_line_no, what, row,
          wrong);
  return OK;
}

static status read_size(words *w, int *n) {
  char word[WORD];
  PASS(next_word(w, word));
  const char *wrong = number_int(word, n);
  if (wrong != NULL || *n < 0 || *n > MOST_UNKNOWNS)
    RAISE(ERR_DECK, "%s: expected at its start the number of unknowns, 0 to %d",
          w->path, (int)MOST_UNKNOWNS);
  return OK;
}

/* The file is long enough for n unknowns; checked before memory is
 * allocated. */
static status check_length(words *w, int n) {
  const long here = ftell(w->f);
  const long end = here < 0 || fseek(w->f, 0, SEEK_END) != 0 ? -1 : ftell(w->f);
  if (end < 0) PASS(text_failed(w->path, "read", errno));
  const long left = end - here, m = n;
  if (left < 2 * m * (m + 1) - 1)
    RAISE(ERR_DECK,
          "%s: %ld characters follow the number of unknowns %d; expected %ld "
          "numbers",
          w->path, left, n, m * (m + 1));
  if (fseek(w->f, here, SEEK_SET) != 0)
    PASS(text_failed(w->path, "read", errno));
  return OK;
}

static status read_numbers(words *w, exchange_problem *p) {
  char word[WORD];
  PASS(read_size(w, &p->n));
  if (p->n > FEW_UNKNOWNS) PASS(check_length(w, p->n));
  p->dim = 1;
  p->m = p->unknowns = p->n;
  p->form = "linear complementarity problem";
  PASS(require_problem_memory(p->m));
  size_t m = p->m;
  PASS_NEW_ALL(OF(p->matrix, m * m), OF(p->load, m));
  for (size_t i = 0; i < m; ++i)
    for (size_t j = 0; j < m; ++j)
      PASS(next_real(w, "row", (int)i + 1, &p->matrix[i + m * j]));
  for (size_t i = 0; i < m; ++i)
    PASS(next_real(w, "q, item", (int)i + 1, &p->load[i]));
  PASS(next_word(w, word));
  if (word[0] != '\0')
    RAISE(ERR_DECK,
          "%s:%d: more follows the last item of q; numbers expected: %d",
          w->path, w->word_line_no, p->n * (p->n + 1) + 1);
  return OK;
}

/* The same for a text. */
static status lcp_text_read(const char *path, exchange_problem *p) {
  const char *why = NULL;
  ENDS_BY(file_leave) FILE *f = input_stream(path, &why);
  if (f == NULL) RAISE(ERR_FILE, "%s: cannot be read: %s", path, why);
  errno = 0;
  if (getc(f) != 0xEF || getc(f) != 0xBB || getc(f) != 0xBF) rewind(f);
  return read_numbers(&(words){.path = path, .line_no = 1, .f = f}, p);
}

/* 1: HDF5 starts here, or at 512, 1024, 2048, ... bytes, behind what others
 * put before it. */
static int is_hdf5(FILE *f) {
  char start[8];
  for (long at = 0; fseek(f, at, SEEK_SET) == 0 &&
                    fread(start, 1, sizeof start, f) == sizeof start;
       at = at == 0 ? 512 : 2 * at)
    if (memcmp(start, "\x89HDF\r\n\x1a\n", sizeof start) == 0) return 1;
  return 0;
}

static status type_of(const char *path, exchange_type *type) {
  const char *why = NULL;
  ENDS_BY(file_leave) FILE *f = input_stream(path, &why);
  if (f == NULL) RAISE(ERR_FILE, "%s: cannot be read: %s", path, why);
  errno = 0;
  if (*type == EXCHANGE_BY_CONTENT)
    *type = is_hdf5(f) ? EXCHANGE_FCLIB : EXCHANGE_LCP;
  if (errno != 0) PASS(text_failed(path, "read", errno));
  return OK;
}

status exchange_read(const char *path, exchange_type type, const place *at,
                     message_log *log, exchange_problem **out) {
  status st = OK;
  exchange_problem *p = NULL;
  *out = NULL;
  PASS_NEW(p, 1);
  OWNS(p);
  TRY(type_of(path, &type));
  if (type == EXCHANGE_FCLIB)
    TRY(fclib_read(path, p));
  else
    TRY(lcp_text_read(path, p));
  *out = p;
done:
  if (st == ERR_FILE) message_add(log, P5001, at, "%s", status_message());
  if (st == ERR_DECK) message_add(log, P5002, at, "%s", status_message());
  if (st != OK) memory_free(p);
  return st;
}
