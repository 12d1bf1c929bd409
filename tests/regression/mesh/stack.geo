// Unit squares on each other, NB of them, with different meshes.
DefineConstant[ NB = 5 ];
For i In {1 : NB}
  k = 10 * i;
  Point(k) = {0, i - 1, 0, 1 / (2 + i % 3)};
  Point(k + 1) = {1, i - 1, 0, 1 / (2 + i % 3)};
  Point(k + 2) = {1, i, 0, 1 / (2 + i % 3)};
  Point(k + 3) = {0, i, 0, 1 / (2 + i % 3)};
  For j In {0 : 3}
    Line(k + j) = {k + j, k + (j + 1) % 4};
  EndFor
  Curve Loop(i) = {k ... k + 3};
  Plane Surface(i) = {i};
  Physical Curve(Sprintf("BOTTOM %g", i)) = {k};
  Physical Curve(Sprintf("TOP %g", i)) = {k + 2};
  Physical Curve(Sprintf("LEFT %g", i)) = {k + 3};
  all[] += {i};
EndFor
Physical Surface("BLOCKS") = {all[]};
Physical Surface("BLOCK 5") = {NB};
