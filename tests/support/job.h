/*
 * Runs of the program for the tests: a deck (with its mesh or .geo) in a folder
 * of its own, the exit code, what was printed, the tables of JOB.dat.
 *
 * The program is $PROTIS, else build/release/protis.
 */
#pragma once

#include "base/memory.h"

#include <stddef.h>

typedef struct job {
  char dir[64];  /* its folder; removed by job_end                         */
  char name[32]; /* JOB                                                    */
  char *errors;  /* what it printed on stderr, or NULL                     */
  char *text;    /* what it printed on stdout, or NULL                     */
} job;

/* A block of JOB.dat. OPEN, SLIP, STICK are read as 0, 1, 2, other words NaN.
 */
typedef struct dat {
  int n_row, n_col;
  char (*name)[32]; /* [n_col] without unit                                 */
  double *value;    /* [n_row*n_col] row by row                             */
} dat;

/* LD_PRELOAD of later runs is NAME.so of tests/preload, in the folder where the
 * program was built; check fails if it is not there. */
void job_preload(const char *name);
/* A new empty folder; check fails if that is not possible. */
job job_begin(const char *name);
void job_end(job *j);
/* JOB j = ...: it ends where the name does; likewise DAT, and others below
 * tests. */
#define JOB ENDS_BY(job_end) job
/* Defined by programs whose decks write no fields, a third of a small run,
 * unless they say *OUTPUT. */
extern const int job_without_fields __attribute__((weak));
/* Write a file of the folder; printf format. */
void job_write(const job *j, const char *file, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Copy a file of the sources into the folder under its own name. */
void job_copy(const job *j, const char *path);
/* A new folder with the deck NAME.inp, printf format, and a file of the
 * sources, or NULL. */
job job_with(const char *name, const char *mesh, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Copy the .geo and .msh files beside a deck of the sources. */
void job_copy_meshes(const job *j, const char *deck);
/* Of an example, "input/x/x"; caller frees. */
char *job_deck_text(const char *deck);
/* Options that make an example cheaper: half the segments (a quarter of more
 * than 15), increments of four times the length, a fifth of the cycles. */
void job_coarsen(const char *deck, char *words, size_t size);
/* The one of JOB.lst and JOB.json ("lst", "json") that is there with an exit
 * code other than that, or NULL. */
const char *job_contradiction(const job *j, int code);
/* Run protis NAME with further words ("" or "-D N=4 --check"); exit code,
 * or 1000 + signal. The check fails if the files of a run have another. */
int job_run(job *j, const char *words);
/* Check fails, with what the program printed, unless a run ends with that exit
 * code. */
#define CK_EXIT(run, wanted, j)                                         \
  do {                                                                  \
    const int code_ = (run);                                            \
    ck_assert_msg(code_ == (wanted), "exit %d: %s", code_, (j).errors); \
  } while (0)
/* Run a command of the shell in the folder, "protis" being the program; its
 * exit code. */
int job_shell(job *j, const char *command);
/* Run a deck of the sources (no .inp) with the results in the folder; JOB is
 * then its name. */
int job_run_deck(job *j, const char *deck, const char *words);
/* The same in a new folder; check fails if the exit code is not 0. */
job job_deck(const char *deck, const char *words);
/* Run a deck of the sources with "cards" at the end of each step, without its
 * *ACCURACY if "without". A new folder, as job_begin. */
int job_run_with(job *j, const char *deck, const char *cards, int without,
                 const char *words);
/* Row of the first zone of a kind (0 OPEN, 1 SLIP, 2 STICK) in a table ZONES;
 * check fails if there is none. */
int dat_zone(const dat *z, int kind);
/* All of a file of the folder as text (caller frees), or NULL. */
char *job_file(const job *j, const char *suffix);
/* 1: JOB.suffix is in the folder. */
int job_has(const job *j, const char *suffix);
/* Remove all results and restart files; deck and meshes stay. */
void job_clear(const job *j);
/* Calls of a stage in the closing table of the listing; *bytes or NULL: what it
 * asked for. Check fails if the stage is not there. */
long job_stage(const job *j, const char *name, long *bytes);
/* The last number of that name in JOB.json; check fails if there is none. */
double job_told(const job *j, const char *name);
/* Unknowns of the last pass of TARGET=. */
double job_unknowns(const job *j);
/* Energy norm of the difference of two runs under the same loads over that of
 * the second, %: its square is (u_a - u_b)'(r_a - r_b) on the contact; block k
 * of the tables CONTACT and ENERGY. */
double job_difference(const job *a, const job *b, int k);
/* Block number k (from 0; -1 the last) of a table (CONTACT, ...) of JOB.dat;
 * check fails if there is none. */
dat job_table(const job *j, const char *kind, int k);
void dat_free(dat *d);
#define DAT ENDS_BY(dat_free) dat
int dat_column(const dat *d, const char *name); /* check fails if absent      */
int dat_has(const dat *d, const char *name); /* 1: the column is there        */
double dat_at(const dat *d, int row, const char *name);
/* Row whose "name" is nearest to value. */
int dat_row_near(const dat *d, const char *name, double value);
double dat_sum(const dat *d, const char *name);
double dat_max(const dat *d, const char *name); /* largest magnitude          */
/* The same of block k of a table of JOB.dat; value: of its first row. */
double job_value(const job *j, const char *kind, int k, const char *name);
double job_sum(const job *j, const char *kind, int k, const char *name);
double job_max(const job *j, const char *kind, int k, const char *name);
/* Potential energy of one increment from rest: E - F'u, F'u twice the
 * trapezoidal work. */
double job_potential(const job *j, double *strain);
int job_tells(const job *j, const char *text); /* 1: JOB.lst has the text */
double job_cpu(void);                          /* of jobs so far, s */
const char *job_program(void);
