/*
 * CHECK= of *SOLVER: the solutions found, and the methods that found them.
 */
#include "output/listing/parts.h"

#include <string.h>

static void print_solution(const solution_set *set, int i, FILE *f) {
  char text[4][NUMBER_SIZE];
  const solution_facts *a = &set->found[i].facts;
  fprintf(f, "    %2d  residual %s  open %d  slip %d  stick %d  ", i + 1,
          text_number(text[0], a->residual, 1), a->n_open, a->n_slip,
          a->n_stick);
  fprintf(f, "u_n %s to %s  u_t %s to %s\n",
          text_number(text[0], a->lowest[0], 4),
          text_number(text[1], a->highest[0], 4),
          text_number(text[2], a->lowest[1], 4),
          text_number(text[3], a->highest[1], 4));
  if (i > 0)
    fprintf(f, "        %s %% of the energy norm away from solution 1\n",
            text_number(text[0], 100 * a->distance, 2));
  if (a->joined > 0)
    fprintf(f,
            "        all states between solutions %d and %d are solutions: a "
            "continuum\n",
            a->joined, i + 1);
}

/* Nodal values of one solution of an enumeration. */
static void print_values(const state *s, const solution *a, FILE *f) {
  static const char *const words[] = {"OPEN", "SLIP", "STICK"};
  char text[4][NUMBER_SIZE];
  fprintf(f, "        %8s %-6s %12s %12s %12s %12s\n", "node_no", "status",
          "u_n", "u_t", "f_n", "f_t");
  for (int i = 0; i < s->errors.solutions->n; ++i)
    fprintf(f, "        %8zu %-6s %s %s %s %s\n",
            s->contacts.surface->node_no[i], words[a->status[i]],
            text_number(text[0], a->u[2 * i], 4),
            text_number(text[1], a->u[2 * i + 1], 4),
            text_number(text[2], -a->r[2 * i], 4),
            text_number(text[3], a->r[2 * i + 1], 4));
}

/* Attempts that ended without a solution. */
static void print_failures(const solution_set *set, FILE *f) {
  char text[NUMBER_SIZE];
  for (int k = 0; k < set->n_attempt; ++k) {
    const solution_attempt *a = &set->attempts[k];
    if (a->solution_no > 0) continue;
    fprintf(f, "    %s (%s), start %s: %s, residual %s\n", a->solver, a->family,
            a->start, outcome_text(a->outcome),
            text_number(text, a->residual, 1));
  }
}

/* The attempts that found solution number i + 1: a line for each solver. */
static void print_finders(const solution_set *set, int i, FILE *f) {
  const char *last = "";
  for (int k = 0; k < set->n_attempt; ++k) {
    const solution_attempt *a = &set->attempts[k];
    if (a->solution_no != i + 1) continue;
    if (strcmp(last, a->solver) != 0)
      fprintf(f, "%s        by %s (%s) from: ", last[0] == '\0' ? "" : "\n",
              a->solver, a->family);
    else
      fputs(", ", f);
    fputs(a->start, f);
    last = a->solver;
  }
  if (last[0] != '\0') fputc('\n', f);
}

void listing_solutions(const state *s, FILE *f) {
  const solution_set *set = s->errors.solutions;
  if (set == NULL) return;
  if (set->n_pattern > 0)
    fprintf(f, "  check: %ld combinations of statuses, ", set->n_pattern);
  else
    fprintf(f, "  check: %d attempts, ", set->n_attempt);
  fprintf(f, "%d solution%s\n", set->n_found, set->n_found == 1 ? "" : "s");
  for (int i = 0; i < set->n_found; ++i) {
    print_solution(set, i, f);
    if (set->n_pattern > 0)
      print_values(s, &set->found[i], f);
    else
      print_finders(set, i, f);
  }
  if (set->n_found > 1) fprintf(f, "    the run goes on with solution 1\n");
  if (set->n_undecided > 0)
    fprintf(f,
            "    %d singular combinations have solutions of unknown extent\n",
            set->n_undecided);
  print_failures(set, f);
}
