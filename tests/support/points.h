/*
 * Points of torture: how many are tried, which, and one line in the end that
 * "make torture" collects: "TALLY kind | tried | survived | lost".
 */
#pragma once

typedef struct points {
  const char *kind;
  long tried, lost;
  char first[400]; /* what was lost first                                   */
} points;

/* 1: the long run; 0: the few of the tests. */
int points_all(void);
/* PROTIS_POINTS times the share, at least 1; without it the few of the tests.
 */
long points_number(long few, double share);
/* Point number k (from 0) of n, spread over 1 .. all, the first and the last
 * among them; n = 1: in the middle; n >= all: each once. */
long points_spread(long k, long n, long all);
void points_try(points *t); /* one more is tried                             */
/* One is lost; printf format tells which and how. */
void points_lose(points *t, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* Print the line; check fails if one was lost or none was tried. */
void points_end(const points *t);
