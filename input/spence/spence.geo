// Quarter of a disc, x >= 0 and y >= 0, whose side y = 0 touches a parabola:
// half of a half plane, cut off at the radius SIZE half-widths.
//   A        half-width of the contact that is expected
//   SIZE     radius, in half-widths
//   NC       segments per half-width, up to 1.2 half-widths
//   GROWTH   growth of the segments with the distance from there
DefineConstant[ A = 0.2348908547, SIZE = 30, NC = 64, GROWTH = 0.08 ];

h = A / NC;
L = SIZE * A;

Point(1) = {0, 0, 0};
Point(2) = {1.2 * A, 0, 0};
Point(3) = {2 * A, 0, 0};
Point(4) = {L, 0, 0};
Point(5) = {0, L, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Circle(4) = {4, 1, 5};
Line(5) = {5, 1};
Curve Loop(1) = {1 ... 5};
Plane Surface(1) = {1};

Transfinite Curve{1} = Ceil(1.2 * NC) + 1;
Transfinite Curve{4} = 81;
Field[1] = Distance;
Field[1].CurvesList = {1};
Field[1].NumPointsPerCurve = 200;
Field[2] = MathEval;
Field[2].F = Sprintf("%g + %g * Max(F1 - %g, 0)", h, GROWTH, A);
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Physical Surface("BODY") = {1};
Physical Curve("CONTACT") = {1, 2};
Physical Curve("FAR") = {4};
Physical Curve("SYMMETRY") = {5};
