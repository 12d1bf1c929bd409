/* One pass through the stages: deck, model, mesh, history, outputs. */
#pragma once

#include "program/command.h"
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

int job_is_geo(const model *m); /* 1: the mesh is made by gmsh */
/* 1: it is neither made again nor refined: a .msh with values at its nodes. */
int job_keeps_mesh(const model *m);

/* Observer of a pass. */
typedef struct job_watch {
  history_sink first; /* of output_options */
  /* After the last increment, before the files are closed: additional output;
   * returns the status of the run. NULL: none. */
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

/* What a mesh has in error at most, -, by the estimate of one that is coarse
 * (space_is_coarse) or not; the estimate that the next one is to have so that
 * the goal is met. */
double target_at_most(double estimate, int is_coarse);
double target_next(double estimate, int is_coarse, double goal);

/* forecast.c, protis JOB --estimate-cost: run the job without results on the
 * mesh of the deck and on two finer ones (two more for *GOAL), and print
 * estimated unknowns, CPU seconds and memory for errors from 10 % to 0.1 %.
 * ERR_DECK: no mesh to refine; the errors of history_run. */
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

/*
 * JOB.rst.h5: what a run goes on from with --restart, to the result of the run
 * that was not interrupted, bit for bit.
 *
 * All that an increment starts from is kept (run_keep): the last equilibrium,
 * slip so far, inelastic strains, the place in the grid of increments. Data of
 * the contact solver that persist from increment to increment (factors and
 * exchanged rows) are saved as well (contact_solver_keep), because a new factor
 * has other last digits; matrices, surfaces and averages are made again, for
 * they depend on the deck and the mesh alone. Of the files their lengths are
 * kept: what was written after the restart file is cut and written again. One
 * of them, JOB.rst.inc, has the summaries of the increments for the end of the
 * run.
 *
 * The last two are there: JOB.rst.h5, and JOB.rst.old.h5 in case the first
 * cannot be read.
 */

/* Input of a restart file. */
typedef struct restart_writer {
  const command *c;
  const job_input *in;
  output *out;
  char *files; /* restart_files when the run was started */
} restart_writer;

/* Contents of the files that the cards of the deck name, new. ERR_FILE. */
status restart_files(const job_input *in, char **text);

/* history_sink.checkpoint; ctx is a restart_writer. */
status restart_write(void *ctx, struct run *r);

/*
 * The restart file of a job, found to fit its deck and mesh. ERR_DECK: no
 * restart for such a job, or cards have changed that must not; ERR_FILE: no
 * restart file, damaged, of another version or mesh. Other threads or another
 * kernel: a warning on stderr. *out is to be freed after a failure too.
 */
status restart_read(const command *c, const job_input *in, archive **out);

/*
 * The targets of *GOAL in the passes of target.c: errors against what is
 * allowed, the sizes of the next mesh.
 */

typedef struct aims aims;

/* *out is new; NULL: there are no goals. Those with a target count, or all, for
 * a forecast. ERR_MEMORY. */
status aims_new(const model *m, int all, aims **out);
int aims_count(const aims *a); /* 1: some goal counts; NULL: none */

/* Of a pass, in this order: before its increments; after each of them; after
 * the last one. All accept NULL. */
status aims_begin(aims *a, const mesh *msh);
void aims_see(aims *a, const mesh *msh, const state *s);
void aims_evaluate(aims *a, const model *m);

/* Of the last pass; NULL: nothing is wanted. 1: all targets are reached. */
int aims_are_met(const aims *a, const model *m);
/* Why no mesh can reach them, or ""; last 1: or that the last has not. */
void aims_check(const aims *a, const model *m, int last, char *why,
                size_t size);
/* 1: the meshes of the last two passes brought the goals no nearer. */
int aims_stand_still(const aims *a);
/* Largest error of the contact solver over that share of what is allowed, -. */
double aims_solver(const aims *a, const model *m, double share);
/* size[n_node] of the next mesh made smaller where a goal requires that;
 * eta[n_elem]: energy norm of the error of each, or NULL. ERR_MEMORY. */
status aims_sizes(aims *a, const model *m, const mesh *msh, const double *eta,
                  double *size);
/* In the place of the targets: the errors shall fall to that part. */
void aims_ask(aims *a, double part);
/* Elements that goal i alone needs for its error, over those of the mesh of the
 * last pass, -. ERR_MEMORY. */
status aims_share(const aims *a, const mesh *msh, int i, double *share);
/* The goals that require it, after "mesh"; 0: none. */
size_t aims_name(const aims *a, const model *m, char *text, size_t size);

/* [n*n_goal] of the passes so far; NULL of NULL. */
const pass_goal *aims_rows(const aims *a);
