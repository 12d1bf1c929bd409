// Rectangle SIZE A x SIZE A above the line y = 0, symmetric about x = 0.
//   A      half-width of the contact
//   SIZE   width and height, in half-widths; the contact may reach 2 A
//   N      segments per half-width, everywhere
DefineConstant[ A = 0.2348908547, SIZE = 4, N = 4 ];

L = SIZE * A;
h = A / N;

Point(1) = {0, 0, 0, h};
Point(2) = {2 * A, 0, 0, h};
Point(3) = {L, 0, 0, h};
Point(4) = {L, L, 0, h};
Point(5) = {0, L, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 1};
Curve Loop(1) = {1 ... 5};
Plane Surface(1) = {1};

Physical Surface("BODY") = {1};
Physical Curve("CONTACT") = {1};
Physical Curve("SIDE") = {3};
Physical Curve("TOP") = {4};
Physical Curve("SYMMETRY") = {5};
