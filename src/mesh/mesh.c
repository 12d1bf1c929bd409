/* The finished mesh: release, look-up of groups, measures, bodies. */
#include "mesh/build.h"

#include "base/base.h"
#include "base/option.h"

#include <stdarg.h>

const char *const mesh_words[4] = {"points", "curves", "surfaces", "volumes"};

const mesh_group *mesh_find_group(const mesh *m, const char *name) {
  for (int i = 0; i < m->n_group; ++i)
    if (strcmp(m->group[i].name, name) == 0) return &m->group[i];
  return NULL;
}

const char *mesh_nearest_group(const mesh *m, const char *name) {
  return nearest_word(name, candidate_name, NAMES(m->group, m->n_group));
}

/* d = x[b] - x[a] */
static void difference(const mesh *m, int a, int b, double *d) {
  vector_of(m->dim, mesh_node_x(m, a), mesh_node_x(m, b), d);
}

double mesh_face_normal(const mesh *m, int face_id, double *normal) {
  const int *v = mesh_face_nodes(m, face_id);
  double a[3], b[3], c[3];
  difference(m, v[0], v[1], a);
  if (m->dim == 2) {
    double length = hypot(a[0], a[1]);
    normal[0] = a[1] / length;
    normal[1] = -a[0] / length;
    return length;
  }
  difference(m, v[0], v[2], b);
  cross(a, b, c);
  double twice = hypot(hypot(c[0], c[1]), c[2]);
  for (int k = 0; k < 3; ++k) normal[k] = c[k] / twice;
  return 0.5 * twice;
}

/* Gauss; Dunavant, Int. J. Num. Meth. Eng. 21, 1985, table II. */
const face_rule mesh_face_rule[2] = {
    {3, {0.1127016653792583, 0.5}, {5. / 18, 8. / 18}},
    {6,
     {0.44594849091596489, 0.09157621350977074},
     {0.22338158967801147, 0.10995174365532187}}};

double face_rule_point(const face_rule *r, int dim, int k, double *phi) {
  const int of = k / dim;
  for (int i = 0; i < dim; ++i) phi[i] = r->at[of];
  phi[k % dim] = 1.0 - (dim - 1) * r->at[of];
  return r->part[of];
}

double mesh_elem_measure(const mesh *m, int elem_id) {
  const int *v = mesh_elem_nodes(m, elem_id);
  double a[3], b[3], c[3], ab[3];
  difference(m, v[0], v[1], a);
  difference(m, v[0], v[2], b);
  if (m->dim == 2) return 0.5 * (a[0] * b[1] - a[1] * b[0]);
  difference(m, v[0], v[3], c);
  cross(a, b, ab);
  return (ab[0] * c[0] + ab[1] * c[1] + ab[2] * c[2]) / 6.0;
}

double mesh_elem_gradients(const mesh *m, int elem_id, double *g) {
  const size_t n = (size_t)m->dim + 1;
  const int *v = m->elem + n * elem_id;
  double e[3][3];
  if (m->dim == 2) {
    const double *p[3];
    for (int a = 0; a < 3; ++a) p[a] = m->x + 2 * (size_t)v[a];
    const double two_area = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) -
                            (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]);
    for (int a = 0; a < 3; ++a) {
      const double *q = p[(a + 1) % 3], *r = p[(a + 2) % 3];
      g[2 * a] = (q[1] - r[1]) / two_area;
      g[2 * a + 1] = (r[0] - q[0]) / two_area;
    }
    return two_area;
  }
  for (int k = 0; k < 3; ++k) difference(m, v[0], v[k + 1], e[k]);
  cross(e[1], e[2], g + 3);
  cross(e[2], e[0], g + 6);
  cross(e[0], e[1], g + 9);
  const double six_volume = e[0][0] * g[3] + e[0][1] * g[4] + e[0][2] * g[5];
  for (int i = 3; i < 12; ++i) g[i] /= six_volume;
  for (int c = 0; c < 3; ++c) g[c] = -(g[3 + c] + g[6 + c] + g[9 + c]);
  return six_volume;
}

/* The path is halved on each search. */
int forest_root(int *parent, int i) {
  while (parent[i] != i) {
    parent[i] = parent[parent[i]];
    i = parent[i];
  }
  return i;
}

void forest_join(int *parent, int a, int b) {
  a = forest_root(parent, a);
  b = forest_root(parent, b);
  if (a < b)
    parent[b] = a;
  else
    parent[a] = b;
}

status mesh_bodies(const mesh *m, int *n_body, int *body) {
  OWNED int *parent = NULL, *body_of = NULL;
  int n_corner = m->dim + 1;
  PASS_NEW_ALL(OF(parent, m->n_node), OF(body_of, m->n_node));
  for (int i = 0; i < m->n_node; ++i) parent[i] = i;
  for (int e = 0; e < m->n_elem; ++e) {
    const int *v = mesh_elem_nodes(m, e);
    for (int k = 1; k < n_corner; ++k) forest_join(parent, v[0], v[k]);
  }
  *n_body = 0;
  for (int i = 0; i < m->n_node; ++i) /* a root comes before its nodes */
    body_of[i] = parent[i] == i ? (*n_body)++ : body_of[forest_root(parent, i)];
  for (int e = 0; e < m->n_elem; ++e) body[e] = body_of[*mesh_elem_nodes(m, e)];
  return OK;
}

status mesh_node_elements(const mesh *m, size_t **start, int **elem) {
  const int per = m->dim + 1;
  return number_places(m->n_node, (size_t)per * m->n_elem, m->elem, per, start,
                       elem);
}

void fault_add(faults *c, const char *format, ...) {
  if (++c->n > SHOWN + 1) return;
  if (c->n > 1) text_add(c->text, sizeof c->text, ", ");
  if (c->n > SHOWN) format = "...";
  const size_t used = strlen(c->text);
  va_list args;
  va_start(args, format);
  vsnprintf(c->text + used, sizeof c->text - used, format, args);
  va_end(args);
}

void fault_centre(const mesh *m, int n, const int *v, double *x) {
  for (int k = 0; k < 3; ++k) x[k] = 0.0;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < m->dim; ++k) x[k] += mesh_node_x(m, v[i])[k] / n;
}

void fault_at(faults *c, int dim, size_t no, const double *x) {
  if (dim == 2)
    fault_add(c, "%zu at (%.6g, %.6g)", no, x[0], x[1]);
  else
    fault_add(c, "%zu at (%.6g, %.6g, %.6g)", no, x[0], x[1], x[2]);
}

void fault_pair(faults *c, int dim, size_t one, size_t two, const double *x) {
  if (dim == 2)
    fault_add(c, "%zu and %zu at (%.6g, %.6g)", one, two, x[0], x[1]);
  else
    fault_add(c, "%zu and %zu at (%.6g, %.6g, %.6g)", one, two, x[0], x[1],
              x[2]);
}

status build_check(const builder *b) {
  int n = message_count(b->log, ERROR) - b->errors;
  if (n > 0) RAISE(ERR_MESH, "the mesh is not valid: %d error(s)", n);
  return OK;
}
