/*
 * Columns of the nodes and of the elements.
 */
#include "run/column_row.h"

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

/* Turn p and q of a symmetric matrix so that a[p][q] = 0 (Jacobi). */
static void turn(double a[3][3], int p, int q) {
  const int r = 3 - p - q;
  const double half = (a[q][q] - a[p][p]) / 2, off = a[p][q];
  const double t = off / (half + copysign(sqrt(half * half + off * off), half));
  const double cosine = 1 / sqrt(1 + t * t), sine = t * cosine;
  const double rp = a[r][p], rq = a[r][q];
  a[p][p] -= t * off;
  a[q][q] += t * off;
  a[p][q] = a[q][p] = 0;
  a[r][p] = a[p][r] = cosine * rp - sine * rq;
  a[r][q] = a[q][r] = sine * rp + cosine * rq;
}

/* Principal stress number part, the largest first. */
static double principal(const view *v, int id, int part) {
  const double *s = v->s->body.stress + at(v->m->ns, id, 0);
  const int solid = v->m->ns == 6;
  double a[3][3], scale = 0;
  for (int k = 0; k < v->m->ns; ++k) scale = fmax(scale, fabs(s[k]));
  if (!(scale > 0)) return s[0];
  for (int k = 0; k < 3; ++k) a[k][k] = s[k] / scale;
  a[0][1] = a[1][0] = s[3] / scale;
  a[1][2] = a[2][1] = solid ? s[4] / scale : 0;
  a[2][0] = a[0][2] = solid ? s[5] / scale : 0;
  for (int pass = 0; pass < 30; ++pass) {
    const int p = pass % 3, q = (p + 1) % 3;
    if (fabs(a[p][q]) > 1e-17) turn(a, p, q);
  }
  const double most = fmax(fmax(a[0][0], a[1][1]), a[2][2]);
  const double least = fmin(fmin(a[0][0], a[1][1]), a[2][2]);
  if (part == 0) return scale * most;
  if (part == 2) return scale * least;
  return scale * (a[0][0] + a[1][1] + a[2][2] - most - least);
}

/* clang-format off */
#define NODE  PER_NODE, AS_REAL
#define ELEM  PER_ELEMENT, AS_REAL
#define NODES (PRINT_NODES | PRINT_REACTIONS)
#define STRAIN(scenes) PRINT_ELEMENTS, ON(STRESS), scenes, NEEDS_STRAIN
#define STRESS(scenes) PRINT_ELEMENTS, ON(STRESS), scenes, NEEDS_STRESS
const column node_columns[] = {
{"node_no", "-", PER_NODE, AS_COUNT, NODES, 0, ANY, NULL, 0, node_no, NULL,
 "number in the mesh"},
{"x", "length", NODE, NODES, 0, CART, 0, NULL, 0, node_x,
 NULL, "coordinate"},
{"r", "length", NODE, NODES, 0, SCENE_AXI, 0, NULL, 0, node_x, NULL,
 "coordinate"},
{"y", "length", NODE, NODES, 0, CART, 0, NULL, 1, node_x,
 NULL, "coordinate"},
{"z", "length", NODE, NODES, 0, SCENE_AXI, 0, NULL, 1, node_x, NULL,
 "coordinate"},
{"z", "length", NODE, NODES, 0, SCENE_SOLID, 0, NULL, 2, node_x, NULL,
 "coordinate"},
{"u_x", "length", NODE, PRINT_NODES, 0, CART, 0, "u", 0,
 node_u, NULL, "displacement"},
{"u_r", "length", NODE, PRINT_NODES, 0, SCENE_AXI, 0, "u", 0, node_u, NULL,
 "displacement"},
{"u_y", "length", NODE, PRINT_NODES, 0, CART, 0, "u", 1,
 node_u, NULL, "displacement"},
{"u_z", "length", NODE, PRINT_NODES, 0, SCENE_AXI, 0, "u", 1, node_u, NULL,
 "displacement"},
{"u_z", "length", NODE, PRINT_NODES, 0, SCENE_SOLID, 0, "u", 2, node_u, NULL,
 "displacement"},
OF_EFFECTS(0),
NO_COLUMN};
/* clang-format on */

/* clang-format off */
const column element_columns[] = {
{"elem_no", "-", PER_ELEMENT, AS_COUNT, PRINT_ELEMENTS, 0, ANY, NULL, 0,
 elem_no, NULL, "number in the mesh"},
{"x", "length", ELEM, PRINT_ELEMENTS, 0, CART, 0, NULL, 0, elem_x, NULL,
 "centre"},
{"r", "length", ELEM, PRINT_ELEMENTS, 0, SCENE_AXI, 0, NULL, 0, elem_x, NULL,
 "centre"},
{"y", "length", ELEM, PRINT_ELEMENTS, 0, CART, 0, NULL, 1, elem_x, NULL,
 "centre"},
{"z", "length", ELEM, PRINT_ELEMENTS, 0, SCENE_AXI, 0, NULL, 1, elem_x, NULL,
 "centre"},
{"z", "length", ELEM, PRINT_ELEMENTS, 0, SCENE_SOLID, 0, NULL, 2, elem_x, NULL,
 "centre"},
{"temperature", "temperature", ELEM, PRINT_ELEMENTS,
 ON(STRESS) | ON(THERMAL), ANY, "temperature", 0, temperature, NULL,
 "mean of the element"},
{"mesh_error", "%", ELEM, PRINT_ELEMENTS, ON(MESH_ERROR), SCENE_ALL,
 NEEDS_ELEM_ERROR, "mesh_error", 0, elem_error, NULL, "share of the element in "
 "the error of the mesh, whose square is the sum of their squares"},
{"strain_xx", "-", ELEM, STRAIN(CART), "strain_xx", 0,
 strain, NULL, "strain"},
{"strain_yy", "-", ELEM, STRAIN(CART), "strain_yy", 1,
 strain, NULL, "strain"},
{"strain_zz", "-", ELEM, STRAIN(CART), "strain_zz", 2,
 strain, NULL, "strain"},
{"gamma_xy", "-", ELEM, STRAIN(CART), "gamma_xy", 3,
 strain, NULL, "engineering shear strain"},
{"gamma_yz", "-", ELEM, STRAIN(SCENE_SOLID), "gamma_yz", 4, strain, NULL,
 "engineering shear strain"},
{"gamma_zx", "-", ELEM, STRAIN(SCENE_SOLID), "gamma_zx", 5, strain, NULL,
 "engineering shear strain"},
{"strain_rr", "-", ELEM, STRAIN(SCENE_AXI), "strain_rr", 0, strain, NULL,
 "strain"},
{"strain_zz", "-", ELEM, STRAIN(SCENE_AXI), "strain_zz", 1, strain, NULL,
 "strain"},
{"strain_tt", "-", ELEM, STRAIN(SCENE_AXI), "strain_tt", 2, strain, NULL,
 "hoop strain"},
{"gamma_rz", "-", ELEM, STRAIN(SCENE_AXI), "gamma_rz", 3, strain, NULL,
 "engineering shear strain"},
{"stress_xx", PA, ELEM, STRESS(CART), "stress", 0,
 stress, NULL, "stress"},
{"stress_yy", PA, ELEM, STRESS(CART), "stress", 1,
 stress, NULL, "stress"},
{"stress_zz", PA, ELEM, STRESS(CART), "stress", 2,
 stress, NULL, "stress"},
{"stress_xy", PA, ELEM, STRESS(CART), "stress", 3,
 stress, NULL, "shear stress"},
{"stress_yz", PA, ELEM, STRESS(SCENE_SOLID), "stress", 4, stress, NULL,
 "shear stress"},
{"stress_zx", PA, ELEM, STRESS(SCENE_SOLID), "stress", 5, stress, NULL,
 "shear stress"},
{"stress_rr", PA, ELEM, STRESS(SCENE_AXI), "stress", 0, stress, NULL,
 "stress"},
{"stress_zz", PA, ELEM, STRESS(SCENE_AXI), "stress", 1, stress, NULL,
 "stress"},
{"stress_tt", PA, ELEM, STRESS(SCENE_AXI), "stress", 2, stress, NULL,
 "hoop stress"},
{"stress_rz", PA, ELEM, STRESS(SCENE_AXI), "stress", 3, stress, NULL,
 "shear stress"},
{"mises", PA, ELEM, STRESS(SCENE_ALL), "mises", 0, mises, NULL,
 "von Mises stress"},
{"principal_1", PA, ELEM, 0, ON(STRESS), SCENE_ALL, NEEDS_STRESS,
 "principal_1", 0, principal, NULL, "largest principal stress"},
{"principal_2", PA, ELEM, 0, ON(STRESS), SCENE_ALL, NEEDS_STRESS,
 "principal_2", 1, principal, NULL, "second principal stress"},
{"principal_3", PA, ELEM, 0, ON(STRESS), SCENE_ALL, NEEDS_STRESS,
 "principal_3", 2, principal, NULL, "least principal stress"},
OF_EFFECTS(0),
NO_COLUMN};
/* clang-format on */
