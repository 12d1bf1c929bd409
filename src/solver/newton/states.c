/* States of the nodes: open, closed, stick, slip (system.h). */
#include "solver/newton/system.h"

#include "base/base.h"
#include "base/number.h"

static const double WARM_SLIP = 0x1p-20; /* -, of g: counts as slipping at the
                                            start */

/* Of each unknown alone, and the mean over a tangent plane. */
static void set_stiffness(const contact_problem *cp, states *s) {
  double largest = 0.0;
  for (int i = 0; i < cp->m; ++i)
    largest = fmax(largest, contact_diagonal(cp, i));
  for (int i = 0; i < cp->m; ++i) {
    double d = contact_diagonal(cp, i);
    s->k[i] = contact_has_stiffness(cp) ? d : 1.0 / (d > 0.0 ? d : largest);
  }
  for (int i = 0; i < cp->n; ++i) {
    double sum = 0.0;
    for (int k = 1; k < cp->dim; ++k)
      sum += contact_diagonal(cp, i * cp->dim + k);
    sum /= cp->dim > 1 ? cp->dim - 1 : 1;
    s->c[i] =
        contact_has_stiffness(cp) ? sum : 1.0 / (sum > 0.0 ? sum : largest);
  }
}

status states_new(const contact_problem *cp, states *s) {
  size_t m = cp->m;
  PASS(pattern_new(cp->dim, cp->n, &s->guess));
  PASS_NEW_REALS(cp->n, &s->c, &s->g, &s->rounding);
  PASS_NEW_ALL(OF(s->raw, m), OF(s->k, m));
  set_stiffness(cp, s);
  return OK;
}

/* ---- reaction ------------------------------------------------------------ */

/* |r_t| = g at a slipping node: the force along e is set to the limit, or,
 * where a small error of the pressure makes a large one of the limit (mu > 1),
 * the pressure to the force. */
static void clean_slip(const states *s, int node_id) {
  const contact_problem *cp = s->cp;
  double *r = s->r + node_id * cp->dim, size = 0.0, mu = 0.0;
  for (int k = 1; k < cp->dim; ++k)
    if (!contact_held(cp, node_id * cp->dim + k)) size += r[k] * r[k];
  size = sqrt(size);
  double g = contact_node_limit(cp, s->r, node_id);
  for (int k = row_begin(cp->B, node_id); k < row_end(cp->B, node_id); ++k)
    if (cp->B->col[k] == node_id) mu = cp->B->val[k];
  if (mu > 1.0 && s->guess.closed[node_id * cp->dim] && r[0] < 0.0) {
    double p = -r[0] + (size - g) / mu;
    if (p > 0.0) r[0] = -p;
    return;
  }
  for (int k = 1; k < cp->dim && size > 0.0; ++k)
    if (!contact_held(cp, node_id * cp->dim + k)) r[k] *= g / size;
}

/* u from raw, the compliance form. */
static void clean_displacement(const states *s) {
  const contact_problem *cp = s->cp;
  for (int dof = 0; dof < cp->m; ++dof) {
    int stick = dof % cp->dim > 0 && s->guess.mode[dof / cp->dim] == STICK;
    if (contact_held(cp, dof)) continue;
    if (s->guess.closed[dof])
      s->u[dof] = contact_bound(cp, dof);
    else
      s->u[dof] = stick ? contact_stick(cp, dof) : s->raw[dof];
  }
}

void states_clean(const states *s) {
  const contact_problem *cp = s->cp;
  if (!contact_has_stiffness(cp)) {
    clean_displacement(s);
    return;
  }
  COPY(s->r, s->raw, cp->m);
  for (int dof = 0; dof < cp->m; ++dof) {
    int k = dof % cp->dim;
    int none = !s->guess.closed[dof] &&
               (k == 0 || s->guess.mode[dof / cp->dim] == FREE);
    if (none || contact_held(cp, dof)) s->r[dof] = 0.0;
  }
  for (int node_id = 0; node_id < cp->n; ++node_id)
    if (s->guess.mode[node_id] == SLIP) clean_slip(s, node_id);
}

/* ---- states ------------------------------------------------------------ */

/* A node slips: direction and turning stiffness from z. */
static void set_slip(states *s, int node_id, const double *z, double size,
                     double g) {
  int tangents = s->cp->dim - 1;
  s->guess.mode[node_id] = SLIP;
  for (int k = 0; k < tangents; ++k)
    s->guess.e[node_id * tangents + k] = z[k] / size;
  double c = s->c[node_id];
  s->guess.kappa[node_id] =
      size - g > 0x1p-20 * g ? c * g / (size - g) : 0x1p20 * c;
}

/* State of friction from z = r_t - c slip; the state before decides ties. */
static void friction_state(states *s, int node_id, int fresh) {
  int tangents = s->cp->dim - 1, first = node_id * s->cp->dim + 1;
  tangent before = fresh ? FREE : (tangent)s->guess.mode[node_id];
  double slip[2], z[2], size = 0.0, along = 0.0;
  double g = s->g[node_id] = contact_node_limit(s->cp, s->r, node_id);
  double margin = s->rounding[node_id];
  newton_slip(s->cp, s->u, node_id, slip);
  for (int k = 0; k < tangents; ++k) {
    double force = contact_held(s->cp, first + k) ? 0.0 : s->r[first + k];
    z[k] = before == STICK ? force : force - s->c[node_id] * slip[k];
    size += z[k] * z[k];
    along += s->guess.e[node_id * tangents + k] * slip[k];
  }
  size = sqrt(size);
  if (!(g > 0.0)) {
    s->guess.mode[node_id] = FREE;
    return;
  }
  if (before == SLIP && tangents == 1 && along * s->c[node_id] <= margin)
    return;
  s->guess.mode[node_id] = STICK;
  if (before == SLIP && along * s->c[node_id] > margin) return;
  if (fresh ? size < g * (1.0 - WARM_SLIP) : size <= g + margin) return;
  if (size > 0.0) set_slip(s, node_id, z, size, g);
}

/* Normal or side unknown: 1 closed. */
static int closed_state(states *s, int dof, int fresh) {
  double over = s->k[dof] * (s->u[dof] - contact_bound(s->cp, dof));
  double margin = s->rounding[dof / s->cp->dim];
  if (fresh) return s->r[dof] <= over;
  if (s->guess.closed[dof]) return s->r[dof] <= margin;
  return over > margin;
}

/* Friction of a node under the guess, to undo a change. */
typedef struct node_friction {
  unsigned char mode;
  double e[2], kappa;
} node_friction;

static node_friction friction_of(const states *s, int node_id) {
  node_friction f = {.mode = s->guess.mode[node_id],
                     .kappa = s->guess.kappa[node_id]};
  for (int k = 0; k < s->cp->dim - 1; ++k)
    f.e[k] = s->guess.e[node_id * (s->cp->dim - 1) + k];
  return f;
}

static void restore_friction(states *s, int node_id, const node_friction *f) {
  s->guess.mode[node_id] = f->mode;
  s->guess.kappa[node_id] = f->kappa;
  for (int k = 0; k < s->cp->dim - 1; ++k)
    s->guess.e[node_id * (s->cp->dim - 1) + k] = f->e[k];
}

/* 1: postpone this change. Reproducible: the random numbers start from the same
 * seed. */
static int put_off(states *s, int changes) {
  if (s->careful) return changes > 0;
  if (s->dice == 0) return 0;
  s->dice ^= s->dice << 13;
  s->dice ^= s->dice >> 7;
  s->dice ^= s->dice << 17;
  return (int)(s->dice >> 60 & 1u);
}

/* Change the wrongly guessed bounds of a node; returns their number. */
static int next_bounds(states *s, int node_id, int fresh, int changes) {
  int before = changes;
  for (int dof = node_id * s->cp->dim; dof < (node_id + 1) * s->cp->dim;
       ++dof) {
    if (!(contact_bound(s->cp, dof) < HUGE_VAL)) continue;
    unsigned char now = (unsigned char)closed_state(s, dof, fresh);
    if (now == s->guess.closed[dof]) continue;
    if (!put_off(s, changes++)) s->guess.closed[dof] = now;
  }
  return changes - before;
}

int states_next(states *s, int fresh) {
  const contact_problem *cp = s->cp;
  int changes = 0, bonded = fresh && is_zero(s->cp->m, s->r);
  if (bonded && !contact_has_stiffness(cp)) {
    /* Forces that push each node back by its own stiffness, to compare its slip
     * with: the cheapest guess of stick or slip. */
    for (int dof = 0; dof < s->cp->m; dof += s->cp->dim)
      s->r[dof] =
          fmin(0.0, -s->k[dof] * (s->u[dof] - s->cp->gap[dof / s->cp->dim]));
    bonded = 0;
  }
  contact_roundings(cp, s->u, s->r, s->rounding);
  for (int node_id = 0; node_id < cp->n; ++node_id) {
    changes += next_bounds(s, node_id, fresh, changes);
    if (cp->g0 == NULL || contact_has_side(cp, node_id)) continue;
    node_friction before = friction_of(s, node_id);
    if (bonded && s->guess.closed[node_id * cp->dim])
      s->guess.mode[node_id] = STICK;
    else
      friction_state(s, node_id, fresh);
    if (s->guess.mode[node_id] == before.mode) continue;
    if (put_off(s, changes++)) restore_friction(s, node_id, &before);
  }
  return changes;
}

void states_all_stick(states *s) {
  const contact_problem *cp = s->cp;
  memset(s->guess.closed, 0, cp->m);
  for (int i = 0; i < cp->n; ++i) {
    s->guess.closed[i * cp->dim] = 1;
    s->guess.mode[i] =
        cp->g0 != NULL && !contact_has_side(cp, i) ? STICK : FREE;
  }
}

uint64_t states_hash(const states *s) {
  uint64_t h = number_hash(HASH_START, s->guess.closed, s->cp->m);
  for (int i = 0; i < s->cp->n; ++i) {
    const unsigned char mode = s->guess.mode[i];
    const int turned = mode == SLIP && s->guess.e[i * (s->cp->dim - 1)] > 0.0;
    const unsigned char state = (unsigned char)(mode | turned << 2);
    h = number_hash(h, &state, 1);
  }
  return h;
}
