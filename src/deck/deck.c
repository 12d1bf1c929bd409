/* The deck reader: cards, their parameters and records; the language cards. */
#include "deck/deck.h"

#include "base/base.h"
#include "base/option.h"
#include "deck/reader.h"

/* How data lines are read. */
enum {
  DATA_EARLY,      /* no card yet */
  DATA_RECORDS,    /* records of the last card */
  DATA_TEXT,       /* the same, free text */
  DATA_DEFINITION, /* of *PARAMETER */
  DATA_REFUSED,    /* the card has none */
  DATA_DROPPED     /* of a card that could not be read */
};

/* Cards whose data lines are free text. */
static const char *const text_cards[] = {"HEADING", NULL};

static int is_text_card(const char *name) {
  for (const char *const *p = text_cards; *p != NULL; ++p)
    if (strcmp(*p, name) == 0) return 1;
  return 0;
}

/* ---- parameters of a card ---------------------------------------------- */

const parameter *card_parameter(const card *c, const char *name) {
  for (int i = 0; i < c->n_parameter; ++i)
    if (strcmp(c->parameters[i].name, name) == 0) return &c->parameters[i];
  return NULL;
}

/* Part of a piece between two bytes of it, blanks cut. */
static piece part(const reader *r, int from, int to) {
  size_t length;
  const char *text = trim(r->line.all.text + from, to - from, &length);
  piece p = {(int)(text - r->line.all.text), (int)length, -1};
  return p;
}

static void report(reader *r, message_id id, int byte, const char *text) {
  place at = logical_place(&r->line, byte);
  message_add(r->log, id, &at, "%s", text);
}

/* The value behind the equals sign at that byte. */
static status read_value(reader *r, piece p, int equals, parameter *out) {
  piece value = part(r, equals + 1, p.start + p.length);
  const char *text = r->line.all.text + value.start;
  out->has_value = value.length > 0;
  if (!out->has_value) {
    place at = logical_place(&r->line, equals);
    message_add(r->log, P1007, &at, "%s has no value", out->name);
    return OK;
  }
  const char *second = memchr(text, '=', value.length);
  if (*text != '"' && *text != '(' && second != NULL)
    report(r, P1010, (int)(second - r->line.all.text),
           "a second equals sign; is a comma missing before?");
  return field_read(r, value, 1, &out->value);
}

/* NAME or NAME=VALUE; *ok 0 if it was refused. */
static status read_parameter(reader *r, piece p, parameter *out, int *ok) {
  const char *text = r->line.all.text + p.start;
  const char *equals = p.length > 0 ? memchr(text, '=', p.length) : NULL;
  int end =
      equals != NULL ? (int)(equals - r->line.all.text) : p.start + p.length;
  piece name = part(r, p.start, end);
  *ok = 0;
  if (name.length == 0) {
    report(r, P1008, p.start,
           equals != NULL ? "no name before the equals sign"
                          : "an empty parameter between commas");
    return OK;
  }
  *out = (parameter){.value = {.text = ""}};
  out->at = logical_place(&r->line, name.start);
  out->value.at = out->at;
  PASS_GET(out->name,
           store_name(r->d, r->line.all.text + name.start, name.length));
  if (equals != NULL) PASS(read_value(r, p, end, out));
  *ok = equals == NULL || out->has_value;
  return OK;
}

/* Parameters from the piece behind the name of the card on. */
static status read_parameters(reader *r, int next, int nested, card *c) {
  parameter list[PARAMETER_MAX];
  c->parameters = list;
  while (next >= 0) {
    int ok;
    piece p = logical_piece(&r->line, next, nested);
    if (p.length == 0 && p.next < 0) break; /* P1016 was given */
    next = p.next;
    if (c->n_parameter == PARAMETER_MAX) {
      report(r, P1033, p.start, "more than 64 parameters");
      break;
    }
    parameter *new = &list[c->n_parameter];
    int errors = message_count(r->log, ERROR);
    PASS(read_parameter(r, p, new, &ok));
    c->damaged |= message_count(r->log, ERROR) > errors;
    if (ok && card_parameter(c, new->name) != NULL)
      message_add(r->log, P1005, &new->at, "%s is repeated", new->name);
    else
      c->n_parameter += ok;
  }
  size_t n = c->n_parameter;
  parameter *kept = store_new(r->d, n, sizeof *kept);
  if (kept == NULL) RAISE(ERR_MEMORY, "memory exhausted: parameters");
  if (n > 0) COPY(kept, list, n);
  c->parameters = kept;
  return OK;
}

/* ---- language cards ---------------------------------------------------- */

/* Refuse parameters not among the names (NULL ends them); 1: there is none. */
static int check_names(reader *r, const card *c, const char *const *names) {
  int good = 1;
  for (EACH(const parameter, p, c->parameters, c->n_parameter)) {
    const char *const *name = names;
    while (*name != NULL && strcmp(*name, p->name) != 0) ++name;
    if (*name != NULL) continue;
    const char *near =
        nearest_word(p->name, candidate_name,
                     &(name_list){names, INT_MAX, sizeof *names, 0, 0});
    if (near == NULL) near = names[0]; /* the only one */
    message_add(r->log, P2003, &p->at,
                near != NULL ? "unknown parameter %s of *%s; did you mean %s?"
                             : "unknown parameter %s of *%s",
                p->name, c->name, near);
    good = 0;
  }
  return good;
}

/* The parameter that the card requires; NULL after a message. */
static const parameter *needed(reader *r, const card *c, const char *name) {
  const parameter *p = card_parameter(c, name);
  if (p != NULL && p->has_value) return p;
  message_add(r->log, p == NULL ? P2005 : P1007, &c->at, "*%s needs %s=VALUE",
              c->name, name);
  return NULL;
}

static status use_parameter(reader *r, const card *c) {
  r->mode = DATA_DEFINITION;
  return OK;
}

/* Data lines behind *INCLUDE, in the file or after it, belong to the card
 * before: the mode stays. */
static status use_include(reader *r, const card *c) {
  const parameter *input = needed(r, c, "INPUT");
  if (input == NULL) return OK;
  if (++r->n_include > INCLUDE_TOTAL) {
    if (r->n_include == INCLUDE_TOTAL + 1)
      message_add(r->log, P1018, &c->at, "more than %d includes",
                  INCLUDE_TOTAL);
    return OK;
  }
  const char *path = deck_path(r->d, &input->value);
  if (path == NULL) RAISE(ERR_MEMORY, "memory exhausted: name of a file");
  return source_open(r->d, r->log, path, &input->value.at, &r->top);
}

static void report_waiting(reader *r) {
  if (r->waiting_format != NULL)
    message_add(r->log, P1031, &r->legacy_at, "no card with data follows");
}

static status use_legacy(reader *r, const card *c) {
  const parameter *p = needed(r, c, "FORMAT");
  report_waiting(r);
  FORGET(r->waiting_format);
  r->mode = DATA_REFUSED;
  if (p == NULL) return OK;
  r->legacy_at = c->at;
  r->waiting_text = p->value.text;
  struct format *read;
  const status st = format_read(p->value.text, &read);
  if (st == OK) r->waiting_format = read;
  if (st != ERR_DECK) return st;
  message_add(r->log, P1027, &p->value.at, "%s in '%.200s'", status_message(),
              p->value.text);
  return OK;
}

typedef struct language_card {
  const char *name;
  int keeps_mode; /* data lines go on with the card before */
  int nested;     /* commas inside parentheses are part of a value */
  status (*use)(reader *r, const card *c);
  const char *names[2]; /* of parameters, NULL at the end */
} language_card;

/* clang-format off */
static const language_card language_cards[] = {
  {"PARAMETER", 0, 0, use_parameter, {NULL,     NULL}},
  {"INCLUDE",   1, 0, use_include,   {"INPUT",  NULL}},
  {"LEGACY",    0, 1, use_legacy,    {"FORMAT", NULL}},
  {NULL,        0, 0, NULL,          {NULL,     NULL}},
};
/* clang-format on */

static const language_card *find_language(const char *name) {
  const language_card *l = language_cards;
  while (l->name != NULL && strcmp(l->name, name) != 0) ++l;
  return l->name != NULL ? l : NULL;
}

/* ---- cards and records ------------------------------------------------- */

/* A card of the model: append it; a pending format is for its data. */
static status add_card(reader *r, card *c) {
  deck *d = r->d;
  PASS_GROW(d->cards, d->n_card, d->own->card_capacity);
  memory_free(r->format);
  r->format = r->waiting_format;
  r->waiting_format = NULL;
  c->format = r->format != NULL ? r->waiting_text : NULL;
  d->cards[d->n_card++] = *c;
  r->record_capacity = 0;
  r->mode =
      is_text_card(c->name) && r->format == NULL ? DATA_TEXT : DATA_RECORDS;
  return OK;
}

/* Name of the card into c; 0 after a message. */
static status read_name(reader *r, piece p, card *c, int *ok) {
  const char *text = r->line.all.text + p.start;
  const char *equals = memchr(text, '=', p.length);
  *ok = 0;
  c->at = logical_place(&r->line, p.start);
  PASS_GET(c->name, store_name(r->d, text + 1, (size_t)p.length - 1));
  if (*c->name == '\0')
    message_add(r->log, P1009, &c->at, "a card without a name");
  else if (equals != NULL)
    report(r, P1010, (int)(equals - r->line.all.text),
           "an equals sign in the name of a card; is a comma missing before?");
  else
    *ok = 1;
  return OK;
}

static status read_card(reader *r, const physical *line) {
  card c = {.n_parameter = 0};
  int ok;
  PASS(logical_read(r, line, LINE_FREE));
  piece p = logical_piece(&r->line, 0, 0);
  PASS(read_name(r, p, &c, &ok));
  const language_card *language = ok ? find_language(c.name) : NULL;
  r->excess_seen = 0;
  r->stray_seen = 0;
  if (!ok) {
    r->mode = DATA_DROPPED;
    return OK;
  }
  PASS(read_parameters(r, p.next, language != NULL && language->nested, &c));
  if (language == NULL) {
    PASS(add_card(r, &c));
  } else {
    if (!language->keeps_mode) r->mode = DATA_DROPPED;
    if (check_names(r, &c, language->names) || language->names[0] == NULL)
      PASS(language->use(r, &c));
  }
  return OK;
}

/* Space for one more record of the last card, with its raw text and place. */
static status add_record(reader *r, const physical *line, record **out) {
  card *c = &r->d->cards[r->d->n_card - 1];
  PASS_GROW(c->records, c->n_record, r->record_capacity);
  record *new = &c->records[c->n_record];
  size_t blanks = 0;
  PASS_GET(new->raw, store_text(r->d, line->text, line->length));
  while (is_blank(line->text[blanks])) ++blanks;
  new->at = source_place(r->top, line->line_no, (int)blanks + 1, new->raw);
  ++c->n_record;
  *out = new;
  return OK;
}

static status read_text(reader *r, const physical *line) {
  record *new;
  size_t length;
  const char *text = trim(line->text, line->length, &length);
  PASS(add_record(r, line, &new));
  PASS_GET(new->fields, store_new(r->d, 1, sizeof *new->fields));
  new->n_field = 1;
  new->fields->at = new->at;
  return symbols_replace(r, text, length, REPLACE_LENIENT, &new->at,
                         &new->fields->text);
}

static status read_fixed(reader *r, const physical *line) {
  record *new;
  PASS(add_record(r, line, &new));
  return format_record(r, r->format, line, new);
}

/* Fields of the logical line; an empty one at the end does not count. */
static int count_fields(const logical *l) {
  int n = 0;
  piece p = {.next = 0};
  while (p.next >= 0) {
    p = logical_piece(l, p.next, 0);
    if (p.length > 0 || p.next >= 0) ++n;
  }
  return n > 0 ? n : 1;
}

static status read_record(reader *r, const physical *line) {
  record *new;
  PASS(add_record(r, line, &new));
  PASS(logical_read(r, line, LINE_FREE));
  int n = count_fields(&r->line);
  PASS_GET(new->fields, store_new(r->d, n, sizeof *new->fields));
  piece p = {.next = 0};
  for (; new->n_field < n; ++new->n_field) {
    p = logical_piece(&r->line, p.next, 0);
    PASS(field_read(r, p, 0, &new->fields[new->n_field]));
  }
  return OK;
}

/* A data line where none may stand: one message for the lines that follow
 * each other. */
static void refuse_line(reader *r, const physical *line) {
  if (r->stray_seen) return;
  place at = source_place(r->top, line->line_no, 1, line->text);
  while (is_blank(line->text[at.column_no - 1])) ++at.column_no;
  if (r->mode == DATA_TEXT)
    message_add(r->log, P1038, &at, "text of an included file");
  else if (r->mode == DATA_EARLY)
    message_add(r->log, P1015, &at, "data before the first card");
  else
    message_add(r->log, P2008, &at, "the card above takes no data lines");
  r->stray_seen = 1;
}

static status read_data(reader *r, const physical *line) {
  switch (r->mode) {
    case DATA_RECORDS:
      PASS(r->format != NULL ? read_fixed(r, line) : read_record(r, line));
      break;
    case DATA_TEXT:
      if (source_hidden(r->top))
        refuse_line(r, line);
      else
        PASS(read_text(r, line));
      break;
    case DATA_DEFINITION:
      PASS(logical_read(r, line, LINE_DEFINITION));
      PASS(symbols_define(r));
      break;
    case DATA_EARLY:
    case DATA_REFUSED:
      refuse_line(r, line);
      break;
    default:
      break;
  }
  return OK;
}

/* ---- the whole deck ---------------------------------------------------- */

static status read_all(reader *r) {
  while (r->top != NULL) {
    const physical *line;
    PASS(source_next(r->top, r->log, &line));
    if (line == NULL) {
      source_pop(&r->top);
      continue;
    }
    const char *p = line->text;
    while (is_blank(*p)) ++p;
    PASS(*p == '*' ? read_card(r, line) : read_data(r, line));
  }
  report_waiting(r);
  if (r->d->n_card == 0 && message_count(r->log, ERROR) == 0) {
    place at = {.file = r->d->file};
    message_add(r->log, P1002, &at, "no card in the file");
  }
  return OK;
}

static void reader_free(reader *r) {
  while (r->top != NULL) source_pop(&r->top);
  RELEASE(r->line.all.text, r->line.segments, r->scratch.text, r->format,
          r->waiting_format);
}

status deck_read(const char *file, int n_define, const char *const *defines,
                 message_log *log, deck **out) {
  *out = NULL;
  OWNED_NEW(deck, d, 1);
  ENDS_BY(reader_free) reader r = {.log = log, .d = d, .mode = DATA_EARLY};
  OWNS(d);
  PASS_NEW(d->own, 1);
  PASS(source_open(d, log, file, NULL, &r.top));
  if (r.top == NULL) RAISE(ERR_FILE, "cannot read %s", file);
  d->file = d->files[0];
  for (int i = 0; i < n_define; ++i) PASS(symbols_from_command(&r, defines[i]));
  PASS(read_all(&r));
  *out = d;
  d = NULL;
  return OK;
}
