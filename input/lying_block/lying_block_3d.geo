// Block L x W x H on the plane z = 0, unstructured, N edges along x.
DefineConstant[ N = 12, L = 80, W = 40, H = 30 ];

h = L / N;
Point(1) = {0, 0, 0, h};
line() = Extrude{L, 0, 0}{ Point{1}; };
base() = Extrude{0, W, 0}{ Curve{line(1)}; };
block() = Extrude{0, 0, H}{ Surface{base(1)}; };
eps = 1e-3 * h;

Physical Volume("BODY") = {block(1)};
Physical Surface("BOTTOM") = {base(1)};
Physical Surface("TOP") = {block(0)};
Physical Surface("LEFT") = Surface In BoundingBox{-eps, -eps, -eps,
                                                  eps, W + eps, H + eps};
Physical Surface("RIGHT") = Surface In BoundingBox{L - eps, -eps, -eps,
                                                   L + eps, W + eps, H + eps};
