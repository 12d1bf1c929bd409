// Block L x H on the line y = 0, unstructured, N segments along its base.
DefineConstant[ N = 32, L = 80, H = 40 ];

h = L / N;
Point(1) = {0, 0, 0, h};
Point(2) = {L, 0, 0, h};
Point(3) = {L, H, 0, h};
Point(4) = {0, H, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1 ... 4};
Plane Surface(1) = {1};
Transfinite Curve{1} = N + 1;

Physical Surface("BODY") = {1};
Physical Curve("BOTTOM") = {1};
Physical Curve("RIGHT") = {2};
Physical Curve("TOP") = {3};
Physical Curve("LEFT") = {4};
