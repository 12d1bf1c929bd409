// Lower half of a disc of radius R that stands on the line y = 0, cut along its
// horizontal diameter.
//   A      half-width of the contact that is expected
//   NC     segments per half-width, on an arc of 1.5 half-widths on each side
//   GROWTH growth of the segments with the distance from there
DefineConstant[ R = 10, A = 0.2348908547, NC = 32, GROWTH = 0.2 ];

h = A / NC;
s = R * Sin(1.5 * A / R);
c = R * (1 - Cos(1.5 * A / R));

Point(1) = {0, R, 0};
Point(2) = {-R, R, 0};
Point(3) = {-s, c, 0};
Point(4) = {s, c, 0};
Point(5) = {R, R, 0};
Point(6) = {-R * Sin(Pi / 4), R * (1 - Cos(Pi / 4)), 0};
Point(7) = {R * Sin(Pi / 4), R * (1 - Cos(Pi / 4)), 0};
Circle(1) = {6, 1, 3};
Circle(2) = {3, 1, 4};
Circle(3) = {4, 1, 7};
Circle(4) = {7, 1, 5};
Line(5) = {5, 1};
Line(6) = {1, 2};
Circle(7) = {2, 1, 6};
Curve Loop(1) = {1 ... 7};
Plane Surface(1) = {1};

Transfinite Curve{2} = 3 * NC + 1;
Field[1] = Distance;
Field[1].CurvesList = {2};
Field[1].NumPointsPerCurve = 400;
Field[2] = MathEval;
Field[2].F = Sprintf("%g + %g * Max(F1 - %g, 0)", h, GROWTH, A);
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Physical Surface("BODY") = {1};
Physical Curve("CONTACT") = {2};
Physical Curve("TOP") = {5, 6};
Physical Curve("GUIDE") = {4, 7};
