// Two bodies that meet at (0, 0): the lower half of a disc of radius R2 above
// the line y = 0, below it the upper half of one of radius R1 or, with R1 = 0,
// a block of the width and height B.
//   A        half-width of the contact that is expected
//   N1, N2   segments per half-width on lines of 1.5 half-widths to each side
//   GROWTH   growth of the segments with the distance from there
//   REACH    length that may touch, in half-widths to each side
DefineConstant[ R1 = 0, R2 = 50, B = 200, A = 6.2146, N1 = 20, N2 = 14,
                GROWTH = 0.15, REACH = 3 ];

Macro Outline
  // centre k, then 7 points from left to right along the surface
  For i In {-3 : 3}
    w = (i < 0 ? -1 : 1) * at[Fabs(i)];
    If (r > 0)
      Point(k + 4 + i) = {r * Sin(w / r), side * r * (1 - Cos(w / r)), 0};
    Else
      Point(k + 4 + i) = {w, 0, 0};
    EndIf
  EndFor
  For i In {1 : 6}
    If (r > 0)
      Circle(k + i) = {k + i, k, k + i + 1};
    Else
      Line(k + i) = {k + i, k + i + 1};
    EndIf
  EndFor
Return

// upper
k = 100; r = R2; side = 1;
at[] = {0, 1.5 * A, REACH * A, Pi / 2 * R2};
Point(k) = {0, R2, 0};
Call Outline;
Line(k + 7) = {k + 7, k};
Line(k + 8) = {k, k + 1};
Line(k + 9) = {k + 4, k};
Curve Loop(k) = {k + 4, k + 5, k + 6, k + 7, -(k + 9)};
Curve Loop(k + 1) = {k + 1, k + 2, k + 3, k + 9, k + 8};
Plane Surface(k) = {k};
Plane Surface(k + 1) = {k + 1};

// lower
k = 200; r = R1; side = -1;
If (R1 > 0)
  at[] = {0, 1.5 * A, REACH * A, Pi / 2 * R1};
  Point(k) = {0, -R1, 0};
Else
  at[] = {0, 1.5 * A, REACH * A, B / 2};
  Point(k) = {0, -B, 0};
EndIf
Call Outline;
If (R1 > 0)
  Line(k + 7) = {k + 7, k};
  Line(k + 8) = {k, k + 1};
Else
  Point(k + 8) = {B / 2, -B, 0};
  Point(k + 9) = {-B / 2, -B, 0};
  Line(k + 10) = {k + 7, k + 8};
  Line(k + 7) = {k + 8, k};
  Line(k + 8) = {k, k + 9};
  Line(k + 11) = {k + 9, k + 1};
EndIf
Line(k + 9) = {k + 4, k};
If (R1 > 0)
  Curve Loop(k) = {k + 4, k + 5, k + 6, k + 7, -(k + 9)};
  Curve Loop(k + 1) = {k + 1, k + 2, k + 3, k + 9, k + 8};
Else
  Curve Loop(k) = {k + 4, k + 5, k + 6, k + 10, k + 7, -(k + 9)};
  Curve Loop(k + 1) = {k + 1, k + 2, k + 3, k + 9, k + 8, k + 11};
EndIf
Plane Surface(k) = {k};
Plane Surface(k + 1) = {k + 1};

For i In {0 : 1}
  k = 200 - 100 * i;
  n = (i == 0) ? N1 : N2;
  Transfinite Curve{k + 3, k + 4} = Ceil(1.5 * n) + 1;
  Field[4 * i + 1] = Distance;
  Field[4 * i + 1].CurvesList = {k + 3, k + 4};
  Field[4 * i + 1].NumPointsPerCurve = 200;
  Field[4 * i + 2] = MathEval;
  Field[4 * i + 2].F = Sprintf("%g + %g * Max(F%g - %g, 0)", A / n, GROWTH,
                               4 * i + 1, A);
EndFor
Field[9] = Min;
Field[9].FieldsList = {2, 6};
Background Field = 9;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

Physical Surface("LOWER") = {200, 201};
Physical Surface("UPPER") = {100, 101};
Physical Curve("LOWER SURFACE") = {202 ... 205};
Physical Curve("UPPER SURFACE") = {102 ... 105};
Physical Curve("BOTTOM") = {207, 208};
Physical Curve("TOP") = {107, 108};
Physical Curve("AXIS") = {109, 209};
Physical Point("PIN") = {200};
Physical Point("END") = {201};
