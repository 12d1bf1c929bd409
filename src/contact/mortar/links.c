#include "contact/mortar/links.h"

#include "base/memory.h"

void links_release(node_links *l) {
  RELEASE(l->start, l->master, l->part);
  *l = (node_links){0};
}
