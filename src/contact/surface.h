/*
 * The contact surface Gamma_3: contact nodes with normal, tangents, tributary
 * area and gap to their rigid obstacle.
 */
#pragma once

#include "contact/mortar/mortar.h"
#include "contact/obstacle.h"

typedef struct contact_surface {
  int dim, n;
  int *node_id;        /* [n] mesh node, ascending */
  size_t *node_no;     /* [n] its number in the mesh file */
  int *contact_id;     /* [n] the *CONTACT the normal belongs to */
  int *side_id;        /* [n*(dim-1)] *CONTACT of a second (third) obstacle,
                          -1 */
  double *x;           /* [dim*n] m */
  double *area;        /* [n] tributary area (integral of the P1 function over
                          the faces of contact_id, of a pair what it carries),
                          m2; 2-D: times thickness; axisymmetric: whole turn */
  double *side_area;   /* [n*(dim-1)] the same of side_id, 0 where it is -1 */
  double *frame;       /* [dim*dim*n] rows n, t1[, t2]: a = frame u; orthonormal
                          except where side_id >= 0 (then that row is the normal
                          of the second obstacle) or held (then that row is what
                          supports hold, oblique to a normal that leans) */
  double *basis;       /* [dim*dim*n] its inverse: u = basis a, column major */
  double *gap0;        /* [n] gap along the normal at time 0, m */
  unsigned char *held; /* [dim*n] 1: this contact unknown is prescribed by
                        *BOUNDARY (never the normal one) */
  node_links *master;  /* row q: contact node q, whose unknowns are relative to
                          the master surface of a pair; NULL: no pair */
  double *share;       /* [dim*n] a row is divided by it: unknowns are averages
                          over what a slave node carries, for neighbours without
                          a multiplier too, -; NULL: no pair */
  double *covered;     /* [n] part of the faces around the node that its normal
                          force acts on, -; NULL: no pair */
  double *lever;       /* [dim*dim*n] where the resultant of a row acts, m;
                          NULL: no pair */
  double *apart;       /* [dim*n] gap to the master along the rows that are
                          normals of pairs, at time 0, m; NULL: no pair */
} contact_surface;

/* A *CONTACT or *CONTACT PAIR as the surface sees it. */
typedef struct contact_pair {
  const char *card, *name;  /* card: "*CONTACT", "*CONTACT PAIR" or "*CRACK" */
  const mesh_group *group;  /* of a pair: the slave */
  const obstacle *support;  /* NULL: a pair */
  const mesh_group *master; /* of a pair */
  unsigned how;             /* of a pair, see surfaces_couple */
  const quantity *change;   /* added to the gap of a pair, m, or NULL */
  double change_sign;       /* -1: it is an interference */
  int update;               /* 1: of a pair, coupled at the places x + u */
  mortar *coupled;     /* of a pair, by pairs_couple; owned by the caller */
  int friction;        /* 1: its law has a sliding limit (for a warning only) */
  int obstacle_normal; /* 1: n is that of the obstacle, not of the body */
  place at;
} contact_pair;

/* Per node, what *BOUNDARY fixes: bit c of fixed[node_id] = component c. */
typedef struct surface_input {
  const mesh *mesh;
  int n_pair;
  contact_pair *pairs;        /* [n_pair] */
  const unsigned char *fixed; /* [n_node] */
  const tie_set *ties;        /* its nodes are no contact nodes */
  const double *face_weight;  /* [n_face] thickness; 1 in 3-D */
  const double *u; /* [dim*n_node] displacements for pairs with update, m; NULL:
                      none yet */
  int axisymmetric;
} surface_input;

/* pair.c: how many slave nodes supports hold along a component that they hold
 * of no master. */
int surfaces_held_alone(const surface_input *in, const mortar *m);
/* pair.c: the coupling of two surfaces at the places x[dim*n_node], without the
 * nodes of dropped[n_node] (or NULL): *out, NULL or an old one that is freed.
 * ERR_MEMORY. how: the normals are those of the slave; the gaps those of the
 * faces as they are. */
enum { COUPLE_SLAVE_NORMAL = 1, COUPLE_FLAT = 2 };
status surfaces_couple(const surface_input *in, const double *x,
                       const mesh_group *slave, const mesh_group *master,
                       unsigned how, const unsigned char *dropped,
                       mortar **out);
/*
 * pair.c: the coupling of each pair under the supports of the input, without
 * the slave nodes that supports hold along the normal, and those that an
 * earlier pair has with (nearly) the same normal. ERR_DECK with errors in the
 * log: surfaces that do not face each other; ERR_MEMORY.
 */
status pairs_couple(const surface_input *in, message_log *log);
void pairs_release(const surface_input *in); /* frees the couplings */
/*
 * Build it, once pairs are coupled. The normal of a node is the sum of the
 * normals of its faces in the group weighted with its share of their area (the
 * gradient of the volume), or that of the obstacle at that place
 * (obstacle_normal, where the shape has one), taken orthogonal to the
 * components that are fixed there; those become tangents, flagged in held.
 *
 * Left out, with a message: nodes fixed in the normal direction, nodes
 * that an obstacle at rest cannot reach along the normal.  A node in the groups
 * of two contacts has the normal of the first and, as a side, of the second;
 * where both have the same obstacle and the surface is smooth there, it belongs
 * to the first with the faces of both.
 *
 * ERR_DECK with errors in the log; ERR_MEMORY.  *out is NULL on failure.
 */
status surface_build(const surface_input *in, message_log *log,
                     contact_surface **out);
/* Gap where a line does not meet an obstacle that moves, over the size of the
 * mesh: no body comes that far. */
#define SURFACE_UNMET 1e6
/*
 * pair.c: gap[n] at time t, m: SURFACE_UNMET where the obstacle is out of reach
 * at that time.  side_gap[n*(dim-1)] (or NULL): HUGE_VAL without a
 * second obstacle.  ERR_DECK if a gap is not a number.
 */
status surface_gap(const contact_surface *s, const surface_input *in, double t,
                   double *gap, double *side_gap);
/* pair.c: 1 unless contact node i has an obstacle that its normal does not meet
 * at time t. */
int surface_meets(const contact_surface *s, const contact_pair *pairs, int i,
                  double t);
/* pair.c: adds to motion[dim*n] the displacement of the obstacle at each node
 * from time t0 to t (obstacle_drift) in the contact frame, m. */
void surface_drift(const contact_surface *s, const surface_input *in, double t0,
                   double t, double *motion);
/* pair.c: w[dim*n], the contact unknowns of the displacements u[dim*n_node]:
 * relative to the masters of pairs, F_a . (u - sum part u(master)) / share. */
void surface_relative(const contact_surface *s, const double *u, double *w);
/* Motion v[dim] of contact node q relative to what its row a meets, of the
 * displacements u[dim*n_node], m. */
void surface_motion(const contact_surface *s, const double *u, int q, int a,
                    double *v);
/* Tangent a = 1, 2 of the first normal of contact node q, t[dim]: row a, but at
 * a corner, where that is another normal. */
void surface_tangent(const contact_surface *s, int q, int a, double *t);
/* Displacement along that tangent, m, of u[dim*n_node] and w[dim*n] of it. */
double surface_along(const contact_surface *s, const double *u, const double *w,
                     int q, int a);
/* w of row a of node q, which supports hold (fixed[dim*n_node]) at
 * ud[dim*n_node], and its masters if it is relative to them, m. */
double surface_prescribed(const contact_surface *s, const unsigned char *fixed,
                          const double *ud, int q, int a);
/* pair.c: 1: a force of row a of node q acts on all that the node touches; 0:
 * supports hold the node, but not the master of its pair. */
int surface_is_mutual(const contact_surface *s, int q, int a);
/* F[dim*n_node] += factor times the forces r[dim*n] dual to those, on
 * both sides of pairs: r'w = F'u. */
void surface_spread(const contact_surface *s, double factor, const double *r,
                    double *F);
/* The same of row a of contact node q alone. */
void surface_spread_row(const contact_surface *s, int q, int a, double force,
                        double *F);
/* The forces r[dim*n] that surface_spread brings to F[dim*n_node] at the
 * contact nodes. ERR_MEMORY. */
status surface_forces(const contact_surface *s, int n_node, const double *F,
                      double *r);
/* What row a of contact node i is divided by, -. */
static inline double surface_share(const contact_surface *s, int i, int a) {
  return s->share == NULL ? 1.0 : s->share[s->dim * i + a];
}
/* Where the force of row a of contact node i acts, [dim] m. */
static inline const double *surface_place(const contact_surface *s, int i,
                                          int a) {
  return s->lever == NULL ? s->x + s->dim * i
                          : s->lever + s->dim * (s->dim * i + a);
}
/* The contact whose normal row a of node i is; -1: a tangent. */
static inline int surface_normal_of(const contact_surface *s, int i, int a) {
  return a == 0 ? s->contact_id[i] : s->side_id[(s->dim - 1) * i + a - 1];
}
/* The same; of a tangent that of the first normal. */
static inline int surface_contact_of(const contact_surface *s, int i, int a) {
  const int id = surface_normal_of(s, i, a);
  return id >= 0 ? id : s->contact_id[i];
}
/* 1: some contact unknown is held. */
int surface_has_held(const contact_surface *s);
/* 1 if node i touches a second obstacle: it has no friction. */
static inline int surface_is_corner(const contact_surface *s, int i) {
  return s->side_id != NULL && s->side_id[i * (s->dim - 1)] >= 0;
}
