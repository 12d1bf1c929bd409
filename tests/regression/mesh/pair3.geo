// Two cubes on each other along z, DEEP in each other, with N and M segments an
// edge.
DefineConstant[ N = 2, M = 3, DEEP = 0 ];
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Box(2) = {0, 0, 1 - DEEP, 1, 1, 1};
MeshSize{ PointsOf{ Volume{1}; } } = 1 / N;
MeshSize{ PointsOf{ Volume{2}; } } = 1 / M;
Physical Surface("LEFT") = {1, 7};
Physical Surface("RIGHT") = {2, 8};
Physical Surface("FRONT") = {3, 9};
Physical Surface("BACK") = {4, 10};
Physical Surface("BOTTOM") = {5};
Physical Surface("UNDER") = {6};
Physical Surface("OVER") = {11};
Physical Surface("TOP") = {12};
Physical Volume("LOWER") = {1};
Physical Volume("UPPER") = {2};
