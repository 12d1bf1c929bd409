// Square [-W, W]^2 with the crack from (-1, 0) to (1, 0), turned by ANGLE
// degrees; segments of the length 1/N at the tips, growing with the distance.
DefineConstant[ W = 20, N = 50, ANGLE = 30, GROWTH = 0.12 ];
c = Cos(ANGLE * Pi / 180);
s = Sin(ANGLE * Pi / 180);
Point(1) = {-W, -W, 0};
Point(2) = {W, -W, 0};
Point(3) = {W, W, 0};
Point(4) = {-W, W, 0};
For i In {1 : 4}
  Line(i) = {i, i % 4 + 1};
EndFor
Point(5) = {-c, -s, 0};
Point(6) = {c, s, 0};
Line(5) = {5, 6};
Curve Loop(1) = {1 ... 4};
Plane Surface(1) = {1};
Curve{5} In Surface{1};
Field[1] = Distance;
Field[1].PointsList = {5, 6};
Field[2] = MathEval;
Field[2].F = Sprintf("%g + %g * F1", 1 / N, GROWTH);
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Physical Surface("PLATE") = {1};
Physical Curve("LINE") = {5};
Physical Curve("BOTTOM") = {1};
Physical Curve("RIGHT") = {2};
Physical Curve("TOP") = {3};
Physical Curve("LEFT") = {4};
Physical Point("PIN") = {1};
Physical Point("END") = {2};
