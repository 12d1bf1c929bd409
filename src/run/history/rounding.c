/*
 * Rounding error of a solution. Where the condition number is far above that of
 * a plain mesh, or where elastic strains are the difference of large numbers,
 * since inelastic strains or motions of the whole body are far above them, the
 * forces of the elements at the answer are compared with loads and contact
 * forces. With d the residual of equilibrium, the error is w = inv(K) d: its
 * energy norm and its stresses are those of the error. With laws that flow K is
 * still that of the elastic body: of all stresses that carry d, those of w have
 * the least energy. Where that error is total, contact may hold the body better
 * than its supports: w is then found with the nodes at the obstacle held. A
 * solution without a correct digit ends the run; loads that grow from zero
 * count with their final size.
 */
#include "base/base.h"
#include "run/history/loop.h"

static const double LAST_DIGIT = 0.1; /* -, error without a correct digit */
/* -, the same where the condition number makes the measuring factor useless */
static const double IN_DOUBT = 0.01;
/* -, work of creep over the strain energy; motion of the body, or forces that
 * contact carries at once, over those of the strains */
static const double FAR = 1e6;
/* -, of the energy norm, the error where the strains are nothing else */
static const double ALL = 0.5;

/* share: of the solution in one that the loss counts against. */
static int leaves_none(const rounding_loss *loss, double share,
                       const condensed *c) {
  const double most = share * fmax(fmax(loss->energy, loss->stress), loss->u);
  return !(most < (condensed_digits(c) > 0 ? LAST_DIGIT : IN_DOUBT));
}

/* The body may be far away by an increment that did not converge. */
static status check(const run *r, double share, const condensed *c) {
  const rounding_loss *loss = &r->errors.rounding;
  if (!leaves_none(loss, share, c) || r->errors.astray) return OK;
  RAISE(ERR_SINGULAR,
        "step %d, time %g: rounding leaves no correct digit: the energy "
        "norm is wrong by about %.1g of itself, stresses by %.1g and "
        "displacements by %.1g of the largest (condition %.1e); contrasts of "
        "stiffness, slivers, nu near 1/2, weak supports, creep strains and "
        "motions far above the elastic ones lose digits",
        run_step_id(r) + 1, r->now.t, loss->energy, loss->stress, loss->u,
        condensed_condition(c));
}

/*
 * Whether the supports of a body strain it (not: those of each body move
 * rigidly, to the rounding of the data): their displacements, as given, are
 * compared with the nearest rigid motion of the body. What is left of them is
 * found in long double, so that it is none of a rigid motion but the rounding
 * of the data. The strains of the solution cannot tell: where the motion is far
 * above them they are rounding.
 */
enum { MODES = 6, COLUMNS = MODES + 1 };

/* One condition for each prescribed component, gathered by Givens rotations in
 * a triangle; its last column is the displacement, m. */
typedef struct motion_fit {
  long double row[MODES][COLUMNS];
  long double left; /* sum of the squares of what no motion gives, m^2 */
  double most;      /* largest displacement, m */
  long n;           /* conditions */
} motion_fit;

/* Displacement of component c at x in the motions: w, t of u = t + w x x. */
static void set_row(kinematics kind, const double *x, int c,
                    long double row[COLUMNS]) {
  for (int k = 0; k < COLUMNS; ++k) row[k] = 0;
  if (kind == AXISYMMETRIC) {
    row[0] = c == 1;
  } else if (kind == SOLID_3D) {
    row[(c + 1) % 3] = x[(c + 2) % 3];
    row[(c + 2) % 3] = -(long double)x[(c + 1) % 3];
    row[3 + c] = 1;
  } else {
    row[0] = c == 0 ? -x[1] : x[0];
    row[1 + c] = 1;
  }
}

static void add_row(motion_fit *f, long double row[COLUMNS]) {
  ++f->n;
  f->most = fmax(f->most, fabs((double)row[MODES]));
  for (int k = 0; k < MODES; ++k) {
    long double *to = f->row[k];
    if (row[k] == 0) continue;
    const long double h = hypotl(to[k], row[k]), c = to[k] / h, s = row[k] / h;
    for (int j = k; j < COLUMNS; ++j) {
      const long double a = to[j], b = row[j];
      to[j] = c * a + s * b;
      row[j] = c * b - s * a;
    }
  }
  f->left += row[MODES] * row[MODES];
}

/* Body of each node, and their number. */
static status find_bodies(const run *r, int *body, int *n) {
  const mesh *m = r->msh;
  OWNED_NEW(int, of, m->n_elem);
  PASS(mesh_bodies(m, n, of));
  for (int e = 0; e < m->n_elem; ++e)
    for (int a = 0; a <= m->dim; ++a)
      body[m->elem[(m->dim + 1) * e + a]] = of[e];
  return OK;
}

static status supports_strain(const run *r, int *strained) {
  const mesh *m = r->msh;
  const int dim = m->dim;
  int n = 0;
  OWNED_NEW(int, body, m->n_node);
  PASS(find_bodies(r, body, &n));
  OWNED_NEW(motion_fit, fit, n);
  for (size_t q = 0; q < r->n_dof; ++q) {
    const size_t i = q / dim;
    long double row[COLUMNS];
    if (!r->body.fixed[q]) continue;
    set_row(r->body.d.kin[0], m->x + dim * i, (int)(q % dim), row);
    row[MODES] = r->loads.ud[q];
    add_row(&fit[body[i]], row);
  }
  *strained = 0;
  for (int b = 0; b < n; ++b) {
    const double least = DBL_EPSILON * fit[b].most;
    if (fit[b].left > (double)fit[b].n * least * least) *strained = 1;
  }
  return OK;
}

/* Arrays of a body whose solution is checked. */
typedef struct misfit {
  condensed *c;
  size_t n_stress;
  double *stress;   /* [n_stress] of the answer, then of w alone, Pa */
  double *rest, *w; /* [n_dof] N; m */
  double *rc;       /* [m of the contact problem] contact forces, N */
} misfit;

/* That of the energies, not that of a step of an integrator. */
static condensed *elastic_body(const run *r) {
  return r->elastic.c != NULL ? r->elastic.c : r->c;
}

static status misfit_new(const run *r, misfit *x) {
  x->c = elastic_body(r);
  x->n_stress = (size_t)r->m->ns * r->msh->n_elem;
  PASS_NEW(x->stress, x->n_stress);
  PASS_NEW_REALS(r->n_dof, &x->rest, &x->w);
  PASS_NEW(x->rc, r->problem.cp.m);
  return OK;
}

double rounding_of_works(const run *r) {
  const double u = largest_entry(r->n_dof, r->now.u);
  return r->msh->n_node * condensed_stiffest(r->c) * u * strains_lost(r);
}

static double largest_force(const run *r) {
  return fmax(fmax(largest_entry(r->n_dof, r->now.F), increment_strain_load(r)),
              largest_entry(r->nodes.n_c, r->now.rc));
}

/* What the rounding of the forces stores, and what the solver has left at the
 * contact nodes, with "lost" of each force, J: at the stiffest node, or at any
 * where nothing but that is left of them. */
static double forces_energy(const run *r, double lost) {
  const double force = largest_force(r), rounding = RUN_CARRIED * force,
               left = r->solving.report.residual * force + lost,
               soft = r->errors.carried ? condensed_condition(r->c) : 1.0;
  return soft *
         (r->msh->n_node * rounding * rounding + r->nodes.n * left * left) /
         condensed_stiffest(elastic_body(r));
}

/* 1: contact forces and supports carry the loads straight, and strains are
 * nothing else, nor are they lost. */
static int forces_hide_strains(const run *r) {
  return r->now.energy.strain + r->errors.misfit <= forces_energy(r, 0.0);
}

/* 1: a load that no support bears at once. */
static int is_loaded(const run *r) {
  for (size_t i = 0; i < r->n_dof; ++i)
    if (!r->body.fixed[i] && fabs(r->now.F[i]) > 0.0) return 1;
  return 0;
}

/* 1: no force acts on the body. */
static int is_unloaded(const run *r) {
  return !is_loaded(r) && largest_entry(r->nodes.n_c, r->now.rc) == 0.0;
}

/* 1: nor do its supports strain it. */
static int moves_alone(const run *r) {
  return !r->errors.strained && is_unloaded(r);
}

double rounding_of_gaps(const run *r) {
  const size_t n = r->msh->dim * r->msh->n_node;
  return 16 * DBL_EPSILON * largest_entry(n, r->msh->x);
}

/* 1: such an error explains all strains. */
static int hides_strains(const run *r, double u) {
  return r->now.energy.strain <= strains_rounding(r, u);
}

int rounding_is_all(const run *r) {
  const double force = largest_entry(r->nodes.n_c, r->now.rc);
  if (forces_hide_strains(r)) return 1;
  if ((r->strains.eigen.n == 0 || r->errors.noise) && moves_alone(r)) return 1;
  if (r->errors.strained) return 0;
  if (r->errors.carried &&
      (r->errors.noise ||
       r->now.energy.strain <= strains_rounding(r, strains_lost(r)) +
                                   forces_energy(r, r->errors.lost)))
    return 1;
  if (is_loaded(r)) return 0;
  const double u = force > 0.0 ? fmax(strains_lost(r), rounding_of_gaps(r))
                               : strains_lost(r);
  return force <= condensed_stiffest(r->c) * u && hides_strains(r, u);
}

/* The contact forces of the answer. Where they differ from those of its
 * displacements by more than rounding, the solver has left that, and the latter
 * are taken. */
static status find_forces(const run *r, misfit *x) {
  const contact_problem *cp = &r->problem.cp;
  const double *u = run_rows(r, 0, r->now.uc), *rc = run_rows(r, 1, r->now.rc);
  OWNED double *raw = NULL, *rounding = NULL;
  PASS_NEW_ALL(OF(raw, cp->m), OF(rounding, cp->n));
  contact_apply(cp, u, raw);
  contact_roundings(cp, u, rc, rounding);
  for (int q = 0; q < cp->m; ++q) {
    const double by_u = raw[q] - cp->f[q];
    x->rc[q] = fabs(rc[q] - by_u) > rounding[q / cp->dim] ? by_u : rc[q];
  }
  return OK;
}

/* w; *square: twice its energy, J. */
static status find_error(const run *r, misfit *x, double *square) {
  domain_stress(&r->body.d, r->now.u, NULL, x->stress);
  domain_internal_force(&r->body.d, x->stress, x->rest);
  for (size_t i = 0; i < r->n_dof; ++i) x->rest[i] = r->now.F[i] - x->rest[i];
  PASS(find_forces(r, x));
  return condensed_misfit(x->c, x->rest, x->rc, x->w, square);
}

/* Largest bound of the rounding of a contact force. */
static status find_lost(run *r) {
  const contact_problem *cp = &r->problem.cp;
  OWNED_NEW(double, rounding, cp->n);
  contact_roundings(cp, run_rows(r, 0, r->now.uc), run_rows(r, 1, r->now.rc),
                    rounding);
  r->errors.lost = largest_entry(cp->n, rounding);
  return OK;
}

/* Whether contact carries the loads straight: at each node its force and the
 * load leave no more than the rounding of forces, what the solver leaves at all
 * contact nodes, or the rounding of the motion, or of all contact forces, if
 * far below the load or nothing loads it. */
static status find_carried(run *r) {
  const double most = fmax(increment_free_load(r, r->now.F),
                           largest_entry(r->nodes.n_c, r->now.rc)),
               n = r->problem.cp.n,
               part = RUN_CARRIED *
                          sqrt(r->msh->n_node * condensed_condition(r->c)) +
                      n * r->solving.report.residual,
               moved = fmax(condensed_stiffest(r->c) * strains_lost(r),
                            n * r->errors.lost);
  OWNED_NEW(double, left, r->n_dof);
  COPY(left, r->now.F, r->n_dof);
  if (r->nodes.n > 0) surface_spread(r->surface, 1.0, r->now.rc, left);
  r->errors.carried = !r->errors.strained;
  for (size_t q = 0; q < r->n_dof; ++q) {
    const double rest = fabs(left[q]), by = fabs(r->now.F[q]);
    if (r->body.fixed[q] || rest <= part * most) continue;
    if (rest > part * most + moved || (by > 0.0 && by < FAR * rest))
      r->errors.carried = 0;
  }
  return OK;
}

/* 1: an error of that square explains all strains. */
static int is_noise(const run *r, double square) {
  return square > ALL * ALL * 2.0 * r->now.energy.strain;
}

/* What errors of displacements count against, m: the largest one, or that of
 * the largest strains without stress so far, where the body is held so that it
 * stays in place. */
static double largest_motion(const run *r) {
  return fmax(largest_entry(r->n_dof, r->now.u),
              r->now.peak_strain * r->msh->size);
}

static void find_peaks(run *r, const misfit *x) {
  equilibrium *e = &r->now;
  const size_t n = (size_t)r->m->ns * r->strains.eigen.n;
  e->peak_stress = fmax(e->peak_stress, largest_entry(x->n_stress, x->stress));
  if (n > 0)
    e->peak_strain =
        fmax(e->peak_strain, largest_entry(n, r->strains.eigen.e0));
}

/* The loss by the error w of the displacements. */
static void take_loss(run *r, misfit *x, double square) {
  r->errors.rounding = (rounding_loss){.found = 1, .norm = sqrt(square)};
  if (square > 0.0) {
    r->errors.rounding.energy = sqrt(square / (2.0 * r->now.peak_energy));
    r->errors.rounding.u = largest_entry(r->n_dof, x->w) / largest_motion(r);
  }
  /* The stresses of the displacement w alone, over those of the solution. */
  domain plain = r->body.d;
  double wrong;
  plain.eigen = NULL;
  domain_stress(&plain, x->w, NULL, x->stress);
  wrong = largest_entry(x->n_stress, x->stress);
  if (wrong > 0.0) r->errors.rounding.stress = wrong / r->now.peak_stress;
}

/* Again with the body held by contact, where supports are weak. */
static status find_adjacent_contact(run *r, misfit *x) {
  double square;
  const contact_problem *cp = &r->problem.cp;
  OWNED_NEW(unsigned char, held, cp->m);
  OWNED_NEW(double, force, cp->m);
  contact_stops(cp, run_rows(r, 0, r->now.uc), run_rows(r, 1, r->now.rc), 1,
                force, held);
  for (int k = 0; k < cp->m; ++k) held[k] |= contact_held(cp, k) != 0;
  PASS(condensed_misfit_held(x->c, x->rest, x->rc, held, x->w, &square));
  if (square < HUGE_VAL) take_loss(r, x, square);
  return OK;
}

/* The loads now over the largest of the step: rounding errors do not grow with
 * them and are relative to the largest. */
double share_of_step(const run *r) {
  const double now = increment_free_load(r, r->now.F);
  return now < r->loads.largest ? now / r->loads.largest : 1.0;
}

/* Where strains are rounding alone they are no loss, nor are displacements
 * right to the tolerance of the solver, or those that contact takes from the
 * loads at once; nor is the place of bodies that no force holds. */
static void forget_strains(run *r) {
  rounding_loss *loss = &r->errors.rounding;
  if (r->solving.placed) loss->u = 0.0;
  const int right = loss->u <= r->solving.tol;
  if (!rounding_is_all(r) && !(right && moves_alone(r))) return;
  loss->energy = loss->stress = loss->norm = 0.0;
  if (right || forces_hide_strains(r)) *loss = (rounding_loss){0};
}

static status find(run *r) {
  const double share = share_of_step(r);
  double square;
  OWNED_PARTS(misfit, x, misfit_new(r, &x));
  PASS(find_error(r, &x, &square));
  r->errors.misfit = 0.5 * square;
  find_peaks(r, &x);
  r->errors.noise = is_noise(r, square);
  take_loss(r, &x, square);
  if (leaves_none(&r->errors.rounding, 1.0, x.c) && r->nodes.n_row > 0)
    PASS(find_adjacent_contact(r, &x));
  forget_strains(r);
  return check(r, share, x.c);
}

/* A body moved so far that contact is decided by rounding. */
static status check_touch(const run *r) {
  const double u = largest_entry(r->n_dof, r->now.u);
  if (u <= FAR * r->msh->size || !rounding_is_all(r)) return OK;
  for (int i = 0; i < r->nodes.n; ++i) {
    const double gap = r->problem.gap[i] - r->now.uc[r->msh->dim * i];
    if (fabs(gap) <= 16 * DBL_EPSILON * u)
      RAISE(ERR_SINGULAR,
            "step %d, time %g: rounding leaves no correct digit: after a "
            "motion of %.1g a gap of %.1g may be open or closed; start nearer "
            "to the obstacle",
            run_step_id(r) + 1, r->now.t, u, gap);
  }
  return OK;
}

/* A body that only contact would hold, at a node that meets no obstacle. */
static status check_met(const run *r) {
  const double *given = r->problem.given, unmet = SURFACE_UNMET * r->msh->size;
  for (int i = 0; i < r->nodes.n; ++i)
    if (r->problem.gap[i] >= unmet && r->now.rc[r->msh->dim * i] < 0.0 &&
        (given == NULL || given[i] < 0.0) &&
        !surface_meets(r->surface, r->faces.pairs, i, r->now.t))
      RAISE(ERR_SINGULAR,
            "step %d, time %g: no equilibrium found: contact node %zu is "
            "pressed where the line along its normal meets no obstacle; a "
            "*BOUNDARY or another load can hold the body",
            run_step_id(r) + 1, r->now.t, r->surface->node_no[i]);
  return OK;
}

/* What the motion would store as a strain of the stiffest element, or the
 * forces there, whichever is larger, J. */
static double farthest_work(const run *r) {
  const double k = condensed_stiffest(r->c), force = largest_force(r),
               u = largest_entry(r->n_dof, r->now.u);
  return fmax(k * u * u, k > 0.0 ? force / k * force : 0.0);
}

/* 1: the strains are so far below the motion that they may be rounding. */
static int may_be_noise(const run *r) {
  return farthest_work(r) > FAR * FAR * r->now.energy.strain;
}

status rounding_hides_stresses(const run *r, int *hides) {
  double square;
  *hides = hides_strains(r, strains_lost(r));
  if (*hides || !may_be_noise(r)) return OK;
  TIMED(STAGE_RECOVERY);
  OWNED_PARTS(misfit, x, misfit_new(r, &x));
  PASS(find_error(r, &x, &square));
  *hides = is_noise(r, square);
  return OK;
}

status rounding_hides_strains(const run *r, int *hides) {
  *hides = 0;
  return rounding_strain_left(r) > 0.0 ? OK : rounding_hides_stresses(r, hides);
}

double rounding_strain_left(const run *r) {
  domain plain = r->body.d;
  plain.eigen = NULL;
  if (r->strains.visco == NULL) return 0.0;
  const double energy = domain_strain_energy(&plain, r->now.u);
  const double moved = strains_rounding(r, strains_lost(r)),
               peak = r->msh->n_node * RUN_CARRIED * RUN_CARRIED *
                      r->now.peak_energy;
  const double none = fmax(forces_energy(r, 0.0),
                           condensed_condition(r->c) * fmax(moved, peak));
  return energy > FAR * none ? energy : 0.0;
}

/* Strains that flow, of a body that nothing loads now. */
static status find_noise(run *r) {
  if (r->strains.eigen.n == 0 || !moves_alone(r) || !may_be_noise(r)) return OK;
  return rounding_hides_stresses(r, &r->errors.noise);
}

/* Largest stress next to each contact node times its area, own[n], N. */
static status find_own(const run *r, double *own) {
  const mesh *m = r->msh;
  OWNED double *sigma = NULL, *most = NULL;
  PASS_NEW_ALL(OF(sigma, (size_t)r->m->ns * m->n_elem), OF(most, m->n_node));
  domain_stress(&r->body.d, r->now.u, NULL, sigma);
  for (int e = 0; e < m->n_elem; ++e) {
    const size_t ns = r->m->ns;
    const double peak = largest_entry(ns, sigma + ns * e);
    for (int a = 0; a <= m->dim; ++a) {
      const int v = m->elem[(m->dim + 1) * e + a];
      most[v] = fmax(most[v], peak);
    }
  }
  for (int k = 0; k < r->problem.cp.n; ++k) {
    const int i = r->nodes.active.in != NULL ? r->nodes.active.in[k] : k;
    own[k] = most[r->surface->node_id[i]] * r->surface->area[i];
  }
  return OK;
}

/* A gap at time 0 of the size of the rounding of coordinates is rounding: the
 * force that closes it, over the largest of all or own[n] (NULL: none), the
 * largest over the nodes. 0 for bodies without load that have moved no more. */
static double hidden_by_gaps(const run *r, const double *own) {
  const contact_problem *cp = &r->problem.cp;
  const double least = rounding_of_gaps(r), force = largest_force(r);
  double worst = 0.0;
  if (!is_loaded(r) && largest_entry(r->n_dof, r->now.u) <= least) return 0.0;
  for (int k = 0; k < cp->n; ++k) {
    const int i = r->nodes.active.in != NULL ? r->nodes.active.in[k] : k;
    const double gap = fabs(r->surface->gap0[i]);
    if (gap == 0.0 || gap > least || !(r->now.rc[cp->dim * i] < 0.0)) continue;
    worst = fmax(worst, gap * contact_diagonal(cp, cp->dim * k) /
                            fmax(force, own != NULL ? own[k] : 0.0));
  }
  return worst;
}

status rounding_hidden(const run *r, double *part) {
  *part = 0.0;
  if (r->nodes.n == 0 || r->solving.report.outcome <= 0) return OK;
  const double *u = run_rows(r, 0, r->now.uc), *rc = run_rows(r, 1, r->now.rc);
  *part = fmax(contact_hidden(&r->problem.cp, u, rc, NULL),
               hidden_by_gaps(r, NULL));
  if (!(*part > LAST_DIGIT)) return OK;
  OWNED_NEW(double, own, r->problem.cp.n);
  PASS(find_own(r, own));
  *part =
      fmax(contact_hidden(&r->problem.cp, u, rc, own), hidden_by_gaps(r, own));
  return OK;
}

static int is_doubtful(const run *r) {
  const double far = FAR * r->now.peak_energy;
  if (condensed_costs_digits(r->c)) return 1;
  return fabs(r->now.energy.inelastic) > far || farthest_work(r) > FAR * far;
}

status rounding_find(run *r) {
  r->errors.rounding = (rounding_loss){0};
  r->errors.strained = r->errors.carried = r->errors.noise = 0;
  r->errors.lost = r->errors.misfit = 0.0;
  r->now.peak_energy = fmax(r->old.peak_energy, r->now.energy.strain);
  r->now.peak_stress = r->old.peak_stress;
  r->now.peak_strain = r->old.peak_strain;
  if (r->solving.report.outcome <= 0) return OK;
  PASS(check_met(r));
  PASS(check_touch(r));
  const int doubtful = is_doubtful(r);
  if (doubtful || is_unloaded(r)) PASS(supports_strain(r, &r->errors.strained));
  if (!doubtful) return find_noise(r);
  if (r->nodes.n_row > 0) PASS(find_lost(r));
  PASS(find_carried(r));
  TIMED(STAGE_RECOVERY);
  return find(r);
}
