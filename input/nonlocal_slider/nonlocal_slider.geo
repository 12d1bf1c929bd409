// Four linings side by side, L long and H thick, N segments along each, their
// rubbing faces on the line y = 0. Lining k begins at x = k*PITCH.
DefineConstant[ N = 320, L = 100, H = 0.1, PITCH = 150 ];

For k In {0 : 3}
  p = 4*k;
  Point(p + 1) = {k*PITCH, 0, 0};
  Point(p + 2) = {k*PITCH + L, 0, 0};
  Point(p + 3) = {k*PITCH + L, H, 0};
  Point(p + 4) = {k*PITCH, H, 0};
  Line(p + 1) = {p + 1, p + 2};
  Line(p + 2) = {p + 2, p + 3};
  Line(p + 3) = {p + 3, p + 4};
  Line(p + 4) = {p + 4, p + 1};
  Curve Loop(k + 1) = {p + 1 ... p + 4};
  Plane Surface(k + 1) = {k + 1};
  Transfinite Curve{p + 1, p + 3} = N + 1;
  Transfinite Curve{p + 2, p + 4} = 2;
  Transfinite Surface{k + 1} Alternated;
EndFor

Physical Surface("LINING") = {1 ... 4};
Physical Curve("FACE0") = {1};
Physical Curve("FACE1") = {5};
Physical Curve("FACE2") = {9};
Physical Curve("FACE3") = {13};
Physical Curve("HOLDER") = {3, 7, 11, 15};
