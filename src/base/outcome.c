/* Texts for the outcomes of an iteration. */
#include "base/outcome.h"

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
