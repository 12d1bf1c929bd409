/*
 * Reading and writing numbers. A real is taken apart into digits and a power of
 * ten and handed to strtod as "DIGITSeEXPONENT": without a point, so that the
 * locale has no influence, and correctly rounded.
 */
#include "base/number.h"

#include "base/memory.h"
#include "base/text.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* More digits than 767 cannot change how a double is rounded, except one last
 * digit for a non-zero rest. */
enum { DIGITS = 800, EXPONENT_LIMIT = 1000000 };

typedef struct decimal {
  int negative;
  int n_digit;
  char digit[DIGITS + 2]; /* without leading zeros */
  long exponent;          /* value = digits * 10^exponent */
  int bare;               /* exponent without a letter: its digits, else 0 */
  int has_point;
} decimal;

static int is_digit(char c) { return c >= '0' && c <= '9'; }
static int is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

static const char *skip_blanks(const char *p) {
  while (is_blank(*p)) ++p;
  return p;
}

/* One of them may look like a blank or a minus sign. */
static int is_foreign(char c) { return (unsigned char)c >= 0x80; }

static const char *wrong_end(const char *p) {
  if (is_foreign(*p)) return "characters beyond ASCII after the number";
  if (is_letter(*p)) return "letters after the number";
  return "characters after the number";
}

static void add_digit(decimal *d, char c) {
  if (d->n_digit == 0 && c == '0') return;
  if (d->n_digit < DIGITS)
    d->digit[d->n_digit++] = c;
  else {
    if (c != '0') d->digit[DIGITS] = '1';
    if (d->exponent < EXPONENT_LIMIT) ++d->exponent;
  }
}

/* Digits with at most one point; NULL if there is no digit. */
static const char *read_mantissa(const char *p, decimal *d) {
  int any = 0;
  for (; is_digit(*p); ++p, any = 1) add_digit(d, *p);
  d->has_point = *p == '.';
  if (d->has_point) {
    for (++p; is_digit(*p); ++p, any = 1) {
      long before = d->exponent;
      int n = d->n_digit;
      add_digit(d, *p);
      /* A digit stored or a leading zero shifts; one dropped does not. */
      if (d->n_digit > n || n == 0) {
        if (d->exponent > -EXPONENT_LIMIT) --d->exponent;
      } else {
        d->exponent = before;
      }
    }
  }
  return any ? p : NULL;
}

/* Exponent after the mantissa, if any; NULL if its digits are missing. */
static const char *read_exponent(const char *p, decimal *d) {
  int letter = *p != '\0' && strchr("eEdD", *p) != NULL;
  if (!letter && *p != '+' && *p != '-') return p;
  p += letter;
  int negative = *p == '-';
  if (*p == '+' || *p == '-') ++p;
  if (!is_digit(*p)) return NULL;
  const char *start = p;
  long e = 0;
  for (; is_digit(*p); ++p)
    if (e < EXPONENT_LIMIT) e = 10 * e + (*p - '0');
  d->bare = letter ? 0 : (int)(p - start);
  d->exponent += negative ? -e : e;
  return p;
}

static const char *read_decimal(const char *text, decimal *d) {
  const char *p = skip_blanks(text);
  if (*p == '\0') return "empty";
  d->negative = *p == '-';
  if (*p == '+' || *p == '-') ++p;
  if (p[0] == '0' && (p[1] == 'x' || p[1] == 'X'))
    return "hexadecimal is not accepted";
  const char *end = read_mantissa(p, d);
  if (end == NULL)
    return is_foreign(*p) ? "characters beyond ASCII" : "not a number";
  p = read_exponent(end, d);
  if (p == NULL)
    return !is_letter(*end) || is_letter(end[1]) ? wrong_end(end)
                                                 : "exponent without digits";
  p = skip_blanks(p);
  return *p == '\0' ? NULL : wrong_end(p);
}

static const char *convert(decimal *d, double *value) {
  char text[DIGITS + 32];
  if (d->n_digit == 0) d->digit[d->n_digit++] = '0';
  if (d->n_digit == DIGITS && d->digit[DIGITS] == '1') {
    ++d->n_digit;
    --d->exponent;
  }
  snprintf(text, sizeof text, "%s%.*se%ld", d->negative ? "-" : "", d->n_digit,
           d->digit, d->exponent);
  int kept = errno;
  double x = strtod(text, NULL);
  errno = kept;
  if (!isfinite(x)) return "too large";
  *value = x;
  return NULL;
}

const char *number_column(const char *text, double *value) {
  decimal d = {.n_digit = 0};
  const char *wrong = read_decimal(text, &d);
  return wrong != NULL ? wrong : convert(&d, value);
}

/* Fortran writes a point, and two or three digits where it has no room for the
 * letter: what else looks so is a difference or a sum. */
const char *number_real(const char *text, double *value) {
  decimal d = {.n_digit = 0};
  const char *wrong = read_decimal(text, &d);
  if (wrong != NULL) return wrong;
  if (d.bare == 1 || (d.bare > 0 && !d.has_point))
    return "a sum, or an exponent without E";
  return convert(&d, value);
}

int number_bare_exponent(const char *text) {
  decimal d = {.n_digit = 0};
  return read_decimal(text, &d) == NULL && d.bare > 0;
}

const char *number_int(const char *text, int *value) {
  const char *p = skip_blanks(text);
  if (*p == '\0') return "empty";
  int negative = *p == '-';
  if (*p == '+' || *p == '-') ++p;
  if (!is_digit(*p)) return "not an integer";
  long n = 0;
  for (; is_digit(*p); ++p)
    if (n <= INT_MAX) n = 10 * n + (*p - '0');
  p = skip_blanks(p);
  if (*p != '\0') return "not an integer";
  if (negative) n = -n;
  if (n > INT_MAX || n < INT_MIN) return "too large";
  *value = (int)n;
  return NULL;
}

/* The decimal separator of the locale, of any length, becomes a point. */
static void put_point(char *text) {
  char *to = text;
  for (const char *from = text; *from != '\0'; ++from)
    if (strchr("+-e0123456789", *from) != NULL)
      *to++ = *from;
    else if (to == text || to[-1] != '.')
      *to++ = '.';
  *to = '\0';
}

void number_text(double value, char text[NUMBER_TEXT_SIZE]) {
  for (int digits = 15; digits <= 17; ++digits) {
    double back = 0;
    snprintf(text, NUMBER_TEXT_SIZE, "%.*g", digits, value);
    if (!isfinite(value)) return;
    put_point(text);
    if (number_real(text, &back) == NULL && back == value) return;
  }
}

int number_order(const void *a, const void *b) {
  const int x = *(const int *)a, y = *(const int *)b;
  return (x > y) - (x < y);
}

int number_pair_order(const void *a, const void *b) {
  const int first = number_order(a, b);
  return first != 0 ? first
                    : number_order((const int *)a + 1, (const int *)b + 1);
}

void number_pair_sort(void *item, size_t size, size_t n) {
  if (n > 0) qsort(item, n, size, number_pair_order);
}

int number_pair_end(const void *item, size_t size, int n, int i) {
  const char *first = (const char *)item + size * i, *next = first;
  while (i < n && number_pair_order(first, next) == 0) {
    next += size;
    ++i;
  }
  return i;
}

void *number_pair_find(const void *item, size_t size, int n, int a, int b) {
  const number_pair key = number_pair_of(a, b);
  return n == 0 ? NULL : bsearch(&key, item, n, size, number_pair_order);
}

int number_find(int number, const int *list, int n) {
  const int *at =
      n == 0 ? NULL : bsearch(&number, list, n, sizeof *list, number_order);
  return at == NULL ? -1 : (int)(at - list);
}

status number_places(int most, size_t n, const int *number, int per,
                     size_t **start, int **item) {
  PASS_NEW_ALL(OF(*start, most + 2), OF(*item, n));
  size_t *s = *start;
  for (size_t k = 0; k < n; ++k) ++s[number[k] + 2];
  for (int i = 0; i < most; ++i) s[i + 2] += s[i + 1];
  for (size_t k = 0; k < n; ++k)
    (*item)[s[number[k] + 1]++] = (int)(k / (size_t)per);
  return OK;
}

uint64_t number_hash(uint64_t h, const void *data, size_t n) {
  const unsigned char *at = data;
  for (size_t i = 0; i < n; ++i) h = (h ^ at[i]) * 1099511628211u;
  return h;
}
