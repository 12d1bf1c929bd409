/*
 * Counted allocation. Every block of the program comes from here, so that the
 * bytes of a stage are known (timer.h) and a test can refuse the k-th request.
 *
 * Each request checks n*size for overflow, returns zeroed memory (memory_new)
 * and never fails for n = 0: it then returns a block that can be released.
 *
 * A failed x_new may leave in *out what it has made: its owner frees it.
 *
 * OWNS(object): what is requested from here to the end of the block belongs to
 * the object, a block itself, and goes with it, unless it is freed before. So
 * memory_free is all that an object needs whose x_new has this line.
 */
#pragma once

#include "base/status.h"

#include <stddef.h>
#include <string.h>

/* n items of what "to" points to. */
#define COPY(to, from, n) memcpy((to), (from), (size_t)(n) * sizeof *(to))
#define CLEAR(to, n) memset((to), 0, (size_t)(n) * sizeof *(to))

/* for (EACH(const load, l, list, n)): l is one of n items after another. */
#define EACH(type, item, list, n)                                 \
  type *item = (list), *item##_end = (n) > 0 ? item + (n) : item; \
  item < item##_end;                                              \
  ++item

/* PASS_NEW_REALS(n, &a, &b, ...): n zeroed numbers for each, or RAISE. */
#define PASS_NEW_REALS(n, ...)                                                 \
  PASS(memory_reals(                                                           \
      (size_t)(n), (int)(sizeof((double **[]){__VA_ARGS__}) / sizeof(void *)), \
      (double **[]){__VA_ARGS__}))

/* NEW(a, n), NEW_ALL(OF(a, n), OF(b, m), ...): n zeroed items for each of what
 * the pointer points to, or FAIL. */
#define NEW(pointer, n) NEW_ALL(OF(pointer, n))
#define PASS_NEW(pointer, n) PASS_NEW_ALL(OF(pointer, n))
#define NEW_ALL(...) TRY(ALL_OF(__VA_ARGS__))
#define PASS_NEW_ALL(...) PASS(ALL_OF(__VA_ARGS__))
#define OF(pointer, n) \
  { &(pointer), #pointer, (size_t)(n), sizeof *(pointer) }
#define ALL_OF(...)                                                      \
  memory_items(                                                          \
      (int)(sizeof((memory_item[]){__VA_ARGS__}) / sizeof(memory_item)), \
      (memory_item[]){__VA_ARGS__})

/* PASS_GROW(pointer, n, capacity): space for item n (0-based), doubling as
 * needed; capacity is an int lvalue that belongs to the pointer. */
#define PASS_GROW(pointer, n, capacity)                  \
  do {                                                   \
    if ((n) >= (capacity)) {                             \
      int wanted_ = (capacity) > 0 ? 2 * (capacity) : 8; \
      PASS_RESIZE(pointer, capacity, (size_t)wanted_);   \
      (capacity) = wanted_;                              \
    }                                                    \
  } while (0)

/* ADDED(load, l, list, n, capacity): l is a new item n++ of the list. */
#define ADDED(type, item, list, n, capacity) \
  PASS_GROW(list, n, capacity);              \
  type *item = &(list)[(n)++]

/* PASS_RESIZE(pointer, from, to): its items are kept, the rest is zero. */
#define PASS_RESIZE(pointer, from, to)                                     \
  do {                                                                     \
    void *grown_ = memory_resize((pointer), (size_t)(from), (size_t)(to),  \
                                 sizeof *(pointer));                       \
    if (grown_ == NULL)                                                    \
      RAISE(ERR_MEMORY, "memory exhausted: %zu items of %zu bytes for %s", \
            (size_t)(to), sizeof *(pointer), #pointer);                    \
    (pointer) = grown_;                                                    \
  } while (0)

/* PASS_GET(pointer, block): a block that a function requests. */
#define PASS_GET(pointer, block)                           \
  do {                                                     \
    (pointer) = (block);                                   \
    if ((pointer) == NULL)                                 \
      RAISE(ERR_MEMORY, "memory exhausted: %s", #pointer); \
  } while (0)

void *memory_new(size_t n, size_t size); /* zeroed; NULL if refused */
status memory_reals(size_t n, int count, double **const *p);
typedef struct memory_item {
  void *at; /* of the pointer */
  const char *name;
  size_t n, size; /* items, bytes of one */
} memory_item;
status memory_items(int count, const memory_item *items);
/* Reallocate old_n items, the rest zeroed; on NULL the old block stays
 * valid. */
void *memory_resize(void *p, size_t old_n, size_t new_n, size_t size);
char *memory_text(const char *text); /* copy of a string; NULL if refused */
void memory_free(void *p);           /* and what it owns; accepts NULL */
void memory_free_all(int n, void *const *p);
void memory_leave(void *p); /* p: address of a pointer whose block is freed */

/* RELEASE(a, b, ...): memory_free of each. */
#define RELEASE(...)                                                       \
  memory_free_all((int)(sizeof((void *[]){__VA_ARGS__}) / sizeof(void *)), \
                  (void *[]){__VA_ARGS__})

/* Free p, which is NULL from then on. */
#define FORGET(p) (memory_free(p), (p) = NULL)

/* OWNED double *a = NULL: freed where the name ends, on each return. */
#define OWNED __attribute__((cleanup(memory_leave)))
/* OWNED_NEW(double, a, n): such an a with n zeroed items, or RAISE. */
#define OWNED_NEW(type, name, n) \
  OWNED type *name = NULL;       \
  PASS_NEW(name, n)
/* The same of a block that a function requests, */
#define OWNED_GET(type, name, block) \
  OWNED type *name = NULL;           \
  PASS_GET(name, block)
/* and of one that a call requests into &a. */
#define OWNED_OF(type, name, call) \
  OWNED type *name = NULL;         \
  PASS(call)
/* OWNED_PARTS(type, name, call): a struct, zero but for what a call requests
 * for it, which is freed where the name ends; or RAISE. The call requests
 * nothing for others. */
#define OWNED_PARTS(type, name, call)   \
  type name = {0};                      \
  OWNED_NEW(char, name##_parts, 1);     \
  do {                                  \
    OWNER_TILL_END(name##_parts, name); \
    PASS(call);                         \
  } while (0)
/* The same by a function of a pointer to the local. */
#define ENDS_BY(function) __attribute__((cleanup(function)))

/* Of what is requested from here to the end of the block the object is the
 * owner; NULL: none. Not behind a jump to "done:" of the same block. */
#define OWNS(object) OWNER_TILL_END(object, before)
#define OWNER_TILL_END(object, name)                                 \
  void *name##_ __attribute__((cleanup(memory_own_again), unused)) = \
      memory_own(object)
/* MAKES(type, s, out): s = *out is a new object that OWNS the rest; may
 * return ERR_MEMORY. */
#define MAKES(type, s, out) \
  PASS_NEW(*out, 1);        \
  type *s = *out;           \
  OWNS(s)
/* SCRATCH; what is requested from here to the end of the block ends there, if
 * it has no other owner: for what calls nothing that keeps a block. */
#define SCRATCH                 \
  OWNED_NEW(char, scratch_, 1); \
  OWNS(scratch_)
void *memory_own(void *p); /* the owner before, for memory_own_again */
void memory_own_again(void *const *before);

/* From here on all blocks of SuiteSparse come from here too. Called before
 * its first use; further calls change nothing. */
void memory_count_suitesparse(void);

/* What has been freed goes back to the system, where a block of so many bytes
 * follows that cannot use it: malloc maps large ones apart. */
void memory_return_before(size_t bytes);

size_t memory_in_use(void);    /* bytes now held */
size_t memory_peak(void);      /* largest number held at a time */
size_t memory_allocated(void); /* bytes requested since the start */
long memory_requests(void);    /* requests since the start */
/* Bytes that may be held at a time; more is refused. who: source of the limit,
 * for messages (a literal). SIZE_MAX: no limit, as at first. */
void memory_limit(size_t bytes, const char *who);
double memory_left(void); /* bytes; INFINITY without limit */
const char *memory_limit_of(void);
int memory_hit_limit(void); /* 1: it has refused a request */
/* ERR_MEMORY, with advice, if so many bytes more exceed the limit: called
 * before a lot of work. what: "the run", ... */
status memory_require(double bytes, const char *what);
/* Refuse request number k (1 = the next) and, if "all", every later one. k = 0
 * switches it off. For tests of the recovery from a refusal. */
void memory_refuse(long k, int all);
