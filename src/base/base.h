/*
 * What nearly every source file uses: status, memory, numbers, text, timers,
 * vectors, and of the C library what goes with them.
 */
#pragma once

#include "base/memory.h"
#include "base/number.h"
#include "base/text.h"
#include "base/timer.h"
#include "base/vector.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
