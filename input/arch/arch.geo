// Semicircular arch of the mean radius 1 and the thickness H, from right to
// left NB voussoirs of M x K cells.
DefineConstant[ H = 0.11, NB = 10, M = 4, K = 4 ];
Point(1) = {0, 0, 0};
For i In {1 : NB}
  k = 10 * i;
  For j In {0 : 1}
    a = Pi * (i - 1 + j) / NB;
    Point(k + 2 * j) = {(1 - H / 2) * Cos(a), (1 - H / 2) * Sin(a), 0};
    Point(k + 2 * j + 1) = {(1 + H / 2) * Cos(a), (1 + H / 2) * Sin(a), 0};
    Line(k + j) = {k + 2 * j, k + 2 * j + 1};
  EndFor
  Circle(k + 2) = {k, 1, k + 2};
  Circle(k + 3) = {k + 1, 1, k + 3};
  Curve Loop(i) = {k, k + 3, -(k + 1), -(k + 2)};
  Plane Surface(i) = {i};
  Transfinite Curve{k, k + 1} = M + 1;
  Transfinite Curve{k + 2, k + 3} = K + 1;
  Transfinite Surface{i} Alternated;
  Physical Curve(Sprintf("FROM %g", i)) = {k};
  Physical Curve(Sprintf("TO %g", i)) = {k + 1};
  all[] += {i};
EndFor
Physical Surface("ARCH") = {all[]};
