/* What the file of an effect uses: the run, the plan, the facts of a model. */
#pragma once

#include "base/base.h"
#include "effects/plan/plan.h"
#include "effects/rows.h"
#include "model/facts.h"
#include "run/run.h"
