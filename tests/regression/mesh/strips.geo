// Row of rectangles [X0, X0 + LX] x [0, LY], N segments along x, M along y;
// FIRST, MIDDLE, LAST are one segment wide each, for stresses at a place.
DefineConstant[ N = 40, M = 1, X0 = 0, LX = 1, LY = 1 ];
h = LX / N;
at[] = {0, h, LX / 2 - h / 2, LX / 2 + h / 2, LX - h, LX};
cells[] = {1, N / 2 - 1.5, 1, N / 2 - 1.5, 1};
For i In {0 : 5}
  Point(2 * i + 1) = {X0 + at[i], 0, 0};
  Point(2 * i + 2) = {X0 + at[i], LY, 0};
  Line(100 + i) = {2 * i + 1, 2 * i + 2};
  Transfinite Curve{100 + i} = M + 1;
EndFor
For i In {0 : 4}
  Line(200 + i) = {2 * i + 1, 2 * i + 3};
  Line(300 + i) = {2 * i + 2, 2 * i + 4};
  Transfinite Curve{200 + i, 300 + i} = Ceil(cells[i]) + 1;
  Curve Loop(i + 1) = {200 + i, 101 + i, -(300 + i), -(100 + i)};
  Plane Surface(i + 1) = {i + 1};
  Transfinite Surface{i + 1} Alternated;
EndFor
Physical Curve("LEFT") = {100};
Physical Curve("RIGHT") = {105};
Physical Curve("BOTTOM") = {200 : 204};
Physical Curve("TOP") = {300 : 304};
Physical Surface("BODY") = {1 : 5};
Physical Surface("FIRST") = {1};
Physical Surface("MIDDLE") = {3};
Physical Surface("LAST") = {5};
