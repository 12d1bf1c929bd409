/*
 * Linked into builds that count branches (make coverage): what a process that
 * leaves by _exit has counted is written too.
 */
#include "leave.h"

void __wrap__exit(int code) {
  __gcov_dump();
  __real__exit(code);
}
