/*
 * Why there is no equilibrium, in words: contact nodes that move away, loads
 * that drive them, or the nodes where the contact conditions are violated most.
 */
#pragma once

#include "fem/fem.h"
#include "model/model.h"

typedef struct verdict_scene {
  const model *m;
  const mesh *msh;
  const step *step;
  double t; /* s */
  const contact_surface *surface;
  const contact_problem *cp; /* with A */
  const double *given; /* [n] given normal forces, N; < 0: none; or NULL */
  const double *u, *r; /* [m] last iterate of the solver */
  condensed *c;        /* the load condensed last is lost */
} verdict_scene;

/*
 * To "text", "": a clause about the unsolved problem, nothing if nothing is
 * known. A motion without resistance is searched by complementary pivoting, up
 * to 2000 contact nodes. Errors: ERR_MEMORY.
 */
status verdict_text(const verdict_scene *s, char *text, size_t size);
/* The motion alone, nothing if none is found. */
status verdict_motion(const verdict_scene *s, char *text, size_t size);
/* The nodes where the conditions are violated most, as such a clause; nothing
 * if unknown. */
status verdict_misfit(const contact_problem *cp, const contact_surface *surface,
                      const double *u, const double *r, char *text,
                      size_t size);
