/* Counted allocation: a header before each block keeps its size, and what it
 * owns. */
#include "base/memory.h"

#include <SuiteSparse_config.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <math.h>
#include <stdint.h>

typedef struct header header;
struct header {
  size_t bytes;
  header *first;        /* of the blocks it owns */
  header *next, **link; /* with the same owner; what points to this one */
};

enum {
  HEADER = 48,     /* bytes, alignment kept */
  MAPPED = 1 << 25 /* bytes: glibc maps larger blocks, and no smaller ones that
                      it has seen freed */
};

static size_t in_use, peak, allocated;
static size_t most = SIZE_MAX;
static const char *limit_of = "nothing";
static long requests, refuse_at;
static int refuse_all, hit_limit;
static header *owner; /* of what is requested, or NULL */

static header *header_of(const void *p) {
  return p == NULL ? NULL : (header *)(void *)((char *)p - HEADER);
}

static void join(header *h, header **first) {
  h->next = *first;
  h->link = first;
  if (h->next != NULL) h->next->link = &h->next;
  *first = h;
}

static void part(header *h) {
  if (h->link != NULL) *h->link = h->next;
  if (h->next != NULL) h->next->link = h->link;
  h->link = NULL;
  h->next = NULL;
}

static int refused(void) {
  ++requests;
  if (refuse_at == 0) return 0;
  if (refuse_at > 1) {
    --refuse_at;
    return 0;
  }
  if (!refuse_all) refuse_at = 0;
  return 1;
}

void *memory_new(size_t n, size_t size) {
  if (refused()) return NULL;
  if (size != 0 && n > (SIZE_MAX - HEADER) / size) return NULL;
  size_t bytes = n * size;
  if (in_use > most || bytes > most - in_use) {
    hit_limit = 1;
    return NULL;
  }
  char *block = calloc(1, bytes + HEADER);
  if (block == NULL) return NULL;
  header *h = header_of(block + HEADER);
  h->bytes = bytes;
  if (owner != NULL) join(h, &owner->first);
  allocated += bytes;
  in_use += bytes;
  if (in_use > peak) peak = in_use;
  return block + HEADER;
}

status memory_reals(size_t n, int count, double **const *p) {
  for (int i = 0; i < count; ++i) {
    *p[i] = memory_new(n, sizeof **p[i]);
    if (*p[i] == NULL)
      RAISE(ERR_MEMORY, "memory exhausted: vector of %zu numbers", n);
  }
  return OK;
}

status memory_items(int count, const memory_item *items) {
  for (const memory_item *i = items; i < items + count; ++i) {
    void *block = memory_new(i->n, i->size);
    memcpy(i->at, &block, sizeof block);
    if (block == NULL)
      RAISE(ERR_MEMORY, "memory exhausted: %zu items of %zu bytes for %s", i->n,
            i->size, i->name);
  }
  return OK;
}

void *memory_resize(void *p, size_t old_n, size_t new_n, size_t size) {
  void *grown = memory_new(new_n, size);
  if (grown == NULL) return NULL;
  if (p == NULL) return grown;
  header *old = header_of(p), *h = header_of(grown);
  memcpy(grown, p, (old_n < new_n ? old_n : new_n) * size);
  part(h);
  if (old->link != NULL) join(h, old->link);
  memory_free(p);
  return grown;
}

char *memory_text(const char *text) {
  size_t length = strlen(text) + 1;
  char *copy = memory_new(length, 1);
  if (copy != NULL) memcpy(copy, text, length);
  return copy;
}

void memory_free(void *p) {
  if (p == NULL) return;
  header *h = header_of(p);
  while (h->first != NULL) memory_free((char *)h->first + HEADER);
  part(h);
  in_use -= h->bytes;
  free(h);
}

void *memory_own(void *p) {
  header *before = owner;
  owner = header_of(p);
  return before;
}

void memory_own_again(void *const *before) { owner = *before; }

void memory_free_all(int n, void *const *p) {
  for (int i = 0; i < n; ++i) memory_free(p[i]);
}

void memory_leave(void *p) {
  void *block;
  memcpy(&block, p, sizeof block);
  memory_free(block);
}

/* Blocks of SuiteSparse may outlast the object that is made. */
static void *malloc_counted(size_t bytes) {
  OWNS(NULL);
  return memory_new(bytes, 1);
}

static void *calloc_counted(size_t n, size_t size) {
  OWNS(NULL);
  return memory_new(n, size);
}

static void *realloc_counted(void *p, size_t bytes) {
  OWNS(NULL);
  return memory_resize(p, p == NULL ? 0 : header_of(p)->bytes, bytes, 1);
}

void memory_count_suitesparse(void) {
  SuiteSparse_config.malloc_func = malloc_counted;
  SuiteSparse_config.calloc_func = calloc_counted;
  SuiteSparse_config.realloc_func = realloc_counted;
  SuiteSparse_config.free_func = memory_free;
}

void memory_return_before(size_t bytes) {
#ifdef __GLIBC__
  if (bytes > MAPPED) malloc_trim(0);
#else
  (void)bytes;
#endif
}

size_t memory_in_use(void) { return in_use; }
size_t memory_peak(void) { return peak; }
size_t memory_allocated(void) { return allocated; }
long memory_requests(void) { return requests; }

void memory_limit(size_t bytes, const char *who) {
  most = bytes;
  limit_of = who;
}

const char *memory_limit_of(void) { return limit_of; }
int memory_hit_limit(void) { return hit_limit; }

double memory_left(void) {
  if (most == SIZE_MAX) return INFINITY;
  return in_use < most ? (double)(most - in_use) : 0.0;
}

status memory_require(double bytes, const char *what) {
  const double mega = 1e6;
  if (bytes > memory_left())
    RAISE(ERR_MEMORY,
          "%s needs about %.0f MB of memory, and %s leaves %.0f MB; take a "
          "coarser mesh or fewer contact nodes, or set the limit with "
          "--max-memory MB (for the passes of TARGET= MAX_MEMORY=)",
          what, ceil(bytes / mega), limit_of, floor(memory_left() / mega));
  return OK;
}

void memory_refuse(long k, int all) {
  refuse_at = k;
  refuse_all = all;
}
