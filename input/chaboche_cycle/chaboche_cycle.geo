// Unit square, N segments on each side.
DefineConstant[ N = 2 ];
h = 1 / N;
Point(1) = {0, 0, 0, h};
Point(2) = {1, 0, 0, h};
Point(3) = {1, 1, 0, h};
Point(4) = {0, 1, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1 ... 4};
Plane Surface(1) = {1};
Physical Curve("BOTTOM") = {1};
Physical Curve("TOP") = {3};
Physical Curve("LEFT") = {4};
Physical Surface("BODY") = {1};
