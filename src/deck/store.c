/*
 * The memory of a deck: chunks that are never moved, so that what points into
 * them stays valid, and small helpers for texts.
 */
#include "base/base.h"
#include "deck/reader.h"

enum { CHUNK_BYTES = 1 << 16, ALIGN = 16 };

struct chunk {
  size_t used, size;
  _Alignas(ALIGN) char bytes[]; /* [size] */
};

static chunk *new_chunk(deck *d, size_t size) {
  const size_t bytes = size > CHUNK_BYTES ? size : CHUNK_BYTES;
  OWNS(d);
  chunk *c = memory_new(1, sizeof *c + bytes);
  if (c == NULL) return NULL;
  c->size = bytes;
  d->own->last = c;
  return c;
}

static void *take(deck *d, size_t bytes, size_t align) {
  chunk *c = d->own->last;
  size_t start = c != NULL ? (c->used + align - 1) & ~(align - 1) : 0;
  if (c == NULL || start > c->size || bytes > c->size - start) {
    c = new_chunk(d, bytes);
    if (c == NULL) return NULL;
    start = 0;
  }
  c->used = start + bytes;
  return c->bytes + start;
}

void *store_new(deck *d, size_t n, size_t size) {
  if (size != 0 && n > SIZE_MAX / 2 / size) return NULL;
  return take(d, n * size, ALIGN);
}

char *store_text(deck *d, const char *text, size_t n) {
  char *copy = take(d, n + 1, 1);
  if (copy == NULL) return NULL;
  if (n > 0) memcpy(copy, text, n);
  copy[n] = '\0';
  return copy;
}

const place *store_place(deck *d, const place *p) {
  place *copy = store_new(d, 1, sizeof *copy);
  if (copy != NULL) *copy = *p;
  return copy;
}

status buffer_add(buffer *b, const char *text, size_t n) {
  if (n > INT32_MAX / 4 || b->n > INT32_MAX / 4)
    RAISE(ERR_MEMORY, "a line of more than %d bytes", INT32_MAX / 4);
  while (b->n + n + 1 > (size_t)b->capacity)
    PASS_GROW(b->text, b->capacity, b->capacity);
  if (n > 0) memcpy(b->text + b->n, text, n);
  b->n += (int)n;
  b->text[b->n] = '\0';
  return OK;
}

int is_name_start(char c) {
  return (upper_case(c) >= 'A' && upper_case(c) <= 'Z') || c == '_';
}

int is_name_part(char c) { return is_name_start(c) || (c >= '0' && c <= '9'); }

const char *trim(const char *text, size_t n, size_t *length) {
  while (n > 0 && is_blank(*text)) {
    ++text;
    --n;
  }
  while (n > 0 && is_blank(text[n - 1])) --n;
  *length = n;
  return text;
}

char *store_name(deck *d, const char *text, size_t n) {
  size_t length, used = 0;
  const char *p = trim(text, n, &length);
  char *name = store_text(d, p, length);
  if (name == NULL) return NULL;
  for (size_t i = 0; i < length; ++i)
    if (!is_blank(p[i]))
      name[used++] = upper_case(p[i]);
    else if (!is_blank(p[i - 1]))
      name[used++] = ' ';
  name[used] = '\0';
  return name;
}

static unsigned hash_name(const char *name, size_t n) {
  unsigned h = 2166136261u;
  for (size_t i = 0; i < n; ++i)
    h = (h ^ (unsigned char)upper_case(name[i])) * 16777619u;
  return h ^ (h >> 15);
}

static int same_name(const char *stored, const char *name, size_t n) {
  for (size_t i = 0; i < n; ++i)
    if (stored[i] != upper_case(name[i])) return 0;
  return stored[n] == '\0';
}

/* Slot of the name, or the free one where it belongs; NULL: no table yet. */
static int *find_slot(const deck *d, const char *name, size_t n) {
  const struct deck_text *own = d->own;
  if (own->n_slot == 0) return NULL;
  unsigned mask = own->n_slot - 1, i = hash_name(name, n) & mask;
  while (own->slot[i] != 0 &&
         !same_name(d->symbols[own->slot[i] - 1].name, name, n))
    i = (i + 1) & mask;
  return &own->slot[i];
}

symbol *symbol_find(const deck *d, const char *name, size_t n) {
  const int *slot = find_slot(d, name, n);
  return slot != NULL && *slot != 0 ? &d->symbols[*slot - 1] : NULL;
}

symbol *symbol_use(const deck *d, const char *name, size_t n) {
  symbol *s = symbol_find(d, name, n);
  if (s != NULL) s->used = 1;
  return s;
}

/* At most half of the slots are taken. */
static status grow_table(deck *d) {
  struct deck_text *own = d->own;
  int *slots = NULL;
  if (2 * (d->n_symbol + 1) <= own->n_slot) return OK;
  int n = own->n_slot > 0 ? 2 * own->n_slot : 64;
  PASS_NEW(slots, n);
  memory_free(own->slot);
  own->slot = slots;
  own->n_slot = n;
  for (int i = 0; i < d->n_symbol; ++i)
    *find_slot(d, d->symbols[i].name, strlen(d->symbols[i].name)) = i + 1;
  return OK;
}

status symbol_add(deck *d, const char *name, size_t n, symbol **out) {
  OWNS(d);
  PASS_GROW(d->symbols, d->n_symbol, d->own->symbol_capacity);
  PASS(grow_table(d));
  symbol *s = &d->symbols[d->n_symbol];
  PASS_GET(s->name, store_name(d, name, n));
  *find_slot(d, name, n) = ++d->n_symbol;
  *out = s;
  return OK;
}
