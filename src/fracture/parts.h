/*
 * Points, their coordinates, fields in them and integrals. Inside src/fracture.
 */
#pragma once

#include "fracture/fracture.h"

enum { MODES = 3, DOMAINS = 3 };

struct fracture {
  fracture_body body;
  int n;
  fracture_point *point; /* [n] */
  size_t *start;         /* [n_node+1] */
  int *elem;             /* elements round each node */
  /* Search for elements */
  int *elem_seen, *node_seen; /* [n_elem], [n_node] mark of the last search */
  int mark;
  int *elem_list, *node_list; /* [n_elem], [n_node] */
};

/* All but the search is there: frames, curvature, size and radius. */
status points_find(fracture *f);

/* A place in the coordinates of a point: x[0] ahead of the front and x[1] above
 * the crack, s along the front; the frame turns with the front. */
typedef struct local {
  double x[2], s; /* m */
  double turn;    /* of the frame over the way along e3, 1/m */
  double axis[9]; /* rows e1, e2, e3 */
} local;
void locate(const fracture_point *p, const double x[3], local *at);
/* x[3] of a node, 0 in the third direction of a plane mesh. */
void place_of(const mesh *m, int node, double x[3]);

/* A point of a quadrature on a segment or triangle. */
typedef struct rule_point {
  double phi[3]; /* P1 functions of the corners */
  double part;   /* of the measure */
} rule_point;
enum { RULE_MOST = 16 };
/* Their number. For 1 / sqrt(d) times a second order polynomial on a segment
 * (n = 1) or triangle (2), d the distance from the front, behind[n+1] at the
 * corners, m. */
int lip_rule(int n, const double *behind, rule_point *to);

typedef struct field_tensor {
  double of[3][3]; /* components in the frame of a place */
} field_tensor;
/* From global components. */
void field_turn(const local *at, double in[3][3], field_tensor *out);
void field_turn_vector(const local *at, const double in[3], double out[3]);
double field_product(const field_tensor *a,
                     const field_tensor *b); /* a_ij b_ij */

typedef struct elasticity {
  double kappa; /* 3 - 4 nu, plane stress (3 - nu)/(1 + nu) */
  double G;     /* shear modulus, Pa; 0: not isotropic */
} elasticity;

/*
 * Fields of the tip of a crack in a plane (Williams, J. Appl. Mech. 24, 1957):
 * u[3] and its gradient d[i][l] = du_i/dx_l of K = 1 in a mode (0 .. 2), at x1
 * ahead of the tip and x2 above the crack; on the lips x2 is +0.0 above and
 * -0.0 below.
 *
 *   kappa  3 - 4 nu (plane strain), (3 - nu)/(1 + nu) (plane stress)
 *   G      shear modulus, Pa
 */
void williams_field(int mode, double kappa, double G, const double x[2],
                    double u[3], double d[3][2]);

typedef struct auxiliary { /* of K = 1 */
  field_tensor d, s, e;    /* du_i/dx_l; stress; strain by Hooke's law */
  field_tensor X;          /* slope along e1 of what e lacks to be that of d */
  double div[3];           /* divergence of s */
} auxiliary;
void auxiliary_set(const elasticity *x, const local *at, int mode,
                   auxiliary *out);
/* P of fracture.h, from stress and displacement gradient. */
void interaction_flux(const field_tensor *s, const field_tensor *d,
                      const auxiliary *x, field_tensor *P);
void energy_flux(const field_tensor *s, const field_tensor *d, double share,
                 field_tensor *P);

typedef struct integrals {
  double I[DOMAINS][MODES + 1]; /* of the modes and, last, the energy */
  double length[DOMAINS];       /* int q ds; 1 in 2-D */
  unsigned pointed; /* bits of modes in which forces at nodes have a part */
} integrals;
/* At a point with a radius. */
void integrals_find(fracture *f, const fracture_state *s,
                    const fracture_point *p, const elasticity *x,
                    integrals *out);
/* The derivative of the integrals of a mode, part[k] of domain k; out has its
 * arrays by nodes, and gets its elements. ERR_MEMORY. */
status integrals_derive(fracture *f, const fracture_state *s,
                        const fracture_point *p, const elasticity *x, int mode,
                        const double *part, fracture_linear *out);
