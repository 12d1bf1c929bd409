/*
 * Contents of JOB.h5: mesh, contact surface, deck; fields of the columns.
 */
#include "output/hdf5/file.h"

#include "model/keyword/keyword.h"

int hdf5_is_history(const hdf5_field *f) {
  return f->of == PER_INCREMENT || f->of == PER_CONTACT;
}

int hdf5_items(const hdf5_file *h, const hdf5_field *f) {
  if (f->of == PER_NODE) return h->msh->n_node;
  if (f->of == PER_ELEMENT) return h->msh->n_elem;
  return f->of == PER_CONTACT_NODE ? h->n_contact_node : 1;
}

void hdf5_record_name(char *text, size_t size, int i) {
  snprintf(text, size, "%05d", i + 1);
}

size_t fixed_bytes(const fixed_data *d) {
  static const size_t size[] = {sizeof(double), sizeof(int), sizeof(size_t), 1};
  return size[d->type] * d->rows * d->columns;
}

/* A name as a link of HDF5: "/" parts groups and "." is the group itself. */
static void link_name(char *text, size_t size, const char *name) {
  snprintf(text, size, "%s", name);
  for (char *c = text; *c != '\0'; ++c)
    if (*c == '/') *c = '|';
  if (strcmp(text, ".") == 0 || text[0] == '\0') snprintf(text, size, "_");
}

static const char *group_of(const column *c) {
  if (c->of == PER_INCREMENT) return "/history";
  return c->of == PER_CONTACT_NODE ? "/contact" : "/fields";
}

/* A column that shares its field with those before is its next component; the
 * fourth makes a symmetric tensor of them. */
static void add_part(hdf5_field *f, const column *c) {
  static const int order[] = {0, 3, 5, 1, 4, 2}; /* of xx yy zz xy yz zx */
  if (c->part > 2 && f->n_part == 3) {
    f->part[5] = f->part[2];
    f->part[3] = f->part[1];
    f->part[1] = f->part[2] = NULL;
  }
  f->n_part = c->part > 2 ? 6 : 3;
  f->part[f->n_part == 6 ? order[c->part] : c->part] = c;
}

static status add_field(hdf5_file *h, const column *c, entity of,
                        const char *group, int id) {
  for (EACH(hdf5_field, f, h->fields, h->n_field)) {
    if (strcmp(f->name, c->field) != 0 || strcmp(f->group, group) != 0)
      continue;
    add_part(f, c);
    return OK;
  }
  ADDED(hdf5_field, f, h->fields, h->n_field, h->cap_field);
  *f = (hdf5_field){.name = c->field, .of = of, .id = id, .n_part = 1};
  snprintf(f->group, sizeof f->group, "%s", group);
  f->part[0] = c;
  return OK;
}

static status choose_fields(hdf5_file *h) {
  char name[100];
  const column *c;
  for (column_walk k = {0}; (c = column_next(&k)) != NULL;) {
    if (c->field == NULL || !column_visible(c, h->m)) continue;
    if (c->of == PER_CONTACT_NODE && h->n_contact_node == 0) continue;
    if (c->of != PER_CONTACT) {
      PASS(add_field(h, c, c->of, group_of(c), 0));
      if (h->n_contact_node > 0 && strcmp(c->field, "u") == 0)
        PASS(add_field(h, c, PER_CONTACT_NODE, "/contact", 0));
      continue;
    }
    for (int i = 0; i < h->m->n.contact; ++i) {
      link_name(name, sizeof name, h->m->contacts[i].name);
      PASS(add_field(h, c, PER_CONTACT, text_of("/totals/%s", name), i));
    }
  }
  return OK;
}

/* Takes own over, also when it fails. */
static status add_fixed(hdf5_file *h, const char *path, data_type type,
                        int rows, int columns, const void *data, void *own) {
  OWNED void *held = own;
  ADDED(fixed_data, d, h->fixed, h->n_fixed, h->cap_fixed);
  *d = (fixed_data){.type = type,
                    .rows = rows,
                    .columns = columns,
                    .data = own != NULL ? own : data,
                    .own = own};
  snprintf(d->path, sizeof d->path, "%s", path);
  held = NULL;
  return OK;
}

/* Points of some nodes (NULL: all), with 3 components. */
static status add_points(hdf5_file *h, const char *path, int n,
                         const int *node_id) {
  size_t dim = h->msh->dim;
  double *own = NULL;
  PASS_NEW(own, 3 * (size_t)n);
  for (size_t i = 0; i < (size_t)n; ++i)
    for (size_t k = 0; k < dim; ++k)
      own[3 * i + k] =
          h->msh->x[dim * (node_id != NULL ? (size_t)node_id[i] : i) + k];
  return add_fixed(h, path, DATA_REAL, n, 3, NULL, own);
}

static int path_known(const hdf5_file *h, const char *path) {
  for (int i = 0; i < h->n_fixed; ++i)
    if (strcmp(h->fixed[i].path, path) == 0) return 1;
  return 0;
}

static status add_group(hdf5_file *h, const mesh_group *g) {
  char name[100], path[200];
  link_name(name, sizeof name, g->name);
  snprintf(path, sizeof path, "/mesh/groups/%s/nodes", name);
  if (path_known(h, path)) /* one name in two dimensions */
    snprintf(name + strlen(name), sizeof name - strlen(name), "_%d", g->dim);
  snprintf(path, sizeof path, "/mesh/groups/%s/nodes", name);
  if (path_known(h, path)) return OK;
  PASS(add_fixed(h, path, DATA_INT, g->n_node, 1, g->node_id, NULL));
  snprintf(path, sizeof path, "/mesh/groups/%s/%s", name,
           g->dim == h->msh->dim ? "elements" : "faces");
  if (g->item_id != NULL)
    PASS(add_fixed(h, path, DATA_INT, g->n_item, 1, g->item_id, NULL));
  return OK;
}

static status add_mesh(hdf5_file *h) {
  const mesh *s = h->msh;
  PASS(add_points(h, "/mesh/nodes", s->n_node, NULL));
  PASS(add_fixed(h, "/mesh/elements", DATA_INT, s->n_elem, s->dim + 1, s->elem,
                 NULL));
  PASS(add_fixed(h, "/mesh/node_no", DATA_NUMBER, s->n_node, 1, s->node_no,
                 NULL));
  PASS(add_fixed(h, "/mesh/elem_no", DATA_NUMBER, s->n_elem, 1, s->elem_no,
                 NULL));
  PASS(add_fixed(h, "/mesh/faces", DATA_INT, s->n_face, s->dim, s->face, NULL));
  for (int i = 0; i < s->n_group; ++i) PASS(add_group(h, &s->group[i]));
  return OK;
}

static const mesh_group *contact_group(const hdf5_file *h, int contact_id) {
  return &h->msh->group[h->m->contacts[contact_id].group_id];
}

/* The faces of the contact groups, as places in contact_node. */
static status add_faces(hdf5_file *h, const int *place_of) {
  const mesh *s = h->msh;
  size_t dim = s->dim, n = 0, most = 0;
  int *faces = NULL;
  for (int c = 0; c < h->m->n.contact; ++c) most += contact_group(h, c)->n_item;
  PASS_NEW(faces, dim * most);
  for (int c = 0; c < h->m->n.contact; ++c) {
    const mesh_group *g = contact_group(h, c);
    if (g->dim != s->dim - 1 || g->item_id == NULL) continue;
    for (int i = 0; i < g->n_item; ++i)
      for (size_t k = 0; k < dim; ++k)
        faces[n++] = place_of[s->face[dim * g->item_id[i] + k]];
  }
  h->n_contact_face = (int)(n / dim);
  return add_fixed(h, "/contact/faces", DATA_INT, h->n_contact_face, s->dim,
                   NULL, faces);
}

/* place_of[n_node]: place in contact_node; contact_of[n_node]: the first
 * contact of a node, from 1; 0: none. */
static status list_contact_nodes(hdf5_file *h, int *place_of, int *contact_of) {
  int n = 0;
  for (int c = h->m->n.contact - 1; c >= 0; --c)
    for (int i = 0; i < contact_group(h, c)->n_node; ++i)
      contact_of[contact_group(h, c)->node_id[i]] = c + 1;
  for (int i = 0; i < h->msh->n_node; ++i) n += contact_of[i] > 0;
  PASS_NEW_ALL(OF(h->contact_node, n), OF(h->surface_id, n));
  h->n_contact_node = n;
  n = 0;
  for (int i = 0; i < h->msh->n_node; ++i) {
    if (contact_of[i] == 0) continue;
    place_of[i] = n;
    h->contact_node[n++] = i;
  }
  return OK;
}

/* Number of the node and of its contact, and the place itself (points of a
 * viewer that draws no faces). */
static status add_contact_numbers(hdf5_file *h, const int *contact_of) {
  size_t *no = NULL;
  int *of = NULL, *index = NULL;
  const int n = h->n_contact_node;
  PASS_NEW(no, n);
  for (int i = 0; i < n; ++i) no[i] = h->msh->node_no[h->contact_node[i]];
  PASS(add_fixed(h, "/contact/node_no", DATA_NUMBER, n, 1, NULL, no));
  PASS_NEW(of, n);
  for (int i = 0; i < n; ++i) of[i] = contact_of[h->contact_node[i]];
  PASS(add_fixed(h, "/contact/contact_no", DATA_INT, n, 1, NULL, of));
  PASS_NEW(index, n);
  for (int i = 0; i < n; ++i) index[i] = i;
  return add_fixed(h, "/contact/index", DATA_INT, n, 1, NULL, index);
}

static status add_contact(hdf5_file *h) {
  OWNED int *place_of = NULL, *contact_of = NULL;
  PASS_NEW_ALL(OF(place_of, h->msh->n_node), OF(contact_of, h->msh->n_node));
  PASS(list_contact_nodes(h, place_of, contact_of));
  if (h->n_contact_node == 0) return OK;
  PASS(add_points(h, "/contact/points", h->n_contact_node, h->contact_node));
  PASS(add_fixed(h, "/contact/node", DATA_INT, h->n_contact_node, 1,
                 h->contact_node, NULL));
  PASS(add_contact_numbers(h, contact_of));
  return add_faces(h, place_of);
}

static status add_deck(hdf5_file *h) {
  char *text = NULL;
  if (h->m->deck == NULL) return OK;
  PASS(text_made(&text, h->m, model_echo));
  return add_fixed(h, "/deck", DATA_TEXT, (int)strlen(text) + 1, 1, NULL, text);
}

status hdf5_content(hdf5_file *h) {
  PASS(add_mesh(h));
  if (h->m->effects & EFFECT_CONTACT) PASS(add_contact(h));
  PASS(add_deck(h));
  return choose_fields(h);
}
