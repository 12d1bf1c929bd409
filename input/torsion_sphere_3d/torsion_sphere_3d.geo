// Half a ball of radius SIZE contact radii, z >= 0, whose flat side touches a
// paraboloid: the half space, cut off.
//   A        radius of the contact that is expected
//   SIZE     radius of the half ball, in contact radii
//   NC       edges per contact radius, up to 1.1 radii from the middle
//   GROWTH   growth of the edges with the distance from there
SetFactory("OpenCASCADE");
DefineConstant[ A = 0.3191252149, SIZE = 5, NC = 8, GROWTH = 0.3 ];

h = A / NC;
L = SIZE * A;
eps = 1e-3 * A;

Sphere(1) = {0, 0, 0, L, 0, Pi / 2, 2 * Pi};
Disk(100) = {0, 0, 0, 1.4 * A};
parts() = BooleanFragments{ Volume{1}; Delete; }{ Surface{100}; Delete; };

Field[1] = MathEval;
Field[1].F = Sprintf("%g + %g * Max(Sqrt(x^2 + y^2 + z^2) - %g, 0)", h, GROWTH,
                     1.1 * A);
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;

foot() = Surface In BoundingBox{-1.5 * A, -1.5 * A, -eps,
                                1.5 * A, 1.5 * A, eps};
flat() = Surface In BoundingBox{-L - eps, -L - eps, -eps,
                                L + eps, L + eps, eps};
far() = Surface In BoundingBox{-L - eps, -L - eps, -eps,
                               L + eps, L + eps, L + eps};
far() -= {flat()};

Physical Volume("BODY") = Volume{:};
Physical Surface("CONTACT") = {foot()};
Physical Surface("FAR") = {far()};
