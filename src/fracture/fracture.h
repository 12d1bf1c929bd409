/*
 * Stress intensity factors and energy release rate along the front of a crack
 * (mesh/crack/crack.h), by domain integrals over the elements near a tip or a
 * node of the front:
 *
 *   I = int P_lj Q_l,j + (sig_ij X_ij,l + saux_ij,j u_i,l - b_i uaux_i,l) Q_l
 *       dV - int_lips t_i uaux_i,l Q_l dS - sum_nodes F_i uaux_i,l Q_l,
 *   P_lj = sig_ij uaux_i,l + saux_ij u_i,l - sig:eaux delta_lj,
 *
 *   K_I, K_II = E'/2 I / int q ds,   K_III = G I / int q ds,
 *
 * Q = q e1 the virtual growth, q = 1 within r1, 0 beyond r2. The auxiliary
 * fields are those of Williams with K = 1, around a front of constant
 * curvature; X is what its strains lack to be those of uaux, and saux is not
 * quite in equilibrium: both vanish at a straight front (Gosz, Moran, Engng.
 * Fract. Mech. 69 (2002)). b: body forces, t: tractions on the lips, F: forces
 * at nodes. The energy release rate has the fields themselves in place of the
 * auxiliary ones, with half of sig:eps. u is taken without the rotation of the
 * lips near the point, which has a part in I by its quadrature alone.
 *
 * A domain holds straight crack alone: its size is the distance to the nearest
 * node of another boundary, kink, branch or material, half of the distance to
 * another part of the front, half of the radius of curvature; in 3-D a tube of
 * 0.8 of it as radius and 0.6 as half length. Three domains of different size
 * give the middle and half of the range as scatter, which is no bound of the
 * error: what they have in common, above all the size of the elements at the
 * front, is not seen. J on loaded lips is accurate to first order only.
 *
 * Not treated: axisymmetry; strains without stress that vary within the domain;
 * crack surfaces that are curved in it.
 */
#pragma once

#include "mesh/mesh.h"

typedef struct fracture_material { /* of a section */
  double E, nu;                    /* Pa, -; E = 0: not isotropic, no K */
  int plane_stress;                /* 0: plane strain, or 3-D */
} fracture_material;

/* What does not change with time; all borrowed. */
typedef struct fracture_body {
  const mesh *mesh;
  int n_crack;
  const mesh_crack *crack;           /* [n_crack] */
  const int *section_id;             /* [n_elem] */
  const fracture_material *material; /* [n_section] those of section_id */
} fracture_body;

typedef struct fracture_state { /* borrowed */
  const double *u;              /* [dim*n_node] m */
  const double *sigma; /* [ns*n_elem] Pa; ns = 4: xx, yy, zz, xy; 6: xx, yy,
                          zz, xy, yz, zx */
  /* [dim*n_node] on the body, at nodes of the lips, Pa; NULL: none. Within 4
   * elements (a quarter of the radius, if that is less) of the front contact
   * pressures scatter: a line through those up to 16 elements away stands for
   * them. */
  const double *traction;
  double share; /* of sigma:strain in J: 1/2; with u the rate of displacements
                   and strains that grow by the power n of the stress n/(n+1),
                   and J is C(t), W/m2 */
  const double *force; /* [dim*n_elem] on the elements, N/m3; NULL: none */
  const double *point; /* [dim*n_node] at nodes, 2-D: over the thickness, N
                          (N/m); NULL: none. At a front there are no factors. */
} fracture_state;

typedef struct fracture_point { /* a tip, or a node of the front */
  int crack, node;
  double origin[3]; /* its place, m */
  double frame[9];  /* rows e1 of growth, e2 normal to the crack to the plus
                       side, e3 = e1 x e2; 2-D: e3 is z or -z */
  double curvature; /* of the front, 1/m; > 0: around the crack */
  double size;      /* of the elements there, m */
  double radius;    /* of the largest domain, m; 0: no space for one */
  int section;      /* -1: elements of different materials meet there */
} fracture_point;

/* NAN where no domain has space, as next to the end of a front at the surface;
 * K also between materials. */
typedef struct fracture_factors {
  double K[3], K_scatter[3]; /* I, II, III (0 in 2-D), Pa m^(1/2) */
  double J, J_scatter;       /* energy release rate, J/m2 */
  unsigned pointed; /* bits of the modes with a part of forces at nodes */
} fracture_factors;

typedef struct fracture fracture;

/* Points crack by crack in the order of front_node, and their domains. *out is
 * new. ERR_MEMORY. */
status fracture_new(const fracture_body *body, fracture **out);
int fracture_count(const fracture *f);
const fracture_point *fracture_points(const fracture *f); /* borrowed */
/* out[fracture_count]. Cost: that of the elements in the domains. */
void fracture_find(fracture *f, const fracture_state *s, fracture_factors *out);

/* K of one mode at one point as a linear function of displacements and
 * tractions, K = by_u'u + by_traction't. */
typedef struct fracture_linear {
  double *by_u;        /* [dim*n_node] Pa m^(-1/2) */
  double *by_traction; /* [dim*n_node] m^(1/2) */
  int n;
  int *elem;     /* [n] of the domains */
  double *flux;  /* [n*(dim+1)*dim*dim] the derivative by du_i/dx_j, row by row,
                    at dim + 1 points of each, Pa m^(1/2) per m^dim; point k has
                    fracture_corner of corner k */
  double turned; /* what flux has in s by the rotation of the lips there, which
                    is not in K, Pa m^(1/2) */
} fracture_linear;
/* Barycentric coordinate of a point of flux in its own corner, those in the
 * others are equal: degree 2 with equal weights. */
double fracture_corner(int dim);
/* Mode 0 to 2, of the domains that give K in s; *out is new. The point has a K.
 * ERR_MEMORY. */
status fracture_derive(fracture *f, const fracture_state *s, int point,
                       int mode, fracture_linear *out);
void fracture_linear_free(fracture_linear *l); /* accepts all-zero */
