/* src/run/start/coarser.c, effects/errors/nested.c: contact problems that start
 * from the solution on a coarser mesh. */
#include "effects/rows.h"
#include "run/history/history.h"
#include "run/start/coarser.h"
#include "support/text_model.h"
#include "support/unit.h"

enum { MOST = 400 };

/* Nodes of two contacts, each with a frame that is turned otherwise. */
typedef struct cloud {
  contact_surface s;
  int contact_id[MOST], side_id[2 * MOST];
  double x[3 * MOST], area[MOST], frame[9 * MOST];
  double rc[3 * MOST], gap[MOST], slip[2 * MOST];
  contact_status contact[MOST];
} cloud;

/* Reproducible, between 0 and 1. */
static double number(void) {
  static unsigned long seed = 12345;
  seed = (seed * 1103515245u + 12345u) % 2147483648u;
  return (double)seed / 2147483648.0;
}

static void make_cloud(cloud *c, int dim, int n) {
  memset(c, 0, sizeof *c);
  for (int i = 0; i < 2 * MOST; ++i) c->side_id[i] = -1;
  for (int i = 0; i < n; ++i) {
    c->contact_id[i] = number() < 0.5;
    c->area[i] = 0.5 + number();
    for (int k = 0; k < dim; ++k) c->x[dim * i + k] = (k == 1) * number();
    c->x[dim * i] = 3 * number();
    /* Turned in the plane of the first two axes. */
    double a = 6 * number(), *f = c->frame + dim * dim * i;
    f[0] = f[dim + 1] = cos(a);
    f[1] = sin(a);
    f[dim] = -sin(a);
    if (dim == 3) f[8] = 1.0;
  }
  c->s = (contact_surface){.dim = dim,
                           .n = n,
                           .contact_id = c->contact_id,
                           .side_id = c->side_id,
                           .x = c->x,
                           .area = c->area,
                           .frame = c->frame};
}

static contact_view view_of(const cloud *c, double t) {
  return (contact_view){t, c->rc, c->gap, c->slip, c->contact};
}

static double square(const cloud *a, int i, const cloud *b, int k) {
  double sum = 0;
  for (int c = 0; c < a->s.dim; ++c) {
    double d = a->x[a->s.dim * i + c] - b->x[a->s.dim * k + c];
    sum += d * d;
  }
  return sum;
}

/* Long along y. */
static void swap_axes(cloud *c) {
  for (int i = 0; i < c->s.n; ++i) {
    double *x = c->x + c->s.dim * i, along = x[0];
    x[0] = x[1];
    x[1] = along;
  }
}

TEST(node_is_the_nearest_of_its_contact) {
  static cloud coarse, fine;
  for (int turn = 0; turn < 4; ++turn) {
    const int dim = 2 + turn % 2;
    OWNED coarser *c = NULL;
    int nearest[MOST];
    make_cloud(&coarse, dim, 60);
    make_cloud(&fine, dim, MOST);
    if (turn >= 2) swap_axes(&coarse);
    if (turn >= 2) swap_axes(&fine);
    for (int i = 0; i < 10; ++i) coarse.contact_id[i] = 0;
    fine.contact_id[0] = 7;
    ck_assert_int_eq(coarser_new(&c), OK);
    const contact_view v = view_of(&coarse, 1.0);
    ck_assert_int_eq(coarser_add(c, &coarse.s, &v), OK);
    const coarser_state *x = coarser_at(c, 1.0, 0);
    ck_assert_int_eq(coarser_match(x, &fine.s, nearest), OK);
    ck_assert_int_eq(nearest[0], -1);
    ck_assert_int_eq(coarser_contact(x, nearest[0]), CONTACT_OPEN);
    for (int i = 1; i < MOST; ++i) {
      double best = HUGE_VAL;
      for (int k = 0; k < 60; ++k)
        if (coarse.contact_id[k] == fine.contact_id[i])
          best = fmin(best, square(&fine, i, &coarse, k));
      ck_assert_int_eq(coarse.contact_id[nearest[i]], fine.contact_id[i]);
      ck_assert_double_eq(square(&fine, i, &coarse, nearest[i]), best);
    }
  }
}

/* A pressure of 3 down the y axis and a shear of 2 along x, in frames turned
 * by some angle there and another one here. */
TEST(tractions_and_slip_are_those_in_space) {
  static cloud coarse, fine;
  OWNED coarser *c = NULL;
  coarser_node node;
  make_cloud(&coarse, 2, 3);
  make_cloud(&fine, 2, 1);
  for (int i = 0; i < 3; ++i) {
    const double *f = coarse.frame + 4 * i;
    for (int a = 0; a < 2; ++a)
      coarse.rc[2 * i + a] = coarse.area[i] * (2 * f[2 * a] - 3 * f[2 * a + 1]);
    coarse.slip[i] = 0.01;
    coarse.gap[i] = 0.2;
    coarse.contact[i] = (contact_status)i;
  }
  ck_assert_int_eq(coarser_new(&c), OK);
  const contact_view v = view_of(&coarse, 1.0);
  ck_assert_int_eq(coarser_add(c, &coarse.s, &v), OK);
  const coarser_state *x = coarser_at(c, 1.0, 0);
  for (int i = 0; i < 3; ++i) {
    const double *from = coarse.frame + 4 * i, *f = fine.frame;
    const int open = coarse.contact[i] == CONTACT_OPEN;
    const int slips = coarse.contact[i] == CONTACT_SLIP;
    coarser_read(x, i, &fine.s, 0, &node);
    for (int a = 0; a < 2; ++a)
      ck_assert_double_eq_tol(
          node.traction[a], open ? 0 : 2 * f[2 * a] - 3 * f[2 * a + 1], 1e-14);
    ck_assert_double_eq(node.gap, open ? 0.2 : 0);
    ck_assert_double_eq_tol(
        node.slip[0], slips ? 0.01 * (from[2] * f[2] + from[3] * f[3]) : 0,
        1e-16);
  }
}

TEST(increments_are_found_by_their_time) {
  static cloud coarse;
  OWNED coarser *c = NULL;
  make_cloud(&coarse, 2, 2);
  ck_assert_int_eq(coarser_new(&c), OK);
  for (int k = 1; k <= 3; ++k) {
    const contact_view v = view_of(&coarse, 0.1 * k);
    ck_assert_int_eq(coarser_add(c, &coarse.s, &v), OK);
  }
  ck_assert_double_eq(coarser_time(coarser_at(c, 0.3, 0)), 0.1 * 3);
  ck_assert_ptr_null(coarser_at(c, 0.25, 0));
  ck_assert_double_eq(coarser_time(coarser_at(c, 0.15, 1)), 0.2);
  ck_assert_ptr_null(coarser_at(c, 0.4, 1));
}

/* ---- runs ----------------------------------------------------------------
 */

/* Pressed on a rough floor and pushed: to and fro, with a gap at one end, or by
 * a force that grows with the pressure. */
#define PUSHED(to_and_fro, gap)                                               \
  "*MESH, FILE=none.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"           \
  "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"                                  \
  "*AMPLITUDE, NAME=FRO\n" to_and_fro "\n*OBSTACLE, NAME=O, TYPE=GAP\n\"" gap \
  "\"\n"                                                                      \
  "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"                              \
  "*FRICTION, CONTACT=C, LAW=COULOMB\n0.4\n"                                  \
  "*STEP\n*QUASISTATIC\n0.25, 1.\n*DSLOAD\nTOP, P, 10.\n"                     \
  "LEFT, TX, 0.6, FRO\nRIGHT, TX, 0.6, FRO\n*OUTPUT, HDF5=NO\n"               \
  "*END STEP\n"
static const char to_and_fro[] =
    PUSHED("0., 0., 0.25, 1., 1., -2.", "if(x > 3, 0.004*(x - 3)^2, 0)");
static const char growing[] = PUSHED("0., 0., 1., 1.", "0");
enum { DOFS = 2000 };

typedef void spoiler(int n, cloud *c);

/* What a run leaves: its contact as it was found, or changed by "spoil". */
typedef struct trace {
  coarser *kept;
  spoiler *spoil;
  int n, n_dof, iterations[8], started; /* increments */
  double u[DOFS];
} trace;

static status keep(void *ctx, const state *s) {
  trace *r = ctx;
  static cloud c;
  const state_contacts *x = &s->contacts;
  const size_t n = (size_t)x->surface->n;
  ck_assert_int_gt(s->report.outcome, 0);
  r->iterations[r->n++] = s->report.iterations;
  r->started += s->note != NULL && strstr(s->note, "coarser mesh") != NULL;
  memcpy(r->u, s->body.u, (size_t)r->n_dof * sizeof *r->u);
  memcpy(c.rc, x->rc, 2 * n * sizeof *c.rc);
  memcpy(c.gap, x->gap, n * sizeof *c.gap);
  memcpy(c.slip, x->slip, n * sizeof *c.slip);
  memcpy(c.contact, x->contact, n * sizeof *c.contact);
  if (r->spoil != NULL) r->spoil((int)n, &c);
  const contact_view v = view_of(&c, s->t);
  return coarser_add(r->kept, x->surface, &v);
}

static trace run_on(const char *text, int cells, const coarser *from,
                    spoiler *spoil) {
  const int n[] = {6 * cells, 4 * cells};
  const double length[] = {6.0, 4.0};
  trace r = {.spoil = spoil};
  int unsettled = 0;
  TEXT_MODEL s = text_model_read(text, make_grid_2d(n, length));
  ck_assert_int_eq(s.st, OK);
  ck_assert_int_eq(coarser_new(&r.kept), OK);
  r.n_dof = 2 * s.msh->n_node;
  ck_assert_int_le(r.n_dof, DOFS);
  s.m->accuracy.coarser = from;
  const history_sink sink = {.ctx = &r, .increment = keep};
  status st = history_run(s.m, s.msh, effect_table, &sink, &unsettled);
  ck_assert_msg(st == OK, "%s", status_message());
  ck_assert_int_eq(unsettled, 0);
  return r;
}

static double far_apart(const trace *a, const trace *b) {
  double worst = 0, most = 0;
  for (int i = 0; i < a->n_dof; ++i) {
    worst = fmax(worst, fabs(a->u[i] - b->u[i]));
    most = fmax(most, fabs(a->u[i]));
  }
  return worst / most;
}

TEST(coarser_mesh_saves_steps) {
  trace coarse = run_on(to_and_fro, 2, NULL, NULL),
        cold = run_on(to_and_fro, 4, NULL, NULL);
  trace fine = run_on(to_and_fro, 4, coarse.kept, NULL);
  ck_assert_int_eq(coarse.started + cold.started, 0);
  ck_assert_int_ge(fine.started, 1);
  ck_assert_msg(fine.iterations[0] <= 3 && cold.iterations[0] >= 5,
                "%d steps, cold %d", fine.iterations[0], cold.iterations[0]);
  ck_assert_double_lt(far_apart(&cold, &fine), 1e-12);
  /* On its own mesh the solution itself is the start. */
  trace again = run_on(to_and_fro, 4, cold.kept, NULL);
  ck_assert_int_eq(again.iterations[0], 1);
  ck_assert_double_lt(far_apart(&cold, &again), 1e-12);
  memory_free(coarse.kept);
  memory_free(cold.kept);
  memory_free(fine.kept);
  memory_free(again.kept);
}

/* Where no state changes the last increment is nearer. */
TEST(later_increments_start_from_what_is_nearer) {
  trace coarse = run_on(growing, 1, NULL, NULL);
  trace cold = run_on(growing, 4, NULL, NULL);
  trace fine = run_on(growing, 4, coarse.kept, NULL);
  ck_assert_int_eq(fine.started, 1);
  for (int k = 1; k < 4; ++k)
    ck_assert_int_eq(fine.iterations[k], cold.iterations[k]);
  memory_free(coarse.kept);
  memory_free(cold.kept);
  memory_free(fine.kept);
}

static void all_open(int n, cloud *c) {
  for (int i = 0; i < n; ++i) {
    c->contact[i] = CONTACT_OPEN;
    c->gap[i] = 0.1;
  }
}

static void all_stick(int n, cloud *c) {
  for (int i = 0; i < n; ++i) {
    c->contact[i] = CONTACT_STICK;
    c->rc[2 * i] = -1e4;
    c->rc[2 * i + 1] = 1e3;
  }
}

/* Everything the other way round, forces that pull too. */
static void reversed(int n, cloud *c) {
  for (int i = 0; i < n; ++i) {
    const int open = c->contact[i] == CONTACT_OPEN;
    c->contact[i] = open ? CONTACT_SLIP : CONTACT_OPEN;
    c->gap[i] = 0.01 * i;
    c->slip[i] = i % 2 ? 0.1 : -0.1;
    c->rc[2 * i] = i % 3 ? -5.0 : 5.0;
    c->rc[2 * i + 1] = 1000 * c->slip[i];
  }
}

TEST(wrong_start_changes_no_answer) {
  spoiler *const spoil[] = {all_open, all_stick, reversed};
  trace cold = run_on(to_and_fro, 2, NULL, NULL);
  for (int k = 0; k < 3; ++k) {
    trace wrong = run_on(to_and_fro, 1, NULL, spoil[k]);
    trace fine = run_on(to_and_fro, 2, wrong.kept, NULL);
    ck_assert_int_ge(fine.started, 1);
    ck_assert_msg(far_apart(&cold, &fine) < 1e-12, "start %d: %g", k,
                  far_apart(&cold, &fine));
    memory_free(wrong.kept);
    memory_free(fine.kept);
  }
  memory_free(cold.kept);
}

UNIT_MAIN("coarser")
