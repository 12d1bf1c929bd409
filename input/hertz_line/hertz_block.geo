// Half of a block, x >= 0, whose side y = 0 touches a parabola x^2 / 2R: the
// half plane of the theory of Hertz, cut off at SIZE half-widths.
//   A        half-width of the contact that is expected
//   SIZE     width and height of the half block, in half-widths
//   NC       segments per half-width, up to 1.5 half-widths
//   GROWTH   growth of the segments with the distance from there
//   REACH    length that may touch, in half-widths
DefineConstant[ A = 0.2348908547, SIZE = 100, NC = 32, GROWTH = 0.12,
                REACH = 3 ];

h = A / NC;
L = SIZE * A;

Point(1) = {0, 0, 0};
Point(2) = {1.5 * A, 0, 0};
Point(3) = {REACH * A, 0, 0};
Point(4) = {L, 0, 0};
Point(5) = {L, L, 0};
Point(6) = {0, L, 0};
For k In {1 : 5}
  Line(k) = {k, k + 1};
EndFor
Line(6) = {6, 1};
Curve Loop(1) = {1 ... 6};
Plane Surface(1) = {1};

Transfinite Curve{1} = Ceil(1.5 * NC) + 1;
Field[1] = Distance;
Field[1].CurvesList = {1};
Field[1].NumPointsPerCurve = 200;
Field[2] = MathEval;
Field[2].F = Sprintf("%g + %g * Max(F1 - %g, 0)", h, GROWTH, A);
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Physical Surface("BODY") = {1};
Physical Curve("CONTACT") = {1, 2};
Physical Curve("TOP") = {5};
Physical Curve("SYMMETRY") = {6};
