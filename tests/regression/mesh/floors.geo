// A block [0, 2] x [0, 1] with N edges below, over two floors [0, C] x [-1, 0]
// and [C, 2] x [-1, 0] of one edge each, 0.001 lower, the right one by S more.
// TURN: all of it by a right angle.
DefineConstant[ N = 5, C = 0.9, S = 0, TURN = 0 ];
Macro Square
  Point(k) = {x0, y0, 0};
  Point(k + 1) = {x1, y0, 0};
  Point(k + 2) = {x1, y0 + 1, 0};
  Point(k + 3) = {x0, y0 + 1, 0};
  For i In {0 : 3}
    Line(k + i) = {k + i, k + (i + 1) % 4};
    Transfinite Curve{k + i} = (i % 2 == 0) ? n + 1 : 2;
  EndFor
  Curve Loop(k) = {k, k + 1, k + 2, k + 3};
  Plane Surface(k) = {k};
Return
k = 1; n = N; x0 = 0; x1 = 2; y0 = 0;
Call Square;
k = 11; n = 1; x1 = C; y0 = -1.001;
Call Square;
k = 21; x0 = C; x1 = 2; y0 = y0 - S;
Call Square;
If (TURN)
  Rotate {{0, 0, 1}, {0, 0, 0}, Pi / 2} { Surface{1, 11, 21}; }
EndIf
Physical Curve("UNDER") = {1};
Physical Curve("TOP") = {3};
Physical Curve("LEFT FLOOR") = {13};
Physical Curve("RIGHT FLOOR") = {23};
Physical Surface("BLOCK") = {1};
Physical Surface("FLOORS") = {11, 21};
