/*
 * Sums of the bounds, shared by the files of this folder only.
 */
#ifndef PROTIS_REDUCTION_PARTS_H
#define PROTIS_REDUCTION_PARTS_H

#include "effects/reduction/reduction.h"

struct reduction {
  const model *m;
  const mesh *msh;
  domain d;
  kinematics *kin;       /* [n_section] */
  double *thickness, *E; /* [n_section], [ns*ns*n_section] */
  double *C;             /* [36*n_section] */
  unsigned char *fixed;  /* [dim*n_node] zero */
  double *sigma;         /* [ns*n_elem] Pa */
  double *T0, *T;        /* [n_elem] */
  double *heat;          /* [ns*n_elem] thermal strain of the last increment */
  struct {
    double *strain;      /* [ns*n_elem] inelastic strain so far */
    double *strain_rate; /* [ns*n_elem] 1/s, of the last increment */
    double *stress;      /* [n_elem] Pa, of the inelastic strain so far */
    double *rate;        /* [n_elem] Pa/s, of the last increment */
  } flow;
  double *way;              /* [(dim-1)*n_node] all slip so far, m*/
  double sum[NEGLECT_MAX];  /* sqrt(J), of the row */
  double last[NEGLECT_MAX]; /* sqrt(J)/s, rate of the last increment */
  double seen[NEGLECT_MAX]; /* -, bound at the last increment solved again */
  double tangential;        /* N, largest tangential force so far */
  double total;             /* N, largest of their sums so far */
  int *elem_id;             /* [n_elem] all */
  double *strain;           /* [ns*n_elem] room */
  double *force, *u;        /* [dim*n_node] room */
};

/* scales.c. Largest stress by pressures and prescribed displacements, Pa; 0:
 * not known (expressions, forces). */
double reduction_load_stress(const model *m, const mesh *msh, double young);
double reduction_young(const material *mat); /* Pa */
int reduction_has_initial(const model *m);   /* 1: of strains, displacements */
/* A new row; NULL: the table is full. */
omitted *reduction_row(model *m, int bit, int id);
/* Kinematics of the first section of a material, or -1. */
int reduction_kinematics(const model *m, int material_id);
/* Increments of a step if each has dt. */
double reduction_increments(const step *s, double dt);
/* a / b; 0 if a is 0. */
double reduction_part(double a, double b);
const material *reduction_material(const reduction *n, int elem_id);
/* 1: the row leaves out the law of that element. */
int reduction_is_about(const reduction *n, const omitted *row, int elem_id);
/* Coefficient of the friction left out at contact node i. */
double reduction_coefficient(const reduction *n, const state *s, int i);

/* laws.c: materials to try without their law. */
status reduction_try_laws(model *m, const mesh *msh);
/* threshold.c: elements that stay below the threshold of their law. */
status reduction_try_threshold(model *m, const mesh *msh);
/* measure.c: stresses of the run into n->sigma. */
status reduction_stress(reduction *n, const state *s);

/* again.c: the increment with the effect of row k in force, where the row's
 * "bound" now has doubled since the last time or the step ends. */
status reduction_again(reduction *n, const state *s, int k, double bound,
                       omitted *row);

#endif
