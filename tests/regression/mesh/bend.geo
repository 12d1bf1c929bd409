// Beam [-2, 2] x [0, 1] with a crack from (0, 0) to (0, 1/2), segments of the
// length 1/N at its tip; upper and lower half of the middle part as materials.
DefineConstant[ N = 80, GROWTH = 0.05 ];
Point(1) = {-2.1, 0, 0};
Point(2) = {-2, 0, 0};
Point(3) = {0, 0, 0};
Point(4) = {2, 0, 0};
Point(5) = {2.1, 0, 0};
Point(6) = {2.1, 1, 0};
Point(7) = {0, 1, 0};
Point(8) = {-2.1, 1, 0};
Point(9) = {0, 0.5, 0};
For i In {1 : 8}
  Line(i) = {i, i % 8 + 1};
EndFor
Line(9) = {3, 9};
Line(10) = {9, 7};
Curve Loop(1) = {1, 2, 9, 10, 7, 8};
Curve Loop(2) = {3, 4, 5, 6, -10, -9};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Field[1] = Distance;
Field[1].PointsList = {9};
Field[2] = MathEval;
Field[2].F = Sprintf("%g + %g * F1", 1 / N, GROWTH);
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Physical Surface("PLATE") = {1, 2};
Physical Surface("ONE") = {1};
Physical Surface("OTHER") = {2};
Physical Curve("LINE") = {9};
Physical Point("LEFT") = {2};
Physical Point("RIGHT") = {4};
Physical Point("TOP") = {7};
