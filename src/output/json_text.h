/*
 * JSON as text, one value after the other; name NULL: an item of an array.
 */
#ifndef PROTIS_OUTPUT_JSON_TEXT_H
#define PROTIS_OUTPUT_JSON_TEXT_H

#include <stdio.h>

/* The writer knows whether a comma is due: one flag per depth. */
typedef struct json {
  FILE *f;
  int depth;
  int filled[8];
} json;

/* '{' or '[', closed by '}' or ']'. */
void json_open(json *w, const char *name, char bracket);
void json_close(json *w, char bracket);
void json_string(json *w, const char *name, const char *text); /* NULL: "" */
void json_real(json *w, const char *name, double value);  /* not finite: null */
void json_count(json *w, const char *name, double value); /* whole */
void json_flag(json *w, const char *name, int value);     /* 0: false */
/* The same under the name in one word: "contact nodes" -> "contact_nodes". */
void json_named_count(json *w, const char *name, double value);

#endif
