/* Option tables: reading, writing, words of a choice, nearest word. */
#include "base/option.h"

#include "base/number.h"
#include "base/text.h"

#include <float.h>
#include <math.h>
#include <string.h>

const option *option_find(const option *table, const char *name) {
  if (table == NULL) return NULL;
  for (const option *row = table; row->name != NULL; ++row)
    if (strcmp(row->name, name) == 0) return row;
  return NULL;
}

/* Length of the word of a choice list that starts here. */
static size_t word_length(const char *word) { return strcspn(word, "|"); }

/* Equal without regard to case and to how many blanks stand in a gap. */
static int same_word(const char *a, size_t n, const char *b) {
  const char *end = a + n;
  while (is_blank(*b)) ++b;
  while (a < end) {
    if (is_blank(*a)) {
      if (!is_blank(*b)) return 0;
      while (a < end && is_blank(*a)) ++a;
      while (is_blank(*b)) ++b;
    } else if (upper_case(*a++) != upper_case(*b++)) {
      return 0;
    }
  }
  while (is_blank(*b)) ++b;
  return *b == '\0';
}

int choice_rank(const char *choices, const char *word) {
  int rank = 0;
  for (const char *p = choices;; ++rank) {
    size_t n = word_length(p);
    if (n > 0 && same_word(p, n, word)) return rank;
    if (p[n] == '\0') return -1;
    p += n + 1;
  }
}

void choice_word(const char *choices, int rank, char *text, size_t size) {
  const char *p = choices;
  for (; rank > 0; --rank) {
    p += word_length(p);
    if (*p == '\0') break;
    ++p;
  }
  snprintf(text, size, "%.*s", (int)word_length(p), p);
}

/* Distances: omission, insertion, exchange of a letter or of two neighbours
 * count 1 (optimal string alignment). Words longer than this are not near. */
enum { WORD_MAX = 64 };

static int smaller(int a, int b) { return a < b ? a : b; }

static int word_distance(const char *a, int n, const char *b, int m) {
  int row[3][WORD_MAX + 1];
  for (int j = 0; j <= m; ++j) row[0][j] = j;
  for (int i = 1; i <= n; ++i) {
    int *now = row[i % 3], *before = row[(i + 2) % 3],
        *older = row[(i + 1) % 3];
    now[0] = i;
    for (int j = 1; j <= m; ++j) {
      char ca = upper_case(a[i - 1]), cb = upper_case(b[j - 1]);
      int d = smaller(before[j], now[j - 1]) + 1;
      d = smaller(d, before[j - 1] + (ca != cb));
      if (i > 1 && j > 1 && ca == upper_case(b[j - 2]) &&
          upper_case(a[i - 2]) == cb)
        d = smaller(d, older[j - 2] + 1);
      now[j] = d;
    }
  }
  return row[n % 3][m];
}

static int starts_with(const char *word, const char *start, int n) {
  for (int i = 0; i < n; ++i)
    if (upper_case(word[i]) != upper_case(start[i])) return 0;
  return 1;
}

/* One of the two begins with the other, at least three letters of it. */
static int is_beginning(const char *word, int n, const char *candidate, int m) {
  int least = smaller(n, m);
  return least >= 3 && m != n && starts_with(candidate, word, least);
}

const char *nearest_word(const char *word,
                         const char *(*next)(const void *ctx, int i),
                         const void *ctx) {
  int n = (int)strnlen(word, WORD_MAX + 1), best = 2 + n / 4;
  const char *found = NULL, *longer = NULL, *candidate;
  if (n > WORD_MAX) return NULL;
  if (best > n) best = n; /* something of the word must remain */
  for (int i = 0; (candidate = next(ctx, i)) != NULL; ++i) {
    int m = (int)strnlen(candidate, WORD_MAX + 1);
    if (m > WORD_MAX) continue;
    if (longer == NULL && is_beginning(word, n, candidate, m))
      longer = candidate;
    if (m - n >= best || n - m >= best) continue;
    int d = word_distance(word, n, candidate, m);
    if (d < best) {
      best = d;
      found = candidate;
    }
  }
  return longer != NULL && best > 1 ? longer : found;
}

const char *candidate_name(const void *names, int i) {
  const name_list *l = names;
  const char *p;
  if (i >= l->n) return NULL;
  const char *row = (const char *)l->first + i * l->size;
  memcpy(&p, row + l->offset, sizeof p);
  if (p != NULL && l->behind > 0) memcpy(&p, p + l->behind - 1, sizeof p);
  return p;
}

enum { CHOICE_TEXT = 1024, CHOICE_WORDS = 64 };

typedef struct word_list {
  int n;
  char text[CHOICE_TEXT];
  const char *word[CHOICE_WORDS]; /* [n] in text */
} word_list;

static void split_choices(const char *choices, word_list *list) {
  snprintf(list->text, sizeof list->text, "%s", choices);
  list->n = 0;
  for (char *p = list->text; list->n < CHOICE_WORDS;) {
    list->word[list->n++] = p;
    p += word_length(p);
    if (*p == '\0') return;
    *p++ = '\0';
  }
}

static int read_choice(const option *row, const char *text, int *rank,
                       char *why, size_t why_size) {
  *rank = choice_rank(row->choices, text);
  if (*rank >= 0) return 0;
  word_list list;
  split_choices(row->choices, &list);
  const char *near =
      nearest_word(text, candidate_name,
                   &(name_list){list.word, list.n, sizeof *list.word, 0, 0});
  if (near != NULL)
    snprintf(why, why_size, "'%s' is none of %s; did you mean %s?", text,
             row->choices, near);
  else
    snprintf(why, why_size, "'%s' is none of %s", text, row->choices);
  return -1;
}

void range_text(double x, double min, double max, char *why, size_t why_size) {
  int no_min = min <= -DBL_MAX, no_max = max >= DBL_MAX;
  char value[NUMBER_TEXT_SIZE], low[NUMBER_TEXT_SIZE], high[NUMBER_TEXT_SIZE];
  number_text(x, value);
  number_text(min, low);
  number_text(max, high);
  if (!isfinite(x))
    snprintf(why, why_size, "%s is not a finite number", value);
  else if (x <= 0.0 && min == DBL_MIN)
    snprintf(why, why_size, "%s is not positive", value);
  else if (no_max)
    snprintf(why, why_size, "%s below %s", value, low);
  else if (no_min || min == DBL_MIN)
    snprintf(why, why_size, "%s above %s", value, high);
  else
    snprintf(why, why_size, "%s outside [%s, %s]", value, low, high);
}

static int check_range(const option *row, double x, char *why,
                       size_t why_size) {
  if (x >= row->min && x <= row->max) return 0;
  int whole = row->type == OPT_INT;
  range_text(x, whole && row->min <= INT_MIN ? -DBL_MAX : row->min,
             whole && row->max >= INT_MAX ? DBL_MAX : row->max, why, why_size);
  return -1;
}

static int read_int(const option *row, const char *text, int *out, char *why,
                    size_t why_size) {
  int n = 0;
  const char *wrong = number_int(text, &n);
  if (wrong != NULL) {
    snprintf(why, why_size, "%s: '%s'", wrong, text);
    return -1;
  }
  if (check_range(row, n, why, why_size) != 0) return -1;
  *out = n;
  return 0;
}

/* A number whose unit is % may bear the sign: text without it, into digits. */
static const char *without_percent(const option *row, const char *text,
                                   char *digits, size_t size) {
  size_t n = strlen(text);
  if (strcmp(row->unit, "%") != 0 || text[n - 1] != '%' || n > size)
    return text;
  for (--n; n > 0 && text[n - 1] == ' ';) --n;
  snprintf(digits, size, "%.*s", (int)n, text);
  return digits;
}

static int read_real(const option *row, const char *text, double *out,
                     char *why, size_t why_size) {
  double x = 0;
  char digits[NUMBER_TEXT_SIZE];
  int rank = row->choices == NULL ? -1 : choice_rank(row->choices, text);
  if (rank >= 0) {
    *out = OPTION_WORD(rank);
    return 0;
  }
  const char *wrong =
      number_real(without_percent(row, text, digits, sizeof digits), &x);
  if (wrong != NULL) {
    snprintf(why, why_size, "%s: '%s'", wrong, text);
    return -1;
  }
  if (check_range(row, x, why, why_size) != 0) return -1;
  *out = x;
  return 0;
}

static int read_flag(const char *text, int *out, char *why, size_t why_size) {
  int rank = text == NULL ? 1 : choice_rank("NO|YES", text);
  if (rank < 0) {
    snprintf(why, why_size, "'%s' is neither YES nor NO", text);
    return -1;
  }
  *out = rank;
  return 0;
}

int option_read(const option *row, const char *text, void *parameters,
                char *why, size_t why_size) {
  void *field = (char *)parameters + row->offset;
  if (row->type == OPT_FLAG) return read_flag(text, field, why, why_size);
  if (text == NULL && row->type == OPT_CHOICE &&
      choice_rank(row->choices, "YES") > 0)
    text = "YES";
  if (text == NULL || *text == '\0') {
    snprintf(why, why_size, "a value is needed");
    return -1;
  }
  switch (row->type) {
    case OPT_INT:
      return read_int(row, text, field, why, why_size);
    case OPT_REAL:
      return read_real(row, text, field, why, why_size);
    case OPT_CHOICE: {
      int rank;
      if (read_choice(row, text, &rank, why, why_size) != 0) return -1;
      *(int *)field = rank;
      return 0;
    }
    default:
      *(const char **)field = text;
      return 0;
  }
}

void option_defaults(const option *table, void *parameters) {
  char why[256];
  if (table == NULL) return;
  for (const option *row = table; row->name != NULL; ++row)
    if (row->initial != NULL && strcmp(row->initial, OPTION_ABSENT) != 0)
      (void)option_read(row, row->initial, parameters, why, sizeof why);
}

void option_write(const option *row, const void *parameters, char *text,
                  size_t size) {
  const void *field = (const char *)parameters + row->offset;
  char number[NUMBER_TEXT_SIZE];
  switch (row->type) {
    case OPT_INT:
      snprintf(text, size, "%d", *(const int *)field);
      return;
    case OPT_REAL: {
      double x = *(const double *)field;
      if (row->choices != NULL && x < 0.0) {
        choice_word(row->choices, (int)(-1.0 - x), text, size);
        return;
      }
      number_text(x, number);
      snprintf(text, size, "%s", number);
      return;
    }
    case OPT_FLAG:
      snprintf(text, size, "%s", *(const int *)field ? "YES" : "NO");
      return;
    case OPT_CHOICE:
      choice_word(row->choices, *(const int *)field, text, size);
      return;
    case OPT_NAME: {
      const char *name = *(const char *const *)field;
      snprintf(text, size, "%s", name != NULL ? name : "");
      return;
    }
  }
}

enum { MANUAL_INDENT = 20 };

/* " in [0, 2]", or one side alone where no number passes the other. */
static void print_range(const option *o, FILE *out) {
  if (o->max < DBL_MAX && o->min == DBL_MIN)
    fprintf(out, " in ]0, %g]", o->max);
  else if (o->max < DBL_MAX)
    fprintf(out, " in [%g, %g]", o->min, o->max);
  else if (o->min == DBL_MIN)
    fputs(" > 0", out);
  else if (o->min > -DBL_MAX)
    fprintf(out, " >= %g", o->min);
}

static void print_row(const option *o, FILE *out) {
  static const char *const type[] = {"integer", "real", "YES or NO", "text",
                                     "word"};
  fprintf(out, "  %-15s %s", o->name,
          o->type == OPT_CHOICE ? o->choices : type[o->type]);
  if (o->type == OPT_REAL || o->type == OPT_INT) {
    print_range(o, out);
    fprintf(out, ", unit %s", o->unit);
    if (o->choices != NULL) fprintf(out, "; or %s", o->choices);
  }
  if (o->initial == NULL)
    fprintf(out, "; must be given");
  else if (strcmp(o->initial, OPTION_ABSENT) != 0)
    fprintf(out, "; default %s", o->initial);
  fprintf(out, "\n%*s", MANUAL_INDENT, "");
  text_wrap(out, o->help, MANUAL_INDENT);
}

void option_print(const option *table, FILE *out) {
  for (const option *o = table; o != NULL && o->name != NULL; ++o)
    print_row(o, out);
}
