/*
 * Friction laws: each fills the sliding limit g = g0 + B p of the contact
 * nodes for a surface at time t. One law per file, one row in FRICTION_LIST.
 */
#pragma once

#include "base/option.h"
#include "contact/contact.h"
#include "contact/surface.h"

typedef struct friction_limit {
  double *g0;             /* [n] N */
  sparse_rows B;          /* [n*n] -; start == NULL if the law needs none */
  unsigned char *in_zone; /* [n] or NULL; 1: no friction where r_n = 0 */
} friction_limit;

/* One *FRICTION card: the law on the nodes of one *CONTACT. */
typedef struct friction_card {
  quantity value;             /* mu, -, or the limit g, force/length^2 (dim
                                 3) or force/length^2 times thickness: a
                                 traction */
  const void *param;          /* [law->param_size] its options */
  const sparse_rows *average; /* [n*n] of law->average; NULL: local friction */
} friction_card;

typedef struct friction_ops {
  const char *name, *reference;        /* as in LAW=, source */
  const char *help;                    /* one line for --list friction */
  const char *value_name, *value_unit; /* the data line: "mu", "-" */
  size_t param_size;
  const option *options;
  /* Reason why the options do not apply to a model of that kind; NULL: they do.
   * NULL pointer: always. */
  const char *(*misfit)(const void *param, int dim, int axisymmetric);
  /* Limit per mu from the normal forces, -: rows of the nodes of the contact,
   * columns of the whole surface. Made once per surface; out all zero before.
   * Warnings go to the log with "at". NULL: the force of the node itself. */
  status (*average)(const friction_card *card, const contact_surface *s,
                    const surface_input *in, int contact_id, const place *at,
                    message_log *log, sparse_rows *out);
  /* Add the law's part for contact nodes node[0..n_node) to out (rows of the
   * whole surface, all zero before); none where surface_is_corner. ERR_DECK if
   * the value is negative or not a number at a node (message names node and
   * time). */
  status (*limit)(const friction_card *card, const contact_surface *s,
                  int n_node, const int *node, double t, friction_limit *out);
} friction_ops;

#define FRICTION_LIST(X) X(none) X(tresca) X(coulomb) X(nonlocal)
#define FRICTION_EXTERN(name) extern const friction_ops name##_friction;
FRICTION_LIST(FRICTION_EXTERN)
extern const friction_ops *const friction_list[]; /* NULL at the end */
/* The law of that name, case ignored, or NULL. */
const friction_ops *friction_find(const char *name);

/* All zero for a surface of n nodes. */
status friction_limit_new(int n, friction_limit *out);
void friction_limit_free(friction_limit *limit); /* accepts all-zero, NULL */

/* For the laws. */
extern const option friction_no_options[]; /* a law without options */

/* Value of the card at contact node i, not negative; ERR_DECK otherwise. */
status friction_value(const friction_card *card, const contact_surface *s,
                      int i, double t, double *value);
