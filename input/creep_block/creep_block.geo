// Half of a block 80 x 40 mm on a rigid foundation, symmetric about x = 40.
//   N           segments of the contact line y = 0
//   STRUCTURED  0: unstructured, four times coarser at the top;
//               1: N x N squares cut along alternating diagonals
DefineConstant[ N = 32, STRUCTURED = 0 ];

L = 40;
h = L / N;
top = STRUCTURED ? h : 4 * h;

Point(1) = {0, 0, 0, h};
Point(2) = {L, 0, 0, h};
Point(3) = {L, L, 0, top};
Point(4) = {0, L, 0, top};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1 ... 4};
Plane Surface(1) = {1};

Transfinite Curve{1} = N + 1;
If (STRUCTURED)
  Transfinite Curve{2 ... 4} = N + 1;
  Transfinite Surface{1} AlternateLeft;
EndIf

Physical Surface("BODY") = {1};
Physical Curve("CONTACT") = {1};
Physical Curve("SYMMETRY") = {2};
Physical Curve("TOP") = {3};
Physical Curve("LEFT") = {4};
