// Whole disc of radius R between the lines y = 0 and y = 2 R.
//   R        radius
//   A        half-width of the contacts that is expected
//   NC       segments per half-width, on arcs of 1.5 half-widths to each side
//   GROWTH   growth of the segments with the distance from there
//   REACH    length of the arcs that may touch, in half-widths to each side
DefineConstant[ R = 10, A = 0.2348908547, NC = 12, GROWTH = 0.2, REACH = 4 ];

h = A / NC;
fine = 1.5 * A / R;
reach = REACH * A / R;

Point(1) = {0, R, 0};
Point(2) = {0, 0, 0};
Point(3) = {R * Sin(fine), R * (1 - Cos(fine)), 0};
Point(4) = {R * Sin(reach), R * (1 - Cos(reach)), 0};
Point(5) = {R, R, 0};
Point(6) = {R * Sin(reach), R * (1 + Cos(reach)), 0};
Point(7) = {R * Sin(fine), R * (1 + Cos(fine)), 0};
Point(8) = {0, 2 * R, 0};
Point(9) = {-R * Sin(fine), R * (1 + Cos(fine)), 0};
Point(10) = {-R * Sin(reach), R * (1 + Cos(reach)), 0};
Point(11) = {-R, R, 0};
Point(12) = {-R * Sin(reach), R * (1 - Cos(reach)), 0};
Point(13) = {-R * Sin(fine), R * (1 - Cos(fine)), 0};
For k In {2 : 12}
  Circle(k) = {k, 1, k + 1};
EndFor
Circle(13) = {13, 1, 2};
Line(14) = {2, 1};
Line(15) = {1, 8};
Curve Loop(1) = {2 ... 7, -15, -14};
Curve Loop(2) = {8 ... 13, 14, 15};
Plane Surface(1) = {1};
Plane Surface(2) = {2};

Transfinite Curve{2, 7, 8, 13} = Ceil(1.5 * NC) + 1;
Field[1] = Distance;
Field[1].CurvesList = {2, 7, 8, 13};
Field[1].NumPointsPerCurve = 200;
Field[2] = MathEval;
Field[2].F = Sprintf("%g + %g * Max(F1 - %g, 0)", h, GROWTH, A);
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Physical Surface("BODY") = {1, 2};
Physical Curve("FOOT") = {2, 3, 12, 13};
Physical Curve("HEAD") = {6, 7, 8, 9};
Physical Curve("AXIS") = {14, 15};
