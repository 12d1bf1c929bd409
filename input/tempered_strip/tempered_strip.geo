// Quarter of a strip of height 2 and length 2 L: x along it from the middle,
// y from the plane in the middle of its height to the surface.
//   N   cells across, NX along, smaller towards the free end
DefineConstant[ N = 30, NX = 8, L = 4 ];
w = L / NX;
Point(1) = {0, 0, 0};
Point(2) = {w, 0, 0};
Point(3) = {L, 0, 0};
Point(4) = {L, 1, 0};
Point(5) = {w, 1, 0};
Point(6) = {0, 1, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Line(7) = {2, 5};
Transfinite Curve{1, 5} = 2;
Transfinite Curve{2} = NX Using Progression 0.8;
Transfinite Curve{4} = NX Using Progression 1 / 0.8;
Transfinite Curve{3, 6, 7} = N + 1;
Curve Loop(1) = {1, 7, 5, 6};
Plane Surface(1) = {1};
Curve Loop(2) = {2, 3, 4, -7};
Plane Surface(2) = {2};
Transfinite Surface{1, 2} Alternated;
Physical Curve("MIDPLANE") = {1, 2};
Physical Curve("SYMMETRY") = {6};
Physical Surface("GLASS") = {1, 2};
Physical Surface("MIDDLE") = {1};
