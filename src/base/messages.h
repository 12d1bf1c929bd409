/*
 * Every message about the input: number, severity, title and advice. The
 * numbers never change their meaning; see message.h for the ranges.
 */
#ifndef PROTIS_BASE_MESSAGES_H
#define PROTIS_BASE_MESSAGES_H

/* clang-format off */
#define MESSAGE_LIST(X)                                                      \
  MESSAGE_LIST_DECK(X)                                                       \
  MESSAGE_LIST_MODEL(X)                                                      \
  MESSAGE_LIST_MESH(X)                                                       \
  MESSAGE_LIST_CONTACT(X)                                                    \
  MESSAGE_LIST_FILES(X)

#define MESSAGE_LIST_DECK(X)                                                 \
  X(1001, ERROR, "file of the deck cannot be read",                          \
    "Check the name and the permissions. The name in *INCLUDE is "           \
    "relative to the file it stands in.")                                    \
  X(1002, ERROR, "deck without a card",                                      \
    "The file holds no line that starts with a card such as *HEADING. "      \
    "Check that it is the deck and not, say, the mesh.")                     \
  X(1003, ERROR, "unknown card",                                             \
    "protis --keywords lists the cards. Names match in full, never by "      \
    "their beginning.")                                                      \
  X(1005, ERROR, "repeated parameter",                                       \
    "A parameter may stand once on a card. Keep the one that is meant.")     \
  X(1007, ERROR, "parameter without value",                                  \
    "Write a value after the equals sign, or the name alone if the "         \
    "parameter is a switch.")                                                \
  X(1008, ERROR, "empty parameter",                                          \
    "Two commas follow each other, or an equals sign has no name before "    \
    "it. Remove the comma or write what is missing.")                        \
  X(1009, ERROR, "card without a name",                                      \
    "A line that starts with * is a card and needs a name; a comment "       \
    "starts with **.")                                                       \
  X(1010, ERROR, "missing comma",                                            \
    "Card name and parameters are separated by commas: *CARD, "              \
    "NAME=VALUE, NAME=VALUE. A value that holds an equals sign stands "      \
    "in quotes.")                                                            \
  X(1011, ERROR, "quote not closed",                                         \
    "A value in quotes ends with a quote on the same line.")                 \
  X(1012, ERROR, "text next to a quoted value",                              \
    "A quote encloses the whole value, from comma to comma.")                \
  X(1013, ERROR, "NUL byte in the file",                                     \
    "The file is not plain text, or is stored as UTF-16. Save it as "        \
    "text (ASCII or UTF-8). Nothing after the byte is read.")                \
  X(1014, ERROR, "line too long",                                            \
    "A line holds at most 4096 characters. End it after a comma: the "       \
    "next line goes on.")                                                    \
  X(1015, ERROR, "data before the first card",                               \
    "The first line that is not a comment must be a card, as *HEADING. "     \
    "Only the first such line is reported.")                                 \
  X(1016, ERROR, "card does not go on",                                      \
    "A card that ends in a comma goes on in the next line. Remove the "      \
    "comma or write the parameter.")                                         \
  X(1017, ERROR, "file includes itself",                                     \
    "Directly or through other files an *INCLUDE names a file that is still "  \
    "being read. Remove the circular include.")                              \
  X(1018, ERROR, "too many includes",                                        \
    "Files may include each other 16 deep, and a deck may have 1000 "        \
    "includes in all.")                                                      \
  X(1019, ERROR, "no definition",                                            \
    "A line under *PARAMETER reads NAME = VALUE, where NAME is a letter "    \
    "followed by letters, digits and underscores, and VALUE a number or "    \
    "an expression.")                                                        \
  X(1020, ERROR, "unknown name",                                             \
    "<NAME> stands for a value that *PARAMETER or -D defined before. "       \
    "Check the spelling, or define it above.")                               \
  X(1021, ERROR, "name defined twice",                                       \
    "A name of *PARAMETER has one value. Remove one of the two "             \
    "definitions; -D NAME=VALUE replaces a value from outside.")             \
  X(1022, ERROR, "expression not valid",                                     \
    "An expression is made of numbers, x, y, z, t, pi, names of "            \
    "*PARAMETER, + - * / ^, comparisons, & and |, parentheses and "          \
    "functions such as sin(x) or if(a, b, c).")                              \
  X(1023, ERROR, "value not finite",                                         \
    "The expression divides by zero, takes the root or logarithm of a "      \
    "negative number, or overflows.")                                        \
  X(1024, ERROR, "not a number",                                             \
    "Numbers read 1, 1., .5, 1.5E3, 1.5D+03 or 1.5+03. An expression "       \
    "stands in quotes.")                                                     \
  X(1025, ERROR, "not an integer",                                           \
    "The field takes a whole number without point and exponent.")            \
  X(1026, ERROR, "definition on the command line not valid",                 \
    "Write -D NAME=VALUE, each NAME once.")                                  \
  X(1027, ERROR, "format not valid",                                         \
    "*LEGACY, FORMAT=(...) takes Iw, Fw.d, Ew.d, Dw.d, Gw.d, Aw and nX, "    \
    "repeat counts and groups in parentheses, as (I5,3F10.0), and at "       \
    "most 4096 columns.")                                                    \
  X(1028, ERROR, "fixed column field not valid",                             \
    "The columns that FORMAT names do not hold a number of that kind. "      \
    "Check that the columns are not shifted.")                               \
  X(1029, ERROR, "tab in fixed columns",                                     \
    "A tab has no fixed width: replace it by blanks.")                       \
  X(1030, WARNING, "text after the last fixed column",                       \
    "The format ends before the line does; what follows is not read. "       \
    "Widen the format if it should be.")                                     \
  X(1031, ERROR, "format without a data block",                              \
    "*LEGACY stands before the card whose data lines it describes. Add "     \
    "the card, or remove *LEGACY.")                                          \
  X(1033, ERROR, "too many parameters",                                      \
    "A card takes at most 64 parameters. Data belong on the lines below "    \
    "the card.")                                                             \
  X(1034, WARNING, "name of a variable",                                     \
    "x, y, z, t and pi have a meaning of their own in expressions. The "     \
    "value can be had as <NAME> only; a longer name avoids the ambiguity.")  \
  X(1035, ERROR, "comment inside a definition",                              \
    "** starts a comment. A power is written with ^.")                       \
  X(1036, ERROR, "exponent without a letter, or a sum",                      \
    "A number put in for <NAME> and the sign behind it would read as "       \
    "mantissa and exponent. Write an expression in quotes. 2.5-1 in the "    \
    "place of a value of *PARAMETER or -D can be 0.25 or 1.5: write "        \
    "2.5E-1, or 2.5 - 1.")                                                   \
  X(1037, ERROR, "empty field",                                              \
    "A number is needed here. Fields are separated by commas.")              \
  X(1038, ERROR, "text of an included file",                                 \
    "*INCLUDE reads cards, and data for the card before it. Text for "       \
    "*HEADING stands in the deck, or below a *HEADING in the file.")

#define MESSAGE_LIST_MODEL(X)                                                \
  X(2003, ERROR, "unknown parameter",                                        \
    "protis --keywords CARD lists the parameters of a card. Names match "    \
    "in full.")                                                              \
  X(2004, ERROR, "value of a parameter not valid",                           \
    "The message gives the range or the words allowed.")                     \
  X(2005, ERROR, "parameter missing",                                        \
    "Add it to the card; protis --keywords CARD explains it.")               \
  X(2006, ERROR, "card at the wrong place",                                  \
    "Cards of the model stand before the first *STEP, cards of a step "      \
    "between *STEP and *END STEP, cards of a material after its "            \
    "*MATERIAL.")                                                            \
  X(2007, ERROR, "data line missing",                                        \
    "protis --keywords CARD shows what the data lines hold.")                \
  X(2008, ERROR, "data line not expected",                                   \
    "Remove it, or put the card before it that it belongs to.")              \
  X(2009, ERROR, "wrong number of fields on a data line",                    \
    "Fields are separated by commas; protis --keywords CARD shows them.")    \
  X(2010, ERROR, "value on a data line not valid",                           \
    "The message gives the range allowed.")                                  \
  X(2011, ERROR, "defined twice",                                            \
    "Names are unique within their kind of card, whatever their case; of "   \
    "contacts and goals also in the tables, where a blank is _.")            \
  X(2012, ERROR, "name not defined",                                         \
    "Define it with the card named in the message, or correct the spelling.")  \
  X(2013, ERROR, "elastic constants not valid",                              \
    "The elasticity must be symmetric and positive definite (CPR98 "         \
    "2.2): for ISO E > 0 and -1 < nu < 0.5.")                                \
  X(2014, ERROR, "material incomplete",                                      \
    "Every material needs *ELASTIC; gravity needs *DENSITY as well.")        \
  X(2015, ERROR, "one *MESH card is needed",                                 \
    "*MESH, FILE=name.msh or name.geo")                                      \
  X(2016, ERROR, "no *SOLID SECTION",                                        \
    "*SOLID SECTION, ELSET=group, MATERIAL=name gives a group of "           \
    "elements its material.")                                                \
  X(2017, ERROR, "no *STEP",                                                 \
    "Add *STEP, a procedure (*STATIC or *QUASISTATIC) and *END STEP.")       \
  X(2018, ERROR, "a step needs one procedure",                               \
    "Write *STATIC or *QUASISTATIC once between *STEP and *END STEP.")       \
  X(2019, ERROR, "step not closed",                                          \
    "Write *END STEP after the last card of the step.")                      \
  X(2020, ERROR, "time increments not valid",                                \
    "0 < dt <= total, and not more than 1e8 increments.")                    \
  X(2021, ERROR, "group not in the mesh",                                    \
    "Names of physical groups keep their case; protis JOB --check lists "    \
    "them.")                                                                 \
  X(2022, ERROR, "group of the wrong dimension",                             \
    "Sections need elements; contacts, cracks, surface loads need faces.")     \
  X(2023, ERROR, "elements without a section, or with two",                  \
    "Every element of the mesh belongs to exactly one *SOLID SECTION.")      \
  X(2024, ERROR, "kinematics do not fit the mesh",                           \
    "Plane strain, plane stress and axisymmetric need triangles, 3D "        \
    "needs tetrahedra.")                                                     \
  X(2025, ERROR, "component does not exist",                                 \
    "Components are 1 and 2 in 2-D, 1 to 3 in 3-D.")                         \
  X(2026, ERROR, "axisymmetric and plane sections in one model",             \
    "Use one kind for all sections.")                                        \
  X(2027, ERROR, "direction is zero",                                        \
    "Give a vector of any length but zero.")                                 \
  X(2028, ERROR, "unknown load label",                                       \
    "The message lists the labels of the card.")                             \
  X(2029, ERROR, "table not ascending",                                      \
    "The first column of a table grows from pair to pair.")                  \
  X(2032, ERROR, "contact has two friction laws",                            \
    "One *FRICTION card for each contact.")                                  \
  X(2033, ERROR, "dependence not possible here",                             \
    "The message says on what the value may depend.")                        \
  X(2034, ERROR, "card not allowed with *CONDENSED PROBLEM",                 \
    "The file holds the whole problem. Allowed with it are only *HEADING, "  \
    "*UNITS, *PARAMETER, *INCLUDE and one step with *STATIC, *SOLVER, "      \
    "*PRINT, CONTACT and *OUTPUT, CONDENSED=FCLIB.")                         \
  X(2035, ERROR, "pressure inside a body",                                   \
    "A pressure acts on the boundary: a face with elements on both sides "   \
    "has no outside. TX, TY and TZ may act there.")                          \
  X(2036, WARNING, "defined but never used",                                 \
    "Nothing refers to the name. Is the reference missing, or another name " \
    "meant?")                                                                \
  X(2037, WARNING, "without effect here",                                    \
    "The parameter or value is read, but changes nothing. Remove it, or "    \
    "check whether another one is meant.")                                   \
  X(2038, WARNING, "two values for one displacement",                        \
    "Two groups of *BOUNDARY share nodes and prescribe different values; "   \
    "the later line counts. Make the values agree or part the groups.")      \
  X(2039, ERROR, "negative radius",                                          \
    "x is the radius of an axisymmetric model: the mesh must lie at "        \
    "x >= 0, with the axis at x = 0.")                                       \
  X(2040, WARNING, "given twice in one step",                                \
    "A later line of the same step gives the same load or support on the "   \
    "same group another value; the later line counts.")                      \
  X(2041, ERROR, "value at a node that is no number",                        \
    "An expression divides by zero there, takes the root or logarithm of "   \
    "a negative number, or overflows; or a friction value is negative.")     \
  X(2042, ERROR, "name that nothing uses",                                   \
    "A *PARAMETER or -D NAME=VALUE that neither the deck nor its .geo uses " \
    "changes nothing: check the spelling. In a .geo upper and lower case "   \
    "count; what is not needed is removed.")                                 \
  X(2043, ERROR, "obstacle cannot turn this way",                            \
    "In plane models ROTATE, x, y, angle turns about the point (x, y); "     \
    "torsion about an axis of symmetry needs a model in three dimensions.")  \
  X(2044, WARNING, "amplitude counts total time",                            \
    "Values of the model - friction, given contact forces, motions of "      \
    "obstacles - run in total time. Write TIME=TOTAL TIME on the "           \
    "*AMPLITUDE to say so.")                                                 \
  X(2045, ERROR, "friction law that does not fit the model",                 \
    "The message names the option. protis --list friction says what each is "  \
    "for.")                                                                  \
  X(2046, ERROR, "inelastic law not valid",                                  \
    "The coefficients do not fit each other or *ELASTIC. protis --list "     \
    "materials shows every law with its fields.")                            \
  X(2047, NOTE, "long-term moduli",                                          \
    "With *VISCOELASTIC the constants of *ELASTIC are those after all "      \
    "terms have relaxed, as in Abaqus. *ELASTIC, MODULI=INSTANTANEOUS "      \
    "makes them those at once.")                                             \
  X(2048, WARNING, "inelastic law that never flows",                         \
    "Inelastic strain grows in *VISCO steps only; the other steps, as in "   \
    "Abaqus, take the material as elastic. Use *VISCO, or remove the law.")  \
  X(2049, WARNING, "moduli without a temperature",                           \
    "Constants of *ELASTIC depend on temperature, but no card gives one, "   \
    "so those of 0 count. Give *INITIAL CONDITIONS, TYPE=TEMPERATURE.")      \
  X(2050, ERROR, "increment not stable",                                     \
    "An explicit integrator must not step over about two of the shortest "   \
    "relaxation times of the laws, or its errors grow. Take a smaller dt, "  \
    "SUBSTEPS=AUTO, or an implicit integrator: MIDPOINT, BACKWARD. Wear "    \
    "opens gaps after an increment and wants the dt of the message.")        \
  X(2051, WARNING, "stresses that ring",                                     \
    "With THETA < 1 parts that relax much faster than dt change sign from "  \
    "increment to increment and die out slowly. Where the law has a "        \
    "threshold they may end below it and stay wrong, as may a contact that " \
    "they open. Take a smaller dt, or INTEGRATOR=BACKWARD, which damps them " \
    "at once.")                                                              \
  X(2052, WARNING, "plane tilted far",                                       \
    "Displacements are small: contact acts along the normals of time 0. "    \
    "Start from the tilted plane, or turn it in its own plane.")             \
  X(2053, ERROR, "nodal field not valid",                                    \
    "FILE= of *TEMPERATURE names a .msh with $NodeData of one component, or "  \
    "HDF5 with /node_no and /temperature, with a value for each node of the "  \
    "mesh by its number in the mesh file.")                                  \
  X(2054, ERROR, "law without an exact step",                                \
    "INTEGRATOR=EXPONENTIAL needs linear laws whose coefficients do not "    \
    "depend on time or temperature. Take MIDPOINT or BACKWARD.")             \
  X(2055, WARNING, "nearly incompressible",                                  \
    "Linear triangles and tetrahedra are too stiff where nu is near 1/2. "   \
    "The figures are those of a tube under pressure on an unstructured "     \
    "mesh; pressures suffer far more than displacements. "                   \
    "FORMULATION=AVERAGED of *SOLID SECTION does not lock.")                 \
  X(2056, ERROR, "closed form not complete",                                 \
    "*REFERENCE compares whole fields: give all components of the "          \
    "displacement, or of the stress (0 where there is none), or neither.")   \
  X(2057, ERROR, "times of tables not valid",                                \
    "*TIME POINTS lists times that ascend; with GENERATE each line has the " \
    "first time, the last one and an interval above zero.")                  \
  X(2058, WARNING, "given without effect",                                   \
    "What the card gives changes nothing here. Heat works through "          \
    "*EXPANSION, *TRS or moduli over temperature; z varies in 3-D only (the "  \
    "axis of an axisymmetric model is y); times are counted from the start " \
    "of a step unless TIME=TOTAL TIME.")                                     \
  X(2059, WARNING, "displacement off the axis of symmetry",                  \
    "A point of the axis cannot move along the radius: the strain u_r/r "    \
    "would have no limit, and what is found depends on the mesh. Hold u_r "  \
    "at zero there.")                                                        \
  X(2060, ERROR, "surfaces of a pair with common faces",                     \
    "A *CONTACT PAIR or a *TIE is between two surfaces: physical groups of "  \
    "the mesh without a common face. For the lips of a crack give each lip a " \
    "group of its own.")                                                     \
  X(2061, ERROR, "condensed stiffness without entries",                      \
    "With STIFFNESS=FACTOR of *SOLVER the matrix is known by its products "  \
    "and solves alone. What is named needs its entries: write "              \
    "STIFFNESS=DENSE or AUTO, or leave that out; of the methods take "       \
    "METHOD=AUTO, NEWTON, AUGLAG, PROXIMAL, PCG or LAGRANGE.")               \
  X(2062, ERROR, "temperature not above absolute zero",                      \
    "Rates with an activation energy depend on the temperature above "       \
    "T_ZERO=, absolute zero, which is 0 if it is absent: T_ZERO=-273.15 "    \
    "for degrees Celsius. Where no card gives a temperature it is 0.")       \
  X(2063, ERROR, "inelastic strain that the units do not make",              \
    "The inelastic strain of KELVIN and PRONY is the sum of the strains of " \
    "their units, of a Prony series each times g_i and k_i. These are the "  \
    "internal variables, unit after unit. Give them by TYPE=INTERNAL, from " \
    "which TYPE=INELASTIC STRAIN follows; it is enough by itself with one "  \
    "unit.")

#define MESSAGE_LIST_MESH(X)                                                 \
  X(3001, ERROR, "mesh file cannot be read",                                 \
    "Check the name and the permissions. FILE= of *MESH is relative to "     \
    "the deck.")                                                             \
  X(3002, ERROR, "not a mesh of gmsh",                                       \
    "Give a .geo, or a .msh of version 2.2 or 4.1. In gmsh: File, "          \
    "Export, Mesh - Gmsh MSH; in a script: gmsh -2 -o name.msh -format "     \
    "msh41 name.geo.")                                                       \
  X(3003, ERROR, "gmsh cannot read or mesh the file",                        \
    "The message quotes gmsh. Open the file with gmsh itself to see "        \
    "the place; a file cut short must be written again.")                    \
  X(3004, WARNING, "warning of gmsh",                                        \
    "gmsh read or meshed the file, but was not content. Open it with "       \
    "gmsh itself to see the place.")                                         \
  X(3005, ERROR, "last line of the .geo does not end",                       \
    "gmsh reads only the first statement of a last line without "            \
    "newline. Add a newline at the end of the file.")                        \
  X(3006, ERROR, "damaged .msh file",                                        \
    "The message names file and line, or byte. Formats 2.2 and 4.1 of gmsh " \
    "are read, ASCII and binary, exactly as they are defined: counts, "      \
    "numbers and ends of sections. Write the file again; a file of another " \
    "program is converted by gmsh: gmsh -save -o new.msh old.msh.")          \
  X(3010, ERROR, "mesh without physical groups",                             \
    "Name the parts in the .geo: Physical Surface(\"BODY\") = {1}; "         \
    "(3-D: Physical Volume) for what is solid, Physical "                    \
    "Curve(\"FOOT\") = {3}; (3-D: Physical Surface) for its sides. "         \
    "Then mesh it again.")                                                   \
  X(3011, ERROR, "no physical group of surfaces or volumes",                 \
    "The groups name only points or curves: add Physical Surface (2-D) "     \
    "or Physical Volume (3-D) for what is solid and mesh again.")            \
  X(3012, ERROR, "name of a group repeated",                                 \
    "Names are unique over points, curves, surfaces and volumes. A "         \
    "group without a name is called by its number. Rename one of the "       \
    "two, or join them in one group.")                                       \
  X(3013, ERROR, "group without elements",                                   \
    "The geometry of the group is not meshed, or its elements are not "      \
    "saved. Mesh it to its dimension, or remove the group.")                 \
  X(3014, WARNING, "elements in no physical group",                          \
    "They are left out of the model. Add them to a Physical Surface "        \
    "(2-D) or Physical Volume (3-D) if they belong to the body.")            \
  X(3020, ERROR, "elements that are no triangles or tetrahedra",             \
    "Linear triangles and tetrahedra are needed. In the .geo remove "        \
    "Recombine, also inside of Extrude, and Mesh.RecombineAll; then mesh "   \
    "again.")                                                                \
  X(3021, ERROR, "elements of higher order",                                 \
    "Linear elements are needed: Mesh.ElementOrder = 1; in the .geo, "       \
    "or gmsh -order 1, and mesh again.")                                     \
  X(3022, ERROR, "elements without area or volume",                          \
    "Their corners are in one line (2-D) or plane (3-D) to rounding. "       \
    "Remesh there: coincident points, curves of length zero or a wrong "     \
    "transfinite count are usual reasons. Where the coordinates are out of " \
    "range, use other units, or SCALE= of *MESH.")                           \
  X(3023, ERROR, "coordinates that are no numbers",                          \
    "The file is damaged, or a formula of the geometry divides by "          \
    "zero. Write it again.")                                                 \
  X(3024, ERROR, "mesh of surfaces not in a plane z = const",                \
    "A 2-D mesh lies in x, y. Turn the geometry into that plane; for a "     \
    "3-D body add a Physical Volume.")                                       \
  X(3025, ERROR, "node that is not in the file",                             \
    "An element names a node that the file does not define. The file "       \
    "is damaged: write it again.")                                           \
  X(3026, NOTE, "elements listed twice",                                     \
    "They count once. Version 2.2 of the format lists an element once "      \
    "for each of its groups; version 4.1 does not.")                         \
  X(3027, ERROR, "mesh too large",                                           \
    "Up to 500 million nodes and elements can be numbered.")                 \
  X(3028, ERROR, "two elements with the same nodes",                         \
    "A group holds an element once. The file is damaged: write it again, "   \
    "or remove the surface or volume that is there twice.")                  \
  X(3029, ERROR, "number given twice",                                       \
    "Each node and each element has its own number. The file is damaged: "   \
    "write it again.")                                                       \
  X(3030, ERROR, "face of a group that bounds no element",                   \
    "The curves (2-D) or surfaces (3-D) of a group are sides of "            \
    "elements of the mesh. Remove construction lines from the group, "       \
    "or add the adjacent surface or volume to a group.")                     \
  X(3031, NOTE, "faces listed twice",                                        \
    "They count once. Version 2.2 of the format lists a face once for "      \
    "each of its groups; version 4.1 does not.")                             \
  X(3032, ERROR, "two elements on one side of a face",                       \
    "Elements overlap there: the same surface or volume is there "           \
    "twice, parts are merged that intersect, or a node was moved through "   \
    "the sides of its elements. Remesh there, or remove one of the parts.")  \
  X(3033, ERROR, "node of a group that is in no element",                    \
    "The points and curves of a group carry nodes of elements. Remove "      \
    "construction points from the group; a point inside a body needs "       \
    "Point{n} In Surface{m}; to be a node.")                                 \
  X(3034, ERROR, "elements that overlap",                                    \
    "They belong to one body or one group: a node was moved through the "    \
    "sides of its elements, a part is there twice, or parts are merged "     \
    "that intersect. Remesh there, or remove one of the parts.")             \
  X(3040, NOTE, "nodes that no element uses",                                \
    "They are left out: centres of circles and other construction "          \
    "points, or parts of the mesh in no group.")                             \
  X(3041, WARNING, "coincident nodes inside one body",                       \
    "Two nodes at one place are not joined: the body has a slit there. "     \
    "If it is not meant, add Coherence; or Coherence Mesh; to the "          \
    ".geo, or define the common curve once.")                                \
  X(3042, WARNING, "bodies that touch without being joined",                 \
    "Their nodes lie on each other but are not the same. If the bodies "     \
    "are one, add Coherence; (built-in kernel), BooleanFragments "           \
    "(OpenCASCADE) or Coherence Mesh; to the .geo.")                         \
  X(3043, WARNING, "bodies that overlap",                                    \
    "Two bodies fill the same place. Bodies do not touch each other in "     \
    "the computation: each is computed as if it were alone.")                \
  X(3050, ERROR, "face of a crack on the boundary",                          \
    "A crack opens faces with an element on both sides. Remove the curves "  \
    "(2-D) or surfaces (3-D) on the boundary of the body from the group.")   \
  X(3051, ERROR, "face of two cracks",                                       \
    "Each curve (2-D) or surface (3-D) belongs to one crack. Groups of "     \
    "different cracks may cross each other, but not cover each other.")      \
  X(3052, ERROR, "crack that opens no node",                                 \
    "The front of a crack stays closed; all nodes of the group are on it. "  \
    "Mesh the crack with several elements from one end to the other.")       \
  X(3053, ERROR, "crack surface that has one side only",                     \
    "A walk over the surface ends on the other side, as on the strip of "    \
    "Moebius, so that no lip can be told from the other. Make two cracks "   \
    "of it.")                                                                \
  X(3054, WARNING, "faces of a crack that stay closed",                      \
    "All nodes of these faces are on the front, which does not open: the "   \
    "front is behind them. Refine the mesh there.")                          \
  X(3055, NOTE, "group of nodes on a crack",                                 \
    "The group gets the nodes of all sides of the crack: a support holds, "  \
    "and a concentrated load acts on each of them. To hold or load one "     \
    "side, name a group of curves (2-D) or surfaces (3-D).")                 \
  X(3056, WARNING, "crack that branches",                                     \
    "A contact node has one normal for a lip, at a branch that of none: "    \
    "stresses there were wrong by a third on closed cracks, on any mesh. "   \
    "Give each line (2-D) or surface (3-D) a group and a *CRACK of its own; " \
    "a branch that stays open is right as it is.")

#define MESSAGE_LIST_CONTACT(X)                                              \
  X(4001, ERROR, "contact group is not made of boundary faces",              \
    "GROUP= of *CONTACT names curves (2-D) or surfaces (3-D) on the boundary " \
    "of a body, with an element on one side only.")                          \
  X(4002, WARNING, "contact nodes fixed in the normal direction",            \
    "*BOUNDARY already prescribes the motion towards the obstacle: these "   \
    "nodes are left out of the contact.")                                    \
  X(4003, NOTE, "contact nodes that the obstacle cannot reach",              \
    "The line along the outward normal does not meet the obstacle: these "   \
    "nodes are left out of the contact.")                                    \
  X(4004, WARNING, "body penetrates the obstacle at the start",              \
    "The negative gap is part of the problem and is closed in the first "    \
    "increment. Move the body or the obstacle if that is not meant.")        \
  X(4005, WARNING, "no friction where two contacts meet",                    \
    "A node that touches two obstacles at once is held by both without "     \
    "friction; the other nodes of the contact keep their law.")              \
  X(4006, ERROR, "contacts of one node are not independent",                 \
    "The normals of the contacts that share a node must differ in "          \
    "direction. Give both contacts the same obstacle, or part their groups.")  \
  X(4007, ERROR, "gap is not a number",                                      \
    "The expression of the gap or of the motion of the obstacle must have "  \
    "a value at every contact node at the start.")                           \
  X(4008, ERROR, "contact node without outward normal",                      \
    "The faces around the node cancel, as at the tip of a fin without "      \
    "thickness. Leave them out of the contact group.")                       \
  X(4009, ERROR, "sphere off the axis of symmetry, or ring on it",           \
    "In an axisymmetric model a SPHERE has its centre on the axis, r = 0; a "  \
    "CYLINDER is a ring, whose circle has its centre at r > 0. A shaft of "    \
    "radius R is a PLANE through (R, 0) with the normal (1, 0), a bore one "   \
    "with (-1, 0).")                                                           \
  X(4010, ERROR, "contact without a node",                                   \
    "The body cannot touch the obstacle: check the group, where the "        \
    "obstacle is, that the normal of a plane points towards the body, and "  \
    "whether the body is inside or outside of a cylinder or sphere.")        \
  X(4011, ERROR, "body free to move",                                        \
    "Neither *BOUNDARY nor contact holds the body against the motion named; "  \
    "a contact without friction does not hold it along the obstacle. Add "   \
    "a support, or friction.")                                               \
  X(4012, ERROR, "given force at a corner of two contacts",                  \
    "*CONTACT FORCE knows one normal at a node. Part the groups, or give "   \
    "both contacts the same obstacle and a smooth surface.")                 \
  X(4013, WARNING, "mesh too coarse for the nonlocal average",               \
    "LAW=NONLOCAL is accurate to 1 % where the edges of the contact are at " \
    "most RADIUS/4 long; nodes farther than RADIUS from all others have "    \
    "local friction. Refine the contact, or raise RADIUS.")                  \
  X(4014, ERROR, "initial displacements are not compatible",                 \
    "They must be in equilibrium with the loads at time 0, under the "       \
    "unilateral and the friction condition (CPR98 3.3; 3.26 with e^i_0 or "  \
    "given forces). Loads without "                                          \
    "AMPLITUDE= start from zero: one that is there at once has an amplitude "  \
    "or an expression of t. INCOMPATIBLE=RELAX takes the equilibrium of "    \
    "time 0 that is next to them.")                                          \
  X(4015, ERROR, "displacement prescribed against friction along one tangent", \
    "In 3-D the direction of slip depends on both tangential motions. "      \
    "Prescribe both, or none, at the nodes of a contact with friction.")     \
  X(4016, WARNING, "made nearly incompressible by creep",                    \
    "A body that creeps loses its shear stiffness and keeps its volume: "    \
    "linear triangles and tetrahedra become too stiff as near nu = 1/2 "     \
    "(P2055). FORMULATION=AVERAGED of *SOLID SECTION does not lock.")        \
  X(4017, WARNING, "element without a state at the end of an increment",     \
    "The rates of the law grow so fast with the stress that its equations "  \
    "cannot be solved over this increment. Let dt_min of *VISCO be smaller, "  \
    "so that increments are cut further, or give the law a smaller exponent "  \
    "n or a larger K: what is left of (stress/K)^n must be a number.")       \
  X(4018, NOTE, "normals of a curved body differ from those of the obstacle",  \
    "The faces around a node have their mean as normal, which differs from " \
    "that of a cylinder or sphere they lie on where they differ in size or " \
    "shape: normal forces then have a part along the obstacle, and a torque "  \
    "about its axis. Write NORMAL=OBSTACLE on *CONTACT, or refine the mesh " \
    "evenly. A flat body on a roller is better served by its own normals.")  \
  X(4019, WARNING, "strains that are not small",                             \
    "Strains and displacements are taken as small: the answer is wrong by "  \
    "about the strain. Check the units (GPa for MPa, mm for m) and the "     \
    "loads; creep strains grow with time. Reported once a run, when the "    \
    "root of the sum of the squares of the components first exceeds 5 %.")   \
  X(4020, WARNING, "element turned inside out by the displacements",         \
    "The displacements are larger than the element: no state of small "      \
    "strains. Check the units of moduli, loads and lengths.")                \
  X(4021, WARNING, "contact that never touched",                             \
    "No node of the contact touched its obstacle at the end of an "          \
    "increment. If it should have: check the point, normal and GAP of "      \
    "*OBSTACLE, at the GROUP, the signs of the loads and their size. The "   \
    "listing says in which increment a contact touches for the first time.") \
  X(4022, WARNING, "supports hold a part of the contact normal",             \
    "A contact node that *BOUNDARY holds in one direction moves in the "     \
    "others alone, and its contact force is that of the normal without the " \
    "held component: the rest is in the reaction. Where that is not meant, " \
    "hold the body away from the contact, or turn the axes so that the "     \
    "obstacle lies along them.")                                             \
  X(4023, ERROR, "surfaces of a pair that do not face each other",           \
    "No face of the one surface meets a face of the other along its normal: " \
    "check the groups, and the places of the bodies in the mesh. Bodies that " \
    "only come to face each other by large motions are not treated.")        \
  X(4024, WARNING, "master much coarser than the slave",                     \
    "The nodes of the slave show the faces of the master: pressures scatter. " \
    "Choose the other side with SLAVE=, or refine the master.")              \
  X(4025, WARNING, "nodes of a tie without partner",                         \
    "They are not tied: the master surface ends before them, or does not "   \
    "face them. Choose the other side with SLAVE=, or extend the group.")    \
  X(4026, ERROR, "ADJUST=YES turns elements inside out",                     \
    "The surfaces are further apart than the elements at the slave: place "  \
    "the bodies nearer to each other, or leave ADJUST=YES out.")             \
  X(4027, ERROR, "pairs that move with each other in a circle",              \
    "A slave node follows the nodes of its master. Where bodies meet at one "  \
    "corner, each the slave of the next, no node of the corner is left that "  \
    "the others follow: give one of the pairs the other side as slave, with "  \
    "SLAVE=FIRST or SECOND. Cracks that meet in a corner: one *CRACK for "   \
    "both.")                                                                 \
  X(4028, WARNING, "crack that ends between two materials",                  \
    "The stress oscillates there: it has no stress intensity factors. The "  \
    "table SIF gives the energy release rate alone.")                        \
  X(4029, WARNING, "no space for the domain of a stress intensity factor",   \
    "The factors come from rings of elements round the tip. Refine the mesh " \
    "there, so that several elements are between it and what is near.")      \
  X(4030, WARNING, "interference as small as the gaps of facets",            \
    "Two meshes of one curved surface have facets at different places: they " \
    "are apart here and enter each other there by about h^2/8R, which adds "  \
    "to the interference. ADJUST=YES on *CONTACT PAIR takes it away.")        \
  X(4031, WARNING, "slave that supports hold, and its master not",            \
    "What supports hold of a slave node is relative to its place. The master " \
    "that moves along it is not seen to slide, and has no friction; where "   \
    "the normal leans, nor is it seen to come nearer. Choose the other "      \
    "side with SLAVE=, or hold the body away from the contact.")              \
  X(4032, WARNING, "tie that supports open",                                  \
    "A component of a slave node that a support holds does not follow the "   \
    "master: the tie is open there. Choose the other side with SLAVE=, or "   \
    "let the support hold the nodes of both.")                               \
  X(4033, WARNING, "faces of a slave with only tied nodes",              \
    "A tied node has no contact; its neighbours on the face carry its part, " \
    "and here there are none. Refine the surface, or choose the other side "  \
    "of the *TIE or the *CONTACT PAIR with SLAVE=.")                         \
  X(4034, NOTE, "masters that meet within a face of the slave",               \
    "The nodes of the face have one contact with both masters, right while "  \
    "these stay level; they belong to the first pair. Where the masters move " \
    "apart, mesh the slave so that one of its nodes is at the joint.")       \
  X(4035, WARNING, "tie of coarse slave that meets a contact",                \
    "The contact force of a tied node acts on all masters it moves with, "    \
    "those within the body too, as no pressure does: stresses at the joint "  \
    "were wrong by up to 30 % on any mesh. With the finer surface as slave "  \
    "of the *TIE (SLAVE=), or meshes that match, they are right.")           \
  X(4036, WARNING, "friction of nodes that supports move",                    \
    "The force of a contact node along what a support prescribes is that of " \
    "the support, which has no law of friction: what the node drags, and the " \
    "work of it, is missing. Move the body at other nodes, or the obstacle "  \
    "or the other body.")

#define MESSAGE_LIST_FILES(X)                                                \
  X(5001, ERROR, "file of a condensed problem cannot be read",               \
    "Check the name and the permissions. FILE= of *CONDENSED PROBLEM is "    \
    "relative to the deck. A file cut short must be written again.")         \
  X(5002, ERROR, "condensed problem not valid",                              \
    "The message names the dataset. The layout is that of FCLIB: "           \
    "/fclib_local with spacedim, W, vectors/q, vectors/mu, or "              \
    "/fclib_global with spacedim, M, H, vectors/f, w, mu. As text: n, the "  \
    "matrix by rows, q.")                                                    \
  X(5003, ERROR, "end of another run cannot be the start",                   \
    "FILE= of *INITIAL CONDITIONS is the JOB.h5 of a run that ended, on the "  \
    "same mesh; the name is relative to the deck. Write the results of this "  \
    "run elsewhere if both have one name.")                                  \
  X(5020, WARNING, "more threads than cores",                                \
    "Threads beyond the cores that affinity and control group leave to the " \
    "process wait for each other: as many threads as cores are used; one "   \
    "where ulimit -v leaves no memory for the buffers of more.")             \
  X(5021, ERROR, "file that --safe does not read",                           \
    "With --safe a mesh is a .msh: a .geo is a program that may do "         \
    "anything. Mesh it before, if its author is trusted.")
/* clang-format on */

#endif
