/*
 * Elasticity of the elements: one entry for each section, and one for each
 * element whose constants follow its temperature (*ELASTIC with several sets,
 * and temperatures in the deck).
 */
#ifndef PROTIS_MODULI_MODULI_H
#define PROTIS_MODULI_MODULI_H

#include "fem/fem.h"
#include "model/model.h"

typedef struct moduli {
  int n;                     /* entries: sections, then the elements */
  int n_own;                 /* elements with an entry of their own */
  int *elem_id;              /* [n_own] ascending */
  double *at;                /* [n_own] temperature of their entry */
  int *section_id;           /* [n_elem] entry of an element, or NULL: its
                                section */
  int *origin;               /* [n] section of an entry */
  kinematics *kin;           /* [n] */
  double *thickness, *E, *C; /* [n] m, [ns*ns*n], [36*n] Pa */
} moduli;

/* At the temperatures T[n_elem]; T NULL: none is given, no element has an entry
 * of its own. ERR_DECK: constants between two temperatures that are no
 * elasticity; ERR_MEMORY. */
status moduli_new(const model *m, const mesh *msh, const double *T,
                  moduli *out);
void moduli_free(moduli *x); /* accepts all-zero */
/* To other temperatures; *changed = 1 if an entry is another one now, else it
 * stays. ERR_DECK likewise. */
status moduli_heat(moduli *x, const model *m, const double *T, int *changed);
/* What d knows of its elements, borrowed from x and m. */
void moduli_domain(const moduli *x, const model *m, domain *d);
/* Entry of an element. */
int moduli_entry(const moduli *x, const model *m, int elem_id);
/* 1 if the stiffness of the element can change. */
int moduli_follows(const model *m, int elem_id);

#endif
