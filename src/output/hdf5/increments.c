/*
 * Rows and records of JOB.h5, written while the job runs.
 */
#include "output/hdf5/file.h"

#include "base/memory.h"

#include <math.h>

/* Space for the rest of the run, and for half as many again as there are, so
 * that copying costs little in total. */
static status grow(hdf5_file *h, const state *s) {
  int rows, records;
  const step *now = &h->m->steps[s->step_no - 1];
  double left = (now->start + now->total - s->t) / fmax(s->dt, 1e-300);
  hdf5_forecast(h->m, s->step_no, fmax(0, ceil(left * (1 - 1e-9))) + 1, &rows,
                &records);
  rows = h->n_row + (int)fmax(rows, 8 + h->n_row / 2);
  if (h->n_record < h->now.n_record)
    records = h->now.n_record;
  else
    records = h->n_record + (int)fmax(records, 4 + h->n_record / 2);
  return hdf5_renew(h, rows, records);
}

static double ready_value(const column *c, const view *v, int id) {
  const double value = c->value(v, id, c->part);
  return value == 0 ? 0.0 : value;
}

static double part_value(const hdf5_field *f, const view *v, int id, int k) {
  const column *c = f->part[k];
  if (c == NULL) return 0;
  return column_ready(c, v->s) ? ready_value(c, v, id) : NAN;
}

/* The item of a column that stands in place id of its field: a contact node
 * that is not in the surface now (-1) has displacements, but no other
 * value. */
static int item_of(const hdf5_file *h, const hdf5_field *f, int id) {
  if (f->of != PER_CONTACT_NODE) return id;
  return f->part[0]->of == PER_NODE ? h->contact_node[id] : h->surface_id[id];
}

static off_t slot(off_t offset, int i) {
  return offset + (off_t)sizeof(double) * i;
}

/* Values that follow each other in the file, to be written at once. */
typedef struct burst {
  off_t at;
  int n;
  double value[CHUNK];
} burst;

static status put_burst(hdf5_file *h, burst *b) {
  const size_t bytes = sizeof *b->value * (size_t)b->n;
  b->n = 0;
  return hdf5_put(h->fd, h->path, b->value, bytes, b->at);
}

static status put_field(hdf5_file *h, const hdf5_field *f, const view *v,
                        off_t offset, burst *b) {
  const int items = hdf5_items(h, f);
  int ready[6];
  for (int k = 0; k < f->n_part; ++k)
    ready[k] = f->part[k] != NULL && column_ready(f->part[k], v->s);
  for (int i = 0; i < items; ++i)
    for (int k = 0; k < f->n_part; ++k, offset = slot(offset, 1)) {
      if (b->n == CHUNK || slot(b->at, b->n) != offset) {
        PASS(put_burst(h, b));
        b->at = offset;
      }
      const int id = item_of(h, f, i);
      double value = f->part[k] == NULL && id >= 0 ? 0 : NAN;
      if (ready[k] && id >= 0) value = ready_value(f->part[k], v, id);
      b->value[b->n++] = value;
    }
  return OK;
}

/* Both lists ascend. */
static void find_surface_ids(hdf5_file *h, const contact_surface *s) {
  int k = 0;
  for (int i = 0; i < h->n_contact_node; ++i) {
    while (s != NULL && k < s->n && s->node_id[k] < h->contact_node[i]) ++k;
    int there = s != NULL && k < s->n && s->node_id[k] == h->contact_node[i];
    h->surface_id[i] = there ? k : -1;
  }
}

static status put_real(hdf5_file *h, double value, off_t offset, int i) {
  return hdf5_put(h->fd, h->path, &value, sizeof value, slot(offset, i));
}

static status put_record(hdf5_file *h, const view *v) {
  burst b = {.n = 0};
  PASS_GROW(h->times, h->n_record, h->cap_time);
  find_surface_ids(h, v->s->contacts.surface);
  for (int i = 0; i < h->n_field; ++i) {
    if (hdf5_is_history(&h->fields[i])) continue;
    size_t k = (size_t)i * (size_t)h->now.n_record + (size_t)h->n_record;
    PASS(put_field(h, &h->fields[i], v, h->now.record[k], &b));
  }
  PASS(put_burst(h, &b));
  PASS(put_real(h, v->s->total_no, h->now.record_total, h->n_record));
  PASS(put_real(h, v->s->t, h->now.record_time, h->n_record));
  h->times[h->n_record++] = v->s->t;
  return OK;
}

static status put_row(hdf5_file *h, const view *v) {
  int time_id = hdf5_time_field(h);
  for (int i = 0; i < h->n_field; ++i) {
    const hdf5_field *f = &h->fields[i];
    if (!hdf5_is_history(f) || i == time_id) continue;
    PASS(put_real(h, part_value(f, v, f->id, 0), h->now.history[i], h->n_row));
  }
  PASS(put_real(h, v->s->t, h->now.history[time_id], h->n_row));
  ++h->n_row;
  return OK;
}

status hdf5_increment(hdf5_file *h, const state *s) {
  if (h == NULL) return OK;
  view v = {h->m, h->msh, s};
  int due = frequency_shows(h->m->steps[s->step_no - 1].output.frequency,
                            s->increment_no, s->end_of_step);
  if (h->n_row == h->now.n_row || (due && h->n_record == h->now.n_record))
    PASS(grow(h, s));
  if (due) PASS(put_record(h, &v));
  return put_row(h, &v);
}
