/*
 * Inelastic laws: e = e^e + e^i, sigma = E (e - e^i) and
 *   d(e^i)/dt = Phi_1(sigma, e^i, alpha, t, T)
 *   d(alpha)/dt = Phi_2(sigma, alpha, t, T)      (CPR98 3.14-3.16).
 * One law per file, one row in LAW_LIST. Nothing here knows elements or time
 * steps: a law is evaluated at a point (P1: an element), and the integrators
 * see rates, their Jacobian and the fastest rate.
 *
 * Components and engineering shear strain as in material.h; sigma_zz and
 * e^i_zz are always carried (ns = 4 or 6). Every alpha starts from zero.
 */
#pragma once

#include "base/option.h"
#include "deck/deck.h"
#include "material/material.h"

/* Elasticity of a section, made once by law_elastic_set. */
typedef struct law_elastic {
  int ns;                      /* 4 in 2-D, 6 in 3-D */
  int isotropic, plane_stress; /* *ELASTIC, TYPE=ISO; plane stress: s_zz = 0 */
  double E[36];                /* [ns*ns] stress of e - e^i, Pa; in plane stress
                                  singular */
  double S[36];                /* [ns*ns] all components of e^e of a stress,
                                  1/Pa */
  double C[36];                /* [ns*ns] inv(S), Pa; = E but for plane
                                  stress */
  double young, shear;         /* 1/S_xx and C_xy,xy: the moduli if isotropic,
                                  Pa */
  kinematics kin;
  double temperature;         /* of what is above */
  const elastic_table *table; /* borrowed; NULL: the same at all
                                 temperatures */
} law_elastic;
/* C6: elastic_matrix(). No table. */
void law_elastic_set(const double C6[36], elastic_type type, kinematics kin,
                     law_elastic *out);
/* With the constants of a table at a temperature; if they depend on it, it is
 * kept (borrowed). ERR_DECK: they are no elasticity there. */
status law_elastic_read(const elastic_table *table, double temperature,
                        kinematics kin, law_elastic *out);

struct law_ops;

/* Time-temperature shift of a law: its rates are multiplied by 1/a. */
typedef enum { SHIFT_NONE, SHIFT_WLF, SHIFT_ARRHENIUS } shift_kind;
#define SHIFT_WORDS "NONE|WLF|ARRHENIUS"
typedef struct law_shift {
  int kind;          /* shift_kind */
  double reference;  /* temperature at which a = 1 */
  double zero;       /* absolute zero on the scale of the deck */
  double c1, c2;     /* WLF: log10 a = -c1 (T - ref)/(c2 + T - ref); -, temp. */
  double activation; /* ARRHENIUS: log a = Q/R (1/(T-zero) - 1/(ref-zero)), Q/R
                        as a temperature */
} law_shift;

/* A law with its data, as a *MATERIAL has it. */
typedef struct law_card {
  const struct law_ops *ops;
  const void *param;         /* [ops->param_size] its words, owned */
  int n_term;                /* lines of ops->terms, as the terms of a Prony
                                series */
  int n_set;                 /* temperatures of the table, 1 if it has none */
  double *temperature;       /* [n_set] ascending, owned */
  quantity *value;           /* [n_set * law_n_value()] fields, then terms,
                                owned */
  const expression *formula; /* rate of the law USER, borrowed; else NULL */
  law_shift shift;
  place at;             /* of the card */
  const char *material; /* its name, borrowed; NULL: none */
} law_card;
/* For messages: file, line, material. */
#define LAW_FORM "%s:%d: material %s: "
#define LAW_ARGS(law)                                              \
  (law)->at.file != NULL ? (law)->at.file : "", (law)->at.line_no, \
      (law)->material != NULL ? (law)->material : ""

/* Where a law is evaluated. */
typedef struct law_point {
  const law_card *law;
  const law_elastic *elastic;
  const double *value; /* [law_n_value()] from law_values() at t and T */
  double speed;        /* from law_speed(): 1/a, - */
  double t, dt;        /* s; dt: step being made, 0 if there is none */
  double temperature;
  const double *sigma; /* [ns] Pa */
  const double *ei;    /* [ns] - */
  const double *alpha; /* [law_n_alpha()] each with the unit of its law */
} law_point;

/* Derivatives of the rates, column major, 1/s over the unit of the variable. */
typedef struct law_jacobian {
  double *ei_sigma;    /* [ns * ns] */
  double *ei_ei;       /* [ns * ns] zero unless the row says "uses_ei" */
  double *ei_alpha;    /* [ns * n_alpha] */
  double *alpha_sigma; /* [n_alpha * ns] */
  double *alpha_alpha; /* [n_alpha * n_alpha] */
} law_jacobian;

/* Springs and dashpots in series: law_ops.series. */
enum { LAW_WHOLE, LAW_DEVIATOR, LAW_MEAN, LAW_NO_PART };
typedef struct law_unit {
  double flow;   /* 1/s: modulus of *ELASTIC over the viscosity; 0: rests */
  double spring; /* the modulus parallel to the dashpot over that of *ELASTIC */
} law_unit;

/*
 * A row. Functions get a point whose values are in range, ignore its speed,
 * write into arrays of zeros and allocate nothing.
 */
typedef struct law_ops {
  /* as in LAW=, source, one line */
  const char *name, *reference, *help;
  size_t param_size;
  const option *options; /* words on the card, or NULL */
  const option *fields;  /* first data line, all OPT_REAL of a struct of doubles
                            in the order of the line; or NULL */
  const option *terms;   /* each further line, the same, one or more where
                            there are no fields; or NULL */
  int linear;            /* rates linear in (sigma, e^i, alpha): one Jacobian
                            for all points with the same values; 0: of the
                            deviator of sigma, without volume */
  int uses_ei;           /* e^i itself enters its rate */
  /* 1: the temperature itself enters the rates of this card; NULL: none do.
   * T_ZERO= of the card is then known to the law. */
  int (*is_warm)(const law_card *law);
  int needs_formula;   /* one data line with a formula of law_formula_names */
  const char *example; /* data lines for moduli of 1e5, stresses of 100, times
                          of 1: shown in the help, used by the tests */
  /* NULL: none */
  int (*n_alpha)(const law_card *law, int ns);
  void (*rate)(const law_point *p, double *ei_rate, double *alpha_rate);
  void (*jacobian)(const law_point *p, law_jacobian *j);
  /* Largest magnitude of the eigenvalues of d(e^i, alpha)/dt under held strain
   * with isotropic elasticity, not plane stress, 1/s; NULL, or an answer < 0:
   * of the whole matrix, by LAPACK. */
  double (*fastest_rate)(const law_point *p);
  /* Terms v_k, alpha = v_1, v_2, ..., that follow the strain each by itself:
   * e^i = w + sum_k W_k v_k, d(v_k)/dt = rate_k (e - w - v_k); rate of term k,
   * 1/s, and its W[ns*ns]. NULL: other laws. */
  double (*relaxing)(const law_point *p, int k, double *W);
  /* R[ns*ns] of the strain e^i = R sigma that it ends with under a held stress,
   * 1/Pa; the longest time it may take as exp(-t/time), s, < 0: it never ends
   * (R is not set). NULL: other laws. */
  double (*relaxed)(const law_point *p, double *R);
  /* Parts of the strain, each a series of units with strains v_k, e^i = v_0 +
   * v_1 + ..., alpha = v_1, v_2, ...: d(v_k)/dt = flow_k (e - e^i - spring_k
   * v_k); which part number "part" is (LAW_WHOLE, or LAW_DEVIATOR and LAW_MEAN
   * in any order) and its unit k, or LAW_NO_PART. NULL: other laws. */
  int (*series)(const law_point *p, int part, int k, law_unit *unit);
  /* Adds the strains of the units in alpha, whose sum e^i is, to sum[ns]: 1 if
   * its rest is that of a dashpot, 0: none. "only", alpha again or NULL: gets
   * e^i first if there is but one unit, no dashpot. NULL: no such strains. */
  int (*units)(const law_point *p, double *only, double *sum);
  /* 0 if every rate is exactly zero at the point; NULL: the law always flows */
  int (*flows)(const law_point *p);
  /* Power lost, >= 0, W/m3; energy stored by alpha and e^i, J/m3 (NULL: none):
   * sigma . d(e^i)/dt = dissipation + d(stored)/dt. */
  double (*dissipation)(const law_point *p);
  double (*stored)(const law_point *p);
  /* Text on what is wrong with values that are each in range, or with the
   * elasticity they are used with; or NULL. */
  const char *(*check)(const law_card *law, elastic_type type,
                       const double *value, char *text, size_t size);
} law_ops;

/* clang-format off */
#define LAW_LIST(X) \
  X(maxwell) X(zener) X(kelvin) X(burgers) X(prony) X(norton) \
  X(hyperbolic) X(perzyna) X(bingham) X(chaboche) X(user)
/* clang-format on */
/* Variables of a formula: equivalent stress, creep strain, temperature, time */
extern const char *const law_formula_names[4];
#define LAW_EXTERN(name) extern const law_ops name##_law;
LAW_LIST(LAW_EXTERN)
extern const law_ops *const law_list[];    /* NULL at the end */
const law_ops *law_find(const char *name); /* case ignored; or NULL */

/* Values: coefficient.c. */
/* The data lines of a card into a law whose ops are set: per temperature the
 * line of the fields, if the row has any, then a line for each term; a last
 * number on every line is the temperature, ascending. Errors go to the log
 * (and leave n_set = 0); ERR_MEMORY. */
status law_card_read(deck *d, const card *c, message_log *log, law_card *law);
/* Values at t = 0 against each other and the elasticity: errors to the log;
 * ERR_MEMORY. */
status law_card_check(const law_card *law, elastic_type type, message_log *log);
/* What a data line holds: "A, n [, m] [, temperature]"; returns text. */
const char *law_line_text(const option *table, char *text, size_t size);
int law_n_field(const option *table); /* rows of fields or terms; NULL: 0 */
int law_n_value(const law_card *law);
/* Coefficients at a time and temperature, value[law_n_value()]: ERR_DECK with
 * the field, the time and the temperature if one is out of its range. */
status law_values(const law_card *law, double t, double temperature,
                  double *value);
/* 1/a of the shift; infinite or 0 only if the deck requires it. */
double law_speed(const law_card *law, double temperature);
/* What is wrong with a temperature for a law whose rates depend on the absolute
 * one: it is not above T_ZERO of the card; NULL: nothing. */
const char *law_too_cold(const law_card *law, double temperature);
enum { LAW_VARIES_TIME = 1, LAW_VARIES_TEMPERATURE = 2 };
/* What the values and the speed depend on: bits; 0: the same for ever. */
unsigned law_varies(const law_card *law);

/* Evaluation with the speed; results are overwritten. */
int law_n_alpha(const law_card *law, int ns);
void law_rate(const law_point *p, double *ei_rate, double *alpha_rate);
void law_jacobian_at(const law_point *p, law_jacobian *j);
int law_flows(const law_point *p);
double law_dissipation(const law_point *p);
double law_stored(const law_point *p); /* 0 if the law has none */
/* The largest magnitude of an eigenvalue of the rates of (e^i, alpha) with
 * sigma = E (e - e^i) under held e, 1/s: an explicit Euler or Heun step decays
 * if dt < 2/rate (exact for MAXWELL, whatever the mesh). ERR_MEMORY,
 * ERR_SINGULAR if the Jacobian is not a number. */
status law_fastest_rate(const law_point *p, double *rate);

/* For the laws: Voigt vectors of ns components. */
double tensor_trace(const double *v);
void tensor_deviator(int ns, const double *v, double *d);
double tensor_mises(int ns, const double *s); /* of a deviator, >= 0 */
void tensor_product(int ns, const double *A, const double *x, double *y);
/* Strain 3/2 s/q of a deviator s with q = tensor_mises > 0: the direction of
 * flow, its shears doubled. */
void tensor_direction(int ns, const double *s, double q, double *n);
/* Equivalent stress q of a stress and the direction of its flow, zero if q is:
 * returns q. */
double tensor_flow(int ns, const double *sigma, double *n);
/* J += a (3/2 P - n n') + b n n', P: deviator to strain (shears doubled). */
void tensor_add_flow(int ns, const double *n, double a, double b, double *J,
                     int ld);
/* Q += a (P' S P): the part of the compliance that sees deviators only if
 * "deviatoric", or its complement Q += a (V' S V) for the mean stress. */
void tensor_add_part(int ns, const double *S, int deviatoric, double a,
                     double *Q);
