/*
 * Restart data: the state an increment starts from that does not follow from
 * the matrices, into an archive and back.
 */
#include "run/setup/setup.h"

/* The nodes of a continued run. */
static status keep_nodes(run *r, archive *a) {
  ENDS_BY(active_free) active_nodes x = r->nodes.active;
  x.in = NULL;
  PASS(archive_reals(a, "reach", &x.distance, 1));
  PASS(archive_ints(a, "reach_passes", &x.passes, 1));
  PASS(archive_ints(a, "nodes_in", &x.n_in, 1));
  if (!archive_reads(a))
    return archive_ints(a, "in", r->nodes.active.in, x.n_in);
  if (x.n_in > 0) PASS_NEW(x.in, r->nodes.n);
  PASS(archive_ints(a, "in", x.in, x.n_in));
  r->nodes.active.distance = x.distance;
  r->nodes.active.passes = x.passes;
  if (active_is_same(&x, &r->nodes.active)) return OK;
  active_nodes old = r->nodes.active;
  r->nodes.active = x;
  x = old;
  return run_renew_nodes(r);
}

static status keep_equilibrium(const run *r, equilibrium *e, archive *a) {
  size_t m = r->nodes.n_c, strains = strains_kept(r);
  size_t elements = e->temperature == NULL ? 0 : r->msh->n_elem;
  PASS(archive_reals(a, "t", &e->t, 1));
  PASS(archive_reals(a, "u", e->u, r->n_dof));
  PASS(archive_reals(a, "F", e->F, r->n_dof));
  PASS(archive_reals(a, "reaction", e->reaction, r->n_dof));
  PASS(archive_reals(a, "uc", e->uc, m));
  PASS(archive_reals(a, "rc", e->rc, m));
  PASS(archive_reals(a, "motion", e->motion, e->motion == NULL ? 0 : m));
  PASS(archive_reals(a, "temperature", e->temperature, elements));
  PASS(archive_reals(a, "thermal", e->thermal, strains));
  PASS(archive_reals(a, "e0", e->e0, strains));
  PASS(archive_reals(a, "sigma", e->sigma, strains));
  PASS(archive_reals(a, "elastic_strain", e->elastic,
                     e->elastic == NULL ? 0 : strains));
  PASS(archive_bytes(a, "energy", &e->energy, sizeof e->energy));
  PASS(archive_reals(a, "peak_energy", &e->peak_energy, 1));
  PASS(archive_reals(a, "peak_stress", &e->peak_stress, 1));
  return archive_reals(a, "peak_strain", &e->peak_strain, 1);
}

/* Temperatures of the moduli, and whether the elastic matrix is theirs. */
static status keep_moduli(run *r, archive *a) {
  int stale = r->body.stale, changed = 0;
  size_t n = r->body.moduli.n_own == 0 ? 0 : r->msh->n_elem;
  double *T = r->now.temperature;
  for (int k = 0; k < r->body.moduli.n_own && !archive_reads(a); ++k)
    T[r->body.moduli.elem_id[k]] = r->body.moduli.at[k];
  PASS(archive_ints(a, "stale", &stale, 1));
  PASS(archive_reals(a, "moduli_temperature", T, n));
  if (!archive_reads(a) || n == 0) return OK;
  PASS(moduli_heat(&r->body.moduli, r->m, T, &changed));
  r->body.stale = stale || changed;
  if (!stale) PASS(run_use(r, &r->elastic));
  return OK;
}

/* The rates of contraction that are known belong to the matrix in use. */
static status keep_rate(run *r, archive *a) {
  known_rate *k = &r->solving.rate;
  int n = k->n, m = n == 0 ? 0 : k->m;
  PASS(archive_ints(a, "rate_size", &m, 1));
  PASS(archive_ints(a, "rates", &n, 1));
  if (archive_reads(a)) known_rate_forget(k);
  if (n < 0 || n > KNOWN_RATES || m <= 0) return OK;
  if (archive_reads(a)) PASS_NEW(k->state, KNOWN_RATES * (size_t)m);
  k->m = m;
  k->n = n;
  PASS(archive_bytes(a, "rate_states", k->state, (size_t)m * n));
  return archive_reals(a, "rate", k->rate, n);
}

static status keep_contact(run *r, archive *a) {
  PASS(keep_nodes(r, a));
  PASS(archive_reals(a, "f_before", r->problem.f_before, r->nodes.n_row));
  r->problem.n_before = r->nodes.n_row;
  r->nodes.n_reported = active_count(&r->nodes.active, r->nodes.n);
  PASS(keep_rate(r, a));
  return matrices_keep(&r->elastic, a, "elastic");
}

static status keep_choice(run *r, archive *a) {
  stiffness_choice *c = &r->body.choice;
  PASS(archive_ints(a, "stiffness", &c->sparse, 1));
  PASS(archive_ints(a, "stiffness_exact", &c->exact, 1));
  PASS(archive_bytes(a, "stiffness_dense", &c->dense, sizeof c->dense));
  PASS(archive_bytes(a, "stiffness_factor", &c->factor, sizeof c->factor));
  return archive_bytes(a, "stiffness_why", c->why, sizeof c->why);
}

status run_keep_start(run *r, archive *a) {
  IN_GROUP(a, "run");
  return archive_reals(a, "start", r->loads.start, r->n_dof);
}

status run_keep_choice(run *r, archive *a) {
  IN_GROUP(a, "run");
  return keep_choice(r, a);
}

status run_keep(run *r, archive *a) {
  IN_GROUP(a, "run");
  observed_work *seen = &r->solving.seen;
  PASS(keep_choice(r, a));
  PASS(archive_bytes(a, "observed", seen, sizeof *seen));
  PASS(archive_bytes(a, "at", &r->at, sizeof r->at));
  PASS(archive_ints(a, "total_no", &r->course.total_no, 1));
  PASS(archive_ints(a, "unsettled", &r->course.unsettled, 1));
  PASS(archive_ints(a, "unsolved", &r->course.unsolved, 1));
  PASS(archive_reals(a, "start", r->loads.start, r->n_dof));
  PASS(archive_reals(a, "step_load", &r->loads.largest, 1));
  PASS(keep_equilibrium(r, &r->old, a));
  PASS(keep_moduli(r, a));
  if (r->nodes.n > 0) PASS(keep_contact(r, a));
  PASS(effects_keep(r, a));
  for (int i = 0; i < STAGE_COUNT; ++i) {
    r->course.costs[i] = timer_cost((stage)i);
    if (!archive_has_cpu(a)) r->course.costs[i].cpu = 0.0;
  }
  PASS(archive_bytes(a, "costs", r->course.costs, sizeof r->course.costs));
  if (archive_reads(a)) timer_resume(r->course.costs);
  return OK;
}
