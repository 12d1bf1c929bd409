// Two blocks beside each other between a base and a roof, N segments an edge of
// length 1, other meshes on each; all four meet at (1, 1) and (1, 2).
DefineConstant[ N = 4 ];
Macro Rect
  Point(k) = {x0, y, 0, 1 / n};
  Point(k + 1) = {x1, y, 0, 1 / n};
  Point(k + 2) = {x1, y + 1, 0, 1 / n};
  Point(k + 3) = {x0, y + 1, 0, 1 / n};
  For i In {0 : 3}
    Line(k + i) = {k + i, k + (i + 1) % 4};
  EndFor
  Curve Loop(k) = {k : k + 3};
  Plane Surface(k) = {k};
Return
k = 10; x0 = 0; x1 = 2; y = 0; n = N; Call Rect;
k = 20; x0 = 0; x1 = 1; y = 1; n = 1.4 * N; Call Rect;
k = 30; x0 = 1; x1 = 2; y = 1; n = 1.7 * N; Call Rect;
k = 40; x0 = 0; x1 = 2; y = 2; n = 1.2 * N; Call Rect;
Physical Surface("BODIES") = {10, 20, 30, 40};
Physical Curve("FLOOR") = {10};
Physical Curve("BASE") = {12};
Physical Curve("LEFT DOWN") = {20};
Physical Curve("LEFT IN") = {21};
Physical Curve("LEFT UP") = {22};
Physical Curve("LEFT OUT") = {23};
Physical Curve("RIGHT DOWN") = {30};
Physical Curve("RIGHT OUT") = {31};
Physical Curve("RIGHT UP") = {32};
Physical Curve("RIGHT IN") = {33};
Physical Curve("ROOF") = {40};
Physical Curve("TOP") = {42};
Physical Curve("DOWN") = {20, 30};
