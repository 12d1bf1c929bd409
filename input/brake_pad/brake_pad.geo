// Brake pad: a lining of length L and height H, on a backing plate of thickness
// D. The trailing end of the plate leans on an abutment in the middle of D.
//   N  segments along the lining
DefineConstant[ L = 60, H = 12, D = 6, N = 48 ];
Point(1) = {-L / 2, 0, 0};
Point(2) = {L / 2, 0, 0};
Point(3) = {L / 2, H, 0};
Point(4) = {L / 2, H + D / 2, 0};
Point(5) = {L / 2, H + D, 0};
Point(6) = {-L / 2, H + D, 0};
Point(7) = {-L / 2, H, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 7};
Line(7) = {7, 1};
Line(8) = {7, 3};
Curve Loop(1) = {1, 2, -8, 7};
Curve Loop(2) = {8, 3, 4, 5, 6};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
MeshSize{1, 2} = L / N;
MeshSize{3 ... 7} = 3 * L / N;
Physical Surface("LINING") = {1};
Physical Surface("PLATE") = {2};
Physical Curve("FACE") = {1};
Physical Curve("BACK") = {5};
Physical Point("ABUTMENT") = {4};
