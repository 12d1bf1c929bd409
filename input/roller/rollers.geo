// Two bodies that meet at (0, 0): the lower half of a disc of radius R2 above
// the line y = 0, below it the upper half of one of radius R1 or, with R1 = 0,
// a block of the width and height B.
//   A        half-width of the contact that is expected
//   N1, N2   segments per half-width on lines of 1.5 half-widths to each side
//   GROWTH   growth of the segments with the distance from there
//   REACH    length that may touch, in half-widths to each side
//   HALF     1: x >= 0 alone, for axisymmetry
DefineConstant[ R1 = 0, R2 = 50, B = 200, A = 6.2146, N1 = 20, N2 = 14,
                GROWTH = 0.15, REACH = 3, HALF = 0 ];

left = HALF ? 0 : -3; // the first of the points -3 ... 3
Macro Outline
  // centre k, then up to 7 points from left to right along the surface
  For i In {left : 3}
    w = (i < 0 ? -1 : 1) * at[Fabs(i)];
    If (r > 0)
      Point(k + 4 + i) = {r * Sin(w / r), side * r * (1 - Cos(w / r)), 0};
    Else
      Point(k + 4 + i) = {w, 0, 0};
    EndIf
  EndFor
  For i In {4 + left : 6}
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
Line(k + 9) = {k + 4, k};
Curve Loop(k) = {k + 4, k + 5, k + 6, k + 7, -(k + 9)};
Plane Surface(k) = {k};
If (!HALF)
  Line(k + 8) = {k, k + 1};
  Curve Loop(k + 1) = {k + 1, k + 2, k + 3, k + 9, k + 8};
  Plane Surface(k + 1) = {k + 1};
EndIf

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
Line(k + 9) = {k + 4, k};
If (R1 > 0)
  Line(k + 7) = {k + 7, k};
  Curve Loop(k) = {k + 4, k + 5, k + 6, k + 7, -(k + 9)};
Else
  Point(k + 8) = {B / 2, -B, 0};
  Line(k + 10) = {k + 7, k + 8};
  Line(k + 7) = {k + 8, k};
  Curve Loop(k) = {k + 4, k + 5, k + 6, k + 10, k + 7, -(k + 9)};
EndIf
Plane Surface(k) = {k};
If (!HALF)
  If (R1 > 0)
    Line(k + 8) = {k, k + 1};
    Curve Loop(k + 1) = {k + 1, k + 2, k + 3, k + 9, k + 8};
  Else
    Point(k + 9) = {-B / 2, -B, 0};
    Line(k + 8) = {k, k + 9};
    Line(k + 11) = {k + 9, k + 1};
    Curve Loop(k + 1) = {k + 1, k + 2, k + 3, k + 9, k + 8, k + 11};
  EndIf
  Plane Surface(k + 1) = {k + 1};
EndIf

For i In {0 : 1}
  k = 200 - 100 * i;
  n = (i == 0) ? N1 : N2;
  Transfinite Curve{k + 4 + left / 3 : k + 4} = Ceil(1.5 * n) + 1;
  Field[4 * i + 1] = Distance;
  Field[4 * i + 1].CurvesList = {k + 4 + left / 3 : k + 4};
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

half = 1 - HALF; // of a list: the second half too
Physical Surface("LOWER") = {200 : 200 + half};
Physical Surface("UPPER") = {100 : 100 + half};
Physical Curve("LOWER SURFACE") = {204 - 2 * half : 205};
Physical Curve("UPPER SURFACE") = {104 - 2 * half : 105};
Physical Curve("BOTTOM") = {207 : 207 + half};
Physical Curve("TOP") = {107 : 107 + half};
Physical Curve("AXIS") = {109, 209};
Physical Point("PIN") = {200};
If (!HALF)
  Physical Point("END") = {201};
EndIf
