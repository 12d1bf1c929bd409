/*
 * The model against the mesh: kinematics, sections, and the parts in order.
 */
#include "model/check/parts.h"

#include "base/memory.h"

#include <math.h>

static void check_kinematics(model *m, const mesh *msh) {
  for (int i = 0; i < m->n_section; ++i) {
    section *s = &m->sections[i];
    if (s->kin < 0) s->kin = msh->dim == 3 ? SOLID_3D : PLANE_STRAIN;
    if ((s->kin == SOLID_3D) != (msh->dim == 3))
      message_add(
          m->log, P2024, &s->at,
          "*SOLID SECTION: this TYPE does not fit a mesh in %d-D; "
          "expected %s",
          msh->dim,
          msh->dim == 3 ? "3D" : "PLANE STRAIN, PLANE STRESS or AXISYMMETRIC");
    if ((s->kin == AXISYMMETRIC) != (m->sections[0].kin == AXISYMMETRIC))
      message_add(m->log, P2026, &s->at,
                  "axisymmetric and plane sections cannot stand in one model");
    if (s->averaged && s->kin == PLANE_STRESS)
      message_add(m->log, P2037, &s->at,
                  "*SOLID SECTION: FORMULATION=AVERAGED does nothing in plane "
                  "stress, which does not lock");
    if (s->kin != AXISYMMETRIC && s->kin != SOLID_3D) continue;
    s->thickness = 1.0;
    if (s->has_thickness)
      message_add(
          m->log, P2037, &s->at,
          "*SOLID SECTION: a thickness counts in plane strain and plane "
          "stress only");
  }
}

/*
 * P1 elements lock where nu comes near 1/2 in plane strain, axisymmetry and
 * 3-D. Lame's tube (radii 1 and 2, unstructured mesh with n elements through
 * its wall): the displacement is too small by about 0.55/(1 + 5 (1 - 2 nu)
 * n^2), within a third of the errors observed for nu = 0.49 to 0.4999 and n = 8
 * to 64.
 */
double model_locking_error(double nu, int n) {
  return 0.55 / (1.0 + 5.0 * (1.0 - 2.0 * nu) * n * n);
}

static void check_locking(const model *m) {
  enum { COARSE = 16, FINE = 64 };
  for (int i = 0; i < m->n_section; ++i) {
    const section *s = &m->sections[i];
    const material *mat =
        s->material_id < 0 || s->kin == PLANE_STRESS || s->averaged
            ? NULL
            : &m->materials[s->material_id];
    if (mat == NULL || mat->elastic.n == 0 || mat->elastic.type != ELASTIC_ISO)
      continue;
    double nu = elastic_table_most(&mat->elastic, 1);
    if (nu <= 0.49) continue;
    message_add(m->log, P2055, &s->at,
                "nu = %g of material %s: linear elements lock; expect "
                "displacements too small by some %.2g %% with %d elements "
                "across a wall, %.2g %% with %d",
                nu, mat->name, 100.0 * model_locking_error(nu, COARSE), COARSE,
                100.0 * model_locking_error(nu, FINE), FINE);
  }
}

/* The radius x of an axisymmetric model is not negative. */
static void check_radius(const model *m, const mesh *msh) {
  static const double rounding = 1e-9; /* of the size of the mesh            */
  if (m->n_section == 0 || m->sections[0].kin != AXISYMMETRIC) return;
  for (int i = 0; i < msh->n_node; ++i) {
    const double *x = msh->x + (size_t)msh->dim * (size_t)i;
    if (x[0] >= -rounding * msh->size) continue;
    message_add(m->log, P2039, &m->sections[0].at,
                "axisymmetric, but node %zu is at radius x = %g",
                msh->node_no[i], x[0]);
    return;
  }
}

/* Each element in one section. */
static status check_sections(model *m, const mesh *msh) {
  PASS_NEW(m->elem_section, msh->n_elem);
  for (int e = 0; e < msh->n_elem; ++e) m->elem_section[e] = -1;
  for (int i = 0; i < m->n_section; ++i) {
    section *s = &m->sections[i];
    s->group_id = check_group_of(m, msh, s->elset, msh->dim, &s->elset_at);
    if (s->group_id < 0) continue;
    const mesh_group *g = &msh->group[s->group_id];
    for (int k = 0; k < g->n_item; ++k) {
      int *of = &m->elem_section[g->item_id[k]];
      if (*of >= 0 && *of != i) {
        message_add(m->log, P2023, &s->at,
                    "element %zu belongs to section %s and to section %s",
                    msh->elem_no[g->item_id[k]], m->sections[*of].elset,
                    s->elset);
        break;
      }
      *of = i;
    }
  }
  if (message_count(m->log, ERROR) > 0) return OK;
  int missing = 0, first = -1;
  for (int e = 0; e < msh->n_elem; ++e)
    if (m->elem_section[e] < 0) {
      if (missing++ == 0) first = e;
    }
  if (missing > 0)
    message_add(m->log, P2023, &m->sections[0].at,
                "%d element%s, the first number %zu, without *SOLID SECTION",
                missing, missing == 1 ? "" : "s", msh->elem_no[first]);
  return OK;
}

/* Moduli over the temperature where there is none. */
static void check_moduli(const model *m) {
  for (int i = 0; i < m->n_material; ++i) {
    const material *mat = &m->materials[i];
    if (!mat->used || mat->elastic.n < 2 || (m->effects & EFFECT_THERMAL))
      continue;
    message_add(m->log, P2049, &mat->at,
                "material %s: *ELASTIC depends on temperature, but no "
                "temperature is given: its constants at 0 are taken",
                mat->name);
  }
}

status model_check(model *m, const mesh *msh) {
  m->dim = msh->dim;
  m->ns = msh->dim == 3 ? 6 : 4;
  check_kinematics(m, msh);
  check_radius(m, msh);
  PASS(check_sections(m, msh));
  check_locking(m);
  check_contacts(m, msh);
  check_laws(m);
  check_initials(m, msh);
  check_steps(m, msh);
  PASS(check_fields(m, msh));
  check_reference(m);
  PASS(model_find_corner(m, msh));
  model_find_effects(m);
  check_moduli(m);
  PASS(message_status(m->log, ERR_DECK));
  check_values(m, msh);
  check_no_effect(m, msh);
  for (int i = 0; i < m->n_step; ++i) PASS(check_agreement(m, msh, i));
  PASS(check_visco(m));
  return message_status(m->log, ERR_DECK);
}
