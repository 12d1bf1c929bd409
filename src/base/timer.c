/* CPU seconds and bytes by stage, with a small stack of open stages. */
#include "base/timer.h"

#include "base/memory.h"

#include <assert.h>
#include <sys/resource.h>
#include <time.h>

enum { DEPTH = 16 };

#define STAGE_TEXT(name, text) text,
static const char *name_of[STAGE_COUNT] = {STAGE_LIST(STAGE_TEXT)};
static stage_cost cost[STAGE_COUNT];
static stage open_stage[DEPTH];
static int depth;
static int whole; /* depth of the stage that all others are part of; 0: none */
static int inner; /* stages entered inside it */
static double last_cpu;
static double child_cpu; /* of ended children */
static size_t last_bytes;

double timer_cpu(void) {
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return child_cpu + (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void timer_child_ended(void) {
  struct rusage child = {0};
  getrusage(RUSAGE_CHILDREN, &child);
  child_cpu = (double)(child.ru_utime.tv_sec + child.ru_stime.tv_sec) +
              1e-6 * (double)(child.ru_utime.tv_usec + child.ru_stime.tv_usec);
}

/* Charge what was spent since the last change to the innermost stage. */
static void charge(void) {
  double cpu = timer_cpu();
  size_t bytes = memory_allocated();
  if (depth > 0) {
    stage_cost *c = &cost[open_stage[depth - 1]];
    c->cpu += cpu - last_cpu;
    c->bytes += bytes - last_bytes;
  }
  last_cpu = cpu;
  last_bytes = bytes;
}

void timer_enter_as(stage s, unsigned how) {
  if (whole > 0) {
    ++inner;
    return;
  }
  assert(depth < DEPTH);
  charge();
  open_stage[depth++] = s;
  cost[s].calls += (how & STAGE_NO_CALL) == 0;
  if (how & STAGE_WHOLE) whole = depth;
}

void timer_enter(stage s) { timer_enter_as(s, 0); }

void timer_leave(stage s) {
  if (inner > 0) {
    --inner;
    return;
  }
  whole = 0;
  assert(depth > 0 && open_stage[depth - 1] == s);
  charge();
  --depth;
}

stage timer_begin(stage s) {
  if (s != STAGE_NONE) timer_enter(s);
  return s;
}

void timer_end(const stage *s) {
  if (*s != STAGE_NONE) timer_leave(*s);
}

stage_cost timer_cost(stage s) {
  if (depth > 0 && open_stage[depth - 1] == s) charge();
  return cost[s];
}

const char *timer_name(stage s) { return name_of[s]; }

stage timer_own_stage(int k, const char *name) {
  assert(k >= 0 && STAGE_LISTED + k < STAGE_COUNT);
  name_of[STAGE_LISTED + k] = name;
  return (stage)(STAGE_LISTED + k);
}

void timer_reset(void) {
  memset(cost, 0, sizeof cost);
  depth = whole = inner = 0;
}

void timer_resume(const stage_cost before[STAGE_COUNT]) {
  charge();
  for (int i = 0; i < STAGE_COUNT; ++i) {
    cost[i].calls = before[i].calls;
    cost[i].cpu += before[i].cpu;
    cost[i].bytes += before[i].bytes;
  }
}
