/*
 * JOB.xdmf: XDMF 3 text with the places of the fields in JOB.h5, named without
 * folder. Two temporal collections: the contact surface and the body; the body
 * is the last one, as some readers take that one only. Data items are whole
 * datasets (hyperslabs are not read everywhere).
 *
 * JOB.body.xdmf, JOB.contact.xdmf: one grid of the last record, without time,
 * for readers that take nothing else (meshio.read).
 */
#include "output/hdf5/file.h"

/* Where the name of a record and its time stand in a text of any record. */
enum { NAME = 1, TIME = 2 };

typedef struct part {
  const char *name, *points, *cells, *topology;
  int n_point, n_cell, corners;
  entity on_points, on_cells; /* fields shown on it; PER_INCREMENT: none */
  int alone;                  /* 1: without time */
} part;

static void xml_text(FILE *f, const char *text) {
  static const char marks[] = "&<>\"";
  static const char *const names[] = {"&amp;", "&lt;", "&gt;", "&quot;"};
  for (; *text != '\0'; ++text) {
    const char *mark = strchr(marks, *text);
    if (mark != NULL)
      fputs(names[mark - marks], f);
    else
      fputc((unsigned char)*text >= ' ' || *text == NAME ? *text : '?', f);
  }
}

static void data_item(FILE *f, const char *file, const char *dataset,
                      const char *type, int rows, int columns) {
  fprintf(f, "<DataItem Format=\"HDF\" %s Dimensions=\"%d", type, rows);
  if (columns > 1) fprintf(f, " %d", columns);
  fputs("\">", f);
  xml_text(f, file);
  fputc(':', f);
  xml_text(f, dataset);
  fputs("</DataItem>\n", f);
}

#define REAL_TYPE "NumberType=\"Float\" Precision=\"8\""
#define INT_TYPE "NumberType=\"Int\" Precision=\"4\""

static void write_mesh(FILE *f, const char *file, const part *p) {
  fprintf(f, "<Topology TopologyType=\"%s\" NumberOfElements=\"%d\"",
          p->topology, p->n_cell);
  if (strcmp(p->topology, "Polyline") == 0 || p->corners == 1)
    fprintf(f, " NodesPerElement=\"%d\"", p->corners);
  fputs(">", f);
  data_item(f, file, p->cells, INT_TYPE, p->n_cell,
            p->corners > 1 ? p->corners : 0);
  fputs("</Topology>\n<Geometry GeometryType=\"XYZ\">", f);
  data_item(f, file, p->points, REAL_TYPE, p->n_point, 3);
  fputs("</Geometry>\n", f);
}

static void write_field(FILE *f, const char *file, const part *p,
                        const hdf5_field *shown) {
  char dataset[400];
  int on_points = shown->of == p->on_points;
  snprintf(dataset, sizeof dataset, "%s/%s/%c", shown->group, shown->name,
           NAME);
  fprintf(f, "<Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"%s\">",
          shown->name,
          shown->n_part == 3   ? "Vector"
          : shown->n_part == 6 ? "Tensor6"
                               : "Scalar",
          on_points ? "Node" : "Cell");
  data_item(f, file, dataset, REAL_TYPE, on_points ? p->n_point : p->n_cell,
            shown->n_part);
  fputs("</Attribute>\n", f);
}

typedef struct pattern {
  const part *of;
  const hdf5_file *h;
} pattern;

/* The text of any record of a part, with NAME and TIME. */
static status write_pattern(FILE *f, const void *what) {
  const pattern *all = what;
  const part *p = all->of;
  const hdf5_file *h = all->h;
  const char *slash = strrchr(h->path, '/');
  const char *file = slash != NULL ? slash + 1 : h->path;
  fprintf(f, "<Grid Name=\"%s\" GridType=\"Uniform\">\n", p->name);
  if (!p->alone) fprintf(f, "<Time Value=\"%c\"/>\n", TIME);
  if (!p->alone && p->on_points == PER_CONTACT_NODE)
    fputs("<Information Name=\"status\" Value=\"0 OPEN, 1 SLIP, 2 STICK\"/>\n",
          f);
  write_mesh(f, file, p);
  for (int k = 0; k < h->n_field; ++k) {
    entity of = h->fields[k].of;
    if (of == PER_INCREMENT || of == PER_CONTACT) continue;
    if (of == p->on_points || of == p->on_cells)
      write_field(f, file, p, &h->fields[k]);
  }
  fputs("</Grid>\n", f);
  return OK;
}

static status make_pattern(const part *p, const hdf5_file *h, char **text) {
  return text_made(text, &(pattern){p, h}, write_pattern);
}

static void write_record(FILE *f, const char *text, int record_id, double t) {
  static const char marks[] = {NAME, TIME, '\0'};
  char name[40];
  const char *time = text_number(t, 16);
  hdf5_record_name(name, sizeof name, record_id);
  for (;; ++text) {
    size_t n = strcspn(text, marks);
    fwrite(text, 1, n, f);
    text += n;
    if (*text == '\0') break;
    fputs(*text == NAME ? name : time, f);
  }
}

static void write_part(FILE *f, const part *p, const char *text,
                       const hdf5_file *h) {
  fprintf(f,
          "<Grid Name=\"%s\" GridType=\"Collection\" "
          "CollectionType=\"Temporal\">\n",
          p->name);
  for (int i = 0; i < h->n_record; ++i) write_record(f, text, i, h->times[i]);
  fputs("</Grid>\n", f);
}

/* Without faces (every neighbour was left out) the nodes are shown. */
static part surface_part(const hdf5_file *h) {
  part p = {"contact",         "/contact/points",
            "/contact/faces",  h->msh->dim == 2 ? "Polyline" : "Triangle",
            h->n_contact_node, h->n_contact_face,
            h->msh->dim,       PER_CONTACT_NODE,
            PER_INCREMENT,     0};
  if (h->n_contact_face == 0) {
    p.cells = "/contact/index";
    p.topology = "Polyvertex";
    p.n_cell = h->n_contact_node;
    p.corners = 1;
  }
  return p;
}

static part body_part(const hdf5_file *h) {
  return (part){"body",           "/mesh/nodes",
                "/mesh/elements", h->msh->dim == 2 ? "Triangle" : "Tetrahedron",
                h->msh->n_node,   h->msh->n_elem,
                h->msh->dim + 1,  PER_NODE,
                PER_ELEMENT,      0};
}

static const char head[] =
    "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n";

typedef struct content {
  const hdf5_file *h;
  part surface, body;
  const char *surface_text, *body_text; /* of a record; the first may be NULL */
} content;

static void write_all(FILE *f, const void *what) {
  const content *c = what;
  fputs(head, f);
  if (c->surface_text != NULL)
    write_part(f, &c->surface, c->surface_text, c->h);
  write_part(f, &c->body, c->body_text, c->h);
  fputs("</Domain>\n</Xdmf>\n", f);
}

status xdmf_write(const hdf5_file *h, const char *path) {
  OWNED char *surface = NULL, *body = NULL;
  content c = {.h = h, .surface = surface_part(h), .body = body_part(h)};
  if (h->n_contact_node > 0) PASS(make_pattern(&c.surface, h, &surface));
  PASS(make_pattern(&c.body, h, &body));
  c.surface_text = surface;
  c.body_text = body;
  return text_replace(path, &c, write_all);
}

typedef struct snapshot {
  const char *text; /* of any record */
  int record_id;
} snapshot;

static void write_last(FILE *f, const void *what) {
  const snapshot *s = what;
  fputs(head, f);
  write_record(f, s->text, s->record_id, 0);
  fputs("</Domain>\n</Xdmf>\n", f);
}

status xdmf_write_last(const hdf5_file *h, int of_contact, const char *path) {
  part p = of_contact ? surface_part(h) : body_part(h);
  if (h->n_record == 0 || p.n_point == 0) return OK;
  p.alone = 1;
  OWNED_OF(char, text, make_pattern(&p, h, &text));
  return text_replace(path, &(snapshot){text, h->n_record - 1}, write_last);
}
