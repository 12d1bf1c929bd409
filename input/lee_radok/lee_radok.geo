// Quarter of a disc of radius R that stands on the line y = 0; symmetric about
// x = 0, cut along its horizontal diameter.
//   R        radius
//   A        half-width of the contact that is expected
//   NC       segments per half-width, on an arc of 1.5 half-widths
//   GROWTH   growth of the segments with the distance from there
//   REACH    length of the arc that may touch, in half-widths
DefineConstant[ R = 10, A = 0.2348908547, NC = 16, GROWTH = 0.15, REACH = 4 ];

h = A / NC;
fine = 1.5 * A / R;
reach = REACH * A / R;

Point(1) = {0, R, 0};
Point(2) = {0, 0, 0};
Point(3) = {R * Sin(fine), R * (1 - Cos(fine)), 0};
Point(4) = {R * Sin(reach), R * (1 - Cos(reach)), 0};
Point(5) = {R, R, 0};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Circle(3) = {4, 1, 5};
Line(4) = {5, 1};
Line(5) = {1, 2};
Curve Loop(1) = {1 ... 5};
Plane Surface(1) = {1};

Transfinite Curve{1} = Ceil(1.5 * NC) + 1;
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
Physical Curve("TOP") = {4};
Physical Curve("SYMMETRY") = {5};
