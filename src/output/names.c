/*
 * The files that a run writes or removes, by their names; none of them may be
 * one that the deck reads.
 */
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "output/writers.h"

#include <dirent.h>
#include <errno.h>
#include <string.h>

/* JOB.stop is removed only if it was made during the run. */
static const char *const results[] = {
    "lst",           "sta",          "cvg",
    "dat",           "h5",           "h5.tmp",
    "xdmf",          "xdmf.tmp",     "json",
    "json.tmp",      "rst.h5",       "lock",
    "rst.h5.tmp",    "rst.old.h5",   "body.xdmf",
    "body.xdmf.tmp", "contact.xdmf", "contact.xdmf.tmp",
    "rst.inc"};

static const char middle[] = "_condensed_";

static status spare(const deck *d, const char *path) {
  for (int i = 0; i < d->n_input; ++i) {
    int same = file_same(d->inputs[i], path);
    if (same < 0) PASS(text_failed(path, "inspect", errno));
    if (same)
      RAISE(
          ERR_DECK,
          "%s is the file %s that the deck reads: the results would overwrite "
          "it; name the deck or the file otherwise, or use -o",
          path, d->inputs[i]);
  }
  return OK;
}

static int is_condensed(const char *name, const char *of) {
  size_t n = strlen(of), k = sizeof middle - 1;
  return strncmp(name, of, n) == 0 && strncmp(name + n, middle, k) == 0;
}

static status spare_condensed(const model *m, const char *dir) {
  status st = OK;
  char *path = NULL;
  DIR *folder = opendir(dir);
  if (folder == NULL && (errno == ENOENT || errno == ENOTDIR)) return OK;
  if (folder == NULL) TRY(text_failed(dir, "read", errno));
  for (struct dirent *e; (e = readdir(folder)) != NULL;) {
    if (!is_condensed(e->d_name, m->name.job)) continue;
    memory_free(path);
    NEW(path, strlen(dir) + strlen(e->d_name) + 2);
    sprintf(path, "%s/%s", dir, e->d_name);
    TRY(spare(m->deck, path));
  }
done:
  if (folder != NULL) closedir(folder);
  memory_free(path);
  return st;
}

status output_spare_inputs(const model *m, const char *dir) {
  OWNED char *path = NULL;
  if (m->deck == NULL) return OK;
  for (size_t k = 0; k < sizeof results / sizeof *results; ++k) {
    memory_free(path);
    path = text_path(dir, m->name.job, results[k]);
    if (path == NULL) RAISE(ERR_MEMORY, "memory exhausted: name of a file");
    PASS(spare(m->deck, path));
  }
  return spare_condensed(m, dir);
}
