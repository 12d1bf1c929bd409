#include "base/base.h"
#include "effects/rows.h"
#include "support/grid.h"
#include "support/made_up.h"

#include <unistd.h>

double made_up_value(int array, int item, int total_no) {
  double x = sin(1.0 + array * 7.3 + item * 0.37 + total_no * 0.011);
  return x * (array == MADE_U ? 1e-5 : array == MADE_STRESS ? 1e8 : 1);
}

static void *need(void *p) {
  if (p == NULL) abort();
  return p;
}

static int group_id(const mesh *m, const char *name) {
  int id = 0;
  while (strcmp(m->group[id].name, name) != 0) ++id;
  return id;
}

/* n = -y, t1 = x[, t2 = z] */
static void make_surface(made_up *run) {
  contact_surface *s = &run->surface;
  const mesh_group *g = &run->msh->group[group_id(run->msh, "BOTTOM")];
  size_t dim = (size_t)run->m.dim, n = (size_t)g->n_node;
  s->dim = (int)dim;
  s->n = (int)n;
  s->node_id = need(memory_new(n, sizeof *s->node_id));
  s->node_no = need(memory_new(n, sizeof *s->node_no));
  s->contact_id = need(memory_new(n, sizeof *s->contact_id));
  s->x = need(memory_new(dim * n, sizeof *s->x));
  s->area = need(memory_new(n, sizeof *s->area));
  s->frame = need(memory_new(dim * dim * n, sizeof *s->frame));
  for (size_t i = 0; i < n; ++i) {
    s->node_id[i] = g->node_id[i];
    s->node_no[i] = run->msh->node_no[g->node_id[i]];
    s->area[i] = 0.25;
    for (size_t k = 0; k < dim; ++k)
      s->x[dim * i + k] = run->msh->x[dim * (size_t)g->node_id[i] + k];
    double *frame = s->frame + dim * dim * i;
    frame[1] = -1;
    frame[dim] = 1;
    if (dim == 3) frame[8] = 1;
  }
}

static void put_effect(made_up *run, const effect_ops *ops, void *own) {
  effect_list *list = &run->effects;
  list->on[list->n].ops = ops;
  list->on[list->n++].state = own;
}

static void make_arrays(made_up *run) {
  int dim = run->m.dim, n = run->surface.n;
  int *count = run->count;
  count[MADE_U] = count[MADE_REACTION] = dim * run->msh->n_node;
  count[MADE_STRAIN] = count[MADE_STRESS] = run->m.ns * run->msh->n_elem;
  count[MADE_UC] = count[MADE_RC] = dim * n;
  count[MADE_GAP] = count[MADE_LIMIT] = count[MADE_DISTANCE] = n;
  count[MADE_SLIP] = (dim - 1) * n;
  for (int a = 0; a < MADE_ARRAYS; ++a)
    run->array[a] = need(memory_new((size_t)count[a], sizeof(double)));
  run->status = need(memory_new((size_t)n, sizeof *run->status));
  run->s.body.u = run->array[MADE_U];
  run->s.body.strain = run->array[MADE_STRAIN];
  run->s.body.stress = run->array[MADE_STRESS];
  run->s.body.reaction = run->array[MADE_REACTION];
  run->s.contacts.uc = run->array[MADE_UC];
  run->s.contacts.rc = run->array[MADE_RC];
  run->s.contacts.gap = run->array[MADE_GAP];
  run->s.contacts.slip = run->array[MADE_SLIP];
  run->s.contacts.limit = run->array[MADE_LIMIT];
  run->s.contacts.distance = run->array[MADE_DISTANCE];
  run->s.contacts.torque = run->torque;
  run->zone_list.zone = run->zones;
  put_effect(run, &loops_effect, run->loops);
  put_effect(run, &zones_effect, &run->zone_list);
  put_effect(run, &closed_form_effect, &run->s.errors.exact);
  run->s.effects = &run->effects;
  run->zone_list.n = 2;
  run->s.contacts.contact = run->status;
  run->s.contacts.totals = run->totals;
  run->s.contacts.surface = &run->surface;
}

static void make_step(made_up *run, int n_increment) {
  step *s = run->steps;
  run->support = (load){.kind = LOAD_FIXING, .group = "TOP"};
  run->support.group_id = group_id(run->msh, "TOP");
  for (int i = 0; i < 8; ++i)
    run->prints[i] =
        (print_request){.table = 1 << i, .group_id = -1, .frequency = 1};
  *s = (step){.kind = STEP_QUASISTATIC, .dt = 0.5, .total = 0.5 * n_increment};
  s->loads.n = 1;
  s->loads.item = &run->support;
  s->print.n = 8;
  s->print.requests = run->prints;
  s->output.frequency = 1;
}

static void make_model(made_up *run, int n_increment) {
  model *m = &run->m;
  run->foot = (contact){.name = "FOOT",
                        .group = "BOTTOM",
                        .obstacle_name = "FLOOR",
                        .obstacle_id = -1, /* the model has no obstacles */
                        .has_axis = 1,
                        .group_id = group_id(run->msh, "BOTTOM")};
  run->body =
      (section){.elset = "BODY", .material_name = "STEEL", .material_id = -1};
  run->body.kin = m->dim == 3 ? SOLID_3D : PLANE_STRAIN;
  m->name.job = (char *)"block";
  m->name.title = "a made-up <block> & \"more\"";
  m->n.section = m->n.contact = m->n.step = 1;
  m->sections = &run->body;
  m->contacts = &run->foot;
  m->steps = run->steps;
  m->effects =
      EFFECT_CONTACT | EFFECT_FRICTION | EFFECT_STRESS | EFFECT_REACTION;
  make_step(run, n_increment);
}

made_up *made_up_new(int dim, int cells, int n_increment) {
  const int n[3] = {cells, cells, cells};
  const double length[3] = {1, 1, 1};
  made_up *run = need(memory_new(1, sizeof *run));
  run->m.dim = dim;
  run->m.ns = dim == 3 ? 6 : 4;
  run->msh = need(dim == 3 ? make_grid_3d(n, length) : make_grid_2d(n, length));
  for (int i = 0; i < run->msh->n_node; ++i)
    run->msh->node_no[i] = (size_t)(3 * (run->msh->n_node - i));
  make_model(run, n_increment);
  make_surface(run);
  make_arrays(run);
  run->facts = (setup_facts){.info = {.unknowns = 100, .ordering = "AMD"},
                             .condition = 1e3,
                             .n_contact_node = run->surface.n};
  return run;
}

void made_up_advance(made_up *run, int total_no) {
  state *s = &run->s;
  s->step_no = 1;
  s->increment_no = s->total_no = total_no;
  s->attempt = 1;
  s->dt = run->steps[0].dt;
  s->t = s->dt * total_no;
  s->end_of_step = s->t >= run->steps[0].total;
  s->settled = 1;
  for (int a = 0; a < MADE_ARRAYS; ++a)
    for (int i = 0; i < run->count[a]; ++i)
      run->array[a][i] = made_up_value(a, i, total_no);
  for (int i = 0; i < run->surface.n; ++i)
    run->status[i] = (contact_status)((i + total_no) % 3);
  s->report = (solver_report){.outcome = CONVERGED,
                              .iterations = 7,
                              .residual = 1e-12 * total_no,
                              .solver = "newton"};
  s->energy = (energies){
      .strain = 2, .external = 5, .friction = 3 - 1e-9, .largest = 5};
  s->energy.defect = 1e-9;
  run->totals[0] = (contact_total){
      .force = {1.5, 2.5, -3.5}, .normal = -2.5 * total_no, .area = 0.75};
  run->torque[0] = 0.125 * total_no;
  run->loops[0] = (contact_loop){.way = {0.5, -0.25},
                                 .mean_u_t = {1e-3, 2e-3},
                                 .angle = 0.75,
                                 .friction = 2.5,
                                 .friction_end = 3.5,
                                 .start_end = 1.25};
  run->zones[0] = (contact_zone){
      .kind = CONTACT_STICK, .to = {0.5, 0}, .length = 0.5, .area = 0.5};
  run->zones[1] = (contact_zone){.kind = CONTACT_SLIP,
                                 .direction = -1,
                                 .from = {0.5, 0},
                                 .to = {0.75, 0},
                                 .length = 0.25,
                                 .area = 0.25};
  s->contacts.n_open = s->contacts.n_slip = s->contacts.n_stick = total_no;
}

void made_up_free(made_up *run) {
  memory_free(run->msh);
  memory_free(run->surface.node_id);
  memory_free(run->surface.node_no);
  memory_free(run->surface.contact_id);
  memory_free(run->surface.x);
  memory_free(run->surface.area);
  memory_free(run->surface.frame);
  for (int a = 0; a < MADE_ARRAYS; ++a) memory_free(run->array[a]);
  memory_free(run->status);
  memory_free(run);
}

void made_up_leave(made_up *const *run) { made_up_free(*run); }
