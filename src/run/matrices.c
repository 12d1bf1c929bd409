/*
 * The matrix in use with its contact solver, and the contact nodes that it has.
 */
#include "base/system/blas.h"
#include "run/run.h"

int run_step_id(const run *r) { return (int)(r->step - r->m->steps); }

const material *run_material(const run *r, int elem_id) {
  const model *m = r->m;
  return &m->materials[m->sections[m->elem_section[elem_id]].material_id];
}

const double *run_elasticity(const run *r, int elem_id) {
  const moduli *x = &r->body.moduli;
  const int *of = x->section_id != NULL ? x->section_id : r->m->elem_section;
  return x->E + (size_t)(r->m->ns * r->m->ns) * of[elem_id];
}

void matrices_free(matrices *m) {
  contact_solver_free(&m->solver);
  condensed_free(m->c);
  RELEASE(m->k, m->E);
  *m = (matrices){0};
}

void run_forget_estimates(run *r) { known_rate_forget(&r->solving.rate); }

static status new_solver(const run *r, matrices *m) {
  PASS(contact_solver_new(&r->step->solver, &m->solver));
  if (m->from == NULL) return OK;
  archive_go(m->from, m->group);
  const status st = contact_solver_keep(m->solver, m->from);
  archive_go(m->from, "");
  m->from = NULL;
  return st;
}

/* Of the present group. */
static status keep_operator(matrices *m, archive *a) {
  int there = m->c != NULL;
  PASS(archive_ints(a, "operator", &there, 1));
  return there && m->c != NULL ? condensed_keep(m->c, a) : OK;
}

status matrices_follow(matrices *m) {
  if (m->from == NULL) return OK;
  archive_go(m->from, m->group);
  const status st = keep_operator(m, m->from);
  archive_go(m->from, "");
  return st;
}

status matrices_keep(matrices *m, archive *a, const char *group) {
  int there = m->solver != NULL;
  if (!archive_reads(a) && !there && m->from != NULL)
    return archive_pass_on(m->from, m->group, a);
  IN_GROUP(a, group);
  PASS(archive_ints(a, "solver", &there, 1));
  PASS(keep_operator(m, a));
  if (!archive_reads(a) || m->solver != NULL)
    return there ? contact_solver_keep(m->solver, a) : OK;
  if (there) {
    m->from = a;
    snprintf(m->group, sizeof m->group, "%s", archive_group(a));
  }
  return OK;
}

status run_renew_elastic(run *r) {
  r->body.stale = 0;
  r->c = NULL;
  ++r->body.elastic_no;
  matrices_free(&r->elastic);
  PASS(stiffness_assemble(&r->body.d, &r->elastic.k));
  return condense(r->elastic.k, &r->body.d, &r->elastic.c);
}

status run_use(run *r, matrices *m) {
  if (m == &r->elastic && r->body.stale) PASS(run_renew_elastic(r));
  if (m->solver == NULL) PASS(new_solver(r, m));
  int read = r->solving.known_key != RUN_NO_KEY;
  if (read ? r->solving.known_key != m->key : r->c != m->c)
    run_forget_estimates(r);
  r->solving.matrix_no += r->c != m->c;
  r->c = m->c;
  blas_rows(r->nodes.n_row);
  r->solver = m->solver;
  r->solving.known_key = RUN_NO_KEY;
  /* An increment may end before it is posed. */
  r->problem.cp.A = condensed_matrix(r->c);
  r->problem.cp.op = condensed_operator(r->c);
  r->problem.cp.bodies = contact_solver_bodies(r->solver, &r->problem.cp);
  return OK;
}

void run_take_nodes(run *r) {
  r->body.d.in = r->nodes.active.in;
  r->body.d.n_in = r->nodes.active.n_in;
  r->nodes.n_row = r->nodes.rows * active_count(&r->nodes.active, r->nodes.n);
}

status run_room_for_part(run *r) {
  const int apart =
      r->nodes.n_row < r->nodes.n_c || surface_has_held(r->surface);
  for (int k = 0; k < 2 && apart && r->problem.row[k] == NULL; ++k)
    PASS_NEW(r->problem.row[k], r->nodes.rows * r->nodes.n);
  if (r->nodes.active.in != NULL && r->problem.part.gap == NULL)
    PASS(active_part_new(r->nodes.n, r->nodes.rows, &r->problem.part));
  return OK;
}

int run_misses_nodes(const run *r) {
  if (r->nodes.active.in == NULL) return 0;
  return r->solving.report.outcome <= 0 ||
         active_too_few(&r->nodes.active, r->nodes.n, r->problem.gap, r->now.uc,
                        r->msh->dim);
}

status run_renew_nodes(run *r) {
  r->c = NULL;
  matrices_free(&r->elastic);
  run_take_nodes(r);
  PASS(run_room_for_part(r));
  PASS(run_choose_stiffness(r));
  PASS(run_renew_elastic(r));
  return run_use(r, &r->elastic);
}

status run_add_nodes(run *r) {
  PASS(active_extend(&r->nodes.active, r->nodes.n, r->problem.gap, r->now.uc,
                     r->msh->dim, r->solving.report.outcome <= 0));
  return run_renew_nodes(r);
}
