/*
 * STIFFNESS= of *SOLVER: the condensed matrix by its entries (DENSE) or by
 * products and solves (FACTOR) gives the same answers; AUTO takes the cheaper.
 */
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

#define DENSE "*SOLVER, METHOD=NEWTON, STIFFNESS=DENSE, TOL=1E-12\n"
#define FACTOR "*SOLVER, METHOD=NEWTON, STIFFNESS=FACTOR, TOL=1E-12\n"

/* Decks of all kinds: friction in the plane and in space, pairs, inelastic
 * strains, bodies that contact alone holds, averages. */
static const struct {
  const char *deck, *words;
} decks[] = {
    {"input/greco/greco", "-D N=10"},
    {"input/block_shear_3d/block_shear_3d", "-D N=4 -D NZ=3"},
    {"input/creep_block/creep_block", ""},
    {"input/lying_block/lying_block_3d", "-D N=6"},
    {"input/press_fit/press_fit", ""},
    {"input/arch/arch", ""},
    {"input/nonlocal_slider/nonlocal_slider", "-D N=80"},
    {"input/torsion_sphere_3d/torsion_sphere_3d", "-D NC=3 -D DT=1"},
};
enum { DECKS = sizeof decks / sizeof *decks };

/* Largest difference of the column in the last table, over its largest or
 * "size". */
static double apart(const dat *a, const dat *b, const char *name,
                    double *size) {
  double most = 0, worst = 0;
  for (int i = 0; i < a->n_row; ++i) {
    most = fmax(most, fabs(dat_at(a, i, name)));
    worst = fmax(worst, fabs(dat_at(a, i, name) - dat_at(b, i, name)));
  }
  *size = fmax(*size, most);
  return *size > 0 ? worst / *size : worst;
}

TESTS(both_kinds_give_the_same_forces, DECKS) {
  JOB a = job_begin("dense"), b = job_begin("factor");
  const char *deck = decks[_i].deck, *words = decks[_i].words;
  double force = 0, u = 0;
  int changes = 0;
  ck_assert_int_eq(job_run_with(&a, deck, DENSE, 0, words), 0);
  ck_assert_int_eq(job_run_with(&b, deck, FACTOR, 0, words), 0);
  DAT t = job_table(&a, "CONTACT", -1), s = job_table(&b, "CONTACT", -1);
  ck_assert_int_eq(t.n_row, s.n_row);
  ck_assert_double_le(apart(&t, &s, "f_n", &force), 1e-9);
  ck_assert_double_le(apart(&t, &s, "u_n", &u), 1e-9);
  if (dat_has(&t, "f_t"))
    ck_assert_double_le(apart(&t, &s, "f_t", &force), 1e-9);
  if (dat_has(&t, "f_t1"))
    ck_assert_double_le(apart(&t, &s, "f_t1", &force), 1e-9);
  for (int i = 0; i < t.n_row; ++i)
    changes += dat_at(&t, i, "status") != dat_at(&s, i, "status");
  ck_assert_int_eq(changes, 0);
  if (_i < 2) {
    ck_assert_double_eq_tol(job_told(&a, "contraction"),
                            job_told(&b, "contraction"), 1e-9);
    ck_assert_double_le(job_told(&b, "iterations"),
                        job_told(&a, "iterations") + 2);
  }
  FREED char *listing = job_file(&b, "lst");
  ck_assert_ptr_nonnull(strstr(listing, "FACTOR  STIFFNESS of *SOLVER"));
}

/* ---- every METHOD that works by products ----------------------------------
 */

static const char *const methods[] = {
    "AUTO", "PCG", "AUGLAG", "AUGLAG, VARIANT=UZAWA", "PROXIMAL", "LAGRANGE"};
/* The first decks, the last method in two of them alone. */
enum { METHODS = sizeof methods / sizeof *methods, FIVE = 5, BOTH = 2 };

/* By the same deck, STIFFNESS=FACTOR; the forces of t to the tolerance. */
static void method_agrees(int of, const char *method, const dat *t) {
  double force = 0;
  JOB j = job_begin("method");
  PRINTED(card, "*SOLVER, METHOD=%s, STIFFNESS=FACTOR, TOL=1E-11\n", method);
  ck_assert_int_eq(job_run_with(&j, decks[of].deck, card, 0, decks[of].words),
                   0);
  DAT s = job_table(&j, "CONTACT", -1);
  ck_assert_int_eq(t->n_row, s.n_row);
  ck_assert_msg(apart(t, &s, "f_n", &force) <= 1e-9, "%s: f_n", method);
  const char *shear = dat_has(t, "f_t") ? "f_t" : "f_t1";
  ck_assert_msg(apart(t, &s, shear, &force) <= 1e-9, "%s: %s", method, shear);
}

TESTS(every_method_gives_the_forces_of_the_entries, FIVE) {
  JOB j = job_begin("dense");
  ck_assert_int_eq(job_run_with(&j, decks[_i].deck, DENSE, 0, decks[_i].words),
                   0);
  DAT t = job_table(&j, "CONTACT", -1);
  for (int k = 0; k < METHODS - (_i >= BOTH); ++k)
    method_agrees(_i, methods[k], &t);
}

/* No equilibrium: the words of NEWTON on the entries. */
TEST(every_method_finds_no_equilibrium) {
  char card[100];
  JOB a;
  const char *deck = "input/arch/arch", *thin = "-D H=0.1";
  ck_assert_int_eq(job_run_with(&a, deck, DENSE, 0, thin), 6);
  for (int k = 0; k < METHODS; ++k) {
    JOB b;
    snprintf(card, sizeof card, "*SOLVER, METHOD=%s, STIFFNESS=FACTOR\n",
             k == 0 ? "NEWTON" : methods[k]);
    ck_assert_int_eq(job_run_with(&b, deck, card, 0, thin), 6);
    ck_assert_msg(strcmp(a.errors, b.errors) == 0, "%s: %s", card, b.errors);
  }
}

/* "--check" prints both rows; the kind it marks as taken. */
static const char *taken(const job *j) {
  const char *dense = strstr(j->text, "stiffness DENSE");
  const char *factor = strstr(j->text, "stiffness FACTOR");
  ck_assert_ptr_nonnull(dense);
  ck_assert_ptr_nonnull(factor);
  const char *mark = strstr(dense, ": taken, ");
  ck_assert_ptr_nonnull(mark);
  ck_assert_ptr_null(strstr(mark + 1, ": taken, "));
  return mark < factor ? "DENSE" : "FACTOR";
}

static const char *choice(const char *cards, const char *words) {
  JOB j = job_begin("choice");
  const char *deck = "input/greco/greco";
  PRINTED(line, "--check %s", words);
  ck_assert_int_eq(job_run_with(&j, deck, cards, 0, line), 0);
  return taken(&j);
}

/* Few contact nodes: DENSE, unless the deck says otherwise. */
TEST(kind_is_chosen_by_cost) {
  ck_assert_str_eq(choice("", "-D N=64"), "DENSE");
  ck_assert_str_eq(choice("*SOLVER, STIFFNESS=FACTOR\n", "-D N=64"), "FACTOR");
  ck_assert_str_eq(choice("*SOLVER, METHOD=SOR\n", "-D N=64"), "DENSE");
  ck_assert_str_eq(choice("*SOLVER, CHECK=YES\n", "-D N=64"), "DENSE");
}

/* A strip of so many cells, all of whose lower side touches. */
static job strip(int cells, const char *solver) {
  job j = job_begin("strip");
  job_write(&j, "strip.geo",
            "// a row of cells\nPoint(1) = {0, 0, 0};\n"
            "b[] = Extrude {1, 0, 0} { Point{1}; Layers{%d}; };\n"
            "s[] = Extrude {0, 0.01, 0} { Line{b[1]}; Layers{3}; };\n"
            "Physical Curve(\"BOTTOM\") = {b[1]};\n"
            "Physical Curve(\"TOP\") = {s[0]};\n"
            "Physical Surface(\"BODY\") = {s[1]};\n",
            cells);
  job_write(&j, "strip.inp",
            "*MESH, FILE=strip.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=GAP\n\"1e-5*(1 - cos(40*x))\"\n"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n*STEP\n*STATIC\n"
            "*BOUNDARY\nTOP, 1, 1, 2e-5\nTOP, 2, 2, -5e-5\n"
            "*SOLVER, %s\n*PRINT, CONTACT\n*OUTPUT, HDF5=NO\n*END STEP\n",
            solver);
  return j;
}

/* One that is dearer, where the other does not fit. */
TEST(kind_is_chosen_by_memory) {
  static const char *const kinds[] = {"DENSE", "FACTOR"};
  for (int k = 0; k < 2; ++k) {
    JOB j = strip(60, k == 0 ? "STIFFNESS=AUTO" : "MAX_MEMORY=0.3");
    ck_assert_int_eq(job_run(&j, "--check"), 0);
    ck_assert_str_eq(taken(&j), kinds[k]);
    ck_assert((strstr(j.text, "needs more memory than there is") != NULL) ==
              (k == 1));
  }
}

/* FACTOR, and the forces of DENSE. */
TEST(contact_of_most_of_the_body_is_not_condensed) {
  static const char *const kinds[] = {"STIFFNESS=AUTO", "STIFFNESS=DENSE"};
  job j[2];
  for (int k = 0; k < 2; ++k) {
    j[k] = strip(300, kinds[k]);
    ck_assert_int_eq(job_run(&j[k], ""), 0);
    FREED char *listing = job_file(&j[k], "lst");
    ck_assert_ptr_nonnull(strstr(
        listing, k == 0 ? "FACTOR  it is expected" : "DENSE  STIFFNESS of"));
  }
  DAT a = job_table(&j[0], "CONTACT", 0), b = job_table(&j[1], "CONTACT", 0);
  double force = 0;
  ck_assert_int_eq(a.n_row, 301);
  ck_assert_double_le(apart(&a, &b, "f_n", &force), 1e-9);
  ck_assert_double_le(apart(&a, &b, "f_t", &force), 1e-9);
  for (int k = 0; k < 2; ++k) job_end(&j[k]);
}

/* Unknowns, entries and solves of the last iteration, and words of its row. */
static int last_system(const job *j, double system[3]) {
  char *text = job_file(j, "cvg"), *row = NULL;
  int words = 0;
  for (char *at = text; at != NULL; at = strchr(at + 1, '\n'))
    if (at[1] == ' ') row = at + 1;
  ck_assert_ptr_nonnull(row);
  *strchr(row, '\n') = '\0';
  for (char *word = strtok(row, " "); word != NULL; word = strtok(NULL, " ")) {
    if (words >= 9 && words < 12) system[words - 9] = atof(word);
    ++words;
  }
  free(text);
  return words;
}

TEST(iterations_tell_their_linear_systems) {
  double dense[3], factor[3], free_unknowns = 0;
  job a = job_begin("dense"), b = job_begin("factor");
  const char *deck = "input/greco/greco", *words = "-D N=16 -D MU=0.6";
  ck_assert_int_eq(job_run_with(&a, deck, DENSE, 0, words), 0);
  ck_assert_int_eq(last_system(&a, dense), 13);
  job_end(&a);
  a = job_begin("dense");
  words = "-D N=16 -D MU=0.6 --no-timing";
  ck_assert_int_eq(job_run_with(&a, deck, DENSE, 0, words), 0);
  ck_assert_int_eq(job_run_with(&b, deck, FACTOR, 0, words), 0);
  ck_assert_int_eq(last_system(&a, dense), 12);
  ck_assert_int_eq(last_system(&b, factor), 12);
  DAT t = job_table(&a, "CONTACT", -1);
  for (int i = 0; i < t.n_row; ++i) {
    const double is = dat_at(&t, i, "status");
    free_unknowns += is == 0 ? 2 : is == 1;
  }
  ck_assert_double_gt(free_unknowns, 0);
  ck_assert_double_eq(dense[0], free_unknowns);
  ck_assert_double_eq(dense[1], free_unknowns * free_unknowns);
  ck_assert_double_eq(dense[2], 1);
  ck_assert_double_eq(factor[0], job_told(&b, "unknowns"));
  ck_assert(factor[1] > 5 * factor[0] && factor[2] >= 1);
  job_end(&a);
  job_end(&b);
}

/* What --list solvers says of a method is what the check of a deck does. */
TEST(list_says_which_methods_take_factors) {
  static const char *const all[] = {"NEWTON", "LEMKE",  "SOR",      "PCG",
                                    "AUGLAG", "AITKEN", "LAGRANGE", "PROXIMAL"};
  JOB j = job_begin("list");
  ck_assert_int_eq(job_shell(&j, "protis --list solvers"), 0);
  for (size_t i = 0; i < sizeof all / sizeof *all; ++i) {
    PRINTED(name, "\n%s  (", all[i]);
    char *at = strstr(j.text, name), *end;
    ck_assert_ptr_nonnull(at);
    end = strstr(at, "\n\n");
    if (end != NULL) *end = '\0';
    const int told =
        strstr(at, "works with STIFFNESS=DENSE and FACTOR") != NULL;
    ck_assert_int_ne(told, strstr(at, "needs the entries") != NULL);
    if (end != NULL) *end = '\n';
    PRINTED(card, "*SOLVER, METHOD=%s, STIFFNESS=FACTOR\n", all[i]);
    JOB deck = job_begin("deck");
    ck_assert_int_eq(
        job_run_with(&deck, "input/greco/greco", card, 0, "--check -D N=4"),
        told ? 0 : 2);
  }
}

UNIT_MAIN("stiffness")
