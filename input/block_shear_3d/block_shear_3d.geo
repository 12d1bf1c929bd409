// Block L x L x H on the plane z = 0, cut into N x N x NZ bricks of six
// tetrahedra; N = 35, NZ = 30 has 40,176 nodes.
DefineConstant[ N = 12, NZ = 6, L = 40, H = 20 ];

Point(1) = {0, 0, 0};
line() = Extrude{L, 0, 0}{ Point{1}; Layers{N}; };
base() = Extrude{0, L, 0}{ Curve{line(1)}; Layers{N}; };
block() = Extrude{0, 0, H}{ Surface{base(1)}; Layers{NZ}; };

Physical Volume("BODY") = {block(1)};
Physical Surface("BOTTOM") = {base(1)};
Physical Surface("TOP") = {block(0)};
