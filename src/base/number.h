/*
 * Numbers as the Fortran codes write them: 1  1.  .5  1.5E3  1.5D+03  1.5+03.
 * Refused: nan, inf, hexadecimal, trailing letters, overflow, empty text.
 */
#pragma once

#include "base/status.h"

#include <stddef.h>
#include <stdint.h>

enum { NUMBER_TEXT_SIZE = 32 };
/* Largest numbers that are computed with: products of two are finite. */
#define NUMBER_MOST 0x1p480

/* NULL and the value, or what is wrong in a few words ("not a number", ...).
 * The text may have blanks before and after the number. The answer does not
 * depend on the locale. Underflow gives the nearest double, zero included. */
const char *number_real(const char *text, double *value);
/* The same in fixed columns, where 1.5-3 and 15+2 are numbers too. */
const char *number_column(const char *text, double *value);
const char *number_int(const char *text, int *value);
/* 1 if the text is a number whose exponent has a sign but no letter (1.5+03);
 * the same text is a sum in an expression. */
int number_bare_exponent(const char *text);
/* Fewest digits that number_real takes back exactly; a point in any locale. */
void number_text(double value, char text[NUMBER_TEXT_SIZE]);

/* FNV-1a of n bytes, after those of h or HASH_START. */
#define HASH_START 14695981039346656037u
uint64_t number_hash(uint64_t h, const void *data, size_t n);

/* For qsort and bsearch: an int; the two ints an item starts with. */
int number_order(const void *a, const void *b);
int number_pair_order(const void *a, const void *b);
typedef struct number_pair {
  int a, b; /* a <= b */
} number_pair;
static inline number_pair number_pair_of(int a, int b) {
  return (number_pair){a < b ? a : b, a < b ? b : a};
}
/* Item[n] by their pairs; one past the last that has the pair of item i. */
#define PAIR_SORT(item, n) number_pair_sort((item), sizeof *(item), (size_t)(n))
#define PAIR_END(item, n, i) number_pair_end((item), sizeof *(item), (n), (i))
void number_pair_sort(void *item, size_t size, size_t n);
int number_pair_end(const void *item, size_t size, int n, int i);
/* The item of the pair of a and b among item[n] in their order, or NULL. */
#define PAIR_FIND(item, n, a, b) \
  number_pair_find((item), sizeof *(item), (n), (a), (b))
void *number_pair_find(const void *item, size_t size, int n, int a, int b);
/* Place in list[n], which ascends; -1: it is not there. */
int number_find(int number, const int *list, int n);

/* Where each i of 0 .. most-1 stands in number[n], items of "per" numbers: in
 * the items (*item)[(*start)[i] .. (*start)[i+1]), ascending; both are new. */
status number_places(int most, size_t n, const int *number, int per,
                     size_t **start, int **item);
