/*
 * Numbers as the Fortran codes write them: 1  1.  .5  1.5E3  1.5D+03  1.5+03.
 * Refused: nan, inf, hexadecimal, trailing letters, overflow, empty text.
 */
#ifndef PROTIS_BASE_NUMBER_H
#define PROTIS_BASE_NUMBER_H

/* NULL and the value, or what is wrong in a few words ("not a number", ...).
 * The text may have blanks before and after the number. The answer does not
 * depend on the locale. Underflow gives the nearest double, zero included. */
const char *number_real(const char *text, double *value);
const char *number_int(const char *text, int *value);

#endif
