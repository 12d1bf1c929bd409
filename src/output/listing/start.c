/*
 * The block of an initial state that is given.
 */
#include "output/listing/parts.h"

enum { WORST_NODES = 10 };

/* The node with the largest defect below that of "last"; -1: none. */
static int next_defect(const start_report *s, int n, int last) {
  int next = -1;
  for (int i = 0; i < n; ++i) {
    int after = last < 0 || s->defect[i] < s->defect[last] ||
                (s->defect[i] == s->defect[last] && i > last);
    if (after && (next < 0 || s->defect[i] > s->defect[next])) next = i;
  }
  return next >= 0 && s->defect[next] > 0.0 ? next : -1;
}

status listing_start(const job *j, const start_report *s, text_file *lst) {
  FILE *f = lst->f;
  char text[NUMBER_SIZE], unit[64];
  int node = -1;
  column_unit("force", j->m, unit, sizeof unit);
  fputs("\ninitial state: ", f);
  if (s->source != NULL)
    fprintf(f, "end of %s, time %s\n", s->source,
            text_number(text, s->source_time, 9));
  else
    fputs("displacements of the deck\n", f);
  fprintf(f, "  %-24s %14s %s\n", "largest force",
          text_number(text, s->scale, DIGITS), unit);
  fprintf(f, "  %-24s %14s %s\n", "largest defect",
          text_number(text, s->worst, DIGITS), unit);
  fprintf(f, "  %-24s %14s -\n", "defect, relative",
          text_number(text, s->ratio, DIGITS));
  fprintf(f, "  %-24s %14d, above %s\n", "nodes out of equilibrium", s->n_bad,
          text_number(text, start_tolerance, 0));
  for (int k = 0; k < WORST_NODES && k < s->n_bad; ++k) {
    node = next_defect(s, j->msh->n_node, node);
    if (node < 0) break;
    fprintf(f, "  node %-19zu %14s %s: %s\n", j->msh->node_no[node],
            text_number(text, s->defect[node], DIGITS), unit,
            defect_text(s->kind[node]));
  }
  fprintf(f, "  %s\n",
          s->relaxed     ? "relaxed to the equilibrium of time 0, increment 0"
          : s->n_bad > 0 ? "REFUSED"
                         : "compatible");
  return text_check(lst);
}
