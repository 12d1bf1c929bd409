/*
 * Random numbers that are the same on every machine.
 */
#include "decks/deck.h"

unsigned long long random_next(random_source *r) {
  unsigned long long z = r->state += 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

double random_real(random_source *r, double from, double to) {
  return from + (to - from) * (double)(random_next(r) >> 11) * 0x1p-53;
}

int random_pick(random_source *r, int n) {
  return (int)(random_next(r) % (unsigned long long)n);
}

int random_chance(random_source *r, double share) {
  return random_real(r, 0, 1) < share;
}
