/*
 * What the estimate of a goal is worth: its band and its verdict (goal.h).
 */
#include "accuracy/goal/goal.h"

/* HOOP, measured on a tube, is for what the elements of it next to the border
 * lack. Measured on plane scenes with known goals: the estimate is within a
 * factor of 2 in 91 % of all cases below TRUSTED, and the true value in the
 * band in 91 to 95 % whatever the share. */
static const double TRUSTED = 0.03; /* -, share of contact ends, of few nodes */
/* What the estimate lacks by infinite stresses was up to 3.4 of their share, by
 * a zone of one to three nodes up to 2.6 of all of it. */
static const double SHARP = 4.0;     /* -, band by it */
static const double LEFT = 0.05;     /* -, of the sum of magnitudes */
static const double BAND = 0.1;      /* -, the same */
static const double HOOP = 0.2;      /* -, the same by the hoop strains */
static const double ROUNDING = 1e-9; /* -, the same: elements without error */
static const double HISTORY = 0.25;  /* -, of what the increments before add */
/* Measured round holes of 4 to 80 edges: of what the estimate lacks recovered
 * stresses of both have half or more; where what they have cancels, the sum of
 * its magnitudes. */
static const double TWICE = 2.0; /* -, band by it */

static const struct {
  const char *word, *text;
} verdicts[] = {
    [GOAL_RELIABLE] = {"reliable", "reliable"},
    [GOAL_CONTACT_END] = {"contact_end", "not reliable: contact end"},
    [GOAL_SUPPORT_END] =
        {"support_end", "not reliable: end of a support or load, inner corner"},
    [GOAL_NO_SLIP] = {"no_slip", "not reliable: no node slips"},
    [GOAL_FEW_NODES] = {"few_nodes", "not reliable: few contact nodes"},
    [GOAL_FEW_ELEMENTS] = {"few_elements",
                           "not reliable: few elements round a tip or hole"},
    [GOAL_COARSE] = {"coarse_mesh", "not reliable: few nodes inside the body"},
    [GOAL_LOCKED] = {"locked", "not reliable: elements lock near nu = 1/2"},
    [GOAL_FRONT] = {"crack_front", "not reliable: front of a crack in space"},
    [GOAL_CANCELS] = {"cancels", "not reliable: errors cancel"},
    [GOAL_NO_HISTORY] = {"no_history",
                         "without history: errors of earlier "
                         "increments are not in it"},
    [GOAL_NOT_COVERED] = {"not_covered", "no estimate: not covered"},
    [GOAL_NO_PEAK] = {"no_peak",
                      "none: the largest pressure is at an edge, "
                      "where it may be infinite"},
    [GOAL_NO_END] = {"no_end",
                     "none: the contact reaches the end of its "
                     "surface"},
    [GOAL_NO_ZONE] = {"no_zone", "none: too few closed nodes"},
    [GOAL_NO_FACTOR] = {"no_factor",
                        "none: no space for an integral at the front"}};

const char *goal_verdict_word(goal_verdict v) { return verdicts[v].word; }
const char *goal_verdict_text(goal_verdict v) { return verdicts[v].text; }

void goal_estimate_add(const goal_estimate *e, goal_estimate *sum) {
  const double *of = (const double *)e;
  double *to = (double *)sum;
  for (size_t k = 0; k < sizeof *e / sizeof *of; ++k) to[k] += of[k];
}

/* Share of a part of the products, beyond rounding; errors of the gap alone
 * have none but that. */
static double share_of(const goal_estimate *e, double part) {
  return e->product > ROUNDING * e->magnitude
             ? part / fmax(e->product, fabs(e->error))
             : 0.0;
}

goal_result goal_evaluate(const goal_estimate *e) {
  const double hollow = fmax(TWICE * fabs(e->twice), e->hollow);
  goal_result r = {.error = e->error,
                   .band = BAND * e->magnitude + e->ends +
                           (SHARP - 1.0) * (e->sharp + e->few) +
                           HISTORY * e->history + HOOP * fabs(e->hoop) + hollow,
                   .ends = share_of(e, e->ends)};
  if (e->few > TRUSTED * fabs(e->error))
    r.verdict = GOAL_FEW_NODES;
  else if (r.ends >= TRUSTED)
    r.verdict =
        2.0 * e->supports > e->ends ? GOAL_SUPPORT_END : GOAL_CONTACT_END;
  else if (share_of(e, e->ends + e->near) >= TRUSTED)
    r.verdict = GOAL_SUPPORT_END;
  else if (fabs(e->error) < fmax(LEFT * e->magnitude, HOOP * fabs(e->hoop)))
    r.verdict = GOAL_CANCELS;
  else if (hollow > fabs(e->error))
    r.verdict = GOAL_FEW_ELEMENTS;
  return r;
}
