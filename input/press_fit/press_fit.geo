// Shaft or ring between the radii R0 and R1, hub between R1 and R2; quarter.
//   N, M   segments of the ring, of the hub along the quarter of the seat
DefineConstant[ R0 = 10, R1 = 20, R2 = 40, N = 32, M = 45 ];
Macro Quarter
  Point(k) = {r, 0, 0, h};
  Point(k + 1) = {0, r, 0, h};
  Circle(k) = {k, 1, k + 1};
  Transfinite Curve{k} = n + 1;
Return
Point(1) = {0, 0, 0};
n = N; h = Pi / 2 * R1 / N;
k = 10; r = R0; Call Quarter;
k = 20; r = R1; Call Quarter;
n = M; h = Pi / 2 * R1 / M;
k = 30; r = R1; Call Quarter;
k = 40; r = R2; Call Quarter;
Line(50) = {10, 20};
Line(51) = {11, 21};
Line(60) = {30, 40};
Line(61) = {31, 41};
Curve Loop(1) = {50, 20, -51, -10};
Curve Loop(2) = {60, 40, -61, -30};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Transfinite Curve{50, 51} = Round((R1 - R0) / (Pi / 2 * R1 / N)) + 1;
Transfinite Curve{60, 61} = Round((R2 - R1) / (Pi / 2 * R1 / M)) + 1;
Transfinite Surface{1, 2} Alternated;
Physical Surface("RING") = {1};
Physical Surface("HUB") = {2};
Physical Curve("SEAT") = {20};
Physical Curve("BORE") = {30};
Physical Curve("FLAT X") = {51, 61};
Physical Curve("FLAT Y") = {50, 60};
