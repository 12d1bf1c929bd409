/* Reasons for a failed increment (verdict.h). */
#include "accuracy/verdict.h"

#include "accuracy/accuracy.h"
#include "base/base.h"
#include "contact/formulation.h"
#include "solver/pivoting/lemke.h"

enum { LISTED = 5, LARGEST = 2000, PARAM_SIZE = 512 };
static const double PART = 0.01;   /* -, of the largest: does not count */
static const double TIE = 1e-6;    /* -, values that count as equal */
static const double MISFIT = 1e-9; /* -, of the force scale: none */

/* A text that is added to. */
typedef struct words {
  char *text;
  size_t size;
} words;

#define ADD(w, ...) text_add((w)->text, (w)->size, __VA_ARGS__)

static void add_node(const words *w, const contact_surface *s, int i) {
  if (s->x == NULL) {
    ADD(w, "%zu", s->node_no[i]);
    return;
  }
  ADD(w, "%zu at (", s->node_no[i]);
  for (int k = 0; k < s->dim; ++k)
    ADD(w, "%s%.6g", k > 0 ? ", " : "", s->x[s->dim * i + k]);
  ADD(w, ")");
}

/* The nodes with the largest value[n] above PART of the largest, up to LISTED,
 * the larger first; value is destroyed. Their number, all counted. */
static int add_nodes(const words *w, const contact_surface *s, double *value) {
  double most = 0.0;
  int counted = 0, listed = 0;
  for (int i = 0; i < s->n; ++i) most = fmax(most, value[i]);
  for (int i = 0; i < s->n; ++i)
    counted += most > 0.0 && value[i] >= PART * most;
  for (; listed < LISTED && listed < counted; ++listed) {
    int next = 0;
    for (int i = 1; i < s->n; ++i)
      if (value[i] > (1.0 + TIE) * value[next]) next = i;
    ADD(w, listed > 0 ? ", " : counted == 1 ? " node " : " nodes ");
    add_node(w, s, next);
    value[next] = -1.0;
  }
  if (counted > listed) ADD(w, " and %d more", counted - listed);
  return counted;
}

status verdict_misfit(const contact_problem *cp, const contact_surface *surface,
                      const double *u, const double *r, char *text,
                      size_t size) {
  words w = {text, size};
  double scale = contact_scale(cp), most = 0.0;
  OWNED_NEW(double, value, cp->n);
  OWNED_PARTS(pair, p, pair_new(cp->n, cp->m, &p));
  pair_set(cp, u, r, &p);
  for (int dof = 0; dof < cp->m; ++dof) {
    double defect = fabs(p.q[dof] - r[dof]);
    value[dof / cp->dim] = fmax(value[dof / cp->dim], defect);
    if (isnan(defect)) return OK;
    most = fmax(most, defect);
  }
  if (!(most > MISFIT * scale)) return OK;
  ADD(&w, "the contact conditions are violated most at");
  add_nodes(&w, surface, value);
  return OK;
}

/* *cp with the given normal forces in the place of unilateral contact. */
static status put_given(const verdict_scene *s, given_form **form,
                        contact_problem *cp) {
  const contact_problem before = *cp;
  OWNED double *force = NULL, *u = NULL, *r = NULL;
  int n = 0;
  if (s->given == NULL) return OK;
  OWNED_NEW(int, node, cp->n);
  PASS_NEW_REALS(cp->m, &force, &u, &r);
  for (int i = 0; i < cp->n; ++i)
    if (s->given[i] >= 0.0) {
      force[n] = s->given[i];
      node[n++] = i;
    }
  PASS(given_form_new(&before, n, node, form));
  return given_form_set(*form, &before, force, s->msh->size, u, r, cp);
}

/* v[m]: the motion; *outcome of complementary pivoting with so many facets. */
static status pivot(const verdict_scene *s, const char *facets, double *v,
                    outcome *end) {
  const contact_problem *cp = s->cp;
  char why[100];
  _Alignas(16) char param[PARAM_SIZE] = {0};
  const solver_ops *lemke = solver_find("lemke");
  const solver_control control = {.tol = 1e-8};
  solver_report rep = {.outcome = RUNNING};
  OWNED double *u = NULL, *r = NULL, *A = NULL;
  *end = RUNNING;
  if (lemke == NULL || !contact_has_stiffness(cp) || cp->n > LARGEST) return OK;
  contact_problem own = *cp;
  if (cp->op != NULL) {
    PASS_NEW(A, (size_t)cp->m * cp->m);
    contact_dense(cp, A);
    own.A = A;
    own.op = NULL;
  }
  OWNED_OF(given_form, form, put_given(s, &form, &own));
  PASS_NEW_REALS(cp->m, &u, &r);
  option_defaults(lemke->options, param);
  (void)option_read(option_find(lemke->options, "FACETS"), facets, param, why,
                    sizeof why);
  OWNED_OF(void, work, solver_set_up(lemke, &own, param, &work));
  PASS(lemke->solve(&own, param, work, &control, u, r, &rep));
  *end = rep.outcome;
  const double *ray = lemke_ray(work);
  if (rep.outcome == STOPPED_RAY && ray != NULL)
    COPY(v, ray, cp->m);
  else if (rep.outcome == STOPPED_RAY)
    *end = STOPPED_STAGNATION;
  if (form != NULL) given_form_move(form, v);
  return OK;
}

/* In space the polygon allows more friction than the disc, 8 % with 8 facets,
 * which hides motions next to the limit; with 32 it is 0.5 %. */
static status find_motion(const verdict_scene *s, double *v, outcome *end) {
  PASS(pivot(s, "8", v, end));
  if (*end == STOPPED_RAY || *end == CONVERGED || s->cp->dim == 2) return OK;
  return pivot(s, "32", v, end);
}

/* Nodes that open, and those that only slide. */
static status add_moving(const words *w, const verdict_scene *s,
                         const double *v) {
  int dim = s->cp->dim, opening = 0;
  OWNED double *open = NULL, *slide = NULL;
  double most = 0.0;
  PASS_NEW_REALS(s->cp->n, &open, &slide);
  for (int dof = 0; dof < s->cp->m; ++dof) most = fmax(most, fabs(v[dof]));
  for (int i = 0; i < s->cp->n; ++i) {
    open[i] = fmax(0.0, -v[dim * i]);
    for (int k = 1; k < dim; ++k) slide[i] = hypot(slide[i], v[dim * i + k]);
    if (open[i] >= PART * most)
      slide[i] = 0.0;
    else
      open[i] = 0.0;
    if (slide[i] < PART * most) slide[i] = 0.0;
    opening += open[i] > 0.0;
  }
  ADD(w, "nothing stops a motion in which contact");
  if (opening > 0) {
    add_nodes(w, s->surface, open);
    ADD(w, opening == 1 ? " separates" : " separate");
  }
  int before = opening;
  for (int i = 0; i < s->cp->n; ++i)
    if (slide[i] > 0.0) {
      if (before > 0) ADD(w, " and contact");
      int n = add_nodes(w, s->surface, slide);
      ADD(w, n == 1 ? " slides" : " slide");
      break;
    }
  return OK;
}

/* Forces of load k alone, F[n_dof]. */
static status forces_of(const verdict_scene *s, int k, double *F) {
  step one = *s->step;
  one.loads.n = 1;
  one.loads.item = &s->step->loads.item[k];
  return load_forces(s->m, s->msh, &one, s->t, F);
}

/* Work of the given forces of a contact on the motion v[m]; adds what obstacles
 * exert to sum[3]. */
static double work_of_given(const verdict_scene *s, int contact_id,
                            const double *v, double *sum) {
  const contact_surface *on = s->surface;
  double work = 0.0;
  for (int i = 0; s->given != NULL && i < on->n; ++i) {
    if (on->contact_id[i] != contact_id || s->given[i] < 0.0) continue;
    work -= s->given[i] * v[on->dim * i];
    for (int k = 0; k < on->dim && !s->m->contacts[contact_id].is_pair; ++k)
      sum[k] -= s->given[i] * on->frame[on->dim * on->dim * i + k];
  }
  return work;
}

/* The loads and given forces that do work on the motion u[n_dof] of the body,
 * v[m] of the contact nodes. */
static status add_loads(const words *w, const verdict_scene *s, const double *u,
                        const double *v, double *F) {
  const int dim = s->msh->dim, n = dim * s->msh->n_node;
  int listed = 0;
  double sum[3] = {0.0}, none[3];
  PASS(load_forces(s->m, s->msh, s->step, s->t, F));
  double work = dot(n, F, u);
  for (int i = 0; i < n; ++i) sum[i % dim] += F[i];
  for (int k = 0; k < s->m->n.contact; ++k) work += work_of_given(s, k, v, sum);
  for (int k = 0; k < s->step->loads.n && listed < LISTED; ++k) {
    const load *l = &s->step->loads.item[k];
    PASS(forces_of(s, k, F));
    if (!(dot(n, F, u) > PART * fabs(work))) continue;
    ADD(w, listed++ == 0 ? ", driven by " : ", ");
    ADD(w, "*%s on %s (line %d)", load_card(l), l->group, l->at.line_no);
  }
  for (int k = 0; k < s->m->n.contact && listed < LISTED; ++k) {
    const contact *c = &s->m->contacts[k];
    if (!(work_of_given(s, k, v, none) > PART * fabs(work))) continue;
    ADD(w, listed++ == 0 ? ", driven by " : ", ");
    ADD(w, "*CONTACT FORCE on %s (line %d)", c->name, c->force.at.line_no);
  }
  ADD(w, "; resultant of all loads (");
  for (int k = 0; k < s->msh->dim; ++k)
    ADD(w, "%s%.6g", k > 0 ? ", " : "", sum[k]);
  ADD(w, ")");
  return OK;
}

/* The rigid motion of the body by the contact nodes, without load. */
static status add_drive(const words *w, const verdict_scene *s,
                        const double *v) {
  size_t n = (size_t)s->msh->dim * s->msh->n_node;
  OWNED double *F = NULL, *u = NULL, *f_c = NULL;
  PASS_NEW_REALS(n, &F, &u);
  PASS_NEW(f_c, s->cp->m);
  PASS(condense_load(s->c, F, NULL, f_c));
  PASS(condense_recover(s->c, v, u));
  return add_loads(w, s, u, v, F);
}

/* A load or gap that is no number: which node. */
static int add_bad_number(const words *w, const verdict_scene *s) {
  for (int dof = 0; dof < s->cp->m; ++dof) {
    int i = dof / s->cp->dim;
    int bad_load = !isfinite(s->cp->f[dof]);
    if (!bad_load && isfinite(s->cp->gap[i])) continue;
    ADD(w, "the %s of contact node ", bad_load ? "load" : "gap");
    add_node(w, s->surface, i);
    ADD(w, " is not a finite number");
    return 1;
  }
  return 0;
}

static status add_motion(const words *w, const verdict_scene *s, outcome *end) {
  OWNED_NEW(double, v, s->cp->m);
  PASS(find_motion(s, v, end));
  if (*end != STOPPED_RAY) return OK;
  PASS(add_moving(w, s, v));
  PASS(add_drive(w, s, v));
  ADD(w, "; a *BOUNDARY or another load can hold it");
  return OK;
}

status verdict_motion(const verdict_scene *s, char *text, size_t size) {
  outcome end = RUNNING;
  return add_motion(&(words){text, size}, s, &end);
}

status verdict_text(const verdict_scene *s, char *text, size_t size) {
  words w = {text, size};
  outcome end = RUNNING;
  if (add_bad_number(&w, s)) return OK;
  PASS(add_motion(&w, s, &end));
  if (end == STOPPED_RAY) return OK;
  if (end == CONVERGED)
    ADD(&w, "METHOD=LEMKE of *SOLVER finds one to 1E-8 of the loads");
  else
    PASS(verdict_misfit(s->cp, s->surface, s->u, s->r, text, size));
  return OK;
}
