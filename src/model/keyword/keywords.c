/*
 * THE table of deck keywords: where a card is allowed, its parameters, its data
 * lines. The parser, the range checks, --keywords, the echo of the deck and the
 * tests all run over it.
 */
#include "model/keyword/keyword.h"

#include "base/base.h"

#define ANY (-1)

/* clang-format off */
#define NAME(field, ...) OPTION_NAME(card_options, field, __VA_ARGS__)
#define INT(field, ...) OPTION_INT(card_options, field, __VA_ARGS__)
#define REAL(field, ...) OPTION_REAL(card_options, field, __VA_ARGS__)
#define WORD(field, ...) OPTION_REAL_WORD(card_options, field, __VA_ARGS__)
#define FLAG(field, ...) OPTION_FLAG(card_options, field, __VA_ARGS__)
#define CHOICE(field, ...) OPTION_CHOICE(card_options, field, __VA_ARGS__)

OPTIONS(units_options,
  NAME(units.length, "LENGTH", OPTION_ABSENT, "label, \"mm\""),
  NAME(units.force, "FORCE", OPTION_ABSENT, "label, \"N\""),
  NAME(units.time, "TIME", OPTION_ABSENT, "label, \"s\""));
OPTIONS(mesh_options,
  NAME(file, "FILE", NULL, ".msh or .geo, relative to the deck"),
  REAL(body.scale, "SCALE", DBL_MIN, DBL_MAX, "1", "-",
       "factor on all coordinates"));
OPTIONS(problem_options,
  NAME(file, "FILE", NULL,
       "FCLIB (HDF5) or a plain LCP (text), relative to the deck"),
  CHOICE(type, "TYPE", "FCLIB|LCP", OPTION_ABSENT,
         "absent: by the file itself"));
OPTIONS(name_options,
  NAME(name, "NAME", NULL, "name for other cards"));
OPTIONS(step_options,
  NAME(name, "NAME", OPTION_ABSENT, "name in the output"));
OPTIONS(elastic_options,
  CHOICE(type, "TYPE", ELASTIC_WORDS, "ISO", "symmetry of the material"),
  CHOICE(body.moduli, "MODULI", "LONG TERM|INSTANTANEOUS", OPTION_ABSENT,
         "with a Prony series: after all terms have relaxed, or at once; "
         "absent: LONG TERM with *VISCOELASTIC, INSTANTANEOUS with "
         "*INELASTIC"));
#define SHIFT_ROWS                                                            \
  CHOICE(shift.kind, "SHIFT", SHIFT_WORDS, "NONE",                            \
         "time-temperature shift: the rates are divided by a"),               \
  REAL(shift.reference, "T_REF", -DBL_MAX, DBL_MAX, OPTION_ABSENT,            \
       "temperature", "where a = 1"),                                         \
  REAL(shift.c1, "C1", 0, DBL_MAX, OPTION_ABSENT, "-",                        \
       "WLF: log10 a = -C1 (T - T_REF)/(C2 + T - T_REF)"),                    \
  REAL(shift.c2, "C2", DBL_MIN, DBL_MAX, OPTION_ABSENT, "temperature",        \
       "no flow below T_REF - C2"),                                           \
  REAL(shift.activation, "ACTIVATION", 0, DBL_MAX, OPTION_ABSENT,             \
       "temperature", "ARRHENIUS: Q/R in log a = Q/R (1/(T - T_ZERO) - "      \
       "1/(T_REF - T_ZERO))"),                                                \
  REAL(shift.zero, "T_ZERO", -DBL_MAX, DBL_MAX, OPTION_ABSENT, "temperature", \
       "absolute zero, -273.15 in Celsius; absent: 0")
OPTIONS(inelastic_options,
  NAME(law, "LAW", NULL, "protis --list materials"),
  SHIFT_ROWS);
OPTIONS(creep_options,
  CHOICE(type, "LAW", CREEP_WORDS, "STRAIN",
         "strain hardening, time hardening, m = 0, hyperbolic sine"),
  SHIFT_ROWS);
OPTIONS(viscoelastic_options,
  CHOICE(type, "TIME", "PRONY", NULL, "terms of a Prony series"),
  SHIFT_ROWS);
OPTIONS(trs_options,
  CHOICE(type, "DEFINITION", "WLF", "WLF", "log10 a = -C1 (T - T_REF)/(C2 + T "
         "- T_REF); others: SHIFT= of *INELASTIC, *VISCOELASTIC"));
OPTIONS(expansion_options,
  CHOICE(type, "TYPE", EXPANSION_WORDS, "ISO",
         "one coefficient, or one for each axis"),
  REAL(body.zero, "ZERO", -DBL_MAX, DBL_MAX, "0", "temperature",
       "from where the coefficients are secants"));
OPTIONS(initial_options,
  CHOICE(type, "TYPE", INITIAL_WORDS, NULL, "what the lines give"),
  NAME(file, "FILE", OPTION_ABSENT, "of displacements: JOB.h5 of a run on the "
       "same mesh; its end is the start, lines override it"),
  CHOICE(body.incompatible, "INCOMPATIBLE", "REFUSE|RELAX", "REFUSE",
         "displacements out of equilibrium at time 0 (CPR98 3.3): an error, or "
         "relaxed to it as increment 0"));
OPTIONS(section_options,
  NAME(body.elset, "ELSET", NULL, "group of elements"),
  NAME(body.material, "MATERIAL", NULL, "name of a *MATERIAL"),
  CHOICE(type, "TYPE", KINEMATICS_WORDS, OPTION_ABSENT,
         "absent: plane strain in 2-D"),
  REAL(body.thickness, "THICKNESS", DBL_MIN, DBL_MAX, "1", "length",
       "of plane strain and plane stress"),
  CHOICE(body.formulation, "FORMULATION", "STANDARD|AVERAGED", "STANDARD",
         "AVERAGED: change of volume averaged over clusters of elements, as "
         "far as nu exceeds 0.4, or all of it if the material flows: no "
         "locking"));
OPTIONS(obstacle_options,
  NAME(name, "NAME", NULL, "name for *CONTACT"),
  CHOICE(type, "TYPE", OBSTACLE_SHAPES, NULL, "shape"),
  REAL(radius, "RADIUS", DBL_MIN, DBL_MAX, OPTION_ABSENT, "length",
       "of cylinder and sphere"),
  CHOICE(surface.side, "SIDE", "OUTSIDE|INSIDE", "OUTSIDE",
         "where the body is"),
  NAME(amplitude, "AMPLITUDE", OPTION_ABSENT,
       "factor on MOVE and ROTATE in total time, whatever its TIME="));
OPTIONS(contact_options,
  NAME(name, "NAME", NULL, "name for *FRICTION"),
  NAME(group, "GROUP", NULL, "faces of Gamma_3"),
  NAME(surface.obstacle, "OBSTACLE", NULL, "name of an *OBSTACLE"),
  CHOICE(surface.normal, "NORMAL", "BODY|OBSTACLE", OPTION_ABSENT,
         "whose normal counts; absent: that of a PLANE, else that of the "
         "body"));
OPTIONS(pair_options,
  NAME(name, "NAME", NULL, "name for *FRICTION"),
  CHOICE(surface.slave, "SLAVE", SLAVE_WORDS, "AUTO",
         "which surface has the contact "
         "nodes; AUTO: the softer from a ratio of 3 on, else the coarser"),
  CHOICE(surface.normal, "NORMAL", "MEAN|SLAVE", "MEAN",
         "MEAN: of both surfaces"),
  CHOICE(surface.adjust, "ADJUST", "NO|YES", "NO",
         "YES: nodes of the slave are moved "
         "onto the master before the run, without strain"),
  CHOICE(surface.update, "UPDATE", "NO|STEP", "NO",
         "STEP: partners are found again at "
         "the start of each step, at the places the bodies have come to"),
  CHOICE(type, "TYPE", "SURFACE TO SURFACE", "SURFACE TO SURFACE",
         "mortar method; there is no other"),
  NAME(amplitude, "AMPLITUDE", OPTION_ABSENT,
       "factor on CLEARANCE or INTERFERENCE in total time, whatever its "
       "TIME="));
OPTIONS(crack_options,
  NAME(name, "NAME", NULL, "name for *FRICTION"),
  NAME(group, "GROUP", NULL,
       "faces inside the body (2-D: curves), which open"));
OPTIONS(tie_options,
  NAME(name, "NAME", NULL, "name for messages"),
  CHOICE(surface.slave, "SLAVE", SLAVE_WORDS, "AUTO",
         "whose nodes move with the "
         "other; AUTO: at a contact the finer, else as of a pair"),
  CHOICE(surface.adjust, "ADJUST", "NO|YES", "NO",
         "YES: nodes of the slave are moved "
         "onto the master before the run, without strain"));
OPTIONS(friction_options,
  NAME(contact, "CONTACT", NULL, "name of a *CONTACT"),
  NAME(law, "LAW", NULL, "protis --list friction"),
  NAME(amplitude, "AMPLITUDE", OPTION_ABSENT,
       "factor in total time, whatever the TIME= of the amplitude"),
  CHOICE(surface.table, "TABLE", "X|Y|Z|T", OPTION_ABSENT,
         "data lines are pairs coordinate (or total time), value"));
OPTIONS(force_options,
  NAME(contact, "CONTACT", NULL, "name of a *CONTACT"),
  NAME(amplitude, "AMPLITUDE", OPTION_ABSENT,
       "factor in total time, whatever the TIME= of the amplitude"),
  CHOICE(surface.table, "TABLE", "X|Y|Z|T", OPTION_ABSENT,
         "data lines are pairs coordinate (or total time), value"));
OPTIONS(wear_options,
  NAME(contact, "CONTACT", NULL, "name of a *CONTACT"),
  REAL(value[0], "COEFFICIENT", 0, DBL_MAX, NULL, "length^2/force",
       "k of Archard's law, depth = k p |slip|"));
OPTIONS(amplitude_options,
  NAME(name, "NAME", NULL, "name for AMPLITUDE="),
  CHOICE(time, "TIME", "STEP TIME|TOTAL TIME", "STEP TIME",
         "which time the table counts"));
OPTIONS(points_options,
  NAME(name, "NAME", NULL, "name for TIME POINTS="),
  CHOICE(time, "TIME", "STEP TIME|TOTAL TIME", "STEP TIME",
         "which time the points count"),
  FLAG(type, "GENERATE", "NO", "lines are first time, last time, interval"));
OPTIONS(quasistatic_options,
  CHOICE(type, "FORM", STEP_FORMS, "DISPLACEMENT",
         "unknown of an increment: N2 or N3 of CPR98, same solution"));
OPTIONS(visco_options,
  NAME(visco.integrator, "INTEGRATOR", NULL, "protis --list integrators"),
  REAL(visco.theta, "THETA", DBL_MIN, 1, "0.5", "-",
       "of INTEGRATOR=THETA: where in the step the rates are taken"),
  REAL(visco.tolerance, "TOLERANCE", 1e-12, 1, OPTION_ABSENT, "-",
       "error of inelastic strain in an increment over the largest elastic "
       "strain so far: increments are chosen by it; absent: dt"),
  CHOICE(visco.iteration, "ITERATION", "TANGENT|INITIAL", "TANGENT",
         "implicit steps of nonlinear laws: consistent tangent, or initial "
         "stress, which never factors again"),
  CHOICE(visco.substeps, "SUBSTEPS", "NO|AUTO", "NO",
         "AUTO cuts increments beyond "
         "the stability of an explicit integrator into 2, 4, 8, ..."));
OPTIONS(load_options,
  NAME(amplitude, "AMPLITUDE", OPTION_ABSENT,
       "course in time; absent: linear over the step"),
  CHOICE(op, "OP", "MOD|NEW", "MOD",
         "NEW ends what earlier steps gave by this card"));
OPTIONS(temperature_options,
  NAME(amplitude, "AMPLITUDE", OPTION_ABSENT,
       "course in time; absent: linear over the step"),
  CHOICE(op, "OP", "MOD|NEW", "MOD",
         "NEW ends what earlier steps gave by this card"),
  NAME(file, "FILE", OPTION_ABSENT, "nodal field: .msh with $NodeData, or HDF5 "
       "with /node_no and /temperature; relative to the deck"));
OPTIONS(solver_options,
  NAME(solver.method, "METHOD", "AUTO", "protis --list solvers"),
  WORD(tol, "TOL", 1e-14, 0.1, "1E-10", "-", "BALANCED",
       "residual of the contact to reach; BALANCED: stop when the error of the "
       "solver is SHARE of those of mesh and increments"),
  REAL(solver.share, "SHARE", 0.001, 1, "0.05", "-",
       "of the other errors, with TOL=BALANCED"),
  INT(solver.max_iter, "MAX_ITER", 0, 100000000, "0", "-",
      "iterations of the method, restarts and passes together; with AUTO of "
      "each method it tries; 0: its own limit"),
  INT(solver.limit_max_iter, "LIMIT_MAX_ITER", 1, 1000000, "1000", "-",
      "passes of the fixed point on the sliding limit"),
  CHOICE(solver.check, "CHECK", "NO|YES|ALL", "NO",
         "look for second solutions: YES "
         "with solvers of all families from several starts; ALL by all "
         "combinations of statuses, up to 10 contact nodes in 2-D"),
  CHOICE(solver.stiffness, "STIFFNESS", "AUTO|DENSE|FACTOR", "AUTO",
         "DENSE: the condensed matrix is formed; FACTOR: it is known by solves "
         "with the sparse matrix of the body; AUTO: the cheaper as expected "
         "(--check prints both)"),
  REAL(max_memory, "MAX_MEMORY", 0, 1e12, "0", "MB",
       "that STIFFNESS=AUTO keeps below; 0: 80 % of the memory"),
  FLAG(solver.nested, "NESTED", "NO",
       "first step: the first increment is solved on a "
       "mesh of elements twice as long before, whose contact is the start"));
OPTIONS(effects_options,
  CHOICE(type, "MODE", "CALLED|AUTO", "CALLED",
         "CALLED: all that the deck requires. AUTO: what is proved to change "
         "the solution by less than TOL is left out"),
  REAL(tol, "TOL", DBL_MIN, 0.1, "1e-3", "-",
       "for AUTO: of the energy norm and of the largest stress"));
OPTIONS(goal_options,
  CHOICE(goal.quantity, "QUANTITY", GOAL_QUANTITIES, NULL,
         "what is wanted; PRESSURE: the largest, or that at a point; WIDTH: of "
         "the closed zone; STRESS: mean of a group; SIF: stress intensity "
         "factor, the largest of a front, or that at a point"),
  NAME(name, "NAME", NULL, "name in the results"),
  NAME(contact, "CONTACT", OPTION_ABSENT,
       "of FORCE, PRESSURE, WIDTH, MOMENT: name of a *CONTACT"),
  NAME(goal.crack, "CRACK", OPTION_ABSENT, "of SIF: name of a *CRACK"),
  NAME(group, "GROUP", OPTION_ABSENT,
       "of STRESS: elements; of DISPLACEMENT: what it is the mean over"),
  NAME(goal.from, "FROM", OPTION_ABSENT,
       "of DISPLACEMENT: group whose mean is taken off"),
  CHOICE(goal.component, "COMPONENT", GOAL_COMPONENTS, OPTION_ABSENT,
         "of FORCE (NORMAL if absent), DISPLACEMENT, STRESS, of MOMENT the "
         "axis through the point (3 if absent in the plane), of SIF the mode"),
  REAL(radius, "RADIUS", DBL_MIN, DBL_MAX, OPTION_ABSENT, "length",
       "of the mean that PRESSURE is; half the half width of the zone if "
       "absent"),
  NAME(goal.target, "TARGET", OPTION_ABSENT, "error to reach by meshes refined "
       "for it: 1 %, of the value, or a number in its unit"));
OPTIONS(accuracy_options,
  CHOICE(accuracy.mesh, "MESH", "NO|YES|END", "END",
         "estimate of the error of the mesh, from recovered stresses: at each "
         "increment, or the last of the step"),
  CHOICE(time, "TIME", "NO|YES|BALANCED", "NO",
         "estimate of the error of the increments, from increments of half the "
         "length; BALANCED: increments whose error is a share of the mesh's"),
  REAL(accuracy.time_share, "TIME_SHARE", 0.001, 1, "0.1", "-",
       "of the error of the mesh, with TIME=BALANCED"),
  FLAG(accuracy.solver, "SOLVER", "YES",
       "bound of the error of the contact solver in the energy norm"),
  FLAG(accuracy.theorems, "THEORY", "NO",
       "limits of mu, bounds (3.9), (3.10) and inequality of CPR98"),
  REAL(accuracy.target, "TARGET", 0, 100, "0", "%",
       "error to reach by finer meshes and increments; 0: none"),
  REAL(accuracy.max_cpu, "MAX_CPU", 0, 1e12, "0", "s",
       "CPU time for that; 0: no limit"),
  REAL(max_memory, "MAX_MEMORY", 0, 1e12, "0", "MB",
       "memory for that; 0: no limit"),
  INT(accuracy.max_passes, "MAX_PASSES", 1, 20, "8", "-", "passes for that"));
#define PRINT_OPTION(name, help) \
  FLAG(output.print[PRINT_NUMBER_##name], #name, "NO", help),
OPTIONS(print_options,
  PRINT_LIST(PRINT_OPTION)
  INT(frequency, "FREQUENCY", 0, 1000000000, "1", "-",
      "every n-th increment and the last; 0: the last only"),
  NAME(group, "GROUP", OPTION_ABSENT, "nodes or elements of one group only"),
  NAME(output.points, "TIME POINTS", OPTION_ABSENT,
       "at these times, within increments too, in the place of FREQUENCY="));
OPTIONS(output_options,
  FLAG(output.hdf5, "HDF5", "YES", "write JOB.h5 and JOB.xdmf"),
  INT(frequency, "FREQUENCY", 0, 1000000000, "1", "-",
      "fields every n-th increment and the last; 0: the last only"),
  CHOICE(output.condensed, "CONDENSED", "NO|FCLIB", "NO",
         "condensed contact problem and its solution, every n-th increment, "
         "into JOB_condensed_NNNNN.h5 (increment counted from the start)"));
OPTIONS(restart_options,
  INT(frequency, "FREQUENCY", 0, 1000000000, "1", "-",
      "every n-th increment and the last; 0: the last only"));

const keyword keyword_table[] = {
  {"HEADING", IN_MODEL, NULL, NULL, apply_heading, 0, ANY,
   "text", "title of the run"},
  {"PARAMETER", LANGUAGE, NULL, NULL, NULL, 1, ANY,
   "NAME = value or expression", "names for <NAME>, handed to a .geo too"},
  {"INCLUDE", LANGUAGE, NULL, NULL, NULL, 0, 0,
   "", "INPUT=file: read another file here"},
  {"LEGACY", LANGUAGE, NULL, NULL, NULL, 0, 0,
   "", "FORMAT=(I5,3F10.0): the next data block stands in fixed columns"},
  {"UNITS", IN_MODEL, units_options, NULL, apply_units, 0, 0,
   "", "labels of the consistent set of units; changes no number"},
  {"MESH", IN_MODEL, mesh_options, NULL, apply_mesh, 0, 0,
   "", "gmsh mesh or geometry; its physical groups are the names below"},
  {"CONDENSED PROBLEM", IN_MODEL, problem_options, NULL,
   apply_condensed_problem, 0, 0,
   "", "discrete contact problem or LCP from a file in the place of a mesh"},
  {"MATERIAL", IN_MODEL, name_options, NULL, apply_material, 0, 0,
   "", "opens a material: *ELASTIC, *INELASTIC, *DENSITY below belong to it"},
  {"ELASTIC", IN_MATERIAL, elastic_options, NULL, apply_elastic, 1, ANY,
   "ISO E, nu; ORTHO E1, E2, E3, nu12, nu13, nu23, G12, G13, G23; "
   "ANISO 21 constants; each [, temperature]: linear between, constant outside",
   "elasticity a_ijkl (CPR98 2.2): symmetric and positive definite"},
  {"INELASTIC", IN_MATERIAL, inelastic_options, names_inelastic,
   apply_inelastic, 1, ANY,
   "coefficients of the law (protis --list materials) [, temperature]; each a "
   "number, or an expression of t in quotes",
   "inelastic law of CPR98 (3.14-3.16), flows in *VISCO steps"},
  {"CREEP", IN_MATERIAL, creep_options, NULL, apply_creep, 1, ANY,
   "A, n [, m] [, temperature]; HYPERB A, B, n [, dH, R] [, temperature]",
   "creep, the same as *INELASTIC, LAW=NORTON or LAW=HYPERBOLIC"},
  {"VISCOELASTIC", IN_MATERIAL, viscoelastic_options, NULL,
   apply_viscoelastic, 1, ANY,
   "g_i, k_i, tau_i [, temperature]",
   "Prony series, the same as *INELASTIC, LAW=PRONY"},
  {"TRS", IN_MATERIAL, trs_options, NULL, apply_trs, 1, 1,
   "T_REF, C1, C2",
   "time-temperature shift of the relaxation, the same as SHIFT=WLF"},
  {"DENSITY", IN_MATERIAL, NULL, NULL, apply_density, 1, 1,
   "rho", "mass per volume, for GRAV"},
  {"EXPANSION", IN_MATERIAL, expansion_options, NULL, apply_expansion, 1, ANY,
   "ISO alpha [, temperature]; ORTHO alpha1, alpha2, alpha3 [, temperature]",
   "thermal strain alpha(T) (T - ZERO), less its value at the initial T"},
  {"SOLID SECTION", IN_MODEL, section_options, NULL, apply_section, 0, 1,
   "[thickness]", "material and kinematics of a group of elements"},
  {"AMPLITUDE", IN_MODEL, amplitude_options, NULL, apply_amplitude, 1, ANY,
   "t, a pairs, any number a line; or one expression of t",
   "course of a load, a motion or a friction value in time"},
  {"TIME POINTS", IN_MODEL, points_options, NULL, apply_time_points, 1, ANY,
   "t, any number a line, ascending; with GENERATE first, last, interval",
   "times for tables of *PRINT; increments need not end there"},
  {"OBSTACLE", IN_MODEL, obstacle_options, NULL, apply_obstacle, 0, 4,
   "PLANE point; normal towards the body. CYLINDER point of the axis; "
   "direction (3-D). SPHERE centre. GAP value. Then MOVE, dx, dy, dz; "
   "ROTATE, x, y, angle (rad, about z) or ROTATE, x, y, z, ax, ay, az, angle",
   "rigid obstacle, may shift and turn; a number without AMPLITUDE= is reached "
   "at the end of the first step"},
  {"CONTACT", IN_MODEL, contact_options, NULL, apply_contact, 0, 1,
   "[AXIS, x, y (along z) or AXIS, x, y, z, ax, ay, az: of the torque]",
   "unilateral contact of Gamma_3 with an obstacle"},
  {"CONTACT PAIR", IN_MODEL, pair_options, NULL, apply_contact_pair, 1, 3,
   "surface, surface; then CLEARANCE, value or INTERFERENCE, value; AXIS as in "
   "*CONTACT",
   "unilateral contact of two bodies, or of two surfaces of one: groups of "
   "faces whose meshes need not match"},
  {"CRACK", IN_MODEL, crack_options, NULL, apply_crack, 0, 0, "",
   "opens the mesh along a group; its lips, the groups GROUP+ and GROUP-, are "
   "a contact pair"},
  {"TIE", IN_MODEL, tie_options, NULL, apply_tie, 1, 1, "surface, surface",
   "joins two surfaces whose meshes need not match"},
  {"FRICTION", IN_MODEL | IN_STEP, friction_options, names_law,
   apply_friction, 0, ANY,
   "mu or g: number, expression of x y z t, or pairs with TABLE=",
   "friction law of a contact; without it the contact is frictionless. In a "
   "step it replaces the old one from there on, at once"},
  {"INITIAL CONDITIONS", IN_MODEL, initial_options, NULL, apply_initial, 0,
   ANY, "TEMPERATURE group of elements, value. DISPLACEMENT group, dof, value. "
   "INELASTIC STRAIN group, component, value. INTERNAL group, number, value",
   "state before the first step; values not given are zero"},
  {"CONTACT FORCE", IN_MODEL, force_options, NULL, apply_contact_force, 0,
   ANY, "p >= 0, force/length^2: number, expression of x y z t, or pairs with "
   "TABLE=",
   "given normal force in the place of the unilateral condition (CPR98 3.19): "
   "p times the area of the node; the node may leave or enter the obstacle"},
  {"WEAR", IN_MODEL, wear_options, NULL, apply_effect, 0,
   0, "",
   "the body wears where it slides: from increment to increment the gap "
   "opens by COEFFICIENT times pressure times slip (Archard 1953)"},
  {"REFERENCE", IN_MODEL, NULL, NULL, apply_reference, 1, ANY,
   "u_x, u_y, u_z (all); stress_xx, _yy, _zz, _xy, _yz, _zx (all), in "
   "axisymmetry u_r, u_z, stress_rr, _zz, _tt, _rz; pressure: name, number or "
   "expression of x y z t",
   "the solution in closed form: the true error is shown with the estimates"},
  {"STEP", IN_MODEL, step_options, NULL, apply_step, 0, 0,
   "", "opens a step; loads stay from step to step until changed"},
  {"STATIC", IN_STEP, NULL, NULL, apply_static, 0, 1,
   "[duration, 1 if absent]",
   "one static problem: friction against the total displacement (P2/D2)"},
  {"QUASISTATIC", IN_STEP, quasistatic_options, NULL, apply_quasistatic, 1, 1,
   "dt, total [, dt_min [, dt_max]]",
   "increments S_i^n: friction against the displacement of each (N2)"},
  {"VISCO", IN_STEP, visco_options, NULL, apply_visco, 1, 1,
   "dt, total [, dt_min [, dt_max]]",
   "quasistatic increments in which inelastic strains flow"},
  {"BOUNDARY", IN_STEP | IN_MODEL, load_options, NULL, apply_boundary, 0, ANY,
   "group, first dof [, last dof [, value [, amplitude]]]",
   "supports, displacements; from those at the start of the step, linear"},
  {"DSLOAD", IN_STEP, load_options, NULL, apply_dsload, 0, ANY,
   "group, P or TX TY TZ, value [, amplitude]",
   "pressure (pushes into the body) or traction on faces"},
  {"DLOAD", IN_STEP, load_options, NULL, apply_dload, 0, ANY,
   "group, BX BY BZ, value [, amplitude]; or group, GRAV, g, gx, gy [, gz "
   "[, amplitude]]",
   "body force per volume, gravity"},
  {"CLOAD", IN_STEP, load_options, NULL, apply_cload, 0, ANY,
   "group, dof, value [, amplitude]", "force on each node of a group"},
  {"TEMPERATURE", IN_STEP, temperature_options, NULL, apply_temperature, 0,
   ANY, "group of elements, value [, amplitude]; with FILE= group "
   "[, factor [, amplitude]]",
   "temperatures; from those at the start of the step, linear over it"},
  {"SOLVER", IN_STEP, solver_options, names_solver, apply_solver, 0, 0,
   "", "method for the contact problem and its options"},
  {"ACCURACY", IN_STEP, accuracy_options, NULL, apply_accuracy, 0, 0,
   "", "error estimates"},
  {"GOAL", IN_MODEL, goal_options, NULL, apply_goal, 0, 2,
   "[x, y[, z]] of PRESSURE, DISPLACEMENT, MOMENT, SIF; of DISPLACEMENT a "
   "second, whose value is taken off",
   "a quantity whose value, error by the mesh and its band are wanted"},
  {"EFFECTS", IN_MODEL | IN_STEP, effects_options, NULL, apply_effects, 0, 0,
   "", "which effects of the deck are simulated; for all steps"},
  {"PRINT", IN_STEP, print_options, NULL, apply_print, 0, 0,
   "", "tables in JOB.dat"},
  {"OUTPUT", IN_STEP, output_options, NULL, apply_output, 0, 0,
   "", "fields in JOB.h5; condensed problems for other programs"},
  {"RESTART", IN_STEP, restart_options, NULL, apply_restart, 0, 0,
   "", "JOB.rst.h5 while the run goes on, for --restart; an interruption "
   "writes it without the card"},
  {"END STEP", IN_STEP, NULL, NULL, apply_end_step, 0, 0,
   "", "closes the step"},
  {NULL, 0, NULL, NULL, NULL, 0, 0, NULL, NULL}};
/* clang-format on */

const keyword *keyword_find(const char *name) {
  for (const keyword *k = keyword_table; k->name != NULL; ++k)
    if (strcmp(k->name, name) == 0) return k;
  return NULL;
}
