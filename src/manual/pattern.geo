// Four layers, 40 wide and 10 high each; the two lines of the floor are groups
// of their own. Beside them a tower of three blocks, whose meshes do not match,
// with a slit in the lowest.
DefineConstant[ N = 8 ];
For k In {0:4}
  Point(3 * k + 1) = {0, 10 * k, 0};
  Point(3 * k + 2) = {20, 10 * k, 0};
  Point(3 * k + 3) = {40, 10 * k, 0};
  Line(100 + 2 * k) = {3 * k + 1, 3 * k + 2};
  Line(101 + 2 * k) = {3 * k + 2, 3 * k + 3};
EndFor
For k In {0:3}
  Line(200 + 2 * k) = {3 * k + 1, 3 * k + 4};
  Line(201 + 2 * k) = {3 * k + 3, 3 * k + 6};
  Curve Loop(k + 1) = {100 + 2 * k, 101 + 2 * k, 201 + 2 * k,
                       -103 - 2 * k, -102 - 2 * k, -200 - 2 * k};
  Plane Surface(k + 1) = {k + 1};
EndFor
For k In {0:2}
  Point(51 + 4 * k) = {60, 10 * k, 0};
  Point(52 + 4 * k) = {70, 10 * k, 0};
  Point(53 + 4 * k) = {70, 10 * k + 10, 0};
  Point(54 + 4 * k) = {60, 10 * k + 10, 0};
  For j In {0:3}
    Line(300 + 4 * k + j) = {51 + 4 * k + j, 51 + 4 * k + (j + 1) % 4};
  EndFor
  Transfinite Curve{300 + 4 * k, 302 + 4 * k} = N / 4 + k + 2;
  Curve Loop(11 + k) = {300 + 4 * k ... 303 + 4 * k};
  Plane Surface(11 + k) = {11 + k};
EndFor
Point(71) = {63, 4, 0};
Point(72) = {67, 6, 0};
Line(320) = {71, 72};
Transfinite Curve{320} = 13;
Curve{320} In Surface{11};
MeshSize{:} = 40 / N;
Physical Surface("BODY") = {1};
Physical Surface("RUBBER") = {2};
Physical Surface("SEAL") = {3};
Physical Surface("CAP") = {4};
Physical Curve("FOOT") = {100};
Physical Curve("TOE") = {101};
Physical Curve("TOP") = {108, 109};
Physical Curve("SIDE") = {200};
Physical Surface("TOWER") = {11, 12, 13};
Physical Curve("TOWER FOOT") = {300};
Physical Curve("TOWER SIDE") = {303, 307, 311};
Physical Curve("BASE TOP") = {302};
Physical Curve("LID FOOT") = {304};
Physical Curve("LID TOP") = {306};
Physical Curve("KNOB FOOT") = {308};
Physical Curve("SLIT") = {320};
