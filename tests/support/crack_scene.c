#include "support/crack_scene.h"

#include "base/base.h"
#include "mesh/crack/crack.h"

static void must(int held, const char *what) {
  if (held) return;
  fprintf(stderr, "test: %s failed\n", what);
  abort();
}

static void *zeroed(int n, size_t size) {
  void *p = calloc((size_t)n, size);
  must(p != NULL, "memory");
  return p;
}

/* Nodes on the crack are above or below as their elements are. */
static void find_sides(crack_scene *s, double height) {
  const mesh *m = s->m;
  const int per = m->dim + 1;
  s->side = zeroed(m->n_node, sizeof *s->side);
  for (int e = 0; e < m->n_elem; ++e) {
    double middle = 0;
    for (int a = 0; a < per; ++a)
      middle += (s->y[3 * m->elem[per * e + a] + m->dim - 1] - height) / per;
    for (int a = 0; a < per; ++a) {
      int node = m->elem[per * e + a];
      double here = s->y[3 * node + m->dim - 1] - height;
      if (fabs(here) < 1e-9) here = middle;
      s->side[node] = here > 0 ? 1 : -1;
    }
  }
}

void scene_start(crack_scene *s, mesh *m, double height,
                 const fracture_material *material, const double *turn) {
  static const double none[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const mesh_cut cut[2] = {{mesh_find_group(m, "CRACK"), NULL},
                           {mesh_find_group(m, "OTHER"), NULL}};
  mesh_crack crack[2] = {0};
  const int dim = m->dim;
  message_log *log;
  memset(s, 0, sizeof *s);
  s->m = m;
  s->material[0] = *material;
  memcpy(s->turn, turn != NULL ? turn : none, sizeof s->turn);
  must(message_log_new(&log) == OK, "log");
  must(mesh_open(m, cut[1].group ? 2 : 1, cut, log, crack) == OK, "opening");
  s->crack = crack[0];
  memory_free(log);
  s->y = zeroed(3 * m->n_node, sizeof *s->y);
  for (int i = 0; i < m->n_node; ++i) {
    for (int c = 0; c < dim; ++c) s->y[3 * i + c] = m->x[dim * i + c];
    for (int c = 0; c < dim; ++c) {
      m->x[dim * i + c] = 0;
      for (int k = 0; k < 3; ++k)
        m->x[dim * i + c] += s->turn[3 * c + k] * s->y[3 * i + k];
    }
  }
  find_sides(s, height);
  s->section = zeroed(m->n_elem, sizeof *s->section);
  s->u = zeroed(dim * m->n_node, sizeof *s->u);
  s->sigma = zeroed(2 * dim * m->n_elem, sizeof *s->sigma);
}

static void turned(const crack_scene *s, const double *value, double sign,
                   double *to) {
  for (int c = 0; c < s->m->dim; ++c) {
    to[c] = 0;
    for (int k = 0; k < 3; ++k) to[c] += sign * s->turn[3 * c + k] * value[k];
  }
}

/* Hooke's law on the constant strain of an element. */
static void set_stress(crack_scene *s, int elem) {
  static const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2},
                                 {0, 1}, {1, 2}, {2, 0}};
  const mesh *m = s->m;
  const fracture_material *x = &s->material[s->section[elem]];
  const int dim = m->dim, *v = m->elem + (dim + 1) * elem;
  const double G = x->E / (2 * (1 + x->nu));
  const double lambda = x->plane_stress ? 2 * G * x->nu / (1 - x->nu)
                                        : 2 * G * x->nu / (1 - 2 * x->nu);
  double g[12], d[3][3] = {{0}};
  mesh_elem_gradients(m, elem, g);
  for (int a = 0; a <= dim; ++a)
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        d[i][j] += s->u[dim * v[a] + i] * g[dim * a + j];
  for (int k = 0; k < 2 * dim; ++k) {
    const int i = pair[k][0], j = pair[k][1];
    s->sigma[2 * dim * elem + k] =
        G * (d[i][j] + d[j][i]) +
        (i == j ? lambda * (d[0][0] + d[1][1] + d[2][2]) : 0);
  }
  if (x->plane_stress) s->sigma[2 * dim * elem + 2] = 0;
}

void scene_move(crack_scene *s, crack_field *field, const void *ctx) {
  for (int i = 0; i < s->m->n_node; ++i) {
    double u[3] = {0, 0, 0};
    field(ctx, s->y + 3 * i, s->side[i], u);
    turned(s, u, 1, s->u + s->m->dim * i);
  }
  for (int e = 0; e < s->m->n_elem; ++e) set_stress(s, e);
}

void scene_load(crack_scene *s, crack_field *field, const void *ctx) {
  const mesh *m = s->m;
  if (s->traction == NULL)
    s->traction = zeroed(m->dim * m->n_node, sizeof *s->traction);
  for (int i = 0; i < 2 * s->crack.n; ++i) {
    const int *face = i % 2 ? s->crack.plus : s->crack.minus;
    for (int k = 0; k < m->dim; ++k) {
      const int node = m->face[m->dim * face[i / 2] + k];
      double t[3] = {0, 0, 0};
      field(ctx, s->y + 3 * node, s->side[node], t);
      turned(s, t, -s->side[node], s->traction + m->dim * node);
    }
  }
}

fracture_factors *scene_factors(const crack_scene *s, int *n,
                                fracture_point **points) {
  const fracture_body body = {s->m, 1, &s->crack, s->section, s->material};
  const fracture_state state = {s->u, s->sigma, s->traction,
                                0.5,  s->force, NULL};
  fracture *f;
  must(fracture_new(&body, &f) == OK, "fracture_new");
  *n = fracture_count(f);
  fracture_factors *out = zeroed(*n, sizeof *out);
  *points = zeroed(*n, sizeof **points);
  memcpy(*points, fracture_points(f), (size_t)*n * sizeof **points);
  fracture_find(f, &state, out);
  memory_free(f);
  return out;
}

void scene_end(crack_scene *s) {
  memory_free(s->m);
  free(s->section);
  free(s->y);
  free(s->side);
  free(s->u);
  free(s->sigma);
  free(s->traction);
  free(s->force);
}
