// Two blocks on each other: [0, 1] x [0, 1], N segments an edge, and
// [C + D, 1 - C + D] x [1, 2], M segments, higher by G, its lower left corner by
// L more; turned about (0, 0) by A degrees.
DefineConstant[ N = 4, M = 7, A = 0, C = 0, D = 0, L = 0, G = 0 ];
c = Cos(A * Pi / 180);
s = Sin(A * Pi / 180);
Macro Square
  For i In {0 : 3}
    px = (i == 0 || i == 3) ? x0 : x1;
    py = (i < 2) ? y0 : y0 + 1;
    If (i == 0)
      py = py + lift;
    EndIf
    Point(k + i) = {c * px - s * py, s * px + c * py, 0, 1 / n};
  EndFor
  For i In {0 : 3}
    Line(k + i) = {k + i, k + (i + 1) % 4};
    Transfinite Curve{k + i} = n + 1;
  EndFor
  Curve Loop(k) = {k, k + 1, k + 2, k + 3};
  Plane Surface(k) = {k};
Return
k = 1; n = N; x0 = 0; x1 = 1; y0 = 0; lift = 0;
Call Square;
k = 11; n = M; x0 = C + D; x1 = 1 - C + D; y0 = 1 + G; lift = L;
Call Square;
Physical Curve("BOTTOM") = {1};
Physical Curve("RIGHT") = {2, 12};
Physical Curve("LEFT") = {4, 14};
Physical Curve("UNDER") = {3};
Physical Curve("OVER") = {11};
Physical Curve("TOP") = {13};
Physical Surface("LOWER") = {1};
Physical Surface("UPPER") = {11};
