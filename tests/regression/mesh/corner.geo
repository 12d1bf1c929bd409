// Three blocks of 1 x 1, N, M, K segments an edge: from (0, 0), above it, on
// its left.
DefineConstant[ N = 4, M = 3, K = 5 ];
Macro Square
  For i In {0 : 3}
    Point(k + i) = {x0 + (i == 1 || i == 2), y0 + (i > 1), 0, 1 / n};
  EndFor
  For i In {0 : 3}
    Line(k + i) = {k + i, k + (i + 1) % 4};
    Transfinite Curve{k + i} = n + 1;
  EndFor
  Curve Loop(k) = {k, k + 1, k + 2, k + 3};
  Plane Surface(k) = {k};
Return
k = 1; n = N; x0 = 0; y0 = 0;
Call Square;
k = 11; n = M; y0 = 1;
Call Square;
k = 21; n = K; x0 = -1; y0 = 0;
Call Square;
Physical Curve("UP") = {3};
Physical Curve("ASIDE") = {4};
Physical Curve("ABOVE") = {11};
Physical Curve("BESIDE") = {22};
Physical Curve("BOTTOM") = {1, 21};
Physical Curve("RIGHT") = {2, 12};
Physical Curve("OUTSIDE") = {13, 14, 23, 24};
Physical Surface("BODY") = {1, 11, 21};
