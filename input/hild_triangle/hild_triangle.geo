// Triangle A = (0, 0), B = (1, 0), C = (1 - 2 NU)(1, T), T = sqrt(NU/(1 - NU)):
// for this shape a uniform strain changes the forces under AB in the ratio
// 1/T without any on CA, and the friction 1/T is critical (P. Hild).
//   N    segments of the contact line AB; 1: one element
//   NU   Poisson's ratio
DefineConstant[ N = 4, NU = 0.1 ];

T = Sqrt(NU / (1 - NU));
h = 1 / N;
Point(1) = {0, 0, 0, h};
Point(2) = {1, 0, 0, h};
Point(3) = {1 - 2 * NU, (1 - 2 * NU) * T, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 1};
Curve Loop(1) = {1 ... 3};
Plane Surface(1) = {1};
Transfinite Curve{1 ... 3} = N + 1;
Transfinite Surface{1} = {1, 2, 3};

Physical Surface("BODY") = {1};
Physical Curve("AB") = {1};
Physical Curve("BC") = {2};
Physical Curve("CA") = {3};
