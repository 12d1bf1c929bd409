// Ball of the radius R with a crack, the unit disc in the plane z = 0 turned
// about x by ANGLE degrees.
DefineConstant[ R = 6, N = 8, ANGLE = 0 ];
SetFactory("OpenCASCADE");
Sphere(1) = {0, 0, 0, R};
Disk(100) = {0, 0, 0, 1};
Rotate{{1, 0, 0}, {0, 0, 0}, ANGLE * Pi / 180} { Surface{100}; }
BooleanFragments{ Volume{1}; Delete; }{ Surface{100}; Delete; }
rim() = Boundary{ Surface{100}; };
Field[1] = Distance;
Field[1].CurvesList = {rim(0)};
Field[1].NumPointsPerCurve = 200;
Field[2] = MathEval;
Field[2].F = Sprintf("%g + 0.45 * F1", 1 / N);
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Physical Volume("BALL") = {1};
Physical Surface("DISC") = {100};
all() = Boundary{ Volume{1}; };
Physical Surface("SKIN") = {all(0)};
