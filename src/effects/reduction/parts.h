/* Sums of the bounds, shared by the files of this folder only. */
#pragma once

#include "effects/reduction/reduction.h"
#include "run/run.h"

struct reduction {
  const model *m;
  const mesh *msh;
  domain d;
  moduli moduli;        /* of the sections */
  unsigned char *fixed; /* [dim*n_node] zero */
  double *sigma;        /* [ns*n_elem] Pa */
  double *T0, *T;       /* [n_elem] */
  double *heat;         /* [ns*n_elem] thermal strain of the last increment */
  struct {
    double *strain;      /* [ns*n_elem] inelastic strain so far */
    double *strain_rate; /* [ns*n_elem] 1/s, of the last increment */
    double *stress;      /* [n_elem] Pa, of the inelastic strain so far */
    double *rate;        /* [n_elem] Pa/s, of the last increment */
  } flow;
  double *slip;             /* [(dim-1)*n_node] all slip so far, m */
  double sum[OMITTED_MAX];  /* sqrt(J), of the row */
  double last[OMITTED_MAX]; /* sqrt(J)/s, rate of the last increment */
  double seen[OMITTED_MAX]; /* -, bound at the last increment solved again */
  double tangential;        /* N, largest tangential force so far */
  double total;             /* N, largest of their sums so far */
  int *elem_id;             /* [n_elem] all */
  double *strain;           /* [ns*n_elem] room */
  double *force, *u;        /* [dim*n_node] room */
};

/* model.c. Largest stress by pressures and prescribed displacements, Pa; 0:
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

/* measure.c */
const material *reduction_material(const reduction *n, int elem_id);
/* Stresses of the run into n->sigma: its thermal strains and those of the laws
 * in force carry none. */
status reduction_stress(reduction *n, const state *s);
