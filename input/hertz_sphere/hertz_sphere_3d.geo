// Quarter of the lower half of a sphere of radius R that stands on the plane
// z = 0; symmetric about x = 0 and y = 0, cut at z = R.
//   R        radius of the sphere
//   A        radius of the contact that is expected
//   NC       edges per contact radius, up to 1.3 radii from the pole
//   GROWTH   growth of the edges with the distance from there
//   REACH    distance from the pole that may touch, in contact radii
SetFactory("OpenCASCADE");
DefineConstant[ R = 10, A = 0.3191252149, NC = 6, GROWTH = 0.3, REACH = 2 ];

h = A / NC;
reach = REACH * A;
eps = 1e-3 * A;

Sphere(1) = {0, 0, R, R, -Pi / 2, 0, Pi / 2};
Sphere(2) = {0, 0, 0, reach, 0, Pi / 2, Pi / 2};
inner() = BooleanIntersection{ Volume{1}; }{ Volume{2}; Delete; };
parts() = BooleanFragments{ Volume{1}; Delete; }{ Volume{inner()}; Delete; };

pole() = Point In BoundingBox{-eps, -eps, -eps, eps, eps, eps};
Field[1] = Distance;
Field[1].PointsList = {pole()};
Field[2] = MathEval;
Field[2].F = Sprintf("%g + %g * Max(F1 - %g, 0)", h, GROWTH, 1.3 * A);
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

side_x() = Surface In BoundingBox{-eps, -eps, -eps, eps, R + eps, R + eps};
side_y() = Surface In BoundingBox{-eps, -eps, -eps, R + eps, eps, R + eps};
top() = Surface In BoundingBox{-eps, -eps, R - eps, R + eps, R + eps, R + eps};
cap() = Surface In BoundingBox{-eps, -eps, -eps, reach + eps, reach + eps,
                               0.6 * reach * reach / R + eps};

// The edge of the top is fine enough for its area, which carries the load.
edge() = Curve In BoundingBox{-eps, -eps, R - eps, R + eps, R + eps, R + eps};
edge() -= {Curve In BoundingBox{-eps, -eps, -eps, eps, R + eps, R + eps}};
edge() -= {Curve In BoundingBox{-eps, -eps, -eps, R + eps, eps, R + eps}};
Transfinite Curve{edge()} = 17;

Physical Volume("BODY") = Volume{:};
Physical Surface("CONTACT") = {cap()};
Physical Surface("TOP") = {top()};
Physical Surface("SIDE_X") = {side_x()};
Physical Surface("SIDE_Y") = {side_y()};
