// Rectangle [0, LX] x [0, LY], N segments on each side.
// KIND 0: unstructured; 1: one diagonal; 2: alternating diagonals.
DefineConstant[ N = 4, LX = 1, LY = 1, KIND = 0 ];
h = 1 / N;
Point(1) = {0, 0, 0, h * LX};
Point(2) = {LX, 0, 0, h * LX};
Point(3) = {LX, LY, 0, h * LX};
Point(4) = {0, LY, 0, h * LX};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
If (KIND > 0)
  Transfinite Curve{1, 2, 3, 4} = N + 1;
  If (KIND == 1)
    Transfinite Surface{1};
  Else
    Transfinite Surface{1} Alternated;
  EndIf
EndIf
Physical Curve("BOTTOM") = {1};
Physical Curve("RIGHT") = {2};
Physical Curve("TOP") = {3};
Physical Curve("LEFT") = {4};
Physical Surface("BODY") = {1};
