/*
 * All hard scenes with every method; prints the matrix. Fails if one fails.
 */
#include "scenes/scenes.h"
#include "support/unit.h"

START_TEST(no_scene_fails) { ck_assert_int_eq(scenes_run(0, stdout), 0); }
END_TEST

UNIT_LOOP("scenes", no_scene_fails, 1)
