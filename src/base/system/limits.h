/* What the system lets this process have: cores and memory. */
#pragma once

typedef struct limits {
  int cores;       /* of the affinity and the quota of the control groups */
  double memory;   /* bytes that can still be taken; INFINITY: unknown */
  const char *who; /* source of the limit, for messages */
} limits;

/* root: "", or a folder that stands for the root of the file system (tests). */
void limits_read(const char *root, limits *l);
/* Bytes of memory this process holds now (resident); 0: unknown. */
double limits_held(void);
/* All processors of the process, which has one until the first call: OpenBLAS
 * starts no thread when it is loaded. */
void limits_release_processors(void);
