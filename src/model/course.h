/*
 * What of a step varies with the time: loads, supports, temperatures, the
 * motions of obstacles, friction, gaps and forces of contacts.
 */
#pragma once

#include "model/model.h"

typedef struct course {
  const quantity *value;
  const load *l; /* NULL: no load */
  const step *s;
  double x[3]; /* of a node of its group; 0 without a load */
} course;

/* Of a step, by k from 0 below the count; 0: number k does not vary. */
int course_count(const model *m, const step *s);
int course_at(const model *m, const mesh *msh, const step *s, int k,
              course *out);
double value_of_course(const course *c, double t);

/* Points of its table over the time from "after" to before t: the first; *n of
 * them. */
int course_points(const course *c, double after, double t, int *n);

/* Times within an increment, ascending. */
enum { TURNS = 8 };
typedef struct turn_list {
  int n;
  double at[TURNS]; /* s */
} turn_list;

/* Adds t, unless it is there; 0: there is no place for it. */
int turns_add(turn_list *list, double t);
/*
 * Adds the times from t0 to t at which the course passes a maximum or minimum
 * beyond its values at t0, t and the times listed, found among its values at 64
 * parts and at the points of a table. Returns 1, or 2 if it is not straight; 0
 * if it does not vary; -1: there is no place for all.
 */
int course_turns(const course *c, double t0, double t, turn_list *list);
