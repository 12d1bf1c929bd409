/* Information without solving: version, lists, the check of a deck. */
#include "program/inform.h"

#include "base/system/blas.h"
#include "effects/plan/plan.h"
#include "effects/rows.h"
#include "model/keyword/keyword.h"
#include "run/history/history.h"

#include <cholmod.h>
#include <hdf5.h>

extern char *openblas_get_config(void);

void inform_version(const char *commit) {
  unsigned major, minor, release;
  int cholmod[3];
  cholmod_version(cholmod);
  H5get_libversion(&major, &minor, &release);
  printf("protis %s (commit %s)\n", PROTIS_VERSION, commit);
  printf("CHOLMOD %d.%d.%d\n", cholmod[0], cholmod[1], cholmod[2]);
  printf("%s\n", openblas_get_config());
  printf("BLAS kernel %s%s\n", blas_kernel(),
         blas_kernel_changed() ? " (chosen by protis)" : "");
  printf("HDF5 %u.%u.%u\n", major, minor, release);
}

const char *inform_nearest(const char *word, next_word *next, const void *ctx) {
  return nearest_word(word, next, ctx);
}

static const char *card_name(const void *ctx, int i) {
  return keyword_table[i].name;
}

int inform_keywords(const char *name, const char **near) {
  if (keywords_print(name, stdout)) return 1;
  *near = nearest_word(name + strspn(name, "*"), card_name, NULL);
  return 0;
}

static void print_sizes(const model *m, const mesh *msh) {
  static const char *const kinds[] = {"none", "static", "quasistatic", "visco"};
  printf("mesh      %d nodes, %d element%s, %d-D\n", msh->n_node, msh->n_elem,
         msh->n_elem == 1 ? "" : "s", msh->dim);
  for (int i = 0; i < msh->n_group; ++i)
    printf("group     %-20s dimension %d, %d node%s\n", msh->group[i].name,
           msh->group[i].dim, msh->group[i].n_node,
           msh->group[i].n_node == 1 ? "" : "s");
  for (int i = 0; i < m->n.step; ++i)
    printf("step      %d %s: %s, time %g to %g, %.0f increment%s\n", i + 1,
           m->steps[i].name, kinds[m->steps[i].kind], m->steps[i].start,
           m->steps[i].start + m->steps[i].total,
           m->steps[i].total / m->steps[i].dt,
           m->steps[i].total / m->steps[i].dt < 1.5 ? "" : "s");
}

static status print_plan(const model *m, const mesh *msh, int n) {
  OWNED_OF(effect_plan, p, plan_new(m, msh, n, &p));
  puts("effects");
  plan_print(p, "  ", stdout);
  return OK;
}

/* Both kinds of the stiffness: which is taken, and why. */
static void print_choice(const stiffness_choice *c) {
  const stiffness_row *rows[] = {&c->dense, &c->factor};
  static const char *const names[] = {"DENSE", "FACTOR"};
  if (c->dense.bytes == 0.0) return;
  for (int k = 0; k < 2; ++k) {
    printf("stiffness %-6s %s %.2g s, %.1f MB", names[k],
           k == 1 && !c->exact ? "at least" : "about", rows[k]->seconds,
           rows[k]->bytes / 1e6);
    printf(c->sparse == k ? ": taken, %s\n" : "\n", c->why);
  }
}

static status print_memory(const model *m, const mesh *msh) {
  const double mega = 1e6;
  plan_bytes b;
  stiffness_choice choice;
  PASS(history_stiffness(m, msh, effect_table, &choice));
  print_choice(&choice);
  PASS(plan_memory(m, msh, -1.0, &choice, &b));
  double all = b.factor + b.contact + b.rest, left = memory_left();
  printf(
      "memory    about %.1f MB for the factor, %.1f MB for the contact, "
      "%.1f MB for the rest\n",
      b.factor / mega, b.contact / mega, b.rest / mega);
  if (all > left)
    printf(
        "memory    %s leaves %.0f MB: the run would be refused, unless "
        "contact nodes are out of reach; see --max-memory\n",
        memory_limit_of(), floor(left / mega));
  return OK;
}

/* Motions that supports leave; ERR_SINGULAR: nothing holds one. */
static status print_motions(const model *m, const mesh *msh, int step_id) {
  static const char *const held[] = {"nothing holds it", "nothing holds it",
                                     "held by friction only",
                                     "held by contact only"};
  OWNED free_motion *list = NULL;
  int n = 0;
  status st = history_motions(m, msh, effect_table, step_id, &n, &list);
  for (int i = 0; i < n; ++i)
    printf("free      step %d, body %d, %s: %s\n", step_id + 1,
           list[i].body_id + 1, list[i].text, held[list[i].held_by]);
  if (n == 0 && st == OK)
    printf("supports  of step %d hold every body\n", step_id + 1);
  return st;
}

status inform_check_problem(const model *m, const exchange_problem *p) {
  printf("problem   %s: %d %s%s, %d unknown%s, condensed to %d\n", p->form,
         p->n, p->dim == 1 ? "row" : "contact", p->n == 1 ? "" : "s",
         p->unknowns, p->unknowns == 1 ? "" : "s", p->m);
  return print_plan(m, NULL, p->n);
}

status inform_check(const model *m, const mesh *msh) {
  print_sizes(m, msh);
  PASS(print_memory(m, msh));
  PASS(print_plan(m, msh, 0));
  /* Supports are removed only where *BOUNDARY, OP=NEW ends some. */
  for (int i = 0; i < m->n.step; ++i)
    if (i == 0 || m->steps[i].renewed >> LOAD_FIXING & 1u)
      PASS(print_motions(m, msh, i));
  PASS(history_check(m, msh, effect_table));
  return history_ranges(m, msh, effect_table);
}
