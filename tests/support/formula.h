/*
 * Quantities of expressions, without a deck.
 */
#pragma once

#include "deck/expression.h"

/* q = the expression; check fails if it is none. */
void formula_compile(quantity *q, const char *text);
void formula_release(quantity *q);
