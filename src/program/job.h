/* One pass through the stages: deck, model, mesh, history, outputs. */
#ifndef PROTIS_JOB_H
#define PROTIS_JOB_H

#include "program/command.h"
#include "run/history/history.h"
#include "output/output.h"
#include "run/start/coarser.h"

typedef struct job_input {
  deck *d;
  model *m;
  mesh *msh;                 /* NULL: a problem from a file */
  double library_cpu;        /* s, CPU time for loading the mesher */
  exchange_problem *problem; /* or NULL */
  coarser *contact;          /* what in->m starts from, or NULL */
  /* Of another pass than the first: the deck of that, to which the messages
   * refer, and the messages of its own. */
  deck *first;
  message_log *log;
  char *closing; /* lines for the end on a terminal, or NULL; free() */
} job_input;

/* The mesh of another pass. */
typedef struct job_mesh {
  mesh_sizes sizes[MESH_SIZES]; /* a .geo is meshed again as in mesh_source */
  mesh *same;                   /* or NULL: this mesh, taken over */
} job_mesh;

/* Everything before the first solve; NULL: the mesh of the deck. What is there
 * is freed by job_input_free, also after a failure. */
status job_read(const command *c, const job_mesh *other, message_log *log,
                job_input *in);
void job_input_free(job_input *in);

/* ERR_MEMORY: n contact nodes would need more than the available memory. */
status job_expect(const job_input *in, int n, const stiffness_choice *choice);

int job_is_geo(const model *m); /* 1: the mesh is made by gmsh */
/* 1: it is neither made again nor refined: a .msh with values at its nodes. */
int job_keeps_mesh(const model *m);

/* Observer of a pass. Any function may be NULL. */
typedef struct job_watch {
  void *ctx;
  /* Any status but OK ends the pass. */
  status (*increment)(void *ctx, const state *s);
  void (*ready)(void *ctx, const setup_facts *facts);
  /* After the last increment, before the files are closed: additional output;
   * returns the status of the run. */
  status (*finished)(void *ctx, status run, output *out);
} job_watch;

/* The contact of an increment, for the start of one on a finer mesh. */
status job_keep_contact(coarser *to, const state *s);

/* *SOLVER, NESTED=YES: the first increment on a mesh with elements of twice the
 * length becomes the start of the job: in->coarser. Where it fails there is
 * none. ERR_MEMORY, or that of an interruption. */
status job_solve_coarser(const command *c, job_input *in);

/* Solve and write the results into the folder, which is there; watch may be
 * NULL. Only a pass without observer writes restart files. from: the restart
 * file of the run to continue, or NULL. *unsettled as history_run. */
status job_solve(const command *c, job_input *in, const job_watch *watch,
                 archive *from, int *unsettled);

/* The same with *EFFECTS, MODE=AUTO: a run without effects that seem not to
 * matter, and the run with them if that is not confirmed
 * (effects/reduction/reduction.h). */
status job_solve_auto(const command *c, job_input *in, int *unsettled);

/*
 * target.c, *ACCURACY, TARGET=: the job in passes with a finer mesh, shorter
 * increments and a tighter solver until the estimated error is reached, or a
 * limit of the deck. *in holds the first pass, then the last; the files are
 * those of the last. ERR_UNSETTLED: the target is missed, the record says why;
 * the errors of job_solve.
 */
status target_reach(const command *c, job_input *in, int *unsettled);

/* forecast.c, protis JOB --estimate-cost: run the job twice without results, on
 * a mesh twice as coarse as that of the deck and on that, and print estimated
 * unknowns, CPU seconds and memory for finer meshes and for errors from 10 % to
 * 0.1 %. ERR_DECK: no .geo to mesh again; the errors of history_run. */
status forecast_print(const command *c, job_input *in);

/* lock.c: one job of a name in a folder at a time: JOB.lock, held by flock(),
 * which the system releases however the process ends. A file left behind is no
 * lock. */
typedef struct job_lock {
  char *path; /* owned; NULL: none held */
  int fd;
} job_lock;

/* Make the folder if it is not there, and take the lock. ERR_FILE: another
 * process holds it, or the file cannot be made. */
status job_lock_take(const char *dir, const char *job, job_lock *l);
void job_lock_release(job_lock *l); /* accepts one never taken */

#endif
