// Half of a disc, y >= 0, whose side y = 0 touches a roller: the half plane,
// cut off at the radius SIZE half-widths.
//   A        half-width of the contact that is expected
//   SIZE     radius, in half-widths
//   NC       segments per half-width, up to 1.4 half-widths on each side
//   GROWTH   growth of the segments with the distance from there
DefineConstant[ A = 0.2348908547, SIZE = 20, NC = 40, GROWTH = 0.1 ];

h = A / NC;
L = SIZE * A;

Point(1) = {0, 0, 0};
Point(2) = {-L, 0, 0};
Point(3) = {-1.4 * A, 0, 0};
Point(4) = {1.4 * A, 0, 0};
Point(5) = {L, 0, 0};
Point(6) = {0, L, 0};
Line(1) = {2, 3};
Line(2) = {3, 1};
Line(3) = {1, 4};
Line(4) = {4, 5};
Circle(5) = {5, 1, 6};
Circle(6) = {6, 1, 2};
Curve Loop(1) = {1 ... 6};
Plane Surface(1) = {1};

Transfinite Curve{2, 3} = Ceil(1.4 * NC) + 1;
Transfinite Curve{5, 6} = 41;
Field[1] = Distance;
Field[1].CurvesList = {2, 3};
Field[1].NumPointsPerCurve = 400;
Field[2] = MathEval;
Field[2].F = Sprintf("%g + %g * Max(F1 - %g, 0)", h, GROWTH, A);
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Physical Surface("BODY") = {1};
Physical Curve("CONTACT") = {2, 3};
Physical Curve("FAR") = {5, 6};
