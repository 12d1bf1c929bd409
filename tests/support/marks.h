/*
 * check writes down each place where an assertion has held, for the report of a
 * crash: more time than the assertion takes, in loops over tables. Here a place
 * is written down when it is another than lately.
 */
#pragma once

void __real__mark_point(const char *file, int line); /* that of check       */
/* What the linker calls in its place (marks of the Makefile). */
void __wrap__mark_point(const char *file, int line);
