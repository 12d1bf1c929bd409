// Four layers, 40 wide and 10 high each; the two lines of the floor are groups
// of their own.
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
MeshSize{:} = 40 / N;
Physical Surface("BODY") = {1};
Physical Surface("RUBBER") = {2};
Physical Surface("SEAL") = {3};
Physical Surface("CAP") = {4};
Physical Curve("FOOT") = {100};
Physical Curve("TOE") = {101};
Physical Curve("TOP") = {108, 109};
Physical Curve("SIDE") = {200};
