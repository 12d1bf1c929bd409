/*
 * All hard scenes with every method; prints the matrix. Fails if one fails.
 */
#include "scenes/scenes.h"
#include "support/unit.h"

TESTS(no_scene_fails, 1) { ck_assert_int_eq(scenes_run(0, stdout), 0); }

UNIT_MAIN_FOR("scenes", 10 * UNIT_SECONDS)
