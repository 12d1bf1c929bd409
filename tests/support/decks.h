/*
 * Decks for the tests: written into a folder of their own under /tmp and read
 * from there.
 */
#pragma once

#include "deck/deck.h"

/* Make a folder and go there; remove it with its decks (*.inp, sub/). */
void decks_enter(void);
void decks_leave(void);

/* A file in the folder, closed; without NUL, or any bytes. */
void decks_write(const char *name, const char *content);
void decks_write_bytes(const char *name, const void *bytes, size_t n);

typedef struct read_deck {
  deck *d; /* NULL if st is not OK                                            */
  message_log *log;
  status st;
} read_deck;

/* Read a file with definitions of -D; read the text as a.inp; the same, but
 * fail unless there is no message at all. */
read_deck decks_read(const char *file, int n, const char *const *defines);
read_deck decks_read_text(const char *content);
read_deck decks_read_good(const char *content);
/* The messages of the deck read last; made again from a log. */
char *decks_messages(void);
void decks_print(const message_log *log);
void decks_done(read_deck *r);

/* Cards as text: *NAME{P=V}{Q}[field|field][field]; quoted fields in "". */
const char *decks_shape(const deck *d);
