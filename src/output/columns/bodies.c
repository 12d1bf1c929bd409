/* Columns of the nodes and of the elements. */
#include "run/column_row.h"

#include "base/vector.h"

#include <math.h>

/* Nodes */
VALUE(node_no, v->msh->node_no[id])
VALUE(node_x, v->msh->x[at(v->msh->dim, id, part)])
VALUE(node_u, v->s->body.u[at(v->msh->dim, id, part)])

/* Elements */
VALUE(elem_no, v->msh->elem_no[id])

static double elem_x(const view *v, int id, int part) {
  const int dim = v->msh->dim, *node = v->msh->elem + (dim + 1) * id;
  double sum = 0;
  for (int k = 0; k <= dim; ++k) sum += v->msh->x[at(dim, node[k], part)];
  return sum / (dim + 1);
}

VALUE(elem_error, 100 * v->s->errors.elem_error[id])
VALUE(temperature, v->s->body.temperature[id])
VALUE(strain, v->s->body.strain[at(v->m->ns, id, part)])
VALUE(stress, v->s->body.stress[at(v->m->ns, id, part)])

static double mises(const view *v, int id, int part) {
  const double *s = v->s->body.stress + at(v->m->ns, id, 0);
  (void)part;
  double shear = s[3] * s[3];
  if (v->m->ns == 6) shear += s[4] * s[4] + s[5] * s[5];
  double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
  return sqrt(0.5 * (a * a + b * b + c * c) + 3 * shear);
}

static double length(const double *a) { return sqrt(dot(3, a, a)); }

/* The larger (sign 1) or the smaller (-1) eigenvalue of [a c; c b]. */
static double of_two(double a, double b, double c, int sign) {
  return (a + b) / 2 + sign * hypot((a - b) / 2, c);
}

/* Of d, symmetric without trace, the eigenvalue farthest from the others. */
static double lone_value(double d[3][3]) {
  const double r =
      sqrt((dot(3, d[0], d[0]) + dot(3, d[1], d[1]) + dot(3, d[2], d[2])) / 6);
  const double normal[3] = {d[1][1] * d[2][2] - d[1][2] * d[2][1],
                            d[1][2] * d[2][0] - d[1][0] * d[2][2],
                            d[1][0] * d[2][1] - d[1][1] * d[2][0]};
  const double ratio = dot(3, d[0], normal) / (2 * r * r * r);
  const double angle = acos(fmax(-1, fmin(1, ratio))) / 3, pi = acos(-1);
  return 2 * r * cos(angle < pi / 6 ? angle : angle + 2 * pi / 3);
}

/* Unit vectors s, t of the plane normal to the eigenvector of "lone", from the
 * columns of d - lone I: the longest, and of the others what is normal to it.
 */
static void plane_of(double d[3][3], double lone, double *s, double *t) {
  double c[3][3];
  int p = 0;
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) c[k][i] = d[k][i] - (i == k ? lone : 0);
    if (length(c[k]) > length(c[p])) p = k;
  }
  double *q = c[(p + 1) % 3], *other = c[(p + 2) % 3];
  const double size = length(c[p]);
  for (int i = 0; i < 3; ++i) s[i] = c[p][i] / size;
  const double along[2] = {dot(3, s, q), dot(3, s, other)};
  for (int i = 0; i < 3; ++i) {
    q[i] -= along[0] * s[i];
    other[i] -= along[1] * s[i];
  }
  if (length(other) > length(q)) q = other;
  const double rest = length(q);
  for (int i = 0; i < 3; ++i) t[i] = q[i] / rest;
}

/* Principal stress number part, the largest first, in space: the lone one by
 * its angle, the others from the plane normal to its direction. W. M.
 * Scherzinger, C. R. Dohrmann, Comput. Methods Appl. Mech. Engrg. 197 (2008)
 * 4007. */
static double principal_in_space(const double *stress, int part) {
  double d[3][3], s[3], t[3], ds[3], dt[3], scale = 0;
  for (int k = 0; k < 6; ++k) scale = fmax(scale, fabs(stress[k]));
  const double mean = (stress[0] + stress[1] + stress[2]) / 3;
  for (int k = 0; k < 3; ++k) {
    d[k][k] = (stress[k] - mean) / scale;
    d[k][(k + 1) % 3] = d[(k + 1) % 3][k] = stress[3 + k] / scale;
  }
  if (!(length(d[0]) + length(d[1]) + length(d[2]) > 0)) return mean;
  const double lone = lone_value(d);
  plane_of(d, lone, s, t);
  for (int k = 0; k < 3; ++k) {
    ds[k] = dot(3, d[k], s);
    dt[k] = dot(3, d[k], t);
  }
  const double a = dot(3, s, ds), b = dot(3, t, dt), c = dot(3, s, dt);
  double e[3] = {lone, of_two(a, b, c, 1), of_two(a, b, c, -1)};
  if (lone < e[1]) {
    e[0] = e[1];
    e[1] = e[2];
    e[2] = lone;
  }
  return mean + scale * e[part];
}

static double principal(const view *v, int id, int part) {
  const double *s = v->s->body.stress + at(v->m->ns, id, 0);
  if (v->m->ns == 6) return principal_in_space(s, part);
  const double high = of_two(s[0], s[1], s[3], 1);
  const double low = of_two(s[0], s[1], s[3], -1);
  if (part == 0) return fmax(high, s[2]);
  if (part == 2) return fmin(low, s[2]);
  return fmax(low, fmin(high, s[2]));
}

/* clang-format off */
#define NODE  PER_NODE, AS_REAL
#define ELEM  PER_ELEMENT, AS_REAL
#define NODES (PRINT_NODES | PRINT_REACTIONS)
#define OF_STRAIN(name, scenes, part, help)                               \
  {name, "-", ELEM, PRINT_ELEMENTS, ON(STRESS), scenes, NEEDS_STRAIN, name, \
   part, strain, NULL, help}
#define OF_STRESS(name, tables, scenes, field, part, value, help)            \
  {name, PA, ELEM, tables, ON(STRESS), scenes, NEEDS_STRESS, field, part,    \
   value, NULL, help}
#define STRESS(name, scenes, part, help) \
  OF_STRESS(name, PRINT_ELEMENTS, scenes, "stress", part, stress, help)
const column node_columns[] = {
{"node_no", "-", PER_NODE, AS_COUNT, NODES, 0, ANY, NULL, 0, node_no, NULL,
 "number in the mesh"},
VECTOR("", "length", NODE, NODES, 0, 0, NULL, node_x, "coordinate"),
VECTOR("u_", "length", NODE, PRINT_NODES, 0, 0, "u", node_u, "displacement"),
OF_EFFECTS(0),
NO_COLUMN};

const column element_columns[] = {
{"elem_no", "-", PER_ELEMENT, AS_COUNT, PRINT_ELEMENTS, 0, ANY, NULL, 0,
 elem_no, NULL, "number in the mesh"},
VECTOR("", "length", ELEM, PRINT_ELEMENTS, 0, 0, NULL, elem_x, "centre"),
{"temperature", "temperature", ELEM, PRINT_ELEMENTS,
 ON(STRESS) | ON(THERMAL), ANY, "temperature", 0, temperature, NULL,
 "mean of the element"},
{"mesh_error", "%", ELEM, PRINT_ELEMENTS, ON(MESH_ERROR), SCENE_ALL,
 NEEDS_ELEM_ERROR, "mesh_error", 0, elem_error, NULL, "share of the element in "
 "the error of the mesh, whose square is the sum of their squares"},
OF_STRAIN("strain_xx", CART, 0, "strain"),
OF_STRAIN("strain_yy", CART, 1, "strain"),
OF_STRAIN("strain_zz", CART, 2, "strain"),
OF_STRAIN("gamma_xy", CART, 3, "engineering shear strain"),
OF_STRAIN("gamma_yz", SCENE_SOLID, 4, "engineering shear strain"),
OF_STRAIN("gamma_zx", SCENE_SOLID, 5, "engineering shear strain"),
OF_STRAIN("strain_rr", SCENE_AXI, 0, "strain"),
OF_STRAIN("strain_zz", SCENE_AXI, 1, "strain"),
OF_STRAIN("strain_tt", SCENE_AXI, 2, "hoop strain"),
OF_STRAIN("gamma_rz", SCENE_AXI, 3, "engineering shear strain"),
STRESS("stress_xx", CART, 0, "stress"),
STRESS("stress_yy", CART, 1, "stress"),
STRESS("stress_zz", CART, 2, "stress"),
STRESS("stress_xy", CART, 3, "shear stress"),
STRESS("stress_yz", SCENE_SOLID, 4, "shear stress"),
STRESS("stress_zx", SCENE_SOLID, 5, "shear stress"),
STRESS("stress_rr", SCENE_AXI, 0, "stress"),
STRESS("stress_zz", SCENE_AXI, 1, "stress"),
STRESS("stress_tt", SCENE_AXI, 2, "hoop stress"),
STRESS("stress_rz", SCENE_AXI, 3, "shear stress"),
OF_STRESS("mises", PRINT_ELEMENTS, SCENE_ALL, "mises", 0, mises,
          "von Mises stress"),
OF_STRESS("principal_1", 0, SCENE_ALL, "principal_1", 0, principal,
          "largest principal stress"),
OF_STRESS("principal_2", 0, SCENE_ALL, "principal_2", 1, principal,
          "second principal stress"),
OF_STRESS("principal_3", 0, SCENE_ALL, "principal_3", 2, principal,
          "least principal stress"),
OF_EFFECTS(0),
NO_COLUMN};
/* clang-format on */
