/*
 * A block that creeps under pressure on a floor it slides on, for the orders of
 * integrators: unit square, E = 1000, nu = 0.3, symmetric about x = 0, friction
 * 0.1, from t = 1 to 3.
 */
#ifndef PROTIS_TESTS_CREEP_CASE_H
#define PROTIS_TESTS_CREEP_CASE_H

/* Order from the displacements at the end with n, 2 n, 4 n increments; check
 * fails if a node but the one on the symmetry line does not slip at the end.
 *   law         card *INELASTIC with its lines, times near 2, stresses of 10
 *   integrator  as in INTEGRATOR=, further words of *VISCO may follow        */
double creep_case_order(const char *law, const char *integrator, int n);

#endif
