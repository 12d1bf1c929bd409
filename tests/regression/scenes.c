/*
 * The quick ones of the hard scenes (tests/scenes): no run fails.
 */
#include "scenes/scenes.h"
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

TEST(no_quick_scene_fails) { ck_assert_int_eq(scenes_run(1, stdout), 0); }

UNIT_MAIN("scenes")
