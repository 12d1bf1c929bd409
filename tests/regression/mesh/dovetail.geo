// A dovetail between two claws, sizes 1/N and 1/M: its sides lean inwards by
// 1 in 3 from (+-0.6, 0) to (+-0.4, 0.6).
DefineConstant[ N = 10, M = 14 ];
Point(1) = {-0.6, 0, 0, 1 / N};
Point(2) = {0.6, 0, 0, 1 / N};
Point(3) = {0.4, 0.6, 0, 1 / N};
Point(4) = {-0.4, 0.6, 0, 1 / N};
For i In {1 : 4}
  Line(i) = {i, i % 4 + 1};
EndFor
Curve Loop(1) = {1 ... 4};
Plane Surface(1) = {1};
For i In {0 : 1}
  k = 11 + 10 * i;
  s = 2 * i - 1;
  Point(k) = {s * 0.6, 0, 0, 1 / M};
  Point(k + 1) = {s * 0.4, 0.6, 0, 1 / M};
  Point(k + 2) = {s * 1.2, 0.6, 0, 1 / M};
  Point(k + 3) = {s * 1.2, 0, 0, 1 / M};
  For j In {0 : 3}
    Line(k + j) = {k + j, k + (j + 1) % 4};
  EndFor
  Curve Loop(k) = {k ... k + 3};
  Plane Surface(k) = {k};
EndFor
Physical Surface("BODIES") = {1, 11, 21};
Physical Curve("TOP") = {3};
Physical Curve("LEFT") = {4};
Physical Curve("RIGHT") = {2};
Physical Curve("LEFT CLAW") = {11};
Physical Curve("RIGHT CLAW") = {21};
Physical Curve("WALLS") = {13, 23};
