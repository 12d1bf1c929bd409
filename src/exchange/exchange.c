/*
 * Choice of the reader, and its failure as a message of the deck.
 */
#include "exchange/exchange.h"

#include "base/memory.h"
#include "base/text.h"
#include "exchange/parts.h"
#include "base/system/input.h"

#include <errno.h>
#include <string.h>

static const unsigned char SIGNATURE[8] = {0x89, 'H',  'D',  'F',
                                           '\r', '\n', 0x1a, '\n'};

/* FCLIB if the file starts as HDF5 does. */
static status type_of(const char *path, exchange_type *type) {
  status st = OK;
  unsigned char start[sizeof SIGNATURE];
  const char *why = NULL;
  FILE *f = input_stream(path, &why);
  if (f == NULL) FAIL(ERR_FILE, "%s: cannot be read: %s", path, why);
  errno = 0;
  size_t n = fread(start, 1, sizeof start, f);
  if (ferror(f)) TRY(text_failed(path, "read", errno));
  if (*type == EXCHANGE_BY_CONTENT)
    *type = n == sizeof start && memcmp(start, SIGNATURE, n) == 0
                ? EXCHANGE_FCLIB
                : EXCHANGE_LCP;
done:
  if (f != NULL) fclose(f);
  return st;
}

status exchange_read(const char *path, exchange_type type, const place *at,
                     message_log *log, exchange_problem **out) {
  status st = OK;
  exchange_problem *p = NULL;
  *out = NULL;
  NEW(p, 1);
  TRY(type_of(path, &type));
  if (type == EXCHANGE_FCLIB)
    TRY(fclib_read(path, p));
  else
    TRY(lcp_text_read(path, p));
  *out = p;
done:
  if (st == ERR_FILE) message_add(log, P5001, at, "%s", status_message());
  if (st == ERR_DECK) message_add(log, P5002, at, "%s", status_message());
  if (st != OK) exchange_free(p);
  return st;
}

void exchange_free(exchange_problem *p) {
  if (p == NULL) return;
  RELEASE(p->matrix, p->load, p->gap, p->ut0, p->g0, p->B.start, p->B.col,
          p->B.val, p);
}
