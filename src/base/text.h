/*
 * Text files of the results, every write checked, and the one format of the
 * numbers in them.
 */
#pragma once

#include "base/status.h"

#include <stdio.h>

typedef struct text_file {
  FILE *f;
  char *path; /* owned */
} text_file;

/* ASCII in any locale. */
static inline char upper_case(char c) {
  return c >= 'a' && c <= 'z' ? (char)(c - 'a' + 'A') : c;
}
static inline int is_blank(char c) { return c == ' ' || c == '\t'; }

/* file.c: DIR/NAME.SUFFIX, new (memory_free), NULL without memory. */
char *text_path(const char *dir, const char *name, const char *suffix);
/* Open for writing; by_line: each line is flushed when it ends. */
status text_open(text_file *t, const char *path, int by_line);
/* Open to append after "length" bytes; what follows is cut. ERR_FILE also if
 * the file is shorter. */
status text_reopen(text_file *t, const char *path, int by_line, long length);
/* Synchronise the file; bytes so far into *length. */
status text_sync(text_file *t, long *length);
/* Flush; ERR_FILE names the file and the reason. */
status text_check(text_file *t);
status text_close(text_file *t); /* checked; accepts one never opened */
/* The file as "write" fills it; written to a temporary file and renamed: a
 * reader sees all of it or nothing. */
status text_replace(const char *path, const void *what,
                    void (*write)(FILE *f, const void *what));
/* What "write" prints as a new text (memory_free); its status. */
status text_made(char **text, const void *what,
                 status (*write)(FILE *f, const void *what));
/* Close a memory stream; 1: it holds all that was printed. */
int text_memory_end(FILE *f, char **text);
/* ERR_FILE, of ENOMEM ERR_MEMORY, with the path and the text of the error
 * number; 0: none known. */
status text_failed(const char *path, const char *doing, int error_no);
/* What was printed has left; no failure if its reader has gone. */
status text_flush_output(void);
/* Space for a short text; the same is returned again after 31 others. */
enum { TEXT_BUFFER = 128, TEXT_BUFFERS = 32 };
char *text_buffer(void);
const char *text_of(const char *format, ...)
    __attribute__((format(printf, 1, 2)));
/* Adds to a text of that size what fits. */
void text_add(char *text, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* "1.5000E+000": digits after the point, three-digit exponent, no -0, NaN,
 * Inf; in a text_buffer. */
const char *text_number(double value, int digits);
/* Right-aligned in a field of the width, at least one blank before it. */
void text_cell(FILE *f, const char *text, int width);
/* Words in lines of at most 78 columns, from column "indent" on, where the
 * first line already is; ends the line. */
void text_wrap(FILE *f, const char *text, int indent);
/*
 * Text from outside made printable: printable UTF-8 stays; each byte of other
 * characters (control characters but the tab, marks that change the direction
 * of writing or have no width, invalid UTF-8) becomes \xHH.
 */
enum { PIECE_SIZE = 20 };
/* The first character of *text, which moves past it; its length, 0 at the
 * end. */
int text_piece(const char **text, char piece[PIECE_SIZE]);
/* All of it, cut at whole characters to the size; its length. */
size_t text_shown(char *out, size_t size, const char *text);
/* The same line by line; "text" is overwritten. */
void text_shown_lines(char *out, size_t size, char *text);
void text_put(FILE *f, const char *text);
/* Undo text_shown, in place: for names of files. */
void text_plain(char *text);
/* The text as one word: blanks become "_". */
void text_word(char *word, size_t size, const char *text);

/*
 * a // b in n characters, the one call of LAPACK to the library of Fortran. In
 * an archive of LAPACK it is answered here: the other would bring libquadmath,
 * which registers formats of its own and so slows all of printf.
 */
void _gfortran_concat_string(size_t n, char *to, size_t n_a, const char *a,
                             size_t n_b, const char *b);
