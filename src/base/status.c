/* The error record: one message and the functions that passed it up. */
#include "base/status.h"

#include "base/text.h"

#include <stdarg.h>
#include <string.h>

enum { MESSAGE_SIZE = 4096, PATH_SIZE = 1024 };

static char message[MESSAGE_SIZE];
static char path[PATH_SIZE];

void status_trace(const char *function, int line) {
  size_t used = strlen(path);
  if (used + 8 < PATH_SIZE)
    snprintf(path + used, PATH_SIZE - used, "%s%s:%d", used ? " < " : "",
             function, line);
}

/* The text is made before the record is cleared: it may quote the old one. */
status status_fail(status code, const char *function, int line,
                   const char *format, ...) {
  char text[MESSAGE_SIZE];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  text_shown_lines(message, sizeof message, text);
  path[0] = '\0';
  status_trace(function, line);
  return code;
}

const char *status_message(void) { return message; }

const char *status_path(void) { return path; }

const char *status_name(status s) {
#define STATUS_NAME(name, exit_code, text) #name,
  static const char *const names[] = {STATUS_LIST(STATUS_NAME)};
  return s < STATUS_COUNT ? names[s] : "?";
}

const char *status_text(status s) {
#define STATUS_TEXT(name, exit_code, text) text,
  static const char *const texts[] = {STATUS_LIST(STATUS_TEXT)};
  return s < STATUS_COUNT ? texts[s] : "?";
}

int status_exit_code(status s) {
#define STATUS_EXIT(name, exit_code, text) exit_code,
  static const int codes[] = {STATUS_LIST(STATUS_EXIT)};
  return s < STATUS_COUNT ? codes[s] : codes[ERR_INTERNAL];
}

int status_is_request(status s) { return status_exit_code(s) > 128; }

void status_clear(void) {
  message[0] = '\0';
  path[0] = '\0';
}

const char *outcome_text(outcome o) {
#define OUTCOME_TEXT(name, value, code, text) [CONVERGED - name] = text,
  static const char *const texts[] = {OUTCOME_LIST(OUTCOME_TEXT)};
  return texts[CONVERGED - o];
}

const char *outcome_code(outcome o) {
#define OUTCOME_CODE(name, value, code, text) [CONVERGED - name] = code,
  static const char *const codes[] = {OUTCOME_LIST(OUTCOME_CODE)};
  return codes[CONVERGED - o];
}

int outcome_is_fatal(outcome o) {
  return o == STOPPED_NAN || o == STOPPED_RAY || o == STOPPED_SINGULAR ||
         o == STOPPED_UNFIT;
}
