/* src/base/system/input.c: what is opened, and what is not. */
#include "base/system/input.h"

#include "support/folder.h"
#include "support/unit.h"

#include <sys/stat.h>
#include <unistd.h>

/* Above: secret; deck: plain, sub/plain, links and a FIFO. */
static char above[64], home[128];

static void put(const char *name) {
  PRINTED(path, "%s/%s", above, name);
  FILE *f = fopen(path, "w");
  ck_assert_ptr_nonnull(f);
  fputs(name, f);
  fclose(f);
}

static void begin(void) {
  folder_new(above);
  snprintf(home, sizeof home, "%s/deck", above);
  ck_assert_int_eq(mkdir(home, 0777), 0);
  put("secret");
  put("deck/plain");
  ck_assert_int_eq(chdir(home), 0);
  ck_assert_int_eq(mkdir("sub", 0777), 0);
  put("deck/sub/plain");
  ck_assert_int_eq(symlink("../secret", "link"), 0);
  ck_assert_int_eq(symlink("plain", "own_link"), 0);
  ck_assert_int_eq(symlink("..", "up"), 0);
  ck_assert_int_eq(symlink("sub", "down"), 0);
  ck_assert_int_eq(mkfifo("fifo", 0666), 0);
}

static void end(void) {
  ck_assert_int_eq(input_confine(NULL), OK);
  ck_assert_int_eq(chdir("/"), 0);
  folder_remove(above);
}

/* NULL if it opens, else why not. */
static const char *refusal(const char *path) {
  const char *why = NULL;
  FILE *f = input_stream(path, &why);
  if (f == NULL) return why != NULL ? why : "";
  fclose(f);
  return NULL;
}

TEST(only_plain_files_are_opened) {
  begin();
  static const char *const good[] = {"plain", "sub/plain", "link", "up/secret"};
  for (int i = 0; i < 4; ++i) ck_assert_ptr_null(refusal(good[i]));
  ck_assert_str_eq(refusal("fifo"), "it is no plain file");
  ck_assert_str_eq(refusal("/dev/zero"), "it is no plain file");
  ck_assert_str_eq(refusal("sub"), "it is a folder");
  ck_assert_ptr_nonnull(strstr(refusal("nothing"), "No such file"));
  end();
}

/* The folder as ".", in full, and as it is seen from above. */
TEST(safe_stays_below_the_folder) {
  static const char *const good[] = {"plain", "./plain", "sub/plain",
                                     "sub/../plain", "sub/./plain"};
  static const char *const bad[] = {"link",
                                    "own_link",
                                    "up/secret",
                                    "up/deck/plain",
                                    "../secret",
                                    "down/plain",
                                    "fifo",
                                    "sub",
                                    "../deck/plain",
                                    "nothing",
                                    "sub/../../s",
                                    "sub/../up",
                                    "..",
                                    "",
                                    "/dev/zero",
                                    "/etc/passwd",
                                    "plain/more",
                                    "/dev/stdin",
                                    "/proc/self/environ"};
  begin();
  for (int k = 0; k < 3; ++k) {
    char path[300];
    const char *name = k == 0 ? "." : k == 1 ? home : "deck";
    if (k == 2) ck_assert_int_eq(chdir(".."), 0);
    ck_assert_int_eq(input_confine(name), OK);
    for (size_t i = 0; i < sizeof good / sizeof *good; ++i) {
      snprintf(path, sizeof path, "%s/%s", name, good[i]);
      ck_assert_msg(refusal(path) == NULL, "%s: %s", path, refusal(path));
      if (k == 0) ck_assert_ptr_null(refusal(good[i]));
    }
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
      snprintf(path, sizeof path, "%s%s%s", name, bad[i][0] == '/' ? "" : "/",
               bad[i]);
      ck_assert_msg(refusal(path) != NULL, "%s", path);
      ck_assert_msg(refusal(bad[i]) != NULL, "%s", bad[i]);
    }
  }
  ck_assert_int_eq(input_confine("nothing"), ERR_FILE);
  end();
}

/* The folder is the one it was: its name may come to mean another. */
TEST(folder_is_held_open) {
  begin();
  ck_assert_int_eq(input_confine(home), OK);
  ck_assert_int_eq(chdir(above), 0);
  ck_assert_int_eq(rename("deck", "old"), 0);
  ck_assert_int_eq(symlink(".", "deck"), 0);
  char path[300];
  snprintf(path, sizeof path, "%s/secret", home);
  ck_assert_ptr_nonnull(refusal(path));
  snprintf(path, sizeof path, "%s/plain", home);
  ck_assert_ptr_null(refusal(path));
  end();
}

UNIT_MAIN("input")
