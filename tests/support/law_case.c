#include "support/law_case.h"

#include "base/memory.h"
#include "base/number.h"

#include <check.h>
#include <stdio.h>
#include <string.h>

/* Number of words of a choice. */
static int n_word(const option *o) {
  int n = 1;
  for (const char *p = o->choices; *p != '\0'; ++p) n += *p == '|';
  return n;
}

/* Set the choices from their common number; 0 if it is too large. */
static int set_words(const law_ops *ops, int words, void *param) {
  for (const option *o = ops->options; o != NULL && o->name != NULL; ++o) {
    if (o->type != OPT_CHOICE) continue;
    int first;
    memcpy(&first, (char *)param + o->offset, sizeof first);
    const int rank = (first + words) % n_word(o);
    memcpy((char *)param + o->offset, &rank, sizeof rank);
    words /= n_word(o);
  }
  return words == 0;
}

/* Numbers of one line; the rows it leaves out get their initial value. */
static void read_line(const option *table, const char *line, size_t length,
                      quantity *value) {
  char text[400], *rest = text;
  ck_assert_uint_lt(length, sizeof text);
  memcpy(text, line, length);
  text[length] = '\0';
  for (int i = 0; table[i].name != NULL; ++i) {
    const char *word = strsep(&rest, ",");
    if (word == NULL) word = table[i].initial;
    ck_assert_msg(word != NULL, "no value for %s", table[i].name);
    if (strcmp(word, OPTION_ABSENT) == 0) continue;
    ck_assert_msg(number_real(word, &value[i].number) == NULL, "%s", word);
  }
  ck_assert_msg(rest == NULL, "too many numbers: %s", line);
}

/* The text between the quotes. */
static void read_formula(law_card *law, const char *data, expression **own) {
  char text[400];
  int column;
  const size_t length = strlen(data);
  ck_assert(length > 2 && length < sizeof text);
  memcpy(text, data + 1, length - 2);
  text[length - 2] = '\0';
  ck_assert_int_eq(
      expression_compile_in(text, law_formula_names, NULL, NULL, own, &column),
      OK);
  law->formula = *own;
  law->n_set = 1;
  law->temperature = memory_new(1, sizeof(double));
}

static void read_data(law_card *law, const char *data) {
  const law_ops *ops = law->ops;
  int n_line = 1, n_field = law_n_field(ops->fields);
  for (const char *p = data; *p != '\0'; ++p) n_line += *p == '\n';
  law->n_term = n_line - (ops->fields != NULL);
  law->n_set = 1;
  law->temperature = memory_new(1, sizeof(double));
  law->value = memory_new((size_t)law_n_value(law), sizeof(quantity));
  for (int i = 0; i < n_line; ++i) {
    const size_t length = strcspn(data, "\n");
    const int is_term = i > 0 || ops->fields == NULL;
    const int term = i - (ops->fields != NULL);
    read_line(
        is_term ? ops->terms : ops->fields, data, length,
        law->value + (is_term ? n_field + term * law_n_field(ops->terms) : 0));
    data += length + 1;
  }
}

int law_case_new(const law_ops *ops, int words, const char *data, double young,
                 double nu, kinematics kin, law_case *c) {
  double C6[36];
  char text[200];
  memset(c, 0, sizeof *c);
  c->card.ops = ops;
  if (ops->param_size > 0) {
    void *param = memory_new(1, ops->param_size);
    option_defaults(ops->options, param);
    c->card.param = param;
    if (!set_words(ops, words, param)) {
      law_case_free(c);
      return 0;
    }
  } else if (words > 0) {
    return 0;
  }
  if (data == NULL) data = ops->example;
  if (ops->needs_formula)
    read_formula(&c->card, data, &c->formula);
  else
    read_data(&c->card, data);
  ck_assert_ptr_null(elastic_matrix(ELASTIC_ISO, 2, (double[]){young, nu}, C6,
                                    text, sizeof text));
  law_elastic_set(C6, ELASTIC_ISO, kin, &c->elastic);
  c->dt = 0.1;
  c->ns = c->elastic.ns;
  c->n_alpha = law_n_alpha(&c->card, c->ns);
  ck_assert_int_le(c->n_alpha, LAW_ALPHA_MAX);
  ck_assert_int_le(law_n_value(&c->card), LAW_VALUE_MAX);
  return 1;
}

void law_case_free(law_case *c) {
  RELEASE((void *)c->card.param, c->card.temperature, c->card.value,
          c->formula);
  c->card = (law_card){0};
  c->formula = NULL;
}

law_point law_case_point(law_case *c) {
  ck_assert_int_eq(law_values(&c->card, c->t, c->temperature, c->value), OK);
  return (law_point){.law = &c->card,
                     .elastic = &c->elastic,
                     .value = c->value,
                     .speed = law_speed(&c->card, c->temperature),
                     .t = c->t,
                     .dt = c->dt,
                     .temperature = c->temperature,
                     .sigma = c->sigma,
                     .ei = c->ei,
                     .alpha = c->alpha};
}

/* A x = b with A symmetric positive definite, n <= 6; b becomes x. */
static void solve(int n, double *A, double *b) {
  for (int k = 0; k < n; ++k)
    for (int i = k + 1; i < n; ++i) {
      const double factor = A[i + n * k] / A[k + n * k];
      for (int j = k; j < n; ++j) A[i + n * j] -= factor * A[k + n * j];
      b[i] -= factor * b[k];
    }
  for (int k = n - 1; k >= 0; --k) {
    for (int j = k + 1; j < n; ++j) b[k] -= A[k + n * j] * b[j];
    b[k] /= A[k + n * k];
  }
}

/* Stresses of the held components and strains of the others, with
 * S sigma = e - e^i. */
static void balance(law_case *c, const int *held) {
  int at[6], n = 0;
  double A[36], b[6];
  const double *S = c->elastic.S;
  for (int i = 0; i < c->ns; ++i)
    if (held[i]) at[n++] = i;
  for (int i = 0; i < n; ++i) {
    b[i] = c->e[at[i]] - c->ei[at[i]];
    for (int j = 0; j < n; ++j) A[i + n * j] = S[at[i] + c->ns * at[j]];
    for (int j = 0; j < c->ns; ++j)
      if (!held[j]) b[i] -= S[at[i] + c->ns * j] * c->sigma[j];
  }
  solve(n, A, b);
  for (int i = 0; i < n; ++i) c->sigma[at[i]] = b[i];
  for (int i = 0; i < c->ns; ++i) {
    if (held[i]) continue;
    c->e[i] = c->ei[i];
    for (int j = 0; j < c->ns; ++j) c->e[i] += S[i + c->ns * j] * c->sigma[j];
  }
}

static void drive(law_case *c, const law_case *from, const law_drive *d,
                  double time) {
  for (int i = 0; i < c->ns; ++i) {
    if (d->held[i])
      c->e[i] = from->e[i] + time * d->e_rate[i];
    else
      c->sigma[i] = from->sigma[i] + time * d->sigma_rate[i];
  }
  balance(c, d->held);
}

void law_case_jump(law_case *c, const law_drive *d) { drive(c, c, d, 1); }

typedef struct slopes {
  double ei[6], alpha[LAW_ALPHA_MAX];
} slopes;

/* State "from" moved by h along the slopes; its slopes into k. */
static void stage(law_case *c, const law_case *from, const law_drive *d,
                  double h, const slopes *along, slopes *k) {
  for (int i = 0; i < c->ns; ++i) c->ei[i] = from->ei[i] + h * along->ei[i];
  for (int i = 0; i < c->n_alpha; ++i)
    c->alpha[i] = from->alpha[i] + h * along->alpha[i];
  c->t = from->t + h;
  drive(c, from, d, h);
  if (k == NULL) return;
  law_point p = law_case_point(c);
  law_rate(&p, k->ei, k->alpha);
}

void law_case_run(law_case *c, const law_drive *d, double time, int n) {
  static slopes k[4], mean;
  static law_case from;
  const double h = time / n;
  c->dt = h;
  for (int step = 0; step < n; ++step) {
    memset(&mean, 0, sizeof mean);
    from = *c;
    stage(c, &from, d, 0, &mean, &k[0]);
    stage(c, &from, d, h / 2, &k[0], &k[1]);
    stage(c, &from, d, h / 2, &k[1], &k[2]);
    stage(c, &from, d, h, &k[2], &k[3]);
    for (int i = 0; i < c->ns; ++i)
      mean.ei[i] =
          (k[0].ei[i] + 2 * k[1].ei[i] + 2 * k[2].ei[i] + k[3].ei[i]) / 6;
    for (int i = 0; i < c->n_alpha; ++i)
      mean.alpha[i] = (k[0].alpha[i] + 2 * k[1].alpha[i] + 2 * k[2].alpha[i] +
                       k[3].alpha[i]) /
                      6;
    stage(c, &from, d, h, &mean, NULL);
  }
}
