// Cross-section of a ring, radii 10 and 10.5, height 1; N cells along a height.
DefineConstant[ N = 8 ];
Point(1) = {10, 0, 0};
Point(2) = {10.5, 0, 0};
Point(3) = {10.5, 1, 0};
Point(4) = {10, 1, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Transfinite Curve{1, 3} = N / 2 + 1;
Transfinite Curve{2, 4} = N + 1;
Curve Loop(1) = {1 ... 4};
Plane Surface(1) = {1};
Transfinite Surface{1} Alternated;
Physical Curve("SEAT") = {1};
Physical Curve("LIP") = {3};
Physical Surface("RING") = {1};
