/*
 * The deck of the creeping block and its runs.
 */
#include "effects/rows.h"
#include "run/history/history.h"
#include "support/creep_case.h"
#include "support/text_model.h"
#include "support/unit.h"

typedef struct follower {
  creep_end *end;
  contact_status before[64]; /* [n] of the contact                            */
} follower;

static status keep(void *ctx, const state *s) {
  follower *r = ctx;
  creep_end *e = r->end;
  const size_t n = (size_t)s->contacts.problem->n;
  ck_assert_uint_le(n, 64);
  memcpy(e->u, s->body.u, (size_t)e->n_dof * sizeof *e->u);
  if (s->step_no == 2 && s->increment_no > 1)
    e->changes += memcmp(r->before, s->contacts.contact,
                         n * sizeof *s->contacts.contact) != 0;
  memcpy(r->before, s->contacts.contact, n * sizeof *s->contacts.contact);
  e->n_slip = s->contacts.n_slip;
  e->n_stick = s->contacts.n_stick;
  return OK;
}

static mesh *block(int solid) {
  const int cells[2][3] = {{4, 2, 0}, {4, 1, 2}};
  const double length[3] = {1, 1, 1};
  return solid ? make_grid_3d(cells[1], length)
               : make_grid_2d(cells[0], length);
}

creep_end creep_case_run(const creep_case *c, const char *integrator, int n) {
  creep_end end = {0};
  follower r = {.end = &end};
  const int solid = strcmp(c->section, "C3D4") == 0;
  const char *top = solid ? "BACK" : "TOP";
  char text[2000];
  const int length = snprintf(
      text, sizeof text,
      "*MESH, FILE=none.msh\n*MATERIAL, NAME=M\n*ELASTIC\n%s\n%s"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=%s\n"
      "*AMPLITUDE, NAME=GROWTH\n\"1 + %.17g*sin(t/%.17g)\"\n"
      "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
      "*CONTACT, NAME=C, GROUP=%s, OBSTACLE=O\n"
      "*FRICTION, CONTACT=C, LAW=COULOMB\n%s\n%s"
      "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\n%s"
      "*DSLOAD\n%s, P, %.17g\n*END STEP\n"
      "*STEP\n*VISCO, INTEGRATOR=%s\n%.17g, %.17g\n"
      "*DSLOAD\n%s, P, %.17g, GROWTH\n%s"
      "*SOLVER, METHOD=NEWTON, TOL=1E-14\n*OUTPUT, HDF5=NO\n*END STEP\n",
      c->elastic, c->law, c->section, c->growth, c->total,
      solid ? "FRONT" : "BOTTOM", c->friction, c->model,
      !solid    ? ""
      : c->free ? "BOTTOM, 2\n"
                : "BOTTOM, 2\nTOP, 2\n",
      top, c->pressure, integrator, c->total / n, c->total, top, c->pressure,
      c->step);
  ck_assert_int_lt(length, (int)sizeof text);
  text_model s;
  s = text_model_read(text, block(solid));
  ck_assert_int_eq(s.st, OK);
  end.n_dof = s.msh->dim * s.msh->n_node;
  ck_assert_int_le(end.n_dof, 256);
  const history_sink sink = {.ctx = &r, .increment = keep};
  int unsettled = 0;
  const status st = history_run(s.m, s.msh, effect_table, &sink, &unsettled);
  ck_assert_msg(st == OK && unsettled == 0, "%s, %d increments: %s", integrator,
                n, st == OK ? "a tolerance was missed" : status_message());
  text_model_close(&s);
  return end;
}

double creep_distance(const creep_end *a, const creep_end *b) {
  double sum = 0;
  for (int i = 0; i < a->n_dof; ++i) sum += pow(a->u[i] - b->u[i], 2);
  return sqrt(sum);
}

double creep_case_order(const creep_case *c, const char *integrator, int n) {
  creep_end e[3];
  for (int k = 0; k < 3; ++k) {
    e[k] = creep_case_run(c, integrator, n << k);
    ck_assert_int_gt(e[k].n_slip, 0);
    ck_assert_int_gt(e[k].n_stick, 0);
    ck_assert_int_eq(e[k].changes, 0);
  }
  return log2(creep_distance(&e[0], &e[1]) / creep_distance(&e[1], &e[2]));
}
