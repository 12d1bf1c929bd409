#include "model/course.h"

#include "base/base.h"

static const double APART = 0x1p-40; /* -, of the time: points of their own */
static const double SMALL = 1e-6;    /* -, of the largest value: no turn */

/* ---- which there are ------------------------------------------------------*/

/* A load that varies in space is looked at in three places. */
enum { PLACES = 3, OF_OBSTACLE = 4, OF_CONTACT = 3 };

int course_count(const model *m, const step *s) {
  return PLACES * s->loads.n + OF_OBSTACLE * m->n.obstacle +
         OF_CONTACT * m->n.contact;
}

static int of_load(const mesh *msh, const step *s, int k, course *out) {
  static const unsigned space = 1u << TABLE_X | 1u << TABLE_Y | 1u << TABLE_Z;
  const load *l = &s->loads.item[k / PLACES];
  const mesh_group *g = &msh->group[l->group_id];
  const int number = k % PLACES;
  if (l->run == RUN_HELD || g->n_node == 0) return 0;
  if (number > 0 && !(quantity_variables(&l->value) & space)) return 0;
  const int node = g->node_id[(g->n_node - 1) * number / (PLACES - 1)];
  *out = (course){.value = &l->value, .l = l, .s = s};
  for (int c = 0; c < msh->dim; ++c)
    out->x[c] = msh->x[(size_t)msh->dim * node + c];
  return 1;
}

int course_at(const model *m, const mesh *msh, const step *s, int k,
              course *out) {
  if (k < PLACES * s->loads.n) return of_load(msh, s, k, out);
  *out = (course){.s = s};
  k -= PLACES * s->loads.n;
  if (k < OF_OBSTACLE * m->n.obstacle) {
    const obstacle *o = &m->obstacles[k / OF_OBSTACLE];
    const int part = k % OF_OBSTACLE;
    out->value = part < 3 ? &o->motion[part] : &o->angle;
  } else {
    k -= OF_OBSTACLE * m->n.obstacle;
    const int id = k / OF_CONTACT;
    const friction_rule *rule = friction_in_force(m, (int)(s - m->steps), id);
    const quantity *const of[OF_CONTACT] = {&rule->card.value,
                                            &m->contacts[id].change.value,
                                            &m->contacts[id].force.value};
    out->value = of[k % OF_CONTACT];
  }
  return (quantity_variables(out->value) & 1u << TABLE_T) != 0;
}

double value_of_course(const course *c, double t) {
  return c->l != NULL ? load_at_point(c->l, c->s, c->x, t)
                      : quantity_value(c->value, c->x, t);
}

int course_points(const course *c, double after, double t, int *n) {
  const value_table *table = c->value->factor;
  const double least = APART * fmax(fabs(after), fabs(t));
  const double start = c->value->factor_start;
  int first = 0;
  *n = 0;
  if (table == NULL || table->variable != TABLE_T) return 0;
  while (first < table->n && table->at[first] + start <= after + least) ++first;
  while (first + *n < table->n && table->at[first + *n] + start < t - least)
    ++*n;
  return first;
}

/* ---- where they turn ------------------------------------------------------*/

int turns_add(turn_list *list, double t) {
  int k = list->n;
  for (int i = 0; i < list->n; ++i)
    if (list->at[i] == t) return 1;
  if (list->n == TURNS) return 0;
  for (; k > 0 && list->at[k - 1] > t; --k) list->at[k] = list->at[k - 1];
  list->at[k] = t;
  ++list->n;
  return 1;
}

/* The maximum (sign 1) or minimum (-1) from a to c next to b, by sections of
 * the golden ratio; b if that is beyond it, as a point of a table is. */
static double turn_in(const course *of, double sign, const double at[3]) {
  static const double ratio = 0.6180339887498949; /* (sqrt(5) - 1)/2 */
  double a = at[0], c = at[2];
  double x = c - ratio * (c - a), y = a + ratio * (c - a);
  double vx = sign * value_of_course(of, x), vy = sign * value_of_course(of, y);
  while (c - a > APART * (at[2] - at[0]) && x < y) {
    if (vx > vy) {
      c = y;
      y = x;
      vy = vx;
      x = c - ratio * (c - a);
      vx = sign * value_of_course(of, x);
    } else {
      a = x;
      x = y;
      vx = vy;
      y = a + ratio * (c - a);
      vy = sign * value_of_course(of, y);
    }
  }
  return fmax(vx, vy) > sign * value_of_course(of, at[1]) ? x : at[1];
}

/* A course on its way from t0 to t. */
typedef struct scan {
  const course *c;
  double ends[2]; /* of the increment, s */
  double first;   /* value at t0 */
  double largest; /* magnitude so far, and at the ends of the step */
  double sign;    /* 1: it rises, -1: it falls, 0: neither so far */
  double top;     /* value farthest on that way, */
  double at[3];   /* s, its time between those looked at next to it */
  double turn[2]; /* s, the last two turns, t0 at first */
  double turned;  /* sign before the last turn; 0: none */
} scan;

static double apart(const scan *s) { return SMALL * s->largest; }

/* Adds the last turn unless a time that is listed, between the turns before and
 * "next", has the same value. */
static int add_turn(const scan *s, double next, turn_list *list) {
  double before = s->turn[0], after = next;
  const double t = s->turn[1];
  if (s->turned == 0.0) return 1;
  for (int i = 0; i < list->n; ++i) {
    if (list->at[i] <= t) before = fmax(before, list->at[i]);
    if (list->at[i] >= t) after = fmin(after, list->at[i]);
  }
  const double v = s->turned * value_of_course(s->c, t);
  const double seen = fmax(s->turned * value_of_course(s->c, before),
                           s->turned * value_of_course(s->c, after));
  return v - seen > apart(s) ? turns_add(list, t) : 1;
}

/* The value at t, after that at s->at[1] or later; 0: the list is full. */
static int look(scan *s, double t, double v, double before, turn_list *list) {
  int all = 1;
  if (s->sign == 0.0 && fabs(v - s->first) > apart(s))
    s->sign = v > s->first ? 1.0 : -1.0;
  if (s->sign * (s->top - v) > apart(s)) {
    if (s->at[2] <= s->at[1]) s->at[2] = t;
    const double turn = turn_in(s->c, s->sign, s->at);
    all = add_turn(s, turn, list);
    s->turn[0] = s->turn[1];
    s->turn[1] = turn;
    s->turned = s->sign;
    s->sign = -s->sign;
    s->top = v;
  }
  if (s->sign * (v - s->top) >= 0.0) {
    s->top = v;
    s->at[0] = before;
    s->at[1] = s->at[2] = t;
  } else if (s->at[2] <= s->at[1]) {
    s->at[2] = t;
  }
  return all;
}

enum { PARTS = 64 };

/* The next time after t at which the course is looked at: parts of the
 * increment, points of its table. */
static double next_look(const course *c, const double ends[2], int *part,
                        int *point, int end_point) {
  const double by_part =
      *part == PARTS ? ends[1] : ends[0] + (ends[1] - ends[0]) * *part / PARTS;
  if (*point < end_point) {
    const double at = c->value->factor->at[*point] + c->value->factor_start;
    *point += at <= by_part;
    *part += at == by_part;
    if (at <= by_part) return at;
  }
  ++*part;
  return by_part;
}

int course_turns(const course *c, double t0, double t, turn_list *list) {
  if (c->l != NULL && c->l->run == RUN_RAMP)
    return value_of_course(c, t0) != value_of_course(c, t);
  int n, part = 1, point = course_points(c, t0, t, &n), all = 1;
  const int end_point = point + n;
  const double first = value_of_course(c, t0),
               slope = (value_of_course(c, t) - first) / (t - t0);
  scan s = {.c = c, .ends = {t0, t}, .first = first, .top = first};
  double bent = 0.0, before = t0;
  for (int i = 0; i < 3; ++i) s.at[i] = s.turn[i / 2] = t0;
  s.largest = fmax(fabs(value_of_course(c, c->s->start)),
                   fabs(value_of_course(c, step_end(c->s))));
  while (part <= PARTS) {
    const double at = next_look(c, s.ends, &part, &point, end_point);
    const double v = value_of_course(c, at);
    s.largest = fmax(s.largest, fabs(v));
    bent = fmax(bent, fabs(v - first - slope * (at - t0)));
    all &= look(&s, at, v, before, list);
    before = at;
  }
  if (!(all & add_turn(&s, t, list))) return -1;
  if (s.sign == 0.0) return 0;
  return bent > apart(&s) ? 2 : 1;
}
